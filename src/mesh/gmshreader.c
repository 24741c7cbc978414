#include "gmshreader.h"
#include <ctype.h>
#include <errno.h>

/* Numbers and words out of a file of gmsh, text or binary, that may be damaged: after the first fault all numbers are 0 */

PetscBool AbutGmshFailed_Private(const AbutGmshReader *r)
{
  return (PetscBool)(r->fault->text[0] != 0);
}

/* Only the first fault counts: what comes after it is its consequence */
void AbutGmshFail_Private(AbutGmshReader *r, const char what[])
{
  size_t line = 1;

  if (AbutGmshFailed_Private(r)) return;
  for (const char *p = r->start; p < r->at; ++p) line += *p == '\n';
  if (r->binary) (void)PetscSNPrintf(r->fault->text, sizeof(r->fault->text), "byte %ld: %s", (long)(r->at - r->start), what);
  else (void)PetscSNPrintf(r->fault->text, sizeof(r->fault->text), "line %ld: %s", (long)line, what);
}

static void AbutGmshSkipSpace_Private(AbutGmshReader *r)
{
  while (r->at < r->end && isspace((unsigned char)*r->at)) ++r->at;
}

void AbutGmshBytes_Private(AbutGmshReader *r, size_t n, void *value)
{
  memset(value, 0, n);
  if (AbutGmshFailed_Private(r)) return;
  if ((size_t)(r->end - r->at) < n) {
    AbutGmshFail_Private(r, "the file is cut off");
    return;
  }
  memcpy(value, r->at, n);
  r->at += n;
}

/* A whole number; bytes: its size in a binary file */
PetscInt64 AbutGmshInt_Private(AbutGmshReader *r, size_t bytes)
{
  PetscInt64 value = 0;
  int        small = 0;
  char      *end;

  if (AbutGmshFailed_Private(r)) return 0;
  if (r->binary) {
    AbutGmshBytes_Private(r, bytes, bytes == 4 ? (void *)&small : (void *)&value);
    return bytes == 4 ? small : value;
  }
  AbutGmshSkipSpace_Private(r);
  errno = 0;
  value = strtoll(r->at, &end, 10);
  if (r->at == r->end) AbutGmshFail_Private(r, "the file is cut off");
  else if (end == r->at || errno || (*end && !isspace((unsigned char)*end))) AbutGmshFail_Private(r, "not a whole number");
  else r->at = end;
  return AbutGmshFailed_Private(r) ? 0 : value;
}

PetscReal AbutGmshReal_Private(AbutGmshReader *r)
{
  double value = 0.;
  char  *end;

  if (AbutGmshFailed_Private(r)) return 0.;
  if (r->binary) AbutGmshBytes_Private(r, sizeof(value), &value);
  else {
    AbutGmshSkipSpace_Private(r);
    value = strtod(r->at, &end);
    if (r->at == r->end) AbutGmshFail_Private(r, "the file is cut off");
    else if (end == r->at || (*end && !isspace((unsigned char)*end))) AbutGmshFail_Private(r, "not a number");
    else r->at = end;
  }
  if (PetscIsInfOrNanReal(value)) AbutGmshFail_Private(r, "not a finite number");
  return AbutGmshFailed_Private(r) ? 0. : value;
}

/* How many of something follow, each of at least so many bytes: the rest of the file must have room for them */
size_t AbutGmshCount_Private(AbutGmshReader *r, size_t bytes, size_t each)
{
  const PetscInt64 n = AbutGmshInt_Private(r, bytes);

  if (n < 0 || (size_t)n > (size_t)(r->end - r->at) / each + 1) AbutGmshFail_Private(r, "the file is cut off, or a count is wrong");
  return AbutGmshFailed_Private(r) ? 0 : (size_t)n;
}

/* A word that must come next */
void AbutGmshExpect_Private(AbutGmshReader *r, const char word[])
{
  const size_t n = strlen(word);
  char         text[ABUT_GMSH_TEXT_MAX];

  if (AbutGmshFailed_Private(r)) return;
  AbutGmshSkipSpace_Private(r);
  if ((size_t)(r->end - r->at) >= n && !strncmp(r->at, word, n)) {
    r->at += n;
    return;
  }
  (void)PetscSNPrintf(text, sizeof(text), r->at == r->end ? "the file is cut off before %s" : "expected %s", word);
  AbutGmshFail_Private(r, text);
}

/* Behind the next place of a word */
void AbutGmshSkipTo_Private(AbutGmshReader *r, const char word[])
{
  const size_t n = strlen(word);

  while ((size_t)(r->end - r->at) >= n && memcmp(r->at, word, n)) {
    r->at = (const char *)memchr(r->at + 1, word[0], (size_t)(r->end - r->at - 1));
    if (!r->at) r->at = r->end;
  }
  if ((size_t)(r->end - r->at) >= n) r->at += n;
  else AbutGmshFail_Private(r, "the file is cut off");
}

/* How many nodes or elements follow in all: in version 2 this is text in binary files, too */
size_t AbutGmshTotal_Private(AbutGmshReader *r, size_t each)
{
  const PetscBool binary = r->binary;
  size_t          n;

  if (r->version == 4) return AbutGmshCount_Private(r, 8, each);
  r->binary = PETSC_FALSE;
  n         = AbutGmshCount_Private(r, 4, each);
  r->binary = binary;
  while (binary && r->at < r->end && *r->at != '\n') ++r->at;
  if (binary && r->at < r->end) ++r->at;
  return n;
}

/* The bytes of a file, followed by a 0, and their checksum; NULL if it cannot be read */
PetscErrorCode AbutGmshLoad_Private(const char path[], char **text, size_t *n, char sum[17], AbutFault *fault)
{
  FILE    *file = fopen(path, "rb");
  size_t   room = 1 << 16, got;
  uint64_t hash = 14695981039346656037u; /* Fowler, Noll and Vo's, 64 bits */

  PetscFunctionBegin;
  *text = NULL;
  *n    = 0;
  if (!file) {
    PetscCall(PetscSNPrintf(fault->text, sizeof(fault->text), "cannot be read: %s", strerror(errno)));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscMalloc1(room + 1, text));
  while ((got = fread(*text + *n, 1, room - *n, file)) > 0) {
    *n += got;
    if (*n < room) continue;
    room *= 2;
    PetscCall(PetscRealloc(room + 1, text));
  }
  if (ferror(file)) PetscCall(PetscSNPrintf(fault->text, sizeof(fault->text), "cannot be read: %s", strerror(errno)));
  (void)fclose(file);
  (*text)[*n] = 0;
  for (size_t i = 0; i < *n; ++i) hash = (hash ^ (unsigned char)(*text)[i]) * 1099511628211u;
  PetscCall(PetscSNPrintf(sum, 17, "%08x%08x", (unsigned)(hash >> 32), (unsigned)(hash & 0xffffffffu)));
  PetscFunctionReturn(PETSC_SUCCESS);
}
