#include "fembemimpl.h"
#include <petscblaslapack.h>

/*
   From nodal forces to tractions, one component at a time. The part of the boundary where that component of the displacement (or contact)
   is prescribed is cut into pieces at corners and where the condition changes; in a piece the traction t is continuous and M t = r, M the
   boundary mass matrix, r the nodal forces. At a node between two pieces one force r feeds two end values: r/2 + beta goes to the piece
   before it, r/2 - beta to the one behind it, and the betas minimise the kinks of t in the two elements next to each such end. A closed
   contour without a corner is cut at its first node, where beta closes it again.
*/
typedef struct {
  PetscInt          first, n; /* elements: first, the one after it, ... */
  AbutConditionType type;     /* ABUT_DISPLACEMENT or ABUT_CONTACT */
  PetscInt          share[2]; /* the betas at its start and end, -1 if none */
  PetscReal        *t;        /* [3*(n+1)] the known part, and what a unit force at the start and at the end adds */
} Piece;

typedef struct {
  FembemBoundary *b;
  PetscInt        c; /* component */
  PetscInt        npieces, nshares;
  Piece          *piece; /* [n] */
  PetscInt       *share; /* [n] beta of each node, -1 if none */
  PetscReal      *value; /* [6*n] room for the t of the pieces */
} Recovery;

static inline AbutConditionType ConditionOf(const Recovery *r, PetscInt e)
{
  return r->b->given->condition[2 * e + r->c];
}

static inline PetscReal Length(const FembemBoundary *b, PetscInt e)
{
  return PetscAbsComplex(b->z[b->next[e]] - b->z[e]);
}

/* Does a new piece begin with element e: another condition, a sharp corner, or a less sharp one between two named sides */
static PetscBool IsCut(const Recovery *r, PetscInt e)
{
  const FembemBoundary *b      = r->b;
  const PetscInt        p      = b->previous[e];
  const PetscReal       cosine = PetscRealPartComplex((b->z[e] - b->z[p]) * PetscConjComplex(b->z[b->next[e]] - b->z[e])) /
                           (Length(b, p) * Length(b, e));

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
  const PetscComplex      t       = r->b->z[r->b->next[contact]] - r->b->z[contact];
  const PetscReal         normal  = (r->c ? PetscRealPartComplex(t) : PetscImaginaryPartComplex(t)) / PetscAbsComplex(t);

  if (type[0] == ABUT_TRACTION || type[1] == ABUT_TRACTION) return PETSC_FALSE;
  return type[0] == type[1] || PetscAbsReal(normal) > 1e-3 ? PETSC_TRUE : PETSC_FALSE;
}

/* The force at a node that the finite elements balance with the tractions of this piece */
static PetscReal NodalForce(const Recovery *r, AbutConditionType type, PetscInt node)
{
  const AbutBoundary *g = r->b->given;
  const PetscInt      k = 2 * node + r->c;

  if (r->share[node] >= 0) return 0.5 * (g->reaction[k] + g->contact[k]);
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
    e = start;
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
  for (PetscInt k = 0; k < r->npieces; ++k) {
    Piece   *p   = &r->piece[k];
    PetscInt end = p->first;

    for (PetscInt i = 0; i < p->n; ++i) end = next[end];
    p->share[0] = r->share[p->first];
    p->share[1] = r->share[end];
    p->t        = room;
    room += 3 * (p->n + 1);
  }
}

