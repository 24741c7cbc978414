/* The map of the interface trace on two blocks pressed evenly, where the loop is a scalar recurrence: with C = sum of H(1-nu^2)/E and the
   approach delta the penetration d of a sweep's trace obeys d <- (1 - gamma/gamma_opt) d + gamma delta, gamma_opt = 1/(1 + C/theta), on any
   meshes. */
#include "ck_box.h"
#include <abutscene.h>

#define DELTA  1e-3
#define YOUNG  2.1e5
#define NU     0.3
#define LENGTH 4.

static const char blocks
  [] = "-scene_bodies lower,upper -scene_pairs mid -lower_mesh_box 0,0,4,1 -lower_mesh_cells 8,2 -lower_material_young 2.1e5 "
       "-lower_material_poisson 0.3 -lower_bc_left_u1 0 -lower_bc_bottom_u2 0 -upper_mesh_box 0,1,4,2 -upper_mesh_cells 6,2 "
       "-upper_mesh_shape triangle -upper_material_young 2.1e5 -upper_material_poisson 0.3 -upper_bc_left_u1 0 -upper_bc_top_u2 -1e-3 "
       "-mid_pair_bodies upper,lower -mid_pair_sides bottom,top -mid_pair_gap 0";

static const PetscReal C = 2. * (1. - NU * NU) / YOUNG;

static AbutScene     scene;
static AbutInterface iface;
static AbutPair      pair;
static Vec           x, G;
static PetscReal     theta;

/* The scene of the blocks with further options, and vectors of its traces */
static void Open(const char more[])
{
  PetscInt number;

  CkOk(PetscOptionsClear(NULL));
  CkOk(PetscOptionsInsertString(NULL, blocks));
  CkOk(PetscOptionsInsertString(NULL, more));
  CkOk(AbutSceneCreate(PETSC_COMM_WORLD, &scene));
  CkOk(AbutSceneSetFromOptions(scene));
  CkOk(AbutSceneSetUp(scene));
  CkOk(AbutSceneGetInterface(scene, &iface));
  CkOk(AbutSceneGetPair(scene, "mid", &pair, &number));
  CkOk(AbutPairGetTheta(pair, &theta));
  CkOk(AbutInterfaceCreateVec(iface, &x));
  CkOk(VecDuplicate(x, &G));
}

static void OpenPenalty(PetscReal c)
{
  char more[64];

  CkOk(PetscSNPrintf(more, sizeof(more), "-mid_pair_penalty %.16g", (double)c));
  Open(more);
  ck_assert_double_eq_tol(theta, c / YOUNG, 1e-14 * theta);
}

static void Close(void)
{
  CkOk(VecDestroy(&x));
  CkOk(VecDestroy(&G));
  CkOk(AbutSceneDestroy(&scene));
  CkOk(PetscOptionsClear(NULL));
}

/* Sweeps at x; the pressure is the same at all nodes that carry one, and here it is */
static PetscReal Pressure(void)
{
  const PetscReal *p, *xp, *D;
  PetscReal        mean = 0.;
  PetscInt         which, n, count = 0;

  CkOk(AbutInterfaceSweep(iface, x, G));
  CkOk(AbutInterfaceGetPressure(iface, 0, &p));
  CkOk(AbutPairGetPressureNodes(pair, &which, &n, &xp, &D));
  for (PetscInt i = 0; i < n; ++i) {
    if (D[i] <= 0.) continue;
    mean += p[i];
    ++count;
  }
  ck_assert_int_gt(count, 3);
  mean /= count;
  for (PetscInt i = 0; i < n; ++i)
    if (D[i] > 0.) ck_assert_double_le(PetscAbsReal(p[i] - mean), 1e-9 * mean);
  return mean;
}

/* x <- x - gamma (x - G(x)), eq. (21) of the paper */
static void Relax(PetscReal gamma)
{
  CkOk(AbutInterfaceSweep(iface, x, G));
  CkOk(VecAXPBY(x, gamma, 1. - gamma, G));
}

