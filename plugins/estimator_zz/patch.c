#include "patch.h"
#include <complex.h>

void AbutPatchSpaceSetUp_Private(PetscInt degree, AbutPatchSpace *space)
{
  space->degree  = degree;
  space->coefs   = 4 * degree + 3;
  space->moments = 2 * (degree + 1) * (degree + 1) + space->coefs;
}

/* s11 + s22 = 4 Re phi', s22 - s11 + 2 i s12 = 2 S, S = conj(z) phi'' + psi' */
static void AbutPotentialStress_Private(double complex dphi, double complex S, PetscReal s[3])
{
  s[0] = 2. * creal(dphi) - creal(S);
  s[1] = 2. * creal(dphi) + creal(S);
  s[2] = cimag(S);
}

/* The stresses at d from the vertex of phi' = z^k, i z^k and psi' = z^k, i z^k, k = 0, 1, ...; phi' = i has none */
static void AbutPatchStresses_Private(const AbutPatchSpace *space, const PetscReal d[2], PetscReal s[][3])
{
  const double complex i = _Complex_I, z = d[0] + i * d[1];
  double complex       power = 1., below = 0.; /* z^k, z^(k-1) */

  for (PetscInt n = 0, k = 0; n < space->coefs; ++k) {
    AbutPotentialStress_Private(power, k * conj(z) * below, s[n++]);
    if (k) AbutPotentialStress_Private(i * power, i * k * conj(z) * below, s[n++]);
    AbutPotentialStress_Private(0., power, s[n++]);
    AbutPotentialStress_Private(0., i * power, s[n++]);
    below = power;
    power *= z;
  }
}

/* Where the sum of z^a conj(z)^b is among the moments, a >= b: by a+b, then by b */
static PetscInt AbutMomentPlace_Private(PetscInt a, PetscInt b)
{
  return 2 * ((a + b + 1) * (a + b + 1) / 4 + b);
}

static double complex AbutMoment_Private(const PetscReal m[], PetscInt a, PetscInt b)
{
  const PetscReal *sum = m + AbutMomentPlace_Private(PetscMax(a, b), PetscMin(a, b));

  return a >= b ? sum[0] + _Complex_I * sum[1] : sum[0] - _Complex_I * sum[1];
}

/* One more sample of the stress, at d from the vertex */
void AbutPatchAdd_Private(const AbutPatchSpace *space, const PetscReal d[2], const PetscReal s[3], PetscReal m[])
{
  const double complex z = d[0] + _Complex_I * d[1];
  PetscReal            own[ABUT_PATCH_COEFS_MAX][3], square = 1.; /* |z|^(2b) */

  for (PetscInt b = 0; b <= space->degree; ++b) {
    double complex power = square; /* z^a conj(z)^b */

    for (PetscInt a = b; a + b <= 2 * space->degree; ++a) {
      m[AbutMomentPlace_Private(a, b)] += creal(power);
      m[AbutMomentPlace_Private(a, b) + 1] += cimag(power);
      power *= z;
    }
    square *= creal(z * conj(z));
  }
  m += space->moments - space->coefs;
  AbutPatchStresses_Private(space, d, own);
  for (PetscInt i = 0; i < space->coefs; ++i) m[i] += own[i][0] * s[0] + own[i][1] * s[1] + 2. * own[i][2] * s[2];
}

/* Stress i of AbutPatchStresses_Private(): is it of phi' or of psi', and of c z^k */
static PetscBool AbutPatchTerm_Private(PetscInt i, PetscInt *k, double complex *c)
{
  const PetscInt at = i ? i + 1 : 0; /* with phi' = i in its place there are four of each k */

  *k = at / 4;
  *c = at % 2 ? _Complex_I : 1.;
  return (PetscBool)(at % 4 < 2);
}

