#include "ckbody.h"
#include <abutpair.h>
#include <petscdt.h>

/* The edges of a contact and its peaks, from traces whose penetration is known. The meshes match, so that the averaged penetration of a
   node is that of the trace at the node, up to order 4. */

#define LENGTH 4.

typedef struct {
  AbutBody         body[2];
  AbutPair         pair;
  PetscInt         n;
  const PetscReal *x; /* [2*n] nodes of the pressure side, from x = 4 to 0 or back */
  PetscReal       *u[2], *p;
} Contact;

static Contact Make(PetscInt order, PetscReal theta, const char pressures[])
{
  static CkField   field[2]; /* bodies refer to it */
  Contact          c;
  char             text[256];
  PetscInt         which, n[2];
  const PetscReal *D;

  for (PetscInt b = 0; b < 2; ++b) {
    field[b]  = (CkField){.at = CkLinear, .order = order};
    c.body[b] = CkBodyOn(PETSC_COMM_WORLD, b ? "upper" : "lower", &field[b], 0., b, LENGTH, b + 1., 32, 2, ABUT_QUAD);
    CkGive(c.body[b], &field[b], b ? "top" : "bottom", "uu");
  }
  CkOk(PetscSNPrintf(text, sizeof(text),
                     "-mid_pair_bodies upper,lower -mid_pair_sides bottom,top -mid_pair_theta %g -mid_pair_pressure_side %s", (double)theta,
                     pressures));
  CkOptions(text);
  CkOk(AbutPairCreate(PETSC_COMM_WORLD, "mid", &c.pair));
  CkOk(AbutPairSetFromOptions(c.pair, 2, c.body));
  CkOptionsEnd();
  CkOk(AbutPairSetUp(c.pair));
  CkOk(AbutPairGetPressureNodes(c.pair, &which, &c.n, &c.x, &D));
  CkOk(AbutPairGetSizes(c.pair, n));
  for (PetscInt s = 0; s < 2; ++s) CkOk(PetscCalloc1(n[s], &c.u[s]));
  CkOk(PetscCalloc1(c.n, &c.p));
  return c;
}

static void Destroy(Contact *c)
{
  for (PetscInt s = 0; s < 2; ++s) CkOk(PetscFree(c->u[s]));
  CkOk(PetscFree(c->p));
  CkOk(AbutPairDestroy(&c->pair));
  for (PetscInt b = 0; b < 2; ++b) CkOk(AbutBodyDestroy(&c->body[b]));
}

/* Distance into the contact of [from[k], to[k]], k < m; below 0 outside */
static PetscReal Inside(PetscReal x, PetscInt m, const PetscReal from[], const PetscReal to[])
{
  PetscReal s = PETSC_MIN_REAL;

  for (PetscInt k = 0; k < m; ++k) s = PetscMax(s, PetscMin(x - from[k], to[k] - x));
  return s;
}

/* The edges of these contacts, ascending; theta = 0: the gap opens as s^(3/2), else the penetration is a straight line */
static PetscInt Edges(Contact *c, PetscReal theta, PetscInt which, PetscInt m, const PetscReal from[], const PetscReal to[],
                      PetscReal edge[])
{
  PetscReal x[16][2];
  PetscInt  n;

  for (PetscInt i = 0; i < c->n; ++i) {
    const PetscReal s = Inside(c->x[2 * i], m, from, to);

    c->u[which][i] = theta > 0. ? 1e-3 * s : (s < 0. ? -2e-3 * PetscPowReal(-s, 1.5) : 0.);
    c->p[i]        = PetscMax(0., s);
  }
  CkOk(AbutPairGetEdges(c->pair, c->u[0], c->u[1], c->p, 16, &n, x));
  for (PetscInt i = 0; i < n; ++i) {
    ck_assert_double_eq_tol(x[i][1], 1., 1e-14);
    edge[i] = x[i][0];
  }
  CkOk(PetscSortReal(n, edge));
  return n;
}

START_TEST(edges_are_found_where_they_are)
{
  const PetscReal from[] = {-1., 1.9, 3.17}, to[] = {0.61, 2.2, 5.};

  for (PetscInt order = 1; order <= ABUT_ORDER_MAX; ++order)
    for (PetscInt variant = 0; variant < 4; ++variant) {
      const PetscReal theta = variant % 2 ? 1e-6 : 0.;
      const PetscInt  which = variant / 2;
      Contact         c     = Make(order, theta, which ? "second" : "first");
      PetscReal       edge[16];

      /* both ends of the side are in contact, and are no edges */
      ck_assert_int_eq(Edges(&c, theta, which, 3, from, to, edge), 4);
      for (PetscInt k = 0; k < 4; ++k) ck_assert_double_eq_tol(edge[k], k % 2 ? from[k / 2 + 1] : to[k / 2], 1e-10);
      ck_assert_int_eq(Edges(&c, theta, which, 1, from + 1, to + 1, edge), 2);
      ck_assert_double_eq_tol(edge[0], 1.9, 1e-10);
      ck_assert_double_eq_tol(edge[1], 2.2, 1e-10);
      ck_assert_int_eq(Edges(&c, theta, which, 0, from, to, edge), 0);
      Destroy(&c);
    }
}
END_TEST

