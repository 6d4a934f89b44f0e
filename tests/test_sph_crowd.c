/*
  test_sph_crowd - markers that crowd at one point come to rest, and a run whose speeds pass that of sound ends.

  A cubic spline has no force at r = 0, so that lasting suction or pressure can gather many markers at one point. Here 32 of 216
  lie within 0.1 dp of one, and the pressure is +-500 Pa. The sum w of V W over the crowd is about 6: XSPH with zeta = 0.5 would
  move each of its markers by v (1 - zeta w) = -2 v relative to the others, against its velocity, which a force that opposes the
  displacement makes grow without end (it reached 1e16 m/s within 20 steps). With sph_xsph_factor() all ends at rest.
  Bounds: sound of amplitude p moves fluid at p/(rho c_s) = 0.017 m/s; ten times that at most for what happens in the crowd, and
  less than p/(rho c_s) after 1000 steps, in which sound passes through the box fifty times.
*/
#include "sphcase.h"
#include "testerror.h"
#include <math.h>

#define DP 0.04
#define RHO 1000.0

static PetscErrorCode Box(Sph *sph, PetscReal *cs)
{
  const FlowCase c = {.dim = 3,
                      .dp = DP,
                      .hi = {6 * DP, 6 * DP, 6 * DP},
                      .periodic = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE},
                      .rho = RHO,
                      .mu = 1,
                      .vmax = 3,
                      .hratio = 1.2,
                      .xsph = -1.0};

  PetscFunctionBegin;
  PetscCall(FlowFluid(&c, sph));
  PetscCall(SphGetSoundSpeed(*sph, cs));
  PetscCall(SphSetUp(*sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Fastest(Sph sph, PetscInt n, PetscReal *v, PetscReal *most)
{
  const SphFields f = {.v = v};

  PetscFunctionBegin;
  PetscCall(SphGetFields(sph, &f));
  *most = 0.0;
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal speed = PetscSqrtReal(v[3 * i] * v[3 * i] + v[3 * i + 1] * v[3 * i + 1] + v[3 * i + 2] * v[3 * i + 2]);
    if (!(speed <= *most)) *most = speed;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Step(Sph sph)
{
  PetscReal dt;

  PetscFunctionBegin;
  PetscCall(SphComputeTimeStep(sph, &dt));
  PetscCall(SphStepBegin(sph, dt));
  PetscCall(SphStepEnd(sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Markers within 1.75 dp of the middle go to it, up to 0.1 dp along each axis. */
static PetscErrorCode Gather(Sph sph, PetscInt n, PetscReal p, PetscReal cs)
{
  PetscReal *x, *rho;
  unsigned seed = 1;
  PetscInt crowd = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(3 * (size_t)n, &x, (size_t)n, &rho));
  const SphFields f = {.x = x}, set = {.x = x, .rho = rho};
  PetscCall(Step(sph)); /* overlapping markers are refused before the first step only */
  PetscCall(SphGetFields(sph, &f));
  for (PetscInt i = 0; i < n; i++) {
    PetscReal r2 = 0.0;
    for (int k = 0; k < 3; k++) r2 += PetscSqr(x[3 * i + k] - 3 * DP);
    for (int k = 0; k < 3 && r2 < PetscSqr(1.75 * DP); k++) {
      seed = seed * 1664525u + 1013904223u;
      x[3 * i + k] = 3 * DP + 0.1 * DP * ((double)(seed >> 8) / 8388608.0 - 1.0);
    }
    if (r2 < PetscSqr(1.75 * DP)) crowd++;
    rho[i] = RHO + p / (cs * cs);
  }
  TEST(crowd == 32, "%d markers in the crowd", (int)crowd);
  PetscCall(SphSetFields(sph, &set));
  PetscCall(PetscFree2(x, rho));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Crowd(PetscReal p)
{
  PetscReal *v, now = 0.0, most = 0.0, cs, sound;
  PetscInt n, left;
  Sph sph;

  PetscFunctionBegin;
  PetscCall(Box(&sph, &cs));
  PetscCall(SphSetSpeedStop(sph, 0.0)); /* see for ourselves */
  PetscCall(SphGetCounts(sph, &n, NULL, NULL));
  PetscCall(PetscMalloc1(3 * (size_t)n, &v));
  PetscCall(Gather(sph, n, p, cs));
  sound = PetscAbsReal(p) / (RHO * cs);
  for (int s = 0; s < 1000 && most <= 10.0 * sound; s++) {
    PetscCall(Step(sph));
    PetscCall(Fastest(sph, n, v, &now));
    most = PetscMax(most, now);
  }
  PetscCall(SphGetCounts(sph, NULL, NULL, &left));
  printf("32 markers at one point, %g Pa: at most %g m/s, %g m/s at the end; p/(rho c_s) %g m/s\n", (double)p, (double)most,
         (double)now, (double)sound);
  TEST(most <= 10.0 * sound, "%g Pa: %g m/s, at most %g", (double)p, (double)most, (double)(10.0 * sound));
  TEST(now < sound && left == 0, "%g Pa: %g m/s at the end, %d markers left", (double)p, (double)now, (int)left);
  PetscCall(PetscFree(v));
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One marker at `speed` times that of sound, with SphSetSpeedStop() at `ratio`, or the default when it is negative. */
static PetscErrorCode Stop(PetscReal ratio, PetscReal speed, PetscBool ends)
{
  PetscReal *v, dt, cs;
  PetscInt n;
  Sph sph;

  PetscFunctionBegin;
  PetscCall(Box(&sph, &cs));
  if (ratio >= 0.0) PetscCall(SphSetSpeedStop(sph, ratio));
  PetscCall(SphGetCounts(sph, &n, NULL, NULL));
  PetscCall(PetscCalloc1(3 * (size_t)n, &v));
  v[3 * 77 + 1] = speed * cs;
  const SphFields f = {.v = v};
  PetscCall(SphSetFields(sph, &f));
  if (ends)
    TEST_REFUSED(SphComputeTimeStep(sph, &dt), "speed 30.3 m/s at step 0, time 0. s, is 1.01");
  else
    PetscCall(SphComputeTimeStep(sph, &dt));
  TEST_REFUSED(SphSetSpeedStop(sph, -1.0), "sph_speed_stop = -1");
  TEST_REFUSED(SphSetSpeedStop(sph, (PetscReal)NAN), "sph_speed_stop");
  PetscCall(PetscFree(v));
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(Crowd(-500.0));
  PetscCall(Crowd(500.0));
  PetscCall(Stop(-1.0, 0.99, PETSC_FALSE));
  PetscCall(Stop(-1.0, 1.01, PETSC_TRUE));
  PetscCall(Stop(3.0, 2.9, PETSC_FALSE));
  PetscCall(Stop(0.0, 20.0, PETSC_FALSE));
  PetscCall(PetscFinalize());
  return test_report();
}
