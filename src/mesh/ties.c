#include <abut/private/meshimpl.h> /*I "abutmesh.h" I*/

/* Vertices of a side that are held at wanted positions, so that a cell begins where something else does, for example a contact.

   The DMPLEX keeps its coordinates, the reference; those of AbutMeshTopology are mapped: along each side of the box by a piecewise linear
   function, whose displacement reaches through the body, so that rectangles stay rectangles; if the opposite side has ties too, that of
   each falls off linearly towards the other. No cell is folded: the slopes A and B of the map along x and y are at least 1/2, and where
   both directions have ties, the displacements are at most a fifth of the box, so that the slopes C and D across obey
   |C D| <= (2/5)^2 < A B. */

#define ABUT_TIE_STRETCH 4. /* a displacement dies off within this many times its length, or within a cell of the first mesh */
#define ABUT_TIE_ACROSS  0.2
#define ABUT_TIE_MOVES   1e-9 /* of a cell of the first mesh */

/* Displacement along a side at the reference position s: knots are pairs of position and displacement, the first and last are its ends */
static PetscReal AbutSideDisplacement_Private(PetscInt n, const PetscReal knot[], PetscReal s)
{
  PetscReal z;

  if (!n) return 0.;
  while (n > 2 && s > knot[2]) {
    knot += 2;
    --n;
  }
  z = (s - knot[0]) / (knot[2] - knot[0]);
  return (1. - z) * knot[1] + z * knot[3];
}

/* The mapped position of a reference point */
static void AbutTiesMap_Private(AbutMesh mesh, PetscReal x[2])
{
  PetscReal u[2] = {0., 0.};

  for (PetscInt side = 0; side < ABUT_BOX_SIDES; ++side) {
    const PetscInt  d      = side / 2;
    const PetscReal up     = (x[d] - mesh->lower[d]) / (mesh->upper[d] - mesh->lower[d]);
    const PetscReal weight = !mesh->nknots[side ^ 1] ? 1. : side % 2 ? up : 1. - up;

    u[!d] += weight * AbutSideDisplacement_Private(mesh->nknots[side], mesh->knot[side], x[!d]);
  }
  for (PetscInt d = 0; d < 2; ++d) x[d] += u[d];
}

