#pragma once

#include <abutsys.h>
#include <petsc/private/petscimpl.h>

/* Where keys are from, for AbutOptionsView() */
PETSC_INTERN PetscErrorCode AbutSourcesKeep_Private(void);
PETSC_INTERN PetscErrorCode AbutSourceFile_Private(const char[]);
PETSC_INTERN PetscErrorCode AbutSourceGiven_Private(const char[], const char[], const char[]);
PETSC_INTERN PetscErrorCode AbutSourceUnless_Private(const char[], const char[]);

PETSC_INTERN PetscBool AbutIsArgument_Private(const char[]);
/* A scene file, beside which AbutFileFind() looks */
PETSC_INTERN PetscErrorCode AbutFindBeside_Private(const char[]);

/* What PETSc says of a bad option, as one line. AbutCallOptions(comm, what, Call(...)): a bad value that Call() meets is reported in one
   line that begins with `what`; a bad input that the call itself reports keeps its own line. */
#define ABUT_MESSAGE 2048 /* as long as PetscError() makes them */
PETSC_INTERN PetscErrorCode AbutErrorKeep_Private(MPI_Comm, int, const char *, const char *, PetscErrorCode, PetscErrorType, const char *,
                                                  void *);
#define AbutCallOptions(comm, what, ...) \
  do { \
    char           said_[ABUT_MESSAGE] = ""; \
    PetscErrorCode ierr_; \
\
    PetscCall(PetscPushErrorHandler(AbutErrorKeep_Private, said_)); \
    ierr_ = __VA_ARGS__; \
    PetscCall(PetscPopErrorHandler()); \
    AbutCheckInput(ierr_ != PETSC_ERR_USER_INPUT, comm, "%s", said_); \
    AbutCheckInput(!ierr_, comm, "%s: %s", what, said_); \
  } while (0)

/* Lists of names in messages: "fembem, zz"; one that would be longer ends in "..." */
#define ABUT_LIST 1024
PETSC_INTERN PetscErrorCode AbutListAddItem_Private(char[], size_t, const char[]);
PETSC_INTERN PetscErrorCode AbutPluginListFiles_Private(const char[], const char[], char[], size_t);

typedef long long AbutWord; /* of the file: 64 bits everywhere */

struct _n_AbutArchive {
  MPI_Comm    comm;
  PetscMPIInt rank;
  char       *file; /* what is read; NULL while it is filled */
  char       *key;  /* the option that names it */
  char       *byte;
  size_t      size, room, at;
};
