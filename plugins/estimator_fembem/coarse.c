#include "twolevel.h"

/* Neighbours under the same conditions, on one side and about in one direction are merged to one straight element of order 1; where there
   are too many corners for that, and then too many changes of conditions, regardless of these */
#define FEMBEM_COARSE_ELEMENTS 300 /* about: few enough for their dense system to cost less than the iterations it saves */
#define FEMBEM_COARSE_MOST     500 /* of at most 4 unknowns each, but 3 a contour */
#define FEMBEM_COARSE_COSINE   0.9 /* least, of the angle between the first element and another */

typedef enum {
  MERGE_STRAIGHT,
  MERGE_CORNERS,
  MERGE_ALL
} Merge;

static PetscBool BeginsGroup(const FembemSystem *s, Merge merge, PetscInt first, PetscInt e, PetscInt most)
{
  const AbutBoundary *g = s->b->given;

  if (e - first >= most) return PETSC_TRUE;
  for (PetscInt c = 0; merge < MERGE_ALL && c < 2; ++c)
    if (g->condition[2 * e + c] != g->condition[2 * first + c]) return PETSC_TRUE;
  if (merge > MERGE_STRAIGHT) return PETSC_FALSE;
  return (PetscBool)(g->side[e] != g->side[first] ||
                     FembemDot(s->e[e].t, s->e[first].t) < FEMBEM_COARSE_COSINE * s->e[e].h * s->e[first].h);
}

/* The first element of each group, group[ngroups] is their end; and the boundary's contours in groups */
static void FindGroups(const FembemSystem *s, Merge merge, PetscInt group[], PetscInt contour[], PetscInt *ngroups)
{
  const AbutBoundary *g    = s->b->given;
  const PetscInt      most = (g->n + FEMBEM_COARSE_ELEMENTS - 1) / FEMBEM_COARSE_ELEMENTS;

  *ngroups = 0;
  for (PetscInt c = 0; c < g->ncontours; ++c) {
    const PetscInt size = PetscMin(most, (g->contour[c + 1] - g->contour[c]) / 3); /* it stays a contour */

    contour[c] = *ngroups;
    for (PetscInt e = g->contour[c]; e < g->contour[c + 1]; ++e)
      if (e == g->contour[c] || BeginsGroup(s, merge, group[*ngroups - 1], e, size)) group[(*ngroups)++] = e;
  }
  contour[g->ncontours] = *ngroups;
  group[*ngroups]       = g->n;
}

static PetscErrorCode SetGiven(const FembemSystem *s, const PetscInt group[], PetscInt n, AbutBoundary *c)
{
  const AbutBoundary *g = s->b->given;

  PetscFunctionBegin;
  c->order = 1;
  c->n = c->nnodes = n;
  c->ncontours     = g->ncontours;
  PetscCall(PetscCalloc5(n, &c->next, 2 * n, &c->x, n, &c->side, 2 * n, &c->condition, 2 * n, &c->u));
  PetscCall(PetscCalloc3(4 * n, &c->traction, 2 * n, &c->reaction, 2 * n, &c->contact));
  for (PetscInt i = 0; i < n; ++i) {
    c->next[i] = i + 1;
    c->side[i] = g->side[group[i]];
    for (PetscInt d = 0; d < 2; ++d) {
      c->x[2 * i + d]         = g->x[2 * g->order * group[i] + d];
      c->condition[2 * i + d] = g->condition[2 * group[i] + d];
    }
  }
  for (PetscInt k = 0; k < c->ncontours; ++k) c->next[c->contour[k + 1] - 1] = c->contour[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Linear along the length of each group */
static PetscErrorCode SetWeights(const FembemSystem *s, const PetscInt group[], FembemCoarse *c)
{
  const PetscInt order = s->b->order;
  PetscReal      lobatto[ABUT_SIDE_NODES_MAX];

  PetscFunctionBegin;
  PetscCall(AbutGetLobattoNodes(order, lobatto, NULL));
  for (PetscInt g = 0; g < c->given.n; ++g) {
    PetscReal length = 0., before = 0.;

    for (PetscInt i = group[g]; i < group[g + 1]; ++i) length += s->e[i].h;
    for (PetscInt i = group[g]; i < group[g + 1]; before += s->e[i++].h)
      for (PetscInt k = 0; k < s->rows; ++k) {
        const PetscReal at = (before + 0.5 * (1. + lobatto[k / 2]) * s->e[i].h) / length;
        const PetscInt  t = s->tindex[s->rows * i + k], u = k / 2 < order ? s->uindex[2 * order * i + k] : -1;

        for (PetscInt end = 0; end < 2; ++end) {
          const PetscReal weight = end ? at : 1. - at;
          const PetscInt  node = end ? c->given.next[g] : g, ui = c->s.uindex[2 * node + k % 2];

          if (t >= 0) {
            c->from[end][t]   = c->s.tindex[4 * g + 2 * end + k % 2];
            c->weight[end][t] = weight;
          }
          if (u >= 0) {
            c->from[end][s->nt + u]   = ui < 0 ? -1 : c->s.nt + ui;
            c->weight[end][s->nt + u] = weight;
          }
        }
      }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FembemCoarseCreate(const FembemSystem *s, FembemCoarse *c)
{
  const FembemBoundary *b = s->b;
  const PetscInt        n = s->nt + s->nu;
  PetscInt             *group, ngroups;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(b->n + 1, &group));
  PetscCall(PetscMalloc1(b->given->ncontours + 1, &c->given.contour));
  FindGroups(s, MERGE_STRAIGHT, group, c->given.contour, &ngroups);
  for (PetscInt merge = MERGE_CORNERS; ngroups > FEMBEM_COARSE_MOST && merge <= MERGE_ALL; ++merge)
    FindGroups(s, (Merge)merge, group, c->given.contour, &ngroups);
  PetscCall(SetGiven(s, group, ngroups, &c->given));
  PetscCall(FembemBoundaryCreate(b->comm, &c->given, b->young, (3. - b->mat.kappa) / 4., &c->b));
  PetscCall(FembemSystemCreate(&c->b, s->scale, &c->s));
  PetscCall(FembemSystemFactor(&c->s, &c->positive)); /* chords that cross may spoil it; blocks are left */
  PetscCall(PetscMalloc4(n, &c->from[0], n, &c->from[1], n, &c->weight[0], n, &c->weight[1]));
  PetscCall(SetWeights(s, group, c));
  PetscCall(PetscFree(group));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FembemCoarseDestroy(FembemCoarse *c)
{
  PetscFunctionBegin;
  PetscCall(FembemSystemDestroy(&c->s));
  PetscCall(FembemBoundaryDestroy(&c->b));
  PetscCall(PetscFree(c->given.contour));
  PetscCall(PetscFree5(c->given.next, c->given.x, c->given.side, c->given.condition, c->given.u));
  PetscCall(PetscFree3(c->given.traction, c->given.reaction, c->given.contact));
  PetscCall(PetscFree4(c->from[0], c->from[1], c->weight[0], c->weight[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
