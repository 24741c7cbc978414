#include <abut/private/sceneimpl.h>

/* The phases of a run: seconds of the record, and stages of PETSc's log with messages, flops and memory of every rank */

/* Until PetscLogStagePop() the log counts for this phase; a run that never comes there has no such stage */
PetscErrorCode AbutScenePhaseBegin_Private(AbutTime phase)
{
  static const char *const name[ABUT_TIMES] = {"Set-up", "Sweeps", "Estimate", "Adapt", "Output"};
  PetscLogStage            stage            = -1;

  PetscFunctionBegin;
  PetscCall(PetscLogStageGetId(name[phase], &stage));
  if (stage < 0) PetscCall(PetscLogStageRegister(name[phase], &stage));
  PetscCall(PetscLogStagePush(stage));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Seconds since the last call go to the phase that ends, and the next one begins */
PetscErrorCode AbutScenePhaseNext_Private(AbutScene scene, AbutTime phase, AbutTime next)
{
  PetscLogDouble now;

  PetscFunctionBegin;
  PetscCall(PetscTime(&now));
  scene->seconds[phase] += now - scene->mark;
  scene->mark = now;
  PetscCall(PetscLogStagePop());
  PetscCall(AbutScenePhaseBegin_Private(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}
