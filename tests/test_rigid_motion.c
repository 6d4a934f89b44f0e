/*
  test_rigid_motion.c - dynamics of rigid bodies against exact solutions, against an independent Runge-Kutta integration of
  Eqs. 12-15 written here, and against known invariants and rates of free tops.
*/
#include "rigid.h"
#include "testing.h"

static const char help[] = "Rigid body dynamics against exact solutions.\n";

/* One body, free unless changed by the caller between the two calls. */
static PetscErrorCode Begin(Rigid *r, RigidBodySpec *s)
{
  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, r));
  PetscCall(RigidBodySpecInit(s));
  s->shape = RIGID_BOX;
  s->size[0] = s->size[1] = s->size[2] = 1.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Ready(Rigid r, const RigidBodySpec *s)
{
  PetscFunctionBegin;
  PetscCall(RigidAddBody(r, s, NULL));
  PetscCall(RigidSetUp(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void BodyFrame(const PetscReal q[4], const PetscReal w[3], PetscReal wb[3])
{
  PetscReal R[9];
  RigidRotationMatrix(q, R);
  for (int i = 0; i < 3; i++) wb[i] = R[i] * w[0] + R[3 + i] * w[1] + R[6 + i] * w[2];
}

/* Right-hand sides of Eqs. 14 and 15, G written out as in Eq. 17; y = (q, omega'); torque Tb in the body frame. */
static void EulerRHS(const PetscReal J[3], const PetscReal Tb[3], const PetscReal y[7], PetscReal f[7])
{
  const PetscReal *q = y, *w = y + 4;
  const PetscReal G[3][4] = {{-q[1], q[0], q[3], -q[2]}, {-q[2], -q[3], q[0], q[1]}, {-q[3], q[2], -q[1], q[0]}};
  for (int c = 0; c < 4; c++) f[c] = .5 * (G[0][c] * w[0] + G[1][c] * w[1] + G[2][c] * w[2]);
  f[4] = (Tb[0] - (J[2] - J[1]) * w[1] * w[2]) / J[0];
  f[5] = (Tb[1] - (J[0] - J[2]) * w[2] * w[0]) / J[1];
  f[6] = (Tb[2] - (J[1] - J[0]) * w[0] * w[1]) / J[2];
}

/* Classical RK4 with the torque T constant in space. */
static void EulerRK4(const PetscReal J[3], const PetscReal T[3], PetscReal dt, PetscReal y[7])
{
  PetscReal k[4][7], z[7], Tb[3];
  for (int s = 0; s < 4; s++) {
    const PetscReal c = s == 0 ? 0. : (s == 3 ? 1. : .5);
    for (int i = 0; i < 7; i++) z[i] = y[i] + (s ? c * dt * k[s - 1][i] : 0.);
    BodyFrame(z, T, Tb);
    EulerRHS(J, Tb, z, k[s]);
  }
  for (int i = 0; i < 7; i++) y[i] += dt / 6. * (k[0][i] + 2. * k[1][i] + 2. * k[2][i] + k[3][i]);
}

/* dq/dt = G^T omega'/2, Eq. 15, by a central difference over two tiny steps: error O(dt^2) + O(eps/dt). */
static PetscErrorCode TestQuaternion(void)
{
  Rigid r;
  RigidBodySpec s;
  PetscReal q0[4], q1[4], q2[4], w[3], y[7], f[7], R[9];
  const PetscReal zero[3] = {0., 0., 0.}, dt = 1.e-5;

  PetscFunctionBegin;
  PetscCall(Begin(&r, &s));
  for (int k = 0; k < 3; k++) s.axisangle[k] = (PetscReal)(k + 1);
  s.axisangle[3] = .7;
  s.omega[0] = .3, s.omega[1] = -.5, s.omega[2] = .2;
  s.inertia[0] = 2., s.inertia[1] = 3., s.inertia[2] = 4.;
  PetscCall(Ready(r, &s));
  PetscCall(RigidGetState(r, 0, NULL, q0, NULL, NULL));
  PetscCall(RigidAdvance(r, dt));
  PetscCall(RigidGetState(r, 0, NULL, q1, NULL, w));
  PetscCall(RigidAdvance(r, 2. * dt));
  PetscCall(RigidGetState(r, 0, NULL, q2, NULL, NULL));
  for (int k = 0; k < 4; k++) y[k] = q1[k];
  BodyFrame(q1, w, y + 4);
  EulerRHS(s.inertia, zero, y, f);
  for (int k = 0; k < 4; k++) TEST_NEAR((q2[k] - q0[k]) / (2. * dt), f[k], 1.e-9, "dq/dt");
  TEST_NEAR(q0[0], cos(.35), 1e-15, "scalar part first");
  TEST_NEAR(q0[3], sin(.35) * 3. / sqrt(14.), 1e-15, "vector part");
  RigidRotationMatrix(q2, R);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      PetscReal d = 0.;
      for (int k = 0; k < 3; k++) d += R[3 * i + k] * R[3 * j + k];
      TEST_NEAR(d, i == j ? 1. : 0., 1e-15, "R R^T");
    }
  /* a quarter turn about z carries x to y */
  PetscReal qz[4] = {sqrt(.5), 0., 0., sqrt(.5)};
  RigidRotationMatrix(qz, R);
  TEST_NEAR(R[3], 1., 1e-15, "R e_x = e_y");
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* 2T, H^2, the vector H and |q| over 1e5 steps: round-off of each step adds up to at most 1e5 x 1e-15 = 1e-10. */
static PetscErrorCode TestInvariants(PetscReal dt)
{
  Rigid r;
  RigidBodySpec s;
  PetscReal q[4], w[3], wb[3], p[3], H[3], H0[3], worst[4] = {0., 0., 0., 0.}, twoT0 = 2.0001, HH0 = 4.0001;

  PetscFunctionBegin;
  PetscCall(Begin(&r, &s));
  for (int k = 0; k < 3; k++) s.inertia[k] = (PetscReal)(k + 1);
  s.omega[0] = .01, s.omega[1] = 1.;
  PetscCall(Ready(r, &s));
  PetscCall(RigidGetMomentum(r, p, H0));
  for (int n = 1; n <= 100000; n++) {
    PetscReal twoT = 0., HH = 0., qq = 0.;
    PetscCall(RigidAdvance(r, n * dt));
    if (n % 37 && n != 100000) continue;
    PetscCall(RigidGetState(r, 0, NULL, q, NULL, w));
    BodyFrame(q, w, wb);
    for (int k = 0; k < 3; k++) {
      twoT += s.inertia[k] * wb[k] * wb[k];
      HH += s.inertia[k] * s.inertia[k] * wb[k] * wb[k];
    }
    for (int k = 0; k < 4; k++) qq += q[k] * q[k];
    PetscCall(RigidGetMomentum(r, p, H));
    worst[0] = PetscMax(worst[0], fabs(twoT / twoT0 - 1.));
    worst[1] = PetscMax(worst[1], fabs(HH / HH0 - 1.));
    worst[2] = PetscMax(worst[2], fabs(qq - 1.));
    for (int k = 0; k < 3; k++) worst[3] = PetscMax(worst[3], fabs(H[k] - H0[k]));
  }
  printf("invariants, 1e5 steps of %g s: 2T %.1e, H^2 %.1e, |q|^2 - 1 %.1e, H vector %.1e\n", dt, worst[0], worst[1], worst[2],
         worst[3]);
  TEST(worst[0] <= 1e-10, "2T drifts by %g", worst[0]);
  TEST(worst[1] <= 1e-10, "H^2 drifts by %g", worst[1]);
  TEST(worst[2] <= 1e-14, "|q|^2 drifts by %g", worst[2]);
  TEST(worst[3] <= 1e-10, "H drifts by %g", worst[3]);
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* First two times at which omega'_2 of the Dzhanibekov top vanishes, by cubic Hermite interpolation (error O(dt^4)). */
static PetscErrorCode FlipTimes(PetscReal dt, PetscReal times[2])
{
  Rigid r;
  RigidBodySpec s;
  PetscReal q[4], w[3], wb[3], f0 = 1., d0 = 0., f1, d1;
  int found = 0;

  PetscFunctionBegin;
  PetscCall(Begin(&r, &s));
  for (int k = 0; k < 3; k++) s.inertia[k] = (PetscReal)(k + 1);
  s.omega[0] = .01, s.omega[1] = 1.;
  PetscCall(Ready(r, &s));
  for (int n = 1; found < 2 && n * dt < 40.; n++) {
    PetscCall(RigidAdvance(r, n * dt));
    PetscCall(RigidGetState(r, 0, NULL, q, NULL, w));
    BodyFrame(q, w, wb);
    f1 = wb[1];
    d1 = -(s.inertia[0] - s.inertia[2]) * wb[2] * wb[0] / s.inertia[1];
    if (f0 * f1 < 0.) {
      PetscReal lo = 0., hi = 1.;
      for (int it = 0; it < 60; it++) {
        const PetscReal x = .5 * (lo + hi);
        const PetscReal v = f0 * (1. + 2. * x) * (1. - x) * (1. - x) + d0 * dt * x * (1. - x) * (1. - x) +
                            f1 * x * x * (3. - 2. * x) + d1 * dt * x * x * (x - 1.);
        if (v * f0 > 0.)
          lo = x;
        else
          hi = x;
      }
      times[found++] = (n - 1 + lo) * dt;
    }
    f0 = f1;
    d0 = d1;
  }
  TEST(found == 2, "omega_2 changed its sign %d times in 40 s", found);
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Literature: first flip 10.377305, then every 20.75460976 s. The even error expansion e = c2 dt^2 + c4 dt^4 gives ratio 4. */
static PetscErrorCode TestDzhanibekov(void)
{
  PetscReal a[2], b[2];

  PetscFunctionBegin;
  PetscCall(FlipTimes(.02, a));
  PetscCall(FlipTimes(.01, b));
  const PetscReal e1 = a[0] - 10.377305, e2 = b[0] - 10.377305, rich = (4. * b[0] - a[0]) / 3.,
                  richp = (4. * (b[1] - b[0]) - (a[1] - a[0])) / 3.;
  printf("Dzhanibekov: first flip %.7f %.7f -> %.7f (10.377305), interval %.8f (20.75460976), error ratio %.3f\n", a[0], b[0],
         rich, richp, e1 / e2);
  TEST_NEAR(e1 / e2, 4., .05, "second order");
  /* rounding of the reference plus the dt^4 term, which is about e2 (omega dt)^2 with omega <= 1.2 rad/s */
  TEST_NEAR(rich, 10.377305, 5e-7 + 1.5 * fabs(e2) * 1e-4, "first flip");
  TEST_NEAR(richp, 20.75460976, 5e-9 + 3. * fabs(e2) * 1e-4, "flip interval");
  PetscCall(FlipTimes(1e-3, b));
  TEST_NEAR(b[0], 10.377305, 1e-4, "flip at dt = 1e-3");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Symmetric top (2, 2, 1), omega = (.5, 0, 2): precession 1.11803399 rad/s in space, -1 rad/s in the body, nutation .46364761. */
static PetscErrorCode SymmetricTop(PetscReal dt, PetscReal rate[2], PetscReal *nutation)
{
  Rigid r;
  RigidBodySpec s;
  PetscReal q[4], w[3], wb[3], p[3], H[3], R[9], e1[3], e2[3], phi0 = 0., psi0 = 0., phi = 0., psi = 0., hn;
  const int steps = (int)(1. / dt + .5); /* less than half a turn */

  PetscFunctionBegin;
  *nutation = 0.;
  PetscCall(Begin(&r, &s));
  s.inertia[0] = s.inertia[1] = 2., s.inertia[2] = 1.;
  s.omega[0] = .5, s.omega[2] = 2.;
  PetscCall(Ready(r, &s));
  PetscCall(RigidGetMomentum(r, p, H));
  hn = sqrt(H[0] * H[0] + H[1] * H[1] + H[2] * H[2]);
  e1[0] = H[2] / hn, e1[1] = 0., e1[2] = -H[0] / hn; /* H lies in the x-z plane */
  e2[0] = 0., e2[1] = 1., e2[2] = 0.;
  for (int n = 0; n <= steps; n++) {
    if (n) PetscCall(RigidAdvance(r, n * dt));
    PetscCall(RigidGetState(r, 0, NULL, q, NULL, w));
    BodyFrame(q, w, wb);
    RigidRotationMatrix(q, R);
    const PetscReal a[3] = {R[2], R[5], R[8]}; /* figure axis in space */
    phi = atan2(a[0] * e2[0] + a[1] * e2[1] + a[2] * e2[2], a[0] * e1[0] + a[1] * e1[1] + a[2] * e1[2]);
    psi = atan2(wb[1], wb[0]);
    if (n == 0) phi0 = phi, psi0 = psi;
    *nutation = PetscMax(*nutation, fabs(acos((a[0] * H[0] + a[1] * H[1] + a[2] * H[2]) / hn) - atan(.5)));
  }
  phi -= phi0;
  if (phi < 0.) phi += 2. * PETSC_PI;
  psi -= psi0;
  if (psi > 0.) psi -= 2. * PETSC_PI;
  rate[0] = phi / (steps * dt);
  rate[1] = psi / (steps * dt);
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestSymmetricTop(void)
{
  PetscReal a[2], b[2], na, nb;

  PetscFunctionBegin;
  PetscCall(SymmetricTop(.02, a, &na));
  PetscCall(SymmetricTop(.01, b, &nb));
  printf("symmetric top: space rate %.8f (1.11803399), body rate %.8f (-1), nutation off by %.1e\n", (4. * b[0] - a[0]) / 3.,
         (4. * b[1] - a[1]) / 3., na);
  /* after the dt^2 term is removed, (omega dt)^4/100 with omega = 2.2 rad/s: 1e-8; plus the rounding of the reference */
  TEST_NEAR((4. * b[0] - a[0]) / 3., 1.11803399, 1.5e-8, "space rate");
  TEST_NEAR((4. * b[1] - a[1]) / 3., -1., 1e-8, "body rate");
  TEST(na < 1e-13 && nb < 1e-13, "nutation angle changes by %g", na); /* an invariant: round-off */
  /* without extrapolation the error is (omega dt)^2/12 at most */
  TEST_NEAR(b[0], 1.11803399, 1.118 * 2.2 * 2.2 * 1e-4 / 12., "space rate at dt = .01");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rms difference of (q, omega') from RK4 along 4 s, asymmetric body under a torque constant in space. */
static PetscErrorCode TorqueError(PetscReal dt, PetscReal *rms)
{
  Rigid r;
  RigidBodySpec s;
  const PetscReal T[3] = {.6, -.9, 1.3}, J[3] = {1., 2., 2.5};
  PetscReal y[7] = {1., 0., 0., 0., .7, -.4, .5}, q[4], w[3], wb[3], sum = 0.;
  const int steps = (int)(4. / dt + .5), sub = 20;

  PetscFunctionBegin;
  PetscCall(Begin(&r, &s));
  for (int k = 0; k < 3; k++) s.inertia[k] = J[k], s.omega[k] = y[4 + k];
  PetscCall(Ready(r, &s));
  PetscCall(RigidAddLoad(r, 0, NULL, T));
  for (int n = 1; n <= steps; n++) {
    PetscCall(RigidAdvance(r, n * dt));
    PetscCall(RigidGetState(r, 0, NULL, q, NULL, w));
    BodyFrame(q, w, wb);
    for (int k = 0; k < sub; k++) EulerRK4(J, T, dt / sub, y);
    for (int k = 0; k < 4; k++) sum += (q[k] - y[k]) * (q[k] - y[k]);
    for (int k = 0; k < 3; k++) sum += (wb[k] - y[4 + k]) * (wb[k] - y[4 + k]);
  }
  *rms = sqrt(sum / steps);
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestTorqueOrder(void)
{
  PetscReal e[3];

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) PetscCall(TorqueError(.04 / (1 << k), &e[k]));
  printf("constant torque: rms error %.3e %.3e %.3e, orders %.3f %.3f\n", e[0], e[1], e[2], log2(e[0] / e[1]), log2(e[1] / e[2]));
  TEST_NEAR(log2(e[0] / e[1]), 2., .1, "order"); /* e = c2 dt^2 (1 + O(dt^2)) */
  TEST_NEAR(log2(e[1] / e[2]), 2., .05, "order");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Thrown, with and without buoyancy: a parabola, exact but for round-off (200 steps x 1e-16 x 100 m). */
static PetscErrorCode TestProjectile(PetscReal rho)
{
  Rigid r;
  RigidBodySpec s;
  const PetscReal g[3] = {0., 1., -9.81}, F[3] = {0., 0., 50.};
  PetscReal X[3], V[3], A[3], ke0, pe0, ke, pe, t = 0.;

  PetscFunctionBegin;
  PetscCall(Begin(&r, &s));
  s.shape = RIGID_SPHERE;
  s.size[0] = .1;
  s.density = 2000.;
  s.position[0] = 1.;
  s.velocity[0] = 3., s.velocity[2] = 20.;
  PetscCall(RigidSetGravity(r, g));
  PetscCall(RigidSetFluidDensity(r, rho));
  PetscCall(Ready(r, &s));
  PetscCall(RigidGetBody(r, 0, &s));
  TEST_REL(s.mass, 2000. * 4. / 3. * PETSC_PI * 1e-3, 1e-14, "mass of the sphere");
  PetscCall(RigidGetEnergy(r, &ke0, &pe0));
  for (int n = 1; n <= 200; n++) PetscCall(RigidAdvance(r, t = n * .01));
  PetscCall(RigidGetEnergy(r, &ke, &pe));
  TEST_REL(ke + pe, ke0 + pe0, 1e-12, "energy of the thrown body");
  PetscCall(RigidAddLoad(r, 0, F, NULL));
  for (int n = 201; n <= 400; n++) PetscCall(RigidAdvance(r, t = n * .01));
  PetscCall(RigidGetState(r, 0, X, NULL, V, NULL));
  PetscCall(RigidGetAcceleration(r, 0, A, NULL));
  for (int k = 0; k < 3; k++) {
    const PetscReal a = g[k] * (1. - rho / 2000.), f = F[k] / s.mass;
    TEST_NEAR(V[k], s.velocity[k] + 4. * a + 2. * f, 1e-11, "velocity");
    TEST_NEAR(X[k], s.position[k] + 4. * s.velocity[k] + 8. * a + 2. * f, 1e-11, "position");
    TEST_NEAR(A[k], a + f, 1e-13, "acceleration");
  }
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A cube moving and spinning freely is on a straight line and turns at a constant rate: exact to 1e-10 after 1e4 steps. */
static PetscErrorCode TestFreeCube(void)
{
  Rigid r;
  RigidBodySpec s;
  const PetscReal w0[3] = {1.1, -.7, 2.3}, v0[3] = {.3, .2, -.9};
  PetscReal X[3], q[4], w[3], n, t = 0.;

  PetscFunctionBegin;
  PetscCall(Begin(&r, &s));
  for (int k = 0; k < 3; k++) s.omega[k] = w0[k], s.velocity[k] = v0[k];
  PetscCall(Ready(r, &s));
  for (int k = 1; k <= 10000; k++) PetscCall(RigidAdvance(r, t = k * 1e-3));
  PetscCall(RigidGetState(r, 0, X, q, NULL, w));
  n = sqrt(w0[0] * w0[0] + w0[1] * w0[1] + w0[2] * w0[2]);
  TEST_NEAR(q[0], cos(.5 * n * t), 1e-10, "quaternion");
  for (int k = 0; k < 3; k++) {
    TEST_NEAR(q[k + 1], sin(.5 * n * t) * w0[k] / n, 1e-10, "quaternion");
    TEST_NEAR(X[k], v0[k] * t, 1e-10, "position");
    TEST_NEAR(w[k], w0[k], 1e-12, "angular velocity");
  }
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define TOP_A 1.    /* transverse moment about the pivot */
#define TOP_C .5    /* axial moment */
#define TOP_M 1.6   /* m g l */
#define TOP_SPIN 5. /* rad/s */
#define TOP_TILT .6 /* rad */

/* Heavy symmetric top in Euler angles (theta, dtheta, phi), p_phi = p_phi(0), L3 = C spin (any textbook). */
static void TopRHS(const PetscReal y[3], PetscReal pphi, PetscReal L3, PetscReal f[3])
{
  const PetscReal s = sin(y[0]), c = cos(y[0]), dphi = (pphi - L3 * c) / (TOP_A * s * s);
  f[0] = y[1];
  f[1] = dphi * dphi * s * c - L3 * dphi * s / TOP_A + TOP_M * s / TOP_A;
  f[2] = dphi;
}

/* Replace the loads by the moment of gravity about the pivot, l n x (-m g e_z), for the orientation now. */
static PetscErrorCode TopMoment(Rigid r, PetscReal T[3])
{
  PetscReal q[4], R[9];

  PetscFunctionBegin;
  PetscCall(RigidGetState(r, 0, NULL, q, NULL, NULL));
  RigidRotationMatrix(q, R);
  T[0] = -TOP_M * R[5];
  T[1] = TOP_M * R[2];
  T[2] = 0.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pivot is the body's centre, held by translation locks; the load of a step is taken half way (predictor), second order. */
static PetscErrorCode TopError(PetscReal dt, PetscReal *rms, PetscReal *turned)
{
  Rigid r;
  RigidBodySpec s;
  PetscReal y[3] = {TOP_TILT, 0., 0.}, sum = 0., state[RIGID_PACK_SIZE + RIGID_LEDGER_SIZE], q[4], R[9], T[3];
  const PetscReal L3 = TOP_C * TOP_SPIN, pphi = L3 * cos(TOP_TILT);
  const int steps = (int)(6. / dt + .5), sub = 20;

  PetscFunctionBegin;
  PetscCall(Begin(&r, &s));
  s.inertia[0] = s.inertia[1] = TOP_A, s.inertia[2] = TOP_C;
  s.axisangle[0] = 0., s.axisangle[1] = 1., s.axisangle[2] = 0., s.axisangle[3] = TOP_TILT; /* axis in the x-z plane */
  s.omega[0] = TOP_SPIN * sin(TOP_TILT), s.omega[2] = TOP_SPIN * cos(TOP_TILT);
  for (int k = 0; k < 3; k++) s.lock[k] = PETSC_TRUE;
  PetscCall(Ready(r, &s));
  for (int n = 1; n <= steps; n++) {
    PetscCall(TopMoment(r, T));
    PetscCall(RigidZeroLoads(r));
    PetscCall(RigidPack(r, state));
    PetscCall(RigidAddLoad(r, 0, NULL, T));
    PetscCall(RigidAdvance(r, (n - .5) * dt));
    PetscCall(TopMoment(r, T));
    PetscCall(RigidUnpack(r, state));
    PetscCall(RigidSetTime(r, (n - 1) * dt));
    PetscCall(RigidAddLoad(r, 0, NULL, T));
    PetscCall(RigidAdvance(r, n * dt));
    for (int m = 0; m < sub; m++) {
      PetscReal k[4][3], z[3];
      for (int st = 0; st < 4; st++) {
        for (int i = 0; i < 3; i++) z[i] = y[i] + (st ? (st == 3 ? 1. : .5) * dt / sub * k[st - 1][i] : 0.);
        TopRHS(z, pphi, L3, k[st]);
      }
      for (int i = 0; i < 3; i++) y[i] += dt / sub / 6. * (k[0][i] + 2. * k[1][i] + 2. * k[2][i] + k[3][i]);
    }
    PetscCall(RigidGetState(r, 0, NULL, q, NULL, NULL));
    RigidRotationMatrix(q, R);
    sum += PetscSqr(R[2] - sin(y[0]) * cos(y[2])) + PetscSqr(R[5] - sin(y[0]) * sin(y[2])) + PetscSqr(R[8] - cos(y[0]));
  }
  *turned = y[2];
  *rms = sqrt(sum / steps);
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestHeavyTop(void)
{
  PetscReal e[3], turned;

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) PetscCall(TopError(.02 / (1 << k), &e[k], &turned));
  printf("heavy top: figure axis off by %.3e %.3e %.3e (rms), orders %.3f %.3f, precession %.4f rad\n", e[0], e[1], e[2],
         log2(e[0] / e[1]), log2(e[1] / e[2]), turned);
  TEST(fabs(turned) > 1., "the top precesses by %g rad only: nothing is tested", turned);
  TEST_NEAR(log2(e[0] / e[1]), 2., .15, "order");
  TEST_NEAR(log2(e[1] / e[2]), 2., .08, "order");
  /* phase error (omega dt)^2/12 over the path of 6 s x 1.2 rad/s at dt = .005 with omega = 5 rad/s */
  TEST(e[2] < 7. * 5. * 5. * 2.5e-5 / 12. * 2., "figure axis off by %g", e[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Turning about one space axis only: J_zz alpha = T, exact; the angle about a tilted body's z through J_zz = e_z.R J R^T e_z. */
static PetscErrorCode TestLocks(void)
{
  Rigid r;
  RigidBodySpec s;
  const PetscReal F[3] = {1., 2., 3.}, T[3] = {5., 7., 2.}, J[3] = {2., 3., 4.}, tilt = .4;
  PetscReal X[3], w[3], ke0, ke, worst = 0., al[3], e[2];
  const PetscReal Jzz = J[2] * cos(tilt) * cos(tilt) + J[1] * sin(tilt) * sin(tilt);

  PetscFunctionBegin;
  PetscCall(Begin(&r, &s));
  for (int k = 0; k < 3; k++) s.inertia[k] = J[k];
  s.axisangle[0] = 1., s.axisangle[2] = 0., s.axisangle[3] = tilt;
  s.mass = 2.;
  s.lock[1] = s.lock[3] = s.lock[4] = PETSC_TRUE;
  PetscCall(Ready(r, &s));
  PetscCall(RigidAddLoad(r, 0, F, T));
  for (int n = 1; n <= 100; n++) PetscCall(RigidAdvance(r, n * .01));
  PetscCall(RigidGetState(r, 0, X, NULL, NULL, w));
  PetscCall(RigidGetAcceleration(r, 0, NULL, al));
  TEST_NEAR(X[0], .25, 1e-13, "free along x");
  TEST_NEAR(X[1], 0., 0., "locked along y");
  TEST_NEAR(w[2], T[2] / Jzz, 1e-13, "turns about z");
  TEST_NEAR(al[2], T[2] / Jzz, 1e-12, "angular acceleration about z");
  TEST(w[0] == 0. && w[1] == 0., "locked rotations move: %g %g", w[0], w[1]);
  PetscCall(RigidDestroy(&r));
  /* one locked rotation: ideal constraint, energy kept up to a bounded error of second order */
  for (int pass = 0; pass < 2; pass++) {
    const PetscReal dt = .02 / (1 + pass);
    PetscCall(Begin(&r, &s));
    for (int k = 0; k < 3; k++) s.inertia[k] = J[k];
    s.lock[3] = PETSC_TRUE;
    s.omega[1] = .8, s.omega[2] = 1.3;
    s.axisangle[0] = 1., s.axisangle[1] = .3, s.axisangle[3] = tilt;
    PetscCall(Ready(r, &s));
    PetscCall(RigidGetEnergy(r, &ke0, NULL));
    worst = 0.;
    for (int n = 1; n <= 2000 * (1 + pass); n++) {
      PetscCall(RigidAdvance(r, n * dt));
      PetscCall(RigidGetEnergy(r, &ke, NULL));
      worst = PetscMax(worst, fabs(ke / ke0 - 1.));
    }
    PetscCall(RigidGetState(r, 0, NULL, NULL, NULL, w));
    TEST(fabs(w[0]) < 1e-14, "locked rotation: %g", w[0]);
    e[pass] = worst;
    PetscCall(RigidDestroy(&r));
  }
  printf("one locked rotation: energy error over 40 s %.2e %.2e\n", e[0], e[1]);
  TEST_NEAR(e[0] / e[1], 4., .4, "energy error of second order");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fixed and prescribed bodies go their way whatever loads they get; a planar disc rolls J_z alpha = T. */
static PetscErrorCode TestOtherMotions(void)
{
  Rigid r;
  RigidBodySpec s;
  const PetscReal F[3] = {1., 2., 3.}, g[3] = {0., -9.81, 0.};
  PetscReal X[3], q[4], V[3], w[3], a[3 * RIGID_PACK_SIZE + RIGID_LEDGER_SIZE], b[3 * RIGID_PACK_SIZE + RIGID_LEDGER_SIZE];

  PetscFunctionBegin;
  PetscCall(Begin(&r, &s));
  s.motion = RIGID_FIXED;
  s.velocity[0] = 1.;
  PetscCall(RigidAddBody(r, &s, NULL));
  s.motion = RIGID_PRESCRIBED;
  s.omega[2] = 2.;
  PetscCall(RigidAddBody(r, &s, NULL));
  s.motion = RIGID_FREE;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidSetGravity(r, g));
  PetscCall(RigidSetUp(r));
  for (PetscInt k = 0; k < 3; k++) PetscCall(RigidAddLoad(r, k, F, F));
  for (int n = 1; n <= 50; n++) PetscCall(RigidAdvance(r, n * .02));
  PetscCall(RigidGetState(r, 0, X, q, V, w));
  TEST(X[0] == 0. && V[0] == 0. && q[0] == 1. && w[2] == 0., "the fixed body moves");
  PetscCall(RigidGetState(r, 1, X, q, V, w));
  TEST_NEAR(X[0], 1., 1e-14, "prescribed velocity");
  TEST_NEAR(X[1], 0., 0., "prescribed body does not fall");
  TEST_NEAR(q[3], sin(1.), 1e-14, "prescribed spin");
  /* a restart from packed variables goes on bit for bit */
  PetscCall(RigidPack(r, a));
  for (int n = 51; n <= 60; n++) PetscCall(RigidAdvance(r, n * .02));
  PetscCall(RigidPack(r, b));
  PetscCall(RigidUnpack(r, a));
  PetscCall(RigidSetTime(r, 50 * .02));
  for (int n = 51; n <= 60; n++) PetscCall(RigidAdvance(r, n * .02));
  PetscCall(RigidPack(r, a));
  for (int k = 0; k < 3 * RIGID_PACK_SIZE + RIGID_LEDGER_SIZE; k++)
    TEST(a[k] == b[k], "restart differs at %d: %.17g %.17g", k, a[k], b[k]);
  PetscCall(RigidDestroy(&r));

  PetscCall(Begin(&r, &s));
  PetscCall(RigidSetDimension(r, 2));
  s.shape = RIGID_CYLINDER;
  s.size[0] = .5;
  s.density = 4.;
  s.velocity[1] = 2.;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidSetUp(r));
  PetscCall(RigidGetBody(r, 0, &s));
  TEST_REL(s.mass, 4. * PETSC_PI * .25, 1e-14, "mass of a disc per metre");
  TEST_REL(s.inertia[2], s.mass * .125, 1e-14, "moment of a disc per metre");
  PetscCall(RigidAddLoad(r, 0, F, F));
  for (int n = 1; n <= 50; n++) PetscCall(RigidAdvance(r, n * .02));
  PetscCall(RigidGetState(r, 0, X, q, V, w));
  TEST_NEAR(w[2], F[2] / s.inertia[2], 1e-12, "spin of the disc");
  TEST_NEAR(X[1], 2. + .5 * F[1] / s.mass, 1e-12, "planar motion");
  TEST(X[2] == 0. && V[2] == 0. && w[0] == 0. && w[1] == 0. && q[1] == 0. && q[2] == 0., "the disc leaves its plane");
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Motion table: velocity linear between its times, so that the path is made of parabolas, exact for any steps; slope =
 * acceleration. */
static PetscErrorCode TestTable(void)
{
  Rigid r;
  RigidBodySpec s;
  const PetscReal t[3] = {.1, .35, .8}, v[9] = {0., 1., 0., 2., 1., 0., -1., 1., 0.}, w[9] = {0., 0., 0., 0., 0., 4., 0., 0., 4.};
  PetscReal X[3], q[4], V[3], W[3], A[3], al[3], now = 0.;

  PetscFunctionBegin;
  PetscCall(Begin(&r, &s));
  s.motion = RIGID_PRESCRIBED;
  s.velocity[0] = 99.;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidSetMotionTable(r, 0, 3, t, v, w));
  PetscCall(RigidSetUp(r));
  for (int n = 1; now < .6; n++) PetscCall(RigidAdvance(r, now = n * .03));
  PetscCall(RigidGetState(r, 0, X, q, V, W));
  PetscCall(RigidGetAcceleration(r, 0, A, al));
  const PetscReal x1 = .5 * .25 * 2., dt = now - .35, angle = .5 * .25 * 4. + 4. * dt;
  TEST_NEAR(X[0], x1 + 2. * dt - .5 * 3. / .45 * dt * dt, 1e-14, "path");
  TEST_NEAR(X[1], now, 1e-14, "path");
  TEST_NEAR(V[0], 2. - 3. / .45 * dt, 1e-14, "velocity");
  TEST_NEAR(A[0], -3. / .45, 1e-13, "acceleration");
  TEST_NEAR(q[3], sin(.5 * angle), 1e-14, "turn");
  TEST_NEAR(W[2], 4., 0., "angular velocity");
  PetscCall(RigidAdvance(r, 1.));
  PetscCall(RigidGetState(r, 0, X, NULL, V, NULL));
  PetscCall(RigidGetAcceleration(r, 0, A, NULL));
  TEST_NEAR(X[0], x1 + .5 * .45 * 1. - .2, 1e-14, "after the table");
  TEST(V[0] == -1. && A[0] == 0., "after the table: %g m/s, %g m/s^2", V[0], A[0]);
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One body with its own gravity, a load and a torque beside one without: parabola and uniform spin-up are exact; the work of the
 * torque is the gain of energy. */
static PetscErrorCode TestOwnLoads(void)
{
  const PetscReal g[3] = {0., 0., -9.}, own[3] = {1., 0., 2.}, F[3] = {0., 3., 0.}, T[3] = {0., 0., 4.}, rho = 300., n = 40.;
  PetscReal X[3], w[3], K0, P0, K, P, bad[3] = {0., 0., 0.};
  PetscErrorCode ierr;
  RigidBodySpec s;
  Rigid r;

  PetscFunctionBegin;
  PetscCall(Begin(&r, &s));
  PetscCall(RigidSetGravity(r, g));
  PetscCall(RigidSetFluidDensity(r, rho));
  s.shape = RIGID_SPHERE;
  s.size[0] = .2;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidSetBodyGravity(r, 1, own));
  PetscCall(RigidSetBodyLoad(r, 1, F, T));
  PetscCall(RigidSetUp(r));
  PetscCall(RigidGetBody(r, 1, &s));
  PetscCall(RigidGetEnergy(r, &K0, &P0));
  for (int k = 1; k <= 40; k++) PetscCall(RigidAdvance(r, k / n));
  PetscCall(RigidGetEnergy(r, &K, &P));
  const PetscReal V = 4. / 3. * PETSC_PI * .008, t = 1.;
  for (int b = 0; b < 2; b++) {
    PetscCall(RigidGetState(r, b, X, NULL, NULL, w));
    for (int k = 0; k < 3; k++) {
      const PetscReal a = b ? own[k] + (F[k] - rho * V * g[k]) / s.mass : (1. - rho * V / s.mass) * g[k];
      TEST_NEAR(X[k] - s.position[k], .5 * a * t * t, 1e-12, b ? "path under its own loads" : "path without");
      TEST_NEAR(w[k], b ? T[k] / s.inertia[k] * t : 0., 1e-12, "spin");
    }
  }
  TEST_NEAR(K + P - K0 - P0, T[2] * .5 * T[2] / s.inertia[2] * t * t, 1e-10 * K, "energy and the torque's work");
  bad[1] = (PetscReal)NAN;
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  ierr = RigidSetBodyLoad(r, 1, bad, NULL);
  TEST(ierr, "a load that is not finite was taken");
  ierr = RigidSetBodyGravity(r, 2, own);
  TEST(ierr, "gravity of a body that is not there was taken");
  PetscCall(PetscPopErrorHandler());
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, help));
  PetscCall(TestQuaternion());
  PetscCall(TestInvariants(.01));
  PetscCall(TestInvariants(.3));
  PetscCall(TestDzhanibekov());
  PetscCall(TestSymmetricTop());
  PetscCall(TestTorqueOrder());
  PetscCall(TestProjectile(0.));
  PetscCall(TestProjectile(900.));
  PetscCall(TestFreeCube());
  PetscCall(TestHeavyTop());
  PetscCall(TestLocks());
  PetscCall(TestOtherMotions());
  PetscCall(TestTable());
  PetscCall(TestOwnLoads());
  PetscCall(PetscFinalize());
  return test_report();
}
