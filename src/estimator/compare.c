#include <abut/private/estimatorimpl.h> /*I "abutestimator.h" I*/

#define ABUT_POINTS_MAX ((ABUT_ORDER_MAX + 2) * (ABUT_ORDER_MAX + 2))

/* Points of the reference cell: [-1,1]^2 for quads, (0,0)(1,0)(0,1) for triangles */
typedef struct {
  PetscInt  n;
  PetscReal xi[2 * ABUT_POINTS_MAX], w[ABUT_POINTS_MAX];
  PetscReal dN[2 * ABUT_CELL_NODES_MAX * ABUT_POINTS_MAX]; /* derivatives of the shape functions at each point */
} AbutRule;

/* Appends the three points (a, a), (1-2a, a), (a, 1-2a) */
static void AbutRuleTriple_Private(PetscReal a, PetscReal w, AbutRule *rule)
{
  for (PetscInt i = 0; i < 3; ++i, ++rule->n) {
    rule->xi[2 * rule->n]     = i == 1 ? 1. - 2. * a : a;
    rule->xi[2 * rule->n + 1] = i == 2 ? 1. - 2. * a : a;
    rule->w[rule->n]          = w;
  }
}

static PetscErrorCode AbutRuleGauss_Private(AbutMesh mesh, PetscInt n, AbutRule *rule)
{
  PetscQuadrature  quadrature;
  const PetscReal *xi, *w;

  PetscFunctionBegin;
  PetscCall(AbutMeshCreateQuadrature(mesh, n, &quadrature));
  PetscCall(PetscQuadratureGetData(quadrature, NULL, NULL, &rule->n, &xi, &w));
  PetscCall(PetscArraycpy(rule->xi, xi, 2 * rule->n));
  PetscCall(PetscArraycpy(rule->w, w, rule->n));
  PetscCall(PetscQuadratureDestroy(&quadrature));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A recovered stress is smooth inside, but that of boundary elements varies like a logarithm beside the boundary: cells there take the
   richer rule (measured at order 1 against 12x12 points: eta within 6 % with 2x2, within 1.4 % with 3x3 points) */
static PetscErrorCode AbutRuleCreate_Private(AbutMesh mesh, const AbutMeshTopology *t, PetscBool rich, AbutRule **rule)
{
  PetscReal N[ABUT_CELL_NODES_MAX];
  AbutRule *r;

  PetscFunctionBegin;
  PetscCall(PetscNew(&r));
  if (t->corners == 4 || t->order > 1) PetscCall(AbutRuleGauss_Private(mesh, t->order + (rich ? 2 : 1), r));
  else if (!rich) AbutRuleTriple_Private(1. / 6., 1. / 6., r);
  else { /* exact for degree 4: D. A. Dunavant, High degree efficient symmetrical Gaussian quadrature rules for the triangle (1985) */
    AbutRuleTriple_Private(0.445948490915964886, 0.5 * 0.223381589678011466, r);
    AbutRuleTriple_Private(0.091576213509770743, 0.5 * 0.109951743655321868, r);
  }
  for (PetscInt q = 0; q < r->n; ++q) PetscCall(AbutMeshEvaluateBasis(mesh, r->xi + 2 * q, N, r->dN + 2 * t->nodes * q));
  *rule = r;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEstimatorSumAtVertices - Sums over the ranks what their cells contributed to each vertex and any other node

   Collective

   Input Parameters:
+  body - the body
-  bs   - numbers per node

   Input/Output Parameter:
.  v - [bs*nunknown] for every node with unknowns on this rank, as in `AbutMeshTopology`: in, what this rank's cells contribute; out, the
   sum over all ranks

   Level: advanced

   Note:
   No rank holds the cells of another. An estimator that needs the cells around a vertex, also where ranks meet, lets every cell contribute
   to its vertices and calls this.

.seealso: `AbutMeshGetTopology()`, `AbutEstimatorRegister()`
@*/
PetscErrorCode AbutEstimatorSumAtVertices(AbutBody body, PetscInt bs, PetscReal v[])
{
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  Vec                     global, local;
  PetscReal              *a;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(VecCreateGhostBlock(PetscObjectComm((PetscObject)body), bs, bs * t->nowned, bs * t->nglobal, t->nunknown - t->nowned,
                                t->global + t->nowned, &global));
  PetscCall(VecGhostGetLocalForm(global, &local));
  PetscCall(VecGetArrayWrite(local, &a));
  PetscCall(PetscArraycpy(a, v, bs * t->nunknown));
  PetscCall(VecRestoreArrayWrite(local, &a));
  PetscCall(VecGhostUpdateBegin(global, ADD_VALUES, SCATTER_REVERSE));
  PetscCall(VecGhostUpdateEnd(global, ADD_VALUES, SCATTER_REVERSE));
  PetscCall(VecGhostUpdateBegin(global, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGhostUpdateEnd(global, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGetArray(local, &a));
  PetscCall(PetscArraycpy(v, a, bs * t->nunknown));
  PetscCall(VecRestoreArray(local, &a));
  PetscCall(VecGhostRestoreLocalForm(global, &local));
  PetscCall(VecDestroy(&global));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells with a vertex on the boundary of the body, also if the element side that makes it so is another rank's */
static PetscErrorCode AbutEstimatorGetBoundaryCells_Private(AbutBody body, const AbutMeshTopology *t, PetscBool touches[])
{
  PetscReal *on;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(t->nunknown, &on));
  for (PetscInt i = 0; i < 2 * t->nsideedges; ++i)
    on[t->unknown[t->sideedge[3 * (i / 2) + i % 2]]] = 1.; /* no vertex of the boundary hangs */
  PetscCall(AbutEstimatorSumAtVertices(body, 1, on));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    touches[c] = PETSC_FALSE;
    for (PetscInt k = 0; k < t->corners; ++k) {
      const PetscInt i = t->unknown[t->cell[t->corners * c + k]];

      if (i >= 0 && on[i] > 0.) touches[c] = PETSC_TRUE;
    }
  }
  PetscCall(PetscFree(on));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal AbutStressSquare_Private(const PetscReal s[3])
{
  return s[0] * s[0] + s[1] * s[1] + 2. * s[2] * s[2];
}

/* Adds the integrals of |s_rec|^2 and |s_rec - s_F|^2 over cell c */
static PetscErrorCode AbutEstimatorIntegrateCell_Private(AbutEstimator est, AbutBody body, AbutStressFunction stress, PetscInt c,
                                                         const AbutRule *rule, PetscReal integral[2])
{
  PetscReal x[2 * ABUT_POINTS_MAX], jac[ABUT_POINTS_MAX], rec[3 * ABUT_POINTS_MAX], fem[3 * ABUT_POINTS_MAX];

  PetscFunctionBegin;
  for (PetscInt q = 0; q < rule->n; ++q) PetscCall(AbutBodyGetCellPoint(body, c, &rule->xi[2 * q], &x[2 * q], &jac[q]));
  PetscCall((*stress)(est, body, c, rule->n, rule->xi, x, rec));
  PetscCall(AbutBodyGetCellStresses(body, c, rule->n, rule->xi, rule->dN, fem));
  for (PetscInt q = 0; q < rule->n; ++q) {
    const PetscReal w = rule->w[q] * jac[q];

    for (PetscInt i = 0; i < 3; ++i) fem[3 * q + i] -= rec[3 * q + i];
    integral[0] += w * AbutStressSquare_Private(&rec[3 * q]);
    integral[1] += w * AbutStressSquare_Private(&fem[3 * q]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The mean square stress below which a body counts as free of stress: what round-off and an iterative solver leave of a rigid motion */
static PetscErrorCode AbutEstimatorGetFloor_Private(AbutBody body, const AbutMeshTopology *t, PetscReal area, PetscReal *floor)
{
  const PetscReal *u;
  PetscReal        young, poisson, umax = 0.;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMaterial(body, &young, &poisson));
  PetscCall(AbutBodyGetNodeDisplacement(body, &u));
  for (PetscInt i = 0; i < 2 * t->nnodes; ++i) umax = PetscMax(umax, PetscAbsReal(u[i]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &umax, 1, MPIU_REAL, MPIU_MAX, PetscObjectComm((PetscObject)body)));
  *floor = PetscSqr(1e-10 * young * umax) / area;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEstimatorScale - From squared errors of the stress in the cells to the indicators of eq. (27) of the paper

   Collective

   Input Parameters:
+  body   - the body, solved
-  square - ||s||^2, the integral of the square of the stress over the cells of this rank; the stress is the best there is

   Input/Output Parameter:
.  eta - [cells on this rank] in: ||s - s_F||_e^2, or an estimate of it, stress^2 times area; out: eta_e, where
   eta_e^2 = ( ||s - s_F||_e^2 / |e| ) / ( ||s||_Omega^2 / |Omega| )

   Level: advanced

   Notes:
   The norm is that of the plane tensor, s11^2 + s22^2 + 2 s12^2, and with axial symmetry the hoop stress is in it; areas are volumes then.

   A body without stress, at rest or moved as a rigid one, has eta = 0.

.seealso: `AbutEstimatorRegister()`, `AbutEstimatorCompareStress()`, `AbutEstimatorGetNorms()`
@*/
PetscErrorCode AbutEstimatorScale(AbutBody body, PetscReal square, PetscReal eta[])
{
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  PetscReal               sum[3] = {0., square, 0.}, measure, area, floor = 0.; /* |Omega|, ||s||^2, and the area in the plane */

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    PetscCall(AbutBodyGetCellMeasure(body, c, &measure));
    PetscCall(AbutMeshGetCellArea(mesh, c, &area));
    sum[0] += measure;
    sum[2] += area;
    eta[c] /= measure;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPIU_SUM, PetscObjectComm((PetscObject)body)));
  PetscCall(AbutEstimatorGetFloor_Private(body, t, sum[2], &floor));
  for (PetscInt c = 0; c < t->ncells; ++c) eta[c] = sum[1] / sum[0] > floor ? PetscSqrtReal(eta[c] * sum[0] / sum[1]) : 0.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutEstimatorCompareStress - The indicator of eq. (27) of the paper: the finite-element stress against one thought better

   Collective

   Input Parameters:
+  est    - the estimator, handed on to `stress`
.  body   - the body, solved
-  stress - the better stress s; called once per cell with all its points

   Output Parameter:
.  eta - [cells on this rank] eta_e, where eta_e^2 = ( ||s - s_F||_e^2 / |e| ) / ( ||s||_Omega^2 / |Omega| )

   Level: advanced

   Notes:
   Norms and what is said of a body without stress are those of `AbutEstimatorScale()`. Cells of order p take p+1 Gauss points in each
   direction, and p+2 where they touch the boundary of the body; triangles of order 1 take 3 points, and 6 there.

.seealso: `AbutEstimatorRegister()`, `AbutEstimatorScale()`, `AbutEstimatorGetNorms()`, `AbutBodyGetCellStress()`
@*/
PetscErrorCode AbutEstimatorCompareStress(AbutEstimator est, AbutBody body, AbutStressFunction stress, PetscReal eta[])
{
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  AbutRule               *rule[2];
  PetscBool              *touches;
  PetscReal               square = 0.;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  for (PetscInt i = 0; i < 2; ++i) PetscCall(AbutRuleCreate_Private(mesh, t, (PetscBool)i, &rule[i]));
  PetscCall(PetscMalloc1(t->ncells, &touches));
  PetscCall(AbutEstimatorGetBoundaryCells_Private(body, t, touches));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    PetscReal integral[2] = {0., 0.};

    PetscCall(AbutEstimatorIntegrateCell_Private(est, body, stress, c, rule[touches[c]], integral));
    square += integral[0];
    eta[c] = integral[1];
  }
  PetscCall(PetscFree(touches));
  for (PetscInt i = 0; i < 2; ++i) PetscCall(PetscFree(rule[i]));
  PetscCall(AbutEstimatorScale(body, square, eta));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutEstimatorGetNorms - One number for a whole body out of the indicators of its cells

   Collective

   Input Parameters:
+  body - the body
-  eta  - the indicators, from `AbutEstimatorEstimate()`

   Output Parameters:
+  total   - sqrt( sum eta_e^2 |e| / |Omega| ), the estimated relative error of the stress
-  largest - the largest eta_e

   Level: intermediate

.seealso: `AbutEstimatorEstimate()`
@*/
PetscErrorCode AbutEstimatorGetNorms(AbutBody body, Vec eta, PetscReal *total, PetscReal *largest)
{
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  const PetscReal        *e;
  PetscReal               sum[2] = {0., 0.};

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(VecGetArrayRead(eta, &e));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    PetscReal area;

    PetscCall(AbutBodyGetCellMeasure(body, c, &area));
    sum[0] += area;
    sum[1] += area * PetscSqr(e[c]);
  }
  PetscCall(VecRestoreArrayRead(eta, &e));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPIU_SUM, PetscObjectComm((PetscObject)body)));
  *total = PetscSqrtReal(sum[1] / sum[0]);
  PetscCall(VecNorm(eta, NORM_INFINITY, largest));
  PetscFunctionReturn(PETSC_SUCCESS);
}
