#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/

/* One factor for all that is prescribed: what load steps change between two solves on one mesh */

/* What acts on the body beside the tractions of its conditions, and the factor of all */
PetscErrorCode AbutBodyLoadsSetUp_Private(AbutBody body)
{
  PetscFunctionBegin;
  PetscCall(AbutBodyHookForces_Private(body));
  PetscCall(VecScale(body->load, body->factor));
  if (body->initial) PetscCall(AbutBodyInitialSetUp_Private(body)); /* knows the factor */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the prescribed displacements put on the right-hand side */
PetscErrorCode AbutBodyLift_Private(AbutBody body)
{
  Vec lift;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetGroupVec_Private(body, body->lift, &lift));
  PetscCall(MatMultTranspose(body->Ac, body->prescribed, lift));
  PetscCall(AbutBodyRestoreGroupVec_Private(body, body->lift, &lift));
  PetscCall(VecScale(body->lift, -1.));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodySetLoadFactor - Multiplies all that is prescribed on a body: displacements and loads

   Collective

   Input Parameters:
+  body   - the body
-  factor - the factor, any finite number, 1 in a new body

   Level: intermediate

   Notes:
   Stays on later meshes. On a mesh that is set up matrix and factors stay, and the displacement becomes zero, as on a new mesh; the next
   `AbutBodySolve()` finds it.

   The gaps of pairs are no load and stay.

.seealso: `AbutBodyGetLoadFactor()`, `AbutBodySetDisplacement()`, `AbutBodySetTraction()`, `AbutSceneSolve()`
@*/
PetscErrorCode AbutBodySetLoadFactor(AbutBody body, PetscReal factor)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  PetscCheck(!PetscIsInfOrNanReal(factor), PetscObjectComm((PetscObject)body), PETSC_ERR_ARG_OUTOFRANGE, "Load factor %g is not finite",
             (double)factor);
  if (factor == body->factor) PetscFunctionReturn(PETSC_SUCCESS);
  body->factor = factor;
  if (body->generation < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ISDestroy(&body->constrained));
  PetscCall(VecDestroy(&body->prescribed));
  PetscCall(AbutBodyConditionsSetUp_Private(body));
  PetscCall(AbutBodyLoadsSetUp_Private(body));
  PetscCall(AbutBodyLift_Private(body));
  PetscCall(VecZeroEntries(body->u));
  PetscCall(AbutBodySpread_Private(body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetLoadFactor - The factor of all that is prescribed on a body

   Not Collective

   Input Parameter:
.  body - the body

   Output Parameter:
.  factor - the factor

   Level: intermediate

.seealso: `AbutBodySetLoadFactor()`
@*/
PetscErrorCode AbutBodyGetLoadFactor(AbutBody body, PetscReal *factor)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  *factor = body->factor;
  PetscFunctionReturn(PETSC_SUCCESS);
}
