#include <abut/private/adaptorimpl.h> /*I "abutadaptor.h" I*/

/* Equal: every cell is to have the same part of the error, after O. C. Zienkiewicz and J. Z. Zhu, A simple error estimator and adaptive
   procedure for practical engineering analysis, Int. J. Numer. Meth. Engng. 24 (1987): done when the total error is at most the target;
   until then the cells with more than their part, target/sqrt(cells), are refined. Of these only the worst: what is better than the worst
   will be after a refinement can wait, and so can what is not needed for the target if a refined cell keeps half of its error. It is the
   total error that counts, so unlike a threshold on the pointwise indicator it ends at a singularity.
   Limits: the half is right where the stress is smooth, elsewhere it takes a cycle more. */
#define ABUT_BINS   400
#define ABUT_OCTAVE 8    /* bins for a factor of two in the square of the error */
#define ABUT_KEPT   0.25 /* part of the square of a cell's error that its children have together; a child has the square of it */
#define ABUT_GOAL   0.9  /* of the target: to meet it with the next mesh, not almost */

/* The cells are sorted by size: bin k has those below the largest by k/ABUT_OCTAVE to (k+1)/ABUT_OCTAVE factors of two */
static PetscErrorCode AbutAdaptorShare_Equal(AbutAdaptor adaptor, const AbutCellErrors *errors, PetscReal target2, PetscReal *square)
{
  PetscReal bin[ABUT_BINS] = {0.}, left = errors->sum;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < errors->n; ++c)
    if (errors->square[c] > 0.)
      bin[(PetscInt)PetscMin(ABUT_BINS - 1., ABUT_OCTAVE * PetscLog2Real(errors->largest / errors->square[c]))] += errors->square[c];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, bin, ABUT_BINS, MPIU_REAL, MPIU_SUM, PetscObjectComm((PetscObject)adaptor)));
  *square = 0.;
  for (PetscInt k = 0; k < ABUT_BINS && left > PetscSqr(ABUT_GOAL) * target2; ++k) {
    left -= (1. - ABUT_KEPT) * bin[k];
    *square = k < ABUT_BINS - 1 ? errors->largest * PetscPowReal(2., -(k + 1.) / ABUT_OCTAVE) : 0.;
  }
  *square = PetscMax(*square, PetscSqr(ABUT_KEPT) * errors->largest);
  *square = PetscMax(*square, target2 / errors->cells);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutAdaptorView_Equal(AbutAdaptor adaptor, PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "equal error in all cells, until all together have at most %g\n", (double)adaptor->target));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutAdaptorCreate_Equal(AbutAdaptor adaptor)
{
  PetscFunctionBegin;
  adaptor->ops->mark           = AbutAdaptorMarkAllowance_Private;
  adaptor->ops->share          = AbutAdaptorShare_Equal;
  adaptor->ops->setfromoptions = AbutAdaptorTargetFromOptions_Private;
  adaptor->ops->view           = AbutAdaptorView_Equal;
  adaptor->ops->about          = "cells with more than their share of the error, until the whole is at the target";
  PetscFunctionReturn(PETSC_SUCCESS);
}
