#include "quadrants.h"
#include <p4est_bits.h>

/* A quadtree whose neighbours may differ by any number of levels as a DMPLEX, on one rank; p4est's own conversion wants 2:1. A side of a
   coarse cell is the parent of two halves, each a side of a fine cell or itself divided: these chains are what hanging nodes follow. */

typedef int64_t Place; /* P4EST_ROOT_LEN for a cell of the first grid */

typedef struct {
  Place x, y, length; /* of the lower left corner */
} Cell;

/* An interval along direction `along` on the line `across` */
typedef struct {
  Place    across, start, length;
  PetscInt along;
} Side;

typedef struct {
  Place x, y;
} Corner;

#define Compare(a, b) ((a) > (b)) - ((a) < (b))

/* Along each line; of two that begin together the longer one first, so that a side follows those that contain it */
static int SideCompare(const void *a, const void *b)
{
  const Side *s = (const Side *)a, *t = (const Side *)b;

  if (s->along != t->along) return Compare(s->along, t->along);
  if (s->across != t->across) return Compare(s->across, t->across);
  if (s->start != t->start) return Compare(s->start, t->start);
  return Compare(t->length, s->length);
}

static int CornerCompare(const void *a, const void *b)
{
  const Corner *s = (const Corner *)a, *t = (const Corner *)b;

  return s->y == t->y ? Compare(s->x, t->x) : Compare(s->y, t->y);
}

/* Sorts, and drops what is there twice */
static PetscInt SidesSort(PetscInt n, Side side[])
{
  PetscInt m = 0;

  qsort(side, (size_t)n, sizeof(*side), SideCompare);
  for (PetscInt i = 0; i < n; ++i)
    if (!m || SideCompare(&side[m - 1], &side[i])) side[m++] = side[i];
  return m;
}

