#include <abutsys.h>
#include <abut/private/sysimpl.h>
#include <ctype.h>

/* A text of the user's in a message may have line breaks, and anything else */
static void AbutOneLine_Private(const char mess[], size_t len, char said[])
{
  snprintf(said, len, "%s", mess);
  for (char *c = said; *c; ++c)
    if (iscntrl((unsigned char)*c)) *c = ' ';
}

/* Where the message of a bad input goes, and that of a file that could not be written: one line, once, from the first rank. Everything
   else is a defect and keeps PETSc's traceback. */
static PetscErrorCode AbutErrorHandler_Private(MPI_Comm comm, int line, const char *fun, const char *file, PetscErrorCode n,
                                               PetscErrorType p, const char *mess, void *ctx)
{
  char        said[ABUT_MESSAGE];
  PetscMPIInt rank = 0;

  if (n != PETSC_ERR_USER_INPUT && n != PETSC_ERR_FILE_WRITE) return PetscTraceBackErrorHandler(comm, line, fun, file, n, p, mess, ctx);
  if (p != PETSC_ERROR_INITIAL) return n;
  if (comm != PETSC_COMM_SELF) MPI_Comm_rank(comm, &rank);
  AbutOneLine_Private(mess, sizeof(said), said);
  if (!rank) fprintf(stderr, "abut: %s\n", said);
  return n;
}

/* Instead of a traceback, the first message of PETSc, without line breaks, in a text of ABUT_MESSAGE characters */
PetscErrorCode AbutErrorKeep_Private(PETSC_UNUSED MPI_Comm comm, PETSC_UNUSED int line, PETSC_UNUSED const char *fun,
                                     PETSC_UNUSED const char *file, PetscErrorCode n, PetscErrorType p, const char *mess, void *ctx)
{
  if (p == PETSC_ERROR_INITIAL) AbutOneLine_Private(mess, ABUT_MESSAGE, (char *)ctx);
  return n;
}

