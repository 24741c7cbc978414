#include "first.h" /*I "abutmesh.h" I*/

/* Which ranks have the cells of a mesh */

/* The first of n cells, in the order of the curve that both shapes follow, that belongs to a rank: equal shares for the ranks of the mesh,
   none for others. The one after the last rank is n. */
PetscInt64 AbutMeshShare_Private(AbutMesh mesh, PetscMPIInt size, PetscInt64 n, PetscMPIInt rank)
{
  const PetscMPIInt nranks = mesh->nranks ? mesh->nranks : size, of = PetscMax(0, PetscMin(rank - mesh->firstrank, nranks));

  return n * of / nranks;
}

/*@
   AbutMeshSetRanks - Which ranks have the cells of a mesh: a mesh that is set up moves there, later ones stay there

   Collective

   Input Parameters:
+  mesh  - the mesh
.  first - the first of them
-  n     - how many; 0 with `first` = 0 for all of the communicator, as in a new mesh

   Level: developer

   Note:
   The mesh stays an object of all ranks of its communicator, and the others have no cells of it. If it moves, every array got from it
   before is no longer valid.

.seealso: `AbutMeshGetRanks()`, `AbutBodySetRanks()`
@*/
PetscErrorCode AbutMeshSetRanks(AbutMesh mesh, PetscMPIInt first, PetscMPIInt n)
{
  DM          dm = mesh->dm;
  PetscMPIInt size;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(mesh, ABUTMESH_CLASSID, 1);
  PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)mesh), &size));
  PetscCheck(first >= 0 && n >= (first > 0) && first + n <= size, PetscObjectComm((PetscObject)mesh), PETSC_ERR_ARG_OUTOFRANGE,
             "Ranks %d to %d are not among %d", (int)first, (int)(first + n - 1), (int)size);
  if (n == size) n = 0;
  if (first == mesh->firstrank && n == mesh->nranks) PetscFunctionReturn(PETSC_SUCCESS);
  mesh->firstrank = first;
  mesh->nranks    = n;
  if (!mesh->setupcalled) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscObjectReference((PetscObject)dm));
  PetscUseTypeMethod(mesh, distribute, &dm);
  ++mesh->generation;
  PetscCall(AbutMeshSetDM_Private(mesh, dm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshGetRanks - The ranks that have the cells of a mesh

   Not Collective

   Input Parameter:
.  mesh - the mesh

   Output Parameters:
+  first - the first of them
-  n     - how many

   Level: developer

.seealso: `AbutMeshSetRanks()`
@*/
PetscErrorCode AbutMeshGetRanks(AbutMesh mesh, PetscMPIInt *first, PetscMPIInt *n)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(mesh, ABUTMESH_CLASSID, 1);
  *first = mesh->firstrank;
  *n     = mesh->nranks;
  if (!mesh->nranks) PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)mesh), n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshGetFirstSize - How many unknowns a displacement on the first mesh will have, about, before there is one

   Not Collective

   Input Parameter:
.  mesh - the mesh, its box or file set

   Output Parameter:
.  n - of its first cells, before any of them is split

   Level: developer

.seealso: `AbutMeshSetBox()`, `AbutMeshSetFile()`
@*/
PetscErrorCode AbutMeshGetFirstSize(AbutMesh mesh, PetscReal *n)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(mesh, ABUTMESH_CLASSID, 1);
  if (mesh->first) *n = (mesh->shape == ABUT_QUAD ? 2. : 1.) * mesh->first->ncells;
  else *n = 2. * mesh->cells[0] * mesh->cells[1];
  *n *= PetscSqr(mesh->order);
  PetscFunctionReturn(PETSC_SUCCESS);
}
