#include "farimpl.h"

/*
   The fast multipole method (L. Greengard and V. Rokhlin, J. Comput. Phys. 73, 1987) for the operators V, W and D. With w = t - z, t in the
   inner cluster and z in the outer one, all three are real parts of sums of products of densities with log w, 1/w and conj(w)/w. About the
   centres, w = d + s - r, d the distance of the centres, and all follow from
     1/w = 1/d sum_ij (-1)^i binomial(i+j, i) (s/d)^i (r/d)^j,   log w = log d - sum_ij (-1)^i binomial(i+j, i)/(i+j) (s/d)^i (r/d)^j,
   cut off at i + j = terms: an error of theta^terms where the radii together are theta |d|. The moments of a cluster are those of the
   tractions t, of du/ds, and of u dt; their powers are of s over the radius, so that small clusters do not underflow. To test is the
   transpose of to sum up: the operator is symmetric whatever the number of terms.
*/
#define FEMBEM_FAR_LEAF  8
#define FEMBEM_FAR_THETA 0.5
#define FEMBEM_FAR_TERMS 48

/* Counts the pairs, and stores them if there is room */
static void FindPairs(FembemFar f, PetscInt a, PetscInt b)
{
  const FembemCluster *A = &f->clusters.cluster[a], *B = &f->clusters.cluster[b];

  if (FembemRadius(A) + FembemRadius(B) < FEMBEM_FAR_THETA * PetscAbsComplex(A->c - B->c)) {
    if (f->far[0]) {
      f->far[0][f->nfar] = a;
      f->far[1][f->nfar] = b;
    }
    ++f->nfar;
  } else if (A->left < 0 && B->left < 0) {
    if (f->near[0]) {
      f->near[0][f->nnear] = a;
      f->near[1][f->nnear] = b;
    }
    ++f->nnear;
  } else if (a == b) {
    FindPairs(f, A->left, A->left);
    FindPairs(f, A->left, A->right);
    FindPairs(f, A->right, A->right);
  } else if (B->left < 0 || (A->left >= 0 && A->R2 >= B->R2)) {
    FindPairs(f, A->left, b);
    FindPairs(f, A->right, b);
  } else {
    FindPairs(f, a, B->left);
    FindPairs(f, a, B->right);
  }
}

