#include <abut/private/effectimpl.h> /*I "abuteffect.h" I*/

/*MC
   ABUTEFFECTPRESSURE - "pressure": on a side, along its normal wherever it runs

   Options Database Keys:
+  -NAME_effect_bodies <name> - the body
.  -NAME_effect_side <side>   - its side
-  -NAME_effect_pressure <p>  - number, formula in x and y, or CSV file, stress; above 0 it pushes on the body

   Level: beginner

   Notes:
   The traction -p n, on top of what `-BODY_bc_SIDE_t1` and `t2` give; estimators know it. The normal is that of the side as it is drawn: it
   does not turn with the body. In a component whose displacement is prescribed the support takes it. In the log it is "AbutPressure".

   Limits: not on a side in contact; small displacements.

.seealso: `AbutEffectSetType()`, `AbutBodyAddTraction()`, `AbutBodySetTraction()`
M*/

static PetscErrorCode AbutPressureTraction_Private(const PetscReal x[2], const PetscReal normal[2], PetscReal t[2], void *ctx)
{
  PetscReal p;

  PetscFunctionBegin;
  PetscCall(AbutExpressionEvaluate(((AbutEffect_Side *)ctx)->value, x, &p));
  for (PetscInt d = 0; d < 2; ++d) t[d] = -p * normal[d];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectApply_Pressure(AbutEffect effect, AbutBody body)
{
  AbutEffect_Side *e;
  PetscLogEvent    event;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &e));
  PetscCall(AbutEffectGetEvent(effect, &event));
  PetscCall(AbutBodyAddTraction(body, ((PetscObject)effect)->name, event, e->side, AbutPressureTraction_Private, e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutEffectCreate_Pressure(AbutEffect effect)
{
  PetscFunctionBegin;
  PetscCall(AbutEffectCreateSide_Private(effect, "-effect_pressure", "Pressure", PETSC_FALSE, AbutEffectApply_Pressure));
  PetscCall(AbutEffectSetAbout(effect, "a pressure on a side, along its normal"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
