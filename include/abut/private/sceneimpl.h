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

/* An end of a contact that is not the end of a side */
typedef struct {
  PetscInt  pair;
  AbutBody  body[2]; /* of the pair */
  PetscInt  side[2];
  PetscReal x[2];
} AbutContactEdge;

#define ABUT_TOUCH 1e-6 /* of the length of an element: what is that near touches it */

/* Of -adaptor_peak, what the loop may leave on a mesh, so that its noise hides no peak on elements of a tenth of the contact:
   see peaks.c */
#define ABUT_SHARE_PEAK 0.003

/* Where the seconds of a run went */
typedef enum {
  ABUT_TIME_SETUP,
  ABUT_TIME_SOLVE,
  ABUT_TIME_ESTIMATE,
  ABUT_TIME_ADAPT,
  ABUT_TIME_OUTPUT,
  ABUT_TIMES
} AbutTime;

/* What a run checks of itself, see check.c; all relative */
typedef enum {
  ABUT_CHECK_BALANCE, /* reactions against loads and contact forces, of every body */
  ABUT_CHECK_ENERGY,  /* twice the strain energy against the work */
  ABUT_CHECK_LINEAR,  /* true residual of the linear problems */
  ABUT_CHECK_CONTACT, /* the forces of a pair on its two bodies; those from here on need pairs */
  ABUT_CHECK_TENSION, /* contact that pulls */
  ABUT_CHECK_COMPLEMENTARITY,
  ABUT_CHECK_PENETRATION, /* beyond what the penalty lets in */
  ABUT_CHECK_FRICTION,    /* the law of friction; only where a pair has it */
  ABUT_CHECKS
} AbutCheck;

struct _p_AbutScene {
  PETSCHEADER(int);
  PetscInt      nbodies, npairs, nprobes, neffects;
  AbutBody      body[ABUT_MAX_NAMES];
  AbutEffect    effect[ABUT_MAX_NAMES];
  AbutPair      pair[ABUT_MAX_NAMES];
  AbutProbe     probe[ABUT_MAX_NAMES];
  PetscBool     estimates[ABUT_MAX_NAMES]; /* bodies whose error is estimated, and adapted if there is an adaptor */
  AbutInterface iface;
  SNES          snes;      /* NULL without pairs */
  AbutEstimator estimator; /* NULL unless asked for */
  AbutAdaptor   adaptor;   /* NULL unless asked for */
  AbutRecorder  recorder;
  PetscInt      start;
  PetscBool     interleave, split, setupcalled;
  PetscReal     eps_u;
  PetscReal     loop_share;         /* of the estimated error that the loop may leave on a mesh to be refined */
  PetscBool     cold;               /* every mesh begins without what the last one left */
  PetscReal     tol;                /* relative error asked for, 0: not given */
  PetscReal     consistent;         /* what the checks may be */
  PetscReal     check[ABUT_CHECKS]; /* of the present cycle */
  char          wrong[128];         /* the first check that does not hold, in words */

  Vec            x; /* the trace */
  Vec            eta[ABUT_MAX_NAMES];
  PetscInt       cycle, sweepsbefore, unknowns_estimator;
  PetscReal      work; /* sweeps times unknowns */
  PetscLogDouble begun, mark, seconds[ABUT_TIMES];
  PetscBool      wantsratio;
  PetscReal      ratio;          /* processor time of the run over that of one linear problem, 0 where it is not asked for */
  AbutErrors     errors;         /* of the last solve */
  PetscReal      discretisation; /* the same, of the estimated bodies */
  const char    *verdict;
  PetscInt       status;

  char       *checkpoint; /* file, NULL: none */
  PetscInt    every;      /* cycles */
  AbutArchive restart;    /* from which the run goes on, NULL: it begins */

  PetscInt         nsteps, step, first; /* load steps, 0: none is named; the present one from 0, and its first cycle */
  PetscReal       *factor;              /* [nsteps] of all that is prescribed */
  PetscBool        anew;                /* the step begins without what the last one left */
  AbutAdaptVerdict limit;               /* the first one that a step has reached */

  PetscInt         nedges; /* of the last meshes that changed */
  AbutContactEdge *edge;
  PetscBool        settled;              /* the meshes have the cells of the last ones, and moved */
  PetscInt         tied[ABUT_MAX_NAMES]; /* vertices of the meshes that were moved to an edge of each pair */
};

