/* The record, the CSV and what is refused before any work; fields are in ck_fields.c */
#include "ck_folder.h"
#include <abutrecorder.h>

/* A recorder with the option `key` set to the file `name` of the test's folder */
static AbutRecorder Recorder(const char key[], const char name[])
{
  AbutRecorder rec;

  if (key) CkOk(PetscOptionsSetValue(NULL, key, CkPath(name)));
  CkOk(AbutRecorderCreate(PETSC_COMM_WORLD, &rec));
  CkOk(AbutRecorderSetFromOptions(rec));
  return rec;
}

/* The file holds exactly this text, seen from every rank */
static void CheckFile(const char name[], const char expected[])
{
  char  text[4096] = "";
  FILE *f          = fopen(CkPath(name), "r");

  ck_assert_msg(f, "there is no file %s", name);
  text[fread(text, 1, sizeof(text) - 1, f)] = 0;
  fclose(f);
  ck_assert_str_eq(text, expected);
  CkOk(MPI_Barrier(PETSC_COMM_WORLD)); /* nobody goes on to replace the file while another rank reads */
}

#define CkRefused(call, code, words) \
  do { \
    PetscErrorCode ierr_refused; \
    CkCatch(ierr_refused = call); \
    ck_assert_int_eq(ierr_refused, code); \
    ck_assert_msg(strstr(ck_line, words), "\"%s\" does not speak of %s", ck_line, words); \
    ck_assert_msg(!strchr(ck_line, '\n'), "\"%s\" has more than one line", ck_line); \
  } while (0)

static void CheckOptionRefused(const char key[], const char value[], const char words[])
{
  AbutRecorder rec;

  CkOk(PetscOptionsSetValue(NULL, key, value));
  CkOk(AbutRecorderCreate(PETSC_COMM_WORLD, &rec));
  CkRefused(AbutRecorderSetFromOptions(rec), PETSC_ERR_USER_INPUT, words);
  CkOk(AbutRecorderDestroy(&rec));
  CkOk(PetscOptionsClearValue(NULL, key));
}

START_TEST(a_key_set_again_replaces_its_value_and_keeps_its_place)
{
  AbutRecorder rec = Recorder("-record", "run.record");

  CkOk(AbutRecorderSetString(rec, "verdict", "stopped: too many sweeps"));
  CkOk(AbutRecorderSetReal(rec, "pair.mid.force", 1. / 3.));
  CkOk(AbutRecorderSetInt(rec, "cycles", 7));
  CkOk(AbutRecorderSetReal(rec, "pair.mid.force", -2.e-7 / 3.));
  CkOk(AbutRecorderSetString(rec, "verdict", "converged"));
  CkOk(AbutRecorderWrite(rec));
  CheckFile("run.record", "verdict converged\npair.mid.force -6.666666667e-08\ncycles 7\n");
  CkOk(AbutRecorderDestroy(&rec));
}
END_TEST

START_TEST(hundreds_of_keys_and_cycles_are_kept)
{
  AbutRecorder rec = Recorder("-record_csv", "run.csv");
  char         key[16], line[16];
  FILE        *f;

  for (PetscInt i = 0; i < 300; ++i) {
    CkOk(PetscSNPrintf(key, sizeof(key), "k%" PetscInt_FMT, i));
    CkOk(AbutRecorderSetInt(rec, key, i));
  }
  for (PetscInt i = 0; i < 100; ++i) {
    CkOk(AbutRecorderSetInt(rec, "k299", i));
    CkOk(AbutRecorderEndCycle(rec));
  }
  f = fopen(CkPath("run.csv"), "r");
  ck_assert_ptr_nonnull(f);
  ck_assert_int_eq(fseek(f, -8, SEEK_END), 0);
  ck_assert_ptr_nonnull(fgets(line, sizeof(line), f));
  fclose(f);
  ck_assert_str_eq(line, ",298,99\n");
  CkOk(AbutRecorderDestroy(&rec));
}
END_TEST

START_TEST(a_number_that_is_not_finite_is_refused_and_its_key_named)
{
  AbutRecorder rec = Recorder("-record", "run.record");

  CkOk(AbutRecorderSetReal(rec, "energy.strain", 2.5));
  CkRefused(AbutRecorderSetReal(rec, "energy.strain", NAN), PETSC_ERR_FP, "energy.strain");
  CkRefused(AbutRecorderSetReal(rec, "eta.lower", INFINITY), PETSC_ERR_FP, "eta.lower");
  CkOk(AbutRecorderWrite(rec));
  CheckFile("run.record", "energy.strain 2.5\n");
  CkOk(AbutRecorderDestroy(&rec));
}
END_TEST

START_TEST(what_would_break_a_line_is_refused)
{
  AbutRecorder rec = Recorder(NULL, NULL);

  CkRefused(AbutRecorderSetInt(rec, "two words", 1), PETSC_ERR_ARG_WRONG, "two words");
  CkRefused(AbutRecorderSetInt(rec, "a,b", 1), PETSC_ERR_ARG_WRONG, "a,b");
  CkRefused(AbutRecorderSetInt(rec, "", 1), PETSC_ERR_ARG_WRONG, "not a key");
  CkRefused(AbutRecorderSetString(rec, "verdict", "not\nconverged"), PETSC_ERR_ARG_WRONG, "verdict");
  CkOk(AbutRecorderDestroy(&rec));
}
END_TEST

