/* ancf_common.h - helpers of the beam tests: the seed's cantilever, error capture, random numbers. */
#ifndef ANCF_COMMON_H
#define ANCF_COMMON_H

#include "ancf.h"
#include "testerror.h"
#include <string.h>

/* Seed Sect. 4: L = 1 m, d = 0.04 m, rho_s = 7200 kg/m^3, E = 20 MPa, along x, clamped at the origin. */
static inline PetscErrorCode SeedSpec(PetscInt elements, AncfBeamSpec *s)
{
  PetscFunctionBegin;
  PetscCall(AncfBeamSpecInit(s));
  s->end[0] = 1;
  s->elements = elements;
  s->diameter = 0.04;
  s->density = 7200;
  s->young = 20e6;
  s->end0 = ANCF_END_CLAMP;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* AncfSetFromOptions() and AncfSetUp() with options from two strings of the test's own, the second NULL for none. */
static inline PetscErrorCode SetUpWith(Ancf ancf, const char first[], const char second[])
{
  PetscOptions options;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(PetscOptionsCreate(&options));
  PetscCall(PetscOptionsInsertString(options, first));
  if (second) PetscCall(PetscOptionsInsertString(options, second));
  PetscCall(PetscOptionsPush(options));
  ierr = AncfSetFromOptions(ancf);
  if (!ierr) ierr = AncfSetUp(ancf);
  PetscCall(PetscOptionsPop());
  PetscCall(PetscOptionsDestroy(&options));
  PetscFunctionReturn(ierr);
}

/* One beam, gravity gz along z, options from a string of the test's own. *ancf is set even after an error. */
static inline PetscErrorCode BeamCreate(const AncfBeamSpec *s, PetscReal gz, const char string[], Ancf *ancf)
{
  PetscReal g[3] = {0, 0, gz};

  PetscFunctionBegin;
  PetscCall(AncfCreate(PETSC_COMM_SELF, ancf));
  PetscCall(AncfAddBeam(*ancf, s, NULL));
  PetscCall(AncfSetGravity(*ancf, g));
  PetscFunctionReturn(SetUpWith(*ancf, string, NULL));
}

/* Height of the last node of each of n beams, m. */
static inline PetscErrorCode TipHeights(Ancf ancf, PetscInt n, PetscReal tip[])
{
  const PetscReal *e;

  PetscFunctionBegin;
  PetscCall(AncfGetState(ancf, NULL, &e, NULL, NULL));
  for (PetscInt b = 0; b < n; b++) {
    AncfBeamSpec s;
    PetscInt first;

    PetscCall(AncfGetBeam(ancf, b, &s, &first, NULL));
    tip[b] = e[6 * (first + s.elements) + 2];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The call must fail with this code, and its one-line message must name the word. */
#define TEST_ERROR(call, code, word)                                                                                             \
  do {                                                                                                                           \
    PetscErrorCode te_;                                                                                                          \
    test_message[0] = 0;                                                                                                         \
    PetscCall(PetscPushErrorHandler(TestCatch, NULL));                                                                           \
    te_ = call;                                                                                                                  \
    PetscCall(PetscPopErrorHandler());                                                                                           \
    TEST(te_ == (code), "%s returned %d, expected %d", #call, (int)te_, (int)(code));                                            \
    TEST(strstr(test_message, word) != NULL, "message '%s' does not name '%s'", test_message, word);                             \
  } while (0)

/* Reproducible uniform numbers in [-1,1): 64-bit linear congruential generator. */
static inline double Random(void)
{
  static unsigned long long s = 88172645463325252ULL;

  s = s * 6364136223846793005ULL + 1442695040888963407ULL;
  return (double)(s >> 11) / 4503599627370496.0 - 1;
}

/* n beams from points to points, then joints, options; *ancf is set even after an error. */
typedef struct {
  PetscInt beam[4], node[4], n;
  AncfJointType type;
} Joint;

static inline PetscErrorCode NetCreate(PetscInt nbeams, const AncfBeamSpec *s, PetscInt njoints, const Joint *j, PetscReal gz,
                                       const char string[], Ancf *ancf)
{
  PetscReal g[3] = {0, 0, gz};
  PetscOptions options;
  PetscErrorCode ierr = PETSC_SUCCESS;

  PetscFunctionBegin;
  PetscCall(AncfCreate(PETSC_COMM_SELF, ancf));
  for (PetscInt b = 0; b < nbeams; b++) PetscCall(AncfAddBeam(*ancf, &s[b], NULL));
  for (PetscInt k = 0; k < njoints && !ierr; k++) ierr = AncfAddJoint(*ancf, j[k].type, j[k].n, j[k].beam, j[k].node, NULL);
  if (ierr) PetscFunctionReturn(ierr);
  PetscCall(AncfSetGravity(*ancf, g));
  PetscCall(PetscOptionsCreate(&options));
  PetscCall(PetscOptionsInsertString(options, string));
  PetscCall(PetscOptionsPush(options));
  ierr = AncfSetFromOptions(*ancf);
  if (!ierr) ierr = AncfSetUp(*ancf);
  PetscCall(PetscOptionsPop());
  PetscCall(PetscOptionsDestroy(&options));
  PetscFunctionReturn(ierr);
}

static inline void Place(AncfBeamSpec *s, PetscReal x0, PetscReal y0, PetscReal z0, PetscReal x1, PetscReal y1, PetscReal z1,
                         PetscInt n)
{
  const PetscReal a[3] = {x0, y0, z0}, b[3] = {x1, y1, z1};

  for (int c = 0; c < 3; c++) s->start[c] = a[c], s->end[c] = b[c];
  s->elements = n;
}

#endif
