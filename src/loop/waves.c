#include <abut/private/loopimpl.h>
#include <petscblaslapack.h>

/* The modes of contact sides, by which layers.c knows bodies: each rank finds a block of them, and the blocks go round */

/* Eigenvectors from..to-1 by columns V of a symmetric tridiagonal matrix, diagonal d and beside it e. LAPACK's fast way (n operations a
   number) now and then gives up on strongly graded sides; then its slow one is taken, which finds them all by n^3. */
static PetscErrorCode AbutModesTridiagonal_Private(PetscInt n, PetscInt from, PetscInt to, PetscReal d[], PetscReal e[], PetscReal xi[],
                                                   PetscReal V[])
{
  const PetscInt count = to - from;
  PetscBLASInt   bn, first, last, found, info, lwork, liwork, *iwork, *support;
  PetscReal      zero = 0., *work, *value, *d2, *e2;

  PetscFunctionBegin;
  PetscCall(PetscBLASIntCast(n, &bn));
  PetscCall(PetscBLASIntCast(from + 1, &first));
  PetscCall(PetscBLASIntCast(to, &last));
  PetscCall(PetscBLASIntCast(18 * n, &lwork));
  PetscCall(PetscBLASIntCast(10 * n, &liwork));
  PetscCall(PetscMalloc6(lwork, &work, liwork, &iwork, 2 * n, &support, n, &value, n, &d2, n, &e2));
  PetscCall(PetscArraycpy(d2, d, n));
  PetscCall(PetscArraycpy(e2, e, n));
  PetscCallBLAS("LAPACKstegr", LAPACKstegr_("V", count == n ? "A" : "I", &bn, d, e, &zero, &zero, &first, &last, &zero, &found, value, V,
                                            &bn, support, work, &lwork, iwork, &liwork, &info));
  if (info || found != count) {
    PetscReal *every;

    PetscCall(PetscMalloc1((size_t)n * n, &every));
    PetscCallBLAS("LAPACKsteqr", LAPACKsteqr_("I", &bn, d2, e2, every, &bn, work, &info));
    PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK steqr failed with info %d", (int)info);
    PetscCall(PetscArraycpy(value, d2 + from, count));
    PetscCall(PetscArraycpy(V, every + (size_t)n * from, n * count));
    PetscCall(PetscFree(every));
  }
  for (PetscInt k = 0; k < count; ++k) xi[k] = PetscSqrtReal(PetscMax(0., value[k]));
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

/* The modes from, from+1, ... of a block at the nodes of a side that may move, 0 at the others; positive at the lower end, so that those of
   opposite sides match */
static PetscErrorCode AbutModesOfSide_Private(const AbutSide *s, PetscInt from, AbutModes *m, PetscReal *shape[])
{
  const PetscInt  end = 2 * (s->n - 1), axis = PetscAbsReal(s->x[end + 1] - s->x[1]) > PetscAbsReal(s->x[end] - s->x[0]) ? 1 : 0;
  const PetscBool rise = (PetscBool)(s->x[axis] < s->x[end + axis]);
  PetscReal      *D, *d, *e, *V;
  PetscInt       *node, all = 0;

  PetscFunctionBegin;
  PetscCall(PetscCalloc4(s->n, &D, s->n, &d, s->n, &e, s->n, &node));
  for (PetscInt i = 0; i < s->n; ++i) {
    if (i + 1 < s->n) {
      D[i] += 0.5 * AbutSideElement_Private(s, i);
      D[i + 1] += 0.5 * AbutSideElement_Private(s, i);
    }
    if (!s->fixed[i]) node[all++] = i;
  }
  for (PetscInt i = 0; i + 1 < s->n; ++i) {
    const PetscReal k = 1. / AbutSideElement_Private(s, i);

    d[i] += k / D[i];
    d[i + 1] += k / D[i + 1];
    e[i] = -k / PetscSqrtReal(D[i] * D[i + 1]);
  }
  /* prescribed nodes are the ends of a side, or all of it: what is left is one run */
  PetscCall(PetscMalloc1((size_t)all * m->n, &V));
  PetscCall(PetscCalloc1((size_t)m->n * s->n, shape));
  if (m->n) PetscCall(AbutModesTridiagonal_Private(all, from, from + m->n, d + node[0], e + node[0], m->xi, V));
  for (PetscInt k = 0; k < m->n; ++k) {
    const PetscReal sign = V[k * all + (rise ? 0 : all - 1)] < 0. ? -1. : 1.;

    for (PetscInt i = 0; i < all; ++i) (*shape)[k * s->n + node[i]] = sign * V[k * all + i] / PetscSqrtReal(D[node[i]]);
  }
  PetscCall(PetscFree(V));
  PetscCall(PetscFree4(D, d, e, node));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A rank's block on side t, without values yet; from: its first mode, most: the largest number of modes of a side */
static PetscErrorCode AbutModesSize_Private(AbutInterface f, AbutContactModel model, PetscInt t, PetscInt most, PetscMPIInt rank,
                                            PetscInt *from, AbutModes *m)
{
  const AbutSide *side;
  PetscMPIInt     size;
  PetscInt        all;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)f), &size));
  PetscCall(AbutModesGetSide_Private(f, t, &side, &all));
  *from     = PetscMin(all, (PetscInt)((PetscInt64)most * rank / size));
  m->n      = PetscMin(all, (PetscInt)((PetscInt64)most * (rank + 1) / size)) - *from;
  m->first  = model->first[t / 2];
  m->rows   = model->normals[t / 2];
  m->length = 0.;
  for (PetscInt i = 0; i + 1 < side->n; ++i) m->length += AbutSideElement_Private(side, i);
  PetscCall(PetscMalloc1((size_t)(m->rows + 1) * m->n, &m->xi));
  m->W = m->xi + m->n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The values of the block of this rank: modes as penetrations of their pair's contact nodes */
