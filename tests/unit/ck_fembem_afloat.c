#include <petscdt.h>
#include "ck.h"
#include "fembemimpl.h"

/* estimator_fembem on bodies that nothing holds: the boundary has no given displacement, or few; its rigid motion is of no account */
/* s11 = 20 - slope*35 y, s22 = -30 + slope*15 x, s12 = 0 is in balance; without slope it leaves the line x = 0 straight */
static PetscReal slope;

static void Stress(const PetscReal x[2], PetscReal s[3])
{
  s[0] = 20. - slope * 35. * x[1];
  s[1] = -30. + slope * 15. * x[0];
  s[2] = 0.;
}

/* ctx: the side */
static PetscErrorCode Traction(const PetscReal x[2], PetscReal *t, void *ctx)
{
  const PetscInt side = *(PetscInt *)ctx;
  PetscReal      s[3];

  Stress(x, s);
  *t = (side % 2 ? 1. : -1.) * s[side / 2];
  return PETSC_SUCCESS;
}

static PetscErrorCode Zero(PETSC_UNUSED const PetscReal x[2], PetscReal *value, PETSC_UNUSED void *ctx)
{
  *value = 0.;
  return PETSC_SUCCESS;
}

/* The top in contact, the rest under tractions, or the left side on rollers */
static AbutBody Create(PetscInt order, PetscBool rollers)
{
  static PetscInt side[3]  = {0, 1, 2};
  const PetscReal lower[2] = {0., 0.}, upper[2] = {2., 1.};
  const PetscInt  cells[2] = {32 / order, 16 / order};
  AbutBody        body;
  AbutMesh        mesh;

  slope = rollers ? 0. : 1.;
  CkOk(AbutBodyCreate(PETSC_COMM_WORLD, "box", &body));
  CkOk(AbutBodyGetMesh(body, &mesh));
  CkOk(AbutMeshSetBox(mesh, lower, upper, cells, ABUT_QUAD));
  CkOk(AbutMeshSetOrder(mesh, order));
  CkOk(AbutBodySetMaterial(body, 2.1e5, 0.3));
  if (rollers) CkOk(AbutBodySetDisplacement(body, "left", 0, Zero, NULL));
  else CkOk(AbutBodySetTraction(body, "left", 0, Traction, &side[0]));
  CkOk(AbutBodySetTraction(body, "right", 0, Traction, &side[1]));
  CkOk(AbutBodySetTraction(body, "bottom", 1, Traction, &side[2]));
  CkOk(AbutBodySetContact(body, 3));
  return body;
}

/* With the nodal contact forces of s22 on the top */
static void Solve(AbutBody body)
{
  const AbutSide *top;
  PetscReal      *force, z[4], w[4];
  Vec             f;

  CkOk(AbutBodySetUp(body));
  CkOk(AbutBodyGetSide(body, 3, &top));
  CkOk(PetscCalloc1(top->n, &force));
  CkOk(PetscDTGaussQuadrature(4, -1., 1., z, w));
  for (PetscInt i = 0; i + 1 < top->n; i += top->order) {
    const PetscReal from = top->x[2 * i], to = top->x[2 * (i + top->order)];

    for (PetscInt g = 0; g < 4; ++g) {
      const PetscReal x[2] = {0.5 * ((1. - z[g]) * from + (1. + z[g]) * to), top->x[2 * i + 1]};
      PetscReal       s[3], N[ABUT_SIDE_NODES_MAX];

      Stress(x, s);
      CkOk(AbutEvaluateLobatto(top->order, z[g], N, NULL));
      for (PetscInt k = 0; k <= top->order; ++k) force[i + k] += 0.5 * w[g] * PetscAbsReal(to - from) * s[1] * N[k];
    }
  }
  CkOk(AbutBodyCreateVec(body, &f));
  CkOk(AbutBodyAddSideForce(body, 3, 1, force, f));
  CkOk(AbutBodySolve(body, f));
  CkOk(VecDestroy(&f));
  CkOk(PetscFree(force));
}

/* Largest error of the boundary elements' stress at points inside, over the largest stress */
static PetscReal BoundaryError(AbutBody body, PetscBool galerkin)
{
  const PetscReal x[10] = {.2, .2, 1.7, .8, .3, .5, 1.1, .15, 1.6, .3};
  AbutBoundary   *given;
  FembemBoundary  b;
  FembemStress    stress;
  PetscReal       young, poisson, s[15], exact[3], error = 0.;
  FembemCost      cost;

  CkOk(AbutBodyGetMaterial(body, &young, &poisson));
  CkOk(AbutBodyGetBoundary(body, &given));
  CkOk(FembemBoundaryCreate(PETSC_COMM_WORLD, given, young, poisson, &b));
  CkOk(FembemRecoverTractions(&b));
  if (galerkin) CkOk(FembemSolveGalerkin(&b, (FembemSolver){.dense = PETSC_MAX_INT}, &cost));
  FembemTakeOffRigidMotion(&b);
  CkOk(FembemStressCreate(&b, 1e-4, &stress));
  CkOk(FembemStressEvaluate(stress, 5, x, s));
  for (PetscInt i = 0; i < 5; ++i) {
    Stress(x + 2 * i, exact);
    for (PetscInt k = 0; k < 3; ++k) error = PetscMax(error, PetscAbsReal(s[3 * i + k] - exact[k]) / 30.);
  }
  CkOk(FembemStressDestroy(&stress));
  CkOk(FembemBoundaryDestroy(&b));
  CkOk(AbutBoundaryDestroy(&given));
  return error;
}

/* 1e4 times the displacement of the load: the treecode's tolerance is 1e-4 */
START_TEST(boundary_elements_find_the_stress_of_a_body_afloat_wherever_it_lies)
{
  const PetscInt  order    = 1 + _i / 4;
  const PetscBool galerkin = (PetscBool)(_i % 2), rollers = (PetscBool)(_i / 2 % 2);
  const PetscReal away[3] = {30., -40., 50.};
  AbutBody        body    = Create(order, rollers);
  PetscReal       error[2];
  PetscInt        n;

  CkOk(AbutBodyGetFreeModeCount(body, &n));
  ck_assert_int_eq(n, rollers ? 1 : 3);
  Solve(body);
  error[0] = BoundaryError(body, galerkin);
  CkOk(AbutBodyMove(body, away));
  error[1] = BoundaryError(body, galerkin);
  CkOk(PetscPrintf(PETSC_COMM_WORLD, "order %" PetscInt_FMT ", %s, %s: error %.2e, moved %.2e\n", order, rollers ? "on rollers" : "afloat",
                   galerkin ? "galerkin" : "none", (double)error[0], (double)error[1]));
  ck_assert_double_lt(error[0], order > 1 ? 1e-9 : (galerkin ? 1e-4 : 2e-3));
  ck_assert_double_eq_tol(error[1], error[0], 1e-7);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("fembem_afloat");
  TCase *tests = tcase_create("body");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  tcase_set_timeout(tests, 0);
  tcase_add_loop_test(tests, boundary_elements_find_the_stress_of_a_body_afloat_wherever_it_lies, 0, 4 * ABUT_ORDER_MAX);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
