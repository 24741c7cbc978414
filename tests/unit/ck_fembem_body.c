#include <petsctime.h>
#include "fembem_bodies.h"
#include <abutestimator.h>

/* estimator_fembem on bodies of order 1, and its meshes */
PETSC_EXTERN PetscErrorCode PetscDLLibraryRegister_estimator_fembem(void);

/* Theorem 6: the boundary elements converge half an order faster, so C falls like h^(1/2); _i: none, galerkin */
START_TEST(on_a_smooth_solution_boundary_elements_are_better_by_half_an_order)
{
  PetscReal measure[2][3];

  for (PetscInt k = 0; k < 2; ++k) {
    AbutBody body = SmoothBody(1, ABUT_QUAD, 8 << k);

    Measure(body, _i ? PETSC_TRUE : PETSC_FALSE, SmoothStress, NULL, measure[k]);
    CkOk(PetscPrintf(PETSC_COMM_WORLD, "smooth, h = 1/%d, %s: C %.3f, effectivity %.3f, error of the finite elements %.2e\n", 8 << k,
                     _i ? "galerkin" : "none", (double)measure[k][0], (double)measure[k][1], (double)measure[k][2]));
    CkOk(AbutBodyDestroy(&body));
  }
  ck_assert_double_lt(measure[0][0], 0.2);
  for (PetscInt k = 0; k < 2; ++k) ck_assert_double_eq_tol(measure[k][1], 0.99, 0.015);
  ck_assert_double_eq_tol(measure[0][0] / measure[1][0], 1.475, 0.125);
}
END_TEST

/* The value is that of an independent Galerkin boundary-element code, graded, 24 and 48 elements per unit agreeing in 6 digits */
START_TEST(galerkin_solves_the_paper_s_layer)
{
  const PetscReal x[2] = {0.5, 0.75};
  PetscReal       s[3];
  FembemStress    reference = LayerReference(_i ? &quartic_division : &linear_division);

  CkOk(FembemStressEvaluate(reference, 1, x, s));
  CkOk(PetscPrintf(PETSC_COMM_WORLD, "layer, elements of order %d: stress at (0.5, 0.75): %.4f %.4f %.4f\n", _i ? 4 : 1, (double)s[0],
                   (double)s[1], (double)s[2]));
  ck_assert_double_eq_tol(s[0], -9.179, 0.004);
  ck_assert_double_eq_tol(s[1], -139.034, 0.004);
  ck_assert_double_eq_tol(s[2], 10.879, 0.004);
  CkOk(FembemStressDestroy(&reference));
}
END_TEST

/* Measured by an independent prototype at h = 1/8: C .198, effectivity .966 without a solve, .123 and .981 with one */
START_TEST(on_the_layer_the_estimate_is_known)
{
  static const PetscReal expected[2][2] = {
    {.198, .966},
    {.123, .981}
  };
  FembemStress reference = LayerReference(&quartic_division);
  AbutBody     body      = LayerBody(1, 32, 8);
  PetscReal    measure[3];

  Measure(body, _i ? PETSC_TRUE : PETSC_FALSE, ReferenceStress, &reference, measure);
  CkOk(PetscPrintf(PETSC_COMM_WORLD, "layer, h = 1/8, %s: C %.3f, effectivity %.3f, error of the finite elements %.2e\n",
                   _i ? "galerkin" : "none", (double)measure[0], (double)measure[1], (double)measure[2]));
  ck_assert_double_eq_tol(measure[0], expected[_i][0], 0.01);
  ck_assert_double_eq_tol(measure[1], expected[_i][1], 0.01);
  CkOk(AbutBodyDestroy(&body));
  CkOk(FembemStressDestroy(&reference));
}
END_TEST

