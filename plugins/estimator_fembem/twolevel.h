#pragma once

#include "system.h"
#include "clusters.h"

/* A dense system of merged elements, and how its unknowns go on to those of the fine system */
typedef struct {
  AbutBoundary   given;
  FembemBoundary b;
  FembemSystem   s;
  PetscBool      positive; /* definite: else it corrects nothing */
  PetscInt      *from[2];  /* [unknowns of the fine system] coarse unknowns, -1 for none */
  PetscReal     *weight[2];
} FembemCoarse;
PETSC_INTERN PetscErrorCode FembemCoarseCreate(const FembemSystem *, FembemCoarse *);
PETSC_INTERN PetscErrorCode FembemCoarseDestroy(FembemCoarse *);

/* Preconditioner: blocks of neighbours and the coarse system, added. Blocks and vectors are dealt out to the ranks, all of which hold the
   coarse system */
typedef struct _n_FembemTwoLevel *FembemTwoLevel;
PETSC_INTERN PetscErrorCode       FembemTwoLevelCreate(const FembemSystem *, const FembemClusters *, Mat, FembemTwoLevel *);
PETSC_INTERN void                 FembemTwoLevelGetLayout(FembemTwoLevel, const PetscInt *[], const PetscInt *[]);
PETSC_INTERN PetscErrorCode       FembemTwoLevelApply(FembemTwoLevel, const PetscReal[], PetscReal[]);
PETSC_INTERN size_t               FembemTwoLevelNumbers(FembemTwoLevel);
PETSC_INTERN PetscErrorCode       FembemTwoLevelDestroy(FembemTwoLevel *);
