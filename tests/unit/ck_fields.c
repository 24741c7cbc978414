/* Fields written by the recorder, read back with the HDF5 library on rank 0. The displacement is linear, so that a body reproduces it
   on every mesh and all expected values are formulas. */
#include "ck_box.h"
#include "ck_folder.h"
#include <abutrecorder.h>
#include <hdf5.h>

#define LENGTH 2.

static PetscErrorCode U1(const PetscReal x[2], PetscReal *u, PETSC_UNUSED void *ctx)
{
  *u = 0.1 * x[0] + 0.02 * x[1] + 0.003;
  return PETSC_SUCCESS;
}

static PetscErrorCode U2(const PetscReal x[2], PetscReal *u, PETSC_UNUSED void *ctx)
{
  *u = -0.03 * x[0] + 0.05 * x[1];
  return PETSC_SUCCESS;
}

/* s11, s22, s33, s12 and von Mises of that displacement for the material of CkBox() */
static void ExactStress(PetscReal s[5])
{
  const PetscReal nu = 0.3, lambda = nu / ((1. + nu) * (1. - 2. * nu)), mu = 0.5 / (1. + nu), e11 = 0.1, e22 = 0.05, g12 = 0.02 - 0.03;

  s[0] = lambda * (e11 + e22) + 2. * mu * e11;
  s[1] = lambda * (e11 + e22) + 2. * mu * e22;
  s[2] = lambda * (e11 + e22);
  s[3] = mu * g12;
  s[4] = PetscSqrtReal(0.5 * (PetscSqr(s[0] - s[1]) + PetscSqr(s[1] - s[2]) + PetscSqr(s[2] - s[0])) + 3. * PetscSqr(s[3]));
}

static AbutBody Box(const char name[], AbutShape shape, PetscInt nx, PetscInt ny)
{
  AbutBody body = CkBox(PETSC_COMM_WORLD, shape, LENGTH, nx, ny, U1, U2);

  CkOk(PetscObjectSetName((PetscObject)body, name));
  CkOk(AbutBodySolve(body, NULL));
  return body;
}

/* An indicator whose value says the level of its cell */
static Vec Eta(AbutBody body)
{
  const AbutMeshTopology *t = CkTopology(body);
  Vec                     eta;
  PetscScalar            *e;

  CkOk(AbutBodyCreateCellVec(body, &eta));
  CkOk(VecGetArrayWrite(eta, &e));
  for (PetscInt c = 0; c < t->ncells; ++c) e[c] = 10. + t->level[c];
  CkOk(VecRestoreArrayWrite(eta, &e));
  return eta;
}

static PetscInt CellCount(AbutBody body)
{
  AbutMesh mesh;
  PetscInt n;

  CkOk(AbutBodyGetMesh(body, &mesh));
  CkOk(AbutMeshGetCellCount(mesh, &n));
  return n;
}

/* The highest level that is to be read back */
static PetscInt LevelMax(AbutBody body)
{
  const AbutMeshTopology *t   = CkTopology(body);
  PetscInt                max = 0;

  for (PetscInt c = 0; c < t->ncells; ++c) max = PetscMax(max, t->level[c]);
  CkOk(MPI_Allreduce(MPI_IN_PLACE, &max, 1, MPIU_INT, MPI_MAX, PETSC_COMM_WORLD));
  return max;
}

static AbutRecorder Recorder(const char name[])
{
  AbutRecorder rec;

  CkOk(PetscOptionsSetValue(NULL, "-output", CkPath(name)));
  CkOk(AbutRecorderCreate(PETSC_COMM_WORLD, &rec));
  CkOk(AbutRecorderSetFromOptions(rec));
  return rec;
}

/* The dataset GROUP/NAME as numbers with its size, which for a flat list has one column; to be freed with free() */
static double *Read(hid_t file, const char group[], const char name[], hsize_t size[2])
{
  char    path[128];
  hid_t   data, space;
  double *values;

  snprintf(path, sizeof(path), "%s/%s", group, name);
  data = H5Dopen(file, path, H5P_DEFAULT);
  ck_assert_msg(data >= 0, "there is no %s", path);
  space   = H5Dget_space(data);
  size[1] = 1;
  ck_assert_int_le(H5Sget_simple_extent_ndims(space), 2);
  H5Sget_simple_extent_dims(space, size, NULL);
  values = (double *)malloc(sizeof(double) * size[0] * size[1] + 1);
  ck_assert_int_ge(H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), 0);
  H5Sclose(space);
  H5Dclose(data);
  return values;
}

static double Area(const double cell[], hsize_t corners, const double x[])
{
  double area = 0.;

  for (hsize_t i = 0; i < corners; ++i) {
    const double *a = &x[2 * (int)cell[i]], *b = &x[2 * (int)cell[(i + 1) % corners]];

    area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
  }
  return area;
}

