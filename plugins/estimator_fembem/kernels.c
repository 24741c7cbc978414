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

/* L = Int dt/w = r (1 + g), Int N_b dt/w = L/2 - g; series in r = (b - a)/m, m from z to the middle, |r| < 1/8: truncated below 1e-13 */
static inline PetscComplex FarSum(PetscComplex r2)
{
  return r2 * (1. / 12. + r2 * (1. / 80. + r2 * (1. / 448. + r2 * (1. / 2304.))));
}

/* The integrals without a logarithm's branch to care for: z is far from the element */
static void IntegrateFar(const FembemElement *e, PetscComplex m, PetscReal m2, FembemIntegrals *v)
{
  const PetscComplex r = e->t * PetscConjComplex(m) / m2, r2 = r * r, g = FarSum(r2), L = r * (1. + g),
                     ei2 = PetscConjComplex(e->em * e->em);
  const PetscReal    s0  = PetscRealPartComplex(r2 * (1. / 24. + r2 * (1. / 320. + r2 * (1. / 2688. + r2 * (1. / 18432.)))));
  const PetscReal    s1  = PetscRealPartComplex(r * (1. / 12. + r2 * (1. / 240. + r2 * (1. / 2240. + r2 * (1. / 16128.)))));
  const PetscComplex id2 = PetscCMPLX(0., 2. * FembemCross(m, e->t) / e->h);

  v->Eb = 0.5 * L - g;
  v->Ea = L - v->Eb;
  v->P0 = e->h * (0.5 * PetscLogReal(m2) - s0);
  v->P1 = 0.5 * v->P0 + e->h * s1;
  v->Q0 = ei2 * (e->h - id2 * PetscConjComplex(L));
  v->Q1 = ei2 * (0.5 * e->h - id2 * PetscConjComplex(v->Eb));
}

/* All integrals at z. own: z lies on the element itself and the limit from inside the body is meant */
void FembemElementIntegrate(const FembemElement *e, PetscComplex z, PetscBool own, FembemIntegrals *v)
{
  const PetscComplex wa = e->a - z, wb = e->b - z, m = 0.5 * (wa + wb);
  const PetscReal    m2 = FembemAbsSquare(m), h = e->h;

  if (m2 > FEMBEM_FAR * FEMBEM_FAR * h * h) {
    IntegrateFar(e, m, m2, v);
  } else {
    const PetscReal    ra = FembemAbsSquare(wa), rb = FembemAbsSquare(wb), la = 0.5 * PetscLogReal(ra), lb = 0.5 * PetscLogReal(rb);
    const PetscReal    cross = own ? 0. : FembemCross(ra <= rb ? wa : wb, e->t); /* from the nearer end: the other one costs digits */
    const PetscReal    sa = PetscRealPartComplex(e->em * wa), sb = PetscRealPartComplex(e->em * wb), d = cross / h;
    const PetscReal    arg = own ? PETSC_PI : atan2(cross, FembemDot(wa, wb));
    const PetscComplex L = PetscCMPLX(lb - la, arg), ei2 = PetscConjComplex(e->em * e->em), id2 = PetscCMPLX(0., 2. * d);

    v->Eb = PetscCMPLX(-sa, d) / h * L + 1.;
    v->Ea = L - v->Eb;
    v->P0 = sb * lb - sa * la - h + PetscAbsReal(d * arg);
    v->P1 = (0.5 * (rb * lb - ra * la) - 0.25 * (sb * sb - sa * sa) - sa * v->P0) / h;
    v->Q0 = ei2 * (h - id2 * PetscConjComplex(L));
    v->Q1 = ei2 * (0.5 * h - id2 * PetscConjComplex(v->Eb));
  }
}

/* u' = du/dt is constant; the u-kernel is integrated by parts round each closed contour, so that only u' enters:
   p = 2 mu u' + i T em, q = -i kappa conj(T) em - 2 mu conj(u') em^2 */
void FembemSourceSet(FembemSource *s, PetscComplex a, PetscComplex b, PetscComplex ua, PetscComplex ub, PetscComplex Ta, PetscComplex Tb,
                     FembemMaterial mat)
{
  PetscComplex du, iem, q;

  FembemElementSet(&s->e, a, b);
  du    = 2. * mat.mu * (ub - ua) / s->e.t;
  iem   = PetscCMPLX(-PetscImaginaryPartComplex(s->e.em), PetscRealPartComplex(s->e.em));
  q     = -PetscConjComplex(du) * s->e.em * s->e.em;
  s->pa = du + iem * Ta;
  s->dp = iem * (Tb - Ta);
  s->p1 = s->dp / s->e.t;
  s->qa = q - mat.kappa * iem * PetscConjComplex(Ta);
  s->dq = -mat.kappa * iem * PetscConjComplex(Tb - Ta);
  s->q1 = s->dq / s->e.t;
}

/* Adds the element's part of Int p dt/w and Int (q/w - conj(w) p/w^2) dt */
void FembemSourceAdd(const FembemSource *s, PetscComplex z, PetscComplex *phi, PetscComplex *S)
{
  const FembemElement *e  = &s->e;
  const PetscComplex   wa = e->a - z, wb = e->b - z, m = 0.5 * (wa + wb);
  const PetscReal      m2 = FembemAbsSquare(m), h = e->h;
  PetscComplex         I1, I2, J1;
  PetscReal            d;

  if (m2 > FEMBEM_FAR * FEMBEM_FAR * h * h) {
    const PetscComplex inv = PetscConjComplex(m) / m2, r = e->t * inv, r2 = r * r, g = FarSum(r2), L = r + r * g, c = 0.25 * r2,
                       p = s->pa + 0.5 * s->dp;

    d  = FembemCross(m, e->t) / h;
    I1 = p * L - s->dp * g;
    J1 = (s->qa + 0.5 * s->dq) * L - s->dq * g;
    I2 = inv * r *
         (p * (1. + c * (1. + c * (1. + c * (1. + c * (1. + c))))) -
          s->dp * r * (1. / 6. + r2 * (0.05 + r2 * (3. / 224. + r2 * (1. / 288. + r2 * (10. / 11264.))))));
  } else {
    const PetscReal    ra = FembemAbsSquare(wa), rb = FembemAbsSquare(wb), cross = FembemCross(ra <= rb ? wa : wb, e->t); /* as above */
    const PetscComplex L  = PetscCMPLX(0.5 * PetscLogReal(rb / ra), atan2(cross, FembemDot(wa, wb)));
    const PetscComplex p0 = s->pa - s->p1 * wa, q0 = s->qa - s->q1 * wa; /* the densities continued to z */

    d  = cross / h;
    I1 = p0 * L + s->dp;
    J1 = q0 * L + s->dq;
    I2 = p0 * e->t * PetscConjComplex(wa * wb) / (ra * rb) + s->p1 * L;
  }
  *phi += I1;
  *S += J1 - e->em * (e->em * I1 + PetscCMPLX(0., 2. * d) * I2);
}
