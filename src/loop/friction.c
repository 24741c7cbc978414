#include <abut/private/loopimpl.h> /*I "abutloop.h" I*/
#include <petscblaslapack.h>

/* What ddactive does otherwise where a pair has friction: unknowns, steps, what it learns. coulomb.c solves the contact problem. */

/* Makes model->friction if a pair has it */
PetscErrorCode AbutContactModelFriction_Private(AbutInterface f, AbutContactModel model)
{
  AbutModelFriction friction;
  PetscBool         any = PETSC_FALSE;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < f->npairs; ++i) {
    PetscBool has;

    PetscCall(AbutPairGetFriction(f->pair[i], &has, NULL));
    if (has) any = PETSC_TRUE;
  }
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&friction));
  PetscCall(PetscMalloc4(model->n, &friction->normal, model->n, &friction->tangent, model->n, &friction->mu, model->n, &friction->zone));
  for (PetscInt i = 0; i < f->npairs; ++i) {
    const PetscInt first = model->first[i], n = model->normals[i];
    PetscReal      mu;
    PetscBool      has;

    PetscCall(AbutPairGetFriction(f->pair[i], &has, &mu));
    for (PetscInt c = first; c < model->first[i + 1]; ++c) {
      friction->normal[c]  = c < first + n ? -1 : c - n;
      friction->tangent[c] = c < first + n && has ? c + n : -1;
      friction->mu[c]      = mu;
      friction->zone[c]    = ABUT_HOLDS;
    }
  }
  model->friction = friction;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutModelFrictionDestroy_Private(AbutModelFriction *friction)
{
  PetscFunctionBegin;
  if (!*friction) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree4((*friction)->normal, (*friction)->tangent, (*friction)->mu, (*friction)->zone));
  for (PetscInt i = 0; i < 2; ++i) PetscCall(PetscFree((*friction)->learned[i]));
  PetscCall(PetscFree((*friction)->S0));
  PetscCall(PetscFree((*friction)->M));
  PetscCall(PetscFree((*friction)->spring));
  PetscCall(PetscFree(*friction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define ABUT_SHORTEST 0.1 /* step: the model learns from a sweep whatever the step was */

/* How far to go along d, which takes q from penetrations and slips. There is no energy that friction makes least: what is asked for is that
   the equations of the model's zones, weighted with d, hold. F + step d keeps to the bounds. */
PetscReal AbutContactModelFrictionStep_Private(const AbutContactModel model, const PetscReal F[], const PetscReal r[], const PetscReal d[],
                                               const PetscReal q[])
{
  const AbutModelFriction friction = model->friction;
  PetscReal               slope = 0., curvature = 0., furthest = PETSC_MAX_REAL;

  for (PetscInt c = 0; c < model->n; ++c) {
    const PetscInt normal = friction->normal[c];

    if (normal < 0 && d[c] < 0.) furthest = PetscMin(furthest, -F[c] / d[c]);
    for (PetscInt sign = -1; normal >= 0 && sign <= 1; sign += 2) {
      const PetscReal room = friction->mu[c] * F[normal] - sign * F[c], less = sign * d[c] - friction->mu[c] * d[normal];

      if (less > 0.) furthest = PetscMin(furthest, PetscMax(0., room) / less);
    }
    if (normal >= 0 && friction->zone[c] != ABUT_HOLDS) continue;
    slope += d[c] * r[c];
    curvature += d[c] * (q[c] + model->soft[c] * d[c]);
  }
  if (curvature <= 0.) return 1.;
  return PetscMin(PetscMax(slope / curvature, ABUT_SHORTEST), PetscMax(1., furthest));
}

/* F + step d, within the bounds whatever the round-off */
void AbutContactModelFrictionAdd_Private(const AbutContactModel model, PetscReal step, const PetscReal d[], PetscReal F[])
{
  for (PetscInt c = 0; c < model->n; ++c) {
    const PetscInt normal = model->friction->normal[c];

    F[c] += step * d[c];
    if (normal < 0) F[c] = PetscMax(0., F[c]);
    else F[c] = PetscMax(-model->friction->mu[c] * F[normal], PetscMin(model->friction->mu[c] * F[normal], F[c]));
  }
}

#define ABUT_NOTHING 1e-10 /* of the energy of a direction */

/* S = S0 - B (V'B)^{-1} B' + W W', B = S0 V, of directions V that took W, V'W = 1: the BFGS formula for all of them at once. One after the
   other in place, what an update does to the round-off of earlier ones grows from sweep to sweep. */
static PetscErrorCode AbutModelFrictionRebuild_Private(AbutContactModel model)
{
  const AbutModelFriction friction = model->friction;
  const PetscInt          n = model->n, k = friction->nlearned;
  const PetscReal        *V = friction->learned[0], *W = friction->learned[1];
  PetscReal              *B, *C, one = 1., zero = 0., minus = -1.;
  PetscBLASInt            bn, bk, info;

  PetscFunctionBegin;
  PetscCall(PetscBLASIntCast(n, &bn));
  PetscCall(PetscBLASIntCast(k, &bk));
  PetscCall(PetscMalloc2(n * k, &B, k * k, &C));
  PetscCallBLAS("BLASgemm", BLASgemm_("N", "N", &bn, &bk, &bn, &one, friction->S0, &bn, V, &bn, &zero, B, &bn));
  PetscCallBLAS("BLASgemm", BLASgemm_("T", "N", &bk, &bk, &bn, &one, V, &bn, B, &bn, &zero, C, &bk));
  PetscCallBLAS("LAPACKpotrf", LAPACKpotrf_("L", &bk, C, &bk, &info));
  if (!info) {
    PetscCallBLAS("BLAStrsm", BLAStrsm_("R", "L", "T", "N", &bn, &bk, &one, C, &bk, B, &bn));
    PetscCall(PetscArraycpy(model->S->a, friction->S0, n * n));
    PetscCallBLAS("BLASgemm", BLASgemm_("N", "T", &bn, &bn, &bk, &minus, B, &bn, B, &bn, &one, model->S->a, &bn));
    PetscCallBLAS("BLASgemm", BLASgemm_("N", "T", &bn, &bn, &bk, &one, W, &bn, W, &bn, &one, model->S->a, &bn));
  } else --friction->nlearned; /* the last direction is round-off */
  PetscCall(PetscFree2(B, C));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A sweep has shown that forces d give way by q. Steps are not those of least energy here, so what d has of earlier directions is taken out
   first, in the sense of the compliance: the model then agrees with all sweeps, not only with the last one. */
PetscErrorCode AbutContactModelLearnFriction_Private(AbutContactModel model, const PetscReal d[], const PetscReal q[])
{
  AbutModelFriction friction = model->friction;
  const PetscInt    n = model->n, k = friction->nlearned;
  PetscReal        *v, *w, dq = 0., vw = 0.;

  PetscFunctionBegin;
  if (!friction->S0) {
    PetscCall(PetscMalloc1(n * n, &friction->S0));
    PetscCall(PetscArraycpy(friction->S0, model->S->a, n * n));
  }
  for (PetscInt i = 0; i < 2; ++i) PetscCall(PetscRealloc((k + 1) * n * sizeof(PetscReal), &friction->learned[i]));
  v = friction->learned[0] + k * n;
  w = friction->learned[1] + k * n;
  PetscCall(PetscArraycpy(v, d, n));
  PetscCall(PetscArraycpy(w, q, n));
  for (PetscInt i = 0; i < 2 * k; ++i) { /* twice: what one pass leaves is round-off of d, not of the remainder */
    const PetscReal *oldv = friction->learned[0] + (i % k) * n, *oldw = friction->learned[1] + (i % k) * n;
    PetscReal        part = 0.;

    for (PetscInt c = 0; c < n; ++c) part += oldv[c] * w[c];
    for (PetscInt c = 0; c < n; ++c) {
      v[c] -= part * oldv[c];
      w[c] -= part * oldw[c];
    }
  }
  for (PetscInt c = 0; c < n; ++c) {
    dq += d[c] * q[c];
    vw += v[c] * w[c];
  }
  if (vw <= ABUT_NOTHING * dq) PetscFunctionReturn(PETSC_SUCCESS); /* nothing new */
  for (PetscInt c = 0; c < n; ++c) {
    v[c] /= PetscSqrtReal(vw);
    w[c] /= PetscSqrtReal(vw);
  }
  ++friction->nlearned;
  PetscCall(AbutModelFrictionRebuild_Private(model));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceKeepSlip - The present slips of all pairs with friction become those from which slip is counted: the end of a load step

   Collective

   Input Parameter:
.  iface - the map, after a loop

   Level: developer

   Note:
   Nothing is done for pairs without friction.

.seealso: `AbutPairKeepSlip()`, `AbutInterfaceKeepTrace()`
@*/
PetscErrorCode AbutInterfaceKeepSlip(AbutInterface iface)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(iface, ABUTINTERFACE_CLASSID, 1);
  for (PetscInt i = 0; i < iface->npairs; ++i) {
    PetscBool has;

    PetscCall(AbutPairGetFriction(iface->pair[i], &has, NULL));
    if (has) PetscCall(AbutPairKeepSlip(iface->pair[i], iface->g + iface->offset[2 * i], iface->g + iface->offset[2 * i + 1], iface->p[i]));
  }
  if (iface->model && iface->model->friction) PetscCall(AbutContactModelOpen_Private(iface, iface->model));
  PetscFunctionReturn(PETSC_SUCCESS);
}
