/* ranks: 1 */
/* Quads without the 2:1 rule: chains of halves on the sides of coarse cells, and anchors that hang themselves */
#include "ckbody.h"

/* A body whose cells at a point are split again and again, its neighbours never */
static AbutBody Unbalanced(CkField *field, PetscInt n, PetscInt levels, PetscReal x, PetscReal y)
{
  const PetscReal lower[2] = {0., 0.}, upper[2] = {2., 1.};
  const PetscInt  cells[2] = {2 * n, n};
  AbutMesh        mesh;
  AbutBody        body;

  field->young   = CK_YOUNG;
  field->poisson = CK_POISSON;
  CkOk(AbutBodyCreate(PETSC_COMM_WORLD, "body", &body));
  CkOk(AbutBodyGetMesh(body, &mesh));
  CkOk(AbutMeshSetBox(mesh, lower, upper, cells, ABUT_QUAD));
  CkOk(AbutMeshSetBalance(mesh, PETSC_FALSE));
  CkOk(AbutMeshSetUp(mesh));
  CkOk(AbutBodySetMaterial(body, field->young, field->poisson));
  for (PetscInt level = 0; level < levels; ++level) {
    const AbutMeshTopology *t = CkTopology(mesh);
    PetscBool              *mark;

    CkOk(PetscMalloc1(t->ncells, &mark));
    for (PetscInt c = 0; c < t->ncells; ++c) {
      const PetscReal *p = t->x + 2 * t->cell[4 * c], *q = t->x + 2 * t->cell[4 * c + 2];

      mark[c] = (PetscBool)(p[0] < x && x < q[0] && p[1] < y && y < q[1]);
    }
    CkOk(AbutMeshAdapt(mesh, mark));
    CkOk(PetscFree(mark));
  }
  return body;
}

static const PetscReal at[][2] = {
  {0.49,  0.49 }, /* beside corners of the first cells */
  {0.501, 0.26 },
  {1.24,  0.74 },
  {0.335, 0.335}, /* turning about: the ends of coarse sides hang on still coarser ones */
  {1.999, 0.999}
};

