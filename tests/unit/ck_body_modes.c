/* ranks: 1 2 3 4 */
#include "ckbody.h"

/* Bodies that may move: their free modes, solves without them, increments and moves */

/* --- which motions are free --- */

static const struct {
  const char *conditions[4]; /* left, right, bottom, top */
  const char *modes;
} ck_free[] = {
  {{"tt", "tt", "tt", "tt"}, "moving along x; moving along y; turning about (2., 1.5); "},
  {{"--", "--", "--", "u-"}, "moving along y; turning about (2., 2.); "                 },
  {{"-u", "--", "--", "--"}, "moving along x; turning about (0., 1.5); "                },
  {{"u-", "u-", "--", "--"}, "moving along y; "                                         },
  {{"--", "--", "-u", "--"}, "moving along x; "                                         },
  {{"-u", "-u", "--", "--"}, "moving along x; "                                         },
  {{"--", "--", "u-", "u-"}, "moving along y; "                                         },
  {{"--", "-u", "u-", "--"}, "turning about (4., 1.); "                                 },
  {{"-u", "--", "--", "u-"}, "turning about (0., 2.); "                                 },
  {{"u-", "--", "-u", "--"}, ""                                                         },
  {{"-u", "-u", "u-", "--"}, ""                                                         },
  {{"--", "--", "uu", "--"}, ""                                                         }
};
#define NFREE (int)(sizeof(ck_free) / sizeof(ck_free[0]))

/* On a box [0,4]x[1,2] times scale; the mesh is made when somebody asks for it */
static AbutBody MakeFree(CkField *field, int which, PetscReal scale)
{
  const PetscReal lower[2] = {0., scale}, upper[2] = {4. * scale, 2. * scale};
  const PetscInt  cells[2] = {8, 2};
  AbutBody        body;

  field->young   = CK_YOUNG;
  field->poisson = CK_POISSON;
  CkOk(AbutBodyCreate(PETSC_COMM_WORLD, "body", &body));
  CkOk(AbutMeshSetBox(CkMeshOf(body), lower, upper, cells, ABUT_QUAD));
  CkOk(AbutBodySetMaterial(body, CK_YOUNG, CK_POISSON));
  CkGiveAll(body, field, ck_free[which].conditions[0], ck_free[which].conditions[1], ck_free[which].conditions[2],
            ck_free[which].conditions[3]);
  return body;
}

START_TEST(the_conditions_alone_say_which_motions_are_free)
{
  const PetscReal scales[3] = {1., 1e-12, 1e12};
  CkField         linear    = {.at = CkLinear};

  for (int s = 0; s < 3; ++s) {
    AbutBody body     = MakeFree(&linear, _i, scales[s]);
    char     all[256] = "", text[64];
    PetscInt n, commas = 0;

    CkOk(AbutBodyGetFreeModeCount(body, &n));
    for (PetscInt k = 0; k < n; ++k) {
      CkOk(AbutBodyGetFreeModeName(body, k, text, sizeof(text)));
      strcat(strcat(all, text), "; ");
    }
    if (!s) ck_assert_str_eq(all, ck_free[_i].modes);
    for (const char *c = ck_free[_i].modes; *c; ++c) commas += *c == ';';
    ck_assert_int_eq(n, commas);
    CkOk(AbutBodyDestroy(&body));
  }
}
END_TEST

/* The vector of a free motion */
static Vec Motion(AbutBody body, PetscInt k)
{
  const AbutMeshTopology *t = CkTopology(CkMeshOf(body));
  PetscScalar            *a;
  Vec                     motion;

  CkOk(AbutBodyCreateVec(body, &motion));
  CkOk(VecGetArray(motion, &a));
  for (PetscInt v = 0; v < t->nvertices; ++v)
    if (t->unknown[v] >= 0 && t->unknown[v] < t->nowned) CkOk(AbutBodyGetFreeMotion(body, k, t->x + 2 * v, a + 2 * t->unknown[v]));
  CkOk(VecRestoreArray(motion, &a));
  return motion;
}

