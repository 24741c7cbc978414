/* ranks: 1 2 3 4 */
#include "ck_folder.h"
#include "ckmesh.h"

/* Cells that are merged again */

static const AbutShape shapes[] = {ABUT_QUAD, ABUT_TRIANGLE};

static PetscInt Cells(AbutMesh mesh)
{
  PetscInt n;

  CkOk(AbutMeshGetCellCount(mesh, &n));
  return n;
}

static PetscInt Generation(AbutMesh mesh)
{
  PetscInt generation;

  CkOk(AbutMeshGetGeneration(mesh, &generation));
  return generation;
}

/* Marks the cells whose middle lies left of x for merging, and adapts */
static void Merge(AbutMesh mesh, PetscReal x, CkMark split)
{
  const AbutMeshTopology *t = CkTopology(mesh);
  PetscBool              *merge, *marks;
  PetscReal               m[2];

  CkOk(PetscMalloc2(t->ncells + 1, &merge, t->ncells + 1, &marks));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    CkCenter(t, c, m);
    merge[c] = (PetscBool)(m[0] < x);
    marks[c] = split ? split(mesh, c, 0) : PETSC_FALSE;
  }
  CkOk(AbutMeshSetCoarsening(mesh, merge));
  CkOk(AbutMeshAdapt(mesh, split ? marks : NULL));
  CkOk(PetscFree2(merge, marks));
}

static int Ascending(const void *a, const void *b)
{
  const PetscReal *x = (const PetscReal *)a, *y = (const PetscReal *)b;

  if (x[0] != y[0]) return x[0] > y[0] ? 1 : -1;
  return (x[1] > y[1]) - (x[1] < y[1]);
}

/* The corners of all cells, in order and each once: all that is the same in meshes that differ in diagonals of parallelograms */
static CkCells Corners(AbutMesh mesh)
{
  CkCells  all = CkGather(mesh);
  PetscInt k   = 0;

  qsort(all.x, (size_t)(all.corners * all.n), 2 * sizeof(PetscReal), Ascending);
  for (PetscInt i = 1; i < all.corners * all.n; ++i)
    if (Ascending(all.x + 2 * k, all.x + 2 * i)) {
      ++k;
      all.x[2 * k]     = all.x[2 * i];
      all.x[2 * k + 1] = all.x[2 * i + 1];
    }
  all.corners = k + 1; /* of all cells together, each once */
  return all;
}

static void Same(CkCells a, CkCells b)
{
  ck_assert_int_eq(a.n, b.n);
  ck_assert_int_eq(a.corners, b.corners);
  for (PetscInt i = 0; i < 2 * a.corners; ++i) ck_assert_double_eq_tol(a.x[i], b.x[i], 1e-12);
  CkOk(PetscFree(a.x));
  CkOk(PetscFree(b.x));
}

