#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/

/* What a body makes of a mesh, and frees with it */

/* What all ranks of the body make together: mesh, vectors, boundary, conditions, loads */
static PetscErrorCode AbutBodyDiscretize_Private(AbutBody body, PetscBool *anew)
{
  const AbutMeshTopology *t;
  PetscInt                generation;
  PetscLogDouble          begun, done;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  PetscCheck(body->young > 0., PetscObjectComm((PetscObject)body), PETSC_ERR_ARG_WRONGSTATE,
             "Call AbutBodySetMaterial() or AbutBodySetFromOptions() first");
  if (body->generation < 0) PetscCall(AbutBodyCheck(body));
  PetscCall(AbutMeshSetUp(body->mesh));
  PetscCall(AbutMeshGetGeneration(body->mesh, &generation));
  *anew = (PetscBool)(generation != body->generation);
  if (!*anew) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutBodyReset_Private(body));
  PetscCall(AbutGetProcessorTime(&begun));
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  PetscCall(PetscCalloc1(2 * t->nnodes, &body->nodeu));
  PetscCall(AbutElementCreate_Private(body->mesh, t->order + (t->corners == 4 || body->kinematics == ABUT_AXISYMMETRIC), &body->element));
  body->meandilatation = (PetscBool)(t->corners == 4 && t->order == 1 && body->kinematics != ABUT_PLANE_STRESS &&
                                     body->poisson > ABUT_ALMOST_INCOMPRESSIBLE);
  body->assembly       = ABUTBODY_Assemble;
  if (body->meandilatation) PetscCall(AbutLogEventGet("AbutDilatation", ABUTBODY_CLASSID, &body->assembly));
  PetscCall(VecCreateGhostBlock(PetscObjectComm((PetscObject)body), 2, 2 * t->nowned, PETSC_DECIDE, t->nunknown - t->nowned,
                                t->global + t->nowned, &body->u));
  PetscCall(AbutBodyCreateVec(body, &body->load));
  PetscCall(VecDuplicate(body->load, &body->lift));
  PetscCall(VecDuplicate(body->load, &body->contact));
  PetscCall(AbutBodyCreateVecOn_Private(body, body->group, &body->rhs));
  PetscCall(AbutBodyBoundarySetUp_Private(body));
  PetscCall(AbutBodyConditionsSetUp_Private(body));
  PetscCall(AbutBodyLoadsSetUp_Private(body));
  PetscCall(AbutBodyModesCreate_Private(body));
  /* ghost values are got by a scatter that all ranks set up at its first use: that must not come when bodies work side by side */
  PetscCall(VecGhostUpdateBegin(body->u, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGhostUpdateEnd(body->u, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(AbutGetProcessorTime(&done));
  body->setupcpu = done - begun;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What its group makes alone: operator and solver */
static PetscErrorCode AbutBodyMakeOperator_Private(AbutBody body)
{
  PetscInt       n;
  PetscLogDouble begun, done;

  PetscFunctionBegin;
  PetscCall(AbutGetProcessorTime(&begun));
  PetscCall(AbutBodyAssemble_Private(body));
  PetscCall(AbutBodyModesSetUp_Private(body));
  PetscCall(AbutBodyGetSize(body, &n));
  PetscCall(AbutBodyChooseSolver_Private(body, n, PETSC_FALSE));
  PetscCall(KSPSetOperators(body->ksp, body->A, body->P));
  if (body->here) {
    PetscCall(AbutBodyGiveFactorRoom_Private(body));
    PetscCall(AbutBodyFactor_Private(body));
  }
  PetscCall(AbutGetProcessorTime(&done));
  body->setupcpu += done - begun;
  PetscCall(AbutMeshGetGeneration(body->mesh, &body->generation));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodySetUpAll - Sets up several bodies, those on disjoint groups of ranks side by side

   Collective

   Input Parameters:
+  n      - how many
-  bodies - [n] the bodies

   Level: developer

.seealso: `AbutBodySetUp()`, `AbutBodySetRanks()`
@*/
PetscErrorCode AbutBodySetUpAll(PetscInt n, AbutBody bodies[])
{
  PetscBool *anew;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &anew));
  for (PetscInt b = 0; b < n; ++b) PetscCall(AbutBodyDiscretize_Private(bodies[b], &anew[b]));
  for (PetscInt b = 0; b < n; ++b)
    if (anew[b]) PetscCall(AbutBodyMakeOperator_Private(bodies[b]));
  PetscCall(PetscFree(anew));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodySetUp - Makes mesh, operator and vectors; after its mesh has adapted, makes them anew

   Collective

   Input Parameter:
.  body - the body

   Level: beginner

.seealso: `AbutBodySetFromOptions()`, `AbutBodySetUpAll()`, `AbutBodySolve()`
@*/
PetscErrorCode AbutBodySetUp(AbutBody body)
{
  PetscFunctionBegin;
  PetscCall(AbutBodySetUpAll(1, &body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* For what works on the vectors of a mesh */
PetscErrorCode AbutBodyNeedSetUp_Private(AbutBody body)
{
  PetscFunctionBegin;
  PetscCheck(body->generation >= 0, PetscObjectComm((PetscObject)body), PETSC_ERR_ARG_WRONGSTATE, "Call AbutBodySetUp() first");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Frees all that belongs to one mesh, the factor too: there is never room for two */
PetscErrorCode AbutBodyReset_Private(AbutBody body)
{
  PetscFunctionBegin;
  body->generation  = -1;
  body->strainknown = PETSC_FALSE;
  PetscCall(KSPReset(body->ksp));
  PetscCall(AbutBodyModesReset_Private(body));
  PetscCall(MatDestroy(&body->A));
  PetscCall(MatDestroy(&body->Ac));
  PetscCall(MatDestroy(&body->S));
  PetscCall(ISDestroy(&body->constrained));
  PetscCall(VecDestroy(&body->prescribed));
  PetscCall(VecDestroy(&body->load));
  PetscCall(VecDestroy(&body->initialload));
  PetscCall(VecDestroy(&body->lift));
  PetscCall(VecDestroy(&body->contact));
  PetscCall(VecDestroy(&body->rhs));
  PetscCall(VecDestroy(&body->u));
  PetscCall(AbutElementDestroy_Private(&body->element));
  PetscCall(PetscFree(body->nodeu));
  PetscCall(AbutBodyBoundaryReset_Private(body));
  PetscFunctionReturn(PETSC_SUCCESS);
}
