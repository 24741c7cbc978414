#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/

/* The material of a body, what its two coordinates are, and what that makes of its material and its measures */

const char *const AbutKinematicsNames[] = {"plane strain", "plane stress", "axial symmetry", "AbutKinematics", "ABUT_", NULL};

/*@
   AbutBodySetMaterial - Sets the elastic constants, eq. (2) of the paper

   Logically Collective

   Input Parameters:
+  body    - the body
.  young   - Young's modulus, > 0, stress
-  poisson - Poisson's ratio, -1 < nu < 0.5

   Level: beginner

.seealso: `AbutBodySetFromOptions()`, `AbutBodyGetMaterial()`
@*/
PetscErrorCode AbutBodySetMaterial(AbutBody body, PetscReal young, PetscReal poisson)
{
  MPI_Comm    comm = PetscObjectComm((PetscObject)body);
  const char *name = ((PetscObject)body)->name;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  AbutCheckInput(young > 0., comm, "%s_material_young: %g is not a modulus; give a positive number, for example 2.1e5", name,
                 (double)young);
  AbutCheckInput(poisson > -1. && poisson < 0.5, comm, "%s_material_poisson: %g; plane strain needs -1 < nu < 0.5, for example 0.3", name,
                 (double)poisson);
  body->young   = young;
  body->poisson = poisson;
  PetscCall(AbutBodySetLame_Private(body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetMaterial - The elastic constants

   Not Collective

   Input Parameter:
.  body - the body

   Output Parameters:
+  young   - Young's modulus, stress
-  poisson - Poisson's ratio

   Level: beginner

.seealso: `AbutBodySetMaterial()`, `AbutBodyGetPlaneMaterial()`
@*/
PetscErrorCode AbutBodyGetMaterial(AbutBody body, PetscReal *young, PetscReal *poisson)
{
  PetscFunctionBegin;
  *young   = body->young;
  *poisson = body->poisson;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodySetKinematics - What the two coordinates of a body are

   Logically Collective

   Input Parameters:
+  body       - the body
-  kinematics - `ABUT_PLANE_STRAIN`, the default: nothing moves across the plane; `ABUT_PLANE_STRESS`: a thin sheet, with no stress across
                the plane; `ABUT_AXISYMMETRIC`: x is the radius, y the axis, and u1/x the strain around it

   Level: intermediate

   Notes:
   Plane stress changes one constant, lambda to 2 lambda mu/(lambda + 2 mu): in the plane the sheet is a body in plane strain with the
   constants of `AbutBodyGetPlaneMaterial()`.

   With axial symmetry the hoop stress is the fourth component of the stress, forces and energies are those of a whole turn, the points of
   the axis stay on it, and the only rigid motion is along y.

   Limits: with axial symmetry a body lies in x >= 0 and has no twist.

.seealso: `AbutBodyGetKinematics()`, `AbutBodyGetThickness()`, `AbutBodyGetCellStresses3D()`
@*/
PetscErrorCode AbutBodySetKinematics(AbutBody body, AbutKinematics kinematics)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  body->kinematics = kinematics;
  body->cell       = kinematics == ABUT_AXISYMMETRIC ? &AbutCellOps_Axisymmetric : &AbutCellOps_Plane;
  PetscCall(AbutBodySetLame_Private(body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetKinematics - What the two coordinates of a body are

   Not Collective

   Input Parameter:
.  body - the body

   Output Parameter:
.  kinematics - plane strain, plane stress or axial symmetry

   Level: intermediate

.seealso: `AbutBodySetKinematics()`
@*/
PetscErrorCode AbutBodyGetKinematics(AbutBody body, AbutKinematics *kinematics)
{
  PetscFunctionBegin;
  *kinematics = body->kinematics;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lame's constants of the plane; what was set up is no longer right */
PetscErrorCode AbutBodySetLame_Private(AbutBody body)
{
  PetscReal young, poisson;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetPlaneMaterial(body, &young, &poisson));
  body->lambda     = young * poisson / ((1. + poisson) * (1. - 2. * poisson));
  body->mu         = young / (2. * (1. + poisson));
  body->generation = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetPlaneMaterial - The elastic constants with which the formulas of plane strain hold

   Not Collective

   Input Parameter:
.  body - the body

   Output Parameters:
+  young   - E, or in plane stress E (1 + 2 nu)/(1 + nu)^2, stress
-  poisson - nu, or in plane stress nu/(1 + nu)

   Level: intermediate

   Note:
   The shear modulus is the same; the compliance (1 - nu^2)/E of plane strain becomes 1/E.

.seealso: `AbutBodyGetMaterial()`, `AbutBodySetKinematics()`
@*/
PetscErrorCode AbutBodyGetPlaneMaterial(AbutBody body, PetscReal *young, PetscReal *poisson)
{
  const PetscReal E = body->young, nu = body->poisson;

  PetscFunctionBegin;
  *young   = body->kinematics == ABUT_PLANE_STRESS ? E * (1. + 2. * nu) / PetscSqr(1. + nu) : E;
  *poisson = body->kinematics == ABUT_PLANE_STRESS ? nu / (1. + nu) : nu;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetThickness - What a length or an area at a point of the plane stands for

   Not Collective

   Input Parameters:
+  body - the body
-  x    - [2] the point

   Output Parameter:
.  thickness - 1, or the circumference 2 pi x[0] with axial symmetry, length

   Level: intermediate

.seealso: `AbutBodySetKinematics()`, `AbutBodyGetCellMeasure()`
@*/
PetscErrorCode AbutBodyGetThickness(AbutBody body, const PetscReal x[2], PetscReal *thickness)
{
  PetscFunctionBegin;
  *thickness = body->kinematics == ABUT_AXISYMMETRIC ? 2. * PETSC_PI * x[0] : 1.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetCellMeasure - The area of a local cell, or with axial symmetry the volume of its ring

   Not Collective

   Input Parameters:
+  body - the body
-  c    - local cell

   Output Parameter:
.  measure - its area or volume

   Level: intermediate

.seealso: `AbutBodyGetCellPoint()`, `AbutMeshGetCellArea()`
@*/
PetscErrorCode AbutBodyGetCellMeasure(AbutBody body, PetscInt c, PetscReal *measure)
{
  const AbutMeshTopology *t;

  PetscFunctionBegin;
  if (body->kinematics != ABUT_AXISYMMETRIC) {
    PetscCall(AbutMeshGetCellArea(body->mesh, c, measure));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  *measure = 0.;
  for (PetscInt k = 0; k < t->corners; ++k) { /* the integral of x over a polygon */
    const PetscReal *p = &t->x[2 * t->cell[t->corners * c + k]], *q = &t->x[2 * t->cell[t->corners * c + (k + 1) % t->corners]];

    *measure += PETSC_PI / 3. * (p[0] + q[0]) * (p[0] * q[1] - p[1] * q[0]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* On the axis of symmetry, or next to it as far as coordinates are known */
PetscBool AbutBodyOnAxis_Private(AbutBody body, const PetscReal x[2])
{
  PetscReal lower[2] = {0., 0.}, upper[2] = {0., 0.};

  if (body->kinematics != ABUT_AXISYMMETRIC) return PETSC_FALSE;
  (void)AbutMeshGetBox(body->mesh, lower, upper);
  return (PetscBool)(PetscAbsReal(x[0]) <= 1e-12 * upper[0]);
}

/* A side on the axis has no area that a traction could act on, and moves along the axis only */
static PetscErrorCode AbutBodyCheckAxis_Private(AbutBody body, PetscInt side)
{
  const char      *name;
  const PetscReal *x;
  PetscReal        u = 0.;
  PetscInt         n;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetSideName(body->mesh, side, &name));
  PetscCall(AbutMeshGetSideSegments(body->mesh, side, &n, &x));
  for (PetscInt k = 0; k < 2 * n; ++k)
    if (!AbutBodyOnAxis_Private(body, x + 2 * k)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt d = 0; d < 2; ++d) {
    const AbutCondition *c = &body->condition[side][d];

    AbutCheckInput(c->type != ABUT_TRACTION || !c->value, PetscObjectComm((PetscObject)body),
                   "%s_bc_%s_t%d: the side is the axis, which has no area; leave it out", ((PetscObject)body)->name, name, (int)d + 1);
    for (PetscInt k = 0; k < 2 * n && !d && c->type == ABUT_DISPLACEMENT; ++k) {
      PetscCall(AbutExpressionEvaluate(c->value, x + 2 * k, &u));
      AbutCheckInput(u == 0., PetscObjectComm((PetscObject)body),
                     "%s_bc_%s_u1: %g, but the side is the axis, which stays; give 0, or leave it out", ((PetscObject)body)->name, name,
                     (double)u);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutBodyCheckKinematics_Private(AbutBody body)
{
  PetscReal lower[2], upper[2];
  PetscInt  nsides;

  PetscFunctionBegin;
  if (body->kinematics != ABUT_AXISYMMETRIC) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutMeshGetBox(body->mesh, lower, upper));
  AbutCheckInput(lower[0] >= 0. || AbutBodyOnAxis_Private(body, lower), PetscObjectComm((PetscObject)body),
                 "%s_mesh_*: begins at x = %g; with axial symmetry x is the radius, give a mesh in x >= 0", ((PetscObject)body)->name,
                 (double)lower[0]);
  PetscCall(AbutMeshGetSideCount(body->mesh, &nsides));
  for (PetscInt s = 0; s < nsides; ++s) PetscCall(AbutBodyCheckAxis_Private(body, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
