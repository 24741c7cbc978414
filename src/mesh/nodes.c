#include <abut/private/meshimpl.h>

/* The nodes of the displacement: where they are, on what hanging ones hang, and the numbers of their unknowns */

/* Nodes of each cell in the order of its basis, and the coordinates of those that are no vertices */
static PetscErrorCode AbutNodesOfCells_Private(AbutMesh mesh)
{
  AbutMeshTopology *t = &mesh->topology;
  const PetscInt    p = t->order, incell = t->nodes - t->corners * p;
  PetscReal        *x = (PetscReal *)t->x, line[ABUT_SIDE_NODES_MAX], J[4];
  PetscInt         *node, side[ABUT_SIDE_NODES_MAX];

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(t->nodes * t->ncells, &node));
  PetscCall(AbutGetLobattoNodes(p, line, NULL));
  for (PetscInt e = 0; e < t->nedges; ++e)
    for (PetscInt i = 1; i < p; ++i) {
      const PetscReal s = 0.5 * (1. + line[i]), *a = x + 2 * t->edge[2 * e], *b = x + 2 * t->edge[2 * e + 1];

      for (PetscInt d = 0; d < 2; ++d) x[2 * (t->nvertices + (p - 1) * e + i - 1) + d] = (1. - s) * a[d] + s * b[d];
    }
  for (PetscInt c = 0; c < t->ncells; ++c) {
    const PetscInt *v = t->cell + t->corners * c;
    PetscInt       *n = node + t->nodes * c;

    for (PetscInt k = 0; k < t->corners; ++k) {
      n[k] = v[k];
      AbutMeshGetEdgeNodes_Private(t, t->celledge[t->corners * c + k], v[k], side);
      for (PetscInt i = 1; i < p; ++i) n[t->corners + (p - 1) * k + i - 1] = side[i];
    }
    for (PetscInt i = 0; i < incell; ++i) {
      const PetscInt k = t->corners * p + i;

      n[k] = t->nvertices + (p - 1) * t->nedges + incell * c + i;
      PetscCall(AbutMeshMapPoint(mesh, c, mesh->basis.xi + 2 * k, x + 2 * n[k], J));
    }
  }
  t->cellnode = node;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where on a coarse side its node hangs that belongs to a half of it, in [-1,1] */
static PetscReal AbutPlaceOnParent_Private(PetscInt half, PetscReal s)
{
  return 0.5 * (s + (half ? 1. : -1.));
}

