#pragma once

#include "ckbody.h"

/* Bodies in plane stress and bodies of revolution, and all four components of their stress against a field. The fourth one follows from the
   other three by Hooke's law: s33 = nu (s11 + s22) + E u1/r with axial symmetry, 0 in plane stress. */

static inline void CkField3D(const CkField *field, AbutKinematics kinematics, const PetscReal x[2], PetscReal u[2], PetscReal s[4])
{
  field->at(field, x, u, s);
  if (kinematics == ABUT_PLANE_STRESS) s[3] = 0.;
  else s[3] = field->poisson * (s[0] + s[1]) + (kinematics == ABUT_AXISYMMETRIC ? field->young * u[0] / x[0] : 0.);
}

/* CkSmooth() with kappa = (3 - nu)/(1 + nu) in place of 3 - 4 nu */
static inline void CkSmoothSheet(const CkField *field, const PetscReal x[2], PetscReal u[2], PetscReal s[3])
{
  const PetscReal      nu = field->poisson, change = (3. - nu) / (1. + nu) - (3. - 4. * nu);
  const double complex w = change * 2. * cexp(0.5 * (x[0] + I * x[1])) * (1. + nu) / field->young;

  CkSmooth(field, x, u, s);
  u[0] += creal(w);
  u[1] += cimag(w);
}

/* A body of revolution, Papkovich and Neuber: 2 mu u = grad(z psi) - 4 (1 - nu) psi e_z, psi = exp(kz) J0(kr) harmonic */
static inline void CkBessel(const CkField *field, const PetscReal x[2], PetscReal u[2], PetscReal s[3])
{
  const PetscReal k = 2., r = x[0], z = x[1], nu = field->poisson, twomu = field->young / (1. + nu);
  const PetscReal psi = PetscExpReal(k * z) * j0(k * r), r1 = -k * PetscExpReal(k * z) * j1(k * r), z1 = k * psi;
  const PetscReal rr = -k * k * psi - (r > 0. ? r1 / r : -0.5 * k * k * PetscExpReal(k * z)); /* Laplace's equation, z2 = k^2 psi */

  u[0] = z * r1 / twomu;
  u[1] = (z * z1 - (3. - 4. * nu) * psi) / twomu;
  s[0] = z * rr - 2. * nu * z1;
  s[1] = z * k * k * psi - 2. * (1. - nu) * z1;
  s[2] = z * k * r1 - (1. - 2. * nu) * r1;
}

/* Error of the stress in the L2 norm over the body (a volume with axial symmetry), and of the displacement, relative */
static inline void CkErrors3D(AbutBody body, const CkField *field, PetscReal *l2, PetscReal *stress)
{
  const AbutMeshTopology *t = CkTopology(CkMeshOf(body));
  AbutKinematics          kinematics;
  PetscQuadrature         rule;
  PetscInt                n;
  const PetscReal        *xi, *w, *uh;
  PetscReal               N[ABUT_CELL_NODES_MAX], dN[2 * ABUT_CELL_NODES_MAX], sum[4] = {0.}, x[2], det, u[2], s[4], sh[4];

  CkOk(AbutBodyGetKinematics(body, &kinematics));
  CkOk(AbutBodyGetNodeDisplacement(body, &uh));
  CkOk(AbutMeshCreateQuadrature(CkMeshOf(body), t->order + 3, &rule));
  CkOk(PetscQuadratureGetData(rule, NULL, NULL, &n, &xi, &w));
  for (PetscInt i = 0; i < n * t->ncells; ++i) {
    const PetscInt c = i / n, q = i % n;

    CkOk(AbutMeshEvaluateBasis(CkMeshOf(body), xi + 2 * q, N, dN));
    CkOk(AbutBodyGetCellPoint(body, c, xi + 2 * q, x, &det));
    CkOk(AbutBodyGetCellStresses3D(body, c, 1, xi + 2 * q, dN, sh, sh + 3));
    CkField3D(field, kinematics, x, u, s);
    for (PetscInt d = 0; d < 2; ++d) sum[1] += w[q] * det * u[d] * u[d];
    for (PetscInt k = 0; k < 2 * t->nodes; ++k) u[k % 2] -= N[k / 2] * uh[2 * t->cellnode[t->nodes * c + k / 2] + k % 2];
    for (PetscInt d = 0; d < 2; ++d) sum[0] += w[q] * det * u[d] * u[d];
    for (PetscInt k = 0; k < 4; ++k) {
      sum[2] += w[q] * det * PetscSqr(s[k] - sh[k]);
      sum[3] += w[q] * det * PetscSqr(s[k]);
    }
  }
  CkOk(PetscQuadratureDestroy(&rule));
  CkOk(MPI_Allreduce(MPI_IN_PLACE, sum, 4, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  *l2     = PetscSqrtReal(sum[0] / sum[1]);
  *stress = PetscSqrtReal(sum[2] / sum[3]);
}

/* Orders 1 to 4 on quads and 1 to 3 on triangles, on a grid and with hanging nodes: 14 meshes */
#define CK_MESHES 14
static inline AbutBody CkBodyOfOrder(int which, CkField *field, AbutKinematics kinematics, PetscReal x0, PetscReal y0, PetscReal x1,
                                     PetscReal y1, PetscInt n)
{
  const AbutShape shape = which % 7 < 4 ? ABUT_QUAD : ABUT_TRIANGLE;
  AbutBody        body;

  field->order = 1 + which % 7 % 4;
  body         = CkBodyOn(PETSC_COMM_WORLD, "body", field, x0, y0, x1, y1, n, n, shape);
  CkOk(AbutBodySetKinematics(body, kinematics));
  if (which >= 7) CkRefine(CkMeshOf(body), CkScattered, 2);
  return body;
}
