#include "motions.h" /*I "abutbody.h" I*/

/* Rigid motions that no prescribed displacement and no foundation resists: their shapes follow from the box and the conditions */

/* A translation is free if its component is prescribed nowhere. A turn about (x0, y0) leaves u1 in peace on the line y = y0 and u2 on
   x = x0, so it is free if all prescribed u1 lie on one line of constant y, and all prescribed u2 on one of constant x. The ends of
   straight segments stand for all their points. With axial symmetry only moving along the axis leaves the circumferences as they are. */
PetscErrorCode AbutBodyFindFreeMotions_Private(AbutBody body, AbutFreeMotions *f)
{
  const PetscBool axial = (PetscBool)(body->kinematics == ABUT_AXISYMMETRIC);
  PetscReal       lower[2], upper[2], least[2], most[2], size;
  PetscInt        nsides, n[2] = {0, 0};

  PetscFunctionBegin;
  PetscCall(AbutMeshGetBox(body->mesh, lower, upper));
  PetscCall(AbutMeshGetSideCount(body->mesh, &nsides));
  size = PetscMax(upper[0] - lower[0], upper[1] - lower[1]);
  for (PetscInt e = 0; e < 2; ++e) {
    least[e] = upper[e];
    most[e]  = lower[e];
  }
  for (PetscInt s = 0; s < nsides; ++s)
    for (PetscInt d = 0; d < 2; ++d) {
      const PetscReal *ends;
      PetscInt         segments;
      PetscBool        holds;

      PetscCall(AbutBodyHoldsSide_Private(body, s, d, &holds));
      if (!holds) continue;
      PetscCall(AbutMeshGetSideSegments(body->mesh, s, &segments, &ends));
      for (PetscInt end = 0; end < 2 * segments; ++end) {
        least[!d] = PetscMin(least[!d], ends[2 * end + !d]);
        most[!d]  = PetscMax(most[!d], ends[2 * end + !d]);
      }
      ++n[d];
    }
  f->n = 0;
  for (PetscInt d = 0; d < 2; ++d) {
    if (!n[d] && (d || !axial)) f->kind[f->n++] = d ? ABUT_MOVE_Y : ABUT_MOVE_X;
    f->center[!d] = 0.5 * (n[d] ? least[!d] + most[!d] : lower[!d] + upper[!d]);
  }
  if (!axial && (!n[0] || most[1] - least[1] <= 1e-10 * size) && (!n[1] || most[0] - least[0] <= 1e-10 * size)) f->kind[f->n++] = ABUT_TURN;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void AbutMotionAt_Private(PetscInt kind, const PetscReal center[2], const PetscReal x[2], PetscReal u[2])
{
  u[0] = kind == ABUT_TURN ? center[1] - x[1] : (PetscReal)(kind == ABUT_MOVE_X);
  u[1] = kind == ABUT_TURN ? x[0] - center[0] : (PetscReal)(kind == ABUT_MOVE_Y);
}

/*@
   AbutBodyGetFreeModeCount - How many rigid motions no prescribed displacement and no spring resists; needs no mesh yet

   Not Collective

   Input Parameter:
.  body - the body, its box and its conditions set

   Output Parameter:
.  n - 0 to 3

   Level: intermediate

   Note:
   Prescribed components count on whole sides, whatever their values; contact does not count.

.seealso: `AbutBodyGetFreeModeName()`, `AbutBodyGetFreeMotion()`, `AbutBodyGetFreeModes()`
@*/
PetscErrorCode AbutBodyGetFreeModeCount(AbutBody body, PetscInt *n)
{
  AbutFreeMotions f;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  PetscCall(AbutBodyFindFreeMotions_Private(body, &f));
  *n = f.n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutBodyFindFreeMotion_Private(AbutBody body, PetscInt k, AbutFreeMotions *f)
{
  PetscFunctionBegin;
  PetscCall(AbutBodyFindFreeMotions_Private(body, f));
  PetscCheck(k >= 0 && k < f->n, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "Free mode %" PetscInt_FMT " is not below %" PetscInt_FMT, k,
             f->n);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyGetFreeModeName - A free rigid motion in words; needs no mesh yet

   Not Collective

   Input Parameters:
+  body - the body
.  k    - number of the motion, below that of `AbutBodyGetFreeModeCount()`
-  len  - room in text, 64 is enough

   Output Parameter:
.  text - "moving along x", "moving along y", "turning about (x, y)"

   Level: intermediate

.seealso: `AbutBodyGetFreeModeCount()`, `AbutBodyGetFreeMotion()`
@*/
PetscErrorCode AbutBodyGetFreeModeName(AbutBody body, PetscInt k, char text[], size_t len)
{
  AbutFreeMotions f;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  PetscCall(AbutBodyFindFreeMotion_Private(body, k, &f));
  if (f.kind[k] == ABUT_TURN) PetscCall(PetscSNPrintf(text, len, "turning about (%g, %g)", (double)f.center[0], (double)f.center[1]));
  else PetscCall(PetscSNPrintf(text, len, "moving along %s", f.kind[k] == ABUT_MOVE_X ? "x" : "y"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetFreeMotion - A free rigid motion at a point; needs no mesh yet

   Not Collective

   Input Parameters:
+  body - the body
.  k    - number of the motion, below that of `AbutBodyGetFreeModeCount()`
-  x    - [2] the point

   Output Parameter:
.  u - [2] its displacement: a unit vector, or for a turn by the small angle 1 about (x0, y0) the vector (y0 - y, x - x0)

   Level: intermediate

.seealso: `AbutBodyGetFreeModeName()`, `AbutBodyGetFreeModes()`
@*/
PetscErrorCode AbutBodyGetFreeMotion(AbutBody body, PetscInt k, const PetscReal x[2], PetscReal u[2])
{
  AbutFreeMotions f;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  PetscCall(AbutBodyFindFreeMotion_Private(body, k, &f));
  AbutMotionAt_Private(f.kind[k], f.center, x, u);
  PetscFunctionReturn(PETSC_SUCCESS);
}
