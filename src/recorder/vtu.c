/* FILE_BODY_0000.vtu for every body and cycle, and FILE.pvd which lists them (VTK File Formats, vtk.org) */
#include <abut/private/recorderimpl.h>
#include <string.h>

#define VTK_TRIANGLE 5
#define VTK_QUAD     9

/* The arrays of one body on rank 0, where they are written; NULL elsewhere */
typedef struct {
  PetscInt           nvertices, ncells, corners;
  const PetscScalar *vertices, *displacement, *cells, *stress, *von_mises, *level, *eta;
} Arrays;

static PetscErrorCode AbutRecorderGather_VTU(Vec v, Vec *all, const PetscScalar **array)
{
  VecScatter scatter;

  PetscFunctionBegin;
  *all   = NULL;
  *array = NULL;
  if (!v) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecScatterCreateToZero(v, &scatter, all));
  PetscCall(VecScatterBegin(scatter, v, *all, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, v, *all, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterDestroy(&scatter));
  PetscCall(VecGetArrayRead(*all, array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutRecorderRelease_VTU(Vec *all, const PetscScalar **array)
{
  PetscFunctionBegin;
  if (!*all) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecRestoreArrayRead(*all, array));
  PetscCall(VecDestroy(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The corners of the cells as numbers, so that they are gathered and written like all the others */
static PetscErrorCode AbutRecorderCreateCellVec_VTU(IS cells, Vec *v)
{
  PetscInt        n;
  const PetscInt *index;
  PetscScalar    *value;

  PetscFunctionBegin;
  PetscCall(ISGetLocalSize(cells, &n));
  PetscCall(VecCreateMPI(PetscObjectComm((PetscObject)cells), n, PETSC_DETERMINE, v));
  PetscCall(ISGetIndices(cells, &index));
  PetscCall(VecGetArrayWrite(*v, &value));
  for (PetscInt i = 0; i < n; ++i) value[i] = index[i];
  PetscCall(VecRestoreArrayWrite(*v, &value));
  PetscCall(ISRestoreIndices(cells, &index));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `n` rows of `m` numbers, filled up with zeros to `width`, for VTK's points and vectors have three components */
static void WriteArray(FILE *f, const char attributes[], PetscInt n, PetscInt m, PetscInt width, const PetscScalar a[])
{
  fprintf(f, "        <DataArray %s NumberOfComponents=\"%" PetscInt_FMT "\" format=\"ascii\">\n", attributes, width);
  for (PetscInt i = 0; i < n; ++i) {
    for (PetscInt j = 0; j < width; ++j) fprintf(f, "%s%.17g", j ? " " : "", j < m ? (double)a[m * i + j] : 0.);
    fputc('\n', f);
  }
  fprintf(f, "        </DataArray>\n");
}

static void WriteCells(FILE *f, const Arrays *a)
{
  fprintf(f, "      <Cells>\n");
  WriteArray(f, "type=\"Int32\" Name=\"connectivity\"", a->corners * a->ncells, 1, 1, a->cells);
  fprintf(f, "        <DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">\n");
  for (PetscInt c = 1; c <= a->ncells; ++c) fprintf(f, "%" PetscInt_FMT "\n", a->corners * c);
  fprintf(f, "        </DataArray>\n        <DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">\n");
  for (PetscInt c = 0; c < a->ncells; ++c) fprintf(f, "%d\n", a->corners == 4 ? VTK_QUAD : VTK_TRIANGLE);
  fprintf(f, "        </DataArray>\n      </Cells>\n");
}

static void WriteBody(FILE *f, const void *ctx)
{
  const Arrays  *a  = (const Arrays *)ctx;
  const PetscInt nv = a->nvertices, nc = a->ncells;
  const char     stress[] = "type=\"Float64\" Name=\"stress\" ComponentName0=\"s11\" ComponentName1=\"s22\" "
                            "ComponentName2=\"s33\" ComponentName3=\"s12\"";

  fprintf(f, "<?xml version=\"1.0\"?>\n");
  fprintf(f, "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n  <UnstructuredGrid>\n");
  fprintf(f, "    <Piece NumberOfPoints=\"%" PetscInt_FMT "\" NumberOfCells=\"%" PetscInt_FMT "\">\n      <Points>\n", nv, nc);
  WriteArray(f, "type=\"Float64\" Name=\"vertices\"", nv, 2, 3, a->vertices);
  fprintf(f, "      </Points>\n");
  WriteCells(f, a);
  fprintf(f, "      <PointData Vectors=\"displacement\">\n");
  WriteArray(f, "type=\"Float64\" Name=\"displacement\"", nv, 2, 3, a->displacement);
  fprintf(f, "      </PointData>\n      <CellData Scalars=\"von_mises\">\n");
  WriteArray(f, stress, nc, 4, 4, a->stress);
  WriteArray(f, "type=\"Float64\" Name=\"von_mises\"", nc, 1, 1, a->von_mises);
  WriteArray(f, "type=\"Int32\" Name=\"level\"", nc, 1, 1, a->level);
  if (a->eta) WriteArray(f, "type=\"Float64\" Name=\"eta\"", nc, 1, 1, a->eta);
  fprintf(f, "      </CellData>\n    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n");
}

static PetscErrorCode AbutRecorderWritePart_VTU(AbutRecorder rec, const AbutRecorderPart *part, const AbutFields *fields)
{
  char                path[PETSC_MAX_PATH_LEN];
  Vec                 cells, all[7];
  Arrays              a       = {part->nvertices, part->ncells, part->corners, NULL, NULL, NULL, NULL, NULL, NULL, NULL};
  const PetscScalar **array[] = {&a.cells, &a.vertices, &a.displacement, &a.stress, &a.von_mises, &a.level, &a.eta};
  const Vec field[] = {NULL, fields->vertices, fields->displacement, fields->stress, fields->von_mises, fields->level, fields->eta};

  PetscFunctionBegin;
  PetscCall(AbutRecorderCreateCellVec_VTU(fields->cells, &cells));
  for (int i = 0; i < 7; ++i) PetscCall(AbutRecorderGather_VTU(i ? field[i] : cells, &all[i], array[i]));
  PetscCall(VecDestroy(&cells));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s_%s_%04" PetscInt_FMT ".vtu", rec->output, part->body, part->cycle));
  PetscCall(AbutFileWrite(PetscObjectComm((PetscObject)rec), path, WriteBody, &a));
  for (int i = 0; i < 7; ++i) PetscCall(AbutRecorderRelease_VTU(&all[i], array[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void WriteIndex(FILE *f, const void *ctx)
{
  const AbutRecorder rec   = (AbutRecorder)ctx;
  const char        *slash = strrchr(rec->output, '/'), *name = slash ? slash + 1 : rec->output;
  PetscInt           body = 0;

  fprintf(f, "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n  <Collection>\n");
  for (PetscInt i = 0; i < rec->nparts; ++i) {
    const AbutRecorderPart *p = &rec->part[i];

    body = i && p->cycle == rec->part[i - 1].cycle ? body + 1 : 0;
    fprintf(f, "    <DataSet timestep=\"%" PetscInt_FMT "\" part=\"%" PetscInt_FMT "\" name=\"%s\" ", p->cycle, body, p->body);
    fprintf(f, "file=\"%s_%s_%04" PetscInt_FMT ".vtu\"/>\n", name, p->body, p->cycle);
  }
  fprintf(f, "  </Collection>\n</VTKFile>\n");
}

static PetscErrorCode AbutRecorderEndCycle_VTU(AbutRecorder rec)
{
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s.pvd", rec->output));
  PetscCall(AbutFileWrite(PetscObjectComm((PetscObject)rec), path, WriteIndex, rec));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutRecorderCreate_VTU(AbutRecorder rec)
{
  PetscFunctionBegin;
  rec->ops->begincycle = NULL;
  rec->ops->writepart  = AbutRecorderWritePart_VTU;
  rec->ops->endcycle   = AbutRecorderEndCycle_VTU;
  PetscFunctionReturn(PETSC_SUCCESS);
}
