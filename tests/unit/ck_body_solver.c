/* ranks: 1 2 3 4 */
#include "ckbody.h"

/* The linear solvers of a body, its keys, and what its assembly costs */

/* The layers scene's conditions: a symmetry plane and a smooth base, so that the components of a node are held apart */
static const char *const
  ck_layer = "-body_mesh_box 0,0,4,1 -body_mesh_cells 64,16 -body_material_young 2.1e5 -body_material_poisson 0.3 -body_bc_left_u1 0 "
             "-body_bc_bottom_u2 0 -body_bc_right_t2 -50 -body_bc_top_t2 -100 ";

static AbutBody Layer(const char *more)
{
  char     text[2048];
  AbutBody body;

  CkOk(PetscSNPrintf(text, sizeof(text), "%s%s", ck_layer, more));
  CkOptions(text);
  CkOk(AbutBodyCreate(PETSC_COMM_WORLD, "body", &body));
  CkOk(AbutBodySetFromOptions(body));
  CkOk(AbutBodySolve(body, NULL));
  CkOptionsEnd();
  return body;
}

START_TEST(every_solver_finds_the_displacement_of_the_direct_one)
{
  static const struct {
    const char *options, *ksp, *pc;
    PetscInt    most; /* iterations */
  } solvers[] = {
    {"-body_pc_type hypre -body_ksp_type cg",                        "cg",      "hypre",    12 },
    {"-body_pc_type hypre",                                          "cg",      "hypre",    12 },
    {"-body_pc_type hypre -body_ksp_type gmres",                     "gmres",   "hypre",    14 },
    {"-body_ksp_type cg",                                            "cg",      "cholesky", 2  },
    {"-body_pc_type lu",                                             "preonly", "lu",       1  },
    {"-body_pc_type bjacobi -body_ksp_type cg -body_ksp_rtol 1e-12", "cg",      "bjacobi",  500}
  };
  AbutBody           direct = Layer(""), body = Layer(solvers[_i].options);
  Vec                u, v;
  KSP                ksp;
  PC                 pc;
  KSPType            ksptype;
  PCType             pctype;
  PetscReal          norm, distance, residual;
  PetscInt           solves, iterations;
  KSPConvergedReason reason;

  CkOk(AbutBodyGetSolution(direct, &u));
  CkOk(AbutBodyGetSolution(body, &v));
  CkOk(VecNorm(u, NORM_2, &norm));
  CkOk(VecAXPY(u, -1., v));
  CkOk(VecNorm(u, NORM_2, &distance));
  ck_assert_double_lt(distance, 1e-8 * norm);
  CkOk(AbutBodyGetLinearResidual(body, &residual));
  ck_assert_double_lt(residual, 1e-9);
  CkOk(AbutBodyGetSolveCounts(body, &solves, &iterations));
  ck_assert_int_eq(solves, 1);
  ck_assert_int_le(iterations, solvers[_i].most);
  CkOk(AbutBodyGetKSP(body, &ksp));
  CkOk(KSPGetPC(ksp, &pc));
  CkOk(KSPGetType(ksp, &ksptype));
  CkOk(PCGetType(pc, &pctype));
  CkOk(KSPGetConvergedReason(ksp, &reason));
  ck_assert_str_eq(ksptype, solvers[_i].ksp);
  ck_assert_str_eq(pctype, solvers[_i].pc);
  ck_assert_int_gt(reason, 0);
  CkOk(AbutBodyDestroy(&direct));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* Small increments take few iterations, large ones as many as the first solve, and none spoils what the first solve left */
START_TEST(an_increment_is_solved_as_far_as_the_whole)
{
  const PetscReal size[] = {1e-6, 1e-3, 10.};
  AbutBody        body   = Layer("-body_pc_type hypre -body_ksp_type cg -body_ksp_rtol 1e-10");
  PetscInt        solves, before, after, first, taken[3];
  Vec             force, w, load;
  PetscReal       whole, residual;

  CkOk(AbutBodyGetSolveCounts(body, &solves, &first));
  CkOk(AbutBodyCreateVec(body, &force));
  CkOk(VecDuplicate(force, &w));
  CkOk(VecDuplicate(force, &load));
  CkOk(VecSetRandom(load, NULL));
  CkOk(VecNorm(load, NORM_2, &whole));
  for (PetscInt i = 0; i < 3; ++i) {
    CkOk(VecAXPBY(force, 500. * size[i] / whole, 0., load));
    CkOk(AbutBodyGetSolveCounts(body, &solves, &before));
    CkOk(AbutBodySolveIncrement(body, force, w));
    CkOk(AbutBodyGetSolveCounts(body, &solves, &after));
    taken[i] = after - before;
    CkOk(AbutBodyUpdate(body, force, w));
    CkOk(AbutBodyGetLinearResidual(body, &residual));
    ck_assert_double_lt(residual, 3e-10);
  }
  ck_assert_int_le(3 * taken[0], 2 * taken[2]);
  ck_assert_int_ge(taken[2], first);
  ck_assert_int_ge(taken[0], 2); /* a ten thousandth all the same */
  CkOk(VecDestroy(&force));
  CkOk(VecDestroy(&w));
  CkOk(VecDestroy(&load));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(without_options_a_direct_solver_is_taken)
{
  CkField       linear = {.at = CkLinear};
  AbutBody      body   = CkBodyOn(PETSC_COMM_WORLD, "body", &linear, 0., 0., 4., 1., 8, 2, ABUT_QUAD);
  KSP           ksp;
  PC            pc;
  MatSolverType solver;
  PetscBool     preonly;

  CkGiveAll(body, &linear, "uu", "uu", "uu", "uu");
  CkOk(AbutBodySolve(body, NULL));
  CkOk(AbutBodyGetKSP(body, &ksp));
  CkOk(KSPGetPC(ksp, &pc));
  CkOk(PetscObjectTypeCompare((PetscObject)ksp, KSPPREONLY, &preonly));
  CkOk(PCFactorGetMatSolverType(pc, &solver));
  ck_assert_int_eq(preonly, PETSC_TRUE);
  ck_assert_str_eq(solver, MATSOLVERMUMPS);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(the_solver_goes_along_when_the_mesh_adapts)
{
  AbutBody  body = Layer("-body_pc_type hypre");
  PetscInt  solves, first, both;
  PetscReal residual;

  CkOk(AbutBodyGetSolveCounts(body, &solves, &first));
  CkRefine(CkMeshOf(body), CkTowardsPoint, 6);
  CkOk(AbutBodySolve(body, NULL));
  CkOk(AbutBodyGetSolveCounts(body, &solves, &both));
  ck_assert_int_le(both - first, 13); /* hanging vertices and seven levels; 16 with a BoomerAMG left over from the first mesh */
  CkOk(AbutBodyGetLinearResidual(body, &residual));
  ck_assert_double_lt(residual, 1e-9);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

/* The prescribed displacements and tractions of the keys: uniaxial strain needs no mesh to be known */
START_TEST(a_body_is_described_by_its_keys)
{
  const PetscReal x[2] = {1.5, 0.25};
  AbutBody        body;
  PetscReal       young, poisson, value[7];

  CkOptions("-Body_mesh_box 0,0,2,1 -body_mesh_cells 3,2 -body_mesh_shape triangle -body_material_young 1000 -body_material_poisson 0.25 "
            "-body_bc_left_u1 0 -body_bc_right_u1 0 "
            "-body_bc_bottom_u2 1e-2 -body_bc_top_t2 -12");
  CkOk(AbutBodyCreate(PETSC_COMM_WORLD, "body", &body));
  CkOk(AbutBodySetFromOptions(body));
  CkOk(AbutBodySolve(body, NULL));
  CkOptionsEnd();
  CkOk(AbutBodyGetMaterial(body, &young, &poisson));
  ck_assert(young == 1000. && poisson == 0.25);
  CkOk(AbutBodyGetPointValues(body, x, value));
  ck_assert_double_eq_tol(value[3], -12., 1e-11); /* e22 = -12/(lambda + 2 mu) = -12/1200 */
  ck_assert_double_eq_tol(value[2], -4., 1e-11);
  ck_assert_double_eq_tol(value[1], 1e-2 - 0.25e-2, 1e-14);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(keys_that_contradict_or_are_missing_are_refused)
{
  static const char *const bad[][2] = {
    {"-body_material_poisson 0.3",                                           "body_material_young: missing"  },
    {"-body_material_young 1",                                               "body_material_poisson: missing"},
    {"-body_material_young 1 -body_material_poisson 0.5",                    "body_material_poisson:"        },
    {"-body_material_young 1 -body_material_poisson 0.3 -body_bc_left_t1 0", "body_bc_left_t1:"              }
  };
  char           text[1024];
  AbutBody       body;
  PetscErrorCode code;

  CkOk(PetscSNPrintf(text, sizeof(text), "-body_mesh_box 0,0,2,1 -body_mesh_cells 3,2 -body_bc_left_u1 0 %s", bad[_i][0]));
  CkOptions(text);
  CkOk(AbutBodyCreate(PETSC_COMM_WORLD, "body", &body));
  CkCatch(code = AbutBodySetFromOptions(body));
  ck_assert_int_eq(code, PETSC_ERR_USER_INPUT);
  ck_assert_ptr_nonnull(strstr(ck_line, bad[_i][1]));
  CkOk(AbutBodyDestroy(&body));
  CkOptionsEnd();
}
END_TEST

/* Seconds are told, not judged: the machine is not ours alone */
START_TEST(the_assembly_tells_what_a_cell_costs)
{
  CkField     linear = {.at = CkLinear};
  AbutBody    body   = CkBodyOn(PETSC_COMM_WORLD, "body", &linear, 0., 0., 4., 1., 256, 64, ABUT_QUAD);
  PetscReal   seconds, factor, cpu, before, after;
  Vec         u;
  PetscInt    cells;
  PetscMPIInt rank;

  CkGiveAll(body, &linear, "u-", "--", "-u", "--");
  CkOk(AbutBodySetUp(body));
  CkOk(AbutBodyGetSetUpCost(body, &seconds, &cells, &factor));
  ck_assert_int_eq(cells, 256 * 64);
  ck_assert_double_gt(seconds, 0.);
  ck_assert_double_gt(factor, 0.);
  CkOk(AbutBodySolve(body, NULL));
  CkOk(AbutBodyGetSolution(body, &u));
  CkOk(VecNorm(u, NORM_2, &before));
  CkOk(AbutBodyGetLinearCost(body, 1e-8, &cpu));
  ck_assert_double_gt(cpu, 0.);
  CkOk(VecNorm(u, NORM_2, &after));
  ck_assert_double_eq(after, before); /* what it solved is forgotten */
  CkOk(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  if (!rank) printf("assembly: %.2f us per Q1 cell\n", 1e6 * seconds / cells);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("body_solver");
  TCase *tc    = tcase_create("all");
  int    failed;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  tcase_set_timeout(tc, 0);
  tcase_add_loop_test(tc, every_solver_finds_the_displacement_of_the_direct_one, 0, 6);
  tcase_add_test(tc, an_increment_is_solved_as_far_as_the_whole);
  tcase_add_test(tc, without_options_a_direct_solver_is_taken);
  tcase_add_test(tc, the_solver_goes_along_when_the_mesh_adapts);
  tcase_add_test(tc, a_body_is_described_by_its_keys);
  tcase_add_loop_test(tc, keys_that_contradict_or_are_missing_are_refused, 0, 4);
  tcase_add_test(tc, the_assembly_tells_what_a_cell_costs);
  suite_add_tcase(suite, tc);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
