/*
  test_host_state.c - stepping for programs that own the time loop.

  Rolling back: the steps after a save and the same steps after going back there end in the same bits, everywhere in a run, with
  the search structure of the fluid rebuilt in between or not, for every integrator of the fluid; two states may be kept at once.
  Two couplings in one program, stepped in turn, end in the bits that each ends in alone.
*/
#include "host_scene.h"

static PetscErrorCode Steps(Scene *s, PetscInt n, PetscReal tmax)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < n; i++) PetscCall(CoupleStep(s->couple, tmax, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Step, back, step: same bits; and the balance and loads come back too. */
static PetscErrorCode TestBack(const char *integrator)
{
  PetscReal *before, *first, *again, *back, t0, t1, t2;
  CoupleState state = NULL, later = NULL;
  CoupleBalance b1, b2;
  CoupleAudit a1, a2;
  PetscInt n, step1, step2, total = 0;
  Scene s;

  PetscFunctionBegin;
  PetscCall(PetscOptionsSetValue(NULL, "-sph_integrator", integrator));
  PetscCall(SceneCreate(BuiltinBeam, &s));
  for (PetscInt round = 0; round < 3; round++) { /* from the very start, then after 1 and 2 steps more */
    PetscCall(Steps(&s, round, 10.0));
    PetscCall(CoupleGetTime(s.couple, &t0, NULL));
    PetscCall(CoupleSaveState(s.couple, &state));
    PetscCall(SceneNumbers(&s, &n, &before));
    PetscCall(Steps(&s, 7, 10.0));
    PetscCall(CoupleSaveState(s.couple, &later));
    PetscCall(Steps(&s, 8, 10.0));
    PetscCall(CoupleGetTime(s.couple, &t1, &step1));
    PetscCall(CoupleGetBalance(s.couple, &b1));
    PetscCall(CoupleGetAudit(s.couple, s.beam, &a1));
    PetscCall(SceneNumbers(&s, &n, &first));
    PetscCall(CoupleRestoreState(s.couple, state));
    PetscCall(SceneNumbers(&s, &n, &back));
    PetscCall(Steps(&s, 15, 10.0)); /* without saving on the way, but the integrators began anew at `later` in the first pass */
    PetscCall(CoupleRestoreState(s.couple, later));
    PetscCall(Steps(&s, 8, 10.0));
    PetscCall(CoupleGetTime(s.couple, &t2, &step2));
    PetscCall(CoupleGetBalance(s.couple, &b2));
    PetscCall(CoupleGetAudit(s.couple, s.beam, &a2));
    PetscCall(SceneNumbers(&s, &n, &again));
    TEST(DifferentBits(n, before, back) == 0, "%s, round %d: %d of %d numbers differ after going back", integrator, (int)round,
         (int)DifferentBits(n, before, back), (int)n);
    TEST(DifferentBits(n, first, again) == 0, "%s, round %d: %d of %d numbers differ when stepped again", integrator, (int)round,
         (int)DifferentBits(n, first, again), (int)n);
    TEST(t1 == t2 && step1 == step2 && t1 > t0, "time %g step %d, again %g %d", (double)t1, (int)step1, (double)t2, (int)step2);
    TEST(!memcmp(&b1, &b2, sizeof(b1)) && !memcmp(&a1, &a2, sizeof(a1)), "balance and audit differ when stepped again");
    TEST(DifferentBits(n, before, again) > n / 2, "only %d of %d numbers changed in 15 steps",
         (int)DifferentBits(n, before, again), (int)n);
    total += DifferentBits(n, first, again);
    PetscCall(PetscFree(before));
    PetscCall(PetscFree(first));
    PetscCall(PetscFree(again));
    PetscCall(PetscFree(back));
  }
  printf("%-10s 3 rounds of 15 steps, back and again: %" PetscInt_FMT " of %" PetscInt_FMT " numbers differ\n", integrator, total,
         n);
  PetscCall(CoupleStateDestroy(&state));
  PetscCall(CoupleStateDestroy(&later));
  PetscCall(SceneDestroy(&s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Steps straight after one save, then back and the same steps. */
static PetscErrorCode TestOneState(void)
{
  PetscReal *first, *again;
  CoupleState state = NULL;
  PetscInt n;
  Scene s;

  PetscFunctionBegin;
  PetscCall(SceneCreate(BuiltinBeam, &s));
  PetscCall(Steps(&s, 5, 10.0));
  PetscCall(CoupleSaveState(s.couple, &state));
  PetscCall(Steps(&s, 40, 10.0)); /* markers move far enough for several rebuilds of the search structure */
  PetscCall(SceneNumbers(&s, &n, &first));
  for (int k = 0; k < 2; k++) {
    PetscCall(CoupleRestoreState(s.couple, state));
    PetscCall(Steps(&s, 40, 10.0));
    PetscCall(SceneNumbers(&s, &n, &again));
    TEST(DifferentBits(n, first, again) == 0, "%d of %d numbers differ after 40 steps, time %d",
         (int)DifferentBits(n, first, again), (int)n, k);
    PetscCall(PetscFree(again));
  }
  PetscCall(PetscFree(first));
  PetscCall(CoupleStateDestroy(&state));
  PetscCall(SceneDestroy(&s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestInstances(void)
{
  PetscReal *alone, *a, *b, t;
  PetscInt n, m;
  const PetscReal *x, *v, *f;
  Scene one, two, three;

  PetscFunctionBegin;
  PetscCall(SceneCreate(BuiltinBeam, &one));
  PetscCall(Steps(&one, 25, 10.0));
  PetscCall(SceneNumbers(&one, &n, &alone));
  PetscCall(SceneCreate(BuiltinBeam, &two));
  PetscCall(Steps(&two, 3, 10.0));
  PetscCall(SceneCreate(BuiltinBeam, &three));
  for (int i = 0; i < 22; i++) {
    PetscCall(Steps(&two, 1, 10.0));
    PetscCall(Steps(&three, 1, 10.0));
  }
  PetscCall(Steps(&three, 3, 10.0));
  PetscCall(SceneNumbers(&two, &n, &a));
  PetscCall(SceneNumbers(&three, &n, &b));
  TEST(DifferentBits(n, alone, a) == 0 && DifferentBits(n, alone, b) == 0, "couplings stepped in turn: %d and %d numbers differ",
       (int)DifferentBits(n, alone, a), (int)DifferentBits(n, alone, b));
  printf("two couplings stepped in turn: %d of %d numbers differ from one alone\n",
         (int)(DifferentBits(n, alone, a) + DifferentBits(n, alone, b)), (int)n);
  PetscCall(CoupleGetTime(one.couple, &t, NULL));
  PetscCall(CoupleAdvance(one.couple, t + 0.01));
  PetscCall(CoupleGetTime(one.couple, &t, NULL));
  TEST(t > 0.01, "CoupleAdvance() went to %g", (double)t);
  {
    CoupleAudit audit;
    double sum = 0;
    PetscCall(CoupleGetMarkers(one.couple, one.beam, &m, &x, &v, &f));
    PetscCall(CoupleGetAudit(one.couple, one.beam, &audit));
    for (PetscInt i = 0; i < m; i++) sum += f[3 * i];
    TEST_NEAR(sum, audit.force[0], 1e-12 * (1 + fabs(sum)), "sum of the marker forces");
    TEST(m > 0 && x && v, "markers of the beam");
  }
  PetscCall(PetscFree(alone));
  PetscCall(PetscFree(a));
  PetscCall(PetscFree(b));
  PetscCall(SceneDestroy(&one));
  PetscCall(SceneDestroy(&two));
  PetscCall(SceneDestroy(&three));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TestOneState());
  PetscCall(TestBack("rk2"));
  PetscCall(TestBack("symplectic"));
  PetscCall(TestBack("verlet"));
  PetscCall(TestInstances());
  PetscCall(PetscFinalize());
  return test_report();
}
