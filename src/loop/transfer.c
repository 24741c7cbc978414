#include <abut/private/pairimpl.h>
#include <abut/private/loopimpl.h> /*I "abutloop.h" I*/

/* Traces and pressures across a change of mesh: kept with the coordinates of their nodes, and evaluated at the new ones */

static PetscErrorCode AbutOldTraceKeep_Private(AbutOldTrace *old, PetscInt n, PetscInt each, const PetscReal x[], const PetscReal value[],
                                               PetscBool backwards)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(old->x, old->value));
  old->n    = n;
  old->each = each;
  PetscCall(PetscMalloc2(2 * n, &old->x, each * n, &old->value));
  for (PetscInt i = 0; i < n; ++i) {
    const PetscInt from = backwards ? n - 1 - i : i;

    old->x[2 * i]     = x[2 * from];
    old->x[2 * i + 1] = x[2 * from + 1];
    for (PetscInt d = 0; d < each; ++d) old->value[each * i + d] = value[each * from + d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Values of the tractions of a pair at a node: the pressure, and with friction the tangential traction */
static PetscErrorCode AbutInterfaceGetTractions_Private(AbutInterface f, PetscInt pair, PetscInt *each)
{
  PetscBool friction;

  PetscFunctionBegin;
  PetscCall(AbutPairGetFriction(f->pair[pair], &friction, NULL));
  *each = friction ? 2 : 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceKeepTrace - Keeps a trace, and the pressures of the last sweep, before the meshes adapt

   Collective

   Input Parameters:
+  iface - the map, set up
-  x     - the trace

   Level: developer

.seealso: `AbutInterfaceTransferTrace()`, `AbutInterfaceReset()`
@*/
PetscErrorCode AbutInterfaceKeepTrace(AbutInterface iface, Vec x)
{
  PetscReal *full;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(iface->offset[2 * iface->npairs], &full));
  PetscCall(AbutInterfaceReplicate_Private(iface, x, full));
  for (PetscInt t = 0; t < 2 * iface->npairs; ++t) {
    AbutBody        bodies[2];
    PetscInt        sides[2], each;
    const AbutSide *side;

    if (iface->bodyof[t] < 0) continue;
    PetscCall(AbutPairGetBodies(iface->pair[t / 2], bodies, sides));
    PetscCall(AbutPairGetComponents(iface->pair[t / 2], &each));
    PetscCall(AbutBodyGetSide(bodies[t % 2], sides[t % 2], &side));
    PetscCall(AbutOldTraceKeep_Private(&iface->old[t], side->n, each, side->x, full + iface->offset[t], PETSC_FALSE));
  }
  for (PetscInt i = 0; i < iface->npairs; ++i) { /* the pressures may change sides: always along the first one */
    PetscInt         which, n;
    const PetscReal *xn, *D;
    PetscReal       *unknown;
    PetscInt         each = 1;

    PetscCall(AbutPairGetPressureNodes(iface->pair[i], &which, &n, &xn, &D));
    PetscCall(AbutInterfaceGetTractions_Private(iface, i, &each));
    PetscCall(PetscMalloc1(each * n, &unknown));
    for (PetscInt k = 0; k < n; ++k)
      for (PetscInt d = 0; d < each; ++d) unknown[each * k + d] = iface->p[i][d * n + k] - iface->guess[i][d * n + k];
    PetscCall(AbutOldTraceKeep_Private(&iface->oldpressure[i], n, each, xn, unknown, (PetscBool)which));
    PetscCall(PetscFree(unknown));
  }
  iface->warm = iface->guessed;
  PetscCall(PetscFree(full));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceForgetTrace - The next loop begins without pressures that were kept

   Logically Collective

   Input Parameter:
.  iface - the map

   Level: developer

.seealso: `AbutInterfaceKeepTrace()`
@*/
PetscErrorCode AbutInterfaceForgetTrace(AbutInterface iface)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(iface, ABUTINTERFACE_CLASSID, 1);
  iface->warm = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void AbutOldTraceValue_Private(const AbutOldTrace *old, const PetscReal x[2], PetscInt *element, PetscReal value[])
{
  const PetscReal t = AbutPairWalkTo_Private(old->n, old->x, x, element);

  for (PetscInt d = 0; d < old->each; ++d)
    value[d] = (1. - t) * old->value[old->each * *element + d] + t * old->value[old->each * (*element + 1) + d];
}

/*@
   AbutInterfaceTransferTrace - The kept trace at the nodes of the present meshes

   Collective

   Input Parameter:
.  iface - the map, set up on the new meshes

   Output Parameter:
.  x - the trace, evaluated linearly between the old nodes

   Level: developer

.seealso: `AbutInterfaceKeepTrace()`
@*/
PetscErrorCode AbutInterfaceTransferTrace(AbutInterface iface, Vec x)
{
  PetscFunctionBegin;
  for (PetscInt t = 0; t < 2 * iface->npairs; ++t)
    AbutCheckInput(iface->bodyof[t] < 0 || (iface->old[t].n > 1 && iface->oldpressure[t / 2].n > 1), PetscObjectComm((PetscObject)iface),
                   "restart: the checkpoint has no traces to begin with; it was written with scene_cold: give that here, too");
  for (PetscInt t = 0; t < 2 * iface->npairs; ++t) {
    AbutBody        bodies[2];
    PetscInt        sides[2], element = 0, each;
    const AbutSide *side;

    if (iface->bodyof[t] < 0) continue;
    PetscCall(AbutPairGetBodies(iface->pair[t / 2], bodies, sides));
    PetscCall(AbutPairGetComponents(iface->pair[t / 2], &each));
    PetscCall(AbutBodyGetSide(bodies[t % 2], sides[t % 2], &side));
    if (each != iface->old[t].each) { /* one chord has become an arc */
      PetscCall(PetscArrayzero(iface->x + iface->offset[t], each * side->n));
      continue;
    }
    for (PetscInt i = 0; i < side->n; ++i)
      AbutOldTraceValue_Private(&iface->old[t], side->x + 2 * i, &element, iface->x + iface->offset[t] + iface->old[t].each * i);
  }
  PetscCall(AbutInterfaceLocalize_Private(iface, iface->x, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The guess of the present meshes, and what was wrong with that of the old ones: the first pressures of a loop that goes on */
PetscErrorCode AbutInterfaceTransferPressure_Private(AbutInterface iface)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < iface->npairs; ++i) {
    PetscInt         which, n, element = 0;
    const PetscReal *x, *D;
    PetscReal        mu;
    PetscBool        friction;

    PetscCall(AbutPairGetPressureNodes(iface->pair[i], &which, &n, &x, &D));
    PetscCall(AbutPairGetFriction(iface->pair[i], &friction, &mu));
    for (PetscInt k = 0; k < n; ++k) {
      const PetscInt node = which ? n - 1 - k : k;
      PetscReal      p[2], most;

      AbutOldTraceValue_Private(&iface->oldpressure[i], x + 2 * node, &element, p);
      iface->p[i][node] = D[node] > 0. ? PetscMax(0., iface->guess[i][node] + p[0]) : 0.;
      if (!friction) continue;
      most                  = mu * iface->p[i][node];
      iface->p[i][n + node] = PetscMax(-most, PetscMin(most, iface->guess[i][n + node] + p[1]));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutOldTraceArchive_Private(AbutOldTrace *old, AbutArchive ar)
{
  PetscBool reads;

  PetscFunctionBegin;
  PetscCall(AbutArchiveReads(ar, &reads));
  PetscCall(AbutArchiveCount(ar, "nodes of a side", &old->n));
  PetscCall(AbutArchiveInts(ar, "values of a node", 1, &old->each));
  AbutCheckInput(old->n == 0 || old->each == 1 || old->each == 2, PETSC_COMM_WORLD,
                 "restart: %" PetscInt_FMT " values of a node are not those of a trace", old->each);
  if (reads) {
    PetscCall(PetscFree2(old->x, old->value));
    PetscCall(PetscMalloc2(2 * old->n, &old->x, old->each * old->n, &old->value));
  }
  PetscCall(AbutArchiveReals(ar, "their places", 2 * old->n, old->x));
  PetscCall(AbutArchiveReals(ar, "their values", old->each * old->n, old->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceArchive - What goes from mesh to mesh into an archive, or out of one: kept traces, pressures, counts of sweeps

   Collective

   Input Parameters:
+  iface - the map
-  ar    - the archive

   Level: developer

.seealso: `AbutInterfaceKeepTrace()`, `AbutInterfaceArchiveTrace()`
@*/
PetscErrorCode AbutInterfaceArchive(AbutInterface iface, AbutArchive ar)
{
  PetscInt state[3] = {iface->sweeps, iface->startsweeps, iface->warm};

  PetscFunctionBegin;
  PetscValidHeaderSpecific(iface, ABUTINTERFACE_CLASSID, 1);
  for (PetscInt i = 0; i < iface->npairs; ++i) {
    const char *name;

    PetscCall(AbutPairGetName(iface->pair[i], &name));
    PetscCall(AbutArchiveFit(ar, "pair", name));
  }
  PetscCall(AbutArchiveInts(ar, "sweeps", 3, state));
  iface->sweeps      = state[0];
  iface->startsweeps = state[1];
  iface->warm        = (PetscBool)state[2];
  for (PetscInt t = 0; t < 2 * iface->npairs; ++t) PetscCall(AbutOldTraceArchive_Private(&iface->old[t], ar));
  for (PetscInt i = 0; i < iface->npairs; ++i) {
    PetscBool friction;

    PetscCall(AbutOldTraceArchive_Private(&iface->oldpressure[i], ar));
    PetscCall(AbutPairGetFriction(iface->pair[i], &friction, NULL));
    if (friction) PetscCall(AbutPairArchiveSlip(iface->pair[i], ar));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceArchiveTrace - A trace on the present meshes into an archive, or out of one

   Collective

   Input Parameters:
+  iface - the map, set up
.  ar    - the archive
-  x     - the trace

   Level: developer

.seealso: `AbutInterfaceArchive()`, `AbutInterfaceCreateVec()`
@*/
PetscErrorCode AbutInterfaceArchiveTrace(AbutInterface iface, AbutArchive ar, Vec x)
{
  const PetscInt n = iface->offset[2 * iface->npairs];
  PetscReal     *full;
  PetscBool      reads;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(iface, ABUTINTERFACE_CLASSID, 1);
  PetscCall(AbutArchiveReads(ar, &reads));
  PetscCall(PetscMalloc1(n, &full));
  if (!reads) PetscCall(AbutInterfaceReplicate_Private(iface, x, full));
  PetscCall(AbutArchiveReals(ar, "trace", n, full));
  if (reads) PetscCall(AbutInterfaceLocalize_Private(iface, full, x));
  PetscCall(PetscFree(full));
  PetscFunctionReturn(PETSC_SUCCESS);
}
