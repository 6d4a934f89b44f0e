/*
  test_ancf_locking.c - membrane locking: errors of 4, 8 and 16 elements with several quadratures, in statics and dynamics, and
  modes without stiffness. The tables of docs/beams.md are what this prints.
*/
#include "ancf_common.h"

#define RULES 6
#define CASES 5
#define SAMPLES 100
static const int rules[RULES][2] = {{1, 2}, {2, 2}, {2, 3}, {3, 3}, {5, 3}, {5, 5}};
#define DEFAULT 3
static const char *const cases[CASES] = {"elastica, alpha = 10, off by / L", "roll-up 2 pi EI/L, gap / L",
                                         "quarter arc, small load, relative", "seed swing, clamped, rms over 1 s, m",
                                         "seed swing, pinned, rms over 1 s, m"};

static PetscErrorCode Options(int rule, const char more[], size_t size, char text[])
{
  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(text, size, "-ancf_quadrature_axial %d -ancf_quadrature_bending %d %s", rules[rule][0], rules[rule][1],
                          more));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* L = 1 m, EI = 1 N m^2, EA = 1e6 N: slender, where locking shows; stretch is 1e-5. */
static PetscErrorCode Slender(PetscInt n, AncfBeamSpec *s)
{
  PetscFunctionBegin;
  PetscCall(AncfBeamSpecInit(s));
  s->end[0] = 1;
  s->elements = n;
  s->diameter = 0.01;
  s->EA = 1e6;
  s->EI = s->rhoA = 1;
  s->end0 = ANCF_END_CLAMP;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Error of one static case; a rule without enough stiffness may have no equilibrium: NaN then. */
static PetscErrorCode StaticError(int k, int rule, PetscInt n, PetscReal *err)
{
  /* Bisshopp and Drucker, alpha = 10: 1 - x/L, v/L, see test_ancf_validation */
  const PetscReal ref[2] = {1 - .5549956, .8106090}, M[3] = {0, -2 * PETSC_PI, 0}, F[3] = {0, 0, 10}, P[3] = {0, -1e-4, 0};
  const PetscReal *e;
  char text[256];
  AncfBeamSpec s;
  PetscErrorCode ierr;
  Ancf a;

  PetscFunctionBegin;
  PetscCall(Slender(n, &s));
  if (k == 2) {
    s.start[0] = s.end[1] = s.normal[2] = s.curvature = 1;
    s.end[0] = 0;
  }
  PetscCall(Options(rule, k == 1 ? "-ancf_strain engineering" : "", sizeof(text), text));
  PetscCall(BeamCreate(&s, 0, text, &a));
  if (k == 0) PetscCall(AncfAddPointLoad(a, 0, 1, F));
  if (k == 1) PetscCall(AncfSetMoment(a, 0, n, M));
  if (k == 2) PetscCall(AncfAddPointLoad(a, 0, 1, P));
  PetscCall(PetscPushErrorHandler(TestCatch, NULL));
  ierr = AncfSolveStatic(a, k == 1 ? 20 : 4);
  PetscCall(PetscPopErrorHandler());
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  e += 6 * n;
  if (k == 0) *err = PetscMax(PetscAbsReal(e[0] - ref[0]), PetscAbsReal(e[2] - ref[1]));
  if (k == 1) *err = PetscSqrtReal(e[0] * e[0] + e[2] * e[2]);
  if (k == 2) *err = PetscAbsReal((1 - e[1]) / (PETSC_PI / 4 * 1e-4) - 1);
  if (ierr) *err = NAN;
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Swing(AncfEnd end, int rule, PetscInt n, PetscReal tip[2 * SAMPLES])
{
  char text[256];
  const PetscReal *e;
  AncfBeamSpec s;
  Ancf a;

  PetscFunctionBegin;
  PetscCall(SeedSpec(n, &s));
  s.end0 = end;
  PetscCall(Options(rule, "", sizeof(text), text));
  PetscCall(BeamCreate(&s, -9.81, text, &a));
  PetscCall(AncfSetSubsteps(a, 10));
  for (PetscInt i = 0; i < SAMPLES; i++) {
    PetscCall(AncfAdvance(a, (PetscReal)(i + 1) / SAMPLES));
    PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
    tip[2 * i] = e[6 * n];
    tip[2 * i + 1] = e[6 * n + 2];
  }
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SwingError(AncfEnd end, int rule, PetscInt n, const PetscReal fine[2 * SAMPLES], PetscReal *err)
{
  PetscReal tip[2 * SAMPLES];

  PetscFunctionBegin;
  *err = NAN;
  if (rules[rule][0] == 1) PetscFunctionReturn(PETSC_SUCCESS); /* mechanisms */
  PetscCall(Swing(end, rule, n, tip));
  *err = 0;
  for (int i = 0; i < 2 * SAMPLES; i++) *err += PetscSqr(tip[i] - fine[i]) / SAMPLES;
  *err = PetscSqrtReal(*err);
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscReal err[CASES][RULES][3], fine[2][2 * SAMPLES];

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(Swing(ANCF_END_CLAMP, DEFAULT, 64, fine[0]));
  PetscCall(Swing(ANCF_END_PIN, DEFAULT, 64, fine[1]));
  for (int k = 0; k < CASES; k++) {
    printf("%s\n  axial + bending points    4 elements    8            16\n", cases[k]);
    for (int r = 0; r < RULES; r++) {
      for (int m = 0; m < 3; m++) {
        if (k < 3)
          PetscCall(StaticError(k, r, 4 << m, &err[k][r][m]));
        else
          PetscCall(SwingError(k == 3 ? ANCF_END_CLAMP : ANCF_END_PIN, r, 4 << m, fine[k - 3], &err[k][r][m]));
      }
      printf("  %d + %d                     %.2e      %.2e     %.2e\n", rules[r][0], rules[r][1], err[k][r][0], err[k][r][1],
             err[k][r][2]);
    }
  }
  for (int k = 0; k < CASES; k++) {
    /* locking goes: the error falls at least as that of a strain of second order; more points than three buy less than a tenth */
    TEST(err[k][DEFAULT][2] < err[k][DEFAULT][1] / 4, "%s: 16 elements %g after %g", cases[k], (double)err[k][DEFAULT][2],
         (double)err[k][DEFAULT][1]);
    for (int r = DEFAULT + 1; r < RULES; r++)
      TEST(err[k][DEFAULT][2] < 1.1 * err[k][r][2], "%s: %g, with more points %g", cases[k], (double)err[k][DEFAULT][2],
           (double)err[k][r][2]);
    if (k < 3) TEST(isnan(err[k][0][2]), "%s: one axial point has an equilibrium", cases[k]);
  }
  TEST(err[0][2][1] < err[0][DEFAULT][1] / 4, "two axial points do not lock in statics: %g", (double)err[0][2][1]);
  TEST(err[4][2][2] > 100 * err[4][DEFAULT][2], "two axial points shake a pinned beam's gradients: %g", (double)err[4][2][2]);
  PetscCall(PetscFinalize());
  return test_report();
}
