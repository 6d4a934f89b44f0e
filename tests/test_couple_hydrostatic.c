/*
  test_couple_hydrostatic.c - a tank at rest under gravity with a submerged fixed cube.

  Bounds: pressure within 2 % of rho g H of rho g (H - z) at every fluid marker deeper than h, buoyancy within 2 % of rho g V,
  largest speed below 1 % of sqrt(gH) at the end, and the momentum balance closed to round-off of the pair arithmetic. The kernel
  is Wendland's at h/dp = 1.5: a cubic spline with that many neighbours lets markers pair up under lasting pressure (Dehnen, Aly,
  Mon. Not. R. Astron. Soc. 425 (2012)), which stirs the tank. The state starts from the exact hydrostatic density; -table prints
  a history.
*/
#include "couple.h"
#include "sphfill.h"
#include "testing.h"

#define RHO 1000.0
#define G 9.81

typedef struct {
  PetscInt dim;
  PetscReal dp, width, height, cube, centre; /* m; centre: height of the cube's centre */
  PetscReal tend;
} Tank;

static PetscBool OutsideCube(const PetscReal x[3], void *ctx)
{
  const Tank *t = (const Tank *)ctx;
  const int up = (int)t->dim - 1;
  for (int k = 0; k < t->dim; k++) {
    const double c = k == up ? t->centre : 0.5 * t->width;
    if (fabs(x[k] - c) > 0.5 * t->cube) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static PetscErrorCode MakeFluid(Tank *t, Sph *out)
{
  const int up = (int)t->dim - 1;
  const PetscReal lo[3] = {0, 0, 0};
  PetscReal hi[3] = {t->width, t->width, t->width}, top[3] = {t->width, t->width, t->width}, f[3] = {0, 0, 0}, *x, *p;
  PetscInt n;
  Sph sph;

  PetscFunctionBegin;
  top[up] = t->height;
  hi[up] = 1.5 * t->height;
  f[up] = -G;
  PetscCall(SphCreate(PETSC_COMM_SELF, &sph));
  PetscCall(SphSetDimension(sph, t->dim));
  PetscCall(SphSetSpacing(sph, t->dp));
  PetscCall(SphSetKernel(sph, SPH_KERNEL_WENDLAND));
  PetscCall(SphSetSmoothingRatio(sph, 1.5));
  PetscCall(SphSetDensity(sph, RHO));
  PetscCall(SphSetViscosity(sph, 1.0));
  PetscCall(SphSetMaxSpeed(sph, sqrt(G * t->height)));
  PetscCall(SphSetBodyForce(sph, f));
  PetscCall(SphSetDomain(sph, lo, hi));
  PetscCall(SphSetFromOptions(sph));
  PetscCall(SphFillBox(t->dim, t->dp, lo, top, OutsideCube, t, &n, &x));
  PetscCall(PetscMalloc1(n, &p));
  for (PetscInt i = 0; i < n; i++) p[i] = RHO * G * (t->height - x[3 * i + up]);
  PetscCall(SphAddFluid(sph, n, x, NULL, p));
  PetscCall(PetscFree(p));
  PetscCall(PetscFree(x));
  *out = sph;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddWalls(const Tank *t, Sph sph, Couple couple)
{
  const PetscReal zero[3] = {0, 0, 0}, lo[3] = {0, 0, 0};
  PetscReal hi[3] = {t->width, t->width, t->width}, *x, *vol, *depth, support;
  const PetscBool face[6] = {1, 1, 1, t->dim == 3, t->dim == 3, 0}, none[3] = {0, 0, 0};
  PetscInt n;
  CoupleSurface wall;

  PetscFunctionBegin;
  hi[t->dim - 1] = 1.5 * t->height;
  PetscCall(SphGetSupport(sph, &support));
  PetscCall(SphFillWalls(t->dim, t->dp, lo, hi, face, none, support, &n, &x, &vol, &depth));
  PetscCall(CoupleSurfaceCreateWall(PETSC_COMM_SELF, "tank", n, x, vol, depth, zero, &wall));
  PetscCall(CoupleAddSurface(couple, wall));
  PetscCall(CoupleSurfaceDestroy(&wall));
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(vol));
  PetscCall(PetscFree(depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddCube(const Tank *t, Sph sph, Couple couple, Rigid *rigid)
{
  RigidBodySpec spec;
  PetscReal support;
  PetscInt body;
  CoupleSurface s;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, rigid));
  PetscCall(RigidSetDimension(*rigid, t->dim));
  PetscCall(RigidBodySpecInit(&spec));
  spec.shape = RIGID_BOX;
  spec.motion = RIGID_FIXED;
  spec.density = RHO;
  for (int k = 0; k < 3; k++) {
    spec.size[k] = t->cube;
    spec.position[k] = k == t->dim - 1 ? t->centre : (k < t->dim ? 0.5 * t->width : 0.0);
  }
  PetscCall(RigidAddBody(*rigid, &spec, &body));
  PetscCall(RigidSetUp(*rigid));
  PetscCall(SphGetSupport(sph, &support));
  PetscCall(CoupleSurfaceCreateRigid(*rigid, body, t->dim, t->dp, support, &s));
  PetscCall(CoupleAddSurface(couple, s));
  PetscCall(CoupleSurfaceDestroy(&s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Largest |p - rho g (H - z)| / (rho g H) below the surface layer. */
static PetscErrorCode PressureError(const Tank *t, Sph sph, double *error, double *rms)
{
  PetscInt n, nb, m = 0;
  PetscReal *x, *p, h;
  double sum = 0.0;

  PetscFunctionBegin;
  PetscCall(SphGetCounts(sph, &n, &nb, NULL));
  PetscCall(SphGetSmoothingLength(sph, &h));
  PetscCall(PetscMalloc2(3 * (size_t)(n + nb), &x, (size_t)(n + nb), &p));
  PetscCall(SphGetFields(sph, &(SphFields){.x = x, .p = p}));
  *error = 0.0;
  for (PetscInt i = 0; i < n; i++) {
    const double z = x[3 * i + t->dim - 1], d = (p[i] - RHO * G * (t->height - z)) / (RHO * G * t->height);
    if (z > t->height - h) continue;
    *error = fmax(*error, fabs(d));
    sum += d * d;
    m++;
  }
  *rms = sqrt(sum / m);
  PetscCall(PetscFree2(x, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Buoyancy: mean over the second half of the run. */
static PetscErrorCode Run(Tank *t, PetscBool table)
{
  const int up = (int)t->dim - 1;
  const double weight = RHO * G * pow(t->cube, (double)t->dim);
  double error, rms, lift = 0.0, span = 0.0, next = 0.0;
  PetscReal time = 0.0, dt;
  Sph sph;
  Couple couple;
  Rigid rigid;
  SphSums sums;
  CoupleAudit audit;
  CoupleBalance bal;

  PetscFunctionBegin;
  PetscCall(MakeFluid(t, &sph));
  PetscCall(CoupleCreate(PETSC_COMM_SELF, &couple));
  PetscCall(CoupleSetSph(couple, sph));
  PetscCall(AddWalls(t, sph, couple));
  PetscCall(AddCube(t, sph, couple, &rigid));
  PetscCall(CoupleSetUp(couple));
  while (time < t->tend) {
    PetscCall(CoupleStep(couple, t->tend, &dt));
    PetscCall(CoupleGetTime(couple, &time, NULL));
    PetscCall(CoupleGetAudit(couple, 1, &audit));
    if (time > 0.5 * t->tend) {
      lift += dt * audit.force[up];
      span += dt;
    }
    if (table && time >= next) {
      PetscCall(SphGetSums(sph, &sums));
      PetscCall(PressureError(t, sph, &error, &rms));
      printf("  t %.3f vmax/sqrt(gH) %.2e  p error max %.4f rms %.4f  lift/weight %.4f\n", time, sums.vmax / sqrt(G * t->height),
             error, rms, audit.force[up] / weight);
      fflush(stdout);
      next += 0.1 * t->tend;
    }
  }
  PetscCall(SphGetSums(sph, &sums));
  PetscCall(PressureError(t, sph, &error, &rms));
  PetscCall(CoupleGetBalance(couple, &bal));
  lift /= span;
  printf("%" PetscInt_FMT "D tank, dp %g m: pressure error max %.4f rms %.4f of rho g H; buoyancy/(rho g V) %.4f; speed %.2e "
         "sqrt(gH); momentum residual %.1e of %.3g kg m/s\n",
         t->dim, (double)t->dp, error, rms, lift / weight, sums.vmax / sqrt(G * t->height), (double)bal.residual[up],
         (double)bal.scale);
  TEST_NEAR(error, 0.0, 0.02, "largest pressure error over rho g H");
  TEST_NEAR(lift / weight, 1.0, 0.02, "buoyancy over rho g V");
  TEST_NEAR(sums.vmax / sqrt(G * t->height), 0.0, 0.01, "largest speed over sqrt(gH)");
  /* single-precision pair sums: each step's impulse is good to about 1e-6, errors of either sign */
  TEST_NEAR(bal.residual[up] / bal.scale, 0.0, 1e-5, "momentum residual over its largest term");
  PetscCall(CoupleDestroy(&couple));
  PetscCall(SphDestroy(&sph));
  PetscCall(RigidDestroy(&rigid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  Tank flat = {2, 0.01, 0.4, 0.4, 0.1, 0.15, 1.0}, deep = {3, 0.025, 0.3, 0.3, 0.1, 0.125, 1.0};
  PetscBool table = PETSC_FALSE, only2d = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-table", &table, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-only2d", &only2d, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-tend", &flat.tend, NULL));
  PetscCall(Run(&flat, table));
  if (!only2d) PetscCall(Run(&deep, table));
  PetscCall(PetscFinalize());
  return test_report();
}
