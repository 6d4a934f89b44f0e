/* rigidtest.h - what several tests of the rigid bodies share: the same random numbers everywhere, and checks of refusals. */
#ifndef RIGIDTEST_H
#define RIGIDTEST_H

#include "testerror.h"

/* In [0, 1); the linear congruential generator of Numerical Recipes. */
static inline PetscReal Random(void)
{
  static unsigned seed = 12345u;
  seed = seed * 1664525u + 1013904223u;
  return (PetscReal)(seed >> 8) / 16777216.;
}

/* The call must have failed with one line that holds both words. */
static inline void Refused(PetscErrorCode ierr, const char what[], const char a[], const char b[])
{
  TEST(ierr != 0, "%s was accepted", what);
  TEST(strstr(test_message, a) && strstr(test_message, b) && !strchr(test_message, '\n'),
       "%s: message \"%s\" lacks \"%s\" or \"%s\"", what, test_message, a, b);
  test_message[0] = 0;
}

#endif
