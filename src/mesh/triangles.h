#pragma once

#include <abut/private/meshimpl.h>
#include <petscdmplextransform.h>

/* The first mesh, from which coarser ones are made, and the vertices that were taken out once, in order; see merge.c */
typedef struct {
  DM         first;
  PetscInt   ngone;
  PetscReal *gone; /* [2*ngone] */
} AbutMesh_Triangles;

PETSC_INTERN PetscErrorCode AbutTrianglesSplit_Private(AbutMesh, DM, DMLabel, DM *);
PETSC_INTERN PetscErrorCode AbutTrianglesMerge_Private(AbutMesh, const PetscBool[], DM *);
PETSC_INTERN PetscErrorCode AbutBisectionsBegin_Private(AbutMesh, DM);
PETSC_INTERN PetscErrorCode AbutBisectionsFollow_Private(AbutMesh, DMPlexTransform, DM, DM);
PETSC_INTERN PetscErrorCode AbutBisectionsGetLevels_Private(AbutMesh, PetscInt[]);
PETSC_INTERN PetscErrorCode AbutMeshGetSides_Triangles(AbutMesh, PetscInt[]);
