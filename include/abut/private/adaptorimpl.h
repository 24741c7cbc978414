#pragma once

#include <abutadaptor.h>
#include <petsc/private/petscimpl.h>

/* Squares of the errors of all cells of the adapted bodies, in energy; the sums over all ranks */
typedef struct {
  PetscInt   n; /* on this rank */
  PetscReal *square;
  PetscReal  sum, largest, cells;
  PetscReal  norm2; /* square of the energy norm of the bodies together */
} AbutCellErrors;

struct _AbutAdaptorOps {
  PetscErrorCode (*mark)(AbutAdaptor, AbutBody, PetscInt, const PetscReal[],
                         PetscBool[]); /* required: which of n local cells want refinement; caps are not its business */
  PetscErrorCode (*share)(AbutAdaptor, const AbutCellErrors *, PetscReal,
                          PetscReal
                            *); /* of a type with a target: the square of the error above which cells are refined, while the whole is
                                           above the square of the target, given in energy too */
  PetscErrorCode (*setfromoptions)(AbutAdaptor, AbutOptionItems); /* optional */
  PetscErrorCode (*view)(AbutAdaptor, PetscViewer);               /* optional */
  PetscErrorCode (*destroy)(AbutAdaptor);                         /* optional, frees data */
  const char *about;                                              /* one line for `abut -list` */
};

#define ABUT_BODIES_MAX 64

struct _p_AbutAdaptor {
  PETSCHEADER(struct _AbutAdaptorOps);
  PetscInt  nbodies; /* named in -adaptor_bodies */
  char     *body[ABUT_BODIES_MAX];
  PetscInt  max_level, max_unknowns;
  PetscInt  jump; /* levels that a refined cell at a contact edge goes up */
  PetscBool follow, followset, settle;
  PetscReal coarsen;   /* part of the bound for refinement below which cells may be merged, 0: none are */
  PetscReal peak;      /* last coefficient of the pressure where it is largest, relative; 0: it is not looked at */
  PetscReal target;    /* relative error of all bodies together, of a type that has a share */
  PetscReal allowance; /* relative error that a cell of the body marked next may have, likewise */
  void     *data;      /* of the type */
};

PETSC_EXTERN PetscErrorCode AbutAdaptorRegister(const char[], PetscErrorCode (*)(AbutAdaptor));
PETSC_INTERN PetscErrorCode AbutAdaptorClearBodies_Private(AbutAdaptor);
PETSC_INTERN PetscErrorCode AbutAdaptorCreate_Threshold(AbutAdaptor);
PETSC_INTERN PetscErrorCode AbutAdaptorCreate_Equal(AbutAdaptor);
PETSC_INTERN PetscErrorCode AbutAdaptorCreate_Doerfler(AbutAdaptor);
PETSC_INTERN PetscErrorCode AbutAdaptorMarkAllowance_Private(AbutAdaptor, AbutBody, PetscInt, const PetscReal[], PetscBool[]);
PETSC_INTERN PetscErrorCode AbutAdaptorTargetFromOptions_Private(AbutAdaptor, AbutOptionItems);
