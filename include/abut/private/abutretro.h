#pragma once

/* The only file that knows PETSc versions: Debian 12 ships 3.18, Debian 13 ships 3.22 */
#include <petscsys.h>

#if PETSC_VERSION_LT(3, 18, 0)
  #error "Abut needs PETSc 3.18 or newer; point PETSC_DIR or PKG_CONFIG_PATH to one"
#endif
#if !PetscDefined(USE_REAL_DOUBLE) || PetscDefined(USE_COMPLEX) || PetscDefined(USE_64BIT_INDICES)
  #error "Abut needs a PETSc with real double scalars and 32-bit indices (p4est's local index type)"
#endif
#if PETSC_VERSION_LT(3, 19, 0)
  #define PETSC_SUCCESS ((PetscErrorCode)0)
#endif
#if PETSC_VERSION_LT(3, 20, 0)
  #define PetscAssertPointer(p, i) PetscValidPointer(p, i)
#endif
#if PETSC_VERSION_LT(3, 23, 0)
typedef PetscOptionItems *AbutOptionItems;
#else
typedef PetscOptionItems AbutOptionItems;
#endif
