#include <abut/private/loopimpl.h>
#include <petscblaslapack.h>

/* The contact problem of the model with Coulomb friction: behind the contact forces F of a pair stand its tangential forces T,
   |T_i| <= mu F_i. The bounds move with F as it is solved, a semismooth Newton method on dense matrices: there is no iteration over
   bounds, and no body is solved. */

#define ABUT_ROUNDOFF 1e-13 /* relative to the largest force or penetration */
#define ABUT_SINGULAR 1e-10 /* of what a free motion meets when the others are held */
#define ABUT_PATIENCE 10

/* A tangential force that slips goes with its contact force: the column of the latter has both, by this factor. 0: it does not slip. */
static PetscReal AbutFrictionShare_Private(AbutContactModel model, PetscInt c)
{
  const AbutModelFriction friction = model->friction;
  const PetscInt          t        = friction->tangent[c];

  return t >= 0 && friction->zone[t] != ABUT_HOLDS ? friction->zone[t] * friction->mu[t] : 0.;
}

/* The unknowns whose equations are solved */
static PetscInt AbutFrictionActive_Private(AbutContactModel model)
{
  const AbutModelFriction friction = model->friction;
  PetscInt                na       = 0;

  for (PetscInt c = 0; c < model->n; ++c) {
    const PetscInt normal = friction->normal[c];

    if (friction->zone[c] == ABUT_HOLDS && (normal < 0 || friction->zone[normal] == ABUT_HOLDS)) model->active[na++] = c;
  }
  return na;
}

/* X = M^{-1} [G b] on the active unknowns, M not symmetric where nodes slip */
static PetscErrorCode AbutFrictionSolveActive_Private(AbutContactModel model, PetscInt na)
{
  const PetscInt *active = model->active, n = model->n, m = model->m;
  PetscReal      *M;
  PetscBLASInt    bn, columns, info, *pivot;

  PetscFunctionBegin;
  if (!na) PetscFunctionReturn(PETSC_SUCCESS);
  if (!model->friction->M) PetscCall(PetscMalloc1(n * n, &model->friction->M));
  M = model->friction->M;
  for (PetscInt j = 0; j < na; ++j) {
    const PetscReal  share = AbutFrictionShare_Private(model, active[j]), *S = model->S->a + active[j] * n;
    const PetscReal *T = share != 0. ? model->S->a + model->friction->tangent[active[j]] * n : NULL;

    for (PetscInt i = 0; i < na; ++i) M[j * na + i] = S[active[i]] + (T ? share * T[active[i]] : 0.);
    M[j * na + j] += model->soft[active[j]];
    for (PetscInt k = 0; k < m; ++k) model->X[k * na + j] = model->G[k * n + active[j]];
    model->X[m * na + j] = model->b[active[j]];
  }
  PetscCall(PetscBLASIntCast(na, &bn));
  PetscCall(PetscBLASIntCast(m + 1, &columns));
  PetscCall(PetscMalloc1(na, &pivot));
  PetscCallBLAS("LAPACKgesv", LAPACKgesv_(&bn, &columns, M, &bn, pivot, model->X, &bn, &info));
  PetscCall(PetscFree(pivot));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "The contact model with friction is singular: LAPACK gesv returned %d", (int)info);
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define ABUT_SPRING 1e-6 /* of what a free motion meets when all nodes hold: far softer than contact */

/* Free motions a that balance the loads; *loose is one that the active unknowns do not resist, -1 if there is none. stiffness: what each
   motion meets, or NULL. */
static PetscErrorCode AbutFrictionBalance_Private(AbutContactModel model, PetscInt na, PetscReal a[], PetscInt *loose,
                                                  PetscReal stiffness[])
{
  const PetscInt m = model->m;
  PetscReal     *W, *scale;
  PetscBLASInt   bm, one = 1, info = 0, *pivot;

  PetscFunctionBegin;
  *loose = -1;
  if (!m) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc3(m * m, &W, m, &scale, m, &pivot));
  for (PetscInt k = 0; k < m; ++k) {
    a[k] = model->e[k];
    for (PetscInt i = 0; i < na; ++i) {
      const PetscInt  c     = model->active[i];
      const PetscReal share = AbutFrictionShare_Private(model, c);
      const PetscReal g = model->G[k * model->n + c] + (share != 0. ? share * model->G[k * model->n + model->friction->tangent[c]] : 0.);

      a[k] -= g * model->X[m * na + i];
      for (PetscInt l = 0; l < m; ++l) W[l * m + k] += g * model->X[l * na + i];
    }
    W[k * m + k] += model->friction->spring[k];
    if (stiffness) stiffness[k] = PetscAbsReal(W[k * m + k]);
    scale[k] = PetscSqrtReal(PetscAbsReal(W[k * m + k]));
    if (scale[k] <= 0. && *loose < 0) *loose = k;
  }
  if (*loose < 0) {
    for (PetscInt k = 0; k < m; ++k) {
      a[k] /= scale[k];
      for (PetscInt l = 0; l < m; ++l) W[l * m + k] /= scale[k] * scale[l];
    }
    PetscCall(PetscBLASIntCast(m, &bm));
    PetscCallBLAS("LAPACKgetrf", LAPACKgetrf_(&bm, &bm, W, &bm, pivot, &info));
    for (PetscInt k = 0; k < m && *loose < 0; ++k)
      if (PetscAbsReal(W[k * m + k]) < ABUT_SINGULAR) *loose = k;
  }
  if (*loose < 0) {
    PetscCallBLAS("LAPACKgetrs", LAPACKgetrs_("N", &bm, &one, W, &bm, pivot, a, &bm, &info));
    for (PetscInt k = 0; k < m; ++k) a[k] /= scale[k];
  }
  PetscCall(PetscFree3(W, scale, pivot));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forces x and motions a in the present zones, and g, what is left of penetrations and slips */
