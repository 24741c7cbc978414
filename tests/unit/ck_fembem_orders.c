#include <petsctime.h>
#include "ckbody.h"
#include "fembem_boundaries.h"

/* estimator_fembem with displacements and tractions of orders 1 to 4: the kernels, the treecode, tractions from nodal forces */

static PetscReal Any(PetscInt i, PetscInt modulus, PetscReal scale, PetscReal shift)
{
  return (PetscReal)(i % modulus) / scale - shift;
}

/* One element a side of [0,2]x[0,1], displacements and tractions of no solution: Somigliana's identity as an integral. All values: 40-digit
   quadrature (mpmath) of Kelvin's kernels as C. A. Brebbia prints them, after which the same programme gives the values of order 1 in
   ck_fembem_kernels.c; E = 1, Poisson's ratio 0.3 */
START_TEST(stresses_are_those_of_kelvins_kernels_at_any_distance)
{
  static const PetscReal corner[8] = {0., 0., 2., 0., 2., 1., 0., 1.};
  static const PetscReal x[14]     = {.7, .3, 1., 1e-6, 1e-6, 1e-6, 1.9999999, .5, 3., 2., 200., 100., -2000., 300.};
  static const PetscReal exact[63] = {5.3838774569368475e-01,  -4.7762345887218438e-01, 1.0765995166364610e-01,  4.7719779812638402e-01,
                                      -5.4865350258033141e-01, -7.4280107613516860e-02, 1.6193166534940260e+00,  2.2439941146274780e+00,
                                      5.9511126820469169e+00,  8.0952613528924444e-01,  1.5688152913469380e+00,  3.8554460362981369e-01,
                                      4.8745636239831920e-02,  -3.4443613959714382e-02, 1.4729920769707749e-02,  6.0795370885656302e-04,
                                      -2.5561147164700639e-06, 3.0092108717845928e-04,  -8.7288507160813774e-05, 1.3208561164062641e-05,
                                      1.3046564294831110e-05,  5.6359526147289352e-01,  -3.0171155725172683e-01, -1.6127561683893279e-01,
                                      2.0431884108750931e-01,  1.7612258622862581e-01,  -3.8717134914517942e-01, 1.7091236367772840e+00,
                                      7.4925566167169748e+00,  7.0837593420288831e+00,  -4.7449650891215678e-01, -1.5669439521559221e+00,
                                      3.6206089935763819e-01,  -1.2013187477730520e-02, 3.3746044568101717e-05,  1.5083629151015359e-02,
                                      -3.6164106167996778e-04, 1.1288904585362180e-04,  -3.7639915082859568e-05, 8.4424328907443317e-05,
                                      -9.2626243077252663e-06, -2.6818608815193951e-05, 9.3690787744953125e-02,  2.2000990424826200e-01,
                                      -4.8511014238102629e-01, 5.9272212407582370e-01,  1.0235678496160590e+00,  -6.2763098330296460e-02,
                                      8.7601875471120323e+00,  6.7325623998087440e+00,  -1.8625910634770579e+00, 4.5570743273327580e-01,
                                      2.2653124797967288e+00,  -1.6987608992770359e-01, 1.0070844220594490e-02,  2.4669062187923599e-02,
                                      3.5986684641970301e-02,  -1.8165889908365669e-04, 1.0121566326230490e-04,  3.5449045534937161e-05,
                                      5.4950421167538379e-05,  -5.2001273797552466e-06, -2.0728844166550090e-05};
  const PetscInt         p         = _i;
  AbutBoundary           given;
  FembemBoundary         b;
  FembemStress           stress;
  PetscReal              s[21];

  CkOk(BoundaryAllocate(4, 1, p, &given));
  for (PetscInt i = 0; i < 8; ++i) given.x[2 * p * (i / 2) + i % 2] = corner[i];
  CkOk(BoundaryPlaceNodes(&given));
  for (PetscInt j = 0; j < 4 * p; ++j) {
    given.u[2 * j]     = Any(7 * j, 11, 8., 0.5);
    given.u[2 * j + 1] = Any(5 * j + 3, 13, 8., 0.75);
  }
  for (PetscInt j = 0; j < 4 * (p + 1); ++j) {
    given.traction[2 * j]     = Any(3 * j, 7, 4., 0.75);
    given.traction[2 * j + 1] = Any(4 * j + 1, 9, 4., 1.);
  }
  CkOk(FembemBoundaryCreate(PETSC_COMM_SELF, &given, 1., 0.3, &b));
  CkOk(FembemStressCreate(&b, 0., &stress));
  CkOk(FembemStressEvaluate(stress, 7, x, s));
  for (PetscInt i = 0; i < 21; ++i) {
    const PetscReal *e = &exact[21 * (p - 2) + 3 * (i / 3)], size = PetscAbsReal(e[0]) + PetscAbsReal(e[1]) + PetscAbsReal(e[2]);

    ck_assert_double_eq_tol(s[i], e[i % 3], (i < 15 ? 1e-12 : 1e-11) * size);
  }
  CkOk(FembemStressDestroy(&stress));
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(BoundaryFree(&given));
}
END_TEST

