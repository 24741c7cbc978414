#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/

/* s[3*n], and in s33[n], unless it is NULL, the component out of the plane: of what moved, without the initial strains */
PetscErrorCode AbutCellStresses_Plane(AbutBody body, PetscInt c, PetscInt n, const PetscReal xi[], const PetscReal dN[], PetscReal s[],
                                      PetscReal s33[])
{
  const AbutMeshTopology *t;
  PetscReal               u[2 * ABUT_CELL_NODES_MAX], mean = 0.;
  const PetscReal         transverse = body->kinematics == ABUT_PLANE_STRESS ? 0. : body->poisson;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  for (PetscInt k = 0; k < 2 * t->nodes; ++k) u[k] = body->nodeu[2 * t->cellnode[t->nodes * c + k / 2] + k % 2];
  if (body->meandilatation) PetscCall((*body->cell->dilatation)(body, c, &mean));
  for (PetscInt q = 0; q < n; ++q) {
    const PetscReal *d    = dN + 2 * t->nodes * q;
    PetscReal        r[4] = {0., 0., 0., 0.}, g[4], x[2], J[4], det, trace; /* r and g: du_i/dxi_j and du_i/dx_j */

    PetscCall(AbutMeshMapPoint(body->mesh, c, xi + 2 * q, x, J));
    det = J[0] * J[3] - J[1] * J[2];
    for (PetscInt k = 0; k < t->nodes; ++k) {
      r[0] += u[2 * k] * d[2 * k];
      r[1] += u[2 * k] * d[2 * k + 1];
      r[2] += u[2 * k + 1] * d[2 * k];
      r[3] += u[2 * k + 1] * d[2 * k + 1];
    }
    for (PetscInt i = 0; i < 4; i += 2) {
      g[i]     = (r[i] * J[3] - r[i + 1] * J[2]) / det;
      g[i + 1] = (-r[i] * J[1] + r[i + 1] * J[0]) / det;
    }
    trace        = body->lambda * (body->meandilatation ? mean : g[0] + g[3]);
    s[3 * q]     = trace + 2. * body->mu * g[0];
    s[3 * q + 1] = trace + 2. * body->mu * g[3];
    s[3 * q + 2] = body->mu * (g[1] + g[2]);
    if (s33) s33[q] = transverse * (s[3 * q] + s[3 * q + 1]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetCellStresses - The finite-element stress of the last solve at points of a local cell, eqs. (1), (2) of the paper

   Not Collective

   Input Parameters:
+  body - the body
.  c    - local cell
.  n    - points
.  xi   - [2*n] reference points: [-1,1]^2 for quads, (0,0)(1,0)(0,1) for triangles
-  dN   - [2*nodes*n] the derivatives of the shape functions there, from `AbutMeshEvaluateBasis()`, the same for all cells

   Output Parameter:
.  s - [3*n] s11, s22, s12 of each point, stress

   Level: intermediate

.seealso: `AbutBodyGetCellStress()`, `AbutMeshCreateQuadrature()`
@*/
PetscErrorCode AbutBodyGetCellStresses(AbutBody body, PetscInt c, PetscInt n, const PetscReal xi[], const PetscReal dN[], PetscReal s[])
{
  PetscFunctionBegin;
  PetscCall(AbutBodyGetCellStresses3D(body, c, n, xi, dN, s, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetCellStresses3D - The finite-element stress of the last solve with its normal component out of the plane

   Not Collective

   Input Parameters:
+  body - the body
.  c    - local cell
.  n    - points
.  xi   - [2*n] reference points: [-1,1]^2 for quads, (0,0)(1,0)(0,1) for triangles
-  dN   - [2*nodes*n] the derivatives of the shape functions there, from `AbutMeshEvaluateBasis()`, the same for all cells

   Output Parameters:
+  s   - [3*n] s11, s22, s12 of each point, stress
-  s33 - [n] the stress across the plane in plane strain, 0 in plane stress, the hoop stress with axial symmetry; or `NULL`

   Level: intermediate

.seealso: `AbutBodyGetCellStresses()`, `AbutBodySetKinematics()`, `AbutBodyAddInitialStrain()`
@*/
PetscErrorCode AbutBodyGetCellStresses3D(AbutBody body, PetscInt c, PetscInt n, const PetscReal xi[], const PetscReal dN[], PetscReal s[],
                                         PetscReal s33[])
{
  PetscFunctionBegin;
  PetscCall((*body->cell->stresses)(body, c, n, xi, dN, s, s33));
  if (body->initial) PetscCall(AbutBodySubtractInitial_Private(body, c, n, xi, s, s33));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetCellStress - The finite-element stress of the last solve at a point of a local cell

   Not Collective

   Input Parameters:
+  body - the body
.  c    - local cell
-  xi   - [2] reference point: [-1,1]^2 for quads, (0,0)(1,0)(0,1) for triangles

   Output Parameter:
.  s - [3] s11, s22, s12, stress

   Level: intermediate

.seealso: `AbutBodySolve()`, `AbutBodyGetCellStresses()`, `AbutVonMises()`
@*/
PetscErrorCode AbutBodyGetCellStress(AbutBody body, PetscInt c, const PetscReal xi[2], PetscReal s[3])
{
  PetscReal N[ABUT_CELL_NODES_MAX], dN[2 * ABUT_CELL_NODES_MAX];

  PetscFunctionBegin;
  PetscCall(AbutMeshEvaluateBasis(body->mesh, xi, N, dN));
  PetscCall(AbutBodyGetCellStresses(body, c, 1, xi, dN, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetCellPoint - Where a reference point of a local cell is, and the measure there

   Not Collective

   Input Parameters:
+  body - the body
.  c    - local cell
-  xi   - [2] reference point

   Output Parameters:
+  x   - [2] the point
-  det - Jacobian determinant of the map: a quadrature weight on the reference cell times this is an area; with axial symmetry times
         2 pi r, so that it is a volume

   Level: intermediate

.seealso: `AbutBodyGetCellStress()`, `AbutBodyGetCellMeasure()`
@*/
PetscErrorCode AbutBodyGetCellPoint(AbutBody body, PetscInt c, const PetscReal xi[2], PetscReal x[2], PetscReal *det)
{
  PetscReal J[4], thickness;

  PetscFunctionBegin;
  PetscCall(AbutMeshMapPoint(body->mesh, c, xi, x, J));
  PetscCall(AbutBodyGetThickness(body, x, &thickness));
  *det = thickness * (J[0] * J[3] - J[1] * J[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutVonMises - The equivalent stress

   Not Collective

   Input Parameter:
.  s - [4] s11, s22, s12, s33, stress

   Output Parameter:
.  vm - von Mises stress

   Level: beginner

.seealso: `AbutBodyGetCellStresses3D()`
@*/
PetscErrorCode AbutVonMises(const PetscReal s[4], PetscReal *vm)
{
  PetscFunctionBegin;
  *vm = PetscSqrtReal(0.5 * (PetscSqr(s[0] - s[1]) + PetscSqr(s[1] - s[3]) + PetscSqr(s[3] - s[0])) + 3. * s[2] * s[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetPointValues - Displacement and stress of the last solve at a point

   Collective

   Input Parameters:
+  body - the body
-  x    - [2] the point; outside the body is bad input

   Output Parameter:
.  value - [7] u1, u2, s11, s22, s12, s33, von Mises; the same on all ranks

   Level: beginner

   Note:
   Where cells meet, the stress is the mean over them, whichever ranks they are on.

.seealso: `AbutBodySolve()`
@*/
PetscErrorCode AbutBodyGetPointValues(AbutBody body, const PetscReal x[2], PetscReal value[7])
{
  const AbutMeshTopology *t;
  PetscReal               sum[7] = {0.}, xi[2], N[ABUT_CELL_NODES_MAX], dN[2 * ABUT_CELL_NODES_MAX], s[4];
  PetscBool               inside;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    PetscCall(AbutMeshInvertCell(body->mesh, c, x, xi, &inside));
    if (!inside) continue;
    PetscCall(AbutMeshEvaluateBasis(body->mesh, xi, N, dN));
    PetscCall(AbutBodyGetCellStresses3D(body, c, 1, xi, dN, s, s + 3));
    for (PetscInt k = 0; k < t->nodes; ++k)
      for (PetscInt d = 0; d < 2; ++d) sum[d] += N[k] * body->nodeu[2 * t->cellnode[t->nodes * c + k] + d];
    for (PetscInt i = 0; i < 4; ++i) sum[2 + i] += s[i];
    sum[6] += 1.;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 7, MPIU_REAL, MPIU_SUM, PetscObjectComm((PetscObject)body)));
  AbutCheckInput(sum[6] > 0., PetscObjectComm((PetscObject)body), "%s: the point (%g, %g) lies outside this body",
                 ((PetscObject)body)->name, (double)x[0], (double)x[1]);
  for (PetscInt i = 0; i < 6; ++i) value[i] = sum[i] / sum[6];
  PetscCall(AbutVonMises(value + 2, &value[6]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetWork - The work of all forces on a body: loads, contact forces, reactions and springs times their displacements

   Collective

   Input Parameter:
.  body - the body, solved

   Output Parameter:
.  work - stress times area; in equilibrium twice the strain energy, and much cheaper than that of `AbutBodyGetEnergy()`

   Level: intermediate

   Note:
   With initial strains, less what the stress does on them: free thermal expansion is no work.

.seealso: `AbutBodyGetEnergy()`
@*/
PetscErrorCode AbutBodyGetWork(AbutBody body, PetscReal *work)
{
  PetscReal w[3], force[2], springs;
  Vec       reaction;

  PetscFunctionBegin;
  PetscCall(VecDot(body->load, body->u, &w[0]));
  PetscCall(VecDot(body->contact, body->u, &w[1]));
  PetscCall(AbutBodyCreateReaction_Private(body, &reaction));
  PetscCall(VecDot(reaction, body->u, &w[2]));
  PetscCall(VecDestroy(&reaction));
  PetscCall(AbutBodyGetFoundationForce_Private(body, force, &springs));
  *work = w[0] + w[1] + w[2] + springs;
  if (body->initial) {
    PetscCall(AbutBodyInitialWork_Private(body, &w[0]));
    *work += w[0];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutBodyComputeStrainEnergy_Private(AbutBody body)
{
  const AbutMeshTopology *t;
  PetscReal               K[4 * ABUT_CELL_NODES_MAX * ABUT_CELL_NODES_MAX], sum = 0., initial = 0.;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    const PetscInt *node = t->cellnode + t->nodes * c, n = 2 * t->nodes;

    PetscCall((*body->cell->stiffness)(body, c, K));
    for (PetscInt i = 0; i < n; ++i)
      for (PetscInt j = 0; j < n; ++j)
        sum += 0.5 * K[n * i + j] * body->nodeu[2 * node[i / 2] + i % 2] * body->nodeu[2 * node[j / 2] + j % 2];
  }
  PetscCallMPI(MPI_Allreduce(&sum, &body->strain, 1, MPIU_REAL, MPIU_SUM, PetscObjectComm((PetscObject)body)));
  if (body->initial) PetscCall(AbutBodyInitialWork_Private(body, &initial));
  body->strain += 0.5 * initial;
  body->strainknown = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetEnergy - Strain energy of the last solve, and the work of all forces on its displacements

   Collective

   Input Parameter:
.  body - the body

   Output Parameters:
+  strain - 1/2 a(u,u) from the element matrices, stress times area; with initial strains that of the elastic strain alone
-  work   - that of `AbutBodyGetWork()`; in equilibrium twice the strain energy

   Level: intermediate

.seealso: `AbutBodySolve()`, `AbutBodyGetWork()`
@*/
PetscErrorCode AbutBodyGetEnergy(AbutBody body, PetscReal *strain, PetscReal *work)
{
  PetscFunctionBegin;
  if (!body->strainknown) PetscCall(AbutBodyComputeStrainEnergy_Private(body));
  *strain = body->strain;
  PetscCall(AbutBodyGetWork(body, work));
  PetscFunctionReturn(PETSC_SUCCESS);
}
