#include <abut/private/recorderimpl.h> /*I "abutrecorder.h" I*/

/* What a recorder knows of the cycles so far, for a run that goes on later */

static PetscErrorCode AbutRecorderArchiveStrings_Private(AbutArchive ar, const char name[], PetscInt n, char *text[])
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < n; ++i) PetscCall(AbutArchiveString(ar, name, &text[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutRecorderArchiveRows_Private(AbutRecorder rec, AbutArchive ar)
{
  PetscBool reads;

  PetscFunctionBegin;
  PetscCall(AbutArchiveReads(ar, &reads));
  PetscCall(AbutArchiveCount(ar, "rows", &rec->nrows));
  if (reads) {
    rec->maxrows = rec->nrows;
    PetscCall(PetscMalloc1(rec->nrows, &rec->row));
  }
  for (PetscInt i = 0; i < rec->nrows; ++i) {
    AbutRecorderRow *row = &rec->row[i];

    PetscCall(AbutArchiveCount(ar, "columns", &row->n));
    if (reads) PetscCall(PetscMalloc1(row->n + 1, &row->value));
    if (reads) row->value[row->n] = NULL;
    PetscCall(AbutRecorderArchiveStrings_Private(ar, "value", row->n, row->value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of files of another name nothing is there yet */
static PetscErrorCode AbutRecorderArchiveParts_Private(AbutRecorder rec, AbutArchive ar)
{
  char     *output = rec->output_file ? rec->output_file : (char *)"";
  PetscBool reads, same = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(AbutArchiveReads(ar, &reads));
  PetscCall(AbutArchiveString(ar, "output", &output));
  if (reads) {
    PetscCall(PetscStrcmp(output, rec->output_file ? rec->output_file : "", &same));
    PetscCall(PetscFree(output));
  }
  PetscCall(AbutArchiveCount(ar, "fields", &rec->nparts));
  if (reads) {
    rec->maxparts = rec->nparts;
    PetscCall(PetscCalloc1(rec->nparts, &rec->part));
  }
  for (PetscInt i = 0; i < rec->nparts; ++i) {
    AbutRecorderPart *part    = &rec->part[i];
    PetscInt          size[6] = {part->cycle, part->nvertices, part->ncells, part->corners, part->has_eta, part->step};

    PetscCall(AbutArchiveString(ar, "name of fields", &part->name));
    PetscCall(AbutArchiveInts(ar, "size of fields", 6, size));
    PetscCall(AbutArchiveReals(ar, "load factor of fields", 1, &part->factor));
    part->cycle     = size[0];
    part->nvertices = size[1];
    part->ncells    = size[2];
    part->corners   = size[3];
    part->has_eta   = (PetscBool)size[4];
    part->step      = size[5];
  }
  for (; !same && rec->nparts; --rec->nparts) PetscCall(PetscFree(rec->part[rec->nparts - 1].name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutRecorderArchive - Keys, rows of the CSV, and what the files of the fields hold, into an archive or out of one

   Collective

   Input Parameters:
+  rec - the recorder; where the archive is read, a new one with its options set
-  ar  - the archive

   Level: developer

   Note:
   The files of the fields themselves stay where they are, and are to be there when a run goes on with an `-output` of the same name; with
   another one, fields begin with the first cycle after.

.seealso: `AbutRecorderSetFromOptions()`, `AbutRecorderEndCycle()`
@*/
PetscErrorCode AbutRecorderArchive(AbutRecorder rec, AbutArchive ar)
{
  PetscBool reads;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(rec, ABUTRECORDER_CLASSID, 1);
  PetscCall(AbutArchiveReads(ar, &reads));
  PetscCall(AbutArchiveCount(ar, "keys", &rec->nkeys));
  if (reads) {
    rec->maxkeys = rec->nkeys;
    PetscCall(PetscRealloc(sizeof(char *) * rec->nkeys, &rec->key));
    PetscCall(PetscRealloc(sizeof(char *) * rec->nkeys, &rec->value));
  }
  PetscCall(AbutRecorderArchiveStrings_Private(ar, "key", rec->nkeys, rec->key));
  PetscCall(AbutRecorderArchiveStrings_Private(ar, "value", rec->nkeys, rec->value));
  PetscCall(AbutRecorderArchiveRows_Private(rec, ar));
  PetscCall(AbutRecorderArchiveParts_Private(rec, ar));
  PetscFunctionReturn(PETSC_SUCCESS);
}
