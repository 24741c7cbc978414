#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/
#include <petscdt.h>

/* Boundary conditions (5), (6) of the paper, per component: prescribed displacement or traction of a named side */

static PetscErrorCode AbutBodySetCondition_Private(AbutBody body, PetscInt side, PetscInt component, AbutConditionType type,
                                                   AbutExpression value)
{
  AbutCondition *c = &body->condition[side][component];

  PetscFunctionBegin;
  PetscCall(AbutExpressionDestroy(&c->value));
  c->type          = type;
  c->value         = value;
  body->generation = -1; /* what was set up is no longer right */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The keys bc_SIDE_u1, bc_SIDE_u2, bc_SIDE_t1, bc_SIDE_t2 of every side; twice is one that says again, and otherwise, what another has
   said */
PetscErrorCode AbutBodySetConditionsFromOptions_Private(AbutBody body, AbutOptionItems PetscOptionsObject, char twice[], size_t len)
{
  PetscInt nsides;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetSideCount(body->mesh, &nsides));
  for (PetscInt s = 0; s < nsides; ++s)
    for (PetscInt d = 0; d < 2; ++d) {
      const char *side;
      PetscBool   given[2];

      PetscCall(AbutMeshGetSideName(body->mesh, s, &side));
      for (PetscInt k = 0; k < 2; ++k) {
        char           opt[128], key[256], text[PETSC_MAX_PATH_LEN] = "";
        AbutExpression value;

        PetscCall(PetscSNPrintf(opt, sizeof(opt), "-bc_%s_%c%d", side, k ? 't' : 'u', (int)d + 1));
        PetscCall(PetscSNPrintf(key, sizeof(key), "%s%s", ((PetscObject)body)->prefix, opt + 1));
        PetscCall(AbutOptionsString(PetscOptionsObject, opt, k ? "Traction of the side" : "Displacement of the side", text, sizeof(text),
                                    &given[k]));
        if (!given[k]) continue;
        if (k && given[0]) PetscCall(PetscStrncpy(twice, key, len));
        PetscCall(AbutExpressionCreate(PetscObjectComm((PetscObject)body), key, text, &value));
        PetscCall(AbutBodySetCondition_Private(body, s, d, k ? ABUT_TRACTION : ABUT_DISPLACEMENT, value));
      }
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutBodySetFunction_Private(AbutBody body, const char side[], PetscInt component, AbutConditionType type,
                                                  AbutPointFunction function, void *ctx)
{
  PetscInt       s;
  AbutExpression value;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  PetscCheck(component == 0 || component == 1, PetscObjectComm((PetscObject)body), PETSC_ERR_ARG_OUTOFRANGE,
             "Component %" PetscInt_FMT " is neither 0 nor 1", component);
  PetscCall(AbutMeshFindSide(body->mesh, ((PetscObject)body)->name, side, &s));
  PetscCall(AbutExpressionCreateFunction(function, ctx, &value));
  PetscCall(AbutBodySetCondition_Private(body, s, component, type, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodySetDisplacement - Prescribes one displacement component on a side

   Logically Collective

   Input Parameters:
+  body      - the body
.  side      - name of the side
.  component - 0 or 1
.  function  - the displacement at a point, length
-  ctx       - handed to the function

   Level: intermediate

.seealso: `AbutBodySetTraction()`, `AbutBodySetUp()`
@*/
PetscErrorCode AbutBodySetDisplacement(AbutBody body, const char side[], PetscInt component, AbutPointFunction function, void *ctx)
{
  PetscFunctionBegin;
  PetscCall(AbutBodySetFunction_Private(body, side, component, ABUT_DISPLACEMENT, function, ctx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodySetTraction - Prescribes one traction component on a side

   Logically Collective

   Input Parameters:
+  body      - the body
.  side      - name of the side
.  component - 0 or 1
.  function  - the traction at a point, stress
-  ctx       - handed to the function

   Level: intermediate

   Note:
   Integrated element side by element side with 16 points or more that crowd at the ends, so that a kink or a root at a node does no harm.

.seealso: `AbutBodySetDisplacement()`, `AbutBodySetUp()`
@*/
PetscErrorCode AbutBodySetTraction(AbutBody body, const char side[], PetscInt component, AbutPointFunction function, void *ctx)
{
  PetscFunctionBegin;
  PetscCall(AbutBodySetFunction_Private(body, side, component, ABUT_TRACTION, function, ctx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodySetContact - Says that a side takes part in a contact: its tractions are the contact forces

   Logically Collective

   Input Parameters:
+  body - the body
-  side - number of the side

   Level: developer

   Note:
   A component with prescribed displacement stays prescribed.

.seealso: `AbutPair`, `AbutBodyGetCondition()`
@*/
PetscErrorCode AbutBodySetContact(AbutBody body, PetscInt side)
{
  PetscFunctionBegin;
  for (PetscInt d = 0; d < 2; ++d)
    if (body->condition[side][d].type == ABUT_TRACTION && !body->condition[side][d].value) body->condition[side][d].type = ABUT_CONTACT;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetCondition - What is known on one component of a side

   Not Collective

   Input Parameters:
+  body      - the body
.  side      - number of the side
-  component - 0 or 1

   Output Parameter:
.  type - traction, displacement or contact

   Level: intermediate

.seealso: `AbutBodySetDisplacement()`, `AbutBodySetTraction()`
@*/
PetscErrorCode AbutBodyGetCondition(AbutBody body, PetscInt side, PetscInt component, AbutConditionType *type)
{
  PetscFunctionBegin;
  *type = body->condition[side][component].type;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Moments m[order+1] of a prescribed traction against the functions of an element side, over a unit of thickness or (whole) over that of
   the body. The substitution s = z^3(10-15z+6z^2) crowds the points at the ends, where a pressure may have a root or a kink; polynomials up
   to degree 4 and more are still integrated exactly. */
PetscErrorCode AbutBodyEdgeMoments_Private(AbutBody body, PetscInt side, PetscInt component, const PetscReal a[2], const PetscReal b[2],
                                           PetscBool whole, PetscReal m[])
{
  const AbutCondition *c = &body->condition[side][component];
  PetscReal            normal[2], length = AbutElementNormal_Private(a, b, normal);
  PetscReal            z[12 + 4 * ABUT_ORDER_MAX], w[12 + 4 * ABUT_ORDER_MAX], N[ABUT_SIDE_NODES_MAX];
  PetscInt             p;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetOrder(body->mesh, &p));
  for (PetscInt i = 0; i <= p; ++i) m[i] = 0.;
  if (!AbutBodyHasTraction_Private(body, side, component)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscDTGaussQuadrature(12 + 4 * p, 0., 1., z, w));
  for (PetscInt q = 0; q < 12 + 4 * p; ++q) {
    const PetscReal s = z[q] * z[q] * z[q] * (10. - 15. * z[q] + 6. * z[q] * z[q]), ds = 30. * PetscSqr(z[q] * (1. - z[q]));
    const PetscReal x[2] = {a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])};
    PetscReal       t = 0., more[2] = {0., 0.}, thickness = 1.;

    if (c->value) PetscCall(AbutExpressionEvaluate(c->value, x, &t));
    PetscCall(AbutBodyHookTraction_Private(body, side, x, normal, more));
    t += more[component];
    PetscCall(AbutEvaluateLobatto(p, 2. * s - 1., N, NULL));
    if (whole) PetscCall(AbutBodyGetThickness(body, x, &thickness));
    for (PetscInt i = 0; i <= p; ++i) m[i] += w[q] * ds * length * t * N[i] * thickness;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Every rank integrates over the whole gathered boundary and keeps its own rows: a traction that is not finite ends the run on all ranks */
static PetscErrorCode AbutBodyLoad_Private(AbutBody body, const AbutMeshTopology *t)
{
  const AbutBoundary *b = body->boundary;
  PetscReal           m[ABUT_SIDE_NODES_MAX];

  PetscFunctionBegin;
  PetscCall(VecZeroEntries(body->load));
  PetscCall(AbutBodyLogHooks_Private(body, ABUT_HOOK_TRACTION, -1, PETSC_TRUE));
  for (PetscInt i = 0; i < b->n; ++i)
    for (PetscInt d = 0; d < 2; ++d) {
      if (!AbutBodyHasTraction_Private(body, b->side[i], d)) continue;
      PetscCall(AbutBodyEdgeMoments_Private(body, b->side[i], d, b->x + 2 * AbutBoundaryNode(b, i, 0),
                                            b->x + 2 * AbutBoundaryNode(b, i, b->order), PETSC_TRUE, m));
      for (PetscInt k = 0; k <= b->order; ++k) {
        const PetscInt node = body->boundaryglobal[AbutBoundaryNode(b, i, k)];

        if (node >= t->firstowned && node < t->firstowned + t->nowned) PetscCall(VecSetValue(body->load, 2 * node + d, m[k], ADD_VALUES));
      }
    }
  PetscCall(AbutBodyLogHooks_Private(body, ABUT_HOOK_TRACTION, -1, PETSC_FALSE));
  PetscCall(VecAssemblyBegin(body->load));
  PetscCall(VecAssemblyEnd(body->load));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which unknowns of the gathered boundary are prescribed, is[2*nnodes], and their values; the first side of a corner says it. Points of an
   axis of symmetry stay there. */
static PetscErrorCode AbutBodyPrescribe_Private(AbutBody body, PetscBool is[], PetscReal value[])
{
  const AbutBoundary *b = body->boundary;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < b->n; ++i)
    for (PetscInt d = 0; d < 2; ++d) {
      const AbutCondition *c = &body->condition[b->side[i]][d];

      for (PetscInt k = 0; c->type == ABUT_DISPLACEMENT && k <= b->order; ++k) {
        const PetscInt node = AbutBoundaryNode(b, i, k);

        if (is[2 * node + d]) continue;
        is[2 * node + d] = PETSC_TRUE;
        PetscCall(AbutExpressionEvaluate(c->value, b->x + 2 * node, &value[2 * node + d]));
      }
    }
  for (PetscInt i = 0; body->kinematics == ABUT_AXISYMMETRIC && i < b->nnodes; ++i) {
    if (!AbutBodyOnAxis_Private(body, b->x + 2 * i)) continue;
    is[2 * i]    = PETSC_TRUE;
    value[2 * i] = 0.;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The prescribed unknowns owned by this rank, found on the gathered boundary, so that a rank that owns a node without having its cell
   knows them too */
PetscErrorCode AbutBodyConditionsSetUp_Private(AbutBody body)
{
  const AbutMeshTopology *t;
  const PetscInt          all = 2 * body->boundary->nnodes;
  PetscInt               *row, n = 0;
  PetscReal              *value, *of;
  PetscScalar            *p;
  PetscBool              *is;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  PetscCall(PetscCalloc4(all, &row, all, &value, all, &of, all, &is));
  PetscCall(AbutBodyPrescribe_Private(body, is, of));
  for (PetscInt k = 0; k < all; ++k) {
    const PetscInt node = body->boundaryglobal[k / 2];

    if (!is[k] || node < t->firstowned || node >= t->firstowned + t->nowned) continue;
    row[n]     = 2 * node + k % 2;
    value[n++] = of[k];
  }
  PetscCall(PetscSortIntWithScalarArray(n, row, value));
  PetscCall(ISCreateGeneral(body->group, n, row, PETSC_COPY_VALUES, &body->constrained));
  PetscCall(VecCreateMPI(body->group, n, PETSC_DETERMINE, &body->prescribed));
  PetscCall(VecGetArrayWrite(body->prescribed, &p));
  for (PetscInt i = 0; i < n; ++i) p[i] = body->factor * value[i];
  PetscCall(VecRestoreArrayWrite(body->prescribed, &p));
  PetscCall(PetscFree4(row, value, of, is));
  PetscCall(AbutBodyLoad_Private(body, t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define ABUT_SAMPLES 32

/*@
   AbutBodyCheck - Ends the run if what is given on a side is not a finite number there, or a body with axial symmetry reaches beyond its
   axis; needs no mesh yet

   Collective

   Input Parameter:
.  body - the body, its box and its conditions set

   Level: developer

   Note:
   Looks at some points of each side. A traction may be infinite at an end. Whether anything holds the body is asked by
   `AbutInterfaceCheck()`.

.seealso: `AbutBodySetUp()`, `AbutPairCheck()`, `AbutInterfaceCheck()`
@*/
PetscErrorCode AbutBodyCheck(AbutBody body)
{
  PetscInt nsides;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  PetscCall(AbutBodyCheckKinematics_Private(body));
  PetscCall(AbutMeshGetSideCount(body->mesh, &nsides));
  for (PetscInt s = 0; s < nsides; ++s)
    for (PetscInt d = 0; d < 2; ++d) {
      const AbutCondition *c = &body->condition[s][d];
      const PetscReal     *segment;
      PetscInt             n, samples;
      PetscReal            value;

      if (!c->value) continue;
      PetscCall(AbutMeshGetSideSegments(body->mesh, s, &n, &segment));
      samples = PetscMax(2, ABUT_SAMPLES / n);
      for (PetscInt i = 0; i < n * samples; ++i) {
        const PetscReal *ends = segment + 4 * (i / samples);
        const PetscReal  z    = c->type == ABUT_DISPLACEMENT ? i % samples / (samples - 1.) : (i % samples + 0.5) / samples;
        const PetscReal  x[2] = {(1. - z) * ends[0] + z * ends[2], (1. - z) * ends[1] + z * ends[3]};

        PetscCall(AbutExpressionEvaluate(c->value, x, &value));
      }
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetFarSide - The side of a body that lies opposite to one with a given normal, and what is known there along that normal

   Not Collective

   Input Parameters:
+  body   - the body
-  normal - [2] outward unit normal

   Output Parameters:
+  side - number of the opposite side; -1 for a body from a file
-  type - traction, displacement or contact; of a body from a file displacement if it is prescribed on any side

   Level: developer

.seealso: `AbutBodyGetSupportDisplacement()`, `AbutBodyGetCondition()`
@*/
PetscErrorCode AbutBodyGetFarSide(AbutBody body, const PetscReal normal[2], PetscInt *side, AbutConditionType *type)
{
  const PetscInt d = PetscAbsReal(normal[0]) > PetscAbsReal(normal[1]) ? 0 : 1;

  const char *file;
  PetscInt    nsides;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetFile(body->mesh, &file));
  PetscCall(AbutMeshGetSideCount(body->mesh, &nsides));
  *side = file ? -1 : 2 * d + (normal[d] > 0. ? 0 : 1);
  *type = ABUT_TRACTION;
  for (PetscInt s = 0; s < nsides; ++s)
    if ((file || s == *side) && *type != ABUT_DISPLACEMENT) *type = body->condition[s][d].type;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetSupportDisplacement - The prescribed normal displacement on the far side of a body, opposite to a point: the base of a Winkler
   layer

   Not Collective

   Input Parameters:
+  body   - the body
.  x      - [2] point on one of its sides
-  normal - [2] outward unit normal there

   Output Parameters:
+  value - displacement of the far side along normal, length
-  found - `PETSC_FALSE` where it is not prescribed, and for a body from a file

   Level: developer

.seealso: `AbutPairComputeWinkler()`
@*/
PetscErrorCode AbutBodyGetSupportDisplacement(AbutBody body, const PetscReal x[2], const PetscReal normal[2], PetscReal *value,
                                              PetscBool *found)
{
  PetscReal         lower[2], upper[2], foot[2] = {x[0], x[1]};
  PetscInt          far, d;
  AbutConditionType type;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetFarSide(body, normal, &far, &type));
  d      = PetscMax(far, 0) / 2;
  *found = (PetscBool)(far >= 0 && type == ABUT_DISPLACEMENT);
  *value = 0.;
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutMeshGetBox(body->mesh, lower, upper));
  foot[d] = far % 2 ? upper[d] : lower[d];
  PetscCall(AbutExpressionEvaluate(body->condition[far][d].value, foot, value));
  *value *= body->factor * normal[d];
  PetscFunctionReturn(PETSC_SUCCESS);
}
