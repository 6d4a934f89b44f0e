/*
  test_sph_dambreak.c - front of a collapsing column of water against Martin and Moyce, Phil. Trans. R. Soc. A 244 (1952).

  Plane column a = 2.25 in wide and 2a high (n^2 = 2) released at t = 0 beside a wall on a dry bed. Compared are Z = z/a, z the
  largest x of the fluid, at T = t sqrt(2 g/a), and the slope dZ/dT between T = 1.997 and 5.091, which the unknown time
  the gate took does not enter: 1.515 in the experiment. Bound on the slope: 10 %, the lead that codes without a gate and a dry
  rough bed have over the experiment (5 to 15 % in published SPH and level-set runs); on Z: one gate delay, 0.3 in T, times that
  slope plus the slope's bound. The bed is free of friction: its
  boundary layer is far thinner than a spacing. No marker may leave through the walls. Options: -across n, markers across a.
*/
#include "sphcase.h"

#define G 9.81
#define A 0.05715

static void Hydrostatic(const PetscReal x[3], void *ctx, PetscReal v[3], PetscReal *p)
{
  (void)ctx;
  (void)v;
  *p = 1000.0 * G * (2.0 * A - x[1]);
}

/* Largest x over a, and how many markers are behind a wall by more than dp. */
static PetscErrorCode Front(Sph sph, PetscReal dp, double *z, PetscInt *lost)
{
  PetscInt n, nb;
  PetscReal *x;

  PetscFunctionBegin;
  PetscCall(SphGetCounts(sph, &n, &nb, lost));
  PetscCall(PetscMalloc1(3 * (size_t)(n + nb), &x));
  PetscCall(SphGetFields(sph, &(SphFields){.x = x}));
  *z = 0.0;
  for (PetscInt i = 0; i < n; i++) {
    *z = fmax(*z, x[3 * i] / A);
    *lost += x[3 * i] < -dp || x[3 * i + 1] < -dp;
  }
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  const double ref[][2] = {{1.219, 1.474}, {1.997, 2.292}, {3.345, 4.134}, {5.091, 6.980}};
  const double slope = (6.980 - 2.292) / (5.091 - 1.997);
  double z[4];
  PetscInt across = 16, group, lost;
  FlowCase c = {.dim = 2,
                .hi = {9 * A, 3 * A, 0},
                .fluidhi = {A, 2 * A, 0},
                .wall = {1, 1, 1, 0, 0, 0},
                .rho = 1000.0,
                .mu = 1e-3,
                .f = {0, -G, 0},
                .kernel = SPH_KERNEL_WENDLAND,
                .hratio = 1.5,
                .xsph = -1.0,
                .initial = Hydrostatic};
  Sph sph;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-across", &across, NULL));
  c.dp = A / (PetscReal)across;
  c.vmax = 2.0 * sqrt(G * 2.0 * A);
  PetscCall(FlowFluid(&c, &sph));
  PetscCall(SphSetViscosityType(sph, SPH_VISCOSITY_ARTIFICIAL));
  PetscCall(SphSetArtificialViscosity(sph, 0.02));
  PetscCall(SphSetSlip(sph, SPH_SLIP_FREE));
  PetscCall(SphSetFromOptions(sph));
  PetscCall(FlowWalls(&c, sph, &group));
  PetscCall(SphSetUp(sph));
  for (int k = 0; k < 4; k++) {
    PetscCall(FlowRun(sph, ref[k][0] * sqrt(A / (2.0 * G))));
    PetscCall(Front(sph, c.dp, &z[k], &lost));
    printf("dam break, %d across: T %.3f Z %.3f, Martin and Moyce %.3f\n", (int)across, ref[k][0], z[k], ref[k][1]);
    fflush(stdout);
    TEST_NEAR(z[k], ref[k][1], 0.3 * slope + 0.1 * (ref[k][1] - 1.0), "front Z");
  }
  const double s = (z[3] - z[1]) / (ref[3][0] - ref[1][0]);
  printf("dam break, %d across: slope dZ/dT %.3f, Martin and Moyce %.3f; %d markers behind the walls\n", (int)across, s, slope,
         (int)lost);
  TEST_REL(s, slope, 0.1, "slope dZ/dT");
  TEST(lost == 0, "%d markers left", (int)lost);
  PetscCall(SphDestroy(&sph));
  PetscCall(PetscFinalize());
  return test_report();
}
