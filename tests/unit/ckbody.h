#pragma once

#include "ckmesh.h"
#include <abutbody.h>
#include <petscdt.h>
#include <complex.h>

/* Bodies whose displacement is known, and how far from it they are. Fields satisfy the equations of plane strain without body force,
   except CkForced. */

typedef struct CkField CkField;
typedef struct {
  const CkField *field;
  PetscInt       side, component;
} CkData;
struct CkField {
  void (*at)(const CkField *, const PetscReal x[2], PetscReal u[2], PetscReal s[3]); /* displacement, and s11, s22, s12 */
  PetscReal young, poisson;
  PetscInt  order;      /* of the mesh; 0 is 1 */
  CkData    data[4][2]; /* what the conditions on the sides refer to */
};

#define CK_YOUNG   2.1e5
#define CK_POISSON 0.3

/* u = (1 + 2x - y, 3 - x/2 + 4y)/1000: every strain is there, and a rotation */
static inline void CkLinear(const CkField *field, const PetscReal x[2], PetscReal u[2], PetscReal s[3])
{
  const PetscReal E = field->young, nu = field->poisson, mu = E / (2. * (1. + nu)), lambda = E * nu / ((1. + nu) * (1. - 2. * nu));

  u[0] = 1e-3 * (1. + 2. * x[0] - x[1]);
  u[1] = 1e-3 * (3. - 0.5 * x[0] + 4. * x[1]);
  s[0] = 1e-3 * (lambda * 6. + 2. * mu * 2.);
  s[1] = 1e-3 * (lambda * 6. + 2. * mu * 4.);
  s[2] = 1e-3 * mu * -1.5;
}

/* Kolosov and Muskhelishvili's potentials: 2 mu (u1 + i u2) = (3 - 4 nu) phi - z conj(phi') - conj(psi) */
static inline void CkSmooth(const CkField *field, const PetscReal x[2], PetscReal u[2], PetscReal s[3])
{
  const double complex z = x[0] + I * x[1], phi = 2. * cexp(0.5 * z), dphi = 0.5 * phi, ddphi = 0.25 * phi, psi = csin(z), dpsi = ccos(z);
  const double complex w = ((3. - 4. * field->poisson) * phi - z * conj(dphi) - conj(psi)) * (1. + field->poisson) / field->young,
                       t = 2. * (conj(z) * ddphi + dpsi);

  u[0] = creal(w);
  u[1] = cimag(w);
  s[0] = 2. * creal(dphi) - 0.5 * creal(t);
  s[1] = 2. * creal(dphi) + 0.5 * creal(t);
  s[2] = 0.5 * cimag(t);
}

/* Hertz' pressure sqrt(a^2 - x^2) p0/a on the half-plane y <= 0 by Westergaard's function; a = 1/2, p0 = 1000, x >= 0 */
static inline void CkHertz(const CkField *field, const PetscReal x[2], PetscReal u[2], PetscReal s[3])
{
  const PetscReal      a = 0.5, p0 = 1000., y = x[1], nu = field->poisson, mu = field->young / (2. * (1. + nu));
  const double complex z = x[0] + I * PetscMin(y, -1e-290), root = csqrt(a * a - z * z); /* the side y = 0 is seen from below */
  const double complex Z = -p0 / a * (root - I * z), dZ = p0 / a * (z / root + I),
                       Zi = -p0 / a * (0.5 * z * root + 0.5 * a * a * casin(z / a) - 0.5 * I * z * z);

  u[0] = ((1. - 2. * nu) * creal(Zi) - y * cimag(Z)) / (2. * mu);
  u[1] = (2. * (1. - nu) * cimag(Zi) - y * creal(Z)) / (2. * mu);
  s[0] = creal(Z) - (y < 0. ? y * cimag(dZ) : 0.);
  s[1] = creal(Z) + (y < 0. ? y * cimag(dZ) : 0.);
  s[2] = y < 0. ? -y * creal(dZ) : 0.;
}

