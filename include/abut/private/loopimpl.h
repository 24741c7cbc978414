#pragma once

#include <abutloop.h>
#include <petsc/private/snesimpl.h>

/* Values at the nodes of one side, kept while a mesh adapts */
typedef struct {
  PetscInt   n, each; /* nodes; values of each */
  PetscReal *x, *value;
} AbutOldTrace;

/* What an unknown does: a force presses or is open, a tangential force sticks or slips, forwards or backwards */
typedef enum {
  ABUT_SLIPS_BACK = -1,
  ABUT_HOLDS      = 0, /* pressed, or sticks: its equation is solved */
  ABUT_SLIPS      = 1,
  ABUT_OPEN       = 2
} AbutZone;

/* The compliance of the contact nodes, n*n, symmetric: see compliance.c */
typedef struct {
  MPI_Comm    comm;
  PetscMPIInt size, *counts, *first; /* [size], [size+1] columns that each rank computes */
  PetscInt    n, from, to;           /* those of this one */
  PetscBool   shared;                /* it keeps only these, and not all */
  PetscInt    begin, end;            /* columns that it keeps */
  PetscReal  *a;                     /* [n*(end-begin)] */
  PetscInt    nactive;               /* of the last factors */
  PetscReal  *lapack;                /* room for n*n */
  Mat         scalapack;
} *AbutCompliance;

/* Of contact models with friction: unknowns are then contact forces and tangential forces */
typedef struct {
  PetscInt  *normal, *tangent; /* [n] the contact force that bounds a tangential one, and back; -1 if it is none, or there is none */
  PetscReal *mu;               /* [n] of its pair */
  PetscInt  *zone;             /* [n] work */
  PetscReal *spring;           /* [m] what resists free motions beside contact while zones are sought; force over motion */
  PetscInt   nlearned;
  PetscReal *learned[2], *S0; /* [nlearned*n] forces of all sweeps, conjugate, and what they took; [n*n] the model before it learned */
  PetscReal *M;               /* [n*n] work */
} *AbutModelFriction;

/* What the loop knows of the bodies without solving them: nodal contact forces F -> penetrations of the contact nodes of all pairs.
   With F >= 0, S the compliance of all bodies, soft_i = theta/D_i and G the penetrations by free rigid motions:
     F complementary to  b - (S + soft) F + G a,   G'F = e
   With friction F and penetrations of a pair have behind them its tangential forces and slips. */
typedef struct {
  PetscInt          n, m;         /* contact nodes; free motions of all bodies */
  PetscInt         *first, *node; /* [npairs+1] first contact node of each pair; [n] number among the nodes of the pair's pressure side, of
                              tangential forces beyond all of these */
  PetscInt         *normals;      /* [npairs] contact nodes of each pair */
  PetscReal        *D, *soft;     /* [n] nodal lengths; theta/D */
  PetscReal        *open;         /* [n] penetrations of bodies that stand still: minus the gap */
  AbutCompliance    S;            /* at first that of the layers, then corrected by every sweep */
  PetscReal        *G, *e;        /* [m*n] penetrations by unit motions; [m] resultants of the loads along them */
  PetscInt         *owner, *mode; /* [m] whose motion, and its number there */
  PetscReal        *X;            /* [(m+1)*n] work */
  PetscInt          nbodies;      /* once AbutInterfaceComply_Private() has been called */
  Vec              *force, *w;    /* [nbodies] of its last call: nodal forces on the bodies, displacements they make */
  PetscReal        *b;            /* [n] work */
  PetscInt         *active;       /* [n] work */
  AbutModelFriction friction;     /* NULL: no pair has any */
} *AbutContactModel;

/* A block of the modes of side t = 2*pair+side: K v = xi^2 D v on its nodes, with the one-dimensional stiffness K, natural ends, lumped
   lengths D and V'DV = I */
typedef struct {
  PetscInt   all;   /* modes of the side: nodes whose normal displacement is not prescribed */
  PetscInt   n;     /* of the block; blocks of a rank begin at the same mode on all sides */
  PetscInt   first; /* first contact node of the pair, and how many */
  PetscInt   rows;
  PetscReal *xi; /* [n] ascending; behind them */
  PetscReal *W;  /* [rows*n] by columns: penetrations of the pair's contact nodes when the side takes the shape of a mode */
  PetscReal  length;
} AbutModes;

#define ABUT_MODEL_SHARE 1000 /* contact nodes above which the ranks share the contact model's matrix */