/* A box of 4x1 with 8x2 cells, or twice as many triangles */
START_TEST(merging_is_the_inverse_of_splitting)
{
  const PetscInt first = shapes[_i] == ABUT_QUAD ? 16 : 32;
  AbutMesh       mesh  = CkBox(0., 0., 4., 1., 8, 2, shapes[_i]);
  PetscInt       generation;

  CkRefine(mesh, CkEverywhere, 3);
  ck_assert_int_eq(Cells(mesh), first * 64);
  for (PetscInt level = 2; level >= 0; --level) {
    Merge(mesh, 5., NULL);
    ck_assert_int_eq(Cells(mesh), first << (2 * level));
  }
  generation = Generation(mesh);
  Merge(mesh, 5., NULL); /* cells of the first grid stay, and there is nothing to do */
  CkOk(AbutMeshSetCoarsening(mesh, NULL));
  CkOk(AbutMeshAdapt(mesh, NULL));
  ck_assert_int_eq(Cells(mesh), first);
  ck_assert_int_eq(CkTopology(mesh)->nglobal, 27);
  ck_assert_int_eq(Generation(mesh), generation);
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

/* From a mesh with many levels, marks and all, back to the first one: triangles of closures need more steps than there are levels */
START_TEST(what_is_marked_often_enough_is_the_first_mesh)
{
  AbutMesh mesh = CkBox(0., 0., 4., 1., 8, 2, shapes[_i]), first = CkBox(0., 0., 4., 1., 8, 2, shapes[_i]);
  PetscInt before;

  CkRefine(mesh, CkTowardsPoint, 6);
  CkRefine(mesh, CkScattered, 2);
  for (before = Cells(mesh) + 1; Cells(mesh) < before;) {
    before = Cells(mesh);
    Merge(mesh, 5., NULL);
  }
  Same(Corners(mesh), Corners(first));
  CkOk(AbutMeshDestroy(&mesh));
  CkOk(AbutMeshDestroy(&first));
}
END_TEST

static PetscBool CkLeftmost(AbutMesh mesh, PetscInt c, PETSC_UNUSED PetscInt i)
{
  PetscReal m[2];

  CkCenter(CkTopology(mesh), c, m);
  return (PetscBool)(m[0] < 0.25);
}

/* How many vertices b has from x = left to right; a must have all of them */
static PetscInt Holds(CkCells a, CkCells b, PetscReal left, PetscReal right)
{
  PetscInt n = 0;

  for (PetscInt i = 0; i < b.corners; ++i) {
    if (b.x[2 * i] < left || b.x[2 * i] > right) continue;
    ++n;
    ck_assert_ptr_nonnull(bsearch(b.x + 2 * i, a.x, (size_t)a.corners, 2 * sizeof(PetscReal), Ascending));
  }
  return n;
}

/* Far from the marked cells the mesh has the vertices that it has without merging, and no split is lost */
START_TEST(nothing_else_changes)
{
  AbutMesh merged = CkBox(0., 0., 4., 1., 8, 2, shapes[_i]), split = CkBox(0., 0., 4., 1., 8, 2, shapes[_i]);
  CkCells  a, b;

  for (PetscInt k = 0; k < 2; ++k) {
    CkRefine(k ? merged : split, CkTowardsPoint, 5);
    CkRefine(k ? merged : split, CkScattered, 2);
  }
  Merge(merged, 2., CkScattered);
  CkRefine(split, CkScattered, 1);
  ck_assert_int_lt(Cells(merged), Cells(split));
  a = Corners(merged);
  b = Corners(split);
  ck_assert_int_gt(Holds(a, b, 2.5, 4.), 20);
  ck_assert_int_eq(Holds(a, b, 2.5, 4.), Holds(b, a, 2.5, 4.));
  CkOk(PetscFree(a.x));
  CkOk(PetscFree(b.x));
  CkOk(AbutMeshDestroy(&merged));
  CkOk(AbutMeshDestroy(&split));
}
END_TEST

/* One cell of a family may go and the others may not: there is no new mesh */
START_TEST(marks_that_merge_nothing_change_nothing)
{
  AbutMesh   mesh = CkBox(0., 0., 4., 1., 8, 2, _i ? ABUT_TRIANGLE : ABUT_QUAD);
  PetscInt   generation[2];
  PetscBool *merge;

  CkRefine(mesh, CkEverywhere, 1);
  CkOk(AbutMeshGetGeneration(mesh, &generation[0]));
  for (PetscInt i = 0; i < 2; ++i) {
    const AbutMeshTopology *t = CkTopology(mesh);
    PetscReal               m[2];

    CkOk(PetscMalloc1(t->ncells, &merge));
    for (PetscInt c = 0; c < t->ncells; ++c) {
      CkCenter(t, c, m);
      merge[c] = (PetscBool)(m[0] < 0.2 && m[1] < 0.2);
    }
    CkOk(AbutMeshSetCoarsening(mesh, merge));
    CkOk(AbutMeshAdapt(mesh, NULL));
    CkOk(PetscFree(merge));
  }
  CkOk(AbutMeshGetGeneration(mesh, &generation[1]));
  ck_assert_int_eq(generation[1], generation[0]);
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

START_TEST(only_whole_families_merge_and_the_mesh_stays_balanced)
{
  AbutMesh mesh = CkBox(0., 0., 4., 1., 8, 2, ABUT_QUAD);

  CkRefine(mesh, CkEverywhere, 2);
  Merge(mesh, 1.1, NULL); /* 16 cells in each of four cells of the first grid become 4; in the next column only first cells are marked */
  ck_assert_int_eq(Cells(mesh), 16 * 16 - 4 * 12);
  Merge(mesh, 1.1, NULL); /* the second column has neighbours of level 2, and so stays at level 1 */
  ck_assert_int_eq(Cells(mesh), 16 * 16 - 4 * 12 - 2 * 3);
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

static PetscBool CkRight(AbutMesh mesh, PetscInt c, PetscInt i)
{
  PetscReal m[2];

  CkCenter(CkTopology(mesh), c, m);
  return (PetscBool)(!i || m[0] > 1.);
}

static PetscBool CkSecondColumn(AbutMesh mesh, PetscInt c, PETSC_UNUSED PetscInt i)
{
  PetscReal m[2];

  CkCenter(CkTopology(mesh), c, m);
  return (PetscBool)(m[0] > 0.5 && m[0] < 1.);
}

START_TEST(a_merge_that_balance_takes_back_is_none)
{
  AbutMesh mesh = CkBox(0., 0., 4., 1., 8, 2, ABUT_QUAD);

  CkRefine(mesh, CkRight, 2);
  Merge(mesh, 1., NULL); /* only the first column goes, beside the second one there are cells of level 2 */
  ck_assert_int_eq(Cells(mesh), 2 + 2 * 4 + 12 * 16);
  CkRefine(mesh, CkSecondColumn, 1); /* and the first one for balance */
  ck_assert_int_eq(Cells(mesh), 2 * 4 + 14 * 16);
  Merge(mesh, 1., NULL); /* the first one has been merged, the second one not */
  ck_assert_int_eq(Cells(mesh), 4 * 4 + 12 * 16);
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

START_TEST(a_cell_that_is_to_be_split_keeps_its_siblings)
{
  AbutMesh mesh = CkBox(0., 0., 4., 1., 8, 2, ABUT_QUAD);

  CkRefine(mesh, CkEverywhere, 1);
  Merge(mesh, 5., CkLeftmost); /* four cells are split; the families of the first two columns are left, the second one for balance */
  ck_assert_int_eq(Cells(mesh), 4 * 4 + 4 + 14);
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

START_TEST(a_triangle_that_is_to_be_split_is_split_and_the_others_go)
{
  AbutMesh mesh = CkBox(0., 0., 4., 1., 8, 2, ABUT_TRIANGLE), split = CkBox(0., 0., 4., 1., 8, 2, ABUT_TRIANGLE);
  CkCells  a, b;

  for (PetscInt k = 0; k < 2; ++k) CkRefine(k ? mesh : split, CkEverywhere, 1);
  Merge(mesh, 5., CkLeftmost);
  CkRefine(split, CkLeftmost, 1);
  a = Corners(mesh);
  b = Corners(split);
  ck_assert_int_gt(Holds(a, b, 0., 0.25), 9 + 5);
  ck_assert_int_eq(Holds(b, a, 1., 4.), 3 * 7); /* those of the first grid */
  CkOk(PetscFree(a.x));
  CkOk(PetscFree(b.x));
  CkOk(AbutMeshDestroy(&mesh));
  CkOk(AbutMeshDestroy(&split));
}
END_TEST

static AbutMesh Graded(AbutShape shape)
{
  char     options[256];
  AbutMesh mesh;

  snprintf(options, sizeof(options), "-mesh_box 0,0,4,1 -mesh_cells 8,2 -mesh_size 0.1+x/2 -mesh_shape %s",
           shape == ABUT_QUAD ? "quad" : "triangle");
  CkOptions(options);
  CkOk(AbutMeshCreate(PETSC_COMM_WORLD, &mesh));
  CkOk(AbutMeshSetFromOptions(mesh));
  CkOptionsEnd();
  CkOk(AbutMeshSetUp(mesh));
  return mesh;
}

START_TEST(the_first_mesh_keeps_its_size)
{
  AbutMesh mesh = Graded(shapes[_i]), first = Graded(shapes[_i]);
  PetscInt cells = Cells(first);

  ck_assert_int_gt(cells, 16 + 2 * 3);
  CkRefine(mesh, CkEverywhere, 1);
  for (PetscInt i = 0; i < 3; ++i) Merge(mesh, 5., NULL);
  Same(Corners(mesh), Corners(first));
  CkOk(AbutMeshDestroy(&mesh));
  CkOk(AbutMeshDestroy(&first));
}
END_TEST

START_TEST(what_was_merged_and_is_split_again_stays)
{
  const PetscInt first = shapes[_i] == ABUT_QUAD ? 16 : 32;
  AbutMesh       mesh  = CkBox(0., 0., 4., 1., 8, 2, shapes[_i]);

  CkRefine(mesh, CkEverywhere, 1);
  Merge(mesh, 5., NULL);
  CkRefine(mesh, CkEverywhere, 1);
  Merge(mesh, 5., NULL);
  ck_assert_int_eq(Cells(mesh), first * 4);
  CkRefine(mesh, CkEverywhere, 1); /* other cells may still go, once */
  Merge(mesh, 5., NULL);
  ck_assert_int_eq(Cells(mesh), first * 4);
  CkRefine(mesh, CkEverywhere, 1);
  Merge(mesh, 5., NULL);
  ck_assert_int_eq(Cells(mesh), first * 16);
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

/* Marks that ask for the opposite of what they got, on many levels */
START_TEST(splitting_and_merging_in_turn_ends)
{
  AbutMesh mesh   = CkBox(0., 0., 4., 1., 8, 2, shapes[_i]);
  PetscInt before = 0;

  CkRefine(mesh, CkTowardsPoint, 4);
  for (PetscInt i = 0; i < 40 && before != Cells(mesh); ++i) {
    AbutMeshMeasures m;

    CkOk(AbutMeshGetMeasures(mesh, &m));
    if (m.level_max < 5) CkRefine(mesh, CkTowardsPoint, 1);
    before = Cells(mesh);
    Merge(mesh, 5., NULL);
  }
  ck_assert_int_eq(before, Cells(mesh));
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

/* The mesh is moved; its cells are merged as without ties, and its vertices moved again */
START_TEST(moved_meshes_merge_too)
{
  const AbutTie tie[2] = {
    {3, 1.,  1.1 },
    {1, 0.5, 0.45}
  };
  AbutMesh mesh = CkBox(0., 0., 4., 1., 8, 2, shapes[_i]), other = CkBox(0., 0., 4., 1., 8, 2, shapes[_i]);

  CkOk(AbutMeshSetTies(mesh, 2, tie));
  CkRefine(mesh, CkEverywhere, 3);
  Merge(mesh, 5., NULL);
  CkRefine(other, CkEverywhere, 2);
  CkOk(AbutMeshSetTies(other, 2, tie));
  CkOk(AbutMeshAdapt(other, NULL));
  Same(Corners(mesh), Corners(other));
  CkOk(AbutMeshDestroy(&mesh));
  CkOk(AbutMeshDestroy(&other));
}
END_TEST

START_TEST(every_distribution_merges_the_same_cells)
{
  CkCells all[2];

  for (PetscInt k = 0; k < 2; ++k) {
    AbutMesh mesh   = CkBoxOn(k ? PETSC_COMM_SELF : PETSC_COMM_WORLD, 0., 0., 4., 1., 8, 2, shapes[_i]);
    PetscInt before = 0;

    for (PetscInt i = 0; i < 2; ++i) {
      CkRefine(mesh, CkScattered, 1);
      Merge(mesh, 1. + i, CkScattered);
    }
    before = Cells(mesh);
    Merge(mesh, 2., NULL);
    ck_assert_int_lt(Cells(mesh), before);
    all[k] = Corners(mesh);
    CkOk(AbutMeshDestroy(&mesh));
  }
  Same(all[0], all[1]);
}
END_TEST

/* Cells five times as long as wide, whose bisections depend on what came first: marked cells have a vertex in the middle of each side */
START_TEST(no_split_of_flat_triangles_is_lost)
{
  AbutMesh mesh = CkBox(0., 0., 10., 1., 4, 2, ABUT_TRIANGLE);

  CkRefine(mesh, CkTowardsPoint, 4);
  for (PetscInt i = 0; i < 4; ++i) {
    const AbutMeshTopology *t = CkTopology(mesh);
    PetscReal              *middle;
    PetscInt                n = 0;
    CkCells                 all;

    CkOk(PetscMalloc1(6 * t->ncells, &middle));
    for (PetscInt k = 0; k < 3 * t->ncells; ++k) {
      const PetscReal *a = t->x + 2 * t->cell[k], *b = t->x + 2 * t->cell[k % 3 < 2 ? k + 1 : k - 2];

      if (!CkScattered(mesh, k / 3, 0)) continue;
      for (PetscInt d = 0; d < 2; ++d) middle[2 * n + d] = 0.5 * (a[d] + b[d]);
      ++n;
    }
    Merge(mesh, 20., CkScattered);
    all = Corners(mesh);
    for (PetscInt k = 0; k < n; ++k)
      ck_assert_ptr_nonnull(bsearch(middle + 2 * k, all.x, (size_t)all.corners, 2 * sizeof(PetscReal), Ascending));
    CkOk(PetscFree(all.x));
    CkOk(PetscFree(middle));
  }
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

/* A journal of splits, merges and moves is written, and makes the same mesh again, to the bit, with the same memory of what may merge */
START_TEST(the_journal_knows_merges)
{
  const AbutTie tie     = {3, 1., 1.1};
  AbutMesh      mesh[2] = {CkBox(0., 0., 4., 1., 8, 2, shapes[_i]), CkBox(0., 0., 4., 1., 8, 2, shapes[_i])};
  AbutArchive   ar;

  for (PetscInt k = 0; k < 2; ++k) CkOk(AbutMeshKeepJournal(mesh[k]));
  CkRefine(mesh[0], CkScattered, 2);
  Merge(mesh[0], 3., NULL);
  CkOk(AbutMeshSetTies(mesh[0], 1, &tie));
  Merge(mesh[0], 2., CkScattered);
  CkOk(AbutArchiveCreate(PETSC_COMM_WORLD, &ar));
  CkOk(AbutMeshArchive(mesh[0], ar));
  CkOk(AbutArchiveWrite(ar, CkPath("archive")));
  CkOk(AbutArchiveDestroy(&ar));
  CkOk(AbutArchiveOpen(PETSC_COMM_WORLD, "restart", CkPath("archive"), &ar));
  CkOk(AbutMeshArchive(mesh[1], ar));
  CkOk(AbutArchiveDestroy(&ar));
  for (PetscInt i = 0; i < 3; ++i) {
    const AbutMeshTopology *a = CkTopology(mesh[0]), *b = CkTopology(mesh[1]);

    ck_assert_int_eq(a->ncells, b->ncells);
    for (PetscInt c = 0; c < a->corners * a->ncells; ++c) ck_assert_int_eq(a->cell[c], b->cell[c]);
    for (PetscInt v = 0; v < 2 * a->nvertices; ++v) ck_assert(a->x[v] == b->x[v]);
    for (PetscInt k = 0; k < 2; ++k) Merge(mesh[k], 5., i == 1 ? CkScattered : NULL);
  }
  for (PetscInt k = 0; k < 2; ++k) CkOk(AbutMeshDestroy(&mesh[k]));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("coarsen");
  TCase *tests = tcase_create("coarsen");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  tcase_add_loop_test(tests, marks_that_merge_nothing_change_nothing, 0, 2);
  tcase_add_checked_fixture(tests, CkFolderMake, CkFolderRemove);
  tcase_add_loop_test(tests, merging_is_the_inverse_of_splitting, 0, 2);
  tcase_add_loop_test(tests, what_is_marked_often_enough_is_the_first_mesh, 0, 2);
  tcase_add_loop_test(tests, nothing_else_changes, 0, 2);
  tcase_add_test(tests, only_whole_families_merge_and_the_mesh_stays_balanced);
  tcase_add_test(tests, a_merge_that_balance_takes_back_is_none);
  tcase_add_test(tests, a_cell_that_is_to_be_split_keeps_its_siblings);
  tcase_add_test(tests, a_triangle_that_is_to_be_split_is_split_and_the_others_go);
  tcase_add_loop_test(tests, the_first_mesh_keeps_its_size, 0, 2);
  tcase_add_loop_test(tests, what_was_merged_and_is_split_again_stays, 0, 2);
  tcase_add_loop_test(tests, splitting_and_merging_in_turn_ends, 0, 2);
  tcase_add_loop_test(tests, moved_meshes_merge_too, 0, 2);
  tcase_add_loop_test(tests, every_distribution_merges_the_same_cells, 0, 2);
  tcase_add_loop_test(tests, the_journal_knows_merges, 0, 2);
  tcase_add_test(tests, no_split_of_flat_triangles_is_lost);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
