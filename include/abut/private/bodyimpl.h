#pragma once

#include <abutbody.h>
#include <petsc/private/petscimpl.h>
#include <petsctime.h>

#define ABUT_MAX_SIDES             64
#define ABUT_MAX_MODES             3
#define ABUT_ALMOST_INCOMPRESSIBLE 0.49 /* Poisson's ratio from which quads of order 1 use the mean dilatation of each cell */

/* What the scene says about one component of one side */
typedef struct {
  AbutConditionType type;
  AbutExpression    value; /* NULL: zero traction */
} AbutCondition;

typedef struct _n_AbutElement *AbutElement;

/* What a cell of some kinematics does: plane ones in element.c and stress.c, with axial symmetry in axial.c */
typedef struct {
  PetscErrorCode (*stiffness)(AbutBody, PetscInt, PetscReal[]);
  PetscErrorCode (*dilatation)(AbutBody, PetscInt, PetscReal *); /* mean over the cell, in the last solve */
  PetscErrorCode (*stresses)(AbutBody, PetscInt, PetscInt, const PetscReal[], const PetscReal[], PetscReal[], PetscReal[]);
} AbutCellOps;

/* One thing that acts on a body beside its conditions, see hooks.c */
typedef enum {
  ABUT_HOOK_FEATURE, /* only says that it is there */
  ABUT_HOOK_FORCE,
  ABUT_HOOK_TRACTION,
  ABUT_HOOK_LOAD,
  ABUT_HOOK_FOUNDATION,
  ABUT_HOOK_OFFSET,
  ABUT_HOOK_STRAIN
} AbutHookType;
typedef struct _n_AbutHook *AbutHook;
struct _n_AbutHook {
  AbutHookType  type;
  char         *name; /* of who brought it */
  PetscLogEvent event;
  PetscInt      feature; /* ABUT_FEATURE_..., 0: none */
  PetscInt      side;
  PetscReal     stiffness[2]; /* of a foundation, normal and tangential, stress over length */
  union {
    AbutForceFunction    force;
    AbutTractionFunction traction;
    AbutLoadFunction     load;
    AbutPointFunction    offset;
    AbutStrainFunction   strain;
  } call;
  void    *ctx;
  AbutHook next;
};

struct _p_AbutBody {
  PETSCHEADER(int);
  AbutMesh           mesh;
  AbutKinematics     kinematics;
  const AbutCellOps *cell;
  PetscReal          young, poisson, lambda, mu; /* lambda is that of the plane: another one in plane stress */
  AbutCondition      condition[ABUT_MAX_SIDES][2];
  PetscReal          factor;         /* of all that is prescribed */
  PetscBool          meandilatation; /* in each cell: against locking */
  PetscLogEvent      assembly;       /* the event: another one with the mean dilatation */
  AbutHook           hooks;          /* in the order they came; NULL: none */
  PetscBool          initial;        /* initial strains are among them */
  MPI_Comm           group;          /* the ranks that have the body, or the others, see group.c; that of the body if all have it */
  PetscMPIInt        leader;         /* the first that has it */
  PetscBool          here, split;    /* this rank has it; others have not */

