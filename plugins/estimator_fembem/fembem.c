#include <abutestimator.h>
#include "fembemimpl.h"

/*
   The estimator of the paper, eqs. (22)-(27): the stress of the finite elements against that of boundary elements on the trace of their
   mesh, eqs. (25) and (26). The boundary elements see the same data as the last solve of the body, eq. (20): given tractions as the load
   projected on the boundary elements, contact as nodal forces, supports as displacements. Boundary elements have the order of the finite
   elements: of order 1 they would be worse than finite elements of order 2.
   Limits: one homogeneous material, Poisson's ratio below 1/2, no body force that varies.
*/
typedef enum {
  FEMBEM_AUTO,
  FEMBEM_GALERKIN,
  FEMBEM_NONE
} FembemSolve;
static const char *const FembemSolves[] = {"auto", "galerkin", "none", NULL};

/* Above some hundred boundary elements the dense system takes longer than the body: 7 s against 1 s for 1400 elements around 150,000
   unknowns. Without it the estimate is as good on meshes as fine as these, but where the stress is singular C is .4 to .6, not .25 to .4 */
#define FEMBEM_AUTO_ELEMENTS 300

typedef struct {
  PetscInt     solve;     /* FembemSolve */
  PetscReal    tolerance; /* of the treecode; PETSC_DECIDE: by the order */
  PetscInt     max_elements;
  FembemStress stress; /* during an estimate */
} Fembem;