PETSC_INTERN PetscErrorCode AbutSceneReadNames_Private(AbutScene, AbutOptionItems, const char[], const char[], PetscInt *, char *[]);
PETSC_INTERN PetscErrorCode AbutSceneProbesFromOptions_Private(AbutScene, PetscInt, char *[]);
PETSC_INTERN PetscErrorCode AbutSceneSolverFromOptions_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutSceneCheckLoop_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutScenePrintGamma_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutSceneGetUnknowns_Private(AbutScene, PetscInt *);
PETSC_INTERN PetscErrorCode AbutSceneRecord_Private(AbutScene, PetscBool, PetscBool *);
PETSC_INTERN PetscErrorCode AbutSceneRecordTimes_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutSceneRecordRatio_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutSceneWarnOfOverlap_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutScenePrintHeader_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutScenePrintCycle_Private(AbutScene, PetscInt);
PETSC_INTERN PetscErrorCode AbutScenePrintEnd_Private(AbutScene);
/* steps.c */
PETSC_INTERN PetscErrorCode AbutSceneStepsFromOptions_Private(AbutScene, AbutOptionItems);
PETSC_INTERN PetscErrorCode AbutSceneSetLoadFactor_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutSceneRecordStep_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutScenePrintStep_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutSceneEndStep_Private(AbutScene, AbutAdaptVerdict, PetscBool *, PetscBool *);
PETSC_INTERN PetscErrorCode AbutSceneNextStep_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutSceneArchiveStep_Private(AbutScene, AbutArchive);
PETSC_INTERN PetscErrorCode AbutSceneLeaveTrace_Private(AbutScene, PetscBool);
/* split.c */
PETSC_INTERN PetscErrorCode AbutSceneSplitFromOptions_Private(AbutScene, AbutOptionItems);
PETSC_INTERN PetscErrorCode AbutSceneSplit_Private(AbutScene, PetscBool);
/* edges.c */
PETSC_INTERN PetscErrorCode AbutSceneKeepEdges_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutSideTouches_Private(AbutMesh, PetscInt, const PetscReal[2], PetscBool *);
PETSC_INTERN PetscErrorCode AbutSceneSettles_Private(AbutScene, PetscBool *);
PETSC_INTERN PetscErrorCode AbutSceneAdaptBody_Private(AbutScene, AbutBody, const PetscBool[]);
PETSC_INTERN PetscErrorCode AbutSceneFollows_Private(AbutScene, PetscBool *);
PETSC_INTERN PetscErrorCode AbutSceneRecordTies_Private(AbutScene);
/* check.c */
PETSC_INTERN void           AbutSceneAddCheck_Private(AbutScene, AbutCheck, PetscReal);
PETSC_INTERN void           AbutSceneBeginChecks_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutSceneEndChecks_Private(AbutScene, PetscBool, PetscBool *);
/* checkpoint.c */
PETSC_INTERN PetscErrorCode AbutSceneCheckpointFromOptions_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutSceneCheckpoint_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutSceneRestart_Private(AbutScene);
/* peaks.c */
PETSC_INTERN PetscErrorCode AbutSceneMarkPeaks_Private(AbutScene, AbutBody, PetscBool[]);
/* budget.c */
PETSC_INTERN PetscErrorCode AbutSceneGetDiscretisation_Private(AbutScene, PetscReal *, PetscReal[]);
PETSC_INTERN PetscErrorCode AbutSceneRecordBudget_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutScenePrintBudget_Private(AbutScene);
/* tolerance.c */
PETSC_INTERN PetscErrorCode AbutSceneSetTolerance_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutSceneSetLinearTolerance_Private(AbutScene);
PETSC_INTERN PetscReal      AbutSceneLoopTolerance_Private(AbutScene);
PETSC_INTERN PetscErrorCode AbutSceneViewTolerance_Private(AbutScene, PetscViewer);
/* phases.c */
PETSC_INTERN PetscErrorCode AbutScenePhaseBegin_Private(AbutTime);
PETSC_INTERN PetscErrorCode AbutScenePhaseNext_Private(AbutScene, AbutTime, AbutTime);
