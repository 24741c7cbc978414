#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/

/* The ranks that have a body. Mesh, boundary and vectors belong to all ranks of the body, so that whatever is asked of it is known
   everywhere; matrices and solver belong to the group of those that have cells, so that bodies on disjoint groups are solved at the same
   time. The other ranks, together, are a group with an empty body: nobody needs to ask which group it is in, but for solving. */

/* What is left of a group when all that belongs to a mesh is freed */
PetscErrorCode AbutBodyLeaveGroup_Private(AbutBody body)
{
  PetscFunctionBegin;
  PetscCall(KSPDestroy(&body->ksp));
  if (body->split) PetscCallMPI(MPI_Comm_free(&body->group));
  body->group = PetscObjectComm((PetscObject)body);
  body->here  = PETSC_TRUE;
  body->split = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodySetRanks - Which ranks have the cells and solve a body; it is set up anew

   Collective

   Input Parameters:
+  body  - the body, its options read
.  first - the first of them
-  n     - how many; 0 with `first` = 0 for all of its communicator, as in a new body

   Level: developer

   Notes:
   A mesh that is set up moves to these ranks. The solver is made anew, with the options of the body.

   What needs all ranks (setting up mesh, boundary and vectors, traces, sums) still needs all of them; assembling, factors and solves
   need the group alone. Whoever wants bodies to be solved side by side calls `AbutBodySolve()` for all before asking what became of any.

.seealso: `AbutBodySetUpAll()`, `AbutBodyGetSolved()`, `AbutMeshSetRanks()`
@*/
PetscErrorCode AbutBodySetRanks(AbutBody body, PetscMPIInt first, PetscMPIInt n)
{
  MPI_Comm    comm = PetscObjectComm((PetscObject)body);
  PetscMPIInt rank, size;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  PetscCall(AbutMeshSetRanks(body->mesh, first, n));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(AbutBodyReset_Private(body));
  PetscCall(AbutBodyLeaveGroup_Private(body));
  body->leader = first;
  body->here   = (PetscBool)(!n || (rank >= first && rank < first + n));
  body->split  = (PetscBool)(n && n < size);
  if (body->split) PetscCallMPI(MPI_Comm_split(comm, body->here ? 0 : 1, rank, &body->group));
  PetscCall(AbutBodyCreateSolver_Private(body));
  PetscCall(AbutBodyChooseSolver_Private(body, 0, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A square matrix of the unknowns, [nowned] nodes in the rows of each of its nodes: owned by this rank, and not */
PetscErrorCode AbutBodyCreateGroupMat_Private(AbutBody body, const PetscInt diagonal[], const PetscInt off[], Mat *M)
{
  const AbutMeshTopology *t;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  PetscCall(MatCreate(body->group, M));
  PetscCall(MatSetSizes(*M, 2 * t->nowned, 2 * t->nowned, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetBlockSize(*M, 2));
  PetscCall(MatSetType(*M, MATAIJ));
  PetscCall(MatXAIJSetPreallocation(*M, 2, diagonal, off, NULL, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A vector of the body as one of its group, with the same values in the same place; v itself is not to be used before it is restored */
PetscErrorCode AbutBodyGetGroupVec_Private(AbutBody body, Vec v, Vec *group)
{
  const AbutMeshTopology *t;
  PetscScalar            *a;
  PetscMPIInt             size;

  PetscFunctionBegin;
  *group = v;
  if (!body->split) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  PetscCall(VecGetArray(v, &a));
  PetscCallMPI(MPI_Comm_size(body->group, &size));
  if (size == 1) PetscCall(VecCreateSeqWithArray(body->group, 2, 2 * t->nowned, a, group));
  else PetscCall(VecCreateMPIWithArray(body->group, 2, 2 * t->nowned, PETSC_DECIDE, a, group));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutBodyRestoreGroupVec_Private(AbutBody body, Vec v, Vec *group)
{
  PetscFunctionBegin;
  if (body->split) {
    PetscCall(VecDestroy(group));
    PetscCall(VecRestoreArray(v, NULL));
  }
  *group = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = M x for a square matrix of the body's group, and vectors of the body */
PetscErrorCode AbutBodyMult_Private(AbutBody body, Mat M, Vec x, Vec y)
{
  Vec gx, gy;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetGroupVec_Private(body, x, &gx));
  PetscCall(AbutBodyGetGroupVec_Private(body, y, &gy));
  PetscCall(MatMult(M, gx, gy));
  PetscCall(AbutBodyRestoreGroupVec_Private(body, y, &gy));
  PetscCall(AbutBodyRestoreGroupVec_Private(body, x, &gx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the group of the body knows, to all ranks */
PetscErrorCode AbutBodyShare_Private(AbutBody body, PetscMPIInt n, PetscReal value[])
{
  PetscFunctionBegin;
  if (body->split) PetscCallMPI(MPI_Bcast(value, n, MPIU_REAL, body->leader, PetscObjectComm((PetscObject)body)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetSolved - Whether the linear solver converged in the last solve of a body, on all ranks

   Collective

   Input Parameter:
.  body - the body, solved

   Output Parameter:
.  solved - `PETSC_FALSE` if it failed

   Level: intermediate

.seealso: `AbutBodySolve()`, `AbutBodySolveIncrement()`, `AbutBodyGetSolveCounts()`
@*/
PetscErrorCode AbutBodyGetSolved(AbutBody body, PetscBool *solved)
{
  KSPConvergedReason reason;
  PetscReal          value[3];

  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  PetscCall(KSPGetConvergedReason(body->ksp, &reason));
  value[0] = reason >= 0;
  value[1] = body->solves;
  value[2] = body->iterations;
  PetscCall(AbutBodyShare_Private(body, 3, value));
  *solved          = (PetscBool)(value[0] > 0.);
  body->solves     = (PetscInt)value[1];
  body->iterations = (PetscInt)value[2];
  PetscFunctionReturn(PETSC_SUCCESS);
}
