#include "gmshreader.h"

/* A reader of gmsh's files, versions 2.2 and 4.1, text and binary. PETSc's own ends in a signal or does not end where a file is damaged,
   and takes cells of second order for straight ones without a word. This one stops at the first thing that is wrong and says where. */

/* Numbers are text in this section even where the file is binary */
static void AbutGmshFormat_Private(AbutGmshReader *r)
{
  PetscReal  version = AbutGmshReal_Private(r);
  PetscInt64 binary  = AbutGmshInt_Private(r, 4), size;
  int        one     = 1;

  size       = AbutGmshInt_Private(r, 4);
  r->version = (int)version;
  if (version != (PetscReal)2.2 && version != (PetscReal)4.1)
    AbutGmshFail_Private(r, "its version is neither 2.2 nor 4.1; give gmsh -format msh41");
  if (binary < 0 || binary > 1 || size != 8) AbutGmshFail_Private(r, "not a format of gmsh with double precision");
  if (binary && !AbutGmshFailed_Private(r)) {
    while (r->at < r->end && *r->at != '\n') ++r->at;
    if (r->at < r->end) ++r->at;
    r->binary = PETSC_TRUE;
    AbutGmshBytes_Private(r, sizeof(one), &one);
    if (one != 1) AbutGmshFail_Private(r, "written on a machine with another order of bytes");
  }
  AbutGmshExpect_Private(r, "$EndMeshFormat");
}

