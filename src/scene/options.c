#include <abut/private/sceneimpl.h> /*I "abutscene.h" I*/

/* What a scene names is made, and only that */

static const char *const AbutReservedNames[] = {"scene",   "snes",    "npc",       "ksp",        "pc",      "mat",    "vec",
                                                "dm",      "adaptor", "estimator", "record",     "output",  "plugin", "log",
                                                "options", "malloc",  "help",      "checkpoint", "restart", NULL};

/* A comma-separated list of names; names are prefixes of keys, so no two may be equal, nor equal to the prefix of a class */
PetscErrorCode AbutSceneReadNames_Private(AbutScene scene, AbutOptionItems PetscOptionsObject, const char opt[], const char text[],
                                          PetscInt *n, char *names[])
{
  MPI_Comm  comm = PetscObjectComm((PetscObject)scene);
  PetscBool given, match;

  PetscFunctionBegin;
  *n = ABUT_MAX_NAMES;
  PetscCall(PetscOptionsStringArray(opt, text, NULL, names, n, &given));
  if (!given) *n = 0;
  for (PetscInt i = 0; i < *n; ++i) {
    const char *at = names[i];

    AbutCheckInput((*at >= 'a' && *at <= 'z') || (*at >= 'A' && *at <= 'Z'), comm, "%s: \"%s\" is not a name; begin with a letter", opt + 1,
                   at);
    for (; *at; ++at)
      AbutCheckInput((*at >= 'a' && *at <= 'z') || (*at >= 'A' && *at <= 'Z') || (*at >= '0' && *at <= '9'), comm,
                     "%s: \"%s\" is not a name; use letters and digits", opt + 1, names[i]);
    for (PetscInt r = 0; AbutReservedNames[r]; ++r) {
      PetscCall(PetscStrcasecmp(names[i], AbutReservedNames[r], &match));
      AbutCheckInput(!match, comm, "%s: \"%s\" begins keys of its own; take another name", opt + 1, names[i]);
    }
    for (PetscInt j = 0; j < i; ++j) {
      PetscCall(PetscStrcasecmp(names[i], names[j], &match));
      AbutCheckInput(!match, comm, "%s: \"%s\" stands twice (names are compared without case); take different names", opt + 1, names[i]);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a scene names */
typedef enum {
  ABUT_NAMES_BODIES,
  ABUT_NAMES_EFFECTS,
  ABUT_NAMES_PAIRS,
  ABUT_NAMES_PROBES,
  ABUT_NAMES
} AbutNameKind;

typedef struct {
  PetscInt n;
  char    *name[ABUT_MAX_NAMES];
} AbutNames;

static PetscErrorCode AbutSceneCheckDistinct_Private(AbutScene scene, const AbutNames *some, const AbutNames *others)
{
  PetscBool match;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < some->n; ++i)
    for (PetscInt j = 0; j < others->n; ++j) {
      PetscCall(PetscStrcasecmp(some->name[i], others->name[j], &match));
      AbutCheckInput(!match, PetscObjectComm((PetscObject)scene),
                     "scene: the name \"%s\" is given to two things; bodies, effects, pairs and probes need different names",
                     some->name[i]);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutSceneReadAllNames_Private(AbutScene scene, AbutOptionItems PetscOptionsObject, AbutNames all[ABUT_NAMES])
{
  static const char *const opt[ABUT_NAMES]  = {"-scene_bodies", "-scene_effects", "-scene_pairs", "-scene_probes"};
  static const char *const text[ABUT_NAMES] = {"Names of the bodies", "Names of what acts on them", "Names of the possible contacts",
                                               "Names of the points of the record"};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < ABUT_NAMES; ++k)
    PetscCall(AbutSceneReadNames_Private(scene, PetscOptionsObject, opt[k], text[k], &all[k].n, all[k].name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bodies, what acts on them, and what they meet; effects come before pairs, which ask the bodies what they are */
static PetscErrorCode AbutSceneMakeNamed_Private(AbutScene scene, AbutNames all[ABUT_NAMES])
{
  MPI_Comm comm = PetscObjectComm((PetscObject)scene);

  PetscFunctionBegin;
  for (PetscInt i = 0; i < ABUT_NAMES; ++i)
    for (PetscInt j = i + 1; j < ABUT_NAMES; ++j) PetscCall(AbutSceneCheckDistinct_Private(scene, &all[i], &all[j]));
  for (PetscInt i = 0; i < all[ABUT_NAMES_BODIES].n; ++i) {
    PetscCall(AbutBodyCreate(comm, all[ABUT_NAMES_BODIES].name[i], &scene->body[scene->nbodies++]));
    PetscCall(AbutBodySetFromOptions(scene->body[i]));
  }
  for (PetscInt i = 0; i < all[ABUT_NAMES_EFFECTS].n; ++i) {
    PetscCall(AbutEffectCreate(comm, all[ABUT_NAMES_EFFECTS].name[i], &scene->effect[scene->neffects++]));
    PetscCall(AbutEffectSetFromOptions(scene->effect[i], scene->nbodies, scene->body));
  }
  for (PetscInt i = 0; i < all[ABUT_NAMES_PAIRS].n; ++i) {
    PetscCall(AbutPairCreate(comm, all[ABUT_NAMES_PAIRS].name[i], &scene->pair[scene->npairs++]));
    PetscCall(AbutPairSetFromOptions(scene->pair[i], scene->nbodies, scene->body));
  }
  PetscCall(AbutSceneProbesFromOptions_Private(scene, all[ABUT_NAMES_PROBES].n, all[ABUT_NAMES_PROBES].name));
  for (PetscInt k = 0; k < ABUT_NAMES; ++k)
    for (PetscInt i = 0; i < all[k].n; ++i) PetscCall(PetscFree(all[k].name[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The estimator runs on the bodies of the adaptor, or on all; an adaptor without an estimator gets the default one */
static PetscErrorCode AbutSceneErrorFromOptions_Private(AbutScene scene, PetscBool adapts, PetscBool estimates)
{
  MPI_Comm           comm  = PetscObjectComm((PetscObject)scene);
  const char *const *names = NULL;
  PetscInt           n     = 0;

  PetscFunctionBegin;
  if (adapts) {
    PetscCall(AbutAdaptorCreate(comm, &scene->adaptor));
    PetscCall(AbutAdaptorSetFromOptions(scene->adaptor));
    PetscCall(AbutAdaptorGetBodies(scene->adaptor, &n, &names));
  }
  if (adapts || estimates) {
    PetscCall(AbutEstimatorCreate(comm, &scene->estimator));
    PetscCall(AbutEstimatorSetFromOptions(scene->estimator));
  }
  for (PetscInt b = 0; b < scene->nbodies; ++b) scene->estimates[b] = (PetscBool)(scene->estimator && !n);
  for (PetscInt i = 0; i < n; ++i) {
    AbutBody body;

    PetscCall(AbutSceneGetBody(scene, names[i], &body));
    AbutCheckInput(body, comm, "adaptor_bodies: the scene has no body \"%s\"; give names from scene_bodies", names[i]);
    for (PetscInt b = 0; b < scene->nbodies; ++b)
      if (scene->body[b] == body) scene->estimates[b] = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the loop leaves moves the edges that the next meshes follow: on two layers of order 4, some 3500 unknowns, a tenth of the estimated
   error puts the force off by 7e-6, 0.03 by 1.4e-7, and 0.003 by 1.0e-7 as does less; each step takes about a sweep more on a mesh */
#define ABUT_SHARE_FOLLOWING 0.003

/* How far and from where the loop is to run on meshes that are going to be refined; keys that would have no effect stay unread, and so
   are errors */
static PetscErrorCode AbutSceneCyclesFromOptions_Private(AbutScene scene)
{
  PetscBool active, follows;

  PetscFunctionBegin;
  PetscCall(AbutSceneFollows_Private(scene, &follows));
  if (follows) scene->loop_share = ABUT_SHARE_FOLLOWING;
  PetscCall(PetscObjectTypeCompare((PetscObject)scene->snes, SNESDDACTIVE, &active));
  PetscObjectOptionsBegin((PetscObject)scene);
  if (active)
    PetscCall(AbutOptionsReal(PetscOptionsObject, "-scene_loop_share", "Part of the estimated error that the loop may leave",
                              &scene->loop_share, NULL));
  PetscCall(AbutOptionsBool(PetscOptionsObject, "-scene_cold", "No trace from the last mesh", &scene->cold, NULL));
  PetscOptionsEnd();
  AbutCheckInput(scene->loop_share >= 0. && scene->loop_share < 1., PetscObjectComm((PetscObject)scene),
                 "scene_loop_share: %g; give a number from 0 up and below 1, for example 0.3", (double)scene->loop_share);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A peak wants a loop that leaves less than it, and both bodies as fine as each other */
static PetscErrorCode AbutSceneCheckPeak_Private(AbutScene scene)
{
  MPI_Comm  comm = PetscObjectComm((PetscObject)scene);
  PetscReal peak, rtol;

  PetscFunctionBegin;
  PetscCall(AbutAdaptorGetPeak(scene->adaptor, &peak));
  if (peak <= 0.) PetscFunctionReturn(PETSC_SUCCESS);
  AbutCheckInput(!scene->interleave, comm, "adaptor_peak: needs a loop that converges on each mesh; leave it out, or scene_interleave");
  PetscCall(SNESGetTolerances(scene->snes, NULL, &rtol, NULL, NULL, NULL));
  AbutCheckInput(ABUT_SHARE_PEAK * peak >= rtol * (1. - 1e-9), comm,
                 "adaptor_peak: %g is below what the loop leaves; give at least %g, or snes_rtol at most %g", (double)peak,
                 (double)(rtol / ABUT_SHARE_PEAK), (double)(ABUT_SHARE_PEAK * peak));
  for (PetscInt i = 0; i < scene->npairs; ++i) {
    AbutBody bodies[2];
    PetscInt sides[2];

    PetscCall(AbutPairGetBodies(scene->pair[i], bodies, sides));
    for (PetscInt b = 0; b < scene->nbodies; ++b) {
      const char *name;

      PetscCall(AbutBodyGetName(scene->body[b], &name));
      AbutCheckInput(scene->estimates[b] || (scene->body[b] != bodies[0] && scene->body[b] != bodies[1]), comm,
                     "adaptor_peak: %s is in contact and not in adaptor_bodies; adapt both bodies of each pair, or leave it out", name);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A vertex that moves takes the hanging ones on its sides along, which knows no chains of them */
static PetscErrorCode AbutSceneCheckFollow_Private(AbutScene scene)
{
  PetscBool follows, balance;

  PetscFunctionBegin;
  PetscCall(AbutAdaptorFollows(scene->adaptor, 1, &follows)); /* meshes without balance are of order 1 */
  for (PetscInt b = 0; b < scene->nbodies && follows; ++b) {
    AbutMesh    mesh;
    const char *name, *file;

    PetscCall(AbutBodyGetName(scene->body[b], &name));
    PetscCall(AbutBodyGetMesh(scene->body[b], &mesh));
    PetscCall(AbutMeshGetBalance(mesh, &balance));
    PetscCall(AbutMeshGetFile(mesh, &file));
    AbutCheckInput(!file || !scene->estimates[b], PetscObjectComm((PetscObject)scene),
                   "adaptor_follow: the mesh of %s is from a file and cannot move; leave it out, or give a box", name);
    AbutCheckInput(balance, PetscObjectComm((PetscObject)scene),
                   "adaptor_follow: a mesh without balance cannot move; leave it out, or %s_mesh_balance", name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Merged triangles are made again from the first mesh by the places of vertices on the grid of a box */
static PetscErrorCode AbutSceneCheckCoarsen_Private(AbutScene scene)
{
  PetscReal part;

  PetscFunctionBegin;
  PetscCall(AbutAdaptorGetCoarsening(scene->adaptor, &part));
  for (PetscInt b = 0; b < scene->nbodies && part > 0.; ++b) {
    AbutMesh    mesh;
    AbutShape   shape;
    const char *name, *file;

    PetscCall(AbutBodyGetName(scene->body[b], &name));
    PetscCall(AbutBodyGetMesh(scene->body[b], &mesh));
    PetscCall(AbutMeshGetFile(mesh, &file));
    PetscCall(AbutMeshGetShape(mesh, &shape));
    AbutCheckInput(!file || !scene->estimates[b] || shape == ABUT_QUAD, PetscObjectComm((PetscObject)scene),
                   "adaptor_coarsen: the triangles of %s are from a file and are not merged; leave it out, or give a file with quads",
                   name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keys of the adaptor that speak of contacts */
static PetscErrorCode AbutSceneCheckContactKeys_Private(AbutScene scene)
{
  const char *const key[] = {"-adaptor_jump", "-adaptor_follow", "-adaptor_settle", "-adaptor_peak", NULL};
  PetscBool         has, settles = PETSC_FALSE, follows;

  PetscFunctionBegin;
  for (PetscInt i = 0; key[i] && !scene->npairs; ++i) {
    PetscCall(PetscOptionsHasName(NULL, NULL, key[i], &has));
    AbutCheckInput(!has, PetscObjectComm((PetscObject)scene),
                   "%s: the scene has no pair, so there is no contact; give scene_pairs, or leave it out", key[i] + 1);
  }
  if (!scene->snes || !scene->adaptor) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutAdaptorSettles(scene->adaptor, &settles));
  PetscCall(AbutSceneFollows_Private(scene, &follows));
  PetscCall(AbutSceneCheckFollow_Private(scene));
  AbutCheckInput(!settles || follows, PetscObjectComm((PetscObject)scene),
                 "adaptor_settle: no mesh follows the edges of contacts; give adaptor_follow: true, or leave it out");
  PetscCall(AbutSceneCheckPeak_Private(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutSceneSetFromOptions - Reads a scene and makes what it names

   Collective

   Input Parameter:
.  scene - the scene

   Options Database Keys:
+  -scene_bodies <names>   - bodies, see `AbutBodyCreate()` for their keys
.  -scene_effects <names>  - what acts on them, see `AbutEffectSetFromOptions()`
.  -scene_pairs <names>    - possible contacts, see `AbutPairCreate()`
.  -scene_probes <names>   - points of the record: `-NAME_probe_body`, `-NAME_probe_point x,y`
.  -scene_interleave       - one sweep and one adaptation a cycle, Fig. 2 of the paper; needs ddneumann
.  -scene_loop_share <0.3>  - with an adaptor and ddactive: part of the estimated error that the loop may leave on a mesh to be refined; 0:
                              none; 0.003 by default where meshes follow edges (`-adaptor_follow`)
.  -record_time_ratio       - measures the processor time of the run in linear problems on its last mesh: `time.ratio`
.  -scene_cold              - with an adaptor: every mesh begins without the traces and forces of the last one
.  -scene_eps_u <0.0015>   - with it: the relative change of the traces at which the run ends
.  -scene_load_steps <f1,f2,...> - factors of all that is prescribed, one load step for each, see `AbutSceneSolve()`
.  -scene_split            - every body on ranks of its own, in proportion to its unknowns, or every rank with bodies of its own, and not
                              every body on all ranks; does nothing on one
.  -scene_tol T            - relative error in the energy norm to be reached: chooses theta, tolerances and refinement, see below
.  -adaptor_type, -estimator_type, -snes_* - what adapts, estimates, iterates; see `AbutAdaptorCreate()`, `AbutEstimatorCreate()`,
                                             `SNESDDNEUMANN`
-  -plugin <libraries>     - libraries with estimators of your own, see `AbutPluginAppendFromOptions()`

   Level: beginner

   Note:
   `-scene_tol` makes an estimator and an adaptor if the scene has none, estimates and adapts all bodies, and ends when the estimate of all
   together is at most three quarters of T: equal errors in all cells (`ABUTADAPTOREQUAL`), or `-adaptor_type doerfler`, whatever
   `-adaptor_threshold`, `-adaptor_target` and `-adaptor_bodies` say; the caps hold. ddactive then works with exact contact; other loops get
   a penalty whose part is about T/8, and the automatic relaxation. Tolerances of the loop and of iterative linear solvers follow from T,
   except where `-snes_rtol` or `-NAME_ksp_rtol` are given. A line says what was chosen.

.seealso: `AbutSceneSetUp()`, `AbutSceneSolve()`
@*/
PetscErrorCode AbutSceneSetFromOptions(AbutScene scene)
{
  MPI_Comm  comm = PetscObjectComm((PetscObject)scene);
  AbutNames names[ABUT_NAMES];
  char      type[64] = "";
  PetscBool adapts, estimates, profile, hastol;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(scene, ABUTSCENE_CLASSID, 1);
  PetscCall(AbutScenePhaseBegin_Private(ABUT_TIME_SETUP));
  PetscObjectOptionsBegin((PetscObject)scene);
  PetscCall(AbutSceneReadAllNames_Private(scene, PetscOptionsObject, names));
  PetscCall(AbutOptionsBool(PetscOptionsObject, "-scene_interleave", "One sweep and one adaptation a cycle", &scene->interleave, NULL));
  if (scene->interleave)
    PetscCall(AbutOptionsReal(PetscOptionsObject, "-scene_eps_u", "Relative change of the traces at the end", &scene->eps_u, NULL));
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-scene_tol", "Relative error in the energy norm to be reached", &scene->tol, &hastol));
  PetscCall(AbutOptionsBool(PetscOptionsObject, "-record_time_ratio", "Processor time in linear problems on the last mesh",
                            &scene->wantsratio, NULL));
  PetscCall(AbutSceneStepsFromOptions_Private(scene, PetscOptionsObject));
  PetscCall(AbutSceneSplitFromOptions_Private(scene, PetscOptionsObject));
  PetscCall(PetscOptionsString("-adaptor_type", "Type of the adaptor", NULL, type, type, sizeof(type), &adapts));
  PetscCall(PetscOptionsString("-estimator_type", "Type of the estimator", NULL, type, type, sizeof(type), &estimates));
  PetscOptionsEnd();
  PetscCall(AbutPluginAppendFromOptions(comm)); /* before any type is looked up */
  AbutCheckInput(!hastol || (scene->tol > 0. && scene->tol < 1.), comm,
                 "scene_tol: %g is not a relative error; give a number between 0 and 1, for example 0.01", (double)scene->tol);
  AbutCheckInput(scene->eps_u > 0., comm, "scene_eps_u: %g; give a positive number, for example 0.0015", (double)scene->eps_u);
  AbutCheckInput(names[ABUT_NAMES_BODIES].n > 0, comm,
                 "scene_bodies: missing; give the names of the bodies, or a scene file, for example examples/layers/layers.yml");
  PetscCall(AbutSceneMakeNamed_Private(scene, names));
  PetscCall(AbutInterfaceCreate(comm, scene->nbodies, scene->body, scene->npairs, scene->pair, &scene->iface));
  PetscCall(AbutSceneErrorFromOptions_Private(scene, (PetscBool)(adapts || hastol), estimates));
  if (scene->npairs) PetscCall(AbutSceneSolverFromOptions_Private(scene));
  PetscCall(AbutSceneSetTolerance_Private(scene));
  if (scene->npairs && scene->adaptor && !scene->interleave) PetscCall(AbutSceneCyclesFromOptions_Private(scene));
  AbutCheckInput(!scene->interleave || scene->adaptor, comm,
                 "scene_interleave: the scene has no adaptor; give adaptor_type, or leave scene_interleave out");
  if (scene->adaptor) PetscCall(AbutSceneCheckCoarsen_Private(scene));
  PetscCall(AbutSceneCheckContactKeys_Private(scene));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-output_profile", &profile));
  AbutCheckInput(!profile || scene->npairs, comm,
                 "output_profile: the scene has no pair to make a profile of; give scene_pairs, or leave it out");
  PetscCall(AbutRecorderCreate(comm, &scene->recorder));
  PetscCall(AbutRecorderSetFromOptions(scene->recorder));
  PetscCall(AbutRecorderSetPairs(scene->recorder, scene->iface, scene->npairs, scene->pair));
  PetscCall(AbutSceneCheckpointFromOptions_Private(scene));
  PetscCall(PetscLogStagePop());
  PetscFunctionReturn(PETSC_SUCCESS);
}
