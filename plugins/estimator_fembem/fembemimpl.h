#pragma once

#include <abutbody.h>
#include "kernels.h"

#define FEMBEM_SLACK 1e-9 /* relative: lengths and distances that differ by less are equal */

/*
   The boundary elements of one body, eq. (25), as complex arrays: displacements linear and continuous round each contour, tractions linear
   in each element and free to jump between elements. Everything below works on this alone and needs neither mesh nor body.
*/
typedef struct {
  MPI_Comm            comm;     /* whose ranks hold the same boundary, for messages */
  const AbutBoundary *given;    /* what the finite elements gave; not owned */
  PetscInt            n;        /* elements, and nodes: element i starts at node i */
  const PetscInt     *next;     /* [n] the node at the end of element i; not owned */
  PetscInt           *previous; /* [n] the element that ends at node i */
  PetscComplex       *z, *u;    /* [n] coordinates and displacement of the nodes */
  PetscComplex       *t;        /* [2*n] traction at the start and the end of each element */
  PetscReal           young;
  FembemMaterial      mat;
} FembemBoundary;

PETSC_INTERN PetscErrorCode FembemBoundaryCreate(MPI_Comm, const AbutBoundary *, PetscReal, PetscReal, FembemBoundary *);
PETSC_INTERN PetscErrorCode FembemBoundaryDestroy(FembemBoundary *);

/* Tractions that hold nodal forces in balance, where a displacement or a contact is prescribed */
PETSC_INTERN PetscErrorCode FembemRecoverTractions(FembemBoundary *);

/* Symmetric Galerkin boundary elements: replaces the displacements and tractions that are not given; the number of unknowns solved for */
PETSC_INTERN PetscErrorCode FembemSolveGalerkin(FembemBoundary *, PetscInt *);

/* The blocks of one outer (tested) and one inner element; rows and columns are 2*end + component, row after row */
typedef struct {
  PetscBool V, W, D; /* which of the three are wanted */
} FembemWanted;
typedef struct {
  PetscReal V[16]; /* <traction, displacement of the inner traction> */
  PetscReal W[16]; /* <traction, displacement of the inner displacement>, from inside: (1/2 - K) */
  PetscReal D[16]; /* <displacement, traction of the inner displacement>, integrated by parts: symmetric, >= 0 */
} FembemBlocks;
PETSC_INTERN PetscErrorCode FembemPair(const FembemElement *, const FembemElement *, PetscBool, FembemMaterial, FembemWanted,
                                       FembemBlocks *);

/* Stresses inside, by Somigliana's identity from u and t: summed directly, or by a treecode of the given relative tolerance */
typedef struct _n_FembemStress *FembemStress;
typedef struct _n_FembemTree   *FembemTree;
PETSC_INTERN PetscErrorCode     FembemStressCreate(const FembemBoundary *, PetscReal, FembemStress *);
PETSC_INTERN PetscErrorCode     FembemStressEvaluate(FembemStress, PetscInt, const PetscReal[], PetscReal[]);
PETSC_INTERN PetscErrorCode     FembemStressDestroy(FembemStress *);
PETSC_INTERN PetscErrorCode     FembemTreeCreate(PetscInt, const FembemSource[], PetscReal, FembemTree *);
PETSC_INTERN void               FembemTreeAdd(FembemTree, PetscComplex, PetscComplex *, PetscComplex *);
PETSC_INTERN PetscErrorCode     FembemTreeDestroy(FembemTree *);
