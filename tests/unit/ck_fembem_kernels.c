#include <petsctime.h>
#include "fembem_boundaries.h"

/* One element a side of [0,2]x[0,1], displacements and tractions of no solution: Somigliana's identity as an integral. All values below:
   40-digit quadrature of the Kelvin kernels */
static void GoldenBoundary(AbutBoundary *given, FembemBoundary *b)
{
  static const PetscReal x[8] = {0., 0., 2., 0., 2., 1., 0., 1.}, u[8] = {0., 0., 1., .5, .25, -1., -.5, .75};
  static const PetscReal t[16] = {1., 2., 3., 4., -1., 0., .5, 1., 2., -2., 0., 1., .25, .5, -.75, 1.};

  CkOk(BoundaryAllocate(4, 1, 1, given));
  CkOk(PetscArraycpy(given->x, x, 8));
  CkOk(PetscArraycpy(given->u, u, 8));
  CkOk(PetscArraycpy(given->traction, t, 16));
  CkOk(FembemBoundaryCreate(PETSC_COMM_SELF, given, 1., 0.3, b));
}

static void Evaluate(const FembemBoundary *b, PetscReal tolerance, PetscInt n, const PetscReal x[], PetscReal s[])
{
  FembemStress stress;

  CkOk(FembemStressCreate(b, tolerance, &stress));
  CkOk(FembemStressEvaluate(stress, n, x, s));
  CkOk(FembemStressDestroy(&stress));
}

START_TEST(stresses_are_those_of_kelvins_kernels_at_any_distance)
{
  static const PetscReal x[10]        = {.7, .3, 1., 1e-6, 1e-6, 1e-6, 1.9999999, .5, 200., 100.},
                         tolerance[5] = {1e-12, 1e-12, 1e-12, 1e-12, 1e-10};
  static const PetscReal exact[15]    = {6.645822597038187e-01,  -1.165467281283533e+00, -5.188109570260746e-01, 3.322332367621149e-01,
                                         -1.713517513115717e+00, -1.093830698058907e+00, 3.954165587811167e+00,  2.212299979365622e+00,
                                         1.857119724530700e+00,  -9.560265704622583e-01, -2.213823670719747e+00, -3.219474327712118e-01,
                                         -6.741960804942364e-03, -1.151566096823238e-03, -4.805159557163802e-03};
  AbutBoundary           given;
  FembemBoundary         b;
  PetscReal              s[15];

  GoldenBoundary(&given, &b);
  Evaluate(&b, 0., 5, x, s);
  for (PetscInt i = 0; i < 15; ++i) ck_assert_double_eq_tol(s[i], exact[i], tolerance[i / 3] * PetscAbsReal(exact[i]));
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(BoundaryFree(&given));
}
END_TEST

/* Displacement at z by the integrals of which the Galerkin matrices are made; own: the element on which z lies, -1 if none */
static PetscComplex Displacement(const FembemBoundary *b, PetscComplex z, PetscInt own)
{
  const PetscReal    cv = 1. / (4. * PETSC_PI * b->mat.mu * (1. + b->mat.kappa));
  const PetscComplex f  = PetscCMPLX(0., -1. / (2. * PETSC_PI * (1. + b->mat.kappa)));
  PetscComplex       u  = 0.;

  for (PetscInt i = 0; i < b->n; ++i) {
    const PetscComplex Ta = b->t[2 * i], Tb = b->t[2 * i + 1], ua = b->u[i], ub = b->u[b->next[i]];
    FembemElement      e;
    FembemIntegrals    v;

    FembemElementSet(&e, b->z[i], b->z[b->next[i]]);
    FembemElementIntegrate(&e, 1, z, i == own ? PETSC_TRUE : PETSC_FALSE, &v);
    u += 0.5 * cv *
         (-2. * b->mat.kappa * ((Ta + Tb) * v.P[0] + (Tb - Ta) * v.P[1]) + PetscConjComplex(Ta + Tb) * v.Q[0] +
          PetscConjComplex(Tb - Ta) * v.Q[1]);
    u += 0.5 * f *
         ((b->mat.kappa * v.E[0] - PetscConjComplex(v.E[0])) * (ua + ub) + (b->mat.kappa * v.E[1] - PetscConjComplex(v.E[1])) * (ub - ua) -
          2. * v.Q[0] / e.h * PetscConjComplex(ub - ua));
  }
  return u;
}

