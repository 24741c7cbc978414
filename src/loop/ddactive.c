#include <abut/private/loopimpl.h> /*I "abutloop.h" I*/

/* Primal-dual active set on the contact forces of all pairs. Bodies, forces and traces always belong together: what is solved for is a
   change of all three. */

#define ABUT_STALL 20 /* steps in which the error estimate must halve */

typedef struct {
  AbutInterface    iface;
  AbutContactModel model;
  PetscReal       *F, *r;     /* [n] contact forces acting; penetrations of the bodies as they are, less soft F */
  PetscReal       *d, *q, *a; /* [n] change of F, penetration it takes away; [m] change of the free motions */
  PetscBool        balanced;  /* F balances the loads along the free motions */
} AbutActive;

static PetscErrorCode AbutActiveCreate_Private(AbutInterface f, AbutActive *s)
{
  PetscFunctionBegin;
  s->iface = f;
  PetscCall(AbutInterfaceGetModel_Private(f, &s->model));
  PetscCall(PetscCalloc5(s->model->n, &s->F, s->model->n, &s->r, s->model->n, &s->d, s->model->n, &s->q, s->model->m, &s->a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutActiveDestroy_Private(AbutActive *s)
{
  PetscFunctionBegin;
  PetscCall(PetscFree5(s->F, s->r, s->d, s->q, s->a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define ABUT_TOUCH 1e-10 /* of the largest displacement and gap */

/* An open node that penetrates by round-off only touches: sides that meet exactly would else be tried again and again */
static PetscErrorCode AbutActiveDefect_Private(AbutActive *s)
{
  const PetscReal *trace = s->iface->g;
  PetscReal        size  = 0.;

  PetscFunctionBegin;
  PetscCall(AbutInterfacePenetration_Private(s->iface, s->model, trace, s->r));
  for (PetscInt k = 0; k < s->iface->offset[2 * s->iface->npairs]; ++k) size = PetscMax(size, PetscAbsReal(trace[k]));
  for (PetscInt i = 0; i < s->model->n; ++i) size = PetscMax(size, PetscAbsReal(s->model->open[i]));
  for (PetscInt i = 0; i < s->model->n; ++i) {
    s->r[i] -= s->model->soft[i] * s->F[i];
    if ((s->model->friction ? s->F[i] == 0. : s->F[i] <= 0.) && PetscAbsReal(s->r[i]) <= ABUT_TOUCH * size) s->r[i] = 0.;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first forces: those that act, or a guess of the model with the bodies moved as their supports move, and on adapted meshes what
   such a guess missed on the meshes before. Then one sweep. */
static PetscErrorCode AbutActiveStart_Private(AbutActive *s)
{
  AbutInterface f = s->iface;
  PetscInt      loose;
  PetscBool     solved;

  PetscFunctionBegin;
  s->balanced = f->acts;
  if (!f->acts) {
    for (PetscInt i = 0; i < f->npairs; ++i)
      PetscCall(AbutPairComputeSupport(f->pair[i], f->g + f->offset[2 * i], f->g + f->offset[2 * i + 1]));
    PetscCall(AbutActiveDefect_Private(s));
    PetscCall(AbutContactModelSolve_Private(s->model, s->r, s->F, s->d, s->a, &loose, &solved));
    AbutContactModelPressures_Private(s->model, f->npairs, s->d, f->guess);
    AbutContactModelPressures_Private(s->model, f->npairs, s->d, f->p);
    f->guessed  = PETSC_TRUE;
    s->balanced = (PetscBool)(!f->warm || !s->model->m);
    if (f->warm) PetscCall(AbutInterfaceTransferPressure_Private(f));
    PetscCall(PetscLogEventBegin(ABUTINTERFACE_Sweep, f, 0, 0, 0));
    PetscCall(AbutInterfaceSolveBodies_Private(f));
    ++f->sweeps;
    PetscCall(PetscLogEventEnd(ABUTINTERFACE_Sweep, f, 0, 0, 0));
  }
  AbutContactModelForces_Private(s->model, f->npairs, f->p, s->F);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bodies move freely by a, which takes no solve */
static PetscErrorCode AbutActiveMove_Private(AbutActive *s)
{
  AbutInterface f = s->iface;

  PetscFunctionBegin;
  if (!s->model->m) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < s->model->m; ++k)
    if (!s->model->mode[k]) PetscCall(AbutBodyMove(f->body[s->model->owner[k]], s->a + k)); /* a body's motions stand side by side */
  PetscCall(AbutInterfaceTraces_Private(f, f->u, f->g));
  PetscCall(AbutActiveDefect_Private(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The energy of the contact as it is: F'(S + soft)F of the model, or the bodies' own and the penalty's where that is less. A load on a
   body that floats is balanced by forces for which S has but a stand-in. */
static PetscErrorCode AbutActiveWhole_Private(AbutActive *s, PetscReal *whole)
{
  PetscReal own = 0.;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < s->iface->nbodies; ++b) {
    PetscReal work;

    PetscCall(AbutBodyGetWork(s->iface->body[b], &work)); /* twice the strain energy */
    own += PetscMax(0., work);
  }
  for (PetscInt i = 0; i < s->model->n; ++i) own += s->model->soft[i] * PetscSqr(s->F[i]);
  PetscCall(AbutContactModelEnergy_Private(s->model, s->model->soft, s->F, whole));
  *whole = PetscMin(own, *whole);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the model would still change, in energy, relative to the contact as it is */
static PetscErrorCode AbutActivePredict_Private(AbutActive *s, SNES snes, PetscReal *left)
{
  AbutContactModel model = s->model;
  PetscInt         loose;
  PetscBool        solved;
  PetscReal        whole = 0., change;

  PetscFunctionBegin;
  PetscCall(AbutActiveDefect_Private(s));
  PetscCall(AbutContactModelSolve_Private(model, s->r, s->F, s->d, s->a, &loose, &solved));
  *left = 1.;
  if (!solved) {
    s->iface->failure = loose >= 0 ? "floating" : "cycling";
    snes->reason      = SNES_DIVERGED_LOCAL_MIN;
    if (loose >= 0) PetscCall(AbutInterfaceSetFloating_Private(s->iface, model->owner[loose], model->mode[loose]));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(AbutActiveMove_Private(s));
  PetscCall(AbutActiveWhole_Private(s, &whole));
  PetscCall(AbutContactModelEnergy_Private(model, model->soft, s->d, &change));
  *left = change > 0. ? PetscSqrtReal(change / PetscMax(whole, change)) : 0.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One sweep: every body is solved with the change of forces alone; then the step along it that leaves the least energy, no force below
   zero */
static PetscErrorCode AbutActiveStep_Private(AbutActive *s)
{
  AbutInterface    f     = s->iface;
  AbutContactModel model = s->model;
  PetscReal        slope = 0., curvature = 0., step, furthest = PETSC_MAX_REAL;

  PetscFunctionBegin;
  PetscCall(AbutInterfaceComply_Private(f, model, s->d, s->q));
  ++f->sweeps;
  if (f->linearfailed) PetscFunctionReturn(PETSC_SUCCESS); /* the bodies stay as they were, which is the best there is */
  for (PetscInt i = 0; i < model->n; ++i) {
    slope += s->d[i] * s->r[i];
    curvature += s->d[i] * (s->q[i] + model->soft[i] * s->d[i]);
    if (s->d[i] < 0.) furthest = PetscMin(furthest, -s->F[i] / s->d[i]);
  }
  step = s->balanced && curvature > 0. ? PetscMin(PetscMax(0., slope / curvature), furthest) : 1.;
  if (model->friction) {
    step = s->balanced ? AbutContactModelFrictionStep_Private(model, s->F, s->r, s->d, s->q) : 1.;
    AbutContactModelFrictionAdd_Private(model, step, s->d, s->F);
  } else
    for (PetscInt i = 0; i < model->n; ++i) s->F[i] = PetscMax(0., s->F[i] + step * s->d[i]);
  for (PetscInt b = 0; b < f->nbodies; ++b) {
    PetscCall(VecScale(model->force[b], step));
    PetscCall(VecScale(model->w[b], step));
    PetscCall(AbutBodyUpdate(f->body[b], model->force[b], model->w[b]));
  }
  PetscCall(AbutInterfaceTraces_Private(f, f->u, f->g));
  if (model->friction) PetscCall(AbutContactModelLearnFriction_Private(model, s->d, s->q));
  else PetscCall(AbutContactModelLearn_Private(model, s->d, s->q));
  s->balanced = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutActiveLoop_Private(AbutActive *s, SNES snes)
{
  PetscReal left = 0., best = PETSC_MAX_REAL;
  PetscInt  when = 0;

  PetscFunctionBegin;
  for (PetscInt it = 0;; ++it) {
    snes->iter = it;
    PetscCall(AbutActivePredict_Private(s, snes, &left));
    if (s->iface->linearfailed) snes->reason = SNES_DIVERGED_LINEAR_SOLVE;
    snes->norm = s->iface->residual = s->iface->pressureresidual = left;
    PetscCall(SNESLogConvergenceHistory(snes, left, 0));
    PetscCall(SNESMonitor(snes, it, left));
    if (!snes->reason && s->balanced) PetscUseTypeMethod(snes, converged, it, 0., 0., left, &snes->reason, snes->cnvP);
    if (!snes->reason && it == snes->max_its) snes->reason = SNES_DIVERGED_MAX_IT;
    if (left < 0.5 * best) {
      best = left;
      when = it;
    } else if (!snes->reason && it - when >= ABUT_STALL) {
      s->iface->failure = "stagnation";
      snes->reason      = SNES_DIVERGED_LOCAL_MIN;
    }
    if (snes->reason) break;
    PetscCall(AbutActiveStep_Private(s));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SNESSolve_DDActive(SNES snes)
{
  AbutActive    s;
  AbutInterface f;

  PetscFunctionBegin;
  PetscCall(SNESGetApplicationContext(snes, &f));
  PetscCheck(f, PetscObjectComm((PetscObject)snes), PETSC_ERR_ARG_WRONGSTATE, "ddactive needs AbutInterfaceSetSNES()");
  snes->reason = SNES_CONVERGED_ITERATING;
  f->rate      = 0.;
  PetscCall(AbutActiveCreate_Private(f, &s));
  PetscCall(AbutActiveStart_Private(&s));
  PetscCall(AbutActiveLoop_Private(&s, snes));
  AbutContactModelPressures_Private(s.model, f->npairs, s.F, f->p);
  PetscCall(PetscArraycpy(f->x, f->g, f->offset[2 * f->npairs]));
  PetscCall(AbutInterfaceLocalize_Private(f, f->g, snes->vec_sol));
  PetscCall(AbutActiveDestroy_Private(&s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SNESView_DDActive(PETSC_UNUSED SNES snes, PetscViewer viewer)
{
  PetscBool ascii;

  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)viewer, PETSCVIEWERASCII, &ascii));
  if (ascii) PetscCall(PetscViewerASCIIPrintf(viewer, "  active set on the contact forces, directions from the layer model\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*MC
   SNESDDACTIVE - Primal-dual active set on the nodal contact forces of all pairs; the default

   Options Database Keys:
+  -snes_rtol <1e-8>           - on the energy of what is still to be changed, relative to the energy of the contact
.  -snes_max_it <10000>        - steps; each is one sweep, that is one solve in every body
-  -snes_ddactive_share <1000> - contact nodes above which the ranks share the model, see `AbutInterfaceSetShare()`

   Level: beginner

   Notes:
   With S the compliance of all bodies in the contact nodes, b the penetrations without contact, G those by free rigid motions a, and
   theta_i = theta/D_i, it solves F >= 0 complementary to b - (S + diag(theta_i)) F + G a, with G'F balancing the loads. A model of S, the
   compliance of elastic layers in closed form, gives direction and contact zone by a small quadratic programme: closed nodes stay while F >
   0, open nodes close when they penetrate, floating bodies stay balanced. One sweep with the change of forces alone gives the step of least
   energy and corrects the model (BFGS), so that on a standing zone the steps are those of preconditioned conjugate gradients, and the
   energy never grows.

   The number of sweeps depends little on theta, mesh, materials and number of bodies: for 1e-8 it was 3 to 5 on layers, and 9 in the
   median, 34 at most, for random stacks of slender and stocky, stiff and soft bodies on coarse meshes. theta = 0, exact contact, is
   allowed; so are bodies that only contact holds. It starts from the forces it left, on adapted meshes from those at the new nodes; the
   trace it is given is not looked at, the one that it leaves is that of the bodies.

   With friction (`-NAME_pair_friction`) the unknowns are F and the tangential forces T, |T_i| <= mu F_i. The model is asked for the
   answer of Coulomb's law itself, T_i = mu F_i where a node slips, so that there is no outer iteration over bounds. No energy is least
   then: steps make the model's equations hold along their direction, and the model learns from all sweeps, not only from the last one. It
   took 6 to 15 sweeps for 1e-8 to 1e-12 on blocks and on Hertz' contact. With a large mu the answer of Coulomb's law need not be the only
   one, or there is none: then the verdict is cycling.

   Verdicts beside converged: stagnation (the estimate does not halve in 20 steps, for example because the bodies are solved too inexactly),
   cycling (the zone of the model does not settle), floating (contact does not hold a body), linear_solver, max_iterations.

   Limits: the model is dense in the contact nodes of all pairs, n: some 40 n^2 bytes, some n^3 operations a mesh and n^3/3 for each zone
   that is tried, which the ranks share above a size; with friction they do not, and a node counts twice. Bodies that are no boxes are known
   at first as the layers of their bounding boxes. With friction next to incompressible (nu = 0.4999 was tried) it may end in stagnation.

   Sources: Hintermueller, Ito, Kunisch, SIAM J. Optim. 13 (2002), the active set; Farhat, Roux, IJNME 32 (1991), the balance of floating
   bodies; the closed forms of a layer under a harmonic pressure: Sneddon, Fourier Transforms (1951).

.seealso: `SNESDDNEUMANN`, `AbutInterfaceSetSNES()`
M*/
PetscErrorCode SNESCreate_DDActive(SNES snes)
{
  PetscFunctionBegin;
  snes->ops->view                   = SNESView_DDActive;
  snes->ops->solve                  = SNESSolve_DDActive;
  snes->usesksp                     = PETSC_FALSE;
  snes->usesnpc                     = PETSC_FALSE;
  snes->alwayscomputesfinalresidual = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