static PetscErrorCode AbutInsertSceneFile_Private(const char file[])
{
  PetscBool      exists;
  PetscErrorCode ierr;
  char           said[ABUT_MESSAGE]; /* of no use: it names a line of PETSc's */

  PetscFunctionBegin;
  PetscCall(PetscTestFile(file, 'r', &exists));
  AbutCheckInput(exists, PETSC_COMM_WORLD,
                 "scene file \"%s\": no such file, or not readable; give the path of a scene, for example examples/layers/layers.yml",
                 file);
  PetscCall(PetscPushErrorHandler(AbutErrorKeep_Private, said));
  ierr = PetscOptionsInsertFile(PETSC_COMM_WORLD, NULL, file, PETSC_TRUE);
  PetscCall(PetscPopErrorHandler());
  AbutCheckInput(!ierr, PETSC_COMM_WORLD,
                 "scene file \"%s\": cannot be read as %s; it may be cut off: compare it with examples/layers/layers.yml", file,
                 strstr(file, ".y") ? "YAML" : "PETSc options");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static char **AbutArguments; /* without the scene files; PETSc keeps pointing into them until it ends */

/* Is a key on the command line? */
PetscBool AbutIsArgument_Private(const char key[])
{
  for (char **word = AbutArguments; word && *word; ++word)
    if (**word == '-' && !strcasecmp(*word + 1, key)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Scene files first, then the command line, wherever on it the file stands: the command line wins */
static PetscErrorCode AbutInsertScene_Private(int nfiles, const char *const files[])
{
  PetscInt  n;
  char    **names, **values;
  PetscBool explain, late;

  PetscFunctionBegin;
  PetscCall(PetscOptionsHasName(NULL, NULL, "-explain", &explain));
  if (explain) PetscCall(AbutSourcesKeep_Private());
  PetscCall(PetscOptionsLeftGet(NULL, &n, &names, &values));
  for (PetscInt i = 0; i < n; ++i) { /* keep copies: the file may replace the values */
    char *v = NULL, *k;

    PetscCall(PetscStrallocpy(names[i], &k));
    if (values[i]) PetscCall(PetscStrallocpy(values[i], &v));
    names[i]  = k;
    values[i] = v;
  }
  for (int i = 0; i < nfiles; ++i) {
    PetscCall(AbutInsertSceneFile_Private(files[i]));
    PetscCall(AbutSourceFile_Private(files[i]));
    PetscCall(AbutFindBeside_Private(files[i]));
  }
  for (PetscInt i = 0; i < n; ++i) {
    char key[PETSC_MAX_OPTION_NAME];

    PetscCall(PetscSNPrintf(key, sizeof(key), "-%s", names[i]));
    PetscCall(PetscOptionsSetValue(NULL, key, values[i]));
    PetscCall(AbutSourceGiven_Private(names[i], values[i],
                                      AbutIsArgument_Private(names[i]) ? "command line" : "PETSC_OPTIONS or .petscrc"));
    PetscCall(PetscFree(names[i]));
    PetscCall(PetscFree(values[i]));
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-explain", &late));
  AbutCheckInput(explain || !late, PETSC_COMM_WORLD, "explain: belongs on the command line, not in a scene file");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A negative number is no key, as in PETSc */
static int AbutIsKey_Private(const char word[])
{
  return word[0] == '-' && (isalpha((unsigned char)word[1]) || word[1] == '_' || word[1] == '-');
}

/* A word that is neither a key nor follows one: PETSc would skip it */
static const char *AbutStrayWord_Private(int n, char *const words[])
{
  for (int i = 1; i < n; ++i)
    if (!AbutIsKey_Private(words[i]) && (i == 1 || !AbutIsKey_Private(words[i - 1]))) return words[i];
  return NULL;
}

/*@C
   AbutInitialize - Starts MPI, PETSc and Abut, and reads the scene files named on the command line

   Collective on `MPI_COMM_WORLD`

   Input Parameters:
+  argc - count of the command-line arguments
.  args - the arguments; a first one that does not begin with `-`, and every `-options_file FILE`, is a scene file
-  help - text printed by `-help`, or `NULL`

   Level: beginner

   Notes:
   Options on the command line win over those of the files. A bad input is reported in one line on standard error, and so is a word that
   belongs to no option: PETSc would skip it.

.seealso: `AbutFinalize()`, `AbutSceneCreate()`
@*/
PetscErrorCode AbutInitialize(int *argc, char ***args, const char help[])
{
  const char **files = (const char **)calloc((size_t)*argc + 1, sizeof(char *));
  char       **rest  = (char **)calloc((size_t)*argc + 1, sizeof(char *));
  const char  *stray;
  int          nfiles = 0, nrest = 0;

  for (int i = 0; i < *argc; ++i) {
    if (i && !strcmp((*args)[i], "-options_file")) files[nfiles++] = i + 1 < *argc ? (*args)[++i] : "";
    else if (i == 1 && (*args)[i][0] != '-') files[nfiles++] = (*args)[i];
    else rest[nrest++] = (*args)[i];
  }
  stray         = AbutStrayWord_Private(nrest, rest);
  AbutArguments = rest;
  PetscCall(PetscInitialize(&nrest, &rest, NULL, help));
  PetscFunctionBegin;
  PetscCall(PetscPushErrorHandler(AbutErrorHandler_Private, NULL));
  AbutCheckInput(!stray, PETSC_COMM_WORLD,
                 "\"%s\" belongs to no key; only the first word may be a scene file, further ones follow -options_file, and keys begin "
                 "with a dash",
                 stray);
  PetscCall(AbutInsertScene_Private(nfiles, files));
  free(files);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutFinalize - Ends Abut, PETSc and MPI

   Collective on `MPI_COMM_WORLD`

   Level: beginner

.seealso: `AbutInitialize()`
@*/
PetscErrorCode AbutFinalize(void)
{
  PetscBool      given; /* no PetscFunctionBegin: PetscFinalize() destroys the stack this function would stand on */
  PetscErrorCode ierr;

  PetscCall(PetscPopErrorHandler());
  PetscCall(PetscOptionsHasName(NULL, NULL, "-options_left", &given));
  if (!given) PetscCall(PetscOptionsSetValue(NULL, "-options_left", "no")); /* AbutOptionsCheckAllRead() has said it, in one line */
  ierr = PetscFinalize();
  free(AbutArguments);
  AbutArguments = NULL;
  return ierr;
}
