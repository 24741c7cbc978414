/* ranks: 1 2 3 4 */
#include "ckmesh.h"

/* Counts, geometry, hanging vertices, numbering and sides of the meshes of both shapes */

/* The meshes on which what holds for every mesh is checked; coordinates are dyadic, so that they can be compared to the last bit */
enum {
  QUAD_GRID,
  QUAD_POINT,
  QUAD_SCATTERED,
  QUAD_ONE,
  QUAD_ONE_POINT,
  TRIANGLE_GRID,
  TRIANGLE_POINT,
  TRIANGLE_SCATTERED,
  TRIANGLE_ONE,
  TRIANGLE_ONE_POINT,
  NMESHES
};

static AbutMesh meshes[NMESHES];

static AbutShape Shape(int which)
{
  return which < TRIANGLE_GRID ? ABUT_QUAD : ABUT_TRIANGLE;
}

static AbutMesh Make(MPI_Comm comm, int which)
{
  const PetscBool one  = (PetscBool)(which == QUAD_ONE || which == QUAD_ONE_POINT || which == TRIANGLE_ONE || which == TRIANGLE_ONE_POINT);
  AbutMesh        mesh = CkBoxOn(comm, 0., 0., one ? 1. : 4., 1., one ? 1 : 8, one ? 1 : 2, Shape(which));

  if (which == QUAD_POINT || which == TRIANGLE_POINT || which == QUAD_ONE_POINT || which == TRIANGLE_ONE_POINT)
    CkRefine(mesh, CkTowardsPoint, 10);
  if (which == QUAD_SCATTERED || which == TRIANGLE_SCATTERED) CkRefine(mesh, CkScattered, 5);
  return mesh;
}

static void MakeAll(void)
{
  for (int i = 0; i < NMESHES; ++i) meshes[i] = Make(PETSC_COMM_WORLD, i);
}

static void DestroyAll(void)
{
  for (int i = 0; i < NMESHES; ++i) CkOk(AbutMeshDestroy(&meshes[i]));
}

static PetscReal Area(PetscInt corners, const PetscReal *x)
{
  PetscReal twice = 0.;

  for (PetscInt k = 0; k < corners; ++k) {
    const PetscReal *p = x + 2 * k, *q = x + 2 * ((k + 1) % corners);

    twice += p[0] * q[1] - p[1] * q[0];
  }
  return 0.5 * twice;
}

static PetscBool Same(const PetscReal p[2], const PetscReal q[2])
{
  return (PetscBool)(p[0] == q[0] && p[1] == q[1]);
}

/* How many cells have the side from p to q, counter-clockwise */
static PetscInt CountSides(const CkCells *all, const PetscReal p[2], const PetscReal q[2])
{
  PetscInt n = 0;

  for (PetscInt c = 0; c < all->n; ++c)
    for (PetscInt k = 0; k < all->corners; ++k)
      if (Same(all->x + 2 * (all->corners * c + k), p) && Same(all->x + 2 * (all->corners * c + (k + 1) % all->corners), q)) ++n;
  return n;
}

static PetscBool IsMiddle(const CkCells *all, const PetscReal x[2])
{
  for (PetscInt c = 0; c < all->n; ++c)
    for (PetscInt k = 0; k < all->corners; ++k) {
      const PetscReal *p = all->x + 2 * (all->corners * c + k), *q = all->x + 2 * (all->corners * c + (k + 1) % all->corners),
                      m[2] = {0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])};

      if (Same(m, x)) return PETSC_TRUE;
    }
  return PETSC_FALSE;
}

static PetscInt SideOf(const PetscReal p[2], const PetscReal q[2], const PetscReal upper[2])
{
  for (PetscInt s = 0; s < 4; ++s) {
    const PetscReal at = s % 2 ? upper[s / 2] : 0.;

    if (p[s / 2] == at && q[s / 2] == at) return s;
  }
  return -1;
}

