/*
  test_sph_engine_steps.c - same bits for any number of threads, order of the integrators, single against double, options of the
  engine.

  Orders: Taylor-Green flow on 16 x 16 markers, double pair arithmetic; the marker system is a smooth ODE, so the error against a
  solution with eight times smaller steps falls as dt^2 for each of the three schemes (verlet has one Euler step at the start, an
  error of order dt^2 once, and runs without XSPH, whose velocity it takes at the beginning of the step: first order). Observed
  orders over two halvings must exceed 1.8: the next order contributes less than a tenth at these steps, and the reference (1/8 of
  the finest step) 1/64.
*/
#include "sph_cuda/sphimpl.h"
#include "sph_cuda/sphfill.h"
#include "testing.h"
#include <float.h>
#include <omp.h>
#include <string.h>

typedef struct {
  PetscInt dim;
  SphKernelType kernel;
  SphWallType wall;
  SphIntegratorType integrator;
  SphPrecision precision;
  SphViscosityType viscosity;
  SphDiffusionType diffusion;
  PetscReal zeta;
} Case;

/* A block of fluid in the corner of an open box with moving walls: collapses in a few dozen steps. */
static PetscErrorCode MakeDam(const Case *c, Sph *out)
{
  const PetscReal dp = c->dim == 2 ? 0.01 : 0.04, lo[3] = {0, 0, 0}, hi[3] = {0.6, 0.6, 0.4}, top[3] = {0.3, 0.4, 0.4},
                  g[3] = {0, -9.81, 0};
  const PetscBool face[6] = {1, 1, 1, 0, c->dim == 3, c->dim == 3}, periodic[3] = {0, 0, 0};
  PetscReal *x, *vol, *depth, support;
  PetscInt n, group;
  Sph sph;

  PetscFunctionBegin;
  PetscCall(SphCreate(PETSC_COMM_SELF, &sph));
  PetscCall(SphSetDimension(sph, c->dim));
  PetscCall(SphSetSpacing(sph, dp));
  PetscCall(SphSetSmoothingRatio(sph, 1.5));
  PetscCall(SphSetMaxSpeed(sph, 3.0));
  PetscCall(SphSetViscosity(sph, 0.1));
  PetscCall(SphSetKernel(sph, c->kernel));
  PetscCall(SphSetWall(sph, c->wall));
  PetscCall(SphSetIntegrator(sph, c->integrator));
  PetscCall(SphSetPrecision(sph, c->precision));
  PetscCall(SphSetViscosityType(sph, c->viscosity));
  PetscCall(SphSetDensityDiffusion(sph, c->diffusion, 0.1));
  PetscCall(SphSetXSPH(sph, c->zeta));
  PetscCall(SphSetDensityReinit(sph, SPH_REINIT_SHEPARD, 7));
  PetscCall(SphSetBodyForce(sph, g));
  PetscCall(SphSetDomain(sph, lo, hi));
  PetscCall(SphFillBox(c->dim, dp, lo, top, NULL, NULL, &n, &x));
  PetscCall(SphAddFluid(sph, n, x, NULL, NULL));
  PetscCall(PetscFree(x));
  PetscCall(SphGetSupport(sph, &support));
  PetscCall(SphFillWalls(c->dim, dp, lo, hi, face, periodic, support, &n, &x, &vol, &depth));
  PetscCall(SphAddBoundary(sph, n, x, NULL, vol, depth, &group));
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(vol));
  PetscCall(PetscFree(depth));
  PetscCall(SphSetUp(sph));
  *out = sph;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Position, velocity and density of all markers after some steps: 7 values each, in added order. */
