#include "fembemimpl.h"
#include <petscblaslapack.h>

/*
   The symmetric Galerkin system (S. Sirtori, Meccanica 14, 1979; G. Maier and C. Polizzotto, Comput. Methods Appl. Mech. Engrg. 60, 1987):
   unknown tractions t where a component of the displacement is given, unknown displacements u elsewhere,
     [ V    W ] [t]   [f]      V = <t, V t> > 0, W = <t, (1/2 - K) u>,
     [ W^T -D ] [u] = [g]      D = <u, D u> >= 0,
   solved by two Cholesky factorisations: V, then D + W^T V^-1 W. Lengths are scaled by twice the size of the body, which keeps V positive
   (logarithmic capacity below 1), stresses by Young's modulus. Rigid motions that no given displacement prevents are set to zero; they
   carry no stress. Limits: dense, so 4000 nodes take about 512 MB and some 10^11 operations.
*/
typedef struct {
  const FembemBoundary *b;
  FembemElement        *e; /* [n] scaled */
  FembemPairing         pairing;
  PetscReal             scale;  /* of lengths */
  PetscInt              rows;   /* 2*(order+1), of an element */
  PetscReal            *t, *u;  /* [rows*n], [2*nnodes] scaled values */
  PetscInt              nt, nu; /* unknowns */
  PetscInt             *tindex; /* [rows*n] number of the unknown, -1 where given */
  PetscInt             *uindex; /* [2*nnodes] */
  PetscBool            *loaded; /* [n] the element has a given traction that is not zero */
  PetscReal            *V, *W, *D, *f, *g;
} System;

/* A component is given at a node if it is on one of its elements */
static void SystemNumber(System *s)
{
  const FembemBoundary    *b    = s->b;
  const AbutConditionType *cond = b->given->condition;

  s->nt = s->nu = 0;
  for (PetscInt i = 0; i < b->n; ++i) {
    s->loaded[i] = PETSC_FALSE;
    for (PetscInt c = 0; c < 2; ++c) {
      const PetscBool given  = (PetscBool)(cond[2 * i + c] == ABUT_DISPLACEMENT);
      const PetscBool before = (PetscBool)(cond[2 * b->previous[i] + c] == ABUT_DISPLACEMENT);

      for (PetscInt k = 0; k < b->order; ++k) s->uindex[2 * (b->order * i + k) + c] = given || (!k && before) ? -1 : s->nu++;
      for (PetscInt k = c; k < s->rows; k += 2) {
        s->tindex[s->rows * i + k] = given ? s->nt++ : -1;
        if (!given && s->t[s->rows * i + k] != 0.) s->loaded[i] = PETSC_TRUE;
      }
    }
  }
}

static PetscReal BodySize(const FembemBoundary *b)
{
  PetscReal lo[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL}, hi[2] = {PETSC_MIN_REAL, PETSC_MIN_REAL};

  for (PetscInt i = 0; i < 2 * b->nnodes; ++i) {
    lo[i % 2] = PetscMin(lo[i % 2], b->given->x[i]);
    hi[i % 2] = PetscMax(hi[i % 2], b->given->x[i]);
  }
  return PetscMax(hi[0] - lo[0], hi[1] - lo[1]);
}

