#include <abut/private/adaptorimpl.h> /*I "abutadaptor.h" I*/
#include <abut/private/pluginimpl.h>

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

/* All bodies are adapted */
PetscErrorCode AbutAdaptorClearBodies_Private(AbutAdaptor adaptor)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < adaptor->nbodies; ++i) PetscCall(PetscFree(adaptor->body[i]));
  adaptor->nbodies = 0;
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
  char         names[256]               = "";
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

/* Splits "lower, upper" */
static PetscErrorCode AbutAdaptorSetBodies_Private(AbutAdaptor adaptor, char list[])
{
  MPI_Comm comm = PetscObjectComm((PetscObject)adaptor);
  char    *at   = list;

  PetscFunctionBegin;
  PetscCall(AbutAdaptorClearBodies_Private(adaptor));
  while (at) {
    char  *name = at + strspn(at, " "), *end = strchr(at, ',');
    size_t n;

    at = end ? end + 1 : NULL;
    if (end) *end = 0;
    n = strcspn(name, " ");
    AbutCheckInput(n, comm,
                   "adaptor_bodies: a name is empty; give names of bodies separated by commas, or leave the key out for all bodies");
    AbutCheckInput(adaptor->nbodies < ABUT_BODIES_MAX, comm, "adaptor_bodies: more than %d names; leave the key out for all bodies",
                   ABUT_BODIES_MAX);
    name[n] = 0;
    PetscCall(PetscStrallocpy(name, &adaptor->body[adaptor->nbodies++]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutAdaptorSetFromOptions - Reads what is refined and how far

   Collective

   Input Parameter:
.  adaptor - the adaptor

   Options Database Keys:
+  -adaptor_type <threshold,equal,doerfler> - how cells are chosen
.  -adaptor_threshold <0.1>        - threshold: delta of eq. (27) of the paper, refine cells whose indicator is above
.  -adaptor_target <0.05>          - equal and doerfler: end when the error of all bodies together is estimated to be at most this, relative
.  -adaptor_bulk <0.5>             - doerfler: the refined cells hold this part of the square of the error of all bodies together
.  -adaptor_jump <1>               - a marked cell at the edge of a contact goes up this many levels at once
.  -adaptor_bodies list            - names of the bodies to adapt, separated by commas; all if it is not given
.  -adaptor_max_level <8>          - cells of this level are not refined any more; the first mesh has level 0
-  -adaptor_max_unknowns <1000000> - of one body: no refinement that would pass it

   Level: intermediate

   Notes:
   The fewest unknowns come from `-adaptor_type doerfler -adaptor_bulk 0.5`, the fewest meshes from `-adaptor_bulk 0.7 -adaptor_jump 2`;
   in a scene file `adaptor: {type: doerfler, target: 0.02, bulk: 0.7, jump: 2}`.

.seealso: `AbutAdaptorMark()`, `AbutAdaptorGetBodies()`
@*/
PetscErrorCode AbutAdaptorSetFromOptions(AbutAdaptor adaptor)
{
  MPI_Comm  comm       = PetscObjectComm((PetscObject)adaptor);
  char      type[256]  = ABUTADAPTORTHRESHOLD;
  char      list[4096] = "";
  PetscBool set;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(adaptor, ABUTADAPTOR_CLASSID, 1);
  if (((PetscObject)adaptor)->type_name) PetscCall(PetscStrncpy(type, ((PetscObject)adaptor)->type_name, sizeof(type)));
  PetscObjectOptionsBegin((PetscObject)adaptor);
  PetscCall(AbutOptionsString(PetscOptionsObject, "-adaptor_type", "how cells are chosen for refinement: threshold, equal, doerfler", type,
                              sizeof(type), NULL));
  PetscCall(AbutAdaptorSetType(adaptor, type));
  PetscCall(AbutOptionsString(PetscOptionsObject, "-adaptor_bodies", "names of the bodies to adapt, all if not given", list, sizeof(list),
                              &set));
  if (set) PetscCall(AbutAdaptorSetBodies_Private(adaptor, list));
  PetscCall(AbutOptionsInt(PetscOptionsObject, "-adaptor_max_level", "cells of this level are not refined any more", &adaptor->max_level,
                           NULL));
  AbutCheckInput(adaptor->max_level >= 0 && adaptor->max_level <= ABUT_LEVEL_MAX, comm,
                 "adaptor_max_level: %" PetscInt_FMT " is not a level; give a number from 0 to %d", adaptor->max_level, ABUT_LEVEL_MAX);
  PetscCall(AbutOptionsInt(PetscOptionsObject, "-adaptor_max_unknowns", "of one body: no refinement that would pass it",
                           &adaptor->max_unknowns, NULL));
  AbutCheckInput(adaptor->max_unknowns > 0, comm,
                 "adaptor_max_unknowns: %" PetscInt_FMT " is not above 0; give a number that fits the memory, for example 1000000",
                 adaptor->max_unknowns);
  PetscCall(AbutOptionsInt(PetscOptionsObject, "-adaptor_jump", "levels that a marked cell at the edge of a contact goes up at once",
                           &adaptor->jump, NULL));
  AbutCheckInput(adaptor->jump > 0 && adaptor->jump <= ABUT_LEVEL_MAX, comm,
                 "adaptor_jump: %" PetscInt_FMT " is no number of levels; give a number from 1 to %d, for example 2", adaptor->jump,
                 ABUT_LEVEL_MAX);
  PetscTryTypeMethod(adaptor, setfromoptions, PetscOptionsObject);
  PetscOptionsEnd();
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutAdaptorGetBodies - Gets the names given by `-adaptor_bodies`

   Not Collective

   Input Parameter:
.  adaptor - the adaptor

   Output Parameters:
+  n    - how many; 0 if the key was not given, which means all bodies
-  name - the names, owned by the adaptor

   Level: intermediate

.seealso: `AbutAdaptorSetFromOptions()`
@*/
PetscErrorCode AbutAdaptorGetBodies(AbutAdaptor adaptor, PetscInt *n, const char *const *name[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(adaptor, ABUTADAPTOR_CLASSID, 1);
  *n    = adaptor->nbodies;
  *name = (const char *const *)adaptor->body;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutAdaptorGetLevels - How far cells at the edge of a contact go up at once, and how far cells may go at all

   Not Collective

   Input Parameter:
.  adaptor - the adaptor

   Output Parameters:
+  jump      - levels that a marked cell at the edge of a contact goes up
-  max_level - the last level

   Level: developer

.seealso: `AbutAdaptorSetFromOptions()`
@*/
PetscErrorCode AbutAdaptorGetLevels(AbutAdaptor adaptor, PetscInt *jump, PetscInt *max_level)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(adaptor, ABUTADAPTOR_CLASSID, 1);
  *jump      = adaptor->jump;
  *max_level = adaptor->max_level;
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

/*@C
   AbutAdaptorMark - Marks the cells of a body that are to be refined

   Collective

   Input Parameters:
+  adaptor - the adaptor
.  body    - the body
-  eta     - the indicators of its cells, from `AbutEstimatorEstimate()`

   Output Parameters:
+  mark    - [cells on this rank] for `AbutMeshAdapt()`
.  nmarked - marked cells over all ranks
-  verdict - `ABUT_ADAPT_REFINED` if any cell is marked; otherwise why none is, the same on all ranks

   Level: intermediate

   Notes:
   Cells at `-adaptor_max_level` are left alone as long as others can be refined: `ABUT_ADAPT_LEVEL` says that only such cells are left.

   The number of unknowns to come is estimated as unknowns*(1 + 3*marked/cells), before the mesh is balanced; so the cap may be passed by a
   little.

.seealso: `AbutMeshAdapt()`, `AbutEstimatorEstimate()`, `AbutAdaptVerdict`
@*/
PetscErrorCode AbutAdaptorMark(AbutAdaptor adaptor, AbutBody body, Vec eta, PetscBool mark[], PetscInt *nmarked, AbutAdaptVerdict *verdict)
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
  PetscCall(VecRestoreArrayRead(eta, &e));
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
  PetscCall(PetscViewerASCIIPrintf(viewer, "adapts %s", adaptor->nbodies ? "" : "all bodies"));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_FALSE));
  for (PetscInt i = 0; i < adaptor->nbodies; ++i) PetscCall(PetscViewerASCIIPrintf(viewer, "%s%s", i ? ", " : "", adaptor->body[i]));
  PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_TRUE));
  PetscCall(PetscViewerASCIIPopTab(viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}
