/* ranks: 1 2 3 4 */
#include "ckkinematics.h"

/* Bodies of revolution about x = 0, against formulas: bars, tubes under pressure, and a field that is no polynomial */

/* A bar pulled along its axis: u_r = -nu e r, u_z = e z */
static void Bar(const CkField *field, const PetscReal x[2], PetscReal u[2], PetscReal s[3])
{
  const PetscReal e = 2e-3;

  u[0] = -field->poisson * e * x[0];
  u[1] = e * x[1];
  s[0] = s[2] = 0.;
  s[1]        = field->young * e;
}

/* Pressed from aside and free along the axis, s_rr = s_tt = -p */
static void Squeezed(const CkField *field, const PetscReal x[2], PetscReal u[2], PetscReal s[3])
{
  const PetscReal p = 300., E = field->young, nu = field->poisson;

  u[0] = -p * (1. - nu) / E * x[0];
  u[1] = 2. * nu * p / E * x[1];
  s[0] = -p;
  s[1] = s[2] = 0.;
}

/* G. Lame: radii a and b, pressure p inside, no strain along the axis */
#define LAME_A 1.
#define LAME_B 2.
#define LAME_P 100.
static void Lame(const CkField *field, const PetscReal x[2], PetscReal u[2], PetscReal s[3])
{
  const PetscReal a2 = LAME_A * LAME_A, b2 = LAME_B * LAME_B, k = LAME_P * a2 / (b2 - a2), nu = field->poisson;

  u[0] = (1. + nu) / field->young * k * ((1. - 2. * nu) * x[0] + b2 / x[0]);
  u[1] = 0.;
  s[0] = k * (1. - b2 / PetscSqr(x[0]));
  s[1] = 2. * nu * k;
  s[2] = 0.;
}

/* On a solid bar whose axis nothing holds by hand, and on a tube */
START_TEST(constant_stresses_are_exact)
{
  for (int k = 0; k < 4; ++k) {
    CkField         field   = {.at = k % 2 ? Squeezed : Bar, .young = CK_YOUNG, .poisson = 0.3};
    const PetscReal a       = k / 2;
    AbutBody        body    = CkBodyOfOrder(_i, &field, ABUT_AXISYMMETRIC, a, 0., a + 1.5, 2., 3);
    const PetscReal axis[2] = {a, 0.7}, volume = PETSC_PI * (PetscSqr(a + 1.5) - a * a) * 2.;
    PetscReal       l2, stress, value[7], u[2], s[4], strain, work, reaction[2], applied[2], sum = 0.;

    CkGiveAll(body, &field, "tt", "tt", "tu", "tt");
    CkOk(AbutBodySolve(body, NULL));
    CkErrors3D(body, &field, &l2, &stress);
    ck_assert_double_le(l2, 1e-9);
    ck_assert_double_le(stress, 1e-9);
    CkOk(AbutBodyGetPointValues(body, axis, value)); /* at r = 0 as well */
    field.at(&field, axis, u, s);
    s[3] = k % 2 ? -300. : 0.;
    for (PetscInt i = 0; i < 4; ++i) ck_assert_double_eq_tol(value[2 + i], s[i], 1e-7 * value[6]);
    CkOk(AbutBodyGetReaction(body, reaction, applied));
    ck_assert_double_eq_tol(applied[1], s[1] * volume / 2., 1e-9 * volume * value[6]);
    ck_assert_double_eq_tol(reaction[1], -applied[1], 1e-8 * volume * value[6]);
    ck_assert_double_eq(reaction[0], 0.);
    CkOk(AbutBodyGetEnergy(body, &strain, &work));
    ck_assert_double_eq_tol(strain, volume * (k % 2 ? 300. * 300. * (1. - 0.3) / CK_YOUNG : 0.5 * CK_YOUNG * 4e-6), 1e-8 * strain);
    ck_assert_double_eq_tol(work, 2. * strain, 1e-8 * strain);
    for (PetscInt c = 0; c < CkTopology(CkMeshOf(body))->ncells; ++c) {
      PetscReal one;

      CkOk(AbutBodyGetCellMeasure(body, c, &one));
      sum += one;
    }
    ck_assert_double_eq_tol(CkTotal(sum), volume, 1e-13 * volume);
    CkOk(AbutBodyDestroy(&body));
  }
}
END_TEST

