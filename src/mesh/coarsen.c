#include <abut/private/meshimpl.h> /*I "abutmesh.h" I*/

/* Cells that may become one again */

/*@C
   AbutMeshSetCoarsening - Marks the cells that the next `AbutMeshAdapt()` may merge

   Collective

   Input Parameters:
+  mesh  - the mesh, set up
-  marks - [ncells] the local cells that may go; on all ranks `NULL` for none

   Level: intermediate

   Notes:
   Replaces the marks set before. Of each cell one level goes at most, and none below the first mesh, its `-mesh_size` included.

   Four quadrilaterals become one again if all of them are marked, none is to be split, and the mesh stays 2:1 across sides.

   Of triangles a vertex goes if all cells around it are marked, none of them is to be split, and the others do not need it to conform: the
   mesh is made again from the first one, by bisecting the sides in whose middle there is a vertex that stays. Diagonals of parallelograms
   may come to lie the other way. Every rank holds all vertices while it is made. Where the vertices that stay cannot be had in this way
   nothing is merged: of a grid whose cells are more than 1.7 times as long as wide some triangles stay finer than marked.

   Triangles of a file (`AbutMeshSetFile()`) are not merged.

   A cell that was made by a merge and is split again stays split, and a vertex goes only once: so no sequence of marks splits and merges
   for ever.

.seealso: `AbutMeshAdapt()`, `AbutMeshKeepCell()`, `AbutAdaptorMark()`
@*/
PetscErrorCode AbutMeshSetCoarsening(AbutMesh mesh, const PetscBool marks[])
{
  const AbutMeshTopology *t   = &mesh->topology;
  PetscBool               any = PETSC_FALSE;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(mesh, ABUTMESH_CLASSID, 1);
  PetscCheck(!marks || !mesh->first || mesh->shape == ABUT_QUAD, PetscObjectComm((PetscObject)mesh), PETSC_ERR_SUP,
             "Triangles of a file are not merged");
  PetscCall(PetscFree(mesh->coarsen));
  PetscCall(PetscMalloc1(t->ncells + 1, &mesh->coarsen)); /* not NULL on a rank without cells */
  for (PetscInt c = 0; c < t->ncells; ++c) {
    mesh->coarsen[c] = (PetscBool)(marks && marks[c] && t->level[c]);
    any              = (PetscBool)(any || mesh->coarsen[c]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPIU_BOOL, MPI_LOR, PetscObjectComm((PetscObject)mesh)));
  if (!any) PetscCall(PetscFree(mesh->coarsen));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshKeepCell - Takes away the mark of a cell that might be merged

   Not Collective

   Input Parameters:
+  mesh - the mesh
-  c    - local cell

   Level: developer

.seealso: `AbutMeshSetCoarsening()`
@*/
PetscErrorCode AbutMeshKeepCell(AbutMesh mesh, PetscInt c)
{
  PetscFunctionBegin;
  if (mesh->coarsen) mesh->coarsen[c] = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
