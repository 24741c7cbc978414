/* ranks: 1 */
#include "ckbody.h"
#include <abutscene.h>

/* The boxes of ck_hertz.c in exact contact, with elements of order 1 to 4: how fast the energy norm of the error falls with the number
   of unknowns N. The stress has a singularity r^(1/2) at the edge of the contact, so that uniform meshes give h^1, and from order 2 on
   h^(3/2), whatever the order; meshes that are graded towards the edge give N^(-p/2), like a smooth solution. Cells are marked by their
   true error, by an estimator that knows the exact solution, or by those of the plugins. */

#define CURVE (2. * (1. - CK_POISSON * CK_POISSON) * 1000. / (CK_YOUNG * 0.5)) /* 1/R */
#define STEPS 60

static CkField     field[2]; /* of the lower and the upper box */
static const char *marks;    /* the estimator that marks, NULL for the true error */

static struct {
  PetscInt  n;
  PetscReal unknowns[STEPS], energy[STEPS];
  PetscReal square[2], unknown; /* of the present cycle: error and solution, of both bodies; unknowns */
  PetscReal lower;              /* error of the lower box */
} history;

/* With the sum of the true error, so that runs end where those end that are marked by it */
static PetscErrorCode EstimateBy(const char type[], AbutBody body, PetscReal error, PetscReal eta[])
{
  AbutEstimator    est;
  Vec              v;
  PetscReal        total, largest;
  const PetscReal *e;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorCreate(PETSC_COMM_WORLD, &est));
  PetscCall(AbutEstimatorSetType(est, type));
  PetscCall(AbutBodyCreateCellVec(body, &v));
  PetscCall(AbutEstimatorEstimate(est, body, v));
  PetscCall(AbutEstimatorGetNorms(body, v, &total, &largest));
  PetscCall(VecGetArrayRead(v, &e));
  for (PetscInt c = 0; c < CkTopology(CkMeshOf(body))->ncells; ++c) eta[c] = e[c] * error / total;
  PetscCall(VecRestoreArrayRead(v, &e));
  PetscCall(VecDestroy(&v));
  PetscCall(AbutEstimatorDestroy(&est));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EstimateExactly(PETSC_UNUSED AbutEstimator est, AbutBody body, PetscReal eta[])
{
  const char             *name;
  const AbutMeshTopology *t = CkTopology(CkMeshOf(body));
  PetscReal               sum[4], whole[2] = {0., 0.}, area = 0.;
  PetscInt                n;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetName(body, &name));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    PetscReal a;

    CkCellErrors(body, &field[name[0] == 'u'], c, sum);
    PetscCall(AbutMeshGetCellArea(CkMeshOf(body), c, &a));
    area += a;
    eta[c] = PetscSqrtReal(sum[2] / a);
    for (PetscInt i = 0; i < 2; ++i) whole[i] += sum[2 + i];
  }
  for (PetscInt c = 0; c < t->ncells; ++c) eta[c] *= PetscSqrtReal(area / whole[1]);
  if (marks) PetscCall(EstimateBy(marks, body, PetscSqrtReal(whole[0] / whole[1]), eta));
  PetscCall(AbutBodyGetSize(body, &n));
  if (name[0] == 'l') history.square[0] = history.square[1] = history.unknown = 0.;
  if (name[0] == 'l') history.lower = PetscSqrtReal(whole[0] / whole[1]);
  for (PetscInt i = 0; i < 2; ++i) history.square[i] += whole[i];
  history.unknown += n;
  if (name[0] == 'u') {
    if (!history.n || history.unknowns[history.n - 1] < history.unknown) ++history.n; /* the last mesh is solved twice, then better */
    history.unknowns[history.n - 1] = history.unknown;
    history.energy[history.n - 1]   = PetscSqrtReal(history.square[0] / history.square[1]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateExact(AbutEstimator est)
{
  const AbutEstimatorOps ops = {.estimate = EstimateExactly};

  PetscFunctionBegin;
  PetscCall(AbutEstimatorSetOps(est, &ops));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One run; history has its cycles */
static void Run(PetscInt n, AbutShape shape, PetscInt order, const char more[])
{
  const char *const name[2] = {"lower", "upper"};
  char              text[2048], part[512];
  AbutScene         scene;

  field[0] = (CkField){.at = CkHertz, .young = CK_YOUNG, .poisson = CK_POISSON};
  field[1] = (CkField){.at = CkHertzAbove, .young = CK_YOUNG, .poisson = CK_POISSON};
  CkOk(PetscSNPrintf(text, sizeof(text),
                     "-scene_bodies lower,upper -scene_pairs mid -mid_pair_bodies lower,upper -mid_pair_sides top,bottom "
                     "-mid_pair_gap %.16g*x^2 -mid_pair_theta 0 -estimator_type exact %s",
                     CURVE, more));
  for (PetscInt b = 0; b < 2; ++b) {
    CkOk(PetscSNPrintf(part, sizeof(part),
                       " -%s_mesh_box 0,%d,2,%d -%s_mesh_cells %d,%d -%s_mesh_shape %s -%s_mesh_order %d -%s_material_young %g "
                       "-%s_material_poisson %g",
                       name[b], b ? 0 : -2, b ? 2 : 0, name[b], (int)n, (int)n, name[b], shape == ABUT_QUAD ? "quad" : "triangle", name[b],
                       (int)order, name[b], CK_YOUNG, name[b], CK_POISSON));
    CkOk(PetscStrlcat(text, part, sizeof(text)));
  }
  history.n = 0;
  CkOptions(text);
  CkOk(AbutSceneCreate(PETSC_COMM_WORLD, &scene));
  CkOk(AbutSceneSetFromOptions(scene));
  for (PetscInt b = 0; b < 2; ++b) {
    AbutBody body;

    CkOk(AbutSceneGetBody(scene, name[b], &body));
    CkGiveAll(body, &field[b], "u-", "uu", b ? "--" : "uu", b ? "uu" : "--");
  }
  CkOk(AbutSceneSolve(scene));
  CkOk(AbutSceneDestroy(&scene));
  CkOptionsEnd();
}

/* Without adaptation */
static PetscReal Uniformly(PetscInt n, AbutShape shape, PetscInt order, PetscReal *lower)
{
  marks = NULL;
  Run(n, shape, order, "-adaptor_type equal -adaptor_target 0.9");
  ck_assert_int_eq(history.n, 1);
  *lower = history.lower;
  return history.energy[0];
}

/* Known: errors of an independent program on the meshes of the lower box; triangles of the upper one are no mirror images of its */
START_TEST(uniform_meshes_have_order_1_and_then_three_halves)
{
  static const PetscReal known[2][2][2] = {
    {{0.0619, 0.03144}, {0.01709, 0.006106}},
    {{0.1142, 0.0589},  {0.02865, 0.01019} }
  };
  static PetscReal worst[2] = {0., 0.}; /* of orders, of errors */
  const AbutShape  shape    = (AbutShape)(_i / 4);
  const PetscInt   order = 1 + _i % 4, first = order == 1 ? 24 : 12;
  PetscReal        energy[2], lower[2];

  if (shape == ABUT_TRIANGLE && order > 3) return;
  for (PetscInt k = 0; k < 2; ++k) energy[k] = Uniformly(first << k, shape, order, &lower[k]);
  printf("%s of order %d: %.3e %.3e, order %.3f\n", shape ? "triangles" : "quads", (int)order, (double)energy[0], (double)energy[1],
         (double)PetscLog2Real(energy[0] / energy[1]));
  worst[0] = PetscMax(worst[0], PetscAbsReal(PetscLog2Real(energy[0] / energy[1]) - (order == 1 ? 1. : 1.5)));
  ck_assert_double_le(worst[0], 0.1);
  for (PetscInt k = 0; order <= 2 && k < 2; ++k) {
    worst[1] = PetscMax(worst[1], PetscAbsReal(lower[k] / known[shape][order - 1][k] - 1.));
    ck_assert_double_le(worst[1], 0.05);
  }
  if (_i != 6) return; /* the last that has a mesh */
  CkCase("V03", "order in the energy norm off 1 and, from order 2 on, 3/2", worst[0], 0.1);
  CkCase("V03", "energy errors off the known ones of P1, Q1, P2, Q2, relative", worst[1], 0.05);
}
END_TEST

/* Exponent of N in the error, by least squares over the last two decades of the history */
static PetscReal Exponent(void)
{
  const PetscReal from   = history.unknowns[history.n - 1] / 100.;
  PetscReal       sum[5] = {0., 0., 0., 0., 0.};

  ck_assert_double_le(history.unknowns[0], from);
  for (PetscInt k = 0; k < history.n; ++k) {
    const PetscReal x = PetscLogReal(history.unknowns[k]), y = PetscLogReal(history.energy[k]);

    if (history.unknowns[k] < from) continue;
    sum[0] += 1.;
    sum[1] += x;
    sum[2] += y;
    sum[3] += x * x;
    sum[4] += x * y;
  }
  return (sum[0] * sum[4] - sum[1] * sum[2]) / (sum[0] * sum[3] - sum[1] * sum[1]);
}

/* The exponent of N over two decades, and over the last one */
static void Adapt(AbutShape shape, PetscInt order)
{
  static const PetscReal target[] = {3e-2, 2.2e-3, 8e-5, 7e-6};
  PetscReal              exponent, last;
  PetscInt               k;
  char                   more[256];

  CkOk(PetscSNPrintf(more, sizeof(more), "-adaptor_type doerfler -adaptor_bulk 0.6 -adaptor_target %g -adaptor_max_level 28",
                     (double)((shape ? 1.5 : 1.) * target[order - 1])));
  Run(order == 1 ? 2 : 1, shape, order, more);
  exponent = Exponent();
  for (k = history.n - 1; k && history.unknowns[k] > history.unknowns[history.n - 1] / 10.;) --k;
  last = PetscLogReal(history.energy[k] / history.energy[history.n - 1]) /
         PetscLogReal(history.unknowns[history.n - 1] / history.unknowns[k]);
  printf("%s of order %d, marked by %s: %g to %g unknowns, %.2e to %.2e, N^%.3f, at last N^-%.3f\n", shape ? "triangles" : "quads",
         (int)order, marks ? marks : "the error", (double)history.unknowns[0], (double)history.unknowns[history.n - 1],
         (double)history.energy[0], (double)history.energy[history.n - 1], (double)exponent, (double)last);
  ck_assert_double_lt(exponent, -0.46 * order);
  ck_assert_double_eq_tol(last, 0.5 * order, 0.1 * order);
}

START_TEST(meshes_adapted_to_the_true_error_have_the_order_of_their_elements)
{
  marks = NULL;
  if (_i / 4 == ABUT_QUAD || _i % 4 < 3) Adapt((AbutShape)(_i / 4), 1 + _i % 4);
}
END_TEST

START_TEST(so_have_meshes_adapted_to_estimates)
{
  static const char *const types[] = {"zz", "fembem", "residual"};

  marks = types[_i % 3];
  Adapt(ABUT_QUAD, 1 + _i / 3);
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("hertz_orders");
  TCase *tc    = tcase_create("all");
  int    failed;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  if (AbutEstimatorRegister("exact", CreateExact)) return EXIT_FAILURE;
  tcase_set_timeout(tc, 0);
  tcase_add_loop_test(tc, uniform_meshes_have_order_1_and_then_three_halves, 0, 8);
  tcase_add_loop_test(tc, meshes_adapted_to_the_true_error_have_the_order_of_their_elements, 0, 8);
  tcase_add_loop_test(tc, so_have_meshes_adapted_to_estimates, 0, 9);
  suite_add_tcase(suite, tc);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
