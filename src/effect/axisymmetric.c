#include <abut/private/effectimpl.h> /*I "abuteffect.h" I*/

/*MC
   ABUTEFFECTAXISYMMETRIC - "axisymmetric": bodies of revolution, x is the radius and y the axis

   Level: beginner

   Notes:
   It has no keys, and is for all bodies of a scene. Their meshes are half sections in x >= 0; points on the axis stay there without a
   condition of their own, and forces and energies are those of a whole turn. s33 is the hoop stress. In
   the log it is "AbutAxisymmetric", once a body.

   Limits: no twist. The estimator is `residual`.

.seealso: `AbutEffectSetType()`, `ABUTEFFECTPLANESTRESS`, `AbutBodySetKinematics()`
M*/

static PetscErrorCode AbutEffectSetFromOptions_Axisymmetric(AbutEffect effect, PETSC_UNUSED AbutOptionItems PetscOptionsObject)
{
  PetscBool given;

  PetscFunctionBegin;
  PetscCall(PetscOptionsHasName(NULL, ((PetscObject)effect)->prefix, "-effect_bodies", &given));
  AbutCheckInput(!given, PetscObjectComm((PetscObject)effect),
                 "%s_effect_bodies: with axisymmetric all bodies are bodies of revolution; leave it out", ((PetscObject)effect)->name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectApply_Axisymmetric(AbutEffect effect, AbutBody body)
{
  PetscFunctionBegin;
  PetscCall(AbutEffectSetKinematics_Private(effect, body, ABUT_AXISYMMETRIC, ABUT_FEATURE_AXISYMMETRIC));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutEffectCreate_Axisymmetric(AbutEffect effect)
{
  const AbutEffectOps ops = {.setfromoptions = AbutEffectSetFromOptions_Axisymmetric, .apply = AbutEffectApply_Axisymmetric};

  PetscFunctionBegin;
  PetscCall(AbutEffectSetOps(effect, &ops));
  PetscCall(AbutEffectSetAbout(effect, "bodies of revolution, x the radius and y the axis"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
