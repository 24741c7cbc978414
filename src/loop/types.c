#include <abut/private/loopimpl.h> /*I "abutloop.h" I*/

/* The loops there are to choose from */

static const struct {
  const char *name, *about;
} AbutLoops[] = {
  {SNESDDACTIVE,    "active set on the contact forces, any penalty and none: the default"   },
  {SNESDDNEUMANN,   "the paper's parallel Neumann iteration with relaxation, eqs. (17)-(21)"},
  {SNESANDERSON,    "Anderson mixing of PETSc over -npc_snes_type ddneumann"                },
  {SNESNGMRES,      "nonlinear GMRES of PETSc over -npc_snes_type ddneumann"                },
  {SNESQN,          "quasi-Newton of PETSc over -npc_snes_type ddneumann"                   },
  {SNESNRICHARDSON, "Richardson of PETSc on the interface trace"                            },
  {SNESNCG,         "nonlinear conjugate gradients of PETSc on the interface trace"         }
};

/*@
   AbutLoopViewTypes - Prints the SNES types that suit the traces of a contact, a line each, and those that a plugin has registered

   Collective

   Input Parameter:
.  viewer - an ASCII viewer

   Level: intermediate

.seealso: `SNESDDACTIVE`, `SNESDDNEUMANN`, `AbutEstimatorViewTypes()`
@*/
PetscErrorCode AbutLoopViewTypes(PetscViewer viewer)
{
  const PetscInt known      = PETSC_STATIC_ARRAY_LENGTH(AbutLoops);
  const char   **registered = NULL;
  int            n          = 0;
  PetscErrorCode (*create)(SNES);

  PetscFunctionBegin;
  PetscCall(SNESInitializePackage());
  PetscCall(AbutLoopRegisterAll());
  for (PetscInt i = 0; i < known; ++i) {
    PetscCall(PetscFunctionListFind(SNESList, AbutLoops[i].name, &create));
    PetscCall(AbutPluginViewType(viewer, AbutLoops[i].name, AbutLoops[i].about, (PetscVoidFunction)create));
  }
  PetscCall(PetscFunctionListGet(SNESList, &registered, &n));
  for (int i = 0; i < n && registered[i]; ++i) {
    PetscBool petsc, ours;

    PetscCall(PetscFunctionListFind(SNESList, registered[i], &create));
    PetscCall(AbutPluginSameFile((PetscVoidFunction)create, (PetscVoidFunction)SNESCreate, &petsc));
    PetscCall(AbutPluginSameFile((PetscVoidFunction)create, (PetscVoidFunction)AbutLoopViewTypes, &ours));
    if (!petsc && !ours) PetscCall(AbutPluginViewType(viewer, registered[i], NULL, (PetscVoidFunction)create));
  }
  PetscCall(PetscFree(registered));
  PetscFunctionReturn(PETSC_SUCCESS);
}
