/* The contact model and the loop that uses it: the programme against all zones tried one by one, the layers against the bodies
   themselves, what a sweep teaches, and the answers of two blocks and of a block that only contact holds, which are formulas */
#include "ck_box.h"
#include <abutscene.h>
#include <abut/private/loopimpl.h>

#define YOUNG   2.1e5
#define NU      0.3
#define CLOSURE 1e-3
#define LOAD    7.

static AbutScene        scene;
static AbutInterface    iface;
static AbutPair         pair;
static AbutContactModel model;

static void Open(const char gap[], const char more[])
{
  static const char
       blocks[] = "-scene_bodies lower,upper -scene_pairs mid -lower_mesh_box 0,0,4,1 -lower_mesh_cells 64,16 -lower_material_young 2.1e5 "
                  "-lower_material_poisson 0.3 -lower_bc_left_u1 0 -lower_bc_bottom_u2 0 -upper_mesh_box 0,1,4,2 -upper_mesh_cells 48,12 "
                  "-upper_material_young 2.1e5 -upper_material_poisson 0.3 -upper_bc_left_u1 0 "
                  "-mid_pair_bodies upper,lower -mid_pair_sides bottom,top";
  char text[256];
  PetscInt number;

  CkOk(PetscOptionsClear(NULL));
  CkOk(PetscOptionsInsertString(NULL, blocks));
  CkOk(PetscSNPrintf(text, sizeof(text), "-mid_pair_gap %s", gap));
  CkOk(PetscOptionsInsertString(NULL, text));
  CkOk(PetscOptionsInsertString(NULL, more));
  CkOk(AbutSceneCreate(PETSC_COMM_WORLD, &scene));
  CkOk(AbutSceneSetFromOptions(scene));
  CkOk(AbutSceneSetUp(scene));
  CkOk(AbutSceneGetInterface(scene, &iface));
  CkOk(AbutSceneGetPair(scene, "mid", &pair, &number));
  CkOk(AbutInterfaceGetModel_Private(iface, &model));
}

static void Close(void)
{
  CkOk(AbutSceneDestroy(&scene));
  CkOk(PetscOptionsClear(NULL));
}

/* --- the programme ------------------------------------------------------------------------------------------------------------- */

#define N 8

/* A small model of its own: S = R R' + I/5 and m motions along which the forces have the resultants e */
static AbutContactModel Small(PetscRandom random, PetscInt m)
{
  AbutContactModel small;
  PetscReal        R[N * N];

  CkOk(PetscNew(&small));
  small->n = N;
  small->m = m;
  CkOk(PetscCalloc1(1, &small->first));
  CkOk(PetscMalloc6(N, &small->node, N, &small->D, N, &small->soft, N, &small->open, N, &small->b, N, &small->active));
  CkOk(AbutComplianceCreate_Private(PETSC_COMM_SELF, N, PETSC_MAX_INT, &small->S));
  CkOk(PetscMalloc4(m * N, &small->G, m, &small->e, m, &small->owner, m, &small->mode));
  CkOk(PetscMalloc1(N * (m + 1), &small->X));
  CkOk(PetscRandomSetInterval(random, -1., 1.));
  for (PetscInt i = 0; i < N * N; ++i) CkOk(PetscRandomGetValue(random, &R[i]));
  for (PetscInt i = 0; i < N; ++i) {
    small->soft[i] = 0.01 * i;
    for (PetscInt j = 0; j < N; ++j)
      for (PetscInt k = 0; k < N; ++k) small->S->a[i * N + j] += R[i * N + k] * R[j * N + k] + (i == j ? 0.2 / N : 0.);
  }
  for (PetscInt k = 0; k < m; ++k) {
    small->e[k] = k ? 0.6 : 1.; /* a load of 1 at 0.6 of the length */
    for (PetscInt i = 0; i < N; ++i) small->G[k * N + i] = k ? (i + 1.) / N : 1.;
  }
  return small;
}

