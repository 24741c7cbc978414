#pragma once

#include <abutloop.h>

/*S
   AbutRecorder - What a run writes: the record, one CSV line per cycle, fields for ParaView, contact profiles

   Level: intermediate

   Notes:
   `-record FILE` one `key value` line each; `-record_csv FILE` one line per cycle with the same names; `-output FILE.xdmf|FILE.vtu`
   fields of every cycle, bodies and sides of pairs, a series in time (HDF5 behind the xdmf, a series of files listed in FILE.pvd for vtu);
   `-output_profile FILE.csv` traces and pressures of every pair on the last mesh. Every file is written aside and renamed, so that a crash
   leaves the old one or the new one, never half of one.

   Limits: all bodies are on the communicator of the recorder; stresses are those at the centres of the cells; a .vtu is text and is
   gathered on rank 0; hanging vertices on a cut between ranks are written once by each rank.

.seealso: `AbutRecorderCreate()`, `AbutRecorderSetReal()`, `AbutRecorderWriteFields()`
S*/
typedef struct _p_AbutRecorder *AbutRecorder;

PETSC_EXTERN PetscClassId   ABUTRECORDER_CLASSID;
PETSC_EXTERN PetscErrorCode AbutRecorderCreate(MPI_Comm, AbutRecorder *);
PETSC_EXTERN PetscErrorCode AbutRecorderSetFromOptions(AbutRecorder);
PETSC_EXTERN PetscErrorCode AbutRecorderDestroy(AbutRecorder *);
PETSC_EXTERN PetscErrorCode AbutRecorderSetReal(AbutRecorder, const char[], PetscReal);
PETSC_EXTERN PetscErrorCode AbutRecorderSetInt(AbutRecorder, const char[], PetscInt);
PETSC_EXTERN PetscErrorCode AbutRecorderSetString(AbutRecorder, const char[], const char[]);
PETSC_EXTERN PetscErrorCode AbutRecorderEndCycle(AbutRecorder);
PETSC_EXTERN PetscErrorCode AbutRecorderWantsFields(AbutRecorder, PetscBool *);
PETSC_EXTERN PetscErrorCode AbutRecorderSetPairs(AbutRecorder, AbutInterface, PetscInt, AbutPair[]);
PETSC_EXTERN PetscErrorCode AbutRecorderSetStep(AbutRecorder, PetscInt, PetscReal);
PETSC_EXTERN PetscErrorCode AbutRecorderWriteFields(AbutRecorder, PetscInt, PetscInt, AbutBody[], Vec[]);
PETSC_EXTERN PetscErrorCode AbutRecorderWriteProfile(AbutRecorder, AbutInterface, PetscInt, AbutPair[]);
PETSC_EXTERN PetscErrorCode AbutRecorderWriteCycleProfile(AbutRecorder, PetscInt, AbutInterface, PetscInt, AbutPair[]);
PETSC_EXTERN PetscErrorCode AbutRecorderWrite(AbutRecorder);
PETSC_EXTERN PetscErrorCode AbutRecorderArchive(AbutRecorder, AbutArchive);
