#include <abut/private/sceneimpl.h> /*I "abutscene.h" I*/

/* The combined algorithm, Fig. 2 of the paper: solve, estimate, mark, refine, until no cell is above the threshold */

/* The trace of this cycle's meshes: the start, or the last trace at the new nodes */
static PetscErrorCode AbutSceneTrace_Private(AbutScene scene)
{
  PetscBool active; /* has its own start */

  PetscFunctionBegin;
  PetscCall(AbutInterfaceSetUp(scene->iface));
  PetscCall(AbutSceneSetLinearTolerance_Private(scene));
  if (scene->x || !scene->snes) PetscFunctionReturn(PETSC_SUCCESS); /* the meshes have stayed */
  PetscCall(AbutInterfaceCreateVec(scene->iface, &scene->x));
  PetscCall(AbutInterfaceSetSNES(scene->iface, scene->snes));
  PetscCall(PetscObjectTypeCompare((PetscObject)scene->snes, SNESDDACTIVE, &active));
  if (scene->cycle && !scene->cold && !scene->anew) PetscCall(AbutInterfaceTransferTrace(scene->iface, scene->x));
  else if (!active) PetscCall(AbutInterfaceComputeStart(scene->iface, (AbutStart)scene->start, scene->x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One SNES solve; interleaved, one sweep, after which the scene asks how far the traces moved on the same mesh */
static PetscErrorCode AbutSceneLoop_Private(AbutScene scene, PetscBool *converged)
{
  Vec       before = NULL;
  PetscReal change;

  PetscFunctionBegin;
  if (!scene->snes) { /* bodies without contact: one solve each */
    for (PetscInt b = 0; b < scene->nbodies; ++b) PetscCall(AbutBodySolve(scene->body[b], NULL));
    *converged = PETSC_TRUE;
    for (PetscInt b = 0; b < scene->nbodies; ++b) {
      PetscBool solved;

      PetscCall(AbutBodyGetSolved(scene->body[b], &solved));
      if (!solved) *converged = PETSC_FALSE;
    }
    scene->verdict = *converged ? "converged" : "linear_solver";
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (scene->interleave) {
    PetscCall(VecDuplicate(scene->x, &before));
    PetscCall(VecCopy(scene->x, before));
  }
  PetscCall(SNESSolve(scene->snes, NULL, scene->x));
  PetscCall(AbutInterfaceGetVerdict(scene->iface, scene->snes, converged, &scene->verdict));
  if (!*converged) PetscCall(AbutInterfaceSweepBest(scene->iface, scene->x));
  if (scene->interleave && *converged) {
    PetscCall(VecAYPX(before, -1., scene->x));
    PetscCall(AbutInterfaceGetChange(scene->iface, before, scene->x, &change));
    *converged = (PetscBool)(change <= scene->eps_u);
  }
  PetscCall(VecDestroy(&before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Estimates every body that asks for it, and all of them together */
static PetscErrorCode AbutSceneEstimate_Private(AbutScene scene, PetscReal norm[])
{
  PetscFunctionBegin;
  scene->unknowns_estimator = 0;
  for (PetscInt b = 0; b < scene->nbodies; ++b) {
    PetscInt n;

    if (!scene->estimates[b]) continue;
    PetscCall(VecDestroy(&scene->eta[b]));
    PetscCall(AbutBodyCreateCellVec(scene->body[b], &scene->eta[b]));
    PetscCall(AbutEstimatorEstimate(scene->estimator, scene->body[b], scene->eta[b]));
    PetscCall(AbutEstimatorGetUnknowns(scene->estimator, &n));
    scene->unknowns_estimator += n;
  }
  PetscCall(AbutSceneGetDiscretisation_Private(scene, &scene->discretisation, norm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One body's cells; no marks: its mesh stays */
static PetscErrorCode AbutSceneMarkBody_Private(AbutScene scene, PetscInt b, PetscBool *mark[], PetscInt *n, AbutAdaptVerdict *verdict)
{
  const AbutMeshTopology *t;
  AbutMesh                mesh;
  PetscBool              *peaks;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(scene->body[b], &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(PetscCalloc1(t->ncells, &peaks));
  PetscCall(AbutSceneMarkPeaks_Private(scene, scene->body[b], peaks));
  PetscCall(PetscMalloc1(t->ncells + 1, mark)); /* not NULL on a rank without cells either */
  PetscCall(AbutAdaptorMark(scene->adaptor, scene->body[b], scene->eta[b], peaks, *mark, n, verdict));
  PetscCall(PetscFree(peaks));
  if (!*n) PetscCall(PetscFree(*mark));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* As long as one body refines or its mesh is to move, the run goes on; then the worst verdict counts */
static PetscErrorCode AbutSceneMark_Private(AbutScene scene, const PetscReal norm[], PetscBool *marks[], AbutAdaptVerdict *verdict,
                                            PetscInt *nmarked)
{
  PetscReal target = 0., allowance[ABUT_MAX_NAMES];
  PetscBool settles;

  PetscFunctionBegin;
  PetscCall(AbutSceneSettles_Private(scene, &settles));
  if (scene->adaptor) PetscCall(AbutAdaptorGetTarget(scene->adaptor, &target));
  if (target > 0.) PetscCall(AbutAdaptorGetAllowances(scene->adaptor, scene->nbodies, scene->body, scene->eta, norm, allowance));
  *verdict = settles ? ABUT_ADAPT_REFINED : ABUT_ADAPT_DONE;
  *nmarked = 0;
  for (PetscInt b = 0; b < scene->nbodies; ++b) {
    AbutAdaptVerdict one;
    PetscInt         n;

    marks[b] = NULL;
    if (!scene->adaptor || !scene->eta[b] || settles) continue;
    if (target > 0.) PetscCall(AbutAdaptorSetAllowance(scene->adaptor, allowance[b]));
    PetscCall(AbutSceneMarkBody_Private(scene, b, &marks[b], &n, &one));
    *nmarked += n;
    if (one == ABUT_ADAPT_REFINED || (*verdict != ABUT_ADAPT_REFINED && one > *verdict)) *verdict = one;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The trace leaves its meshes or its load, and is kept for what comes, or not */
PetscErrorCode AbutSceneLeaveTrace_Private(AbutScene scene, PetscBool keep)
{
  PetscFunctionBegin;
  if (!scene->snes) PetscFunctionReturn(PETSC_SUCCESS);
  if (keep) PetscCall(AbutInterfaceKeepTrace(scene->iface, scene->x));
  else PetscCall(AbutInterfaceForgetTrace(scene->iface));
  PetscCall(VecDestroy(&scene->x));
  /* a new solver: what the old one remembers belongs to the old mesh, and not every type forgets it in SNESReset() */
  PetscCall(SNESDestroy(&scene->snes));
  PetscCall(AbutSceneSolverFromOptions_Private(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* New meshes; the trace crosses over by evaluation */
static PetscErrorCode AbutSceneAdapt_Private(AbutScene scene, PetscBool *const marks[])
{
  PetscFunctionBegin;
  PetscCall(AbutSceneKeepEdges_Private(scene));
  scene->settled = PETSC_TRUE;
  scene->anew    = PETSC_FALSE;
  PetscCall(AbutSceneLeaveTrace_Private(scene, (PetscBool)!scene->cold));
  for (PetscInt b = 0; b < scene->nbodies; ++b) {
    if (!scene->estimates[b]) continue;
    if (marks[b]) scene->settled = PETSC_FALSE;
    PetscCall(AbutSceneAdaptBody_Private(scene, scene->body[b], marks[b]));
    PetscCall(VecDestroy(&scene->eta[b]));
  }
  PetscCall(AbutInterfaceReset(scene->iface));
  PetscCall(AbutSceneSplit_Private(scene, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is this the last cycle of the run or of its step, and with which verdict? */
static PetscBool AbutSceneEnds_Private(AbutScene scene, PetscBool converged, PetscBool consistent, AbutAdaptVerdict adapt)
{
  const PetscBool failed = (PetscBool)(strcmp(scene->verdict, "converged") != 0);

  scene->status = failed ? 2 : 0;
  if (failed) return PETSC_TRUE;
  if (!consistent) {
    scene->verdict = "inconsistent";
    scene->status  = 2;
    return PETSC_TRUE;
  }
  if (adapt == ABUT_ADAPT_REFINED) return PETSC_FALSE;
  if (!converged) { /* interleaved: the meshes stand still, the traces not yet */
    if (scene->cycle - scene->first < 10000) return PETSC_FALSE;
    scene->verdict = "max_iterations";
    scene->status  = 2;
    return PETSC_TRUE;
  }
  if (scene->tol > 0. && adapt == ABUT_ADAPT_DONE &&
      scene->discretisation + scene->errors.penalty + scene->errors.loop + scene->errors.linear > scene->tol) {
    scene->verdict = "inconsistent"; /* the parts were chosen so that their sum stays below */
    scene->status  = 2;
  } else if (adapt != ABUT_ADAPT_DONE) {
    scene->verdict = adapt == ABUT_ADAPT_LEVEL ? "limit_level" : "limit_unknowns";
    scene->status  = 3;
  }
  return PETSC_TRUE;
}

/* last: of the run, or of its step */
static PetscErrorCode AbutSceneOutput_Private(AbutScene scene, PetscBool last)
{
  PetscBool wants;

  PetscFunctionBegin;
  PetscCall(AbutRecorderEndCycle(scene->recorder));
  if (scene->snes) PetscCall(AbutRecorderWriteCycleProfile(scene->recorder, scene->cycle, scene->iface, scene->npairs, scene->pair));
  if (scene->snes && last) PetscCall(AbutRecorderWriteProfile(scene->recorder, scene->iface, scene->npairs, scene->pair));
  PetscCall(AbutRecorderWantsFields(scene->recorder, &wants));
  if (wants) PetscCall(AbutRecorderWriteFields(scene->recorder, scene->cycle, scene->nbodies, scene->body, scene->eta));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A mesh that is going to be refined need not be solved further than to a part of its own error, and of what is asked of the pressure; the
   last one is solved to the end. Of the first mesh the error is not known yet. */
static PetscErrorCode AbutSceneLoosen_Private(AbutScene scene, PetscReal *rtol, PetscBool *loose)
{
  PetscReal       enough, peak;
  PetscBool       active;
  const PetscReal expected = 0.1;

  PetscFunctionBegin;
  *loose = PETSC_FALSE;
  if (!scene->snes || !scene->adaptor) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscObjectTypeCompare((PetscObject)scene->snes, SNESDDACTIVE, &active));
  PetscCall(SNESGetTolerances(scene->snes, NULL, rtol, NULL, NULL, NULL));
  enough = scene->loop_share * (scene->cycle ? PetscMin(1., scene->discretisation) : expected);
  PetscCall(AbutAdaptorGetPeak(scene->adaptor, &peak));
  if (peak > 0.) enough = PetscMin(enough, ABUT_SHARE_PEAK * peak);
  *loose = (PetscBool)(active && enough > *rtol);
  if (*loose) PetscCall(SNESSetTolerances(scene->snes, 0., enough, 0., PETSC_DEFAULT, PETSC_DEFAULT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutSceneFreeMarks_Private(AbutScene scene, PetscBool *marks[])
{
  PetscFunctionBegin;
  for (PetscInt b = 0; b < scene->nbodies; ++b) PetscCall(PetscFree(marks[b]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves, estimates and marks on the present meshes */
static PetscErrorCode AbutSceneCycle_Private(AbutScene scene, PetscBool *marks[], PetscBool *converged, AbutAdaptVerdict *adapt,
                                             PetscInt *nmarked)
{
  PetscReal norm[ABUT_MAX_NAMES], rtol = 0.;
  PetscBool loose, again               = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(AbutSceneTrace_Private(scene));
  PetscCall(AbutSceneLoosen_Private(scene, &rtol, &loose));
  PetscCall(AbutScenePhaseNext_Private(scene, ABUT_TIME_SETUP, ABUT_TIME_SOLVE));
  while (again) {
    PetscCall(AbutSceneFreeMarks_Private(scene, marks));
    PetscCall(AbutSceneLoop_Private(scene, converged));
    PetscCall(AbutScenePhaseNext_Private(scene, ABUT_TIME_SOLVE, ABUT_TIME_ESTIMATE));
    PetscCall(AbutSceneEstimate_Private(scene, norm));
    PetscCall(AbutSceneMark_Private(scene, norm, marks, adapt, nmarked));
    again = (PetscBool)(loose && *adapt != ABUT_ADAPT_REFINED && !strcmp(scene->verdict, "converged"));
    PetscCall(AbutScenePhaseNext_Private(scene, ABUT_TIME_ESTIMATE, again ? ABUT_TIME_SOLVE : ABUT_TIME_OUTPUT));
    if (again) PetscCall(SNESSetTolerances(scene->snes, 0., rtol, 0., PETSC_DEFAULT, PETSC_DEFAULT));
    loose = PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutSceneSolve - Runs the scene: solve, estimate, adapt, until nothing is left to refine or a limit is reached

   Collective

   Input Parameter:
.  scene - the scene; set up if need be

   Level: beginner

   Notes:
   By default the loop runs on each mesh until it leaves `-scene_loop_share` of the estimated error (ddactive) or to its tolerance (other
   types), and to its tolerance on the last mesh; with `-scene_interleave` a cycle is one sweep and one adaptation, as in Fig. 2
   of the paper. A run that does not converge keeps and writes its last answer; see `AbutSceneGetExitStatus()`.

   With `-scene_load_steps` all this is done for one factor of the load after the other (`AbutBodySetLoadFactor()`), each on the meshes that
   the last one left; ddactive starts from the forces of the last step, but from none where the factor is zero or has another sign. The
   first step that does not converge or does not agree with itself ends the run; one that reaches a limit does not, but its verdict is
   that of the run, if no later step fails.

   Limits: slips are counted from the end of the step before (`AbutInterfaceKeepSlip()`). Contact without friction keeps no memory, so that
   every step has the answer that its factor alone has, but for the meshes: those only become finer, unless `-adaptor_coarsen` is given, and
   move to the edges of the contacts of a step (`-adaptor_follow`) where that step refines, or with `-adaptor_settle`.

.seealso: `AbutSceneSetFromOptions()`, `AbutSceneGetExitStatus()`
@*/
PetscErrorCode AbutSceneSolve(AbutScene scene)
{
  PetscBool        ends = PETSC_FALSE, next = PETSC_FALSE, converged, consistent, *marks[ABUT_MAX_NAMES] = {NULL};
  AbutAdaptVerdict adapt   = ABUT_ADAPT_DONE;
  PetscInt         nmarked = 0;

  PetscFunctionBegin;
  PetscCall(AbutSceneSetUp(scene));
  PetscCall(AbutScenePhaseBegin_Private(ABUT_TIME_SETUP));
  PetscCall(AbutScenePrintGamma_Private(scene));
  PetscCall(AbutScenePrintHeader_Private(scene));
  PetscCall(AbutScenePrintStep_Private(scene));
  for (; !ends; ++scene->cycle) {
    PetscCall(AbutSceneCycle_Private(scene, marks, &converged, &adapt, &nmarked));
    PetscCall(AbutSceneRecord_Private(scene, (PetscBool)(adapt != ABUT_ADAPT_REFINED), &consistent));
    ends = AbutSceneEnds_Private(scene, converged, consistent, adapt);
    PetscCall(AbutSceneEndStep_Private(scene, adapt, &ends, &next));
    PetscCall(AbutRecorderSetString(scene->recorder, "verdict", scene->verdict));
    PetscCall(AbutSceneRecordTimes_Private(scene));
    PetscCall(AbutScenePrintCycle_Private(scene, nmarked));
    PetscCall(AbutSceneOutput_Private(scene, (PetscBool)(ends || next)));
    PetscCall(AbutScenePhaseNext_Private(scene, ABUT_TIME_OUTPUT, ABUT_TIME_ADAPT));
    if (next) PetscCall(AbutSceneNextStep_Private(scene));
    else if (!ends && adapt == ABUT_ADAPT_REFINED) PetscCall(AbutSceneAdapt_Private(scene, marks));
    PetscCall(AbutSceneFreeMarks_Private(scene, marks));
    PetscCall(AbutScenePhaseNext_Private(scene, ABUT_TIME_ADAPT, ABUT_TIME_SETUP));
    if (!ends) PetscCall(AbutSceneCheckpoint_Private(scene));
  }
  PetscCall(PetscLogStagePop());
  PetscCall(AbutSceneRecordTimes_Private(scene));
  PetscCall(AbutSceneRecordRatio_Private(scene));
  PetscCall(AbutRecorderWrite(scene->recorder));
  PetscCall(AbutScenePrintEnd_Private(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}