/* The same on the half-plane y >= 0 */
static inline void CkHertzAbove(const CkField *field, const PetscReal x[2], PetscReal u[2], PetscReal s[3])
{
  const PetscReal below[2] = {x[0], -x[1]};

  CkHertz(field, below, u, s);
  u[1] = -u[1];
  s[2] = -s[2];
}

/* u = (sin x cosh y, x y^2)/1000, which wants a body force */
static inline void CkForced(const CkField *field, const PetscReal x[2], PetscReal u[2], PetscReal s[3])
{
  const PetscReal E = field->young, nu = field->poisson, mu = E / (2. * (1. + nu)), lambda = E * nu / ((1. + nu) * (1. - 2. * nu));
  const PetscReal e11 = 1e-3 * cos(x[0]) * cosh(x[1]), e22 = 2e-3 * x[0] * x[1], g = 1e-3 * (sin(x[0]) * sinh(x[1]) + x[1] * x[1]);

  u[0] = 1e-3 * sin(x[0]) * cosh(x[1]);
  u[1] = 1e-3 * x[0] * x[1] * x[1];
  s[0] = lambda * (e11 + e22) + 2. * mu * e11;
  s[1] = lambda * (e11 + e22) + 2. * mu * e22;
  s[2] = mu * g;
}

/* -div s = -mu (lap u) - (lambda + mu) grad div u; lap u = (0, 2x), div u = cos x cosh y + 2xy */
static inline PetscErrorCode CkForceOfForced(const PetscReal x[2], PetscReal f[2], void *ctx)
{
  const CkField  *field = (const CkField *)ctx;
  const PetscReal E = field->young, nu = field->poisson, mu = E / (2. * (1. + nu)), lambda = E * nu / ((1. + nu) * (1. - 2. * nu));

  f[0] = -1e-3 * (lambda + mu) * (2. * x[1] - sin(x[0]) * cosh(x[1]));
  f[1] = -1e-3 * (mu * 2. * x[0] + (lambda + mu) * (cos(x[0]) * sinh(x[1]) + 2. * x[0]));
  return PETSC_SUCCESS;
}

static inline PetscErrorCode CkDisplacement(const PetscReal x[2], PetscReal *value, void *ctx)
{
  const CkData *data = (const CkData *)ctx;
  PetscReal     u[2], s[3];

  data->field->at(data->field, x, u, s);
  *value = u[data->component];
  return PETSC_SUCCESS;
}

static inline PetscErrorCode CkTraction(const PetscReal x[2], PetscReal *value, void *ctx)
{
  const CkData  *data = (const CkData *)ctx;
  const PetscInt d    = data->side / 2; /* sides left, right, bottom, top: the normal is -e1, e1, -e2, e2 */
  PetscReal      u[2], s[3];

  data->field->at(data->field, x, u, s);
  *value = (data->side % 2 ? 1. : -1.) * (d == data->component ? s[d] : s[2]);
  return PETSC_SUCCESS;
}

/* A body of a field, without conditions yet */
static inline AbutBody CkBodyOn(MPI_Comm comm, const char name[], CkField *field, PetscReal x0, PetscReal y0, PetscReal x1, PetscReal y1,
                                PetscInt nx, PetscInt ny, AbutShape shape)
{
  const PetscReal lower[2] = {x0, y0}, upper[2] = {x1, y1};
  const PetscInt  cells[2] = {nx, ny};
  AbutMesh        mesh;
  AbutBody        body;

  if (field->young == 0.) {
    field->young   = CK_YOUNG;
    field->poisson = CK_POISSON;
  }
  CkOk(AbutBodyCreate(comm, name, &body));
  CkOk(AbutBodyGetMesh(body, &mesh));
  CkOk(AbutMeshSetBox(mesh, lower, upper, cells, shape));
  if (field->order) CkOk(AbutMeshSetOrder(mesh, field->order));
  CkOk(AbutMeshSetUp(mesh));
  CkOk(AbutBodySetMaterial(body, field->young, field->poisson));
  return body;
}

