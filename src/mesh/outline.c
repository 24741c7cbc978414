#include "first.h"

/* What a mesh from a file must be, and where its boundary is: on one rank */

typedef struct {
  PetscInt low, high; /* vertices */
  PetscInt from;      /* of the two, where the side begins that has its cell on the left */
  PetscInt corner;    /* of all corners of cells: the side begins there */
} AbutHalf;

static int AbutHalfCompare_Private(const void *a, const void *b)
{
  const AbutHalf *p = (const AbutHalf *)a, *q = (const AbutHalf *)b;

  if (p->low != q->low) return p->low < q->low ? -1 : 1;
  if (p->high != q->high) return p->high < q->high ? -1 : 1;
  return (p->corner > q->corner) - (p->corner < q->corner);
}

static int AbutLineCompare_Private(const void *a, const void *b)
{
  const PetscInt *p = (const PetscInt *)a, *q = (const PetscInt *)b;

  if (p[0] != q[0]) return p[0] < q[0] ? -1 : 1;
  return (p[1] > q[1]) - (p[1] < q[1]);
}

/* Twice the area of the triangle at corner k of a cell, and the square of the longer side there */
static PetscReal AbutCornerArea_Private(const AbutGmsh *g, PetscInt c, PetscInt k, PetscReal *size)
{
  const PetscInt  *v = g->cell + g->corners * c, n = g->corners;
  const PetscReal *a = g->x + 2 * v[k], *b = g->x + 2 * v[(k + 1) % n], *d = g->x + 2 * v[(k + n - 1) % n];

  *size = PetscMax(PetscSqr(b[0] - a[0]) + PetscSqr(b[1] - a[1]), PetscSqr(d[0] - a[0]) + PetscSqr(d[1] - a[1]));
  return (b[0] - a[0]) * (d[1] - a[1]) - (b[1] - a[1]) * (d[0] - a[0]);
}

