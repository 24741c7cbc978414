/* ranks: 1 2 3 4 */
#include "ckkinematics.h"

/* Strains without stress, against formulas of thermal stresses: B. A. Boley and J. H. Weiner, Theory of Thermal Stresses (1960) */

#define ALPHA 1.2e-5

typedef struct {
  PetscReal T[4]; /* T[0] + T[1] x + T[2] y + T[3] x^2 */
} Heat;

static PetscReal At(const Heat *heat, const PetscReal x[2])
{
  return heat->T[0] + heat->T[1] * x[0] + heat->T[2] * x[1] + heat->T[3] * x[0] * x[0];
}

static PetscErrorCode Expand(const PetscReal x[2], PetscReal eps[4], void *ctx)
{
  eps[0] = eps[1] = eps[3] = ALPHA * At(ctx, x);
  eps[2]                   = 0.;
  return PETSC_SUCCESS;
}

static PetscErrorCode Skew(PETSC_UNUSED const PetscReal x[2], PetscReal eps[4], PETSC_UNUSED void *ctx)
{
  eps[0] = 1e-3;
  eps[1] = -2e-3;
  eps[2] = 0.5e-3;
  eps[3] = 0.;
  return PETSC_SUCCESS;
}

/* Largest s11, s22, s12, s33, in size, at the nodes of all cells */
static PetscReal LargestStress(AbutBody body)
{
  const AbutMeshTopology *t = CkTopology(CkMeshOf(body));
  const PetscReal        *node;
  PetscReal               N[ABUT_CELL_NODES_MAX], dN[2 * ABUT_CELL_NODES_MAX], s[4], most = 0.;

  CkOk(AbutMeshGetReferenceNodes(CkMeshOf(body), &node));
  for (PetscInt k = 0; k < t->nodes; ++k) {
    CkOk(AbutMeshEvaluateBasis(CkMeshOf(body), node + 2 * k, N, dN));
    for (PetscInt c = 0; c < t->ncells; ++c) {
      CkOk(AbutBodyGetCellStresses3D(body, c, 1, node + 2 * k, dN, s, s + 3));
      for (PetscInt i = 0; i < 4; ++i) most = PetscMax(most, PetscAbsReal(s[i]));
    }
  }
  CkOk(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  return most;
}

static PetscReal Energy(AbutBody body)
{
  PetscReal strain, work;

  CkOk(AbutBodyGetEnergy(body, &strain, &work));
  ck_assert_double_eq_tol(work, 2. * strain, 1e-9 * CK_YOUNG * PetscSqr(ALPHA * 100.) + 1e-9 * strain);
  return strain;
}

/* 100 K: no stress in a sheet or a body of revolution, -E alpha T across the plane in plane strain, where it expands by (1 + nu) alpha T */
START_TEST(free_expansion_has_no_stress)
{
  static const PetscReal nu[2] = {0.3, 0.495};

  for (int k = 0; k < 6; ++k) {
    const AbutKinematics kinematics = (AbutKinematics)(k / 2);
    const PetscReal      grows      = (kinematics == ABUT_PLANE_STRAIN ? 1. + nu[k % 2] : 1.) * ALPHA * 100.;
    const PetscReal across = kinematics == ABUT_PLANE_STRAIN ? CK_YOUNG * ALPHA * 100. : 0., corner[2] = {2., 1.}, origin[2] = {0., 0.};
    Heat            heat = {
      {100., 0., 0., 0.}
    };
    CkField   field = {.at = CkLinear, .young = CK_YOUNG, .poisson = nu[k % 2]};
    AbutBody  body  = CkBodyOfOrder(_i, &field, kinematics, 0., 0., 2., 1., 3);
    PetscReal value[7], from[7], reaction[2], applied[2];

    CkOk(AbutBodyAddInitialStrain(body, "heat", 0, PETSC_FALSE, Expand, &heat));
    CkOk(AbutBodySolve(body, NULL));
    CkOk(AbutBodyGetPointValues(body, corner, value));
    ck_assert_double_eq_tol(LargestStress(body), across, 2e-8 * CK_YOUNG * ALPHA * 100.); /* round-off at an axis, nu = .495: 5e-9 */
    ck_assert_double_eq_tol(value[5], -across, 1e-9 * CK_YOUNG * ALPHA * 100.);
    ck_assert_double_eq_tol(Energy(body), 0.5 * across * across / CK_YOUNG * 2., 1e-9 * CK_YOUNG * grows * grows);
    CkOk(AbutBodyGetReaction(body, reaction, applied));
    for (PetscInt d = 0; d < 2; ++d) ck_assert_double_eq_tol(applied[d], 0., 1e-10 * CK_YOUNG * grows);
    CkOk(AbutBodyGetPointValues(body, origin, from));
    for (PetscInt d = 0; d < 2; ++d) ck_assert_double_eq_tol(value[d] - from[d], grows * corner[d], 1e-9 * grows);
    CkOk(AbutBodyDestroy(&body));
  }
}
END_TEST

static PetscErrorCode Nothing(PETSC_UNUSED const PetscReal x[2], PetscReal *value, PETSC_UNUSED void *ctx)
{
  *value = 0.;
  return PETSC_SUCCESS;
}

/* Held at both ends, free aside: s = -E alpha T in plane stress, -E alpha T/(1 - nu) in plane strain. Between two plates that do not move,
   a bar of revolution: -E alpha T. */
START_TEST(a_clamped_bar_has_the_stress_of_the_formula)
{
  static const PetscReal nu[2] = {0.3, 0.4999};

  for (int k = 0; k < 6; ++k) {
    const AbutKinematics kinematics = (AbutKinematics)(k / 2);
    const PetscReal      S = CK_YOUNG * ALPHA * 100., s = kinematics == ABUT_PLANE_STRAIN ? S / (1. - nu[k % 2]) : S;
    const PetscReal      x[2] = {0.3, 0.4}, pi = PETSC_PI;
    Heat                 heat = {
      {100., 0., 0., 0.}
    };
    CkField   field = {.at = CkLinear, .young = CK_YOUNG, .poisson = nu[k % 2]};
    AbutBody  body  = CkBodyOfOrder(_i, &field, kinematics, 0., 0., 2., 1., 3);
    PetscReal value[7], volume = kinematics == ABUT_AXISYMMETRIC ? 4. * pi : 2., reaction[2], applied[2];

    CkOk(AbutBodyAddInitialStrain(body, "heat", 0, PETSC_FALSE, Expand, &heat));
    CkOk(AbutBodySetDisplacement(body, "bottom", 1, Nothing, NULL));
    CkOk(AbutBodySetDisplacement(body, "top", 1, Nothing, NULL));
    if (kinematics != ABUT_AXISYMMETRIC) CkOk(AbutBodySetDisplacement(body, "left", 0, Nothing, NULL));
    CkOk(AbutBodySolve(body, NULL));
    CkOk(AbutBodyGetPointValues(body, x, value));
    ck_assert_double_eq_tol(value[2], 0., 1e-7 * s);
    ck_assert_double_eq_tol(value[3], -s, 1e-7 * s);
    ck_assert_double_eq_tol(value[4], 0., 1e-7 * s);
    ck_assert_double_eq_tol(value[5], kinematics == ABUT_PLANE_STRAIN ? -s : 0., 1e-7 * s);
    ck_assert_double_eq_tol(value[6], s, 1e-7 * s);
    ck_assert_double_eq_tol(LargestStress(body), s, 1e-7 * s);
    /* s e/2 over the volume, with the elastic strain alpha T in each direction that is held */
    ck_assert_double_eq_tol(Energy(body), (kinematics == ABUT_PLANE_STRAIN ? 1. : 0.5) * s * ALPHA * 100. * volume,
                            1e-7 * s * ALPHA * 100.);
    CkOk(AbutBodyGetReaction(body, reaction, applied)); /* both plates press, one against the other */
    ck_assert_double_eq_tol(reaction[1], 0., 1e-8 * s * volume);
    CkOk(AbutBodyDestroy(&body));
  }
}
END_TEST

/* T linear in y bends a sheet with the curvature alpha dT/dy and leaves no stress; order 2 has the parabola, order 1 comes near */
START_TEST(a_linear_temperature_bends_a_strip_without_stress)
{
  for (int k = 0; k < 2; ++k) {
    const AbutKinematics kinematics = (AbutKinematics)k;
    const PetscInt       order      = 1 + _i % 7 % 4;
    const PetscReal      b = 50., curvature = (k ? 1. : 1.3) * ALPHA * b,
                    end[3][2] = {
                      {0., 0.},
                      {2., 0.},
                      {4., 0.}
    };
    Heat heat = {
      {20., 10., b, 0.}
    };
    CkField   field = {.at = CkLinear, .young = CK_YOUNG, .poisson = 0.3};
    AbutBody  body  = CkBodyOfOrder(_i, &field, kinematics, 0., -0.25, 4., 0.25, 8);
    PetscReal v[3][7], across = k ? 0. : CK_YOUNG * ALPHA * (20. + 40. + 0.25 * b);

    CkOk(AbutBodyAddInitialStrain(body, "heat", 0, PETSC_FALSE, Expand, &heat));
    CkRefine(CkMeshOf(body), CkEverywhere, order == 1 ? 2 : 0);
    CkOk(AbutBodySolve(body, NULL));
    for (PetscInt i = 0; i < 3; ++i) CkOk(AbutBodyGetPointValues(body, end[i], v[i]));
    if (order == 1) ck_assert_double_eq_tol((v[0][1] - 2. * v[1][1] + v[2][1]) / 4., -curvature, 0.15 * curvature);
    else {
      ck_assert_double_eq_tol((v[0][1] - 2. * v[1][1] + v[2][1]) / 4., -curvature, 1e-8 * curvature);
      ck_assert_double_eq_tol(LargestStress(body), across, 1e-8 * CK_YOUNG * ALPHA * 100.);
    }
    (void)Energy(body);
    CkOk(AbutBodyDestroy(&body));
  }
}
END_TEST

/* A tube, T = r^2 c, in plane strain along the axis: with radii a < b,
   u = (1+nu)/(1-nu) alpha/r I(r) + C r + D/r, I(r) = int_a^r T r dr = c (r^4 - a^4)/4, C and D such that s_rr = 0 at a and b;
   s_rr = E alpha/(1-nu) (-I(r)/r^2 + (r^2 - a^2)/(r^2 (b^2 - a^2)) I(b)), s_zz = nu (s_rr + s_tt) - E alpha T */
#define HEAT_C 40.
static void HotTube(const CkField *field, const PetscReal x[2], PetscReal u[2], PetscReal s[4])
{
  const PetscReal E = field->young, nu = field->poisson, r = x[0], r2 = r * r, a2 = 1., b2 = 4., k = E * ALPHA / (1. - nu);
  const PetscReal J = HEAT_C * (r2 * r2 - a2 * a2) / 4., Jb = HEAT_C * (b2 * b2 - a2 * a2) / 4., T = HEAT_C * r2;

  s[0] = k * (-J / r2 + (r2 - a2) / (r2 * (b2 - a2)) * Jb);
  s[3] = k * (J / r2 + (r2 + a2) / (r2 * (b2 - a2)) * Jb - T);
  s[1] = nu * (s[0] + s[3]) - E * ALPHA * T;
  s[2] = 0.;
  u[0] = r * ((s[3] - nu * (s[0] + s[1])) / E + ALPHA * T);
  u[1] = 0.;
}

START_TEST(a_hot_tube_has_the_stresses_of_the_formula)
{
  const PetscInt order = 1 + _i % 7 % 4;
  Heat           heat  = {
    {0., 0., 0., HEAT_C}
  };
  CkField   field = {.at = HotTube, .young = CK_YOUNG, .poisson = _i % 7 ? 0.3 : 0.495}; /* with the mean dilatation as well */
  AbutBody  body  = CkBodyOfOrder(_i, &field, ABUT_AXISYMMETRIC, 1., 0., 2., 0.5, 4);
  PetscReal error[2], u[2], s[4];

  CkOk(AbutBodyAddInitialStrain(body, "heat", 0, PETSC_FALSE, Expand, &heat));
  CkOk(AbutBodySetDisplacement(body, "bottom", 1, Nothing, NULL));
  CkOk(AbutBodySetDisplacement(body, "top", 1, Nothing, NULL));
  for (PetscInt i = 0; i < 2; ++i) {
    const PetscReal x[2] = {1.3, 0.2};
    PetscReal       value[7];

    CkRefine(CkMeshOf(body), CkEverywhere, order > 1 ? 1 : 2);
    CkOk(AbutBodySolve(body, NULL));
    HotTube(&field, x, u, s);
    CkOk(AbutBodyGetPointValues(body, x, value));
    error[i] = PetscAbsReal(value[0] / u[0] - 1.);
    for (PetscInt j = 0; i && j < 4; ++j)
      ck_assert_double_eq_tol(value[2 + j], s[j], (order == 1 ? 0.1 : order == 2 ? 5e-3 : 5e-4) * value[6]);
    (void)Energy(body);
  }
  ck_assert_double_lt(error[1], order == 1 ? 3e-4 : 1e-5);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* Two strains on a body that may not move at all: stress -D (eps + eps), and the energy of it */
START_TEST(several_strains_add_up)
{
  Heat heat = {
    {100., 0., 0., 0.}
  };
  CkField         field = {.at = CkLinear, .young = CK_YOUNG, .poisson = 0.3};
  AbutBody        body  = CkBodyOfOrder(_i, &field, ABUT_PLANE_STRAIN, 0., 0., 1., 1., 2);
  const PetscReal mu = CK_YOUNG / 2.6, lambda = mu * 2. * 0.3 / 0.4, T = ALPHA * 100., x[2] = {0.4, 0.6};
  const PetscReal e[4] = {T + 1e-3, T - 2e-3, 0.5e-3, T}, trace = e[0] + e[1] + e[3];
  const PetscReal s[4] = {-lambda * trace - 2. * mu * e[0], -lambda * trace - 2. * mu * e[1], -2. * mu * e[2],
                          -lambda * trace - 2. * mu * e[3]};
  PetscReal       value[7];

  CkOk(AbutBodyAddInitialStrain(body, "heat", 0, PETSC_FALSE, Expand, &heat));
  CkOk(AbutBodyAddInitialStrain(body, "skew", 0, PETSC_FALSE, Skew, NULL));
  for (PetscInt side = 0; side < 4; ++side)
    for (PetscInt d = 0; d < 2; ++d) {
      static const char *const names[] = {"left", "right", "bottom", "top"};

      CkOk(AbutBodySetDisplacement(body, names[side], d, Nothing, NULL));
    }
  CkOk(AbutBodySolve(body, NULL));
  CkOk(AbutBodyGetPointValues(body, x, value));
  for (PetscInt i = 0; i < 4; ++i) ck_assert_double_eq_tol(value[2 + i], s[i], 1e-9 * value[6]);
  ck_assert_double_eq_tol(Energy(body), -0.5 * (s[0] * e[0] + s[1] * e[1] + 2. * s[2] * e[2] + s[3] * e[3]), 1e-9 * value[6]);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("initial");
  TCase *tc    = tcase_create("all");
  int    failed;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  tcase_set_timeout(tc, 0);
  tcase_add_loop_test(tc, free_expansion_has_no_stress, 0, CK_MESHES);
  tcase_add_loop_test(tc, a_clamped_bar_has_the_stress_of_the_formula, 0, CK_MESHES);
  tcase_add_loop_test(tc, a_linear_temperature_bends_a_strip_without_stress, 0, CK_MESHES);
  tcase_add_loop_test(tc, a_hot_tube_has_the_stresses_of_the_formula, 0, CK_MESHES);
  tcase_add_loop_test(tc, several_strains_add_up, 0, CK_MESHES);
  suite_add_tcase(suite, tc);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
