#include "first.h" /*I "abutmesh.h" I*/

/* Diameters of the circles around and inside a triangle */
static void AbutTriangleDiameters_Private(const PetscReal a[2], const PetscReal b[2], const PetscReal c[2], PetscReal *around,
                                          PetscReal *inside)
{
  const PetscReal ab   = PetscSqrtReal(PetscSqr(b[0] - a[0]) + PetscSqr(b[1] - a[1])),
                  bc   = PetscSqrtReal(PetscSqr(c[0] - b[0]) + PetscSqr(c[1] - b[1]));
  const PetscReal ca   = PetscSqrtReal(PetscSqr(a[0] - c[0]) + PetscSqr(a[1] - c[1])),
                  area = 0.5 * PetscAbsReal((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));

  *around = ab * bc * ca / (2. * area);
  *inside = 4. * area / (ab + bc + ca);
}

/* Upper and lower diameter of a cell, the paper's Definition 1: of a triangle its two circles, of a quadrilateral the extremes over the
   four triangles of its vertices */
static void AbutCellDiameters_Private(const AbutMeshTopology *t, PetscInt c, PetscReal *upper, PetscReal *lower)
{
  const PetscInt *v = t->cell + t->corners * c, n = t->corners == 3 ? 1 : 4;

  *upper = 0.;
  *lower = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < n; ++k) {
    PetscReal around, inside;

    AbutTriangleDiameters_Private(t->x + 2 * v[k], t->x + 2 * v[(k + 1) % t->corners], t->x + 2 * v[(k + 2) % t->corners], &around,
                                  &inside);
    *upper = PetscMax(*upper, around);
    *lower = PetscMin(*lower, inside);
  }
}

static PetscReal AbutEdgeLength_Private(const AbutMeshTopology *t, PetscInt a, PetscInt b)
{
  return PetscSqrtReal(PetscSqr(t->x[2 * b] - t->x[2 * a]) + PetscSqr(t->x[2 * b + 1] - t->x[2 * a + 1]));
}

/*@
   AbutMeshGetMeasures - The paper's measures of a mesh: diameters, regularity, eq. (22), and whether Lemma 1's hypothesis holds

   Collective

   Input Parameter:
.  mesh - the mesh

   Output Parameter:
.  m - the measures, the same on all ranks

   Level: intermediate

   Note:
   Definitions 1-3 and Lemma 1 of the paper; the boundary elements are the element sides on the boundary, eq. (25).

.seealso: `AbutMeshGetTopology()`
@*/
PetscErrorCode AbutMeshGetMeasures(AbutMesh mesh, AbutMeshMeasures *m)
{
  const AbutMeshTopology *t          = &mesh->topology;
  MPI_Comm                comm       = PetscObjectComm((PetscObject)mesh);
  PetscReal               high[5]    = {0., 0., 0., 0., PETSC_MIN_REAL}, lower, upper; /* h_fe, h_be, regularity, level_max, -h_min */
  PetscReal               onboundary = 0.;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < t->ncells; ++c) {
    AbutCellDiameters_Private(t, c, &upper, &lower);
    high[0] = PetscMax(high[0], upper);
    high[2] = PetscMax(high[2], upper / lower);
    high[3] = PetscMax(high[3], (PetscReal)t->level[c]);
    for (PetscInt k = 0; k < t->corners; ++k)
      high[4] = PetscMax(high[4], -AbutEdgeLength_Private(t, t->cell[t->corners * c + k], t->cell[t->corners * c + (k + 1) % t->corners]));
  }
  for (PetscInt e = 0; e < t->nsideedges; ++e) {
    high[1] = PetscMax(high[1], AbutEdgeLength_Private(t, t->sideedge[3 * e], t->sideedge[3 * e + 1]));
    AbutCellDiameters_Private(t, t->sidecell[e], &upper, &lower);
    onboundary = PetscMax(onboundary, upper);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, high, 5, MPIU_REAL, MPIU_MAX, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &onboundary, 1, MPIU_REAL, MPIU_MAX, comm));
  m->h_fe       = high[0];
  m->h_be       = high[1];
  m->h_min      = -high[4];
  m->regularity = high[2];
  m->ratio      = high[1] / high[0];
  m->lemma      = (PetscBool)(onboundary >= high[0] * (1. - 1e-12));
  m->level_max  = (PetscInt)high[3];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshGetCellCount - Cells of the whole mesh

   Collective

   Input Parameter:
.  mesh - the mesh

   Output Parameter:
.  ncells - over all ranks

   Level: beginner

.seealso: `AbutMeshGetTopology()`
@*/
PetscErrorCode AbutMeshGetCellCount(AbutMesh mesh, PetscInt *ncells)
{
  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(&mesh->topology.ncells, ncells, 1, MPIU_INT, MPI_SUM, PetscObjectComm((PetscObject)mesh)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshView - Prints a mesh: shape, box, cells, levels

   Collective

   Input Parameters:
+  mesh   - the mesh
-  viewer - the viewer

   Level: intermediate

.seealso: `AbutMeshCreate()`
@*/
PetscErrorCode AbutMeshView(AbutMesh mesh, PetscViewer viewer)
{
  AbutMeshMeasures m;
  PetscInt         ncells;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetCellCount(mesh, &ncells));
  PetscCall(AbutMeshGetMeasures(mesh, &m));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "mesh: %s of order %" PetscInt_FMT ", %" PetscInt_FMT " cells, %" PetscInt_FMT
                                   " nodes with unknowns, levels up to %" PetscInt_FMT ", smallest side %g\n",
                                   AbutShapeNames[mesh->shape], mesh->order, ncells, mesh->topology.nglobal, m.level_max, (double)m.h_min));
  PetscFunctionReturn(PETSC_SUCCESS);
}
