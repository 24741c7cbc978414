#include "ck_box.h"
#include <abutadaptor.h>

/* Marks on a mesh of 4x4 quads, whose cells get an indicator by the place of their middle */

static AbutAdaptor Adaptor(const char options[])
{
  AbutAdaptor adaptor;

  CkOk(PetscOptionsInsertString(NULL, options));
  CkOk(AbutAdaptorCreate(PETSC_COMM_WORLD, &adaptor));
  CkOk(AbutAdaptorSetFromOptions(adaptor));
  CkOk(PetscOptionsClear(NULL));
  return adaptor;
}

static void Middle(const AbutMeshTopology *t, PetscInt c, PetscReal x[2])
{
  x[0] = x[1] = 0.;
  for (PetscInt k = 0; k < t->corners; ++k)
    for (PetscInt i = 0; i < 2; ++i) x[i] += t->x[2 * t->cell[t->corners * c + k] + i] / t->corners;
}

/* eta is high in the first column, low elsewhere; gives the verdict and, over all ranks, the number of marks and of those in that column */
static AbutAdaptVerdict Mark(const char options[], AbutBody body, PetscReal high, PetscReal low, PetscInt *marked, PetscInt *first)
{
  const AbutMeshTopology *t       = CkTopology(body);
  AbutAdaptor             adaptor = Adaptor(options);
  AbutAdaptVerdict        verdict;
  PetscBool              *mark;
  PetscReal              *e, x[2];
  PetscInt                count[2] = {0, 0};
  Vec                     eta;

  CkOk(AbutBodyCreateCellVec(body, &eta));
  CkOk(VecGetArray(eta, &e));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    Middle(t, c, x);
    e[c] = x[0] < 0.25 ? high : low;
  }
  CkOk(VecRestoreArray(eta, &e));
  CkOk(PetscMalloc1(t->ncells, &mark));
  CkOk(AbutAdaptorMark(adaptor, body, eta, NULL, mark, marked, &verdict));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    Middle(t, c, x);
    count[0] += mark[c];
    count[1] += mark[c] && x[0] < 0.25;
  }
  CkOk(MPI_Allreduce(MPI_IN_PLACE, count, 2, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  ck_assert_int_eq(count[0], *marked);
  *first = count[1];
  CkOk(PetscFree(mark));
  CkOk(VecDestroy(&eta));
  CkOk(AbutAdaptorDestroy(&adaptor));
  return verdict;
}

START_TEST(cells_above_the_threshold_are_marked_and_no_others)
{
  AbutBody body = CkBox(PETSC_COMM_WORLD, ABUT_QUAD, 1., 4, 4, NULL, NULL);
  PetscInt marked, first;

  ck_assert_int_eq(Mark("", body, 0.11, 0.1, &marked, &first), ABUT_ADAPT_REFINED); /* 0.1 is not above 0.1, the default */
  ck_assert_int_eq(marked, 4);
  ck_assert_int_eq(first, 4);
  ck_assert_int_eq(Mark("-adaptor_threshold 0.05", body, 0.11, 0.1, &marked, &first), ABUT_ADAPT_REFINED);
  ck_assert_int_eq(marked, 16);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(nothing_above_the_threshold_is_done)
{
  AbutBody body = CkBox(PETSC_COMM_WORLD, ABUT_QUAD, 1., 4, 4, NULL, NULL);
  PetscInt marked, first;

  ck_assert_int_eq(Mark("-adaptor_threshold 0.2 -adaptor_max_level 0 -adaptor_max_unknowns 1", body, 0.2, 0., &marked, &first),
                   ABUT_ADAPT_DONE);
  ck_assert_int_eq(marked, 0);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(cells_of_the_last_level_are_left_alone_until_only_they_are_left)
{
  AbutBody body = CkBox(PETSC_COMM_WORLD, ABUT_QUAD, 1., 4, 4, NULL, NULL);
  PetscInt marked, first;

  ck_assert_int_eq(Mark("-adaptor_max_level 0", body, 1., 0., &marked, &first), ABUT_ADAPT_LEVEL);
  ck_assert_int_eq(marked, 0);
  CkRefine(body, 0., 0., 0.1); /* the first cell becomes four of level 1, so that the first column has 3 + 4 cells */
  ck_assert_int_eq(Mark("-adaptor_max_level 1", body, 1., 0., &marked, &first), ABUT_ADAPT_REFINED);
  ck_assert_int_eq(marked, 3);
  ck_assert_int_eq(Mark("-adaptor_max_level 2", body, 1., 0., &marked, &first), ABUT_ADAPT_REFINED);
  ck_assert_int_eq(marked, 7);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(no_refinement_passes_the_cap_on_unknowns)
{
  AbutBody body = CkBox(PETSC_COMM_WORLD, ABUT_QUAD, 1., 4, 4, NULL,
                        NULL); /* 50 unknowns; 4 of 16 cells marked make about 50*(1 + 3/4) = 87.5 */
  PetscInt marked, first;

  ck_assert_int_eq(Mark("-adaptor_max_unknowns 88", body, 1., 0., &marked, &first), ABUT_ADAPT_REFINED);
  ck_assert_int_eq(marked, 4);
  ck_assert_int_eq(Mark("-adaptor_max_unknowns 87", body, 1., 0., &marked, &first), ABUT_ADAPT_UNKNOWNS);
  ck_assert_int_eq(marked, 0);
  ck_assert_int_eq(Mark("-adaptor_max_unknowns 50", body, 1., 0., &marked, &first), ABUT_ADAPT_UNKNOWNS);
  ck_assert_int_eq(marked, 0);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(the_bodies_to_adapt_are_read_and_no_list_means_all)
{
  AbutAdaptor        adaptor = Adaptor("");
  PetscInt           n       = -1;
  const char *const *name;

  CkOk(AbutAdaptorGetBodies(adaptor, &n, &name));
  ck_assert_int_eq(n, 0);
  CkOk(AbutAdaptorDestroy(&adaptor));
  CkOk(PetscOptionsSetValue(NULL, "-adaptor_bodies", "lower, upper"));
  adaptor = Adaptor("");
  CkOk(AbutAdaptorGetBodies(adaptor, &n, &name));
  ck_assert_int_eq(n, 2);
  ck_assert_str_eq(name[0], "lower");
  ck_assert_str_eq(name[1], "upper");
  CkOk(AbutAdaptorDestroy(&adaptor));
}
END_TEST

static void Refused(const char key[], const char value[], const char line[])
{
  AbutAdaptor    adaptor;
  PetscErrorCode code;

  CkOk(PetscOptionsSetValue(NULL, key, value));
  CkOk(AbutAdaptorCreate(PETSC_COMM_WORLD, &adaptor));
  CkCatch(code = AbutAdaptorSetFromOptions(adaptor));
  ck_assert_int_eq(code, PETSC_ERR_USER_INPUT);
  ck_assert_str_eq(ck_line, line);
  CkOk(PetscOptionsClear(NULL));
  CkOk(AbutAdaptorDestroy(&adaptor));
}

START_TEST(wrong_values_are_refused_in_one_line)
{
  Refused("-adaptor_threshold", "-0.5", "adaptor_threshold: -0.5 is not above 0; give the indicator that is small enough, for example 0.1");
  Refused("-adaptor_max_level", "-1", "adaptor_max_level: -1 is not a level; give a number from 0 to 28");
  Refused("-adaptor_max_unknowns", "0", "adaptor_max_unknowns: 0 is not above 0; give a number that fits the memory, for example 1000000");
  Refused("-adaptor_type", "guess", "adaptor_type: no adaptor named \"guess\"; there are: threshold, equal, doerfler");
  CkOk(PetscOptionsSetValue(NULL, "-adaptor_type", "equal"));
  Refused("-adaptor_target", "1", "adaptor_target: 1. is not a relative error; give a number between 0 and 1, for example 0.05");
  Refused("-adaptor_bodies", "lower,",
          "adaptor_bodies: a name is empty; give names of bodies separated by commas, or leave the key out for all bodies");
}
END_TEST

/* Equal errors: in n bodies of 16 cells those left of `edge` are high, the rest low; marks of each body */
static void Share(PetscReal target, PetscInt n, AbutBody body[], const PetscReal norm[], PetscReal edge, PetscReal high, PetscReal low,
                  PetscInt marked[])
{
  AbutAdaptor adaptor = Adaptor("-adaptor_type equal");
  PetscReal   allowance[2], x[2], *e;
  Vec         eta[2];

  CkOk(AbutAdaptorSetTarget(adaptor, target));
  for (PetscInt b = 0; b < n; ++b) {
    const AbutMeshTopology *t = CkTopology(body[b]);

    CkOk(AbutBodyCreateCellVec(body[b], &eta[b]));
    CkOk(VecGetArray(eta[b], &e));
    for (PetscInt c = 0; c < t->ncells; ++c) {
      Middle(t, c, x);
      e[c] = x[0] < edge ? high : low;
    }
    CkOk(VecRestoreArray(eta[b], &e));
  }
  CkOk(AbutAdaptorGetAllowances(adaptor, n, body, eta, norm, allowance));
  for (PetscInt b = 0; b < n; ++b) {
    AbutAdaptVerdict verdict;
    PetscBool       *mark;

    CkOk(PetscMalloc1(CkTopology(body[b])->ncells, &mark));
    CkOk(AbutAdaptorSetAllowance(adaptor, allowance[b]));
    CkOk(AbutAdaptorMark(adaptor, body[b], eta[b], NULL, mark, &marked[b], &verdict));
    ck_assert_int_eq(verdict, marked[b] ? ABUT_ADAPT_REFINED : ABUT_ADAPT_DONE);
    CkOk(PetscFree(mark));
    CkOk(VecDestroy(&eta[b]));
  }
  CkOk(AbutAdaptorDestroy(&adaptor));
}

START_TEST(equal_is_done_when_the_whole_error_is_at_most_the_target)
{
  AbutBody        body = CkBox(PETSC_COMM_WORLD, ABUT_QUAD, 1., 4, 4, NULL, NULL);
  const PetscReal norm = 3.;
  PetscInt        marked;

  Share(0.1, 1, &body, &norm, 0.25, 0.0999, 0.0999, &marked); /* sqrt(sum eta^2 |e|) = 0.0999, whatever the norm */
  ck_assert_int_eq(marked, 0);
  Share(0.1, 1, &body, &norm, 0.25, 0.1999, 0., &marked); /* a quarter of the cells: half of it */
  ck_assert_int_eq(marked, 0);
  Share(0.1, 1, &body, &norm, 0.25, 0.2001, 0., &marked);
  ck_assert_int_eq(marked, 4);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(equal_refines_the_worst_cells_and_no_more_than_it_needs)
{
  AbutBody        body = CkBox(PETSC_COMM_WORLD, ABUT_QUAD, 1., 4, 4, NULL, NULL);
  const PetscReal norm = 1.;
  PetscInt        marked;

  Share(0.01, 1, &body, &norm, 0.25, 1., 0.24, &marked); /* below a quarter of the worst: waits */
  ck_assert_int_eq(marked, 4);
  Share(0.01, 1, &body, &norm, 0.25, 1., 0.26, &marked);
  ck_assert_int_eq(marked, 16);
  /* every cell has more than its part; with three columns refined the square of the error is 0.25 0.26 + 0.75 0.5625/4 = 0.1705,
     to be 0.81 target^2 */
  Share(0.5, 1, &body, &norm, 0.75, 0.75, 0.51, &marked); /* 0.2025 */
  ck_assert_int_eq(marked, 12);
  Share(0.45, 1, &body, &norm, 0.75, 0.75, 0.51, &marked); /* 0.1640 */
  ck_assert_int_eq(marked, 16);
  Share(0.53, 1, &body, &norm, 0.25, 0.6, 0.525,
        &marked); /* 0.2275 would take more than the first column, but the rest has less than its part */
  ck_assert_int_eq(marked, 4);
  CkOk(AbutBodyDestroy(&body));
}
END_TEST

START_TEST(equal_weighs_bodies_by_their_energy)
{
  AbutBody body[2] = {CkBox(PETSC_COMM_WORLD, ABUT_QUAD, 1., 4, 4, NULL, NULL), CkBox(PETSC_COMM_WORLD, ABUT_QUAD, 1., 4, 4, NULL, NULL)};
  PetscInt marked[2];

  Share(0.1, 2, body, (const PetscReal[]){1., 0.2}, 0.25, 0.5, 0.4, marked);
  ck_assert_int_eq(marked[0], 16);
  ck_assert_int_eq(marked[1], 0);
  Share(0.1, 2, body, (const PetscReal[]){1., 0.}, 0.25, 0.5, 0.4, marked);
  ck_assert_int_eq(marked[0], 16);
  ck_assert_int_eq(marked[1], 0);
  Share(0.1, 2, body, (const PetscReal[]){1., 1.}, 0.25, 0.5, 0.4, marked);
  ck_assert_int_eq(marked[0], 16);
  ck_assert_int_eq(marked[1], 16);
  for (PetscInt b = 0; b < 2; ++b) CkOk(AbutBodyDestroy(&body[b]));
}
END_TEST

START_TEST(a_threshold_has_no_target)
{
  AbutAdaptor adaptor = Adaptor("");
  PetscReal   target  = 1.;

  CkOk(AbutAdaptorSetTarget(adaptor, 0.2));
  CkOk(AbutAdaptorGetTarget(adaptor, &target));
  ck_assert_double_eq(target, 0.);
  CkOk(AbutAdaptorSetType(adaptor, ABUTADAPTOREQUAL));
  CkOk(AbutAdaptorGetTarget(adaptor, &target));
  ck_assert_double_eq(target, 0.05);
  CkOk(AbutAdaptorDestroy(&adaptor));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("adaptor");
  TCase *tests = tcase_create("adaptor");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  tcase_add_test(tests, cells_above_the_threshold_are_marked_and_no_others);
  tcase_add_test(tests, nothing_above_the_threshold_is_done);
  tcase_add_test(tests, cells_of_the_last_level_are_left_alone_until_only_they_are_left);
  tcase_add_test(tests, no_refinement_passes_the_cap_on_unknowns);
  tcase_add_test(tests, the_bodies_to_adapt_are_read_and_no_list_means_all);
  tcase_add_test(tests, wrong_values_are_refused_in_one_line);
  tcase_add_test(tests, equal_is_done_when_the_whole_error_is_at_most_the_target);
  tcase_add_test(tests, equal_refines_the_worst_cells_and_no_more_than_it_needs);
  tcase_add_test(tests, equal_weighs_bodies_by_their_energy);
  tcase_add_test(tests, a_threshold_has_no_target);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