  /* of the present mesh */
  AbutElement   element;       /* what all cells share */
  PetscInt      generation;    /* of the mesh for which the rest was made, -1 if it is to be made anew */
  Mat           A;             /* stiffness, rows and columns of prescribed unknowns replaced by mu on the diagonal */
  Mat           P;             /* what is preconditioned or factored: A, or if modes are free A on springs that resist them */
  Mat           Ac;            /* rows of the stiffness at the prescribed unknowns: for the lift and the reactions */
  Mat           S;             /* stiffness of the foundations, part of A before that; NULL: none */
  IS            constrained;   /* owned prescribed unknowns, global numbers */
  Vec           prescribed;    /* their values, laid out like the rows of Ac */
  Vec           load, lift;    /* nodal forces of tractions and initial strains; -Ac^T times the prescribed values */
  Vec           initialload;   /* those of the initial strains alone, NULL if there are none, ... */
  PetscReal     initialenergy; /* ... and twice the energy if nothing moved */
  Vec           contact;       /* nodal contact forces that act */
  Vec           rhs, u;        /* of the last linear solve, the first in the group; u has ghost values */
  PetscInt      nmodes;        /* rigid motions that no prescribed displacement resists */
  Vec           mode[ABUT_MAX_MODES];
  MatNullSpace  free;   /* the modes, NULL if there are none */
  PetscReal    *nodeu;  /* [2*nnodes] displacement at all local nodes, hanging ones too */
  PetscReal     strain; /* energy of nodeu, once it has been asked for */
  PetscBool     strainknown;
  AbutBoundary *boundary;       /* skeleton: contours, nodes, sides; no values */
  PetscInt     *boundaryglobal; /* [nnodes] global numbers of its nodes */
  VecScatter    toboundary;     /* from a vector of unknowns to [2*nnodes] values on every rank */
  Vec           onboundary;
  AbutSide      side[ABUT_MAX_SIDES];

  KSP       ksp;
  PetscBool userksp; /* the user chose the solver: size does not */
  PetscInt  solves, iterations;
  PetscReal whole;                    /* size of the right-hand side of the last AbutBodySolve() */
  PetscReal assemblytime, factortime; /* seconds, of all meshes */
  PetscInt  assemblycells;
  PetscReal setupcpu; /* processor seconds of AbutBodySetUp() on the present mesh */
};

PETSC_INTERN PetscErrorCode    AbutBodySetConditionsFromOptions_Private(AbutBody, AbutOptionItems, char[], size_t);
PETSC_INTERN PetscErrorCode    AbutBodyConditionsSetUp_Private(AbutBody);
PETSC_INTERN PetscErrorCode    AbutBodyLift_Private(AbutBody);
PETSC_INTERN PetscErrorCode    AbutBodyLoadsSetUp_Private(AbutBody);
PETSC_INTERN PetscErrorCode    AbutBodyEdgeMoments_Private(AbutBody, PetscInt, PetscInt, const PetscReal[2], const PetscReal[2], PetscBool,
                                                           PetscReal[]);
PETSC_INTERN PetscErrorCode    AbutBodySetLame_Private(AbutBody);
PETSC_INTERN PetscErrorCode    AbutBodyCheckKinematics_Private(AbutBody);
PETSC_INTERN PetscBool         AbutBodyOnAxis_Private(AbutBody, const PetscReal[2]);
PETSC_INTERN PetscErrorCode    AbutBodyInitialSetUp_Private(AbutBody);
PETSC_INTERN PetscErrorCode    AbutBodySubtractInitial_Private(AbutBody, PetscInt, PetscInt, const PetscReal[], PetscReal[], PetscReal[]);
PETSC_INTERN PetscErrorCode    AbutBodyInitialWork_Private(AbutBody, PetscReal *);
PETSC_INTERN PetscErrorCode    AbutBodyAssemble_Private(AbutBody);
PETSC_INTERN const AbutCellOps AbutCellOps_Plane, AbutCellOps_Axisymmetric;
PETSC_INTERN PetscErrorCode    AbutCellStresses_Plane(AbutBody, PetscInt, PetscInt, const PetscReal[], const PetscReal[], PetscReal[],
                                                      PetscReal[]);
