#include <abut.h>

static char help[] = "Unilateral contact of elastic bodies with adaptive meshes.\n\
  abut SCENE [-options]          for example: abut examples/layers/layers.yml -snes_monitor\n\
  abut SCENE -explain            what the scene would make, and every key with the file it is from; solves nothing\n\
  abut -list                     the estimators, effects, loops and adaptors there are to choose from\n\
Exit status: 0 converged and consistent, 1 bad input or a file that cannot be written, 2 not converged, 3 a limit was reached.\n\n";

/* What there is to choose from, and where it was loaded from; -plugin adds to it */
static PetscErrorCode AbutList(void)
{
  const PetscViewer viewer = PETSC_VIEWER_STDOUT_WORLD;
  PetscBool         scene;

  PetscFunctionBegin;
  PetscCall(PetscOptionsHasName(NULL, NULL, "-scene_bodies", &scene));
  AbutCheckInput(!scene, PETSC_COMM_WORLD, "list: says what any scene may choose from; give it without a scene");
  PetscCall(AbutPluginAppendFromOptions(PETSC_COMM_WORLD));
  PetscCall(PetscViewerASCIIPrintf(viewer, "estimators, -estimator_type; several separated by commas\n"));
  PetscCall(AbutEstimatorViewTypes(PETSC_COMM_WORLD, viewer));
  PetscCall(PetscViewerASCIIPrintf(viewer, "effects, -NAME_effect_type\n"));
  PetscCall(AbutEffectViewTypes(PETSC_COMM_WORLD, viewer));
  PetscCall(PetscViewerASCIIPrintf(viewer, "loops, -snes_type\n"));
  PetscCall(AbutLoopViewTypes(viewer));
  PetscCall(PetscViewerASCIIPrintf(viewer, "adaptors, -adaptor_type\n"));
  PetscCall(AbutAdaptorViewTypes(PETSC_COMM_WORLD, viewer));
  PetscCall(AbutOptionsCheckAllRead(PETSC_COMM_WORLD, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the scene makes, and where each of its keys is from */
static PetscErrorCode AbutExplain(AbutScene scene)
{
  PetscFunctionBegin;
  PetscCall(AbutSceneSetUp(scene));
  PetscCall(AbutSceneView(scene, PETSC_VIEWER_STDOUT_WORLD));
  PetscCall(AbutOptionsView(PETSC_VIEWER_STDOUT_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutSolve(AbutScene scene, PetscInt *status)
{
  PetscFunctionBegin;
  PetscCall(AbutSceneSetUp(scene));
  PetscCall(AbutSceneSolve(scene));
  PetscCall(AbutSceneGetExitStatus(scene, status));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutRun(PetscInt *status)
{
  AbutScene scene;
  PetscBool help, list = PETSC_FALSE, explain = PETSC_FALSE;

  PetscFunctionBegin;
  *status = 0;
  PetscOptionsBegin(PETSC_COMM_WORLD, NULL, "What is asked for", NULL);
  PetscCall(AbutOptionsBool(PetscOptionsObject, "-list", "the types there are", &list, NULL));
  PetscCall(AbutOptionsBool(PetscOptionsObject, "-explain", "what the scene makes", &explain, NULL));
  PetscOptionsEnd();
  if (list) {
    PetscCall(AbutList());
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(AbutSceneCreate(PETSC_COMM_WORLD, &scene));
  PetscCall(AbutSceneSetFromOptions(scene));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-help", &help)); /* it has listed the keys of what the scene names: all it asks for */
  if (!help && explain) PetscCall(AbutExplain(scene));
  if (!help && !explain) PetscCall(AbutSolve(scene, status));
  PetscCall(AbutSceneDestroy(&scene));
  if (!help && !explain) PetscCall(AbutOptionsCheckAllRead(PETSC_COMM_WORLD, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define ABUT_PATIENCE 10. /* seconds */

/* A bad input is raised by all ranks or none; but a formula may be no number at a point that one rank alone has met, and the others would
   wait for it for ever */
static PetscBool AbutAllHaveFailed(void)
{
  const double begun = MPI_Wtime();
  MPI_Request  all;
  int          done = 0;

  if (MPI_Ibarrier(MPI_COMM_WORLD, &all)) return PETSC_FALSE;
  while (!done && MPI_Wtime() - begun < ABUT_PATIENCE)
    if (MPI_Test(&all, &done, MPI_STATUS_IGNORE)) return PETSC_FALSE;
  return (PetscBool)done;
}

int main(int argc, char **argv)
{
  PetscInt       status = 1;
  PetscErrorCode ierr;

  /* no PetscCall() here: in main() it would end a bad input with an abort and its noise instead of one line */
  ierr = AbutInitialize(&argc, &argv, help);
  if (!ierr) ierr = AbutRun(&status);
  if (ierr && ierr != PETSC_ERR_USER_INPUT && ierr != PETSC_ERR_FILE_WRITE) MPI_Abort(MPI_COMM_WORLD, 70);
  if (ierr && !AbutAllHaveFailed()) MPI_Abort(MPI_COMM_WORLD, 1);
  if (AbutFinalize()) return 70;
  return ierr ? 1 : (int)status;
}
