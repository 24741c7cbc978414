/* FILE.h5 with the groups /cycle_0000/BODY, and FILE.xdmf which tells ParaView what they are (XDMF 2, xdmf.org) */
#include <abut/private/recorderimpl.h>
#include <petscviewerhdf5.h>
#include <string.h>

static PetscErrorCode AbutRecorderGetPath_XDMF(AbutRecorder rec, const char extension[], char path[], size_t len)
{
  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(path, len, "%s%s", rec->output, extension));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first cycle starts a new file, later ones append to a copy; the file under its own name is complete at all times */
static PetscErrorCode AbutRecorderBeginCycle_XDMF(AbutRecorder rec)
{
  const MPI_Comm comm = PetscObjectComm((PetscObject)rec);
  char           path[PETSC_MAX_PATH_LEN], aside[PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  PetscCall(AbutRecorderGetPath_XDMF(rec, ".h5", path, sizeof(path)));
  PetscCall(AbutRecorderGetPath_XDMF(rec, ".h5.part", aside, sizeof(aside)));
  if (rec->nparts) PetscCall(AbutFileCopyAside(comm, path));
  PetscCall(PetscViewerHDF5Open(comm, aside, rec->nparts ? FILE_MODE_APPEND : FILE_MODE_WRITE, &rec->viewer));
  PetscCall(PetscViewerHDF5SetBaseDimension2(rec->viewer, PETSC_FALSE)); /* a scalar field is one-dimensional, whatever the options say */
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutRecorderWritePart_XDMF(AbutRecorder rec, const AbutRecorderPart *part, const AbutFields *f)
{
  const Vec field[] = {f->vertices, f->displacement, f->stress, f->von_mises, f->level, f->eta};
  char      group[PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(group, sizeof(group), "/cycle_%04" PetscInt_FMT "/%s", part->cycle, part->body));
  PetscCall(PetscViewerHDF5PushGroup(rec->viewer, group));
  PetscCall(ISView(f->cells, rec->viewer));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(field); ++i) {
    if (field[i]) PetscCall(VecView(field[i], rec->viewer));
  }
  PetscCall(PetscViewerHDF5PopGroup(rec->viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the writers below need to name a dataset of the HDF5 file */
typedef struct {
  FILE                   *f;
  const char             *h5;
  const AbutRecorderPart *part;
} Writer;

/* <DataItem> of `n` rows of `m` numbers; a flat list for m = 1 */
static void WriteData(const Writer *w, const char name[], const char number[], PetscInt n, PetscInt m)
{
  char rows[64];

  if (m == 1) snprintf(rows, sizeof(rows), "%" PetscInt_FMT, n);
  else snprintf(rows, sizeof(rows), "%" PetscInt_FMT " %" PetscInt_FMT, n, m);
  fprintf(w->f, "<DataItem Dimensions=\"%s\" %s Format=\"HDF\">%s:/cycle_%04" PetscInt_FMT "/%s/%s</DataItem>", rows, number, w->h5,
          w->part->cycle, w->part->body, name);
}

/* Column `j` of a dataset of `n` rows of `m` numbers: start, stride and count, then the dataset */
static void WriteColumn(const Writer *w, const char name[], PetscInt n, PetscInt m, PetscInt j)
{
  fprintf(w->f, "<DataItem ItemType=\"HyperSlab\" Type=\"HyperSlab\" Dimensions=\"%" PetscInt_FMT " 1\">", n);
  fprintf(w->f, "<DataItem Dimensions=\"3 2\" Format=\"XML\">0 %" PetscInt_FMT " 1 1 %" PetscInt_FMT " 1</DataItem>", j, n);
  WriteData(w, name, "NumberType=\"Float\" Precision=\"8\"", n, m);
  fprintf(w->f, "</DataItem>");
}

static void WriteCellField(const Writer *w, const char name[])
{
  fprintf(w->f, "          <Attribute Name=\"%s\" AttributeType=\"Scalar\" Center=\"Cell\">", name);
  WriteData(w, name, "NumberType=\"Float\" Precision=\"8\"", w->part->ncells, 1);
  fprintf(w->f, "</Attribute>\n");
}

/* XDMF has no attribute of four components: one scalar for each */
static void WriteStress(const Writer *w)
{
  const char *const component[4] = {"s11", "s22", "s33", "s12"};

  for (PetscInt j = 0; j < 4; ++j) {
    fprintf(w->f, "          <Attribute Name=\"%s\" AttributeType=\"Scalar\" Center=\"Cell\">", component[j]);
    WriteColumn(w, "stress", w->part->ncells, 4, j);
    fprintf(w->f, "</Attribute>\n");
  }
}

/* ParaView warps by vectors of three components only: a zero is joined to the two of the file */
static void WriteDisplacement(const Writer *w)
{
  const PetscInt n = w->part->nvertices;

  fprintf(w->f, "          <Attribute Name=\"displacement\" AttributeType=\"Vector\" Center=\"Node\">\n");
  fprintf(w->f, "            <DataItem ItemType=\"Function\" Function=\"JOIN($0, $1, 0*$1)\" Dimensions=\"%" PetscInt_FMT " 3\">", n);
  for (PetscInt j = 0; j < 2; ++j) WriteColumn(w, "displacement", n, 2, j);
  fprintf(w->f, "</DataItem>\n          </Attribute>\n");
}

static void WriteBody(const Writer *w)
{
  const AbutRecorderPart *p = w->part;

  fprintf(w->f, "        <Grid Name=\"%s\" GridType=\"Uniform\">\n", p->body);
  fprintf(w->f, "          <Topology TopologyType=\"%s\" NumberOfElements=\"%" PetscInt_FMT "\">",
          p->corners == 4 ? "Quadrilateral" : "Triangle", p->ncells);
  WriteData(w, "cells", "NumberType=\"Int\" Precision=\"4\"", p->ncells, p->corners);
  fprintf(w->f, "</Topology>\n          <Geometry GeometryType=\"XY\">");
  WriteData(w, "vertices", "NumberType=\"Float\" Precision=\"8\"", p->nvertices, 2);
  fprintf(w->f, "</Geometry>\n");
  WriteDisplacement(w);
  WriteStress(w);
  WriteCellField(w, "von_mises");
  WriteCellField(w, "level");
  if (p->has_eta) WriteCellField(w, "eta");
  fprintf(w->f, "        </Grid>\n");
}

static void WriteIndex(FILE *f, const void *ctx)
{
  const AbutRecorder rec   = (AbutRecorder)ctx;
  const char        *slash = strrchr(rec->output, '/');
  char               h5[PETSC_MAX_PATH_LEN];
  Writer             w = {f, h5, NULL};

  snprintf(h5, sizeof(h5), "%s.h5", slash ? slash + 1 : rec->output);
  fprintf(f, "<?xml version=\"1.0\"?>\n<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n<Xdmf Version=\"2.0\">\n  <Domain>\n");
  fprintf(f, "    <Grid Name=\"cycles\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
  for (PetscInt i = 0; i < rec->nparts; ++i) {
    const PetscInt cycle = rec->part[i].cycle;

    if (!i || rec->part[i - 1].cycle != cycle) {
      fprintf(f, "      <Grid Name=\"cycle_%04" PetscInt_FMT "\" GridType=\"Collection\" CollectionType=\"Spatial\">\n", cycle);
      fprintf(f, "        <Time Value=\"%" PetscInt_FMT "\"/>\n", cycle);
    }
    w.part = &rec->part[i];
    WriteBody(&w);
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
  PetscCall(AbutRecorderGetPath_XDMF(rec, ".xdmf", path, sizeof(path)));
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
