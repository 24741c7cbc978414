#pragma once

#include <abut/private/meshimpl.h>
#include <p4est.h>

/* The arrays in which p4est_get_plex_data() describes a mesh as a DMPlex */
typedef struct {
  sc_array_t *points, *conesizes, *cones, *orientations, *coordinates, *children, *parents, *childids, *leaves, *remotes;
} AbutPlexData;

PETSC_INTERN PetscErrorCode AbutForestGetPlexData_Private(AbutMesh, p4est_t *, AbutPlexData *);
PETSC_INTERN PetscErrorCode AbutTreesCreate_Private(AbutMesh, p4est_connectivity_t **);
PETSC_INTERN PetscErrorCode AbutTreesGetSides_Private(AbutMesh, p4est_t *, PetscInt[]);
PETSC_INTERN PetscErrorCode AbutTreesMove_Private(AbutMesh, p4est_t *, DM);
