#pragma once

#include <petscdt.h>
#include "ck.h"
#include "fembemimpl.h"

/* Boundaries made by hand for the tests of estimator_fembem: rectangles, a hole if wanted, any condition on any side, data of a field */

/* A stress field in balance with its displacement; t and u at a point */
typedef struct {
  PetscReal young, poisson;
  void (*stress)(const PetscReal x[2], PetscReal s[3]);
  void (*displacement)(PetscReal young, PetscReal poisson, const PetscReal x[2], PetscReal u[2]);
} Field;

/* Uniform stress, and a rotation */
static const PetscReal uniform_stress[3] = {1.2, -0.7, 0.45};
static inline void     UniformStress(PETSC_UNUSED const PetscReal x[2], PetscReal s[3])
{
  for (PetscInt k = 0; k < 3; ++k) s[k] = uniform_stress[k];
}
static inline void UniformDisplacement(PetscReal E, PetscReal nu, const PetscReal x[2], PetscReal u[2])
{
  const PetscReal *s = uniform_stress, e11 = (1. + nu) / E * ((1. - nu) * s[0] - nu * s[1]),
                  e22 = (1. + nu) / E * ((1. - nu) * s[1] - nu * s[0]), e12 = (1. + nu) / E * s[2];

  u[0] = 0.3 / E + e11 * x[0] + (e12 - 0.2 / E) * x[1];
  u[1] = -0.1 / E + (e12 + 0.2 / E) * x[0] + e22 * x[1];
}

/* Pure bending: s11 = x2 */
static inline void BendingStress(const PetscReal x[2], PetscReal s[3])
{
  s[0] = x[1];
  s[1] = s[2] = 0.;
}
static inline void BendingDisplacement(PetscReal E, PetscReal nu, const PetscReal x[2], PetscReal u[2])
{
  u[0] = (1. - nu * nu) / E * x[0] * x[1];
  u[1] = -0.5 * (1. - nu * nu) / E * x[0] * x[0] - 0.5 * nu * (1. + nu) / E * x[1] * x[1];
}

/* Muskhelishvili's potentials phi = sum a_k z^k, psi = sum b_k z^k up to a degree, which the displacement then has */
static PetscInt            polynomial_degree = 4;
static inline PetscComplex Potential(PetscComplex z, PetscComplex first, PetscInt derivative)
{
  PetscComplex sum = 0., power = 1., a = first;

  for (PetscInt k = derivative; k <= polynomial_degree; ++k, power *= z) {
    PetscReal factor = 1.;

    for (PetscInt i = 0; i < derivative; ++i) factor *= k - i;
    a = first * PetscExpComplex(PetscCMPLX(-0.7 * k, 2. * k));
    if (k) sum += factor * a * power;
  }
  return sum;
}
static inline void PolynomialStress(const PetscReal x[2], PetscReal s[3])
{
  const PetscComplex z = PetscCMPLX(x[0], x[1]), dphi = Potential(z, 1., 1),
                     S = PetscConjComplex(z) * Potential(z, 1., 2) + Potential(z, PetscCMPLX(-1., 2.), 1);

  s[0] = 2. * PetscRealPartComplex(dphi) - PetscRealPartComplex(S);
  s[1] = 2. * PetscRealPartComplex(dphi) + PetscRealPartComplex(S);
  s[2] = PetscImaginaryPartComplex(S);
}
static inline void PolynomialDisplacement(PetscReal E, PetscReal nu, const PetscReal x[2], PetscReal u[2])
{
  const PetscComplex z = PetscCMPLX(x[0], x[1]), v = (1. + nu) / E *
                                                     ((3. - 4. * nu) * Potential(z, 1., 0) - z * PetscConjComplex(Potential(z, 1., 1)) -
                                                      PetscConjComplex(Potential(z, PetscCMPLX(-1., 2.), 0)));

  u[0] = PetscRealPartComplex(v);
  u[1] = PetscImaginaryPartComplex(v);
}

/* The largest difference of two arrays, over the largest value of the second one */
static inline PetscReal BoundaryDifference(PetscInt n, const PetscReal x[], const PetscReal y[])
{
  PetscReal worst = 0., largest = 0.;

  for (PetscInt i = 0; i < n; ++i) {
    worst   = PetscMax(worst, PetscAbsReal(x[i] - y[i]));
    largest = PetscMax(largest, PetscAbsReal(y[i]));
  }
  return worst / largest;
}

