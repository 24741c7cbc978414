#include "kernels.h"

/* Beyond this many element lengths the closed forms are expanded about the middle: without the logarithms' cancellation, and cheaper */
#define FEMBEM_FAR 8.

void FembemElementSet(FembemElement *e, PetscComplex a, PetscComplex b)
{
  e->a  = a;
  e->b  = b;
  e->t  = b - a;
  e->h  = PetscAbsComplex(b - a);
  e->em = PetscConjComplex(b - a) / e->h;
}

/* L = Int dt/w = r (1 + g), Int x dt/w = -2 g; series in r = (b - a)/m, m from z to the middle, |r| < 1/8: truncated below 1e-13 */
static inline PetscComplex FarSum(PetscComplex r2)
{
  return r2 * (1. / 12. + r2 * (1. / 80. + r2 * (1. / 448. + r2 * (1. / 2304.))));
}

/* P and E of order 1, without a logarithm's branch to care for: z is far from the element */
static void IntegrateFar(const FembemElement *e, PetscComplex m, PetscReal m2, FembemIntegrals *v)
{
  const PetscComplex r = e->t * PetscConjComplex(m) / m2, r2 = r * r, g = FarSum(r2);
  const PetscReal    s0 = PetscRealPartComplex(r2 * (1. / 24. + r2 * (1. / 320. + r2 * (1. / 2688. + r2 * (1. / 18432.)))));
  const PetscReal    s1 = PetscRealPartComplex(r * (1. / 12. + r2 * (1. / 240. + r2 * (1. / 2240. + r2 * (1. / 16128.)))));

  v->E[0] = r * (1. + g);
  v->E[1] = -2. * g;
  v->P[0] = e->h * (0.5 * PetscLogReal(m2) - s0);
  v->P[1] = 2. * e->h * s1;
}

/* P and E of order 1 */
static void IntegrateNear(const FembemElement *e, PetscComplex wa, PetscComplex wb, PetscReal d, PetscBool own, FembemIntegrals *v)
{
  const PetscReal    ra = FembemAbsSquare(wa), rb = FembemAbsSquare(wb), la = 0.5 * PetscLogReal(ra), lb = 0.5 * PetscLogReal(rb);
  const PetscReal    sa = PetscRealPartComplex(e->em * wa), sb = PetscRealPartComplex(e->em * wb);
  const PetscReal    arg = own ? PETSC_PI : atan2(d * e->h, FembemDot(wa, wb));
  const PetscComplex L   = PetscCMPLX(lb - la, arg);

  v->E[0] = L;
  v->E[1] = PetscCMPLX(-sa - sb, 2. * d) / e->h * L + 2.;
  v->P[0] = sb * lb - sa * la - e->h + PetscAbsReal(d * arg);
  v->P[1] = (rb * lb - ra * la - 0.5 * (sb * sb - sa * sa) - (sa + sb) * v->P[0]) / e->h;
}

/* P and E of any order: Int P_n ln|w| ds by parts, Int P_n dx = (P_(n+1) - P_(n-1))/(2n+1) */
static void IntegrateLegendre(const FembemElement *e, PetscInt order, PetscComplex wa, PetscComplex wb, PetscBool own, FembemIntegrals *v)
{
  PetscComplex Q[ABUT_SIDE_NODES_MAX + 1];

  FembemLegendreQ(order + 1, e, wa, wb, own, Q);
  v->E[0] = -2. * Q[0];
  v->P[0] = e->h * (0.25 * PetscLogReal(FembemAbsSquare(wa) * FembemAbsSquare(wb)) + PetscRealPartComplex(Q[1]));
  for (PetscInt n = 1; n <= order; ++n) {
    v->E[n] = -2. * Q[n];
    v->P[n] = e->h * PetscRealPartComplex(Q[n + 1] - Q[n - 1]) / (2. * n + 1.);
  }
}

