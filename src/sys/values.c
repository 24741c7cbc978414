#include <abut/private/sysimpl.h> /*I "abutsys.h" I*/
#include <string.h>

/* The values of an archive, one after another: length of the name and the name, kind, count, and the values; whole numbers are 64 bits
   long, reals are doubles. What comes out of a file may be anything: counts are believed only as far as there are bytes. */

#define ABUT_ARCHIVE_NAME 64

/* Bytes into the archive, on rank 0 */
static PetscErrorCode AbutArchivePut_Private(AbutArchive ar, size_t n, const void *from)
{
  PetscFunctionBegin;
  if (ar->rank || !n) PetscFunctionReturn(PETSC_SUCCESS);
  if (ar->size + n > ar->room) {
    ar->room = 2 * (ar->size + n);
    PetscCall(PetscRealloc(ar->room, &ar->byte));
  }
  memcpy(ar->byte + ar->size, from, n);
  ar->size += n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bytes out of it: those that should be there */
static PetscErrorCode AbutArchiveGet_Private(AbutArchive ar, const char name[], size_t n, void *to)
{
  PetscFunctionBegin;
  AbutCheckInput(n <= ar->size - ar->at, ar->comm, "%s: %s has no %s; it belongs to another scene", ar->key, ar->file, name);
  if (n) memcpy(to, ar->byte + ar->at, n); /* there may be no room for nothing */
  ar->at += n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of whatever is counted each takes a byte at least: memory is not asked for in vain */
static PetscBool AbutArchiveHas_Private(AbutArchive ar, AbutWord n)
{
  return (PetscBool)(n >= 0 && (size_t)n <= ar->size - ar->at);
}

/* The name, kind and count of what follows; n < 0: any count */
static PetscErrorCode AbutArchiveTitle_Private(AbutArchive ar, const char name[], AbutWord kind, PetscInt *n)
{
  char     there[ABUT_ARCHIVE_NAME] = "", mine[ABUT_ARCHIVE_NAME] = "";
  AbutWord title[2] = {kind, *n};

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(mine, name, sizeof(mine)));
  if (!ar->file) {
    PetscCall(AbutArchivePut_Private(ar, sizeof(mine), mine));
    PetscCall(AbutArchivePut_Private(ar, sizeof(title), title));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(AbutArchiveGet_Private(ar, name, sizeof(there), there));
  PetscCall(AbutArchiveGet_Private(ar, name, sizeof(title), title));
  AbutCheckInput(!strncmp(there, mine, sizeof(there)) && title[0] == kind &&
                   (*n < 0 ? AbutArchiveHas_Private(ar, title[1]) : title[1] == *n),
                 ar->comm, "%s: %s has no %s; it belongs to another scene", ar->key, ar->file, name);
  *n = (PetscInt)title[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutArchiveInts - Whole numbers into or out of an archive

   Collective

   Input Parameters:
+  ar   - the archive
.  name - what they are, in a message to the user; at most 63 letters
-  n    - how many

   Input/Output Parameter:
.  value - [n] the numbers; where the archive is filled those of rank 0 count, where it is read all ranks get them

   Level: developer

.seealso: `AbutArchiveReals()`, `AbutArchiveString()`
@*/
PetscErrorCode AbutArchiveInts(AbutArchive ar, const char name[], PetscInt n, PetscInt value[])
{
  PetscFunctionBegin;
  PetscCall(AbutArchiveTitle_Private(ar, name, 'i', &n));
  for (PetscInt i = 0; i < n; ++i) {
    AbutWord word;

    if (ar->file) {
      PetscCall(AbutArchiveGet_Private(ar, name, sizeof(word), &word));
      value[i] = (PetscInt)word;
    } else {
      word = value[i];
      PetscCall(AbutArchivePut_Private(ar, sizeof(word), &word));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutArchiveCount - How many of something follow, into or out of an archive

   Collective

   Input Parameters:
+  ar   - the archive
-  name - what they are, in a message to the user; at most 63 letters

   Input/Output Parameter:
.  n - how many; more than the rest of the archive could hold, or less than none, is a bad input

   Level: developer

.seealso: `AbutArchiveInts()`
@*/
PetscErrorCode AbutArchiveCount(AbutArchive ar, const char name[], PetscInt *n)
{
  PetscFunctionBegin;
  PetscCall(AbutArchiveInts(ar, name, 1, n));
  AbutCheckInput(!ar->file || AbutArchiveHas_Private(ar, *n), ar->comm, "%s: %s has no %" PetscInt_FMT " %s; it is damaged", ar->key,
                 ar->file, *n, name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutArchiveReals - Numbers into or out of an archive, to the last bit

   Collective

   Input Parameters:
+  ar   - the archive
.  name - what they are, in a message to the user; at most 63 letters
-  n    - how many

   Input/Output Parameter:
.  value - [n] the numbers; where the archive is filled those of rank 0 count and other ranks may give `NULL`, where it is read all ranks
           get them

   Level: developer

.seealso: `AbutArchiveInts()`
@*/
PetscErrorCode AbutArchiveReals(AbutArchive ar, const char name[], PetscInt n, PetscReal value[])
{
  PetscFunctionBegin;
  PetscCall(AbutArchiveTitle_Private(ar, name, 'r', &n));
  if (!ar->file) PetscCall(AbutArchivePut_Private(ar, sizeof(PetscReal) * n, value));
  else PetscCall(AbutArchiveGet_Private(ar, name, sizeof(PetscReal) * n, value));
  for (PetscInt i = 0; i < n && ar->file; ++i)
    AbutCheckInput(!PetscIsInfOrNanReal(value[i]), ar->comm, "%s: in %s the %s are not all finite; it is damaged", ar->key, ar->file, name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutArchiveString - A text into or out of an archive

   Collective

   Input Parameters:
+  ar   - the archive
-  name - what it is, in a message to the user; at most 63 letters

   Input/Output Parameter:
.  text - the text; where the archive is read, a new one, to be freed with `PetscFree()`

   Level: developer

.seealso: `AbutArchiveInts()`, `AbutArchiveFit()`
@*/
PetscErrorCode AbutArchiveString(AbutArchive ar, const char name[], char **text)
{
  PetscInt n = ar->file ? -1 : (PetscInt)strlen(*text);

  PetscFunctionBegin;
  PetscCall(AbutArchiveTitle_Private(ar, name, 's', &n));
  if (!ar->file) {
    PetscCall(AbutArchivePut_Private(ar, n, *text));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscCalloc1(n + 1, text));
  PetscCall(AbutArchiveGet_Private(ar, name, n, *text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutArchiveFit - A text that must be the same where the archive is filled and where it is read: what a scene has to have in common

   Collective

   Input Parameters:
+  ar   - the archive
.  name - what it is, in a message to the user; at most 63 letters
-  text - the text here

   Level: developer

   Note:
   Another text in the archive is a bad input that shows both.

.seealso: `AbutArchiveString()`
@*/
PetscErrorCode AbutArchiveFit(AbutArchive ar, const char name[], const char text[])
{
  char *there = (char *)text;

  PetscFunctionBegin;
  PetscCall(AbutArchiveString(ar, name, &there));
  if (!ar->file) PetscFunctionReturn(PETSC_SUCCESS);
  AbutCheckInput(!strcmp(there, text), ar->comm, "%s: %s is of another scene: %s is \"%s\" there and \"%s\" here", ar->key, ar->file, name,
                 there, text);
  PetscCall(PetscFree(there));
  PetscFunctionReturn(PETSC_SUCCESS);
}
