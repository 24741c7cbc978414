#pragma once

#include <petscdmplex.h>
#include <abutsys.h>

/*S
   AbutMesh - The mesh of one body: a `DMPLEX`, its named sides, its levels, and how it is refined

   Level: intermediate

   Notes:
   Quadrilaterals are held by a p4est quadtree forest (refinement, 2:1 balance across sides, partition) and converted to a `DMPLEX` with a
   tree; triangles are a `DMPLEX` refined by `DMPLEXREFINESBR`. Every cell is on exactly one rank (no overlap); a rank may be without cells.

.seealso: `AbutMeshCreate()`, `AbutMeshAdapt()`, `AbutMeshGetTopology()`, `AbutBody`
S*/
typedef struct _p_AbutMesh *AbutMesh;

typedef enum {
  ABUT_QUAD,
  ABUT_TRIANGLE
} AbutShape;
PETSC_EXTERN const char *const AbutShapes[];

#define ABUT_LEVEL_MAX 28 /* of a p4est quadtree, one below P4EST_QMAXLEVEL */

/* Plain arrays of the local part of a mesh, valid until the mesh adapts or is destroyed.
   Vertices are counted 0..nvertices-1 in the order of the DMPLEX; lengths in the unit of the scene. */
typedef struct {
  PetscInt         ncells, nvertices;
  PetscInt         corners;    /* of a cell: 4 or 3 */
  const PetscInt  *cell;       /* [corners*ncells] local vertices of each cell, counter-clockwise */
  const PetscInt  *level;      /* [ncells] refinement level, 0 in the first mesh */
  const PetscReal *x;          /* [2*nvertices] coordinates */
  const PetscInt  *anchor;     /* [2*nvertices] the two ends of the coarse side on which a hanging vertex is the middle, or -1,-1 */
  PetscInt         nunknown;   /* vertices that carry unknowns on this rank, owned ones first */
  PetscInt         nowned;     /* of these, owned by this rank */
  PetscInt         firstowned; /* global number of the first owned one */
  PetscInt         nglobal;    /* over all ranks */
  const PetscInt  *unknown;    /* [nvertices] index in 0..nunknown-1, -1 for a hanging vertex */
  const PetscInt  *global;     /* [nunknown] global number of the vertex; its displacement unknowns are 2*global and 2*global+1 */
  PetscInt         nsideedges; /* element sides on the boundary of the body, of local cells */
  const PetscInt  *sideedge;   /* [3*nsideedges] start vertex, end vertex (body on the left), side number */
  const PetscInt  *sidecell;   /* [nsideedges] the cell */
} AbutMeshTopology;

PETSC_EXTERN PetscClassId   ABUTMESH_CLASSID;
PETSC_EXTERN PetscErrorCode AbutMeshCreate(MPI_Comm, AbutMesh *);
PETSC_EXTERN PetscErrorCode AbutMeshSetBox(AbutMesh, const PetscReal[2], const PetscReal[2], const PetscInt[2], AbutShape);
PETSC_EXTERN PetscErrorCode AbutMeshSetFromOptions(AbutMesh);
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
PETSC_EXTERN PetscErrorCode AbutMeshAdapt(AbutMesh, const PetscBool[]);
PETSC_EXTERN PetscErrorCode AbutMeshGetGeneration(AbutMesh, PetscInt *);

/* Shape functions N[corners], their gradients G[2*corners] (1/length) and the Jacobian determinant of local cell c at a reference point:
   [-1,1]^2 for quads, (0,0)(1,0)(0,1) for triangles. The inverse map says whether the point lies in the cell (or on its border). */
PETSC_EXTERN PetscErrorCode AbutMeshMapCell(AbutMesh, PetscInt, const PetscReal[2], PetscReal[2], PetscReal[], PetscReal[], PetscReal *);
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
