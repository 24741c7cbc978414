#include "ck_box.h"
#include "ck_estimate.h"
#include <complex.h>
#undef I
#include <patch.h>
#include <zz.h>

/* The patch recovery against exact stresses. Solutions without body force come from two holomorphic functions (Kolosov and Muskhelishvili):
   2 mu (u1 + i u2) = kappa phi - z conj(phi') - conj(psi), s11 + s22 = 4 Re phi', s22 - s11 + 2 i s12 = 2 (conj(z) phi'' + psi') */

static const PetscReal nu = 0.3; /* and E = 1, as in CkBox() */

typedef double complex Complex;
typedef struct {
  Complex phi, dphi, ddphi, psi, dpsi;
} Potentials;

static Complex Point(const PetscReal x[2])
{
  return x[0] + _Complex_I * x[1];
}

/* Stress linear in x and y: bending */
static Potentials Linear(const PetscReal x[2])
{
  const Complex    z = Point(x), a = 1. + 0.5 * _Complex_I, b = -0.3 + 0.2 * _Complex_I;
  const Potentials p = {a * z * z, 2. * a * z, 2. * a, b * z * z, 2. * b * z};

  return p;
}

static Potentials Smooth(const PetscReal x[2])
{
  const Complex    z = Point(x), e = cexp(1.5 * z), k = 0.7 + 0.4 * _Complex_I;
  const Potentials p = {e, 1.5 * e, 2.25 * e, csin(2. * z) * k, 2. * ccos(2. * z) * k};

  return p;
}

static Potentials (*exact)(const PetscReal[2]);

static PetscErrorCode Displacement1(const PetscReal x[2], PetscReal *value, PETSC_UNUSED void *ctx)
{
  const Potentials p = (*exact)(x);

  *value = creal((3. - 4. * nu) * p.phi - Point(x) * conj(p.dphi) - conj(p.psi)) * (1. + nu);
  return PETSC_SUCCESS;
}

static PetscErrorCode Displacement2(const PetscReal x[2], PetscReal *value, PETSC_UNUSED void *ctx)
{
  const Potentials p = (*exact)(x);

  *value = cimag((3. - 4. * nu) * p.phi - Point(x) * conj(p.dphi) - conj(p.psi)) * (1. + nu);
  return PETSC_SUCCESS;
}

static void ExactStress(const PetscReal x[2], PetscReal s[3])
{
  const Potentials p   = (*exact)(x);
  const Complex    dev = 2. * (conj(Point(x)) * p.ddphi + p.dpsi);

  s[0] = 2. * creal(p.dphi) - 0.5 * creal(dev);
  s[1] = 2. * creal(p.dphi) + 0.5 * creal(dev);
  s[2] = 0.5 * cimag(dev);
}

static PetscReal Distance2(const PetscReal s[3], const PetscReal r[3])
{
  return PetscSqr(s[0] - r[0]) + PetscSqr(s[1] - r[1]) + 2. * PetscSqr(s[2] - r[2]);
}

/* Adds to sum the squares of s_F - s*, s_rec - s*, s_rec - s_F and s* over a cell, at 4x4 points (collapsed to the triangle) */
static void AddCell(AbutBody body, const AbutMeshTopology *t, PetscInt c, const PetscReal nodal[], PetscReal sum[4])
{
  static const PetscReal gx[4]   = {-0.861136311594053, -0.339981043584856, 0.339981043584856, 0.861136311594053};
  static const PetscReal gw[4]   = {0.347854845137454, 0.652145154862546, 0.652145154862546, 0.347854845137454};
  const PetscReal        zero[3] = {0., 0., 0.};
  AbutMesh               mesh;

  CkOk(AbutBodyGetMesh(body, &mesh));
  for (PetscInt q = 0; q < 16; ++q) {
    PetscReal xi[2] = {gx[q % 4], gx[q / 4]}, w = gw[q % 4] * gw[q / 4], x[2], N[4], G[8], det, fe[3], ex[3], rec[3] = {0., 0., 0.};

    if (t->corners == 3) {
      w *= 0.125 * (1. - xi[0]);
      xi[1] = 0.25 * (1. + xi[1]) * (1. - xi[0]);
      xi[0] = 0.5 * (1. + xi[0]);
    }
    CkOk(AbutMeshMapCell(mesh, c, xi, x, N, G, &det));
    CkOk(AbutBodyGetCellStress(body, c, xi, fe));
    ExactStress(x, ex);
    for (PetscInt k = 0; k < t->corners; ++k)
      for (PetscInt i = 0; i < 3; ++i) rec[i] += N[k] * nodal[3 * (t->corners * c + k) + i];
    sum[0] += w * det * Distance2(fe, ex);
    sum[1] += w * det * Distance2(rec, ex);
    sum[2] += w * det * Distance2(rec, fe);
    sum[3] += w * det * Distance2(ex, zero);
  }
}

