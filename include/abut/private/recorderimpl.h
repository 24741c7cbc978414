#pragma once

#include <abutrecorder.h>
#include <petsc/private/petscimpl.h>

/* The fields of one body, numbered over all ranks: row g of a vertex field is the vertex with global number g, hanging vertices follow.
   A hanging vertex on a cut between ranks has a row for each of them. Or the fields of a side of a pair, whose cells have two corners. What
   a body, or a side, does not have is NULL. */
typedef struct {
  PetscInt nvertices, ncells; /* over all ranks */
  PetscInt corners;
  Vec      vertices;     /* [2 per vertex] coordinates */
  Vec      displacement; /* [2 per vertex] */
  IS       cells;        /* [corners per cell] rows of the vertices, counter-clockwise */
  Vec      stress;       /* [4 per cell] s11, s22, s33, s12 at the centre */
  Vec      von_mises;    /* [cell] of that stress */
  Vec      level;        /* [cell] refinement level */
  Vec      eta;          /* [cell] error indicator, NULL where none was estimated */
  Vec      pressure;     /* [vertex] of the side, as the record reads it */
  Vec      gap, normal;  /* [vertex] gap before anything moves; displacement along the outward normal */
} AbutFields;

PETSC_INTERN PetscErrorCode AbutFieldsCreate_Private(AbutBody, Vec, AbutFields *);
PETSC_INTERN PetscErrorCode AbutFieldsCreateSide_Private(AbutInterface, PetscInt, AbutPair, AbutFields *);
PETSC_INTERN PetscErrorCode AbutFieldsCreateVec_Private(MPI_Comm, const char[], PetscInt, PetscInt, PetscInt, Vec *);
PETSC_INTERN PetscErrorCode AbutFieldsDestroy_Private(AbutFields *);

/* What the index files (.xdmf, .pvd) say of one body, or the side of a pair, in one cycle */
typedef struct {
  PetscInt  cycle;
  PetscInt  step; /* load step, 0 without */
  PetscReal factor;
  char     *name;
  PetscInt  nvertices, ncells, corners;
  PetscBool has_eta;
} AbutRecorderPart;

/* One row of the CSV: the values of the first n keys */
typedef struct {
  PetscInt n;
  char   **value;
} AbutRecorderRow;

/* How fields are written; all NULL without -output */
struct _AbutRecorderOps {
  PetscErrorCode (*begincycle)(AbutRecorder);
  PetscErrorCode (*writepart)(AbutRecorder, const AbutRecorderPart *, const AbutFields *); /* one body or side */
  PetscErrorCode (*endcycle)(AbutRecorder);
};

struct _p_AbutRecorder {
  PETSCHEADER(struct _AbutRecorderOps);
  char     *record_file, *csv_file, *output_file, *profile_file; /* NULL: not asked for */
  char     *output;                                              /* output_file without its extension */
  PetscBool profile_cycles;                                      /* a profile of every cycle too */

  PetscInt      step, npairs; /* 0 without steps; pairs that are written */
  PetscReal     factor;
  AbutInterface iface;
  AbutPair     *pair;

  PetscInt nkeys, maxkeys;
  char   **key, **value; /* [nkeys] in order of first appearance */

  PetscInt         nrows, maxrows;
  AbutRecorderRow *row; /* [nrows] one per cycle, kept for the CSV only */

  PetscInt          nparts, maxparts;
  AbutRecorderPart *part;   /* [nparts] all bodies and pairs of all cycles written so far */
  PetscViewer       viewer; /* of the HDF5 file, open while a cycle is being written */
};

PETSC_INTERN PetscLogEvent ABUTRECORDER_WriteFields;

PETSC_INTERN PetscErrorCode AbutRecorderCreate_XDMF(AbutRecorder);
PETSC_INTERN PetscErrorCode AbutRecorderCreate_VTU(AbutRecorder);
