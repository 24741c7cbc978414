#include "clusters.h"

static void Bound(const FembemElement e[], FembemCluster *cl)
{
  PetscReal lo[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL}, hi[2] = {PETSC_MIN_REAL, PETSC_MIN_REAL};

  for (PetscInt i = cl->first; i < cl->end; ++i) {
    for (PetscInt k = 0; k < 2; ++k) {
      const PetscComplex z    = k ? e[i].b : e[i].a;
      const PetscReal    x[2] = {PetscRealPartComplex(z), PetscImaginaryPartComplex(z)};

      for (PetscInt d = 0; d < 2; ++d) {
        lo[d] = PetscMin(lo[d], x[d]);
        hi[d] = PetscMax(hi[d], x[d]);
      }
    }
  }
  cl->c  = PetscCMPLX(0.5 * (lo[0] + hi[0]), 0.5 * (lo[1] + hi[1]));
  cl->R2 = 0.;
  for (PetscInt i = cl->first; i < cl->end; ++i)
    cl->R2 = PetscMax(cl->R2, PetscMax(FembemAbsSquare(e[i].a - cl->c), FembemAbsSquare(e[i].b - cl->c)));
}

static PetscInt Build(const FembemElement e[], PetscInt first, PetscInt end, PetscInt leaf, FembemClusters *clusters)
{
  const PetscInt id = clusters->n++, middle = (first + end) / 2;
  FembemCluster *cl = &clusters->cluster[id];

  cl->first = first;
  cl->end   = end;
  cl->left = cl->right = -1;
  Bound(e, cl);
  if (end - first > leaf) {
    cl->left  = Build(e, first, middle, leaf, clusters);
    cl->right = Build(e, middle, end, leaf, clusters);
  }
  return id;
}

/* Leaves have at most, and more than half of, so many elements */
PetscErrorCode FembemClustersCreate(PetscInt n, const FembemElement e[], PetscInt leaf, FembemClusters *clusters)
{
  PetscFunctionBegin;
  clusters->n = 0;
  PetscCall(PetscMalloc1(2 * (2 * (size_t)n / leaf + 1), &clusters->cluster));
  Build(e, 0, n, leaf, clusters);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FembemClustersDestroy(FembemClusters *clusters)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(clusters->cluster));
  PetscFunctionReturn(PETSC_SUCCESS);
}
