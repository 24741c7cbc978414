#include <abutsys.h> /*I "abutsys.h" I*/
#include <time.h>

/*@
   AbutGetProcessorTime - Processor seconds of this process since it began

   Not Collective

   Output Parameter:
.  seconds - of all its threads, to better than a microsecond; `PetscGetCPUTime()` may count in hundredths of a second

   Level: developer

.seealso: `AbutBodyGetLinearCost()`
@*/
PetscErrorCode AbutGetProcessorTime(PetscLogDouble *seconds)
{
  struct timespec now;

  PetscFunctionBegin;
  PetscCheck(!clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now), PETSC_COMM_SELF, PETSC_ERR_SYS, "No clock of the process");
  *seconds = now.tv_sec + 1e-9 * now.tv_nsec;
  PetscFunctionReturn(PETSC_SUCCESS);
}