/* M t = r in one piece, for three right-hand sides */
static PetscErrorCode SolvePiece(const Recovery *r, Piece *p)
{
  const PetscInt m = p->n + 1;
  PetscInt       e = p->first;
  PetscReal     *d;
  PetscScalar   *off;
  PetscBLASInt   n, three = 3, info;

  PetscFunctionBegin;
  PetscCall(PetscBLASIntCast(m, &n));
  PetscCall(PetscCalloc2(m, &d, m, &off));
  PetscCall(PetscArrayzero(p->t, 3 * m));
  p->t[m] = p->t[3 * m - 1] = 1.;
  for (PetscInt i = 0; i < m; ++i, e = r->b->next[e]) {
    p->t[i] = NodalForce(r, p->type, e);
    if (i == p->n) break;
    off[i] = Length(r->b, e) / 6.;
    d[i] += 2. * off[i];
    d[i + 1] += 2. * off[i];
  }
  PetscCallBLAS("LAPACKpttrf", LAPACKpttrf_(&n, d, off, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "Mass matrix of a side: pttrf gives %d", (int)info);
  PetscCallBLAS("LAPACKpttrs", LAPACKpttrs_(&n, &three, d, off, p->t, &n, &info));
  PetscCall(PetscFree2(d, off));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool IsClosed(const Recovery *r, const Piece *p)
{
  return p->share[0] >= 0 && p->share[0] == p->share[1] && !IsCut(r, p->first) ? PETSC_TRUE : PETSC_FALSE;
}

/* How much the slope of t changes between the first (or last) two elements of a piece, for each of its three parts; of one element, or
   where the piece closes a contour, how much t itself does */
static void Kink(const Recovery *r, const Piece *p, PetscBool atend, PetscReal kink[3])
{
  const PetscInt m = p->n + 1, step = atend ? -1 : 1;

  for (PetscInt k = 0; k < 3; ++k) {
    const PetscReal *t = p->t + k * m + (atend ? p->n : 0);

    if (p->n == 1 || IsClosed(r, p)) {
      kink[k] = t[step * p->n] - t[0];
    } else {
      PetscInt  e = p->first;
      PetscReal h[2];

      for (PetscInt i = 1; atend && i < p->n; ++i) e = r->b->next[e];
      h[0]    = Length(r->b, e);
      h[1]    = Length(r->b, atend ? r->b->previous[e] : r->b->next[e]);
      kink[k] = 0.5 * (h[0] + h[1]) * ((t[2 * step] - t[step]) / h[1] - (t[step] - t[0]) / h[0]);
    }
  }
}

/* The betas: a small least-squares problem, of least norm where the kinks leave one free */
static PetscErrorCode SolveShares(const Recovery *r, PetscReal beta[])
{
  const PetscInt m   = 2 * r->nshares;
  PetscInt       row = 0;
  PetscReal     *A, *s, kink[3], rcond = 1e-10;
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

/* Into the component of the traction of the elements of a piece */
static void StorePiece(const Recovery *r, const Piece *p, const PetscReal beta[])
{
  const PetscReal first = p->share[0] >= 0 ? -beta[p->share[0]] : 0., last = p->share[1] >= 0 ? beta[p->share[1]] : 0.;
  PetscInt        e = p->first;

  for (PetscInt i = 0; i < p->n; ++i, e = r->b->next[e]) {
    for (PetscInt k = 0; k < 2; ++k) {
      const PetscReal *t   = p->t + i + k;
      PetscComplex    *old = &r->b->t[2 * e + k];
      const PetscReal  v   = t[0] + first * t[p->n + 1] + last * t[2 * (p->n + 1)];

      *old = r->c ? PetscCMPLX(PetscRealPartComplex(*old), v) : PetscCMPLX(v, PetscImaginaryPartComplex(*old));
    }
  }
}

PetscErrorCode FembemRecoverTractions(FembemBoundary *b)
{
  Recovery   r = {.b = b};
  PetscReal *beta;

  PetscFunctionBegin;
  PetscCall(PetscMalloc4(b->n, &r.piece, b->n, &r.share, 6 * b->n, &r.value, 2 * b->n, &beta));
  for (r.c = 0; r.c < 2; ++r.c) {
    FindPieces(&r);
    for (PetscInt k = 0; k < r.npieces; ++k) PetscCall(SolvePiece(&r, &r.piece[k]));
    if (r.nshares) PetscCall(SolveShares(&r, beta));
    for (PetscInt k = 0; k < r.npieces; ++k) StorePiece(&r, &r.piece[k], beta);
  }
  PetscCall(PetscFree4(r.piece, r.share, r.value, beta));
  PetscFunctionReturn(PETSC_SUCCESS);
}
