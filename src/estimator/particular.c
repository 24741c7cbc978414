#include <abut/private/estimatorimpl.h> /*I "abutestimator.h" I*/

/* A constant body force for methods that know none: they judge what is left when a stress that balances it is taken off */

/*@C
   AbutEstimatorGetParticular - A stress that balances the constant body force f of a body, and a displacement that has this stress

   Not Collective

   Input Parameters:
+  body - the body
-  x    - [2] a point

   Output Parameters:
+  u - [2] displacement, length, of degree 2 in x, or `NULL`
-  s - [3] s11, s22, s12 = -f1 (x1 - c1), -f2 (x2 - c2), 0, stress; c is the middle of the box of the body

   Level: advanced

   Note:
   All are 0 where there is no body force. One that varies is not known here: `ABUT_FEATURE_BODY_FORCE_VARYING` is not to be claimed.

.seealso: `AbutEstimatorSetFeatures()`, `AbutBodyGetForce()`
@*/
PetscErrorCode AbutEstimatorGetParticular(AbutBody body, const PetscReal x[2], PetscReal u[], PetscReal s[3])
{
  AbutMesh  mesh;
  PetscReal lower[2], upper[2], f[2], young, nu, a, y[2];

  PetscFunctionBegin;
  PetscCall(AbutBodyGetForce(body, x, f));
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetBox(mesh, lower, upper));
  for (PetscInt d = 0; d < 2; ++d) {
    y[d] = x[d] - 0.5 * (lower[d] + upper[d]);
    s[d] = -f[d] * y[d];
  }
  s[2] = 0.;
  if (!u) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutBodyGetPlaneMaterial(body, &young, &nu));
  a = (1. + nu) / young; /* e11 = a ((1-nu) s11 - nu s22), integrated such that the shear vanishes */
  for (PetscInt d = 0; d < 2; ++d)
    u[d] = a * (-0.5 * (1. - nu) * f[d] * y[d] * y[d] + nu * f[!d] * y[0] * y[1] - 0.5 * nu * f[d] * y[!d] * y[!d]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
