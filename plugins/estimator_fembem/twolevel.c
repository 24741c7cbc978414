#include "twolevel.h"
#include <petscblaslapack.h>

/*
   Two levels, added (B. Smith, P. Bjorstad and W. Gropp, Domain Decomposition, 1996): the operator within each leaf of the tree, whose
   inverse knows what changes from element to element, and the dense system of merged elements, which knows the rest.
*/
struct _n_FembemTwoLevel {
  FembemCoarse  coarse;
  PetscInt      n, nblocks;
  PetscInt     *first;   /* [nblocks+1] of the places below */
  PetscInt     *unknown; /* [n] those of each block */
  size_t       *offset;  /* [nblocks+1] of its matrix */
  PetscReal    *block;   /* factored, by columns */
  PetscBLASInt *pivot;   /* [n] */
  PetscReal    *work;    /* [n], and [unknowns of the coarse system] */
};

/* A leaf has the tractions of its elements and the displacements of their nodes but the last one */
static void FindBlocks(const FembemSystem *s, const FembemClusters *tree, FembemTwoLevel two)
{
  const PetscInt order = s->b->order;
  PetscInt       n     = 0;

  two->nblocks = 0;
  for (PetscInt id = 0; id < tree->n; ++id) {
    const FembemCluster *cl = &tree->cluster[id];
    PetscInt             m;

    if (cl->left >= 0) continue;
    two->first[two->nblocks] = n;
    for (PetscInt k = s->rows * cl->first; k < s->rows * cl->end; ++k)
      if (s->tindex[k] >= 0) two->unknown[n++] = s->tindex[k];
    for (PetscInt k = 2 * order * cl->first; k < 2 * order * cl->end; ++k)
      if (s->uindex[k] >= 0) two->unknown[n++] = s->nt + s->uindex[k];
    m                             = n - two->first[two->nblocks];
    two->offset[two->nblocks + 1] = two->offset[two->nblocks] + (size_t)m * m;
    two->first[++two->nblocks]    = n;
  }
}

static PetscErrorCode FactorBlocks(const FembemSystem *s, FembemTwoLevel two)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < two->nblocks; ++i) {
    PetscBLASInt m = two->first[i + 1] - two->first[i], lda = PetscMax(m, 1), info;

    PetscCallBLAS("LAPACKgetrf", LAPACKgetrf_(&m, &m, two->block + two->offset[i], &lda, two->pivot + two->first[i], &info));
    PetscCheck(!info, s->b->comm, PETSC_ERR_LIB, "A block of neighbouring boundary elements is singular: getrf gives %d", (int)info);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* near: this rank's part of the operator within the leaves, and more */
PetscErrorCode FembemTwoLevelCreate(const FembemSystem *s, const FembemClusters *tree, Mat near, FembemTwoLevel *newtwo)
{
  FembemTwoLevel two;

  PetscFunctionBegin;
  PetscCall(PetscNew(&two));
  two->n = s->nt + s->nu;
  PetscCall(FembemCoarseCreate(s, &two->coarse));
  PetscCall(PetscCalloc5(tree->n + 1, &two->first, two->n, &two->unknown, tree->n + 1, &two->offset, two->n, &two->pivot,
                         two->n + two->coarse.s.nt + two->coarse.s.nu, &two->work));
  FindBlocks(s, tree, two);
  PetscCall(PetscCalloc1(two->offset[two->nblocks], &two->block));
  for (PetscInt i = 0; i < two->nblocks; ++i) { /* by rows, but symmetric */
    const PetscInt m = two->first[i + 1] - two->first[i], *unknown = two->unknown + two->first[i];

    PetscCall(MatGetValues(near, m, unknown, m, unknown, two->block + two->offset[i]));
  }
  PetscCall(FembemDenseSum(s->b->comm, two->offset[two->nblocks], two->block));
  PetscCall(FactorBlocks(s, two));
  *newtwo = two;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FembemTwoLevelApply(FembemTwoLevel two, const PetscReal r[], PetscReal z[])
{
  const FembemCoarse *c    = &two->coarse;
  PetscReal          *work = two->work, *coarse = two->work + two->n;
  PetscBLASInt        one = 1, info;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(coarse, c->s.nt + c->s.nu));
  for (PetscInt end = 0; end < 2; ++end)
    for (PetscInt k = 0; k < two->n; ++k)
      if (c->from[end][k] >= 0) coarse[c->from[end][k]] += c->weight[end][k] * r[k];
  PetscCall(FembemSystemSolve(&c->s, coarse, coarse + c->s.nt));
  for (PetscInt i = 0; i < two->nblocks; ++i) {
    const PetscInt first = two->first[i];
    PetscBLASInt   m = two->first[i + 1] - first, lda = PetscMax(m, 1);

    for (PetscInt k = first; k < first + m; ++k) work[k] = r[two->unknown[k]];
    PetscCallBLAS("LAPACKgetrs",
                  LAPACKgetrs_("N", &m, &one, two->block + two->offset[i], &lda, two->pivot + first, work + first, &lda, &info));
    for (PetscInt k = first; k < first + m; ++k) z[two->unknown[k]] = work[k];
  }
  for (PetscInt end = 0; end < 2; ++end)
    for (PetscInt k = 0; k < two->n; ++k)
      if (c->from[end][k] >= 0) z[k] += c->weight[end][k] * coarse[c->from[end][k]];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Held for blocks and for the coarse system */
size_t FembemTwoLevelNumbers(FembemTwoLevel two)
{
  const size_t nt = two->coarse.s.nt, nu = two->coarse.s.nu;

  return two->offset[two->nblocks] + nt * (nt + nu) + nu * nu;
}

PetscErrorCode FembemTwoLevelDestroy(FembemTwoLevel *two)
{
  PetscFunctionBegin;
  if (!*two) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FembemCoarseDestroy(&(*two)->coarse));
  PetscCall(PetscFree5((*two)->first, (*two)->unknown, (*two)->offset, (*two)->pivot, (*two)->work));
  PetscCall(PetscFree((*two)->block));
  PetscCall(PetscFree(*two));
  PetscFunctionReturn(PETSC_SUCCESS);
}
