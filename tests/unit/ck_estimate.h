#pragma once

#include "ck.h"
#include <abutestimator.h>

/* What an estimator, whose plugin this opens, says of a body as a whole */
static inline void CkEstimate(AbutBody body, const char type[], PetscReal *total, PetscReal *largest)
{
  AbutEstimator est;
  Vec           eta;

  CkOk(AbutEstimatorCreate(PetscObjectComm((PetscObject)body), &est));
  CkOk(AbutEstimatorSetType(est, type));
  CkOk(AbutBodyCreateCellVec(body, &eta));
  CkOk(AbutEstimatorEstimate(est, body, eta));
  CkOk(AbutEstimatorGetNorms(body, eta, total, largest));
  CkOk(VecDestroy(&eta));
  CkOk(AbutEstimatorDestroy(&est));
}
