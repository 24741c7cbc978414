#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/

/* Element matrices and their assembly. Hanging unknowns are replaced by the ends of the coarse side in the index list, with weights 1/2 in
   the element matrix. */

#define ABUT_MAX_CELL_VERTICES 8 /* a cell's own corners, two for each that hangs */

/* Stiffness of local cell c, eq. (11) of the paper, in plain loops: PetscFE's general ones cost ten times more */
PetscErrorCode AbutCellStiffness_Private(AbutBody body, PetscInt c, PetscReal K[64])
{
  static const PetscReal quad[4][2] = {
    {-0.57735026918962576, -0.57735026918962576},
    {0.57735026918962576,  -0.57735026918962576},
    {0.57735026918962576,  0.57735026918962576 },
    {-0.57735026918962576, 0.57735026918962576 }
  };
  static const PetscReal triangle[1][2] = {
    {1. / 3., 1. / 3.}
  };
  const AbutMeshTopology *t;
  PetscInt                n, npoints;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  n       = t->corners;
  npoints = n == 4 ? 4 : 1;
  for (PetscInt i = 0; i < 4 * n * n; ++i) K[i] = 0.;
  for (PetscInt q = 0; q < npoints; ++q) {
    PetscReal x[2], N[4], G[8], det, l, m;

    PetscCall(AbutMeshMapCell(body->mesh, c, n == 4 ? quad[q] : triangle[q], x, N, G, &det));
    if (n == 3) det *= 0.5;
    l = det * body->lambda;
    m = det * body->mu;
    for (PetscInt a = 0; a < n; ++a)
      for (PetscInt b = 0; b < n; ++b) {
        const PetscReal xx = G[2 * a] * G[2 * b], xy = G[2 * a] * G[2 * b + 1], yx = G[2 * a + 1] * G[2 * b],
                        yy = G[2 * a + 1] * G[2 * b + 1];
        PetscReal *k       = K + 4 * n * a + 2 * b;

        k[0] += l * xx + m * (2. * xx + yy);
        k[1] += l * xy + m * yx;
        k[2 * n] += l * yx + m * xy;
        k[2 * n + 1] += l * yy + m * (xx + 2. * yy);
      }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The vertices with unknowns that a cell sees, and the weights by which they make its corners: W[corners x n] */
static PetscInt AbutCellAnchors_Private(const AbutMeshTopology *t, PetscInt c, PetscInt vertex[], PetscReal W[], PetscBool *hanging)
{
  PetscInt n = 0;

  *hanging = PETSC_FALSE;
  for (PetscInt i = 0; i < t->corners * ABUT_MAX_CELL_VERTICES; ++i) W[i] = 0.;
  for (PetscInt k = 0; k < t->corners; ++k) {
    const PetscInt v = t->cell[t->corners * c + k], count = t->anchor[2 * v] < 0 ? 1 : 2;

    for (PetscInt i = 0; i < count; ++i) {
      const PetscInt a  = count == 1 ? v : t->anchor[2 * v + i];
      PetscInt       at = 0;

      while (at < n && vertex[at] != a) ++at;
      if (at == n) vertex[n++] = a;
      W[k * ABUT_MAX_CELL_VERTICES + at] += count == 1 ? 1. : 0.5;
      if (count == 2) *hanging = PETSC_TRUE;
    }
  }
  return n;
}

/* W^T K W: the element matrix seen by the vertices with unknowns */
static void AbutCellCondense_Private(PetscInt corners, PetscInt n, const PetscReal K[], const PetscReal W[], PetscReal out[])
{
  for (PetscInt a = 0; a < n; ++a)
    for (PetscInt b = 0; b < n; ++b) {
      PetscReal s[4] = {0., 0., 0., 0.};

      for (PetscInt k = 0; k < corners; ++k) {
        const PetscReal wk = W[k * ABUT_MAX_CELL_VERTICES + a];

        if (wk == 0.) continue;
        for (PetscInt l = 0; l < corners; ++l) {
          const PetscReal w = wk * W[l * ABUT_MAX_CELL_VERTICES + b];

          if (w == 0.) continue;
          for (PetscInt i = 0; i < 4; ++i) s[i] += w * K[(2 * k + i / 2) * 2 * corners + 2 * l + i % 2];
        }
      }
      for (PetscInt i = 0; i < 4; ++i) out[(2 * a + i / 2) * 2 * n + 2 * b + i % 2] = s[i];
    }
}

/* Pattern first: MatSetPreallocationCOO() wants all index pairs in the order in which the values will come */
static PetscErrorCode AbutBodyPattern_Private(AbutBody body, const AbutMeshTopology *t, PetscCount *count)
{
  PetscInt  *row, *column, vertex[ABUT_MAX_CELL_VERTICES];
  PetscReal  W[4 * ABUT_MAX_CELL_VERTICES];
  PetscBool  hanging;
  PetscCount n = 0;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < t->ncells; ++c) {
    const PetscInt m = AbutCellAnchors_Private(t, c, vertex, W, &hanging);

    n += 4 * m * m;
  }
  PetscCall(PetscMalloc2(n, &row, n, &column));
  *count = n;
  n      = 0;
  for (PetscInt c = 0; c < t->ncells; ++c) {
    const PetscInt m = AbutCellAnchors_Private(t, c, vertex, W, &hanging);

    for (PetscInt a = 0; a < 2 * m; ++a)
      for (PetscInt b = 0; b < 2 * m; ++b) {
        row[n]      = 2 * t->global[t->unknown[vertex[a / 2]]] + a % 2;
        column[n++] = 2 * t->global[t->unknown[vertex[b / 2]]] + b % 2;
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
  PetscInt       vertex[ABUT_MAX_CELL_VERTICES];
  PetscReal      W[4 * ABUT_MAX_CELL_VERTICES], K[64], *value;
  PetscBool      hanging;
  PetscCount     n = 0;
  PetscLogDouble start, end;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(count, &value));
  PetscCall(PetscTime(&start));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    const PetscInt m = AbutCellAnchors_Private(t, c, vertex, W, &hanging);

    if (hanging) {
      PetscCall(AbutCellStiffness_Private(body, c, K));
      AbutCellCondense_Private(t->corners, m, K, W, value + n);
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
