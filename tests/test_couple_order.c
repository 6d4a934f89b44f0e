/*
  test_couple_order.c - order in time of the coupled step: loads constant or linear over it, staggered or iterated.

  2D, a periodic box of fluid at rest, pushed by a body force that grows linearly from zero, so that every quantity starts
  smoothly; in it a clamped elastic plate 8 dp long (density ratio 8) or a free disc (ratio 2). The trajectory of the tip or
  centre is compared, rms over common times, with that of an iterated run with linear loads at a quarter of the smallest step.
  Orders are log2 of the ratio of errors at dt and dt/2. A scheme of second order must show 1.7 to 2.3: the next term of the
  expansion, of relative size of dt over the shortest period that matters (first mode: 63 ms), is given 20 %, the reference's own
  error 1/16 of the finest. A scheme with a term of first order must show less than 1.7 at the finest steps, which says that the
  test sees the difference. Which is which: coupleloads.c and docs/substeps.md.
*/
#include "couple.h"
#include "sphfill.h"
#include "testing.h"

#define DP 0.01
#define BOX 0.24
#define RHO 1000.0
#define HALF 0.01   /* thickness of the plate, halved */
#define LENGTH 0.08 /* of the plate */
#define PLATE 8.0   /* density ratio of the plate */
#define RADIUS 0.04
#define PUSH 200.0 /* rate of the body force, m/s^3 */
#define END 0.032
#define DT 4e-4
#define SAMPLES 20 /* of the trajectory, END/SAMPLES a multiple of DT */

typedef struct {
  PetscBool disc;
  CoupleLoads loads;
  PetscInt iterations;
  PetscReal ratio; /* density of the plate over that of the fluid; 0: PLATE */
} Case;

typedef struct {
  Sph sph;
  Couple couple;
  Rigid rigid;
  Ancf ancf;
} System;

static PetscBool Outside(const PetscReal x[3], void *ctx)
{
  const PetscReal dx = x[0] - 0.5 * BOX, dy = x[1] - 0.5 * BOX;

  if (((Case *)ctx)->disc) return hypot(dx, dy) > RADIUS ? PETSC_TRUE : PETSC_FALSE;
  return fabs(dy) < HALF && fabs(dx) < 0.5 * LENGTH ? PETSC_FALSE : PETSC_TRUE;
}

