#include <abut/private/sysimpl.h> /*I "abutsys.h" I*/

/* Types that a class knows by name: those that have registered, and those of plugins that may be opened */

/*@C
   AbutPluginListTypes - What there is to choose from: the files of plugins, and what has registered

   Not Collective

   Input Parameters:
+  kind - such as "estimator"
.  list - what has registered
-  len  - length of `names`

   Output Parameter:
.  names - such as "fembem, zz"; empty if there are none

   Level: developer

.seealso: `AbutPluginFindType()`, `AbutPluginListAvailable()`
@*/
PetscErrorCode AbutPluginListTypes(const char kind[], PetscFunctionList list, char names[], size_t len)
{
  const char **registered = NULL;
  int          n          = 0;

  PetscFunctionBegin;
  PetscCall(AbutPluginListAvailable(kind, names, len));
  PetscCall(PetscFunctionListGet(list, &registered, &n));
  for (int i = 0; i < n && registered[i]; ++i)
    PetscCall(AbutListAddItem_Private(names, len, registered[i])); /* n counts a trailing NULL in PETSc 3.18 */
  PetscCall(PetscFree(registered));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@C
   AbutPluginFindType - The create routine of a type, from a plugin if it has not registered yet; an unknown name is bad input

   Collective

   Input Parameters:
+  comm  - the communicator
.  key   - the key the name comes from, for messages
.  kind  - such as "estimator"
.  class - such as "Estimator"
.  list  - the address of what has registered: opening a plugin adds to it
-  type  - the name

   Output Parameter:
.  create - the address of a pointer to the function that was registered

   Level: developer

.seealso: `AbutPluginListTypes()`, `AbutPluginLoad()`
@*/
PetscErrorCode AbutPluginFindType(MPI_Comm comm, const char key[], const char kind[], const char class[], const PetscFunctionList *list,
                                  const char type[], PetscVoidFunction *create)
{
  char      names[ABUT_LIST], files[ABUT_LIST];
  PetscBool found;

  PetscFunctionBegin;
  PetscCall(PetscFunctionListFind(*list, type, create));
  if (*create) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AbutPluginLoad(comm, kind, type, &found));
  PetscCall(PetscFunctionListFind(*list, type, create));
  if (*create) PetscFunctionReturn(PETSC_SUCCESS);
  AbutCheckInput(!found, comm, "%s: lib%s_%s.so was opened but registers no %s \"%s\"; its Abut%sRegister() must use the name of the file",
                 key, kind, type, kind, type, class);
  PetscCall(AbutPluginListTypes(kind, *list, names, sizeof(names)));
  PetscCall(AbutPluginListFiles_Private(kind, type, files, sizeof(files)));
  SETERRQ(comm, PETSC_ERR_USER_INPUT,
          "%s: no %s named \"%s\"; there are: %s (a plugin from elsewhere is loaded with -plugin path/to/lib%s_NAME.so%s%s)", key, kind,
          type, names[0] ? names : "none", kind, files[0] ? "; there is no " : "", files);
}
