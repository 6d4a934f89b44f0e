/*
  test_sph_audit.c - powers of the pair forces, for the energy balance.

  Split: the power of all forces on the fluid, sum of m a . v with the a that the backend computed, equals pressure power -
  viscous heat - work on the boundaries, pair by pair; what is left is rounding, 1e-12 of the largest term for 1e5 pairs in double
  precision. Velocities, densities and positions are random, walls move.

  Taylor-Green vortices on a lattice: heat 16 pi^2/Re times the kinetic energy. The sum's error is of second order in k h,
  k = 2 pi: below (k h)^2, and a quarter with twice the markers; a third is allowed for the next order. As they decay, kinetic
  energy less the integral of pressure power - heat (trapezoids over the steps, second order as the midpoint rule) stays, with an
  error that falls to a quarter with half the step.
*/
#include "sphcase.h"

static unsigned seed = 7;
static double Random(void) /* in (-1, 1) */
{
  seed = seed * 1664525u + 1013904223u;
  return (double)(seed >> 8) / 8388608.0 - 1.0;
}

/* Random velocities and densities, positions off the lattice by up to a tenth of dp. */
static PetscErrorCode Disturb(Sph sph, PetscReal dp)
{
  PetscInt nf, nb;
  PetscReal *x, *v, *rho;

  PetscFunctionBegin;
  PetscCall(SphGetCounts(sph, &nf, &nb, NULL));
  PetscCall(PetscMalloc3(3 * (size_t)(nf + nb), &x, 3 * (size_t)(nf + nb), &v, (size_t)(nf + nb), &rho));
  PetscCall(SphGetFields(sph, &(SphFields){.x = x, .v = v, .rho = rho}));
  for (PetscInt i = 0; i < nf; i++) {
    for (int k = 0; k < 2; k++) {
      x[3 * i + k] += 0.1 * dp * Random();
      v[3 * i + k] = Random();
    }
    rho[i] *= 1.0 + 0.01 * Random();
  }
  PetscCall(SphSetFields(sph, &(SphFields){.x = x, .v = v, .rho = rho}));
  PetscCall(PetscFree3(x, v, rho));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Power of all forces on the fluid, of the forces on the boundary, and the fluid's angular momentum. */
static PetscErrorCode BruteForce(Sph sph, double *fluid, double *boundary, double *angular)
{
  PetscInt nf, nb;
  PetscReal *x, *v, *a, *f;
  SphSums sums;

  PetscFunctionBegin;
  PetscCall(SphGetCounts(sph, &nf, &nb, NULL));
  PetscCall(SphGetSums(sph, &sums));
  PetscCall(PetscMalloc4(3 * (size_t)(nf + nb), &x, 3 * (size_t)(nf + nb), &v, 3 * (size_t)(nf + nb), &a, 3 * (size_t)nb, &f));
  PetscCall(SphGetFields(sph, &(SphFields){.x = x, .v = v, .a = a}));
  PetscCall(SphGetBoundaryForce(sph, 0, f));
  *fluid = *boundary = *angular = 0.0;
  for (PetscInt i = 0; i < nf; i++) {
    const double m = sums.mass / (double)nf;
    for (int k = 0; k < 2; k++) *fluid += m * a[3 * i + k] * v[3 * i + k];
    *angular += m * (x[3 * i] * v[3 * i + 1] - x[3 * i + 1] * v[3 * i]);
  }
  for (PetscInt i = 0; i < nb; i++)
    for (int k = 0; k < 2; k++) *boundary += f[3 * i + k] * v[3 * (nf + i) + k];
  PetscCall(PetscFree4(x, v, a, f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Split(SphViscosityType viscosity, SphWallType wall, SphSlipType slip)
{
  const FlowCase c = {.dim = 2,
                      .dp = 0.05,
                      .hi = {1, 1, 0},
                      .periodic = {PETSC_TRUE, PETSC_FALSE, PETSC_FALSE},
                      .wall = {PETSC_FALSE, PETSC_FALSE, PETSC_TRUE, PETSC_TRUE},
                      .wallvelocity = {{0}, {0}, {0.3, 0, 0}, {-0.5, 0, 0}},
                      .rho = 1000,
                      .mu = 50,
                      .vmax = 1,
                      .hratio = 1.2,
                      .xsph = -1.0};
  double fluid, boundary, angular, scale;
  PetscInt group;
  SphAudit audit;
  Sph sph;

  PetscFunctionBegin;
  PetscCall(FlowFluid(&c, &sph));
  PetscCall(SphSetPrecision(sph, SPH_PRECISION_DOUBLE));
  PetscCall(SphSetViscosityType(sph, viscosity));
  PetscCall(SphSetWall(sph, wall));
  PetscCall(SphSetSlip(sph, slip));
  PetscCall(FlowWalls(&c, sph, &group));
  PetscCall(SphSetUp(sph));
  PetscCall(Disturb(sph, c.dp));
  PetscCall(SphStepBegin(sph, 1e-20)); /* rates; the state stays to rounding */
  PetscCall(BruteForce(sph, &fluid, &boundary, &angular));
  PetscCall(SphGetAudit(sph, &audit));
  scale = PetscMax(PetscAbsReal(audit.pressure), PetscMax(PetscAbsReal(audit.viscous), PetscAbsReal(boundary)));
  printf("%s, %s, slip %s: pressure %.6g W/m, heat %.6g, on walls %.6g, residual %.1e of the largest\n",
         SphViscosityTypes[viscosity], SphWallTypes[wall], SphSlipTypes[slip], (double)audit.pressure, (double)audit.viscous,
         boundary, (audit.pressure - audit.viscous - boundary - fluid) / scale);
  TEST_NEAR((audit.pressure - audit.viscous - boundary - fluid) / scale, 0.0, 1e-12,
            "power of the pairs less that of the forces");
  TEST(slip == SPH_SLIP_FREE || audit.viscous > 0.0, "heat %g W must be > 0", (double)audit.viscous);
  TEST_NEAR(audit.angular[2], angular, 1e-12 * 1000.0, "angular momentum");
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define RE 100.0
static void TaylorGreen(const PetscReal x[3], void *ctx, PetscReal v[3], PetscReal *p)
{
  const PetscReal k = 2.0 * PETSC_PI;
  (void)ctx;
  v[0] = -cos(k * x[0]) * sin(k * x[1]);
  v[1] = sin(k * x[0]) * cos(k * x[1]);
  *p = 0.0;
}

static FlowCase Vortices(PetscInt across)
{
  return (FlowCase){.dim = 2,
                    .dp = 1.0 / (PetscReal)across,
                    .hi = {1, 1, 0},
                    .periodic = {PETSC_TRUE, PETSC_TRUE, PETSC_FALSE},
                    .rho = 1.0,
                    .mu = 1.0 / RE,
                    .vmax = 1.0,
                    .kernel = SPH_KERNEL_WENDLAND,
                    .hratio = 2.0,
                    .xsph = 0.0,
                    .initial = TaylorGreen};
}

/* Change of the kinetic energy less the integral of the powers at time `end`, over the initial kinetic energy. */
static PetscErrorCode Decay(PetscReal dt, PetscReal end, double *residual)
{
  const FlowCase c = Vortices(25);
  const PetscInt steps = (PetscInt)lrint(end / dt);
  SphAudit audit;
  SphSums start, sums;
  double integral = 0.0, heat = 0.0;
  Sph sph;

  PetscFunctionBegin;
  PetscCall(FlowFluid(&c, &sph));
  PetscCall(SphSetPrecision(sph, SPH_PRECISION_DOUBLE));
  PetscCall(SphSetDensityReinit(sph, SPH_REINIT_NONE, 10));
  PetscCall(SphSetTimeStep(sph, dt));
  PetscCall(SphSetUp(sph));
  PetscCall(SphGetSums(sph, &start));
  for (PetscInt k = 0; k <= steps; k++) {
    const double w = k == 0 || k == steps ? 0.5 * dt : dt;
    PetscCall(SphGetAudit(sph, &audit));
    integral += w * (audit.pressure - audit.viscous);
    heat += w * audit.viscous;
    if (k == steps) break;
    PetscCall(SphStepBegin(sph, dt));
    PetscCall(SphStepEnd(sph));
  }
  PetscCall(SphGetSums(sph, &sums));
  *residual = (sums.kinetic - start.kinetic - integral) / start.kinetic;
  printf("Taylor-Green, dt %g s: at t = %g s kinetic energy %.6g of %.6g J/m, heat %.6g, residual %.2e of the first\n",
         (double)dt, (double)end, (double)sums.kinetic, (double)start.kinetic, heat, *residual);
  TEST(heat > 0.1 * start.kinetic, "heat %g J/m must matter", heat);
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Heat(PetscInt across, double *error)
{
  const FlowCase c = Vortices(across);
  SphAudit audit;
  SphSums sums;
  Sph sph;

  PetscFunctionBegin;
  PetscCall(FlowFluid(&c, &sph));
  PetscCall(SphSetUp(sph));
  PetscCall(SphGetAudit(sph, &audit));
  PetscCall(SphGetSums(sph, &sums));
  *error = audit.viscous / (16.0 * PETSC_PI * PETSC_PI / RE * sums.kinetic) - 1.0;
  printf("Taylor-Green, %d across: heat %.6g W/m, error %.3g\n", (int)across, (double)audit.viscous, *error);
  TEST(fabs(*error) < pow(2.0 * PETSC_PI * 2.0 / (double)across, 2), "error of the heat: %g", *error);
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  double coarse, fine;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(Split(SPH_VISCOSITY_EQ6, SPH_WALL_ADAMI, SPH_SLIP_NONE));
  PetscCall(Split(SPH_VISCOSITY_MORRIS, SPH_WALL_ADAMI, SPH_SLIP_NONE));
  PetscCall(Split(SPH_VISCOSITY_ARTIFICIAL, SPH_WALL_ADAMI, SPH_SLIP_FREE));
  PetscCall(Split(SPH_VISCOSITY_EQ6, SPH_WALL_BCE, SPH_SLIP_NONE));
  PetscCall(Heat(25, &coarse));
  PetscCall(Heat(50, &fine));
  TEST(fabs(fine) < fabs(coarse) / 3.0, "error of the heat: %g, %g with twice the markers", coarse, fine);
  PetscCall(Decay(1e-3, 0.1, &coarse));
  PetscCall(Decay(5e-4, 0.1, &fine));
  TEST(fabs(fine) < fabs(coarse) / 3.0, "residual of the energy: %g, %g with half the step", coarse, fine);
  PetscCall(PetscFinalize());
  return test_report();
}
