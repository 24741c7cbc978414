#include "zz.h"
#include "patch.h"

/*MC
   ABUTESTIMATORZZ - "zz": the finite-element stress against the one recovered from patches of cells

   Level: beginner

   Notes:
   Superconvergent patch recovery: O. C. Zienkiewicz and J. Z. Zhu, The superconvergent patch recovery and a posteriori error estimates,
   Int. J. Numer. Meth. Engng. 33 (1992). The stress is sampled at the middle of each cell; around every vertex inside the body a polynomial
   (1, x, y, xy for quads; 1, x, y for triangles) is fitted to the cells that have the vertex as a corner; its value there is the recovered
   stress of the vertex. A vertex on the boundary takes the mean of the polynomials of the inner vertices it shares a cell with, a hanging
   vertex the mean value of the two ends of its coarse side. Between vertices the shape functions interpolate.

   Cheap, local, and for any material law: nothing is solved.

   Limits: cells of order 1. At a singularity of the stress it smooths too much: on uniform meshes the estimate is then up to a quarter too
   small. Nothing is known of an error that neighbouring cells share. A body of one row of cells is judged along the row only.

.seealso: `AbutEstimatorSetType()`, `AbutEstimatorCompareStress()`, `ABUTESTIMATORFEMBEM`
M*/

typedef struct {
  PetscReal *s; /* [3*nvertices] recovered stress, during an estimate only */
} AbutEstimator_ZZ;

/* What is known at the vertices with unknowns */
typedef struct {
  PetscReal *moment;   /* [ABUT_PATCH_MOMENTS*nunknown] */
  PetscReal *boundary; /* [nunknown] above 0 on the boundary of the body */
  PetscReal *coef;     /* [ABUT_PATCH_COEFS*nunknown] the fit, about the vertex */
  PetscBool *done;     /* [nunknown] there is a fit */
} AbutPatches;

