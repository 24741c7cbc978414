#include <abut/private/meshimpl.h> /*I "abutmesh.h" I*/

/* A cell's corner pair with both ends on one line of the box is an element side on the boundary: no interior side lies there */

static const char *const AbutSideNames[ABUT_BOX_SIDES] = {"left", "right", "bottom", "top"};

static PetscInt AbutSideOf_Private(AbutMesh mesh, const PetscReal a[2], const PetscReal b[2])
{
  for (PetscInt s = 0; s < ABUT_BOX_SIDES; ++s) {
    const PetscInt  d  = s / 2;
    const PetscReal at = s % 2 ? mesh->upper[d] : mesh->lower[d], tol = 1e-10 * (mesh->upper[d] - mesh->lower[d]) / mesh->cells[d];

    if (PetscAbsReal(a[d] - at) < tol && PetscAbsReal(b[d] - at) < tol) return s;
  }
  return -1;
}

PetscErrorCode AbutMeshSidesBuild_Private(AbutMesh mesh)
{
  AbutMeshTopology *t    = &mesh->topology;
  PetscInt          room = 0, *edge, *node, *cell;

  PetscFunctionBegin;
  for (PetscInt pass = 0; pass < 2; ++pass) {
    if (pass) PetscCall(PetscMalloc3(3 * room, &edge, (t->order + 1) * room, &node, room, &cell));
    for (PetscInt c = 0; c < t->ncells; ++c)
      for (PetscInt k = 0; k < t->corners; ++k) {
        const PetscInt a = t->cell[t->corners * c + k], b = t->cell[t->corners * c + (k + 1) % t->corners],
                       side = AbutSideOf_Private(mesh, t->x + 2 * a, t->x + 2 * b);

        if (side < 0) continue;
        if (!pass) {
          ++room;
          continue;
        }
        edge[3 * t->nsideedges]     = a;
        edge[3 * t->nsideedges + 1] = b;
        edge[3 * t->nsideedges + 2] = side;
        AbutMeshGetEdgeNodes_Private(t, t->celledge[t->corners * c + k], a, node + (t->order + 1) * t->nsideedges);
        cell[t->nsideedges++] = c;
      }
  }
  t->sideedge = edge;
  t->sidenode = node;
  t->sidecell = cell;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshGetSideCount - How many named sides a mesh has

   Not Collective

   Input Parameter:
.  mesh - the mesh

   Output Parameter:
.  n - the number of sides

   Level: intermediate

.seealso: `AbutMeshGetSideName()`, `AbutMeshFindSide()`
@*/
PetscErrorCode AbutMeshGetSideCount(AbutMesh mesh, PetscInt *n)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(mesh, ABUTMESH_CLASSID, 1);
  *n = ABUT_BOX_SIDES;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutMeshGetSideName - The name of a side

   Not Collective

   Input Parameters:
+  mesh - the mesh
-  side - its number

   Output Parameter:
.  name - left, right, bottom or top for a box

   Level: intermediate

.seealso: `AbutMeshFindSide()`
@*/
PetscErrorCode AbutMeshGetSideName(AbutMesh mesh, PetscInt side, const char *name[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(mesh, ABUTMESH_CLASSID, 1);
  *name = AbutSideNames[side];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutMeshFindSide - The number of a side; an unknown name is bad input

   Logically Collective

   Input Parameters:
+  mesh - the mesh
.  key  - the key the name comes from, for the message
-  name - the name, compared without case

   Output Parameter:
.  side - its number

   Level: intermediate

.seealso: `AbutMeshGetSideName()`
@*/
PetscErrorCode AbutMeshFindSide(AbutMesh mesh, const char key[], const char name[], PetscInt *side)
{
  PetscBool match;

  PetscFunctionBegin;
  for (PetscInt s = 0; s < ABUT_BOX_SIDES; ++s) {
    PetscCall(PetscStrcasecmp(name, AbutSideNames[s], &match));
    *side = s;
    if (match) PetscFunctionReturn(PETSC_SUCCESS);
  }
  SETERRQ(PetscObjectComm((PetscObject)mesh), PETSC_ERR_USER_INPUT, "%s: there is no side \"%s\"; a box has left, right, bottom, top", key,
          name);
}

/*@
   AbutMeshGetSideEnds - The ends and the normal of a straight side; the mesh need not be set up

   Not Collective

   Input Parameters:
+  mesh - the mesh
-  side - number of the side

   Output Parameters:
+  ends   - [4] first and last point, with the body on the left
-  normal - [2] outward unit normal

   Level: developer

.seealso: `AbutMeshFindSide()`
@*/
PetscErrorCode AbutMeshGetSideEnds(AbutMesh mesh, PetscInt side, PetscReal ends[4], PetscReal normal[2])
{
  const PetscInt  d = side / 2, forward = d ? side % 2 == 0 : side % 2; /* bottom and right run upwards along their coordinate */
  const PetscReal at = side % 2 ? mesh->upper[d] : mesh->lower[d];

  PetscFunctionBegin;
  ends[d] = ends[2 + d] = at;
  ends[!d]              = forward ? mesh->lower[!d] : mesh->upper[!d];
  ends[2 + !d]          = forward ? mesh->upper[!d] : mesh->lower[!d];
  normal[d]             = side % 2 ? 1. : -1.;
  normal[!d]            = 0.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutMeshGetSidePolygon - The points of a side in the first mesh; the mesh need not be set up

   Not Collective

   Input Parameters:
+  mesh - the mesh
-  side - number of the side

   Output Parameters:
+  n - how many points; 2 for a side of a box
-  x - [2*n] the points in order, with the body on the left, owned by the mesh

   Level: developer

.seealso: `AbutMeshGetSideEnds()`
@*/
PetscErrorCode AbutMeshGetSidePolygon(AbutMesh mesh, PetscInt side, PetscInt *n, const PetscReal *x[])
{
  PetscReal normal[2];

  PetscFunctionBegin;
  PetscCall(AbutMeshGetSideEnds(mesh, side, mesh->sideends[side], normal));
  *n = 2;
  *x = mesh->sideends[side];
  PetscFunctionReturn(PETSC_SUCCESS);
}
