#include <abut/private/meshimpl.h> /*I "abutmesh.h" I*/

/* The sides of cells: numbered as the DMPLEX has them, directed by their ends, so that all ranks see the nodes of a side in one order */

/* Does a side run from a to b? It runs along the first coordinate or, if that stands still up to round-off, along the second */
static PetscBool AbutEdgeRunsForward_Private(const PetscReal a[2], const PetscReal b[2])
{
  const PetscReal d[2] = {b[0] - a[0], b[1] - a[1]};

  return (PetscBool)(PetscAbsReal(d[0]) > 1e-6 * PetscAbsReal(d[1]) ? d[0] > 0. : d[1] > 0.);
}

PetscErrorCode AbutMeshEdgesBuild_Private(AbutMesh mesh)
{
  AbutMeshTopology *t = &mesh->topology;
  PetscInt          cStart, eStart, vStart, *edge, *parent, *celledge;

  PetscFunctionBegin;
  PetscCall(DMPlexGetHeightStratum(mesh->dm, 0, &cStart, NULL));
  PetscCall(DMPlexGetDepthStratum(mesh->dm, 1, &eStart, NULL));
  PetscCall(DMPlexGetDepthStratum(mesh->dm, 0, &vStart, NULL));
  PetscCall(PetscMalloc3(2 * t->nedges, &edge, 2 * t->nedges, &parent, t->corners * t->ncells, &celledge));
  for (PetscInt e = 0; e < t->nedges; ++e) {
    const PetscInt *cone;
    PetscInt        forward, above;

    PetscCall(DMPlexGetCone(mesh->dm, e + eStart, &cone));
    forward         = AbutEdgeRunsForward_Private(t->x + 2 * (cone[0] - vStart), t->x + 2 * (cone[1] - vStart));
    edge[2 * e]     = cone[!forward] - vStart;
    edge[2 * e + 1] = cone[forward] - vStart;
    PetscCall(DMPlexGetTreeParent(mesh->dm, e + eStart, &above, NULL));
    parent[2 * e] = parent[2 * e + 1] = -1;
    if (above == e + eStart) continue;
    PetscCall(DMPlexGetCone(mesh->dm, above, &cone));
    parent[2 * e]     = above - eStart;
    parent[2 * e + 1] = edge[2 * e] != cone[0] - vStart && edge[2 * e] != cone[1] - vStart; /* it begins in the middle */
  }
  for (PetscInt c = 0; c < t->ncells; ++c) {
    const PetscInt *cone;

    PetscCall(DMPlexGetCone(mesh->dm, c + cStart, &cone));
    for (PetscInt k = 0; k < t->corners; ++k) {
      const PetscInt a = t->cell[t->corners * c + k], b = t->cell[t->corners * c + (k + 1) % t->corners];

      for (PetscInt i = 0; i < t->corners; ++i) {
        const PetscInt e = cone[i] - eStart;

        if (PetscMin(edge[2 * e], edge[2 * e + 1]) == PetscMin(a, b) && PetscMax(edge[2 * e], edge[2 * e + 1]) == PetscMax(a, b))
          celledge[t->corners * c + k] = e;
      }
    }
  }
  t->edge       = edge;
  t->edgeparent = parent;
  t->celledge   = celledge;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The nodes of a side, its ends included, beginning at one of them: [order+1] */
void AbutMeshGetEdgeNodes_Private(const AbutMeshTopology *t, PetscInt e, PetscInt from, PetscInt node[])
{
  const PetscBool forward = (PetscBool)(t->edge[2 * e] == from);
  const PetscInt  p       = t->order;

  node[forward ? 0 : p] = t->edge[2 * e];
  node[forward ? p : 0] = t->edge[2 * e + 1];
  for (PetscInt i = 1; i < p; ++i) node[forward ? i : p - i] = t->nvertices + (p - 1) * e + i - 1;
}

/* Sums v[bs*n] over the ranks at the n points of the DMPLEX of one depth */
static PetscErrorCode AbutMeshSumAtPoints_Private(AbutMesh mesh, PetscInt depth, PetscInt n, PetscInt bs, PetscReal v[])
{
  PetscInt     pStart, pEnd, start, nroots;
  PetscReal   *all;
  PetscSF      sf;
  MPI_Datatype block = MPIU_REAL; /* PetscSF does not add a block of one as a number */
  PetscMPIInt  length;

  PetscFunctionBegin;
  PetscCall(DMGetPointSF(mesh->dm, &sf));
  PetscCall(PetscSFGetGraph(sf, &nroots, NULL, NULL, NULL));
  if (nroots < 0) PetscFunctionReturn(PETSC_SUCCESS); /* one rank */
  PetscCall(DMPlexGetChart(mesh->dm, &pStart, &pEnd));
  PetscCall(DMPlexGetDepthStratum(mesh->dm, depth, &start, NULL));
  PetscCall(PetscMPIIntCast(bs, &length));
  if (length > 1) {
    PetscCallMPI(MPI_Type_contiguous(length, MPIU_REAL, &block));
    PetscCallMPI(MPI_Type_commit(&block));
  }
  PetscCall(PetscCalloc1(bs * (pEnd - pStart), &all));
  PetscCall(PetscArraycpy(all + bs * (start - pStart), v, bs * n));
  PetscCall(PetscSFReduceBegin(sf, block, all, all, MPI_SUM));
  PetscCall(PetscSFReduceEnd(sf, block, all, all, MPI_SUM));
  PetscCall(PetscSFBcastBegin(sf, block, all, all, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, block, all, all, MPI_REPLACE));
  PetscCall(PetscArraycpy(v, all + bs * (start - pStart), bs * n));
  PetscCall(PetscFree(all));
  if (length > 1) PetscCallMPI(MPI_Type_free(&block));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutMeshSumAtEdges - Sums over the ranks what each contributed to the sides of its cells

   Collective

   Input Parameters:
+  mesh - the mesh, set up
-  bs   - numbers per side

   Input/Output Parameter:
.  v - [bs*nedges] for every side of `AbutMeshTopology`: in, what this rank contributes; out, the sum over all ranks that know it

   Level: advanced

   Note:
   A coarse side is known to the ranks of the cells on both sides of it, a hanging one only where the fine cells are.

.seealso: `AbutMeshGetTopology()`, `AbutMeshSumAtVertices()`
@*/
PetscErrorCode AbutMeshSumAtEdges(AbutMesh mesh, PetscInt bs, PetscReal v[])
{
  PetscFunctionBegin;
  PetscCall(AbutMeshSumAtPoints_Private(mesh, 1, mesh->topology.nedges, bs, v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutMeshSumAtVertices - Sums over the ranks what each contributed to the vertices of its cells

   Collective

   Input Parameters:
+  mesh - the mesh, set up
-  bs   - numbers per vertex

   Input/Output Parameter:
.  v - [bs*nvertices] for every vertex of `AbutMeshTopology`: in, what this rank contributes; out, the sum over all ranks that know it

   Level: advanced

   Note:
   The ends of a coarse side are known to the ranks of the cells on both sides of it, a hanging vertex only where the fine cells are.

.seealso: `AbutMeshGetTopology()`, `AbutMeshSumAtEdges()`, `AbutEstimatorSumAtVertices()`
@*/
PetscErrorCode AbutMeshSumAtVertices(AbutMesh mesh, PetscInt bs, PetscReal v[])
{
  PetscFunctionBegin;
  PetscCall(AbutMeshSumAtPoints_Private(mesh, 0, mesh->topology.nvertices, bs, v));
  PetscFunctionReturn(PETSC_SUCCESS);
}
