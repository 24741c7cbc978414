#include <abut/private/recorderimpl.h> /*I "abutrecorder.h" I*/

/* The side of a pair that carries its pressures, as a polyline with fields at its nodes: the same on all ranks, written by the first */

static PetscErrorCode AbutSideFieldCreate_Private(MPI_Comm comm, const char name[], PetscInt bs, PetscInt n, const PetscReal value[],
                                                  Vec *v)
{
  PetscMPIInt  rank;
  PetscScalar *a;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(AbutFieldsCreateVec_Private(comm, name, bs, rank ? 0 : n, PETSC_DETERMINE, v));
  PetscCall(VecGetArrayWrite(*v, &a));
  for (PetscInt i = 0; i < (rank ? 0 : bs * n); ++i) a[i] = value[i];
  PetscCall(VecRestoreArrayWrite(*v, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lines between neighbouring nodes */
static PetscErrorCode AbutSideLinesCreate_Private(MPI_Comm comm, PetscInt n, IS *lines)
{
  PetscMPIInt rank;
  PetscInt   *end;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscMalloc1(2 * (n - 1), &end));
  for (PetscInt i = 0; i < 2 * (n - 1); ++i) end[i] = (i + 1) / 2;
  PetscCall(ISCreateGeneral(comm, rank ? 0 : 2 * (n - 1), end, PETSC_COPY_VALUES, lines));
  PetscCall(PetscFree(end));
  PetscCall(ISSetBlockSize(*lines, 2));
  PetscCall(PetscObjectSetName((PetscObject)*lines, "cells"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pressure at the nodes as the record reads it */
static PetscErrorCode AbutSidePressure_Private(AbutInterface iface, PetscInt i, AbutPair pair, PetscInt n, PetscReal p[])
{
  const PetscReal *nodal;
  AbutPairState    state;

  PetscFunctionBegin;
  PetscCall(AbutInterfaceGetPressure(iface, i, &nodal));
  PetscCall(AbutInterfaceGetPairState(iface, i, &state));
  if (state.consistent) PetscCall(AbutPairRecoverPressure(pair, nodal, p));
  else PetscCall(PetscArraycpy(p, nodal, n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The displacement along the outward normal at the nodes of the pressure side */
static PetscErrorCode AbutSideNormalDisplacement_Private(AbutInterface iface, PetscInt i, AbutPair pair, PetscInt which, PetscReal un[])
{
  const PetscReal *trace;
  const AbutSide  *side;
  AbutBody         body[2];
  PetscInt         number[2], components;

  PetscFunctionBegin;
  PetscCall(AbutInterfaceGetTrace(iface, i, which, &trace));
  PetscCall(AbutPairGetComponents(pair, &components));
  PetscCall(AbutPairGetBodies(pair, body, number));
  PetscCall(AbutBodyGetSide(body[which], number[which], &side));
  for (PetscInt k = 0; k < side->n; ++k) {
    PetscReal normal[2];

    PetscCall(AbutSideGetNodeNormal(side, k, normal));
    un[k] = components == 1 ? trace[k] : trace[2 * k] * normal[0] + trace[2 * k + 1] * normal[1];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Pair `i` of the interface, after a sweep */
PetscErrorCode AbutFieldsCreateSide_Private(AbutInterface iface, PetscInt i, AbutPair pair, AbutFields *f)
{
  const MPI_Comm   comm = PetscObjectComm((PetscObject)iface);
  PetscInt         which, n;
  const PetscReal *x, *length;
  PetscReal       *p, *gap, *un;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(f, sizeof(*f)));
  PetscCall(AbutPairGetPressureNodes(pair, &which, &n, &x, &length));
  PetscCall(PetscMalloc3(n, &p, n, &gap, n, &un));
  PetscCall(AbutSideNormalDisplacement_Private(iface, i, pair, which, un));
  PetscCall(AbutSidePressure_Private(iface, i, pair, n, p));
  for (PetscInt k = 0; k < n; ++k) PetscCall(AbutPairGetNodeGap(pair, k, &gap[k]));
  f->corners   = 2;
  f->nvertices = n;
  f->ncells    = n - 1;
  PetscCall(AbutSideFieldCreate_Private(comm, "vertices", 2, n, x, &f->vertices));
  PetscCall(AbutSideLinesCreate_Private(comm, n, &f->cells));
  PetscCall(AbutSideFieldCreate_Private(comm, "pressure", 1, n, p, &f->pressure));
  PetscCall(AbutSideFieldCreate_Private(comm, "gap", 1, n, gap, &f->gap));
  PetscCall(AbutSideFieldCreate_Private(comm, "normal_displacement", 1, n, un, &f->normal));
  PetscCall(PetscFree3(p, gap, un));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutRecorderSetPairs - Has the pairs written, too, wherever fields are

   Logically Collective

   Input Parameters:
+  rec    - the recorder
.  iface  - the interface, in its state after a sweep whenever `AbutRecorderWriteFields()` is called
.  npairs - how many pairs
-  pairs  - [npairs] the pairs, as given to `AbutInterfaceCreate()`; the array is not copied

   Level: intermediate

   Note:
   Neither interface nor pairs are referenced: they are to live as long as fields are written.

.seealso: `AbutRecorderWriteFields()`, `AbutRecorderWriteProfile()`
@*/
PetscErrorCode AbutRecorderSetPairs(AbutRecorder rec, AbutInterface iface, PetscInt npairs, AbutPair pairs[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(rec, ABUTRECORDER_CLASSID, 1);
  rec->iface  = iface;
  rec->npairs = npairs;
  rec->pair   = pairs;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutRecorderSetStep - Says to which load step belongs what is written from now on

   Logically Collective

   Input Parameters:
+  rec    - the recorder
.  step   - number of the step from 1; 0, as in a new recorder, for a run without steps
-  factor - the load factor

   Level: intermediate

   Note:
   Fields then have `step` and `load_factor`, and there is a file of HDF5 and a profile for every step.

.seealso: `AbutRecorderWriteFields()`, `AbutRecorderWriteProfile()`, `AbutBodySetLoadFactor()`
@*/
PetscErrorCode AbutRecorderSetStep(AbutRecorder rec, PetscInt step, PetscReal factor)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(rec, ABUTRECORDER_CLASSID, 1);
  rec->step   = step;
  rec->factor = factor;
  PetscFunctionReturn(PETSC_SUCCESS);
}
