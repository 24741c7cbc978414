#include <petscksp.h>
#include "far.h"
#include "twolevel.h"

/*
   Systems too large to be dense. Pairs of elements near each other are entries of a sparse matrix, what is far goes by moments of clusters:
   both grow in proportion to the boundary. GMRES (Y. Saad and M. H. Schultz, SIAM J. Sci. Stat. Comput. 7, 1986) solves.
   Every rank evaluates its part of the near pairs and of the clusters, for which it sees all unknowns; of GMRES's vectors it has a part.
*/
#define FEMBEM_RESTART    100
#define FEMBEM_ITERATIONS 1000

typedef struct {
  FembemSystem  *s;
  FembemFar      far;
  FembemTwoLevel two;
  Mat            near;           /* of this rank's pairs */
  Vec            all, part;      /* all unknowns, and what this rank's pairs and clusters make of them */
  PetscReal     *t, *u;          /* [rows*n], [2*nnodes] zero where given */
  PetscReal     *onT, *onU;      /* what the far operator adds */
  PetscReal     *buffer;         /* [nt+nu] in the order of GMRES's vectors */
  PetscMPIInt   *count, *before; /* [ranks] unknowns of each, and of those before it */
} Operator;

/* Of elements, in a pair of leaves */
static PetscInt CountPairs(const FembemCluster *a, const FembemCluster *b)
{
  const PetscInt n = a->end - a->first;

  return a == b ? n * (n + 1) / 2 : n * (b->end - b->first);
}

/* This rank's near pairs of leaves: those whose middle falls into its part of all pairs of elements */
static PetscErrorCode GetMyPairs(const Operator *op, PetscBool mine[], PetscCount *npairs)
{
  const FembemClusters *tree;
  const PetscInt       *near[2];
  PetscCount            nnear;
  PetscInt64            total = 0, before = 0;
  PetscMPIInt           size, rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(op->s->b->comm, &size));
  PetscCallMPI(MPI_Comm_rank(op->s->b->comm, &rank));
  FembemFarGetClusters(op->far, &tree, &nnear, near);
  for (PetscCount k = 0; k < nnear; ++k) total += CountPairs(&tree->cluster[near[0][k]], &tree->cluster[near[1][k]]);
  *npairs = 0;
  for (PetscCount k = 0; k < nnear; ++k) {
    const PetscInt n = CountPairs(&tree->cluster[near[0][k]], &tree->cluster[near[1][k]]);

    mine[k] = (PetscBool)((2 * before + n) * size / (2 * total) == rank);
    before += n;
    if (mine[k]) *npairs += n;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Before any of them is evaluated; room: entries of this rank, of each component either the traction or the displacement is unknown */
static PetscErrorCode CheckRoom(const FembemSystem *s, PetscCount npairs, PetscCount *room)
{
  PetscInt64 most;

  PetscFunctionBegin;
  *room = most = 2 * s->rows * s->rows * (PetscInt64)npairs;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_INT64, MPI_MAX, s->b->comm));
  AbutCheckInput(most <= PETSC_MAX_INT, s->b->comm,
                 "estimator_fembem_max_elements: %" PetscInt_FMT " boundary elements of order %" PetscInt_FMT " have %" PetscInt64_FMT
                 " matrix entries with near ones on a rank, more than PETSc's integers count; take more ranks or solve none",
                 s->b->n, s->b->order, most);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The sparse matrix, and what near elements with given values do to the right-hand side */
