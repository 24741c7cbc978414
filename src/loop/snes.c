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
  PetscCall(SNESRegister(SNESDDACTIVE, SNESCreate_DDActive));
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

#define ABUT_WINDOW 50 /* iterations over which the residual must have fallen, or two time constants of the slowest mode */

/* Beyond its limit the relaxation does not blow up, it wanders between open and overloaded contact: then the residuals of a window of
   iterations are not much below those of the window before, in the geometric mean, which one lucky iterate does not change. Half of what
   the slowest mode loses is asked for, or anything at all where that is not known. */
static PetscBool AbutInterfaceStagnates_Private(AbutInterface f, PetscInt it, PetscReal fnorm)
{
  const PetscInt window    = f->rate > 0. ? PetscMax(ABUT_WINDOW, (PetscInt)(2. / f->rate)) : 4 * ABUT_WINDOW;
  PetscBool      stagnates = PETSC_FALSE;

  if (!it) f->level[0] = f->level[1] = 0.;
  else if (it % window == 0) {
    const PetscReal fall = 1. - PetscPowRealInt(1. - PetscMin(f->rate, 1.), window);

    stagnates   = (PetscBool)(it >= 3 * window && f->level[0] - f->level[1] >= PetscLogReal(1. - 0.5 * fall));
    f->level[1] = f->level[0];
    f->level[0] = 0.;
  }
  f->level[0] += PetscLogReal(PetscMax(fnorm, PETSC_MACHINE_EPSILON * f->fnorm)) / window;
  return stagnates;
}

#define ABUT_INEXACT 10. /* errors of the bodies' linear solves pass up to so many times the tolerance */

/* Errors that iterative solvers leave in the bodies, in the energy norm, relative to the bodies' own energy or, where they only move, to
   one of a thousandth of their displacement. The loop does not see them: a solver that starts from the last displacement and is content
   with it leaves traces that stand still. */