static PetscErrorCode Run(const Case *c, int threads, PetscInt steps, PetscInt *n, double **out)
{
  PetscReal dt;
  PetscInt nf, nb;
  double *v;
  Sph sph;

  PetscFunctionBegin;
  omp_set_num_threads(threads);
  PetscCall(MakeDam(c, &sph));
  for (PetscInt s = 0; s < steps; s++) {
    PetscCall(SphComputeTimeStep(sph, &dt));
    PetscCall(SphStepBegin(sph, dt));
    PetscCall(SphStepEnd(sph));
  }
  PetscCall(SphGetCounts(sph, &nf, &nb, NULL));
  *n = nf + nb;
  PetscCall(PetscMalloc1(7 * (size_t)*n, &v));
  PetscCall(SphGetFields(sph, &(SphFields){.x = v, .v = v + 3 * *n, .rho = v + 6 * *n}));
  PetscCall(SphDestroy(&sph));
  *out = v;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Enough for several rebuilds of the search structure and re-initialisations. */
#define STEPS 30

static PetscErrorCode SameBits(void)
{
  static const Case cases[] = {
      {2, SPH_KERNEL_CUBIC, SPH_WALL_ADAMI, SPH_INTEGRATOR_RK2, SPH_PRECISION_SINGLE, SPH_VISCOSITY_EQ6, SPH_DIFFUSION_NONE, 0.5},
      {3, SPH_KERNEL_WENDLAND, SPH_WALL_BCE, SPH_INTEGRATOR_VERLET, SPH_PRECISION_SINGLE, SPH_VISCOSITY_ARTIFICIAL,
       SPH_DIFFUSION_FOURTAKAS, 0.0},
      {3, SPH_KERNEL_CUBIC, SPH_WALL_ADAMI, SPH_INTEGRATOR_SYMPLECTIC, SPH_PRECISION_DOUBLE, SPH_VISCOSITY_MORRIS,
       SPH_DIFFUSION_MOLTENI, 0.3},
  };

  PetscFunctionBegin;
  for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
    double *ref, *v;
    PetscInt n, m;
    PetscCall(Run(&cases[i], 1, STEPS, &n, &ref));
    for (int t = 2; t <= 3; t++) {
      PetscCall(Run(&cases[i], t, STEPS, &m, &v));
      TEST(m == n && memcmp(ref, v, (size_t)(7 * n) * sizeof(double)) == 0,
           "case %d: %d threads give other bits than 1 after %d steps", (int)i, t, STEPS);
      PetscCall(PetscFree(v));
    }
    printf("same bits for 1, 2, 3 threads: case %d, %" PetscInt_FMT " markers, %d steps\n", (int)i, n, STEPS);
    PetscCall(PetscFree(ref));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Single against double after one and after many steps, relative to the largest speed and to the column's static pressure as
 * density. */
static PetscErrorCode SingleAgainstDouble(void)
{
  PetscFunctionBegin;
  for (int walls = 0; walls < 2; walls++) {
    Case c = {2,
              SPH_KERNEL_WENDLAND,
              (SphWallType)walls,
              SPH_INTEGRATOR_RK2,
              SPH_PRECISION_SINGLE,
              SPH_VISCOSITY_EQ6,
              SPH_DIFFUSION_NONE,
              0.5};
    for (PetscInt steps = 1; steps <= 100; steps *= 100) {
      double *s, *d, ev = 0.0, vv = 0.0, er = 0.0, rr = 0.0;
      PetscInt n;
      c.precision = SPH_PRECISION_SINGLE;
      PetscCall(Run(&c, 2, steps, &n, &s));
      c.precision = SPH_PRECISION_DOUBLE;
      PetscCall(Run(&c, 2, steps, &n, &d));
      for (PetscInt i = 3 * n; i < 6 * n; i++) {
        ev += (s[i] - d[i]) * (s[i] - d[i]);
        vv += d[i] * d[i];
      }
      for (PetscInt i = 6 * n; i < 7 * n; i++) {
        er += (s[i] - d[i]) * (s[i] - d[i]);
        rr += (d[i] - 1000.0) * (d[i] - 1000.0);
      }
      printf("single against double, wall %s, %3" PetscInt_FMT " steps: rms velocity %.2e, rms density deviation %.2e relative\n",
             SphWallTypes[walls], steps, sqrt(ev / vv), sqrt(er / rr));
      /* one step: two right-hand sides, each within (N + 32) epsilon of its amplitude, N about 30 neighbours; amplitudes up to
       * 100 times the sums */
      if (steps == 1)
        TEST(sqrt(ev / vv) < 2.0 * 62.0 * 100.0 * FLT_EPSILON, "velocity of single precision after one step is %g off",
             sqrt(ev / vv));
      PetscCall(PetscFree(s));
      PetscCall(PetscFree(d));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Taylor-Green flow to time T in `steps` steps: n x 6 positions and velocities. */
static PetscErrorCode TaylorGreen(SphIntegratorType integrator, PetscReal zeta, PetscReal T, PetscInt steps, PetscInt *nout,
                                  double **out)
{
  const PetscReal dp = 1.0 / 16.0, lo[3] = {0, 0, 0}, hi[3] = {1, 1, 0};
  const PetscBool periodic[3] = {1, 1, 0};
  PetscReal *x, *v, *p;
  PetscInt n;
  Sph sph;

  PetscFunctionBegin;
  PetscCall(SphCreate(PETSC_COMM_SELF, &sph));
  PetscCall(SphSetDimension(sph, 2));
  PetscCall(SphSetSpacing(sph, dp));
  PetscCall(SphSetSmoothingRatio(sph, 1.5));
  PetscCall(SphSetSoundSpeed(sph, 10.0));
  PetscCall(SphSetViscosity(sph, 10.0));
  PetscCall(SphSetKernel(sph, SPH_KERNEL_WENDLAND));
  PetscCall(SphSetPrecision(sph, SPH_PRECISION_DOUBLE));
  PetscCall(SphSetIntegrator(sph, integrator));
  PetscCall(SphSetXSPH(sph, zeta));
  PetscCall(SphSetDensityReinit(sph, SPH_REINIT_NONE, 1));
  PetscCall(SphSetDomain(sph, lo, hi));
  PetscCall(SphSetPeriodic(sph, periodic));
  PetscCall(SphFillBox(2, dp, lo, hi, NULL, NULL, &n, &x));
  PetscCall(PetscMalloc2(3 * (size_t)n, &v, n, &p));
  for (PetscInt i = 0; i < n; i++) {
    const double a = 2.0 * PETSC_PI * x[3 * i], b = 2.0 * PETSC_PI * x[3 * i + 1];
    v[3 * i] = -cos(a) * sin(b);
    v[3 * i + 1] = sin(a) * cos(b);
    v[3 * i + 2] = 0.0;
    p[i] = -250.0 * (cos(2.0 * a) + cos(2.0 * b));
  }
  PetscCall(SphAddFluid(sph, n, x, v, p));
  PetscCall(PetscFree(x));
  PetscCall(PetscFree2(v, p));
  PetscCall(SphSetUp(sph));
  for (PetscInt s = 0; s < steps; s++) {
    PetscCall(SphStepBegin(sph, T / (PetscReal)steps));
    PetscCall(SphStepEnd(sph));
  }
  PetscCall(PetscMalloc1(6 * (size_t)n, out));
  PetscCall(SphGetFields(sph, &(SphFields){.x = *out, .v = *out + 3 * n}));
  PetscCall(SphDestroy(&sph));
  *nout = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Orders(void)
{
  const PetscReal T = 0.016;

  PetscFunctionBegin;
  for (int integrator = 0; integrator < 3; integrator++) {
    const PetscReal zeta = integrator == SPH_INTEGRATOR_VERLET ? 0.0 : 0.5;
    double *ref, *got, e[3][2];
    PetscInt n = 0;
    PetscCall(TaylorGreen(SPH_INTEGRATOR_RK2, zeta, T, 256, &n, &ref));
    for (int k = 0; k < 3; k++) {
      double ex = 0.0, ev = 0.0;
      PetscCall(TaylorGreen((SphIntegratorType)integrator, zeta, T, 8 << k, &n, &got));
      for (PetscInt i = 0; i < 3 * n; i++) {
        const double dx = got[i] - ref[i], dv = got[3 * n + i] - ref[3 * n + i];
        ex += (dx - rint(dx)) * (dx - rint(dx)); /* the period is 1 */
        ev += dv * dv;
      }
      e[k][0] = sqrt(ex / (double)n);
      e[k][1] = sqrt(ev / (double)n);
      PetscCall(PetscFree(got));
    }
    printf("%-10s rms error of position %.2e %.2e %.2e, of velocity %.2e %.2e %.2e: orders %.2f, %.2f\n",
           SphIntegratorTypes[integrator], e[0][0], e[1][0], e[2][0], e[0][1], e[1][1], e[2][1], 0.5 * log2(e[0][0] / e[2][0]),
           0.5 * log2(e[0][1] / e[2][1]));
    for (int f = 0; f < 2; f++)
      TEST(0.5 * log2(e[0][f] / e[2][f]) > 1.8, "%s: order %g of %s", SphIntegratorTypes[integrator],
           0.5 * log2(e[0][f] / e[2][f]), f ? "velocity" : "position");
    PetscCall(PetscFree(ref));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Options arrive where the setters put them; a value out of range is an error. */
static PetscErrorCode Options(void)
{
  PetscErrorCode alpha, delta;
  Sph sph;

  PetscFunctionBegin;
  PetscCall(PetscOptionsInsertString(NULL, "-sph_viscosity_type morris -sph_artificial_alpha 0.3 -sph_density_diffusion "
                                           "fourtakas -sph_density_diffusion_delta 0.2 -sph_integrator symplectic"));
  PetscCall(SphCreate(PETSC_COMM_SELF, &sph));
  PetscCall(SphSetFromOptions(sph));
  TEST(sph->par.viscosity == SPH_VISCOSITY_MORRIS && sph->par.alpha == 0.3 && sph->par.diffusion == SPH_DIFFUSION_FOURTAKAS &&
           sph->par.delta == 0.2 && sph->par.integrator == SPH_INTEGRATOR_SYMPLECTIC,
       "options of the forms did not arrive");
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  alpha = SphSetArtificialViscosity(sph, -1.0);
  delta = SphSetDensityDiffusion(sph, SPH_DIFFUSION_MOLTENI, 2.0);
  PetscCall(PetscPopErrorHandler());
  TEST(alpha == PETSC_ERR_ARG_OUTOFRANGE && delta == PETSC_ERR_ARG_OUTOFRANGE,
       "alpha = -1 and delta = 2 must be refused, got errors %d, %d", (int)alpha, (int)delta);
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two markers 0.02 dp apart, in one cell, across a cell border and across the period: refused; 0.2 dp: accepted. */
static PetscErrorCode Overlap(void)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {1, 1, 1}, at[3] = {0.031, 1.0 / 3.0, 0.0};
  const PetscBool periodic[3] = {1, 1, 1};

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++)
    for (int apart = 0; apart < 2; apart++) {
      const PetscReal d = apart ? 0.1 : 0.01, x[6] = {0.1, 0.2, at[k] - d * 0.1, 0.1, 0.2, at[k] + d * 0.1};
      PetscErrorCode error;
      Sph sph;
      PetscCall(SphCreate(PETSC_COMM_SELF, &sph));
      PetscCall(SphSetSpacing(sph, 0.1));
      PetscCall(SphSetSmoothingRatio(sph, 1.5));
      PetscCall(SphSetSoundSpeed(sph, 10.0));
      PetscCall(SphSetDomain(sph, lo, hi));
      PetscCall(SphSetPeriodic(sph, periodic));
      PetscCall(SphAddFluid(sph, 2, x, NULL, NULL));
      PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
      error = SphSetUp(sph);
      PetscCall(PetscPopErrorHandler());
      TEST((error == PETSC_ERR_ARG_WRONG) == !apart, "place %d, %g dp apart: error %d", k, 2.0 * d, (int)error);
      PetscCall(SphDestroy(&sph));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At most 200 bytes of counted memory per marker, single-precision pairs, the search structure after some steps included. */
static PetscErrorCode Memory(void)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {0.6, 0.5, 0.2};

  PetscFunctionBegin;
  for (int i = 0; i < 3; i++) {
    PetscReal *x, bytes, dt;
    PetscInt n;
    Sph sph;
    PetscCall(SphCreate(PETSC_COMM_SELF, &sph));
    PetscCall(SphSetSpacing(sph, 0.01));
    PetscCall(SphSetSmoothingRatio(sph, sqrt(3.0)));
    PetscCall(SphSetMaxSpeed(sph, 3.0));
    PetscCall(SphSetWall(sph, SPH_WALL_BCE));
    PetscCall(SphSetIntegrator(sph, (SphIntegratorType)i));
    PetscCall(SphSetDensityDiffusion(sph, SPH_DIFFUSION_MOLTENI, 0.1));
    PetscCall(SphSetXSPH(sph, 0.0));
    PetscCall(SphSetDomain(sph, lo, hi));
    PetscCall(SphFillBox(3, 0.01, lo, hi, NULL, NULL, &n, &x));
    PetscCall(SphAddFluid(sph, n, x, NULL, NULL));
    PetscCall(PetscFree(x));
    PetscCall(SphSetUp(sph));
    PetscCall(SphComputeTimeStep(sph, &dt));
    PetscCall(SphStepBegin(sph, dt));
    PetscCall(SphStepEnd(sph));
    PetscCall(SphGetWork(sph, &bytes, NULL));
    printf("%s: %.1f bytes per marker, %d markers\n", SphIntegratorTypes[i], bytes / (double)n, (int)n);
    TEST(bytes <= 200.0 * (double)n, "%s: %g bytes per marker, must be at most 200", SphIntegratorTypes[i], bytes / (double)n);
    PetscCall(SphDestroy(&sph));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(SameBits());
  PetscCall(SingleAgainstDouble());
  PetscCall(Orders());
  PetscCall(Options());
  PetscCall(Overlap());
  PetscCall(Memory());
  PetscCall(PetscFinalize());
  return test_report();
}
