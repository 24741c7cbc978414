#pragma once

#include "far.h"

/* Moments of a cluster for each power: of t1, t2, (t1 + i t2) conj(s); the same of du/ds; of u1 dt, u2 dt, which act on tractions alone */
enum {
  FEMBEM_T1,
  FEMBEM_T2,
  FEMBEM_TC,
  FEMBEM_U1,
  FEMBEM_U2,
  FEMBEM_UC,
  FEMBEM_E1,
  FEMBEM_E2,
  FEMBEM_MOMENTS
};
typedef PetscComplex FembemMoments[FEMBEM_MOMENTS];

struct _n_FembemFar {
  const FembemSystem *s; /* not owned */
  FembemClusters      clusters;
  PetscInt            terms, stride;  /* stride of the integrals of an element */
  PetscReal          *binomial;       /* [terms*terms] k over i */
  PetscComplex       *integral;       /* [stride*n] of P_n s^k ds, then of P_n conj(s) s^k ds */
  FembemMoments      *moment, *local; /* [terms] of each cluster */
  PetscBool          *mine;           /* [clusters] this rank evaluates in it, or in a part of it */
  PetscBool          *traction;       /* [clusters] some traction in it is unknown, or given and not zero */
  PetscCount          nfar, nnear;
  PetscInt           *far[2], *near[2]; /* pairs of clusters, each once */
};

/* The powers of a cluster among those of all */
static inline FembemMoments *FembemFarMoments(FembemFar f, FembemMoments *all, PetscInt cluster)
{
  return all + (size_t)f->terms * cluster;
}

static inline PetscReal FembemRadius(const FembemCluster *cl)
{
  return PetscSqrtReal(cl->R2);
}

PETSC_INTERN PetscErrorCode FembemFarSetIntegrals(FembemFar);
PETSC_INTERN void           FembemFarAddElement(FembemFar, PetscInt, const PetscReal[], const PetscReal[], FembemMoments[]);
PETSC_INTERN void           FembemFarSeeElement(FembemFar, PetscInt, const FembemMoments[], PetscReal[], PetscReal[]);
