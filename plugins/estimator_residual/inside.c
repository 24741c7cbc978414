#include "residual.h"

/* What is left of equilibrium inside the cells: (h/p)^2 |div s + f|^2, f the body force, h the largest height of the cell above a side of
   it */

/* Adds the integrals of |div s + f|^2 and |s|^2 over cell c, with axial symmetry those of its turn and with the hoop stress; dN are the
   derivatives of the basis at its nodes. The stress at the nodes is differentiated with the basis: exact in triangles and parallelograms */
static PetscErrorCode IntegrateCell(AbutBody body, AbutMesh mesh, PetscInt c, PetscQuadrature rule, const PetscReal dN[],
                                    PetscReal integral[2])
{
  const AbutMeshTopology *t;
  const PetscReal        *node, *xi, *w;
  PetscInt                npoints;
  AbutKinematics          kinematics;
  PetscReal s[3 * ABUT_CELL_NODES_MAX], s33[ABUT_CELL_NODES_MAX], thickness, N[ABUT_CELL_NODES_MAX], G[2 * ABUT_CELL_NODES_MAX], x[2], det;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(AbutMeshGetReferenceNodes(mesh, &node));
  PetscCall(AbutBodyGetKinematics(body, &kinematics));
  PetscCall(AbutBodyGetCellStresses3D(body, c, t->nodes, node, dN, s, s33));
  PetscCall(PetscQuadratureGetData(rule, NULL, NULL, &npoints, &xi, &w));
  for (PetscInt q = 0; q < npoints; ++q) {
    PetscReal here[3] = {0., 0., 0.}, div[2], hoop = 0.;

    PetscCall(AbutMeshMapCell(mesh, c, xi + 2 * q, x, N, G, &det));
    PetscCall(AbutBodyGetThickness(body, x, &thickness));
    PetscCall(AbutBodyGetForce(body, x, div));
    for (PetscInt k = 0; k < t->nodes; ++k) {
      for (PetscInt i = 0; i < 3; ++i) here[i] += N[k] * s[3 * k + i];
      div[0] += G[2 * k] * s[3 * k] + G[2 * k + 1] * s[3 * k + 2];
      div[1] += G[2 * k] * s[3 * k + 2] + G[2 * k + 1] * s[3 * k + 1];
    }
    if (kinematics == ABUT_AXISYMMETRIC) {
      for (PetscInt k = 0; k < t->nodes; ++k) hoop += N[k] * s33[k];
      div[0] += (here[0] - hoop) / x[0];
      div[1] += here[2] / x[0];
    }
    integral[0] += w[q] * det * thickness * (PetscSqr(div[0]) + PetscSqr(div[1]));
    integral[1] += w[q] * det * thickness * (PetscSqr(here[0]) + PetscSqr(here[1]) + 2. * PetscSqr(here[2]) + PetscSqr(hoop));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ResidualAddInside(AbutBody body, PetscReal square[], PetscReal *norm)
{
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  PetscQuadrature         rule;
  const PetscReal        *node;
  PetscReal               N[ABUT_CELL_NODES_MAX], dN[2 * ABUT_CELL_NODES_MAX * ABUT_CELL_NODES_MAX];

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(AbutMeshGetReferenceNodes(mesh, &node));
  PetscCall(AbutMeshCreateQuadrature(mesh, t->order + 1, &rule)); /* exact for |div s|^2 in triangles and parallelograms */
  for (PetscInt k = 0; k < t->nodes; ++k) PetscCall(AbutMeshEvaluateBasis(mesh, node + 2 * k, N, dN + 2 * t->nodes * k));
  *norm = 0.;
  for (PetscInt c = 0; c < t->ncells; ++c) {
    PetscReal integral[2] = {0., 0.}, h = 0., height, length;

    PetscCall(IntegrateCell(body, mesh, c, rule, dN, integral));
    for (PetscInt k = 0; k < t->corners; ++k) {
      PetscCall(ResidualGetHeight(mesh, c, k, &height, &length));
      h = PetscMax(h, height);
    }
    square[c] += PetscSqr(h / t->order) * integral[0];
    *norm += integral[1];
  }
  PetscCall(PetscQuadratureDestroy(&rule));
  PetscFunctionReturn(PETSC_SUCCESS);
}
