#include <abut/private/pairimpl.h> /*I "abutpair.h" I*/

/* The two straight sides of a pair, before there are meshes */

typedef struct {
  PetscReal ends[2][4], normal[2][2]; /* of each side */
  PetscReal at[2][2];                 /* where its ends lie along the first side */
  PetscReal from, to;                 /* the part they share, from > to if there is none */
  PetscReal length;                   /* of the first side */
} AbutPairSides;

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

/*@
   AbutPairGetSharedEnds - The ends of the part that the sides of a pair share; needs no meshes yet

   Not Collective

   Input Parameter:
.  pair - the pair, its keys read

   Output Parameters:
+  point  - [side][end] the two ends along the first side, each seen from both sides, length
-  normal - [side] outward unit normals

   Level: developer

.seealso: `AbutPairCheck()`, `AbutInterfaceCheck()`
@*/
PetscErrorCode AbutPairGetSharedEnds(AbutPair pair, PetscReal point[2][2][2], PetscReal normal[2][2])
{
  AbutPairSides f;

  PetscFunctionBegin;
  PetscCall(AbutPairGetSides_Private(pair, &f));
  for (PetscInt s = 0; s < 2; ++s)
    for (PetscInt e = 0; e < 2; ++e) {
      const PetscReal z = ((e ? f.to : f.from) - f.at[s][0]) / (f.at[s][1] - f.at[s][0]);

      for (PetscInt d = 0; d < 2; ++d) point[s][e][d] = (1. - z) * f.ends[s][d] + z * f.ends[s][2 + d];
    }
  for (PetscInt s = 0; s < 2; ++s)
    for (PetscInt d = 0; d < 2; ++d) normal[s][d] = f.normal[s][d];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The two sides must lie against each other: opposite normals, a common part, and a distance that is small, or none where the gap is
   given */
PetscErrorCode AbutPairCheckFacing_Private(AbutPair pair)
{
  MPI_Comm      comm = PetscObjectComm((PetscObject)pair);
  const char   *name = ((PetscObject)pair)->name, *body[2];
  PetscReal     distance;
  AbutPairSides f;

  PetscFunctionBegin;
  for (PetscInt s = 0; s < 2; ++s) PetscCall(AbutBodyGetName(pair->body[s], &body[s]));
  PetscCall(AbutPairGetSides_Private(pair, &f));
  distance = AbutPairSidesDistance_Private(&f);
  AbutCheckInput(f.normal[0][0] * f.normal[1][0] + f.normal[0][1] * f.normal[1][1] < -0.999 && f.to - f.from > 1e-9 * f.length &&
                   PetscAbsReal(distance) < 0.1 * f.length,
                 comm,
                 "%s_pair_sides: bodies \"%s\" and \"%s\" share no part of these sides (distance %g); give sides that lie against each "
                 "other, for example bottom,top",
                 name, body[0], body[1], (double)distance);
  AbutCheckInput(!pair->gap || PetscAbsReal(distance) < 1e-6 * f.length, comm,
                 "%s_pair_gap: given, but the sides of \"%s\" and \"%s\" are %g apart; bring the boxes together, or leave the gap out to "
                 "use this distance",
                 name, body[0], body[1], (double)distance);
  PetscFunctionReturn(PETSC_SUCCESS);
}
