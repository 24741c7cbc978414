#include <petscdt.h>
#include "fembemimpl.h"

/* Outer integral of one pair of elements; the inner one is exact. Near pairs: Gauss's rule after s = x^3 (10 - 15 x + 6 x^2), which takes
   the logarithms out of the ends. The further away the inner element, the fewer points of the plain rule give the same; a much smaller one
   nearby has the outer one halved. At order 1 a patch test is met to 4e-6, a smooth problem to 1e-4 of its discretisation error; from
   order 2 on, with finer rules, to 2e-8. On a regular mesh distances and lengths are often equal to these limits: FEMBEM_SLACK keeps
   round-off, and so the unit of length, from deciding. */
static const PetscReal rule_from[FEMBEM_RULES]      = {16., 3., 1., 0.3, -1.};
static const PetscInt  rule_points[2][FEMBEM_RULES] = {
  {2, 3, 5, 8,  8 },
  {5, 7, 9, 13, 24}
};

PetscErrorCode FembemPairingSet(const FembemBasis *basis, FembemMaterial mat, FembemPairing *pairing)
{
  PetscFunctionBegin;
  pairing->basis = *basis;
  pairing->mat   = mat;
  for (PetscInt i = 0; i < FEMBEM_RULES; ++i) {
    FembemRule *r = &pairing->rule[i];

    r->from = rule_from[i];
    r->n    = rule_points[basis->order > 1][i];
    PetscCall(PetscDTGaussQuadrature(r->n, 0., 1., r->x, r->w));
    for (PetscInt g = 0; r->from < 0. && g < r->n; ++g) {
      const PetscReal x = r->x[g];

      r->x[g] = x * x * x * (10. - 15. * x + 6. * x * x);
      r->w[g] *= 30. * PetscSqr(x * (1. - x));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the outer integration sums: polynomials of the outer element, one a row, times the inner integrals */
typedef PetscComplex Matrix[ABUT_SIDE_NODES_MAX][ABUT_SIDE_NODES_MAX];
typedef struct {
  Matrix P, Q, E;
} Sums;

/* From polynomials to nodes, or to the derivatives of their functions: out = A^T sums B */
static void Transform(PetscInt order, const FembemMatrix A, const FembemMatrix B, Matrix sums, Matrix out)
{
  Matrix half;

  for (PetscInt m = 0; m <= order; ++m)
    for (PetscInt l = 0; l <= order; ++l) {
      half[m][l] = 0.;
      for (PetscInt n = 0; n <= order; ++n) half[m][l] += sums[m][n] * B[n][l];
    }
  for (PetscInt k = 0; k <= order; ++k)
    for (PetscInt l = 0; l <= order; ++l) {
      out[k][l] = 0.;
      for (PetscInt m = 0; m <= order; ++m) out[k][l] += A[m][k] * half[m][l];
    }
}

/* The maps c -> alpha c + beta conj(c) of the entries as real 2x2 matrices */
static void SetMaps(PetscInt order, Matrix alpha, Matrix beta, PetscReal block[])
{
  const PetscInt n = 2 * (order + 1);

  for (PetscInt k = 0; k <= order; ++k)
    for (PetscInt l = 0; l <= order; ++l) {
      PetscReal   *b = block + 2 * n * k + 2 * l;
      PetscComplex p = alpha[k][l], q = beta[k][l];

      b[0]     = PetscRealPartComplex(p) + PetscRealPartComplex(q);
      b[1]     = PetscImaginaryPartComplex(q) - PetscImaginaryPartComplex(p);
      b[n]     = PetscImaginaryPartComplex(q) + PetscImaginaryPartComplex(p);
      b[n + 1] = PetscRealPartComplex(p) - PetscRealPartComplex(q);
    }
}

static void Scale(PetscInt order, PetscComplex factor, Matrix a)
{
  for (PetscInt k = 0; k <= order; ++k)
    for (PetscInt l = 0; l <= order; ++l) a[k][l] *= factor;
}

static void SetV(const FembemPairing *p, Sums *s, PetscReal V[])
{
  const PetscInt  order = p->basis.order;
  const PetscReal c     = 1. / (4. * PETSC_PI * p->mat.mu * (1. + p->mat.kappa));
  Matrix          alpha, beta;

  Transform(order, p->basis.coefficient, p->basis.coefficient, s->P, alpha);
  Transform(order, p->basis.coefficient, p->basis.coefficient, s->Q, beta);
  Scale(order, -2. * p->mat.kappa * c, alpha);
  Scale(order, c, beta);
  SetMaps(order, alpha, beta, V);
}

/* (kappa E u - conj(E) u - Q conj(du/ds)) f, f = 1/(2 pi i (1 + kappa)) */
static void SetW(const FembemPairing *p, Sums *s, PetscReal h, PetscReal W[])
{
  const PetscInt     order = p->basis.order;
  const PetscComplex f     = PetscCMPLX(0., -1. / (2. * PETSC_PI * (1. + p->mat.kappa)));
  Matrix             alpha, beta;

  Transform(order, p->basis.coefficient, p->basis.coefficient, s->E, alpha);
  Transform(order, p->basis.coefficient, p->basis.derivative, s->Q, beta);
  for (PetscInt k = 0; k <= order; ++k)
    for (PetscInt l = 0; l <= order; ++l) alpha[k][l] = f * (p->mat.kappa * alpha[k][l] - PetscConjComplex(alpha[k][l]));
  Scale(order, -2. / h * f, beta);
  SetMaps(order, alpha, beta, W);
}

/* Re Int conj(dv/ds) c (Q conj(du/ds) - 2 P du/ds) */
static void SetD(const FembemPairing *p, Sums *s, PetscReal hh, PetscReal D[])
{
  const PetscInt  order = p->basis.order;
  const PetscReal c     = 4. * p->mat.mu / (PETSC_PI * (1. + p->mat.kappa) * hh); /* 4/hh of it makes derivatives by x those by s */
  Matrix          alpha, beta;

  Transform(order, p->basis.derivative, p->basis.derivative, s->P, alpha);
  Transform(order, p->basis.derivative, p->basis.derivative, s->Q, beta);
  Scale(order, -2. * c, alpha);
  Scale(order, c, beta);
  SetMaps(order, alpha, beta, D);
}

/* Adds the part of the outer element from s[0] to s[1], in lengths of it */
static void AddPart(const FembemPairing *p, const FembemElement *outer, const FembemElement *inner, PetscBool own, const PetscReal s[2],
                    Sums *sums)
{
  const PetscInt     order = p->basis.order;
  const PetscReal    size = (s[1] - s[0]) * outer->h, middle = 0.5 * (s[0] + s[1]);
  const PetscComplex w        = outer->a - inner->a + middle * outer->t;
  const PetscReal    foot     = PetscMax(0., PetscMin(1., FembemDot(w, inner->t) / (inner->h * inner->h)));
  const PetscReal    distance = PetscAbsComplex(w - foot * inner->t) / size - 0.5; /* a lower bound */
  const FembemRule  *rule     = p->rule;
  FembemIntegrals    v;
  PetscReal          P[ABUT_SIDE_NODES_MAX];

  if (distance < 1. - FEMBEM_SLACK && size > (2. + FEMBEM_SLACK) * inner->h && !own) {
    const PetscReal half[2][2] = {
      {s[0],   middle},
      {middle, s[1]  }
    };

    AddPart(p, outer, inner, own, half[0], sums);
    AddPart(p, outer, inner, own, half[1], sums);
    return;
  }
  while (distance < rule->from - FEMBEM_SLACK) ++rule;
  for (PetscInt g = 0; g < rule->n; ++g) {
    const PetscReal x = s[0] + (s[1] - s[0]) * rule->x[g];

    FembemElementIntegrate(inner, order, x < 0.5 ? outer->a + x * outer->t : outer->b - (1. - x) * outer->t, own, &v);
    FembemLegendreP(order, 2. * x - 1., P);
    for (PetscInt m = 0; m <= order; ++m)
      for (PetscInt n = 0; n <= order; ++n) {
        const PetscReal weight = P[m] * rule->w[g] * size;

        sums->P[m][n] += weight * v.P[n];
        sums->Q[m][n] += weight * v.Q[n];
        sums->E[m][n] += weight * v.E[n];
      }
  }
}

/* own: both are the same element */
PetscErrorCode FembemPair(const FembemPairing *p, const FembemElement *outer, const FembemElement *inner, PetscBool own,
                          FembemWanted wanted, FembemBlocks *blocks)
{
  const PetscReal whole[2] = {0., 1.};
  Sums            sums;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(&sums, sizeof(sums)));
  AddPart(p, outer, inner, own, whole, &sums);
  if (wanted.V) SetV(p, &sums, blocks->V);
  if (wanted.W) SetW(p, &sums, inner->h, blocks->W);
  if (wanted.D) SetD(p, &sums, outer->h * inner->h, blocks->D);
  PetscFunctionReturn(PETSC_SUCCESS);
}
