#pragma once

#include <abut/private/bodyimpl.h>

#define ABUT_MOVE_X 0
#define ABUT_MOVE_Y 1
#define ABUT_TURN   2

typedef struct {
  PetscInt  n, kind[ABUT_MAX_MODES];
  PetscReal center[2]; /* about which the body may turn */
} AbutFreeMotions;

PETSC_INTERN PetscErrorCode AbutBodyFindFreeMotions_Private(AbutBody, AbutFreeMotions *);
PETSC_INTERN void           AbutMotionAt_Private(PetscInt, const PetscReal[2], const PetscReal[2], PetscReal[2]);
