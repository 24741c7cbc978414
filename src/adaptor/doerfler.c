#include <abut/private/adaptorimpl.h>

/* Doerfler: the smallest set of cells, of all bodies together, that holds a given part of the square of the whole error, after W. Doerfler,
   A convergent adaptive algorithm for Poisson's equation, SIAM J. Numer. Anal. 33 (1996), eq. (4.1); done when the whole error is at most
   the target. A small part gives the fewest unknowns in many cycles, a large one few cycles.
   Limits: cells at -adaptor_max_level count in the set, so that it ends when such cells hold the part. */
typedef struct {
  PetscReal bulk;
} AbutAdaptor_Doerfler;

#define ABUT_OCTAVES 100   /* factors of two below the largest square within which the bound is sought: what is smaller holds nothing */
#define ABUT_BISECT  1e-7  /* relative width at which the bound is known */
#define ABUT_TIE     1e-3  /* cells that differ by less, relative, go together: mirror images differ by what loop and treecode leave */
#define ABUT_SLACK   1e-10 /* of the sum: does not depend on its order */

/* The largest bound such that the cells not below it hold the part */
static PetscErrorCode AbutAdaptorShare_Doerfler(AbutAdaptor adaptor, const AbutCellErrors *errors, PETSC_UNUSED PetscReal target2,
                                                PetscReal *square)
{
  const PetscReal goal = (((const AbutAdaptor_Doerfler *)adaptor->data)->bulk - ABUT_SLACK) * errors->sum;
  PetscReal       low = errors->largest * PetscPowReal(2., -ABUT_OCTAVES), high = errors->largest;

  PetscFunctionBegin;
  high *= 1. + ABUT_BISECT;
  while (high > low * (1. + ABUT_BISECT)) {
    const PetscReal middle = low * PetscSqrtReal(high / low);
    PetscReal       held   = 0.;

    for (PetscInt c = 0; c < errors->n; ++c)
      if (errors->square[c] >= middle) held += errors->square[c];
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &held, 1, MPIU_REAL, MPIU_SUM, PetscObjectComm((PetscObject)adaptor)));
    if (held >= goal) low = middle;
    else high = middle;
  }
  *square = low * (1. - ABUT_TIE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutAdaptorSetFromOptions_Doerfler(AbutAdaptor adaptor, AbutOptionItems PetscOptionsObject)
{
  AbutAdaptor_Doerfler *d = (AbutAdaptor_Doerfler *)adaptor->data;

  PetscFunctionBegin;
  PetscCall(AbutAdaptorTargetFromOptions_Private(adaptor, PetscOptionsObject));
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-adaptor_bulk", "part of the square of the error that the refined cells hold", &d->bulk,
                            NULL));
  AbutCheckInput(d->bulk > 0. && d->bulk <= 1., PetscObjectComm((PetscObject)adaptor),
                 "adaptor_bulk: %g is not a part; give a number above 0 and at most 1, for example 0.5", (double)d->bulk);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutAdaptorView_Doerfler(AbutAdaptor adaptor, PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "refines the cells that hold %g of the square of the error, until it is at most %g\n",
                                   (double)((AbutAdaptor_Doerfler *)adaptor->data)->bulk, (double)adaptor->target));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutAdaptorDestroy_Doerfler(AbutAdaptor adaptor)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(adaptor->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutAdaptorCreate_Doerfler(AbutAdaptor adaptor)
{
  AbutAdaptor_Doerfler *d;

  PetscFunctionBegin;
  PetscCall(PetscNew(&d));
  d->bulk                      = 0.5;
  adaptor->data                = d;
  adaptor->ops->mark           = AbutAdaptorMarkAllowance_Private;
  adaptor->ops->share          = AbutAdaptorShare_Doerfler;
  adaptor->ops->setfromoptions = AbutAdaptorSetFromOptions_Doerfler;
  adaptor->ops->view           = AbutAdaptorView_Doerfler;
  adaptor->ops->destroy        = AbutAdaptorDestroy_Doerfler;
  adaptor->ops->about          = "the fewest cells that hold a part of the error, until the whole is at the target";
  PetscFunctionReturn(PETSC_SUCCESS);
}
