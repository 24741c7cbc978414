#pragma once

#include <abutmesh.h>
#include <petsc/private/petscimpl.h>
#include <petscsf.h>

typedef struct _AbutMeshOps *AbutMeshOps;
struct _AbutMeshOps {
  PetscErrorCode (*create)(AbutMesh, DM *); /* required: the grid of the box */
  PetscErrorCode (*keepfirst)(AbutMesh);    /* required: the current mesh is the first one, below which nothing is merged */
  /* required: the mesh with the marked cells (and what must follow) split, and others merged; a rank may have no marks. The DM is the
     present one on entry, and stays it if nothing changes. */
  PetscErrorCode (*refine)(AbutMesh, const PetscBool[], DM *);
  PetscErrorCode (*distribute)(AbutMesh, DM *);      /* required: the present mesh, in the DM on entry, to the ranks that are to have it */
  PetscErrorCode (*getlevels)(AbutMesh, PetscInt[]); /* required: level of each local cell of the current DM */
  /* required for a mesh from a file: [corners*ncells] side of the body on which each side of a local cell lies, -1 for none */
  PetscErrorCode (*getsides)(AbutMesh, PetscInt[]);
  PetscErrorCode (*destroy)(AbutMesh); /* optional, frees data */
};

#define ABUT_BOX_SIDES     4
#define ABUT_SIDES_MAX     64 /* of a mesh from a file */
#define ABUT_SIDE_NAME_MAX 64

typedef struct _AbutFirst *AbutFirst; /* see first.h */

typedef struct _AbutMeshStep *AbutMeshStep; /* see journal.c */

/* Lagrange's functions of one order on the reference cell */
typedef struct {
  PetscInt  order, corners, nodes;
  PetscReal xi[2 * ABUT_CELL_NODES_MAX]; /* the nodes */
  PetscInt  row[ABUT_CELL_NODES_MAX];    /* quads: the point of each node on the first coordinate's line, and ... */
  PetscInt  column[ABUT_CELL_NODES_MAX]; /* ... on the second one's */
  PetscReal monomial[10 * 10];           /* triangles: the functions in powers of the coordinates, one a row */
} AbutBasis;

PETSC_INTERN PetscErrorCode AbutBasisSetUp_Private(PetscInt, PetscInt, AbutBasis *);
PETSC_INTERN void           AbutBasisEvaluate_Private(const AbutBasis *, const PetscReal[2], PetscReal[], PetscReal[]);

struct _p_AbutMesh {
  PETSCHEADER(struct _AbutMeshOps);
  PetscReal        lower[2], upper[2]; /* of the box, or around the first mesh of a file */
  PetscInt         cells[2];
  AbutFirst        first; /* the first mesh of a file, NULL: the grid of the box */
  PetscReal        ends[ABUT_BOX_SIDES][4];
  AbutShape        shape;
  PetscInt         order;
  PetscBool        shapeset, setupcalled; /* by a box or a file */
  PetscBool        balance;               /* at most one level between quads with a common side */
  AbutExpression   size;                  /* wanted length of the cells of the first mesh, NULL: as they are */
  PetscMPIInt      firstrank, nranks;     /* that have the cells; 0 for all, see partition.c */
  DM               dm;
  PetscInt         generation; /* counts the meshes: 0 is the first */
  AbutBasis        basis;
  AbutMeshTopology topology;
  PetscInt         nknots[ABUT_BOX_SIDES]; /* of the displacement along each side, see ties.c; 0: none */
  PetscReal       *knot[ABUT_BOX_SIDES];   /* [2*nknots] reference position and displacement */
  PetscBool        tiesmoved;              /* since the topology was made */
  PetscBool       *coarsen;                /* [ncells] cells that the next adaptation may merge, NULL on all ranks: none */
  PetscBool        journal;                /* is kept */
  PetscInt         nsteps, maxsteps;
  AbutMeshStep     step; /* [nsteps] */
  void            *data;
};

/* Coordinate of the i-th line of the first grid; the last one is the side of the box to the last bit */
static inline PetscReal AbutMeshGridLine_Private(AbutMesh mesh, PetscInt d, PetscInt i)
{
  const PetscReal s = (PetscReal)i / mesh->cells[d];

  return mesh->lower[d] * (1. - s) + mesh->upper[d] * s;
}

PETSC_INTERN PetscInt64     AbutMeshShare_Private(AbutMesh, PetscMPIInt, PetscInt64, PetscMPIInt);
PETSC_INTERN PetscErrorCode AbutMeshSetDM_Private(AbutMesh, DM);
PETSC_INTERN PetscErrorCode AbutMeshCreate_Forest(AbutMesh);
PETSC_INTERN PetscErrorCode AbutMeshCreate_Triangles(AbutMesh);
PETSC_INTERN PetscErrorCode AbutMeshRefineToSize_Private(AbutMesh);
PETSC_INTERN PetscErrorCode AbutMeshTopologyBuild_Private(AbutMesh);
PETSC_INTERN PetscErrorCode AbutMeshTopologyReset_Private(AbutMesh);
PETSC_INTERN PetscErrorCode AbutMeshEdgesBuild_Private(AbutMesh);
PETSC_INTERN PetscErrorCode AbutMeshNodesBuild_Private(AbutMesh);
PETSC_INTERN PetscErrorCode AbutMeshMoveToTies_Private(AbutMesh, PetscInt, PetscReal[]);
PETSC_INTERN PetscErrorCode AbutJournalTies_Private(AbutMesh, PetscInt, const AbutTie[]);
PETSC_INTERN PetscErrorCode AbutJournalAdapt_Private(AbutMesh, PetscBool, const PetscBool[]);
PETSC_INTERN PetscErrorCode AbutJournalDestroy_Private(AbutMesh);
PETSC_INTERN PetscErrorCode AbutPointsGather_Private(MPI_Comm, PetscInt, PetscInt, const PetscReal[], PetscInt *, PetscReal **);
PETSC_INTERN int            AbutPointCompare_Private(const void *, const void *);
PETSC_INTERN PetscErrorCode AbutMeshSidesBuild_Private(AbutMesh);
PETSC_INTERN void           AbutMeshGetEdgeNodes_Private(const AbutMeshTopology *, PetscInt, PetscInt, PetscInt[]);
PETSC_EXTERN PetscLogEvent  ABUTMESH_Adapt;
