#include <abut/private/pairimpl.h> /*I "abutpair.h" I*/
#include <petscdt.h>

/* Dual-mortar weights on the common refinement of the two sides. One-sided quadrature would fail the contact patch test by some per
   cent. */

/* Coordinate of every node along the straight pressure side, 0 at its first node */
static PetscErrorCode AbutPairProject_Private(AbutPair pair, PetscReal *s[2], PetscReal tangent[2])
{
  const AbutSide *m = pair->nodes[pair->which];
  PetscReal       length;

  PetscFunctionBegin;
  for (PetscInt d = 0; d < 2; ++d) tangent[d] = m->x[2 * (m->n - 1) + d] - m->x[d];
  length = PetscSqrtReal(tangent[0] * tangent[0] + tangent[1] * tangent[1]);
  for (PetscInt d = 0; d < 2; ++d) tangent[d] /= length;
  for (PetscInt k = 0; k < 2; ++k) {
    const AbutSide *side = pair->nodes[k ? !pair->which : pair->which];

    PetscCall(PetscMalloc1(side->n, &s[k]));
    for (PetscInt i = 0; i < side->n; ++i) s[k][i] = (side->x[2 * i] - m->x[0]) * tangent[0] + (side->x[2 * i + 1] - m->x[1]) * tangent[1];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define ABUT_STIFFER 1.5

/* The side with more nodes on the common part carries the pressures, the first one if equal; but never that of the clearly stiffer body.
   Pressures that only a stiff body resolves are held by its small compliance alone, and oscillate. */
static PetscErrorCode AbutPairChoosePressureSide_Private(AbutPair pair)
{
  PetscInt  count[2] = {0, 0};
  PetscReal young[2], poisson[2], modulus[2];

  PetscFunctionBegin;

  pair->which = pair->pressureside == ABUT_PRESSURE_SECOND;
  if (pair->pressureside != ABUT_PRESSURE_FINER) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < 2; ++k) {
    const AbutSide *own = pair->nodes[k], *other = pair->nodes[!k];
    PetscReal       box[4] = {PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MIN_REAL, PETSC_MIN_REAL};
    const PetscInt  d = PetscAbsReal(own->normal[0]) > PetscAbsReal(own->normal[1]) ? 1 : 0; /* the coordinate that runs along the side */

    for (PetscInt i = 0; i < other->n; ++i) {
      box[d]     = PetscMin(box[d], other->x[2 * i + d]);
      box[2 + d] = PetscMax(box[2 + d], other->x[2 * i + d]);
    }
    for (PetscInt i = 0; i < own->n; ++i)
      if (own->x[2 * i + d] >= box[d] && own->x[2 * i + d] <= box[2 + d]) ++count[k];
  }
  pair->which = count[1] > count[0];
  for (PetscInt s = 0; s < 2; ++s) {
    PetscCall(AbutBodyGetMaterial(pair->body[s], &young[s], &poisson[s]));
    modulus[s] = young[s] / (1. - poisson[s] * poisson[s]);
  }
  if (modulus[pair->which] > ABUT_STIFFER * modulus[!pair->which]) pair->which = !pair->which;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The dual functions psi_i = sum_j A[i][j] phi_j of one element on its overlap with the other side, biorthogonal there: A = diag(D) M^-1;
   z[j] holds the hat function phi_j at the two ends of the overlap, of length f. Beside a node that carries no pressure the other node's
   function is 1, so that constants stay in the space. On a small overlap the dual functions are wild: the largest eigenvalue of D M^-1 is
   det D/det M, 3 on a full element; beyond 100 the nearer node carries alone. */
static void AbutPairDual_Private(const PetscReal z[2][2], const PetscBool carries[2], PetscReal A[2][2])
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

/* Integrals over one piece [from,to] (along the side) of the elements e of the pressure side and k of the other */
static PetscErrorCode AbutPairSegment_Private(AbutPair pair, PetscReal *const s[2], const PetscReal tangent[2], PetscInt e, PetscInt k,
                                              const PetscReal A[2][2], PetscReal from, PetscReal to)
{
  static const PetscReal z[4] = {-0.86113631159405258, -0.33998104358485626, 0.33998104358485626, 0.86113631159405258};
  static const PetscReal w[4] = {0.34785484513745386, 0.65214515486254614, 0.65214515486254614, 0.34785484513745386};
  const AbutSide        *m    = pair->nodes[pair->which];
  AbutSegment           *g    = &pair->segment[pair->nsegments++];

  PetscFunctionBegin;
  PetscCall(PetscMemzero(g, sizeof(*g)));
  g->element[0] = e;
  g->element[1] = k;
  for (PetscInt q = 0; q < 4; ++q) {
    const PetscReal at = 0.5 * (from + to) + 0.5 * z[q] * (to - from), dw = 0.5 * w[q] * (to - from),
                    x[2] = {m->x[0] + at * tangent[0], m->x[1] + at * tangent[1]};
    const PetscReal own = (at - s[0][e]) / (s[0][e + 1] - s[0][e]), other = (at - s[1][k]) / (s[1][k + 1] - s[1][k]),
                    phi[2][2] = {
                      {1. - own,   own  },
                      {1. - other, other}
    };
    PetscReal f;

    PetscCall(AbutPairGetGap(pair, x, &f));
    for (PetscInt i = 0; i < 2; ++i) {
      const PetscReal psi = dw * (A[i][0] * phi[0][0] + A[i][1] * phi[0][1]);

      pair->D[e + i] += psi;
      pair->F[e + i] += psi * f;
      for (PetscInt side = 0; side < 2; ++side)
        for (PetscInt j = 0; j < 2; ++j) g->M[side][i][j] += psi * phi[side][j];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The sides run against each other, so elements of the other one are met from its end */
PetscErrorCode AbutPairMortar_Private(AbutPair pair)
{
  PetscReal      *s[2], tangent[2], low, high;
  const AbutSide *m, *o;
  PetscInt        k;

  PetscFunctionBegin;
  PetscCall(AbutPairChoosePressureSide_Private(pair));
  m = pair->nodes[pair->which];
  o = pair->nodes[!pair->which];
  PetscCall(AbutPairProject_Private(pair, s, tangent));
  PetscCall(PetscMalloc1(m->n + o->n, &pair->segment));
  PetscCall(PetscCalloc3(m->n, &pair->D, m->n, &pair->F, m->n, &pair->work));
  low              = s[1][o->n - 1];
  high             = s[1][0];
  k                = o->n - 2;
  pair->overlap[0] = PetscMax(low, 0.);
  pair->overlap[1] = PetscMin(high, s[0][m->n - 1]);
  for (PetscInt e = 0; e + 1 < m->n; ++e) {
    const PetscReal h = s[0][e + 1] - s[0][e], from = PetscMax(s[0][e], low), to = PetscMin(s[0][e + 1], high);
    const PetscReal hats[2][2] = {
      {(s[0][e + 1] - from) / h, (s[0][e + 1] - to) / h},
      {(from - s[0][e]) / h,     (to - s[0][e]) / h    }
    };
    const PetscBool carries[2] = {(PetscBool)!m->fixed[e], (PetscBool)!m->fixed[e + 1]};
    PetscReal       A[2][2];

    if (to - from < 1e-9 * h) continue;
    AbutPairDual_Private(hats, carries, A);
    while (k > 0 && s[1][k] <= from + 1e-12 * h) --k;
    for (PetscInt j = k; j >= 0 && s[1][j + 1] < to; --j) { /* element j of the other side covers [s[1][j+1], s[1][j]] */
      const PetscReal a = PetscMax(from, s[1][j + 1]), b = PetscMin(to, s[1][j]);

      if (b - a > 1e-12 * h) PetscCall(AbutPairSegment_Private(pair, s, tangent, e, j, A, a, b));
    }
  }
  for (PetscInt i = 0; i < 2; ++i) PetscCall(PetscFree(s[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutPairMortarReset_Private(AbutPair pair)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(pair->segment));
  PetscCall(PetscFree3(pair->D, pair->F, pair->work));
  pair->nsegments = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPairComputePenetration - Averaged nodal penetrations: u_n1 + u_n2 - f tested with the dual functions, over their integrals

   Not Collective

   Input Parameters:
+  pair - the pair, set up
.  u1   - [n1] normal displacements at the nodes of the first side, length
-  u2   - [n2] the same on the second side

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

    for (PetscInt i = 0; i < 2; ++i)
      for (PetscInt side = 0; side < 2; ++side)
        for (PetscInt j = 0; j < 2; ++j) g[seg->element[0] + i] += seg->M[side][i][j] * trace[side][seg->element[side] + j];
  }
  for (PetscInt i = 0; i < n; ++i) g[i] = pair->D[i] > 0. ? g[i] / pair->D[i] : 0.;
  PetscFunctionReturn(PETSC_SUCCESS);
}
