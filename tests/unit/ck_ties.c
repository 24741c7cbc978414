/* ranks: 1 2 3 4 */
#include "ckbody.h"

/* Meshes whose vertices on the sides are tied to positions */

static PetscReal Hash(PetscInt i)
{
  const PetscReal h = 1e4 * PetscSinReal(12.9898 * i + 4.1);

  return h - PetscFloorReal(h);
}

/* A box of 4x1 with small cells here and there, hanging vertices among them */
static AbutMesh Scattered(MPI_Comm comm, AbutShape shape)
{
  AbutMesh mesh = CkBoxOn(comm, 0., 0., 4., 1., 8, 2, shape);

  CkRefine(mesh, CkScattered, 3);
  return mesh;
}

/* Ties of the vertices nearest to a few points of each side to these points */
static void TieToPoints(AbutMesh mesh, PetscInt seed, PetscInt perside)
{
  AbutTie   tie[16];
  PetscInt  n = 0;
  PetscBool found;

  for (PetscInt i = 0; i < 4 * perside; ++i) {
    const PetscInt  side = i % 4;
    PetscReal       ends[4], normal[2], x[2];
    const PetscReal z = Hash(100 * seed + i);

    CkOk(AbutMeshGetSideEnds(mesh, side, ends, normal));
    for (PetscInt d = 0; d < 2; ++d) x[d] = (1. - z) * ends[d] + z * ends[2 + d];
    CkOk(AbutMeshFindTie(mesh, side, x, &tie[n], &found));
    if (found) ++n;
  }
  CkOk(AbutMeshSetTies(mesh, n, tie));
  CkOk(AbutMeshAdapt(mesh, NULL));
}

/* Twice the area of the triangle of a corner and its neighbours */
static PetscReal Corner(const CkCells *all, PetscInt c, PetscInt k)
{
  const PetscInt   m    = all->corners;
  const PetscReal *cell = all->x + 2 * m * c, *a = cell + 2 * ((k + m - 1) % m), *b = cell + 2 * k, *e = cell + 2 * ((k + 1) % m);

  return (e[0] - b[0]) * (a[1] - b[1]) - (e[1] - b[1]) * (a[0] - b[0]);
}

/* No cell is folded, and together they fill the box */
static void CheckFills(AbutMesh mesh)
{
  CkCells   all  = CkGather(mesh);
  PetscReal area = 0., lower[2] = {9., 9.}, upper[2] = {-9., -9.};

  for (PetscInt c = 0; c < all.n; ++c)
    for (PetscInt k = 0; k < all.corners; ++k) {
      const PetscReal twice = Corner(&all, c, k), *x = all.x + 2 * (all.corners * c + k);

      ck_assert(twice > 0.);
      area += twice / (all.corners == 4 ? 4. : 6.);
      for (PetscInt d = 0; d < 2; ++d) {
        lower[d] = PetscMin(lower[d], x[d]);
        upper[d] = PetscMax(upper[d], x[d]);
      }
    }
  ck_assert_double_eq_tol(area, 4., 1e-13);
  ck_assert(lower[0] == 0. && lower[1] == 0. && upper[0] == 4. && upper[1] == 1.);
  CkOk(PetscFree(all.x));
}

START_TEST(no_cell_folds_whatever_is_tied)
{
  for (PetscInt seed = 0; seed < 5; ++seed) {
    AbutMesh mesh = Scattered(PETSC_COMM_WORLD, (AbutShape)_i);
    AbutTie  tie[12];

    TieToPoints(mesh, seed, 2);
    CheckFills(mesh);
    /* far more than is possible: vertices close to each other that are to change places, or to leave the side */
    for (PetscInt i = 0; i < 12; ++i) {
      const PetscInt  side = (PetscInt)(4. * Hash(1000 + 50 * seed + i));
      const PetscReal size = side < 2 ? 1. : 4.;

      tie[i].side      = side;
      tie[i].reference = size * (1. + PetscFloorReal(7. * Hash(2000 + 50 * seed + i))) / 8.;
      tie[i].wanted    = size * (2. * Hash(3000 + 50 * seed + i) - 0.5);
    }
    CkOk(AbutMeshSetTies(mesh, 12, tie));
    CkOk(AbutMeshAdapt(mesh, NULL));
    CheckFills(mesh);
    CkRefine(mesh, CkScattered, 1);
    CheckFills(mesh);
    CkOk(AbutMeshDestroy(&mesh));
  }
}
END_TEST

/* Is there a vertex on this side with this position? */
static PetscBool HasVertex(AbutMesh mesh, PetscInt side, PetscReal at)
{
  const AbutMeshTopology *t = CkTopology(mesh);
  PetscInt                n = 0;

  for (PetscInt k = 0; k < t->nsideedges; ++k)
    for (PetscInt i = 0; i < 2; ++i)
      n += t->sideedge[3 * k + 2] == side && PetscAbsReal(t->x[2 * t->sideedge[3 * k + i] + !(side / 2)] - at) < 1e-14;
  return (PetscBool)(CkSum(n) > 0);
}

