#include <abut/private/meshimpl.h> /*I "abutmesh.h" I*/
#include <petscblaslapack.h>
#include <petscdt.h>

/* Lagrange's functions of orders 1 to 4 with nodes at the Gauss-Lobatto points of the sides, where contact pressures live; in a quad
   products of those, in a triangle of order 3 also its middle */

/*@C
   AbutGetLobattoNodes - The Gauss-Lobatto points of a side

   Not Collective

   Input Parameter:
.  order - 1 to 4

   Output Parameters:
+  x - [order+1] the points in [-1,1], ascending
-  w - [order+1] their weights, or `NULL`; exact up to degree 2*order-1

   Level: developer

.seealso: `AbutEvaluateLobatto()`, `AbutMeshGetReferenceNodes()`
@*/
PetscErrorCode AbutGetLobattoNodes(PetscInt order, PetscReal x[], PetscReal w[])
{
  const PetscReal inner[5] = {0., 0., 0., PetscSqrtReal(0.2), PetscSqrtReal(3. / 7.)}, end = 2. / (order * (order + 1.));

  PetscFunctionBegin;
  for (PetscInt i = 0; i <= order; ++i) {
    const PetscBool outer = (PetscBool)(i == 0 || i == order), middle = (PetscBool)(2 * i == order);

    x[i] = outer ? 1. : middle ? 0. : inner[order];
    if (2 * i < order) x[i] = -x[i];
    if (w) w[i] = outer ? end : order == 2 ? 4. / 3. : order == 3 ? 5. / 6. : middle ? 32. / 45. : 49. / 90.;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutEvaluateLobatto - Lagrange's functions of the Gauss-Lobatto points of a side, and their derivatives

   Not Collective

   Input Parameters:
+  order - 1 to 4
-  s     - the point, in [-1,1]

   Output Parameters:
+  N  - [order+1] the functions
-  dN - [order+1] their derivatives, or `NULL`

   Level: developer

.seealso: `AbutGetLobattoNodes()`
@*/
PetscErrorCode AbutEvaluateLobatto(PetscInt order, PetscReal s, PetscReal N[], PetscReal dN[])
{
  PetscReal x[ABUT_SIDE_NODES_MAX];

  PetscFunctionBegin;
  PetscCall(AbutGetLobattoNodes(order, x, NULL));
  for (PetscInt i = 0; i <= order; ++i) {
    PetscReal value = 1., slope = 0.;

    for (PetscInt j = 0; j <= order; ++j) { /* the product rule, factor by factor */
      if (j == i) continue;
      slope = (slope * (s - x[j]) + value) / (x[i] - x[j]);
      value *= (s - x[j]) / (x[i] - x[j]);
    }
    N[i] = value;
    if (dN) dN[i] = slope;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutGetLobattoMassInverse - The inverse of the mass matrix of Lagrange's functions of the Gauss-Lobatto points of a side

   Not Collective

   Input Parameter:
.  order - 1 to 4

   Output Parameter:
.  inverse - [(order+1)^2] of the integrals over [-1,1] of products of two functions

   Level: developer

   Note:
   The mass matrix is that of the Gauss-Lobatto weights but for one direction, the Legendre polynomial of degree order, whose square these
   integrate as 2/order instead of 2/(2 order+1); so is the inverse.

.seealso: `AbutEvaluateLobatto()`, `AbutGetLobattoNodes()`
@*/
PetscErrorCode AbutGetLobattoMassInverse(PetscInt order, PetscReal inverse[])
{
  const PetscInt n = order + 1;
  PetscReal      x[ABUT_SIDE_NODES_MAX], w[ABUT_SIDE_NODES_MAX], P[ABUT_SIDE_NODES_MAX];

  PetscFunctionBegin;
  PetscCall(AbutGetLobattoNodes(order, x, w));
  PetscCall(PetscDTJacobiEval(n, 0., 0., x, 1, &order, P, NULL, NULL));
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = 0; j < n; ++j) inverse[n * i + j] = (i == j ? 1. / w[i] : 0.) + 0.5 * (order + 1.) * P[i] * P[j];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void AbutMonomials_Private(PetscInt order, const PetscReal xi[2], PetscReal m[], PetscReal dm[])
{
  PetscInt k = 0;

  for (PetscInt degree = 0; degree <= order; ++degree)
    for (PetscInt b = 0; b <= degree; ++b, ++k) {
      const PetscInt a = degree - b;

      m[k] = PetscPowRealInt(xi[0], a) * PetscPowRealInt(xi[1], b);
      if (!dm) continue;
      dm[2 * k]     = a ? a * PetscPowRealInt(xi[0], a - 1) * PetscPowRealInt(xi[1], b) : 0.;
      dm[2 * k + 1] = b ? b * PetscPowRealInt(xi[0], a) * PetscPowRealInt(xi[1], b - 1) : 0.;
    }
}

/* The functions in powers of the coordinates: the inverse of the powers at the nodes */
static PetscErrorCode AbutBasisSetUpTriangle_Private(AbutBasis *b)
{
  PetscReal    m[10];
  PetscScalar  work[10];
  PetscBLASInt n, pivot[10], lwork = 10, info;

  PetscFunctionBegin;
  PetscCall(PetscBLASIntCast(b->nodes, &n));
  for (PetscInt k = 0; k < b->nodes; ++k) { /* LAPACK's columns are powers, its rows nodes; then its columns are functions */
    AbutMonomials_Private(b->order, b->xi + 2 * k, m, NULL);
    for (PetscInt i = 0; i < b->nodes; ++i) b->monomial[i * b->nodes + k] = m[i];
  }
  PetscCallBLAS("LAPACKgetrf", LAPACKgetrf_(&n, &n, b->monomial, &n, pivot, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK getrf failed with info %d", (int)info);
  PetscCallBLAS("LAPACKgetri", LAPACKgetri_(&n, b->monomial, &n, pivot, work, &lwork, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK getri failed with info %d", (int)info);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void AbutBasisAddNode_Private(AbutBasis *b, PetscReal x, PetscReal y)
{
  b->xi[2 * b->nodes]       = x;
  b->xi[2 * b->nodes++ + 1] = y;
}

PetscErrorCode AbutBasisSetUp_Private(PetscInt corners, PetscInt order, AbutBasis *b)
{
  static const PetscReal quad[] = {-1., -1., 1., -1., 1., 1., -1., 1.}, triangle[] = {0., 0., 1., 0., 0., 1.};
  const PetscReal       *corner = corners == 4 ? quad : triangle;
  PetscReal              line[ABUT_SIDE_NODES_MAX];

  PetscFunctionBegin;
  PetscCall(PetscMemzero(b, sizeof(*b)));
  PetscCall(AbutGetLobattoNodes(order, line, NULL));
  b->order   = order;
  b->corners = corners;
  for (PetscInt k = 0; k < corners; ++k) AbutBasisAddNode_Private(b, corner[2 * k], corner[2 * k + 1]);
  for (PetscInt k = 0; k < corners; ++k)
    for (PetscInt i = 1; i < order; ++i) {
      const PetscReal *p = corner + 2 * k, *q = corner + 2 * ((k + 1) % corners), s = 0.5 * (1. + line[i]);

      AbutBasisAddNode_Private(b, (1. - s) * p[0] + s * q[0], (1. - s) * p[1] + s * q[1]);
    }
  if (corners == 3) {
    if (order == 3) AbutBasisAddNode_Private(b, 1. / 3., 1. / 3.);
    PetscCall(AbutBasisSetUpTriangle_Private(b));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt j = 1; j < order; ++j)
    for (PetscInt i = 1; i < order; ++i) AbutBasisAddNode_Private(b, line[i], line[j]);
  for (PetscInt k = 0; k < b->nodes; ++k)
    for (PetscInt i = 0; i <= order; ++i) {
      if (PetscAbsReal(b->xi[2 * k] - line[i]) < 1e-8) b->row[k] = i;
      if (PetscAbsReal(b->xi[2 * k + 1] - line[i]) < 1e-8) b->column[k] = i;
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* N[nodes] and their derivatives dN[2*nodes] in the reference coordinates */
void AbutBasisEvaluate_Private(const AbutBasis *b, const PetscReal xi[2], PetscReal N[], PetscReal dN[])
{
  if (b->corners == 4) {
    PetscReal f[2][ABUT_SIDE_NODES_MAX], df[2][ABUT_SIDE_NODES_MAX];

    for (PetscInt d = 0; d < 2; ++d) (void)AbutEvaluateLobatto(b->order, xi[d], f[d], df[d]); /* cannot fail */
    for (PetscInt k = 0; k < b->nodes; ++k) {
      N[k]          = f[0][b->row[k]] * f[1][b->column[k]];
      dN[2 * k]     = df[0][b->row[k]] * f[1][b->column[k]];
      dN[2 * k + 1] = f[0][b->row[k]] * df[1][b->column[k]];
    }
  } else {
    PetscReal m[10], dm[20];

    AbutMonomials_Private(b->order, xi, m, dm);
    for (PetscInt k = 0; k < b->nodes; ++k) {
      N[k] = dN[2 * k] = dN[2 * k + 1] = 0.;
      for (PetscInt i = 0; i < b->nodes; ++i) {
        N[k] += b->monomial[k * b->nodes + i] * m[i];
        dN[2 * k] += b->monomial[k * b->nodes + i] * dm[2 * i];
        dN[2 * k + 1] += b->monomial[k * b->nodes + i] * dm[2 * i + 1];
      }
    }
  }
}

/*@C
   AbutMeshEvaluateBasis - The shape functions of a mesh and their derivatives at a reference point

   Not Collective

   Input Parameters:
+  mesh - the mesh, set up
-  xi   - [2] reference point

   Output Parameters:
+  N  - [nodes] shape functions
-  dN - [2*nodes] their derivatives in the reference coordinates

   Level: developer

.seealso: `AbutMeshMapCell()`, `AbutMeshGetReferenceNodes()`
@*/
PetscErrorCode AbutMeshEvaluateBasis(AbutMesh mesh, const PetscReal xi[2], PetscReal N[], PetscReal dN[])
{
  PetscFunctionBegin;
  AbutBasisEvaluate_Private(&mesh->basis, xi, N, dN);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutMeshGetReferenceNodes - Where the nodes of a cell lie in the reference cell

   Not Collective

   Input Parameter:
.  mesh - the mesh, set up

   Output Parameter:
.  xi - [2*nodes] reference points in the order of `AbutMeshTopology`, owned by the mesh

   Level: developer

.seealso: `AbutMeshMapCell()`, `AbutMeshSetOrder()`
@*/
PetscErrorCode AbutMeshGetReferenceNodes(AbutMesh mesh, const PetscReal *xi[])
{
  PetscFunctionBegin;
  *xi = mesh->basis.xi;
  PetscFunctionReturn(PETSC_SUCCESS);
}
