#include "ck_box.h"
#include <abutadaptor.h>

/* Bulk marking of two bodies at once, each of 8x8 quads of area 1/64, against sorting all cells. The square of a cell's error is a function
   of its place, so that every distribution has the same ones. */

#define BODIES 2
#define CELLS  64

typedef PetscReal (*Square)(PetscInt body, PetscInt i, PetscInt j);

static PetscReal Different(PetscInt body, PetscInt i, PetscInt j)
{
  return PetscExpReal(2. * PetscSinReal(1. + 7.3 * i + 2.9 * j + 0.7 * body) - 0.2 * i);
}

static PetscReal Symmetric(PETSC_UNUSED PetscInt body, PetscInt i, PetscInt j)
{
  return Different(0, PetscMin(i, 7 - i), j) * (1. + 1e-5 * i);
}

static PetscReal Alike(PETSC_UNUSED PetscInt body, PETSC_UNUSED PetscInt i, PETSC_UNUSED PetscInt j)
{
  return 1.;
}

static void Place(const AbutMeshTopology *t, PetscInt c, PetscInt *i, PetscInt *j)
{
  const PetscReal *x = t->x + 2 * t->cell[4 * c], *y = t->x + 2 * t->cell[4 * c + 2]; /* opposite corners */

  *i = (PetscInt)(4. * (x[0] + y[0]));
  *j = (PetscInt)(4. * (x[1] + y[1]));
}

