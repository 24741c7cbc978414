#include "fembem_bodies.h"
#include "ck_box.h"
#include <abutestimator.h>
#include "far.h"

/* The boundary elements' operator between elements that are far from each other, and systems too large to be dense */

PETSC_EXTERN PetscErrorCode PetscDLLibraryRegister_estimator_fembem(void);

static const PetscReal lo[2] = {0., 0.}, hi[2] = {2., 1.};
static const PetscInt  sides[4] = {60, 25, 45, 30};

/* A box with a hole */
static void CreateBoundary(MPI_Comm comm, PetscInt order, const char text[16], const PetscInt m[4], AbutBoundary *given, FembemBoundary *b)
{
  const Field       field = {2.1e5, .3, PolynomialStress, PolynomialDisplacement};
  AbutConditionType condition[16];

  polynomial_degree = PetscMin(order, 2);
  BoundaryConditions(text, condition);
  CkOk(BoundaryCreateBox(lo, hi, m, PETSC_TRUE, order, given));
  BoundaryFill(&field, condition, given);
  CkOk(FembemBoundaryCreate(comm, given, field.young, field.poisson, b));
}

/* One outer and one inner element, by FembemPair() */
static void AddPair(const FembemSystem *s, PetscInt i, PetscInt j, const PetscReal t[], const PetscReal u[], PetscReal onT[],
                    PetscReal onU[])
{
  const FembemWanted all = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE};
  FembemBlocks       block;

  CkOk(FembemPair(&s->pairing, &s->e[i], &s->e[j], PETSC_FALSE, all, &block));
  for (PetscInt k = 0; k < s->rows * s->rows; ++k) {
    const PetscInt r = k / s->rows, c = k % s->rows, ti = s->rows * i + r, tj = s->rows * j + c;
    const PetscInt ui = 2 * AbutBoundaryNode(s->b, i, r / 2) + r % 2, uj = 2 * AbutBoundaryNode(s->b, j, c / 2) + c % 2;

    onT[ti] += block.V[k] * t[tj] + block.W[k] * u[uj];
    onU[uj] += block.W[k] * t[ti];
    onU[ui] -= block.D[k] * u[uj];
  }
}

/* Of order 1 the pairs' own quadrature is good to 1e-5 */
START_TEST(clusters_do_to_each_other_what_their_elements_do)
{
  AbutBoundary          given;
  FembemBoundary        b;
  FembemSystem          s;
  FembemFar             far;
  const FembemClusters *tree;
  const PetscInt       *near[2];
  PetscCount            nnear;
  PetscInt              nt, nu, pairs = 0;
  PetscReal            *t, *u, *onT, *onU, *exactT, *exactU;
  PetscBool            *isnear;
  PetscRandom           random;

  CreateBoundary(PETSC_COMM_WORLD, _i, "tuttttututtttttt", sides, &given, &b);
  CkOk(FembemSystemCreate(&b, FembemSystemScale(&b), &s));
  nt = s.rows * b.n;
  nu = 2 * b.nnodes;
  CkOk(PetscCalloc7(nt, &t, nu, &u, nt, &onT, nu, &onU, nt, &exactT, nu, &exactU, b.n * b.n, &isnear));
  CkOk(PetscRandomCreate(PETSC_COMM_SELF, &random));
  for (PetscInt i = 0; i < nt; ++i) CkOk(PetscRandomGetValueReal(random, &t[i]));
  for (PetscInt i = 0; i < nu; ++i) CkOk(PetscRandomGetValueReal(random, &u[i]));
  CkOk(PetscRandomDestroy(&random));
  CkOk(FembemFarCreate(&s, 1e-9, &far));
  FembemFarGetClusters(far, &tree, &nnear, near);
  for (PetscCount k = 0; k < nnear; ++k)
    for (PetscInt i = tree->cluster[near[0][k]].first; i < tree->cluster[near[0][k]].end; ++i)
      for (PetscInt j = tree->cluster[near[1][k]].first; j < tree->cluster[near[1][k]].end; ++j)
        isnear[b.n * i + j] = isnear[b.n * j + i] = PETSC_TRUE;
  for (PetscInt i = 0; i < b.n; ++i)
    for (PetscInt j = 0; j < b.n; ++j)
      if (!isnear[b.n * i + j]) {
        AddPair(&s, i, j, t, u, exactT, exactU);
        ++pairs;
      }
  CkOk(FembemFarAdd(far, t, u, onT, onU));
  CkOk(FembemDenseSum(PETSC_COMM_WORLD, nt, onT));
  CkOk(FembemDenseSum(PETSC_COMM_WORLD, nu, onU));
  CkOk(PetscPrintf(PETSC_COMM_WORLD,
                   "order %d: %" PetscInt_FMT " of %" PetscInt_FMT " pairs are far, error on tractions %.1e, on displacements %.1e\n", _i,
                   pairs, b.n * b.n, (double)BoundaryDifference(nt, onT, exactT), (double)BoundaryDifference(nu, onU, exactU)));
  ck_assert_double_lt(BoundaryDifference(nt, onT, exactT), _i > 1 ? 1e-8 : 1e-5);
  ck_assert_double_lt(BoundaryDifference(nu, onU, exactU), _i > 1 ? 1e-8 : 1e-5);
  CkOk(FembemFarDestroy(&far));
  CkOk(PetscFree7(t, u, onT, onU, exactT, exactU, isnear));
  CkOk(FembemSystemDestroy(&s));
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(BoundaryFree(&given));
}
END_TEST

