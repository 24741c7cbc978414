#include <petscdt.h>
#include "farimpl.h"

/* Of the polynomials on each element with powers about the centre of its leaf */
PetscErrorCode FembemFarSetIntegrals(FembemFar f)
{
  const PetscInt order = f->s->b->order, npoints = (f->terms + order + 3) / 2;
  PetscReal     *x, *weight, P[ABUT_SIDE_NODES_MAX];

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(npoints, &x, npoints, &weight));
  PetscCall(PetscDTGaussQuadrature(npoints, -1., 1., x, weight));
  for (PetscInt id = 0; id < f->clusters.n; ++id) {
    const FembemCluster *cl = &f->clusters.cluster[id];

    for (PetscInt i = cl->first; cl->left < 0 && i < cl->end; ++i) {
      const FembemElement *e   = &f->s->e[i];
      PetscComplex        *sum = f->integral + (size_t)f->stride * i;

      for (PetscInt g = 0; g < npoints; ++g) {
        const PetscComplex s     = e->a - cl->c + (0.5 + 0.5 * x[g]) * e->t;
        PetscComplex       power = 0.5 * weight[g] * e->h;

        FembemLegendreP(order, x[g], P);
        for (PetscInt k = 0; k < f->terms; ++k, power *= s / FembemRadius(cl))
          for (PetscInt n = 0; n <= order; ++n) {
            sum[(order + 1) * k + n] += P[n] * power;
            sum[(order + 1) * (f->terms + k) + n] += P[n] * power * PetscConjComplex(s);
          }
      }
    }
  }
  PetscCall(PetscFree2(x, weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the moments of an element of a leaf */
void FembemFarAddElement(FembemFar f, PetscInt i, const PetscReal t[], const PetscReal u[], FembemMoments m[])
{
  const FembemSystem *s     = f->s;
  const FembemBasis  *basis = &s->b->basis;
  const PetscInt      n     = basis->order + 1;
  const PetscReal     toarc = 2. / s->e[i].h;

  for (PetscInt l = 0; l < n; ++l) {
    PetscReal T[2] = {0., 0.}, U[2] = {0., 0.}, E[2] = {0., 0.};

    for (PetscInt k = 0; k < n; ++k)
      for (PetscInt c = 0; c < 2; ++c) {
        const PetscReal v = u[2 * AbutBoundaryNode(s->b, i, k) + c];

        T[c] += basis->coefficient[l][k] * t[s->rows * i + 2 * k + c];
        U[c] += toarc * basis->derivative[l][k] * v;
        E[c] += basis->coefficient[l][k] * v;
      }
    for (PetscInt k = 0; k < f->terms; ++k) {
      const PetscComplex *in = f->integral + (size_t)f->stride * i + n * k + l, a = in[0], b = in[n * f->terms];
      const PetscComplex  dt = a * PetscConjComplex(s->e[i].em);

      for (PetscInt c = 0; c < 2; ++c) {
        m[k][FEMBEM_T1 + c] += T[c] * a;
        m[k][FEMBEM_U1 + c] += U[c] * a;
        m[k][FEMBEM_E1 + c] += E[c] * dt;
      }
      m[k][FEMBEM_TC] += PetscCMPLX(T[0], T[1]) * b;
      m[k][FEMBEM_UC] += PetscCMPLX(U[0], U[1]) * b;
    }
  }
}

/* Transposed: adds what the element's nodes see */
void FembemFarSeeElement(FembemFar f, PetscInt i, const FembemMoments v[], PetscReal t[], PetscReal u[])
{
  const FembemSystem *s     = f->s;
  const FembemBasis  *basis = &s->b->basis;
  const PetscInt      n     = basis->order + 1;
  const PetscReal     toarc = 2. / s->e[i].h;

  for (PetscInt l = 0; l < n; ++l) {
    PetscComplex T[2] = {0., 0.}, U[2] = {0., 0.}, E[2] = {0., 0.}, TC = 0., UC = 0.;

    for (PetscInt k = 0; k < f->terms; ++k) {
      const PetscComplex *in = f->integral + (size_t)f->stride * i + n * k + l, a = in[0], b = in[n * f->terms];

      for (PetscInt c = 0; c < 2; ++c) {
        T[c] += v[k][FEMBEM_T1 + c] * a;
        U[c] += v[k][FEMBEM_U1 + c] * a;
        E[c] += v[k][FEMBEM_E1 + c] * a;
      }
      TC += v[k][FEMBEM_TC] * b;
      UC += v[k][FEMBEM_UC] * b;
    }
    for (PetscInt c = 0; c < 2; ++c) { /* Re(i z) = -Im z */
      const PetscReal onT = PetscRealPartComplex(T[c]) + (c ? -PetscImaginaryPartComplex(TC) : PetscRealPartComplex(TC));
      const PetscReal onU = PetscRealPartComplex(U[c]) + (c ? -PetscImaginaryPartComplex(UC) : PetscRealPartComplex(UC));
      const PetscReal onE = PetscRealPartComplex(E[c] * PetscConjComplex(s->e[i].em));

      for (PetscInt k = 0; k < n; ++k) {
        t[s->rows * i + 2 * k + c] += basis->coefficient[l][k] * onT;
        u[2 * AbutBoundaryNode(s->b, i, k) + c] += toarc * basis->derivative[l][k] * onU + basis->coefficient[l][k] * onE;
      }
    }
  }
}
