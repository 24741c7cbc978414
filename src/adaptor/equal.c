#include <abut/private/adaptorimpl.h> /*I "abutadaptor.h" I*/

/* Equal: every cell is to have the same part of the error, after O. C. Zienkiewicz and J. Z. Zhu, A simple error estimator and adaptive
   procedure for practical engineering analysis, Int. J. Numer. Meth. Engng. 24 (1987): done when the total error is at most the target;
   until then the cells with more than their part, target/sqrt(cells), are refined. Of these only the worst: what is better than the worst
   will be after a refinement can wait, and so can what is not needed for the target if a refined cell keeps half of its error. It is the
   total error that counts, so unlike a threshold on the pointwise indicator it ends at a singularity.
   Limits: it never coarsens; the half is right where the stress is smooth, elsewhere it takes a cycle more. */
typedef struct {
  PetscReal target;    /* relative error of all bodies together */
  PetscReal allowance; /* relative error that a cell of the body marked next may have */
} AbutAdaptor_Equal;

#define ABUT_BINS   400
#define ABUT_OCTAVE 8    /* bins for a factor of two in the square of the error */
#define ABUT_KEPT   0.25 /* part of the square of a cell's error that its children have together; a child has the square of it */
#define ABUT_GOAL   0.9  /* of the target: to meet it with the next mesh, not almost */

/* Squares of the errors of all cells by size: bin k has those below the largest by k/ABUT_OCTAVE to (k+1)/ABUT_OCTAVE factors of two */
typedef struct {
  PetscReal sum, largest, norm2, cells, bin[ABUT_BINS];
} AbutErrorSizes;

/* eta_e^2 |e|/|Omega| of every local cell: the square of its part of the body's relative error */
static PetscErrorCode AbutAdaptorGetCellErrors_Private(AbutBody body, PetscInt n, const PetscReal eta[], PetscReal e2[])
{
  AbutMesh  mesh;
  PetscReal whole = 0.;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  for (PetscInt c = 0; c < n; ++c) {
    PetscReal area;

    PetscCall(AbutMeshGetCellArea(mesh, c, &area));
    whole += area;
    e2[c] = area * PetscSqr(eta[c]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &whole, 1, MPIU_REAL, MPIU_SUM, PetscObjectComm((PetscObject)body)));
  for (PetscInt c = 0; c < n; ++c) e2[c] /= whole;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of all bodies that have indicators, in energy; two rounds over the cells, the second into the bins */
static PetscErrorCode AbutAdaptorGetErrorSizes_Private(PetscInt n, AbutBody body[], Vec eta[], const PetscReal norm[],
                                                       AbutErrorSizes *sizes)
{
  PetscFunctionBegin;
  PetscCall(PetscMemzero(sizes, sizeof(*sizes)));
  for (PetscInt round = 0; round < 2; ++round) {
    MPI_Comm comm = MPI_COMM_NULL;

    for (PetscInt b = 0; b < n; ++b) {
      const PetscReal *e;
      PetscReal       *e2;
      PetscInt         cells;

      if (!eta[b]) continue;
      comm = PetscObjectComm((PetscObject)body[b]);
      PetscCall(VecGetLocalSize(eta[b], &cells));
      PetscCall(PetscMalloc1(cells, &e2));
      PetscCall(VecGetArrayRead(eta[b], &e));
      PetscCall(AbutAdaptorGetCellErrors_Private(body[b], cells, e, e2));
      PetscCall(VecRestoreArrayRead(eta[b], &e));
      if (!round) {
        sizes->norm2 += PetscSqr(norm[b]);
        sizes->cells += cells;
      }
      for (PetscInt c = 0; c < cells; ++c) {
        const PetscReal square = e2[c] * PetscSqr(norm[b]);

        if (!round) {
          sizes->sum += square;
          sizes->largest = PetscMax(sizes->largest, square);
        } else if (square > 0.) {
          sizes->bin[(PetscInt)PetscMin(ABUT_BINS - 1., ABUT_OCTAVE * PetscLog2Real(sizes->largest / square))] += square;
        }
      }
      PetscCall(PetscFree(e2));
    }
    if (comm == MPI_COMM_NULL) break;
    if (!round) {
      PetscReal sum[2] = {sizes->sum, sizes->cells};

      PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPIU_SUM, comm));
      PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sizes->largest, 1, MPIU_REAL, MPIU_MAX, comm));
      sizes->sum   = sum[0];
      sizes->cells = sum[1];
    } else PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sizes->bin, ABUT_BINS, MPIU_REAL, MPIU_SUM, comm));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutAdaptorGetAllowances - What a cell of each body may have of the error, if several bodies share one target

   Collective

   Input Parameters:
