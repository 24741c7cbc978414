#include <abutestimator.h>
#include "fembemimpl.h"
#include <petscdt.h>

/* A constant body force, an initial strain that is linear: the boundary elements judge what is left when a stress that balances the one is
   taken off, with its tractions and its displacement, and the displacement that frees of the other. The nodal forces of the tractions are
   taken off those that hold the body, component by component. */

/* Outward normal of boundary element e, times its length */
static void GetNormal(const AbutBoundary *b, PetscInt e, PetscReal n[2])
{
  const PetscReal *p = b->x + 2 * AbutBoundaryNode(b, e, 0), *q = b->x + 2 * AbutBoundaryNode(b, e, b->order);

  n[0] = q[1] - p[1];
  n[1] = p[0] - q[0];
}

/* s n at the nodes of element e, times its length: linear along it */
static PetscErrorCode GetTraction(AbutBody body, const AbutBoundary *b, PetscInt e, PetscReal t[])
{
  PetscReal n[2], s[3];

  PetscFunctionBegin;
  GetNormal(b, e, n);
  for (PetscInt k = 0; k <= b->order; ++k) {
    PetscCall(AbutEstimatorGetParticular(body, b->x + 2 * AbutBoundaryNode(b, e, k), NULL, s));
    t[2 * k]     = s[0] * n[0] + s[2] * n[1];
    t[2 * k + 1] = s[2] * n[0] + s[1] * n[1];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes it off one element: off its given traction, or off the nodal forces where none is given */
static PetscErrorCode TakeOffElement(AbutBody body, PetscInt e, AbutBoundary *b)
{
  const PetscInt n = b->order + 1;
  PetscReal      t[2 * ABUT_SIDE_NODES_MAX], z[ABUT_SIDE_NODES_MAX], w[ABUT_SIDE_NODES_MAX], normal[2], length;

  PetscFunctionBegin;
  PetscCall(GetTraction(body, b, e, t));
  GetNormal(b, e, normal);
  length = PetscSqrtReal(PetscSqr(normal[0]) + PetscSqr(normal[1]));
  PetscCall(PetscDTGaussQuadrature(n, -1., 1., z, w));
  for (PetscInt d = 0; d < 2; ++d) {
    const AbutConditionType type  = b->condition[2 * e + d];
    PetscReal              *force = type == ABUT_CONTACT ? b->contact : b->reaction;

    for (PetscInt k = 0; k < n && type == ABUT_TRACTION; ++k) b->traction[2 * (n * e + k) + d] -= t[2 * k + d] / length;
    for (PetscInt q = 0; q < n && type != ABUT_TRACTION; ++q) {
      PetscReal N[ABUT_SIDE_NODES_MAX], here = 0.;

      PetscCall(AbutEvaluateLobatto(b->order, z[q], N, NULL));
      for (PetscInt k = 0; k < n; ++k) here += N[k] * t[2 * k + d];
      for (PetscInt k = 0; k < n; ++k) force[2 * AbutBoundaryNode(b, e, k) + d] -= 0.5 * w[q] * here * N[k];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FembemTakeOffForce(AbutBody body, AbutBoundary *b)
{
  PetscInt features;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetFeatures(body, &features));
  if (!(features & (ABUT_FEATURE_BODY_FORCE_CONSTANT | ABUT_FEATURE_INITIAL_STRAIN_LINEAR))) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt e = 0; e < b->n; ++e) PetscCall(TakeOffElement(body, e, b));
  for (PetscInt i = 0; i < b->nnodes; ++i) {
    PetscReal u[2], s[3];

    PetscCall(AbutEstimatorGetParticular(body, b->x + 2 * i, u, s));
    for (PetscInt d = 0; d < 2; ++d) b->u[2 * i + d] -= u[d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FembemAddForce(AbutBody body, PetscInt n, const PetscReal x[], PetscReal s[])
{
  PetscInt features;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetFeatures(body, &features));
  for (PetscInt q = 0; q < n && features & ABUT_FEATURE_BODY_FORCE_CONSTANT; ++q) {
    PetscReal more[3];

    PetscCall(AbutEstimatorGetParticular(body, x + 2 * q, NULL, more));
    for (PetscInt i = 0; i < 3; ++i) s[3 * q + i] += more[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
