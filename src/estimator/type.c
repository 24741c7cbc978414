#include <abut/private/estimatorimpl.h> /*I "abutestimator.h" I*/

/* What a type of estimator, mostly a plugin, tells the class and keeps there */

/*@C
   AbutEstimatorSetOps - Says what a type does; called by the create routine of the type

   Logically Collective

   Input Parameters:
+  est - the estimator
-  ops - its functions, copied; `estimate` is required

   Level: advanced

.seealso: `AbutEstimatorRegister()`, `AbutEstimatorSetData()`
@*/
PetscErrorCode AbutEstimatorSetOps(AbutEstimator est, const AbutEstimatorOps *ops)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(est, ABUTESTIMATOR_CLASSID, 1);
  *est->ops = *ops;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEstimatorSetFeatures - Says what a type can do beyond plane strain with tractions and contact; called by the create routine of the
   type

   Logically Collective

   Input Parameters:
+  est      - the estimator
-  features - the sum of `ABUT_FEATURE_BODY_FORCE_CONSTANT` and so on

   Level: advanced

   Note:
   A type that says nothing is not given a body that has any of them: `AbutEstimatorCheck()` refuses it.

.seealso: `AbutEstimatorSetOps()`, `AbutEstimatorCheck()`, `AbutBodyGetFeatures()`
@*/
PetscErrorCode AbutEstimatorSetFeatures(AbutEstimator est, PetscInt features)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(est, ABUTESTIMATOR_CLASSID, 1);
  est->features = features;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutEstimatorSetAbout - Says in one line what a type compares, for `abut -list`; called by the create routine of the type

   Logically Collective

   Input Parameters:
+  est   - the estimator
-  about - the line, not copied

   Level: advanced

.seealso: `AbutEstimatorSetOps()`, `AbutEstimatorViewTypes()`
@*/
PetscErrorCode AbutEstimatorSetAbout(AbutEstimator est, const char about[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(est, ABUTESTIMATOR_CLASSID, 1);
  est->about = about;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEstimatorSetData - Gives an estimator the data of its type

   Logically Collective

   Input Parameters:
+  est  - the estimator
-  data - anything; the `destroy` of the type frees it

   Level: advanced

.seealso: `AbutEstimatorGetData()`, `AbutEstimatorSetOps()`
@*/
PetscErrorCode AbutEstimatorSetData(AbutEstimator est, void *data)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(est, ABUTESTIMATOR_CLASSID, 1);
  est->data = data;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEstimatorGetData - Gets the data of the type

   Not Collective

   Input Parameter:
.  est - the estimator

   Output Parameter:
.  data - the address of a pointer to what `AbutEstimatorSetData()` was given

   Level: advanced

.seealso: `AbutEstimatorSetData()`
@*/
PetscErrorCode AbutEstimatorGetData(AbutEstimator est, void *data)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(est, ABUTESTIMATOR_CLASSID, 1);
  *(void **)data = est->data;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEstimatorSetUnknowns - Says how many unknowns the type solved for in this estimate, beside those of the body

   Logically Collective

   Input Parameters:
+  est - the estimator
-  n   - over all ranks, 0 for a type that solves nothing

   Level: advanced

.seealso: `AbutEstimatorGetUnknowns()`
@*/
PetscErrorCode AbutEstimatorSetUnknowns(AbutEstimator est, PetscInt n)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(est, ABUTESTIMATOR_CLASSID, 1);
  est->unknowns = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEstimatorGetUnknowns - Gets how many unknowns the last estimate solved for, beside those of the body

   Not Collective

   Input Parameter:
.  est - the estimator

   Output Parameter:
.  n - over all ranks; the boundary elements of `ABUTESTIMATORFEMBEM` count here, 0 for most types

   Level: intermediate

.seealso: `AbutEstimatorEstimate()`
@*/
PetscErrorCode AbutEstimatorGetUnknowns(AbutEstimator est, PetscInt *n)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(est, ABUTESTIMATOR_CLASSID, 1);
  *n = est->unknowns;
  PetscFunctionReturn(PETSC_SUCCESS);
}
