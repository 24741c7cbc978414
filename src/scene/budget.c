#include <abut/private/sceneimpl.h>

/* The error budget of a run: discretisation, penalty, loop, linear solvers, all relative and in the energy norm, so that they compare */

/* Estimates of single bodies -> one for all that are estimated, each weighed by its energy; and their energy norms */
PetscErrorCode AbutSceneGetDiscretisation_Private(AbutScene scene, PetscReal *error, PetscReal norm[])
{
  PetscReal sum[2] = {0., 0.};

  PetscFunctionBegin;
  for (PetscInt b = 0; b < scene->nbodies; ++b) {
    PetscReal energy, work, eta, eta_max;

    norm[b] = 0.;
    if (!scene->eta[b]) continue;
    PetscCall(AbutBodyGetEnergy(scene->body[b], &energy, &work));
    PetscCall(AbutEstimatorGetNorms(scene->body[b], scene->eta[b], &eta, &eta_max));
    norm[b] = PetscSqrtReal(2. * energy);
    sum[0] += PetscSqr(eta * norm[b]);
    sum[1] += PetscSqr(norm[b]);
  }
  *error = sum[1] > 0. ? PetscSqrtReal(sum[0] / sum[1]) : 0.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Names of the bodies of whose discretisation nothing is known */
static PetscErrorCode AbutSceneGetUnestimated_Private(AbutScene scene, char names[], size_t len)
{
  PetscFunctionBegin;
  names[0] = 0;
  for (PetscInt b = 0; b < scene->nbodies; ++b) {
    const char *name;

    if (scene->eta[b]) continue;
    PetscCall(AbutBodyGetName(scene->body[b], &name));
    if (names[0]) PetscCall(PetscStrlcat(names, " ", len));
    PetscCall(PetscStrlcat(names, name, len));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutSceneRecordBudget_Private(AbutScene scene)
{
  AbutRecorder rec = scene->recorder;
  PetscReal    force[ABUT_MAX_NAMES];
  char         names[4096];

  PetscFunctionBegin;
  PetscCall(AbutInterfaceGetErrors(scene->iface, &scene->errors, force));
  PetscCall(AbutSceneGetUnestimated_Private(scene, names, sizeof(names)));
  if (scene->estimator) PetscCall(AbutRecorderSetReal(rec, "error.discretisation", scene->discretisation));
  if (names[0]) PetscCall(AbutRecorderSetString(rec, "error.unestimated", names));
  if (scene->npairs) {
    PetscCall(AbutRecorderSetReal(rec, "error.penalty", scene->errors.penalty));
    PetscCall(AbutRecorderSetReal(rec, "error.loop", scene->errors.loop));
  }
  PetscCall(AbutRecorderSetReal(rec, "error.linear", scene->errors.linear));
  for (PetscInt i = 0; i < scene->npairs; ++i) {
    const char *name;
    char        key[256];

    PetscCall(AbutPairGetName(scene->pair[i], &name));
    PetscCall(PetscSNPrintf(key, sizeof(key), "pair.%s.force_penalty", name));
    PetscCall(AbutRecorderSetReal(rec, key, force[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutScenePrintBudget_Private(AbutScene scene)
{
  MPI_Comm comm = PetscObjectComm((PetscObject)scene);
  char     names[4096];

  PetscFunctionBegin;
  PetscCall(AbutSceneGetUnestimated_Private(scene, names, sizeof(names)));
  PetscCall(PetscPrintf(comm, "error in the energy norm: "));
  if (scene->estimator)
    PetscCall(PetscPrintf(comm, "discretisation %.2g%s%s%s, ", (double)scene->discretisation, names[0] ? " (without " : "", names,
                          names[0] ? ")" : ""));
  else PetscCall(PetscPrintf(comm, "discretisation not estimated, "));
  if (scene->npairs) PetscCall(PetscPrintf(comm, "penalty %.2g, loop %.2g, ", (double)scene->errors.penalty, (double)scene->errors.loop));
  PetscCall(PetscPrintf(comm, "linear %.2g\n", (double)scene->errors.linear));
  PetscFunctionReturn(PETSC_SUCCESS);
}
