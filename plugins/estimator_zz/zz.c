#include "zz.h"

/*MC
   ABUTESTIMATORZZ - "zz": the finite-element stress against the one recovered from patches of cells

   Level: beginner

   Notes:
   Superconvergent patch recovery: O. C. Zienkiewicz and J. Z. Zhu, The superconvergent patch recovery and a posteriori error estimates,
   Int. J. Numer. Meth. Engng. 33 (1992). With cells of order p, the stress is sampled at p x p Gauss points of each cell; around every
   vertex a polynomial stress is fitted to the samples in the cells that have the vertex as a corner. Its values at a node of a cell,
   weighed with the bilinear functions of the corners, are the recovered stress of the node: T. Blacker and T. Belytschko, Superconvergent
   patch recovery with equilibrium and conjoint interpolant enhancements, Int. J. Numer. Meth. Engng. 37 (1994). A hanging node takes the
   function of its coarse side. Between nodes the shape functions interpolate.

   The polynomials are in balance, as N.-E. Wiberg and F. Abdulwahab proposed, Patch recovery based on superconvergent derivatives and
   equilibrium, Int. J. Numer. Meth. Engng. 36 (1993), and compatible as well: those of Kolosov's and Muskhelishvili's potentials, phi' and
   psi' of degree p, in quads from order 2 on of degree p+1. They are so few, 4p+3 of 3(p+1)(p+2)/2 for triangles, that vertices on the
   boundary have their own, from cells on one side; of order 1 these take what inner vertices say.

   From order 2 on, the samples keep their values in the recovered stress (in triangles its part of degree p-2): beside the edge of a
   contact the patches alone would claim up to three times the error.

   A constant body force is taken off with a stress that balances it, and added again.

   Cheap and local: nothing is solved.

   Limits: no body force that varies, one isotropic material. Where Hertz' pressure ends at a node, the estimate over the error is 0.91 to
   1.05 for quads, 0.93 to 1.02 for triangles, on the last three of five uniform meshes and of those refined there
   (tests/unit/ck_effectivity.c, ck_zz_orders.c); where it ends inside a cell, down to 0.4. At a stress without bound, under a sharp punch
   or at a corner, uniform meshes are judged too well by up to a third. Cells beside a hanging side are judged too well (order 2 by a third,
   3 by a half, 4 by two thirds): what its constraint spoils, the samples share. Triangles of order 1 in one row are judged too well by a
   fifth.

.seealso: `AbutEstimatorSetType()`, `AbutEstimatorCompareStress()`, `ABUTESTIMATORFEMBEM`
M*/

/* Shape functions at the points of a rule */
typedef struct {
  PetscInt   n;
  PetscReal *xi; /* [2*n] */
  PetscReal *N;  /* [nodes*n] */
} AbutShapeTable;

/* During an estimate only */
typedef struct {
  PetscReal     *s;        /* [3*nodes*ncells] recovered stress at the nodes of each cell */
  AbutShapeTable table[2]; /* of the last rules asked for; AbutEstimatorCompareStress() has two */
  PetscInt       next;     /* the table that makes room */
} AbutEstimator_ZZ;

static PetscErrorCode AbutShapeTableReset_Private(AbutShapeTable *table)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(table->xi, table->N));
  table->n = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorGetShape_ZZ(AbutEstimator_ZZ *zz, AbutMesh mesh, PetscInt nodes, PetscInt n, const PetscReal xi[],
                                               const PetscReal *N[])
{
  AbutShapeTable *table;
  PetscReal       dN[2 * ABUT_CELL_NODES_MAX];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < 2; ++i) {
    PetscBool same = PETSC_FALSE;

    if (zz->table[i].n == n) PetscCall(PetscArraycmp(zz->table[i].xi, xi, 2 * n, &same));
    *N = zz->table[i].N;
    if (same) PetscFunctionReturn(PETSC_SUCCESS);
  }
  table    = &zz->table[zz->next];
  zz->next = 1 - zz->next;
  PetscCall(AbutShapeTableReset_Private(table));
  PetscCall(PetscMalloc2(2 * n, &table->xi, nodes * n, &table->N));
  PetscCall(PetscArraycpy(table->xi, xi, 2 * n));
  for (PetscInt q = 0; q < n; ++q) PetscCall(AbutMeshEvaluateBasis(mesh, &xi[2 * q], table->N + nodes * q, dN));
  table->n = n;
  *N       = table->N;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorStress_ZZ(AbutEstimator est, AbutBody body, PetscInt c, PetscInt n, const PetscReal xi[],
                                             PETSC_UNUSED const PetscReal x[], PetscReal s[])
{
  AbutEstimator_ZZ       *zz;
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  const PetscReal        *N;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &zz));
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(AbutEstimatorGetShape_ZZ(zz, mesh, t->nodes, n, xi, &N));
  for (PetscInt q = 0; q < n; ++q)
    for (PetscInt j = 0; j < 3; ++j) {
      s[3 * q + j] = 0.;
      for (PetscInt k = 0; k < t->nodes; ++k) s[3 * q + j] += N[t->nodes * q + k] * zz->s[3 * (t->nodes * c + k) + j];
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorEstimate_ZZ(AbutEstimator est, AbutBody body, PetscReal eta[])
{
  AbutEstimator_ZZ       *zz;
  AbutMesh                mesh;
  const AbutMeshTopology *t;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &zz));
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(PetscMalloc1(3 * t->nodes * t->ncells, &zz->s));
  PetscCall(AbutEstimatorRecover_ZZ(body, zz->s));
  PetscCall(AbutEstimatorCompareStress(est, body, AbutEstimatorStress_ZZ, eta));
  PetscCall(PetscFree(zz->s));
  for (PetscInt i = 0; i < 2; ++i) PetscCall(AbutShapeTableReset_Private(&zz->table[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorDestroy_ZZ(AbutEstimator est)
{
  AbutEstimator_ZZ *zz;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &zz));
  PetscCall(PetscFree(zz));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorCreate_ZZ(AbutEstimator est)
{
  const AbutEstimatorOps ops = {.estimate = AbutEstimatorEstimate_ZZ, .destroy = AbutEstimatorDestroy_ZZ};
  AbutEstimator_ZZ      *zz;

  PetscFunctionBegin;
  PetscCall(PetscNew(&zz));
  PetscCall(AbutEstimatorSetData(est, zz));
  PetscCall(AbutEstimatorSetOps(est, &ops));
  PetscCall(AbutEstimatorSetFeatures(est, ABUT_FEATURE_BODY_FORCE_CONSTANT | ABUT_FEATURE_FOUNDATION | ABUT_FEATURE_PLANE_STRESS |
                                            ABUT_FEATURE_INITIAL_STRAIN_LINEAR));
  PetscCall(AbutEstimatorSetAbout(est, "stress recovered from patches of cells, Zienkiewicz and Zhu (1992)"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PETSc calls this when it opens libestimator_zz.so */
PETSC_EXTERN PetscErrorCode PetscDLLibraryRegister_estimator_zz(void)
{
  PetscFunctionBegin;
  PetscCall(AbutEstimatorRegister(ABUTESTIMATORZZ, AbutEstimatorCreate_ZZ));
  PetscFunctionReturn(PETSC_SUCCESS);
}
