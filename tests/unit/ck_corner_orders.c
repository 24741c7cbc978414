/* ranks: 1 */
#include "ckbody.h"
#include <abutestimator.h>

/* The stress at a re-entrant corner of 3 pi/2 with free sides, after M. L. Williams, Stress singularities resulting from various boundary
   conditions in angular corners of plates in extension, J. Appl. Mech. 19 (1952), on the part of it that is a unit square: the bottom is a
   free side of the corner, the left side lies inside the material. The displacement is r^lambda times a function of the angle, where
   sin(3 pi/2 lambda) = lambda: uniform meshes give h^lambda, whatever the order p, and adapted ones N^(-p/2). */

#define LAMBDA 0.5444837367824622
#define MOST   40 /* meshes */

static void CkCorner(const CkField *field, const PetscReal x[2], PetscReal u[2], PetscReal s[3])
{
  const double complex turn = cexp(0.75 * PETSC_PI * I), z = (x[0] + I * x[1]) / turn, power = cpow(z, LAMBDA);
  const double         b    = -cos(1.5 * PETSC_PI * LAMBDA); /* cos(3 pi/2) = 0: no other part */
  const double complex dphi = LAMBDA * power / z, ddphi = (LAMBDA - 1.) * dphi / z,
                       w = ((3. - 4. * field->poisson) * power - z * conj(dphi) - conj(b * power)) * turn * (1. + field->poisson) /
                           field->young,
                       t = 2. * (conj(z) * ddphi + b * dphi) / (turn * turn);

  u[0] = cabs(z) > 0. ? creal(w) : 0.;
  u[1] = cabs(z) > 0. ? cimag(w) : 0.;
  s[0] = 2. * creal(dphi) - 0.5 * creal(t);
  s[1] = 2. * creal(dphi) + 0.5 * creal(t);
  s[2] = 0.5 * cimag(t);
}

/* The body of a corner, solved */
static AbutBody Corner(CkField *field, AbutShape shape, PetscInt order, PetscInt n)
{
  AbutBody body;

  *field = (CkField){.at = CkCorner, .order = order};
  body   = CkBodyOn(PETSC_COMM_WORLD, "body", field, 0., 0., 1., 1., n, n, shape);
  CkGiveAll(body, field, "uu", "uu", "--", "uu");
  CkOk(AbutBodySolve(body, NULL));
  return body;
}

START_TEST(the_field_is_in_balance_and_the_flank_free)
{
  const PetscReal h = 1e-4, at[2] = {0.3, 0.4}, flank[2] = {0.7, 0.};
  CkField         field = {.at = CkCorner, .young = CK_YOUNG, .poisson = CK_POISSON};
  const PetscReal mu = CK_YOUNG / (2. * (1. + CK_POISSON)), lambda = 2. * mu * CK_POISSON / (1. - 2. * CK_POISSON);
  PetscReal       u[2], s[3], du[2][2], ds[2][3];

  CkCorner(&field, flank, u, s);
  ck_assert_double_eq_tol(s[1], 0., 1e-12);
  ck_assert_double_eq_tol(s[2], 0., 1e-12);
  for (PetscInt d = 0; d < 2; ++d)
    for (PetscInt side = -1; side <= 1; side += 2) {
      const PetscReal x[2] = {at[0] + (d ? 0. : side * h), at[1] + (d ? side * h : 0.)};

      CkCorner(&field, x, u, s);
      for (PetscInt i = 0; i < 2; ++i) du[d][i] = side * u[i] / (2. * h) + (side > 0 ? du[d][i] : 0.);
      for (PetscInt i = 0; i < 3; ++i) ds[d][i] = side * s[i] / (2. * h) + (side > 0 ? ds[d][i] : 0.);
    }
  CkCorner(&field, at, u, s);
  ck_assert_double_eq_tol(ds[0][0] + ds[1][2], 0., 1e-6);
  ck_assert_double_eq_tol(ds[0][2] + ds[1][1], 0., 1e-6);
  ck_assert_double_eq_tol(s[0], (lambda + 2. * mu) * du[0][0] + lambda * du[1][1], 1e-6);
  ck_assert_double_eq_tol(s[1], (lambda + 2. * mu) * du[1][1] + lambda * du[0][0], 1e-6);
  ck_assert_double_eq_tol(s[2], mu * (du[0][1] + du[1][0]), 1e-6);
}
END_TEST

