#include "first.h" /*I "abutmesh.h" I*/

/* The keys of a mesh */

/*@
   AbutMeshSetFromOptions - Reads the keys of a mesh

   Collective

   Input Parameter:
.  mesh - the mesh; its keys are listed under `AbutMeshCreate()`

   Level: intermediate

.seealso: `AbutMeshCreate()`, `AbutMeshSetUp()`
@*/
PetscErrorCode AbutMeshSetFromOptions(AbutMesh mesh)
{
  MPI_Comm    comm     = PetscObjectComm((PetscObject)mesh);
  const char *prefix   = ((PetscObject)mesh)->prefix ? ((PetscObject)mesh)->prefix : "";
  PetscReal   box[4]   = {mesh->lower[0], mesh->lower[1], mesh->upper[0], mesh->upper[1]};
  PetscInt    cells[2] = {mesh->cells[0], mesh->cells[1]}, shape = mesh->shape, order = mesh->order;
  PetscBool   hasbox, hascells, hasshape, hasorder, hassize, hasbalance, balance = mesh->balance;
  PetscBool   hasfile, hasregion;
  char        size[PETSC_MAX_PATH_LEN] = "", file[PETSC_MAX_PATH_LEN] = "", region[256] = "", key[256];

  PetscFunctionBegin;
  PetscValidHeaderSpecific(mesh, ABUTMESH_CLASSID, 1);
  PetscObjectOptionsBegin((PetscObject)mesh);
  PetscCall(AbutOptionsString(PetscOptionsObject, "-mesh_file", "A gmsh file", file, sizeof(file), &hasfile));
  PetscCall(AbutOptionsString(PetscOptionsObject, "-mesh_region", "Its physical surface", region, sizeof(region), &hasregion));
  PetscCall(AbutOptionsReals(PetscOptionsObject, "-mesh_box", "x0,y0,x1,y1", 4, box, &hasbox));
  PetscCall(AbutOptionsInts(PetscOptionsObject, "-mesh_cells", "nx,ny", 2, cells, &hascells));
  PetscCall(AbutOptionsEnum(PetscOptionsObject, "-mesh_shape", "Shape of the cells", AbutShapeNames, &shape, &hasshape));
  PetscCall(AbutOptionsInt(PetscOptionsObject, "-mesh_order", "Order of the displacement", &order, &hasorder));
  PetscCall(AbutOptionsBool(PetscOptionsObject, "-mesh_balance", "At most one level between neighbours", &balance, &hasbalance));
  PetscCall(AbutOptionsString(PetscOptionsObject, "-mesh_size", "Largest side of the cells", size, sizeof(size), &hassize));
  PetscOptionsEnd();
  PetscCall(PetscSNPrintf(key, sizeof(key), "%smesh_size", prefix));
  PetscCall(AbutExpressionDestroy(&mesh->size));
  if (hassize) PetscCall(AbutExpressionCreate(comm, key, size, &mesh->size));
  AbutCheckInput(!hasfile || (!hasbox && !hascells), comm, "%smesh_file: given, and %smesh_%s too; give the file, or box and cells", prefix,
                 prefix, hasbox ? "box" : "cells");
  AbutCheckInput(hasfile || !hasregion, comm, "%smesh_region: there is no file whose region this is; give %smesh_file, or leave it out",
                 prefix, prefix);
  if (hasfile) {
    char found[PETSC_MAX_PATH_LEN];

    PetscCall(PetscSNPrintf(key, sizeof(key), "%smesh_file", prefix));
    PetscCall(AbutFileFind(comm, key, file, found, sizeof(found)));
    PetscCall(AbutMeshSetFile(mesh, found, hasregion ? region : NULL));
  }
  AbutCheckInput(!mesh->first || !hasshape || shape == (PetscInt)mesh->shape, comm,
                 "%smesh_shape: %s, but the cells of %s are %ss; leave it out", prefix, AbutShapeNames[shape], mesh->first->path,
                 AbutShapeNames[mesh->shape]);
  AbutCheckInput(mesh->shapeset || (hasbox && hascells), comm, "%smesh_%s: missing; give %s", prefix, hasbox ? "cells" : "box",
                 hasbox ? "the cells along each direction, for example 8,2" : "the corners x0,y0,x1,y1 of the box, for example 0,0,4,1");
  if (mesh->first) PetscCall(AbutFirstCurvesFromOptions_Private(mesh));
  else if (hasbox || hascells || hasshape) PetscCall(AbutMeshSetBox(mesh, box, box + 2, cells, (AbutShape)shape));
  if (hasorder || hasshape) PetscCall(AbutMeshSetOrder(mesh, order));
  if (hasbalance) PetscCall(AbutMeshSetBalance(mesh, balance));
  PetscFunctionReturn(PETSC_SUCCESS);
}
