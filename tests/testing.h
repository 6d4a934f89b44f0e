/* testing.h - the checks that every C test of Frond uses: a failed check prints what was expected and is counted. */
#ifndef TESTING_H
#define TESTING_H

#include <math.h>
#include <petscsys.h>
#include <stdio.h>

static int test_checks = 0, test_failures = 0;

#define TEST(cond, ...)                                                                                                          \
  do {                                                                                                                           \
    test_checks++;                                                                                                               \
    if (!(cond)) {                                                                                                               \
      test_failures++;                                                                                                           \
      fprintf(stdout, "FAILED %s:%d: %s: ", __FILE__, __LINE__, #cond);                                                          \
      fprintf(stdout, __VA_ARGS__);                                                                                              \
      fprintf(stdout, "\n");                                                                                                     \
    }                                                                                                                            \
  } while (0)

/* |a-b| <= tol, false for NaN. */
#define TEST_NEAR(a, b, tol, what)                                                                                               \
  do {                                                                                                                           \
    double ta_ = (double)(a), tb_ = (double)(b), tt_ = (double)(tol);                                                            \
    TEST(fabs(ta_ - tb_) <= tt_, "%s: got %.12g, expected %.12g within %.3g", what, ta_, tb_, tt_);                              \
  } while (0)

/* |a-b| <= tol |b|. */
#define TEST_REL(a, b, tol, what) TEST_NEAR(a, b, (double)(tol)*fabs((double)(b)), what)

static inline int test_report(void)
{
  printf("%d checks, %d failed\n", test_checks, test_failures);
  return test_failures ? 1 : 0;
}

#endif
