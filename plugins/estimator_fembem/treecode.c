#include <petscdt.h>
#include "fembemimpl.h"
#include "clusters.h"

/*
   Barnes and Hut's treecode (Nature 324, 1986) for the sums of FembemSourceAdd(): a binary tree over the boundary in its order, each
   cluster with the moments of its densities about its centre c. The potentials are holomorphic, so with v = 1/(z - c), moments
   Mp_k = Int p (t-c)^k dt, Mq_k the same of q, N_k = Int conj(t-c) p (t-c)^k dt,
     Int p/(t-z) dt = -sum_k Mp_k v^(k+1),   Int (conj(t)-conj(z)) p/(t-z)^2 dt = sum_k (k+1) (N_k - conj(z-c) Mp_k) v^(k+2).
   A cluster of radius R is used when R < theta |z-c|; nearer leaves are summed in closed form, so points may lie anywhere.
*/
#define FEMBEM_LEAF  8
#define FEMBEM_THETA 0.5

struct _n_FembemTree {
  PetscInt            terms;
  const FembemSource *source; /* not owned */
  FembemClusters      clusters;
  PetscComplex       *moment; /* [4*terms*nclusters] for each k: Mp, Mq, (k+1) Mp, (k+1) N */
  PetscInt            npoints;
  PetscReal          *point, *weight; /* Gauss on [-1,1], exact for the moments */
  PetscReal          *legendre;       /* [ABUT_SIDE_NODES_MAX*npoints] the polynomials there */
};

static void ClusterMoments(FembemTree tree, const FembemCluster *cl, PetscComplex m[])
{
  for (PetscInt k = 0; k < 4 * tree->terms; ++k) m[k] = 0.;
  for (PetscInt i = cl->first; i < cl->end; ++i) {
    const FembemSource *s = &tree->source[i];

    for (PetscInt g = 0; g < tree->npoints; ++g) {
      const PetscReal   *P = tree->legendre + ABUT_SIDE_NODES_MAX * g;
      const PetscComplex w = s->e.a - cl->c + (0.5 + 0.5 * tree->point[g]) * s->e.t, dt = 0.5 * tree->weight[g] * s->e.t,
                         cw = PetscConjComplex(w);
      PetscComplex p = 0., q = 0.;

      for (PetscInt k = 0; k <= s->order; ++k) {
        p += P[k] * s->p[k];
        q += P[k] * s->q[k];
      }
      p *= dt;
      q *= dt;
      for (PetscInt k = 0; k < tree->terms; ++k) {
        m[4 * k] += p;
        m[4 * k + 1] += q;
        m[4 * k + 2] += (k + 1.) * p;
        m[4 * k + 3] += (k + 1.) * p * cw;
        p *= w;
        q *= w;
      }
    }
  }
}

/* Terms for a relative tolerance; the errors measured are below 0.1 theta^terms (10 terms: 1e-4, 16: 1.4e-6, 24: 4e-9) */
static PetscInt TermsForTolerance(PetscReal tolerance)
{
  return PetscMax(4, (PetscInt)PetscCeilReal(PetscLogReal(tolerance / 0.1) / PetscLogReal(FEMBEM_THETA)));
}

PetscErrorCode FembemTreeCreate(PetscInt n, const FembemSource source[], PetscReal tolerance, FembemTree *newtree)
{
  FembemTree     tree;
  FembemElement *e;

  PetscFunctionBegin;
  PetscCall(PetscNew(&tree));
  PetscCall(PetscMalloc1(n, &e));
  for (PetscInt i = 0; i < n; ++i) e[i] = source[i].e;
  PetscCall(FembemClustersCreate(n, e, FEMBEM_LEAF, &tree->clusters));
  PetscCall(PetscFree(e));
  tree->source  = source;
  tree->terms   = TermsForTolerance(tolerance);
  tree->npoints = (tree->terms + source[0].order + 3) / 2;
  PetscCall(PetscMalloc4(4 * (size_t)tree->terms * tree->clusters.n, &tree->moment, tree->npoints, &tree->point, tree->npoints,
                         &tree->weight, ABUT_SIDE_NODES_MAX * tree->npoints, &tree->legendre));
  PetscCall(PetscDTGaussQuadrature(tree->npoints, -1., 1., tree->point, tree->weight));
  for (PetscInt g = 0; g < tree->npoints; ++g) FembemLegendreP(source[0].order, tree->point[g], &tree->legendre[ABUT_SIDE_NODES_MAX * g]);
  for (PetscInt i = 0; i < tree->clusters.n; ++i)
    ClusterMoments(tree, &tree->clusters.cluster[i], &tree->moment[4 * (size_t)tree->terms * i]);
  *newtree = tree;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Horner's scheme, from the highest term */
static void ClusterAdd(FembemTree tree, PetscInt id, PetscComplex w, PetscComplex *phi, PetscComplex *S)
{
  const PetscComplex *m = &tree->moment[4 * (size_t)tree->terms * id], v = PetscConjComplex(w) / FembemAbsSquare(w);
  PetscComplex        p = 0., q = 0., dp = 0., dn = 0.;

  for (PetscInt k = tree->terms - 1; k >= 0; --k) {
    p  = p * v + m[4 * k];
    q  = q * v + m[4 * k + 1];
    dp = dp * v + m[4 * k + 2];
    dn = dn * v + m[4 * k + 3];
  }
  *phi -= p * v;
  *S -= q * v + (dn - PetscConjComplex(w) * dp) * v * v;
}

static void TreeAdd(FembemTree tree, PetscInt id, PetscComplex z, PetscComplex *phi, PetscComplex *S)
{
  const FembemCluster *cl = &tree->clusters.cluster[id];
  const PetscComplex   w  = z - cl->c;

  if (cl->R2 < FEMBEM_THETA * FEMBEM_THETA * FembemAbsSquare(w)) {
    ClusterAdd(tree, id, w, phi, S);
  } else if (cl->left < 0) {
    for (PetscInt i = cl->first; i < cl->end; ++i) FembemSourceAdd(&tree->source[i], z, phi, S);
  } else {
    TreeAdd(tree, cl->left, z, phi, S);
    TreeAdd(tree, cl->right, z, phi, S);
  }
}

/* What FembemSourceAdd() of all elements would add */
void FembemTreeAdd(FembemTree tree, PetscComplex z, PetscComplex *phi, PetscComplex *S)
{
  TreeAdd(tree, 0, z, phi, S);
}

PetscErrorCode FembemTreeDestroy(FembemTree *tree)
{
  PetscFunctionBegin;
  if (!*tree) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FembemClustersDestroy(&(*tree)->clusters));
  PetscCall(PetscFree4((*tree)->moment, (*tree)->point, (*tree)->weight, (*tree)->legendre));
  PetscCall(PetscFree(*tree));
  PetscFunctionReturn(PETSC_SUCCESS);
}