START_TEST(displacements_are_those_of_kelvins_kernels_at_any_distance)
{
  static const PetscReal x[12]        = {.7, .3, 1., 1e-6, 1e-6, 1e-6, 1.9999999, .5, 3., 2., 200., 100.},
                         tolerance[6] = {1e-12, 1e-12, 1e-12, 1e-12, 1e-12, 1e-10};
  static const PetscReal exact[12]    = {3.602014945555732e-01,  7.426136925090538e-01,  1.313783457792141e+00,  1.221801831294789e+00,
                                         1.121262878084306e-02,  3.115226432777908e-01,  9.410555524537041e-01,  -1.534949447745509e-01,
                                         -7.594181071526049e-01, -1.299682158930858e+00, -7.293007825843997e+00, -8.937982431245493e+00};
  AbutBoundary           given;
  FembemBoundary         b;

  GoldenBoundary(&given, &b);
  for (PetscInt i = 0; i < 6; ++i) {
    const PetscComplex u = Displacement(&b, PetscCMPLX(x[2 * i], x[2 * i + 1]), -1);

    ck_assert_double_eq_tol(PetscRealPartComplex(u), exact[2 * i], tolerance[i] * PetscAbsReal(exact[2 * i]));
    ck_assert_double_eq_tol(PetscImaginaryPartComplex(u), exact[2 * i + 1], tolerance[i] * PetscAbsReal(exact[2 * i + 1]));
  }
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(BoundaryFree(&given));
}
END_TEST

static void CheckComplex(PetscComplex z, PetscReal re, PetscReal im)
{
  ck_assert_double_eq_tol(PetscRealPartComplex(z), re, 2e-14);
  ck_assert_double_eq_tol(PetscImaginaryPartComplex(z), im, 2e-14);
}

/* 40-digit quadrature, except on the element itself: closed form */
START_TEST(element_integrals_match_their_quadrature)
{
  FembemElement   e;
  FembemIntegrals v;

  FembemElementSet(&e, PetscCMPLX(0.2, 0.1), PetscCMPLX(1., 0.7));
  FembemElementIntegrate(&e, 1, PetscCMPLX(0.5, 0.9), PETSC_FALSE, &v);
  CheckComplex(v.E[0], -.461581805580959, 1.549060619953104);
  CheckComplex(PetscCMPLX(v.P[0], 0.5 * (v.P[0] + v.P[1])), -.574030392804091, -.335613062695817);
  CheckComplex(v.Q[0], -.526707066389022, -.289226866424926);
  CheckComplex(0.5 * (v.Q[0] + v.Q[1]), -.132273446355562, -.305958093286997);
  FembemElementIntegrate(&e, 1, PetscCMPLX(0.6, 0.4), PETSC_TRUE, &v);
  CheckComplex(v.E[0], 0., PETSC_PI);
  CheckComplex(PetscCMPLX(v.P[0], 0.5 * (v.P[0] + v.P[1])), -1.693147180559945, -.846573590279973);
  CheckComplex(v.Q[0], .28, .96);
  CheckComplex(0.5 * (v.Q[0] + v.Q[1]), .14, .48);
  FembemElementIntegrate(&e, 1, 3., PETSC_FALSE, &v);
  CheckComplex(v.E[0], -.279330415020077, -.300975706707403);
  CheckComplex(PetscCMPLX(v.P[0], 0.5 * (v.P[0] + v.P[1])), .889583899425878, .421364752321117);
  CheckComplex(v.Q[0], .927271681905027, -.332365165149445);
  CheckComplex(0.5 * (v.Q[0] + v.Q[1]), .446414957215982, -.212557899872941);
}
END_TEST

/* A point near the start of an element, and all of it turned to 3 + 4i, coordinates exact: its distance must be taken from that end */
START_TEST(an_inclined_element_keeps_the_digits_near_its_ends)
{
  const PetscReal      along = ldexp(1., -44), off = ldexp(1., -56);
  const FembemMaterial mat    = {.mu = 0.4, .kappa = 1.8};
  const PetscComplex   z[2]   = {PetscCMPLX(5. * along, 5. * off), PetscCMPLX(3. * along - 4. * off, 4. * along + 3. * off)};
  PetscComplex         phi[2] = {0., 0.}, S[2] = {0., 0.};
  FembemIntegrals      v[2];
  FembemBasis          linear;

  CkOk(FembemBasisSet(1, &linear));
  for (PetscInt k = 0; k < 2; ++k) {
    const PetscComplex b = k ? PetscCMPLX(3., 4.) : 5., u[2] = {0., 0.}, T[2] = {b, 0.5 * b};
    FembemSource       s;

    FembemSourceSet(&s, &linear, 0., b, u, T, mat);
    FembemSourceAdd(&s, z[k], &phi[k], &S[k]);
    FembemElementIntegrate(&s.e, 1, z[k], PETSC_FALSE, &v[k]);
  }
  ck_assert_double_eq_tol(PetscAbsComplex(v[0].E[0] - v[1].E[0]), 0., 1e-13);
  ck_assert_double_eq_tol(PetscAbsComplex(v[0].E[1] - v[1].E[1]), 0., 1e-13);
  ck_assert_double_eq_tol(PetscAbsComplex(phi[0] - phi[1]), 0., 1e-12);
}
END_TEST

