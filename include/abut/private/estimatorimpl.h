#pragma once

#include <abutestimator.h>
#include <petsc/private/petscimpl.h>

struct _p_AbutEstimator {
  PETSCHEADER(AbutEstimatorOps);
  PetscInt    unknowns;                             /* solved for by the last estimate, beside those of the body */
  PetscInt    features;                             /* ABUT_FEATURE_... of a body that the type can do */
  void       *data;                                 /* of the type */
  const char *about;                                /* the type in one line, for `abut -list`; NULL: nothing said */
  PetscErrorCode (*check)(AbutEstimator, AbutBody); /* of a type of several: asks each */
};

/* "fembem, zz": the names in a type of several; what makes an estimator of them */
#define ABUT_COMBINED_MAX  8
#define ABUT_COMBINED_NAME 64
PETSC_INTERN PetscErrorCode AbutEstimatorSplitType_Private(MPI_Comm, const char[], PetscInt *, char[][ABUT_COMBINED_NAME]);
PETSC_INTERN PetscErrorCode AbutEstimatorCreate_Combined(AbutEstimator);
