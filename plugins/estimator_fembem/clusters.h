#pragma once

#include "kernels.h"

/* A binary tree over elements in their order: a cluster comes before its children, the left one before the right one */
typedef struct {
  PetscInt     first, end;  /* elements */
  PetscInt     left, right; /* children, -1 in a leaf */
  PetscComplex c;
  PetscReal    R2; /* squared radius about c that holds all elements */
} FembemCluster;

typedef struct {
  PetscInt       n;
  FembemCluster *cluster;
} FembemClusters;

PETSC_INTERN PetscErrorCode FembemClustersCreate(PetscInt, const FembemElement[], PetscInt, FembemClusters *);
PETSC_INTERN PetscErrorCode FembemClustersDestroy(FembemClusters *);
