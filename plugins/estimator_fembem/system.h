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

/* A rigid motion of a contour that no given displacement prevents; it carries no stress */
typedef struct {
  PetscInt   first, end; /* the contour's unknown displacements */
  PetscReal *r, norm2;   /* [end-first] its values there, and the sum of their squares */
} FembemMotion;

typedef struct {
  const FembemBoundary *b;
  FembemElement        *e; /* [n] scaled */
  FembemPairing         pairing;
  PetscReal             scale;       /* of lengths */
  PetscInt              rows;        /* 2*(order+1), of an element */
  PetscReal            *t, *u;       /* [rows*n], [2*nnodes] scaled values */
  PetscInt              nt, nu;      /* unknowns */
  PetscInt             *tindex;      /* [rows*n] number of the unknown, -1 where given */
  PetscInt             *uindex;      /* [2*nnodes] */
  PetscBool            *loaded;      /* [n] the element has a given traction that is not zero */
  FembemLocal          *local;       /* [n] */
  PetscReal            *rhs, *f, *g; /* [nt+nu], and its two parts */
  PetscReal            *V, *W, *D;   /* [nt*nt], [nt*nu], [nu*nu] by columns */
  FembemList           *list;        /* NULL: entries go to V, W and D */
  PetscInt              nmotions;
  FembemMotion         *motion; /* [nmotions] in the order of the contours */
  PetscReal            *value;  /* [3*nu] those of the motions */
  PetscInt              pairs;  /* of elements, evaluated on this rank */
} FembemSystem;

/* By which iterations hold a motion: that of an unknown of D, over the square of the norm */
static inline PetscReal FembemMotionStiffness(const FembemSystem *s, const FembemMotion *m)
{
  const FembemMaterial *mat = &s->pairing.mat;

  return mat->mu / (PETSC_PI * (1. + mat->kappa) * m->norm2);
}

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
