/*
  test_sph_turning.c - no-slip at walls that turn: fluid in a box that turns as a whole (2D, wall adami).

  1. Fluid on its lattice in rigid rotation, v = w x r, pressure 0. On the lattice every viscous sum over a full support is
  Sum m F (v_a - v_b) = w x Sum m F x_ab = 0 by symmetry, provided that walls lend the velocity w x r too, whatever their depth:
  walls make it so exactly, as r (v_a + w x (<x> - x_a) - <v>) = 0 for any linear v. What is left is round-off: N terms of size
  m |F| |v| wrong by (N + 32) u each, as in sphbrute.h, and in the mean of walls as many. With w of the walls unset the sum is of
  first order, 1e10 times as much.

  2. The box turns on for half a turn. In its frame fluid at rest is the exact solution, so kinetic energy over that of the same
  markers in rigid rotation stays 1. Without the walls' angular velocity walls seem displaced by a marker's depth, about dp, which
  makes the energy wrong by about 2 dp/(L/2): 20 % and 10 % at 20 and 40 across at first. A second-order method is left with the
  square, (dp/(L/2))^2: 1 % and 0.25 %.
*/
#include "sphcase.h"

#define LENGTH 1.0
#define OMEGA 1.0

static void Turning(const PetscReal x[3], void *ctx, PetscReal v[3], PetscReal *p)
{
  (void)ctx;
  (void)p;
  v[0] = -OMEGA * x[1];
  v[1] = OMEGA * x[0];
}

typedef struct {
  PetscInt n, group;
  PetscReal *x, *v, *a, *w; /* n x 3: places at the beginning, state to set */
  PetscReal *now;
} Walls;