/* Of a solved body: relative error of the finite elements; saturation constant C, eq. (23) of the paper, and effectivity of the recovery */
static void Measure(AbutBody body, PetscReal *error, PetscReal *C, PetscReal *effectivity)
{
  const AbutMeshTopology *t      = CkTopology(body);
  PetscReal               sum[4] = {0., 0., 0., 0.}, *nodal;

  CkOk(PetscMalloc1(3 * t->nodes * t->ncells, &nodal));
  CkOk(AbutEstimatorRecover_ZZ(body, nodal));
  for (PetscInt c = 0; c < t->ncells; ++c) AddCell(body, t, c, nodal, sum);
  CkOk(MPI_Allreduce(MPI_IN_PLACE, sum, 4, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  *error       = PetscSqrtReal(sum[0] / sum[3]);
  *C           = PetscSqrtReal(sum[1] / sum[0]);
  *effectivity = PetscSqrtReal(sum[2] / sum[0]);
  CkOk(PetscFree(nodal));
}

static AbutBody Solved(MPI_Comm comm, Potentials (*solution)(const PetscReal[2]), AbutShape shape, PetscInt nx, PetscInt ny,
                       PetscInt refine)
{
  AbutBody body;

  exact = solution;
  body  = CkBox(comm, shape, (PetscReal)nx / ny, nx, ny, Displacement1, Displacement2);
  for (PetscInt r = 0; r < refine; ++r) CkRefine(body, 0.5, 0.5, 0.3 / (r + 1));
  CkOk(AbutBodySolve(body, NULL));
  return body;
}

/* phi' and psi' of degree n, in lengths of a unit */
static void PolynomialStress(PetscInt n, const PetscReal x[2], PetscReal s[3])
{
  const Complex z   = Point(x);
  Complex       dev = 0.;
  PetscReal     sum = 0.;

  for (PetscInt k = 0; k <= n; ++k) {
    const Complex a = 1. - 0.3 * k + 0.4 * _Complex_I * k, b = 0.7 * k - 1. + 0.2 * _Complex_I;

    sum += 4. * creal(a * cpow(z, k));
    dev += 2. * (k ? conj(Point(x)) * a * k * cpow(z, k - 1) : 0.) + 2. * b * cpow(z, k);
  }
  s[0] = 0.5 * (sum - creal(dev));
  s[1] = 0.5 * (sum + creal(dev));
  s[2] = 0.5 * cimag(dev);
}

static AbutPatchSpace Space(PetscInt degree)
{
  AbutPatchSpace space;

  AbutPatchSpaceSetUp_Private(degree, &space);
  return space;
}

/* Samples of it at n x n points of four unequal cells around the vertex */
static void AddSamples(PetscInt degree, PetscReal unit, PetscReal m[])
{
  const AbutPatchSpace space = Space(degree);
  const PetscInt       n     = PetscMax(2, degree - 1);

  for (PetscInt i = 0; i < 4 * n * n; ++i) {
    const PetscReal h[4] = {-1., 0.3, -0.4, 1.}, x = h[i % 2] * (i / 4 % n + 0.3) / n, y = h[2 + i / 2 % 2] * (i / 4 / n + 0.4) / n;
    const PetscReal at[2] = {x, y}, d[2] = {unit * x, unit * y};
    PetscReal       s[3];

    PolynomialStress(degree, at, s);
    AbutPatchAdd_Private(&space, d, s, m);
  }
}

START_TEST(a_patch_reproduces_the_stress_of_polynomial_potentials)
{
  const PetscInt       degree = 1 + _i / 2;
  const PetscReal      unit   = _i % 2 ? 1e-5 : 1e3; /* of length: it must not matter */
  const AbutPatchSpace space  = Space(degree);
  PetscReal           *m, *coef, x[2] = {0.2, -0.3}, d[2] = {0.2 * unit, -0.3 * unit}, s[2][3];
  PetscBool            all = PETSC_FALSE;

  CkOk(PetscCalloc2(space.moments, &m, space.coefs, &coef));
  AddSamples(degree, unit, m);
  AbutPatchFit_Private(&space, m, coef, &all);
  ck_assert(all);
  AbutPatchEvaluate_Private(&space, coef, d, s[0]);
  PolynomialStress(degree, x, s[1]);
  for (PetscInt k = 0; k < 3; ++k) ck_assert_double_eq_tol(s[0][k], s[1][k], 1e-9);
  CkOk(PetscFree2(m, coef));
}
END_TEST

START_TEST(a_poor_patch_leaves_out_what_it_cannot_tell)
{
  const AbutPatchSpace space = Space(1 + _i);
  const PetscReal      sample[2][3] =
    {
      {5., 0., 0.},
      {9., 0., 0.}
  },
                  at[2][2] = {{-1., 0.5}, {1., 0.5}}, middle[2] = {0., 0.5};
  PetscReal m[300] = {0.}, coef[ABUT_PATCH_COEFS_MAX], s[3];
  PetscBool all    = PETSC_TRUE;

  AbutPatchAdd_Private(&space, at[0], sample[0], m); /* one sample: a constant */
  AbutPatchFit_Private(&space, m, coef, &all);
  ck_assert(!all);
  AbutPatchEvaluate_Private(&space, coef, at[1], s);
  for (PetscInt k = 0; k < 3; ++k) ck_assert_double_eq_tol(s[k], sample[0][k], 1e-14);
  AbutPatchAdd_Private(&space, at[1], sample[1], m); /* two samples side by side: linear along them */
  AbutPatchFit_Private(&space, m, coef, &all);
  ck_assert(!all);
  AbutPatchEvaluate_Private(&space, coef, middle, s);
  ck_assert_double_eq_tol(s[0], 7., 1e-13);
  AbutPatchEvaluate_Private(&space, coef, at[1], s);
  for (PetscInt k = 0; k < 3; ++k) ck_assert_double_eq_tol(s[k], sample[1][k], 1e-13);
  for (PetscInt i = 7; i < space.coefs; ++i) ck_assert_double_eq(coef[i], 0.);
}
END_TEST

START_TEST(a_moved_stress_has_the_same_values)
{
  const AbutPatchSpace space = Space(1);
  const PetscReal a[7] = {1., -2., 3., 0.5, -0.7, 1.1, 0.4}, d[2] = {0.3, -0.7}, x[2] = {1.1, 0.4}, there[2] = {x[0] + d[0], x[1] + d[1]};
  PetscReal       b[7], s[2][3];

  AbutPatchShift_Private(a, d, b);
  AbutPatchEvaluate_Private(&space, a, there, s[0]);
  AbutPatchEvaluate_Private(&space, b, x, s[1]);
  for (PetscInt k = 0; k < 3; ++k) ck_assert_double_eq_tol(s[0][k], s[1][k], 1e-12);
}
END_TEST

/* On a uniform mesh the finite-element stress of a quadratic displacement is exact where it is sampled: the recovered one is exact */
START_TEST(a_linear_stress_is_recovered_exactly_on_a_uniform_mesh)
{
  AbutBody  body = Solved(PETSC_COMM_WORLD, Linear, (AbutShape)_i, 6, 6, 0);
  PetscReal error, C, effectivity;

  Measure(body, &error, &C, &effectivity);
  ck_assert_double_gt(error, 1e-2);
  ck_assert_double_lt(C, 1e-10);
  ck_assert_double_eq_tol(effectivity, 1., 1e-10);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(a_smooth_stress_is_recovered_an_order_better)
{
  PetscReal error, C[2], effectivity;

  for (PetscInt k = 0; k < 2; ++k) {
    AbutBody body = Solved(PETSC_COMM_WORLD, Smooth, (AbutShape)_i, 8 << k, 8 << k, 0);

    Measure(body, &error, &C[k], &effectivity);
    PetscPrintf(PETSC_COMM_WORLD, "%s 1/%d: error %.3e, C %.3f, effectivity %.3f\n", _i ? "P1" : "Q1", 8 << k, (double)error, (double)C[k],
                (double)effectivity);
    ck_assert_double_lt(C[k], 0.3);
    ck_assert_double_gt(effectivity, 0.95);
    ck_assert_double_lt(effectivity, 1.05);
    CkOk(AbutBodyDestroy(&body));
  }
  ck_assert_double_gt(C[0] / C[1], 1.6); /* 2 is one order */
  ck_assert_double_lt(C[0] / C[1], 2.2);
}
END_TEST

START_TEST(a_locally_refined_mesh_is_judged_as_well)
{
  PetscReal error, C, effectivity;

  for (PetscInt k = 0; k < 2; ++k) {
    AbutBody body = Solved(PETSC_COMM_WORLD, Smooth, (AbutShape)_i, 8 << k, 8 << k, 3);

    Measure(body, &error, &C, &effectivity);
    PetscPrintf(PETSC_COMM_WORLD, "%s 1/%d with three levels more: error %.3e, C %.3f, effectivity %.3f\n", _i ? "P1" : "Q1", 8 << k,
                (double)error, (double)C, (double)effectivity);
    ck_assert_double_lt(C, 0.3);
    ck_assert_double_gt(effectivity, 0.9);
    ck_assert_double_lt(effectivity, 1.1);
    CkOk(AbutBodyDestroy(&body));
  }
}
END_TEST

static void CheckRanks(AbutShape shape, PetscInt nx, PetscInt ny, PetscInt refine)
{
  AbutBody  all = Solved(PETSC_COMM_WORLD, Smooth, shape, nx, ny, refine), one = Solved(PETSC_COMM_SELF, Smooth, shape, nx, ny, refine);
  PetscReal total[2], largest[2];

  CkEstimate(all, ABUTESTIMATORZZ, &total[0], &largest[0]);
  CkEstimate(one, ABUTESTIMATORZZ, &total[1], &largest[1]);
  ck_assert_double_eq_tol(total[0], total[1], 1e-10 * total[1]);
  ck_assert_double_eq_tol(largest[0], largest[1], 1e-10 * largest[1]);
  CkOk(AbutBodyDestroy(&all));
  CkOk(AbutBodyDestroy(&one));
}

/* Among several small meshes of triangles there are cuts where a rank holds a vertex of the boundary but no side at it */
START_TEST(all_numbers_of_ranks_give_the_same_estimate)
{
  CheckRanks(ABUT_QUAD, 8, 8, 3);
  CheckRanks(ABUT_TRIANGLE, 8, 8, 3);
  for (PetscInt n = 2; n <= 6; ++n) CheckRanks(ABUT_TRIANGLE, n, 2, 0);
}
END_TEST

START_TEST(the_estimate_is_close_to_the_error)
{
  AbutBody  body = Solved(PETSC_COMM_WORLD, Smooth, (AbutShape)_i, 16, 16, 0);
  PetscReal error, C, effectivity, total, largest;

  Measure(body, &error, &C, &effectivity);
  CkEstimate(body, ABUTESTIMATORZZ, &total, &largest);
  ck_assert_double_eq_tol(total, error, 0.02 * error);
  ck_assert_double_gt(largest, total);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(a_body_without_inner_vertices_has_an_estimate)
{
  for (PetscInt nx = 1; nx <= 8; nx += 7) {
    AbutBody  body  = Solved(PETSC_COMM_WORLD, Smooth, (AbutShape)_i, nx, 1, 0);
    PetscReal total = -1., largest = -1.;

    CkEstimate(body, ABUTESTIMATORZZ, &total, &largest);
    ck_assert(!PetscIsInfOrNanReal(total) && total >= 0.);
    if (nx > 1) ck_assert_double_gt(total, 0.01);
    CkOk(AbutBodyDestroy(&body));
  }
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("zz");
  TCase *tests = tcase_create("recovery");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  tcase_add_loop_test(tests, a_patch_reproduces_the_stress_of_polynomial_potentials, 0, 2 * ABUT_PATCH_DEGREE_MAX);
  tcase_add_loop_test(tests, a_poor_patch_leaves_out_what_it_cannot_tell, 0, ABUT_PATCH_DEGREE_MAX);
  tcase_add_test(tests, a_moved_stress_has_the_same_values);
  tcase_add_loop_test(tests, a_linear_stress_is_recovered_exactly_on_a_uniform_mesh, 0, 2);
  tcase_add_loop_test(tests, a_smooth_stress_is_recovered_an_order_better, 0, 2);
  tcase_add_loop_test(tests, a_locally_refined_mesh_is_judged_as_well, 0, 2);
  tcase_add_test(tests, all_numbers_of_ranks_give_the_same_estimate);
  tcase_add_loop_test(tests, the_estimate_is_close_to_the_error, 0, 2);
  tcase_add_loop_test(tests, a_body_without_inner_vertices_has_an_estimate, 0, 2);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