START_TEST(uniform_meshes_have_the_order_of_the_corner)
{
  static PetscReal worst = 0.;
  const AbutShape  shape = (AbutShape)(_i / 4);
  const PetscInt   order = 1 + _i % 4;
  PetscReal        l2, energy[2];

  if (shape == ABUT_TRIANGLE && order > 3) return;
  for (PetscInt k = 0; k < 2; ++k) {
    CkField  field;
    AbutBody body = Corner(&field, shape, order, 16 << k);

    CkErrors(body, &field, &l2, &energy[k]);
    CkOk(AbutBodyDestroy(&body));
  }
  printf("%s of order %d: %.3e %.3e, order %.3f\n", shape ? "triangles" : "quads", (int)order, (double)energy[0], (double)energy[1],
         (double)PetscLog2Real(energy[0] / energy[1]));
  worst = PetscMax(worst, PetscAbsReal(PetscLog2Real(energy[0] / energy[1]) - LAMBDA));
  ck_assert_double_le(worst, 0.03);
  if (_i == 6) CkCase("V10", "order in h of uniform meshes, whatever the elements, off 0.5445", worst, 0.03);
}
END_TEST

/* Cells with more than half of the largest indicator */
static void Refine(AbutBody body, const char type[])
{
  const AbutMeshTopology *t = CkTopology(CkMeshOf(body));
  AbutEstimator           est;
  const PetscReal        *e;
  PetscReal              *part, largest = 0.;
  PetscBool              *mark;
  Vec                     eta;

  CkOk(AbutEstimatorCreate(PETSC_COMM_WORLD, &est));
  CkOk(AbutEstimatorSetType(est, type));
  CkOk(AbutBodyCreateCellVec(body, &eta));
  CkOk(AbutEstimatorEstimate(est, body, eta));
  CkOk(PetscMalloc2(t->ncells, &part, t->ncells, &mark));
  CkOk(VecGetArrayRead(eta, &e));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    CkOk(AbutMeshGetCellArea(CkMeshOf(body), c, &part[c]));
    part[c] = e[c] * PetscSqrtReal(part[c]);
    largest = PetscMax(largest, part[c]);
  }
  for (PetscInt c = 0; c < t->ncells; ++c) mark[c] = (PetscBool)(part[c] > 0.5 * largest);
  CkOk(VecRestoreArrayRead(eta, &e));
  CkOk(AbutMeshAdapt(CkMeshOf(body), mark));
  CkOk(PetscFree2(part, mark));
  CkOk(VecDestroy(&eta));
  CkOk(AbutEstimatorDestroy(&est));
}

/* From cells of a half, over the last decade of unknowns */
START_TEST(adapted_meshes_have_the_order_of_their_elements)
{
  static const char *const types[] = {"zz", "residual", "fembem"};
  static const char *const what[] = {"exponent of 1/N over p/2, meshes adapted by zz, off 1", "the same by residual", "the same by fembem"};
  static PetscReal         worst[3];
  const char *const        type  = types[_i % 3];
  const AbutShape          shape = (AbutShape)(_i / 3 % 2);
  const PetscInt           order = 1 + _i / 6;
  PetscReal                unknowns[MOST], energy[MOST], l2, slope;
  CkField                  field;
  AbutBody                 body = Corner(&field, shape, order, 2);
  PetscInt                 k, n = 0, first = 0;

  for (n = 0; n < MOST && (!n || unknowns[n - 1] < 4000.); ++n) {
    if (n) Refine(body, type);
    CkOk(AbutBodySolve(body, NULL));
    CkOk(AbutBodyGetSize(body, &k));
    CkErrors(body, &field, &l2, &energy[n]);
    unknowns[n] = k;
  }
  while (unknowns[first] < unknowns[n - 1] / 10.) ++first;
  slope = PetscLogReal(energy[n - 1] / energy[first]) / PetscLogReal(unknowns[n - 1] / unknowns[first]);
  printf("%s of order %d, %s: %g to %g unknowns, %.2e to %.2e, N^%.3f\n", shape ? "triangles" : "quads", (int)order, type,
         (double)unknowns[first], (double)unknowns[n - 1], (double)energy[first], (double)energy[n - 1], (double)slope);
  worst[_i % 3] = PetscMax(worst[_i % 3], PetscAbsReal(slope / (-0.5 * order) - 1.));
  ck_assert_double_le(worst[_i % 3], 0.12);
  if (_i > 8) CkCase("V10", what[_i % 3], worst[_i % 3], 0.12);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("corner_orders");
  TCase *tests = tcase_create("all");
  int    failed;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  tcase_set_timeout(tests, 0);
  tcase_add_test(tests, the_field_is_in_balance_and_the_flank_free);
  tcase_add_loop_test(tests, uniform_meshes_have_the_order_of_the_corner, 0, 8);
  tcase_add_loop_test(tests, adapted_meshes_have_the_order_of_their_elements, 0, 12);
  suite_add_tcase(suite, tests);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
