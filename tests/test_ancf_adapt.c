/*
  test_ancf_adapt.c - adaptive TS steps (-ancf_ts_adapt_type basic) within the calls of AncfAdvance() that a fluid makes.

  The paper's beam with 4 elements swings from horizontal for 0.2 s in calls of 2 ms and 4 ms in turn. Checked:
  - every call ends at the time asked for, to the bit;
  - the rms error of the tip against RK4 with steps of 0.05 ms (error below h^4 w^4/100 = 1e-6 of the amplitude of the fastest
  wave, which has hardly any here; halving its step shows how far it is off) falls with the tolerance. A method of order p gives
  an error in proportion to tol^(p/(p+1)), 21-fold for alpha2 and 63-fold for RK5(4) when tol falls by 100; half of the exponent
  is asked for;
  - the step is carried over: the first step that a call tries is what the controller wanted after the last call, or the whole
  call when that is shorter; and where the tolerance wants several steps in a call there is less than one rejected step per call,
  which is what beginning anew with the whole call would cost.
*/
#include "ancf_common.h"

#define CALLS 66

/* Monitor: the step that a call tries first, s. */
typedef struct {
  PetscReal from, tried;
} Watch;

static PetscReal TimeOf(PetscInt call)
{
  return (PetscReal)(call / 2) * 6e-3 + (call % 2 ? 2e-3 : 0.0);
}

static PetscErrorCode Look(TS ts, PetscInt step, PetscReal t, Vec u, void *ctx)
{
  Watch *w = (Watch *)ctx;

  PetscFunctionBegin;
  (void)step;
  (void)u;
  if (w->tried <= 0.0 && PetscAbsReal(t - w->from) < 1e-12) PetscCall(TSGetTimeStep(ts, &w->tried));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tips after each call, steps made and rejected. */
static PetscErrorCode Swing(const char options[], PetscBool adaptive, PetscReal tip[CALLS], PetscInt *steps, PetscInt *rejected)
{
  AncfBeamSpec spec;
  Watch watch;
  PetscReal wanted = 0.0;
  Ancf ancf;
  TS ts;

  PetscFunctionBegin;
  PetscCall(SeedSpec(4, &spec));
  PetscCall(BeamCreate(&spec, -9.81, options, &ancf));
  PetscCall(AncfGetTS(ancf, &ts));
  PetscCall(TSMonitorSet(ts, Look, &watch, NULL));
  for (PetscInt i = 0; i < CALLS; i++) {
    const PetscReal t = TimeOf(i + 1);
    PetscReal now, whole = t - TimeOf(i);

    watch = (Watch){TimeOf(i), 0.0};
    PetscCall(AncfAdvance(ancf, t));
    PetscCall(AncfGetState(ancf, &now, NULL, NULL, NULL));
    TEST(now == t, "%s: a call to t = %.17g s ended at %.17g s", options, (double)t, (double)now);
    PetscCall(TSGetTime(ts, &now));
    TEST(now == t, "%s: TS ended at %.17g s, not at %.17g s", options, (double)now, (double)t);
    if (wanted > 0.0)
      TEST_REL(watch.tried, PetscMin(wanted, whole), 1e-12, "first step of a call against the step wanted before");
    if (adaptive) PetscCall(TSGetTimeStep(ts, &wanted));
    PetscCall(TipHeights(ancf, 1, &tip[i]));
  }
  PetscCall(AncfGetCounts(ancf, steps, NULL, NULL));
  PetscCall(TSGetStepRejections(ts, rejected));
  PetscCall(AncfDestroy(&ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Rms(const PetscReal *a, const PetscReal *b)
{
  PetscReal sum = 0.0;
  for (PetscInt i = 0; i < CALLS; i++) sum += PetscSqr(a[i] - b[i]);
  return PetscSqrtReal(sum / CALLS);
}

int main(int argc, char **argv)
{
  const struct {
    const char *options;
    PetscReal order;
  } type[] = {
      {"-ancf_ts_type alpha2", 2}, {"-ancf_ts_type bdf -ancf_ts_bdf_order 2", 2}, {"-ancf_ts_type rk -ancf_ts_rk_type 5dp", 5}};
  const char *const tolerance[] = {"1e-4", "1e-6", "1e-8"};
  PetscReal reference[CALLS], coarse[CALLS], tip[CALLS], error[3];
  PetscInt steps, rejected;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(Swing("-ancf_ts_type rk -ancf_ts_rk_type 4 -ancf_substeps 80 -ancf_ts_adapt_type none", PETSC_FALSE, reference,
                  &steps, &rejected));
  PetscCall(Swing("-ancf_ts_type rk -ancf_ts_rk_type 4 -ancf_substeps 40 -ancf_ts_adapt_type none", PETSC_FALSE, coarse, &steps,
                  &rejected));
  printf("reference: off by about %.1e m\n", (double)(Rms(coarse, reference) / 15));
  for (size_t k = 0; k < sizeof(type) / sizeof(type[0]); k++) {
    for (int j = 0; j < 3; j++) {
      char options[256];
      snprintf(options, sizeof(options), "%s -ancf_ts_adapt_type basic -ancf_ts_rtol %s -ancf_ts_atol %s", type[k].options,
               tolerance[j], tolerance[j]);
      PetscCall(Swing(options, PETSC_TRUE, tip, &steps, &rejected));
      error[j] = Rms(tip, reference);
      printf("%s, tolerance %s: error %.2e m, %d steps, %d rejected, %d calls\n", type[k].options, tolerance[j], (double)error[j],
             (int)steps, (int)rejected, CALLS);
      if (steps > 2 * CALLS) TEST(rejected < CALLS, "%s: %d rejected steps in %d calls", options, (int)rejected, CALLS);
    }
    for (int j = 0; j < 2; j++)
      TEST(error[j + 1] < error[j] / pow(100.0, 0.5 * type[k].order / (type[k].order + 1.0)),
           "%s: error %g m at tolerance %s, %g m at %s", type[k].options, (double)error[j + 1], tolerance[j + 1],
           (double)error[j], tolerance[j]);
  }
  PetscCall(PetscFinalize());
  return test_report();
}
