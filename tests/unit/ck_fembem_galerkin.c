#include <petsctime.h>
#include "ck.h"
#include "fembem_boundaries.h"
#include <petscblaslapack.h>

static const PetscReal lo[2] = {0., 0.}, hi[2] = {2., 1.};

/* Forgets what is not given, solves, and returns the largest error of the stress at points inside, relative to the largest stress there */
static PetscReal SolveError(const Field *field, const char text[16], const PetscInt m[4], PetscBool hole, PetscInt *unknowns)
{
  const PetscReal   x[10] = {.2, .2, 1.7, .8, .3, .5, 1.1, .15, 1.6, .3};
  AbutConditionType condition[16];
  AbutBoundary      given;
  FembemBoundary    b;
  FembemStress      stress;
  PetscReal         s[15], exact[3], error = 0., largest = 0.;

  BoundaryConditions(text, condition);
  CkOk(BoundaryCreateBox(lo, hi, m, hole, &given));
  BoundaryFill(field, condition, &given);
  CkOk(FembemBoundaryCreate(PETSC_COMM_SELF, &given, field->young, field->poisson, &b));
  CkOk(FembemRecoverTractions(&b));
  for (PetscInt i = 0; i < b.n; ++i) {
    for (PetscInt c = 0; c < 2; ++c) {
      const PetscBool fixed = given.condition[2 * i + c] == ABUT_DISPLACEMENT || given.condition[2 * b.previous[i] + c] == ABUT_DISPLACEMENT
                                ? PETSC_TRUE
                                : PETSC_FALSE;

      if (!fixed) b.u[i] = c ? PetscRealPartComplex(b.u[i]) : PetscCMPLX(0., PetscImaginaryPartComplex(b.u[i]));
      for (PetscInt k = 0; k < 2; ++k)
        if (given.condition[2 * i + c] == ABUT_DISPLACEMENT)
          b.t[2 * i + k] = c ? PetscRealPartComplex(b.t[2 * i + k]) : PetscCMPLX(0., PetscImaginaryPartComplex(b.t[2 * i + k]));
    }
  }
  CkOk(FembemSolveGalerkin(&b, unknowns));
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
  error = SolveError(&field, text, m, PETSC_FALSE, &unknowns);
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
  const PetscReal          error = SolveError(&field, text[_i], m, PETSC_TRUE, &unknowns);

  CkOk(PetscPrintf(PETSC_COMM_WORLD, "uniform stress, hole, %s: error %.1e with %" PetscInt_FMT " unknowns\n", text[_i], (double)error,
                   unknowns));
  ck_assert_double_lt(error, 5e-5);
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
  for (PetscInt k = 0; k < 2; ++k) error[k] = SolveError(&field, text, m[k], PETSC_FALSE, &unknowns);
  CkOk(PetscPrintf(PETSC_COMM_WORLD, "bending, %.8s: error %.1e, %.1e\n", text, (double)error[0], (double)error[1]));
  ck_assert_double_lt(error[1], 0.5 * error[0]);
}
END_TEST

/* Full matrices of V on all tractions (4n) and of D on all displacements (2n); lengths scaled so that V is positive */
static void Matrices(PetscInt n, const FembemBoundary *b, FembemMaterial mat, PetscReal *V, PetscReal *D)
{
  FembemElement *e;

  CkOk(PetscMalloc1(n, &e));
  for (PetscInt i = 0; i < n; ++i) FembemElementSet(&e[i], b->z[i] / 4., b->z[b->next[i]] / 4.);
  for (PetscInt i = 0; i < n; ++i) {
    for (PetscInt j = 0; j < n; ++j) {
      const FembemWanted all   = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE};
      const PetscInt     ni[2] = {i, b->next[i]}, nj[2] = {j, b->next[j]};
      FembemBlocks       block;

      CkOk(FembemPair(&e[i], &e[j], i == j ? PETSC_TRUE : PETSC_FALSE, mat, all, &block));
      for (PetscInt k = 0; k < 16; ++k) {
        V[4 * i + k / 4 + 4 * n * (4 * j + k % 4)] += block.V[k];
        D[2 * ni[k / 8] + k / 4 % 2 + 2 * n * (2 * nj[k % 4 / 2] + k % 2)] += block.D[k];
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
  const PetscInt m[4] = {8, 4, 8, 4}, n = 24;
  AbutBoundary   given;
  FembemBoundary b;
  PetscReal     *V, *D, *value;

  CkOk(BoundaryCreateBox(lo, hi, m, PETSC_FALSE, &given));
  CkOk(FembemBoundaryCreate(PETSC_COMM_SELF, &given, 1., 0.3, &b));
  CkOk(PetscCalloc3(16 * n * n, &V, 4 * n * n, &D, 4 * n, &value));
  Matrices(n, &b, b.mat, V, D);
  CkOk(PetscPrintf(PETSC_COMM_WORLD, "asymmetry of V %.1e, of D %.1e\n", (double)Asymmetry(4 * n, V), (double)Asymmetry(2 * n, D)));
  ck_assert_double_lt(Asymmetry(4 * n, V), 1e-5);
  ck_assert_double_lt(Asymmetry(2 * n, D), 1e-5);
  Eigenvalues(4 * n, V, value);
  CkOk(PetscPrintf(PETSC_COMM_WORLD, "V from %.1e to %.1e", (double)value[0], (double)value[4 * n - 1]));
  ck_assert_double_gt(value[0], 1e-5 * value[4 * n - 1]);
  Eigenvalues(2 * n, D, value);
  CkOk(PetscPrintf(PETSC_COMM_WORLD, ", D %.1e %.1e %.1e %.1e to %.1e\n", (double)value[0], (double)value[1], (double)value[2],
                   (double)value[3], (double)value[2 * n - 1]));
  for (PetscInt i = 0; i < 3; ++i) ck_assert_double_eq_tol(value[i], 0., 1e-5 * value[2 * n - 1]);
  ck_assert_double_gt(value[3], 1e-3 * value[2 * n - 1]);
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

  for (PetscInt k = 0; k < 2; ++k) {
    CkOk(PetscTime(&time[0]));
    SolveError(&field, "tutttcuttttttttt", m[k], PETSC_FALSE, &unknowns);
    CkOk(PetscTime(&time[1]));
    CkOk(PetscPrintf(PETSC_COMM_WORLD, "%" PetscInt_FMT " boundary elements, %" PetscInt_FMT " unknowns: %.0f ms\n",
                     2 * (m[k][0] + m[k][1]), unknowns, 1e3 * (time[1] - time[0])));
  }
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("fembem_galerkin");
  TCase *tests = tcase_create("galerkin");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  tcase_add_test(tests, the_operators_are_symmetric_and_only_rigid_motions_are_free);
  tcase_add_loop_test(tests, a_uniform_stress_is_found_under_all_supports, 0, 7);
  tcase_add_loop_test(tests, a_uniform_stress_is_found_round_a_hole, 0, 4);
  tcase_add_loop_test(tests, bending_converges_under_all_supports, 0, 7);
  tcase_add_test(tests, the_time_of_a_solve_is_printed);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
