/* ranks: 2 3 4 */
/* The contact ends where the part of a rank ends, on both bodies: the answer is that of one rank alone, which each finds for itself */
#include "ck.h"
#include <abutscene.h>

/* Two sides that are flat and touch up to x = 2, the middle of their boxes, where the curve along which the cells are cut passes from one
   half into the other */
static const char layers
  [] = "-scene_bodies lower,upper -scene_pairs mid -lower_mesh_box 0,0,4,1 -lower_mesh_cells 16,4 -lower_material_young 2.1e5 "
       "-lower_material_poisson 0.3 -lower_bc_left_u1 0 -lower_bc_bottom_u2 0 -upper_mesh_box 0,1,4,2 -upper_mesh_cells 16,4 "
       "-upper_material_young 2.1e5 -upper_material_poisson 0.3 -upper_bc_left_u1 0 -upper_bc_top_u2 -1e-3 -mid_pair_bodies upper,lower "
       "-mid_pair_sides bottom,top -mid_pair_gap max(0,x-2) -snes_rtol 1e-12 ";

#define EDGE 2.

static const char *const variants[] = {"-mid_pair_penalty 0",
                                       "-mid_pair_penalty 0.05",
                                       "-mid_pair_penalty 0 -mid_pair_friction 0.3",
                                       "-mid_pair_penalty 0 -upper_mesh_shape triangle",
                                       "-mid_pair_penalty 0 -upper_mesh_order 2 -lower_mesh_order 2",
                                       "-mid_pair_penalty 0 -upper_mesh_order 3 -upper_mesh_shape triangle -lower_mesh_order 4"};

static AbutScene Solve(MPI_Comm comm, const char more[])
{
  AbutScene scene;

  CkOk(PetscOptionsClear(NULL));
  CkOk(PetscOptionsInsertString(NULL, layers));
  CkOk(PetscOptionsInsertString(NULL, more));
  CkOk(AbutSceneCreate(comm, &scene));
  CkOk(AbutSceneSetFromOptions(scene));
  CkOk(AbutSceneSolve(scene));
  CkOk(PetscOptionsClear(NULL));
  return scene;
}

/* How many ranks have a side of a cell on this side of the body that begins or ends at the edge */
static PetscInt Ranks(AbutScene scene, const char name[], const char which[])
{
  const AbutMeshTopology *t;
  AbutBody                body;
  AbutMesh                mesh;
  PetscInt                side, ranks = 0;

  CkOk(AbutSceneGetBody(scene, name, &body));
  CkOk(AbutBodyGetMesh(body, &mesh));
  CkOk(AbutMeshGetTopology(mesh, &t));
  CkOk(AbutMeshFindSide(mesh, name, which, &side));
  for (PetscInt i = 0; i < t->nsideedges && !ranks; ++i)
    for (PetscInt k = 0; k < 2; ++k)
      if (t->sideedge[3 * i + 2] == side && PetscAbsReal(t->x[2 * t->sideedge[3 * i + k]] - EDGE) < 1e-12) ranks = 1;
  CkOk(MPI_Allreduce(MPI_IN_PLACE, &ranks, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  return ranks;
}

static AbutPairState State(AbutScene scene, PetscInt *n, const PetscReal *x[], const PetscReal *p[])
{
  AbutInterface    iface;
  AbutPairState    state;
  AbutPair         pair;
  PetscInt         number, which;
  const PetscReal *D;

  CkOk(AbutSceneGetPair(scene, "mid", &pair, &number));
  CkOk(AbutSceneGetInterface(scene, &iface));
  CkOk(AbutInterfaceGetPairState(iface, number, &state));
  CkOk(AbutInterfaceGetPressure(iface, number, p));
  CkOk(AbutPairGetPressureNodes(pair, &which, n, x, &D));
  return state;
}

START_TEST(contact_may_end_where_a_rank_ends)
{
  AbutScene        many = Solve(PETSC_COMM_WORLD, variants[_i]), one = Solve(PETSC_COMM_SELF, variants[_i]);
  PetscInt         n[2];
  const PetscReal *x[2], *p[2];
  AbutPairState    state[2];
  PetscReal        last = 0.;
  PetscMPIInt      size;

  CkOk(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  if (size != 3) { /* a third of the cells is no power of two */
    ck_assert_int_eq(Ranks(many, "lower", "top"), 2);
    ck_assert_int_eq(Ranks(many, "upper", "bottom"), 2);
  }
  state[0] = State(many, &n[0], &x[0], &p[0]);
  state[1] = State(one, &n[1], &x[1], &p[1]);
  ck_assert_int_eq(n[0], n[1]);
  ck_assert_int_eq(state[0].active, state[1].active);
  for (PetscInt i = 0; i < n[0]; ++i) {
    ck_assert_double_eq_tol(x[0][2 * i], x[1][2 * i], 1e-14);
    ck_assert_double_eq_tol(p[0][i], p[1][i], 1e-10 * state[1].pressure_max);
    if (p[1][i] > 0.) last = PetscMax(last, x[1][2 * i]);
  }
  ck_assert_double_eq_tol(last, EDGE, 1e-12);
  ck_assert_double_eq_tol(state[0].force, state[1].force, 1e-10 * state[1].force);
  ck_assert_double_eq_tol(state[0].contact_edge, state[1].contact_edge, 1e-10);
  CkOk(AbutSceneDestroy(&many));
  CkOk(AbutSceneDestroy(&one));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("border");
  TCase *tc    = tcase_create("border");
  int    status;

  if (AbutInitialize(&argc, &argv, NULL)) return 1;
  tcase_set_timeout(tc, 0);
  tcase_add_loop_test(tc, contact_may_end_where_a_rank_ends, 0, PETSC_STATIC_ARRAY_LENGTH(variants));
  suite_add_tcase(suite, tc);
  status = CkRun(suite);
  return AbutFinalize() ? 1 : status;
}
