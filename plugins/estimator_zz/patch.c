#include "patch.h"

/* One more sample of the stress, at d from the vertex */
void AbutPatchAdd_Private(const PetscReal d[2], const PetscReal s[3], PetscReal m[])
{
  const PetscReal x = d[0], y = d[1], p[4] = {1., x, y, x * y}, more[5] = {x * x, y * y, x * x * y, x * y * y, x * x * y * y};

  for (PetscInt i = 0; i < 4; ++i) m[i] += p[i];
  for (PetscInt i = 0; i < 5; ++i) m[4 + i] += more[i];
  for (PetscInt i = 0; i < 12; ++i) m[9 + i] += s[i / 4] * p[i % 4];
}

/* Fits 1, x, y and, if terms is 4, xy. A term that the samples do not tell apart from those before it is left out, so that any samples give
   an answer; plane says whether 1, x and y were all told apart. The test is relative to the term itself, whatever the unit of length. */
void AbutPatchFit_Private(PetscInt terms, const PetscReal m[], PetscReal coef[], PetscBool *plane)
{
  static const PetscInt moment[4][4] = {
    {0, 1, 2, 3},
    {1, 4, 3, 6},
    {2, 3, 5, 7},
    {3, 6, 7, 8}
  };
  const PetscReal apart = 1e-3;
  PetscReal       L[4][4];
  PetscBool       out[4];

  for (PetscInt i = 0; i < terms; ++i) { /* Cholesky */
    for (PetscInt j = 0; j <= i; ++j) {
      L[i][j] = m[moment[i][j]];
      for (PetscInt k = 0; k < j; ++k) L[i][j] -= L[i][k] * L[j][k];
      if (j < i) L[i][j] = out[j] ? 0. : L[i][j] / L[j][j];
    }
    out[i]  = L[i][i] > apart * m[moment[i][i]] ? PETSC_FALSE : PETSC_TRUE;
    L[i][i] = out[i] ? 1. : PetscSqrtReal(L[i][i]);
  }
  *plane = out[0] || out[1] || out[2] ? PETSC_FALSE : PETSC_TRUE;
  for (PetscInt s = 0; s < 3; ++s) {
    PetscReal *a = coef + 4 * s;

    for (PetscInt i = 0; i < 4; ++i) a[i] = 0.;
    for (PetscInt i = 0; i < terms; ++i) {
      if (out[i]) continue;
      a[i] = m[9 + 4 * s + i];
      for (PetscInt k = 0; k < i; ++k) a[i] -= L[i][k] * a[k];
      a[i] /= L[i][i];
    }
    for (PetscInt i = terms - 1; i >= 0; --i) {
      for (PetscInt k = i + 1; k < terms; ++k) a[i] -= out[k] ? 0. : L[k][i] * a[k];
      a[i] = out[i] ? 0. : a[i] / L[i][i];
    }
  }
}

/* The same polynomials about an origin moved by d */
void AbutPatchShift_Private(const PetscReal a[], const PetscReal d[2], PetscReal b[])
{
  for (PetscInt s = 0; s < 12; s += 4) {
    b[s]     = a[s] + a[s + 1] * d[0] + a[s + 2] * d[1] + a[s + 3] * d[0] * d[1];
    b[s + 1] = a[s + 1] + a[s + 3] * d[1];
    b[s + 2] = a[s + 2] + a[s + 3] * d[0];
    b[s + 3] = a[s + 3];
  }
}
