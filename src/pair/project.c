#include <abut/private/pairimpl.h>

/* How the two sides of a pair lie against each other. Along straight sides one coordinate serves both. Along curved ones, which are
   polygons here, every point of the pressure side looks along a direction that runs continuously from vertex to vertex (the mean of the
   normals there) and sees at most one point of the other side; there is one normal for both. */

static PetscReal AbutCross_Private(const PetscReal a[2], const PetscReal b[2])
{
  return a[0] * b[1] - a[1] * b[0];
}

/* Are the sides straight and opposite to each other? */
static PetscBool AbutPairIsStraight_Private(AbutPair pair)
{
  const AbutSide *own = pair->nodes[pair->which], *other = pair->nodes[!pair->which];

  if (!pair->body[1]) return own->straight;
  return (PetscBool)(own->straight && other->straight &&
                     PetscAbsReal(own->normal[0] + other->normal[0]) + PetscAbsReal(own->normal[1] + other->normal[1]) < 1e-9);
}

/* The direction at a vertex between the elements e-1 and e: the mean of their normals, that of the longer one, which is further from it,
   counting less. On a circle it is the radius. */
static void AbutPairVertexDirection_Private(AbutPair pair, PetscInt e, PetscReal d[2])
{
  const AbutSide  *m = pair->nodes[pair->which];
  const PetscReal *s = pair->place[0] + m->order * e, *before = m->normal + 2 * (e - 1), *behind = m->normal + 2 * e;
  const PetscReal  t = (s[0] - s[-m->order]) / (s[m->order] - s[-m->order]);
  PetscReal        size;

  for (PetscInt i = 0; i < 2; ++i) d[i] = (1. - t) * before[i] + t * behind[i];
  size = PetscSqrtReal(d[0] * d[0] + d[1] * d[1]);
  for (PetscInt i = 0; i < 2; ++i) d[i] /= size;
}

/* At an end of the side the direction is such that the normal of the last element is the mean of those at its ends: on an arc that ends in
   a plane of symmetry it lies in the plane */
static PetscErrorCode AbutPairDirections_Private(AbutPair pair)
{
  const AbutSide *m = pair->nodes[pair->which];
  const PetscInt  n = (m->n - 1) / m->order;
  PetscReal      *d;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(2 * (n + 1), &d));
  for (PetscInt v = 1; v < n; ++v) AbutPairVertexDirection_Private(pair, v, d + 2 * v);
  for (PetscInt end = 0; end < 2; ++end) {
    const PetscReal *normal = m->normal + 2 * (end ? n - 1 : 0), *next = n > 1 ? d + 2 * (end ? n - 1 : 1) : normal;
    const PetscReal  dot = normal[0] * next[0] + normal[1] * next[1];

    for (PetscInt i = 0; i < 2; ++i) d[2 * (end ? n : 0) + i] = 2. * dot * normal[i] - next[i];
  }
  pair->direction = d;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How far the foot from which a point y is seen lies before the point at the share t of element e; negative: behind it */
static PetscReal AbutPairAhead_Private(AbutPair pair, PetscInt e, PetscReal t, const PetscReal y[2])
{
  const AbutSide  *m = pair->nodes[pair->which];
  const PetscReal *a = m->x + 2 * m->order * e, *b = m->x + 2 * m->order * (e + 1), *na = pair->direction + 2 * e, *nb = na + 2;
  const PetscReal  x[2] = {(1. - t) * a[0] + t * b[0] - y[0], (1. - t) * a[1] + t * b[1] - y[1]};
  const PetscReal  n[2] = {(1. - t) * na[0] + t * nb[0], (1. - t) * na[1] + t * nb[1]};

  return -AbutCross_Private(x, n);
}

