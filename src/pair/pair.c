#include <abut/private/bodyimpl.h>
#include <abut/private/pairimpl.h> /*I "abutpair.h" I*/

PetscClassId ABUTPAIR_CLASSID;

/*@C
   AbutPairCreate - Creates a pair: one possible contact of two sides

   Collective

   Input Parameters:
+  comm - the communicator of its bodies
-  name - its name; its keys begin with it: `-mid_pair_gap`

   Output Parameter:
.  pair - the pair

   Options Database Keys:
+  -NAME_pair_bodies <first,second> - names of the two bodies; E and H of the first give theta. One name: the other one is rigid
.  -NAME_pair_sides <first,second>  - their sides, or the side of the one body
.  -NAME_pair_gap <f>               - gap as number, formula in x and y, or CSV file, length; default: the distance of the sides
.  -NAME_pair_obstacle <d>          - with one body: distance from a rigid obstacle, positive where the body may be, formula in x and y,
                                      length: y for the plane y = 0, sqrt(x^2+(y-8)^2)-8 for a disc
.  -NAME_pair_penalty <c>           - theta = c H/E, default 0.05; 0 for exact contact
.  -NAME_pair_theta <theta>         - theta itself, length/stress
.  -NAME_pair_friction <mu>        - coefficient of Coulomb friction; without it the pair is frictionless
.  -NAME_pair_height <H>            - H, where it is not the extent of the first body along the normal, length; required, or theta,
                                      of a body from a file with a penalty
-  -NAME_pair_pressure_side <first|second|finer> - which side carries the nodal pressures; finer is the other one where its body is clearly
                                                   stiffer

   Level: intermediate

   Note:
   With friction tangential tractions t act at the nodes that carry pressures: |t| <= mu p, and where a node slips, |t| = mu p against the
   slip. Slip is counted from the end of the last load step; the penalty lets also sticking nodes slip, by theta t.

   Limits: small displacements (the pairing of the sides is fixed). Exact contact, theta = 0, needs `SNESDDACTIVE`. Curved
   sides are polygons, whose points look for each other along the mean of the normals at their vertices: a contact side should have no
   corners. An obstacle neither moves nor gives way.

.seealso: `AbutPairSetFromOptions()`, `AbutPairSetUp()`, `AbutPairDestroy()`
@*/
PetscErrorCode AbutPairCreate(MPI_Comm comm, const char name[], AbutPair *pair)
{
  char prefix[128];

  PetscFunctionBegin;
  PetscAssertPointer(pair, 3);
  if (!ABUTPAIR_CLASSID) PetscCall(PetscClassIdRegister("Abut Pair", &ABUTPAIR_CLASSID));
  PetscCall(PetscHeaderCreate(*pair, ABUTPAIR_CLASSID, "AbutPair", "Contact of two sides", "Pair", comm, AbutPairDestroy, AbutPairView));
  PetscCall(PetscObjectSetName((PetscObject)*pair, name));
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_", name));
  PetscCall(PetscObjectSetOptionsPrefix((PetscObject)*pair, prefix));
  (*pair)->penalty       = 0.05;
  (*pair)->pressureside  = ABUT_PRESSURE_FINER;
  (*pair)->generation[0] = (*pair)->generation[1] = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What sides stand out is asked for in every point while the gap is integrated */
static PetscErrorCode AbutPairLogOffsets_Private(AbutPair pair, PetscBool begin)
{
  PetscFunctionBegin;
  for (PetscInt s = 0; s < 2 && pair->body[s]; ++s)
    PetscCall(AbutBodyLogHooks_Private(pair->body[s], ABUT_HOOK_OFFSET, pair->side[s], begin));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutPairSetUp - Makes the common refinement and the dual-mortar weights; after a body's mesh has adapted, makes them anew

   Collective

   Input Parameter:
.  pair - the pair

   Level: intermediate

.seealso: `AbutPairSetFromOptions()`, `AbutPairComputePressure()`
@*/
PetscErrorCode AbutPairSetUp(AbutPair pair)
{
  PetscInt  generation[2];
  PetscBool same = PETSC_TRUE;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(pair, ABUTPAIR_CLASSID, 1);
  for (PetscInt s = 0; s < 2 && pair->body[s]; ++s) {
    AbutMesh mesh;

    PetscCall(AbutBodySetUp(pair->body[s]));
    PetscCall(AbutBodyGetMesh(pair->body[s], &mesh));
    PetscCall(AbutMeshGetGeneration(mesh, &generation[s]));
    if (generation[s] != pair->generation[s]) same = PETSC_FALSE;
  }
  if (same) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscLogEventBegin(pair->event, pair, 0, 0, 0));
  PetscCall(AbutPairMortarReset_Private(pair));
  for (PetscInt s = 0; s < 2 && pair->body[s]; ++s) {
    pair->generation[s] = generation[s];
    PetscCall(AbutBodyGetSide(pair->body[s], pair->side[s], &pair->nodes[s]));
    pair->n[s] = pair->nodes[s]->n;
  }
  PetscCall(AbutPairLogOffsets_Private(pair, PETSC_TRUE));
  PetscCall(AbutPairMortar_Private(pair));
  PetscCall(AbutPairLogOffsets_Private(pair, PETSC_FALSE));
  PetscCall(PetscLogEventEnd(pair->event, pair, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutPairView - Prints a pair

   Collective

   Input Parameters:
+  pair   - the pair
-  viewer - the viewer

   Level: intermediate

.seealso: `AbutPairCreate()`
@*/
PetscErrorCode AbutPairView(AbutPair pair, PetscViewer viewer)
{
  const char *gap = "the distance of the sides", *body[2] = {"", ""}, *side[2] = {"", ""};

  PetscFunctionBegin;
  if (pair->gap) PetscCall(AbutExpressionGetText(pair->gap, &gap));
  if (pair->obstacle) PetscCall(AbutExpressionGetText(pair->obstacle, &gap));
  for (PetscInt s = 0; s < 2 && pair->body[s]; ++s) {
    AbutMesh mesh;

    PetscCall(AbutBodyGetName(pair->body[s], &body[s]));
    PetscCall(AbutBodyGetMesh(pair->body[s], &mesh));
    PetscCall(AbutMeshGetSideName(mesh, pair->side[s], &side[s]));
  }
  PetscCall(PetscViewerASCIIPrintf(viewer, "pair %s: %s of %s on %s%s%s, gap %s, theta %g\n", ((PetscObject)pair)->name, side[0], body[0],
                                   pair->body[1] ? side[1] : "a rigid obstacle", pair->body[1] ? " of " : "", body[1], gap,
                                   (double)pair->theta));
  if (pair->friction) PetscCall(PetscViewerASCIIPrintf(viewer, "  friction %g\n", (double)pair->friction->mu));
  if (pair->segment) {
    PetscCall(PetscViewerASCIIPushTab(viewer));
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "%" PetscInt_FMT " and %" PetscInt_FMT " nodes, %" PetscInt_FMT
                                     " pieces in the common refinement, pressures on %s\n",
                                     pair->n[0], pair->n[1], pair->nsegments, body[pair->which]));
    PetscCall(PetscViewerASCIIPopTab(viewer));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutPairDestroy - Frees a pair

   Collective

   Input Parameter:
.  pair - the pair; set to `NULL`

   Level: intermediate

.seealso: `AbutPairCreate()`
@*/
PetscErrorCode AbutPairDestroy(AbutPair *pair)
{
  PetscFunctionBegin;
  if (!*pair) PetscFunctionReturn(PETSC_SUCCESS);
  PetscValidHeaderSpecific(*pair, ABUTPAIR_CLASSID, 1);
  if (--((PetscObject)*pair)->refct > 0) {
    *pair = NULL;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(AbutPairMortarReset_Private(*pair));
  PetscCall(AbutPairFrictionDestroy_Private(*pair));
  PetscCall(AbutExpressionDestroy(&(*pair)->gap));
  PetscCall(AbutExpressionDestroy(&(*pair)->obstacle));
  PetscCall(PetscHeaderDestroy(pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutPairSetTheta - Sets the penalty, whatever the keys of the pair say

   Logically Collective

   Input Parameters:
+  pair  - the pair
-  theta - theta of p = max(0, u_n1 + u_n2 - f)/theta, length over stress; 0 for exact contact

   Level: intermediate

   Note:
   For a loop that has begun, only after `AbutInterfaceReset()`.

.seealso: `AbutPairGetTheta()`, `AbutPairSetFromOptions()`
@*/
PetscErrorCode AbutPairSetTheta(AbutPair pair, PetscReal theta)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(pair, ABUTPAIR_CLASSID, 1);
  pair->theta    = theta;
  pair->thetaset = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPairGetName - The name of a pair

   Not Collective

   Input Parameter:
.  pair - the pair

   Output Parameter:
.  name - its name, owned by the pair

   Level: intermediate

.seealso: `AbutPairCreate()`
@*/
PetscErrorCode AbutPairGetName(AbutPair pair, const char *name[])
{
  PetscFunctionBegin;
  *name = ((PetscObject)pair)->name;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutPairGetBodies - The bodies and sides of a pair

   Not Collective

   Input Parameter:
.  pair - the pair

   Output Parameters:
+  bodies - [2] the bodies; the second one is `NULL` for a rigid obstacle
-  sides  - [2] the numbers of their sides

   Level: intermediate

.seealso: `AbutPairGetSizes()`
@*/
PetscErrorCode AbutPairGetBodies(AbutPair pair, AbutBody bodies[2], PetscInt sides[2])
{
  PetscFunctionBegin;
  for (PetscInt s = 0; s < 2; ++s) {
    bodies[s] = pair->body[s];
    sides[s]  = pair->side[s];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutPairGetSizes - How many nodes the two sides have

   Not Collective

   Input Parameter:
.  pair - the pair, set up

   Output Parameter:
.  n - [2] nodes; 0 for a rigid obstacle

   Level: intermediate

.seealso: `AbutPairGetBodies()`
@*/
PetscErrorCode AbutPairGetSizes(AbutPair pair, PetscInt n[2])
{
  PetscFunctionBegin;
  n[0] = pair->n[0];
  n[1] = pair->n[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutPairGetComponents - How many values a trace has at a node

   Not Collective

   Input Parameter:
.  pair - the pair, set up

   Output Parameter:
.  n - 1 for straight sides, the displacement along the outward normal; 2, both components, for curved ones and with friction

   Level: intermediate

.seealso: `AbutPairGetSizes()`, `AbutBodyGetSideTrace()`
@*/
PetscErrorCode AbutPairGetComponents(AbutPair pair, PetscInt *n)
{
  PetscFunctionBegin;
  *n = pair->components;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutPairGetTheta - The penalty parameter theta = c H/E of eq. (15) of the paper

   Not Collective

   Input Parameter:
.  pair - the pair

   Output Parameter:
.  theta - length/stress

   Level: intermediate

.seealso: `AbutPairGetCompliance()`
@*/
PetscErrorCode AbutPairGetTheta(AbutPair pair, PetscReal *theta)
{
  PetscFunctionBegin;
  *theta = pair->theta;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutPairGetCompliance - H (1-nu^2)/E of the two bodies: how much a layer of a body's height gives under a unit pressure

   Not Collective

   Input Parameter:
.  pair - the pair

   Output Parameter:
.  compliance - [2] length/stress; 0 for a rigid obstacle

   Level: intermediate

   Note:
   For two layers on supports their sum C bounds the spectrum of a sweep: relaxation converges for gamma < 2/(1+C/theta).

.seealso: `AbutPairGetTheta()`, `AbutInterfaceGetGamma()`
@*/
PetscErrorCode AbutPairGetCompliance(AbutPair pair, PetscReal compliance[2])
{
  PetscFunctionBegin;
  compliance[1] = 0.;
  for (PetscInt s = 0; s < 2 && pair->body[s]; ++s) {
    AbutMesh  mesh;
    PetscReal normal[2], height, young, poisson;

    PetscCall(AbutBodyGetMesh(pair->body[s], &mesh));
    PetscCall(AbutMeshGetSideDirection(mesh, pair->side[s], normal));
    PetscCall(AbutBodyGetHeight(pair->body[s], normal, &height));
    PetscCall(AbutBodyGetPlaneMaterial(pair->body[s], &young, &poisson));
    compliance[s] = height * (1. - poisson * poisson) / young;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
