#include "ck_box.h"
#include <abutestimator.h>

/* AbutEstimatorCompareStress() and its companions, mostly on a body at rest: the finite-element stress is zero, so eta_e^2 is the mean of
   |s|^2 over the cell divided by its mean over the body, which has closed forms */

static AbutBody  rest;
static PetscInt  calls;
static PetscReal stress_power;

static PetscErrorCode Stress_Constant(PETSC_UNUSED AbutEstimator est, PETSC_UNUSED AbutBody body, PETSC_UNUSED PetscInt c, PetscInt n,
                                      PETSC_UNUSED const PetscReal xi[], PETSC_UNUSED const PetscReal x[], PetscReal s[])
{
  for (PetscInt q = 0; q < n; ++q) {
    s[3 * q]     = 1.;
    s[3 * q + 1] = 2.;
    s[3 * q + 2] = 3.;
  }
  ++calls;
  return PETSC_SUCCESS;
}

/* s11 = x^power */
static PetscErrorCode Stress_Power(PETSC_UNUSED AbutEstimator est, PETSC_UNUSED AbutBody body, PETSC_UNUSED PetscInt c, PetscInt n,
                                   PETSC_UNUSED const PetscReal xi[], const PetscReal x[], PetscReal s[])
{
  for (PetscInt q = 0; q < n; ++q) {
    s[3 * q]     = PetscPowReal(x[2 * q], stress_power);
    s[3 * q + 1] = s[3 * q + 2] = 0.;
  }
  return PETSC_SUCCESS;
}

/* The finite-element stress and something constant on top */
static PetscErrorCode Stress_Shifted(PETSC_UNUSED AbutEstimator est, AbutBody body, PetscInt c, PetscInt n, const PetscReal xi[],
                                     PETSC_UNUSED const PetscReal x[], PetscReal s[])
{
  for (PetscInt q = 0; q < n; ++q) {
    if (AbutBodyGetCellStress(body, c, &xi[2 * q], &s[3 * q])) return PETSC_ERR_PLIB;
    s[3 * q] += 0.1;
    s[3 * q + 1] += 0.2;
    s[3 * q + 2] -= 0.3;
  }
  return PETSC_SUCCESS;
}

/* The reference points given, mapped by the mesh, must be the points given: eta is zero or the two do not agree */
static PetscErrorCode Stress_Points(PETSC_UNUSED AbutEstimator est, AbutBody body, PetscInt c, PetscInt n, const PetscReal xi[],
                                    const PetscReal x[], PetscReal s[])
{
  AbutMesh  mesh;
  PetscReal at[2], N[4], G[8], det;

  if (AbutBodyGetMesh(body, &mesh)) return PETSC_ERR_PLIB;
  for (PetscInt q = 0; q < n; ++q) {
    if (AbutMeshMapCell(mesh, c, &xi[2 * q], at, N, G, &det)) return PETSC_ERR_PLIB;
    for (PetscInt i = 0; i < 3; ++i) s[3 * q + i] = i < 2 ? at[i] - x[2 * q + i] : 0.;
  }
  return PETSC_SUCCESS;
}

/* Mean of x^n over a cell: over an interval for quads with upright sides, over a triangle by complete symmetric polynomials */
static PetscReal Mean(const AbutMeshTopology *t, PetscInt c, PetscInt n)
{
  PetscReal a[4], h[3] = {0., 0., 0.};

  for (PetscInt k = 0; k < t->corners; ++k) a[k] = t->x[2 * t->cell[t->corners * c + k]];
  if (t->corners == 4) {
    const PetscReal lo = PetscMin(a[0], a[2]), hi = PetscMax(a[0], a[2]);

    return (PetscPowRealInt(hi, n + 1) - PetscPowRealInt(lo, n + 1)) / ((n + 1) * (hi - lo));
  }
  for (PetscInt i = 0; i <= n; ++i)
    for (PetscInt j = 0; i + j <= n; ++j)
      h[0] += (i ? PetscPowRealInt(a[0], i) : 1.) * (j ? PetscPowRealInt(a[1], j) : 1.) *
              (n - i - j ? PetscPowRealInt(a[2], n - i - j) : 1.);
  return 2. * h[0] / ((n + 1) * (n + 2));
}

