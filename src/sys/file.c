#include <abutsys.h> /*I "abutsys.h" I*/
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Files that are never half written: rank 0 writes PATH.part and renames it to PATH */

#define ABUT_FILE_ISFOLDER 1
#define ABUT_FILE_NOTFILE  2
#define ABUT_FILE_NOFOLDER 3
#define ABUT_FILE_NOACCESS 4

/* Renaming would put a file in the place of a device; and only making a file tells whether one can be made */
static int PathProblem(const char path[], const char folder[])
{
  struct stat s;
  char        aside[PETSC_MAX_PATH_LEN];
  int         file;

  if (!stat(path, &s) && S_ISDIR(s.st_mode)) return ABUT_FILE_ISFOLDER;
  if (!lstat(path, &s) && !S_ISREG(s.st_mode)) return ABUT_FILE_NOTFILE;
  if (stat(folder, &s) || !S_ISDIR(s.st_mode)) return ABUT_FILE_NOFOLDER;
  snprintf(aside, sizeof(aside), "%s.part", path);
  file = open(aside, O_CREAT | O_WRONLY, 0666);
  if (file < 0) return ABUT_FILE_NOACCESS;
  (void)close(file);
  (void)remove(aside);
  return 0;
}

/*@C
   AbutFileCheckPath - Whether a file can be written, asked before any work is done; if not, a bad input

   Collective

   Input Parameters:
+  comm - the communicator
.  key  - the option that names the file, without its dash
-  path - the file

   Level: developer

.seealso: `AbutFileWrite()`
@*/
PetscErrorCode AbutFileCheckPath(MPI_Comm comm, const char key[], const char path[])
{
  char        folder[PETSC_MAX_PATH_LEN] = ".";
  const char *slash                      = strrchr(path, '/');
  int         problem                    = 0;
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (slash) {
    PetscCall(PetscStrncpy(folder, path, sizeof(folder)));
    folder[slash == path ? 1 : slash - path] = 0;
  }
  if (rank == 0) problem = PathProblem(path, folder);
  PetscCallMPI(MPI_Bcast(&problem, 1, MPI_INT, 0, comm));
  AbutCheckInput(problem != ABUT_FILE_ISFOLDER, comm, "%s: '%s' is a folder; name a file in it", key, path);
  AbutCheckInput(problem != ABUT_FILE_NOTFILE, comm, "%s: '%s' is a device or a link, which a file would replace; name a file", key, path);
  AbutCheckInput(problem != ABUT_FILE_NOFOLDER, comm, "%s: there is no folder '%s' for '%s'; make it first", key, folder, path);
  AbutCheckInput(problem != ABUT_FILE_NOACCESS, comm, "%s: the folder '%s' of '%s' is not writable; name another", key, folder, path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Both return 0 or the errno of what went wrong */
static int WriteAside(const char aside[], AbutFileWriter write, const void *ctx)
{
  FILE *f = fopen(aside, "w");
  int   status;

  if (!f) return errno;
  errno = 0;
  write(f, ctx);
  status = ferror(f) ? (errno ? errno : EIO) : 0;
  if (fclose(f) && !status) status = errno;
  return status;
}

static int Copy(const char from[], const char to[])
{
  char   buffer[1 << 16];
  size_t n;
  FILE  *in = fopen(from, "rb"), *out = in ? fopen(to, "wb") : NULL;
  int    status = out ? 0 : errno;

  while (!status && (n = fread(buffer, 1, sizeof(buffer), in)) > 0) {
    if (fwrite(buffer, 1, n, out) < n) status = errno;
  }
  if (!status && ferror(in)) status = errno;
  if (out && fclose(out) && !status) status = errno;
  if (in) (void)fclose(in);
  return status;
}

/* Collective: what rank 0 met, on all ranks; a file that failed is not left behind */
static PetscErrorCode AbutFileCheckStatus_Private(MPI_Comm comm, int status, const char path[], const char aside[])
{
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0 && status) (void)remove(aside);
  PetscCallMPI(MPI_Bcast(&status, 1, MPI_INT, 0, comm));
  PetscCheck(!status, comm, PETSC_ERR_FILE_WRITE, "%s: could not be written: %s", path, strerror(status));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutFileWrite - Writes a file aside, as PATH.part, and renames it: there is the old one or the new one, never half of one

   Collective

   Input Parameters:
+  comm  - the communicator
.  path  - the file
.  write - writes to a stream; called on rank 0 only
-  ctx   - handed to write

   Level: developer

   Note:
   What goes wrong on rank 0 is `PETSC_ERR_FILE_WRITE` on all ranks, and the old file stays.

.seealso: `AbutFileCheckPath()`, `AbutFileCopyAside()`
@*/
PetscErrorCode AbutFileWrite(MPI_Comm comm, const char path[], AbutFileWriter write, const void *ctx)
{
  char        aside[PETSC_MAX_PATH_LEN];
  int         status = 0;
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscSNPrintf(aside, sizeof(aside), "%s.part", path));
  if (rank == 0) {
    status = WriteAside(aside, write, ctx);
    if (!status && rename(aside, path)) status = errno;
  }
  PetscCall(AbutFileCheckStatus_Private(comm, status, path, aside));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutFileCopyAside - Copies PATH to PATH.part, to which more is then appended

   Collective

   Input Parameters:
+  comm - the communicator
-  path - the file

   Level: developer

.seealso: `AbutFileRename()`
@*/
PetscErrorCode AbutFileCopyAside(MPI_Comm comm, const char path[])
{
  char        aside[PETSC_MAX_PATH_LEN];
  int         status = 0;
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscSNPrintf(aside, sizeof(aside), "%s.part", path));
  if (rank == 0) status = Copy(path, aside);
  PetscCall(AbutFileCheckStatus_Private(comm, status, path, aside));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutFileRename - Renames PATH.part, which all ranks have closed, to PATH

   Collective

   Input Parameters:
+  comm - the communicator
-  path - the file

   Level: developer

.seealso: `AbutFileCopyAside()`
@*/
PetscErrorCode AbutFileRename(MPI_Comm comm, const char path[])
{
  char        aside[PETSC_MAX_PATH_LEN];
  int         status = 0;
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscSNPrintf(aside, sizeof(aside), "%s.part", path));
  PetscCallMPI(MPI_Barrier(comm)); /* MPI-IO may close on rank 0 before the others have */
  if (rank == 0 && rename(aside, path)) status = errno;
  PetscCall(AbutFileCheckStatus_Private(comm, status, path, aside));
  PetscFunctionReturn(PETSC_SUCCESS);
}
