#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/

/* What acts on a body beside its conditions, and is asked on every mesh. A body knows nothing of effects: they hang their functions
   here. */

static PetscErrorCode AbutBodyAddHook_Private(AbutBody body, AbutHookType type, const char name[], PetscLogEvent event, PetscInt feature,
                                              void *ctx, AbutHook *hook)
{
  AbutHook *last = &body->hooks;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  while (*last) last = &(*last)->next;
  PetscCall(PetscNew(last));
  (*last)->type    = type;
  (*last)->event   = event ? event : ABUTBODY_Assemble;
  (*last)->feature = feature;
  (*last)->side    = -1;
  (*last)->ctx     = ctx;
  PetscCall(PetscStrallocpy(name, &(*last)->name));
  *hook            = *last;
  body->generation = -1; /* what was set up is no longer right */
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutHooksDestroy_Private(AbutHook *hooks)
{
  PetscFunctionBegin;
  while (*hooks) {
    AbutHook next = (*hooks)->next;

    PetscCall(PetscFree((*hooks)->name));
    PetscCall(PetscFree(*hooks));
    *hooks = next;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyAddForce - Adds a body force, a force per volume

   Logically Collective

   Input Parameters:
+  body     - the body
.  name     - who brings it, for messages
.  event    - logged while it acts; 0 for that of the assembly
.  constant - whether it is the same everywhere, which more estimators can do
.  function - the force at a point, stress over length
-  ctx      - handed to the function

   Level: intermediate

   Note:
   Integrated over each cell with order + 2 points in each direction. A force that is not a finite number has to be found before the body
   is set up: cells are on different ranks.

.seealso: `AbutBodyAddTraction()`, `AbutBodyAddLoad()`, `AbutBodyGetForce()`
@*/
PetscErrorCode AbutBodyAddForce(AbutBody body, const char name[], PetscLogEvent event, PetscBool constant, AbutForceFunction function,
                                void *ctx)
{
  AbutHook h;

  PetscFunctionBegin;
  PetscCall(AbutBodyAddHook_Private(body, ABUT_HOOK_FORCE, name, event,
                                    constant ? ABUT_FEATURE_BODY_FORCE_CONSTANT : ABUT_FEATURE_BODY_FORCE_VARYING, ctx, &h));
  h->call.force = function;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyAddTraction - Adds a traction on a side, which may depend on the normal

   Logically Collective

   Input Parameters:
+  body     - the body
.  name     - who brings it, for messages
.  event    - logged while it acts; 0 for that of the assembly
.  side     - number of the side
.  function - the traction at a point, its outward unit normal given, stress
-  ctx      - handed to the function

   Level: intermediate

   Notes:
   It comes on top of `AbutBodySetTraction()`, and is integrated like that; `AbutBodyGetBoundary()` gives the sum. In a component whose
   displacement is prescribed it does nothing: there the support takes it.

   Limits: not for a side in contact, whose tractions are the contact forces.

.seealso: `AbutBodySetTraction()`, `AbutBodyAddForce()`
@*/
PetscErrorCode AbutBodyAddTraction(AbutBody body, const char name[], PetscLogEvent event, PetscInt side, AbutTractionFunction function,
                                   void *ctx)
{
  AbutHook h;

  PetscFunctionBegin;
  PetscCall(AbutBodyAddHook_Private(body, ABUT_HOOK_TRACTION, name, event, 0, ctx, &h));
  h->call.traction = function;
  h->side          = side;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyAddLoad - Adds nodal forces of any kind

   Logically Collective

   Input Parameters:
+  body     - the body
.  name     - who brings them, for messages
.  event    - logged while they are made; 0 for that of the assembly
.  function - adds its nodal forces, stress times length, to a vector of the layout of `AbutBodyCreateVec()`; called on every mesh
-  ctx      - handed to the function

   Level: advanced

   Notes:
   The function may use `AbutMeshGetTopology()` and `AbutBodyGetSide()`, is called by all ranks, and leaves the vector assembled. What is
   at a hanging node goes to its anchors, with their weights.

   Estimators know nothing of such forces, and refuse the body, except one that says that it can do `ABUT_FEATURE_LOAD`.

.seealso: `AbutBodyAddForce()`, `AbutBodyAddTraction()`
@*/
PetscErrorCode AbutBodyAddLoad(AbutBody body, const char name[], PetscLogEvent event, AbutLoadFunction function, void *ctx)
{
  AbutHook h;

  PetscFunctionBegin;
  PetscCall(AbutBodyAddHook_Private(body, ABUT_HOOK_LOAD, name, event, ABUT_FEATURE_LOAD, ctx, &h));
  h->call.load = function;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyAddFoundation - Puts a side on springs, a foundation of E. Winkler's: the traction is -k_n u_n n - k_t u_t t

   Logically Collective

   Input Parameters:
+  body       - the body
.  name       - who brings it, for messages
.  event      - logged while it enters the matrix; 0 for that of the assembly
.  side       - number of the side
.  normal     - k_n >= 0, force per area and length: stress over length
-  tangential - k_t >= 0, the same

   Level: intermediate

   Notes:
   The springs are without stress where nothing is displaced, and pull as well as they push. They are a part of the operator of the body
   and hold it: what they resist is no free mode. Their forces are among the reactions of `AbutBodyGetReaction()`, their work in that of
   `AbutBodyGetWork()`, and their tractions in those of `AbutBodyGetBoundary()`.

   Limits: a side that runs along no axis wants both k_n and k_t: the rigid motions that one of them leaves are no moves along an axis.

.seealso: `AbutBodyGetFoundation()`, `AbutBodyGetFreeModeCount()`
@*/
PetscErrorCode AbutBodyAddFoundation(AbutBody body, const char name[], PetscLogEvent event, PetscInt side, PetscReal normal,
                                     PetscReal tangential)
{
  AbutHook h;

  PetscFunctionBegin;
  PetscCheck(normal >= 0. && tangential >= 0., PetscObjectComm((PetscObject)body), PETSC_ERR_ARG_OUTOFRANGE,
             "Stiffnesses %g and %g are not both at least 0", (double)normal, (double)tangential);
  PetscCall(AbutBodyAddHook_Private(body, ABUT_HOOK_FOUNDATION, name, event, ABUT_FEATURE_FOUNDATION, NULL, &h));
  h->side         = side;
  h->stiffness[0] = normal;
  h->stiffness[1] = tangential;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyAddSideOffset - Says that a side stands out beyond where it is drawn; the pairs of the side find less gap

   Logically Collective

   Input Parameters:
+  body     - the body
.  name     - who brings it, for messages
.  event    - logged while pairs integrate the gap with it; 0 for that of the assembly
.  side     - number of the side
.  function - how far it stands out at a point, length
-  ctx      - handed to the function

   Level: intermediate

.seealso: `AbutBodyGetSideOffset()`, `AbutPairGetGap()`
@*/
PetscErrorCode AbutBodyAddSideOffset(AbutBody body, const char name[], PetscLogEvent event, PetscInt side, AbutPointFunction function,
                                     void *ctx)
{
  AbutHook h;

  PetscFunctionBegin;
  PetscCall(AbutBodyAddHook_Private(body, ABUT_HOOK_OFFSET, name, event, 0, ctx, &h));
  h->call.offset = function;
  h->side        = side;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyAddInitialStrain - Adds a strain that a body has without stress

   Logically Collective

   Input Parameters:
+  body     - the body
.  name     - who brings it, for messages
.  event    - logged while its nodal forces are made; 0 for that of the assembly
.  linear   - whether it is linear in x and y all over the body, which more estimators can do
.  function - e11, e22, e12 (half the change of the angle) and e33 at a point
-  ctx      - handed to the function

   Level: intermediate

   Notes:
   Stresses are those of the strain less this one. In plane strain e33 counts like the others, for the strain across the plane stays 0; in
   plane stress it makes no stress. Several add up.

   Limits: orders of convergence need a smooth function; at order p one that is not a polynomial of degree p - 1 leaves a stress of its own
   in every cell, of the size of the discretisation error.

.seealso: `AbutBodySetUp()`, `AbutBodyGetCellStresses()`, `AbutBodyGetEnergy()`
@*/
PetscErrorCode AbutBodyAddInitialStrain(AbutBody body, const char name[], PetscLogEvent event, PetscBool linear,
                                        AbutStrainFunction function, void *ctx)
{
  AbutHook h;

  PetscFunctionBegin;
  PetscCall(AbutBodyAddHook_Private(body, ABUT_HOOK_STRAIN, name, event,
                                    linear ? ABUT_FEATURE_INITIAL_STRAIN_LINEAR : ABUT_FEATURE_INITIAL_STRAIN, ctx, &h));
  h->call.strain = function;
  body->initial  = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyAddFeature - Says that a body has something that an estimator must know of

   Logically Collective

   Input Parameters:
+  body    - the body
.  name    - who brings it, for messages
-  feature - one of `ABUT_FEATURE_BODY_FORCE_CONSTANT` and so on

   Level: advanced

.seealso: `AbutBodyGetFeatures()`, `AbutEstimatorSetFeatures()`
@*/
PetscErrorCode AbutBodyAddFeature(AbutBody body, const char name[], PetscInt feature)
{
  AbutHook h;

  PetscFunctionBegin;
  PetscCall(AbutBodyAddHook_Private(body, ABUT_HOOK_FEATURE, name, 0, feature, NULL, &h));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetFeatures - What a body has that an estimator must know of

   Not Collective

   Input Parameter:
.  body - the body

   Output Parameter:
.  features - the sum of its `ABUT_FEATURE_BODY_FORCE_CONSTANT` and so on, 0 if there are none

   Level: advanced

.seealso: `AbutBodyFindFeature()`, `AbutEstimatorSetFeatures()`
@*/
PetscErrorCode AbutBodyGetFeatures(AbutBody body, PetscInt *features)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  *features = 0;
  for (AbutHook h = body->hooks; h; h = h->next) *features |= h->feature;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyFindFeature - The first feature of a body that is not among given ones, in words

   Not Collective

   Input Parameters:
+  body - the body
-  able - a sum of `ABUT_FEATURE_BODY_FORCE_CONSTANT` and so on

   Output Parameters:
+  what - "a body force" and the like, or `NULL` if there is none
-  name - who brought it; owned by the body

   Level: advanced

.seealso: `AbutBodyGetFeatures()`, `AbutEstimatorCheck()`
@*/
PetscErrorCode AbutBodyFindFeature(AbutBody body, PetscInt able, const char *what[], const char *name[])
{
  static const char *const words[] = {"a body force",   "a body force that varies",
                                      "springs",        "an initial strain that is not linear",
                                      "axial symmetry", "plane stress",
                                      "nodal forces",   "an initial strain"};

  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  *what = *name = NULL;
  for (AbutHook h = body->hooks; h && !*what; h = h->next)
    for (PetscInt i = 0; i < (PetscInt)PETSC_STATIC_ARRAY_LENGTH(words); ++i)
      if (h->feature & ~able & (1 << i)) {
        *what = words[i];
        *name = h->name;
      }
  PetscFunctionReturn(PETSC_SUCCESS);
}
