#include "fembem_bodies.h"
#include <abutestimator.h>

/* estimator_fembem with finite elements of orders 2 to 4: eqs. (23) and (24) of the paper, the boundary elements are better */

PETSC_EXTERN PetscErrorCode PetscDLLibraryRegister_estimator_fembem(void);

static void Print(const char what[], PetscInt order, PetscInt n, PetscBool galerkin, const PetscReal measure[3])
{
  CkOk(PetscPrintf(PETSC_COMM_WORLD,
                   "%s, order %" PetscInt_FMT ", h = 1/%" PetscInt_FMT ", %s: C %.3f, effectivity %.3f, finite elements %.2e\n", what,
                   order, n, galerkin ? "galerkin" : "none", (double)measure[0], (double)measure[1], (double)measure[2]));
}

/* C falls like h^(1/2), as at order 1: where the mesh is halved by 2^(1/2), if coarse by more. Without a solve tractions of reactions on
   triangles, where two sides of a corner are held, are the worst */
static void CheckSmooth(PetscInt order, AbutShape shape, PetscBool galerkin, PetscReal most)
{
  PetscReal before = 0.;

  for (PetscInt n = 2; n <= 16; n *= 2) {
    AbutBody  body = SmoothBody(order, shape, n);
    PetscReal measure[3];

    Measure(body, galerkin, SmoothStress, NULL, measure);
    Print(shape == ABUT_QUAD ? "smooth, quads" : "smooth, triangles", order, n, galerkin, measure);
    if (n == 2) ck_assert_double_lt(measure[0], most);
    else ck_assert_double_eq_tol(before / measure[0], 1.5, 0.3);
    ck_assert_double_eq_tol(measure[1], 1., n == 2 ? 0.06 : 0.03);
    before = measure[0];
    CkOk(AbutBodyDestroy(&body));
  }
}

START_TEST(on_a_smooth_solution_boundary_elements_are_better_by_half_an_order)
{
  const PetscBool galerkin = (PetscBool)(_i % 2);
  const PetscInt  order    = 2 + _i / 2;

  CheckSmooth(order, ABUT_QUAD, galerkin, 0.2);
  if (order < 4) CheckSmooth(order, ABUT_TRIANGLE, galerkin, galerkin ? 0.15 : 0.55);
}
END_TEST

/* The stress has a square root at the end of the pressure: C tends to a constant, half of it if the boundary elements' problem is solved */
START_TEST(at_a_square_root_of_the_load_they_are_better_by_a_factor)
{
  const PetscBool galerkin  = (PetscBool)(_i % 2);
  const PetscInt  order     = 2 + _i / 2;
  FembemStress    reference = LayerReference(&quartic_division);

  for (PetscInt n = 1; n <= 4; n *= 2) {
    AbutBody  body = LayerBody(order, 4 * n, n);
    PetscReal measure[3];

    Measure(body, galerkin, ReferenceStress, &reference, measure);
    Print("layer", order, n, galerkin, measure);
    ck_assert_double_lt(measure[0], galerkin ? 0.23 : 0.39);
    ck_assert_double_eq_tol(measure[1], galerkin ? 0.95 : 0.9, 0.05);
    CkOk(AbutBodyDestroy(&body));
  }
  CkOk(FembemStressDestroy(&reference));
}
END_TEST

/* 8 elements of order 3 */
START_TEST(elements_of_high_order_count_as_often_against_the_limit)
{
  AbutBody       body = SmoothBody(3, ABUT_QUAD, 2);
  AbutEstimator  est;
  Vec            eta;
  PetscInt       unknowns;
  PetscErrorCode code;

  CkOk(AbutBodyCreateCellVec(body, &eta));
  CkOk(PetscOptionsSetValue(NULL, "-estimator_fembem_max_elements", _i ? "24" : "23"));
  CkOk(PetscOptionsSetValue(NULL, "-estimator_fembem_solve", "galerkin"));
  CkOk(AbutEstimatorCreate(PETSC_COMM_WORLD, &est));
  CkOk(AbutEstimatorSetType(est, ABUTESTIMATORFEMBEM));
  CkOk(AbutEstimatorSetFromOptions(est));
  if (_i) {
    CkOk(AbutEstimatorEstimate(est, body, eta));
    CkOk(AbutEstimatorGetUnknowns(est, &unknowns));
    ck_assert_int_eq(unknowns, 2 * (4 * 4 + 11)); /* tractions left and below, displacements right and above */
  } else {
    CkCatch(code = AbutEstimatorEstimate(est, body, eta));
    ck_assert_int_eq(code, PETSC_ERR_USER_INPUT);
    ck_assert_ptr_nonnull(strstr(ck_line, "estimator_fembem_max_elements: 8 boundary elements of order 3 are more than 23"));
  }
  CkOk(AbutEstimatorDestroy(&est));
  CkOk(VecDestroy(&eta));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("fembem_saturation");
  TCase *tests = tcase_create("saturation");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  PetscCall(PetscDLLibraryRegister_estimator_fembem());
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, on_a_smooth_solution_boundary_elements_are_better_by_half_an_order, 0, 6);
  tcase_add_loop_test(tests, at_a_square_root_of_the_load_they_are_better_by_a_factor, 0, 6);
  tcase_add_loop_test(tests, elements_of_high_order_count_as_often_against_the_limit, 0, 2);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
