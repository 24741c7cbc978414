/* ranks: 1 2 3 4 */
#include "ckbody.h"

/* Fields that are no polynomials, and how fast the elements come near them */

enum {
  GIVEN_DISPLACEMENT, /* on all sides */
  GIVEN_TRACTION,     /* normal displacement on two sides, tractions for the rest */
  HANGING             /* the same, and a first mesh of several levels */
};

/* Halving all cells divides the L2 error by 2^(p+1) and the energy error by 2^p. With both u on a side the dual problem is singular
   where it ends: a quarter of an order less in L2. */
START_TEST(the_displacement_converges_with_its_order_and_one_more_and_the_stress_with_its_order)
{
  const PetscInt   order  = 1 + _i / 6;
  const AbutShape  shape  = (AbutShape)(_i / 3 % 2);
  const int        how    = _i % 3;
  CkField          smooth = {.at = CkSmooth, .order = order};
  const PetscInt   n      = order > 2 ? 4 : 8;
  AbutBody         body;
  PetscReal        l2[3], energy[3];
  static PetscReal worst[2] = {0., 0.};
  PetscMPIInt      size;

  if (shape == ABUT_TRIANGLE && order > 3) return;
  body = CkBodyOn(PETSC_COMM_WORLD, "body", &smooth, 0., 0., 2., 1., 2 * n, n, shape);
  if (how == GIVEN_DISPLACEMENT) CkGiveAll(body, &smooth, "uu", "uu", "uu", "uu");
  else CkGiveAll(body, &smooth, "ut", "tt", "tu", "tt");
  if (how == HANGING) CkRefine(CkMeshOf(body), CkTowardsPoint, order > 2 ? 2 : 3);
  for (PetscInt i = 0; i < 3; ++i) {
    if (i) CkRefine(CkMeshOf(body), CkEverywhere, 1);
    CkOk(AbutBodySolve(body, NULL));
    CkErrors(body, &smooth, &l2[i], &energy[i]);
  }
  ck_assert_double_eq_tol(PetscLog2Real(l2[1] / l2[2]), order + 1., order == 1 ? 0.03 : 0.1);
  ck_assert_double_eq_tol(PetscLog2Real(energy[1] / energy[2]), (double)order, order == 1 ? 0.015 : 0.1);
  worst[0] = PetscMax(worst[0], PetscAbsReal(PetscLog2Real(l2[1] / l2[2]) - order - 1.));
  worst[1] = PetscMax(worst[1], PetscAbsReal(PetscLog2Real(energy[1] / energy[2]) - order));
  CkOk(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  if (_i == 20 && size == 1) {
    CkCase("V13", "order in L2 off p + 1, P1 to P3, Q1 to Q4, hanging nodes", worst[0], 0.1);
    CkCase("V13", "order in energy off p, the same meshes", worst[1], 0.1);
  }
  ck_assert_double_lt(l2[2], order == 1 ? 5e-4 : 3e-5);
  ck_assert_double_lt(energy[2], order == 1 ? 1.2e-2 : 1e-3);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

static PetscBool AtTheEdgeOfContact(AbutMesh mesh, PetscInt c, PETSC_UNUSED PetscInt i)
{
  PetscReal x[2];

  CkCenter(CkTopology(mesh), c, x);
  return (PetscBool)(PetscSqr(x[0] - 0.5) + PetscSqr(x[1]) < PetscSqr(0.75 * PetscPowReal(0.5, i)));
}

START_TEST(the_exact_field_of_the_hertz_box_has_its_known_value)
{
  CkField         hertz = {.at = CkHertz, .young = CK_YOUNG, .poisson = CK_POISSON};
  const PetscReal x[2] = {2., -2.}, side[2] = {0.3, 0.};
  PetscReal       u[2], s[3];

  CkHertz(&hertz, x, u, s);
  ck_assert_double_eq_tol(u[0], 2.8389e-4, 1e-8);
  ck_assert_double_eq_tol(u[1], 5.56001e-3, 1e-8);
  CkHertz(&hertz, side, u, s);
  ck_assert_double_eq_tol(s[1], -800., 1e-9); /* p0 sqrt(1 - (x/a)^2) */
}
END_TEST

/* The Hertz pressure on the top: errors known from an independent program, half an order lost nowhere but at the edge of the pressure */
START_TEST(the_hertz_box_has_the_known_energy_errors)
{
  const PetscReal known[2][2] = {
    {0.0619, 0.03144},
    {0.1142, 0.0589 }
  };

  for (PetscInt i = 0; i < 2; ++i) {
    CkField   hertz = {.at = CkHertz};
    PetscInt  n     = i ? 48 : 24; /* cells of 1/12, 1/24 */
    AbutBody  body  = CkBodyOn(PETSC_COMM_WORLD, "body", &hertz, 0., -2., 2., 0., n, n, (AbutShape)_i);
    PetscReal l2, energy;

    CkGiveAll(body, &hertz, "u-", "uu", "uu", "tt");
    CkOk(AbutBodySolve(body, NULL));
    CkErrors(body, &hertz, &l2, &energy);
    ck_assert_double_eq_tol(energy, known[_i][i], 0.03 * known[_i][i]);
    CkOk(AbutBodyDestroy(&body));
  }
}
END_TEST

START_TEST(refinement_towards_the_edge_of_the_pressure_lessens_the_error)
{
  CkField   hertz = {.at = CkHertz};
  AbutBody  body  = CkBodyOn(PETSC_COMM_WORLD, "body", &hertz, 0., -2., 2., 0., 24, 24, (AbutShape)_i);
  PetscReal l2, energy[2];

  CkGiveAll(body, &hertz, "u-", "uu", "uu", "tt");
  CkOk(AbutBodySolve(body, NULL));
  CkErrors(body, &hertz, &l2, &energy[0]);
  CkRefine(CkMeshOf(body), AtTheEdgeOfContact, 5);
  CkOk(AbutBodySolve(body, NULL));
  CkErrors(body, &hertz, &l2, &energy[1]);
  ck_assert_double_lt(energy[1], 0.75 * energy[0]);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("body_orders");
  TCase *tc    = tcase_create("all");
  int    failed;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  tcase_set_timeout(tc, 0);
  tcase_add_loop_test(tc, the_displacement_converges_with_its_order_and_one_more_and_the_stress_with_its_order, 0, 24);
  tcase_add_test(tc, the_exact_field_of_the_hertz_box_has_its_known_value);
  tcase_add_loop_test(tc, the_hertz_box_has_the_known_energy_errors, 0, 2);
  tcase_add_loop_test(tc, refinement_towards_the_edge_of_the_pressure_lessens_the_error, 0, 2);
  suite_add_tcase(suite, tc);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