/* The stress at points inside after a solve, and what the solve cost */
#define POINTS 5
static void Solve(MPI_Comm comm, PetscInt order, const char text[16], const PetscInt m[4], FembemSolver solver, PetscReal s[3 * POINTS],
                  FembemCost *cost)
{
  const PetscReal x[2 * POINTS] = {.2, .2, 1.7, .8, .3, .5, 1.1, .15, 1.95, .03};
  AbutBoundary    given;
  FembemBoundary  b;
  FembemStress    stress;

  CreateBoundary(comm, order, text, m, &given, &b);
  CkOk(FembemRecoverTractions(&b));
  CkOk(FembemSolveGalerkin(&b, solver, cost));
  FembemTakeOffRigidMotion(&b);
  CkOk(FembemStressCreate(&b, 0., &stress));
  CkOk(FembemStressEvaluate(stress, POINTS, x, s));
  CkOk(FembemStressDestroy(&stress));
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(BoundaryFree(&given));
}

static const char *const supports[] = {"uuuuuuuutttttttt", "tuttttuttttttttt", "uuttttutuuuuuuuu", "tttttttttttttttt",
                                       "tutttttttutttttt", "tuttccuttttttttt", "tttttttttuttttut"};

/* Rigid motions that nothing holds, holes with and without support. Of order 1 the dense system's quadrature is good to 1e-5 */
START_TEST(iterations_and_the_dense_system_agree_under_all_supports)
{
  const FembemSolver iterated = {.dense = 0, .tolerance = 1e-9};
  PetscReal          dense[3 * POINTS], s[3 * POINTS];
  FembemCost         cost;

  for (PetscInt order = 1; order <= ABUT_ORDER_MAX; order += 2) {
    Solve(PETSC_COMM_WORLD, order, supports[_i], sides, dense_solver, dense, &cost);
    ck_assert_int_eq(cost.iterations, 0);
    if (_i == 3) ck_assert_int_eq(cost.numbers, cost.unknowns * cost.unknowns); /* displacements alone */
    Solve(PETSC_COMM_WORLD, order, supports[_i], sides, iterated, s, &cost);
    CkOk(PetscPrintf(PETSC_COMM_WORLD,
                     "order %" PetscInt_FMT ", %.16s: %" PetscInt_FMT " unknowns, %" PetscInt_FMT " iterations, difference %.1e\n", order,
                     supports[_i], cost.unknowns, cost.iterations, (double)BoundaryDifference(3 * POINTS, s, dense)));
    ck_assert_double_lt(BoundaryDifference(3 * POINTS, s, dense), order > 1 ? 1e-7 : 1e-5);
    ck_assert_int_gt(cost.iterations, 0);
    ck_assert_int_lt(cost.iterations, 60);
  }
}
END_TEST

