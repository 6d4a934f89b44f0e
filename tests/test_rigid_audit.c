/*
  test_rigid_audit.c - the balances of RigidGetAudit() against what is known otherwise: the kinetic energy that lubrication and
  dampers take from a body on which nothing else acts, the loss of a collision of given restitution, the work of a moving plate,
  of yielding and of a torque; and both balances of a mechanism with everything in it.
*/
#include "rigid.h"
#include "rigidtest.h"

static const char help[] = "Balances of rigid bodies.\n";

#define A .01
#define MASS 4e-3

static PetscErrorCode Ball(PetscReal x, PetscReal v, RigidBodySpec *s)
{
  PetscFunctionBegin;
  PetscCall(RigidBodySpecInit(s));
  s->size[0] = A;
  s->mass = MASS;
  s->position[0] = x;
  s->velocity[0] = v;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Kinetic, potential and all elastic energy, plus what was taken, less what was given. */
static PetscErrorCode Sum(Rigid r, RigidAudit *a, PetscReal *sum)
{
  PetscReal potential, springs;

  PetscFunctionBegin;
  PetscCall(RigidGetAudit(r, a));
  PetscCall(RigidGetEnergy(r, NULL, &potential));
  PetscCall(RigidGetJointEnergy(r, &springs));
  *sum = a->kinetic + potential + springs + a->contact + a->lubrication + a->impact + a->joints - a->driven;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A sphere that lubrication stops before a plate at rest: what it takes is the kinetic energy lost, to round-off at any step. */
static PetscErrorCode TestLubrication(void)
{
  const PetscReal v0 = -.2;
  Rigid r;
  RigidBodySpec s;
  RigidAudit a;
  ShortRange p;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_WORLD, &r));
  PetscCall(ShortRangeInit(&p));
  p.viscosity = .1, p.cutoff = .25 * A, p.roughness = .01 * A;
  PetscCall(RigidSetShortRange(r, &p));
  PetscCall(RigidSetShortRangeSpacing(r, A));
  PetscCall(Ball(1.3 * A, v0, &s));
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidBodySpecInit(&s));
  s.shape = RIGID_BOX;
  s.size[0] = 2. * A, s.size[1] = s.size[2] = 20. * A;
  s.position[0] = -A;
  s.motion = RIGID_FIXED;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidSetUp(r));
  for (int n = 1; n <= 400; n++) PetscCall(RigidAdvance(r, n * 5e-5));
  PetscCall(RigidGetAudit(r, &a));
  printf("lubrication took %.6g of %.6g J\n", a.lubrication, .5 * MASS * v0 * v0);
  TEST(a.lubrication > .3 * .5 * MASS * v0 * v0, "lubrication does little: %g J", a.lubrication);
  TEST_NEAR(a.lubrication + a.kinetic, .5 * MASS * v0 * v0, 1e-12 * MASS * v0 * v0, "kinetic energy lost to lubrication");
  TEST(a.driven == 0. && a.impact == 0. && a.joints == 0. && a.contact == 0., "nothing else acts");
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two equal spheres meet at 2 v; the largest error of the balance, relative, and what the collision took. */
static PetscErrorCode Collide(PetscReal e, PetscInt steps, PetscReal *worst, PetscReal *taken, PetscReal *stored)
{
  const PetscReal v = .5, e0 = MASS * v * v;
  PetscReal T, sum;
  Rigid r;
  RigidBodySpec s;
  RigidAudit a;
  ShortRange p;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_WORLD, &r));
  PetscCall(ShortRangeInit(&p));
  p.roughness = .01 * A, p.modulus = 1e7, p.restitution = e;
  PetscCall(RigidSetShortRange(r, &p));
  T = ShortRangeContactTime(&p, .5 * A, .5 * MASS, 2. * v);
  PetscCall(Ball(-1.005 * A - .1 * T * v, v, &s));
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(Ball(1.005 * A + .1 * T * v, -v, &s));
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidSetUp(r));
  *worst = *stored = 0.;
  for (PetscInt n = 1; n <= steps; n++) {
    PetscCall(RigidAdvance(r, 1.5 * T * (PetscReal)n / (PetscReal)steps));
    PetscCall(Sum(r, &a, &sum));
    *worst = PetscMax(*worst, PetscAbsReal(sum - e0) / e0);
    *stored = PetscMax(*stored, a.contact / e0);
  }
  *taken = a.impact / e0;
  TEST(a.contact == 0. && a.kinetic > .5 * e * e * e0, "the spheres are apart again, and move");
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Leapfrog: second order. All energy is elastic at the closest point; restitution e takes 1 - e^2. */
static PetscErrorCode TestCollision(void)
{
  PetscReal coarse, fine, taken, stored;

  PetscFunctionBegin;
  PetscCall(Collide(1., 75, &coarse, &taken, &stored));
  PetscCall(Collide(1., 150, &fine, &taken, &stored));
  printf("elastic collision: balance to %.3g, half the step %.3g; %.6f of the energy elastic at most\n", coarse, fine, stored);
  TEST(coarse > 3. * fine && coarse < 1e-2, "second order: %g, %g", coarse, fine);
  TEST(taken == 0., "an elastic collision takes nothing");
  TEST_NEAR(stored, 1., 1e-3, "elastic at the closest point"); /* a step of T/100 misses (pi/200)^2 at most */
  PetscCall(Collide(.7, 300, &coarse, &taken, &stored));
  PetscCall(Collide(.7, 600, &fine, &taken, &stored));
  printf("restitution 0.7: balance to %.3g, %.3g; taken %.5f, 1 - e^2 = %.5f\n", coarse, fine, taken, 1. - .49);
  TEST(coarse > 1.6 * fine, "first order at least, as the damping force is taken before the kick: %g, %g", coarse, fine);
  TEST_NEAR(taken, 1. - .49, 1e-2, "energy that the damping of the contact took");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A plate of given speed hits a sphere at rest, elastically: the sphere leaves at twice that speed. */
static PetscErrorCode TestPlate(void)
{
  const PetscReal v = .3;
  PetscReal T;
  Rigid r;
  RigidBodySpec s;
  RigidAudit a;
  ShortRange p;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_WORLD, &r));
  PetscCall(ShortRangeInit(&p));
  p.roughness = .01 * A, p.modulus = 1e7;
  PetscCall(RigidSetShortRange(r, &p));
  PetscCall(RigidSetShortRangeSpacing(r, A));
  PetscCall(RigidBodySpecInit(&s));
  s.shape = RIGID_BOX;
  s.size[0] = 2. * A, s.size[1] = s.size[2] = 20. * A;
  s.position[0] = -A;
  s.velocity[0] = v;
  s.motion = RIGID_PRESCRIBED;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(Ball(1.02 * A, 0., &s));
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidSetUp(r));
  T = .02 * A / v + 2. * ShortRangeContactTime(&p, A, MASS, v);
  for (int n = 1; n <= 400; n++) PetscCall(RigidAdvance(r, n * T / 400.));
  PetscCall(RigidGetAudit(r, &a));
  printf("plate: work %.6g J, exact %.6g J\n", a.driven, 2. * MASS * v * v);
  TEST_REL(a.driven, 2. * MASS * v * v, 1e-3, "work of the plate"); /* 200 steps a collision: (pi/200)^2 and less */
  TEST_REL(a.kinetic, 2. * MASS * v * v, 1e-3, "the plate is not in the kinetic energy");
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A wheel of inertia J on a hinge with spring, damper, yield moment: spun at w0. steps of T/steps; what is left of J w0^2/2. */
static PetscErrorCode Wheel(PetscReal k, PetscReal c, PetscReal yield, PetscReal rupture, PetscReal T, PetscInt steps,
                            RigidAudit *a, PetscReal *springs, PetscReal *angle)
{
  Rigid r;
  RigidBodySpec s;
  RigidJointSpec j;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_WORLD, &r));
  PetscCall(RigidBodySpecInit(&s));
  s.size[0] = .1;
  s.mass = 1.;
  for (int d = 0; d < 3; d++) s.inertia[d] = 2.;
  s.omega[2] = 1.;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidJointSpecInit(&j));
  j.type = RIGID_JOINT_HINGE;
  j.a = 0;
  j.axis[2] = 1.;
  j.stiffness = k, j.damping = c, j.yield = yield, j.rupture = rupture;
  PetscCall(RigidAddJoint(r, &j, NULL));
  PetscCall(RigidSetUp(r));
  for (PetscInt n = 1; n <= steps; n++) PetscCall(RigidAdvance(r, T * (PetscReal)n / (PetscReal)steps));
  PetscCall(RigidGetAudit(r, a));
  PetscCall(RigidGetJointEnergy(r, springs));
  PetscCall(RigidGetJointState(r, 0, angle, NULL));
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestJoints(void)
{
  RigidAudit a;
  PetscReal springs, angle;

  PetscFunctionBegin;
  /* damper alone: w = exp(-c t/J), hence J (1 - exp(-2 c t/J))/2 is lost; second order in c dt/J = 1/400 */
  PetscCall(Wheel(0., .5, PETSC_INFINITY, PETSC_INFINITY, 4., 400, &a, &springs, &angle));
  TEST_REL(a.joints, 1. - PetscExpReal(-2.), 1e-5, "energy that the damper took");
  TEST_REL(a.kinetic + a.joints, 1., 1e-5, "all of it from the wheel");
  /* stiff and perfectly plastic: stops after the angle J w0^2/(2 M); elastic part M^2/(2 k) = 5e-4, which then swings */
  PetscCall(Wheel(1000., 0., 1., PETSC_INFINITY, 3., 6000, &a, &springs, &angle));
  printf("yielding hinge: taken %.6g J, %.3g J left elastic and kinetic, angle %.5g rad\n", a.joints, springs + a.kinetic, angle);
  TEST_NEAR(a.joints, 1. - 5e-4, 2e-5, "energy that yielding took"); /* (w dt)^2/8 of 5e-4, w^2 = 500, and a step's overshoot */
  TEST_NEAR(springs + a.kinetic + a.joints, 1., 2e-5, "all of it from the wheel");
  TEST_REL(a.joints, 1. * (angle - 0.), 2e-3, "moment times plastic angle"); /* the elastic angle is 1e-3 */
  /* breaks at .5 rad with k/2 (.5)^2 in its spring, which is gone */
  PetscCall(Wheel(2., 0., PETSC_INFINITY, .5, 3., 6000, &a, &springs, &angle));
  TEST_REL(a.joints, .25, 3e-3, "energy of a spring that broke"); /* found after a step: k phi w dt = 5e-4 */
  TEST_REL(a.kinetic, .75, 1e-3, "the wheel runs on without it");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Two arms in a row, hinged to the ground and to one another, a third body on a spring and damper that a prescribed body pulls, a
  ball that bounces off a wall and the last arm: gravity, own torque, dampers. Worst residual of energy (of 1 J) and of angular
  momentum.
*/
static PetscErrorCode Mechanism(PetscInt steps, PetscReal *energy, PetscReal *angular)
{
  const PetscReal g[3] = {.3, -9.81, .5}, torque[3] = {.02, .05, -.03}, floor[3] = {0., -1.3, 0.}, up[3] = {0., 1., 0.};
  PetscReal sum, start, L0[3];
  Rigid r;
  RigidBodySpec s;
  RigidJointSpec j;
  RigidAudit a;
  ShortRange p;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_WORLD, &r));
  PetscCall(RigidSetGravity(r, g));
  PetscCall(ShortRangeInit(&p));
  p.roughness = .002, p.modulus = 2e4, p.restitution = .6, p.viscosity = 5., p.cutoff = .02;
  PetscCall(RigidSetShortRange(r, &p));
  PetscCall(RigidAddWall(r, floor, up));
  PetscCall(RigidBodySpecInit(&s));
  s.size[0] = .1;
  s.mass = 1.;
  s.inertia[0] = .02, s.inertia[1] = .03, s.inertia[2] = .025;
  s.position[0] = .5;
  PetscCall(RigidAddBody(r, &s, NULL));
  s.position[0] = 1.;
  s.omega[1] = .5;
  PetscCall(RigidAddBody(r, &s, NULL));
  s.position[0] = 2.;
  s.omega[1] = 0.;
  s.velocity[2] = .4;
  PetscCall(RigidAddBody(r, &s, NULL));
  s.position[0] = -.5, s.position[1] = -1.1;
  s.velocity[0] = .2;
  PetscCall(RigidAddBody(r, &s, NULL));
  s.motion = RIGID_PRESCRIBED;
  s.position[0] = 2.5, s.position[1] = .5;
  s.velocity[0] = .6, s.velocity[1] = .3;
  s.omega[2] = 1.;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidJointSpecInit(&j));
  j.type = RIGID_JOINT_HINGE;
  j.a = 0;
  j.axis[2] = 1.;
  j.damping = .05;
  PetscCall(RigidAddJoint(r, &j, NULL));
  j.type = RIGID_JOINT_BEND;
  j.a = 1, j.b = 0;
  j.point[0] = .75;
  j.axis[0] = 1., j.axis[2] = 0.;
  j.stiffness = 3., j.damping = .02, j.torsion = 2., j.torsiondamping = .01;
  PetscCall(RigidAddJoint(r, &j, NULL));
  j.type = RIGID_JOINT_SPRING;
  j.a = 2, j.b = 4;
  j.point[0] = 2.05;
  j.pointb[0] = 2.4, j.pointb[1] = .5;
  j.stiffness = 40., j.damping = .5;
  j.rest = PETSC_DECIDE;
  PetscCall(RigidAddJoint(r, &j, NULL));
  PetscCall(RigidSetBodyLoad(r, 2, NULL, torque));
  PetscCall(RigidSetUp(r));
  PetscCall(Sum(r, &a, &start));
  PetscCall(PetscArraycpy(L0, a.angular, 3));
  *energy = *angular = 0.;
  for (PetscInt n = 1; n <= steps; n++) {
    PetscCall(RigidAdvance(r, .5 * (PetscReal)n / (PetscReal)steps));
    PetscCall(Sum(r, &a, &sum));
    *energy = PetscMax(*energy, PetscAbsReal(sum - start));
    for (int k = 0; k < 3; k++) *angular = PetscMax(*angular, PetscAbsReal(a.angular[k] - L0[k] - a.turn[k]));
  }
  TEST(a.lubrication > 1e-3 && a.impact > 1e-3 && a.joints > 1e-3 && PetscAbsReal(a.driven) > 1e-2,
       "everything acts: %g, %g, %g, %g J", a.lubrication, a.impact, a.joints, a.driven);
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestMechanism(void)
{
  PetscReal coarse, fine, finer, L;

  PetscFunctionBegin;
  PetscCall(Mechanism(2000, &coarse, &L));
  PetscCall(Mechanism(4000, &fine, &L));
  PetscCall(Mechanism(16000, &finer, &L));
  printf("mechanism: energy balanced to %.3g, %.3g, %.3g J (dt, dt/2, dt/8), angular momentum to %.2g kg m^2/s\n", coarse, fine,
         finer, L);
  TEST(coarse > 1.6 * fine && fine > 3. * finer, "first order at least: %g, %g, %g", coarse, fine, finer);
  TEST(finer < 1e-2, "%g of several J", finer);
  TEST(L < 1e-10, "angular momentum: %g of several kg m^2/s, round-off of 16000 steps and of joints kept to 1e-13", L);
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, help));
  PetscCall(TestLubrication());
  PetscCall(TestCollision());
  PetscCall(TestPlate());
  PetscCall(TestJoints());
  PetscCall(TestMechanism());
  PetscCall(PetscFinalize());
  return test_report();
}
