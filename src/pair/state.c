#include <abut/private/pairimpl.h> /*I "abutpair.h" I*/

/* In contact at an end of the part that both sides share (a symmetric half model): distance from that end; else half the distance of the
   two outermost edges */
static PetscReal AbutPairEdge_Private(AbutPair pair, const PetscReal g[], const PetscReal p[])
{
  PetscInt  first = -1, last = -1;
  PetscReal edge[2] = {pair->overlap[0], pair->overlap[1]};

  for (PetscInt i = 0; i < pair->n[pair->which]; ++i) {
    if (p[i] <= 0.) continue;
    if (first < 0) first = i;
    last = i;
  }
  if (first < 0) return 0.;
  for (PetscInt k = 0; k < 2; ++k) (void)AbutPairEdgeBeyond_Private(pair, g, p, k ? last : first, k ? 1 : -1, &edge[k]);
  return (edge[0] <= pair->overlap[0] || edge[1] >= pair->overlap[1] ? 1. : 0.5) * (edge[1] - edge[0]);
}

static PetscErrorCode AbutPairReadPressures_Private(AbutPair pair, const PetscReal p[], AbutPairState *state)
{
  const PetscInt n = pair->n[pair->which];
  PetscReal     *read;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &read));
  PetscCall(AbutPairGetReading_Private(pair, p, read));
  state->consistent = (PetscBool)(pair->order[0] > 1);
  for (PetscInt i = 0; i < n; ++i) {
    if (pair->D[i] <= 0.) continue;
    state->pressure_min = PetscMin(state->pressure_min, p[i]);
  }
  PetscCall(AbutPairGetLargest_Private(pair, read, &state->pressure_max));
  PetscCall(PetscFree(read));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The largest displacement, or gap where nothing moves */
static PetscReal AbutPairScale_Private(AbutPair pair, const PetscReal u1[], const PetscReal u2[])
{
  PetscReal largest = 0., gap = 0.;

  for (PetscInt i = 0; i < pair->components * pair->n[0]; ++i) largest = PetscMax(largest, PetscAbsReal(u1[i]));
  for (PetscInt i = 0; i < pair->components * pair->n[1]; ++i) largest = PetscMax(largest, PetscAbsReal(u2[i]));
  for (PetscInt i = 0; i < pair->n[pair->which]; ++i)
    if (pair->D[i] > 0.) gap = PetscMax(gap, PetscAbsReal(pair->F[i] / pair->D[i]));
  return largest > 0. ? largest : gap;
}

/* What the forces on the two sides leave, over the force; on vectors the normals are outward, and opposite */
static PetscErrorCode AbutPairBalance_Private(AbutPair pair, const PetscReal p[], AbutPairState *state)
{
  const PetscInt m = pair->components;
  PetscReal     *f[2],
    sum[2][2] =
      {
        {0., 0.},
        {0., 0.}
  },
    left = 0.;

  PetscFunctionBegin;
  state->balance = 0.;
  if (!pair->body[1] || state->force <= 0.) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(m * pair->n[0], &f[0], m * pair->n[1], &f[1]));
  PetscCall(AbutPairComputeForce(pair, p, f[0], f[1]));
  for (PetscInt s = 0; s < 2; ++s)
    for (PetscInt i = 0; i < m * pair->n[s]; ++i) sum[s][i % m] += f[s][i];
  PetscCall(PetscFree2(f[0], f[1]));
  for (PetscInt d = 0; d < m; ++d) left = PetscMax(left, PetscAbsReal(m == 1 ? sum[0][d] - sum[1][d] : sum[0][d] + sum[1][d]));
  state->balance = left / state->force;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPairGetState - Forces, contact zone and the residuals of the contact conditions (7)-(10) of the paper

   Not Collective

   Input Parameters:
+  pair - the pair, set up
.  u1   - [components*n1] displacements at the nodes of the first side, length
.  u2   - [components*n2] the same on the second side
-  p    - [nodes of the pressure side] the pressures that act, stress; with friction [2*nodes], the tangential tractions behind

   Output Parameter:
.  state - the state

   Level: intermediate

   Note:
   For the contact edge see `AbutPairGetEdges()`. The largest pressure is that of `AbutPairRecoverPressure()` on sides of order 2 and
   higher.

.seealso: `AbutPairComputePressure()`, `AbutPairGetEdges()`, `AbutInterfaceGetPairState()`
@*/
PetscErrorCode AbutPairGetState(AbutPair pair, const PetscReal u1[], const PetscReal u2[], const PetscReal p[], AbutPairState *state)
{
  PetscReal     *g = pair->work, compliance[2], largest = 0.; /* nodal pressure */
  const PetscInt n = pair->n[pair->which];

  PetscFunctionBegin;
  PetscCall(PetscMemzero(state, sizeof(*state)));
  PetscCall(AbutPairComputePenetration(pair, u1, u2, g));
  for (PetscInt i = 0; i < n; ++i) {
    if (pair->D[i] <= 0.) continue;
    ++state->nodes;
    largest = PetscMax(largest, p[i]);
    state->force += p[i] * pair->D[i];
    state->energy += 0.5 * pair->theta * p[i] * p[i] * pair->D[i];
    state->penetration_max = PetscMax(state->penetration_max, g[i]);
    state->complementarity = PetscMax(state->complementarity, p[i] * PetscAbsReal(p[i] * pair->theta - g[i]));
    state->excess          = PetscMax(state->excess, g[i] - p[i] * pair->theta);
    if (p[i] > 0.) {
      ++state->active;
      state->contact_length += pair->length[i];
    }
  }
  PetscCall(AbutPairReadPressures_Private(pair, p, state));
  PetscCall(AbutPairGetCompliance(pair, compliance));
  if (largest > 0.) {
    state->complementarity /= (compliance[0] + compliance[1] + pair->theta) * PetscSqr(largest);
    state->excess /= (compliance[0] + compliance[1] + pair->theta) * largest;
  } else if (state->excess > 0.) state->excess /= AbutPairScale_Private(pair, u1, u2); /* overlapping, and no force between them */
  if (pair->friction) PetscCall(AbutPairFrictionState_Private(pair, u1, u2, p, largest, state));
  state->contact_edge = AbutPairEdge_Private(pair, g, p);
  PetscCall(AbutPairBalance_Private(pair, p, state));
  PetscFunctionReturn(PETSC_SUCCESS);
}
