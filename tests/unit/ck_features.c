/* ranks: 1 2 3 */
#include "ckbody.h"
#include "ck_estimate.h"

/* Estimators of bodies with body forces and springs: those that say they can judge them can, the others refuse */

static const char *const types[] = {"residual", "zz", "fembem"};

/* A smooth field with a constant body force: that of the potentials, and one of degree 2 with s11 = -f1 x, s22 = -f2 y, s12 = 0 */
static const PetscReal force[2] = {3., -5.};

static void CkHeavy(const CkField *field, const PetscReal x[2], PetscReal u[2], PetscReal s[3])
{
  const PetscReal nu = field->poisson, a = (1. + nu) / field->young;

  CkSmooth(field, x, u, s);
  u[0] += a * (-0.5 * (1. - nu) * force[0] * x[0] * x[0] + nu * force[1] * x[0] * x[1] - 0.5 * nu * force[0] * x[1] * x[1]);
  u[1] += a * (-0.5 * (1. - nu) * force[1] * x[1] * x[1] + nu * force[0] * x[0] * x[1] - 0.5 * nu * force[1] * x[0] * x[0]);
  s[0] -= force[0] * x[0];
  s[1] -= force[1] * x[1];
}

static PetscErrorCode Heavy(PETSC_UNUSED const PetscReal x[2], PetscReal f[2], PETSC_UNUSED void *ctx)
{
  f[0] = force[0];
  f[1] = force[1];
  return PETSC_SUCCESS;
}

static const CkField *exact;

static PetscErrorCode Exact(PETSC_UNUSED AbutEstimator est, PETSC_UNUSED AbutBody body, PETSC_UNUSED PetscInt c, PetscInt n,
                            PETSC_UNUSED const PetscReal xi[], const PetscReal x[], PetscReal s[])
{
  PetscReal u[2];

  for (PetscInt q = 0; q < n; ++q) exact->at(exact, x + 2 * q, u, s + 3 * q);
  return PETSC_SUCCESS;
}

static PetscErrorCode Estimate_Exact(AbutEstimator est, AbutBody body, PetscReal eta[])
{
  return AbutEstimatorCompareStress(est, body, Exact, eta);
}

static PetscErrorCode Create_Exact(AbutEstimator est)
{
  const AbutEstimatorOps ops = {.estimate = Estimate_Exact};

  PetscCall(AbutEstimatorSetFeatures(est, ABUT_FEATURE_BODY_FORCE_CONSTANT | ABUT_FEATURE_BODY_FORCE_VARYING | ABUT_FEATURE_FOUNDATION));
  return AbutEstimatorSetOps(est, &ops);
}

static PetscErrorCode Create_Old(AbutEstimator est)
{
  const AbutEstimatorOps ops = {.estimate = Estimate_Exact};

  return AbutEstimatorSetOps(est, &ops);
}

/* Springs under the bottom, and what they lack of the field's traction there */
#define CK_STIFFNESS 1e5

static PetscErrorCode Rest(const PetscReal x[2], const PetscReal normal[2], PetscReal t[2], void *ctx)
{
  const CkField *field = (const CkField *)ctx;
  PetscReal      u[2], s[3];

  field->at(field, x, u, s);
  t[0] = s[0] * normal[0] + s[2] * normal[1] + CK_STIFFNESS * u[0];
  t[1] = s[2] * normal[0] + s[1] * normal[1] + CK_STIFFNESS * u[1];
  return PETSC_SUCCESS;
}

static AbutBody Make(CkField *field, AbutShape shape, PetscBool springs)
{
  const PetscInt n    = field->order > 2 ? 6 : 12;
  AbutBody       body = CkBodyOn(PETSC_COMM_WORLD, "body", field, 0., 0., 2., 1., 2 * n, n, shape);

  CkGiveAll(body, field, "ut", "tt", springs ? "--" : "tu", "tt");
  if (springs) {
    CkOk(AbutBodyAddFoundation(body, "ground", 0, 2, CK_STIFFNESS, CK_STIFFNESS));
    CkOk(AbutBodyAddTraction(body, "rest", 0, 2, Rest, field));
  }
  return body;
}

static PetscReal Effectivity(AbutBody body, const CkField *field, const char type[])
{
  PetscReal total, error, largest;

  exact = field;
  CkOk(AbutBodySolve(body, NULL));
  CkEstimate(body, type, &total, &largest);
  CkEstimate(body, "exact", &error, &largest);
  ck_assert_double_gt(error, 1e-9);
  return total / error;
}

