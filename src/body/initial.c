#include "element.h"

/* Strains that a body has without stress, as of its temperature: nodal forces int B' D eps0 in the load, stresses D (eps - eps0). With the
   mean dilatation of cells that of eps0 is a mean too. Gauss points: one more in each direction than the order, in triangles too. */

/*@C
   AbutBodyGetInitialStrain - The strain that a body has without stress at a point

   Not Collective

   Input Parameters:
+  body - the body
-  x    - [2] the point

   Output Parameter:
.  eps - [4] e11, e22, e12, e33: the sum of what `AbutBodyAddInitialStrain()` added; in plane stress e33 = 0, as it makes no stress

   Level: advanced

.seealso: `AbutBodyAddInitialStrain()`
@*/
PetscErrorCode AbutBodyGetInitialStrain(AbutBody body, const PetscReal x[2], PetscReal eps[4])
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < 4; ++i) eps[i] = 0.;
  for (AbutHook h = body->hooks; h; h = h->next) {
    PetscReal one[4];

    if (h->type != ABUT_HOOK_STRAIN) continue;
    PetscCall((*h->call.strain)(x, one, h->ctx));
    for (PetscInt i = 0; i < 4; ++i) eps[i] += one[i];
  }
  if (body->kinematics == ABUT_PLANE_STRESS) eps[3] = 0.;
  for (PetscInt i = 0; i < 4; ++i) eps[i] *= body->factor;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutBodyInitialStrain_Private(AbutBody body, const PetscReal x[2], PetscReal eps[4], PetscReal *dilatation)
{
  PetscFunctionBegin;
  *dilatation = 0.;
  PetscCall(AbutBodyGetInitialStrain(body, x, eps));
  *dilatation = eps[0] + eps[1] + eps[3];
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  PetscQuadrature  rule;
  PetscInt         n;
  const PetscReal *xi, *w;
} AbutInitialRule;