static PetscErrorCode AbutPatchesGather_Private(AbutBody body, const AbutMeshTopology *t, AbutPatches *p)
{
  const PetscReal middle[2] = {t->corners == 4 ? 0. : 1. / 3., t->corners == 4 ? 0. : 1. / 3.};

  PetscFunctionBegin;
  for (PetscInt c = 0; c < t->ncells; ++c) {
    PetscReal x[2], s[3], jac;

    PetscCall(AbutBodyGetCellPoint(body, c, middle, x, &jac));
    PetscCall(AbutBodyGetCellStress(body, c, middle, s));
    for (PetscInt k = 0; k < t->corners; ++k) {
      const PetscInt  v    = t->cell[t->corners * c + k];
      const PetscReal d[2] = {x[0] - t->x[2 * v], x[1] - t->x[2 * v + 1]};

      if (t->unknown[v] >= 0) AbutPatchAdd_Private(d, s, &p->moment[ABUT_PATCH_MOMENTS * t->unknown[v]]);
    }
  }
  for (PetscInt i = 0; i < 2 * t->nsideedges; ++i) p->boundary[t->unknown[t->sideedge[3 * (i / 2) + i % 2]]] = 1.; /* none of them hangs */
  PetscCall(AbutEstimatorSumAtVertices(body, ABUT_PATCH_MOMENTS, p->moment));
  PetscCall(AbutEstimatorSumAtVertices(body, 1, p->boundary));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fits the patches that are good for one: all inner ones at first; if these leave vertices without a fit, all */
static PetscErrorCode AbutPatchesFit_Private(const AbutMeshTopology *t, PetscBool all, AbutPatches *p)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < t->nunknown; ++i) {
    PetscBool plane;

    if (p->done[i] || (p->boundary[i] > 0. && !all)) continue;
    AbutPatchFit_Private(t->corners, &p->moment[ABUT_PATCH_MOMENTS * i], &p->coef[ABUT_PATCH_COEFS * i], &plane);
    p->done[i] = all || plane ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Every vertex without a fit takes the mean of those it shares a cell with; tells how many that helped and how many are left */
static PetscErrorCode AbutPatchesSpread_Private(AbutBody body, const AbutMeshTopology *t, AbutPatches *p, PetscInt *helped, PetscInt *left)
{
  const PetscInt bs       = ABUT_PATCH_COEFS + 1;
  PetscInt       count[2] = {0, 0};
  PetscReal     *sum, moved[ABUT_PATCH_COEFS];

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(bs * t->nunknown, &sum));
  for (PetscInt k = 0; k < t->ncells * t->corners * t->corners; ++k) { /* all pairs of corners of all cells */
    const PetscInt  c    = k / (t->corners * t->corners);
    const PetscInt  from = t->cell[t->corners * c + k / t->corners % t->corners], to = t->cell[t->corners * c + k % t->corners];
    const PetscInt  i = t->unknown[from], j = t->unknown[to];
    const PetscReal d[2] = {t->x[2 * to] - t->x[2 * from], t->x[2 * to + 1] - t->x[2 * from + 1]};

    if (i < 0 || j < 0 || !p->done[i] || p->done[j]) continue;
    AbutPatchShift_Private(&p->coef[ABUT_PATCH_COEFS * i], d, moved);
    for (PetscInt m = 0; m < ABUT_PATCH_COEFS; ++m) sum[bs * j + m] += moved[m];
    sum[bs * j + ABUT_PATCH_COEFS] += 1.;
  }
  PetscCall(AbutEstimatorSumAtVertices(body, bs, sum));
  for (PetscInt j = 0; j < t->nunknown; ++j) {
    const PetscReal n = sum[bs * j + ABUT_PATCH_COEFS];

    if (p->done[j]) continue;
    for (PetscInt m = 0; n > 0. && m < ABUT_PATCH_COEFS; ++m) p->coef[ABUT_PATCH_COEFS * j + m] = sum[bs * j + m] / n;
    p->done[j] = n > 0. ? PETSC_TRUE : PETSC_FALSE;
    ++count[p->done[j] ? 0 : 1];
  }
  PetscCall(PetscFree(sum));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 2, MPIU_INT, MPI_SUM, PetscObjectComm((PetscObject)body)));
  *helped = count[0];
  *left   = count[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The value of each fit at its vertex; a hanging vertex takes the mean of its anchors, so that the recovered stress is continuous. A fit of
   its own to the three cells around it would need numbers for hanging vertices across ranks, and measured the same (C .189, not .191). */
static PetscErrorCode AbutPatchesEvaluate_Private(const AbutMeshTopology *t, const AbutPatches *p, PetscReal s[])
{
  PetscFunctionBegin;
  for (PetscInt v = 0; v < t->nvertices; ++v)
    for (PetscInt j = 0; j < 3; ++j) {
      s[3 * v + j] = t->unknown[v] < 0 ? 0. : p->coef[ABUT_PATCH_COEFS * t->unknown[v] + 4 * j];
      for (PetscInt i = t->anchors[v]; i < t->anchors[v + 1]; ++i)
        s[3 * v + j] += t->weight[i] * p->coef[ABUT_PATCH_COEFS * t->unknown[t->anchor[i]] + 4 * j];
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The recovered stress at the vertices of this rank */
PetscErrorCode AbutEstimatorRecover_ZZ(AbutBody body, const AbutMeshTopology *t, PetscReal s[])
{
  AbutPatches p;
  PetscInt    helped, left;

  PetscFunctionBegin;
  PetscCall(PetscCalloc4(ABUT_PATCH_MOMENTS * t->nunknown, &p.moment, t->nunknown, &p.boundary, ABUT_PATCH_COEFS * t->nunknown, &p.coef,
                         t->nunknown, &p.done));
  PetscCall(AbutPatchesGather_Private(body, t, &p));
  PetscCall(AbutPatchesFit_Private(t, PETSC_FALSE, &p));
  do PetscCall(AbutPatchesSpread_Private(body, t, &p, &helped, &left));
  while (helped && left);
  PetscCall(AbutPatchesFit_Private(t, PETSC_TRUE, &p)); /* a body without inner vertices */
  PetscCall(AbutPatchesEvaluate_Private(t, &p, s));
  PetscCall(PetscFree4(p.moment, p.boundary, p.coef, p.done));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorStress_ZZ(AbutEstimator est, AbutBody body, PetscInt c, PetscInt n, const PetscReal xi[],
                                             PETSC_UNUSED const PetscReal x[], PetscReal s[])
{
  AbutEstimator_ZZ       *zz;
  AbutMesh                mesh;
  const AbutMeshTopology *t;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &zz));
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  for (PetscInt q = 0; q < n; ++q) {
    PetscReal at[2], N[4], G[8], det;

    PetscCall(AbutMeshMapCell(mesh, c, &xi[2 * q], at, N, G, &det));
    for (PetscInt j = 0; j < 3; ++j) {
      s[3 * q + j] = 0.;
      for (PetscInt k = 0; k < t->corners; ++k) s[3 * q + j] += N[k] * zz->s[3 * t->cell[t->corners * c + k] + j];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorEstimate_ZZ(AbutEstimator est, AbutBody body, PetscReal eta[])
{
  AbutEstimator_ZZ       *zz;
  AbutMesh                mesh;
  const AbutMeshTopology *t;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &zz));
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  AbutCheckInput(t->order == 1, PetscObjectComm((PetscObject)est), "estimator_type: zz is for order 1; give mesh_order 1");
  PetscCall(PetscMalloc1(3 * t->nvertices, &zz->s));
  PetscCall(AbutEstimatorRecover_ZZ(body, t, zz->s));
  PetscCall(AbutEstimatorCompareStress(est, body, AbutEstimatorStress_ZZ, eta));
  PetscCall(PetscFree(zz->s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorDestroy_ZZ(AbutEstimator est)
{
  AbutEstimator_ZZ *zz;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &zz));
  PetscCall(PetscFree(zz));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorCreate_ZZ(AbutEstimator est)
{
  const AbutEstimatorOps ops = {.estimate = AbutEstimatorEstimate_ZZ, .destroy = AbutEstimatorDestroy_ZZ};
  AbutEstimator_ZZ      *zz;

  PetscFunctionBegin;
  PetscCall(PetscNew(&zz));
  PetscCall(AbutEstimatorSetData(est, zz));
  PetscCall(AbutEstimatorSetOps(est, &ops));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PETSc calls this when it opens libestimator_zz.so */
PETSC_EXTERN PetscErrorCode PetscDLLibraryRegister_estimator_zz(void)
{
  PetscFunctionBegin;
  PetscCall(AbutEstimatorRegister(ABUTESTIMATORZZ, AbutEstimatorCreate_ZZ));
  PetscFunctionReturn(PETSC_SUCCESS);
}