/* What is summed by Gauss's rule: the two integrals of a source, and those of each of Legendre's polynomials */
typedef struct {
  PetscComplex    phi, S;
  FembemIntegrals v;
} Sums;

/* Of an element from -(3+4i) to 3+4i at z = (3+4i) (x + i y), on parts that grow from the foot of z */
static void Quadrature(const FembemSource *s, PetscReal x, PetscReal y, Sums *sums)
{
  const PetscComplex half = 0.5 * s->e.t;
  const PetscReal    foot = PetscMax(-1., PetscMin(1., x)), first = PetscMax(PetscAbsReal(x - foot), PetscAbsReal(y));
  PetscReal          g[20], w[20], P[ABUT_SIDE_NODES_MAX];

  CkOk(PetscDTGaussQuadrature(20, 0., 1., g, w));
  CkOk(PetscMemzero(sums, sizeof(*sums)));
  for (PetscInt side = -1; side < 2; side += 2) {
    for (PetscReal from = 0., to = 0.5 * first; from < 1. - side * foot; from = to, to *= 2.) {
      const PetscReal size = PetscMin(to, 1. - side * foot) - from;

      for (PetscInt i = 0; i < 20; ++i) {
        const PetscReal    r = from + g[i] * size, ds = 5. * w[i] * size;
        const PetscComplex v = half * PetscCMPLX(foot - x + side * r, -y), dt = half * w[i] * size;

        FembemLegendreP(s->order, foot + side * r, P);
        for (PetscInt n = 0; n <= s->order; ++n) {
          sums->phi += s->p[n] * P[n] * dt / v;
          sums->S += (s->q[n] - PetscConjComplex(v) / v * s->p[n]) * P[n] * dt / v;
          sums->v.E[n] += P[n] * dt / v;
          sums->v.P[n] += P[n] * ds * PetscLogReal(PetscAbsComplex(v));
          sums->v.Q[n] += P[n] * ds * v / PetscConjComplex(v);
        }
      }
    }
  }
}

/* The largest difference of the integrals, relative to how large the first one is or would be with an absolute value inside */
static PetscReal Difference(PetscInt order, const FembemIntegrals *v, const FembemIntegrals *exact)
{
  PetscReal worst = 0.;

  for (PetscInt n = 0; n <= order; ++n) {
    worst = PetscMax(worst, PetscAbsComplex(v->E[n] - exact->E[n]) / PetscAbsComplex(exact->E[0]));
    worst = PetscMax(worst, PetscAbsReal(v->P[n] - exact->P[n]) / (10. + PetscAbsReal(exact->P[0])));
    worst = PetscMax(worst, PetscAbsComplex(v->Q[n] - exact->Q[n]) / 10.);
  }
  return worst;
}

