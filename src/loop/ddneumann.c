#include <abut/private/loopimpl.h> /*I "abutloop.h" I*/

/* The parallel Neumann scheme (20), (21) of the paper as a SNES: x <- x - gamma F(x), F(x) = x - G(x) */

typedef enum {
  ABUT_STOP_RESIDUAL,
  ABUT_STOP_PAPER
} AbutStop;

static const char *const AbutStops[] = {"residual", "paper", NULL};

typedef struct {
  PetscReal eps; /* the paper's eps_u */
  PetscInt  stop;
} SNES_DDNeumann;

static PetscErrorCode SNESSetUp_DDNeumann(SNES snes)
{
  PetscFunctionBegin;
  PetscCall(SNESSetWorkVecs(snes, 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SNESSetFromOptions_DDNeumann(SNES snes, AbutOptionItems PetscOptionsObject)
{
  SNES_DDNeumann *dd = (SNES_DDNeumann *)snes->data;
  PetscBool       set;

  PetscFunctionBegin;
  PetscOptionsHeadBegin(PetscOptionsObject, "SNES ddneumann options");
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-snes_ddneumann_eps", "Relative change of the paper's stop test", &dd->eps, &set));
  AbutCheckInput(!set || dd->eps > 0., PetscObjectComm((PetscObject)snes),
                 "snes_ddneumann_eps: %g; give a positive number, for example 0.0015", (double)dd->eps);
  PetscCall(AbutOptionsEnum(PetscOptionsObject, "-snes_ddneumann_stop", "Stop test", AbutStops, &dd->stop, NULL));
  PetscOptionsHeadEnd();
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SNESView_DDNeumann(SNES snes, PetscViewer viewer)
{
  SNES_DDNeumann *dd = (SNES_DDNeumann *)snes->data;
  AbutInterface   iface;
  PetscReal       gamma;
  PetscBool       ascii;

  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)viewer, PETSCVIEWERASCII, &ascii));
  if (!ascii) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscViewerASCIIPrintf(viewer, "  parallel Neumann scheme, stop test %s\n", AbutStops[dd->stop]));
  PetscCall(SNESGetApplicationContext(snes, &iface));
  if (!iface || (iface->spectrum && iface->largest == 0.)) PetscFunctionReturn(PETSC_SUCCESS); /* not known yet */
  PetscCall(AbutInterfaceGetGamma(iface, &gamma));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  relaxation gamma = %g\n", (double)gamma));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The paper's own test: the relative change of u_n in every body; 0/0 is not converged */
static PetscErrorCode SNESDDNeumannPaperStop_Private(SNES snes, AbutInterface iface, Vec step, Vec x)
{
  SNES_DDNeumann *dd = (SNES_DDNeumann *)snes->data;
  PetscReal       change;

  PetscFunctionBegin;
  PetscCall(AbutInterfaceGetChange(iface, step, x, &change));
  if (change <= dd->eps) snes->reason = SNES_CONVERGED_SNORM_RELATIVE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SNESSolve_DDNeumann(SNES snes)
{
  SNES_DDNeumann *dd = (SNES_DDNeumann *)snes->data;
  Vec             x = snes->vec_sol, F = snes->vec_func, step = snes->work[0];
  const PetscBool inner = (PetscBool)(snes->normschedule != SNES_NORM_ALWAYS); /* a preconditioner of another SNES: no tests, no monitors */
  AbutInterface   iface;
  PetscReal       gamma, fnorm = 0., xnorm, ynorm = 0.;

  PetscFunctionBegin;
  PetscCall(SNESGetApplicationContext(snes, &iface));
  PetscCheck(iface, PetscObjectComm((PetscObject)snes), PETSC_ERR_ARG_WRONGSTATE, "ddneumann needs AbutInterfaceSetSNES()");
  PetscCall(AbutInterfaceGetGamma(iface, &gamma));
  snes->reason = SNES_CONVERGED_ITERATING;
  iface->rate  = gamma; /* what the slowest mode of a sound loop loses in a sweep */
  for (PetscInt it = 0;; ++it) {
    snes->iter = it;
    if (inner && it == snes->max_its) break;
    PetscCall(SNESComputeFunction(snes, x, F));
    if (!inner) {
      PetscCall(VecNorm(F, NORM_2, &fnorm));
      SNESCheckFunctionNorm(snes, fnorm);
      PetscCall(VecNorm(x, NORM_2, &xnorm));
      snes->norm = fnorm;
      PetscCall(SNESLogConvergenceHistory(snes, fnorm, 0));
      PetscCall(SNESMonitor(snes, it, fnorm));
      PetscUseTypeMethod(snes, converged, it, xnorm, ynorm, fnorm, &snes->reason, snes->cnvP);
      if (snes->reason > 0 && dd->stop == ABUT_STOP_PAPER) snes->reason = SNES_CONVERGED_ITERATING;
      if (snes->reason) break;
    }
    if (!inner && it == snes->max_its) {
      snes->reason = SNES_DIVERGED_MAX_IT;
      break;
    }
    PetscCall(VecCopy(F, step));
    PetscCall(VecScale(step, -gamma));
    PetscCall(VecAXPY(x, 1., step)); /* eq. (21) */
    PetscCall(VecNorm(step, NORM_2, &ynorm));
    if (!inner && dd->stop == ABUT_STOP_PAPER) PetscCall(SNESDDNeumannPaperStop_Private(snes, iface, step, x));
    if (snes->reason) {
      ++snes->iter;
      break;
    }
  }
  if (inner && !snes->reason) {
    if (snes->normschedule == SNES_NORM_FINAL_ONLY) {
      PetscCall(SNESComputeFunction(snes, x, F));
      PetscCall(VecNorm(F, NORM_2, &snes->norm));
    }
    snes->reason = SNES_CONVERGED_ITS;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SNESDestroy_DDNeumann(SNES snes)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(snes->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*MC
   SNESDDNEUMANN - The paper's parallel Neumann domain decomposition, eqs. (17)-(21): one solve of every body, then relaxation

   Options Database Keys:
+  -snes_ddneumann_gamma <0>                   - relaxation; 0 means 2/(2+C/theta), see `AbutInterfaceGetGamma()`
.  -snes_ddneumann_gamma_spectrum <no,yes>     - the automatic one from computed eigenvalues, `AbutInterfaceGetSpectrum()`
.  -snes_ddneumann_start <winkler,nocontact,zero> - first trace, see `AbutInterfaceComputeStart()`
.  -snes_ddneumann_stop <residual,paper>       - the fixed-point residual with -snes_rtol, or the paper's relative change per sweep
-  -snes_ddneumann_eps <0.0015>                - the paper's eps_u

   Level: beginner

   Notes:
   Converges for gamma < 2/(1+C/theta); beyond that it ends with the verdict oscillation. As -npc_snes_type ddneumann with -npc_snes_max_it
   1 it preconditions PETSc's anderson, ngmres and qn; the relaxation is one for all, that of the map.

   The paper's test measures gamma times the error of the slow modes: with gamma 0.02 and 0.0015 an error of 7.5 % passes.

   Limits: theta > 0; the number of sweeps grows like 1/theta.

   Source: the paper, eqs. (17)-(21), Theorem 5.

.seealso: `SNESCreate()`, `AbutInterfaceSetSNES()`
M*/
PetscErrorCode SNESCreate_DDNeumann(SNES snes)
{
  SNES_DDNeumann *dd;

  PetscFunctionBegin;
  PetscCall(PetscNew(&dd));
  dd->eps                           = 0.0015;
  snes->data                        = dd;
  snes->ops->setup                  = SNESSetUp_DDNeumann;
  snes->ops->setfromoptions         = SNESSetFromOptions_DDNeumann;
  snes->ops->view                   = SNESView_DDNeumann;
  snes->ops->solve                  = SNESSolve_DDNeumann;
  snes->ops->destroy                = SNESDestroy_DDNeumann;
  snes->usesksp                     = PETSC_FALSE;
  snes->usesnpc                     = PETSC_FALSE;
  snes->alwayscomputesfinalresidual = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
