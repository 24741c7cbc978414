#include <abut/private/sceneimpl.h>

/* Which ranks have which body: every body on all of them, or each on its own, by their unknowns. Bodies on ranks of their own are
   assembled, factored and solved at the same time. */

#define ABUT_UNEVEN 1.15 /* bodies move when this many times the unknowns that the busiest rank could have are on one */

typedef struct {
  PetscMPIInt first, n;
} AbutRanks;

PetscErrorCode AbutSceneSplitFromOptions_Private(AbutScene scene, AbutOptionItems PetscOptionsObject)
{
  PetscMPIInt size;

  PetscFunctionBegin;
  PetscCall(AbutOptionsBool(PetscOptionsObject, "-scene_split", "Every body on ranks of its own", &scene->split, NULL));
  PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)scene), &size));
  if (size == 1) scene->split = PETSC_FALSE; /* there is nothing to share */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At least as many ranks as bodies: each body gets one, and every further rank goes to the body that has most unknowns a rank */
static void AbutSplitRanks_Private(PetscInt nbodies, const PetscReal unknowns[], PetscMPIInt size, AbutRanks ranks[])
{
  for (PetscInt b = 0; b < nbodies; ++b) ranks[b].n = 1;
  for (PetscMPIInt r = (PetscMPIInt)nbodies; r < size; ++r) {
    PetscInt most = 0;

    for (PetscInt b = 1; b < nbodies; ++b)
      if (unknowns[b] * ranks[most].n > unknowns[most] * ranks[b].n) most = b;
    ++ranks[most].n;
  }
  ranks[0].first = 0;
  for (PetscInt b = 1; b < nbodies; ++b) ranks[b].first = ranks[b - 1].first + ranks[b - 1].n;
}

/* Fewer ranks than bodies: the largest body that has no rank yet goes to the rank that has fewest unknowns */
static void AbutSplitBodies_Private(PetscInt nbodies, const PetscReal unknowns[], PetscMPIInt size, PetscReal load[], AbutRanks ranks[])
{
  for (PetscMPIInt r = 0; r < size; ++r) load[r] = 0.;
  for (PetscInt b = 0; b < nbodies; ++b) ranks[b].n = 0;
  for (PetscInt k = 0; k < nbodies; ++k) {
    PetscInt    largest = -1;
    PetscMPIInt least   = 0;

    for (PetscInt b = 0; b < nbodies; ++b)
      if (!ranks[b].n && (largest < 0 || unknowns[b] > unknowns[largest])) largest = b;
    for (PetscMPIInt r = 1; r < size; ++r)
      if (load[r] < load[least]) least = r;
    ranks[largest] = (AbutRanks){.first = least, .n = 1};
    load[least] += unknowns[largest];
  }
}

/* Unknowns of the rank that has most */
static PetscReal AbutSplitBusiest_Private(PetscInt nbodies, const PetscReal unknowns[], PetscMPIInt size, PetscReal load[],
                                          const AbutRanks ranks[])
{
  PetscReal most = 0.;

  for (PetscMPIInt r = 0; r < size; ++r) load[r] = 0.;
  for (PetscInt b = 0; b < nbodies; ++b)
    for (PetscMPIInt r = ranks[b].first; r < ranks[b].first + ranks[b].n; ++r) load[r] += unknowns[b] / ranks[b].n;
  for (PetscMPIInt r = 0; r < size; ++r) most = PetscMax(most, load[r]);
  return most;
}

/* Of the present mesh, or about those that the first one will have */
static PetscErrorCode AbutSceneCountUnknowns_Private(AbutScene scene, PetscBool first, PetscReal unknowns[])
{
  PetscFunctionBegin;
  for (PetscInt b = 0; b < scene->nbodies; ++b) {
    AbutMesh mesh;
    PetscInt n;

    PetscCall(AbutBodyGetMesh(scene->body[b], &mesh));
    if (first) PetscCall(AbutMeshGetFirstSize(mesh, &unknowns[b]));
    else {
      PetscCall(AbutMeshSetUp(mesh));
      PetscCall(AbutBodyGetSize(scene->body[b], &n));
      unknowns[b] = n;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the bodies their ranks, before there are meshes (first) and whenever these have changed; a little unevenness is cheaper than
   moving a mesh */
PetscErrorCode AbutSceneSplit_Private(AbutScene scene, PetscBool first)
{
  PetscReal     unknowns[ABUT_MAX_NAMES], *load;
  AbutRanks     now[ABUT_MAX_NAMES], wanted[ABUT_MAX_NAMES];
  PetscMPIInt   size;
  PetscLogEvent event;

  PetscFunctionBegin;
  if (!scene->split) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)scene), &size));
  PetscCall(AbutLogEventGet("AbutSplit", ABUTSCENE_CLASSID, &event));
  PetscCall(PetscLogEventBegin(event, scene, 0, 0, 0));
  PetscCall(AbutSceneCountUnknowns_Private(scene, first, unknowns));
  PetscCall(PetscMalloc1(size, &load));
  if (size >= scene->nbodies) AbutSplitRanks_Private(scene->nbodies, unknowns, size, wanted);
  else AbutSplitBodies_Private(scene->nbodies, unknowns, size, load, wanted);
  for (PetscInt b = 0; b < scene->nbodies; ++b) {
    AbutMesh mesh;

    PetscCall(AbutBodyGetMesh(scene->body[b], &mesh));
    PetscCall(AbutMeshGetRanks(mesh, &now[b].first, &now[b].n));
  }
  if (first || AbutSplitBusiest_Private(scene->nbodies, unknowns, size, load, now) >
                 ABUT_UNEVEN * AbutSplitBusiest_Private(scene->nbodies, unknowns, size, load, wanted))
    for (PetscInt b = 0; b < scene->nbodies; ++b)
      if (wanted[b].first != now[b].first || wanted[b].n != now[b].n)
        PetscCall(AbutBodySetRanks(scene->body[b], wanted[b].first, wanted[b].n));
  PetscCall(PetscFree(load));
  PetscCall(PetscLogEventEnd(event, scene, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
