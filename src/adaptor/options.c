#include <abut/private/adaptorimpl.h> /*I "abutadaptor.h" I*/
#include <abut/private/sysimpl.h>

/* What the user says of an adaptation */

/* All bodies are adapted */
PetscErrorCode AbutAdaptorClearBodies_Private(AbutAdaptor adaptor)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < adaptor->nbodies; ++i) PetscCall(PetscFree(adaptor->body[i]));
  adaptor->nbodies = 0;
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
.  -adaptor_coarsen <0>            - cells below this part of the bound above which cells are refined may be merged again; 0: never
.  -adaptor_follow <bool>          - the meshes of adapted bodies move such that a vertex lies on each edge of their contacts; by default
                                     where the order is 2 or more
.  -adaptor_settle <bool>          - a new mesh that follows is solved twice, and moves to the edges that the first solve finds
.  -adaptor_peak <0>               - how large the last coefficient of the pressure may be on elements that hold the largest one, relative;
                                     0 leaves that pressure to the energy
.  -adaptor_bodies list            - names of the bodies to adapt, separated by commas; all if it is not given
.  -adaptor_max_level <8>          - cells of this level are not refined any more; the first mesh has level 0
-  -adaptor_max_unknowns <1000000> - of one body: no refinement that would pass it

   Level: intermediate

   Notes:
   The fewest unknowns come from `-adaptor_type doerfler -adaptor_bulk 0.5`, the fewest meshes from `-adaptor_bulk 0.7 -adaptor_jump 2`;
   in a scene file `adaptor: {type: doerfler, target: 0.02, bulk: 0.7, jump: 2, follow: true}`.

   Where the pressure ends inside a cell, the force is off by a part that depends on where, of the order of the square of its length,
   whatever the order of the displacement. With `-adaptor_follow` the vertex that is nearest to each end of a contact, as estimated on the
   last meshes (`AbutPairGetEdges()`), is tied to it on both sides (`AbutMeshSetTies()`). At order 1 this gains little.

   After a jump the edge is known to a part of the length of the old cells; with `-adaptor_settle` the solve on the new cells gives it to a
   part of theirs, at the cost of one more solve a mesh. It is worth it for contact forces better than a part in 10^6.

   With `-adaptor_coarsen` P cells whose error is below P times the bound above which cells are refined, `-adaptor_threshold` or the share
   of the target, may go back by one level a cycle (`AbutMeshSetCoarsening()`); those at the edges of contacts stay. It takes away what a
   jump left in the wrong place: on two layers of order 2 that begin with 3 by 1 cells and jump 8 levels, P = 0.1 saves 15 per cent of
   the unknowns of quads and 25 of triangles, with the same error of the force on as many meshes. Where the first mesh finds the edge it
   gains nothing: on the same layers from 8 by 2 cells, to 0.002, 0.1 merges no cell and 0.4 takes 15 meshes instead of 9. Cells merge
   only in a cycle that refines others: a run that ends at `-adaptor_max_unknowns` makes no room for itself. Triangles of a grid whose
   cells are more than 1.7 times as long as wide may stay, all of them, without a word.

   The energy has nearly nothing of an error of the pressure far from the edges, so meshes that are made for the energy leave the cells
   below the largest pressure as they were. With `-adaptor_peak` the cells of both bodies that touch it are refined whatever their
   indicators, as long as `AbutPairGetPeaks()` finds it unresolved and what the loop leaves is less: the loop runs to 0.003 of the
   key on all meshes. What the edge of the contact does to the largest pressure is not in it: on two layers of order 3 and a target
   of 0.02 it stays at 1e-5 whatever the key says. Corners, where one side ends and the other goes on, are left alone.

   Limits: where contact reaches the end of the part that both sides share, as below the corner of a punch, there is no edge to follow.
   Without a cell to refine nothing is merged: the last mesh may have cells that are finer than they need be.

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
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-adaptor_coarsen", "part of the bound for refinement below which cells may be merged",
                            &adaptor->coarsen, NULL));
  AbutCheckInput(adaptor->coarsen >= 0. && adaptor->coarsen <= 0.5, comm,
                 "adaptor_coarsen: %g; give a part of the bound for refinement from 0 to 0.5, for example 0.05", (double)adaptor->coarsen);
  PetscCall(AbutSourceUnless_Private("adaptor_follow", "from order 2 on"));
  PetscCall(AbutOptionsBool(PetscOptionsObject, "-adaptor_follow", "meshes move with the edges of the contacts", &adaptor->follow, &set));
  if (set) adaptor->followset = PETSC_TRUE;
  PetscCall(AbutOptionsBool(PetscOptionsObject, "-adaptor_settle", "a new mesh that follows moves again after its first solve",
                            &adaptor->settle, NULL));
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-adaptor_peak", "last coefficient of the pressure on elements that hold the largest",
                            &adaptor->peak, NULL));
  AbutCheckInput(adaptor->peak == 0. || (adaptor->peak >= 1e-8 && adaptor->peak < 1.), comm,
                 "adaptor_peak: %g is not a part of the largest pressure; give a number from 1e-8 to 1, for example 1e-4, or 0 to "
                 "leave it to the energy",
                 (double)adaptor->peak);
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

