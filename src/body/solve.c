#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/
#include <petsc/private/kspimpl.h> /* ksp->reason: there is no setter */

/* Solves of a body, and what became of them */

#define ABUT_INCREMENT 1e-4 /* relative tolerance of an increment, at most */

/* Displacement at every local node: at a hanging one that of the coarse side */
PetscErrorCode AbutBodySpread_Private(AbutBody body)
{
  const AbutMeshTopology *t;
  const PetscScalar      *ua;
  Vec                     local;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  PetscCall(VecGhostUpdateBegin(body->u, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGhostUpdateEnd(body->u, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGhostGetLocalForm(body->u, &local));
  PetscCall(VecGetArrayRead(local, &ua));
  for (PetscInt k = 0; k < t->nnodes; ++k)
    for (PetscInt d = 0; d < 2; ++d) {
      PetscReal *u = body->nodeu + 2 * k + d;

      *u = t->unknown[k] < 0 ? 0. : ua[2 * t->unknown[k] + d];
      for (PetscInt i = t->anchors[k]; i < t->anchors[k + 1]; ++i) *u += t->weight[i] * ua[2 * t->unknown[t->anchor[i]] + d];
    }
  body->strainknown = PETSC_FALSE;
  PetscCall(VecRestoreArrayRead(local, &ua));
  PetscCall(VecGhostRestoreLocalForm(body->u, &local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the present forces and prescribed displacements make of the right-hand side of A: mu times the value in a prescribed row */
PetscErrorCode AbutBodyRightHandSide_Private(AbutBody body, Vec b)
{
  const Vec          part[3] = {body->load, body->contact, body->lift};
  const PetscInt    *row;
  const PetscScalar *g, *of[3];
  PetscScalar       *a;
  PetscInt           n, size, first;

  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(b, &size));
  PetscCall(VecGetOwnershipRange(b, &first, NULL));
  PetscCall(ISGetLocalSize(body->constrained, &n));
  PetscCall(ISGetIndices(body->constrained, &row));
  PetscCall(VecGetArrayRead(body->prescribed, &g));
  for (PetscInt k = 0; k < 3; ++k) PetscCall(VecGetArrayRead(part[k], &of[k]));
  PetscCall(VecGetArrayWrite(b, &a));
  for (PetscInt i = 0; i < size; ++i) a[i] = of[0][i] + of[1][i] + of[2][i];
  for (PetscInt i = 0; i < n; ++i) a[row[i] - first] = body->mu * g[i];
  PetscCall(VecRestoreArrayWrite(b, &a));
  for (PetscInt k = 0; k < 3; ++k) PetscCall(VecRestoreArrayRead(part[k], &of[k]));
  PetscCall(VecRestoreArrayRead(body->prescribed, &g));
  PetscCall(ISRestoreIndices(body->constrained, &row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The right-hand side without its part along the free modes, which has no solution, and its size. KSPSolve() of PETSc 3.18 and 3.22 looks
   for the null space of the right-hand side in P, where there is none, so it is ours to clean. */
static PetscErrorCode AbutBodyCleanRightHandSide_Private(AbutBody body, PetscReal *size)
{
  PetscFunctionBegin;
  PetscCall(MatNullSpaceRemove(body->free, body->rhs));
  PetscCall(VecNorm(body->rhs, NORM_2, size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A x = rhs, a clean one; the solution without a part along the free modes, which is not determined: the null space of A keeps the
   directions of a Krylov method clean, but not its start. */
static PetscErrorCode AbutBodySolveLinear_Private(AbutBody body, Vec u)
{
  Vec       x;
  PetscInt  its;
  PetscReal size;

  PetscFunctionBegin;
  if (!body->here) PetscFunctionReturn(PETSC_SUCCESS);
  ++body->solves;
  PetscCall(AbutBodyGetGroupVec_Private(body, u, &x));
  PetscCall(KSPSolve(body->ksp, body->rhs, x));
  PetscCall(MatNullSpaceRemove(body->free, x));
  PetscCall(VecNorm(x, NORM_INFINITY, &size));
  if (PetscIsInfOrNanReal(size)) { /* a factor may be spoilt without saying so: the caller asks the KSP, and finds zeros instead of NaN */
    body->ksp->reason = KSP_DIVERGED_NANORINF;
    PetscCall(VecZeroEntries(x));
  }
  PetscCall(AbutBodyRestoreGroupVec_Private(body, u, &x));
  PetscCall(KSPGetIterationNumber(body->ksp, &its));
  body->iterations += its;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodySolve - Solves the body with given nodal contact forces: one body's part of a sweep, eq. (20) of the paper

   Collective

   Input Parameters:
+  body    - the body; set up if need be
-  contact - nodal contact forces, stress times length, of the layout of `AbutBodyCreateVec()`, or `NULL` for none

   Level: beginner

   Notes:
   Whether the linear solver converged says `AbutBodyGetSolved()`. An iterative one begins with the present displacement.

   With free modes, what the forces have along them is left out (see `AbutBodyGetImbalance()`), and the displacement has no part along them.

.seealso: `AbutBodyGetSolution()`, `AbutBodyGetCellStress()`, `AbutBodySolveIncrement()`, `AbutBodyGetFreeModes()`, `AbutBodyGetImbalance()`
@*/
PetscErrorCode AbutBodySolve(AbutBody body, Vec contact)
{
  PetscFunctionBegin;
  PetscCall(AbutBodySetUp(body));
  PetscCall(PetscLogEventBegin(ABUTBODY_Solve, body, 0, 0, 0));
  if (contact) PetscCall(VecCopy(contact, body->contact));
  else PetscCall(VecZeroEntries(body->contact));
  PetscCall(AbutBodyRightHandSide_Private(body, body->rhs));
  PetscCall(AbutBodyCleanRightHandSide_Private(body, &body->whole));
  PetscCall(AbutBodySolveLinear_Private(body, body->u));
  PetscCall(AbutBodySpread_Private(body));
  PetscCall(PetscLogEventEnd(ABUTBODY_Solve, body, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodySolveIncrement - Answers more contact forces alone: zero prescribed displacements, no tractions; the body itself stays as it is

   Collective

   Input Parameters:
+  body    - the body, set up
-  contact - nodal contact forces to come, stress times length, of the layout of `AbutBodyCreateVec()`

   Output Parameter:
.  w - the displacement they add, length, of the same layout; what it held before is of no account, an iterative solver begins with zero

   Level: intermediate

   Notes:
   Counts as a solve, except for contact forces that are all zero, which cost nothing. Whether the linear solver converged says
   `AbutBodyGetSolved()`; after a failure w may be zero.

   An iterative solver need not leave less than it left in `AbutBodySolve()`: its relative tolerance is half of that one's, in
   proportion to the sizes of the right-hand sides, up to a ten thousandth, with which the loops still take no more sweeps than with
   exact answers.

   With free modes, what the forces have along them is left out, and w has no part along them.

.seealso: `AbutBodyUpdate()`, `AbutBodySolve()`, `AbutBodyGetKSP()`
@*/
PetscErrorCode AbutBodySolveIncrement(AbutBody body, Vec contact, Vec w)
{
  Vec       force;
  PetscReal size, rtol;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  PetscCall(AbutBodyNeedSetUp_Private(body));
  PetscCall(PetscLogEventBegin(ABUTBODY_Solve, body, 0, 0, 0));
  PetscCall(AbutBodyGetGroupVec_Private(body, contact, &force));
  PetscCall(VecCopy(force, body->rhs));
  PetscCall(AbutBodyRestoreGroupVec_Private(body, contact, &force));
  PetscCall(VecISSet(body->rhs, body->constrained, 0.));
  PetscCall(VecZeroEntries(w));
  PetscCall(AbutBodyCleanRightHandSide_Private(body, &size));
  PetscCall(KSPGetTolerances(body->ksp, &rtol, NULL, NULL, NULL));
  if (size == 0.) body->ksp->reason = KSP_CONVERGED_ATOL;
  else {
    const PetscReal enough = PetscMax(rtol, PetscMin(ABUT_INCREMENT, 0.5 * rtol * body->whole / size));

    PetscCall(KSPSetTolerances(body->ksp, enough, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
    PetscCall(AbutBodySolveLinear_Private(body, w));
    PetscCall(KSPSetTolerances(body->ksp, rtol, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  }
  PetscCall(PetscLogEventEnd(ABUTBODY_Solve, body, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyUpdate - Adds to the displacement of a body, and to the contact forces on it

   Collective

   Input Parameters:
+  body    - the body, set up
.  contact - nodal contact forces to add, stress times length, or `NULL` for none
-  w       - displacement to add, length, as of `AbutBodySolveIncrement()`, or `NULL` for none

   Level: intermediate

.seealso: `AbutBodySolveIncrement()`, `AbutBodyMove()`
@*/
PetscErrorCode AbutBodyUpdate(AbutBody body, Vec contact, Vec w)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  PetscCall(AbutBodyNeedSetUp_Private(body));
  if (contact) PetscCall(VecAXPY(body->contact, 1., contact));
  if (!w) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecAXPY(body->u, 1., w));
  PetscCall(AbutBodySpread_Private(body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetSolution - The displacement of the last solve

   Not Collective

   Input Parameter:
.  body - the body

   Output Parameter:
.  u - displacements, length, owned by the body

   Level: beginner

.seealso: `AbutBodySolve()`, `AbutBodyGetNodeDisplacement()`
@*/
PetscErrorCode AbutBodyGetSolution(AbutBody body, Vec *u)
{
  PetscFunctionBegin;
  *u = body->u;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyGetNodeDisplacement - The displacement of the last solve at all local nodes, hanging ones included; vertices come first

   Not Collective

   Input Parameter:
.  body - the body

   Output Parameter:
.  u - [2*nnodes] displacements, length, in the order of `AbutMeshTopology`, owned by the body

   Level: intermediate

.seealso: `AbutBodyGetSolution()`, `AbutMeshGetTopology()`
@*/
PetscErrorCode AbutBodyGetNodeDisplacement(AbutBody body, const PetscReal *u[])
{
  PetscFunctionBegin;
  *u = body->nodeu;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetSolveCounts - How often the body was solved, and the iterations this took

   Not Collective

   Input Parameter:
.  body - the body

   Output Parameters:
+  solves     - since the body was created
-  iterations - of its `KSP`, all solves together; of both those before the last `AbutBodyGetSolved()` at least

   Level: intermediate

.seealso: `AbutBodySolve()`
@*/
PetscErrorCode AbutBodyGetSolveCounts(AbutBody body, PetscInt *solves, PetscInt *iterations)
{
  PetscFunctionBegin;
  *solves     = body->solves;
  *iterations = body->iterations;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* b - A u of the present state and the size of b, both without what the free modes leave without an answer, for the group */
static PetscErrorCode AbutBodyCreateResidual_Private(AbutBody body, Vec *r, PetscReal *b)
{
  Vec u;

  PetscFunctionBegin;
  PetscCall(AbutBodyNeedSetUp_Private(body));
  PetscCall(VecDuplicate(body->rhs, r));
  PetscCall(AbutBodyRightHandSide_Private(body, body->rhs));
  PetscCall(MatNullSpaceRemove(body->free, body->rhs));
  PetscCall(VecNorm(body->rhs, NORM_2, b));
  PetscCall(AbutBodyGetGroupVec_Private(body, body->u, &u));
  PetscCall(MatMult(body->A, u, *r));
  PetscCall(AbutBodyRestoreGroupVec_Private(body, body->u, &u));
  PetscCall(VecAYPX(*r, -1., body->rhs));
  PetscCall(MatNullSpaceRemove(body->free, *r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyArchive - The mesh of a body and its counts of solves into an archive, or out of one

   Collective

   Input Parameters:
+  body - the body, whose mesh keeps a journal
-  ar   - the archive

   Level: developer

   Note:
   Displacements are not in it: the next solve finds them.

.seealso: `AbutMeshArchive()`, `AbutBodyGetSolveCounts()`
@*/
PetscErrorCode AbutBodyArchive(AbutBody body, AbutArchive ar)
{
  PetscInt count[2] = {body->solves, body->iterations};

  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  PetscCall(AbutArchiveFit(ar, "body", ((PetscObject)body)->name));
  PetscCall(AbutMeshArchive(body->mesh, ar));
  PetscCall(AbutArchiveInts(ar, "solves", 2, count));
  body->solves     = count[0];
  body->iterations = count[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetLinearResidual - The true residual of a body as it now is, after solves, updates and moves

   Collective

   Input Parameter:
.  body - the body, solved

   Output Parameter:
.  residual - |b - A u|/|b| without the parts along the free modes; |b - A u| for a body without load

   Level: intermediate

.seealso: `AbutBodySolve()`, `AbutBodyUpdate()`, `AbutBodyGetLinearError()`
@*/
PetscErrorCode AbutBodyGetLinearResidual(AbutBody body, PetscReal *residual)
{
  Vec       r;
  PetscReal b, e;

  PetscFunctionBegin;
  PetscCall(AbutBodyCreateResidual_Private(body, &r, &b));
  PetscCall(VecNorm(r, NORM_2, &e));
  PetscCall(VecDestroy(&r));
  *residual = b > 0. ? e / b : e;
  PetscCall(AbutBodyShare_Private(body, 1, residual));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetLinearError - How far the displacement of a body is from that of an exact linear solver, in the energy norm

   Collective

   Input Parameter:
.  body - the body, solved

   Output Parameter:
.  energy - estimate of the square root of a(e,e), e the error of the linear solver; its square has the unit of `AbutBodyGetEnergy()`

   Level: intermediate

   Note:
   The square root of r.Br, r the true residual of the present state, B one application of the preconditioner: exact for a direct factor.

.seealso: `AbutBodyGetLinearResidual()`, `AbutBodyGetEnergy()`
@*/
PetscErrorCode AbutBodyGetLinearError(AbutBody body, PetscReal *energy)
{
  Vec         r, z;
  PC          pc;
  PetscReal   b;
  PetscScalar dot;

  PetscFunctionBegin;
  PetscCall(AbutBodyCreateResidual_Private(body, &r, &b));
  PetscCall(VecDuplicate(r, &z));
  if (body->here) {
    PetscCall(KSPSetUp(body->ksp));
    PetscCall(KSPGetPC(body->ksp, &pc));
    PetscCall(PCApply(pc, r, z));
  }
  PetscCall(VecDot(r, z, &dot));
  PetscCall(VecDestroy(&r));
  PetscCall(VecDestroy(&z));
  *energy = PetscSqrtReal(PetscMax(dot, 0.)); /* round-off of a residual that is nothing else */
  PetscCall(AbutBodyShare_Private(body, 1, energy));
  PetscFunctionReturn(PETSC_SUCCESS);
}
