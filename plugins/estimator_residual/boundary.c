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

/* The contact traction at the nodes of element e from the nodal contact forces f: lumped, the pressure -f.n / D and the tangential traction
   f.tau / D with D the integral of the node's function. At a node between two elements in contact one force is that of both: D is the sum,
   as far as they have one normal, and tau that of their mean; across a corner of 90 degrees tractions do not mix. */
static void SetContactTraction(const AbutBoundary *b, PetscInt e, PetscInt previous, const PetscReal w[], PetscReal traction[])
{
  PetscReal n[2], length = GetNormal(b, e, n);

  for (PetscInt k = 0; k <= b->order; ++k) {
    const PetscInt   other = k == 0 ? previous : k == b->order ? b->next[e] : e;
    const PetscReal *f     = b->contact + 2 * AbutBoundaryNode(b, e, k);
    PetscReal        D = 0.5 * w[k] * length, m[2], N[2] = {n[0] / length, n[1] / length}, size, shear;
    PetscBool        corner = PETSC_FALSE;

    if (other != e && IsContact(b, other)) {
      size = GetNormal(b, other, m);
      D += 0.5 * w[k] * PetscMax(0., (n[0] * m[0] + n[1] * m[1]) / length);
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
}

/* Known tractions at the nodes of each boundary element, [2*(order+1)*n] */
static PetscErrorCode GetTractions(const AbutBoundary *b, PetscReal traction[])
{
  PetscReal x[ABUT_ORDER_MAX + 1], w[ABUT_ORDER_MAX + 1];
  PetscInt *previous;

  PetscFunctionBegin;
  PetscCall(AbutGetLobattoNodes(b->order, x, w));
  PetscCall(PetscMalloc1(b->n, &previous));
  PetscCall(PetscArraycpy(traction, b->traction, 2 * (b->order + 1) * b->n));
  for (PetscInt e = 0; e < b->n; ++e) previous[b->next[e]] = e;
  for (PetscInt e = 0; e < b->n; ++e)
    if (IsContact(b, e)) SetContactTraction(b, e, previous[e], w, traction + 2 * (b->order + 1) * e);
  PetscCall(PetscFree(previous));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the integral of |t - s n|^2 over boundary element e, side k of cell c, divided by its length */
static PetscErrorCode IntegrateElement(AbutBody body, const AbutBoundary *b, PetscInt e, PetscInt c, PetscInt k, const PetscReal known[],
                                       const ResidualRule *rule, PetscReal *mean)
{
  PetscReal traction[2 * (ABUT_ORDER_MAX + 1)], N[ABUT_ORDER_MAX + 1];

  PetscFunctionBegin;
  PetscCall(ResidualGetTraction(body, c, k, 0., 1., rule, traction));
  for (PetscInt q = 0; q < rule->n; ++q) {
    PetscCall(AbutEvaluateLobatto(b->order, 2. * rule->s[q] - 1., N, NULL));
    for (PetscInt d = 0; d < 2; ++d) {
      PetscReal r = -traction[2 * q + d];

      if (b->condition[2 * e + d] == ABUT_DISPLACEMENT) continue;
      for (PetscInt i = 0; i <= b->order; ++i) r += N[i] * known[2 * i + d];
      *mean += rule->w[q] * PetscSqr(r);
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
  PetscCall(GetTractions(b, known));
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
