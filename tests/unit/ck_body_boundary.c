/* ranks: 1 2 3 4 */
#include "ckbody.h"

/* The gathered boundary of a body and its sides: what the boundary-element method and the contact pairs see */

enum {
  GRID,
  POINT,
  SCATTERED,
  ONE, /* fewer cells than ranks */
  NMESHES
};

static PetscBool TowardsTheTop(AbutMesh mesh, PetscInt c, PETSC_UNUSED PetscInt i)
{
  const PetscReal p[2] = {2.5, 3.};
  PetscReal       xi[2];
  PetscBool       inside;

  CkOk(AbutMeshInvertCell(mesh, c, p, xi, &inside));
  return inside;
}

static AbutBody Make(CkField *field, int which, AbutShape shape)
{
  AbutBody body = CkBodyOn(PETSC_COMM_WORLD, "body", field, 1., 2., 5., 3., which == ONE ? 1 : 8, which == ONE ? 1 : 2, shape);

  if (which == POINT) CkRefine(CkMeshOf(body), TowardsTheTop, 8);
  if (which == SCATTERED) CkRefine(CkMeshOf(body), CkScattered, 4);
  return body;
}

static const PetscReal ck_normals[4][2] = {
  {-1., 0. },
  {1.,  0. },
  {0.,  -1.},
  {0.,  1. }
};

