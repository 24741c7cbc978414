/* ranks: 1 2 3 4 */
/* The dense compliance, kept whole or shared by the ranks: S_ij = min(t_i, t_j) of ascending t, whose products are sums and whose inverse
   has three diagonals */
#include "ck.h"
#include <abut/private/loopimpl.h>

static const PetscInt sizes[] = {1, 2, 3, 5, 64, 150, 211};

static PetscReal Place(PetscInt i)
{
  return i + 1. + 0.5 * PetscSinReal((PetscReal)i);
}

static PetscReal Value(PetscInt i)
{
  return PetscCosReal(3. * i);
}

static AbutCompliance Create(PetscInt n, PetscBool shared)
{
  AbutCompliance S;
  PetscReal     *column;
  PetscInt       from, to;
  PetscMPIInt    size;

  CkOk(AbutComplianceCreate_Private(PETSC_COMM_WORLD, n, shared ? 0 : n, &S));
  CkOk(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  ck_assert_int_eq(S->shared, shared && size > 1);
  column = AbutComplianceGetColumns_Private(S, &from, &to);
  ck_assert_int_le(to - from, n / size + 1);
  for (PetscInt j = from; j < to; ++j)
    for (PetscInt i = 0; i < n; ++i) column[(j - from) * n + i] = Place(PetscMin(i, j));
  CkOk(AbutComplianceAssemble_Private(S));
  return S;
}

/* The same on all ranks, to the last bit */
static void CheckAlike(PetscInt n, const PetscReal x[])
{
  PetscReal *least, *most;

  CkOk(PetscMalloc2(n, &least, n, &most));
  CkOk(MPI_Allreduce(x, least, (PetscMPIInt)n, MPIU_REAL, MPI_MIN, PETSC_COMM_WORLD));
  CkOk(MPI_Allreduce(x, most, (PetscMPIInt)n, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  for (PetscInt i = 0; i < n; ++i) ck_assert(least[i] == most[i]);
  CkOk(PetscFree2(least, most));
}

START_TEST(products_sums_and_diagonals)
{
  const PetscInt n = sizes[_i / 2];
  AbutCompliance S = Create(n, (PetscBool)(_i % 2));
  PetscReal     *x, *y, *V, *W, vx = 0., wx = 0.;

  CkOk(PetscMalloc4(n, &x, n, &y, 2 * n, &V, 2 * n, &W));
  for (PetscInt i = 0; i < n; ++i) {
    x[i] = Value(i);
    V[i] = W[i] = 0.1 * Value(2 * i); /* 0.01 aa' - bb' */
    V[n + i]    = Value(3 * i + 1);
    W[n + i]    = -V[n + i];
    vx += W[i] * x[i];
    wx += W[n + i] * x[i];
  }
  CkOk(AbutComplianceAdd_Private(S, 2, V, W));
  CkOk(AbutComplianceMult_Private(S, x, y));
  CheckAlike(n, y);
  for (PetscInt i = 0; i < n; ++i) {
    PetscReal sum = V[i] * vx + V[n + i] * wx;

    for (PetscInt j = 0; j < n; ++j) sum += Place(PetscMin(i, j)) * x[j];
    ck_assert_double_eq_tol(y[i], sum, 1e-13 * n * n);
  }
  CkOk(AbutComplianceGetDiagonal_Private(S, y));
  CheckAlike(n, y);
  for (PetscInt i = 0; i < n; ++i) ck_assert_double_eq_tol(y[i], Place(i) + V[i] * W[i] + V[n + i] * W[n + i], 1e-13 * n);
  CkOk(PetscFree4(x, y, V, W));
  CkOk(AbutComplianceDestroy_Private(&S));
}
END_TEST

/* The value of (min(t_i, t_j))^{-1} x at the k-th of na places */
static PetscReal Inverse(PetscInt na, const PetscInt active[], const PetscReal x[], PetscInt k)
{
  const PetscReal left  = Place(active[k]) - (k ? Place(active[k - 1]) : 0.),
                  right = k + 1 < na ? Place(active[k + 1]) - Place(active[k]) : 0.;
  PetscReal sum         = (x[k] - (k ? x[k - 1] : 0.)) / left;

  if (k + 1 < na) sum -= (x[k + 1] - x[k]) / right;
  return sum;
}

/* All nodes, every third, the first ones, the last one; without softness, where the inverse is known, and with it */
START_TEST(factors_of_any_part)
{
  const PetscInt n = sizes[_i / 2];
  AbutCompliance S = Create(n, (PetscBool)(_i % 2));
  PetscReal     *soft, *X, *B;
  PetscInt      *active;

  CkOk(PetscMalloc4(n, &soft, 2 * n, &X, 2 * n, &B, n, &active));
  for (PetscInt way = 0; way < 8; ++way) {
    const PetscInt which = way / 2;
    PetscInt       na    = 0;

    for (PetscInt i = 0; i < n; ++i) {
      soft[i] = way % 2 ? 0.1 * (i % 7) : 0.;
      if (which == 0 || (which == 1 && i % 3 == 1) || (which == 2 && i <= n / 3) || (which == 3 && i == n - 1)) active[na++] = i;
    }
    if (!na) continue;
    for (PetscInt i = 0; i < 2 * na; ++i) X[i] = B[i] = Value(i);
    CkOk(AbutComplianceFactor_Private(S, na, active, soft));
    CkOk(AbutComplianceSolve_Private(S, 2, X));
    CheckAlike(2 * na, X);
    for (PetscInt i = 0; i < 2 * na; ++i) {
      PetscReal sum = soft[active[i % na]] * X[i];

      for (PetscInt j = 0; j < na; ++j) sum += Place(PetscMin(active[i % na], active[j])) * X[i / na * na + j];
      ck_assert_double_eq_tol(sum, B[i], 1e-12 * n);
      if (!(way % 2)) ck_assert_double_eq_tol(X[i], Inverse(na, active, B + i / na * na, i % na), 1e-12 * n);
    }
  }
  CkOk(PetscFree4(soft, X, B, active));
  CkOk(AbutComplianceDestroy_Private(&S));
}
END_TEST

int main(int argc, char **argv)
{
  Suite *suite = suite_create("compliance");
  TCase *tc    = tcase_create("compliance");
  int    status;

  if (AbutInitialize(&argc, &argv, NULL)) return 1;
  tcase_set_timeout(tc, 0);
  tcase_add_loop_test(tc, products_sums_and_diagonals, 0, 2 * PETSC_STATIC_ARRAY_LENGTH(sizes));
  tcase_add_loop_test(tc, factors_of_any_part, 0, 2 * PETSC_STATIC_ARRAY_LENGTH(sizes));
  suite_add_tcase(suite, tc);
  status = CkRun(suite);
  return AbutFinalize() ? 1 : status;
}