/* The far expansion takes over at 8 lengths: both sides of that distance agree, for the same element seen from two points an ulp apart */
START_TEST(near_and_far_formulas_meet)
{
  const PetscComplex u[2] = {0., PetscCMPLX(.7, .2)}, T[2] = {PetscCMPLX(1., -2.), PetscCMPLX(.3, .4)};
  FembemElement      e;
  FembemIntegrals    v[2];
  FembemBasis        linear;
  FembemSource       source;
  PetscComplex       phi[2] = {0., 0.}, S[2] = {0., 0.};

  FembemElementSet(&e, PetscCMPLX(-0.4, -0.3), PetscCMPLX(0.4, 0.3));
  CkOk(FembemBasisSet(1, &linear));
  FembemSourceSet(&source, &linear, e.a, e.b, u, T, (FembemMaterial){.mu = 0.4, .kappa = 1.8});
  for (PetscInt k = 0; k < 2; ++k) {
    const PetscReal    radius = k ? 8. + 1e-14 : 8. - 1e-14;
    const PetscComplex z      = radius * PetscCMPLX(-0.28, 0.96);

    FembemElementIntegrate(&e, 1, z, PETSC_FALSE, &v[k]);
    FembemSourceAdd(&source, z, &phi[k], &S[k]);
  }
  ck_assert_double_eq_tol(v[0].P[0], v[1].P[0], 1e-11);
  ck_assert_double_eq_tol(v[0].P[1], v[1].P[1], 1e-11);
  ck_assert_double_eq_tol(PetscAbsComplex(v[0].Q[0] - v[1].Q[0]), 0., 1e-11);
  ck_assert_double_eq_tol(PetscAbsComplex(v[0].Q[1] - v[1].Q[1]), 0., 1e-11);
  ck_assert_double_eq_tol(PetscAbsComplex(v[0].E[0] - v[1].E[0]), 0., 1e-11);
  ck_assert_double_eq_tol(PetscAbsComplex(v[0].E[1] - v[1].E[1]), 0., 1e-11);
  ck_assert_double_eq_tol(PetscAbsComplex(phi[0] - phi[1]), 0., 1e-11);
  ck_assert_double_eq_tol(PetscAbsComplex(S[0] - S[1]), 0., 1e-11);
}
END_TEST