START_TEST(the_boundary_is_one_closed_contour_with_the_body_on_the_left)
{
  CkField       linear = {.at = CkLinear};
  AbutBody      body   = Make(&linear, _i % NMESHES, (AbutShape)(_i / NMESHES));
  PetscReal     area = 0., length[4] = {0., 0., 0., 0.}, u[2], s[3];
  AbutBoundary *b;

  CkGiveAll(body, &linear, "uu", "uu", "uu", "uu");
  CkOk(AbutBodySolve(body, NULL));
  CkOk(AbutBodyGetBoundary(body, &b));
  ck_assert_int_eq(b->n, CkSum(CkTopology(CkMeshOf(body))->nsideedges));
  ck_assert_int_eq(b->ncontours, 1);
  ck_assert(b->contour[0] == 0 && b->contour[1] == b->n);
  ck_assert(b->x[0] == 1. && b->x[1] == 2.); /* begins at the lowest, leftmost corner */
  for (PetscInt i = 0; i < b->n; ++i) {
    const PetscReal *p = b->x + 2 * i, *q = b->x + 2 * b->next[i], h = PetscAbsReal(p[0] - q[0]) + PetscAbsReal(p[1] - q[1]),
                    *n = ck_normals[b->side[i]];

    ck_assert_int_eq(b->next[i], (i + 1) % b->n);
    ck_assert_double_eq_tol(q[0] - p[0], -n[1] * h, 1e-15);
    ck_assert_double_eq_tol(q[1] - p[1], n[0] * h, 1e-15);
    area += 0.5 * ((p[0] - 1.) * (q[1] - 2.) - (p[1] - 2.) * (q[0] - 1.));
    length[b->side[i]] += h;
    CkLinear(&linear, p, u, s);
    for (PetscInt d = 0; d < 2; ++d) {
      ck_assert_double_eq_tol(b->u[2 * i + d], u[d], 1e-14);
      ck_assert_int_eq(b->condition[2 * i + d], ABUT_DISPLACEMENT);
    }
  }
  ck_assert_double_eq_tol(area, 4., 1e-14);
  for (PetscInt k = 0; k < 4; ++k) ck_assert_double_eq_tol(length[k], k < 2 ? 1. : 4., 1e-14);
  CkOk(AbutBoundaryDestroy(&b));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* In a constant stress the reaction of a node is the traction times half of the elements at both of its sides */
START_TEST(reactions_are_the_moments_of_the_tractions_that_hold_the_body)
{
  CkField       linear = {.at = CkLinear};
  AbutBody      body   = Make(&linear, _i % NMESHES, (AbutShape)(_i / NMESHES));
  PetscReal    *force, u[2], s[3], most = 0.;
  AbutBoundary *b;

  CkGiveAll(body, &linear, "uu", "uu", "uu", "uu");
  CkOk(AbutBodySolve(body, NULL));
  CkOk(AbutBodyGetBoundary(body, &b));
  CkOk(PetscCalloc1(2 * b->n, &force));
  CkLinear(&linear, b->x, u, s);
  for (PetscInt i = 0; i < b->n; ++i) {
    const PetscReal *p = b->x + 2 * i, *q = b->x + 2 * b->next[i], h = PetscAbsReal(p[0] - q[0]) + PetscAbsReal(p[1] - q[1]),
                    *n   = ck_normals[b->side[i]];
    const PetscReal t[2] = {s[0] * n[0] + s[2] * n[1], s[2] * n[0] + s[1] * n[1]};

    for (PetscInt d = 0; d < 2; ++d) {
      force[2 * i + d] += 0.5 * h * t[d];
      force[2 * b->next[i] + d] += 0.5 * h * t[d];
    }
  }
  for (PetscInt k = 0; k < 2 * b->n; ++k) most = PetscMax(most, PetscAbsReal(force[k]));
  for (PetscInt k = 0; k < 2 * b->n; ++k) ck_assert_double_eq_tol(b->reaction[k], force[k], 1e-11 * most);
  CkOk(PetscFree(force));
  CkOk(AbutBoundaryDestroy(&b));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

static PetscErrorCode Square(const PetscReal x[2], PetscReal *value, PETSC_UNUSED void *ctx)
{
  *value = x[0] * x[0];
  return PETSC_SUCCESS;
}

static PetscErrorCode Zero(PETSC_UNUSED const PetscReal x[2], PetscReal *value, PETSC_UNUSED void *ctx)
{
  *value = 0.;
  return PETSC_SUCCESS;
}

/* On x = x0 + h s the linear function nearest to x^2 is x0^2 + 2 x0 h s + h^2 (s - 1/6) */
START_TEST(given_tractions_are_projected_and_balance_the_reactions_in_force_and_moment)
{
  CkField       linear = {.at = CkLinear};
  AbutBody      body   = Make(&linear, _i % NMESHES, (AbutShape)(_i / NMESHES));
  PetscReal     sum[3] = {0., 0., 0.}, reaction[2], applied[2], total = 0.;
  AbutBoundary *b;

  CkOk(AbutBodySetDisplacement(body, "left", 0, Zero, NULL));
  CkOk(AbutBodySetDisplacement(body, "bottom", 1, Zero, NULL));
  CkOk(AbutBodySetTraction(body, "top", 1, Square, NULL));
  CkOk(AbutBodySetTraction(body, "right", 0, Square, NULL)); /* 25 */
  CkOk(AbutBodySetTraction(body, "right", 1, Square, NULL)); /* at the lower corner it meets a prescribed displacement */
  CkOk(AbutBodySetContact(body, 3));
  CkOk(AbutBodySolve(body, NULL));
  CkOk(AbutBodyGetBoundary(body, &b));
  for (PetscInt i = 0; i < b->n; ++i) {
    const PetscReal *p = b->x + 2 * i, *q = b->x + 2 * b->next[i], h = PetscAbsReal(p[0] - q[0]) + PetscAbsReal(p[1] - q[1]),
                    *t = b->traction + 4 * i;

    for (PetscInt k = 0; k < 2; ++k) {
      const PetscReal s = k ? 1. : 0., step = -h; /* the top runs from right to left */

      ck_assert_double_eq_tol(t[2 * k], b->side[i] == 1 ? 25. : 0., 1e-12);
      ck_assert_double_eq_tol(t[2 * k + 1],
                              b->side[i] == 1   ? 25.
                              : b->side[i] == 3 ? p[0] * p[0] + 2. * p[0] * step * s + h * h * (s - 1. / 6.)
                                                : 0.,
                              1e-11);
    }
    ck_assert_int_eq(b->condition[2 * i], b->side[i] == 0 ? ABUT_DISPLACEMENT : (b->side[i] == 3 ? ABUT_CONTACT : ABUT_TRACTION));
    ck_assert_int_eq(b->condition[2 * i + 1], b->side[i] == 2 ? ABUT_DISPLACEMENT : ABUT_TRACTION);
    for (PetscInt d = 0; d < 2; ++d) {
      sum[d] += 0.5 * h * (t[d] + t[2 + d]) + b->reaction[2 * i + d];
      if (b->x[2 * i + d] != 1. + d) ck_assert_double_eq(b->reaction[2 * i + d], 0.); /* nothing holds this node along d */
      sum[2] += (d ? -1. : 1.) * p[!d] * b->reaction[2 * i + d];
      sum[2] += (d ? -1. : 1.) * h / 6. * (p[!d] * (2. * t[d] + t[2 + d]) + q[!d] * (t[d] + 2. * t[2 + d]));
      total += h * PetscAbsReal(t[d]);
    }
  }
  for (PetscInt k = 0; k < 3; ++k) ck_assert_double_eq_tol(sum[k], 0., 1e-12 * total * (k < 2 ? 1. : 5.));
  CkOk(AbutBodyGetReaction(body, reaction, applied));
  ck_assert_double_eq_tol(applied[0], 25., 1e-12 * total);
  ck_assert_double_eq_tol(applied[1], 25. + (125. - 1.) / 3., 1e-12 * total);
  for (PetscInt d = 0; d < 2; ++d) ck_assert_double_eq_tol(reaction[d], -applied[d], 1e-12 * total);
  CkOk(AbutBoundaryDestroy(&b));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(a_side_is_an_ordered_list_of_nodes_with_outward_normals)
{
  const PetscReal from[4][2] =
    {
      {1., 3.},
      {5., 2.},
      {1., 2.},
      {5., 3.}
  },
                  to[4][2] = {{1., 2.}, {5., 3.}, {5., 2.}, {1., 3.}};
  CkField         linear   = {.at = CkLinear};
  AbutBody        body     = Make(&linear, _i % NMESHES, (AbutShape)(_i / NMESHES));
  PetscInt        n        = 0;
  const AbutSide *side;

  CkGiveAll(body, &linear, "uu", "uu", "uu", "uu");
  CkOk(AbutBodySetUp(body));
  for (PetscInt s = 0; s < 4; ++s) {
    CkOk(AbutBodyGetSide(body, s, &side));
    ck_assert(side->x[0] == from[s][0] && side->x[1] == from[s][1]);
    ck_assert(side->x[2 * side->n - 2] == to[s][0] && side->x[2 * side->n - 1] == to[s][1]);
    for (PetscInt i = 0; i + 1 < side->n; ++i) {
      for (PetscInt d = 0; d < 2; ++d) ck_assert_double_eq_tol(side->normal[2 * i + d], ck_normals[s][d], 1e-15);
      ck_assert_double_gt((side->x[2 * i + 2] - side->x[2 * i]) * -ck_normals[s][1] +
                            (side->x[2 * i + 3] - side->x[2 * i + 1]) * ck_normals[s][0],
                          0.);
    }
    n += side->n - 1;
  }
  ck_assert_int_eq(n, CkSum(CkTopology(CkMeshOf(body))->nsideedges));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(a_node_is_fixed_where_its_normal_displacement_is_prescribed_by_either_side)
{
  /* conditions of left, right, bottom, top; then whether first, inner, last node of each side is fixed along its normal */
  static const struct {
    const char *conditions[4], *fixed[4];
  } cases[] = {
    {{"u-", "--", "-u", "--"}, {"111", "000", "111", "000"}}, /* the layers scene: its symmetry plane fixes no normal of the top */
    {{"uu", "--", "--", "--"}, {"111", "000", "100", "001"}}, /* clamped on the left: fixed along both normals at its two corners */
    {{"--", "-u", "uu", "--"}, {"001", "100", "111", "100"}}
  };
  CkField         linear = {.at = CkLinear};
  AbutBody        body   = Make(&linear, GRID, ABUT_QUAD);
  const AbutSide *side;

  CkGiveAll(body, &linear, cases[_i].conditions[0], cases[_i].conditions[1], cases[_i].conditions[2], cases[_i].conditions[3]);
  CkOk(AbutBodySetUp(body));
  for (PetscInt s = 0; s < 4; ++s) {
    CkOk(AbutBodyGetSide(body, s, &side));
    for (PetscInt i = 0; i < side->n; ++i) ck_assert_int_eq(side->fixed[i], cases[_i].fixed[s][!i ? 0 : (i + 1 == side->n ? 2 : 1)] == '1');
  }
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* A body loaded by the traction x^2 on its top, or by the moments of x^2 as contact forces; and some more contact forces in both cases */
START_TEST(nodal_side_forces_act_as_the_traction_they_stand_for)
{
  const PetscReal more = -3., x[2] = {2.1, 2.7};
  PetscReal       value[2][7];

  for (PetscInt asforce = 0; asforce < 2; ++asforce) {
    CkField         linear = {.at = CkLinear};
    AbutBody        body   = Make(&linear, _i % NMESHES, (AbutShape)(_i / NMESHES));
    PetscReal      *force, *trace, work = 0., dot, strain, twice, sum = 0., reaction[2], applied[2];
    Vec             f, u;
    const AbutSide *top, *base;
    AbutBoundary   *b;

    CkOk(AbutBodySetDisplacement(body, "left", 0, Zero, NULL));
    CkOk(AbutBodySetDisplacement(body, "bottom", 1, Zero, NULL));
    if (!asforce) CkOk(AbutBodySetTraction(body, "top", 1, Square, NULL));
    CkOk(AbutBodySetUp(body));
    CkOk(AbutBodyGetSide(body, 3, &top));
    CkOk(AbutBodyGetSide(body, 2, &base));
    CkOk(AbutBodyCreateVec(body, &f));
    CkOk(PetscCalloc2(PetscMax(top->n, base->n), &force, PetscMax(top->n, base->n), &trace));
    for (PetscInt i = 0; i < base->n; ++i) force[i] = 2.;
    CkOk(AbutBodyAddSideForce(body, 2, 1, force, f)); /* straight into the support */
    for (PetscInt i = 0; i < top->n; ++i) force[i] = more;
    for (PetscInt i = 0; asforce && i + 1 < top->n; ++i) { /* on the element from r back to r - h */
      const PetscReal r = top->x[2 * i], h = r - top->x[2 * i + 2];

      force[i] += h * (r * r / 2. - r * h / 3. + h * h / 12.);
      force[i + 1] += h * (r * r / 2. - 2. * r * h / 3. + h * h / 4.);
    }
    CkOk(AbutBodyAddSideForce(body, 3, 1, force, f));
    CkOk(AbutBodySolve(body, f));
    CkOk(AbutBodyGetPointValues(body, x, value[asforce]));
    CkOk(AbutBodyGetSolution(body, &u));
    CkOk(AbutBodyGetSideTrace(body, 3, 1, u, trace));
    CkOk(VecDot(f, u, &dot));
    for (PetscInt i = 0; i < top->n; ++i) work += force[i] * trace[i];
    ck_assert_double_eq_tol(dot, work, 1e-12 * PetscAbsReal(work));
    CkOk(AbutBodyGetSideTrace(body, 2, 1, u, trace)); /* nothing moves at the base */
    for (PetscInt i = 0; i < base->n; ++i) ck_assert_double_eq(trace[i], 0.);
    CkOk(AbutBodyGetReaction(body, reaction, applied));
    ck_assert_double_eq_tol(reaction[1], -applied[1], 1e-10);
    CkOk(AbutBodyGetEnergy(body, &strain, &twice));
    ck_assert_double_eq_tol(twice, 2. * strain, 1e-11 * twice);
    CkOk(AbutBodyGetBoundary(body, &b));
    for (PetscInt i = 0; i < top->n; ++i) sum += force[i];
    sum -= 2. * base->n;
    for (PetscInt i = 0; i < b->n; ++i) sum -= b->contact[2 * i + 1];
    ck_assert_double_eq_tol(sum, 0., 1e-10);
    CkOk(AbutBoundaryDestroy(&b));
    CkOk(PetscFree2(force, trace));
    CkOk(VecDestroy(&f));
    CkOk(AbutBodyDestroy(&body));
  }
  for (PetscInt i = 0; i < 7; ++i)
    ck_assert_double_eq_tol(value[0][i], value[1][i],
                            1e-11 * (i < 2 ? PetscAbsReal(value[1][0]) + PetscAbsReal(value[1][1]) : value[1][6]));
}
END_TEST

START_TEST(the_far_side_is_the_base_of_a_winkler_layer)
{
  const PetscReal up[2] =
    {
      0., 1.
  },
                  left[2] = {-1., 0.}, right[2] = {1., 0.}, x[2] = {3., 3.}, y[2] = {1., 2.5}, foot[2][2] = {{3., 2.}, {5., 2.5}};
  CkField   linear = {.at = CkLinear};
  AbutBody  body   = Make(&linear, GRID, ABUT_QUAD);
  PetscReal value, u[2], s[3], height;
  PetscBool found;

  CkGiveAll(body, &linear, "--", "u-", "-u", "--");
  CkLinear(&linear, foot[0], u, s);
  CkOk(AbutBodyGetSupportDisplacement(body, x, up, &value, &found));
  ck_assert(found && value == u[1]);
  CkLinear(&linear, foot[1], u, s);
  CkOk(AbutBodyGetSupportDisplacement(body, y, left, &value, &found));
  ck_assert(found && value == -u[0]);
  CkOk(AbutBodyGetSupportDisplacement(body, foot[1], right, &value, &found));
  ck_assert_int_eq(found, PETSC_FALSE);
  CkOk(AbutBodyGetHeight(body, up, &height));
  ck_assert_double_eq(height, 1.);
  CkOk(AbutBodyGetHeight(body, left, &height));
  ck_assert_double_eq(height, 4.);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("body_boundary");
  TCase *tc    = tcase_create("all");
  int    failed;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  tcase_set_timeout(tc, 0);
  tcase_add_loop_test(tc, the_boundary_is_one_closed_contour_with_the_body_on_the_left, 0, 2 * NMESHES);
  tcase_add_loop_test(tc, reactions_are_the_moments_of_the_tractions_that_hold_the_body, 0, 2 * NMESHES);
  tcase_add_loop_test(tc, given_tractions_are_projected_and_balance_the_reactions_in_force_and_moment, 0, 2 * NMESHES);
  tcase_add_loop_test(tc, a_side_is_an_ordered_list_of_nodes_with_outward_normals, 0, 2 * NMESHES);
  tcase_add_loop_test(tc, a_node_is_fixed_where_its_normal_displacement_is_prescribed_by_either_side, 0, 3);
  tcase_add_loop_test(tc, nodal_side_forces_act_as_the_traction_they_stand_for, 0, 2 * NMESHES);
  tcase_add_test(tc, the_far_side_is_the_base_of_a_winkler_layer);
  suite_add_tcase(suite, tc);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
