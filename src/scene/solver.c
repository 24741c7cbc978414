#include <abut/private/sceneimpl.h>
#include <abut/private/sysimpl.h>

/* The SNES of the scene: ddactive by default, our tolerances, the user's options over them */

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

/* Anderson mixing over ddneumann works on the left, where an iteration is one sweep; on the right, PETSc's default, it would be two */
static PetscErrorCode AbutSceneAndersonOptions_Private(AbutScene scene)
{
  PetscBool hasnpc, set = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(PetscOptionsHasName(NULL, NULL, "-npc_snes_type", &hasnpc));
  if (hasnpc) PetscCall(AbutSceneDefault_Private("-snes_npc_side", "left", &set));
  PetscCall(AbutSceneReadSolver_Private(scene));
  if (set) PetscCall(PetscOptionsClearValue(NULL, "-snes_npc_side"));
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

/* A loop on the traces needs pressures that follow from them, and bodies that each have a solution of their own */
PetscErrorCode AbutSceneCheckLoop_Private(AbutScene scene)
{
  MPI_Comm    comm = PetscObjectComm((PetscObject)scene);
  const char *type;

  PetscFunctionBegin;
  if (!scene->snes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESGetType(scene->snes, &type));
  if (!strcmp(type, SNESDDACTIVE)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < scene->npairs; ++i) {
    const char *name;
    PetscReal   theta;

    PetscCall(AbutPairGetName(scene->pair[i], &name));
    PetscCall(AbutPairGetTheta(scene->pair[i], &theta));
    AbutCheckInput(theta > 0., comm,
                   "snes_type: %s needs a penalty, and that of %s is 0, exact contact; give a positive %s_pair_penalty, for example "
                   "0.05, or -snes_type ddactive",
                   type, name, name);
  }
  for (PetscInt b = 0; b < scene->nbodies; ++b) {
    const char *name;
    char        motion[128] = "";
    PetscInt    free;

    PetscCall(AbutBodyGetName(scene->body[b], &name));
    PetscCall(AbutBodyGetFreeModeCount(scene->body[b], &free));
    if (free) PetscCall(AbutBodyGetFreeModeName(scene->body[b], 0, motion, sizeof(motion)));
    AbutCheckInput(!free, comm,
                   "snes_type: %s needs bodies that are held, and %s is free in %s; prescribe this, or give -snes_type ddactive", type,
                   name, motion);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutSceneSolverFromOptions_Private(AbutScene scene)
{
  MPI_Comm  comm      = PetscObjectComm((PetscObject)scene);
  char      type[256] = SNESDDACTIVE;
  PetscBool named, unfit = PETSC_FALSE;
  PetscErrorCode (*create)(SNES);

  PetscFunctionBegin;
  PetscCall(AbutLoopRegisterAll());
  PetscCall(SNESCreate(comm, &scene->snes));
  PetscCall(SNESSetApplicationContext(scene->snes, scene->iface));
  /* no absolute tolerance: it would depend on the units */
  PetscCall(SNESSetTolerances(scene->snes, 0., AbutSceneLoopTolerance_Private(scene), 0., 10000, 1000000000));
  PetscCall(SNESSetDivergenceTolerance(scene->snes, 1e10)); /* a trace without contact may be a thousandth of one with too much of it */
  if (scene->interleave) PetscCall(PetscStrncpy(type, SNESDDNEUMANN, sizeof(type))); /* a sweep a cycle is the paper's */
  PetscCall(PetscOptionsGetString(NULL, NULL, "-snes_type", type, sizeof(type), &named));
  PetscCall(PetscFunctionListFind(SNESList, type, &create));
  AbutCheckInput(create, comm,
                 "snes_type: there is no \"%s\"; the fast loop is ddactive, the paper's is ddneumann, PETSc's are for example anderson, "
                 "ngmres, qn",
                 type);
  for (PetscInt i = 0; AbutUnfitTypes[i] && !unfit; ++i) PetscCall(PetscStrcmp(type, AbutUnfitTypes[i], &unfit));
  AbutCheckInput(!unfit, comm,
                 "snes_type: %s does not suit the traces of a contact; give ddactive, ddneumann, anderson, ngmres, qn, nrichardson or ncg",
                 type);
  AbutCheckInput(!scene->interleave || !strcmp(type, SNESDDNEUMANN), comm,
                 "scene_interleave: needs -snes_type ddneumann; %s keeps a history that a new mesh makes void", type);
  if (scene->interleave) PetscCall(AbutSceneCheckInterleave_Private(scene));
  /* a scene of the paper's loop may be run with -snes_type ddactive; by default its keys would do nothing, and so stay unread */
  if (named || strcmp(type, SNESDDACTIVE)) {
    PetscOptionsBegin(comm, NULL, "Start of the loop", NULL);
    PetscCall(AbutOptionsEnum(PetscOptionsObject, "-snes_ddneumann_start", "First trace", AbutStarts, &scene->start, NULL));
    PetscOptionsEnd();
    PetscCall(AbutInterfaceSetGammaFromOptions(scene->iface));
  }
  PetscCall(AbutInterfaceSetFromOptions(scene->iface));
  PetscCall(SNESSetType(scene->snes, scene->interleave ? SNESDDNEUMANN : SNESDDACTIVE));
  if (!strcmp(type, SNESANDERSON)) PetscCall(AbutSceneAndersonOptions_Private(scene));
  else PetscCall(AbutSceneReadSolver_Private(scene));
  /* interleaved, a cycle is one bare iteration, and the scene itself tests the change of the traces */
  if (scene->interleave) PetscCall(SNESSetTolerances(scene->snes, 0., PETSC_DEFAULT, 0., 1, PETSC_DEFAULT));
  /* without norms there would be no stop test */
  PetscCall(SNESSetNormSchedule(scene->snes, scene->interleave ? SNES_NORM_NONE : SNES_NORM_ALWAYS));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What there is to say of the relaxation before the first loop */
PetscErrorCode AbutScenePrintGamma_Private(AbutScene scene)
{
  char      text[256];
  PetscBool active;

  PetscFunctionBegin;
  if (!scene->snes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscObjectTypeCompare((PetscObject)scene->snes, SNESDDACTIVE, &active));
  if (active) PetscFunctionReturn(PETSC_SUCCESS); /* relaxes nothing */
  PetscCall(AbutInterfaceJudgeGamma(scene->iface, text, sizeof(text)));
  if (text[0]) PetscCall(PetscPrintf(PetscObjectComm((PetscObject)scene), "%s\n", text));
  PetscFunctionReturn(PETSC_SUCCESS);
}