START_TEST(the_first_mesh_has_the_counts_of_its_grid)
{
  AbutMesh mesh;
  PetscInt n;

  mesh = CkBox(-1., 2., 3., 5., 5, 3, (AbutShape)_i);
  CkOk(AbutMeshGetCellCount(mesh, &n));
  ck_assert_int_eq(n, _i == ABUT_QUAD ? 15 : 30);
  ck_assert_int_eq(CkTopology(mesh)->nglobal, 24);
  ck_assert_int_eq(CkSum(CkTopology(mesh)->nsideedges), 16);
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

START_TEST(refining_every_cell_quarters_it)
{
  AbutMesh                mesh = CkBox(0., 0., 4., 1., 8, 2, (AbutShape)_i);
  const AbutMeshTopology *t;
  PetscInt                n, generation;

  CkRefine(mesh, CkEverywhere, 2);
  CkOk(AbutMeshGetCellCount(mesh, &n));
  CkOk(AbutMeshGetGeneration(mesh, &generation));
  t = CkTopology(mesh);
  ck_assert_int_eq(generation, 2);
  ck_assert_int_eq(n, _i == ABUT_QUAD ? 256 : 512);
  ck_assert_int_eq(t->nglobal, 33 * 9);
  for (PetscInt c = 0; c < t->ncells; ++c) ck_assert_int_eq(t->level[c], 2);
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

START_TEST(cells_fill_the_box_and_turn_counter_clockwise)
{
  AbutMesh  mesh = meshes[_i];
  CkCells   all  = CkGather(mesh);
  PetscReal sum  = 0., lower[2], upper[2];

  for (PetscInt c = 0; c < all.n; ++c) {
    const PetscReal area = Area(all.corners, all.x + 2 * all.corners * c);

    ck_assert(area > 0.);
    sum += area;
  }
  CkOk(AbutMeshGetBox(mesh, lower, upper));
  ck_assert_double_eq_tol(sum, upper[0] * upper[1], 1e-14 * sum);
  CkOk(PetscFree(all.x));
}
END_TEST

START_TEST(a_cell_has_the_size_of_its_level)
{
  AbutMesh                mesh = meshes[_i];
  const AbutMeshTopology *t    = CkTopology(mesh);
  const PetscReal         h    = _i % 5 < 3 ? 0.5 : 1.;
  PetscInt                most = 0, highest;

  for (PetscInt c = 0; c < t->ncells; ++c) {
    const PetscReal first = h / (PetscReal)(1 << t->level[c]);
    PetscReal       x[8], area;

    for (PetscInt i = 0; i < 2 * t->corners; ++i) x[i] = t->x[2 * t->cell[t->corners * c + i / 2] + i % 2];
    area = Area(t->corners, x);
    most = PetscMax(most, t->level[c]);
    if (t->corners == 4)
      for (PetscInt k = 0; k < 4; ++k) {
        const PetscReal *p = x + 2 * k, *q = x + 2 * ((k + 1) % 4);

        ck_assert_double_eq(PetscAbsReal(p[0] - q[0]) + PetscAbsReal(p[1] - q[1]), first);
      }
    else
      ck_assert(area == 0.5 * first * first ||
                area == first * first); /* a level is two bisections; the first of them counts as the whole */
  }
  CkOk(MPI_Allreduce(&most, &highest, 1, MPIU_INT, MPI_MAX, PETSC_COMM_WORLD));
  if (_i == QUAD_POINT || _i == QUAD_ONE_POINT) ck_assert_int_eq(highest, 10);
}
END_TEST

START_TEST(across_a_side_levels_differ_by_at_most_one_and_triangles_conform)
{
  AbutMesh  mesh   = meshes[_i];
  CkCells   all    = CkGather(mesh);
  PetscInt  halves = 0;
  PetscReal lower[2], upper[2];

  CkOk(AbutMeshGetBox(mesh, lower, upper));
  for (PetscInt c = 0; c < all.n; ++c)
    for (PetscInt k = 0; k < all.corners; ++k) {
      const PetscReal *p = all.x + 2 * (all.corners * c + k), *q = all.x + 2 * (all.corners * c + (k + 1) % all.corners);
      const PetscReal  m[2] = {0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])}, beforep[2] = {2. * p[0] - q[0], 2. * p[1] - q[1]},
                      afterq[2] = {2. * q[0] - p[0], 2. * q[1] - p[1]};
      const PetscInt whole = CountSides(&all, q, p), split = CountSides(&all, q, m) + CountSides(&all, m, p),
                     half = CountSides(&all, afterq, p) + CountSides(&all, q, beforep);

      ck_assert_int_eq(CountSides(&all, p, q), 1);
      if (SideOf(p, q, upper) >= 0) ck_assert_int_eq(whole + split + half, 0);
      else if (all.corners == 3) ck_assert_int_eq(whole, 1);
      else ck_assert(whole ? whole == 1 && !split && !half : (split ? split == 2 && !half : half == 1));
      if (!whole && half) ++halves;
    }
  if (_i == QUAD_POINT || _i == QUAD_SCATTERED || _i == QUAD_ONE_POINT) ck_assert_int_gt(halves, 0);
  CkOk(PetscFree(all.x));
}
END_TEST