struct _p_AbutInterface {
  PETSCHEADER(int);
  PetscInt  nbodies, npairs;
  AbutBody *body;
  AbutPair *pair;
  PetscInt *bodyof; /* [2*npairs] number of the body of side t = 2*pair+side, -1 for a rigid obstacle */

  /* of the present meshes; index t = 2*pair+side */
  PetscBool        setupcalled;
  PetscInt        *offset; /* [2*npairs+1] where each side's values begin among all */
  PetscInt         nowned; /* values owned by this rank, each by the owner of its node */
  PetscInt        *owned;  /* [nowned] their places among all */
  PetscInt        *place;  /* [all] the place of the k-th value in the order of the ranks */
  VecScatter       toall;
  Vec              everywhere;
  PetscInt         share;     /* contact nodes above which the ranks share the contact model's matrix */
  PetscReal        gamma;     /* the user's relaxation, 0 for the automatic one */
  PetscBool        spectrum;  /* the automatic one from computed eigenvalues */
  PetscReal        largest;   /* eigenvalue of I - dG, computed on these meshes; 0 not yet */
  PetscReal       *x, *g;     /* [all] the trace of the last sweep and its image, on every rank */
  PetscReal       *xbest;     /* [all] the trace of least residual since the set-up */
  PetscReal      **p;         /* [npairs] the pressures of the last sweep */
  PetscReal      **guess;     /* [npairs] those that the contact model gave before any sweep */
  Vec             *force, *u; /* [nbodies] nodal contact forces; displacements, the bodies' own */
  PetscBool        acts;      /* p acts in the bodies as they are, and g holds their traces */
  AbutContactModel model;     /* made when first asked for */

  Vec              G;  /* image of the trace of the last sweep */
  PetscObjectId    id; /* of that trace vector, and its state then: a second look at the same point is no sweep */
  PetscObjectState state;
  PetscInt         sweeps, startsweeps;
  PetscReal        residual, pressureresidual; /* |G-x|/|G| and the same of the pressures, of the last sweep */
  PetscBool        linearfailed;
  PetscReal        residualbest;
  PetscReal        fnorm;         /* of F at the first iterate */
  PetscReal        level[2];      /* mean of the logarithm of the norm of F in the present window of iterations, and in the one before */
  PetscReal        rate;          /* what the solver's slowest mode loses in an iteration, 0 unknown */
  const char      *failure;       /* why the stop test gave up, in one word */
  char             floating[256]; /* the body that contact does not hold, and its motion */
  AbutOldTrace    *old;           /* [2*npairs] traces */
  AbutOldTrace    *oldpressure;   /* [npairs] pressures less the guess, along the first side: what the model did not know */
  PetscBool        guessed, warm; /* guess belongs to the present meshes; oldpressure is there */
};

PETSC_INTERN PetscErrorCode SNESCreate_DDNeumann(SNES);
PETSC_INTERN PetscErrorCode SNESCreate_DDActive(SNES);

/* What is PETSC_EXTERN here is so for the unit tests */

/* sweep.c: pressures -> nodal forces on the bodies; their displacements -> traces; both with one solve per body between */
PETSC_INTERN PetscErrorCode AbutInterfaceForces_Private(AbutInterface, PetscReal *const[], Vec[]);
PETSC_INTERN PetscErrorCode AbutInterfaceTraces_Private(AbutInterface, const Vec[], PetscReal[]);
PETSC_INTERN PetscErrorCode AbutInterfaceSolveBodies_Private(AbutInterface);
PETSC_INTERN PetscErrorCode AbutInterfaceIncrement_Private(AbutInterface, PetscReal *const[], Vec[], Vec[], PetscReal[]);

