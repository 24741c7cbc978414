#include <abut/private/loopimpl.h> /*I "abutloop.h" I*/

PetscClassId  ABUTINTERFACE_CLASSID;
PetscLogEvent ABUTINTERFACE_Sweep;

/*@
   AbutInterfaceCreate - Makes bodies and pairs into one map of the interface trace

   Collective

   Input Parameters:
+  comm    - the communicator of the bodies
.  nbodies - the bodies
.  bodies  - [nbodies]
.  npairs  - the pairs; 0 for bodies without contact
-  pairs   - [npairs]

   Output Parameter:
.  iface - the map

   Level: intermediate

   Note:
   Limits: the trace is kept on every rank, and so is the contact model up to the size of `AbutInterfaceSetShare()`.

.seealso: `AbutInterfaceSetUp()`, `AbutInterfaceSweep()`, `AbutInterfaceSetSNES()`, `AbutInterfaceDestroy()`
@*/
PetscErrorCode AbutInterfaceCreate(MPI_Comm comm, PetscInt nbodies, AbutBody bodies[], PetscInt npairs, AbutPair pairs[],
                                   AbutInterface *iface)
{
  AbutInterface f;

  PetscFunctionBegin;
  PetscCall(AbutLoopRegisterAll());
  PetscCall(PetscHeaderCreate(f, ABUTINTERFACE_CLASSID, "AbutInterface", "Map of the interface trace", "Interface", comm,
                              AbutInterfaceDestroy, NULL));
  f->nbodies = nbodies;
  f->npairs  = npairs;
  f->share   = ABUT_MODEL_SHARE;
  PetscCall(PetscMalloc2(nbodies, &f->body, npairs, &f->pair));
  for (PetscInt i = 0; i < nbodies; ++i) {
    PetscCall(PetscObjectReference((PetscObject)bodies[i]));
    f->body[i] = bodies[i];
  }
  for (PetscInt i = 0; i < npairs; ++i) {
    PetscCall(PetscObjectReference((PetscObject)pairs[i]));
    f->pair[i] = pairs[i];
  }
  PetscCall(PetscCalloc2(2 * npairs, &f->old, npairs, &f->oldpressure));
  PetscCall(PetscMalloc1(2 * npairs, &f->bodyof));
  for (PetscInt t = 0; t < 2 * npairs; ++t) {
    AbutBody ends[2];
    PetscInt sides[2];

    PetscCall(AbutPairGetBodies(pairs[t / 2], ends, sides));
    for (PetscInt b = 0; b < nbodies; ++b)
      if (bodies[b] == ends[t % 2]) f->bodyof[t] = b;
    if (!ends[t % 2]) f->bodyof[t] = -1;
  }
  *iface = f;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which values are whose, and where they stand when all ranks' values are laid end to end */
static PetscErrorCode AbutInterfaceLayout_Private(AbutInterface f)
{
  MPI_Comm    comm = PetscObjectComm((PetscObject)f);
  PetscInt    all = f->offset[2 * f->npairs], n = 0;
  PetscMPIInt size, count, *counts, *displs;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(all, &f->owned, all, &f->place));
  for (PetscInt i = 0; i < f->npairs; ++i) {
    AbutBody bodies[2];
    PetscInt sides[2], m;

    PetscCall(AbutPairGetBodies(f->pair[i], bodies, sides));
    PetscCall(AbutPairGetComponents(f->pair[i], &m));
    for (PetscInt s = 0; s < 2 && bodies[s]; ++s) {
      const AbutSide         *side;
      const AbutMeshTopology *t;
      AbutMesh                mesh;

      PetscCall(AbutBodyGetSide(bodies[s], sides[s], &side));
      PetscCall(AbutBodyGetMesh(bodies[s], &mesh));
      PetscCall(AbutMeshGetTopology(mesh, &t));
      for (PetscInt k = 0; k < m * side->n; ++k)
        if (side->global[k / m] >= t->firstowned && side->global[k / m] < t->firstowned + t->nowned)
          f->owned[n++] = f->offset[2 * i + s] + k;
    }
  }
  f->nowned = n;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMalloc2(size, &counts, size, &displs));
  PetscCall(PetscMPIIntCast(n, &count));
  PetscCallMPI(MPI_Allgather(&count, 1, MPI_INT, counts, 1, MPI_INT, comm));
  for (PetscMPIInt r = 0, at = 0; r < size; at += counts[r++]) displs[r] = at;
  PetscCallMPI(MPI_Allgatherv(f->owned, count, MPIU_INT, f->place, counts, displs, MPIU_INT, comm));
  PetscCall(PetscFree2(counts, displs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceSetUp - Sets up bodies and pairs, and the layout of the trace; after `AbutInterfaceReset()` for adapted meshes anew

   Collective

   Input Parameter:
.  iface - the map

   Level: intermediate

.seealso: `AbutInterfaceCreate()`, `AbutInterfaceCreateVec()`
@*/
PetscErrorCode AbutInterfaceSetUp(AbutInterface iface)
{
  PetscInt all;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(iface, ABUTINTERFACE_CLASSID, 1);
  if (iface->setupcalled) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutBodySetUpAll(iface->nbodies, iface->body));
  PetscCall(PetscCalloc1(2 * iface->npairs + 1, &iface->offset));
  for (PetscInt i = 0; i < iface->npairs; ++i) {
    PetscInt n[2], m;

    PetscCall(AbutPairSetUp(iface->pair[i]));
    PetscCall(AbutPairGetSizes(iface->pair[i], n));
    PetscCall(AbutPairGetComponents(iface->pair[i], &m));
    iface->offset[2 * i + 1] = iface->offset[2 * i] + m * n[0];
    iface->offset[2 * i + 2] = iface->offset[2 * i + 1] + m * n[1];
  }
  all = iface->offset[2 * iface->npairs];
  PetscCall(AbutInterfaceLayout_Private(iface));
  PetscCall(PetscCalloc5(all, &iface->x, all, &iface->g, all, &iface->xbest, iface->npairs, &iface->p, iface->npairs, &iface->guess));
  for (PetscInt i = 0; i < iface->npairs; ++i) {
    PetscCall(PetscCalloc1(iface->offset[2 * i + 2] - iface->offset[2 * i], &iface->p[i]));
    PetscCall(PetscCalloc1(iface->offset[2 * i + 2] - iface->offset[2 * i], &iface->guess[i]));
  }
  PetscCall(PetscMalloc2(iface->nbodies, &iface->force, iface->nbodies, &iface->u));
  for (PetscInt b = 0; b < iface->nbodies; ++b) {
    PetscCall(AbutBodyCreateVec(iface->body[b], &iface->force[b]));
    PetscCall(AbutBodyGetSolution(iface->body[b], &iface->u[b]));
  }
  PetscCall(AbutInterfaceCreateVec(iface, &iface->G));
  PetscCall(VecScatterCreateToAll(iface->G, &iface->toall, &iface->everywhere));
  iface->id           = 0;
  iface->residualbest = PETSC_MAX_REAL;
  iface->linearfailed = PETSC_FALSE;
  iface->failure      = NULL;
  iface->floating[0]  = 0;
  iface->acts         = PETSC_FALSE;
  iface->guessed      = PETSC_FALSE;
  iface->largest      = 0.;
  iface->setupcalled  = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceReset - Frees what belongs to the present meshes; the counts of sweeps stay

   Collective

   Input Parameter:
.  iface - the map

   Level: intermediate

.seealso: `AbutInterfaceSetUp()`, `AbutInterfaceKeepTrace()`
@*/
PetscErrorCode AbutInterfaceReset(AbutInterface iface)
{
  PetscFunctionBegin;
  if (!iface->setupcalled) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < iface->npairs; ++i) {
    PetscCall(PetscFree(iface->p[i]));
    PetscCall(PetscFree(iface->guess[i]));
  }
  for (PetscInt b = 0; b < iface->nbodies; ++b) PetscCall(VecDestroy(&iface->force[b]));
  PetscCall(PetscFree2(iface->force, iface->u));
  PetscCall(AbutContactModelDestroy_Private(&iface->model));
  PetscCall(PetscFree(iface->offset));
  PetscCall(PetscFree2(iface->owned, iface->place));
  PetscCall(PetscFree5(iface->x, iface->g, iface->xbest, iface->p, iface->guess));
  PetscCall(VecScatterDestroy(&iface->toall));
  PetscCall(VecDestroy(&iface->everywhere));
  PetscCall(VecDestroy(&iface->G));
  iface->setupcalled = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceDestroy - Frees the map

   Collective

   Input Parameter:
.  iface - the map; set to `NULL`

   Level: intermediate

.seealso: `AbutInterfaceCreate()`
@*/
PetscErrorCode AbutInterfaceDestroy(AbutInterface *iface)
{
  PetscFunctionBegin;
  if (!*iface) PetscFunctionReturn(PETSC_SUCCESS);
  PetscValidHeaderSpecific(*iface, ABUTINTERFACE_CLASSID, 1);
  if (--((PetscObject)*iface)->refct > 0) {
    *iface = NULL;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(AbutInterfaceReset(*iface));
  for (PetscInt b = 0; b < (*iface)->nbodies; ++b) PetscCall(AbutBodyDestroy(&(*iface)->body[b]));
  for (PetscInt i = 0; i < (*iface)->npairs; ++i) PetscCall(AbutPairDestroy(&(*iface)->pair[i]));
  for (PetscInt t = 0; t < 2 * (*iface)->npairs; ++t) PetscCall(PetscFree2((*iface)->old[t].x, (*iface)->old[t].value));
  for (PetscInt i = 0; i < (*iface)->npairs; ++i) PetscCall(PetscFree2((*iface)->oldpressure[i].x, (*iface)->oldpressure[i].value));
  PetscCall(PetscFree2((*iface)->old, (*iface)->oldpressure));
  PetscCall(PetscFree((*iface)->bodyof));
  PetscCall(PetscFree2((*iface)->body, (*iface)->pair));
  PetscCall(PetscHeaderDestroy(iface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceCreateVec - Creates a trace vector

   Collective

   Input Parameter:
.  iface - the map, set up

   Output Parameter:
.  x - u_n1 and u_n2 of every pair, or both components where its sides are curved, length; each value on the rank that owns its node

   Level: intermediate

.seealso: `AbutInterfaceSweep()`
@*/
PetscErrorCode AbutInterfaceCreateVec(AbutInterface iface, Vec *x)
{
  PetscFunctionBegin;
  PetscCall(VecCreate(PetscObjectComm((PetscObject)iface), x));
  PetscCall(VecSetSizes(*x, iface->nowned, PETSC_DETERMINE));
  PetscCall(VecSetType(*x, VECSTANDARD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A trace vector -> all its values on every rank, side by side in order; and back */
PetscErrorCode AbutInterfaceReplicate_Private(AbutInterface iface, Vec x, PetscReal full[])
{
  const PetscScalar *a;

  PetscFunctionBegin;
  PetscCall(VecScatterBegin(iface->toall, x, iface->everywhere, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(iface->toall, x, iface->everywhere, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGetArrayRead(iface->everywhere, &a));
  for (PetscInt k = 0; k < iface->offset[2 * iface->npairs]; ++k) full[iface->place[k]] = a[k];
  PetscCall(VecRestoreArrayRead(iface->everywhere, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutInterfaceLocalize_Private(AbutInterface iface, const PetscReal full[], Vec x)
{
  PetscScalar *a;

  PetscFunctionBegin;
  PetscCall(VecGetArrayWrite(x, &a));
  for (PetscInt k = 0; k < iface->nowned; ++k) a[k] = full[iface->owned[k]];
  PetscCall(VecRestoreArrayWrite(x, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceGetSweeps - Sweeps so far: solves of all bodies over the number of bodies

   Not Collective

   Input Parameter:
.  iface - the map

   Output Parameters:
+  sweeps - sweeps of the loop
-  start  - sweeps spent on a start that solves each body alone, or `NULL`

   Level: intermediate

.seealso: `AbutInterfaceSweep()`
@*/
PetscErrorCode AbutInterfaceGetSweeps(AbutInterface iface, PetscInt *sweeps, PetscInt *start)
{
  PetscFunctionBegin;
  *sweeps = iface->sweeps;
  if (start) *start = iface->startsweeps;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceGetResidual - The fixed-point residuals of the last sweep

   Not Collective

   Input Parameter:
.  iface - the map

   Output Parameters:
+  trace    - |G(x) - x|/|G(x)|
-  pressure - the same of the pressures, in L2 with the nodal lengths

   Level: intermediate

.seealso: `AbutInterfaceSweep()`
@*/
PetscErrorCode AbutInterfaceGetResidual(AbutInterface iface, PetscReal *trace, PetscReal *pressure)
{
  PetscFunctionBegin;
  *trace    = iface->residual;
  *pressure = iface->pressureresidual;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutInterfaceGetPressure - The nodal pressures that acted in the last sweep

   Not Collective

   Input Parameters:
+  iface - the map
-  pair  - number of the pair

   Output Parameter:
.  p - pressures at the nodes of `AbutPairGetPressureNodes()`, stress; the same on all ranks, owned by the map

   Level: intermediate

.seealso: `AbutInterfaceGetTrace()`, `AbutInterfaceGetPairState()`
@*/
PetscErrorCode AbutInterfaceGetPressure(AbutInterface iface, PetscInt pair, const PetscReal *p[])
{
  PetscFunctionBegin;
  *p = iface->p[pair];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutInterfaceGetTrace - The displacements that the last sweep gave on one side of a pair: those of the bodies as they now are

   Not Collective

   Input Parameters:
+  iface - the map
.  pair  - number of the pair
-  side  - 0 or 1

   Output Parameter:
.  u - displacements at the nodes of the side, length, as many values a node as `AbutPairGetComponents()` says; the same on all ranks, owned
       by the map

   Level: intermediate

.seealso: `AbutInterfaceGetPressure()`
@*/
PetscErrorCode AbutInterfaceGetTrace(AbutInterface iface, PetscInt pair, PetscInt side, const PetscReal *u[])
{
  PetscFunctionBegin;
  *u = iface->g + iface->offset[2 * pair + side];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutInterfaceGetPairState - Forces, contact zone and contact residuals of one pair after the last sweep

   Not Collective

   Input Parameters:
+  iface - the map
-  pair  - number of the pair

   Output Parameter:
.  state - the state: pressures as they acted, traces as the bodies answered

   Level: intermediate

.seealso: `AbutPairGetState()`
@*/
PetscErrorCode AbutInterfaceGetPairState(AbutInterface iface, PetscInt pair, AbutPairState *state)
{
  PetscFunctionBegin;
  PetscCall(AbutPairGetState(iface->pair[pair], iface->g + iface->offset[2 * pair], iface->g + iface->offset[2 * pair + 1], iface->p[pair],
                             state));
  PetscFunctionReturn(PETSC_SUCCESS);
}