/* Vertices lie in the box and carry the linear displacement, cells cover the box; returns the number of cells */
static hsize_t CheckMesh(hid_t file, const char group[], hsize_t corners, double level_max)
{
  hsize_t nx[2], nu[2], nc[2], nl[2];
  double *x = Read(file, group, "vertices", nx), *u = Read(file, group, "displacement", nu);
  double *cell = Read(file, group, "cells", nc), *level = Read(file, group, "level", nl);
  double  area = 0., highest = 0., exact[2];

  ck_assert_uint_eq(nx[1], 2);
  ck_assert_uint_eq(nu[1], 3);
  ck_assert_uint_eq(nu[0], nx[0]);
  ck_assert_uint_eq(nc[1], corners);
  ck_assert_uint_eq(nl[0], nc[0]);
  for (hsize_t i = 0; i < nx[0]; ++i) {
    ck_assert(x[2 * i] >= 0. && x[2 * i] <= LENGTH && x[2 * i + 1] >= 0. && x[2 * i + 1] <= 1.);
    CkOk(U1(&x[2 * i], &exact[0], NULL));
    CkOk(U2(&x[2 * i], &exact[1], NULL));
    for (int d = 0; d < 2; ++d) ck_assert_double_eq_tol(u[3 * i + d], exact[d], 1e-12);
    ck_assert_double_eq(u[3 * i + 2], 0.);
  }
  for (hsize_t c = 0; c < nc[0]; ++c) {
    const double part = Area(&cell[corners * c], corners, x);

    for (hsize_t i = 0; i < corners; ++i) ck_assert(cell[corners * c + i] >= 0. && cell[corners * c + i] < (double)nx[0]);
    ck_assert_double_gt(part, 0.); /* counter-clockwise */
    area += part;
    highest = PetscMax(highest, level[c]);
  }
  ck_assert_double_eq_tol(area, LENGTH, 1e-12);
  ck_assert_double_eq(highest, level_max);
  free(x);
  free(u);
  free(cell);
  free(level);
  return nc[0];
}

static void CheckCells(hid_t file, const char group[], hsize_t ncells)
{
  const char *const name[5] = {"s11", "s22", "s33", "s12", "von_mises"};
  PetscReal         exact[5];

  ExactStress(exact);
  for (int k = 0; k < 5; ++k) {
    hsize_t n[2];
    double *stress = Read(file, group, name[k], n);

    ck_assert_uint_eq(n[0], ncells);
    ck_assert_uint_eq(n[1], 1);
    for (hsize_t i = 0; i < ncells; ++i) ck_assert_double_eq_tol(stress[i], exact[k], 1e-12);
    free(stress);
  }
}

static void CheckEta(hid_t file, const char group[], hsize_t ncells)
{
  hsize_t n[2], nlevel[2];
  double *eta = Read(file, group, "eta", n), *level = Read(file, group, "level", nlevel);

  ck_assert_uint_eq(n[0], ncells);
  for (hsize_t c = 0; c < ncells; ++c) ck_assert_double_eq(eta[c], 10. + level[c]);
  free(eta);
  free(level);
}

static hid_t Open(const char name[])
{
  hid_t file = H5Fopen(CkPath(name), H5F_ACC_RDONLY, H5P_DEFAULT);

  ck_assert_msg(file >= 0, "%s is not an HDF5 file", name);
  return file;
}

/* What is checked on rank 0 stands last in each test, so that a failure does not leave the other ranks waiting */

START_TEST(the_fields_of_refined_quads_and_triangles_read_back_exactly)
{
  const char *const group[]   = {"/cycle_0000/quads", "/cycle_0000/triangles"};
  const hsize_t     corners[] = {4, 3};
  AbutRecorder      rec       = Recorder("fields.xdmf");
  AbutBody          body[]    = {Box("quads", ABUT_QUAD, 4, 2), Box("triangles", ABUT_TRIANGLE, 4, 2)};
  Vec               eta[]     = {NULL, NULL};
  PetscInt          ncells[2], level_max[2];

  for (PetscInt b = 0; b < 2; ++b) {
    for (PetscInt i = 0; i < 2; ++i) CkRefine(body[b], 1., 0.5, 0.01); /* in the middle, on the cuts between ranks */
    CkOk(AbutBodySolve(body[b], NULL));
    ncells[b]    = CellCount(body[b]);
    level_max[b] = LevelMax(body[b]);
  }
  eta[0] = Eta(body[0]);
  CkOk(AbutRecorderWriteFields(rec, 0, 2, body, eta));
  CkOk(VecDestroy(&eta[0]));
  for (PetscInt b = 0; b < 2; ++b) CkOk(AbutBodyDestroy(&body[b]));
  CkOk(AbutRecorderDestroy(&rec));
  ck_assert(!CkExists("fields.h5.part") && !CkExists("fields.xdmf.part"));
  if (CkRank() == 0) {
    hid_t file = Open("fields.h5");

    for (PetscInt b = 0; b < 2; ++b) {
      ck_assert_uint_eq(CheckMesh(file, group[b], corners[b], level_max[b]), ncells[b]);
      CheckCells(file, group[b], ncells[b]);
    }
    CheckEta(file, group[0], ncells[0]);
    ck_assert_int_eq(H5Lexists(file, "/cycle_0000/triangles/eta", H5P_DEFAULT), 0);
    H5Fclose(file);
  }
}
END_TEST

