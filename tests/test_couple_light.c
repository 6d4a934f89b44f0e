/*
  test_couple_light.c - light bodies: where the staggered step fails and the iterated one does not; order in time.

  2D, a disc of radius 4 dp in a periodic box of fluid at rest, driven by its buoyancy. At a density ratio of 0.05 the added mass
  that walls take from the last step (Adami et al., Eq. 27) exceeds the disc's own: the staggered step must fail (an error, or a
  speed four times that of the ideal fluid), the iterated one must not, keeps the momentum balance and gains the speed of a disc
  with the added mass of an ideal fluid, g (rho V - m)/(m + rho V) t, within 20 %: at the end, 15 sound crossings of the radius
  after the start, the sound wave of the start still carries (rho c 2 pi R)^-1 times the driving force's impulse, 5 %, and the
  viscous layer, sqrt(nu t) = 0.04 R, adds another 2 x 0.04 to the added mass (Stokes); the rest is left to 8 markers across the
  disc. At ratio 2 both agree. Orders come from three step sizes: the iterated step must reach 2 (at least 1.7); the staggered one
  is held back by the lagged acceleration (about 1.2).
*/
#include "couple.h"
#include "sphfill.h"
#include "testing.h"

#define DP 0.01
#define RADIUS 0.04
#define BOX 0.32
#define RHO 1000.0
#define G 1.0

static PetscBool Outside(const PetscReal x[3], void *ctx)
{
  (void)ctx;
  return hypot(x[0] - 0.5 * BOX, x[1] - 0.5 * BOX) > RADIUS ? PETSC_TRUE : PETSC_FALSE;
}

typedef struct {
  Sph sph;
  Couple couple;
  Rigid rigid;
} System;

