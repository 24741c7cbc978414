#include <abut/private/recorderimpl.h> /*I "abutrecorder.h" I*/
#include <string.h>

static PetscErrorCode AbutRecorderReadPath_Private(AbutOptionItems PetscOptionsObject, const char opt[], const char text[], char **path)
{
  char      given[PETSC_MAX_PATH_LEN - 256] = ""; /* leaves room for what is added to the name */
  PetscBool set;

  PetscFunctionBegin;
  PetscCall(AbutOptionsString(PetscOptionsObject, opt, text, given, sizeof(given), &set));
  if (!set) PetscFunctionReturn(PETSC_SUCCESS);
  AbutCheckInput(given[0], PetscOptionsObject->comm, "%s: no file is named; give the name of a file", opt + 1);
  AbutCheckInput(strlen(given) + 1 < sizeof(given), PetscOptionsObject->comm,
                 "%s: the name of the file is too long; the limit is %d characters", opt + 1, (int)sizeof(given) - 2);
  PetscCall(PetscFree(*path));
  PetscCall(PetscStrallocpy(given, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether the name of the file, without its folder, ends with the extension and has something before it */
static PetscBool HasExtension(const char path[], const char extension[])
{
  const char  *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
  const size_t n = strlen(name), m = strlen(extension);

  return n > m && !strcmp(name + n - m, extension) ? PETSC_TRUE : PETSC_FALSE;
}

static PetscErrorCode AbutRecorderSetOutput_Private(AbutRecorder rec, const char path[])
{
  const MPI_Comm comm = PetscObjectComm((PetscObject)rec);

  PetscFunctionBegin;
  if (HasExtension(path, ".xdmf")) PetscCall(AbutRecorderCreate_XDMF(rec));
  else if (HasExtension(path, ".vtu")) PetscCall(AbutRecorderCreate_VTU(rec));
  else SETERRQ(comm, PETSC_ERR_USER_INPUT, "output: '%s' is not a kind of file known here; name it FILE.xdmf or FILE.vtu", path);
  AbutCheckInput(!strpbrk(path, "<>&\":"), comm, "output: the name '%s' cannot stand in an XML file; leave out < > & \" and :", path);
  PetscCall(PetscFree(rec->output));
  PetscCall(PetscStrallocpy(path, &rec->output));
  *strrchr(rec->output, '.') = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutRecorderSetFromOptions - Reads what is to be written, and checks that it can be, before any work is done

   Collective

   Input Parameter:
.  rec - the recorder

   Options Database Keys:
+  -record FILE             - the record: one `key value` line each
.  -record_csv FILE         - one line per cycle, one column per key
.  -output FILE.xdmf        - fields of every cycle: FILE.h5 holds them, with load steps FILE_step_0001.h5 and so on; FILE.xdmf says so to
                              ParaView
.  -output FILE.vtu         - fields of every cycle: FILE_NAME_CYCLE.vtu for every body, .vtp for every pair, listed in
                              FILE.pvd
.  -output_profile FILE.csv - traces and pressures along every pair on the last mesh; with load steps also FILE_step_0001.csv and so on, on
                              the last mesh of every step
-  -output_profile_cycles   - with it: after every cycle too, FILE_0000.csv and so on

   Level: beginner

.seealso: `AbutRecorderCreate()`, `AbutRecorderWrite()`, `AbutRecorderWriteFields()`, `AbutRecorderWriteProfile()`
@*/
PetscErrorCode AbutRecorderSetFromOptions(AbutRecorder rec)
{
  const MPI_Comm    comm   = PetscObjectComm((PetscObject)rec);
  const char *const key[4] = {"record", "record_csv", "output", "output_profile"};
  const char       *path[4];

  PetscFunctionBegin;
  PetscValidHeaderSpecific(rec, ABUTRECORDER_CLASSID, 1);
  PetscObjectOptionsBegin((PetscObject)rec);
  PetscCall(AbutRecorderReadPath_Private(PetscOptionsObject, "-record", "File of the record", &rec->record_file));
  PetscCall(AbutRecorderReadPath_Private(PetscOptionsObject, "-record_csv", "File with one line per cycle", &rec->csv_file));
  PetscCall(AbutRecorderReadPath_Private(PetscOptionsObject, "-output", "Fields: FILE.xdmf (HDF5) or FILE.vtu", &rec->output_file));
  PetscCall(AbutRecorderReadPath_Private(PetscOptionsObject, "-output_profile", "Profiles of the pairs: FILE.csv", &rec->profile_file));
  if (rec->profile_file)
    PetscCall(AbutOptionsBool(PetscOptionsObject, "-output_profile_cycles", "Profiles of every cycle", &rec->profile_cycles, NULL));
  PetscOptionsEnd();
  if (rec->output_file) PetscCall(AbutRecorderSetOutput_Private(rec, rec->output_file));
  AbutCheckInput(!rec->profile_file || HasExtension(rec->profile_file, ".csv"), comm,
                 "output_profile: '%s' is not a kind of file known here; name it FILE.csv", rec->profile_file);
  path[0] = rec->record_file;
  path[1] = rec->csv_file;
  path[2] = rec->output_file;
  path[3] = rec->profile_file;
  for (PetscInt i = 0; i < 4; ++i) {
    if (!path[i]) continue;
    PetscCall(AbutFileCheckPath(comm, key[i], path[i]));
    for (PetscInt j = 0; j < i; ++j) {
      AbutCheckInput(!path[j] || strcmp(path[i], path[j]), comm, "%s: '%s' is also the file of %s; name two files", key[i], path[i],
                     key[j]);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