static PetscErrorCode AbutInterfaceInexactness_Private(AbutInterface f, PetscReal *relative)
{
  PetscReal error2 = 0., energy2 = 0.;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < f->nbodies; ++b) {
    PetscReal strain, work, error, young, poisson, umax;
    PetscBool direct;

    PetscCall(AbutBodyGetEnergy(f->body[b], &strain, &work));
    PetscCall(AbutBodyGetMaterial(f->body[b], &young, &poisson));
    PetscCall(VecNorm(f->u[b], NORM_INFINITY, &umax));
    energy2 += 2. * strain + 1e-3 * young * umax * umax;
    PetscCall(AbutBodyIsDirect(f->body[b], &direct));
    if (direct) continue;
    PetscCall(AbutBodyGetLinearError(f->body[b], &error));
    error2 += error * error;
  }
  *relative = energy2 > 0. ? PetscSqrtReal(error2 / energy2) : 0.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutInterfaceGiveUp_Private(AbutInterface f, const char why[], SNESConvergedReason *reason)
{
  PetscFunctionBegin;
  f->failure = why;
  *reason    = SNES_DIVERGED_LOCAL_MIN;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Never the change per sweep, which is gamma times smaller than the error: the fixed-point residual of the traces and of the pressures.
   Where a plain relaxation no longer gets better it oscillates, unless what is left is the noise of the linear solves, which shows in the
   pressures first. */
static PetscErrorCode AbutInterfaceConverged_Private(SNES snes, PetscInt it, PETSC_UNUSED PetscReal xnorm, PETSC_UNUSED PetscReal ynorm,
                                                     PetscReal fnorm, SNESConvergedReason *reason, void *ctx)
{
  AbutInterface iface = (AbutInterface)ctx;
  PetscReal     rtol, divtol, inexactness;
  PetscBool     relaxation;

  PetscFunctionBegin;
  PetscCall(SNESGetTolerances(snes, NULL, &rtol, NULL, NULL, NULL));
  PetscCall(SNESGetDivergenceTolerance(snes, &divtol));
  if (!it) iface->fnorm = fnorm;
  *reason = SNES_CONVERGED_ITERATING;
  if (PetscIsInfOrNanReal(fnorm)) *reason = SNES_DIVERGED_FNORM_NAN;
  else if (iface->residual <= rtol && iface->pressureresidual <= rtol) {
    PetscCall(AbutInterfaceInexactness_Private(iface, &inexactness));
    if (inexactness <= ABUT_INEXACT * rtol) *reason = SNES_CONVERGED_FNORM_RELATIVE;
    else PetscCall(AbutInterfaceGiveUp_Private(iface, "stagnation", reason));
  } else if (divtol > 0. && fnorm > divtol * iface->fnorm) *reason = SNES_DIVERGED_DTOL;
  else if (AbutInterfaceStagnates_Private(iface, it, fnorm)) {
    PetscCall(PetscObjectTypeCompare((PetscObject)snes, SNESDDNEUMANN, &relaxation));
    PetscCall(AbutInterfaceInexactness_Private(iface, &inexactness));
    if (iface->residual <= PetscMax(rtol, ABUT_INEXACT * inexactness)) relaxation = PETSC_FALSE;
    PetscCall(AbutInterfaceGiveUp_Private(iface, relaxation ? "oscillation" : "stagnation", reason));
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
+  -snes_rtol <1e-8>                  - on |G(x)-x|/|G(x)|, and on the same of the pressures
-  -snes_divergence_tolerance <1e10> - on |G(x)-x| relative to the first one; 1e4 in a `SNES` of your own

   Level: intermediate

   Notes:
   Call it again after the meshes have changed. There is no absolute tolerance: it would depend on the units.

   With errors of more than ten times this in the linear solves of the bodies a loop has not converged, whatever its residual says: its
   verdict is stagnation.

   PETSc's anderson, when nothing preconditions it, gets the relaxation of a sweep for its `-snes_anderson_beta`, unless that is given.

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
  PetscCall(AbutInterfaceSetMixing_Private(iface, snes));
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
    PetscInt t = 0;

    while (iface->owned[k] >= iface->offset[t + 1]) ++t;
    sum[2 * iface->bodyof[t]] += PetscSqr(s[k]);
    sum[2 * iface->bodyof[t] + 1] += PetscSqr(v[k]);
  }
  PetscCall(VecRestoreArrayRead(step, &s));
  PetscCall(VecRestoreArrayRead(x, &v));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, (PetscMPIInt)(2 * iface->nbodies), MPIU_REAL, MPIU_SUM,
                             PetscObjectComm((PetscObject)iface)));
  *change = 0.;
  for (PetscInt t = 0; t < 2 * iface->npairs; ++t) { /* a body that is in no pair has no trace to change */
    const PetscInt b = iface->bodyof[t];

    if (b < 0) continue;
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
-  verdict   - converged, oscillation, stagnation, cycling, floating, max_iterations, linear_solver, nan or diverged

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

/* The verdict floating has a body and a motion */
PetscErrorCode AbutInterfaceSetFloating_Private(AbutInterface iface, PetscInt body, PetscInt mode)
{
  const char *name;
  char        motion[128];

  PetscFunctionBegin;
  PetscCall(AbutBodyGetName(iface->body[body], &name));
  PetscCall(AbutBodyGetFreeModeName(iface->body[body], mode, motion, sizeof(motion)));
  PetscCall(PetscSNPrintf(iface->floating, sizeof(iface->floating), "%s: contact does not hold this body, it is free in %s", name, motion));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutInterfaceGetFloating - Which body the verdict floating means, and in which motion

   Not Collective

   Input Parameter:
.  iface - the map

   Output Parameter:
.  text - a sentence for people, empty if there is no such body; owned by the map

   Level: intermediate

.seealso: `AbutInterfaceGetVerdict()`, `SNESDDACTIVE`
@*/
PetscErrorCode AbutInterfaceGetFloating(AbutInterface iface, const char *text[])
{
  PetscFunctionBegin;
  *text = iface->floating;
  PetscFunctionReturn(PETSC_SUCCESS);
}
