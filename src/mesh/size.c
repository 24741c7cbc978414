#include <abut/private/meshimpl.h> /*I "abutmesh.h" I*/

/* The first mesh made finer where the scene wants small cells */

#define ABUT_CELLS_MAX 1e8 /* as for the cells of the box */
#define ABUT_GRID      16

static PetscErrorCode AbutMeshCheckCells_Private(AbutMesh mesh, PetscReal cells)
{
  PetscFunctionBegin;
  AbutCheckInput(cells <= ABUT_CELLS_MAX, PetscObjectComm((PetscObject)mesh),
                 "%smesh_size: asks for more than %g cells; give larger sizes away from where small cells are needed",
                 ((PetscObject)mesh)->prefix, ABUT_CELLS_MAX);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ends the run if the wanted size is not a length on a grid of points, or if as many cells as that grid foresees would be too many */
static PetscErrorCode AbutMeshCheckSize_Private(AbutMesh mesh)
{
  const PetscReal width[2] = {mesh->upper[0] - mesh->lower[0], mesh->upper[1] - mesh->lower[1]};
  PetscReal       cells    = 0.;

  PetscFunctionBegin;
  if (mesh->first) PetscFunctionReturn(PETSC_SUCCESS); /* the grid would leave the body: every round asks its cells */
  for (PetscInt i = 0; i <= ABUT_GRID; ++i)
    for (PetscInt j = 0; j <= ABUT_GRID; ++j) {
      const PetscReal x[2] = {mesh->lower[0] + i * width[0] / ABUT_GRID, mesh->lower[1] + j * width[1] / ABUT_GRID};
      PetscReal       wanted;

      PetscCall(AbutExpressionEvaluate(mesh->size, x, &wanted));
      AbutCheckInput(wanted > 0., PetscObjectComm((PetscObject)mesh),
                     "%smesh_size: %g at (%g, %g) is not a length; give an expression above 0 everywhere, for example "
                     "max(0.01,0.2*abs(x-1))",
                     ((PetscObject)mesh)->prefix, (double)wanted, (double)x[0], (double)x[1]);
      if (i % ABUT_GRID && j % ABUT_GRID) cells += width[0] * width[1] / (PetscSqr(ABUT_GRID) * PetscSqr(wanted));
    }
  PetscCall(AbutMeshCheckCells_Private(mesh, cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells whose longest side is above the wanted size at their middle */
static PetscErrorCode AbutMeshMarkSize_Private(AbutMesh mesh, PetscBool mark[], PetscInt *marked)
{
  const AbutMeshTopology *t = &mesh->topology;
  PetscInt                cells, count[2] = {0, 0}; /* cells to split, and cells where the wanted size is none */

  PetscFunctionBegin;
  for (PetscInt c = 0; c < t->ncells; ++c) {
    const PetscInt *v         = t->cell + t->corners * c;
    PetscReal       middle[2] = {0., 0.}, size2 = 0., wanted;

    for (PetscInt k = 0; k < t->corners; ++k) {
      const PetscReal *p = t->x + 2 * v[k], *q = t->x + 2 * v[(k + 1) % t->corners];

      size2 = PetscMax(size2, PetscSqr(q[0] - p[0]) + PetscSqr(q[1] - p[1]));
      for (PetscInt d = 0; d < 2; ++d) middle[d] += p[d] / t->corners;
    }
    PetscCall(AbutExpressionEvaluate(mesh->size, middle, &wanted));
    mark[c] = (PetscBool)(t->level[c] < ABUT_LEVEL_MAX && size2 > PetscSqr(wanted) * (1. + 1e-10));
    count[0] += mark[c];
    if (wanted <= 0.) ++count[1];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 2, MPIU_INT, MPI_SUM, PetscObjectComm((PetscObject)mesh)));
  AbutCheckInput(!count[1], PetscObjectComm((PetscObject)mesh),
                 "%smesh_size: not a length somewhere in the body; give an expression above 0 everywhere, for example "
                 "max(0.01,0.2*abs(x-1))",
                 ((PetscObject)mesh)->prefix);
  *marked = count[0];
  PetscCall(AbutMeshGetCellCount(mesh, &cells));
  PetscCall(AbutMeshCheckCells_Private(mesh, cells + 3. * *marked));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutMeshRefineToSize_Private(AbutMesh mesh)
{
  const PetscBool journal = mesh->journal;
  PetscInt        marked  = 1;
  PetscLogEvent   event;

  PetscFunctionBegin;
  if (!mesh->size) PetscFunctionReturn(PETSC_SUCCESS);
  mesh->journal = PETSC_FALSE; /* what is made anew by every set-up is no step of adaptation */
  PetscCall(AbutLogEventGet("AbutMeshSize", ABUTMESH_CLASSID, &event));
  PetscCall(PetscLogEventBegin(event, mesh, 0, 0, 0));
  PetscCall(AbutMeshCheckSize_Private(mesh));
  while (marked) {
    PetscBool *mark;

    PetscCall(PetscMalloc1(mesh->topology.ncells, &mark));
    PetscCall(AbutMeshMarkSize_Private(mesh, mark, &marked));
    if (marked) PetscCall(AbutMeshAdapt(mesh, mark));
    PetscCall(PetscFree(mark));
  }
  mesh->journal = journal;
  PetscCall(PetscLogEventEnd(event, mesh, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
