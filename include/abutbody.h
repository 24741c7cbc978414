#pragma once

#include <petscksp.h>
#include <abutmesh.h>

/*S
   AbutBody - One elastic body in plane strain: mesh, material, boundary conditions, operator, solver, displacement and stresses

   Level: beginner

   Notes:
   Linear isotropic elasticity, eqs. (1)-(6) of the paper, on cells of order 1 to 4. Its options carry its name: `-lower_mesh_box`,
   `-lower_ksp_type`.

.seealso: `AbutBodyCreate()`, `AbutBodySolve()`, `AbutMesh`, `AbutPair`, `AbutEstimator`
S*/
typedef struct _p_AbutBody *AbutBody;

/* What is known on one component of one side: the traction (zero where nothing is said), the displacement, or the contact condition */
typedef enum {
  ABUT_TRACTION,
  ABUT_DISPLACEMENT,
  ABUT_CONTACT
} AbutConditionType;

PETSC_EXTERN PetscClassId   ABUTBODY_CLASSID;
PETSC_EXTERN PetscErrorCode AbutBodyCreate(MPI_Comm, const char[], AbutBody *);
PETSC_EXTERN PetscErrorCode AbutBodySetMaterial(AbutBody, PetscReal, PetscReal);
PETSC_EXTERN PetscErrorCode AbutBodyGetMaterial(AbutBody, PetscReal *, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutBodySetDisplacement(AbutBody, const char[], PetscInt, AbutPointFunction, void *);
PETSC_EXTERN PetscErrorCode AbutBodySetTraction(AbutBody, const char[], PetscInt, AbutPointFunction, void *);
PETSC_EXTERN PetscErrorCode AbutBodySetContact(AbutBody, PetscInt);
PETSC_EXTERN PetscErrorCode AbutBodyGetCondition(AbutBody, PetscInt, PetscInt, AbutConditionType *);
PETSC_EXTERN PetscErrorCode AbutBodySetLoadFactor(AbutBody, PetscReal);
PETSC_EXTERN PetscErrorCode AbutBodyGetLoadFactor(AbutBody, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutBodySetFromOptions(AbutBody);
PETSC_EXTERN PetscErrorCode AbutBodyCheck(AbutBody);
PETSC_EXTERN PetscErrorCode AbutBodySetUp(AbutBody);
PETSC_EXTERN PetscErrorCode AbutBodyView(AbutBody, PetscViewer);
PETSC_EXTERN PetscErrorCode AbutBodyDestroy(AbutBody *);

PETSC_EXTERN PetscErrorCode AbutBodyGetName(AbutBody, const char *[]);
PETSC_EXTERN PetscErrorCode AbutBodyGetMesh(AbutBody, AbutMesh *);
PETSC_EXTERN PetscErrorCode AbutBodyGetKSP(AbutBody, KSP *);
PETSC_EXTERN PetscErrorCode AbutBodyIsDirect(AbutBody, PetscBool *);
PETSC_EXTERN PetscErrorCode AbutBodyGetSize(AbutBody, PetscInt *);
PETSC_EXTERN PetscErrorCode AbutBodyGetIntegration(AbutBody, const char *[], PetscBool *);
PETSC_EXTERN PetscErrorCode AbutBodyViewIntegration(AbutBody, PetscViewer);
PETSC_EXTERN PetscErrorCode AbutBodyGetHeight(AbutBody, const PetscReal[2], PetscReal *);
PETSC_EXTERN PetscErrorCode AbutBodyCreateVec(AbutBody, Vec *);
PETSC_EXTERN PetscErrorCode AbutBodyCreateCellVec(AbutBody, Vec *);

/* Rigid motions that no prescribed displacement resists, 0 to 3: in words and at points by box and conditions, as vectors on a mesh */
PETSC_EXTERN PetscErrorCode AbutBodyGetFreeModeCount(AbutBody, PetscInt *);
PETSC_EXTERN PetscErrorCode AbutBodyGetFreeModeName(AbutBody, PetscInt, char[], size_t);
PETSC_EXTERN PetscErrorCode AbutBodyGetFreeMotion(AbutBody, PetscInt, const PetscReal[2], PetscReal[2]);
PETSC_EXTERN PetscErrorCode AbutBodyGetFreeModes(AbutBody, PetscInt *, const Vec *[]);
PETSC_EXTERN PetscErrorCode AbutBodyGetImbalance(AbutBody, PetscBool, PetscReal[]);

PETSC_EXTERN PetscErrorCode AbutBodyArchive(AbutBody, AbutArchive);

/* Solve with the given nodal contact forces (a vector of AbutBodyCreateVec(), or NULL for none); the displacement stays in the body */
PETSC_EXTERN PetscErrorCode AbutBodySolve(AbutBody, Vec);
PETSC_EXTERN PetscErrorCode AbutBodySolveIncrement(AbutBody, Vec, Vec);
PETSC_EXTERN PetscErrorCode AbutBodyUpdate(AbutBody, Vec, Vec);
PETSC_EXTERN PetscErrorCode AbutBodyMove(AbutBody, const PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutBodyGetSolution(AbutBody, Vec *);
PETSC_EXTERN PetscErrorCode AbutBodyGetSolveCounts(AbutBody, PetscInt *, PetscInt *);
PETSC_EXTERN PetscErrorCode AbutBodyGetNodeDisplacement(AbutBody, const PetscReal *[]);
PETSC_EXTERN PetscErrorCode AbutBodyGetWork(AbutBody, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutBodyGetEnergy(AbutBody, PetscReal *, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutBodyGetReaction(AbutBody, PetscReal[2], PetscReal[2]);
PETSC_EXTERN PetscErrorCode AbutBodyGetLinearResidual(AbutBody, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutBodyGetLinearError(AbutBody, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutBodyGetSetUpCost(AbutBody, PetscReal *, PetscInt *, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutBodyGetLinearCost(AbutBody, PetscReal, PetscReal *);

/* Stress (s11, s22, s12) of the last solve in local cell c at a reference point: [-1,1]^2 for quads, (0,0)(1,0)(0,1) for triangles */
PETSC_EXTERN PetscErrorCode AbutBodyGetCellStress(AbutBody, PetscInt, const PetscReal[2], PetscReal[3]);
PETSC_EXTERN PetscErrorCode AbutBodyGetCellStresses(AbutBody, PetscInt, PetscInt, const PetscReal[], const PetscReal[], PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutBodyGetCellPoint(AbutBody, PetscInt, const PetscReal[2], PetscReal[2], PetscReal *);
PETSC_EXTERN PetscErrorCode AbutBodyGetPointValues(AbutBody, const PetscReal[2], PetscReal[7]);
PETSC_EXTERN PetscErrorCode AbutVonMises(const PetscReal[3], PetscReal, PetscReal *);

/* One side of a body as an ordered list of nodes, the same on all ranks. Nodes follow the boundary with the body on the left; a node of
   a side always carries unknowns (hanging ones never lie on the boundary). */
typedef struct {
  PetscInt   order;  /* of the displacement */
  PetscInt   n;      /* nodes; element i has the nodes order*i to order*(i+1), Gauss-Lobatto points */
  PetscReal *x;      /* [2*n] coordinates */
  PetscReal *normal; /* [2*elements] outward unit normal of each element */
  PetscInt  *global; /* [n] global number of the node, as in AbutMeshTopology */
  PetscBool *fixed;  /* [n] its displacement along the normal is prescribed */
} AbutSide;
PETSC_EXTERN PetscErrorCode AbutBodyGetSide(AbutBody, PetscInt, const AbutSide **);
PETSC_EXTERN PetscErrorCode AbutBodyGetSideTrace(AbutBody, PetscInt, Vec, PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutBodyAddSideForce(AbutBody, PetscInt, const PetscReal[], Vec);
PETSC_EXTERN PetscErrorCode AbutBodyGetFarSide(AbutBody, const PetscReal[2], PetscInt *, AbutConditionType *);
PETSC_EXTERN PetscErrorCode AbutBodyGetSupportDisplacement(AbutBody, const PetscReal[2], const PetscReal[2], PetscReal *, PetscBool *);

/* The whole boundary of a body after a solve, gathered on every rank: eq. (25), each element side on the boundary is one boundary element.
   Element i has the nodes order*i, ..., order*i+order-1, and the first one of the next element of its contour: AbutBoundaryNode(b, i, k),
   k = 0..order, at the Gauss-Lobatto points of the element. Outer contours run counter-clockwise.
   Displacements in the length unit of the scene, tractions in its stress unit, forces in stress times length. */
typedef struct {
  PetscInt           order;
  PetscInt           n, nnodes; /* boundary elements; nodes: order times as many */
  PetscInt           ncontours;
  PetscInt          *contour;   /* [ncontours+1] first element of each contour, then n */
  PetscInt          *next;      /* [n] the next element of the contour; the first one after the last */
  PetscReal         *x;         /* [2*nnodes] nodes */
  PetscReal         *u;         /* [2*nnodes] displacements there */
  PetscInt          *side;      /* [n] side number of the element */
  AbutConditionType *condition; /* [2*n] what is known on the element, per component */
  PetscReal *traction; /* [2*(order+1)*n] given traction, L2 projection: (t1,t2) at the nodes of each element; 0 where none is given */
  PetscReal *reaction; /* [2*nnodes] nodal forces by which prescribed displacements hold the body, K u - f, 0 elsewhere */
  PetscReal *contact;  /* [2*nnodes] nodal contact forces on the body */
} AbutBoundary;
#define AbutBoundaryNode(b, i, k) ((k) < (b)->order ? (b)->order * (i) + (k) : (b)->order * (b)->next[i])
PETSC_EXTERN PetscErrorCode AbutBodyGetBoundary(AbutBody, AbutBoundary **);
PETSC_EXTERN PetscErrorCode AbutBoundaryDestroy(AbutBoundary **);
