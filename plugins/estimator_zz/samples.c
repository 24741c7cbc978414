#include "samples.h"
#include <petscdt.h>

/* Orthonormal polynomials on the reference cell at one point: of degree order-1 in each coordinate on quads, of degree order-2 on
   triangles */
static PetscErrorCode AbutLowPolynomials_Private(const AbutMeshTopology *t, const PetscReal xi[2], PetscInt *n, PetscReal phi[])
{
  const PetscInt degree[ABUT_ORDER_MAX] = {0, 1, 2, 3}, p = t->order;

  PetscFunctionBegin;
  if (t->corners == 4) {
    PetscReal legendre[2 * ABUT_ORDER_MAX];

    *n = p * p;
    PetscCall(PetscDTJacobiEval(2, 0., 0., xi, p, degree, legendre, NULL, NULL));
    for (PetscInt i = 0; i < p; ++i)
      for (PetscInt j = 0; j < p; ++j) phi[p * i + j] = 0.5 * PetscSqrtReal((2. * i + 1.) * (2. * j + 1.)) * legendre[i] * legendre[p + j];
  } else {
    const PetscReal x[2] = {2. * xi[0] - 1., 2. * xi[1] - 1.}; /* PETSc's triangle has four times the area */

    *n = p * (p - 1) / 2;
    PetscCall(PetscDTPKDEvalJet(2, 1, x, p - 2, 0, phi));
    for (PetscInt i = 0; i < *n; ++i) phi[i] *= 2.;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutSamplesLow_Private(AbutMesh mesh, const AbutMeshTopology *t, AbutSamples *a)
{
  PetscReal        at[ABUT_SAMPLES_MAX], phi[ABUT_SAMPLES_MAX];
  const PetscReal *node;
  PetscInt         m;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetReferenceNodes(mesh, &node));
  for (PetscInt k = 0; k < t->nodes; ++k) {
    PetscCall(AbutLowPolynomials_Private(t, node + 2 * k, &m, at));
    for (PetscInt q = 0; q < a->n; ++q) {
      PetscCall(AbutLowPolynomials_Private(t, a->xi + 2 * q, &m, phi));
      a->low[a->n * k + q] = 0.;
      for (PetscInt i = 0; i < m; ++i) a->low[a->n * k + q] += a->w[q] * at[i] * phi[i];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* order x order points, where the stress of quads is superconvergent; on triangles it is nowhere, and other points measured the same */
PetscErrorCode AbutSamplesCreate_Private(AbutBody body, AbutMesh mesh, const AbutMeshTopology *t, AbutSamples **samples)
{
  PetscQuadrature  quadrature;
  const PetscReal *xi, *w;
  PetscReal       *dN;
  AbutSamples     *a;

  PetscFunctionBegin;
  PetscCall(PetscNew(&a));
  PetscCall(AbutMeshCreateQuadrature(mesh, t->order, &quadrature));
  PetscCall(PetscQuadratureGetData(quadrature, NULL, NULL, &a->n, &xi, &w));
  PetscCall(PetscArraycpy(a->xi, xi, 2 * a->n));
  PetscCall(PetscArraycpy(a->w, w, a->n));
  PetscCall(PetscQuadratureDestroy(&quadrature));
  PetscCall(PetscMalloc1(2 * t->nodes * a->n, &dN));
  PetscCall(PetscMalloc1(3 * a->n * t->ncells, &a->s));
  for (PetscInt q = 0; q < a->n; ++q) PetscCall(AbutMeshEvaluateBasis(mesh, a->xi + 2 * q, a->N + t->nodes * q, dN + 2 * t->nodes * q));
  for (PetscInt c = 0; c < t->ncells; ++c) PetscCall(AbutBodyGetCellStresses(body, c, a->n, a->xi, dN, a->s + 3 * a->n * c));
  PetscCall(PetscFree(dN));
  if (t->order > 1) PetscCall(AbutSamplesLow_Private(mesh, t, a));
  *samples = a;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Replaces the lower part of a stress s[3*nodes] at the nodes of cell c by that of the finite elements */
PetscErrorCode AbutSamplesKeep_Private(const AbutSamples *a, const AbutMeshTopology *t, PetscInt c, PetscReal s[])
{
  PetscReal apart[3 * ABUT_SAMPLES_MAX];

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(apart, a->s + 3 * a->n * c, 3 * a->n));
  for (PetscInt q = 0; q < a->n; ++q)
    for (PetscInt k = 0; k < t->nodes; ++k)
      for (PetscInt j = 0; j < 3; ++j) apart[3 * q + j] -= a->N[t->nodes * q + k] * s[3 * k + j];
  for (PetscInt k = 0; k < t->nodes; ++k)
    for (PetscInt q = 0; q < a->n; ++q)
      for (PetscInt j = 0; j < 3; ++j) s[3 * k + j] += a->low[a->n * k + q] * apart[3 * q + j];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutSamplesDestroy_Private(AbutSamples **samples)
{
  PetscFunctionBegin;
  PetscCall(PetscFree((*samples)->s));
  PetscCall(PetscFree(*samples));
  PetscFunctionReturn(PETSC_SUCCESS);
}