/* The axis of a body of revolution has no area on which a traction could act */
static inline PetscBool CkIsAxis(AbutBody body, AbutMesh mesh, PetscInt side)
{
  AbutKinematics kinematics;
  PetscReal      ends[4], normal[2];

  CkOk(AbutBodyGetKinematics(body, &kinematics));
  CkOk(AbutMeshGetSideEnds(mesh, side, ends, normal));
  return (PetscBool)(kinematics == ABUT_AXISYMMETRIC && ends[0] == 0. && ends[2] == 0.);
}

/* The field's displacements (u) or tractions (t) on a side, a letter per component, - for none: CkGive(body, &field, "left", "ut") */
static inline void CkGive(AbutBody body, CkField *field, const char side[], const char what[2])
{
  AbutMesh mesh;
  PetscInt s;

  CkOk(AbutBodyGetMesh(body, &mesh));
  CkOk(AbutMeshFindSide(mesh, "side", side, &s));
  for (PetscInt d = 0; d < 2; ++d) {
    CkData *data    = &field->data[s][d];
    data->field     = field;
    data->side      = s;
    data->component = d;
    if (what[d] == 'u') CkOk(AbutBodySetDisplacement(body, side, d, CkDisplacement, data));
    if (what[d] == 't' && !CkIsAxis(body, mesh, s)) CkOk(AbutBodySetTraction(body, side, d, CkTraction, data));
  }
}

static inline void CkGiveAll(AbutBody body, CkField *field, const char left[2], const char right[2], const char bottom[2],
                             const char top[2])
{
  CkGive(body, field, "left", left);
  CkGive(body, field, "right", right);
  CkGive(body, field, "bottom", bottom);
  CkGive(body, field, "top", top);
}

static inline AbutMesh CkMeshOf(AbutBody body)
{
  AbutMesh mesh;

  CkOk(AbutBodyGetMesh(body, &mesh));
  return mesh;
}

/* Largest distance from the field at vertices, over the largest displacement */
static inline PetscReal CkNodalError(AbutBody body, const CkField *field)
{
  const AbutMeshTopology *t       = CkTopology(CkMeshOf(body));
  PetscReal               most[2] = {0., 0.}, u[2], s[3];
  const PetscReal        *uh;

  CkOk(AbutBodyGetNodeDisplacement(body, &uh));
  for (PetscInt i = 0; i < t->corners * t->ncells; ++i) {
    const PetscInt v = t->cell[i];

    field->at(field, t->x + 2 * v, u, s);
    for (PetscInt d = 0; d < 2; ++d) {
      most[0] = PetscMax(most[0], PetscAbsReal(uh[2 * v + d] - u[d]));
      most[1] = PetscMax(most[1], PetscAbsReal(u[d]));
    }
  }
  CkOk(MPI_Allreduce(MPI_IN_PLACE, most, 2, MPIU_REAL, MPIU_MAX, PetscObjectComm((PetscObject)body)));
  return most[0] / most[1];
}

#define CK_POINTS 7

/* Squares over a local cell, CK_POINTS^2 points: of the distance of the solution from the field, of the field; first the L2 norm of the
   displacement, then the energy norm (sigma:eps) */
