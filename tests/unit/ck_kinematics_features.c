/* ranks: 1 2 3 */
#include "ckkinematics.h"
#include "ck_estimate.h"

/* Estimators of sheets, bodies of revolution and bodies with initial strains */

static const char *const types[] = {"residual", "zz", "fembem"};

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

  PetscCall(AbutEstimatorSetFeatures(est, ~0));
  return AbutEstimatorSetOps(est, &ops);
}

/* What is estimated, and over the error */
static PetscReal Estimate(AbutBody body, const CkField *field, const char type[], PetscReal *effectivity)
{
  PetscReal total, error, largest;

  exact = field;
  CkOk(AbutBodySolve(body, NULL));
  CkEstimate(body, type, &total, &largest);
  CkEstimate(body, "exact", &error, &largest);
  *effectivity = total / error;
  return total;
}

static AbutBody Make(int which, CkField *field, AbutKinematics kinematics)
{
  AbutBody body = CkBodyOfOrder(which, field, kinematics, 0., 0.5, 2., 1.5, which % 7 % 4 > 1 ? 4 : 8);

  CkGiveAll(body, field, "ut", "tt", "tu", "tt");
  return body;
}

/* In the plane a sheet is a body in plane strain with other constants: the same displacements, stresses and estimates */
START_TEST(a_sheet_is_judged_like_the_body_in_plane_strain_that_it_is)
{
  const char *type    = types[_i % 3];
  CkField     sheet   = {.at = CkSmoothSheet, .young = CK_YOUNG, .poisson = 0.4};
  CkField     same    = {.at = CkSmooth, .young = CK_YOUNG * 1.8 / (1.4 * 1.4), .poisson = 0.4 / 1.4};
  AbutBody    body[2] = {Make(_i / 3, &sheet, ABUT_PLANE_STRESS), Make(_i / 3, &same, ABUT_PLANE_STRAIN)};
  PetscReal   eta[2], effectivity[2];

  for (int k = 0; k < 2; ++k) {
    eta[k] = Estimate(body[k], k ? &same : &sheet, type, &effectivity[k]);
    CkOk(AbutBodyDestroy(&body[k]));
  }
  ck_assert_double_eq_tol(eta[0], eta[1], 1e-6 * eta[1]);
  ck_assert_double_eq_tol(effectivity[0], effectivity[1], 1e-6 * effectivity[1]);
}
END_TEST

#define ALPHA 1e-5
static const PetscReal heat[3] = {20., 10., 50.}; /* T = 20 + 10 x + 50 y: as large as the strain of the field */

static PetscErrorCode Expand(const PetscReal x[2], PetscReal eps[4], PETSC_UNUSED void *ctx)
{
  eps[0] = eps[1] = eps[3] = ALPHA * (heat[0] + heat[1] * x[0] + heat[2] * x[1]);
  eps[2]                   = 0.;
  return PETSC_SUCCESS;
}

/* CkSmooth(), and the displacement by which a body in plane strain makes room for that */
static void Hot(const CkField *field, const PetscReal x[2], PetscReal u[2], PetscReal s[3])
{
  const PetscReal a = (1. + field->poisson) * ALPHA, squares = x[0] * x[0] - x[1] * x[1];

  CkSmooth(field, x, u, s);
  u[0] += a * (heat[0] * x[0] + 0.5 * heat[1] * squares + heat[2] * x[0] * x[1]);
  u[1] += a * (heat[0] * x[1] + heat[1] * x[0] * x[1] - 0.5 * heat[2] * squares);
}

/* From order 2 on the elements have that displacement, and the error is that of a cold body; of order 1, it is another one */
START_TEST(a_strain_that_is_linear_is_no_error)
{
  const char *type     = types[_i % 3];
  CkField     field[2] = {
    {.at = CkSmooth, .young = CK_YOUNG, .poisson = 0.3},
    {.at = Hot,      .young = CK_YOUNG, .poisson = 0.3}
  };
  PetscReal eta[2], effectivity[2];

  for (int hot = 0; hot < 2; ++hot) {
    AbutBody body = Make(_i / 3, &field[hot], ABUT_PLANE_STRAIN);

    if (hot) CkOk(AbutBodyAddInitialStrain(body, "heat", 0, PETSC_TRUE, Expand, NULL));
    eta[hot] = Estimate(body, &field[hot], type, &effectivity[hot]);
    CkOk(AbutBodyDestroy(&body));
  }
  if (field[0].order > 1) {
    ck_assert_double_eq_tol(eta[1], eta[0], 1e-5 * eta[0]);
    ck_assert_double_eq_tol(effectivity[1], effectivity[0], 1e-5 * effectivity[0]);
  } else {
    CkOk(PetscPrintf(PETSC_COMM_WORLD, "mesh %d, order 1, %s: %.3f cold, %.3f hot\n", _i / 3, type, (double)effectivity[0],
                     (double)effectivity[1]));
    if (_i % 3) ck_assert_double_eq_tol(effectivity[1] / effectivity[0], 1., 0.15);
    else ck_assert_double_eq_tol(effectivity[1], 0.6, 0.2); /* what the strain does inside cells is less of a residual than of an error */
  }
}
END_TEST

START_TEST(the_residual_is_of_the_size_of_the_error_in_a_body_of_revolution)
{
  CkField   field = {.at = CkBessel, .young = CK_YOUNG, .poisson = 0.3};
  AbutBody  body  = Make(_i, &field, ABUT_AXISYMMETRIC);
  PetscReal effectivity;

  CkGive(body, &field, "left", "tt"); /* the axis */
  CkRefine(CkMeshOf(body), CkEverywhere, 1);
  (void)Estimate(body, &field, "residual", &effectivity);
  CkOk(PetscPrintf(PETSC_COMM_WORLD, "mesh %d, order %" PetscInt_FMT ": residual over error %.3f\n", _i, field.order, (double)effectivity));
  ck_assert_double_eq_tol(effectivity, 1., 0.5);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("kinematics_features");
  TCase *tc    = tcase_create("all");
  int    failed;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  if (AbutEstimatorRegister("exact", Create_Exact)) return EXIT_FAILURE;
  tcase_set_timeout(tc, 0);
  tcase_add_loop_test(tc, a_sheet_is_judged_like_the_body_in_plane_strain_that_it_is, 0, 3 * CK_MESHES);
  tcase_add_loop_test(tc, a_strain_that_is_linear_is_no_error, 0, 3 * CK_MESHES);
  tcase_add_loop_test(tc, the_residual_is_of_the_size_of_the_error_in_a_body_of_revolution, 0, CK_MESHES);
  suite_add_tcase(suite, tc);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
