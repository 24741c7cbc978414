#include "ckbody.h"
#include <abutestimator.h>
#include <abutscene.h>

/* The residual estimator on bodies whose stress is known */

/* The orders there are: i = 0..6 are quads of orders 1 to 4, triangles of orders 1 to 3 */
static AbutShape Shape(int i)
{
  return i < 4 ? ABUT_QUAD : ABUT_TRIANGLE;
}

static PetscInt Order(int i)
{
  return i < 4 ? i + 1 : i - 3;
}

static PetscErrorCode Zero(PETSC_UNUSED const PetscReal x[2], PetscReal *value, PETSC_UNUSED void *ctx)
{
  *value = 0.;
  return PETSC_SUCCESS;
}

/* eta of the whole body and of its worst cell; the place of the worst cell, the same on all ranks */
static void Estimate(AbutBody body, PetscReal *total, PetscReal *largest, PetscReal worst[2])
{
  const AbutMeshTopology *t = CkTopology(CkMeshOf(body));
  AbutEstimator           est;
  Vec                     eta;
  const PetscReal        *e;
  PetscReal               center[2];

  CkOk(AbutEstimatorCreate(PetscObjectComm((PetscObject)body), &est));
  CkOk(AbutEstimatorSetType(est, ABUTESTIMATORRESIDUAL)); /* opens the plugin */
  CkOk(AbutBodyCreateCellVec(body, &eta));
  CkOk(AbutEstimatorEstimate(est, body, eta));
  CkOk(AbutEstimatorGetNorms(body, eta, total, largest));
  if (worst) {
    worst[0] = worst[1] = PETSC_MIN_REAL;
    CkOk(VecGetArrayRead(eta, &e));
    for (PetscInt c = 0; c < t->ncells; ++c) {
      CkCenter(t, c, center);
      for (PetscInt d = 0; d < 2 && e[c] == *largest; ++d) worst[d] = center[d];
    }
    CkOk(VecRestoreArrayRead(eta, &e));
    CkOk(MPI_Allreduce(MPI_IN_PLACE, worst, 2, MPIU_REAL, MPIU_MAX, PetscObjectComm((PetscObject)body)));
  }
  CkOk(VecDestroy(&eta));
  CkOk(AbutEstimatorDestroy(&est));
}

/* Relative error of the stress in the norm of the estimators, 25 points a cell */
static PetscReal TrueError(AbutBody body, const CkField *field)
{
  const AbutMeshTopology *t      = CkTopology(CkMeshOf(body));
  PetscReal               sum[2] = {0., 0.}, z[5], w[5], x[2], u[2], s[2][3], det;

  CkOk(PetscDTGaussQuadrature(5, 0., 1., z, w));
  for (PetscInt c = 0; c < t->ncells; ++c)
    for (PetscInt q = 0; q < 25; ++q) {
      const PetscReal a = z[q / 5], b = z[q % 5], xi[2] = {t->corners == 4 ? 2. * a - 1. : a, t->corners == 4 ? 2. * b - 1. : b * (1. - a)};
      const PetscReal weight = (t->corners == 4 ? 4. : 1. - a) * w[q / 5] * w[q % 5];

      CkOk(AbutBodyGetCellPoint(body, c, xi, x, &det));
      CkOk(AbutBodyGetCellStress(body, c, xi, s[0]));
      field->at(field, x, u, s[1]);
      for (PetscInt i = 0; i < 3; ++i) {
        sum[0] += (i == 2 ? 2. : 1.) * weight * det * PetscSqr(s[0][i] - s[1][i]);
        sum[1] += (i == 2 ? 2. : 1.) * weight * det * PetscSqr(s[1][i]);
      }
    }
  CkOk(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPIU_SUM, PetscObjectComm((PetscObject)body)));
  return PetscSqrtReal(sum[0] / sum[1]);
}

