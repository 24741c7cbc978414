#include <abut/private/loopimpl.h> /*I "abutloop.h" I*/

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

#define ABUT_CONTACT_NODES 30000 /* 7 GB for the compliance, or for the modes of a side on the rank that finds them */

/* The compliance of the layers. With friction every rank has it all: coulomb.c looks into it. */
static PetscErrorCode AbutContactModelCompliance_Private(AbutInterface f, AbutContactModel model)
{
  MPI_Comm       comm  = PetscObjectComm((PetscObject)f);
  const PetscInt share = model->friction ? PETSC_MAX_INT : f->share;
  PetscInt       modes, most = ABUT_CONTACT_NODES;
  PetscMPIInt    size;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(AbutModesCount_Private(f, &modes));
  if (model->n > share) most = (PetscInt)(most * PetscSqrtReal(size));
  AbutCheckInput(model->n <= most && modes <= ABUT_CONTACT_NODES, comm,
                 "scene_pairs: %" PetscInt_FMT " nodes in contacts, %" PetscInt_FMT
                 " on one side, are too many for the dense contact model; give larger cells on the contact sides, at most %" PetscInt_FMT
                 " and %d nodes",
                 model->n, modes, most, ABUT_CONTACT_NODES);
  PetscCall(AbutComplianceCreate_Private(comm, model->n, share, &model->S));
  PetscCall(AbutInterfaceLayers_Private(f, model));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The model of the present meshes */
PetscErrorCode AbutInterfaceGetModel_Private(AbutInterface f, AbutContactModel *model)
{
  PetscFunctionBegin;
  if (!f->model) {
    PetscCall(PetscNew(&f->model));
    PetscCall(AbutContactModelNodes_Private(f, f->model));
    PetscCall(AbutContactModelFriction_Private(f, f->model));
    PetscCall(AbutContactModelOpen_Private(f, f->model));
    PetscCall(AbutContactModelCompliance_Private(f, f->model));
    PetscCall(AbutContactModelMotions_Private(f, f->model));
    PetscCall(PetscMalloc1(f->model->n * (f->model->m + 1), &f->model->X));
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
  PetscCall(AbutComplianceDestroy_Private(&(*model)->S));
  PetscCall(PetscFree4((*model)->G, (*model)->e, (*model)->owner, (*model)->mode));
  PetscCall(PetscFree((*model)->X));
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
PetscErrorCode AbutContactModelEnergy_Private(AbutContactModel model, const PetscReal soft[], const PetscReal v[], PetscReal *energy)
{
  PetscReal e = 0., *Sv;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(model->n, &Sv));
  PetscCall(AbutComplianceMult_Private(model->S, v, Sv));
  for (PetscInt i = 0; i < model->n; ++i) e += v[i] * (Sv[i] + (soft ? soft[i] * v[i] : 0.));
  PetscCall(PetscFree(Sv));
  PetscCall(AbutComplianceAgree_Private(model->S, 1, MPIU_REAL, &e)); /* it decides whether the loop goes on */
  *energy = PetscMax(0., e);
  PetscFunctionReturn(PETSC_SUCCESS);
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
  const PetscInt n   = model->n;
  PetscReal      dSd = 0., dq = 0., *V, *W;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(2 * n, &V, 2 * n, &W));
  PetscCall(AbutComplianceMult_Private(model->S, d, W));
  for (PetscInt i = 0; i < n; ++i) {
    dSd += d[i] * W[i];
    dq += d[i] * q[i];
  }
  if (dSd > 0. && dq > 0.) { /* a direction below round-off teaches nothing */
    for (PetscInt i = 0; i < n; ++i) {
      W[i] /= PetscSqrtReal(dSd);
      W[n + i] = q[i] / PetscSqrtReal(dq);
      V[i]     = -W[i];
      V[n + i] = W[n + i];
    }
    PetscCall(AbutComplianceAdd_Private(model->S, 2, V, W));
  }
  PetscCall(PetscFree2(V, W));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceSetShare - Sets the size above which the ranks share the matrix of the contact model

   Logically Collective

   Input Parameters:
+  iface - the map, not set up
-  nodes - contact nodes of all pairs up to which every rank keeps the matrix of them all

   Level: intermediate

   Notes:
   Shared, a rank keeps n^2/p of its numbers and does n^3/p of the operations, and ScaLAPACK factors it. Below some size that takes longer
   than what every rank does for itself.

   Limits: with a PETSc without ScaLAPACK nothing is shared. One rank finds the modes of a side, n^2 numbers. With friction every rank keeps
   the matrix of all nodes, whatever the size.

.seealso: `AbutInterfaceSetFromOptions()`, `SNESDDACTIVE`
@*/
PetscErrorCode AbutInterfaceSetShare(AbutInterface iface, PetscInt nodes)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(iface, ABUTINTERFACE_CLASSID, 1);
  PetscValidLogicalCollectiveInt(iface, nodes, 2);
  PetscCheck(nodes >= 0, PetscObjectComm((PetscObject)iface), PETSC_ERR_ARG_OUTOFRANGE, "%" PetscInt_FMT " contact nodes", nodes);
  iface->share = nodes;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceSetFromOptions - Reads from the options how the contact model is kept

   Collective

   Input Parameter:
.  iface - the map, not set up

   Options Database Key:
.  -snes_ddactive_share <1000> - contact nodes above which the ranks share the contact model, see `AbutInterfaceSetShare()`

   Level: intermediate

   Note:
   Relaxations are read by `AbutInterfaceSetGammaFromOptions()`, since not every loop has one.

.seealso: `AbutInterfaceSetShare()`, `AbutInterfaceSetGammaFromOptions()`, `SNESDDACTIVE`
@*/
PetscErrorCode AbutInterfaceSetFromOptions(AbutInterface iface)
{
  MPI_Comm  comm  = PetscObjectComm((PetscObject)iface);
  PetscInt  share = iface->share;
  PetscBool given;

  PetscFunctionBegin;
  PetscObjectOptionsBegin((PetscObject)iface);
  PetscCall(AbutOptionsInt(PetscOptionsObject, "-snes_ddactive_share", "Contact nodes above which the ranks share the contact model",
                           &share, &given));
  PetscOptionsEnd();
  AbutCheckInput(share >= 0, comm, "snes_ddactive_share: %" PetscInt_FMT "; give a number of contact nodes, 0 to share any contact model",
                 share);
#if !defined(PETSC_HAVE_SCALAPACK)
  AbutCheckInput(!given, comm,
                 "snes_ddactive_share: this PETSc has no ScaLAPACK, so that every rank keeps the contact model; leave it out");
#endif
  PetscCall(AbutInterfaceSetShare(iface, share));
  PetscFunctionReturn(PETSC_SUCCESS);
}
