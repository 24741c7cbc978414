#include <abut/private/adaptorimpl.h>

/* Threshold: every cell whose indicator is above delta, eq. (27) of the paper.
   Limits: it asks for a pointwise accuracy, so at a singularity of the stress it never ends by itself (the indicator there grows with every
   level): -adaptor_max_level ends it. */
typedef struct {
  PetscReal delta;
} AbutAdaptor_Threshold;

static PetscErrorCode AbutAdaptorMark_Threshold(AbutAdaptor adaptor, PETSC_UNUSED AbutBody body, PetscInt n, const PetscReal eta[],
                                                PetscBool mark[])
{
  const AbutAdaptor_Threshold *th = (const AbutAdaptor_Threshold *)adaptor->data;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < n; ++c) mark[c] = eta[c] > th->delta ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutAdaptorSetFromOptions_Threshold(AbutAdaptor adaptor, AbutOptionItems PetscOptionsObject)
{
  AbutAdaptor_Threshold *th = (AbutAdaptor_Threshold *)adaptor->data;

  PetscFunctionBegin;
  PetscCall(AbutOptionsReal(PetscOptionsObject, "-adaptor_threshold", "refine cells whose indicator is above this, delta of eq. (27)",
                            &th->delta, NULL));
  AbutCheckInput(th->delta > 0., PetscObjectComm((PetscObject)adaptor),
                 "adaptor_threshold: %g is not above 0; give the indicator that is small enough, for example 0.1", (double)th->delta);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutAdaptorView_Threshold(AbutAdaptor adaptor, PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "refines cells above %g\n", (double)((AbutAdaptor_Threshold *)adaptor->data)->delta));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutAdaptorDestroy_Threshold(AbutAdaptor adaptor)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(adaptor->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutAdaptorCreate_Threshold(AbutAdaptor adaptor)
{
  AbutAdaptor_Threshold *th;

  PetscFunctionBegin;
  PetscCall(PetscNew(&th));
  th->delta                    = 0.1;
  adaptor->data                = th;
  adaptor->ops->mark           = AbutAdaptorMark_Threshold;
  adaptor->ops->setfromoptions = AbutAdaptorSetFromOptions_Threshold;
  adaptor->ops->view           = AbutAdaptorView_Threshold;
  adaptor->ops->destroy        = AbutAdaptorDestroy_Threshold;
  adaptor->ops->about          = "cells whose indicator is above delta, eq. (27) of the paper";
  PetscFunctionReturn(PETSC_SUCCESS);
}