/* [0,1]x[0,1]: held on the left, sliding on the right, loaded below and above */
static AbutBody Body(MPI_Comm comm, CkField *field, int i, PetscInt n, CkMark mark, PetscInt times)
{
  AbutBody body;

  field->order = Order(i);
  body         = CkBodyOn(comm, "body", field, 0., 0., 1., 1., n, n, Shape(i));
  CkGiveAll(body, field, "uu", "ut", "tt", "tt");
  CkRefine(CkMeshOf(body), mark, times);
  CkOk(AbutBodySetUp(body));
  CkOk(AbutBodySolve(body, NULL));
  return body;
}

static PetscReal Uniform(PETSC_UNUSED PetscReal x)
{
  return 1000.;
}

static PetscReal Hertz(PetscReal x)
{
  return x < 0.5 ? 2000. * PetscSqrtReal(0.25 - x * x) : 0.;
}

/* Nodal contact forces on the top side, the integrals of p N_i over its elements, which are cut at x = 1/2 */
static Vec Press(AbutBody body, PetscReal (*pressure)(PetscReal))
{
  const AbutSide *side;
  PetscReal      *force, z[16], w[16], N[ABUT_ORDER_MAX + 1];
  Vec             f;

  CkOk(AbutBodyGetSide(body, 3, &side));
  CkOk(PetscCalloc1(side->n, &force));
  CkOk(PetscDTGaussQuadrature(16, 0., 1., z, w));
  for (PetscInt i = 0; i + 1 < side->n; i += side->order) {
    const PetscReal l = side->x[2 * (i + side->order)], r = side->x[2 * i], cut[3] = {l, PetscMin(PetscMax(l, 0.5), r), r};

    for (PetscInt q = 0; q < 32; ++q) { /* points crowd at the end of each part, where the pressure may have a root */
      const PetscReal h = cut[q / 16 + 1] - cut[q / 16], x = cut[q / 16] + h * (1. - PetscSqr(z[q % 16]));

      CkOk(AbutEvaluateLobatto(side->order, 2. * (r - x) / (r - l) - 1., N, NULL));
      for (PetscInt k = 0; k <= side->order; ++k) force[i + k] -= 2. * h * z[q % 16] * w[q % 16] * N[k] * (*pressure)(x);
    }
  }
  CkOk(AbutBodyCreateVec(body, &f));
  CkOk(AbutBodyAddSideForce(body, 3, 1, force, f));
  CkOk(PetscFree(force));
  return f;
}

static void CheckZero(AbutBody body)
{
  PetscReal total, largest;

  Estimate(body, &total, &largest, NULL);
  ck_assert_double_lt(largest, 1e-9);
  CkOk(AbutBodyDestroy(&body));
}

START_TEST(nothing_is_left_of_a_linear_displacement)
{
  CkField field = {.at = CkLinear};

  CheckZero(Body(PETSC_COMM_WORLD, &field, _i, 4, CkScattered, 0));
  CheckZero(Body(PETSC_COMM_WORLD, &field, _i, 4, CkScattered, 2));
}
END_TEST

/* Uniaxial stress: s22 = -1000 by contact on the top, which ends at a free side and at one that slides */
START_TEST(nothing_is_left_of_a_uniform_pressure)
{
  for (PetscInt times = 0; times <= 2; times += 2) {
    CkField  field = {.order = Order(_i)};
    AbutBody body  = CkBodyOn(PETSC_COMM_WORLD, "body", &field, 0., 0., 1., 1., 3, 3, Shape(_i));
    Vec      f;

    CkOk(AbutBodySetDisplacement(body, "left", 0, Zero, NULL));
    CkOk(AbutBodySetDisplacement(body, "bottom", 1, Zero, NULL));
    CkOk(AbutBodySetContact(body, 3));
    CkRefine(CkMeshOf(body), CkScattered, times);
    CkOk(AbutBodySetUp(body));
    f = Press(body, Uniform);
    CkOk(AbutBodySolve(body, f));
    CkOk(VecDestroy(&f));
    CheckZero(body);
  }
}
END_TEST

