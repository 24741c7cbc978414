#include <abut/private/loopimpl.h>
#include <petscblaslapack.h>

/* The compliance of the bodies as if each were an elastic layer between its contact side and the side opposite to it: closed forms for a
   pressure cos(xi x). It replaces no solve; it predicts the contact zone and preconditions, and what it misses the sweeps correct. */

/* The modes of side t = 2*pair+side: K v = xi^2 D v on its nodes, with the one-dimensional stiffness K, natural ends, lumped lengths D
   and V'DV = I */
typedef struct {
  PetscInt   n;     /* modes: nodes of the side whose normal displacement is not prescribed */
  PetscInt   first; /* first contact node of the pair, and how many */
  PetscInt   rows;
  PetscReal *xi; /* [n] ascending */
  PetscReal *W;  /* [rows*n] by columns: penetrations of the pair's contact nodes when the side takes the shape of a mode */
  PetscReal  length;
} AbutModes;

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

/* Modes at the nodes of a side that may move, 0 at the others; positive at the lower end, so that those of opposite sides match */
static PetscErrorCode AbutModesOfSide_Private(const AbutSide *s, AbutModes *m, PetscReal *shape[])
{
  const PetscInt  end = 2 * (s->n - 1), axis = PetscAbsReal(s->x[end + 1] - s->x[1]) > PetscAbsReal(s->x[end] - s->x[0]) ? 1 : 0;
  const PetscBool rise = (PetscBool)(s->x[axis] < s->x[end + axis]);
  PetscReal      *D, *d, *e, *V;
  PetscInt       *node;

  PetscFunctionBegin;
  m->n      = 0;
  m->length = 0.;
  PetscCall(PetscCalloc4(s->n, &D, s->n, &d, s->n, &e, s->n, &node));
  for (PetscInt i = 0; i < s->n; ++i) {
    if (i + 1 < s->n) {
      D[i] += 0.5 * AbutSideElement_Private(s, i);
      D[i + 1] += 0.5 * AbutSideElement_Private(s, i);
      m->length += AbutSideElement_Private(s, i);
    }
    if (!s->fixed[i]) node[m->n++] = i;
  }
  for (PetscInt i = 0; i + 1 < s->n; ++i) {
    const PetscReal k = 1. / AbutSideElement_Private(s, i);

    d[i] += k / D[i];
    d[i + 1] += k / D[i + 1];
    e[i] = -k / PetscSqrtReal(D[i] * D[i + 1]);
  }
  /* prescribed nodes are the ends of a side, or all of it: what is left is one run */
  PetscCall(PetscMalloc1(m->n, &m->xi));
  PetscCall(PetscMalloc1(m->n * m->n, &V));
  PetscCall(PetscCalloc1(m->n * s->n, shape));
  if (m->n) PetscCall(AbutModesTridiagonal_Private(m->n, d + node[0], e + node[0], m->xi, V));
  for (PetscInt k = 0; k < m->n; ++k) {
    const PetscReal sign = V[k * m->n + (rise ? 0 : m->n - 1)] < 0. ? -1. : 1.;

    for (PetscInt i = 0; i < m->n; ++i) (*shape)[k * s->n + node[i]] = sign * V[k * m->n + i] / PetscSqrtReal(D[node[i]]);
  }
  PetscCall(PetscFree(V));
  PetscCall(PetscFree4(D, d, e, node));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The modes of side t, as penetrations of its pair's contact nodes */
static PetscErrorCode AbutModesCreate_Private(AbutInterface f, AbutContactModel model, PetscInt t, AbutModes *m)
{
  const PetscInt   pair = t / 2, first = model->first[pair];
  AbutBody         bodies[2];
  PetscInt         sides[2], which, n;
  const AbutSide  *side;
  const PetscReal *x, *D;
  PetscReal       *shape, *trace, *g;

  PetscFunctionBegin;
  PetscCall(AbutPairGetBodies(f->pair[pair], bodies, sides));
  PetscCall(AbutBodyGetSide(bodies[t % 2], sides[t % 2], &side));
  PetscCall(AbutModesOfSide_Private(side, m, &shape));
  m->first = first;
  m->rows  = model->normals[pair];
  PetscCall(AbutPairGetPressureNodes(f->pair[pair], &which, &n, &x, &D));
  PetscCall(PetscMalloc1(m->rows * m->n, &m->W));
  PetscCall(PetscCalloc2(f->offset[2 * pair + 2] - f->offset[2 * pair], &trace, n, &g));
  for (PetscInt k = 0; k < m->n; ++k) {
    PetscCall(AbutPairSetNormalTrace(f->pair[pair], t % 2, shape + k * side->n, trace + f->offset[t] - f->offset[2 * pair]));
    PetscCall(AbutPairComputePenetration(f->pair[pair], trace, trace + f->offset[2 * pair + 1] - f->offset[2 * pair], g));
    for (PetscInt c = 0; c < m->rows; ++c) m->W[k * m->rows + c] = g[model->node[first + c]] - model->open[first + c];
  }
  PetscCall(PetscFree2(trace, g));
  PetscCall(PetscFree(shape));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutModesDestroy_Private(AbutModes *m)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(m->xi));
  PetscCall(PetscFree(m->W));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How far each face of a layer of half height h gives way, smooth faces, equal pressures cos(xi x) on both: k/xi 2 sinh^2 s/(sinh 2s +
   2s), s = xi h. By symmetry also a layer of height h on a smooth rigid base. k = 2(1-nu^2)/E; xi -> 0: k h/2; xi -> infinity: k/xi, the
   half plane. */
static PetscReal AbutLayerSqueeze_Private(PetscReal k, PetscReal xi, PetscReal h)
{
  const PetscReal s = xi * h;

  if (s < 1e-4) return 0.5 * k * h;
  if (s > 20.) return k / xi;
  return k / xi * 2. * PetscSqr(PetscSinhReal(s)) / (PetscSinhReal(2. * s) + 2. * s);
}

/* The same for opposite pressures: the layer bends, k/xi 2 cosh^2 s/(sinh 2s - 2s) */
static PetscReal AbutLayerBend_Private(PetscReal k, PetscReal xi, PetscReal h)
{
  const PetscReal s = xi * h;

  if (s < 1e-2) return 1.5 * k / (xi * s * s * s);
  if (s > 20.) return k / xi;
  return k / xi * 2. * PetscSqr(PetscCoshReal(s)) / (PetscSinhReal(2. * s) - 2. * s);
}

/* The ranks share the columns of S: those of one of them */
static void AbutLayerColumns_Private(const AbutContactModel model, PetscMPIInt rank, PetscMPIInt size, PetscInt *from, PetscInt *to)
{
  *from = (PetscInt)((PetscInt64)model->n * rank / size);
  *to   = (PetscInt)((PetscInt64)model->n * (rank + 1) / size);
}

/* S += W_a diag(w) W_b' in the block of their pairs and the columns of this rank, for the first modes of both sides */
static PetscErrorCode AbutLayerAdd_Private(AbutInterface f, AbutContactModel model, const AbutModes *a, const AbutModes *b,
                                           const PetscReal w[])
{
  const PetscInt modes = PetscMin(a->n, b->n);
  PetscInt       from, to;
  PetscMPIInt    rank, size;
  PetscBLASInt   na, nb, nk, ld, ldb;
  PetscReal      one = 1., *scaled;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(PetscObjectComm((PetscObject)f), &rank));
  PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)f), &size));
  AbutLayerColumns_Private(model, rank, size, &from, &to);
  from = PetscMax(from, b->first);
  to   = PetscMin(to, b->first + b->rows);
  if (!modes || !a->rows || from >= to) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(a->rows * modes, &scaled));
  for (PetscInt k = 0; k < modes; ++k)
    for (PetscInt i = 0; i < a->rows; ++i) scaled[k * a->rows + i] = a->W[k * a->rows + i] * w[k];
  PetscCall(PetscBLASIntCast(a->rows, &na));
  PetscCall(PetscBLASIntCast(to - from, &nb));
  PetscCall(PetscBLASIntCast(b->rows, &ldb));
  PetscCall(PetscBLASIntCast(modes, &nk));
  PetscCall(PetscBLASIntCast(model->n, &ld));
  PetscCallBLAS("BLASgemm", BLASgemm_("N", "T", &na, &nb, &nk, &one, scaled, &na, b->W + from - b->first, &ldb, &one,
                                      model->S + from * model->n + a->first, &ld));
  PetscCall(PetscFree(scaled));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How the contact on side t gives way under the contact on side r of the same body: itself or another one on the same side, or one on
   the opposite side. A layer that is held on its far side only gets thinner; one that is not also bends, and its faces act on each
   other, mode by mode. */
