#include <abut/private/sceneimpl.h>
#include <abut/private/adaptorimpl.h>

/* -scene_tol T: from one number, a relative error in the energy norm, all the others. Parts of T: the discretisation is what costs, so it
   gets most. At the edge of the contact the estimate may miss some of the error, most where a coarse mesh meets a fine one (measured on
   two layers from six pairs of first meshes with both estimators: the true error is 0.9 to 1.3 times the estimate). The solvers are cheap,
   and get parts of T^2: forces and energies suffer from their errors to first order, from those of the meshes only to second. */
#define ABUT_TOL_ESTIMATE 0.75
#define ABUT_TOL_PENALTY  0.125 /* where the loop wants a penalty */
#define ABUT_TOL_LOOP     0.02  /* of T^2 */
#define ABUT_TOL_LINEAR   1e-3  /* of T^2, in the residual: the error is some ten times that */
#define ABUT_TOL_CHECKS   0.2   /* balance of forces and energy identity, with iterative linear solvers */

/* Keys that would choose otherwise */
static PetscErrorCode AbutSceneCheckTolerance_Private(AbutScene scene)
{
  MPI_Comm  comm     = PetscObjectComm((PetscObject)scene);
  char      stop[32] = "";
  PetscBool paper;

  PetscFunctionBegin;
  AbutCheckInput(!scene->interleave, comm, "scene_tol: needs a loop that converges on each mesh; leave out scene_tol, or scene_interleave");
  PetscCall(PetscOptionsGetString(NULL, NULL, "-snes_ddneumann_stop", stop, sizeof(stop), NULL));
  PetscCall(PetscStrcasecmp(stop, "paper", &paper));
  AbutCheckInput(!paper, comm,
                 "scene_tol: the stop test of the paper is no test of the error; leave out scene_tol, or snes_ddneumann_stop");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Exact contact where the loop can; else the penalty that two layers on supports feel as its part of the tolerance, theta/C, and the
   relaxation that suits it */
static PetscErrorCode AbutSceneChoosePenalty_Private(AbutScene scene)
{
  PetscBool active, given;

  PetscFunctionBegin;
  if (!scene->snes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscObjectTypeCompare((PetscObject)scene->snes, SNESDDACTIVE, &active));
  for (PetscInt i = 0; i < scene->npairs; ++i) {
    PetscReal C[2];

    PetscCall(AbutPairGetCompliance(scene->pair[i], C));
    PetscCall(AbutPairSetTheta(scene->pair[i], active ? 0. : ABUT_TOL_PENALTY * scene->tol * (C[0] + C[1])));
  }
  if (active) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutInterfaceSetGamma(scene->iface, 0.));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-snes_ddneumann_gamma", &given)); /* read again on every mesh */
  if (given) PetscCall(PetscOptionsSetValue(NULL, "-snes_ddneumann_gamma", "0"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Everything that does not depend on the meshes; the loop's tolerance was set when the SNES was made, under the user's */
PetscErrorCode AbutSceneSetTolerance_Private(AbutScene scene)
{
  PetscReal target;

  PetscFunctionBegin;
  if (scene->tol <= 0.) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutSceneCheckTolerance_Private(scene));
  PetscCall(AbutSceneChoosePenalty_Private(scene));
  PetscCall(AbutAdaptorClearBodies_Private(scene->adaptor));
  PetscCall(AbutAdaptorGetTarget(scene->adaptor, &target));
  if (target <= 0.) PetscCall(AbutAdaptorSetType(scene->adaptor, ABUTADAPTOREQUAL));
  PetscCall(AbutAdaptorSetTarget(scene->adaptor, ABUT_TOL_ESTIMATE * scene->tol));
  for (PetscInt b = 0; b < scene->nbodies; ++b) scene->estimates[b] = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the loop is to leave at most, unless the user says otherwise */
PetscReal AbutSceneLoopTolerance_Private(AbutScene scene)
{
  const PetscReal tolerance = scene->tol > 0. ? ABUT_TOL_LOOP * PetscSqr(scene->tol) : 1e-8;
  PetscReal       peak      = 0.;

  if (scene->adaptor) (void)AbutAdaptorGetPeak(scene->adaptor, &peak);
  return peak > 0. ? PetscMin(tolerance, ABUT_SHARE_PEAK * peak) : tolerance;
}

/* Is the linear solver of a body one that has a tolerance, and is it the user's? */
static PetscErrorCode AbutSceneGetKSP_Private(AbutScene scene, PetscInt b, KSP *ksp, PetscBool *iterates, PetscBool *given)
{
  const char *prefix;
  PetscBool   direct;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetKSP(scene->body[b], ksp));
  PetscCall(AbutBodyIsDirect(scene->body[b], &direct));
  PetscCall(KSPGetOptionsPrefix(*ksp, &prefix));
  PetscCall(PetscOptionsHasName(NULL, prefix, "-ksp_rtol", given));
  *iterates = (PetscBool)!direct;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After every set-up: a body may have grown too large for a direct solver */
PetscErrorCode AbutSceneSetLinearTolerance_Private(AbutScene scene)
{
  PetscFunctionBegin;
  if (scene->tol <= 0.) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt b = 0; b < scene->nbodies; ++b) {
    KSP       ksp;
    PetscReal rtol, abstol, dtol;
    PetscInt  max_it;
    PetscBool iterates, given;

    PetscCall(AbutSceneGetKSP_Private(scene, b, &ksp, &iterates, &given));
    if (iterates) scene->consistent = PetscMax(scene->consistent, ABUT_TOL_CHECKS * scene->tol);
    if (!iterates || given) continue;
    PetscCall(KSPGetTolerances(ksp, &rtol, &abstol, &dtol, &max_it));
    PetscCall(KSPSetTolerances(ksp, ABUT_TOL_LINEAR * PetscSqr(scene->tol), abstol, dtol, max_it));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keys of the scene that the tolerance puts aside */
static PetscErrorCode AbutSceneGetPutAside_Private(AbutScene scene, char keys[], size_t len)
{
  static const char *const other[] = {"-snes_ddneumann_gamma", "-adaptor_threshold", "-adaptor_target", "-adaptor_bodies"};
  char                     key[256];
  PetscBool                active = PETSC_TRUE, has;

  PetscFunctionBegin;
  keys[0] = 0;
  if (scene->snes) PetscCall(PetscObjectTypeCompare((PetscObject)scene->snes, SNESDDACTIVE, &active));
  for (PetscInt i = 0; i < 2 * scene->npairs; ++i) {
    const char *name;

    PetscCall(AbutPairGetName(scene->pair[i / 2], &name));
    PetscCall(PetscSNPrintf(key, sizeof(key), "-%s_pair_%s", name, i % 2 ? "theta" : "penalty"));
    PetscCall(PetscOptionsHasName(NULL, NULL, key, &has));
    if (!has) continue;
    PetscCall(PetscStrlcat(keys, keys[0] ? ", " : "", len));
    PetscCall(PetscStrlcat(keys, key + 1, len));
  }
  for (PetscInt i = active; i < (PetscInt)PETSC_STATIC_ARRAY_LENGTH(other); ++i) {
    PetscCall(PetscOptionsHasName(NULL, NULL, other[i], &has));
    if (!has) continue;
    PetscCall(PetscStrlcat(keys, keys[0] ? ", " : "", len));
    PetscCall(PetscStrlcat(keys, other[i] + 1, len));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What was chosen, in one line; what this puts aside, in another */
PetscErrorCode AbutSceneViewTolerance_Private(AbutScene scene, PetscViewer viewer)
{
  char      text[1024], keys[1024];
  PetscBool iterates, given, direct = PETSC_TRUE;
  PetscReal theta, rtol;

  PetscFunctionBegin;
  if (scene->tol <= 0.) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(text, sizeof(text), "scene_tol %g:", (double)scene->tol));
  for (PetscInt i = 0; i < scene->npairs; ++i) {
    const char *name;

    PetscCall(AbutPairGetTheta(scene->pair[i], &theta));
    PetscCall(AbutPairGetName(scene->pair[i], &name));
    if (theta > 0.) PetscCall(PetscSNPrintf(keys, sizeof(keys), " theta %.3g of %s,", (double)theta, name));
    else PetscCall(PetscStrncpy(keys, i ? "" : " theta 0 (exact contact),", sizeof(keys)));
    PetscCall(PetscStrlcat(text, keys, sizeof(text)));
  }
  if (scene->snes) {
    PetscCall(SNESGetTolerances(scene->snes, NULL, &rtol, NULL, NULL, NULL));
    PetscCall(PetscOptionsHasName(NULL, NULL, "-snes_rtol", &given));
    PetscCall(PetscSNPrintf(keys, sizeof(keys), " loop %.2g%s,", (double)rtol, given ? " (snes_rtol)" : ""));
    PetscCall(PetscStrlcat(text, keys, sizeof(text)));
  }
  for (PetscInt b = 0; b < scene->nbodies; ++b) {
    const char *name;
    KSP         ksp;

    PetscCall(AbutSceneGetKSP_Private(scene, b, &ksp, &iterates, &given));
    if (!iterates) continue;
    PetscCall(AbutBodyGetName(scene->body[b], &name));
    PetscCall(KSPGetTolerances(ksp, &rtol, NULL, NULL, NULL));
    PetscCall(PetscSNPrintf(keys, sizeof(keys), " linear %.2g of %s%s,", (double)rtol, name, given ? " (its ksp_rtol)" : ""));
    PetscCall(PetscStrlcat(text, keys, sizeof(text)));
    direct = PETSC_FALSE;
  }
  if (direct) PetscCall(PetscStrlcat(text, " linear direct,", sizeof(text)));
  PetscCall(PetscViewerASCIIPrintf(viewer, "%s estimate <= %g, all bodies adapted\n", text, (double)(ABUT_TOL_ESTIMATE * scene->tol)));
  PetscCall(AbutSceneGetPutAside_Private(scene, keys, sizeof(keys)));
  if (keys[0]) PetscCall(PetscViewerASCIIPrintf(viewer, "scene_tol: put aside %s\n", keys));
  PetscFunctionReturn(PETSC_SUCCESS);
}
