#include "first.h"
#include "quadrants.h" /*I "abutmesh.h" I*/
#include <p4est_algorithms.h>
#include <p4est_bits.h>
#include <p4est_extended.h>
#include <p4est_plex.h>

/* Quadrilaterals: p4est holds the quadtree (refinement, balance, partition), DMPlex holds the mesh */
typedef struct {
  p4est_connectivity_t *connectivity;
  p4est_t              *p4est;
} AbutMesh_Forest;

typedef enum {
  ABUT_MERGED_NOT,
  ABUT_MERGED_BEFORE,
  ABUT_MERGED_NOW /* in the present step: balance may still take it back */
} AbutMerged;

/* What every quadrant keeps in mind */
typedef struct {
  int        mark;     /* 1: to be split, -1: may be merged */
  int        least;    /* it is merged into no cell of a lower level */
  AbutMerged merged;   /* is it made of its children? */
  int        children; /* which of these were made of theirs, a bit each */
} AbutQuad;

static AbutQuad *AbutForestQuad_Private(const p4est_quadrant_t *quadrant)
{
  return (AbutQuad *)quadrant->p.user_data;
}

static void AbutForestBegin_Private(PETSC_UNUSED p4est_t *p4est, PETSC_UNUSED p4est_topidx_t tree, p4est_quadrant_t *quadrant)
{
  memset(quadrant->p.user_data, 0, sizeof(AbutQuad));
}

static int AbutForestIsMarked_Private(PETSC_UNUSED p4est_t *p4est, PETSC_UNUSED p4est_topidx_t tree, p4est_quadrant_t *quadrant)
{
  return AbutForestQuad_Private(quadrant)->mark > 0;
}

static int AbutForestMayMerge_Private(PETSC_UNUSED p4est_t *p4est, PETSC_UNUSED p4est_topidx_t tree, p4est_quadrant_t *family[])
{
  for (int i = 0; i < P4EST_CHILDREN; ++i) {
    const AbutQuad *quad = AbutForestQuad_Private(family[i]);

    if (quad->mark >= 0 || quad->least >= family[i]->level) return 0;
  }
  return 1;
}

/* A cell that is split after a merge is not merged again, unless it is only balance that takes the merge back */
static void AbutForestReplace_Private(PETSC_UNUSED p4est_t *p4est, PETSC_UNUSED p4est_topidx_t tree, int nout, p4est_quadrant_t *out[],
                                      int nin, p4est_quadrant_t *in[])
{
  const AbutQuad *old = AbutForestQuad_Private(out[0]);

  for (int i = 0; i < nin; ++i) {
    AbutQuad *quad = AbutForestQuad_Private(in[i]);

    quad->least = old->least;
    if (nout > 1) {
      quad->merged = ABUT_MERGED_NOW;
      for (int k = 0; k < nout; ++k) quad->children |= (AbutForestQuad_Private(out[k])->merged != ABUT_MERGED_NOT) << k;
    } else if (old->merged == ABUT_MERGED_NOW)
      quad->merged = (old->children >> p4est_quadrant_child_id(in[i])) % 2 ? ABUT_MERGED_BEFORE : ABUT_MERGED_NOT;
    else if (old->merged == ABUT_MERGED_BEFORE) quad->least = in[i]->level;
  }
}

