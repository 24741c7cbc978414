#include <abut/private/estimatorimpl.h> /*I "abutestimator.h" I*/

PetscClassId ABUTESTIMATOR_CLASSID;

static PetscLogEvent     ABUTESTIMATOR_Estimate;
static PetscFunctionList AbutEstimatorList        = NULL;
static PetscBool         AbutEstimatorInitialized = PETSC_FALSE;

static PetscErrorCode AbutEstimatorFinalizePackage(void)
{
  PetscFunctionBegin;
  PetscCall(PetscFunctionListDestroy(&AbutEstimatorList));
  AbutEstimatorInitialized = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorInitializePackage(void)
{
  PetscFunctionBegin;
  if (AbutEstimatorInitialized) PetscFunctionReturn(PETSC_SUCCESS);
  AbutEstimatorInitialized = PETSC_TRUE;
  PetscCall(PetscClassIdRegister("Abut Estimator", &ABUTESTIMATOR_CLASSID));
  PetscCall(PetscLogEventRegister("AbutEstimate", ABUTESTIMATOR_CLASSID, &ABUTESTIMATOR_Estimate));
  PetscCall(PetscRegisterFinalize(AbutEstimatorFinalizePackage));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutEstimatorRegister - Adds a type of estimator

   Not Collective, to be called by all ranks

   Input Parameters:
+  name   - the value of `-estimator_type` that chooses it
-  create - fills in a new estimator: `AbutEstimatorSetOps()`, and `AbutEstimatorSetData()` if it has data

   Level: advanced

   Note:
   A plugin calls this in its function `PetscDLLibraryRegister_estimator_NAME()`; `plugins/template` is one to copy.

.seealso: `AbutEstimatorSetType()`, `AbutEstimatorSetOps()`, `AbutPluginLoad()`
@*/
PetscErrorCode AbutEstimatorRegister(const char name[], PetscErrorCode (*create)(AbutEstimator))
{
  PetscFunctionBegin;
  PetscCall(AbutEstimatorInitializePackage());
  PetscCall(PetscFunctionListAdd(&AbutEstimatorList, name, create));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEstimatorCreate - Creates an estimator, yet without a type

   Collective

   Input Parameter:
.  comm - the communicator of the bodies it will be used for

   Output Parameter:
.  est - the estimator

   Level: beginner

.seealso: `AbutEstimatorSetFromOptions()`, `AbutEstimatorEstimate()`, `AbutEstimatorDestroy()`
@*/
PetscErrorCode AbutEstimatorCreate(MPI_Comm comm, AbutEstimator *est)
{
  PetscFunctionBegin;
  PetscAssertPointer(est, 2);
  PetscCall(AbutEstimatorInitializePackage());
  PetscCall(PetscHeaderCreate(*est, ABUTESTIMATOR_CLASSID, "AbutEstimator", "Error estimator", "Estimator", comm, AbutEstimatorDestroy,
                              AbutEstimatorView));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEstimatorDestroy - Frees an estimator

   Collective

   Input Parameter:
.  est - the estimator, `NULL` afterwards

   Level: beginner

.seealso: `AbutEstimatorCreate()`
@*/
PetscErrorCode AbutEstimatorDestroy(AbutEstimator *est)
{
  PetscFunctionBegin;
  if (!*est) PetscFunctionReturn(PETSC_SUCCESS);
  PetscValidHeaderSpecific(*est, ABUTESTIMATOR_CLASSID, 1);
  if (--((PetscObject)*est)->refct > 0) {
    *est = NULL;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscTryTypeMethod(*est, destroy);
  PetscCall(PetscHeaderDestroy(est));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorFindOne_Private(AbutEstimator est, AbutEstimatorType type, PetscErrorCode (**create)(AbutEstimator))
{
  PetscFunctionBegin;
  PetscCall(AbutPluginFindType(PetscObjectComm((PetscObject)est), "estimator_type", "estimator", "Estimator", &AbutEstimatorList, type,
                               (PetscVoidFunction *)create));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Several names separated by commas are all looked up before any estimator is made */
static PetscErrorCode AbutEstimatorFindType_Private(AbutEstimator est, AbutEstimatorType type, PetscErrorCode (**create)(AbutEstimator))
{
  char     name[ABUT_COMBINED_MAX][ABUT_COMBINED_NAME];
  PetscInt n;

  PetscFunctionBegin;
  if (!strchr(type, ',')) {
    PetscCall(AbutEstimatorFindOne_Private(est, type, create));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(AbutEstimatorSplitType_Private(PetscObjectComm((PetscObject)est), type, &n, name));
  for (PetscInt i = 0; i < n; ++i) PetscCall(AbutEstimatorFindOne_Private(est, name[i], create));
  *create = AbutEstimatorCreate_Combined;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutEstimatorSetType - Chooses how the error is estimated

   Collective

   Input Parameters:
+  est  - the estimator
-  type - a name, such as `ABUTESTIMATORFEMBEM` or `ABUTESTIMATORZZ`, or several separated by commas, such as "fembem,zz"

   Options Database Keys:
+  -estimator_type type - the name or names
-  -plugin_path folder  - where `libestimator_NAME.so` is looked for

   Level: beginner

   Notes:
   A type that is not yet registered is looked for as the plugin `libestimator_NAME.so`; only the plugin of the chosen type is opened.

   Of several types every one estimates, with its own options, and the indicator of a cell is the largest of theirs, or the root of the sum
   of their squares: see `AbutEstimatorSetFromOptions()`. Their unknowns add up.

.seealso: `AbutEstimatorSetFromOptions()`, `AbutEstimatorGetType()`, `AbutEstimatorRegister()`
@*/
PetscErrorCode AbutEstimatorSetType(AbutEstimator est, AbutEstimatorType type)
{
  PetscErrorCode (*create)(AbutEstimator) = NULL;
  PetscBool same;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(est, ABUTESTIMATOR_CLASSID, 1);
  PetscCall(PetscObjectTypeCompare((PetscObject)est, type, &same));
  if (same) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutEstimatorFindType_Private(est, type, &create));
  PetscTryTypeMethod(est, destroy);
  PetscCall(PetscMemzero(est->ops, sizeof(*est->ops)));
  est->data     = NULL;
  est->check    = NULL;
  est->unknowns = 0;
  est->features = 0;
  PetscCall(PetscObjectChangeTypeName((PetscObject)est, type));
  PetscCall((*create)(est));
  AbutCheckInput(est->ops->estimate, PetscObjectComm((PetscObject)est),
                 "estimator_type: the create routine of \"%s\" set no function estimate; give it one with AbutEstimatorSetOps()", type);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutEstimatorGetType - Gets the name of the type

   Not Collective

   Input Parameter:
.  est - the estimator

   Output Parameter:
.  type - the name, `NULL` if none was chosen

   Level: beginner

.seealso: `AbutEstimatorSetType()`
@*/
PetscErrorCode AbutEstimatorGetType(AbutEstimator est, AbutEstimatorType *type)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(est, ABUTESTIMATOR_CLASSID, 1);
  *type = ((PetscObject)est)->type_name;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEstimatorSetFromOptions - Chooses the type, and lets it read its own options

   Collective

   Input Parameter:
.  est - the estimator

   Options Database Keys:
+  -estimator_type <fembem>    - the type, or several separated by commas
.  -estimator_combine <max,sum> - with several types: `max` (default), in every cell the largest of their indicators eta_i counts; `sum`:
                                 sqrt( sum eta_i^2 )
-  -plugin_path folder         - where `libestimator_NAME.so` is, if not with `libabut.so`

   Level: beginner

.seealso: `AbutEstimatorSetType()`
@*/
PetscErrorCode AbutEstimatorSetFromOptions(AbutEstimator est)
{
  char type[256] = ABUTESTIMATORDEFAULT, folder[PETSC_MAX_PATH_LEN] = ""; /* the folder is for -help: AbutPluginLoad() reads it itself */

  PetscFunctionBegin;
  PetscValidHeaderSpecific(est, ABUTESTIMATOR_CLASSID, 1);
  if (((PetscObject)est)->type_name) PetscCall(PetscStrncpy(type, ((PetscObject)est)->type_name, sizeof(type)));
  PetscObjectOptionsBegin((PetscObject)est);
  PetscCall(AbutOptionsString(PetscOptionsObject, "-estimator_type",
                              "how the error is estimated: the name of a plugin, or several separated by commas", type, sizeof(type),
                              NULL));
  PetscCall(AbutOptionsString(PetscOptionsObject, "-plugin_path", "where libestimator_NAME.so is, if not with libabut.so", folder,
                              sizeof(folder), NULL));
  PetscCall(AbutEstimatorSetType(est, type));
  PetscTryTypeMethod(est, setfromoptions, PetscOptionsObject);
  PetscOptionsEnd();
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEstimatorCheck - Ends the run if a body has something that the type of an estimator cannot do; needs no mesh yet

   Collective

   Input Parameters:
+  est  - the estimator, its type chosen
-  body - the body

   Level: developer

   Note:
   `AbutEstimatorEstimate()` asks again.

.seealso: `AbutEstimatorSetFeatures()`, `AbutBodyGetFeatures()`
@*/
PetscErrorCode AbutEstimatorCheck(AbutEstimator est, AbutBody body)
{
  const char *what, *who, *name;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(est, ABUTESTIMATOR_CLASSID, 1);
  if (est->check) {
    PetscCall((*est->check)(est, body));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(AbutBodyGetName(body, &name));
  PetscCall(AbutBodyFindFeature(body, est->features, &what, &who));
  AbutCheckInput(!what, PetscObjectComm((PetscObject)est),
                 "estimator_type: %s does not know how to judge %s with %s, that of %s; give residual, or leave %s out of adaptor_bodies",
                 ((PetscObject)est)->type_name, name, what, who, name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEstimatorEstimate - Estimates the error of the last solve of a body, cell by cell

   Collective

   Input Parameters:
+  est  - the estimator, its type chosen
-  body - the body, solved

   Output Parameter:
.  eta - a vector of `AbutBodyCreateCellVec()`: the eta_e of eq. (27) of the paper, of no dimension

   Level: beginner

   Notes:
   Logged as "AbutEstimate".

   The estimate is of the discretisation error of the linear problem just solved: it says nothing of penalty, gap or an unconverged loop.

.seealso: `AbutEstimatorGetNorms()`, `AbutEstimatorGetUnknowns()`, `AbutAdaptorMark()`
@*/
PetscErrorCode AbutEstimatorEstimate(AbutEstimator est, AbutBody body, Vec eta)
{
  PetscReal *e, norm;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(est, ABUTESTIMATOR_CLASSID, 1);
  PetscCheck(est->ops->estimate, PetscObjectComm((PetscObject)est), PETSC_ERR_ORDER,
             "Choose a type with AbutEstimatorSetType() or AbutEstimatorSetFromOptions() first");
  if (body) PetscCall(AbutEstimatorCheck(est, body)); /* a type may do without */
  PetscCall(PetscLogEventBegin(ABUTESTIMATOR_Estimate, est, 0, 0, 0));
  est->unknowns = 0;
  PetscCall(VecGetArrayWrite(eta, &e));
  PetscUseTypeMethod(est, estimate, body, e);
  PetscCall(VecRestoreArrayWrite(eta, &e));
  PetscCall(PetscLogEventEnd(ABUTESTIMATOR_Estimate, est, 0, 0, 0));
  PetscCall(VecNorm(eta, NORM_1, &norm)); /* a NaN would be above no threshold, and pass for a small error */
  PetscCheck(!PetscIsInfOrNanReal(norm), PetscObjectComm((PetscObject)est), PETSC_ERR_FP,
             "Estimator \"%s\" gave an indicator that is not a number", ((PetscObject)est)->type_name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEstimatorView - Prints the type and its settings

   Collective

   Input Parameters:
+  est    - the estimator
-  viewer - where to

   Level: beginner

.seealso: `AbutEstimatorCreate()`
@*/
PetscErrorCode AbutEstimatorView(AbutEstimator est, PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(est, ABUTESTIMATOR_CLASSID, 1);
  PetscCall(PetscObjectPrintClassNamePrefixType((PetscObject)est, viewer));
  PetscCall(PetscViewerASCIIPushTab(viewer));
  PetscTryTypeMethod(est, view, viewer);
  PetscCall(PetscViewerASCIIPopTab(viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEstimatorViewTypes - Prints every type of estimator there is, a line each; opens the plugins for that

   Collective

   Input Parameters:
+  comm   - the communicator
-  viewer - an ASCII viewer

   Level: intermediate

.seealso: `AbutEstimatorRegister()`, `AbutPluginListAvailable()`
@*/
PetscErrorCode AbutEstimatorViewTypes(MPI_Comm comm, PetscViewer viewer)
{
  char names[512], *name, *rest = names;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorInitializePackage());
  PetscCall(AbutPluginListTypes("estimator", AbutEstimatorList, names, sizeof(names)));
  while ((name = strtok_r(NULL, ", ", &rest))) {
    AbutEstimator est;
    PetscErrorCode (*create)(AbutEstimator);

    PetscCall(AbutEstimatorCreate(comm, &est));
    PetscCall(AbutEstimatorSetType(est, name));
    PetscCall(PetscFunctionListFind(AbutEstimatorList, name, &create));
    PetscCall(AbutPluginViewType(viewer, name, est->about, (PetscVoidFunction)create));
    PetscCall(AbutEstimatorDestroy(&est));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