/* Marks of all cells by place, over all ranks; `total` is the relative error of both bodies together */
static void Mark(PetscReal bulk, PetscReal target, Square square, const PetscReal norm[], PetscReal total, PetscInt mark[BODIES * CELLS])
{
  const PetscInt nbodies = BODIES;
  AbutAdaptor    adaptor;
  AbutBody       body[BODIES];
  PetscReal      allowance[BODIES], sum = 0., norm2 = 0.;
  Vec            eta[BODIES];
  char           options[128];

  for (PetscInt k = 0; k < BODIES * CELLS; ++k) {
    mark[k] = 0;
    sum += square(k / CELLS, k % 8, k % CELLS / 8);
  }
  for (PetscInt b = 0; b < nbodies; ++b) norm2 += PetscSqr(norm[b]);
  CkOk(PetscSNPrintf(options, sizeof(options), "-adaptor_type doerfler -adaptor_bulk %g -adaptor_target %g", (double)bulk, (double)target));
  CkOk(PetscOptionsInsertString(NULL, options));
  CkOk(AbutAdaptorCreate(PETSC_COMM_WORLD, &adaptor));
  CkOk(AbutAdaptorSetFromOptions(adaptor));
  CkOk(PetscOptionsClear(NULL));
  for (PetscInt b = 0; b < nbodies; ++b) {
    const AbutMeshTopology *t;
    PetscReal              *e;

    body[b] = CkBox(PETSC_COMM_WORLD, ABUT_QUAD, 1., 8, 8, NULL, NULL);
    t       = CkTopology(body[b]);
    CkOk(AbutBodyCreateCellVec(body[b], &eta[b]));
    CkOk(VecGetArray(eta[b], &e));
    for (PetscInt c = 0; c < t->ncells; ++c) { /* norm^2 eta^2 |e| = square * total^2 norm2/sum */
      PetscInt i, j;

      Place(t, c, &i, &j);
      e[c] = total / norm[b] * PetscSqrtReal(CELLS * norm2 * square(b, i, j) / sum);
    }
    CkOk(VecRestoreArray(eta[b], &e));
  }
  CkOk(AbutAdaptorGetAllowances(adaptor, nbodies, body, eta, norm, allowance));
  for (PetscInt b = 0; b < nbodies; ++b) {
    const AbutMeshTopology *t = CkTopology(body[b]);
    AbutAdaptVerdict        verdict;
    PetscBool              *m;
    PetscInt                n;

    CkOk(PetscMalloc1(t->ncells, &m));
    CkOk(AbutAdaptorSetAllowance(adaptor, allowance[b]));
    CkOk(AbutAdaptorMark(adaptor, body[b], eta[b], NULL, m, &n, &verdict));
    ck_assert_int_eq(verdict, n ? ABUT_ADAPT_REFINED : ABUT_ADAPT_DONE);
    for (PetscInt c = 0; c < t->ncells; ++c) {
      PetscInt i, j;

      Place(t, c, &i, &j);
      mark[CELLS * b + 8 * j + i] = m[c];
    }
    CkOk(PetscFree(m));
    CkOk(VecDestroy(&eta[b]));
    CkOk(AbutBodyDestroy(&body[b]));
  }
  CkOk(AbutAdaptorDestroy(&adaptor));
  CkOk(MPI_Allreduce(MPI_IN_PLACE, mark, BODIES * CELLS, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
}

static PetscInt Count(const PetscInt mark[])
{
  PetscInt n = 0;

  for (PetscInt k = 0; k < BODIES * CELLS; ++k) n += mark[k];
  return n;
}

static const PetscReal even[] = {3., 3.}, uneven[] = {1., 10.};

START_TEST(the_marked_cells_are_the_fewest_that_hold_the_part)
{
  const PetscReal bulk[] = {0.1, 0.3, 0.5, 0.7, 0.9, 0.99};
  PetscReal       all[BODIES * CELLS], sum = 0.;
  PetscInt        mark[BODIES * CELLS];

  for (PetscInt k = 0; k < BODIES * CELLS; ++k) sum += all[k] = Different(k / CELLS, k % 8, k % CELLS / 8);
  CkOk(PetscSortReal(BODIES * CELLS, all));
  for (PetscInt i = 0; i < 6; ++i)
    for (PetscInt n = 0; n < 2; ++n) { /* energies only scale: the squares are given in energy */
      PetscReal held = 0.;
      PetscInt  k    = BODIES * CELLS;

      while (held < bulk[i] * sum) held += all[--k];
      Mark(bulk[i], 0.05, Different, n ? even : uneven, 0.3, mark);
      ck_assert_int_eq(Count(mark), BODIES * CELLS - k);
      for (PetscInt c = 0; c < BODIES * CELLS; ++c) ck_assert_int_eq(mark[c], Different(c / CELLS, c % 8, c % CELLS / 8) >= all[k]);
    }
}
END_TEST

START_TEST(equal_cells_go_together)
{
  PetscInt mark[BODIES * CELLS];

  for (PetscInt i = 1; i < 10; ++i) {
    Mark(0.1 * i, 0.05, Symmetric, even, 0.3, mark);
    ck_assert(Count(mark) > 0);
    for (PetscInt k = 0; k < BODIES * CELLS; ++k) ck_assert_int_eq(mark[k], mark[k / 8 * 8 + 7 - k % 8]);
  }
  Mark(0.01, 0.05, Alike, even, 0.3, mark);
  ck_assert_int_eq(Count(mark), BODIES * CELLS);
  Mark(1., 0.05, Different, even, 0.3, mark);
  ck_assert_int_eq(Count(mark), BODIES * CELLS);
}
END_TEST

START_TEST(it_is_done_when_the_whole_error_is_at_most_the_target)
{
  PetscInt mark[BODIES * CELLS];

  Mark(0.5, 0.1, Different, uneven, 0.0999, mark);
  ck_assert_int_eq(Count(mark), 0);
  Mark(0.5, 0.1, Different, uneven, 0.1001, mark);
  ck_assert(Count(mark) > 0);
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("doerfler");
  TCase *tests = tcase_create("doerfler");
  int    status;

  PetscCall(AbutInitialize(&argc, &argv, NULL));
  tcase_add_test(tests, the_marked_cells_are_the_fewest_that_hold_the_part);
  tcase_add_test(tests, equal_cells_go_together);
  tcase_add_test(tests, it_is_done_when_the_whole_error_is_at_most_the_target);
  suite_add_tcase(suite, tests);
  status = CkRun(suite);
  PetscCall(AbutFinalize());
  return status;
}