static PetscErrorCode SystemCreate(const FembemBoundary *b, PetscReal scale, System *s)
{
  FembemMaterial mat = b->mat;

  PetscFunctionBegin;
  mat.mu /= b->young;
  s->b     = b;
  s->scale = scale;
  s->rows  = 2 * (b->order + 1);
  PetscCall(FembemPairingSet(&b->basis, mat, &s->pairing));
  PetscCall(PetscMalloc6(b->n, &s->e, s->rows * b->n, &s->t, 2 * b->nnodes, &s->u, s->rows * b->n, &s->tindex, 2 * b->nnodes, &s->uindex,
                         b->n, &s->loaded));
  for (PetscInt i = 0; i < b->n; ++i) FembemElementSet(&s->e[i], FembemStart(b, i) / scale, FembemStart(b, b->next[i]) / scale);
  for (PetscInt i = 0; i < b->nnodes; ++i) {
    s->u[2 * i]     = PetscRealPartComplex(b->u[i]) / scale;
    s->u[2 * i + 1] = PetscImaginaryPartComplex(b->u[i]) / scale;
  }
  for (PetscInt i = 0; i < (b->order + 1) * b->n; ++i) {
    s->t[2 * i]     = PetscRealPartComplex(b->t[i]) / b->young;
    s->t[2 * i + 1] = PetscImaginaryPartComplex(b->t[i]) / b->young;
  }
  SystemNumber(s);
  PetscCall(PetscCalloc5((size_t)s->nt * s->nt, &s->V, (size_t)s->nt * s->nu, &s->W, (size_t)s->nu * s->nu, &s->D, s->nt, &s->f, s->nu,
                         &s->g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SystemDestroy(System *s)
{
  PetscFunctionBegin;
  PetscCall(PetscFree6(s->e, s->t, s->u, s->tindex, s->uindex, s->loaded));
  PetscCall(PetscFree5(s->V, s->W, s->D, s->f, s->g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One block of a symmetric operator: unknown rows and columns into the matrix, unknown rows and given columns to the right-hand side */
static void AddSymmetric(PetscInt rows, PetscInt n, PetscReal A[], PetscReal rhs[], const PetscInt row[], const PetscInt col[],
                         const PetscReal value[], PetscReal sign, const PetscReal block[])
{
  for (PetscInt k = 0; k < rows * rows; ++k) {
    const PetscInt r = row[k / rows], c = col[k % rows];

    if (r >= 0 && c >= 0) A[r + (size_t)n * c] += block[k];
    else if (r >= 0) rhs[r] -= sign * block[k] * value[k % rows];
  }
}

static void Transpose(PetscInt rows, const PetscReal block[], PetscReal transposed[])
{
  for (PetscInt k = 0; k < rows * rows; ++k) transposed[k] = block[rows * (k % rows) + k / rows];
}

/* W has rows of element i (tractions) and columns of element j (displacements); both may be unknown or given */
static void AddW(System *s, const PetscInt t[], const PetscInt u[], const PetscReal tv[], const PetscReal uv[], const PetscReal W[])
{
  for (PetscInt k = 0; k < s->rows * s->rows; ++k) {
    const PetscInt r = t[k / s->rows], c = u[k % s->rows];

    if (r >= 0 && c >= 0) s->W[r + (size_t)s->nt * c] += W[k];
    else if (r >= 0) s->f[r] -= W[k] * uv[k % s->rows];
    else if (c >= 0) s->g[c] -= W[k] * tv[k / s->rows];
  }
}

/* What is needed of element i as row (of V and W) or as row and column (of D) */
typedef struct {
  PetscInt  t[FEMBEM_ROWS_MAX], u[FEMBEM_ROWS_MAX];   /* unknowns, -1 where given */
  PetscReal tv[FEMBEM_ROWS_MAX], uv[FEMBEM_ROWS_MAX]; /* values */
  PetscBool tfree, ufree, loaded;
} Local;

static void GetLocal(const System *s, PetscInt i, Local *l)
{
  l->tfree = l->ufree = PETSC_FALSE;
  l->loaded           = s->loaded[i];
  for (PetscInt k = 0; k < s->rows; ++k) {
    const PetscInt iu = 2 * AbutBoundaryNode(s->b, i, k / 2) + k % 2;

    l->t[k]  = s->tindex[s->rows * i + k];
    l->tv[k] = s->t[s->rows * i + k];
    l->u[k]  = s->uindex[iu];
    l->uv[k] = s->u[iu];
    if (l->t[k] >= 0) l->tfree = PETSC_TRUE;
    if (l->u[k] >= 0) l->ufree = PETSC_TRUE;
  }
}

/* W_ij and, unless only W is asked for, the symmetric V and D with both orders of the pair */
static PetscErrorCode AddPair(System *s, PetscInt i, const Local *li, PetscInt j, const Local *lj, PetscBool onlyW)
{
  const FembemWanted wanted = {.V = !onlyW && ((li->tfree && (lj->tfree || lj->loaded)) || (lj->tfree && li->loaded)) ? PETSC_TRUE
                                                                                                                      : PETSC_FALSE,
                               .W = li->tfree || (li->loaded && lj->ufree) ? PETSC_TRUE : PETSC_FALSE,
                               .D = !onlyW && (li->ufree || lj->ufree) ? PETSC_TRUE : PETSC_FALSE};
  FembemBlocks       block;
  PetscReal          transposed[FEMBEM_ROWS_MAX * FEMBEM_ROWS_MAX];

  PetscFunctionBegin;
  if (!wanted.V && !wanted.W && !wanted.D) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FembemPair(&s->pairing, &s->e[i], &s->e[j], (PetscBool)(i == j), wanted, &block));
  if (wanted.W) AddW(s, li->t, lj->u, li->tv, lj->uv, block.W);
  if (wanted.V) {
    AddSymmetric(s->rows, s->nt, s->V, s->f, li->t, lj->t, lj->tv, 1., block.V);
    Transpose(s->rows, block.V, transposed);
    if (i != j) AddSymmetric(s->rows, s->nt, s->V, s->f, lj->t, li->t, li->tv, 1., transposed);
  }
  if (wanted.D) {
    AddSymmetric(s->rows, s->nu, s->D, s->g, li->u, lj->u, lj->uv, -1., block.D);
    Transpose(s->rows, block.D, transposed);
    if (i != j) AddSymmetric(s->rows, s->nu, s->D, s->g, lj->u, li->u, li->uv, -1., transposed);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All pairs; in a pair the smaller element is the outer one, W needs both orders. The mass matrix <t, u> joins unknown t to given u only */
static PetscErrorCode SystemAssemble(System *s)
{
  Local *local;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(s->b->n, &local));
  for (PetscInt i = 0; i < s->b->n; ++i) {
    Local *l = &local[i];

    GetLocal(s, i, l);
    for (PetscInt k = 0; k < s->rows * s->rows; ++k) {
      const PetscInt row = k / s->rows, col = k % s->rows;

      if (l->t[row] >= 0 && row % 2 == col % 2) s->f[l->t[row]] += 0.5 * s->e[i].h * s->b->basis.mass[row / 2][col / 2] * l->uv[col];
    }
  }
  for (PetscInt i = 0; i < s->b->n; ++i) {
    for (PetscInt j = i; j < s->b->n; ++j) {
      const PetscInt o = s->e[j].h < (1. - FEMBEM_SLACK) * s->e[i].h ? j : i, p = i + j - o;

      PetscCall(AddPair(s, o, &local[o], p, &local[p], PETSC_FALSE));
      if (i != j) PetscCall(AddPair(s, p, &local[p], o, &local[o], PETSC_TRUE));
    }
  }
  PetscCall(PetscFree(local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Value of rigid motion m (two translations, one rotation) in component c at node i */
static inline PetscReal RigidMotion(const System *s, PetscInt i, PetscInt c, PetscInt m)
{
  const PetscComplex arm = (s->b->z[i] - s->b->z[0]) / s->scale;

  if (m < 2) return m == c ? 1. : 0.;
  return c ? PetscRealPartComplex(arm) : -PetscImaginaryPartComplex(arm);
}

/* The rigid motions that no given displacement of nodes first..end-1 prevents: coefficients [3*k] in v */
static PetscErrorCode FindFreeMotions(const System *s, PetscInt first, PetscInt end, PetscReal v[9], PetscInt *nfree)
{
  PetscBLASInt three = 3, lwork = 32, info;
  PetscReal    value[3];
  PetscScalar  work[32];

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(v, 9));
  for (PetscInt i = first; i < end; ++i)
    for (PetscInt c = 0; c < 2; ++c)
      for (PetscInt k = 0; s->uindex[2 * i + c] < 0 && k < 9; ++k) v[k] += RigidMotion(s, i, c, k / 3) * RigidMotion(s, i, c, k % 3);
  PetscCallBLAS("LAPACKsyev", LAPACKsyev_("V", "L", &three, v, &three, value, work, &lwork, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "Rigid motions: syev gives %d", (int)info);
  for (*nfree = 0; *nfree < 3 && value[*nfree] < 1e-12;) ++*nfree;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* D + W^T V^-1 W does not feel these motions: give each the stiffness of an average unknown, so that it becomes zero */
static PetscErrorCode HoldFreeMotions(System *s)
{
  const AbutBoundary *g = s->b->given;
  PetscReal          *r, v[9], stiffness = 0.;
  PetscInt            nfree = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(s->nu, &r));
  for (PetscInt k = 0; k < s->nu; ++k) stiffness += s->D[k + (size_t)s->nu * k] / s->nu;
  for (PetscInt c = 0; c < g->ncontours; ++c) {
    const PetscInt first = s->b->order * g->contour[c], end = s->b->order * g->contour[c + 1]; /* nodes */
    PetscReal      area = 0.;

    for (PetscInt i = g->contour[c]; i < g->contour[c + 1]; ++i) area += FembemCross(s->e[i].a - s->e[g->contour[c]].a, s->e[i].t);
    /* the rigid motion of a hole alone is felt nowhere; that of the outer contour moves the holes */
    PetscCall(FindFreeMotions(s, area < 0. ? first : 0, area < 0. ? end : s->b->nnodes, v, &nfree));
    for (PetscInt m = 0; m < nfree; ++m) {
      PetscReal norm2 = 0.;

      PetscCall(PetscArrayzero(r, s->nu));
      for (PetscInt i = 2 * first; i < 2 * end; ++i) {
        const PetscInt k = s->uindex[i];

        if (k < 0) continue;
        for (PetscInt j = 0; j < 3; ++j) r[k] += v[3 * m + j] * RigidMotion(s, i / 2, i % 2, j);
        norm2 += r[k] * r[k];
      }
      for (PetscInt i = 0; i < s->nu; ++i) {
        for (PetscInt j = 0; r[i] != 0. && j < s->nu; ++j) s->D[j + (size_t)s->nu * i] += stiffness / norm2 * r[i] * r[j];
      }
    }
  }
  PetscCall(PetscFree(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Factor(const System *s, PetscBLASInt n, PetscBLASInt lda, PetscReal A[])
{
  PetscBLASInt info;

  PetscFunctionBegin;
  PetscCallBLAS("LAPACKpotrf", LAPACKpotrf_("L", &n, A, &lda, &info));
  AbutCheckInput(!info, s->b->comm,
                 "estimator_fembem_solve: the boundary-element system is singular (Poisson's ratio %g, %" PetscInt_FMT
                 " boundary elements); give none",
                 (double)((3. - s->b->mat.kappa) / 4.), s->b->n);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Leaves the unknown tractions in f and the unknown displacements in g */
static PetscErrorCode SystemSolve(System *s)
{
  const PetscReal one = 1., minus = -1.;
  PetscBLASInt    nt, nu, ldt, ldu, ione = 1, info;

  PetscFunctionBegin;
  PetscCall(PetscBLASIntCast(s->nt, &nt));
  PetscCall(PetscBLASIntCast(s->nu, &nu));
  ldt = PetscMax(nt, 1);
  ldu = PetscMax(nu, 1);
  PetscCall(Factor(s, nt, ldt, s->V));
  PetscCallBLAS("BLAStrsm", BLAStrsm_("L", "L", "N", "N", &nt, &ione, &one, s->V, &ldt, s->f, &ldt));
  if (nu) {
    PetscCallBLAS("BLAStrsm", BLAStrsm_("L", "L", "N", "N", &nt, &nu, &one, s->V, &ldt, s->W, &ldt));
    PetscCallBLAS("BLASsyrk", BLASsyrk_("L", "T", &nu, &nt, &one, s->W, &ldt, &one, s->D, &ldu));
    for (PetscInt k = 0; k < s->nu; ++k) s->g[k] = -s->g[k];
    if (nt) PetscCallBLAS("BLASgemv", BLASgemv_("T", &nt, &nu, &one, s->W, &ldt, s->f, &ione, &one, s->g, &ione));
    PetscCall(HoldFreeMotions(s));
    PetscCall(Factor(s, nu, ldu, s->D));
    PetscCallBLAS("LAPACKpotrs", LAPACKpotrs_("L", &nu, &ione, s->D, &ldu, s->g, &ldu, &info));
    if (nt) PetscCallBLAS("BLASgemv", BLASgemv_("N", &nt, &nu, &minus, s->W, &ldt, s->g, &ione, &one, s->f, &ione));
  }
  PetscCallBLAS("BLAStrsm", BLAStrsm_("L", "L", "T", "N", &nt, &ione, &one, s->V, &ldt, s->f, &ldt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FembemSolveGalerkin(FembemBoundary *b, PetscInt *unknowns)
{
  const PetscReal scale = 2. * BodySize(b);
  System          s;

  PetscFunctionBegin;
  PetscCall(SystemCreate(b, scale, &s));
  PetscCall(SystemAssemble(&s));
  PetscCall(SystemSolve(&s));
  for (PetscInt k = 0; k < s.rows * b->n; ++k)
    if (s.tindex[k] >= 0) s.t[k] = s.f[s.tindex[k]];
  for (PetscInt k = 0; k < 2 * b->nnodes; ++k)
    if (s.uindex[k] >= 0) s.u[k] = s.g[s.uindex[k]];
  for (PetscInt i = 0; i < b->nnodes; ++i) b->u[i] = scale * PetscCMPLX(s.u[2 * i], s.u[2 * i + 1]);
  for (PetscInt i = 0; i < (b->order + 1) * b->n; ++i) b->t[i] = b->young * PetscCMPLX(s.t[2 * i], s.t[2 * i + 1]);
  *unknowns = s.nt + s.nu;
  PetscCall(SystemDestroy(&s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
