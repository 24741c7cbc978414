#include <abut/private/pairimpl.h> /*I "abutpair.h" I*/
#include <petscdt.h>

/* The contact pressure as a function on the pressure side, out of the nodal forces */

/* M += integrals of products of the functions of element e over the part that both sides share; the lower band of AbutSolveBand() */
static PetscErrorCode AbutPairAddMass_Private(AbutPair pair, PetscInt e, PetscReal M[])
{
  const AbutSide  *m = pair->nodes[pair->which];
  const PetscInt   n = pair->order[0] + 1, first = pair->order[0] * e;
  const PetscReal *a = m->x + 2 * first, *b = a + 2 * pair->order[0];
  const PetscReal  h   = PetscSqrtReal(PetscSqr(b[0] - a[0]) + PetscSqr(b[1] - a[1])),
                  from = PetscSqrtReal(PetscSqr(a[0] - m->x[0]) + PetscSqr(a[1] - m->x[1]));
  const PetscReal s[2] = {PetscMax(0., (pair->overlap[0] - from) / h), PetscMin(1., (pair->overlap[1] - from) / h)};
  PetscReal       N[ABUT_SIDE_NODES_MAX], z[ABUT_SIDE_NODES_MAX], w[ABUT_SIDE_NODES_MAX];

  PetscFunctionBegin;
  if (s[1] <= s[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscDTGaussQuadrature(n, s[0], s[1], z, w));
  for (PetscInt q = 0; q < n; ++q) {
    PetscCall(AbutEvaluateLobatto(pair->order[0], 2. * z[q] - 1., N, NULL));
    for (PetscInt j = 0; j < n; ++j)
      for (PetscInt i = j; i < n; ++i) M[n * (first + j) + i - j] += w[q] * h * N[i] * N[j];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Open nodes leave the system, and those beyond the part that both sides share: their rows and columns are those of the unit matrix. A node
   that carries no pressure, for example at a held end, has a value all the same. */
static void AbutPairKeepClosed_Private(PetscInt order, PetscInt n, const PetscReal D[], const PetscReal p[], PetscReal M[],
                                       PetscReal force[], PetscBool out[])
{
  for (PetscInt i = 0; i < n; ++i) out[i] = (PetscBool)((D[i] > 0. && p[i] <= 0.) || M[(order + 1) * i] <= 0.);
  for (PetscInt j = 0; j < n; ++j) {
    for (PetscInt i = j; i <= PetscMin(j + order, n - 1); ++i)
      if (out[i] || out[j]) M[(order + 1) * j + i - j] = i == j ? 1. : 0.;
    if (out[j]) force[j] = 0.;
  }
}

/*@C
   AbutPairRecoverPressure - The consistent pressure: the function on the pressure side that vanishes at open nodes and whose integrals with
   the functions of the closed ones are the nodal contact forces

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
  const PetscInt order = pair->order[0], n = pair->n[pair->which];
  PetscReal     *M, *f[2];
  PetscBool     *out;

  PetscFunctionBegin;
  PetscCall(PetscCalloc4((order + 1) * n, &M, pair->n[0], &f[0], pair->n[1], &f[1], n, &out));
  PetscCall(AbutPairComputeForce(pair, p, f[0], f[1]));
  PetscCall(PetscArraycpy(q, f[pair->which], n));
  for (PetscInt e = 0; order * e + 1 < n; ++e) PetscCall(AbutPairAddMass_Private(pair, e, M));
  AbutPairKeepClosed_Private(order, n, pair->D, p, M, q, out);
  PetscCall(AbutSolveBand(n, order, M, 1, q));
  PetscCall(PetscFree4(M, f[0], f[1], out));
  PetscFunctionReturn(PETSC_SUCCESS);
}
