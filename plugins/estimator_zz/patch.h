#pragma once

#include <petscsys.h>

/* Least squares of a stress over the cells around a vertex, by sums ("moments") that add up over cells and ranks */
#define ABUT_PATCH_TERMS_MAX 25

/* Polynomials in the distance from the vertex: x^i y^j with i, j <= order for quads, i + j <= order for triangles */
typedef struct {
  PetscInt order, terms;
  PetscInt moments;                        /* sums of x^i y^j, i, j <= 2*order, of the terms times each of s11, s22, s12, of |s|^2 */
  PetscInt coefs;                          /* those of s11, then of s22, of s12 */
  PetscInt power[ABUT_PATCH_TERMS_MAX][2]; /* i and j of each term, by degree */
} AbutPatchSpace;

PETSC_INTERN void      AbutPatchSpaceSetUp_Private(PetscInt, PetscInt, AbutPatchSpace *);
PETSC_INTERN void      AbutPatchAdd_Private(const AbutPatchSpace *, const PetscReal[2], const PetscReal[3], PetscReal[]);
PETSC_INTERN void      AbutPatchFit_Private(const AbutPatchSpace *, const PetscReal[], PetscReal[], PetscBool *);
PETSC_INTERN void      AbutPatchShift_Private(const AbutPatchSpace *, PetscInt, const PetscReal[], const PetscReal[2], PetscReal[]);
PETSC_INTERN void      AbutPatchEvaluate_Private(const AbutPatchSpace *, const PetscReal[], const PetscReal[2], PetscReal[3]);
PETSC_INTERN PetscReal AbutPatchWeight_Private(const AbutPatchSpace *, const PetscReal[], const PetscReal[]);
