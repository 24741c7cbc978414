/* ranks: 1 2 3 4 */
#include "ckbody.h"

/* Next to incompressible: quads of order 1 with the mean dilatation of each cell, also on cells that are no parallelograms */

#define ALMOST 0.49999

enum {
  GRID,
  SCATTERED, /* cells of several sizes */
  SLANTED,   /* trapezia: a vertex of the top is moved by a third of a cell, the one opposite stays */
  NMESHES
};

static AbutBody Make(CkField *field, int which, PetscInt refine)
{
  AbutBody body = CkBodyOn(PETSC_COMM_WORLD, "body", field, 0., 0., 2., 1., 8, 4, ABUT_QUAD);

  if (which == SCATTERED) CkRefine(CkMeshOf(body), CkScattered, 2);
  CkRefine(CkMeshOf(body), CkEverywhere, refine);
  if (which == SLANTED) {
    AbutTie tie[2] = {
      {.reference = 1., .wanted = 1.08},
      {.reference = 1., .wanted = 1.  }
    };

    CkOk(AbutMeshFindSide(CkMeshOf(body), "side", "top", &tie[0].side));
    CkOk(AbutMeshFindSide(CkMeshOf(body), "side", "bottom", &tie[1].side));
    CkOk(AbutMeshSetTies(CkMeshOf(body), 2, tie));
    CkOk(AbutMeshAdapt(CkMeshOf(body), NULL));
  }
  return body;
}

static void Rotation(PETSC_UNUSED const CkField *field, const PetscReal x[2], PetscReal u[2], PetscReal s[3])
{
  u[0] = -1e-3 * x[1];
  u[1] = 1e-3 * x[0];
  s[0] = s[1] = s[2] = 0.;
}

START_TEST(a_constant_strain_is_exact_and_a_rotation_has_no_energy)
{
  static const char *const conditions[2][4] = {
    {"uu", "uu", "uu", "uu"},
    {"ut", "tt", "tu", "tt"}
  };

  for (int k = 0; k < 4; ++k) {
    CkField            field = {.at = k % 2 ? Rotation : CkLinear, .young = CK_YOUNG, .poisson = ALMOST};
    AbutBody           body  = Make(&field, _i, 0);
    const char *const *c     = conditions[k / 2];
    const PetscReal    scale = 1e-6 * CK_YOUNG / (3. * (1. - 2. * ALMOST)); /* bulk modulus times displacement^2 */
    const char        *name;
    PetscReal          strain, work;
    PetscBool          locks;

    CkGiveAll(body, &field, c[0], c[1], c[2], c[3]);
    CkOk(AbutBodySolve(body, NULL));
    CkOk(AbutBodyGetIntegration(body, &name, &locks));
    ck_assert_str_eq(name, "mean_dilatation");
    ck_assert_int_eq(locks, PETSC_FALSE);
    ck_assert_double_lt(CkNodalError(body, &field), 1e-10); /* the condition number is 1/(1 - 2 nu) times larger */
    CkOk(AbutBodyGetEnergy(body, &strain, &work));
    if (k % 2) ck_assert_double_lt(PetscAbsReal(strain), 1e-10 * scale);
    else {
      ck_assert_double_lt(CkStressError(body, &field), 1e-9);
      ck_assert_double_eq_tol(work, 2. * strain, 1e-10 * strain);
    }
    CkOk(AbutBodyDestroy(&body));
  }
}
END_TEST

/* Strain of the finite elements, its dilatation last */
static void Strain(AbutBody body, PetscInt c, const PetscReal xi[2], PetscReal e[4], PetscReal *det)
{
  const AbutMeshTopology *t = CkTopology(CkMeshOf(body));
  PetscReal               x[2], N[ABUT_CELL_NODES_MAX], G[2 * ABUT_CELL_NODES_MAX];
  const PetscReal        *u;

  CkOk(AbutBodyGetNodeDisplacement(body, &u));
  CkOk(AbutMeshMapCell(CkMeshOf(body), c, xi, x, N, G, det));
  for (PetscInt i = 0; i < 4; ++i) e[i] = 0.;
  for (PetscInt k = 0; k < t->nodes; ++k) {
    const PetscReal *a = u + 2 * t->cellnode[t->nodes * c + k];

    e[0] += a[0] * G[2 * k];
    e[1] += a[1] * G[2 * k + 1];
    e[2] += 0.5 * (a[0] * G[2 * k + 1] + a[1] * G[2 * k]);
  }
  e[3] = e[0] + e[1];
}

/* lambda/2 times the square of a cell's mean dilatation, plus mu times the strain squared, at 2x2 Gauss points; and the stress times the
   strain, which is twice that only if the stresses are those of the stiffness */