/* The walls at time t. */
static PetscErrorCode Turn(Sph sph, Walls *b, PetscReal t, PetscBool known)
{
  const PetscReal c = PetscCosReal(OMEGA * t), s = PetscSinReal(OMEGA * t);

  PetscFunctionBegin;
  for (PetscInt i = 0; i < b->n; i++) {
    PetscReal *x = b->now + 3 * i;
    x[0] = c * b->x[3 * i] - s * b->x[3 * i + 1];
    x[1] = s * b->x[3 * i] + c * b->x[3 * i + 1];
    b->v[3 * i] = -OMEGA * x[1];
    b->v[3 * i + 1] = OMEGA * x[0];
    b->a[3 * i] = -OMEGA * OMEGA * x[0];
    b->a[3 * i + 1] = -OMEGA * OMEGA * x[1];
    b->w[3 * i + 2] = known ? OMEGA : 0.0;
  }
  PetscCall(SphSetBoundaryMotion(sph, b->group, b->now, b->v, known || t > 0.0 ? b->a : NULL));
  PetscCall(SphSetBoundaryRotation(sph, b->group, b->w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(PetscInt across, Sph *sph, Walls *b)
{
  const FlowCase c = {.dim = 2,
                      .dp = LENGTH / (PetscReal)across,
                      .lo = {-0.5 * LENGTH, -0.5 * LENGTH, 0},
                      .hi = {0.5 * LENGTH, 0.5 * LENGTH, 0},
                      .wall = {1, 1, 1, 1, 0, 0},
                      .rho = 1000.0,
                      .mu = 10.0,
                      .vmax = 0.75 * OMEGA * LENGTH,
                      .hratio = 1.2,
                      .xsph = 0.0,
                      .initial = Turning};
  const PetscReal lo[3] = {-LENGTH, -LENGTH, 0}, hi[3] = {LENGTH, LENGTH, 0};
  PetscReal *volume, *depth, support;

  PetscFunctionBegin;
  PetscCall(FlowFluid(&c, sph));
  PetscCall(SphSetPrecision(*sph, SPH_PRECISION_DOUBLE));
  PetscCall(SphSetDomain(*sph, lo, hi)); /* room for the walls to turn */
  PetscCall(SphGetSupport(*sph, &support));
  PetscCall(SphFillWalls(2, c.dp, c.lo, c.hi, c.wall, c.periodic, support, &b->n, &b->x, &volume, &depth));
  PetscCall(PetscCalloc4(3 * (size_t)b->n, &b->v, 3 * (size_t)b->n, &b->a, 3 * (size_t)b->n, &b->w, 3 * (size_t)b->n, &b->now));
  for (PetscInt i = 0; i < b->n; i++) Turning(b->x + 3 * i, NULL, b->v + 3 * i, NULL);
  PetscCall(SphAddBoundary(*sph, b->n, b->x, b->v, volume, depth, &b->group));
  PetscCall(SphSetUp(*sph));
  PetscCall(PetscFree(volume));
  PetscCall(PetscFree(depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(Sph *sph, Walls *b)
{
  PetscFunctionBegin;
  PetscCall(PetscFree4(b->v, b->a, b->w, b->now));
  PetscCall(PetscFree(b->x));
  PetscCall(SphDestroy(sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Largest acceleration of a fluid marker, walls without their centripetal acceleration, so that their pressures vanish too. */
static PetscErrorCode Friction(PetscBool known, double *most, double *bound)
{
  const PetscReal zero[3] = {0, 0, 0};
  PetscInt n, nb;
  PetscReal *a;
  Walls b;
  Sph sph;

  PetscFunctionBegin;
  PetscCall(Create(20, &sph, &b));
  PetscCall(PetscArrayzero(b.w, 3 * b.n));
  for (PetscInt i = 0; i < b.n; i++) b.w[3 * i + 2] = known ? OMEGA : 0.0;
  PetscCall(SphSetBodyForce(sph, zero));
  PetscCall(SphSetBoundaryRotation(sph, b.group, b.w));
  PetscCall(SphStepBegin(sph, 1e-12)); /* evaluates the state as it is; what 1e-12 s moves is counted below */
  PetscCall(SphGetCounts(sph, &n, &nb, NULL));
  PetscCall(PetscMalloc1(3 * (size_t)(n + nb), &a));
  PetscCall(SphGetFields(sph, &(SphFields){.a = a}));
  *most = 0.0;
  for (PetscInt i = 0; i < 3 * n; i++) *most = PetscMax(*most, PetscAbsReal(a[i]));
  /* 20 neighbours: each |2 nu F V| <= 2 nu 4/dp^2 (the Laplacian's largest weight), |v| <= 0.8 w L */
  *bound = 20.0 * (2 * 20.0 + 32.0) * PETSC_MACHINE_EPSILON * 2.0 * 0.01 * 4.0 * 400.0 * 0.8 * OMEGA * LENGTH;
  PetscCall(PetscFree(a));
  PetscCall(Destroy(&sph, &b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Kinetic energy after half a turn over that of rigid rotation, less 1. */
static PetscErrorCode Energy(PetscInt across, PetscBool known, double *error)
{
  PetscReal t = 0.0, dt, kinetic = 0.0, rigid = 0.0, *x, *v;
  PetscInt n, nb;
  Walls b;
  Sph sph;

  PetscFunctionBegin;
  PetscCall(Create(across, &sph, &b));
  PetscCall(Turn(sph, &b, 0.0, known));
  while (t < PETSC_PI / OMEGA) {
    PetscCall(SphComputeTimeStep(sph, &dt));
    PetscCall(SphStepBegin(sph, dt));
    PetscCall(Turn(sph, &b, t + 0.5 * dt, known));
    PetscCall(SphStepEnd(sph));
    t += dt;
    PetscCall(Turn(sph, &b, t, known));
  }
  PetscCall(SphGetCounts(sph, &n, &nb, NULL));
  PetscCall(PetscMalloc2(3 * (size_t)(n + nb), &x, 3 * (size_t)(n + nb), &v));
  PetscCall(SphGetFields(sph, &(SphFields){.x = x, .v = v}));
  for (PetscInt i = 0; i < 3 * n; i++) {
    kinetic += v[i] * v[i];
    rigid += i % 3 < 2 ? PetscSqr(OMEGA * x[i]) : 0.0;
  }
  *error = kinetic / rigid - 1.0;
  PetscCall(PetscFree2(x, v));
  PetscCall(Destroy(&sph, &b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  double most, bound, e;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(Friction(PETSC_TRUE, &most, &bound));
  printf("friction in rigid rotation: %.3g m/s^2, round-off %.3g\n", most, bound);
  TEST(most <= bound, "friction %g m/s^2 in rigid rotation, bound %g", most, bound);
  PetscCall(Friction(PETSC_FALSE, &most, &bound));
  printf("the same, angular velocity of the walls unset: %.3g m/s^2\n", most);
  TEST(most > 1e6 * bound, "friction %g m/s^2 though the walls' angular velocity is unset", most);
  for (PetscInt across = 20; across <= 40; across *= 2) {
    PetscCall(Energy(across, PETSC_TRUE, &e));
    printf("%d across: kinetic energy after half a turn %+.3f %%\n", (int)across, 100.0 * e);
    TEST_NEAR(e, 0.0, PetscSqr(2.0 / (double)across), "kinetic energy over that of rigid rotation - 1");
  }
  PetscCall(Energy(20, PETSC_FALSE, &e));
  printf("20 across, angular velocity unset: %+.3f %%\n", 100.0 * e);
  TEST(e > 0.02, "without the walls' angular velocity the energy is off by %g only", e);
  PetscCall(PetscFinalize());
  return test_report();
}