PETSC_INTERN PetscErrorCode AbutInterfaceSetFloating_Private(AbutInterface, PetscInt, PetscInt);
PETSC_INTERN PetscErrorCode AbutInterfaceTransferPressure_Private(AbutInterface);
PETSC_INTERN PetscErrorCode AbutInterfaceReplicate_Private(AbutInterface, Vec, PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutInterfaceLocalize_Private(AbutInterface, const PetscReal[], Vec);

/* gamma.c; spectrum.c: the only file that knows SLEPc, or that it is missing */
PETSC_INTERN PetscErrorCode AbutInterfaceSetMixing_Private(AbutInterface, SNES);
PETSC_INTERN PetscErrorCode AbutInterfaceCheckSpectrum_Private(AbutInterface);
PETSC_INTERN PetscErrorCode AbutInterfaceComputeSpectrum_Private(AbutInterface, PetscReal *);

/* compliance.c, factor.c */
PETSC_EXTERN PetscErrorCode AbutComplianceCreate_Private(MPI_Comm, PetscInt, PetscInt, AbutCompliance *);
PETSC_EXTERN PetscErrorCode AbutComplianceDestroy_Private(AbutCompliance *);
PETSC_EXTERN PetscReal     *AbutComplianceGetColumns_Private(AbutCompliance, PetscInt *, PetscInt *);
PETSC_EXTERN PetscErrorCode AbutComplianceAssemble_Private(AbutCompliance);
PETSC_INTERN PetscErrorCode AbutComplianceAgree_Private(AbutCompliance, PetscInt, MPI_Datatype, void *);
PETSC_EXTERN PetscErrorCode AbutComplianceMult_Private(AbutCompliance, const PetscReal[], PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutComplianceAdd_Private(AbutCompliance, PetscInt, const PetscReal[], const PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutComplianceGetDiagonal_Private(AbutCompliance, PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutComplianceFactor_Private(AbutCompliance, PetscInt, const PetscInt[], const PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutComplianceSolve_Private(AbutCompliance, PetscInt, PetscReal[]);
PETSC_INTERN PetscErrorCode AbutComplianceFreeFactor_Private(AbutCompliance);

/* waves.c */
PETSC_INTERN PetscErrorCode AbutModesCount_Private(AbutInterface, PetscInt *);
PETSC_INTERN PetscErrorCode AbutModesCreate_Private(AbutInterface, AbutContactModel, AbutModes[]);
PETSC_INTERN PetscErrorCode AbutModesPass_Private(AbutInterface, PetscMPIInt, AbutModes[]);
PETSC_INTERN PetscErrorCode AbutModesDestroy_Private(AbutInterface, AbutModes[]);

/* layers.c, model.c, programme.c: the contact model */
PETSC_EXTERN PetscErrorCode AbutInterfaceGetModel_Private(AbutInterface, AbutContactModel *);
PETSC_INTERN PetscErrorCode AbutInterfaceLayers_Private(AbutInterface, AbutContactModel);
PETSC_INTERN PetscErrorCode AbutInterfacePenetration_Private(AbutInterface, AbutContactModel, const PetscReal[], PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutInterfaceComply_Private(AbutInterface, AbutContactModel, const PetscReal[], PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutContactModelLearn_Private(AbutContactModel, const PetscReal[], const PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutContactModelSolve_Private(AbutContactModel, const PetscReal[], const PetscReal[], PetscReal[], PetscReal[],
                                                          PetscInt *, PetscBool *);
PETSC_INTERN PetscErrorCode AbutContactModelAgree_Private(AbutContactModel, PetscReal[], PetscReal[], PetscInt *, PetscBool *);
PETSC_INTERN void           AbutContactModelPressures_Private(const AbutContactModel, PetscInt, const PetscReal[], PetscReal *const[]);
PETSC_INTERN void           AbutContactModelForces_Private(const AbutContactModel, PetscInt, PetscReal *const[], PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutContactModelEnergy_Private(AbutContactModel, const PetscReal[], const PetscReal[], PetscReal *);
PETSC_INTERN PetscErrorCode AbutContactModelOpen_Private(AbutInterface, AbutContactModel);
/* friction.c, coulomb.c: only with friction, but for the first two */
PETSC_INTERN PetscErrorCode AbutContactModelFriction_Private(AbutInterface, AbutContactModel);
PETSC_INTERN PetscErrorCode AbutModelFrictionDestroy_Private(AbutModelFriction *);
PETSC_INTERN PetscErrorCode AbutContactModelSolveFriction_Private(AbutContactModel, const PetscReal[], const PetscReal[], PetscReal[],
                                                                  PetscReal[], PetscInt *, PetscBool *);
PETSC_INTERN PetscReal AbutContactModelFrictionStep_Private(const AbutContactModel, const PetscReal[], const PetscReal[], const PetscReal[],
                                                            const PetscReal[]);
PETSC_INTERN void      AbutContactModelFrictionAdd_Private(const AbutContactModel, PetscReal, const PetscReal[], PetscReal[]);
PETSC_INTERN PetscErrorCode AbutContactModelLearnFriction_Private(AbutContactModel, const PetscReal[], const PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutContactModelDestroy_Private(AbutContactModel *);
PETSC_EXTERN PetscLogEvent  ABUTINTERFACE_Sweep;
