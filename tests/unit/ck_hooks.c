/* ranks: 1 2 3 4 */
#include "ckbody.h"

/* What acts on a body beside its conditions: forces, pressures, springs */

/* Halving all cells divides the L2 error by 2^(p+1) and the energy error by 2^p, with hanging nodes in every other mesh */
START_TEST(with_a_body_force_the_elements_converge_with_their_orders)
{
  const PetscInt   order = 1 + _i / 4, n = order > 2 ? 4 : 8;
  const AbutShape  shape    = (AbutShape)(_i / 2 % 2);
  CkField          forced   = {.at = CkForced, .order = order};
  static PetscReal worst[2] = {0., 0.};
  AbutBody         body;
  PetscReal        l2[3], energy[3];
  PetscMPIInt      size;

  if (shape == ABUT_TRIANGLE && order > 3) return;
  body = CkBodyOn(PETSC_COMM_WORLD, "body", &forced, 0., 0., 2., 1., 2 * n, n, shape);
  CkGiveAll(body, &forced, "ut", "tt", "tu", "tt");
  CkOk(AbutBodyAddForce(body, "forced", 0, PETSC_FALSE, CkForceOfForced, &forced));
  if (_i % 2) CkRefine(CkMeshOf(body), CkTowardsPoint, 2);
  for (PetscInt i = 0; i < 3; ++i) {
    if (i) CkRefine(CkMeshOf(body), CkEverywhere, 1);
    CkOk(AbutBodySolve(body, NULL));
    CkErrors(body, &forced, &l2[i], &energy[i]);
  }
  worst[0] = PetscMax(worst[0], PetscAbsReal(PetscLog2Real(l2[1] / l2[2]) - order - 1.));
  worst[1] = PetscMax(worst[1], PetscAbsReal(PetscLog2Real(energy[1] / energy[2]) - order));
  ck_assert_double_le(worst[0], 0.08);
  ck_assert_double_le(worst[1], 0.03);
  CkOk(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  if (_i == 13 && size == 1) {
    CkCase("V13", "with a body force: order in L2 off p + 1, hanging nodes", worst[0], 0.08);
    CkCase("V13", "with a body force: order in energy off p, the same meshes", worst[1], 0.03);
  }
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

static PetscErrorCode Weight(PETSC_UNUSED const PetscReal x[2], PetscReal f[2], PETSC_UNUSED void *ctx)
{
  f[0] = 3.;
  f[1] = -7.;
  return PETSC_SUCCESS;
}

static PetscErrorCode NodalForce(AbutBody body, Vec load, void *ctx)
{
  const AbutSide *s;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetSide(body, 3, &s));
  PetscCall(VecSetValue(load, 2 * s->global[0], *(PetscReal *)ctx, ADD_VALUES));
  PetscCall(VecAssemblyBegin(load));
  PetscCall(VecAssemblyEnd(load));
  PetscFunctionReturn(PETSC_SUCCESS);
}

START_TEST(forces_add_up_to_force_times_area_and_are_held_by_the_reactions)
{
  const PetscInt  order = 1 + _i / 2;
  const AbutShape shape = (AbutShape)(_i % 2);
  CkField         any   = {.at = CkLinear, .order = order};
  PetscReal       reaction[2], applied[2], strain, work, given = 5.;
  PetscMPIInt     size;
  AbutBody        body;

  if (shape == ABUT_TRIANGLE && order > 3) return;
  CkOk(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  body = CkBodyOn(PETSC_COMM_WORLD, "body", &any, 0., 0., 2., 1., 4, 2, shape);
  CkGive(body, &any, "bottom", "uu");
  CkOk(AbutBodyAddForce(body, "weight", 0, PETSC_TRUE, Weight, NULL));
  CkRefine(CkMeshOf(body), CkTowardsPoint, 3);
  CkOk(AbutBodySolve(body, NULL));
  CkOk(AbutBodyGetReaction(body, reaction, applied));
  ck_assert_double_eq_tol(applied[0], 6., 1e-12);
  ck_assert_double_eq_tol(applied[1], -14., 1e-12);
  for (PetscInt d = 0; d < 2; ++d) ck_assert_double_eq_tol(reaction[d] + applied[d], 0., 1e-7); /* of forces of 1e3 at the corners */
  CkOk(AbutBodyGetEnergy(body, &strain, &work));
  ck_assert_double_eq_tol(work / (2. * strain), 1., 1e-11);
  CkOk(AbutBodyAddLoad(body, "point", 0, NodalForce, &given)); /* every rank adds it */
  CkOk(AbutBodySolve(body, NULL));
  CkOk(AbutBodyGetReaction(body, reaction, applied));
  ck_assert_double_eq_tol(applied[0], 6. + 5. * size, 1e-12);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

static PetscErrorCode Pressure(const PetscReal x[2], PetscReal *p, PETSC_UNUSED void *ctx)
{
  *p = 30. + 10. * x[0] - 20. * x[1] * x[1];
  return PETSC_SUCCESS;
}

static PetscErrorCode PressureAlongNormal(const PetscReal x[2], const PetscReal normal[2], PetscReal t[2], PETSC_UNUSED void *ctx)
{
  PetscReal p;

  PetscCall(Pressure(x, &p, NULL));
  for (PetscInt d = 0; d < 2; ++d) t[d] = -p * normal[d];
  return PETSC_SUCCESS;
}

static PetscErrorCode Pull(const PetscReal x[2], PetscReal *t, void *ctx)
{
  PetscCall(Pressure(x, t, NULL));
  *t *= -*(PetscReal *)ctx;
  return PETSC_SUCCESS;
}

static AbutBody Pressed(CkField *any, PetscInt side, PetscBool hook, PetscReal *sign)
{
  static const char *const name[] = {"left", "right", "bottom", "top"};
  AbutBody                 body   = CkBodyOn(PETSC_COMM_WORLD, "body", any, 0., 0., 2., 1., 4, 3, ABUT_QUAD);

  CkGive(body, any, name[side ^ 1], "uu");
  *sign = side % 2 ? 1. : -1.;
  if (hook) CkOk(AbutBodyAddTraction(body, "press", 0, side, PressureAlongNormal, NULL));
  else CkOk(AbutBodySetTraction(body, name[side], side / 2, Pull, sign));
  CkOk(AbutBodySolve(body, NULL));
  return body;
}

START_TEST(a_traction_along_the_normal_is_the_same_as_by_components_also_for_estimators)
{
  CkField       any = {.at = CkLinear, .order = 1 + _i / 4};
  PetscReal     sign, distance, size;
  AbutBody      one = Pressed(&any, _i % 4, PETSC_TRUE, &sign), two = Pressed(&any, _i % 4, PETSC_FALSE, &sign);
  AbutBoundary *b[2];
  Vec           u, v;

  CkOk(AbutBodyGetSolution(one, &u));
  CkOk(AbutBodyGetSolution(two, &v));
  CkOk(VecNorm(v, NORM_INFINITY, &size));
  CkOk(VecAXPY(u, -1., v));
  CkOk(VecNorm(u, NORM_INFINITY, &distance));
  ck_assert_double_gt(size, 1e-4);
  ck_assert_double_le(distance, 1e-12 * size);
  CkOk(AbutBodyGetBoundary(one, &b[0]));
  CkOk(AbutBodyGetBoundary(two, &b[1]));
  for (PetscInt i = 0; i < 2 * (b[0]->order + 1) * b[0]->n; ++i) ck_assert_double_eq_tol(b[0]->traction[i], b[1]->traction[i], 1e-11);
  for (PetscInt i = 0; i < 2; ++i) CkOk(AbutBoundaryDestroy(&b[i]));
  CkOk(AbutBodyDestroy(&one));
  CkOk(AbutBodyDestroy(&two));
}
END_TEST

/* u = CkLinear on a body whose bottom is on springs: there t = -C u + what CkSprung gives */
#define CK_NORMAL     7e4
#define CK_TANGENTIAL 3e4

static PetscErrorCode Sprung(const PetscReal x[2], const PetscReal normal[2], PetscReal t[2], void *ctx)
{
  PetscReal u[2], s[3];

  CkLinear((const CkField *)ctx, x, u, s);
  t[0] = s[0] * normal[0] + s[2] * normal[1] + CK_TANGENTIAL * u[0];
  t[1] = s[2] * normal[0] + s[1] * normal[1] + CK_NORMAL * u[1];
  return PETSC_SUCCESS;
}

START_TEST(a_body_on_springs_needs_no_other_support_and_has_its_linear_field)
{
  const PetscInt  order  = 1 + _i / 2;
  const AbutShape shape  = (AbutShape)(_i % 2);
  CkField         linear = {.at = CkLinear, .order = order};
  PetscReal       reaction[2], applied[2], strain, work, kn, kt;
  PetscInt        n, modes;
  const Vec      *mode;
  AbutBoundary   *b;
  AbutBody        body;

  if (shape == ABUT_TRIANGLE && order > 3) return;
  body = CkBodyOn(PETSC_COMM_WORLD, "body", &linear, 0., 0., 2., 1., 4, 2, shape);
  CkGive(body, &linear, "left", "tt");
  CkGive(body, &linear, "right", "tt");
  CkGive(body, &linear, "top", "tt");
  CkOk(AbutBodyGetFreeModeCount(body, &n));
  ck_assert_int_eq(n, 3);
  CkOk(AbutBodyAddFoundation(body, "ground", 0, 2, 0.25 * CK_NORMAL, 0.)); /* it resists a move along y and a turn */
  CkOk(AbutBodyGetFreeModeCount(body, &n));
  ck_assert_int_eq(n, 1);
  CkOk(AbutBodyAddFoundation(body, "more", 0, 2, 0.75 * CK_NORMAL, CK_TANGENTIAL));
  CkOk(AbutBodyAddTraction(body, "rest", 0, 2, Sprung, &linear));
  CkRefine(CkMeshOf(body), CkScattered, 2);
  CkOk(AbutBodySolve(body, NULL));
  ck_assert_double_le(CkNodalError(body, &linear), 1e-11);
  CkOk(AbutBodyGetFreeModes(body, &modes, &mode));
  ck_assert_int_eq(modes, 0);
  CkOk(AbutBodyGetFoundation(body, 2, &kn, &kt));
  ck_assert_double_eq_tol(kn, CK_NORMAL, 1e-9);
  ck_assert_double_eq_tol(kt, CK_TANGENTIAL, 1e-9);
  CkOk(AbutBodyGetReaction(body, reaction, applied));
  ck_assert_double_eq_tol(reaction[0], -CK_TANGENTIAL * 1e-3 * 6., 1e-7); /* the integral of 1 + 2x over 0 to 2, of 3 - x/2 */
  ck_assert_double_eq_tol(reaction[1], -CK_NORMAL * 1e-3 * 5., 1e-7);
  for (PetscInt d = 0; d < 2; ++d) ck_assert_double_eq_tol(reaction[d] + applied[d], 0., 1e-8 * PetscAbsReal(applied[d]));
  CkOk(AbutBodyGetEnergy(body, &strain, &work));
  ck_assert_double_eq_tol(work / (2. * strain), 1., 1e-9);
  CkOk(AbutBodyGetBoundary(body, &b));
  for (PetscInt e = 0; e < b->n; ++e) { /* the stress of the field, on this side too */
    PetscReal u[2], s[3];

    if (b->side[e] != 2) continue;
    CkLinear(&linear, b->x + 2 * AbutBoundaryNode(b, e, 0), u, s);
    ck_assert_double_eq_tol(b->traction[2 * (order + 1) * e], -s[2], 1e-7 * PetscAbsReal(s[2]));
    ck_assert_double_eq_tol(b->traction[2 * (order + 1) * e + 1], -s[1], 1e-7 * s[1]);
  }
  CkOk(AbutBoundaryDestroy(&b));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* Springs under one half of what is held: the corner's own row is among the prescribed ones */
START_TEST(springs_beside_a_prescribed_side_leave_reactions_and_energy_in_balance)
{
  CkField   any = {.at = CkLinear, .order = 1 + _i};
  PetscReal reaction[2], applied[2], strain, work;
  AbutBody  body = CkBodyOn(PETSC_COMM_WORLD, "body", &any, 0., 0., 2., 1., 4, 3, ABUT_QUAD);

  CkGive(body, &any, "left", "uu");
  CkOk(AbutBodyAddFoundation(body, "ground", 0, 2, CK_NORMAL, CK_TANGENTIAL));
  CkOk(AbutBodyAddForce(body, "weight", 0, PETSC_TRUE, Weight, NULL));
  CkOk(AbutBodySolve(body, NULL));
  CkOk(AbutBodyGetReaction(body, reaction, applied));
  for (PetscInt d = 0; d < 2; ++d) ck_assert_double_eq_tol(reaction[d] + applied[d], 0., 1e-9);
  CkOk(AbutBodyGetEnergy(body, &strain, &work));
  ck_assert_double_eq_tol(work / (2. * strain), 1., 1e-11);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(features_are_what_was_added)
{
  CkField     any  = {.at = CkLinear};
  AbutBody    body = CkBodyOn(PETSC_COMM_WORLD, "body", &any, 0., 0., 2., 1., 4, 2, ABUT_QUAD);
  PetscInt    features;
  const char *what, *name;

  CkOk(AbutBodyGetFeatures(body, &features));
  ck_assert_int_eq(features, 0);
  CkOk(AbutBodyAddTraction(body, "press", 0, 3, PressureAlongNormal, NULL));
  CkOk(AbutBodyFindFeature(body, 0, &what, &name));
  ck_assert_ptr_null(what);
  CkOk(AbutBodyAddForce(body, "weight", 0, PETSC_TRUE, Weight, NULL));
  CkOk(AbutBodyAddFoundation(body, "ground", 0, 2, 1., 0.));
  CkOk(AbutBodyGetFeatures(body, &features));
  ck_assert_int_eq(features, ABUT_FEATURE_BODY_FORCE_CONSTANT | ABUT_FEATURE_FOUNDATION);
  CkOk(AbutBodyFindFeature(body, ABUT_FEATURE_BODY_FORCE_CONSTANT, &what, &name));
  ck_assert_str_eq(what, "springs");
  ck_assert_str_eq(name, "ground");
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("hooks");
  TCase *tc    = tcase_create("all");
  int    failed;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  tcase_set_timeout(tc, 0);
  tcase_add_loop_test(tc, with_a_body_force_the_elements_converge_with_their_orders, 0, 16);
  tcase_add_loop_test(tc, forces_add_up_to_force_times_area_and_are_held_by_the_reactions, 0, 8);
  tcase_add_loop_test(tc, a_traction_along_the_normal_is_the_same_as_by_components_also_for_estimators, 0, 16);
  tcase_add_loop_test(tc, a_body_on_springs_needs_no_other_support_and_has_its_linear_field, 0, 8);
  tcase_add_loop_test(tc, springs_beside_a_prescribed_side_leave_reactions_and_energy_in_balance, 0, 4);
  tcase_add_test(tc, features_are_what_was_added);
  suite_add_tcase(suite, tc);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
