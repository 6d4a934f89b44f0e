/*
  test_sph_channel.c - transient plane Poiseuille and Couette flow against their series solutions.

  Set-up of Morris, Fox, Zhu, J. Comput. Phys. 136 (1997): L = 1e-3 m, nu = 1e-6 m^2/s, rho = 1000 kg/m^3, F = 1e-4 m/s^2 or plate
  speed V0 = 1.25e-5 m/s. Bound: relative L2 error <= 1 % at 40 markers across, at nu t/L^2 = 0.02, 0.1, 0.5 (Poiseuille) and
  0.05, 0.2 (Couette); the scheme is second order in dp at fixed h/dp (lattice-normalised viscosity, linear wall extrapolation):
  the order between 10 and 40 markers must be at least 1.5. The last Couette time is steady, its linear profile exact up to noise:
  no order is asked of it. -table prints the errors for both wall treatments.
*/
#include "sph.h"
#include "sphfill.h"
#include "testing.h"

#define L 1e-3
#define NU 1e-6
#define V0 1.25e-5
#define FX 1e-4

static double Exact(int couette, double y, double t)
{
  double u = couette ? V0 * y / L : FX * y * (L - y) / (2.0 * NU);
  for (int n = 1; n < 200; n++) {
    const double k = n * PETSC_PI / L, e = exp(-k * k * NU * t);
    if (couette)
      u += 2.0 * V0 / (n * PETSC_PI) * (n % 2 ? -1.0 : 1.0) * sin(k * y) * e;
    else if (n % 2)
      u -= 4.0 * FX * L * L / (NU * pow(PETSC_PI * n, 3)) * sin(k * y) * e;
  }
  return u;
}

typedef struct {
  int couette, across;
  SphWallType wall;
  SphPrecision precision;
  double hratio;
} Case;

