#pragma once

#include <abutestimator.h>

/*S
   AbutAdaptor - From one number per cell to marks, and to a new mesh: threshold (27), equal errors or bulk, caps on level and unknowns

   Level: intermediate

.seealso: `AbutAdaptorCreate()`, `AbutEstimator`, `AbutMeshAdapt()`
S*/
typedef struct _p_AbutAdaptor *AbutAdaptor;
typedef const char            *AbutAdaptorType;
#define ABUTADAPTORTHRESHOLD "threshold" /* cells whose indicator is above delta, eq. (27) of the paper */
#define ABUTADAPTOREQUAL     "equal"     /* cells with more than their share of the error, until the total is small enough */
#define ABUTADAPTORDOERFLER  "doerfler"  /* the fewest cells that hold a part of the error, until the total is small enough */

typedef enum {
  ABUT_ADAPT_DONE,    /* no cell is above the threshold, or above its share */
  ABUT_ADAPT_REFINED, /* cells are marked for refinement */
  ABUT_ADAPT_LEVEL,   /* every cell above the threshold is at -adaptor_max_level */
  ABUT_ADAPT_UNKNOWNS /* refining would pass -adaptor_max_unknowns */
} AbutAdaptVerdict;

PETSC_EXTERN PetscClassId   ABUTADAPTOR_CLASSID;
PETSC_EXTERN PetscErrorCode AbutAdaptorCreate(MPI_Comm, AbutAdaptor *);
PETSC_EXTERN PetscErrorCode AbutAdaptorSetType(AbutAdaptor, AbutAdaptorType);
PETSC_EXTERN PetscErrorCode AbutAdaptorSetFromOptions(AbutAdaptor);
PETSC_EXTERN PetscErrorCode AbutAdaptorSetTarget(AbutAdaptor, PetscReal);
PETSC_EXTERN PetscErrorCode AbutAdaptorGetTarget(AbutAdaptor, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutAdaptorGetAllowances(AbutAdaptor, PetscInt, AbutBody[], Vec[], const PetscReal[], PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutAdaptorSetAllowance(AbutAdaptor, PetscReal);
PETSC_EXTERN PetscErrorCode AbutAdaptorGetLevels(AbutAdaptor, PetscInt *, PetscInt *);
PETSC_EXTERN PetscErrorCode AbutAdaptorGetMaxUnknowns(AbutAdaptor, PetscInt *);
PETSC_EXTERN PetscErrorCode AbutAdaptorFollows(AbutAdaptor, PetscInt, PetscBool *);
PETSC_EXTERN PetscErrorCode AbutAdaptorSettles(AbutAdaptor, PetscBool *);
PETSC_EXTERN PetscErrorCode AbutAdaptorGetCoarsening(AbutAdaptor, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutAdaptorGetPeak(AbutAdaptor, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutAdaptorGetBodies(AbutAdaptor, PetscInt *, const char *const *[]);
PETSC_EXTERN PetscErrorCode AbutAdaptorMark(AbutAdaptor, AbutBody, Vec, const PetscBool[], PetscBool[], PetscInt *, AbutAdaptVerdict *);
PETSC_EXTERN PetscErrorCode AbutAdaptorView(AbutAdaptor, PetscViewer);
PETSC_EXTERN PetscErrorCode AbutAdaptorViewTypes(MPI_Comm, PetscViewer);
PETSC_EXTERN PetscErrorCode AbutAdaptorDestroy(AbutAdaptor *);
