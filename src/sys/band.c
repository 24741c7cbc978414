#include <abutsys.h> /*I "abutsys.h" I*/

/*@C
   AbutSolveBand - Solves a symmetric positive definite band system by Cholesky's method

   Not Collective

   Input Parameters:
+  n    - unknowns
.  band - diagonals below the main one
.  A    - [(band+1)*n] lower half by columns: A[(band+1)*j + i-j] for j <= i <= j+band; its factor on output
.  nrhs - right-hand sides
-  b    - [n*nrhs] right-hand sides one after the other, the solutions on output

   Level: developer

   Note:
   PETSc declares no band solver of LAPACK but the tridiagonal one.

.seealso: `AbutPairRecoverPressure()`
@*/
PetscErrorCode AbutSolveBand(PetscInt n, PetscInt band, PetscReal A[], PetscInt nrhs, PetscReal b[])
{
  const PetscInt ld = band + 1;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < n; ++j) {
    const PetscInt end = PetscMin(band, n - 1 - j);
    PetscReal     *c   = A + ld * j;

    PetscCheck(c[0] > 0., PETSC_COMM_SELF, PETSC_ERR_MAT_CH_ZRPVT, "Band matrix is not positive definite: pivot %" PetscInt_FMT, j);
    c[0] = PetscSqrtReal(c[0]);
    for (PetscInt i = 1; i <= end; ++i) c[i] /= c[0];
    for (PetscInt k = 1; k <= end; ++k)
      for (PetscInt i = k; i <= end; ++i) A[ld * (j + k) + i - k] -= c[i] * c[k];
  }
  for (PetscInt m = 0; m < nrhs; ++m, b += n) {
    for (PetscInt j = 0; j < n; ++j) {
      b[j] /= A[ld * j];
      for (PetscInt i = 1; i <= PetscMin(band, n - 1 - j); ++i) b[j + i] -= A[ld * j + i] * b[j];
    }
    for (PetscInt j = n - 1; j >= 0; --j) {
      for (PetscInt i = 1; i <= PetscMin(band, n - 1 - j); ++i) b[j] -= A[ld * j + i] * b[j + i];
      b[j] /= A[ld * j];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
