#include <abut/private/adaptorimpl.h> /*I "abutadaptor.h" I*/
#include <abut/private/sysimpl.h>

PetscClassId ABUTADAPTOR_CLASSID;

static PetscLogEvent     ABUTADAPTOR_Mark;
static PetscFunctionList AbutAdaptorList        = NULL;
static PetscBool         AbutAdaptorInitialized = PETSC_FALSE;

static PetscErrorCode AbutAdaptorFinalizePackage(void)
{
  PetscFunctionBegin;
  PetscCall(PetscFunctionListDestroy(&AbutAdaptorList));
  AbutAdaptorInitialized = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutAdaptorInitializePackage(void)
{
  PetscFunctionBegin;
  if (AbutAdaptorInitialized) PetscFunctionReturn(PETSC_SUCCESS);
  AbutAdaptorInitialized = PETSC_TRUE;
  PetscCall(PetscClassIdRegister("Abut Adaptor", &ABUTADAPTOR_CLASSID));
  PetscCall(PetscLogEventRegister("AbutMark", ABUTADAPTOR_CLASSID, &ABUTADAPTOR_Mark));
  PetscCall(PetscRegisterFinalize(AbutAdaptorFinalizePackage));
  PetscCall(AbutAdaptorRegister(ABUTADAPTORTHRESHOLD, AbutAdaptorCreate_Threshold));
  PetscCall(AbutAdaptorRegister(ABUTADAPTOREQUAL, AbutAdaptorCreate_Equal));
  PetscCall(AbutAdaptorRegister(ABUTADAPTORDOERFLER, AbutAdaptorCreate_Doerfler));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a type: the value of -adaptor_type, and the routine that fills in ops and data */
PetscErrorCode AbutAdaptorRegister(const char name[], PetscErrorCode (*create)(AbutAdaptor))
{
  PetscFunctionBegin;
  PetscCall(AbutAdaptorInitializePackage());
  PetscCall(PetscFunctionListAdd(&AbutAdaptorList, name, create));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutAdaptorCreate - Creates an adaptor, which decides what cells are refined

   Collective

   Input Parameter:
.  comm - the communicator of the bodies it will be used for

   Output Parameter:
.  adaptor - the adaptor

   Level: intermediate

.seealso: `AbutAdaptorSetFromOptions()`, `AbutAdaptorMark()`, `AbutAdaptorDestroy()`
@*/
PetscErrorCode AbutAdaptorCreate(MPI_Comm comm, AbutAdaptor *adaptor)
{
  PetscFunctionBegin;
  PetscAssertPointer(adaptor, 2);
  PetscCall(AbutAdaptorInitializePackage());
  PetscCall(PetscHeaderCreate(*adaptor, ABUTADAPTOR_CLASSID, "AbutAdaptor", "Mesh adaptor", "Adaptor", comm, AbutAdaptorDestroy,
                              AbutAdaptorView));
  (*adaptor)->max_level    = 8;
  (*adaptor)->max_unknowns = 1000000;
  (*adaptor)->jump         = 1;
  (*adaptor)->target       = 0.05;
  (*adaptor)->allowance    = PETSC_MAX_REAL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutAdaptorDestroy - Frees an adaptor

   Collective

   Input Parameter:
.  adaptor - the adaptor, `NULL` afterwards

   Level: intermediate

.seealso: `AbutAdaptorCreate()`
@*/
PetscErrorCode AbutAdaptorDestroy(AbutAdaptor *adaptor)
{
  PetscFunctionBegin;
  if (!*adaptor) PetscFunctionReturn(PETSC_SUCCESS);
  PetscValidHeaderSpecific(*adaptor, ABUTADAPTOR_CLASSID, 1);
  if (--((PetscObject)*adaptor)->refct > 0) {
    *adaptor = NULL;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscTryTypeMethod(*adaptor, destroy);
  PetscCall(AbutAdaptorClearBodies_Private(*adaptor));
  PetscCall(PetscHeaderDestroy(adaptor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutAdaptorSetType - Chooses how cells are marked

   Collective

   Input Parameters:
+  adaptor - the adaptor
-  type    - `ABUTADAPTORTHRESHOLD`, `ABUTADAPTOREQUAL` or `ABUTADAPTORDOERFLER`; the present type is left as it is

   Level: intermediate

.seealso: `AbutAdaptorSetFromOptions()`, `AbutAdaptorSetTarget()`
@*/
PetscErrorCode AbutAdaptorSetType(AbutAdaptor adaptor, AbutAdaptorType type)
{
  PetscErrorCode (*create)(AbutAdaptor) = NULL;
  const char **registered               = NULL;
  char         names[ABUT_LIST]         = "";
  int          n                        = 0;
  PetscBool    same;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(adaptor, ABUTADAPTOR_CLASSID, 1);
  PetscCall(PetscObjectTypeCompare((PetscObject)adaptor, type, &same));
  if (same) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFunctionListFind(AbutAdaptorList, type, &create));
  if (!create) {
    PetscCall(PetscFunctionListGet(AbutAdaptorList, &registered, &n));
    for (int i = 0; i < n && registered[i]; ++i) PetscCall(AbutListAddItem_Private(names, sizeof(names), registered[i]));
    PetscCall(PetscFree(registered));
  }
  AbutCheckInput(create, PetscObjectComm((PetscObject)adaptor), "adaptor_type: no adaptor named \"%s\"; there are: %s", type, names);
  PetscTryTypeMethod(adaptor, destroy);
  PetscCall(PetscMemzero(adaptor->ops, sizeof(*adaptor->ops)));
  adaptor->data = NULL;
  PetscCall(PetscObjectChangeTypeName((PetscObject)adaptor, type));
  PetscCall((*create)(adaptor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutAdaptorViewTypes - Prints every type of adaptor there is, a line each

   Collective

   Input Parameters:
+  comm   - the communicator
-  viewer - an ASCII viewer

   Level: intermediate

.seealso: `AbutAdaptorSetType()`, `AbutEstimatorViewTypes()`
@*/
PetscErrorCode AbutAdaptorViewTypes(MPI_Comm comm, PetscViewer viewer)
{
  const char **registered = NULL;
  AbutAdaptor  adaptor;
  int          n = 0;

  PetscFunctionBegin;
  PetscCall(AbutAdaptorCreate(comm, &adaptor));
  PetscCall(PetscFunctionListGet(AbutAdaptorList, &registered, &n));
  for (int i = 0; i < n && registered[i]; ++i) {
    PetscErrorCode (*create)(AbutAdaptor);

    PetscCall(AbutAdaptorSetType(adaptor, registered[i]));
    PetscCall(PetscFunctionListFind(AbutAdaptorList, registered[i], &create));
    PetscCall(AbutPluginViewType(viewer, registered[i], adaptor->ops->about, (PetscVoidFunction)create));
  }
  PetscCall(PetscFree(registered));
  PetscCall(AbutAdaptorDestroy(&adaptor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes away the marks of cells at the last level; counts over all ranks cells, cells marked before, and cells still marked */
static PetscErrorCode AbutAdaptorCapLevel_Private(AbutAdaptor adaptor, const AbutMeshTopology *t, PetscBool mark[], PetscInt count[3])
{
  PetscFunctionBegin;
  count[0] = t->ncells;
  count[1] = count[2] = 0;
  for (PetscInt c = 0; c < t->ncells; ++c) {
    count[1] += mark[c];
    if (t->level[c] >= adaptor->max_level) mark[c] = PETSC_FALSE;
    count[2] += mark[c];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 3, MPIU_INT, MPI_SUM, PetscObjectComm((PetscObject)adaptor)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Would these marks pass the cap on unknowns? One cell becomes four; what 2:1 balance adds is not foreseen */
static PetscErrorCode AbutAdaptorPassesUnknowns_Private(AbutAdaptor adaptor, AbutBody body, const PetscInt count[3], PetscBool *passes)
{
  PetscInt  n;
  PetscReal next;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetSize(body, &n));
  next    = (PetscReal)n * (1. + 3. * (PetscReal)count[2] / (PetscReal)count[0]);
  *passes = n >= adaptor->max_unknowns || next > (PetscReal)adaptor->max_unknowns ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells that the type would not refine even if their errors were larger by 1/coarsen may be merged; none if nothing is refined for the
   error, but for a peak */
static PetscErrorCode AbutAdaptorMarkMerges_Private(AbutAdaptor adaptor, AbutBody body, AbutMesh mesh, PetscInt n, const PetscReal eta[],
                                                    const PetscBool also[])
{
  PetscReal *larger;
  PetscBool *mark;

  PetscFunctionBegin;
  if (adaptor->coarsen <= 0.) PetscFunctionReturn(PETSC_SUCCESS);
  if (adaptor->ops->share && adaptor->allowance >= PETSC_MAX_REAL) {
    PetscCall(AbutMeshSetCoarsening(mesh, NULL));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscMalloc2(n, &larger, n, &mark));
  for (PetscInt c = 0; c < n; ++c) larger[c] = eta[c] / adaptor->coarsen;
  PetscUseTypeMethod(adaptor, mark, body, n, larger, mark);
  for (PetscInt c = 0; c < n; ++c) mark[c] = (PetscBool) !(mark[c] || (also && also[c]));
  PetscCall(AbutMeshSetCoarsening(mesh, mark));
  PetscCall(PetscFree2(larger, mark));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutAdaptorMark - Marks the cells of a body that are to be refined

   Collective

   Input Parameters:
+  adaptor - the adaptor
.  body    - the body
.  eta     - the indicators of its cells, from `AbutEstimatorEstimate()`
-  also    - [cells on this rank] cells to refine whatever their indicators, or `NULL`

   Output Parameters:
+  mark    - [cells on this rank] for `AbutMeshAdapt()`
.  nmarked - marked cells over all ranks
-  verdict - `ABUT_ADAPT_REFINED` if any cell is marked; otherwise why none is, the same on all ranks

   Level: intermediate

   Notes:
   Cells at `-adaptor_max_level` are left alone as long as others can be refined: `ABUT_ADAPT_LEVEL` says that only such cells are left.

   The number of unknowns to come is estimated as unknowns*(1 + 3*marked/cells), before the mesh is balanced; so the cap may be passed by a
   little.

   With `-adaptor_coarsen` the cells that may be merged go to `AbutMeshSetCoarsening()`; cells of `also` are not among them.

.seealso: `AbutMeshAdapt()`, `AbutMeshSetCoarsening()`, `AbutEstimatorEstimate()`, `AbutAdaptVerdict`
@*/
PetscErrorCode AbutAdaptorMark(AbutAdaptor adaptor, AbutBody body, Vec eta, const PetscBool also[], PetscBool mark[], PetscInt *nmarked,
                               AbutAdaptVerdict *verdict)
{
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  const PetscReal        *e;
  PetscInt                count[3];
  PetscBool               passes = PETSC_FALSE;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(adaptor, ABUTADAPTOR_CLASSID, 1);
  PetscCheck(adaptor->ops->mark, PetscObjectComm((PetscObject)adaptor), PETSC_ERR_ORDER, "Call AbutAdaptorSetFromOptions() first");
  PetscCall(PetscLogEventBegin(ABUTADAPTOR_Mark, adaptor, 0, 0, 0));
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(VecGetArrayRead(eta, &e));
  PetscUseTypeMethod(adaptor, mark, body, t->ncells, e, mark);
  PetscCall(AbutAdaptorMarkMerges_Private(adaptor, body, mesh, t->ncells, e, also));
  PetscCall(VecRestoreArrayRead(eta, &e));
  for (PetscInt c = 0; c < t->ncells && also; ++c) mark[c] = (PetscBool)(mark[c] || also[c]);
  PetscCall(AbutAdaptorCapLevel_Private(adaptor, t, mark, count));
  *nmarked = 0;
  if (!count[1]) *verdict = ABUT_ADAPT_DONE;
  else if (!count[2]) *verdict = ABUT_ADAPT_LEVEL;
  else {
    PetscCall(AbutAdaptorPassesUnknowns_Private(adaptor, body, count, &passes));
    *verdict = passes ? ABUT_ADAPT_UNKNOWNS : ABUT_ADAPT_REFINED;
    if (passes) PetscCall(PetscArrayzero(mark, t->ncells));
    else *nmarked = count[2];
  }
  PetscCall(PetscLogEventEnd(ABUTADAPTOR_Mark, adaptor, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutAdaptorView - Prints the type and the caps

   Collective

   Input Parameters:
+  adaptor - the adaptor
-  viewer  - where to

   Level: intermediate

.seealso: `AbutAdaptorSetFromOptions()`
@*/
PetscErrorCode AbutAdaptorView(AbutAdaptor adaptor, PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(adaptor, ABUTADAPTOR_CLASSID, 1);
  PetscCall(PetscObjectPrintClassNamePrefixType((PetscObject)adaptor, viewer));
  PetscCall(PetscViewerASCIIPushTab(viewer));
  PetscTryTypeMethod(adaptor, view, viewer);
  PetscCall(PetscViewerASCIIPrintf(viewer, "at most level %" PetscInt_FMT ", %" PetscInt_FMT " unknowns in a body\n", adaptor->max_level,
                                   adaptor->max_unknowns));
  if (adaptor->coarsen > 0.)
    PetscCall(PetscViewerASCIIPrintf(viewer, "merges cells below %g of the bound for refinement\n", (double)adaptor->coarsen));
  PetscCall(PetscViewerASCIIPrintf(viewer, "adapts %s", adaptor->nbodies ? "" : "all bodies"));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_FALSE));
  for (PetscInt i = 0; i < adaptor->nbodies; ++i) PetscCall(PetscViewerASCIIPrintf(viewer, "%s%s", i ? ", " : "", adaptor->body[i]));
  PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_TRUE));
  PetscCall(PetscViewerASCIIPopTab(viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}
