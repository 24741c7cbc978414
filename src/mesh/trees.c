#include "first.h"
#include "quadrants.h"
#include <p4est_bits.h>

/* Quads of a mesh from a file: every one is the root of a quadtree. A quadrant touches a side of the body with its faces on those of its
   tree; new vertices on a curved side lie on the curve, and their neighbours inside follow. */

static const PetscInt AbutCornerOf[4] = {0, 1, 3, 2}; /* p4est's number of the corner that is the k-th counter-clockwise, and back */

PetscErrorCode AbutTreesCreate_Private(AbutMesh mesh, p4est_connectivity_t **connectivity)
{
  const AbutFirst       f = mesh->first;
  p4est_connectivity_t *c = p4est_connectivity_new((p4est_topidx_t)f->nvertices, (p4est_topidx_t)f->ncells, 0, 0);

  PetscFunctionBegin;
  for (PetscInt v = 0; v < f->nvertices; ++v)
    for (PetscInt d = 0; d < 3; ++d) c->vertices[3 * v + d] = d < 2 ? f->x[2 * v + d] : 0.;
  for (PetscInt t = 0; t < f->ncells; ++t)
    for (PetscInt k = 0; k < 4; ++k) {
      c->tree_to_vertex[4 * t + AbutCornerOf[k]] = (p4est_topidx_t)f->cell[4 * t + k];
      c->tree_to_tree[4 * t + k]                 = (p4est_topidx_t)t;
      c->tree_to_face[4 * t + k]                 = (int8_t)k;
    }
  p4est_connectivity_complete(c);
  *connectivity = c;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does the side k of a quadrant lie on that of its tree? */
static PetscBool AbutQuadrantTouches_Private(const p4est_quadrant_t *q, PetscInt k)
{
  const p4est_qcoord_t far = P4EST_ROOT_LEN - P4EST_QUADRANT_LEN(q->level);

  return (PetscBool)(k == 0 ? q->y == 0 : k == 1 ? q->x == far : k == 2 ? q->y == far : q->x == 0);
}

PetscErrorCode AbutTreesGetSides_Private(AbutMesh mesh, p4est_t *p4est, PetscInt side[])
{
  PetscInt c = 0;

  PetscFunctionBegin;
  for (p4est_topidx_t t = p4est->first_local_tree; t <= p4est->last_local_tree; ++t) {
    p4est_tree_t *tree = p4est_tree_array_index(p4est->trees, t);

    for (size_t q = 0; q < tree->quadrants.elem_count; ++q, ++c)
      for (PetscInt k = 0; k < 4; ++k)
        side[4 * c + k] = AbutQuadrantTouches_Private(p4est_quadrant_array_index(&tree->quadrants, q), k) ? mesh->first->cellside[4 * t + k]
                                                                                                          : -1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A quad on its way from a root to a quadrant: its corners, counter-clockwise, and the sides of the body on which its sides lie */
typedef struct {
  PetscReal x[4][2];
  PetscInt  side[4];
} AbutQuadPlace;

/* The j-th of its children, of which the first has its first corner. The middle is that of Coons' patch. */
static PetscErrorCode AbutQuadPlaceSplit_Private(AbutFirst f, PetscInt j, AbutQuadPlace *q)
{
  PetscReal     middle[4][2], centre[2] = {0., 0.};
  AbutQuadPlace child;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 4; ++k) {
    for (PetscInt d = 0; d < 2; ++d) middle[k][d] = 0.5 * (q->x[k][d] + q->x[(k + 1) % 4][d]);
    if (q->side[k] >= 0) PetscCall(AbutFirstMoveToCurve_Private(f, q->side[k], middle[k]));
  }
  for (PetscInt d = 0; d < 2; ++d)
    centre[d] = 0.5 * (middle[0][d] + middle[1][d] + middle[2][d] + middle[3][d]) -
                0.25 * (q->x[0][d] + q->x[1][d] + q->x[2][d] + q->x[3][d]);
  for (PetscInt d = 0; d < 2; ++d) {
    child.x[j][d]           = q->x[j][d];
    child.x[(j + 1) % 4][d] = middle[j][d];
    child.x[(j + 2) % 4][d] = centre[d];
    child.x[(j + 3) % 4][d] = middle[(j + 3) % 4][d];
  }
  child.side[j]           = q->side[j];
  child.side[(j + 1) % 4] = child.side[(j + 2) % 4] = -1;
  child.side[(j + 3) % 4]                           = q->side[(j + 3) % 4];
  *q                                                = child;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The place of a quadrant and that of its parent; child: which of the parent's it is, -1 for a root */
static PetscErrorCode AbutQuadPlaceFind_Private(AbutFirst f, p4est_topidx_t t, const p4est_quadrant_t *quadrant, AbutQuadPlace *parent,
                                                AbutQuadPlace *q, PetscInt *child)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < 4; ++k) {
    for (PetscInt d = 0; d < 2; ++d) q->x[k][d] = f->x[2 * f->cell[4 * t + k] + d];
    q->side[k] = f->cellside[4 * t + k];
  }
  *child = -1;
  for (int level = 1; level <= quadrant->level; ++level) {
    *parent = *q;
    *child  = AbutCornerOf[p4est_quadrant_ancestor_id(quadrant, level)];
    PetscCall(AbutQuadPlaceSplit_Private(f, *child, q));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt AbutQuadPlaceIsFolded_Private(const AbutQuadPlace *q)
{
  for (PetscInt k = 0; k < 4; ++k) {
    const PetscReal *a = q->x[k], *b = q->x[(k + 1) % 4], *d = q->x[(k + 3) % 4],
                    size = PetscMax(PetscSqr(b[0] - a[0]) + PetscSqr(b[1] - a[1]), PetscSqr(d[0] - a[0]) + PetscSqr(d[1] - a[1]));

    if (!((b[0] - a[0]) * (d[1] - a[1]) - (b[1] - a[1]) * (d[0] - a[0]) > ABUT_CURVE_AREA * ABUT_CURVE_AREA * size)) return 1;
  }
  return 0;
}

/* Writes the corners of cell c of the DM. Where a side hangs, the far end of the coarse one above it may be no corner of a cell here. */
static PetscErrorCode AbutQuadPlaceSet_Private(DM dm, PetscInt c, const AbutQuadPlace *q, const AbutQuadPlace *parent, PetscInt child,
                                               PetscSection section, PetscScalar x[])
{
  const PetscInt *side, *orientation, *end;
  PetscInt        offset, above;

  PetscFunctionBegin;
  PetscCall(DMPlexGetCone(dm, c, &side));
  PetscCall(DMPlexGetConeOrientation(dm, c, &orientation));
  for (PetscInt k = 0; k < 4; ++k) {
    PetscInt from, to, far;

    PetscCall(DMPlexGetCone(dm, side[k], &end));
    from = end[orientation[k] < 0];
    to   = end[orientation[k] >= 0];
    PetscCall(PetscSectionGetOffset(section, from, &offset));
    for (PetscInt d = 0; d < 2; ++d) x[offset + d] = q->x[k][d];
    PetscCall(DMPlexGetTreeParent(dm, side[k], &above, NULL));
    if (above == side[k]) continue;
    PetscCall(DMPlexGetCone(dm, above, &end));
    far = end[end[0] == from || end[0] == to];
    PetscCall(PetscSectionGetOffset(section, far, &offset));
    for (PetscInt d = 0; d < 2; ++d) x[offset + d] = parent->x[child == k ? (k + 1) % 4 : k][d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A vertex that hangs may belong to cells of other ranks only */
static PetscErrorCode AbutTreesHang_Private(DM dm, PetscSection section, PetscScalar x[])
{
  PetscInt vStart, vEnd;

  PetscFunctionBegin;
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, &vEnd));
  for (PetscInt v = vStart; v < vEnd; ++v) {
    const PetscInt *end;
    PetscInt        above, at[3];

    PetscCall(DMPlexGetTreeParent(dm, v, &above, NULL));
    if (above == v) continue;
    PetscCall(DMPlexGetCone(dm, above, &end));
    for (PetscInt i = 0; i < 3; ++i) PetscCall(PetscSectionGetOffset(section, i < 2 ? end[i] : v, &at[i]));
    for (PetscInt d = 0; d < 2; ++d) x[at[2] + d] = 0.5 * (x[at[0] + d] + x[at[1] + d]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The vertices of a mesh with curved sides, which p4est knows as that of the file */
PetscErrorCode AbutTreesMove_Private(AbutMesh mesh, p4est_t *p4est, DM dm)
{
  PetscInt     c, folded = 0;
  PetscSection section;
  Vec          coordinates;
  PetscScalar *x;

  PetscFunctionBegin;
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(VecGetArray(coordinates, &x));
  PetscCall(DMPlexGetHeightStratum(dm, 0, &c, NULL));
  for (p4est_topidx_t t = p4est->first_local_tree; t <= p4est->last_local_tree; ++t) {
    p4est_tree_t *tree = p4est_tree_array_index(p4est->trees, t);

    for (size_t i = 0; i < tree->quadrants.elem_count; ++i, ++c) {
      AbutQuadPlace q, parent;
      PetscInt      child;

      PetscCall(AbutQuadPlaceFind_Private(mesh->first, t, p4est_quadrant_array_index(&tree->quadrants, i), &parent, &q, &child));
      folded += AbutQuadPlaceIsFolded_Private(&q);
      PetscCall(AbutQuadPlaceSet_Private(dm, c, &q, &parent, child, section, x));
    }
  }
  PetscCall(AbutTreesHang_Private(dm, section, x));
  PetscCall(VecRestoreArray(coordinates, &x));
  PetscCall(DMSetCoordinatesLocal(dm, coordinates));
  PetscCall(AbutFirstCheckMoved_Private(mesh, folded));
  PetscFunctionReturn(PETSC_SUCCESS);
}
