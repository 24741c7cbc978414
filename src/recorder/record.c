#include <abut/private/recorderimpl.h> /*I "abutrecorder.h" I*/

PetscClassId  ABUTRECORDER_CLASSID;
PetscLogEvent ABUTRECORDER_WriteFields;

static PetscBool AbutRecorderInitialized = PETSC_FALSE;

static PetscErrorCode AbutRecorderFinalizePackage(void)
{
  PetscFunctionBegin;
  AbutRecorderInitialized = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutRecorderInitializePackage(void)
{
  PetscFunctionBegin;
  if (AbutRecorderInitialized) PetscFunctionReturn(PETSC_SUCCESS);
  AbutRecorderInitialized = PETSC_TRUE;
  PetscCall(PetscClassIdRegister("Abut Recorder", &ABUTRECORDER_CLASSID));
  PetscCall(PetscLogEventRegister("AbutWriteFields", ABUTRECORDER_CLASSID, &ABUTRECORDER_WriteFields));
  PetscCall(PetscRegisterFinalize(AbutRecorderFinalizePackage));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutRecorderCreate - Creates a recorder that writes nothing yet

   Collective

   Input Parameter:
.  comm - the communicator of the bodies and pairs it will write

   Output Parameter:
.  rec - the recorder

   Level: beginner

.seealso: `AbutRecorderSetFromOptions()`, `AbutRecorderSetReal()`, `AbutRecorderWrite()`, `AbutRecorderDestroy()`
@*/
PetscErrorCode AbutRecorderCreate(MPI_Comm comm, AbutRecorder *rec)
{
  PetscFunctionBegin;
  PetscAssertPointer(rec, 2);
  PetscCall(AbutRecorderInitializePackage());
  PetscCall(PetscHeaderCreate(*rec, ABUTRECORDER_CLASSID, "AbutRecorder", "Record, fields", "Recorder", comm, AbutRecorderDestroy, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutRecorderDestroy - Frees a recorder; what was not written is lost

   Collective

   Input Parameter:
.  rec - the recorder, `NULL` afterwards

   Level: beginner

.seealso: `AbutRecorderCreate()`, `AbutRecorderWrite()`
@*/
PetscErrorCode AbutRecorderDestroy(AbutRecorder *rec)
{
  AbutRecorder r = *rec;

  PetscFunctionBegin;
  if (!r) PetscFunctionReturn(PETSC_SUCCESS);
  PetscValidHeaderSpecific(r, ABUTRECORDER_CLASSID, 1);
  if (--((PetscObject)r)->refct > 0) {
    *rec = NULL;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt i = 0; i < r->nkeys; ++i) {
    PetscCall(PetscFree(r->key[i]));
    PetscCall(PetscFree(r->value[i]));
  }
  PetscCall(PetscFree(r->key));
  PetscCall(PetscFree(r->value));
  for (PetscInt i = 0; i < r->nrows; ++i) PetscCall(PetscStrNArrayDestroy(r->row[i].n, &r->row[i].value));
  PetscCall(PetscFree(r->row));
  for (PetscInt i = 0; i < r->nparts; ++i) PetscCall(PetscFree(r->part[i].name));
  PetscCall(PetscFree(r->part));
  PetscCall(PetscViewerDestroy(&r->viewer));
  PetscCall(PetscFree(r->record_file));
  PetscCall(PetscFree(r->csv_file));
  PetscCall(PetscFree(r->profile_file));
  PetscCall(PetscFree(r->output_file));
  PetscCall(PetscFree(r->output));
  PetscCall(PetscHeaderDestroy(rec));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A key or a value must stay on its line, and a key must be one word */
static PetscErrorCode AbutRecorderCheckKey_Private(AbutRecorder rec, const char key[], const char value[])
{
  const MPI_Comm comm = PetscObjectComm((PetscObject)rec);
  PetscBool      bad  = key[0] ? PETSC_FALSE : PETSC_TRUE;

  PetscFunctionBegin;
  for (const char *c = key; *c; ++c)
    if (*c <= ' ' || *c == ',' || *c == '"') bad = PETSC_TRUE;
  PetscCheck(!bad, comm, PETSC_ERR_ARG_WRONG, "Record: \"%s\" is not a key; a key is one word without comma and quote", key);
  for (const char *c = value; *c; ++c)
    if (*c == '\n' || *c == '\r') bad = PETSC_TRUE;
  PetscCheck(!bad, comm, PETSC_ERR_ARG_WRONG, "Record: the value of %s has more than one line", key);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets value[i] of the key, a new key at the end; a run has some hundred keys, so a linear search does */
static PetscErrorCode AbutRecorderSetValue_Private(AbutRecorder rec, const char key[], const char value[])
{
  PetscBool found = PETSC_FALSE;
  PetscInt  i;

  PetscFunctionBegin;
  PetscCall(AbutRecorderCheckKey_Private(rec, key, value));
  for (i = 0; i < rec->nkeys; ++i) {
    PetscCall(PetscStrcmp(rec->key[i], key, &found));
    if (found) break;
  }
  if (!found) {
    if (rec->nkeys == rec->maxkeys) {
      rec->maxkeys = 2 * rec->maxkeys + 64;
      PetscCall(PetscRealloc(sizeof(char *) * rec->maxkeys, &rec->key));
      PetscCall(PetscRealloc(sizeof(char *) * rec->maxkeys, &rec->value));
    }
    PetscCall(PetscStrallocpy(key, &rec->key[i]));
    rec->value[i] = NULL;
    ++rec->nkeys;
  }
  PetscCall(PetscFree(rec->value[i]));
  PetscCall(PetscStrallocpy(value, &rec->value[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutRecorderSetReal - Sets a number of the record

   Logically Collective

   Input Parameters:
+  rec   - the recorder
.  key   - its name, one word
-  value - the number, the same on all ranks

   Level: beginner

   Notes:
   A key set again replaces its value and keeps its place. Written with ten digits.

   A value that is not a finite number is refused with `PETSC_ERR_FP` and the name of the key, and the old value stays:
   no run ends quietly with a NaN.

.seealso: `AbutRecorderSetInt()`, `AbutRecorderSetString()`, `AbutRecorderEndCycle()`, `AbutRecorderWrite()`
@*/
PetscErrorCode AbutRecorderSetReal(AbutRecorder rec, const char key[], PetscReal value)
{
  char text[64];

  PetscFunctionBegin;
  PetscValidHeaderSpecific(rec, ABUTRECORDER_CLASSID, 1);
  PetscCheck(!PetscIsInfOrNanReal(value), PetscObjectComm((PetscObject)rec), PETSC_ERR_FP, "Record: %s is not a finite number but %g", key,
             (double)value);
  PetscCall(PetscSNPrintf(text, sizeof(text), "%.10g", (double)value));
  PetscCall(AbutRecorderSetValue_Private(rec, key, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutRecorderSetInt - Sets a whole number of the record

   Logically Collective

   Input Parameters:
+  rec   - the recorder
.  key   - its name, one word
-  value - the number, the same on all ranks

   Level: beginner

.seealso: `AbutRecorderSetReal()`
@*/
PetscErrorCode AbutRecorderSetInt(AbutRecorder rec, const char key[], PetscInt value)
{
  char text[32];

  PetscFunctionBegin;
  PetscValidHeaderSpecific(rec, ABUTRECORDER_CLASSID, 1);
  PetscCall(PetscSNPrintf(text, sizeof(text), "%" PetscInt_FMT, value));
  PetscCall(AbutRecorderSetValue_Private(rec, key, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutRecorderSetString - Sets a text of the record

   Logically Collective

   Input Parameters:
+  rec   - the recorder
.  key   - its name, one word
-  value - the text, one line, the same on all ranks

   Level: beginner

.seealso: `AbutRecorderSetReal()`
@*/
PetscErrorCode AbutRecorderSetString(AbutRecorder rec, const char key[], const char value[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(rec, ABUTRECORDER_CLASSID, 1);
  PetscCall(AbutRecorderSetValue_Private(rec, key, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void WriteRecord(FILE *f, const void *ctx)
{
  const AbutRecorder rec = (AbutRecorder)ctx;

  for (PetscInt i = 0; i < rec->nkeys; ++i) fprintf(f, "%s %s\n", rec->key[i], rec->value[i]);
}

/* A cell of the CSV; a text with a comma or a quote is quoted as in RFC 4180 */
static void WriteCell(FILE *f, const char value[])
{
  if (!strpbrk(value, ",\"")) {
    fputs(value, f);
    return;
  }
  fputc('"', f);
  for (const char *c = value; *c; ++c) {
    if (*c == '"') fputc('"', f);
    fputc(*c, f);
  }
  fputc('"', f);
}

static void WriteCSV(FILE *f, const void *ctx)
{
  const AbutRecorder rec = (AbutRecorder)ctx;

  for (PetscInt i = 0; i < rec->nkeys; ++i) fprintf(f, "%s%s", i ? "," : "", rec->key[i]);
  fputc('\n', f);
  for (PetscInt j = 0; j < rec->nrows; ++j) {
    for (PetscInt i = 0; i < rec->nkeys; ++i) {
      if (i) fputc(',', f);
      if (i < rec->row[j].n) WriteCell(f, rec->row[j].value[i]);
    }
    fputc('\n', f);
  }
}

/* Under an event of its own, if the file is asked for */
static PetscErrorCode AbutRecorderWriteTo_Private(AbutRecorder rec, const char path[], const char name[], AbutFileWriter write)
{
  PetscLogEvent event;

  PetscFunctionBegin;
  if (!path) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutLogEventGet(name, ABUTRECORDER_CLASSID, &event));
  PetscCall(PetscLogEventBegin(event, rec, 0, 0, 0));
  PetscCall(AbutFileWrite(PetscObjectComm((PetscObject)rec), path, write, rec));
  PetscCall(PetscLogEventEnd(event, rec, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutRecorderEndCycle - Adds the present values of all keys to the CSV as the row of this cycle, and writes the CSV

   Collective

   Input Parameter:
.  rec - the recorder

   Level: beginner

   Notes:
   The columns are all keys in the order of their first appearance; a cell is empty where a key was not yet known in that cycle.
   A key not set since an earlier cycle repeats its value.

   The file is written anew in every cycle, so that a crash loses none. Without `-record_csv` nothing is kept.

.seealso: `AbutRecorderSetReal()`, `AbutRecorderWrite()`
@*/
PetscErrorCode AbutRecorderEndCycle(AbutRecorder rec)
{
  AbutRecorderRow *row;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(rec, ABUTRECORDER_CLASSID, 1);
  if (!rec->csv_file) PetscFunctionReturn(PETSC_SUCCESS);
  if (rec->nrows == rec->maxrows) {
    rec->maxrows = 2 * rec->maxrows + 16;
    PetscCall(PetscRealloc(sizeof(AbutRecorderRow) * rec->maxrows, &rec->row));
  }
  row    = &rec->row[rec->nrows++];
  row->n = rec->nkeys;
  PetscCall(PetscStrNArrayallocpy(row->n, (const char *const *)rec->value, &row->value));
  PetscCall(AbutRecorderWriteTo_Private(rec, rec->csv_file, "AbutWriteCSV", WriteCSV));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutRecorderWrite - Writes the record (`-record FILE`) and the CSV (`-record_csv FILE`) where they are asked for

   Collective

   Input Parameter:
.  rec - the recorder

   Level: beginner

   Note:
   To be called at the end of a run, and before if a crash shall lose nothing: a file is replaced as a whole or not at all.

.seealso: `AbutRecorderSetReal()`, `AbutRecorderEndCycle()`, `AbutRecorderSetFromOptions()`
@*/
PetscErrorCode AbutRecorderWrite(AbutRecorder rec)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(rec, ABUTRECORDER_CLASSID, 1);
  PetscCall(AbutRecorderWriteTo_Private(rec, rec->record_file, "AbutWriteRecord", WriteRecord));
  PetscCall(AbutRecorderWriteTo_Private(rec, rec->csv_file, "AbutWriteCSV", WriteCSV));
  PetscFunctionReturn(PETSC_SUCCESS);
}
