#include "ck_box.h"
#include <abutestimator.h>

/* Several estimators at once against each of them alone */

static PetscErrorCode Displacement(const PetscReal x[2], PetscReal *value, PETSC_UNUSED void *ctx)
{
  *value = PetscExpReal(x[0]) * PetscSinReal(x[1] + 0.3);
  return PETSC_SUCCESS;
}

static AbutBody Solved(void)
{
  AbutBody body = CkBox(PETSC_COMM_WORLD, ABUT_QUAD, 1., 6, 6, Displacement, Displacement);

  CkRefine(body, 0.5, 0.5, 0.3);
  CkOk(AbutBodySolve(body, NULL));
  return body;
}

/* The indicators of a type with some options, and the unknowns it solved for */
static Vec Estimate(AbutBody body, const char options[], PetscInt *unknowns)
{
  AbutEstimator est;
  Vec           eta;

  CkOk(PetscOptionsInsertString(NULL, options));
  CkOk(AbutEstimatorCreate(PETSC_COMM_WORLD, &est));
  CkOk(AbutEstimatorSetFromOptions(est));
  CkOk(AbutOptionsCheckAllRead(PETSC_COMM_WORLD, PETSC_TRUE));
  CkOk(PetscOptionsClear(NULL));
  CkOk(AbutBodyCreateCellVec(body, &eta));
  CkOk(AbutEstimatorEstimate(est, body, eta));
  CkOk(AbutEstimatorGetUnknowns(est, unknowns));
  CkOk(AbutEstimatorDestroy(&est));
  return eta;
}

/* The largest difference of two, and of the second from zero */
static void Compare(Vec a, Vec b, PetscReal *difference, PetscReal *size)
{
  CkOk(VecNorm(b, NORM_INFINITY, size));
  CkOk(VecAXPY(b, -1., a));
  CkOk(VecNorm(b, NORM_INFINITY, difference));
}