/* From 1e-9 to 1e3 lengths, at points abreast of the element, round its ends and behind them */
START_TEST(no_digit_is_lost_at_any_distance)
{
  const PetscReal from[4] = {0.25, 1., -1., 1.}, along[4] = {0., 0., -1., 1.}, off[4] = {1., -1., 0., 0.5};
  FembemSource    s        = {.order = _i};
  PetscReal       worst[2] = {0., 0.};

  FembemElementSet(&s.e, PetscCMPLX(-3., -4.), PetscCMPLX(3., 4.));
  for (PetscInt n = 0; n <= _i; ++n) {
    s.p[n] = PetscCMPLX(Any(5 * n, 7, 4., 0.6), Any(3 * n + 1, 5, 4., 0.7));
    s.q[n] = PetscCMPLX(Any(3 * n + 2, 7, 3., 0.8), Any(2 * n, 5, 3., 0.4));
  }
  for (PetscInt k = 0; k < 4; ++k)
    for (PetscInt i = -28; i <= 11; ++i)
      for (PetscReal eighth = 1.; eighth < 2.; eighth += 0.125) {
        const PetscReal    r = eighth * ldexp(1., i), x = from[k] + along[k] * r, y = off[k] * r;
        const PetscComplex z = PetscCMPLX(3. * x - 4. * y, 4. * x + 3. * y); /* without round-off */
        Sums               sums =
               {
                 0., 0., {{0.}, {0.}, {0.}}
        },
             exact;

        Quadrature(&s, x, y, &exact);
        FembemSourceAdd(&s, z, &sums.phi, &sums.S);
        FembemElementIntegrate(&s.e, _i, z, PETSC_FALSE, &sums.v);
        worst[0] = PetscMax(worst[0], PetscMax(PetscAbsComplex(sums.phi - exact.phi), PetscAbsComplex(sums.S - exact.S)) /
                                        PetscAbsComplex(exact.phi));
        worst[1] = PetscMax(worst[1], Difference(_i, &sums.v, &exact.v));
      }
  CkOk(PetscPrintf(PETSC_COMM_WORLD, "order %" PetscInt_FMT ": largest error %.1e, of single integrals %.1e\n", _i, (double)worst[0],
                   (double)worst[1]));
  ck_assert_double_lt(worst[0], _i == 1 ? 1e-11 : 1e-12);
  ck_assert_double_lt(worst[1], _i == 1 ? 1e-11 : 1e-12);
}
END_TEST

/* On the element itself: the limit from its left, where the body is, is that of points nearby */
START_TEST(integrals_on_the_element_are_limits_from_inside)
{
  const PetscReal tiny = ldexp(1., -40);
  FembemElement   e;
  FembemIntegrals own, near;

  FembemElementSet(&e, PetscCMPLX(-3., -4.), PetscCMPLX(3., 4.));
  for (PetscReal x = -0.875; x < 1.; x += 0.25) {
    FembemElementIntegrate(&e, _i, x * PetscCMPLX(3., 4.), PETSC_TRUE, &own);
    FembemElementIntegrate(&e, _i, PetscCMPLX(x, tiny) * PetscCMPLX(3., 4.), PETSC_FALSE, &near);
    ck_assert_double_lt(Difference(_i, &own, &near), 1e-10);
  }
}
END_TEST

/* Q_n(z) = n!/(2n+1)!! z^(-n-1) F((n+1)/2, (n+2)/2; n+3/2; 1/z^2) for |z| > 1 (Abramowitz and Stegun, 8.1.3): each one for itself, while
   a sum of them would hide that the last ones are wrong */
