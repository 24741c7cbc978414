#include <abut/private/sysimpl.h>
#include <string.h>

/* Appends an item to a list like "fembem, zz" unless it is there already; where there is no room, "..." once, so that nothing of what
   follows the list in a message is lost */
PetscErrorCode AbutListAddItem_Private(char list[], size_t len, const char item[])
{
  static const char more[] = "...";
  const char       *at;
  size_t            n, used;
  PetscBool         full;

  PetscFunctionBegin;
  PetscCall(PetscStrendswith(list, more, &full));
  if (full) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscStrlen(item, &n));
  for (at = strstr(list, item); at; at = strstr(at + 1, item)) {
    if ((at == list || at[-1] == ' ') && (!at[n] || at[n] == ',')) PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscStrlen(list, &used));
  if (list[0]) PetscCall(PetscStrlcat(list, ", ", len));
  PetscCall(PetscStrlcat(list, used + n + 2 * sizeof(", ...") > len ? more : item, len));
  PetscFunctionReturn(PETSC_SUCCESS);
}