+  adaptor - the adaptor, of type `ABUTADAPTOREQUAL`
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
  AbutErrorSizes sizes;
  PetscReal      target, target2, left, square = 0.;

  PetscFunctionBegin;
  PetscCall(AbutAdaptorGetTarget(adaptor, &target));
  PetscCall(AbutAdaptorGetErrorSizes_Private(n, body, eta, norm, &sizes));
  target2 = PetscSqr(target) * sizes.norm2;
  left    = sizes.sum;
  for (PetscInt k = 0; k < ABUT_BINS && left > PetscSqr(ABUT_GOAL) * target2; ++k) {
    left -= (1. - ABUT_KEPT) * sizes.bin[k];
    square = k < ABUT_BINS - 1 ? sizes.largest * PetscPowReal(2., -(k + 1.) / ABUT_OCTAVE) : 0.;
  }
  square = PetscMax(square, PetscSqr(ABUT_KEPT) * sizes.largest);
  if (sizes.cells > 0.) square = PetscMax(square, target2 / sizes.cells);
  for (PetscInt b = 0; b < n; ++b) allowance[b] = sizes.sum > target2 && norm[b] > 0. ? PetscSqrtReal(square) / norm[b] : PETSC_MAX_REAL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutAdaptorMark_Equal(AbutAdaptor adaptor, AbutBody body, PetscInt n, const PetscReal eta[], PetscBool mark[])
{
  const AbutAdaptor_Equal *eq = (const AbutAdaptor_Equal *)adaptor->data;
  PetscReal               *e2;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &e2));
  PetscCall(AbutAdaptorGetCellErrors_Private(body, n, eta, e2));
  for (PetscInt c = 0; c < n; ++c) mark[c] = (PetscBool)(PetscSqrtReal(e2[c]) > eq->allowance);
  PetscCall(PetscFree(e2));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutAdaptorSetFromOptions_Equal(AbutAdaptor adaptor, AbutOptionItems PetscOptionsObject)
{
  AbutAdaptor_Equal *eq = (AbutAdaptor_Equal *)adaptor->data;

  PetscFunctionBegin;
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-adaptor_target",
                            "relative error of all adapted bodies together at which the adaptation ends", &eq->target, NULL));
  AbutCheckInput(eq->target > 0. && eq->target < 1., PetscObjectComm((PetscObject)adaptor),
                 "adaptor_target: %g is not a relative error; give a number between 0 and 1, for example 0.05", (double)eq->target);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutAdaptorView_Equal(AbutAdaptor adaptor, PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "equal error in all cells, until all together have at most %g\n",
                                   (double)((AbutAdaptor_Equal *)adaptor->data)->target));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutAdaptorDestroy_Equal(AbutAdaptor adaptor)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(adaptor->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutAdaptorCreate_Equal(AbutAdaptor adaptor)
{
  AbutAdaptor_Equal *eq;

  PetscFunctionBegin;
  PetscCall(PetscNew(&eq));
  eq->target                   = 0.05;
  eq->allowance                = PETSC_MAX_REAL;
  adaptor->data                = eq;
  adaptor->ops->mark           = AbutAdaptorMark_Equal;
  adaptor->ops->setfromoptions = AbutAdaptorSetFromOptions_Equal;
  adaptor->ops->view           = AbutAdaptorView_Equal;
  adaptor->ops->destroy        = AbutAdaptorDestroy_Equal;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutAdaptorGetEqual_Private(AbutAdaptor adaptor, AbutAdaptor_Equal **eq)
{
  PetscBool same;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(adaptor, ABUTADAPTOR_CLASSID, 1);
  PetscCall(PetscObjectTypeCompare((PetscObject)adaptor, ABUTADAPTOREQUAL, &same));
  *eq = same ? (AbutAdaptor_Equal *)adaptor->data : NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutAdaptorSetTarget - Sets the relative error at which the adaptation ends

   Logically Collective

   Input Parameters:
+  adaptor - the adaptor; nothing happens if its type is not `ABUTADAPTOREQUAL`
-  target  - of all adapted bodies together, between 0 and 1

   Options Database Key:
.  -adaptor_target <0.05> - with -adaptor_type equal

   Level: intermediate

.seealso: `AbutAdaptorGetTarget()`, `AbutAdaptorSetAllowance()`
@*/
PetscErrorCode AbutAdaptorSetTarget(AbutAdaptor adaptor, PetscReal target)
{
  AbutAdaptor_Equal *eq = NULL;

  PetscFunctionBegin;
  PetscCall(AbutAdaptorGetEqual_Private(adaptor, &eq));
  if (eq) eq->target = target;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutAdaptorGetTarget - Gets the relative error at which the adaptation ends

   Not Collective

   Input Parameter:
.  adaptor - the adaptor

   Output Parameter:
.  target - of all adapted bodies together; 0 if the type is not `ABUTADAPTOREQUAL`

   Level: intermediate

.seealso: `AbutAdaptorSetTarget()`
@*/
PetscErrorCode AbutAdaptorGetTarget(AbutAdaptor adaptor, PetscReal *target)
{
  AbutAdaptor_Equal *eq = NULL;

  PetscFunctionBegin;
  PetscCall(AbutAdaptorGetEqual_Private(adaptor, &eq));
  *target = eq ? eq->target : 0.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutAdaptorSetAllowance - Sets the part of the error that a cell of the body marked next may have

   Logically Collective

   Input Parameters:
+  adaptor   - the adaptor; nothing happens if its type is not `ABUTADAPTOREQUAL`
-  allowance - of eta_e sqrt(|e|/|Omega|), as `AbutAdaptorGetAllowances()` gives it

   Level: developer

.seealso: `AbutAdaptorGetAllowances()`, `AbutAdaptorMark()`
@*/
PetscErrorCode AbutAdaptorSetAllowance(AbutAdaptor adaptor, PetscReal allowance)
{
  AbutAdaptor_Equal *eq = NULL;

  PetscFunctionBegin;
  PetscCall(AbutAdaptorGetEqual_Private(adaptor, &eq));
  if (eq) eq->allowance = allowance;
  PetscFunctionReturn(PETSC_SUCCESS);
}
