#include "gmshreader.h"

/* What one body needs of a gmsh file: the cells of one physical surface or of all, their vertices, and the lines of physical curves */

/* The place of a node in the list of the file, -1 if there is none */
static PetscInt AbutGmshFindNode_Private(const AbutGmshFile *f, PetscInt64 number)
{
  size_t low = 0, high = f->nnodes;

  while (low < high) {
    const size_t middle = (low + high) / 2;

    if (f->node[middle].number < number) low = middle + 1;
    else high = middle;
  }
  return low < f->nnodes && f->node[low].number == number ? (PetscInt)low : -1;
}

/* The number of a physical surface by its name, or by its number as a text; -1 if there is none */
static PetscInt64 AbutGmshFindRegion_Private(const AbutGmshFile *f, const char region[])
{
  const AbutGmshElements *lists[2] = {&f->triangles, &f->quads};
  char                   *end;
  const PetscInt64        number = strtoll(region, &end, 10);

  for (size_t i = 0; i < f->nnames; ++i)
    if (f->name[i].dim == 2 && !strcmp(f->name[i].text, region)) return f->name[i].tag;
  for (PetscInt k = 0; k < 2 && !*end; ++k)
    for (size_t i = 0; i < lists[k]->n; ++i)
      if (lists[k]->element[i].physical == number) return number;
  return -1;
}

