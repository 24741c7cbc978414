#include "fembemimpl.h"

static inline PetscComplex PointAt(const PetscReal x[], PetscInt i)
{
  return PetscCMPLX(x[2 * i], x[2 * i + 1]);
}

/* Takes over a boundary, which must outlive the copy; tractions that are not given are zero until recovered or solved for */
PetscErrorCode FembemBoundaryCreate(MPI_Comm comm, const AbutBoundary *given, PetscReal young, PetscReal poisson, FembemBoundary *b)
{
  PetscFunctionBegin;
  AbutCheckInput(poisson < 0.5, comm, "estimator_type: fembem needs a Poisson's ratio below 0.5, not %g; use zz", (double)poisson);
  b->comm      = comm;
  b->given     = given;
  b->order     = given->order;
  b->n         = given->n;
  b->nnodes    = given->nnodes;
  b->young     = young;
  b->mat.mu    = young / (2. * (1. + poisson));
  b->mat.kappa = 3. - 4. * poisson;
  b->next      = given->next;
  PetscCall(FembemBasisSet(b->order, &b->basis));
  PetscCall(PetscMalloc4(b->n, &b->previous, b->nnodes, &b->z, b->nnodes, &b->u, (b->order + 1) * b->n, &b->t));
  for (PetscInt i = 0; i < b->n; ++i) b->previous[b->next[i]] = i;
  for (PetscInt i = 0; i < b->nnodes; ++i) {
    b->z[i] = PointAt(given->x, i);
    b->u[i] = PointAt(given->u, i);
  }
  for (PetscInt i = 0; i < (b->order + 1) * b->n; ++i) b->t[i] = PointAt(given->traction, i);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes off the rigid motion mean + i*turn*(z - center) that is nearest to the displacement of the nodes. It has no stress, but the errors
   of quadrature and treecode would grow with it: a body that contact alone holds may lie far from where it was drawn. */
void FembemTakeOffRigidMotion(FembemBoundary *b)
{
  PetscComplex mean = 0., center = 0.;
  PetscReal    arms = 0., turn = 0.;

  for (PetscInt i = 0; i < b->nnodes; ++i) {
    mean += b->u[i] / b->nnodes;
    center += b->z[i] / b->nnodes;
  }
  for (PetscInt i = 0; i < b->nnodes; ++i) {
    const PetscComplex arm = PetscConjComplex(b->z[i] - center);

    arms += PetscSqr(PetscAbsComplex(arm));
    turn += PetscImaginaryPartComplex(arm * (b->u[i] - mean));
  }
  for (PetscInt i = 0; i < b->nnodes; ++i) b->u[i] -= mean + turn / arms * PETSC_i * (b->z[i] - center);
}

PetscErrorCode FembemBoundaryDestroy(FembemBoundary *b)
{
  PetscFunctionBegin;
  PetscCall(PetscFree4(b->previous, b->z, b->u, b->t));
  PetscFunctionReturn(PETSC_SUCCESS);
}
