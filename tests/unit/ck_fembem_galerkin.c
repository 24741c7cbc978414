#include <petsctime.h>
#include "fembem_boundaries.h"
#include <petscblaslapack.h>

static const PetscReal lo[2] = {0., 0.}, hi[2] = {2., 1.};

/* Puts 1 for all that is not given */
static void Forget(FembemBoundary *b)
{
  const AbutConditionType *condition = b->given->condition;

  for (PetscInt i = 0; i < b->n; ++i)
    for (PetscInt c = 0; c < 2; ++c)
      for (PetscInt k = 0; k <= b->order; ++k) {
        const PetscBool held   = (PetscBool)(condition[2 * i + c] == ABUT_DISPLACEMENT);
        const PetscBool before = (PetscBool)(k == 0 && condition[2 * b->previous[i] + c] == ABUT_DISPLACEMENT);
        PetscComplex   *u = &b->u[AbutBoundaryNode(b, i, k)], *t = &b->t[(b->order + 1) * i + k];

        if (k < b->order && !held && !before)
          *u = c ? PetscCMPLX(PetscRealPartComplex(*u), 1.) : PetscCMPLX(1., PetscImaginaryPartComplex(*u));
        if (held) *t = c ? PetscCMPLX(PetscRealPartComplex(*t), 1.) : PetscCMPLX(1., PetscImaginaryPartComplex(*t));
      }
}

/* Forgets what is not given, solves, and returns the largest error of the stress at points inside, relative to the largest stress there */
static PetscReal SolveError(PetscInt order, const Field *field, const char text[16], const PetscInt m[4], PetscBool hole,
                            PetscInt *unknowns)
{
  const PetscReal   x[10] = {.2, .2, 1.7, .8, .3, .5, 1.1, .15, 1.6, .3};
  AbutConditionType condition[16];
  AbutBoundary      given;
  FembemBoundary    b;
  FembemStress      stress;
  FembemCost        cost;
  PetscReal         s[15], exact[3], error = 0., largest = 0.;

  BoundaryConditions(text, condition);
  CkOk(BoundaryCreateBox(lo, hi, m, hole, order, &given));
  BoundaryFill(field, condition, &given);
  CkOk(FembemBoundaryCreate(PETSC_COMM_SELF, &given, field->young, field->poisson, &b));
  CkOk(FembemRecoverTractions(&b));
  Forget(&b);
  CkOk(FembemSolveGalerkin(&b, dense_solver, &cost));
  *unknowns = cost.unknowns;
  CkOk(FembemStressCreate(&b, 0., &stress));
  CkOk(FembemStressEvaluate(stress, 5, x, s));
  for (PetscInt i = 0; i < 5; ++i) {
    field->stress(&x[2 * i], exact);
    for (PetscInt k = 0; k < 3; ++k) {
      error   = PetscMax(error, PetscAbsReal(s[3 * i + k] - exact[k]));
      largest = PetscMax(largest, PetscAbsReal(exact[k]));
    }
  }
  CkOk(FembemStressDestroy(&stress));
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(BoundaryFree(&given));
  return error / largest;
}

static const char *const supports[] = {
  "uuuuuuuu", /* displacement all round: four corners with one reaction and two tractions */
  "tuttttut", /* smooth base, symmetry plane: the paper's body */
  "uuttttut", /* bonded base beside a symmetry plane */
  "tttttttt", /* no support */
  "tutttttt", /* smooth base alone: free to slide */
  "tuttccut", /* contact above */
  "tuuutcut"  /* contact that meets a side held in the same direction */
};

START_TEST(a_uniform_stress_is_found_under_all_supports)
{
  const Field    field = {2.1e5, .3, UniformStress, UniformDisplacement};
  const PetscInt m[4]  = {8, 5, 7, 4};
  PetscInt       unknowns;
  char           text[17] = "tttttttttttttttt";
  PetscReal      error;

  memcpy(text, supports[_i], 8);
  error = SolveError(1, &field, text, m, PETSC_FALSE, &unknowns);
  CkOk(PetscPrintf(PETSC_COMM_WORLD, "uniform stress, %.8s: error %.1e with %" PetscInt_FMT " unknowns\n", text, (double)error, unknowns));
  ck_assert_double_lt(error, 5e-5);
}
END_TEST

