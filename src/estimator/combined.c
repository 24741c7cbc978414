#include <abut/private/estimatorimpl.h> /*I "abutestimator.h" I*/

/* Several estimators at once, each with its own options. In every cell the largest of their indicators counts, or the root of the sum of
   their squares. */

static const char *const AbutCombines[] = {"max", "sum", NULL};

typedef enum {
  ABUT_COMBINE_MAX,
  ABUT_COMBINE_SUM
} AbutCombine;

typedef struct {
  PetscInt      n;
  AbutEstimator part[ABUT_COMBINED_MAX];
  PetscInt      combine; /* AbutCombine */
} AbutCombined;

/* "fembem, zz" to its names, without blanks; none may be empty, or there twice */
PetscErrorCode AbutEstimatorSplitType_Private(MPI_Comm comm, const char type[], PetscInt *n, char name[][ABUT_COMBINED_NAME])
{
  const char *at = type;

  PetscFunctionBegin;
  *n = 0;
  do {
    const size_t blanks = strspn(at, " "), all = strcspn(at + blanks, ",");
    size_t       length = all;

    at += blanks;
    while (length && at[length - 1] == ' ') --length;
    AbutCheckInput(length, comm, "estimator_type: \"%s\" has an empty name; give names separated by commas, for example fembem,zz", type);
    AbutCheckInput(*n < ABUT_COMBINED_MAX && length < ABUT_COMBINED_NAME, comm,
                   "estimator_type: \"%s\"; give at most %d names, of at most %d letters", type, ABUT_COMBINED_MAX, ABUT_COMBINED_NAME - 1);
    PetscCall(PetscStrncpy(name[*n], at, length + 1));
    for (PetscInt i = 0; i < *n; ++i)
      AbutCheckInput(strcmp(name[i], name[*n]), comm, "estimator_type: \"%s\" is there twice in \"%s\"; once is enough", name[i], type);
    ++*n;
    at += all;
  } while (*at++);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorEstimate_Combined(AbutEstimator est, AbutBody body, PetscReal eta[])
{
  AbutCombined    *combined;
  Vec              one;
  const PetscReal *e;
  PetscInt         unknowns, all = 0, ncells;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &combined));
  PetscCall(AbutBodyCreateCellVec(body, &one));
  PetscCall(VecGetLocalSize(one, &ncells));
  for (PetscInt i = 0; i < combined->n; ++i) {
    PetscCall(AbutEstimatorEstimate(combined->part[i], body, one));
    PetscCall(AbutEstimatorGetUnknowns(combined->part[i], &unknowns));
    all += unknowns;
    PetscCall(VecGetArrayRead(one, &e));
    for (PetscInt c = 0; c < ncells; ++c) {
      const PetscReal before = i ? eta[c] : 0.;

      eta[c] = combined->combine == ABUT_COMBINE_MAX ? PetscMax(before, e[c]) : PetscSqrtReal(PetscSqr(before) + PetscSqr(e[c]));
    }
    PetscCall(VecRestoreArrayRead(one, &e));
  }
  PetscCall(VecDestroy(&one));
  PetscCall(AbutEstimatorSetUnknowns(est, all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorCheck_Combined(AbutEstimator est, AbutBody body)
{
  AbutCombined *combined;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &combined));
  for (PetscInt i = 0; i < combined->n; ++i) PetscCall(AbutEstimatorCheck(combined->part[i], body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorSetFromOptions_Combined(AbutEstimator est, AbutOptionItems PetscOptionsObject)
{
  AbutCombined *combined;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &combined));
  PetscCall(AbutOptionsEnum(PetscOptionsObject, "-estimator_combine",
                            "with several types, what counts in a cell: max, the largest, or sum, the root of the sum of squares",
                            AbutCombines, &combined->combine, NULL));
  for (PetscInt i = 0; i < combined->n; ++i) PetscTryTypeMethod(combined->part[i], setfromoptions, PetscOptionsObject);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorView_Combined(AbutEstimator est, PetscViewer viewer)
{
  AbutCombined *combined;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &combined));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  in each cell the %s\n",
                                   combined->combine == ABUT_COMBINE_MAX ? "largest counts" : "root of the sum of squares counts"));
  for (PetscInt i = 0; i < combined->n; ++i) PetscCall(AbutEstimatorView(combined->part[i], viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorDestroy_Combined(AbutEstimator est)
{
  AbutCombined *combined;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &combined));
  for (PetscInt i = 0; i < combined->n; ++i) PetscCall(AbutEstimatorDestroy(&combined->part[i]));
  PetscCall(PetscFree(combined));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The name of the type is the list of its parts */
PetscErrorCode AbutEstimatorCreate_Combined(AbutEstimator est)
{
  const AbutEstimatorOps ops  = {.estimate       = AbutEstimatorEstimate_Combined,
                                 .setfromoptions = AbutEstimatorSetFromOptions_Combined,
                                 .view           = AbutEstimatorView_Combined,
                                 .destroy        = AbutEstimatorDestroy_Combined};
  MPI_Comm               comm = PetscObjectComm((PetscObject)est);
  AbutCombined          *combined;
  char                   name[ABUT_COMBINED_MAX][ABUT_COMBINED_NAME];

  PetscFunctionBegin;
  PetscCall(PetscNew(&combined));
  PetscCall(AbutEstimatorSplitType_Private(comm, ((PetscObject)est)->type_name, &combined->n, name));
  for (PetscInt i = 0; i < combined->n; ++i) {
    PetscCall(AbutEstimatorCreate(comm, &combined->part[i]));
    PetscCall(AbutEstimatorSetType(combined->part[i], name[i]));
  }
  PetscCall(AbutEstimatorSetData(est, combined));
  PetscCall(AbutEstimatorSetOps(est, &ops));
  est->check = AbutEstimatorCheck_Combined;
  PetscFunctionReturn(PETSC_SUCCESS);
}
