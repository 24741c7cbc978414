#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/
#include <petsc/private/kspimpl.h> /* ksp->reason: there is no setter */

/* Below this many unknowns a direct factor pays: it is used for every sweep, and takes 1 kB per unknown */
#define ABUT_DIRECT_UNKNOWNS 1000000

static PetscErrorCode AbutBodySetDirect_Private(AbutBody body)
{
  PC pc;

  PetscFunctionBegin;
  PetscCall(KSPGetPC(body->ksp, &pc));
  PetscCall(KSPSetType(body->ksp, KSPPREONLY));
  PetscCall(PCSetType(pc, PCCHOLESKY));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutBodySetIterative_Private(AbutBody body)
{
  PC pc;

  PetscFunctionBegin;
  PetscCall(KSPGetPC(body->ksp, &pc));
  PetscCall(KSPSetType(body->ksp, KSPCG));
  PetscCall(KSPSetNormType(body->ksp, KSP_NORM_UNPRECONDITIONED));
  PetscCall(KSPSetTolerances(body->ksp, 1e-10, PETSC_DEFAULT, PETSC_DEFAULT, 1000));
  PetscCall(KSPSetInitialGuessNonzero(body->ksp, PETSC_TRUE)); /* the last sweep's displacement */
  PetscCall(PCSetType(pc, PCHYPRE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whoever reads no options gets the direct factor */
PetscErrorCode AbutBodyCreateSolver_Private(AbutBody body)
{
  PetscFunctionBegin;
  PetscCall(KSPCreate(PetscObjectComm((PetscObject)body), &body->ksp));
  PetscCall(KSPSetOptionsPrefix(body->ksp, ((PetscObject)body)->prefix));
  PetscCall(AbutBodySetDirect_Private(body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Multigrid keeps what belongs to its first matrix (BoomerAMG the numbering of the unknowns, GAMG the sizes of its levels) and goes astray when a larger one
   follows: each mesh gets a new preconditioner. At our strong threshold BoomerAMG takes 8 iterations where hypre's own 0.25 takes 94. */
static PetscErrorCode AbutBodyRenewPreconditioner_Private(AbutBody body)
{
  char      name[256], type[64];
  PetscBool factor, given = PETSC_TRUE;
  PCType    present;
  PC        pc;

  PetscFunctionBegin;
  PetscCall(KSPGetPC(body->ksp, &pc));
  PetscCall(PetscObjectTypeCompareAny((PetscObject)pc, &factor, PCCHOLESKY, PCLU, ""));
  if (factor) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PCGetType(pc, &present));
  PetscCall(PetscStrncpy(type, present, sizeof(type)));
  PetscCall(PetscSNPrintf(name, sizeof(name), "-%spc_hypre_boomeramg_strong_threshold", ((PetscObject)body)->prefix));
  if (!strcmp(type, PCHYPRE)) PetscCall(PetscOptionsHasName(NULL, NULL, name, &given));
  if (!given) PetscCall(PetscOptionsSetValue(NULL, name, "0.5"));
  PetscCall(PCSetType(pc, PCNONE));
  PetscCall(PCSetType(pc, type));
  PetscCall(PCSetFromOptions(pc));
  if (!given) PetscCall(PetscOptionsClearValue(NULL, name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* With the 20 per cent of spare workspace that are its default, MUMPS 5.7 returns NaN from some symmetric factors on 3 or 4 ranks, and no error; with 35 it
   did not any more. A -mat_mumps_icntl_14 of the user comes later. */
PetscErrorCode AbutBodyGiveFactorRoom_Private(AbutBody body)
{
  MatSolverType solver = NULL;
  PetscBool     mumps;
  PC            pc;
  Mat           factor;

  PetscFunctionBegin;
  PetscCall(KSPGetPC(body->ksp, &pc));
  PetscCall(PCFactorGetMatSolverType(pc, &solver));
  PetscCall(PetscStrcmp(solver, MATSOLVERMUMPS, &mumps));
  if (!mumps) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PCFactorSetUpMatSolverType(pc));
  PetscCall(PCFactorGetMatrix(pc, &factor));
  PetscCall(MatMumpsSetIcntl(factor, 14, 60));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Our defaults first, the user's options over them. Before the first mesh its size is not known, and taken as small. */
PetscErrorCode AbutBodyChooseSolver_Private(AbutBody body, PetscInt n, PetscBool readoptions)
{
  const char *prefix     = ((PetscObject)body)->prefix;
  char        pctype[64] = "";
  PetscBool   haspc, hasksp, factor;
  PC          pc;

  PetscFunctionBegin;
  if (readoptions || (!body->userksp && n > ABUT_DIRECT_UNKNOWNS)) {
    PetscCall(PetscOptionsGetString(NULL, prefix, "-pc_type", pctype, sizeof(pctype), &haspc));
    PetscCall(PetscOptionsHasName(NULL, prefix, "-ksp_type", &hasksp));
    body->userksp = (PetscBool)(haspc || hasksp);
    factor        = (PetscBool)(!haspc || !strcmp(pctype, PCCHOLESKY) || !strcmp(pctype, PCLU));
    PetscCall((factor && n <= ABUT_DIRECT_UNKNOWNS ? AbutBodySetDirect_Private : AbutBodySetIterative_Private)(body));
    PetscCall(KSPGetPC(body->ksp, &pc));
    if (haspc) {
      PetscCall(PCSetType(pc, pctype));
      if (factor) PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
    }
    PetscCall(KSPSetFromOptions(body->ksp));
  }
  PetscCall(AbutBodyRenewPreconditioner_Private(body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Displacement at every local vertex: that of a hanging one is the mean of the ends of the coarse side */
static PetscErrorCode AbutBodySpread_Private(AbutBody body)
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
  for (PetscInt v = 0; v < t->nvertices; ++v)
    for (PetscInt d = 0; d < 2; ++d) {
      const PetscInt *a = t->anchor + 2 * v;

      body->vertexu[2 * v + d] = a[0] < 0 ? ua[2 * t->unknown[v] + d] : 0.5 * (ua[2 * t->unknown[a[0]] + d] + ua[2 * t->unknown[a[1]] + d]);
    }
  PetscCall(VecRestoreArrayRead(local, &ua));
  PetscCall(VecGhostRestoreLocalForm(body->u, &local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodySolve - Solves the body with given nodal contact forces: one body's part of a sweep, eq. (20) of the paper

   Collective

   Input Parameters:
+  body    - the body; set up if need be
-  contact - nodal contact forces, stress times length, of the layout of `AbutBodyCreateVec()`, or `NULL` for none

   Level: beginner

   Note:
   Whether the linear solver converged is asked of its `KSP`, see `AbutBodyGetKSP()`.

.seealso: `AbutBodyGetSolution()`, `AbutBodyGetVertexDisplacement()`, `AbutBodyGetCellStress()`
@*/
PetscErrorCode AbutBodySolve(AbutBody body, Vec contact)
{
  PetscInt           its, first;
  PetscReal          size;
  const PetscInt    *row;
  const PetscScalar *g;
  PetscScalar       *b;
  PetscInt           n;

  PetscFunctionBegin;
  PetscCall(AbutBodySetUp(body));
  PetscCall(PetscLogEventBegin(ABUTBODY_Solve, body, 0, 0, 0));
  if (contact) PetscCall(VecCopy(contact, body->contact));
  else PetscCall(VecZeroEntries(body->contact));
  PetscCall(VecWAXPY(body->rhs, 1., body->load, body->contact));
  PetscCall(VecAXPY(body->rhs, 1., body->lift));
  PetscCall(VecGetOwnershipRange(body->rhs, &first, NULL));
  PetscCall(ISGetLocalSize(body->constrained, &n));
  PetscCall(ISGetIndices(body->constrained, &row));
  PetscCall(VecGetArrayRead(body->prescribed, &g));
  PetscCall(VecGetArray(body->rhs, &b));
  for (PetscInt i = 0; i < n; ++i) b[row[i] - first] = body->mu * g[i];
  PetscCall(VecRestoreArray(body->rhs, &b));
  PetscCall(VecRestoreArrayRead(body->prescribed, &g));
  PetscCall(ISRestoreIndices(body->constrained, &row));
  PetscCall(KSPSolve(body->ksp, body->rhs, body->u));
  PetscCall(VecNorm(body->u, NORM_INFINITY, &size));
  if (PetscIsInfOrNanReal(size)) { /* a factor may be spoilt without saying so: the caller asks the KSP, and finds zeros instead of NaN */
    body->ksp->reason = KSP_DIVERGED_NANORINF;
    PetscCall(VecZeroEntries(body->u));
  }
  PetscCall(KSPGetIterationNumber(body->ksp, &its));
  ++body->solves;
  body->iterations += its;
  PetscCall(AbutBodySpread_Private(body));
  PetscCall(PetscLogEventEnd(ABUTBODY_Solve, body, 0, 0, 0));
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

.seealso: `AbutBodySolve()`, `AbutBodyGetVertexDisplacement()`
@*/
PetscErrorCode AbutBodyGetSolution(AbutBody body, Vec *u)
{
  PetscFunctionBegin;
  *u = body->u;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyGetVertexDisplacement - The displacement of the last solve at all local vertices, hanging ones included

   Not Collective

   Input Parameter:
.  body - the body

   Output Parameter:
.  u - [2*nvertices] displacements, length, in the order of `AbutMeshTopology`, owned by the body

   Level: intermediate

.seealso: `AbutBodyGetSolution()`, `AbutMeshGetTopology()`
@*/
PetscErrorCode AbutBodyGetVertexDisplacement(AbutBody body, const PetscReal *u[])
{
  PetscFunctionBegin;
  *u = body->vertexu;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetSolveCounts - How often the body was solved, and the iterations this took

   Not Collective

   Input Parameter:
.  body - the body

   Output Parameters:
+  solves     - since the body was created
-  iterations - of its `KSP`, all solves together

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

/*@
   AbutBodyGetLinearResidual - The true residual of the last linear solve

   Collective

   Input Parameter:
.  body - the body

   Output Parameter:
.  residual - |b - A u|/|b|, 0 for a body without load

   Level: intermediate

.seealso: `AbutBodySolve()`
@*/
PetscErrorCode AbutBodyGetLinearResidual(AbutBody body, PetscReal *residual)
{
  Vec       r;
  PetscReal b, e;

  PetscFunctionBegin;
  PetscCall(VecDuplicate(body->rhs, &r));
  PetscCall(MatMult(body->A, body->u, r));
  PetscCall(VecAYPX(r, -1., body->rhs));
  PetscCall(VecNorm(r, NORM_2, &e));
  PetscCall(VecNorm(body->rhs, NORM_2, &b));
  PetscCall(VecDestroy(&r));
  *residual = b > 0. ? e / b : e;
  PetscFunctionReturn(PETSC_SUCCESS);
}