START_TEST(a_uniform_stress_is_found_round_a_hole)
{
  static const char *const text[] = {"tuttttuttttttttt", "tuttttutuuuuuuuu", "ttttttttuuuuuuuu", "tttttttttttttttt"};
  const Field              field  = {2.1e5, .3, UniformStress, UniformDisplacement};
  const PetscInt           m[4]   = {8, 5, 7, 4};
  PetscInt                 unknowns;
  const PetscReal          error = SolveError(1, &field, text[_i], m, PETSC_TRUE, &unknowns);

  CkOk(PetscPrintf(PETSC_COMM_WORLD, "uniform stress, hole, %s: error %.1e with %" PetscInt_FMT " unknowns\n", text[_i], (double)error,
                   unknowns));
  ck_assert_double_lt(error, 5e-5);
}
END_TEST

/* Displacements of the elements' degree, at orders 2 to 4 */
START_TEST(a_polynomial_is_found_under_all_supports)
{
  const Field    field = {2.1e5, .3, PolynomialStress, PolynomialDisplacement};
  const PetscInt m[4]  = {8, 5, 7, 4};
  PetscInt       unknowns;
  char           text[17] = "tttttttttttttttt";

  memcpy(text, supports[_i], 8);
  for (PetscInt order = 2; order <= ABUT_ORDER_MAX; ++order)
    for (PetscInt hole = 0; hole < 2; ++hole) {
      PetscReal error;

      polynomial_degree = order;
      error             = SolveError(order, &field, text, m, (PetscBool)hole, &unknowns);
      CkOk(PetscPrintf(PETSC_COMM_WORLD, "degree and order %" PetscInt_FMT ", %.8s: error %.1e with %" PetscInt_FMT " unknowns\n", order,
                       text, (double)error, unknowns));
      ck_assert_double_lt(error, 5e-8);
    }
}
END_TEST

/* A displacement of second degree: the error falls at least in proportion to the element, inside */
START_TEST(bending_converges_under_all_supports)
{
  const Field    field   = {2.1e5, .3, BendingStress, BendingDisplacement};
  const PetscInt m[2][4] = {
    {8,  4, 8,  4},
    {16, 8, 16, 8}
  };
  PetscReal error[2];
  PetscInt  unknowns;
  char      text[17] = "tttttttttttttttt";

  memcpy(text, supports[_i], 8);
  for (PetscInt k = 0; k < 2; ++k) error[k] = SolveError(1, &field, text, m[k], PETSC_FALSE, &unknowns);
  CkOk(PetscPrintf(PETSC_COMM_WORLD, "bending, %.8s: error %.1e, %.1e\n", text, (double)error[0], (double)error[1]));
  ck_assert_double_lt(error[1], 0.5 * error[0]);
}
END_TEST

/* Full matrices of V on all tractions and of D on all displacements; lengths scaled so that V is positive */
static void Matrices(const FembemBoundary *b, PetscReal *V, PetscReal *D)
{
  const FembemWanted all  = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE};
  const PetscInt     rows = 2 * (b->order + 1), nt = rows * b->n, nu = 2 * b->nnodes;
  FembemPairing      pairing;
  FembemElement     *e;

  CkOk(FembemPairingSet(&b->basis, b->mat, &pairing));
  CkOk(PetscMalloc1(b->n, &e));
  for (PetscInt i = 0; i < b->n; ++i) FembemElementSet(&e[i], FembemStart(b, i) / 4., FembemStart(b, b->next[i]) / 4.);
  for (PetscInt i = 0; i < b->n; ++i) {
    for (PetscInt j = 0; j < b->n; ++j) {
      FembemBlocks block;

      CkOk(FembemPair(&pairing, &e[i], &e[j], (PetscBool)(i == j), all, &block));
      for (PetscInt k = 0; k < rows * rows; ++k) {
        const PetscInt r = k / rows, c = k % rows;

        V[rows * i + r + nt * (rows * j + c)] += block.V[k];
        D[2 * AbutBoundaryNode(b, i, r / 2) + r % 2 + nu * (2 * AbutBoundaryNode(b, j, c / 2) + c % 2)] += block.D[k];
      }
    }
  }
  CkOk(PetscFree(e));
}

static PetscReal Asymmetry(PetscInt n, const PetscReal A[])
{
  PetscReal worst = 0., largest = 0.;

  for (PetscInt i = 0; i < n * n; ++i) {
    worst   = PetscMax(worst, PetscAbsReal(A[i] - A[i / n + n * (i % n)]));
    largest = PetscMax(largest, PetscAbsReal(A[i]));
  }
  return worst / largest;
}

