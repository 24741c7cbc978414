#pragma once

#include <abutmesh.h>
#include <petsc/private/petscimpl.h>
#include <petscsf.h>

typedef struct _AbutMeshOps *AbutMeshOps;
struct _AbutMeshOps {
  PetscErrorCode (*create)(AbutMesh, DM *);                    /* required: the first mesh of the box */
  PetscErrorCode (*refine)(AbutMesh, const PetscBool[], DM *); /* required: the mesh with the marked cells (and what must follow) split */
  PetscErrorCode (*getlevels)(AbutMesh, PetscInt[]);           /* required: level of each local cell of the current DM */
  PetscErrorCode (*destroy)(AbutMesh);                         /* optional, frees data */
};

#define ABUT_BOX_SIDES 4

struct _p_AbutMesh {
  PETSCHEADER(struct _AbutMeshOps);
  PetscReal        lower[2], upper[2];
  PetscInt         cells[2];
  AbutShape        shape;
  PetscBool        boxset, setupcalled;
  AbutExpression   size; /* wanted length of the cells of the first mesh, NULL: as they are */
  DM               dm;
  PetscInt         generation; /* counts the meshes: 0 is the first */
  AbutMeshTopology topology;
  void            *data;
};

/* Coordinate of the i-th line of the first grid; the last one is the side of the box to the last bit */
static inline PetscReal AbutMeshGridLine_Private(AbutMesh mesh, PetscInt d, PetscInt i)
{
  const PetscReal s = (PetscReal)i / mesh->cells[d];

  return mesh->lower[d] * (1. - s) + mesh->upper[d] * s;
}

PETSC_INTERN PetscErrorCode AbutMeshCreate_Forest(AbutMesh);
PETSC_INTERN PetscErrorCode AbutMeshCreate_Triangles(AbutMesh);
PETSC_INTERN PetscErrorCode AbutMeshRefineToSize_Private(AbutMesh);
PETSC_INTERN PetscErrorCode AbutMeshTopologyBuild_Private(AbutMesh);
PETSC_INTERN PetscErrorCode AbutMeshTopologyReset_Private(AbutMesh);
PETSC_INTERN PetscErrorCode AbutMeshSidesBuild_Private(AbutMesh);
PETSC_EXTERN PetscLogEvent  ABUTMESH_Adapt;