/* From reference to mapped coordinates of the vertices; hanging ones stay in the middle of their coarse side, which stays straight */
PetscErrorCode AbutMeshMoveToTies_Private(AbutMesh mesh, PetscInt n, PetscReal x[])
{
  PetscInt vStart;

  PetscFunctionBegin;
  mesh->tiesmoved = PETSC_FALSE;
  if (!mesh->nknots[0] && !mesh->nknots[1] && !mesh->nknots[2] && !mesh->nknots[3]) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt v = 0; v < n; ++v) AbutTiesMap_Private(mesh, x + 2 * v);
  PetscCall(DMPlexGetDepthStratum(mesh->dm, 0, &vStart, NULL));
  for (PetscInt v = 0; v < n; ++v) {
    const PetscInt *end;
    PetscInt        parent;

    PetscCall(DMPlexGetTreeParent(mesh->dm, v + vStart, &parent, NULL));
    if (parent == v + vStart) continue;
    PetscCall(DMPlexGetCone(mesh->dm, parent, &end)); /* these do not hang: the mesh is 2:1 across sides */
    for (PetscInt d = 0; d < 2; ++d) x[2 * v + d] = 0.5 * (x[2 * (end[0] - vStart) + d] + x[2 * (end[1] - vStart) + d]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The ties of one side in order, of two at one vertex only the first */
static PetscErrorCode AbutTiesSort_Private(AbutMesh mesh, PetscInt side, PetscInt n, const AbutTie tie[], PetscInt *nsorted,
                                           AbutTie sorted[])
{
  const PetscInt  d    = !(side / 2);
  const PetscReal tiny = ABUT_TIE_MOVES * (mesh->upper[d] - mesh->lower[d]) / mesh->cells[d];

  PetscFunctionBegin;
  *nsorted = 0;
  for (PetscInt i = 0; i < n; ++i) {
    PetscInt k = 0;

    if (tie[i].side != side) continue;
    PetscCheck(tie[i].reference > mesh->lower[d] && tie[i].reference < mesh->upper[d], PetscObjectComm((PetscObject)mesh),
               PETSC_ERR_ARG_OUTOFRANGE, "A tie at %g is not inside its side", (double)tie[i].reference);
    while (k < *nsorted && sorted[k].reference < tie[i].reference - tiny) ++k;
    if (k < *nsorted && sorted[k].reference < tie[i].reference + tiny) continue;
    for (PetscInt j = *nsorted; j > k; --j) sorted[j] = sorted[j - 1];
    sorted[k] = tie[i];
    ++*nsorted;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How far a tie may move: the slopes stay above 1/2 */
static PetscReal AbutTieLimit_Private(AbutMesh mesh, PetscInt d, PetscBool both, PetscInt n, const AbutTie tie[], PetscInt i)
{
  PetscReal limit = 0.5 * PetscMin(tie[i].reference - mesh->lower[d], mesh->upper[d] - tie[i].reference);

  if (i) limit = PetscMin(limit, 0.25 * (tie[i].reference - tie[i - 1].reference));
  if (i + 1 < n) limit = PetscMin(limit, 0.25 * (tie[i + 1].reference - tie[i].reference));
  return both ? PetscMin(limit, ABUT_TIE_ACROSS * (mesh->upper[!d] - mesh->lower[!d])) : limit;
}

static void AbutKnotAdd_Private(PetscReal s, PetscReal displacement, PetscInt *n, PetscReal knot[])
{
  knot[2 * *n]     = s;
  knot[2 * *n + 1] = displacement;
  ++*n;
}

/* The function of one side: at most 3n+2 knots */
static PetscInt AbutTiesGetKnots_Private(AbutMesh mesh, PetscInt side, PetscBool both, PetscInt n, const AbutTie tie[], PetscReal knot[])
{
  const PetscInt  d     = !(side / 2);
  const PetscReal first = (mesh->upper[d] - mesh->lower[d]) / mesh->cells[d];
  PetscReal       at = mesh->lower[d], reach = 0.; /* of the tie before */
  PetscInt        k = 0;

  if (!n) return 0;
  AbutKnotAdd_Private(at, 0., &k, knot);
  for (PetscInt i = 0; i <= n; ++i) {
    PetscReal s = mesh->upper[d], move = 0., own = 0.;

    if (i < n) {
      const PetscReal limit = AbutTieLimit_Private(mesh, d, both, n, tie, i);

      s    = tie[i].reference;
      move = PetscMin(limit, PetscMax(-limit, tie[i].wanted - s));
      own  = PetscMax(first, ABUT_TIE_STRETCH * PetscAbsReal(move));
    }
    if (at + reach < s - own) { /* there is room for a part without displacement */
      if (reach > 0.) AbutKnotAdd_Private(at + reach, 0., &k, knot);
      if (own > 0.) AbutKnotAdd_Private(s - own, 0., &k, knot);
    }
    AbutKnotAdd_Private(s, move, &k, knot);
    at    = s;
    reach = own;
  }
  return k;
}

/*@C
   AbutMeshSetTies - Ties vertices on the sides to positions; the rest of the mesh follows smoothly

   Collective

   Input Parameters:
+  mesh - the mesh, set up
.  n    - how many ties
-  tie  - [n] side, reference position of a vertex and wanted position, both as the coordinate that runs along the side, length; the same on
          all ranks

   Level: intermediate

   Notes:
   They replace all ties set before, and take effect with the next `AbutMeshAdapt()`, which may be without marks. A tie that would fold
   cells goes as far as it may: half the way to the ends of the side, a quarter of that to the next tie.

   Levels of cells, and the order in which ranks share them, are those of the mesh without ties.

.seealso: `AbutMeshFindTie()`, `AbutMeshAdapt()`
@*/
PetscErrorCode AbutMeshSetTies(AbutMesh mesh, PetscInt n, const AbutTie tie[])
{
  AbutTie  *sorted[ABUT_BOX_SIDES];
  PetscInt  count[ABUT_BOX_SIDES];
  PetscBool both;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(mesh, ABUTMESH_CLASSID, 1);
  PetscCheck(!mesh->first, PetscObjectComm((PetscObject)mesh), PETSC_ERR_SUP, "Only vertices of a box can be tied");
  PetscCall(AbutJournalTies_Private(mesh, n, tie));
  for (PetscInt side = 0; side < ABUT_BOX_SIDES; ++side) {
    PetscCall(PetscMalloc1(n, &sorted[side]));
    PetscCall(AbutTiesSort_Private(mesh, side, n, tie, &count[side], sorted[side]));
  }
  both = (PetscBool)((count[0] || count[1]) && (count[2] || count[3]));
  for (PetscInt side = 0; side < ABUT_BOX_SIDES; ++side) {
    const PetscInt  d    = !(side / 2);
    const PetscReal tiny = ABUT_TIE_MOVES * (mesh->upper[d] - mesh->lower[d]) / mesh->cells[d];
    PetscReal      *knot;
    PetscInt        k;

    PetscCall(PetscMalloc1(2 * (3 * count[side] + 2), &knot));
    k = AbutTiesGetKnots_Private(mesh, side, both, count[side], sorted[side], knot);
    if (k != mesh->nknots[side]) mesh->tiesmoved = PETSC_TRUE;
    for (PetscInt i = 0; i < 2 * k && !mesh->tiesmoved; ++i)
      if (PetscAbsReal(knot[i] - mesh->knot[side][i]) > tiny) mesh->tiesmoved = PETSC_TRUE;
    PetscCall(PetscFree(mesh->knot[side]));
    mesh->knot[side]   = knot;
    mesh->nknots[side] = k;
    PetscCall(PetscFree(sorted[side]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutMeshFindTie - The tie by which the nearest vertex of a side would come to lie at a point

   Collective

   Input Parameters:
+  mesh - the mesh, set up
.  side - number of the side
-  x    - [2] the point, on the side or beside it; the same on all ranks

   Output Parameters:
+  tie   - for `AbutMeshSetTies()`; the same on all ranks
-  found - false if the nearest vertex is an end of the side, or the point lies beyond one

   Level: intermediate

   Note:
   The nearest vertex of the mesh as it is, with its present ties: so a vertex stays tied to a point that moves by less than half of the
   cells beside it.

.seealso: `AbutMeshSetTies()`
@*/
PetscErrorCode AbutMeshFindTie(AbutMesh mesh, PetscInt side, const PetscReal x[2], AbutTie *tie, PetscBool *found)
{
  const AbutMeshTopology *t      = &mesh->topology;
  const PetscInt          d      = !(side / 2);
  const PetscReal         wanted = x[d], tiny = ABUT_TIE_MOVES * (mesh->upper[d] - mesh->lower[d]) / mesh->cells[d];
  MPI_Comm                comm = PetscObjectComm((PetscObject)mesh);
  PetscReal               best = PETSC_MAX_REAL, all, reference = PETSC_MAX_REAL;
  const PetscReal        *xa;
  PetscInt                vStart;
  PetscSection            section;
  Vec                     coordinates;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(mesh, ABUTMESH_CLASSID, 1);
  PetscCall(DMPlexGetDepthStratum(mesh->dm, 0, &vStart, NULL));
  PetscCall(DMGetCoordinatesLocal(mesh->dm, &coordinates));
  PetscCall(DMGetCoordinateSection(mesh->dm, &section));
  PetscCall(VecGetArrayRead(coordinates, &xa));
  for (PetscInt k = 0; k < 2 * t->nsideedges; ++k) {
    const PetscInt *edge = t->sideedge + 3 * (k / 2), v = edge[k % 2];
    const PetscReal a = t->x[2 * edge[0] + d], b = t->x[2 * edge[1] + d], distance = PetscAbsReal(t->x[2 * v + d] - wanted);
    PetscInt        offset;

    if (edge[2] != side || wanted < PetscMin(a, b) - tiny || wanted > PetscMax(a, b) + tiny) continue;
    if (distance > 0.5 * PetscAbsReal(b - a) + tiny || distance > best + tiny) continue;
    if (t->x[2 * v + d] < mesh->lower[d] + tiny || t->x[2 * v + d] > mesh->upper[d] - tiny) continue;
    PetscCall(PetscSectionGetOffset(section, v + vStart, &offset));
    if (distance < best - tiny || xa[offset + d] < reference) reference = xa[offset + d];
    best = PetscMin(best, distance);
  }
  PetscCall(VecRestoreArrayRead(coordinates, &xa));
  /* of two at the same distance, the one with the smaller coordinate */
  PetscCallMPI(MPI_Allreduce(&best, &all, 1, MPIU_REAL, MPIU_MIN, comm));
  if (best > all + tiny) reference = PETSC_MAX_REAL;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &reference, 1, MPIU_REAL, MPIU_MIN, comm));
  *found         = (PetscBool)(all < PETSC_MAX_REAL);
  tie->side      = side;
  tie->reference = reference;
  tie->wanted    = wanted;
  PetscFunctionReturn(PETSC_SUCCESS);
}
