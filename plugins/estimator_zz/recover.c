#include "zz.h"
#include "patch.h"
#include "samples.h"

/* What is known at the vertices */
typedef struct {
  AbutPatchSpace space;
  PetscReal     *moment;   /* [moments*nvertices] */
  PetscReal     *boundary; /* [nvertices] above 0 on the boundary of the body */
  PetscReal     *coef;     /* [coefs*nvertices] the fitted stress, about the vertex; of those with unknowns */
  PetscBool     *good;     /* [nvertices] it is to be relied on */
} AbutPatches;

static PetscErrorCode AbutPatchesGather_Private(const AbutSamples *a, AbutMesh mesh, const AbutMeshTopology *t, AbutPatches *p)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < a->n * t->ncells; ++i) {
    const PetscInt c = i / a->n;
    PetscReal      x[2], J[4];

    PetscCall(AbutMeshMapPoint(mesh, c, a->xi + 2 * (i % a->n), x, J));
    for (PetscInt k = 0; k < t->corners; ++k) {
      const PetscInt  v    = t->cell[t->corners * c + k];
      const PetscReal d[2] = {x[0] - t->x[2 * v], x[1] - t->x[2 * v + 1]};

      if (t->unknown[v] >= 0) AbutPatchAdd_Private(&p->space, d, a->s + 3 * i, p->moment + p->space.moments * v);
    }
  }
  for (PetscInt i = 0; i < 2 * t->nsideedges; ++i) p->boundary[t->sideedge[3 * (i / 2) + i % 2]] = 1.; /* none of them hangs */
  PetscCall(AbutMeshSumAtVertices(mesh, p->space.moments, p->moment));
  PetscCall(AbutMeshSumAtVertices(mesh, 1, p->boundary));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Samples of order 1 are not good enough for one-sided patches: C, eq. (23) of the paper, would be 0.5 instead of 0.2 */