START_TEST(legendre_s_functions_are_those_of_the_hypergeometric_series)
{
  PetscReal worst = 0.;

  for (PetscInt i = 0; i < 400; ++i) {
    const PetscReal    r = 1.1 * PetscPowReal(1.02, i);
    const PetscComplex z = r * PetscExpComplex(PetscCMPLX(0., 0.7 * i)), v = 1. / (z * z);
    PetscComplex       Q[5], scale                                         = 1. / z;
    FembemElement      e;

    FembemElementSet(&e, -1., 1.);
    FembemLegendreQ(4, &e, -1. - z, 1. - z, PETSC_FALSE, Q);
    for (PetscInt n = 0; n < 5; ++n, scale *= n / (2. * n + 1.) / z) {
      PetscComplex term = scale, sum = 0.;

      for (PetscInt k = 0; PetscAbsComplex(term) > 1e-17 * PetscAbsComplex(sum); ++k) {
        sum += term;
        term *= (0.5 * (n + 1.) + k) * (0.5 * (n + 2.) + k) / ((n + 1.5 + k) * (k + 1.)) * v;
      }
      worst = PetscMax(worst, PetscAbsComplex(Q[n] / sum - 1.));
    }
  }
  CkOk(PetscPrintf(PETSC_COMM_WORLD, "Legendre's functions: largest relative error %.1e\n", (double)worst));
  ck_assert_double_lt(worst, 1e-12);
}
END_TEST

/* Everything held as nodal forces or given: u and t of a polynomial field are what they should be, and so is the stress */
static PetscReal StressError(PetscInt order, PetscInt degree, PetscReal tolerance)
{
  const Field             field = {2., .25, PolynomialStress, PolynomialDisplacement};
  const PetscReal         lo[2] = {0., 0.}, hi[2] = {1., 1.}, x[6] = {.2, .7, .99, .03, .4, .5};
  const PetscInt          m[4]               = {7, 2, 5, 3};
  const AbutConditionType given_traction[16] = {ABUT_TRACTION};
  PetscReal               s[9], exact[3], error = 0., largest = 0.;
  AbutBoundary            given;
  FembemBoundary          b;
  FembemStress            stress;

  polynomial_degree = degree;
  CkOk(BoundaryCreateBox(lo, hi, m, PETSC_TRUE, order, &given));
  BoundaryFill(&field, given_traction, &given);
  CkOk(FembemBoundaryCreate(PETSC_COMM_SELF, &given, field.young, field.poisson, &b));
  CkOk(FembemStressCreate(&b, tolerance, &stress));
  CkOk(FembemStressEvaluate(stress, 3, x, s));
  for (PetscInt i = 0; i < 9; ++i) { /* the last point is in the hole: no stress */
    if (i % 3 == 0) PolynomialStress(x + 2 * (i / 3), exact);
    error   = PetscMax(error, PetscAbsReal(s[i] - (i < 6 ? exact[i % 3] : 0.)));
    largest = PetscMax(largest, PetscAbsReal(exact[i % 3]));
  }
  CkOk(FembemStressDestroy(&stress));
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(BoundaryFree(&given));
  return error / largest;
}

