#include <abut/private/effectimpl.h> /*I "abuteffect.h" I*/

/*MC
   ABUTEFFECTOVERLAP - "overlap": a side stands out beyond where it is drawn, as in a press fit

   Options Database Keys:
+  -NAME_effect_bodies <name> - the body
.  -NAME_effect_side <side>   - its side, one in contact
-  -NAME_effect_depth <d>     - how far it stands out: number, formula in x and y, or CSV file, length; below 0 it stands back

   Level: beginner

   Notes:
   The pairs of the side find so much less gap, and contact pushes the bodies apart. Where an effect says so a run does not warn of sides
   that overlap at first. As it is one of the gap, a load factor does not change it. In the log it is "AbutOverlap".

   Limits: small against the cells: the bodies are computed as they are drawn.

.seealso: `AbutEffectSetType()`, `AbutBodyAddSideOffset()`, `AbutPairGetOverlap()`
M*/

static PetscErrorCode AbutOverlapOffset_Private(const PetscReal x[2], PetscReal *offset, void *ctx)
{
  PetscFunctionBegin;
  PetscCall(AbutExpressionEvaluate(((AbutEffect_Side *)ctx)->value, x, offset));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectApply_Overlap(AbutEffect effect, AbutBody body)
{
  AbutEffect_Side *e;
  PetscLogEvent    event;

  PetscFunctionBegin;
  PetscCall(AbutEffectGetData(effect, &e));
  PetscCall(AbutEffectGetEvent(effect, &event));
  PetscCall(AbutBodyAddSideOffset(body, ((PetscObject)effect)->name, event, e->side, AbutOverlapOffset_Private, e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutEffectCreate_Overlap(AbutEffect effect)
{
  PetscFunctionBegin;
  PetscCall(AbutEffectCreateSide_Private(effect, "-effect_depth", "How far the side stands out", PETSC_TRUE, AbutEffectApply_Overlap));
  PetscCall(AbutEffectSetAbout(effect, "a side that stands out, as in a press fit"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
