#include "system.h"
#include <petscblaslapack.h>

/*
   Cholesky's factorisation and what goes with it for matrices that every rank holds: each does a part of the operations and sends its
   results to the others, so that in the end every rank can solve alone. Limits: n unknowns take n^2 numbers on every rank.
*/
#define FEMBEM_PANEL 64        /* columns: enough for the matrix products, few enough for the ranks to take turns */
#define FEMBEM_CHUNK (1 << 24) /* numbers in a message */

/* Sums over the ranks */
PetscErrorCode FembemDenseSum(MPI_Comm comm, size_t n, PetscReal A[])
{
  PetscMPIInt size;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  for (size_t i = 0; size > 1 && i < n; i += FEMBEM_CHUNK)
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, A + i, (PetscMPIInt)PetscMin(n - i, FEMBEM_CHUNK), MPIU_REAL, MPIU_SUM, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Only one rank gets the sums, the others keep what they have */
PetscErrorCode FembemDenseSumTo(MPI_Comm comm, size_t n, PetscMPIInt to, PetscReal A[])
{
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  for (size_t i = 0; i < n; i += FEMBEM_CHUNK)
    PetscCallMPI(MPI_Reduce(rank == to ? MPI_IN_PLACE : A + i, A + i, (PetscMPIInt)PetscMin(n - i, FEMBEM_CHUNK), MPIU_REAL, MPIU_SUM, to,
                            comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Columns first[r] to first[r+1]-1 of a matrix with ld rows come from rank r */
static PetscErrorCode ShareColumns(MPI_Comm comm, PetscInt ld, const PetscInt first[], PetscReal A[])
{
  PetscMPIInt size;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  for (PetscMPIInt r = 0; size > 1 && r < size; ++r) {
    const size_t from = (size_t)ld * first[r], to = (size_t)ld * first[r + 1];

    for (size_t i = from; i < to; i += FEMBEM_CHUNK)
      PetscCallMPI(MPI_Bcast(A + i, (PetscMPIInt)PetscMin(to - i, FEMBEM_CHUNK), MPIU_REAL, r, comm));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One panel of the factor: the diagonal block, what is below it; info is 0 if it is positive definite */
static PetscErrorCode FactorPanel(PetscBLASInt n, PetscBLASInt columns, PetscReal A[], PetscBLASInt lda, PetscBLASInt *info)
{
  const PetscReal    one  = 1.;
  const PetscBLASInt rest = n - columns;

  PetscFunctionBegin;
  PetscCallBLAS("LAPACKpotrf", LAPACKpotrf_("L", &columns, A, &lda, info));
  if (!*info && rest) PetscCallBLAS("BLAStrsm", BLAStrsm_("R", "L", "T", "N", &rest, &columns, &one, A, &lda, A + columns, &lda));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The panel travels without the rows above it */
static PetscErrorCode SharePanel(MPI_Comm comm, PetscMPIInt owner, PetscInt n, PetscInt columns, PetscReal A[], PetscInt lda,
                                 PetscReal buffer[])
{
  PetscMPIInt rank, count;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscMPIIntCast(n * columns, &count));
  for (PetscInt k = 0; rank == owner && k < columns; ++k) PetscCall(PetscArraycpy(buffer + n * k, A + (size_t)lda * k, n));
  PetscCallMPI(MPI_Bcast(buffer, count, MPIU_REAL, owner, comm));
  for (PetscInt k = 0; rank != owner && k < columns; ++k) PetscCall(PetscArraycpy(A + (size_t)lda * k, buffer + n * k, n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A = L L^T, L in the lower triangle; positive is false, and A spoilt, if there is none */
PetscErrorCode FembemDenseFactor(MPI_Comm comm, PetscInt n, PetscReal A[], PetscBool *positive)
{
  const PetscReal one = 1., minus = -1.;
  PetscMPIInt     size, rank;
  PetscInt        width;
  PetscBLASInt    lda, info = 0;
  PetscReal      *buffer;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscBLASIntCast(PetscMax(n, 1), &lda));
  width = size > 1 ? FEMBEM_PANEL : PetscMax(n, 1);
  PetscCall(PetscMalloc1(size > 1 ? n * width : 0, &buffer));
  for (PetscInt k = 0; !info && k < n; k += width) {
    const PetscMPIInt  owner   = (PetscMPIInt)(k / width % size);
    const PetscBLASInt columns = PetscMin(width, n - k);
    PetscReal         *panel   = A + k + (size_t)lda * k;

    if (rank == owner) PetscCall(FactorPanel(n - k, columns, panel, lda, &info));
    if (size == 1) break;
    PetscCallMPI(MPI_Bcast(&info, sizeof(info), MPI_BYTE, owner, comm));
    PetscCall(SharePanel(comm, owner, n - k, columns, panel, lda, buffer));
    for (PetscInt j = k + width; j < n; j += width) {
      const PetscBLASInt rows = n - j, more = PetscMin(width, n - j);

      if (j / width % size == rank)
        PetscCallBLAS("BLASgemm", BLASgemm_("N", "T", &rows, &more, &columns, &minus, panel + j - k, &lda, panel + j - k, &lda, &one,
                                            A + j + (size_t)lda * j, &lda));
    }
  }
  *positive = (PetscBool)!info;
  PetscCall(PetscFree(buffer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* B = L^-1 B, m columns */
PetscErrorCode FembemDenseForward(MPI_Comm comm, PetscInt n, PetscInt m, const PetscReal L[], PetscReal B[])
{
  const PetscReal one = 1.;
  PetscMPIInt     size, rank;
  PetscInt       *first;
  PetscBLASInt    rows, columns, lda;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscMalloc1(size + 1, &first));
  for (PetscMPIInt r = 0; r <= size; ++r) first[r] = (PetscInt)((PetscInt64)m * r / size);
  PetscCall(PetscBLASIntCast(n, &rows));
  lda     = PetscMax(rows, 1);
  columns = first[rank + 1] - first[rank];
  PetscCallBLAS("BLAStrsm", BLAStrsm_("L", "L", "N", "N", &rows, &columns, &one, L, &lda, B + (size_t)lda * first[rank], &lda));
  PetscCall(ShareColumns(comm, n, first, B));
  PetscCall(PetscFree(first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* D += W^T W in the lower triangle, W of n rows and m columns */
PetscErrorCode FembemDenseSchur(MPI_Comm comm, PetscInt n, PetscInt m, const PetscReal W[], PetscReal D[])
{
  const PetscReal one = 1.;
  PetscMPIInt     size, rank;
  PetscInt       *first;
  PetscBLASInt    rows, mine, below, ldw, ldd;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscMalloc1(size + 1, &first));
  for (PetscMPIInt r = 0; r <= size; ++r) first[r] = (PetscInt)(m * (1. - PetscSqrtReal(1. - (PetscReal)r / size))); /* equal areas */
  PetscCall(PetscBLASIntCast(n, &rows));
  PetscCall(PetscBLASIntCast(PetscMax(m, 1), &ldd));
  ldw   = PetscMax(rows, 1);
  mine  = first[rank + 1] - first[rank];
  below = m - first[rank + 1];
  PetscCallBLAS("BLASsyrk", BLASsyrk_("L", "T", &mine, &rows, &one, W + (size_t)ldw * first[rank], &ldw, &one,
                                      D + first[rank] + (size_t)ldd * first[rank], &ldd));
  if (below)
    PetscCallBLAS("BLASgemm", BLASgemm_("T", "N", &below, &mine, &rows, &one, W + (size_t)ldw * first[rank + 1], &ldw,
                                        W + (size_t)ldw * first[rank], &ldw, &one, D + first[rank + 1] + (size_t)ldd * first[rank], &ldd));
  PetscCall(ShareColumns(comm, m, first, D));
  PetscCall(PetscFree(first));
  PetscFunctionReturn(PETSC_SUCCESS);
}
