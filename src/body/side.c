#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/

/* One side of a body as an ordered list of nodes, cut out of the gathered boundary */

/* First boundary element of a side, and how many follow it; a side is one piece */
static PetscErrorCode AbutSideRange_Private(AbutBody body, PetscInt side, PetscInt *first, PetscInt *n)
{
  const AbutBoundary *b = body->boundary;

  PetscFunctionBegin;
  *first = -1;
  *n     = 0;
  for (PetscInt i = 0; i < b->n; ++i) {
    if (b->side[i] != side) continue;
    if (*first < 0) *first = i; /* a contour begins where one side ends and the next begins */
    ++*n;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is the displacement along a normal prescribed on these two elements together? */
static PetscBool AbutNodeIsFixed_Private(AbutBody body, PetscInt before, PetscInt behind, const PetscReal normal[2])
{
  const PetscInt side[2] = {body->boundary->side[before], body->boundary->side[behind]};
  PetscBool      u[2]    = {PETSC_FALSE, PETSC_FALSE};

  for (PetscInt k = 0; k < 4; ++k)
    if (body->condition[side[k / 2]][k % 2].type == ABUT_DISPLACEMENT) u[k % 2] = PETSC_TRUE;
  return (PetscBool)((u[0] || PetscAbsReal(normal[0]) < 1e-12) && (u[1] || PetscAbsReal(normal[1]) < 1e-12));
}

/* The outward unit normal of a boundary element from p to q, and its length */
PetscReal AbutElementNormal_Private(const PetscReal p[2], const PetscReal q[2], PetscReal normal[2])
{
  const PetscReal length = PetscSqrtReal(PetscSqr(q[0] - p[0]) + PetscSqr(q[1] - p[1]));

  normal[0] = (q[1] - p[1]) / length;
  normal[1] = (p[0] - q[0]) / length;
  return length;
}

static void AbutSideNormals_Private(AbutSide *s)
{
  for (PetscInt i = 0; i + 1 < s->n; i += s->order)
    (void)AbutElementNormal_Private(s->x + 2 * i, s->x + 2 * (i + s->order), s->normal + 2 * (i / s->order));
  s->straight = PETSC_TRUE;
  for (PetscInt e = 1; e < (s->n - 1) / s->order; ++e)
    for (PetscInt d = 0; d < 2; ++d)
      if (PetscAbsReal(s->normal[2 * e + d] - s->normal[d]) > 1e-9) s->straight = PETSC_FALSE;
}

/*@C
   AbutBodyGetSide - The nodes of a side, in order, with the body on the left; the same on all ranks

   Collective on first use

   Input Parameters:
+  body - the body, set up
-  side - number of the side

   Output Parameter:
.  s - its nodes and normals, owned by the body, valid until its mesh adapts

   Level: intermediate

.seealso: `AbutBodyGetSideTrace()`, `AbutBodyAddSideForce()`
@*/
PetscErrorCode AbutBodyGetSide(AbutBody body, PetscInt side, const AbutSide **s)
{
  AbutSide           *out = &body->side[side];
  const AbutBoundary *b   = body->boundary;
  const PetscInt      p   = b->order;
  PetscInt            first, n, previous = -1;

  PetscFunctionBegin;
  *s = out;
  if (out->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutSideRange_Private(body, side, &first, &n));
  PetscCheck(n > 0, PetscObjectComm((PetscObject)body), PETSC_ERR_PLIB, "Side %" PetscInt_FMT " has no element", side);
  out->order = p;
  out->n     = p * n + 1;
  PetscCall(PetscMalloc4(2 * out->n, &out->x, 2 * n, &out->normal, out->n, &out->global, out->n, &out->fixed));
  for (PetscInt i = 0; i < out->n; ++i) {
    const PetscInt node = i < p * n ? p * first + i : AbutBoundaryNode(b, first + n - 1, p);

    out->global[i] = body->boundaryglobal[node];
    for (PetscInt d = 0; d < 2; ++d) out->x[2 * i + d] = b->x[2 * node + d];
  }
  AbutSideNormals_Private(out);
  for (PetscInt i = 0; i < b->n; ++i)
    if (b->next[i] == first) previous = i;
  for (PetscInt i = 0; i < out->n; ++i) {
    const PetscInt k = i / p; /* element behind the node, the one before it is another only at its start */

    out->fixed[i] = AbutNodeIsFixed_Private(body, i == 0 ? previous : first + PetscMin(i % p ? k : k - 1, n - 1),
                                            k < n ? first + k : b->next[first + n - 1], out->normal + 2 * PetscMin(k, n - 1));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutSideGetNodeNormal - The unit normal at a node of a side: the direction of the sum of the normals of the elements that meet there

   Not Collective

   Input Parameters:
+  s - the side
-  i - number of the node

   Output Parameter:
.  n - [2] outward unit normal

   Level: developer

.seealso: `AbutBodyGetSide()`
@*/
PetscErrorCode AbutSideGetNodeNormal(const AbutSide *s, PetscInt i, PetscReal n[2])
{
  const PetscInt   behind = PetscMin(i, s->n - 2) / s->order, before = PetscMax(i - 1, 0) / s->order;
  const PetscReal *p = s->normal + 2 * before, *q = s->normal + 2 * behind;
  const PetscReal  m[2] = {p[0] + q[0], p[1] + q[1]}, h = PetscSqrtReal(m[0] * m[0] + m[1] * m[1]);

  PetscFunctionBegin;
  n[0] = m[0] / h;
  n[1] = m[1] / h;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyGetSideTrace - The trace of a displacement on a side

   Collective

   Input Parameters:
+  body       - the body
.  side       - number of the side
.  components - 1 for the normal displacement, 2 for both components
-  u          - displacement, of the layout of `AbutBodyCreateVec()`

   Output Parameter:
.  trace - [components*n] at the nodes of the side, length: along the outward normal, or (u1, u2); the same on all ranks

   Level: developer

.seealso: `AbutBodyGetSide()`, `AbutBodyAddSideForce()`
@*/
PetscErrorCode AbutBodyGetSideTrace(AbutBody body, PetscInt side, PetscInt components, Vec u, PetscReal trace[])
{
  const AbutSide  *s;
  const PetscReal *value;
  PetscInt         first, n;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetSide(body, side, &s));
  PetscCall(AbutSideRange_Private(body, side, &first, &n));
  PetscCall(AbutBodyGatherBoundary_Private(body, u, &value));
  for (PetscInt i = 0; i < s->n; ++i) {
    const PetscInt node = i + 1 < s->n ? s->order * first + i : AbutBoundaryNode(body->boundary, first + n - 1, s->order);
    PetscReal      normal[2];

    for (PetscInt d = 0; components == 2 && d < 2; ++d) trace[2 * i + d] = value[2 * node + d];
    if (components == 2) continue;
    PetscCall(AbutSideGetNodeNormal(s, i, normal));
    trace[i] = normal[0] * value[2 * node] + normal[1] * value[2 * node + 1];
  }
  PetscCall(AbutBodyUngatherBoundary_Private(body, &value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyAddSideForce - Adds nodal forces on a side to a vector of nodal forces

   Collective

   Input Parameters:
+  body       - the body
.  side       - number of the side
.  components - 1 for forces along the outward normal, 2 for both components
.  force      - [components*n] forces at the nodes of the side, stress times length; the same on all ranks
-  f          - vector of the layout of `AbutBodyCreateVec()`

   Level: developer

.seealso: `AbutBodyGetSideTrace()`, `AbutBodySolve()`
@*/
PetscErrorCode AbutBodyAddSideForce(AbutBody body, PetscInt side, PetscInt components, const PetscReal force[], Vec f)
{
  const AbutSide *s;
  PetscInt        low, high;
  PetscScalar    *a;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetSide(body, side, &s));
  PetscCall(VecGetOwnershipRange(f, &low, &high));
  PetscCall(VecGetArray(f, &a));
  for (PetscInt i = 0; i < s->n; ++i) {
    PetscReal normal[2];

    if (2 * s->global[i] < low || 2 * s->global[i] >= high) continue;
    PetscCall(AbutSideGetNodeNormal(s, i, normal));
    for (PetscInt d = 0; d < 2; ++d) a[2 * s->global[i] + d - low] += components == 2 ? force[2 * i + d] : force[i] * normal[d];
  }
  PetscCall(VecRestoreArray(f, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}
