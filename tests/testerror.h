/* testerror.h - PETSc errors caught: the one-line message of the call that failed. Tests that include it say something of bad
 * input. */
#ifndef TESTERROR_H
#define TESTERROR_H

#include "testing.h"
#include <string.h>

static char test_message[2048]; /* of the last error caught */

static inline PetscErrorCode TestCatch(MPI_Comm comm, int line, const char *fun, const char *file, PetscErrorCode n,
                                       PetscErrorType p, const char *mess, void *ctx)
{
  (void)comm, (void)line, (void)fun, (void)file, (void)ctx;
  if (p == PETSC_ERROR_INITIAL && mess) snprintf(test_message, sizeof(test_message), "%s", mess);
  return n;
}

/* The call must fail, and its message must name the words. */
#define TEST_REFUSED(call, words)                                                                                                \
  do {                                                                                                                           \
    PetscErrorCode te_;                                                                                                          \
    test_message[0] = 0;                                                                                                         \
    PetscCall(PetscPushErrorHandler(TestCatch, NULL));                                                                           \
    te_ = call;                                                                                                                  \
    PetscCall(PetscPopErrorHandler());                                                                                           \
    TEST(te_ &&strstr(test_message, words), "%s: error %d, message '%s' does not name '%s'", #call, (int)te_, test_message,      \
         words);                                                                                                                 \
  } while (0)

#endif