START_TEST(two_types_give_what_each_gives)
{
  const char *const both[] = {"-estimator_type fembem,zz -estimator_fembem_solve none",
                              "-estimator_type zz,fembem -estimator_fembem_solve none -estimator_combine max",
                              "-estimator_type fembem,zz -estimator_fembem_solve none -estimator_combine sum"};
  AbutBody          body   = Solved();
  PetscInt          unknowns;
  PetscReal         difference, size;
  Vec               zz     = Estimate(body, "-estimator_type zz", &unknowns), all, wanted;
  Vec               fembem = Estimate(body, "-estimator_type fembem -estimator_fembem_solve none", &unknowns);

  CkOk(VecDuplicate(zz, &wanted));
  if (_i < 2) CkOk(VecPointwiseMax(wanted, zz, fembem));
  else {
    CkOk(VecPointwiseMult(wanted, zz, zz));
    CkOk(VecPointwiseMult(fembem, fembem, fembem));
    CkOk(VecAXPY(wanted, 1., fembem));
    CkOk(VecSqrtAbs(wanted));
  }
  all = Estimate(body, both[_i], &unknowns);
  Compare(all, wanted, &difference, &size);
  ck_assert_double_gt(size, 1e-2);
  ck_assert_double_lt(difference, 1e-14);
  Compare(zz, all, &difference, &size);
  ck_assert_double_gt(difference, 1e-3); /* zz alone is something else */
  CkOk(VecDestroy(&zz));
  CkOk(VecDestroy(&fembem));
  CkOk(VecDestroy(&wanted));
  CkOk(VecDestroy(&all));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(the_unknowns_add_up)
{
  AbutBody body = Solved();
  PetscInt alone, all;
  Vec      eta = Estimate(body, "-estimator_type fembem", &alone);

  CkOk(VecDestroy(&eta));
  eta = Estimate(body, "-estimator_type zz,fembem", &all); /* zz solves nothing */
  ck_assert_int_gt(alone, 0);
  ck_assert_int_eq(all, alone);
  CkOk(VecDestroy(&eta));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

static PetscErrorCode Fill(AbutBody body, PetscReal value, PetscReal eta[])
{
  for (PetscInt c = 0; c < CkTopology(body)->ncells; ++c) eta[c] = value;
  return PETSC_SUCCESS;
}

static PetscErrorCode Estimate_Solving(AbutEstimator est, AbutBody body, PetscReal eta[])
{
  CkOk(AbutEstimatorSetUnknowns(est, 7));
  return Fill(body, 1., eta);
}

static PetscErrorCode Estimate_Broken(PETSC_UNUSED AbutEstimator est, AbutBody body, PetscReal eta[])
{
  return Fill(body, NAN, eta);
}

static PetscErrorCode Create_Solving(AbutEstimator est)
{
  const AbutEstimatorOps ops = {.estimate = Estimate_Solving};

  return AbutEstimatorSetOps(est, &ops);
}

static PetscErrorCode Create_Broken(AbutEstimator est)
{
  const AbutEstimatorOps ops = {.estimate = Estimate_Broken};

  return AbutEstimatorSetOps(est, &ops);
}

START_TEST(the_part_that_gives_no_number_is_named)
{
  AbutBody       body = Solved();
  AbutEstimator  est;
  PetscErrorCode code;
  Vec            eta;

  CkOk(AbutEstimatorRegister("broken", Create_Broken));
  CkOk(AbutBodyCreateCellVec(body, &eta));
  CkOk(AbutEstimatorCreate(PETSC_COMM_WORLD, &est));
  CkOk(AbutEstimatorSetType(est, "zz,broken"));
  CkCatch(code = AbutEstimatorEstimate(est, body, eta));
  ck_assert_int_eq(code, PETSC_ERR_FP);
  ck_assert_msg(strstr(ck_line, "\"broken\""), "%s", ck_line);
  CkOk(VecDestroy(&eta));
  CkOk(AbutEstimatorDestroy(&est));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(three_types_are_as_good_as_two)
{
  AbutBody body = Solved();
  PetscInt unknowns[2];
  Vec      eta;

  CkOk(AbutEstimatorRegister("solving", Create_Solving));
  eta = Estimate(body, "-estimator_type fembem", &unknowns[0]);
  CkOk(VecDestroy(&eta));
  eta = Estimate(body, "-estimator_type solving,fembem,zz", &unknowns[1]);
  ck_assert_int_eq(unknowns[1], unknowns[0] + 7);
  CkOk(VecDestroy(&eta));
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(a_list_may_have_blanks_but_no_empty_name_and_none_twice)
{
  static const struct {
    const char *type, *line;
  } bad[] = {
    {"zz,",           "estimator_type: \"zz,\" has an empty name; "            },
    {",zz",           "estimator_type: \",zz\" has an empty name; "            },
    {"zz, ,fembem",   "estimator_type: \"zz, ,fembem\" has an empty name; "    },
    {",",             "estimator_type: \",\" has an empty name; "              },
    {"zz,fembem, zz", "estimator_type: \"zz\" is there twice in "              },
    {"a,b",           "estimator_type: no estimator named \"a\"; there are: "  },
    {"zz,bad",        "estimator_type: no estimator named \"bad\"; there are: "},
  };
  AbutEstimator     est;
  AbutEstimatorType type;
  PetscErrorCode    code;

  CkOk(AbutEstimatorCreate(PETSC_COMM_WORLD, &est));
  CkOk(AbutEstimatorSetType(est, " zz , fembem "));
  for (size_t i = 0; i < sizeof(bad) / sizeof(bad[0]); ++i) {
    CkCatch(code = AbutEstimatorSetType(est, bad[i].type));
    ck_assert_int_eq(code, PETSC_ERR_USER_INPUT);
    ck_assert_msg(!strncmp(ck_line, bad[i].line, strlen(bad[i].line)), "%s", ck_line);
    CkOk(AbutEstimatorGetType(est, &type));
    ck_assert_str_eq(type, " zz , fembem "); /* a bad list changes nothing */
  }
  CkOk(AbutEstimatorDestroy(&est));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("combined");
  TCase *tests = tcase_create("estimators");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  tcase_add_loop_test(tests, two_types_give_what_each_gives, 0, 3);
  tcase_add_test(tests, the_unknowns_add_up);
  tcase_add_test(tests, the_part_that_gives_no_number_is_named);
  tcase_add_test(tests, three_types_are_as_good_as_two);
  tcase_add_test(tests, a_list_may_have_blanks_but_no_empty_name_and_none_twice);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
