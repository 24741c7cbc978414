#ifndef _GNU_SOURCE
  #define _GNU_SOURCE /* dladdr(), realpath() */
#endif
#include <dirent.h>
#include <dlfcn.h>
#include <limits.h>
#include <abut/private/sysimpl.h> /*I "abutsys.h" I*/

#define ABUT_PLUGIN_SUFFIX "." PETSC_SLSUFFIX

/* Where plugins are looked for: `-plugin_path`, or else the folder of the library this function is in, and its subfolder `abut` */
static PetscErrorCode AbutPluginGetFolders_Private(char folder[2][PETSC_MAX_PATH_LEN], PetscInt *n)
{
  PetscBool set, dir;
  Dl_info   info;
  char     *slash;

  PetscFunctionBegin;
  *n = 1;
  PetscCall(PetscOptionsGetString(NULL, NULL, "-plugin_path", folder[0], PETSC_MAX_PATH_LEN, &set));
  if (set) {
    PetscCall(PetscTestDirectory(folder[0], 'r', &dir));
    AbutCheckInput(dir, PETSC_COMM_WORLD, "plugin_path: no folder \"%s\"; it is the folder that holds the lib*%s of the plugins", folder[0],
                   ABUT_PLUGIN_SUFFIX);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  *n = 0;
  if (!dladdr((void *)(uintptr_t)AbutPluginLoad, &info) || !info.dli_fname) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscStrncpy(folder[0], info.dli_fname, PETSC_MAX_PATH_LEN));
  slash = strrchr(folder[0], '/');
  if (slash) *slash = 0;
  else PetscCall(PetscStrncpy(folder[0], ".", PETSC_MAX_PATH_LEN));
  PetscCall(PetscSNPrintf(folder[1], PETSC_MAX_PATH_LEN, "%s/abut", folder[0]));
  *n = 2;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The files in which `AbutPluginLoad()` looks for a type: none for a name that is a path */
static PetscErrorCode AbutPluginGetFiles_Private(const char kind[], const char name[], char file[2][2 * PETSC_MAX_PATH_LEN], PetscInt *n)
{
  char folder[2][PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  *n = 0;
  if (!name[0] || strchr(name, '/')) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutPluginGetFolders_Private(folder, n));
  for (PetscInt i = 0; i < *n; ++i)
    PetscCall(PetscSNPrintf(file[i], sizeof(file[i]), "%s/lib%s_%s" ABUT_PLUGIN_SUFFIX, folder[i], kind, name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The same as a list for messages */
PetscErrorCode AbutPluginListFiles_Private(const char kind[], const char name[], char list[], size_t len)
{
  char     file[2][2 * PETSC_MAX_PATH_LEN];
  PetscInt n;

  PetscFunctionBegin;
  list[0] = 0;
  PetscCall(AbutPluginGetFiles_Private(kind, name, file, &n));
  for (PetscInt i = 0; i < n; ++i) PetscCall(AbutListAddItem_Private(list, len, file[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PETSc would open a library without a register function and say nothing: find out first what is wrong with it, "" if nothing is */
static PetscErrorCode AbutPluginDiagnose_Private(const char path[], char why[], size_t len)
{
  const char *base = strrchr(path, '/');
  char        symbol[PETSC_MAX_PATH_LEN], *dot;
  void       *handle;

  PetscFunctionBegin;
  why[0] = 0;
  base   = base ? base + 1 : path;
  if (!strncmp(base, "lib", 3)) base += 3;
  PetscCall(PetscSNPrintf(symbol, sizeof(symbol), "PetscDLLibraryRegister_%s", base));
  dot = strchr(symbol, '.');
  if (dot) *dot = 0;
  for (char *c = symbol; *c; ++c) {
    if (*c == '-') *c = '_';
  }
  handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  if (!handle) PetscCall(PetscSNPrintf(why, len, "cannot open \"%s\": %s", path, dlerror()));
  else {
    if (!dlsym(handle, symbol)) PetscCall(PetscSNPrintf(why, len, "\"%s\" is not a plugin of Abut: it has no function %s()", path, symbol));
    (void)dlclose(handle);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The file is there on every rank: open it on every rank, or fail on every rank */
static PetscErrorCode AbutPluginOpen_Private(MPI_Comm comm, const char path[])
{
  char        why[2 * PETSC_MAX_PATH_LEN];
  PetscMPIInt bad, rank, worst;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(AbutPluginDiagnose_Private(path, why, sizeof(why)));
  bad = why[0] ? rank : -1;
  PetscCallMPI(MPI_Allreduce(&bad, &worst, 1, MPI_INT, MPI_MAX, comm));
  if (worst >= 0) PetscCallMPI(MPI_Bcast(why, (PetscMPIInt)sizeof(why), MPI_CHAR, worst, comm));
  AbutCheckInput(worst < 0, comm, "plugin: %s", why);
  PetscCall(PetscDLLibraryAppend(comm, &PetscDLLibrariesLoaded, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutPluginTestFile_Private(MPI_Comm comm, const char path[], PetscBool *found)
{
  PetscBool here;

  PetscFunctionBegin;
  PetscCall(PetscTestFile(path, 'r', &here));
  PetscCallMPI(MPI_Allreduce(&here, found, 1, MPIU_BOOL, MPI_LAND, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPluginAppend - Opens the shared library of a plugin, which then registers what it brings

   Collective

   Input Parameters:
+  comm - all ranks that will use the plugin
-  path - the file, `path/to/libNAME.so`

   Level: intermediate

   Notes:
   PETSc calls the function `PetscDLLibraryRegister_NAME()` of the library; a library without it is refused. `abut -plugin path,path` comes
   here.

   A library is never closed before the end of the run, and opening it twice does nothing.

.seealso: `AbutPluginLoad()`, `AbutEstimatorRegister()`
@*/
PetscErrorCode AbutPluginAppend(MPI_Comm comm, const char path[])
{
  char      file[PETSC_MAX_PATH_LEN];
  PetscBool found;

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(file, sizeof(file), "%s%s", strchr(path, '/') ? "" : "./",
                          path)); /* without a slash the system would search its own folders */
  PetscCall(AbutPluginTestFile_Private(comm, file, &found));
  AbutCheckInput(found, comm, "plugin: no file \"%s\"", path);
  PetscCall(AbutPluginOpen_Private(comm, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define ABUT_PLUGINS_MAX 64

/*@
   AbutPluginAppendFromOptions - Opens the libraries that the user names

   Collective

   Input Parameter:
.  comm - all ranks that will use them

   Options Database Key:
.  -plugin path,path - the files

   Level: developer

.seealso: `AbutPluginAppend()`
@*/
PetscErrorCode AbutPluginAppendFromOptions(MPI_Comm comm)
{
  char    *path[ABUT_PLUGINS_MAX];
  PetscInt n = ABUT_PLUGINS_MAX;

  PetscFunctionBegin;
  PetscOptionsBegin(comm, NULL, "Plugins", NULL);
  PetscCall(PetscOptionsStringArray("-plugin", "Libraries to load", NULL, path, &n, NULL));
  PetscOptionsEnd();
  for (PetscInt i = 0; i < n; ++i) {
    PetscCall(AbutPluginAppend(comm, path[i]));
    PetscCall(PetscFree(path[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPluginLoad - Looks for the plugin that brings a type, by the name of its file, and opens it

   Collective

   Input Parameters:
+  comm - all ranks that will use the plugin
.  kind - what it is a kind of, such as "estimator"
-  name - name of the type, such as "zz": the file is `libestimator_zz.so`

   Output Parameter:
.  found - whether there is such a file; it is no error if there is none

   Options Database Key:
.  -plugin_path folder - where to look, instead of the folder of libabut.so and its subfolder `abut`

   Level: developer

.seealso: `AbutPluginAppend()`, `AbutPluginListAvailable()`, `AbutEstimatorSetType()`
@*/
PetscErrorCode AbutPluginLoad(MPI_Comm comm, const char kind[], const char name[], PetscBool *found)
{
  char     file[2][2 * PETSC_MAX_PATH_LEN];
  PetscInt n;

  PetscFunctionBegin;
  *found = PETSC_FALSE;
  PetscCall(AbutPluginGetFiles_Private(kind, name, file, &n));
  for (PetscInt i = 0; i < n && !*found; ++i) {
    PetscCall(AbutPluginTestFile_Private(comm, file[i], found));
    if (*found) PetscCall(AbutPluginOpen_Private(comm, file[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPluginListAvailable - Names the plugins of a kind that `AbutPluginLoad()` would find

   Not Collective

   Input Parameters:
+  kind - such as "estimator"
-  len  - length of `names`

   Output Parameter:
.  names - such as "fembem, zz", in alphabetical order; empty if there are none

   Level: developer

   Note:
   Only looks at names of files; opens none of them.

.seealso: `AbutPluginLoad()`
@*/
PetscErrorCode AbutPluginListAvailable(const char kind[], char names[], size_t len)
{
  char     folder[2][PETSC_MAX_PATH_LEN], prefix[64], name[256];
  PetscInt n;
  size_t   np, nn;

  PetscFunctionBegin;
  names[0] = 0;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "lib%s_", kind));
  PetscCall(PetscStrlen(prefix, &np));
  PetscCall(AbutPluginGetFolders_Private(folder, &n));
  for (PetscInt i = 0; i < n; ++i) {
    struct dirent **entry = NULL;
    const int       count = scandir(folder[i], &entry, NULL, alphasort); /* -1 if there is no such folder */

    for (int k = 0; k < count; ++k) {
      PetscBool suffix;

      PetscCall(PetscStrendswith(entry[k]->d_name, ABUT_PLUGIN_SUFFIX, &suffix));
      if (suffix && !strncmp(entry[k]->d_name, prefix, np)) {
        PetscCall(PetscStrncpy(name, entry[k]->d_name + np, sizeof(name)));
        PetscCall(PetscStrlen(name, &nn));
        name[nn - strlen(ABUT_PLUGIN_SUFFIX)] = 0;
        PetscCall(AbutListAddItem_Private(names, len, name));
      }
      free(entry[k]);
    }
    free(entry);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutPluginGetFile_Private(PetscVoidFunction function, char file[], size_t len)
{
  char    real[PATH_MAX];
  Dl_info info;

  PetscFunctionBegin;
  file[0] = 0;
  if (!dladdr((void *)(uintptr_t)function, &info) || !info.dli_fname) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscStrncpy(file, realpath(info.dli_fname, real) ? real : info.dli_fname, len));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPluginViewType - Prints one line of `abut -list`: a type, what it is, and the file that it came from

   Collective

   Input Parameters:
+  viewer - an ASCII viewer
.  name   - of the type
.  about  - one line, or `NULL`
-  create - the function that was registered for it

   Level: developer

.seealso: `AbutPluginSameFile()`, `AbutEstimatorViewTypes()`, `AbutLoopViewTypes()`, `AbutAdaptorViewTypes()`
@*/
PetscErrorCode AbutPluginViewType(PetscViewer viewer, const char name[], const char about[], PetscVoidFunction create)
{
  char file[PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  PetscCall(AbutPluginGetFile_Private(create, file, sizeof(file)));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %-12s %s%s[%s]\n", name, about ? about : "", about ? "  " : "", file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPluginSameFile - Whether two functions are of one library

   Not Collective

   Input Parameters:
+  one   - a function
-  other - a function

   Output Parameter:
.  same - whether they are

   Level: developer

.seealso: `AbutPluginViewType()`
@*/
PetscErrorCode AbutPluginSameFile(PetscVoidFunction one, PetscVoidFunction other, PetscBool *same)
{
  char file[2][PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  PetscCall(AbutPluginGetFile_Private(one, file[0], sizeof(file[0])));
  PetscCall(AbutPluginGetFile_Private(other, file[1], sizeof(file[1])));
  PetscCall(PetscStrcmp(file[0], file[1], same));
  PetscFunctionReturn(PETSC_SUCCESS);
}
