#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/

/* What the hooks of a body say: forces, tractions, nodal forces, and how far sides stand out */

/* Adds the integrals of a body force against the functions of all nodes; what a hanging node gets is its anchors' */
static PetscErrorCode AbutBodyIntegrateForce_Private(AbutBody body, AbutHook h, const AbutMeshTopology *t, PetscQuadrature rule,
                                                     PetscScalar load[])
{
  const PetscReal *xi, *w;
  PetscInt         npoints;
  PetscReal        N[ABUT_CELL_NODES_MAX], G[2 * ABUT_CELL_NODES_MAX], x[2], f[2], det, thickness;

  PetscFunctionBegin;
  PetscCall(PetscQuadratureGetData(rule, NULL, NULL, &npoints, &xi, &w));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    PetscReal moment[2 * ABUT_CELL_NODES_MAX] = {0.};

    for (PetscInt q = 0; q < npoints; ++q) {
      PetscCall(AbutMeshMapCell(body->mesh, c, xi + 2 * q, x, N, G, &det));
      PetscCall((*h->call.force)(x, f, h->ctx));
      PetscCall(AbutBodyGetThickness(body, x, &thickness));
      for (PetscInt k = 0; k < 2 * t->nodes; ++k) moment[k] += w[q] * det * thickness * N[k / 2] * f[k % 2];
    }
    for (PetscInt k = 0; k < 2 * t->nodes; ++k) {
      const PetscInt node = t->cellnode[t->nodes * c + k / 2];

      if (t->unknown[node] >= 0) load[2 * t->unknown[node] + k % 2] += moment[k];
      for (PetscInt i = t->anchors[node]; i < t->anchors[node + 1]; ++i)
        load[2 * t->unknown[t->anchor[i]] + k % 2] += t->weight[i] * moment[k];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutBodyHookForce_Private(AbutBody body, AbutHook h)
{
  const AbutMeshTopology *t;
  PetscQuadrature         rule;
  PetscScalar            *a;
  Vec                     all, local;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  PetscCall(AbutMeshCreateQuadrature(body->mesh, t->order + 2, &rule));
  PetscCall(VecDuplicate(body->u, &all)); /* with ghost values */
  PetscCall(VecGhostGetLocalForm(all, &local));
  PetscCall(VecZeroEntries(local));
  PetscCall(VecGetArray(local, &a));
  PetscCall(AbutBodyIntegrateForce_Private(body, h, t, rule, a));
  PetscCall(VecRestoreArray(local, &a));
  PetscCall(VecGhostRestoreLocalForm(all, &local));
  PetscCall(VecGhostUpdateBegin(all, ADD_VALUES, SCATTER_REVERSE));
  PetscCall(VecGhostUpdateEnd(all, ADD_VALUES, SCATTER_REVERSE));
  PetscCall(VecAXPY(body->load, 1., all));
  PetscCall(VecDestroy(&all));
  PetscCall(PetscQuadratureDestroy(&rule));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Body forces and nodal forces of the present mesh; tractions are in the load already */
PetscErrorCode AbutBodyHookForces_Private(AbutBody body)
{
  PetscFunctionBegin;
  for (AbutHook h = body->hooks; h; h = h->next) {
    if (h->type != ABUT_HOOK_FORCE && h->type != ABUT_HOOK_LOAD) continue;
    PetscCall(PetscLogEventBegin(h->event, body, 0, 0, 0));
    if (h->type == ABUT_HOOK_FORCE) PetscCall(AbutBodyHookForce_Private(body, h));
    else PetscCall((*h->call.load)(body, body->load, h->ctx));
    PetscCall(PetscLogEventEnd(h->event, body, 0, 0, 0));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is a traction given on this component of a side, by its condition or by a hook? */
PetscBool AbutBodyHasTraction_Private(AbutBody body, PetscInt side, PetscInt component)
{
  const AbutCondition *c = &body->condition[side][component];

  if (c->type != ABUT_TRACTION) return PETSC_FALSE;
  for (AbutHook h = body->hooks; h; h = h->next)
    if (h->type == ABUT_HOOK_TRACTION && h->side == side) return PETSC_TRUE;
  return (PetscBool)(c->value != NULL);
}

/* The events of hooks of a type begin or end, on one side or (-1) all of them: once for all points, of which there are many */
PetscErrorCode AbutBodyLogHooks_Private(AbutBody body, AbutHookType type, PetscInt side, PetscBool begin)
{
  PetscFunctionBegin;
  for (AbutHook h = body->hooks; h; h = h->next) {
    if (h->type != type || (side >= 0 && h->side != side)) continue;
    if (begin) PetscCall(PetscLogEventBegin(h->event, body, 0, 0, 0));
    else PetscCall(PetscLogEventEnd(h->event, body, 0, 0, 0));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the tractions of hooks at a point of a side */
PetscErrorCode AbutBodyHookTraction_Private(AbutBody body, PetscInt side, const PetscReal x[2], const PetscReal normal[2], PetscReal t[2])
{
  PetscFunctionBegin;
  for (AbutHook h = body->hooks; h; h = h->next) {
    PetscReal more[2];

    if (h->type != ABUT_HOOK_TRACTION || h->side != side) continue;
    PetscCall((*h->call.traction)(x, normal, more, h->ctx));
    for (PetscInt d = 0; d < 2; ++d) t[d] += more[d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyGetForce - The body force at a point

   Not Collective

   Input Parameters:
+  body - the body
-  x    - [2] the point

   Output Parameter:
.  force - [2] force per volume, stress over length: the sum of what `AbutBodyAddForce()` added

   Level: advanced

   Note:
   For estimators: what is left of equilibrium inside a cell is div s + force.

.seealso: `AbutBodyAddForce()`, `AbutBodyGetFeatures()`
@*/
PetscErrorCode AbutBodyGetForce(AbutBody body, const PetscReal x[2], PetscReal force[2])
{
  PetscFunctionBegin;
  force[0] = force[1] = 0.;
  for (AbutHook h = body->hooks; h; h = h->next) {
    PetscReal more[2];

    if (h->type != ABUT_HOOK_FORCE) continue;
    PetscCall((*h->call.force)(x, more, h->ctx));
    for (PetscInt d = 0; d < 2; ++d) force[d] += body->factor * more[d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyHasSideOffset - Whether a side was said to stand out

   Not Collective

   Input Parameters:
+  body - the body
-  side - number of the side

   Output Parameter:
.  has - whether `AbutBodyAddSideOffset()` was called for it

   Level: developer

.seealso: `AbutBodyGetSideOffset()`
@*/
PetscErrorCode AbutBodyHasSideOffset(AbutBody body, PetscInt side, PetscBool *has)
{
  PetscFunctionBegin;
  *has = PETSC_FALSE;
  for (AbutHook h = body->hooks; h; h = h->next)
    if (h->type == ABUT_HOOK_OFFSET && h->side == side) *has = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyGetSideOffset - How far a side stands out beyond where it is drawn

   Not Collective

   Input Parameters:
+  body - the body
.  side - number of the side
-  x    - [2] point on the side

   Output Parameter:
.  offset - the sum of what `AbutBodyAddSideOffset()` added, length; 0 where nothing did

   Level: developer

.seealso: `AbutBodyAddSideOffset()`, `AbutPairGetGap()`
@*/
PetscErrorCode AbutBodyGetSideOffset(AbutBody body, PetscInt side, const PetscReal x[2], PetscReal *offset)
{
  PetscFunctionBegin;
  *offset = 0.;
  for (AbutHook h = body->hooks; h; h = h->next) {
    PetscReal more;

    if (h->type != ABUT_HOOK_OFFSET || h->side != side) continue;
    PetscCall((*h->call.offset)(x, &more, h->ctx));
    *offset += more;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
