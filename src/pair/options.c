#include <abut/private/bodyimpl.h>
#include <abut/private/sysimpl.h>
#include <abut/private/pairimpl.h> /*I "abutpair.h" I*/

/* The keys of a pair */

static const char *const AbutPressureSideNames[] = {"first", "second", "finer", NULL};

/* "a,b" -> two words */
static PetscErrorCode AbutPairSplit_Private(AbutPair pair, const char key[], const char text[], char first[], char second[], size_t len)
{
  const char *comma = strchr(text, ',');

  PetscFunctionBegin;
  AbutCheckInput(comma && !strchr(comma + 1, ',') && comma != text && comma[1], PetscObjectComm((PetscObject)pair),
                 "%s_pair_%s: \"%s\" is not two names; give them with a comma between, for example %s", ((PetscObject)pair)->name, key,
                 text, key[0] == 'b' ? "upper,lower" : "bottom,top");
  PetscCall(PetscStrncpy(first, text, PetscMin(len, (size_t)(comma - text) + 1)));
  while (*++comma == ' ') { }
  PetscCall(PetscStrncpy(second, comma, len));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutPairFindBodies_Private(AbutPair pair, const char text[], PetscInt nbodies, AbutBody bodies[])
{
  char names[2][128], all[ABUT_LIST] = "";

  PetscFunctionBegin;
  if (strchr(text, ',')) PetscCall(AbutPairSplit_Private(pair, "bodies", text, names[0], names[1], sizeof(names[0])));
  else {
    PetscCall(PetscStrncpy(names[0], text, sizeof(names[0])));
    names[1][0] = 0;
  }
  pair->body[1] = NULL;
  for (PetscInt s = 0; s < 2 && names[s][0]; ++s) {
    PetscCall(AbutBodyFind_Private(nbodies, bodies, names[s], &pair->body[s], all, sizeof(all)));
    AbutCheckInput(pair->body[s], PetscObjectComm((PetscObject)pair), "%s_pair_bodies: the scene has no body \"%s\"; give two of: %s",
                   ((PetscObject)pair)->name, names[s], all);
  }
  AbutCheckInput(pair->body[0] != pair->body[1], PetscObjectComm((PetscObject)pair),
                 "%s_pair_bodies: both are \"%s\"; give two different bodies of: %s", ((PetscObject)pair)->name, names[0], all);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutPairSetTheta_Private(AbutPair pair)
{
  MPI_Comm    comm = PetscObjectComm((PetscObject)pair);
  const char *name = ((PetscObject)pair)->name, *file;
  AbutMesh    mesh;
  PetscReal   young, poisson, normal[2];

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(pair->body[0], &mesh));
  PetscCall(AbutMeshGetSideDirection(mesh, pair->side[0], normal));
  PetscCall(AbutMeshGetFile(mesh, &file));
  AbutCheckInput(!file || pair->thetaset || pair->height > 0. || pair->penalty == 0., comm,
                 "%s_pair_height: missing, and the first body is no box; give H of theta = c H/E, or %s_pair_theta, or %s_pair_penalty: 0",
                 name, name, name);
  if (pair->height <= 0.) PetscCall(AbutBodyGetHeight(pair->body[0], normal, &pair->height));
  PetscCall(AbutBodyGetMaterial(pair->body[0], &young, &poisson));
  if (!pair->thetaset) pair->theta = pair->penalty * pair->height / young;
  AbutCheckInput(pair->theta >= 0., comm, "%s_pair_%s: %g; give 0 for exact contact, or a penalty, for example %s", name,
                 pair->thetaset ? "theta" : "penalty", (double)(pair->thetaset ? pair->theta : pair->penalty),
                 pair->thetaset ? "2.4e-7" : "0.05");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutPairSetFromOptions - Reads the keys of a pair

   Collective

   Input Parameters:
+  pair    - the pair; its keys are listed under `AbutPairCreate()`
.  nbodies - bodies of the scene
-  bodies  - [nbodies] the bodies, which have read their keys

   Level: intermediate

.seealso: `AbutPairCreate()`, `AbutPairSetUp()`
@*/
PetscErrorCode AbutPairSetFromOptions(AbutPair pair, PetscInt nbodies, AbutBody bodies[])
{
  MPI_Comm    comm                        = PetscObjectComm((PetscObject)pair);
  const char *name                        = ((PetscObject)pair)->name;
  char        text[3][PETSC_MAX_PATH_LEN] = {"", "", ""}, names[2][128], key[256];
  PetscBool   set[3], heightset;
  PetscInt    pressureside = pair->pressureside;

  PetscFunctionBegin;
  PetscObjectOptionsBegin((PetscObject)pair);
  PetscCall(AbutOptionsString(PetscOptionsObject, "-pair_bodies", "Names of the two bodies", text[0], sizeof(text[0]), &set[0]));
  PetscCall(AbutOptionsString(PetscOptionsObject, "-pair_sides", "Their sides", text[1], sizeof(text[1]), &set[1]));
  PetscCall(AbutOptionsString(PetscOptionsObject, "-pair_gap", "Gap", text[2], sizeof(text[2]), &set[2]));
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-pair_penalty", "c of theta = c H/E", &pair->penalty, NULL));
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-pair_theta", "theta", &pair->theta, &pair->thetaset));
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-pair_height", "H of theta = c H/E", &pair->height, &heightset));
  PetscCall(AbutOptionsEnum(PetscOptionsObject, "-pair_pressure_side", "Which side carries the pressures", AbutPressureSideNames,
                            &pressureside, NULL));
  PetscOptionsEnd();
  pair->pressureside = (AbutPressureSide)pressureside;
  AbutCheckInput(set[0], comm, "%s_pair_bodies: missing; give the names of two bodies, for example upper,lower", name);
  AbutCheckInput(set[1], comm, "%s_pair_sides: missing; give a side of each body, for example bottom,top", name);
  AbutCheckInput(!heightset || pair->height > 0., comm, "%s_pair_height: %g is not a length; give a positive number", name,
                 (double)pair->height);
  PetscCall(AbutPairFindBodies_Private(pair, text[0], nbodies, bodies));
  if (pair->body[1]) PetscCall(AbutPairSplit_Private(pair, "sides", text[1], names[0], names[1], sizeof(names[0])));
  else {
    AbutCheckInput(!strchr(text[1], ','), comm,
                   "%s_pair_bodies: \"%s\" is one body, and \"%s\" are two sides; give two bodies, or one side", name, text[0], text[1]);
    PetscCall(PetscStrncpy(names[0], text[1], sizeof(names[0])));
  }
  PetscCall(PetscSNPrintf(key, sizeof(key), "%s_pair_sides", name));
  for (PetscInt s = 0; s < 2 && pair->body[s]; ++s) {
    AbutMesh mesh;

    PetscCall(AbutBodyGetMesh(pair->body[s], &mesh));
    PetscCall(AbutMeshFindSide(mesh, key, names[s], &pair->side[s]));
    PetscCall(AbutBodySetContact(pair->body[s], pair->side[s]));
  }
  PetscCall(PetscSNPrintf(key, sizeof(key), "%s_pair_gap", name));
  if (set[2]) PetscCall(AbutExpressionCreate(comm, key, text[2], &pair->gap));
  PetscCall(AbutPairObstacleFromOptions_Private(pair));
  PetscCall(AbutPairFrictionFromOptions_Private(pair));
  PetscCall(AbutPairCheckFacing_Private(pair));
  PetscCall(AbutPairCheckTractions_Private(pair));
  PetscCall(AbutPairSetTheta_Private(pair));
  PetscCall(AbutLogEventGet(pair->body[1] ? "AbutPairSetUp" : "AbutObstacle", ABUTPAIR_CLASSID, &pair->event));
  PetscFunctionReturn(PETSC_SUCCESS);
}
