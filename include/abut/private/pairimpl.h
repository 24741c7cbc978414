#pragma once

#include <abutpair.h>
#include <petsc/private/petscimpl.h>

typedef enum {
  ABUT_PRESSURE_FIRST,
  ABUT_PRESSURE_SECOND,
  ABUT_PRESSURE_FINER
} AbutPressureSide;

/* A piece of the common refinement: one element of each side, and M[s][i][k] = integral of psi_i phi_k, psi_i the dual function of node
   i of the pressure side's element, phi_k the function of node k of the element of side s: s = 0 the pressure side, s = 1 the other one */
typedef struct {
  PetscInt  element[2];
  PetscReal M[2][ABUT_SIDE_NODES_MAX][ABUT_SIDE_NODES_MAX];
} AbutSegment;

struct _p_AbutPair {
  PETSCHEADER(int);
  AbutBody         body[2];
  PetscInt         side[2];
  AbutExpression   gap; /* NULL: the distance of the sides */
  PetscReal        penalty, theta, height;
  PetscBool        thetaset;
  AbutPressureSide pressureside;

  /* of the present meshes */
  PetscInt        generation[2];
  PetscInt        which;    /* the side that carries the pressures */
  PetscInt        n[2];     /* nodes of both sides */
  PetscInt        order[2]; /* of the displacements of the pressure side, and of the other one */
  PetscInt        nsegments, room;
  AbutSegment    *segment;
  PetscReal       overlap[2]; /* the part of the pressure side that the other one faces: distances from its first node */
  PetscReal      *D, *F;      /* [n[which]] integrals of psi_i and of psi_i times the gap; D = 0: the node carries no pressure */
  PetscReal      *work;       /* [n[which]] */
  const AbutSide *nodes[2];
};

PETSC_INTERN PetscErrorCode AbutPairCheckFacing_Private(AbutPair);
PETSC_INTERN PetscErrorCode AbutPairGetDistance_Private(AbutPair, PetscReal *);
PETSC_INTERN PetscReal      AbutPairPlace_Private(AbutPair, PetscInt);
PETSC_INTERN PetscErrorCode AbutPairGetReading_Private(AbutPair, const PetscReal[], PetscReal[]);
PETSC_INTERN PetscErrorCode AbutPairGetLargest_Private(AbutPair, const PetscReal[], PetscReal *);
PETSC_INTERN PetscBool      AbutPairEdgeBeyond_Private(AbutPair, const PetscReal[], const PetscReal[], PetscInt, PetscInt, PetscReal *);
PETSC_INTERN PetscErrorCode AbutPairMortar_Private(AbutPair);
PETSC_INTERN PetscErrorCode AbutPairMortarReset_Private(AbutPair);
