/* ranks: 1 2 3 4 */
#include "ckmesh.h"

/* Meshes from files, refined: tests/meshes has a quarter of a ring of 3 by 6 quads whose trees are turned at random, and a plate of 4 by 2
   squares in two triangles each; both were written by tests/msh.py */

static AbutMesh Load(const char path[], PetscBool curved, PetscInt order)
{
  AbutMesh mesh;
  PetscInt side;

  CkOk(AbutMeshCreate(PETSC_COMM_WORLD, &mesh));
  CkOk(AbutMeshSetFile(mesh, path, NULL));
  CkOk(AbutMeshSetOrder(mesh, order));
  if (curved) {
    CkOk(AbutMeshFindSide(mesh, "side", "outer", &side));
    CkOk(AbutMeshSetCurve(mesh, side, "key", "circle 0,0,2"));
    CkOk(AbutMeshFindSide(mesh, "side", "inner", &side));
    CkOk(AbutMeshSetCurve(mesh, side, "key", "x^2+y^2-1"));
  }
  CkOk(AbutMeshSetUp(mesh));
  return mesh;
}

START_TEST(hanging_nodes_lie_where_their_anchors_say)
{
  AbutMesh                mesh = Load("tests/meshes/rotated.msh", PETSC_TRUE, _i);
  const AbutMeshTopology *t;
  PetscInt                hanging = 0;

  CkRefine(mesh, CkScattered, 4);
  t = CkTopology(mesh);
  for (PetscInt i = 0; i < t->nnodes; ++i) {
    PetscReal x[2] = {0., 0.};

    if (t->anchors[i + 1] == t->anchors[i]) continue;
    ++hanging;
    for (PetscInt k = t->anchors[i]; k < t->anchors[i + 1]; ++k)
      for (PetscInt d = 0; d < 2; ++d) x[d] += t->weight[k] * t->x[2 * t->anchor[k] + d];
    for (PetscInt d = 0; d < 2; ++d) ck_assert_double_eq_tol(x[d], t->x[2 * i + d], 1e-14);
  }
  ck_assert_int_gt(CkSum(hanging), 20);
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

START_TEST(vertices_of_curved_sides_lie_on_the_curve)
{
  AbutMesh                mesh = Load("tests/meshes/rotated.msh", PETSC_TRUE, 1);
  const AbutMeshTopology *t;
  const char             *name;

  CkRefine(mesh, CkScattered, 4);
  t = CkTopology(mesh);
  for (PetscInt e = 0; e < t->nsideedges; ++e) {
    const PetscReal *x = t->x + 2 * t->sideedge[3 * e], r = PetscSqrtReal(x[0] * x[0] + x[1] * x[1]);

    CkOk(AbutMeshGetSideName(mesh, t->sideedge[3 * e + 2], &name));
    if (!strcmp(name, "outer")) ck_assert_double_eq_tol(r, 2., 1e-13);
    if (!strcmp(name, "inner")) ck_assert_double_eq_tol(r, 1., 1e-13);
    if (!strcmp(name, "left")) ck_assert_double_eq_tol(x[0], 0., 1e-13);
    if (!strcmp(name, "bottom")) ck_assert_double_eq_tol(x[1], 0., 1e-13);
  }
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

/* Two bisections are a level, one is half of it, rounded up */
START_TEST(levels_of_triangles_count_bisections)
{
  AbutMesh                mesh = Load("tests/meshes/triangles.msh", PETSC_FALSE, 1);
  const AbutMeshTopology *t;
  PetscInt                odd = 0;

  CkRefine(mesh, CkScattered, 4);
  t = CkTopology(mesh);
  for (PetscInt c = 0; c < t->ncells; ++c) {
    PetscReal area;
    PetscInt  n;

    CkOk(AbutMeshGetCellArea(mesh, c, &area));
    n = (PetscInt)PetscFloorReal(0.5 + PetscLog2Real(0.125 / area));
    ck_assert_int_eq(t->level[c], (n + 1) / 2);
    odd += n % 2;
  }
  ck_assert_int_gt(CkSum(odd), 10);
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

START_TEST(sides_are_known_before_there_is_a_mesh)
{
  AbutMesh         mesh;
  const PetscReal *x;
  PetscReal        ends[4], normal[2];
  PetscInt         side, n;
  PetscBool        straight, covers;

  CkOk(AbutMeshCreate(PETSC_COMM_WORLD, &mesh));
  CkOk(AbutMeshSetFile(mesh, "tests/meshes/rotated.msh", "body"));
  CkOk(AbutMeshFindSide(mesh, "side", "Left", &side));
  CkOk(AbutMeshGetSideEnds(mesh, side, ends, normal)); /* the body is on the left of the way down */
  ck_assert_double_eq_tol(ends[1], 2., 1e-15);
  ck_assert_double_eq_tol(ends[3], 1., 1e-15);
  ck_assert_double_eq_tol(normal[0], -1., 1e-15);
  CkOk(AbutMeshFindSide(mesh, "side", "outer", &side));
  CkOk(AbutMeshIsSideStraight(mesh, side, &straight));
  ck_assert(!straight);
  CkOk(AbutMeshGetSideSegments(mesh, side, &n, &x));
  ck_assert_int_eq(n, 6);
  for (PetscInt k = 0; k < 5; ++k) ck_assert(x[4 * k + 2] == x[4 * k + 4] && x[4 * k + 3] == x[4 * k + 5]);
  CkOk(AbutMeshCovers(mesh, (PetscReal[2]){1., 1.}, &covers));
  ck_assert(covers);
  CkOk(AbutMeshCovers(mesh, (PetscReal[2]){0.5, 0.5}, &covers));
  ck_assert(!covers);
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

/* Six cells round, so chords of 15 degrees: outwards the first mesh ends at them, inwards, as all later ones will, at the circle */
START_TEST(points_inside_chords_and_curves_are_covered_by_all_meshes)
{
  const PetscReal angle = PETSC_PI / 12.;
  AbutMesh        mesh  = Load("tests/meshes/rotated.msh", PETSC_TRUE, 1);
  PetscInt        near  = 0;

  CkRefine(mesh, CkScattered, 3);
  for (PetscInt i = 0; i < 45; ++i)
    for (PetscInt j = 0; j < 60; ++j) {
      const PetscReal phi = (i + 0.5) * angle * 6. / 45., r = j < 30 ? 0.986 + 1e-3 * j : 1.98 + 1e-3 * (j - 30),
                      x[2]  = {r * PetscCosReal(phi), r * PetscSinReal(phi)};
      const PetscReal chord = r * PetscCosReal(phi - angle * (PetscFloorReal(phi / angle) + 0.5)) / PetscCosReal(0.5 * angle);
      PetscBool       covers, inside = PETSC_FALSE, expected = (PetscBool)(r > 1. && chord < 2.);

      if (PetscMin(PetscAbsReal(r - 1.), PetscAbsReal(chord - 2.)) < 1e-6) continue;
      CkOk(AbutMeshCovers(mesh, x, &covers));
      ck_assert_msg(covers == expected, "(%g, %g) at %g", (double)x[0], (double)x[1], (double)r);
      for (PetscInt c = 0; c < CkTopology(mesh)->ncells && !inside; ++c) {
        PetscReal xi[2];

        CkOk(AbutMeshInvertCell(mesh, c, x, xi, &inside));
      }
      ck_assert(CkSum(inside) || !covers);
      near += !covers && chord > 1. && r < 2.;
    }
  ck_assert_int_gt(near, 100);
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("file");
  TCase *tc    = tcase_create("file");
  int    failed;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;

  tcase_set_timeout(tc, 0);
  tcase_add_loop_test(tc, hanging_nodes_lie_where_their_anchors_say, 1, 5);
  tcase_add_test(tc, vertices_of_curved_sides_lie_on_the_curve);
  tcase_add_test(tc, levels_of_triangles_count_bisections);
  tcase_add_test(tc, sides_are_known_before_there_is_a_mesh);
  tcase_add_test(tc, points_inside_chords_and_curves_are_covered_by_all_meshes);
  suite_add_tcase(suite, tc);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
