#pragma once

#include <petscdt.h>
#include "fembem_boundaries.h"

/* Bodies for the tests of estimator_fembem: eq. (23), C = ||s_B - s*||/||s_F - s*||, eq. (24), effectivity ||s_B - s_F||/||s_F - s*|| */
typedef PetscErrorCode (*StressFunction)(const PetscReal x[2], PetscReal s[3], void *ctx);

/* The stress of boundary elements on the trace of a solved body */
static inline FembemStress BodyStress(AbutBody body, PetscBool galerkin, PetscReal tolerance)
{
  AbutBoundary  *given;
  FembemBoundary b;
  FembemStress   stress;
  PetscReal      young, poisson;
  FembemCost     cost;

  CkOk(AbutBodyGetMaterial(body, &young, &poisson));
  CkOk(AbutBodyGetBoundary(body, &given));
  CkOk(FembemBoundaryCreate(PETSC_COMM_WORLD, given, young, poisson, &b));
  CkOk(FembemRecoverTractions(&b));
  if (galerkin) CkOk(FembemSolveGalerkin(&b, dense_solver, &cost));
  CkOk(FembemStressCreate(&b, tolerance, &stress));
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(AbutBoundaryDestroy(&given));
  return stress;
}

/* measure: C, effectivity, relative error of the finite elements; order + 3 points in each direction of a cell, in a triangle of the square
   squeezed to it */
