#include "element.h"

/* Stiffness of one cell, eq. (11) of the paper, in plain loops: PetscFE's general ones cost ten times more. Most cells are parallelograms
   or triangles, whose map is affine: their matrices are sums of four that are integrated once, on the reference cell. */

/* What all cells of a mesh share; with n Gauss points in each direction */
PetscErrorCode AbutElementCreate_Private(AbutMesh mesh, PetscInt points, AbutElement *element)
{
  const AbutMeshTopology *t;
  AbutElement             e;
  PetscInt                n;
  PetscReal               N[ABUT_CELL_NODES_MAX];

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(PetscNew(&e));
  e->nodes = n = t->nodes;
  PetscCall(AbutMeshCreateQuadrature(mesh, points, &e->quadrature));
  PetscCall(PetscQuadratureGetData(e->quadrature, NULL, NULL, &e->npoints, &e->xi, &e->w));
  PetscCall(PetscCalloc6(n * n, &e->R[0][0], n * n, &e->R[0][1], n * n, &e->R[1][0], n * n, &e->R[1][1], 2 * n, &e->G, 2 * n, &e->mean));
  for (PetscInt q = 0; q < e->npoints; ++q) {
    PetscCall(AbutMeshEvaluateBasis(mesh, e->xi + 2 * q, N, e->G));
    for (PetscInt a = 0; a < n; ++a)
      for (PetscInt b = 0; b < n; ++b)
        for (PetscInt i = 0; i < 2; ++i)
          for (PetscInt j = 0; j < 2; ++j) e->R[i][j][a * n + b] += e->w[q] * e->G[2 * a + i] * e->G[2 * b + j];
  }
  *element = e;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutElementDestroy_Private(AbutElement *element)
{
  PetscFunctionBegin;
  if (!*element) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscQuadratureDestroy(&(*element)->quadrature));
  PetscCall(PetscFree6((*element)->R[0][0], (*element)->R[0][1], (*element)->R[1][0], (*element)->R[1][1], (*element)->G,
                       (*element)->mean));
  PetscCall(PetscFree(*element));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The block of nodes a and b, and its mirror image, from the integrals g_ij of d_i N_a d_j N_b */
static inline void AbutAddBlock_Private(PetscInt n, PetscInt a, PetscInt b, PetscReal lambda, PetscReal mu, const PetscReal g[4],
                                        PetscReal K[])
{
  const PetscReal trace = mu * (g[0] + g[3]);

  for (PetscInt i = 0; i < 2; ++i)
    for (PetscInt j = 0; j < 2; ++j) {
      const PetscReal k = lambda * g[2 * i + j] + mu * g[2 * j + i] + (i == j ? trace : 0.);

      K[(2 * a + i) * 2 * n + 2 * b + j] += k;
      if (a != b) K[(2 * b + j) * 2 * n + 2 * a + i] += k;
    }
}

/* B[2*i+a] = dxi_a/dx_i; J[2*i+a] = dx_i/dxi_a */
static inline void AbutInvert_Private(const PetscReal J[4], PetscReal B[4], PetscReal *det)
{
  *det = J[0] * J[3] - J[1] * J[2];
  B[0] = J[3] / *det;
  B[1] = -J[2] / *det;
  B[2] = -J[1] / *det;
  B[3] = J[0] / *det;
}

static void AbutStiffnessAffine_Private(const AbutElement e, const PetscReal J[4], PetscReal lambda, PetscReal mu, PetscReal K[])
{
  const PetscInt n = e->nodes;
  PetscReal      B[4], T[4][4], det;

  AbutInvert_Private(J, B, &det);
  for (PetscInt k = 0; k < 16; ++k) T[k / 4][k % 4] = det * B[2 * (k / 4 / 2) + k % 4 / 2] * B[2 * (k / 4 % 2) + k % 4 % 2];
  for (PetscInt a = 0; a < n; ++a)
    for (PetscInt b = a; b < n; ++b) {
      const PetscReal r[4] = {e->R[0][0][a * n + b], e->R[0][1][a * n + b], e->R[1][0][a * n + b], e->R[1][1][a * n + b]};
      PetscReal       g[4];

      for (PetscInt k = 0; k < 4; ++k) g[k] = T[k][0] * r[0] + T[k][1] * r[1] + T[k][2] * r[2] + T[k][3] * r[3];
      AbutAddBlock_Private(n, a, b, lambda, mu, g, K);
    }
}

/* With the mean of the dilatation in place of the dilatation, a quad of order 1 does not lock at Poisson's ratios near 1/2 (J. C.
   Nagtegaal, D. M. Parks, J. R. Rice, Comput. Methods Appl. Mech. Engrg. 4, 1974) */
static PetscErrorCode AbutStiffnessQuadrature_Private(AbutBody body, PetscInt c, PetscReal lambda, PetscReal K[])
{
  const AbutElement e    = body->element;
  const PetscInt    n    = e->nodes;
  PetscReal         area = 0.;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(e->mean, 2 * n));
  for (PetscInt q = 0; q < e->npoints; ++q) {
    PetscReal x[2], N[ABUT_CELL_NODES_MAX], det, w;

    PetscCall(AbutMeshMapCell(body->mesh, c, e->xi + 2 * q, x, N, e->G, &det));
    w = det * e->w[q];
    area += w;
    for (PetscInt k = 0; k < 2 * n; ++k) e->mean[k] += w * e->G[k];
    for (PetscInt a = 0; a < n; ++a)
      for (PetscInt b = a; b < n; ++b) {
        const PetscReal *Ga = e->G + 2 * a, *Gb = e->G + 2 * b;
        const PetscReal  g[4] = {w * Ga[0] * Gb[0], w * Ga[0] * Gb[1], w * Ga[1] * Gb[0], w * Ga[1] * Gb[1]};

        AbutAddBlock_Private(n, a, b, lambda, body->mu, g, K);
      }
  }
  if (body->meandilatation)
    for (PetscInt k = 0; k < 2 * n; ++k)
      for (PetscInt l = 0; l < 2 * n; ++l) K[k * 2 * n + l] += body->lambda * e->mean[k] * e->mean[l] / area;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* K[(2*nodes)^2] of local cell c */
static PetscErrorCode AbutCellStiffness_Plane(AbutBody body, PetscInt c, PetscReal K[])
{
  const AbutMeshTopology *t;
  const PetscReal        *p[4];
  PetscReal               J[4] = {0., 0., 0., 0.}, size = 0.;
  PetscBool               affine = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  PetscCall(PetscArrayzero(K, 4 * t->nodes * t->nodes));
  for (PetscInt k = 0; k < t->corners; ++k) p[k] = t->x + 2 * t->cell[t->corners * c + k];
  for (PetscInt i = 0; i < 2; ++i) {
    const PetscReal scale = t->corners == 4 ? 0.5 : 1.;

    J[2 * i]     = scale * (p[1][i] - p[0][i]);
    J[2 * i + 1] = scale * (p[t->corners - 1][i] - p[0][i]);
    size         = PetscMax(size, PetscMax(PetscAbsReal(J[2 * i]), PetscAbsReal(J[2 * i + 1])));
  }
  for (PetscInt i = 0; t->corners == 4 && i < 2; ++i)
    if (PetscAbsReal(p[0][i] - p[1][i] + p[2][i] - p[3][i]) > 1e-13 * size) affine = PETSC_FALSE;
  if (affine && !body->meandilatation) AbutStiffnessAffine_Private(body->element, J, body->lambda, body->mu, K);
  else PetscCall(AbutStiffnessQuadrature_Private(body, c, body->meandilatation ? 0. : body->lambda, K));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The mean dilatation of local cell c in the last solve */
static PetscErrorCode AbutCellDilatation_Plane(AbutBody body, PetscInt c, PetscReal *mean)
{
  const AbutElement       e    = body->element;
  PetscReal               area = 0., sum = 0.;
  const AbutMeshTopology *t;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  for (PetscInt q = 0; q < e->npoints; ++q) {
    PetscReal x[2], N[ABUT_CELL_NODES_MAX], det;

    PetscCall(AbutMeshMapCell(body->mesh, c, e->xi + 2 * q, x, N, e->G, &det));
    area += det * e->w[q];
    for (PetscInt k = 0; k < 2 * e->nodes; ++k) sum += det * e->w[q] * e->G[k] * body->nodeu[2 * t->cellnode[e->nodes * c + k / 2] + k % 2];
  }
  *mean = sum / area;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const AbutCellOps AbutCellOps_Plane = {AbutCellStiffness_Plane, AbutCellDilatation_Plane, AbutCellStresses_Plane};

/*@C
   AbutBodyGetIntegration - How the dilatation enters the cells of a body

   Not Collective

   Input Parameter:
.  body - the body, set up

   Output Parameters:
+  name  - "full", or "mean_dilatation" if each cell takes the mean of its dilatation, in its stiffness and in its stress
-  locks - whether Poisson's ratio is so close to 1/2 that these elements are far too stiff: triangles of order 1

   Level: intermediate

   Notes:
   Quads of order 1 above a Poisson's ratio of 0.49 take the mean, and higher orders need none. The area of a triangle of order 1 has to
   stay as it is when its material is incompressible, and in a whole mesh this leaves next to no motion: take order 2 or quads. In plane
   stress a sheet gets thicker instead, and nothing locks. With axial symmetry the mean is that over the volume.

   The nearer to 1/2, the worse the condition of any of them: conjugate gradients with BoomerAMG took 8 iterations at 0.3, 142 at 0.499 and
   412 at 0.49999 on 64 x 16 quads. The direct solver, `-NAME_ksp_type preonly -NAME_pc_type cholesky`, does not mind.

.seealso: `AbutBodySetMaterial()`, `AbutBodyGetCellStress()`
@*/
PetscErrorCode AbutBodyGetIntegration(AbutBody body, const char *name[], PetscBool *locks)
{
  const AbutMeshTopology *t;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(body, ABUTBODY_CLASSID, 1);
  PetscCall(AbutBodyNeedSetUp_Private(body));
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  if (name) *name = body->meandilatation ? "mean_dilatation" : "full";
  if (locks)
    *locks = (PetscBool)(t->corners == 3 && t->order == 1 && body->kinematics != ABUT_PLANE_STRESS &&
                         body->poisson > ABUT_ALMOST_INCOMPRESSIBLE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyViewIntegration - Prints what is done, or should be, against locking; nothing where Poisson's ratio is far from 1/2

   Collective

   Input Parameters:
+  body   - the body, set up
-  viewer - the viewer

   Level: intermediate

.seealso: `AbutBodyGetIntegration()`, `AbutBodyView()`
@*/
PetscErrorCode AbutBodyViewIntegration(AbutBody body, PetscViewer viewer)
{
  const char *name = ((PetscObject)body)->name;
  PetscBool   locks;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetIntegration(body, NULL, &locks));
  if (body->meandilatation)
    PetscCall(PetscViewerASCIIPrintf(viewer, "%s: Poisson's ratio %g is above %g: quads of order 1 take the mean dilatation of each cell\n",
                                     name, (double)body->poisson, ABUT_ALMOST_INCOMPRESSIBLE));
  if (locks)
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "warning: %s: triangles of order 1 lock at Poisson's ratio %g: take -%s_mesh_order 2 or "
                                     "-%s_mesh_shape quad\n",
                                     name, (double)body->poisson, name, name));
  PetscFunctionReturn(PETSC_SUCCESS);
}
