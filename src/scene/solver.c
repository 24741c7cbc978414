#include <abut/private/sceneimpl.h>
#include <abut/private/sysimpl.h>

/* The SNES of the scene: ddneumann by default, our tolerances, the user's options over them */

/* Gives an option that the user has left out a default of ours, while the options are read */
static PetscErrorCode AbutSceneDefault_Private(const char name[], const char value[], PetscBool *set)
{
  PetscBool has;

  PetscFunctionBegin;
  PetscCall(PetscOptionsHasName(NULL, NULL, name, &has));
  *set = (PetscBool)!has;
  if (*set) PetscCall(PetscOptionsSetValue(NULL, name, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Types of PETSc that work on parts of a mesh, or are made in C, or iterate without a test */
static const char *const AbutUnfitTypes[] = {SNESNGS,     SNESCOMPOSITE,        SNESSHELL, SNESPATCH, SNESASPIN, SNESNASM, SNESMS,
                                             SNESKSPONLY, SNESKSPTRANSPOSEONLY, NULL};

static PetscErrorCode AbutSceneReadSolver_Private(AbutScene scene)
{
  MPI_Comm comm   = PetscObjectComm((PetscObject)scene);
  PetscInt max_it = 0;

  PetscFunctionBegin;
  AbutCallOptions(comm, "snes_*", SNESSetFromOptions(scene->snes));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-snes_max_it", &max_it, NULL)); /* the SNES of PETSc 3.22 takes -1 for "the default" */
  AbutCheckInput(max_it >= 0, comm, "snes_max_it: %" PetscInt_FMT "; give a number from 0 up, for example 10000", max_it);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Anderson mixing on F has the mixing parameter of a relaxation: the automatic one. With ddneumann as its preconditioner it works on the left, where an
   iteration is one sweep; on the right, PETSc's default, it would be two. */
static PetscErrorCode AbutSceneAndersonOptions_Private(AbutScene scene)
{
  PetscBool   hasnpc, set;
  const char *name;
  char        value[64] = "left";
  PetscReal   gamma;

  PetscFunctionBegin;
  PetscCall(PetscOptionsHasName(NULL, NULL, "-npc_snes_type", &hasnpc));
  name = hasnpc ? "-snes_npc_side" : "-snes_anderson_beta";
  if (!hasnpc) {
    PetscCall(AbutInterfaceGetGamma(scene->iface, &gamma));
    PetscCall(PetscSNPrintf(value, sizeof(value), "%.16g", (double)gamma));
  }
  PetscCall(AbutSceneDefault_Private(name, value, &set));
  PetscCall(AbutSceneReadSolver_Private(scene));
  if (set) PetscCall(PetscOptionsClearValue(NULL, name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A cycle of one sweep has no use for the stop tests of a loop */
static PetscErrorCode AbutSceneCheckInterleave_Private(AbutScene scene)
{
  static const char *const keys[] = {"-snes_rtol", "-snes_max_it", "-snes_ddneumann_stop", "-snes_ddneumann_eps", NULL};
  PetscBool                has;

  PetscFunctionBegin;
  for (PetscInt i = 0; keys[i]; ++i) {
    PetscCall(PetscOptionsHasName(NULL, NULL, keys[i], &has));
    AbutCheckInput(!has, PetscObjectComm((PetscObject)scene),
                   "%s: of no use with scene_interleave, which makes its own test; give scene_eps_u instead", keys[i] + 1);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutSceneSolverFromOptions_Private(AbutScene scene)
{
  MPI_Comm  comm      = PetscObjectComm((PetscObject)scene);
  char      type[256] = SNESDDNEUMANN;
  PetscReal gamma;
  PetscBool hasgamma, unfit = PETSC_FALSE;
  PetscErrorCode (*create)(SNES);

  PetscFunctionBegin;
  PetscCall(AbutLoopRegisterAll());
  PetscCall(SNESCreate(comm, &scene->snes));
  PetscCall(SNESSetTolerances(scene->snes, 0., 1e-8, 0., 10000, 1000000000)); /* no absolute tolerance: it would depend on the units */
  PetscCall(PetscOptionsGetString(NULL, NULL, "-snes_type", type, sizeof(type), NULL));
  PetscCall(PetscFunctionListFind(SNESList, type, &create));
  AbutCheckInput(create, comm, "snes_type: there is no \"%s\"; the paper's loop is ddneumann, PETSc's are for example anderson, ngmres, qn",
                 type);
  for (PetscInt i = 0; AbutUnfitTypes[i] && !unfit; ++i) PetscCall(PetscStrcmp(type, AbutUnfitTypes[i], &unfit));
  AbutCheckInput(!unfit, comm,
                 "snes_type: %s does not suit the traces of a contact; give ddneumann, anderson, ngmres, qn, nrichardson or ncg", type);
  AbutCheckInput(!scene->interleave || !strcmp(type, SNESDDNEUMANN), comm,
                 "scene_interleave: needs -snes_type ddneumann; %s keeps a history that a new mesh makes void", type);
  if (scene->interleave) PetscCall(AbutSceneCheckInterleave_Private(scene));
  PetscOptionsBegin(comm, NULL, "Start and relaxation of the loop", NULL);
  PetscCall(AbutOptionsEnum(PetscOptionsObject, "-snes_ddneumann_start", "First trace", AbutStarts, &scene->start, NULL));
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-snes_ddneumann_gamma", "Relaxation of a sweep, whatever accelerates it", &gamma,
                            &hasgamma));
  PetscOptionsEnd();
  AbutCheckInput(!hasgamma || gamma >= 0., comm, "snes_ddneumann_gamma: %g; give a positive number, or 0 for 2/(2+C/theta)", (double)gamma);
  if (hasgamma) PetscCall(AbutInterfaceSetGamma(scene->iface, gamma));
  PetscCall(SNESSetType(scene->snes, SNESDDNEUMANN));
  if (!strcmp(type, SNESANDERSON)) PetscCall(AbutSceneAndersonOptions_Private(scene));
  else PetscCall(AbutSceneReadSolver_Private(scene));
  /* interleaved, a cycle is one bare iteration, and the scene itself tests the change of the traces */
  if (scene->interleave) PetscCall(SNESSetTolerances(scene->snes, 0., PETSC_DEFAULT, 0., 1, PETSC_DEFAULT));
  PetscCall(SNESSetNormSchedule(scene->snes,
                                scene->interleave ? SNES_NORM_NONE : SNES_NORM_ALWAYS)); /* without norms there would be no stop test */
  PetscFunctionReturn(PETSC_SUCCESS);
}
