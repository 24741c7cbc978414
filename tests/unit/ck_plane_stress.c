/* ranks: 1 2 3 4 */
#include "ckkinematics.h"

/* Thin sheets, against Hooke's law and Kolosov's formulas of plane stress */

/* The displacement of CkLinear(); E/(1 - nu^2) (e11 + nu e22) */
static void Linear(const CkField *field, const PetscReal x[2], PetscReal u[2], PetscReal s[3])
{
  const PetscReal E = field->young, nu = field->poisson, e[3] = {2e-3, 4e-3, -1.5e-3}; /* the last is twice e12 */

  CkLinear(field, x, u, s);
  s[0] = E / (1. - nu * nu) * (e[0] + nu * e[1]);
  s[1] = E / (1. - nu * nu) * (e[1] + nu * e[0]);
  s[2] = E / (2. * (1. + nu)) * e[2];
}

START_TEST(a_constant_strain_is_exact)
{
  CkField         field = {.at = Linear, .young = CK_YOUNG, .poisson = 0.4};
  AbutBody        body  = CkBodyOfOrder(_i, &field, ABUT_PLANE_STRESS, 0., 0., 2., 1., 3);
  const PetscReal at[2] = {0.77, 0.31};
  PetscReal       l2, stress, value[7], u[2], s[4], strain, work;

  CkGiveAll(body, &field, "ut", "tt", "tu", "tt");
  CkOk(AbutBodySolve(body, NULL));
  CkErrors3D(body, &field, &l2, &stress);
  ck_assert_double_le(l2, 1e-9);
  ck_assert_double_le(stress, 1e-9);
  CkOk(AbutBodyGetPointValues(body, at, value));
  CkField3D(&field, ABUT_PLANE_STRESS, at, u, s);
  ck_assert_double_eq(value[5], 0.);
  ck_assert_double_eq_tol(value[6], PetscSqrtReal(s[0] * s[0] - s[0] * s[1] + s[1] * s[1] + 3. * s[2] * s[2]), 1e-8 * value[6]);
  CkOk(AbutBodyGetEnergy(body, &strain, &work));
  ck_assert_double_eq_tol(strain, 2. * 0.5 * (s[0] * 2e-3 + s[1] * 4e-3 - s[2] * 1.5e-3), 1e-8 * strain); /* area 2 */
  ck_assert_double_eq_tol(work, 2. * strain, 1e-8 * strain);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(a_smooth_field_is_met_with_the_order_of_the_elements)
{
  const PetscInt order = 1 + _i % 7 % 4;
  CkField        field = {.at = CkSmoothSheet, .young = CK_YOUNG, .poisson = 0.4};
  AbutBody       body  = CkBodyOfOrder(_i, &field, ABUT_PLANE_STRESS, 0., 0., 2., 1., order > 2 ? 4 : 8);
  PetscReal      l2, stress[2];

  CkGiveAll(body, &field, "ut", "tt", "tu", "tt");
  for (PetscInt i = 0; i < 2; ++i) {
    CkRefine(CkMeshOf(body), CkEverywhere, 1);
    CkOk(AbutBodySolve(body, NULL));
    CkErrors3D(body, &field, &l2, &stress[i]);
  }
  ck_assert_double_eq_tol(PetscLog2Real(stress[0] / stress[1]), (double)order, _i < 11 ? 0.1 : 0.2); /* bisected triangles change shape */
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(the_constants_of_plane_strain_have_the_shear_modulus_and_the_compliance_of_the_sheet)
{
  CkField         field = {.at = Linear, .young = 3., .poisson = 0.25};
  AbutBody        body  = CkBodyOfOrder(0, &field, ABUT_PLANE_STRESS, 0., 0., 1., 1., 1);
  const PetscReal x[2]  = {0.5, 0.5};
  PetscReal       young, poisson, thickness;

  CkOk(AbutBodyGetPlaneMaterial(body, &young, &poisson));
  ck_assert_double_eq_tol(young / (1. + poisson), 3. / 1.25, 1e-14);
  ck_assert_double_eq_tol((1. - poisson * poisson) / young, 1. / 3., 1e-15);
  ck_assert_double_eq_tol(3. - 4. * poisson, 2.75 / 1.25, 1e-14); /* Kolosov's constant */
  CkOk(AbutBodyGetThickness(body, x, &thickness));
  ck_assert_double_eq(thickness, 1.);
  CkOk(AbutBodySetKinematics(body, ABUT_PLANE_STRAIN));
  CkOk(AbutBodyGetPlaneMaterial(body, &young, &poisson));
  ck_assert_double_eq(young, 3.);
  ck_assert_double_eq(poisson, 0.25);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(a_sheet_does_not_lock)
{
  for (int which = 0; which < 5; which += 4) {
    CkField     field = {.at = Linear, .young = CK_YOUNG, .poisson = 0.4999};
    AbutBody    body  = CkBodyOfOrder(which, &field, ABUT_PLANE_STRESS, 0., 0., 1., 1., 2);
    const char *name;
    PetscBool   locks;

    CkGiveAll(body, &field, "ut", "tt", "tu", "tt");
    CkOk(AbutBodySetUp(body));
    CkOk(AbutBodyGetIntegration(body, &name, &locks));
    ck_assert_str_eq(name, "full");
    ck_assert(!locks);
    CkOk(AbutBodyDestroy(&body));
  }
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("plane_stress");
  TCase *tc    = tcase_create("all");
  int    failed;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  tcase_set_timeout(tc, 0);
  tcase_add_loop_test(tc, a_constant_strain_is_exact, 0, CK_MESHES);
  tcase_add_loop_test(tc, a_smooth_field_is_met_with_the_order_of_the_elements, 0, CK_MESHES);
  tcase_add_test(tc, the_constants_of_plane_strain_have_the_shear_modulus_and_the_compliance_of_the_sheet);
  tcase_add_test(tc, a_sheet_does_not_lock);
  suite_add_tcase(suite, tc);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
