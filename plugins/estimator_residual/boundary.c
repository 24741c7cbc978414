#include "residual.h"

/* Sides on the boundary: h/p |t - s n|^2, h the height of the cell above the side, in the components where no displacement is given.
   There t is the given traction, in its L2 projection on the elements, or that of the contact pressure. */

/* Which boundary element each local element side on the boundary is */
static PetscErrorCode FindElements(AbutBody body, const AbutMeshTopology *t, const AbutBoundary *b, PetscInt element[])
{
  PetscInt *start, *order, i = 0, at;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(b->n, &start, b->n, &order));
  while (i < b->n) { /* a side is one piece of a contour */
    const AbutSide *side;
    const PetscInt  first = i, number = b->side[i];

    PetscCall(AbutBodyGetSide(body, number, &side));
    for (; i < b->n && b->side[i] == number; ++i) {
      start[i] = side->global[b->order * (i - first)];
      order[i] = i;
    }
  }
  PetscCall(PetscSortIntWithArray(b->n, start, order));
  for (PetscInt e = 0; e < t->nsideedges; ++e) {
    PetscCall(PetscFindInt(t->global[t->unknown[t->sideedge[3 * e]]], b->n, start, &at));
    PetscCheck(at >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "An element side on the boundary is not in the boundary of the body");
    element[e] = order[at];
  }
  PetscCall(PetscFree2(start, order));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Outward normal of a boundary element, times its length */
static PetscReal GetNormal(const AbutBoundary *b, PetscInt e, PetscReal n[2])
{
  const PetscReal *p = b->x + 2 * AbutBoundaryNode(b, e, 0), *q = b->x + 2 * AbutBoundaryNode(b, e, b->order);

  n[0] = q[1] - p[1];
  n[1] = p[0] - q[0];
  return PetscSqrtReal(PetscSqr(n[0]) + PetscSqr(n[1]));
}

static PetscBool IsContact(const AbutBoundary *b, PetscInt e)
{
  return (PetscBool)(b->condition[2 * e] == ABUT_CONTACT || b->condition[2 * e + 1] == ABUT_CONTACT);
}

/* The mean of the body's thickness with the function of node k of element e: that at the node, or beside it if the order is 1 */
static PetscErrorCode GetNodeThickness(AbutBody body, const AbutBoundary *b, PetscInt e, PetscInt k, PetscReal *thickness)
{
  PetscReal other;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetThickness(body, b->x + 2 * AbutBoundaryNode(b, e, k), thickness));
  if (b->order > 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutBodyGetThickness(body, b->x + 2 * AbutBoundaryNode(b, e, !k), &other));
  *thickness = (2. * *thickness + other) / 3.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At an end on an axis of symmetry the node's function has no integral from order 2 on: the polynomial through the other nodes */
static void ExtrapolateTraction(PetscInt order, PetscInt end, const PetscReal x[], PetscReal traction[])
{
  traction[2 * end] = traction[2 * end + 1] = 0.;
  for (PetscInt j = 0; j <= order; ++j) {
    PetscReal l = j == end ? 0. : 1.;

    for (PetscInt i = 0; i <= order; ++i)
      if (i != j && i != end) l *= (x[end] - x[i]) / (x[j] - x[i]);
    for (PetscInt d = 0; j != end && d < 2; ++d) traction[2 * end + d] += l * traction[2 * j + d];
  }
}

/* The contact traction at the nodes of element e from the nodal contact forces f: lumped, the pressure -f.n / D and the tangential traction
   f.tau / D with D the integral of the node's function. At a node between two elements in contact one force is that of both: D is the sum,
   as far as they have one normal, and tau that of their mean; across a corner of 90 degrees tractions do not mix. */
