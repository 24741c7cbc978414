#pragma once

#include <check.h>
#include <abutsys.h>

/* What every unit test needs: one suite run by all ranks at once, and a look at the line of a bad input */

static char ck_line[2048]; /* of the last error caught by CkCatch() */

static inline PetscErrorCode CkKeepLine(PETSC_UNUSED MPI_Comm comm, PETSC_UNUSED int line, PETSC_UNUSED const char *function,
                                        PETSC_UNUSED const char *file, PetscErrorCode code, PetscErrorType type, const char *message,
                                        PETSC_UNUSED void *ctx)
{
  if (type == PETSC_ERROR_INITIAL) snprintf(ck_line, sizeof(ck_line), "%s", message);
  return code;
}

/* CkCatch(code = Call(...)); runs the call with errors kept in ck_line instead of printed */
#define CkCatch(call) \
  do { \
    ck_line[0] = 0; \
    ck_assert_int_eq(PetscPushErrorHandler(CkKeepLine, NULL), 0); \
    call; \
    ck_assert_int_eq(PetscPopErrorHandler(), 0); \
  } while (0)

#define CkOk(call) ck_assert_int_eq((call), 0)

/* A line of the table of `make suite`: of a case of tests/cases.py, what was measured and the most it may be */
static inline void CkCase(const char name[], const char criterion[], double measured, double most)
{
  PetscMPIInt rank;

  CkOk(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  if (!rank) printf("case %s | %s | %.3g | at most %g | %s\n", name, criterion, measured, most, measured <= most ? "pass" : "FAIL");
  ck_assert_double_le(measured, most);
}

/* Ranks must not fork; what failed on one rank has failed */
static inline int CkRun(Suite *suite)
{
  SRunner *runner = srunner_create(suite);
  int      failed;

  srunner_set_fork_status(runner, CK_NOFORK);
  srunner_run_all(runner, CK_NORMAL);
  failed = srunner_ntests_failed(runner);
  srunner_free(runner);
  if (MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD)) failed = 1;
  return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
