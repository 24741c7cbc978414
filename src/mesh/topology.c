#include <abut/private/meshimpl.h> /*I "abutmesh.h" I*/

/* Plain arrays of the local part of a DMPLEX: coordinates and cells; sides are in edges.c, nodes and unknowns in nodes.c */

/* Room for all nodes: those inside sides and cells get theirs when these are known */
static PetscErrorCode AbutTopologyVertices_Private(AbutMesh mesh, PetscInt vStart)
{
  AbutMeshTopology  *t = &mesh->topology;
  PetscReal         *x;
  const PetscScalar *xa;
  Vec                coordinates;
  PetscSection       section;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(2 * t->nnodes, &x));
  PetscCall(DMGetCoordinatesLocal(mesh->dm, &coordinates));
  PetscCall(DMGetCoordinateSection(mesh->dm, &section));
  PetscCall(VecGetArrayRead(coordinates, &xa));
  for (PetscInt v = 0; v < t->nvertices; ++v) {
    PetscInt offset;

    PetscCall(PetscSectionGetOffset(section, v + vStart, &offset));
    x[2 * v]     = xa[offset];
    x[2 * v + 1] = xa[offset + 1];
  }
  PetscCall(VecRestoreArrayRead(coordinates, &xa));
  t->x = x;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutTopologyCells_Private(AbutMesh mesh, PetscInt cStart, PetscInt vStart)
{
  AbutMeshTopology *t = &mesh->topology;
  PetscInt         *cell, *level;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(t->corners * t->ncells, &cell, t->ncells, &level));
  t->cell  = cell;
  t->level = level;
  for (PetscInt c = 0; c < t->ncells; ++c) {
    PetscInt       *v = cell + t->corners * c;
    const PetscInt *side, *orientation, *ends, n = t->corners;

    PetscCall(DMPlexGetCone(mesh->dm, c + cStart, &side));
    PetscCall(DMPlexGetConeOrientation(mesh->dm, c + cStart, &orientation));
    for (PetscInt k = 0; k < n; ++k) { /* each side begins where the one before it ends */
      PetscCall(DMPlexGetCone(mesh->dm, side[k], &ends));
      v[k] = ends[orientation[k] < 0] - vStart;
    }
    {
      const PetscReal *a = t->x + 2 * v[0], *b = t->x + 2 * v[1], *d = t->x + 2 * v[n - 1];

      if ((b[0] - a[0]) * (d[1] - a[1]) - (b[1] - a[1]) * (d[0] - a[0]) < 0.) { /* clockwise: turn it round */
        const PetscInt second = v[1];

        v[1]     = v[n - 1];
        v[n - 1] = second;
      }
    }
  }
  PetscUseTypeMethod(mesh, getlevels, level);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutMeshTopologyBuild_Private(AbutMesh mesh)
{
  AbutMeshTopology *t = &mesh->topology;
  PetscInt          cStart, cEnd, eStart, eEnd, vStart, vEnd, incell;

  PetscFunctionBegin;
  PetscCall(DMPlexGetHeightStratum(mesh->dm, 0, &cStart, &cEnd));
  PetscCall(DMPlexGetDepthStratum(mesh->dm, 1, &eStart, &eEnd));
  PetscCall(DMPlexGetDepthStratum(mesh->dm, 0, &vStart, &vEnd));
  t->order     = mesh->order;
  t->corners   = mesh->shape == ABUT_QUAD ? 4 : 3;
  t->ncells    = cEnd - cStart;
  t->nedges    = eEnd - eStart;
  t->nvertices = vEnd - vStart;
  PetscCall(AbutBasisSetUp_Private(t->corners, t->order, &mesh->basis));
  t->nodes  = mesh->basis.nodes;
  incell    = t->nodes - t->corners * t->order;
  t->nnodes = t->nvertices + (t->order - 1) * t->nedges + incell * t->ncells;
  PetscCall(AbutTopologyVertices_Private(mesh, vStart));
  PetscCall(AbutTopologyCells_Private(mesh, cStart, vStart));
  PetscCall(AbutMeshEdgesBuild_Private(mesh));
  PetscCall(AbutMeshMoveToTies_Private(mesh, t->nvertices, (PetscReal *)t->x)); /* the rest knows the coordinates of the DMPLEX */
  PetscCall(AbutMeshNodesBuild_Private(mesh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutMeshTopologyReset_Private(AbutMesh mesh)
{
  AbutMeshTopology *t = &mesh->topology;

  PetscFunctionBegin;
  PetscCall(PetscFree(t->x));
  PetscCall(PetscFree2(t->cell, t->level));
  PetscCall(PetscFree3(t->edge, t->edgeparent, t->celledge));
  PetscCall(PetscFree(t->cellnode));
  PetscCall(PetscFree3(t->anchors, t->anchor, t->weight));
  PetscCall(PetscFree2(t->unknown, t->global));
  PetscCall(PetscFree3(t->sideedge, t->sidenode, t->sidecell));
  PetscCall(PetscMemzero(t, sizeof(*t)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutMeshGetTopology - Plain arrays of the local part of the mesh

   Not Collective

   Input Parameter:
.  mesh - the mesh

   Output Parameter:
.  topology - the arrays, owned by the mesh, valid until it adapts

   Level: developer

.seealso: `AbutMeshGetDM()`, `AbutMeshAdapt()`
@*/
PetscErrorCode AbutMeshGetTopology(AbutMesh mesh, const AbutMeshTopology **topology)
{
  PetscFunctionBegin;
  *topology = &mesh->topology;
  PetscFunctionReturn(PETSC_SUCCESS);
}
