#include <abut/private/pairimpl.h> /*I "abutpair.h" I*/

/* Coulomb friction of a pair: slips and tangential tractions at the nodes that carry pressures, by the same dual functions. Where the pair
   has none, nothing of this is made or called, and traces of straight sides are normal displacements. */

static PetscLogEvent ABUTPAIR_Friction;

/* What component d of node k on side s, in segment g, adds to the slip of node i of the pressure side: along the normal turned, which runs
   along the side with its body on the left */
static inline PetscReal AbutSegmentSlip_Private(AbutPair pair, PetscInt g, PetscInt s, PetscInt d, PetscInt i, PetscInt k)
{
  return d ? pair->vector[g][s][0][i][k] : -pair->vector[g][s][1][i][k];
}

PetscErrorCode AbutPairFrictionFromOptions_Private(AbutPair pair)
{
  PetscReal mu = 0.;
  PetscBool given;

  PetscFunctionBegin;
  PetscObjectOptionsBegin((PetscObject)pair);
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-pair_friction", "Coefficient of Coulomb friction", &mu, &given));
  PetscOptionsEnd();
  AbutCheckInput(!given || mu >= 0., PetscObjectComm((PetscObject)pair),
                 "%s_pair_friction: %g; give a coefficient of friction, 0 or more, for example 0.3", ((PetscObject)pair)->name, (double)mu);
  if (!given) PetscFunctionReturn(PETSC_SUCCESS);
  if (!ABUTPAIR_Friction) PetscCall(PetscLogEventRegister("AbutPairFriction", ABUTPAIR_CLASSID, &ABUTPAIR_Friction));
  PetscCall(PetscNew(&pair->friction));
  pair->friction->mu = mu;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutPairFrictionDestroy_Private(AbutPair pair)
{
  PetscFunctionBegin;
  if (!pair->friction) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree2(pair->friction->x, pair->friction->kept));
  PetscCall(PetscFree(pair->friction->reference));
  PetscCall(PetscFree(pair->friction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutPairGetFriction - Whether a pair has Coulomb friction, and its coefficient

   Not Collective

   Input Parameter:
.  pair - the pair

   Output Parameters:
+  friction - whether `-NAME_pair_friction` is given
-  mu       - the coefficient, 0 without friction, or `NULL`

   Level: intermediate

   Note:
   With friction, arrays of pressures have two parts of equal length: the pressures and, behind them, the tangential tractions. Traces then
   have two components.

.seealso: `AbutPairComputeSlip()`, `AbutPairComputePressure()`, `AbutPairGetComponents()`
@*/
PetscErrorCode AbutPairGetFriction(AbutPair pair, PetscBool *friction, PetscReal *mu)
{
  PetscFunctionBegin;
  *friction = (PetscBool)(pair->friction != NULL);
  if (mu) *mu = pair->friction ? pair->friction->mu : 0.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutPairGetShearCompliance - H 2(1+nu)/E of the two bodies: how much a layer of a body's height gives under a unit tangential traction

   Not Collective

   Input Parameter:
.  pair - the pair

   Output Parameter:
.  compliance - [2] length/stress; 0 for a rigid obstacle

   Level: developer

   Note:
   Of a layer whose far side is held along it.

.seealso: `AbutPairGetCompliance()`
@*/
PetscErrorCode AbutPairGetShearCompliance(AbutPair pair, PetscReal compliance[2])
{
  PetscFunctionBegin;
  PetscCall(AbutPairGetCompliance(pair, compliance));
  for (PetscInt s = 0; s < 2 && pair->body[s]; ++s) {
    PetscReal young, poisson;

    PetscCall(AbutBodyGetPlaneMaterial(pair->body[s], &young, &poisson));
    compliance[s] *= 2. / (1. - poisson);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPairComputeSlip - Averaged nodal slips: (u_1 - u_2).tau tested with the dual functions, over their integrals, less the slips that
   were kept

   Not Collective

   Input Parameters:
+  pair - the pair, set up, with friction
.  u1   - [2*n1] displacements at the nodes of the first side, length
-  u2   - [2*n2] the same on the second side

   Output Parameter:
.  s - [nodes of the pressure side] slips of the first side on the second, along the tangent tau of the first, which has its body on the
       left, length; 0 at nodes that carry no pressure

   Level: intermediate

.seealso: `AbutPairComputePenetration()`, `AbutPairKeepSlip()`, `AbutPairGetFriction()`
@*/
PetscErrorCode AbutPairComputeSlip(AbutPair pair, const PetscReal u1[], const PetscReal u2[], PetscReal s[])
{
  const PetscReal *trace[2] = {pair->which ? u2 : u1, pair->which ? u1 : u2};
  const PetscInt   n        = pair->n[pair->which];

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(ABUTPAIR_Friction, pair, 0, 0, 0));
  PetscCall(PetscArrayzero(s, n));
  for (PetscInt k = 0; k < pair->nsegments; ++k) {
    const AbutSegment *seg = &pair->segment[k];

    for (PetscInt i = 0; i <= pair->order[0]; ++i)
      for (PetscInt side = 0; side < 2; ++side)
        for (PetscInt j = 0; j <= pair->order[side]; ++j)
          for (PetscInt d = 0; d < 2; ++d)
            s[pair->order[0] * seg->element[0] + i] += AbutSegmentSlip_Private(pair, k, side, d, i, j) *
                                                       trace[side][2 * (pair->order[side] * seg->element[side] + j) + d];
  }
  for (PetscInt i = 0; i < n; ++i) s[i] = pair->D[i] > 0. ? s[i] / pair->D[i] - pair->friction->reference[i] : 0.;
  PetscCall(PetscLogEventEnd(ABUTPAIR_Friction, pair, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The tangential tractions of the penalty law behind the pressures p: s/theta, at most mu p */
PetscErrorCode AbutPairFrictionLaw_Private(AbutPair pair, const PetscReal u1[], const PetscReal u2[], PetscReal p[])
{
  const PetscInt n = pair->n[pair->which];

  PetscFunctionBegin;
  PetscCall(AbutPairComputeSlip(pair, u1, u2, p + n));
  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal most = pair->friction->mu * p[i];

    p[n + i] = PetscMax(-most, PetscMin(most, p[n + i] / pair->theta));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the nodal forces of tangential tractions t, of the pressure side and of the other one, against the direction in which they act */
PetscErrorCode AbutPairFrictionForce_Private(AbutPair pair, const PetscReal t[], PetscReal *const force[2])
{
  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(ABUTPAIR_Friction, pair, 0, 0, 0));
  for (PetscInt k = 0; k < pair->nsegments; ++k) {
    const AbutSegment *seg = &pair->segment[k];

    for (PetscInt i = 0; i <= pair->order[0]; ++i)
      for (PetscInt side = 0; side < 2; ++side)
        for (PetscInt j = 0; j <= pair->order[side]; ++j)
          for (PetscInt d = 0; d < 2; ++d)
            force[side][2 * (pair->order[side] * seg->element[side] + j) + d] += AbutSegmentSlip_Private(pair, k, side, d, i, j) *
                                                                                 t[pair->order[0] * seg->element[0] + i];
  }
  PetscCall(PetscLogEventEnd(ABUTPAIR_Friction, pair, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPairKeepSlip - The present slips become those from which slip is counted: the end of a load step

   Not Collective

   Input Parameters:
+  pair - the pair, set up, with friction
.  u1   - [2*n1] displacements at the nodes of the first side, length
.  u2   - [2*n2] the same on the second side
-  p    - [2*nodes of the pressure side] pressures and tangential tractions that act, stress

   Level: developer

   Notes:
   Of what slips elastically under a penalty, theta times the traction is not kept: the traction goes on from what it is.

   They are kept with the places of their nodes, and evaluated linearly on adapted meshes.

.seealso: `AbutPairComputeSlip()`, `AbutInterfaceKeepSlip()`
@*/
PetscErrorCode AbutPairKeepSlip(AbutPair pair, const PetscReal u1[], const PetscReal u2[], const PetscReal p[])
{
  AbutFriction    friction = pair->friction;
  const AbutSide *side     = pair->nodes[pair->which];
  PetscReal      *s;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(side->n, &s));
  PetscCall(AbutPairComputeSlip(pair, u1, u2, s));
  PetscCall(PetscFree2(friction->x, friction->kept));
  PetscCall(PetscMalloc2(2 * side->n, &friction->x, side->n, &friction->kept));
  friction->n = side->n;
  for (PetscInt i = 0; i < side->n; ++i) {
    const PetscInt to = pair->which ? side->n - 1 - i : i; /* the pressures may change sides: always along the first one */

    friction->reference[i] += s[i] - pair->theta * p[side->n + i];
    friction->kept[to] = friction->reference[i];
    PetscCall(PetscArraycpy(friction->x + 2 * to, side->x + 2 * i, 2));
  }
  PetscCall(PetscFree(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where a point lies between kept nodes x[2*n] along a side: in [0,1] of the element from node *element on, which only goes forward, for
   node lists that run in the same direction are walked once */
PetscReal AbutPairWalkTo_Private(PetscInt n, const PetscReal x[], const PetscReal at[2], PetscInt *element)
{
  PetscReal t;

  for (;; ++*element) {
    const PetscReal *a = x + 2 * *element, d[2] = {a[2] - a[0], a[3] - a[1]};

    t = ((at[0] - a[0]) * d[0] + (at[1] - a[1]) * d[1]) / (d[0] * d[0] + d[1] * d[1]);
    if (t <= 1. || *element + 2 >= n) break;
  }
  return PetscMin(1., PetscMax(0., t));
}

/* The kept slips at the nodes of the present meshes */
PetscErrorCode AbutPairFrictionSetUp_Private(AbutPair pair)
{
  AbutFriction    friction = pair->friction;
  const AbutSide *side     = pair->nodes[pair->which];
  PetscInt        e        = 0;

  PetscFunctionBegin;
  PetscCall(PetscFree(friction->reference));
  PetscCall(PetscCalloc1(side->n, &friction->reference));
  for (PetscInt i = 0; friction->n > 1 && i < side->n; ++i) {
    const PetscInt  node = pair->which ? side->n - 1 - i : i;
    const PetscReal t    = AbutPairWalkTo_Private(friction->n, friction->x, side->x + 2 * node, &e);

    friction->reference[node] = (1. - t) * friction->kept[e] + t * friction->kept[e + 1];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutPairArchiveSlip - The kept slips into an archive, or out of one

   Collective

   Input Parameters:
+  pair - the pair, with friction, not set up on the meshes of the archive yet
-  ar   - the archive

   Level: developer

.seealso: `AbutPairKeepSlip()`, `AbutInterfaceArchive()`
@*/
PetscErrorCode AbutPairArchiveSlip(AbutPair pair, AbutArchive ar)
{
  AbutFriction friction = pair->friction;
  PetscBool    reads;

  PetscFunctionBegin;
  PetscCall(AbutArchiveReads(ar, &reads));
  PetscCall(AbutArchiveCount(ar, "nodes of kept slips", &friction->n));
  if (reads) {
    PetscCall(PetscFree2(friction->x, friction->kept));
    PetscCall(PetscMalloc2(2 * friction->n, &friction->x, friction->n, &friction->kept));
  }
  PetscCall(AbutArchiveReals(ar, "places of kept slips", 2 * friction->n, friction->x));
  PetscCall(AbutArchiveReals(ar, "kept slips", friction->n, friction->kept));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define ABUT_STICKS 1e-6 /* of mu p: nearer to it a node slips; exact contact leaves round-off there */

/* What friction adds to the state of a pair: p has the pressures, and the tangential tractions behind them */
PetscErrorCode AbutPairFrictionState_Private(AbutPair pair, const PetscReal u1[], const PetscReal u2[], const PetscReal p[],
                                             PetscReal largest, AbutPairState *state)
{
  const PetscInt n = pair->n[pair->which];
  PetscReal     *s, compliance[2], misfit = 0.;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &s));
  PetscCall(AbutPairComputeSlip(pair, u1, u2, s));
  PetscCall(AbutPairGetShearCompliance(pair, compliance));
  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal t = p[n + i], most = pair->friction->mu * p[i], slip = s[i] - pair->theta * t;

    if (pair->D[i] <= 0.) continue;
    state->tangential += t * pair->D[i];
    state->energy += 0.5 * pair->theta * t * t * pair->D[i];
    if (p[i] <= 0.) continue;
    state->slip_max = PetscMax(state->slip_max, PetscAbsReal(s[i]));
    if (PetscAbsReal(t) < (1. - ABUT_STICKS) * most) state->stick_length += pair->length[i];
    misfit          = PetscMax(misfit, PetscMax(PetscAbsReal(slip) * PetscMin(largest, most - PetscAbsReal(t)), -slip * t));
    state->friction = PetscMax(state->friction, (PetscAbsReal(t) - most) / largest);
  }
  if (largest > 0.)
    state->friction = PetscMax(state->friction, misfit / ((compliance[0] + compliance[1] + pair->theta) * PetscSqr(largest)));
  PetscCall(PetscFree(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
