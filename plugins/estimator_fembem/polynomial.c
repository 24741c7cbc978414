#include "kernels.h"

/*
   Densities of degree order on an element, t = (a + b)/2 + x (b - a)/2 with x in [-1,1], by Legendre's polynomials P_n(x). With z at
   zeta on the same scale and Legendre's functions of the second kind (F. Neumann's formula; E. W. Hobson, Spherical and Ellipsoidal
   Harmonics, ch. 2)
     Int P_n dt/(t-z) = -2 Q_n(zeta),   Int P_n dt/(t-z)^2 = -4 Q_n'(zeta)/(b-a),   (zeta^2 - 1) Q_n' = n (zeta Q_n - Q_(n-1)).
*/

/* P_0..P_order at x */
void FembemLegendreP(PetscInt order, PetscReal x, PetscReal P[])
{
  P[0] = 1.;
  P[1] = x;
  for (PetscInt n = 1; n < order; ++n) P[n + 1] = ((2. * n + 1.) * x * P[n] - n * P[n - 1]) / (n + 1.);
}

#define FEMBEM_UPWARDS 1.25 /* s up to which; rho = 2 */

/* Q_0..Q_order. Round the element, on the ellipse |wa| + |wb| = s h, they fall with n like rho^-n, rho = s + (s^2 - 1)^(1/2), while the
   other solution of their recurrence, P_n, grows like rho^n: it may go upwards from the logarithm as long as rho is small. Further away it
   goes downwards (J. C. P. Miller's algorithm; W. Gautschi, SIAM Rev. 9, 1967), started so high that rho^(-2 n) is round-off there, and its
   last step, zeta Q_0 - Q_1 = 1, gives the scale: no digit is lost, near or far.
   own: z lies on the element itself and the limit from its left is meant */
void FembemLegendreQ(PetscInt order, const FembemElement *e, PetscComplex wa, PetscComplex wb, PetscBool own, PetscComplex Q[])
{
  const PetscComplex zeta = FembemReference(e, wa, wb);
  const PetscReal    ra = FembemAbsSquare(wa), rb = FembemAbsSquare(wb), s = (PetscSqrtReal(ra) + PetscSqrtReal(rb)) / e->h;

  if (s < FEMBEM_UPWARDS) {
    const PetscReal arg = own ? PETSC_PI : atan2(FembemAreaFrom(e, wa, wb), FembemDot(wa, wb));

    Q[0] = -0.5 * PetscCMPLX(0.5 * PetscLogReal(rb / ra), arg);
    Q[1] = zeta * Q[0] - 1.;
    for (PetscInt n = 1; n < order; ++n) Q[n + 1] = ((2. * n + 1.) * zeta * Q[n] - n * Q[n - 1]) / (n + 1.);
  } else {
    const PetscInt start = order + 1 + (PetscInt)(18.4 / PetscLogReal(s + PetscSqrtReal(s * s - 1.))); /* exp(-2*18.4) = 1e-16 */
    PetscComplex   above = 0., q = 1.;

    for (PetscInt n = start; n > 0; --n) {
      const PetscComplex below = (2. + 1. / n) * zeta * q - (1. + 1. / n) * above;

      above = q;
      q     = below;
      if (n <= order + 1) Q[n - 1] = q;
    }
    q = 1. / (zeta * Q[0] - Q[1]);
    for (PetscInt n = 0; n <= order; ++n) Q[n] *= q;
  }
}

PetscErrorCode FembemBasisSet(PetscInt order, FembemBasis *basis)
{
  PetscReal x[ABUT_SIDE_NODES_MAX], w[ABUT_SIDE_NODES_MAX], P[ABUT_SIDE_NODES_MAX];

  PetscFunctionBegin;
  PetscCall(PetscMemzero(basis, sizeof(*basis)));
  basis->order = order;
  PetscCall(AbutGetLobattoNodes(order, x, w));
  for (PetscInt k = 0; k <= order; ++k) {
    FembemLegendreP(order, x[k], P);
    /* the sum over the points is the integral, but for the square of the last polynomial: 2/order instead of 2/(2 order + 1) */
    for (PetscInt n = 0; n <= order; ++n) basis->coefficient[n][k] = (n < order ? n + 0.5 : 0.5 * order) * w[k] * P[n];
  }
  /* P_n' = (2n-1) P_(n-1) + (2n-5) P_(n-3) + ... */
  for (PetscInt n = order - 1; n >= 0; --n)
    for (PetscInt k = 0; k <= order; ++k)
      basis->derivative[n][k] = (2. * n + 1.) *
                                (basis->coefficient[n + 1][k] + (n + 2 < order ? basis->derivative[n + 2][k] / (2. * n + 5.) : 0.));
  for (PetscInt n = 0; n <= order; ++n)
    for (PetscInt j = 0; j <= order; ++j)
      for (PetscInt k = 0; k <= order; ++k) basis->mass[j][k] += 2. / (2. * n + 1.) * basis->coefficient[n][j] * basis->coefficient[n][k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Displacements u and tractions T at the Gauss-Lobatto points from a to b. The u-kernel is integrated by parts round each closed contour,
   so that only u' = du/dt enters: p = 2 mu u' + i T em, q = -i kappa conj(T) em - 2 mu conj(u') em^2 */
void FembemSourceSet(FembemSource *s, const FembemBasis *basis, PetscComplex a, PetscComplex b, const PetscComplex u[],
                     const PetscComplex T[], FembemMaterial mat)
{
  PetscComplex em, iem;

  FembemElementSet(&s->e, a, b);
  s->order = basis->order;
  em       = s->e.em;
  iem      = PetscCMPLX(-PetscImaginaryPartComplex(em), PetscRealPartComplex(em));
  for (PetscInt n = 0; n <= s->order; ++n) {
    PetscComplex du = 0., Tn = 0.;

    for (PetscInt k = 0; k <= s->order; ++k) {
      du += basis->derivative[n][k] * u[k];
      Tn += basis->coefficient[n][k] * T[k];
    }
    du *= 4. * mat.mu / s->e.t;
    s->p[n] = du + iem * Tn;
    s->q[n] = -PetscConjComplex(du) * em * em - mat.kappa * iem * PetscConjComplex(Tn);
  }
}
