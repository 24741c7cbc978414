/* Marks cells at random: what an estimator has to be better than. The number of a cell is made of its middle, so that a run can be repeated.
   They are scaled such that the whole error is the root of 0.1 over the count of cells: it falls from mesh to mesh like that of order 1.
   Built outside the tree, with the Makefile of plugins/template. */
#include <abutestimator.h>

static PetscErrorCode Estimate(AbutEstimator est, AbutBody body, PetscReal eta[])
{
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  PetscReal               sum[2] = {0., 0.}; /* of the numbers, and of the cells */

  PetscFunctionBegin;
  (void)est;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    PetscReal middle[2] = {0., 0.}, hash;

    for (PetscInt k = 0; k < 2 * t->corners; ++k) middle[k % 2] += t->x[2 * t->cell[t->corners * c + k / 2] + k % 2] / t->corners;
    hash   = 1e4 * PetscSinReal(12.9898 * middle[0] + 78.233 * middle[1] + t->level[c]);
    eta[c] = hash - PetscFloorReal(hash);
    sum[0] += eta[c];
    sum[1] += 1.;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPIU_SUM, PetscObjectComm((PetscObject)body)));
  for (PetscInt c = 0; c < t->ncells; ++c) eta[c] *= 0.1 / (sum[0] * sum[1]);
  PetscCall(AbutEstimatorScale(body, 1., eta));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(AbutEstimator est)
{
  const AbutEstimatorOps ops = {.estimate = Estimate};

  PetscFunctionBegin;
  PetscCall(AbutEstimatorSetOps(est, &ops));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PETSC_EXTERN PetscErrorCode PetscDLLibraryRegister_estimator_random(void)
{
  PetscFunctionBegin;
  PetscCall(AbutEstimatorRegister("random", Create));
  PetscFunctionReturn(PETSC_SUCCESS);
}
