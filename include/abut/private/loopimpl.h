#pragma once

#include <abutloop.h>
#include <petsc/private/snesimpl.h>

/* A trace kept while a mesh adapts: values at the nodes of one side */
typedef struct {
  PetscInt   n;
  PetscReal *x, *value;
} AbutOldTrace;

struct _p_AbutInterface {
  PETSCHEADER(int);
  PetscInt  nbodies, npairs;
  AbutBody *body;
  AbutPair *pair;

  /* of the present meshes; index t = 2*pair+side */
  PetscBool   setupcalled;
  PetscInt   *offset; /* [2*npairs+1] where each side's values begin among all */
  PetscInt    nowned; /* values owned by this rank, each by the owner of its node */
  PetscInt   *owned;  /* [nowned] their places among all */
  PetscInt   *place;  /* [all] the place of the k-th value in the order of the ranks */
  VecScatter  toall;
  Vec         everywhere;
  PetscReal   gamma; /* the user's relaxation, 0 for the automatic one */
  PetscReal  *x, *g; /* [all] the trace of the last sweep and its image, on every rank */
  PetscReal  *xbest; /* [all] the trace of least residual since the set-up */
  PetscReal **p;     /* [npairs] the pressures of the last sweep */
  Vec        *force; /* [nbodies] nodal contact forces */

  Vec              G;  /* image of the trace of the last sweep */
  PetscObjectId    id; /* of that trace vector, and its state then: a second look at the same point is no sweep */
  PetscObjectState state;
  PetscInt         sweeps, startsweeps;
  PetscReal        residual, pressureresidual; /* |G-x|/|G| and the same of the pressures, of the last sweep */
  PetscBool        linearfailed;
  PetscReal        residualbest;
  PetscReal        best[2]; /* least residual of the present window of iterations, and of the one before */
  PetscReal        rate;    /* what the solver's slowest mode loses in an iteration, 0 unknown */
  const char      *failure; /* why the stop test gave up, in one word */
  AbutOldTrace    *old;     /* [2*npairs] */
};

PETSC_INTERN PetscErrorCode SNESCreate_DDNeumann(SNES);
PETSC_INTERN PetscErrorCode AbutInterfaceSweepFull_Private(AbutInterface);
PETSC_INTERN PetscErrorCode AbutInterfaceReplicate_Private(AbutInterface, Vec, PetscReal[]);
PETSC_INTERN PetscErrorCode AbutInterfaceLocalize_Private(AbutInterface, const PetscReal[], Vec);
PETSC_INTERN PetscErrorCode AbutInterfaceBodyChange_Private(AbutInterface, Vec, Vec, PetscReal[], PetscReal[]);
PETSC_EXTERN PetscLogEvent  ABUTINTERFACE_Sweep;
