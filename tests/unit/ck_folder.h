#pragma once

#include "ck.h"
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* A folder of its own for each test that writes files: tcase_add_checked_fixture(tc, CkFolderMake, CkFolderRemove) */

static char ck_folder[64]; /* the same on all ranks */

static inline PetscMPIInt CkRank(void)
{
  PetscMPIInt rank;

  CkOk(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  return rank;
}

static inline void CkFolderMake(void)
{
  strcpy(ck_folder, "/tmp/abut.XXXXXX");
  if (CkRank() == 0) ck_assert_ptr_nonnull(mkdtemp(ck_folder));
  CkOk(MPI_Bcast(ck_folder, sizeof(ck_folder), MPI_CHAR, 0, PETSC_COMM_WORLD));
}

/* Also forgets the options of the test */
static inline void CkFolderRemove(void)
{
  char command[128];

  CkOk(PetscOptionsClear(NULL));
  CkOk(MPI_Barrier(PETSC_COMM_WORLD));
  snprintf(command, sizeof(command), "rm -r '%s'", ck_folder);
  if (CkRank() == 0) ck_assert_int_eq(system(command), 0);
}

/* The path of a file in the folder; the last four answers stay valid */
static inline const char *CkPath(const char name[])
{
  static char path[4][512];
  static int  next = 0;

  next = (next + 1) % 4;
  snprintf(path[next], sizeof(path[next]), "%s/%s", ck_folder, name);
  return path[next];
}

static inline PetscBool CkExists(const char name[])
{
  return access(CkPath(name), F_OK) ? PETSC_FALSE : PETSC_TRUE;
}
