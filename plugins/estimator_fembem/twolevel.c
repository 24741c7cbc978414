#include "twolevel.h"
#include <petscblaslapack.h>

/*
   Two levels, added (B. Smith, P. Bjorstad and W. Gropp, Domain Decomposition, 1996): the operator within each leaf of the tree, whose
   inverse knows what changes from element to element, and the dense system of merged elements, which knows the rest.
*/
struct _n_FembemTwoLevel {
  MPI_Comm      comm;
  PetscMPIInt   rank;
  FembemCoarse  coarse;
  PetscInt      nblocks;
  PetscInt     *first;   /* [nblocks+1] of the places below */
  PetscInt     *unknown; /* [nt+nu] those of each block */
  size_t       *offset;  /* [nblocks+1] of its matrix */
  PetscInt     *begin;   /* [ranks+1] blocks of each rank, */
  PetscInt     *place;   /* [ranks+1] and its places */
  PetscReal    *block;   /* of this rank, factored, by columns */
  PetscBLASInt *pivot;   /* [places of this rank] */
  PetscReal    *work;    /* [unknowns of the coarse system] */
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

/* About equally many places, in whole blocks */
static void DealOut(FembemTwoLevel two, PetscMPIInt size)
{
  const PetscInt n = two->first[two->nblocks];
  PetscInt       i = 0;

  for (PetscMPIInt r = 0; r < size; ++r) {
    two->begin[r] = i;
    while (i < two->nblocks && (PetscInt64)(two->first[i] + two->first[i + 1]) * size < (PetscInt64)2 * n * (r + 1)) ++i;
  }
  two->begin[size] = two->nblocks;
  for (PetscMPIInt r = 0; r <= size; ++r) two->place[r] = two->first[two->begin[r]];
}

/* Sums what the ranks know of the blocks of one of them; by rows, but symmetric */
static PetscErrorCode SumBlocks(FembemTwoLevel two, Mat near, PetscMPIInt r, PetscReal block[])
{
  const size_t offset = two->offset[two->begin[r]];

  PetscFunctionBegin;
  for (PetscInt i = two->begin[r]; i < two->begin[r + 1]; ++i) {
    const PetscInt m = two->first[i + 1] - two->first[i], *unknown = two->unknown + two->first[i];

    PetscCall(MatGetValues(near, m, unknown, m, unknown, block + two->offset[i] - offset));
  }
  PetscCall(FembemDenseSumTo(two->comm, two->offset[two->begin[r + 1]] - offset, r, block));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetBlocks(FembemTwoLevel two, Mat near)
{
  PetscMPIInt size;
  size_t      most = 0;
  PetscReal  *others;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(two->comm, &size));
  for (PetscMPIInt r = 0; r < size; ++r)
    if (r != two->rank) most = PetscMax(most, two->offset[two->begin[r + 1]] - two->offset[two->begin[r]]);
  PetscCall(PetscMalloc1(two->offset[two->begin[two->rank + 1]] - two->offset[two->begin[two->rank]], &two->block));
  PetscCall(PetscMalloc1(most, &others));
  for (PetscMPIInt r = 0; r < size; ++r) PetscCall(SumBlocks(two, near, r, r == two->rank ? two->block : others));
  PetscCall(PetscFree(others));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void HoldMotion(const FembemSystem *s, const FembemMotion *motion, PetscInt n, const PetscInt unknown[], PetscReal block[])
{
  const PetscInt  first = s->nt + motion->first, end = s->nt + motion->end;
  const PetscReal stiffness = FembemMotionStiffness(s, motion);

  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = 0; j < n; ++j)
      if (unknown[i] >= first && unknown[i] < end && unknown[j] >= first && unknown[j] < end)
        block[n * i + j] -= stiffness * motion->r[unknown[i] - first] * motion->r[unknown[j] - first];
}

/* As the operator does, but only where one leaf has all of a contour: its block would be singular. Motions come in the order of leaves */
static void HoldMotions(const FembemSystem *s, FembemTwoLevel two)
{
  const PetscInt begin = two->begin[two->rank];
  PetscInt       next  = 0;

  for (PetscInt i = begin; i < two->begin[two->rank + 1]; ++i) {
    const PetscInt n = two->first[i + 1] - two->first[i], *unknown = two->unknown + two->first[i];
    PetscInt       lo = s->nu, hi = 0; /* of the displacements in it, numbered one after the other */

    for (PetscInt k = 0; k < n; ++k) {
      if (unknown[k] < s->nt) continue;
      lo = PetscMin(lo, unknown[k] - s->nt);
      hi = PetscMax(hi, unknown[k] - s->nt + 1);
    }
    if (!hi) continue;
    while (next < s->nmotions && s->motion[next].first < lo) ++next;
    for (PetscInt m = next; m < s->nmotions && s->motion[m].end <= hi; ++m)
      HoldMotion(s, &s->motion[m], n, unknown, two->block + two->offset[i] - two->offset[begin]);
  }
}

static PetscErrorCode FactorBlocks(FembemTwoLevel two)
{
  const PetscInt begin = two->begin[two->rank];
  PetscMPIInt    worst = 0;

  PetscFunctionBegin;
  for (PetscInt i = begin; i < two->begin[two->rank + 1]; ++i) {
    PetscBLASInt m = two->first[i + 1] - two->first[i], lda = PetscMax(m, 1), info;

    PetscCallBLAS("LAPACKgetrf", LAPACKgetrf_(&m, &m, two->block + two->offset[i] - two->offset[begin], &lda,
                                              two->pivot + two->first[i] - two->first[begin], &info));
    worst = PetscMax(worst, PetscAbsInt(info));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_INT, MPI_MAX, two->comm));
  PetscCheck(!worst, two->comm, PETSC_ERR_LIB, "A block of neighbouring boundary elements is singular: getrf gives %d", worst);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* near: this rank's part of the operator within the leaves, and more */
PetscErrorCode FembemTwoLevelCreate(const FembemSystem *s, const FembemClusters *tree, Mat near, FembemTwoLevel *newtwo)
{
  FembemTwoLevel two;
  PetscMPIInt    size;

  PetscFunctionBegin;
  PetscCall(PetscNew(&two));
  two->comm = s->b->comm;
  PetscCallMPI(MPI_Comm_size(two->comm, &size));
  PetscCallMPI(MPI_Comm_rank(two->comm, &two->rank));
  PetscCall(FembemCoarseCreate(s, &two->coarse));
  PetscCall(PetscCalloc6(tree->n + 1, &two->first, s->nt + s->nu, &two->unknown, tree->n + 1, &two->offset, size + 1, &two->begin, size + 1,
                         &two->place, two->coarse.s.nt + two->coarse.s.nu, &two->work));
  FindBlocks(s, tree, two);
  DealOut(two, size);
  PetscCall(PetscMalloc1(two->place[two->rank + 1] - two->place[two->rank], &two->pivot));
  PetscCall(SetBlocks(two, near));
  HoldMotions(s, two);
  PetscCall(FactorBlocks(two));
  *newtwo = two;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How vectors are laid out: the unknown at each place, and the first place of each rank */
void FembemTwoLevelGetLayout(FembemTwoLevel two, const PetscInt *unknown[], const PetscInt *first[])
{
  if (unknown) *unknown = two->unknown;
  if (first) *first = two->place;
}

/* Collective; r and z are this rank's places */
PetscErrorCode FembemTwoLevelApply(FembemTwoLevel two, const PetscReal r[], PetscReal z[])
{
  const FembemCoarse *c     = &two->coarse;
  const PetscInt      begin = two->begin[two->rank], place = two->place[two->rank], n = two->place[two->rank + 1] - place;
  const PetscInt     *unknown = two->unknown + place;
  PetscBLASInt        one     = 1, info;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(two->work, c->s.nt + c->s.nu));
  if (c->positive) {
    for (PetscInt end = 0; end < 2; ++end)
      for (PetscInt k = 0; k < n; ++k)
        if (c->from[end][unknown[k]] >= 0) two->work[c->from[end][unknown[k]]] += c->weight[end][unknown[k]] * r[k];
    PetscCall(FembemDenseSum(two->comm, c->s.nt + c->s.nu, two->work));
    PetscCall(FembemSystemSolve(&c->s, two->work, two->work + c->s.nt));
  }
  PetscCall(PetscArraycpy(z, r, n));
  for (PetscInt i = begin; i < two->begin[two->rank + 1]; ++i) {
    const PetscInt first = two->first[i] - place;
    PetscBLASInt   m = two->first[i + 1] - two->first[i], lda = PetscMax(m, 1);

    PetscCallBLAS("LAPACKgetrs", LAPACKgetrs_("N", &m, &one, two->block + two->offset[i] - two->offset[begin], &lda, two->pivot + first,
                                              z + first, &lda, &info));
  }
  for (PetscInt end = 0; end < 2; ++end)
    for (PetscInt k = 0; k < n; ++k)
      if (c->from[end][unknown[k]] >= 0) z[k] += c->weight[end][unknown[k]] * two->work[c->from[end][unknown[k]]];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Held for this rank's blocks and for the coarse system */
size_t FembemTwoLevelNumbers(FembemTwoLevel two)
{
  const size_t nt = two->coarse.s.nt, nu = two->coarse.s.nu;

  return two->offset[two->begin[two->rank + 1]] - two->offset[two->begin[two->rank]] + nt * (nt + nu) + nu * nu;
}

PetscErrorCode FembemTwoLevelDestroy(FembemTwoLevel *two)
{
  PetscFunctionBegin;
  if (!*two) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FembemCoarseDestroy(&(*two)->coarse));
  PetscCall(PetscFree6((*two)->first, (*two)->unknown, (*two)->offset, (*two)->begin, (*two)->place, (*two)->work));
  PetscCall(PetscFree((*two)->block));
  PetscCall(PetscFree((*two)->pivot));
  PetscCall(PetscFree(*two));
  PetscFunctionReturn(PETSC_SUCCESS);
}
