/*
  test_rigid_joint.c - joints: mechanisms against Runge-Kutta integrations of their minimal-coordinate equations written here,
  spring and damper against the closed form of the integration rule, conservation, reactions, drift, yield, refusals.
*/
#include "rigid.h"
#include "rigidtest.h"

static const char help[] = "Joints of rigid bodies.\n";

#define GRAV 9.81
static const PetscReal down[3] = {0., 0., -GRAV};

/* A uniform rod of length l and mass m as a slender box; its moments are set: J about the centre normal to it, axial Ja. */
static PetscErrorCode Rod(RigidBodySpec *s, PetscReal l, PetscReal m, PetscReal J, PetscReal Ja)
{
  PetscFunctionBegin;
  PetscCall(RigidBodySpecInit(s));
  s->shape = RIGID_BOX;
  s->size[0] = s->size[1] = .01, s->size[2] = l;
  s->mass = m;
  s->inertia[0] = s->inertia[1] = J, s->inertia[2] = Ja;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Joint(Rigid r, RigidJointType type, PetscInt a, PetscInt b, PetscReal x, PetscReal y, PetscReal z,
                            PetscInt axis)
{
  RigidJointSpec j;

  PetscFunctionBegin;
  PetscCall(RigidJointSpecInit(&j));
  j.type = type;
  j.a = a, j.b = b;
  j.point[0] = x, j.point[1] = y, j.point[2] = z;
  j.axis[axis] = 1.;
  PetscCall(RigidAddJoint(r, &j, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef void (*RHS)(const PetscReal y[], PetscReal f[]);

static void RK4(RHS rhs, int n, PetscReal dt, int sub, PetscReal y[])
{
  for (int m = 0; m < sub; m++) {
    PetscReal k[4][8], z[8];
    for (int s = 0; s < 4; s++) {
      for (int i = 0; i < n; i++) z[i] = y[i] + (s ? (s == 3 ? 1. : .5) * dt / sub * k[s - 1][i] : 0.);
      rhs(z, k[s]);
    }
    for (int i = 0; i < n; i++) y[i] += dt / sub / 6. * (k[0][i] + 2. * k[1][i] + 2. * k[2][i] + k[3][i]);
  }
}

/* Double pendulum of two uniform rods (l = 1, m = 1 and .5), angles from the vertical, swinging in the x-z plane. */
#define DP_M1 1.
#define DP_M2 .5
static void DoublePendulum(const PetscReal y[], PetscReal f[])
{
  const PetscReal c = cos(y[0] - y[1]), s = sin(y[0] - y[1]);
  const PetscReal A = DP_M1 / 3. + DP_M2, B = .5 * DP_M2 * c, D = DP_M2 / 3.;
  const PetscReal p = -.5 * DP_M2 * s * y[3] * y[3] - (.5 * DP_M1 + DP_M2) * GRAV * sin(y[0]);
  const PetscReal q = .5 * DP_M2 * s * y[2] * y[2] - .5 * DP_M2 * GRAV * sin(y[1]);
  f[0] = y[2], f[1] = y[3];
  f[2] = (p * D - B * q) / (A * D - B * B);
  f[3] = (A * q - B * p) / (A * D - B * B);
}

/* hinge: both joints are hinges about y, else balls (the motion stays plane by symmetry). */
static PetscErrorCode DoublePendulumError(RigidJointType type, PetscReal dt, PetscReal *rms, PetscReal *drift, PetscReal *energy)
{
  Rigid r;
  RigidBodySpec s;
  PetscReal y[4] = {1.2, .4, 0., 0.}, sum = 0., X[3], ke, pe, e0, p, v;
  const int steps = (int)(2. / dt + .5);

  PetscFunctionBegin;
  *drift = *energy = 0.;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidSetGravity(r, down));
  for (int i = 0; i < 2; i++) {
    PetscCall(Rod(&s, 1., i ? DP_M2 : DP_M1, (i ? DP_M2 : DP_M1) / 12., .3 * (i ? DP_M2 : DP_M1) / 12.));
    s.position[0] = i ? sin(y[0]) + .5 * sin(y[1]) : .5 * sin(y[0]);
    s.position[2] = i ? -cos(y[0]) - .5 * cos(y[1]) : -.5 * cos(y[0]);
    s.axisangle[1] = 1., s.axisangle[2] = 0., s.axisangle[3] = -y[i];
    PetscCall(RigidAddBody(r, &s, NULL));
  }
  PetscCall(Joint(r, type, 0, RIGID_GROUND, 0., 0., 0., 1));
  PetscCall(Joint(r, type, 1, 0, sin(y[0]), 0., -cos(y[0]), 1));
  PetscCall(RigidSetUp(r));
  PetscCall(RigidGetEnergy(r, &ke, &pe));
  e0 = ke + pe;
  for (int n = 1; n <= steps; n++) {
    PetscCall(RigidAdvance(r, n * dt));
    RK4(DoublePendulum, 4, dt, 20, y);
    PetscCall(RigidGetState(r, 1, X, NULL, NULL, NULL));
    sum += PetscSqr(X[0] - sin(y[0]) - .5 * sin(y[1])) + PetscSqr(X[2] + cos(y[0]) + .5 * cos(y[1])) + X[1] * X[1];
    PetscCall(RigidGetJointError(r, &p, &v));
    *drift = PetscMax(*drift, PetscMax(p, v));
    PetscCall(RigidGetEnergy(r, &ke, &pe));
    *energy = PetscMax(*energy, fabs(ke + pe - e0));
  }
  *rms = sqrt(sum / steps);
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestDoublePendulum(void)
{
  const RigidJointType type[2] = {RIGID_JOINT_HINGE, RIGID_JOINT_BALL};
  PetscReal e[3], d[3], en[3];

  PetscFunctionBegin;
  for (int m = 0; m < 2; m++) {
    for (int k = 0; k < 3; k++) PetscCall(DoublePendulumError(type[m], .01 / (1 << k), &e[k], &d[k], &en[k]));
    printf("double pendulum (%s): rms error %.2e %.2e %.2e, orders %.3f %.3f, drift %.1e, energy error %.2e %.2e %.2e J\n",
           m ? "ball" : "hinge", e[0], e[1], e[2], log2(e[0] / e[1]), log2(e[1] / e[2]), PetscMax(d[0], PetscMax(d[1], d[2])),
           en[0], en[1], en[2]);
    TEST_NEAR(log2(e[0] / e[1]), 2., .15, "order");
    TEST_NEAR(log2(e[1] / e[2]), 2., .08, "order");
    TEST_NEAR(log2(en[1] / en[2]), 2., .15, "order of the energy error");
    for (int k = 0; k < 3; k++)
      TEST(d[k] < 1e-11, "constraints violated by %g", d[k]); /* round-off of 2 m; velocities: times 1/dt at most */
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define TOP_A 1.
#define TOP_C .5
#define TOP_M 1.6
#define TOP_SPIN 5.
#define TOP_TILT .6
static void Top(const PetscReal y[], PetscReal f[])
{
  const PetscReal s = sin(y[0]), c = cos(y[0]), L3 = TOP_C * TOP_SPIN, dphi = (L3 * cos(TOP_TILT) - L3 * c) / (TOP_A * s * s);
  f[0] = y[1];
  f[1] = dphi * dphi * s * c - L3 * dphi * s / TOP_A + TOP_M * s / TOP_A;
  f[2] = dphi;
}

/* Heavy symmetric top on a ball joint: mass 2 at distance l, moments about the centre reduced by m l^2 (Steiner). */
static PetscErrorCode TopError(PetscReal dt, PetscReal *rms)
{
  Rigid r;
  RigidBodySpec s;
  PetscReal y[3] = {TOP_TILT, 0., 0.}, X[3], sum = 0.;
  const PetscReal m = 2., l = TOP_M / (m * GRAV), w[3] = {TOP_SPIN * sin(TOP_TILT), 0., TOP_SPIN * cos(TOP_TILT)};
  const int steps = (int)(6. / dt + .5);

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidSetGravity(r, down));
  PetscCall(Rod(&s, l, m, TOP_A - m * l * l, TOP_C));
  s.position[0] = l * sin(TOP_TILT), s.position[2] = l * cos(TOP_TILT);
  s.axisangle[1] = 1., s.axisangle[2] = 0., s.axisangle[3] = TOP_TILT;
  for (int k = 0; k < 3; k++) s.omega[k] = w[k];
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(Joint(r, RIGID_JOINT_BALL, 0, RIGID_GROUND, 0., 0., 0., 2));
  PetscCall(RigidSetUp(r));
  for (int n = 1; n <= steps; n++) {
    PetscCall(RigidAdvance(r, n * dt));
    RK4(Top, 3, dt, 20, y);
    PetscCall(RigidGetState(r, 0, X, NULL, NULL, NULL));
    sum +=
        PetscSqr(X[0] / l - sin(y[0]) * cos(y[2])) + PetscSqr(X[1] / l - sin(y[0]) * sin(y[2])) + PetscSqr(X[2] / l - cos(y[0]));
  }
  *rms = sqrt(sum / steps);
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestTop(void)
{
  PetscReal e[3];

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) PetscCall(TopError(.02 / (1 << k), &e[k]));
  printf("heavy top on a ball joint: rms error %.2e %.2e %.2e, orders %.3f %.3f\n", e[0], e[1], e[2], log2(e[0] / e[1]),
         log2(e[1] / e[2]));
  TEST_NEAR(log2(e[0] / e[1]), 2., .15, "order");
  TEST_NEAR(log2(e[1] / e[2]), 2., .08, "order");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Parallelogram: two cranks (length 1, mass 1) and a coupler (mass 2, length 1.5); in space, its 4 hinges hold 3 redundant rows.
 */
static void Parallelogram(const PetscReal y[], PetscReal f[])
{
  f[0] = y[1];
  f[1] = -(1. + 2.) * GRAV * sin(y[0]) / (2. / 3. + 2.);
}

static PetscErrorCode ParallelogramError(PetscReal dt, PetscReal *rms, PetscReal *drift)
{
  Rigid r;
  RigidBodySpec s;
  PetscReal y[2] = {1., 0.}, sum = 0., X[3], p, v;
  const int steps = (int)(2. / dt + .5);

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidSetGravity(r, down));
  for (int i = 0; i < 3; i++) {
    PetscCall(Rod(&s, 1., i < 2 ? 1. : 2., 1. / 12., .02));
    s.position[0] = (i < 2 ? .5 * sin(1.) + 1.5 * i : sin(1.) + .75), s.position[2] = -(i < 2 ? .5 : 1.) * cos(1.);
    s.axisangle[1] = 1., s.axisangle[2] = 0., s.axisangle[3] = i < 2 ? -1. : 0.;
    PetscCall(RigidAddBody(r, &s, NULL));
  }
  for (int i = 0; i < 2; i++) {
    PetscCall(Joint(r, RIGID_JOINT_HINGE, i, RIGID_GROUND, 1.5 * i, 0., 0., 1));
    PetscCall(Joint(r, RIGID_JOINT_HINGE, 2, i, 1.5 * i + sin(1.), 0., -cos(1.), 1));
  }
  PetscCall(RigidSetUp(r));
  *drift = 0.;
  for (int n = 1; n <= steps; n++) {
    PetscCall(RigidAdvance(r, n * dt));
    RK4(Parallelogram, 2, dt, 20, y);
    PetscCall(RigidGetState(r, 2, X, NULL, NULL, NULL));
    sum += PetscSqr(X[0] - .75 - sin(y[0])) + PetscSqr(X[2] + cos(y[0]));
    PetscCall(RigidGetJointError(r, &p, &v));
    *drift = PetscMax(*drift, PetscMax(p, v));
  }
  *rms = sqrt(sum / steps);
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestParallelogram(void)
{
  PetscReal e[2], d[2];

  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) PetscCall(ParallelogramError(.01 / (1 << k), &e[k], &d[k]));
  printf("parallelogram with redundant hinges: rms error %.2e %.2e, order %.3f, drift %.1e\n", e[0], e[1], log2(e[0] / e[1]),
         PetscMax(d[0], d[1]));
  TEST_NEAR(log2(e[0] / e[1]), 2., .1, "order");
  TEST(d[0] < 1e-11 && d[1] < 1e-11, "constraints violated by %g", PetscMax(d[0], d[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Springs act by their mean over the step: an oscillator of frequency w has x_n = x_0 cos(n a), tan(a/2) = w h/2, exactly; a
  damper takes v to v (1 - z/2)/(1 + z/2), z = c h/m. Linear (slider, linear, spring) and angular (hinge, bend) alike.
*/
static PetscErrorCode TestOscillator(RigidJointType type, PetscReal wh)
{
  Rigid r;
  RigidBodySpec s;
  RigidJointSpec j;
  const PetscReal m = 2., J = .7, x0 = .1, k = 50.;
  const PetscBool turn = type == RIGID_JOINT_HINGE || type == RIGID_JOINT_BEND ? PETSC_TRUE : PETSC_FALSE;
  const PetscReal w = sqrt(k / (turn ? J : m)), h = wh / w, a = 2. * atan(.5 * wh);
  PetscReal c, worst = 0., v0 = 0., v1 = 0., V[3], W[3], el, ke, e0;

  PetscFunctionBegin;
  for (int damped = 0; damped < 2; damped++) {
    PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
    PetscCall(RigidBodySpecInit(&s));
    s.shape = RIGID_BOX;
    s.size[0] = s.size[1] = s.size[2] = .2;
    s.mass = m;
    s.inertia[0] = s.inertia[1] = s.inertia[2] = J;
    s.position[0] = 1., s.position[1] = 2.;
    if (damped) {
      if (turn)
        s.omega[2] = 1.;
      else
        s.velocity[2] = 1.;
    }
    PetscCall(RigidAddBody(r, &s, NULL));
    PetscCall(RigidJointSpecInit(&j));
    j.type = type;
    j.a = 0;
    for (int d = 0; d < 3; d++) j.point[d] = j.pointb[d] = s.position[d];
    j.axis[type == RIGID_JOINT_BEND ? 0 : 2] = 1.;
    if (damped)
      j.damping = 3.;
    else
      j.stiffness = k, j.rest = type == RIGID_JOINT_BEND ? 0. : -x0;
    if (type == RIGID_JOINT_SPRING) {
      j.pointb[2] -= 1.;
      j.rest = 1. - (damped ? 0. : x0);
    }
    PetscCall(RigidAddJoint(r, &j, NULL));
    PetscCall(RigidSetUp(r));
    if (type == RIGID_JOINT_BEND && !damped) { /* its rest is the initial placement: turn the body */
      const PetscReal q[4] = {cos(.5 * x0), 0., 0., sin(.5 * x0)};
      PetscCall(RigidSetState(r, 0, NULL, q, NULL, NULL));
    }
    PetscCall(RigidGetJointEnergy(r, &e0));
    PetscCall(RigidGetEnergy(r, &ke, NULL));
    e0 += ke;
    for (int n = 1; n <= 200; n++) {
      PetscCall(RigidAdvance(r, n * h));
      PetscCall(RigidGetJointState(r, 0, &c, NULL));
      if (type == RIGID_JOINT_HINGE || type == RIGID_JOINT_SLIDER || type == RIGID_JOINT_LINEAR) c += x0;
      if (!damped)
        worst = PetscMax(worst, fabs((type == RIGID_JOINT_BEND ? c - fabs(x0 * cos(n * a)) : c - x0 * cos(n * a)) / x0));
      PetscCall(RigidGetState(r, 0, NULL, NULL, V, W));
      if (damped && n == 1) v0 = turn ? W[2] : V[2];
      if (damped && n == 2) v1 = turn ? W[2] : V[2];
    }
    if (!damped) {
      PetscCall(RigidGetJointEnergy(r, &el));
      PetscCall(RigidGetEnergy(r, &ke, NULL));
      TEST_REL(el + ke, e0, 1e-10, "energy of the oscillator"); /* kept exactly by the rule; round-off of 200 solves to 1e-13 */
    }
    PetscCall(RigidDestroy(&r));
  }
  const PetscReal z = 3. * h / (turn ? J : m);
  printf("oscillator, joint type %d, w h = %.2f: off by %.1e; damper ratio %.12f (%.12f)\n", (int)type, wh, worst, v1 / v0,
         (1. - .5 * z) / (1. + .5 * z));
  TEST(worst < 1e-9, "oscillator off by %g",
       worst); /* 200 steps x tolerance 1e-13 x 3 m of coordinates / .1 m, phase errors add up */
  TEST_NEAR(v0, (1. - .5 * z) / (1. + .5 * z), 1e-11, "damper");
  TEST_NEAR(v1 / v0, (1. - .5 * z) / (1. + .5 * z), 1e-11, "damper");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A rail at angle a: x = g sin(a) t^2/2 along it, exact; the reaction is m g cos(a) normal to it. A hanging body: m g. */
static PetscErrorCode TestRailAndReaction(void)
{
  Rigid r;
  RigidBodySpec s;
  RigidJointSpec j;
  PetscReal X[3], F[3], M[3], A[3];
  const PetscReal a = .5;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidSetGravity(r, down));
  PetscCall(Rod(&s, 1., 3., .2, .1));
  s.position[1] = 2.;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidJointSpecInit(&j));
  j.type = RIGID_JOINT_SLIDER;
  j.a = 0;
  j.point[1] = 2.;
  j.axis[0] = cos(a), j.axis[2] = -sin(a);
  PetscCall(RigidAddJoint(r, &j, NULL));
  PetscCall(RigidSetUp(r));
  for (int n = 1; n <= 100; n++) PetscCall(RigidAdvance(r, n * .01));
  PetscCall(RigidGetState(r, 0, X, NULL, NULL, NULL));
  TEST_NEAR(X[0], .5 * GRAV * sin(a) * cos(a), 1e-11, "down the rail");
  TEST_NEAR(X[2], -.5 * GRAV * sin(a) * sin(a), 1e-11, "down the rail");
  PetscCall(RigidGetJointForce(r, 0, F, M));
  TEST_NEAR(F[0], 3. * GRAV * cos(a) * sin(a), 1e-8, "reaction of the rail"); /* tolerance 1e-13 m x 2 m/h^2 */
  TEST_NEAR(F[2], 3. * GRAV * cos(a) * cos(a), 1e-8, "reaction of the rail");
  PetscCall(RigidGetAcceleration(r, 0, A, NULL));
  TEST_NEAR(A[0], GRAV * sin(a) * cos(a), 1e-8, "acceleration along the rail");
  PetscCall(RigidDestroy(&r));

  /* beam clamped by a hinge that carries no moment about y: hold it by a bend joint instead, M = m g l/2 about y */
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidSetGravity(r, down));
  PetscCall(Rod(&s, 1., 3., .2, .1));
  s.position[0] = .5;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidJointSpecInit(&j));
  j.type = RIGID_JOINT_BEND;
  j.a = 0;
  j.axis[0] = 1.;
  j.stiffness = j.torsion = 1e4;
  j.damping = 100.;
  PetscCall(RigidAddJoint(r, &j, NULL));
  PetscCall(RigidSetUp(r));
  for (int n = 1; n <= 3000; n++) PetscCall(RigidAdvance(r, n * .01));
  PetscCall(RigidGetJointForce(r, 0, F, M));
  PetscCall(RigidGetState(r, 0, X, NULL, NULL, NULL));
  TEST_NEAR(F[2], 3. * GRAV, 1e-6, "support force");
  TEST_NEAR(M[1], -3. * GRAV * X[0], 1e-6, "support moment");
  TEST_NEAR(asin(-X[2] / .5), 3. * GRAV * X[0] / 1e4, 1e-9, "angle of the spring");
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Three bodies in space, joined by a spring, a bend joint with torsion, a ball and a slider, tumbling freely: p and L are kept to
   round-off, the energy to second order; a Jacobian that were not the derivative of its row would spoil the latter. */
static PetscErrorCode TumbleError(PetscReal dt, PetscReal *energy, PetscReal *momentum)
{
  Rigid r;
  RigidBodySpec s;
  RigidJointSpec j;
  PetscReal p0[3], L0[3], p[3], L[3], ke, el, e0, a[64 * 8], b[64 * 8];
  PetscInt np;
  const int steps = (int)(1.5 / dt + .5);

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  for (int i = 0; i < 4; i++) {
    PetscCall(RigidBodySpecInit(&s));
    s.shape = RIGID_BOX;
    s.size[0] = .5, s.size[1] = .3, s.size[2] = .8;
    s.density = 10. + i;
    s.position[0] = i, s.position[1] = .3 * i * i, s.position[2] = .1 * i;
    s.axisangle[0] = 1., s.axisangle[1] = i, s.axisangle[3] = .5 * i;
    s.omega[0] = .4, s.omega[1] = -.7 + .9 * i, s.omega[2] = 1.1;
    s.velocity[0] = .2 * i, s.velocity[2] = .5 - .3 * i;
    PetscCall(RigidAddBody(r, &s, NULL));
  }
  PetscCall(RigidJointSpecInit(&j));
  j.type = RIGID_JOINT_SPRING;
  j.a = 0, j.b = 3;
  j.point[0] = .1, j.pointb[0] = 3., j.pointb[1] = 2.5;
  j.stiffness = 20., j.rest = 2.;
  PetscCall(RigidAddJoint(r, &j, NULL));
  j.type = RIGID_JOINT_BEND;
  j.a = 1, j.b = 0;
  j.point[0] = .5, j.point[1] = .2;
  j.axis[0] = 1., j.axis[1] = .5;
  j.stiffness = 8., j.torsion = 5.;
  PetscCall(RigidAddJoint(r, &j, NULL));
  PetscCall(RigidJointSpecInit(&j));
  j.type = RIGID_JOINT_SLIDER;
  j.a = 2, j.b = 1;
  j.point[0] = 1.5, j.point[1] = .7;
  j.axis[0] = 1., j.axis[2] = .5;
  j.stiffness = 30.;
  j.rest = .1;
  PetscCall(RigidAddJoint(r, &j, NULL));
  j.type = RIGID_JOINT_HINGE;
  j.a = 3, j.b = 2;
  j.point[0] = 2.5, j.point[1] = 2.;
  j.stiffness = 4.;
  j.rest = .3;
  PetscCall(RigidAddJoint(r, &j, NULL));
  j.type = RIGID_JOINT_LINEAR;
  j.a = 3, j.b = 1;
  j.stiffness = 6.;
  PetscCall(RigidAddJoint(r, &j, NULL));
  PetscCall(RigidSetUp(r));
  PetscCall(RigidGetMomentum(r, p0, L0));
  PetscCall(RigidGetEnergy(r, &ke, NULL));
  PetscCall(RigidGetJointEnergy(r, &el));
  e0 = ke + el;
  *energy = *momentum = 0.;
  PetscCall(RigidGetPackSize(r, &np));
  for (int n = 1; n <= steps; n++) {
    if (n == steps / 2) PetscCall(RigidPack(r, a));
    PetscCall(RigidAdvance(r, n * dt));
    PetscCall(RigidGetMomentum(r, p, L));
    PetscCall(RigidGetEnergy(r, &ke, NULL));
    PetscCall(RigidGetJointEnergy(r, &el));
    *energy = PetscMax(*energy, fabs(ke + el - e0) / e0);
    for (int k = 0; k < 3; k++) *momentum = PetscMax(*momentum, PetscMax(fabs(p[k] - p0[k]), fabs(L[k] - L0[k])));
  }
  /* restart half way: bit for bit */
  PetscCall(RigidPack(r, b));
  PetscCall(RigidUnpack(r, a));
  PetscCall(RigidSetTime(r, (steps / 2 - 1) * dt));
  for (int n = steps / 2; n <= steps; n++) PetscCall(RigidAdvance(r, n * dt));
  PetscCall(RigidPack(r, a));
  for (PetscInt k = 0; k < np; k++) TEST(a[k] == b[k], "restart differs at %d: %.17g %.17g", (int)k, a[k], b[k]);
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestTumble(void)
{
  PetscReal e[3], m[3];

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) PetscCall(TumbleError(.01 / (1 << k), &e[k], &m[k]));
  printf("tumbling chain: energy error %.2e %.2e %.2e, orders %.3f %.3f; momenta kept to %.1e\n", e[0], e[1], e[2],
         log2(e[0] / e[1]), log2(e[1] / e[2]), PetscMax(m[0], PetscMax(m[1], m[2])));
  TEST_NEAR(log2(e[1] / e[2]), 2., .2, "order of the energy error");
  for (int k = 0; k < 3; k++) TEST(m[k] < 1e-9, "momentum changes by %g", m[k]); /* 600 steps x (tolerance 1e-13 m)/h x kg */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Elastic, perfectly plastic hinge under a constant moment above yield, then unloaded; then rupture. */
static PetscErrorCode TestYield(void)
{
  Rigid r;
  RigidBodySpec s;
  RigidJointSpec j;
  const PetscReal J = 2., K = 100., My = 5., T[3] = {0., 0., 8.}, h = 1e-3;
  PetscReal c, c1, c2, w[3], el, F[3], M[3], thetay, t1, lo = 1e30, hi = -1e30;
  PetscBool broken;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidBodySpecInit(&s));
  s.size[0] = .1;
  s.mass = 1.;
  s.inertia[0] = s.inertia[1] = s.inertia[2] = J;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidJointSpecInit(&j));
  j.type = RIGID_JOINT_HINGE;
  j.a = 0;
  j.axis[2] = 1.;
  j.stiffness = K, j.yield = My, j.rupture = 2.;
  PetscCall(RigidAddJoint(r, &j, NULL));
  PetscCall(RigidSetUp(r));
  PetscCall(RigidAddLoad(r, 0, NULL, T));
  /* elastic until K theta = My: theta = (T/K)(1 - cos wt); then J theta'' = T - My */
  const PetscReal w0 = sqrt(K / J);
  thetay = My / K;
  t1 = acos(1. - My / T[2]) / w0;
  const PetscReal vy = T[2] / K * w0 * sin(w0 * t1);
  for (int n = 1; n <= 500; n++) PetscCall(RigidAdvance(r, n * h));
  PetscCall(RigidGetJointState(r, 0, &c, &broken));
  PetscCall(RigidGetJointForce(r, 0, F, M));
  const PetscReal dt = .5 - t1, want = thetay + vy * dt + .5 * (T[2] - My) / J * dt * dt;
  printf("yield: angle %.6f (%.6f) rad after .5 s, moment %.6f\n", c, want, M[2]);
  TEST_NEAR(c, want, (w0 * h) * (w0 * h) + vy * h * (T[2] - My) / T[2],
            "angle after yield"); /* second order, and the yield time within a step */
  TEST_NEAR(M[2], -My, 1e-9, "moment at yield");
  TEST(!broken, "broken at %g rad", c);
  /* stopped and unloaded: elastic again about the plastic angle c - My/K, no further yield */
  const PetscReal zero[3] = {0., 0., 0.};
  PetscCall(RigidZeroLoads(r));
  PetscCall(RigidSetState(r, 0, NULL, NULL, NULL, zero));
  for (int n = 501; n <= 2500; n++) {
    PetscCall(RigidAdvance(r, n * h));
    PetscCall(RigidGetJointState(r, 0, &c1, NULL));
    lo = PetscMin(lo, c1);
    hi = PetscMax(hi, c1);
  }
  TEST_NEAR(.5 * (lo + hi), c - thetay, 1e-3 * thetay + .5 * vy * h, "plastic angle");
  PetscCall(RigidGetJointEnergy(r, &el));
  TEST(el <= .5 * My * My / K * (1. + 1e-3), "spring energy %g above that at yield", el);
  /* beyond 2 rad it breaks: from then on T alone accelerates */
  PetscCall(RigidAddLoad(r, 0, NULL, T));
  int n = 2500;
  for (broken = PETSC_FALSE; !broken && n < 10000;) {
    PetscCall(RigidAdvance(r, ++n * h));
    PetscCall(RigidGetJointState(r, 0, &c2, &broken));
  }
  TEST(broken && c2 > 2. && c2 < 2.1, "rupture at %g rad", c2);
  PetscCall(RigidGetState(r, 0, NULL, NULL, NULL, w));
  c1 = w[2];
  for (int m = 0; m < 100; m++) PetscCall(RigidAdvance(r, ++n * h));
  PetscCall(RigidGetState(r, 0, NULL, NULL, NULL, w));
  TEST_NEAR(w[2] - c1, T[2] / J * .1, 1e-10, "free after rupture");
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A pendulum carried along by a prescribed body hangs still beside it; planar hinge in 2D; velocities fitted to the joints. */
static PetscErrorCode TestCarried(void)
{
  Rigid r;
  RigidBodySpec s;
  PetscReal X[3], w[3], V[3];
  const PetscReal g2[3] = {0., -GRAV, 0.};

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidSetGravity(r, down));
  PetscCall(Rod(&s, 1., 3., .2, .1));
  s.motion = RIGID_PRESCRIBED;
  s.velocity[0] = .7;
  PetscCall(RigidAddBody(r, &s, NULL));
  s.motion = RIGID_FREE;
  s.position[2] = -1.;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(Joint(r, RIGID_JOINT_BALL, 1, 0, 0., 0., -.5, 2));
  PetscCall(RigidSetUp(r));
  for (int n = 1; n <= 100; n++) PetscCall(RigidAdvance(r, n * .01));
  PetscCall(RigidGetState(r, 1, X, NULL, V, w));
  TEST_NEAR(X[0], .7, 1e-11, "carried along");
  TEST_NEAR(X[2], -1., 1e-11, "hangs");
  PetscCall(RigidDestroy(&r));

  /* a disc on a hinge at its rim in 2D, given a velocity that the hinge does not allow: v = 1 at the centre becomes w = m v r/(J
   * + m r^2) */
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidSetDimension(r, 2));
  PetscCall(RigidSetGravity(r, g2));
  PetscCall(RigidSetSubsteps(r, 4));
  PetscCall(RigidBodySpecInit(&s));
  s.size[0] = .5;
  s.density = 2.;
  s.position[1] = -.5;
  s.velocity[0] = 1.;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(Joint(r, RIGID_JOINT_HINGE, 0, RIGID_GROUND, 0., 0., 0., 2));
  PetscCall(RigidSetUp(r));
  PetscCall(RigidGetState(r, 0, NULL, NULL, V, w));
  TEST_NEAR(w[2], .5 / (.125 + .25), 1e-12, "velocity after the joint takes hold");
  TEST_NEAR(V[0], .5 * w[2], 1e-12, "velocity after the joint takes hold");
  PetscReal e0, pe, ke;
  PetscCall(RigidGetEnergy(r, &e0, &pe));
  e0 += pe;
  for (int n = 1; n <= 300; n++) PetscCall(RigidAdvance(r, n * .01));
  PetscCall(RigidGetState(r, 0, X, NULL, V, w));
  PetscCall(RigidGetEnergy(r, &ke, &pe));
  TEST_NEAR(hypot(X[0], X[1]), .5, 1e-12, "distance from the hinge");
  TEST(X[2] == 0. && w[0] == 0. && w[1] == 0., "leaves the plane");
  TEST_REL(ke + pe, e0, 2e-5, "energy"); /* (w h)^2/8 of the potential energy, w = 4.4 rad/s (as a pendulum), h = 2.5e-3 */
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A body that spins about a hinge off its centre turns by a = 2 asin(w h/2) a step, a chord of length w h r; its turns are
 * counted. */
static PetscErrorCode TestTurns(void)
{
  Rigid r;
  RigidBodySpec s;
  const PetscReal w = 20., wh = .4, J = .1, mr2 = .5;
  PetscReal lo = 0., hi = 1., c, ke0, ke, p, v;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(Rod(&s, 1., 2., .2, .1));
  s.position[0] = .5;
  s.velocity[1] = .5 * w;
  s.omega[2] = w;
  s.inertia[2] = J;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(Joint(r, RIGID_JOINT_HINGE, 0, RIGID_GROUND, 0., 0., 0., 2));
  PetscCall(RigidSetUp(r));
  PetscCall(RigidGetEnergy(r, &ke0, NULL));
  for (int n = 1; n <= 200; n++) PetscCall(RigidAdvance(r, n * wh / w));
  PetscCall(RigidGetJointState(r, 0, &c, NULL));
  PetscCall(RigidGetJointError(r, &p, &v));
  PetscCall(RigidGetEnergy(r, &ke, NULL));
  for (int it = 0; it < 60; it++) {
    const PetscReal a = .5 * (lo + hi);
    if (J * a + mr2 * sin(a) < (J + mr2) * wh)
      lo = a;
    else
      hi = a;
  }
  TEST_REL(c, 200. * lo, 1e-10, "turns about the hinge");
  TEST_REL(ke, ke0, 1e-10, "energy of the rotor");
  TEST(p < 1e-12 && v < 1e-10, "constraints violated by %g, %g", p, v);
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define REFUSE(change, a_, b_)                                                                                                   \
  do {                                                                                                                           \
    RigidJointSpec s = good;                                                                                                     \
    change;                                                                                                                      \
    Refused(RigidAddJoint(r, &s, NULL), #change, a_, b_);                                                                        \
  } while (0)

static PetscErrorCode TestBadInput(void)
{
  Rigid r;
  RigidBodySpec body;
  RigidJointSpec good;
  const PetscReal nan = (PetscReal)NAN, X[3] = {.5, 0., 0.};

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidBodySpecInit(&body));
  body.size[0] = .5;
  for (int i = 0; i < 2; i++) PetscCall(RigidAddBody(r, &body, NULL));
  PetscCall(RigidJointSpecInit(&good));
  good.type = RIGID_JOINT_HINGE;
  good.a = 0;
  good.axis[2] = 1.;
  PetscCall(RigidAddJoint(r, &good, NULL));
  PetscCall(PetscPushErrorHandler(TestCatch, NULL));
  REFUSE(s.b = 0, "joint 1", "body 0 to itself");
  REFUSE(s.a = RIGID_GROUND, "joint 1", "itself");
  REFUSE(s.a = 2, "a = 2", "2 bodies");
  REFUSE(s.b = -7, "b = -7", "2 bodies");
  REFUSE(s.axis[2] = 0., "joint 1", "length > 0");
  REFUSE(s.axis[1] = nan, "joint 1", "finite");
  REFUSE(s.stiffness = -1.5, "stiffness = -1.5", ">= 0");
  REFUSE(s.damping = nan, "damping", ">= 0");
  REFUSE(s.yield = 0., "yield = 0", "> 0");
  REFUSE(s.rupture = -1.5, "rupture = -1.5", "> 0");
  REFUSE(s.type = (RigidJointType)9, "type = 9", "ball");
  REFUSE((s.type = RIGID_JOINT_SPRING, s.rest = -2.5), "rest = -2.5", ">= 0");
  Refused(RigidSetSubsteps(r, 0), "substeps 0", "-rigid_substeps 0", ">= 1");
  PetscCall(RigidSetUp(r));
  PetscCall(RigidSetState(r, 0, X, NULL, NULL, NULL));
  Refused(RigidAdvance(r, .1), "torn joint", "joint 0 (hinge", "not assembled");
  Refused(RigidAddJoint(r, &good, NULL), "late joint", "RigidAddJoint", "before");
  Refused(RigidGetJointState(r, 1, NULL, NULL), "no such joint", "joint 1", "1 joints");
  const PetscReal X0[3] = {0., 0., 0.}, W[3] = {0., 0., 12.5};
  PetscCall(RigidSetState(r, 0, X0, NULL, NULL, W));
  Refused(RigidAdvance(r, .1), "long step", "body 0: turns by 1.25 rad", "-rigid_substeps");
  PetscCall(RigidDestroy(&r));
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidAddBody(r, &body, NULL));
  good.type = RIGID_JOINT_SPRING;
  PetscCall(RigidAddJoint(r, &good, NULL));
  Refused(RigidSetUp(r), "spring of length 0", "joint 0", "length 0");
  PetscCall(RigidDestroy(&r));
  PetscCall(PetscPopErrorHandler());
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, help));
  PetscCall(TestDoublePendulum());
  PetscCall(TestTop());
  PetscCall(TestParallelogram());
  for (int type = RIGID_JOINT_HINGE; type <= RIGID_JOINT_BEND; type++) {
    PetscCall(TestOscillator((RigidJointType)type, .1));
    PetscCall(TestOscillator((RigidJointType)type, 3.)); /* beyond the limit 2 of explicit rules */
  }
  PetscCall(TestRailAndReaction());
  PetscCall(TestTumble());
  PetscCall(TestYield());
  PetscCall(TestCarried());
  PetscCall(TestTurns());
  PetscCall(TestBadInput());
  PetscCall(PetscFinalize());
  return test_report();
}
