/* The profile of a pair whose solution is known: two boxes with non-matching sides, pressed evenly, free to widen */
#include "ck_folder.h"
#include <abutrecorder.h>

#define DELTA 0.01
#define GAP   0.002
#define NU    0.3
#define THETA 0.05

/* Both boxes have height 1 and E = 1: p (theta + 2 (1 - nu^2)) = delta - gap */
static const double pressure = (DELTA - GAP) / (THETA + 2. * (1. - NU * NU));

static const char *const options[][2] = {
  {"-lower_mesh_box",         "0,0,2,1"    },
  {"-lower_mesh_cells",       "4,2"        },
  {"-lower_material_young",   "1"          },
  {"-lower_material_poisson", "0.3"        },
  {"-lower_bc_left_u1",       "0"          },
  {"-lower_bc_bottom_u2",     "0"          },
  {"-upper_mesh_box",         "0,1,2,2"    },
  {"-upper_mesh_cells",       "3,2"        },
  {"-upper_mesh_shape",       "triangle"   },
  {"-upper_material_young",   "1"          },
  {"-upper_material_poisson", "0.3"        },
  {"-upper_bc_left_u1",       "0"          },
  {"-upper_bc_top_u2",        "-0.01"      },
  {"-mid_pair_bodies",        "upper,lower"},
  {"-mid_pair_sides",         "bottom,top" },
  {"-mid_pair_gap",           "0.002"      },
  {"-mid_pair_theta",         "0.05"       }
};

/* Writes the profile after one sweep from the Winkler layer, which is exact here */
static void WriteProfile(void)
{
  AbutBody      body[2];
  AbutPair      pair;
  AbutInterface iface;
  AbutRecorder  rec;
  Vec           x, g;

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(options); ++i) CkOk(PetscOptionsSetValue(NULL, options[i][0], options[i][1]));
  CkOk(PetscOptionsSetValue(NULL, "-output_profile", CkPath("profile.csv")));
  CkOk(AbutRecorderCreate(PETSC_COMM_WORLD, &rec));
  CkOk(AbutRecorderSetFromOptions(rec));
  CkOk(AbutBodyCreate(PETSC_COMM_WORLD, "upper", &body[0]));
  CkOk(AbutBodyCreate(PETSC_COMM_WORLD, "lower", &body[1]));
  for (PetscInt b = 0; b < 2; ++b) CkOk(AbutBodySetFromOptions(body[b]));
  CkOk(AbutPairCreate(PETSC_COMM_WORLD, "mid", &pair));
  CkOk(AbutPairSetFromOptions(pair, 2, body));
  CkOk(AbutInterfaceCreate(PETSC_COMM_WORLD, 2, body, 1, &pair, &iface));
  CkOk(AbutInterfaceSetUp(iface));
  CkOk(AbutInterfaceCreateVec(iface, &x));
  CkOk(VecDuplicate(x, &g));
  CkOk(AbutInterfaceComputeStart(iface, ABUT_START_WINKLER, x));
  CkOk(AbutInterfaceSweep(iface, x, g));
  CkOk(AbutRecorderWriteProfile(rec, iface, 1, &pair));
  CkOk(VecDestroy(&x));
  CkOk(VecDestroy(&g));
  CkOk(AbutRecorderDestroy(&rec));
  CkOk(AbutInterfaceDestroy(&iface));
  CkOk(AbutPairDestroy(&pair));
  for (PetscInt b = 0; b < 2; ++b) CkOk(AbutBodyDestroy(&body[b]));
}

/* A row of side 1, 2 or of the pressures: s runs from the first node with the body on the left, values are constant along the sides */
static void CheckRow(const char line[], int count[3])
{
  const double shrink = pressure * (1. - NU * NU), u_n[] = {DELTA - shrink, -shrink};
  double       s, x, y, value[2];
  int          side;

  if (sscanf(line, "mid,pressure,%lg,%lg,%lg,,%lg,%lg\n", &s, &x, &y, &value[0], &value[1]) == 5) {
    ck_assert_double_eq_tol(value[0], GAP, 1e-14);
    ck_assert_double_eq_tol(value[1], pressure, 1e-9 * pressure);
    ck_assert_double_eq_tol(s, 2. - x, 1e-9); /* the finer side is that of the lower body */
    ++count[2];
  } else {
    ck_assert_msg(sscanf(line, "mid,%d,%lg,%lg,%lg,%lg,,\n", &side, &s, &x, &y, &value[0]) == 5, "not a row of a profile: %s", line);
    ck_assert_double_eq_tol(value[0], u_n[side - 1], 1e-9 * DELTA);
    ck_assert_double_eq_tol(s, side == 1 ? x : 2. - x, 1e-9);
    ++count[side - 1];
  }
  ck_assert_double_eq(y, 1.);
}

START_TEST(the_profile_has_the_nodes_of_both_sides_and_the_nodal_pressures)
{
  char  line[256];
  int   count[3] = {0, 0, 0};
  FILE *f;

  WriteProfile();
  ck_assert(!CkExists("profile.csv.part"));
  f = fopen(CkPath("profile.csv"), "r");
  ck_assert_ptr_nonnull(f);
  ck_assert_ptr_nonnull(fgets(line, sizeof(line), f));
  ck_assert_str_eq(line, "pair,side,s,x,y,u_n,gap,pressure\n");
  while (fgets(line, sizeof(line), f)) CheckRow(line, count);
  fclose(f);
  ck_assert_int_eq(count[0], 4);
  ck_assert_int_eq(count[1], 5);
  ck_assert_int_eq(count[2], 5);
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("profile");
  TCase *tc    = tcase_create("profile");
  int    status;

  if (AbutInitialize(&argc, &argv, NULL)) return EXIT_FAILURE;
  suite_add_tcase(suite, tc);
  tcase_add_checked_fixture(tc, CkFolderMake, CkFolderRemove);
  tcase_add_test(tc, the_profile_has_the_nodes_of_both_sides_and_the_nodal_pressures);
  status = CkRun(suite);
  return AbutFinalize() ? EXIT_FAILURE : status;
}
