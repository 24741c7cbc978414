#pragma once

#include <abutbody.h>
#include "kernels.h"

#define FEMBEM_SLACK 1e-9 /* relative: lengths and distances that differ by less are equal */

/*
   The boundary elements of one body, eq. (25), as complex arrays: displacements of the order of the finite elements, continuous round each
   contour, tractions of the same order in each element and free to jump between elements; both by their values at the Gauss-Lobatto points
   of the elements. Everything below works on this alone and needs neither mesh nor body.
*/
typedef struct {
  MPI_Comm            comm;  /* whose ranks hold the same boundary, for messages */
  const AbutBoundary *given; /* what the finite elements gave; not owned */
  PetscInt            order; /* of the polynomials */
  FembemBasis         basis;
  PetscInt            n, nnodes; /* elements, and nodes: order*n */
  const PetscInt     *next;      /* [n] the element after each one; not owned */
  PetscInt           *previous;  /* [n] the element before it */
  PetscComplex       *z, *u;     /* [nnodes] coordinates and displacement of the nodes */
  PetscComplex       *t;         /* [(order+1)*n] traction at the nodes of each element, from its start to its end */
  PetscReal           young;
  FembemMaterial      mat;
} FembemBoundary;

static inline PetscComplex FembemStart(const FembemBoundary *b, PetscInt e)
{
  return b->z[b->order * e];
}

static inline PetscReal FembemLength(const FembemBoundary *b, PetscInt e)
{
  return PetscAbsComplex(FembemStart(b, b->next[e]) - FembemStart(b, e));
}

PETSC_INTERN PetscErrorCode FembemBoundaryCreate(MPI_Comm, const AbutBoundary *, PetscReal, PetscReal, FembemBoundary *);
PETSC_INTERN void           FembemTakeOffRigidMotion(FembemBoundary *);
PETSC_INTERN PetscErrorCode FembemBoundaryDestroy(FembemBoundary *);

/* What balances a constant body force: off the boundary, and added to stresses s[3*n] at points x[2*n] */
PETSC_INTERN PetscErrorCode FembemTakeOffForce(AbutBody, AbutBoundary *);
PETSC_INTERN PetscErrorCode FembemAddForce(AbutBody, PetscInt, const PetscReal[], PetscReal[]);

/* Tractions that hold nodal forces in balance, where a displacement or a contact is prescribed */
PETSC_INTERN PetscErrorCode FembemRecoverTractions(FembemBoundary *);

/* Symmetric Galerkin boundary elements: replaces the displacements and tractions that are not given */
typedef struct {
  PetscInt  dense;     /* unknowns up to which the system is a dense matrix */
  PetscReal tolerance; /* relative, above: of the residual, and of what distant elements do to each other */
} FembemSolver;
typedef struct {
  PetscInt  unknowns, iterations; /* no iterations: dense */
  PetscInt  pairs;                /* of elements, evaluated on this rank */
  size_t    numbers;              /* held on this rank for the system */
  PetscBool failed;               /* the iterations did not converge: the boundary is as it was */
} FembemCost;
PETSC_INTERN PetscErrorCode FembemSolveGalerkin(FembemBoundary *, FembemSolver, FembemCost *);

/* What all pairs of elements have in common */
#define FEMBEM_RULES      5
#define FEMBEM_POINTS_MAX 24
typedef struct {
  PetscReal from; /* smallest distance of the inner element, in lengths of the outer one */
  PetscInt  n;
  PetscReal x[FEMBEM_POINTS_MAX], w[FEMBEM_POINTS_MAX]; /* points and weights on [0,1] */
} FembemRule;
typedef struct {
  FembemBasis    basis;
  FembemMaterial mat;
  FembemRule     rule[FEMBEM_RULES];
} FembemPairing;
PETSC_INTERN PetscErrorCode FembemPairingSet(const FembemBasis *, FembemMaterial, FembemPairing *);

/* The blocks of one outer (tested) and one inner element; rows and columns are 2*node + component, row after row */
#define FEMBEM_ROWS_MAX (2 * ABUT_SIDE_NODES_MAX)
typedef struct {
  PetscBool V, W, D; /* which of the three are wanted */
} FembemWanted;
typedef struct {
  PetscReal V[FEMBEM_ROWS_MAX * FEMBEM_ROWS_MAX]; /* <traction, displacement of the inner traction> */
  PetscReal W[FEMBEM_ROWS_MAX * FEMBEM_ROWS_MAX]; /* <traction, displacement of the inner displacement>, from inside: (1/2 - K) */
  PetscReal D[FEMBEM_ROWS_MAX * FEMBEM_ROWS_MAX]; /* <displacement, traction of the inner displacement>, by parts: symmetric, >= 0 */
} FembemBlocks;
PETSC_INTERN PetscErrorCode FembemPair(const FembemPairing *, const FembemElement *, const FembemElement *, PetscBool, FembemWanted,
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
