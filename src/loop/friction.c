#include <abut/private/loopimpl.h> /*I "abutloop.h" I*/

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
  for (PetscInt k = 0; k < (*friction)->nlearned; ++k) PetscCall(PetscFree((*friction)->learned[k]));
  PetscCall(PetscFree((*friction)->learned));
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

/* A sweep has shown that forces d give way by q. Steps are not those of least energy here, so what d has of earlier directions is taken out
   first, in the sense of the compliance: the model then agrees with all sweeps, not only with the last one. */
PetscErrorCode AbutContactModelLearnFriction_Private(AbutContactModel model, const PetscReal d[], const PetscReal q[])
{
  AbutModelFriction friction = model->friction;
  const PetscInt    n        = model->n;
  PetscReal        *v, *w, dq = 0., vw = 0.;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(2 * n, &v));
  w = v + n;
  PetscCall(PetscArraycpy(v, d, n));
  PetscCall(PetscArraycpy(w, q, n));
  for (PetscInt k = 0; k < friction->nlearned; ++k) {
    const PetscReal *old  = friction->learned[k];
    PetscReal        part = 0., whole = 0.;

    for (PetscInt c = 0; c < n; ++c) {
      part += old[c] * w[c];
      whole += old[c] * old[n + c];
    }
    for (PetscInt c = 0; c < 2 * n; ++c) v[c] -= part / whole * old[c];
  }
  for (PetscInt c = 0; c < n; ++c) {
    dq += d[c] * q[c];
    vw += v[c] * w[c];
  }
  if (vw <= ABUT_NOTHING * dq) { /* nothing new */
    PetscCall(PetscFree(v));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(AbutContactModelLearn_Private(model, v, w));
  PetscCall(PetscRealloc((friction->nlearned + 1) * sizeof(*friction->learned), &friction->learned));
  friction->learned[friction->nlearned++] = v;
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
