#pragma once

#include <abutpair.h>
#include <petsc/private/petscimpl.h>

typedef enum {
  ABUT_PRESSURE_FIRST,
  ABUT_PRESSURE_SECOND,
  ABUT_PRESSURE_FINER
} AbutPressureSide;

/* A piece of the common refinement: one element of each side, and M[s][i][k] = integral of psi_i phi_k, psi_i the dual function of node
   i of the pressure side's element, phi_k the function of node k of the element of side s: s = 0 the pressure side, s = 1 the other one.
   Both sides are pressed along the one normal, so that the forces on them balance to round-off. */
typedef struct {
  PetscInt  element[2];
  PetscReal M[2][ABUT_SIDE_NODES_MAX][ABUT_SIDE_NODES_MAX];
} AbutSegment;

/* The same with the components of the outward normal of side s, point by point: [s][d][i][k]. A constant normal would count a part of the
   slip as gap, of first order where elements of two lengths meet. */
typedef PetscReal AbutSegmentVector[2][2][ABUT_SIDE_NODES_MAX][ABUT_SIDE_NODES_MAX];

/* Coulomb friction, of pairs that have it */
typedef struct {
  PetscReal  mu;
  PetscReal *reference; /* [nodes of the pressure side] slips from which slip is counted, on the present meshes */
  PetscInt   n;         /* the same as they were kept, along the first side; 0: never */
  PetscReal *x, *kept;
} *AbutFriction;

struct _p_AbutPair {
  PETSCHEADER(int);
  AbutBody         body[2]; /* the second one NULL: a rigid obstacle */
  PetscInt         side[2];
  AbutExpression   gap;      /* NULL: the distance of the sides */
  AbutExpression   obstacle; /* of a rigid one: its distance, positive where the body may be */
  PetscReal        penalty, theta, height;
  AbutFriction     friction; /* NULL: none */
  PetscBool        thetaset;
  AbutPressureSide pressureside;

  /* of the present meshes */
  PetscInt      generation[2];
  PetscLogEvent event;      /* of the set-up: two bodies, or an obstacle */
  PetscInt      which;      /* the side that carries the pressures */
  PetscInt      n[2];       /* nodes of both sides */
  PetscInt      order[2];   /* of the displacements of the pressure side, and of the other one: -1 if there is none */
  PetscBool     straight;   /* both sides are, and opposite to each other */
  PetscInt      components; /* of a trace at a node: 1 the normal displacement, 2 the vector */
  PetscReal    *place[2];   /* of the nodes of the pressure side, and of the other one, along the former: distances from its first node */
  PetscReal    *direction;  /* [2*(elements+1)] where they are curved: outward at the vertices of the pressure side */
  PetscInt      nsegments, room;
  AbutSegment  *segment;
  AbutSegmentVector *vector;     /* of the segments where traces are vectors, NULL where not */
  PetscReal          overlap[2]; /* the part of the pressure side that the other one faces: distances from its first node */
  PetscReal         *D, *F;      /* [n[which]] integrals of psi_i and of psi_i times the gap; D = 0: the node carries no pressure */
  PetscReal         *length;     /* [n[which]] what D is along the side: D itself, but for bodies of revolution */
  PetscBool          axial;      /* they are: integrals weigh the circumference */
  PetscReal         *work;       /* [n[which]] */
  const AbutSide    *nodes[2];
};

/* What component d of node k on side s, in segment g, adds to the penetration of node i of the pressure side */
static inline PetscReal AbutSegmentWeight_Private(AbutPair pair, PetscInt g, PetscInt s, PetscInt d, PetscInt i, PetscInt k)
{
  return pair->components == 1 ? pair->segment[g].M[s][i][k] : pair->vector[g][s][d][i][k];
}

PETSC_INTERN PetscErrorCode AbutPairCheckFacing_Private(AbutPair);
PETSC_INTERN PetscErrorCode AbutPairCheckTractions_Private(AbutPair);
PETSC_INTERN PetscErrorCode AbutPairGetDistance_Private(AbutPair, PetscReal *);
PETSC_INTERN PetscErrorCode AbutPairObstacleFromOptions_Private(AbutPair);
PETSC_INTERN PetscErrorCode AbutPairCloseGap_Private(AbutPair, const PetscReal[2], PetscReal *);
PETSC_INTERN PetscErrorCode AbutPairObstacleGap_Private(AbutPair, const PetscReal[2], const PetscReal[2], PetscReal *);
/* project.c */
PETSC_INTERN PetscErrorCode AbutPairProject_Private(AbutPair);
PETSC_INTERN PetscErrorCode AbutPairProjectReset_Private(AbutPair);
PETSC_INTERN PetscErrorCode AbutPairFace_Private(AbutPair, const PetscInt[2], PetscReal, PetscReal[2], PetscReal[2], PetscReal *);
PETSC_INTERN void           AbutPairPointAt_Private(AbutPair, PetscReal, PetscReal[2]);
PETSC_INTERN PetscErrorCode AbutPairGetReading_Private(AbutPair, const PetscReal[], PetscReal[]);
PETSC_INTERN PetscErrorCode AbutPairGetLargest_Private(AbutPair, const PetscReal[], PetscReal *);
PETSC_INTERN PetscBool      AbutPairEdgeBeyond_Private(AbutPair, const PetscReal[], const PetscReal[], PetscInt, PetscInt, PetscReal *);
/* friction.c: only for pairs that have it, but for the first two */
PETSC_INTERN PetscErrorCode AbutPairFrictionFromOptions_Private(AbutPair);
PETSC_INTERN PetscErrorCode AbutPairFrictionDestroy_Private(AbutPair);
PETSC_INTERN PetscErrorCode AbutPairFrictionSetUp_Private(AbutPair);
PETSC_INTERN PetscReal      AbutPairWalkTo_Private(PetscInt, const PetscReal[], const PetscReal[2], PetscInt *);
PETSC_INTERN PetscErrorCode AbutPairFrictionLaw_Private(AbutPair, const PetscReal[], const PetscReal[], PetscReal[]);
PETSC_INTERN PetscErrorCode AbutPairFrictionForce_Private(AbutPair, const PetscReal[], PetscReal *const[2]);
PETSC_INTERN PetscErrorCode AbutPairFrictionState_Private(AbutPair, const PetscReal[], const PetscReal[], const PetscReal[], PetscReal,
                                                          AbutPairState *);
PETSC_INTERN PetscErrorCode AbutPairMortar_Private(AbutPair);
PETSC_INTERN PetscErrorCode AbutPairMortarReset_Private(AbutPair);