/* F >= 0, g = b - (S + soft) F + G a <= 0, F g = 0, G'F = e: with S positive definite there is one such F, whatever way it was found */
static void CheckComplementary(AbutContactModel s, const PetscReal b[], const PetscReal F[], const PetscReal a[])
{
  for (PetscInt i = 0; i < N; ++i) {
    PetscReal g = b[i] - s->soft[i] * F[i];

    for (PetscInt j = 0; j < N; ++j) g -= s->S->a[i * N + j] * F[j];
    for (PetscInt k = 0; k < s->m; ++k) g += s->G[k * N + i] * a[k];
    ck_assert_double_ge(F[i], 0.);
    ck_assert_double_le(g, 1e-10);
    ck_assert_double_le(PetscAbsReal(F[i] * g), 1e-10);
  }
  for (PetscInt k = 0; k < s->m; ++k) {
    PetscReal resultant = 0.;

    for (PetscInt i = 0; i < N; ++i) resultant += s->G[k * N + i] * F[i];
    ck_assert_double_eq_tol(resultant, s->e[k], 1e-10);
  }
}

START_TEST(the_programme_is_solved_from_any_zone)
{
  PetscRandom random;

  CkOk(PetscRandomCreate(PETSC_COMM_SELF, &random));
  for (PetscInt seed = 0; seed < 200; ++seed) {
    AbutContactModel small;
    PetscReal        b[N], r[N], F[N], d[N], a[2];
    PetscInt         loose;
    PetscBool        solved;

    CkOk(PetscRandomSetSeed(random, 1 + seed));
    CkOk(PetscRandomSeed(random));
    small = Small(random, seed % 3);
    for (PetscInt i = 0; i < N; ++i) {
      CkOk(PetscRandomGetValue(random, &b[i]));
      CkOk(PetscRandomGetValue(random, &F[i]));
      F[i] = PetscMax(0., F[i]); /* the zone to begin with */
    }
    for (PetscInt i = 0; i < N; ++i) {
      r[i] = b[i] - small->soft[i] * F[i];
      for (PetscInt j = 0; j < N; ++j) r[i] -= small->S->a[i * N + j] * F[j];
    }
    CkOk(AbutContactModelSolve_Private(small, r, F, d, a, &loose, &solved));
    ck_assert(solved);
    for (PetscInt i = 0; i < N; ++i) F[i] += d[i];
    CheckComplementary(small, b, F, a);
    CkOk(AbutContactModelDestroy_Private(&small));
  }
  CkOk(PetscRandomDestroy(&random));
}
END_TEST

START_TEST(a_resultant_that_pulls_cannot_be_held)
{
  AbutContactModel small;
  PetscRandom      random;
  PetscReal        r[N] = {0.}, F[N] = {0.}, d[N], a[2];
  PetscInt         loose;
  PetscBool        solved;

  CkOk(PetscRandomCreate(PETSC_COMM_SELF, &random));
  small       = Small(random, 1);
  small->e[0] = -1.;
  CkOk(AbutContactModelSolve_Private(small, r, F, d, a, &loose, &solved));
  ck_assert(!solved);
  ck_assert_int_eq(loose, 0);
  for (PetscInt i = 0; i < N; ++i) ck_assert_double_eq(d[i], 0.);
  CkOk(AbutContactModelDestroy_Private(&small));
  CkOk(PetscRandomDestroy(&random));
}
END_TEST

