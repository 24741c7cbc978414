#include "triangles.h"
#include "first.h"

/* Triangles: DMPlex, refined by bisection (DMPLEXREFINESBR), which keeps the mesh conforming and its angles bounded */

#define ABUT_CURVE_BITS 26 /* of each coordinate: both together are exact in a double */

/* Where a point lies on the Z-curve, which p4est follows too: the bits of its two coordinates, interleaved */
static PetscReal AbutTrianglesCurve_Private(AbutMesh mesh, const PetscReal x[2])
{
  const PetscReal size  = PetscMax(mesh->upper[0] - mesh->lower[0], mesh->upper[1] - mesh->lower[1]),
                  steps = (PetscReal)(1 << ABUT_CURVE_BITS);
  PetscReal s[2], at = 0.;

  for (PetscInt d = 0; d < 2; ++d) s[d] = PetscMax(0., PetscMin(PetscFloorReal((x[d] - mesh->lower[d]) / size * steps), steps - 1.));
  for (PetscInt bit = ABUT_CURVE_BITS - 1; bit >= 0; --bit)
    at = 4. * at + 2. * (((PetscInt)s[1] >> bit) & 1) + (((PetscInt)s[0] >> bit) & 1);
  return at;
}

/* How many of n ascending numbers lie below a bound */
static PetscInt AbutTrianglesBelow_Private(PetscInt n, const PetscReal at[], PetscReal bound)
{
  PetscInt low = 0, high = n;

  while (low < high) {
    const PetscInt middle = (low + high) / 2;

    if (at[middle] < bound) low = middle + 1;
    else high = middle;
  }
  return low;
}

/* Cuts the curve into pieces of equally many cells, whose bounds are found by bisection, all at once: count[r] of the n local cells, which
   ascend along the curve, go to rank r */
