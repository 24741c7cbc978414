#include <abut/private/estimatorimpl.h> /*I "abutestimator.h" I*/

/* A constant body force, and an initial strain that is linear, for methods that know none: they judge what is left when a stress that
   balances the one is taken off, and the displacement that frees of the other */

/* The displacement of an initial strain that is linear, at y from c: the strain is a[i] + b[i][0] y1 + b[i][1] y2, i = 11, 22, 12, and nu
   times that across the plane in the first two, as in plane strain */
static PetscErrorCode AbutInitialDisplacement_Private(AbutBody body, const PetscReal c[2], const PetscReal extent[2], PetscReal nu,
                                                      const PetscReal y[2], PetscReal u[2])
{
  PetscReal a[3], b[3][2], e[3][4];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 3; ++k) {
    const PetscReal x[2] = {c[0] + (k == 1 ? 0.5 * extent[0] : 0.), c[1] + (k == 2 ? 0.5 * extent[1] : 0.)};

    PetscCall(AbutBodyGetInitialStrain(body, x, e[k]));
    for (PetscInt i = 0; i < 2; ++i) e[k][i] += nu * e[k][3];
  }
  for (PetscInt i = 0; i < 3; ++i) {
    a[i] = e[0][i];
    for (PetscInt d = 0; d < 2; ++d) b[i][d] = (e[1 + d][i] - e[0][i]) / (0.5 * extent[d]);
  }
  for (PetscInt d = 0; d < 2; ++d)
    u[d] += a[d] * y[d] + a[2] * y[!d] + 0.5 * b[d][d] * y[d] * y[d] + b[d][!d] * y[0] * y[1] + (b[2][!d] - 0.5 * b[!d][d]) * y[!d] * y[!d];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutEstimatorGetParticular - A stress that balances the constant body force f of a body, and a displacement that has this stress

   Not Collective

   Input Parameters:
+  body - the body
-  x    - [2] a point

   Output Parameters:
+  u - [2] displacement, length, of degree 2 in x, with that of the initial strain, or `NULL`
-  s - [3] s11, s22, s12 = -f1 (x1 - c1), -f2 (x2 - c2), 0, stress; c is the middle of the box of the body

   Level: advanced

   Note:
   The stress is 0 where there is no body force, the displacement too if there is no initial strain. A body force that varies and a strain
   that is not linear are not known here: `ABUT_FEATURE_BODY_FORCE_VARYING` and `ABUT_FEATURE_INITIAL_STRAIN` are not to be claimed.

.seealso: `AbutEstimatorSetFeatures()`, `AbutBodyGetForce()`
@*/
PetscErrorCode AbutEstimatorGetParticular(AbutBody body, const PetscReal x[2], PetscReal u[], PetscReal s[3])
{
  AbutMesh  mesh;
  PetscReal lower[2], upper[2], center[2], extent[2], f[2], young, nu, a, y[2];
  PetscInt  features;

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
  PetscCall(AbutBodyGetFeatures(body, &features));
  for (PetscInt d = 0; d < 2; ++d) {
    center[d] = 0.5 * (lower[d] + upper[d]);
    extent[d] = upper[d] - lower[d];
  }
  if (features & ABUT_FEATURE_INITIAL_STRAIN_LINEAR) PetscCall(AbutInitialDisplacement_Private(body, center, extent, nu, y, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}
