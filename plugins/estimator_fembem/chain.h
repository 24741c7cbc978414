#pragma once

#include "fembemimpl.h"

/* Entries of a row in its first unknown, the one after it and the last one of the chain, and its right-hand side */
typedef struct {
  PetscReal own, next, last, rhs;
} FembemChainRow;

PETSC_INTERN void           FembemChainAdd(PetscInt, FembemChainRow[], PetscInt, FembemChainRow);
PETSC_INTERN PetscErrorCode FembemChainSolve(PetscInt, const FembemChainRow[], PetscReal, PetscReal[]);