START_TEST(a_sweep_teaches_its_direction_and_keeps_what_was_learnt)
{
  AbutContactModel small, truth; /* the truth is another model */
  PetscRandom      random;
  PetscReal        d[N][N], q[N];

  CkOk(PetscRandomCreate(PETSC_COMM_SELF, &random));
  small = Small(random, 0);
  truth = Small(random, 0);
  for (PetscInt k = 0; k < N; ++k) { /* directions conjugate in the truth, as those of the loop on a standing zone */
    for (PetscInt i = 0; i < N; ++i) d[k][i] = i == k ? 1. : 0.;
    for (PetscInt l = 0; l < k; ++l) {
      PetscReal up = 0., down = 0.;

      for (PetscInt i = 0; i < N; ++i)
        for (PetscInt j = 0; j < N; ++j) {
          up += d[k][i] * truth->S->a[i * N + j] * d[l][j];
          down += d[l][i] * truth->S->a[i * N + j] * d[l][j];
        }
      for (PetscInt i = 0; i < N; ++i) d[k][i] -= up / down * d[l][i];
    }
    for (PetscInt i = 0; i < N; ++i) {
      q[i] = 0.;
      for (PetscInt j = 0; j < N; ++j) q[i] += truth->S->a[i * N + j] * d[k][j];
    }
    CkOk(AbutContactModelLearn_Private(small, d[k], q));
    for (PetscInt l = 0; l <= k; ++l)
      for (PetscInt i = 0; i < N; ++i) {
        PetscReal give = 0.;

        for (PetscInt j = 0; j < N; ++j) give += (small->S->a[i * N + j] - truth->S->a[i * N + j]) * d[l][j];
        ck_assert_double_le(PetscAbsReal(give), 1e-9);
      }
  }
  for (PetscInt i = 0; i < N * N; ++i) ck_assert_double_eq_tol(small->S->a[i], truth->S->a[i], 1e-9); /* N directions are all there are */
  CkOk(AbutContactModelDestroy_Private(&small));
  CkOk(AbutContactModelDestroy_Private(&truth));
  CkOk(PetscRandomDestroy(&random));
}
END_TEST

/* --- the layers ---------------------------------------------------------------------------------------------------------------- */

/* d'S d of the bodies themselves, one sweep */
static PetscReal TrueEnergy(const PetscReal d[])
{
  PetscReal *q, energy = 0.;

  CkOk(PetscMalloc1(model->n, &q));
  CkOk(AbutInterfaceComply_Private(iface, model, d, q));
  for (PetscInt c = 0; c < model->n; ++c) energy += d[c] * q[c];
  CkOk(PetscFree(q));
  return energy;
}

/* Pressures 1 + cos(k pi x/L), which two layers on smooth bases answer mode by mode, on meshes that do not match */
START_TEST(the_layers_know_how_two_layers_give_way)
{
  const PetscInt   k = _i;
  const PetscReal *x, *D;
  PetscReal       *d, energy, model_energy;
  PetscInt         which, n;

  Open("0", "-upper_bc_top_u2 -1e-3");
  CkOk(AbutPairGetPressureNodes(pair, &which, &n, &x, &D));
  CkOk(PetscMalloc1(model->n, &d));
  for (PetscInt c = 0; c < model->n; ++c) d[c] = model->D[c] * PetscCosReal(k * PETSC_PI * x[2 * model->node[c]] / 4.);
  energy = TrueEnergy(d);
  CkOk(AbutContactModelEnergy_Private(model, NULL, d, &model_energy));
  /* the free end of the bodies is no plane of symmetry, and waves of few cells give way less than they should */
  ck_assert_double_eq_tol(model_energy, energy, (k ? 0.02 + 0.002 * k * k : 1e-10) * energy);
  if (!k) ck_assert_double_eq_tol(energy, 4. * 2. * (1. - NU * NU) / YOUNG, 1e-10 * energy);
  CkOk(PetscFree(d));
  Close();
}
END_TEST

/* --- the loop ------------------------------------------------------------------------------------------------------------------ */

static void Solve(PetscInt expected, AbutPairState *state, PetscInt *sweeps)
{
  PetscInt status;

  CkOk(AbutSceneSolve(scene));
  CkOk(AbutSceneGetExitStatus(scene, &status));
  ck_assert_int_eq(status, expected);
  CkOk(AbutInterfaceGetPairState(iface, 0, state));
  CkOk(AbutInterfaceGetSweeps(iface, sweeps, NULL));
}

