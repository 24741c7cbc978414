/* ranks: 1 2 3 4 */
#include "ckbody.h"
#include "ck_estimate.h"
#include <zz.h>

/* The patch recovery with cells of orders 1 to 4 (triangles: 3) against exact stresses, smooth ones and one with the edge of a contact */

#define POINTS 8 /* in each direction of a cell */

static PetscReal Distance2(const PetscReal s[3], const PetscReal r[3])
{
  return PetscSqr(s[0] - r[0]) + PetscSqr(s[1] - r[1]) + 2. * PetscSqr(s[2] - r[2]);
}

/* What all cells share */
typedef struct {
  PetscInt         n, nodes;
  PetscQuadrature  quadrature;
  const PetscReal *xi, *w;
  PetscReal       *N, *dN;
} Rule;

static Rule RuleCreate(AbutMesh mesh)
{
  Rule r = {.nodes = CkTopology(mesh)->nodes};

  CkOk(AbutMeshCreateQuadrature(mesh, POINTS, &r.quadrature));
  CkOk(PetscQuadratureGetData(r.quadrature, NULL, NULL, &r.n, &r.xi, &r.w));
  CkOk(PetscMalloc2(r.nodes * r.n, &r.N, 2 * r.nodes * r.n, &r.dN));
  for (PetscInt q = 0; q < r.n; ++q) CkOk(AbutMeshEvaluateBasis(mesh, r.xi + 2 * q, r.N + r.nodes * q, r.dN + 2 * r.nodes * q));
  return r;
}

static void RuleDestroy(Rule *r)
{
  CkOk(PetscFree2(r->N, r->dN));
  CkOk(PetscQuadratureDestroy(&r->quadrature));
}

/* Integrals over cell c of the squares of s_F - s*, s_rec - s*, s_rec - s_F, s*, and of 1 */
static void IntegrateCell(AbutBody body, const CkField *field, const Rule *r, PetscInt c, const PetscReal rec[], PetscReal integral[5])
{
  const PetscReal zero[3] = {0., 0., 0.};
  PetscReal       s[3 * POINTS * POINTS];

  CkOk(AbutBodyGetCellStresses(body, c, r->n, r->xi, r->dN, s));
  CkOk(PetscArrayzero(integral, 5));
  for (PetscInt q = 0; q < r->n; ++q) {
    PetscReal x[2], det, u[2], ex[3], at[3] = {0., 0., 0.};

    CkOk(AbutBodyGetCellPoint(body, c, r->xi + 2 * q, x, &det));
    field->at(field, x, u, ex);
    for (PetscInt k = 0; k < 3 * r->nodes; ++k) at[k % 3] += r->N[r->nodes * q + k / 3] * rec[k];
    integral[0] += r->w[q] * det * Distance2(s + 3 * q, ex);
    integral[1] += r->w[q] * det * Distance2(at, ex);
    integral[2] += r->w[q] * det * Distance2(at, s + 3 * q);
    integral[3] += r->w[q] * det * Distance2(ex, zero);
    integral[4] += r->w[q] * det;
  }
}

/* Spearman's rank correlation */
static PetscReal RankCorrelation(PetscInt n, const PetscReal a[], const PetscReal b[])
{
  PetscReal sum = 0., *key;
  PetscInt *by, *rank;

  CkOk(PetscMalloc3(n, &key, n, &by, 2 * n, &rank));
  for (PetscInt k = 0; k < 2; ++k) {
    for (PetscInt i = 0; i < n; ++i) {
      key[i] = (k ? b : a)[i];
      by[i]  = i;
    }
    CkOk(PetscSortRealWithArrayInt(n, key, by));
    for (PetscInt i = 0; i < n; ++i) rank[n * k + by[i]] = i;
  }
  for (PetscInt i = 0; i < n; ++i) sum += PetscSqr((PetscReal)(rank[i] - rank[n + i]));
  CkOk(PetscFree3(key, by, rank));
  return 1. - 6. * sum / (n * (PetscSqr((PetscReal)n) - 1.));
}

typedef struct {
  PetscReal error, C, effectivity, ranking; /* relative error of the finite elements; eq. (23) of the paper; of local errors */
} Quality;

