#include "ck.h"
#include <abutestimator.h>

/* The class AbutEstimator with estimators made up here */

static PetscInt fake_estimates, fake_destroyed;

typedef struct {
  PetscReal value;
} Fake;

static PetscErrorCode Estimate_Fake(AbutEstimator est, PETSC_UNUSED AbutBody body, PetscReal eta[])
{
  Fake *fake;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &fake));
  for (PetscInt c = 0; c < 3; ++c) eta[c] = fake->value;
  ++fake_estimates;
  PetscCall(AbutEstimatorSetUnknowns(est, 7));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetFromOptions_Fake(AbutEstimator est, AbutOptionItems PetscOptionsObject)
{
  Fake *fake;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &fake));
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-estimator_fake_value", "what it says of every cell", &fake->value, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy_Fake(AbutEstimator est)
{
  Fake *fake;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &fake));
  PetscCall(PetscFree(fake));
  ++fake_destroyed;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create_Fake(AbutEstimator est)
{
  const AbutEstimatorOps ops = {Estimate_Fake, SetFromOptions_Fake, NULL, Destroy_Fake};
  Fake                  *fake;

  PetscFunctionBegin;
  PetscCall(PetscNew(&fake));
  PetscCall(AbutEstimatorSetData(est, fake));
  PetscCall(AbutEstimatorSetOps(est, &ops));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create_Lazy(PETSC_UNUSED AbutEstimator est)
{
  return PETSC_SUCCESS;
}

static PetscBool IsMapped(const char library[])
{
  FILE     *f = fopen("/proc/self/maps", "r");
  char      line[4096];
  PetscBool found = PETSC_FALSE;

  while (f && fgets(line, sizeof(line), f)) found = found || strstr(line, library) ? PETSC_TRUE : PETSC_FALSE;
  if (f) fclose(f);
  return found;
}

/* First of all tests, before any estimator is made */
START_TEST(a_run_without_an_estimator_has_no_event_and_opens_no_plugin)
{
  PetscLogEvent event = 0;

  CkOk(PetscLogEventGetId("AbutEstimate", &event));
  ck_assert_int_eq(event, -1);
  ck_assert(!IsMapped("libestimator_"));
}
END_TEST

START_TEST(an_estimator_is_asked_once_and_what_it_says_comes_back)
{
  AbutEstimator     est;
  AbutEstimatorType type;
  Vec               eta;
  PetscReal         least, most;
  PetscInt          unknowns;

  CkOk(AbutEstimatorRegister("fake", Create_Fake));
  CkOk(PetscOptionsInsertString(NULL, "-estimator_type fake -estimator_fake_value 0.25"));
  CkOk(AbutEstimatorCreate(PETSC_COMM_WORLD, &est));
  CkOk(AbutEstimatorSetFromOptions(est));
  CkOk(PetscOptionsClear(NULL));
  CkOk(AbutEstimatorGetType(est, &type));
  ck_assert_str_eq(type, "fake");
  CkOk(VecCreateMPI(PETSC_COMM_WORLD, 3, PETSC_DETERMINE, &eta));
  fake_estimates = 0;
  CkOk(AbutEstimatorEstimate(est, NULL, eta));
  ck_assert_int_eq(fake_estimates, 1);
  CkOk(VecMin(eta, NULL, &least));
  CkOk(VecMax(eta, NULL, &most));
  ck_assert_double_eq(least, 0.25);
  ck_assert_double_eq(most, 0.25);
  CkOk(AbutEstimatorGetUnknowns(est, &unknowns));
  ck_assert_int_eq(unknowns, 7);
  ck_assert(!IsMapped("libestimator_")); /* the type was there: no file was opened for it */
  CkOk(VecDestroy(&eta));
  CkOk(AbutEstimatorDestroy(&est));
}
END_TEST

START_TEST(another_type_and_destroy_free_the_data)
{
  AbutEstimator est;

  CkOk(AbutEstimatorRegister("fake2", Create_Fake));
  fake_destroyed = 0;
  CkOk(AbutEstimatorCreate(PETSC_COMM_WORLD, &est));
  CkOk(AbutEstimatorSetType(est, "fake"));
  CkOk(AbutEstimatorSetType(est, "fake"));
  ck_assert_int_eq(fake_destroyed, 0);
  CkOk(AbutEstimatorSetType(est, "fake2"));
  ck_assert_int_eq(fake_destroyed, 1);
  CkOk(AbutEstimatorDestroy(&est));
  ck_assert_int_eq(fake_destroyed, 2);
  ck_assert_ptr_null(est);
}
END_TEST

START_TEST(an_unknown_name_is_answered_with_the_names_there_are)
{
  AbutEstimator  est;
  PetscErrorCode code;
  const char    *start = "estimator_type: no estimator named \"zzz\"; there are: ";
  const char    *hint  = " (a plugin from elsewhere is loaded with -plugin path/to/libestimator_NAME.so; there is no ";
  const char    *end   = "libestimator_zzz.so)";

  CkOk(AbutEstimatorCreate(PETSC_COMM_WORLD, &est));
  CkCatch(code = AbutEstimatorSetType(est, "zzz"));
  ck_assert_int_eq(code, PETSC_ERR_USER_INPUT);
  ck_assert_msg(!strncmp(ck_line, start, strlen(start)), "%s", ck_line);
  ck_assert_msg(strlen(ck_line) > strlen(end) && !strcmp(ck_line + strlen(ck_line) - strlen(end), end), "%s", ck_line);
  ck_assert_msg(strstr(ck_line, "fake, fake2"), "%s", ck_line);
  ck_assert_msg(strstr(ck_line, hint), "%s", ck_line);
  ck_assert_msg(!strchr(ck_line, '\n'), "%s", ck_line);
  CkOk(AbutEstimatorDestroy(&est));
}
END_TEST

START_TEST(a_path_is_not_a_name)
{
  AbutEstimator  est;
  PetscErrorCode code;

  CkOk(AbutEstimatorCreate(PETSC_COMM_WORLD, &est));
  CkCatch(code = AbutEstimatorSetType(est, "../x"));
  ck_assert_int_eq(code, PETSC_ERR_USER_INPUT);
  ck_assert_msg(strstr(ck_line, "no estimator named \"../x\""), "%s", ck_line);
  CkOk(AbutEstimatorDestroy(&est));
}
END_TEST

START_TEST(a_plugin_path_that_is_no_folder_is_an_error)
{
  AbutEstimator  est;
  PetscErrorCode code;

  CkOk(PetscOptionsSetValue(NULL, "-plugin_path", "/nowhere/at/all"));
  CkOk(AbutEstimatorCreate(PETSC_COMM_WORLD, &est));
  CkCatch(code = AbutEstimatorSetType(est, "zzz"));
  ck_assert_int_eq(code, PETSC_ERR_USER_INPUT);
  ck_assert_str_eq(ck_line, "plugin_path: no folder \"/nowhere/at/all\"; it is the folder that holds the lib*.so of the plugins");
  CkOk(PetscOptionsClear(NULL));
  CkOk(AbutEstimatorDestroy(&est));
}
END_TEST

START_TEST(a_plugin_that_is_not_there_or_no_plugin_is_an_error_of_one_line)
{
  PetscErrorCode code;
  PetscMPIInt    rank;
  const char    *path = "/tmp/libabut_ck_estimator_text.so";

  CkCatch(code = AbutPluginAppend(PETSC_COMM_WORLD, "/nowhere/libestimator_x.so"));
  ck_assert_int_eq(code, PETSC_ERR_USER_INPUT);
  ck_assert_str_eq(ck_line, "plugin: no file \"/nowhere/libestimator_x.so\"");

  CkOk(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  if (!rank) {
    FILE *f = fopen(path, "w");

    ck_assert_ptr_nonnull(f);
    fprintf(f, "not a library\n");
    fclose(f);
  }
  CkOk(MPI_Barrier(PETSC_COMM_WORLD));
  CkCatch(code = AbutPluginAppend(PETSC_COMM_WORLD, path));
  ck_assert_int_eq(code, PETSC_ERR_USER_INPUT);
  ck_assert_msg(strstr(ck_line, "plugin: cannot open \"/tmp/libabut_ck_estimator_text.so\": "), "%s", ck_line);
  CkOk(MPI_Barrier(PETSC_COMM_WORLD));
  if (!rank) remove(path);
}
END_TEST

START_TEST(a_type_that_cannot_estimate_is_refused)
{
  AbutEstimator  est;
  PetscErrorCode code;

  CkOk(AbutEstimatorRegister("lazy", Create_Lazy));
  CkOk(AbutEstimatorCreate(PETSC_COMM_WORLD, &est));
  CkCatch(code = AbutEstimatorSetType(est, "lazy"));
  ck_assert_int_eq(code, PETSC_ERR_USER_INPUT);
  ck_assert_msg(strstr(ck_line, "the create routine of \"lazy\" set no function estimate"), "%s", ck_line);
  CkOk(AbutEstimatorDestroy(&est));
}
END_TEST

START_TEST(an_indicator_that_is_not_a_number_is_an_error)
{
  AbutEstimator  est;
  PetscErrorCode code;
  Fake          *fake;
  Vec            eta;

  CkOk(AbutEstimatorCreate(PETSC_COMM_WORLD, &est));
  CkOk(AbutEstimatorSetType(est, "fake"));
  CkOk(AbutEstimatorGetData(est, &fake));
  fake->value = NAN;
  CkOk(VecCreateMPI(PETSC_COMM_WORLD, 3, PETSC_DETERMINE, &eta));
  CkCatch(code = AbutEstimatorEstimate(est, NULL, eta));
  ck_assert_int_eq(code, PETSC_ERR_FP);
  CkOk(VecDestroy(&eta));
  CkOk(AbutEstimatorDestroy(&est));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("estimator");
  TCase *tests = tcase_create("class");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  PetscCall(PetscLogDefaultBegin());
  tcase_add_test(tests, a_run_without_an_estimator_has_no_event_and_opens_no_plugin);
  tcase_add_test(tests, an_estimator_is_asked_once_and_what_it_says_comes_back);
  tcase_add_test(tests, another_type_and_destroy_free_the_data);
  tcase_add_test(tests, an_unknown_name_is_answered_with_the_names_there_are);
  tcase_add_test(tests, a_path_is_not_a_name);
  tcase_add_test(tests, a_plugin_path_that_is_no_folder_is_an_error);
  tcase_add_test(tests, a_plugin_that_is_not_there_or_no_plugin_is_an_error_of_one_line);
  tcase_add_test(tests, a_type_that_cannot_estimate_is_refused);
  tcase_add_test(tests, an_indicator_that_is_not_a_number_is_an_error);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
