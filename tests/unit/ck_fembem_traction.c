#include "fembem_boundaries.h"

static const PetscReal lo[2] = {0., 0.}, hi[2] = {2., 1.};

/* Largest error of the tractions recovered from the data of a field, relative to the largest */
static PetscReal TractionError(const Field *field, const AbutBoundary *given)
{
  const PetscInt order = given->order;
  FembemBoundary b;
  PetscReal      error = 0., largest = 0.;

  CkOk(FembemBoundaryCreate(PETSC_COMM_SELF, given, field->young, field->poisson, &b));
  CkOk(FembemRecoverTractions(&b));
  for (PetscInt i = 0; i < (order + 1) * b.n; ++i) {
    const PetscInt     e = i / (order + 1), node = AbutBoundaryNode(&b, e, i % (order + 1));
    const PetscComplex tangent = (FembemStart(&b, b.next[e]) - FembemStart(&b, e)) / FembemLength(&b, e);
    const PetscReal    n[2]    = {PetscImaginaryPartComplex(tangent), -PetscRealPartComplex(tangent)};
    PetscReal          s[3];
    PetscComplex       t;

    field->stress(&given->x[2 * node], s);
    t       = PetscCMPLX(s[0] * n[0] + s[2] * n[1], s[2] * n[0] + s[1] * n[1]);
    error   = PetscMax(error, PetscAbsComplex(b.t[i] - t));
    largest = PetscMax(largest, PetscAbsComplex(t));
  }
  CkOk(FembemBoundaryDestroy(&b));
  return error / largest;
}

/* Of a box; held: a node whose contact force is given as reaction; onename: all sides have one name */
static PetscReal RecoverError(PetscInt order, const Field *field, const char text[16], const PetscInt m[4], PetscBool hole, PetscInt held,
                              PetscBool onename)
{
  AbutConditionType condition[16];
  AbutBoundary      given;
  PetscReal         error;

  BoundaryConditions(text, condition);
  CkOk(BoundaryCreateBox(lo, hi, m, hole, order, &given));
  BoundaryFill(field, condition, &given);
  for (PetscInt i = 0; onename && i < given.n; ++i) given.side[i] = 0;
  for (PetscInt k = 2 * order * held; held >= 0 && k < 2 * order * held + 2; ++k) {
    given.reaction[k] += given.contact[k];
    given.contact[k] = 0.;
  }
  error = TractionError(field, &given);
  CkOk(BoundaryFree(&given));
  return error;
}

static const char *const conditions[] = {"tuttttuttttttttt", "tuttccuttttttttt", "uuttttuttttttttt", "uuuutttttttttttt",
                                         "uuuuuuuutttttttt", "uuuuuuuuuuuuuuuu", "tuuutcuttttttttt"};

/* Alone, beside given tractions, at corners where one reaction holds two sides; corners between named sides and inside one */
START_TEST(tractions_of_their_degree_are_recovered_from_their_forces)
{
  const Field field[3] = {
    {2.1e5, .3, UniformStress,    UniformDisplacement   },
    {2.1e5, .3, BendingStress,    BendingDisplacement   },
    {2.1e5, .3, PolynomialStress, PolynomialDisplacement}
  };
  const PetscInt m[2][4] = {
    {7, 4, 6, 5},
    {3, 2, 2, 2}
  };

  for (PetscInt order = 1; order <= ABUT_ORDER_MAX; ++order)
    for (PetscInt k = 0; k < 6; ++k) {
      polynomial_degree = order + 1;
      ck_assert_double_lt(RecoverError(order, &field[k % 3], conditions[_i], m[k / 3], PETSC_TRUE, -1, (PetscBool)(k < 3)), 1e-10);
    }
}
END_TEST

/* A side held in the direction in which contact acts above it: its corner carries no contact force, the reaction there is that of both */
START_TEST(the_reaction_of_a_held_corner_feeds_the_contact_too)
{
  const Field    field = {2.1e5, .3, UniformStress, UniformDisplacement};
  const PetscInt m[4]  = {7, 4, 6, 5};

  ck_assert_double_lt(RecoverError(_i, &field, "tuuutcuttttttttt", m, PETSC_FALSE, 11, PETSC_FALSE), 1e-10);
}
END_TEST

/* One element a side: the corners' shares are not all determined, those of least norm are taken; a lower degree is found again if it says
   enough */
START_TEST(single_elements_are_no_obstacle)
{
  const Field field[2] = {
    {2.1e5, .3, UniformStress,    UniformDisplacement   },
    {2.1e5, .3, PolynomialStress, PolynomialDisplacement}
  };
  const PetscInt m[4] = {1, 1, 1, 1};

  polynomial_degree = _i;
  for (PetscInt k = 0; k < 2; ++k) {
    ck_assert_double_lt(RecoverError(_i, &field[k], "tuttttuttttttttt", m, PETSC_FALSE, -1, PETSC_FALSE), 1e-10);
    ck_assert_double_lt(RecoverError(_i, &field[k], "uuuuuuuutttttttt", m, PETSC_FALSE, -1, PETSC_FALSE), k ? 1. : 1e-10);
  }
}
END_TEST

