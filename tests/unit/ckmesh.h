#pragma once

#include "ck.h"
#include <abutmesh.h>

/* Meshes for the tests of everything that lives on one */

static PetscOptions ck_options;

/* Between the two calls these options hold, and no other */
static inline void CkOptions(const char text[])
{
  CkOk(PetscOptionsCreate(&ck_options));
  CkOk(PetscOptionsInsertString(ck_options, text));
  CkOk(PetscOptionsPush(ck_options));
}

static inline void CkOptionsEnd(void)
{
  CkOk(PetscOptionsPop());
  CkOk(PetscOptionsDestroy(&ck_options));
}

static inline AbutMesh CkBoxOn(MPI_Comm comm, PetscReal x0, PetscReal y0, PetscReal x1, PetscReal y1, PetscInt nx, PetscInt ny,
                               AbutShape shape)
{
  const PetscReal lower[2] = {x0, y0}, upper[2] = {x1, y1};
  const PetscInt  cells[2] = {nx, ny};
  AbutMesh        mesh;

  CkOk(AbutMeshCreate(comm, &mesh));
  CkOk(AbutMeshSetBox(mesh, lower, upper, cells, shape));
  CkOk(AbutMeshSetUp(mesh));
  return mesh;
}

static inline AbutMesh CkBox(PetscReal x0, PetscReal y0, PetscReal x1, PetscReal y1, PetscInt nx, PetscInt ny, AbutShape shape)
{
  return CkBoxOn(PETSC_COMM_WORLD, x0, y0, x1, y1, nx, ny, shape);
}

static inline const AbutMeshTopology *CkTopology(AbutMesh mesh)
{
  const AbutMeshTopology *t;

  CkOk(AbutMeshGetTopology(mesh, &t));
  return t;
}

static inline void CkCenter(const AbutMeshTopology *t, PetscInt c, PetscReal x[2])
{
  for (PetscInt d = 0; d < 2; ++d) {
    x[d] = 0.;
    for (PetscInt k = 0; k < t->corners; ++k) x[d] += t->x[2 * t->cell[t->corners * c + k] + d] / t->corners;
  }
}

/* Marks cells by their place only, so that every distribution makes the same mesh */
typedef PetscBool (*CkMark)(AbutMesh, PetscInt, PetscInt);

static inline void CkRefine(AbutMesh mesh, CkMark mark, PetscInt times)
{
  for (PetscInt i = 0; i < times; ++i) {
    const AbutMeshTopology *t = CkTopology(mesh);
    PetscBool              *marks;

    CkOk(PetscCalloc1(t->ncells, &marks));
    for (PetscInt c = 0; c < t->ncells; ++c) marks[c] = mark(mesh, c, i);
    CkOk(AbutMeshAdapt(mesh, marks));
    CkOk(PetscFree(marks));
  }
}

static inline PetscBool CkEverywhere(PETSC_UNUSED AbutMesh mesh, PETSC_UNUSED PetscInt c, PETSC_UNUSED PetscInt i)
{
  return PETSC_TRUE;
}

/* The cells that contain a point in the inside of most boxes used here, and a vertex of most of their grids */
static inline PetscBool CkTowardsPoint(AbutMesh mesh, PetscInt c, PETSC_UNUSED PetscInt i)
{
  const PetscReal p[2] = {0.5, 0.25};
  PetscReal       xi[2];
  PetscBool       inside;

  CkOk(AbutMeshInvertCell(mesh, c, p, xi, &inside));
  return inside;
}

/* Every fourth cell or so, as a cheap hash of its centre says */
static inline PetscBool CkScattered(AbutMesh mesh, PetscInt c, PetscInt i)
{
  PetscReal x[2], hash;

  CkCenter(CkTopology(mesh), c, x);
  hash = 1e4 * PetscSinReal(12.9898 * x[0] + 78.233 * x[1] + i);
  return (PetscBool)(hash - PetscFloorReal(hash) < 0.25);
}

/* The corners of all cells, on every rank */
typedef struct {
  PetscInt   n, corners;
  PetscReal *x; /* [2*corners*n] */
} CkCells;

static inline CkCells CkGather(AbutMesh mesh)
{
  const AbutMeshTopology *t    = CkTopology(mesh);
  MPI_Comm                comm = PetscObjectComm((PetscObject)mesh);
  CkCells                 all  = {0, t->corners, NULL};
  PetscMPIInt             size, mine = (PetscMPIInt)(2 * t->corners * t->ncells), *counts, *offsets;
  PetscReal              *x;

  CkOk(MPI_Comm_size(comm, &size));
  CkOk(PetscMalloc3(mine, &x, size, &counts, size + 1, &offsets));
  for (PetscInt i = 0; i < mine; ++i) x[i] = t->x[2 * t->cell[i / 2] + i % 2];
  CkOk(MPI_Allgather(&mine, 1, MPI_INT, counts, 1, MPI_INT, comm));
  offsets[0] = 0;
  for (PetscMPIInt r = 0; r < size; ++r) offsets[r + 1] = offsets[r] + counts[r];
  all.n = offsets[size] / (2 * all.corners);
  CkOk(PetscMalloc1(offsets[size], &all.x));
  CkOk(MPI_Allgatherv(x, mine, MPIU_REAL, all.x, counts, offsets, MPIU_REAL, comm));
  CkOk(PetscFree3(x, counts, offsets));
  return all;
}

static inline PetscInt CkSum(PetscInt mine)
{
  PetscInt sum;

  CkOk(MPI_Allreduce(&mine, &sum, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  return sum;
}

static inline PetscReal CkTotal(PetscReal mine)
{
  PetscReal sum;

  CkOk(MPI_Allreduce(&mine, &sum, 1, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  return sum;
}