START_TEST(a_smooth_error_is_estimated)
{
  PetscReal total[3], error, effectivity, largest;

  for (PetscInt k = 0; k < 3; ++k) {
    CkField  field = {.at = CkSmooth};
    AbutBody body  = Body(PETSC_COMM_WORLD, &field, _i, 4 << k, CkEverywhere, 0);

    Estimate(body, &total[k], &largest, NULL);
    error       = TrueError(body, &field);
    effectivity = total[k] / error;
    PetscPrintf(PETSC_COMM_WORLD, "%s%d, h = 1/%d: error %.3e, effectivity %.3f\n", Shape(_i) == ABUT_QUAD ? "Q" : "P", (int)Order(_i),
                4 << k, (double)error, (double)effectivity);
    ck_assert_double_eq_tol(effectivity, 1., 0.25);
    if (k) ck_assert_double_eq_tol(PetscLog2Real(total[k - 1] / total[k]), Order(_i), 0.1);
    CkOk(AbutBodyDestroy(&body));
  }
}
END_TEST

START_TEST(an_error_on_a_locally_refined_mesh_is_estimated)
{
  CkField   field = {.at = CkSmooth};
  AbutBody  body  = Body(PETSC_COMM_WORLD, &field, _i, 6, CkScattered, 2);
  PetscReal total, largest, effectivity;

  Estimate(body, &total, &largest, NULL);
  effectivity = total / TrueError(body, &field);
  PetscPrintf(PETSC_COMM_WORLD, "%s%d, cells of three sizes: effectivity %.3f\n", Shape(_i) == ABUT_QUAD ? "Q" : "P", (int)Order(_i),
              (double)effectivity);
  ck_assert_double_eq_tol(effectivity, 1., 0.3);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* The box [0,2]x[-2,0] under Hertz' pressure on its top, x < 1/2; what was cut off is replaced by the exact displacements */
static AbutBody HertzBody(CkField *field, int i, PetscInt n)
{
  AbutBody body;
  Vec      f;

  field->order = Order(i);
  body         = CkBodyOn(PETSC_COMM_WORLD, "body", field, 0., -2., 2., 0., n, n, Shape(i));
  CkGiveAll(body, field, "u-", "uu", "uu", "--");
  CkOk(AbutBodySetContact(body, 3));
  CkOk(AbutBodySetUp(body));
  f = Press(body, Hertz);
  CkOk(AbutBodySolve(body, f));
  CkOk(VecDestroy(&f));
  return body;
}

/* Energy errors fall with order 1 or 3/2 here, whatever the order of the cells: the effectivity stays what it is */
START_TEST(an_error_under_a_contact_is_estimated)
{
  PetscReal first = 0.;

  for (PetscInt n = 8; n <= 32; n *= 2) { /* the end of the contact is always a node */
    CkField   field = {.at = CkHertz};
    AbutBody  body  = HertzBody(&field, _i, n);
    PetscReal total, largest, effectivity;

    Estimate(body, &total, &largest, NULL);
    effectivity = total / TrueError(body, &field);
    if (!(first > 0.)) first = effectivity;
    PetscPrintf(PETSC_COMM_WORLD, "%s%d, Hertz, h = 1/%d: estimate %.2e, effectivity %.3f\n", Shape(_i) == ABUT_QUAD ? "Q" : "P",
                (int)Order(_i), (int)n / 2, (double)total, (double)effectivity);
    ck_assert_double_eq_tol(effectivity, first, 0.3 * first);
    ck_assert_double_gt(effectivity, 0.7);
    ck_assert_double_lt(effectivity, 1.5);
    CkOk(AbutBodyDestroy(&body));
  }
}
END_TEST

static void CheckRanks(int i, PetscInt n, PetscInt times)
{
  CkField  field[2] = {{.at = CkSmooth}, {.at = CkSmooth}};
  AbutBody all      = Body(PETSC_COMM_WORLD, &field[0], i, n, CkScattered, times),
           one      = Body(PETSC_COMM_SELF, &field[1], i, n, CkScattered, times);
  PetscReal total[2], largest[2];

  Estimate(all, &total[0], &largest[0], NULL);
  Estimate(one, &total[1], &largest[1], NULL);
  ck_assert_double_gt(total[1], 0.); /* of the stress, the solver's round-off stays: 1e-13 */
  ck_assert_double_eq_tol(total[0], total[1], 1e-10 * total[1] + 1e-13);
  ck_assert_double_eq_tol(largest[0], largest[1], 1e-10 * largest[1] + 1e-13);
  CkOk(AbutBodyDestroy(&all));
  CkOk(AbutBodyDestroy(&one));
}

START_TEST(all_numbers_of_ranks_give_the_same_estimate)
{
  for (PetscInt n = 2; n <= 6; n += 2) CheckRanks(_i, n, 0);
  CheckRanks(_i, 4, 3);
}
END_TEST

/* Two layers pressed together without penalty, contact up to a = 0.9926 */
START_TEST(the_contact_edge_of_two_layers_is_seen)
{
  char      text[1024];
  AbutScene scene;
  AbutBody  body;
  PetscInt  status;
  PetscReal total, largest, worst[2];

  for (PetscInt n = 6; n <= 12; n *= 2) {
    CkOk(PetscSNPrintf(text, sizeof(text),
                       "-scene_bodies lower,upper -scene_pairs mid -mid_pair_bodies upper,lower -mid_pair_sides bottom,top -mid_pair_gap "
                       "1e-3*x^2 "
                       "-mid_pair_theta 0 -lower_mesh_box 0,0,4,1 -upper_mesh_box 0,1,4,2 -lower_mesh_cells %d,%d -upper_mesh_cells %d,%d "
                       "-lower_mesh_order %d -upper_mesh_order %d -lower_mesh_shape %s -upper_mesh_shape %s "
                       "-lower_material_young 2.1e5 -lower_material_poisson 0.3 "
                       "-upper_material_young 2.1e5 -upper_material_poisson 0.3 -lower_bc_left_u1 0 -upper_bc_left_u1 0 "
                       "-lower_bc_bottom_u2 0 "
                       "-upper_bc_top_u2 -1.366e-3",
                       (int)(4 * n), (int)n, (int)(4 * n), (int)n, (int)Order(_i), (int)Order(_i),
                       Shape(_i) == ABUT_QUAD ? "quad" : "triangle", Shape(_i) == ABUT_QUAD ? "quad" : "triangle"));
    CkOptions(text);
    CkOk(AbutSceneCreate(PETSC_COMM_WORLD, &scene));
    CkOk(AbutSceneSetFromOptions(scene));
    CkOk(AbutSceneSolve(scene));
    CkOk(AbutSceneGetExitStatus(scene, &status));
    ck_assert_int_eq(status, 0);
    CkOk(AbutSceneGetBody(scene, "lower", &body));
    Estimate(body, &total, &largest, worst);
    PetscPrintf(PETSC_COMM_WORLD, "%s%d, h = 1/%d: largest %.4f at (%.3f, %.3f)\n", Shape(_i) == ABUT_QUAD ? "Q" : "P", (int)Order(_i),
                (int)n, (double)largest, (double)worst[0], (double)worst[1]);
    ck_assert_double_eq_tol(worst[0], 0.99264204, 1. / n);
    ck_assert_double_gt(worst[1], 1. - 1. / n);
    CkOk(AbutSceneDestroy(&scene));
    CkOptionsEnd();
  }
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("residual");
  TCase *tests = tcase_create("estimator");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  tcase_add_loop_test(tests, nothing_is_left_of_a_linear_displacement, 0, 7);
  tcase_add_loop_test(tests, nothing_is_left_of_a_uniform_pressure, 0, 7);
  tcase_add_loop_test(tests, a_smooth_error_is_estimated, 0, 7);
  tcase_add_loop_test(tests, an_error_on_a_locally_refined_mesh_is_estimated, 0, 7);
  tcase_add_loop_test(tests, an_error_under_a_contact_is_estimated, 0, 7);
  tcase_add_loop_test(tests, all_numbers_of_ranks_give_the_same_estimate, 0, 7);
  tcase_add_loop_test(tests, the_contact_edge_of_two_layers_is_seen, 0, 7);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
