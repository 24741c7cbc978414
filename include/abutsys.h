#pragma once

#include <petscviewer.h>
#include <stdio.h>
#include <abut/private/abutretro.h>

PETSC_EXTERN PetscErrorCode AbutInitialize(int *, char ***, const char[]);
PETSC_EXTERN PetscErrorCode AbutFinalize(void);

/* Bad input: one line saying which key or file, what is wrong and what would be right; `abut` prints just that and exits with 1.
   Raised by every rank of the communicator, or by none. */
#define AbutCheckInput(cond, comm, ...) PetscCheck(cond, comm, PETSC_ERR_USER_INPUT, __VA_ARGS__)

/* Typed readers of one key: like PetscOptionsReal() and its sisters, but a bad value names its key.
   To be called between PetscObjectOptionsBegin() and PetscOptionsEnd(), so that -help lists the key. */
PETSC_EXTERN PetscErrorCode AbutOptionsReal(AbutOptionItems, const char[], const char[], PetscReal *, PetscBool *);
PETSC_EXTERN PetscErrorCode AbutOptionsInt(AbutOptionItems, const char[], const char[], PetscInt *, PetscBool *);
PETSC_EXTERN PetscErrorCode AbutOptionsBool(AbutOptionItems, const char[], const char[], PetscBool *, PetscBool *);
PETSC_EXTERN PetscErrorCode AbutOptionsString(AbutOptionItems, const char[], const char[], char[], size_t, PetscBool *);
PETSC_EXTERN PetscErrorCode AbutOptionsEnum(AbutOptionItems, const char[], const char[], const char *const[], PetscInt *, PetscBool *);
PETSC_EXTERN PetscErrorCode AbutOptionsReals(AbutOptionItems, const char[], const char[], PetscInt, PetscReal[], PetscBool *);
PETSC_EXTERN PetscErrorCode AbutOptionsInts(AbutOptionItems, const char[], const char[], PetscInt, PetscInt[], PetscBool *);
PETSC_EXTERN PetscErrorCode AbutOptionsCheckAllRead(MPI_Comm, PetscBool);
PETSC_EXTERN PetscErrorCode AbutOptionsView(PetscViewer);

/*S
   AbutExpression - A scalar function of the point (x, y): a number, a formula, a CSV file of points or a C function

   Level: beginner

   Notes:
   A formula is parsed by muParser, whose library is opened when the first formula of a scene is met.
   A CSV file has lines `x,y,value`; the value at a point is interpolated linearly along the polyline of its points.

.seealso: `AbutExpressionCreate()`, `AbutExpressionEvaluate()`
S*/
typedef struct _n_AbutExpression *AbutExpression;
typedef PetscErrorCode (*AbutPointFunction)(const PetscReal x[2], PetscReal *value, void *ctx);
PETSC_EXTERN PetscErrorCode AbutExpressionCreate(MPI_Comm, const char[], const char[], AbutExpression *);
PETSC_EXTERN PetscErrorCode AbutExpressionCreateFunction(AbutPointFunction, void *, AbutExpression *);
PETSC_EXTERN PetscErrorCode AbutExpressionEvaluate(AbutExpression, const PetscReal[2], PetscReal *);
PETSC_EXTERN PetscErrorCode AbutExpressionGetText(AbutExpression, const char *[]);
PETSC_EXTERN PetscErrorCode AbutExpressionDestroy(AbutExpression *);

/* Files that are never half written */
typedef void (*AbutFileWriter)(FILE *, const void *ctx);
PETSC_EXTERN PetscErrorCode AbutFileFind(MPI_Comm, const char[], const char[], char[], size_t);
PETSC_EXTERN PetscErrorCode AbutFileCheckPath(MPI_Comm, const char[], const char[]);
PETSC_EXTERN PetscErrorCode AbutFileWrite(MPI_Comm, const char[], AbutFileWriter, const void *);
PETSC_EXTERN PetscErrorCode AbutFileCopyAside(MPI_Comm, const char[]);
PETSC_EXTERN PetscErrorCode AbutFileRename(MPI_Comm, const char[]);

/*S
   AbutArchive - Values by name, into a file or out of one: the same calls write and read, so that both agree

   Level: developer

   Notes:
   An archive is filled, value after value, and written; or opened, and gives the values in the same order. A value of another name, kind
   or number than asked for, a file that is cut off, damaged, of another version or no archive is a bad input that names the file.

   Limits: the file is held in memory, on rank 0 while it is filled and on all ranks while it is read.

.seealso: `AbutArchiveCreate()`, `AbutArchiveOpen()`
S*/
typedef struct _n_AbutArchive *AbutArchive;
PETSC_EXTERN PetscErrorCode    AbutArchiveCreate(MPI_Comm, AbutArchive *);
PETSC_EXTERN PetscErrorCode    AbutArchiveOpen(MPI_Comm, const char[], const char[], AbutArchive *);
PETSC_EXTERN PetscErrorCode    AbutArchiveWrite(AbutArchive, const char[]);
PETSC_EXTERN PetscErrorCode    AbutArchiveReads(AbutArchive, PetscBool *);
PETSC_EXTERN PetscErrorCode    AbutArchiveInts(AbutArchive, const char[], PetscInt, PetscInt[]);
PETSC_EXTERN PetscErrorCode    AbutArchiveCount(AbutArchive, const char[], PetscInt *);
PETSC_EXTERN PetscErrorCode    AbutArchiveReals(AbutArchive, const char[], PetscInt, PetscReal[]);
PETSC_EXTERN PetscErrorCode    AbutArchiveString(AbutArchive, const char[], char **);
PETSC_EXTERN PetscErrorCode    AbutArchiveFit(AbutArchive, const char[], const char[]);
PETSC_EXTERN PetscErrorCode    AbutArchiveDestroy(AbutArchive *);

PETSC_EXTERN PetscErrorCode AbutGetProcessorTime(PetscLogDouble *);
PETSC_EXTERN PetscErrorCode AbutLogEventGet(const char[], PetscClassId, PetscLogEvent *);
PETSC_EXTERN PetscErrorCode AbutSolveBand(PetscInt, PetscInt, PetscReal[], PetscInt, PetscReal[]);
PETSC_EXTERN PetscErrorCode AbutPluginAppend(MPI_Comm, const char[]);
PETSC_EXTERN PetscErrorCode AbutPluginLoad(MPI_Comm, const char[], const char[], PetscBool *);
PETSC_EXTERN PetscErrorCode AbutPluginListAvailable(const char[], char[], size_t);
PETSC_EXTERN PetscErrorCode AbutPluginListTypes(const char[], PetscFunctionList, char[], size_t);
PETSC_EXTERN PetscErrorCode AbutPluginFindType(MPI_Comm, const char[], const char[], const char[], const PetscFunctionList *, const char[],
                                               PetscVoidFunction *);
PETSC_EXTERN PetscErrorCode AbutPluginAppendFromOptions(MPI_Comm);
PETSC_EXTERN PetscErrorCode AbutPluginViewType(PetscViewer, const char[], const char[], PetscVoidFunction);
PETSC_EXTERN PetscErrorCode AbutPluginSameFile(PetscVoidFunction, PetscVoidFunction, PetscBool *);
