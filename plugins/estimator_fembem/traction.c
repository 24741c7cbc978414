#include "chain.h"
#include <petscblaslapack.h>

/*
   From nodal forces to tractions, one component at a time. The part of the boundary where that component of the displacement (or contact)
   is prescribed is cut into pieces at corners and where the condition changes; in a piece the traction t is continuous and M t = r, M the
   boundary mass matrix of the order of the elements, r the nodal forces. At a node between two pieces one force r feeds two end values:
   r/2 + beta goes to the piece before it, r/2 - beta to the one behind it, and the betas minimise the kinks of t in the two elements next
   to each such end. A closed contour without a corner is cut at its first node, where beta closes it again.
*/
#define FEMBEM_SHARES_DENSE 64    /* betas up to which their problem is dense: for few, gelss is as fast and knows any rank */
#define FEMBEM_SHARES_RANK  1e-10 /* relative: what is determined by less is not */

typedef struct {
  PetscInt          first, n; /* elements: first, the one after it, ... */
  AbutConditionType type;     /* ABUT_DISPLACEMENT or ABUT_CONTACT */
  PetscInt          share[2]; /* the betas at its start and end, -1 if none */
  PetscReal        *t;        /* [3*(order*n+1)] the known part, and what a unit force at the start and at the end adds */
} Piece;

typedef struct {
  FembemBoundary *b;
  PetscInt        c; /* component */
  PetscInt        npieces, nshares;
  Piece          *piece;                   /* [n] */
  PetscInt       *share;                   /* [n] beta of the start of each element, -1 if none */
  PetscInt       *firstpiece, *firstshare; /* [contours+1] */
  PetscReal      *value;                   /* [3*(order+1)*n] room for the t of the pieces */
} Recovery;

static inline AbutConditionType ConditionOf(const Recovery *r, PetscInt e)
{
  return r->b->given->condition[2 * e + r->c];
}

/* Does a new piece begin with element e: another condition, a sharp corner, or a less sharp one between two named sides */
static PetscBool IsCut(const Recovery *r, PetscInt e)
{
  const FembemBoundary *b      = r->b;
  const PetscInt        p      = b->previous[e];
  const PetscComplex    start  = FembemStart(b, e);
  const PetscReal       cosine = FembemDot(start - FembemStart(b, p), FembemStart(b, b->next[e]) - start) /
                           (FembemLength(b, p) * FembemLength(b, e));

  if (ConditionOf(r, e) != ConditionOf(r, p)) return PETSC_TRUE;
  return cosine < 0.5 || (cosine < 0.99 && b->given->side[e] != b->given->side[p]) ? PETSC_TRUE : PETSC_FALSE;
}

/* Does one force feed the pieces on both sides of the start of element e? Reactions and contact forces are kept apart, except at a node
   held in the direction in which contact acts: no contact force is computed there, the reaction holds both parts */
static PetscBool IsShared(const Recovery *r, PetscInt e)
{
  const PetscInt          p       = r->b->previous[e];
  const AbutConditionType type[2] = {ConditionOf(r, p), ConditionOf(r, e)};
  const PetscInt          contact = type[0] == ABUT_CONTACT ? p : e;
  const PetscComplex      t       = FembemStart(r->b, r->b->next[contact]) - FembemStart(r->b, contact);
  const PetscReal         normal  = (r->c ? PetscRealPartComplex(t) : PetscImaginaryPartComplex(t)) / FembemLength(r->b, contact);

  if (type[0] == ABUT_TRACTION || type[1] == ABUT_TRACTION) return PETSC_FALSE;
  return type[0] == type[1] || PetscAbsReal(normal) > 1e-3 ? PETSC_TRUE : PETSC_FALSE;
}

/* The force at node j of element e that the finite elements balance with the tractions of this piece */
static PetscReal NodalForce(const Recovery *r, AbutConditionType type, PetscInt e, PetscInt j)
{
  const AbutBoundary *g = r->b->given;
  const PetscInt      k = 2 * (r->b->order * e + j) + r->c;

  if (!j && r->share[e] >= 0) return 0.5 * (g->reaction[k] + g->contact[k]);
  return type == ABUT_CONTACT ? g->contact[k] : g->reaction[k];
}

