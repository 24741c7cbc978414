/* ranks: 1 2 3 4 */
#include "ckbody.h"
#include <abutloop.h>

/* Patch test, balance, energy, point values, what is refused, and that ranks do not matter */

enum {
  GRID,
  POINT, /* ten levels */
  SCATTERED,
  ONE, /* cell or two: fewer than ranks */
  NMESHES
};

static AbutBody Make(MPI_Comm comm, CkField *field, int which, AbutShape shape)
{
  AbutBody body = CkBodyOn(comm, "body", field, 0., 0., which == ONE ? 1. : 4., 1., which == ONE ? 1 : 8, which == ONE ? 1 : 2, shape);

  if (which == POINT) CkRefine(CkMeshOf(body), CkTowardsPoint, 10);
  if (which == SCATTERED) CkRefine(CkMeshOf(body), CkScattered, 4);
  return body;
}

START_TEST(linear_displacements_are_exact_on_every_mesh)
{
  static const char *const conditions[3][4] = {
    {"uu", "uu", "uu", "uu"},
    {"ut", "tt", "tu", "tt"}, /* symmetry plane and smooth base, in kind */
    {"tu", "uu", "tt", "ut"}
  };
  CkField          linear = {.at = CkLinear};
  static PetscReal worst  = 0.;
  AbutBody         body;
  PetscReal        residual, error;
  PetscMPIInt      size;

  for (PetscInt k = 0; k < 3; ++k) {
    const char *const *c = conditions[k];

    body = Make(PETSC_COMM_WORLD, &linear, _i % NMESHES, (AbutShape)(_i / NMESHES));
    CkGiveAll(body, &linear, c[0], c[1], c[2], c[3]);
    CkOk(AbutBodySolve(body, NULL));
    error = CkNodalError(body, &linear);
    ck_assert_double_lt(error, 1e-12);
    worst = PetscMax(worst, error);
    ck_assert_double_lt(CkStressError(body, &linear),
                        _i % NMESHES == POINT ? 1e-10 : 1e-12); /* differences over cells a thousand times smaller */
    CkOk(AbutBodyGetLinearResidual(body, &residual));
    ck_assert_double_lt(residual, 1e-12);
    CkOk(AbutBodyDestroy(&body));
  }
  CkOk(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  if (_i == 2 * NMESHES - 1 && size == 1) CkCase("V13", "linear u on quads and triangles with hanging nodes", worst, 1e-12);
}
END_TEST

START_TEST(reactions_balance_the_loads_and_the_work_is_twice_the_strain_energy)
{
  CkField   smooth = {.at = CkSmooth};
  AbutBody  body   = Make(PETSC_COMM_WORLD, &smooth, _i % NMESHES, (AbutShape)(_i / NMESHES));
  PetscReal reaction[2], applied[2], strain, work;

  CkGiveAll(body, &smooth, "ut", "tt", "tu", "tt");
  CkOk(AbutBodySolve(body, NULL));
  CkOk(AbutBodyGetReaction(body, reaction, applied));
  for (PetscInt d = 0; d < 2; ++d) {
    ck_assert_double_gt(PetscAbsReal(applied[d]), 0.01);
    ck_assert_double_eq_tol(reaction[d], -applied[d], 1e-12 * (PetscAbsReal(applied[0]) + PetscAbsReal(applied[1])));
  }
  CkOk(AbutBodyGetEnergy(body, &strain, &work));
  ck_assert_double_gt(strain, 0.);
  ck_assert_double_eq_tol(work, 2. * strain, 1e-11 * work);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* sigma:eps of the linear field over the box, by its constant stress and strain */
START_TEST(the_strain_energy_of_a_constant_strain_is_its_formula)
{
  const PetscReal strain[3] = {2e-3, 4e-3, -0.75e-3}, x[2] = {0., 0.};
  CkField         linear = {.at = CkLinear};
  AbutBody        body   = Make(PETSC_COMM_WORLD, &linear, SCATTERED, (AbutShape)_i);
  PetscReal       u[2], s[3], energy, work;

  CkGiveAll(body, &linear, "uu", "uu", "uu", "uu");
  CkOk(AbutBodySolve(body, NULL));
  CkOk(AbutBodyGetEnergy(body, &energy, &work));
  CkLinear(&linear, x, u, s);
  ck_assert_double_eq_tol(energy, 0.5 * 4. * (s[0] * strain[0] + s[1] * strain[1] + 2. * s[2] * strain[2]), 1e-12 * energy);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(ranks_do_not_change_the_solution)
{
  CkField   smooth[2] = {{.at = CkSmooth}, {.at = CkSmooth}};
  PetscReal norm[2], energy[2], work, value[2][7];
  PetscInt  size[2];

  for (PetscInt k = 0; k < 2; ++k) {
    const PetscReal x[2] = {0.51, 0.26};
    AbutBody        body = Make(k ? PETSC_COMM_SELF : PETSC_COMM_WORLD, &smooth[k], _i % NMESHES, (AbutShape)(_i / NMESHES));
    Vec             u;

    CkGiveAll(body, &smooth[k], "uu", "tt", "tu", "tt");
    CkOk(AbutBodySolve(body, NULL));
    CkOk(AbutBodyGetSolution(body, &u));
    CkOk(VecNorm(u, NORM_2, &norm[k]));
    CkOk(AbutBodyGetSize(body, &size[k]));
    CkOk(AbutBodyGetEnergy(body, &energy[k], &work));
    CkOk(AbutBodyGetPointValues(body, x, value[k]));
    CkOk(AbutBodyDestroy(&body));
  }
  ck_assert_int_eq(size[0], size[1]);
  ck_assert_double_eq_tol(norm[0], norm[1], 1e-10 * norm[1]);
  ck_assert_double_eq_tol(energy[0], energy[1], 1e-10 * energy[1]);
  for (PetscInt i = 0; i < 7; ++i)
    ck_assert_double_eq_tol(value[0][i], value[1][i],
                            1e-10 * (i < 2 ? PetscAbsReal(value[1][0]) + PetscAbsReal(value[1][1]) : value[1][6]));
}
END_TEST

START_TEST(where_cells_meet_the_stress_is_the_mean_over_them)
{
  const PetscReal x[2] =
    {
      1., 0.25
  },
                  centers[2][2] = {{0.5, 0.5}, {1.5, 0.5}}, outside[2] = {2.01, 0.5};
  CkField                 smooth = {.at = CkSmooth};
  AbutBody                body   = CkBodyOn(PETSC_COMM_WORLD, "body", &smooth, 0., 0., 2., 1., 2, 1, ABUT_QUAD);
  const AbutMeshTopology *t;
  PetscReal               s[6] = {0., 0., 0., 0., 0., 0.}, value[7], vm;
  PetscErrorCode          code;

  CkGiveAll(body, &smooth, "uu", "tt", "tt", "tt");
  CkOk(AbutBodySolve(body, NULL));
  t = CkTopology(CkMeshOf(body));
  for (PetscInt c = 0; c < t->ncells; ++c)
    for (PetscInt k = 0; k < 2; ++k) {
      const PetscReal xi[2] = {k ? -1. : 1., -0.5};
      PetscReal       m[2];

      CkCenter(t, c, m);
      if (PetscAbsReal(m[0] - centers[k][0]) < 0.1) CkOk(AbutBodyGetCellStress(body, c, xi, s + 3 * k));
    }
  CkOk(MPI_Allreduce(MPI_IN_PLACE, s, 6, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  CkOk(AbutBodyGetPointValues(body, x, value));
  ck_assert_double_gt(PetscAbsReal(s[0] - s[3]), 0.01 * PetscAbsReal(s[0])); /* or the mean would be no test */
  for (PetscInt i = 0; i < 3; ++i) ck_assert_double_eq_tol(value[2 + i], 0.5 * (s[i] + s[3 + i]), 1e-12 * value[6]);
  ck_assert_double_eq_tol(value[5], CK_POISSON * (value[2] + value[3]), 1e-12 * value[6]);
  CkOk(AbutVonMises(value + 2, &vm));
  ck_assert_double_eq_tol(value[6], vm, 1e-12 * vm);
  CkCatch(code = AbutBodyGetPointValues(body, outside, value));
  ck_assert_int_eq(code, PETSC_ERR_USER_INPUT);
  ck_assert_ptr_nonnull(strstr(ck_line, "outside"));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(the_equivalent_stress_has_its_known_values)
{
  const PetscReal shear[4] = {0., 0., 2., 0.}, even[4] = {1., 1., 0., 0.6}, one[4] = {1., 0., 0., 0.3};
  PetscReal       vm;

  CkOk(AbutVonMises(shear, &vm));
  ck_assert_double_eq_tol(vm, 2. * PetscSqrtReal(3.), 1e-15);
  CkOk(AbutVonMises(even, &vm));
  ck_assert_double_eq_tol(vm, 0.4, 1e-15);
  CkOk(AbutVonMises(one, &vm));
  ck_assert_double_eq_tol(vm, PetscSqrtReal(0.79), 1e-15); /* plane strain: 1 - nu + nu^2 */
}
END_TEST

START_TEST(a_body_that_nothing_holds_is_refused_and_the_free_motion_named)
{
  static const struct {
    const char *conditions[4], *says; /* left, right, bottom, top */
  } floating[] = {
    {{"--", "--", "-u", "-u"}, "along x"},
    {{"u-", "u-", "--", "--"}, "along y"},
    {{"tt", "tt", "tt", "tt"}, "along x"},
    {{"-u", "-u", "u-", "--"}, NULL     }, /* two arms */
    {{"-u", "--", "u-", "--"}, "turn"   },
    {{"-u", "--", "--", "u-"}, "turn"   },
    {{"--", "--", "uu", "--"}, NULL     }
  };
  CkField        linear = {.at = CkLinear};
  AbutBody       body   = Make(PETSC_COMM_WORLD, &linear, ONE, ABUT_QUAD);
  AbutInterface  iface;
  PetscErrorCode code;

  CkGiveAll(body, &linear, floating[_i].conditions[0], floating[_i].conditions[1], floating[_i].conditions[2], floating[_i].conditions[3]);
  CkOk(AbutInterfaceCreate(PETSC_COMM_WORLD, 1, &body, 0, NULL, &iface)); /* a scene of one body without contact */
  CkCatch(code = AbutInterfaceCheck(iface));
  ck_assert_int_eq(code, floating[_i].says ? PETSC_ERR_USER_INPUT : 0);
  if (floating[_i].says) ck_assert(!strncmp(ck_line, "body:", 5) && strstr(ck_line, floating[_i].says));
  CkOk(AbutInterfaceDestroy(&iface));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(constants_that_no_material_has_are_refused)
{
  static const struct {
    PetscReal   young, poisson;
    const char *says;
  } bad[] = {
    {0.,     0.3, "body_material_young"  },
    {-2.1e5, 0.3, "body_material_young"  },
    {2.1e5,  0.5, "body_material_poisson"},
    {2.1e5,  0.6, "body_material_poisson"},
    {2.1e5,  -1., "body_material_poisson"}
  };
  AbutBody       body;
  PetscErrorCode code;

  CkOk(AbutBodyCreate(PETSC_COMM_WORLD, "body", &body));
  CkCatch(code = AbutBodySetMaterial(body, bad[_i].young, bad[_i].poisson));
  ck_assert_int_eq(code, PETSC_ERR_USER_INPUT);
  ck_assert_ptr_nonnull(strstr(ck_line, bad[_i].says));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

static PetscErrorCode Constant(PETSC_UNUSED const PetscReal x[2], PetscReal *value, void *ctx)
{
  *value = *(PetscReal *)ctx;
  return PETSC_SUCCESS;
}

START_TEST(what_is_set_after_a_solve_holds_for_the_next)
{
  PetscReal g[2] = {1e-3, 0.}, value[7], x[2] = {0.5, 0.5};
  CkField   linear = {.at = CkLinear};
  AbutBody  body   = Make(PETSC_COMM_WORLD, &linear, ONE, ABUT_QUAD);
  PetscInt  solves, iterations;

  CkOk(AbutBodySetDisplacement(body, "left", 0, Constant, &g[1]));
  CkOk(AbutBodySetDisplacement(body, "bottom", 1, Constant, &g[1]));
  CkOk(AbutBodySetDisplacement(body, "top", 1, Constant, &g[0]));
  for (PetscInt k = 0; k < 2; ++k) { /* strain g along y, free along x: s22 = E/(1 - nu^2) g */
    CkOk(AbutBodySolve(body, NULL));
    CkOk(AbutBodyGetPointValues(body, x, value));
    ck_assert_double_eq_tol(value[3], (k ? 2. : 1.) * CK_YOUNG / (1. - CK_POISSON * CK_POISSON) * 1e-3, 1e-11 * value[3]);
    if (!k) CkOk(AbutBodySetMaterial(body, 2. * CK_YOUNG, CK_POISSON));
  }
  g[0] = -3e-3;
  CkOk(AbutBodySetDisplacement(body, "top", 1, Constant, &g[0]));
  CkOk(AbutBodySolve(body, NULL));
  CkOk(AbutBodyGetPointValues(body, x, value));
  ck_assert_double_eq_tol(value[1], -1.5e-3, 1e-14);
  CkOk(AbutBodyGetSolveCounts(body, &solves, &iterations));
  ck_assert_int_eq(solves, 3);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("body");
  TCase *tc    = tcase_create("all");
  int    failed;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  tcase_set_timeout(tc, 0);
  tcase_add_loop_test(tc, linear_displacements_are_exact_on_every_mesh, 0, 2 * NMESHES);
  tcase_add_loop_test(tc, reactions_balance_the_loads_and_the_work_is_twice_the_strain_energy, 0, 2 * NMESHES);
  tcase_add_loop_test(tc, the_strain_energy_of_a_constant_strain_is_its_formula, 0, 2);
  tcase_add_loop_test(tc, ranks_do_not_change_the_solution, 0, 2 * NMESHES);
  tcase_add_test(tc, where_cells_meet_the_stress_is_the_mean_over_them);
  tcase_add_test(tc, the_equivalent_stress_has_its_known_values);
  tcase_add_loop_test(tc, a_body_that_nothing_holds_is_refused_and_the_free_motion_named, 0, 7);
  tcase_add_loop_test(tc, constants_that_no_material_has_are_refused, 0, 5);
  tcase_add_test(tc, what_is_set_after_a_solve_holds_for_the_next);
  suite_add_tcase(suite, tc);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