START_TEST(only_the_marked_cells_are_split)
{
  CkField  field = {.at = CkLinear};
  AbutBody body  = Unbalanced(&field, 2, 7, at[_i][0], at[_i][1]);
  AbutMesh mesh;
  PetscInt n;

  CkOk(AbutBodyGetMesh(body, &mesh));
  CkOk(AbutMeshGetCellCount(mesh, &n));
  ck_assert_int_eq(n, 8 + 3 * 7);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(hanging_vertices_lie_where_their_anchors_say_and_these_have_unknowns)
{
  CkField                 field = {.at = CkLinear};
  AbutBody                body  = Unbalanced(&field, 2, 7, at[_i][0], at[_i][1]);
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  PetscInt                most = 0;

  CkOk(AbutBodyGetMesh(body, &mesh));
  t = CkTopology(mesh);
  for (PetscInt v = 0; v < t->nvertices; ++v) {
    PetscReal sum[3] = {0., 0., 0.};

    most = PetscMax(most, t->anchors[v + 1] - t->anchors[v]);
    ck_assert_int_eq(t->unknown[v]<0, t->anchors[v + 1]> t->anchors[v]);
    if (t->unknown[v] >= 0) continue;
    for (PetscInt i = t->anchors[v]; i < t->anchors[v + 1]; ++i) {
      const PetscInt a = t->anchor[i];

      ck_assert_int_ge(t->unknown[a], 0);
      ck_assert(t->weight[i] > 0. && t->weight[i] < 1.);
      for (PetscInt d = 0; d < 2; ++d) sum[d] += t->weight[i] * t->x[2 * a + d];
      sum[2] += t->weight[i];
    }
    for (PetscInt d = 0; d < 2; ++d) ck_assert_double_eq_tol(sum[d], t->x[2 * v + d], 1e-14);
    ck_assert_double_eq_tol(sum[2], 1., 1e-14);
  }
  if (_i == 3) ck_assert_int_gt(most, 2); /* a chain: more than the two ends of one side */
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(sides_of_each_level_are_halves_of_those_above)
{
  CkField                 field = {.at = CkLinear};
  AbutBody                body  = Unbalanced(&field, 2, 7, at[_i][0], at[_i][1]);
  AbutMesh                mesh;
  const AbutMeshTopology *t;

  CkOk(AbutBodyGetMesh(body, &mesh));
  t = CkTopology(mesh);
  for (PetscInt e = 0; e < t->nedges; ++e) {
    const PetscInt   parent = t->edgeparent[2 * e], half = t->edgeparent[2 * e + 1];
    const PetscReal *p = t->x + 2 * t->edge[2 * e], *q = t->x + 2 * t->edge[2 * e + 1];

    if (parent < 0) continue;
    for (PetscInt d = 0; d < 2; ++d) {
      const PetscReal a = t->x[2 * t->edge[2 * parent] + d], b = t->x[2 * t->edge[2 * parent + 1] + d];

      ck_assert_double_eq_tol(p[d], half ? 0.5 * (a + b) : a, 1e-14);
      ck_assert_double_eq_tol(q[d], half ? b : 0.5 * (a + b), 1e-14);
    }
  }
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(a_linear_field_is_reproduced)
{
  CkField   field = {.at = CkLinear};
  AbutBody  body  = Unbalanced(&field, 2, 7, at[_i][0], at[_i][1]);
  PetscReal u;

  CkGiveAll(body, &field, "ut", "tt", "tu", "tt");
  CkGive(body, &field, "left", "uu");
  CkOk(AbutBodySetUp(body));
  CkOk(AbutBodySolve(body, NULL));
  u = CkNodalError(body, &field);
  ck_assert_double_lt(u, 1e-10);
  ck_assert_double_lt(CkStressError(body, &field), 1e-10);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* Energy error of a smooth field */
static PetscReal SmoothError(PetscInt n, PetscInt levels, const PetscReal x[2])
{
  CkField   field = {.at = CkSmooth};
  AbutBody  body  = Unbalanced(&field, n, levels, x[0], x[1]);
  PetscReal l2, energy;

  CkGiveAll(body, &field, "uu", "tt", "tt", "tt");
  CkOk(AbutBodySetUp(body));
  CkOk(AbutBodySolve(body, NULL));
  CkErrors(body, &field, &l2, &energy);
  CkOk(AbutBodyDestroy(&body));
  return energy;
}

START_TEST(the_error_falls_with_the_size_of_the_first_cells_and_never_grows_with_splitting)
{
  const PetscReal coarse = SmoothError(4, 0, at[_i]), split = SmoothError(4, 6, at[_i]), fine = SmoothError(8, 6, at[_i]);

  ck_assert_double_lt(split, coarse);
  ck_assert_double_eq_tol(fine / split, 0.5, 0.05);
}
END_TEST

int main(int argc, char **argv)
{
  Suite    *suite = suite_create("unbalanced");
  TCase    *tc    = tcase_create("unbalanced");
  const int n     = PETSC_STATIC_ARRAY_LENGTH(at);
  int       failed;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;

  tcase_set_timeout(tc, 0);
  tcase_add_loop_test(tc, only_the_marked_cells_are_split, 0, n);
  tcase_add_loop_test(tc, hanging_vertices_lie_where_their_anchors_say_and_these_have_unknowns, 0, n);
  tcase_add_loop_test(tc, sides_of_each_level_are_halves_of_those_above, 0, n);
  tcase_add_loop_test(tc, a_linear_field_is_reproduced, 0, n);
  tcase_add_loop_test(tc, the_error_falls_with_the_size_of_the_first_cells_and_never_grows_with_splitting, 0, n);
  suite_add_tcase(suite, tc);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