/* The function of the coarse side gives a hanging node its value; in a mesh that is 2:1 across sides the coarse side itself never hangs */
static PetscErrorCode AbutNodesHang_Private(AbutMeshTopology *t)
{
  const PetscInt p = t->order;
  PetscReal     *place, line[ABUT_SIDE_NODES_MAX], N[ABUT_SIDE_NODES_MAX], *weight;
  PetscInt      *above, *anchors, *anchor, n = 0;

  PetscFunctionBegin;
  PetscCall(AbutGetLobattoNodes(p, line, NULL));
  PetscCall(PetscMalloc2(t->nnodes, &above, t->nnodes, &place)); /* the side on which a node hangs, and where */
  for (PetscInt i = 0; i < t->nnodes; ++i) above[i] = -1;
  for (PetscInt e = 0; e < t->nedges; ++e) {
    const PetscInt parent = t->edgeparent[2 * e], half = t->edgeparent[2 * e + 1];
    PetscInt       side[ABUT_SIDE_NODES_MAX];

    if (parent < 0) continue;
    AbutMeshGetEdgeNodes_Private(t, e, t->edge[2 * e], side);
    for (PetscInt i = half ? 0 : 1; i <= (half ? p - 1 : p); ++i) { /* all but the end that the two sides share */
      above[side[i]] = parent;
      place[side[i]] = AbutPlaceOnParent_Private(half, line[i]);
      ++n;
    }
  }
  PetscCall(PetscMalloc3(t->nnodes + 1, &anchors, (p + 1) * n, &anchor, (p + 1) * n, &weight));
  n = 0;
  for (PetscInt i = 0; i < t->nnodes; ++i) {
    PetscInt side[ABUT_SIDE_NODES_MAX];

    anchors[i] = n;
    if (above[i] < 0) continue;
    AbutMeshGetEdgeNodes_Private(t, above[i], t->edge[2 * above[i]], side);
    PetscCall(AbutEvaluateLobatto(p, place[i], N, NULL));
    for (PetscInt k = 0; k <= p; ++k) {
      if (PetscAbsReal(N[k]) < 1e-14) continue;
      anchor[n]   = side[k];
      weight[n++] = N[k];
    }
  }
  anchors[t->nnodes] = n;
  t->anchors         = anchors;
  t->anchor          = anchor;
  t->weight          = weight;
  PetscCall(PetscFree2(above, place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The nodes with unknowns, and their weights, on which a node hangs, added to the n of a list; returns how many the list has, at most
   ABUT_CELL_ANCHORS_MAX+1 */
static PetscInt AbutNodeExpand_Private(const AbutMeshTopology *t, PetscInt i, PetscReal w, PetscInt n, PetscInt node[], PetscReal weight[])
{
  PetscInt at = 0;

  if (t->anchors[i + 1] > t->anchors[i]) {
    for (PetscInt k = t->anchors[i]; k < t->anchors[i + 1] && n <= ABUT_CELL_ANCHORS_MAX; ++k)
      n = AbutNodeExpand_Private(t, t->anchor[k], w * t->weight[k], n, node, weight);
    return n;
  }
  while (at < n && node[at] != i) ++at;
  if (at == n) {
    node[n]     = i;
    weight[n++] = 0.;
  }
  weight[at] += w;
  return n;
}

/* Without balance an end of the coarse side, or of a half of it, may itself hang: anchors of anchors, until all have unknowns */
static PetscErrorCode AbutNodesResolve_Private(AbutMesh mesh)
{
  AbutMeshTopology *t = &mesh->topology;
  PetscInt          list[ABUT_CELL_ANCHORS_MAX + 1], *anchors, *anchor, total = 0;
  PetscReal         w[ABUT_CELL_ANCHORS_MAX + 1], *weight;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < t->ncells; ++c) {
    PetscInt n = 0;

    for (PetscInt k = 0; k < t->nodes && n <= ABUT_CELL_ANCHORS_MAX; ++k)
      n = AbutNodeExpand_Private(t, t->cellnode[t->nodes * c + k], 1., n, list, w);
    AbutCheckInput(n <= ABUT_CELL_ANCHORS_MAX, PetscObjectComm((PetscObject)mesh),
                   "%smesh_balance: a cell hangs on more than %d nodes; leave it out, or give a smaller adaptor_max_level",
                   ((PetscObject)mesh)->prefix ? ((PetscObject)mesh)->prefix : "", ABUT_CELL_ANCHORS_MAX);
  }
  for (PetscInt i = 0; i < t->nnodes; ++i)
    if (t->anchors[i + 1] > t->anchors[i]) total += AbutNodeExpand_Private(t, i, 1., 0, list, w);
  PetscCall(PetscMalloc3(t->nnodes + 1, &anchors, total, &anchor, total, &weight));
  total = 0;
  for (PetscInt i = 0; i < t->nnodes; ++i) {
    anchors[i] = total;
    if (t->anchors[i + 1] > t->anchors[i]) total += AbutNodeExpand_Private(t, i, 1., 0, anchor + total, weight + total);
  }
  anchors[t->nnodes] = total;
  PetscCall(PetscFree3(t->anchors, t->anchor, t->weight));
  t->anchors = anchors;
  t->anchor  = anchor;
  t->weight  = weight;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The nodes of one kind of points of the DMPLEX: vertices, sides, cells */
typedef struct {
  PetscInt start, n; /* points */
  PetscInt first;    /* node */
  PetscInt each;     /* nodes of a point */
} AbutStratum;

/* first[point]: the global number of its first node, on every rank that has the point; -1 where it hangs, in which case no node of it has
   unknowns */
static PetscErrorCode AbutNodesShareNumbers_Private(AbutMesh mesh, PetscInt first[])
{
  PetscSF  sf;
  PetscInt nroots;

  PetscFunctionBegin;
  PetscCall(DMGetPointSF(mesh->dm, &sf));
  PetscCall(PetscSFGetGraph(sf, &nroots, NULL, NULL, NULL));
  if (nroots < 0) PetscFunctionReturn(PETSC_SUCCESS); /* one rank */
  PetscCall(PetscSFBcastBegin(sf, MPIU_INT, first, first, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, MPIU_INT, first, first, MPI_REPLACE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Points owned by another rank */
static PetscErrorCode AbutNodesFindForeign_Private(AbutMesh mesh, PetscInt npoints, PetscBool foreign[])
{
  PetscSF         sf;
  PetscInt        nroots, nleaves;
  const PetscInt *leaves;

  PetscFunctionBegin;
  for (PetscInt p = 0; p < npoints; ++p) foreign[p] = PETSC_FALSE;
  PetscCall(DMGetPointSF(mesh->dm, &sf));
  PetscCall(PetscSFGetGraph(sf, &nroots, &nleaves, &leaves, NULL));
  for (PetscInt l = 0; l < nleaves; ++l) foreign[leaves ? leaves[l] : l] = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Hanging nodes carry no unknowns. Owned nodes come first, then those of other ranks; in both, vertices, then those inside sides, then
   those inside cells, each in the order of the DMPLEX. */
static PetscErrorCode AbutNodesNumber_Private(AbutMesh mesh, const AbutStratum s[3])
{
  MPI_Comm          comm = PetscObjectComm((PetscObject)mesh);
  AbutMeshTopology *t    = &mesh->topology;
  PetscInt          pStart, pEnd, *first, *unknown, *global, next = 0;
  PetscBool        *foreign;
  PetscMPIInt       rank;

  PetscFunctionBegin;
  PetscCall(DMPlexGetChart(mesh->dm, &pStart, &pEnd));
  PetscCall(PetscMalloc2(pEnd - pStart, &first, pEnd - pStart, &foreign));
  PetscCall(PetscMalloc2(t->nnodes, &unknown, t->nnodes, &global));
  PetscCall(AbutNodesFindForeign_Private(mesh, pEnd - pStart, foreign));
  for (PetscInt i = 0; i < t->nnodes; ++i) unknown[i] = -1;
  for (PetscInt p = 0; p < pEnd - pStart; ++p) first[p] = -1;
  for (PetscInt round = 0; round < 2; ++round) { /* owned, then foreign */
    for (PetscInt k = 0; k < 3; ++k)
      for (PetscInt i = 0; i < s[k].n * (s[k].each > 0); ++i) {
        const PetscInt point = s[k].start + i - pStart, node = s[k].first + i * s[k].each;

        if (foreign[point] != (PetscBool)round || t->anchors[node + 1] > t->anchors[node]) continue;
        if (!round) first[point] = next;
        for (PetscInt j = 0; j < s[k].each; ++j) unknown[node + j] = next++;
      }
    if (!round) t->nowned = next;
  }
  t->nunknown = next;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Exscan(&t->nowned, &t->firstowned, 1, MPIU_INT, MPI_SUM, comm));
  PetscCallMPI(MPI_Allreduce(&t->nowned, &t->nglobal, 1, MPIU_INT, MPI_SUM, comm));
  if (!rank) t->firstowned = 0;
  for (PetscInt p = 0; p < pEnd - pStart; ++p)
    if (first[p] >= 0) first[p] += t->firstowned;
  PetscCall(AbutNodesShareNumbers_Private(mesh, first));
  for (PetscInt k = 0; k < 3; ++k)
    for (PetscInt i = 0; i < s[k].n * s[k].each; ++i) {
      const PetscInt point = s[k].start + i / s[k].each - pStart, node = s[k].first + i;

      if (unknown[node] < 0) continue;
      PetscCheck(first[point] >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "A node with unknowns is not numbered by its owner");
      global[unknown[node]] = first[point] + i % s[k].each;
    }
  t->unknown = unknown;
  t->global  = global;
  PetscCall(PetscFree2(first, foreign));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutMeshNodesBuild_Private(AbutMesh mesh)
{
  AbutMeshTopology *t = &mesh->topology;
  AbutStratum       s[3];

  PetscFunctionBegin;
  PetscCall(AbutNodesOfCells_Private(mesh));
  PetscCall(AbutNodesHang_Private(t));
  if (!mesh->balance) PetscCall(AbutNodesResolve_Private(mesh));
  s[0] = (AbutStratum){.n = t->nvertices, .first = 0, .each = 1};
  s[1] = (AbutStratum){.n = t->nedges, .first = t->nvertices, .each = t->order - 1};
  s[2] = (AbutStratum){.n = t->ncells, .first = t->nvertices + (t->order - 1) * t->nedges, .each = t->nodes - t->corners * t->order};
  PetscCall(DMPlexGetDepthStratum(mesh->dm, 0, &s[0].start, NULL));
  PetscCall(DMPlexGetDepthStratum(mesh->dm, 1, &s[1].start, NULL));
  PetscCall(DMPlexGetHeightStratum(mesh->dm, 0, &s[2].start, NULL));
  PetscCall(AbutNodesNumber_Private(mesh, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
