#include <abut/private/sceneimpl.h>

/* Keys of every probe: NAME_probe_body, NAME_probe_point; the point must lie in the body */
PetscErrorCode AbutSceneProbesFromOptions_Private(AbutScene scene, PetscInt n, char *names[])
{
  MPI_Comm comm = PetscObjectComm((PetscObject)scene);

  PetscFunctionBegin;
  for (PetscInt i = 0; i < n; ++i) {
    AbutProbe  *probe = &scene->probe[scene->nprobes++];
    char        prefix[128], body[128] = "";
    const char *file;
    PetscBool   hasbody, haspoint, inside;
    AbutMesh    mesh;
    PetscReal   lower[2], upper[2];

    PetscCall(PetscStrallocpy(names[i], &probe->name));
    PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_", names[i]));
    PetscOptionsBegin(comm, prefix, "Probe", NULL);
    PetscCall(AbutOptionsString(PetscOptionsObject, "-probe_body", "The body", body, sizeof(body), &hasbody));
    PetscCall(AbutOptionsReals(PetscOptionsObject, "-probe_point", "x,y", 2, probe->x, &haspoint));
    PetscOptionsEnd();
    AbutCheckInput(hasbody, comm, "%s_probe_body: missing; give the name of a body", names[i]);
    AbutCheckInput(haspoint, comm, "%s_probe_point: missing; give a point x,y", names[i]);
    PetscCall(AbutSceneGetBody(scene, body, &probe->body));
    AbutCheckInput(probe->body, comm, "%s_probe_body: the scene has no body \"%s\"; give a name from scene_bodies", names[i], body);
    PetscCall(AbutBodyGetMesh(probe->body, &mesh));
    PetscCall(AbutMeshGetBox(mesh, lower, upper));
    PetscCall(AbutMeshGetFile(mesh, &file));
    PetscCall(AbutMeshCovers(mesh, probe->x, &inside));
    AbutCheckInput(inside || !file, comm,
                   "%s_probe_point: (%g, %g) lies outside \"%s\"; give a point in the cells of %s and inside the curves of its sides",
                   names[i], (double)probe->x[0], (double)probe->x[1], body, file);
    AbutCheckInput(file || (probe->x[0] >= lower[0] && probe->x[0] <= upper[0] && probe->x[1] >= lower[1] && probe->x[1] <= upper[1]), comm,
                   "%s_probe_point: (%g, %g) lies outside \"%s\"; give a point of its box [%g,%g]x[%g,%g]", names[i], (double)probe->x[0],
                   (double)probe->x[1], body, (double)lower[0], (double)upper[0], (double)lower[1], (double)upper[1]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