static PetscErrorCode Make(PetscReal ratio, PetscInt iterations, PetscReal cs, PetscReal dtmax, System *s)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {BOX, BOX, 0}, g[3] = {0, -G, 0};
  const PetscBool per[3] = {PETSC_TRUE, PETSC_TRUE, PETSC_FALSE};
  RigidBodySpec spec;
  PetscReal *x, support;
  PetscInt n, body;
  CoupleSurface surface;

  PetscFunctionBegin;
  PetscCall(SphCreate(PETSC_COMM_SELF, &s->sph));
  PetscCall(SphSetDimension(s->sph, 2));
  PetscCall(SphSetSpacing(s->sph, DP));
  PetscCall(SphSetViscosity(s->sph, 0.1));
  PetscCall(SphSetSoundSpeed(s->sph, cs));
  PetscCall(SphSetDomain(s->sph, lo, hi));
  PetscCall(SphSetPeriodic(s->sph, per));
  PetscCall(SphSetPrecision(s->sph, SPH_PRECISION_DOUBLE));
  PetscCall(SphSetDensityReinit(s->sph, SPH_REINIT_NONE, 10)); /* every n steps: not the same problem at another step size */
  PetscCall(SphFillBox(2, DP, lo, hi, Outside, NULL, &n, &x));
  PetscCall(SphAddFluid(s->sph, n, x, NULL, NULL));
  PetscCall(PetscFree(x));
  PetscCall(RigidCreate(PETSC_COMM_SELF, &s->rigid));
  PetscCall(RigidSetDimension(s->rigid, 2));
  PetscCall(RigidBodySpecInit(&spec));
  spec.shape = RIGID_SPHERE;
  spec.motion = RIGID_FREE;
  spec.size[0] = RADIUS;
  spec.density = ratio * RHO;
  spec.position[0] = spec.position[1] = 0.5 * BOX;
  PetscCall(RigidAddBody(s->rigid, &spec, &body));
  PetscCall(RigidSetGravity(s->rigid, g));
  PetscCall(RigidSetFluidDensity(s->rigid, RHO));
  PetscCall(RigidSetUp(s->rigid));
  PetscCall(CoupleCreate(PETSC_COMM_SELF, &s->couple));
  PetscCall(CoupleSetSph(s->couple, s->sph));
  PetscCall(CoupleSetIterations(s->couple, iterations, 1e-8, 0.5));
  PetscCall(CoupleSetMaxTimeStep(s->couple, dtmax));
  PetscCall(SphGetSupport(s->sph, &support));
  PetscCall(CoupleSurfaceCreateRigid(s->rigid, body, 2, DP, support, &surface));
  PetscCall(CoupleAddSurface(s->couple, surface));
  PetscCall(CoupleSurfaceDestroy(&surface));
  PetscCall(CoupleSetUp(s->couple));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(System *s)
{
  PetscFunctionBegin;
  PetscCall(CoupleDestroy(&s->couple));
  PetscCall(SphDestroy(&s->sph));
  PetscCall(RigidDestroy(&s->rigid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Height gained and velocity at t; *failed when a step stops with an error or the speed passes `limit`. */
static PetscErrorCode Run(PetscReal ratio, PetscInt iterations, PetscReal cs, PetscReal dtmax, PetscReal end, PetscReal limit,
                          PetscReal *y, PetscReal *v, PetscBool *failed)
{
  PetscReal t = 0.0, X[3], V[3];
  PetscInt its, missed, steps;
  CoupleBalance b;
  System s;

  PetscFunctionBegin;
  PetscCall(Make(ratio, iterations, cs, dtmax, &s));
  *failed = PETSC_FALSE;
  while (t < end) {
    PetscErrorCode ierr;
    PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
    ierr = CoupleStep(s.couple, end, NULL);
    PetscCall(PetscPopErrorHandler());
    PetscCall(CoupleGetTime(s.couple, &t, &steps));
    PetscCall(RigidGetState(s.rigid, 0, X, NULL, V, NULL));
    if (ierr || !(fabs(V[1]) < limit)) {
      *failed = PETSC_TRUE;
      break;
    }
  }
  *y = X[1] - 0.5 * BOX;
  *v = V[1];
  PetscCall(CoupleGetIterations(s.couple, &its, &missed));
  PetscCall(CoupleGetBalance(s.couple, &b));
  printf("ratio %.2f, at most %2" PetscInt_FMT
         " iterations: t %.4f s, y %+.6e m, v %+.6e m/s, %.2f iterations a step, %" PetscInt_FMT
         " steps missed the tolerance, momentum residual %.1e of %.1e%s\n",
         (double)ratio, iterations, (double)t, (double)*y, (double)*v, (double)its / (double)steps, missed, (double)b.residual[1],
         (double)b.scale, *failed ? ": failed" : "");
  /* pair sums in double: about 1e-15 of the largest impulse per step, 1e3 steps */
  if (!*failed) TEST_NEAR(b.residual[1] / b.scale, 0.0, 1e-11, "momentum residual");
  PetscCall(Destroy(&s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  const PetscReal end = 0.03, light = 0.05, ideal = G * (1.0 - light) / (1.0 + light), limit = 4.0 * ideal * end;
  PetscReal y, v, y2, v2, yk[3], vk[3];
  PetscBool failed;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(Run(light, 1, 20.0, PETSC_DECIDE, end, limit, &y, &v, &failed));
  TEST(failed, "the staggered step must fail at density ratio %g, it gave v = %g m/s", light, v);
  PetscCall(Run(light, 30, 20.0, PETSC_DECIDE, end, limit, &y, &v, &failed));
  TEST(!failed, "the iterated step must not fail at density ratio %g", light);
  TEST_REL(v, ideal * end, 0.2, "velocity of the light disc against the ideal fluid's added mass");
  PetscCall(Run(2.0, 1, 5.0, PETSC_DECIDE, end, limit, &y, &v, &failed));
  PetscCall(Run(2.0, 30, 5.0, PETSC_DECIDE, end, limit, &y2, &v2, &failed));
  TEST_REL(v2, v, 0.01, "heavy disc: staggered and iterated velocities");
  /* order of the staggered scheme: three step sizes, differences fall by 4 when it is second order */
  for (int k = 0; k < 3; k++) PetscCall(Run(2.0, 1, 5.0, 4e-4 / (1 << k), 0.02, limit, &yk[k], &vk[k], &failed));
  printf("staggered step: order in time %.2f (position), %.2f (velocity)\n", log2(fabs((yk[0] - yk[1]) / (yk[1] - yk[2]))),
         log2(fabs((vk[0] - vk[1]) / (vk[1] - vk[2]))));
  for (int k = 0; k < 3; k++) PetscCall(Run(2.0, 30, 5.0, 4e-4 / (1 << k), 0.02, limit, &yk[k], &vk[k], &failed));
  printf("iterated step: order in time %.2f (position), %.2f (velocity)\n", log2(fabs((yk[0] - yk[1]) / (yk[1] - yk[2]))),
         log2(fabs((vk[0] - vk[1]) / (vk[1] - vk[2]))));
  TEST(log2(fabs((yk[0] - yk[1]) / (yk[1] - yk[2]))) >= 1.7 && log2(fabs((vk[0] - vk[1]) / (vk[1] - vk[2]))) >= 1.7,
       "the iterated step must be of second order");
  PetscCall(PetscFinalize());
  return test_report();
}
