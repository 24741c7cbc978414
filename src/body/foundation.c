#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/
#include <petscdt.h>

/* Sides on springs, E. Winkler's foundation: traction -C u with C = k_n n n' + k_t t t'. The springs are a part of the operator. */

/* C for an outward unit normal n and k = (k_n, k_t) */
static void AbutSprings_Private(const PetscReal k[2], const PetscReal n[2], PetscReal C[4])
{
  for (PetscInt i = 0; i < 4; ++i) C[i] = (k[0] - k[1]) * n[i / 2] * n[i % 2] + (i % 3 ? 0. : k[1]);
}

/* Room for the rows of boundary nodes: those of two elements meet in a vertex */
static PetscErrorCode AbutBodyCreateSpringMat_Private(AbutBody body, const AbutMeshTopology *t)
{
  const PetscInt room = 2 * body->boundary->order + 1;
  PetscInt      *diagonal, *off;

  PetscFunctionBegin;
  PetscCall(PetscCalloc2(t->nowned, &diagonal, t->nowned, &off));
  for (PetscInt i = 0; i < body->boundary->nnodes; ++i) {
    const PetscInt own = body->boundaryglobal[i] - t->firstowned;

    if (own < 0 || own >= t->nowned) continue;
    diagonal[own] = PetscMin(room, t->nowned);
    off[own]      = PetscMin(room, t->nglobal - t->nowned);
  }
  PetscCall(AbutBodyCreateGroupMat_Private(body, diagonal, off, &body->S));
  PetscCall(PetscFree2(diagonal, off));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows of this rank in the matrix of boundary element e: C times the mass matrix, by Gauss points that are exact for it */
static PetscErrorCode AbutBodyElementSprings_Private(AbutBody body, const AbutMeshTopology *t, PetscInt e, const PetscReal C[4],
                                                     PetscReal length)
{
  const AbutBoundary *b                                            = body->boundary;
  const PetscInt      n                                            = b->order + 1;
  PetscReal           M[ABUT_SIDE_NODES_MAX * ABUT_SIDE_NODES_MAX] = {0.}, z[ABUT_SIDE_NODES_MAX + 1], w[ABUT_SIDE_NODES_MAX + 1];
  PetscInt            node[ABUT_SIDE_NODES_MAX];

  PetscFunctionBegin;
  PetscCall(PetscDTGaussQuadrature(n, -1., 1., z, w));
  for (PetscInt q = 0; q < n; ++q) {
    const PetscReal *p = b->x + 2 * AbutBoundaryNode(b, e, 0), *r = b->x + 2 * AbutBoundaryNode(b, e, b->order), s = 0.5 * (1. + z[q]);
    const PetscReal  x[2] = {(1. - s) * p[0] + s * r[0], (1. - s) * p[1] + s * r[1]};
    PetscReal        N[ABUT_SIDE_NODES_MAX], thickness;

    PetscCall(AbutEvaluateLobatto(b->order, z[q], N, NULL));
    PetscCall(AbutBodyGetThickness(body, x, &thickness));
    for (PetscInt i = 0; i < n * n; ++i) M[i] += 0.5 * length * w[q] * thickness * N[i / n] * N[i % n];
  }
  for (PetscInt k = 0; k < n; ++k) node[k] = body->boundaryglobal[AbutBoundaryNode(b, e, k)];
  for (PetscInt k = 0; k < n; ++k) {
    PetscReal row[4 * ABUT_SIDE_NODES_MAX];

    if (node[k] < t->firstowned || node[k] >= t->firstowned + t->nowned) continue;
    for (PetscInt j = 0; j < n; ++j)
      for (PetscInt i = 0; i < 4; ++i) row[i / 2 * 2 * n + 2 * j + i % 2] = C[i] * M[n * k + j];
    PetscCall(MatSetValuesBlocked(body->S, 1, node + k, n, node, row, ADD_VALUES));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the springs to the stiffness, and keeps them: every rank knows the whole boundary, and makes its own rows */
PetscErrorCode AbutBodyAssembleFoundation_Private(AbutBody body)
{
  const AbutBoundary     *b = body->boundary;
  const AbutMeshTopology *t;

  PetscFunctionBegin;
  PetscCall(AbutMeshGetTopology(body->mesh, &t));
  for (AbutHook h = body->hooks; h; h = h->next) {
    if (h->type != ABUT_HOOK_FOUNDATION) continue;
    PetscCall(PetscLogEventBegin(h->event, body, 0, 0, 0));
    if (!body->S) PetscCall(AbutBodyCreateSpringMat_Private(body, t));
    for (PetscInt e = 0; e < b->n; ++e) {
      PetscReal normal[2], C[4],
        length = AbutElementNormal_Private(b->x + 2 * AbutBoundaryNode(b, e, 0), b->x + 2 * AbutBoundaryNode(b, e, b->order), normal);

      AbutSprings_Private(h->stiffness, normal, C);
      if (b->side[e] == h->side) PetscCall(AbutBodyElementSprings_Private(body, t, e, C, length));
    }
    PetscCall(PetscLogEventEnd(h->event, body, 0, 0, 0));
  }
  if (!body->S) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatAssemblyBegin(body->S, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(body->S, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAXPY(body->A, 1., body->S, SUBSET_NONZERO_PATTERN)); /* nodes of an element are nodes of a cell */
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define ABUT_ALONG 1e-9 /* of the length of a segment: what is off an axis by less runs along it */

/* Whether a component of the displacement of a whole side is prescribed or resisted by springs */
PetscErrorCode AbutBodyHoldsSide_Private(AbutBody body, PetscInt side, PetscInt component, PetscBool *holds)
{
  const PetscReal *end;
  PetscReal        k[2];
  PetscInt         n;

  PetscFunctionBegin;
  *holds = (PetscBool)(body->condition[side][component].type == ABUT_DISPLACEMENT);
  if (*holds || !body->hooks) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutMeshGetSideSegments(body->mesh, side, &n, &end));
  PetscCall(AbutBodyGetFoundation(body, side, &k[0], &k[1]));
  *holds = (PetscBool)(k[0] > 0. || k[1] > 0.);
  for (PetscInt i = 0; i < n && !(k[0] > 0. && k[1] > 0.); ++i) { /* one stiffness holds what is along it, on all of the side */
    const PetscReal d = end[4 * i + 2 + !component] - end[4 * i + !component], e = end[4 * i + 2 + component] - end[4 * i + component];

    if (k[0] > 0. ? PetscAbsReal(e) > ABUT_ALONG * PetscAbsReal(d) : PetscAbsReal(d) > ABUT_ALONG * PetscAbsReal(e)) *holds = PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The sum of the forces of the springs on the body, and their work on its displacement, which is not above 0 */
PetscErrorCode AbutBodyGetFoundationForce_Private(AbutBody body, PetscReal force[2], PetscReal *work)
{
  Vec f;

  PetscFunctionBegin;
  force[0] = force[1] = *work = 0.;
  if (!body->S) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(body->load, &f));
  PetscCall(AbutBodyMult_Private(body, body->S, body->u, f));
  PetscCall(VecScale(f, -1.));
  PetscCall(VecDot(f, body->u, work));
  for (PetscInt d = 0; d < 2; ++d) PetscCall(VecStrideSum(f, d, &force[d]));
  PetscCall(VecDestroy(&f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* -C u at the nodes of each boundary element, where no displacement is prescribed */
PetscErrorCode AbutBodyAddFoundationTraction_Private(AbutBody body, AbutBoundary *b)
{
  PetscFunctionBegin;
  for (PetscInt e = 0; e < b->n && body->S; ++e) {
    PetscReal normal[2], k[2], C[4];

    (void)AbutElementNormal_Private(b->x + 2 * AbutBoundaryNode(b, e, 0), b->x + 2 * AbutBoundaryNode(b, e, b->order), normal);
    PetscCall(AbutBodyGetFoundation(body, b->side[e], &k[0], &k[1]));
    AbutSprings_Private(k, normal, C);
    for (PetscInt k = 0; k <= b->order; ++k) {
      const PetscReal *u = b->u + 2 * AbutBoundaryNode(b, e, k);
      PetscReal       *t = b->traction + 2 * ((b->order + 1) * e + k);

      for (PetscInt d = 0; d < 2; ++d)
        if (b->condition[2 * e + d] == ABUT_TRACTION) t[d] -= C[2 * d] * u[0] + C[2 * d + 1] * u[1];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyGetFoundation - The springs of a side

   Not Collective

   Input Parameters:
+  body - the body
-  side - number of the side

   Output Parameters:
+  normal     - k_n, stress over length, 0 if there are none
-  tangential - k_t, the same

   Level: advanced

.seealso: `AbutBodyAddFoundation()`
@*/
PetscErrorCode AbutBodyGetFoundation(AbutBody body, PetscInt side, PetscReal *normal, PetscReal *tangential)
{
  PetscFunctionBegin;
  *normal = *tangential = 0.;
  for (AbutHook h = body->hooks; h; h = h->next) {
    if (h->type != ABUT_HOOK_FOUNDATION || h->side != side) continue;
    *normal += h->stiffness[0];
    *tangential += h->stiffness[1];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