static PetscErrorCode MakeFluid(Case *c, System *s)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {BOX, BOX, 0};
  const PetscBool per[3] = {PETSC_TRUE, PETSC_TRUE, PETSC_FALSE};
  PetscReal *x;
  PetscInt n;

  PetscFunctionBegin;
  PetscCall(SphCreate(PETSC_COMM_SELF, &s->sph));
  PetscCall(SphSetDimension(s->sph, 2));
  PetscCall(SphSetSpacing(s->sph, DP));
  PetscCall(SphSetViscosity(s->sph, 1.0));
  PetscCall(SphSetSoundSpeed(s->sph, 5.0));
  PetscCall(SphSetDomain(s->sph, lo, hi));
  PetscCall(SphSetPeriodic(s->sph, per));
  PetscCall(SphSetPrecision(s->sph, SPH_PRECISION_DOUBLE));
  PetscCall(SphSetDensityReinit(s->sph, SPH_REINIT_NONE, 10)); /* every n steps: not the same problem at another step size */
  PetscCall(SphFillBox(2, DP, lo, hi, Outside, c, &n, &x));
  PetscCall(SphAddFluid(s->sph, n, x, NULL, NULL));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MakeDisc(System *s, PetscReal support, CoupleSurface *surface)
{
  RigidBodySpec spec;
  PetscInt body;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &s->rigid));
  PetscCall(RigidSetDimension(s->rigid, 2));
  PetscCall(RigidBodySpecInit(&spec));
  spec.shape = RIGID_SPHERE;
  spec.motion = RIGID_FREE;
  spec.size[0] = RADIUS;
  spec.density = 2.0 * RHO;
  spec.position[0] = spec.position[1] = 0.5 * BOX;
  PetscCall(RigidAddBody(s->rigid, &spec, &body));
  PetscCall(RigidSetUp(s->rigid));
  PetscCall(CoupleSurfaceCreateRigid(s->rigid, body, 2, DP, support, surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MakePlate(const Case *c, System *s, PetscReal support, CoupleSurface *surface)
{
  const PetscReal h = 2.0 * HALF, ratio = c->ratio > 0.0 ? c->ratio : PLATE, rhoA = ratio * RHO * h;
  AncfBeamSpec spec;
  PetscInt beam;

  PetscFunctionBegin;
  PetscCall(AncfCreate(PETSC_COMM_SELF, &s->ancf));
  PetscCall(AncfBeamSpecInit(&spec));
  for (int k = 0; k < 3; k++) spec.start[k] = spec.end[k] = k < 2 ? 0.5 * BOX : 0.0;
  spec.start[0] -= 0.5 * LENGTH;
  spec.end[0] += 0.5 * LENGTH;
  spec.diameter = h;
  spec.density = ratio * RHO;
  spec.young = 1e6;
  spec.rhoA = rhoA;
  spec.EI = rhoA * PetscSqr(100.0 / 3.516 * LENGTH * LENGTH); /* first mode at 100 rad/s */
  spec.EA = rhoA * PetscSqr(500.0 / (0.5 * PETSC_PI) * LENGTH);
  spec.end0 = ANCF_END_CLAMP;
  spec.elements = 4;
  PetscCall(AncfAddBeam(s->ancf, &spec, &beam));
  PetscCall(AncfSetSubsteps(s->ancf, 4));
  PetscCall(AncfSetFromOptions(s->ancf));
  PetscCall(AncfSetUp(s->ancf));
  PetscCall(CoupleSurfaceCreateBeam(s->ancf, beam, 2, DP, support, surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Make(Case *c, PetscReal dt, System *s)
{
  CoupleSurface surface;
  PetscReal support;

  PetscFunctionBegin;
  *s = (System){NULL, NULL, NULL, NULL};
  PetscCall(MakeFluid(c, s));
  PetscCall(SphGetSupport(s->sph, &support));
  PetscCall(CoupleCreate(PETSC_COMM_SELF, &s->couple));
  PetscCall(CoupleSetSph(s->couple, s->sph));
  PetscCall(CoupleSetIterations(s->couple, c->iterations, 1e-7, 0.5));
  PetscCall(CoupleSetLoads(s->couple, c->loads));
  PetscCall(CoupleSetMaxTimeStep(s->couple, dt));
  if (c->disc)
    PetscCall(MakeDisc(s, support, &surface));
  else
    PetscCall(MakePlate(c, s, support, &surface));
  PetscCall(CoupleAddSurface(s->couple, surface));
  PetscCall(CoupleSurfaceDestroy(&surface));
  PetscCall(CoupleSetUp(s->couple));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Run(Case *c, PetscReal dt, PetscReal y[SAMPLES])
{
  const PetscInt steps = (PetscInt)(END / dt + 0.5);
  PetscInt missed, early = 0;
  System s;

  PetscFunctionBegin;
  PetscCall(Make(c, dt, &s));
  for (PetscInt i = 0; i < steps; i++) {
    const PetscReal f[3] = {0.0, PUSH * ((PetscReal)i + 0.5) * dt, 0.0};
    PetscReal X[3], taken;
    const PetscReal *e;
    PetscCall(SphSetBodyForce(s.sph, f));
    PetscCall(CoupleStep(s.couple, ((PetscReal)i + 1.0) * dt, &taken));
    TEST_REL(taken, dt, 1e-9, "step");
    if (10 * i < steps) PetscCall(CoupleGetIterations(s.couple, NULL, &early)); /* forces of the size of Newton's tolerance */
    if ((i + 1) % (steps / SAMPLES)) continue;
    if (c->disc)
      PetscCall(RigidGetState(s.rigid, 0, X, NULL, NULL, NULL));
    else {
      PetscCall(AncfGetState(s.ancf, NULL, &e, NULL, NULL));
      X[1] = e[6 * 4 + 1];
    }
    y[(i + 1) / (steps / SAMPLES) - 1] = X[1] - 0.5 * BOX;
  }
  PetscCall(CoupleGetIterations(s.couple, NULL, &missed));
  TEST(missed == early, "%d steps missed the tolerance", (int)(missed - early));
  PetscCall(CoupleDestroy(&s.couple));
  PetscCall(SphDestroy(&s.sph));
  if (s.rigid) PetscCall(RigidDestroy(&s.rigid));
  if (s.ancf) PetscCall(AncfDestroy(&s.ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Rms(const PetscReal *y, const PetscReal *ref)
{
  PetscReal sum = 0.0;
  for (int i = 0; i < SAMPLES; i++) sum += PetscSqr(y[i] - ref[i]);
  return PetscSqrtReal(sum / SAMPLES);
}

typedef struct {
  Case c;
  PetscBool second; /* whether it must be of second order */
} Claim;

/* error: of the four schemes at three steps. */
static PetscErrorCode Orders(PetscBool disc, const Claim claim[4], PetscReal error[4][3])
{
  PetscReal ref[SAMPLES], y[SAMPLES];
  Case fine = {disc, COUPLE_LOADS_LINEAR, 40, 0};

  PetscFunctionBegin;
  PetscCall(Run(&fine, DT / 16, ref));
  printf("%s: moves by %g m\n", disc ? "disc" : "plate", (double)ref[SAMPLES - 1]);
  for (int k = 0; k < 4; k++) {
    Case c = claim[k].c;
    PetscReal first, last;
    for (int j = 0; j < 3; j++) {
      PetscCall(Run(&c, DT / (1 << j), y));
      error[k][j] = Rms(y, ref);
    }
    first = log2(error[k][0] / error[k][1]);
    last = log2(error[k][1] / error[k][2]);
    printf("  %-9s %-9s errors %.3e %.3e %.3e m, orders %.2f %.2f\n", CoupleLoadsTypes[c.loads],
           c.iterations > 1 ? "iterated" : "staggered", (double)error[k][0], (double)error[k][1], (double)error[k][2],
           (double)first, (double)last);
    if (claim[k].second)
      TEST(first > 1.7 && first < 2.3 && last > 1.7 && last < 2.3, "must be of second order");
    else
      TEST(last < 1.7, "this scheme is not of second order");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where the tip of a light plate ends. */
static PetscErrorCode RunLight(PetscInt iterations, CoupleLoads loads, PetscReal dt, PetscReal *tip)
{
  Case c = {PETSC_FALSE, loads, iterations, 0.25};
  PetscReal y[SAMPLES];

  PetscFunctionBegin;
  PetscCall(Run(&c, dt, y));
  *tip = y[SAMPLES - 1];
  printf("plate of density ratio 0.25, %s loads, at most %d iterations, dt %g s: tip at %.4e m\n", CoupleLoadsTypes[loads],
         (int)iterations, (double)dt, (double)*tip);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  A plate a quarter as dense as the fluid. The iterated step converges: halving the step changes the tip by less than 1 %. The
  staggered step must fail: it is unstable, the error grows when the step is halved, and is above 10 %.
*/
static PetscErrorCode LightPlate(void)
{
  PetscReal good[2], bad[2];

  PetscFunctionBegin;
  for (int j = 0; j < 2; j++) {
    PetscCall(RunLight(1, COUPLE_LOADS_CONSTANT, DT / (2 << j), &bad[j]));
    PetscCall(RunLight(40, COUPLE_LOADS_LINEAR, DT / (2 << j), &good[j]));
  }
  TEST_REL(good[0], good[1], 0.01, "light plate, iterated: tip at dt/2 and dt/4");
  for (int j = 0; j < 2; j++) bad[j] = fabs(bad[j] - good[1]) / fabs(good[1]);
  TEST(bad[1] > 0.1 && bad[1] > bad[0], "light plate: the staggered step must fail, its errors are %g at dt/2, %g at dt/4",
       (double)bad[0], (double)bad[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  const Claim plate[4] = {
      {{PETSC_FALSE, COUPLE_LOADS_CONSTANT, 1, 0}, PETSC_FALSE},
      {{PETSC_FALSE, COUPLE_LOADS_LINEAR, 1, 0}, PETSC_FALSE},
      {{PETSC_FALSE, COUPLE_LOADS_CONSTANT, 40, 0}, PETSC_FALSE}, /* generalised-alpha delays steps of the load */
      {{PETSC_FALSE, COUPLE_LOADS_LINEAR, 40, 0}, PETSC_TRUE}};
  const Claim disc[4] = {{{PETSC_TRUE, COUPLE_LOADS_CONSTANT, 1, 0}, PETSC_FALSE},
                         {{PETSC_TRUE, COUPLE_LOADS_LINEAR, 1, 0}, PETSC_TRUE},
                         {{PETSC_TRUE, COUPLE_LOADS_CONSTANT, 40, 0}, PETSC_TRUE},
                         {{PETSC_TRUE, COUPLE_LOADS_LINEAR, 40, 0}, PETSC_TRUE}};
  PetscReal error[4][3];

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(Orders(PETSC_FALSE, plate, error));
  for (int j = 0; j < 3; j++) {
    TEST(error[1][j] < error[0][j], "plate, staggered: linear loads must have a smaller error than constant ones at dt/%d",
         1 << j);
    TEST(error[3][j] < error[2][j], "plate, iterated: linear loads must have a smaller error than constant ones at dt/%d",
         1 << j);
  }
  PetscCall(Orders(PETSC_TRUE, disc, error));
  for (int j = 0; j < 3; j++)
    TEST(error[1][j] < error[0][j], "disc, staggered: linear loads must have a smaller error than constant ones at dt/%d",
         1 << j);
  PetscCall(LightPlate());
  PetscCall(PetscFinalize());
  return test_report();
}