/* _i: dense, iterated. What the ranks do together is what one does alone, and none does more than its part */
START_TEST(ranks_share_the_pairs_of_elements)
{
  const FembemSolver solver = {.dense = _i ? 0 : PETSC_MAX_INT, .tolerance = 1e-12};
  PetscReal          alone[3 * POINTS], together[3 * POINTS];
  FembemCost         one, cost;
  PetscInt           sum, most;
  PetscMPIInt        size;

  CkOk(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  Solve(PETSC_COMM_SELF, 1, supports[2], sides, solver, alone, &one);
  Solve(PETSC_COMM_WORLD, 1, supports[2], sides, solver, together, &cost);
  CkOk(MPI_Allreduce(&cost.pairs, &sum, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  CkOk(MPI_Allreduce(&cost.pairs, &most, 1, MPIU_INT, MPI_MAX, PETSC_COMM_WORLD));
  CkOk(PetscPrintf(PETSC_COMM_WORLD, "%s: %" PetscInt_FMT " pairs, at most %" PetscInt_FMT " on a rank, difference %.1e\n",
                   _i ? "iterated" : "dense", sum, most, (double)BoundaryDifference(3 * POINTS, together, alone)));
  ck_assert_double_lt(BoundaryDifference(3 * POINTS, together, alone), 1e-10);
  ck_assert_int_eq(cost.iterations, one.iterations);
  ck_assert_int_eq(sum, one.pairs);
  if (!_i) ck_assert_int_eq(sum, 320 * 321 / 2);
  ck_assert_double_le((PetscReal)most * size / sum, 1.15);
}
END_TEST

/* The residual of the system over its right-hand side, all pairs one by one */
static PetscReal Residual(const FembemBoundary *b)
{
  FembemSystem s;
  PetscReal    sum[2] = {0., 0.};

  CkOk(FembemSystemCreate(b, FembemSystemScale(b), &s));
  CkOk(PetscCalloc3(s.nt * s.nt, &s.V, s.nt * s.nu, &s.W, s.nu * s.nu, &s.D));
  for (PetscInt i = 0; i < b->n; ++i)
    for (PetscInt j = i; j < b->n; ++j) CkOk(FembemSystemAddPair(&s, i, j));
  FembemSystemAddMass(&s);
  for (PetscInt k = 0; k < s.nt + s.nu; ++k) sum[0] += PetscSqr(s.rhs[k]);
  for (PetscInt j = 0; j < s.rows * b->n; ++j) {
    const PetscInt c = s.tindex[j];

    for (PetscInt r = 0; c >= 0 && r < s.nt; ++r) s.f[r] -= s.V[r + s.nt * c] * s.t[j];
    for (PetscInt r = 0; c >= 0 && r < s.nu; ++r) s.g[r] -= s.W[c + s.nt * r] * s.t[j];
  }
  for (PetscInt j = 0; j < 2 * b->nnodes; ++j) {
    const PetscInt c = s.uindex[j];

    for (PetscInt r = 0; c >= 0 && r < s.nt; ++r) s.f[r] -= s.W[r + s.nt * c] * s.u[j];
    for (PetscInt r = 0; c >= 0 && r < s.nu; ++r) s.g[r] += s.D[r + s.nu * c] * s.u[j];
  }
  for (PetscInt k = 0; k < s.nt + s.nu; ++k) sum[1] += PetscSqr(s.rhs[k]);
  CkOk(FembemSystemDestroy(&s));
  return PetscSqrtReal(sum[1] / sum[0]);
}

/* Half as much more for what distant elements do to each other */
START_TEST(the_tolerance_is_that_of_the_residual)
{
  const FembemSolver solver = {.dense = 0, .tolerance = 1e-4};
  const PetscInt     m[4]   = {30, 12, 22, 15};
  AbutBoundary       given;
  FembemBoundary     b;
  FembemCost         cost;
  PetscReal          residual;

  CreateBoundary(PETSC_COMM_WORLD, 2, supports[_i], m, &given, &b);
  CkOk(FembemRecoverTractions(&b));
  CkOk(FembemSolveGalerkin(&b, solver, &cost));
  residual = Residual(&b);
  CkOk(PetscPrintf(PETSC_COMM_WORLD, "%.16s: residual %.2e after %" PetscInt_FMT " iterations to %.0e\n", supports[_i], (double)residual,
                   cost.iterations, (double)solver.tolerance));
  ck_assert_double_le(residual, 1.5 * solver.tolerance);
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(BoundaryFree(&given));
}
END_TEST

/* As on mixed processors: a material that differs in its last digits, with motions that nothing holds. When to stop is decided once */
START_TEST(ranks_that_compute_unlike_have_one_solution)
{
  const FembemSolver solver = {.dense = 0, .tolerance = 1e-9};
  AbutBoundary       given;
  FembemBoundary     b;
  FembemCost         cost;
  PetscMPIInt        rank;
  PetscComplex      *u, *t;
  PetscInt           its;

  CkOk(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  CreateBoundary(PETSC_COMM_WORLD, 1, supports[3], sides, &given, &b);
  b.mat.kappa *= 1. + 1e-9 * rank;
  CkOk(FembemSolveGalerkin(&b, solver, &cost));
  CkOk(PetscMalloc2(b.nnodes, &u, 2 * b.n, &t));
  CkOk(PetscArraycpy(u, b.u, b.nnodes));
  CkOk(PetscArraycpy(t, b.t, 2 * b.n));
  its = cost.iterations;
  CkOk(MPI_Bcast(u, b.nnodes, MPIU_COMPLEX, 0, PETSC_COMM_WORLD));
  CkOk(MPI_Bcast(t, 2 * b.n, MPIU_COMPLEX, 0, PETSC_COMM_WORLD));
  CkOk(MPI_Bcast(&its, 1, MPIU_INT, 0, PETSC_COMM_WORLD));
  ck_assert_int_eq(cost.iterations, its);
  for (PetscInt i = 0; i < b.nnodes; ++i) ck_assert(u[i] == b.u[i]);
  for (PetscInt i = 0; i < 2 * b.n; ++i) ck_assert(t[i] == b.t[i]);
  CkOk(PetscFree2(u, t));
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(BoundaryFree(&given));
}
END_TEST

/* A dense system of twice the unknowns is four times as large */
START_TEST(what_iterations_hold_grows_with_the_boundary)
{
  const FembemSolver iterated = {.dense = 0, .tolerance = 1e-6};
  PetscReal          s[3 * POINTS];
  FembemCost         cost[3];

  for (PetscInt k = 0; k < 3; ++k) {
    const PetscInt m[4] = {160 << k, 80 << k, 160 << k, 80 << k};

    Solve(PETSC_COMM_WORLD, 1, supports[1], m, iterated, s, &cost[k]);
    CkOk(PetscPrintf(PETSC_COMM_WORLD, "%" PetscInt_FMT " unknowns: %" PetscInt_FMT " pairs, %zu numbers, %" PetscInt_FMT " iterations\n",
                     cost[k].unknowns, cost[k].pairs, cost[k].numbers, cost[k].iterations));
  }
  for (PetscInt k = 1; k < 3; ++k) {
    ck_assert_double_lt((PetscReal)cost[k].numbers / cost[k - 1].numbers, 2.1);
    ck_assert_double_lt((PetscReal)cost[k].pairs / cost[k - 1].pairs, 2.2);
  }
  ck_assert_double_lt((PetscReal)cost[2].numbers, 0.25 * cost[2].unknowns * cost[2].unknowns);
}
END_TEST

static Vec Estimate(AbutBody body, const char dense[], const char tolerance[])
{
  AbutEstimator est;
  Vec           eta;

  CkOk(PetscOptionsSetValue(NULL, "-estimator_fembem_solve", "galerkin"));
  CkOk(PetscOptionsSetValue(NULL, "-estimator_fembem_dense_unknowns", dense));
  CkOk(PetscOptionsSetValue(NULL, "-estimator_fembem_solve_tolerance", tolerance));
  CkOk(AbutBodyCreateCellVec(body, &eta));
  CkOk(AbutEstimatorCreate(PETSC_COMM_WORLD, &est));
  CkOk(AbutEstimatorSetType(est, ABUTESTIMATORFEMBEM));
  CkOk(AbutEstimatorSetFromOptions(est));
  CkOk(AbutEstimatorEstimate(est, body, eta));
  CkOk(AbutEstimatorDestroy(&est));
  return eta;
}

/* The largest relative change among the indicators that are at least a part of the largest */
static PetscReal LargestChange(Vec from, Vec to, PetscReal part)
{
  const PetscReal *a, *b;
  PetscReal        worst = 0., largest;
  PetscInt         n;

  CkOk(VecMax(from, NULL, &largest));
  CkOk(VecGetLocalSize(from, &n));
  CkOk(VecGetArrayRead(from, &a));
  CkOk(VecGetArrayRead(to, &b));
  for (PetscInt i = 0; i < n; ++i)
    if (a[i] >= part * largest) worst = PetscMax(worst, PetscAbsReal(b[i] / a[i] - 1.));
  CkOk(VecRestoreArrayRead(from, &a));
  CkOk(VecRestoreArrayRead(to, &b));
  CkOk(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  return worst;
}

/* With the default tolerance those that are at least a twentieth of the largest; with a smaller one all, if the quadrature is that of
   order 2. _i: order, and whether the mesh is refined towards the end of the load */
START_TEST(indicators_are_those_of_the_dense_system)
{
  const PetscInt order = 1 + _i % 2, refined = 5 * (_i / 2);
  AbutBody       body = LayerBody(order, 64 / order, 16 / order);
  Vec            dense, iterated[2];
  PetscReal      change[2];

  for (PetscInt k = 1; k <= refined; ++k) CkRefine(body, 1., 1., PetscPowRealInt(0.5, k));
  if (refined) CkOk(AbutBodySolve(body, NULL));
  dense       = Estimate(body, "100000", "1e-7");
  iterated[0] = Estimate(body, "0", "1e-7");
  iterated[1] = Estimate(body, "0", "1e-10");
  change[0]   = LargestChange(dense, iterated[0], 0.05);
  change[1]   = LargestChange(dense, iterated[1], 0.);
  CkOk(PetscPrintf(PETSC_COMM_WORLD, "order %" PetscInt_FMT "%s: large indicators differ by %.1e, to a smaller tolerance all by %.1e\n",
                   order, refined ? ", refined" : "", (double)change[0], (double)change[1]));
  ck_assert_double_le(change[0], 1e-3);
  if (order > 1) ck_assert_double_le(change[1], 1e-5);
  for (PetscInt i = 0; i < 2; ++i) CkOk(VecDestroy(&iterated[i]));
  CkOk(VecDestroy(&dense));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("fembem_far");
  TCase *tests = tcase_create("far");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  PetscCall(PetscDLLibraryRegister_estimator_fembem());
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, clusters_do_to_each_other_what_their_elements_do, 1, ABUT_ORDER_MAX + 1);
  tcase_add_loop_test(tests, iterations_and_the_dense_system_agree_under_all_supports, 0, 7);
  tcase_add_loop_test(tests, ranks_share_the_pairs_of_elements, 0, 2);
  tcase_add_loop_test(tests, the_tolerance_is_that_of_the_residual, 0, 7);
  tcase_add_test(tests, ranks_that_compute_unlike_have_one_solution);
  tcase_add_loop_test(tests, indicators_are_those_of_the_dense_system, 0, 4);
  tcase_add_test(tests, what_iterations_hold_grows_with_the_boundary);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
