#include <abut/private/loopimpl.h>
#include <petscblaslapack.h>

/* The contact problem of the model, a quadratic programme in the contact nodes: no body is solved here */

#define ABUT_ROUNDOFF 1e-13 /* relative to the largest force or penetration */
#define ABUT_SINGULAR 1e-10 /* of what a free motion meets when the others are held */

/* The answer of AbutContactModelSolve_Private() of the first rank for all: on it hangs what they do together */
PetscErrorCode AbutContactModelAgree_Private(AbutContactModel model, PetscReal d[], PetscReal a[], PetscInt *loose, PetscBool *solved)
{
  PetscFunctionBegin;
  PetscCall(AbutComplianceAgree_Private(model->S, model->n, MPIU_REAL, d));
  PetscCall(AbutComplianceAgree_Private(model->S, model->m, MPIU_REAL, a));
  PetscCall(AbutComplianceAgree_Private(model->S, 1, MPIU_INT, loose));
  PetscCall(AbutComplianceAgree_Private(model->S, 1, MPIU_BOOL, solved));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* X = (S + soft)^{-1} [G b] on the active nodes */
static PetscErrorCode AbutContactModelActive_Private(AbutContactModel model, PetscInt na)
{
  const PetscInt *active = model->active, n = model->n, m = model->m;

  PetscFunctionBegin;
  if (!na) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt j = 0; j < na; ++j) {
    for (PetscInt k = 0; k < m; ++k) model->X[k * na + j] = model->G[k * n + active[j]];
    model->X[m * na + j] = model->b[active[j]];
  }
  PetscCall(AbutComplianceFactor_Private(model->S, na, active, model->soft));
  PetscCall(AbutComplianceSolve_Private(model->S, m + 1, model->X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Free motions a that balance the loads: (G'X_G) a = e - G'X_b. *loose is a motion that the active nodes do not resist, -1 if there is
   none. */
static PetscErrorCode AbutContactModelBalance_Private(AbutContactModel model, PetscInt na, PetscReal a[], PetscInt *loose)
{
  const PetscInt m = model->m;
  PetscReal     *W, *scale;
  PetscBLASInt   bm, one = 1, info = 0;

  PetscFunctionBegin;
  *loose = -1;
  if (!m) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2(m * m, &W, m, &scale));
  for (PetscInt k = 0; k < m; ++k) {
    a[k] = model->e[k];
    for (PetscInt i = 0; i < na; ++i) {
      const PetscReal g = model->G[k * model->n + model->active[i]];

      a[k] -= g * model->X[m * na + i];
      for (PetscInt l = 0; l < m; ++l) W[k * m + l] += g * model->X[l * na + i];
    }
    scale[k] = PetscSqrtReal(W[k * m + k]);
    if (scale[k] <= 0. && *loose < 0) *loose = k;
  }
  if (*loose < 0) {
    for (PetscInt k = 0; k < m; ++k) {
      a[k] /= scale[k];
      for (PetscInt l = 0; l < m; ++l) W[k * m + l] /= scale[k] * scale[l];
    }
    PetscCall(PetscBLASIntCast(m, &bm));
    PetscCallBLAS("LAPACKpotrf", LAPACKpotrf_("L", &bm, W, &bm, &info));
    if (info > 0) *loose = info - 1;
    for (PetscInt k = 0; k < m && *loose < 0; ++k)
      if (PetscSqr(W[k * m + k]) < ABUT_SINGULAR) *loose = k;
  }
  if (*loose < 0) {
    PetscCallBLAS("LAPACKpotrs", LAPACKpotrs_("L", &bm, &one, W, &bm, a, &bm, &info));
    for (PetscInt k = 0; k < m; ++k) a[k] /= scale[k];
  }
  PetscCall(PetscFree2(W, scale));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forces and motions when the nodes of zone are closed and all others open; and what contradicts this: g[i] > 0 where an open node
   penetrates, F[i] < 0 */
static PetscErrorCode AbutContactModelZone_Private(AbutContactModel model, const PetscBool zone[], PetscReal F[], PetscReal g[],
                                                   PetscReal a[], PetscInt *loose)
{
  const PetscInt n = model->n, m = model->m;
  PetscInt       na = 0;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < n; ++i)
    if (zone[i]) model->active[na++] = i;
  PetscCall(AbutContactModelActive_Private(model, na));
  PetscCall(AbutContactModelBalance_Private(model, na, a, loose));
  if (model->S->shared) { /* the next factors are made together */
    PetscCall(AbutComplianceAgree_Private(model->S, m, MPIU_REAL, a));
    PetscCall(AbutComplianceAgree_Private(model->S, 1, MPIU_INT, loose));
  }
  if (*loose >= 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArrayzero(F, n));
  for (PetscInt j = 0; j < na; ++j) {
    PetscReal *f = F + model->active[j];

    *f = model->X[m * na + j];
    for (PetscInt k = 0; k < m; ++k) *f += a[k] * model->X[k * na + j];
  }
  PetscCall(AbutComplianceMult_Private(model->S, F, g));
  for (PetscInt i = 0; i < n; ++i) {
    g[i] = model->b[i] - g[i] - model->soft[i] * F[i];
    for (PetscInt k = 0; k < m; ++k) g[i] += a[k] * model->G[k * n + i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define ABUT_PATIENCE 10

/* Changes the zone where it is contradicted: closed nodes stay while F > 0, open nodes close when g > 0. All of them at once, and one at
   a time when that has not made the contradictions fewer for a while: so it ends (Judice and Pires, Comput. Oper. Res. 21, 1994).
   Returns how many there were. */
static PetscInt AbutContactModelExchange_Private(AbutContactModel model, const PetscReal F[], const PetscReal g[], PetscInt *least,
                                                 PetscInt *patience, PetscBool zone[])
{
  PetscReal largest[2] = {0., 0.};
  PetscInt  wrong = 0, last = -1;
  PetscBool all;

  for (PetscInt i = 0; i < model->n; ++i) {
    largest[0] = PetscMax(largest[0], PetscAbsReal(F[i]));
    largest[1] = PetscMax(largest[1], PetscMax(PetscAbsReal(g[i]), PetscAbsReal(model->b[i])));
  }
  for (PetscInt i = 0; i < model->n; ++i) {
    if (zone[i] ? F[i] >= -ABUT_ROUNDOFF * largest[0] : g[i] <= ABUT_ROUNDOFF * largest[1]) continue;
    model->active[wrong++] = i;
    last                   = i;
  }
  if (wrong < *least) {
    *least    = wrong;
    *patience = ABUT_PATIENCE;
  } else --*patience;
  all = (PetscBool)(*patience > 0);
  for (PetscInt j = 0; j < wrong; ++j)
    if (all || model->active[j] == last) zone[model->active[j]] = (PetscBool)!zone[model->active[j]];
  return wrong;
}

/* Nodes that touch without force do not hold a body. Where nothing is loaded all forces may be round-off of the gaps that were closed. */
static PetscErrorCode AbutContactModelTouching_Private(AbutContactModel model, const PetscReal F[], PetscBool zone[])
{
  PetscReal largest = 0., gap = 0., *diagonal;
  PetscBool loaded = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(model->n, &diagonal));
  PetscCall(AbutComplianceGetDiagonal_Private(model->S, diagonal));
  for (PetscInt k = 0; k < model->m; ++k)
    if (model->e[k] != 0.) loaded = PETSC_TRUE;
  for (PetscInt i = 0; i < model->n; ++i) {
    largest = PetscMax(largest, F[i]);
    gap     = PetscMax(gap, PetscAbsReal(model->b[i]));
  }
  for (PetscInt i = 0; i < model->n; ++i)
    zone[i] = (PetscBool)(F[i] > ABUT_ROUNDOFF * largest && (loaded || F[i] * diagonal[i] > ABUT_SINGULAR * gap));
  PetscCall(PetscFree(diagonal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Closes for every loaded motion the node that it closes first, and opens all others */
static void AbutContactModelFirstMet_Private(AbutContactModel model, PetscBool zone[])
{
  for (PetscInt i = 0; i < model->n; ++i) zone[i] = PETSC_FALSE;
  for (PetscInt k = 0; k < model->m; ++k) {
    PetscReal least = PETSC_MAX_REAL;
    PetscInt  first = -1;

    for (PetscInt i = 0; i < model->n; ++i) {
      const PetscReal toward = model->e[k] * model->G[k * model->n + i];

      if (toward <= 0. || -model->b[i] >= least * toward) continue;
      least = -model->b[i] / toward;
      first = i;
    }
    if (first >= 0) zone[first] = PETSC_TRUE;
  }
}

/*
   AbutContactModelSolve_Private - The contact problem of the model, from the state of the bodies

   Input Parameters:
+  model - the model
.  r     - [n] penetrations of the bodies as they are, less soft F; length
-  F     - [n] contact forces acting, >= 0, stress times length

   Output Parameters:
+  d      - [n] change of the forces that the model asks for
.  a      - [m] change of the free motions
.  loose  - a free motion that contact cannot hold, -1 if there is none
-  solved - false if the zone has not settled; d is then zero
*/
PetscErrorCode AbutContactModelSolve_Private(AbutContactModel model, const PetscReal r[], const PetscReal F[], PetscReal d[], PetscReal a[],
                                             PetscInt *loose, PetscBool *solved)
{
  const PetscInt n = model->n;
  PetscBool     *zone, any = PETSC_FALSE;
  PetscReal     *g;
  PetscInt       least = n + 1, patience = ABUT_PATIENCE, wrong = 1, rescues = 0;

  PetscFunctionBegin;
  if (model->friction) {
    PetscCall(AbutContactModelSolveFriction_Private(model, r, F, d, a, loose, solved));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscMalloc2(n, &zone, n, &g));
  PetscCall(AbutComplianceMult_Private(model->S, F, model->b));
  for (PetscInt i = 0; i < n; ++i) {
    zone[i] = (PetscBool)(F[i] > 0.);
    if (zone[i]) any = PETSC_TRUE;
    model->b[i] += r[i] + model->soft[i] * F[i];
  }
  for (PetscInt i = 0; i < n && !any; ++i) zone[i] = (PetscBool)(model->m || r[i] > 0.);
  *loose = -1;
  for (PetscInt it = 0; wrong && it < 100 + 10 * n; ++it) {
    PetscCall(AbutContactModelZone_Private(model, zone, d, g, a, loose));
    if (*loose >= 0 && rescues == 2) break;
    if (*loose >= 0) { /* too few nodes closed to hold a body: close all; in a hole most of these pull, and open at once */
      for (PetscInt i = 0; i < n; ++i) zone[i] = PETSC_TRUE;
      if (++rescues == 2) AbutContactModelFirstMet_Private(model, zone);
    } else wrong = AbutContactModelExchange_Private(model, d, g, &least, &patience, zone);
  }
  if (!wrong && model->m) {
    PetscCall(AbutContactModelTouching_Private(model, d, zone));
    PetscCall(AbutContactModelZone_Private(model, zone, d, g, a, loose));
  }
  *solved = (PetscBool)(!wrong && *loose < 0);
  for (PetscInt i = 0; i < n; ++i) d[i] = *solved ? PetscMax(0., d[i]) - F[i] : 0.;
  PetscCall(AbutContactModelAgree_Private(model, d, a, loose, solved));
  PetscCall(PetscFree2(zone, g));
  PetscFunctionReturn(PETSC_SUCCESS);
}
