/*
  test_sph_periodic.c - flows in a periodic box: Taylor-Green vortices, rest, momentum.

  Taylor-Green, unit box, U = 1 m/s, Re = 100, from a lattice: u = -U cos(2 pi x) sin(2 pi y) e^(-8 pi^2 t/Re); the amplitude is
  the projection of the velocity on that field: 0.454041 at t = 1 s, kinetic energy over its initial value 0.206153. Bounds at 50
  markers across: 2 % of U on the amplitude, 2 % of the initial value on the energy, 5 % relative L2 error at the end: the flow
  stretches the lattice to chaos within the first quarter second, which at h/dp = 2 is a disturbance of a few percent. The error
  at 100 across must be smaller (-fine). Shifting is on, or the markers line up along the stagnation lines.

  Rest, 10 000 steps: rounding of the pair sums (single precision, about 30 terms that cancel) is the only force; 1e-5 of the
  expected speed is what 10 000 kicks of 1e-7 relative size, of random sign, add up to. Momentum: Eqs. 5, 6 are antisymmetric
  pair by pair, and neither XSPH nor shifting enters the velocity; its sum stays constant to rounding, n evaluations of 1e-16
  (double) or 1e-7 (single).
*/
#include "sphcase.h"

#define U 1.0
#define RE 100.0

static void TaylorGreen(const PetscReal x[3], void *ctx, PetscReal v[3], PetscReal *p)
{
  const PetscReal k = 2.0 * PETSC_PI;
  (void)ctx;
  v[0] = -U * cos(k * x[0]) * sin(k * x[1]);
  v[1] = U * sin(k * x[0]) * cos(k * x[1]);
  *p = -0.25 * U * U * (cos(2.0 * k * x[0]) + cos(2.0 * k * x[1])) * 1.0;
}

static FlowCase Box(PetscInt across)
{
  return (FlowCase){.dim = 2,
                    .dp = 1.0 / (PetscReal)across,
                    .hi = {1, 1, 0},
                    .periodic = {PETSC_TRUE, PETSC_TRUE, PETSC_FALSE},
                    .rho = 1.0,
                    .mu = U / RE,
                    .vmax = U,
                    .kernel = SPH_KERNEL_WENDLAND,
                    .hratio = 2.0,
                    .xsph = -1.0,
                    .shifting = SPH_SHIFTING_SUN,
                    .initial = TaylorGreen};
}

