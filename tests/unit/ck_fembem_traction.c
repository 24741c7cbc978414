#include "ck.h"
#include "fembem_boundaries.h"

static const PetscReal lo[2] = {0., 0.}, hi[2] = {2., 1.};

/* Largest error of the recovered tractions of a field, relative to the largest; held: a node whose contact force
   is given as reaction; onename: all sides have one name */
static PetscReal RecoverError(const Field *field, const char text[16], const PetscInt m[4], PetscBool hole, PetscInt held,
                              PetscBool onename)
{
  AbutConditionType condition[16];
  AbutBoundary      given;
  FembemBoundary    b;
  PetscReal         error = 0., largest = 0.;

  BoundaryConditions(text, condition);
  CkOk(BoundaryCreateBox(lo, hi, m, hole, &given));
  BoundaryFill(field, condition, &given);
  for (PetscInt i = 0; onename && i < given.n; ++i) given.side[i] = 0;
  for (PetscInt k = 2 * held; held >= 0 && k < 2 * held + 2; ++k) {
    given.reaction[k] += given.contact[k];
    given.contact[k] = 0.;
  }
  CkOk(FembemBoundaryCreate(PETSC_COMM_SELF, &given, field->young, field->poisson, &b));
  CkOk(FembemRecoverTractions(&b));
  for (PetscInt i = 0; i < 2 * b.n; ++i) {
    const PetscInt     e = i / 2, node = i % 2 ? b.next[e] : e;
    const PetscComplex tangent = (b.z[b.next[e]] - b.z[e]) / PetscAbsComplex(b.z[b.next[e]] - b.z[e]);
    const PetscReal    n[2]    = {PetscImaginaryPartComplex(tangent), -PetscRealPartComplex(tangent)};
    PetscReal          s[3];
    PetscComplex       t;

    field->stress(&given.x[2 * node], s);
    t       = PetscCMPLX(s[0] * n[0] + s[2] * n[1], s[2] * n[0] + s[1] * n[1]);
    error   = PetscMax(error, PetscAbsComplex(b.t[i] - t));
    largest = PetscMax(largest, PetscAbsComplex(t));
  }
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(BoundaryFree(&given));
  return error / largest;
}

static const char *const conditions[] = {"tuttttuttttttttt", "tuttccuttttttttt", "uuttttuttttttttt", "uuuutttttttttttt",
                                         "uuuuuuuutttttttt", "uuuuuuuuuuuuuuuu", "tuuutcuttttttttt"};

/* Alone, beside given tractions, at corners where one reaction holds two sides; corners between named sides and inside one */
START_TEST(linear_tractions_are_recovered_from_their_forces)
{
  const Field field[2] = {
    {2.1e5, .3, UniformStress, UniformDisplacement},
    {2.1e5, .3, BendingStress, BendingDisplacement}
  };
  const PetscInt m[2][4] = {
    {7, 4, 6, 5},
    {3, 2, 2, 2}
  };

  for (PetscInt k = 0; k < 4; ++k)
    ck_assert_double_lt(RecoverError(&field[k % 2], conditions[_i], m[k / 2], PETSC_TRUE, -1, k < 2 ? PETSC_TRUE : PETSC_FALSE), 1e-10);
}
END_TEST

/* A side held in the direction in which contact acts above it: its corner carries no contact force, the reaction there is that of both */
START_TEST(the_reaction_of_a_held_corner_feeds_the_contact_too)
{
  const Field    field = {2.1e5, .3, UniformStress, UniformDisplacement};
  const PetscInt m[4]  = {7, 4, 6, 5};

  ck_assert_double_lt(RecoverError(&field, "tuuutcuttttttttt", m, PETSC_FALSE, 11, PETSC_FALSE), 1e-10);
}
END_TEST

/* One element a side: the corners' shares are not all determined, those of least norm are taken */
START_TEST(single_elements_are_no_obstacle)
{
  const Field    field = {2.1e5, .3, UniformStress, UniformDisplacement};
  const PetscInt m[4]  = {1, 1, 1, 1};

  ck_assert_double_lt(RecoverError(&field, "tuttttuttttttttt", m, PETSC_FALSE, -1, PETSC_FALSE), 1e-10);
  ck_assert_double_lt(RecoverError(&field, "uuuuuuuutttttttt", m, PETSC_FALSE, -1, PETSC_FALSE), 3.);
}
END_TEST

/* A polygon with 24 sides of one name, displacement given all round: no corner is sharp enough for a cut, the forces stay in balance */
START_TEST(on_a_closed_smooth_contour_tractions_are_continuous_and_keep_the_forces)
{
  AbutBoundary   given;
  FembemBoundary b;
  PetscReal      sum[4] = {0., 0., 0., 0.};

  CkOk(BoundaryAllocate(24, 1, &given));
  for (PetscInt i = 0; i < 24; ++i) {
    const PetscReal angle = PETSC_PI * i / 12.;

    given.x[2 * i]         = PetscCosReal(angle);
    given.x[2 * i + 1]     = PetscSinReal(angle);
    given.condition[2 * i] = given.condition[2 * i + 1] = ABUT_DISPLACEMENT;
    given.reaction[2 * i]                               = 1. + PetscCosReal(angle);
    given.reaction[2 * i + 1]                           = 2. * PetscSinReal(2. * angle) - 0.3;
  }
  CkOk(FembemBoundaryCreate(PETSC_COMM_SELF, &given, 1., 0.3, &b));
  CkOk(FembemRecoverTractions(&b));
  for (PetscInt i = 0; i < 24; ++i) {
    const PetscReal    h = PetscAbsComplex(b.z[b.next[i]] - b.z[i]);
    const PetscComplex t = 0.5 * h * (b.t[2 * i] + b.t[2 * i + 1]);

    sum[0] += PetscRealPartComplex(t);
    sum[1] += PetscImaginaryPartComplex(t);
    sum[2] += given.reaction[2 * i];
    sum[3] += given.reaction[2 * i + 1];
    ck_assert_double_eq_tol(PetscAbsComplex(b.t[2 * i] - b.t[2 * b.previous[i] + 1]), 0., 1e-11);
  }
  ck_assert_double_eq_tol(sum[0], sum[2], 1e-12);
  ck_assert_double_eq_tol(sum[1], sum[3], 1e-12);
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(BoundaryFree(&given));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("fembem_traction");
  TCase *tests = tcase_create("traction");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  tcase_add_loop_test(tests, linear_tractions_are_recovered_from_their_forces, 0, 7);
  tcase_add_test(tests, the_reaction_of_a_held_corner_feeds_the_contact_too);
  tcase_add_test(tests, single_elements_are_no_obstacle);
  tcase_add_test(tests, on_a_closed_smooth_contour_tractions_are_continuous_and_keep_the_forces);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
