#include <abut/private/pairimpl.h> /*I "abutpair.h" I*/

/* Where contact begins and ends */

/* The edge beyond the last closed node, from the second to fourth open node on: there gap^(2/3) runs straight into the edge of an exact
   contact. At most an element away from the last closed node, which is itself the answer where there is no such line. */
static PetscReal AbutPairEdgeOfGap_Private(AbutPair pair, const PetscReal g[], const PetscReal p[], PetscInt in, PetscInt step)
{
  const AbutSide *m    = pair->nodes[pair->which];
  const PetscInt  end  = PetscMin(PetscMax(in + step * pair->order[0], 0), m->n - 1);
  const PetscReal last = pair->place[0][in], h = PetscAbsReal(pair->place[0][end] - last);
  PetscReal       s[3], y[3], ms = 0., my = 0., sy = 0., ss = 0., edge;

  for (PetscInt k = 0; k < 3; ++k) {
    const PetscInt node = in + (k + 2) * step;

    if (node < 0 || node >= m->n || pair->D[node] <= 0. || p[node] > 0. || g[node] >= 0.) return last;
    s[k] = pair->place[0][node];
    y[k] = PetscPowReal(-g[node], 2. / 3.);
    ms += s[k] / 3.;
    my += y[k] / 3.;
  }
  for (PetscInt k = 0; k < 3; ++k) {
    sy += (s[k] - ms) * (y[k] - my);
    ss += (s[k] - ms) * (s[k] - ms);
  }
  edge = sy != 0. ? ms - my * ss / sy : last;
  edge = PetscMin(PetscMax(edge, last - h), last + h);
  return PetscMin(PetscMax(edge, pair->overlap[0]), pair->overlap[1]);
}

/* The edge beyond the closed node `in`, in the direction of step, as a distance from the first node: where the penetration changes sign, or
   in exact contact where the gap opens. There is none if the next node carries no pressure: then the contact reaches the end of the part
   that both sides share. */
PetscBool AbutPairEdgeBeyond_Private(AbutPair pair, const PetscReal g[], const PetscReal p[], PetscInt in, PetscInt step, PetscReal *at)
{
  const AbutSide *m   = pair->nodes[pair->which];
  const PetscInt  out = in + step;

  if (out < 0 || out >= m->n || pair->D[out] <= 0.) return PETSC_FALSE;
  *at = pair->theta > 0. ? pair->place[0][in] : AbutPairEdgeOfGap_Private(pair, g, p, in, step);
  if (pair->theta > 0. && g[in] > 0. && g[out] < 0.) *at += (pair->place[0][out] - *at) * g[in] / (g[in] - g[out]);
  return PETSC_TRUE;
}

/*@C
   AbutPairGetEdges - Where contact begins and ends: both ends of every run of closed nodes that is not at the end of the shared part

   Not Collective

   Input Parameters:
+  pair - the pair, set up
.  u1   - [components*n1] displacements at the nodes of the first side, length
.  u2   - [components*n2] the same on the second side
.  p    - [nodes of the pressure side] the pressures that act, stress
-  max  - room in x

   Output Parameters:
+  n - how many edges; at most max
-  x - [n][2] points on the pressure side, in the order of its nodes, length; the same on all ranks

   Level: intermediate

   Note:
   An edge is where the penetration changes sign (theta > 0); in exact contact, where the straight line through gap^(2/3) at the second to
   fourth open node meets zero, at most an element away from the last closed node.

.seealso: `AbutPairGetState()`, `AbutMeshSetTies()`
@*/
PetscErrorCode AbutPairGetEdges(AbutPair pair, const PetscReal u1[], const PetscReal u2[], const PetscReal p[], PetscInt max, PetscInt *n,
                                PetscReal x[][2])
{
  const AbutSide *m = pair->nodes[pair->which];
  PetscReal      *g = pair->work, at;

  PetscFunctionBegin;
  PetscCall(AbutPairComputePenetration(pair, u1, u2, g));
  *n = 0;
  for (PetscInt i = 0; i < m->n; ++i)
    for (PetscInt step = -1; step <= 1; step += 2) {
      const PetscInt next = i + step;

      if (p[i] <= 0. || (next >= 0 && next < m->n && p[next] > 0.) || *n == max) continue; /* open, or inside a run */
      if (!AbutPairEdgeBeyond_Private(pair, g, p, i, step, &at)) continue;
      AbutPairPointAt_Private(pair, at, x[(*n)++]);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}