/* Contours of equally many elements, everything else zero */
static inline PetscErrorCode BoundaryAllocate(PetscInt n, PetscInt ncontours, PetscInt order, AbutBoundary *b)
{
  const PetscInt two = 2 * order * n; /* values at nodes */

  PetscFunctionBegin;
  b->order     = order;
  b->n         = n;
  b->nnodes    = order * n;
  b->ncontours = ncontours;
  PetscCall(PetscCalloc5(ncontours + 1, &b->contour, n, &b->next, two, &b->x, two, &b->u, n, &b->side));
  PetscCall(PetscCalloc4(2 * n, &b->condition, 2 * (order + 1) * n, &b->traction, two, &b->reaction, two, &b->contact));
  for (PetscInt i = 0; i < n; ++i) b->next[i] = i + 1;
  for (PetscInt c = 0; c < ncontours; ++c) {
    b->contour[c + 1]              = (c + 1) * n / ncontours;
    b->next[b->contour[c + 1] - 1] = b->contour[c];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The nodes inside the elements, between their ends */
static inline PetscErrorCode BoundaryPlaceNodes(AbutBoundary *b)
{
  const PetscInt p = b->order;
  PetscReal      z[ABUT_SIDE_NODES_MAX];

  PetscFunctionBegin;
  PetscCall(AbutGetLobattoNodes(p, z, NULL));
  for (PetscInt i = 0; i < b->n; ++i)
    for (PetscInt k = 2; k < 2 * p; ++k)
      b->x[2 * p * i + k] = 0.5 * ((1. - z[k / 2]) * b->x[2 * p * i + k % 2] + (1. + z[k / 2]) * b->x[2 * p * b->next[i] + k % 2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscErrorCode BoundaryFree(AbutBoundary *b)
{
  PetscFunctionBegin;
  PetscCall(PetscFree5(b->contour, b->next, b->x, b->u, b->side));
  PetscCall(PetscFree4(b->condition, b->traction, b->reaction, b->contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One rectangle, m[0..3] elements below, right, above, left, those of a side growing up to 20 times; clockwise for a hole */
static inline void RectangleNodes(const PetscReal lo[2], const PetscReal hi[2], const PetscInt m[4], PetscBool hole, PetscInt first,
                                  AbutBoundary *b)
{
  const PetscReal corner[4][2] = {
    {lo[0], lo[1]},
    {hi[0], lo[1]},
    {hi[0], hi[1]},
    {lo[0], hi[1]}
  };
  PetscInt i = first;

  for (PetscInt k = 0; k < 4; ++k) {
    const PetscInt side = hole ? 3 - k : k, from = hole ? (4 - k) % 4 : k, to = hole ? 3 - k : (k + 1) % 4;

    for (PetscInt j = 0; j < m[side]; ++j, ++i) {
      const PetscReal s = (PetscPowReal(20., (PetscReal)j / m[side]) - 1.) / 19.;

      for (PetscInt d = 0; d < 2; ++d) b->x[2 * b->order * i + d] = (1. - s) * corner[from][d] + s * corner[to][d];
      b->side[i] = side + (hole ? 4 : 0);
    }
  }
}

/* A box of m elements a side, with a hole in its middle third if wanted */
static inline PetscErrorCode BoundaryCreateBox(const PetscReal lo[2], const PetscReal hi[2], const PetscInt m[4], PetscBool hole,
                                               PetscInt order, AbutBoundary *b)
{
  const PetscInt  n      = m[0] + m[1] + m[2] + m[3];
  const PetscReal ilo[2] = {(2. * lo[0] + hi[0]) / 3., (2. * lo[1] + hi[1]) / 3.},
                  ihi[2] = {(lo[0] + 2. * hi[0]) / 3., (lo[1] + 2. * hi[1]) / 3.};

  PetscFunctionBegin;
  PetscCall(BoundaryAllocate(hole ? 2 * n : n, hole ? 2 : 1, order, b));
  RectangleNodes(lo, hi, m, PETSC_FALSE, 0, b);
  if (hole) RectangleNodes(ilo, ihi, m, PETSC_TRUE, n, b);
  PetscCall(BoundaryPlaceNodes(b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Teeth on a contour, of so many elements on each flank, height in lengths of their base; nodes between the elements' ends stay behind */
static inline void BoundaryRaiseTeeth(PetscInt flank, PetscReal height, AbutBoundary *b)
{
  const PetscInt n = b->n, two = 2 * b->order;

  for (PetscInt i = flank; i < n; i += 2 * flank) {
    const PetscReal *end[2] = {&b->x[two * (i - flank)], &b->x[two * ((i + flank) % n)]};
    PetscReal       *tip    = &b->x[two * i];

    tip[0] += height * (end[1][1] - end[0][1]);
    tip[1] -= height * (end[1][0] - end[0][0]);
    for (PetscInt k = 1; k < 2 * flank; ++k) {
      const PetscReal s = PetscAbsReal((PetscReal)k / flank - 1.); /* from the tip */

      for (PetscInt d = 0; k != flank && d < 2; ++d) b->x[two * (i - flank + k) + d] = (1. - s) * tip[d] + s * end[k > flank][d];
    }
  }
}

/* The part of element e in the data of a field: displacements at its nodes, in each component tractions there, or the forces by which its
   nodes hold the tractions, integrals with their functions */
static inline void BoundaryFillElement(const Field *f, PetscInt e, AbutBoundary *b)
{
  const PetscInt   p    = b->order;
  const PetscReal *x[2] = {&b->x[2 * p * e], &b->x[2 * p * b->next[e]]}, dx[2] = {x[1][0] - x[0][0], x[1][1] - x[0][1]};
  PetscReal        z[ABUT_SIDE_NODES_MAX], g[5], w[5], N[ABUT_SIDE_NODES_MAX], s[3];

  CkOk(AbutGetLobattoNodes(p, z, NULL));
  CkOk(PetscDTGaussQuadrature(5, -1., 1., g, w));
  for (PetscInt q = 0; q < p + 6; ++q) { /* the nodes, then Gauss's points */
    const PetscReal at = q <= p ? z[q] : g[q - p - 1], point[2] = {x[0][0] + 0.5 * (1. + at) * dx[0], x[0][1] + 0.5 * (1. + at) * dx[1]};
    PetscReal       t[2]; /* times the length */

    f->stress(point, s);
    t[0] = s[0] * dx[1] - s[2] * dx[0];
    t[1] = s[2] * dx[1] - s[1] * dx[0];
    if (q < p) f->displacement(f->young, f->poisson, point, &b->u[2 * (p * e + q)]);
    if (q > p) CkOk(AbutEvaluateLobatto(p, at, N, NULL));
    for (PetscInt d = 0; d < 2; ++d) {
      const AbutConditionType type = b->condition[2 * e + d];

      if (q <= p && type == ABUT_TRACTION) b->traction[2 * ((p + 1) * e + q) + d] = t[d] / PetscSqrtReal(dx[0] * dx[0] + dx[1] * dx[1]);
      for (PetscInt k = 0; q > p && k <= p; ++k) {
        const PetscInt node = k < p ? p * e + k : p * b->next[e];

        if (type == ABUT_DISPLACEMENT) b->reaction[2 * node + d] += 0.5 * w[q - p - 1] * N[k] * t[d];
        if (type == ABUT_CONTACT) b->contact[2 * node + d] += 0.5 * w[q - p - 1] * N[k] * t[d];
      }
    }
  }
}

/* The data of a field under condition[2*side + component] */
static inline void BoundaryFill(const Field *f, const AbutConditionType condition[], AbutBoundary *b)
{
  for (PetscInt i = 0; i < b->n; ++i) {
    for (PetscInt d = 0; d < 2; ++d) b->condition[2 * i + d] = condition[2 * b->side[i] + d];
    BoundaryFillElement(f, i, b);
  }
}

/* Galerkin with a dense system, however large */
static const FembemSolver dense_solver = {.dense = PETSC_MAX_INT, .tolerance = 1e-6};

/* Two letters a side: below, right, above, left, then a hole; t, u, c: traction, displacement, contact given for a component */
static inline void BoundaryConditions(const char text[16], AbutConditionType condition[16])
{
  for (PetscInt i = 0; i < 16; ++i) condition[i] = text[i] == 'u' ? ABUT_DISPLACEMENT : (text[i] == 'c' ? ABUT_CONTACT : ABUT_TRACTION);
}
