#pragma once

#include <abutbody.h>

/*S
   AbutEffect - One named addition to bodies: their weight, a pressure, springs; made only where a scene names it

   Level: beginner

   Notes:
   An effect hangs functions in the hooks of its bodies, such as `AbutBodyAddForce()`, and is not heard of again: nothing asks whether
   there is one. It owns a log event, which is registered when the first effect of its type is made.

.seealso: `AbutEffectCreate()`, `AbutEffectSetType()`, `AbutEffectRegister()`, `AbutBody`
S*/
typedef struct _p_AbutEffect *AbutEffect;
typedef const char           *AbutEffectType;
#define ABUTEFFECTGRAVITY      "gravity"      /* weight */
#define ABUTEFFECTFORCE        "force"        /* a force per volume */
#define ABUTEFFECTPRESSURE     "pressure"     /* normal to a side */
#define ABUTEFFECTSPRING       "spring"       /* a side on springs */
#define ABUTEFFECTOVERLAP      "overlap"      /* a side that stands out */
#define ABUTEFFECTTHERMAL      "thermal"      /* expansion */
#define ABUTEFFECTPLANESTRESS  "plane_stress" /* thin sheets */
#define ABUTEFFECTAXISYMMETRIC "axisymmetric" /* bodies of revolution */

/* What a type fills in and hands to AbutEffectSetOps() in its create routine */
typedef struct {
  PetscErrorCode (*setfromoptions)(AbutEffect, AbutOptionItems); /* optional: the keys of the type, NAME_effect_... */
  PetscErrorCode (*check)(AbutEffect, AbutBody);                 /* optional: bad input that shows when all keys are read */
  PetscErrorCode (*apply)(AbutEffect, AbutBody);                 /* required: hangs functions in the hooks of a body */
  PetscErrorCode (*view)(AbutEffect, PetscViewer);               /* optional: its keys, in one line */
  PetscErrorCode (*destroy)(AbutEffect);                         /* optional, frees what AbutEffectSetData() was given */
} AbutEffectOps;

PETSC_EXTERN PetscClassId   ABUTEFFECT_CLASSID;
PETSC_EXTERN PetscErrorCode AbutEffectRegister(const char[], PetscErrorCode (*)(AbutEffect));
PETSC_EXTERN PetscErrorCode AbutEffectCreate(MPI_Comm, const char[], AbutEffect *);
PETSC_EXTERN PetscErrorCode AbutEffectSetType(AbutEffect, AbutEffectType);
PETSC_EXTERN PetscErrorCode AbutEffectGetType(AbutEffect, AbutEffectType *);
PETSC_EXTERN PetscErrorCode AbutEffectSetBodies(AbutEffect, PetscInt, AbutBody[]);
PETSC_EXTERN PetscErrorCode AbutEffectGetBodies(AbutEffect, PetscInt *, AbutBody *[]);
PETSC_EXTERN PetscErrorCode AbutEffectSetFromOptions(AbutEffect, PetscInt, AbutBody[]);
PETSC_EXTERN PetscErrorCode AbutEffectSetUp(AbutEffect);
PETSC_EXTERN PetscErrorCode AbutEffectCheck(AbutEffect);
PETSC_EXTERN PetscErrorCode AbutEffectGetName(AbutEffect, const char *[]);
PETSC_EXTERN PetscErrorCode AbutEffectView(AbutEffect, PetscViewer);
PETSC_EXTERN PetscErrorCode AbutEffectViewTypes(MPI_Comm, PetscViewer);
PETSC_EXTERN PetscErrorCode AbutEffectDestroy(AbutEffect *);

/* For types */
PETSC_EXTERN PetscErrorCode AbutEffectSetOps(AbutEffect, const AbutEffectOps *);
PETSC_EXTERN PetscErrorCode AbutEffectSetAbout(AbutEffect, const char[]);
PETSC_EXTERN PetscErrorCode AbutEffectSetData(AbutEffect, void *);
PETSC_EXTERN PetscErrorCode AbutEffectGetData(AbutEffect, void *);
PETSC_EXTERN PetscErrorCode AbutEffectGetEvent(AbutEffect, PetscLogEvent *);
PETSC_EXTERN PetscErrorCode AbutEffectOptionsSide(AbutEffect, AbutOptionItems, PetscInt *);
PETSC_EXTERN PetscErrorCode AbutEffectOptionsExpression(AbutEffect, AbutOptionItems, const char[], const char[], const char[],
                                                        AbutExpression *);
PETSC_EXTERN PetscErrorCode AbutEffectCheckSide(AbutEffect, AbutBody, PetscInt, PetscBool);
