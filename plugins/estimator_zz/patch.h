#pragma once

#include <petscsys.h>

/* Least squares of a stress over the cells around a vertex, by sums ("moments") that add up over cells and ranks */
#define ABUT_PATCH_MOMENTS 21 /* 1 x y xy xx yy xxy xyy xxyy, and 1 x y xy times each of s11, s22, s12 */
#define ABUT_PATCH_COEFS   12 /* 1 x y xy of s11, then of s22, of s12 */

PETSC_INTERN void AbutPatchAdd_Private(const PetscReal[2], const PetscReal[3], PetscReal[]);
PETSC_INTERN void AbutPatchFit_Private(PetscInt, const PetscReal[], PetscReal[], PetscBool *);
PETSC_INTERN void AbutPatchShift_Private(const PetscReal[], const PetscReal[2], PetscReal[]);
