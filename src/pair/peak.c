#include <abut/private/pairimpl.h> /*I "abutpair.h" I*/

/* The peak of the contact pressure, and how well the elements there resolve it */

/* The pressures that are read: consistent ones from order 2, where nodal ones have an error of one sign at the vertices */
PetscErrorCode AbutPairGetReading_Private(AbutPair pair, const PetscReal p[], PetscReal q[])
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
  x[0] = pair->place[0][e];
  x[1] = pair->place[0][e + 1];
  x[2] = pair->place[0][third];
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

/* The largest value of the function on element e, and its place: between the neighbours of the largest node, by golden sections, unless the
   nodes are below half of what is enough: no polynomial of these orders rises that far above its nodes */
static PetscErrorCode AbutPairElementTop_Private(AbutPair pair, const PetscReal q[], PetscInt e, PetscReal enough, PetscReal *value,
                                                 PetscReal *at)
{
  const PetscReal  golden = 0.6180339887498949;
  const PetscInt   order  = pair->order[0];
  const PetscReal *v      = q + order * e;
  PetscReal        z[ABUT_SIDE_NODES_MAX], N[ABUT_SIDE_NODES_MAX], low, high;
  PetscInt         top = 0;

  PetscFunctionBegin;
  PetscCall(AbutGetLobattoNodes(order, z, NULL));
  for (PetscInt i = 1; i <= order; ++i)
    if (v[i] > v[top]) top = i;
  *value = v[top];
  *at    = z[top];
  low    = z[PetscMax(top - 1, 0)];
  high   = z[PetscMin(top + 1, order)];
  for (PetscInt step = 0; order > 1 && *value >= 0.5 * enough && step < 40; ++step) {
    PetscReal f[2] = {0., 0.}, x[2] = {high - golden * (high - low), low + golden * (high - low)};

    for (PetscInt k = 0; k < 2; ++k) {
      PetscCall(AbutEvaluateLobatto(order, x[k], N, NULL));
      for (PetscInt i = 0; i <= order; ++i) f[k] += N[i] * v[i];
      if (f[k] > *value) *at = x[k];
      *value = PetscMax(*value, f[k]);
    }
    if (f[0] > f[1]) high = x[1];
    else low = x[0];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The largest of the pressures that are read, on nodes and between them */
PetscErrorCode AbutPairGetLargest_Private(AbutPair pair, const PetscReal q[], PetscReal *largest)
{
  const PetscInt order = pair->order[0];
  PetscReal      node  = 0.;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < pair->n[pair->which]; ++i) node = PetscMax(node, q[i]);
  *largest = node;
  for (PetscInt first = 0; first + order < pair->n[pair->which]; first += order) {
    PetscReal value, at;

    PetscCall(AbutPairElementTop_Private(pair, q, first / order, node, &value, &at));
    *largest = PetscMax(*largest, value);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does an element touch an end of the shared part that is an end of one side only? There the other body has a corner to press against, or
   this one presses with its own, and the pressure is unbounded. */
static PetscBool AbutPairAtCorner_Private(AbutPair pair, PetscReal from, PetscReal to)
{
  const PetscReal length = pair->place[0][pair->n[pair->which] - 1], near = 1e-9 * length, *other = pair->place[1];
  PetscReal       end[2];

  if (!pair->body[1]) return PETSC_FALSE;
  end[0] = other[0];
  end[1] = other[pair->n[!pair->which] - 1];
  if (PetscAbsReal(PetscMin(end[0], end[1])) > near && from < pair->overlap[0] + near) return PETSC_TRUE;
  return (PetscBool)(PetscAbsReal(PetscMax(end[0], end[1]) - length) > near && to > pair->overlap[1] - near);
}

/*@C
   AbutPairGetPeaks - Elements of the pressure side that hold the largest pressure and do not resolve it

   Not Collective

   Input Parameters:
+  pair      - the pair, set up
.  p         - [nodes of the pressure side] the pressures that act, stress
.  tolerance - how large the last coefficient of the pressure may be, relative to the largest pressure, above 0
-  max       - room in peak; there are not more than nodes

   Output Parameters:
+  n    - how many elements, at most max; 0 without contact
-  peak - [n] the elements, in the order of their nodes; the same on all ranks

   Level: intermediate

   Notes:
   An element holds the largest pressure if the pressure somewhere on it is within the tolerance of it, and resolves it if its last Legendre
   coefficient is within the tolerance too; at order 1, the distance in the middle of the element from the parabola through a neighbour.

   Elements at a corner, where one side ends and the other goes on, are left out: the pressure is unbounded there.

   Limits: the coefficient is a measure of what the element lacks, no bound of the error: that has a part from the edge of the contact and
   from the inside of the bodies, which only the energy sees. It does not see how coarse the other body is, either.

.seealso: `AbutPairRecoverPressure()`, `AbutAdaptorSetFromOptions()`
@*/
PetscErrorCode AbutPairGetPeaks(AbutPair pair, const PetscReal p[], PetscReal tolerance, PetscInt max, PetscInt *n, AbutPeak peak[])
{
  const AbutSide *m     = pair->nodes[pair->which];
  const PetscInt  order = pair->order[0];
  PetscReal      *q, largest, enough, contact = 0.;

  PetscFunctionBegin;
  *n = 0;
  for (PetscInt i = 0; i < m->n; ++i) contact += p[i] > 0. ? pair->length[i] : 0.;
  PetscCall(PetscMalloc1(m->n, &q));
  PetscCall(AbutPairGetReading_Private(pair, p, q));
  PetscCall(AbutPairGetLargest_Private(pair, q, &largest));
  enough = (1. - tolerance) * largest;
  for (PetscInt first = 0; largest > 0. && first + order < m->n && *n < max; first += order) {
    const PetscReal  from = pair->place[0][first], to = pair->place[0][first + order];
    const PetscReal *a = m->x + 2 * first, *b = m->x + 2 * (first + order);
    PetscReal        last = 0., top, at;

    PetscCall(AbutPairElementTop_Private(pair, q, first / order, enough, &top, &at));
    if (top < enough || AbutPairAtCorner_Private(pair, from, to)) continue;
    PetscCall(AbutPairLastCoefficient_Private(pair, q, first / order, &last));
    if (last <= tolerance * largest) continue;
    peak[*n].length = to - from;
    peak[*n].part   = (to - from) / contact;
    peak[*n].last   = last / largest;
    for (PetscInt d = 0; d < 2; ++d) peak[*n].x[d] = 0.5 * ((1. - at) * a[d] + (1. + at) * b[d]);
    ++*n;
  }
  PetscCall(PetscFree(q));
  PetscFunctionReturn(PETSC_SUCCESS);
}
