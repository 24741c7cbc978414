#pragma once

#include <abut/private/sysimpl.h>
#include <abut/private/meshimpl.h>

/* What a gmsh file says, on one rank; vertices are numbered from 0 in the order of the file */
typedef struct {
  PetscInt   corners, ncells, nvertices, nlines, nnames;
  PetscInt  *cell;    /* [corners*ncells] */
  PetscInt  *id;      /* [ncells] of the elements in the file */
  PetscReal *x;       /* [2*nvertices] */
  PetscInt  *line;    /* [3*nlines] two vertices and the number of the physical curve */
  PetscInt  *nametag; /* [nnames] physical curves with a name */
  char (*name)[ABUT_SIDE_NAME_MAX];
} AbutGmsh;

/* What is wrong with an input that only one rank reads: a text, empty if all is well */
typedef struct {
  char text[ABUT_LIST + 512];
} AbutFault;

PETSC_INTERN PetscErrorCode AbutGmshRead_Private(const char[], const char[], AbutGmsh *, char[], AbutFault *);
PETSC_INTERN PetscErrorCode AbutGmshFree_Private(AbutGmsh *);

typedef struct _AbutCurve *AbutCurve;

/* The first mesh of a body from a file, the same on all ranks */
struct _AbutFirst {
  char      *path, *region; /* region may be NULL: all of the file */
  char       sum[17];       /* of the bytes of the file */
  PetscInt   corners, ncells, nvertices, nsides;
  PetscInt  *cell;     /* [corners*ncells] vertices, counter-clockwise */
  PetscInt  *cellside; /* [corners*ncells] side of the body from corner k to the next one, -1 inside */
  PetscReal *x;        /* [2*nvertices] */
  char (*name)[ABUT_SIDE_NAME_MAX];
  PetscInt  *segments; /* [nsides+1] where the segments of a side begin */
  PetscReal *segment;  /* [4*segments[nsides]] from one point to the next, the body on the left */
  PetscBool  curved;   /* has any side a curve? */
  AbutCurve *curve;    /* [nsides] NULL: straight between the vertices of the first mesh */
  char     **curvetext;
};

PETSC_INTERN const char *const AbutShapeNames[];

PETSC_INTERN PetscErrorCode AbutFirstDestroy_Private(AbutFirst *);
PETSC_INTERN PetscErrorCode AbutFirstDescribe_Private(AbutMesh, char[], size_t);
PETSC_INTERN PetscErrorCode AbutFirstOrient_Private(AbutGmsh *, AbutFault *);
PETSC_INTERN PetscErrorCode AbutFirstOutline_Private(const AbutGmsh *, AbutFirst, AbutFault *);
PETSC_INTERN PetscErrorCode AbutFirstCurvesFromOptions_Private(AbutMesh);
PETSC_INTERN PetscErrorCode AbutCurveDestroy_Private(AbutCurve *);
PETSC_INTERN PetscErrorCode AbutFirstMoveToCurve_Private(AbutFirst, PetscInt, PetscReal[2]);
PETSC_INTERN PetscErrorCode AbutFirstBeyondCurve_Private(AbutFirst, const PetscReal[2], PetscBool *);

#define ABUT_CURVE_AREA 0.05 /* what must be left of a cell whose vertices move to a curve */
PETSC_INTERN PetscErrorCode AbutFirstCheckMoved_Private(AbutMesh, PetscInt);
