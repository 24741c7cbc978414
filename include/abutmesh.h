#pragma once

#include <petscdmplex.h>
#include <abutsys.h>

/*S
   AbutMesh - The mesh of one body: a `DMPLEX`, its named sides, its levels, and how it is refined

   Level: intermediate

   Notes:
   The first mesh is the grid of a box or comes from a gmsh file. Quadrilaterals are held by a p4est quadtree forest (refinement, 2:1
   balance across sides, partition) and converted to a `DMPLEX` with a tree; triangles are a `DMPLEX` refined by `DMPLEXREFINESBR`. Every
   cell is on exactly one rank (no overlap); a rank may be without cells.

.seealso: `AbutMeshCreate()`, `AbutMeshAdapt()`, `AbutMeshGetTopology()`, `AbutBody`
S*/
typedef struct _p_AbutMesh *AbutMesh;

typedef enum {
  ABUT_QUAD,
  ABUT_TRIANGLE
} AbutShape;
PETSC_EXTERN const char *const AbutShapes[];

#define ABUT_LEVEL_MAX 28 /* of a p4est quadtree, one below P4EST_QMAXLEVEL */

#define ABUT_ORDER_MAX      4 /* on quads; 3 on triangles */
#define ABUT_SIDE_NODES_MAX 5 /* of a cell's side, its ends included */
#define ABUT_CELL_NODES_MAX 25
#define ABUT_CELL_ANCHORS_MAX \
  (ABUT_CELL_NODES_MAX + 2 * ABUT_SIDE_NODES_MAX) /* nodes with unknowns that a cell sees: two of its sides hang */

/* Plain arrays of the local part of a mesh, valid until the mesh adapts or is destroyed.
   Vertices are counted 0..nvertices-1 in the order of the DMPLEX; lengths in the unit of the scene.
   Nodes are the points whose displacements make the function: the vertices, with their numbers, then points inside the sides of the cells
   and inside the cells; Gauss-Lobatto points on a side, and their products in a quad. The displacement of a hanging node, on half of a
   coarse side, is that of the coarse side there: a sum over its anchors. In a mesh without balance a coarse side may have divided halves:
   these are sides too, of no cell. */
typedef struct {
  PetscInt         order; /* of the displacement */
  PetscInt         ncells, nvertices, nnodes;
  PetscInt         corners;    /* of a cell: 4 or 3 */
  PetscInt         nodes;      /* of a cell, its corners first, then those of its sides in turn */
  const PetscInt  *cell;       /* [corners*ncells] local vertices of each cell, counter-clockwise */
  const PetscInt  *cellnode;   /* [nodes*ncells] local nodes of each cell */
  const PetscInt  *level;      /* [ncells] refinement level, 0 in the first mesh */
  const PetscReal *x;          /* [2*nnodes] coordinates */
  const PetscInt  *anchors;    /* [nnodes+1] where the anchors of each node begin; a node with unknowns of its own has none */
  const PetscInt  *anchor;     /* [anchors[nnodes]] nodes with unknowns ... */
  const PetscReal *weight;     /* ... and their weights */
  PetscInt         nunknown;   /* nodes that carry unknowns on this rank, owned ones first */
  PetscInt         nowned;     /* of these, owned by this rank */
  PetscInt         firstowned; /* global number of the first owned one */
  PetscInt         nglobal;    /* over all ranks */
  const PetscInt  *unknown;    /* [nnodes] index in 0..nunknown-1, -1 for a hanging node */
  const PetscInt  *global;     /* [nunknown] global number of the node; its displacement unknowns are 2*global and 2*global+1 */
  PetscInt         nedges;     /* sides of the local cells, and coarse sides above hanging ones */
  const PetscInt  *edge;       /* [2*nedges] end vertices, in the same order on all ranks */
  const PetscInt  *edgeparent; /* [2*nedges] the coarse side above a hanging one, and which half of it: 0 has its first vertex; or -1,-1 */
  const PetscInt  *celledge;   /* [corners*ncells] edge from corner k to corner k+1 */
  PetscInt         nsideedges; /* element sides on the boundary of the body, of local cells */
  const PetscInt  *sideedge;   /* [3*nsideedges] start vertex, end vertex (body on the left), side number */
  const PetscInt  *sidenode;   /* [(order+1)*nsideedges] nodes from start to end */
  const PetscInt  *sidecell;   /* [nsideedges] the cell */
} AbutMeshTopology;

