#include <petscdt.h>
#include "far.h"

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

/* Moments of a cluster for each power: of t1, t2; of the components of du/ds; of (t1 + i t2) conj(s); the same of du/ds; of u1 dt, u2 dt */
enum {
  OF_T1,
  OF_T2,
  OF_U1,
  OF_U2,
  OF_TC,
  OF_UC,
  OF_E1,
  OF_E2,
  NMOMENTS
};
typedef PetscComplex Moments[NMOMENTS];

struct _n_FembemFar {
  const FembemSystem *s; /* not owned */
  FembemClusters      clusters;
  PetscInt            terms, stride;  /* stride of the integrals of an element */
  PetscReal          *binomial;       /* [terms*terms] k over i */
  PetscComplex       *integral;       /* [stride*n] of P_n s^k ds, then of P_n conj(s) s^k ds */
  Moments            *moment, *local; /* [terms] of each cluster */
  PetscBool          *mine;           /* [clusters] this rank evaluates in it, or in a part of it */
  PetscInt            nfar, nnear;
  PetscInt           *far[2], *near[2]; /* pairs of clusters, each once */
};

static inline PetscReal Radius(const FembemCluster *cl)
{
  return PetscSqrtReal(cl->R2);
}

/* Counts the pairs, and stores them if there is room */
static void FindPairs(FembemFar f, PetscInt a, PetscInt b)
{
  const FembemCluster *A = &f->clusters.cluster[a], *B = &f->clusters.cluster[b];

  if (Radius(A) + Radius(B) < FEMBEM_FAR_THETA * PetscAbsComplex(A->c - B->c)) {
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
static PetscErrorCode SetMine(FembemFar f)
{
  PetscMPIInt size, rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(f->s->b->comm, &size));
  PetscCallMPI(MPI_Comm_rank(f->s->b->comm, &rank));
  for (PetscInt i = f->clusters.n - 1; i >= 0; --i) {
    const FembemCluster *cl = &f->clusters.cluster[i];

    if (cl->left >= 0) f->mine[i] = (PetscBool)(f->mine[cl->left] || f->mine[cl->right]);
    else f->mine[i] = (PetscBool)((PetscInt64)(cl->first + cl->end) * size / (2 * f->s->b->n) == rank);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetIntegrals(FembemFar f)
{
  const PetscInt order = f->s->b->order, npoints = (f->terms + order + 3) / 2;
  PetscReal     *x, *weight, P[ABUT_SIDE_NODES_MAX];

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(npoints, &x, npoints, &weight));
  PetscCall(PetscDTGaussQuadrature(npoints, -1., 1., x, weight));
  for (PetscInt id = 0; id < f->clusters.n; ++id) {
    const FembemCluster *cl = &f->clusters.cluster[id];

    for (PetscInt i = cl->first; cl->left < 0 && i < cl->end; ++i) {
      const FembemElement *e   = &f->s->e[i];
      PetscComplex        *sum = f->integral + (size_t)f->stride * i;

      for (PetscInt g = 0; g < npoints; ++g) {
        const PetscComplex s     = e->a - cl->c + (0.5 + 0.5 * x[g]) * e->t;
        PetscComplex       power = 0.5 * weight[g] * e->h;

        FembemLegendreP(order, x[g], P);
        for (PetscInt k = 0; k < f->terms; ++k, power *= s / Radius(cl))
          for (PetscInt n = 0; n <= order; ++n) {
            sum[(order + 1) * k + n] += P[n] * power;
            sum[(order + 1) * (f->terms + k) + n] += P[n] * power * PetscConjComplex(s);
          }
      }
    }
  }
  PetscCall(PetscFree2(x, weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* tolerance: relative error of what clusters do to each other */
PetscErrorCode FembemFarCreate(const FembemSystem *s, PetscReal tolerance, FembemFar *far)
{
  FembemFar f;

  PetscFunctionBegin;
  PetscCall(PetscNew(&f));
  f->s      = s;
  f->terms  = PetscMin(FEMBEM_FAR_TERMS, (PetscInt)PetscCeilReal(PetscLogReal(tolerance) / PetscLogReal(FEMBEM_FAR_THETA)));
  f->stride = 2 * f->terms * (s->b->order + 1);
  PetscCall(FembemClustersCreate(s->b->n, s->e, FEMBEM_FAR_LEAF, &f->clusters));
  PetscCall(PetscCalloc5(f->terms * f->terms, &f->binomial, (size_t)f->stride * s->b->n, &f->integral, f->terms * f->clusters.n, &f->moment,
                         f->terms * f->clusters.n, &f->local, f->clusters.n, &f->mine));
  for (PetscInt k = 0; k < f->terms; ++k)
    for (PetscInt i = 0; i <= k; ++i) f->binomial[f->terms * k + i] = i == 0 ? 1. : f->binomial[f->terms * k + i - 1] * (k - i + 1.) / i;
  PetscCall(SetMine(f));
  PetscCall(SetPairs(f));
  PetscCall(SetIntegrals(f));
  *far = f;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pairs of leaves that are near each other */
void FembemFarGetClusters(FembemFar f, const FembemClusters **clusters, PetscInt *nnear, const PetscInt *near[2])
{
  *clusters = &f->clusters;
  *nnear    = f->nnear;
  near[0]   = f->near[0];
  near[1]   = f->near[1];
}

/* Held for integrals and moments */
size_t FembemFarNumbers(FembemFar f)
{
  return 2 * ((size_t)f->stride * f->s->b->n + 2 * (size_t)NMOMENTS * f->terms * f->clusters.n);
}

/* Moments of an element of a leaf; or, transposed, what the element's nodes see */
static void AddElement(FembemFar f, PetscInt i, const PetscReal t[], const PetscReal u[], Moments m[])
{
  const FembemSystem *s     = f->s;
  const FembemBasis  *basis = &s->b->basis;
  const PetscInt      n     = basis->order + 1;
  const PetscReal     toarc = 2. / s->e[i].h;

  for (PetscInt l = 0; l < n; ++l) {
    PetscReal T[2] = {0., 0.}, U[2] = {0., 0.}, E[2] = {0., 0.};

    for (PetscInt k = 0; k < n; ++k)
      for (PetscInt c = 0; c < 2; ++c) {
        const PetscReal v = u[2 * AbutBoundaryNode(s->b, i, k) + c];

        T[c] += basis->coefficient[l][k] * t[s->rows * i + 2 * k + c];
        U[c] += toarc * basis->derivative[l][k] * v;
        E[c] += basis->coefficient[l][k] * v;
      }
    for (PetscInt k = 0; k < f->terms; ++k) {
      const PetscComplex *in = f->integral + (size_t)f->stride * i + n * k + l, a = in[0], b = in[n * f->terms];
      const PetscComplex  dt = a * PetscConjComplex(s->e[i].em);

      for (PetscInt c = 0; c < 2; ++c) {
        m[k][OF_T1 + c] += T[c] * a;
        m[k][OF_U1 + c] += U[c] * a;
        m[k][OF_E1 + c] += E[c] * dt;
      }
      m[k][OF_TC] += PetscCMPLX(T[0], T[1]) * b;
      m[k][OF_UC] += PetscCMPLX(U[0], U[1]) * b;
    }
  }
}

static void SeeElement(FembemFar f, PetscInt i, Moments v[], PetscReal t[], PetscReal u[])
{
  const FembemSystem *s     = f->s;
  const FembemBasis  *basis = &s->b->basis;
  const PetscInt      n     = basis->order + 1;
  const PetscReal     toarc = 2. / s->e[i].h;

  for (PetscInt l = 0; l < n; ++l) {
    PetscComplex T[2] = {0., 0.}, U[2] = {0., 0.}, E[2] = {0., 0.}, TC = 0., UC = 0.;

    for (PetscInt k = 0; k < f->terms; ++k) {
      const PetscComplex *in = f->integral + (size_t)f->stride * i + n * k + l, a = in[0], b = in[n * f->terms];

      for (PetscInt c = 0; c < 2; ++c) {
        T[c] += v[k][OF_T1 + c] * a;
        U[c] += v[k][OF_U1 + c] * a;
        E[c] += v[k][OF_E1 + c] * a;
      }
      TC += v[k][OF_TC] * b;
      UC += v[k][OF_UC] * b;
    }
    for (PetscInt c = 0; c < 2; ++c) { /* Re(i z) = -Im z */
      const PetscReal onT = PetscRealPartComplex(T[c]) + (c ? -PetscImaginaryPartComplex(TC) : PetscRealPartComplex(TC));
      const PetscReal onU = PetscRealPartComplex(U[c]) + (c ? -PetscImaginaryPartComplex(UC) : PetscRealPartComplex(UC));
      const PetscReal onE = PetscRealPartComplex(E[c] * PetscConjComplex(s->e[i].em));

      for (PetscInt k = 0; k < n; ++k) {
        t[s->rows * i + 2 * k + c] += basis->coefficient[l][k] * onT;
        u[2 * AbutBoundaryNode(s->b, i, k) + c] += toarc * basis->derivative[l][k] * onU + basis->coefficient[l][k] * onE;
      }
    }
  }
}

/* (s + d)^k over the parent's radius, by powers of s over the child's: factors of the lower triangle */
static void GetShift(FembemFar f, PetscInt child, PetscInt parent, PetscComplex *d, PetscComplex factor[])
{
  const FembemCluster *from = &f->clusters.cluster[child], *to = &f->clusters.cluster[parent];
  const PetscComplex   r = (from->c - to->c) / Radius(to);
  const PetscReal      q = Radius(from) / Radius(to);
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
  const Moments *from = f->moment + f->terms * child;
  Moments       *to   = f->moment + f->terms * parent;
  PetscComplex   d;

  GetShift(f, child, parent, &d, factor);
  for (PetscInt k = 0; k < f->terms; ++k)
    for (PetscInt i = 0; i <= k; ++i) {
      const PetscComplex c = factor[f->terms * k + i];

      for (PetscInt m = 0; m < NMOMENTS; ++m) to[k][m] += c * from[i][m];
      to[k][OF_TC] += c * PetscConjComplex(d) * (from[i][OF_T1] + PETSC_i * from[i][OF_T2]);
      to[k][OF_UC] += c * PetscConjComplex(d) * (from[i][OF_U1] + PETSC_i * from[i][OF_U2]);
    }
}

static void ShiftDown(FembemFar f, PetscInt child, PetscInt parent, PetscComplex factor[])
{
  const Moments *from = f->local + f->terms * parent;
  Moments       *to   = f->local + f->terms * child;
  PetscComplex   d;

  GetShift(f, child, parent, &d, factor);
  for (PetscInt k = 0; k < f->terms; ++k)
    for (PetscInt i = 0; i <= k; ++i) {
      const PetscComplex c = factor[f->terms * k + i], t = c * PetscConjComplex(d) * from[k][OF_TC],
                         u = c * PetscConjComplex(d) * from[k][OF_UC];

      for (PetscInt m = 0; m < NMOMENTS; ++m) to[i][m] += c * from[k][m];
      to[i][OF_T1] += t;
      to[i][OF_T2] += PETSC_i * t;
      to[i][OF_U1] += u;
      to[i][OF_U2] += PETSC_i * u;
    }
}

/* Sums over the powers of the source for one power j of the target: the kernel 1/w, but for 1/d, and of the first four moments log w */
static void SumPowers(FembemFar f, PetscInt j, const Moments scaled[], Moments cauchy, Moments logarithm)
{
  for (PetscInt m = 0; m < NMOMENTS; ++m) cauchy[m] = logarithm[m] = 0.;
  for (PetscInt i = 0; i + j < f->terms; ++i) {
    const PetscReal c = (i % 2 ? -1. : 1.) * f->binomial[f->terms * (i + j) + i], l = i + j ? -c / (i + j) : 0.;

    for (PetscInt m = 0; m < NMOMENTS; ++m) cauchy[m] += c * scaled[i][m];
    for (PetscInt m = OF_T1; m <= OF_U2; ++m) logarithm[m] += l * scaled[i][m];
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
  const Moments       *moment = f->moment + f->terms * source;
  Moments             *local  = f->local + f->terms * target, scaled[FEMBEM_FAR_TERMS];
  PetscComplex         power  = 1.;

  for (PetscInt i = 0; i < f->terms; ++i, power *= Radius(from) * inv)
    for (PetscInt m = 0; m < NMOMENTS; ++m) scaled[i][m] = power * moment[i][m];
  power = 1.;
  for (PetscInt j = 0; j < f->terms; ++j, power *= Radius(to) * inv) {
    Moments      X, Y;
    PetscComplex t, u, tc, uc;

    SumPowers(f, j, scaled, X, Y);
    for (PetscInt m = 0; m < NMOMENTS; ++m) X[m] *= power * inv;
    for (PetscInt m = OF_T1; m <= OF_U2; ++m) Y[m] = power * Y[m] + (j ? 0. : PetscLogComplex(d) * scaled[0][m]);
    t  = X[OF_T1] + PETSC_i * X[OF_T2];
    u  = X[OF_U1] + PETSC_i * X[OF_U2];
    tc = PetscConjComplex(d) * t + X[OF_TC];
    uc = PetscConjComplex(d) * u + X[OF_UC];
    local[j][OF_T1] += cV * (tc - 2. * kappa * Y[OF_T1]) - iF * ((kappa + 1.) * X[OF_E1] + PETSC_i * (kappa - 1.) * X[OF_E2] + uc);
    local[j][OF_T2] += cV * (PETSC_i * tc - 2. * kappa * Y[OF_T2]) -
                       iF * ((kappa + 1.) * X[OF_E2] - PETSC_i * (kappa - 1.) * X[OF_E1] + PETSC_i * uc);
    local[j][OF_TC] += iF * u - cV * t;
    local[j][OF_U1] += cD * (2. * Y[OF_U1] - uc) - iF * tc;
    local[j][OF_U2] += cD * (2. * Y[OF_U2] - PETSC_i * uc) + F * tc;
    local[j][OF_UC] += cD * u + iF * t;
    local[j][OF_E1] += iF * ((kappa + 1.) * X[OF_T1] - PETSC_i * (kappa - 1.) * X[OF_T2]);
    local[j][OF_E2] += iF * ((kappa + 1.) * X[OF_T2] + PETSC_i * (kappa - 1.) * X[OF_T1]);
  }
}

/* Adds this rank's part of the far operator on t, [rows*n] at the nodes of each element, and u, [2*nnodes] */
void FembemFarAdd(FembemFar f, const PetscReal t[], const PetscReal u[], PetscReal onT[], PetscReal onU[])
{
  PetscComplex factor[FEMBEM_FAR_TERMS * FEMBEM_FAR_TERMS];

  for (PetscInt i = 0; i < f->terms * f->clusters.n; ++i)
    for (PetscInt m = 0; m < NMOMENTS; ++m) f->moment[i][m] = f->local[i][m] = 0.;
  for (PetscInt id = f->clusters.n - 1; id >= 0; --id) {
    const FembemCluster *cl = &f->clusters.cluster[id];

    if (cl->left < 0) {
      for (PetscInt i = cl->first; i < cl->end; ++i) AddElement(f, i, t, u, f->moment + f->terms * id);
    } else {
      ShiftUp(f, cl->left, id, factor);
      ShiftUp(f, cl->right, id, factor);
    }
  }
  for (PetscInt k = 0; k < f->nfar; ++k) {
    if (f->mine[f->far[0][k]]) Convert(f, f->far[0][k], f->far[1][k]);
    if (f->mine[f->far[1][k]]) Convert(f, f->far[1][k], f->far[0][k]);
  }
  for (PetscInt id = 0; id < f->clusters.n; ++id) {
    const FembemCluster *cl = &f->clusters.cluster[id];

    if (!f->mine[id]) continue;
    if (cl->left < 0) {
      for (PetscInt i = cl->first; i < cl->end; ++i) SeeElement(f, i, f->local + f->terms * id, onT, onU);
    } else {
      ShiftDown(f, cl->left, id, factor);
      ShiftDown(f, cl->right, id, factor);
    }
  }
}

PetscErrorCode FembemFarDestroy(FembemFar *far)
{
  PetscFunctionBegin;
  if (!*far) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FembemClustersDestroy(&(*far)->clusters));
  PetscCall(PetscFree5((*far)->binomial, (*far)->integral, (*far)->moment, (*far)->local, (*far)->mine));
  PetscCall(PetscFree4((*far)->far[0], (*far)->far[1], (*far)->near[0], (*far)->near[1]));
  PetscCall(PetscFree(*far));
  PetscFunctionReturn(PETSC_SUCCESS);
}