START_TEST(stiffness_and_stress_have_the_energy_of_the_mean_dilatation)
{
  CkField                 field = {.at = CkSmooth, .young = CK_YOUNG, .poisson = ALMOST};
  AbutBody                body  = Make(&field, _i, 0);
  const AbutMeshTopology *t;
  const PetscReal         g = 1. / PetscSqrtReal(3.), mu = CK_YOUNG / (2. * (1. + ALMOST)), lambda = 2. * mu * ALMOST / (1. - 2. * ALMOST);
  PetscReal               strain, work, energy = 0., product = 0., skew = 0.;

  CkGiveAll(body, &field, "ut", "tt", "tu", "tt");
  CkOk(AbutBodySolve(body, NULL));
  t = CkTopology(CkMeshOf(body));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    PetscReal area = 0., dilatation = 0., det[4];

    for (PetscInt q = 0; q < 4; ++q) {
      const PetscReal xi[2] = {q % 2 ? g : -g, q / 2 ? g : -g};
      PetscReal       e[4], s[3];

      Strain(body, c, xi, e, &det[q]);
      CkOk(AbutBodyGetCellStress(body, c, xi, s));
      area += det[q];
      dilatation += det[q] * e[3];
      energy += det[q] * mu * (e[0] * e[0] + e[1] * e[1] + 2. * e[2] * e[2]);
      product += det[q] * (s[0] * e[0] + s[1] * e[1] + 2. * s[2] * e[2]);
    }
    energy += 0.5 * lambda * dilatation * dilatation / area;
    skew = PetscMax(skew, PetscAbsReal(det[3] / det[0] - 1.));
  }
  CkOk(AbutBodyGetEnergy(body, &strain, &work));
  ck_assert_double_eq_tol(strain, CkTotal(energy), 1e-9 * strain);
  ck_assert_double_eq_tol(2. * strain, CkTotal(product), 1e-9 * strain);
  ck_assert_double_eq_tol(2. * strain, work, 1e-7 * strain);
  CkOk(MPI_Allreduce(MPI_IN_PLACE, &skew, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  ck_assert_int_eq(skew > 0.01, _i == SLANTED);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* As at nu = 0.3. The error is measured with the compliance, so that it has a limit at 1/2. */
START_TEST(the_orders_of_convergence_are_those_far_from_incompressible)
{
  PetscReal l2[2], energy[2], ordinary;

  for (PetscInt i = 0; i < 2; ++i) {
    CkField  field = {.at = CkSmooth, .young = CK_YOUNG, .poisson = ALMOST};
    AbutBody body  = Make(&field, _i, 1 + i);

    CkGiveAll(body, &field, "ut", "tt", "tu", "tt");
    CkOk(AbutBodySolve(body, NULL));
    CkErrors(body, &field, &l2[i], &energy[i]);
    CkOk(AbutBodyDestroy(&body));
  }
  ck_assert_double_eq_tol(PetscLog2Real(l2[0] / l2[1]), 2., 0.1);
  ck_assert_double_eq_tol(PetscLog2Real(energy[0] / energy[1]), 1., 0.05);
  {
    CkField  field = {.at = CkSmooth, .young = CK_YOUNG, .poisson = 0.3};
    AbutBody body  = Make(&field, _i, 2);

    CkGiveAll(body, &field, "ut", "tt", "tu", "tt");
    CkOk(AbutBodySolve(body, NULL));
    CkErrors(body, &field, &l2[0], &ordinary);
    CkOk(AbutBodyDestroy(&body));
  }
  printf("mesh %d: energy errors %.4e and, at nu = 0.3, %.4e\n", _i, (double)energy[1], (double)ordinary);
  ck_assert_double_lt(energy[1], 1.5 * ordinary);
}
END_TEST

START_TEST(only_triangles_of_order_1_lock)
{
  for (PetscInt k = 0; k < 8; ++k) {
    const PetscInt  order = 1 + k % 2;
    const AbutShape shape = (AbutShape)(k / 2 % 2);
    const PetscReal nu    = k < 4 ? 0.48 : 0.495;
    CkField         field = {.at = CkLinear, .young = 1., .poisson = nu, .order = order};
    AbutBody        body  = CkBodyOn(PETSC_COMM_WORLD, "body", &field, 0., 0., 1., 1., 2, 2, shape);
    const char     *name;
    PetscBool       locks;

    CkGiveAll(body, &field, "uu", "uu", "uu", "uu");
    CkOk(AbutBodySetUp(body));
    CkOk(AbutBodyGetIntegration(body, &name, &locks));
    ck_assert_str_eq(name, nu > 0.49 && shape == ABUT_QUAD && order == 1 ? "mean_dilatation" : "full");
    ck_assert_int_eq(locks, nu > 0.49 && shape == ABUT_TRIANGLE && order == 1);
    CkOk(AbutBodyDestroy(&body));
  }
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("dilatation");
  TCase *tc    = tcase_create("all");
  int    failed;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  tcase_set_timeout(tc, 0);
  tcase_add_loop_test(tc, a_constant_strain_is_exact_and_a_rotation_has_no_energy, 0, NMESHES);
  tcase_add_loop_test(tc, stiffness_and_stress_have_the_energy_of_the_mean_dilatation, 0, NMESHES);
  tcase_add_loop_test(tc, the_orders_of_convergence_are_those_far_from_incompressible, 0, NMESHES);
  tcase_add_test(tc, only_triangles_of_order_1_lock);
  suite_add_tcase(suite, tc);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
