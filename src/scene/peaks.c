#include <abut/private/sceneimpl.h>

/* The largest contact pressures, and the cells that are to resolve them whatever the energy says */

#define ABUT_PEAKS_MAX 256 /* elements of a pair; more wait for the next mesh */

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

    if (t->sideedge[3 * k + 2] != side || PetscSqr(b[0] - a[0]) + PetscSqr(b[1] - a[1]) < PetscSqr(enough)) continue;
    if (AbutSideTouches_Private(t, k, peak->x)) mark[t->sidecell[k]] = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks the cells of a body at the unresolved peaks of all its pairs */
PetscErrorCode AbutSceneMarkPeaks_Private(AbutScene scene, AbutBody body, PetscBool mark[])
{
  PetscReal tolerance;
  AbutPeak *peak;

  PetscFunctionBegin;
  PetscCall(AbutAdaptorGetPeak(scene->adaptor, &tolerance));
  if (tolerance <= 0.) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(ABUT_PEAKS_MAX, &peak));
  for (PetscInt i = 0; i < scene->npairs; ++i) {
    const PetscReal *p;
    AbutBody         bodies[2];
    PetscInt         sides[2], n;

    PetscCall(AbutPairGetBodies(scene->pair[i], bodies, sides));
    PetscCall(AbutInterfaceGetPressure(scene->iface, i, &p));
    PetscCall(AbutPairGetPeaks(scene->pair[i], p, tolerance, ABUT_PEAKS_MAX, &n, peak));
    for (PetscInt s = 0; s < 2; ++s)
      for (PetscInt k = 0; k < n && bodies[s] == body; ++k) PetscCall(AbutSceneMarkPeak_Private(body, sides[s], &peak[k], mark));
  }
  PetscCall(PetscFree(peak));
  PetscFunctionReturn(PETSC_SUCCESS);
}
