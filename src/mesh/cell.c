#include <abut/private/meshimpl.h> /*I "abutmesh.h" I*/

/* Shape functions of order 1 and their derivatives in the reference cell */
static void AbutCellShape_Private(PetscInt corners, const PetscReal xi[2], PetscReal N[], PetscReal dN[])
{
  static const PetscReal s[4] = {-1., 1., 1., -1.}, t[4] = {-1., -1., 1., 1.};

  if (corners == 3) {
    const PetscReal d[6] = {-1., -1., 1., 0., 0., 1.};

    N[0] = 1. - xi[0] - xi[1];
    N[1] = xi[0];
    N[2] = xi[1];
    for (PetscInt i = 0; i < 6; ++i) dN[i] = d[i];
    return;
  }
  for (PetscInt k = 0; k < 4; ++k) {
    N[k]          = 0.25 * (1. + s[k] * xi[0]) * (1. + t[k] * xi[1]);
    dN[2 * k]     = 0.25 * s[k] * (1. + t[k] * xi[1]);
    dN[2 * k + 1] = 0.25 * t[k] * (1. + s[k] * xi[0]);
  }
}

/*@C
   AbutMeshMapPoint - Maps a reference point into a local cell, which is straight, whatever the order of the displacement

   Not Collective

   Input Parameters:
+  mesh - the mesh
.  c    - local cell
-  xi   - [2] reference point: [-1,1]^2 for quads, (0,0)(1,0)(0,1) for triangles

   Output Parameters:
+  x - [2] the point in space
-  J - [4] the Jacobian by rows: J[2*i+j] = dx_i/dxi_j, length

   Level: developer

.seealso: `AbutMeshMapCell()`, `AbutMeshInvertCell()`
@*/
PetscErrorCode AbutMeshMapPoint(AbutMesh mesh, PetscInt c, const PetscReal xi[2], PetscReal x[2], PetscReal J[4])
{
  const AbutMeshTopology *t = &mesh->topology;
  const PetscInt         *v = t->cell + t->corners * c;
  PetscReal               N[4], dN[8];

  PetscFunctionBegin;
  AbutCellShape_Private(t->corners, xi, N, dN);
  for (PetscInt i = 0; i < 2; ++i) {
    x[i] = J[2 * i] = J[2 * i + 1] = 0.;
    for (PetscInt k = 0; k < t->corners; ++k) {
      const PetscReal xk = t->x[2 * v[k] + i];

      x[i] += N[k] * xk;
      for (PetscInt j = 0; j < 2; ++j) J[2 * i + j] += xk * dN[2 * k + j];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutMeshMapCell - Maps a reference point into a local cell

   Not Collective

   Input Parameters:
+  mesh - the mesh
.  c    - local cell
-  xi   - [2] reference point: [-1,1]^2 for quads, (0,0)(1,0)(0,1) for triangles

   Output Parameters:
+  x   - [2] the point in space
.  N   - [nodes] shape functions, at most `ABUT_CELL_NODES_MAX`
.  G   - [2*nodes] their gradients in space, 1/length
-  det - determinant of the map's Jacobian, area

   Level: developer

.seealso: `AbutMeshInvertCell()`, `AbutMeshGetTopology()`, `AbutMeshGetReferenceNodes()`
@*/
PetscErrorCode AbutMeshMapCell(AbutMesh mesh, PetscInt c, const PetscReal xi[2], PetscReal x[2], PetscReal N[], PetscReal G[],
                               PetscReal *det)
{
  const AbutBasis *b = &mesh->basis;
  PetscReal        J[4], d;

  PetscFunctionBegin;
  PetscCall(AbutMeshMapPoint(mesh, c, xi, x, J));
  if (b->order == 1) AbutCellShape_Private(b->corners, xi, N, G);
  else AbutBasisEvaluate_Private(b, xi, N, G);
  d = J[0] * J[3] - J[1] * J[2];
  for (PetscInt k = 0; k < b->nodes; ++k) {
    const PetscReal dN[2] = {G[2 * k], G[2 * k + 1]};

    G[2 * k]     = (dN[0] * J[3] - dN[1] * J[2]) / d;
    G[2 * k + 1] = (-dN[0] * J[1] + dN[1] * J[0]) / d;
  }
  *det = d;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshGetCellArea - The area of a local cell

   Not Collective

   Input Parameters:
+  mesh - the mesh
-  c    - local cell

   Output Parameter:
.  area - its area

   Level: developer

.seealso: `AbutMeshMapCell()`, `AbutMeshGetTopology()`
@*/
PetscErrorCode AbutMeshGetCellArea(AbutMesh mesh, PetscInt c, PetscReal *area)
{
  const AbutMeshTopology *t = &mesh->topology;

  PetscFunctionBegin;
  *area = 0.;
  for (PetscInt k = 0; k < t->corners; ++k) { /* the shoelace formula */
    const PetscReal *p = &t->x[2 * t->cell[t->corners * c + k]], *q = &t->x[2 * t->cell[t->corners * c + (k + 1) % t->corners]];

    *area += 0.5 * (p[0] * q[1] - p[1] * q[0]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutMeshInvertCell - Finds the reference point of a point in a local cell

   Not Collective

   Input Parameters:
+  mesh - the mesh
.  c    - local cell
-  x    - [2] the point

   Output Parameters:
+  xi     - [2] the reference point, where inside
-  inside - whether the point lies in the cell or on its border, to 1e-9 of its size

   Level: developer

   Note:
   Newton's method on the bilinear map; exact after one step on parallelograms and triangles.

.seealso: `AbutMeshMapCell()`
@*/
PetscErrorCode AbutMeshInvertCell(AbutMesh mesh, PetscInt c, const PetscReal x[2], PetscReal xi[2], PetscBool *inside)
{
  const AbutMeshTopology *t      = &mesh->topology;
  const PetscInt         *v      = t->cell + t->corners * c;
  const PetscReal         margin = 1e-9;
  PetscReal               at[2], J[4], lo[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL}, hi[2] = {PETSC_MIN_REAL, PETSC_MIN_REAL};

  PetscFunctionBegin;
  *inside = PETSC_FALSE;
  for (PetscInt k = 0; k < t->corners; ++k)
    for (PetscInt i = 0; i < 2; ++i) {
      lo[i] = PetscMin(lo[i], t->x[2 * v[k] + i]);
      hi[i] = PetscMax(hi[i], t->x[2 * v[k] + i]);
    }
  for (PetscInt i = 0; i < 2; ++i)
    if (x[i] < lo[i] - margin * (hi[i] - lo[i]) || x[i] > hi[i] + margin * (hi[i] - lo[i])) PetscFunctionReturn(PETSC_SUCCESS);
  xi[0] = xi[1] = t->corners == 3 ? 1. / 3. : 0.;
  for (PetscInt it = 0; it < 20; ++it) {
    PetscReal step[2], det;

    PetscCall(AbutMeshMapPoint(mesh, c, xi, at, J));
    det     = J[0] * J[3] - J[1] * J[2];
    step[0] = (J[3] * (x[0] - at[0]) - J[1] * (x[1] - at[1])) / det;
    step[1] = (J[0] * (x[1] - at[1]) - J[2] * (x[0] - at[0])) / det;
    xi[0] += step[0];
    xi[1] += step[1];
    if (PetscAbsReal(step[0]) + PetscAbsReal(step[1]) < 1e-13) break;
  }
  *inside = t->corners == 3 ? (PetscBool)(xi[0] > -margin && xi[1] > -margin && xi[0] + xi[1] < 1. + margin)
                            : (PetscBool)(PetscAbsReal(xi[0]) < 1. + margin && PetscAbsReal(xi[1]) < 1. + margin);
  PetscFunctionReturn(PETSC_SUCCESS);
}
