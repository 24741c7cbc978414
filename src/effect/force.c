#include <abut/private/effectimpl.h> /*I "abuteffect.h" I*/

/*MC
   ABUTEFFECTFORCE - "force": a force per volume, of each component a formula

   Options Database Keys:
+  -NAME_effect_f1 <0> - first component: number, formula in x and y, or CSV file, stress over length
-  -NAME_effect_f2 <0> - second component

   Level: beginner

   Notes:
   Integrated over each cell with order + 2 points in each direction. In the log it is "AbutForce".

   Limits: finite in the whole box of a body; that is looked at before any work, on 32 x 32 points. Estimators other than `residual` can do
   it where both components are numbers only.

.seealso: `AbutEffectSetType()`, `ABUTEFFECTGRAVITY`, `AbutBodyAddForce()`
M*/

typedef struct {
  AbutExpression f[2];
} AbutEffect_Force;

static PetscErrorCode AbutForceForce_Private(const PetscReal x[2], PetscReal force[2], void *ctx)
{
  const AbutEffect_Force *e = (AbutEffect_Force *)ctx;

  PetscFunctionBegin;
  for (PetscInt d = 0; d < 2; ++d) PetscCall(AbutExpressionEvaluate(e->f[d], x, &force[d]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectSetFromOptions_Force(AbutEffect effect, AbutOptionItems PetscOptionsObject)
{
  AbutEffect_Force *e;
  PetscBool         given[2];

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &e));
  for (PetscInt d = 0; d < 2; ++d) {
    const char *opt = d ? "-effect_f2" : "-effect_f1";

    PetscCall(PetscOptionsHasName(NULL, ((PetscObject)effect)->prefix, opt, &given[d]));
    PetscCall(AbutEffectOptionsExpression(effect, PetscOptionsObject, opt, "Force per volume", "0", &e->f[d]));
  }
  AbutCheckInput(given[0] || given[1], PetscObjectComm((PetscObject)effect),
                 "%s_effect_f1: missing, and so is %s_effect_f2; give at least one of them, for example 1e-3*y",
                 ((PetscObject)effect)->name, ((PetscObject)effect)->name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectCheck_Force(AbutEffect effect, AbutBody body)
{
  AbutEffect_Force *e;
  PetscReal         z[2], x[2], f[2];

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &e));
  for (PetscInt i = 0; i < ABUT_EFFECT_SAMPLES; ++i) {
    PetscCall(AbutEffectGetSample_Private(body, i, z, x));
    PetscCall(AbutForceForce_Private(x, f, e));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A number, and no formula */
static PetscErrorCode AbutExpressionIsNumber_Private(AbutExpression e, PetscBool *is)
{
  const char *text;
  char       *end;

  PetscFunctionBegin;
  PetscCall(AbutExpressionGetText(e, &text));
  (void)strtod(text, &end);
  *is = (PetscBool) !*end;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectApply_Force(AbutEffect effect, AbutBody body)
{
  AbutEffect_Force *e;
  PetscLogEvent     event;
  PetscBool         number[2];

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &e));
  PetscCall(AbutEffectGetEvent(effect, &event));
  for (PetscInt d = 0; d < 2; ++d) PetscCall(AbutExpressionIsNumber_Private(e->f[d], &number[d]));
  PetscCall(AbutBodyAddForce(body, ((PetscObject)effect)->name, event, (PetscBool)(number[0] && number[1]), AbutForceForce_Private, e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectView_Force(AbutEffect effect, PetscViewer viewer)
{
  AbutEffect_Force *e;
  const char       *text[2];

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &e));
  for (PetscInt d = 0; d < 2; ++d) PetscCall(AbutExpressionGetText(e->f[d], &text[d]));
  PetscCall(PetscViewerASCIIPrintf(viewer, ", (%s, %s)", text[0], text[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectDestroy_Force(AbutEffect effect)
{
  AbutEffect_Force *e;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &e));
  for (PetscInt d = 0; d < 2; ++d) PetscCall(AbutExpressionDestroy(&e->f[d]));
  PetscCall(PetscFree(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutEffectCreate_Force(AbutEffect effect)
{
  const AbutEffectOps ops = {.setfromoptions = AbutEffectSetFromOptions_Force,
                             .check          = AbutEffectCheck_Force,
                             .apply          = AbutEffectApply_Force,
                             .view           = AbutEffectView_Force,
                             .destroy        = AbutEffectDestroy_Force};
  AbutEffect_Force   *e;

  PetscFunctionBegin;
  PetscCall(PetscNew(&e));
  PetscCall(AbutEffectSetData(effect, e));
  PetscCall(AbutEffectSetOps(effect, &ops));
  PetscCall(AbutEffectSetAbout(effect, "a force per volume, by formulas"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
