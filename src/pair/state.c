#include <abut/private/pairimpl.h> /*I "abutpair.h" I*/

/* Distance of a node from the first one along the (straight) side */
static PetscReal AbutPairPlace_Private(const AbutSide *m, PetscInt i)
{
  return PetscSqrtReal(PetscSqr(m->x[2 * i] - m->x[0]) + PetscSqr(m->x[2 * i + 1] - m->x[1]));
}

/* The edge beyond the last closed node, from the second to fourth open node on: there gap^(2/3) runs straight into the edge of an exact
   contact. At most an element away from the last closed node, which is itself the answer where there is no such line. */
static PetscReal AbutPairEdgeOfGap_Private(AbutPair pair, const PetscReal g[], PetscInt in, PetscInt step)
{
  const AbutSide *m    = pair->nodes[pair->which];
  const PetscReal last = AbutPairPlace_Private(m, in), h = PetscAbsReal(AbutPairPlace_Private(m, in + step) - last);
  PetscReal       s[3], y[3], ms = 0., my = 0., sy = 0., ss = 0., edge;

  for (PetscInt k = 0; k < 3; ++k) {
    const PetscInt node = in + (k + 2) * step;

    if (node < 0 || node >= m->n || pair->D[node] <= 0. || g[node] >= 0.) return last;
    s[k] = AbutPairPlace_Private(m, node);
    y[k] = PetscPowReal(-g[node], 2. / 3.);
    ms += s[k] / 3.;
    my += y[k] / 3.;
  }
  for (PetscInt k = 0; k < 3; ++k) {
    sy += (s[k] - ms) * (y[k] - my);
    ss += (s[k] - ms) * (s[k] - ms);
  }
  edge = sy != 0. ? ms - my * ss / sy : last;
  return PetscMin(PetscMax(edge, last - h), last + h);
}

/* Where the penetration changes sign, or in exact contact where the gap opens. In contact at an end of the part that both sides share (a
   symmetric half model): distance from that end; else half the distance of the two edges. Beyond the last node that may carry a pressure
   the contact reaches the end of the shared part. */
static PetscReal AbutPairEdge_Private(AbutPair pair, const PetscReal g[], const PetscReal p[])
{
  const AbutSide *m     = pair->nodes[pair->which];
  PetscInt        first = -1, last = -1;
  PetscReal       edge[2];

  for (PetscInt i = 0; i < m->n; ++i) {
    if (p[i] <= 0.) continue;
    if (first < 0) first = i;
    last = i;
  }
  if (first < 0) return 0.;
  for (PetscInt k = 0; k < 2; ++k) {
    const PetscInt in = k ? last : first, out = k ? last + 1 : first - 1;

    edge[k] = pair->overlap[k];
    if (out < 0 || out >= m->n || pair->D[out] <= 0.) continue;
    edge[k] = pair->theta > 0. ? AbutPairPlace_Private(m, in) : AbutPairEdgeOfGap_Private(pair, g, in, out - in);
    if (pair->theta > 0. && g[in] > 0. && g[out] < 0.) edge[k] += (AbutPairPlace_Private(m, out) - edge[k]) * g[in] / (g[in] - g[out]);
  }
  return (edge[0] <= pair->overlap[0] || edge[1] >= pair->overlap[1] ? 1. : 0.5) * (edge[1] - edge[0]);
}

static PetscErrorCode AbutPairReadPressures_Private(AbutPair pair, const PetscReal p[], AbutPairState *state)
{
  const PetscInt   n    = pair->n[pair->which];
  const PetscReal *read = p;
  PetscReal       *consistent;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &consistent));
  if (pair->order[0] > 1) {
    PetscCall(AbutPairRecoverPressure(pair, p, consistent));
    read = consistent;
  }
  for (PetscInt i = 0; i < n; ++i) {
    state->pressure_max = PetscMax(state->pressure_max, read[i]);
    state->pressure_min = PetscMin(state->pressure_min, p[i]);
  }
  PetscCall(PetscFree(consistent));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPairGetState - Forces, contact zone and the residuals of the contact conditions (7)-(10) of the paper

   Not Collective

   Input Parameters:
+  pair - the pair, set up
.  u1   - [n1] normal displacements at the nodes of the first side, length
.  u2   - [n2] the same on the second side
-  p    - [nodes of the pressure side] the pressures that act, stress

   Output Parameter:
.  state - the state

   Level: intermediate

   Note:
   The contact edge is where the penetration changes sign (theta > 0); in exact contact, where the straight line through gap^(2/3) at the
   second to fourth open node meets zero. The largest pressure is that of `AbutPairRecoverPressure()` on sides of order 2 and higher.

.seealso: `AbutPairComputePressure()`, `AbutInterfaceGetPairState()`
@*/
PetscErrorCode AbutPairGetState(AbutPair pair, const PetscReal u1[], const PetscReal u2[], const PetscReal p[], AbutPairState *state)
{
  PetscReal     *g = pair->work, *f[2], sum[2] = {0., 0.}, compliance[2];
  const PetscInt n = pair->n[pair->which];

  PetscFunctionBegin;
  PetscCall(PetscMemzero(state, sizeof(*state)));
  PetscCall(AbutPairComputePenetration(pair, u1, u2, g));
  for (PetscInt i = 0; i < n; ++i) {
    if (pair->D[i] <= 0.) continue;
    ++state->nodes;
    state->force += p[i] * pair->D[i];
    state->energy += 0.5 * pair->theta * p[i] * p[i] * pair->D[i];
    state->penetration_max = PetscMax(state->penetration_max, g[i]);
    state->complementarity = PetscMax(state->complementarity, p[i] * PetscAbsReal(p[i] * pair->theta - g[i]));
    if (p[i] > 0.) {
      ++state->active;
      state->contact_length += pair->D[i];
    }
  }
  PetscCall(AbutPairReadPressures_Private(pair, p, state));
  PetscCall(AbutPairGetCompliance(pair, compliance));
  if (state->pressure_max > 0.) state->complementarity /= (compliance[0] + compliance[1] + pair->theta) * PetscSqr(state->pressure_max);
  state->contact_edge = AbutPairEdge_Private(pair, g, p);
  PetscCall(PetscMalloc2(pair->n[0], &f[0], pair->n[1], &f[1]));
  PetscCall(AbutPairComputeForce(pair, p, f[0], f[1]));
  for (PetscInt s = 0; s < 2; ++s)
    for (PetscInt i = 0; i < pair->n[s]; ++i) sum[s] += f[s][i];
  PetscCall(PetscFree2(f[0], f[1]));
  state->balance = state->force > 0. ? PetscAbsReal(sum[0] - sum[1]) / state->force : 0.;
  PetscFunctionReturn(PETSC_SUCCESS);
}
