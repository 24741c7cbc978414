#pragma once

#include <petscsys.h>

/* Least squares of a stress over the cells around a vertex, by sums ("moments") that add up over cells and ranks */
#define ABUT_PATCH_DEGREE_MAX 5
#define ABUT_PATCH_COEFS_MAX  (4 * ABUT_PATCH_DEGREE_MAX + 3)

/* Stresses of a degree that are in balance without body forces and those of some displacement */
typedef struct {
  PetscInt degree, coefs;
  PetscInt moments; /* sums of z^a conj(z)^b, a >= b, a+b <= 2*degree, of which all products of two of these stresses are made; then of the
                       products of each with the samples */
} AbutPatchSpace;

PETSC_INTERN void AbutPatchSpaceSetUp_Private(PetscInt, AbutPatchSpace *);
PETSC_INTERN void AbutPatchAdd_Private(const AbutPatchSpace *, const PetscReal[2], const PetscReal[3], PetscReal[]);
PETSC_INTERN void AbutPatchFit_Private(const AbutPatchSpace *, const PetscReal[], PetscReal[], PetscBool *);
PETSC_INTERN void AbutPatchEvaluate_Private(const AbutPatchSpace *, const PetscReal[], const PetscReal[2], PetscReal[3]);
PETSC_INTERN void AbutPatchShift_Private(const PetscReal[], const PetscReal[2], PetscReal[]);