PETSC_INTERN PetscErrorCode    AbutElementCreate_Private(AbutMesh, PetscInt, AbutElement *);
PETSC_INTERN PetscErrorCode    AbutElementDestroy_Private(AbutElement *);
PETSC_INTERN PetscErrorCode    AbutBodyCreateSolver_Private(AbutBody);
PETSC_INTERN PetscErrorCode    AbutBodyChooseSolver_Private(AbutBody, PetscInt, PetscBool);
PETSC_INTERN PetscErrorCode    AbutBodyGiveFactorRoom_Private(AbutBody);
PETSC_INTERN PetscErrorCode    AbutBodyReset_Private(AbutBody);
PETSC_INTERN PetscErrorCode    AbutBodyNeedSetUp_Private(AbutBody);
PETSC_INTERN PetscErrorCode    AbutBodyModesCreate_Private(AbutBody);
PETSC_INTERN PetscErrorCode    AbutBodyFind_Private(PetscInt, AbutBody[], const char[], AbutBody *, char[], size_t);
PETSC_INTERN PetscErrorCode    AbutBodyModesSetUp_Private(AbutBody);
PETSC_INTERN PetscErrorCode    AbutBodyModesReset_Private(AbutBody);
PETSC_INTERN PetscErrorCode    AbutBodyFactor_Private(AbutBody);
PETSC_INTERN PetscErrorCode    AbutBodyRightHandSide_Private(AbutBody, Vec);
PETSC_INTERN PetscErrorCode    AbutBodySpread_Private(AbutBody);
PETSC_INTERN PetscErrorCode    AbutBodyBoundarySetUp_Private(AbutBody);
PETSC_INTERN PetscErrorCode    AbutBodyBoundaryReset_Private(AbutBody);
PETSC_INTERN PetscErrorCode    AbutBodyGatherBoundary_Private(AbutBody, Vec, const PetscReal *[]);
PETSC_INTERN PetscErrorCode    AbutBodyCreateReaction_Private(AbutBody, Vec *);
PETSC_INTERN PetscErrorCode    AbutBodyUngatherBoundary_Private(AbutBody, const PetscReal *[]);
PETSC_INTERN PetscErrorCode    AbutHooksDestroy_Private(AbutHook *);
/* group.c */
PETSC_INTERN PetscErrorCode AbutBodyLeaveGroup_Private(AbutBody);
PETSC_INTERN PetscErrorCode AbutBodyCreateVecOn_Private(AbutBody, MPI_Comm, Vec *); /* vectors.c */
PETSC_INTERN PetscErrorCode AbutBodyCreateGroupMat_Private(AbutBody, const PetscInt[], const PetscInt[], Mat *);
PETSC_INTERN PetscErrorCode AbutBodyGetGroupVec_Private(AbutBody, Vec, Vec *);
PETSC_INTERN PetscErrorCode AbutBodyRestoreGroupVec_Private(AbutBody, Vec, Vec *);
PETSC_INTERN PetscErrorCode AbutBodyMult_Private(AbutBody, Mat, Vec, Vec);
PETSC_INTERN PetscErrorCode AbutBodyShare_Private(AbutBody, PetscMPIInt, PetscReal[]);
/* forces.c */
PETSC_INTERN PetscErrorCode AbutBodyHookForces_Private(AbutBody);
PETSC_INTERN PetscErrorCode AbutBodyLogHooks_Private(AbutBody, AbutHookType, PetscInt, PetscBool);
PETSC_INTERN PetscBool      AbutBodyHasTraction_Private(AbutBody, PetscInt, PetscInt);
PETSC_INTERN PetscErrorCode AbutBodyHookTraction_Private(AbutBody, PetscInt, const PetscReal[2], const PetscReal[2], PetscReal[2]);
/* side.c */
PETSC_INTERN PetscReal AbutElementNormal_Private(const PetscReal[2], const PetscReal[2], PetscReal[2]);
/* foundation.c */
PETSC_INTERN PetscErrorCode AbutBodyAssembleFoundation_Private(AbutBody);
PETSC_INTERN PetscErrorCode AbutBodyHoldsSide_Private(AbutBody, PetscInt, PetscInt, PetscBool *);
PETSC_INTERN PetscErrorCode AbutBodyGetFoundationForce_Private(AbutBody, PetscReal[2], PetscReal *);
PETSC_INTERN PetscErrorCode AbutBodyAddFoundationTraction_Private(AbutBody, AbutBoundary *);
PETSC_EXTERN PetscLogEvent  ABUTBODY_Assemble, ABUTBODY_Solve;
