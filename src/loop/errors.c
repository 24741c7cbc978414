#include <abut/private/loopimpl.h> /*I "abutloop.h" I*/

/* Parts of the error budget that need no other mesh: loop, penalty and linear solver, in the energy norm */

#define ABUT_SAFETY 1.25 /* of the penalty's part: see the note of AbutInterfaceGetErrors() */

/* What the model would still change of the contact forces F, with its penalty or with another one. The bodies are as g says, whatever
   brought them there. */
static PetscErrorCode AbutInterfaceAsk_Private(AbutInterface f, AbutContactModel model, PetscReal soft[], const PetscReal F[],
                                               PetscReal d[], PetscBool *solved)
{
  PetscReal *own = model->soft, *r, *a;
  PetscInt   loose;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(model->n, &r, model->m, &a));
  PetscCall(AbutInterfacePenetration_Private(f, model, f->g, r));
  *solved = PETSC_TRUE;
  for (PetscInt i = 0; i < model->n; ++i) {
    r[i] -= soft[i] * F[i];
    if (PetscIsInfOrNanReal(r[i])) *solved = PETSC_FALSE; /* a loop that blew up */
  }
  model->soft = soft;
  if (*solved) PetscCall(AbutContactModelSolve_Private(model, r, F, d, a, &loose, solved));
  model->soft = own;
  PetscCall(PetscFree2(r, a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Energy norms of the changes of displacement by more sweeps, and from there to exact contact; the change of each pair's force by the
   latter */
static PetscErrorCode AbutInterfaceContactErrors_Private(AbutInterface f, PetscReal *loop, PetscReal *penalty, PetscReal force[],
                                                         PetscBool *solved)
{
  AbutContactModel model;
  PetscReal       *F, *d, *e, *exact;
  PetscBool        soft = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(AbutInterfaceGetModel_Private(f, &model));
  PetscCall(PetscCalloc4(model->n, &F, model->n, &d, model->n, &e, model->n, &exact));
  AbutContactModelForces_Private(model, f->npairs, f->p, F);
  for (PetscInt i = 0; i < model->n; ++i)
    if (model->soft[i] > 0.) soft = PETSC_TRUE;
  PetscCall(AbutInterfaceAsk_Private(f, model, model->soft, F, d, solved));
  PetscCall(AbutContactModelEnergy_Private(model, NULL, d, loop));
  *loop = PetscSqrtReal(*loop);
  if (soft && *solved) {
    PetscCall(AbutInterfaceAsk_Private(f, model, exact, F, e, solved));
    for (PetscInt i = 0; i < model->n; ++i) e[i] -= d[i];
    PetscCall(AbutContactModelEnergy_Private(model, NULL, e, penalty));
    *penalty = ABUT_SAFETY * PetscSqrtReal(*penalty);
    for (PetscInt i = 0; i < f->npairs; ++i)
      for (PetscInt c = model->first[i]; c < model->first[i] + model->normals[i]; ++c) force[i] += ABUT_SAFETY * e[c];
  }
  PetscCall(PetscFree4(F, d, e, exact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define ABUT_UNSTRAINED 1e-6 /* strains of this size drown in the round-off of the energy of a rigid motion */

static PetscReal AbutErrorsRelative_Private(PetscReal part, PetscReal norm, PetscReal floor)
{
  if (norm > floor) return part / norm;
  return part > floor ? 1. : 0.;
}

/*@
   AbutInterfaceGetErrors - Parts of the error of the bodies as they are: loop, penalty, linear solvers

   Collective

   Input Parameter:
.  iface - the map, after at least one sweep; or without pairs, after a solve of every body

   Output Parameters:
+  errors - energy norms of the parts, relative to that of the displacements; 1 for loop and penalty if a body floats or the loop blew up
-  force  - [npairs] how much larger the force of each pair would be with exact contact, stress times length

   Level: intermediate

   Notes:
   The contact model of `SNESDDACTIVE` is asked what it would still change of the contact forces, with its penalties and with none: the
   first is the part of the loop, what the second has more is that of the penalty. This takes no sweep, and serves every loop. For other
   loops than `SNESDDACTIVE` the model is that of elastic layers, not corrected by sweeps. Where the bodies are such layers its answers are
   right within 2 per cent; penalty and force are given a quarter larger than that, because they are to be bounds also for the largest
   pressure, which changes by some per cent more.

   Bodies without strain, at rest or moved as rigid ones, have no linear error; loop and penalty are then 0 or 1.

   The part of the linear solvers is that of `AbutBodyGetLinearError()`. What the meshes cost is not in here, see `AbutEstimatorGetNorms()`.

   Limits: those of the model, dense in the contact nodes of all pairs.

.seealso: `AbutInterfaceGetPairState()`, `AbutBodyGetLinearError()`, `SNESDDACTIVE`
@*/
PetscErrorCode AbutInterfaceGetErrors(AbutInterface iface, AbutErrors *errors, PetscReal force[])
{
  PetscReal strain = 0., linear = 0., floor = 0.;
  PetscBool solved = PETSC_TRUE;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(iface, ABUTINTERFACE_CLASSID, 1);
  PetscCall(PetscMemzero(errors, sizeof(*errors)));
  PetscCall(PetscArrayzero(force, iface->npairs));
  for (PetscInt b = 0; b < iface->nbodies; ++b) {
    PetscReal energy, work, error, young, poisson, umax;

    PetscCall(AbutBodyGetEnergy(iface->body[b], &energy, &work));
    PetscCall(AbutBodyGetLinearError(iface->body[b], &error));
    PetscCall(AbutBodyGetMaterial(iface->body[b], &young, &poisson));
    PetscCall(VecNorm(iface->u[b], NORM_INFINITY, &umax));
    strain += energy;
    linear += error * error;
    floor += young * PetscSqr(ABUT_UNSTRAINED * umax);
  }
  floor        = PetscSqrtReal(floor);
  errors->norm = PetscSqrtReal(PetscMax(0., 2. * strain));
  if (iface->npairs) PetscCall(AbutInterfaceContactErrors_Private(iface, &errors->loop, &errors->penalty, force, &solved));
  errors->loop    = solved ? AbutErrorsRelative_Private(errors->loop, errors->norm, floor) : 1.;
  errors->penalty = solved ? AbutErrorsRelative_Private(errors->penalty, errors->norm, floor) : 1.;
  errors->linear  = AbutErrorsRelative_Private(PetscSqrtReal(linear), errors->norm, floor);
  PetscFunctionReturn(PETSC_SUCCESS);
}