/* A polygon with 24 sides of one name, displacement given all round: no corner is sharp enough for a cut, the forces stay in balance */
START_TEST(on_a_closed_smooth_contour_tractions_are_continuous_and_keep_the_forces)
{
  AbutBoundary   given;
  FembemBoundary b;
  const PetscInt p      = _i;
  PetscReal      sum[4] = {0., 0., 0., 0.}, z[ABUT_SIDE_NODES_MAX], w[ABUT_SIDE_NODES_MAX];

  CkOk(BoundaryAllocate(24, 1, p, &given));
  for (PetscInt i = 0; i < 24; ++i) {
    given.x[2 * p * i]     = PetscCosReal(PETSC_PI * i / 12.);
    given.x[2 * p * i + 1] = PetscSinReal(PETSC_PI * i / 12.);
    given.condition[2 * i] = given.condition[2 * i + 1] = ABUT_DISPLACEMENT;
  }
  CkOk(BoundaryPlaceNodes(&given));
  for (PetscInt i = 0; i < given.nnodes; ++i) {
    const PetscReal angle = 2. * PETSC_PI * i / given.nnodes;

    given.reaction[2 * i]     = 1. + PetscCosReal(angle);
    given.reaction[2 * i + 1] = 2. * PetscSinReal(2. * angle) - 0.3;
    for (PetscInt d = 0; d < 2; ++d) sum[2 + d] += given.reaction[2 * i + d];
  }
  CkOk(FembemBoundaryCreate(PETSC_COMM_SELF, &given, 1., 0.3, &b));
  CkOk(FembemRecoverTractions(&b));
  CkOk(AbutGetLobattoNodes(p, z, w));
  for (PetscInt i = 0; i < 24; ++i) {
    for (PetscInt k = 0; k <= p; ++k) {
      const PetscComplex force = 0.5 * w[k] * FembemLength(&b, i) * b.t[(p + 1) * i + k];

      sum[0] += PetscRealPartComplex(force);
      sum[1] += PetscImaginaryPartComplex(force);
    }
    ck_assert_double_eq_tol(PetscAbsComplex(b.t[(p + 1) * i] - b.t[(p + 1) * b.previous[i] + p]), 0., 1e-10);
  }
  for (PetscInt d = 0; d < 2; ++d) ck_assert_double_eq_tol(sum[d], sum[2 + d], 1e-12 * given.nnodes);
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(BoundaryFree(&given));
}
END_TEST

/* 3000 teeth of one element on each flank, or 1000 of three: nearly all corners have a share. All round an even number of single elements
   leaves one free; that of least norm is exact where opposite teeth mirror each other */
START_TEST(shares_of_thousands_of_corners_are_found)
{
  static const char *const text[]   = {"tuttccuttttttttt", "uuuuuuuutttttttt", "uuutcccutttttttt"};
  const Field              field[2] = {
    {2.1e5, .3, UniformStress,    UniformDisplacement   },
    {2.1e5, .3, PolynomialStress, PolynomialDisplacement}
  };
  const PetscInt    m[4] = {1500, 1500, 1500, 1500};
  AbutConditionType condition[16];
  AbutBoundary      given;

  BoundaryConditions(text[_i], condition);
  for (PetscInt order = 1; order <= ABUT_ORDER_MAX; ++order)
    for (PetscInt k = 0; k < 2; ++k) {
      PetscReal error;

      polynomial_degree = order + 1;
      CkOk(BoundaryCreateBox(lo, hi, m, PETSC_FALSE, order, &given));
      BoundaryRaiseTeeth(k ? 3 : 1, 0.75, &given);
      CkOk(BoundaryPlaceNodes(&given));
      BoundaryFill(&field[k], condition, &given);
      error = TractionError(&field[k], &given);
      CkOk(PetscPrintf(PETSC_COMM_WORLD, "teeth, %.8s, order %" PetscInt_FMT ": error %.1e\n", text[_i], order, (double)error));
      ck_assert_double_lt(error, 1e-10);
      CkOk(BoundaryFree(&given));
    }
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("fembem_traction");
  TCase *tests = tcase_create("traction");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  tcase_add_loop_test(tests, tractions_of_their_degree_are_recovered_from_their_forces, 0, 7);
  tcase_add_loop_test(tests, the_reaction_of_a_held_corner_feeds_the_contact_too, 1, ABUT_ORDER_MAX + 1);
  tcase_add_loop_test(tests, single_elements_are_no_obstacle, 1, ABUT_ORDER_MAX + 1);
  tcase_add_loop_test(tests, on_a_closed_smooth_contour_tractions_are_continuous_and_keep_the_forces, 1, ABUT_ORDER_MAX + 1);
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, shares_of_thousands_of_corners_are_found, 0, 3);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
