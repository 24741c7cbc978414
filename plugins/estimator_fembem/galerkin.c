#include "system.h"
#include <petscblaslapack.h>

/* The dense system: two Cholesky factorisations, V, then D + W^T V^-1 W. Limits: n unknowns take up to n^2 numbers on every rank */

/* All pairs, dealt out to the ranks: a rank has neighbours and far ones, and of each row as many as the others */
static PetscErrorCode Assemble(FembemSystem *s)
{
  PetscMPIInt size, rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(s->b->comm, &size));
  PetscCallMPI(MPI_Comm_rank(s->b->comm, &rank));
  if (!rank) FembemSystemAddMass(s);
  for (PetscInt i = 0; i < s->b->n; ++i)
    for (PetscInt j = i; j < s->b->n; ++j)
      if (j % size == rank) PetscCall(FembemSystemAddPair(s, i, j));
  PetscCall(FembemDenseSum(s->b->comm, (size_t)s->nt * s->nt, s->V));
  PetscCall(FembemDenseSum(s->b->comm, (size_t)s->nt * s->nu, s->W));
  PetscCall(FembemDenseSum(s->b->comm, (size_t)s->nu * s->nu, s->D));
  PetscCall(FembemDenseSum(s->b->comm, s->nt + s->nu, s->rhs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Each rigid motion that is free gets the stiffness of an average unknown, so that it becomes zero */
static void HoldMotions(FembemSystem *s)
{
  PetscReal stiffness = 0.;

  for (PetscInt k = 0; k < s->nu; ++k) stiffness += s->D[k + (size_t)s->nu * k] / s->nu;
  for (PetscInt m = 0; m < s->nmotions; ++m) {
    const FembemMotion *motion = &s->motion[m];
    const PetscInt      first = motion->first, n = motion->end - first;

    for (PetscInt i = 0; i < n; ++i)
      for (PetscInt j = 0; j < n; ++j)
        s->D[first + j + (size_t)s->nu * (first + i)] += stiffness / motion->norm2 * motion->r[i] * motion->r[j];
  }
}

/* Assembles and factors; V, W and D are what FembemSystemSolve() needs, if they are positive */
PetscErrorCode FembemSystemFactor(FembemSystem *s, PetscBool *positive)
{
  PetscFunctionBegin;
  PetscCall(PetscCalloc3((size_t)s->nt * s->nt, &s->V, (size_t)s->nt * s->nu, &s->W, (size_t)s->nu * s->nu, &s->D));
  PetscCall(Assemble(s));
  PetscCall(FembemDenseFactor(s->b->comm, s->nt, s->V, positive));
  if (!*positive || !s->nu) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FembemDenseForward(s->b->comm, s->nt, s->nu, s->V, s->W));
  PetscCall(FembemDenseSchur(s->b->comm, s->nt, s->nu, s->W, s->D));
  HoldMotions(s);
  PetscCall(FembemDenseFactor(s->b->comm, s->nu, s->D, positive));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Leaves the unknown tractions in f and the unknown displacements in g */
PetscErrorCode FembemSystemSolve(const FembemSystem *s, PetscReal f[], PetscReal g[])
{
  const PetscReal one = 1., minus = -1.;
  PetscBLASInt    nt, nu, ldt, ldu, ione = 1, info;

  PetscFunctionBegin;
  PetscCall(PetscBLASIntCast(s->nt, &nt));
  PetscCall(PetscBLASIntCast(s->nu, &nu));
  ldt = PetscMax(nt, 1);
  ldu = PetscMax(nu, 1);
  PetscCallBLAS("BLAStrsm", BLAStrsm_("L", "L", "N", "N", &nt, &ione, &one, s->V, &ldt, f, &ldt));
  if (nu) {
    for (PetscInt k = 0; k < s->nu; ++k) g[k] = -g[k];
    if (nt) PetscCallBLAS("BLASgemv", BLASgemv_("T", &nt, &nu, &one, s->W, &ldt, f, &ione, &one, g, &ione));
    PetscCallBLAS("LAPACKpotrs", LAPACKpotrs_("L", &nu, &ione, s->D, &ldu, g, &ldu, &info));
    if (nt) PetscCallBLAS("BLASgemv", BLASgemv_("N", &nt, &nu, &minus, s->W, &ldt, g, &ione, &one, f, &ione));
  }
  PetscCallBLAS("BLAStrsm", BLAStrsm_("L", "L", "T", "N", &nt, &ione, &one, s->V, &ldt, f, &ldt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FembemSolveGalerkin(FembemBoundary *b, FembemSolver solver, FembemCost *cost)
{
  FembemSystem s;
  PetscBool    positive;

  PetscFunctionBegin;
  PetscCall(FembemSystemCreate(b, FembemSystemScale(b), &s));
  *cost = (FembemCost){.unknowns = s.nt + s.nu};
  if (cost->unknowns > solver.dense) PetscCall(FembemSystemIterate(&s, solver.tolerance, cost));
  else {
    PetscCall(FembemSystemFactor(&s, &positive));
    AbutCheckInput(positive, b->comm,
                   "estimator_fembem_solve: the boundary-element system is singular (Poisson's ratio %g, %" PetscInt_FMT
                   " boundary elements); give none",
                   (double)((3. - b->mat.kappa) / 4.), b->n);
    PetscCall(FembemSystemSolve(&s, s.f, s.g));
    cost->numbers = (size_t)s.nt * (s.nt + s.nu) + (size_t)s.nu * s.nu;
  }
  cost->pairs += s.pairs;
  if (cost->failed) {
    PetscCall(FembemSystemDestroy(&s));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt k = 0; k < s.rows * b->n; ++k)
    if (s.tindex[k] >= 0) s.t[k] = s.f[s.tindex[k]];
  for (PetscInt k = 0; k < 2 * b->nnodes; ++k)
    if (s.uindex[k] >= 0) s.u[k] = s.g[s.uindex[k]];
  for (PetscInt i = 0; i < b->nnodes; ++i) b->u[i] = s.scale * PetscCMPLX(s.u[2 * i], s.u[2 * i + 1]);
  for (PetscInt i = 0; i < (b->order + 1) * b->n; ++i) b->t[i] = b->young * PetscCMPLX(s.t[2 * i], s.t[2 * i + 1]);
  PetscCall(FembemSystemDestroy(&s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
