/*
  plugin.c - what libfrond.so gives to a PETSc program that loads it with -dll_append .../libfrond.so: its solvers by name.

  PETSc looks for PetscDLLibraryRegister_ followed by the library's name. The program is neither changed nor recompiled.
*/
#include "blocktri.h"

FROND_EXTERN PetscErrorCode PetscDLLibraryRegister_frond(void);

/* Registers the preconditioner "blocktri" (PCBLOCKTRI). */
PetscErrorCode PetscDLLibraryRegister_frond(void)
{
  PetscFunctionBegin;
  PetscCall(PCBlockTriRegister());
  PetscFunctionReturn(PETSC_SUCCESS);
}
