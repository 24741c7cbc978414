#include <abut/private/loopimpl.h> /*I "abutloop.h" I*/
#include <abut/private/sysimpl.h>

/* Is every rigid motion that the prescribed displacements leave free resisted by contact? Contact resists a motion of the bodies by its
   normal jump, at the points of AbutPairGetSharedPoints(); where it has friction, by the tangential jump, too. */

/* One row per shared point of a pair and direction, one column per free motion of a body: the displacements of both sides along it,
   added */
typedef struct {
  PetscInt   rows, columns;
  PetscInt  *body, *mode; /* [columns] */
  PetscReal *M;           /* [rows*columns] */
} AbutJumps;

/* The directions in which a pair resists: the normal, and with friction the tangent */
static PetscErrorCode AbutPairGetDirections_Private(AbutPair pair, PetscInt *n)
{
  PetscBool friction;
  PetscReal mu;

  PetscFunctionBegin;
  PetscCall(AbutPairGetFriction(pair, &friction, &mu));
  *n = mu > 0. ? 2 : 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutJumpsCreate_Private(AbutInterface f, AbutJumps *j)
{
  PetscFunctionBegin;
  j->rows    = 0;
  j->columns = 0;
  for (PetscInt i = 0; i < f->npairs; ++i) {
    PetscReal *x;
    PetscInt   n, directions;

    PetscCall(AbutPairGetSharedPoints(f->pair[i], &n, &x));
    PetscCall(AbutPairGetDirections_Private(f->pair[i], &directions));
    PetscCall(PetscFree(x));
    j->rows += directions * n;
  }
  for (PetscInt pass = 0; pass < 2; ++pass) {
    if (pass) PetscCall(PetscMalloc2(j->columns, &j->body, j->columns, &j->mode));
    j->columns = 0;
    for (PetscInt b = 0; b < f->nbodies; ++b) {
      PetscInt n;

      PetscCall(AbutBodyGetFreeModeCount(f->body[b], &n));
      for (PetscInt k = 0; k < n; ++k, ++j->columns) {
        if (!pass) continue;
        j->body[j->columns] = b;
        j->mode[j->columns] = k;
      }
    }
  }
  PetscCall(PetscCalloc1(j->rows * j->columns, &j->M));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutJumpsDestroy_Private(AbutJumps *j)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(j->body, j->mode));
  PetscCall(PetscFree(j->M));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The motion at both corners of the body's box, by which a turn is known, and its size there: for a turn that of the box */
static PetscErrorCode AbutMotionAtCorners_Private(AbutBody body, PetscInt mode, PetscReal u[2][2], PetscBool *turn, PetscReal *scale)
{
  AbutMesh  mesh;
  PetscReal x[2][2];

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetBox(mesh, x[0], x[1]));
  for (PetscInt e = 0; e < 2; ++e) PetscCall(AbutBodyGetFreeMotion(body, mode, x[e], u[e]));
  *turn  = (PetscBool)(u[0][0] != u[1][0] || u[0][1] != u[1][1]);
  *scale = *turn ? PetscMax(x[1][0] - x[0][0], x[1][1] - x[0][1]) : 1.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutJumpsFill_Private(AbutInterface f, AbutJumps *j)
{
  PetscInt row = 0;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < f->npairs; ++i) {
    PetscReal *x;
    PetscInt   n, directions;

    PetscCall(AbutPairGetSharedPoints(f->pair[i], &n, &x));
    PetscCall(AbutPairGetDirections_Private(f->pair[i], &directions));
    for (PetscInt c = 0; c < j->columns; ++c)
      for (PetscInt s = 0; s < 2; ++s) {
        PetscReal corner[2][2], scale, u[2];
        PetscBool turn;

        if (j->body[c] != f->bodyof[2 * i + s]) continue;
        PetscCall(AbutMotionAtCorners_Private(f->body[j->body[c]], j->mode[c], corner, &turn, &scale));
        for (PetscInt k = 0; k < directions * n; ++k) {
          const PetscReal *at = x + 6 * (k % n), *normal = at + 4, along = k < n ? 0. : 1.;

          PetscCall(AbutBodyGetFreeMotion(f->body[j->body[c]], j->mode[c], at + 2 * s, u));
          j->M[(row + k) * j->columns + c] += (s ? -1. : 1.) *
                                              ((1. - along) * (u[0] * normal[0] + u[1] * normal[1]) +
                                               along * (u[1] * normal[0] - u[0] * normal[1])) /
                                              scale;
        }
      }
    PetscCall(PetscFree(x));
    row += directions * n;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gauss and Jordan, column by column: the first column that the ones before it make, or -1. used[c]: column c has a part in it. */
static PetscErrorCode AbutJumpsFindFree_Private(AbutJumps *j, PetscInt *which, PetscBool used[])
{
  const PetscReal tol  = 1e-10;
  PetscInt        rank = 0, *pivot;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(j->rows, &pivot)); /* of each row, its column */
  *which = -1;
  for (PetscInt c = 0; c < j->columns && *which < 0; ++c) {
    PetscInt best = rank;

    for (PetscInt r = rank; r < j->rows; ++r)
      if (PetscAbsReal(j->M[r * j->columns + c]) > PetscAbsReal(j->M[best * j->columns + c])) best = r;
    if (rank == j->rows || PetscAbsReal(j->M[best * j->columns + c]) <= tol) {
      *which = c;
      for (PetscInt r = 0; r < rank; ++r)
        if (PetscAbsReal(j->M[r * j->columns + c]) > tol) used[pivot[r]] = PETSC_TRUE;
      continue;
    }
    for (PetscInt k = 0; k < j->columns; ++k) {
      const PetscReal swap = j->M[rank * j->columns + k];

      j->M[rank * j->columns + k] = j->M[best * j->columns + k];
      j->M[best * j->columns + k] = swap;
    }
    for (PetscInt k = j->columns - 1; k >= c; --k) j->M[rank * j->columns + k] /= j->M[rank * j->columns + c];
    for (PetscInt r = 0; r < j->rows; ++r) {
      const PetscReal l = j->M[r * j->columns + c];

      if (r == rank || l == 0.) continue;
      for (PetscInt k = c; k < j->columns; ++k) j->M[r * j->columns + k] -= l * j->M[rank * j->columns + k];
    }
    pivot[rank++] = c;
  }
  PetscCall(PetscFree(pivot));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A side and a component that would hold the body, none that is in contact if there is another: against a translation along d the sides
   across it first, against a turn those across y */
static PetscErrorCode AbutBodyFindSupport_Private(AbutBody body, PetscBool turn, PetscInt d, const char *side[], PetscInt *component)
{
  AbutMesh    mesh;
  PetscInt    found = -1, nsides;
  const char *file;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetFile(mesh, &file));
  PetscCall(AbutMeshGetSideCount(mesh, &nsides));
  for (PetscInt k = 0; k < nsides && found < 0; ++k) {
    const PetscInt    s = file ? k : 2 * (k < 2 ? d : !d) + k % 2;
    AbutConditionType type;

    PetscCall(AbutBodyGetCondition(body, s, turn && !file ? s / 2 : d, &type));
    if (type == ABUT_TRACTION) found = s;
  }
  if (found < 0) found = file ? 0 : 2 * d;
  *component = turn && !file ? found / 2 : d;
  PetscCall(AbutMeshGetSideName(mesh, found, side));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutInterfaceComplain_Private(AbutInterface f, const AbutJumps *j, PetscInt which, const PetscBool used[],
                                                    char text[], size_t len)
{
  AbutBody    body = f->body[j->body[which]];
  const char *name, *other, *side;
  char        others[ABUT_LIST] = "", with[ABUT_LIST + 32] = "";
  PetscReal   u[2][2], scale;
  PetscBool   turn;
  PetscInt    d, component = 0, last = j->body[which];

  PetscFunctionBegin;
  PetscCall(AbutBodyGetName(body, &name));
  PetscCall(AbutMotionAtCorners_Private(body, j->mode[which], u, &turn, &scale));
  d = turn || u[0][0] == 0. ? 1 : 0;
  for (PetscInt c = 0; c < which; ++c) {
    if (!used[c] || j->body[c] == last || j->body[c] == j->body[which]) continue;
    last = j->body[c];
    PetscCall(AbutBodyGetName(f->body[last], &other));
    PetscCall(AbutListAddItem_Private(others, sizeof(others), other));
  }
  if (others[0]) PetscCall(PetscSNPrintf(with, sizeof(with), ", %s %s with it", turn ? "and" : "nor", others));
  PetscCall(AbutBodyFindSupport_Private(body, turn, d, &side, &component));
  if (turn)
    PetscCall(PetscSNPrintf(text, len,
                            "%s: this body is free to turn%s; prescribe a displacement normal to a side of some length, for example "
                            "%s_bc_%s_u%d: 0",
                            name, with, name, side, (int)component + 1));
  else
    PetscCall(PetscSNPrintf(text, len,
                            "%s: nothing holds this body along %s%s; prescribe u%d on one of its sides, for example %s_bc_%s_u%d: 0", name,
                            d ? "y" : "x", with, (int)component + 1, name, side, (int)component + 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutInterfaceCheck - Ends the run if bodies can move rigidly against no prescribed displacement and no contact; needs no meshes yet

   Collective

   Input Parameter:
.  iface - the map

   Level: developer

   Note:
   What can hold a body may still fail to: contact only pushes, and may be open; friction holds up to mu times the force. That is found by
   solving.

.seealso: `AbutBodyGetFreeModeCount()`, `AbutBodyCheck()`, `AbutPairCheck()`
@*/
PetscErrorCode AbutInterfaceCheck(AbutInterface iface)
{
  AbutJumps  j;
  PetscInt   which;
  PetscBool *used;
  char       text[2 * ABUT_LIST] = "";

  PetscFunctionBegin;
  PetscValidHeaderSpecific(iface, ABUTINTERFACE_CLASSID, 1);
  PetscCall(AbutJumpsCreate_Private(iface, &j));
  PetscCall(AbutJumpsFill_Private(iface, &j));
  PetscCall(PetscCalloc1(j.columns, &used));
  PetscCall(AbutJumpsFindFree_Private(&j, &which, used));
  if (which >= 0) PetscCall(AbutInterfaceComplain_Private(iface, &j, which, used, text, sizeof(text)));
  PetscCall(PetscFree(used));
  PetscCall(AbutJumpsDestroy_Private(&j));
  AbutCheckInput(!text[0], PetscObjectComm((PetscObject)iface), "%s", text);
  PetscFunctionReturn(PETSC_SUCCESS);
}
