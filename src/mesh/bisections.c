#include "first.h"
#include "triangles.h"

/* Triangles of a mesh from a file: labels of the DMPLEX say on which side of the body a side of a cell lies, and how often a first cell was
   bisected to the present one. New vertices on a curved side move to its curve, in the DMPLEX itself: it has the mesh as it is. */

#define ABUT_LABEL_SIDES      "Abut sides"
#define ABUT_LABEL_BISECTIONS "Abut bisections"

/* On all ranks, of which only the first has cells: side k of cell c is the k-th of its cone */
PetscErrorCode AbutBisectionsBegin_Private(AbutMesh mesh, DM dm)
{
  const AbutFirst f = mesh->first;
  DMLabel         sides, bisections;
  PetscInt        cStart, cEnd;
  const PetscInt *cone;

  PetscFunctionBegin;
  PetscCall(DMCreateLabel(dm, ABUT_LABEL_SIDES));
  PetscCall(DMCreateLabel(dm, ABUT_LABEL_BISECTIONS));
  PetscCall(DMGetLabel(dm, ABUT_LABEL_SIDES, &sides));
  PetscCall(DMGetLabel(dm, ABUT_LABEL_BISECTIONS, &bisections));
  PetscCall(DMPlexGetHeightStratum(dm, 0, &cStart, &cEnd));
  for (PetscInt c = cStart; c < cEnd; ++c) {
    PetscCall(DMLabelSetValue(bisections, c, 0));
    PetscCall(DMPlexGetCone(dm, c, &cone));
    for (PetscInt k = 0; k < 3; ++k)
      if (f->cellside[3 * (c - cStart) + k] >= 0) PetscCall(DMLabelSetValue(sides, cone[k], f->cellside[3 * (c - cStart) + k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* value[p]: of each point of a label, first <= p < last; -1 where it has none */
static PetscErrorCode AbutLabelGet_Private(DM dm, const char name[], PetscInt first, PetscInt last, PetscInt value[])
{
  DMLabel         label;
  IS              values, points;
  PetscInt        nvalues, n;
  const PetscInt *v, *p;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < last - first; ++i) value[i] = -1;
  PetscCall(DMGetLabel(dm, name, &label));
  PetscCall(DMLabelGetNumValues(label, &nvalues));
  PetscCall(DMLabelGetValueIS(label, &values));
  PetscCall(ISGetIndices(values, &v));
  for (PetscInt k = 0; k < nvalues; ++k) {
    PetscCall(DMLabelGetStratumIS(label, v[k], &points));
    if (!points) continue;
    PetscCall(ISGetLocalSize(points, &n));
    PetscCall(ISGetIndices(points, &p));
    for (PetscInt i = 0; i < n; ++i)
      if (p[i] >= first && p[i] < last) value[p[i] - first] = v[k];
    PetscCall(ISRestoreIndices(points, &p));
    PetscCall(ISDestroy(&points));
  }
  PetscCall(ISRestoreIndices(values, &v));
  PetscCall(ISDestroy(&values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Twice the signed area of a triangle */
static PetscErrorCode AbutTriangleArea_Private(DM dm, PetscSection section, const PetscScalar xa[], PetscInt c, PetscReal *area)
{
  const PetscInt    *side, *orientation, *end;
  const PetscScalar *x[3];
  PetscInt           offset;

  PetscFunctionBegin;
  PetscCall(DMPlexGetCone(dm, c, &side));
  PetscCall(DMPlexGetConeOrientation(dm, c, &orientation));
  for (PetscInt k = 0; k < 3; ++k) {
    PetscCall(DMPlexGetCone(dm, side[k], &end));
    PetscCall(PetscSectionGetOffset(section, end[orientation[k] < 0], &offset));
    x[k] = xa + offset;
  }
  *area = (x[1][0] - x[0][0]) * (x[2][1] - x[0][1]) - (x[1][1] - x[0][1]) * (x[2][0] - x[0][0]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutTrianglesGetAreas_Private(DM dm, PetscReal area[])
{
  PetscInt           cStart, cEnd;
  PetscSection       section;
  Vec                coordinates;
  const PetscScalar *x;

  PetscFunctionBegin;
  PetscCall(DMPlexGetHeightStratum(dm, 0, &cStart, &cEnd));
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(VecGetArrayRead(coordinates, &x));
  for (PetscInt c = cStart; c < cEnd; ++c) PetscCall(AbutTriangleArea_Private(dm, section, x, c, &area[c - cStart]));
  PetscCall(VecRestoreArrayRead(coordinates, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Before new vertices move, the area of a child is that of its parent, halved by each bisection. The transform's map from the old points to
   the new ones is right; the one back is not, in PETSc 3.18. */
static PetscErrorCode AbutBisectionsCount_Private(DMPlexTransform transform, DM old, const PetscReal oldarea[], DM dm,
                                                  const PetscReal area[])
{
  PetscInt cStart, cEnd, newStart, newEnd, *count;
  DMLabel  label;

  PetscFunctionBegin;
  PetscCall(DMPlexGetHeightStratum(old, 0, &cStart, &cEnd));
  PetscCall(DMPlexGetHeightStratum(dm, 0, &newStart, &newEnd));
  PetscCall(PetscMalloc1(cEnd - cStart, &count));
  PetscCall(AbutLabelGet_Private(old, ABUT_LABEL_BISECTIONS, cStart, cEnd, count));
  PetscCall(DMRemoveLabel(dm, ABUT_LABEL_BISECTIONS, NULL));
  PetscCall(DMCreateLabel(dm, ABUT_LABEL_BISECTIONS));
  PetscCall(DMGetLabel(dm, ABUT_LABEL_BISECTIONS, &label));
  for (PetscInt c = cStart; c < cEnd; ++c) {
    DMPolytopeType type, *types;
    PetscInt       ntypes, *sizes, *cone, *orientation, child;

    PetscCall(DMPlexGetCellType(old, c, &type));
    PetscCall(DMPlexTransformCellTransform(transform, type, c, NULL, &ntypes, &types, &sizes, &cone, &orientation));
    for (PetscInt i = 0; i < ntypes; ++i)
      for (PetscInt r = 0; r < sizes[i] && types[i] == DM_POLYTOPE_TRIANGLE; ++r) {
        PetscCall(DMPlexTransformGetTargetPoint(transform, type, types[i], c, r, &child));
        PetscCall(DMLabelSetValue(label, child,
                                  count[c - cStart] +
                                    (PetscInt)PetscFloorReal(0.5 + PetscLog2Real(oldarea[c - cStart] / area[child - newStart]))));
      }
  }
  PetscCall(PetscFree(count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The new vertices in the middle of old sides on curved sides of the body */
static PetscErrorCode AbutBisectionsMove_Private(AbutMesh mesh, DMPlexTransform transform, DM old, DM dm)
{
  PetscInt     eStart, eEnd, *side;
  PetscSection section;
  Vec          coordinates;
  PetscScalar *x;

  PetscFunctionBegin;
  PetscCall(DMPlexGetDepthStratum(old, 1, &eStart, &eEnd));
  PetscCall(PetscMalloc1(eEnd - eStart, &side));
  PetscCall(AbutLabelGet_Private(old, ABUT_LABEL_SIDES, eStart, eEnd, side));
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(VecGetArray(coordinates, &x));
  for (PetscInt e = eStart; e < eEnd; ++e) {
    DMPolytopeType type, *types;
    PetscInt       ntypes, *sizes, *cone, *orientation, vertex, offset;

    if (side[e - eStart] < 0) continue;
    PetscCall(DMPlexGetCellType(old, e, &type));
    PetscCall(DMPlexTransformCellTransform(transform, type, e, NULL, &ntypes, &types, &sizes, &cone, &orientation));
    for (PetscInt i = 0; i < ntypes; ++i) {
      if (types[i] != DM_POLYTOPE_POINT) continue;
      PetscCall(DMPlexTransformGetTargetPoint(transform, type, types[i], e, 0, &vertex));
      PetscCall(PetscSectionGetOffset(section, vertex, &offset));
      PetscCall(AbutFirstMoveToCurve_Private(mesh->first, side[e - eStart], x + offset));
    }
  }
  PetscCall(VecRestoreArray(coordinates, &x));
  PetscCall(DMSetCoordinatesLocal(dm, coordinates)); /* the global ones are made anew */
  PetscCall(PetscFree(side));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After a mesh has been transformed to another */
PetscErrorCode AbutBisectionsFollow_Private(AbutMesh mesh, DMPlexTransform transform, DM old, DM dm)
{
  PetscInt   cStart, cEnd, newStart, newEnd, bad = 0;
  PetscReal *oldarea, *area, *moved;

  PetscFunctionBegin;
  PetscCall(DMPlexGetHeightStratum(old, 0, &cStart, &cEnd));
  PetscCall(DMPlexGetHeightStratum(dm, 0, &newStart, &newEnd));
  PetscCall(PetscMalloc3(cEnd - cStart, &oldarea, newEnd - newStart, &area, newEnd - newStart, &moved));
  PetscCall(AbutTrianglesGetAreas_Private(old, oldarea));
  PetscCall(AbutTrianglesGetAreas_Private(dm, area));
  PetscCall(AbutBisectionsCount_Private(transform, old, oldarea, dm, area));
  if (mesh->first->curved) {
    PetscCall(AbutBisectionsMove_Private(mesh, transform, old, dm));
    PetscCall(AbutTrianglesGetAreas_Private(dm, moved));
    for (PetscInt c = 0; c < newEnd - newStart; ++c) bad += !(moved[c] / area[c] >= ABUT_CURVE_AREA); /* nor is it no number */
    PetscCall(AbutFirstCheckMoved_Private(mesh, bad));
  }
  PetscCall(PetscFree3(oldarea, area, moved));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutBisectionsGetLevels_Private(AbutMesh mesh, PetscInt level[])
{
  PetscInt cStart, cEnd;

  PetscFunctionBegin;
  PetscCall(DMPlexGetHeightStratum(mesh->dm, 0, &cStart, &cEnd));
  PetscCall(AbutLabelGet_Private(mesh->dm, ABUT_LABEL_BISECTIONS, cStart, cEnd, level));
  for (PetscInt c = 0; c < cEnd - cStart; ++c) level[c] = (level[c] + 1) / 2;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutMeshGetSides_Triangles(AbutMesh mesh, PetscInt side[])
{
  const AbutMeshTopology *t = &mesh->topology;
  PetscInt                eStart, eEnd, *of;

  PetscFunctionBegin;
  PetscCall(DMPlexGetDepthStratum(mesh->dm, 1, &eStart, &eEnd));
  PetscCall(PetscMalloc1(eEnd - eStart, &of));
  PetscCall(AbutLabelGet_Private(mesh->dm, ABUT_LABEL_SIDES, eStart, eEnd, of));
  for (PetscInt k = 0; k < t->corners * t->ncells; ++k) side[k] = of[t->celledge[k]];
  PetscCall(PetscFree(of));
  PetscFunctionReturn(PETSC_SUCCESS);
}
