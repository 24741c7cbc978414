#include <abutsys.h>
#include <abut/private/sysimpl.h>

/* Where the message of a bad input goes: one line, once, from the first rank. Everything else is a defect and keeps PETSc's traceback. */
static PetscErrorCode AbutErrorHandler_Private(MPI_Comm comm, int line, const char *fun, const char *file, PetscErrorCode n, PetscErrorType p, const char *mess, void *ctx)
{
  PetscMPIInt rank = 0;

  if (n != PETSC_ERR_USER_INPUT) return PetscTraceBackErrorHandler(comm, line, fun, file, n, p, mess, ctx);
  if (p != PETSC_ERROR_INITIAL) return n;
  if (comm != PETSC_COMM_SELF) MPI_Comm_rank(comm, &rank);
  if (!rank) fprintf(stderr, "abut: %s\n", mess);
  return n;
}

/* PETSc's own reader would end a bad file with a traceback: this one keeps quiet, and the caller says what is wrong in one line */
static PetscErrorCode AbutErrorQuiet_Private(PETSC_UNUSED MPI_Comm comm, PETSC_UNUSED int line, PETSC_UNUSED const char *fun, PETSC_UNUSED const char *file, PetscErrorCode n, PETSC_UNUSED PetscErrorType p, PETSC_UNUSED const char *mess, PETSC_UNUSED void *ctx)
{
  return n;
}

static PetscErrorCode AbutInsertSceneFile_Private(const char file[])
{
  PetscBool      exists;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(PetscTestFile(file, 'r', &exists));
  AbutCheckInput(exists, PETSC_COMM_WORLD, "scene file \"%s\": no such file, or not readable; give the path of a scene, for example examples/layers/layers.yml", file);
  PetscCall(PetscPushErrorHandler(AbutErrorQuiet_Private, NULL));
  ierr = PetscOptionsInsertFile(PETSC_COMM_WORLD, NULL, file, PETSC_TRUE);
  PetscCall(PetscPopErrorHandler());
  AbutCheckInput(!ierr, PETSC_COMM_WORLD, "scene file \"%s\": cannot be read as %s; it may be cut off: compare it with examples/layers/layers.yml", file,
                 strstr(file, ".y") ? "YAML" : "PETSc options");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Scene files first, then the command line, wherever on it the file stands: the command line wins */
static PetscErrorCode AbutInsertScene_Private(int nfiles, char *files[])
{
  PetscInt n;
  char   **names, **values;

  PetscFunctionBegin;
  PetscCall(PetscOptionsLeftGet(NULL, &n, &names, &values));
  for (PetscInt i = 0; i < n; ++i) { /* keep copies: the file may replace the values */
    char *v = NULL, *k;

    PetscCall(PetscStrallocpy(names[i], &k));
    if (values[i]) PetscCall(PetscStrallocpy(values[i], &v));
    names[i]  = k;
    values[i] = v;
  }
  for (int i = 0; i < nfiles; ++i) PetscCall(AbutInsertSceneFile_Private(files[i]));
  for (PetscInt i = 0; i < n; ++i) {
    char key[PETSC_MAX_OPTION_NAME];

    PetscCall(PetscSNPrintf(key, sizeof(key), "-%s", names[i]));
    PetscCall(PetscOptionsSetValue(NULL, key, values[i]));
    PetscCall(PetscFree(names[i]));
    PetscCall(PetscFree(values[i]));
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
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
   Options on the command line win over those of the files. A bad input is reported in one line on standard error.

.seealso: `AbutFinalize()`, `AbutSceneCreate()`
@*/
PetscErrorCode AbutInitialize(int *argc, char ***args, const char help[])
{
  char **files = (char **)calloc((size_t)*argc + 1, sizeof(char *)), **rest = (char **)calloc((size_t)*argc + 1, sizeof(char *));
  int    nfiles = 0, nrest = 0;

  for (int i = 0; i < *argc; ++i) {
    const int isfile = i && i + 1 < *argc && !strcmp((*args)[i], "-options_file");

    if (isfile) files[nfiles++] = (*args)[++i];
    else if (i == 1 && (*args)[i][0] != '-') files[nfiles++] = (*args)[i];
    else rest[nrest++] = (*args)[i];
  }
  PetscCall(PetscInitialize(&nrest, &rest, NULL, help));
  PetscFunctionBegin;
  PetscCall(PetscPushErrorHandler(AbutErrorHandler_Private, NULL));
  PetscCall(AbutInsertScene_Private(nfiles, files));
  free(files); /* PETSc keeps pointing into rest, as it does into argv: it lives as long as the program */
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
  PetscCall(PetscPopErrorHandler()); /* no PetscFunctionBegin: PetscFinalize() destroys the stack this function would stand on */
  return PetscFinalize();
}