/* Walks round each contour, from a cut if there is one */
static void FindPieces(Recovery *r)
{
  const AbutBoundary *g    = r->b->given;
  const PetscInt     *next = r->b->next;
  PetscReal          *room = r->value;

  r->npieces = r->nshares = 0;
  for (PetscInt i = 0; i < r->b->n; ++i) r->share[i] = -1;
  for (PetscInt k = 0; k < g->ncontours; ++k) {
    PetscInt start = g->contour[k], e;

    while (start < g->contour[k + 1] && !IsCut(r, start)) ++start;
    if (start == g->contour[k + 1]) start = g->contour[k];
    r->firstpiece[k] = r->npieces;
    r->firstshare[k] = r->nshares;
    e                = start;
    do {
      if (ConditionOf(r, e) != ABUT_TRACTION) {
        if (e == start || IsCut(r, e)) {
          r->piece[r->npieces++] = (Piece){.first = e, .n = 0, .type = ConditionOf(r, e)};
          if (IsShared(r, e)) r->share[e] = r->nshares++;
        }
        ++r->piece[r->npieces - 1].n;
      }
      e = next[e];
    } while (e != start);
  }
  r->firstpiece[g->ncontours] = r->npieces;
  r->firstshare[g->ncontours] = r->nshares;
  for (PetscInt k = 0; k < r->npieces; ++k) {
    Piece   *p   = &r->piece[k];
    PetscInt end = p->first;

    for (PetscInt i = 0; i < p->n; ++i) end = next[end];
    p->share[0] = r->share[p->first];
    p->share[1] = r->share[end];
    p->t        = room;
    room += 3 * (r->b->order * p->n + 1);
  }
}

/* M t = r in one piece, for three right-hand sides */
static PetscErrorCode SolvePiece(const Recovery *r, Piece *p)
{
  const FembemBoundary *b    = r->b;
  const PetscInt        band = b->order, m = band * p->n + 1;
  PetscInt              e = p->first;
  PetscReal            *M, *t = p->t;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1((band + 1) * m, &M));
  PetscCall(PetscArrayzero(t, 3 * m));
  t[m] = t[3 * m - 1] = 1.;
  for (PetscInt i = 0; i < p->n; ++i, e = b->next[e]) {
    for (PetscInt j = 0; j <= band; ++j) {
      if (j < band) t[band * i + j] = NodalForce(r, p->type, e, j);
      for (PetscInt k = 0; k <= j; ++k) M[(band + 1) * (band * i + k) + j - k] += 0.5 * FembemLength(b, e) * b->basis.mass[j][k];
    }
  }
  t[m - 1] = NodalForce(r, p->type, e, 0);
  PetscCall(AbutSolveBand(m, band, M, 3, t));
  PetscCall(PetscFree(M));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool IsClosed(const Recovery *r, const Piece *p)
{
  return p->share[0] >= 0 && p->share[0] == p->share[1] && !IsCut(r, p->first) ? PETSC_TRUE : PETSC_FALSE;
}

/* How much the highest derivative of t, its slope at order 1, changes between the first (or last) two elements of a piece, for each of its
   three parts. Of one element: how far t is from a lower degree; where the piece closes a contour: how much t itself changes */
static void Kink(const Recovery *r, const Piece *p, PetscBool atend, PetscReal kink[3])
{
  const FembemBoundary *b     = r->b;
  const PetscReal      *c     = b->basis.coefficient[b->order];
  const PetscInt        first = atend ? PetscMax(0, p->n - 2) : 0, m = b->order * p->n + 1; /* of the two elements */
  PetscReal             h[2] = {1., 1.}, power[2];
  PetscInt              e    = p->first;

  for (PetscInt i = 0; i < p->n; ++i, e = b->next[e])
    if (i - first == 0 || i - first == 1) h[i - first] = FembemLength(b, e);
  for (PetscInt k = 0; k < 2; ++k) power[k] = PetscPowRealInt((h[0] + h[1]) / h[k], b->order);
  for (PetscInt k = 0; k < 3; ++k) {
    const PetscReal *t = p->t + k * m;

    kink[k] = IsClosed(r, p) ? t[m - 1] - t[0] : 0.;
    for (PetscInt j = 0; !IsClosed(r, p) && j <= b->order; ++j) {
      if (p->n == 1) kink[k] += 2. * c[j] * t[j];
      else kink[k] += c[j] * (power[1] * t[b->order * (first + 1) + j] - power[0] * t[b->order * first + j]);
    }
  }
}