START_TEST(a_field_that_is_no_polynomial_is_met_with_the_order_of_the_elements)
{
  const PetscInt  order   = 1 + _i % 7 % 4;
  CkField         field   = {.at = CkBessel, .young = CK_YOUNG, .poisson = 0.3};
  AbutBody        body    = CkBodyOfOrder(_i, &field, ABUT_AXISYMMETRIC, 0., 0.5, 1., 1.5, 4);
  const PetscReal axis[2] = {0., 0.8};
  PetscReal       l2[2], stress[2], value[7];

  CkGiveAll(body, &field, "--", "tt", "tu", "tt");
  for (PetscInt i = 0; i < 2; ++i) {
    CkRefine(CkMeshOf(body), CkEverywhere, 1);
    CkOk(AbutBodySolve(body, NULL));
    CkErrors3D(body, &field, &l2[i], &stress[i]);
  }
  ck_assert_double_eq_tol(PetscLog2Real(stress[0] / stress[1]), (double)order, _i < 11 ? 0.12 : 0.2); /* bisected triangles change shape */
  ck_assert_double_gt(PetscLog2Real(l2[0] / l2[1]), order + 0.8);
  CkOk(AbutBodyGetPointValues(body, axis, value));
  ck_assert_double_eq_tol(value[0], 0., 1e-14 * PetscAbsReal(value[1]));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

static AbutBody MakeLame(int which, CkField *field, PetscInt n)
{
  AbutBody body = CkBodyOfOrder(which, field, ABUT_AXISYMMETRIC, LAME_A, 0., LAME_B, 0.5, n);

  CkGiveAll(body, field, "tt", "tt", "tu", "tu");
  return body;
}

START_TEST(a_tube_under_pressure_is_that_of_lame)
{
  const PetscInt order = 1 + _i % 7 % 4;
  CkField        field = {.at = Lame, .young = CK_YOUNG, .poisson = 0.3};
  AbutBody       body  = MakeLame(_i, &field, 4);
  PetscReal      l2[3], stress[3];

  for (PetscInt i = 0; i < 3; ++i) {
    CkRefine(CkMeshOf(body), CkEverywhere, i ? 1 : 0);
    CkOk(AbutBodySolve(body, NULL));
    CkErrors3D(body, &field, &l2[i], &stress[i]);
  }
  PetscCallAbort(PETSC_COMM_WORLD, PetscPrintf(PETSC_COMM_WORLD, "mesh %2d, order %" PetscInt_FMT ": displacement %.2e, stress %.2e\n", _i,
                                               order, (double)l2[2], (double)stress[2]));
  ck_assert_double_eq_tol(PetscLog2Real(stress[1] / stress[2]), (double)order, 0.2);
  ck_assert_double_gt(PetscLog2Real(l2[1] / l2[2]), order + 0.8);
  if (order > 1) ck_assert_double_lt(l2[2], 1e-4);
  if (order > 2) ck_assert_double_lt(stress[2], 1e-4);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* Full integration would leave next to nothing of the displacement */
START_TEST(a_tube_that_is_next_to_incompressible_does_not_lock)
{
  CkField         field = {.at = Lame, .young = CK_YOUNG, .poisson = 0.49999};
  AbutBody        body  = MakeLame(_i ? 7 : 0, &field, 8); /* quads of order 1 */
  const PetscReal x[2]  = {LAME_B, 0.25};
  PetscReal       value[7], u[2], s[3], strain, work, product = 0.;
  const char     *name;

  CkOk(AbutBodySolve(body, NULL));
  CkOk(AbutBodyGetIntegration(body, &name, NULL));
  ck_assert_str_eq(name, "mean_dilatation");
  Lame(&field, x, u, s);
  CkOk(AbutBodyGetPointValues(body, x, value));
  ck_assert_double_eq_tol(value[0], u[0], 0.01 * u[0]);
  CkOk(AbutBodyGetEnergy(body, &strain, &work));
  ck_assert_double_eq_tol(work, 2. * strain, 1e-7 * strain);
  for (PetscInt c = 0; c < CkTopology(CkMeshOf(body))->ncells; ++c) /* the stress is that of the stiffness */
    for (PetscInt q = 0; q < 4; ++q) {
      const PetscReal         g = 1. / PetscSqrtReal(3.), xi[2] = {q % 2 ? g : -g, q / 2 ? g : -g};
      const AbutMeshTopology *t = CkTopology(CkMeshOf(body));
      PetscReal               N[4], G[8], dN[8], at[2], det, area, e[4] = {0.}, sh[4];
      const PetscReal        *uh;

      CkOk(AbutBodyGetNodeDisplacement(body, &uh));
      CkOk(AbutMeshEvaluateBasis(CkMeshOf(body), xi, N, dN));
      CkOk(AbutMeshMapCell(CkMeshOf(body), c, xi, at, N, G, &area));
      CkOk(AbutBodyGetCellPoint(body, c, xi, at, &det));
      CkOk(AbutBodyGetCellStresses3D(body, c, 1, xi, dN, sh, sh + 3));
      for (PetscInt k = 0; k < 4; ++k) {
        const PetscReal *a = uh + 2 * t->cellnode[4 * c + k];

        e[0] += G[2 * k] * a[0];
        e[1] += G[2 * k + 1] * a[1];
        e[2] += G[2 * k + 1] * a[0] + G[2 * k] * a[1];
        e[3] += N[k] * a[0] / at[0];
      }
      product += det * (sh[0] * e[0] + sh[1] * e[1] + sh[2] * e[2] + sh[3] * e[3]);
    }
  ck_assert_double_eq_tol(CkTotal(product), 2. * strain, 1e-8 * strain);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* Tractions that are in balance on a body that nothing holds */
START_TEST(the_only_rigid_motion_is_along_the_axis)
{
  CkField    field = {.at = Bar, .young = CK_YOUNG, .poisson = 0.3};
  AbutBody   body  = CkBodyOfOrder(1, &field, ABUT_AXISYMMETRIC, 0., 0., 1., 1., 3);
  PetscInt   n;
  PetscReal  imbalance[3], l2, stress;
  const Vec *modes;
  char       text[64];

  CkGiveAll(body, &field, "tt", "tt", "tt", "tt");
  CkOk(AbutBodyGetFreeModeCount(body, &n));
  ck_assert_int_eq(n, 1);
  CkOk(AbutBodyGetFreeModeName(body, 0, text, sizeof(text)));
  ck_assert_str_eq(text, "moving along y");
  CkOk(AbutBodySolve(body, NULL));
  CkOk(AbutBodyGetFreeModes(body, &n, &modes));
  ck_assert_int_eq(n, 1);
  CkOk(AbutBodyGetImbalance(body, PETSC_TRUE, imbalance));
  ck_assert_double_eq(imbalance[0], 0.);
  CkErrors3D(body, &field, &l2, &stress);
  ck_assert_double_le(stress, 1e-8);
  CkOk(AbutBodyDestroy(&body));
  body = CkBodyOfOrder(1, &field, ABUT_AXISYMMETRIC, 0., 0., 1., 1., 3);
  CkGiveAll(body, &field, "--", "--", "-u", "--");
  CkOk(AbutBodyGetFreeModeCount(body, &n));
  ck_assert_int_eq(n, 0);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(a_mesh_beyond_the_axis_is_refused)
{
  CkField        field = {.at = Bar, .young = CK_YOUNG, .poisson = 0.3};
  AbutBody       body  = CkBodyOfOrder(0, &field, ABUT_AXISYMMETRIC, -0.5, 0., 1., 1., 3);
  PetscErrorCode code;

  CkGiveAll(body, &field, "tt", "tt", "tu", "tt");
  CkCatch(code = AbutBodySetUp(body));
  ck_assert_int_eq(code, PETSC_ERR_USER_INPUT);
  ck_assert_ptr_nonnull(strstr(ck_line, "body_mesh_*: begins at x = -0.5"));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* No more than in the plane, where it is 8 to 12 */
START_TEST(multigrid_takes_few_iterations)
{
  static const char *const options[2] = {"-body_ksp_type cg -body_pc_type hypre", "-body_ksp_type cg -body_pc_type gamg"};

  for (int a = 0; a < 2; ++a) {
    CkField  field = {.at = Bar, .young = CK_YOUNG, .poisson = 0.3};
    AbutBody body  = CkBodyOfOrder(0, &field, ABUT_AXISYMMETRIC, a, 0., a + 1., 1., 64);
    PetscInt solves, its;

    CkOptions(options[_i]);
    CkOk(AbutBodySetFromOptions(body));
    CkGiveAll(body, &field, "tt", "tt", "tu", "tt");
    CkOk(AbutBodySolve(body, NULL));
    CkOptionsEnd();
    CkOk(AbutBodyGetSolveCounts(body, &solves, &its));
    CkOk(PetscPrintf(PETSC_COMM_WORLD, "%s, %s: %" PetscInt_FMT " iterations\n", options[_i], a ? "tube" : "bar", its));
    ck_assert_int_le(its, _i ? 40 : 20);
    CkOk(AbutBodyDestroy(&body));
  }
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("axial");
  TCase *tc    = tcase_create("all");
  int    failed;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  tcase_set_timeout(tc, 0);
  tcase_add_loop_test(tc, constant_stresses_are_exact, 0, CK_MESHES);
  tcase_add_loop_test(tc, a_field_that_is_no_polynomial_is_met_with_the_order_of_the_elements, 0, CK_MESHES);
  tcase_add_loop_test(tc, a_tube_under_pressure_is_that_of_lame, 0, CK_MESHES);
  tcase_add_loop_test(tc, a_tube_that_is_next_to_incompressible_does_not_lock, 0, 2);
  tcase_add_test(tc, the_only_rigid_motion_is_along_the_axis);
  tcase_add_test(tc, a_mesh_beyond_the_axis_is_refused);
  tcase_add_loop_test(tc, multigrid_takes_few_iterations, 0, 2);
  suite_add_tcase(suite, tc);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
