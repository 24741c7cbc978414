#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/

/* Vectors of the present mesh of a body, and how long they are */

/*@
   AbutBodyGetSize - The displacement unknowns of a body, prescribed ones included, hanging ones not

   Not Collective

   Input Parameter:
.  body - the body, set up

   Output Parameter:
.  n - unknowns over all ranks

   Level: beginner

.seealso: `AbutBodySetUp()`
@*/
PetscErrorCode AbutBodyGetSize(AbutBody body, PetscInt *n)
{
  const AbutMeshTopology *t;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  *n = 2 * t->nglobal;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The unknowns on all ranks of the body, or on its group */
PetscErrorCode AbutBodyCreateVecOn_Private(AbutBody body, MPI_Comm comm, Vec *v)
{
  const AbutMeshTopology *t;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  PetscCall(VecCreate(comm, v));
  PetscCall(VecSetSizes(*v, 2 * t->nowned, PETSC_DETERMINE));
  PetscCall(VecSetBlockSize(*v, 2));
  PetscCall(VecSetType(*v, VECSTANDARD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyCreateVec - Creates a vector of the body's unknowns: nodal displacements or forces

   Collective

   Input Parameter:
.  body - the body, its mesh set up

   Output Parameter:
.  v - the vector, zero, block size 2

   Level: intermediate

.seealso: `AbutBodySolve()`, `AbutBodyCreateCellVec()`
@*/
PetscErrorCode AbutBodyCreateVec(AbutBody body, Vec *v)
{
  PetscFunctionBegin;
  PetscCall(AbutBodyCreateVecOn_Private(body, PetscObjectComm((PetscObject)body), v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyCreateCellVec - Creates a vector with one value per cell

   Collective

   Input Parameter:
.  body - the body, its mesh set up

   Output Parameter:
.  v - the vector, zero; local entry c belongs to local cell c

   Level: intermediate

.seealso: `AbutEstimatorEstimate()`
@*/
PetscErrorCode AbutBodyCreateCellVec(AbutBody body, Vec *v)
{
  const AbutMeshTopology *t;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  PetscCall(VecCreateMPI(PetscObjectComm((PetscObject)body), t->ncells, PETSC_DETERMINE, v));
  PetscFunctionReturn(PETSC_SUCCESS);
}
