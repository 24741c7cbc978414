#include <abut/private/effectimpl.h> /*I "abuteffect.h" I*/

/*MC
   ABUTEFFECTTHERMAL - "thermal": bodies that are warmer than where they are free of stress

   Options Database Keys:
+  -NAME_effect_temperature <T> - by how much, per point: number, formula in x and y, or CSV file, K
-  -NAME_effect_expansion <a>   - coefficient of linear expansion, 1/K, for example 1.2e-5 of steel

   Level: beginner

   Notes:
   The strain a T in all three directions has no stress. In plane strain, where a body cannot grow across the plane, this makes a free one
   grow by (1 + nu) a T in the plane and leaves s33 = -E a T; a sheet in plane stress and a body with axial symmetry grow freely.
   `energy.strain` is the elastic energy, `energy.work` what is left of the work when that on this strain is taken off.

   A temperature that is linear in x and y leaves no stress in the plane of a free body, unless it is one of revolution, and every
   estimator can judge it; for others there is `residual`. Bodies of different materials take an effect each, effects on one body add up. In
   the log it is "AbutThermal".

   Limits: the temperature is given and not computed; material constants do not change with it; one coefficient for all directions. With
   order 1 a temperature that varies inside the cells leaves a stress in them of the size of the discretisation error.

.seealso: `AbutEffectSetType()`, `AbutBodyAddInitialStrain()`
M*/

typedef struct {
  AbutExpression temperature;
  PetscReal      expansion;
} AbutEffect_Thermal;

static PetscErrorCode AbutThermalStrain_Private(const PetscReal x[2], PetscReal strain[4], void *ctx)
{
  const AbutEffect_Thermal *e = (AbutEffect_Thermal *)ctx;
  PetscReal                 T;

  PetscFunctionBegin;
  PetscCall(AbutExpressionEvaluate(e->temperature, x, &T));
  strain[0] = strain[1] = strain[3] = e->expansion * T;
  strain[2]                         = 0.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectSetFromOptions_Thermal(AbutEffect effect, AbutOptionItems PetscOptionsObject)
{
  AbutEffect_Thermal *e;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &e));
  PetscCall(AbutEffectOptionsExpression(effect, PetscOptionsObject, "-effect_temperature", "By how much a body is warmer", NULL,
                                        &e->temperature));
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-effect_expansion", "Coefficient of linear expansion", &e->expansion, NULL));
  AbutCheckInput(e->expansion != 0., PetscObjectComm((PetscObject)effect),
                 "%s_effect_expansion: missing, or 0; give the coefficient of linear expansion, for example 1.2e-5",
                 ((PetscObject)effect)->name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is the temperature linear in the box of a body? A fit through three corners, looked at in many points: each is evaluated on all ranks,
   so that a temperature that is no finite number ends the run on all of them. */
static PetscErrorCode AbutThermalIsLinear_Private(AbutEffect_Thermal *e, AbutBody body, PetscBool *linear)
{
  PetscReal T[3], most = 0., off = 0.;

  PetscFunctionBegin;
  for (PetscInt i = -3; i < ABUT_EFFECT_SAMPLES; ++i) {
    PetscReal z[2], x[2], here;

    PetscCall(AbutEffectGetSample_Private(body, i, z, x));
    PetscCall(AbutExpressionEvaluate(e->temperature, x, &here));
    if (i < 0) T[i + 3] = here;
    else off = PetscMax(off, PetscAbsReal(here - T[0] - z[0] * (T[1] - T[0]) - z[1] * (T[2] - T[0])));
    most = PetscMax(most, PetscAbsReal(here));
  }
  *linear = (PetscBool)(off <= 1e-10 * most);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectApply_Thermal(AbutEffect effect, AbutBody body)
{
  AbutEffect_Thermal *e;
  PetscLogEvent       event;
  PetscBool           linear = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &e));
  PetscCall(AbutEffectGetEvent(effect, &event));
  PetscCall(AbutThermalIsLinear_Private(e, body, &linear));
  PetscCall(AbutBodyAddInitialStrain(body, ((PetscObject)effect)->name, event, linear, AbutThermalStrain_Private, e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectView_Thermal(AbutEffect effect, PetscViewer viewer)
{
  AbutEffect_Thermal *e;
  const char         *text;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &e));
  PetscCall(AbutExpressionGetText(e->temperature, &text));
  PetscCall(PetscViewerASCIIPrintf(viewer, ", temperature %s, expansion %g", text, (double)e->expansion));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectDestroy_Thermal(AbutEffect effect)
{
  AbutEffect_Thermal *e;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &e));
  PetscCall(AbutExpressionDestroy(&e->temperature));
  PetscCall(PetscFree(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutEffectCreate_Thermal(AbutEffect effect)
{
  const AbutEffectOps ops = {.setfromoptions = AbutEffectSetFromOptions_Thermal,
                             .apply          = AbutEffectApply_Thermal,
                             .view           = AbutEffectView_Thermal,
                             .destroy        = AbutEffectDestroy_Thermal};
  AbutEffect_Thermal *e;

  PetscFunctionBegin;
  PetscCall(PetscNew(&e));
  PetscCall(AbutEffectSetData(effect, e));
  PetscCall(AbutEffectSetOps(effect, &ops));
  PetscCall(AbutEffectSetAbout(effect, "bodies that are warmer than where they are free of stress"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
