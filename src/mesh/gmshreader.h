#pragma once

#include "first.h"
#include <string.h>

#define ABUT_GMSH_TEXT_MAX  256
#define ABUT_GMSH_NODES_MAX 4

/* The file in memory, followed by a 0, and how far it is read */
typedef struct {
  const char *start, *at, *end;
  PetscBool   binary;
  int         version; /* 2 or 4 */
  AbutFault  *fault;
} AbutGmshReader;

/* An element as the file has it, nodes by their numbers there */
typedef struct {
  PetscInt64 node[ABUT_GMSH_NODES_MAX];
  PetscInt64 id, physical; /* 0: of no physical group */
} AbutGmshElement;

typedef struct {
  size_t           n, room;
  AbutGmshElement *element;
} AbutGmshElements;

typedef struct {
  PetscInt64 number;
  PetscReal  x[3];
} AbutGmshNode;

/* Of a curve or a surface of version 4 */
typedef struct {
  PetscInt64 dim, tag, physical;
} AbutGmshEntity;

typedef struct {
  PetscInt64 dim, tag;
  char       text[ABUT_GMSH_TEXT_MAX];
} AbutGmshName;

typedef struct {
  AbutGmshReader   r;
  size_t           nnodes, nentities, nnames;
  AbutGmshNode    *node;
  AbutGmshEntity  *entity;
  AbutGmshName    *name;
  AbutGmshElements lines, triangles, quads;
} AbutGmshFile;

PETSC_INTERN PetscBool      AbutGmshFailed_Private(const AbutGmshReader *);
PETSC_INTERN void           AbutGmshFail_Private(AbutGmshReader *, const char[]);
PETSC_INTERN void           AbutGmshBytes_Private(AbutGmshReader *, size_t, void *);
PETSC_INTERN PetscInt64     AbutGmshInt_Private(AbutGmshReader *, size_t);
PETSC_INTERN PetscReal      AbutGmshReal_Private(AbutGmshReader *);
PETSC_INTERN size_t         AbutGmshCount_Private(AbutGmshReader *, size_t, size_t);
PETSC_INTERN void           AbutGmshExpect_Private(AbutGmshReader *, const char[]);
PETSC_INTERN size_t         AbutGmshTotal_Private(AbutGmshReader *, size_t);
PETSC_INTERN PetscErrorCode AbutGmshLoad_Private(const char[], char **, size_t *, char[17], AbutFault *);
PETSC_INTERN PetscErrorCode AbutGmshSections_Private(AbutGmshFile *);
PETSC_INTERN void           AbutGmshSkipTo_Private(AbutGmshReader *, const char[]);
