#pragma once

#include <abutestimator.h>

PETSC_EXTERN PetscErrorCode PetscDLLibraryRegister_estimator_zz(void);
PETSC_INTERN PetscErrorCode AbutEstimatorRecover_ZZ(AbutBody, PetscReal[]);
