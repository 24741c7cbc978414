#pragma once

#include <abutadaptor.h>
#include <petsc/private/petscimpl.h>

struct _AbutAdaptorOps {
  PetscErrorCode (*mark)(AbutAdaptor, AbutBody, PetscInt, const PetscReal[],
                         PetscBool[]); /* required: which of n local cells want refinement; caps are not its business */
  PetscErrorCode (*setfromoptions)(AbutAdaptor, AbutOptionItems); /* optional */
  PetscErrorCode (*view)(AbutAdaptor, PetscViewer);               /* optional */
  PetscErrorCode (*destroy)(AbutAdaptor);                         /* optional, frees data */
};

#define ABUT_BODIES_MAX 64

struct _p_AbutAdaptor {
  PETSCHEADER(struct _AbutAdaptorOps);
  PetscInt nbodies; /* named in -adaptor_bodies */
  char    *body[ABUT_BODIES_MAX];
  PetscInt max_level, max_unknowns;
  void    *data; /* of the type */
};

PETSC_EXTERN PetscErrorCode AbutAdaptorRegister(const char[], PetscErrorCode (*)(AbutAdaptor));
PETSC_INTERN PetscErrorCode AbutAdaptorClearBodies_Private(AbutAdaptor);
PETSC_INTERN PetscErrorCode AbutAdaptorCreate_Threshold(AbutAdaptor);
PETSC_INTERN PetscErrorCode AbutAdaptorCreate_Equal(AbutAdaptor);