/* The share of element e at which AbutPairAhead_Private(), quadratic in it, is zero; there is one between 0 and 1 */
static PetscReal AbutPairFoot_Private(AbutPair pair, PetscInt e, const PetscReal y[2])
{
  const PetscReal c = AbutPairAhead_Private(pair, e, 0., y), middle = AbutPairAhead_Private(pair, e, 0.5, y),
                  end = AbutPairAhead_Private(pair, e, 1., y), a = 2. * (end + c - 2. * middle), b = end - c - a;
  const PetscReal root = PetscSqrtReal(PetscMax(0., b * b - 4. * a * c));

  return b + root > 0. ? PetscMin(1., PetscMax(0., -2. * c / (b + root))) : 0.;
}

/* The places of the other side's nodes, which run the other way: one walk, in which every node is compared with what is near it alone, for
   on a long arc the directions at the far end point anywhere. Nodes before the first element, or behind the last one, see none. */
static void AbutPairSee_Private(AbutPair pair)
{
  const AbutSide  *m = pair->nodes[pair->which], *o = pair->nodes[!pair->which];
  const PetscReal *s      = pair->place[0];
  const PetscInt   n      = (m->n - 1) / m->order;
  PetscInt         e      = 0;
  PetscBool        before = PETSC_TRUE;

  for (PetscInt i = o->n - 1; i >= 0; --i) {
    const PetscReal *y = o->x + 2 * i, start = before ? AbutPairAhead_Private(pair, 0, 0., y) : 0.;
    PetscReal        end;

    before = (PetscBool)(start > 0.);
    while (!before && e + 1 < n && AbutPairAhead_Private(pair, e, 1., y) < 0.) ++e;
    end = before ? 0. : AbutPairAhead_Private(pair, e, 1., y);
    if (before) pair->place[1][i] = -start;
    else if (end < 0.) pair->place[1][i] = s[m->n - 1] - end;
    else pair->place[1][i] = s[m->order * e] + AbutPairFoot_Private(pair, e, y) * (s[m->order * (e + 1)] - s[m->order * e]);
  }
}

/* Coordinates along the first side's chord, which is the side if it is straight */
static void AbutPairPlaceOnChord_Private(const AbutSide *m, const AbutSide *side, PetscReal place[])
{
  const PetscReal *a = m->x, *b = m->x + 2 * (m->n - 1), d[2] = {b[0] - a[0], b[1] - a[1]},
                  length = PetscSqrtReal(d[0] * d[0] + d[1] * d[1]);

  for (PetscInt i = 0; i < side->n; ++i)
    place[i] = (side->x[2 * i] - a[0]) * (d[0] / length) + (side->x[2 * i + 1] - a[1]) * (d[1] / length);
}

