#include <abut/private/bodyimpl.h> /*I "abutbody.h" I*/

/* The linear solver of a body: by its size, unless the user chooses */

/* Below this many unknowns a direct factor pays: it is used for every sweep, and takes 1 kB per unknown */
#define ABUT_DIRECT_UNKNOWNS 1000000

static PetscErrorCode AbutBodySetDirect_Private(AbutBody body)
{
  PC pc;

  PetscFunctionBegin;
  PetscCall(KSPGetPC(body->ksp, &pc));
  PetscCall(KSPSetType(body->ksp, KSPPREONLY));
  PetscCall(PCSetType(pc, PCCHOLESKY));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AbutBodySetIterative_Private(AbutBody body)
{
  PC pc;

  PetscFunctionBegin;
  PetscCall(KSPGetPC(body->ksp, &pc));
  PetscCall(KSPSetType(body->ksp, KSPCG));
  PetscCall(KSPSetNormType(body->ksp, KSP_NORM_UNPRECONDITIONED));
  PetscCall(KSPSetTolerances(body->ksp, 1e-10, PETSC_DEFAULT, PETSC_DEFAULT, 1000));
  PetscCall(KSPSetInitialGuessNonzero(body->ksp, PETSC_TRUE)); /* the last sweep's displacement */
  PetscCall(PCSetType(pc, PCHYPRE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whoever reads no options gets the direct factor */
PetscErrorCode AbutBodyCreateSolver_Private(AbutBody body)
{
  PetscFunctionBegin;
  PetscCall(KSPCreate(body->group, &body->ksp));
  PetscCall(KSPSetOptionsPrefix(body->ksp, ((PetscObject)body)->prefix));
  PetscCall(AbutBodySetDirect_Private(body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Our defaults for BoomerAMG on elasticity in the plane, the user's over them. With coarsening, interpolation and threshold of hypre's own
   CG takes half as many iterations again at 10^6 unknowns as at 10^5, with these 1.2 times as many. Chebyshev polynomials smooth alike
   however the unknowns are cut: over the nine meshes of graded quads up to 1.6 10^5 unknowns, nu = 0.3, there are 8.4 iterations a sweep
   and body on one rank and 8.8 on 16; with Gauss-Seidel, which stops at the cut, 7.3 and 8.7, and neither l1 scaling nor PMIS helps. They
   cost less: on one rank a solve takes 0.8 of the time, from nu = 0.49 on as much, and the set-up 1.25. */
static const char *const AbutMultigridDefaults[][2] = {
  {"strong_threshold", "0.4"      },
  {"coarsen_type",     "HMIS"     },
  {"interp_type",      "ext+i"    },
  {"P_max",            "4"        },
  {"relax_type_all",   "Chebyshev"}
};
#define ABUT_NDEFAULTS ((PetscInt)PETSC_STATIC_ARRAY_LENGTH(AbutMultigridDefaults))

/* Options that are there while a preconditioner is set from them, and gone afterwards */
static PetscErrorCode AbutBodySetMultigrid_Private(AbutBody body, PC pc)
{
  char      name[ABUT_NDEFAULTS][256];
  PetscBool given[ABUT_NDEFAULTS];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < ABUT_NDEFAULTS; ++i) {
    PetscCall(PetscSNPrintf(name[i], sizeof(name[i]), "-%spc_hypre_boomeramg_%s", ((PetscObject)body)->prefix,
                            AbutMultigridDefaults[i][0]));
    PetscCall(PetscOptionsHasName(NULL, NULL, name[i], &given[i]));
    if (!given[i]) PetscCall(PetscOptionsSetValue(NULL, name[i], AbutMultigridDefaults[i][1]));
  }
  PetscCall(PCSetFromOptions(pc));
  for (PetscInt i = 0; i < ABUT_NDEFAULTS; ++i)
    if (!given[i]) PetscCall(PetscOptionsClearValue(NULL, name[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Multigrid keeps what belongs to its first matrix (BoomerAMG the numbering of the unknowns, GAMG the sizes of its levels) and goes astray
   when a larger one follows: each mesh gets a new preconditioner */
static PetscErrorCode AbutBodyRenewPreconditioner_Private(AbutBody body)
{
  char      type[64];
  PetscBool factor;
  PCType    present;
  PC        pc;

  PetscFunctionBegin;
  PetscCall(KSPGetPC(body->ksp, &pc));
  PetscCall(PetscObjectTypeCompareAny((PetscObject)pc, &factor, PCCHOLESKY, PCLU, ""));
  if (factor) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PCGetType(pc, &present));
  PetscCall(PetscStrncpy(type, present, sizeof(type)));
  PetscCall(PCSetType(pc, PCNONE));
  PetscCall(PCSetType(pc, type));
  if (!strcmp(type, PCHYPRE)) PetscCall(AbutBodySetMultigrid_Private(body, pc));
  else PetscCall(PCSetFromOptions(pc));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* With the 20 per cent of spare workspace that are its default, MUMPS 5.7 returns NaN from some symmetric factors on 3 or 4 ranks, and no
   error; with 35 it did not any more. A -mat_mumps_icntl_14 of the user comes later. */
PetscErrorCode AbutBodyGiveFactorRoom_Private(AbutBody body)
{
  MatSolverType solver = NULL;
  PetscBool     mumps;
  PC            pc;
  Mat           factor;

  PetscFunctionBegin;
  PetscCall(KSPGetPC(body->ksp, &pc));
  PetscCall(PCFactorGetMatSolverType(pc, &solver));
  PetscCall(PetscStrcmp(solver, MATSOLVERMUMPS, &mumps));
  if (!mumps) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PCFactorSetUpMatSolverType(pc));
  PetscCall(PCFactorGetMatrix(pc, &factor));
  PetscCall(MatMumpsSetIcntl(factor, 14, 60));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Our defaults first, the user's options over them. Before the first mesh its size is not known, and taken as small. */
PetscErrorCode AbutBodyChooseSolver_Private(AbutBody body, PetscInt n, PetscBool readoptions)
{
  const char *prefix     = ((PetscObject)body)->prefix;
  char        pctype[64] = "";
  PetscBool   haspc, hasksp, factor, once;
  PC          pc;

  PetscFunctionBegin;
  if (readoptions || (!body->userksp && n > ABUT_DIRECT_UNKNOWNS)) {
    PetscCall(PetscOptionsGetString(NULL, prefix, "-pc_type", pctype, sizeof(pctype), &haspc));
    PetscCall(PetscOptionsHasName(NULL, prefix, "-ksp_type", &hasksp));
    body->userksp = (PetscBool)(haspc || hasksp);
    factor        = (PetscBool)(!haspc || !strcmp(pctype, PCCHOLESKY) || !strcmp(pctype, PCLU));
    PetscCall((factor && n <= ABUT_DIRECT_UNKNOWNS ? AbutBodySetDirect_Private : AbutBodySetIterative_Private)(body));
    PetscCall(KSPGetPC(body->ksp, &pc));
    if (haspc) {
      PetscCall(PCSetType(pc, pctype));
      if (factor) PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
    }
    PetscCall(KSPSetFromOptions(body->ksp));
    PetscCall(PetscObjectTypeCompare((PetscObject)body->ksp, KSPPREONLY, &once));
    if (once) PetscCall(KSPSetInitialGuessNonzero(body->ksp, PETSC_FALSE));
  }
  PetscCall(AbutBodyRenewPreconditioner_Private(body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
   AbutBodyIsDirect - Whether the linear solver of a body is nothing but a factor, so that it has no tolerance

   Not Collective

   Input Parameter:
.  body - the body

   Output Parameter:
.  direct - `PETSC_TRUE` for one application of Cholesky or LU

   Level: developer

.seealso: `AbutBodyGetKSP()`, `AbutBodyGetLinearError()`
@*/
PetscErrorCode AbutBodyIsDirect(AbutBody body, PetscBool *direct)
{
  PetscBool once;
  PC        pc;

  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)body->ksp, KSPPREONLY, &once));
  PetscCall(KSPGetPC(body->ksp, &pc));
  PetscCall(PetscObjectTypeCompareAny((PetscObject)pc, direct, PCCHOLESKY, PCLU, ""));
  if (!once) *direct = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
