#include <abut.h>

static char help[] = "Unilateral contact of elastic bodies with adaptive meshes.\n\
  abut SCENE [-options]          for example: abut examples/layers/layers.yml -snes_monitor\n\
Exit status: 0 converged and consistent, 1 bad input or a file that cannot be written, 2 not converged, 3 a limit was reached.\n\n";

static PetscErrorCode AbutRun(PetscInt *status)
{
  AbutScene scene;
  PetscBool help;

  PetscFunctionBegin;
  PetscCall(AbutSceneCreate(PETSC_COMM_WORLD, &scene));
  PetscCall(AbutSceneSetFromOptions(scene));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-help", &help));
  *status = 0;
  if (!help) { /* -help has listed the keys of what the scene names, and that was all it asked for */
    PetscCall(AbutSceneSetUp(scene));
    PetscCall(AbutSceneSolve(scene));
    PetscCall(AbutSceneGetExitStatus(scene, status));
  }
  PetscCall(AbutSceneDestroy(&scene));
  if (!help) PetscCall(AbutOptionsCheckAllRead(PETSC_COMM_WORLD, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscInt       status = 1;
  PetscErrorCode ierr;

  /* no PetscCall() here: in main() it would end a bad input with an abort and its noise instead of one line */
  ierr = AbutInitialize(&argc, &argv, help);
  if (!ierr) ierr = AbutRun(&status);
  if (ierr && ierr != PETSC_ERR_USER_INPUT && ierr != PETSC_ERR_FILE_WRITE) MPI_Abort(MPI_COMM_WORLD, 70);
  if (AbutFinalize()) return 70;
  return ierr ? 1 : (int)status;
}
