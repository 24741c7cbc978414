#include <abut/private/pairimpl.h> /*I "abutpair.h" I*/

/* The gap of a pair before anything moves */

/*@C
   AbutPairGetGap - The gap f at a point of the pressure side, where it is given or the sides are straight

   Not Collective

   Input Parameters:
+  pair - the pair
-  x    - [2] the point

   Output Parameter:
.  gap - f, length; without `-NAME_pair_gap` the distance of the sides; less what the sides stand out

   Level: intermediate

.seealso: `AbutPairGetNodeGap()`, `AbutPairComputePressure()`
@*/
PetscErrorCode AbutPairGetGap(AbutPair pair, const PetscReal x[2], PetscReal *gap)
{
  PetscFunctionBegin;
  if (pair->gap) PetscCall(AbutExpressionEvaluate(pair->gap, x, gap));
  else PetscCall(AbutPairGetDistance_Private(pair, gap));
  PetscCall(AbutPairCloseGap_Private(pair, x, gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sides that stand out of their bodies leave less of a gap */
PetscErrorCode AbutPairCloseGap_Private(AbutPair pair, const PetscReal x[2], PetscReal *gap)
{
  PetscFunctionBegin;
  for (PetscInt s = 0; s < 2 && pair->body[s]; ++s) {
    PetscReal offset;

    PetscCall(AbutBodyGetSideOffset(pair->body[s], pair->side[s], x, &offset));
    *gap -= offset;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Against what the one body of a pair presses: an obstacle, or what the gap says. Only with one body the key is read. */
PetscErrorCode AbutPairObstacleFromOptions_Private(AbutPair pair)
{
  const MPI_Comm comm                     = PetscObjectComm((PetscObject)pair);
  const char    *name                     = ((PetscObject)pair)->name;
  char           text[PETSC_MAX_PATH_LEN] = "", key[256];
  PetscBool      given;

  PetscFunctionBegin;
  if (pair->body[1]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscObjectOptionsBegin((PetscObject)pair);
  PetscCall(AbutOptionsString(PetscOptionsObject, "-pair_obstacle", "Distance of a rigid obstacle", text, sizeof(text), &given));
  PetscOptionsEnd();
  AbutCheckInput(given != (PetscBool)(pair->gap != NULL), comm,
                 "%s_pair_bodies: one body presses against something rigid; give %s_pair_obstacle, its distance in x and y, or "
                 "%s_pair_gap, and not "
                 "both; or a second body",
                 name, name, name);
  PetscCall(PetscSNPrintf(key, sizeof(key), "%s_pair_obstacle", name));
  if (given) PetscCall(AbutExpressionCreate(comm, key, text, &pair->obstacle));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define ABUT_OBSTACLE_STEPS 50

/* How far an obstacle is from x along a normal: where its distance changes sign, by the rule of false position with half weights
   (Illinois). A point that looks past the obstacle is as far from it as it is. */
PetscErrorCode AbutPairObstacleGap_Private(AbutPair pair, const PetscReal x[2], const PetscReal normal[2], PetscReal *gap)
{
  PetscReal t[2] = {0., 0.}, f[2], at[2], here;

  PetscFunctionBegin;
  PetscCall(AbutExpressionEvaluate(pair->obstacle, x, &here));
  *gap = t[1] = here;
  f[0] = f[1] = here;
  for (PetscInt step = 0; step < 8 && f[0] * f[1] > 0.; ++step) { /* a bracket: twice as far each time */
    for (PetscInt d = 0; d < 2; ++d) at[d] = x[d] + t[1] * normal[d];
    PetscCall(AbutExpressionEvaluate(pair->obstacle, at, &f[1]));
    if (f[0] * f[1] > 0.) t[1] *= 2.;
  }
  if (f[0] * f[1] > 0.) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt step = 0; step < ABUT_OBSTACLE_STEPS && f[1] != 0.; ++step) {
    const PetscReal middle = t[1] - f[1] * (t[1] - t[0]) / (f[1] - f[0]);
    PetscReal       value;

    for (PetscInt d = 0; d < 2; ++d) at[d] = x[d] + middle * normal[d];
    PetscCall(AbutExpressionEvaluate(pair->obstacle, at, &value));
    if (value * f[1] < 0.) {
      t[0] = t[1];
      f[0] = f[1];
    } else f[0] *= 0.5;
    if (middle == t[1]) break;
    t[1] = middle;
    f[1] = value;
  }
  *gap = t[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutPairGetNodeGap - The gap f at a node of the pressure side

   Not Collective

   Input Parameters:
+  pair - the pair, set up
-  i    - number of the node on the pressure side

   Output Parameter:
.  gap - f, length; 0 at nodes that carry no pressure

   Level: intermediate

.seealso: `AbutPairGetGap()`, `AbutPairGetPressureNodes()`
@*/
PetscErrorCode AbutPairGetNodeGap(AbutPair pair, PetscInt i, PetscReal *gap)
{
  const AbutSide  *m = pair->nodes[pair->which], *o = pair->body[1] ? pair->nodes[!pair->which] : NULL;
  const PetscReal *s = pair->place[1], place = pair->place[0][i];
  PetscInt         element[2] = {PetscMin(i, m->n - 2) / m->order, 0}, high = o ? (o->n - 1) / o->order : 0;
  PetscReal        at[2], normal[2];

  PetscFunctionBegin;
  *gap = 0.;
  if (pair->D[i] <= 0.) PetscFunctionReturn(PETSC_SUCCESS);
  while (high - element[1] > 1) { /* the other side's places descend */
    const PetscInt middle = (element[1] + high) / 2;

    if (s[o->order * middle] >= place) element[1] = middle;
    else high = middle;
  }
  PetscCall(AbutPairFace_Private(pair, element, place, at, normal, gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define ABUT_DISTANCE 2. /* what an obstacle's expression changes by is at most so many times the way, and at least that part of it */

/* Is the expression of an obstacle a distance at a point, or nearly? Otherwise its change of sign would not be found. h is the length of a
   segment of the side. */
static PetscErrorCode AbutPairCheckDistance_Private(AbutPair pair, const PetscReal x[2], PetscReal h)
{
  const PetscReal step = 1e-4 * h;
  PetscReal       g[2], size;

  PetscFunctionBegin;
  for (PetscInt d = 0; d < 2; ++d) {
    PetscReal at[2] = {x[0], x[1]}, up, down;

    at[d] = x[d] + step;
    PetscCall(AbutExpressionEvaluate(pair->obstacle, at, &up));
    at[d] = x[d] - step;
    PetscCall(AbutExpressionEvaluate(pair->obstacle, at, &down));
    g[d] = (up - down) / (2. * step);
  }
  size = PetscSqrtReal(g[0] * g[0] + g[1] * g[1]);
  AbutCheckInput(size <= ABUT_DISTANCE && size >= 1. / ABUT_DISTANCE, PetscObjectComm((PetscObject)pair),
                 "%s_pair_obstacle: no distance at (%g, %g), where it changes by %.3g in a way of 1; give for example y, or "
                 "sqrt(x^2+(y-8)^2)-8",
                 ((PetscObject)pair)->name, (double)x[0], (double)x[1], (double)size);
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define ABUT_SAMPLES 32

/*@
   AbutPairCheck - Ends the run if the gap is not a finite number on the first side; needs no meshes yet

   Collective

   Input Parameter:
.  pair - the pair, its keys read

   Level: developer

   Note:
   Looks at some points of the side.

.seealso: `AbutPairSetUp()`, `AbutBodyCheck()`
@*/
PetscErrorCode AbutPairCheck(AbutPair pair)
{
  const AbutExpression given = pair->obstacle ? pair->obstacle : pair->gap;
  AbutMesh             mesh;
  const PetscReal     *p;
  PetscReal            gap;
  PetscInt             n, samples;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(pair, ABUTPAIR_CLASSID, 1);
  if (!given) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutBodyGetMesh(pair->body[0], &mesh));
  PetscCall(AbutMeshGetSideSegments(mesh, pair->side[0], &n, &p));
  samples = n > 1 ? 2 : ABUT_SAMPLES;
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt k = 0; k < samples; ++k) {
      const PetscReal z    = n > 1 ? k : k / (ABUT_SAMPLES - 1.);
      const PetscReal x[2] = {(1. - z) * p[4 * i] + z * p[4 * i + 2], (1. - z) * p[4 * i + 1] + z * p[4 * i + 3]};

      PetscCall(AbutExpressionEvaluate(given, x, &gap));
      if (pair->obstacle) PetscCall(AbutPairCheckDistance_Private(pair, x, PetscSqrtReal(PetscSqr(p[2] - p[0]) + PetscSqr(p[3] - p[1]))));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPairGetOverlap - How deep the sides of a pair lie in each other before anything moves

   Not Collective

   Input Parameter:
.  pair - the pair, set up

   Output Parameters:
+  depth - the largest of what the gap is below 0 at the nodes that carry pressures, length; 0 where the sides only touch
-  x     - where, not set if they only touch

   Level: intermediate

   Note:
   Contact pushes the bodies apart by it, which is what a scene with an interference fit wants and most others do not.

.seealso: `AbutPairGetGap()`, `AbutPairComputePenetration()`
@*/
PetscErrorCode AbutPairGetOverlap(AbutPair pair, PetscReal *depth, PetscReal x[2])
{
  const AbutSide *side = pair->nodes[pair->which];
  const PetscReal near = 1e-9 * pair->place[0][side->n - 1];

  PetscFunctionBegin;
  *depth = 0.;
  for (PetscInt i = 0; i < side->n; ++i) {
    PetscReal gap;

    if (pair->D[i] <= 0.) continue;
    PetscCall(AbutPairGetNodeGap(pair, i, &gap));
    if (-gap <= PetscMax(near, *depth)) continue;
    *depth = -gap;
    PetscCall(PetscArraycpy(x, side->x + 2 * i, 2));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
