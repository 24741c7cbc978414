#include "residual.h"

/* Jumps of the traction across the sides inside a body: 1/2 h/p |[s n]|^2 for each of the two cells, h its height above the side. The
   coarse cell above a hanging side has a jump on each half of its side. */

PetscErrorCode ResidualGetTraction(AbutBody body, PetscInt c, PetscInt k, PetscReal from, PetscReal to, const ResidualRule *rule,
                                   PetscReal traction[])
{
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  const PetscReal        *node, *a, *b, *p, *q;
  PetscReal               n[2], length;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(AbutMeshGetReferenceNodes(mesh, &node));
  a      = node + 2 * k;
  b      = node + 2 * ((k + 1) % t->corners);
  p      = t->x + 2 * t->cell[t->corners * c + k];
  q      = t->x + 2 * t->cell[t->corners * c + (k + 1) % t->corners];
  length = PetscSqrtReal(PetscSqr(q[0] - p[0]) + PetscSqr(q[1] - p[1]));
  n[0]   = (q[1] - p[1]) / length; /* outward, corners go counter-clockwise */
  n[1]   = (p[0] - q[0]) / length;
  for (PetscInt i = 0; i < rule->n; ++i) {
    const PetscReal at = from + rule->s[i] * (to - from), xi[2] = {a[0] + at * (b[0] - a[0]), a[1] + at * (b[1] - a[1])};
    PetscReal       s[3];

    PetscCall(AbutBodyGetCellStress(body, c, xi, s));
    traction[2 * i]     = s[0] * n[0] + s[2] * n[1];
    traction[2 * i + 1] = s[2] * n[0] + s[1] * n[1];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ResidualGetThickness(AbutBody body, PetscInt c, PetscInt k, PetscReal from, PetscReal to, const ResidualRule *rule,
                                    PetscReal thickness[])
{
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  const PetscReal        *p, *q;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  p = t->x + 2 * t->cell[t->corners * c + k];
  q = t->x + 2 * t->cell[t->corners * c + (k + 1) % t->corners];
  for (PetscInt i = 0; i < rule->n; ++i) {
    const PetscReal at = from + rule->s[i] * (to - from), x[2] = {p[0] + at * (q[0] - p[0]), p[1] + at * (q[1] - p[1])};

    PetscCall(AbutBodyGetThickness(body, x, &thickness[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ResidualGetHeight(AbutMesh mesh, PetscInt c, PetscInt k, PetscReal *height, PetscReal *length)
{
  const AbutMeshTopology *t;
  const PetscReal        *p, *q;
  PetscReal               area;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(AbutMeshGetCellArea(mesh, c, &area));
  p       = t->x + 2 * t->cell[t->corners * c + k];
  q       = t->x + 2 * t->cell[t->corners * c + (k + 1) % t->corners];
  *length = PetscSqrtReal(PetscSqr(q[0] - p[0]) + PetscSqr(q[1] - p[1]));
  *height = (t->corners == 3 ? 2. : 1.) * area / *length;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A piece of a cell's side behind which there is one other cell */
typedef struct {
  PetscInt  slot;     /* 2e for the whole side e or its first half, 2e+1 for its second half */
  PetscReal from, to; /* in the direction of side e, which may be the opposite of the cell's */
} Piece;

typedef struct {
  const AbutMeshTopology *t;
  PetscReal              *split; /* [nedges] above 0 for a side with hanging ones below it */
  PetscBool              *outer; /* [nedges] on the boundary of the body */
} Sides;

static PetscErrorCode SidesCreate(AbutMesh mesh, const AbutMeshTopology *t, Sides *sides)
{
  PetscFunctionBegin;
  sides->t = t;
  PetscCall(PetscCalloc2(t->nedges, &sides->split, t->nedges, &sides->outer));
  for (PetscInt i = 0; i < t->corners * t->ncells; ++i) {
    const PetscInt parent = t->edgeparent[2 * t->celledge[i]];

    if (parent >= 0) sides->split[parent] = 1.;
  }
  PetscCall(AbutMeshSumAtEdges(mesh, 1, sides->split));
  for (PetscInt i = 0; i < t->nsideedges; ++i) {
    const PetscInt c = t->sidecell[i];

    for (PetscInt k = 0; k < t->corners; ++k)
      if (t->cell[t->corners * c + k] == t->sideedge[3 * i]) sides->outer[t->celledge[t->corners * c + k]] = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pieces of side k of a cell, none on the boundary */
static PetscInt SidesGetPieces(const Sides *sides, PetscInt c, PetscInt k, Piece piece[2])
{
  const AbutMeshTopology *t = sides->t;
  const PetscInt          e = t->celledge[t->corners * c + k], parent = t->edgeparent[2 * e], n = sides->split[e] > 0. ? 2 : 1;
  const PetscBool         forward = (PetscBool)(t->cell[t->corners * c + k] == t->edge[2 * e]);

  if (sides->outer[e]) return 0;
  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal from = (PetscReal)i / n, to = (PetscReal)(i + 1) / n;

    piece[i].slot = parent < 0 ? 2 * e + i : 2 * parent + t->edgeparent[2 * e + 1];
    piece[i].from = forward ? from : 1. - from;
    piece[i].to   = forward ? to : 1. - to;
  }
  return n;
}

static PetscErrorCode SidesDestroy(Sides *sides)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(sides->split, sides->outer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ResidualAddJumps(AbutBody body, const ResidualRule *rule, PetscReal square[])
{
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  Sides                   sides;
  Piece                   piece[2];
  PetscReal              *jump, traction[2 * (ABUT_ORDER_MAX + 1)], thickness[ABUT_ORDER_MAX + 1], height, length;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(SidesCreate(mesh, t, &sides));
  PetscCall(PetscCalloc1(4 * rule->n * t->nedges, &jump)); /* each cell adds the traction with its own outward normal */
  for (PetscInt i = 0; i < t->corners * t->ncells; ++i) {
    const PetscInt n = SidesGetPieces(&sides, i / t->corners, i % t->corners, piece);

    for (PetscInt j = 0; j < n; ++j) {
      PetscCall(ResidualGetTraction(body, i / t->corners, i % t->corners, piece[j].from, piece[j].to, rule, traction));
      for (PetscInt q = 0; q < 2 * rule->n; ++q) jump[2 * rule->n * piece[j].slot + q] += traction[q];
    }
  }
  PetscCall(AbutMeshSumAtEdges(mesh, 4 * rule->n, jump));
  for (PetscInt i = 0; i < t->corners * t->ncells; ++i) {
    const PetscInt n = SidesGetPieces(&sides, i / t->corners, i % t->corners, piece);

    PetscCall(ResidualGetHeight(mesh, i / t->corners, i % t->corners, &height, &length));
    for (PetscInt j = 0; j < n; ++j) {
      PetscCall(ResidualGetThickness(body, i / t->corners, i % t->corners, piece[j].from, piece[j].to, rule, thickness));
      for (PetscInt q = 0; q < 2 * rule->n; ++q)
        square[i / t->corners] += 0.5 * height * length / n / t->order * rule->w[q / 2] * thickness[q / 2] *
                                  PetscSqr(jump[2 * rule->n * piece[j].slot + q]);
    }
  }
  PetscCall(PetscFree(jump));
  PetscCall(SidesDestroy(&sides));
  PetscFunctionReturn(PETSC_SUCCESS);
}
