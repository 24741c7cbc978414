#pragma once

#include <abutsys.h>

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

/* Integrals over s from a to b with N_a = 1 - s/h, N_b = s/h, w = t(s) - z, dt = (b - a) ds/h */
typedef struct {
  PetscReal    P0, P1; /* of ln|w| and N_b ln|w| */
  PetscComplex Q0, Q1; /* of w/conj(w) and N_b w/conj(w) */
  PetscComplex Ea, Eb; /* of N_a dt/w and N_b dt/w */
} FembemIntegrals;

/* An element with its densities p and q of Somigliana's stress identity:
   f Int p dt/w is Muskhelishvili's phi', f Int (q/w - conj(w) p/w^2) dt is S = (s22 - s11)/2 + i s12, f = 1/(2 pi i (1 + kappa)) */
typedef struct {
  FembemElement e;
  PetscComplex  pa, dp, p1, qa, dq, q1; /* value at the start, change, change over b - a */
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

PETSC_INTERN void FembemElementSet(FembemElement *, PetscComplex, PetscComplex);
PETSC_INTERN void FembemElementIntegrate(const FembemElement *, PetscComplex, PetscBool, FembemIntegrals *);
PETSC_INTERN void FembemSourceSet(FembemSource *, PetscComplex, PetscComplex, PetscComplex, PetscComplex, PetscComplex, PetscComplex,
                                  FembemMaterial);
PETSC_INTERN void FembemSourceAdd(const FembemSource *, PetscComplex, PetscComplex *, PetscComplex *);
