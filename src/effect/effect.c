#include <abut/private/effectimpl.h> /*I "abuteffect.h" I*/

PetscClassId ABUTEFFECT_CLASSID;

/*@C
   AbutEffectCreate - Creates an effect, yet without a type

   Collective

   Input Parameters:
+  comm - the communicator of the bodies it will be used for
-  name - its name; its keys begin with it: `-weight_effect_type`

   Output Parameter:
.  effect - the effect

   Level: beginner

.seealso: `AbutEffectSetFromOptions()`, `AbutEffectSetType()`, `AbutEffectDestroy()`
@*/
PetscErrorCode AbutEffectCreate(MPI_Comm comm, const char name[], AbutEffect *effect)
{
  char prefix[128];

  PetscFunctionBegin;
  PetscAssertPointer(effect, 3);
  PetscCall(AbutEffectInitializePackage_Private());
  PetscCall(PetscHeaderCreate(*effect, ABUTEFFECT_CLASSID, "AbutEffect", "Effect on bodies", "Effect", comm, AbutEffectDestroy,
                              AbutEffectView));
  PetscCall(PetscObjectSetName((PetscObject)*effect, name));
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_", name));
  PetscCall(PetscObjectSetOptionsPrefix((PetscObject)*effect, prefix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEffectDestroy - Frees an effect, not before the last solve of its bodies

   Collective

   Input Parameter:
.  effect - the effect, `NULL` afterwards

   Level: beginner

.seealso: `AbutEffectCreate()`
@*/
PetscErrorCode AbutEffectDestroy(AbutEffect *effect)
{
  PetscFunctionBegin;
  if (!*effect) PetscFunctionReturn(PETSC_SUCCESS);
  PetscValidHeaderSpecific(*effect, ABUTEFFECT_CLASSID, 1);
  if (--((PetscObject)*effect)->refct > 0) {
    *effect = NULL;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscTryTypeMethod(*effect, destroy);
  PetscCall(PetscFree((*effect)->body));
  PetscCall(PetscHeaderDestroy(effect));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEffectSetBodies - Says which bodies an effect acts on

   Logically Collective

   Input Parameters:
+  effect - the effect
.  n      - how many
-  bodies - [n] the bodies, not copied and not referenced

   Level: intermediate

.seealso: `AbutEffectSetUp()`, `AbutEffectGetBodies()`
@*/
PetscErrorCode AbutEffectSetBodies(AbutEffect effect, PetscInt n, AbutBody bodies[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(effect, ABUTEFFECT_CLASSID, 1);
  PetscCall(PetscFree(effect->body));
  PetscCall(PetscMalloc1(n, &effect->body));
  PetscCall(PetscArraycpy(effect->body, bodies, n));
  effect->nbodies = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutEffectGetBodies - The bodies that an effect acts on

   Not Collective

   Input Parameter:
.  effect - the effect

   Output Parameters:
+  n      - how many
-  bodies - [n] the bodies; the array is owned by the effect

   Level: intermediate

.seealso: `AbutEffectSetBodies()`
@*/
PetscErrorCode AbutEffectGetBodies(AbutEffect effect, PetscInt *n, AbutBody *bodies[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(effect, ABUTEFFECT_CLASSID, 1);
  *n      = effect->nbodies;
  *bodies = effect->body;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEffectSetUp - Hangs the functions of an effect in the hooks of its bodies, once

   Logically Collective

   Input Parameter:
.  effect - the effect, with its type and its bodies

   Level: intermediate

.seealso: `AbutEffectSetFromOptions()`, `AbutEffectCheck()`
@*/
PetscErrorCode AbutEffectSetUp(AbutEffect effect)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(effect, ABUTEFFECT_CLASSID, 1);
  if (effect->applied) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(effect->ops->apply, PetscObjectComm((PetscObject)effect), PETSC_ERR_ORDER,
             "Choose a type with AbutEffectSetType() or AbutEffectSetFromOptions() first");
  for (PetscInt b = 0; b < effect->nbodies; ++b) PetscUseTypeMethod(effect, apply, effect->body[b]);
  effect->applied = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEffectCheck - Ends the run if an effect does not suit its bodies; needs no mesh yet

   Collective

   Input Parameter:
.  effect - the effect; pairs and conditions of its bodies are known

   Level: developer

.seealso: `AbutBodyCheck()`, `AbutPairCheck()`
@*/
PetscErrorCode AbutEffectCheck(AbutEffect effect)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(effect, ABUTEFFECT_CLASSID, 1);
  for (PetscInt b = 0; b < effect->nbodies; ++b) PetscTryTypeMethod(effect, check, effect->body[b]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutEffectGetName - The name of an effect

   Not Collective

   Input Parameter:
.  effect - the effect

   Output Parameter:
.  name - its name, owned by the effect

   Level: beginner

.seealso: `AbutEffectCreate()`
@*/
PetscErrorCode AbutEffectGetName(AbutEffect effect, const char *name[])
{
  PetscFunctionBegin;
  *name = ((PetscObject)effect)->name;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEffectView - Prints an effect: type, bodies, keys

   Collective

   Input Parameters:
+  effect - the effect
-  viewer - the viewer

   Level: beginner

.seealso: `AbutEffectCreate()`
@*/
PetscErrorCode AbutEffectView(AbutEffect effect, PetscViewer viewer)
{
  const char *type = ((PetscObject)effect)->type_name;

  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "effect %s: %s on ", ((PetscObject)effect)->name, type ? type : "yet without a type"));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_FALSE));
  for (PetscInt b = 0; b < effect->nbodies; ++b)
    PetscCall(PetscViewerASCIIPrintf(viewer, "%s%s", b ? ", " : "", ((PetscObject)effect->body[b])->name));
  PetscTryTypeMethod(effect, view, viewer);
  PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}
