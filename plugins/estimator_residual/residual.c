#include "residual.h"
#include <petscdt.h>

/*MC
   ABUTESTIMATORRESIDUAL - "residual": what the finite-element stress leaves of equilibrium, in the cells, across their sides, on the
   boundary

   Options Database Key:
.  -estimator_residual_constant <0.25 for quads, 0.3 for triangles> - what the residual is multiplied by to be an estimate of the error

   Level: beginner

   Notes:
   With p the order, n the outward normal, h the height of the cell above a side of it, the residual res_e of a cell e is the root of the
   sum of

     (h/p)^2 ||div s + f||^2 over the cell, f the body force, h the largest of its heights;
     1/2 h/p ||[s n]||^2 over its sides inside the body, the coarse cell above hanging sides as well;
     h/p ||t - s n||^2 over its sides on the boundary, in the components without a given displacement.

   With axial symmetry all are integrals over a whole turn, and div s has the terms (s_rr - s_tt)/r and s_rz/r.

   There t is the given traction, with that of springs under the displacement, or that of contact, -p n and with friction a tangential one:
   then the term is the normal stress plus the pressure, and what the shear stress differs by. They come from the nodal contact forces: force
   over the integral of the node's function, interpolated; at a corner between two sides in contact without the tangential one.

   eta_e is C res_e in the scale of eq. (27): relative to the root mean square of the stress. R. Verfuerth, A review of a posteriori error
   estimation and adaptive mesh-refinement techniques (1996); with contact P. Hild and S. Nicaise, Residual a posteriori error estimators
   for contact problems in elasticity, ESAIM: M2AN 41 (2007); powers of p as in J. M. Melenk and B. I. Wohlmuth, On residual-based a
   posteriori error estimation in hp-FEM, Adv. Comput. Math. 15 (2001).

   The theory leaves the constant open; C is from measurements. Estimate over true error of the stress, quads of orders 1 to 4 and triangles
   of orders 1 to 3, smooth solution, cells of side 1/4 to 1/16: .84-.88, .89-.91, 1.14-1.19, 1.09 and .85-.89, .93-.94, 1.19-1.22. Where
   Hertz' pressure ends at a node, side 1/32: .93, .88, 1.12, 1.43 and .90, .91, 1.12; where it ends inside a cell of side 1/5, down to .55.
   Where the pressure of a sharp punch ends: .57, .61, .80, .97 and .61, .62, .75, on four meshes. Cells 16 and 32 times as long as wide,
   along either axis: .85-1.5, but 2.8 for quads of order 1 across the direction of the error. Poisson's ratio from 0 to .4999: .6 to 1.3.

   Bodies of revolution, a smooth solution that has an axis: .83-1.10, .99-1.24, 1.11-1.46, 1.10-1.38 with orders 1 to 4. An initial strain
   that varies inside cells of order 1: .44-.68.

   Limits: no nodal forces but those of tractions, contact and springs. Given tractions count by their L2 projection on the elements, so
   that what a mesh does not see of them is no error. A locked stress, triangles of order 1 at Poisson's ratios above .49, leaves little of
   a residual: the estimate is then far too small. The two bodies of a pair are judged one by one: penetration between nodes, or a pressure
   where there is a gap, is not in it. At a node of a contact side that a support holds along the normal no pressure is known: it counts as
   free of pressure.

.seealso: `AbutEstimatorSetType()`, `AbutEstimatorScale()`, `ABUTESTIMATORFEMBEM`, `ABUTESTIMATORZZ`
M*/

typedef struct {
  PetscReal constant; /* 0 for that of the shape of the cells */
} AbutEstimator_Residual;

