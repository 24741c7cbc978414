#include <abut/private/sceneimpl.h>

/* Load steps: one factor after the other of all that is prescribed, each on the meshes the last one left */

#define ABUT_MAX_STEPS 1000

/* The next number of the list; *at moves behind its comma, and is NULL after the last one */
static PetscErrorCode AbutSceneReadFactor_Private(AbutScene scene, char **at, PetscReal *factor)
{
  char *word = *at, *comma = strchr(word, ','), *end;

  PetscFunctionBegin;
  *at = comma ? comma + 1 : NULL;
  if (comma) *comma = 0;
  *factor = strtod(word, &end);
  AbutCheckInput(end != word && !end[strspn(end, " ")] && !PetscIsInfOrNanReal(*factor), PetscObjectComm((PetscObject)scene),
                 "scene_load_steps: \"%.32s\" is not a number; give factors of the load separated by commas, for example 0.5,1", word);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutSceneStepsFromOptions_Private(AbutScene scene, AbutOptionItems PetscOptionsObject)
{
  const size_t len = 32 * ABUT_MAX_STEPS;
  char        *text, *at;
  PetscBool    set;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(len, &text));
  PetscCall(AbutOptionsString(PetscOptionsObject, "-scene_load_steps", "Factors of all that is prescribed, one after the other", text, len,
                              &set));
  at = set ? text : NULL;
  if (set) PetscCall(PetscMalloc1(ABUT_MAX_STEPS, &scene->factor));
  while (at) {
    AbutCheckInput(scene->nsteps < ABUT_MAX_STEPS, PetscObjectComm((PetscObject)scene),
                   "scene_load_steps: more than %d steps; give fewer, and go on with another run", ABUT_MAX_STEPS);
    PetscCall(AbutSceneReadFactor_Private(scene, &at, &scene->factor[scene->nsteps++]));
  }
  PetscCall(PetscFree(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The present step on all bodies, before they are set up or between two solves */
PetscErrorCode AbutSceneSetLoadFactor_Private(AbutScene scene)
{
  PetscFunctionBegin;
  for (PetscInt b = 0; b < scene->nbodies && scene->nsteps; ++b)
    PetscCall(AbutBodySetLoadFactor(scene->body[b], scene->factor[scene->step]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutSceneRecordStep_Private(AbutScene scene)
{
  PetscFunctionBegin;
  if (!scene->nsteps) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutRecorderSetInt(scene->recorder, "steps", scene->nsteps));
  PetscCall(AbutRecorderSetInt(scene->recorder, "step", scene->step + 1));
  PetscCall(AbutRecorderSetReal(scene->recorder, "load_factor", scene->factor[scene->step]));
  PetscCall(AbutRecorderSetStep(scene->recorder, scene->step + 1, scene->factor[scene->step]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutScenePrintStep_Private(AbutScene scene)
{
  PetscFunctionBegin;
  if (!scene->nsteps) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscPrintf(PetscObjectComm((PetscObject)scene), "step %" PetscInt_FMT " of %" PetscInt_FMT ": load factor %g\n",
                        scene->step + 1, scene->nsteps, (double)scene->factor[scene->step]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After a cycle that ends a step: does another one follow? The verdict of the run is that of the last step, or the first limit on the
   way. */
PetscErrorCode AbutSceneEndStep_Private(AbutScene scene, AbutAdaptVerdict adapt, PetscBool *ends, PetscBool *next)
{
  PetscFunctionBegin;
  *next = PETSC_FALSE;
  if (!scene->nsteps || !*ends || scene->status == 2) PetscFunctionReturn(PETSC_SUCCESS);
  if (scene->status == 3 && scene->limit == ABUT_ADAPT_DONE) scene->limit = adapt;
  *next = (PetscBool)(scene->step + 1 < scene->nsteps);
  *ends = (PetscBool) !*next;
  if (*next || scene->limit == ABUT_ADAPT_DONE) PetscFunctionReturn(PETSC_SUCCESS);
  scene->verdict = scene->limit == ABUT_ADAPT_LEVEL ? "limit_level" : "limit_unknowns";
  scene->status  = 3;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forces of another sign say nothing, and those that are to vanish would do so only up to the tolerance of the loop */
PetscErrorCode AbutSceneNextStep_Private(AbutScene scene)
{
  const PetscReal *f = scene->factor + scene->step;
  PetscLogEvent    event;

  PetscFunctionBegin;
  PetscCall(AbutLogEventGet("AbutLoadStep", ABUTSCENE_CLASSID, &event));
  PetscCall(PetscLogEventBegin(event, scene, 0, 0, 0));
  scene->anew    = (PetscBool)(f[0] * f[1] <= 0.);
  scene->settled = PETSC_FALSE;
  if (scene->snes) PetscCall(AbutInterfaceKeepSlip(scene->iface));
  PetscCall(AbutSceneLeaveTrace_Private(scene, (PetscBool)(!scene->cold && !scene->anew)));
  ++scene->step;
  scene->first = scene->cycle + 1;
  PetscCall(AbutSceneSetLoadFactor_Private(scene));
  PetscCall(AbutInterfaceReset(scene->iface));
  PetscCall(AbutScenePrintStep_Private(scene));
  PetscCall(PetscLogEventEnd(event, scene, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A run may go on with other factors than it began with, but not beyond the last one */
PetscErrorCode AbutSceneArchiveStep_Private(AbutScene scene, AbutArchive ar)
{
  PetscInt count[4] = {scene->step, scene->first, scene->anew, scene->limit};

  PetscFunctionBegin;
  PetscCall(AbutArchiveInts(ar, "load step", 4, count));
  AbutCheckInput(count[0] >= 0 && count[0] < PetscMax(1, scene->nsteps), PetscObjectComm((PetscObject)scene),
                 "restart: the checkpoint stands in load step %" PetscInt_FMT ", and scene_load_steps has %" PetscInt_FMT, count[0] + 1,
                 scene->nsteps);
  scene->step  = count[0];
  scene->first = count[1];
  scene->anew  = (PetscBool)count[2];
  scene->limit = (AbutAdaptVerdict)count[3];
  PetscCall(AbutSceneSetLoadFactor_Private(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}
