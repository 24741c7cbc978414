/* How far the stress in the middle of a cell is from the means, at its corners, of the stresses of the cells around them */
#include <abutestimator.h>

static PetscErrorCode Estimate(PETSC_UNUSED AbutEstimator est, AbutBody body, PetscReal eta[])
{
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  PetscReal              *sum, s[4] = {0., 0., 0., 1.}, measure, square = 0.; /* three stresses and a count */

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(PetscCalloc1(4 * t->nunknown, &sum));
  for (PetscInt pass = 0; pass < 2; ++pass) { /* from the cells to their corners, and back */
    for (PetscInt c = 0; c < t->ncells; ++c) {
      PetscCall(AbutBodyGetCellStress(body, c, (PetscReal[2]){t->corners == 4 ? 0. : 1. / 3., t->corners == 4 ? 0. : 1. / 3.}, s));
      PetscCall(AbutBodyGetCellMeasure(body, c, &measure));
      for (PetscInt k = 0; k < t->corners; ++k) {
        PetscReal *at = sum + 4 * t->unknown[t->cell[t->corners * c + k]];

        if (at < sum) continue; /* the corner hangs, and has no mean */
        for (PetscInt i = 0; i < 4 && !pass; ++i) at[i] += s[i];
        for (PetscInt i = 0; i < 3 && pass; ++i) eta[c] += (i == 2 ? 2. : 1.) * PetscSqr(s[i] - at[i] / at[3]) * measure / t->corners;
      }
      if (pass) square += (s[0] * s[0] + s[1] * s[1] + 2. * s[2] * s[2]) * measure;
      else eta[c] = 0.;
    }
    if (!pass) PetscCall(AbutEstimatorSumAtVertices(body, 4, sum)); /* the cells around a vertex may be on several ranks */
  }
  PetscCall(PetscFree(sum));
  PetscCall(AbutEstimatorScale(body, square, eta));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(AbutEstimator est)
{
  return AbutEstimatorSetOps(est, &(AbutEstimatorOps){.estimate = Estimate});
}

PETSC_EXTERN PetscErrorCode PetscDLLibraryRegister_estimator_own(void)
{
  return AbutEstimatorRegister("own", Create);
}