START_TEST(a_vertex_hangs_exactly_where_it_is_the_middle_of_a_side_and_its_anchors_do_not_hang)
{
  AbutMesh                mesh = meshes[_i];
  CkCells                 all  = CkGather(mesh);
  const AbutMeshTopology *t    = CkTopology(mesh);

  for (PetscInt i = 0; i < t->corners * t->ncells; ++i) {
    const PetscInt v = t->cell[i], *a = t->anchor + t->anchors[v];

    ck_assert_int_eq(t->unknown[v] < 0, IsMiddle(&all, t->x + 2 * v));
    ck_assert_int_eq(t->anchors[v + 1] - t->anchors[v], t->unknown[v] < 0 ? 2 : 0);
    if (t->unknown[v] >= 0) continue;
    ck_assert(a[0] < t->nvertices && a[1] >= 0 && a[1] < t->nvertices && a[0] != a[1]);
    for (PetscInt d = 0; d < 2; ++d) {
      ck_assert_double_eq(t->x[2 * v + d], 0.5 * (t->x[2 * a[0] + d] + t->x[2 * a[1] + d]));
      ck_assert_int_eq(t->anchors[a[d] + 1], t->anchors[a[d]]);
      ck_assert_int_ge(t->unknown[a[d]], 0);
    }
  }
  CkOk(PetscFree(all.x));
}
END_TEST