static PetscErrorCode FembemCompare(AbutEstimator est, AbutBody body, PETSC_UNUSED PetscInt c, PetscInt n,
                                    PETSC_UNUSED const PetscReal xi[], const PetscReal x[], PetscReal s[])
{
  Fembem *fembem;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &fembem));
  PetscCall(FembemStressEvaluate(fembem->stress, n, x, s));
  PetscCall(FembemAddForce(body, n, x, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the treecode adds to the error is to be well below that of the finite elements, also where these converge faster */
static PetscReal TreeTolerance(const Fembem *fembem, PetscInt order)
{
  return fembem->tolerance == PETSC_DECIDE ? PetscPowRealInt(10., -2 - 2 * order) : fembem->tolerance;
}

static PetscBool WantsGalerkin(const Fembem *fembem, const AbutBoundary *b)
{
  return (PetscBool)(fembem->solve == FEMBEM_GALERKIN ||
                     (fembem->solve == FEMBEM_AUTO && b->nnodes <= PetscMin(FEMBEM_AUTO_ELEMENTS, fembem->max_elements)));
}

/* The boundary is small beside the body: every rank holds all of it, solves for it, and evaluates the stress in its own cells */
static PetscErrorCode AbutEstimatorEstimate_Fembem(AbutEstimator est, AbutBody body, PetscReal eta[])
{
  MPI_Comm       comm = PetscObjectComm((PetscObject)est);
  Fembem        *fembem;
  AbutBoundary  *given;
  FembemBoundary boundary;
  PetscReal      young, poisson;
  PetscInt       unknowns = 0;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &fembem));
  PetscCall(AbutBodyGetPlaneMaterial(body, &young, &poisson));
  PetscCall(AbutBodyGetBoundary(body, &given));
  PetscCall(FembemTakeOffForce(body, given));
  PetscCall(FembemBoundaryCreate(PetscObjectComm((PetscObject)body), given, young, poisson, &boundary));
  FembemTakeOffRigidMotion(&boundary);
  PetscCall(FembemRecoverTractions(&boundary));
  if (WantsGalerkin(fembem, given)) {
    AbutCheckInput(given->nnodes <= fembem->max_elements, comm,
                   "estimator_fembem_max_elements: %" PetscInt_FMT " boundary elements of order %" PetscInt_FMT
                   " are more than %" PetscInt_FMT
                   " of order 1; raise it (memory and time grow with the square and the cube), or give -estimator_fembem_solve none",
                   given->n, given->order, fembem->max_elements);
    PetscCall(FembemSolveGalerkin(&boundary, &unknowns));
    FembemTakeOffRigidMotion(&boundary); /* where no displacement is given, the solution has any */
  }
  PetscCall(AbutEstimatorSetUnknowns(est, unknowns));
  PetscCall(FembemStressCreate(&boundary, TreeTolerance(fembem, given->order), &fembem->stress));
  PetscCall(AbutEstimatorCompareStress(est, body, FembemCompare, eta));
  PetscCall(FembemStressDestroy(&fembem->stress));
  PetscCall(FembemBoundaryDestroy(&boundary));
  PetscCall(AbutBoundaryDestroy(&given));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorSetFromOptions_Fembem(AbutEstimator est, AbutOptionItems PetscOptionsObject)
{
  MPI_Comm  comm = PetscObjectComm((PetscObject)est);
  Fembem   *fembem;
  PetscBool given;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &fembem));
  PetscCall(AbutOptionsEnum(PetscOptionsObject, "-estimator_fembem_solve",
                            "galerkin: boundary elements solved for; none: displacements and reactions of the finite elements; auto: "
                            "galerkin "
                            "for up to 300 boundary elements",
                            FembemSolves, &fembem->solve, NULL));
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-estimator_fembem_tree_tolerance",
                            "relative error of the treecode for stresses; 0 sums directly, not given: 1e-4 and, for each order above 1, "
                            "1e-2 of that",
                            &fembem->tolerance, &given));
  PetscCall(AbutOptionsInt(PetscOptionsObject, "-estimator_fembem_max_elements",
                           "boundary elements, of order p each counted p times, up to which galerkin's dense system is solved",
                           &fembem->max_elements, NULL));
  AbutCheckInput(!given || (fembem->tolerance >= 0. && fembem->tolerance < 0.1), comm,
                 "estimator_fembem_tree_tolerance: %g is not in [0, 0.1); 1e-4 is ample", (double)fembem->tolerance);
  AbutCheckInput(fembem->max_elements > 0, comm, "estimator_fembem_max_elements: %" PetscInt_FMT " is not positive", fembem->max_elements);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorView_Fembem(AbutEstimator est, PetscViewer viewer)
{
  Fembem *fembem;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &fembem));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  boundary elements: solve %s (up to %" PetscInt_FMT "), treecode tolerance %g%s\n",
                                   FembemSolves[fembem->solve], fembem->max_elements, (double)TreeTolerance(fembem, 1),
                                   fembem->tolerance == PETSC_DECIDE ? ", for each order above 1 divided by 100" : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorDestroy_Fembem(AbutEstimator est)
{
  Fembem *fembem;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &fembem));
  PetscCall(PetscFree(fembem));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorCreate_Fembem(AbutEstimator est)
{
  const AbutEstimatorOps ops = {.estimate       = AbutEstimatorEstimate_Fembem,
                                .setfromoptions = AbutEstimatorSetFromOptions_Fembem,
                                .view           = AbutEstimatorView_Fembem,
                                .destroy        = AbutEstimatorDestroy_Fembem};
  Fembem                *fembem;

  PetscFunctionBegin;
  PetscCall(PetscNew(&fembem));
  fembem->solve        = FEMBEM_AUTO;
  fembem->tolerance    = PETSC_DECIDE;
  fembem->max_elements = 4000;
  PetscCall(AbutEstimatorSetData(est, fembem));
  PetscCall(AbutEstimatorSetOps(est, &ops));
  PetscCall(AbutEstimatorSetFeatures(est, ABUT_FEATURE_BODY_FORCE_CONSTANT | ABUT_FEATURE_FOUNDATION | ABUT_FEATURE_PLANE_STRESS |
                                            ABUT_FEATURE_INITIAL_STRAIN_LINEAR));
  PetscCall(AbutEstimatorSetAbout(est, "stress of boundary elements on the trace of the mesh, eq. (27) of the paper"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   PetscDLLibraryRegister_estimator_fembem - Registers `ABUTESTIMATORFEMBEM`; called when the plugin is opened

   Not Collective

   Options Database Keys:
+  -estimator_fembem_solve <auto>           - `galerkin` solves the boundary elements' problem; `none` takes u and t of the finite elements;
                                              `auto` is `galerkin` for up to 300 boundary elements of a body, of order p each
                                              counted p times, `none` above
.  -estimator_fembem_tree_tolerance <real>  - relative error of the treecode that evaluates stresses; 0 sums directly; by default 1e-4 at
                                              order 1, 1e-6, 1e-8 and 1e-10 at orders 2 to 4
-  -estimator_fembem_max_elements <4000>    - boundary elements up to which the dense system of `galerkin` is solved; one of order p counts
                                              p times

   Level: developer

.seealso: `AbutEstimatorRegister()`, `AbutEstimatorCompareStress()`
@*/
PETSC_EXTERN PetscErrorCode PetscDLLibraryRegister_estimator_fembem(void)
{
  PetscFunctionBegin;
  PetscCall(AbutEstimatorRegister(ABUTESTIMATORFEMBEM, AbutEstimatorCreate_Fembem));
  PetscFunctionReturn(PETSC_SUCCESS);
}
