#include <abut/private/adaptorimpl.h> /*I "abutadaptor.h" I*/

/* Types with a target: the error that all adapted bodies may have together; what of it a cell may have is the type's to say */

/* eta_e^2 |e|/|Omega| of every local cell: the square of its part of the body's relative error */
static PetscErrorCode AbutAdaptorGetCellErrors_Private(AbutBody body, PetscInt n, const PetscReal eta[], PetscReal e2[])
{
  PetscReal whole = 0.;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < n; ++c) {
    PetscReal area;

    PetscCall(AbutBodyGetCellMeasure(body, c, &area));
    whole += area;
    e2[c] = area * PetscSqr(eta[c]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &whole, 1, MPIU_REAL, MPIU_SUM, PetscObjectComm((PetscObject)body)));
  for (PetscInt c = 0; c < n; ++c) e2[c] /= whole;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The cells of all bodies that have indicators, in energy */
static PetscErrorCode AbutCellErrorsCreate_Private(MPI_Comm comm, PetscInt n, AbutBody body[], Vec eta[], const PetscReal norm[],
                                                   AbutCellErrors *errors)
{
  PetscReal sum[2] = {0., 0.};

  PetscFunctionBegin;
  PetscCall(PetscMemzero(errors, sizeof(*errors)));
  for (PetscInt pass = 0; pass < 2; ++pass) {
    PetscInt at = 0;

    if (pass) PetscCall(PetscMalloc1(errors->n, &errors->square));
    for (PetscInt b = 0; b < n; ++b) {
      const PetscReal *e;
      PetscInt         cells;

      if (!eta[b]) continue;
      PetscCall(VecGetLocalSize(eta[b], &cells));
      if (pass) {
        PetscCall(VecGetArrayRead(eta[b], &e));
        PetscCall(AbutAdaptorGetCellErrors_Private(body[b], cells, e, errors->square + at));
        PetscCall(VecRestoreArrayRead(eta[b], &e));
        for (PetscInt c = at; c < at + cells; ++c) errors->square[c] *= PetscSqr(norm[b]);
        errors->norm2 += PetscSqr(norm[b]);
      }
      at += cells;
    }
    errors->n = at;
  }
  sum[1] = errors->n;
  for (PetscInt c = 0; c < errors->n; ++c) {
    sum[0] += errors->square[c];
    errors->largest = PetscMax(errors->largest, errors->square[c]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPIU_SUM, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &errors->largest, 1, MPIU_REAL, MPIU_MAX, comm));
  errors->sum   = sum[0];
  errors->cells = sum[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutAdaptorGetAllowances - What a cell of each body may have of the error, if several bodies share one target

   Collective

   Input Parameters:
+  adaptor - the adaptor, of a type with a target
.  n       - bodies
.  body    - [n] the bodies
.  eta     - [n] their indicators, from `AbutEstimatorEstimate()`, or `NULL` for a body that is not adapted
-  norm    - [n] their energy norms: what their relative errors are to be multiplied with

   Output Parameter:
.  allowance - [n] for `AbutAdaptorSetAllowance()`; `PETSC_MAX_REAL` if the target is reached

   Level: developer

.seealso: `AbutAdaptorSetTarget()`, `AbutAdaptorMark()`
@*/
PetscErrorCode AbutAdaptorGetAllowances(AbutAdaptor adaptor, PetscInt n, AbutBody body[], Vec eta[], const PetscReal norm[],
                                        PetscReal allowance[])
{
  AbutCellErrors errors;
  PetscReal      target2, square = PETSC_MAX_REAL;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(adaptor, ABUTADAPTOR_CLASSID, 1);
  PetscCall(AbutCellErrorsCreate_Private(PetscObjectComm((PetscObject)adaptor), n, body, eta, norm, &errors));
  target2 = PetscSqr(adaptor->target) * errors.norm2;
  if (errors.sum > target2) PetscUseTypeMethod(adaptor, share, &errors, target2, &square);
  for (PetscInt b = 0; b < n; ++b) allowance[b] = errors.sum > target2 && norm[b] > 0. ? PetscSqrtReal(square) / norm[b] : PETSC_MAX_REAL;
  PetscCall(PetscFree(errors.square));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The mark of the types with a target */
PetscErrorCode AbutAdaptorMarkAllowance_Private(AbutAdaptor adaptor, AbutBody body, PetscInt n, const PetscReal eta[], PetscBool mark[])
{
  PetscReal *e2;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &e2));
  PetscCall(AbutAdaptorGetCellErrors_Private(body, n, eta, e2));
  for (PetscInt c = 0; c < n; ++c) mark[c] = (PetscBool)(PetscSqrtReal(e2[c]) > adaptor->allowance);
  PetscCall(PetscFree(e2));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutAdaptorTargetFromOptions_Private(AbutAdaptor adaptor, AbutOptionItems PetscOptionsObject)
{
  PetscFunctionBegin;
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-adaptor_target",
                            "relative error of all adapted bodies together at which the adaptation ends", &adaptor->target, NULL));
  AbutCheckInput(adaptor->target > 0. && adaptor->target < 1., PetscObjectComm((PetscObject)adaptor),
                 "adaptor_target: %g is not a relative error; give a number between 0 and 1, for example 0.05", (double)adaptor->target);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutAdaptorSetTarget - Sets the relative error at which the adaptation ends

   Logically Collective

   Input Parameters:
+  adaptor - the adaptor; nothing happens if its type has no target
-  target  - of all adapted bodies together, between 0 and 1

   Options Database Key:
.  -adaptor_target <0.05> - with -adaptor_type equal or doerfler

   Level: intermediate

.seealso: `AbutAdaptorGetTarget()`, `AbutAdaptorSetAllowance()`
@*/
PetscErrorCode AbutAdaptorSetTarget(AbutAdaptor adaptor, PetscReal target)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(adaptor, ABUTADAPTOR_CLASSID, 1);
  if (adaptor->ops->share) adaptor->target = target;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutAdaptorGetTarget - Gets the relative error at which the adaptation ends

   Not Collective

   Input Parameter:
.  adaptor - the adaptor

   Output Parameter:
.  target - of all adapted bodies together; 0 if the type has none

   Level: intermediate

.seealso: `AbutAdaptorSetTarget()`
@*/
PetscErrorCode AbutAdaptorGetTarget(AbutAdaptor adaptor, PetscReal *target)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(adaptor, ABUTADAPTOR_CLASSID, 1);
  *target = adaptor->ops->share ? adaptor->target : 0.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutAdaptorSetAllowance - Sets the part of the error that a cell of the body marked next may have

   Logically Collective

   Input Parameters:
+  adaptor   - the adaptor; nothing happens if its type has no target
-  allowance - of eta_e sqrt(|e|/|Omega|), as `AbutAdaptorGetAllowances()` gives it

   Level: developer

.seealso: `AbutAdaptorGetAllowances()`, `AbutAdaptorMark()`
@*/
PetscErrorCode AbutAdaptorSetAllowance(AbutAdaptor adaptor, PetscReal allowance)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(adaptor, ABUTADAPTOR_CLASSID, 1);
  if (adaptor->ops->share) adaptor->allowance = allowance;
  PetscFunctionReturn(PETSC_SUCCESS);
}
