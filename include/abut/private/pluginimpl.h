#pragma once

#include <abutsys.h>

/* Lists of names in messages: "fembem, zz" */
PETSC_INTERN PetscErrorCode AbutListAddItem_Private(char[], size_t, const char[]);