START_TEST(the_csv_has_the_keys_of_all_cycles_and_empty_cells_for_those_not_yet_known)
{
  AbutRecorder rec = Recorder("-record_csv", "run.csv");

  CkOk(AbutRecorderSetInt(rec, "cycles", 1));
  CkOk(AbutRecorderSetString(rec, "verdict", "none, \"yet\""));
  CkOk(AbutRecorderEndCycle(rec));
  CheckFile("run.csv", "cycles,verdict\n1,\"none, \"\"yet\"\"\"\n"); /* on disk after every cycle */
  CkOk(AbutRecorderSetInt(rec, "cycles", 2));
  CkOk(AbutRecorderSetReal(rec, "eta.lower", .25));
  CkOk(AbutRecorderSetString(rec, "verdict", "converged"));
  CkOk(AbutRecorderEndCycle(rec));
  CkOk(AbutRecorderSetReal(rec, "time.total", 3.));
  CkOk(AbutRecorderWrite(rec));
  CheckFile("run.csv", "cycles,verdict,eta.lower,time.total\n1,\"none, \"\"yet\"\"\",,\n2,converged,0.25,\n");
  CkOk(AbutRecorderDestroy(&rec));
}
END_TEST

START_TEST(a_file_is_replaced_as_a_whole_and_nothing_is_left_aside)
{
  AbutRecorder rec      = Recorder("-record", "run.record");
  char         text[64] = "";
  FILE        *f;

  CkOk(AbutRecorderSetInt(rec, "cycles", 1));
  CkOk(AbutRecorderWrite(rec));
  f = fopen(CkPath("run.record"), "r");
  ck_assert_ptr_nonnull(f);
  CkOk(MPI_Barrier(PETSC_COMM_WORLD));
  CkOk(AbutRecorderSetInt(rec, "cycles", 2));
  CkOk(AbutRecorderWrite(rec));
  ck_assert_ptr_nonnull(fgets(text, sizeof(text), f)); /* who reads the old file sees all of the old file */
  fclose(f);
  ck_assert_str_eq(text, "cycles 1\n");
  CheckFile("run.record", "cycles 2\n");
  ck_assert(!CkExists("run.record.part"));
  CkOk(AbutRecorderDestroy(&rec));
}
END_TEST

START_TEST(without_options_nothing_is_written)
{
  AbutRecorder rec = Recorder(NULL, NULL);
  PetscBool    wants;

  CkOk(AbutRecorderSetInt(rec, "cycles", 1));
  CkOk(AbutRecorderEndCycle(rec));
  CkOk(AbutRecorderWantsFields(rec, &wants));
  ck_assert(!wants);
  CkOk(AbutRecorderWriteFields(rec, 0, 0, NULL, NULL));
  CkOk(AbutRecorderWriteProfile(rec, NULL, 0, NULL));
  CkOk(AbutRecorderWrite(rec));
  if (CkRank() == 0) ck_assert_int_eq(rmdir(ck_folder), 0); /* which only an empty folder allows */
  if (CkRank() == 0) ck_assert_int_eq(mkdir(ck_folder, 0777), 0);
  CkOk(AbutRecorderDestroy(&rec));
}
END_TEST

START_TEST(a_file_that_cannot_be_written_is_refused_before_any_work)
{
  CheckOptionRefused("-record", CkPath("nowhere/run.record"), "there is no folder");
  CheckOptionRefused("-record_csv", ck_folder, "is a folder");
  CheckOptionRefused("-output", CkPath("nowhere/run.xdmf"), "output: there is no folder");
  CheckOptionRefused("-output", CkPath("run.vtk"), "FILE.xdmf or FILE.vtu");
  CheckOptionRefused("-output", CkPath(".vtu"), "FILE.xdmf or FILE.vtu");
  CheckOptionRefused("-output", CkPath("a&b.xdmf"), "XML");
  CheckOptionRefused("-output_profile", CkPath("run.txt"), "FILE.csv");
  CheckOptionRefused("-record", "", "no file");
  if (geteuid()) CheckOptionRefused("-record", "/run.record", "not writable"); /* root may write everywhere */
  CkOk(PetscOptionsSetValue(NULL, "-record", CkPath("same.csv")));
  CheckOptionRefused("-record_csv", CkPath("same.csv"), "also the file of record");
}
END_TEST

START_TEST(a_file_that_fails_later_is_an_error_on_all_ranks)
{
  AbutRecorder rec = Recorder("-record", "run.record");

  if (CkRank() == 0) ck_assert_int_eq(mkdir(CkPath("run.record"), 0777), 0);
  CkRefused(AbutRecorderWrite(rec), PETSC_ERR_FILE_WRITE, "run.record");
  ck_assert(!CkExists("run.record.part"));
  CkOk(AbutRecorderDestroy(&rec));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("recorder");
  TCase *tc    = tcase_create("record");
  int    status;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  suite_add_tcase(suite, tc);
  tcase_add_checked_fixture(tc, CkFolderMake, CkFolderRemove);
  tcase_add_test(tc, a_key_set_again_replaces_its_value_and_keeps_its_place);
  tcase_add_test(tc, hundreds_of_keys_and_cycles_are_kept);
  tcase_add_test(tc, a_number_that_is_not_finite_is_refused_and_its_key_named);
  tcase_add_test(tc, what_would_break_a_line_is_refused);
  tcase_add_test(tc, the_csv_has_the_keys_of_all_cycles_and_empty_cells_for_those_not_yet_known);
  tcase_add_test(tc, a_file_is_replaced_as_a_whole_and_nothing_is_left_aside);
  tcase_add_test(tc, without_options_nothing_is_written);
  tcase_add_test(tc, a_file_that_cannot_be_written_is_refused_before_any_work);
  tcase_add_test(tc, a_file_that_fails_later_is_an_error_on_all_ranks);
  status = CkRun(suite);
  return AbutFinalize() ? EXIT_FAILURE : status;
}