/* One rank says it for all */
static void Say(const char name[], const char criterion[], PetscReal measured, PetscReal most)
{
  PetscMPIInt size;

  CkOk(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  if (size == 1) CkCase(name, criterion, measured, most);
  ck_assert_double_le(measured, most);
}

START_TEST(fields_up_to_the_order_are_exact)
{
  static PetscReal worst = 0.;

  for (PetscInt degree = 1; degree < 6; ++degree) {
    const PetscReal error = StressError(_i, degree, 0.);

    CkOk(PetscPrintf(PETSC_COMM_WORLD, "order %" PetscInt_FMT ", field of degree %" PetscInt_FMT ": error %.1e\n", _i, degree,
                     (double)error));
    if (degree <= _i) {
      ck_assert_double_lt(error, 1e-13);
      worst = PetscMax(worst, error);
    } else ck_assert_double_gt(error, 1e-7);
  }
  if (_i == ABUT_ORDER_MAX) Say("V15", "constant to cubic stresses inside, orders 1 to 4", worst, 1e-10);
}
END_TEST

/* The largest error of the stress, relative, at distances from 1e-1 to 1e-8 of the element abreast of its middle, on the diagonal of a
   corner, and beside elements 100 times as small; at nodes it is that of a point beside them */
START_TEST(the_stress_is_exact_up_to_the_boundary_and_a_number_on_it)
{
  const Field             field = {2., .25, PolynomialStress, PolynomialDisplacement};
  const PetscReal         lo[2] = {0., 0.}, hi[2] = {1., 1.};
  const PetscInt          m[4]               = {1, 100, 2, 5};
  const AbutConditionType given_traction[16] = {ABUT_TRACTION};
  static PetscReal        worst[3]           = {0., 0., 0.};
  static PetscInt         bad                = 0;
  PetscReal               largest            = 0., small, end;
  AbutBoundary            given;
  FembemBoundary          b;
  FembemStress            stress;

  polynomial_degree = _i;
  CkOk(BoundaryCreateBox(lo, hi, m, PETSC_FALSE, _i, &given));
  BoundaryFill(&field, given_traction, &given);
  CkOk(FembemBoundaryCreate(PETSC_COMM_SELF, &given, field.young, field.poisson, &b));
  CkOk(FembemStressCreate(&b, 0., &stress));
  small = PetscImaginaryPartComplex(FembemStart(&b, 2)); /* the first element of the right side */
  end   = PetscRealPartComplex(FembemStart(&b, 102));    /* where the upper side has a node */
  ck_assert_double_lt(100. * small, 1.);
  for (PetscInt k = 1; k <= 8; ++k) {
    const PetscReal d    = PetscPowReal(10., (PetscReal)-k);
    const PetscReal x[8] = {.3, d, 1. - d * small, d * small, 1. - d * small, .5 * small, .7, d * small};
    PetscReal       s[12], exact[3];

    CkOk(FembemStressEvaluate(stress, 4, x, s));
    for (PetscInt i = 0; i < 12; ++i) {
      if (i % 3 == 0) PolynomialStress(x + 2 * (i / 3), exact);
      largest = PetscMax(largest, PetscAbsReal(exact[i % 3]));
      bad += PetscIsInfOrNanReal(s[i]);
      worst[0] = PetscMax(worst[0], k > 2 ? 0. : PetscAbsReal(s[i] - exact[i % 3]) / largest);
      worst[1] = PetscMax(worst[1], PetscAbsReal(s[i] - exact[i % 3]) / largest);
    }
  }
  {
    const PetscReal x[14] = {.3, 0., 1., .5 * small, .5 * (1. + end), 1., 0., .999, 1., small, 1., 1., 0., 0.};
    PetscReal       s[21], exact[3];

    CkOk(FembemStressEvaluate(stress, 7, x, s));
    for (PetscInt i = 0; i < 21; ++i) {
      bad += PetscIsInfOrNanReal(s[i]);
      if (i < 12) continue; /* nodes: between a short and a long element, and corners */
      if (i % 3 == 0) PolynomialStress(x + 2 * (i / 3), exact);
      worst[2] = PetscMax(worst[2], PetscAbsReal(s[i] - exact[i % 3]) / largest);
    }
  }
  CkOk(FembemStressDestroy(&stress));
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(BoundaryFree(&given));
  CkOk(PetscPrintf(PETSC_COMM_WORLD, "order %" PetscInt_FMT ": up to a hundredth %.1e, up to 1e-8 %.1e, %" PetscInt_FMT " not finite\n", _i,
                   (double)worst[0], (double)worst[1], bad));
  if (_i < ABUT_ORDER_MAX) return;
  Say("V15", "the same stresses up to a hundredth of an element from the boundary", worst[0], 1e-6);
  Say("H20", "error of the stress 1e-1 to 1e-8 h from edges, corners, 100:1 elements", worst[1], 1e-6);
  Say("H20", "values of the stress there, on edges, nodes and corners not finite", bad, 0.);
  Say("H20", "error of the stress at nodes and corners", worst[2], 1e-5);
}
END_TEST

static void HertzStress(const PetscReal x[2], PetscReal s[3])
{
  const CkField hertz = {.at = CkHertz, .young = CK_YOUNG, .poisson = CK_POISSON};
  PetscReal     u[2];

  CkHertz(&hertz, x, u, s);
}

static void HertzDisplacement(PetscReal young, PetscReal poisson, const PetscReal x[2], PetscReal u[2])
{
  const CkField hertz = {.at = CkHertz, .young = young, .poisson = poisson};
  PetscReal     s[3];

  CkHertz(&hertz, x, u, s);
}

/* Displacements and forces on the sides of Hertz' box, elements of order 1; its pressure is like a root at 1/2, a node */
static PetscReal HertzError(PetscInt n)
{
  const Field       field = {CK_YOUNG, CK_POISSON, HertzStress, HertzDisplacement};
  const PetscReal   x[8]  = {.5, -1., 1.3, -.4, .2, -1.7, .5, -.4};
  AbutConditionType held[16];
  PetscReal         s[12], exact[3], error = 0., largest = 0.;
  AbutBoundary      given;
  FembemBoundary    b;
  FembemStress      stress;

  BoundaryConditions("uuuuuuuutttttttt", held);
  CkOk(BoundaryAllocate(4 * n, 1, 1, &given));
  for (PetscInt i = 0; i < 4 * n; ++i) {
    const PetscReal at = 2. * (i % n) / n, end[4][2] = {
                                             {at,      -2.    },
                                             {2.,      at - 2.},
                                             {2. - at, 0.     },
                                             {0.,      -at    }
    };

    for (PetscInt d = 0; d < 2; ++d) given.x[2 * i + d] = end[i / n][d];
    given.side[i] = i / n;
  }
  BoundaryFill(&field, held, &given);
  CkOk(FembemBoundaryCreate(PETSC_COMM_SELF, &given, CK_YOUNG, CK_POISSON, &b));
  CkOk(FembemRecoverTractions(&b));
  CkOk(FembemStressCreate(&b, 0., &stress));
  CkOk(FembemStressEvaluate(stress, 4, x, s));
  for (PetscInt i = 0; i < 12; ++i) {
    if (i % 3 == 0) HertzStress(x + 2 * (i / 3), exact);
    error   = PetscMax(error, PetscAbsReal(s[i] - exact[i % 3]));
    largest = PetscMax(largest, PetscAbsReal(exact[i % 3]));
  }
  CkOk(FembemStressDestroy(&stress));
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(BoundaryFree(&given));
  return error / largest;
}

START_TEST(the_stress_of_hertz_box_converges_at_least_with_order_2)
{
  PetscReal error[4];

  for (PetscInt k = 0; k < 4; ++k) error[k] = HertzError(16 << k);
  for (PetscInt k = 1; k < 4; ++k)
    CkOk(PetscPrintf(PETSC_COMM_WORLD, "Hertz' box: %.2e %.2e, order %.4f\n", (double)error[k - 1], (double)error[k],
                     (double)PetscLog2Real(error[k - 1] / error[k])));
  Say("V15", "2 less the order of the stress inside Hertz' box, 16 to 128 a side", 2. - PetscLog2Real(error[0] / error[3]) / 3., 0.);
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("fembem_orders");
  TCase *tests = tcase_create("orders");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  tcase_add_loop_test(tests, stresses_are_those_of_kelvins_kernels_at_any_distance, 2, ABUT_ORDER_MAX + 1);
  tcase_add_loop_test(tests, no_digit_is_lost_at_any_distance, 1, ABUT_ORDER_MAX + 1);
  tcase_add_loop_test(tests, integrals_on_the_element_are_limits_from_inside, 1, ABUT_ORDER_MAX + 1);
  tcase_add_test(tests, legendre_s_functions_are_those_of_the_hypergeometric_series);
  tcase_add_loop_test(tests, fields_up_to_the_order_are_exact, 1, ABUT_ORDER_MAX + 1);
  tcase_add_loop_test(tests, the_stress_is_exact_up_to_the_boundary_and_a_number_on_it, 1, ABUT_ORDER_MAX + 1);
  tcase_add_test(tests, the_stress_of_hertz_box_converges_at_least_with_order_2);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
