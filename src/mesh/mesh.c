#include "first.h" /*I "abutmesh.h" I*/

PetscClassId      ABUTMESH_CLASSID;
PetscLogEvent     ABUTMESH_Adapt;
const char *const AbutShapes[]     = {"quad", "triangle", "AbutShape", "ABUT_", NULL};
const char *const AbutShapeNames[] = {"quad", "triangle", NULL};

static PetscErrorCode AbutMeshInitializePackage_Private(void)
{
  PetscFunctionBegin;
  if (ABUTMESH_CLASSID) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscClassIdRegister("Abut Mesh", &ABUTMESH_CLASSID));
  PetscCall(PetscLogEventRegister("AbutMeshAdapt", ABUTMESH_CLASSID, &ABUTMESH_Adapt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshCreate - Creates an empty mesh

   Collective

   Input Parameter:
.  comm - the communicator

   Output Parameter:
.  mesh - the mesh

   Options Database Keys:
+  -mesh_file <part.msh>       - a gmsh file, instead of a box; shape of the cells and names of the sides are the file's;
                                beside the scene file, or else in the current folder
.  -mesh_region <name>         - physical surface of the file whose cells are the body; all cells if it is not given
.  -mesh_curve_SIDE <curve>    - `circle xc,yc,r`, or an expression that is 0 on the side, see `AbutMeshSetCurve()`
.  -mesh_box <x0,y0,x1,y1>     - lower left and upper right corner, in the length unit of the scene
.  -mesh_cells <nx,ny>         - cells of the first mesh along each direction (triangles: twice as many)
.  -mesh_size <expression>     - largest side a cell may have, an expression in x and y: cells of the first mesh are split until they obey
.  -mesh_shape <quad|triangle> - shape of the cells
.  -mesh_order <1>             - polynomial order of the displacement: 1 to 4 on quads, 1 to 3 on triangles
-  -mesh_balance <yes>         - no: quads with a common side may differ by any number of levels, see `AbutMeshSetBalance()`

   Level: intermediate

   Note:
   The sides of a box are left, right, bottom and top. Limits: plane bodies; those of a file are listed under `AbutMeshSetFile()`.

.seealso: `AbutMeshSetFromOptions()`, `AbutMeshSetBox()`, `AbutMeshSetFile()`, `AbutMeshAdapt()`, `AbutMeshDestroy()`
@*/
PetscErrorCode AbutMeshCreate(MPI_Comm comm, AbutMesh *mesh)
{
  PetscFunctionBegin;
  PetscAssertPointer(mesh, 2);
  PetscCall(AbutMeshInitializePackage_Private());
  PetscCall(PetscHeaderCreate(*mesh, ABUTMESH_CLASSID, "AbutMesh", "Mesh of a body", "Mesh", comm, AbutMeshDestroy, AbutMeshView));
  (*mesh)->order   = 1;
  (*mesh)->balance = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshSetBox - Makes the mesh that of a box

   Logically Collective

   Input Parameters:
+  mesh  - the mesh
.  lower - [2] lower left corner
.  upper - [2] upper right corner
.  cells - [2] cells along each direction; a triangle mesh has two triangles in each
-  shape - `ABUT_QUAD` or `ABUT_TRIANGLE`

   Level: intermediate

.seealso: `AbutMeshSetFromOptions()`, `AbutMeshSetUp()`
@*/
PetscErrorCode AbutMeshSetBox(AbutMesh mesh, const PetscReal lower[2], const PetscReal upper[2], const PetscInt cells[2], AbutShape shape)
{
  MPI_Comm    comm   = PetscObjectComm((PetscObject)mesh);
  const char *prefix = ((PetscObject)mesh)->prefix ? ((PetscObject)mesh)->prefix : "";

  PetscFunctionBegin;
  PetscValidHeaderSpecific(mesh, ABUTMESH_CLASSID, 1);
  PetscCheck(!mesh->setupcalled, comm, PETSC_ERR_ORDER, "Call AbutMeshSetBox() before AbutMeshSetUp()");
  AbutCheckInput(lower[0] < upper[0] && lower[1] < upper[1], comm,
                 "%smesh_box: %g,%g,%g,%g has no area; give x0,y0,x1,y1 with x0 < x1 and y0 < y1", prefix, (double)lower[0],
                 (double)lower[1], (double)upper[0], (double)upper[1]);
  AbutCheckInput(cells[0] > 0 && cells[1] > 0 && cells[0] <= 1000000 / cells[1] * 100, comm,
                 "%smesh_cells: %" PetscInt_FMT ",%" PetscInt_FMT "; give two numbers from 1 up, at most 1e8 cells in all", prefix,
                 cells[0], cells[1]);
  for (PetscInt d = 0; d < 2; ++d) {
    mesh->lower[d] = lower[d];
    mesh->upper[d] = upper[d];
    mesh->cells[d] = cells[d];
  }
  PetscCall(AbutFirstDestroy_Private(&mesh->first));
  mesh->shape    = shape;
  mesh->shapeset = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshSetOrder - The polynomial order of the displacement

   Logically Collective

   Input Parameters:
+  mesh  - the mesh, its box set
-  order - 1 to 4 on quads, 1 to 3 on triangles

   Level: intermediate

.seealso: `AbutMeshSetBox()`, `AbutMeshGetOrder()`
@*/
PetscErrorCode AbutMeshSetOrder(AbutMesh mesh, PetscInt order)
{
  const char    *prefix = ((PetscObject)mesh)->prefix ? ((PetscObject)mesh)->prefix : "";
  const PetscInt most   = mesh->shape == ABUT_QUAD ? ABUT_ORDER_MAX : ABUT_ORDER_MAX - 1;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(mesh, ABUTMESH_CLASSID, 1);
  PetscCheck(!mesh->setupcalled, PetscObjectComm((PetscObject)mesh), PETSC_ERR_ORDER, "Call AbutMeshSetOrder() before AbutMeshSetUp()");
  AbutCheckInput(order >= 1 && order <= most, PetscObjectComm((PetscObject)mesh),
                 "%smesh_order: %" PetscInt_FMT " is not there; give 1 to %" PetscInt_FMT " for cells of shape %s", prefix, order, most,
                 AbutShapeNames[mesh->shape]);
  mesh->order = order;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshGetOrder - The polynomial order of the displacement

   Not Collective

   Input Parameter:
.  mesh - the mesh

   Output Parameter:
.  order - 1 to 4

   Level: intermediate

.seealso: `AbutMeshSetOrder()`
@*/
PetscErrorCode AbutMeshGetOrder(AbutMesh mesh, PetscInt *order)
{
  PetscFunctionBegin;
  *order = mesh->order;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes over a new DM, and makes what is derived from it */
PetscErrorCode AbutMeshSetDM_Private(AbutMesh mesh, DM dm)
{
  PetscFunctionBegin;
  PetscCall(AbutMeshTopologyReset_Private(mesh));
  PetscCall(DMDestroy(&mesh->dm));
  mesh->dm = dm;
  PetscCall(AbutMeshTopologyBuild_Private(mesh));
  PetscCall(AbutMeshSidesBuild_Private(mesh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshSetUp - Makes the first mesh and distributes it

   Collective

   Input Parameter:
.  mesh - the mesh

   Level: intermediate

.seealso: `AbutMeshSetBox()`, `AbutMeshAdapt()`, `AbutMeshGetTopology()`
@*/
PetscErrorCode AbutMeshSetUp(AbutMesh mesh)
{
  DM dm;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(mesh, ABUTMESH_CLASSID, 1);
  if (mesh->setupcalled) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(mesh->shapeset, PetscObjectComm((PetscObject)mesh), PETSC_ERR_ARG_WRONGSTATE,
             "Call AbutMeshSetBox(), AbutMeshSetFile() or AbutMeshSetFromOptions() first");
  PetscCall(AbutMeshSetOrder(mesh, mesh->order)); /* the shape may have come later */
  PetscCall(AbutMeshSetBalance(mesh, mesh->balance));
  mesh->setupcalled = PETSC_TRUE;
  PetscCall((mesh->shape == ABUT_QUAD ? AbutMeshCreate_Forest : AbutMeshCreate_Triangles)(mesh));
  PetscUseTypeMethod(mesh, create, &dm);
  PetscCall(AbutMeshSetDM_Private(mesh, dm));
  PetscCall(AbutMeshRefineToSize_Private(mesh));
  PetscUseTypeMethod(mesh, keepfirst);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshAdapt - Splits the marked cells, and those that must follow, merges others, distributes the new mesh, and moves it to its ties

   Collective

   Input Parameters:
+  mesh  - the mesh
-  marks - [ncells] the local cells to split; on all ranks `NULL` for none

   Level: intermediate

   Notes:
   Quadrilaterals are split in four and kept 2:1 across sides, which is the paper's extra rule against spurious refinement
   (`AbutMeshSetBalance()`); triangles are split in four by bisections, and their neighbours bisected until the mesh conforms.
   Every array got from the mesh before is no longer valid; without cells to split or to merge, and with the ties as they were, nothing
   happens.

.seealso: `AbutMeshGetTopology()`, `AbutMeshGetGeneration()`, `AbutMeshSetTies()`, `AbutMeshSetCoarsening()`, `AbutAdaptorMark()`
@*/
PetscErrorCode AbutMeshAdapt(AbutMesh mesh, const PetscBool marks[])
{
  DM        dm;
  PetscBool splits;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(mesh, ABUTMESH_CLASSID, 1);
  PetscCheck(mesh->setupcalled, PetscObjectComm((PetscObject)mesh), PETSC_ERR_ORDER, "Call AbutMeshSetUp() first");
  splits = (PetscBool)(marks || mesh->coarsen); /* a rank without cells may have no array */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &splits, 1, MPIU_BOOL, MPI_LOR, PetscObjectComm((PetscObject)mesh)));
  if (!splits && !mesh->tiesmoved) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscLogEventBegin(ABUTMESH_Adapt, mesh, 0, 0, 0));
  PetscCall(AbutJournalAdapt_Private(mesh, splits, marks));
  dm = mesh->dm;
  if (splits) PetscUseTypeMethod(mesh, refine, marks, &dm);
  if (dm == mesh->dm) PetscCall(PetscObjectReference((PetscObject)dm));
  if (dm != mesh->dm || mesh->tiesmoved) {
    ++mesh->generation;
    PetscCall(AbutMeshSetDM_Private(mesh, dm));
  } else PetscCall(DMDestroy(&dm)); /* no four marked cells were one */
  PetscCall(PetscFree(mesh->coarsen));
  PetscCall(PetscLogEventEnd(ABUTMESH_Adapt, mesh, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshGetGeneration - How often the mesh has been adapted

   Not Collective

   Input Parameter:
.  mesh - the mesh

   Output Parameter:
.  generation - 0 for the first mesh

   Level: developer

.seealso: `AbutMeshAdapt()`
@*/
PetscErrorCode AbutMeshGetGeneration(AbutMesh mesh, PetscInt *generation)
{
  PetscFunctionBegin;
  *generation = mesh->generation;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshGetDM - The `DMPLEX` of the mesh

   Not Collective

   Input Parameter:
.  mesh - the mesh

   Output Parameter:
.  dm - the `DMPLEX`, owned by the mesh; it changes with `AbutMeshAdapt()`

   Level: intermediate

.seealso: `AbutMeshGetTopology()`
@*/
PetscErrorCode AbutMeshGetDM(AbutMesh mesh, DM *dm)
{
  PetscFunctionBegin;
  *dm = mesh->dm;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshGetShape - The shape of the cells

   Not Collective

   Input Parameter:
.  mesh - the mesh

   Output Parameter:
.  shape - `ABUT_QUAD` or `ABUT_TRIANGLE`

   Level: intermediate

.seealso: `AbutMeshSetBox()`
@*/
PetscErrorCode AbutMeshGetShape(AbutMesh mesh, AbutShape *shape)
{
  PetscFunctionBegin;
  *shape = mesh->shape;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshGetBox - The corners of the box, for a mesh from a file those of the smallest box around its first vertices

   Not Collective

   Input Parameter:
.  mesh - the mesh

   Output Parameters:
+  lower - [2] lower left corner
-  upper - [2] upper right corner

   Level: intermediate

.seealso: `AbutMeshSetBox()`
@*/
PetscErrorCode AbutMeshGetBox(AbutMesh mesh, PetscReal lower[2], PetscReal upper[2])
{
  PetscFunctionBegin;
  for (PetscInt d = 0; d < 2; ++d) {
    lower[d] = mesh->lower[d];
    upper[d] = mesh->upper[d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshDestroy - Frees a mesh

   Collective

   Input Parameter:
.  mesh - the mesh; set to `NULL`

   Level: intermediate

.seealso: `AbutMeshCreate()`
@*/
PetscErrorCode AbutMeshDestroy(AbutMesh *mesh)
{
  PetscFunctionBegin;
  if (!*mesh) PetscFunctionReturn(PETSC_SUCCESS);
  PetscValidHeaderSpecific(*mesh, ABUTMESH_CLASSID, 1);
  if (--((PetscObject)*mesh)->refct > 0) {
    *mesh = NULL;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(AbutMeshTopologyReset_Private(*mesh));
  PetscCall(DMDestroy(&(*mesh)->dm));
  for (PetscInt side = 0; side < ABUT_BOX_SIDES; ++side) PetscCall(PetscFree((*mesh)->knot[side]));
  PetscCall(PetscFree((*mesh)->coarsen));
  PetscCall(AbutJournalDestroy_Private(*mesh));
  PetscTryTypeMethod(*mesh, destroy);
  PetscCall(AbutExpressionDestroy(&(*mesh)->size));
  PetscCall(AbutFirstDestroy_Private(&(*mesh)->first));
  PetscCall(PetscHeaderDestroy(mesh));
  PetscFunctionReturn(PETSC_SUCCESS);
}
