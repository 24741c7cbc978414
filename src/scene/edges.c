#include <abut/private/sceneimpl.h>

/* The edges of the contacts, where the stress has its singularities, and what the meshes do about them */

#define ABUT_EDGES_MAX 64 /* of a pair; more are not looked after */

/* The edges of one pair, as the last solve found them */
static PetscErrorCode AbutSceneGetEdges_Private(AbutScene scene, PetscInt i, PetscInt max, PetscInt *n, PetscReal x[][2])
{
  const PetscReal *u[2], *p;

  PetscFunctionBegin;
  for (PetscInt s = 0; s < 2; ++s) PetscCall(AbutInterfaceGetTrace(scene->iface, i, s, &u[s]));
  PetscCall(AbutInterfaceGetPressure(scene->iface, i, &p));
  PetscCall(AbutPairGetEdges(scene->pair[i], u[0], u[1], p, max, n, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps the edges that the last solve found, before the meshes change */
PetscErrorCode AbutSceneKeepEdges_Private(AbutScene scene)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(scene->edge));
  scene->nedges = 0;
  for (PetscInt i = 0; i < scene->npairs; ++i) scene->tied[i] = 0;
  PetscCall(PetscMalloc1(ABUT_EDGES_MAX * scene->npairs, &scene->edge));
  for (PetscInt i = 0; i < scene->npairs; ++i) {
    PetscReal x[ABUT_EDGES_MAX][2];
    PetscInt  n;

    PetscCall(AbutSceneGetEdges_Private(scene, i, ABUT_EDGES_MAX, &n, x));
    for (PetscInt e = 0; e < n; ++e) {
      AbutContactEdge *edge = &scene->edge[scene->nedges++];

      edge->pair = i;
      PetscCall(AbutPairGetBodies(scene->pair[i], edge->body, edge->side));
      for (PetscInt d = 0; d < 2; ++d) edge->x[d] = x[e][d];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which side of an edge's pair belongs to the body, -1 if none */
static PetscInt AbutSceneEdgeSide_Private(const AbutContactEdge *edge, AbutBody body)
{
  return edge->body[0] == body ? edge->side[0] : (edge->body[1] == body ? edge->side[1] : -1);
}

#define ABUT_NEAR 0.25 /* of the body: sides of a pair are nearer than that, and across a round body it is further */

/* Does an element side on the boundary touch the point, seen along it? */
PetscErrorCode AbutSideTouches_Private(AbutMesh mesh, PetscInt k, const PetscReal x[2], PetscBool *touches)
{
  const AbutMeshTopology *t;
  const PetscReal        *a, *b;
  PetscReal               d[2], r[2], h2, z, away, lower[2], upper[2];

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(AbutMeshGetBox(mesh, lower, upper));
  a = t->x + 2 * t->sideedge[3 * k];
  b = t->x + 2 * t->sideedge[3 * k + 1];
  for (PetscInt i = 0; i < 2; ++i) {
    d[i] = b[i] - a[i];
    r[i] = x[i] - a[i];
  }
  h2       = d[0] * d[0] + d[1] * d[1];
  z        = (r[0] * d[0] + r[1] * d[1]) / h2;
  away     = PetscAbsReal(r[0] * d[1] - r[1] * d[0]) / PetscSqrtReal(h2);
  *touches = (PetscBool)(z >= -ABUT_TOUCH && z <= 1. + ABUT_TOUCH &&
                         away <= ABUT_NEAR * PetscMax(upper[0] - lower[0], upper[1] - lower[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does element side k of the boundary belong to the edge's side of the body, and touch it? */
static PetscErrorCode AbutSceneIsAtEdge_Private(const AbutContactEdge *edge, AbutBody body, const AbutMeshTopology *t, PetscInt k,
                                                PetscBool *is)
{
  AbutMesh mesh;

  PetscFunctionBegin;
  *is = PETSC_FALSE;
  if (t->sideedge[3 * k + 2] != AbutSceneEdgeSide_Private(edge, body)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutSideTouches_Private(mesh, k, edge->x, is));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The level that the marked cells at each edge are to reach, -1 where none is marked */
static PetscErrorCode AbutSceneWantedLevels_Private(AbutScene scene, AbutBody body, const PetscBool mark[], PetscInt level[])
{
  const AbutMeshTopology *t;
  AbutMesh                mesh;
  PetscInt                jump, last;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(AbutAdaptorGetLevels(scene->adaptor, &jump, &last));
  for (PetscInt e = 0; e < scene->nedges; ++e) {
    level[e] = -1;
    for (PetscInt k = 0; k < t->nsideedges; ++k) {
      PetscBool is;

      PetscCall(AbutSceneIsAtEdge_Private(&scene->edge[e], body, t, k, &is));
      if (is && mark[t->sidecell[k]]) level[e] = PetscMax(level[e], PetscMin(t->level[t->sidecell[k]] + jump, last));
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, level, (PetscMPIInt)scene->nedges, MPIU_INT, MPI_MAX, PetscObjectComm((PetscObject)scene)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Splits the cells at the edges until they have these levels, or the body as many unknowns as it may */
static PetscErrorCode AbutSceneJump_Private(AbutScene scene, AbutBody body, const PetscInt level[])
{
  AbutMesh mesh;
  PetscInt marked = 1, most;

  PetscFunctionBegin;
  PetscCall(AbutAdaptorGetMaxUnknowns(scene->adaptor, &most));
  PetscCall(AbutBodyGetMesh(body, &mesh));
  while (marked) {
    const AbutMeshTopology *t;
    PetscBool              *mark;

    PetscCall(AbutMeshGetTopology(mesh, &t));
    if (2 * t->nglobal >= most) break;
    PetscCall(PetscCalloc1(t->ncells, &mark));
    marked = 0;
    for (PetscInt e = 0; e < scene->nedges; ++e)
      for (PetscInt k = 0; k < t->nsideedges; ++k) {
        const PetscInt c = t->sidecell[k];
        PetscBool      is;

        PetscCall(AbutSceneIsAtEdge_Private(&scene->edge[e], body, t, k, &is));
        if (!is || t->level[c] >= level[e]) continue;
        mark[c] = PETSC_TRUE;
        ++marked;
      }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &marked, 1, MPIU_INT, MPI_SUM, PetscObjectComm((PetscObject)scene)));
    if (marked) PetscCall(AbutMeshAdapt(mesh, mark));
    PetscCall(PetscFree(mark));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is a vertex of this body to lie on each edge? */
static PetscErrorCode AbutSceneBodyFollows_Private(AbutScene scene, AbutBody body, PetscBool *follows)
{
  AbutMesh    mesh;
  PetscInt    order;
  const char *file;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetOrder(mesh, &order));
  PetscCall(AbutMeshGetFile(mesh, &file));
  *follows = PETSC_FALSE;
  if (scene->adaptor && scene->npairs && !file) PetscCall(AbutAdaptorFollows(scene->adaptor, order, follows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The vertices nearest to the edges are tied to them */
static PetscErrorCode AbutSceneTieBody_Private(AbutScene scene, AbutBody body)
{
  AbutMesh      mesh;
  AbutTie      *tie;
  PetscInt      n = 0;
  PetscBool     follows, found;
  PetscLogEvent event;

  PetscFunctionBegin;
  PetscCall(AbutSceneBodyFollows_Private(scene, body, &follows));
  if (!follows) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutLogEventGet("AbutFollow", ABUTSCENE_CLASSID, &event));
  PetscCall(PetscLogEventBegin(event, scene, 0, 0, 0));
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(PetscMalloc1(scene->nedges, &tie));
  for (PetscInt e = 0; e < scene->nedges; ++e) {
    const PetscInt side = AbutSceneEdgeSide_Private(&scene->edge[e], body);

    if (side < 0) continue;
    PetscCall(AbutMeshFindTie(mesh, side, scene->edge[e].x, &tie[n], &found));
    if (!found) continue;
    ++n;
    ++scene->tied[scene->edge[e].pair];
  }
  PetscCall(AbutMeshSetTies(mesh, n, tie));
  PetscCall(PetscFree(tie));
  PetscCall(PetscLogEventEnd(event, scene, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells at the edges stay, whatever their error: they hold the vertices that are tied */
static PetscErrorCode AbutSceneKeepCells_Private(AbutScene scene, AbutBody body)
{
  const AbutMeshTopology *t;
  AbutMesh                mesh;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  for (PetscInt e = 0; e < scene->nedges; ++e)
    for (PetscInt k = 0; k < t->nsideedges; ++k) {
      PetscBool is;

      PetscCall(AbutSceneIsAtEdge_Private(&scene->edge[e], body, t, k, &is));
      if (is) PetscCall(AbutMeshKeepCell(mesh, t->sidecell[k]));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A new mesh for one body; without marks only ties may move it, or cells be merged */
PetscErrorCode AbutSceneAdaptBody_Private(AbutScene scene, AbutBody body, const PetscBool mark[])
{
  AbutMesh  mesh;
  PetscInt *level;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(PetscMalloc1(scene->nedges, &level));
  if (mark) PetscCall(AbutSceneWantedLevels_Private(scene, body, mark, level));
  PetscCall(AbutSceneTieBody_Private(scene, body));
  PetscCall(AbutSceneKeepCells_Private(scene, body));
  PetscCall(AbutMeshAdapt(mesh, mark));
  if (mark) PetscCall(AbutSceneJump_Private(scene, body, level));
  PetscCall(PetscFree(level));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is there a body whose mesh moves? */
PetscErrorCode AbutSceneFollows_Private(AbutScene scene, PetscBool *follows)
{
  PetscFunctionBegin;
  *follows = PETSC_FALSE;
  for (PetscInt b = 0; b < scene->nbodies && !*follows; ++b)
    if (scene->estimates[b]) PetscCall(AbutSceneBodyFollows_Private(scene, scene->body[b], follows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Has any contact an edge, as the last solve found it? */
static PetscErrorCode AbutSceneHasEdges_Private(AbutScene scene, PetscBool *has)
{
  PetscFunctionBegin;
  *has = PETSC_FALSE;
  for (PetscInt i = 0; i < scene->npairs && !*has; ++i) {
    PetscReal x[1][2];
    PetscInt  n;

    PetscCall(AbutSceneGetEdges_Private(scene, i, 1, &n, x));
    *has = (PetscBool)(n > 0);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Are the meshes to move only, this time? */
PetscErrorCode AbutSceneSettles_Private(AbutScene scene, PetscBool *settles)
{
  PetscFunctionBegin;
  *settles = PETSC_FALSE;
  if (!scene->adaptor || scene->settled) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutAdaptorSettles(scene->adaptor, settles));
  if (*settles) PetscCall(AbutSceneFollows_Private(scene, settles));
  if (*settles) PetscCall(AbutSceneHasEdges_Private(scene, settles));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutSceneRecordTies_Private(AbutScene scene)
{
  PetscBool follows;

  PetscFunctionBegin;
  PetscCall(AbutSceneFollows_Private(scene, &follows));
  for (PetscInt i = 0; i < scene->npairs && follows; ++i) {
    const char *name;
    char        key[256];

    PetscCall(AbutPairGetName(scene->pair[i], &name));
    PetscCall(PetscSNPrintf(key, sizeof(key), "pair.%s.tied", name));
    PetscCall(AbutRecorderSetInt(scene->recorder, key, scene->tied[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