/* The places of all nodes along the pressure side */
PetscErrorCode AbutPairProject_Private(AbutPair pair)
{
  const AbutSide *m = pair->nodes[pair->which], *o = pair->body[1] ? pair->nodes[!pair->which] : NULL;

  PetscFunctionBegin;
  pair->straight = AbutPairIsStraight_Private(pair);
  PetscCall(PetscMalloc2(m->n, &pair->place[0], o ? o->n : 0, &pair->place[1]));
  if (pair->straight) {
    AbutPairPlaceOnChord_Private(m, m, pair->place[0]);
    if (o) AbutPairPlaceOnChord_Private(m, o, pair->place[1]);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  pair->place[0][0] = 0.;
  for (PetscInt i = 1; i < m->n; ++i)
    pair->place[0][i] = pair->place[0][i - 1] +
                        PetscSqrtReal(PetscSqr(m->x[2 * i] - m->x[2 * i - 2]) + PetscSqr(m->x[2 * i + 1] - m->x[2 * i - 1]));
  PetscCall(AbutPairDirections_Private(pair));
  if (o) AbutPairSee_Private(pair);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutPairProjectReset_Private(AbutPair pair)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(pair->place[0], pair->place[1]));
  PetscCall(PetscFree(pair->direction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The point of the pressure side at a place */
void AbutPairPointAt_Private(AbutPair pair, PetscReal place, PetscReal x[2])
{
  const AbutSide  *m   = pair->nodes[pair->which];
  const PetscReal *s   = pair->place[0];
  PetscInt         low = 0, high = m->n - 1;
  PetscReal        t;

  while (high - low > 1) {
    const PetscInt middle = (low + high) / 2;

    if (s[middle] <= place) low = middle;
    else high = middle;
  }
  t = (place - s[low]) / (s[high] - s[low]);
  for (PetscInt d = 0; d < 2; ++d) x[d] = (1. - t) * m->x[2 * low + d] + t * m->x[2 * high + d];
}

/* The point of a side's curve that is nearest to one of its polygon */
static PetscErrorCode AbutPairOnCurve_Private(AbutPair pair, PetscInt s, const PetscReal x[2], PetscReal foot[2])
{
  AbutMesh mesh;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(pair->body[s], &mesh));
  PetscCall(AbutMeshGetCurvePoint(mesh, pair->side[s], x, foot));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The gap of a point of the pressure side, which looks along a normal, as if it and the point y of the other side lay on the curves of their
   sides and not on polygons: from order 2 on the nodes between vertices would else stand back by what an arc is above its chord */
static PetscErrorCode AbutPairCurvedGap_Private(AbutPair pair, const PetscReal x[2], const PetscReal y[2], const PetscReal normal[2],
                                                PetscReal *gap)
{
  PetscReal own[2], other[2];

  PetscFunctionBegin;
  PetscCall(AbutPairOnCurve_Private(pair, pair->which, x, own));
  if (!pair->obstacle && (pair->gap || pair->straight)) {
    PetscCall(AbutPairGetGap(pair, own, gap));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (pair->obstacle) PetscCall(AbutPairObstacleGap_Private(pair, own, normal, gap));
  else {
    PetscCall(AbutPairOnCurve_Private(pair, !pair->which, y, other));
    *gap = (other[0] - own[0]) * normal[0] + (other[1] - own[1]) * normal[1];
  }
  PetscCall(AbutPairCloseGap_Private(pair, own, gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the point at a place, in element[0] of the pressure side, sees of element[1] of the other one: where it is there, in [-1,1]; and the
   gap. normal: the direction in which it looks, outward. */
PetscErrorCode AbutPairFace_Private(AbutPair pair, const PetscInt element[2], PetscReal place, PetscReal at[2], PetscReal normal[2],
                                    PetscReal *gap)
{
  const AbutSide  *m = pair->nodes[pair->which], *o = pair->body[1] ? pair->nodes[!pair->which] : NULL;
  const PetscInt   first = m->order * element[0], second = o ? o->order * element[1] : 0;
  const PetscReal *s = pair->place[0], a = s[first], b = s[first + m->order];
  PetscReal        x[2], y[2] = {0., 0.}, t = (place - a) / (b - a), size;

  PetscFunctionBegin;
  at[0] = 2. * t - 1.;
  for (PetscInt d = 0; d < 2; ++d) x[d] = (1. - t) * m->x[2 * first + d] + t * m->x[2 * (first + m->order) + d];
  if (pair->straight) {
    for (PetscInt d = 0; d < 2; ++d) normal[d] = m->normal[d];
    if (o)
      at[1] = (2. * place - pair->place[1][second] - pair->place[1][second + o->order]) /
              (pair->place[1][second + o->order] - pair->place[1][second]);
  } else {
    for (PetscInt d = 0; d < 2; ++d)
      normal[d] = (1. - t) * pair->direction[2 * element[0] + d] + t * pair->direction[2 * element[0] + 2 + d];
    size = PetscSqrtReal(normal[0] * normal[0] + normal[1] * normal[1]);
    for (PetscInt d = 0; d < 2; ++d) normal[d] /= size;
    if (o) {
      const PetscReal *p = o->x + 2 * second, *q = o->x + 2 * (second + o->order), d[2] = {q[0] - p[0], q[1] - p[1]};
      const PetscReal  r[2] = {x[0] - p[0], x[1] - p[1]}, share = AbutCross_Private(r, normal) / AbutCross_Private(d, normal);

      at[1] = PetscMin(1., PetscMax(-1., 2. * share - 1.));
      y[0]  = p[0] + share * d[0];
      y[1]  = p[1] + share * d[1];
    }
  }
  PetscCall(AbutPairCurvedGap_Private(pair, x, y, normal, gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}
