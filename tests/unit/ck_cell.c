/* ranks: 1 2 3 4 */
#include "ckmesh.h"

/* The map of a cell, the paper's measures of a mesh, and what is said of a mesh by keys and names */

static PetscReal Random(PetscInt i)
{
  const PetscReal r = 1e4 * PetscSinReal(12.9898 * i + 1.);

  return r - PetscFloorReal(r);
}

/* A point of the reference cell */
static void Reference(PetscInt corners, PetscInt i, PetscReal xi[2])
{
  xi[0] = Random(2 * i);
  xi[1] = Random(2 * i + 1);
  for (PetscInt d = 0; d < 2; ++d) xi[d] = corners == 4 ? 2. * xi[d] - 1. : 0.5 * xi[d];
}

START_TEST(a_cell_maps_to_where_its_inverse_finds_the_point)
{
  AbutMesh                mesh = CkBox(-3., 7., 5., 10., 7, 3, (AbutShape)_i);
  const AbutMeshTopology *t;

  CkRefine(mesh, CkScattered, 4);
  t = CkTopology(mesh);
  for (PetscInt c = 0; c < t->ncells; ++c) {
    PetscReal xi[2], x[2], N[4], G[8], det, back[2], sum = 0., g[6] = {0., 0., 0., 0., 0., 0.}, area = 0.;
    PetscBool inside;

    Reference(t->corners, c, xi);
    CkOk(AbutMeshMapCell(mesh, c, xi, x, N, G, &det));
    CkOk(AbutMeshInvertCell(mesh, c, x, back, &inside));
    ck_assert_int_eq(inside, PETSC_TRUE);
    for (PetscInt d = 0; d < 2; ++d)
      ck_assert_double_eq_tol(back[d], xi[d], 1e-10); /* the point itself is rounded to 1e-15 of its 10, cells are 1e-2 */
    for (PetscInt k = 0; k < t->corners; ++k) {
      const PetscReal *p = t->x + 2 * t->cell[t->corners * c + k], *q = t->x + 2 * t->cell[t->corners * c + (k + 1) % t->corners];

      sum += N[k];
      area += 0.5 * ((p[0] - x[0]) * (q[1] - x[1]) - (p[1] - x[1]) * (q[0] - x[0]));
      for (PetscInt j = 0; j < 2; ++j) {
        g[j] += G[2 * k + j];
        g[2 + j] += p[0] * G[2 * k + j];
        g[4 + j] += p[1] * G[2 * k + j];
      }
    }
    ck_assert_double_eq_tol(sum, 1., 1e-15);
    ck_assert_double_eq_tol((t->corners == 4 ? 4. : 0.5) * det, area, 1e-12 * area); /* parallelograms have one determinant */
    for (PetscInt j = 0; j < 6; ++j) ck_assert_double_eq_tol(g[j], j == 2 || j == 5 ? 1. : 0., 1e-11);
  }
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

/* Cells add 1, their outward normal times the length, and where the side starts: where a side has two neighbours the normals cancel */
START_TEST(what_cells_add_at_their_sides_is_summed)
{
  AbutMesh                mesh = CkBox(0., 0., 3., 2., 6, 4, (AbutShape)_i);
  const AbutMeshTopology *t;
  PetscReal              *count, *sum;
  PetscBool              *outer;

  CkRefine(mesh, CkScattered, 3);
  t = CkTopology(mesh);
  CkOk(PetscCalloc3(t->nedges, &count, 4 * t->nedges, &sum, t->nedges, &outer));
  for (PetscInt i = 0; i < t->corners * t->ncells; ++i) {
    const PetscInt   c = i / t->corners, k = i % t->corners, e = t->celledge[i], parent = t->edgeparent[2 * e];
    const PetscReal *p = t->x + 2 * t->cell[i], *q = t->x + 2 * t->cell[t->corners * c + (k + 1) % t->corners];

    ck_assert(t->edge[2 * e] == t->cell[i] || t->edge[2 * e + 1] == t->cell[i]);
    for (PetscInt side = e; side >= 0; side = side == e ? parent : -1) { /* it, and the coarse one above it */
      const PetscReal *start    = t->x + 2 * t->edge[2 * side];
      const PetscReal  value[4] = {q[1] - p[1], p[0] - q[0], start[0], start[1]};

      count[side] += 1.;
      for (PetscInt j = 0; j < 4; ++j) sum[4 * side + j] += value[j];
    }
    for (PetscInt j = 0; j < t->nsideedges; ++j)
      if (t->sidecell[j] == c && t->sideedge[3 * j] == t->cell[i]) outer[e] = PETSC_TRUE;
  }
  CkOk(AbutMeshSumAtEdges(mesh, 1, count));
  CkOk(AbutMeshSumAtEdges(mesh, 4, sum));
  for (PetscInt i = 0; i < t->corners * t->ncells; ++i) {
    const PetscInt e = t->celledge[i], above = t->edgeparent[2 * e] >= 0 ? t->edgeparent[2 * e] : e; /* a coarse side has three cells */

    if (outer[e]) ck_assert_double_eq(count[e], 1.);
    else if (above != e) ck_assert_double_eq(count[above], 3.);
    else ck_assert(count[e] == 2. || count[e] == 3.);
    for (PetscInt d = 0; d < 2; ++d) {
      if (!outer[e]) ck_assert_double_eq_tol(sum[4 * above + d], 0., 1e-13);
      ck_assert_double_eq_tol(sum[4 * above + 2 + d], count[above] * t->x[2 * t->edge[2 * above] + d], 1e-13);
    }
  }
  CkOk(PetscFree3(count, sum, outer));
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

/* Cells add their angles: a full turn, half of one on a side of the box and at a hanging vertex, a quarter in a corner */
START_TEST(what_cells_add_at_their_vertices_is_summed)
{
  AbutMesh                mesh = CkBox(0., 0., 3., 2., 6, 4, (AbutShape)_i);
  const AbutMeshTopology *t;
  PetscReal              *angle;

  CkRefine(mesh, CkScattered, 3);
  t = CkTopology(mesh);
  CkOk(PetscCalloc1(2 * t->nvertices, &angle));
  for (PetscInt i = 0; i < t->corners * t->ncells; ++i) {
    const PetscInt  *cell = t->cell + i / t->corners * t->corners, k = i % t->corners;
    const PetscReal *p = t->x + 2 * cell[k], *q = t->x + 2 * cell[(k + 1) % t->corners],
                    *r = t->x + 2 * cell[(k + t->corners - 1) % t->corners];

    angle[2 * cell[k]] += PetscAtan2Real((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]),
                                         (q[0] - p[0]) * (r[0] - p[0]) + (q[1] - p[1]) * (r[1] - p[1]));
    angle[2 * cell[k] + 1] += 1.;
  }
  CkOk(AbutMeshSumAtVertices(mesh, 2, angle));
  for (PetscInt i = 0; i < t->corners * t->ncells; ++i) {
    const PetscInt  v = t->cell[i];
    const PetscReal x = t->x[2 * v], y = t->x[2 * v + 1];
    const PetscInt  halves = (x < 1e-9 || x > 3. - 1e-9) + (y < 1e-9 || y > 2. - 1e-9) + (t->unknown[v] < 0);

    ck_assert_double_eq_tol(angle[2 * v], 2. * PETSC_PI / (1 << halves), 1e-10);
    if (_i == ABUT_QUAD) ck_assert_double_eq(angle[2 * v + 1], 4. / (1 << halves));
  }
  CkOk(PetscFree(angle));
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

/* x^i y^j over the reference cell: 2/(i+1) 2/(j+1) for even powers on the square, i! j! / (i+j+2)! on the triangle */
START_TEST(gauss_points_integrate_what_they_should)
{
  AbutMesh mesh = CkBox(0., 0., 1., 1., 1, 1, (AbutShape)_i);

  for (PetscInt n = 1; n <= 6; ++n) {
    PetscQuadrature  quadrature;
    const PetscReal *xi, *w;
    PetscInt         points;

    CkOk(AbutMeshCreateQuadrature(mesh, n, &quadrature));
    CkOk(PetscQuadratureGetData(quadrature, NULL, NULL, &points, &xi, &w));
    ck_assert_int_eq(points, n * n);
    for (PetscInt i = 0; i < 2 * n; ++i)
      for (PetscInt j = 0; j < (_i == ABUT_QUAD ? 2 * n : 2 * n - i); ++j) {
        const PetscReal square   = i % 2 || j % 2 ? 0. : 4. / ((i + 1.) * (j + 1.));
        const PetscReal triangle = tgamma(i + 1.) * tgamma(j + 1.) / tgamma(i + j + 3.);
        PetscReal       sum      = 0.;

        for (PetscInt q = 0; q < points; ++q) sum += w[q] * PetscPowRealInt(xi[2 * q], i) * PetscPowRealInt(xi[2 * q + 1], j);
        ck_assert_double_eq_tol(sum, _i == ABUT_QUAD ? square : triangle, 1e-13);
      }
    CkOk(PetscQuadratureDestroy(&quadrature));
  }
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

START_TEST(a_point_is_in_the_cells_that_touch_it_and_in_no_other)
{
  AbutMesh                mesh        = CkBox(0., 0., 3., 2., 3, 2, (AbutShape)_i);
  const AbutMeshTopology *t           = CkTopology(mesh);
  const PetscReal         point[5][2] = {
    {0.25,      0.5},
    {1.,        0.5},
    {1.,        1. },
    {0.,        0. },
    {3. + 1e-6, 1. }
  };
  const PetscInt quads[5] = {1, 2, 4, 1, 0}, triangles[5] = {1, 2, 6, 2, 0};

  for (PetscInt i = 0; i < 5; ++i) {
    PetscInt n = 0;

    for (PetscInt c = 0; c < t->ncells; ++c) {
      PetscReal xi[2];
      PetscBool inside;

      CkOk(AbutMeshInvertCell(mesh, c, point[i], xi, &inside));
      if (inside) ++n;
    }
    ck_assert_int_eq(CkSum(n), _i == ABUT_QUAD ? quads[i] : triangles[i]);
  }
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

/* Diagonal s of a cell a x b: the circle round it, and the circle in its half, have the diameters s and a + b - s */
START_TEST(the_measures_of_a_uniform_mesh_are_those_of_its_right_triangles)
{
  const PetscReal  a = 0.75, b = 0.5, s = PetscSqrtReal(a * a + b * b);
  AbutMesh         mesh = CkBox(1., 1., 7., 3., 8, 4, (AbutShape)_i);
  AbutMeshMeasures m;

  CkOk(AbutMeshGetMeasures(mesh, &m));
  ck_assert_double_eq_tol(m.h_fe, s, 1e-14);
  ck_assert_double_eq_tol(m.h_be, a, 1e-14);
  ck_assert_double_eq_tol(m.h_min, b, 1e-14);
  ck_assert_double_eq_tol(m.regularity, s / (a + b - s), 1e-13);
  ck_assert_double_eq_tol(m.ratio, a / s, 1e-14);
  ck_assert_int_eq(m.lemma, PETSC_TRUE);
  ck_assert_int_eq(m.level_max, 0);
  CkOk(AbutMeshDestroy(&mesh));
  mesh = CkBox(0., 0., 2., 2., 4, 4, (AbutShape)_i);
  CkOk(AbutMeshGetMeasures(mesh, &m));
  ck_assert_double_eq_tol(m.regularity, 1. + PETSC_SQRT2, 1e-13); /* of a square */
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

static PetscBool AtTheBoundary(AbutMesh mesh, PetscInt c, PETSC_UNUSED PetscInt i)
{
  PetscReal x[2];

  CkCenter(CkTopology(mesh), c, x);
  return (PetscBool)(x[0] < 1. || x[0] > 3. || x[1] < 1. || x[1] > 3.);
}

START_TEST(refined_all_along_its_boundary_a_mesh_misses_the_hypothesis_of_lemma_1)
{
  AbutMesh         mesh = CkBox(0., 0., 4., 4., 4, 4, ABUT_QUAD);
  AbutMeshMeasures m;

  CkRefine(mesh, AtTheBoundary, 1);
  CkOk(AbutMeshGetMeasures(mesh, &m));
  ck_assert_int_eq(m.lemma, PETSC_FALSE);
  ck_assert_double_eq_tol(m.h_fe, PETSC_SQRT2, 1e-14);
  ck_assert_double_eq_tol(m.h_be, 0.5, 1e-14);
  ck_assert_double_eq_tol(m.h_min, 0.5, 1e-14);
  ck_assert_int_eq(m.level_max, 1);
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

START_TEST(sides_are_found_by_their_names)
{
  static const char *const names[] = {"left", "right", "bottom", "top"};
  AbutMesh                 mesh    = CkBox(0., 0., 1., 1., 2, 2, ABUT_QUAD);
  PetscErrorCode           code;
  PetscInt                 n, s;
  const char              *name;

  CkOk(AbutMeshGetSideCount(mesh, &n));
  ck_assert_int_eq(n, 4);
  for (PetscInt i = 0; i < n; ++i) {
    CkOk(AbutMeshGetSideName(mesh, i, &name));
    ck_assert_str_eq(name, names[i]);
    CkOk(AbutMeshFindSide(mesh, "key", names[i], &s));
    ck_assert_int_eq(s, i);
  }
  CkOk(AbutMeshFindSide(mesh, "key", "Bottom", &s));
  ck_assert_int_eq(s, 2);
  CkCatch(code = AbutMeshFindSide(mesh, "mid_pair_sides", "botom", &s));
  ck_assert_int_eq(code, PETSC_ERR_USER_INPUT);
  ck_assert(strstr(ck_line, "mid_pair_sides") && strstr(ck_line, "botom") && strstr(ck_line, "left, right, bottom, top"));
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

START_TEST(a_mesh_is_described_by_its_keys)
{
  const PetscReal lower[2] = {0., 0.}, upper[2] = {1., 1.};
  const PetscInt  cells[2] = {2, 2};
  AbutMesh        mesh;
  AbutShape       shape;
  PetscReal       low[2], high[2];
  PetscInt        n;

  CkOptions("-a_mesh_box 1,2,3,5 -a_mesh_cells 4,3 -a_mesh_shape triangle -a_mesh_order 1 -b_mesh_cells 5,3 -b_mesh_shape triangle");
  CkOk(AbutMeshCreate(PETSC_COMM_WORLD, &mesh));
  CkOk(PetscObjectSetOptionsPrefix((PetscObject)mesh, "a_"));
  CkOk(AbutMeshSetFromOptions(mesh));
  CkOk(AbutMeshSetUp(mesh));
  CkOk(AbutMeshGetShape(mesh, &shape));
  CkOk(AbutMeshGetBox(mesh, low, high));
  CkOk(AbutMeshGetCellCount(mesh, &n));
  ck_assert_int_eq(shape, ABUT_TRIANGLE);
  ck_assert(low[0] == 1. && low[1] == 2. && high[0] == 3. && high[1] == 5.);
  ck_assert_int_eq(n, 24);
  CkOk(AbutMeshDestroy(&mesh));
  CkOk(AbutMeshCreate(PETSC_COMM_WORLD, &mesh)); /* keys win over calls, one by one */
  CkOk(PetscObjectSetOptionsPrefix((PetscObject)mesh, "b_"));
  CkOk(AbutMeshSetBox(mesh, lower, upper, cells, ABUT_QUAD));
  CkOk(AbutMeshSetFromOptions(mesh));
  CkOk(AbutMeshSetUp(mesh));
  CkOk(AbutMeshGetCellCount(mesh, &n));
  ck_assert_int_eq(n, 30);
  CkOk(AbutMeshDestroy(&mesh));
  CkOptionsEnd();
}
END_TEST

START_TEST(a_mesh_that_cannot_be_is_refused_with_its_key)
{
  static const char *const bad[][2] = {
    {"-a_mesh_cells 2,2",                                     "a_mesh_box: missing"  },
    {"-a_mesh_box 0,0,1,1",                                   "a_mesh_cells: missing"},
    {"-a_mesh_box 0,0,0,1 -a_mesh_cells 2,2",                 "a_mesh_box:"          },
    {"-a_mesh_box 0,0,1,-1 -a_mesh_cells 2,2",                "a_mesh_box:"          },
    {"-a_mesh_box 0,0,1,1 -a_mesh_cells 0,2",                 "a_mesh_cells:"        },
    {"-a_mesh_box 0,0,1,1 -a_mesh_cells 2,-1",                "a_mesh_cells:"        },
    {"-a_mesh_box 0,0,1,1 -a_mesh_cells 1000000,1000000",     "a_mesh_cells:"        },
    {"-a_mesh_box 0,0,1,1 -a_mesh_cells 2,2 -a_mesh_order 5", "a_mesh_order:"        },
  };
  AbutMesh       mesh;
  PetscErrorCode code;

  CkOptions(bad[_i][0]);
  CkOk(AbutMeshCreate(PETSC_COMM_WORLD, &mesh));
  CkOk(PetscObjectSetOptionsPrefix((PetscObject)mesh, "a_"));
  CkCatch(code = AbutMeshSetFromOptions(mesh));
  ck_assert_int_eq(code, PETSC_ERR_USER_INPUT);
  ck_assert_ptr_nonnull(strstr(ck_line, bad[_i][1]));
  CkOk(AbutMeshDestroy(&mesh));
  CkOptionsEnd();
}
END_TEST

START_TEST(calls_out_of_order_are_refused)
{
  const PetscReal lower[2] = {0., 0.}, upper[2] = {1., 1.};
  const PetscInt  cells[2] = {2, 2};
  AbutMesh        mesh;
  PetscErrorCode  code[3];

  CkOk(AbutMeshCreate(PETSC_COMM_WORLD, &mesh));
  CkCatch(code[0] = AbutMeshSetUp(mesh));
  CkCatch(code[1] = AbutMeshAdapt(mesh, NULL));
  CkOk(AbutMeshSetBox(mesh, lower, upper, cells, ABUT_QUAD));
  CkOk(AbutMeshSetUp(mesh));
  CkCatch(code[2] = AbutMeshSetBox(mesh, lower, upper, cells, ABUT_QUAD));
  for (PetscInt i = 0; i < 3; ++i) ck_assert_int_ne(code[i], 0);
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("cell");
  TCase *tc    = tcase_create("all");
  int    failed;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  tcase_set_timeout(tc, 0);
  tcase_add_loop_test(tc, a_cell_maps_to_where_its_inverse_finds_the_point, 0, 2);
  tcase_add_loop_test(tc, what_cells_add_at_their_sides_is_summed, 0, 2);
  tcase_add_loop_test(tc, what_cells_add_at_their_vertices_is_summed, 0, 2);
  tcase_add_loop_test(tc, gauss_points_integrate_what_they_should, 0, 2);
  tcase_add_loop_test(tc, a_point_is_in_the_cells_that_touch_it_and_in_no_other, 0, 2);
  tcase_add_loop_test(tc, the_measures_of_a_uniform_mesh_are_those_of_its_right_triangles, 0, 2);
  tcase_add_test(tc, refined_all_along_its_boundary_a_mesh_misses_the_hypothesis_of_lemma_1);
  tcase_add_test(tc, sides_are_found_by_their_names);
  tcase_add_test(tc, a_mesh_is_described_by_its_keys);
  tcase_add_loop_test(tc, a_mesh_that_cannot_be_is_refused_with_its_key, 0, 8);
  tcase_add_test(tc, calls_out_of_order_are_refused);
  suite_add_tcase(suite, tc);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
