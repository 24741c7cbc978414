#include <abut/private/loopimpl.h>
#include <petscblaslapack.h>

/* The modes of contact sides, by which layers.c knows bodies. One rank finds all those of a side: found by several, those whose eigenvalues
   lie close together would not be orthogonal, as there are on sides refined alike at both ends. Then each rank gets a block of them, and
   the blocks go round. */

/* Eigenvectors by columns V of a symmetric tridiagonal matrix, diagonal d and beside it e. LAPACK's fast way (n^2 operations) now and
   then gives up on strongly graded sides; then its slow one (n^3) is taken. */
static PetscErrorCode AbutModesTridiagonal_Private(PetscInt n, PetscReal d[], PetscReal e[], PetscReal xi[], PetscReal V[])
{
  PetscBLASInt bn, found, one = 1, info, lwork, liwork, *iwork, *support;
  PetscReal    zero = 0., *work, *value, *d2, *e2;

  PetscFunctionBegin;
  PetscCall(PetscBLASIntCast(n, &bn));
  PetscCall(PetscBLASIntCast(18 * n, &lwork));
  PetscCall(PetscBLASIntCast(10 * n, &liwork));
  PetscCall(PetscMalloc6(lwork, &work, liwork, &iwork, 2 * n, &support, n, &value, n, &d2, n, &e2));
  PetscCall(PetscArraycpy(d2, d, n));
  PetscCall(PetscArraycpy(e2, e, n));
  PetscCallBLAS("LAPACKstegr", LAPACKstegr_("V", "A", &bn, d, e, &zero, &zero, &one, &one, &zero, &found, value, V, &bn, support, work,
                                            &lwork, iwork, &liwork, &info));
  if (info || found != bn) {
    PetscCallBLAS("LAPACKsteqr", LAPACKsteqr_("I", &bn, d2, e2, V, &bn, work, &info));
    PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK steqr failed with info %d", (int)info);
    PetscCall(PetscArraycpy(value, d2, n));
  }
  for (PetscInt k = 0; k < n; ++k) xi[k] = PetscSqrtReal(PetscMax(0., value[k]));
  PetscCall(PetscFree6(work, iwork, support, value, d2, e2));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal AbutSideElement_Private(const AbutSide *s, PetscInt i)
{
  return PetscSqrtReal(PetscSqr(s->x[2 * i + 2] - s->x[2 * i]) + PetscSqr(s->x[2 * i + 3] - s->x[2 * i + 1]));
}

/* A side, and its number of modes: nodes whose normal displacement is not prescribed */
static PetscErrorCode AbutModesGetSide_Private(AbutInterface f, PetscInt t, const AbutSide **side, PetscInt *all)
{
  AbutBody bodies[2];
  PetscInt sides[2];

  PetscFunctionBegin;
  PetscCall(AbutPairGetBodies(f->pair[t / 2], bodies, sides));
  PetscCall(AbutBodyGetSide(bodies[t % 2], sides[t % 2], side));
  *all = 0;
  for (PetscInt i = 0; i < (*side)->n; ++i)
    if (!(*side)->fixed[i]) ++*all;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All modes of a side, by columns V at the nodes that may move; positive at the lower end, so that those of opposite sides match */
static PetscErrorCode AbutModesOfSide_Private(const AbutSide *s, PetscReal xi[], PetscReal V[])
{
  const PetscInt  end = 2 * (s->n - 1), axis = PetscAbsReal(s->x[end + 1] - s->x[1]) > PetscAbsReal(s->x[end] - s->x[0]) ? 1 : 0;
  const PetscBool rise = (PetscBool)(s->x[axis] < s->x[end + axis]);
  PetscReal      *D, *d, *e;
  PetscInt        first, n = 0;

  PetscFunctionBegin;
  PetscCall(PetscCalloc3(s->n, &D, s->n, &d, s->n, &e));
  for (PetscInt i = 0; i < s->n; ++i) {
    if (i + 1 < s->n) {
      D[i] += 0.5 * AbutSideElement_Private(s, i);
      D[i + 1] += 0.5 * AbutSideElement_Private(s, i);
    }
    if (!s->fixed[i]) ++n;
  }
  for (PetscInt i = 0; i + 1 < s->n; ++i) {
    const PetscReal k = 1. / AbutSideElement_Private(s, i);

    d[i] += k / D[i];
    d[i + 1] += k / D[i + 1];
    e[i] = -k / PetscSqrtReal(D[i] * D[i + 1]);
  }
  for (first = 0; first < s->n && s->fixed[first];) ++first; /* fixed are the ends of a side, or all of it: what is left is one run */
  if (n) PetscCall(AbutModesTridiagonal_Private(n, d + first, e + first, xi, V));
  for (PetscInt k = 0; k < n; ++k) {
    const PetscReal sign = V[k * n + (rise ? 0 : n - 1)] < 0. ? -1. : 1.;

    for (PetscInt i = 0; i < n; ++i) V[k * n + i] *= sign / PetscSqrtReal(D[first + i]);
  }
  PetscCall(PetscFree3(D, d, e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The block of a rank: modes from..to-1 of all */
static void AbutModesBlock_Private(PetscInt all, PetscInt most, PetscMPIInt rank, PetscMPIInt size, PetscInt *from, PetscInt *to)
{
  *from = PetscMin(all, (PetscInt)((PetscInt64)most * rank / size));
  *to   = PetscMin(all, (PetscInt)((PetscInt64)most * (rank + 1) / size));
}

/* Room for the block of a rank on one side, of which all else is known; most: the largest number of modes of a side */
static PetscErrorCode AbutModesAllocate_Private(PetscInt most, PetscMPIInt rank, PetscMPIInt size, AbutModes *m)
{
  PetscInt from, to;

  PetscFunctionBegin;
  AbutModesBlock_Private(m->all, most, rank, size, &from, &to);
  m->n = to - from;
  PetscCall(PetscMalloc1((size_t)(m->rows + 1) * m->n, &m->xi));
  m->W = m->xi + m->n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* From the rank that found them each one gets its block of the modes of a side: xi, and V by columns into own */
static PetscErrorCode AbutModesDeal_Private(MPI_Comm comm, PetscMPIInt owner, PetscInt most, const PetscReal xi[], const PetscReal V[],
                                            AbutModes *m, PetscReal own[])
{
  PetscMPIInt  size, *counts, *first;
  MPI_Datatype column;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMalloc2(size, &counts, size, &first));
  for (PetscMPIInt r = 0; r < size; ++r) {
    PetscInt from, to;

    AbutModesBlock_Private(m->all, most, r, size, &from, &to);
    first[r]  = (PetscMPIInt)from;
    counts[r] = (PetscMPIInt)(to - from);
  }
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)m->all, MPIU_REAL, &column));
  PetscCallMPI(MPI_Type_commit(&column));
  PetscCallMPI(MPI_Scatterv(xi, counts, first, MPIU_REAL, m->xi, (PetscMPIInt)m->n, MPIU_REAL, owner, comm));
  PetscCallMPI(MPI_Scatterv(V, counts, first, column, own, (PetscMPIInt)m->n, column, owner, comm));
  PetscCallMPI(MPI_Type_free(&column));
  PetscCall(PetscFree2(counts, first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The values of the block of this rank: modes as penetrations of their pair's contact nodes */
static PetscErrorCode AbutModesFill_Private(AbutInterface f, AbutContactModel model, PetscInt t, const AbutSide *side, const PetscReal V[],
                                            AbutModes *m)
{
  const PetscInt   pair = t / 2;
  PetscInt         which, n;
  const PetscReal *x, *D;
  PetscReal       *shape, *trace, *g;

  PetscFunctionBegin;
  PetscCall(AbutPairGetPressureNodes(f->pair[pair], &which, &n, &x, &D));
  PetscCall(PetscCalloc3(side->n, &shape, f->offset[2 * pair + 2] - f->offset[2 * pair], &trace, n, &g));
  for (PetscInt k = 0; k < m->n; ++k) {
    for (PetscInt i = 0, free = 0; i < side->n; ++i) shape[i] = side->fixed[i] ? 0. : V[k * m->all + free++];
    PetscCall(AbutPairSetNormalTrace(f->pair[pair], t % 2, shape, trace + f->offset[t] - f->offset[2 * pair]));
    PetscCall(AbutPairComputePenetration(f->pair[pair], trace, trace + f->offset[2 * pair + 1] - f->offset[2 * pair], g));
    for (PetscInt c = 0; c < m->rows; ++c) m->W[k * m->rows + c] = g[model->node[m->first + c]] - model->open[m->first + c];
  }
  PetscCall(PetscFree3(shape, trace, g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The largest number of modes of a side */
PetscErrorCode AbutModesCount_Private(AbutInterface f, PetscInt *most)
{
  PetscFunctionBegin;
  *most = 0;
  for (PetscInt t = 0; t < 2 * f->npairs; ++t) {
    const AbutSide *side;
    PetscInt        all;

    if (f->bodyof[t] < 0) continue;
    PetscCall(AbutModesGetSide_Private(f, t, &side, &all));
    *most = PetscMax(*most, all);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The blocks of side t, whose modes the owner finds; xi and V are its room for them */
static PetscErrorCode AbutModesOfTrace_Private(AbutInterface f, AbutContactModel model, PetscInt t, PetscInt most, PetscMPIInt owner,
                                               const PetscReal xi[], const PetscReal V[], AbutModes *m)
{
  MPI_Comm        comm = PetscObjectComm((PetscObject)f);
  const AbutSide *side;
  PetscMPIInt     rank, size;
  PetscReal      *own;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(AbutModesGetSide_Private(f, t, &side, &m->all));
  m->first  = model->first[t / 2];
  m->rows   = model->normals[t / 2];
  m->length = 0.;
  for (PetscInt i = 0; i + 1 < side->n; ++i) m->length += AbutSideElement_Private(side, i);
  PetscCall(AbutModesAllocate_Private(most, rank, size, m));
  PetscCall(PetscMalloc1((size_t)m->all * m->n, &own));
  PetscCall(AbutModesDeal_Private(comm, owner, most, xi, V, m, own));
  PetscCall(AbutModesFill_Private(f, model, t, side, own, m));
  PetscCall(PetscFree(own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* This rank's blocks of the modes of all sides that are no rigid obstacles, m [2*npairs]. As many sides at once as there are ranks: each
   rank finds the modes of one of them. */
PetscErrorCode AbutModesCreate_Private(AbutInterface f, AbutContactModel model, AbutModes m[])
{
  PetscMPIInt rank, size;
  PetscInt    most;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(PetscObjectComm((PetscObject)f), &rank));
  PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)f), &size));
  PetscCall(AbutModesCount_Private(f, &most));
  for (PetscInt begin = 0; begin < 2 * f->npairs; begin += size) {
    const PetscInt end = PetscMin(2 * f->npairs, begin + size), mine = begin + rank;
    PetscReal     *xi = NULL, *V = NULL;

    if (mine < end && f->bodyof[mine] >= 0) {
      const AbutSide *side;
      PetscInt        all;

      PetscCall(AbutModesGetSide_Private(f, mine, &side, &all));
      PetscCall(PetscMalloc2(all, &xi, (size_t)all * all, &V));
      PetscCall(AbutModesOfSide_Private(side, xi, V));
    }
    for (PetscInt t = begin; t < end; ++t)
      if (f->bodyof[t] >= 0) PetscCall(AbutModesOfTrace_Private(f, model, t, most, (PetscMPIInt)(t - begin), xi, V, &m[t]));
    PetscCall(PetscFree2(xi, V));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The blocks here, which a rank before this one made some steps ago, go to the next rank, and those of the rank before take their place */
PetscErrorCode AbutModesPass_Private(AbutInterface f, PetscMPIInt step, AbutModes m[])
{
  MPI_Comm    comm = PetscObjectComm((PetscObject)f);
  PetscMPIInt rank, size, next, before, tag;
  PetscInt    most = 0;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscObjectGetNewTag((PetscObject)f, &tag));
  next   = (rank + 1) % size;
  before = (rank + size - 1) % size;
  for (PetscInt t = 0; t < 2 * f->npairs; ++t) most = PetscMax(most, m[t].all);
  for (PetscInt t = 0; t < 2 * f->npairs; ++t) {
    AbutModes there = m[t];

    if (f->bodyof[t] < 0) continue;
    PetscCall(AbutModesAllocate_Private(most, (before + size - step) % size, size, &there));
    PetscCallMPI(MPI_Sendrecv(m[t].xi, (PetscMPIInt)((m[t].rows + 1) * m[t].n), MPIU_REAL, next, tag, there.xi,
                              (PetscMPIInt)((there.rows + 1) * there.n), MPIU_REAL, before, tag, comm, MPI_STATUS_IGNORE));
    PetscCall(PetscFree(m[t].xi));
    m[t] = there;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutModesDestroy_Private(AbutInterface f, AbutModes m[])
{
  PetscFunctionBegin;
  for (PetscInt t = 0; t < 2 * f->npairs; ++t) PetscCall(PetscFree(m[t].xi));
  PetscFunctionReturn(PETSC_SUCCESS);
}
