#include <abut/private/loopimpl.h> /*I "abutloop.h" I*/

/* One sweep, eq. (20) of the paper: traces -> pressures -> forces -> one solve per body -> traces */

/* Nodal pressures of all pairs -> nodal forces on all bodies */
PetscErrorCode AbutInterfaceForces_Private(AbutInterface f, PetscReal *const p[], Vec force[])
{
  PetscFunctionBegin;
  for (PetscInt b = 0; b < f->nbodies; ++b) PetscCall(VecZeroEntries(force[b]));
  for (PetscInt i = 0; i < f->npairs; ++i) {
    const PetscInt *o = f->offset + 2 * i;
    AbutBody        bodies[2];
    PetscInt        sides[2], m;
    PetscReal      *nodal;

    PetscCall(AbutPairGetBodies(f->pair[i], bodies, sides));
    PetscCall(AbutPairGetComponents(f->pair[i], &m));
    PetscCall(PetscMalloc1(o[2] - o[0], &nodal));
    PetscCall(AbutPairComputeForce(f->pair[i], p[i], nodal, nodal + o[1] - o[0]));
    for (PetscInt k = 0; k < o[2] - o[0]; ++k) nodal[k] = -nodal[k]; /* a pressure pushes against the outward normal */
    for (PetscInt s = 0; s < 2 && bodies[s]; ++s)
      PetscCall(AbutBodyAddSideForce(bodies[s], sides[s], m, nodal + o[s] - o[0], force[f->bodyof[2 * i + s]]));
    PetscCall(PetscFree(nodal));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Displacements of all bodies -> traces on both sides of all pairs */
PetscErrorCode AbutInterfaceTraces_Private(AbutInterface f, const Vec u[], PetscReal trace[])
{
  PetscFunctionBegin;
  for (PetscInt t = 0; t < 2 * f->npairs; ++t) {
    AbutBody bodies[2];
    PetscInt sides[2], m;

    if (f->bodyof[t] < 0) continue;
    PetscCall(AbutPairGetBodies(f->pair[t / 2], bodies, sides));
    PetscCall(AbutPairGetComponents(f->pair[t / 2], &m));
    PetscCall(AbutBodyGetSideTrace(bodies[t % 2], sides[t % 2], m, u[f->bodyof[t]], trace + f->offset[t]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Has the last linear solve of a body failed? Asked when all bodies are solved: it is where ranks wait for each other. */
static PetscErrorCode AbutInterfaceCheckSolves_Private(AbutInterface f)
{
  PetscBool solved;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < f->nbodies; ++b) {
    PetscCall(AbutBodyGetSolved(f->body[b], &solved));
    if (!solved) f->linearfailed = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Pressures p act, every body is solved with them, its traces go to g */
PetscErrorCode AbutInterfaceSolveBodies_Private(AbutInterface f)
{
  PetscFunctionBegin;
  PetscCall(AbutInterfaceForces_Private(f, f->p, f->force));
  for (PetscInt b = 0; b < f->nbodies; ++b) PetscCall(AbutBodySolve(f->body[b], f->force[b]));
  PetscCall(AbutInterfaceCheckSolves_Private(f));
  PetscCall(AbutInterfaceTraces_Private(f, f->u, f->g));
  f->acts = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One sweep with more pressures alone, zero prescribed displacements and no loads: what it adds to the traces; the bodies stay as they
   are */
PetscErrorCode AbutInterfaceIncrement_Private(AbutInterface f, PetscReal *const p[], Vec force[], Vec w[], PetscReal trace[])
{
  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(ABUTINTERFACE_Sweep, f, 0, 0, 0));
  PetscCall(AbutInterfaceForces_Private(f, p, force));
  for (PetscInt b = 0; b < f->nbodies; ++b) PetscCall(AbutBodySolveIncrement(f->body[b], force[b], w[b]));
  PetscCall(AbutInterfaceCheckSolves_Private(f));
  PetscCall(AbutInterfaceTraces_Private(f, w, trace));
  PetscCall(PetscLogEventEnd(ABUTINTERFACE_Sweep, f, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* |G-x|/|G|, and the same of the pressures that G would give */
static PetscErrorCode AbutInterfaceResiduals_Private(AbutInterface f)
{
  PetscReal e2 = 0., g2 = 0., ep2 = 0., p2 = 0.;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < f->offset[2 * f->npairs]; ++k) {
    e2 += PetscSqr(f->g[k] - f->x[k]);
    g2 += PetscSqr(f->g[k]);
  }
  for (PetscInt i = 0; i < f->npairs; ++i) {
    const PetscReal *x, *D;
    PetscReal       *p;
    PetscInt         which, n, values;
    PetscBool        friction;

    PetscCall(AbutPairGetPressureNodes(f->pair[i], &which, &n, &x, &D));
    PetscCall(AbutPairGetFriction(f->pair[i], &friction, NULL));
    values = (friction ? 2 : 1) * n;
    PetscCall(PetscMalloc1(values, &p));
    PetscCall(AbutPairComputePressure(f->pair[i], f->g + f->offset[2 * i], f->g + f->offset[2 * i + 1], p));
    for (PetscInt k = 0; k < values; ++k) {
      ep2 += D[k % n] * PetscSqr(p[k] - f->p[i][k]);
      p2 += D[k % n] * PetscSqr(p[k]);
    }
    PetscCall(PetscFree(p));
  }
  f->residual         = g2 > 0. ? PetscSqrtReal(e2 / g2) : (e2 > 0. ? 1. : 0.);
  f->pressureresidual = p2 > 0. ? PetscSqrtReal(ep2 / p2) : (ep2 > 0. ? 1. : 0.);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceSweep - One sweep: solves every body once with the pressures of a trace, and returns the new trace G(x)

   Collective

   Input Parameters:
+  iface - the map, set up
-  x     - trace, length

   Output Parameter:
.  G - the new trace; what was computed for the same x is returned without a sweep

   Level: intermediate

.seealso: `AbutInterfaceGetSweeps()`, `AbutInterfaceSetSNES()`
@*/
PetscErrorCode AbutInterfaceSweep(AbutInterface iface, Vec x, Vec G)
{
  PetscObjectId    id;
  PetscObjectState state;

  PetscFunctionBegin;
  PetscCall(PetscObjectGetId((PetscObject)x, &id));
  PetscCall(PetscObjectStateGet((PetscObject)x, &state));
  if (id != iface->id || state != iface->state) {
    PetscBool same = PETSC_FALSE;

    if (iface->id) { /* another vector with the very values of the last sweep: solvers copy their iterates */
      PetscReal *full;
      PetscInt   all = iface->offset[2 * iface->npairs];

      PetscCall(PetscMalloc1(all, &full));
      PetscCall(AbutInterfaceReplicate_Private(iface, x, full));
      PetscCall(PetscArraycmp(full, iface->x, all, &same));
      PetscCall(PetscFree(full));
    }
    if (!same) {
      PetscCall(PetscLogEventBegin(ABUTINTERFACE_Sweep, iface, 0, 0, 0));
      PetscCall(AbutInterfaceReplicate_Private(iface, x, iface->x));
      for (PetscInt i = 0; i < iface->npairs; ++i)
        PetscCall(AbutPairComputePressure(iface->pair[i], iface->x + iface->offset[2 * i], iface->x + iface->offset[2 * i + 1],
                                          iface->p[i]));
      PetscCall(AbutInterfaceSolveBodies_Private(iface));
      PetscCall(AbutInterfaceResiduals_Private(iface));
      PetscCall(AbutInterfaceLocalize_Private(iface, iface->g, iface->G));
      ++iface->sweeps;
      if (iface->residual < iface->residualbest) {
        iface->residualbest = iface->residual;
        PetscCall(PetscArraycpy(iface->xbest, iface->x, iface->offset[2 * iface->npairs]));
      }
      PetscCall(PetscLogEventEnd(ABUTINTERFACE_Sweep, iface, 0, 0, 0));
    }
    iface->id    = id;
    iface->state = state;
  }
  PetscCall(VecCopy(iface->G, G));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceSweepBest - Takes bodies and trace back to the trace of least residual since the set-up: what a failed loop leaves

   Collective

   Input Parameter:
.  iface - the map

   Output Parameter:
.  x - that trace

   Level: developer

.seealso: `AbutInterfaceSweep()`, `AbutInterfaceGetVerdict()`
@*/
PetscErrorCode AbutInterfaceSweepBest(AbutInterface iface, Vec x)
{
  Vec G;

  PetscFunctionBegin;
  if (iface->residualbest == PETSC_MAX_REAL || iface->residual <= iface->residualbest) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutInterfaceLocalize_Private(iface, iface->xbest, x));
  PetscCall(VecDuplicate(x, &G));
  PetscCall(AbutInterfaceSweep(iface, x, G));
  PetscCall(VecDestroy(&G));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const char *const AbutStarts[] = {"winkler", "nocontact", "zero", NULL};

/*@
   AbutInterfaceComputeStart - The first trace of a loop

   Collective

   Input Parameters:
+  iface - the map, set up
-  start - `ABUT_START_WINKLER` two elastic layers, the paper's; `ABUT_START_NOCONTACT` every body solved without contact forces;
           `ABUT_START_ZERO`

   Output Parameter:
.  x - the trace

   Level: intermediate

   Note:
   Winkler needs a support with prescribed displacement opposite to each side; without it the start is without contact.

.seealso: `AbutInterfaceSweep()`, `AbutPairComputeWinkler()`
@*/
PetscErrorCode AbutInterfaceComputeStart(AbutInterface iface, AbutStart start, Vec x)
{
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(iface->x, iface->offset[2 * iface->npairs]));
  iface->id   = 0;
  iface->warm = PETSC_FALSE;
  for (PetscInt i = 0; start == ABUT_START_WINKLER && i < iface->npairs; ++i) {
    PetscBool found;

    PetscCall(AbutPairComputeWinkler(iface->pair[i], iface->x + iface->offset[2 * i], iface->x + iface->offset[2 * i + 1], &found));
    if (!found) start = ABUT_START_NOCONTACT;
  }
  if (start == ABUT_START_NOCONTACT) {
    for (PetscInt i = 0; i < iface->npairs; ++i) PetscCall(PetscArrayzero(iface->p[i], iface->offset[2 * i + 2] - iface->offset[2 * i]));
    PetscCall(AbutInterfaceSolveBodies_Private(iface));
    PetscCall(PetscArraycpy(iface->x, iface->g, iface->offset[2 * iface->npairs]));
    ++iface->startsweeps;
  }
  PetscCall(AbutInterfaceLocalize_Private(iface, iface->x, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}
