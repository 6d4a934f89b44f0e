/*
  test_sph_cavity.c - lid-driven cavity against Ghia, Ghia, Shin, J. Comput. Phys. 48 (1982).

  Unit box, lid speed 1 m/s along x at y = 1, reached in 1 s, Re = 100 (400 with -re); velocities on the centre lines by the
  kernel's normalised mean. The lid's markers travel with it, and those that leave its span at one end come back at the other. A
  background pressure of rho c_s^2/10 keeps the pressure positive: without one, markers leave through the corners of the lid.
  Bounds: 3 % of the lid speed in the rms, and at any point 2 dp U/L, what the steepest of the profiles, about 2 U/L, changes
  over one spacing. No marker may leave the box. Options: -across, -re, -tend.
*/
#include "sphcase.h"

typedef struct {
  double at, u; /* u(0.5, y = at) or v(x = at, 0.5) */
} Point;

static const Point u100[] = {{0.9531, 0.68717}, {0.7344, 0.00332}, {0.5, -0.20581}, {0.4531, -0.21090}, {0.1719, -0.10150}},
                   v100[] = {{0.8047, -0.24533}, {0.2344, 0.17527}};
static const Point u400[] = {{0.9531, 0.61756}, {0.7344, 0.16256}, {0.5, -0.11477}, {0.2813, -0.32726}, {0.1719, -0.24299}},
                   v400[] = {{0.8594, -0.44993}, {0.5, 0.05186}, {0.2344, 0.30203}};

/* Errors over the lid speed. */
static PetscErrorCode Compare(Sph sph, int vertical, int n, const Point *ref, double *sum, double *most)
{
  PetscFunctionBegin;
  for (int k = 0; k < n; k++) {
    const PetscReal x[3] = {vertical ? ref[k].at : 0.5, vertical ? 0.5 : ref[k].at, 0};
    PetscReal v[3];
    PetscCall(SphSample(sph, 1, x, v, NULL));
    const double d = (double)v[vertical] - ref[k].u;
    printf("  %s at %.4f: %.5f, Ghia %.5f, difference %.4f\n", vertical ? "v(x, 0.5)" : "u(0.5, y)", ref[k].at,
           (double)v[vertical], ref[k].u, d);
    *sum += d * d;
    *most = fmax(*most, fabs(d));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define RAMP 1.0 /* s */

typedef struct {
  PetscInt n, group;
  PetscReal *x0, *x, *v;
} Lid;

static PetscErrorCode LidCreate(Sph sph, Lid *lid)
{
  PetscInt n, nb;
  PetscReal *x;

  PetscFunctionBegin;
  PetscCall(SphGetCounts(sph, &n, &nb, NULL));
  PetscCall(PetscMalloc1(3 * (size_t)(n + nb), &x));
  PetscCall(PetscMalloc3(3 * (size_t)nb, &lid->x0, 3 * (size_t)nb, &lid->x, 3 * (size_t)nb, &lid->v));
  PetscCall(SphGetFields(sph, &(SphFields){.x = x}));
  PetscCall(PetscArraycpy(lid->x0, x + 3 * n, 3 * nb));
  PetscCall(PetscFree(x));
  lid->n = nb;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LidMove(Lid *lid, Sph sph, PetscReal t)
{
  const PetscReal speed = PetscMin(t / RAMP, 1.0), way = t < RAMP ? 0.5 * t * t / RAMP : t - 0.5 * RAMP;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(lid->x, lid->x0, 3 * lid->n));
  PetscCall(PetscArrayzero(lid->v, 3 * lid->n));
  for (PetscInt i = 0; i < lid->n; i++) {
    PetscReal *x = lid->x + 3 * i;
    if (x[1] < 1.0 || x[0] < 0.0 || x[0] > 1.0) continue;
    x[0] += way - floor(x[0] + way);
    lid->v[3 * i] = speed;
  }
  PetscCall(SphSetBoundaryMotion(sph, lid->group, lid->x, lid->v, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CavityRun(Lid *lid, Sph sph, PetscReal end)
{
  PetscReal t, dt;

  PetscFunctionBegin;
  for (;;) {
    PetscCall(SphGetTime(sph, &t, NULL));
    if (t >= end * (1.0 - 1e-12)) break;
    PetscCall(SphComputeTimeStep(sph, &dt));
    dt = PetscMin(dt, end - t);
    PetscCall(SphStepBegin(sph, dt));
    PetscCall(LidMove(lid, sph, t + 0.5 * dt));
    PetscCall(SphStepEnd(sph));
    PetscCall(LidMove(lid, sph, t + dt));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CountOutside(Sph sph, PetscInt *outside)
{
  PetscInt n, nb;
  PetscReal *x;

  PetscFunctionBegin;
  PetscCall(SphGetCounts(sph, &n, &nb, NULL));
  PetscCall(PetscMalloc1(3 * (size_t)(n + nb), &x));
  PetscCall(SphGetFields(sph, &(SphFields){.x = x}));
  *outside = 0;
  for (PetscInt i = 0; i < n; i++) *outside += x[3 * i] < 0 || x[3 * i] > 1 || x[3 * i + 1] < 0 || x[3 * i + 1] > 1;
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscInt across = 32, re = 100, outside;
  PetscReal tend = 12.0;
  Lid lid;
  FlowCase c = {.dim = 2,
                .hi = {1, 1, 0},
                .wall = {1, 1, 1, 1, 0, 0},
                .rho = 1.0,
                .vmax = 1.0,
                .kernel = SPH_KERNEL_WENDLAND,
                .hratio = 1.5,
                .xsph = -1.0,
                .shifting = SPH_SHIFTING_SUN};
  Sph sph;
  SphSums a;
  double sum = 0.0, most = 0.0;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-across", &across, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-re", &re, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-tend", &tend, NULL));
  c.dp = 1.0 / (PetscReal)across;
  c.mu = 1.0 / (PetscReal)re;
  PetscCall(FlowFluid(&c, &sph));
  PetscCall(SphSetBackgroundPressure(sph, 10.0 * c.rho));
  PetscCall(FlowWalls(&c, sph, &lid.group));
  PetscCall(SphSetUp(sph));
  PetscCall(LidCreate(sph, &lid));
  for (int k = 1; k <= 3; k++) {
    PetscCall(CavityRun(&lid, sph, tend * k / 3.0));
    PetscCall(SphGetSums(sph, &a));
    printf("cavity Re %d, %d across, t %.2f: kinetic energy %.6f\n", (int)re, (int)across, (double)(tend * k / 3.0),
           (double)a.kinetic);
    fflush(stdout);
  }
  const int nu = 5, nv = re == 400 ? 3 : 2;
  PetscCall(Compare(sph, 0, nu, re == 400 ? u400 : u100, &sum, &most));
  PetscCall(Compare(sph, 1, nv, re == 400 ? v400 : v100, &sum, &most));
  sum = sqrt(sum / (nu + nv));
  printf("cavity Re %d, %d across: rms difference %.4f, largest %.4f of the lid speed\n", (int)re, (int)across, sum, most);
  PetscCall(CountOutside(sph, &outside));
  TEST(outside == 0, "%d markers are outside the box", (int)outside);
  TEST(re == 100 || re == 400, "-re %d: references are for 100 and 400", (int)re);
  TEST_NEAR(sum, 0.0, 0.03, "rms difference over the lid speed");
  TEST_NEAR(most, 0.0, 2.0 * c.dp, "largest difference over the lid speed");
  PetscCall(PetscFree3(lid.x0, lid.x, lid.v));
  PetscCall(SphDestroy(&sph));
  PetscCall(PetscFinalize());
  return test_report();
}
