#include <abut/private/loopimpl.h>
#if defined(ABUT_HAVE_SLEPC)
  #include <slepceps.h>
#endif

/* The largest eigenvalue of a sweep. This is the only file that knows SLEPc, and it starts it when an eigenvalue is wanted: nobody else
   pays for it. */

#if !defined(ABUT_HAVE_SLEPC)

PetscErrorCode AbutInterfaceCheckSpectrum_Private(AbutInterface f)
{
  PetscFunctionBegin;
  AbutCheckInput(PETSC_FALSE, PetscObjectComm((PetscObject)f),
                 "snes_ddneumann_gamma_spectrum: this abut was built without SLEPc; install it and build again, or leave the key out for "
                 "the closed form");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AbutInterfaceComputeSpectrum_Private(AbutInterface f, PETSC_UNUSED PetscReal *largest)
{
  PetscFunctionBegin;
  PetscCall(AbutInterfaceCheckSpectrum_Private(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#else

  #define ABUT_SPECTRUM_RTOL  1e-4 /* of the residual; the eigenvalue is then right to the square of that, and if anything too small */
  #define ABUT_SPECTRUM_BASIS 6    /* solves of all bodies between two looks at the eigenvalue */

/* W S W on all contact nodes, S the compliance of all bodies, W_i^2 = D_i/theta: similar to dG, but symmetric */
typedef struct {
  AbutInterface    iface;
  AbutContactModel model; /* its nodes, not its compliance */
  PetscReal       *d, *q; /* [n] forces on all contact nodes and what they take from the penetrations, on every rank */
} AbutSpectrum;

PetscErrorCode AbutInterfaceCheckSpectrum_Private(PETSC_UNUSED AbutInterface f)
{
  PetscFunctionBegin;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal AbutSpectrumWeight_Private(const AbutSpectrum *s, PetscInt c)
{
  return 1. / PetscSqrtReal(s->model->soft[c]);
}

static PetscErrorCode AbutSpectrumCreate_Private(AbutInterface f, AbutSpectrum *s)
{
  PetscFunctionBegin;
  s->iface = f;
  PetscCall(AbutInterfaceGetModel_Private(f, &s->model));
  PetscCall(PetscMalloc2(s->model->n, &s->d, s->model->n, &s->q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first rank has all of v and y, and tells the others */
static PetscErrorCode AbutSpectrumMult_Private(Mat A, Vec v, Vec y)
{
  AbutSpectrum      *s;
  const PetscScalar *a;
  PetscScalar       *b;
  PetscInt           n;
  PetscMPIInt        count;

  PetscFunctionBegin;
  PetscCall(MatShellGetContext(A, &s));
  PetscCall(VecGetLocalSize(v, &n));
  PetscCall(VecGetArrayRead(v, &a));
  for (PetscInt c = 0; c < n; ++c) s->d[c] = AbutSpectrumWeight_Private(s, c) * a[c];
  PetscCall(VecRestoreArrayRead(v, &a));
  PetscCall(PetscMPIIntCast(s->model->n, &count));
  PetscCallMPI(MPI_Bcast(s->d, count, MPIU_REAL, 0, PetscObjectComm((PetscObject)s->iface)));
  PetscCall(AbutInterfaceComply_Private(s->iface, s->model, s->d, s->q));
  ++s->iface->startsweeps;
  PetscCall(VecGetArrayWrite(y, &b));
  for (PetscInt c = 0; c < n; ++c) b[c] = s->iface->linearfailed ? 0. : AbutSpectrumWeight_Private(s, c) * s->q[c];
  PetscCall(VecRestoreArrayWrite(y, &b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An even pressure, which is the mode of layers, and a little of everything else: a symmetric start would never find an antisymmetric
   mode */
static PetscErrorCode AbutSpectrumStart_Private(const AbutSpectrum *s, Vec v)
{
  PetscScalar *a;
  PetscInt     n;

  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(v, &n));
  PetscCall(VecGetArrayWrite(v, &a));
  for (PetscInt c = 0; c < n; ++c) a[c] = (1. + 0.1 * (2. * PetscFmodReal(c * 0.6180339887, 1.) - 1.)) * AbutSpectrumWeight_Private(s, c);
  PetscCall(VecRestoreArrayWrite(v, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutSpectrumStartSLEPc_Private(void)
{
  PetscBool started;

  PetscFunctionBegin;
  PetscCall(SlepcInitialized(&started));
  if (started) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SlepcInitialize(NULL, NULL, NULL, NULL));
  PetscCall(PetscRegisterFinalize(SlepcFinalize));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The largest eigenvalue of I - dG with all contact nodes closed, on the present meshes */
PetscErrorCode AbutInterfaceComputeSpectrum_Private(AbutInterface f, PetscReal *largest)
{
  MPI_Comm     comm = PetscObjectComm((PetscObject)f);
  AbutSpectrum s;
  EPS          eps;
  Mat          A;
  Vec          v;
  PetscMPIInt  rank;
  PetscInt     n, all, found;
  PetscScalar  value = 0.;

  PetscFunctionBegin;
  PetscCall(AbutSpectrumStartSLEPc_Private());
  PetscCall(AbutSpectrumCreate_Private(f, &s));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  all = s.model->n;
  n   = rank ? 0 : all;
  if (all) {
    PetscCall(MatCreateShell(comm, n, n, all, all, &s, &A));
    PetscCall(MatShellSetOperation(A, MATOP_MULT, (void (*)(void))AbutSpectrumMult_Private));
    PetscCall(MatCreateVecs(A, &v, NULL));
    PetscCall(AbutSpectrumStart_Private(&s, v));
    PetscCall(EPSCreate(comm, &eps));
    PetscCall(EPSSetOperators(eps, A, NULL));
    PetscCall(EPSSetProblemType(eps, EPS_HEP));
    PetscCall(EPSSetWhichEigenpairs(eps, EPS_LARGEST_REAL));
    PetscCall(EPSSetDimensions(eps, 1, PetscMin(all, ABUT_SPECTRUM_BASIS), PetscMin(all, ABUT_SPECTRUM_BASIS)));
    PetscCall(EPSSetTolerances(eps, ABUT_SPECTRUM_RTOL, 100));
    PetscCall(EPSSetInitialSpace(eps, 1, &v));
    PetscCall(EPSSolve(eps));
    PetscCall(EPSGetConverged(eps, &found));
    PetscCheck(found || f->linearfailed, comm, PETSC_ERR_NOT_CONVERGED, "The largest eigenvalue of a sweep was not found");
    if (found) PetscCall(EPSGetEigenvalue(eps, 0, &value, NULL));
    PetscCall(EPSDestroy(&eps));
    PetscCall(VecDestroy(&v));
    PetscCall(MatDestroy(&A));
  }
  PetscCall(PetscFree2(s.d, s.q));
  *largest = 1. + PetscMax(0., PetscRealPart(value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#endif
