#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/
#include <abut/private/sysimpl.h>

PetscClassId  ABUTBODY_CLASSID;
PetscLogEvent ABUTBODY_Assemble, ABUTBODY_Solve;

static PetscErrorCode AbutBodyInitializePackage_Private(void)
{
  PetscFunctionBegin;
  if (ABUTBODY_CLASSID) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscClassIdRegister("Abut Body", &ABUTBODY_CLASSID));
  PetscCall(PetscLogEventRegister("AbutBodyAssemble", ABUTBODY_CLASSID, &ABUTBODY_Assemble));
  PetscCall(PetscLogEventRegister("AbutBodySolve", ABUTBODY_CLASSID, &ABUTBODY_Solve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyCreate - Creates a body

   Collective

   Input Parameters:
+  comm - the communicator
-  name - its name; its keys begin with it: `-lower_mesh_box`

   Output Parameter:
.  body - the body

   Options Database Keys:
+  -NAME_mesh_*              - see `AbutMeshCreate()`
.  -NAME_material_young <E>  - Young's modulus, > 0, in the stress unit of the scene
.  -NAME_material_poisson <nu> - Poisson's ratio, -1 < nu < 0.5
.  -NAME_bc_SIDE_u1|u2 <g>   - prescribed displacement of a side, per component: number, formula in x and y, or CSV file
.  -NAME_bc_SIDE_t1|t2 <g>   - prescribed traction of a side, per component
-  -NAME_ksp_*, -NAME_pc_*   - the linear solver; unless given, a direct factor up to 1e6 unknowns, above it CG with BoomerAMG

   Level: beginner

   Note:
   Limits: linear isotropic material, small displacements; plane strain unless `AbutBodySetKinematics()` says otherwise. Above a Poisson's
   ratio of 0.49 quads of order 1 take the mean dilatation of each cell, and triangles of order 1 lock; see `AbutBodyGetIntegration()`.

.seealso: `AbutBodySetFromOptions()`, `AbutBodySetKinematics()`, `AbutBodySolve()`, `AbutBodyDestroy()`
@*/
PetscErrorCode AbutBodyCreate(MPI_Comm comm, const char name[], AbutBody *body)
{
  char prefix[128];

  PetscFunctionBegin;
  PetscAssertPointer(body, 3);
  PetscCall(AbutBodyInitializePackage_Private());
  PetscCall(PetscHeaderCreate(*body, ABUTBODY_CLASSID, "AbutBody", "Elastic body", "Body", comm, AbutBodyDestroy, AbutBodyView));
  PetscCall(PetscObjectSetName((PetscObject)*body, name));
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_", name));
  PetscCall(PetscObjectSetOptionsPrefix((PetscObject)*body, prefix));
  (*body)->factor     = 1.;
  (*body)->generation = -1;
  (*body)->cell       = &AbutCellOps_Plane;
  PetscCall(AbutMeshCreate(comm, &(*body)->mesh));
  PetscCall(PetscObjectSetOptionsPrefix((PetscObject)(*body)->mesh, prefix));
  PetscCall(AbutBodyLeaveGroup_Private(*body));
  PetscCall(AbutBodyCreateSolver_Private(*body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodySetFromOptions - Reads the keys of a body, of its mesh and of its solver

   Collective

   Input Parameter:
.  body - the body; its keys are listed under `AbutBodyCreate()`

   Level: beginner

.seealso: `AbutBodyCreate()`, `AbutBodySetUp()`
@*/
PetscErrorCode AbutBodySetFromOptions(AbutBody body)
{
  MPI_Comm    comm  = PetscObjectComm((PetscObject)body);
  const char *name  = ((PetscObject)body)->name;
  PetscReal   young = body->young, poisson = body->poisson;
  PetscBool   hasyoung, haspoisson;
  char        twice[256] = "", solver[256];

  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  PetscCall(AbutMeshSetFromOptions(body->mesh));
  PetscObjectOptionsBegin((PetscObject)body);
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-material_young", "Young's modulus", &young, &hasyoung));
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-material_poisson", "Poisson's ratio", &poisson, &haspoisson));
  PetscCall(AbutBodySetConditionsFromOptions_Private(body, PetscOptionsObject, twice, sizeof(twice)));
  PetscOptionsEnd();
  AbutCheckInput(body->young > 0. || (hasyoung && haspoisson), comm, "%s_material_%s: missing; give %s", name,
                 hasyoung ? "poisson" : "young", hasyoung ? "Poisson's ratio, for example 0.3" : "Young's modulus, for example 2.1e5");
  AbutCheckInput(!twice[0], comm, "%s: the same component also has its displacement given; give one of the two", twice);
  PetscCall(AbutBodySetMaterial(body, young, poisson));
  PetscCall(PetscSNPrintf(solver, sizeof(solver), "%s_ksp_*, %s_pc_*", name, name));
  AbutCallOptions(comm, solver, AbutBodyChooseSolver_Private(body, 0, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyDestroy - Frees a body

   Collective

   Input Parameter:
.  body - the body; set to `NULL`

   Level: beginner

.seealso: `AbutBodyCreate()`
@*/
PetscErrorCode AbutBodyDestroy(AbutBody *body)
{
  PetscFunctionBegin;
  if (!*body) PetscFunctionReturn(PETSC_SUCCESS);
  PetscValidHeaderSpecific(*body, ABUTBODY_CLASSID, 1);
  if (--((PetscObject)*body)->refct > 0) {
    *body = NULL;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(AbutBodyReset_Private(*body));
  for (PetscInt s = 0; s < ABUT_MAX_SIDES; ++s)
    for (PetscInt d = 0; d < 2; ++d) PetscCall(AbutExpressionDestroy(&(*body)->condition[s][d].value));
  PetscCall(AbutHooksDestroy_Private(&(*body)->hooks));
  PetscCall(AbutBodyLeaveGroup_Private(*body));
  PetscCall(AbutMeshDestroy(&(*body)->mesh));
  PetscCall(PetscHeaderDestroy(body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyView - Prints a body: material, mesh, solver

   Collective

   Input Parameters:
+  body   - the body
-  viewer - the viewer

   Level: beginner

.seealso: `AbutBodyCreate()`
@*/
PetscErrorCode AbutBodyView(AbutBody body, PetscViewer viewer)
{
  KSPType       ksptype;
  PCType        pctype;
  PC            pc;
  MatSolverType solver = NULL;
  PetscMPIInt   first, n;

  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "body %s: Young's modulus %g, Poisson's ratio %g, %s\n", ((PetscObject)body)->name,
                                   (double)body->young, (double)body->poisson, AbutKinematicsNames[body->kinematics]));
  PetscCall(PetscViewerASCIIPushTab(viewer));
  PetscCall(AbutMeshGetRanks(body->mesh, &first, &n));
  if (body->split) PetscCall(PetscViewerASCIIPrintf(viewer, "on ranks %d to %d\n", (int)first, (int)(first + n - 1)));
  if (body->generation >= 0) {
    PetscCall(AbutMeshView(body->mesh, viewer));
    PetscCall(AbutBodyViewIntegration(body, viewer));
  }
  PetscCall(KSPGetType(body->ksp, &ksptype));
  PetscCall(KSPGetPC(body->ksp, &pc));
  PetscCall(PCGetType(pc, &pctype));
  if (body->A) PetscCall(PCFactorGetMatSolverType(pc, &solver));
  PetscCall(PetscViewerASCIIPrintf(viewer, "solver: %s with %s%s%s, chosen by %s\n", ksptype, pctype, solver ? " of " : "",
                                   solver ? solver : "", body->userksp ? "the user" : "size"));
  PetscCall(PetscViewerASCIIPopTab(viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutBodyGetName - The name of a body

   Not Collective

   Input Parameter:
.  body - the body

   Output Parameter:
.  name - its name, owned by the body

   Level: beginner

.seealso: `AbutBodyCreate()`
@*/
PetscErrorCode AbutBodyGetName(AbutBody body, const char *name[])
{
  PetscFunctionBegin;
  *name = ((PetscObject)body)->name;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The body of a name, compared without case; NULL if there is none, and their names for the message */
PetscErrorCode AbutBodyFind_Private(PetscInt n, AbutBody bodies[], const char name[], AbutBody *body, char all[], size_t len)
{
  PetscFunctionBegin;
  *body  = NULL;
  all[0] = 0;
  for (PetscInt i = 0; i < n; ++i) {
    PetscBool match;

    PetscCall(AbutListAddItem_Private(all, len, ((PetscObject)bodies[i])->name));
    PetscCall(PetscStrcasecmp(name, ((PetscObject)bodies[i])->name, &match));
    if (match) *body = bodies[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetMesh - The mesh of a body

   Not Collective

   Input Parameter:
.  body - the body

   Output Parameter:
.  mesh - its mesh, owned by the body

   Level: intermediate

.seealso: `AbutMesh`
@*/
PetscErrorCode AbutBodyGetMesh(AbutBody body, AbutMesh *mesh)
{
  PetscFunctionBegin;
  *mesh = body->mesh;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetKSP - The linear solver of a body

   Not Collective

   Input Parameter:
.  body - the body

   Output Parameter:
.  ksp - the solver, owned by the body

   Level: intermediate

.seealso: `AbutBodySolve()`
@*/
PetscErrorCode AbutBodyGetKSP(AbutBody body, KSP *ksp)
{
  PetscFunctionBegin;
  *ksp = body->ksp;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetHeight - The extent of a body along a direction

   Not Collective

   Input Parameters:
+  body   - the body
-  normal - [2] unit vector

   Output Parameter:
.  height - its extent, length

   Level: intermediate

.seealso: `AbutPairGetTheta()`
@*/
PetscErrorCode AbutBodyGetHeight(AbutBody body, const PetscReal normal[2], PetscReal *height)
{
  PetscReal lower[2], upper[2];

  PetscFunctionBegin;
  PetscCall(AbutMeshGetBox(body->mesh, lower, upper));
  *height = PetscAbsReal(normal[0]) * (upper[0] - lower[0]) + PetscAbsReal(normal[1]) * (upper[1] - lower[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