START_TEST(a_second_cycle_is_appended_and_the_file_of_the_first_is_left_as_it_was)
{
  AbutRecorder rec  = Recorder("fields.xdmf");
  AbutBody     body = Box("quads", ABUT_QUAD, 2, 1);
  PetscInt     ncells;

  CkOk(AbutRecorderWriteFields(rec, 0, 1, &body, NULL));
  if (CkRank() == 0) ck_assert_int_eq(link(CkPath("fields.h5"), CkPath("first.h5")), 0); /* who has the file open keeps what it saw */
  CkRefine(body, 0., 0., 0.01);
  CkOk(AbutBodySolve(body, NULL));
  ncells = CellCount(body);
  CkOk(AbutRecorderWriteFields(rec, 3, 1, &body, NULL));
  CkOk(AbutBodyDestroy(&body));
  CkOk(AbutRecorderDestroy(&rec));
  ck_assert(!CkExists("fields.h5.part") && !CkExists("fields.xdmf.part"));
  if (CkRank() == 0) {
    hid_t file = Open("fields.h5"), first = Open("first.h5");

    ck_assert_uint_eq(CheckMesh(file, "/cycle_0000/quads", 4, 0.), 2);
    ck_assert_uint_eq(CheckMesh(file, "/cycle_0003/quads", 4, 1.), ncells);
    ck_assert_uint_eq(CheckMesh(first, "/cycle_0000/quads", 4, 0.), 2);
    ck_assert_int_eq(H5Lexists(first, "/cycle_0003", H5P_DEFAULT), 0);
    H5Fclose(file);
    H5Fclose(first);
  }
}
END_TEST

START_TEST(a_new_run_starts_a_new_file)
{
  AbutBody body = Box("quads", ABUT_QUAD, 2, 1);

  for (PetscInt cycle = 7; cycle >= 0; cycle -= 7) {
    AbutRecorder rec = Recorder("fields.xdmf");

    CkOk(AbutRecorderWriteFields(rec, cycle, 1, &body, NULL));
    CkOk(AbutRecorderDestroy(&rec));
  }
  CkOk(AbutBodyDestroy(&body));
  if (CkRank() == 0) {
    hid_t file = Open("fields.h5");

    ck_assert_uint_eq(CheckMesh(file, "/cycle_0000/quads", 4, 0.), 2);
    ck_assert_int_eq(H5Lexists(file, "/cycle_0007", H5P_DEFAULT), 0);
    H5Fclose(file);
  }
}
END_TEST

START_TEST(ranks_without_cells_take_part)
{
  AbutRecorder rec  = Recorder("fields.xdmf");
  AbutBody     body = Box("one", ABUT_QUAD, 1, 1);

  CkOk(AbutRecorderWriteFields(rec, 0, 1, &body, NULL));
  CkOk(AbutBodyDestroy(&body));
  CkOk(AbutRecorderDestroy(&rec));
  if (CkRank() == 0) {
    hid_t file = Open("fields.h5");

    ck_assert_uint_eq(CheckMesh(file, "/cycle_0000/one", 4, 0.), 1);
    CheckCells(file, "/cycle_0000/one", 1);
    H5Fclose(file);
  }
}
END_TEST

START_TEST(cycles_must_follow_each_other)
{
  AbutRecorder rec  = Recorder("fields.vtu");
  AbutBody     body = Box("quads", ABUT_QUAD, 2, 1);
  int          code;

  CkOk(AbutRecorderWriteFields(rec, 1, 1, &body, NULL));
  CkCatch(code = AbutRecorderWriteFields(rec, 1, 1, &body, NULL));
  ck_assert_int_eq(code, PETSC_ERR_ARG_OUTOFRANGE);
  CkOk(AbutBodyDestroy(&body));
  CkOk(AbutRecorderDestroy(&rec));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("fields");
  TCase *tc    = tcase_create("fields");
  int    status;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  suite_add_tcase(suite, tc);
  tcase_add_checked_fixture(tc, CkFolderMake, CkFolderRemove);
  tcase_add_test(tc, the_fields_of_refined_quads_and_triangles_read_back_exactly);
  tcase_add_test(tc, a_second_cycle_is_appended_and_the_file_of_the_first_is_left_as_it_was);
  tcase_add_test(tc, a_new_run_starts_a_new_file);
  tcase_add_test(tc, ranks_without_cells_take_part);
  tcase_add_test(tc, cycles_must_follow_each_other);
  status = CkRun(suite);
  return AbutFinalize() ? EXIT_FAILURE : status;
}