/* Whether the file has elements of a physical group of a kind whose number is this text, and no name for it */
static PetscErrorCode AbutGmshIsNumber_Private(const AbutGmshFile *f, PetscInt64 dim, const char text[], PetscBool *is)
{
  const AbutGmshElements *lists[2] = {dim == 1 ? &f->lines : &f->triangles, dim == 1 ? NULL : &f->quads};
  const PetscInt64        number   = strtoll(text, NULL, 10);
  char                    digits[32];

  PetscFunctionBegin;
  *is = PETSC_FALSE;
  PetscCall(PetscSNPrintf(digits, sizeof(digits), "%lld", (long long)number));
  if (dim < 1 || dim > 2 || number <= 0 || strcmp(digits, text)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < 2 && lists[k]; ++k)
    for (size_t i = 0; i < lists[k]->n; ++i)
      if (lists[k]->element[i].physical == number) *is = PETSC_TRUE;
  for (size_t i = 0; i < f->nnames; ++i)
    if (f->name[i].dim == dim && f->name[i].tag == number) *is = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two physical groups of one kind with one name, or with a name that is the number by which another is known */
static PetscErrorCode AbutGmshCheckNames_Private(const AbutGmshFile *f, AbutFault *fault)
{
  PetscFunctionBegin;
  for (size_t i = 0; i < f->nnames; ++i) {
    PetscBool same = PETSC_FALSE, number;

    if (f->name[i].dim == 1 && strlen(f->name[i].text) >= ABUT_SIDE_NAME_MAX)
      PetscCall(PetscSNPrintf(fault->text, sizeof(fault->text), "the name \"%.70s...\" of a physical curve is longer than %d letters",
                              f->name[i].text, ABUT_SIDE_NAME_MAX - 1));
    for (size_t j = 0; j < i && !same; ++j)
      if (f->name[j].dim == f->name[i].dim) PetscCall(PetscStrcasecmp(f->name[i].text, f->name[j].text, &same));
    if (same)
      PetscCall(PetscSNPrintf(fault->text, sizeof(fault->text),
                              "two physical %s have the name \"%s\"; give each one of its own, without case",
                              f->name[i].dim == 1 ? "curves" : "surfaces", f->name[i].text));
    PetscCall(AbutGmshIsNumber_Private(f, f->name[i].dim, f->name[i].text, &number));
    if (number)
      PetscCall(PetscSNPrintf(fault->text, sizeof(fault->text),
                              "two physical %s are \"%s\": one has this name, another this number and no name; give the other a name",
                              f->name[i].dim == 1 ? "curves" : "surfaces", f->name[i].text));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Triangles or quads of the region, whichever there are */
static PetscErrorCode AbutGmshCells_Private(AbutGmshFile *f, const char region[], AbutGmsh *out, AbutFault *fault)
{
  AbutGmshElements *lists[2] = {&f->triangles, &f->quads};
  const PetscInt64  physical = region ? AbutGmshFindRegion_Private(f, region) : 0;
  PetscInt          n[2]     = {0, 0};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; ++k) {
    size_t kept = 0;

    for (size_t i = 0; i < lists[k]->n; ++i)
      if (!region || lists[k]->element[i].physical == physical) lists[k]->element[kept++] = lists[k]->element[i];
    n[k] = (PetscInt)(lists[k]->n = kept);
  }
  if (physical < 0) {
    char names[ABUT_LIST] = "";

    for (size_t i = 0; i < f->nnames; ++i)
      if (f->name[i].dim == 2) PetscCall(AbutListAddItem_Private(names, sizeof(names), f->name[i].text));
    PetscCall(PetscSNPrintf(fault->text, sizeof(fault->text), "there is no physical surface \"%s\"; the file has %s", region,
                            names[0] ? names : "none with a name"));
  } else if (!n[0] && !n[1]) PetscCall(PetscStrncpy(fault->text, "there are no triangles and no quads", sizeof(fault->text)));
  else if (n[0] && n[1])
    PetscCall(PetscSNPrintf(fault->text, sizeof(fault->text),
                            "%" PetscInt_FMT " triangles and %" PetscInt_FMT
                            " quads; give all triangles, or all quads: Recombine Surface and "
                            "Mesh.SubdivisionAlgorithm = 1 in the .geo",
                            n[0], n[1]));
  out->corners = n[0] ? 3 : 4;
  out->ncells  = n[0] ? n[0] : n[1];
  PetscCall(PetscMalloc1(out->corners * out->ncells, &out->cell));
  PetscCall(PetscMalloc1(out->ncells, &out->id));
  for (PetscInt c = 0; c < out->ncells; ++c) {
    const AbutGmshElement *e = &lists[!n[0]]->element[c];

    out->id[c] = (PetscInt)e->id;
    for (PetscInt k = 0; k < out->corners; ++k) {
      out->cell[out->corners * c + k] = AbutGmshFindNode_Private(f, e->node[k]);
      if (out->cell[out->corners * c + k] < 0 && !fault->text[0])
        PetscCall(PetscSNPrintf(fault->text, sizeof(fault->text), "element %lld has the node %lld, which is not there", (long long)e->id,
                                (long long)e->node[k]));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The nodes that are corners of cells lie in a plane along x and y, but for what the numbers of a mesher that turned it lost */
static PetscErrorCode AbutGmshCheckPlane_Private(const AbutGmshFile *f, const PetscInt vertex[], PetscInt first, AbutFault *fault)
{
  const PetscReal tiny = 1e-9, *x = f->node[first].x; /* of the size of the mesh */
  PetscReal       size = 0.;

  PetscFunctionBegin;
  for (size_t i = 0; i < f->nnodes; ++i)
    for (PetscInt d = 0; d < 2 && vertex[i] >= 0; ++d) size = PetscMax(size, PetscAbsReal(f->node[i].x[d] - x[d]));
  for (size_t i = 0; i < f->nnodes && !fault->text[0]; ++i)
    if (vertex[i] >= 0 && PetscAbsReal(f->node[i].x[2] - x[2]) > tiny * size)
      PetscCall(PetscSNPrintf(fault->text, sizeof(fault->text),
                              "node %lld lies at z = %g, others at %g; give a mesh in the plane of x and y", (long long)f->node[i].number,
                              (double)f->node[i].x[2], (double)x[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps the nodes that are corners of cells, and lines between two of them */
static PetscErrorCode AbutGmshVertices_Private(const AbutGmshFile *f, AbutGmsh *out, AbutFault *fault)
{
  PetscInt *vertex;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(f->nnodes, &vertex));
  for (size_t i = 0; i < f->nnodes; ++i) vertex[i] = -1;
  for (PetscInt k = 0; k < out->corners * out->ncells; ++k) vertex[out->cell[k]] = 0;
  PetscCall(AbutGmshCheckPlane_Private(f, vertex, out->cell[0], fault));
  PetscCall(PetscMalloc1(2 * f->nnodes, &out->x));
  for (size_t i = 0; i < f->nnodes; ++i) {
    if (vertex[i] < 0) continue;
    vertex[i] = out->nvertices++;
    for (PetscInt d = 0; d < 2; ++d) out->x[2 * vertex[i] + d] = f->node[i].x[d];
  }
  PetscCall(PetscMalloc1(3 * f->lines.n, &out->line));
  for (size_t i = 0; i < f->lines.n; ++i) {
    const AbutGmshElement *e    = &f->lines.element[i];
    const PetscInt         a[2] = {AbutGmshFindNode_Private(f, e->node[0]), AbutGmshFindNode_Private(f, e->node[1])};
    PetscInt              *line = out->line + 3 * out->nlines;

    if (!e->physical || a[0] < 0 || a[1] < 0 || vertex[a[0]] < 0 || vertex[a[1]] < 0) continue;
    if ((e->physical < 0 || e->physical > PETSC_MAX_INT) && !fault->text[0])
      PetscCall(PetscSNPrintf(fault->text, sizeof(fault->text), "a physical curve has the number %lld; give one from 1 to %lld",
                              (long long)e->physical, (long long)PETSC_MAX_INT));
    for (PetscInt k = 0; k < 2; ++k) line[k] = vertex[a[k]];
    line[2] = (PetscInt)e->physical;
    ++out->nlines;
  }
  for (PetscInt k = 0; k < out->corners * out->ncells; ++k) out->cell[k] = vertex[out->cell[k]];
  PetscCall(PetscFree(vertex));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutGmshCurveNames_Private(const AbutGmshFile *f, AbutGmsh *out)
{
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(f->nnames, &out->nametag));
  PetscCall(PetscMalloc1(f->nnames, &out->name));
  for (size_t i = 0; i < f->nnames; ++i) {
    if (f->name[i].dim != 1) continue;
    out->nametag[out->nnames] = (PetscInt)f->name[i].tag;
    PetscCall(PetscStrncpy(out->name[out->nnames++], f->name[i].text, ABUT_SIDE_NAME_MAX));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* On one rank: reads what a body needs, region may be NULL; or says what is wrong */
PetscErrorCode AbutGmshRead_Private(const char path[], const char region[], AbutGmsh *out, char sum[], AbutFault *fault)
{
  AbutGmshFile f;
  char        *text;
  size_t       n;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(&f, sizeof(f)));
  PetscCall(PetscMemzero(out, sizeof(*out)));
  PetscCall(AbutGmshLoad_Private(path, &text, &n, sum, fault));
  f.r = (AbutGmshReader){.start = text, .at = text, .end = text + n, .fault = fault};
  if (!fault->text[0]) PetscCall(AbutGmshSections_Private(&f));
  if (!fault->text[0]) PetscCall(AbutGmshCheckNames_Private(&f, fault));
  if (!fault->text[0]) PetscCall(AbutGmshCells_Private(&f, region, out, fault));
  if (!fault->text[0]) PetscCall(AbutGmshVertices_Private(&f, out, fault));
  if (!fault->text[0]) PetscCall(AbutGmshCurveNames_Private(&f, out));
  PetscCall(PetscFree(text));
  PetscCall(PetscFree(f.node));
  PetscCall(PetscFree(f.entity));
  PetscCall(PetscFree(f.name));
  PetscCall(PetscFree(f.lines.element));
  PetscCall(PetscFree(f.triangles.element));
  PetscCall(PetscFree(f.quads.element));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutGmshFree_Private(AbutGmsh *g)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(g->cell));
  PetscCall(PetscFree(g->id));
  PetscCall(PetscFree(g->x));
  PetscCall(PetscFree(g->line));
  PetscCall(PetscFree(g->nametag));
  PetscCall(PetscFree(g->name));
  PetscFunctionReturn(PETSC_SUCCESS);
}
