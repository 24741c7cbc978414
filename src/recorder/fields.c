#include <abut/private/recorderimpl.h> /*I "abutrecorder.h" I*/

/* A vector of `n` rows of `bs` numbers over all ranks, of which `local` (or PETSC_DECIDE) are here */
PetscErrorCode AbutFieldsCreateVec_Private(MPI_Comm comm, const char name[], PetscInt bs, PetscInt local, PetscInt n, Vec *v)
{
  PetscFunctionBegin;
  if (local == PETSC_DECIDE) PetscCall(PetscSplitOwnership(comm, &local, &n));
  PetscCall(VecCreate(comm, v));
  PetscCall(VecSetSizes(*v, bs * local, PETSC_DETERMINE));
  PetscCall(VecSetBlockSize(*v, bs));
  PetscCall(VecSetType(*v, VECSTANDARD));
  PetscCall(PetscObjectSetName((PetscObject)*v, name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows of the local vertices: those with unknowns in the order of their global numbers, then the hanging ones of all ranks. Vertices come
   first among the nodes of each rank, so the rank that owns a node, and how many vertices the ranks before it have, give the row. */
static PetscErrorCode AbutFieldsNumberVertices_Private(MPI_Comm comm, const AbutMeshTopology *t, PetscInt number[], PetscInt *nvertices)
{
  PetscInt    own[2] = {t->firstowned, 0}, hanging = 0, next, all, *first;
  PetscMPIInt size;

  PetscFunctionBegin;
  for (PetscInt v = 0; v < t->nvertices; ++v) {
    hanging += t->unknown[v] < 0;
    own[1] += t->unknown[v] >= 0 && t->unknown[v] < t->nowned;
  }
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMalloc1(2 * size, &first)); /* of each rank: its first node, its vertices and then those before it */
  PetscCallMPI(MPI_Allgather(own, 2, MPIU_INT, first, 2, MPIU_INT, comm));
  next = 0;
  for (PetscMPIInt r = 0; r < size; ++r) {
    const PetscInt vertices = first[2 * r + 1];

    first[2 * r + 1] = next;
    next += vertices;
  }
  *nvertices = next;
  PetscCallMPI(MPI_Scan(&hanging, &next, 1, MPIU_INT, MPI_SUM, comm));
  PetscCallMPI(MPI_Allreduce(&hanging, &all, 1, MPIU_INT, MPI_SUM, comm));
  next += *nvertices - hanging;
  *nvertices += all;
  for (PetscInt v = 0; v < t->nvertices; ++v) {
    PetscMPIInt owner = size - 1;

    if (t->unknown[v] < 0) {
      number[v] = next++;
      continue;
    }
    while (first[2 * owner] > t->global[t->unknown[v]]) --owner;
    number[v] = t->global[t->unknown[v]] - first[2 * owner] + first[2 * owner + 1];
  }
  PetscCall(PetscFree(first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A field of the vertices, each row given by the rank that owns the vertex; hanging ones by every rank that has them */
static PetscErrorCode AbutFieldsCreateVertexVec_Private(MPI_Comm comm, const char name[], const AbutMeshTopology *t,
                                                        const PetscInt number[], PetscInt n, const PetscReal values[], Vec *v)
{
  PetscFunctionBegin;
  PetscCall(AbutFieldsCreateVec_Private(comm, name, 2, PETSC_DECIDE, n, v));
  for (PetscInt i = 0; i < t->nvertices; ++i) {
    if (t->unknown[i] < t->nowned) PetscCall(VecSetValuesBlocked(*v, 1, &number[i], &values[2 * i], INSERT_VALUES));
  }
  PetscCall(VecAssemblyBegin(*v));
  PetscCall(VecAssemblyEnd(*v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutFieldsCreateCells_Private(MPI_Comm comm, const AbutMeshTopology *t, const PetscInt number[], IS *cells)
{
  const PetscInt n = t->corners * t->ncells;
  PetscInt      *corner;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &corner));
  for (PetscInt i = 0; i < n; ++i) corner[i] = number[t->cell[i]];
  PetscCall(ISCreateGeneral(comm, n, corner, PETSC_OWN_POINTER, cells));
  PetscCall(ISSetBlockSize(*cells, t->corners));
  PetscCall(PetscObjectSetName((PetscObject)*cells, "cells"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stress at the centre of each cell */
static PetscErrorCode AbutFieldsCreateStress_Private(MPI_Comm comm, AbutBody body, const AbutMeshTopology *t, Vec *stress, Vec *von_mises)
{
  const PetscReal centre[2][2] = {
    {1. / 3., 1. / 3.},
    {0.,      0.     }
  };
  PetscReal    N[ABUT_CELL_NODES_MAX], dN[2 * ABUT_CELL_NODES_MAX], s[4];
  AbutMesh     mesh;
  PetscScalar *row, *vm;

  PetscFunctionBegin;
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshEvaluateBasis(mesh, centre[t->corners == 4], N, dN));
  PetscCall(AbutFieldsCreateVec_Private(comm, "stress", 4, t->ncells, PETSC_DETERMINE, stress));
  PetscCall(AbutFieldsCreateVec_Private(comm, "von_mises", 1, t->ncells, PETSC_DETERMINE, von_mises));
  PetscCall(VecGetArrayWrite(*stress, &row));
  PetscCall(VecGetArrayWrite(*von_mises, &vm));
  for (PetscInt c = 0; c < t->ncells; ++c) {
    PetscCall(AbutBodyGetCellStresses3D(body, c, 1, centre[t->corners == 4], dN, s, s + 3));
    row[4 * c]     = s[0];
    row[4 * c + 1] = s[1];
    row[4 * c + 2] = s[3];
    row[4 * c + 3] = s[2];
    PetscCall(AbutVonMises(s, &vm[c]));
  }
  PetscCall(VecRestoreArrayWrite(*stress, &row));
  PetscCall(VecRestoreArrayWrite(*von_mises, &vm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutFieldsCreateLevel_Private(MPI_Comm comm, const AbutMeshTopology *t, Vec *level)
{
  PetscScalar *l;

  PetscFunctionBegin;
  PetscCall(AbutFieldsCreateVec_Private(comm, "level", 1, t->ncells, PETSC_DETERMINE, level));
  PetscCall(VecGetArrayWrite(*level, &l));
  for (PetscInt c = 0; c < t->ncells; ++c) l[c] = t->level[c];
  PetscCall(VecRestoreArrayWrite(*level, &l));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Collects the fields of a solved body; `eta` (one number per cell) may be NULL */
PetscErrorCode AbutFieldsCreate_Private(AbutBody body, Vec eta, AbutFields *f)
{
  const MPI_Comm          comm = PetscObjectComm((PetscObject)body);
  AbutMesh                mesh;
  const AbutMeshTopology *t;
  const PetscReal        *u;
  PetscInt               *number;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(f, sizeof(*f)));
  PetscCall(AbutBodyGetMesh(body, &mesh));
  PetscCall(AbutMeshGetTopology(mesh, &t));
  PetscCall(AbutMeshGetCellCount(mesh, &f->ncells));
  PetscCall(AbutBodyGetNodeDisplacement(body, &u));
  f->corners = t->corners;
  PetscCall(PetscMalloc1(t->nvertices, &number));
  PetscCall(AbutFieldsNumberVertices_Private(comm, t, number, &f->nvertices));
  PetscCall(AbutFieldsCreateVertexVec_Private(comm, "vertices", t, number, f->nvertices, t->x, &f->vertices));
  PetscCall(AbutFieldsCreateVertexVec_Private(comm, "displacement", t, number, f->nvertices, u, &f->displacement));
  PetscCall(AbutFieldsCreateCells_Private(comm, t, number, &f->cells));
  PetscCall(PetscFree(number));
  PetscCall(AbutFieldsCreateStress_Private(comm, body, t, &f->stress, &f->von_mises));
  PetscCall(AbutFieldsCreateLevel_Private(comm, t, &f->level));
  if (eta) {
    PetscCall(AbutFieldsCreateVec_Private(comm, "eta", 1, t->ncells, PETSC_DETERMINE, &f->eta));
    PetscCall(VecCopy(eta, f->eta));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutFieldsDestroy_Private(AbutFields *f)
{
  PetscFunctionBegin;
  PetscCall(VecDestroy(&f->vertices));
  PetscCall(VecDestroy(&f->displacement));
  PetscCall(ISDestroy(&f->cells));
  PetscCall(VecDestroy(&f->stress));
  PetscCall(VecDestroy(&f->von_mises));
  PetscCall(VecDestroy(&f->level));
  PetscCall(VecDestroy(&f->eta));
  PetscCall(VecDestroy(&f->pressure));
  PetscCall(VecDestroy(&f->gap));
  PetscCall(VecDestroy(&f->normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes one body or side of one cycle, and adds it to what the index file lists */
static PetscErrorCode AbutRecorderWritePart_Private(AbutRecorder rec, PetscInt cycle, const char name[], AbutFields *f)
{
  AbutRecorderPart *part;

  PetscFunctionBegin;
  if (rec->nparts == rec->maxparts) {
    rec->maxparts = 2 * rec->maxparts + 16;
    PetscCall(PetscRealloc(sizeof(AbutRecorderPart) * rec->maxparts, &rec->part));
  }
  part = &rec->part[rec->nparts++];
  PetscCall(PetscStrallocpy(name, &part->name));
  part->cycle     = cycle;
  part->step      = rec->step;
  part->factor    = rec->factor;
  part->nvertices = f->nvertices;
  part->ncells    = f->ncells;
  part->corners   = f->corners;
  part->has_eta   = f->eta ? PETSC_TRUE : PETSC_FALSE;
  PetscUseTypeMethod(rec, writepart, part, f);
  PetscCall(AbutFieldsDestroy_Private(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutRecorderWantsFields - Whether `-output` asks for fields

   Not Collective

   Input Parameter:
.  rec - the recorder

   Output Parameter:
.  wants - `PETSC_TRUE` if `AbutRecorderWriteFields()` will write

   Level: intermediate

.seealso: `AbutRecorderWriteFields()`
@*/
PetscErrorCode AbutRecorderWantsFields(AbutRecorder rec, PetscBool *wants)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(rec, ABUTRECORDER_CLASSID, 1);
  *wants = rec->output ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutRecorderWriteFields - Writes the fields of all bodies and pairs in one cycle, beside those of earlier cycles: a series in time

   Collective

   Input Parameters:
+  rec     - the recorder
.  cycle   - number of the cycle from 0, larger than that of the last call
.  nbodies - how many bodies
.  bodies  - [nbodies] the bodies after a solve, all on the communicator of the recorder
-  eta     - [nbodies] one number per cell (`AbutBodyCreateCellVec()`), or `NULL` for a body without; the array may be `NULL` too

   Options Database Key:
.  -output FILE.xdmf|FILE.vtu - where; without it nothing is done

   Level: intermediate

   Notes:
   The time of the series is the number of the cycle from 0, through all load steps; every time has meshes of its own. With
   `AbutRecorderSetStep()` every grid also has `step` and `load_factor` as field data.

   A body is a grid of its name. Per vertex it has the coordinates and the displacement (length unit of the scene), with a third component
   of zero; per cell the stress s11, s22, s33, s12 and its von Mises value at the centre (stress unit), the refinement level, and eta.
   Vertices with unknowns come in the order of their global numbers, hanging vertices follow. Of displacements of higher order the values
   at the vertices are written.

   A pair of `AbutRecorderSetPairs()` is a polyline of its name along the side that carries the pressures, through all its nodes, where they
   were before anything moved. At the nodes it has the contact `pressure` as the record reads it (`AbutPairState`): nodal, or from order 2
   the consistent one, which may be largest between nodes; the `gap` that was given, and the `normal_displacement` of this side along its
   outward normal.

   Behind an .xdmf is an HDF5 file with the groups `/cycle_0000/NAME`, written by all ranks together, and one for every load step,
   FILE_step_0001.h5. From its second cycle on it is copied before more is appended, so that a crash leaves all earlier cycles readable; n
   cycles copy about n/2 times the final size. A .vtu is gathered on rank 0 and is text: for meshes that fit there; pairs are
   .vtp. All are listed in the index, .xdmf or .pvd, which is replaced when all its files are there.

.seealso: `AbutRecorderWantsFields()`, `AbutRecorderSetPairs()`, `AbutRecorderSetStep()`, `AbutRecorderWriteProfile()`,
          `AbutRecorderSetFromOptions()`
@*/
PetscErrorCode AbutRecorderWriteFields(AbutRecorder rec, PetscInt cycle, PetscInt nbodies, AbutBody bodies[], Vec eta[])
{
  const MPI_Comm comm = PetscObjectComm((PetscObject)rec);
  const char    *name;
  AbutFields     f;
  PetscMPIInt    same;

  PetscFunctionBegin;
  PetscValidHeaderSpecific(rec, ABUTRECORDER_CLASSID, 1);
  if (!rec->output) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(!rec->nparts || cycle > rec->part[rec->nparts - 1].cycle, comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Fields of cycle %" PetscInt_FMT " after those of cycle %" PetscInt_FMT, cycle, rec->part[rec->nparts - 1].cycle);
  PetscCall(PetscLogEventBegin(ABUTRECORDER_WriteFields, rec, 0, 0, 0));
  PetscTryTypeMethod(rec, begincycle);
  for (PetscInt i = 0; i < nbodies; ++i) {
    PetscCallMPI(MPI_Comm_compare(comm, PetscObjectComm((PetscObject)bodies[i]), &same));
    PetscCheck(same == MPI_IDENT || same == MPI_CONGRUENT, comm, PETSC_ERR_ARG_NOTSAMECOMM,
               "A body is not on the communicator of the recorder");
    PetscCall(AbutFieldsCreate_Private(bodies[i], eta ? eta[i] : NULL, &f));
    PetscCall(AbutBodyGetName(bodies[i], &name));
    PetscCall(AbutRecorderWritePart_Private(rec, cycle, name, &f));
  }
  for (PetscInt i = 0; i < rec->npairs; ++i) {
    PetscCall(AbutFieldsCreateSide_Private(rec->iface, i, rec->pair[i], &f));
    PetscCall(AbutPairGetName(rec->pair[i], &name));
    PetscCall(AbutRecorderWritePart_Private(rec, cycle, name, &f));
  }
  PetscUseTypeMethod(rec, endcycle);
  PetscCall(PetscLogEventEnd(ABUTRECORDER_WriteFields, rec, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
