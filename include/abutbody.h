#pragma once

#include <petscksp.h>
#include <abutmesh.h>

/*S
   AbutBody - One elastic body: mesh, material, boundary conditions, operator, solver, displacement and stresses

   Level: beginner

   Notes:
   Linear isotropic elasticity, eqs. (1)-(6) of the paper, on cells of order 1 to 4. Its options carry its name: `-lower_mesh_box`,
   `-lower_ksp_type`.

   In plane strain, or as `AbutBodySetKinematics()` says. A body with axial symmetry is a whole turn of its mesh about the axis x = 0: what
   is "stress times length" or "stress times area" below is then a force or an energy, over the whole circumference.

.seealso: `AbutBodyCreate()`, `AbutBodySolve()`, `AbutMesh`, `AbutPair`, `AbutEstimator`
S*/
typedef struct _p_AbutBody *AbutBody;

/* What is known on one component of one side: the traction (zero where nothing is said), the displacement, or the contact condition */
typedef enum {
  ABUT_TRACTION,
  ABUT_DISPLACEMENT,
  ABUT_CONTACT
} AbutConditionType;

/* What the two coordinates are: a slice of a long body, a thin sheet, or half a section through the axis of a body of revolution */
typedef enum {
  ABUT_PLANE_STRAIN,
  ABUT_PLANE_STRESS,
  ABUT_AXISYMMETRIC
} AbutKinematics;
PETSC_EXTERN const char *const AbutKinematicsNames[];

