#pragma once

#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/
#include <petscdt.h>

struct _n_AbutElement {
  PetscInt         nodes, npoints;
  PetscQuadrature  quadrature; /* on the reference cell, exact for affine plane cells ... */
  const PetscReal *xi, *w;     /* [2*npoints], [npoints] ... its arrays */
  PetscReal       *R[2][2];    /* [nodes*nodes] integrals of d_i N_a d_j N_b there */
  PetscReal       *G;          /* [2*nodes] work */
  PetscReal       *mean;       /* [2*nodes] work: integrals of the dilatation of each function */
};