static PetscErrorCode AbutModesFill_Private(AbutInterface f, AbutContactModel model, PetscInt t, PetscInt from, AbutModes *m)
{
  const PetscInt   pair = t / 2;
  PetscInt         which, n, all;
  const AbutSide  *side;
  const PetscReal *x, *D;
  PetscReal       *shape, *trace, *g;

  PetscFunctionBegin;
  PetscCall(AbutModesGetSide_Private(f, t, &side, &all));
  PetscCall(AbutModesOfSide_Private(side, from, m, &shape));
  PetscCall(AbutPairGetPressureNodes(f->pair[pair], &which, &n, &x, &D));
  PetscCall(PetscCalloc2(f->offset[2 * pair + 2] - f->offset[2 * pair], &trace, n, &g));
  for (PetscInt k = 0; k < m->n; ++k) {
    PetscCall(AbutPairSetNormalTrace(f->pair[pair], t % 2, shape + k * side->n, trace + f->offset[t] - f->offset[2 * pair]));
    PetscCall(AbutPairComputePenetration(f->pair[pair], trace, trace + f->offset[2 * pair + 1] - f->offset[2 * pair], g));
    for (PetscInt c = 0; c < m->rows; ++c) m->W[k * m->rows + c] = g[model->node[m->first + c]] - model->open[m->first + c];
  }
  PetscCall(PetscFree2(trace, g));
  PetscCall(PetscFree(shape));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The largest number of modes of a side */
static PetscErrorCode AbutModesCount_Private(AbutInterface f, PetscInt *most)
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

/* This rank's blocks of the modes of all sides that are no rigid obstacles, m [2*npairs] */
PetscErrorCode AbutModesCreate_Private(AbutInterface f, AbutContactModel model, AbutModes m[])
{
  PetscMPIInt rank;
  PetscInt    most, from;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(PetscObjectComm((PetscObject)f), &rank));
  PetscCall(AbutModesCount_Private(f, &most));
  for (PetscInt t = 0; t < 2 * f->npairs; ++t) {
    if (f->bodyof[t] < 0) continue;
    PetscCall(AbutModesSize_Private(f, model, t, most, rank, &from, &m[t]));
    PetscCall(AbutModesFill_Private(f, model, t, from, &m[t]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The blocks here, which a rank before this one made some steps ago, go to the next rank, and those of the rank before take their place */
PetscErrorCode AbutModesPass_Private(AbutInterface f, AbutContactModel model, PetscMPIInt step, AbutModes m[])
{
  MPI_Comm    comm = PetscObjectComm((PetscObject)f);
  PetscMPIInt rank, size, next, before, tag;
  PetscInt    most, from;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscObjectGetNewTag((PetscObject)f, &tag));
  PetscCall(AbutModesCount_Private(f, &most));
  next   = (rank + 1) % size;
  before = (rank + size - 1) % size;
  for (PetscInt t = 0; t < 2 * f->npairs; ++t) {
    AbutModes there;

    if (f->bodyof[t] < 0) continue;
    PetscCall(AbutModesSize_Private(f, model, t, most, (before + size - step) % size, &from, &there));
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