/* Turns clockwise cells round; each corner must then be convex */
PetscErrorCode AbutFirstOrient_Private(AbutGmsh *g, AbutFault *fault)
{
  const PetscReal least = 1e-10; /* of the square of a side */

  PetscFunctionBegin;
  for (PetscInt c = 0; c < g->ncells && !fault->text[0]; ++c) {
    PetscInt        *v    = g->cell + g->corners * c;
    PetscReal        area = 0., size;
    const PetscReal *x    = g->x;

    for (PetscInt k = 0; k < g->corners; ++k) area += AbutCornerArea_Private(g, c, k, &size);
    if (area < 0.) {
      const PetscInt second = v[1];

      v[1]              = v[g->corners - 1];
      v[g->corners - 1] = second;
    }
    for (PetscInt k = 0; k < g->corners && !fault->text[0]; ++k)
      if (AbutCornerArea_Private(g, c, k, &size) <= least * size)
        PetscCall(PetscSNPrintf(fault->text, sizeof(fault->text),
                                "element %" PetscInt_FMT " at (%g, %g) has no area, or a corner of 180 degrees or more", g->id[c],
                                (double)x[2 * v[k]], (double)x[2 * v[k] + 1]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The name of a physical curve: its number where it has none */
static PetscErrorCode AbutCurveName_Private(const AbutGmsh *g, PetscInt tag, char name[ABUT_SIDE_NAME_MAX])
{
  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(name, ABUT_SIDE_NAME_MAX, "%" PetscInt_FMT, tag));
  for (PetscInt i = 0; i < g->nnames; ++i)
    if (g->nametag[i] == tag) PetscCall(PetscStrncpy(name, g->name[i], ABUT_SIDE_NAME_MAX));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All sides of cells, those between the same two vertices together */
static PetscErrorCode AbutHalvesCreate_Private(const AbutGmsh *g, AbutHalf **half)
{
  const PetscInt n = g->corners * g->ncells;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, half));
  for (PetscInt i = 0; i < n; ++i) {
    const PetscInt a = g->cell[i], b = g->cell[i / g->corners * g->corners + (i + 1) % g->corners];

    (*half)[i] = (AbutHalf){PetscMin(a, b), PetscMax(a, b), a, i};
  }
  qsort(*half, (size_t)n, sizeof(**half), AbutHalfCompare_Private);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps the sides of one cell only, with their physical curve in cellside; inside, two cells must lie on the two hands of a side */
static PetscErrorCode AbutHalvesPair_Private(const AbutGmsh *g, PetscInt n, const AbutHalf half[], PetscInt cellside[], AbutFault *fault)
{
  PetscInt missing = 0, first = -1;

  PetscFunctionBegin;
  for (PetscInt i = 0, next; i < n; i = next) {
    const PetscReal *x = g->x + 2 * half[i].low, *y = g->x + 2 * half[i].high;

    for (next = i + 1; next < n && half[next].low == half[i].low && half[next].high == half[i].high;) ++next;
    for (PetscInt k = i; k < next; ++k) cellside[half[k].corner] = -1;
    if (next - i > 2 || (next - i == 2 && half[i].from == half[i + 1].from)) {
      PetscCall(PetscSNPrintf(fault->text, sizeof(fault->text),
                              "elements %" PetscInt_FMT " and %" PetscInt_FMT " lie on the same side of the line from (%g, %g) to (%g, %g)",
                              g->id[half[i].corner / g->corners], g->id[half[next - 1].corner / g->corners], (double)x[0], (double)x[1],
                              (double)y[0], (double)y[1]));
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    if (next - i == 1) {
      const PetscInt  key[2] = {half[i].low, half[i].high};
      const PetscInt *line   = (const PetscInt *)bsearch(key, g->line, (size_t)g->nlines, 3 * sizeof(PetscInt), AbutLineCompare_Private);

      if (line) {
        const PetscInt *before = line - 3, *behind = line + 3;

        if ((line > g->line && !AbutLineCompare_Private(before, key) && before[2] != line[2]) ||
            (behind < g->line + 3 * g->nlines && !AbutLineCompare_Private(behind, key) && behind[2] != line[2])) {
          PetscCall(PetscSNPrintf(fault->text, sizeof(fault->text),
                                  "the line from (%g, %g) to (%g, %g) belongs to two physical curves; give it one", (double)x[0],
                                  (double)x[1], (double)y[0], (double)y[1]));
          PetscFunctionReturn(PETSC_SUCCESS);
        }
        cellside[half[i].corner] = line[2];
      } else if (!missing++) first = i;
    }
  }
  if (missing)
    PetscCall(PetscSNPrintf(fault->text, sizeof(fault->text),
                            "%" PetscInt_FMT
                            " lines of the boundary belong to no physical curve, the first at (%g, %g); give a Physical Curve "
                            "for each side",
                            missing, (double)(0.5 * (g->x[2 * half[first].low] + g->x[2 * half[first].high])),
                            (double)(0.5 * (g->x[2 * half[first].low + 1] + g->x[2 * half[first].high + 1]))));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* From physical curves to sides, in the order of their numbers */
static PetscErrorCode AbutFirstNameSides_Private(const AbutGmsh *g, AbutFirst first, AbutFault *fault)
{
  PetscInt tag[ABUT_SIDES_MAX], n = g->corners * g->ncells;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < n; ++i) {
    PetscInt s = 0;

    if (first->cellside[i] < 0) continue;
    while (s < first->nsides && tag[s] < first->cellside[i]) ++s;
    if (s < first->nsides && tag[s] == first->cellside[i]) continue;
    if (first->nsides == ABUT_SIDES_MAX) {
      PetscCall(PetscSNPrintf(fault->text, sizeof(fault->text), "the boundary has more than %d physical curves", ABUT_SIDES_MAX));
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    for (PetscInt k = first->nsides++; k > s; --k) tag[k] = tag[k - 1];
    tag[s] = first->cellside[i];
  }
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt s = 0; s < first->nsides && first->cellside[i] >= 0; ++s)
      if (tag[s] == first->cellside[i]) {
        first->cellside[i] = s;
        break;
      }
  PetscCall(PetscMalloc1(first->nsides, &first->name));
  for (PetscInt s = 0; s < first->nsides; ++s) PetscCall(AbutCurveName_Private(g, tag[s], first->name[s]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The boundary as a list: leaving[v] is the corner where its side begins at vertex v, -1 inside */
static PetscErrorCode AbutOutlineFollow_Private(const AbutGmsh *g, const PetscInt cellside[], PetscInt leaving[], AbutFault *fault)
{
  PetscFunctionBegin;
  for (PetscInt v = 0; v < g->nvertices; ++v) leaving[v] = -1;
  for (PetscInt i = 0; i < g->corners * g->ncells; ++i) {
    const PetscInt v = g->cell[i];

    if (cellside[i] < 0) continue;
    if (leaving[v] >= 0 && !fault->text[0])
      PetscCall(PetscSNPrintf(fault->text, sizeof(fault->text), "at (%g, %g) the body hangs together by a vertex only", (double)g->x[2 * v],
                              (double)g->x[2 * v + 1]));
    leaving[v] = i;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How many bodies that hang together there are */
static PetscErrorCode AbutOutlinePieces_Private(const AbutGmsh *g, PetscInt *pieces)
{
  PetscInt *root;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(g->nvertices, &root));
  for (PetscInt v = 0; v < g->nvertices; ++v) root[v] = v;
  *pieces = g->nvertices;
  for (PetscInt i = 0; i < g->corners * g->ncells; ++i) {
    PetscInt a = g->cell[i], b = g->cell[i / g->corners * g->corners];

    while (root[a] != a) a = root[a] = root[root[a]];
    while (root[b] != b) b = root[b] = root[root[b]];
    *pieces -= a != b;
    root[PetscMax(a, b)] = PetscMin(a, b);
  }
  PetscCall(PetscFree(root));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The vertex at the other end of the side that begins at corner i */
static PetscInt AbutOutlineNext_Private(const AbutGmsh *g, PetscInt i)
{
  return g->cell[i / g->corners * g->corners + (i + 1) % g->corners];
}

/* Where the next piece of a side begins: at a vertex where another side ends, if there is one left, the lowest, then leftmost; -1: none */
static PetscInt AbutOutlineBegin_Private(const AbutGmsh *g, const PetscInt cellside[], const PetscInt leaving[], const PetscInt entering[],
                                         const PetscBool used[], PetscInt side)
{
  PetscInt  begin = -1;
  PetscBool open  = PETSC_FALSE;

  for (PetscInt v = 0; v < g->nvertices; ++v) {
    const PetscReal *x = g->x + 2 * v, *y = g->x + 2 * PetscMax(begin, 0);
    PetscBool        starts;

    if (leaving[v] < 0 || used[v] || cellside[leaving[v]] != side) continue;
    starts = (PetscBool)(cellside[entering[v]] != side);
    if (begin >= 0 && (open != starts ? open : x[1] > y[1] || (x[1] == y[1] && x[0] > y[0]))) continue;
    begin = v;
    open  = starts;
  }
  return begin;
}

/* The segments of every side, piece after piece */
static PetscErrorCode AbutFirstSegments_Private(const AbutGmsh *g, const PetscInt leaving[], AbutFirst first)
{
  PetscInt   total = 0, *entering;
  PetscBool *used;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(g->nvertices, &entering));
  PetscCall(PetscCalloc1(g->nvertices, &used));
  for (PetscInt v = 0; v < g->nvertices; ++v) {
    if (leaving[v] < 0) continue;
    ++total;
    entering[AbutOutlineNext_Private(g, leaving[v])] = leaving[v];
  }
  PetscCall(PetscMalloc1(first->nsides + 1, &first->segments));
  PetscCall(PetscMalloc1(4 * total, &first->segment));
  total = 0;
  for (PetscInt s = 0; s < first->nsides; ++s) {
    PetscInt v;

    first->segments[s] = total;
    while ((v = AbutOutlineBegin_Private(g, first->cellside, leaving, entering, used, s)) >= 0)
      for (; !used[v] && first->cellside[leaving[v]] == s; v = AbutOutlineNext_Private(g, leaving[v])) {
        PetscReal *segment = first->segment + 4 * total++;

        used[v] = PETSC_TRUE;
        PetscCall(PetscArraycpy(segment, g->x + 2 * v, 2));
        PetscCall(PetscArraycpy(segment + 2, g->x + 2 * AbutOutlineNext_Private(g, leaving[v]), 2));
      }
  }
  first->segments[first->nsides] = total;
  PetscCall(PetscFree(entering));
  PetscCall(PetscFree(used));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sides and segments of the cells of a file, or what is wrong with them */
PetscErrorCode AbutFirstOutline_Private(const AbutGmsh *g, AbutFirst first, AbutFault *fault)
{
  const PetscInt n = g->corners * g->ncells;
  PetscInt      *leaving, pieces = 1;
  AbutHalf      *half;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < g->nlines; ++i) {
    PetscInt *line = g->line + 3 * i, a = line[0];

    line[0] = PetscMin(line[0], line[1]);
    line[1] = PetscMax(a, line[1]);
  }
  qsort(g->line, (size_t)g->nlines, 3 * sizeof(PetscInt), AbutLineCompare_Private);
  PetscCall(PetscMalloc1(n, &first->cellside));
  PetscCall(PetscMalloc1(g->nvertices, &leaving));
  PetscCall(AbutHalvesCreate_Private(g, &half));
  PetscCall(AbutHalvesPair_Private(g, n, half, first->cellside, fault));
  if (!fault->text[0]) PetscCall(AbutOutlineFollow_Private(g, first->cellside, leaving, fault));
  if (!fault->text[0]) PetscCall(AbutOutlinePieces_Private(g, &pieces));
  if (!fault->text[0] && pieces > 1)
    PetscCall(PetscSNPrintf(fault->text, sizeof(fault->text),
                            "%" PetscInt_FMT " pieces that do not hang together; give mesh_region for one of them", pieces));
  if (!fault->text[0]) PetscCall(AbutFirstNameSides_Private(g, first, fault));
  if (!fault->text[0]) PetscCall(AbutFirstSegments_Private(g, leaving, first));
  PetscCall(PetscFree(half));
  PetscCall(PetscFree(leaving));
  PetscFunctionReturn(PETSC_SUCCESS);
}
