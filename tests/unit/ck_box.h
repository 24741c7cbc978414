#pragma once

#include "ck.h"
#include <abutbody.h>

static PetscErrorCode CkZero(PETSC_UNUSED const PetscReal x[2], PetscReal *value, PETSC_UNUSED void *ctx)
{
  *value = 0.;
  return PETSC_SUCCESS;
}

/* A body on a box, both components of the displacement given on all sides; NULL is zero */
static inline AbutBody CkBox(MPI_Comm comm, AbutShape shape, PetscReal length, PetscInt nx, PetscInt ny, AbutPointFunction u1,
                             AbutPointFunction u2)
{
  static const char *const side[]   = {"left", "right", "bottom", "top"};
  const PetscReal          lower[2] = {0., 0.}, upper[2] = {length, 1.};
  const PetscInt           cells[2] = {nx, ny};
  AbutBody                 body;
  AbutMesh                 mesh;

  CkOk(AbutBodyCreate(comm, "box", &body));
  CkOk(AbutBodyGetMesh(body, &mesh));
  CkOk(AbutMeshSetBox(mesh, lower, upper, cells, shape));
  CkOk(AbutBodySetMaterial(body, 1., 0.3));
  for (PetscInt s = 0; s < 4; ++s) {
    CkOk(AbutBodySetDisplacement(body, side[s], 0, u1 ? u1 : CkZero, NULL));
    CkOk(AbutBodySetDisplacement(body, side[s], 1, u2 ? u2 : CkZero, NULL));
  }
  CkOk(AbutBodySetFromOptions(body));
  CkOk(AbutBodySetUp(body));
  return body;
}

static inline const AbutMeshTopology *CkTopology(AbutBody body)
{
  AbutMesh                mesh;
  const AbutMeshTopology *t;

  CkOk(AbutBodyGetMesh(body, &mesh));
  CkOk(AbutMeshGetTopology(mesh, &t));
  return t;
}

/* Refines once the cells that have a corner within the distance r of a point */
static inline void CkRefine(AbutBody body, PetscReal x, PetscReal y, PetscReal r)
{
  const AbutMeshTopology *t = CkTopology(body);
  AbutMesh                mesh;
  PetscBool              *mark;

  CkOk(PetscCalloc1(t->ncells, &mark));
  for (PetscInt i = 0; i < t->ncells * t->corners; ++i) {
    const PetscReal *p = &t->x[2 * t->cell[i]];

    if (PetscSqr(p[0] - x) + PetscSqr(p[1] - y) <= r * r) mark[i / t->corners] = PETSC_TRUE;
  }
  CkOk(AbutBodyGetMesh(body, &mesh));
  CkOk(AbutMeshAdapt(mesh, mark));
  CkOk(AbutBodySetUp(body));
  CkOk(PetscFree(mark));
}
