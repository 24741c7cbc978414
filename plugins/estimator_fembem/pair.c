#include "fembemimpl.h"

/* Outer integral of one pair of elements; the inner one is exact. Near pairs: Gauss's rule with 8 points after s = x^3 (10 - 15 x + 6
   x^2), which takes the logarithms out of the ends (a patch test is met to 4e-6, a smooth problem to 1e-4 of its discretisation error).
   The further away the inner element, the fewer points of the plain rule give the same; a much smaller one nearby has the outer one
   halved. On a regular mesh distances and lengths are often equal to these limits: FEMBEM_SLACK keeps round-off, and so the unit of
   length, from deciding. */
typedef struct {
  PetscReal from; /* smallest distance of the inner element, in lengths of the outer one */
  PetscInt  n;
  PetscReal x[8], w[8]; /* points and weights on [0,1] */
} OuterRule;

/* clang-format off */
static const OuterRule rules[] = {
  {16., 2, {0.21132486540518712, 0.78867513459481288},
           {0.5, 0.5}},
  {3.,  3, {0.11270166537925831, 0.5, 0.88729833462074169},
           {0.27777777777777778, 0.44444444444444444, 0.27777777777777778}},
  {1.,  5, {0.046910077030668004, 0.23076534494715845, 0.5, 0.76923465505284155, 0.953089922969332},
           {0.11846344252809454, 0.23931433524968324, 0.28444444444444444, 0.23931433524968324, 0.11846344252809454}},
  {0.3, 8, {0.019855071751231884, 0.10166676129318663, 0.2372337950418355, 0.40828267875217510,
            0.5917173212478249, 0.7627662049581645, 0.89833323870681337, 0.98014492824876812},
           {0.05061426814518813, 0.11119051722668724, 0.15685332293894364, 0.18134189168918099,
            0.18134189168918099, 0.15685332293894364, 0.11119051722668724, 0.05061426814518813}},
  {-1., 8, {7.5960760500378814e-5, 0.008971044882962048, 0.090512037665132928, 0.33184874283894914,
            0.66815125716105086, 0.90948796233486707, 0.99102895511703795, 0.99992403923949962},
           {0.00057506605386579939, 0.027824150963004972, 0.1540816700644081, 0.31751911291872113,
            0.31751911291872113, 0.1540816700644081, 0.027824150963004972, 0.00057506605386579939}}
};
/* clang-format on */

/* The map c -> alpha c + beta conj(c) as a real 2x2 matrix, added to a block of 4x4 at the given ends */
static void AddMap(PetscReal block[], PetscInt row, PetscInt col, PetscComplex alpha, PetscComplex beta)
{
  PetscReal *b = block + 8 * row + 2 * col;

  b[0] += PetscRealPartComplex(alpha) + PetscRealPartComplex(beta);
  b[1] += PetscImaginaryPartComplex(beta) - PetscImaginaryPartComplex(alpha);
  b[4] += PetscImaginaryPartComplex(beta) + PetscImaginaryPartComplex(alpha);
  b[5] += PetscRealPartComplex(alpha) - PetscRealPartComplex(beta);
}

/* What the outer integration sums: of N_row times the inner integrals */
typedef struct {
  PetscReal    P[2][2];
  PetscComplex Q[2][2], E[2][2];
} Sums;

static void AddV(const Sums *s, FembemMaterial m, PetscReal V[])
{
  const PetscReal c = 1. / (4. * PETSC_PI * m.mu * (1. + m.kappa));

  for (PetscInt k = 0; k < 2; ++k)
    for (PetscInt l = 0; l < 2; ++l) AddMap(V, k, l, -2. * m.kappa * c * s->P[k][l], c * s->Q[k][l]);
}

