#include <abut/private/sceneimpl.h> /*I "abutscene.h" I*/

PetscClassId ABUTSCENE_CLASSID;

/*@
   AbutSceneCreate - Creates an empty scene

   Collective

   Input Parameter:
.  comm - the communicator

   Output Parameter:
.  scene - the scene

   Level: beginner

.seealso: `AbutSceneSetFromOptions()`, `AbutSceneSolve()`, `AbutSceneDestroy()`
@*/
PetscErrorCode AbutSceneCreate(MPI_Comm comm, AbutScene *scene)
{
  PetscFunctionBegin;
  PetscAssertPointer(scene, 2);
  if (!ABUTSCENE_CLASSID) PetscCall(PetscClassIdRegister("Abut Scene", &ABUTSCENE_CLASSID));
  PetscCall(PetscHeaderCreate(*scene, ABUTSCENE_CLASSID, "AbutScene", "Bodies in contact", "Scene", comm, AbutSceneDestroy, AbutSceneView));
  (*scene)->eps_u      = 0.0015;
  (*scene)->loop_share = 0.3;
  (*scene)->consistent = 1e-6;
  (*scene)->verdict    = "not_solved";
  (*scene)->status     = 2;
  PetscCall(PetscTime(&(*scene)->begun));
  (*scene)->mark = (*scene)->begun;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutSceneSetUp - Sets up what the scene made: meshes, operators, pairs; an option that nobody has read by now, a body that nothing holds,
   a gap or a condition that is not finite end the run before that

   Collective

   Input Parameter:
.  scene - the scene

   Options Database Key:
.  -scene_view - prints what was made

   Level: beginner

.seealso: `AbutSceneSetFromOptions()`, `AbutSceneSolve()`
@*/
PetscErrorCode AbutSceneSetUp(AbutScene scene)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(scene, ABUTSCENE_CLASSID, 1);
  if (scene->setupcalled) PetscFunctionReturn(PETSC_SUCCESS);
  scene->setupcalled = PETSC_TRUE;
  PetscCall(AbutScenePhaseBegin_Private(ABUT_TIME_SETUP));
  PetscCall(AbutOptionsCheckAllRead(PetscObjectComm((PetscObject)scene), PETSC_FALSE));
  for (PetscInt i = 0; i < scene->nbodies; ++i) PetscCall(AbutBodyCheck(scene->body[i]));
  for (PetscInt i = 0; i < scene->neffects; ++i) PetscCall(AbutEffectCheck(scene->effect[i]));
  for (PetscInt i = 0; i < scene->npairs; ++i) PetscCall(AbutPairCheck(scene->pair[i]));
  for (PetscInt i = 0; i < scene->nbodies; ++i)
    if (scene->estimates[i]) PetscCall(AbutEstimatorCheck(scene->estimator, scene->body[i]));
  PetscCall(AbutInterfaceCheck(scene->iface));
  PetscCall(AbutSceneCheckLoop_Private(scene));
  PetscCall(AbutSceneSplit_Private(scene, PETSC_TRUE));
  PetscCall(AbutSceneRestart_Private(scene));
  PetscCall(AbutSceneSetLoadFactor_Private(scene));
  PetscCall(AbutSceneSplit_Private(scene, PETSC_FALSE));
  PetscCall(AbutInterfaceSetUp(scene->iface));
  PetscCall(AbutSceneSetLinearTolerance_Private(scene));
  PetscCall(AbutSceneWarnOfOverlap_Private(scene));
  PetscCall(AbutScenePhaseNext_Private(scene, ABUT_TIME_SETUP, ABUT_TIME_SETUP));
  PetscCall(PetscLogStagePop());
  PetscCall(PetscObjectViewFromOptions((PetscObject)scene, NULL, "-scene_view"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutSceneGetExitStatus - How a run ended, as the program's exit status

   Not Collective

   Input Parameter:
.  scene - the scene, solved

   Output Parameter:
.  status - 0 converged and consistent, 2 not converged, 3 a limit was reached

   Level: beginner

.seealso: `AbutSceneSolve()`
@*/
PetscErrorCode AbutSceneGetExitStatus(AbutScene scene, PetscInt *status)
{
  PetscFunctionBegin;
  *status = scene->status;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutSceneGetBody - A body of the scene by name

   Not Collective

   Input Parameters:
+  scene - the scene
-  name  - the name, compared without case

   Output Parameter:
.  body - the body, owned by the scene, or `NULL`

   Level: intermediate

.seealso: `AbutSceneGetPair()`
@*/
PetscErrorCode AbutSceneGetBody(AbutScene scene, const char name[], AbutBody *body)
{
  const char *other;
  PetscBool   match;

  PetscFunctionBegin;
  *body = NULL;
  for (PetscInt i = 0; i < scene->nbodies; ++i) {
    PetscCall(AbutBodyGetName(scene->body[i], &other));
    PetscCall(PetscStrcasecmp(name, other, &match));
    if (match) *body = scene->body[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutSceneGetPair - A pair of the scene by name

   Not Collective

   Input Parameters:
+  scene - the scene
-  name  - the name, compared without case

   Output Parameters:
+  pair   - the pair, owned by the scene, or `NULL`
-  number - its number in the `AbutInterface`, or -1

   Level: intermediate

.seealso: `AbutSceneGetBody()`, `AbutSceneGetInterface()`
@*/
PetscErrorCode AbutSceneGetPair(AbutScene scene, const char name[], AbutPair *pair, PetscInt *number)
{
  const char *other;
  PetscBool   match;

  PetscFunctionBegin;
  *pair   = NULL;
  *number = -1;
  for (PetscInt i = 0; i < scene->npairs; ++i) {
    PetscCall(AbutPairGetName(scene->pair[i], &other));
    PetscCall(PetscStrcasecmp(name, other, &match));
    if (!match) continue;
    *pair   = scene->pair[i];
    *number = i;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutSceneGetInterface - The map of the interface trace

   Not Collective

   Input Parameter:
.  scene - the scene, set up

   Output Parameter:
.  iface - the map, owned by the scene

   Level: intermediate

.seealso: `AbutSceneGetPair()`
@*/
PetscErrorCode AbutSceneGetInterface(AbutScene scene, AbutInterface *iface)
{
  PetscFunctionBegin;
  *iface = scene->iface;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutSceneView - Prints what a scene made: bodies, pairs, loop, estimator, adaptor, with the tolerances in force

   Collective

   Input Parameters:
+  scene  - the scene, set up
-  viewer - the viewer

   Level: beginner

.seealso: `AbutSceneCreate()`
@*/
PetscErrorCode AbutSceneView(AbutScene scene, PetscViewer viewer)
{
  PetscInt unknowns;

  PetscFunctionBegin;
  PetscCall(AbutSceneGetUnknowns_Private(scene, &unknowns));
  PetscCall(PetscViewerASCIIPrintf(viewer, "scene of %" PetscInt_FMT " bodies and %" PetscInt_FMT " pairs, %" PetscInt_FMT " unknowns\n",
                                   scene->nbodies, scene->npairs, unknowns));
  PetscCall(PetscViewerASCIIPushTab(viewer));
  PetscCall(AbutSceneViewTolerance_Private(scene, viewer));
  for (PetscInt i = 0; i < scene->nbodies; ++i) PetscCall(AbutBodyView(scene->body[i], viewer));
  for (PetscInt i = 0; i < scene->neffects; ++i) PetscCall(AbutEffectView(scene->effect[i], viewer));
  for (PetscInt i = 0; i < scene->npairs; ++i) PetscCall(AbutPairView(scene->pair[i], viewer));
  if (scene->snes) PetscCall(SNESView(scene->snes, viewer));
  if (scene->interleave)
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "one sweep and one adaptation a cycle, until the relative change of the traces is at most %g\n",
                                     (double)scene->eps_u));
  if (scene->estimator) PetscCall(AbutEstimatorView(scene->estimator, viewer));
  if (scene->adaptor) PetscCall(AbutAdaptorView(scene->adaptor, viewer));
  PetscCall(PetscViewerASCIIPopTab(viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutSceneDestroy - Frees a scene and what it made

   Collective

   Input Parameter:
.  scene - the scene; set to `NULL`

   Level: beginner

.seealso: `AbutSceneCreate()`
@*/
PetscErrorCode AbutSceneDestroy(AbutScene *scene)
{
  AbutScene s = *scene;

  PetscFunctionBegin;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscValidHeaderSpecific(s, ABUTSCENE_CLASSID, 1);
  if (--((PetscObject)s)->refct > 0) {
    *scene = NULL;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(VecDestroy(&s->x));
  PetscCall(PetscFree(s->edge));
  PetscCall(PetscFree(s->factor));
  PetscCall(PetscFree(s->checkpoint));
  PetscCall(AbutArchiveDestroy(&s->restart));
  PetscCall(SNESDestroy(&s->snes));
  PetscCall(AbutInterfaceDestroy(&s->iface));
  PetscCall(AbutEstimatorDestroy(&s->estimator));
  PetscCall(AbutAdaptorDestroy(&s->adaptor));
  PetscCall(AbutRecorderDestroy(&s->recorder));
  for (PetscInt i = 0; i < s->npairs; ++i) PetscCall(AbutPairDestroy(&s->pair[i]));
  for (PetscInt i = 0; i < s->nbodies; ++i) {
    PetscCall(VecDestroy(&s->eta[i]));
    PetscCall(AbutBodyDestroy(&s->body[i]));
  }
  for (PetscInt i = 0; i < s->neffects; ++i) PetscCall(AbutEffectDestroy(&s->effect[i]));
  for (PetscInt i = 0; i < s->nprobes; ++i) PetscCall(PetscFree(s->probe[i].name));
  PetscCall(PetscHeaderDestroy(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}