START_TEST(a_rigid_motion_has_no_stress)
{
  const PetscReal lo[2] = {-1., 0.}, hi[2] = {1., 1.}, x[4] = {.1, .3, .99, 1e-3};
  const PetscInt  m[4] = {5, 3, 9, 4};
  PetscReal       s[6], worst = 0.;
  AbutBoundary    given;
  FembemBoundary  b;
  PetscMPIInt     size;

  CkOk(BoundaryCreateBox(lo, hi, m, PETSC_FALSE, 1, &given));
  for (PetscInt i = 0; i < given.n; ++i) {
    given.u[2 * i]     = .4 - .7 * given.x[2 * i + 1];
    given.u[2 * i + 1] = -.3 + .7 * given.x[2 * i];
  }
  CkOk(FembemBoundaryCreate(PETSC_COMM_SELF, &given, 1., 0.3, &b));
  Evaluate(&b, 0., 2, x, s);
  for (PetscInt i = 0; i < 6; ++i) {
    ck_assert_double_eq_tol(s[i], 0., 1e-14);
    worst = PetscMax(worst, PetscAbsReal(s[i]));
  }
  CkOk(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  if (size == 1) CkCase("V15", "stress of a rigid motion of size 1, E 1", worst, 1e-12);
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(BoundaryFree(&given));
}
END_TEST

/* Inside, in the hole, outside */
START_TEST(a_uniform_stress_is_exact_inside_and_zero_outside)
{
  const Field             field = {2., .25, UniformStress, UniformDisplacement};
  const PetscReal         lo[2] = {0., 0.}, hi[2] = {1., 1.}, x[6] = {.2, .7, .4, .5, 1.3, .2};
  const PetscInt          m[4]               = {7, 2, 5, 3};
  const AbutConditionType given_traction[16] = {ABUT_TRACTION};
  PetscReal               s[9];
  AbutBoundary            given;
  FembemBoundary          b;

  CkOk(BoundaryCreateBox(lo, hi, m, PETSC_TRUE, 1, &given));
  BoundaryFill(&field, given_traction, &given);
  CkOk(FembemBoundaryCreate(PETSC_COMM_SELF, &given, field.young, field.poisson, &b));
  Evaluate(&b, 0., 3, x, s);
  for (PetscInt i = 0; i < 9; ++i) ck_assert_double_eq_tol(s[i], i < 3 ? uniform_stress[i] : 0., 5e-15);
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(BoundaryFree(&given));
}
END_TEST

/* Random tractions on a unit box graded to its corners; points everywhere, also very near the boundary */
static void TreeAgainstDirect(PetscInt order, PetscInt side, PetscReal tolerance, PetscReal bound)
{
  const PetscReal lo[2] = {0., 0.}, hi[2] = {4., 1.};
  const PetscInt  m[4] = {side, side / 4, side, side / 4}, n = 2000;
  PetscReal      *x, *s[2], error = 0., largest = 0.;
  PetscLogDouble  time[3];
  AbutBoundary    given;
  FembemBoundary  b;
  PetscRandom     random;

  CkOk(BoundaryCreateBox(lo, hi, m, PETSC_FALSE, order, &given));
  CkOk(PetscMalloc3(2 * n, &x, 3 * n, &s[0], 3 * n, &s[1]));
  CkOk(PetscRandomCreate(PETSC_COMM_SELF, &random));
  CkOk(PetscRandomSetInterval(random, 0., 1.));
  for (PetscInt i = 0; i < 2 * (order + 1) * given.n; ++i) CkOk(PetscRandomGetValue(random, &given.traction[i]));
  for (PetscInt i = 0; i < 2 * given.nnodes; ++i) given.u[i] = PetscSinReal(given.x[i]);
  for (PetscInt i = 0; i < 2 * n; ++i) {
    CkOk(PetscRandomGetValue(random, &x[i]));
    x[i] *= hi[i % 2];
    if (i % 20 == 1) x[i] *= 1e-4;
  }
  CkOk(FembemBoundaryCreate(PETSC_COMM_SELF, &given, 1., 0.3, &b));
  CkOk(PetscTime(&time[0]));
  Evaluate(&b, tolerance, n, x, s[0]);
  CkOk(PetscTime(&time[1]));
  Evaluate(&b, 0., n, x, s[1]);
  CkOk(PetscTime(&time[2]));
  for (PetscInt i = 0; i < 3 * n; ++i) {
    error   = PetscMax(error, PetscAbsReal(s[0][i] - s[1][i]));
    largest = PetscMax(largest, PetscAbsReal(s[1][i]));
  }
  CkOk(PetscPrintf(PETSC_COMM_WORLD,
                   "%5" PetscInt_FMT " elements of order %" PetscInt_FMT
                   ", tolerance %g: error %.1e; treecode with its build %.2f us a point, direct %.2f\n",
                   given.n, order, (double)tolerance, (double)(error / largest), (time[1] - time[0]) / n * 1e6,
                   (time[2] - time[1]) / n * 1e6));
  ck_assert_double_lt(error, bound * largest);
  CkOk(PetscRandomDestroy(&random));
  CkOk(PetscFree3(x, s[0], s[1]));
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(BoundaryFree(&given));
}

START_TEST(the_treecode_keeps_its_tolerance)
{
  TreeAgainstDirect(_i, 32, 1e-4, 2e-4);
  TreeAgainstDirect(_i, 60, 1e-4, 2e-4);
  TreeAgainstDirect(_i, 120, 1e-4, 2e-4);
  TreeAgainstDirect(_i, 120, 4e-9, 1e-8);
  TreeAgainstDirect(_i, 400, 1e-4, 2e-4);
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("fembem_kernels");
  TCase *tests = tcase_create("kernels");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  tcase_add_test(tests, stresses_are_those_of_kelvins_kernels_at_any_distance);
  tcase_add_test(tests, displacements_are_those_of_kelvins_kernels_at_any_distance);
  tcase_add_test(tests, element_integrals_match_their_quadrature);
  tcase_add_test(tests, an_inclined_element_keeps_the_digits_near_its_ends);
  tcase_add_test(tests, near_and_far_formulas_meet);
  tcase_add_test(tests, a_rigid_motion_has_no_stress);
  tcase_add_test(tests, a_uniform_stress_is_exact_inside_and_zero_outside);
  tcase_add_loop_test(tests, the_treecode_keeps_its_tolerance, 1, ABUT_ORDER_MAX + 1);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