/* All integrals at z up to an order. own: z lies on the element itself and the limit from inside the body is meant */
void FembemElementIntegrate(const FembemElement *e, PetscInt order, PetscComplex z, PetscBool own, FembemIntegrals *v)
{
  const PetscComplex wa = e->a - z, wb = e->b - z, m = 0.5 * (wa + wb), ei2 = PetscConjComplex(e->em * e->em);
  const PetscReal    m2 = FembemAbsSquare(m), d = own ? 0. : FembemAreaFrom(e, wa, wb) / e->h;

  if (order > 1) IntegrateLegendre(e, order, wa, wb, own, v);
  else if (m2 > FEMBEM_FAR * FEMBEM_FAR * e->h * e->h) IntegrateFar(e, m, m2, v);
  else IntegrateNear(e, wa, wb, d, own, v);
  /* w/conj(w) = ei2 (1 - 2 i d/conj(em w)) */
  for (PetscInt n = 0; n <= order; ++n) v->Q[n] = ei2 * ((n ? 0. : e->h) - PetscCMPLX(0., 2. * d) * PetscConjComplex(v->E[n]));
}

/* Int p dt/w, Int q dt/w, Int p dt/w^2 of linear densities; cross is twice the area of the triangle of z and the element */
static void SourceIntegrateLinear(const FembemSource *s, PetscComplex wa, PetscComplex wb, PetscReal cross, PetscComplex v[3])
{
  const FembemElement *e  = &s->e;
  const PetscComplex   m  = 0.5 * (wa + wb);
  const PetscReal      m2 = FembemAbsSquare(m);

  if (m2 > FEMBEM_FAR * FEMBEM_FAR * e->h * e->h) {
    const PetscComplex inv = PetscConjComplex(m) / m2, r = e->t * inv, r2 = r * r, g = FarSum(r2), L = r + r * g, c = 0.25 * r2;

    v[0] = s->p[0] * L - 2. * s->p[1] * g;
    v[1] = s->q[0] * L - 2. * s->q[1] * g;
    v[2] = inv * r *
           (s->p[0] * (1. + c * (1. + c * (1. + c * (1. + c * (1. + c))))) -
            s->p[1] * r * (1. / 3. + r2 * (0.1 + r2 * (3. / 112. + r2 * (1. / 144. + r2 * (10. / 5632.))))));
  } else {
    const PetscReal    ra = FembemAbsSquare(wa), rb = FembemAbsSquare(wb);
    const PetscComplex L    = PetscCMPLX(0.5 * PetscLogReal(rb / ra), atan2(cross, FembemDot(wa, wb)));
    const PetscComplex zeta = FembemReference(e, wa, wb), p = s->p[0] + zeta * s->p[1]; /* continued to z */

    v[0] = p * L + 2. * s->p[1];
    v[1] = (s->q[0] + zeta * s->q[1]) * L + 2. * s->q[1];
    v[2] = p * e->t * PetscConjComplex(wa * wb) / (ra * rb) + 2. / e->h * e->em * s->p[1] * L;
  }
}

/* The same by Legendre's functions; no digit is lost at any distance */
static void SourceIntegrate(const FembemSource *s, PetscComplex wa, PetscComplex wb, PetscComplex v[3])
{
  const PetscComplex zeta = FembemReference(&s->e, wa, wb);
  PetscComplex       Q[ABUT_SIDE_NODES_MAX], second = s->p[0];

  FembemLegendreQ(s->order, &s->e, wa, wb, PETSC_FALSE, Q);
  v[0] = s->p[0] * Q[0];
  v[1] = s->q[0] * Q[0];
  for (PetscInt n = 1; n <= s->order; ++n) {
    v[0] += s->p[n] * Q[n];
    v[1] += s->q[n] * Q[n];
    second -= n * s->p[n] * (zeta * Q[n] - Q[n - 1]);
  }
  v[0] *= -2.;
  v[1] *= -2.;
  v[2] = second * s->e.t / (wa * wb);
}

/* Adds the element's part of Int p dt/w and Int (q/w - conj(w) p/w^2) dt */
void FembemSourceAdd(const FembemSource *s, PetscComplex z, PetscComplex *phi, PetscComplex *S)
{
  const FembemElement *e  = &s->e;
  const PetscComplex   wa = e->a - z, wb = e->b - z;
  const PetscReal      cross = FembemAreaFrom(e, wa, wb);
  PetscComplex         v[3];

  if (s->order == 1) SourceIntegrateLinear(s, wa, wb, cross, v);
  else SourceIntegrate(s, wa, wb, v);
  *phi += v[0];
  *S += v[1] - e->em * (e->em * v[0] + PetscCMPLX(0., 2. * cross / e->h) * v[2]);
}
