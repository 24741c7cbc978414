#pragma once

#include <abuteffect.h>
#include <petsc/private/petscimpl.h>

struct _p_AbutEffect {
  PETSCHEADER(AbutEffectOps);
  PetscInt    nbodies;
  AbutBody   *body;    /* [nbodies] not owned */
  PetscBool   applied; /* its functions hang in the hooks of the bodies */
  void       *data;    /* of the type */
  const char *about;   /* the type in one line, for `abut -list` */
};

PETSC_INTERN PetscErrorCode AbutEffectInitializePackage_Private(void);
PETSC_INTERN PetscErrorCode AbutEffectCreate_Gravity(AbutEffect);
