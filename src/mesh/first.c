#include "first.h" /*I "abutmesh.h" I*/
#include <string.h>

/* The first mesh of a body whose shape is given by a gmsh file: read on one rank, the same on all */

static PetscErrorCode AbutFirstShare_Private(MPI_Comm comm, AbutFirst f)
{
  PetscInt    n[5] = {f->corners, f->ncells, f->nvertices, f->nsides, f->nsides ? f->segments[f->nsides] : 0};
  PetscMPIInt rank, count;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Bcast(n, 5, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(f->sum, sizeof(f->sum), MPI_CHAR, 0, comm));
  f->corners   = n[0];
  f->ncells    = n[1];
  f->nvertices = n[2];
  f->nsides    = n[3];
  if (rank) {
    PetscCall(PetscMalloc1(f->corners * f->ncells, &f->cell));
    PetscCall(PetscMalloc1(f->corners * f->ncells, &f->cellside));
    PetscCall(PetscMalloc1(2 * f->nvertices, &f->x));
    PetscCall(PetscMalloc1(f->nsides, &f->name));
    PetscCall(PetscMalloc1(f->nsides + 1, &f->segments));
    PetscCall(PetscMalloc1(4 * n[4], &f->segment));
  }
  PetscCall(PetscMPIIntCast(f->corners * f->ncells, &count));
  PetscCallMPI(MPI_Bcast(f->cell, count, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(f->cellside, count, MPIU_INT, 0, comm));
  PetscCall(PetscMPIIntCast(2 * f->nvertices, &count));
  PetscCallMPI(MPI_Bcast(f->x, count, MPIU_REAL, 0, comm));
  PetscCallMPI(MPI_Bcast(f->name, (PetscMPIInt)(f->nsides * sizeof(*f->name)), MPI_CHAR, 0, comm));
  PetscCallMPI(MPI_Bcast(f->segments, (PetscMPIInt)f->nsides + 1, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(f->segment, (PetscMPIInt)(4 * n[4]), MPIU_REAL, 0, comm));
  PetscCall(PetscCalloc2(f->nsides, &f->curve, f->nsides, &f->curvetext));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* On the first rank: the arrays of the file become those of the mesh */
static PetscErrorCode AbutFirstRead_Private(AbutFirst f, AbutFault *fault)
{
  AbutGmsh g;

  PetscFunctionBegin;
  PetscCall(AbutGmshRead_Private(f->path, f->region, &g, f->sum, fault));
  if (!fault->text[0]) PetscCall(AbutFirstOrient_Private(&g, fault));
  if (!fault->text[0]) PetscCall(AbutFirstOutline_Private(&g, f, fault));
  if (!fault->text[0]) {
    f->corners   = g.corners;
    f->ncells    = g.ncells;
    f->nvertices = g.nvertices;
    f->cell      = g.cell;
    f->x         = g.x;
    g.cell       = NULL;
    g.x          = NULL;
  }
  PetscCall(AbutGmshFree_Private(&g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutFirstDestroy_Private(AbutFirst *first)
{
  AbutFirst f = *first;

  PetscFunctionBegin;
  if (!f) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt s = 0; s < f->nsides && f->curve; ++s) {
    PetscCall(AbutCurveDestroy_Private(&f->curve[s]));
    PetscCall(PetscFree(f->curvetext[s]));
  }
  PetscCall(PetscFree2(f->curve, f->curvetext));
  PetscCall(PetscFree(f->path));
  PetscCall(PetscFree(f->region));
  PetscCall(PetscFree(f->cell));
  PetscCall(PetscFree(f->cellside));
  PetscCall(PetscFree(f->x));
  PetscCall(PetscFree(f->name));
  PetscCall(PetscFree(f->segments));
  PetscCall(PetscFree(f->segment));
  PetscCall(PetscFree(*first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* By which a checkpoint knows the mesh again, wherever the file lies */
PetscErrorCode AbutFirstDescribe_Private(AbutMesh mesh, char text[], size_t len)
{
  const AbutFirst f     = mesh->first;
  const char     *slash = strrchr(f->path, '/');

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(text, len, "%ss of order %d, region %s of %s, checksum %s", AbutShapeNames[mesh->shape], (int)mesh->order,
                          f->region ? f->region : "(all)", slash ? slash + 1 : f->path, f->sum));
  for (PetscInt s = 0; s < f->nsides && f->curved; ++s) {
    PetscCall(PetscStrlcat(text, ", ", len));
    PetscCall(PetscStrlcat(text, f->curvetext[s] ? f->curvetext[s] : "", len));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutMeshSetFile - Makes the mesh that of a gmsh file

   Collective

   Input Parameters:
+  mesh   - the mesh
.  path   - the file: versions 2.2 and 4.1, text or binary
-  region - name, or number, of the physical surface whose cells are the body; `NULL` for all cells of the file

   Level: intermediate

   Notes:
   The cells are all triangles or all quads, with nodes at their corners. The physical curves of the file, with their names or else their
   numbers, are the sides of the body; every line of the boundary belongs to one. No name may be the number of
   another group of its kind that has none. Lengths are in the unit of the scene. Clockwise cells are turned round, and nodes of no cell do
   not count. Whatever else is wrong with the file is bad input: one line, on all ranks.

   The box of the mesh, `AbutMeshGetBox()`, is then the smallest around all vertices.

   Limits: one body is one piece, and has at most 64 sides. Every rank holds the first mesh. Its vertices cannot be tied
   (`AbutMeshSetTies()`), its triangles not be merged, and its quads are balanced.

.seealso: `AbutMeshSetCurve()`, `AbutMeshSetBox()`, `AbutMeshSetFromOptions()`, `AbutMeshGetSideSegments()`
@*/
PetscErrorCode AbutMeshSetFile(AbutMesh mesh, const char path[], const char region[])
{
  MPI_Comm      comm   = PetscObjectComm((PetscObject)mesh);
  const char   *prefix = ((PetscObject)mesh)->prefix ? ((PetscObject)mesh)->prefix : "";
  AbutFault     fault  = {""};
  AbutFirst     f;
  PetscMPIInt   rank;
  PetscLogEvent event;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(mesh, ABUTMESH_CLASSID, 1);
  PetscCheck(!mesh->setupcalled, comm, PETSC_ERR_ORDER, "Call AbutMeshSetFile() before AbutMeshSetUp()");
  PetscCall(AbutLogEventGet("AbutReadGmsh", ABUTMESH_CLASSID, &event));
  PetscCall(PetscLogEventBegin(event, mesh, 0, 0, 0));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscNew(&f));
  PetscCall(PetscStrallocpy(path, &f->path));
  PetscCall(PetscStrallocpy(region, &f->region));
  if (!rank) PetscCall(AbutFirstRead_Private(f, &fault));
  PetscCallMPI(MPI_Bcast(fault.text, sizeof(fault.text), MPI_CHAR, 0, comm));
  if (fault.text[0]) PetscCall(AbutFirstDestroy_Private(&f));
  AbutCheckInput(!fault.text[0], comm, "%smesh_file: %s: %s", prefix, path, fault.text);
  PetscCall(AbutFirstShare_Private(comm, f));
  PetscCall(PetscLogEventEnd(event, mesh, 0, 0, 0));
  PetscCall(AbutFirstDestroy_Private(&mesh->first));
  mesh->first    = f;
  mesh->shape    = f->corners == 4 ? ABUT_QUAD : ABUT_TRIANGLE;
  mesh->shapeset = PETSC_TRUE;
  for (PetscInt d = 0; d < 2; ++d) {
    mesh->cells[d] = 1;
    mesh->lower[d] = mesh->upper[d] = f->x[d];
    for (PetscInt v = 0; v < f->nvertices; ++v) {
      mesh->lower[d] = PetscMin(mesh->lower[d], f->x[2 * v + d]);
      mesh->upper[d] = PetscMax(mesh->upper[d], f->x[2 * v + d]);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutMeshGetFile - The gmsh file of a mesh

   Not Collective

   Input Parameter:
.  mesh - the mesh

   Output Parameter:
.  path - the file, `NULL` for a box

   Level: intermediate

.seealso: `AbutMeshSetFile()`
@*/
PetscErrorCode AbutMeshGetFile(AbutMesh mesh, const char *path[])
{
  PetscFunctionBegin;
  *path = mesh->first ? mesh->first->path : NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutMeshGetSideSegments - The straight pieces of a side in the first mesh; the mesh need not be set up

   Not Collective

   Input Parameters:
+  mesh - the mesh, its keys read
-  side - number of the side

   Output Parameters:
+  n - how many segments; 1 for the side of a box
-  x - [4*n] first and last point of each, with the body on the left, owned by the mesh; the end of one is the beginning of the next, to
       the last bit, except where the side is in several pieces

   Level: developer

   Note:
   A side that closes on itself, as that of a hole, begins at its lowest, then leftmost, vertex.

.seealso: `AbutMeshGetSideEnds()`, `AbutMeshSetFile()`
@*/
PetscErrorCode AbutMeshGetSideSegments(AbutMesh mesh, PetscInt side, PetscInt *n, const PetscReal *x[])
{
  const AbutFirst f = mesh->first;
  PetscReal       normal[2];

  PetscFunctionBegin;
  PetscValidHeaderSpecific(mesh, ABUTMESH_CLASSID, 1);
  if (f) {
    *n = f->segments[side + 1] - f->segments[side];
    *x = f->segment + 4 * f->segments[side];
  } else {
    PetscCall(AbutMeshGetSideEnds(mesh, side, mesh->ends[side], normal));
    *n = 1;
    *x = mesh->ends[side];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshIsSideStraight - Whether a side is one piece of one straight line; the mesh need not be set up

   Not Collective

   Input Parameters:
+  mesh - the mesh, its keys read
-  side - number of the side

   Output Parameter:
.  straight - if not, `AbutMeshGetSideEnds()` is bad input

   Level: developer

.seealso: `AbutMeshGetSideSegments()`
@*/
PetscErrorCode AbutMeshIsSideStraight(AbutMesh mesh, PetscInt side, PetscBool *straight)
{
  const PetscReal  tiny = 1e-9; /* of the length of the side */
  const PetscReal *x, *last;
  PetscReal        d[2], length2;
  PetscInt         n;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetSideSegments(mesh, side, &n, &x));
  last = x + 4 * n - 2;
  for (PetscInt i = 0; i < 2; ++i) d[i] = last[i] - x[i];
  length2   = d[0] * d[0] + d[1] * d[1];
  *straight = (PetscBool)(length2 > 0.);
  for (PetscInt k = 0; k + 1 < n && *straight; ++k) {
    const PetscReal *p = x + 4 * k + 2, *next = x + 4 * (k + 1);

    if (p[0] != next[0] || p[1] != next[1] || PetscAbsReal(d[0] * (p[1] - x[1]) - d[1] * (p[0] - x[0])) > tiny * length2)
      *straight = PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutMeshCovers - Whether a point lies in the body; the mesh need not be set up

   Not Collective

   Input Parameters:
+  mesh - the mesh, its keys read
-  x    - [2] the point

   Output Parameter:
.  covers - `PETSC_TRUE` if it lies in the box, or in a cell of the file and inside all curves, or on the border of those

   Level: developer

   Note:
   Such a point lies in a cell of every later mesh. One between a cell of the file and a curve that bends outwards may not, and is not
   covered.

.seealso: `AbutMeshGetBox()`, `AbutMeshSetFile()`
@*/
PetscErrorCode AbutMeshCovers(AbutMesh mesh, const PetscReal x[2], PetscBool *covers)
{
  const AbutFirst f = mesh->first;

  PetscFunctionBegin;
  *covers = (PetscBool)(!f && x[0] >= mesh->lower[0] && x[0] <= mesh->upper[0] && x[1] >= mesh->lower[1] && x[1] <= mesh->upper[1]);
  for (PetscInt c = 0; f && c < f->ncells && !*covers; ++c) {
    *covers = PETSC_TRUE;
    for (PetscInt k = 0; k < f->corners && *covers; ++k) {
      const PetscReal *a = f->x + 2 * f->cell[f->corners * c + k], *b = f->x + 2 * f->cell[f->corners * c + (k + 1) % f->corners],
                      d[2] = {b[0] - a[0], b[1] - a[1]};

      *covers = (PetscBool)(d[0] * (x[1] - a[1]) - d[1] * (x[0] - a[0]) >= -1e-9 * (d[0] * d[0] + d[1] * d[1]));
    }
  }
  if (f && *covers) {
    PetscBool beyond;

    PetscCall(AbutFirstBeyondCurve_Private(f, x, &beyond));
    *covers = (PetscBool)!beyond;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
