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

struct _p_AbutBody {
  PETSCHEADER(int);
  AbutMesh      mesh;
  PetscReal     young, poisson, lambda, mu;
  AbutCondition condition[ABUT_MAX_SIDES][2];
  PetscReal     factor;         /* of all that is prescribed */
  PetscBool     meandilatation; /* in each cell: against locking */

  /* of the present mesh */
  AbutElement   element;     /* what all cells share */
  PetscInt      generation;  /* of the mesh for which the rest was made, -1 if it is to be made anew */
  Mat           A;           /* stiffness, rows and columns of prescribed unknowns replaced by mu on the diagonal */
  Mat           P;           /* what is preconditioned or factored: A, or if modes are free A on springs that resist them */
  Mat           Ac;          /* rows of the stiffness at the prescribed unknowns: for the lift and the reactions */
  IS            constrained; /* owned prescribed unknowns, global numbers */
  Vec           prescribed;  /* their values, laid out like the rows of Ac */
  Vec           load, lift;  /* nodal forces of the tractions; -Ac^T times the prescribed values */
  Vec           contact;     /* nodal contact forces that act */
  Vec           rhs, u;      /* of the last linear solve; u has ghost values */
  PetscInt      nmodes;      /* rigid motions that no prescribed displacement resists */
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

PETSC_INTERN PetscErrorCode AbutBodySetConditionsFromOptions_Private(AbutBody, AbutOptionItems, char[], size_t);
PETSC_INTERN PetscErrorCode AbutBodyConditionsSetUp_Private(AbutBody);
PETSC_INTERN PetscErrorCode AbutBodyLift_Private(AbutBody);
PETSC_INTERN PetscErrorCode AbutBodyEdgeMoments_Private(AbutBody, PetscInt, PetscInt, const PetscReal[2], const PetscReal[2], PetscReal[]);
PETSC_INTERN PetscErrorCode AbutBodyAssemble_Private(AbutBody);
PETSC_INTERN PetscErrorCode AbutElementCreate_Private(AbutMesh, AbutElement *);
PETSC_INTERN PetscErrorCode AbutElementDestroy_Private(AbutElement *);
PETSC_INTERN PetscErrorCode AbutCellStiffness_Private(AbutBody, PetscInt, PetscReal[]);
PETSC_INTERN PetscErrorCode AbutCellDilatation_Private(AbutBody, PetscInt, PetscReal *);
PETSC_INTERN PetscErrorCode AbutBodyCreateSolver_Private(AbutBody);
PETSC_INTERN PetscErrorCode AbutBodyChooseSolver_Private(AbutBody, PetscInt, PetscBool);
PETSC_INTERN PetscErrorCode AbutBodyGiveFactorRoom_Private(AbutBody);
PETSC_INTERN PetscErrorCode AbutBodyReset_Private(AbutBody);
PETSC_INTERN PetscErrorCode AbutBodyNeedSetUp_Private(AbutBody);
PETSC_INTERN PetscErrorCode AbutBodyModesSetUp_Private(AbutBody);
PETSC_INTERN PetscErrorCode AbutBodyModesReset_Private(AbutBody);
PETSC_INTERN PetscErrorCode AbutBodyFactor_Private(AbutBody);
PETSC_INTERN PetscErrorCode AbutBodyRightHandSide_Private(AbutBody, Vec);
PETSC_INTERN PetscErrorCode AbutBodySpread_Private(AbutBody);
PETSC_INTERN PetscErrorCode AbutBodyBoundarySetUp_Private(AbutBody);
PETSC_INTERN PetscErrorCode AbutBodyBoundaryReset_Private(AbutBody);
PETSC_INTERN PetscErrorCode AbutBodyGatherBoundary_Private(AbutBody, Vec, const PetscReal *[]);
PETSC_INTERN PetscErrorCode AbutBodyCreateReaction_Private(AbutBody, Vec *);
PETSC_INTERN PetscErrorCode AbutBodyUngatherBoundary_Private(AbutBody, const PetscReal *[]);
PETSC_EXTERN PetscLogEvent  ABUTBODY_Assemble, ABUTBODY_Solve;
