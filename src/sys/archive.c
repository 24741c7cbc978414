#include <abut/private/sysimpl.h> /*I "abutsys.h" I*/
#include <errno.h>
#include <string.h>

/* The file of an archive: a header of five numbers, and the values as values.c puts them */

#define ABUT_ARCHIVE_MAGIC   0x6576696863724142 /* "BArchive" */
#define ABUT_ARCHIVE_VERSION 1

typedef struct {
  AbutWord magic, version, order, size; /* order: of bytes */
  AbutWord sum;                         /* of the bytes that follow */
} AbutArchiveHeader;

#define ABUT_ARCHIVE_ORDER 0x0102030405060708

/* FNV-1a of 64 bits, http://www.isthe.com/chongo/tech/comp/fnv */
static AbutWord AbutArchiveSum_Private(size_t n, const char byte[])
{
  unsigned long long sum = 0xcbf29ce484222325ULL;

  for (size_t i = 0; i < n; ++i) sum = (sum ^ (unsigned char)byte[i]) * 0x100000001b3ULL;
  return (AbutWord)sum;
}

/*@
   AbutArchiveCreate - Creates an empty archive, to be filled

   Collective

   Input Parameter:
.  comm - the communicator

   Output Parameter:
.  ar - the archive

   Level: developer

.seealso: `AbutArchiveReals()`, `AbutArchiveWrite()`, `AbutArchiveDestroy()`
@*/
PetscErrorCode AbutArchiveCreate(MPI_Comm comm, AbutArchive *ar)
{
  PetscFunctionBegin;
  PetscCall(PetscNew(ar));
  (*ar)->comm = comm;
  PetscCallMPI(MPI_Comm_rank(comm, &(*ar)->rank));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads on rank 0; what is wrong, in a text, or an empty one */
static PetscErrorCode AbutArchiveLoad_Private(const char path[], AbutArchive ar, char wrong[], size_t len)
{
  AbutArchiveHeader header;
  FILE             *f = fopen(path, "rb");
  size_t            n = f ? fread(&header, 1, sizeof(header), f) : 0;

  PetscFunctionBegin;
  if (!f) PetscCall(PetscSNPrintf(wrong, len, "cannot be read: %s", strerror(errno)));
  else if (n < sizeof(header.magic) || header.magic != ABUT_ARCHIVE_MAGIC) PetscCall(PetscStrncpy(wrong, "is not a checkpoint", len));
  else if (n < sizeof(header)) PetscCall(PetscStrncpy(wrong, "is cut off", len));
  else if (header.order != ABUT_ARCHIVE_ORDER) PetscCall(PetscStrncpy(wrong, "was written on a machine with another order of bytes", len));
  else if (header.version != ABUT_ARCHIVE_VERSION)
    PetscCall(PetscSNPrintf(wrong, len, "has version %lld, and this program reads version %d", header.version, ABUT_ARCHIVE_VERSION));
  else {
    size_t rest;

    (void)fseek(f, 0, SEEK_END);
    rest = (size_t)ftell(f) - sizeof(header);
    (void)fseek(f, sizeof(header), SEEK_SET);
    if (header.size < 0 || rest < (size_t)header.size) PetscCall(PetscStrncpy(wrong, "is cut off", len));
    else {
      ar->size = (size_t)header.size;
      PetscCall(PetscMalloc1(ar->size + 1, &ar->byte));
      n = fread(ar->byte, 1, ar->size, f);
      if (rest != ar->size || n != ar->size || AbutArchiveSum_Private(n, ar->byte) != header.sum)
        PetscCall(PetscStrncpy(wrong, "is damaged: its checksum does not fit", len));
    }
  }
  if (f) (void)fclose(f);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutArchiveOpen - Reads an archive that was written; one that cannot be read is a bad input

   Collective

   Input Parameters:
+  comm - the communicator
.  key  - the option that names the file, without its dash
-  path - the file

   Output Parameter:
.  ar - the archive, which gives its values in the order in which they were put in

   Level: developer

.seealso: `AbutArchiveCreate()`, `AbutArchiveReals()`, `AbutArchiveDestroy()`
@*/
PetscErrorCode AbutArchiveOpen(MPI_Comm comm, const char key[], const char path[], AbutArchive *ar)
{
  char        wrong[256] = "";
  AbutArchive a;
  PetscInt    size;

  PetscFunctionBegin;
  PetscCall(AbutArchiveCreate(comm, &a));
  PetscCall(PetscStrallocpy(path, &a->file));
  PetscCall(PetscStrallocpy(key, &a->key));
  if (!a->rank) PetscCall(AbutArchiveLoad_Private(path, a, wrong, sizeof(wrong)));
  PetscCallMPI(MPI_Bcast(wrong, sizeof(wrong), MPI_CHAR, 0, comm));
  if (wrong[0]) PetscCall(AbutArchiveDestroy(&a));
  AbutCheckInput(!wrong[0], comm, "%s: %s %s; give one that -checkpoint has written", key, path, wrong);
  size = (PetscInt)a->size;
  PetscCallMPI(MPI_Bcast(&size, 1, MPIU_INT, 0, comm));
  a->size = (size_t)size;
  if (a->rank) PetscCall(PetscMalloc1(a->size + 1, &a->byte));
  PetscCallMPI(MPI_Bcast(a->byte, (PetscMPIInt)a->size, MPI_CHAR, 0, comm));
  *ar = a;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void AbutArchiveDump_Private(FILE *f, const void *ctx)
{
  const AbutArchive       ar     = (AbutArchive)ctx;
  const AbutArchiveHeader header = {ABUT_ARCHIVE_MAGIC, ABUT_ARCHIVE_VERSION, ABUT_ARCHIVE_ORDER, (AbutWord)ar->size,
                                    AbutArchiveSum_Private(ar->size, ar->byte)};

  (void)fwrite(&header, sizeof(header), 1, f);
  (void)fwrite(ar->byte, 1, ar->size, f);
}

/*@C
   AbutArchiveWrite - Writes an archive that was filled

   Collective

   Input Parameters:
+  ar   - the archive
-  path - the file; it is replaced as a whole or not at all

   Level: developer

.seealso: `AbutArchiveCreate()`, `AbutFileWrite()`
@*/
PetscErrorCode AbutArchiveWrite(AbutArchive ar, const char path[])
{
  PetscBool fits = (PetscBool)(ar->size <= PETSC_MPI_INT_MAX); /* it is read by one broadcast */

  PetscFunctionBegin;
  PetscCallMPI(MPI_Bcast(&fits, 1, MPIU_BOOL, 0, ar->comm));
  AbutCheckInput(fits, ar->comm, "checkpoint: %s would have more than 2 GB; leave it out", path);
  PetscCall(AbutFileWrite(ar->comm, path, AbutArchiveDump_Private, ar));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutArchiveReads - Whether values come out of the archive, or go into it

   Not Collective

   Input Parameter:
.  ar - the archive

   Output Parameter:
.  reads - they come out

   Level: developer

.seealso: `AbutArchiveOpen()`, `AbutArchiveCreate()`
@*/
PetscErrorCode AbutArchiveReads(AbutArchive ar, PetscBool *reads)
{
  PetscFunctionBegin;
  *reads = (PetscBool)(ar->file != NULL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutArchiveDestroy - Frees an archive; what was not written is lost

   Collective

   Input Parameter:
.  ar - the archive; set to `NULL`

   Level: developer

.seealso: `AbutArchiveCreate()`, `AbutArchiveWrite()`
@*/
PetscErrorCode AbutArchiveDestroy(AbutArchive *ar)
{
  PetscFunctionBegin;
  if (!*ar) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree((*ar)->file));
  PetscCall(PetscFree((*ar)->key));
  PetscCall(PetscFree((*ar)->byte));
  PetscCall(PetscFree(*ar));
  PetscFunctionReturn(PETSC_SUCCESS);
}