static PetscErrorCode AbutEstimatorEstimate_Residual(AbutEstimator est, AbutBody body, PetscReal eta[])
{
  AbutEstimator_Residual *residual;
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  ResidualRule            rule;
  PetscReal               norm, constant;
  PetscBool               balance;
  const char             *name;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &residual));
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutBodyGetName(body, &name));
  PetscCall(AbutMeshGetBalance(mesh, &balance));
  AbutCheckInput(balance, PetscObjectComm((PetscObject)est),
                 "estimator_type: residual looks at two halves of a side, at most; leave out %s_mesh_balance, or give another estimator",
                 name);
  PetscCall(AbutMeshGetTopology(mesh, &t));
  rule.n = t->order + 1;
  PetscCall(PetscDTGaussQuadrature(rule.n, 0., 1., rule.s, rule.w));
  PetscCall(PetscArrayzero(eta, t->ncells));
  PetscCall(ResidualAddInside(body, eta, &norm));
  PetscCall(ResidualAddJumps(body, &rule, eta));
  PetscCall(ResidualAddBoundary(body, &rule, eta));
  constant = residual->constant > 0. ? residual->constant : t->corners == 4 ? 0.25 : 0.3;
  for (PetscInt c = 0; c < t->ncells; ++c) eta[c] *= PetscSqr(constant);
  PetscCall(AbutEstimatorScale(body, norm, eta));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorSetFromOptions_Residual(AbutEstimator est, AbutOptionItems PetscOptionsObject)
{
  AbutEstimator_Residual *residual;
  PetscBool               set;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &residual));
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-estimator_residual_constant",
                            "what the residual is multiplied by; 0.25 for quads, 0.3 for triangles, if not given", &residual->constant,
                            &set));
  AbutCheckInput(!set || residual->constant > 0., PetscObjectComm((PetscObject)est),
                 "estimator_residual_constant: %g is not positive; give what the residual is multiplied by", (double)residual->constant);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorView_Residual(AbutEstimator est, PetscViewer viewer)
{
  AbutEstimator_Residual *residual;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &residual));
  if (residual->constant > 0.) PetscCall(PetscViewerASCIIPrintf(viewer, "  residual times %g\n", (double)residual->constant));
  else PetscCall(PetscViewerASCIIPrintf(viewer, "  residual times the constant of the shape of the cells\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorDestroy_Residual(AbutEstimator est)
{
  AbutEstimator_Residual *residual;

  PetscFunctionBegin;
  PetscCall(AbutEstimatorGetData(est, &residual));
  PetscCall(PetscFree(residual));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutEstimatorCreate_Residual(AbutEstimator est)
{
  const AbutEstimatorOps  ops = {.estimate       = AbutEstimatorEstimate_Residual,
                                 .setfromoptions = AbutEstimatorSetFromOptions_Residual,
                                 .view           = AbutEstimatorView_Residual,
                                 .destroy        = AbutEstimatorDestroy_Residual};
  AbutEstimator_Residual *residual;

  PetscFunctionBegin;
  PetscCall(PetscNew(&residual));
  PetscCall(AbutEstimatorSetData(est, residual));
  PetscCall(AbutEstimatorSetOps(est, &ops));
  PetscCall(AbutEstimatorSetFeatures(est, ABUT_FEATURE_BODY_FORCE_CONSTANT | ABUT_FEATURE_BODY_FORCE_VARYING | ABUT_FEATURE_FOUNDATION |
                                            ABUT_FEATURE_PLANE_STRESS | ABUT_FEATURE_AXISYMMETRIC | ABUT_FEATURE_INITIAL_STRAIN |
                                            ABUT_FEATURE_INITIAL_STRAIN_LINEAR));
  PetscCall(AbutEstimatorSetAbout(est, "what is left of equilibrium in cells, across their sides and on the boundary"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PETSc calls this when it opens libestimator_residual.so */
PETSC_EXTERN PetscErrorCode PetscDLLibraryRegister_estimator_residual(void)
{
  PetscFunctionBegin;
  PetscCall(AbutEstimatorRegister(ABUTESTIMATORRESIDUAL, AbutEstimatorCreate_Residual));
  PetscFunctionReturn(PETSC_SUCCESS);
}
