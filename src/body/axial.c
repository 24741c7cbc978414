#include "element.h"

/* Cells of bodies of revolution: x is the radius r, y the axis, and the strain around it is u1/r. Everything is integrated over a turn, by
   Gauss points, which are never on the axis. */

/* The strain u1/r that function k of a cell makes at r > 0, or its limit where r is 0 as far as the cell is known: there u1 vanishes */
static inline PetscReal AbutHoop_Private(PetscReal r, PetscReal extent, PetscReal N, PetscReal dN)
{
  return r > 1e-8 * extent ? N / r : dN;
}

/* The largest radius of a local cell */
static PetscReal AbutCellExtent_Private(const AbutMeshTopology *t, PetscInt c)
{
  PetscReal r = 0.;

  for (PetscInt k = 0; k < t->corners; ++k) r = PetscMax(r, t->x[2 * t->cell[t->corners * c + k]]);
  return r;
}

/* The blocks of nodes a and b, from the gradients and the hoop strains of their functions, times w */
static inline void AbutAddAxialBlock_Private(PetscInt n, PetscInt a, PetscInt b, PetscReal lambda, PetscReal mu, PetscReal w,
                                             const PetscReal G[], const PetscReal hoop[], PetscReal K[])
{
  const PetscReal *A = G + 2 * a, *B = G + 2 * b, da[2] = {A[0] + hoop[a], A[1]}, db[2] = {B[0] + hoop[b], B[1]};
  const PetscReal  trace = A[0] * B[0] + A[1] * B[1];

  for (PetscInt i = 0; i < 2; ++i)
    for (PetscInt j = 0; j < 2; ++j) {
      PetscReal k = lambda * da[i] * db[j] + mu * A[j] * B[i];

      if (i == j) k += mu * (i ? trace : trace + 2. * hoop[a] * hoop[b]);
      K[(2 * a + i) * 2 * n + 2 * b + j] += w * k;
      if (a != b) K[(2 * b + j) * 2 * n + 2 * a + i] += w * k;
    }
}

/* K[(2*nodes)^2] of local cell c; against locking with the mean of the dilatation over its volume, as in plane cells */
static PetscErrorCode AbutCellStiffness_Axisymmetric(AbutBody body, PetscInt c, PetscReal K[])
{
  const AbutElement e      = body->element;
  const PetscInt    n      = e->nodes;
  const PetscReal   lambda = body->meandilatation ? 0. : body->lambda;
  PetscReal         volume = 0., N[ABUT_CELL_NODES_MAX], x[2], det, w;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(K, 4 * n * n));
  PetscCall(PetscArrayzero(e->mean, 2 * n));
  for (PetscInt q = 0; q < e->npoints; ++q) {
    PetscCall(AbutMeshMapCell(body->mesh, c, e->xi + 2 * q, x, N, e->G, &det));
    w = 2. * PETSC_PI * x[0] * det * e->w[q];
    volume += w;
    for (PetscInt k = 0; k < n; ++k) N[k] /= x[0];
    for (PetscInt k = 0; k < 2 * n; ++k) e->mean[k] += w * (e->G[k] + (k % 2 ? 0. : N[k / 2]));
    for (PetscInt a = 0; a < n; ++a)
      for (PetscInt b = a; b < n; ++b) AbutAddAxialBlock_Private(n, a, b, lambda, body->mu, w, e->G, N, K);
  }
  if (body->meandilatation)
    for (PetscInt k = 0; k < 2 * n; ++k)
      for (PetscInt l = 0; l < 2 * n; ++l) K[k * 2 * n + l] += body->lambda * e->mean[k] * e->mean[l] / volume;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutCellDilatation_Axisymmetric(AbutBody body, PetscInt c, PetscReal *mean)
{
  const AbutElement       e      = body->element;
  PetscReal               volume = 0., sum = 0., N[ABUT_CELL_NODES_MAX], x[2], det, w;
  const AbutMeshTopology *t;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  for (PetscInt q = 0; q < e->npoints; ++q) {
    PetscCall(AbutMeshMapCell(body->mesh, c, e->xi + 2 * q, x, N, e->G, &det));
    w = x[0] * det * e->w[q];
    volume += w;
    for (PetscInt k = 0; k < e->nodes; ++k) {
      const PetscReal *u = body->nodeu + 2 * t->cellnode[e->nodes * c + k];

      sum += w * ((e->G[2 * k] + N[k] / x[0]) * u[0] + e->G[2 * k + 1] * u[1]);
    }
  }
  *mean = sum / volume;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* s[3*n], and unless it is NULL the hoop stress s33[n]: of what moved, without the initial strains */
static PetscErrorCode AbutCellStresses_Axisymmetric(AbutBody body, PetscInt c, PetscInt n, const PetscReal xi[],
                                                    PETSC_UNUSED const PetscReal dN[], PetscReal s[], PetscReal s33[])
{
  const AbutMeshTopology *t;
  PetscReal               mean = 0., N[ABUT_CELL_NODES_MAX], G[2 * ABUT_CELL_NODES_MAX], x[2], det, extent;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  extent = AbutCellExtent_Private(t, c);
  if (body->meandilatation) PetscCall(AbutCellDilatation_Axisymmetric(body, c, &mean));
  for (PetscInt q = 0; q < n; ++q) {
    PetscReal e[4] = {0., 0., 0., 0.}, trace;

    PetscCall(AbutMeshMapCell(body->mesh, c, xi + 2 * q, x, N, G, &det));
    for (PetscInt k = 0; k < t->nodes; ++k) {
      const PetscReal *u = body->nodeu + 2 * t->cellnode[t->nodes * c + k];

      e[0] += G[2 * k] * u[0];
      e[1] += G[2 * k + 1] * u[1];
      e[2] += 0.5 * (G[2 * k + 1] * u[0] + G[2 * k] * u[1]);
      e[3] += AbutHoop_Private(x[0], extent, N[k], G[2 * k]) * u[0];
    }
    trace        = body->lambda * (body->meandilatation ? mean : e[0] + e[1] + e[3]);
    s[3 * q]     = trace + 2. * body->mu * e[0];
    s[3 * q + 1] = trace + 2. * body->mu * e[1];
    s[3 * q + 2] = 2. * body->mu * e[2];
    if (s33) s33[q] = trace + 2. * body->mu * e[3];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

const AbutCellOps AbutCellOps_Axisymmetric = {AbutCellStiffness_Axisymmetric, AbutCellDilatation_Axisymmetric,
                                              AbutCellStresses_Axisymmetric};