static PetscBool TouchesBoundary(const AbutMeshTopology *t, PetscInt c)
{
  for (PetscInt k = 0; k < t->corners; ++k) {
    const PetscReal *p = &t->x[2 * t->cell[t->corners * c + k]];

    if (p[0] < 1e-12 || p[0] > 1. - 1e-12 || p[1] < 1e-12 || p[1] > 1. - 1e-12) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static void Compare(AbutBody body, AbutStressFunction stress, Vec *eta)
{
  AbutEstimator est;
  PetscReal    *e;

  CkOk(AbutEstimatorCreate(PETSC_COMM_WORLD, &est));
  CkOk(AbutBodyCreateCellVec(body, eta));
  CkOk(VecGetArray(*eta, &e));
  CkOk(AbutEstimatorCompareStress(est, body, stress, e));
  CkOk(VecRestoreArray(*eta, &e));
  CkOk(AbutEstimatorDestroy(&est));
}

START_TEST(a_constant_stress_against_none_gives_one_everywhere)
{
  const AbutMeshTopology *t;
  PetscReal               total, largest;
  Vec                     eta;

  rest  = CkBox(PETSC_COMM_WORLD, _i ? ABUT_TRIANGLE : ABUT_QUAD, 1., 4, 4, NULL, NULL);
  t     = CkTopology(rest);
  calls = 0;
  Compare(rest, Stress_Constant, &eta);
  ck_assert_int_eq(calls, t->ncells); /* all points of a cell at once */
  CkOk(AbutEstimatorGetNorms(rest, eta, &total, &largest));
  ck_assert_double_eq_tol(total, 1., 1e-13);
  ck_assert_double_eq_tol(largest, 1., 1e-13);
  CkOk(VecDestroy(&eta));
  CkOk(AbutBodyDestroy(&rest));
}
END_TEST

START_TEST(a_linear_stress_is_integrated_exactly_on_every_cell)
{
  const AbutMeshTopology *t;
  const PetscReal        *e;
  Vec                     eta;

  rest         = CkBox(PETSC_COMM_WORLD, _i ? ABUT_TRIANGLE : ABUT_QUAD, 1., 4, 4, NULL, NULL);
  t            = CkTopology(rest);
  stress_power = 1.;
  Compare(rest, Stress_Power, &eta);
  CkOk(VecGetArrayRead(eta, &e));
  for (PetscInt c = 0; c < t->ncells; ++c) ck_assert_double_eq_tol(PetscSqr(e[c]), Mean(t, c, 2) * 3., 1e-12);
  CkOk(VecRestoreArrayRead(eta, &e));
  CkOk(VecDestroy(&eta));
  CkOk(AbutBodyDestroy(&rest));
}
END_TEST

/* Cells of order p: x^p, whose square has degree 2p, within the rules of p+1 points */
START_TEST(a_stress_of_the_order_of_the_cells_is_integrated_exactly)
{
  const PetscInt          order = 1 + _i % 4;
  const AbutMeshTopology *t;
  const PetscReal        *e;
  char                    text[8];
  Vec                     eta;

  CkOk(PetscSNPrintf(text, sizeof(text), "%d", (int)order));
  CkOk(PetscOptionsSetValue(NULL, "-box_mesh_order", text));
  rest = CkBox(PETSC_COMM_WORLD, _i < 4 ? ABUT_QUAD : ABUT_TRIANGLE, 1., 4, 4, NULL, NULL);
  CkOk(PetscOptionsClearValue(NULL, "-box_mesh_order"));
  t            = CkTopology(rest);
  stress_power = order;
  Compare(rest, Stress_Power, &eta);
  CkOk(VecGetArrayRead(eta, &e));
  ck_assert_int_eq(t->order, order);
  for (PetscInt c = 0; c < t->ncells; ++c)
    ck_assert_double_eq_tol(PetscSqr(e[c]), Mean(t, c, 2 * order) * (2. * order + 1.), 1e-12 * (2. * order + 1.));
  CkOk(VecRestoreArrayRead(eta, &e));
  CkOk(VecDestroy(&eta));
  CkOk(AbutBodyDestroy(&rest));
}
END_TEST

/* With s11 = x^2, whose square has degree 4, beyond 2x2 and 3 points, within 3x3 and 6 points */
static void CheckRules(AbutShape shape, PetscInt nx, PetscInt ny)
{
  const AbutMeshTopology *t;
  const PetscReal        *e;
  PetscReal               range[2] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL}; /* minus the least and the greatest ratio at the boundary */
  Vec                     eta;

  rest         = CkBox(PETSC_COMM_WORLD, shape, 1., nx, ny, NULL, NULL);
  t            = CkTopology(rest);
  stress_power = 2.;
  Compare(rest, Stress_Power, &eta);
  CkOk(VecGetArrayRead(eta, &e));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    const PetscReal ratio = PetscSqr(e[c]) / Mean(t, c, 4);

    if (!TouchesBoundary(t, c)) continue;
    range[0] = PetscMax(range[0], -ratio);
    range[1] = PetscMax(range[1], ratio);
  }
  CkOk(MPI_Allreduce(MPI_IN_PLACE, range, 2, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  ck_assert_double_eq_tol(-range[0], range[1], 1e-10 * range[1]);
  for (PetscInt c = 0; c < t->ncells; ++c)
    if (!TouchesBoundary(t, c)) ck_assert_double_gt(PetscAbsReal(PetscSqr(e[c]) / Mean(t, c, 4) / range[1] - 1.), 1e-6);
  CkOk(VecRestoreArrayRead(eta, &e));
  CkOk(VecDestroy(&eta));
  CkOk(AbutBodyDestroy(&rest));
}

/* Among many meshes of triangles there are cuts where a triangle touches the boundary only by a vertex whose sides are another rank's */
START_TEST(cells_that_touch_the_boundary_have_the_richer_rule_on_any_number_of_ranks)
{
  CheckRules(ABUT_QUAD, 6, 6);
  for (PetscInt nx = 2; nx <= 9; ++nx)
    for (PetscInt ny = 2; ny <= 6; ++ny) CheckRules(ABUT_TRIANGLE, nx, ny);
}
END_TEST

START_TEST(reference_points_and_points_in_space_agree)
{
  PetscReal total, largest;
  Vec       eta;

  rest = CkBox(PETSC_COMM_WORLD, _i ? ABUT_TRIANGLE : ABUT_QUAD, 1., 4, 4, NULL, NULL);
  CkRefine(rest, 0., 0., 0.3);
  Compare(rest, Stress_Points, &eta);
  CkOk(AbutEstimatorGetNorms(rest, eta, &total, &largest));
  ck_assert_double_eq(largest, 0.); /* which also is the answer where there is no stress at all: not a NaN */
  CkOk(VecDestroy(&eta));
  CkOk(AbutBodyDestroy(&rest));
}
END_TEST

static PetscErrorCode Stretch(const PetscReal x[2], PetscReal *value, PETSC_UNUSED void *ctx)
{
  *value = x[0];
  return PETSC_SUCCESS;
}

static PetscErrorCode One(PETSC_UNUSED const PetscReal x[2], PetscReal *value, PETSC_UNUSED void *ctx)
{
  *value = 1.;
  return PETSC_SUCCESS;
}

START_TEST(a_shifted_uniform_stress_gives_the_shift_over_the_stress)
{
  const PetscReal E = 1., nu = 0.3, s11 = E * (1. - nu) / ((1. + nu) * (1. - 2. * nu)),
                  s22   = s11 * nu / (1. - nu); /* of the strain e11 = 1 */
  const PetscReal shift = PetscSqrtReal(0.01 + 0.04 + 2. * 0.09),
                  norm  = PetscSqrtReal(PetscSqr(s11 + 0.1) + PetscSqr(s22 + 0.2) + 2. * 0.09);
  PetscReal total, largest;
  Vec       eta;

  rest = CkBox(PETSC_COMM_WORLD, _i ? ABUT_TRIANGLE : ABUT_QUAD, 1., 4, 4, Stretch, NULL);
  CkRefine(rest, 0.5, 0.5, 0.1);
  CkOk(AbutBodySolve(rest, NULL));
  Compare(rest, Stress_Shifted, &eta);
  CkOk(AbutEstimatorGetNorms(rest, eta, &total, &largest));
  ck_assert_double_eq_tol(total, shift / norm, 1e-10);
  ck_assert_double_eq_tol(largest, shift / norm, 1e-10);
  CkOk(VecDestroy(&eta));
  CkOk(AbutBodyDestroy(&rest));
}
END_TEST

static PetscErrorCode Stress_Own(PETSC_UNUSED AbutEstimator est, AbutBody body, PetscInt c, PetscInt n, const PetscReal xi[],
                                 PETSC_UNUSED const PetscReal x[], PetscReal s[])
{
  for (PetscInt q = 0; q < n; ++q) {
    if (AbutBodyGetCellStress(body, c, &xi[2 * q], &s[3 * q])) return PETSC_ERR_PLIB;
    for (PetscInt i = 0; i < 3; ++i) s[3 * q + i] *= 2.; /* all round-off, but eta = 1/2 by the formula */
  }
  return PETSC_SUCCESS;
}

START_TEST(a_body_moved_as_a_rigid_one_has_no_error)
{
  PetscReal total, largest;
  Vec       eta;

  rest = CkBox(PETSC_COMM_WORLD, _i ? ABUT_TRIANGLE : ABUT_QUAD, 1., 4, 4, One, One);
  CkOk(AbutBodySolve(rest, NULL));
  Compare(rest, Stress_Own, &eta);
  CkOk(AbutEstimatorGetNorms(rest, eta, &total, &largest));
  ck_assert_double_eq(largest, 0.);
  CkOk(VecDestroy(&eta));
  CkOk(AbutBodyDestroy(&rest));
}
END_TEST

START_TEST(the_norms_weigh_cells_by_area)
{
  const AbutMeshTopology *t;
  PetscReal               total, largest, *e;
  Vec                     eta;

  rest = CkBox(PETSC_COMM_WORLD, ABUT_QUAD, 2., 4, 2, NULL, NULL);
  CkRefine(rest, 0., 0., 0.1); /* the cell at the origin, 1/8 of the body, becomes four */
  t = CkTopology(rest);
  CkOk(AbutBodyCreateCellVec(rest, &eta));
  CkOk(VecGetArray(eta, &e));
  for (PetscInt c = 0; c < t->ncells; ++c) e[c] = t->level[c] ? 3. : 1.;
  CkOk(VecRestoreArray(eta, &e));
  CkOk(AbutEstimatorGetNorms(rest, eta, &total, &largest));
  ck_assert_double_eq_tol(total, PetscSqrtReal((9. + 7.) / 8.), 1e-14);
  ck_assert_double_eq(largest, 3.);
  CkOk(VecDestroy(&eta));
  CkOk(AbutBodyDestroy(&rest));
}
END_TEST

START_TEST(vertices_sum_over_the_cells_of_all_ranks)
{
  const AbutMeshTopology *t;
  PetscReal              *v;

  rest = CkBox(PETSC_COMM_WORLD, ABUT_QUAD, 1., 4, 4, NULL, NULL);
  t    = CkTopology(rest);
  CkOk(PetscCalloc1(2 * t->nunknown, &v));
  for (PetscInt i = 0; i < 4 * t->ncells; ++i) {
    v[2 * t->unknown[t->cell[i]]] += 1.;
    v[2 * t->unknown[t->cell[i]] + 1] += 0.5;
  }
  CkOk(AbutEstimatorSumAtVertices(rest, 2, v));
  for (PetscInt i = 0; i < t->nvertices; ++i) {
    const PetscReal *p     = &t->x[2 * i];
    const PetscReal  cells = (p[0] > 0. && p[0] < 1. ? 2. : 1.) * (p[1] > 0. && p[1] < 1. ? 2. : 1.);

    ck_assert_double_eq(v[2 * t->unknown[i]], cells);
    ck_assert_double_eq(v[2 * t->unknown[i] + 1], 0.5 * cells);
  }
  CkOk(PetscFree(v));
  CkOk(AbutBodyDestroy(&rest));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("compare");
  TCase *tests = tcase_create("stress");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  tcase_add_loop_test(tests, a_constant_stress_against_none_gives_one_everywhere, 0, 2);
  tcase_add_loop_test(tests, a_linear_stress_is_integrated_exactly_on_every_cell, 0, 2);
  tcase_add_loop_test(tests, a_stress_of_the_order_of_the_cells_is_integrated_exactly, 0, 7);
  tcase_add_test(tests, cells_that_touch_the_boundary_have_the_richer_rule_on_any_number_of_ranks);
  tcase_add_loop_test(tests, reference_points_and_points_in_space_agree, 0, 2);
  tcase_add_loop_test(tests, a_shifted_uniform_stress_gives_the_shift_over_the_stress, 0, 2);
  tcase_add_loop_test(tests, a_body_moved_as_a_rigid_one_has_no_error, 0, 2);
  tcase_add_test(tests, the_norms_weigh_cells_by_area);
  tcase_add_test(tests, vertices_sum_over_the_cells_of_all_ranks);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
