#pragma once

#include <abutmesh.h>

/*
   Closed-form integrals of the plane-strain boundary-element kernels over one straight element.

   Points and vectors are complex numbers, x1 + i x2; a boundary has the body on its left. In the variables of Kolosov and Muskhelishvili
   (N. I. Muskhelishvili, Some Basic Problems of the Mathematical Theory of Elasticity, ch. 5) the kernels of Kelvin's solution are rational
   functions of w = t - z and conj(w), so that linear densities integrate to logarithms and powers; nothing is singular before z is a node.
   Limits: straight elements; z not nearer to a node than roundoff.
*/
typedef struct {
  PetscComplex a, b, t; /* start, end, b - a */
  PetscComplex em;      /* conjugate of the unit tangent */
  PetscReal    h;       /* length */
} FembemElement;

/* Integrals over the element of Legendre's polynomials P_n(x), x from -1 to 1, s the length, w = t(s) - z, dt = (b - a) ds/h */
typedef struct {
  PetscReal    P[ABUT_SIDE_NODES_MAX]; /* P_n ln|w| ds */
  PetscComplex Q[ABUT_SIDE_NODES_MAX]; /* P_n w/conj(w) ds */
  PetscComplex E[ABUT_SIDE_NODES_MAX]; /* P_n dt/w */
} FembemIntegrals;

typedef PetscReal FembemMatrix[ABUT_SIDE_NODES_MAX][ABUT_SIDE_NODES_MAX];

/* Polynomials on an element: their coefficients in Legendre's polynomials of x, from -1 to 1, by their values at Gauss-Lobatto points */
typedef struct {
  PetscInt     order;
  FembemMatrix coefficient; /* of polynomial n from the value at point k */
  FembemMatrix derivative;  /* the same of the derivative by x */
  FembemMatrix mass;        /* integral over x of the functions of points j and k */
} FembemBasis;

/* An element with its densities p and q of Somigliana's stress identity:
   f Int p dt/w is Muskhelishvili's phi', f Int (q/w - conj(w) p/w^2) dt is S = (s22 - s11)/2 + i s12, f = 1/(2 pi i (1 + kappa)) */
typedef struct {
  FembemElement e;
  PetscInt      order;
  PetscComplex  p[ABUT_SIDE_NODES_MAX], q[ABUT_SIDE_NODES_MAX]; /* coefficients in Legendre's polynomials */
} FembemSource;

typedef struct {
  PetscReal mu, kappa; /* shear modulus, 3 - 4 nu */
} FembemMaterial;

static inline PetscReal FembemAbsSquare(PetscComplex z)
{
  return PetscRealPartComplex(z) * PetscRealPartComplex(z) + PetscImaginaryPartComplex(z) * PetscImaginaryPartComplex(z);
}

/* Twice the signed area of two vectors: Im(conj(a) b) */
static inline PetscReal FembemCross(PetscComplex a, PetscComplex b)
{
  return PetscRealPartComplex(a) * PetscImaginaryPartComplex(b) - PetscImaginaryPartComplex(a) * PetscRealPartComplex(b);
}

static inline PetscReal FembemDot(PetscComplex a, PetscComplex b)
{
  return PetscRealPartComplex(a) * PetscRealPartComplex(b) + PetscImaginaryPartComplex(a) * PetscImaginaryPartComplex(b);
}

/* z on the scale on which the element goes from -1 to 1, from wa = a - z and wb = b - z */
static inline PetscComplex FembemReference(const FembemElement *e, PetscComplex wa, PetscComplex wb)
{
  return -(wa + wb) * e->em / e->h;
}

/* Twice the area of the triangle of z and the element, from the nearer end: the other one costs digits */
static inline PetscReal FembemAreaFrom(const FembemElement *e, PetscComplex wa, PetscComplex wb)
{
  return FembemCross(FembemAbsSquare(wa) <= FembemAbsSquare(wb) ? wa : wb, e->t);
}

PETSC_INTERN void FembemElementSet(FembemElement *, PetscComplex, PetscComplex);
PETSC_INTERN void FembemElementIntegrate(const FembemElement *, PetscInt, PetscComplex, PetscBool, FembemIntegrals *);
PETSC_INTERN void FembemSourceAdd(const FembemSource *, PetscComplex, PetscComplex *, PetscComplex *);
PETSC_INTERN void FembemSourceSet(FembemSource *, const FembemBasis *, PetscComplex, PetscComplex, const PetscComplex[],
                                  const PetscComplex[], FembemMaterial);

PETSC_INTERN PetscErrorCode FembemBasisSet(PetscInt, FembemBasis *);
PETSC_INTERN void           FembemLegendreP(PetscInt, PetscReal, PetscReal[]);
PETSC_INTERN void           FembemLegendreQ(PetscInt, const FembemElement *, PetscComplex, PetscComplex, PetscBool, PetscComplex[]);
