#include <abut/private/pairimpl.h> /*I "abutpair.h" I*/
#include <petscdt.h>

/* The contact pressure as a function on the pressure side, out of the nodal forces */

/* The system for the values at the nodes: the mass matrix of the elements that the other side covers whole, in the lower band of
   AbutSolveBand(), and their part of the nodal forces */
typedef struct {
  PetscInt   order, n;
  PetscReal *M, *force;
  PetscBool *known; /* [n] the value is given: 0 at open nodes and where the other side does not reach, and beside elements covered in
                       part, where the matrix would be close to singular, the nodal pressure itself */
} AbutRecovery;

static PetscBool AbutPairCoversElement_Private(AbutPair pair, PetscInt e, PetscReal *h)
{
  const PetscReal from = pair->place[0][pair->order[0] * e];

  *h = pair->place[0][pair->order[0] * (e + 1)] - from;
  return (PetscBool)(from > pair->overlap[0] - 1e-9 * *h && from + *h < pair->overlap[1] + 1e-9 * *h);
}

static PetscErrorCode AbutRecoveryAddElement_Private(AbutPair pair, AbutRecovery *r, PetscInt e, PetscReal h)
{
  const PetscInt n = r->order + 1, first = r->order * e;
  PetscReal      N[ABUT_SIDE_NODES_MAX], z[ABUT_SIDE_NODES_MAX + 1], w[ABUT_SIDE_NODES_MAX + 1], x[2], thickness;
  const PetscInt points = pair->axial ? n + 1 : n;

  PetscFunctionBegin;
  PetscCall(PetscDTGaussQuadrature(points, -1., 1., z, w));
  for (PetscInt q = 0; q < points; ++q) {
    AbutPairPointAt_Private(pair, pair->place[0][first] + 0.5 * (1. + z[q]) * h, x);
    PetscCall(AbutBodyGetThickness(pair->body[pair->which], x, &thickness));
    PetscCall(AbutEvaluateLobatto(r->order, z[q], N, NULL));
    for (PetscInt j = 0; j < n; ++j)
      for (PetscInt i = j; i < n; ++i) r->M[n * (first + j) + i - j] += 0.5 * w[q] * thickness * h * N[i] * N[j];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutRecoverySetUp_Private(AbutPair pair, const PetscReal p[], AbutRecovery *r)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < r->n; ++i) r->known[i] = (PetscBool)(pair->D[i] > 0. && p[i] <= 0.);
  for (PetscInt e = 0; r->order * e + 1 < r->n; ++e) {
    PetscReal h;

    if (AbutPairCoversElement_Private(pair, e, &h)) PetscCall(AbutRecoveryAddElement_Private(pair, r, e, h));
    else
      for (PetscInt i = 0; i <= r->order; ++i) r->known[r->order * e + i] = PETSC_TRUE;
  }
  for (PetscInt g = 0; g < pair->nsegments; ++g) {
    const AbutSegment *seg   = &pair->segment[g];
    const PetscInt     first = r->order * seg->element[0];
    PetscReal          h;

    if (!AbutPairCoversElement_Private(pair, seg->element[0], &h)) continue;
    for (PetscInt i = 0; i <= r->order; ++i)
      for (PetscInt j = 0; j <= r->order; ++j) r->force[first + j] += seg->M[0][i][j] * p[first + i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is known goes to the right-hand side; its rows and columns become those of the unit matrix */
static void AbutRecoveryEliminate_Private(const AbutRecovery *r, const PetscReal p[])
{
  for (PetscInt j = 0; j < r->n; ++j)
    for (PetscInt i = j + 1; i <= PetscMin(j + r->order, r->n - 1); ++i) {
      PetscReal *m = &r->M[(r->order + 1) * j + i - j];

      if (r->known[i] && !r->known[j]) r->force[j] -= *m * p[i];
      if (r->known[j] && !r->known[i]) r->force[i] -= *m * p[j];
      if (r->known[i] || r->known[j]) *m = 0.;
    }
  for (PetscInt j = 0; j < r->n; ++j) {
    if (!r->known[j]) continue;
    r->M[(r->order + 1) * j] = 1.;
    r->force[j]              = p[j];
  }
}

/*@C
   AbutPairRecoverPressure - The consistent pressure: the function on the pressure side that vanishes at open nodes and whose integrals with
   the functions of the closed ones are the nodal contact forces; on elements that the other side covers in part, the nodal pressures

   Not Collective

   Input Parameters:
+  pair - the pair, set up
-  p    - [nodes of the pressure side] pressures, the coefficients of the dual functions, stress

   Output Parameter:
.  q - [nodes of the pressure side] values of the function at the nodes, stress

   Level: intermediate

   Note:
   The coefficients are values of the pressure too, those at the vertices of order 2 with an error of second order in the size of the
   elements, all of one sign, at points inside elements of the other; this takes it out. Where the edge of the contact lies inside an
   element the function may ring there.

.seealso: `AbutPairGetState()`, `AbutPairComputeForce()`
@*/
PetscErrorCode AbutPairRecoverPressure(AbutPair pair, const PetscReal p[], PetscReal q[])
{
  AbutRecovery r = {.order = pair->order[0], .n = pair->n[pair->which], .force = q};

  PetscFunctionBegin;
  PetscCall(PetscCalloc2((r.order + 1) * r.n, &r.M, r.n, &r.known));
  PetscCall(PetscArrayzero(q, r.n));
  PetscCall(AbutRecoverySetUp_Private(pair, p, &r));
  AbutRecoveryEliminate_Private(&r, p);
  PetscCall(AbutSolveBand(r.n, r.order, r.M, 1, q));
  PetscCall(PetscFree2(r.M, r.known));
  PetscFunctionReturn(PETSC_SUCCESS);
}
