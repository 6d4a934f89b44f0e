/*
  couplethreads.c - surfaces among threads.

  Surfaces write to memory of their own only, so the results do not depend on the threads. The function for one surface calls
  PETSc for nothing but errors; a PETSc with a debugging stack, which threads may not share, has the surfaces one by one.
*/
#include "coupleimpl.h"

/* Waking a thread takes as long as some ten surfaces. */
#define COUPLE_SHARED 64

PetscBool CoupleShares(Couple c, const CoupleSlot *s)
{
  return s->surface->prepare && c->nshared >= COUPLE_SHARED ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode CouplePrepare(Couple c)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < c->n; i++)
    if (CoupleShares(c, &c->slot[i])) PetscCall((*c->slot[i].surface->prepare)(c->slot[i].surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleShare(Couple c, CoupleSlotWork work, PetscReal number)
{
  int ierr = 0;

  PetscFunctionBegin;
  if (c->nshared < COUPLE_SHARED) PetscFunctionReturn(PETSC_SUCCESS);
#if !PetscDefined(USE_DEBUG) || PetscDefined(HAVE_THREADSAFETY)
  #pragma omp parallel for schedule(static) reduction(max : ierr)
#endif
  for (PetscInt i = 0; i < c->n; i++) {
    int e;

    if (!CoupleShares(c, &c->slot[i])) continue;
    e = (int)(*work)(c, &c->slot[i], number);
    ierr = PetscMax(ierr, e);
  }
  PetscCall((PetscErrorCode)ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}
