#pragma once

#include <petscsnes.h>
#include <abutpair.h>

/*S
   AbutInterface - The bodies and pairs of a scene as one map G of the interface trace: one sweep, eqs. (20)-(21) of the paper

   Level: intermediate

   Notes:
   The trace x holds u_n1 and u_n2 of every pair, each value on the rank that owns the node. A sweep turns x into pressures, solves every
   body once with them, and returns the new traces G(x). The nonlinear function of the loop is F(x) = x - G(x); G(x) is kept until x
   changes.

.seealso: `AbutInterfaceCreate()`, `AbutInterfaceSetSNES()`, `SNESDDNEUMANN`
S*/
typedef struct _p_AbutInterface *AbutInterface;

#define SNESDDNEUMANN "ddneumann"
#define SNESDDACTIVE  "ddactive"
PETSC_EXTERN PetscErrorCode AbutLoopViewTypes(PetscViewer);

typedef enum {
  ABUT_START_WINKLER,
  ABUT_START_NOCONTACT,
  ABUT_START_ZERO
} AbutStart;
PETSC_EXTERN const char *const AbutStarts[];

PETSC_EXTERN PetscClassId   ABUTINTERFACE_CLASSID;
PETSC_EXTERN PetscErrorCode AbutInterfaceCreate(MPI_Comm, PetscInt, AbutBody[], PetscInt, AbutPair[], AbutInterface *);
PETSC_EXTERN PetscErrorCode AbutInterfaceSetFromOptions(AbutInterface);
PETSC_EXTERN PetscErrorCode AbutInterfaceCheck(AbutInterface);
PETSC_EXTERN PetscErrorCode AbutInterfaceSetUp(AbutInterface);
PETSC_EXTERN PetscErrorCode AbutInterfaceReset(AbutInterface);
PETSC_EXTERN PetscErrorCode AbutInterfaceDestroy(AbutInterface *);
PETSC_EXTERN PetscErrorCode AbutInterfaceCreateVec(AbutInterface, Vec *);
PETSC_EXTERN PetscErrorCode AbutInterfaceComputeStart(AbutInterface, AbutStart, Vec);
PETSC_EXTERN PetscErrorCode AbutInterfaceSweep(AbutInterface, Vec, Vec);
PETSC_EXTERN PetscErrorCode AbutInterfaceGetSweeps(AbutInterface, PetscInt *, PetscInt *);
PETSC_EXTERN PetscErrorCode AbutInterfaceSweepBest(AbutInterface, Vec);
PETSC_EXTERN PetscErrorCode AbutInterfaceKeepTrace(AbutInterface, Vec);
PETSC_EXTERN PetscErrorCode AbutInterfaceForgetTrace(AbutInterface);
PETSC_EXTERN PetscErrorCode AbutInterfaceKeepSlip(AbutInterface);
PETSC_EXTERN PetscErrorCode AbutInterfaceTransferTrace(AbutInterface, Vec);
PETSC_EXTERN PetscErrorCode AbutInterfaceArchive(AbutInterface, AbutArchive);
PETSC_EXTERN PetscErrorCode AbutInterfaceArchiveTrace(AbutInterface, AbutArchive, Vec);
PETSC_EXTERN PetscErrorCode AbutInterfaceGetChange(AbutInterface, Vec, Vec, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutInterfaceSetGamma(AbutInterface, PetscReal);
PETSC_EXTERN PetscErrorCode AbutInterfaceGetGamma(AbutInterface, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutInterfaceJudgeGamma(AbutInterface, char[], size_t);
PETSC_EXTERN PetscErrorCode AbutInterfaceSetSpectrum(AbutInterface, PetscBool);
PETSC_EXTERN PetscErrorCode AbutInterfaceSetGammaFromOptions(AbutInterface);
PETSC_EXTERN PetscErrorCode AbutInterfaceSetShare(AbutInterface, PetscInt);
PETSC_EXTERN PetscErrorCode AbutInterfaceGetSpectrum(AbutInterface, PetscReal *, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutInterfaceGetResidual(AbutInterface, PetscReal *, PetscReal *);
PETSC_EXTERN PetscErrorCode AbutInterfaceGetPressure(AbutInterface, PetscInt, const PetscReal *[]);
PETSC_EXTERN PetscErrorCode AbutInterfaceGetPairState(AbutInterface, PetscInt, AbutPairState *);
PETSC_EXTERN PetscErrorCode AbutInterfaceGetTrace(AbutInterface, PetscInt, PetscInt, const PetscReal *[]);
PETSC_EXTERN PetscErrorCode AbutInterfaceSetSNES(AbutInterface, SNES);
PETSC_EXTERN PetscErrorCode AbutInterfaceGetVerdict(AbutInterface, SNES, PetscBool *, const char *[]);
PETSC_EXTERN PetscErrorCode AbutInterfaceGetFloating(AbutInterface, const char *[]);
PETSC_EXTERN PetscErrorCode AbutLoopRegisterAll(void);

/* Parts of the error of the bodies as they are, in the energy norm: relative to `norm`, the square root of twice their strain energy */
typedef struct {
  PetscReal loop;    /* what more sweeps would change */
  PetscReal penalty; /* from there to exact contact, theta = 0: a bound */
  PetscReal linear;  /* the linear solvers' */
  PetscReal norm;    /* its square has the unit of an energy */
} AbutErrors;
PETSC_EXTERN PetscErrorCode AbutInterfaceGetErrors(AbutInterface, AbutErrors *, PetscReal[]);
