#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/

/* Assembly of the element matrices. Hanging unknowns are replaced by their anchors in the index list, with weights in the element
   matrix. */

/* The nodes with unknowns that a cell sees, and the weights by which they make its own nodes: W[nodes x n] */
static PetscInt AbutCellAnchors_Private(const AbutMeshTopology *t, PetscInt c, PetscInt node[], PetscReal W[], PetscBool *hanging)
{
  const PetscInt *own = t->cellnode + t->nodes * c;
  PetscInt        n   = 0;

  *hanging = PETSC_FALSE;
  for (PetscInt k = 0; k < t->nodes; ++k)
    if (t->anchors[own[k] + 1] > t->anchors[own[k]]) *hanging = PETSC_TRUE;
  if (!*hanging) {
    for (PetscInt k = 0; k < t->nodes; ++k) node[k] = own[k];
    return t->nodes;
  }
  for (PetscInt i = 0; i < t->nodes * ABUT_CELL_ANCHORS_MAX; ++i) W[i] = 0.;
  for (PetscInt k = 0; k < t->nodes; ++k) {
    const PetscInt first = t->anchors[own[k]], count = t->anchors[own[k] + 1] - first;

    for (PetscInt i = 0; i < PetscMax(1, count); ++i) {
      const PetscInt a  = count ? t->anchor[first + i] : own[k];
      PetscInt       at = 0;

      while (at < n && node[at] != a) ++at;
      if (at == n) node[n++] = a;
      W[k * ABUT_CELL_ANCHORS_MAX + at] += count ? t->weight[first + i] : 1.;
    }
  }
  return n;
}

/* W^T K W: the element matrix seen by the nodes with unknowns */
static void AbutCellCondense_Private(PetscInt nodes, PetscInt n, const PetscReal K[], const PetscReal W[], PetscReal out[])
{
  PetscReal KW[4 * ABUT_CELL_NODES_MAX * ABUT_CELL_ANCHORS_MAX];

  for (PetscInt i = 0; i < 4 * nodes * n; ++i) KW[i] = 0.;
  for (PetscInt i = 0; i < 4 * n * n; ++i) out[i] = 0.;
  for (PetscInt l = 0; l < nodes; ++l)
    for (PetscInt b = 0; b < n; ++b) {
      const PetscReal w = W[l * ABUT_CELL_ANCHORS_MAX + b];

      for (PetscInt k = 0; w != 0. && k < 4 * nodes; ++k) KW[k / 2 * 2 * n + 2 * b + k % 2] += w * K[k / 2 * 2 * nodes + 2 * l + k % 2];
    }
  for (PetscInt k = 0; k < nodes; ++k)
    for (PetscInt a = 0; a < n; ++a) {
      const PetscReal w = W[k * ABUT_CELL_ANCHORS_MAX + a];

      for (PetscInt i = 0; w != 0. && i < 4 * n; ++i) out[(2 * a) * 2 * n + i] += w * KW[(2 * k) * 2 * n + i];
    }
}

/* The nodes with unknowns that each local cell sees: list[start[c]..start[c+1]-1] */
typedef struct {
  PetscInt *start, *list;
} AbutCellLists;

static PetscErrorCode AbutCellListsCreate_Private(const AbutMeshTopology *t, AbutCellLists *cells)
{
  PetscInt  node[ABUT_CELL_ANCHORS_MAX], room = t->nodes * t->ncells + 16, n = 0;
  PetscReal W[ABUT_CELL_NODES_MAX * ABUT_CELL_ANCHORS_MAX];
  PetscBool hanging;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(t->ncells + 1, &cells->start));
  PetscCall(PetscMalloc1(room, &cells->list));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    const PetscInt m = AbutCellAnchors_Private(t, c, node, W, &hanging);

    if (n + m > room) {
      room += room / 2 + m;
      PetscCall(PetscRealloc(room * sizeof(PetscInt), &cells->list));
    }
    cells->start[c] = n;
    for (PetscInt i = 0; i < m; ++i) cells->list[n++] = t->unknown[node[i]];
  }
  cells->start[t->ncells] = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How many nodes each node meets in the cells of this rank, itself included: owned by this rank, and not */