/* The determinant of motion_k . P motion_l, by Gauss, for springs of stiffness one: 1 for a translation, more for a turn of a long body */
static PetscReal Resistance(AbutBody body, PetscInt n)
{
  PetscReal G[9], product = 1.;
  KSP       ksp;
  Mat       P;

  CkOk(AbutBodyGetKSP(body, &ksp));
  CkOk(KSPGetOperators(ksp, NULL, &P));
  for (PetscInt k = 0; k < n; ++k)
    for (PetscInt l = 0; l < n; ++l) {
      Vec a = Motion(body, k), b = Motion(body, l), Pb;

      CkOk(VecDuplicate(b, &Pb));
      CkOk(MatMult(P, b, Pb));
      CkOk(VecDot(a, Pb, &G[3 * k + l]));
      CkOk(VecDestroy(&a));
      CkOk(VecDestroy(&b));
      CkOk(VecDestroy(&Pb));
    }
  for (PetscInt i = 0; i < n; ++i) {
    product *= G[4 * i] / (0.01 * CK_YOUNG / (2. * (1. + CK_POISSON)));
    for (PetscInt j = i + 1; j < n; ++j)
      for (PetscInt m = n - 1; m >= i; --m) G[3 * j + m] -= G[3 * j + i] / G[4 * i] * G[3 * i + m];
  }
  return product;
}

