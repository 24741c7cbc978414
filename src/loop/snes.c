#include <abut/private/loopimpl.h> /*I "abutloop.h" I*/
#include <petscdmshell.h>

/* The map of the interface trace as the nonlinear function of a SNES, its stop test, and the name of what came out */

/*@
   AbutLoopRegisterAll - Registers the SNES types of Abut

   Not Collective

   Level: developer

.seealso: `SNESDDNEUMANN`, `SNESRegister()`
@*/
PetscErrorCode AbutLoopRegisterAll(void)
{
  PetscFunctionBegin;
  if (ABUTINTERFACE_CLASSID) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscClassIdRegister("Abut Interface", &ABUTINTERFACE_CLASSID));
  PetscCall(PetscLogEventRegister("AbutSweep", ABUTINTERFACE_CLASSID, &ABUTINTERFACE_Sweep));
  PetscCall(SNESRegister(SNESDDNEUMANN, SNESCreate_DDNeumann));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutInterfaceFunction_Private(SNES snes, Vec x, Vec F, void *ctx)
{
  AbutInterface iface = (AbutInterface)ctx;

  PetscFunctionBegin;
  PetscCall(AbutInterfaceSweep(iface, x, F));
  PetscCall(VecAYPX(F, -1., x));
  if (iface->linearfailed) PetscCall(SNESSetFunctionDomainError(snes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define ABUT_WINDOW 50 /* iterations over which the residual must have fallen; four times as many where the rate is not known */

/* Beyond its limit the relaxation does not blow up, it wanders between open and overloaded contact: then the least residual of a window of iterations is not
   much below that of the window before. Half of what the slowest mode loses is asked for, or anything at all where that is not known. */
static PetscBool AbutInterfaceStagnates_Private(AbutInterface f, PetscInt it)
{
  const PetscInt window    = f->rate > 0. ? ABUT_WINDOW : 4 * ABUT_WINDOW;
  PetscBool      stagnates = PETSC_FALSE;

  if (!it) f->best[0] = f->best[1] = PETSC_MAX_REAL;
  else if (it % window == 0) {
    const PetscReal fall = 1. - PetscPowRealInt(1. - PetscMin(f->rate, 1.), window);

    stagnates  = (PetscBool)(it >= 3 * window && f->best[0] >= (1. - 0.5 * fall) * f->best[1]);
    f->best[1] = f->best[0];
    f->best[0] = f->residual;
  }
  f->best[0] = PetscMin(f->best[0], f->residual);
  return stagnates;
}

/* Never the change per sweep, which is gamma times smaller than the error: the fixed-point residual of the traces and of the pressures */
static PetscErrorCode AbutInterfaceConverged_Private(SNES snes, PetscInt it, PETSC_UNUSED PetscReal xnorm, PETSC_UNUSED PetscReal ynorm,
                                                     PetscReal fnorm, SNESConvergedReason *reason, void *ctx)
{
  AbutInterface iface = (AbutInterface)ctx;
  PetscReal     rtol;

  PetscFunctionBegin;
  PetscCall(SNESGetTolerances(snes, NULL, &rtol, NULL, NULL, NULL));
  *reason = SNES_CONVERGED_ITERATING;
  if (PetscIsInfOrNanReal(fnorm)) *reason = SNES_DIVERGED_FNORM_NAN;
  else if (iface->residual <= rtol && iface->pressureresidual <= rtol) *reason = SNES_CONVERGED_FNORM_RELATIVE;
  else if (AbutInterfaceStagnates_Private(iface, it)) {
    iface->failure = iface->rate > 0. ? "oscillation" : "stagnation";
    *reason        = SNES_DIVERGED_LOCAL_MIN;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceSetSNES - Makes F(x) = x - G(x) the function of a SNES, with the stop test on the fixed-point residual

   Collective

   Input Parameters:
+  iface - the map, set up
-  snes  - the solver

   Options Database Keys:
.  -snes_rtol <1e-8> - on |G(x)-x|/|G(x)|, and on the same of the pressures

   Level: intermediate

   Note:
   Call it again after the meshes have changed. There is no absolute tolerance: it would depend on the units.

.seealso: `AbutInterfaceSweep()`, `AbutInterfaceGetVerdict()`, `SNESDDNEUMANN`
@*/
PetscErrorCode AbutInterfaceSetSNES(AbutInterface iface, SNES snes)
{
  Vec r;
  DM  dm; /* tells the SNES how long its work vectors are, which changes with the meshes */

  PetscFunctionBegin;
  PetscCall(AbutInterfaceCreateVec(iface, &r));
  PetscCall(DMShellCreate(PetscObjectComm((PetscObject)iface), &dm));
  PetscCall(DMShellSetGlobalVector(dm, r));
  PetscCall(SNESSetDM(snes, dm));
  PetscCall(DMDestroy(&dm));
  PetscCall(SNESSetFunction(snes, r, AbutInterfaceFunction_Private, iface));
  PetscCall(VecDestroy(&r));
  PetscCall(SNESSetApplicationContext(snes, iface));
  PetscCall(SNESSetConvergenceTest(snes, AbutInterfaceConverged_Private, iface, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceGetChange - The largest relative change of u_n over the bodies: the quantity of the paper's stop test

   Collective

   Input Parameters:
+  iface - the map
.  step  - change of the trace
-  x     - the trace after it

   Output Parameter:
.  change - largest |step|/|x| of any body, one norm a body; infinite where a body's trace is zero

   Level: developer

.seealso: `SNESDDNEUMANN`
@*/
PetscErrorCode AbutInterfaceGetChange(AbutInterface iface, Vec step, Vec x, PetscReal *change)
{
  const PetscScalar *s, *v;
  PetscReal         *sum;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(2 * iface->nbodies, &sum));
  PetscCall(VecGetArrayRead(step, &s));
  PetscCall(VecGetArrayRead(x, &v));
  for (PetscInt k = 0; k < iface->nowned; ++k) {
    PetscInt t = 0, sides[2];
    AbutBody bodies[2];

    while (iface->owned[k] >= iface->offset[t + 1]) ++t;
    PetscCall(AbutPairGetBodies(iface->pair[t / 2], bodies, sides));
    for (PetscInt b = 0; b < iface->nbodies; ++b) {
      if (iface->body[b] != bodies[t % 2]) continue;
      sum[2 * b] += PetscSqr(s[k]);
      sum[2 * b + 1] += PetscSqr(v[k]);
    }
  }
  PetscCall(VecRestoreArrayRead(step, &s));
  PetscCall(VecRestoreArrayRead(x, &v));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, (PetscMPIInt)(2 * iface->nbodies), MPIU_REAL, MPIU_SUM,
                             PetscObjectComm((PetscObject)iface)));
  *change = 0.;
  for (PetscInt t = 0; t < 2 * iface->npairs; ++t) { /* a body that is in no pair has no trace to change */
    PetscInt sides[2], b = 0;
    AbutBody bodies[2];

    PetscCall(AbutPairGetBodies(iface->pair[t / 2], bodies, sides));
    while (iface->body[b] != bodies[t % 2]) ++b;
    *change = PetscMax(*change, sum[2 * b + 1] > 0. ? PetscSqrtReal(sum[2 * b] / sum[2 * b + 1]) : PETSC_INFINITY);
  }
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutInterfaceGetVerdict - What came out of a loop, in one word

   Not Collective

   Input Parameters:
+  iface - the map
-  snes  - the solver, after its solve

   Output Parameters:
+  converged - whether it did
-  verdict   - converged, oscillation, stagnation, max_iterations, linear_solver, nan or diverged

   Level: intermediate

.seealso: `AbutInterfaceSetSNES()`
@*/
PetscErrorCode AbutInterfaceGetVerdict(AbutInterface iface, SNES snes, PetscBool *converged, const char *verdict[])
{
  SNESConvergedReason reason;

  PetscFunctionBegin;
  PetscCall(SNESGetConvergedReason(snes, &reason));
  *converged = (PetscBool)(reason > 0 && !iface->linearfailed);
  if (iface->linearfailed) *verdict = "linear_solver";
  else if (reason > 0) *verdict = "converged";
  else if (iface->failure) *verdict = iface->failure;
  else if (reason == SNES_DIVERGED_MAX_IT || reason == SNES_DIVERGED_FUNCTION_COUNT) *verdict = "max_iterations";
  else if (reason == SNES_DIVERGED_FNORM_NAN) *verdict = "nan";
  else *verdict = "diverged";
  PetscFunctionReturn(PETSC_SUCCESS);
}