static PetscErrorCode AbutTrianglesCut_Private(AbutMesh mesh, PetscInt n, const PetscReal at[], PetscInt count[])
{
  MPI_Comm    comm = PetscObjectComm((PetscObject)mesh);
  PetscMPIInt size;
  PetscInt    ncells, *below, *sum;
  PetscReal  *low, *high;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCallMPI(MPI_Allreduce(&n, &ncells, 1, MPIU_INT, MPI_SUM, comm));
  PetscCall(PetscCalloc4(size, &below, size, &sum, size, &low, size, &high));
  for (PetscMPIInt r = 0; r < size; ++r) high[r] = PetscPowReal(4., ABUT_CURVE_BITS);
  for (PetscInt bit = 0; bit <= 2 * ABUT_CURVE_BITS; ++bit) {
    for (PetscMPIInt r = 0; r < size; ++r) below[r] = AbutTrianglesBelow_Private(n, at, PetscFloorReal(0.5 * (low[r] + high[r])));
    PetscCallMPI(MPI_Allreduce(below, sum, size, MPIU_INT, MPI_SUM, comm));
    for (PetscMPIInt r = 0; r < size; ++r) {
      const PetscReal middle = PetscFloorReal(0.5 * (low[r] + high[r]));

      if (low[r] >= high[r]) continue;
      if (sum[r] >= AbutMeshShare_Private(mesh, size, ncells, r + 1)) high[r] = middle; /* rank r has the cells below its bound */
      else low[r] = middle + 1.;
    }
  }
  for (PetscMPIInt r = 0; r < size; ++r) count[r] = AbutTrianglesBelow_Private(n, at, high[r]);
  for (PetscMPIInt r = size - 1; r > 0; --r) count[r] -= count[r - 1];
  PetscCall(PetscFree4(below, sum, low, high));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Graph partitioners draw lots: two runs would not agree to the last bit. The curve does not depend on where the cells were before. */
static PetscErrorCode AbutMeshDistribute_Triangles(AbutMesh mesh, DM *dm)
{
  MPI_Comm         comm = PetscObjectComm((PetscObject)mesh);
  DM               distributed;
  PetscPartitioner part;
  PetscMPIInt      size;
  PetscInt         cStart, cEnd, *cell, *count;
  PetscReal       *at;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  if (size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMPlexGetHeightStratum(*dm, 0, &cStart, &cEnd));
  PetscCall(PetscMalloc3(cEnd - cStart, &at, cEnd - cStart, &cell, size, &count));
  for (PetscInt c = cStart; c < cEnd; ++c) {
    PetscReal center[2];

    PetscCall(DMPlexComputeCellGeometryFVM(*dm, c, NULL, center, NULL));
    at[c - cStart]   = AbutTrianglesCurve_Private(mesh, center);
    cell[c - cStart] = c - cStart;
  }
  PetscCall(PetscSortRealWithArrayInt(cEnd - cStart, at, cell));
  PetscCall(AbutTrianglesCut_Private(mesh, cEnd - cStart, at, count));
  PetscCall(PetscPartitionerCreate(comm, &part));
  PetscCall(PetscPartitionerSetType(part, PETSCPARTITIONERSHELL));
  PetscCall(PetscPartitionerShellSetPartition(part, size, count, cell));
  PetscCall(DMPlexSetPartitioner(*dm, part));
  PetscCall(PetscPartitionerDestroy(&part));
  PetscCall(PetscFree3(at, cell, count));
  PetscCall(DMPlexDistribute(*dm, 0, NULL, &distributed));
  if (!distributed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMDestroy(dm));
  *dm = distributed;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Every cell of the grid is cut along its rising diagonal */
static PetscErrorCode AbutTrianglesGrid_Private(AbutMesh mesh, PetscInt *nc, PetscInt *nv, PetscInt **cell, PetscReal **xy)
{
  const PetscInt nx = mesh->cells[0], ny = mesh->cells[1];
  PetscInt       k = 0;

  PetscFunctionBegin;
  *nc = 2 * nx * ny;
  *nv = (nx + 1) * (ny + 1);
  PetscCall(PetscMalloc1(3 * *nc, cell));
  PetscCall(PetscMalloc1(2 * *nv, xy));
  for (PetscInt v = 0; v < *nv; ++v) {
    (*xy)[2 * v]     = AbutMeshGridLine_Private(mesh, 0, v % (nx + 1));
    (*xy)[2 * v + 1] = AbutMeshGridLine_Private(mesh, 1, v / (nx + 1));
  }
  for (PetscInt q = 0; q < *nc / 2; ++q) {
    const PetscInt v = q / nx * (nx + 1) + q % nx, corner[6] = {v, v + 1, v + nx + 2, v, v + nx + 2, v + nx + 1};

    for (PetscInt i = 0; i < 6; ++i) (*cell)[k++] = corner[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The mesh is made on the first rank and distributed */
static PetscErrorCode AbutMeshCreate_Triangles_DM(AbutMesh mesh, DM *dm)
{
  MPI_Comm    comm = PetscObjectComm((PetscObject)mesh);
  PetscMPIInt rank;
  PetscInt    nc = 0, nv = 0, *cell = NULL;
  PetscReal  *xy = NULL;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (mesh->first && !rank)
    PetscCall(DMPlexCreateFromCellListPetsc(comm, 2, mesh->first->ncells, mesh->first->nvertices, 3, PETSC_TRUE, mesh->first->cell, 2,
                                            mesh->first->x, dm));
  else {
    if (!rank) PetscCall(AbutTrianglesGrid_Private(mesh, &nc, &nv, &cell, &xy));
    PetscCall(DMPlexCreateFromCellListPetsc(comm, 2, nc, nv, 3, PETSC_TRUE, cell, 2, xy, dm));
  }
  PetscCall(PetscFree(cell));
  PetscCall(PetscFree(xy));
  if (mesh->first) PetscCall(AbutBisectionsBegin_Private(mesh, *dm));
  PetscCall(AbutMeshDistribute_Triangles(mesh, dm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bisects the labelled sides, and those of labelled cells */
PetscErrorCode AbutTrianglesSplit_Private(AbutMesh mesh, DM old, DMLabel active, DM *dm)
{
  DMPlexTransform transform;

  PetscFunctionBegin;
  PetscCall(DMPlexTransformCreate(PetscObjectComm((PetscObject)old), &transform));
  PetscCall(DMPlexTransformSetDM(transform, old));
  PetscCall(DMPlexTransformSetType(transform, DMPLEXREFINESBR));
  PetscCall(DMPlexTransformSetActive(transform, active));
  PetscCall(DMPlexTransformSetUp(transform));
  PetscCall(DMPlexTransformApply(transform, old, dm));
  if (mesh->first) PetscCall(AbutBisectionsFollow_Private(mesh, transform, old, *dm));
  PetscCall(DMPlexTransformDestroy(&transform));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutMeshRefine_Triangles(AbutMesh mesh, const PetscBool marks[], DM *dm)
{
  DMLabel   active;
  PetscInt  cStart, cEnd;
  PetscBool any = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(DMLabelCreate(PETSC_COMM_SELF, "adapt", &active));
  PetscCall(DMPlexGetHeightStratum(mesh->dm, 0, &cStart, &cEnd));
  for (PetscInt c = cStart; c < cEnd && marks; ++c) {
    if (!marks[c - cStart]) continue;
    PetscCall(DMLabelSetValue(active, c, DM_ADAPT_REFINE));
    any = PETSC_TRUE;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPIU_BOOL, MPI_LOR, PetscObjectComm((PetscObject)mesh)));
  if (any) PetscCall(AbutTrianglesSplit_Private(mesh, mesh->dm, active, dm));
  PetscCall(DMLabelDestroy(&active));
  if (mesh->coarsen) PetscCall(AbutTrianglesMerge_Private(mesh, marks, dm));
  if (*dm != mesh->dm) PetscCall(AbutMeshDistribute_Triangles(mesh, dm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two bisections halve the sides: the level counts how often the area of a first triangle was quartered, rounded up */
static PetscErrorCode AbutMeshGetLevels_Triangles(AbutMesh mesh, PetscInt level[])
{
  const PetscReal first = 0.5 * (mesh->upper[0] - mesh->lower[0]) * (mesh->upper[1] - mesh->lower[1]) /
                          ((PetscReal)mesh->cells[0] * mesh->cells[1]);
  PetscReal area;

  PetscFunctionBegin;
  if (mesh->first) {
    PetscCall(AbutBisectionsGetLevels_Private(mesh, level));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt c = 0; c < mesh->topology.ncells; ++c) {
    PetscCall(AbutMeshGetCellArea(mesh, c, &area));
    level[c] = (PetscInt)PetscCeilReal(0.5 * PetscLog2Real(first / area) - 0.1);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutMeshKeepFirst_Triangles(AbutMesh mesh)
{
  PetscFunctionBegin;
  PetscCall(PetscObjectReference((PetscObject)mesh->dm));
  ((AbutMesh_Triangles *)mesh->data)->first = mesh->dm;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutMeshDestroy_Triangles(AbutMesh mesh)
{
  AbutMesh_Triangles *triangles = (AbutMesh_Triangles *)mesh->data;

  PetscFunctionBegin;
  PetscCall(DMDestroy(&triangles->first));
  PetscCall(PetscFree(triangles->gone));
  PetscCall(PetscFree(mesh->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutMeshCreate_Triangles(AbutMesh mesh)
{
  AbutMesh_Triangles *triangles;

  PetscFunctionBegin;
  PetscCall(PetscNew(&triangles));
  mesh->data            = triangles;
  mesh->ops->create     = AbutMeshCreate_Triangles_DM;
  mesh->ops->keepfirst  = AbutMeshKeepFirst_Triangles;
  mesh->ops->refine     = AbutMeshRefine_Triangles;
  mesh->ops->distribute = AbutMeshDistribute_Triangles;
  mesh->ops->getlevels  = AbutMeshGetLevels_Triangles;
  mesh->ops->getsides   = AbutMeshGetSides_Triangles;
  mesh->ops->destroy    = AbutMeshDestroy_Triangles;
  PetscFunctionReturn(PETSC_SUCCESS);
}
