#include <abut/private/pairimpl.h> /*I "abutpair.h" I*/

/*@C
   AbutPairGetGap - The gap f at a point of the pressure side

   Not Collective

   Input Parameters:
+  pair - the pair
-  x    - [2] the point

   Output Parameter:
.  gap - f, length; without `-NAME_pair_gap` the distance of the sides; less what the sides stand out

   Level: intermediate

.seealso: `AbutPairComputePressure()`
@*/
PetscErrorCode AbutPairGetGap(AbutPair pair, const PetscReal x[2], PetscReal *gap)
{
  PetscFunctionBegin;
  if (pair->gap) PetscCall(AbutExpressionEvaluate(pair->gap, x, gap));
  else PetscCall(AbutPairGetDistance_Private(pair, gap));
  for (PetscInt s = 0; s < 2; ++s) {
    PetscReal offset;

    PetscCall(AbutBodyGetSideOffset(pair->body[s], pair->side[s], x, &offset));
    *gap -= offset;
  }
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
  AbutMesh  mesh;
  PetscReal ends[4], normal[2], gap;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(pair, ABUTPAIR_CLASSID, 1);
  PetscCall(AbutBodyGetMesh(pair->body[0], &mesh));
  PetscCall(AbutMeshGetSideEnds(mesh, pair->side[0], ends, normal));
  for (PetscInt i = 0; i < ABUT_SAMPLES; ++i) {
    const PetscReal z = i / (ABUT_SAMPLES - 1.), x[2] = {(1. - z) * ends[0] + z * ends[2], (1. - z) * ends[1] + z * ends[3]};

    PetscCall(AbutPairGetGap(pair, x, &gap));
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
  const PetscReal near = 1e-9 * AbutPairPlace_Private(pair, side->n - 1);

  PetscFunctionBegin;
  *depth = 0.;
  for (PetscInt i = 0; i < side->n; ++i) {
    PetscReal gap;

    if (pair->D[i] <= 0.) continue;
    PetscCall(AbutPairGetGap(pair, side->x + 2 * i, &gap));
    if (-gap <= PetscMax(near, *depth)) continue;
    *depth = -gap;
    PetscCall(PetscArraycpy(x, side->x + 2 * i, 2));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPairComputePressure - Nodal pressures of the penalty law, p = max(0, u_n1 + u_n2 - f)/theta, for given traces: eqs. (15), (20) of the
   paper

   Not Collective

   Input Parameters:
+  pair - the pair, set up
.  u1   - [n1] normal displacements at the nodes of the first side, length
-  u2   - [n2] the same on the second side

   Output Parameter:
.  p - [nodes of the pressure side] pressures, stress; 0 at nodes that carry none

   Level: intermediate

.seealso: `AbutPairComputeForce()`, `AbutPairGetPressureNodes()`
@*/
PetscErrorCode AbutPairComputePressure(AbutPair pair, const PetscReal u1[], const PetscReal u2[], PetscReal p[])
{
  PetscFunctionBegin;
  PetscCall(AbutPairComputePenetration(pair, u1, u2, p));
  for (PetscInt i = 0; i < pair->n[pair->which]; ++i) p[i] = PetscMax(0., p[i]) / pair->theta;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPairComputeForce - Nodal normal forces on both sides of nodal pressures, the pressing direction positive

   Not Collective

   Input Parameters:
+  pair - the pair, set up
-  p    - [nodes of the pressure side] pressures, stress

   Output Parameters:
+  f1 - [n1] integrals of the pressure against the functions of the first side's nodes, stress times length
-  f2 - [n2] the same on the second side

   Level: intermediate

.seealso: `AbutPairComputePressure()`
@*/
PetscErrorCode AbutPairComputeForce(AbutPair pair, const PetscReal p[], PetscReal f1[], PetscReal f2[])
{
  PetscReal *const f[2]     = {f1, f2};
  PetscReal *const force[2] = {f[pair->which], f[!pair->which]};

  PetscFunctionBegin;
  for (PetscInt s = 0; s < 2; ++s)
    for (PetscInt i = 0; i < pair->n[s]; ++i) f[s][i] = 0.;
  for (PetscInt g = 0; g < pair->nsegments; ++g) {
    const AbutSegment *seg = &pair->segment[g];

    for (PetscInt i = 0; i <= pair->order[0]; ++i)
      for (PetscInt side = 0; side < 2; ++side)
        for (PetscInt j = 0; j <= pair->order[side]; ++j)
          force[side][pair->order[side] * seg->element[side] + j] += seg->M[side][i][j] * p[pair->order[0] * seg->element[0] + i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPairComputeSupport - Traces of two bodies that follow their supports without deforming

   Not Collective

   Input Parameter:
.  pair - the pair, set up

   Output Parameters:
+  u1 - [n1] normal displacements at the nodes of the first side: what is prescribed on the side opposite to it, 0 if nothing is; length
-  u2 - [n2] the same on the second side

   Level: developer

.seealso: `AbutPairComputeWinkler()`, `SNESDDACTIVE`
@*/
PetscErrorCode AbutPairComputeSupport(AbutPair pair, PetscReal u1[], PetscReal u2[])
{
  PetscReal *const u[2] = {u1, u2};
  PetscBool        found;

  PetscFunctionBegin;
  for (PetscInt s = 0; s < 2; ++s)
    for (PetscInt i = 0; i < pair->n[s]; ++i)
      PetscCall(AbutBodyGetSupportDisplacement(pair->body[s], pair->nodes[s]->x + 2 * i, pair->nodes[s]->normal, &u[s][i], &found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPairComputeWinkler - Traces of two elastic layers on their supports, p = max(0, approach - f)/(theta + C1 + C2): the paper's start

   Not Collective

   Input Parameter:
.  pair - the pair, set up

   Output Parameters:
+  u1    - [n1] normal displacements at the nodes of the first side, length
.  u2    - [n2] the same on the second side
-  found - `PETSC_FALSE` where a body has no support with prescribed displacement opposite to its side; u1, u2 are then not set

   Level: intermediate

.seealso: `AbutInterfaceComputeStart()`, `AbutPairGetCompliance()`
@*/
PetscErrorCode AbutPairComputeWinkler(AbutPair pair, PetscReal u1[], PetscReal u2[], PetscBool *found)
{
  PetscReal *const u[2] = {u1, u2};
  PetscReal        compliance[2];

  PetscFunctionBegin;
  PetscCall(AbutPairGetCompliance(pair, compliance));
  for (PetscInt s = 0; s < 2; ++s)
    for (PetscInt i = 0; i < pair->n[s]; ++i) {
      const PetscReal *x = pair->nodes[s]->x + 2 * i;
      PetscReal        base[2], f, p;

      for (PetscInt b = 0; b < 2; ++b) {
        PetscCall(AbutBodyGetSupportDisplacement(pair->body[b], x, pair->nodes[b]->normal, &base[b], found));
        if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
      }
      PetscCall(AbutPairGetGap(pair, x, &f));
      p       = PetscMax(0., base[0] + base[1] - f) / (pair->theta + compliance[0] + compliance[1]);
      u[s][i] = base[s] - p * compliance[s];
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPairGetPressureNodes - The nodes that carry pressures

   Not Collective

   Input Parameter:
.  pair - the pair, set up

   Output Parameters:
+  which - 0 or 1: the side that carries them
.  n     - its nodes
.  x     - [2*n] their coordinates
-  D     - [n] integrals of their dual functions, length; 0 where a node carries no pressure

   Level: intermediate

.seealso: `AbutPairComputePressure()`
@*/
PetscErrorCode AbutPairGetPressureNodes(AbutPair pair, PetscInt *which, PetscInt *n, const PetscReal *x[], const PetscReal *D[])
{
  PetscFunctionBegin;
  *which = pair->which;
  *n     = pair->n[pair->which];
  *x     = pair->nodes[pair->which]->x;
  *D     = pair->D;
  PetscFunctionReturn(PETSC_SUCCESS);
}
