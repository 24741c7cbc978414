#include <abut/private/effectimpl.h> /*I "abuteffect.h" I*/

/* Effects that are one formula along one side: what they have in common */

static PetscErrorCode AbutEffectSetFromOptions_Side(AbutEffect effect, AbutOptionItems PetscOptionsObject)
{
  AbutEffect_Side *e;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &e));
  PetscCall(AbutEffectOptionsSide(effect, PetscOptionsObject, &e->side));
  PetscCall(AbutEffectOptionsExpression(effect, PetscOptionsObject, e->opt, e->text, NULL, &e->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define ABUT_SAMPLES 32

/* What is given has to be finite; a point at an end may be none, as for a traction */
static PetscErrorCode AbutEffectCheck_Side(AbutEffect effect, AbutBody body)
{
  AbutEffect_Side *e;
  AbutMesh         mesh;
  const PetscReal *segment;
  PetscInt         n, samples;
  PetscReal        value;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &e));
  PetscCall(AbutEffectCheckSide(effect, body, e->side, e->contact));
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetSideSegments(mesh, e->side, &n, &segment));
  samples = PetscMax(2, ABUT_SAMPLES / n);
  for (PetscInt i = 0; i < n * samples; ++i) {
    const PetscReal *ends = segment + 4 * (i / samples), z = (i % samples + 0.5) / samples;
    const PetscReal  x[2] = {(1. - z) * ends[0] + z * ends[2], (1. - z) * ends[1] + z * ends[3]};

    PetscCall(AbutExpressionEvaluate(e->value, x, &value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectView_Side(AbutEffect effect, PetscViewer viewer)
{
  AbutEffect_Side *e;
  AbutMesh         mesh;
  const char      *text, *side;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &e));
  PetscCall(AbutBodyGetMesh(effect->body[0], &mesh));
  PetscCall(AbutMeshGetSideName(mesh, e->side, &side));
  PetscCall(AbutExpressionGetText(e->value, &text));
  PetscCall(PetscViewerASCIIPrintf(viewer, ", %s: %s", side, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectDestroy_Side(AbutEffect effect)
{
  AbutEffect_Side *e;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &e));
  PetscCall(AbutExpressionDestroy(&e->value));
  PetscCall(PetscFree(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A type with the key `opt`, for sides in contact or for others */
PetscErrorCode AbutEffectCreateSide_Private(AbutEffect effect, const char opt[], const char text[], PetscBool contact,
                                            PetscErrorCode (*apply)(AbutEffect, AbutBody))
{
  const AbutEffectOps ops = {.setfromoptions = AbutEffectSetFromOptions_Side,
                             .check          = AbutEffectCheck_Side,
                             .apply          = apply,
                             .view           = AbutEffectView_Side,
                             .destroy        = AbutEffectDestroy_Side};
  AbutEffect_Side    *e;

  PetscFunctionBegin;
  PetscCall(PetscNew(&e));
  e->opt     = opt;
  e->text    = text;
  e->contact = contact;
  PetscCall(AbutEffectSetData(effect, e));
  PetscCall(AbutEffectSetOps(effect, &ops));
  PetscFunctionReturn(PETSC_SUCCESS);
}