/* Fluid between y = 0 and L, periodic in x; walls below and above, the upper one moving in the Couette case. */
static PetscErrorCode Make(const Case *c, Sph *out)
{
  const double dp = L / c->across, width = 8.0 * dp;
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {width, L, 0}, f[3] = {c->couette ? 0.0 : FX, 0, 0};
  const PetscBool periodic[3] = {PETSC_TRUE, PETSC_FALSE, PETSC_FALSE};
  PetscReal *x, *xw, *vol, *depth, *v, support;
  PetscInt n, g;
  Sph sph;

  PetscFunctionBegin;
  PetscCall(SphCreate(PETSC_COMM_SELF, &sph));
  PetscCall(SphSetDimension(sph, 2));
  PetscCall(SphSetSpacing(sph, dp));
  PetscCall(SphSetSmoothingRatio(sph, c->hratio));
  PetscCall(SphSetDensity(sph, 1000.0));
  PetscCall(SphSetViscosity(sph, 1000.0 * NU));
  PetscCall(SphSetMaxSpeed(sph, 1.25e-5));
  PetscCall(SphSetBodyForce(sph, f));
  PetscCall(SphSetDomain(sph, lo, hi));
  PetscCall(SphSetPeriodic(sph, periodic));
  PetscCall(SphSetWall(sph, c->wall));
  PetscCall(SphSetPrecision(sph, c->precision));
  PetscCall(SphSetFromOptions(sph));
  PetscCall(SphFillBox(2, dp, lo, hi, NULL, NULL, &n, &x));
  PetscCall(SphAddFluid(sph, n, x, NULL, NULL));
  PetscCall(PetscFree(x));
  PetscCall(SphGetSupport(sph, &support));
  for (int top = 0; top < 2; top++) {
    const PetscBool face[6] = {PETSC_FALSE, PETSC_FALSE, top ? PETSC_FALSE : PETSC_TRUE, top ? PETSC_TRUE : PETSC_FALSE,
                               PETSC_FALSE, PETSC_FALSE};
    PetscCall(SphFillWalls(2, dp, lo, hi, face, periodic, support, &n, &xw, &vol, &depth));
    PetscCall(PetscCalloc1(3 * (size_t)n, &v));
    if (top && c->couette)
      for (PetscInt i = 0; i < n; i++) v[3 * i] = V0;
    PetscCall(SphAddBoundary(sph, n, xw, v, vol, depth, &g));
    PetscCall(PetscFree(v));
    PetscCall(PetscFree(xw));
    PetscCall(PetscFree(vol));
    PetscCall(PetscFree(depth));
  }
  PetscCall(SphSetUp(sph));
  *out = sph;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode L2Error(Sph sph, int couette, double t, double *error)
{
  PetscInt n, nb;
  double e2 = 0.0, u2 = 0.0;
  PetscReal *x, *v;

  PetscFunctionBegin;
  PetscCall(SphGetCounts(sph, &n, &nb, NULL));
  PetscCall(PetscMalloc2(3 * (size_t)(n + nb), &x, 3 * (size_t)(n + nb), &v));
  PetscCall(SphGetFields(sph, &(SphFields){.x = x, .v = v}));
  for (PetscInt i = 0; i < n; i++) {
    const double u = Exact(couette, x[3 * i + 1], t), d = v[3 * i] - u;
    e2 += d * d;
    u2 += u * u;
  }
  *error = sqrt(e2 / u2);
  PetscCall(PetscFree2(x, v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Moving walls keep their place: the upper plate slides along itself. Errors at the ntau times. */
static PetscErrorCode Run(const Case *c, int ntau, const double *tau, double *error)
{
  Sph sph;

  PetscFunctionBegin;
  PetscCall(Make(c, &sph));
  for (int k = 0; k < ntau; k++) {
    const double end = tau[k] * L * L / NU;
    PetscReal t, dt;
    for (;;) {
      PetscCall(SphGetTime(sph, &t, NULL));
      if (t >= end * (1.0 - 1e-12)) break;
      PetscCall(SphComputeTimeStep(sph, &dt));
      PetscCall(SphStepBegin(sph, PetscMin(dt, end - t)));
      PetscCall(SphStepEnd(sph));
    }
    PetscCall(L2Error(sph, c->couette, end, &error[k]));
  }
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const double tau_p[3] = {0.02, 0.1, 0.5}, tau_c[3] = {0.05, 0.2, 0.5};

static PetscErrorCode Table(SphWallType wall, SphPrecision precision, double hratio, PetscBool check)
{
  PetscFunctionBegin;
  for (int couette = 0; couette < 2; couette++) {
    const double *tau = couette ? tau_c : tau_p;
    double e[3][3];
    printf("%s, wall %s, %s, h/dp %g: relative L2 error\n  across", couette ? "Couette" : "Poiseuille", SphWallTypes[wall],
           SphPrecisions[precision], hratio);
    for (int k = 0; k < 3; k++) printf("  tau=%-6g", tau[k]);
    printf("\n");
    for (int r = 0; r < 3; r++) {
      const Case c = {couette, 10 << r, wall, precision, hratio};
      PetscCall(Run(&c, 3, tau, e[r]));
      printf("  %6d  %.3e  %.3e  %.3e\n", c.across, e[r][0], e[r][1], e[r][2]);
      fflush(stdout);
    }
    printf("  order   %9.2f  %9.2f  %9.2f\n", log2(e[0][0] / e[2][0]) / 2, log2(e[0][1] / e[2][1]) / 2,
           log2(e[0][2] / e[2][2]) / 2);
    if (!check) continue;
    for (int k = 0; k < 3; k++) {
      TEST(e[2][k] <= 0.01, "%s at tau %g: L2 error %g at 40 across, bound 0.01", couette ? "Couette" : "Poiseuille", tau[k],
           e[2][k]);
      if (!(couette && k == 2))
        TEST(log2(e[0][k] / e[2][k]) / 2 >= 1.5, "%s at tau %g: order %g, bound 1.5", couette ? "Couette" : "Poiseuille", tau[k],
             log2(e[0][k] / e[2][k]) / 2);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscBool table = PETSC_FALSE;
  PetscReal hratio = 1.2;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-table", &table, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-hratio", &hratio, NULL));
  if (table) {
    PetscCall(Table(SPH_WALL_BCE, SPH_PRECISION_DOUBLE, hratio, PETSC_FALSE));
    PetscCall(Table(SPH_WALL_ADAMI, SPH_PRECISION_DOUBLE, hratio, PETSC_FALSE));
  }
  PetscCall(Table(SPH_WALL_ADAMI, SPH_PRECISION_SINGLE, hratio, PETSC_TRUE));
  PetscCall(PetscFinalize());
  return test_report();
}