PETSC_EXTERN PetscClassId   ABUTBODY_CLASSID;
PETSC_EXTERN PetscErrorCode AbutBodyCreate(MPI_Comm, const char[], AbutBody *);
PETSC_EXTERN PetscErrorCode AbutBodySetMaterial(AbutBody, PetscReal, PetscReal);
PETSC_EXTERN PetscErrorCode AbutBodyGetMaterial(AbutBody, PetscReal *, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutBodyGetPlaneMaterial(AbutBody, PetscReal *, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutBodySetKinematics(AbutBody, AbutKinematics);
PETSC_EXTERN PetscErrorCode AbutBodyGetKinematics(AbutBody, AbutKinematics *);
PETSC_EXTERN PetscErrorCode AbutBodyGetThickness(AbutBody, const PetscReal[2], PetscReal *);
PETSC_EXTERN PetscErrorCode AbutBodySetDisplacement(AbutBody, const char[], PetscInt, AbutPointFunction, void *);
PETSC_EXTERN PetscErrorCode AbutBodySetTraction(AbutBody, const char[], PetscInt, AbutPointFunction, void *);
PETSC_EXTERN PetscErrorCode AbutBodySetContact(AbutBody, PetscInt);
PETSC_EXTERN PetscErrorCode AbutBodyGetCondition(AbutBody, PetscInt, PetscInt, AbutConditionType *);
PETSC_EXTERN PetscErrorCode AbutBodySetLoadFactor(AbutBody, PetscReal);
PETSC_EXTERN PetscErrorCode AbutBodyGetLoadFactor(AbutBody, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutBodySetFromOptions(AbutBody);

/* What acts on a body beside its conditions. Each thing has the name of who brought it, for messages, and an event that is logged when it
   acts. It is added before the body is set up, and asked for on each mesh. */
typedef PetscErrorCode (*AbutForceFunction)(const PetscReal x[2], PetscReal force[2], void *ctx);
typedef PetscErrorCode (*AbutTractionFunction)(const PetscReal x[2], const PetscReal normal[2], PetscReal traction[2], void *ctx);
typedef PetscErrorCode (*AbutLoadFunction)(AbutBody, Vec load, void *ctx);
typedef PetscErrorCode (*AbutStrainFunction)(const PetscReal x[2], PetscReal strain[4], void *ctx); /* e11, e22, e12, e33 */
PETSC_EXTERN PetscErrorCode AbutBodyAddForce(AbutBody, const char[], PetscLogEvent, PetscBool, AbutForceFunction, void *);
PETSC_EXTERN PetscErrorCode AbutBodyAddTraction(AbutBody, const char[], PetscLogEvent, PetscInt, AbutTractionFunction, void *);
PETSC_EXTERN PetscErrorCode AbutBodyAddLoad(AbutBody, const char[], PetscLogEvent, AbutLoadFunction, void *);
PETSC_EXTERN PetscErrorCode AbutBodyAddFoundation(AbutBody, const char[], PetscLogEvent, PetscInt, PetscReal, PetscReal);
PETSC_EXTERN PetscErrorCode AbutBodyAddSideOffset(AbutBody, const char[], PetscLogEvent, PetscInt, AbutPointFunction, void *);
PETSC_EXTERN PetscErrorCode AbutBodyAddInitialStrain(AbutBody, const char[], PetscLogEvent, PetscBool, AbutStrainFunction, void *);
PETSC_EXTERN PetscErrorCode AbutBodyGetInitialStrain(AbutBody, const PetscReal[2], PetscReal[4]);
PETSC_EXTERN PetscErrorCode AbutBodyGetForce(AbutBody, const PetscReal[2], PetscReal[2]);
PETSC_EXTERN PetscErrorCode AbutBodyGetFoundation(AbutBody, PetscInt, PetscReal *, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutBodyGetSideOffset(AbutBody, PetscInt, const PetscReal[2], PetscReal *);
PETSC_EXTERN PetscErrorCode AbutBodyHasSideOffset(AbutBody, PetscInt, PetscBool *);

/* What an estimator may have to know of a body; it says which of them it can do, see AbutEstimatorSetFeatures() */
#define ABUT_FEATURE_BODY_FORCE_CONSTANT   0x01
#define ABUT_FEATURE_BODY_FORCE_VARYING    0x02
#define ABUT_FEATURE_FOUNDATION            0x04 /* its tractions are in those of AbutBodyGetBoundary() */
#define ABUT_FEATURE_INITIAL_STRAIN        0x08 /* one that is not linear */
#define ABUT_FEATURE_AXISYMMETRIC          0x10
#define ABUT_FEATURE_PLANE_STRESS          0x20
#define ABUT_FEATURE_LOAD                  0x40 /* nodal forces of which nothing more is known */
#define ABUT_FEATURE_INITIAL_STRAIN_LINEAR 0x80 /* linear in x and y: compatible, see AbutEstimatorGetParticular() */
PETSC_EXTERN PetscErrorCode AbutBodyAddFeature(AbutBody, const char[], PetscInt);
PETSC_EXTERN PetscErrorCode AbutBodyGetFeatures(AbutBody, PetscInt *);
PETSC_EXTERN PetscErrorCode AbutBodyFindFeature(AbutBody, PetscInt, const char *[], const char *[]);
PETSC_EXTERN PetscErrorCode AbutBodyCheck(AbutBody);
PETSC_EXTERN PetscErrorCode AbutBodySetRanks(AbutBody, PetscMPIInt, PetscMPIInt);
PETSC_EXTERN PetscErrorCode AbutBodySetUp(AbutBody);
PETSC_EXTERN PetscErrorCode AbutBodySetUpAll(PetscInt, AbutBody[]);
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
PETSC_EXTERN PetscErrorCode AbutBodyGetSolved(AbutBody, PetscBool *);
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
PETSC_EXTERN PetscErrorCode AbutBodyGetCellStresses3D(AbutBody, PetscInt, PetscInt, const PetscReal[], const PetscReal[], PetscReal[],
                                                      PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutBodyGetCellMeasure(AbutBody, PetscInt, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutBodyGetCellPoint(AbutBody, PetscInt, const PetscReal[2], PetscReal[2], PetscReal *);
PETSC_EXTERN PetscErrorCode AbutBodyGetPointValues(AbutBody, const PetscReal[2], PetscReal[7]);
PETSC_EXTERN PetscErrorCode AbutVonMises(const PetscReal[4], PetscReal *);

/* One side of a body as an ordered list of nodes, the same on all ranks. Nodes follow the boundary with the body on the left; a node of
   a side always carries unknowns (hanging ones never lie on the boundary). */
typedef struct {
  PetscInt   order;    /* of the displacement */
  PetscInt   n;        /* nodes; element i has the nodes order*i to order*(i+1), Gauss-Lobatto points */
  PetscReal *x;        /* [2*n] coordinates */
  PetscReal *normal;   /* [2*elements] outward unit normal of each element */
  PetscBool  straight; /* these are all the same */
  PetscInt  *global;   /* [n] global number of the node, as in AbutMeshTopology */
  PetscBool *fixed;    /* [n] its displacement along the normal is prescribed */
} AbutSide;
PETSC_EXTERN PetscErrorCode AbutBodyGetSide(AbutBody, PetscInt, const AbutSide **);
PETSC_EXTERN PetscErrorCode AbutSideGetNodeNormal(const AbutSide *, PetscInt, PetscReal[2]);
PETSC_EXTERN PetscErrorCode AbutBodyGetSideTrace(AbutBody, PetscInt, PetscInt, Vec, PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutBodyAddSideForce(AbutBody, PetscInt, PetscInt, const PetscReal[], Vec);
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
  PetscReal
    *traction; /* [2*(order+1)*n] given traction, L2 projection, and that of springs under the displacement: (t1,t2) at the nodes of each
                          element; 0 where none is given */
  PetscReal *reaction; /* [2*nnodes] nodal forces by which prescribed displacements hold the body, K u - f, 0 elsewhere */
  PetscReal *contact;  /* [2*nnodes] nodal contact forces on the body */
} AbutBoundary;
#define AbutBoundaryNode(b, i, k) ((k) < (b)->order ? (b)->order * (i) + (k) : (b)->order * (b)->next[i])
PETSC_EXTERN PetscErrorCode AbutBodyGetBoundary(AbutBody, AbutBoundary **);
PETSC_EXTERN PetscErrorCode AbutBoundaryDestroy(AbutBoundary **);
