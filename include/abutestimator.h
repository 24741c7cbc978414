#pragma once

#include <abutbody.h>

/*S
   AbutEstimator - Computes one error indicator per cell of an `AbutBody`; knows nothing of marking

   Level: beginner

.seealso: `AbutEstimatorCreate()`, `AbutEstimatorSetType()`, `AbutEstimatorRegister()`, `AbutAdaptor`
S*/
typedef struct _p_AbutEstimator *AbutEstimator;
typedef const char              *AbutEstimatorType;
#define ABUTESTIMATORFEMBEM   "fembem"   /* FEM against boundary-element stress, eq. (27) of the paper */
#define ABUTESTIMATORZZ       "zz"       /* recovered against raw stress, Zienkiewicz and Zhu (1992) */
#define ABUTESTIMATORRESIDUAL "residual" /* what is left of equilibrium in the cells, across their sides and on the boundary */
#define ABUTESTIMATORDEFAULT  ABUTESTIMATORFEMBEM

/* What a plugin fills in and hands to AbutEstimatorSetOps() in its create routine */
typedef struct {
  PetscErrorCode (*estimate)(AbutEstimator, AbutBody, PetscReal[]); /* required: eta of each local cell of the body, eq. (27) */
  PetscErrorCode (*setfromoptions)(AbutEstimator, AbutOptionItems); /* optional */
  PetscErrorCode (*view)(AbutEstimator, PetscViewer);               /* optional */
  PetscErrorCode (*destroy)(AbutEstimator);                         /* optional, frees what AbutEstimatorSetData() was given */
} AbutEstimatorOps;

PETSC_EXTERN PetscClassId   ABUTESTIMATOR_CLASSID;
PETSC_EXTERN PetscErrorCode AbutEstimatorRegister(const char[], PetscErrorCode (*)(AbutEstimator));
PETSC_EXTERN PetscErrorCode AbutEstimatorSetOps(AbutEstimator, const AbutEstimatorOps *);
PETSC_EXTERN PetscErrorCode AbutEstimatorSetFeatures(AbutEstimator, PetscInt);
PETSC_EXTERN PetscErrorCode AbutEstimatorSetAbout(AbutEstimator, const char[]);
PETSC_EXTERN PetscErrorCode AbutEstimatorSetData(AbutEstimator, void *);
PETSC_EXTERN PetscErrorCode AbutEstimatorGetData(AbutEstimator, void *);
PETSC_EXTERN PetscErrorCode AbutEstimatorSetUnknowns(AbutEstimator, PetscInt);
PETSC_EXTERN PetscErrorCode AbutEstimatorGetUnknowns(AbutEstimator, PetscInt *);
PETSC_EXTERN PetscErrorCode AbutEstimatorCreate(MPI_Comm, AbutEstimator *);
PETSC_EXTERN PetscErrorCode AbutEstimatorSetType(AbutEstimator, AbutEstimatorType);
PETSC_EXTERN PetscErrorCode AbutEstimatorGetType(AbutEstimator, AbutEstimatorType *);
PETSC_EXTERN PetscErrorCode AbutEstimatorSetFromOptions(AbutEstimator);
PETSC_EXTERN PetscErrorCode AbutEstimatorCheck(AbutEstimator, AbutBody);
PETSC_EXTERN PetscErrorCode AbutEstimatorEstimate(AbutEstimator, AbutBody, Vec);
PETSC_EXTERN PetscErrorCode AbutEstimatorGetNorms(AbutBody, Vec, PetscReal *, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutEstimatorView(AbutEstimator, PetscViewer);
PETSC_EXTERN PetscErrorCode AbutEstimatorViewTypes(MPI_Comm, PetscViewer);
PETSC_EXTERN PetscErrorCode AbutEstimatorDestroy(AbutEstimator *);

/* A stress (s11, s22, s12) thought better than that of the finite elements, at n points of one local cell:
   xi[2*n] reference points as in AbutBodyGetCellStress(), x[2*n] the same points in space, s[3*n] the result */
typedef PetscErrorCode (*AbutStressFunction)(AbutEstimator, AbutBody, PetscInt c, PetscInt n, const PetscReal xi[], const PetscReal x[],
                                             PetscReal s[]);
PETSC_EXTERN PetscErrorCode AbutEstimatorCompareStress(AbutEstimator, AbutBody, AbutStressFunction, PetscReal[]);

/* For what estimates the error of the stress without a better one: from ||s - s_F||_e^2 of each local cell to eta_e, eq. (27) */
PETSC_EXTERN PetscErrorCode AbutEstimatorScale(AbutBody, PetscReal, PetscReal[]);

/* For what knows no body force: a stress that balances a constant one, to be taken off and added again, and its displacement */
PETSC_EXTERN PetscErrorCode AbutEstimatorGetParticular(AbutBody, const PetscReal[2], PetscReal[], PetscReal[3]);

/* For what gathers from cells to vertices: sums over the ranks at the vertices with unknowns, v[bs*nunknown] as in AbutMeshTopology */
PETSC_EXTERN PetscErrorCode AbutEstimatorSumAtVertices(AbutBody, PetscInt, PetscReal[]);
