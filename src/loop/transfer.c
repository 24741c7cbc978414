#include <abut/private/loopimpl.h> /*I "abutloop.h" I*/

/* The trace across a change of mesh: kept with the coordinates of its nodes, and evaluated at the new ones */

/*@
   AbutInterfaceKeepTrace - Keeps a trace before the meshes adapt

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
    AbutOldTrace   *old = &iface->old[t];
    AbutBody        bodies[2];
    PetscInt        sides[2];
    const AbutSide *side;

    PetscCall(AbutPairGetBodies(iface->pair[t / 2], bodies, sides));
    PetscCall(AbutBodyGetSide(bodies[t % 2], sides[t % 2], &side));
    PetscCall(PetscFree2(old->x, old->value));
    old->n = side->n;
    PetscCall(PetscMalloc2(2 * old->n, &old->x, old->n, &old->value));
    PetscCall(PetscArraycpy(old->x, side->x, 2 * old->n));
    PetscCall(PetscArraycpy(old->value, full + iface->offset[t], old->n));
  }
  PetscCall(PetscFree(full));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Both node lists run along the same side in the same direction: one walk serves all nodes */
static PetscReal AbutOldTraceValue_Private(const AbutOldTrace *old, const PetscReal x[2], PetscInt *element)
{
  PetscReal t;

  for (;; ++*element) {
    const PetscReal *a = old->x + 2 * *element, d[2] = {a[2] - a[0], a[3] - a[1]};

    t = ((x[0] - a[0]) * d[0] + (x[1] - a[1]) * d[1]) / (d[0] * d[0] + d[1] * d[1]);
    if (t <= 1. || *element + 2 >= old->n) break;
  }
  t = PetscMin(1., PetscMax(0., t));
  return (1. - t) * old->value[*element] + t * old->value[*element + 1];
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
  for (PetscInt t = 0; t < 2 * iface->npairs; ++t) {
    AbutBody        bodies[2];
    PetscInt        sides[2], element = 0;
    const AbutSide *side;

    PetscCall(AbutPairGetBodies(iface->pair[t / 2], bodies, sides));
    PetscCall(AbutBodyGetSide(bodies[t % 2], sides[t % 2], &side));
    for (PetscInt i = 0; i < side->n; ++i)
      iface->x[iface->offset[t] + i] = AbutOldTraceValue_Private(&iface->old[t], side->x + 2 * i, &element);
  }
  PetscCall(AbutInterfaceLocalize_Private(iface, iface->x, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}
