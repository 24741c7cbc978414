#include <petscksp.h>
#include "far.h"
#include "twolevel.h"

/*
   Systems too large to be dense. Pairs of elements near each other are entries of a sparse matrix, what is far goes by moments of clusters:
   both grow in proportion to the boundary. GMRES (Y. Saad and M. H. Schultz, SIAM J. Sci. Stat. Comput. 7, 1986) solves.
   Every rank evaluates its part of the near pairs and of the clusters; vectors are small, so that all ranks hold them and iterate alike.
*/
#define FEMBEM_RESTART    100
#define FEMBEM_ITERATIONS 1000

typedef struct {
  FembemSystem  *s;
  FembemFar      far;
  FembemTwoLevel two;
  Mat            near;      /* of this rank's pairs */
  PetscReal     *t, *u;     /* [rows*n], [2*nnodes] zero where given */
  PetscReal     *onT, *onU; /* what the far operator adds */
} Operator;

/* Of elements, in a pair of leaves */
static PetscInt CountPairs(const FembemCluster *a, const FembemCluster *b)
{
  const PetscInt n = a->end - a->first;

  return a == b ? n * (n + 1) / 2 : n * (b->end - b->first);
}

/* This rank's near pairs of leaves: those whose middle falls into its part of all pairs of elements */
static PetscErrorCode GetMyPairs(const Operator *op, PetscBool mine[], PetscInt *npairs)
{
  const FembemClusters *tree;
  const PetscInt       *near[2];
  PetscInt              nnear;
  PetscInt64            total = 0, before = 0;
  PetscMPIInt           size, rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(op->s->b->comm, &size));
  PetscCallMPI(MPI_Comm_rank(op->s->b->comm, &rank));
  FembemFarGetClusters(op->far, &tree, &nnear, near);
  for (PetscInt k = 0; k < nnear; ++k) total += CountPairs(&tree->cluster[near[0][k]], &tree->cluster[near[1][k]]);
  *npairs = 0;
  for (PetscInt k = 0; k < nnear; ++k) {
    const PetscInt n = CountPairs(&tree->cluster[near[0][k]], &tree->cluster[near[1][k]]);

    mine[k] = (PetscBool)((2 * before + n) * size / (2 * total) == rank);
    before += n;
    if (mine[k]) *npairs += n;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The sparse matrix, and what near elements with given values do to the right-hand side */
static PetscErrorCode AssembleNear(Operator *op)
{
  FembemSystem         *s = op->s;
  const FembemClusters *tree;
  const PetscInt       *near[2];
  const PetscInt        n = s->nt + s->nu;
  PetscInt              nnear, room = 0;
  PetscBool            *mine;
  FembemList            list = {.n = 0};

  PetscFunctionBegin;
  FembemFarGetClusters(op->far, &tree, &nnear, near);
  PetscCall(PetscMalloc1(nnear, &mine));
  PetscCall(GetMyPairs(op, mine, &room));
  room *= 2 * s->rows * s->rows; /* of each component either the traction or the displacement is unknown */
  PetscCall(PetscMalloc3(room, &list.row, room, &list.col, room, &list.value));
  s->list = &list;
  for (PetscInt k = 0; k < nnear; ++k) {
    const FembemCluster *a = &tree->cluster[near[0][k]], *b = &tree->cluster[near[1][k]];

    for (PetscInt i = a->first; mine[k] && i < a->end; ++i)
      for (PetscInt j = a == b ? i : b->first; j < b->end; ++j) PetscCall(FembemSystemAddPair(s, i, j));
  }
  s->list = NULL;
  PetscCall(MatCreate(PETSC_COMM_SELF, &op->near));
  PetscCall(MatSetSizes(op->near, n, n, n, n));
  PetscCall(MatSetType(op->near, MATSEQAIJ));
  PetscCall(MatSetPreallocationCOO(op->near, list.n, list.row, list.col));
  PetscCall(MatSetValuesCOO(op->near, list.value, ADD_VALUES));
  PetscCall(PetscFree3(list.row, list.col, list.value));
  PetscCall(PetscFree(mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds factor times this rank's far part for t and u to y, [nt+nu] */
static PetscErrorCode AddFar(Operator *op, PetscReal factor, PetscReal y[])
{
  const FembemSystem *s = op->s;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < s->rows * s->b->n; ++k) op->onT[k] = 0.;
  for (PetscInt k = 0; k < 2 * s->b->nnodes; ++k) op->onU[k] = 0.;
  PetscCall(FembemFarAdd(op->far, op->t, op->u, op->onT, op->onU));
  for (PetscInt k = 0; k < s->rows * s->b->n; ++k)
    if (s->tindex[k] >= 0) y[s->tindex[k]] += factor * op->onT[k];
  for (PetscInt k = 0; k < 2 * s->b->nnodes; ++k)
    if (s->uindex[k] >= 0) y[s->nt + s->uindex[k]] += factor * op->onU[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The same numbers, to the last bit, on all ranks: they decide alike */
static PetscErrorCode SumAlike(const Operator *op, PetscReal y[])
{
  const PetscInt n = op->s->nt + op->s->nu;
  PetscMPIInt    size;

  PetscFunctionBegin;
  PetscCall(FembemDenseSum(op->s->b->comm, n, y));
  PetscCallMPI(MPI_Comm_size(op->s->b->comm, &size));
  if (size > 1) PetscCallMPI(MPI_Bcast(y, n, MPIU_REAL, 0, op->s->b->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetRightHandSide(Operator *op)
{
  FembemSystem *s = op->s;
  PetscMPIInt   rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(s->b->comm, &rank));
  if (!rank) FembemSystemAddMass(s);
  for (PetscInt k = 0; k < s->rows * s->b->n; ++k) op->t[k] = s->tindex[k] < 0 ? s->t[k] : 0.;
  for (PetscInt k = 0; k < 2 * s->b->nnodes; ++k) op->u[k] = s->uindex[k] < 0 ? s->u[k] : 0.;
  PetscCall(AddFar(op, -1., s->rhs));
  PetscCall(SumAlike(op, s->rhs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Each rigid motion that is free gets the stiffness of an unknown of D, so that it becomes zero */
static void HoldMotions(const FembemSystem *s, const PetscReal u[], PetscReal y[])
{
  const FembemMaterial *mat = &s->pairing.mat;

  for (PetscInt m = 0; m < s->nmotions; ++m) {
    const PetscReal *r   = s->motion + (size_t)s->nu * m;
    PetscReal        sum = 0.;

    for (PetscInt k = 0; k < s->nu; ++k) sum += r[k] * u[k];
    sum *= mat->mu / (PETSC_PI * (1. + mat->kappa) * s->norm2[m]);
    for (PetscInt k = 0; k < s->nu; ++k) y[k] -= sum * r[k];
  }
}

static PetscErrorCode Multiply(Mat A, Vec x, Vec y)
{
  Operator           *op;
  const FembemSystem *s;
  const PetscScalar  *in;
  PetscScalar        *out;

  PetscFunctionBegin;
  PetscCall(MatShellGetContext(A, &op));
  s = op->s;
  PetscCall(MatMult(op->near, x, y));
  PetscCall(VecGetArrayRead(x, &in));
  PetscCall(VecGetArray(y, &out));
  for (PetscInt k = 0; k < s->rows * s->b->n; ++k) op->t[k] = s->tindex[k] < 0 ? 0. : in[s->tindex[k]];
  for (PetscInt k = 0; k < 2 * s->b->nnodes; ++k) op->u[k] = s->uindex[k] < 0 ? 0. : in[s->nt + s->uindex[k]];
  PetscCall(AddFar(op, 1., out));
  PetscCall(SumAlike(op, out));
  HoldMotions(s, in + s->nt, out + s->nt);
  PetscCall(VecRestoreArray(y, &out));
  PetscCall(VecRestoreArrayRead(x, &in));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Precondition(PC pc, Vec r, Vec z)
{
  Operator          *op;
  const PetscScalar *in;
  PetscScalar       *out;

  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &op));
  PetscCall(VecGetArrayRead(r, &in));
  PetscCall(VecGetArrayWrite(z, &out));
  PetscCall(FembemTwoLevelApply(op->two, in, out));
  PetscCall(VecRestoreArrayWrite(z, &out));
  PetscCall(VecRestoreArrayRead(r, &in));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Leaves the solution in s->rhs */
static PetscErrorCode Iterate(Operator *op, PetscReal tolerance, PetscInt *its, PetscBool *failed)
{
  const PetscInt     n = op->s->nt + op->s->nu;
  Mat                A;
  KSP                ksp;
  PC                 pc;
  Vec                b, x;
  const PetscScalar *solution;
  KSPConvergedReason reason;

  PetscFunctionBegin;
  PetscCall(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, op, &A));
  PetscCall(MatShellSetOperation(A, MATOP_MULT, (void (*)(void))Multiply));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, op->s->rhs, &b));
  PetscCall(VecDuplicate(b, &x));
  PetscCall(KSPCreate(PETSC_COMM_SELF, &ksp));
  PetscCall(KSPSetType(ksp, KSPGMRES));
  PetscCall(KSPGMRESSetRestart(ksp, FEMBEM_RESTART));
  PetscCall(KSPSetTolerances(ksp, tolerance, PETSC_DEFAULT, PETSC_DEFAULT, FEMBEM_ITERATIONS));
  PetscCall(KSPSetOperators(ksp, A, A));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, op));
  PetscCall(PCShellSetApply(pc, Precondition));
  PetscCall(KSPSolve(ksp, b, x));
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  PetscCall(KSPGetIterationNumber(ksp, its));
  *failed = (PetscBool)(reason < 0);
  PetscCall(VecGetArrayRead(x, &solution));
  PetscCall(PetscArraycpy(op->s->rhs, solution, n));
  PetscCall(VecRestoreArrayRead(x, &solution));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&b));
  PetscCall(KSPDestroy(&ksp));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Leaves the unknown tractions in f and the unknown displacements in g */
PetscErrorCode FembemSystemIterate(FembemSystem *s, PetscReal tolerance, FembemCost *cost)
{
  const PetscInt        nt = s->rows * s->b->n, nu = 2 * s->b->nnodes;
  const FembemClusters *tree;
  const PetscInt       *near[2];
  PetscInt              nnear;
  Operator              op = {.s = s};
  MatInfo               info;

  PetscFunctionBegin;
  PetscCall(FembemFarCreate(s, tolerance, &op.far));
  FembemFarGetClusters(op.far, &tree, &nnear, near);
  PetscCall(PetscMalloc4(nt, &op.t, nu, &op.u, nt, &op.onT, nu, &op.onU));
  PetscCall(AssembleNear(&op));
  PetscCall(SetRightHandSide(&op));
  PetscCall(FembemTwoLevelCreate(s, tree, op.near, &op.two));
  PetscCall(Iterate(&op, tolerance, &cost->iterations, &cost->failed));
  PetscCall(MatGetInfo(op.near, MAT_LOCAL, &info));
  cost->numbers = (size_t)info.nz_used + FembemFarNumbers(op.far) + FembemTwoLevelNumbers(op.two);
  PetscCall(FembemTwoLevelDestroy(&op.two));
  PetscCall(MatDestroy(&op.near));
  PetscCall(PetscFree4(op.t, op.u, op.onT, op.onU));
  PetscCall(FembemFarDestroy(&op.far));
  PetscFunctionReturn(PETSC_SUCCESS);
}
