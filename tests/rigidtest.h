/* rigidtest.h - what several tests of the rigid bodies share: the same random numbers everywhere, and checks of refusals. */
#ifndef RIGIDTEST_H
#define RIGIDTEST_H

#include "testing.h"
#include <string.h>

/* In [0, 1); the linear congruential generator of Numerical Recipes. */
static inline PetscReal Random(void)
{
  static unsigned seed = 12345u;
  seed = seed * 1664525u + 1013904223u;
  return (PetscReal)(seed >> 8) / 16777216.;
}

static char message[1024]; /* of the last error while Catch() is on the stack of error handlers */

static inline PetscErrorCode Catch(MPI_Comm comm, int line, const char *fun, const char *file, PetscErrorCode n, PetscErrorType p,
                                   const char *mess, void *ctx)
{
  (void)comm, (void)line, (void)fun, (void)file, (void)ctx;
  if (p == PETSC_ERROR_INITIAL) snprintf(message, sizeof(message), "%s", mess);
  return n;
}

/* The call must have failed with one line that holds both words. */
static inline void Refused(PetscErrorCode ierr, const char what[], const char a[], const char b[])
{
  TEST(ierr != 0, "%s was accepted", what);
  TEST(strstr(message, a) && strstr(message, b) && !strchr(message, '\n'), "%s: message \"%s\" lacks \"%s\" or \"%s\"", what,
       message, a, b);
  message[0] = 0;
}

#endif