/* Of a solved body that is on this rank only */
static Quality Measure(AbutBody body, const CkField *field)
{
  AbutMesh                mesh   = CkMeshOf(body);
  const AbutMeshTopology *t      = CkTopology(mesh);
  Rule                    r      = RuleCreate(mesh);
  PetscReal               sum[4] = {0., 0., 0., 0.}, *rec, *local;
  Quality                 q;

  CkOk(PetscMalloc2(3 * t->nodes * t->ncells, &rec, 2 * t->ncells, &local));
  CkOk(AbutEstimatorRecover_ZZ(body, rec));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    PetscReal integral[5];

    IntegrateCell(body, field, &r, c, rec + 3 * t->nodes * c, integral);
    for (PetscInt i = 0; i < 4; ++i) sum[i] += integral[i];
    local[c]             = integral[0] / integral[4];
    local[t->ncells + c] = integral[2] / integral[4];
  }
  q.error       = PetscSqrtReal(sum[0] / sum[3]);
  q.C           = PetscSqrtReal(sum[1] / sum[0]);
  q.effectivity = PetscSqrtReal(sum[2] / sum[0]);
  q.ranking     = RankCorrelation(t->ncells, local, local + t->ncells);
  CkOk(PetscFree2(rec, local));
  RuleDestroy(&r);
  return q;
}

/* Quads of orders 1 to 4, then triangles of orders 1 to 3 */
static AbutShape Shape(PetscInt i)
{
  return i < 4 ? ABUT_QUAD : ABUT_TRIANGLE;
}

static PetscInt Order(PetscInt i)
{
  return i < 4 ? i + 1 : i - 3;
}

static AbutBody SmoothBox(MPI_Comm comm, CkField *field, PetscInt i, PetscInt n)
{
  AbutBody body;

  *field = (CkField){.at = CkSmooth, .order = Order(i)};
  body   = CkBodyOn(comm, "body", field, 0., 0., 2., 1., 2 * n, n, Shape(i));
  CkGiveAll(body, field, "ut", "tt", "tu", "tt");
  return body;
}

/* The edge of the contact, x = 1/2, is at cell lines if width is 2 and n a multiple of 4 */
static AbutBody HertzBox(MPI_Comm comm, CkField *field, PetscInt i, PetscReal width, PetscInt n)
{
  AbutBody body;

  *field = (CkField){.at = CkHertz, .order = Order(i)};
  body   = CkBodyOn(comm, "body", field, 0., -2., width, 0., n, n, Shape(i));
  CkGiveAll(body, field, "u-", "uu", "uu", "tt");
  return body;
}

static PetscBool AtTheEdgeOfContact(AbutMesh mesh, PetscInt c, PetscInt i)
{
  PetscReal x[2];

  CkCenter(CkTopology(mesh), c, x);
  return (PetscBool)(PetscSqr(x[0] - 0.5) + PetscSqr(x[1]) < PetscSqr(0.75 * PetscPowReal(0.5, i)));
}

static Quality Level(AbutBody body, const CkField *field, const char scene[], PetscInt i)
{
  Quality q;

  CkOk(AbutBodySolve(body, NULL));
  q = Measure(body, field);
  CkOk(PetscPrintf(PETSC_COMM_WORLD, "%s %c%d, %d cells: error %.3e, C %.3f, effectivity %.3f, ranking %.3f\n", scene, i < 4 ? 'Q' : 'P',
                   (int)Order(i), (int)CkTopology(CkMeshOf(body))->ncells, (double)q.error, (double)q.C, (double)q.effectivity,
                   (double)q.ranking));
  return q;
}

static void CheckRange(PetscReal value, PetscReal low, PetscReal high)
{
  ck_assert_double_ge(value, low);
  ck_assert_double_le(value, high);
}

