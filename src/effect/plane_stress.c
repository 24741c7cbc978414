#include <abut/private/effectimpl.h> /*I "abuteffect.h" I*/

/*MC
   ABUTEFFECTPLANESTRESS - "plane_stress": bodies are thin sheets, with no stress across the plane, and not in plane strain

   Level: beginner

   Notes:
   It has no keys but `-NAME_effect_bodies`. In a pair of a sheet and a body in plane strain each has the thickness 1. It
   logs "AbutPlane_stress" once a body.

   Limits: sheets of one thickness that do not buckle.

.seealso: `AbutEffectSetType()`, `ABUTEFFECTAXISYMMETRIC`, `AbutBodySetKinematics()`
M*/

/* A body has one kind of kinematics */
PetscErrorCode AbutEffectSetKinematics_Private(AbutEffect effect, AbutBody body, AbutKinematics kinematics, PetscInt feature)
{
  AbutKinematics present;
  PetscLogEvent  event;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetKinematics(body, &present));
  AbutCheckInput(present == ABUT_PLANE_STRAIN, PetscObjectComm((PetscObject)effect),
                 "%s_effect_type: %s for %s, which has %s already; leave one of the two out", ((PetscObject)effect)->name,
                 ((PetscObject)effect)->type_name, ((PetscObject)body)->name, AbutKinematicsNames[present]);
  PetscCall(AbutEffectGetEvent(effect, &event));
  PetscCall(PetscLogEventBegin(event, effect, 0, 0, 0));
  PetscCall(AbutBodySetKinematics(body, kinematics));
  PetscCall(AbutBodyAddFeature(body, ((PetscObject)effect)->name, feature));
  PetscCall(PetscLogEventEnd(event, effect, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectApply_PlaneStress(AbutEffect effect, AbutBody body)
{
  PetscFunctionBegin;
  PetscCall(AbutEffectSetKinematics_Private(effect, body, ABUT_PLANE_STRESS, ABUT_FEATURE_PLANE_STRESS));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutEffectCreate_PlaneStress(AbutEffect effect)
{
  const AbutEffectOps ops = {.apply = AbutEffectApply_PlaneStress};

  PetscFunctionBegin;
  PetscCall(AbutEffectSetOps(effect, &ops));
  PetscCall(AbutEffectSetAbout(effect, "thin sheets instead of plane strain"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
