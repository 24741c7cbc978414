#include <abut/private/effectimpl.h> /*I "abuteffect.h" I*/

/* The types of effects there are, and what a type tells the class and keeps there */

static PetscFunctionList AbutEffectList        = NULL;
static PetscBool         AbutEffectInitialized = PETSC_FALSE;

static PetscErrorCode AbutEffectFinalizePackage(void)
{
  PetscFunctionBegin;
  PetscCall(PetscFunctionListDestroy(&AbutEffectList));
  AbutEffectInitialized = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutEffectInitializePackage_Private(void)
{
  PetscFunctionBegin;
  if (AbutEffectInitialized) PetscFunctionReturn(PETSC_SUCCESS);
  AbutEffectInitialized = PETSC_TRUE;
  PetscCall(PetscClassIdRegister("Abut Effect", &ABUTEFFECT_CLASSID));
  PetscCall(PetscRegisterFinalize(AbutEffectFinalizePackage));
  PetscCall(AbutEffectRegister(ABUTEFFECTGRAVITY, AbutEffectCreate_Gravity));
  PetscCall(AbutEffectRegister(ABUTEFFECTFORCE, AbutEffectCreate_Force));
  PetscCall(AbutEffectRegister(ABUTEFFECTPRESSURE, AbutEffectCreate_Pressure));
  PetscCall(AbutEffectRegister(ABUTEFFECTSPRING, AbutEffectCreate_Spring));
  PetscCall(AbutEffectRegister(ABUTEFFECTOVERLAP, AbutEffectCreate_Overlap));
  PetscCall(AbutEffectRegister(ABUTEFFECTTHERMAL, AbutEffectCreate_Thermal));
  PetscCall(AbutEffectRegister(ABUTEFFECTPLANESTRESS, AbutEffectCreate_PlaneStress));
  PetscCall(AbutEffectRegister(ABUTEFFECTAXISYMMETRIC, AbutEffectCreate_Axisymmetric));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutEffectRegister - Adds a type of effect

   Not Collective, to be called by all ranks

   Input Parameters:
+  name   - the value of `-NAME_effect_type` that chooses it
-  create - fills in a new effect: `AbutEffectSetOps()`, and `AbutEffectSetData()` if it has data

   Level: advanced

   Note:
   A plugin `libeffect_NAME.so` calls this in its function `PetscDLLibraryRegister_effect_NAME()`.

.seealso: `AbutEffectSetType()`, `AbutEffectSetOps()`, `AbutPluginLoad()`
@*/
PetscErrorCode AbutEffectRegister(const char name[], PetscErrorCode (*create)(AbutEffect))
{
  PetscFunctionBegin;
  PetscCall(AbutEffectInitializePackage_Private());
  PetscCall(PetscFunctionListAdd(&AbutEffectList, name, create));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEffectFindType_Private(AbutEffect effect, AbutEffectType type, PetscErrorCode (**create)(AbutEffect))
{
  char key[256];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(key, sizeof(key), "%s_effect_type", ((PetscObject)effect)->name));
  PetscCall(AbutPluginFindType(PetscObjectComm((PetscObject)effect), key, "effect", "Effect", &AbutEffectList, type,
                               (PetscVoidFunction *)create));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The event "AbutGravity" of type "gravity", registered by its first effect */
static PetscErrorCode AbutEffectRegisterEvent_Private(AbutEffectType type, PetscLogEvent *event)
{
  char name[64];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(name, sizeof(name), "Abut%s", type));
  if (name[4] >= 'a' && name[4] <= 'z') name[4] += 'A' - 'a';
  PetscCall(AbutLogEventGet(name, ABUTEFFECT_CLASSID, event));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutEffectSetType - Chooses what an effect does

   Collective

   Input Parameters:
+  effect - the effect
-  type   - a name, such as `ABUTEFFECTGRAVITY`

   Options Database Keys:
+  -NAME_effect_type type - the name
-  -plugin_path folder    - where `libeffect_TYPE.so` is looked for

   Level: beginner

   Note:
   A type that is not yet registered is looked for as the plugin `libeffect_TYPE.so`.

.seealso: `AbutEffectSetFromOptions()`, `AbutEffectGetType()`, `AbutEffectRegister()`
@*/
PetscErrorCode AbutEffectSetType(AbutEffect effect, AbutEffectType type)
{
  PetscErrorCode (*create)(AbutEffect) = NULL;
  PetscBool same;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(effect, ABUTEFFECT_CLASSID, 1);
  PetscCall(PetscObjectTypeCompare((PetscObject)effect, type, &same));
  if (same) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(!effect->applied, PetscObjectComm((PetscObject)effect), PETSC_ERR_ORDER, "The effect already acts on its bodies");
  PetscCall(AbutEffectFindType_Private(effect, type, &create));
  PetscTryTypeMethod(effect, destroy);
  PetscCall(PetscMemzero(effect->ops, sizeof(*effect->ops)));
  effect->data = NULL;
  PetscCall(PetscObjectChangeTypeName((PetscObject)effect, type));
  PetscCall((*create)(effect));
  AbutCheckInput(effect->ops->apply, PetscObjectComm((PetscObject)effect),
                 "%s_effect_type: the create routine of \"%s\" set no function apply; give it one with AbutEffectSetOps()",
                 ((PetscObject)effect)->name, type);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutEffectGetType - Gets the name of the type

   Not Collective

   Input Parameter:
.  effect - the effect

   Output Parameter:
.  type - the name, `NULL` if none was chosen

   Level: beginner

.seealso: `AbutEffectSetType()`
@*/
PetscErrorCode AbutEffectGetType(AbutEffect effect, AbutEffectType *type)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(effect, ABUTEFFECT_CLASSID, 1);
  *type = ((PetscObject)effect)->type_name;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEffectViewTypes - Prints every type of effect there is, a line each; opens plugins of effects for that

   Collective

   Input Parameters:
+  comm   - the communicator
-  viewer - an ASCII viewer

   Level: intermediate

.seealso: `AbutEffectRegister()`, `AbutEstimatorViewTypes()`
@*/
PetscErrorCode AbutEffectViewTypes(MPI_Comm comm, PetscViewer viewer)
{
  char names[512], *name, *rest = names;

  PetscFunctionBegin;
  PetscCall(AbutEffectInitializePackage_Private());
  PetscCall(AbutPluginListTypes("effect", AbutEffectList, names, sizeof(names)));
  while ((name = strtok_r(NULL, ", ", &rest))) {
    AbutEffect effect;
    PetscErrorCode (*create)(AbutEffect);

    PetscCall(AbutEffectCreate(comm, name, &effect));
    PetscCall(AbutEffectSetType(effect, name));
    PetscCall(PetscFunctionListFind(AbutEffectList, name, &create));
    PetscCall(AbutPluginViewType(viewer, name, effect->about, (PetscVoidFunction)create));
    PetscCall(AbutEffectDestroy(&effect));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutEffectSetOps - Says what a type does; called by the create routine of the type

   Logically Collective

   Input Parameters:
+  effect - the effect
-  ops    - its functions, copied; `apply` is required

   Level: advanced

.seealso: `AbutEffectRegister()`, `AbutEffectSetData()`
@*/
PetscErrorCode AbutEffectSetOps(AbutEffect effect, const AbutEffectOps *ops)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(effect, ABUTEFFECT_CLASSID, 1);
  *effect->ops = *ops;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutEffectSetAbout - Says in one line what a type is, for `abut -list`; called by the create routine of the type

   Logically Collective

   Input Parameters:
+  effect - the effect
-  about  - the line, not copied

   Level: advanced

.seealso: `AbutEffectSetOps()`, `AbutEffectViewTypes()`
@*/
PetscErrorCode AbutEffectSetAbout(AbutEffect effect, const char about[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(effect, ABUTEFFECT_CLASSID, 1);
  effect->about = about;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEffectSetData - Gives an effect the data of its type

   Logically Collective

   Input Parameters:
+  effect - the effect
-  data   - anything; the `destroy` of the type frees it

   Level: advanced

.seealso: `AbutEffectGetData()`, `AbutEffectSetOps()`
@*/
PetscErrorCode AbutEffectSetData(AbutEffect effect, void *data)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(effect, ABUTEFFECT_CLASSID, 1);
  effect->data = data;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEffectGetData - Gets the data of the type

   Not Collective

   Input Parameter:
.  effect - the effect

   Output Parameter:
.  data - the address of a pointer to what `AbutEffectSetData()` was given

   Level: advanced

.seealso: `AbutEffectSetData()`
@*/
PetscErrorCode AbutEffectGetData(AbutEffect effect, void *data)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(effect, ABUTEFFECT_CLASSID, 1);
  *(void **)data = effect->data;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEffectGetEvent - The log event of the type, "AbutGravity" of "gravity"; the hooks of a body log it

   Not Collective

   Input Parameter:
.  effect - the effect, with bodies to act on

   Output Parameter:
.  event - the event

   Level: advanced

   Note:
   Registered by the first effect that asks, when it is applied; `-log_view` of a scene without one knows no such event.

.seealso: `AbutBodyAddForce()`, `AbutEffectSetUp()`
@*/
PetscErrorCode AbutEffectGetEvent(AbutEffect effect, PetscLogEvent *event)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(effect, ABUTEFFECT_CLASSID, 1);
  PetscCall(AbutEffectRegisterEvent_Private(((PetscObject)effect)->type_name, event));
  PetscFunctionReturn(PETSC_SUCCESS);
}