/* Amplitude over U (projection on the initial field), kinetic energy over the initial one, and L2 error over the exact norm. */
static PetscErrorCode Decay(Sph sph, PetscReal t, double *amplitude, double *energy, double *l2)
{
  const double e = exp(-8.0 * PETSC_PI * PETSC_PI * t / RE);
  PetscInt n;
  PetscReal *x, *v;
  double dot = 0.0, norm = 0.0, kin = 0.0, err = 0.0;

  PetscFunctionBegin;
  PetscCall(SphGetCounts(sph, &n, NULL, NULL));
  PetscCall(PetscMalloc2(3 * (size_t)n, &x, 3 * (size_t)n, &v));
  PetscCall(SphGetFields(sph, &(SphFields){.x = x, .v = v}));
  for (PetscInt i = 0; i < n; i++) {
    PetscReal u[3] = {0, 0, 0}, p;
    TaylorGreen(x + 3 * i, NULL, u, &p);
    for (int k = 0; k < 2; k++) {
      dot += u[k] * v[3 * i + k];
      norm += u[k] * u[k];
      kin += v[3 * i + k] * v[3 * i + k];
      err += PetscSqr(v[3 * i + k] - e * u[k]);
    }
  }
  *amplitude = dot / norm;
  *energy = kin / (0.5 * U * U * (double)n);
  *l2 = sqrt(err / norm) / e;
  PetscCall(PetscFree2(x, v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RunTaylorGreen(PetscInt across, double *l2end)
{
  const FlowCase c = Box(across);
  Sph sph;
  SphSums sums;
  double a, k, l2;

  PetscFunctionBegin;
  PetscCall(FlowFluid(&c, &sph));
  PetscCall(SphSetUp(sph));
  for (int q = 1; q <= 4; q++) {
    const PetscReal t = 0.25 * q;
    PetscCall(FlowRun(sph, t));
    PetscCall(Decay(sph, t, &a, &k, &l2));
    PetscCall(SphGetSums(sph, &sums));
    const double e = exp(-8.0 * PETSC_PI * PETSC_PI * t / RE);
    printf(
        "Taylor-Green %3d across, t %.2f: amplitude %.5f exact %.5f, kinetic energy %.5f exact %.5f, L2 error %.4f, compression "
        "%.4f\n",
        (int)across, (double)t, a, e, k, e * e, l2, (double)sums.compression);
    fflush(stdout);
    TEST_NEAR(a, e, 0.02, "amplitude of the vortices over U");
    TEST_NEAR(k, e * e, 0.02, "kinetic energy over the initial one");
  }
  TEST(l2 <= 0.05, "L2 error %g at t = 1", l2);
  *l2end = l2;
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RunRest(void)
{
  FlowCase c = Box(16);
  Sph sph;
  SphSums sums;
  PetscReal dt;

  PetscFunctionBegin;
  c.initial = NULL;
  PetscCall(FlowFluid(&c, &sph));
  PetscCall(SphSetUp(sph));
  for (int k = 0; k < 10000; k++) {
    PetscCall(SphComputeTimeStep(sph, &dt));
    PetscCall(SphStepBegin(sph, dt));
    PetscCall(SphStepEnd(sph));
  }
  PetscCall(SphGetSums(sph, &sums));
  printf("rest, 10000 steps: largest speed %.2e V_max, compression %.2e\n", (double)(sums.vmax / c.vmax),
         (double)sums.compression);
  TEST_NEAR(sums.vmax / c.vmax, 0.0, 1e-5, "speed of a fluid at rest over V_max");
  TEST_NEAR(sums.compression, 0.0, 1e-5, "density of a fluid at rest");
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Disturbed: the vortices plus a mean flow. */
static void Disturbed(const PetscReal x[3], void *ctx, PetscReal v[3], PetscReal *p)
{
  TaylorGreen(x, ctx, v, p);
  v[0] += 0.3 * U;
  v[1] -= 0.2 * U;
}

static PetscErrorCode RunMomentum(SphPrecision precision, double bound)
{
  const int steps = 200;
  FlowCase c = Box(24);
  Sph sph;
  SphSums a, b;
  PetscReal dt;

  PetscFunctionBegin;
  c.initial = Disturbed;
  c.vmax = 1.5 * U;
  PetscCall(FlowFluid(&c, &sph));
  PetscCall(SphSetPrecision(sph, precision));
  PetscCall(SphSetUp(sph));
  PetscCall(SphGetSums(sph, &a));
  for (int k = 0; k < steps; k++) {
    PetscCall(SphComputeTimeStep(sph, &dt));
    PetscCall(SphStepBegin(sph, dt));
    PetscCall(SphStepEnd(sph));
  }
  PetscCall(SphGetSums(sph, &b));
  for (int k = 0; k < 2; k++) {
    const double d = (b.momentum[k] - a.momentum[k]) / (a.mass * U);
    printf("momentum, %s: change over %d steps %.2e of m U along %c\n", SphPrecisions[precision], steps, d, 'x' + k);
    TEST_NEAR(d, 0.0, bound, "change of momentum over m U");
  }
  TEST_REL(b.mass, a.mass, 1e-14, "mass");
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscBool fine = PETSC_FALSE;
  double coarse, finer;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-fine", &fine, NULL));
  PetscCall(RunTaylorGreen(50, &coarse));
  if (fine) {
    PetscCall(RunTaylorGreen(100, &finer));
    printf("order of the L2 error from 50 to 100 across: %.2f\n", log2(coarse / finer));
    TEST(finer < coarse, "error %g at 100 across, %g at 50", finer, coarse);
  } else {
    PetscCall(RunRest());
    PetscCall(RunMomentum(SPH_PRECISION_DOUBLE, 1e-13));
    PetscCall(RunMomentum(SPH_PRECISION_SINGLE, 1e-6));
  }
  PetscCall(PetscFinalize());
  return test_report();
}
