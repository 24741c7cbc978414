#include "first.h" /*I "abutmesh.h" I*/

/* How a mesh became what it is: every set of ties, every split and every merge since the first mesh, by which a restarted run makes the
   same mesh again, on any number of ranks. Marked cells are known by their centres. */

typedef enum {
  ABUT_STEP_TIES,  /* new ties, see AbutMeshSetTies() */
  ABUT_STEP_MOVE,  /* the mesh moved to them */
  ABUT_STEP_SPLIT, /* cells were split, those marked in the step before merged, and the mesh moved */
  ABUT_STEP_MERGE  /* cells were marked that may be merged, see AbutMeshSetCoarsening() */
} AbutStepKind;

struct _AbutMeshStep {
  PetscInt   kind, n; /* how many ties, or local cells */
  PetscReal *value;   /* [3 or 2 each] side, reference, wanted; or x, y */
};

/*@
   AbutMeshKeepJournal - From now on a mesh keeps in mind how it is refined

   Logically Collective

   Input Parameter:
.  mesh - the mesh, before it is adapted

   Level: developer

   Note:
   Costs 16 bytes for each cell that is marked.

.seealso: `AbutMeshArchive()`
@*/
PetscErrorCode AbutMeshKeepJournal(AbutMesh mesh)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(mesh, ABUTMESH_CLASSID, 1);
  PetscCheck(!mesh->generation, PetscObjectComm((PetscObject)mesh), PETSC_ERR_ORDER, "Call AbutMeshKeepJournal() before the mesh adapts");
  mesh->journal = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutJournalAdd_Private(AbutMesh mesh, PetscInt kind, PetscInt n, PetscInt each, AbutMeshStep *step)
{
  PetscFunctionBegin;
  if (mesh->nsteps == mesh->maxsteps) {
    mesh->maxsteps = 2 * mesh->maxsteps + 16;
    PetscCall(PetscRealloc(sizeof(**step) * mesh->maxsteps, &mesh->step));
  }
  *step          = &mesh->step[mesh->nsteps++];
  (*step)->kind  = kind;
  (*step)->n     = n;
  (*step)->value = NULL;
  PetscCall(PetscMalloc1(each * n, &(*step)->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutJournalTies_Private(AbutMesh mesh, PetscInt n, const AbutTie tie[])
{
  AbutMeshStep step;

  PetscFunctionBegin;
  if (!mesh->journal) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutJournalAdd_Private(mesh, ABUT_STEP_TIES, n, 3, &step));
  for (PetscInt i = 0; i < n; ++i) {
    step->value[3 * i]     = tie[i].side;
    step->value[3 * i + 1] = tie[i].reference;
    step->value[3 * i + 2] = tie[i].wanted;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the size of a cell, too */
static PetscReal AbutJournalCentre_Private(const AbutMeshTopology *t, PetscInt c, PetscReal x[2])
{
  const PetscInt *corner = t->cell + t->corners * c;

  for (PetscInt d = 0; d < 2; ++d) {
    x[d] = 0.;
    for (PetscInt k = 0; k < t->corners; ++k) x[d] += t->x[2 * corner[k] + d] / t->corners;
  }
  return PetscMax(PetscAbsReal(x[0] - t->x[2 * corner[0]]), PetscAbsReal(x[1] - t->x[2 * corner[0] + 1]));
}

static PetscErrorCode AbutJournalMarks_Private(AbutMesh mesh, PetscInt kind, const PetscBool mark[])
{
  const AbutMeshTopology *t = &mesh->topology;
  AbutMeshStep            step;
  PetscInt                n = 0;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < t->ncells && mark; ++c) n += mark[c];
  PetscCall(AbutJournalAdd_Private(mesh, kind, n, 2, &step));
  n = 0;
  for (PetscInt c = 0; c < t->ncells && mark; ++c)
    if (mark[c]) (void)AbutJournalCentre_Private(t, c, step->value + 2 * n++);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Before the mesh changes; without cells to split or merge it only moves */
PetscErrorCode AbutJournalAdapt_Private(AbutMesh mesh, PetscBool changes, const PetscBool mark[])
{
  PetscFunctionBegin;
  if (!mesh->journal) PetscFunctionReturn(PETSC_SUCCESS);
  if (mesh->coarsen) PetscCall(AbutJournalMarks_Private(mesh, ABUT_STEP_MERGE, mesh->coarsen));
  PetscCall(AbutJournalMarks_Private(mesh, changes ? ABUT_STEP_SPLIT : ABUT_STEP_MOVE, changes ? mark : NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutJournalDestroy_Private(AbutMesh mesh)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < mesh->nsteps; ++i) PetscCall(PetscFree(mesh->step[i].value));
  PetscCall(PetscFree(mesh->step));
  mesh->nsteps = mesh->maxsteps = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* By the first coordinate, then by the second one */
int AbutPointCompare_Private(const void *a, const void *b)
{
  const PetscReal *x = (const PetscReal *)a, *y = (const PetscReal *)b;

  if (x[0] != y[0]) return x[0] > y[0] ? 1 : -1;
  return (x[1] > y[1]) - (x[1] < y[1]);
}

/* The points of all ranks on all ranks, in order; each has so many numbers, of which the first two are its coordinates */
PetscErrorCode AbutPointsGather_Private(MPI_Comm comm, PetscInt each, PetscInt n, const PetscReal mine[], PetscInt *nall, PetscReal **all)
{
  PetscMPIInt size, count, *counts, *first;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMPIIntCast(each * n, &count));
  PetscCall(PetscMalloc2(size, &counts, size + 1, &first));
  PetscCallMPI(MPI_Allgather(&count, 1, MPI_INT, counts, 1, MPI_INT, comm));
  first[0] = 0;
  for (PetscMPIInt r = 0; r < size; ++r) first[r + 1] = first[r] + counts[r];
  *nall = first[size] / each;
  PetscCall(PetscMalloc1(first[size], all));
  PetscCallMPI(MPI_Allgatherv(mine, count, MPIU_REAL, *all, counts, first, MPIU_REAL, comm));
  if (*nall) qsort(*all, (size_t)*nall, (size_t)each * sizeof(PetscReal), AbutPointCompare_Private);
  PetscCall(PetscFree2(counts, first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks the local cells whose centres are in the list, but for round-off: another rank may sum corners in another order */
static PetscInt AbutJournalFind_Private(const AbutMeshTopology *t, PetscInt n, const PetscReal centre[], PetscBool mark[])
{
  PetscInt found = 0;

  for (PetscInt c = 0; c < t->ncells; ++c) {
    PetscReal x[2];
    PetscReal near = 1e-6 * AbutJournalCentre_Private(t, c, x);
    PetscInt  low = 0, high = n;

    while (low < high) {
      const PetscInt middle = (low + high) / 2;

      if (centre[2 * middle] < x[0] - near) low = middle + 1;
      else high = middle;
    }
    mark[c] = PETSC_FALSE;
    for (; low < n && centre[2 * low] <= x[0] + near && !mark[c]; ++low)
      mark[c] = (PetscBool)(PetscAbsReal(centre[2 * low + 1] - x[1]) <= near);
    found += mark[c];
  }
  return found;
}

/* Whether three numbers are a tie of the mesh: a vertex between the ends of a side */
static PetscBool AbutJournalHasTie_Private(AbutMesh mesh, const PetscReal value[3])
{
  const PetscInt d = !(value[0] >= 2.);

  return (PetscBool)(!mesh->first && value[0] >= 0. && value[0] < ABUT_BOX_SIDES && value[1] > mesh->lower[d] &&
                     value[1] < mesh->upper[d] && value[2] > mesh->lower[d] && value[2] < mesh->upper[d]);
}

/* Does again what the journal says */
static PetscErrorCode AbutJournalReplay_Private(AbutMesh mesh, PetscInt kind, PetscInt n, const PetscReal value[], PetscBool *same)
{
  MPI_Comm   comm = PetscObjectComm((PetscObject)mesh);
  AbutTie   *tie;
  PetscBool *mark;
  PetscInt   found;

  PetscFunctionBegin;
  *same = PETSC_TRUE;
  if (kind == ABUT_STEP_TIES) {
    PetscCall(PetscMalloc1(n, &tie));
    for (PetscInt i = 0; i < n && *same; ++i) {
      *same = AbutJournalHasTie_Private(mesh, value + 3 * i);
      if (*same) tie[i] = (AbutTie){(PetscInt)value[3 * i], value[3 * i + 1], value[3 * i + 2]};
    }
    if (*same) PetscCall(AbutMeshSetTies(mesh, n, tie));
    PetscCall(PetscFree(tie));
  } else if (kind == ABUT_STEP_MOVE) PetscCall(AbutMeshAdapt(mesh, NULL));
  else {
    PetscCall(PetscMalloc1(mesh->topology.ncells + 1, &mark)); /* not NULL on a rank without cells */
    found = AbutJournalFind_Private(&mesh->topology, n, value, mark);
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &found, 1, MPIU_INT, MPI_SUM, comm));
    *same = (PetscBool)(found == n);
    if (*same) PetscCall((kind == ABUT_STEP_MERGE ? AbutMeshSetCoarsening : AbutMeshAdapt)(mesh, mark));
    PetscCall(PetscFree(mark));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshArchive - Writes how a mesh became what it is, or makes it that again

   Collective

   Input Parameters:
+  mesh - the mesh, with a journal; where the archive is read, the first mesh of the same box, set up
-  ar   - the archive

   Level: developer

   Note:
   The same mesh to the last bit on the same number of ranks. An archive whose marks do not fit, or that ends with another number of
   cells, is a bad input.

.seealso: `AbutMeshKeepJournal()`, `AbutArchiveOpen()`
@*/
PetscErrorCode AbutMeshArchive(AbutMesh mesh, AbutArchive ar)
{
  MPI_Comm  comm  = PetscObjectComm((PetscObject)mesh);
  PetscInt  steps = mesh->nsteps, cells;
  PetscBool reads, same = PETSC_TRUE;
  char      text[512];

  PetscFunctionBegin;
  PetscValidHeaderSpecific(mesh, ABUTMESH_CLASSID, 1);
  PetscCall(AbutArchiveReads(ar, &reads));
  if (mesh->first) PetscCall(AbutFirstDescribe_Private(mesh, text, sizeof(text)));
  else
    PetscCall(PetscSNPrintf(text, sizeof(text), "%ss of order %d, %d by %d from %.17g,%.17g to %.17g,%.17g%s", AbutShapes[mesh->shape],
                            (int)mesh->order, (int)mesh->cells[0], (int)mesh->cells[1], (double)mesh->lower[0], (double)mesh->lower[1],
                            (double)mesh->upper[0], (double)mesh->upper[1], mesh->balance ? "" : ", without balance"));
  PetscCall(AbutArchiveFit(ar, "its mesh", text));
  PetscCall(AbutArchiveCount(ar, "splits", &steps));
  for (PetscInt i = 0; i < steps && same; ++i) {
    PetscInt   title[2];
    PetscReal *value = NULL;

    if (!reads) {
      title[0] = mesh->step[i].kind;
      title[1] = mesh->step[i].n;
      if (title[0] >= ABUT_STEP_SPLIT) PetscCall(AbutPointsGather_Private(comm, 2, title[1], mesh->step[i].value, &title[1], &value));
    }
    PetscCall(AbutArchiveInts(ar, "split", 2, title));
    PetscCall(AbutMeshGetCellCount(mesh, &cells));
    /* marks of cells, or ties of their corners */
    same = (PetscBool)(!reads || (title[0] >= ABUT_STEP_TIES && title[0] <= ABUT_STEP_MERGE && title[1] >= 0 && title[1] <= 4 * cells));
    if (!same) break;
    if (reads) PetscCall(PetscMalloc1(3 * title[1], &value));
    PetscCall(AbutArchiveReals(ar, "split cells", (title[0] == ABUT_STEP_TIES ? 3 : 2) * title[1],
                               value || reads ? value : mesh->step[i].value));
    if (reads) PetscCall(AbutJournalReplay_Private(mesh, title[0], title[1], value, &same));
    PetscCall(PetscFree(value));
  }
  PetscCall(AbutMeshGetCellCount(mesh, &cells));
  PetscCall(PetscSNPrintf(text, sizeof(text), "%" PetscInt_FMT " cells", same ? cells : -1));
  PetscCall(AbutArchiveFit(ar, "the last mesh", text));
  PetscFunctionReturn(PETSC_SUCCESS);
}
