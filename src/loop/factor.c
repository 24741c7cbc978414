#include <abut/private/loopimpl.h>
#include <petscblaslapack.h>

/* Cholesky factors of a compliance in some of its nodes: by LAPACK where every rank has it all, by ScaLAPACK where the ranks share it */

/* The ranks' rows of a matrix of n: as many each, as ScaLAPACK wants them, the last ones beyond n */
static PetscInt AbutFactorRows_Private(AbutCompliance S, PetscInt n)
{
  return (n + S->size - 1) / S->size;
}

/* How many active nodes have a column on a rank before r: before[r], r up to the number of ranks */
static void AbutFactorCount_Private(AbutCompliance S, PetscInt na, const PetscInt active[], PetscInt before[])
{
  PetscInt j = 0;

  for (PetscMPIInt r = 0; r <= S->size; ++r) {
    while (j < na && active[j] < S->first[r]) ++j;
    before[r] = j;
  }
}

/* The length of what two runs have in common, and where in the first one it begins */
static void AbutFactorMeet_Private(PetscInt from, PetscInt to, PetscInt from2, PetscInt to2, PetscMPIInt *n, PetscMPIInt *at)
{
  *n  = (PetscMPIInt)PetscMax(0, PetscMin(to, to2) - PetscMax(from, from2));
  *at = (PetscMPIInt)PetscMax(0, from2 - from);
}

