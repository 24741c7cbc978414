#include <abut/private/sysimpl.h> /*I "abutsys.h" I*/
#include <unistd.h>

/* Files that keys name: a scene and its files move together */

static struct {
  PetscInt n;
  char   **scene; /* the scene files, in the order in which they were read */
} AbutScenes = {0, NULL};

static PetscErrorCode AbutFindFinalize_Private(void)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < AbutScenes.n; ++i) PetscCall(PetscFree(AbutScenes.scene[i]));
  PetscCall(PetscFree(AbutScenes.scene));
  AbutScenes.n = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutFindBeside_Private(const char scene[])
{
  PetscFunctionBegin;
  if (!AbutScenes.n) PetscCall(PetscRegisterFinalize(AbutFindFinalize_Private));
  PetscCall(PetscRealloc(sizeof(*AbutScenes.scene) * (AbutScenes.n + 1), &AbutScenes.scene));
  PetscCall(PetscStrallocpy(scene, &AbutScenes.scene[AbutScenes.n++]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutFileFind - The file that a key names, to be read

   Collective

   Input Parameters:
+  comm - the communicator
.  key  - the key, without its dash
.  path - its value
-  size - room in found

   Output Parameter:
.  found - the file: that beside the scene file, the last one that has it if there are several, or else that of the current folder, which
           need not be there

   Level: developer

   Note:
   A path from the command line, like an absolute one, is taken as it is.

.seealso: `AbutMeshSetFile()`, `AbutExpressionCreate()`
@*/
PetscErrorCode AbutFileFind(MPI_Comm comm, const char key[], const char path[], char found[], size_t size)
{
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(found, path, size));
  if (path[0] == '/' || AbutIsArgument_Private(key)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  for (PetscInt i = AbutScenes.n - 1; !rank && i >= 0; --i) {
    const char *scene = AbutScenes.scene[i], *slash = strrchr(scene, '/');

    PetscCall(PetscSNPrintf(found, size, "%.*s%s", slash ? (int)(slash - scene) + 1 : 0, scene, path));
    if (!access(found, R_OK)) break;
    PetscCall(PetscStrncpy(found, path, size));
  }
  PetscCallMPI(MPI_Bcast(found, (PetscMPIInt)size, MPI_CHAR, 0, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