static PetscErrorCode SetContactTraction(AbutBody body, const AbutBoundary *b, PetscInt e, PetscInt previous, const PetscReal x[],
                                         const PetscReal w[], PetscReal traction[])
{
  PetscReal n[2], m[2], length = GetNormal(b, e, n), thickness, across;
  PetscInt  axis = -1;

  PetscFunctionBegin;
  for (PetscInt k = 0; k <= b->order; ++k) {
    const PetscInt   other = k == 0 ? previous : k == b->order ? b->next[e] : e;
    const PetscReal *f     = b->contact + 2 * AbutBoundaryNode(b, e, k);
    PetscReal        D, N[2] = {n[0] / length, n[1] / length}, size, shear;
    PetscBool        corner = PETSC_FALSE;

    PetscCall(GetNodeThickness(body, b, e, k, &thickness));
    PetscCall(GetNodeThickness(body, b, e, b->order - k, &across));
    D = 0.5 * w[k] * length * thickness;
    if (thickness <= 1e-10 * across) {
      axis = k;
      continue;
    }
    if (other != e && IsContact(b, other)) {
      size = GetNormal(b, other, m);
      PetscCall(GetNodeThickness(body, b, other, k ? 0 : b->order, &thickness));
      D += 0.5 * w[k] * PetscMax(0., (n[0] * m[0] + n[1] * m[1]) / length) * thickness;
      if (n[0] * m[0] + n[1] * m[1] < 0.5 * length * size) corner = PETSC_TRUE;
      for (PetscInt d = 0; d < 2; ++d) N[d] += m[d] / size;
    }
    size  = PetscSqrtReal(PetscSqr(N[0]) + PetscSqr(N[1]));
    shear = corner ? 0. : (f[1] * N[0] - f[0] * N[1]) / size; /* a force of both sides of a corner is not to be told apart */
    for (PetscInt d = 0; d < 2; ++d) {
      if (b->condition[2 * e + d] != ABUT_CONTACT) continue;
      traction[2 * k + d] = (f[0] * n[0] + f[1] * n[1]) / D * n[d] / PetscSqr(length) + shear / D * (d ? n[0] : -n[1]) / length;
    }
  }
  if (axis >= 0) ExtrapolateTraction(b->order, axis, x, traction);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Known tractions at the nodes of each boundary element, [2*(order+1)*n] */
static PetscErrorCode GetTractions(AbutBody body, const AbutBoundary *b, PetscReal traction[])
{
  PetscReal x[ABUT_ORDER_MAX + 1], w[ABUT_ORDER_MAX + 1];
  PetscInt *previous;

  PetscFunctionBegin;
  PetscCall(AbutGetLobattoNodes(b->order, x, w));
  PetscCall(PetscMalloc1(b->n, &previous));
  PetscCall(PetscArraycpy(traction, b->traction, 2 * (b->order + 1) * b->n));
  for (PetscInt e = 0; e < b->n; ++e) previous[b->next[e]] = e;
  for (PetscInt e = 0; e < b->n; ++e)
    if (IsContact(b, e)) PetscCall(SetContactTraction(body, b, e, previous[e], x, w, traction + 2 * (b->order + 1) * e));
  PetscCall(PetscFree(previous));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the integral of |t - s n|^2 over boundary element e, side k of cell c, divided by its length */
static PetscErrorCode IntegrateElement(AbutBody body, const AbutBoundary *b, PetscInt e, PetscInt c, PetscInt k, const PetscReal known[],
                                       const ResidualRule *rule, PetscReal *mean)
{
  PetscReal traction[2 * (ABUT_ORDER_MAX + 1)], thickness[ABUT_ORDER_MAX + 1], N[ABUT_ORDER_MAX + 1];

  PetscFunctionBegin;
  PetscCall(ResidualGetTraction(body, c, k, 0., 1., rule, traction));
  PetscCall(ResidualGetThickness(body, c, k, 0., 1., rule, thickness));
  for (PetscInt q = 0; q < rule->n; ++q) {
    PetscCall(AbutEvaluateLobatto(b->order, 2. * rule->s[q] - 1., N, NULL));
    for (PetscInt d = 0; d < 2; ++d) {
      PetscReal r = -traction[2 * q + d];

      if (b->condition[2 * e + d] == ABUT_DISPLACEMENT) continue;
      for (PetscInt i = 0; i <= b->order; ++i) r += N[i] * known[2 * i + d];
      *mean += rule->w[q] * thickness[q] * PetscSqr(r);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ResidualAddBoundary(AbutBody body, const ResidualRule *rule, PetscReal square[])
{
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  AbutBoundary           *b;
  PetscInt               *element;
  PetscReal              *known, height, length;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(AbutBodyGetBoundary(body, &b));
  PetscCall(PetscMalloc2(t->nsideedges, &element, 2 * (b->order + 1) * b->n, &known));
  PetscCall(FindElements(body, t, b, element));
  PetscCall(GetTractions(body, b, known));
  for (PetscInt i = 0; i < t->nsideedges; ++i) {
    const PetscInt c = t->sidecell[i], e = element[i];
    PetscInt       k    = 0;
    PetscReal      mean = 0.;

    while (t->cell[t->corners * c + k] != t->sideedge[3 * i]) ++k;
    PetscCall(IntegrateElement(body, b, e, c, k, known + 2 * (b->order + 1) * e, rule, &mean));
    PetscCall(ResidualGetHeight(mesh, c, k, &height, &length));
    square[c] += height * length / b->order * mean;
  }
  PetscCall(PetscFree2(element, known));
  PetscCall(AbutBoundaryDestroy(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}
