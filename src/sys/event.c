#include <abutsys.h> /*I "abutsys.h" I*/

/*@C
   AbutLogEventGet - The event of something that few scenes ask for, registered when it is first asked for

   Not Collective, to be called by all ranks

   Input Parameters:
+  name    - of the event in `-log_view`
-  classid - of the class it belongs to, or `PETSC_OBJECT_CLASSID`

   Output Parameter:
.  event - the event, for `PetscLogEventBegin()`

   Level: developer

   Note:
   A run that does not come here has no such event. Looking it up takes longer than `PetscLogEventBegin()`: keep it where calls are many.

.seealso: `AbutEffectGetEvent()`
@*/
PetscErrorCode AbutLogEventGet(const char name[], PetscClassId classid, PetscLogEvent *event)
{
  PetscFunctionBegin;
  PetscCall(PetscLogEventGetId(name, event));
  if (*event < 0) PetscCall(PetscLogEventRegister(name, classid, event));
  PetscFunctionReturn(PETSC_SUCCESS);
}
