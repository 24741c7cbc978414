/* ranks: 1 */
#include "ckbody.h"
#include <abutestimator.h>

/* Estimates against true errors of the stress, in the norm of eq. (27) of the paper, on five meshes: a smooth field, and the Hertz box,
   whose stress is like a root at the edge of the pressure, which is a vertex from cells of 1/2 on. Prints a table: the error, the
   effectivity (estimate over error), and Spearman's rank correlation of the cells' estimates with their errors. */

#define LEVELS 5

typedef struct {
  PetscReal value;
  PetscInt  cell;
} Entry;

static int Compare(const void *a, const void *b)
{
  const PetscReal x = ((const Entry *)a)->value, y = ((const Entry *)b)->value;

  return (x > y) - (x < y);
}

/* Ranks of n values; equal ones, to 6 digits, share the mean of theirs */
static void Rank(PetscInt n, const PetscReal value[], PetscReal rank[])
{
  Entry *entry;

  CkOk(PetscMalloc1(n, &entry));
  for (PetscInt i = 0; i < n; ++i) entry[i] = (Entry){value[i], i};
  qsort(entry, n, sizeof(*entry), Compare);
  for (PetscInt i = 0, j; i < n; i = j) {
    for (j = i + 1; j < n && entry[j].value <= entry[i].value * (1. + 1e-6); ++j);
    for (PetscInt k = i; k < j; ++k) rank[entry[k].cell] = 0.5 * (i + j - 1);
  }
  CkOk(PetscFree(entry));
}

static PetscReal Spearman(PetscInt n, const PetscReal a[], const PetscReal b[])
{
  PetscReal *r[2], sum[3] = {0., 0., 0.};

  CkOk(PetscMalloc2(n, &r[0], n, &r[1]));
  Rank(n, a, r[0]);
  Rank(n, b, r[1]);
  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal x = r[0][i] - 0.5 * (n - 1), y = r[1][i] - 0.5 * (n - 1);

    sum[0] += x * x;
    sum[1] += y * y;
    sum[2] += x * y;
  }
  CkOk(PetscFree2(r[0], r[1]));
  return sum[2] / PetscSqrtReal(sum[0] * sum[1]);
}

/* ||s - s_F||_e^2 of each cell; over the body, relative, as result */
static PetscReal StressErrors(AbutBody body, const CkField *field, PetscReal square[])
{
  const AbutMeshTopology *t      = CkTopology(CkMeshOf(body));
  PetscReal               sum[2] = {0., 0.}, z[CK_POINTS], w[CK_POINTS];

  CkOk(PetscDTGaussQuadrature(CK_POINTS, 0., 1., z, w));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    square[c] = 0.;
    for (PetscInt q = 0; q < CK_POINTS * CK_POINTS; ++q) {
      const PetscReal a = z[q / CK_POINTS], b = z[q % CK_POINTS];
      PetscReal       weight = w[q / CK_POINTS] * w[q % CK_POINTS], xi[2] = {2. * a - 1., 2. * b - 1.}, x[2], det, u[2], s[2][3];

      if (t->corners == 3) {
        xi[0] = a;
        xi[1] = b * (1. - a);
        weight *= 1. - a;
      } else weight *= 4.;
      CkOk(AbutBodyGetCellPoint(body, c, xi, x, &det));
      CkOk(AbutBodyGetCellStress(body, c, xi, s[0]));
      field->at(field, x, u, s[1]);
      for (PetscInt i = 0; i < 3; ++i) {
        square[c] += weight * det * (i == 2 ? 2. : 1.) * PetscSqr(s[0][i] - s[1][i]);
        sum[1] += weight * det * (i == 2 ? 2. : 1.) * PetscSqr(s[1][i]);
      }
    }
    sum[0] += square[c];
  }
  return PetscSqrtReal(sum[0] / sum[1]);
}

typedef struct {
  PetscReal error[LEVELS], effectivity[LEVELS], spearman[LEVELS];
} Table;

static AbutBody Make(CkField *field, AbutShape shape, PetscInt n)
{
  AbutBody body;

  if (field->at == CkHertz) {
    body = CkBodyOn(PETSC_COMM_WORLD, "body", field, 0., -2., 2., 0., 2 * n, 2 * n, shape);
    CkGiveAll(body, field, "u-", "uu", "uu", "tt");
  } else {
    body = CkBodyOn(PETSC_COMM_WORLD, "body", field, 0., 0., 2., 1., 2 * n, n, shape);
    CkGiveAll(body, field, "ut", "tt", "tu", "tt");
  }
  return body;
}

