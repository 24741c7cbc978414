#include <abut/private/sysimpl.h> /*I "abutsys.h" I*/

/* For `abut -explain`: which keys there are, and where their values are from. Kept only if asked for. */

typedef struct {
  char *key;
  char *from;  /* NULL if it is not given */
  char *value; /* that which is given, or the default */
} AbutSource;

static struct {
  PetscBool   kept;
  PetscInt    n, room;
  AbutSource *source;
} AbutSources = {PETSC_FALSE, 0, 0, NULL};

static PetscErrorCode AbutSourcesFinalize_Private(void)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < AbutSources.n; ++i) {
    PetscCall(PetscFree(AbutSources.source[i].key));
    PetscCall(PetscFree(AbutSources.source[i].from));
    PetscCall(PetscFree(AbutSources.source[i].value));
  }
  PetscCall(PetscFree(AbutSources.source));
  AbutSources.n = AbutSources.room = 0;
  AbutSources.kept                 = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutSourcesKeep_Private(void)
{
  PetscFunctionBegin;
  AbutSources.kept = PETSC_TRUE;
  PetscCall(PetscRegisterFinalize(AbutSourcesFinalize_Private));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutSourceFind_Private(const char key[], AbutSource **source)
{
  PetscBool same;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < AbutSources.n; ++i) {
    *source = &AbutSources.source[i];
    PetscCall(PetscStrcasecmp((*source)->key, key, &same));
    if (same) PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (AbutSources.n == AbutSources.room) {
    AbutSources.room = 2 * AbutSources.room + 64;
    PetscCall(PetscRealloc(sizeof(AbutSource) * AbutSources.room, &AbutSources.source));
  }
  *source  = &AbutSources.source[AbutSources.n++];
  **source = (AbutSource){NULL, NULL, NULL};
  PetscCall(PetscStrallocpy(key, &(*source)->key));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A key, without its dash, is given; the last one to say so counts */
PetscErrorCode AbutSourceGiven_Private(const char key[], const char value[], const char from[])
{
  AbutSource *source;

  PetscFunctionBegin;
  if (!AbutSources.kept) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutSourceFind_Private(key, &source));
  PetscCall(PetscFree(source->from));
  PetscCall(PetscFree(source->value));
  PetscCall(PetscStrallocpy(from, &source->from));
  PetscCall(PetscStrallocpy(value ? value : "", &source->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A key is read, and has this value if it is not given */
PetscErrorCode AbutSourceUnless_Private(const char key[], const char value[])
{
  AbutSource *source;

  PetscFunctionBegin;
  if (!AbutSources.kept) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutSourceFind_Private(key, &source));
  if (!source->value) PetscCall(PetscStrallocpy(value, &source->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The keys of a file: PETSc does not tell them from those that were there before */
PetscErrorCode AbutSourceFile_Private(const char file[])
{
  PetscOptions options;
  PetscInt     n;
  char       **names, **values;

  PetscFunctionBegin;
  if (!AbutSources.kept) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscOptionsCreate(&options));
  PetscCall(PetscOptionsInsertFile(PETSC_COMM_WORLD, options, file, PETSC_TRUE));
  PetscCall(PetscOptionsLeftGet(options, &n, &names, &values));
  for (PetscInt i = 0; i < n; ++i) PetscCall(AbutSourceGiven_Private(names[i], values[i], file));
  PetscCall(PetscOptionsLeftRestore(options, &n, &names, &values));
  PetscCall(PetscOptionsDestroy(&options));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int AbutSourceCompare_Private(const void *a, const void *b)
{
  return strcmp(((const AbutSource *)a)->key, ((const AbutSource *)b)->key);
}

/*@
   AbutOptionsView - Prints the keys that were given or read, their values, and where these are from: a file, the command line, the default

   Collective

   Input Parameter:
.  viewer - an ASCII viewer

   Options Database Key:
.  -explain - on the command line of `abut`: keeps what is printed here

   Level: beginner

   Notes:
   Keys that PETSc reads itself, such as `lower_ksp_type`, are listed if they are given, but for those that it reads when it starts, such as
   `log_view`; a default that is an empty text is not listed. A key of a file that another file names is that of the other one. What
   `-scene_tol` puts aside is listed as it was given: `AbutSceneView()` says what is in force instead.

.seealso: `AbutInitialize()`, `AbutSceneView()`
@*/
PetscErrorCode AbutOptionsView(PetscViewer viewer)
{
  PetscFunctionBegin;
  if (AbutSources.n) qsort(AbutSources.source, (size_t)AbutSources.n, sizeof(AbutSource), AbutSourceCompare_Private);
  PetscCall(PetscViewerASCIIPrintf(viewer, "keys that are given or read, and where they are from\n"));
  for (PetscInt i = 0; i < AbutSources.n; ++i) {
    const AbutSource *source = &AbutSources.source[i];

    if (!source->from && !source->value[0]) continue;
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %-32s %-28s %s\n", source->key, source->value, source->from ? source->from : "default"));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