static PetscErrorCode AbutFrictionZone_Private(AbutContactModel model, PetscReal x[], PetscReal g[], PetscReal a[], PetscInt *loose,
                                               PetscReal stiffness[])
{
  const PetscInt n = model->n, m = model->m, na = AbutFrictionActive_Private(model);

  PetscFunctionBegin;
  PetscCall(AbutFrictionSolveActive_Private(model, na));
  PetscCall(AbutFrictionBalance_Private(model, na, a, loose, stiffness));
  if (*loose >= 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArrayzero(x, n));
  for (PetscInt j = 0; j < na; ++j) {
    const PetscInt  c     = model->active[j];
    const PetscReal share = AbutFrictionShare_Private(model, c);

    x[c] = model->X[m * na + j];
    for (PetscInt k = 0; k < m; ++k) x[c] += a[k] * model->X[k * na + j];
    if (share != 0.) x[model->friction->tangent[c]] = share * x[c];
  }
  PetscCall(AbutComplianceMult_Private(model->S, x, g));
  for (PetscInt i = 0; i < n; ++i) {
    g[i] = model->b[i] - g[i] - model->soft[i] * x[i];
    for (PetscInt k = 0; k < m; ++k) g[i] += a[k] * model->G[k * n + i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The zone that the answer asks an unknown to be in: its own, unless it is contradicted. Of the tolerances the first is for forces. */
static PetscInt AbutFrictionAsked_Private(const AbutContactModel model, PetscInt c, const PetscReal x[], const PetscReal g[],
                                          const PetscReal tolerance[2])
{
  const PetscInt zone = model->friction->zone[c], normal = model->friction->normal[c];

  if (normal < 0) {
    if (zone == ABUT_HOLDS) return x[c] < -tolerance[0] ? ABUT_OPEN : ABUT_HOLDS;
    return g[c] > tolerance[1] ? ABUT_HOLDS : ABUT_OPEN;
  }
  if (model->friction->zone[normal] != ABUT_HOLDS) return zone;
  if (zone != ABUT_HOLDS) return zone * g[c] < -tolerance[1] ? ABUT_HOLDS : zone;
  if (PetscAbsReal(x[c]) <= model->friction->mu[c] * PetscMax(0., x[normal]) + tolerance[0]) return ABUT_HOLDS;
  return x[c] > 0. ? ABUT_SLIPS : ABUT_SLIPS_BACK;
}

/* Changes zones where they are contradicted, all at once, and every other one by chance when that has not made the contradictions fewer for
   a while: matrices with friction are not those for which single changes must end. Returns how many there were. */
static PetscInt AbutFrictionExchange_Private(AbutContactModel model, const PetscReal x[], const PetscReal g[], PetscInt *least,
                                             PetscInt *patience)
{
  PetscReal largest[2] = {0., 0.};
  PetscInt  wrong      = 0;
  unsigned  chance     = (unsigned)(ABUT_PATIENCE - *patience); /* the same in every run, on every rank */

  for (PetscInt i = 0; i < model->n; ++i) {
    largest[0] = PetscMax(largest[0], ABUT_ROUNDOFF * PetscAbsReal(x[i]));
    largest[1] = PetscMax(largest[1], ABUT_ROUNDOFF * PetscMax(PetscAbsReal(g[i]), PetscAbsReal(model->b[i])));
  }
  for (PetscInt c = 0; c < model->n; ++c)
    if (AbutFrictionAsked_Private(model, c, x, g, largest) != model->friction->zone[c]) model->active[wrong++] = c;
  if (wrong < *least) {
    *least    = wrong;
    *patience = ABUT_PATIENCE;
  } else --*patience;
  for (PetscInt j = wrong - 1; j >= 0; --j) { /* backwards: tangential forces before their bounds */
    chance = (1103515245u * chance + 12345u) & 0x7fffffffu;
    if (*patience > 0 || wrong == 1 || chance & 0x40000000u)
      model->friction->zone[model->active[j]] = AbutFrictionAsked_Private(model, model->active[j], x, g, largest);
  }
  return wrong;
}

/* Nodes that touch without force do not hold a body */
static void AbutFrictionTouching_Private(AbutContactModel model, const PetscReal x[])
{
  PetscReal largest = 0., gap = 0.;
  PetscBool loaded = PETSC_FALSE;

  for (PetscInt k = 0; k < model->m; ++k)
    if (model->e[k] != 0.) loaded = PETSC_TRUE;
  for (PetscInt c = 0; c < model->n; ++c) {
    largest = PetscMax(largest, PetscAbsReal(x[c]));
    gap     = PetscMax(gap, PetscAbsReal(model->b[c]));
  }
  for (PetscInt c = 0; c < model->n; ++c)
    if (model->friction->normal[c] < 0 &&
        (x[c] <= ABUT_ROUNDOFF * largest || !(loaded || x[c] * model->S->a[c * model->n + c] > ABUT_SINGULAR * gap)))
      model->friction->zone[c] = ABUT_OPEN;
}

/* The zones that begin: those of the forces that act; a node that is loaded to its bound slips on */
static void AbutFrictionBegin_Private(AbutContactModel model, const PetscReal r[], const PetscReal F[])
{
  const AbutModelFriction friction = model->friction;
  PetscBool               any      = PETSC_FALSE;

  for (PetscInt c = 0; c < model->n; ++c)
    if (friction->normal[c] < 0 && F[c] > 0.) any = PETSC_TRUE;
  for (PetscInt c = 0; c < model->n; ++c) {
    const PetscInt normal = friction->normal[c];

    if (normal < 0) friction->zone[c] = (any ? F[c] > 0. : model->m || r[c] > 0.) ? ABUT_HOLDS : ABUT_OPEN;
    else if (F[c] == 0. || PetscAbsReal(F[c]) < (1. - ABUT_SINGULAR) * friction->mu[c] * F[normal]) friction->zone[c] = ABUT_HOLDS;
    else friction->zone[c] = F[c] > 0. ? ABUT_SLIPS : ABUT_SLIPS_BACK;
  }
}

/* The zones of the answer, and whether they have settled. Where too few nodes hold a body all are closed and let stick, once; from then on
   a weak spring holds it too: a body that slips on all its sides moves until one of them drags it along. */
static PetscErrorCode AbutFrictionSettle_Private(AbutContactModel model, PetscReal x[], PetscReal g[], PetscReal a[], PetscInt *loose,
                                                 PetscBool *settled)
{
  const PetscInt n       = model->n;
  PetscBool      rescued = PETSC_FALSE;
  PetscInt       least = n + 1, patience = ABUT_PATIENCE, wrong = 1;

  PetscFunctionBegin;
  for (PetscInt it = 0; wrong && it < 100 + 10 * n; ++it) {
    PetscCall(AbutFrictionZone_Private(model, x, g, a, loose, NULL));
    if (*loose >= 0 && rescued) break;
    if (*loose >= 0) {
      for (PetscInt c = 0; c < n; ++c) model->friction->zone[c] = ABUT_HOLDS;
      PetscCall(AbutFrictionZone_Private(model, x, g, a, loose, model->friction->spring));
      if (*loose >= 0) break;
      for (PetscInt k = 0; k < model->m; ++k) model->friction->spring[k] *= ABUT_SPRING;
      rescued = PETSC_TRUE;
      least   = n + 1;
    }
    wrong = AbutFrictionExchange_Private(model, x, g, &least, &patience);
  }
  PetscCall(PetscArrayzero(model->friction->spring, model->m));
  if (!wrong && model->m) {
    AbutFrictionTouching_Private(model, x);
    PetscCall(AbutFrictionZone_Private(model, x, g, a, loose, NULL));
  }
  *settled = (PetscBool)!wrong;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* AbutContactModelSolve_Private() with friction: r has slips behind the penetrations, F tangential forces behind the forces */
PetscErrorCode AbutContactModelSolveFriction_Private(AbutContactModel model, const PetscReal r[], const PetscReal F[], PetscReal d[],
                                                     PetscReal a[], PetscInt *loose, PetscBool *solved)
{
  const PetscInt n = model->n;
  PetscReal     *g;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &g));
  if (!model->friction->spring) PetscCall(PetscCalloc1(model->m, &model->friction->spring));
  AbutFrictionBegin_Private(model, r, F);
  PetscCall(AbutComplianceMult_Private(model->S, F, model->b));
  for (PetscInt i = 0; i < n; ++i) model->b[i] += r[i] + model->soft[i] * F[i];
  *loose = -1;
  PetscCall(AbutFrictionSettle_Private(model, d, g, a, loose, solved));
  if (*loose >= 0) *solved = PETSC_FALSE;
  for (PetscInt c = 0; c < n; ++c) {
    const PetscInt normal = model->friction->normal[c];

    if (!*solved) d[c] = 0.;
    else if (normal < 0) d[c] = PetscMax(0., d[c]); /* forces come before the tangential ones that they bound */
    else d[c] = PetscMax(-model->friction->mu[c] * d[normal], PetscMin(model->friction->mu[c] * d[normal], d[c]));
  }
  for (PetscInt c = 0; c < n && *solved; ++c) d[c] -= F[c];
  PetscCall(AbutContactModelAgree_Private(model, d, a, loose, solved));
  PetscCall(PetscFree(g));
  PetscFunctionReturn(PETSC_SUCCESS);
}