/* A solver with keys -try_snes_* from the trace x */
static SNESConvergedReason Solve(const char options[])
{
  SNES                snes;
  SNESConvergedReason reason;

  CkOk(PetscOptionsInsertString(NULL, options));
  CkOk(SNESCreate(PETSC_COMM_WORLD, &snes));
  CkOk(SNESSetOptionsPrefix(snes, "try_"));
  CkOk(SNESSetTolerances(snes, 0., 1e-12, 0., 100, 1000));
  CkOk(SNESSetType(snes, SNESDDNEUMANN));
  CkOk(SNESSetFromOptions(snes));
  CkOk(AbutInterfaceSetSNES(iface, snes));
  CkOk(SNESSolve(snes, NULL, x));
  CkOk(SNESGetConvergedReason(snes, &reason));
  CkOk(SNESDestroy(&snes));
  return reason;
}

static PetscInt Sweeps(void)
{
  PetscInt sweeps;

  CkOk(AbutInterfaceGetSweeps(iface, &sweeps, NULL));
  return sweeps;
}

/* One rank: the digits of others differ, and one line is enough */
static PetscBool Alone(void)
{
  PetscMPIInt size;

  CkOk(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  return (PetscBool)(size == 1);
}

/* d[0..3] obey the recurrence; its factor is measured without knowing where it leads */
static void CheckRecurrence(const char what[], const PetscReal d[4], PetscReal gamma)
{
  const PetscReal factor = 1. - gamma * (1. + C / theta);
  PetscReal       worst  = 0.;

  ck_assert_double_eq_tol(d[0], DELTA, 1e-10 * DELTA);
  for (PetscInt k = 0; k < 3; ++k) ck_assert_double_eq_tol(d[k + 1], factor * d[k] + gamma * DELTA, 1e-9 * DELTA);
  for (PetscInt k = 0; k < 2; ++k) worst = PetscMax(worst, PetscAbsReal((d[k + 2] - d[k + 1]) / (d[k + 1] - d[k]) - factor));
  ck_assert_double_le(worst, 1e-6);
  if (Alone()) CkCase("V01", what, worst, 1e-6);
}

START_TEST(relaxation_by_hand_contracts_the_penetration_by_0_252)
{
  PetscReal d[4];

  OpenPenalty(0.05);
  ck_assert_double_eq_tol(1. - 0.02 * (1. + C / theta), 0.252, 1e-14);
  CkOk(AbutInterfaceComputeStart(iface, ABUT_START_NOCONTACT, x));
  for (PetscInt k = 0; k < 4; ++k) {
    if (k) Relax(0.02);
    d[k] = theta * Pressure();
  }
  CheckRecurrence("factor of a relaxation by hand off 0.252", d, 0.02);
  Close();
}
END_TEST

START_TEST(ddneumann_contracts_the_penetration_by_0_252)
{
  PetscReal d[4];
  char      options[128];

  OpenPenalty(0.05);
  for (PetscInt k = 0; k < 4; ++k) {
    CkOk(AbutInterfaceComputeStart(iface, ABUT_START_NOCONTACT, x));
    CkOk(PetscSNPrintf(options, sizeof(options), "-try_snes_max_it %" PetscInt_FMT, k));
    CkOk(AbutInterfaceSetGamma(iface, 0.02));
    ck_assert_int_eq(Solve(options), SNES_DIVERGED_MAX_IT);
    d[k] = theta * Pressure();
  }
  CheckRecurrence("factor of ddneumann off 0.252", d, 0.02);
  Close();
}
END_TEST

START_TEST(an_iteration_of_ddneumann_is_one_sweep)
{
  OpenPenalty(0.05);
  CkOk(AbutInterfaceComputeStart(iface, ABUT_START_NOCONTACT, x));
  CkOk(AbutInterfaceSetGamma(iface, 0.02));
  ck_assert_int_eq(Solve("-try_snes_max_it 3"), SNES_DIVERGED_MAX_IT);
  ck_assert_int_eq(Sweeps(), 4); /* the last one for the residual of the last trace, which is then known */
  (void)Pressure();
  ck_assert_int_eq(Sweeps(), 4);
  Close();
}
END_TEST

static const PetscReal penalties[] = {0.5, 0.05, 0.005, 5e-4};

START_TEST(one_step_with_the_optimal_relaxation_gives_the_exact_pressure)
{
  static PetscReal worst = 0.;
  const PetscReal  exact = DELTA / (C + penalties[_i] / YOUNG);
  PetscReal        error;

  OpenPenalty(penalties[_i]);
  if (_i == 1) ck_assert_double_eq_tol(exact, 112.299465, 1e-6);
  CkOk(AbutInterfaceComputeStart(iface, ABUT_START_NOCONTACT, x));
  Relax(1. / (1. + C / theta));
  error = PetscAbsReal(Pressure() / exact - 1.);
  ck_assert_double_le(error, 1e-9);
  worst = PetscMax(worst, error);
  if (_i == 3 && Alone()) CkCase("V01", "pressure after one sweep with the best gamma, c 0.5 to 5e-4", worst, 1e-8);
  Close();
}
END_TEST

START_TEST(a_loop_from_zero_ends_at_the_exact_pressure)
{
  const PetscReal exact = DELTA / (C + penalties[_i] / YOUNG);
  AbutPairState   state;
  char            options[128];

  OpenPenalty(penalties[_i]);
  CkOk(AbutInterfaceComputeStart(iface, ABUT_START_ZERO, x));
  ck_assert_double_eq(Pressure(), 0.);
  CkOk(PetscSNPrintf(options, sizeof(options), "-try_snes_type anderson -try_snes_rtol 1e-11 -try_snes_anderson_beta %g",
                     (double)(2. / (2. + C / theta))));
  ck_assert_int_gt(Solve(options), 0);
  ck_assert_double_eq_tol(Pressure(), exact, 1e-8 * exact);
  CkOk(AbutInterfaceGetPairState(iface, 0, &state));
  ck_assert_double_eq_tol(state.force, LENGTH * exact, 1e-8 * LENGTH * exact);
  ck_assert_double_eq_tol(state.penetration_max, theta * exact, 1e-8 * theta * exact);
  Close();
}
END_TEST

START_TEST(the_winkler_start_is_exact_where_layers_are)
{
  PetscReal residual;

  OpenPenalty(0.05);
  CkOk(AbutInterfaceComputeStart(iface, ABUT_START_WINKLER, x));
  ck_assert_double_eq_tol(Pressure(), DELTA / (C + theta), 1e-9 * DELTA / (C + theta));
  CkOk(VecAXPY(G, -1., x));
  CkOk(VecNorm(G, NORM_INFINITY, &residual));
  ck_assert_double_le(residual, 1e-11 * DELTA);
  Close();
}
END_TEST

START_TEST(the_automatic_relaxation_is_2_over_2_plus_C_over_theta)
{
  PetscReal gamma;

  OpenPenalty(penalties[_i]);
  CkOk(AbutInterfaceGetGamma(iface, &gamma));
  ck_assert_double_eq_tol(gamma, 2. / (2. + C / theta), 1e-14);
  CkOk(AbutInterfaceSetGamma(iface, 0.125));
  CkOk(AbutInterfaceGetGamma(iface, &gamma));
  ck_assert_double_eq(gamma, 0.125);
  Close();
}
END_TEST

START_TEST(the_automatic_relaxation_knows_heights_and_materials)
{
  const PetscReal exact = 2. / (2. + (0.5 * (1. - 0.0625) / 7e4 + 1. * (1. - NU * NU) / YOUNG) / 1e-6);
  PetscReal       gamma;

  Open("-upper_mesh_box 0,1,4,1.5 -upper_material_young 7e4 -upper_material_poisson 0.25 -mid_pair_theta 1e-6");
  CkOk(AbutInterfaceGetGamma(iface, &gamma));
  ck_assert_double_eq_tol(gamma, exact, 1e-14);
  Close();
}
END_TEST

/* Whether this abut has SLEPc; then the spectrum is to be computed */
static PetscBool ComputeSpectrum(void)
{
  PetscErrorCode code;

  CkCatch(code = AbutInterfaceSetSpectrum(iface, PETSC_TRUE));
  if (code) ck_assert_ptr_nonnull(strstr(ck_line, "built without SLEPc"));
  return (PetscBool)!code;
}

START_TEST(the_computed_spectrum_of_two_blocks_ends_at_1_plus_C_over_theta)
{
  PetscReal least, largest, gamma;

  OpenPenalty(penalties[_i]);
  if (ComputeSpectrum()) {
    CkOk(AbutInterfaceGetSpectrum(iface, &least, &largest));
    ck_assert_double_eq(least, 1.);
    ck_assert_double_eq_tol(largest, 1. + C / theta, 1e-7 * largest);
    CkOk(AbutInterfaceGetGamma(iface, &gamma));
    ck_assert_double_eq_tol(gamma, 2. / (1. + largest), 1e-14);
    CkOk(AbutInterfaceSetGamma(iface, 0.125));
    CkOk(AbutInterfaceGetGamma(iface, &gamma));
    ck_assert_double_eq(gamma, 0.125);
  }
  Close();
}
END_TEST

START_TEST(the_spectrum_is_computed_once_a_mesh_and_counted_as_start)
{
  AbutBody  bodies[2];
  PetscInt  sides[2], sweeps, start[4];
  PetscReal least, largest;

  OpenPenalty(0.05);
  CkOk(AbutPairGetBodies(pair, bodies, sides));
  for (PetscInt k = 0; k < 4 && ComputeSpectrum(); ++k) {
    if (k == 2) {
      CkRefine(bodies[0], 1.1, 1., 0.5);
      CkOk(AbutInterfaceReset(iface));
      CkOk(AbutInterfaceSetUp(iface));
    }
    CkOk(AbutInterfaceGetSpectrum(iface, &least, &largest));
    if (k < 2) ck_assert_double_eq_tol(largest, 1. + C / theta, 1e-6 * largest);
    else ck_assert_double_gt(largest, 1.02 * (1. + C / theta)); /* sawteeth of coarse pressures on smaller cells */
    CkOk(AbutInterfaceGetSweeps(iface, &sweeps, &start[k]));
    ck_assert_int_eq(sweeps, 0);
    if (!k) ck_assert_int_gt(start[0], 0);
    else if (k == 2) ck_assert_int_gt(start[2], start[1]);
    else ck_assert_int_eq(start[k], start[k - 1]);
  }
  Close();
}
END_TEST

START_TEST(a_second_look_at_the_same_trace_is_no_sweep)
{
  Vec       y, H;
  PetscReal difference;

  OpenPenalty(0.05);
  CkOk(VecDuplicate(x, &y));
  CkOk(VecDuplicate(x, &H));
  CkOk(AbutInterfaceComputeStart(iface, ABUT_START_NOCONTACT, x));
  CkOk(AbutInterfaceSweep(iface, x, G));
  ck_assert_int_eq(Sweeps(), 1);
  CkOk(AbutInterfaceSweep(iface, x, H)); /* the same vector */
  ck_assert_int_eq(Sweeps(), 1);
  CkOk(VecCopy(x, y));
  CkOk(AbutInterfaceSweep(iface, y, H)); /* another one with the same values */
  ck_assert_int_eq(Sweeps(), 1);
  CkOk(VecAXPY(H, -1., G));
  CkOk(VecNorm(H, NORM_INFINITY, &difference));
  ck_assert_double_eq(difference, 0.);
  CkOk(VecScale(y, 1. + 1e-12));
  CkOk(AbutInterfaceSweep(iface, y, H)); /* almost the same values */
  ck_assert_int_eq(Sweeps(), 2);
  CkOk(AbutInterfaceSweep(iface, x, H)); /* only the last trace is remembered */
  ck_assert_int_eq(Sweeps(), 3);
  CkOk(VecDestroy(&y));
  CkOk(VecDestroy(&H));
  Close();
}
END_TEST

/* Walks the trace v in its order: the values of each side that this rank owns, one side after the other. Sets those of side s to a[s] +
   b[s] x, or checks that they are. */
static void Walk(Vec v, const PetscReal a[2], const PetscReal b[2], PetscBool check)
{
  PetscScalar *value;
  AbutBody     bodies[2];
  PetscInt     sides[2], k = 0, n;

  CkOk(AbutPairGetBodies(pair, bodies, sides));
  CkOk(VecGetLocalSize(v, &n));
  CkOk(VecGetArray(v, &value));
  for (PetscInt s = 0; s < 2; ++s) {
    const AbutMeshTopology *t = CkTopology(bodies[s]);
    const AbutSide         *side;

    CkOk(AbutBodyGetSide(bodies[s], sides[s], &side));
    for (PetscInt i = 0; i < side->n; ++i) {
      const PetscReal exact = a[s] + b[s] * side->x[2 * i];

      if (side->global[i] < t->firstowned || side->global[i] >= t->firstowned + t->nowned) continue;
      if (check) ck_assert_double_eq_tol(value[k], exact, 1e-13);
      value[k++] = exact;
    }
  }
  ck_assert_int_eq(k, n);
  CkOk(VecRestoreArray(v, &value));
}

START_TEST(the_change_of_the_paper_is_the_largest_over_the_bodies_and_none_where_a_trace_is_zero)
{
  static const PetscReal trace[2] = {2., 5.}, step[2] = {0.2, 1.}, one[2] = {2., 0.}, none[2] = {0., 0.};
  PetscReal              change;

  OpenPenalty(0.05);
  Walk(x, trace, none, PETSC_FALSE);
  Walk(G, step, none, PETSC_FALSE);
  CkOk(AbutInterfaceGetChange(iface, G, x, &change));
  ck_assert_double_eq_tol(change, 0.2, 1e-14);
  Walk(x, one, none, PETSC_FALSE); /* the second body does not move */
  Walk(G, none, none, PETSC_FALSE);
  CkOk(AbutInterfaceGetChange(iface, G, x, &change));
  ck_assert_double_ge(change, PETSC_INFINITY);
  Close();
}
END_TEST

START_TEST(a_linear_trace_crosses_exactly_to_refined_meshes)
{
  static const PetscReal a[2] = {-1., 3.}, b[2] = {0.9, -0.7};
  AbutBody               bodies[2];
  PetscInt               sides[2], before, after;

  OpenPenalty(0.05);
  CkOk(AbutPairGetBodies(pair, bodies, sides));
  for (PetscInt step = 0; step < 3; ++step) {
    CkOk(VecGetSize(x, &before));
    Walk(x, a, b, PETSC_FALSE);
    CkOk(AbutInterfaceKeepTrace(iface, x));
    if (step != 1) CkRefine(bodies[0], 1.1 + 0.1 * step, 1., 0.5); /* upper, triangles */
    if (step != 2) CkRefine(bodies[1], 0.2, 1., 0.6);              /* lower, quadrilaterals */
    CkOk(AbutInterfaceReset(iface));
    CkOk(AbutInterfaceSetUp(iface));
    CkOk(VecDestroy(&x));
    CkOk(AbutInterfaceCreateVec(iface, &x));
    CkOk(AbutInterfaceTransferTrace(iface, x));
    CkOk(VecGetSize(x, &after));
    ck_assert_int_gt(after, before);
    Walk(x, a, b, PETSC_TRUE);
  }
  Close();
}
END_TEST

int main(int argc, char **argv)
{
  const int n     = (int)PETSC_STATIC_ARRAY_LENGTH(penalties);
  Suite    *suite = suite_create("loop");
  TCase    *tc    = tcase_create("loop");
  int       status;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  suite_add_tcase(suite, tc);
  tcase_add_test(tc, relaxation_by_hand_contracts_the_penetration_by_0_252);
  tcase_add_test(tc, ddneumann_contracts_the_penetration_by_0_252);
  tcase_add_test(tc, an_iteration_of_ddneumann_is_one_sweep);
  tcase_add_loop_test(tc, one_step_with_the_optimal_relaxation_gives_the_exact_pressure, 0, n);
  tcase_add_loop_test(tc, a_loop_from_zero_ends_at_the_exact_pressure, 0, n - 1); /* acceleration is unreliable for the smallest theta */
  tcase_add_test(tc, the_winkler_start_is_exact_where_layers_are);
  tcase_add_loop_test(tc, the_automatic_relaxation_is_2_over_2_plus_C_over_theta, 0, n);
  tcase_add_test(tc, the_automatic_relaxation_knows_heights_and_materials);
  tcase_add_loop_test(tc, the_computed_spectrum_of_two_blocks_ends_at_1_plus_C_over_theta, 0, n);
  tcase_add_test(tc, the_spectrum_is_computed_once_a_mesh_and_counted_as_start);
  tcase_add_test(tc, a_second_look_at_the_same_trace_is_no_sweep);
  tcase_add_test(tc, the_change_of_the_paper_is_the_largest_over_the_bodies_and_none_where_a_trace_is_zero);
  tcase_add_test(tc, a_linear_trace_crosses_exactly_to_refined_meshes);
  status = CkRun(suite);
  return AbutFinalize() ? EXIT_FAILURE : status;
}
