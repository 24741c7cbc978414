#include <abut/private/sceneimpl.h>

/* What a run needs to go on after a cycle: how the meshes were refined, the traces and pressures that go over to the new ones, and what the
   record knows. Solving, estimating and marking again on these meshes gives what the run would have given. */

/*  -checkpoint FILE -checkpoint_every N, -restart FILE */
PetscErrorCode AbutSceneCheckpointFromOptions_Private(AbutScene scene)
{
  MPI_Comm  comm                        = PetscObjectComm((PetscObject)scene);
  char      path[2][PETSC_MAX_PATH_LEN] = {"", ""};
  PetscBool set[2];

  PetscFunctionBegin;
  scene->every = 1;
  PetscOptionsBegin(comm, NULL, "Checkpoints", NULL);
  PetscCall(AbutOptionsString(PetscOptionsObject, "-checkpoint", "File from which a run that was stopped can go on", path[0],
                              sizeof(path[0]), &set[0]));
  if (set[0]) PetscCall(AbutOptionsInt(PetscOptionsObject, "-checkpoint_every", "Cycles between two checkpoints", &scene->every, NULL));
  PetscCall(AbutOptionsString(PetscOptionsObject, "-restart", "File of a checkpoint to go on from", path[1], sizeof(path[1]), &set[1]));
  PetscOptionsEnd();
  for (PetscInt i = 0; i < 2; ++i)
    AbutCheckInput(!set[i] || path[i][0], comm, "%s: no file is named; give the name of a file", i ? "restart" : "checkpoint");
  AbutCheckInput(scene->adaptor || scene->nsteps > 1 || !(set[0] || set[1]), comm,
                 "%s: the scene has no adaptor, so it has one cycle and nothing to go on with; give adaptor_type or scene_load_steps, or "
                 "leave it out",
                 set[0] ? "checkpoint" : "restart");
  AbutCheckInput(scene->every > 0, comm, "checkpoint_every: %" PetscInt_FMT " is no number of cycles; give 1 or more", scene->every);
  if (set[0]) {
    PetscCall(AbutFileCheckPath(comm, "checkpoint", path[0]));
    PetscCall(PetscStrallocpy(path[0], &scene->checkpoint));
  }
  if (set[1]) PetscCall(AbutArchiveOpen(comm, "restart", path[1], &scene->restart));
  for (PetscInt b = 0; b < scene->nbodies && (set[0] || set[1]); ++b) {
    AbutMesh mesh;

    PetscCall(AbutBodyGetMesh(scene->body[b], &mesh));
    PetscCall(AbutMeshKeepJournal(mesh));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutSceneArchiveEdges_Private(AbutScene scene, AbutArchive ar)
{
  PetscBool reads;

  PetscFunctionBegin;
  PetscCall(AbutArchiveReads(ar, &reads));
  PetscCall(AbutArchiveCount(ar, "edges of contacts", &scene->nedges));
  if (reads) PetscCall(PetscMalloc1(scene->nedges, &scene->edge));
  for (PetscInt e = 0; e < scene->nedges; ++e) {
    AbutContactEdge *edge = &scene->edge[e];

    PetscCall(AbutArchiveInts(ar, "pair of an edge", 1, &edge->pair));
    PetscCall(AbutArchiveReals(ar, "place of an edge", 2, edge->x));
    AbutCheckInput(edge->pair >= 0 && edge->pair < scene->npairs, PetscObjectComm((PetscObject)scene),
                   "restart: the checkpoint is damaged: an edge of a contact is that of pair %" PetscInt_FMT, edge->pair);
    if (reads) PetscCall(AbutPairGetBodies(scene->pair[edge->pair], edge->body, edge->side));
  }
  PetscCall(AbutArchiveInts(ar, "tied vertices", scene->npairs, scene->tied));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where the run stands; stays: its next cycle is on the same meshes */
static PetscErrorCode AbutSceneArchiveNumbers_Private(AbutScene scene, AbutArchive ar, PetscBool *stays)
{
  PetscReal number[2 + ABUT_TIMES] = {scene->work, scene->discretisation};
  PetscInt  count[4]               = {scene->cycle + 1, scene->sweepsbefore, scene->settled, scene->x != NULL};
  PetscBool reads;

  PetscFunctionBegin;
  PetscCall(AbutArchiveReads(ar, &reads));
  for (PetscInt i = 0; i < ABUT_TIMES; ++i) number[2 + i] = scene->seconds[i];
  PetscCall(AbutArchiveInts(ar, "cycle", 4, count));
  PetscCall(AbutArchiveReals(ar, "work", 2 + ABUT_TIMES, number));
  *stays = (PetscBool)count[3];
  if (!reads) PetscFunctionReturn(PETSC_SUCCESS);
  scene->cycle          = count[0];
  scene->sweepsbefore   = count[1];
  scene->settled        = (PetscBool)count[2];
  scene->work           = number[0];
  scene->discretisation = number[1];
  for (PetscInt i = 0; i < ABUT_TIMES; ++i) {
    scene->seconds[i] += number[2 + i];
    scene->begun -= number[2 + i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The state at the beginning of a cycle, in or out */
static PetscErrorCode AbutSceneArchive_Private(AbutScene scene, AbutArchive ar)
{
  PetscInt  size[2] = {scene->nbodies, scene->npairs};
  PetscBool stays   = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(AbutArchiveInts(ar, "numbers of bodies and pairs", 2, size));
  AbutCheckInput(size[0] == scene->nbodies && size[1] == scene->npairs, PetscObjectComm((PetscObject)scene),
                 "restart: the checkpoint is of another scene: it has %" PetscInt_FMT " bodies and %" PetscInt_FMT
                 " pairs, this one %" PetscInt_FMT " and %" PetscInt_FMT,
                 size[0], size[1], scene->nbodies, scene->npairs);
  PetscCall(AbutSceneArchiveNumbers_Private(scene, ar, &stays));
  PetscCall(AbutSceneArchiveStep_Private(scene, ar));
  for (PetscInt b = 0; b < scene->nbodies; ++b) PetscCall(AbutBodyArchive(scene->body[b], ar));
  PetscCall(AbutSceneArchiveEdges_Private(scene, ar));
  PetscCall(AbutInterfaceArchive(scene->iface, ar));
  if (ar == scene->restart) PetscCall(AbutSceneSplit_Private(scene, PETSC_FALSE)); /* before anything is made on these meshes */
  if (stays) {
    PetscCall(AbutInterfaceSetUp(scene->iface));
    if (!scene->x) { /* it is being read */
      PetscCall(AbutInterfaceCreateVec(scene->iface, &scene->x));
      PetscCall(AbutInterfaceSetSNES(scene->iface, scene->snes));
    }
    PetscCall(AbutInterfaceArchiveTrace(scene->iface, ar, scene->x));
  }
  PetscCall(AbutRecorderArchive(scene->recorder, ar));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After a cycle that is not the last one */
PetscErrorCode AbutSceneCheckpoint_Private(AbutScene scene)
{
  AbutArchive   ar;
  PetscLogEvent event;

  PetscFunctionBegin;
  if (!scene->checkpoint || (scene->cycle + 1) % scene->every) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutLogEventGet("AbutCheckpoint", ABUTSCENE_CLASSID, &event));
  PetscCall(PetscLogEventBegin(event, scene, 0, 0, 0));
  PetscCall(AbutArchiveCreate(PetscObjectComm((PetscObject)scene), &ar));
  PetscCall(AbutSceneArchive_Private(scene, ar));
  PetscCall(AbutArchiveWrite(ar, scene->checkpoint));
  PetscCall(AbutArchiveDestroy(&ar));
  PetscCall(PetscLogEventEnd(event, scene, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Before the first cycle */
PetscErrorCode AbutSceneRestart_Private(AbutScene scene)
{
  PetscLogEvent event;

  PetscFunctionBegin;
  if (!scene->restart) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutLogEventGet("AbutRestart", ABUTSCENE_CLASSID, &event));
  PetscCall(PetscLogEventBegin(event, scene, 0, 0, 0));
  for (PetscInt b = 0; b < scene->nbodies; ++b) {
    AbutMesh mesh;

    PetscCall(AbutBodyGetMesh(scene->body[b], &mesh));
    PetscCall(AbutMeshSetUp(mesh));
  }
  PetscCall(AbutSceneArchive_Private(scene, scene->restart));
  PetscCall(AbutArchiveDestroy(&scene->restart));
  PetscCall(PetscLogEventEnd(event, scene, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