/* f = 1/(2 pi i (1 + kappa)); (kappa E u - conj(E) u - Q0/h conj(u_b - u_a)) f */
static void AddW(const Sums *s, FembemMaterial m, PetscReal h, PetscReal W[])
{
  const PetscComplex f = PetscCMPLX(0., -1. / (2. * PETSC_PI * (1. + m.kappa)));

  for (PetscInt k = 0; k < 2; ++k) {
    const PetscComplex beta = f * (s->Q[k][0] + s->Q[k][1]) / h;

    for (PetscInt l = 0; l < 2; ++l) AddMap(W, k, l, f * (m.kappa * s->E[k][l] - PetscConjComplex(s->E[k][l])), l ? -beta : beta);
  }
}

/* Re Int conj(dv/ds) c (Q0 conj(du/ds) - 2 P0 du/ds) */
static void AddD(const Sums *s, FembemMaterial m, PetscReal hh, PetscReal D[])
{
  const PetscReal    c = 2. * m.mu / (2. * PETSC_PI * (1. + m.kappa) * hh), P = s->P[0][0] + s->P[0][1] + s->P[1][0] + s->P[1][1];
  const PetscComplex Q = s->Q[0][0] + s->Q[0][1] + s->Q[1][0] + s->Q[1][1];

  for (PetscInt k = 0; k < 2; ++k)
    for (PetscInt l = 0; l < 2; ++l) AddMap(D, k, l, (k == l ? -2. : 2.) * c * P, (k == l ? c : -c) * Q);
}

/* Adds the part of the outer element from s[0] to s[1], in lengths of it */
static void AddPart(const FembemElement *outer, const FembemElement *inner, PetscBool own, const PetscReal s[2], Sums *sums)
{
  const PetscReal    size = (s[1] - s[0]) * outer->h, middle = 0.5 * (s[0] + s[1]);
  const PetscComplex w        = outer->a - inner->a + middle * outer->t;
  const PetscReal    foot     = PetscMax(0., PetscMin(1., FembemDot(w, inner->t) / (inner->h * inner->h)));
  const PetscReal    distance = PetscAbsComplex(w - foot * inner->t) / size - 0.5; /* a lower bound */
  const OuterRule   *rule     = rules;
  FembemIntegrals    v;

  if (distance < 1. - FEMBEM_SLACK && size > (2. + FEMBEM_SLACK) * inner->h && !own) {
    const PetscReal half[2][2] = {
      {s[0],   middle},
      {middle, s[1]  }
    };

    AddPart(outer, inner, own, half[0], sums);
    AddPart(outer, inner, own, half[1], sums);
    return;
  }
  while (distance < rule->from - FEMBEM_SLACK) ++rule;
  for (PetscInt g = 0; g < rule->n; ++g) {
    const PetscReal x = s[0] + (s[1] - s[0]) * rule->x[g], w = rule->w[g] * size, N[2] = {(1. - x) * w, x * w};

    FembemElementIntegrate(inner, x < 0.5 ? outer->a + x * outer->t : outer->b - (1. - x) * outer->t, own, &v);
    for (PetscInt k = 0; k < 2; ++k) {
      sums->P[k][0] += N[k] * (v.P0 - v.P1);
      sums->P[k][1] += N[k] * v.P1;
      sums->Q[k][0] += N[k] * (v.Q0 - v.Q1);
      sums->Q[k][1] += N[k] * v.Q1;
      sums->E[k][0] += N[k] * v.Ea;
      sums->E[k][1] += N[k] * v.Eb;
    }
  }
}

/* own: both are the same element */
PetscErrorCode FembemPair(const FembemElement *outer, const FembemElement *inner, PetscBool own, FembemMaterial mat, FembemWanted wanted,
                          FembemBlocks *blocks)
{
  const PetscReal whole[2] = {0., 1.};
  Sums            sums     = {0};

  PetscFunctionBegin;
  AddPart(outer, inner, own, whole, &sums);
  PetscCall(PetscMemzero(blocks, sizeof(*blocks)));
  if (wanted.V) AddV(&sums, mat, blocks->V);
  if (wanted.W) AddW(&sums, mat, inner->h, blocks->W);
  if (wanted.D) AddD(&sums, mat, outer->h * inner->h, blocks->D);
  PetscFunctionReturn(PETSC_SUCCESS);
}
