#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/

/* Assembly of the element matrices. Hanging unknowns are replaced by their anchors in the index list, with weights in the element matrix. */

#define ABUT_CELL_ANCHORS_MAX (ABUT_CELL_NODES_MAX + 2 * ABUT_SIDE_NODES_MAX) /* at most two sides of a cell hang */

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

/* Pattern first: MatSetPreallocationCOO() wants all index pairs in the order in which the values will come */
static PetscErrorCode AbutBodyPattern_Private(AbutBody body, const AbutMeshTopology *t, PetscCount *count)
{
  PetscInt  *row, *column, node[ABUT_CELL_ANCHORS_MAX];
  PetscReal  W[ABUT_CELL_NODES_MAX * ABUT_CELL_ANCHORS_MAX];
  PetscBool  hanging;
  PetscCount n = 0;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < t->ncells; ++c) {
    const PetscInt m = AbutCellAnchors_Private(t, c, node, W, &hanging);

    n += 4 * m * m;
  }
  PetscCall(PetscMalloc2(n, &row, n, &column));
  *count = n;
  n      = 0;
  for (PetscInt c = 0; c < t->ncells; ++c) {
    const PetscInt m = AbutCellAnchors_Private(t, c, node, W, &hanging);

    for (PetscInt a = 0; a < 2 * m; ++a)
      for (PetscInt b = 0; b < 2 * m; ++b) {
        row[n]      = 2 * t->global[t->unknown[node[a / 2]]] + a % 2;
        column[n++] = 2 * t->global[t->unknown[node[b / 2]]] + b % 2;
      }
  }
  PetscCall(MatCreate(PetscObjectComm((PetscObject)body), &body->A));
  PetscCall(MatSetSizes(body->A, 2 * t->nowned, 2 * t->nowned, 2 * t->nglobal, 2 * t->nglobal));
  PetscCall(MatSetBlockSize(body->A, 2));
  PetscCall(MatSetType(body->A, MATAIJ));
  PetscCall(MatSetPreallocationCOO(body->A, n, row, column));
  PetscCall(PetscFree2(row, column));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutBodyValues_Private(AbutBody body, const AbutMeshTopology *t, PetscCount count)
{
  PetscInt       node[ABUT_CELL_ANCHORS_MAX];
  PetscReal      W[ABUT_CELL_NODES_MAX * ABUT_CELL_ANCHORS_MAX], K[4 * ABUT_CELL_NODES_MAX * ABUT_CELL_NODES_MAX], *value;
  PetscBool      hanging;
  PetscCount     n = 0;
  PetscLogDouble start, end;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(count, &value));
  PetscCall(PetscTime(&start));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    const PetscInt m = AbutCellAnchors_Private(t, c, node, W, &hanging);

    if (hanging) {
      PetscCall(AbutCellStiffness_Private(body, c, K));
      AbutCellCondense_Private(t->nodes, m, K, W, value + n);
    } else PetscCall(AbutCellStiffness_Private(body, c, value + n));
    n += 4 * m * m;
  }
  PetscCall(MatSetValuesCOO(body->A, value, INSERT_VALUES));
  PetscCall(PetscTime(&end));
  body->assemblytime += end - start;
  body->assemblycells += t->ncells;
  PetscCall(PetscFree(value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prescribed unknowns stay in the system (block size 2 is what makes BoomerAMG work): their rows are kept aside for the lift of the
   right-hand side and for the reactions, then rows and columns are cleared with mu on the diagonal */
PetscErrorCode AbutBodyAssemble_Private(AbutBody body)
{
  const AbutMeshTopology *t;
  PetscCount              count;
  IS                      columns;

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(ABUTBODY_Assemble, body, 0, 0, 0));
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  PetscCall(AbutBodyPattern_Private(body, t, &count));
  PetscCall(AbutBodyValues_Private(body, t, count));
  PetscCall(ISCreateStride(PetscObjectComm((PetscObject)body), 2 * t->nowned, 2 * t->firstowned, 1, &columns));
  PetscCall(MatCreateSubMatrix(body->A, body->constrained, columns, MAT_INITIAL_MATRIX, &body->Ac));
  PetscCall(ISDestroy(&columns));
  PetscCall(MatMultTranspose(body->Ac, body->prescribed, body->lift));
  PetscCall(VecScale(body->lift, -1.));
  PetscCall(MatZeroRowsColumnsIS(body->A, body->constrained, body->mu, NULL, NULL));
  PetscCall(PetscLogEventEnd(ABUTBODY_Assemble, body, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetAssemblyCost - Seconds spent on element matrices and their insertion, and for how many cells

   Collective

   Input Parameter:
.  body - the body

   Output Parameters:
+  seconds - over all meshes so far, the slowest rank
-  cells   - assembled so far, over all ranks

   Level: developer

.seealso: `AbutBodySetUp()`
@*/
PetscErrorCode AbutBodyGetAssemblyCost(AbutBody body, PetscReal *seconds, PetscInt *cells)
{
  MPI_Comm comm = PetscObjectComm((PetscObject)body);

  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(&body->assemblytime, seconds, 1, MPIU_REAL, MPIU_MAX, comm));
  PetscCallMPI(MPI_Allreduce(&body->assemblycells, cells, 1, MPIU_INT, MPI_SUM, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
