#include "motions.h" /*I "abutbody.h" I*/

/* The free rigid motions on a mesh: they are the null space of the stiffness, and a few springs that carry nothing make it a matrix with a
   factor. */

/* The unknowns of one motion on the present mesh */
static PetscErrorCode AbutBodySetMotion_Private(AbutBody body, PetscInt kind, const PetscReal center[2], Vec mode)
{
  const AbutMeshTopology *t;
  PetscScalar            *a;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  PetscCall(VecGetArrayWrite(mode, &a));
  for (PetscInt k = 0; k < t->nnodes; ++k)
    if (t->unknown[k] >= 0 && t->unknown[k] < t->nowned) AbutMotionAt_Private(kind, center, t->x + 2 * k, a + 2 * t->unknown[k]);
  PetscCall(VecRestoreArrayWrite(mode, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gram and Schmidt, twice: on a mesh fine at one end a turn about the middle of the box is almost a translation */
static PetscErrorCode AbutOrthonormalize_Private(PetscInt n, Vec mode[])
{
  PetscScalar dot[ABUT_MAX_MODES];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < n; ++k)
    for (PetscInt again = 0; again < 2; ++again) {
      PetscCall(VecMDot(mode[k], k, mode, dot));
      for (PetscInt i = 0; i < k; ++i) dot[i] = -dot[i];
      PetscCall(VecMAXPY(mode[k], k, dot, mode));
      PetscCall(VecNormalize(mode[k], NULL));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* As many boundary unknowns as there are motions, such that springs there resist all of them: rows of largest pivot, the first of equals,
   in the order of the contours, which no distribution changes */
static PetscErrorCode AbutBodyFindSupports_Private(AbutBody body, const AbutFreeMotions *f, PetscInt support[])
{
  const AbutBoundary *b = body->boundary;
  PetscReal          *row, lower[2], upper[2];

  PetscFunctionBegin;
  PetscCall(AbutMeshGetBox(body->mesh, lower, upper));
  PetscCall(PetscMalloc1(2 * b->nnodes * f->n, &row));
  for (PetscInt i = 0; i < b->nnodes; ++i)
    for (PetscInt k = 0; k < f->n; ++k) {
      const PetscReal scale = f->kind[k] == ABUT_TURN ? PetscMax(upper[0] - lower[0], upper[1] - lower[1]) : 1.;
      PetscReal       u[2];

      AbutMotionAt_Private(f->kind[k], f->center, b->x + 2 * i, u);
      for (PetscInt d = 0; d < 2; ++d) row[(2 * i + d) * f->n + k] = u[d] / scale;
    }
  for (PetscInt step = 0; step < f->n; ++step) {
    PetscReal pivot[ABUT_MAX_MODES] = {0.}, most = 0.;

    for (PetscInt i = 0; i < 2 * b->nnodes; ++i) {
      PetscReal norm = 0.;

      for (PetscInt k = 0; k < f->n; ++k) norm += PetscSqr(row[i * f->n + k]);
      if (norm <= most) continue;
      most          = norm;
      support[step] = 2 * body->boundaryglobal[i / 2] + i % 2;
      for (PetscInt k = 0; k < f->n; ++k) pivot[k] = row[i * f->n + k] / PetscSqrtReal(norm);
    }
    for (PetscInt i = 0; i < 2 * b->nnodes; ++i) {
      PetscReal dot = 0.;

      for (PetscInt k = 0; k < f->n; ++k) dot += row[i * f->n + k] * pivot[k];
      for (PetscInt k = 0; k < f->n; ++k) row[i * f->n + k] -= dot * pivot[k];
    }
  }
  PetscCall(PetscFree(row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A on springs. Forces without a part along the motions load no spring of a statically determinate support, so the solution with P is one
   with A. Soft springs do not disturb multigrid: with BoomerAMG, CG takes 12 iterations where it takes 10 for the body held, 13 with
   springs a hundred times stiffer, and 17 if the three unknowns are pinned instead, by which GAMG loses its way altogether. */
#define ABUT_SPRING 0.01 /* of the shear modulus */

static PetscErrorCode AbutBodySupport_Private(AbutBody body, const AbutFreeMotions *f)
{
  PetscInt support[ABUT_MAX_MODES], low, high;

  PetscFunctionBegin;
  PetscCall(AbutBodyFindSupports_Private(body, f, support));
  PetscCall(MatDuplicate(body->A, MAT_COPY_VALUES, &body->P));
  PetscCall(MatGetOwnershipRange(body->P, &low, &high));
  for (PetscInt k = 0; k < f->n; ++k)
    if (support[k] >= low && support[k] < high) PetscCall(MatSetValue(body->P, support[k], support[k], ABUT_SPRING * body->mu, ADD_VALUES));
  PetscCall(MatAssemblyBegin(body->P, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(body->P, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All three rigid motions, for multigrid that wants to know what is almost free */
static PetscErrorCode AbutBodySetNearNullSpace_Private(AbutBody body, const PetscReal center[2], Mat A)
{
  MatNullSpace near;
  Vec          mode[3];

  PetscFunctionBegin;
  if (!body->here) PetscFunctionReturn(PETSC_SUCCESS); /* vectors of no length cannot have length 1 */
  for (PetscInt k = 0; k < 3; ++k) {
    PetscCall(AbutBodyCreateVecOn_Private(body, body->group, &mode[k]));
    PetscCall(AbutBodySetMotion_Private(body, k, center, mode[k]));
  }
  PetscCall(AbutOrthonormalize_Private(3, mode));
  PetscCall(MatNullSpaceCreate(PetscObjectComm((PetscObject)A), PETSC_FALSE, 3, mode, &near));
  PetscCall(MatSetNearNullSpace(A, near));
  PetscCall(MatNullSpaceDestroy(&near));
  for (PetscInt k = 0; k < 3; ++k) PetscCall(VecDestroy(&mode[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The free modes of the present mesh */
PetscErrorCode AbutBodyModesCreate_Private(AbutBody body)
{
  AbutFreeMotions f;

  PetscFunctionBegin;
  PetscCall(AbutBodyFindFreeMotions_Private(body, &f));
  for (PetscInt k = 0; k < f.n; ++k) {
    PetscCall(AbutBodyCreateVec(body, &body->mode[k]));
    PetscCall(AbutBodySetMotion_Private(body, f.kind[k], f.center, body->mode[k]));
    PetscCall(VecISSet(body->mode[k], body->constrained, 0.));
  }
  body->nmodes = f.n;
  PetscCall(AbutOrthonormalize_Private(f.n, body->mode));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* They as the null space of the matrices of the group, which outlive every other look at them */
static PetscErrorCode AbutBodyCreateNullSpace_Private(AbutBody body, MatNullSpace *space)
{
  const PetscInt n = body->here ? body->nmodes : 0;
  Vec            mode[ABUT_MAX_MODES], group;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < n; ++k) {
    PetscCall(AbutBodyGetGroupVec_Private(body, body->mode[k], &group));
    PetscCall(VecDuplicate(group, &mode[k]));
    PetscCall(VecCopy(group, mode[k]));
    PetscCall(AbutBodyRestoreGroupVec_Private(body, body->mode[k], &group));
  }
  PetscCall(MatNullSpaceCreate(body->group, PETSC_FALSE, n, mode, space));
  for (PetscInt k = 0; k < n; ++k) PetscCall(VecDestroy(&mode[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The matrices of the solver: A, which knows its null space, and P, which has none */
PetscErrorCode AbutBodyModesSetUp_Private(AbutBody body)
{
  AbutFreeMotions f;
  PetscLogEvent   event;

  PetscFunctionBegin;
  PetscCall(AbutBodyFindFreeMotions_Private(body, &f));
  if (f.n) {
    PetscCall(AbutLogEventGet("AbutFreeModes", ABUTBODY_CLASSID, &event));
    PetscCall(PetscLogEventBegin(event, body, 0, 0, 0));
    PetscCall(AbutBodySupport_Private(body, &f));
    PetscCall(AbutBodyCreateNullSpace_Private(body, &body->free));
    PetscCall(MatSetNullSpace(body->A, body->free));
    PetscCall(MatSetOption(body->A, MAT_SYMMETRIC, PETSC_TRUE));
    PetscCall(PetscLogEventEnd(event, body, 0, 0, 0));
  } else {
    PetscCall(PetscObjectReference((PetscObject)body->A));
    body->P = body->A;
  }
  PetscCall(MatSetOption(body->P, MAT_SPD, PETSC_TRUE));
  PetscCall(AbutBodySetNearNullSpace_Private(body, f.center, body->A));
  if (f.n) PetscCall(AbutBodySetNearNullSpace_Private(body, f.center, body->P));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutBodyModesReset_Private(AbutBody body)
{
  PetscFunctionBegin;
  PetscCall(MatNullSpaceDestroy(&body->free));
  for (PetscInt k = 0; k < body->nmodes; ++k) PetscCall(VecDestroy(&body->mode[k]));
  PetscCall(MatDestroy(&body->P));
  body->nmodes = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyGetFreeModes - The free rigid motions as vectors of the present mesh

   Not Collective

   Input Parameter:
.  body - the body, set up

   Output Parameters:
+  n     - how many, 0 to 3
-  modes - [n] orthonormal vectors of the layout of `AbutBodyCreateVec()`, owned by the body, valid until its mesh adapts

   Level: intermediate

   Note:
   They span the motions of `AbutBodyGetFreeMotion()`, and vanish at all prescribed unknowns.

.seealso: `AbutBodyGetFreeModeCount()`, `AbutBodyMove()`, `AbutBodyGetImbalance()`
@*/
PetscErrorCode AbutBodyGetFreeModes(AbutBody body, PetscInt *n, const Vec *modes[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  PetscCall(AbutBodyNeedSetUp_Private(body));
  *n     = body->nmodes;
  *modes = body->mode;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyMove - Moves a body along its free modes; stresses and forces stay

   Collective

   Input Parameters:
+  body - the body, set up
-  a    - [n] how far along each vector of `AbutBodyGetFreeModes()`, the same on all ranks

   Level: intermediate

.seealso: `AbutBodyGetFreeModes()`, `AbutBodyUpdate()`
@*/
PetscErrorCode AbutBodyMove(AbutBody body, const PetscReal a[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  PetscCall(AbutBodyNeedSetUp_Private(body));
  if (!body->nmodes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecMAXPY(body->u, body->nmodes, a, body->mode));
  PetscCall(AbutBodySpread_Private(body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyGetImbalance - What the forces on a body have along its free modes: resultants that nothing balances

   Collective

   Input Parameters:
+  body    - the body, set up
-  contact - whether the contact forces that now act are to be counted, or the tractions alone

   Output Parameter:
.  r - [n] products of the nodal forces with the vectors of `AbutBodyGetFreeModes()`, 0 where that is round-off

   Level: intermediate

.seealso: `AbutBodyGetFreeModes()`, `AbutBodySolve()`
@*/
PetscErrorCode AbutBodyGetImbalance(AbutBody body, PetscBool contact, PetscReal r[])
{
  PetscScalar of[2][ABUT_MAX_MODES];
  PetscReal   size[2] = {0., 0.};

  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  PetscCall(AbutBodyNeedSetUp_Private(body));
  if (!body->nmodes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecMDot(body->load, body->nmodes, body->mode, of[0]));
  if (body->initial) { /* they have none, but for round-off */
    PetscCall(VecMDot(body->initialload, body->nmodes, body->mode, of[1]));
    for (PetscInt k = 0; k < body->nmodes; ++k) of[0][k] -= of[1][k];
  }
  PetscCall(VecNorm(body->load, NORM_2, &size[0]));
  for (PetscInt k = 0; k < body->nmodes; ++k) of[1][k] = 0.;
  if (contact) {
    PetscCall(VecMDot(body->contact, body->nmodes, body->mode, of[1]));
    PetscCall(VecNorm(body->contact, NORM_2, &size[1]));
  }
  for (PetscInt k = 0; k < body->nmodes; ++k) {
    r[k] = of[0][k] + of[1][k];
    if (PetscAbsReal(r[k]) <= 1e-14 * (size[0] + size[1])) r[k] = 0.;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