static void Eigenvalues(PetscInt n, PetscReal A[], PetscReal value[])
{
  PetscBLASInt bn = n, lwork = 4 * n, info;
  PetscReal   *work;

  CkOk(PetscMalloc1(lwork, &work));
  LAPACKsyev_("N", "L", &bn, A, &bn, value, work, &lwork, &info);
  ck_assert_int_eq(info, 0);
  CkOk(PetscFree(work));
}

START_TEST(the_operators_are_symmetric_and_only_rigid_motions_are_free)
{
  const PetscInt  m[4] = {8, 4, 8, 4}, nt = 48 * (_i + 1), nu = 48 * _i;
  const PetscReal error = _i == 1 ? 1e-5 : 1e-8;
  AbutBoundary    given;
  FembemBoundary  b;
  PetscReal      *V, *D, *value;

  CkOk(BoundaryCreateBox(lo, hi, m, PETSC_FALSE, _i, &given));
  CkOk(FembemBoundaryCreate(PETSC_COMM_SELF, &given, 1., 0.3, &b));
  CkOk(PetscCalloc3(nt * nt, &V, nu * nu, &D, nt, &value));
  Matrices(&b, V, D);
  CkOk(PetscPrintf(PETSC_COMM_WORLD, "order %d: asymmetry of V %.1e, of D %.1e; ", _i, (double)Asymmetry(nt, V), (double)Asymmetry(nu, D)));
  ck_assert_double_lt(Asymmetry(nt, V), error);
  ck_assert_double_lt(Asymmetry(nu, D), error);
  Eigenvalues(nt, V, value);
  CkOk(PetscPrintf(PETSC_COMM_WORLD, "V from %.1e to %.1e", (double)value[0], (double)value[nt - 1]));
  ck_assert_double_gt(value[0], 5e-6 * value[nt - 1]);
  Eigenvalues(nu, D, value);
  CkOk(PetscPrintf(PETSC_COMM_WORLD, ", D %.1e %.1e %.1e %.1e to %.1e\n", (double)value[0], (double)value[1], (double)value[2],
                   (double)value[3], (double)value[nu - 1]));
  for (PetscInt i = 0; i < 3; ++i) ck_assert_double_eq_tol(value[i], 0., error * value[nu - 1]);
  ck_assert_double_gt(value[3], 1e-3 * value[nu - 1]);
  CkOk(PetscFree3(V, D, value));
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(BoundaryFree(&given));
}
END_TEST

/* Not asserted: what the estimator costs */
START_TEST(the_time_of_a_solve_is_printed)
{
  const Field    field   = {2.1e5, .3, BendingStress, BendingDisplacement};
  const PetscInt m[2][4] = {
    {55,  20, 55,  20},
    {150, 50, 150, 50}
  };
  PetscInt       unknowns;
  PetscLogDouble time[2];

  for (PetscInt k = 0; k < (_i == 1 ? 2 : 1); ++k) {
    CkOk(PetscTime(&time[0]));
    SolveError(_i, &field, "tutttcuttttttttt", m[k], PETSC_FALSE, &unknowns);
    CkOk(PetscTime(&time[1]));
    CkOk(PetscPrintf(PETSC_COMM_WORLD, "%" PetscInt_FMT " boundary elements of order %d, %" PetscInt_FMT " unknowns: %.0f ms\n",
                     2 * (m[k][0] + m[k][1]), _i, unknowns, 1e3 * (time[1] - time[0])));
  }
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("fembem_galerkin");
  TCase *tests = tcase_create("galerkin");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  tcase_add_loop_test(tests, the_operators_are_symmetric_and_only_rigid_motions_are_free, 1, ABUT_ORDER_MAX + 1);
  tcase_add_loop_test(tests, a_uniform_stress_is_found_under_all_supports, 0, 7);
  tcase_add_loop_test(tests, a_uniform_stress_is_found_round_a_hole, 0, 4);
  tcase_add_loop_test(tests, a_polynomial_is_found_under_all_supports, 0, 7);
  tcase_add_loop_test(tests, bending_converges_under_all_supports, 0, 7);
  tcase_add_loop_test(tests, the_time_of_a_solve_is_printed, 1, ABUT_ORDER_MAX + 1);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
