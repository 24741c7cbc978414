#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/

/* The boundary of a body gathered on every rank: it is one-dimensional, so it is small. Element sides are chained into closed contours with
   the body on the left; the trace of the finite-element mesh is the boundary-element mesh, eqs. (25), (26) of the paper. */

/* One element side as it travels */
typedef struct {
  PetscReal x[2];
  PetscInt  node[ABUT_SIDE_NODES_MAX], side;
} AbutElementSide;

/* All element sides on the boundary, from every rank, in the order of their start vertex */
static PetscErrorCode AbutBoundaryGather_Private(AbutBody body, PetscInt *n, AbutElementSide *all[])
{
  MPI_Comm                comm = PetscObjectComm((PetscObject)body);
  const AbutMeshTopology *t;
  AbutElementSide        *mine, *got;
  PetscMPIInt             size, bytes, *counts, *offsets;
  PetscInt               *key, *order;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscCalloc1(t->nsideedges, &mine));
  for (PetscInt e = 0; e < t->nsideedges; ++e) {
    const PetscInt *edge = t->sideedge + 3 * e;

    for (PetscInt d = 0; d < 2; ++d) mine[e].x[d] = t->x[2 * edge[0] + d];
    for (PetscInt k = 0; k <= t->order; ++k) mine[e].node[k] = t->global[t->unknown[t->sidenode[(t->order + 1) * e + k]]];
    mine[e].side = edge[2];
  }
  PetscCall(PetscMalloc2(size, &counts, size + 1, &offsets));
  bytes = (PetscMPIInt)(t->nsideedges * sizeof(*mine));
  PetscCallMPI(MPI_Allgather(&bytes, 1, MPI_INT, counts, 1, MPI_INT, comm));
  offsets[0] = 0;
  for (PetscMPIInt r = 0; r < size; ++r) offsets[r + 1] = offsets[r] + counts[r];
  *n = (PetscInt)(offsets[size] / (PetscMPIInt)sizeof(*mine));
  PetscCall(PetscMalloc1(*n, &got));
  PetscCallMPI(MPI_Allgatherv(mine, bytes, MPI_BYTE, got, counts, offsets, MPI_BYTE, comm));
  PetscCall(PetscMalloc1(*n, all));
  PetscCall(PetscMalloc2(*n, &key, *n, &order));
  for (PetscInt i = 0; i < *n; ++i) {
    key[i]   = got[i].node[0];
    order[i] = i;
  }
  PetscCall(PetscSortIntWithArray(*n, key, order));
  for (PetscInt i = 0; i < *n; ++i) (*all)[i] = got[order[i]];
  PetscCall(PetscFree2(key, order));
  PetscCall(PetscFree2(counts, offsets));
  PetscCall(PetscFree(got));
  PetscCall(PetscFree(mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The element that begins at a vertex */
static PetscInt AbutBoundaryFind_Private(PetscInt n, const AbutElementSide all[], PetscInt start)
{
  PetscInt low = 0, high = n - 1;

  while (low < high) {
    const PetscInt middle = (low + high) / 2;

    if (all[middle].node[0] < start) low = middle + 1;
    else high = middle;
  }
  return low;
}

/* Element k of the boundary is element side e; its nodes follow when those of all elements are there */
static void AbutBoundaryAppend_Private(const AbutElementSide *e, PetscInt k, AbutBoundary *b, PetscInt global[])
{
  b->side[k] = e->side;
  b->next[k] = k + 1;
  for (PetscInt i = 0; i < b->order; ++i) global[b->order * k + i] = e->node[i];
  for (PetscInt d = 0; d < 2; ++d) b->x[2 * b->order * k + d] = e->x[d];
}

/* Each contour begins at the lowest, then leftmost, node at which one side ends and the next begins, or, where it is one side all round, at
   the lowest, then leftmost, of all: the same for every distribution */
static PetscErrorCode AbutBoundaryChain_Private(PetscInt n, const AbutElementSide all[], AbutBoundary *b, PetscInt global[])
{
  PetscInt  *next, *previous, first, k = 0;
  PetscBool *used;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(n, &next, n, &previous, n, &used));
  for (PetscInt i = 0; i < n; ++i) {
    next[i] = AbutBoundaryFind_Private(n, all, all[i].node[b->order]);
    PetscCheck(all[next[i]].node[0] == all[i].node[b->order], PETSC_COMM_SELF, PETSC_ERR_PLIB, "The boundary of a body is not closed");
    previous[next[i]] = i;
    used[i]           = PETSC_FALSE;
  }
  b->ncontours = 0;
  while (k < n) {
    first = -1;
    for (PetscInt any = 0; any < 2 && first < 0; ++any)
      for (PetscInt i = 0; i < n; ++i) {
        if (used[i] || (!any && all[previous[i]].side == all[i].side)) continue;
        if (first < 0 || all[i].x[1] < all[first].x[1] || (all[i].x[1] == all[first].x[1] && all[i].x[0] < all[first].x[0])) first = i;
      }
    b->contour[b->ncontours++] = k;
    for (PetscInt i = first; !used[i]; i = next[i]) {
      used[i] = PETSC_TRUE;
      AbutBoundaryAppend_Private(&all[i], k++, b, global);
    }
    b->next[k - 1] = b->contour[b->ncontours - 1];
  }
  b->contour[b->ncontours] = n;
  PetscCall(PetscFree3(next, previous, used));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes inside the elements, which are straight */
static PetscErrorCode AbutBoundaryPlaceNodes_Private(AbutBoundary *b)
{
  PetscReal line[ABUT_SIDE_NODES_MAX];

  PetscFunctionBegin;
  PetscCall(AbutGetLobattoNodes(b->order, line, NULL));
  for (PetscInt i = 0; i < b->n; ++i)
    for (PetscInt k = 1; k < b->order; ++k)
      for (PetscInt d = 0; d < 2; ++d) {
        const PetscReal s = 0.5 * (1. + line[k]);

        b->x[2 * AbutBoundaryNode(b, i, k) + d] = (1. - s) * b->x[2 * AbutBoundaryNode(b, i, 0) + d] +
                                                  s * b->x[2 * AbutBoundaryNode(b, i, b->order) + d];
      }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutBoundaryCreate_Private(PetscInt order, PetscInt n, AbutBoundary **b)
{
  const PetscInt nodes = order * n;

  PetscFunctionBegin;
  PetscCall(PetscNew(b));
  (*b)->order  = order;
  (*b)->n      = n;
  (*b)->nnodes = nodes;
  PetscCall(PetscCalloc5(n + 1, &(*b)->contour, n, &(*b)->next, 2 * nodes, &(*b)->x, n, &(*b)->side, 2 * n, &(*b)->condition));
  PetscCall(PetscCalloc4(2 * nodes, &(*b)->u, 2 * (order + 1) * n, &(*b)->traction, 2 * nodes, &(*b)->reaction, 2 * nodes, &(*b)->contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBoundaryDestroy - Frees what `AbutBodyGetBoundary()` gave

   Not Collective

   Input Parameter:
.  b - the boundary; set to `NULL`

   Level: intermediate

.seealso: `AbutBodyGetBoundary()`
@*/
PetscErrorCode AbutBoundaryDestroy(AbutBoundary **b)
{
  PetscFunctionBegin;
  if (!*b) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree5((*b)->contour, (*b)->next, (*b)->x, (*b)->side, (*b)->condition));
  PetscCall(PetscFree4((*b)->u, (*b)->traction, (*b)->reaction, (*b)->contact));
  PetscCall(PetscFree(*b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutBodyBoundarySetUp_Private(AbutBody body)
{
  AbutElementSide *all;
  AbutBoundary    *b;
  PetscInt         n, order;
  IS               from;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetOrder(body->mesh, &order));
  PetscCall(AbutBoundaryGather_Private(body, &n, &all));
  PetscCall(AbutBoundaryCreate_Private(order, n, &body->boundary));
  b = body->boundary;
  PetscCall(PetscMalloc1(b->nnodes, &body->boundaryglobal));
  PetscCall(AbutBoundaryChain_Private(n, all, b, body->boundaryglobal));
  PetscCall(AbutBoundaryPlaceNodes_Private(b));
  PetscCall(PetscFree(all));
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, 2 * b->nnodes, &body->onboundary));
  PetscCall(ISCreateBlock(PETSC_COMM_SELF, 2, b->nnodes, body->boundaryglobal, PETSC_COPY_VALUES, &from));
  PetscCall(VecScatterCreate(body->load, from, body->onboundary, NULL, &body->toboundary));
  PetscCall(ISDestroy(&from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutBodyBoundaryReset_Private(AbutBody body)
{
  PetscFunctionBegin;
  for (PetscInt s = 0; s < ABUT_MAX_SIDES; ++s) {
    AbutSide *side = &body->side[s];

    PetscCall(PetscFree4(side->x, side->normal, side->global, side->fixed));
    side->n = 0;
  }
  PetscCall(AbutBoundaryDestroy(&body->boundary));
  PetscCall(PetscFree(body->boundaryglobal));
  PetscCall(VecScatterDestroy(&body->toboundary));
  PetscCall(VecDestroy(&body->onboundary));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The values of a vector of unknowns at all boundary nodes, [2*n], on every rank; collective */
PetscErrorCode AbutBodyGatherBoundary_Private(AbutBody body, Vec v, const PetscReal *value[])
{
  PetscFunctionBegin;
  PetscCall(VecScatterBegin(body->toboundary, v, body->onboundary, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(body->toboundary, v, body->onboundary, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGetArrayRead(body->onboundary, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutBodyUngatherBoundary_Private(AbutBody body, const PetscReal *value[])
{
  PetscFunctionBegin;
  PetscCall(VecRestoreArrayRead(body->onboundary, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* K u - f at the prescribed unknowns, zero elsewhere */
PetscErrorCode AbutBodyCreateReaction_Private(AbutBody body, Vec *reaction)
{
  Vec                held, u;
  const PetscScalar *h, *load, *contact;
  PetscScalar       *r;
  const PetscInt    *row;
  PetscInt           n, first;

  PetscFunctionBegin;
  PetscCall(VecDuplicate(body->load, reaction));
  PetscCall(VecDuplicate(body->prescribed, &held));
  PetscCall(AbutBodyGetGroupVec_Private(body, body->u, &u));
  PetscCall(MatMult(body->Ac, u, held));
  PetscCall(AbutBodyRestoreGroupVec_Private(body, body->u, &u));
  PetscCall(VecGetOwnershipRange(*reaction, &first, NULL));
  PetscCall(ISGetLocalSize(body->constrained, &n));
  PetscCall(ISGetIndices(body->constrained, &row));
  PetscCall(VecGetArrayRead(held, &h));
  PetscCall(VecGetArrayRead(body->load, &load));
  PetscCall(VecGetArrayRead(body->contact, &contact));
  PetscCall(VecGetArray(*reaction, &r));
  for (PetscInt i = 0; i < n; ++i) r[row[i] - first] = h[i] - load[row[i] - first] - contact[row[i] - first];
  PetscCall(VecRestoreArray(*reaction, &r));
  PetscCall(VecRestoreArrayRead(body->contact, &contact));
  PetscCall(VecRestoreArrayRead(body->load, &load));
  PetscCall(VecRestoreArrayRead(held, &h));
  PetscCall(ISRestoreIndices(body->constrained, &row));
  PetscCall(VecDestroy(&held));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetReaction - Sum of the forces that hold a body, and of those that load it

   Collective

   Input Parameter:
.  body - the body, solved

   Output Parameters:
+  reaction - [2] sum of the reactions, those of springs too, stress times length; with axial symmetry over the circumference, 0 along x
-  applied  - [2] sum of loads and contact forces; in equilibrium the two cancel

   Level: intermediate

.seealso: `AbutBodySolve()`
@*/
PetscErrorCode AbutBodyGetReaction(AbutBody body, PetscReal reaction[2], PetscReal applied[2])
{
  Vec       r;
  PetscReal contact[2], springs[2], work;

  PetscFunctionBegin;
  PetscCall(AbutBodyCreateReaction_Private(body, &r));
  PetscCall(AbutBodyGetFoundationForce_Private(body, springs, &work));
  for (PetscInt d = 0; d < 2; ++d) {
    PetscCall(VecStrideSum(r, d, &reaction[d]));
    PetscCall(VecStrideSum(body->load, d, &applied[d]));
    PetscCall(VecStrideSum(body->contact, d, &contact[d]));
    applied[d] += contact[d];
    reaction[d] += springs[d];
  }
  if (body->kinematics == ABUT_AXISYMMETRIC) reaction[0] = applied[0] = 0.; /* what points away from the axis has no resultant */
  PetscCall(VecDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* L2 projection of a given traction on element i: the element's mass matrix times its values at the nodes are its moments */
static PetscErrorCode AbutBoundaryProjectTraction_Private(AbutBody body, AbutBoundary *b, PetscInt i, PetscInt d)
{
  const PetscInt   n = b->order + 1;
  const PetscReal *p = b->x + 2 * AbutBoundaryNode(b, i, 0), *q = b->x + 2 * AbutBoundaryNode(b, i, b->order),
                  half = 0.5 * PetscSqrtReal(PetscSqr(q[0] - p[0]) + PetscSqr(q[1] - p[1]));
  PetscReal m[ABUT_SIDE_NODES_MAX], inverse[ABUT_SIDE_NODES_MAX * ABUT_SIDE_NODES_MAX];

  PetscFunctionBegin;
  PetscCall(AbutBodyEdgeMoments_Private(body, b->side[i], d, p, q, PETSC_FALSE, m));
  PetscCall(AbutGetLobattoMassInverse(b->order, inverse));
  for (PetscInt k = 0; k < n; ++k)
    for (PetscInt j = 0; j < n; ++j) b->traction[2 * (n * i + k) + d] += inverse[n * k + j] * m[j] / half;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyGetBoundary - The whole boundary of a body after a solve, gathered on every rank

   Collective

   Input Parameter:
.  body - the body, solved

   Output Parameter:
.  boundary - nodes, displacements, conditions, tractions and nodal forces; free it with `AbutBoundaryDestroy()`

   Level: intermediate

.seealso: `AbutBoundaryDestroy()`, `AbutBodyGetSide()`
@*/
PetscErrorCode AbutBodyGetBoundary(AbutBody body, AbutBoundary **boundary)
{
  const AbutBoundary *skeleton = body->boundary;
  const PetscInt      n = skeleton->n, nodes = skeleton->nnodes;
  AbutBoundary       *b;
  Vec                 reaction;
  const PetscReal    *value;

  PetscFunctionBegin;
  PetscCall(AbutBoundaryCreate_Private(skeleton->order, n, &b));
  *boundary    = b;
  b->ncontours = skeleton->ncontours;
  PetscCall(PetscArraycpy(b->contour, skeleton->contour, b->ncontours + 1));
  PetscCall(PetscArraycpy(b->next, skeleton->next, n));
  PetscCall(PetscArraycpy(b->x, skeleton->x, 2 * nodes));
  PetscCall(PetscArraycpy(b->side, skeleton->side, n));
  PetscCall(AbutBodyLogHooks_Private(body, ABUT_HOOK_TRACTION, -1, PETSC_TRUE));
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt d = 0; d < 2; ++d) {
      b->condition[2 * i + d] = body->condition[b->side[i]][d].type;
      PetscCall(AbutBoundaryProjectTraction_Private(body, b, i, d));
    }
  PetscCall(AbutBodyLogHooks_Private(body, ABUT_HOOK_TRACTION, -1, PETSC_FALSE));
  for (PetscInt k = 0; k < 2 * (b->order + 1) * n; ++k) b->traction[k] *= body->factor;
  PetscCall(AbutBodyGatherBoundary_Private(body, body->u, &value));
  PetscCall(PetscArraycpy(b->u, value, 2 * nodes));
  PetscCall(AbutBodyUngatherBoundary_Private(body, &value));
  PetscCall(AbutBodyAddFoundationTraction_Private(body, b));
  PetscCall(AbutBodyGatherBoundary_Private(body, body->contact, &value));
  PetscCall(PetscArraycpy(b->contact, value, 2 * nodes));
  PetscCall(AbutBodyUngatherBoundary_Private(body, &value));
  PetscCall(AbutBodyCreateReaction_Private(body, &reaction));
  PetscCall(AbutBodyGatherBoundary_Private(body, reaction, &value));
  PetscCall(PetscArraycpy(b->reaction, value, 2 * nodes));
  PetscCall(AbutBodyUngatherBoundary_Private(body, &value));
  PetscCall(VecDestroy(&reaction));
  PetscFunctionReturn(PETSC_SUCCESS);
}
