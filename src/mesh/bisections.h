#pragma once

#include <abut/private/meshimpl.h>
#include <petscdmplextransform.h>

PETSC_INTERN PetscErrorCode AbutBisectionsBegin_Private(AbutMesh, DM);
PETSC_INTERN PetscErrorCode AbutBisectionsFollow_Private(AbutMesh, DMPlexTransform, DM, DM);
PETSC_INTERN PetscErrorCode AbutBisectionsGetLevels_Private(AbutMesh, PetscInt[]);
PETSC_INTERN PetscErrorCode AbutMeshGetSides_Triangles(AbutMesh, PetscInt[]);
