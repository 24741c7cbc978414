#include <abut/private/meshimpl.h>
#include <petscdmplextransform.h>

/* Triangles: DMPlex, refined by bisection (DMPLEXREFINESBR), which keeps the mesh conforming and its angles bounded */

static PetscErrorCode AbutTrianglesDistribute_Private(DM *dm)
{
  DM          distributed;
  PetscMPIInt size;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)*dm), &size));
  if (size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMPlexDistribute(*dm, 0, NULL, &distributed));
  if (!distributed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMDestroy(dm));
  *dm = distributed;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Every cell of the grid is cut along its rising diagonal; the mesh is made on the first rank and distributed */
static PetscErrorCode AbutMeshCreate_Triangles_DM(AbutMesh mesh, DM *dm)
{
  const PetscInt nx = mesh->cells[0], ny = mesh->cells[1];
  PetscMPIInt    rank;
  PetscInt       nc, nv, *cell, k = 0;
  PetscReal     *xy;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(PetscObjectComm((PetscObject)mesh), &rank));
  nc = rank ? 0 : 2 * nx * ny;
  nv = rank ? 0 : (nx + 1) * (ny + 1);
  PetscCall(PetscMalloc2(3 * nc, &cell, 2 * nv, &xy));
  for (PetscInt v = 0; v < nv; ++v) {
    xy[2 * v]     = AbutMeshGridLine_Private(mesh, 0, v % (nx + 1));
    xy[2 * v + 1] = AbutMeshGridLine_Private(mesh, 1, v / (nx + 1));
  }
  for (PetscInt q = 0; q < nc / 2; ++q) {
    const PetscInt v = q / nx * (nx + 1) + q % nx, corner[6] = {v, v + 1, v + nx + 2, v, v + nx + 2, v + nx + 1};

    for (PetscInt i = 0; i < 6; ++i) cell[k++] = corner[i];
  }
  PetscCall(DMPlexCreateFromCellListPetsc(PetscObjectComm((PetscObject)mesh), 2, nc, nv, 3, PETSC_TRUE, cell, 2, xy, dm));
  PetscCall(PetscFree2(cell, xy));
  PetscCall(AbutTrianglesDistribute_Private(dm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutMeshRefine_Triangles(AbutMesh mesh, const PetscBool marks[], DM *dm)
{
  DMPlexTransform transform;
  DMLabel         active;
  PetscInt        cStart, cEnd;

  PetscFunctionBegin;
  PetscCall(DMLabelCreate(PETSC_COMM_SELF, "adapt", &active));
  PetscCall(DMPlexGetHeightStratum(mesh->dm, 0, &cStart, &cEnd));
  for (PetscInt c = cStart; c < cEnd; ++c)
    if (marks[c - cStart]) PetscCall(DMLabelSetValue(active, c, DM_ADAPT_REFINE));
  PetscCall(DMPlexTransformCreate(PetscObjectComm((PetscObject)mesh), &transform));
  PetscCall(DMPlexTransformSetDM(transform, mesh->dm));
  PetscCall(DMPlexTransformSetType(transform, DMPLEXREFINESBR));
  PetscCall(DMPlexTransformSetActive(transform, active));
  PetscCall(DMPlexTransformSetUp(transform));
  PetscCall(DMPlexTransformApply(transform, mesh->dm, dm));
  PetscCall(DMPlexTransformDestroy(&transform));
  PetscCall(DMLabelDestroy(&active));
  PetscCall(AbutTrianglesDistribute_Private(dm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two bisections halve the sides: the level counts how often the area of a first triangle was quartered, rounded up */
static PetscErrorCode AbutMeshGetLevels_Triangles(AbutMesh mesh, PetscInt level[])
{
  const PetscReal first = 0.5 * (mesh->upper[0] - mesh->lower[0]) * (mesh->upper[1] - mesh->lower[1]) / ((PetscReal)mesh->cells[0] * mesh->cells[1]);
  const PetscReal xi[2] = {1. / 3., 1. / 3.};
  PetscReal       x[2], N[3], G[6], det;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < mesh->topology.ncells; ++c) {
    PetscCall(AbutMeshMapCell(mesh, c, xi, x, N, G, &det));
    level[c] = (PetscInt)PetscCeilReal(0.5 * PetscLog2Real(first / (0.5 * det)) - 0.1);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutMeshCreate_Triangles(AbutMesh mesh)
{
  PetscFunctionBegin;
  mesh->ops->create    = AbutMeshCreate_Triangles_DM;
  mesh->ops->refine    = AbutMeshRefine_Triangles;
  mesh->ops->getlevels = AbutMeshGetLevels_Triangles;
  PetscFunctionReturn(PETSC_SUCCESS);
}
