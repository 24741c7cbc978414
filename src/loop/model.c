#include <abut/private/loopimpl.h>

/* The contact model of an interface: its nodes, the layers' compliance, the free motions of its bodies; and how it learns from sweeps */

/* Contact nodes of all pairs, one after the other: those that carry a pressure. With friction each is there twice. */
static PetscErrorCode AbutContactModelNodes_Private(AbutInterface f, AbutContactModel model)
{
  PetscFunctionBegin;
  PetscCall(PetscCalloc2(f->npairs + 1, &model->first, f->npairs, &model->normals));
  for (PetscInt pass = 0; pass < 2; ++pass) {
    PetscInt c = 0;

    for (PetscInt i = 0; i < f->npairs; ++i) {
      PetscInt         which, n;
      const PetscReal *x, *D;
      PetscReal        theta;
      PetscBool        friction;

      PetscCall(AbutPairGetPressureNodes(f->pair[i], &which, &n, &x, &D));
      PetscCall(AbutPairGetTheta(f->pair[i], &theta));
      PetscCall(AbutPairGetFriction(f->pair[i], &friction, NULL));
      for (PetscInt k = 0; k < (friction ? 2 : 1) * n; ++k) {
        if (D[k % n] <= 0.) continue;
        if (pass) {
          model->node[c] = k;
          model->D[c]    = D[k % n];
          model->soft[c] = theta / D[k % n];
        }
        ++c;
      }
      model->normals[i]   = (c - model->first[i]) / (friction ? 2 : 1);
      model->first[i + 1] = c;
    }
    model->n = c;
    if (!pass) PetscCall(PetscMalloc6(c, &model->node, c, &model->D, c, &model->soft, c, &model->open, c, &model->b, c, &model->active));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Penetrations by a unit of each free motion, and the resultants of the loads that contact has to balance */
static PetscErrorCode AbutContactModelMotions_Private(AbutInterface f, AbutContactModel model)
{
  PetscInt   all = f->offset[2 * f->npairs], m = 0;
  PetscReal *trace;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < f->nbodies; ++b) {
    PetscInt k;

    PetscCall(AbutBodyGetFreeModeCount(f->body[b], &k));
    model->m += k;
  }
  PetscCall(PetscMalloc4(model->m * model->n, &model->G, model->m, &model->e, model->m, &model->owner, model->m, &model->mode));
  PetscCall(PetscMalloc1(all, &trace));
  for (PetscInt b = 0; model->m && b < f->nbodies; ++b) {
    const Vec *mode;
    PetscInt   nmodes;
    PetscReal  load[3];

    PetscCall(AbutBodyGetFreeModes(f->body[b], &nmodes, &mode));
    PetscCall(AbutBodyGetImbalance(f->body[b], PETSC_FALSE, load));
    for (PetscInt k = 0; k < nmodes; ++k, ++m) {
      PetscReal *G = model->G + m * model->n;

      PetscCall(PetscArrayzero(trace, all));
      for (PetscInt t = 0; t < 2 * f->npairs; ++t) {
        AbutBody bodies[2];
        PetscInt sides[2], each;

        PetscCall(AbutPairGetBodies(f->pair[t / 2], bodies, sides));
        PetscCall(AbutPairGetComponents(f->pair[t / 2], &each));
        if (f->bodyof[t] == b) PetscCall(AbutBodyGetSideTrace(bodies[t % 2], sides[t % 2], each, mode[k], trace + f->offset[t]));
      }
      PetscCall(AbutInterfacePenetration_Private(f, model, trace, G));
      for (PetscInt c = 0; c < model->n; ++c) G[c] -= model->open[c];
      model->e[m]     = load[k];
      model->owner[m] = b;
      model->mode[m]  = k;
    }
  }
  PetscCall(PetscFree(trace));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutContactModelOpen_Private(AbutInterface f, AbutContactModel model)
{
  PetscReal *trace;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(f->offset[2 * f->npairs], &trace));
  PetscCall(AbutInterfacePenetration_Private(f, model, trace, model->open));
  PetscCall(PetscFree(trace));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define ABUT_CONTACT_NODES 30000 /* 7 GB for the compliance alone */

/* The model of the present meshes */
PetscErrorCode AbutInterfaceGetModel_Private(AbutInterface f, AbutContactModel *model)
{
  PetscFunctionBegin;
  if (!f->model) {
    PetscCall(PetscNew(&f->model));
    PetscCall(AbutContactModelNodes_Private(f, f->model));
    PetscCall(AbutContactModelFriction_Private(f, f->model));
    PetscCall(AbutContactModelOpen_Private(f, f->model));
    AbutCheckInput(f->model->n <= ABUT_CONTACT_NODES, PetscObjectComm((PetscObject)f),
                   "scene_pairs: %" PetscInt_FMT
                   " contact nodes are too many for the dense contact model; give larger cells on the contact sides, at most %d nodes",
                   f->model->n, ABUT_CONTACT_NODES);
    PetscCall(PetscCalloc1(f->model->n * f->model->n, &f->model->S));
    PetscCall(AbutInterfaceLayers_Private(f, f->model));
    PetscCall(AbutContactModelMotions_Private(f, f->model));
    PetscCall(PetscMalloc2(f->model->n * f->model->n, &f->model->factor, f->model->n * (f->model->m + 1), &f->model->X));
  }
  *model = f->model;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutContactModelDestroy_Private(AbutContactModel *model)
{
  PetscFunctionBegin;
  if (!*model) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree2((*model)->first, (*model)->normals));
  PetscCall(AbutModelFrictionDestroy_Private(&(*model)->friction));
  PetscCall(PetscFree6((*model)->node, (*model)->D, (*model)->soft, (*model)->open, (*model)->b, (*model)->active));
  PetscCall(PetscFree((*model)->S));
  PetscCall(PetscFree4((*model)->G, (*model)->e, (*model)->owner, (*model)->mode));
  PetscCall(PetscFree2((*model)->factor, (*model)->X));
  for (PetscInt b = 0; b < (*model)->nbodies; ++b) {
    PetscCall(VecDestroy(&(*model)->force[b]));
    PetscCall(VecDestroy(&(*model)->w[b]));
  }
  PetscCall(PetscFree2((*model)->force, (*model)->w));
  PetscCall(PetscFree(*model));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Traces -> penetrations of the contact nodes of all pairs, length */
PetscErrorCode AbutInterfacePenetration_Private(AbutInterface f, AbutContactModel model, const PetscReal trace[], PetscReal g[])
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < f->npairs; ++i) {
    PetscInt         which, n;
    const PetscReal *x, *D;
    const PetscReal *u1 = trace + f->offset[2 * i], *u2 = trace + f->offset[2 * i + 1];
    PetscReal       *nodal;
    PetscBool        friction;

    PetscCall(AbutPairGetPressureNodes(f->pair[i], &which, &n, &x, &D));
    PetscCall(AbutPairGetFriction(f->pair[i], &friction, NULL));
    PetscCall(PetscMalloc1((friction ? 2 : 1) * n, &nodal));
    PetscCall(AbutPairComputePenetration(f->pair[i], u1, u2, nodal));
    if (friction) PetscCall(AbutPairComputeSlip(f->pair[i], u1, u2, nodal + n));
    for (PetscInt c = model->first[i]; c < model->first[i + 1]; ++c) g[c] = nodal[model->node[c]];
    PetscCall(PetscFree(nodal));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forces on the contact nodes of all pairs -> nodal pressures of each pair; and back */
void AbutContactModelPressures_Private(const AbutContactModel model, PetscInt npairs, const PetscReal F[], PetscReal *const p[])
{
  for (PetscInt i = 0; i < npairs; ++i)
    for (PetscInt c = model->first[i]; c < model->first[i + 1]; ++c) p[i][model->node[c]] = F[c] / model->D[c];
}

void AbutContactModelForces_Private(const AbutContactModel model, PetscInt npairs, PetscReal *const p[], PetscReal F[])
{
  for (PetscInt i = 0; i < npairs; ++i)
    for (PetscInt c = model->first[i]; c < model->first[i + 1]; ++c) F[c] = p[i][model->node[c]] * model->D[c];
}

/* Energy v'(S + soft)v of contact forces v; soft may be NULL: the square of the energy norm of the displacements they make */
PetscReal AbutContactModelEnergy_Private(const AbutContactModel model, const PetscReal soft[], const PetscReal v[])
{
  PetscReal e = 0.;

  for (PetscInt i = 0; i < model->n; ++i) {
    PetscReal Sv = soft ? soft[i] * v[i] : 0.;

    for (PetscInt j = 0; j < model->n; ++j) Sv += model->S[i * model->n + j] * v[j];
    e += v[i] * Sv;
  }
  return PetscMax(0., e);
}

static PetscErrorCode AbutContactModelVectors_Private(AbutInterface f, AbutContactModel model)
{
  PetscFunctionBegin;
  model->nbodies = f->nbodies;
  PetscCall(PetscMalloc2(f->nbodies, &model->force, f->nbodies, &model->w));
  for (PetscInt b = 0; b < f->nbodies; ++b) {
    PetscCall(AbutBodyCreateVec(f->body[b], &model->force[b]));
    PetscCall(AbutBodyCreateVec(f->body[b], &model->w[b]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* q = S d by one solve of every body with the forces d of the contact nodes alone, which leaves model->force and model->w. The bodies' own
   displacements stay. */
PetscErrorCode AbutInterfaceComply_Private(AbutInterface f, AbutContactModel model, const PetscReal d[], PetscReal q[])
{
  PetscReal *trace, **p;

  PetscFunctionBegin;
  if (!model->w) PetscCall(AbutContactModelVectors_Private(f, model));
  PetscCall(PetscMalloc2(f->offset[2 * f->npairs], &trace, f->npairs, &p));
  for (PetscInt i = 0; i < f->npairs; ++i) PetscCall(PetscCalloc1(f->offset[2 * i + 2] - f->offset[2 * i], &p[i]));
  AbutContactModelPressures_Private(model, f->npairs, d, p);
  PetscCall(AbutInterfaceIncrement_Private(f, p, model->force, model->w, trace));
  PetscCall(AbutInterfacePenetration_Private(f, model, trace, q));
  for (PetscInt c = 0; c < model->n; ++c) q[c] = model->open[c] - q[c];
  for (PetscInt i = 0; i < f->npairs; ++i) PetscCall(PetscFree(p[i]));
  PetscCall(PetscFree2(trace, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A sweep has shown that forces d give way by q. The BFGS formula makes S agree with it and keeps what earlier sweeps taught; on a
   standing contact zone, with the step lengths of ddactive, the directions that follow are those of conjugate gradients preconditioned
   by the first S (Nazareth, SIAM J. Numer. Anal. 16, 1979). */
PetscErrorCode AbutContactModelLearn_Private(AbutContactModel model, const PetscReal d[], const PetscReal q[])
{
  const PetscInt n  = model->n;
  PetscReal     *Sd = model->b, dSd = 0., dq = 0.;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < n; ++i) {
    Sd[i] = 0.;
    for (PetscInt j = 0; j < n; ++j) Sd[i] += model->S[i * n + j] * d[j];
    dSd += d[i] * Sd[i];
    dq += d[i] * q[i];
  }
  if (dSd <= 0. || dq <= 0.) PetscFunctionReturn(PETSC_SUCCESS); /* a direction below round-off teaches nothing */
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = 0; j < n; ++j) model->S[i * n + j] += q[i] * q[j] / dq - Sd[i] * Sd[j] / dSd;
  PetscFunctionReturn(PETSC_SUCCESS);
}
