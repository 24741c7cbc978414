#include "system.h"

/* Which of the three operators an entry belongs to */
typedef enum {
  ENTRY_V,
  ENTRY_W,
  ENTRY_D
} EntryOf;

static void Append(FembemList *list, PetscInt r, PetscInt c, PetscReal v)
{
  list->row[list->n]     = r;
  list->col[list->n]     = c;
  list->value[list->n++] = v;
}

/* Row and column are those of the operator; the list is that of the whole matrix */
static inline void AddEntry(FembemSystem *s, EntryOf of, PetscInt r, PetscInt c, PetscReal v)
{
  if (s->list) {
    Append(s->list, of == ENTRY_D ? s->nt + r : r, of == ENTRY_V ? c : s->nt + c, of == ENTRY_D ? -v : v);
    if (of == ENTRY_W) Append(s->list, s->nt + c, r, v);
  } else if (of == ENTRY_V) s->V[r + (size_t)s->nt * c] += v;
  else if (of == ENTRY_W) s->W[r + (size_t)s->nt * c] += v;
  else s->D[r + (size_t)s->nu * c] += v;
}

/* One block of a symmetric operator: unknown rows and columns into the matrix, unknown rows and given columns to the right-hand side */
static void AddSymmetric(FembemSystem *s, EntryOf of, const PetscInt row[], const PetscInt col[], const PetscReal value[],
                         const PetscReal block[])
{
  const PetscReal sign = of == ENTRY_D ? -1. : 1.;
  PetscReal      *rhs  = of == ENTRY_D ? s->g : s->f;

  for (PetscInt k = 0; k < s->rows * s->rows; ++k) {
    const PetscInt r = row[k / s->rows], c = col[k % s->rows];

    if (r >= 0 && c >= 0) AddEntry(s, of, r, c, block[k]);
    else if (r >= 0) rhs[r] -= sign * block[k] * value[k % s->rows];
  }
}

static void Transpose(PetscInt rows, const PetscReal block[], PetscReal transposed[])
{
  for (PetscInt k = 0; k < rows * rows; ++k) transposed[k] = block[rows * (k % rows) + k / rows];
}

/* W has rows of element i (tractions) and columns of element j (displacements); both may be unknown or given */
static void AddW(FembemSystem *s, const PetscInt t[], const PetscInt u[], const PetscReal tv[], const PetscReal uv[], const PetscReal W[])
{
  for (PetscInt k = 0; k < s->rows * s->rows; ++k) {
    const PetscInt r = t[k / s->rows], c = u[k % s->rows];

    if (r >= 0 && c >= 0) AddEntry(s, ENTRY_W, r, c, W[k]);
    else if (r >= 0) s->f[r] -= W[k] * uv[k % s->rows];
    else if (c >= 0) s->g[c] -= W[k] * tv[k / s->rows];
  }
}

/* W_ij and, unless only W is asked for, the symmetric V and D with both orders of the pair */
static PetscErrorCode AddPair(FembemSystem *s, PetscInt i, PetscInt j, PetscBool onlyW)
{
  const FembemLocal *li = &s->local[i], *lj = &s->local[j];
  const FembemWanted wanted = {.V = !onlyW && ((li->tfree && (lj->tfree || lj->loaded)) || (lj->tfree && li->loaded)) ? PETSC_TRUE
                                                                                                                      : PETSC_FALSE,
                               .W = li->tfree || (li->loaded && lj->ufree) ? PETSC_TRUE : PETSC_FALSE,
                               .D = !onlyW && (li->ufree || lj->ufree) ? PETSC_TRUE : PETSC_FALSE};
  FembemBlocks       block;
  PetscReal          transposed[FEMBEM_ROWS_MAX * FEMBEM_ROWS_MAX];

  PetscFunctionBegin;
  if (!wanted.V && !wanted.W && !wanted.D) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FembemPair(&s->pairing, &s->e[i], &s->e[j], (PetscBool)(i == j), wanted, &block));
  if (wanted.W) AddW(s, li->t, lj->u, li->tv, lj->uv, block.W);
  if (wanted.V) {
    AddSymmetric(s, ENTRY_V, li->t, lj->t, lj->tv, block.V);
    Transpose(s->rows, block.V, transposed);
    if (i != j) AddSymmetric(s, ENTRY_V, lj->t, li->t, li->tv, transposed);
  }
  if (wanted.D) {
    AddSymmetric(s, ENTRY_D, li->u, lj->u, lj->uv, block.D);
    Transpose(s->rows, block.D, transposed);
    if (i != j) AddSymmetric(s, ENTRY_D, lj->u, li->u, li->uv, transposed);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* In a pair the smaller element is the outer one; W needs both orders */
PetscErrorCode FembemSystemAddPair(FembemSystem *s, PetscInt i, PetscInt j)
{
  const PetscInt o = s->e[j].h < (1. - FEMBEM_SLACK) * s->e[i].h ? j : i, p = i + j - o;

  PetscFunctionBegin;
  PetscCall(AddPair(s, o, p, PETSC_FALSE));
  if (i != j) PetscCall(AddPair(s, p, o, PETSC_TRUE));
  ++s->pairs;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The mass matrix <t, u> joins unknown t to given u only */
void FembemSystemAddMass(FembemSystem *s)
{
  for (PetscInt i = 0; i < s->b->n; ++i) {
    const FembemLocal *l = &s->local[i];

    for (PetscInt k = 0; k < s->rows * s->rows; ++k) {
      const PetscInt row = k / s->rows, col = k % s->rows;

      if (l->t[row] >= 0 && row % 2 == col % 2) s->f[l->t[row]] += 0.5 * s->e[i].h * s->b->basis.mass[row / 2][col / 2] * l->uv[col];
    }
  }
}
