/*
  test_rigid_lumped.c - lumped-elasticity beams: the static cantilever of Capasso et al. (Table 1) for N = 5, 10, 20 trunks
  against their Eq. 22 and against the exact answer of the discrete model, large deflections against the elastica, the first
  frequency, a beam whose bearing yields, a beam in 2D, refusals.
*/
#include "rigid.h"
#include "rigidtest.h"

static const char help[] = "Lumped-elasticity beams.\n";

/* Table 1: L .079, b = h = .005 m, 1100 kg/m^3, 12 MPa, 9.81 m/s^2: EI 6.25e-4 N m^2, q .269775 N/m */
static PetscErrorCode PaperBeam(RigidLumpedSpec *s, PetscInt N)
{
  PetscFunctionBegin;
  PetscCall(RigidLumpedSpecInit(s));
  s->end[0] = .079;
  s->trunks = N;
  s->section[0] = s->section[1] = .005;
  s->density = 1100.;
  s->young = 1.2e7;
  s->end0 = RIGID_END_CLAMP;
  s->damping = .08;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Runs until the beam rests; nodes into x. Gravity grows smoothly over the first 0.6 of the steps, so that high modes stay quiet.
 */
static PetscErrorCode Settle(const RigidLumpedSpec *s, PetscInt dim, const PetscReal g[3], PetscReal dt, PetscInt steps,
                             PetscReal x[], PetscReal *ke)
{
  Rigid r;
  PetscInt first;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidSetDimension(r, dim));
  PetscCall(RigidSetGravity(r, g));
  PetscCall(RigidAddLumpedBeam(r, s, &first, NULL));
  PetscCall(RigidSetUp(r));
  for (PetscInt n = 1; n <= steps; n++) {
    const PetscReal t = PetscMin(1., (PetscReal)n / (.6 * (PetscReal)steps)), ramp = t * t * t * (10. + t * (6. * t - 15.));
    const PetscReal now[3] = {ramp * g[0], ramp * g[1], ramp * g[2]};
    PetscCall(RigidSetGravity(r, now));
    PetscCall(RigidAdvance(r, (PetscReal)n * dt));
  }
  PetscCall(RigidGetEnergy(r, ke, NULL));
  PetscCall(RigidGetLumpedNodes(r, first, s->trunks, x));
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Small-rotation answer of the discrete model, Eqs. 15-20: moments of the trunks' weights, angles M/K summed, deflections summed.
 */
static void DiscreteDeflection(PetscInt N, PetscReal L, PetscReal EI, PetscReal q, PetscReal v[])
{
  const PetscReal dx = L / N;
  PetscReal theta = 0.;
  v[0] = 0.;
  for (PetscInt i = 0; i < N; i++) {
    PetscReal M = 0.;
    for (PetscInt j = i; j < N; j++) M += q * dx * (j + .5 - i) * dx;
    theta += M / ((i == 0 ? 2. : 1.) * EI / dx);
    v[i + 1] = v[i] + theta * dx;
  }
}

static PetscErrorCode TestStatic(void)
{
  const PetscInt N[3] = {5, 10, 20};
  const PetscReal L = .079, EI = 6.25e-4, q = .269775, tip = q * L * L * L * L / (8. * EI);
  RigidLumpedSpec s;
  PetscReal x[63], v[21], ke;

  PetscFunctionBegin;
  TEST_REL(tip, 2.101552e-3, 1e-6, "tip of Eq. 22");
  for (int m = 0; m < 3; m++) {
    PetscReal worst = 0., worst22 = 0.;
    const PetscReal weak[3] = {0., 0., -9.81e-4}, full[3] = {0., 0., -9.81};
    PetscCall(PaperBeam(&s, N[m]));
    /* loads 1e-4 times as large: rotations below 4e-6, geometry linear to 1e-11; damped at about 70 /s for 0.56 s after the load
     * is full */
    PetscCall(Settle(&s, 3, weak, 2e-3, 700, x, &ke));
    DiscreteDeflection(N[m], L, EI, q, v);
    for (PetscInt i = 0; i <= N[m]; i++) {
      const PetscReal xi = L * i / N[m], v22 = q * xi * xi / EI * (L * L / 4. - L * xi / 6. + xi * xi / 24.);
      worst = PetscMax(worst, fabs(-x[3 * i + 2] * 1e4 - v[i]) / tip);
      worst22 = PetscMax(worst22, fabs(-x[3 * i + 2] * 1e4 - v22) / tip);
    }
    printf("N = %2d: tip %.6f mm (%.6f), /Eq. 22 - 1 = %.6f (1/N^2 = %.6f), nodes off the discrete answer by %.1e, off Eq. 22 by "
           "%.4f of the tip\n",
           (int)N[m], -x[3 * N[m] + 2] * 1e7, v[N[m]] * 1e3, -x[3 * N[m] + 2] * 1e4 / tip - 1., 1. / (N[m] * N[m]), worst,
           worst22);
    TEST(worst < 1e-6, "N = %d: off the discrete answer by %g of the tip", (int)N[m],
         worst); /* settling; joints to 1e-13/4e-8 m */
    TEST_NEAR(-x[3 * N[m] + 2] * 1e4 / tip, 1. + 1. / (N[m] * N[m]), 1e-6, "error law 1/N^2");
    TEST(worst22 <= 1.0001 / (N[m] * N[m]), "N = %d: off Eq. 22 by %g of the tip", (int)N[m], worst22); /* the tip is the worst */
    /* full weight: geometry adds -(v/L)^2 order 1e-3 */
    PetscCall(Settle(&s, 3, full, 2e-3, 700, x, &ke));
    TEST_NEAR(-x[3 * N[m] + 2] / tip, 1. + 1. / (N[m] * N[m]), 1e-3, "tip at full weight");
    if (N[m] == 5)
      for (int i = 1; i < 5; i++) {
        static const PetscReal table[4] = {.146828e-3, .511097e-3, .998657e-3, 1.542259e-3};
        TEST_NEAR(-x[3 * i + 2], table[i - 1], 1.05 / 25. * tip, "Eq. 22 at x/L = .2 ... .8");
      }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Self weight, lambda = q L^3/EI = 10: (x, y)/L = (.656354, .700200), the elastica; second order in 1/N. */
static PetscErrorCode TestElastica(void)
{
  const PetscReal g[3] = {0., 0., -10.};
  PetscReal ex[3], ey[3], x[3 * 41], ke;

  PetscFunctionBegin;
  for (int m = 0; m < 3; m++) {
    RigidLumpedSpec s;
    PetscCall(RigidLumpedSpecInit(&s));
    s.end[0] = 1.;
    s.trunks = 10 << m;
    s.section[0] = .02;
    s.rhoA = 1.;
    s.EI = 1.;
    s.end0 = RIGID_END_CLAMP;
    s.hingedamping = .15 * s.trunks; /* 0.15 s times K: first mode 3.5 rad/s (straight) to about 8 */
    PetscCall(Settle(&s, 3, g, .05, 300, x, &ke));
    ex[m] = x[3 * s.trunks] - .656354;
    ey[m] = -x[3 * s.trunks + 2] - .700200;
    TEST(ke < 1e-10, "still moving: %g J", ke); /* 1 kg at 1.4e-5 m/s swings by 2e-6 m at 8 rad/s */
    TEST_NEAR(x[3 * s.trunks + 1], 0., 1e-10, "in the plane");
  }
  printf("elastica, lambda = 10: tip off by (%.2e, %.2e), (%.2e, %.2e), (%.2e, %.2e) for N = 10, 20, 40; orders %.2f %.2f\n",
         ex[0], ey[0], ex[1], ey[1], ex[2], ey[2], log2(ey[0] / ey[1]), log2(ey[1] / ey[2]));
  TEST_NEAR(log2(fabs(ey[0] / ey[1])), 2., .15, "order");
  TEST_NEAR(log2(fabs(ey[1] / ey[2])), 2., .15, "order");
  TEST_NEAR((4. * ex[2] - ex[1]) / 3., 0., 2e-5,
            "x of the elastica after extrapolation"); /* dt^4 terms of 1e-3 error, and the reference's digits */
  TEST_NEAR((4. * ey[2] - ey[1]) / 3., 0., 2e-5, "y of the elastica after extrapolation");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* First frequency of a cantilever, 3.516015 sqrt(EI/(rho A L^4)), from the swing that a small weight starts; in 2D. */
static PetscErrorCode FirstFrequency(PetscInt N, PetscReal *ratio)
{
  Rigid r;
  RigidLumpedSpec s;
  const PetscReal g[3] = {0., -1e-4, 0.}, dt = .01, w1 = 3.516015;
  PetscReal sc = 0., ss = 0., best = 0., wbest = 0., y[3000], x[3 * 41], mean = 0.;
  PetscInt first;
  const int steps = 2500;

  PetscFunctionBegin;
  PetscCall(RigidLumpedSpecInit(&s));
  s.end[0] = 1.;
  s.trunks = N;
  s.section[0] = 1., s.section[1] = .01;
  s.EI = s.rhoA = 1.;
  s.end0 = RIGID_END_CLAMP;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidSetDimension(r, 2));
  PetscCall(RigidSetGravity(r, g));
  PetscCall(RigidAddLumpedBeam(r, &s, &first, NULL));
  PetscCall(RigidSetUp(r));
  for (int n = 0; n < steps; n++) {
    PetscCall(RigidAdvance(r, (n + 1) * dt));
    PetscCall(RigidGetLumpedNodes(r, first, N, x));
    y[n] = x[3 * N + 1];
    mean += y[n] / steps;
  }
  PetscCall(RigidDestroy(&r));
  /* largest Fourier coefficient under a Hann window near w1 */
  for (PetscReal w = .9 * w1; w < 1.1 * w1; w += 1e-4 * w1) {
    sc = ss = 0.;
    for (int n = 0; n < steps; n++) {
      const PetscReal win = 1. - cos(2. * PETSC_PI * (n + .5) / steps);
      sc += win * (y[n] - mean) * cos(w * (n + 1) * dt);
      ss += win * (y[n] - mean) * sin(w * (n + 1) * dt);
    }
    if (sc * sc + ss * ss > best) best = sc * sc + ss * ss, wbest = w;
  }
  *ratio = wbest / w1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestFrequency(void)
{
  PetscReal a, b;

  PetscFunctionBegin;
  PetscCall(FirstFrequency(5, &a));
  PetscCall(FirstFrequency(10, &b));
  printf("first frequency / Euler-Bernoulli: N = 5 %.4f, N = 10 %.4f\n", a, b);
  /* grid of 1e-4, time error (w dt)^2/12 = 1e-4; 1/N^2 with a factor of order one */
  TEST(fabs(a - 1.) < 1. / 25. && fabs(b - 1.) < 1. / 100., "first frequency off by %g, %g", a - 1., b - 1.);
  TEST_NEAR((a - 1.) / (b - 1.), 4., .7, "second order");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Hinges that bear 1.1 of the bearing's moment q L^2/2 hold. With 0.5 the bearing yields until the weight's arm is half as long:
  the beam hangs 60 degrees down at least. A bearing that breaks lets it fall.
*/
static PetscErrorCode TestCollapse(void)
{
  const PetscReal g[3] = {0., 0., -9.81}, My = .269775 * .079 * .079 / 2.;
  PetscReal tip[3], x[33], ke;

  PetscFunctionBegin;
  for (int m = 0; m < 3; m++) {
    RigidLumpedSpec s;
    PetscCall(PaperBeam(&s, 10));
    s.yield = (m == 0 ? 1.1 : .5) * My;
    if (m > 0) s.damping = m == 1 ? .005 : 0.;
    if (m == 2) s.rupture = .3;
    PetscCall(Settle(&s, 3, g, 1e-3, m == 2 ? 500 : 1500, x, &ke));
    tip[m] = -x[32];
  }
  printf("yield at 1.1, 0.5 of the bearing's moment: tip %.5f, %.5f m; with rupture at .3 rad: %.4f m after .5 s\n", tip[0],
         tip[1], tip[2]);
  TEST_NEAR(tip[0], 2.1226e-3, 1e-5, "holds"); /* 1.01 x Eq. 22, geometry -1e-3 */
  TEST(tip[1] > .99 * .079 * sin(PETSC_PI / 3.), "does not collapse: %g m", tip[1]);
  TEST(tip[2] > .1, "does not fall: %g m", tip[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define REFUSE(change, a, b)                                                                                                     \
  do {                                                                                                                           \
    RigidLumpedSpec s;                                                                                                           \
    PetscCall(PaperBeam(&s, 5));                                                                                                 \
    change;                                                                                                                      \
    Refused(RigidAddLumpedBeam(r, &s, NULL, NULL), #change, a, b);                                                               \
  } while (0)

static PetscErrorCode TestBadInput(void)
{
  Rigid r;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(PetscPushErrorHandler(TestCatch, NULL));
  REFUSE(s.trunks = 0, "trunks = 0", ">= 1");
  REFUSE(s.end[0] = 0., "length = 0", "> 0");
  REFUSE(s.section[0] = 0., "section[0] = 0", "> 0");
  REFUSE(s.section[1] = .004, "0.005 x 0.004", "square");
  REFUSE(s.density = -1.5, "density = -1.5", "> 0");
  REFUSE(s.young = 0., "young = 0", "> 0");
  REFUSE(s.EI = -2.5, "EI = -2.5", "> 0");
  REFUSE(s.rhoA = 0., "rhoA = 0", "> 0");
  REFUSE(s.damping = -1.5, "damping = -1.5", ">= 0");
  REFUSE(s.poisson = .75, "poisson = 0.75", "0.5");
  REFUSE(s.yield = -1.5, "yield = -1.5", "> 0");
  PetscCall(PetscPopErrorHandler());
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, help));
  PetscCall(TestStatic());
  PetscCall(TestElastica());
  PetscCall(TestFrequency());
  PetscCall(TestCollapse());
  PetscCall(TestBadInput());
  PetscCall(PetscFinalize());
  return test_report();
}