START_TEST(two_blocks_need_no_second_direction)
{
  static const PetscReal c[] = {0.5, 0.05, 5e-4, 1e-10, 0.};
  const PetscReal        C   = 2. * (1. - NU * NU) / YOUNG;
  AbutPairState          state;
  char                   more[128];
  PetscInt               sweeps;

  CkOk(PetscSNPrintf(more, sizeof(more), "-upper_bc_top_u2 -1e-3 -mid_pair_penalty %.16g", (double)c[_i]));
  Open("0", more);
  Solve(0, &state, &sweeps);
  ck_assert_double_eq_tol(state.force, 4. * CLOSURE / (C + c[_i] / YOUNG), 1e-10 * state.force);
  ck_assert_int_le(sweeps, 2); /* the layers are exact for an even pressure */
  ck_assert_int_eq(state.active, state.nodes);
  Close();
}
END_TEST

START_TEST(its_trace_is_a_fixed_point_of_the_paper_s_sweep)
{
  AbutPairState state;
  PetscInt      sweeps;
  PetscReal     trace, pressure;
  Vec           x, G;

  Open("1e-3*x^2", "-upper_bc_top_u2 -1.366e-3 -mid_pair_penalty 0.5 -snes_rtol 1e-11");
  Solve(0, &state, &sweeps);
  CkOk(AbutInterfaceCreateVec(iface, &x));
  CkOk(VecDuplicate(x, &G));
  CkOk(AbutInterfaceLocalize_Private(iface, iface->g, x));
  CkOk(AbutInterfaceSweep(iface, x, G));
  CkOk(AbutInterfaceGetResidual(iface, &trace, &pressure));
  ck_assert_double_le(trace, 1e-10);
  ck_assert_double_le(pressure, 1e-9);
  CkOk(VecDestroy(&x));
  CkOk(VecDestroy(&G));
  Close();
}
END_TEST

/* An even load on a block that nothing but contact holds along y: the gap is closed by a free motion, the pressure is the load */
START_TEST(a_block_under_load_finds_its_support)
{
  AbutPairState    state;
  PetscInt         sweeps;
  const PetscReal *u;

  Open("0.02", "-upper_bc_top_t2 -7 -mid_pair_penalty 0");
  Solve(0, &state, &sweeps);
  ck_assert_double_eq_tol(state.force, 4. * LOAD, 1e-10 * state.force);
  ck_assert_double_eq_tol(state.pressure_max, LOAD, 1e-9 * LOAD);
  CkOk(AbutInterfaceGetTrace(iface, 0, 0, &u));
  ck_assert_double_eq_tol(u[0], 0.02 + LOAD * (1. - NU * NU) / YOUNG, 1e-9 * 0.02); /* down by the gap and by what the support gives */
  Close();
}
END_TEST

START_TEST(a_block_that_is_pulled_away_is_named)
{
  AbutPairState state;
  PetscInt      sweeps;
  const char   *text;

  Open("0.02", "-upper_bc_top_t2 7 -mid_pair_penalty 0");
  Solve(2, &state, &sweeps);
  CkOk(AbutInterfaceGetFloating(iface, &text));
  ck_assert_str_eq(text, "upper: contact does not hold this body, it is free in moving along y");
  Close();
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("ddactive");
  TCase *tests = tcase_create("model"), *loop = tcase_create("loop");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  tcase_set_timeout(tests, 0);
  tcase_set_timeout(loop, 0);
  tcase_add_test(tests, the_programme_is_solved_from_any_zone);
  tcase_add_test(tests, a_resultant_that_pulls_cannot_be_held);
  tcase_add_test(tests, a_sweep_teaches_its_direction_and_keeps_what_was_learnt);
  tcase_add_loop_test(tests, the_layers_know_how_two_layers_give_way, 0, 8);
  tcase_add_loop_test(loop, two_blocks_need_no_second_direction, 0, 5);
  tcase_add_test(loop, its_trace_is_a_fixed_point_of_the_paper_s_sweep);
  tcase_add_test(loop, a_block_under_load_finds_its_support);
  tcase_add_test(loop, a_block_that_is_pulled_away_is_named);
  suite_add_tcase(suite, tests);
  suite_add_tcase(suite, loop);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