PETSC_EXTERN PetscClassId   ABUTMESH_CLASSID;
PETSC_EXTERN PetscErrorCode AbutMeshCreate(MPI_Comm, AbutMesh *);
PETSC_EXTERN PetscErrorCode AbutMeshSetBox(AbutMesh, const PetscReal[2], const PetscReal[2], const PetscInt[2], AbutShape);
PETSC_EXTERN PetscErrorCode AbutMeshSetFile(AbutMesh, const char[], const char[]);
PETSC_EXTERN PetscErrorCode AbutMeshGetFile(AbutMesh, const char *[]);
PETSC_EXTERN PetscErrorCode AbutMeshSetCurve(AbutMesh, PetscInt, const char[], const char[]);
PETSC_EXTERN PetscErrorCode AbutMeshSetFromOptions(AbutMesh);
PETSC_EXTERN PetscErrorCode AbutMeshSetRanks(AbutMesh, PetscMPIInt, PetscMPIInt);
PETSC_EXTERN PetscErrorCode AbutMeshGetRanks(AbutMesh, PetscMPIInt *, PetscMPIInt *);
PETSC_EXTERN PetscErrorCode AbutMeshGetFirstSize(AbutMesh, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutMeshSetUp(AbutMesh);
PETSC_EXTERN PetscErrorCode AbutMeshView(AbutMesh, PetscViewer);
PETSC_EXTERN PetscErrorCode AbutMeshDestroy(AbutMesh *);
PETSC_EXTERN PetscErrorCode AbutMeshGetDM(AbutMesh, DM *);
PETSC_EXTERN PetscErrorCode AbutMeshGetShape(AbutMesh, AbutShape *);
PETSC_EXTERN PetscErrorCode AbutMeshGetBox(AbutMesh, PetscReal[2], PetscReal[2]);
PETSC_EXTERN PetscErrorCode AbutMeshGetTopology(AbutMesh, const AbutMeshTopology **);
PETSC_EXTERN PetscErrorCode AbutMeshGetCellCount(AbutMesh, PetscInt *);
PETSC_EXTERN PetscErrorCode AbutMeshGetSideCount(AbutMesh, PetscInt *);
PETSC_EXTERN PetscErrorCode AbutMeshGetSideName(AbutMesh, PetscInt, const char *[]);
PETSC_EXTERN PetscErrorCode AbutMeshFindSide(AbutMesh, const char[], const char[], PetscInt *);
PETSC_EXTERN PetscErrorCode AbutMeshGetSideEnds(AbutMesh, PetscInt, PetscReal[4], PetscReal[2]);
PETSC_EXTERN PetscErrorCode AbutMeshGetSideSegments(AbutMesh, PetscInt, PetscInt *, const PetscReal *[]);
PETSC_EXTERN PetscErrorCode AbutMeshGetSideDirection(AbutMesh, PetscInt, PetscReal[2]);
PETSC_EXTERN PetscErrorCode AbutMeshGetCurvePoint(AbutMesh, PetscInt, const PetscReal[2], PetscReal[2]);
PETSC_EXTERN PetscErrorCode AbutMeshIsSideStraight(AbutMesh, PetscInt, PetscBool *);
PETSC_EXTERN PetscErrorCode AbutMeshCovers(AbutMesh, const PetscReal[2], PetscBool *);
PETSC_EXTERN PetscErrorCode AbutMeshAdapt(AbutMesh, const PetscBool[]);
PETSC_EXTERN PetscErrorCode AbutMeshSetCoarsening(AbutMesh, const PetscBool[]);
PETSC_EXTERN PetscErrorCode AbutMeshKeepCell(AbutMesh, PetscInt);
PETSC_EXTERN PetscErrorCode AbutMeshGetGeneration(AbutMesh, PetscInt *);
PETSC_EXTERN PetscErrorCode AbutMeshKeepJournal(AbutMesh);
PETSC_EXTERN PetscErrorCode AbutMeshArchive(AbutMesh, AbutArchive);

/* A vertex on a side of the box that is held at a position; positions are the coordinate that runs along the side, length */
typedef struct {
  PetscInt  side;
  PetscReal reference; /* of the vertex, in the mesh without ties */
  PetscReal wanted;
} AbutTie;
PETSC_EXTERN PetscErrorCode AbutMeshSetTies(AbutMesh, PetscInt, const AbutTie[]);
PETSC_EXTERN PetscErrorCode AbutMeshFindTie(AbutMesh, PetscInt, const PetscReal[2], AbutTie *, PetscBool *);

/* Shape functions N[nodes], their gradients G[2*nodes] (1/length) and the Jacobian determinant of local cell c at a reference point:
   [-1,1]^2 for quads, (0,0)(1,0)(0,1) for triangles. The inverse map says whether the point lies in the cell (or on its border). */
PETSC_EXTERN PetscErrorCode AbutMeshMapCell(AbutMesh, PetscInt, const PetscReal[2], PetscReal[2], PetscReal[], PetscReal[], PetscReal *);
PETSC_EXTERN PetscErrorCode AbutMeshMapPoint(AbutMesh, PetscInt, const PetscReal[2], PetscReal[2], PetscReal[4]);
PETSC_EXTERN PetscErrorCode AbutMeshEvaluateBasis(AbutMesh, const PetscReal[2], PetscReal[], PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutMeshGetReferenceNodes(AbutMesh, const PetscReal *[]);
PETSC_EXTERN PetscErrorCode AbutMeshCreateQuadrature(AbutMesh, PetscInt, PetscQuadrature *);
PETSC_EXTERN PetscErrorCode AbutGetLobattoNodes(PetscInt, PetscReal[], PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutGetLobattoMassInverse(PetscInt, PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutEvaluateLobatto(PetscInt, PetscReal, PetscReal[], PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutMeshSumAtEdges(AbutMesh, PetscInt, PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutMeshSumAtVertices(AbutMesh, PetscInt, PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutMeshGetOrder(AbutMesh, PetscInt *);
PETSC_EXTERN PetscErrorCode AbutMeshSetOrder(AbutMesh, PetscInt);
PETSC_EXTERN PetscErrorCode AbutMeshSetBalance(AbutMesh, PetscBool);
PETSC_EXTERN PetscErrorCode AbutMeshGetBalance(AbutMesh, PetscBool *);
PETSC_EXTERN PetscErrorCode AbutMeshGetCellArea(AbutMesh, PetscInt, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutMeshInvertCell(AbutMesh, PetscInt, const PetscReal[2], PetscReal[2], PetscBool *);

/* The paper's measures of a mesh, Definitions 1-3, eq. (22) and Lemma 1; the same on all ranks */
typedef struct {
  PetscReal h_fe;       /* largest upper diameter of the cells */
  PetscReal h_be;       /* largest length of the boundary elements */
  PetscReal h_min;      /* smallest side of a cell */
  PetscReal regularity; /* largest D_e/d_e: upper over lower diameter */
  PetscReal ratio;      /* h_be/h_fe, the constant of eq. (22) */
  PetscBool lemma;      /* a cell of largest upper diameter has a side on the boundary: Lemma 1's hypothesis */
  PetscInt  level_max;
} AbutMeshMeasures;
PETSC_EXTERN PetscErrorCode AbutMeshGetMeasures(AbutMesh, AbutMeshMeasures *);
