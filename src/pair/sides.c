#include <abut/private/pairimpl.h> /*I "abutpair.h" I*/

/* The two sides of a pair before there are meshes: segments, one of them if they are those of a box */

/* Two straight sides that are opposite to each other */
typedef struct {
  PetscReal ends[2][4], normal[2][2]; /* of each side */
  PetscReal at[2][2];                 /* where its ends lie along the first side */
  PetscReal from, to;                 /* the part they share, from > to if there is none */
  PetscReal length;                   /* of the first side */
} AbutPairSides;

/* [4*n] the ends of the segments of one side */
static PetscErrorCode AbutPairGetSegments_Private(AbutPair pair, PetscInt s, PetscInt *n, const PetscReal *x[])
{
  AbutMesh mesh;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(pair->body[s], &mesh));
  PetscCall(AbutMeshGetSideSegments(mesh, pair->side[s], n, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Outward normal of a segment, and its length */
static void AbutSegmentGetNormal_Private(const PetscReal x[4], PetscReal normal[2], PetscReal *length)
{
  const PetscReal d[2] = {x[2] - x[0], x[3] - x[1]};

  *length   = PetscSqrtReal(d[0] * d[0] + d[1] * d[1]);
  normal[0] = d[1] / *length;
  normal[1] = -d[0] / *length;
}

static PetscErrorCode AbutPairGetSides_Private(AbutPair pair, AbutPairSides *f)
{
  PetscReal tangent[2];

  PetscFunctionBegin;
  for (PetscInt s = 0; s < 2; ++s) {
    AbutMesh mesh;

    PetscCall(AbutBodyGetMesh(pair->body[s], &mesh));
    PetscCall(AbutMeshGetSideEnds(mesh, pair->side[s], f->ends[s], f->normal[s]));
  }
  for (PetscInt d = 0; d < 2; ++d) tangent[d] = f->ends[0][2 + d] - f->ends[0][d];
  f->length = PetscSqrtReal(tangent[0] * tangent[0] + tangent[1] * tangent[1]);
  f->from   = PETSC_MIN_REAL;
  f->to     = PETSC_MAX_REAL;
  for (PetscInt s = 0; s < 2; ++s) {
    for (PetscInt e = 0; e < 2; ++e) f->at[s][e] = (f->ends[s][2 * e] * tangent[0] + f->ends[s][2 * e + 1] * tangent[1]) / f->length;
    f->from = PetscMax(f->from, PetscMin(f->at[s][0], f->at[s][1]));
    f->to   = PetscMin(f->to, PetscMax(f->at[s][0], f->at[s][1]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal AbutPairSidesDistance_Private(const AbutPairSides *f)
{
  return (f->ends[1][0] - f->ends[0][0]) * f->normal[0][0] + (f->ends[1][1] - f->ends[0][1]) * f->normal[0][1];
}

/* How far the second side is from the first, along its normal: the gap where none is given */
PetscErrorCode AbutPairGetDistance_Private(AbutPair pair, PetscReal *distance)
{
  AbutPairSides f;

  PetscFunctionBegin;
  PetscCall(AbutPairGetSides_Private(pair, &f));
  *distance = AbutPairSidesDistance_Private(&f);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutPairAreStraight_Private(AbutPair pair, PetscBool *straight)
{
  PetscBool one[2] = {PETSC_TRUE, PETSC_TRUE};

  PetscFunctionBegin;
  for (PetscInt s = 0; s < 2 && pair->body[s]; ++s) {
    AbutMesh mesh;

    PetscCall(AbutBodyGetMesh(pair->body[s], &mesh));
    PetscCall(AbutMeshIsSideStraight(mesh, pair->side[s], &one[s]));
  }
  *straight = (PetscBool)(one[0] && one[1]);
  if (*straight && pair->body[1]) {
    AbutPairSides f;

    PetscCall(AbutPairGetSides_Private(pair, &f));
    if (f.normal[0][0] * f.normal[1][0] + f.normal[0][1] * f.normal[1][1] > -1. + 1e-9) *straight = PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The nearest point of the second side to x, and whether the segment it is on faces the normal: not so where the side has ended */
static PetscErrorCode AbutPairNearestOther_Private(AbutPair pair, const PetscReal x[2], const PetscReal normal[2], PetscReal foot[2],
                                                   PetscReal *distance, PetscBool *faces)
{
  const PetscReal *p;
  PetscReal        best = PETSC_MAX_REAL;
  PetscInt         n;

  PetscFunctionBegin;
  PetscCall(AbutPairGetSegments_Private(pair, 1, &n, &p));
  *faces = PETSC_FALSE;
  for (PetscInt i = 0; i < n; ++i, p += 4) {
    PetscReal own[2], length, t, at[2], r;

    AbutSegmentGetNormal_Private(p, own, &length);
    t = (-own[1] * (x[0] - p[0]) + own[0] * (x[1] - p[1])) / length;
    for (PetscInt d = 0; d < 2; ++d) at[d] = p[d] + PetscMin(1., PetscMax(0., t)) * (p[2 + d] - p[d]);
    r = PetscSqrtReal(PetscSqr(at[0] - x[0]) + PetscSqr(at[1] - x[1]));
    if (r >= best) continue;
    best   = r;
    *faces = (PetscBool)(own[0] * normal[0] + own[1] * normal[1] < -0.1 && (i > 0 || t >= 0.) && (i + 1 < n || t <= 1.));
    for (PetscInt d = 0; d < 2; ++d) foot[d] = at[d];
  }
  *distance = best;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPairGetSharedPoints - Points at which the sides of a pair lie against each other; needs no meshes yet

   Not Collective

   Input Parameter:
.  pair - the pair, its keys read

   Output Parameters:
+  n - how many: the two ends of the shared part of straight sides, which say all of rigid motions; otherwise one for each segment of the
       first side that faces the second
-  x - [6*n] for each: the point on the first side, that on the second, and the outward normal of the first; free it with `PetscFree()`

   Level: developer

.seealso: `AbutPairCheck()`, `AbutInterfaceCheck()`
@*/
PetscErrorCode AbutPairGetSharedPoints(AbutPair pair, PetscInt *n, PetscReal *x[])
{
  const PetscReal *p;
  PetscInt         segments;
  PetscBool        straight, faces = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(AbutPairAreStraight_Private(pair, &straight));
  PetscCall(AbutPairGetSegments_Private(pair, 0, &segments, &p));
  PetscCall(PetscCalloc1(12 * segments, x));
  *n = 0;
  if (straight && pair->body[1]) {
    AbutPairSides f;

    PetscCall(AbutPairGetSides_Private(pair, &f));
    for (PetscInt e = 0; e < 2; ++e, ++*n) {
      for (PetscInt s = 0; s < 2; ++s) {
        const PetscReal z = ((e ? f.to : f.from) - f.at[s][0]) / (f.at[s][1] - f.at[s][0]);

        for (PetscInt d = 0; d < 2; ++d) (*x)[6 * e + 2 * s + d] = (1. - z) * f.ends[s][d] + z * f.ends[s][2 + d];
      }
      PetscCall(PetscArraycpy(*x + 6 * e + 4, f.normal[0], 2));
    }
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt k = 0; k < 2 * segments; ++k) { /* the ends of straight segments, the middles of others */
    PetscReal *at = *x + 6 * *n, length, distance;

    if (!straight && k % 2) continue;
    AbutSegmentGetNormal_Private(p + 4 * (k / 2), at + 4, &length);
    for (PetscInt d = 0; d < 2; ++d) at[d] = at[2 + d] = straight ? p[2 * k + d] : 0.5 * (p[2 * k + d] + p[2 * k + 2 + d]);
    if (pair->body[1]) PetscCall(AbutPairNearestOther_Private(pair, at, at + 4, at + 2, &distance, &faces));
    if (faces) ++*n;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Straight sides must have a common part, and a distance that is small, or none where the gap is given */
static PetscErrorCode AbutPairCheckStraight_Private(AbutPair pair, const char *const body[])
{
  MPI_Comm      comm = PetscObjectComm((PetscObject)pair);
  const char   *name = ((PetscObject)pair)->name;
  PetscReal     distance;
  AbutPairSides f;

  PetscFunctionBegin;
  PetscCall(AbutPairGetSides_Private(pair, &f));
  distance = AbutPairSidesDistance_Private(&f);
  AbutCheckInput(f.to - f.from > 1e-9 * f.length && PetscAbsReal(distance) < 0.1 * f.length, comm,
                 "%s_pair_sides: bodies \"%s\" and \"%s\" share no part of these sides (distance %g); give sides that lie against each "
                 "other, for example bottom,top",
                 name, body[0], body[1], (double)distance);
  AbutCheckInput(!pair->gap || PetscAbsReal(distance) < 1e-6 * f.length, comm,
                 "%s_pair_gap: given, but the sides of \"%s\" and \"%s\" are %g apart; bring the boxes together, or leave the gap out to "
                 "use this distance",
                 name, body[0], body[1], (double)distance);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A side in contact is one piece, and has two ends if it is to meet another one */
static PetscErrorCode AbutPairCheckPieces_Private(AbutPair pair, PetscInt s)
{
  const char      *name, *side;
  const PetscReal *x;
  PetscBool        pieces = PETSC_FALSE;
  PetscInt         n;
  AbutMesh         mesh;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetName(pair->body[s], &name));
  PetscCall(AbutBodyGetMesh(pair->body[s], &mesh));
  PetscCall(AbutMeshGetSideName(mesh, pair->side[s], &side));
  PetscCall(AbutPairGetSegments_Private(pair, s, &n, &x));
  for (PetscInt k = 1; k < n; ++k)
    if (x[4 * k] != x[4 * k - 2] || x[4 * k + 1] != x[4 * k - 1]) pieces = PETSC_TRUE;
  AbutCheckInput(!pieces, PetscObjectComm((PetscObject)pair),
                 "%s_pair_sides: side \"%s\" of %s is in several pieces; give each a name of its own, and a pair",
                 ((PetscObject)pair)->name, side, name);
  AbutCheckInput(!pair->body[1] || n < 2 || x[0] != x[4 * n - 2] || x[1] != x[4 * n - 1], PetscObjectComm((PetscObject)pair),
                 "%s_pair_sides: side \"%s\" of %s closes on itself; cut it in two, with a name and a pair for each half, or give half of "
                 "the "
                 "body",
                 ((PetscObject)pair)->name, side, name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Estimators take a given traction for all there is; contact may act in it where it has more than a normal component of its own */
PetscErrorCode AbutPairCheckTractions_Private(AbutPair pair)
{
  PetscBool straight;

  PetscFunctionBegin;
  PetscCall(AbutPairAreStraight_Private(pair, &straight));
  if (straight && !pair->friction) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < 4 && pair->body[k / 2]; ++k) {
    AbutConditionType type;
    AbutMesh          mesh;
    const char       *body, *side;

    PetscCall(AbutBodyGetCondition(pair->body[k / 2], pair->side[k / 2], k % 2, &type));
    PetscCall(AbutBodyGetName(pair->body[k / 2], &body));
    PetscCall(AbutBodyGetMesh(pair->body[k / 2], &mesh));
    PetscCall(AbutMeshGetSideName(mesh, pair->side[k / 2], &side));
    AbutCheckInput(type != ABUT_TRACTION, PetscObjectComm((PetscObject)pair), "%s_bc_%s_t%d: the side is in contact (%s), %s; leave it out",
                   body, side, (int)(k % 2) + 1, ((PetscObject)pair)->name,
                   pair->friction ? "with friction, which acts along it too" : "and curved, so that pressures act in both components");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The two sides must lie against each other: opposite normals somewhere, and near there */
PetscErrorCode AbutPairCheckFacing_Private(AbutPair pair)
{
  const char      *name = ((PetscObject)pair)->name, *body[2];
  const PetscReal *p;
  PetscReal       *x, length = 0., nearest = PETSC_MAX_REAL;
  PetscInt         n, segments;
  PetscBool        straight;

  PetscFunctionBegin;
  for (PetscInt s = 0; s < 2 && pair->body[s]; ++s) PetscCall(AbutPairCheckPieces_Private(pair, s));
  if (!pair->body[1]) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt s = 0; s < 2; ++s) PetscCall(AbutBodyGetName(pair->body[s], &body[s]));
  PetscCall(AbutPairAreStraight_Private(pair, &straight));
  if (straight) {
    PetscCall(AbutPairCheckStraight_Private(pair, body));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(AbutPairGetSharedPoints(pair, &n, &x));
  for (PetscInt i = 0; i < n; ++i)
    nearest = PetscMin(nearest, PetscSqrtReal(PetscSqr(x[6 * i] - x[6 * i + 2]) + PetscSqr(x[6 * i + 1] - x[6 * i + 3])));
  PetscCall(PetscFree(x));
  PetscCall(AbutPairGetSegments_Private(pair, 0, &segments, &p));
  for (PetscInt i = 0; i < segments; ++i) {
    PetscReal normal[2], one;

    AbutSegmentGetNormal_Private(p + 4 * i, normal, &one);
    length += one;
  }
  AbutCheckInput(n > 0 && nearest < 0.1 * length, PetscObjectComm((PetscObject)pair),
                 "%s_pair_sides: bodies \"%s\" and \"%s\" share no part of these sides; give sides that lie against each other, for "
                 "example "
                 "bottom,top",
                 name, body[0], body[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
