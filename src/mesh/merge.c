#include "triangles.h"

/* Triangles that are merged. Bisection keeps no tree; but it puts every vertex in the middle of a side, so the vertices that are to stay
   tell how to make the mesh again from the first one: bisect every side in whose middle one of them lies, until there is none. */

/* A vertex, by its place on a grid so fine that all are whole numbers: those of other ranks and of other meshes are the same to the bit */
typedef struct {
  PetscReal at[2];
  PetscReal least; /* only a cell larger than this is bisected for it: 0 for all, PETSC_MAX_REAL where that is not known here */
} AbutVertex;

/* Adds the local vertices of a DM to n others */
static PetscErrorCode AbutVerticesAdd_Private(AbutMesh mesh, DM dm, PetscInt *n, AbutVertex *vertex[])
{
  PetscInt           vStart, vEnd;
  PetscSection       section;
  Vec                coordinates;
  const PetscScalar *x;

  PetscFunctionBegin;
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, &vEnd));
  PetscCall(PetscRealloc(sizeof(AbutVertex) * (size_t)(*n + vEnd - vStart), vertex));
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(VecGetArrayRead(coordinates, &x));
  for (PetscInt v = vStart; v < vEnd; ++v, ++*n) {
    PetscInt offset;

    PetscCall(PetscSectionGetOffset(section, v, &offset));
    for (PetscInt d = 0; d < 2; ++d) {
      const PetscReal steps = mesh->cells[d] * PetscPowReal(2., ABUT_LEVEL_MAX), width = mesh->upper[d] - mesh->lower[d];

      (*vertex)[*n].at[d] = PetscFloorReal((PetscRealPart(x[offset + d]) - mesh->lower[d]) / width * steps + 0.5);
    }
    (*vertex)[*n].least = PETSC_MAX_REAL;
  }
  PetscCall(VecRestoreArrayRead(coordinates, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The corners of a cell, corner k between its sides k-1 and k, and its area in steps of the grid */
static PetscErrorCode AbutTriangleGet_Private(DM dm, PetscInt c, const AbutVertex vertex[], PetscInt corner[3], PetscReal *area)
{
  const PetscInt  *side, *orientation, *end;
  const PetscReal *x[3];
  PetscInt         vStart;

  PetscFunctionBegin;
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, NULL));
  PetscCall(DMPlexGetCone(dm, c, &side));
  PetscCall(DMPlexGetConeOrientation(dm, c, &orientation));
  for (PetscInt k = 0; k < 3; ++k) {
    PetscCall(DMPlexGetCone(dm, side[k], &end));
    corner[k] = end[orientation[k] < 0] - vStart;
    x[k]      = vertex[corner[k]].at;
  }
  *area = 0.5 * PetscAbsReal((x[1][0] - x[0][0]) * (x[2][1] - x[0][1]) - (x[1][1] - x[0][1]) * (x[2][0] - x[0][0]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A vertex may go, unless it is needed for cells more than four times as large as a present one, if all cells around it are marked, and if
   it has not gone before */
static PetscErrorCode AbutVerticesRelease_Private(AbutMesh mesh, const PetscBool marks[], PetscInt n, AbutVertex vertex[])
{
  const AbutMesh_Triangles *triangles = (const AbutMesh_Triangles *)mesh->data;
  PetscInt                  cStart, cEnd, corner[3];
  PetscReal                 area;

  PetscFunctionBegin;
  PetscCall(DMPlexGetHeightStratum(mesh->dm, 0, &cStart, &cEnd));
  for (PetscInt c = cStart; c < cEnd; ++c) {
    const PetscBool may = (PetscBool)(mesh->coarsen[c - cStart] && !(marks && marks[c - cStart]));

    PetscCall(AbutTriangleGet_Private(mesh->dm, c, vertex, corner, &area));
    for (PetscInt k = 0; k < 3; ++k) vertex[corner[k]].least = PetscMin(vertex[corner[k]].least, may ? 4. * area : 0.);
  }
  for (PetscInt v = 0; v < n; ++v)
    if (triangles->ngone &&
        bsearch(vertex[v].at, triangles->gone, (size_t)triangles->ngone, 2 * sizeof(PetscReal), AbutPointCompare_Private))
      vertex[v].least = 0.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The vertices of all ranks on all ranks, in order and each once */
static PetscErrorCode AbutVerticesGather_Private(MPI_Comm comm, PetscInt nmine, const AbutVertex mine[], PetscInt *n, AbutVertex *all[])
{
  PetscInt k = 0;

  PetscFunctionBegin;
  PetscCall(AbutPointsGather_Private(comm, sizeof(AbutVertex) / sizeof(PetscReal), nmine, (const PetscReal *)mine, n, (PetscReal **)all));
  for (PetscInt i = 1; i < *n; ++i)
    if (AbutPointCompare_Private(&(*all)[k], &(*all)[i])) (*all)[++k] = (*all)[i];
    else (*all)[k].least = PetscMin((*all)[k].least, (*all)[i].least);
  *n = k + 1;
  for (PetscInt i = 0; i < *n; ++i)
    if ((*all)[i].least >= PETSC_MAX_REAL) (*all)[i].least = 0.; /* new ones, beside cells that were split */
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const AbutVertex *AbutVerticesFind_Private(PetscInt n, const AbutVertex all[], const PetscReal at[2])
{
  return (const AbutVertex *)bsearch(at, all, (size_t)n, sizeof(AbutVertex), AbutPointCompare_Private);
}

/* Bisects once every side that has one of the vertices in its middle, in a cell that is large enough */
static PetscErrorCode AbutVerticesBisect_Private(AbutMesh mesh, PetscInt n, const AbutVertex wanted[], DM *dm, PetscBool *any)
{
  PetscInt        nvertices = 0, cStart, cEnd, corner[3];
  const PetscInt *side;
  AbutVertex     *vertex = NULL;
  DMLabel         active;
  DM              finer;

  PetscFunctionBegin;
  PetscCall(AbutVerticesAdd_Private(mesh, *dm, &nvertices, &vertex));
  PetscCall(DMLabelCreate(PETSC_COMM_SELF, "sides", &active));
  PetscCall(DMPlexGetHeightStratum(*dm, 0, &cStart, &cEnd));
  *any = PETSC_FALSE;
  for (PetscInt c = cStart; c < cEnd; ++c) {
    PetscReal area;

    PetscCall(AbutTriangleGet_Private(*dm, c, vertex, corner, &area));
    PetscCall(DMPlexGetCone(*dm, c, &side));
    for (PetscInt k = 0; k < 3; ++k) {
      const PetscReal  *a = vertex[corner[k]].at, *b = vertex[corner[(k + 1) % 3]].at;
      const PetscReal   middle[2] = {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])};
      const AbutVertex *found     = AbutVerticesFind_Private(n, wanted, middle);

      if (!found || area <= found->least) continue;
      PetscCall(DMLabelSetValue(active, side[k], DM_ADAPT_REFINE));
      *any = PETSC_TRUE;
    }
  }
  PetscCall(PetscFree(vertex));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, any, 1, MPIU_BOOL, MPI_LOR, PetscObjectComm((PetscObject)mesh)));
  if (*any) {
    PetscCall(AbutTrianglesSplit_Private(mesh, *dm, active, &finer));
    PetscCall(DMDestroy(dm));
    *dm = finer;
  }
  PetscCall(DMLabelDestroy(&active));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The vertices of the list that a DM does not have, in order; whole: it has all that must stay */
static PetscErrorCode AbutVerticesMissing_Private(AbutMesh mesh, DM dm, PetscInt n, AbutVertex all[], PetscInt *nmissing, PetscBool *whole)
{
  PetscInt    nvertices = 0;
  AbutVertex *vertex    = NULL;
  PetscBool  *has;

  PetscFunctionBegin;
  PetscCall(AbutVerticesAdd_Private(mesh, dm, &nvertices, &vertex));
  PetscCall(PetscCalloc1(n, &has));
  for (PetscInt v = 0; v < nvertices; ++v) {
    const AbutVertex *found = AbutVerticesFind_Private(n, all, vertex[v].at);

    if (found) has[found - all] = PETSC_TRUE;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, has, (PetscMPIInt)n, MPIU_BOOL, MPI_LOR, PetscObjectComm((PetscObject)mesh)));
  *nmissing = 0;
  *whole    = PETSC_TRUE;
  for (PetscInt i = 0; i < n; ++i) {
    if (has[i]) continue;
    if (all[i].least <= 0.) *whole = PETSC_FALSE;
    all[(*nmissing)++] = all[i];
  }
  PetscCall(PetscFree(vertex));
  PetscCall(PetscFree(has));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutVerticesForbid_Private(AbutMesh mesh, PetscInt n, const AbutVertex gone[])
{
  AbutMesh_Triangles *triangles = (AbutMesh_Triangles *)mesh->data;

  PetscFunctionBegin;
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscRealloc(2 * sizeof(PetscReal) * (size_t)(triangles->ngone + n), &triangles->gone));
  for (PetscInt i = 0; i < n; ++i) PetscCall(PetscArraycpy(triangles->gone + 2 * triangles->ngone++, gone[i].at, 2));
  qsort(triangles->gone, (size_t)triangles->ngone, 2 * sizeof(PetscReal), AbutPointCompare_Private);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* From the mesh with the marked cells split to the one without the vertices that may go */
PetscErrorCode AbutTrianglesMerge_Private(AbutMesh mesh, const PetscBool marks[], DM *dm)
{
  PetscInt    nmine  = 0, n, left;
  AbutVertex *mine   = NULL, *all;
  DM          coarse = ((AbutMesh_Triangles *)mesh->data)->first;
  PetscBool   again  = PETSC_FALSE, whole;

  PetscFunctionBegin;
  PetscCall(AbutVerticesAdd_Private(mesh, mesh->dm, &nmine, &mine));
  PetscCall(AbutVerticesRelease_Private(mesh, marks, nmine, mine));
  PetscCall(AbutVerticesAdd_Private(mesh, *dm, &nmine, &mine));
  PetscCall(AbutVerticesGather_Private(PetscObjectComm((PetscObject)mesh), nmine, mine, &n, &all));
  PetscCall(PetscFree(mine));
  for (PetscInt i = 0; i < n && !again; ++i) again = (PetscBool)(all[i].least > 0.);
  if (again) {
    PetscCall(PetscObjectReference((PetscObject)coarse));
    while (again) PetscCall(AbutVerticesBisect_Private(mesh, n, all, &coarse, &again));
    PetscCall(AbutVerticesMissing_Private(mesh, coarse, n, all, &left, &whole));
    if (whole && left) {
      PetscCall(AbutVerticesForbid_Private(mesh, left, all));
      if (*dm != mesh->dm) PetscCall(DMDestroy(dm));
      *dm = coarse;
    } else PetscCall(DMDestroy(&coarse));
  }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}
