#include "residual.h"
#include <petscdt.h>

/* What is left of equilibrium inside the cells: (h/p)^2 |div s|^2, h the largest height of the cell above a side of it */

#define POINTS_MAX ((ABUT_ORDER_MAX + 1) * (ABUT_ORDER_MAX + 1))

typedef struct {
  PetscInt  n;
  PetscReal xi[2 * POINTS_MAX], w[POINTS_MAX];
} CellRule;

/* Gauss points in each direction, exact for |div s|^2 in a parallelogram; in a triangle those of a square squeezed to it */
static PetscErrorCode CellRuleCreate(PetscInt corners, PetscInt order, CellRule *rule)
{
  const PetscInt n = order + 1;
  PetscReal      z[ABUT_ORDER_MAX + 1], w[ABUT_ORDER_MAX + 1];

  PetscFunctionBegin;
  PetscCall(PetscDTGaussQuadrature(n, 0., 1., z, w));
  rule->n = n * n;
  for (PetscInt q = 0; q < rule->n; ++q) {
    const PetscReal a = z[q / n], b = z[q % n];

    rule->xi[2 * q]     = corners == 4 ? 2. * a - 1. : a;
    rule->xi[2 * q + 1] = corners == 4 ? 2. * b - 1. : b * (1. - a);
    rule->w[q]          = (corners == 4 ? 4. : 1. - a) * w[q / n] * w[q % n];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the integrals of |div s|^2 and |s|^2 over cell c. The stress at its nodes is differentiated with the basis: exact in triangles and
   parallelograms */
static PetscErrorCode IntegrateCell(AbutBody body, AbutMesh mesh, PetscInt c, const CellRule *rule, PetscReal integral[2])
{
  const AbutMeshTopology *t;
  const PetscReal        *node;
  PetscReal               s[3 * ABUT_CELL_NODES_MAX], N[ABUT_CELL_NODES_MAX], G[2 * ABUT_CELL_NODES_MAX], x[2], det;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(AbutMeshGetReferenceNodes(mesh, &node));
  for (PetscInt k = 0; k < t->nodes; ++k) PetscCall(AbutBodyGetCellStress(body, c, node + 2 * k, s + 3 * k));
  for (PetscInt q = 0; q < rule->n; ++q) {
    PetscReal here[3] = {0., 0., 0.}, div[2] = {0., 0.};

    PetscCall(AbutMeshMapCell(mesh, c, rule->xi + 2 * q, x, N, G, &det));
    for (PetscInt k = 0; k < t->nodes; ++k) {
      for (PetscInt i = 0; i < 3; ++i) here[i] += N[k] * s[3 * k + i];
      div[0] += G[2 * k] * s[3 * k] + G[2 * k + 1] * s[3 * k + 2];
      div[1] += G[2 * k] * s[3 * k + 2] + G[2 * k + 1] * s[3 * k + 1];
    }
    integral[0] += rule->w[q] * det * (PetscSqr(div[0]) + PetscSqr(div[1]));
    integral[1] += rule->w[q] * det * (PetscSqr(here[0]) + PetscSqr(here[1]) + 2. * PetscSqr(here[2]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ResidualAddInside(AbutBody body, PetscReal square[], PetscReal *norm)
{
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  CellRule                rule;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(CellRuleCreate(t->corners, t->order, &rule));
  *norm = 0.;
  for (PetscInt c = 0; c < t->ncells; ++c) {
    PetscReal integral[2] = {0., 0.}, h = 0., height, length;

    PetscCall(IntegrateCell(body, mesh, c, &rule, integral));
    for (PetscInt k = 0; k < t->corners; ++k) {
      PetscCall(ResidualGetHeight(mesh, c, k, &height, &length));
      h = PetscMax(h, height);
    }
    square[c] += PetscSqr(h / t->order) * integral[0];
    *norm += integral[1];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
