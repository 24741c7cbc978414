#pragma once

#include <abutestimator.h>

/* Gauss points of a side, exact for the squares of its residuals: 0 is its start, 1 its end, seen with the cell on the left */
typedef struct {
  PetscInt  n;
  PetscReal s[ABUT_ORDER_MAX + 1], w[ABUT_ORDER_MAX + 1];
} ResidualRule;

/* The traction of the finite-element stress at the points of the piece [from, to] of side k of a local cell */
PETSC_INTERN PetscErrorCode ResidualGetTraction(AbutBody, PetscInt, PetscInt, PetscReal, PetscReal, const ResidualRule *, PetscReal[]);

/* The thickness of the body there, 1 or 2 pi r */
PETSC_INTERN PetscErrorCode ResidualGetThickness(AbutBody, PetscInt, PetscInt, PetscReal, PetscReal, const ResidualRule *, PetscReal[]);

/* The length of side k of a local cell, and the height of the cell above it */
PETSC_INTERN PetscErrorCode ResidualGetHeight(AbutMesh, PetscInt, PetscInt, PetscReal *, PetscReal *);

/* These add to square[] what the inside of every local cell, its sides inside the body, and those on the boundary give; all collective.
   The first also gives the integral of the square of the stress over the cells of this rank. */
PETSC_INTERN PetscErrorCode ResidualAddInside(AbutBody, PetscReal[], PetscReal *);
PETSC_INTERN PetscErrorCode ResidualAddJumps(AbutBody, const ResidualRule *, PetscReal[]);
PETSC_INTERN PetscErrorCode ResidualAddBoundary(AbutBody, const ResidualRule *, PetscReal[]);
