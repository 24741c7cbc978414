#pragma once

#include <abutscene.h>
#include <petsc/private/petscimpl.h>
#include <petsctime.h>

#define ABUT_MAX_NAMES 64

/* A point of which the record tells displacement and stress */
typedef struct {
  char     *name;
  AbutBody  body;
  PetscReal x[2];
} AbutProbe;

/* Where the seconds of a run went */
typedef enum {
  ABUT_TIME_SETUP,
  ABUT_TIME_SOLVE,
  ABUT_TIME_ESTIMATE,
  ABUT_TIME_ADAPT,
  ABUT_TIME_OUTPUT,
  ABUT_TIMES
} AbutTime;

struct _p_AbutScene {
  PETSCHEADER(int);
  PetscInt      nbodies, npairs, nprobes;
  AbutBody      body[ABUT_MAX_NAMES];
  AbutPair      pair[ABUT_MAX_NAMES];
  AbutProbe     probe[ABUT_MAX_NAMES];
  PetscBool     estimates[ABUT_MAX_NAMES]; /* bodies whose error is estimated, and adapted if there is an adaptor */
  AbutInterface iface;
  SNES          snes;      /* NULL without pairs */
  AbutEstimator estimator; /* NULL unless asked for */
  AbutAdaptor   adaptor;   /* NULL unless asked for */
  AbutRecorder  recorder;
  PetscInt      start;
  PetscBool     interleave, setupcalled;
  PetscReal     eps_u;

  Vec            x; /* the trace */
  Vec            eta[ABUT_MAX_NAMES];
  PetscInt       cycle, sweepsbefore, unknowns_estimator;
  PetscLogDouble begun, mark, seconds[ABUT_TIMES];
  const char    *verdict;
  PetscInt       status;
};

PETSC_INTERN PetscErrorCode AbutSceneReadNames_Private(AbutScene, AbutOptionItems, const char[], const char[], PetscInt *, char *[]);
PETSC_INTERN PetscErrorCode AbutSceneProbesFromOptions_Private(AbutScene, PetscInt, char *[]);
PETSC_INTERN PetscErrorCode AbutSceneSolverFromOptions_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutSceneRecord_Private(AbutScene, PetscBool *);
PETSC_INTERN PetscErrorCode AbutSceneRecordTimes_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutScenePrintHeader_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutScenePrintCycle_Private(AbutScene, PetscInt);
PETSC_INTERN PetscErrorCode AbutScenePrintEnd_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutSceneClock_Private(AbutScene, AbutTime);