/* above[i]: the shortest side that contains side i, -1 if none does */
static PetscErrorCode SidesNest(PetscInt n, const Side side[], PetscInt above[])
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < n; ++i) {
    PetscInt a = i - 1; /* those that contain the one before, from the shortest on, are the candidates */

    while (a >= 0 && (side[a].along != side[i].along || side[a].across != side[i].across ||
                      side[a].start + side[a].length < side[i].start + side[i].length))
      a = above[a];
    above[i] = a;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Corner k of a cell, counted counter-clockwise from the lower left one */
static Corner CellCorner(const Cell *q, PetscInt k)
{
  return (Corner){q->x + (k == 1 || k == 2) * q->length, q->y + (k > 1) * q->length};
}

/* Side k of a cell, from corner k to the next one, directed along its coordinate */
static Side CellSide(const Cell *q, PetscInt k)
{
  const Corner   from  = CellCorner(q, k > 1 ? (k + 1) % 4 : k);
  const PetscInt along = k % 2;

  return (Side){along ? from.x : from.y, along ? from.y : from.x, q->length, along};
}

static Corner SideEnd(const Side *s, Place at)
{
  return s->along ? (Corner){s->across, s->start + at} : (Corner){s->start + at, s->across};
}

/* The sides of all cells, and those between a coarse side and the fine ones on it that are more than a level below */
static PetscErrorCode SidesCreate(PetscInt ncells, const Cell cell[], PetscInt *nsides, Side **sides, PetscInt **above)
{
  PetscInt n = 0, added = 1, room = 8 * ncells + 16;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(room, sides));
  PetscCall(PetscMalloc1(room, above));
  for (PetscInt i = 0; i < 4 * ncells; ++i) (*sides)[n++] = CellSide(&cell[i / 4], i % 4);
  while (added) {
    n     = SidesSort(n, *sides);
    added = 0;
    PetscCall(SidesNest(n, *sides, *above));
    if (2 * n > room) {
      room = 2 * n;
      PetscCall(PetscRealloc(room * sizeof(**sides), sides));
      PetscCall(PetscRealloc(room * sizeof(**above), above));
    }
    for (PetscInt i = 0; i < n; ++i) {
      Side s = (*sides)[i];

      if ((*above)[i] < 0 || (*sides)[(*above)[i]].length == 2 * s.length) continue;
      s.length *= 2;
      s.start -= s.start % s.length;
      (*sides)[n + added++] = s;
    }
    n += added;
  }
  *nsides = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt Find(const void *key, const void *in, PetscInt n, size_t size, int (*compare)(const void *, const void *))
{
  const char *found = (const char *)bsearch(key, in, (size_t)n, size, compare);

  return (PetscInt)((found - (const char *)in) / (ptrdiff_t)size);
}

static PetscErrorCode CornersCreate(PetscInt ncells, const Cell cell[], PetscInt *n, Corner **corner)
{
  PetscFunctionBegin;
  *n = 0;
  PetscCall(PetscMalloc1(4 * ncells, corner));
  for (PetscInt i = 0; i < 4 * ncells; ++i) (*corner)[i] = CellCorner(&cell[i / 4], i % 4);
  qsort(*corner, (size_t)(4 * ncells), sizeof(**corner), CornerCompare);
  for (PetscInt i = 0; i < 4 * ncells; ++i)
    if (!*n || CornerCompare(&(*corner)[*n - 1], &(*corner)[i])) (*corner)[(*n)++] = (*corner)[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Push(sc_array_t *array, PetscInt value)
{
  *(p4est_locidx_t *)sc_array_push(array) = (p4est_locidx_t)value;
}

/* A coordinate of a corner of the first grid */
static Place GridCorner(AbutMesh mesh, const double x[], PetscInt d)
{
  return P4EST_ROOT_LEN * (Place)PetscFloorReal(0.5 + (x[d] - mesh->lower[d]) / (mesh->upper[d] - mesh->lower[d]) * mesh->cells[d]);
}

static PetscErrorCode CellsCreate(AbutMesh mesh, p4est_t *p4est, Cell **cell)
{
  const p4est_connectivity_t *grid = p4est->connectivity;
  PetscInt                    n    = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(p4est->local_num_quadrants, cell));
  for (p4est_topidx_t t = 0; t < grid->num_trees; ++t) {
    p4est_tree_t *tree   = p4est_tree_array_index(p4est->trees, t);
    const double *corner = grid->vertices + 3 * grid->tree_to_vertex[4 * t];

    for (size_t i = 0; i < tree->quadrants.elem_count; ++i) {
      const p4est_quadrant_t *q = p4est_quadrant_array_index(&tree->quadrants, i);

      (*cell)[n++] = (Cell){GridCorner(mesh, corner, 0) + q->x, GridCorner(mesh, corner, 1) + q->y, P4EST_QUADRANT_LEN(q->level)};
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static double Coordinate(AbutMesh mesh, PetscInt d, Place at)
{
  const PetscInt  line = (PetscInt)(at / P4EST_ROOT_LEN);
  const PetscReal s = (PetscReal)(at % P4EST_ROOT_LEN) / P4EST_ROOT_LEN, x = AbutMeshGridLine_Private(mesh, d, line);

  return s > 0. ? (1. - s) * x + s * AbutMeshGridLine_Private(mesh, d, line + 1) : x;
}

/* Points are cells, then vertices, then sides */
PetscErrorCode AbutForestGetPlexData_Private(AbutMesh mesh, p4est_t *p4est, AbutPlexData *data)
{
  const PetscInt ncells = p4est->local_num_quadrants;
  PetscInt       nsides = 0, ncorners = 0, *above, *parent;
  Cell          *cell;
  Side          *side;
  Corner        *corner;

  PetscFunctionBegin;
  PetscCall(CellsCreate(mesh, p4est, &cell));
  PetscCall(SidesCreate(ncells, cell, &nsides, &side, &above));
  PetscCall(CornersCreate(ncells, cell, &ncorners, &corner));
  Push(data->points, ncorners);
  Push(data->points, nsides);
  Push(data->points, ncells);
  for (PetscInt i = 0; i < ncells + ncorners + nsides; ++i) Push(data->conesizes, i < ncells ? 4 : i < ncells + ncorners ? 0 : 2);
  for (PetscInt i = 0; i < 4 * ncells; ++i) {
    const Side s = CellSide(&cell[i / 4], i % 4);

    Push(data->cones, ncells + ncorners + Find(&s, side, nsides, sizeof(s), SideCompare));
    Push(data->orientations, i % 4 > 1 ? -1 : 0);
  }
  for (PetscInt i = 0; i < 2 * nsides; ++i) {
    const Corner end = SideEnd(&side[i / 2], i % 2 ? side[i / 2].length : 0);

    Push(data->cones, ncells + Find(&end, corner, ncorners, sizeof(end), CornerCompare));
    Push(data->orientations, 0);
  }
  for (PetscInt i = 0; i < ncorners; ++i) {
    double *x = (double *)sc_array_push(data->coordinates);

    x[0] = Coordinate(mesh, 0, corner[i].x);
    x[1] = Coordinate(mesh, 1, corner[i].y);
    x[2] = 0.;
  }
  PetscCall(PetscMalloc1(ncorners + nsides, &parent));
  for (PetscInt i = 0; i < ncorners; ++i) parent[i] = -1;
  for (PetscInt i = 0; i < nsides; ++i) {
    const Corner end = SideEnd(&side[i], side[i].length);

    parent[ncorners + i] = above[i];
    if (above[i] >= 0 && side[i].start == side[above[i]].start) /* a first half: it ends in the middle of the whole */
      parent[Find(&end, corner, ncorners, sizeof(end), CornerCompare)] = above[i];
  }
  for (PetscInt i = 0; i < ncorners + nsides; ++i) { /* in the order of the points, as DMPlexSetTree() wants it */
    if (parent[i] < 0) continue;
    Push(data->children, ncells + i);
    Push(data->parents, ncells + ncorners + parent[i]);
  }
  PetscCall(PetscFree(parent));
  PetscCall(PetscFree(cell));
  PetscCall(PetscFree(side));
  PetscCall(PetscFree(above));
  PetscCall(PetscFree(corner));
  PetscFunctionReturn(PETSC_SUCCESS);
}