/* The sum over the samples of the product of two of these stresses, s:r = 8 Re phi' Re phi'_r + 2 Re(S conj(S_r)) */
static PetscReal AbutPatchProduct_Private(const PetscReal m[], PetscInt i, PetscInt j)
{
  PetscInt        k, l;
  double complex  c, d;
  const PetscBool phi = AbutPatchTerm_Private(i, &k, &c), phir = AbutPatchTerm_Private(j, &l, &d);

  if (phi && phir)
    return 4. * creal(c * d * AbutMoment_Private(m, k + l, 0)) + (4. + 2. * k * l) * creal(c * conj(d) * AbutMoment_Private(m, k, l));
  if (phi) return k ? 2. * k * creal(c * conj(d) * AbutMoment_Private(m, k - 1, l + 1)) : 0.;
  if (phir) return l ? 2. * l * creal(d * conj(c) * AbutMoment_Private(m, l - 1, k + 1)) : 0.;
  return 2. * creal(c * conj(d) * AbutMoment_Private(m, k, l));
}

/* The factor of the normal equations; a stress that the samples do not tell apart from those before it is left out. The test is relative
   to the stress itself, so that neither it nor round-off depend on the unit of length. Of degree 5 the last one keeps 9e-5 of itself where
   two of four cells are half as large, 4e-8 in cells a thousand times as long as wide; what cannot be told leaves 1e-14. */
static void AbutPatchFactor_Private(PetscInt n, const PetscReal m[], PetscReal L[][ABUT_PATCH_COEFS_MAX], PetscBool out[])
{
  for (PetscInt i = 0; i < n; ++i) { /* Cholesky */
    PetscReal own = 0.;

    for (PetscInt j = 0; j <= i; ++j) {
      L[i][j] = own = AbutPatchProduct_Private(m, i, j);
      for (PetscInt k = 0; k < j; ++k) L[i][j] -= L[i][k] * L[j][k];
      if (j < i) L[i][j] = out[j] ? 0. : L[i][j] / L[j][j];
    }
    out[i]  = L[i][i] > 1e-9 * own ? PETSC_FALSE : PETSC_TRUE;
    L[i][i] = out[i] ? 1. : PetscSqrtReal(L[i][i]);
  }
}

/* Fits all stresses, or as many as the samples tell apart, so that any samples give an answer */
void AbutPatchFit_Private(const AbutPatchSpace *space, const PetscReal m[], PetscReal a[], PetscBool *all)
{
  const PetscInt   n      = space->coefs;
  const PetscReal *stress = m + space->moments - n;
  PetscReal        L[ABUT_PATCH_COEFS_MAX][ABUT_PATCH_COEFS_MAX];
  PetscBool        out[ABUT_PATCH_COEFS_MAX];

  AbutPatchFactor_Private(n, m, L, out);
  *all = PETSC_TRUE;
  for (PetscInt i = 0; i < n; ++i) {
    if (out[i]) *all = PETSC_FALSE;
    a[i] = out[i] ? 0. : stress[i];
    for (PetscInt k = 0; k < i && !out[i]; ++k) a[i] -= L[i][k] * a[k];
    a[i] /= L[i][i];
  }
  for (PetscInt i = n - 1; i >= 0; --i) {
    for (PetscInt k = i + 1; k < n; ++k) a[i] -= out[k] ? 0. : L[k][i] * a[k];
    a[i] = out[i] ? 0. : a[i] / L[i][i];
  }
}

/* The fitted stress at d from the vertex */
void AbutPatchEvaluate_Private(const AbutPatchSpace *space, const PetscReal a[], const PetscReal d[2], PetscReal s[3])
{
  PetscReal own[ABUT_PATCH_COEFS_MAX][3];

  AbutPatchStresses_Private(space, d, own);
  s[0] = s[1] = s[2] = 0.;
  for (PetscInt i = 0; i < space->coefs; ++i)
    for (PetscInt k = 0; k < 3; ++k) s[k] += a[i] * own[i][k];
}

/* A stress of degree 1 about an origin moved by d */
void AbutPatchShift_Private(const PetscReal a[], const PetscReal d[2], PetscReal b[])
{
  const double complex z = d[0] + _Complex_I * d[1], dphi = a[3] + _Complex_I * a[4], dpsi = a[5] + _Complex_I * a[6];
  const double complex S = conj(z) * dphi + z * dpsi;

  for (PetscInt i = 0; i < 7; ++i) b[i] = a[i];
  b[0] += creal(z * dphi);
  b[1] += creal(S);
  b[2] += cimag(S);
}
