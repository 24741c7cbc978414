/* FILE_NAME_0000.vtu for every body and cycle, .vtp for every pair, and FILE.pvd which lists them (VTK File Formats, vtk.org) */
#include <abut/private/recorderimpl.h>
#include <string.h>

#define VTK_TRIANGLE 5
#define VTK_QUAD     9

/* The arrays of one body or side on rank 0, where they are written; NULL elsewhere, and those it does not have */
typedef struct {
  const AbutRecorderPart *part;
  const PetscScalar      *vertices, *displacement, *cells, *stress, *von_mises, *level, *eta, *pressure, *gap, *normal;
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

/* Corners of the cells, or ends of the lines; only cells have types */
static void WriteCells(FILE *f, const Arrays *a, const char kind[], PetscBool types)
{
  const PetscInt corners = a->part->corners, ncells = a->part->ncells;

  fprintf(f, "      <%s>\n", kind);
  WriteArray(f, "type=\"Int32\" Name=\"connectivity\"", corners * ncells, 1, 1, a->cells);
  fprintf(f, "        <DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">\n");
  for (PetscInt c = 1; c <= ncells; ++c) fprintf(f, "%" PetscInt_FMT "\n", corners * c);
  if (types) fprintf(f, "        </DataArray>\n        <DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">\n");
  for (PetscInt c = 0; types && c < ncells; ++c) fprintf(f, "%d\n", corners == 4 ? VTK_QUAD : VTK_TRIANGLE);
  fprintf(f, "        </DataArray>\n      </%s>\n", kind);
}

static void WriteBodyData(FILE *f, const Arrays *a)
{
  const PetscInt nc       = a->part->ncells;
  const char     stress[] = "type=\"Float64\" Name=\"stress\" ComponentName0=\"s11\" ComponentName1=\"s22\" "
                            "ComponentName2=\"s33\" ComponentName3=\"s12\"";

  fprintf(f, "      <PointData Vectors=\"displacement\">\n");
  WriteArray(f, "type=\"Float64\" Name=\"displacement\"", a->part->nvertices, 2, 3, a->displacement);
  fprintf(f, "      </PointData>\n      <CellData Scalars=\"von_mises\">\n");
  WriteArray(f, stress, nc, 4, 4, a->stress);
  WriteArray(f, "type=\"Float64\" Name=\"von_mises\"", nc, 1, 1, a->von_mises);
  WriteArray(f, "type=\"Int32\" Name=\"level\"", nc, 1, 1, a->level);
  if (a->eta) WriteArray(f, "type=\"Float64\" Name=\"eta\"", nc, 1, 1, a->eta);
  fprintf(f, "      </CellData>\n");
}

static void WriteSideData(FILE *f, const Arrays *a)
{
  const PetscInt nv = a->part->nvertices;

  fprintf(f, "      <PointData Scalars=\"pressure\">\n");
  WriteArray(f, "type=\"Float64\" Name=\"pressure\"", nv, 1, 1, a->pressure);
  WriteArray(f, "type=\"Float64\" Name=\"gap\"", nv, 1, 1, a->gap);
  WriteArray(f, "type=\"Float64\" Name=\"normal_displacement\"", nv, 1, 1, a->normal);
  fprintf(f, "      </PointData>\n");
}

static void WriteNumber(FILE *f, const char name[], double value)
{
  fprintf(f, "      <DataArray type=\"Float64\" Name=\"%s\" NumberOfTuples=\"1\" format=\"ascii\">%.17g</DataArray>\n", name, value);
}

static void WritePart(FILE *f, const void *ctx)
{
  const Arrays           *a    = (const Arrays *)ctx;
  const AbutRecorderPart *p    = a->part;
  const PetscBool         side = (PetscBool)(p->corners == 2);
  const char             *type = side ? "PolyData" : "UnstructuredGrid";

  fprintf(f, "<?xml version=\"1.0\"?>\n");
  fprintf(f, "<VTKFile type=\"%s\" version=\"1.0\" byte_order=\"LittleEndian\">\n  <%s>\n", type, type);
  if (p->step) {
    fprintf(f, "    <FieldData>\n");
    WriteNumber(f, "step", p->step);
    WriteNumber(f, "load_factor", p->factor);
    fprintf(f, "    </FieldData>\n");
  }
  fprintf(f, "    <Piece NumberOfPoints=\"%" PetscInt_FMT "\" %s=\"%" PetscInt_FMT "\">\n      <Points>\n", p->nvertices,
          side ? "NumberOfLines" : "NumberOfCells", p->ncells);
  WriteArray(f, "type=\"Float64\" Name=\"vertices\"", p->nvertices, 2, 3, a->vertices);
  fprintf(f, "      </Points>\n");
  if (side) {
    WriteCells(f, a, "Lines", PETSC_FALSE);
    WriteSideData(f, a);
  } else {
    WriteCells(f, a, "Cells", PETSC_TRUE);
    WriteBodyData(f, a);
  }
  fprintf(f, "    </Piece>\n  </%s>\n</VTKFile>\n", type);
}

/* FILE_NAME_0000.vtu of a body, .vtp of a side */
static void NameFile(const char stem[], const AbutRecorderPart *p, char path[], size_t len)
{
  snprintf(path, len, "%s_%s_%04" PetscInt_FMT ".%s", stem, p->name, p->cycle, p->corners == 2 ? "vtp" : "vtu");
}

#define ARRAYS 10

static PetscErrorCode AbutRecorderWritePart_VTU(AbutRecorder rec, const AbutRecorderPart *part, const AbutFields *fields)
{
  char                path[PETSC_MAX_PATH_LEN];
  Vec                 cells, all[ARRAYS];
  Arrays              a             = {.part = part};
  const PetscScalar **array[ARRAYS] = {&a.cells, &a.vertices, &a.displacement, &a.stress, &a.von_mises,
                                       &a.level, &a.eta,      &a.pressure,     &a.gap,    &a.normal};
  const Vec           field[ARRAYS] = {NULL,          fields->vertices, fields->displacement, fields->stress, fields->von_mises,
                                       fields->level, fields->eta,      fields->pressure,     fields->gap,    fields->normal};

  PetscFunctionBegin;
  PetscCall(AbutRecorderCreateCellVec_VTU(fields->cells, &cells));
  for (int i = 0; i < ARRAYS; ++i) PetscCall(AbutRecorderGather_VTU(i ? field[i] : cells, &all[i], array[i]));
  PetscCall(VecDestroy(&cells));
  NameFile(rec->output, part, path, sizeof(path));
  PetscCall(AbutFileWrite(PetscObjectComm((PetscObject)rec), path, WritePart, &a));
  for (int i = 0; i < ARRAYS; ++i) PetscCall(AbutRecorderRelease_VTU(&all[i], array[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void WriteIndex(FILE *f, const void *ctx)
{
  const AbutRecorder rec   = (AbutRecorder)ctx;
  const char        *slash = strrchr(rec->output, '/'), *name = slash ? slash + 1 : rec->output;
  char               path[PETSC_MAX_PATH_LEN];
  PetscInt           number = 0;

  fprintf(f, "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n  <Collection>\n");
  for (PetscInt i = 0; i < rec->nparts; ++i) {
    const AbutRecorderPart *p = &rec->part[i];

    number = i && p->cycle == rec->part[i - 1].cycle ? number + 1 : 0;
    fprintf(f, "    <DataSet timestep=\"%" PetscInt_FMT "\" part=\"%" PetscInt_FMT "\" name=\"%s\" ", p->cycle, number, p->name);
    NameFile(name, p, path, sizeof(path));
    fprintf(f, "file=\"%s\"/>\n", path);
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
