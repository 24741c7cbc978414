#include <abutmesh.h>
#include "patch.h"

#define ABUT_POWERS_MAX (2 * ABUT_ORDER_MAX + 1)

void AbutPatchSpaceSetUp_Private(PetscInt corners, PetscInt order, AbutPatchSpace *space)
{
  space->order = order;
  space->terms = 0;
  for (PetscInt degree = 0; degree <= (corners == 4 ? 2 : 1) * order; ++degree)
    for (PetscInt i = PetscMin(degree, order); i >= PetscMax(degree - order, 0); --i) {
      space->power[space->terms][0]   = i;
      space->power[space->terms++][1] = degree - i;
    }
  space->coefs   = 3 * space->terms;
  space->moments = PetscSqr(2 * order + 1) + space->coefs + 1;
}

static void AbutPowers_Private(PetscInt n, const PetscReal d[2], PetscReal power[2][ABUT_POWERS_MAX])
{
  for (PetscInt k = 0; k < 2; ++k) {
    power[k][0] = 1.;
    for (PetscInt i = 1; i <= n; ++i) power[k][i] = power[k][i - 1] * d[k];
  }
}

/* One more sample of the stress, at d from the vertex */
void AbutPatchAdd_Private(const AbutPatchSpace *space, const PetscReal d[2], const PetscReal s[3], PetscReal m[])
{
  const PetscInt n = 2 * space->order + 1;
  PetscReal      power[2][ABUT_POWERS_MAX];

  AbutPowers_Private(n - 1, d, power);
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = 0; j < n; ++j) m[n * i + j] += power[0][i] * power[1][j];
  m += n * n;
  for (PetscInt i = 0; i < space->terms; ++i) {
    const PetscReal p = power[0][space->power[i][0]] * power[1][space->power[i][1]];

    for (PetscInt k = 0; k < 3; ++k) m[space->terms * k + i] += s[k] * p;
  }
  m[space->coefs] += s[0] * s[0] + s[1] * s[1] + 2. * s[2] * s[2];
}

/* The factor of the normal equations; a term that the samples do not tell apart from those before it is left out. The test is relative
   to the term itself, so that neither it nor round-off depend on the unit of length. At order 4 the last term keeps 1.5e-3 of itself
   over four equal cells, and 5e-5 where two are half as wide and two half as high; what cannot be told leaves 1e-14. */
static void AbutPatchFactor_Private(const AbutPatchSpace *space, const PetscReal m[], PetscReal L[][ABUT_PATCH_TERMS_MAX], PetscBool out[])
{
  const PetscReal apart = space->order == 1 ? 1e-3 : 1e-9;

  for (PetscInt i = 0; i < space->terms; ++i) { /* Cholesky */
    PetscReal own = 0.;

    for (PetscInt j = 0; j <= i; ++j) {
      const PetscInt *a = space->power[i], *b = space->power[j];

      L[i][j] = own = m[(2 * space->order + 1) * (a[0] + b[0]) + a[1] + b[1]];
      for (PetscInt k = 0; k < j; ++k) L[i][j] -= L[i][k] * L[j][k];
      if (j < i) L[i][j] = out[j] ? 0. : L[i][j] / L[j][j];
    }
    out[i]  = L[i][i] > apart * own ? PETSC_FALSE : PETSC_TRUE;
    L[i][i] = out[i] ? 1. : PetscSqrtReal(L[i][i]);
  }
}

/* Fits the terms, or as many of them as the samples tell apart, so that any samples give an answer; plane says whether 1, x and y were */
void AbutPatchFit_Private(const AbutPatchSpace *space, const PetscReal m[], PetscReal coef[], PetscBool *plane)
{
  const PetscInt   n      = space->terms;
  const PetscReal *stress = m + PetscSqr(2 * space->order + 1);
  PetscReal        L[ABUT_PATCH_TERMS_MAX][ABUT_PATCH_TERMS_MAX];
  PetscBool        out[ABUT_PATCH_TERMS_MAX];

  AbutPatchFactor_Private(space, m, L, out);
  *plane = out[0] || out[1] || out[2] ? PETSC_FALSE : PETSC_TRUE;
  for (PetscInt s = 0; s < 3; ++s) {
    PetscReal *a = coef + n * s;

    for (PetscInt i = 0; i < n; ++i) {
      a[i] = out[i] ? 0. : stress[n * s + i];
      for (PetscInt k = 0; k < i && !out[i]; ++k) a[i] -= L[i][k] * a[k];
      a[i] /= L[i][i];
    }
    for (PetscInt i = n - 1; i >= 0; --i) {
      for (PetscInt k = i + 1; k < n; ++k) a[i] -= out[k] ? 0. : L[k][i] * a[k];
      a[i] = out[i] ? 0. : a[i] / L[i][i];
    }
  }
}

/* The same polynomials, as far as they are of up to a degree in each coordinate, about an origin moved by d: x^i becomes the sum of
   binomial(i,k) d^(i-k) x^k */
void AbutPatchShift_Private(const AbutPatchSpace *space, PetscInt degree, const PetscReal a[], const PetscReal d[2], PetscReal b[])
{
  static const PetscReal binomial[5][5] = {
    {1., 0., 0., 0., 0.},
    {1., 1., 0., 0., 0.},
    {1., 2., 1., 0., 0.},
    {1., 3., 3., 1., 0.},
    {1., 4., 6., 4., 1.}
  };
  PetscReal power[2][ABUT_POWERS_MAX];

  AbutPowers_Private(space->order, d, power);
  for (PetscInt k = 0; k < space->coefs; ++k) b[k] = 0.;
  for (PetscInt i = 0; i < space->terms; ++i)
    for (PetscInt k = 0; k <= i; ++k) {
      const PetscInt *from = space->power[i], *to = space->power[k];
      PetscReal       f;

      if (to[0] > from[0] || to[1] > from[1] || from[0] > degree || from[1] > degree) continue;
      f = binomial[from[0]][to[0]] * binomial[from[1]][to[1]] * power[0][from[0] - to[0]] * power[1][from[1] - to[1]];
      for (PetscInt s = 0; s < 3; ++s) b[space->terms * s + k] += f * a[space->terms * s + i];
    }
}

/* The polynomials at d from their origin */
void AbutPatchEvaluate_Private(const AbutPatchSpace *space, const PetscReal a[], const PetscReal d[2], PetscReal s[3])
{
  PetscReal power[2][ABUT_POWERS_MAX];

  AbutPowers_Private(space->order, d, power);
  s[0] = s[1] = s[2] = 0.;
  for (PetscInt i = 0; i < space->terms; ++i) {
    const PetscReal p = power[0][space->power[i][0]] * power[1][space->power[i][1]];

    for (PetscInt k = 0; k < 3; ++k) s[k] += p * a[space->terms * k + i];
  }
}

/* One over the root mean square distance of the fit from its samples: large where the stress is smooth. Below 3e-7 of the stress itself
   round-off hides the difference. */
PetscReal AbutPatchWeight_Private(const AbutPatchSpace *space, const PetscReal m[], const PetscReal coef[])
{
  const PetscInt   n      = space->terms;
  const PetscReal *stress = m + PetscSqr(2 * space->order + 1), square = stress[space->coefs];
  PetscReal        left = square;

  for (PetscInt i = 0; i < n; ++i) left -= coef[i] * stress[i] + coef[n + i] * stress[n + i] + 2. * coef[2 * n + i] * stress[2 * n + i];
  return square > 0. ? PetscSqrtReal(m[0] / PetscMax(left, 1e-13 * square)) : 1.;
}
