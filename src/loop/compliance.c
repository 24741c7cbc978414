#include <abut/private/loopimpl.h>
#include <petscblaslapack.h>

/*
   The compliance of the contact nodes, a symmetric dense matrix: products, sums with vv', factors of its part in some nodes.
   Columns are computed by all ranks, each its own. Then every rank gets them all; or, above a size, the ranks go on to share them, and with
   them the n^2 numbers and n^3 operations: products are put together from those of the ranks, and ScaLAPACK factors.
   Vectors are whole on every rank, and what follows from them is the same on all, to the last bit: ranks must decide alike.
*/

/* S = 0. The ranks share it if there are more than share nodes, and ScaLAPACK. */
PetscErrorCode AbutComplianceCreate_Private(MPI_Comm comm, PetscInt n, PETSC_UNUSED PetscInt share, AbutCompliance *compliance)
{
  AbutCompliance S;
  PetscMPIInt    rank;

  PetscFunctionBegin;
  PetscCall(PetscNew(&S));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &S->size));
  S->comm = comm;
  S->n    = n;
#if defined(PETSC_HAVE_SCALAPACK)
  S->shared = (PetscBool)(S->size > 1 && n > share);
#endif
  PetscCall(PetscMalloc2(S->size, &S->counts, S->size + 1, &S->first));
  for (PetscMPIInt r = 0; r <= S->size; ++r) S->first[r] = (PetscMPIInt)((PetscInt64)n * r / S->size);
  for (PetscMPIInt r = 0; r < S->size; ++r) S->counts[r] = S->first[r + 1] - S->first[r];
  S->from  = S->first[rank];
  S->to    = S->first[rank + 1];
  S->begin = S->shared ? S->from : 0;
  S->end   = S->shared ? S->to : n;
  PetscCall(PetscCalloc1((size_t)n * (S->end - S->begin), &S->a));
  *compliance = S;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutComplianceDestroy_Private(AbutCompliance *S)
{
  PetscFunctionBegin;
  if (!*S) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutComplianceFreeFactor_Private(*S));
  PetscCall(PetscFree2((*S)->counts, (*S)->first));
  PetscCall(PetscFree((*S)->a));
  PetscCall(PetscFree(*S));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The columns from..to-1 that this rank computes, one after the other; then AbutComplianceAssemble_Private() */
PetscReal *AbutComplianceGetColumns_Private(AbutCompliance S, PetscInt *from, PetscInt *to)
{
  *from = S->from;
  *to   = S->to;
  return S->a + (size_t)S->n * (S->from - S->begin);
}

PetscErrorCode AbutComplianceAssemble_Private(AbutCompliance S)
{
  MPI_Datatype column;

  PetscFunctionBegin;
  if (S->size == 1 || S->shared) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)S->n, MPIU_REAL, &column));
  PetscCallMPI(MPI_Type_commit(&column));
  PetscCallMPI(MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, S->a, S->counts, S->first, column, S->comm));
  PetscCallMPI(MPI_Type_free(&column));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What this rank has of a vector, a value for each column that it keeps, to all ranks */
static PetscErrorCode AbutComplianceGather_Private(AbutCompliance S, PetscReal y[])
{
  PetscFunctionBegin;
  if (S->shared) PetscCallMPI(MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, y, S->counts, S->first, MPIU_REAL, S->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Values that every rank has computed for itself become those of the first one: on processors of several kinds they need not be the same */
PetscErrorCode AbutComplianceAgree_Private(AbutCompliance S, PetscInt n, MPI_Datatype type, void *x)
{
  PetscFunctionBegin;
  if (S->size > 1) PetscCallMPI(MPI_Bcast(x, (PetscMPIInt)n, type, 0, S->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = S x */
PetscErrorCode AbutComplianceMult_Private(AbutCompliance S, const PetscReal x[], PetscReal y[])
{
  const PetscReal one = 1., zero = 0.;
  PetscBLASInt    rows, columns, ld, step = 1;

  PetscFunctionBegin;
  PetscCall(PetscBLASIntCast(S->n, &rows));
  PetscCall(PetscBLASIntCast(S->end - S->begin, &columns));
  ld = PetscMax(1, rows);
  PetscCallBLAS("BLASgemv", BLASgemv_("T", &rows, &columns, &one, S->a, &ld, x, &step, &zero, y + S->begin, &step));
  PetscCall(AbutComplianceGather_Private(S, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* S += sum of V_k W_k', which is to be symmetric; count columns each, side by side */
PetscErrorCode AbutComplianceAdd_Private(AbutCompliance S, PetscInt count, const PetscReal V[], const PetscReal W[])
{
  const PetscReal one = 1.;
  PetscBLASInt    rows, columns, k, ld;

  PetscFunctionBegin;
  PetscCall(PetscBLASIntCast(S->n, &rows));
  PetscCall(PetscBLASIntCast(S->end - S->begin, &columns));
  PetscCall(PetscBLASIntCast(count, &k));
  ld = PetscMax(1, rows);
  PetscCallBLAS("BLASgemm", BLASgemm_("N", "T", &rows, &columns, &k, &one, V, &ld, W + S->begin, &ld, &one, S->a, &ld));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutComplianceGetDiagonal_Private(AbutCompliance S, PetscReal diagonal[])
{
  PetscFunctionBegin;
  for (PetscInt i = S->begin; i < S->end; ++i) diagonal[i] = S->a[(size_t)S->n * (i - S->begin) + i];
  PetscCall(AbutComplianceGather_Private(S, diagonal));
  PetscFunctionReturn(PETSC_SUCCESS);
}
