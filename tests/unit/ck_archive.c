#include "ck_folder.h"

/* Values that go into an archive and come out of it; what a user's file may do wrong is in tests/robust/test_restart.py */

#define COUNT 1000

static void Exchange(AbutArchive ar, PetscInt number[2], PetscReal value[COUNT], char *text[2])
{
  CkOk(AbutArchiveInts(ar, "numbers", 2, number));
  CkOk(AbutArchiveReals(ar, "nothing", 0, NULL));
  CkOk(AbutArchiveReals(ar, "values", COUNT, value));
  for (PetscInt i = 0; i < 2; ++i) CkOk(AbutArchiveString(ar, "text", &text[i]));
  CkOk(AbutArchiveFit(ar, "what both have", "the same"));
}

START_TEST(what_went_in_comes_out)
{
  char       *in[2] = {(char *)"", (char *)"a text"}, *out[2] = {NULL, NULL};
  PetscInt    number[2] = {-7, PETSC_MAX_INT}, back[2] = {0, 0};
  PetscReal   value[COUNT], got[COUNT];
  PetscBool   reads;
  AbutArchive ar;

  for (PetscInt i = 0; i < COUNT; ++i) value[i] = PetscSinReal(i) * PetscPowReal(10., i % 600 - 300.);
  CkOk(AbutArchiveCreate(PETSC_COMM_WORLD, &ar));
  CkOk(AbutArchiveReads(ar, &reads));
  ck_assert(!reads);
  Exchange(ar, number, value, in);
  CkOk(AbutArchiveWrite(ar, CkPath("archive")));
  CkOk(AbutArchiveDestroy(&ar));
  CkOk(AbutArchiveOpen(PETSC_COMM_WORLD, "restart", CkPath("archive"), &ar));
  CkOk(AbutArchiveReads(ar, &reads));
  ck_assert(reads);
  Exchange(ar, back, got, out);
  for (PetscInt i = 0; i < 2; ++i) {
    ck_assert_int_eq(back[i], number[i]);
    ck_assert_str_eq(out[i], in[i]);
    CkOk(PetscFree(out[i]));
  }
  for (PetscInt i = 0; i < COUNT; ++i) ck_assert(got[i] == value[i]);
  CkOk(AbutArchiveDestroy(&ar));
}
END_TEST

START_TEST(another_name_kind_or_number_is_refused)
{
  PetscInt       number[2] = {1, 2}, one;
  PetscReal      value     = 1.;
  char          *text      = NULL;
  AbutArchive    ar;
  PetscErrorCode code = PETSC_SUCCESS;

  CkOk(AbutArchiveCreate(PETSC_COMM_WORLD, &ar));
  CkOk(AbutArchiveInts(ar, "numbers", 2, number));
  CkOk(AbutArchiveFit(ar, "the colour", "red"));
  CkOk(AbutArchiveWrite(ar, CkPath("archive")));
  CkOk(AbutArchiveDestroy(&ar));
  for (PetscInt wrong = 0; wrong < 6; ++wrong) {
    CkOk(AbutArchiveOpen(PETSC_COMM_WORLD, "restart", CkPath("archive"), &ar));
    if (wrong > 3) CkOk(AbutArchiveInts(ar, "numbers", 2, number));
    if (wrong == 0) CkCatch(code = AbutArchiveInts(ar, "others", 2, number));
    if (wrong == 1) CkCatch(code = AbutArchiveInts(ar, "numbers", 1, &one));
    if (wrong == 2) CkCatch(code = AbutArchiveReals(ar, "numbers", 1, &value));
    if (wrong == 3) CkCatch(code = AbutArchiveString(ar, "numbers", &text));
    if (wrong == 4) CkCatch(code = AbutArchiveFit(ar, "the colour", "green"));
    if (wrong == 5) {
      CkOk(AbutArchiveFit(ar, "the colour", "red"));
      CkCatch(code = AbutArchiveInts(ar, "more", 1, &one)); /* there is no more */
    }
    ck_assert_int_eq(code, PETSC_ERR_USER_INPUT);
    ck_assert_ptr_nonnull(strstr(ck_line, "restart: "));
    ck_assert_ptr_nonnull(strstr(ck_line, CkPath("archive")));
    if (wrong == 4) ck_assert_ptr_nonnull(strstr(ck_line, "the colour is \"red\" there and \"green\" here"));
    else ck_assert_ptr_nonnull(strstr(ck_line, "it belongs to another scene"));
    CkOk(AbutArchiveDestroy(&ar));
  }
}
END_TEST

START_TEST(counts_beyond_the_file_and_values_that_are_none_are_refused)
{
  const PetscInt count[3] = {-1, 89, 88}, rest = 88; /* bytes of one number with its title */

  for (PetscInt i = 0; i < 3; ++i) {
    PetscInt       n     = count[i];
    PetscReal      value = i ? NAN : 1.;
    AbutArchive    ar;
    PetscErrorCode code = PETSC_SUCCESS;

    CkOk(AbutArchiveCreate(PETSC_COMM_WORLD, &ar));
    CkOk(AbutArchiveCount(ar, "things", &n));
    CkOk(AbutArchiveReals(ar, "value", 1, &value));
    CkOk(AbutArchiveWrite(ar, CkPath("archive")));
    CkOk(AbutArchiveDestroy(&ar));
    CkOk(AbutArchiveOpen(PETSC_COMM_WORLD, "restart", CkPath("archive"), &ar));
    CkCatch(code = AbutArchiveCount(ar, "things", &n));
    ck_assert_int_eq(code, n < 0 || n > rest ? PETSC_ERR_USER_INPUT : PETSC_SUCCESS);
    CkCatch(code = AbutArchiveReals(ar, "value", 1, &value));
    ck_assert_int_eq(code, i ? PETSC_ERR_USER_INPUT : PETSC_SUCCESS);
    CkOk(AbutArchiveDestroy(&ar));
  }
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("archive");
  TCase *tests = tcase_create("all");
  int    failed;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  tcase_add_checked_fixture(tests, CkFolderMake, CkFolderRemove);
  tcase_add_test(tests, what_went_in_comes_out);
  tcase_add_test(tests, another_name_kind_or_number_is_refused);
  tcase_add_test(tests, counts_beyond_the_file_and_values_that_are_none_are_refused);
  suite_add_tcase(suite, tests);
  failed = CkRun(suite);
  return AbutFinalize() || failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