/*@
   AbutAdaptorGetMaxUnknowns - The cap on the unknowns of one body

   Not Collective

   Input Parameter:
.  adaptor - the adaptor

   Output Parameter:
.  most - no refinement that would pass it

   Level: developer

.seealso: `AbutAdaptorMark()`, `AbutAdaptorGetLevels()`
@*/
PetscErrorCode AbutAdaptorGetMaxUnknowns(AbutAdaptor adaptor, PetscInt *most)
{
  PetscFunctionBegin;
  *most = adaptor->max_unknowns;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutAdaptorFollows - Whether meshes are to move with the edges of the contacts

   Not Collective

   Input Parameters:
+  adaptor - the adaptor
-  order   - of the displacement in the mesh

   Output Parameter:
.  follows - what `-adaptor_follow` says; by default true from order 2 on

   Level: developer

.seealso: `AbutAdaptorSetFromOptions()`, `AbutMeshSetTies()`
@*/
PetscErrorCode AbutAdaptorFollows(AbutAdaptor adaptor, PetscInt order, PetscBool *follows)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(adaptor, ABUTADAPTOR_CLASSID, 1);
  *follows = adaptor->followset ? adaptor->follow : (PetscBool)(order > 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutAdaptorSettles - Whether a new mesh that follows the edges moves again after its first solve

   Not Collective

   Input Parameter:
.  adaptor - the adaptor

   Output Parameter:
.  settles - what `-adaptor_settle` says

   Level: developer

.seealso: `AbutAdaptorFollows()`
@*/
PetscErrorCode AbutAdaptorSettles(AbutAdaptor adaptor, PetscBool *settles)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(adaptor, ABUTADAPTOR_CLASSID, 1);
  *settles = adaptor->settle;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutAdaptorGetPeak - How large the last coefficient of the pressure may be on elements that hold the largest one, relative to it

   Not Collective

   Input Parameter:
.  adaptor - the adaptor

   Output Parameter:
.  tolerance - what `-adaptor_peak` says; 0: no cell is refined for it

   Level: developer

.seealso: `AbutPairGetPeaks()`, `AbutAdaptorSetFromOptions()`
@*/
PetscErrorCode AbutAdaptorGetPeak(AbutAdaptor adaptor, PetscReal *tolerance)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(adaptor, ABUTADAPTOR_CLASSID, 1);
  *tolerance = adaptor->peak;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutAdaptorGetCoarsening - The part of the bound for refinement below which cells may be merged

   Not Collective

   Input Parameter:
.  adaptor - the adaptor

   Output Parameter:
.  part - what `-adaptor_coarsen` says; 0: no cell is merged

   Level: developer

.seealso: `AbutMeshSetCoarsening()`, `AbutAdaptorSetFromOptions()`
@*/
PetscErrorCode AbutAdaptorGetCoarsening(AbutAdaptor adaptor, PetscReal *part)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(adaptor, ABUTADAPTOR_CLASSID, 1);
  *part = adaptor->coarsen;
  PetscFunctionReturn(PETSC_SUCCESS);
}
