#include "chain.h"

/*
   Least squares for unknowns on a closed chain, in proportion to their number: a row has two neighbours, the last unknown is next to the
   first one. Givens's rotations make of each row as it comes one of an upper triangle (A. George and M. T. Heath, Linear Algebra Appl. 34,
   1980), which has entries beside the diagonal and in its last column alone.
*/

/* Makes the first entry of the row zero */
static void Rotate(FembemChainRow *R, FembemChainRow *row)
{
  const FembemChainRow a = *R, b = *row;
  const PetscReal      r = hypot(a.own, b.own), c = r > 0. ? a.own / r : 1., s = r > 0. ? b.own / r : 0.;

  *R   = (FembemChainRow){.own = r, .next = c * a.next + s * b.next, .last = c * a.last + s * b.last, .rhs = c * a.rhs + s * b.rhs};
  *row = (FembemChainRow){.own = 0., .next = c * b.next - s * a.next, .last = c * b.last - s * a.last, .rhs = c * b.rhs - s * a.rhs};
}

/* Adds a row of first unknown k to the triangle R[n], which is zero at first; of k = n - 1 only the last entry is there */
void FembemChainAdd(PetscInt n, FembemChainRow R[], PetscInt k, FembemChainRow row)
{
  for (; k < n - 1 && (row.own != 0. || row.next != 0.); ++k) {
    Rotate(&R[k], &row);
    row.own  = row.next;
    row.next = 0.;
  }
  row.own  = row.last;
  row.last = 0.;
  Rotate(&R[n - 1], &row);
}

/* An end of the chain determines what follows it, so that only a chain without ends leaves an unknown free, the last one if its entry is
   below the given one; then x is the solution of least norm */
PetscErrorCode FembemChainSolve(PetscInt n, const FembemChainRow R[], PetscReal least, PetscReal x[])
{
  const PetscBool isfree = (PetscBool)(R[n - 1].own <= least);
  PetscReal      *v, vx = 0., vv = 0.;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &v));
  x[n - 1] = isfree ? 0. : R[n - 1].rhs / R[n - 1].own;
  v[n - 1] = isfree ? 1. : 0.;
  for (PetscInt k = n - 2; k >= 0; --k) {
    x[k] = (R[k].rhs - R[k].next * x[k + 1] - R[k].last * x[n - 1]) / R[k].own;
    v[k] = (-R[k].next * v[k + 1] - R[k].last * v[n - 1]) / R[k].own;
  }
  for (PetscInt k = 0; k < n; ++k) {
    vx += v[k] * x[k];
    vv += v[k] * v[k];
  }
  for (PetscInt k = 0; isfree && k < n; ++k) x[k] -= vx / vv * v[k];
  PetscCall(PetscFree(v));
  PetscFunctionReturn(PETSC_SUCCESS);
}