static Table Measure(const char type[], CkField field, AbutShape shape, PetscInt first)
{
  Table table;

  for (PetscInt level = 0; level < LEVELS; ++level) {
    AbutBody                body = Make(&field, shape, first << level);
    AbutEstimator           est;
    const AbutMeshTopology *t;
    PetscReal              *square, total, largest;
    const PetscReal        *e;
    Vec                     eta;

    CkOk(AbutBodySolve(body, NULL));
    t = CkTopology(CkMeshOf(body));
    CkOk(AbutEstimatorCreate(PETSC_COMM_WORLD, &est));
    CkOk(AbutEstimatorSetType(est, type));
    CkOk(AbutBodyCreateCellVec(body, &eta));
    CkOk(AbutEstimatorEstimate(est, body, eta));
    CkOk(AbutEstimatorGetNorms(body, eta, &total, &largest));
    CkOk(PetscMalloc1(t->ncells, &square));
    table.error[level]       = StressErrors(body, &field, square);
    table.effectivity[level] = total / table.error[level];
    CkOk(VecGetArrayRead(eta, &e));
    for (PetscInt c = 0; c < t->ncells; ++c) square[c] = PetscSqrtReal(square[c]);
    table.spearman[level] = Spearman(t->ncells, e, square); /* all cells have the same area */
    CkOk(VecRestoreArrayRead(eta, &e));
    CkOk(PetscFree(square));
    CkOk(VecDestroy(&eta));
    CkOk(AbutEstimatorDestroy(&est));
    CkOk(AbutBodyDestroy(&body));
  }
  printf("%-8s %-6s %-8s %d", type, field.at == CkHertz ? "hertz" : "smooth", shape ? "triangle" : "quad", (int)field.order);
  for (PetscInt k = 0; k < LEVELS; ++k)
    printf("  %.2e %.3f %.2f", (double)table.error[k], (double)table.effectivity[k], (double)table.spearman[k]);
  printf("\n");
  return table;
}

static const char *const types[] = {"fembem", "zz", "residual"};

/* The last three meshes count */
START_TEST(estimates_are_near_the_errors_and_rank_the_cells)
{
  const char *const type     = types[_i % 3];
  const PetscInt    order    = 1 + _i / 3;
  const PetscBool   residual = (PetscBool)!strcmp(type, "residual"); /* knows the error up to a factor */
  static PetscReal  rank[3], worst[2];                               /* of the Hertz box */
  char              what[96];

  for (int which = 0; which < 4; ++which) {
    const PetscBool edge  = (PetscBool)(which % 2);
    const AbutShape shape = (AbutShape)(which / 2);
    CkField         field = {.at = edge ? CkHertz : CkSmooth, .young = CK_YOUNG, .poisson = CK_POISSON, .order = order};
    const Table     table = Measure(type, field, shape, order == 1 ? (edge ? 2 : 4) : order == 2 && !edge ? 2 : 1);
    PetscReal       low = PETSC_MAX_REAL, high = 0.;

    for (PetscInt k = LEVELS - 3; k < LEVELS; ++k) {
      low  = PetscMin(low, table.effectivity[k]);
      high = PetscMax(high, table.effectivity[k]);
      ck_assert_double_ge(table.spearman[k], 0.8);
      if (edge) rank[_i % 3] = PetscMax(rank[_i % 3], 1. - table.spearman[k]);
      if (edge) worst[0] = PetscMax(worst[0], PetscMax(table.effectivity[k], 1. / table.effectivity[k]));
    }
    if (edge) worst[1] = PetscMax(worst[1], high / low);
    ck_assert_double_lt(high / low, 1.3);
    ck_assert_double_ge(low, residual ? 0.5 : 0.75);
    ck_assert_double_le(high, residual ? 2. : 1.15);
  }
  if (order < 3) return;
  CkOk(PetscSNPrintf(what, sizeof(what), "%s, order 1 to 3: 1 less the rank correlation with errors", type));
  CkCase("V16", what, rank[_i % 3], 0.2);
  if (_i < 8) return;
  CkCase("V16", "all three: estimate over error, or error over estimate", worst[0], 3.);
  CkCase("V16", "its largest value over the least, last three meshes", worst[1], 1.3);
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("effectivity");
  TCase *tc    = tcase_create("all");
  int    failed;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  tcase_set_timeout(tc, 0);
  tcase_add_loop_test(tc, estimates_are_near_the_errors_and_rank_the_cells, 0, 9);
  suite_add_tcase(suite, tc);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
