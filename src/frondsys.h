/* frondsys.h - declarations shared by every public header of Frond: symbol visibility and C linkage. */
#ifndef FRONDSYS_H
#define FRONDSYS_H

#include <petscsys.h>

#if defined(__GNUC__)
  #define FROND_VISIBLE __attribute__((visibility("default")))
#else
  #define FROND_VISIBLE
#endif

#if defined(__cplusplus)
  #define FROND_EXTERN extern "C" FROND_VISIBLE
#else
  #define FROND_EXTERN extern FROND_VISIBLE
#endif

/* PETSc 3.18 has no PETSC_SUCCESS. */
#if PETSC_VERSION_LT(3, 19, 0)
  #define PETSC_SUCCESS ((PetscErrorCode)0)
#endif

#endif