START_TEST(no_more_edges_than_there_is_room_for)
{
  Contact   c = Make(1, 0., "first");
  PetscReal x[3][2];
  PetscInt  n;

  for (PetscInt i = 0; i < c.n; ++i) c.p[i] = i % 2; /* every other node is closed, none at an end: the last closed node is the edge */
  CkOk(AbutPairGetEdges(c.pair, c.u[0], c.u[1], c.p, 3, &n, x));
  ck_assert_int_eq(n, 3);
  ck_assert_double_eq_tol(x[0][0], c.x[2], 1e-14);
  ck_assert_double_eq_tol(x[1][0], c.x[2], 1e-14);
  ck_assert_double_eq_tol(x[2][0], c.x[6], 1e-14);
  Destroy(&c);
}
END_TEST

/* Of the pressure on an element, by Gauss's formula; at order 1 the pressure is c - x^2/20, and its distance from a line in the middle of
   the element h^2/80 */
static PetscReal LastCoefficient(PetscInt order, PetscReal h, const PetscReal q[])
{
  PetscReal z[8], w[8], L, N[ABUT_SIDE_NODES_MAX], sum = 0.;

  if (order == 1) return h * h / 80.;
  CkOk(PetscDTGaussQuadrature(8, -1., 1., z, w));
  for (PetscInt k = 0; k < 8; ++k) {
    CkOk(PetscDTLegendreEval(1, &z[k], 1, &order, &L, NULL, NULL));
    CkOk(AbutEvaluateLobatto(order, z[k], N, NULL));
    for (PetscInt i = 0; i <= order; ++i) sum += (order + 0.5) * w[k] * L * N[i] * q[i];
  }
  return PetscAbsReal(sum);
}

/* The largest value on an element, and where, among many points */
static PetscReal Largest(PetscInt order, const PetscReal q[], PetscReal *at)
{
  PetscReal N[ABUT_SIDE_NODES_MAX], most = -1.;

  for (PetscInt k = 0; k <= 4000; ++k) {
    PetscReal value = 0., s = k / 2000. - 1.;

    CkOk(AbutEvaluateLobatto(order, s, N, NULL));
    for (PetscInt i = 0; i <= order; ++i) value += N[i] * q[i];
    if (value > most) *at = s;
    most = PetscMax(most, value);
  }
  return most;
}

/* Those of the definition, with coefficients by another formula; for a peak inside the side and at both of its ends */
START_TEST(peaks_are_the_elements_of_the_largest_pressure)
{
  const PetscReal tops[] = {2.5, 0., 4.};

  for (PetscInt order = 1; order <= ABUT_ORDER_MAX; ++order)
    for (PetscInt k = 0; k < 6; ++k) {
      Contact   c = Make(order, 0., "first");
      AbutPeak  peak[32];
      PetscReal q[32 * ABUT_ORDER_MAX + 1], largest = 0., tolerance;
      PetscInt  n, found = 0, first = 0;

      for (PetscInt i = 0; i < c.n; ++i) {
        const PetscReal s = c.x[2 * i] - tops[k % 3];

        c.p[i] = 2. - s * s / 20. + (order > 1 ? 0.1 * PetscCosReal(3. * s) : 0.);
      }
      if (order > 1) CkOk(AbutPairRecoverPressure(c.pair, c.p, q));
      else CkOk(PetscArraycpy(q, c.p, c.n));
      for (PetscInt e = 0; e < 32; ++e) {
        PetscReal       at;
        const PetscReal most = Largest(order, q + order * e, &at);

        if (most > largest) first = order * e;
        largest = PetscMax(largest, most);
      }
      tolerance = LastCoefficient(order, LENGTH / 32., q + first) * (k < 3 ? 0.9 : 0.2) / largest;
      CkOk(AbutPairGetPeaks(c.pair, c.p, tolerance, 32, &n, peak));
      for (PetscInt e = 0; e < 32; ++e) {
        const PetscReal last = LastCoefficient(order, LENGTH / 32., q + order * e) / largest;
        const PetscReal from = c.x[2 * order * e], to = c.x[2 * order * (e + 1)];
        PetscReal       at;

        if (Largest(order, q + order * e, &at) < (1. - tolerance) * largest || last <= tolerance) continue;
        ck_assert_int_lt(found, n);
        ck_assert_double_eq_tol(peak[found].x[0], 0.5 * ((1. - at) * from + (1. + at) * to), LENGTH / 32. * 2e-3);
        ck_assert_double_eq_tol(peak[found].x[1], 1., 1e-12);
        ck_assert_double_eq_tol(peak[found].length, LENGTH / 32., 1e-12);
        ck_assert_double_eq_tol(peak[found].last / last, 1., 1e-6);
        ++found;
      }
      ck_assert_int_eq(n, found);
      ck_assert_int_ge(found, 1);
      CkOk(AbutPairGetPeaks(c.pair, c.p, tolerance, 1, &n, peak));
      ck_assert_int_eq(n, 1);
      CkOk(AbutPairGetPeaks(c.pair, c.p, 0.5, 32, &n, peak)); /* all elements hold it, and resolve it */
      ck_assert_int_eq(n, 0);
      CkOk(PetscArrayzero(c.p, c.n));
      CkOk(AbutPairGetPeaks(c.pair, c.p, tolerance, 32, &n, peak));
      ck_assert_int_eq(n, 0);
      Destroy(&c);
    }
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("edges");
  TCase *tests = tcase_create("edges");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  tcase_add_test(tests, edges_are_found_where_they_are);
  tcase_add_test(tests, peaks_are_the_elements_of_the_largest_pressure);
  tcase_add_test(tests, no_more_edges_than_there_is_room_for);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