/* Columns of the active part -> the same as rows, as many on every rank; row [rows*na], one after the other */
static PetscErrorCode AbutFactorDistribute_Private(AbutCompliance S, PetscInt na, const PetscInt active[], PetscReal row[])
{
  const PetscInt rows = AbutFactorRows_Private(S, na);
  PetscMPIInt    rank, *nsend, *sendat, *nrecv, *recvat;
  PetscInt      *before;
  PetscReal     *own;
  MPI_Datatype   column;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(S->comm, &rank));
  PetscCall(PetscMalloc5(S->size, &nsend, S->size, &sendat, S->size, &nrecv, S->size, &recvat, S->size + 1, &before));
  AbutFactorCount_Private(S, na, active, before);
  for (PetscMPIInt r = 0; r < S->size; ++r) {
    AbutFactorMeet_Private(before[rank], before[rank + 1], rows * r, PetscMin(na, rows * (r + 1)), &nsend[r], &sendat[r]);
    AbutFactorMeet_Private(rows * rank, PetscMin(na, rows * (rank + 1)), before[r], before[r + 1], &nrecv[r], &recvat[r]);
  }
  PetscCall(PetscMalloc1((size_t)(before[rank + 1] - before[rank]) * na, &own));
  for (PetscInt j = before[rank]; j < before[rank + 1]; ++j) {
    const PetscReal *a = S->a + (size_t)S->n * (active[j] - S->begin);

    for (PetscInt i = 0; i < na; ++i) own[(size_t)na * (j - before[rank]) + i] = a[active[i]];
  }
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)na, MPIU_REAL, &column));
  PetscCallMPI(MPI_Type_commit(&column));
  PetscCallMPI(MPI_Alltoallv(own, nsend, sendat, column, row, nrecv, recvat, column, S->comm));
  PetscCallMPI(MPI_Type_free(&column));
  PetscCall(PetscFree(own));
  PetscCall(PetscFree5(nsend, sendat, nrecv, recvat, before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows beyond na are those of the unit matrix */
static PetscErrorCode AbutFactorShared_Private(AbutCompliance S, PetscInt na, const PetscInt active[], const PetscReal soft[])
{
  const PetscInt rows = AbutFactorRows_Private(S, na), all = rows * S->size;
  PetscInt       first;
  PetscReal     *row, *d;
  Mat            dense;
  PetscErrorCode error;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1((size_t)rows * na, &row));
  PetscCall(AbutFactorDistribute_Private(S, na, active, row));
  PetscCall(MatCreateDense(S->comm, rows, rows, all, all, NULL, &dense));
  PetscCall(MatGetOwnershipRange(dense, &first, NULL));
  PetscCall(MatDenseGetArrayWrite(dense, &d));
  PetscCall(PetscArrayzero(d, (size_t)rows * all));
  for (PetscInt i = 0; i < rows; ++i) {
    for (PetscInt j = 0; j < na && first + i < na; ++j) d[(size_t)rows * j + i] = row[(size_t)na * i + j];
    d[(size_t)rows * (first + i) + i] += first + i < na ? soft[active[first + i]] : 1.;
  }
  PetscCall(MatDenseRestoreArrayWrite(dense, &d));
  PetscCall(PetscFree(row));
  PetscCall(MatConvert(dense, MATSCALAPACK, MAT_INITIAL_MATRIX, &S->scalapack));
  PetscCall(MatDestroy(&dense));
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  error = MatCholeskyFactor(S->scalapack, NULL, NULL);
  PetscCall(PetscPopErrorHandler());
  PetscCheck(!error, PETSC_COMM_SELF, PETSC_ERR_LIB,
             "The contact model was not factored, as one is not that is not positive definite: MatCholeskyFactor returned %d", (int)error);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutFactorAlone_Private(AbutCompliance S, PetscInt na, const PetscInt active[], const PetscReal soft[])
{
  PetscBLASInt n, info;

  PetscFunctionBegin;
  if (!S->lapack) PetscCall(PetscMalloc1((size_t)S->n * S->n, &S->lapack));
  for (PetscInt j = 0; j < na; ++j) {
    const PetscReal *a = S->a + (size_t)S->n * active[j];

    for (PetscInt i = 0; i < na; ++i) S->lapack[(size_t)na * j + i] = a[active[i]];
    S->lapack[(size_t)na * j + j] += soft[active[j]];
  }
  PetscCall(PetscBLASIntCast(na, &n));
  PetscCallBLAS("LAPACKpotrf", LAPACKpotrf_("L", &n, S->lapack, &n, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "The contact model is not positive definite: LAPACK potrf returned %d", (int)info);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutComplianceFreeFactor_Private(AbutCompliance S)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(S->lapack));
  PetscCall(MatDestroy(&S->scalapack));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Factors S + diag(soft) of the na > 0 active nodes, which ascend; soft [n] */
PetscErrorCode AbutComplianceFactor_Private(AbutCompliance S, PetscInt na, const PetscInt active[], const PetscReal soft[])
{
  PetscFunctionBegin;
  if (!S->shared) PetscCall(AbutFactorAlone_Private(S, na, active, soft));
  else {
    PetscCall(MatDestroy(&S->scalapack));
    PetscCall(AbutFactorShared_Private(S, na, active, soft));
  }
  S->nactive = na;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutFactorSolveShared_Private(AbutCompliance S, PetscInt columns, PetscReal X[])
{
  const PetscInt na = S->nactive, rows = AbutFactorRows_Private(S, na);
  PetscInt       first;
  PetscReal     *all;
  Vec            b, x;

  PetscFunctionBegin;
  PetscCall(MatCreateVecs(S->scalapack, &x, &b));
  PetscCall(VecGetOwnershipRange(b, &first, NULL));
  PetscCall(PetscMalloc1(rows * S->size, &all));
  for (PetscInt k = 0; k < columns; ++k) {
    PetscScalar       *in;
    const PetscScalar *out;

    PetscCall(VecGetArrayWrite(b, &in));
    for (PetscInt i = 0; i < rows; ++i) in[i] = first + i < na ? X[na * k + first + i] : 0.;
    PetscCall(VecRestoreArrayWrite(b, &in));
    PetscCall(MatSolve(S->scalapack, b, x));
    PetscCall(VecGetArrayRead(x, &out));
    PetscCallMPI(MPI_Allgather(out, (PetscMPIInt)rows, MPIU_REAL, all, (PetscMPIInt)rows, MPIU_REAL, S->comm));
    PetscCall(VecRestoreArrayRead(x, &out));
    PetscCall(PetscArraycpy(X + na * k, all, na));
  }
  PetscCall(PetscFree(all));
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* X := the inverse of what was factored times X, columns of as many numbers as there were active nodes, side by side */
PetscErrorCode AbutComplianceSolve_Private(AbutCompliance S, PetscInt columns, PetscReal X[])
{
  PetscBLASInt n, k, info;

  PetscFunctionBegin;
  if (S->shared) {
    PetscCall(AbutFactorSolveShared_Private(S, columns, X));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscBLASIntCast(S->nactive, &n));
  PetscCall(PetscBLASIntCast(columns, &k));
  PetscCallBLAS("LAPACKpotrs", LAPACKpotrs_("L", &n, &k, S->lapack, &n, X, &n, &info));
  PetscFunctionReturn(PETSC_SUCCESS);
}
