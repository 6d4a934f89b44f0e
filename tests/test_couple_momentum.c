/*
  test_couple_momentum.c - a free rigid sphere and a free flexible beam drift through a periodic fluid under gravity.

  No wall and no support takes up momentum, so fluid + sphere + beam must gain exactly the impulse of gravity: the residual of the
  balance is round-off of the pair sums. Pair forces cancel to one rounding of each, so per step it is at most eps * sum |m a| dt;
  the bound is eps times the sum over steps of N times the largest force, with eps of the pair arithmetic. The beam runs with the
  spectral radius 1, for which generalised-alpha turns a load held over a step into exactly its impulse; smaller radii filter it
  over about a step. Linear loads have the same mean. Also: the same bits for 1 and 2 threads.
*/
#include "couple.h"
#include "sphfill.h"
#include "testing.h"
#include <omp.h>

#define DP 0.02

static const double center[3] = {0.10, 0.10, 0.10}, radius = 0.05, beam_y = 0.26, beam_z = 0.2, beam_r = 0.02;

static PetscBool Outside(const PetscReal x[3], void *ctx)
{
  const double dy = x[1] - beam_y, dz = x[2] - beam_z;
  double r2 = 0.0;
  (void)ctx;
  for (int k = 0; k < 3; k++) r2 += PetscSqr(x[k] - center[k]);
  if (r2 < radius * radius) return PETSC_FALSE;
  if (x[0] > 0.06 && x[0] < 0.34 && dy * dy + dz * dz < beam_r * beam_r) return PETSC_FALSE;
  return PETSC_TRUE;
}

typedef struct {
  Sph sph;
  Ancf ancf;
  Rigid rigid;
  Couple couple;
} System;

