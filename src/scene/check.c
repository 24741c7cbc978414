#include <abut/private/sceneimpl.h>

/* The self-check of every cycle: does the answer agree with itself? A run whose answer does not ends as `inconsistent`. */

static const struct {
  const char *key;
  PetscBool   ofloop; /* the loop leaves it, in proportion to its residual */
} AbutChecks[ABUT_CHECKS] = {
  [ABUT_CHECK_BALANCE] = {"check.balance",         PETSC_FALSE},
    [ABUT_CHECK_ENERGY] = {"check.energy",          PETSC_FALSE},
  [ABUT_CHECK_LINEAR] = {"residual.linear",       PETSC_FALSE},
    [ABUT_CHECK_CONTACT] = {"check.contact",         PETSC_FALSE},
  [ABUT_CHECK_TENSION] = {"check.tension",         PETSC_FALSE},
    [ABUT_CHECK_COMPLEMENTARITY] = {"check.complementarity", PETSC_TRUE },
  [ABUT_CHECK_PENETRATION] = {"check.penetration",     PETSC_TRUE },
    [ABUT_CHECK_FRICTION] = {"check.friction",        PETSC_TRUE }
};

/* What a loop may leave at a node: so many times its residual, which is a measure of energy, measured were up to 10; but slender bodies
   with a residual of 1e-8 were measured with 1e-5 at a node */
#define ABUT_CHECK_RESIDUALS 30.
#define ABUT_CHECK_NODE      1e-4

/* Every check is over all bodies and pairs: the largest counts */
void AbutSceneAddCheck_Private(AbutScene scene, AbutCheck check, PetscReal value)
{
  scene->check[check] = PetscMax(scene->check[check], value);
}

void AbutSceneBeginChecks_Private(AbutScene scene)
{
  for (PetscInt i = 0; i < ABUT_CHECKS; ++i) scene->check[i] = 0.;
  scene->wrong[0] = 0;
}

/* Records them; the first one that does not hold is kept for the last line of the run. What the loop leaves counts on the last mesh. */
PetscErrorCode AbutSceneEndChecks_Private(AbutScene scene, PetscBool last, PetscBool *consistent)
{
  PetscReal residual = 0., pressure = 0.;
  PetscInt  n = scene->npairs ? ABUT_CHECK_FRICTION : ABUT_CHECK_CONTACT;

  PetscFunctionBegin;
  *consistent = PETSC_TRUE;
  for (PetscInt i = 0; i < scene->npairs; ++i) {
    PetscBool friction;

    PetscCall(AbutPairGetFriction(scene->pair[i], &friction, NULL));
    if (friction) n = ABUT_CHECKS;
  }
  if (scene->npairs) PetscCall(AbutInterfaceGetResidual(scene->iface, &residual, &pressure));
  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal loop = AbutChecks[i].ofloop ? PetscMax(ABUT_CHECK_NODE, ABUT_CHECK_RESIDUALS * PetscMax(residual, pressure)) : 0.;
    const PetscReal most = PetscMax(scene->consistent, loop);

    PetscCall(AbutRecorderSetReal(scene->recorder, AbutChecks[i].key, scene->check[i]));
    if (scene->check[i] <= most || !*consistent || (AbutChecks[i].ofloop && !last)) continue;
    *consistent = PETSC_FALSE;
    PetscCall(PetscSNPrintf(scene->wrong, sizeof(scene->wrong), "%s is %.2g, and may be %.2g", AbutChecks[i].key, (double)scene->check[i],
                            (double)most));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