/* Nothing of what is added is a part of the error, so the ratio stays what it is without */
START_TEST(estimates_over_errors_are_with_a_body_force_and_springs_what_they_are_without)
{
  const char     *type   = types[_i % 3];
  const PetscInt  order  = 1 + _i / 6;
  const AbutShape shape  = (AbutShape)(_i / 3 % 2);
  CkField         smooth = {.at = CkSmooth, .order = order}, heavy = {.at = CkHeavy, .order = order};
  AbutBody        body[3];
  PetscReal       ratio[3];

  if (shape == ABUT_TRIANGLE && order > 3) return;
  for (PetscInt i = 0; i < 3; ++i) {
    CkField *field = i == 1 ? &heavy : &smooth;

    body[i] = Make(field, shape, (PetscBool)(i == 2));
    if (i == 1) CkOk(AbutBodyAddForce(body[i], "weight", 0, PETSC_TRUE, Heavy, NULL));
    ratio[i] = Effectivity(body[i], field, type);
    CkOk(AbutBodyDestroy(&body[i]));
  }
  /* of order 1, the stress has no divergence that could meet the force: the residual sees all of it */
  if (_i % 3 || order > 1) ck_assert_double_eq_tol(ratio[1] / ratio[0], 1., 0.02);
  else ck_assert(ratio[1] > ratio[0] && ratio[1] < 1.5 * ratio[0]);
  ck_assert_double_eq_tol(ratio[2] / ratio[0], 1., 0.02);
}
END_TEST

START_TEST(the_residual_is_of_the_size_of_the_error_under_a_force_that_varies)
{
  const PetscInt  order = 1 + _i / 2;
  const AbutShape shape = (AbutShape)(_i % 2);
  CkField         field = {.at = CkForced, .order = order};
  AbutBody        body;

  if (shape == ABUT_TRIANGLE && order > 3) return;
  body = Make(&field, shape, PETSC_FALSE);
  CkOk(AbutBodyAddForce(body, "forced", 0, PETSC_FALSE, CkForceOfForced, &field));
  ck_assert_double_eq_tol(Effectivity(body, &field, "residual"), 1.2, 0.4);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

static void CkRefuses(AbutBody body, const char type[], const char line[])
{
  AbutEstimator  est;
  PetscErrorCode code;

  CkOk(AbutEstimatorCreate(PETSC_COMM_WORLD, &est));
  CkOk(AbutEstimatorSetType(est, type));
  CkCatch(code = AbutEstimatorCheck(est, body));
  if (line) ck_assert_int_eq(code, PETSC_ERR_USER_INPUT);
  ck_assert_str_eq(ck_line, line ? line : "");
  CkOk(AbutEstimatorDestroy(&est));
}

#define CK_REFUSED \
  "estimator_type: %s does not know how to judge body with %s, that of %s; give residual, or leave body out of adaptor_bodies"

START_TEST(an_estimator_refuses_what_it_cannot_judge_and_one_that_says_nothing_all_of_it)
{
  CkField  field = {.at = CkForced};
  AbutBody body  = Make(&field, ABUT_QUAD, PETSC_FALSE);
  char     line[256];

  CkRefuses(body, "old", NULL);
  CkOk(AbutBodyAddFoundation(body, "ground", 0, 2, 1., 0.));
  snprintf(line, sizeof(line), CK_REFUSED, "old", "springs", "ground");
  CkRefuses(body, "old", line);
  CkRefuses(body, "zz,fembem", NULL);
  CkOk(AbutBodyAddForce(body, "forced", 0, PETSC_FALSE, CkForceOfForced, &field));
  snprintf(line, sizeof(line), CK_REFUSED, "zz", "a body force that varies", "forced");
  CkRefuses(body, "residual,zz", line);
  snprintf(line, sizeof(line), CK_REFUSED, "fembem", "a body force that varies", "forced");
  CkRefuses(body, "fembem", line);
  CkRefuses(body, "residual", NULL);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("features");
  TCase *tc    = tcase_create("all");
  int    failed;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  if (AbutEstimatorRegister("exact", Create_Exact) || AbutEstimatorRegister("old", Create_Old)) return EXIT_FAILURE;
  tcase_set_timeout(tc, 0);
  tcase_add_loop_test(tc, estimates_over_errors_are_with_a_body_force_and_springs_what_they_are_without, 0, 24);
  tcase_add_loop_test(tc, the_residual_is_of_the_size_of_the_error_under_a_force_that_varies, 0, 8);
  tcase_add_test(tc, an_estimator_refuses_what_it_cannot_judge_and_one_that_says_nothing_all_of_it);
  suite_add_tcase(suite, tc);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
