#include <abut/private/meshimpl.h> /*I "abutmesh.h" I*/

/* The paper's extra rule for quads, and meshes without it */

/*@
   AbutMeshSetBalance - Whether quads with a common side differ by at most one level

   Logically Collective

   Input Parameters:
+  mesh    - the mesh, its box and order set
-  balance - `PETSC_TRUE` (default), or `PETSC_FALSE` for a mesh without the paper's extra rule

   Level: advanced

   Notes:
   Without balance only the marked cells are split. The sides of fine cells on one of a coarse cell are joined to it by a mortar condition
   with multipliers on the fine sides. The trace of the coarse cell is one of those of the fine ones, so the condition makes them equal: all
   nodes on the coarse side take the values of its function there.

   For the study of what the rule is good for: one rank, quads, order 1. Criterion (27) may split cells without end then; the residual
   estimator, and meshes that follow the edges of contacts, want balance.

   Source: the paper, Figs. 5 and 6.

.seealso: `AbutMeshAdapt()`, `AbutMeshGetBalance()`
@*/
PetscErrorCode AbutMeshSetBalance(AbutMesh mesh, PetscBool balance)
{
  const MPI_Comm comm   = PetscObjectComm((PetscObject)mesh);
  const char    *prefix = ((PetscObject)mesh)->prefix ? ((PetscObject)mesh)->prefix : "";
  PetscMPIInt    size;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(mesh, ABUTMESH_CLASSID, 1);
  PetscCheck(!mesh->setupcalled, comm, PETSC_ERR_ORDER, "Call AbutMeshSetBalance() before AbutMeshSetUp()");
  PetscCallMPI(MPI_Comm_size(comm, &size));
  AbutCheckInput(balance || mesh->shape == ABUT_QUAD, comm,
                 "%smesh_balance: triangles are always refined such that they fit; leave it out, or give %smesh_shape: quad", prefix,
                 prefix);
  AbutCheckInput(balance || mesh->order == 1, comm, "%smesh_balance: no is for order 1 only; leave it out, or give %smesh_order: 1", prefix,
                 prefix);
  AbutCheckInput(balance || !mesh->first, comm, "%smesh_balance: no is for boxes only; leave it out, or give %smesh_box", prefix, prefix);
  AbutCheckInput(balance || size == 1, comm, "%smesh_balance: no is for one rank only; leave it out, or run on one", prefix);
  mesh->balance = balance;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshGetBalance - Whether quads with a common side differ by at most one level

   Not Collective

   Input Parameter:
.  mesh - the mesh

   Output Parameter:
.  balance - `PETSC_TRUE` if they do

   Level: advanced

.seealso: `AbutMeshSetBalance()`
@*/
PetscErrorCode AbutMeshGetBalance(AbutMesh mesh, PetscBool *balance)
{
  PetscFunctionBegin;
  *balance = mesh->balance;
  PetscFunctionReturn(PETSC_SUCCESS);
}