START_TEST(free_modes_are_orthonormal_and_span_the_motions_that_springs_alone_resist)
{
  CkField  linear = {.at = CkLinear};
  AbutBody body   = MakeFree(&linear, _i, 1.);

  for (PetscInt again = 0; again < 2; ++again) { /* and on an adapted mesh */
    const Vec *mode;
    PetscInt   n;
    KSP        ksp;
    Mat        A;

    CkOk(AbutBodySetUp(body));
    CkOk(AbutBodyGetFreeModes(body, &n, &mode));
    CkOk(AbutBodyGetKSP(body, &ksp));
    CkOk(KSPGetOperators(ksp, &A, NULL));
    for (PetscInt k = 0; k < n; ++k) {
      PetscReal norm[2];
      Vec       motion = Motion(body, k), Ar;

      CkOk(VecDuplicate(motion, &Ar));
      CkOk(MatMult(A, mode[k], Ar));
      CkOk(VecNorm(Ar, NORM_INFINITY, norm));
      ck_assert_double_lt(norm[0], 1e-14 * CK_YOUNG);
      CkOk(VecNorm(motion, NORM_2, &norm[0]));
      for (PetscInt l = 0; l < n; ++l) {
        PetscScalar dot;

        CkOk(VecDot(mode[k], mode[l], &dot));
        ck_assert_double_eq_tol(dot, k == l, 1e-14);
        CkOk(VecDot(motion, mode[l], &dot));
        CkOk(VecAXPY(motion, -dot, mode[l]));
      }
      CkOk(VecNorm(motion, NORM_2, &norm[1]));
      ck_assert_double_lt(norm[1], 1e-13 * norm[0]);
      CkOk(VecDestroy(&motion));
      CkOk(VecDestroy(&Ar));
    }
    if (n) ck_assert_double_gt(Resistance(body, n), 0.9); /* a direct factor of a singular matrix may go well, by luck */
    CkRefine(CkMeshOf(body), CkTowardsPoint, 3);
  }
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* --- solves --- */

static const struct {
  const char *options;
  PetscReal   stress, residual; /* largest relative errors */
} ck_solvers[] = {
  {"",                                                              1e-10, 1e-12},
  {"-body_ksp_type cg -body_pc_type cholesky",                      1e-10, 1e-10},
  {"-body_pc_type hypre -body_ksp_rtol 1e-12",                      1e-8,  1e-11},
  {"-body_pc_type gamg -body_ksp_rtol 1e-12",                       1e-8,  1e-11},
  {"-body_pc_type hypre -body_ksp_type gmres -body_ksp_rtol 1e-12", 1e-8,  1e-10}
};
#define NSOLVERS (int)(sizeof(ck_solvers) / sizeof(ck_solvers[0]))

enum {
  GRID,
  POINT, /* six levels */
  SCATTERED,
  ONE, /* cell or two: fewer than ranks */
  NMESHES
};

/* A square of side 2 about (1.5, 1.25), without conditions yet */
static AbutBody MakeSquare(MPI_Comm comm, CkField *field, int which, AbutShape shape, const char *options)
{
  const PetscInt n    = which == ONE ? 1 : 4;
  AbutBody       body = CkBodyOn(comm, "body", field, 0.5, 0.25, 2.5, 2.25, n, n, shape);

  CkOptions(options);
  CkOk(AbutBodySetFromOptions(body));
  CkOptionsEnd();
  if (which == POINT) CkRefine(CkMeshOf(body), CkTowardsPoint, 6);
  if (which == SCATTERED) CkRefine(CkMeshOf(body), CkScattered, 3);
  return body;
}

static PetscErrorCode Constant(PETSC_UNUSED const PetscReal x[2], PetscReal *value, void *ctx)
{
  *value = *(PetscReal *)ctx;
  return PETSC_SUCCESS;
}

/* Largest part of a vector along the free modes, over its size */
static PetscReal AlongModes(AbutBody body, Vec v)
{
  const Vec  *mode;
  PetscInt    n;
  PetscScalar dot[3];
  PetscReal   norm, most = 0.;

  CkOk(AbutBodyGetFreeModes(body, &n, &mode));
  CkOk(VecNorm(v, NORM_2, &norm));
  for (PetscInt k = 0; k < n; ++k) {
    CkOk(VecDot(v, mode[k], &dot[k]));
    most = PetscMax(most, PetscAbsReal(dot[k]));
  }
  return norm > 0. ? most / norm : most;
}

static void CheckSolved(AbutBody body, PetscReal tolerance)
{
  PetscReal          residual;
  KSP                ksp;
  KSPConvergedReason reason;
  Vec                u;

  CkOk(AbutBodyGetKSP(body, &ksp));
  CkOk(KSPGetConvergedReason(ksp, &reason));
  ck_assert_int_gt(reason, 0);
  CkOk(AbutBodyGetLinearResidual(body, &residual));
  ck_assert_double_lt(residual, tolerance);
  CkOk(AbutBodyGetSolution(body, &u));
  ck_assert_double_lt(AlongModes(body, u), 1e-12);
}

START_TEST(a_square_afloat_under_balanced_tractions_has_their_stresses)
{
  const int direct = _i < 4 * NMESHES; /* two direct solvers on all meshes, three iterative ones on one */
  const int which = direct ? _i % NMESHES : SCATTERED, shape = direct ? _i / NMESHES % 2 : _i % 2,
            solver = direct ? _i / NMESHES / 2 : 2 + (_i - 4 * NMESHES) / 2;
  CkField   linear = {.at = CkLinear};
  AbutBody  body   = MakeSquare(PETSC_COMM_WORLD, &linear, which, (AbutShape)shape, ck_solvers[solver].options);
  PetscReal r[3], reaction[2], applied[2], strain, work;

  CkGiveAll(body, &linear, "tt", "tt", "tt", "tt");
  for (PetscInt again = 0; again < 2; ++again) { /* with the last mesh's solver gone */
    CkOk(AbutBodySolve(body, NULL));
    ck_assert_double_lt(CkStressError(body, &linear), ck_solvers[solver].stress);
    CheckSolved(body, ck_solvers[solver].residual);
    CkOk(AbutBodyGetImbalance(body, PETSC_TRUE, r));
    for (PetscInt k = 0; k < 3; ++k) ck_assert_double_lt(PetscAbsReal(r[k]), 1e-13 * 1e-3 * CK_YOUNG * 20.);
    CkOk(AbutBodyGetReaction(body, reaction, applied));
    for (PetscInt d = 0; d < 2; ++d) ck_assert(reaction[d] == 0. && PetscAbsReal(applied[d]) < 1e-12 * 1e-3 * CK_YOUNG * 20.);
    CkOk(AbutBodyGetEnergy(body, &strain, &work));
    ck_assert_double_eq_tol(work, 2. * strain, 10. * ck_solvers[solver].stress * work);
    CkRefine(CkMeshOf(body), CkTowardsPoint, 1);
  }
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(a_layer_held_at_one_smooth_side_finds_its_uniaxial_stress)
{
  CkField         linear = {.at = CkLinear};
  const PetscReal x[2]   = {2.5, 0.25};
  PetscReal       pull = 21., zero = 0., value[7];
  AbutBody        body = MakeSquare(PETSC_COMM_WORLD, &linear, _i % NMESHES, (AbutShape)(_i / NMESHES), "");
  PetscInt        n;

  CkOk(AbutBodySetDisplacement(body, "left", 0, Constant, &zero));
  CkOk(AbutBodySetTraction(body, "right", 0, Constant, &pull));
  CkOk(AbutBodyGetFreeModeCount(body, &n));
  ck_assert_int_eq(n, 1);
  CkOk(AbutBodySolve(body, NULL));
  CheckSolved(body, 1e-12);
  CkOk(AbutBodyGetPointValues(body, x, value));
  ck_assert_double_eq_tol(value[0], 2. * pull * (1. - CK_POISSON * CK_POISSON) / CK_YOUNG, 1e-10 * value[0]);
  ck_assert_double_eq_tol(value[2], pull, 1e-10 * pull);
  ck_assert_double_eq_tol(value[3], 0., 1e-10 * pull);
  ck_assert_double_eq_tol(value[4], 0., 1e-10 * pull);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* Normal forces on a side, all at its first node or spread over all; outward positive */
static Vec SideForce(AbutBody body, const char name[], PetscBool spread, PetscReal total)
{
  const AbutSide *side;
  PetscReal      *force;
  PetscInt        s;
  Vec             f;

  CkOk(AbutMeshFindSide(CkMeshOf(body), "side", name, &s));
  CkOk(AbutBodyGetSide(body, s, &side));
  CkOk(PetscCalloc1(side->n, &force));
  for (PetscInt i = 0; i < (spread ? side->n : 1); ++i) force[i] = spread ? total / side->n : total;
  CkOk(AbutBodyCreateVec(body, &f));
  CkOk(AbutBodyAddSideForce(body, s, 1, force, f));
  CkOk(PetscFree(force));
  return f;
}

static PetscErrorCode Slope(const PetscReal x[2], PetscReal *value, PETSC_UNUSED void *ctx)
{
  *value = 2. + x[0];
  return PETSC_SUCCESS;
}

/* Tractions (2 + x, -3) on the top: resultant (7, -6), moment about the middle -7; a force 5 along x at the lower right corner: moment 5 */
START_TEST(the_imbalance_is_the_resultant_of_the_forces)
{
  const PetscReal resultant[2][3] = {
    {7.,  -6., -7.},
    {12., -6., -2.}
  };
  CkField    linear = {.at = CkLinear};
  AbutBody   body   = MakeSquare(PETSC_COMM_WORLD, &linear, _i % NMESHES, (AbutShape)(_i / NMESHES), "");
  PetscReal  down   = -3., r[3];
  const Vec *mode;
  PetscInt   n;

  CkOk(AbutBodySetTraction(body, "top", 0, Slope, NULL));
  CkOk(AbutBodySetTraction(body, "top", 1, Constant, &down));
  CkOk(AbutBodySetUp(body));
  for (PetscInt with = 0; with < 2; ++with) {
    Vec f = SideForce(body, "right", PETSC_FALSE, with ? 5. : 0.);

    CkOk(AbutBodySolve(body, f));
    CheckSolved(body, 1e-12);
    CkOk(AbutBodyGetImbalance(body, PETSC_TRUE, r));
    CkOk(AbutBodyGetFreeModes(body, &n, &mode));
    ck_assert_int_eq(n, 3);
    for (PetscInt k = 0; k < 3; ++k) {
      Vec       motion = Motion(body, k);
      PetscReal sum    = 0.;

      for (PetscInt l = 0; l < 3; ++l) {
        PetscScalar dot;

        CkOk(VecDot(motion, mode[l], &dot));
        sum += dot * r[l];
      }
      ck_assert_double_eq_tol(sum, resultant[with][k], 1e-11);
      CkOk(VecDestroy(&motion));
    }
    CkOk(VecDestroy(&f));
  }
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* --- increments, updates, moves --- */

static const char *const ck_held[][4] = {
  {"ut", "tt", "tu", "tt"},
  {"ut", "tt", "t-", "tt"}, /* moves along y */
  {"-u", "t-", "u-", "tt"}, /* turns */
  {"tt", "t-", "--", "tt"}  /* moves and turns */
};

static PetscReal Distance(Vec a, Vec b)
{
  PetscReal norm[2];
  Vec       d;

  CkOk(VecNorm(b, NORM_2, &norm[1]));
  CkOk(VecDuplicate(a, &d));
  CkOk(VecWAXPY(d, -1., b, a));
  CkOk(VecNorm(d, NORM_2, &norm[0]));
  CkOk(VecDestroy(&d));
  return norm[0] / norm[1];
}

START_TEST(a_solve_and_an_increment_make_the_solve_with_both_forces)
{
  const int held = _i % 4, solver = _i < 4 * NMESHES ? 0 : 2, which = solver ? SCATTERED : _i / 4;
  CkField   linear[2] = {{.at = CkLinear}, {.at = CkLinear}};
  AbutBody  body[2]; /* in two steps, in one */
  PetscInt  solves, iterations;
  PetscReal tolerance = solver ? 1e-9 : 1e-11, imbalance[2][3], energy[2][2];
  Vec       f[2], w, u[2], before;

  for (PetscInt k = 0; k < 2; ++k) {
    body[k] = MakeSquare(PETSC_COMM_WORLD, &linear[k], which, which % 2 ? ABUT_TRIANGLE : ABUT_QUAD, ck_solvers[solver].options);
    CkGiveAll(body[k], &linear[k], ck_held[held][0], ck_held[held][1], ck_held[held][2], ck_held[held][3]);
    CkOk(AbutBodySetUp(body[k]));
  }
  f[0] = SideForce(body[0], "right", PETSC_FALSE, -300.);
  f[1] = SideForce(body[0], "top", PETSC_TRUE, -700.);
  CkOk(AbutBodyCreateVec(body[0], &w));
  CkOk(VecSet(w, 17.));
  CkOk(AbutBodySolve(body[0], f[0]));
  CkOk(AbutBodyGetSolution(body[0], &u[0]));
  CkOk(VecDuplicate(u[0], &before));
  CkOk(VecCopy(u[0], before));
  CkOk(AbutBodySolveIncrement(body[0], f[1], w));
  ck_assert(Distance(u[0], before) == 0.);
  ck_assert_double_lt(AlongModes(body[0], w), 1e-12);
  CkOk(AbutBodyGetSolveCounts(body[0], &solves, &iterations));
  ck_assert_int_eq(solves, 2);
  CkOk(AbutBodyUpdate(body[0], f[1], w));
  CkOk(VecAXPY(f[0], 1., f[1]));
  CkOk(AbutBodySolve(body[1], f[0]));
  CkOk(AbutBodyGetSolution(body[1], &u[1]));
  ck_assert_double_lt(Distance(u[0], u[1]), tolerance);
  for (PetscInt k = 0; k < 2; ++k) {
    const PetscReal *vertexu;
    PetscInt         n = CkTopology(CkMeshOf(body[k]))->nvertices;

    CheckSolved(body[k], 10. * ck_solvers[solver].residual);
    CkOk(AbutBodyGetImbalance(body[k], PETSC_TRUE, imbalance[k]));
    CkOk(AbutBodyGetEnergy(body[k], &energy[k][0], &energy[k][1]));
    CkOk(AbutBodyGetNodeDisplacement(body[k], &vertexu));
    energy[k][1] = 0.;
    for (PetscInt i = 0; i < 2 * n; ++i) energy[k][1] += PetscSqr(vertexu[i]);
    energy[k][1] = CkTotal(energy[k][1]);
  }
  CkOk(AbutBodyGetFreeModeCount(body[0], &solves));
  for (PetscInt k = 0; k < solves; ++k) ck_assert_double_eq_tol(imbalance[0][k], imbalance[1][k], 1e-11 * 1000.);
  for (PetscInt k = 0; k < 2; ++k) ck_assert_double_eq_tol(energy[0][k], energy[1][k], 10. * tolerance * energy[1][k]);
  for (PetscInt k = 0; k < 2; ++k) {
    CkOk(VecDestroy(&f[k]));
    CkOk(AbutBodyDestroy(&body[k]));
  }
  CkOk(VecDestroy(&w));
  CkOk(VecDestroy(&before));
}
END_TEST

START_TEST(an_increment_without_forces_is_zero_and_costs_nothing)
{
  CkField            linear = {.at = CkLinear};
  AbutBody           body   = MakeSquare(PETSC_COMM_WORLD, &linear, SCATTERED, ABUT_QUAD, ck_solvers[_i].options);
  PetscInt           solves, iterations[2];
  PetscReal          norm;
  KSP                ksp;
  KSPConvergedReason reason;
  Vec                f, w;

  CkGiveAll(body, &linear, "ut", "tt", "--", "tt");
  CkOk(AbutBodySolve(body, NULL));
  CkOk(AbutBodyGetSolveCounts(body, &solves, &iterations[0]));
  CkOk(AbutBodyCreateVec(body, &f));
  CkOk(AbutBodyCreateVec(body, &w));
  CkOk(VecSet(w, 17.));
  CkOk(AbutBodySolveIncrement(body, f, w));
  CkOk(VecNorm(w, NORM_2, &norm));
  ck_assert(norm == 0.);
  CkOk(AbutBodyGetKSP(body, &ksp));
  CkOk(KSPGetConvergedReason(ksp, &reason));
  ck_assert_int_gt(reason, 0);
  CkOk(AbutBodyGetSolveCounts(body, &solves, &iterations[1]));
  ck_assert_int_eq(solves, 1);
  ck_assert_int_eq(iterations[0], iterations[1]);
  CheckSolved(body, ck_solvers[_i].residual);
  CkOk(VecDestroy(&f));
  CkOk(VecDestroy(&w));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(an_increment_that_fails_says_so_through_the_ksp)
{
  static const char *const options[2] = {"", "-body_pc_type jacobi -body_ksp_max_it 2"};
  CkField                  linear     = {.at = CkLinear};
  AbutBody                 body       = MakeSquare(PETSC_COMM_WORLD, &linear, SCATTERED, ABUT_QUAD, options[_i]);
  PetscReal                norm;
  KSP                      ksp;
  KSPConvergedReason       reason;
  Vec                      f, w;

  CkGiveAll(body, &linear, "ut", "tt", "--", "tt");
  CkOk(AbutBodySetUp(body));
  f = SideForce(body, "top", PETSC_FALSE, _i ? 1. : PETSC_MAX_REAL);
  CkOk(AbutBodyCreateVec(body, &w));
  if (!_i) CkOk(VecScale(f, 10.));
  CkOk(AbutBodySolveIncrement(body, f, w));
  CkOk(AbutBodyGetKSP(body, &ksp));
  CkOk(KSPGetConvergedReason(ksp, &reason));
  ck_assert_int_eq(reason, _i ? KSP_DIVERGED_ITS : KSP_DIVERGED_NANORINF);
  CkOk(VecNorm(w, NORM_2, &norm));
  ck_assert(_i ? norm > 0. : norm == 0.);
  CkOk(VecDestroy(&f));
  CkOk(VecDestroy(&w));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(a_move_changes_the_place_and_nothing_else)
{
  const int       held = 1 + _i % 3, solver = _i < 3 * NMESHES ? 0 : 2, which = solver ? SCATTERED : _i / 3;
  CkField         linear = {.at = CkLinear};
  AbutBody        body   = MakeSquare(PETSC_COMM_WORLD, &linear, which, which % 2 ? ABUT_TRIANGLE : ABUT_QUAD, ck_solvers[solver].options);
  const PetscReal x[2] = {1.6, 1.3}, a[3] = {0.03, -0.02, 0.05};
  PetscReal       value[2][7], energy[2][2], move[2] = {0., 0.}, force[2][4], residual;
  const Vec      *mode;
  PetscInt        n;
  Vec             f;

  CkGiveAll(body, &linear, ck_held[held][0], ck_held[held][1], ck_held[held][2], ck_held[held][3]);
  CkOk(AbutBodySetUp(body));
  f = SideForce(body, "top", PETSC_TRUE, -700.);
  CkOk(AbutBodySolve(body, f));
  CkOk(AbutBodyGetFreeModes(body, &n, &mode));
  for (PetscInt k = 0; k < 2; ++k) {
    if (k) CkOk(AbutBodyMove(body, a));
    CkOk(AbutBodyGetPointValues(body, x, value[k]));
    CkOk(AbutBodyGetEnergy(body, &energy[k][0], &energy[k][1]));
    CkOk(AbutBodyGetReaction(body, force[k], force[k] + 2));
    CkOk(AbutBodyGetLinearResidual(body, &residual));
    ck_assert_double_lt(residual, ck_solvers[solver].residual);
  }
  for (PetscInt k = 0; k < n; ++k) { /* the motion at x, by the components of the k-th vector along all free motions */
    PetscReal G[9], y[3];

    for (PetscInt i = 0; i < n; ++i) {
      Vec motion = Motion(body, i), other;

      CkOk(VecDot(motion, mode[k], &y[i]));
      for (PetscInt j = 0; j < n; ++j) {
        other = Motion(body, j);
        CkOk(VecDot(motion, other, &G[3 * i + j]));
        CkOk(VecDestroy(&other));
      }
      CkOk(VecDestroy(&motion));
    }
    for (PetscInt i = 0; i < n; ++i) /* Gauss */
      for (PetscInt j = 0; j < n; ++j) {
        const PetscReal l = G[3 * j + i] / G[3 * i + i];

        if (j == i) continue;
        for (PetscInt m = 0; m < n; ++m) G[3 * j + m] -= l * G[3 * i + m];
        y[j] -= l * y[i];
      }
    for (PetscInt i = 0; i < n; ++i) {
      PetscReal u[2];

      CkOk(AbutBodyGetFreeMotion(body, i, x, u));
      for (PetscInt d = 0; d < 2; ++d) move[d] += a[k] * y[i] / G[4 * i] * u[d];
    }
  }
  for (PetscInt d = 0; d < 2; ++d) ck_assert_double_eq_tol(value[1][d] - value[0][d], move[d], 1e-14);
  ck_assert_double_gt(PetscAbsReal(move[0]) + PetscAbsReal(move[1]), 1e-4);
  for (PetscInt i = 2; i < 7; ++i) ck_assert_double_eq_tol(value[0][i], value[1][i], 1e-9 * value[0][6]);
  for (PetscInt i = 0; i < 4; ++i) ck_assert_double_eq_tol(force[0][i], force[1][i], 1e-9 * 700.);
  ck_assert_double_eq_tol(energy[0][0], energy[1][0], 1e-9 * energy[0][0]);
  CkOk(AbutBodySolve(body, f)); /* an iterative one begins here */
  CheckSolved(body, ck_solvers[solver].residual);
  CkOk(VecDestroy(&f));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* A known error is put into the displacement: balanced forces f answer w, so that a(w,w) = f.w */
START_TEST(the_linear_error_is_estimated_in_the_energy_norm)
{
  const int   solver = _i % NSOLVERS, held = _i / NSOLVERS;
  CkField     linear = {.at = CkLinear};
  AbutBody    body   = MakeSquare(PETSC_COMM_WORLD, &linear, SCATTERED, ABUT_QUAD, ck_solvers[solver].options);
  PetscReal   error[2];
  PetscScalar dot;
  Vec         f, w;

  CkGiveAll(body, &linear, ck_held[held][0], ck_held[held][1], ck_held[held][2], ck_held[held][3]);
  CkOk(AbutBodySolve(body, NULL));
  CkOk(AbutBodyGetLinearError(body, &error[0]));
  f = SideForce(body, "top", PETSC_TRUE, -700.);
  CkOk(AbutBodyCreateVec(body, &w));
  CkOk(AbutBodySolveIncrement(body, f, w));
  CkOk(VecDot(f, w, &dot));
  CkOk(AbutBodyUpdate(body, NULL, w));
  CkOk(AbutBodyGetLinearError(body, &error[1]));
  ck_assert_double_eq_tol(error[1], PetscSqrtReal(dot), (solver < 2 ? 1e-9 : 0.3) * error[1]);
  ck_assert_double_lt(error[0], 1e-7 * error[1]);
  CkOk(VecDestroy(&f));
  CkOk(VecDestroy(&w));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* The springs that make a factor of a matrix without one must not be felt by an iterative solver */
START_TEST(a_body_afloat_takes_hardly_more_iterations_than_a_held_one)
{
  static const char *const options[2] = {"-body_pc_type hypre", "-body_pc_type gamg"};
  CkField                  linear[2]  = {{.at = CkSmooth}, {.at = CkSmooth}};
  PetscInt                 solves, iterations[2];

  for (PetscInt k = 0; k < 2; ++k) {
    AbutBody body = MakeSquare(PETSC_COMM_WORLD, &linear[k], GRID, ABUT_QUAD, options[_i]);

    CkRefine(CkMeshOf(body), CkEverywhere, 4);
    CkGiveAll(body, &linear[k], k ? "tt" : "ut", "tt", k ? "tt" : "tu", "tt");
    CkOk(AbutBodySolve(body, NULL));
    CkOk(AbutBodyGetSolveCounts(body, &solves, &iterations[k]));
    CkOk(AbutBodyDestroy(&body));
  }
  ck_assert_int_le(iterations[0], _i ? 23 : 13);
  ck_assert_int_le(iterations[1], iterations[0] + 3);
}
END_TEST

START_TEST(ranks_do_not_change_what_a_body_afloat_answers)
{
  CkField   smooth[2] = {{.at = CkSmooth}, {.at = CkSmooth}};
  PetscReal value[2][7], energy[2], work, norm[2];

  for (PetscInt k = 0; k < 2; ++k) {
    const PetscReal x[2] = {0.51, 0.26};
    AbutBody        body = MakeSquare(k ? PETSC_COMM_SELF : PETSC_COMM_WORLD, &smooth[k], _i % NMESHES, (AbutShape)(_i / NMESHES), "");
    Vec             u;

    CkGiveAll(body, &smooth[k], "tt", "tt", "tt", "t-");
    CkOk(AbutBodySolve(body, NULL));
    CkOk(AbutBodyGetSolution(body, &u));
    CkOk(VecNorm(u, NORM_2, &norm[k]));
    CkOk(AbutBodyGetEnergy(body, &energy[k], &work));
    CkOk(AbutBodyGetPointValues(body, x, value[k]));
    CkOk(AbutBodyDestroy(&body));
  }
  ck_assert_double_eq_tol(norm[0], norm[1], 1e-10 * norm[1]);
  ck_assert_double_eq_tol(energy[0], energy[1], 1e-10 * energy[1]);
  for (PetscInt i = 0; i < 7; ++i)
    ck_assert_double_eq_tol(value[0][i], value[1][i], 1e-9 * (i < 2 ? PetscAbsReal(value[1][0]) + PetscAbsReal(value[1][1]) : value[1][6]));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("body_modes");
  TCase *tc    = tcase_create("all");
  int    failed;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  tcase_set_timeout(tc, 0);
  tcase_add_loop_test(tc, the_conditions_alone_say_which_motions_are_free, 0, NFREE);
  tcase_add_loop_test(tc, free_modes_are_orthonormal_and_span_the_motions_that_springs_alone_resist, 0, NFREE);
  tcase_add_loop_test(tc, a_square_afloat_under_balanced_tractions_has_their_stresses, 0, 4 * NMESHES + 2 * (NSOLVERS - 2));
  tcase_add_loop_test(tc, a_layer_held_at_one_smooth_side_finds_its_uniaxial_stress, 0, 2 * NMESHES);
  tcase_add_loop_test(tc, the_imbalance_is_the_resultant_of_the_forces, 0, 2 * NMESHES);
  tcase_add_loop_test(tc, a_solve_and_an_increment_make_the_solve_with_both_forces, 0, 4 * NMESHES + 4);
  tcase_add_loop_test(tc, an_increment_without_forces_is_zero_and_costs_nothing, 0, NSOLVERS);
  tcase_add_loop_test(tc, an_increment_that_fails_says_so_through_the_ksp, 0, 2);
  tcase_add_loop_test(tc, a_move_changes_the_place_and_nothing_else, 0, 3 * NMESHES + 3);
  tcase_add_loop_test(tc, the_linear_error_is_estimated_in_the_energy_norm, 0, 4 * NSOLVERS);
  tcase_add_loop_test(tc, a_body_afloat_takes_hardly_more_iterations_than_a_held_one, 0, 2);
  tcase_add_loop_test(tc, ranks_do_not_change_what_a_body_afloat_answers, 0, 2 * NMESHES);
  suite_add_tcase(suite, tc);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
