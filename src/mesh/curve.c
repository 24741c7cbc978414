#include "first.h" /*I "abutmesh.h" I*/
#include <math.h>
#include <stdio.h>

/* Curved sides: the vertices by which a mesh is refined there move to the nearest point of the curve */

#define ABUT_CURVE_FITS       1e-6 /* of the length of a side: how far the vertices of the first mesh may be from the curve */
#define ABUT_CURVE_STEPS      50
#define ABUT_CURVE_DIFFERENCE 1e-6 /* of the length of a side: central differences of the gradient */

struct _AbutCurve {
  PetscReal      circle[3]; /* centre and radius */
  AbutExpression f;         /* 0 on the curve; NULL: a circle */
  PetscReal      length;    /* of the side in the first mesh, the scale */
};

PetscErrorCode AbutCurveDestroy_Private(AbutCurve *curve)
{
  PetscFunctionBegin;
  if (!*curve) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutExpressionDestroy(&(*curve)->f));
  PetscCall(PetscFree(*curve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Newton's method along the gradient, which stands on the curve where it ends; where it does not end, or there is no gradient, the point is
   no number, which whoever looks at areas or distances finds */
static PetscErrorCode AbutCurveNewton_Private(AbutCurve curve, PetscReal x[2])
{
  const PetscReal h = ABUT_CURVE_DIFFERENCE * curve->length, end = PETSC_SQRT_MACHINE_EPSILON * h;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < ABUT_CURVE_STEPS; ++i) {
    PetscReal f, g[2], g2, step;

    PetscCall(AbutExpressionEvaluate(curve->f, x, &f));
    for (PetscInt d = 0; d < 2; ++d) {
      PetscReal y[2] = {x[0], x[1]}, up, down;

      y[d] = x[d] + h;
      PetscCall(AbutExpressionEvaluate(curve->f, y, &up));
      y[d] = x[d] - h;
      PetscCall(AbutExpressionEvaluate(curve->f, y, &down));
      g[d] = (up - down) / (2. * h);
    }
    g2 = g[0] * g[0] + g[1] * g[1];
    if (!(g2 > 0.)) break;
    step = f / g2;
    for (PetscInt d = 0; d < 2; ++d) x[d] -= step * g[d];
    if (PetscAbsReal(step) * PetscSqrtReal(g2) <= end) PetscFunctionReturn(PETSC_SUCCESS);
  }
  x[0] = x[1] = NAN;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* To the nearest point of the curve of a side, if it has one */
PetscErrorCode AbutFirstMoveToCurve_Private(AbutFirst first, PetscInt side, PetscReal x[2])
{
  const AbutCurve curve = first->curve[side];

  PetscFunctionBegin;
  if (!curve) PetscFunctionReturn(PETSC_SUCCESS);
  if (curve->f) PetscCall(AbutCurveNewton_Private(curve, x));
  else {
    const PetscReal d[2] = {x[0] - curve->circle[0], x[1] - curve->circle[1]}, r = PetscSqrtReal(d[0] * d[0] + d[1] * d[1]);

    for (PetscInt i = 0; i < 2 && r > 0.; ++i) x[i] = curve->circle[i] + d[i] / r * curve->circle[2];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Collective: how many local cells lost their area by a move */
PetscErrorCode AbutFirstCheckMoved_Private(AbutMesh mesh, PetscInt bad)
{
  MPI_Comm comm = PetscObjectComm((PetscObject)mesh);

  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &bad, 1, MPIU_INT, MPI_SUM, comm));
  AbutCheckInput(!bad, comm,
                 "%smesh_file: %" PetscInt_FMT
                 " cells of %s lose their area where their sides move to the curve of mesh_curve; give a file "
                 "with smaller cells there",
                 ((PetscObject)mesh)->prefix ? ((PetscObject)mesh)->prefix : "", bad, mesh->first->path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutMeshSetCurve - Says on which curve a side of a mesh from a file lies

   Collective

   Input Parameters:
+  mesh - the mesh, its file set
.  side - number of the side
.  key  - the key the text comes from, for messages
-  text - `circle xc,yc,r`, or an expression in x and y that is 0 on the curve, and has a gradient there

   Level: intermediate

   Notes:
   The vertices by which cells are split on the side move to the nearest point of the curve: for an expression by Newton's method along its
   gradient. Those of the first mesh must lie on it, to 1e-6 of the length of the side. Without a curve a side stays the polygon of the
   file.

   Inside a cell with a curved side the new vertices move along, so that cells keep their shape.

   Limits: cells have straight sides, whatever the order of the displacement, so what is computed on a curved body is of second order. A
   first mesh that is so coarse that a cell would lose its area is bad input when it is refined.

.seealso: `AbutMeshSetFile()`, `AbutMeshAdapt()`
@*/
PetscErrorCode AbutMeshSetCurve(AbutMesh mesh, PetscInt side, const char key[], const char text[])
{
  MPI_Comm         comm = PetscObjectComm((PetscObject)mesh);
  double           c[3];
  const PetscReal *x;
  PetscInt         n;
  AbutCurve        curve;
  PetscBool        circle;
  PetscLogEvent    event;
  int              end = 0;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(mesh, ABUTMESH_CLASSID, 1);
  PetscCheck(mesh->first && !mesh->setupcalled, comm, PETSC_ERR_ORDER,
             "Call AbutMeshSetCurve() after AbutMeshSetFile() and before AbutMeshSetUp()");
  PetscCall(AbutMeshGetSideSegments(mesh, side, &n, &x));
  PetscCall(AbutCurveDestroy_Private(&mesh->first->curve[side]));
  PetscCall(PetscNew(&curve));
  PetscCall(PetscFree(mesh->first->curvetext[side]));
  PetscCall(PetscStrallocpy(text, &mesh->first->curvetext[side]));
  mesh->first->curve[side] = curve;
  mesh->first->curved      = PETSC_TRUE;
  for (PetscInt k = 0; k < n; ++k)
    curve->length += PetscSqrtReal(PetscSqr(x[4 * k + 2] - x[4 * k]) + PetscSqr(x[4 * k + 3] - x[4 * k + 1]));
  PetscCall(PetscStrbeginswith(text, "circle", &circle));
  if (circle) {
    AbutCheckInput(sscanf(text, "circle %lf , %lf , %lf %n", &c[0], &c[1], &c[2], &end) == 3 && !text[end] && c[2] > 0. &&
                     !PetscIsInfOrNanReal(c[0] + c[1] + c[2]),
                   comm, "%s: \"%s\" is no circle; give its centre and radius, for example circle 0,0,1", key, text);
    for (PetscInt i = 0; i < 3; ++i) curve->circle[i] = c[i];
  } else PetscCall(AbutExpressionCreate(comm, key, text, &curve->f));
  PetscCall(AbutLogEventGet("AbutCurve", ABUTMESH_CLASSID, &event));
  PetscCall(PetscLogEventBegin(event, mesh, 0, 0, 0));
  for (PetscInt k = 0; k < 2 * n; ++k) {
    PetscReal y[2] = {x[2 * k], x[2 * k + 1]}, distance;

    PetscCall(AbutFirstMoveToCurve_Private(mesh->first, side, y));
    distance = PetscSqrtReal(PetscSqr(y[0] - x[2 * k]) + PetscSqr(y[1] - x[2 * k + 1]));
    AbutCheckInput(!PetscIsNanReal(distance), comm,
                   "%s: from the vertex (%g, %g) of the file there is no way to a curve \"%s\" = 0; give a formula that is 0 on it, and "
                   "has a "
                   "gradient there",
                   key, (double)x[2 * k], (double)x[2 * k + 1], text);
    AbutCheckInput(distance <= ABUT_CURVE_FITS * curve->length, comm,
                   "%s: the vertex (%g, %g) of the file is %g away from \"%s\"; give the curve on which the side lies", key,
                   (double)x[2 * k], (double)x[2 * k + 1], (double)distance, text);
  }
  PetscCall(PetscLogEventEnd(event, mesh, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The keys mesh_curve_SIDE */
PetscErrorCode AbutFirstCurvesFromOptions_Private(AbutMesh mesh)
{
  const char *prefix = ((PetscObject)mesh)->prefix ? ((PetscObject)mesh)->prefix : "";

  PetscFunctionBegin;
  PetscObjectOptionsBegin((PetscObject)mesh);
  for (PetscInt s = 0; s < mesh->first->nsides; ++s) {
    char      opt[128], key[256], text[PETSC_MAX_PATH_LEN] = "";
    PetscBool set;

    PetscCall(PetscSNPrintf(opt, sizeof(opt), "-mesh_curve_%s", mesh->first->name[s]));
    PetscCall(PetscSNPrintf(key, sizeof(key), "%s%s", prefix, opt + 1));
    PetscCall(AbutOptionsString(PetscOptionsObject, opt, "Curve on which the side lies", text, sizeof(text), &set));
    if (set) PetscCall(AbutMeshSetCurve(mesh, s, key, text));
  }
  PetscOptionsEnd();
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether a point of a first cell is beyond a curve that bends into the body: the cells of finer meshes leave such a point out */
PetscErrorCode AbutFirstBeyondCurve_Private(AbutFirst first, const PetscReal x[2], PetscBool *beyond)
{
  const PetscReal tiny = 1e-9; /* of the length of the segment, as for cells */

  PetscFunctionBegin;
  *beyond = PETSC_FALSE;
  for (PetscInt s = 0; s < first->nsides && !*beyond; ++s)
    for (PetscInt k = first->segments[s]; k < first->segments[s + 1] && first->curve[s] && !*beyond; ++k) {
      const PetscReal *a = first->segment + 4 * k, d[2] = {a[2] - a[0], a[3] - a[1]}, length2 = d[0] * d[0] + d[1] * d[1];
      const PetscReal  t    = (d[0] * (x[0] - a[0]) + d[1] * (x[1] - a[1])) / length2;
      PetscReal        y[2] = {a[0] + t * d[0], a[1] + t * d[1]}, foot[2] = {x[0], x[1]}, rise, height; /* to the left, times the length */

      if (t < 0. || t > 1.) continue;
      height = d[0] * (x[1] - a[1]) - d[1] * (x[0] - a[0]);
      PetscCall(AbutFirstMoveToCurve_Private(first, s, y));
      rise = d[0] * (y[1] - a[1]) - d[1] * (y[0] - a[0]);
      if (height > 2. * rise) continue; /* nearly above each other, and further away the nearest point may be that of another segment */
      PetscCall(AbutFirstMoveToCurve_Private(first, s, foot));
      *beyond = (PetscBool)(d[0] * (x[1] - foot[1]) - d[1] * (x[0] - foot[0]) < -tiny * length2);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutMeshGetCurvePoint - The point of the curve of a side that is nearest to a point

   Not Collective

   Input Parameters:
+  mesh - the mesh
.  side - number of the side
-  x    - [2] the point

   Output Parameter:
.  foot - [2] the point of the curve; x itself where the side is a polygon

   Level: developer

.seealso: `AbutMeshSetCurve()`
@*/
PetscErrorCode AbutMeshGetCurvePoint(AbutMesh mesh, PetscInt side, const PetscReal x[2], PetscReal foot[2])
{
  PetscFunctionBegin;
  for (PetscInt d = 0; d < 2; ++d) foot[d] = x[d];
  if (mesh->first) PetscCall(AbutFirstMoveToCurve_Private(mesh->first, side, foot));
  PetscFunctionReturn(PETSC_SUCCESS);
}
