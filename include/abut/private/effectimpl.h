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
PETSC_INTERN PetscErrorCode AbutEffectCreate_Force(AbutEffect);
PETSC_INTERN PetscErrorCode AbutEffectCreate_Pressure(AbutEffect);
PETSC_INTERN PetscErrorCode AbutEffectCreate_Spring(AbutEffect);
PETSC_INTERN PetscErrorCode AbutEffectCreate_Overlap(AbutEffect);
PETSC_INTERN PetscErrorCode AbutEffectCreate_Thermal(AbutEffect);
PETSC_INTERN PetscErrorCode AbutEffectCreate_PlaneStress(AbutEffect);
PETSC_INTERN PetscErrorCode AbutEffectCreate_Axisymmetric(AbutEffect);
PETSC_INTERN PetscErrorCode AbutEffectSetKinematics_Private(AbutEffect, AbutBody, AbutKinematics, PetscInt);

/* Where a formula over a body is looked at before any work, see options.c */
#define ABUT_EFFECT_LINE    32
#define ABUT_EFFECT_SAMPLES (ABUT_EFFECT_LINE * ABUT_EFFECT_LINE)
PETSC_INTERN PetscErrorCode AbutEffectGetSample_Private(AbutBody, PetscInt, PetscReal[2], PetscReal[2]);

/* Data of the types that are one formula along one side, see side.c */
typedef struct {
  const char    *opt, *text; /* the key of the formula, and a line on it */
  PetscBool      contact;    /* for sides in contact, or for others */
  PetscInt       side;
  AbutExpression value;
} AbutEffect_Side;
PETSC_INTERN PetscErrorCode AbutEffectCreateSide_Private(AbutEffect, const char[], const char[], PetscBool,
                                                         PetscErrorCode (*)(AbutEffect, AbutBody));
