#include <abut/private/pairimpl.h> /*I "abutpair.h" I*/

/*@C
   AbutPairComputePressure - Nodal pressures of the penalty law, p = max(0, u_n1 + u_n2 - f)/theta, for given traces: eqs. (15), (20) of the
   paper; with friction also the tangential tractions

   Not Collective

   Input Parameters:
+  pair - the pair, set up
.  u1   - [components*n1] displacements at the nodes of the first side, length
-  u2   - [components*n2] the same on the second side

   Output Parameter:
.  p - [nodes of the pressure side] pressures, stress; 0 at nodes that carry none; with friction [2*nodes], the tangential tractions behind

   Level: intermediate

.seealso: `AbutPairComputeForce()`, `AbutPairGetPressureNodes()`
@*/
PetscErrorCode AbutPairComputePressure(AbutPair pair, const PetscReal u1[], const PetscReal u2[], PetscReal p[])
{
  PetscFunctionBegin;
  PetscCall(AbutPairComputePenetration(pair, u1, u2, p));
  for (PetscInt i = 0; i < pair->n[pair->which]; ++i) p[i] = PetscMax(0., p[i]) / pair->theta;
  if (pair->friction) PetscCall(AbutPairFrictionLaw_Private(pair, u1, u2, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPairComputeForce - Nodal forces on both sides of nodal pressures, along the outward normals: against the pressing direction

   Not Collective

   Input Parameters:
+  pair - the pair, set up
-  p    - [nodes of the pressure side] pressures, stress; with friction [2*nodes], the tangential tractions behind

   Output Parameters:
+  f1 - [components*n1] integrals of the pressure against the functions of the first side's nodes, stress times length
-  f2 - [components*n2] the same on the second side

   Level: intermediate

.seealso: `AbutPairComputePressure()`
@*/
PetscErrorCode AbutPairComputeForce(AbutPair pair, const PetscReal p[], PetscReal f1[], PetscReal f2[])
{
  PetscReal *const f[2]     = {f1, f2};
  PetscReal *const force[2] = {f[pair->which], f[!pair->which]};

  PetscFunctionBegin;
  for (PetscInt s = 0; s < 2; ++s)
    for (PetscInt i = 0; i < pair->components * pair->n[s]; ++i) f[s][i] = 0.;
  for (PetscInt g = 0; g < pair->nsegments; ++g) {
    const AbutSegment *seg = &pair->segment[g];

    for (PetscInt i = 0; i <= pair->order[0]; ++i)
      for (PetscInt side = 0; side < 2; ++side)
        for (PetscInt j = 0; j <= pair->order[side]; ++j)
          for (PetscInt d = 0; d < pair->components; ++d)
            force[side][pair->components * (pair->order[side] * seg->element[side] + j) + d] += AbutSegmentWeight_Private(pair, g, side, d,
                                                                                                                          i, j) *
                                                                                                p[pair->order[0] * seg->element[0] + i];
  }
  if (pair->friction) PetscCall(AbutPairFrictionForce_Private(pair, p + pair->n[pair->which], force));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPairSetNormalTrace - Makes a trace of displacements along the outward normal of a side

   Not Collective

   Input Parameters:
+  pair - the pair, set up
.  side - 0 or 1
-  un   - [nodes of the side] normal displacements, length

   Output Parameter:
.  trace - [components*nodes of the side] the trace

   Level: developer

.seealso: `AbutPairGetComponents()`, `AbutPairComputeSupport()`
@*/
PetscErrorCode AbutPairSetNormalTrace(AbutPair pair, PetscInt side, const PetscReal un[], PetscReal trace[])
{
  PetscFunctionBegin;
  for (PetscInt i = pair->n[side] - 1; i >= 0; --i) { /* backwards: both may be one array */
    PetscReal normal[2];

    PetscCall(AbutSideGetNodeNormal(pair->nodes[side], i, normal));
    if (pair->components == 1) trace[i] = un[i];
    else
      for (PetscInt d = 1; d >= 0; --d) trace[2 * i + d] = un[i] * normal[d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPairComputeSupport - Traces of two bodies that follow their supports without deforming

   Not Collective

   Input Parameter:
.  pair - the pair, set up

   Output Parameters:
+  u1 - [components*n1] displacements at the nodes of the first side: what is prescribed on the side opposite to it, 0 if nothing is; length
-  u2 - [components*n2] the same on the second side

   Level: developer

.seealso: `AbutPairComputeWinkler()`, `SNESDDACTIVE`
@*/
PetscErrorCode AbutPairComputeSupport(AbutPair pair, PetscReal u1[], PetscReal u2[])
{
  PetscReal *const u[2] = {u1, u2};
  PetscBool        found;

  PetscFunctionBegin;
  for (PetscInt s = 0; s < 2 && pair->body[s]; ++s) {
    PetscReal *un;

    PetscCall(PetscMalloc1(pair->n[s], &un));
    for (PetscInt i = 0; i < pair->n[s]; ++i)
      PetscCall(AbutBodyGetSupportDisplacement(pair->body[s], pair->nodes[s]->x + 2 * i, pair->nodes[s]->normal, &un[i], &found));
    PetscCall(AbutPairSetNormalTrace(pair, s, un, u[s]));
    PetscCall(PetscFree(un));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How far the bodies would come together at a point if they followed their supports; found: both have one */
static PetscErrorCode AbutPairApproach_Private(AbutPair pair, const PetscReal x[2], PetscReal base[2], PetscBool *found)
{
  PetscFunctionBegin;
  base[1] = 0.;
  *found  = PETSC_TRUE;
  for (PetscInt b = 0; b < 2 && pair->body[b] && *found; ++b)
    PetscCall(AbutBodyGetSupportDisplacement(pair->body[b], x, pair->nodes[b]->normal, &base[b], found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPairComputeWinkler - Traces of two elastic layers on their supports, p = max(0, approach - f)/(theta + C1 + C2): the paper's start

   Not Collective

   Input Parameter:
.  pair - the pair, set up

   Output Parameters:
+  u1    - [components*n1] displacements at the nodes of the first side, length
.  u2    - [components*n2] the same on the second side
-  found - `PETSC_FALSE` where a body has no support with prescribed displacement opposite to its side, or the sides are curved; u1, u2 are
           then not set

   Level: intermediate

.seealso: `AbutInterfaceComputeStart()`, `AbutPairGetCompliance()`
@*/
PetscErrorCode AbutPairComputeWinkler(AbutPair pair, PetscReal u1[], PetscReal u2[], PetscBool *found)
{
  PetscReal *const u[2] = {u1, u2};
  PetscReal        compliance[2];

  PetscFunctionBegin;
  *found = (PetscBool)(pair->straight && !pair->obstacle);
  PetscCall(AbutPairGetCompliance(pair, compliance));
  for (PetscInt s = 0; s < 2 && *found; ++s) {
    for (PetscInt i = 0; i < pair->n[s]; ++i) {
      const PetscReal *x = pair->nodes[s]->x + 2 * i;
      PetscReal        base[2], f, p;

      PetscCall(AbutPairApproach_Private(pair, x, base, found));
      if (!*found) break;
      PetscCall(AbutPairGetGap(pair, x, &f));
      p       = PetscMax(0., base[0] + base[1] - f) / (pair->theta + compliance[0] + compliance[1]);
      u[s][i] = base[s] - p * compliance[s];
    }
    if (*found) PetscCall(AbutPairSetNormalTrace(pair, s, u[s], u[s]));
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