static PetscErrorCode AbutCountNeighbours_Private(const AbutMeshTopology *t, const AbutCellLists *cells, PetscReal count[])
{
  PetscInt *first, *cell, *seen;

  PetscFunctionBegin;
  PetscCall(PetscCalloc3(t->nunknown + 2, &first, cells->start[t->ncells], &cell, t->nunknown, &seen));
  for (PetscInt i = 0; i < cells->start[t->ncells]; ++i) ++first[cells->list[i] + 2];
  for (PetscInt k = 0; k < t->nunknown; ++k) first[k + 2] += first[k + 1];
  for (PetscInt c = 0; c < t->ncells; ++c)
    for (PetscInt i = cells->start[c]; i < cells->start[c + 1]; ++i) cell[first[cells->list[i] + 1]++] = c;
  for (PetscInt k = 0; k < t->nunknown; ++k)
    for (PetscInt j = first[k]; j < first[k + 1]; ++j)
      for (PetscInt i = cells->start[cell[j]]; i < cells->start[cell[j] + 1]; ++i) {
        const PetscInt other = cells->list[i];

        if (seen[other] == k + 1) continue;
        seen[other] = k + 1;
        count[2 * k + (other >= t->nowned)] += 1.;
      }
  PetscCall(PetscFree3(first, cell, seen));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Room in the rows of the matrix. What another rank's cells add to a row is counted by that rank, for both kinds of columns: a little too
   much where ranks meet. */
static PetscErrorCode AbutBodyPreallocate_Private(AbutBody body, const AbutMeshTopology *t)
{
  AbutCellLists cells;
  Vec           count, local;
  PetscScalar  *a;
  PetscInt     *diagonal, *off;

  PetscFunctionBegin;
  PetscCall(AbutCellListsCreate_Private(t, &cells));
  PetscCall(VecDuplicate(body->u, &count));
  PetscCall(VecGhostGetLocalForm(count, &local));
  PetscCall(VecZeroEntries(local));
  PetscCall(VecGetArray(local, &a));
  PetscCall(AbutCountNeighbours_Private(t, &cells, a));
  for (PetscInt k = t->nowned; k < t->nunknown; ++k) a[2 * k] = a[2 * k + 1] = a[2 * k] + a[2 * k + 1];
  PetscCall(VecRestoreArray(local, &a));
  PetscCall(VecGhostRestoreLocalForm(count, &local));
  PetscCall(VecGhostUpdateBegin(count, ADD_VALUES, SCATTER_REVERSE));
  PetscCall(VecGhostUpdateEnd(count, ADD_VALUES, SCATTER_REVERSE));
  PetscCall(PetscMalloc2(t->nowned, &diagonal, t->nowned, &off));
  PetscCall(VecGetArray(count, &a));
  for (PetscInt k = 0; k < t->nowned; ++k) {
    diagonal[k] = PetscMin((PetscInt)a[2 * k], t->nowned);
    off[k]      = PetscMin((PetscInt)a[2 * k + 1], t->nglobal - t->nowned);
  }
  PetscCall(VecRestoreArray(count, &a));
  PetscCall(VecDestroy(&count));
  PetscCall(AbutBodyCreateGroupMat_Private(body, diagonal, off, &body->A));
  PetscCall(PetscFree2(diagonal, off));
  PetscCall(PetscFree(cells.start));
  PetscCall(PetscFree(cells.list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutBodyValues_Private(AbutBody body, const AbutMeshTopology *t)
{
  PetscInt       node[ABUT_CELL_ANCHORS_MAX];
  PetscReal      W[ABUT_CELL_NODES_MAX * ABUT_CELL_ANCHORS_MAX], *K[2];
  PetscBool      hanging;
  PetscLogDouble start, end;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(4 * t->nodes * t->nodes, &K[0], 4 * ABUT_CELL_ANCHORS_MAX * ABUT_CELL_ANCHORS_MAX, &K[1]));
  PetscCall(PetscTime(&start));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    const PetscInt n = AbutCellAnchors_Private(t, c, node, W, &hanging);

    for (PetscInt i = 0; i < n; ++i) node[i] = t->global[t->unknown[node[i]]];
    PetscCall((*body->cell->stiffness)(body, c, K[0]));
    if (hanging) AbutCellCondense_Private(t->nodes, n, K[0], W, K[1]);
    PetscCall(MatSetValuesBlocked(body->A, n, node, n, node, K[hanging], ADD_VALUES));
  }
  PetscCall(MatAssemblyBegin(body->A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(body->A, MAT_FINAL_ASSEMBLY));
  PetscCall(PetscTime(&end));
  body->assemblytime += end - start;
  body->assemblycells += t->ncells;
  PetscCall(PetscFree2(K[0], K[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prescribed unknowns stay in the system (block size 2 is what makes BoomerAMG work): their rows are kept aside for the lift of the
   right-hand side and for the reactions, then rows and columns are cleared with mu on the diagonal */
PetscErrorCode AbutBodyAssemble_Private(AbutBody body)
{
  const AbutMeshTopology *t;
  IS                      columns;

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(body->assembly, body, 0, 0, 0));
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  PetscCall(AbutBodyPreallocate_Private(body, t));
  PetscCall(AbutBodyValues_Private(body, t));
  PetscCall(AbutBodyAssembleFoundation_Private(body));
  PetscCall(ISCreateStride(body->group, 2 * t->nowned, 2 * t->firstowned, 1, &columns));
  PetscCall(MatCreateSubMatrix(body->A, body->constrained, columns, MAT_INITIAL_MATRIX, &body->Ac));
  PetscCall(ISDestroy(&columns));
  PetscCall(AbutBodyLift_Private(body));
  PetscCall(MatZeroRowsColumnsIS(body->A, body->constrained, body->mu, NULL, NULL));
  PetscCall(PetscLogEventEnd(body->assembly, body, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
