#include <abut/private/meshimpl.h> /*I "abutmesh.h" I*/
#include <petscdt.h>

/*@
   AbutMeshCreateQuadrature - Gauss points of the reference cell of a mesh

   Not Collective

   Input Parameters:
+  mesh - the mesh, set up
-  n    - points in each direction

   Output Parameter:
.  quadrature - n^2 points in [-1,1]^2 for quads, in (0,0)(1,0)(0,1) for triangles, for which those of a square are folded; exact up to
   degree 2n-1, in each coordinate for quads

   Level: developer

.seealso: `AbutMeshEvaluateBasis()`, `AbutBodyGetCellStresses()`
@*/
PetscErrorCode AbutMeshCreateQuadrature(AbutMesh mesh, PetscInt n, PetscQuadrature *quadrature)
{
  PetscReal       *xi, *w;
  const PetscReal *fixedxi, *fixedw;
  PetscInt         npoints;

  PetscFunctionBegin;
  if (mesh->topology.corners == 4) {
    PetscCall(PetscDTGaussTensorQuadrature(2, 1, n, -1., 1., quadrature));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscDTStroudConicalQuadrature(2, 1, n, -1., 1., quadrature));
  PetscCall(PetscQuadratureGetData(*quadrature, NULL, NULL, &npoints, &fixedxi, &fixedw));
  xi = (PetscReal *)fixedxi; /* owned by the quadrature */
  w  = (PetscReal *)fixedw;
  for (PetscInt i = 0; i < 2 * npoints; ++i) xi[i] = 0.5 * (1. + xi[i]); /* PETSc's triangle is (-1,-1)(1,-1)(-1,1) */
  for (PetscInt q = 0; q < npoints; ++q) w[q] *= 0.25;
  PetscFunctionReturn(PETSC_SUCCESS);
}
