#include <abut/private/sysimpl.h>

/* The full name of a key as a user writes it, without the dash: prefix and option */
static PetscErrorCode AbutOptionsKey_Private(AbutOptionItems PetscOptionsObject, const char opt[], char key[], size_t len)
{
  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(key, len, "%s%s", PetscOptionsObject->prefix ? PetscOptionsObject->prefix : "", opt + 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutOptionsString - Reads a text; like `PetscOptionsString()`

   Logically Collective

   Input Parameters:
+  PetscOptionsObject - the block begun by `PetscObjectOptionsBegin()`
.  opt  - the key with its dash, without the prefix
.  text - one line for `-help`
-  len  - room in value

   Output Parameters:
+  value - the text, unchanged if the key is not given
-  set   - whether it was given, or `NULL`

   Level: developer

.seealso: `AbutOptionsReal()`, `AbutOptionsCheckAllRead()`
@*/
PetscErrorCode AbutOptionsString(AbutOptionItems PetscOptionsObject, const char opt[], const char text[], char value[], size_t len,
                                 PetscBool *set)
{
  char      key[256];
  PetscBool given;

  PetscFunctionBegin;
  PetscCall(AbutOptionsKey_Private(PetscOptionsObject, opt, key, sizeof(key)));
  PetscCall(AbutSourceUnless_Private(key, value));
  PetscCall(PetscOptionsString(opt, text, NULL, value, value, len, &given));
  if (set) *set = given;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Splits "a, b, c" into numbers and demands exactly n of them */
static PetscErrorCode AbutOptionsNumbers_Private(AbutOptionItems PetscOptionsObject, const char opt[], const char text[], PetscInt n,
                                                 PetscReal value[], PetscBool integer, PetscBool *set)
{
  char        given[1024] = "", key[256], kind[64] = "a number", *end;
  const char *at = given;
  PetscBool   flg;

  PetscFunctionBegin;
  if (n > 1) PetscCall(PetscSNPrintf(kind, sizeof(kind), "%" PetscInt_FMT " %snumbers separated by commas", n, integer ? "whole " : ""));
  else if (integer) PetscCall(PetscStrncpy(kind, "a whole number", sizeof(kind)));
  PetscCall(AbutOptionsKey_Private(PetscOptionsObject, opt, key, sizeof(key)));
  PetscCall(PetscOptionsString(opt, text, NULL, given, given, sizeof(given), &flg));
  if (set) *set = flg;
  if (!flg) {
    for (PetscInt i = 0; i < n; ++i)
      PetscCall(PetscSNPrintf(given + strlen(given), sizeof(given) - strlen(given), "%s%.10g", i ? "," : "", (double)value[i]));
    PetscCall(AbutSourceUnless_Private(key, given));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt i = 0; i < n; ++i) {
    const double v    = strtod(at, &end);
    const int    last = i + 1 == n;

    while (*end == ' ') ++end;
    AbutCheckInput(end != at && *end == (last ? '\0' : ',') && PetscIsNormalReal(v ? v : 1.) &&
                     (!integer || (PetscAbsReal(v) <= PETSC_MAX_INT && v == (PetscInt)v)),
                   PetscOptionsObject->comm, "%s: \"%s\" is not %s (%s)", key, given, kind, text);
    value[i] = v;
    at       = end + 1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutOptionsReals - Reads exactly n numbers separated by commas

   Logically Collective

   Input Parameters:
+  PetscOptionsObject - the block begun by `PetscObjectOptionsBegin()`
.  opt  - the key with its dash, without the prefix
.  text - one line for `-help`
-  n    - how many

   Output Parameters:
+  value - [n] the numbers, unchanged if the key is not given
-  set   - whether it was given, or `NULL`

   Level: developer

.seealso: `AbutOptionsReal()`
@*/
PetscErrorCode AbutOptionsReals(AbutOptionItems PetscOptionsObject, const char opt[], const char text[], PetscInt n, PetscReal value[],
                                PetscBool *set)
{
  PetscFunctionBegin;
  PetscCall(AbutOptionsNumbers_Private(PetscOptionsObject, opt, text, n, value, PETSC_FALSE, set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutOptionsReal - Reads a number

   Logically Collective

   Input Parameters:
+  PetscOptionsObject - the block begun by `PetscObjectOptionsBegin()`
.  opt  - the key with its dash, without the prefix
-  text - one line for `-help`

   Output Parameters:
+  value - the number, unchanged if the key is not given
-  set   - whether it was given, or `NULL`

   Level: developer

   Note:
   Unlike `PetscOptionsReal()` a text that is not a finite number is reported with its key.

.seealso: `AbutOptionsInt()`, `AbutOptionsReals()`
@*/
PetscErrorCode AbutOptionsReal(AbutOptionItems PetscOptionsObject, const char opt[], const char text[], PetscReal *value, PetscBool *set)
{
  PetscFunctionBegin;
  PetscCall(AbutOptionsNumbers_Private(PetscOptionsObject, opt, text, 1, value, PETSC_FALSE, set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutOptionsInts - Reads exactly n whole numbers separated by commas

   Logically Collective

   Input Parameters:
+  PetscOptionsObject - the block begun by `PetscObjectOptionsBegin()`
.  opt  - the key with its dash, without the prefix
.  text - one line for `-help`
-  n    - how many, at most 8

   Output Parameters:
+  value - [n] the numbers, unchanged if the key is not given
-  set   - whether it was given, or `NULL`

   Level: developer

.seealso: `AbutOptionsInt()`
@*/
PetscErrorCode AbutOptionsInts(AbutOptionItems PetscOptionsObject, const char opt[], const char text[], PetscInt n, PetscInt value[],
                               PetscBool *set)
{
  PetscReal v[8];
  PetscBool given;

  PetscFunctionBegin;
  PetscCheck(n <= 8, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "At most 8 whole numbers in one key");
  for (PetscInt i = 0; i < n; ++i) v[i] = value[i];
  PetscCall(AbutOptionsNumbers_Private(PetscOptionsObject, opt, text, n, v, PETSC_TRUE, &given));
  for (PetscInt i = 0; given && i < n; ++i) value[i] = (PetscInt)v[i];
  if (set) *set = given;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutOptionsInt - Reads a whole number

   Logically Collective

   Input Parameters:
+  PetscOptionsObject - the block begun by `PetscObjectOptionsBegin()`
.  opt  - the key with its dash, without the prefix
-  text - one line for `-help`

   Output Parameters:
+  value - the number, unchanged if the key is not given
-  set   - whether it was given, or `NULL`

   Level: developer

.seealso: `AbutOptionsReal()`
@*/
PetscErrorCode AbutOptionsInt(AbutOptionItems PetscOptionsObject, const char opt[], const char text[], PetscInt *value, PetscBool *set)
{
  PetscFunctionBegin;
  PetscCall(AbutOptionsInts(PetscOptionsObject, opt, text, 1, value, set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutOptionsEnum - Reads one of a list of names

   Logically Collective

   Input Parameters:
+  PetscOptionsObject - the block begun by `PetscObjectOptionsBegin()`
.  opt   - the key with its dash, without the prefix
.  text  - one line for `-help`
-  names - the names, ended by `NULL`

   Output Parameters:
+  value - the index of the name, unchanged if the key is not given
-  set   - whether it was given, or `NULL`

   Level: developer

.seealso: `AbutOptionsString()`
@*/
PetscErrorCode AbutOptionsEnum(AbutOptionItems PetscOptionsObject, const char opt[], const char text[], const char *const names[],
                               PetscInt *value, PetscBool *set)
{
  char      given[256] = "", key[256], all[ABUT_LIST] = "";
  PetscBool flg, match;

  PetscFunctionBegin;
  PetscCall(AbutOptionsKey_Private(PetscOptionsObject, opt, key, sizeof(key)));
  PetscCall(AbutSourceUnless_Private(key, names[*value]));
  PetscCall(PetscOptionsString(opt, text, NULL, names[*value], given, sizeof(given), &flg));
  if (set) *set = flg;
  if (!flg) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; names[i]; ++i) {
    PetscCall(PetscStrcasecmp(given, names[i], &match));
    if (match) {
      *value = i;
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    if (!names[i][0]) continue; /* the key alone */
    PetscCall(AbutListAddItem_Private(all, sizeof(all), names[i]));
  }
  SETERRQ(PetscOptionsObject->comm, PETSC_ERR_USER_INPUT, "%s: there is no \"%s\"; give one of: %s", key, given, all);
}

/*@C
   AbutOptionsBool - Reads yes or no; the key alone means yes

   Logically Collective

   Input Parameters:
+  PetscOptionsObject - the block begun by `PetscObjectOptionsBegin()`
.  opt  - the key with its dash, without the prefix
-  text - one line for `-help`

   Output Parameters:
+  value - the answer, unchanged if the key is not given
-  set   - whether it was given, or `NULL`

   Level: developer

.seealso: `AbutOptionsEnum()`
@*/
PetscErrorCode AbutOptionsBool(AbutOptionItems PetscOptionsObject, const char opt[], const char text[], PetscBool *value, PetscBool *set)
{
  static const char *const words[] = {"no", "yes", "false", "true", "0", "1", "off", "on", "", NULL};
  PetscInt                 word    = *value;
  PetscBool                given;

  PetscFunctionBegin;
  PetscCall(AbutOptionsEnum(PetscOptionsObject, opt, text, words, &word, &given));
  if (given) *value = words[word][0] && !(word % 2) ? PETSC_FALSE : PETSC_TRUE;
  if (set) *set = given;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Options that PETSc reads before we start or after we end, or when a factor, a viewer or a log is made */
static PetscBool AbutOptionsIsLate_Private(const char name[])
{
  static const char *const start[]  = {"log_", "malloc",  "objects_dump", "options_",     "memory_",    "on_error",  "start_in_", "fp_trap",
                                       "help", "version", "info",         "skip_petscrc", "checkstack", "get_total", NULL};
  static const char *const inside[] = {"mat_mumps_", "_view", "pc_hypre_", "_converged_reason", NULL};

  for (PetscInt i = 0; start[i]; ++i)
    if (!strncmp(name, start[i], strlen(start[i]))) return PETSC_TRUE;
  for (PetscInt i = 0; inside[i]; ++i)
    if (strstr(name, inside[i])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Has no rank read this key of the first rank? A rank without a body does not read what its factor does. */
static PetscErrorCode AbutOptionsIsLeft_Private(MPI_Comm comm, PetscInt n, char *const names[], char name[ABUT_LIST], PetscBool *left)
{
  PetscFunctionBegin;
  PetscCallMPI(MPI_Bcast(name, ABUT_LIST, MPI_CHAR, 0, comm));
  *left = PETSC_FALSE;
  for (PetscInt k = 0; k < n && !*left; ++k) PetscCall(PetscStrcmp(names[k], name, left));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, left, 1, MPIU_BOOL, MPI_LAND, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutOptionsCheckAllRead - Ends the run if some option was read by nobody: a misspelt key would answer another question

   Collective

   Input Parameters:
+  comm  - the communicator
-  final - `PETSC_TRUE` at the end of a run, when also the options that PETSc reads late must have been read

   Level: developer

.seealso: `AbutOptionsReal()`
@*/
PetscErrorCode AbutOptionsCheckAllRead(MPI_Comm comm, PetscBool final)
{
  PetscInt n, first, nbad                   = 0;
  char   **names, **values, list[ABUT_LIST] = "", name[ABUT_LIST];

  PetscFunctionBegin;
  PetscCall(PetscOptionsLeftGet(NULL, &n, &names, &values));
  first = n;
  PetscCallMPI(MPI_Bcast(&first, 1, MPIU_INT, 0, comm));
  for (PetscInt i = 0; i < first; ++i) {
    PetscBool late, left;

    PetscCall(PetscStrncpy(name, i < n ? names[i] : "", sizeof(name)));
    PetscCall(AbutOptionsIsLeft_Private(comm, n, names, name, &left));
    late = AbutOptionsIsLate_Private(name);
    if (!left) continue;
    if (late && (!final || !strncmp(name, "objects_dump", 12) || !strncmp(name, "malloc", 6) || !strncmp(name, "options_", 8))) continue;
    PetscCall(AbutListAddItem_Private(list, sizeof(list), name));
    ++nbad;
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  AbutCheckInput(!nbad, comm,
                 "%s: nothing in this scene reads %s; check the spelling (-help lists the keys), and that the scene names the body, pair "
                 "or effect it belongs to",
                 list, nbad > 1 ? "these keys" : "this key");
  PetscFunctionReturn(PETSC_SUCCESS);
}