START_TEST(a_smooth_stress_is_judged_as_it_is)
{
  CkField   field;
  AbutBody  body = SmoothBox(PETSC_COMM_SELF, &field, _i, Order(_i) > 2 ? 2 : 4);
  PetscReal C    = 1.;

  for (PetscInt level = 0; level < 4; ++level) {
    Quality q;

    if (level) CkRefine(CkMeshOf(body), CkEverywhere, 1);
    q = Level(body, &field, "smooth", _i);
    if (!level) continue;
    CheckRange(q.effectivity, 0.95, 1.05);
    ck_assert_double_gt(q.ranking, 0.9);
    ck_assert_double_lt(q.C, Order(_i) == 1 ? 0.25 : Shape(_i) == ABUT_TRIANGLE ? 0.15 : 0.08);
    ck_assert_double_lt(q.C, 0.9 * C); /* it converges faster than the finite elements */
    C = q.C;
  }
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(hanging_nodes_are_judged_as_well)
{
  CkField  field;
  AbutBody body = SmoothBox(PETSC_COMM_SELF, &field, _i, 2);

  CkRefine(CkMeshOf(body), CkTowardsPoint, 2);
  for (PetscInt level = 0; level < 3; ++level) {
    Quality q;

    if (level) CkRefine(CkMeshOf(body), CkEverywhere, 1);
    q = Level(body, &field, "hanging", _i);
    if (!level) continue;
    CheckRange(q.effectivity, 0.9, 1.05);
    ck_assert_double_gt(q.ranking, 0.9);
    ck_assert_double_lt(q.C, Order(_i) == 1 ? 0.45 : 0.3);
  }
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* Where the stress is not smooth the recovered one is no better than that of the finite elements; its distance from it still tells the
   error */
START_TEST(the_edge_of_a_contact_is_judged_fairly_on_uniform_meshes)
{
  CkField  field;
  AbutBody body = HertzBox(PETSC_COMM_SELF, &field, _i, 2., 8);

  for (PetscInt level = 0; level < 3; ++level) {
    Quality q;

    if (level) CkRefine(CkMeshOf(body), CkEverywhere, 1);
    q = Level(body, &field, "Hertz", _i);
    if (!level) continue;
    CheckRange(q.effectivity, 0.85, 1.1);
    ck_assert_double_gt(q.ranking, 0.95);
  }
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(the_edge_of_a_contact_is_judged_fairly_on_adapted_meshes)
{
  CkField  field;
  AbutBody body = HertzBox(PETSC_COMM_SELF, &field, _i, 2., 6);

  for (PetscInt level = 0; level < 5; ++level) {
    Quality q;

    if (level) {
      const AbutMeshTopology *t = CkTopology(CkMeshOf(body));
      PetscBool              *marks;

      CkOk(PetscMalloc1(t->ncells, &marks));
      for (PetscInt c = 0; c < t->ncells; ++c) marks[c] = AtTheEdgeOfContact(CkMeshOf(body), c, level - 1);
      CkOk(AbutMeshAdapt(CkMeshOf(body), marks));
      CkOk(PetscFree(marks));
    }
    q = Level(body, &field, "Hertz, adapted", _i);
    if (level < 2) continue;
    CheckRange(q.effectivity, 0.85, 1.1);
    ck_assert_double_gt(q.ranking, 0.8);
  }
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* u1 + i u2 of Kolosov and Muskhelishvili with phi = z^2, psi = 0, of degree 2: cells of order 2 and more hold it, its stress is linear */
static void Bending(const CkField *field, const PetscReal x[2], PetscReal u[2], PetscReal s[3])
{
  const double complex z = x[0] + I * x[1],
                       w = ((3. - 4. * field->poisson) * z * z - 2. * z * conj(z)) * (1. + field->poisson) / field->young;
  const double complex d = 4. * conj(z);

  u[0] = creal(w);
  u[1] = cimag(w);
  s[0] = 4. * creal(z) - 0.5 * creal(d);
  s[1] = 4. * creal(z) + 0.5 * creal(d);
  s[2] = 0.5 * cimag(d);
}

START_TEST(what_the_cells_hold_has_no_error)
{
  CkField   field = {.at = Bending, .order = Order(_i)};
  AbutBody  body  = CkBodyOn(PETSC_COMM_WORLD, "body", &field, 0., 0., 2., 1., 6, 3, Shape(_i));
  PetscReal total, largest;

  if (Order(_i) > 1) {
    CkGiveAll(body, &field, "ut", "tt", "tu", "tt");
    CkRefine(CkMeshOf(body), CkTowardsPoint, 3);
    CkOk(AbutBodySolve(body, NULL));
    ck_assert_double_lt(CkStressError(body, &field), 1e-8);
    CkEstimate(body, ABUTESTIMATORZZ, &total, &largest);
    ck_assert_double_lt(largest, 1e-7);
  }
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(all_numbers_of_ranks_give_the_same_estimate)
{
  for (PetscInt scene = 0; scene < 2; ++scene) {
    PetscReal total[2], largest[2];

    for (PetscInt alone = 0; alone < 2; ++alone) {
      const MPI_Comm comm = alone ? PETSC_COMM_SELF : PETSC_COMM_WORLD;
      CkField        field;
      AbutBody       body = scene ? HertzBox(comm, &field, _i, 2.1, 6) : SmoothBox(comm, &field, _i, 4);

      CkRefine(CkMeshOf(body), scene ? AtTheEdgeOfContact : CkTowardsPoint, 3);
      CkOk(AbutBodySolve(body, NULL));
      CkEstimate(body, ABUTESTIMATORZZ, &total[alone], &largest[alone]);
      CkOk(AbutBodyDestroy(&body));
    }
    ck_assert_double_eq_tol(total[0], total[1], 1e-6 * total[1]);
    ck_assert_double_eq_tol(largest[0], largest[1], 1e-6 * largest[1]);
  }
}
END_TEST

START_TEST(a_body_without_inner_vertices_has_an_estimate)
{
  for (PetscInt nx = 1; nx <= 8; nx += 7) {
    CkField   field = {.at = CkSmooth, .order = Order(_i)};
    AbutBody  body  = CkBodyOn(PETSC_COMM_WORLD, "body", &field, 0., 0., 2., 1., nx, 1, Shape(_i));
    PetscReal total = -1., largest = -1.;

    CkGiveAll(body, &field, "ut", "tt", "tu", "tt");
    CkOk(AbutBodySolve(body, NULL));
    CkEstimate(body, ABUTESTIMATORZZ, &total, &largest);
    ck_assert(!PetscIsInfOrNanReal(total) && total >= 0.);
    CkOk(AbutBodyDestroy(&body));
  }
}
END_TEST

/* One row of square cells, all of their vertices on the boundary */
START_TEST(a_row_of_cells_is_judged_as_well)
{
  for (PetscInt n = 16; n <= 64; n *= 2) {
    CkField  field = {.at = CkSmooth, .order = Order(_i)};
    AbutBody body  = CkBodyOn(PETSC_COMM_SELF, "body", &field, 0., 0., 2., 2. / n, n, 1, Shape(_i));
    Quality  q;

    CkGiveAll(body, &field, "ut", "tt", "tu", "tt");
    q = Level(body, &field, "row", _i);
    CheckRange(q.effectivity, Order(_i) == 1 ? 0.75 : 0.95, Order(_i) == 1 ? 1.15 : 1.05);
    CkOk(AbutBodyDestroy(&body));
  }
}
END_TEST

int main(int argc, char **argv)
{
  Suite      *suite = suite_create("zz_orders");
  TCase      *tests = tcase_create("recovery");
  int         failed;
  PetscMPIInt ranks;

  if (AbutInitialize(&argc, &argv, NULL) || MPI_Comm_size(PETSC_COMM_WORLD, &ranks)) return EXIT_FAILURE;
  tcase_set_timeout(tests, 0);
  if (ranks == 1) {
    tcase_add_loop_test(tests, a_smooth_stress_is_judged_as_it_is, 0, 7);
    tcase_add_loop_test(tests, hanging_nodes_are_judged_as_well, 0, 7);
    tcase_add_loop_test(tests, the_edge_of_a_contact_is_judged_fairly_on_uniform_meshes, 0, 7);
    tcase_add_loop_test(tests, the_edge_of_a_contact_is_judged_fairly_on_adapted_meshes, 0, 7);
    tcase_add_loop_test(tests, a_row_of_cells_is_judged_as_well, 0, 7);
  }
  tcase_add_loop_test(tests, what_the_cells_hold_has_no_error, 0, 7);
  tcase_add_loop_test(tests, all_numbers_of_ranks_give_the_same_estimate, 0, 7);
  tcase_add_loop_test(tests, a_body_without_inner_vertices_has_an_estimate, 0, 7);
  suite_add_tcase(suite, tests);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
