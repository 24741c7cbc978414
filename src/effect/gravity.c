#include <abut/private/effectimpl.h> /*I "abuteffect.h" I*/

/*MC
   ABUTEFFECTGRAVITY - "gravity": the weight of bodies, or the force of any other constant acceleration

   Options Database Keys:
+  -NAME_effect_density <rho>            - mass per volume, > 0
-  -NAME_effect_acceleration <0,-9.81>   - [2] acceleration, length over time squared

   Level: beginner

   Notes:
   The body force rho a, which must come out in the scene's stress unit over its length unit: with m and Pa in kg/m^3 and m/s^2, with mm and
   MPa in t/mm^3 and mm/s^2 (steel: 7.85e-9, and 0,-9810). Per unit thickness it adds up to rho a times the area of the body.

   Bodies of different densities take an effect each. In the log it is "AbutGravity".

   Limits: the same everywhere in a body; for a density that varies take `ABUTEFFECTFORCE`.

.seealso: `AbutEffectSetType()`, `ABUTEFFECTFORCE`, `AbutBodyAddForce()`
M*/

typedef struct {
  PetscReal density, acceleration[2];
} AbutEffect_Gravity;

static PetscErrorCode AbutGravityForce_Private(PETSC_UNUSED const PetscReal x[2], PetscReal force[2], void *ctx)
{
  const AbutEffect_Gravity *g = (AbutEffect_Gravity *)ctx;

  PetscFunctionBegin;
  for (PetscInt d = 0; d < 2; ++d) force[d] = g->density * g->acceleration[d];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectSetFromOptions_Gravity(AbutEffect effect, AbutOptionItems PetscOptionsObject)
{
  AbutEffect_Gravity *g;
  PetscBool           given;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &g));
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-effect_density", "Mass per volume", &g->density, &given));
  PetscCall(AbutOptionsReals(PetscOptionsObject, "-effect_acceleration", "a1,a2", 2, g->acceleration, NULL));
  AbutCheckInput(given, PetscObjectComm((PetscObject)effect), "%s_effect_density: missing; give the mass per volume, for example 7850",
                 ((PetscObject)effect)->name);
  AbutCheckInput(g->density > 0., PetscObjectComm((PetscObject)effect),
                 "%s_effect_density: %g is no mass per volume; give a positive number, for example 7850", ((PetscObject)effect)->name,
                 (double)g->density);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectApply_Gravity(AbutEffect effect, AbutBody body)
{
  AbutEffect_Gravity *g;
  PetscLogEvent       event;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &g));
  PetscCall(AbutEffectGetEvent(effect, &event));
  PetscCall(AbutBodyAddForce(body, ((PetscObject)effect)->name, event, PETSC_TRUE, AbutGravityForce_Private, g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectView_Gravity(AbutEffect effect, PetscViewer viewer)
{
  AbutEffect_Gravity *g;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &g));
  PetscCall(PetscViewerASCIIPrintf(viewer, ", density %g, acceleration (%g, %g)", (double)g->density, (double)g->acceleration[0],
                                   (double)g->acceleration[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectDestroy_Gravity(AbutEffect effect)
{
  AbutEffect_Gravity *g;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &g));
  PetscCall(PetscFree(g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutEffectCreate_Gravity(AbutEffect effect)
{
  const AbutEffectOps ops = {.setfromoptions = AbutEffectSetFromOptions_Gravity,
                             .apply          = AbutEffectApply_Gravity,
                             .view           = AbutEffectView_Gravity,
                             .destroy        = AbutEffectDestroy_Gravity};
  AbutEffect_Gravity *g;

  PetscFunctionBegin;
  PetscCall(PetscNew(&g));
  g->acceleration[1] = -9.81;
  PetscCall(AbutEffectSetData(effect, g));
  PetscCall(AbutEffectSetOps(effect, &ops));
  PetscCall(AbutEffectSetAbout(effect, "the weight of bodies"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