START_TEST(every_vertex_with_unknowns_has_one_number_and_one_owner)
{
  AbutMesh                mesh = meshes[_i];
  const AbutMeshTopology *t    = CkTopology(mesh);
  PetscReal              *x, *least, *most;
  PetscInt               *owners;

  ck_assert_int_eq(CkSum(t->nowned), t->nglobal);
  CkOk(PetscCalloc4(2 * t->nglobal, &x, 2 * t->nglobal, &least, 2 * t->nglobal, &most, t->nglobal, &owners));
  for (PetscInt i = 0; i < 2 * t->nglobal; ++i) {
    least[i] = PETSC_MAX_REAL;
    most[i]  = PETSC_MIN_REAL;
  }
  for (PetscInt v = 0; v < t->nvertices; ++v) {
    const PetscInt u = t->unknown[v];

    if (u < 0) continue;
    ck_assert_int_lt(u, t->nunknown);
    ck_assert(t->global[u] >= 0 && t->global[u] < t->nglobal);
    ck_assert_int_eq(u < t->nowned, t->global[u] >= t->firstowned && t->global[u] < t->firstowned + t->nowned);
    if (u < t->nowned) {
      ck_assert_int_eq(t->global[u], t->firstowned + u);
      ++owners[t->global[u]];
    }
    for (PetscInt d = 0; d < 2; ++d) least[2 * t->global[u] + d] = most[2 * t->global[u] + d] = t->x[2 * v + d];
  }
  CkOk(MPI_Allreduce(MPI_IN_PLACE, owners, (int)t->nglobal, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  CkOk(MPI_Allreduce(MPI_IN_PLACE, least, (int)(2 * t->nglobal), MPIU_REAL, MPIU_MIN, PETSC_COMM_WORLD));
  CkOk(MPI_Allreduce(MPI_IN_PLACE, most, (int)(2 * t->nglobal), MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  for (PetscInt i = 0; i < t->nglobal; ++i) {
    ck_assert_int_eq(owners[i], 1);
    ck_assert(Same(least + 2 * i, most + 2 * i));
    for (PetscInt j = 0; j < i; ++j) ck_assert(!Same(least + 2 * i, least + 2 * j));
  }
  CkOk(PetscFree4(x, least, most, owners));
}
END_TEST

START_TEST(element_sides_on_the_boundary_cover_each_side_once_with_the_body_on_the_left)
{
  AbutMesh                mesh      = meshes[_i];
  const AbutMeshTopology *t         = CkTopology(mesh);
  PetscReal               length[4] = {0., 0., 0., 0.}, lower[2], upper[2];
  PetscInt               *starts, *ends;

  CkOk(AbutMeshGetBox(mesh, lower, upper));
  CkOk(PetscCalloc2(t->nglobal, &starts, t->nglobal, &ends));
  for (PetscInt e = 0; e < t->nsideedges; ++e) {
    const PetscInt  *edge = t->sideedge + 3 * e, *cell = t->cell + t->corners * t->sidecell[e];
    const PetscReal *p = t->x + 2 * edge[0], *q = t->x + 2 * edge[1];
    PetscInt         of = 0;

    for (PetscInt k = 0; k < t->corners; ++k)
      if (cell[k] == edge[0] && cell[(k + 1) % t->corners] == edge[1])
        ++of; /* cells turn counter-clockwise: then the body is on the left */
    ck_assert_int_eq(of, 1);
    ck_assert_int_eq(edge[2], SideOf(p, q, upper));
    length[edge[2]] += PetscAbsReal(p[0] - q[0]) + PetscAbsReal(p[1] - q[1]);
    ++starts[t->global[t->unknown[edge[0]]]];
    ++ends[t->global[t->unknown[edge[1]]]];
  }
  CkOk(MPI_Allreduce(MPI_IN_PLACE, length, 4, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  CkOk(MPI_Allreduce(MPI_IN_PLACE, starts, (int)t->nglobal, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  CkOk(MPI_Allreduce(MPI_IN_PLACE, ends, (int)t->nglobal, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  for (PetscInt s = 0; s < 4; ++s) ck_assert_double_eq_tol(length[s], upper[1 - s / 2], 1e-14 * upper[1 - s / 2]);
  for (PetscInt i = 0; i < t->nglobal; ++i) {
    ck_assert_int_le(starts[i], 1);
    ck_assert_int_eq(starts[i], ends[i]);
  }
  CkOk(PetscFree2(starts, ends));
}
END_TEST

START_TEST(the_mesh_is_the_same_on_any_number_of_ranks)
{
  AbutMesh  mesh = meshes[_i], alone = Make(PETSC_COMM_SELF, _i);
  CkCells   all = CkGather(mesh), one = CkGather(alone);
  PetscReal sum[2] = {0., 0.};

  ck_assert_int_eq(all.n, one.n);
  ck_assert_int_eq(CkTopology(mesh)->nglobal, CkTopology(alone)->nglobal);
  for (PetscInt c = 0; c < all.n; ++c)
    for (PetscInt k = 0; k < 2; ++k) {
      const PetscReal *x    = (k ? one.x : all.x) + 2 * all.corners * c;
      PetscReal        m[2] = {0., 0.};

      for (PetscInt i = 0; i < 2 * all.corners; ++i) m[i % 2] += x[i] / all.corners;
      sum[k] += PetscSqr(PetscSinReal(5. * m[0] + 17. * m[1])) + m[0] * m[1];
    }
  ck_assert_double_eq_tol(sum[0], sum[1], 1e-12 * sum[1]);
  CkOk(PetscFree(all.x));
  CkOk(PetscFree(one.x));
  CkOk(AbutMeshDestroy(&alone));
}
END_TEST

START_TEST(the_same_mesh_made_twice_is_distributed_alike_and_evenly)
{
  AbutMesh                mesh = meshes[_i], again = Make(PETSC_COMM_WORLD, _i);
  const AbutMeshTopology *t = CkTopology(mesh), *r = CkTopology(again);
  const PetscInt          n = CkSum(t->ncells);
  PetscMPIInt             size;

  CkOk(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  ck_assert_int_eq(CkSum(t->ncells != r->ncells), 0);
  ck_assert(t->ncells >= n / size && t->ncells <= n / size + 1);
  for (PetscInt i = 0; i < t->corners * t->ncells; ++i) ck_assert(Same(t->x + 2 * t->cell[i], r->x + 2 * r->cell[i]));
  CkOk(AbutMeshDestroy(&again));
}
END_TEST

START_TEST(triangles_keep_their_angles)
{
  AbutMesh  mesh   = meshes[_i];
  CkCells   all    = CkGather(mesh);
  PetscReal cosine = 0.;

  for (PetscInt c = 0; c < all.n; ++c)
    for (PetscInt k = 0; k < 3; ++k) {
      const PetscReal *p = all.x + 6 * c + 2 * k, *q = all.x + 6 * c + 2 * ((k + 1) % 3), *r = all.x + 6 * c + 2 * ((k + 2) % 3);
      const PetscReal  a[2] = {q[0] - p[0], q[1] - p[1]}, b[2] = {r[0] - p[0], r[1] - p[1]};

      cosine = PetscMax(cosine, (a[0] * b[0] + a[1] * b[1]) / PetscSqrtReal((a[0] * a[0] + a[1] * a[1]) * (b[0] * b[0] + b[1] * b[1])));
    }
  ck_assert_double_eq_tol(cosine, PETSC_SQRT2 / 2., 1e-14); /* 45 degrees */
  CkOk(PetscFree(all.x));
}
END_TEST

START_TEST(a_mesh_with_fewer_cells_than_ranks_leaves_ranks_without_cells)
{
  AbutMesh    mesh = CkBox(0., 0., 1., 1., 1, 1, ABUT_QUAD);
  PetscMPIInt size, rank;

  CkOk(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  CkOk(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  ck_assert_int_eq(CkSum(CkTopology(mesh)->ncells), 1);
  ck_assert_int_eq(CkTopology(mesh)->nglobal, 4);
  if (size > 1 && !rank) ck_assert_int_eq(CkTopology(mesh)->ncells, 0); /* the first rank, which most forget */
  CkOk(AbutMeshDestroy(&mesh));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("mesh");
  TCase *tc    = tcase_create("all");
  int    failed;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  tcase_set_timeout(tc, 0);
  tcase_add_unchecked_fixture(tc, MakeAll, DestroyAll);
  tcase_add_loop_test(tc, the_first_mesh_has_the_counts_of_its_grid, 0, 2);
  tcase_add_loop_test(tc, refining_every_cell_quarters_it, 0, 2);
  tcase_add_loop_test(tc, cells_fill_the_box_and_turn_counter_clockwise, 0, NMESHES);
  tcase_add_loop_test(tc, a_cell_has_the_size_of_its_level, 0, NMESHES);
  tcase_add_loop_test(tc, across_a_side_levels_differ_by_at_most_one_and_triangles_conform, 0, NMESHES);
  tcase_add_loop_test(tc, a_vertex_hangs_exactly_where_it_is_the_middle_of_a_side_and_its_anchors_do_not_hang, 0, NMESHES);
  tcase_add_loop_test(tc, every_vertex_with_unknowns_has_one_number_and_one_owner, 0, NMESHES);
  tcase_add_loop_test(tc, element_sides_on_the_boundary_cover_each_side_once_with_the_body_on_the_left, 0, NMESHES);
  tcase_add_loop_test(tc, the_mesh_is_the_same_on_any_number_of_ranks, 0, NMESHES);
  tcase_add_loop_test(tc, the_same_mesh_made_twice_is_distributed_alike_and_evenly, 0, NMESHES);
  tcase_add_loop_test(tc, triangles_keep_their_angles, TRIANGLE_GRID, NMESHES);
  tcase_add_test(tc, a_mesh_with_fewer_cells_than_ranks_leaves_ranks_without_cells);
  suite_add_tcase(suite, tc);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
