#pragma once

#include "fembemimpl.h"

/*
   The symmetric Galerkin system (S. Sirtori, Meccanica 14, 1979; G. Maier and C. Polizzotto, Comput. Methods Appl. Mech. Engrg. 60, 1987):
   unknown tractions t where a component of the displacement is given, unknown displacements u elsewhere,
     [ V    W ] [t]   [f]      V = <t, V t> > 0, W = <t, (1/2 - K) u>,
     [ W^T -D ] [u] = [g]      D = <u, D u> >= 0.
   Lengths are scaled by twice the size of the body, which keeps V positive (logarithmic capacity below 1), stresses by Young's modulus.
*/

/* What is needed of element i as row (of V and W) or as row and column (of D) */
typedef struct {
  PetscInt  t[FEMBEM_ROWS_MAX], u[FEMBEM_ROWS_MAX];   /* unknowns, -1 where given */
  PetscReal tv[FEMBEM_ROWS_MAX], uv[FEMBEM_ROWS_MAX]; /* values */
  PetscBool tfree, ufree, loaded;
} FembemLocal;

/* Entries of a sparse part of the matrix, those of equal place to be added */
typedef struct {
  PetscCount n;
  PetscInt  *row, *col;
  PetscReal *value;
} FembemList;

typedef struct {
  const FembemBoundary *b;
  FembemElement        *e; /* [n] scaled */
  FembemPairing         pairing;
  PetscReal             scale;          /* of lengths */
  PetscInt              rows;           /* 2*(order+1), of an element */
  PetscReal            *t, *u;          /* [rows*n], [2*nnodes] scaled values */
  PetscInt              nt, nu;         /* unknowns */
  PetscInt             *tindex;         /* [rows*n] number of the unknown, -1 where given */
  PetscInt             *uindex;         /* [2*nnodes] */
  PetscBool            *loaded;         /* [n] the element has a given traction that is not zero */
  FembemLocal          *local;          /* [n] */
  PetscReal            *rhs, *f, *g;    /* [nt+nu], and its two parts */
  PetscReal            *V, *W, *D;      /* [nt*nt], [nt*nu], [nu*nu] by columns */
  FembemList           *list;           /* NULL: entries go to V, W and D */
  PetscInt              nmotions;       /* rigid motions that no given displacement prevents; they carry no stress */
  PetscReal            *motion, *norm2; /* [nu] each, at the unknown displacements, and the squares of their norms */
  PetscInt              pairs;          /* of elements, evaluated on this rank */
} FembemSystem;

PETSC_INTERN PetscErrorCode FembemSystemCreate(const FembemBoundary *, PetscReal, FembemSystem *);
PETSC_INTERN PetscReal      FembemSystemScale(const FembemBoundary *);
PETSC_INTERN PetscErrorCode FembemSystemAddPair(FembemSystem *, PetscInt, PetscInt);
PETSC_INTERN void           FembemSystemAddMass(FembemSystem *);
PETSC_INTERN PetscErrorCode FembemSystemFactor(FembemSystem *, PetscBool *);
PETSC_INTERN PetscErrorCode FembemSystemSolve(const FembemSystem *, PetscReal[], PetscReal[]);
PETSC_INTERN PetscErrorCode FembemSystemIterate(FembemSystem *, PetscReal, FembemCost *);
PETSC_INTERN PetscErrorCode FembemSystemDestroy(FembemSystem *);

/* Dense matrices that all ranks hold, by columns, and work on together; of one rank LAPACK's routines */
PETSC_INTERN PetscErrorCode FembemDenseSum(MPI_Comm, size_t, PetscReal[]);
PETSC_INTERN PetscErrorCode FembemDenseSumTo(MPI_Comm, size_t, PetscMPIInt, PetscReal[]);
PETSC_INTERN PetscErrorCode FembemDenseFactor(MPI_Comm, PetscInt, PetscReal[], PetscBool *);
PETSC_INTERN PetscErrorCode FembemDenseForward(MPI_Comm, PetscInt, PetscInt, const PetscReal[], PetscReal[]);
PETSC_INTERN PetscErrorCode FembemDenseSchur(MPI_Comm, PetscInt, PetscInt, const PetscReal[], PetscReal[]);