START_TEST(a_vertex_lies_where_it_is_tied_and_stays_there)
{
  const PetscReal at[2][2] = {
    {1.3, 0. },
    {0.,  0.4}
  };
  const PetscInt side[] = {2, 0};
  AbutMesh       mesh   = Scattered(PETSC_COMM_WORLD, (AbutShape)_i);
  AbutTie        tie[2], again;
  PetscBool      found;

  for (PetscInt i = 0; i < 2; ++i) {
    CkOk(AbutMeshFindTie(mesh, side[i], at[i], &tie[i], &found));
    ck_assert(found);
  }
  CkOk(AbutMeshSetTies(mesh, 2, tie));
  CkOk(AbutMeshAdapt(mesh, NULL));
  CkRefine(mesh, CkScattered, 1);
  for (PetscInt i = 0; i < 2; ++i) {
    PetscReal moved[2] = {at[i][0], at[i][1]};

    ck_assert(HasVertex(mesh, side[i], at[i][!(side[i] / 2)]));
    CkOk(AbutMeshFindTie(mesh, side[i], at[i], &again, &found));
    ck_assert(found && again.reference == tie[i].reference && again.wanted == tie[i].wanted);
    moved[!(side[i] / 2)] += 1e-4; /* the same vertex follows */
    CkOk(AbutMeshFindTie(mesh, side[i], moved, &again, &found));
    ck_assert(found && again.reference == tie[i].reference && again.wanted == moved[!(side[i] / 2)]);
  }
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

START_TEST(the_ends_of_a_side_are_not_tied)
{
  AbutMesh  mesh = CkBox(0., 0., 4., 1., 4, 1, (AbutShape)_i);
  AbutTie   tie;
  PetscBool found;

  for (PetscInt i = 0; i < 2; ++i) {
    const PetscReal x[2] = {i ? 0.51 : 0.49, 1.}, beyond[2] = {i ? -0.1 : 4.1, 1.};

    CkOk(AbutMeshFindTie(mesh, 3, x, &tie, &found));
    ck_assert_int_eq(found, i);
    if (found) ck_assert(tie.reference == 1. && tie.wanted == x[0]);
    CkOk(AbutMeshFindTie(mesh, 3, beyond, &tie, &found));
    ck_assert(!found);
  }
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

START_TEST(hanging_vertices_stay_in_the_middle)
{
  AbutMesh                mesh = Scattered(PETSC_COMM_WORLD, ABUT_QUAD);
  const AbutMeshTopology *t;
  CkCells                 all;
  PetscInt                nhanging = 0;

  TieToPoints(mesh, 3, 2);
  t   = CkTopology(mesh);
  all = CkGather(mesh);
  for (PetscInt v = 0; v < t->nvertices; ++v) {
    PetscInt n = 0;

    if (t->unknown[v] >= 0) continue;
    ++nhanging;
    for (PetscInt k = 0; k < 4 * all.n; ++k) {
      const PetscReal *p = all.x + 2 * k, *q = all.x + 2 * (k / 4 * 4 + (k + 1) % 4);

      n += PetscAbsReal(0.5 * (p[0] + q[0]) - t->x[2 * v]) + PetscAbsReal(0.5 * (p[1] + q[1]) - t->x[2 * v + 1]) < 1e-14;
    }
    ck_assert_int_eq(n, 1);
  }
  ck_assert(CkSum(nhanging) > 10);
  CkOk(PetscFree(all.x));
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

/* Every cell of one mesh is one of the other, to the last bit */
static void CheckSame(const CkCells *one, const CkCells *other)
{
  const PetscInt n = 2 * one->corners;

  ck_assert_int_eq(one->n, other->n);
  for (PetscInt c = 0; c < one->n; ++c) {
    PetscInt found = 0;

    for (PetscInt e = 0; e < other->n; ++e)
      for (PetscInt turn = 0; turn < one->corners; ++turn) {
        PetscBool same = PETSC_TRUE;

        for (PetscInt i = 0; i < n && same; ++i) same = (PetscBool)(one->x[n * c + i] == other->x[n * e + (i + 2 * turn) % n]);
        found += same;
      }
    ck_assert_int_eq(found, 1);
  }
}

START_TEST(every_distribution_has_the_same_mesh)
{
  AbutMesh mesh[2];
  CkCells  all[2];

  for (PetscInt i = 0; i < 2; ++i) {
    mesh[i] = Scattered(i ? PETSC_COMM_SELF : PETSC_COMM_WORLD, (AbutShape)_i);
    TieToPoints(mesh[i], 5, 3);
    CkRefine(mesh[i], CkTowardsPoint, 2);
    TieToPoints(mesh[i], 6, 2);
    all[i] = CkGather(mesh[i]);
  }
  CheckSame(&all[0], &all[1]);
  for (PetscInt i = 0; i < 2; ++i) {
    CkOk(PetscFree(all[i].x));
    CkOk(AbutMeshDestroy(&mesh[i]));
  }
}
END_TEST

/* The same marks by number, of meshes whose cells are in the same order */
static void RefineAlike(AbutMesh mesh, PetscInt seed)
{
  PetscBool *mark;
  PetscInt   n = CkTopology(mesh)->ncells;

  CkOk(PetscMalloc1(n, &mark));
  for (PetscInt c = 0; c < n; ++c) mark[c] = (PetscBool)(Hash(seed + 31 * c) < 0.2);
  CkOk(AbutMeshAdapt(mesh, mark));
  CkOk(PetscFree(mark));
}

START_TEST(levels_and_marks_know_nothing_of_ties)
{
  AbutMesh mesh[2] = {Scattered(PETSC_COMM_WORLD, (AbutShape)_i), Scattered(PETSC_COMM_WORLD, (AbutShape)_i)};
  CkCells  all[2];
  PetscInt generation;

  for (PetscInt i = 0; i < 3; ++i) {
    const AbutMeshTopology *t[2];

    TieToPoints(mesh[0], i, 2);
    for (PetscInt k = 0; k < 2; ++k) {
      RefineAlike(mesh[k], i);
      t[k] = CkTopology(mesh[k]);
    }
    ck_assert_int_eq(t[0]->ncells, t[1]->ncells);
    for (PetscInt c = 0; c < t[0]->ncells; ++c) ck_assert_int_eq(t[0]->level[c], t[1]->level[c]);
  }
  CkOk(AbutMeshGetGeneration(mesh[0], &generation));
  CkOk(AbutMeshSetTies(mesh[0], 0, NULL));
  for (PetscInt i = 1; i < 3; ++i) { /* the second time there is nothing to do */
    PetscInt now;

    CkOk(AbutMeshAdapt(mesh[0], NULL));
    CkOk(AbutMeshGetGeneration(mesh[0], &now));
    ck_assert_int_eq(now, generation + 1);
  }
  for (PetscInt i = 0; i < 2; ++i) all[i] = CkGather(mesh[i]);
  CheckSame(&all[0], &all[1]);
  for (PetscInt i = 0; i < 2; ++i) {
    CkOk(PetscFree(all[i].x));
    CkOk(AbutMeshDestroy(&mesh[i]));
  }
}
END_TEST

/* Linear displacements are exact on any mesh, also when only the ties have changed */
START_TEST(the_patch_test_holds_on_tied_meshes)
{
  const AbutShape shape = _i < ABUT_ORDER_MAX ? ABUT_QUAD : ABUT_TRIANGLE;
  CkField         field = {.at = CkLinear, .order = 1 + _i % ABUT_ORDER_MAX};
  AbutBody        body  = CkBodyOn(PETSC_COMM_WORLD, "box", &field, 0., 0., 4., 1., 8, 2, shape);

  CkRefine(CkMeshOf(body), CkScattered, 3);
  CkGiveAll(body, &field, "uu", "tt", "tu", "ut");
  CkOk(AbutBodySetFromOptions(body));
  for (PetscInt seed = 0; seed < 3; ++seed) {
    TieToPoints(CkMeshOf(body), seed, 2);
    CkOk(AbutBodySetUp(body));
    CkOk(AbutBodySolve(body, NULL));
    ck_assert_double_lt(CkNodalError(body, &field), 1e-12);
    ck_assert_double_lt(CkStressError(body, &field), 1e-12);
  }
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("ties");
  TCase *tests = tcase_create("ties");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, no_cell_folds_whatever_is_tied, ABUT_QUAD, ABUT_TRIANGLE + 1);
  tcase_add_loop_test(tests, a_vertex_lies_where_it_is_tied_and_stays_there, ABUT_QUAD, ABUT_TRIANGLE + 1);
  tcase_add_loop_test(tests, the_ends_of_a_side_are_not_tied, ABUT_QUAD, ABUT_TRIANGLE + 1);
  tcase_add_test(tests, hanging_vertices_stay_in_the_middle);
  tcase_add_loop_test(tests, every_distribution_has_the_same_mesh, ABUT_QUAD, ABUT_TRIANGLE + 1);
  tcase_add_loop_test(tests, levels_and_marks_know_nothing_of_ties, ABUT_QUAD, ABUT_TRIANGLE + 1);
  tcase_add_loop_test(tests, the_patch_test_holds_on_tied_meshes, 0, 2 * ABUT_ORDER_MAX - 1); /* triangles to order 3 */
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
