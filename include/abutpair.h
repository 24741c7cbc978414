#pragma once

#include <abutbody.h>

/*S
   AbutPair - One possible contact of two sides of two bodies: gap, common refinement, dual-mortar weights, penalty law, KKT residuals

   Level: intermediate

   Notes:
   Contact conditions (7)-(10) of the paper in the penalty form (15)-(16): p = max(0, u_n1 + u_n2 - f)/theta. Pressures are nodal values on
   one of the sides (`-mid_pair_pressure_side`), tested with the biorthogonal (dual) basis; all integrals are taken on the common refinement
   of both sides.

.seealso: `AbutPairCreate()`, `AbutBody`, `AbutInterface`
S*/
typedef struct _p_AbutPair *AbutPair;

/* The state of a pair for given traces; the same on all ranks. Forces per unit thickness (stress times length), lengths in the scene's
   unit */
typedef struct {
  PetscReal force;                      /* integral of p */
  PetscReal pressure_max, pressure_min; /* of the nodal values; of AbutPairRecoverPressure() from order 2 */
  PetscBool consistent;                 /* they are of AbutPairRecoverPressure() */
  PetscReal contact_length;             /* sum of the nodal lengths D_i over active nodes */
  PetscReal contact_edge;               /* from the closed end of the shared part, else half the contact's width: see AbutPairGetEdges() */
  PetscReal penetration_max;            /* of the averaged nodal penetration */
  PetscReal complementarity; /* largest p_i*|p_i*theta - penetration_i| over p_max times what two layers and theta give under p_max */
  PetscReal excess;          /* largest penetration beyond p_i*theta, over what two layers and theta give under p_max */
  PetscReal balance;         /* |sum of forces on both sides| / force */
  PetscReal energy;          /* J_theta, eq. (15) */
  PetscInt  active, nodes;
  /* of pairs with friction, else 0 */
  PetscReal tangential;   /* integral of the tangential tractions: what the first side pulls the second along its tangent */
  PetscReal slip_max;     /* at closed nodes, since the last load step */
  PetscReal stick_length; /* sum of D_i over the closed nodes whose traction is below mu p */
  PetscReal friction; /* by how much tractions exceed mu p, or slip is not theirs: over p_max times what layers and theta give under it */
} AbutPairState;

PETSC_EXTERN PetscClassId   ABUTPAIR_CLASSID;
PETSC_EXTERN PetscErrorCode AbutPairCreate(MPI_Comm, const char[], AbutPair *);
PETSC_EXTERN PetscErrorCode AbutPairSetFromOptions(AbutPair, PetscInt, AbutBody[]);
PETSC_EXTERN PetscErrorCode AbutPairCheck(AbutPair);
PETSC_EXTERN PetscErrorCode AbutPairSetUp(AbutPair);
PETSC_EXTERN PetscErrorCode AbutPairView(AbutPair, PetscViewer);
PETSC_EXTERN PetscErrorCode AbutPairDestroy(AbutPair *);
PETSC_EXTERN PetscErrorCode AbutPairGetName(AbutPair, const char *[]);
PETSC_EXTERN PetscErrorCode AbutPairGetBodies(AbutPair, AbutBody[2], PetscInt[2]);
PETSC_EXTERN PetscErrorCode AbutPairSetTheta(AbutPair, PetscReal);
PETSC_EXTERN PetscErrorCode AbutPairGetTheta(AbutPair, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutPairGetCompliance(AbutPair, PetscReal[2]);
PETSC_EXTERN PetscErrorCode AbutPairGetFriction(AbutPair, PetscBool *, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutPairGetShearCompliance(AbutPair, PetscReal[2]);
PETSC_EXTERN PetscErrorCode AbutPairKeepSlip(AbutPair, const PetscReal[], const PetscReal[], const PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutPairArchiveSlip(AbutPair, AbutArchive);
PETSC_EXTERN PetscErrorCode AbutPairGetSharedPoints(AbutPair, PetscInt *, PetscReal *[]);
PETSC_EXTERN PetscErrorCode AbutPairGetSizes(AbutPair, PetscInt[2]);
PETSC_EXTERN PetscErrorCode AbutPairGetComponents(AbutPair, PetscInt *);

/* Traces at the nodes of the two sides (as ordered in AbutSide) -> nodal pressures; nodal pressures -> nodal forces on both sides. They
   have AbutPairGetComponents() values a node: 1, along the outward normal, if the sides are straight, otherwise 2. With friction they have
   2, and behind the pressures are as many tangential tractions. */
PETSC_EXTERN PetscErrorCode AbutPairComputePenetration(AbutPair, const PetscReal[], const PetscReal[], PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutPairComputeSlip(AbutPair, const PetscReal[], const PetscReal[], PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutPairComputePressure(AbutPair, const PetscReal[], const PetscReal[], PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutPairComputeForce(AbutPair, const PetscReal[], PetscReal[], PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutPairComputeSupport(AbutPair, PetscReal[], PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutPairComputeWinkler(AbutPair, PetscReal[], PetscReal[], PetscBool *);
PETSC_EXTERN PetscErrorCode AbutPairGetGap(AbutPair, const PetscReal[2], PetscReal *);
PETSC_EXTERN PetscErrorCode AbutPairGetNodeGap(AbutPair, PetscInt, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutPairSetNormalTrace(AbutPair, PetscInt, const PetscReal[], PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutPairGetOverlap(AbutPair, PetscReal *, PetscReal[2]);
PETSC_EXTERN PetscErrorCode AbutPairGetPressureNodes(AbutPair, PetscInt *, PetscInt *, const PetscReal *[], const PetscReal *[]);
PETSC_EXTERN PetscErrorCode AbutPairRecoverPressure(AbutPair, const PetscReal[], PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutPairGetState(AbutPair, const PetscReal[], const PetscReal[], const PetscReal[], AbutPairState *);
/* An element of the pressure side that holds the largest pressure */
typedef struct {
  PetscReal x[2];   /* where the pressure is largest on it */
  PetscReal length; /* of the element */
  PetscReal part;   /* this length over that of the contact, the sum of D_i over active nodes */
  PetscReal last;   /* coefficient of the pressure on it, relative to the largest pressure of the pair: see AbutPairGetPeaks() */
} AbutPeak;
PETSC_EXTERN PetscErrorCode AbutPairGetPeaks(AbutPair, const PetscReal[], PetscReal, PetscInt, PetscInt *, AbutPeak[]);
PETSC_EXTERN PetscErrorCode AbutPairGetEdges(AbutPair, const PetscReal[], const PetscReal[], const PetscReal[], PetscInt, PetscInt *,
                                             PetscReal[][2]);
