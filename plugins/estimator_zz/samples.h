#pragma once

#include <abutbody.h>

/* The finite-element stress at Gauss points of all local cells */
#define ABUT_SAMPLES_MAX (ABUT_ORDER_MAX * ABUT_ORDER_MAX)
typedef struct {
  PetscInt   n;                        /* of a cell */
  PetscReal  xi[2 * ABUT_SAMPLES_MAX]; /* reference points */
  PetscReal  w[ABUT_SAMPLES_MAX];
  PetscReal  N[ABUT_CELL_NODES_MAX * ABUT_SAMPLES_MAX];   /* [nodes] shape functions at each */
  PetscReal  low[ABUT_CELL_NODES_MAX * ABUT_SAMPLES_MAX]; /* [n] per node: what the lower part of a function is there, by its samples */
  PetscReal *s;                                           /* [3*n*ncells] */
} AbutSamples;

PETSC_INTERN PetscErrorCode AbutSamplesCreate_Private(AbutBody, AbutMesh, const AbutMeshTopology *, AbutSamples **);
PETSC_INTERN PetscErrorCode AbutSamplesKeep_Private(const AbutSamples *, const AbutMeshTopology *, PetscInt, PetscReal[]);
PETSC_INTERN PetscErrorCode AbutSamplesDestroy_Private(AbutSamples **);
