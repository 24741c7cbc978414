/* FILE.h5 with the groups /cycle_0000/NAME, and FILE.xdmf which tells ParaView what they are (XDMF 2, xdmf.org) */
#include <abut/private/recorderimpl.h>
#include <petscviewerhdf5.h>
#include <string.h>

/* What stands between the name of the output and the extension of the HDF5 file of a load step: with one file for each, a run of many
   steps copies little */
static void NameStep(PetscInt step, char name[], size_t len)
{
  if (step) snprintf(name, len, "_step_%04" PetscInt_FMT, step);
  else name[0] = 0;
}

static PetscErrorCode AbutRecorderGetPath_XDMF(AbutRecorder rec, const char extension[], char path[], size_t len)
{
  char step[32];

  PetscFunctionBegin;
  NameStep(rec->step, step, sizeof(step));
  PetscCall(PetscSNPrintf(path, len, "%s%s%s", rec->output, step, extension));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first cycle, of a load step, starts a new file, later ones append to a copy; a file under its own name is complete at all times */
static PetscErrorCode AbutRecorderBeginCycle_XDMF(AbutRecorder rec)
{
  const MPI_Comm  comm = PetscObjectComm((PetscObject)rec);
  const PetscBool more = (PetscBool)(rec->nparts && rec->part[rec->nparts - 1].step == rec->step);
  char            path[PETSC_MAX_PATH_LEN], aside[PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  PetscCall(AbutRecorderGetPath_XDMF(rec, ".h5", path, sizeof(path)));
  PetscCall(AbutRecorderGetPath_XDMF(rec, ".h5.part", aside, sizeof(aside)));
  if (more) PetscCall(AbutFileCopyAside(comm, path));
  PetscCall(PetscViewerHDF5Open(comm, aside, more ? FILE_MODE_APPEND : FILE_MODE_WRITE, &rec->viewer));
  PetscCall(PetscViewerHDF5SetBaseDimension2(rec->viewer, PETSC_FALSE)); /* a scalar field is one-dimensional, whatever the options say */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows of three, with a zero: ParaView warps by three components only, and the newer of its readers takes datasets only as a whole, no
   functions or parts of them */
static PetscErrorCode AbutRecorderWriteDisplacement_XDMF(PetscViewer viewer, Vec u)
{
  PetscInt n;
  Vec      one, three;

  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(u, &n));
  PetscCall(AbutFieldsCreateVec_Private(PetscObjectComm((PetscObject)u), "displacement", 3, n / 2, PETSC_DETERMINE, &three));
  PetscCall(AbutFieldsCreateVec_Private(PetscObjectComm((PetscObject)u), "component", 1, n / 2, PETSC_DETERMINE, &one));
  for (PetscInt d = 0; d < 2; ++d) {
    PetscCall(VecStrideGather(u, d, one, INSERT_VALUES));
    PetscCall(VecStrideScatter(one, d, three, INSERT_VALUES));
  }
  PetscCall(VecView(three, viewer));
  PetscCall(VecDestroy(&one));
  PetscCall(VecDestroy(&three));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A dataset for each component, for the same reason */
static const char *const StressNames[] = {"s11", "s22", "s33", "s12"};

static PetscErrorCode AbutRecorderWriteStress_XDMF(PetscViewer viewer, Vec stress)
{
  PetscInt n;

  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(stress, &n));
  for (PetscInt j = 0; j < 4; ++j) {
    Vec one;

    PetscCall(AbutFieldsCreateVec_Private(PetscObjectComm((PetscObject)stress), StressNames[j], 1, n / 4, PETSC_DETERMINE, &one));
    PetscCall(VecStrideGather(stress, j, one, INSERT_VALUES));
    PetscCall(VecView(one, viewer));
    PetscCall(VecDestroy(&one));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutRecorderWritePart_XDMF(AbutRecorder rec, const AbutRecorderPart *part, const AbutFields *f)
{
  const Vec field[] = {f->vertices, f->von_mises, f->level, f->eta, f->pressure, f->gap, f->normal};
  char      group[PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(group, sizeof(group), "/cycle_%04" PetscInt_FMT "/%s", part->cycle, part->name));
  PetscCall(PetscViewerHDF5PushGroup(rec->viewer, group));
  PetscCall(ISView(f->cells, rec->viewer));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(field); ++i)
    if (field[i]) PetscCall(VecView(field[i], rec->viewer));
  if (f->displacement) PetscCall(AbutRecorderWriteDisplacement_XDMF(rec->viewer, f->displacement));
  if (f->stress) PetscCall(AbutRecorderWriteStress_XDMF(rec->viewer, f->stress));
  PetscCall(PetscViewerHDF5PopGroup(rec->viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the writers below need to name a dataset of an HDF5 file */
typedef struct {
  FILE                   *f;
  const char             *stem; /* of its file */
  const AbutRecorderPart *part;
} Writer;

/* <DataItem> of `n` rows of `m` numbers; a flat list for m = 1 */
static void WriteData(const Writer *w, const char name[], const char number[], PetscInt n, PetscInt m)
{
  char rows[64], step[32];

  if (m == 1) snprintf(rows, sizeof(rows), "%" PetscInt_FMT, n);
  else snprintf(rows, sizeof(rows), "%" PetscInt_FMT " %" PetscInt_FMT, n, m);
  NameStep(w->part->step, step, sizeof(step));
  fprintf(w->f, "<DataItem Dimensions=\"%s\" %s Format=\"HDF\">%s%s.h5:/cycle_%04" PetscInt_FMT "/%s/%s</DataItem>", rows, number, w->stem,
          step, w->part->cycle, w->part->name, name);
}

static void WriteField(const Writer *w, const char name[], const char centre[], PetscInt n, PetscInt m)
{
  fprintf(w->f, "          <Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"%s\">", name, m == 1 ? "Scalar" : "Vector", centre);
  WriteData(w, name, "NumberType=\"Float\" Precision=\"8\"", n, m);
  fprintf(w->f, "</Attribute>\n");
}

static void WriteBodyFields(const Writer *w)
{
  const PetscInt n = w->part->ncells;

  WriteField(w, "displacement", "Node", w->part->nvertices, 3);
  for (PetscInt j = 0; j < 4; ++j) WriteField(w, StressNames[j], "Cell", n, 1);
  WriteField(w, "von_mises", "Cell", n, 1);
  WriteField(w, "level", "Cell", n, 1);
  if (w->part->has_eta) WriteField(w, "eta", "Cell", n, 1);
}

static void WriteSideFields(const Writer *w)
{
  WriteField(w, "pressure", "Node", w->part->nvertices, 1);
  WriteField(w, "gap", "Node", w->part->nvertices, 1);
  WriteField(w, "normal_displacement", "Node", w->part->nvertices, 1);
}

/* Numbers of the whole grid */
static void WriteStep(const Writer *w)
{
  fprintf(w->f, "          <Attribute Name=\"step\" AttributeType=\"Scalar\" Center=\"Grid\">");
  fprintf(w->f, "<DataItem Dimensions=\"1\" NumberType=\"Int\" Format=\"XML\">%" PetscInt_FMT "</DataItem></Attribute>\n", w->part->step);
  fprintf(w->f, "          <Attribute Name=\"load_factor\" AttributeType=\"Scalar\" Center=\"Grid\">");
  fprintf(w->f, "<DataItem Dimensions=\"1\" NumberType=\"Float\" Precision=\"8\" Format=\"XML\">%.17g</DataItem></Attribute>\n",
          (double)w->part->factor);
}

static void WriteGrid(const Writer *w)
{
  const AbutRecorderPart *p      = w->part;
  const char *const       type[] = {"", "", "Polyline\" NodesPerElement=\"2", "Triangle", "Quadrilateral"};

  fprintf(w->f, "        <Grid Name=\"%s\" GridType=\"Uniform\">\n", p->name);
  fprintf(w->f, "          <Topology TopologyType=\"%s\" NumberOfElements=\"%" PetscInt_FMT "\">", type[p->corners], p->ncells);
  WriteData(w, "cells", "NumberType=\"Int\" Precision=\"4\"", p->ncells, p->corners);
  fprintf(w->f, "</Topology>\n          <Geometry GeometryType=\"XY\">");
  WriteData(w, "vertices", "NumberType=\"Float\" Precision=\"8\"", p->nvertices, 2);
  fprintf(w->f, "</Geometry>\n");
  if (p->corners == 2) WriteSideFields(w);
  else WriteBodyFields(w);
  if (p->step) WriteStep(w);
  fprintf(w->f, "        </Grid>\n");
}

static void WriteIndex(FILE *f, const void *ctx)
{
  const AbutRecorder rec   = (AbutRecorder)ctx;
  const char        *slash = strrchr(rec->output, '/');
  Writer             w     = {f, slash ? slash + 1 : rec->output, NULL};

  fprintf(f, "<?xml version=\"1.0\"?>\n<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n<Xdmf Version=\"2.0\">\n  <Domain>\n");
  fprintf(f, "    <Grid Name=\"cycles\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
  for (PetscInt i = 0; i < rec->nparts; ++i) {
    const PetscInt cycle = rec->part[i].cycle;

    if (!i || rec->part[i - 1].cycle != cycle) {
      fprintf(f, "      <Grid Name=\"cycle_%04" PetscInt_FMT "\" GridType=\"Collection\" CollectionType=\"Spatial\">\n", cycle);
      fprintf(f, "        <Time Value=\"%" PetscInt_FMT "\"/>\n", cycle);
    }
    w.part = &rec->part[i];
    WriteGrid(&w);
    if (i + 1 == rec->nparts || rec->part[i + 1].cycle != cycle) fprintf(f, "      </Grid>\n");
  }
  fprintf(f, "    </Grid>\n  </Domain>\n</Xdmf>\n");
}

static PetscErrorCode AbutRecorderEndCycle_XDMF(AbutRecorder rec)
{
  const MPI_Comm comm = PetscObjectComm((PetscObject)rec);
  char           path[PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  PetscCall(PetscViewerDestroy(&rec->viewer));
  PetscCall(AbutRecorderGetPath_XDMF(rec, ".h5", path, sizeof(path)));
  PetscCall(AbutFileRename(comm, path));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s.xdmf", rec->output));
  PetscCall(AbutFileWrite(comm, path, WriteIndex, rec));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutRecorderCreate_XDMF(AbutRecorder rec)
{
  PetscFunctionBegin;
  rec->ops->begincycle = AbutRecorderBeginCycle_XDMF;
  rec->ops->writepart  = AbutRecorderWritePart_XDMF;
  rec->ops->endcycle   = AbutRecorderEndCycle_XDMF;
  PetscFunctionReturn(PETSC_SUCCESS);
}
