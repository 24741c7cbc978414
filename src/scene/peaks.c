#include <abut/private/sceneimpl.h>

/* The largest contact pressures, and the cells that are to resolve them whatever the energy says */

#define ABUT_PEAK_NOISE 30. /* times the residual of the loop */

/* Marks the cells of the body's side that touch a peak, unless they are shorter than the element that does not resolve it */
static PetscErrorCode AbutSceneMarkPeak_Private(AbutBody body, PetscInt side, const AbutPeak *peak, PetscBool mark[])
{
  const AbutMeshTopology *t;
  AbutMesh                mesh;
  const PetscReal         enough = peak->length * (1. - ABUT_TOUCH);

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  for (PetscInt k = 0; k < t->nsideedges; ++k) {
    const PetscReal *a = t->x + 2 * t->sideedge[3 * k], *b = t->x + 2 * t->sideedge[3 * k + 1];
    PetscBool        touches;

    if (t->sideedge[3 * k + 2] != side || PetscSqr(b[0] - a[0]) + PetscSqr(b[1] - a[1]) < PetscSqr(enough)) continue;
    PetscCall(AbutSideTouches_Private(mesh, k, peak->x, &touches));
    if (touches) mark[t->sidecell[k]] = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks the cells of a body at the unresolved peaks of all its pairs. What a loop leaves shows on small elements as a pressure of its own:
   up to 3 times its residual over their part of the contact (measured, orders 2 to 4); less than ten times that is no reason to refine. */
PetscErrorCode AbutSceneMarkPeaks_Private(AbutScene scene, AbutBody body, PetscBool mark[])
{
  PetscReal     tolerance, residual, pressure;
  PetscLogEvent event;

  PetscFunctionBegin;
  PetscCall(AbutAdaptorGetPeak(scene->adaptor, &tolerance));
  if (tolerance <= 0. || !scene->npairs) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutLogEventGet("AbutPeak", ABUTSCENE_CLASSID, &event));
  PetscCall(PetscLogEventBegin(event, scene, 0, 0, 0));
  PetscCall(AbutInterfaceGetResidual(scene->iface, &residual, &pressure));
  for (PetscInt i = 0; i < scene->npairs; ++i) {
    const PetscReal *p;
    AbutPeak        *peak;
    AbutBody         bodies[2];
    PetscInt         sides[2], nodes[2], n;

    PetscCall(AbutPairGetBodies(scene->pair[i], bodies, sides));
    if (bodies[0] != body && bodies[1] != body) continue;
    PetscCall(AbutPairGetSizes(scene->pair[i], nodes));
    PetscCall(PetscMalloc1(PetscMax(nodes[0], nodes[1]), &peak));
    PetscCall(AbutInterfaceGetPressure(scene->iface, i, &p));
    PetscCall(AbutPairGetPeaks(scene->pair[i], p, tolerance, PetscMax(nodes[0], nodes[1]), &n, peak));
    for (PetscInt k = 0; k < n; ++k) {
      if (peak[k].last <= ABUT_PEAK_NOISE * residual / peak[k].part) continue;
      for (PetscInt side = 0; side < 2; ++side)
        if (bodies[side] == body) PetscCall(AbutSceneMarkPeak_Private(body, sides[side], &peak[k], mark));
    }
    PetscCall(PetscFree(peak));
  }
  PetscCall(PetscLogEventEnd(event, scene, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
