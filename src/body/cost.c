#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/

/* What the linear algebra of a body costs */

/* The preconditioner or factor of a new mesh, as a step of its own and not in the first solve, where it would be one of the sweeps */
PetscErrorCode AbutBodyFactor_Private(AbutBody body)
{
  PetscLogDouble begun, done;

  PetscFunctionBegin;
  PetscCall(PetscTime(&begun));
  PetscCall(KSPSetUp(body->ksp));
  PetscCall(PetscTime(&done));
  body->factortime += done - begun;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetSetUpCost - Seconds spent on element matrices and their insertion, for how many cells, and on preconditioners or factors

   Collective

   Input Parameter:
.  body - the body

   Output Parameters:
+  assembly - over all meshes so far, the slowest rank
.  cells    - assembled so far, over all ranks
-  factor   - over all meshes so far, the slowest rank

   Level: developer

.seealso: `AbutBodySetUp()`, `AbutBodyGetLinearCost()`
@*/
PetscErrorCode AbutBodyGetSetUpCost(AbutBody body, PetscReal *assembly, PetscInt *cells, PetscReal *factor)
{
  MPI_Comm  comm       = PetscObjectComm((PetscObject)body);
  PetscReal seconds[2] = {body->assemblytime, body->factortime};

  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, seconds, 2, MPIU_REAL, MPIU_MAX, comm));
  PetscCallMPI(MPI_Allreduce(&body->assemblycells, cells, 1, MPIU_INT, MPI_SUM, comm));
  *assembly = seconds[0];
  *factor   = seconds[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetLinearCost - The processor time of one linear problem on the present mesh: assembly, factor or preconditioner, and one solve

   Collective

   Input Parameters:
+  body - the body, solved
-  rtol - relative tolerance of the solve, which begins with zero, for an iterative solver

   Output Parameter:
.  cpu - seconds, the sum over the ranks; assembly and factor as they were measured, the solve is made now and forgotten

   Level: developer

.seealso: `AbutBodySolve()`, `AbutBodyGetSetUpCost()`
@*/
PetscErrorCode AbutBodyGetLinearCost(AbutBody body, PetscReal rtol, PetscReal *cpu)
{
  Vec            x;
  PetscBool      nonzero;
  PetscReal      own;
  PetscLogDouble begun, done, seconds;

  PetscFunctionBegin;
  PetscCall(AbutBodyNeedSetUp_Private(body));
  PetscCall(VecDuplicate(body->rhs, &x));
  PetscCall(KSPGetInitialGuessNonzero(body->ksp, &nonzero));
  PetscCall(KSPGetTolerances(body->ksp, &own, NULL, NULL, NULL));
  PetscCall(KSPSetInitialGuessNonzero(body->ksp, PETSC_FALSE));
  PetscCall(KSPSetTolerances(body->ksp, rtol, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  PetscCall(AbutGetProcessorTime(&begun));
  PetscCall(AbutBodyRightHandSide_Private(body, body->rhs));
  PetscCall(MatNullSpaceRemove(body->free, body->rhs));
  if (body->here) PetscCall(KSPSolve(body->ksp, body->rhs, x));
  PetscCall(AbutGetProcessorTime(&done));
  PetscCall(KSPSetInitialGuessNonzero(body->ksp, nonzero));
  PetscCall(KSPSetTolerances(body->ksp, own, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  PetscCall(VecDestroy(&x));
  seconds = body->setupcpu + done - begun;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &seconds, 1, MPI_DOUBLE, MPI_SUM, PetscObjectComm((PetscObject)body)));
  *cpu = seconds;
  PetscFunctionReturn(PETSC_SUCCESS);
}
