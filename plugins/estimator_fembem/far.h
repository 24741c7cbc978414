#pragma once

#include "system.h"
#include "clusters.h"

/* The Galerkin operator between clusters of elements that are far from each other; near ones are left to pairs of elements */
typedef struct _n_FembemFar *FembemFar;

PETSC_INTERN PetscErrorCode FembemFarCreate(const FembemSystem *, PetscReal, FembemFar *);
PETSC_INTERN void           FembemFarGetClusters(FembemFar, const FembemClusters **, PetscCount *, const PetscInt *[2]);
PETSC_INTERN size_t         FembemFarNumbers(FembemFar);
PETSC_INTERN PetscErrorCode FembemFarAdd(FembemFar, const PetscReal[], const PetscReal[], PetscReal[], PetscReal[]);
PETSC_INTERN PetscErrorCode FembemFarDestroy(FembemFar *);
