#pragma once

#include <abutadaptor.h>
#include <abuteffect.h>
#include <abutrecorder.h>

/*S
   AbutScene - Reads what a scene names, owns it, and drives solve - estimate - adapt: the combined algorithm, Fig. 2 of the paper

   Level: beginner

.seealso: `AbutSceneCreate()`, `AbutSceneSolve()`
S*/
typedef struct _p_AbutScene *AbutScene;

PETSC_EXTERN PetscClassId   ABUTSCENE_CLASSID;
PETSC_EXTERN PetscErrorCode AbutSceneCreate(MPI_Comm, AbutScene *);
PETSC_EXTERN PetscErrorCode AbutSceneSetFromOptions(AbutScene);
PETSC_EXTERN PetscErrorCode AbutSceneSetUp(AbutScene);
PETSC_EXTERN PetscErrorCode AbutSceneSolve(AbutScene);
PETSC_EXTERN PetscErrorCode AbutSceneGetExitStatus(AbutScene, PetscInt *);
PETSC_EXTERN PetscErrorCode AbutSceneGetBody(AbutScene, const char[], AbutBody *);
PETSC_EXTERN PetscErrorCode AbutSceneGetPair(AbutScene, const char[], AbutPair *, PetscInt *);
PETSC_EXTERN PetscErrorCode AbutSceneGetInterface(AbutScene, AbutInterface *);
PETSC_EXTERN PetscErrorCode AbutSceneView(AbutScene, PetscViewer);
PETSC_EXTERN PetscErrorCode AbutSceneDestroy(AbutScene *);