static PetscErrorCode AssembleNear(Operator *op)
{
  FembemSystem         *s = op->s;
  const FembemClusters *tree;
  const PetscInt       *near[2];
  const PetscInt        n = s->nt + s->nu;
  PetscCount            nnear, npairs = 0, room = 0;
  PetscBool            *mine;
  FembemList            list = {.n = 0};

  PetscFunctionBegin;
  FembemFarGetClusters(op->far, &tree, &nnear, near);
  PetscCall(PetscMalloc1(nnear, &mine));
  PetscCall(GetMyPairs(op, mine, &npairs));
  PetscCall(CheckRoom(s, npairs, &room));
  PetscCall(PetscMalloc3(room, &list.row, room, &list.col, room, &list.value));
  s->list = &list;
  for (PetscCount k = 0; k < nnear; ++k) {
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

/* All unknowns from the ranks' parts */
static PetscErrorCode GatherUnknowns(const Operator *op, Vec x, PetscReal all[])
{
  const PetscInt     n = op->s->nt + op->s->nu, *unknown;
  const PetscScalar *own;
  PetscMPIInt        rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(op->s->b->comm, &rank));
  PetscCall(VecGetArrayRead(x, &own));
  PetscCallMPI(MPI_Allgatherv(own, op->count[rank], MPIU_REAL, op->buffer, op->count, op->before, MPIU_REAL, op->s->b->comm));
  PetscCall(VecRestoreArrayRead(x, &own));
  FembemTwoLevelGetLayout(op->two, &unknown, NULL);
  for (PetscInt k = 0; k < n; ++k) all[unknown[k]] = op->buffer[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums over the ranks, of which each gets its own unknowns */
static PetscErrorCode SumUnknowns(const Operator *op, const PetscReal part[], Vec y)
{
  const PetscInt n = op->s->nt + op->s->nu, *unknown;
  PetscScalar   *own;

  PetscFunctionBegin;
  FembemTwoLevelGetLayout(op->two, &unknown, NULL);
  for (PetscInt k = 0; k < n; ++k) op->buffer[k] = part[unknown[k]];
  PetscCall(VecGetArrayWrite(y, &own));
  PetscCallMPI(MPI_Reduce_scatter(op->buffer, own, op->count, MPIU_REAL, MPIU_SUM, op->s->b->comm));
  PetscCall(VecRestoreArrayWrite(y, &own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* This rank's part; near pairs have added theirs */
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
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Each rigid motion that is free gets the stiffness of an unknown of D, so that it becomes zero */
static void HoldMotions(const FembemSystem *s, const PetscReal u[], PetscReal y[])
{
  for (PetscInt m = 0; m < s->nmotions; ++m) {
    const FembemMotion *motion = &s->motion[m];
    const PetscInt      first = motion->first, n = motion->end - first;
    PetscReal           sum = 0.;

    for (PetscInt k = 0; k < n; ++k) sum += motion->r[k] * u[first + k];
    sum *= FembemMotionStiffness(s, motion);
    for (PetscInt k = 0; k < n; ++k) y[first + k] -= sum * motion->r[k];
  }
}

static PetscErrorCode Multiply(Mat A, Vec x, Vec y)
{
  Operator           *op;
  const FembemSystem *s;
  const PetscScalar  *in;
  PetscScalar        *all, *out;
  PetscMPIInt         rank;

  PetscFunctionBegin;
  PetscCall(MatShellGetContext(A, &op));
  s = op->s;
  PetscCallMPI(MPI_Comm_rank(s->b->comm, &rank));
  PetscCall(VecGetArrayWrite(op->all, &all));
  PetscCall(GatherUnknowns(op, x, all));
  PetscCall(VecRestoreArrayWrite(op->all, &all));
  PetscCall(MatMult(op->near, op->all, op->part));
  PetscCall(VecGetArrayRead(op->all, &in));
  for (PetscInt k = 0; k < s->rows * s->b->n; ++k) op->t[k] = s->tindex[k] < 0 ? 0. : in[s->tindex[k]];
  for (PetscInt k = 0; k < 2 * s->b->nnodes; ++k) op->u[k] = s->uindex[k] < 0 ? 0. : in[s->nt + s->uindex[k]];
  PetscCall(VecGetArray(op->part, &out));
  PetscCall(AddFar(op, 1., out));
  if (!rank) HoldMotions(s, in + s->nt, out + s->nt);
  PetscCall(SumUnknowns(op, out, y));
  PetscCall(VecRestoreArray(op->part, &out));
  PetscCall(VecRestoreArrayRead(op->all, &in));
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

static PetscErrorCode CreateSolver(Operator *op, PetscReal tolerance, KSP *newksp)
{
  const PetscInt n    = op->s->nt + op->s->nu;
  MPI_Comm       comm = op->s->b->comm;
  PetscMPIInt    rank;
  Mat            A;
  KSP            ksp;
  PC             pc;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(MatCreateShell(comm, op->count[rank], op->count[rank], n, n, op, &A));
  PetscCall(MatShellSetOperation(A, MATOP_MULT, (void (*)(void))Multiply));
  PetscCall(KSPCreate(comm, &ksp));
  PetscCall(KSPSetType(ksp, KSPGMRES));
  PetscCall(KSPGMRESSetRestart(ksp, FEMBEM_RESTART));
  PetscCall(KSPSetPCSide(ksp, PC_RIGHT)); /* the residual is that of the system, whatever the preconditioner */
  PetscCall(KSPSetTolerances(ksp, tolerance, PETSC_DEFAULT, PETSC_DEFAULT, FEMBEM_ITERATIONS));
  PetscCall(KSPSetOperators(ksp, A, A));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, op));
  PetscCall(PCShellSetApply(pc, Precondition));
  PetscCall(MatDestroy(&A));
  *newksp = ksp;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Leaves the solution in s->rhs, on all ranks */
static PetscErrorCode Iterate(Operator *op, PetscReal tolerance, PetscInt *its, PetscBool *failed)
{
  Mat                A;
  KSP                ksp;
  Vec                b, x;
  KSPConvergedReason reason;

  PetscFunctionBegin;
  PetscCall(CreateSolver(op, tolerance, &ksp));
  PetscCall(KSPGetOperators(ksp, &A, NULL));
  PetscCall(MatCreateVecs(A, &x, &b));
  PetscCall(SumUnknowns(op, op->s->rhs, b));
  PetscCall(KSPSolve(ksp, b, x));
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  PetscCall(KSPGetIterationNumber(ksp, its));
  *failed = (PetscBool)(reason < 0);
  PetscCall(GatherUnknowns(op, x, op->s->rhs));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&b));
  PetscCall(KSPDestroy(&ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateOperator(FembemSystem *s, PetscReal tolerance, Operator *op)
{
  const PetscInt        nt = s->rows * s->b->n, nu = 2 * s->b->nnodes, *first;
  const FembemClusters *tree;
  const PetscInt       *near[2];
  PetscCount            nnear;
  PetscMPIInt           size;

  PetscFunctionBegin;
  op->s = s;
  PetscCallMPI(MPI_Comm_size(s->b->comm, &size));
  PetscCall(FembemFarCreate(s, tolerance, &op->far));
  FembemFarGetClusters(op->far, &tree, &nnear, near);
  PetscCall(PetscMalloc7(nt, &op->t, nu, &op->u, nt, &op->onT, nu, &op->onU, s->nt + s->nu, &op->buffer, size, &op->count, size,
                         &op->before));
  PetscCall(AssembleNear(op));
  PetscCall(MatCreateVecs(op->near, &op->all, &op->part));
  PetscCall(SetRightHandSide(op));
  PetscCall(FembemTwoLevelCreate(s, tree, op->near, &op->two));
  FembemTwoLevelGetLayout(op->two, NULL, &first);
  for (PetscMPIInt r = 0; r < size; ++r) {
    op->before[r] = (PetscMPIInt)first[r];
    op->count[r]  = (PetscMPIInt)(first[r + 1] - first[r]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyOperator(Operator *op)
{
  PetscFunctionBegin;
  PetscCall(FembemTwoLevelDestroy(&op->two));
  PetscCall(VecDestroy(&op->all));
  PetscCall(VecDestroy(&op->part));
  PetscCall(MatDestroy(&op->near));
  PetscCall(PetscFree7(op->t, op->u, op->onT, op->onU, op->buffer, op->count, op->before));
  PetscCall(FembemFarDestroy(&op->far));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Leaves the unknown tractions in f and the unknown displacements in g */
PetscErrorCode FembemSystemIterate(FembemSystem *s, PetscReal tolerance, FembemCost *cost)
{
  Operator op;
  MatInfo  info;

  PetscFunctionBegin;
  PetscCall(CreateOperator(s, tolerance, &op));
  PetscCall(Iterate(&op, tolerance, &cost->iterations, &cost->failed));
  PetscCall(MatGetInfo(op.near, MAT_LOCAL, &info));
  cost->numbers = (size_t)info.nz_used + FembemFarNumbers(op.far) + FembemTwoLevelNumbers(op.two);
  PetscCall(DestroyOperator(&op));
  PetscFunctionReturn(PETSC_SUCCESS);
}
