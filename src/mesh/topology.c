#include <abut/private/meshimpl.h> /*I "abutmesh.h" I*/

/* Plain arrays of the local part of a DMPLEX: coordinates, cells, hanging vertices, and the numbering of the unknowns */

static PetscErrorCode AbutTopologyVertices_Private(AbutMesh mesh, PetscInt vStart)
{
  AbutMeshTopology *t = &mesh->topology;
  PetscReal        *x;
  PetscInt         *anchor;
  const PetscReal  *xa;
  Vec               coordinates;
  PetscSection      section;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(2 * t->nvertices, &x, 2 * t->nvertices, &anchor));
  PetscCall(DMGetCoordinatesLocal(mesh->dm, &coordinates));
  PetscCall(DMGetCoordinateSection(mesh->dm, &section));
  PetscCall(VecGetArrayRead(coordinates, &xa));
  for (PetscInt v = 0; v < t->nvertices; ++v) {
    PetscInt        offset, parent;
    const PetscInt *cone;

    PetscCall(PetscSectionGetOffset(section, v + vStart, &offset));
    x[2 * v]     = xa[offset];
    x[2 * v + 1] = xa[offset + 1];
    PetscCall(DMPlexGetTreeParent(mesh->dm, v + vStart, &parent, NULL));
    anchor[2 * v] = anchor[2 * v + 1] = -1;
    if (parent == v + vStart) continue;
    PetscCall(DMPlexGetCone(mesh->dm, parent, &cone)); /* a hanging vertex is the middle of the coarse side above it */
    for (PetscInt i = 0; i < 2; ++i) anchor[2 * v + i] = cone[i] - vStart;
  }
  PetscCall(VecRestoreArrayRead(coordinates, &xa));
  t->x      = x;
  t->anchor = anchor;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutTopologyCells_Private(AbutMesh mesh, PetscInt cStart, PetscInt vStart, PetscInt vEnd)
{
  AbutMeshTopology *t = &mesh->topology;
  PetscInt         *cell, *level;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(t->corners * t->ncells, &cell, t->ncells, &level));
  t->cell  = cell;
  t->level = level;
  for (PetscInt c = 0; c < t->ncells; ++c) {
    PetscInt *closure = NULL, nclosure, n = 0, *v = cell + t->corners * c;

    PetscCall(DMPlexGetTransitiveClosure(mesh->dm, c + cStart, PETSC_TRUE, &nclosure, &closure));
    for (PetscInt i = 0; i < nclosure; ++i)
      if (closure[2 * i] >= vStart && closure[2 * i] < vEnd) v[n++] = closure[2 * i] - vStart;
    PetscCall(DMPlexRestoreTransitiveClosure(mesh->dm, c + cStart, PETSC_TRUE, &nclosure, &closure));
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

/* Hanging vertices carry no unknowns. Owned vertices come first, then those of other ranks, each in the order of the DMPLEX. */
static PetscErrorCode AbutTopologyNumbering_Private(AbutMesh mesh, PetscInt vStart)
{
  AbutMeshTopology  *t = &mesh->topology;
  PetscSF            sf;
  PetscInt           pStart, pEnd, nroots, nleaves, *number, *unknown, *global, next = 0, ghost;
  const PetscInt    *leaves;
  const PetscSFNode *remote;

  PetscFunctionBegin;
  PetscCall(DMGetPointSF(mesh->dm, &sf));
  PetscCall(DMPlexGetChart(mesh->dm, &pStart, &pEnd));
  PetscCall(PetscSFGetGraph(sf, &nroots, &nleaves, &leaves, &remote));
  PetscCall(PetscMalloc1(pEnd - pStart, &number));
  PetscCall(PetscMalloc2(t->nvertices, &unknown, t->nvertices, &global));
  for (PetscInt p = 0; p < pEnd - pStart; ++p) number[p] = 0;
  for (PetscInt l = 0; l < nleaves; ++l) number[leaves ? leaves[l] : l] = -1; /* owned elsewhere */
  for (PetscInt v = 0; v < t->nvertices; ++v) {
    unknown[v] = -1;
    if (t->anchor[2 * v] < 0 && number[v + vStart - pStart] >= 0) unknown[v] = next++;
  }
  t->nowned = next;
  PetscCallMPI(MPI_Exscan(&t->nowned, &t->firstowned, 1, MPIU_INT, MPI_SUM, PetscObjectComm((PetscObject)mesh)));
  PetscCallMPI(MPI_Allreduce(&t->nowned, &t->nglobal, 1, MPIU_INT, MPI_SUM, PetscObjectComm((PetscObject)mesh)));
  {
    PetscMPIInt rank;

    PetscCallMPI(MPI_Comm_rank(PetscObjectComm((PetscObject)mesh), &rank));
    if (!rank) t->firstowned = 0;
  }
  for (PetscInt v = 0; v < t->nvertices; ++v) number[v + vStart - pStart] = unknown[v] < 0 ? -1 : t->firstowned + unknown[v];
  if (nroots >= 0) {
    PetscCall(PetscSFBcastBegin(sf, MPIU_INT, number, number, MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(sf, MPIU_INT, number, number, MPI_REPLACE));
  }
  ghost = t->nowned;
  for (PetscInt v = 0; v < t->nvertices; ++v) {
    if (t->anchor[2 * v] >= 0) continue;
    if (unknown[v] < 0) unknown[v] = ghost++;
    global[unknown[v]] = number[v + vStart - pStart];
    PetscCheck(global[unknown[v]] >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "A vertex with unknowns is not numbered by its owner");
  }
  t->nunknown = ghost;
  t->unknown  = unknown;
  t->global   = global;
  PetscCall(PetscFree(number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutMeshTopologyBuild_Private(AbutMesh mesh)
{
  AbutMeshTopology *t = &mesh->topology;
  PetscInt          cStart, cEnd, vStart, vEnd;

  PetscFunctionBegin;
  PetscCall(DMPlexGetHeightStratum(mesh->dm, 0, &cStart, &cEnd));
  PetscCall(DMPlexGetDepthStratum(mesh->dm, 0, &vStart, &vEnd));
  t->ncells    = cEnd - cStart;
  t->nvertices = vEnd - vStart;
  t->corners   = mesh->shape == ABUT_QUAD ? 4 : 3;
  PetscCall(AbutTopologyVertices_Private(mesh, vStart));
  PetscCall(AbutTopologyCells_Private(mesh, cStart, vStart, vEnd));
  PetscCall(AbutTopologyNumbering_Private(mesh, vStart));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutMeshTopologyReset_Private(AbutMesh mesh)
{
  AbutMeshTopology *t = &mesh->topology;

  PetscFunctionBegin;
  PetscCall(PetscFree2(t->x, t->anchor));
  PetscCall(PetscFree2(t->cell, t->level));
  PetscCall(PetscFree2(t->unknown, t->global));
  PetscCall(PetscFree2(t->sideedge, t->sidecell));
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