/* Text in all files */
static PetscErrorCode AbutGmshNames_Private(AbutGmshFile *f)
{
  AbutGmshReader *r      = &f->r;
  const PetscBool binary = r->binary;
  size_t          n;

  PetscFunctionBegin;
  r->binary = PETSC_FALSE;
  n         = AbutGmshCount_Private(r, 4, 4);
  PetscCall(PetscFree(f->name));
  PetscCall(PetscCalloc1(n, &f->name));
  for (f->nnames = 0; f->nnames < n && !AbutGmshFailed_Private(r); ++f->nnames) {
    AbutGmshName *name = &f->name[f->nnames];
    const char   *end;

    name->dim = AbutGmshInt_Private(r, 4);
    name->tag = AbutGmshInt_Private(r, 4);
    AbutGmshExpect_Private(r, "\"");
    end = (const char *)memchr(r->at, '"', (size_t)(r->end - r->at));
    if (!end || (size_t)(end - r->at) >= sizeof(name->text)) AbutGmshFail_Private(r, "a name without end");
    if (AbutGmshFailed_Private(r)) break;
    memcpy(name->text, r->at, (size_t)(end - r->at));
    r->at = end + 1;
  }
  AbutGmshExpect_Private(r, "$EndPhysicalNames");
  r->binary = binary;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Version 4: which physical group a curve or a surface is of, the first if there are several */
static PetscErrorCode AbutGmshEntities_Private(AbutGmshFile *f)
{
  AbutGmshReader *r = &f->r;
  size_t          count[4], n = 0;

  PetscFunctionBegin;
  for (PetscInt d = 0; d < 4; ++d) count[d] = AbutGmshCount_Private(r, 8, 8);
  PetscCall(PetscFree(f->entity));
  PetscCall(PetscCalloc1(count[1] + count[2], &f->entity));
  for (PetscInt d = 0; d < 4; ++d)
    for (size_t i = 0; i < count[d] && !AbutGmshFailed_Private(r); ++i) {
      const PetscInt64 tag      = AbutGmshInt_Private(r, 4);
      PetscInt64       physical = 0;
      size_t           k;

      for (PetscInt j = 0; j < (d ? 6 : 3); ++j) (void)AbutGmshReal_Private(r);
      k = AbutGmshCount_Private(r, 8, 2);
      if ((d == 1 || d == 2) && k > 1 && !AbutGmshFailed_Private(r))
        AbutGmshFail_Private(r, d == 1 ? "a curve belongs to several physical curves, and a side needs one"
                                       : "a surface belongs to several physical surfaces, and a body needs one");
      for (size_t j = 0; j < k && !AbutGmshFailed_Private(r); ++j) {
        const PetscInt64 p = AbutGmshInt_Private(r, 4);

        if (!j) physical = p < 0 ? -p : p;
      }
      k = d ? AbutGmshCount_Private(r, 8, 2) : 0;
      for (size_t j = 0; j < k && !AbutGmshFailed_Private(r); ++j) (void)AbutGmshInt_Private(r, 4);
      if (d == 1 || d == 2) f->entity[n++] = (AbutGmshEntity){d, tag, physical};
    }
  f->nentities = AbutGmshFailed_Private(r) ? 0 : n;
  AbutGmshExpect_Private(r, "$EndEntities");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int AbutGmshNodeCompare_Private(const void *a, const void *b)
{
  const AbutGmshNode *p = (const AbutGmshNode *)a, *q = (const AbutGmshNode *)b;

  return (p->number > q->number) - (p->number < q->number);
}

static PetscErrorCode AbutGmshNodes_Private(AbutGmshFile *f)
{
  AbutGmshReader *r      = &f->r;
  size_t          blocks = r->version == 4 ? AbutGmshCount_Private(r, 8, 16) : 1, n = AbutGmshTotal_Private(r, 6);

  PetscFunctionBegin;
  PetscCall(PetscFree(f->node));
  PetscCall(PetscCalloc1(n, &f->node));
  f->nnodes = 0;
  for (PetscInt j = 0; j < (r->version == 4 ? 2 : 0); ++j) (void)AbutGmshInt_Private(r, 8);
  for (size_t b = 0; b < blocks && !AbutGmshFailed_Private(r); ++b) {
    PetscInt64 dim = 0, parametric = 0;
    size_t     inblock = n;

    if (r->version == 4) {
      dim = AbutGmshInt_Private(r, 4);
      (void)AbutGmshInt_Private(r, 4);
      parametric = AbutGmshInt_Private(r, 4);
      inblock    = AbutGmshCount_Private(r, 8, 2);
    }
    if (inblock > n - f->nnodes || dim < 0 || dim > 3) AbutGmshFail_Private(r, "more nodes than announced");
    for (size_t i = 0; i < (r->version == 4 ? inblock : 0) && !AbutGmshFailed_Private(r); ++i)
      f->node[f->nnodes + i].number = AbutGmshInt_Private(r, 8);
    for (size_t i = 0; i < inblock && !AbutGmshFailed_Private(r); ++i) {
      AbutGmshNode *node = &f->node[f->nnodes++];

      if (r->version == 2) node->number = AbutGmshInt_Private(r, 4);
      for (PetscInt d = 0; d < 3; ++d) node->x[d] = AbutGmshReal_Private(r);
      for (PetscInt64 d = 0; d < (parametric ? dim : 0); ++d) (void)AbutGmshReal_Private(r);
    }
  }
  if (f->nnodes < n) AbutGmshFail_Private(r, "fewer nodes than announced");
  AbutGmshExpect_Private(r, "$EndNodes");
  qsort(f->node, f->nnodes, sizeof(*f->node), AbutGmshNodeCompare_Private);
  for (size_t i = 1; i < f->nnodes; ++i)
    if (f->node[i].number == f->node[i - 1].number) AbutGmshFail_Private(r, "two nodes with one number");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The list to which elements of a type belong, NULL for points, and how many nodes they have */
static AbutGmshElements *AbutGmshType_Private(AbutGmshFile *f, PetscInt64 type, PetscInt *nodes)
{
  *nodes = type == 15 ? 1 : (PetscInt)type + 1;
  if (type == 1) return &f->lines;
  if (type == 2) return &f->triangles;
  if (type == 3) return &f->quads;
  if (type == 4 || type == 5 || type == 6 || type == 7 || type == 11 || type == 12 || type == 13 || type == 14)
    AbutGmshFail_Private(&f->r, "an element of a solid; give a plane mesh, gmsh -2");
  else if (type != 15)
    AbutGmshFail_Private(&f->r,
                         "an element that is neither a line, a triangle nor a quad with nodes at its corners; give gmsh -2 -order 1");
  return NULL;
}

static PetscErrorCode AbutGmshAppend_Private(AbutGmshElements *list, const AbutGmshElement *element)
{
  PetscFunctionBegin;
  if (list->n == list->room) {
    list->room = 2 * list->room + 64;
    PetscCall(PetscRealloc(list->room * sizeof(*list->element), &list->element));
  }
  list->element[list->n++] = *element;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Version 2: in a text file every element has its header, in a binary one several have one together */
static PetscErrorCode AbutGmshElements2_Private(AbutGmshFile *f)
{
  AbutGmshReader *r = &f->r;
  const size_t    n = AbutGmshTotal_Private(r, 8);
  size_t          i = 0;

  PetscFunctionBegin;
  while (i < n && !AbutGmshFailed_Private(r)) {
    const PetscInt64  id     = r->binary ? 0 : AbutGmshInt_Private(r, 4);
    const PetscInt64  type   = AbutGmshInt_Private(r, 4);
    const PetscInt64  follow = r->binary ? AbutGmshInt_Private(r, 4) : 1;
    const PetscInt64  ntags  = AbutGmshInt_Private(r, 4);
    PetscInt          nodes;
    AbutGmshElements *list = AbutGmshType_Private(f, type, &nodes);

    if (follow < 1 || follow > (PetscInt64)(n - i) || ntags < 0) AbutGmshFail_Private(r, "more elements than announced, or less than none");
    for (PetscInt64 e = 0; e < follow && !AbutGmshFailed_Private(r); ++e, ++i) {
      AbutGmshElement element = {{0}, r->binary ? AbutGmshInt_Private(r, 4) : id, 0};

      for (PetscInt64 j = 0; j < ntags && !AbutGmshFailed_Private(r); ++j) {
        const PetscInt64 tag = AbutGmshInt_Private(r, 4);

        if (!j) element.physical = tag < 0 ? -tag : tag;
      }
      for (PetscInt j = 0; j < nodes && !AbutGmshFailed_Private(r); ++j) element.node[j] = AbutGmshInt_Private(r, 4);
      if (list && !AbutGmshFailed_Private(r)) PetscCall(AbutGmshAppend_Private(list, &element));
    }
  }
  AbutGmshExpect_Private(r, "$EndElements");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Version 4: blocks of the elements of one curve or surface */
static PetscErrorCode AbutGmshElements4_Private(AbutGmshFile *f)
{
  AbutGmshReader *r      = &f->r;
  const size_t    blocks = AbutGmshCount_Private(r, 8, 16);

  PetscFunctionBegin;
  for (PetscInt j = 0; j < 3; ++j) (void)AbutGmshInt_Private(r, 8);
  for (size_t b = 0; b < blocks && !AbutGmshFailed_Private(r); ++b) {
    const PetscInt64  dim = AbutGmshInt_Private(r, 4), tag = AbutGmshInt_Private(r, 4), type = AbutGmshInt_Private(r, 4);
    const size_t      n        = AbutGmshCount_Private(r, 8, 4);
    PetscInt64        physical = 0;
    PetscInt          nodes;
    AbutGmshElements *list = AbutGmshType_Private(f, type, &nodes);

    for (size_t i = 0; i < f->nentities; ++i)
      if (f->entity[i].dim == dim && f->entity[i].tag == tag) physical = f->entity[i].physical;
    for (size_t i = 0; i < n && !AbutGmshFailed_Private(r); ++i) {
      AbutGmshElement element = {{0}, AbutGmshInt_Private(r, 8), physical};

      for (PetscInt j = 0; j < nodes && !AbutGmshFailed_Private(r); ++j) element.node[j] = AbutGmshInt_Private(r, 8);
      if (list && !AbutGmshFailed_Private(r)) PetscCall(AbutGmshAppend_Private(list, &element));
    }
  }
  AbutGmshExpect_Private(r, "$EndElements");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The word at which the file is read; empty where it ends */
static PetscErrorCode AbutGmshWord_Private(AbutGmshReader *r, size_t len, char word[])
{
  size_t n = 0;

  PetscFunctionBegin;
  while (r->at < r->end && *r->at <= ' ') ++r->at;
  while (r->at + n < r->end && r->at[n] > ' ' && n < len - 1) ++n;
  memcpy(word, r->at, n);
  word[n] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Section after section; those of no interest are skipped */
PetscErrorCode AbutGmshSections_Private(AbutGmshFile *f)
{
  static const char *const section[] = {"$PhysicalNames", "$Entities", "$Nodes", "$Elements"};
  AbutGmshReader          *r         = &f->r;
  PetscBool                has[4]    = {PETSC_FALSE};

  PetscFunctionBegin;
  AbutGmshExpect_Private(r, "$MeshFormat");
  if (!AbutGmshFailed_Private(r)) AbutGmshFormat_Private(r);
  while (!AbutGmshFailed_Private(r)) {
    PetscInt which = 0;
    char     word[ABUT_GMSH_TEXT_MAX], end[ABUT_GMSH_TEXT_MAX + 3];

    PetscCall(AbutGmshWord_Private(r, sizeof(word), word));
    if (!word[0]) break;
    while (which < 4 && strcmp(word, section[which])) ++which;
    if (word[0] != '$') AbutGmshFail_Private(r, "expected the beginning of a section");
    else if (which < 4 && has[which]) AbutGmshFail_Private(r, "a section is there twice");
    if (AbutGmshFailed_Private(r)) break;
    r->at += strlen(word);
    if (which == 4) { /* where binary numbers follow, only its end can be looked for */
      PetscCall(PetscSNPrintf(end, sizeof(end), "$End%s", word + 1));
      AbutGmshSkipTo_Private(r, end);
      continue;
    }
    has[which] = PETSC_TRUE;
    if (r->binary && r->at < r->end) ++r->at; /* the line feed */
    if (which == 0) PetscCall(AbutGmshNames_Private(f));
    else if (which == 1) PetscCall(AbutGmshEntities_Private(f));
    else if (which == 2) PetscCall(AbutGmshNodes_Private(f));
    else PetscCall((r->version == 2 ? AbutGmshElements2_Private : AbutGmshElements4_Private)(f));
  }
  if (!has[2] || !has[3]) AbutGmshFail_Private(r, "the file is cut off: it has no $Nodes or no $Elements");
  PetscFunctionReturn(PETSC_SUCCESS);
}
