#pragma once

#include <abutestimator.h>
#include <petsc/private/petscimpl.h>

struct _p_AbutEstimator {
  PETSCHEADER(AbutEstimatorOps);
  PetscInt unknowns; /* solved for by the last estimate, beside those of the body */
  void    *data;     /* of the type */
};