/* Two children of a side and their middle have numbers in DMPlex's reference tree, not p4est's: they are told by incidence */
static PetscErrorCode AbutForestReferenceIds_Private(DM reference, PetscInt ids[3])
{
  PetscInt        eStart, eEnd, side = -1, nchildren;
  const PetscInt *children, *cone;

  PetscFunctionBegin;
  PetscCall(DMPlexGetDepthStratum(reference, 1, &eStart, &eEnd));
  for (PetscInt e = eStart; e < eEnd && side < 0; ++e) {
    PetscInt parent;

    PetscCall(DMPlexGetTreeParent(reference, e, &parent, NULL));
    PetscCall(DMPlexGetTreeChildren(reference, e, &nchildren, &children));
    if (parent == e && nchildren == 3) side = e;
  }
  PetscCall(DMPlexGetCone(reference, side, &cone));
  for (PetscInt i = 0; i < 3; ++i) {
    const PetscInt *ends;
    PetscInt        depth;

    PetscCall(DMPlexGetPointDepth(reference, children[i], &depth));
    if (!depth) {
      ids[2] = children[i];
      continue;
    }
    PetscCall(DMPlexGetCone(reference, children[i], &ends));
    ids[ends[0] == cone[0] || ends[1] == cone[0] ? 0 : 1] = children[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutForestSetTree_Private(DM dm, const AbutPlexData *data)
{
  const PetscInt *child = (const PetscInt *)data->children->array, *parent = (const PetscInt *)data->parents->array,
                 n = (PetscInt)data->children->elem_count;
  DM           reference;
  PetscSection section;
  PetscInt     pStart, pEnd, reference_ids[3], *ids;

  PetscFunctionBegin;
  PetscCall(DMPlexCreateDefaultReferenceTree(PetscObjectComm((PetscObject)dm), 2, PETSC_FALSE, &reference));
  PetscCall(DMPlexSetReferenceTree(dm, reference));
  PetscCall(AbutForestReferenceIds_Private(reference, reference_ids));
  PetscCall(DMPlexGetChart(dm, &pStart, &pEnd));
  PetscCall(PetscSectionCreate(PetscObjectComm((PetscObject)dm), &section));
  PetscCall(PetscSectionSetChart(section, pStart, pEnd));
  PetscCall(PetscMalloc1(n, &ids));
  for (PetscInt i = 0; i < n; ++i) {
    const PetscInt *side, *ends;
    PetscInt        depth;

    PetscCall(PetscSectionSetDof(section, child[i], 1));
    PetscCall(DMPlexGetPointDepth(dm, child[i], &depth));
    PetscCall(DMPlexGetCone(dm, parent[i], &side));
    if (depth) PetscCall(DMPlexGetCone(dm, child[i], &ends));
    ids[i] = reference_ids[!depth ? 2 : (ends[0] == side[0] || ends[1] == side[0] ? 0 : 1)];
  }
  PetscCall(PetscSectionSetUp(section));
  PetscCall(DMPlexSetTree(dm, section, (PetscInt *)data->parents->array, ids));
  PetscCall(PetscFree(ids));
  PetscCall(PetscSectionDestroy(&section));
  PetscCall(DMDestroy(&reference));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutForestSetPointSF_Private(DM dm, const AbutPlexData *data)
{
  const PetscInt n = (PetscInt)data->leaves->elem_count;
  PetscSF        sf;
  PetscSFNode   *remote;
  PetscInt       pStart, pEnd;
  DM             cdm;

  PetscFunctionBegin;
  PetscCall(DMPlexGetChart(dm, &pStart, &pEnd));
  PetscCall(PetscMalloc1(n, &remote));
  for (PetscInt i = 0; i < n; ++i) {
    const p4est_locidx_t *r = (const p4est_locidx_t *)sc_array_index(data->remotes, (size_t)i);

    remote[i].rank  = r[0];
    remote[i].index = r[1];
  }
  PetscCall(PetscSFCreate(PetscObjectComm((PetscObject)dm), &sf));
  PetscCall(PetscSFSetGraph(sf, pEnd - pStart, n, (PetscInt *)data->leaves->array, PETSC_COPY_VALUES, remote, PETSC_OWN_POINTER));
  PetscCall(DMSetPointSF(dm, sf));
  PetscCall(DMGetCoordinateDM(dm, &cdm));
  PetscCall(DMSetPointSF(cdm, sf));
  PetscCall(PetscSFDestroy(&sf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutForestFillPlex_Private(DM dm, const AbutPlexData *data)
{
  const size_t nv          = data->coordinates->elem_count;
  PetscInt    *orientation = (PetscInt *)data->orientations->array;
  PetscScalar *xy;

  PetscFunctionBegin;
  for (size_t i = 0; i < data->orientations->elem_count; ++i)
    if (orientation[i] == -2) orientation[i] = -1; /* p4est speaks the orientation of PETSc before 3.16 */
  PetscCall(PetscMalloc1(2 * nv, &xy));
  for (size_t i = 0; i < nv; ++i)
    for (int d = 0; d < 2; ++d) xy[2 * i + d] = ((const double *)sc_array_index(data->coordinates, i))[d];
  PetscCall(DMPlexCreateFromDAG(dm, 2, (PetscInt *)data->points->array, (PetscInt *)data->conesizes->array, (PetscInt *)data->cones->array,
                                orientation, xy));
  PetscCall(PetscFree(xy));
  PetscCall(DMPlexSetMaxProjectionHeight(dm, 1));
  PetscCall(AbutForestSetTree_Private(dm, data));
  PetscCall(AbutForestSetPointSF_Private(dm, data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutForestToPlex_Private(AbutMesh mesh, p4est_t *p4est, DM *dm)
{
  AbutPlexData   data;
  sc_array_t   **array[] = {&data.points,   &data.conesizes, &data.cones,    &data.orientations, &data.coordinates,
                            &data.children, &data.parents,   &data.childids, &data.leaves,       &data.remotes};
  p4est_locidx_t first;

  PetscFunctionBegin;
  for (int i = 0; i < 10; ++i)
    *array[i] = sc_array_new(i == 4 ? 3 * sizeof(double) : (i == 9 ? 2 * sizeof(p4est_locidx_t) : sizeof(p4est_locidx_t)));
  if (mesh->balance)
    p4est_get_plex_data(p4est, P4EST_CONNECT_FULL, 0, &first, data.points, data.conesizes, data.cones, data.orientations, data.coordinates,
                        data.children, data.parents, data.childids, data.leaves, data.remotes);
  else PetscCall(AbutForestGetPlexData_Private(mesh, p4est, &data));
  PetscCall(DMCreate(PetscObjectComm((PetscObject)mesh), dm));
  PetscCall(DMSetType(*dm, DMPLEX));
  PetscCall(DMSetDimension(*dm, 2));
  PetscCall(DMSetCoordinateDim(*dm, 2));
  PetscCall(AbutForestFillPlex_Private(*dm, &data));
  for (int i = 0; i < 10; ++i) sc_array_destroy(*array[i]);
  if (mesh->first && mesh->first->curved) PetscCall(AbutTreesMove_Private(mesh, p4est, *dm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutForestGrid_Private(AbutMesh mesh, p4est_connectivity_t **connectivity)
{
  PetscFunctionBegin;
  *connectivity = p4est_connectivity_new_brick(mesh->cells[0], mesh->cells[1], 0, 0);
  for (int i = 0; i < (*connectivity)->num_vertices; ++i)
    for (int d = 0; d < 2; ++d) {
      double *v = &(*connectivity)->vertices[3 * i + d];
      *v        = AbutMeshGridLine_Private(mesh, d, (PetscInt)*v);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Equal shares of the quadrants for the ranks that have them */
static PetscErrorCode AbutForestPartition_Private(AbutMesh mesh, p4est_t *p4est)
{
  p4est_locidx_t *count;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(p4est->mpisize, &count));
  for (PetscMPIInt r = 0; r < p4est->mpisize; ++r)
    count[r] = (p4est_locidx_t)(AbutMeshShare_Private(mesh, p4est->mpisize, p4est->global_num_quadrants, r + 1) -
                                AbutMeshShare_Private(mesh, p4est->mpisize, p4est->global_num_quadrants, r));
  (void)p4est_partition_given(p4est, count);
  PetscCall(PetscFree(count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutMeshDistribute_Forest(AbutMesh mesh, DM *dm)
{
  p4est_t *p4est = ((AbutMesh_Forest *)mesh->data)->p4est;

  PetscFunctionBegin;
  PetscCall(AbutForestPartition_Private(mesh, p4est));
  PetscCall(DMDestroy(dm));
  PetscCall(AbutForestToPlex_Private(mesh, p4est, dm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutMeshCreate_Forest_DM(AbutMesh mesh, DM *dm)
{
  AbutMesh_Forest *forest = (AbutMesh_Forest *)mesh->data;

  PetscFunctionBegin;
  if (mesh->first) PetscCall(AbutTreesCreate_Private(mesh, &forest->connectivity));
  else PetscCall(AbutForestGrid_Private(mesh, &forest->connectivity));
  forest->p4est = p4est_new(PetscObjectComm((PetscObject)mesh), forest->connectivity, sizeof(AbutQuad), AbutForestBegin_Private, NULL);
  PetscCall(AbutForestPartition_Private(mesh, forest->p4est));
  PetscCall(AbutForestToPlex_Private(mesh, forest->p4est, dm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Local cell c of the DM is the c-th local quadrant */
static PetscErrorCode AbutMeshGetLevels_Forest(AbutMesh mesh, PetscInt level[])
{
  p4est_t *p4est = ((AbutMesh_Forest *)mesh->data)->p4est;
  PetscInt c     = 0;

  PetscFunctionBegin;
  for (p4est_topidx_t t = p4est->first_local_tree; t <= p4est->last_local_tree; ++t) {
    p4est_tree_t *tree = p4est_tree_array_index(p4est->trees, t);

    for (size_t q = 0; q < tree->quadrants.elem_count; ++q) level[c++] = p4est_quadrant_array_index(&tree->quadrants, q)->level;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutMeshGetSides_Forest(AbutMesh mesh, PetscInt side[])
{
  PetscFunctionBegin;
  PetscCall(AbutTreesGetSides_Private(mesh, ((AbutMesh_Forest *)mesh->data)->p4est, side));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The present cells are those of the first mesh */
static PetscErrorCode AbutMeshKeepFirst_Forest(AbutMesh mesh)
{
  p4est_t *p4est = ((AbutMesh_Forest *)mesh->data)->p4est;

  PetscFunctionBegin;
  for (p4est_topidx_t t = p4est->first_local_tree; t <= p4est->last_local_tree; ++t) {
    p4est_tree_t *tree = p4est_tree_array_index(p4est->trees, t);

    for (size_t q = 0; q < tree->quadrants.elem_count; ++q) {
      const p4est_quadrant_t *quadrant = p4est_quadrant_array_index(&tree->quadrants, q);

      AbutForestQuad_Private(quadrant)->least = quadrant->level;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutMeshRefine_Forest(AbutMesh mesh, const PetscBool marks[], DM *dm)
{
  p4est_t       *p4est  = ((AbutMesh_Forest *)mesh->data)->p4est;
  p4est_gloidx_t before = p4est->global_num_quadrants, merged;
  PetscInt       c      = 0;

  PetscFunctionBegin;
  for (p4est_topidx_t t = p4est->first_local_tree; t <= p4est->last_local_tree; ++t) {
    p4est_tree_t *tree = p4est_tree_array_index(p4est->trees, t);

    for (size_t q = 0; q < tree->quadrants.elem_count; ++q, ++c) {
      AbutQuad *quad = AbutForestQuad_Private(p4est_quadrant_array_index(&tree->quadrants, q));

      quad->mark = marks && marks[c] ? 1 : (mesh->coarsen && mesh->coarsen[c] ? -1 : 0);
      if (quad->merged == ABUT_MERGED_NOW) quad->merged = ABUT_MERGED_BEFORE;
    }
  }
  if (mesh->coarsen) { /* with siblings on one rank */
    p4est_partition(p4est, 1, NULL);
    p4est_coarsen_ext(p4est, 0, 0, AbutForestMayMerge_Private, AbutForestBegin_Private, AbutForestReplace_Private);
  }
  merged = p4est->global_num_quadrants;
  p4est_refine_ext(p4est, 0, -1, AbutForestIsMarked_Private, AbutForestBegin_Private, AbutForestReplace_Private);
  /* across sides only: the paper's extra rule */
  if (mesh->balance) p4est_balance_ext(p4est, P4EST_CONNECT_FACE, AbutForestBegin_Private, AbutForestReplace_Private);
  PetscCall(AbutForestPartition_Private(mesh, p4est));
  if (merged != before || p4est->global_num_quadrants != merged) PetscCall(AbutForestToPlex_Private(mesh, p4est, dm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutMeshDestroy_Forest(AbutMesh mesh)
{
  AbutMesh_Forest *forest = (AbutMesh_Forest *)mesh->data;

  PetscFunctionBegin;
  if (forest->p4est) p4est_destroy(forest->p4est);
  if (forest->connectivity) p4est_connectivity_destroy(forest->connectivity);
  PetscCall(PetscFree(mesh->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutMeshCreate_Forest(AbutMesh mesh)
{
  static PetscBool initialized = PETSC_FALSE;
  AbutMesh_Forest *forest;

  PetscFunctionBegin;
  if (!initialized) {
    initialized = PETSC_TRUE;
    sc_init(MPI_COMM_NULL, 0, 0, NULL, SC_LP_ERROR);
    p4est_init(NULL, SC_LP_ERROR);
  }
  PetscCall(PetscNew(&forest));
  mesh->data            = forest;
  mesh->ops->create     = AbutMeshCreate_Forest_DM;
  mesh->ops->keepfirst  = AbutMeshKeepFirst_Forest;
  mesh->ops->refine     = AbutMeshRefine_Forest;
  mesh->ops->distribute = AbutMeshDistribute_Forest;
  mesh->ops->getlevels  = AbutMeshGetLevels_Forest;
  mesh->ops->getsides   = AbutMeshGetSides_Forest;
  mesh->ops->destroy    = AbutMeshDestroy_Forest;
  PetscFunctionReturn(PETSC_SUCCESS);
}
