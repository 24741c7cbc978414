/* An estimator to copy. It compares the finite-element stress with a smoother one: the mean, at each vertex, of the stresses in the middle
   of the cells around it. Only public headers are used, and nothing in Abut needs to know this file.
   Limits: cells of order 1; beside the boundary the mean is one-sided, so that the estimate is some ten per cent too large there. */
#include <abutestimator.h>

/* The smooth stress at n points of cell c: the shape functions between the vertices, whose values are the data of the estimator */
static PetscErrorCode SmoothStress(AbutEstimator est, AbutBody body, PetscInt c, PetscInt n, const PetscReal xi[], const PetscReal x[],
                                   PetscReal s[])
{
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  PetscReal              *nodal, at[2], N[4], gradient[8], det;

  PetscFunctionBegin;
  (void)x; /* the same points in space, for those who need them */
  PetscCall(AbutEstimatorGetData(est, &nodal));
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  for (PetscInt q = 0; q < n; ++q) {
    PetscCall(AbutMeshMapCell(mesh, c, &xi[2 * q], at, N, gradient, &det));
    for (PetscInt i = 0; i < 3; ++i) s[3 * q + i] = 0.;
    for (PetscInt k = 0; k < t->corners; ++k)
      for (PetscInt i = 0; i < 3; ++i) s[3 * q + i] += N[k] * nodal[3 * t->cell[t->corners * c + k] + i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What Abut calls: one eta for each cell of this rank */
static PetscErrorCode Estimate(AbutEstimator est, AbutBody body, PetscReal eta[])
{
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  PetscReal              *sum, *nodal, s[3], middle[2];

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  AbutCheckInput(t->order == 1, PetscObjectComm((PetscObject)est), "estimator_type: template is for order 1; give mesh_order 1, or zz");
  middle[0] = middle[1] = t->corners == 4 ? 0. : 1. / 3.;
  PetscCall(PetscCalloc2(4 * t->nunknown, &sum, 3 * t->nvertices, &nodal));
  for (PetscInt c = 0; c < t->ncells; ++c) { /* three stresses and a count, from each cell to its vertices */
    PetscCall(AbutBodyGetCellStress(body, c, middle, s));
    for (PetscInt k = 0; k < t->corners; ++k) {
      const PetscInt v = t->unknown[t->cell[t->corners * c + k]];

      if (v < 0) continue; /* it hangs */
      for (PetscInt i = 0; i < 3; ++i) sum[4 * v + i] += s[i];
      sum[4 * v + 3] += 1.;
    }
  }
  PetscCall(AbutEstimatorSumAtVertices(body, 4, sum)); /* the cells around a vertex may be on several ranks */
  for (PetscInt v = 0; v < t->nvertices; ++v)
    for (PetscInt i = 0; i < 3; ++i) {
      const PetscInt own = t->unknown[v];

      nodal[3 * v + i] = own < 0 ? 0. : sum[4 * own + i] / sum[4 * own + 3];
      for (PetscInt k = t->anchors[v]; k < t->anchors[v + 1]; ++k) { /* a hanging vertex takes the mean of the ends of the side it is on */
        const PetscInt end = t->unknown[t->anchor[k]];

        nodal[3 * v + i] += t->weight[k] * sum[4 * end + i] / sum[4 * end + 3];
      }
    }
  PetscCall(AbutEstimatorSetData(est, nodal));
  PetscCall(AbutEstimatorCompareStress(est, body, SmoothStress, eta)); /* eq. (27) of the paper: norms, quadrature, sums over ranks */
  PetscCall(PetscFree2(sum, nodal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(AbutEstimator est)
{
  const AbutEstimatorOps ops = {.estimate = Estimate};

  PetscFunctionBegin;
  PetscCall(AbutEstimatorSetOps(est, &ops));
  PetscCall(AbutEstimatorSetAbout(est, "mean stress at the vertices, to copy"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Called when libestimator_template.so is opened: what follows PetscDLLibraryRegister_ must be the name of the file */
PETSC_EXTERN PetscErrorCode PetscDLLibraryRegister_estimator_template(void)
{
  PetscFunctionBegin;
  PetscCall(AbutEstimatorRegister("template", Create));
  PetscFunctionReturn(PETSC_SUCCESS);
}