static PetscErrorCode AbutInitialRuleCreate_Private(AbutMesh mesh, AbutInitialRule *r)
{
  const AbutMeshTopology *t;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(AbutMeshCreateQuadrature(mesh, t->order + 1, &r->rule));
  PetscCall(PetscQuadratureGetData(r->rule, NULL, NULL, &r->n, &r->xi, &r->w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The mean over local cell c of the dilatation of the initial strains */
static PetscErrorCode AbutCellInitialDilatation_Private(AbutBody body, PetscInt c, PetscInt n, const PetscReal xi[], const PetscReal w[],
                                                        PetscReal *mean)
{
  PetscReal sum[2] = {0., 0.};

  PetscFunctionBegin;
  for (PetscInt q = 0; q < n; ++q) {
    PetscReal x[2], det, eps[4], dilatation;

    PetscCall(AbutBodyGetCellPoint(body, c, xi + 2 * q, x, &det));
    PetscCall(AbutBodyInitialStrain_Private(body, x, eps, &dilatation));
    sum[0] += w[q] * det;
    sum[1] += w[q] * det * dilatation;
  }
  *mean = sum[1] / sum[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodal forces f[2*nodes] of local cell c, and the integral of eps0 D eps0 */
static PetscErrorCode AbutCellInitial_Private(AbutBody body, PetscInt c, const AbutInitialRule *r, PetscReal f[], PetscReal *energy)
{
  const AbutElement e    = body->element;
  PetscReal         mean = 0., N[ABUT_CELL_NODES_MAX], x[2], det, thickness, eps[4], dilatation;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(f, 2 * e->nodes));
  if (body->meandilatation) PetscCall(AbutCellInitialDilatation_Private(body, c, r->n, r->xi, r->w, &mean));
  for (PetscInt q = 0; q < r->n; ++q) {
    PetscReal w, s[4];

    PetscCall(AbutMeshMapCell(body->mesh, c, r->xi + 2 * q, x, N, e->G, &det));
    PetscCall(AbutBodyGetThickness(body, x, &thickness));
    PetscCall(AbutBodyInitialStrain_Private(body, x, eps, &dilatation));
    if (body->meandilatation) dilatation = mean;
    w = r->w[q] * det * thickness;
    for (PetscInt i = 0; i < 4; ++i) s[i] = w * ((i == 2 ? 0. : body->lambda * dilatation) + 2. * body->mu * eps[i]);
    *energy += s[0] * eps[0] + s[1] * eps[1] + 2. * s[2] * eps[2] + s[3] * eps[3];
    for (PetscInt k = 0; k < e->nodes; ++k) {
      f[2 * k] += s[0] * e->G[2 * k] + s[2] * e->G[2 * k + 1];
      f[2 * k + 1] += s[2] * e->G[2 * k] + s[1] * e->G[2 * k + 1];
      if (body->kinematics == ABUT_AXISYMMETRIC) f[2 * k] += s[3] * N[k] / x[0];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the nodal forces of local cell c; what a hanging node gets is its anchors' */
static PetscErrorCode AbutCellAddForces_Private(const AbutMeshTopology *t, PetscInt c, const PetscReal f[], Vec load)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2 * t->nodes; ++k) {
    const PetscInt node = t->cellnode[t->nodes * c + k / 2];

    if (t->unknown[node] >= 0) PetscCall(VecSetValue(load, 2 * t->global[t->unknown[node]] + k % 2, f[k], ADD_VALUES));
    for (PetscInt i = t->anchors[node]; i < t->anchors[node + 1]; ++i)
      PetscCall(VecSetValue(load, 2 * t->global[t->unknown[t->anchor[i]]] + k % 2, t->weight[i] * f[k], ADD_VALUES));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The nodal forces of the initial strains, added to the load */
PetscErrorCode AbutBodyInitialSetUp_Private(AbutBody body)
{
  const AbutMeshTopology *t;
  AbutInitialRule         rule;
  PetscReal               f[2 * ABUT_CELL_NODES_MAX], energy = 0.;

  PetscFunctionBegin;
  PetscCall(AbutBodyLogHooks_Private(body, ABUT_HOOK_STRAIN, -1, PETSC_TRUE));
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  PetscCall(VecDestroy(&body->initialload)); /* of another load factor */
  PetscCall(AbutBodyCreateVec(body, &body->initialload));
  PetscCall(AbutInitialRuleCreate_Private(body->mesh, &rule));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    PetscCall(AbutCellInitial_Private(body, c, &rule, f, &energy));
    PetscCall(AbutCellAddForces_Private(t, c, f, body->initialload));
  }
  PetscCall(PetscQuadratureDestroy(&rule.rule));
  PetscCall(VecAssemblyBegin(body->initialload));
  PetscCall(VecAssemblyEnd(body->initialload));
  PetscCallMPI(MPI_Allreduce(&energy, &body->initialenergy, 1, MPIU_REAL, MPIU_SUM, PetscObjectComm((PetscObject)body)));
  PetscCall(VecAXPY(body->load, 1., body->initialload));
  PetscCall(AbutBodyLogHooks_Private(body, ABUT_HOOK_STRAIN, -1, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the stress of the initial strains from s[3*n], and from s33[n] unless it is NULL, at points of local cell c */
PetscErrorCode AbutBodySubtractInitial_Private(AbutBody body, PetscInt c, PetscInt n, const PetscReal xi[], PetscReal s[], PetscReal s33[])
{
  const AbutElement e    = body->element;
  PetscReal         mean = 0.;

  PetscFunctionBegin;
  if (body->meandilatation) PetscCall(AbutCellInitialDilatation_Private(body, c, e->npoints, e->xi, e->w, &mean));
  for (PetscInt q = 0; q < n; ++q) {
    PetscReal x[2], det, eps[4], dilatation, trace;

    PetscCall(AbutBodyGetCellPoint(body, c, xi + 2 * q, x, &det));
    PetscCall(AbutBodyInitialStrain_Private(body, x, eps, &dilatation));
    trace = body->lambda * (body->meandilatation ? mean : dilatation);
    s[3 * q] -= trace + 2. * body->mu * eps[0];
    s[3 * q + 1] -= trace + 2. * body->mu * eps[1];
    s[3 * q + 2] -= 2. * body->mu * eps[2];
    if (s33 && body->kinematics != ABUT_PLANE_STRESS) s33[q] -= trace + 2. * body->mu * eps[3];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the initial strains add to u.Ku to make it twice the elastic energy, int (eps - eps0) D (eps - eps0) */
PetscErrorCode AbutBodyInitialWork_Private(AbutBody body, PetscReal *work)
{
  PetscFunctionBegin;
  PetscCall(VecDot(body->initialload, body->u, work));
  *work = body->initialenergy - 2. * *work;
  PetscFunctionReturn(PETSC_SUCCESS);
}
