#include <abut/private/pairimpl.h> /*I "abutpair.h" I*/
#include <petscdt.h>

/* Dual-mortar weights on the common refinement of the two sides. One-sided quadrature would fail the contact patch test by some per
   cent. */

#define ABUT_STIFFER 1.5

/* Nodes whose normal displacement is prescribed carry no pressure: on such a side none would */
static PetscBool AbutSideCarries_Private(const AbutSide *s)
{
  for (PetscInt i = 0; i < s->n; ++i)
    if (!s->fixed[i]) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The side with more elements on the common part carries the pressures, of equally many that of the lower order, then the first; but never
   that of the clearly stiffer body. Pressures that only a stiff body resolves are held by its small compliance alone, and those that only
   one side resolves are rough: both oscillate. */
static PetscErrorCode AbutPairChoosePressureSide_Private(AbutPair pair)
{
  PetscInt  count[2] = {0, 0};
  PetscReal young[2], poisson[2], modulus[2];

  PetscFunctionBegin;
  pair->which = pair->pressureside == ABUT_PRESSURE_SECOND;
  if (!pair->body[1]) pair->which = 0;
  if (!pair->body[1] || pair->pressureside != ABUT_PRESSURE_FINER) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < 2; ++k) {
    const AbutSide *own = pair->nodes[k], *other = pair->nodes[!k];
    PetscReal       box[4] = {PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MIN_REAL, PETSC_MIN_REAL};
    const PetscInt  d = PetscAbsReal(own->normal[0]) > PetscAbsReal(own->normal[1]) ? 1 : 0; /* the coordinate that runs along the side */

    for (PetscInt i = 0; i < other->n; ++i) {
      box[d]     = PetscMin(box[d], other->x[2 * i + d]);
      box[2 + d] = PetscMax(box[2 + d], other->x[2 * i + d]);
    }
    for (PetscInt i = 0; i < own->n; i += own->order)
      if (own->x[2 * i + d] >= box[d] && own->x[2 * i + d] <= box[2 + d]) ++count[k];
  }
  pair->which = count[1] > count[0] || (count[1] == count[0] && pair->nodes[1]->order < pair->nodes[0]->order);
  for (PetscInt s = 0; s < 2; ++s) {
    PetscCall(AbutBodyGetPlaneMaterial(pair->body[s], &young[s], &poisson[s]));
    modulus[s] = young[s] / (1. - poisson[s] * poisson[s]);
  }
  if (modulus[pair->which] > ABUT_STIFFER * modulus[!pair->which]) pair->which = !pair->which;
  if (!AbutSideCarries_Private(pair->nodes[pair->which])) pair->which = !pair->which;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* psi_i = sum_j A[i][j] phi_j on an element of the pressure side */
typedef PetscReal AbutDual[ABUT_SIDE_NODES_MAX][ABUT_SIDE_NODES_MAX];

/* The dual functions of one element of order 1 on its overlap with the other side, biorthogonal there: A = diag(D) M^-1; z[j] holds the hat
   function phi_j at the two ends of the overlap, of length f. Beside a node that carries no pressure the other node's function is 1, so
   that constants stay in the space. On a small overlap the dual functions are wild: the largest eigenvalue of D M^-1 is det D/det M, 3 on a
   full element; beyond 100 the nearer node carries alone. */
static void AbutPairDualLinear_Private(const PetscReal z[2][2], const PetscBool carries[2], AbutDual A)
{
  const PetscReal sum[2] = {z[0][0] + z[0][1], z[1][0] + z[1][1]}, f2 = PetscSqr(z[1][1] - z[1][0]); /* D_i = f sum_i/2, det M = f^4/12 */
  const PetscReal cross = 2. * (z[0][0] * z[1][0] + z[0][1] * z[1][1]) + z[0][0] * z[1][1] + z[0][1] * z[1][0];
  const PetscBool both = (PetscBool)(carries[0] && carries[1]), small = (PetscBool)(3. * sum[0] * sum[1] > 100. * f2);

  for (PetscInt i = 0; i < 2; ++i) {
    const PetscInt  k  = !i;
    const PetscBool in = (PetscBool)(carries[i] && !(both && small && (i ? sum[1] <= sum[0] : sum[0] < sum[1])));

    A[i][0] = A[i][1] = in ? 1. : 0.;
    if (!both || small) continue;
    A[i][i] = 2. * sum[i] * (z[k][0] * z[k][0] + z[k][0] * z[k][1] + z[k][1] * z[k][1]) / f2;
    A[i][k] = -sum[i] * cross / f2;
  }
}

/* Those of a whole element: D_i are its Gauss-Lobatto weights, all positive, and the functions reproduce pressures of one order less */
static PetscErrorCode AbutPairDual_Private(PetscInt order, AbutDual A)
{
  PetscReal x[ABUT_SIDE_NODES_MAX], w[ABUT_SIDE_NODES_MAX], inverse[ABUT_SIDE_NODES_MAX * ABUT_SIDE_NODES_MAX];

  PetscFunctionBegin;
  PetscCall(AbutGetLobattoNodes(order, x, w));
  PetscCall(AbutGetLobattoMassInverse(order, inverse));
  for (PetscInt i = 0; i <= order; ++i)
    for (PetscInt j = 0; j <= order; ++j) A[i][j] = w[i] * inverse[(order + 1) * i + j];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The same for bodies of revolution, whose integrals weigh the circumference: psi_i = D_i (M^-1 phi)_i with the weighted mass matrix M and
   D_i the integral of phi_i, which is positive but on the axis from order 2 on, where it is 0 */
static PetscErrorCode AbutPairDualAxial_Private(AbutPair pair, PetscInt e, AbutDual A)
{
  const PetscInt   p = pair->order[0], n = p + 1;
  const PetscReal *s = pair->place[0] + p * e;
  PetscReal        z[ABUT_ORDER_MAX + 2], w[ABUT_ORDER_MAX + 2], N[ABUT_SIDE_NODES_MAX], D[ABUT_SIDE_NODES_MAX] = {0.}, x[2], t, total = 0.;
  PetscReal        M[ABUT_SIDE_NODES_MAX * ABUT_SIDE_NODES_MAX] = {0.}, inverse[ABUT_SIDE_NODES_MAX * ABUT_SIDE_NODES_MAX] = {0.};

  PetscFunctionBegin;
  PetscCall(PetscDTGaussQuadrature(p + 2, s[0], s[p], z, w));
  for (PetscInt q = 0; q < p + 2; ++q) {
    AbutPairPointAt_Private(pair, z[q], x);
    PetscCall(AbutBodyGetThickness(pair->body[pair->which], x, &t));
    PetscCall(AbutEvaluateLobatto(p, (2. * z[q] - s[0] - s[p]) / (s[p] - s[0]), N, NULL));
    total += w[q] * t;
    for (PetscInt i = 0; i < n; ++i) {
      D[i] += w[q] * t * N[i];
      for (PetscInt j = 0; j <= i; ++j) M[n * j + i - j] += w[q] * t * N[i] * N[j]; /* the lower band of AbutSolveBand() */
    }
  }
  for (PetscInt i = 0; i < n; ++i) inverse[n * i + i] = 1.;
  PetscCall(AbutSolveBand(n, p, M, n, inverse));
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = 0; j < n; ++j) A[i][j] = D[i] > 1e-12 * total ? D[i] * inverse[n * i + j] : 0.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Integrals over one piece [from,to] of the elements e of the pressure side and k of the other */
static PetscErrorCode AbutPairSegment_Private(AbutPair pair, PetscInt e, PetscInt k, AbutDual A, PetscReal from, PetscReal to)
{
  const PetscInt n = pair->order[0] + PetscMax(pair->order[1], 0) + 2, first = pair->order[0] * e;
  PetscReal    z[2 * ABUT_ORDER_MAX + 2], w[2 * ABUT_ORDER_MAX + 2], phi[2][ABUT_SIDE_NODES_MAX], at[2], x[2], normal[2], f, thickness = 1.;
  AbutSegment *g;

  PetscFunctionBegin;
  if (pair->nsegments == pair->room) {
    pair->room = 2 * pair->room + 16;
    PetscCall(PetscRealloc(pair->room * sizeof(*pair->segment), &pair->segment));
    if (pair->components > 1) PetscCall(PetscRealloc(pair->room * sizeof(*pair->vector), &pair->vector));
  }
  g = &pair->segment[pair->nsegments++];
  PetscCall(PetscMemzero(g, sizeof(*g)));
  if (pair->vector) PetscCall(PetscMemzero(pair->vector[pair->nsegments - 1], sizeof(*pair->vector)));
  g->element[0] = e;
  g->element[1] = k;
  PetscCall(PetscDTGaussQuadrature(n, from, to, z, w));
  for (PetscInt q = 0; q < n; ++q) {
    PetscCall(AbutPairFace_Private(pair, g->element, z[q], at, normal, &f));
    for (PetscInt side = 0; side < 2 && pair->order[side] > 0; ++side)
      PetscCall(AbutEvaluateLobatto(pair->order[side], at[side], phi[side], NULL));
    if (pair->axial) {
      AbutPairPointAt_Private(pair, z[q], x);
      PetscCall(AbutBodyGetThickness(pair->body[pair->which], x, &thickness));
    }
    for (PetscInt i = 0; i <= pair->order[0]; ++i) {
      PetscReal psi = 0.;

      for (PetscInt j = 0; j <= pair->order[0]; ++j) psi += w[q] * A[i][j] * phi[0][j];
      if (pair->axial) {
        pair->length[first + i] += psi;
        psi *= thickness;
      }
      pair->D[first + i] += psi;
      pair->F[first + i] += psi * f;
      for (PetscInt side = 0; side < 2; ++side)
        for (PetscInt j = 0; j <= pair->order[side]; ++j) g->M[side][i][j] += psi * phi[side][j];
      for (PetscInt side = 0; side < 2 && pair->vector; ++side)
        for (PetscInt d = 0; d < 2; ++d)
          for (PetscInt j = 0; j <= pair->order[side]; ++j)
            pair->vector[pair->nsegments - 1][side][d][i][j] += (side ? -normal[d] : normal[d]) * psi * phi[side][j];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pieces of [from,to], in element e of the pressure side. Elements of the other side are met from its end: element j covers
   [s[p j + p], s[p j]], p its order; k is the one met last. */
static PetscErrorCode AbutPairPieces_Private(AbutPair pair, PetscInt *k, PetscInt e, AbutDual A, PetscReal from, PetscReal to)
{
  const PetscReal *own = pair->place[0] + pair->order[0] * e, *s = pair->place[1], tiny = 1e-12 * (own[pair->order[0]] - own[0]);
  const PetscInt   p = pair->order[1];

  PetscFunctionBegin;
  if (p < 0) {
    PetscCall(AbutPairSegment_Private(pair, e, 0, A, from, to));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  while (*k > 0 && s[p * *k] <= from + tiny) --*k;
  for (PetscInt j = *k; j >= 0 && s[p * (j + 1)] < to; --j) {
    const PetscReal a = PetscMax(from, s[p * (j + 1)]), b = PetscMin(to, s[p * j]);

    if (b - a > tiny) PetscCall(AbutPairSegment_Private(pair, e, j, A, a, b));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An element of higher order that the other side covers in part, or with nodes that carry no pressure: dual functions need not be
   positive there, so each of the nodes on the overlap that carry takes what is nearest to it, a constant; if none does, the nearest. */
static PetscErrorCode AbutPairNearest_Private(AbutPair pair, PetscInt *k, PetscInt e, PetscReal from, PetscReal to)
{
  const PetscInt   p     = pair->order[0];
  const PetscReal *s     = pair->place[0] + p * e;
  const PetscBool *fixed = pair->nodes[pair->which]->fixed + p * e;
  PetscInt         node[ABUT_SIDE_NODES_MAX], n = 0, nearest = -1;

  PetscFunctionBegin;
  for (PetscInt i = 0; i <= p; ++i) {
    if (fixed[i]) continue;
    if (s[i] >= from && s[i] <= to) node[n++] = i;
    if (nearest < 0 || PetscAbsReal(s[i] - 0.5 * (from + to)) < PetscAbsReal(s[nearest] - 0.5 * (from + to))) nearest = i;
  }
  if (!n && nearest >= 0) node[n++] = nearest;
  for (PetscInt i = 0; i < n; ++i) {
    AbutDual A = {{0.}};

    for (PetscInt j = 0; j <= p; ++j) A[node[i]][j] = 1.;
    PetscCall(AbutPairPieces_Private(pair, k, e, A, i ? 0.5 * (s[node[i - 1]] + s[node[i]]) : from,
                                     i + 1 < n ? 0.5 * (s[node[i]] + s[node[i + 1]]) : to));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Element e of the pressure side, of which [from,to] lies against the other one */
static PetscErrorCode AbutPairElement_Private(AbutPair pair, PetscInt *k, PetscInt e, PetscReal from, PetscReal to)
{
  const PetscInt   p = pair->order[0];
  const PetscReal *s = pair->place[0] + p * e, h = s[p] - s[0];
  const PetscBool *fixed = pair->nodes[pair->which]->fixed + p * e;
  PetscBool        whole = (PetscBool)(to - from > h * (1. - 1e-9));
  AbutDual         A     = {{0.}};

  PetscFunctionBegin;
  for (PetscInt i = 0; i <= p; ++i)
    if (fixed[i]) whole = PETSC_FALSE;
  if (pair->axial && whole) PetscCall(AbutPairDualAxial_Private(pair, e, A));
  else if (p == 1 && !pair->axial) {
    const PetscReal hats[2][2] = {
      {(s[1] - from) / h, (s[1] - to) / h},
      {(from - s[0]) / h, (to - s[0]) / h}
    };
    const PetscBool carries[2] = {(PetscBool)!fixed[0], (PetscBool)!fixed[1]};

    AbutPairDualLinear_Private(hats, carries, A);
  } else if (whole) PetscCall(AbutPairDual_Private(p, A));
  else {
    PetscCall(AbutPairNearest_Private(pair, k, e, from, to));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(AbutPairPieces_Private(pair, k, e, A, from, to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutPairMortar_Private(AbutPair pair)
{
  const AbutSide *own, *other;
  AbutKinematics  kinematics;
  PetscInt        k;

  PetscFunctionBegin;
  PetscCall(AbutPairChoosePressureSide_Private(pair));
  own            = pair->nodes[pair->which];
  other          = pair->body[1] ? pair->nodes[!pair->which] : NULL;
  pair->order[0] = own->order;
  pair->order[1] = other ? other->order : -1;
  PetscCall(AbutPairProject_Private(pair));
  pair->components = pair->straight && !pair->friction ? 1 : 2;
  PetscCall(PetscCalloc3(own->n, &pair->D, own->n, &pair->F, own->n, &pair->work));
  PetscCall(AbutBodyGetKinematics(pair->body[0], &kinematics));
  pair->axial  = (PetscBool)(kinematics == ABUT_AXISYMMETRIC);
  pair->length = pair->D;
  if (pair->axial) PetscCall(PetscCalloc1(own->n, &pair->length));
  pair->overlap[0] = other ? PetscMax(pair->place[1][other->n - 1], 0.) : 0.;
  pair->overlap[1] = other ? PetscMin(pair->place[1][0], pair->place[0][own->n - 1]) : pair->place[0][own->n - 1];
  k                = other ? (other->n - 1) / other->order - 1 : 0;
  for (PetscInt e = 0; e < (own->n - 1) / own->order; ++e) {
    const PetscReal *s = pair->place[0] + own->order * e, *end = s + own->order, from = PetscMax(*s, pair->overlap[0]),
                    to = PetscMin(*end, pair->overlap[1]);

    if (to - from >= 1e-9 * (*end - *s)) PetscCall(AbutPairElement_Private(pair, &k, e, from, to));
  }
  if (pair->friction) PetscCall(AbutPairFrictionSetUp_Private(pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutPairMortarReset_Private(AbutPair pair)
{
  PetscFunctionBegin;
  PetscCall(AbutPairProjectReset_Private(pair));
  PetscCall(PetscFree(pair->segment));
  PetscCall(PetscFree(pair->vector));
  if (pair->length != pair->D) PetscCall(PetscFree(pair->length));
  PetscCall(PetscFree3(pair->D, pair->F, pair->work));
  pair->nsegments = pair->room = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPairComputePenetration - Averaged nodal penetrations: u_n1 + u_n2 - f tested with the dual functions, over their integrals

   Not Collective

   Input Parameters:
+  pair - the pair, set up
.  u1   - [components*n1] displacements at the nodes of the first side, length
-  u2   - [components*n2] the same on the second side

   Output Parameter:
.  g - [nodes of the pressure side] penetrations, length; 0 at nodes that carry no pressure

   Level: intermediate

.seealso: `AbutPairComputePressure()`, `AbutPairGetPressureNodes()`
@*/
PetscErrorCode AbutPairComputePenetration(AbutPair pair, const PetscReal u1[], const PetscReal u2[], PetscReal g[])
{
  const PetscReal *trace[2] = {pair->which ? u2 : u1, pair->which ? u1 : u2};
  const PetscInt   n        = pair->n[pair->which];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < n; ++i) g[i] = -pair->F[i];
  for (PetscInt k = 0; k < pair->nsegments; ++k) {
    const AbutSegment *seg = &pair->segment[k];

    for (PetscInt i = 0; i <= pair->order[0]; ++i)
      for (PetscInt side = 0; side < 2; ++side)
        for (PetscInt j = 0; j <= pair->order[side]; ++j)
          for (PetscInt d = 0; d < pair->components; ++d)
            g[pair->order[0] * seg->element[0] + i] += AbutSegmentWeight_Private(pair, k, side, d, i, j) *
                                                       trace[side][pair->components * (pair->order[side] * seg->element[side] + j) + d];
  }
  for (PetscInt i = 0; i < n; ++i) g[i] = pair->D[i] > 0. ? g[i] / pair->D[i] : 0.;
  PetscFunctionReturn(PETSC_SUCCESS);
}
