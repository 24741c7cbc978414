#include "first.h" /*I "abutmesh.h" I*/

/* The named sides. Of a box, a cell's corner pair with both ends on one line of it is an element side on the boundary: no interior side
   lies there. In a mesh from a file the sides of cells know on which side of the body they lie. */

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
  PetscInt          room = 0, *edge, *node, *cell, *known = NULL;

  PetscFunctionBegin;
  if (mesh->first) {
    PetscCall(PetscMalloc1(t->corners * t->ncells, &known));
    PetscUseTypeMethod(mesh, getsides, known);
  }
  for (PetscInt pass = 0; pass < 2; ++pass) {
    if (pass) PetscCall(PetscMalloc3(3 * room, &edge, (t->order + 1) * room, &node, room, &cell));
    for (PetscInt c = 0; c < t->ncells; ++c)
      for (PetscInt k = 0; k < t->corners; ++k) {
        const PetscInt a = t->cell[t->corners * c + k], b = t->cell[t->corners * c + (k + 1) % t->corners],
                       side = mesh->first ? known[t->corners * c + k] : AbutSideOf_Private(mesh, t->x + 2 * a, t->x + 2 * b);

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
  PetscCall(PetscFree(known));
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
  *n = mesh->first ? mesh->first->nsides : ABUT_BOX_SIDES;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutMeshGetSideName - The name of a side

   Not Collective

   Input Parameters:
+  mesh - the mesh
-  side - its number

   Output Parameter:
.  name - left, right, bottom or top for a box; for a file that of the physical curve

   Level: intermediate

.seealso: `AbutMeshFindSide()`
@*/
PetscErrorCode AbutMeshGetSideName(AbutMesh mesh, PetscInt side, const char *name[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(mesh, ABUTMESH_CLASSID, 1);
  *name = mesh->first ? mesh->first->name[side] : AbutSideNames[side];
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
  const char *have;
  char        all[ABUT_LIST] = "";
  PetscInt    n;
  PetscBool   match;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetSideCount(mesh, &n));
  for (PetscInt s = 0; s < n; ++s) {
    PetscCall(AbutMeshGetSideName(mesh, s, &have));
    PetscCall(PetscStrcasecmp(name, have, &match));
    *side = s;
    if (match) PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(AbutListAddItem_Private(all, sizeof(all), have));
  }
  SETERRQ(PetscObjectComm((PetscObject)mesh), PETSC_ERR_USER_INPUT, "%s: there is no side \"%s\"; %s has %s", key, name,
          mesh->first ? mesh->first->path : "a box", all);
}

static PetscErrorCode AbutFirstGetSideEnds_Private(AbutMesh mesh, PetscInt side, PetscReal ends[4], PetscReal normal[2])
{
  const PetscReal *x;
  PetscReal        length;
  PetscInt         n;
  PetscBool        straight;

  PetscFunctionBegin;
  PetscCall(AbutMeshIsSideStraight(mesh, side, &straight));
  AbutCheckInput(straight, PetscObjectComm((PetscObject)mesh),
                 "%smesh_file: side \"%s\" of %s is not one straight line; give a side that is",
                 ((PetscObject)mesh)->prefix ? ((PetscObject)mesh)->prefix : "", mesh->first->name[side], mesh->first->path);
  PetscCall(AbutMeshGetSideSegments(mesh, side, &n, &x));
  for (PetscInt d = 0; d < 2; ++d) {
    ends[d]     = x[d];
    ends[2 + d] = x[4 * n - 2 + d];
  }
  length    = PetscSqrtReal(PetscSqr(ends[2] - ends[0]) + PetscSqr(ends[3] - ends[1]));
  normal[0] = (ends[3] - ends[1]) / length;
  normal[1] = (ends[0] - ends[2]) / length;
  PetscFunctionReturn(PETSC_SUCCESS);
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

   Note:
   A side of a file that is not one straight line is bad input.

.seealso: `AbutMeshFindSide()`, `AbutMeshGetSideSegments()`, `AbutMeshIsSideStraight()`
@*/
PetscErrorCode AbutMeshGetSideEnds(AbutMesh mesh, PetscInt side, PetscReal ends[4], PetscReal normal[2])
{
  const PetscInt  d = side / 2 % 2, forward = d ? side % 2 == 0 : side % 2; /* bottom and right run upwards along their coordinate */
  const PetscReal at = side % 2 ? mesh->upper[d] : mesh->lower[d];

  PetscFunctionBegin;
  if (mesh->first) {
    PetscCall(AbutFirstGetSideEnds_Private(mesh, side, ends, normal));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  ends[d] = ends[2 + d] = at;
  ends[!d]              = forward ? mesh->lower[!d] : mesh->upper[!d];
  ends[2 + !d]          = forward ? mesh->upper[!d] : mesh->lower[!d];
  normal[d]             = side % 2 ? 1. : -1.;
  normal[!d]            = 0.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshGetSideDirection - The mean of the outward normals of a side; the mesh need not be set up

   Not Collective

   Input Parameters:
+  mesh - the mesh
-  side - number of the side

   Output Parameter:
.  normal - [2] unit vector: across the line from the first to the last point; that of the first segment if the side closes on itself

   Level: developer

.seealso: `AbutMeshGetSideEnds()`, `AbutMeshGetSideSegments()`
@*/
PetscErrorCode AbutMeshGetSideDirection(AbutMesh mesh, PetscInt side, PetscReal normal[2])
{
  const PetscReal *x;
  PetscReal        d[2] = {0., 0.}, length = 0., h;
  PetscInt         n;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetSideSegments(mesh, side, &n, &x));
  for (PetscInt k = 0; k < n; ++k) {
    for (PetscInt i = 0; i < 2; ++i) d[i] += x[4 * k + 2 + i] - x[4 * k + i];
    length += PetscSqrtReal(PetscSqr(x[4 * k + 2] - x[4 * k]) + PetscSqr(x[4 * k + 3] - x[4 * k + 1]));
  }
  if (PetscSqrtReal(d[0] * d[0] + d[1] * d[1]) < 1e-3 * length)
    for (PetscInt i = 0; i < 2; ++i) d[i] = x[2 + i] - x[i];
  h         = PetscSqrtReal(d[0] * d[0] + d[1] * d[1]);
  normal[0] = d[1] / h;
  normal[1] = -d[0] / h;
  PetscFunctionReturn(PETSC_SUCCESS);
}