static inline void Measure(AbutBody body, PetscBool galerkin, StressFunction exact, void *ctx, PetscReal measure[3])
{
  FembemStress            stress = BodyStress(body, galerkin, 1e-12);
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  PetscReal               z[7], w[7], sum[4] = {0., 0., 0., 0.};
  PetscInt                n;

  CkOk(AbutBodyGetMesh(body, &mesh));
  CkOk(AbutMeshGetTopology(mesh, &t));
  n = t->order + 3;
  CkOk(PetscDTGaussQuadrature(n, -1., 1., z, w));
  for (PetscInt k = 0; k < n * n * t->ncells; ++k) {
    const PetscInt  i = k % n, j = k / n % n, c = k / n / n;
    const PetscReal a = 0.5 + 0.5 * z[i], b = 0.5 + 0.5 * z[j];
    PetscReal       xi[2] = {z[i], z[j]}, weight = w[i] * w[j], x[2], jac, sB[3], sF[3], s[3];

    if (t->corners == 3) {
      xi[0] = a;
      xi[1] = b * (1. - a);
      weight *= 1. - a;
    }
    CkOk(AbutBodyGetCellPoint(body, c, xi, x, &jac));
    CkOk(AbutBodyGetCellStress(body, c, xi, sF));
    CkOk(FembemStressEvaluate(stress, 1, x, sB));
    CkOk((*exact)(x, s, ctx));
    for (PetscInt d = 0; d < 3; ++d) {
      const PetscReal factor = weight * jac * (d == 2 ? 2. : 1.);

      sum[0] += factor * PetscSqr(sB[d] - s[d]);
      sum[1] += factor * PetscSqr(sB[d] - sF[d]);
      sum[2] += factor * PetscSqr(sF[d] - s[d]);
      sum[3] += factor * PetscSqr(s[d]);
    }
  }
  CkOk(MPI_Allreduce(MPI_IN_PLACE, sum, 4, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  measure[0] = PetscSqrtReal(sum[0] / sum[2]);
  measure[1] = PetscSqrtReal(sum[1] / sum[2]);
  measure[2] = PetscSqrtReal(sum[2] / sum[3]);
  CkOk(FembemStressDestroy(&stress));
}

static inline AbutBody CreateBox(PetscInt order, AbutShape shape, PetscReal length, PetscInt nx, PetscInt ny, PetscReal young)
{
  const PetscReal lower[2] = {0., 0.}, upper[2] = {length, 1.};
  const PetscInt  cells[2] = {nx, ny};
  AbutBody        body;
  AbutMesh        mesh;

  CkOk(AbutBodyCreate(PETSC_COMM_WORLD, "box", &body));
  CkOk(AbutBodyGetMesh(body, &mesh));
  CkOk(AbutMeshSetBox(mesh, lower, upper, cells, shape));
  CkOk(AbutMeshSetOrder(mesh, order));
  CkOk(AbutBodySetMaterial(body, young, 0.3));
  return body;
}

/* Muskhelishvili's phi = e^z, psi = cos(2 z) on the unit square, E = 1: displacement given left and below, traction right and above */
static inline PetscErrorCode SmoothStress(const PetscReal x[2], PetscReal s[3], PETSC_UNUSED void *ctx)
{
  const PetscComplex z = PetscCMPLX(x[0], x[1]), dphi = PetscExpComplex(z), S = PetscConjComplex(z) * dphi - 2. * PetscSinComplex(2. * z);

  s[0] = 2. * PetscRealPartComplex(dphi) - PetscRealPartComplex(S);
  s[1] = 2. * PetscRealPartComplex(dphi) + PetscRealPartComplex(S);
  s[2] = PetscImaginaryPartComplex(S);
  return PETSC_SUCCESS;
}

static inline PetscErrorCode SmoothDisplacement(const PetscReal x[2], PetscReal *u, void *ctx)
{
  const PetscComplex z = PetscCMPLX(x[0], x[1]), e = PetscExpComplex(z),
                     v = 1.3 * (1.8 * e - z * PetscConjComplex(e) - PetscConjComplex(PetscCosComplex(2. * z)));

  *u = *(PetscInt *)ctx ? PetscImaginaryPartComplex(v) : PetscRealPartComplex(v);
  return PETSC_SUCCESS;
}

/* On the right the traction is (s11, s12), above (s12, s22) */
static inline PetscErrorCode SmoothTraction(const PetscReal x[2], PetscReal *t, void *ctx)
{
  PetscReal s[3];

  PetscCall(SmoothStress(x, s, NULL));
  *t = s[*(PetscInt *)ctx];
  return PETSC_SUCCESS;
}

static inline AbutBody SmoothBody(PetscInt order, AbutShape shape, PetscInt n)
{
  static PetscInt component[3] = {0, 1, 2};
  AbutBody        body         = CreateBox(order, shape, 1., n, n, 1.);

  for (PetscInt c = 0; c < 2; ++c) {
    CkOk(AbutBodySetDisplacement(body, "left", c, SmoothDisplacement, &component[c]));
    CkOk(AbutBodySetDisplacement(body, "bottom", c, SmoothDisplacement, &component[c]));
    CkOk(AbutBodySetTraction(body, "right", c, SmoothTraction, &component[c ? 2 : 0]));
    CkOk(AbutBodySetTraction(body, "top", c, SmoothTraction, &component[c ? 1 : 2]));
  }
  CkOk(AbutBodySetFromOptions(body));
  CkOk(AbutBodySetUp(body));
  CkOk(AbutBodySolve(body, NULL));
  return body;
}

/* The paper's lower body under a given pressure: p = 166.2 sqrt(1 - x1^2) MPa above, symmetry left, smooth base, right side free */
static inline PetscErrorCode Pressure(const PetscReal x[2], PetscReal *t, PETSC_UNUSED void *ctx)
{
  *t = x[0] < 1. ? -166.2 * PetscSqrtReal(1. - x[0] * x[0]) : 0.;
  return PETSC_SUCCESS;
}

static inline PetscErrorCode Zero(PETSC_UNUSED const PetscReal x[2], PetscReal *value, PETSC_UNUSED void *ctx)
{
  *value = 0.;
  return PETSC_SUCCESS;
}

static inline AbutBody LayerBody(PetscInt order, PetscInt nx, PetscInt ny)
{
  AbutBody body = CreateBox(order, ABUT_QUAD, 4., nx, ny, 2.1e5);

  CkOk(AbutBodySetDisplacement(body, "left", 0, Zero, NULL));
  CkOk(AbutBodySetDisplacement(body, "bottom", 1, Zero, NULL));
  CkOk(AbutBodySetTraction(body, "top", 1, Pressure, NULL));
  CkOk(AbutBodySetFromOptions(body));
  CkOk(AbutBodySetUp(body));
  CkOk(AbutBodySolve(body, NULL));
  return body;
}

/* The pressure projected on each element of the top */
static inline void ProjectPressure(AbutBoundary *b)
{
  const PetscInt p = b->order;
  PetscReal      g[20], w[20], z[ABUT_SIDE_NODES_MAX], P[ABUT_SIDE_NODES_MAX];

  CkOk(PetscDTGaussQuadrature(20, 0., 1., g, w));
  CkOk(AbutGetLobattoNodes(p, z, NULL));
  for (PetscInt i = 0; i < b->n; ++i) {
    PetscReal c[ABUT_SIDE_NODES_MAX] = {0.}; /* of Legendre's polynomials */

    if (b->side[i] != 2) continue;
    for (PetscInt q = 0; q < 20; ++q) {
      const PetscReal s = g[q] * g[q] * g[q] * (10. - 15. * g[q] + 6. * g[q] * g[q]), ds = w[q] * 30. * PetscSqr(g[q] * (1. - g[q]));
      const PetscReal x[2] = {(1. - s) * b->x[2 * p * i] + s * b->x[2 * p * b->next[i]], 1.};
      PetscReal       t;

      CkOk(Pressure(x, &t, NULL));
      FembemLegendreP(p, 2. * s - 1., P);
      for (PetscInt n = 0; n <= p; ++n) c[n] += (2. * n + 1.) * ds * t * P[n];
    }
    for (PetscInt k = 0; k <= p; ++k) {
      FembemLegendreP(p, z[k], P);
      for (PetscInt n = 0; n <= p; ++n) b->traction[2 * ((p + 1) * i + k) + 1] += c[n] * P[n];
    }
  }
}

/* How the boundary of the layer is divided: elements of the largest length, on the top of growth times the distance from the end of the
   pressure, but not below the smallest */
typedef struct {
  PetscInt  order;
  PetscReal largest, growth, smallest;
} Division;
static const Division linear_division = {1, 0.03125, 0.25, 1e-4}, quartic_division = {4, 0.125, 0.3, 1e-7};

/* Ends of elements of the top from left to right */
#define NTOP 400
static inline PetscInt TopNodes(const Division *d, PetscReal top[])
{
  PetscInt  n = 0;
  PetscReal x = 0.;

  while (x < 4. - 1e-9) {
    const PetscReal h = PetscMax(d->smallest, PetscMin(d->largest, d->growth * PetscAbsReal(x - 1.)));

    top[n++] = x;
    if (x < 1. && x + 1.5 * h > 1.) x = 1.;
    else x = x + 1.5 * h > 4. ? 4. : x + h;
  }
  return n;
}

/* Its solution by boundary elements alone */
static inline FembemStress LayerReference(const Division *d)
{
  AbutBoundary   given;
  FembemBoundary b;
  FembemStress   stress;
  FembemCost     cost;
  PetscReal      top[NTOP];
  const PetscInt high = (PetscInt)(1. / d->largest), n[4] = {4 * high, high, TopNodes(d, top), high};
  PetscInt       i = 0;

  CkOk(BoundaryAllocate(n[0] + n[1] + n[2] + n[3], 1, d->order, &given));
  for (PetscInt side = 0; side < 4; ++side) {
    for (PetscInt j = 0; j < n[side]; ++j, ++i) {
      PetscReal *x = &given.x[2 * d->order * i];

      x[0]          = side == 0 ? 4. * j / n[0] : (side == 1 ? 4. : (side == 2 ? (j ? top[n[2] - j] : 4.) : 0.));
      x[1]          = side == 0 ? 0. : (side == 1 ? (PetscReal)j / n[1] : (side == 2 ? 1. : 1. - (PetscReal)j / n[3]));
      given.side[i] = side;
      if (side == 0) given.condition[2 * i + 1] = ABUT_DISPLACEMENT;
      if (side == 3) given.condition[2 * i] = ABUT_DISPLACEMENT;
    }
  }
  CkOk(BoundaryPlaceNodes(&given));
  ProjectPressure(&given);
  CkOk(FembemBoundaryCreate(PETSC_COMM_SELF, &given, 2.1e5, 0.3, &b));
  CkOk(FembemSolveGalerkin(&b, dense_solver, &cost));
  CkOk(FembemStressCreate(&b, 1e-10, &stress));
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(BoundaryFree(&given));
  return stress;
}

static inline PetscErrorCode ReferenceStress(const PetscReal x[2], PetscReal s[3], void *ctx)
{
  return FembemStressEvaluate(*(FembemStress *)ctx, 1, x, s);
}