/* Marks what is above 0.1; counts: marked, all */
static PetscReal EstimateAndMark(AbutEstimator est, AbutBody body, PetscBool **mark, PetscInt count[2])
{
  const AbutMeshTopology *t;
  const PetscReal        *eta;
  AbutMesh                mesh;
  Vec                     indicators;
  PetscReal               largest;

  CkOk(AbutBodyGetMesh(body, &mesh));
  CkOk(AbutMeshGetTopology(mesh, &t));
  CkOk(AbutBodyCreateCellVec(body, &indicators));
  CkOk(AbutEstimatorEstimate(est, body, indicators));
  CkOk(VecMax(indicators, NULL, &largest));
  CkOk(PetscMalloc1(t->ncells, mark));
  CkOk(VecGetArrayRead(indicators, &eta));
  count[0] = 0;
  count[1] = t->ncells;
  for (PetscInt c = 0; c < t->ncells; ++c) {
    (*mark)[c] = eta[c] > 0.1 ? PETSC_TRUE : PETSC_FALSE;
    count[0] += (*mark)[c] ? 1 : 0;
  }
  CkOk(VecRestoreArrayRead(indicators, &eta));
  CkOk(VecDestroy(&indicators));
  CkOk(MPI_Allreduce(MPI_IN_PLACE, count, 2, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  return largest;
}

static void Refine(AbutBody body, const PetscBool mark[])
{
  AbutMesh mesh;

  CkOk(AbutBodyGetMesh(body, &mesh));
  CkOk(AbutMeshAdapt(mesh, mark));
  CkOk(AbutBodySetUp(body));
  CkOk(AbutBodySolve(body, NULL));
}

/* The counts of an independent prototype with its own quadtree */
START_TEST(without_a_boundary_solve_the_layer_is_refined_five_times)
{
  static const PetscInt  marked[6] = {7, 16, 13, 9, 5, 0}, cells[6] = {16, 37, 85, 130, 166, 190};
  static const PetscReal largest[6] = {.338, .273, .222, .174, .132, .098};
  AbutBody               body       = LayerBody(1, 8, 2);
  AbutEstimator          est;
  PetscInt               unknowns;

  CkOk(PetscOptionsSetValue(NULL, "-estimator_fembem_solve", "none"));
  CkOk(AbutEstimatorCreate(PETSC_COMM_WORLD, &est));
  CkOk(AbutEstimatorSetType(est, ABUTESTIMATORFEMBEM));
  CkOk(AbutEstimatorSetFromOptions(est));
  for (PetscInt step = 0; step < 6; ++step) {
    PetscBool *mark;
    PetscInt   count[2];

    ck_assert_double_eq_tol(EstimateAndMark(est, body, &mark, count), largest[step], 0.001);
    ck_assert_int_eq(count[0], marked[step]);
    ck_assert_int_eq(count[1], cells[step]);
    if (count[0]) Refine(body, mark);
    CkOk(PetscFree(mark));
  }
  CkOk(AbutEstimatorGetUnknowns(est, &unknowns));
  ck_assert_int_eq(unknowns, 0);
  CkOk(AbutEstimatorDestroy(&est));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* galerkin, the default; the prototype: 8 steps, at the sixth 2 cells marked and 0.103 the largest. Printed: the cost of an estimate */
START_TEST(with_a_boundary_solve_the_layer_is_refined_seven_times)
{
  AbutBody       body = LayerBody(1, 8, 2);
  AbutEstimator  est;
  PetscInt       unknowns, count[2] = {1, 0}, step = 0;
  PetscReal      largest = 0.;
  PetscLogDouble time[2];

  CkOk(PetscOptionsSetValue(NULL, "-estimator_fembem_solve", "galerkin"));
  CkOk(AbutEstimatorCreate(PETSC_COMM_WORLD, &est));
  CkOk(AbutEstimatorSetType(est, ABUTESTIMATORFEMBEM));
  CkOk(AbutEstimatorSetFromOptions(est));
  for (; count[0] && step < 12; ++step) {
    PetscBool *mark;

    CkOk(PetscTime(&time[0]));
    largest = EstimateAndMark(est, body, &mark, count);
    CkOk(PetscTime(&time[1]));
    CkOk(AbutEstimatorGetUnknowns(est, &unknowns));
    CkOk(PetscPrintf(PETSC_COMM_WORLD,
                     "layer, step %" PetscInt_FMT ": %" PetscInt_FMT " cells, %" PetscInt_FMT " marked, largest eta %.4f, %" PetscInt_FMT
                     " unknowns, %.1f ms\n",
                     step + 1, count[1], count[0], (double)largest, unknowns, 1e3 * (time[1] - time[0])));
    if (step == 5) {
      ck_assert_int_eq(count[0], 2);
      ck_assert_double_eq_tol(largest, 0.103, 0.001);
    }
    if (count[0]) Refine(body, mark);
    CkOk(PetscFree(mark));
  }
  ck_assert_int_eq(step, 8);
  CkOk(AbutEstimatorDestroy(&est));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("fembem_body");
  TCase *tests = tcase_create("body");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  PetscCall(PetscDLLibraryRegister_estimator_fembem());
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, on_a_smooth_solution_boundary_elements_are_better_by_half_an_order, 0, 2);
  tcase_add_loop_test(tests, galerkin_solves_the_paper_s_layer, 0, 2);
  tcase_add_loop_test(tests, on_the_layer_the_estimate_is_known, 0, 2);
  tcase_add_test(tests, without_a_boundary_solve_the_layer_is_refined_five_times);
  tcase_add_test(tests, with_a_boundary_solve_the_layer_is_refined_seven_times);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