static PetscErrorCode AbutLayerSides_Private(AbutInterface f, AbutContactModel model, PetscInt t, PetscInt r, const AbutModes m[])
{
  AbutConditionType condition;
  AbutBody          bodies[2], others[2];
  AbutMesh          mesh;
  PetscInt          sides[2], othersides[2], far;
  PetscReal         normal[2], young, poisson, height, *w;

  PetscFunctionBegin;
  PetscCall(AbutPairGetBodies(f->pair[t / 2], bodies, sides));
  PetscCall(AbutPairGetBodies(f->pair[r / 2], others, othersides));
  PetscCall(AbutBodyGetMesh(bodies[t % 2], &mesh));
  PetscCall(AbutMeshGetSideDirection(mesh, sides[t % 2], normal));
  PetscCall(AbutBodyGetFarSide(bodies[t % 2], normal, &far, &condition));
  if (othersides[r % 2] != sides[t % 2] && othersides[r % 2] != far) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutBodyGetHeight(bodies[t % 2], normal, &height));
  PetscCall(AbutBodyGetPlaneMaterial(bodies[t % 2], &young, &poisson));
  PetscCall(PetscMalloc1(m[t].n, &w));
  for (PetscInt k = 0; k < m[t].n; ++k) {
    const PetscReal compliance = 2. * (1. - poisson * poisson) / young, longest = 0.5 * PETSC_PI / m[t].length;
    const PetscReal xi      = k < m[r].n ? 0.5 * (m[t].xi[k] + m[r].xi[k]) : m[t].xi[k];
    const PetscReal squeeze = AbutLayerSqueeze_Private(compliance, xi, 0.5 * height);
    const PetscReal bend    = AbutLayerBend_Private(compliance, PetscMax(xi, longest), 0.5 * height); /* moving resists nothing */

    if (condition == ABUT_DISPLACEMENT) w[k] = AbutLayerSqueeze_Private(compliance, xi, height);
    else w[k] = 0.5 * (othersides[r % 2] == far ? squeeze - bend : squeeze + bend);
  }
  PetscCall(AbutLayerAdd_Private(f, model, &m[t], &m[r], w));
  PetscCall(PetscFree(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The same along side t for tangential tractions t cos(xi x): k/xi tanh, which is H 2(1+nu)/E for long waves, where the far side is held
   along it, and k/xi coth, a rod, where it is not; the half plane for short ones. On straight sides slips have the modes that penetrations
   have. Nothing of how tractions and pressures act on each other: that the sweeps teach. */
static PetscErrorCode AbutLayerShear_Private(AbutInterface f, AbutContactModel model, PetscInt t, const AbutModes *side)
{
  AbutConditionType condition;
  AbutBody          bodies[2];
  AbutMesh          mesh;
  AbutModes         m = *side;
  PetscInt          sides[2], far;
  PetscReal         normal[2], tangent[2], young, poisson, height, *w;

  PetscFunctionBegin;
  PetscCall(AbutPairGetBodies(f->pair[t / 2], bodies, sides));
  PetscCall(AbutBodyGetMesh(bodies[t % 2], &mesh));
  PetscCall(AbutMeshGetSideDirection(mesh, sides[t % 2], normal));
  tangent[0] = -normal[1];
  tangent[1] = normal[0];
  PetscCall(AbutBodyGetFarSide(bodies[t % 2], normal, &far, &condition));
  if (far >= 0) PetscCall(AbutBodyGetCondition(bodies[t % 2], far, !(far / 2), &condition));
  else PetscCall(AbutBodyGetFarSide(bodies[t % 2], tangent, &far, &condition)); /* any side of a mesh from a file */
  PetscCall(AbutBodyGetHeight(bodies[t % 2], normal, &height));
  PetscCall(AbutBodyGetPlaneMaterial(bodies[t % 2], &young, &poisson));
  PetscCall(PetscMalloc1(m.n, &w));
  for (PetscInt k = 0; k < m.n; ++k) {
    const PetscReal compliance = 2. * (1. - poisson * poisson) / young, xi = PetscMax(m.xi[k], 0.5 * PETSC_PI / m.length);

    if (condition == ABUT_DISPLACEMENT) w[k] = compliance / xi * PetscTanhReal(xi * height / (1. - poisson));
    else w[k] = compliance / xi / PetscTanhReal(2. * xi * height);
  }
  m.first += m.rows;
  PetscCall(AbutLayerAdd_Private(f, model, &m, &m, w));
  PetscCall(PetscFree(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All columns of S to all ranks */
static PetscErrorCode AbutLayersGather_Private(AbutInterface f, AbutContactModel model)
{
  MPI_Comm     comm = PetscObjectComm((PetscObject)f);
  PetscMPIInt  size, *counts, *first;
  MPI_Datatype column;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  if (size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(size, &counts, size, &first));
  for (PetscMPIInt r = 0; r < size; ++r) {
    PetscInt from, to;

    AbutLayerColumns_Private(model, r, size, &from, &to);
    first[r]  = (PetscMPIInt)from;
    counts[r] = (PetscMPIInt)(to - from);
  }
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)model->n, MPIU_REAL, &column));
  PetscCallMPI(MPI_Type_commit(&column));
  PetscCallMPI(MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, model->S, counts, first, column, comm));
  PetscCallMPI(MPI_Type_free(&column));
  PetscCall(PetscFree2(counts, first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fills S, zero before, with the layers' compliance; some n^3 operations, which the ranks share */
PetscErrorCode AbutInterfaceLayers_Private(AbutInterface f, AbutContactModel model)
{
  AbutModes *m;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(2 * f->npairs, &m));
  for (PetscInt t = 0; t < 2 * f->npairs; ++t)
    if (f->bodyof[t] >= 0) PetscCall(AbutModesCreate_Private(f, model, t, &m[t]));
  for (PetscInt t = 0; t < 2 * f->npairs; ++t)
    for (PetscInt r = 0; r < 2 * f->npairs; ++r)
      if (f->bodyof[t] >= 0 && f->bodyof[t] == f->bodyof[r]) PetscCall(AbutLayerSides_Private(f, model, t, r, m));
  for (PetscInt t = 0; t < 2 * f->npairs; ++t)
    if (f->bodyof[t] >= 0 && model->first[t / 2 + 1] - model->first[t / 2] > model->normals[t / 2])
      PetscCall(AbutLayerShear_Private(f, model, t, &m[t]));
  PetscCall(AbutLayersGather_Private(f, model));
  for (PetscInt t = 0; t < 2 * f->npairs; ++t) PetscCall(AbutModesDestroy_Private(&m[t]));
  PetscCall(PetscFree(m));
  PetscFunctionReturn(PETSC_SUCCESS);
}
