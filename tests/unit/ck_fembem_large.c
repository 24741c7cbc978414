#include "fembem_boundaries.h"

/* Large boundaries, and hard ones: what the system of boundary elements takes there */

static const PetscReal lo[2] = {0., 0.}, hi[2] = {2., 1.};

/* Every second node of a box lies outside it by half an element, so that there is a corner at every node */
START_TEST(corners_cost_no_more_than_unknowns)
{
  const Field             field    = {2.1e5, .3, UniformStress, UniformDisplacement};
  const FembemSolver      iterated = {.dense = 0, .tolerance = 1e-8};
  const AbutConditionType held[16] = {ABUT_TRACTION, ABUT_DISPLACEMENT, ABUT_TRACTION,     ABUT_TRACTION,
                                      ABUT_TRACTION, ABUT_TRACTION,     ABUT_DISPLACEMENT, ABUT_TRACTION};
  const PetscReal         x[4]     = {.3, .5, 1.1, .15};
  FembemCost              cost[2];

  for (PetscInt k = 0; k < 2; ++k) {
    const PetscInt m[4] = {500 << k, 500 << k, 500 << k, 500 << k};
    AbutBoundary   given;
    FembemBoundary b;
    FembemStress   stress;
    PetscReal      s[6];

    CkOk(BoundaryCreateBox(lo, hi, m, PETSC_FALSE, 1, &given));
    BoundaryRaiseTeeth(1, 0.25, &given);
    BoundaryFill(&field, held, &given);
    CkOk(FembemBoundaryCreate(PETSC_COMM_WORLD, &given, field.young, field.poisson, &b));
    CkOk(FembemRecoverTractions(&b));
    CkOk(FembemSolveGalerkin(&b, iterated, &cost[k]));
    CkOk(FembemStressCreate(&b, 0., &stress));
    CkOk(FembemStressEvaluate(stress, 2, x, s));
    CkOk(PetscPrintf(PETSC_COMM_WORLD, "%" PetscInt_FMT " unknowns at corners: %zu numbers, %" PetscInt_FMT " iterations, error %.1e\n",
                     cost[k].unknowns, cost[k].numbers, cost[k].iterations,
                     (double)PetscMax(BoundaryDifference(3, s, uniform_stress), BoundaryDifference(3, s + 3, uniform_stress))));
    ck_assert_double_lt(BoundaryDifference(3, s, uniform_stress), 5e-5);
    ck_assert_double_lt(BoundaryDifference(3, s + 3, uniform_stress), 5e-5);
    ck_assert_int_lt(cost[k].iterations, 60);
    CkOk(FembemStressDestroy(&stress));
    CkOk(FembemBoundaryDestroy(&b));
    CkOk(BoundaryFree(&given));
  }
  ck_assert_double_lt((PetscReal)cost[1].numbers / cost[0].numbers, 2.1);
  ck_assert_double_lt((PetscReal)cost[1].numbers, 0.1 * cost[1].unknowns * cost[1].unknowns);
}
END_TEST

/* A box of 120 elements about a square hole of 8, which is one leaf of the tree of clusters */
static void CreatePlate(PetscInt order, AbutBoundary *given)
{
  const PetscReal ilo[2] = {.9, .4}, ihi[2] = {1.1, .6};
  const PetscInt  outer[4] = {30, 30, 30, 30}, inner[4] = {2, 2, 2, 2};

  CkOk(BoundaryAllocate(128, 2, order, given));
  given->contour[1] = 120;
  for (PetscInt i = 0; i < given->n; ++i) given->next[i] = i + 1;
  given->next[119] = 0;
  given->next[127] = 120;
  RectangleNodes(lo, hi, outer, PETSC_FALSE, 0, given);
  RectangleNodes(ilo, ihi, inner, PETSC_TRUE, 120, given);
  CkOk(BoundaryPlaceNodes(given));
}

/* With the rigid motion of the hole its block of the preconditioner would be singular; held at the side below, it is free to slide */
START_TEST(a_hole_may_be_one_leaf)
{
  static const char *const text[]   = {"tuttttuttttttttt", "tttttttttttttttt", "tuttttutttuttttt"};
  const Field              field    = {2.1e5, .3, UniformStress, UniformDisplacement};
  const FembemSolver       iterated = {.dense = 0, .tolerance = 1e-8};
  const PetscReal          x[4]     = {.3, .5, 1.2, .15};
  AbutConditionType        condition[16];

  BoundaryConditions(text[_i], condition);
  for (PetscInt order = 1; order <= ABUT_ORDER_MAX; ++order) {
    AbutBoundary   given;
    FembemBoundary b;
    FembemStress   stress;
    FembemCost     cost;
    PetscReal      s[6], error;

    CreatePlate(order, &given);
    BoundaryFill(&field, condition, &given);
    CkOk(FembemBoundaryCreate(PETSC_COMM_WORLD, &given, field.young, field.poisson, &b));
    FembemTakeOffRigidMotion(&b);
    CkOk(FembemRecoverTractions(&b));
    CkOk(FembemSolveGalerkin(&b, iterated, &cost));
    FembemTakeOffRigidMotion(&b);
    CkOk(FembemStressCreate(&b, 0., &stress));
    CkOk(FembemStressEvaluate(stress, 2, x, s));
    error = PetscMax(BoundaryDifference(3, s, uniform_stress), BoundaryDifference(3, s + 3, uniform_stress));
    CkOk(PetscPrintf(PETSC_COMM_WORLD, "hole in a leaf, %s, order %" PetscInt_FMT ": %" PetscInt_FMT " iterations, error %.1e\n", text[_i],
                     order, cost.iterations, (double)error));
    ck_assert(!cost.failed);
    ck_assert_int_lt(cost.iterations, 60);
    ck_assert_double_lt(error, order > 1 ? 1e-7 : 5e-5);
    CkOk(FembemStressDestroy(&stress));
    CkOk(FembemBoundaryDestroy(&b));
    CkOk(BoundaryFree(&given));
  }
}
END_TEST

/* A comb whose teeth are as long as the box: every element is near every other one */
START_TEST(more_entries_than_integers_count_are_refused)
{
  const FembemSolver solver = {.dense = 0, .tolerance = 1e-4};
  const PetscInt     m[4]   = {3000, 3000, 3000, 3000};
  AbutBoundary       given;
  FembemBoundary     b;
  FembemCost         cost;
  AbutConditionType  condition[16];
  PetscErrorCode     code;

  BoundaryConditions("tttttttttttttttt", condition);
  CkOk(BoundaryCreateBox(lo, hi, m, PETSC_FALSE, 4, &given));
  for (PetscInt i = 1; i < given.n; i += 2)
    for (PetscInt d = 0; d < 2; ++d) given.x[8 * i + d] = lo[d] + hi[d] - given.x[8 * i + d];
  CkOk(BoundaryPlaceNodes(&given));
  CkOk(FembemBoundaryCreate(PETSC_COMM_WORLD, &given, 2.1e5, 0.3, &b));
  CkCatch(code = FembemSolveGalerkin(&b, solver, &cost));
  ck_assert_int_eq(code, PETSC_ERR_USER_INPUT);
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("fembem_large");
  TCase *tests = tcase_create("large");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  tcase_set_timeout(tests, 120);
  tcase_add_test(tests, corners_cost_no_more_than_unknowns);
  tcase_add_test(tests, more_entries_than_integers_count_are_refused);
  tcase_add_loop_test(tests, a_hole_may_be_one_leaf, 0, 3);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
