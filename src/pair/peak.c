#include <abut/private/pairimpl.h> /*I "abutpair.h" I*/

/* The peak of the contact pressure, and how well the elements there resolve it */

/* The pressures that are read: consistent ones from order 2, where nodal ones have an error of one sign at the vertices */
PetscErrorCode AbutPairReadPressure_Private(AbutPair pair, const PetscReal p[], PetscReal q[])
{
  PetscFunctionBegin;
  if (pair->order[0] > 1) PetscCall(AbutPairRecoverPressure(pair, p, q));
  else PetscCall(PetscArraycpy(q, p, pair->n[pair->which]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A line through two nodes misses the parabola through them and a third one by h^2/4 times its divided difference in the middle of
   element e; 0 if there is no such node */
static PetscReal AbutPairCurve_Private(AbutPair pair, const PetscReal q[], PetscInt e, PetscInt third)
{
  PetscReal x[3];

  if (third < 0 || third >= pair->n[pair->which]) return 0.;
  x[0] = AbutPairPlace_Private(pair, e);
  x[1] = AbutPairPlace_Private(pair, e + 1);
  x[2] = AbutPairPlace_Private(pair, third);
  return 0.25 * (x[1] - x[0]) * PetscAbsReal((q[third] - q[e]) * (x[1] - x[0]) - (q[e + 1] - q[e]) * (x[2] - x[0])) /
         PetscAbsReal((x[2] - x[0]) * (x[2] - x[1]));
}

/* How much a function on element e depends on its order p: the size of its last Legendre coefficient, by the Gauss-Lobatto formula, whose
   nodes are those of the element: L_p alternates there, with squares 2/(p(p+1)w_i), and has the square 2/p. At order 1 that would be the
   slope; there it is the curve of the neighbourhood that counts. */
static PetscErrorCode AbutPairLastCoefficient_Private(AbutPair pair, const PetscReal q[], PetscInt e, PetscReal *last)
{
  const PetscInt   order = pair->order[0];
  const PetscReal *v     = q + order * e;
  PetscReal        z[ABUT_SIDE_NODES_MAX], w[ABUT_SIDE_NODES_MAX], sum = 0.;

  PetscFunctionBegin;
  if (order == 1) {
    *last = PetscMax(AbutPairCurve_Private(pair, q, e, e - 1), AbutPairCurve_Private(pair, q, e, e + 2));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(AbutGetLobattoNodes(order, z, w));
  for (PetscInt i = 0; i <= order; ++i) sum += (i % 2 ? -1. : 1.) * PetscSqrtReal(2. * w[i] / (order * (order + 1.))) * v[i];
  *last = 0.5 * order * PetscAbsReal(sum);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPairGetPeaks - Elements of the pressure side that hold the largest pressure and do not resolve it

   Not Collective

   Input Parameters:
+  pair      - the pair, set up
.  p         - [nodes of the pressure side] the pressures that act, stress
.  tolerance - relative error that the largest pressure may have, above 0
-  max       - room in peak

   Output Parameters:
+  n    - how many elements, at most max; 0 without contact
-  peak - [n] the elements, in the order of their nodes; the same on all ranks

   Level: intermediate

   Notes:
   An element holds the largest pressure if a pressure on it is within the tolerance of it, and resolves it if the last Legendre coefficient
   of the pressure on the element is within the tolerance too; at order 1, the distance in the middle of the element from the parabola
   through a neighbour.

   Limits: that is a measure, no bound. Below two layers the true error of the largest pressure is up to 3 times it at order 3 and up to 20
   times at order 4, where the pressure of a wide contact is nearly a parabola. It does not see how coarse the other body is. A pressure
   that is unbounded, as below the corner of a punch, is not resolved by any element.

.seealso: `AbutPairRecoverPressure()`, `AbutAdaptorSetFromOptions()`
@*/
PetscErrorCode AbutPairGetPeaks(AbutPair pair, const PetscReal p[], PetscReal tolerance, PetscInt max, PetscInt *n, AbutPeak peak[])
{
  const AbutSide *m     = pair->nodes[pair->which];
  const PetscInt  order = pair->order[0];
  PetscReal      *q, largest = 0.;

  PetscFunctionBegin;
  *n = 0;
  PetscCall(PetscMalloc1(m->n, &q));
  PetscCall(AbutPairReadPressure_Private(pair, p, q));
  for (PetscInt i = 0; i < m->n; ++i) largest = PetscMax(largest, q[i]);
  for (PetscInt first = 0; largest > 0. && first + order < m->n && *n < max; first += order) {
    PetscInt  top  = first;
    PetscReal last = 0.;

    for (PetscInt i = first + 1; i <= first + order; ++i)
      if (q[i] > q[top]) top = i;
    if (q[top] < (1. - tolerance) * largest) continue;
    PetscCall(AbutPairLastCoefficient_Private(pair, q, first / order, &last));
    if (last <= tolerance * largest) continue;
    peak[*n].length = AbutPairPlace_Private(pair, first + order) - AbutPairPlace_Private(pair, first);
    peak[*n].last   = last / largest;
    for (PetscInt d = 0; d < 2; ++d) peak[*n].x[d] = m->x[2 * top + d];
    ++*n;
  }
  PetscCall(PetscFree(q));
  PetscFunctionReturn(PETSC_SUCCESS);
}