static PetscErrorCode SetPairs(FembemFar f)
{
  PetscFunctionBegin;
  FindPairs(f, 0, 0);
  PetscCall(PetscMalloc4(f->nfar, &f->far[0], f->nfar, &f->far[1], f->nnear, &f->near[0], f->nnear, &f->near[1]));
  f->nfar = f->nnear = 0;
  FindPairs(f, 0, 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Leaves are dealt out by their place on the boundary */
static PetscErrorCode SetFlags(FembemFar f)
{
  PetscMPIInt size, rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(f->s->b->comm, &size));
  PetscCallMPI(MPI_Comm_rank(f->s->b->comm, &rank));
  for (PetscInt i = f->clusters.n - 1; i >= 0; --i) {
    const FembemCluster *cl = &f->clusters.cluster[i];

    if (cl->left >= 0) {
      f->mine[i]     = (PetscBool)(f->mine[cl->left] || f->mine[cl->right]);
      f->traction[i] = (PetscBool)(f->traction[cl->left] || f->traction[cl->right]);
      continue;
    }
    f->mine[i] = (PetscBool)((PetscInt64)(cl->first + cl->end) * size / (2 * f->s->b->n) == rank);
    for (PetscInt k = cl->first; k < cl->end; ++k)
      if (f->s->local[k].tfree || f->s->local[k].loaded) f->traction[i] = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* tolerance: relative error of what clusters do to each other; measured, it is well below 0.1 theta^terms */
PetscErrorCode FembemFarCreate(const FembemSystem *s, PetscReal tolerance, FembemFar *far)
{
  FembemFar f;

  PetscFunctionBegin;
  PetscCall(PetscNew(&f));
  f->s      = s;
  f->terms  = PetscMin(FEMBEM_FAR_TERMS, (PetscInt)PetscCeilReal(PetscLogReal(tolerance / 0.1) / PetscLogReal(FEMBEM_FAR_THETA)));
  f->stride = 2 * f->terms * (s->b->order + 1);
  PetscCall(FembemClustersCreate(s->b->n, s->e, FEMBEM_FAR_LEAF, &f->clusters));
  PetscCall(PetscCalloc6(f->terms * f->terms, &f->binomial, (size_t)f->stride * s->b->n, &f->integral, f->terms * (size_t)f->clusters.n,
                         &f->moment, f->terms * (size_t)f->clusters.n, &f->local, f->clusters.n, &f->mine, f->clusters.n, &f->traction));
  for (PetscInt k = 0; k < f->terms; ++k)
    for (PetscInt i = 0; i <= k; ++i) f->binomial[f->terms * k + i] = i == 0 ? 1. : f->binomial[f->terms * k + i - 1] * (k - i + 1.) / i;
  PetscCall(SetFlags(f));
  PetscCall(SetPairs(f));
  PetscCall(FembemFarSetIntegrals(f));
  *far = f;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pairs of leaves that are near each other */
void FembemFarGetClusters(FembemFar f, const FembemClusters **clusters, PetscCount *nnear, const PetscInt *near[2])
{
  *clusters = &f->clusters;
  *nnear    = f->nnear;
  near[0]   = f->near[0];
  near[1]   = f->near[1];
}

/* Held for integrals and moments */
size_t FembemFarNumbers(FembemFar f)
{
  return 2 * ((size_t)f->stride * f->s->b->n + 2 * (size_t)FEMBEM_MOMENTS * f->terms * f->clusters.n);
}

/* (s + d)^k over the parent's radius, by powers of s over the child's: factors of the lower triangle */
static void GetShift(FembemFar f, PetscInt child, PetscInt parent, PetscComplex *d, PetscComplex factor[])
{
  const FembemCluster *from = &f->clusters.cluster[child], *to = &f->clusters.cluster[parent];
  const PetscComplex   r = (from->c - to->c) / FembemRadius(to);
  const PetscReal      q = FembemRadius(from) / FembemRadius(to);
  PetscComplex         power[FEMBEM_FAR_TERMS];

  *d       = from->c - to->c;
  power[0] = 1.;
  for (PetscInt k = 1; k < f->terms; ++k) power[k] = power[k - 1] * r;
  for (PetscInt k = 0; k < f->terms; ++k) {
    PetscReal qi = 1.;

    for (PetscInt i = 0; i <= k; ++i, qi *= q) factor[f->terms * k + i] = f->binomial[f->terms * k + i] * qi * power[k - i];
  }
}

static void ShiftUp(FembemFar f, PetscInt child, PetscInt parent, PetscComplex factor[])
{
  const FembemMoments *from = FembemFarMoments(f, f->moment, child);
  FembemMoments       *to   = FembemFarMoments(f, f->moment, parent);
  PetscComplex         d;

  GetShift(f, child, parent, &d, factor);
  for (PetscInt k = 0; k < f->terms; ++k)
    for (PetscInt i = 0; i <= k; ++i) {
      const PetscComplex c = factor[f->terms * k + i];

      for (PetscInt m = 0; m < FEMBEM_MOMENTS; ++m) to[k][m] += c * from[i][m];
      to[k][FEMBEM_TC] += c * PetscConjComplex(d) * (from[i][FEMBEM_T1] + PETSC_i * from[i][FEMBEM_T2]);
      to[k][FEMBEM_UC] += c * PetscConjComplex(d) * (from[i][FEMBEM_U1] + PETSC_i * from[i][FEMBEM_U2]);
    }
}

static void ShiftDown(FembemFar f, PetscInt child, PetscInt parent, PetscComplex factor[])
{
  const FembemMoments *from = FembemFarMoments(f, f->local, parent);
  FembemMoments       *to   = FembemFarMoments(f, f->local, child);
  PetscComplex         d;

  GetShift(f, child, parent, &d, factor);
  for (PetscInt k = 0; k < f->terms; ++k)
    for (PetscInt i = 0; i <= k; ++i) {
      const PetscComplex c = factor[f->terms * k + i], t = c * PetscConjComplex(d) * from[k][FEMBEM_TC],
                         u = c * PetscConjComplex(d) * from[k][FEMBEM_UC];

      for (PetscInt m = 0; m < FEMBEM_MOMENTS; ++m) to[i][m] += c * from[k][m];
      to[i][FEMBEM_T1] += t;
      to[i][FEMBEM_T2] += PETSC_i * t;
      to[i][FEMBEM_U1] += u;
      to[i][FEMBEM_U2] += PETSC_i * u;
    }
}

/* Sums over the powers of the source for one power j of the target, of moments first to end-1: the kernel 1/w, but for 1/d, and log w */
static void SumPowers(FembemFar f, PetscInt j, PetscInt first, PetscInt end, const FembemMoments scaled[], FembemMoments cauchy,
                      FembemMoments logarithm)
{
  for (PetscInt m = 0; m < FEMBEM_MOMENTS; ++m) cauchy[m] = logarithm[m] = 0.;
  for (PetscInt i = 0; i + j < f->terms; ++i) {
    const PetscReal c = (i % 2 ? -1. : 1.) * f->binomial[f->terms * (i + j) + i], l = i + j ? -c / (i + j) : 0.;

    for (PetscInt m = first; m < end; ++m) cauchy[m] += c * scaled[i][m];
    for (PetscInt m = first; m < FEMBEM_UC; ++m) logarithm[m] += l * scaled[i][m];
  }
}

/* What the moments of the source are to the target. With F = 1/(2 pi (1 + kappa)) and z outside, t inside
     V: c Re[-2 kappa (h1 g1 + h2 g2) log w + h g conj(w)/w], c = 1/(4 pi mu (1 + kappa)), D: the same of du/ds with kappa = 1 and other c,
     W: F Im[(kappa + 1)(h1 E1 + h2 E2)/w + i (kappa - 1)(h1 E2 - h2 E1)/w + h du/ds conj(w)/w], E = u dt. */
static void Convert(FembemFar f, PetscInt target, PetscInt source)
{
  const FembemCluster *to = &f->clusters.cluster[target], *from = &f->clusters.cluster[source];
  const PetscReal      mu = f->s->pairing.mat.mu, kappa = f->s->pairing.mat.kappa, F = 1. / (2. * PETSC_PI * (1. + kappa));
  const PetscReal      cV = 0.5 * F / mu, cD = 2. * F * mu;
  const PetscComplex   d = from->c - to->c, inv = PetscConjComplex(d) / FembemAbsSquare(d), iF = F * PETSC_i;
  const FembemMoments *moment = FembemFarMoments(f, f->moment, source);
  FembemMoments       *local  = FembemFarMoments(f, f->local, target), scaled[FEMBEM_FAR_TERMS];
  const PetscInt       first = f->traction[source] ? FEMBEM_T1 : FEMBEM_U1, end = f->traction[target] ? FEMBEM_MOMENTS : FEMBEM_E1;
  PetscComplex         power = 1.;

  for (PetscInt i = 0; i < f->terms; ++i, power *= FembemRadius(from) * inv)
    for (PetscInt m = 0; m < FEMBEM_MOMENTS; ++m) scaled[i][m] = power * moment[i][m];
  power = 1.;
  for (PetscInt j = 0; j < f->terms; ++j, power *= FembemRadius(to) * inv) {
    FembemMoments X, Y;
    PetscComplex  t, u, tc, uc;

    SumPowers(f, j, first, end, scaled, X, Y);
    for (PetscInt m = 0; m < FEMBEM_MOMENTS; ++m) X[m] *= power * inv;
    for (PetscInt m = FEMBEM_T1; m < FEMBEM_UC; ++m) Y[m] = power * Y[m] + (j ? 0. : PetscLogComplex(d) * scaled[0][m]);
    t  = X[FEMBEM_T1] + PETSC_i * X[FEMBEM_T2];
    u  = X[FEMBEM_U1] + PETSC_i * X[FEMBEM_U2];
    tc = PetscConjComplex(d) * t + X[FEMBEM_TC];
    uc = PetscConjComplex(d) * u + X[FEMBEM_UC];
    local[j][FEMBEM_T1] += cV * (tc - 2. * kappa * Y[FEMBEM_T1]) -
                           iF * ((kappa + 1.) * X[FEMBEM_E1] + PETSC_i * (kappa - 1.) * X[FEMBEM_E2] + uc);
    local[j][FEMBEM_T2] += cV * (PETSC_i * tc - 2. * kappa * Y[FEMBEM_T2]) -
                           iF * ((kappa + 1.) * X[FEMBEM_E2] - PETSC_i * (kappa - 1.) * X[FEMBEM_E1] + PETSC_i * uc);
    local[j][FEMBEM_TC] += iF * u - cV * t;
    local[j][FEMBEM_U1] += cD * (2. * Y[FEMBEM_U1] - uc) - iF * tc;
    local[j][FEMBEM_U2] += cD * (2. * Y[FEMBEM_U2] - PETSC_i * uc) + F * tc;
    local[j][FEMBEM_UC] += cD * u + iF * t;
    local[j][FEMBEM_E1] += iF * ((kappa + 1.) * X[FEMBEM_T1] - PETSC_i * (kappa - 1.) * X[FEMBEM_T2]);
    local[j][FEMBEM_E2] += iF * ((kappa + 1.) * X[FEMBEM_T2] + PETSC_i * (kappa - 1.) * X[FEMBEM_T1]);
  }
}

/* FembemMoments are sums over the elements, so that each rank goes up from its own; those of all ranks are added */
static PetscErrorCode GetMoments(FembemFar f, const PetscReal t[], const PetscReal u[])
{
  PetscComplex factor[FEMBEM_FAR_TERMS * FEMBEM_FAR_TERMS];

  PetscFunctionBegin;
  for (size_t i = 0; i < f->terms * (size_t)f->clusters.n; ++i)
    for (PetscInt m = 0; m < FEMBEM_MOMENTS; ++m) f->moment[i][m] = 0.;
  for (PetscInt id = f->clusters.n - 1; id >= 0; --id) {
    const FembemCluster *cl = &f->clusters.cluster[id];

    if (!f->mine[id]) continue;
    if (cl->left < 0) {
      for (PetscInt i = cl->first; i < cl->end; ++i) FembemFarAddElement(f, i, t, u, FembemFarMoments(f, f->moment, id));
    } else {
      if (f->mine[cl->left]) ShiftUp(f, cl->left, id, factor);
      if (f->mine[cl->right]) ShiftUp(f, cl->right, id, factor);
    }
  }
  PetscCall(FembemDenseSum(f->s->b->comm, 2 * (size_t)FEMBEM_MOMENTS * f->terms * f->clusters.n, (PetscReal *)f->moment));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds this rank's part of the far operator on t, [rows*n] at the nodes of each element, and u, [2*nnodes]; collective */
PetscErrorCode FembemFarAdd(FembemFar f, const PetscReal t[], const PetscReal u[], PetscReal onT[], PetscReal onU[])
{
  PetscComplex factor[FEMBEM_FAR_TERMS * FEMBEM_FAR_TERMS];

  PetscFunctionBegin;
  PetscCall(GetMoments(f, t, u));
  for (size_t i = 0; i < f->terms * (size_t)f->clusters.n; ++i)
    for (PetscInt m = 0; m < FEMBEM_MOMENTS; ++m) f->local[i][m] = 0.;
  for (PetscCount k = 0; k < f->nfar; ++k) {
    if (f->mine[f->far[0][k]]) Convert(f, f->far[0][k], f->far[1][k]);
    if (f->mine[f->far[1][k]]) Convert(f, f->far[1][k], f->far[0][k]);
  }
  for (PetscInt id = 0; id < f->clusters.n; ++id) {
    const FembemCluster *cl = &f->clusters.cluster[id];

    if (!f->mine[id]) continue;
    if (cl->left < 0) {
      for (PetscInt i = cl->first; i < cl->end; ++i) FembemFarSeeElement(f, i, FembemFarMoments(f, f->local, id), onT, onU);
    } else {
      if (f->mine[cl->left]) ShiftDown(f, cl->left, id, factor);
      if (f->mine[cl->right]) ShiftDown(f, cl->right, id, factor);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FembemFarDestroy(FembemFar *far)
{
  PetscFunctionBegin;
  if (!*far) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FembemClustersDestroy(&(*far)->clusters));
  PetscCall(PetscFree6((*far)->binomial, (*far)->integral, (*far)->moment, (*far)->local, (*far)->mine, (*far)->traction));
  PetscCall(PetscFree4((*far)->far[0], (*far)->far[1], (*far)->near[0], (*far)->near[1]));
  PetscCall(PetscFree(*far));
  PetscFunctionReturn(PETSC_SUCCESS);
}