static inline void CkCellErrors(AbutBody body, const CkField *field, PetscInt cell, PetscReal sum[4])
{
  const AbutMeshTopology *t  = CkTopology(CkMeshOf(body));
  const PetscReal         nu = field->poisson, c = (1. + nu) / field->young;
  PetscReal               z[CK_POINTS], w[CK_POINTS];
  const PetscReal        *uh;

  CkOk(PetscDTGaussQuadrature(CK_POINTS, 0., 1., z, w));
  CkOk(AbutBodyGetNodeDisplacement(body, &uh));
  CkOk(PetscArrayzero(sum, 4));
  for (PetscInt q = 0; q < CK_POINTS * CK_POINTS; ++q) {
    const PetscReal a = z[q / CK_POINTS], b = z[q % CK_POINTS], wab = w[q / CK_POINTS] * w[q % CK_POINTS];
    PetscReal       xi[2] =
      {
        2. * a - 1., 2. * b - 1.
    },
              x[2], N[ABUT_CELL_NODES_MAX], G[2 * ABUT_CELL_NODES_MAX], det, s[2][3], u[2][2] = {{0., 0.}, {0., 0.}}, weight = 4. * wab;

    if (t->corners == 3) { /* a square squeezed to a triangle */
      xi[0]  = a;
      xi[1]  = b * (1. - a);
      weight = wab * (1. - a);
    }
    CkOk(AbutMeshMapCell(CkMeshOf(body), cell, xi, x, N, G, &det));
    CkOk(AbutBodyGetCellStress(body, cell, xi, s[0]));
    field->at(field, x, u[1], s[1]);
    for (PetscInt k = 0; k < 2 * t->nodes; ++k) u[0][k % 2] += N[k / 2] * uh[2 * t->cellnode[t->nodes * cell + k / 2] + k % 2];
    for (PetscInt of = 0; of < 2; ++of) {
      const PetscReal *e = s[1];
      PetscReal        d[3];

      for (PetscInt i = 0; i < 3; ++i) d[i] = of ? e[i] : e[i] - s[0][i];
      for (PetscInt i = 0; i < 2; ++i) sum[of] += weight * det * PetscSqr(u[1][i] - (of ? 0. : u[0][i]));
      sum[2 + of] += weight * det * c * ((1. - nu) * (d[0] * d[0] + d[1] * d[1]) - 2. * nu * d[0] * d[1] + 2. * d[2] * d[2]);
    }
  }
}

/* The same over the body, relative */
static inline void CkErrors(AbutBody body, const CkField *field, PetscReal *l2, PetscReal *energy)
{
  const AbutMeshTopology *t      = CkTopology(CkMeshOf(body));
  PetscReal               sum[4] = {0., 0., 0., 0.};

  for (PetscInt cell = 0; cell < t->ncells; ++cell) {
    PetscReal one[4];

    CkCellErrors(body, field, cell, one);
    for (PetscInt i = 0; i < 4; ++i) sum[i] += one[i];
  }
  CkOk(MPI_Allreduce(MPI_IN_PLACE, sum, 4, MPIU_REAL, MPIU_SUM, PetscObjectComm((PetscObject)body)));
  *l2     = PetscSqrtReal(sum[0] / sum[1]);
  *energy = PetscSqrtReal(sum[2] / sum[3]);
}

/* Largest distance of the stresses at three points of every cell from the field's, over the largest stress */
static inline PetscReal CkStressError(AbutBody body, const CkField *field)
{
  const PetscReal xi[3][2] = {
    {0.1, 0.1},
    {0.8, 0.1},
    {0.2, 0.7}
  };
  const AbutMeshTopology *t       = CkTopology(CkMeshOf(body));
  PetscReal               most[2] = {0., 0.}, x[2], det, u[2], s[2][3];

  for (PetscInt c = 0; c < t->ncells; ++c)
    for (PetscInt q = 0; q < 3; ++q) {
      CkOk(AbutBodyGetCellPoint(body, c, xi[q], x, &det));
      CkOk(AbutBodyGetCellStress(body, c, xi[q], s[0]));
      field->at(field, x, u, s[1]);
      for (PetscInt i = 0; i < 3; ++i) {
        most[0] = PetscMax(most[0], PetscAbsReal(s[0][i] - s[1][i]));
        most[1] = PetscMax(most[1], PetscAbsReal(s[1][i]));
      }
    }
  CkOk(MPI_Allreduce(MPI_IN_PLACE, most, 2, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  return most[0] / most[1];
}
