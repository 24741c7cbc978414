#include "system.h"
#include <petscblaslapack.h>

/* A component is given at a node if it is on one of its elements */
static void SystemNumber(FembemSystem *s)
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

/* Of lengths */
PetscReal FembemSystemScale(const FembemBoundary *b)
{
  PetscReal lo[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL}, hi[2] = {PETSC_MIN_REAL, PETSC_MIN_REAL};

  for (PetscInt i = 0; i < 2 * b->nnodes; ++i) {
    lo[i % 2] = PetscMin(lo[i % 2], b->given->x[i]);
    hi[i % 2] = PetscMax(hi[i % 2], b->given->x[i]);
  }
  return 2. * PetscMax(hi[0] - lo[0], hi[1] - lo[1]);
}

static void GetLocal(const FembemSystem *s, PetscInt i, FembemLocal *l)
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

/* Value of rigid motion m (two translations, one rotation) in component c at node i */
static inline PetscReal RigidMotion(const FembemSystem *s, PetscInt i, PetscInt c, PetscInt m)
{
  const PetscComplex arm = (s->b->z[i] - s->b->z[0]) / s->scale;

  if (m < 2) return m == c ? 1. : 0.;
  return c ? PetscRealPartComplex(arm) : -PetscImaginaryPartComplex(arm);
}

/* The rigid motions that no given displacement of nodes first..end-1 prevents: coefficients [3*k] in v */
static PetscErrorCode FindFreeMotions(const FembemSystem *s, PetscInt first, PetscInt end, PetscReal v[9], PetscInt *nfree)
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

/* The unknown displacements of nodes first..end-1: a contour's are numbered one after the other */
static void FindRange(const FembemSystem *s, PetscInt first, PetscInt end, FembemMotion *m)
{
  PetscInt n = 0;

  m->first = s->nu;
  for (PetscInt i = 2 * first; i < 2 * end; ++i) {
    if (s->uindex[i] < 0) continue;
    m->first = PetscMin(m->first, s->uindex[i]);
    ++n;
  }
  m->end = m->first + n;
}

/* D + W^T V^-1 W does not feel these motions */
static PetscErrorCode FindMotions(FembemSystem *s)
{
  const AbutBoundary *g = s->b->given;
  PetscReal           v[9], *room = s->value;
  PetscInt            nfree = 0;

  PetscFunctionBegin;
  s->nmotions = 0;
  for (PetscInt c = 0; c < g->ncontours; ++c) {
    const PetscInt first = s->b->order * g->contour[c], end = s->b->order * g->contour[c + 1]; /* nodes */
    PetscReal      area = 0.;

    for (PetscInt i = g->contour[c]; i < g->contour[c + 1]; ++i) area += FembemCross(s->e[i].a - s->e[g->contour[c]].a, s->e[i].t);
    /* the rigid motion of a hole alone is felt nowhere; that of the outer contour moves the holes */
    PetscCall(FindFreeMotions(s, area < 0. ? first : 0, area < 0. ? end : s->b->nnodes, v, &nfree));
    for (PetscInt m = 0; m < nfree; ++m, ++s->nmotions) {
      FembemMotion *motion = &s->motion[s->nmotions];

      FindRange(s, first, end, motion);
      motion->r     = room;
      motion->norm2 = 0.;
      room += motion->end - motion->first;
      for (PetscInt i = 2 * first; i < 2 * end; ++i) {
        const PetscInt k = s->uindex[i] - motion->first;

        if (s->uindex[i] < 0) continue;
        for (PetscInt j = 0; j < 3; ++j) motion->r[k] += v[3 * m + j] * RigidMotion(s, i / 2, i % 2, j);
        motion->norm2 += motion->r[k] * motion->r[k];
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FembemSystemCreate(const FembemBoundary *b, PetscReal scale, FembemSystem *s)
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
  s->V = s->W = s->D = NULL;
  s->list            = NULL;
  s->pairs           = 0;
  PetscCall(PetscCalloc4(s->nt + s->nu, &s->rhs, b->n, &s->local, 3 * b->given->ncontours, &s->motion, 3 * s->nu, &s->value));
  s->f = s->rhs;
  s->g = s->rhs + s->nt;
  for (PetscInt i = 0; i < b->n; ++i) GetLocal(s, i, &s->local[i]);
  PetscCall(FindMotions(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FembemSystemDestroy(FembemSystem *s)
{
  PetscFunctionBegin;
  PetscCall(PetscFree3(s->V, s->W, s->D));
  PetscCall(PetscFree6(s->e, s->t, s->u, s->tindex, s->uindex, s->loaded));
  PetscCall(PetscFree4(s->rhs, s->local, s->motion, s->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}