static PetscErrorCode AbutPatchesFit_Private(const AbutMeshTopology *t, AbutPatches *p)
{
  PetscFunctionBegin;
  for (PetscInt v = 0; v < t->nvertices; ++v) {
    if (t->unknown[v] < 0) continue;
    AbutPatchFit_Private(&p->space, p->moment + p->space.moments * v, p->coef + p->space.coefs * v, &p->good[v]);
    if (t->order == 1 && p->boundary[v] > 0.) p->good[v] = PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Every vertex without a stress of its own, done or handed on, takes the mean of those it shares a cell with; tells how many that helped
   and how many are left */
static PetscErrorCode AbutPatchesSpread_Private(AbutMesh mesh, const AbutMeshTopology *t, AbutPatches *p, PetscBool done[],
                                                PetscInt *helped, PetscInt *left)
{
  const PetscInt n = p->space.coefs, bs = n + 1;
  PetscInt       count[2] = {0, 0};
  PetscReal     *sum, moved[ABUT_PATCH_COEFS_MAX];

  PetscFunctionBegin;
  PetscCheck(t->order == 1, PETSC_COMM_SELF, PETSC_ERR_PLIB, "Only stresses of degree 1 are handed on");
  PetscCall(PetscCalloc1(bs * t->nvertices, &sum));
  for (PetscInt k = 0; k < t->ncells * t->corners * t->corners; ++k) { /* all pairs of corners of all cells */
    const PetscInt *cell = t->cell + k / (t->corners * t->corners) * t->corners;
    const PetscInt  from = cell[k / t->corners % t->corners], to = cell[k % t->corners];
    const PetscReal d[2] = {t->x[2 * to] - t->x[2 * from], t->x[2 * to + 1] - t->x[2 * from + 1]};

    if (t->unknown[to] < 0 || !done[from] || done[to]) continue;
    AbutPatchShift_Private(p->coef + n * from, d, moved);
    for (PetscInt m = 0; m < n; ++m) sum[bs * to + m] += moved[m];
    sum[bs * to + n] += 1.;
  }
  PetscCall(AbutMeshSumAtVertices(mesh, bs, sum));
  for (PetscInt v = 0; v < t->nvertices; ++v) {
    const PetscReal several = sum[bs * v + n];

    if (t->unknown[v] < 0 || done[v]) continue;
    for (PetscInt m = 0; several > 0. && m < n; ++m) p->coef[n * v + m] = sum[bs * v + m] / several;
    done[v] = several > 0. ? PETSC_TRUE : PETSC_FALSE;
    ++count[done[v] ? 0 : 1];
  }
  PetscCall(PetscFree(sum));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 2, MPIU_INT, MPI_SUM, PetscObjectComm((PetscObject)mesh)));
  *helped = count[0];
  *left   = count[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of order 1: those without a good fit ask their neighbours; if none has one, as in a body of one row of cells, they keep their own */
static PetscErrorCode AbutPatchesHandOn_Private(AbutMesh mesh, const AbutMeshTopology *t, AbutPatches *p)
{
  PetscBool *done;
  PetscInt   helped, left;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(t->nvertices, &done));
  PetscCall(PetscArraycpy(done, p->good, t->nvertices));
  do PetscCall(AbutPatchesSpread_Private(mesh, t, p, done, &helped, &left));
  while (helped && left);
  PetscCall(PetscFree(done));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The hats of the corners of a cell at a reference point */
static void AbutHats_Private(PetscInt corners, const PetscReal xi[2], PetscReal hat[4])
{
  const PetscReal x = 0.5 * (1. + xi[0]), y = 0.5 * (1. + xi[1]);

  hat[0] = corners == 3 ? 1. - xi[0] - xi[1] : (1. - x) * (1. - y);
  hat[1] = corners == 3 ? xi[0] : x * (1. - y);
  hat[2] = corners == 3 ? xi[1] : x * y;
  hat[3] = corners == 3 ? 0. : (1. - x) * y;
}

/* Adds to sum[4] what the corners of cell c say of its node k: stress, and how loud. First, only corners with a good fit speak, each as
   loud as its hat is high or, if no such hat reaches the node, all alike. */
static void AbutPatchesAddNode_Private(const AbutMeshTopology *t, const AbutPatches *p, PetscInt c, PetscInt k, const PetscReal xi[2],
                                       PetscBool any, PetscReal sum[4])
{
  const PetscReal *x = t->x + 2 * t->cellnode[t->nodes * c + k];
  PetscReal        hat[4], reach = 0.;

  AbutHats_Private(t->corners, xi, hat);
  for (PetscInt i = 0; i < t->corners; ++i) {
    if (hat[i] < 1e-12) hat[i] = 0.; /* round-off: a node on a side is out of the reach of the corners beyond */
    if (p->good[t->cell[t->corners * c + i]] || any) reach += hat[i];
  }
  for (PetscInt i = 0; i < t->corners; ++i) {
    const PetscInt  v    = t->cell[t->corners * c + i];
    const PetscReal d[2] = {x[0] - t->x[2 * v], x[1] - t->x[2 * v + 1]}, w = reach > 0. ? hat[i] : 1.;
    PetscReal       s[3];

    if (w == 0. || t->unknown[v] < 0 || !(p->good[v] || any)) continue;
    AbutPatchEvaluate_Private(&p->space, p->coef + p->space.coefs * v, d, s);
    for (PetscInt j = 0; j < 3; ++j) sum[j] += w * s[j];
    sum[3] += w;
  }
}

/* The recovered stress at the nodes; it is continuous: a hanging node takes the function of its coarse side. To ask the corners of its
   cells instead measured the same. */
static PetscErrorCode AbutPatchesEvaluate_Private(AbutBody body, AbutMesh mesh, const AbutMeshTopology *t, const AbutPatches *p,
                                                  PetscReal s[])
{
  const PetscReal *xi;
  PetscReal       *sum;
  PetscBool       *done;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetReferenceNodes(mesh, &xi));
  PetscCall(PetscMalloc1(4 * t->nunknown, &sum));
  PetscCall(PetscCalloc1(t->nunknown, &done));
  PetscCall(PetscArrayzero(s, 3 * t->nnodes));
  for (PetscInt any = 0; any < 2; ++any) { /* a cell in a corner of the body may have no corner with a good fit */
    PetscCall(PetscArrayzero(sum, 4 * t->nunknown));
    for (PetscInt i = 0; i < t->nodes * t->ncells; ++i) {
      const PetscInt k = i % t->nodes, u = t->unknown[t->cellnode[i]];

      if (u >= 0 && !done[u]) AbutPatchesAddNode_Private(t, p, i / t->nodes, k, xi + 2 * k, (PetscBool)any, sum + 4 * u);
    }
    PetscCall(AbutEstimatorSumAtVertices(body, 4, sum));
    for (PetscInt n = 0; n < t->nnodes; ++n) {
      const PetscInt u = t->unknown[n];

      if (u < 0 || !(sum[4 * u + 3] > 0.)) continue;
      for (PetscInt j = 0; j < 3; ++j) s[3 * n + j] = sum[4 * u + j] / sum[4 * u + 3];
      done[u] = PETSC_TRUE;
    }
  }
  for (PetscInt n = 0; n < t->nnodes; ++n)
    for (PetscInt i = t->anchors[n]; i < t->anchors[n + 1]; ++i)
      for (PetscInt j = 0; j < 3; ++j) s[3 * n + j] += t->weight[i] * s[3 * t->anchor[i] + j];
  PetscCall(PetscFree(sum));
  PetscCall(PetscFree(done));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fits at all vertices with unknowns. From order 2 on the samples of quads are so good that polynomials of degree order are worse. */
static PetscErrorCode AbutPatchesSetUp_Private(const AbutSamples *a, AbutMesh mesh, const AbutMeshTopology *t, AbutPatches *p)
{
  PetscFunctionBegin;
  AbutPatchSpaceSetUp_Private(t->order + (t->corners == 4 && t->order > 1 ? 1 : 0), &p->space);
  PetscCall(PetscCalloc4(p->space.moments * t->nvertices, &p->moment, t->nvertices, &p->boundary, p->space.coefs * t->nvertices, &p->coef,
                         t->nvertices, &p->good));
  PetscCall(AbutPatchesGather_Private(a, mesh, t, p));
  PetscCall(AbutPatchesFit_Private(t, p));
  if (t->order == 1) PetscCall(AbutPatchesHandOn_Private(mesh, t, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds `times` what balances a constant body force: to stresses s[3*n] of each cell, at reference points xi[2*n] */
static PetscErrorCode AbutAddParticular_Private(AbutBody body, AbutMesh mesh, const AbutMeshTopology *t, PetscReal times, PetscInt n,
                                                const PetscReal xi[], PetscReal s[])
{
  PetscInt features;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetFeatures(body, &features));
  if (!(features & ABUT_FEATURE_BODY_FORCE_CONSTANT)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < n * t->ncells; ++i) {
    PetscReal x[2], J[4], more[3];

    PetscCall(AbutMeshMapPoint(mesh, i / n, xi + 2 * (i % n), x, J));
    PetscCall(AbutEstimatorGetParticular(body, x, NULL, more));
    for (PetscInt j = 0; j < 3; ++j) s[3 * i + j] += times * more[j];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The recovered stress at the nodes of the cells of this rank, [3*nodes*ncells].

   The continuous one of the patches is not the last word from order 2 on: beside a point where the stress is not smooth, as the edge of a
   contact, its error is more than that of the finite elements (measured: 1.3 times in triangles of order 3, 3.5 times in quads of order
   4). In quads the finite-element stress is best at the samples; so it keeps its lower part, the polynomial through them, and the patches
   only say what comes on top. Where all is smooth this changes next to nothing. Triangles have no such points: they keep what is of degree
   order-2. */
PetscErrorCode AbutEstimatorRecover_ZZ(AbutBody body, PetscReal s[])
{
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  AbutSamples            *samples;
  AbutPatches             p;
  const PetscReal        *node;
  PetscReal              *atnode;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(AbutMeshGetReferenceNodes(mesh, &node));
  PetscCall(AbutSamplesCreate_Private(body, mesh, t, &samples));
  PetscCall(AbutAddParticular_Private(body, mesh, t, -1., samples->n, samples->xi, samples->s));
  PetscCall(AbutPatchesSetUp_Private(samples, mesh, t, &p));
  PetscCall(PetscMalloc1(3 * t->nnodes, &atnode));
  PetscCall(AbutPatchesEvaluate_Private(body, mesh, t, &p, atnode));
  for (PetscInt i = 0; i < 3 * t->nodes * t->ncells; ++i) s[i] = atnode[3 * t->cellnode[i / 3] + i % 3];
  for (PetscInt c = 0; c < t->ncells && t->order > 1; ++c) PetscCall(AbutSamplesKeep_Private(samples, t, c, s + 3 * t->nodes * c));
  PetscCall(AbutAddParticular_Private(body, mesh, t, 1., t->nodes, node, s));
  PetscCall(PetscFree(atnode));
  PetscCall(PetscFree4(p.moment, p.boundary, p.coef, p.good));
  PetscCall(AbutSamplesDestroy_Private(&samples));
  PetscFunctionReturn(PETSC_SUCCESS);
}