static PetscErrorCode MakeFluid(SphPrecision precision, Sph *sph)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {0.4, 0.4, 0.32};
  const PetscBool per[3] = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE};
  PetscReal *x, *v;
  PetscInt n;

  PetscFunctionBegin;
  PetscCall(SphCreate(PETSC_COMM_SELF, sph));
  PetscCall(SphSetSpacing(*sph, DP));
  PetscCall(SphSetMaxSpeed(*sph, 1.0));
  PetscCall(SphSetViscosity(*sph, 1.0));
  PetscCall(SphSetDomain(*sph, lo, hi));
  PetscCall(SphSetPeriodic(*sph, per));
  PetscCall(SphSetPrecision(*sph, precision));
  PetscCall(SphFillBox(3, DP, lo, hi, Outside, NULL, &n, &x));
  PetscCall(PetscMalloc1(3 * (size_t)n, &v));
  for (PetscInt i = 0; i < n; i++) {
    v[3 * i] = 0.1 * sin(2.0 * PETSC_PI * x[3 * i + 1] / 0.4);
    v[3 * i + 1] = 0.1 * sin(2.0 * PETSC_PI * x[3 * i + 2] / 0.32);
    v[3 * i + 2] = 0.0;
  }
  PetscCall(SphAddFluid(*sph, n, x, v, NULL));
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MakeBodies(System *s, PetscReal support)
{
  const PetscReal g[3] = {0, 0, -9.81};
  AncfBeamSpec beam;
  RigidBodySpec ball;
  CoupleSurface surface;
  PetscInt id;

  PetscFunctionBegin;
  PetscCall(AncfCreate(PETSC_COMM_SELF, &s->ancf));
  PetscCall(AncfBeamSpecInit(&beam));
  for (int k = 0; k < 3; k++) {
    beam.start[k] = k == 0 ? 0.06 : (k == 1 ? beam_y : beam_z);
    beam.end[k] = k == 0 ? 0.34 : beam.start[k];
  }
  beam.elements = 4;
  beam.diameter = 2 * beam_r;
  beam.density = 3000.0;
  beam.young = 1e6;
  beam.end0 = beam.end1 = ANCF_END_FREE;
  PetscCall(AncfAddBeam(s->ancf, &beam, &id));
  PetscCall(AncfSetGravity(s->ancf, g));
  PetscCall(AncfSetSubsteps(s->ancf, 2));
  PetscCall(AncfSetFromOptions(s->ancf));
  PetscCall(AncfSetUp(s->ancf));
  PetscCall(CoupleSurfaceCreateBeam(s->ancf, id, 3, DP, support, &surface));
  PetscCall(CoupleAddSurface(s->couple, surface));
  PetscCall(CoupleSurfaceDestroy(&surface));
  PetscCall(RigidCreate(PETSC_COMM_SELF, &s->rigid));
  PetscCall(RigidBodySpecInit(&ball));
  ball.shape = RIGID_SPHERE;
  ball.motion = RIGID_FREE;
  ball.size[0] = radius;
  ball.density = 2000.0;
  for (int k = 0; k < 3; k++) {
    ball.position[k] = center[k];
    ball.velocity[k] = 0.2 - 0.1 * k;
    ball.omega[k] = 1.0 + k;
  }
  PetscCall(RigidAddBody(s->rigid, &ball, &id));
  PetscCall(RigidSetGravity(s->rigid, g));
  PetscCall(RigidSetUp(s->rigid));
  PetscCall(CoupleSurfaceCreateRigid(s->rigid, id, 3, DP, support, &surface));
  PetscCall(CoupleAddSurface(s->couple, surface));
  PetscCall(CoupleSurfaceDestroy(&surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Make(SphPrecision precision, CoupleLoads loads, System *s)
{
  PetscReal support;

  PetscFunctionBegin;
  PetscCall(MakeFluid(precision, &s->sph));
  PetscCall(SphGetSupport(s->sph, &support));
  PetscCall(CoupleCreate(PETSC_COMM_SELF, &s->couple));
  PetscCall(CoupleSetSph(s->couple, s->sph));
  PetscCall(CoupleSetLoads(s->couple, loads));
  PetscCall(MakeBodies(s, support));
  PetscCall(CoupleSetUp(s->couple));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(System *s)
{
  PetscFunctionBegin;
  PetscCall(CoupleDestroy(&s->couple));
  PetscCall(SphDestroy(&s->sph));
  PetscCall(AncfDestroy(&s->ancf));
  PetscCall(RigidDestroy(&s->rigid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Steps; afterwards positions and velocities of all markers, and the bound on the residual as explained on top. */
static PetscErrorCode Run(SphPrecision precision, CoupleLoads loads, PetscInt steps, PetscReal **state, PetscInt *nstate,
                          PetscReal *residual, PetscReal *bound)
{
  const PetscReal eps = precision == SPH_PRECISION_SINGLE ? 6e-8 : 1.2e-16;
  PetscReal dt, *a;
  PetscInt n, nb;
  CoupleBalance b;
  System s;

  PetscFunctionBegin;
  PetscCall(Make(precision, loads, &s));
  PetscCall(SphGetCounts(s.sph, &n, &nb, NULL));
  *nstate = 6 * (n + nb);
  PetscCall(PetscMalloc1(*nstate, state));
  PetscCall(PetscMalloc1(3 * (size_t)(n + nb), &a));
  *bound = 0.0;
  for (PetscInt i = 0; i < steps; i++) {
    PetscReal sum = 0.0;
    PetscCall(CoupleStep(s.couple, 1.0, &dt));
    PetscCall(SphGetFields(s.sph, &(SphFields){.a = a}));
    for (PetscInt j = 0; j < 3 * (n + nb); j++) sum += 1000.0 * DP * DP * DP * PetscAbsReal(a[j]);
    *bound += 64.0 * eps * sum * dt; /* 64: about the number of terms in a marker's sum */
  }
  PetscCall(SphGetFields(s.sph, &(SphFields){.x = *state, .v = *state + 3 * (n + nb)}));
  PetscCall(CoupleGetBalance(s.couple, &b));
  *residual = PetscMax(PetscAbsReal(b.residual[0]), PetscMax(PetscAbsReal(b.residual[1]), PetscAbsReal(b.residual[2])));
  *bound += 1000.0 * PETSC_MACHINE_EPSILON *
            (b.scale + 1000.0 * 0.4 * 0.4 * 0.32); /* and of the sums of the balance itself, ten a step */
  printf("%s: residual %.2e kg m/s, bound %.2e, momentum scale %.3g\n", SphPrecisions[precision], (double)*residual,
         (double)*bound, (double)b.scale);
  PetscCall(PetscFree(a));
  PetscCall(Destroy(&s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscReal *one, *two, residual, bound;
  PetscInt n;
  PetscBool same;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  omp_set_num_threads(1);
  PetscCall(PetscOptionsSetValue(NULL, "-ancf_ts_alpha_radius", "1"));
  PetscCall(Run(SPH_PRECISION_DOUBLE, COUPLE_LOADS_CONSTANT, 60, &one, &n, &residual, &bound));
  TEST_NEAR(residual, 0.0, bound, "momentum residual, double precision");
  PetscCall(PetscFree(one));
  PetscCall(Run(SPH_PRECISION_DOUBLE, COUPLE_LOADS_LINEAR, 60, &one, &n, &residual, &bound));
  TEST_NEAR(residual, 0.0, bound, "momentum residual, loads linear over the step");
  PetscCall(PetscFree(one));
  PetscCall(Run(SPH_PRECISION_SINGLE, COUPLE_LOADS_CONSTANT, 60, &one, &n, &residual, &bound));
  TEST_NEAR(residual, 0.0, bound, "momentum residual, single precision");
  omp_set_num_threads(2);
  PetscCall(Run(SPH_PRECISION_SINGLE, COUPLE_LOADS_CONSTANT, 60, &two, &n, &residual, &bound));
  PetscCall(PetscArraycmp(one, two, n, &same));
  TEST(same, "positions and velocities after 60 steps with 1 and 2 threads must have the same bits");
  PetscCall(PetscFree(one));
  PetscCall(PetscFree(two));
  PetscCall(PetscFinalize());
  return test_report();
}