/* Few betas: a dense least-squares problem, of least norm where the kinks leave one free */
static PetscErrorCode SolveFewShares(const Recovery *r, PetscReal beta[])
{
  const PetscInt m   = 2 * r->nshares;
  PetscInt       row = 0;
  PetscReal     *A, *s, kink[3], rcond = FEMBEM_SHARES_RANK;
  PetscScalar   *work;
  PetscBLASInt   bm, bn, one = 1, rank, lwork, info;

  PetscFunctionBegin;
  PetscCall(PetscBLASIntCast(m, &bm));
  PetscCall(PetscBLASIntCast(r->nshares, &bn));
  PetscCall(PetscBLASIntCast(16 * m + 64, &lwork));
  PetscCall(PetscCalloc3(m * r->nshares, &A, r->nshares, &s, lwork, &work));
  for (PetscInt k = 0; k < r->npieces; ++k) {
    for (PetscInt end = 0; end < 2; ++end) {
      const Piece *p = &r->piece[k];

      if (p->share[end] < 0) continue;
      Kink(r, p, end ? PETSC_TRUE : PETSC_FALSE, kink);
      if (p->share[0] >= 0) A[p->share[0] * m + row] -= kink[1];
      if (p->share[1] >= 0) A[p->share[1] * m + row] += kink[2];
      beta[row++] = -kink[0];
    }
  }
  PetscCallBLAS("LAPACKgelss", LAPACKgelss_(&bm, &bn, &one, A, &bm, beta, &bm, s, &rcond, &rank, work, &lwork, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "Tractions at corners: gelss gives %d", (int)info);
  PetscCall(PetscFree3(A, s, work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The kink at an end of a piece whose contour has n betas from the given one on, which is the last one of their chain */
static void AddKink(const Recovery *r, const Piece *p, PetscBool atend, PetscInt first, PetscInt n, FembemChainRow R[], PetscReal *largest)
{
  FembemChainRow row = {.own = 0.};
  PetscInt       k   = n - 1;
  PetscReal      kink[3];

  Kink(r, p, atend, kink);
  for (PetscInt end = 1; end >= 0; --end) {
    const PetscInt  place = (p->share[end] - first + n - 1) % n;
    const PetscReal value = end ? kink[2] : -kink[1];

    if (p->share[end] < 0) continue;
    *largest = PetscMax(*largest, PetscAbsReal(value));
    if (place == n - 1) row.last += value;
    else {
      row.next = row.own;
      row.own  = value;
      k        = place;
    }
  }
  row.rhs = -kink[0];
  FembemChainAdd(n, R, k, row);
}

/* Many corners: a kink is of the betas at the two ends of its piece, those of a contour are a chain */
static PetscErrorCode SolveManyShares(const Recovery *r, PetscReal beta[])
{
  FembemChainRow *R;
  PetscReal      *x;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(r->nshares, &R, r->nshares, &x));
  for (PetscInt c = 0; c < r->b->given->ncontours; ++c) {
    const PetscInt first = r->firstshare[c], n = r->firstshare[c + 1] - first;
    PetscReal      largest = 0.;

    if (!n) continue;
    PetscCall(PetscArrayzero(R, n));
    for (PetscInt k = r->firstpiece[c]; k < r->firstpiece[c + 1]; ++k)
      for (PetscInt end = 0; end < 2; ++end)
        if (r->piece[k].share[end] >= 0) AddKink(r, &r->piece[k], (PetscBool)end, first, n, R, &largest);
    PetscCall(FembemChainSolve(n, R, FEMBEM_SHARES_RANK * largest, x));
    for (PetscInt k = 0; k < n; ++k) beta[first + (k + 1) % n] = x[k];
  }
  PetscCall(PetscFree2(R, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Into the component of the traction of the elements of a piece */
static void StorePiece(const Recovery *r, const Piece *p, const PetscReal beta[])
{
  const PetscReal first = p->share[0] >= 0 ? -beta[p->share[0]] : 0., last = p->share[1] >= 0 ? beta[p->share[1]] : 0.;
  const PetscInt  order = r->b->order, m = order * p->n + 1;
  PetscInt        e = p->first;

  for (PetscInt i = 0; i < p->n; ++i, e = r->b->next[e]) {
    for (PetscInt k = 0; k <= order; ++k) {
      const PetscReal *t   = p->t + order * i + k;
      PetscComplex    *old = &r->b->t[(order + 1) * e + k];
      const PetscReal  v   = t[0] + first * t[m] + last * t[2 * m];

      *old = r->c ? PetscCMPLX(PetscRealPartComplex(*old), v) : PetscCMPLX(v, PetscImaginaryPartComplex(*old));
    }
  }
}

PetscErrorCode FembemRecoverTractions(FembemBoundary *b)
{
  Recovery   r = {.b = b};
  PetscReal *beta;

  PetscFunctionBegin;
  PetscCall(PetscMalloc6(b->n, &r.piece, b->n, &r.share, b->given->ncontours + 1, &r.firstpiece, b->given->ncontours + 1, &r.firstshare,
                         3 * (b->order + 1) * b->n, &r.value, 2 * b->n, &beta));
  for (r.c = 0; r.c < 2; ++r.c) {
    FindPieces(&r);
    for (PetscInt k = 0; k < r.npieces; ++k) PetscCall(SolvePiece(&r, &r.piece[k]));
    if (r.nshares > FEMBEM_SHARES_DENSE) PetscCall(SolveManyShares(&r, beta));
    else if (r.nshares) PetscCall(SolveFewShares(&r, beta));
    for (PetscInt k = 0; k < r.npieces; ++k) StorePiece(&r, &r.piece[k], beta);
  }
  PetscCall(PetscFree6(r.piece, r.share, r.firstpiece, r.firstshare, r.value, beta));
  PetscFunctionReturn(PETSC_SUCCESS);
}
