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

/* auto is what it was when every system was dense, so that indicators stay what they were. Without a solve the estimate is as good on
   meshes finer than these, but where the stress is singular C is .4 to .6, not .25 to .4 */
#define FEMBEM_AUTO_ELEMENTS 300

typedef struct {
  PetscInt     solve;     /* FembemSolve */
  PetscReal    tolerance; /* of the treecode; PETSC_DECIDE: by the order */
  PetscInt     max_elements;
  FembemSolver solver;
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
  FembemCost     cost = {.unknowns = 0};

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
                   " are more than %" PetscInt_FMT " of order 1; raise it, or give -estimator_fembem_solve none",
                   given->n, given->order, fembem->max_elements);
    PetscCall(FembemSolveGalerkin(&boundary, fembem->solver, &cost));
    PetscCall(PetscInfo(est,
                        "%" PetscInt_FMT " unknowns, %" PetscInt_FMT " iterations, %" PetscInt_FMT
                        " pairs evaluated and %zu numbers held on this rank\n",
                        cost.unknowns, cost.iterations, cost.pairs, cost.numbers));
    if (cost.failed)
      PetscCall(PetscPrintf(comm,
                            "warning: estimator_fembem_solve: %" PetscInt_FMT " iterations have not solved for %" PetscInt_FMT
                            " boundary unknowns; the estimate takes those of the finite elements, as with none\n",
                            cost.iterations, cost.unknowns));
    FembemTakeOffRigidMotion(&boundary); /* where no displacement is given, the solution has any */
  }
  PetscCall(AbutEstimatorSetUnknowns(est, cost.unknowns));
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
                           "boundary elements, of order p each counted p times, up to which galerkin's system is solved",
                           &fembem->max_elements, NULL));
  PetscCall(AbutOptionsInt(PetscOptionsObject, "-estimator_fembem_dense_unknowns",
                           "unknowns up to which galerkin's system is a dense matrix; above it is solved by iterations",
                           &fembem->solver.dense, NULL));
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-estimator_fembem_solve_tolerance",
                            "relative error of these iterations, and of what distant boundary elements do to each other",
                            &fembem->solver.tolerance, NULL));
  AbutCheckInput(!given || (fembem->tolerance >= 0. && fembem->tolerance < 0.1), comm,
                 "estimator_fembem_tree_tolerance: %g is not in [0, 0.1); 1e-4 is ample", (double)fembem->tolerance);
  AbutCheckInput(fembem->max_elements > 0, comm, "estimator_fembem_max_elements: %" PetscInt_FMT " is not positive", fembem->max_elements);
  AbutCheckInput(fembem->solver.dense >= 0, comm,
                 "estimator_fembem_dense_unknowns: %" PetscInt_FMT
                 " is below 0; give the unknowns of the largest dense system, for example 3000",
                 fembem->solver.dense);
  AbutCheckInput(fembem->solver.tolerance >= 1e-12 && fembem->solver.tolerance <= 1e-2, comm,
                 "estimator_fembem_solve_tolerance: %g is not in [1e-12, 0.01]; give a relative error, for example 1e-7",
                 (double)fembem->solver.tolerance);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorView_Fembem(AbutEstimator est, PetscViewer viewer)
{
  Fembem *fembem;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &fembem));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "  boundary elements: solve %s (up to %" PetscInt_FMT ", above %" PetscInt_FMT
                                   " unknowns by iterations to %g), treecode tolerance %g%s\n",
                                   FembemSolves[fembem->solve], fembem->max_elements, fembem->solver.dense,
                                   (double)fembem->solver.tolerance, (double)TreeTolerance(fembem, 1),
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
  fembem->max_elements = 100000;
  fembem->solver       = (FembemSolver){.dense = 3000, .tolerance = 1e-7};
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
.  -estimator_fembem_max_elements <100000>  - boundary elements up to which `galerkin` is solved; one of order p counts p times
.  -estimator_fembem_dense_unknowns <3000>  - unknowns of `galerkin` up to which its system is a dense matrix, which all ranks assemble and
                                              factor together; above, GMRES takes memory in proportion to the boundary
-  -estimator_fembem_solve_tolerance <1e-7> - above that, residual of GMRES over the right-hand side, and relative error of what distant
                                              elements do to each other, in [1e-12, 0.01]

   Note:
   All ranks hold the boundary. Each evaluates an equal part of the pairs of elements, and the stress in its own cells. `-info
   :abut_estimator` prints unknowns, iterations, pairs of elements and numbers held.

   Limits:
   With a solve tolerance of 1e-7 indicators of at least a twentieth of the largest are within 1e-3 of those of the dense system, whose
   quadrature at order 1 is not better; on order 1 with 2,500 elements and cells down to 2^-8 of the others within 4e-3. Smaller ones are
   off by more, up to 2 per cent from a hundredth on; 1e-8 leaves 5e-3 there and takes 5 to 17 per cent more time. Where sides have many
   corners the iterations are more (some 50 for 2e4 unknowns), as the system that precedes them has at most 500 elements, or 3 a contour.

   Level: developer

.seealso: `AbutEstimatorRegister()`, `AbutEstimatorCompareStress()`
@*/
PETSC_EXTERN PetscErrorCode PetscDLLibraryRegister_estimator_fembem(void)
{
  PetscFunctionBegin;
  PetscCall(AbutEstimatorRegister(ABUTESTIMATORFEMBEM, AbutEstimatorCreate_Fembem));
  PetscFunctionReturn(PETSC_SUCCESS);
}
