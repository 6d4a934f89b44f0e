/*
  Joints between beams: two collinear beams are one, a ball-jointed pendulum swings as a rigid double pendulum, frames and tripods
  carry loads as structural mechanics says, momentum is kept, and wrong joints are refused.
*/
#include "ancf_common.h"

/*
  The seed's swing with one beam of four elements, and with two of two joined rigidly, the second one from the joint on or
  (turned) towards it. The same equations in another order: positions agree to the accumulated round-off and Newton's tolerance,
  1e-9 of each step's first residual.
*/
static PetscErrorCode TestCollinear(const char options[], PetscBool turned)
{
  const Joint j = {{0, 1}, {2, turned ? 2 : 0}, 2, ANCF_JOINT_RIGID};
  AncfBeamSpec whole, half[2];
  const PetscReal *e, *f;
  Ancf a, b;

  PetscFunctionBegin;
  PetscCall(SeedSpec(4, &whole));
  half[0] = half[1] = whole;
  Place(&half[0], 0, 0, 0, 0.5, 0, 0, 2);
  Place(&half[1], turned ? 1 : 0.5, 0, 0, turned ? 0.5 : 1, 0, 0, 2);
  half[1].end0 = ANCF_END_FREE;
  PetscCall(BeamCreate(&whole, -9.81, options, &a));
  PetscCall(NetCreate(2, half, 1, &j, -9.81, options, &b));
  for (int i = 1; i <= 300; i++) {
    PetscCall(AncfAdvance(a, 1e-3 * i));
    PetscCall(AncfAdvance(b, 1e-3 * i));
  }
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  PetscCall(AncfGetState(b, NULL, &f, NULL, NULL));
  printf("%-44s collinear beams%s: tip %.6f, %.6f m, off by %.1e m\n", options, turned ? ", turned" : "", (double)e[24],
         (double)e[26], (double)PetscAbsReal(e[26] - f[turned ? 20 : 32]));
  for (int c = 0; c < 3; c++) {
    TEST_NEAR(f[(turned ? 18 : 30) + c], e[24 + c], 1e-8, "tip of two beams");
    TEST_NEAR(f[12 + c], e[12 + c], 1e-8, "middle of two beams");
    TEST_NEAR(f[(turned ? 30 : 18) + c], f[12 + c], 1e-15, "the joint's nodes");
    TEST_NEAR(f[(turned ? 33 : 21) + c], (turned ? -1 : 1) * f[15 + c], 1e-15, "the joint's gradients");
  }
  PetscCall(AncfDestroy(&a));
  PetscCall(AncfDestroy(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rigid double pendulum of two uniform rods of length l, angles from the vertical: accelerations by Lagrange's equations. */
static void PendulumRate(const double y[4], double l, double g, double r[4])
{
  const double c = cos(y[0] - y[1]), s = sin(y[0] - y[1]);
  const double a = 4.0 / 3, b = 0.5 * c, d = 1.0 / 3;
  const double p = -0.5 * s * y[3] * y[3] - 1.5 * g / l * sin(y[0]), q = 0.5 * s * y[2] * y[2] - 0.5 * g / l * sin(y[1]);
  const double det = a * d - b * b;

  r[0] = y[2], r[1] = y[3];
  r[2] = (d * p - b * q) / det, r[3] = (a * q - b * p) / det;
}

static void Pendulum(double y[4], double l, double g, double t, int n)
{
  const double h = t / n;

  for (int i = 0; i < n; i++) {
    double k[4][4], z[4];

    PendulumRate(y, l, g, k[0]);
    for (int s = 1; s < 4; s++) {
      for (int c = 0; c < 4; c++) z[c] = y[c] + (s == 3 ? h : h / 2) * k[s - 1][c];
      PendulumRate(z, l, g, k[s]);
    }
    for (int c = 0; c < 4; c++) y[c] += h / 6 * (k[0][c] + 2 * k[1][c] + 2 * k[2][c] + k[3][c]);
  }
}

/*
  Two stiff rods, a ball in between, from 90 and 60 degrees. A rod bends by about 5 w l^4/(384 EI) and stretches by rhoA g l^2/EA
  with its weight per length w: for E = 2e10 Pa and d = 0.04 m, l = 0.5 m below 1e-6 m; the time step gives (dt/T)^2 of the
  motion, T = 1 s: 1e-6 times some ten. The error must fall at second order until it meets that floor.
*/
static PetscErrorCode TestDoublePendulum(const char options[], PetscReal dt, PetscReal tol)
{
  const Joint j = {{0, 1}, {2, 0}, 2, ANCF_JOINT_BALL};
  const double l = 0.5;
  double y[4] = {PETSC_PI / 2, PETSC_PI / 3, 0, 0}, x[4];
  AncfBeamSpec s[2];
  const PetscReal *e;
  Ancf a;

  PetscFunctionBegin;
  PetscCall(SeedSpec(2, &s[0]));
  s[0].young = 2e10;
  s[1] = s[0];
  s[0].end0 = ANCF_END_PIN;
  s[1].end0 = ANCF_END_FREE;
  Place(&s[0], 0, 0, 0, l, 0, 0, 2);
  Place(&s[1], l, 0, 0, l + l * sin(y[1]), 0, -l * cos(y[1]), 2);
  PetscCall(NetCreate(2, s, 1, &j, -9.81, options, &a));
  for (int i = 1; i * dt <= 0.6 + 1e-9; i++) PetscCall(AncfAdvance(a, dt * i));
  Pendulum(y, l, 9.81, 0.6, 6000);
  x[0] = l * sin(y[0]), x[1] = -l * cos(y[0]), x[2] = x[0] + l * sin(y[1]), x[3] = x[1] - l * cos(y[1]);
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  printf("%-44s double pendulum, dt %.1e: tip %.6f, %.6f m, rigid %.6f, %.6f\n", options, (double)dt, (double)e[30],
         (double)e[32], x[2], x[3]);
  TEST_NEAR(e[12], x[0], tol, "hinge x");
  TEST_NEAR(e[14], x[1], tol, "hinge z");
  TEST_NEAR(e[30], x[2], tol, "tip x");
  TEST_NEAR(e[32], x[3], tol, "tip z");
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Portal frame: two clamped columns of height h, a girder of length b, rigid corners, equal EI, a small force H at one corner.
  Slope deflection of Euler-Bernoulli members without axial strain, k = h/b:
    sway H h^3/(12 EI) (3 k + 2)/(6 k + 1), shear H/2 in each column, moment H h/2 (3 k + 1)/(6 k + 1) at each foot.
  Checks of its limits: k = 0, two cantilevers; k large, two columns clamped at both ends. EA is raised so that axial strain,
  EI/(EA h^2), does not matter; the sway is 3e-4 h and geometric terms are of the order of its square over the axial one, 1e-4.
*/
static PetscErrorCode TestPortal(const char options[])
{
  const PetscReal h = 1, b = 1.5, H = 1;
  const Joint j[2] = {{{0, 1}, {4, 0}, 2, ANCF_JOINT_RIGID}, {{1, 2}, {4, 4}, 2, ANCF_JOINT_RIGID}};
  AncfBeamSpec s[3];
  PetscReal EI, k, D, F[3] = {0, 0, 0}, f[6], M[3];
  const PetscReal *e;
  Ancf a;

  PetscFunctionBegin;
  PetscCall(SeedSpec(4, &s[0]));
  s[0].young = 2e9;
  s[0].EA = 2e9 * PETSC_PI * 4e-4 * 1e3; /* no axial strain worth mentioning */
  s[1] = s[2] = s[0];
  s[1].end0 = ANCF_END_FREE;
  Place(&s[0], 0, 0, 0, 0, 0, h, 4);
  Place(&s[1], 0, 0, h, b, 0, h, 4);
  Place(&s[2], b, 0, 0, b, 0, h, 4);
  PetscCall(NetCreate(3, s, 2, j, 0, options, &a));
  EI = 2e9 * PETSC_PI / 64 * PetscSqr(PetscSqr(0.04));
  F[0] = H;
  PetscCall(AncfAddPointLoad(a, 0, 1, F));
  PetscCall(AncfSolveStatic(a, 1));
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  k = h / b;
  D = H * h * h * h / (12 * EI) * (3 * k + 2) / (6 * k + 1);
  printf("%-44s portal frame: sway %.8g m, beam theory %.8g\n", options, (double)e[24], (double)D);
  TEST_REL(e[24], D, 1e-3, "sway of a portal frame");
  PetscCall(AncfGetNodeReaction(a, 0, 0, f));
  TEST_REL(f[0], -H / 2, 1e-3, "shear in a column");
  PetscCall(AncfGetSection(a, 0, 0, NULL, NULL, NULL, M));
  TEST_REL(PetscAbsReal(M[1]), H * h / 2 * (3 * k + 1) / (6 * k + 1), 1e-2, "moment at a foot");
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Star of three arms, clamped at their far ends, joined rigidly at 120 degrees, turned in space; a moment M about the axis n at
  the hub. An arm along t resists a rotation about n with 4 EI/L over its part normal to t: M = 4 EI/L (3 - sum (n.t)^2) theta,
  that is 12 EI/L about the normal of the star and 6 EI/L about the axis in its plane normal to an arm. theta = 1e-4: geometric
  terms, its square, and Newton's tolerance are below 1e-6 of it; the arms are exact cubics.
*/
static PetscErrorCode TestStar(PetscBool inplane, const PetscReal u[3], const PetscReal w[3])
{
  const Joint j = {{0, 1, 2}, {0, 2, 0}, 3, ANCF_JOINT_RIGID};
  AncfBeamSpec s[3];
  PetscReal EI, M[3], n[3], theta = 0, expect, m;
  const PetscReal *e;
  Ancf a;

  PetscFunctionBegin;
  PetscCall(SeedSpec(2, &s[0]));
  s[0].end0 = ANCF_END_FREE, s[0].end1 = ANCF_END_CLAMP;
  s[1] = s[2] = s[0];
  s[1].end0 = ANCF_END_CLAMP, s[1].end1 = ANCF_END_FREE;
  for (int k = 0; k < 3; k++)
    for (int c = 0; c < 3; c++)
      (k == 1 ? s[k].start : s[k].end)[c] = cos(2 * PETSC_PI * k / 3) * u[c] + sin(2 * PETSC_PI * k / 3) * w[c],
                             (k == 1 ? s[k].end : s[k].start)[c] = 0;
  PetscCall(NetCreate(3, s, 1, &j, 0, "", &a));
  EI = 20e6 * PETSC_PI / 64 * PetscSqr(PetscSqr(0.04));
  m = 1e-4 * 4 * EI;
  for (int c = 0; c < 3; c++) n[c] = inplane ? w[c] : u[(c + 1) % 3] * w[(c + 2) % 3] - u[(c + 2) % 3] * w[(c + 1) % 3];
  for (int c = 0; c < 3; c++) M[c] = m * n[c];
  PetscCall(AncfSetMoment(a, 0, 0, M));
  PetscCall(AncfSolveStatic(a, 1));
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  for (int c = 0; c < 3; c++) theta += e[3 + c] * (n[(c + 1) % 3] * u[(c + 2) % 3] - n[(c + 2) % 3] * u[(c + 1) % 3]);
  expect = inplane ? m / (6 * EI) : m / (12 * EI);
  printf("star, moment %s: rotation %.9g, beam theory %.9g\n", inplane ? "in its plane" : "about its normal", (double)theta,
         (double)expect);
  TEST_REL(theta, expect, 1e-5, "rotation of the hub");
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Tripod of pin-jointed legs under a vertical load P: each leg of length L at the angle b from the vertical carries P/(3 cos b),
  and the apex sinks by P L/(3 EA cos^2 b); the change of geometry is of the order of the strain, 1e-5.
*/
static PetscErrorCode TestTripod(const char options[])
{
  const Joint j = {{0, 1, 2}, {1, 1, 1}, 3, ANCF_JOINT_BALL};
  const PetscReal b = PETSC_PI / 6, P = 1, F[3] = {0, 0, -P};
  AncfBeamSpec s[3];
  PetscReal EA, N, f[6], sink, sum = 0;
  const PetscReal *e;
  Ancf a;

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    PetscCall(SeedSpec(1, &s[k]));
    s[k].end0 = ANCF_END_PIN;
    Place(&s[k], sin(b) * cos(2 * PETSC_PI * k / 3), sin(b) * sin(2 * PETSC_PI * k / 3), 0, 0, 0, cos(b), 1);
  }
  PetscCall(NetCreate(3, s, 1, &j, 0, options, &a));
  EA = 20e6 * PETSC_PI / 4 * PetscSqr(0.04);
  PetscCall(AncfAddPointLoad(a, 1, 1, F));
  PetscCall(AncfSolveStatic(a, 1));
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  sink = cos(b) - e[8];
  PetscCall(AncfGetSection(a, 2, 0.5, NULL, &N, NULL, NULL));
  printf("%-44s tripod: sinks %.6g m, statics %.6g; leg %.6g N, statics %.6g\n", options, (double)sink,
         (double)(P / (3 * EA * PetscSqr(cos(b)))), (double)N, (double)(-P / (3 * cos(b))));
  TEST_REL(sink, P / (3 * EA * PetscSqr(cos(b))), 1e-3, "sinking of a tripod");
  TEST_REL(N, -P / (3 * cos(b)), 1e-3, "force in a leg");
  for (PetscInt k = 0; k < 3; k++) { /* the joint hands the load on: its forces add up to zero */
    PetscCall(AncfGetJointForce(a, 0, k, f));
    sum += f[2];
  }
  TEST_NEAR(sum, 0, 1e-9 * P + 1e-7, "forces of the joint"); /* Newton's residual of AncfSolveStatic() */
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Free flight of a spinning network: three arms that meet in ball joints only (1), a rigid bend of two arms (2), or a rigid star
  of three (3), each with one more beam on a ball joint at a tip. Ball joints are linear: linear momentum telescopes to round-off
  and Newton's residual, some 1e-8 N in each of 400 steps.

  The tangents of a corner are not: the velocity of a dependent gradient is taken from the constraint at the ends of a step, its
  acceleration in the step from the constraint's rate. Their difference is the quadrature error of the method, C dt^2 [v''] over
  the flight for the gradient's velocity v, with C = 1/24 for the midpoint rule (alpha2 with radius 1, theta), 1/12 for the
  trapezoidal rule, 1/3 for BDF2; take 1/3. What varies fastest is the stretch that the spin w sets free at the start, strain
  eps = rho/E w^2 R^2 at the radius R, at the frequencies k pi c/L of an arm, c^2 = E/rho. A centrifugal load excites mode k by
  k^-3 of eps, so that the four modes of two cubic elements give |v''| <= 4 eps (pi c/L)^3 each. Mass: rhoA l^2/12 for each of the
  nodes of the corner. Angular momentum: the same with lever R. Energy: the elastic part, 3 eps of all for a spinning rod, to
  its four modes' (dt pi c/L)^2. A corner without the terms of dG/dt would miss w^2 of the acceleration, all the time: 100 times
  more than allowed here.
*/
typedef struct {
  PetscReal momentum, angular, energy;
} Drift;

static Drift FlyBound(const AncfBeamSpec *s, PetscReal spin, PetscReal radius, PetscInt nodes, PetscReal dt)
{
  const PetscReal L = 0.5, l = 0.25, eps = s->density / s->young * PetscSqr(spin * radius);
  const PetscReal frequency = PETSC_PI * PetscSqrtReal(s->young / s->density) / L, x = dt * frequency;
  const PetscReal mass = s->density * PETSC_PI / 4 * PetscSqr(s->diameter) * l * l / 12 * (PetscReal)nodes;
  Drift d;

  d.momentum = mass * x * x / 3 * 2 * 4 * eps * frequency;
  d.angular = d.momentum * radius;
  d.energy = 3 * eps * 4 * x * x;
  return d;
}

static PetscErrorCode Fly(PetscInt arms, const char options[], PetscReal dt)
{
  const Joint j[2] = {{{0, 1, 2}, {0, 0, 0}, arms == 2 ? 2 : 3, arms == 1 ? ANCF_JOINT_BALL : ANCF_JOINT_RIGID},
                      {{0, 3}, {2, 0}, 2, ANCF_JOINT_BALL}};
  AncfBeamSpec s[4];
  PetscReal *x, *y, p0[3], H0[3], p[3], H[3], k, u, E, drift[3] = {0}, radius = 0, q;
  const PetscReal *e, w[3] = {1, -2, 3};
  Drift most;
  PetscInt n;
  Ancf a;

  PetscFunctionBegin;
  for (int b = 0; b < 4; b++) {
    PetscCall(SeedSpec(2, &s[b]));
    s[b].end0 = ANCF_END_FREE;
  }
  Place(&s[0], 0, 0, 0, 0.5, 0, 0, 2);
  Place(&s[1], 0, 0, 0, 0, 0.4, 0.3, 2);
  Place(&s[2], 0, 0, 0, -0.2, -0.3, 0.3, 2);
  Place(&s[3], 0.5, 0, 0, 0.5, 0.5, 0, 2);
  if (arms == 2) Place(&s[2], 9, 0, 0, 9, 0.5, 0, 2); /* on its own */
  PetscCall(NetCreate(4, s, 2, j, 0, options, &a));
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  PetscCall(AncfGetNumNodes(a, &n));
  PetscCall(PetscMalloc2(6 * (size_t)n, &x, 6 * (size_t)n, &y));
  for (PetscInt i = 0; i < 6 * n; i++) x[i] = e[i];
  for (PetscInt i = 0; i < 6 * n; i++)
    y[i] = w[(i + 1) % 3] * x[i - i % 3 + (i + 2) % 3] - w[(i + 2) % 3] * x[i - i % 3 + (i + 1) % 3];
  PetscCall(AncfSetState(a, 0, x, y));
  PetscCall(AncfGetMomentum(a, p0, H0));
  PetscCall(AncfGetEnergy(a, &k, &u, &q));
  E = k + u;
  for (int i = 1; i * dt <= 0.2 + 1e-9; i++) PetscCall(AncfAdvance(a, dt * i));
  PetscCall(AncfGetMomentum(a, p, H));
  PetscCall(AncfGetEnergy(a, &k, &u, &q));
  for (int c = 0; c < 3; c++) {
    drift[0] = PetscMax(drift[0], PetscAbsReal(p[c] - p0[c]));
    drift[1] = PetscMax(drift[1], PetscAbsReal(H[c] - H0[c]));
  }
  drift[2] = PetscAbsReal(k + u - E) / E;
  printf("%-44s free flight, %d arms, dt %.1e: momentum %.1e kg m/s, angular %.1e kg m^2/s, energy %.1e of all\n", options,
         (int)arms, (double)dt, (double)drift[0], (double)drift[1], (double)drift[2]);
  if (arms == 1) TEST_NEAR(drift[0], 0, 1e-9, "linear momentum");
  for (PetscInt i = 0; i < n; i++)
    if (arms > 2 || x[6 * i] < 5) radius = PetscMax(radius, PetscSqrtReal(x[6 * i] * x[6 * i] + x[6 * i + 1] * x[6 * i + 1]));
  most = FlyBound(&s[0], PetscSqrtReal(14), radius, arms, dt);
  if (arms > 1) {
    TEST_NEAR(drift[0], 0, most.momentum, "linear momentum");
    TEST_NEAR(drift[1], 0, most.angular, "angular momentum");
    TEST_NEAR(drift[2], 0, most.energy, "energy");
  }
  PetscCall(PetscFree2(x, y));
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestFly(PetscInt arms, const char options[])
{
  PetscFunctionBegin;
  PetscCall(Fly(arms, options, 1e-3));
  PetscCall(Fly(arms, options, 5e-4));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Every sparse solver gives the same motion: the tip of a star, one arm clamped, after 20 steps, to Newton's tolerance. */
static PetscErrorCode Star(const char options[], PetscReal tip[3])
{
  const Joint j = {{0, 1, 2}, {2, 0, 0}, 3, ANCF_JOINT_RIGID};
  AncfBeamSpec s[3];
  const PetscReal *e;
  Ancf a = NULL;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  for (int b = 0; b < 3; b++) {
    PetscCall(SeedSpec(2, &s[b]));
    if (b) s[b].end0 = ANCF_END_FREE;
  }
  Place(&s[0], 0, 0, 0, 1, 0, 0, 2);
  Place(&s[1], 1, 0, 0, 1, 0.5, 0.1, 2);
  Place(&s[2], 1, 0, 0, 1.3, -0.3, 0.3, 2);
  ierr = NetCreate(3, s, 1, &j, -9.81, options, &a);
  for (int i = 1; i <= 20 && !ierr; i++) ierr = AncfAdvance(a, 5e-3 * i);
  if (!ierr) {
    PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
    PetscCall(PetscArraycpy(tip, e + 48, 3));
  }
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(ierr);
}

static PetscErrorCode TestSolvers(void)
{
  static const char *const same[] = {
#if defined(PETSC_HAVE_SUITESPARSE)
    "-ancf_pc_factor_mat_solver_type klu",
    "-ancf_pc_factor_mat_solver_type umfpack",
    "-ancf_pc_factor_mat_solver_type cholmod",
    "-ancf_pc_type cholesky -ancf_pc_factor_mat_solver_type cholmod",
#endif
    "-ancf_pc_type lu -ancf_pc_factor_mat_solver_type petsc",
    "-ancf_pc_type cholesky -ancf_pc_factor_mat_solver_type petsc",
    "-ancf_ksp_type gmres -ancf_ksp_rtol 1e-12 -ancf_pc_type ilu"
  };
  PetscReal ref[3] = {0}, tip[3] = {0};

  PetscFunctionBegin;
  PetscCall(Star("", ref));
  for (size_t k = 0; k < sizeof(same) / sizeof(same[0]); k++) {
    PetscCall(Star(same[k], tip));
    printf("%-72s tip %.10f, %.10f, %.10f\n", same[k], (double)tip[0], (double)tip[1], (double)tip[2]);
    for (int c = 0; c < 3; c++) TEST_NEAR(tip[c], ref[c], 1e-7, same[k]);
  }
  TEST_ERROR(Star("-ancf_pc_type blocktri", tip), PETSC_ERR_ARG_INCOMP, "-ancf_pc_type blocktri");
  TEST_ERROR(Star("-ancf_ts_type basicsymplectic", tip), PETSC_ERR_ARG_INCOMP, "-ancf_ts_type basicsymplectic");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Bad(const AncfBeamSpec s[2], Joint j, PetscInt joints)
{
  const Joint two[2] = {j, j};
  Ancf a = NULL;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  ierr = NetCreate(2, s, joints, two, 0, "", &a);
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(ierr);
}

static PetscErrorCode TestBadInput(void)
{
  const Joint good = {{0, 1}, {2, 0}, 2, ANCF_JOINT_RIGID};
  AncfBeamSpec s[2], t[2];
  Joint j;
  Ancf a;

  PetscFunctionBegin;
  PetscCall(SeedSpec(2, &s[0]));
  s[0].end0 = ANCF_END_FREE;
  s[1] = s[0];
  Place(&s[1], 1, 0, 0, 1, 1, 0, 2);
  PetscCall(Bad(s, good, 1));
  j = good, j.n = 1;
  TEST_ERROR(Bad(s, j, 1), PETSC_ERR_ARG_OUTOFRANGE, "1 nodes");
  j = good, j.beam[1] = 2;
  TEST_ERROR(Bad(s, j, 1), PETSC_ERR_ARG_OUTOFRANGE, "beam 2 must be in 0..1");
  j = good, j.node[0] = 3;
  TEST_ERROR(Bad(s, j, 1), PETSC_ERR_ARG_OUTOFRANGE, "node 3 of beam 0");
  j = good, j.node[1] = 1;
  TEST_ERROR(Bad(s, j, 1), PETSC_ERR_ARG_INCOMP, "node 1 of beam 1 lies 0.5 m from node 2 of beam 0");
  j = good, j.beam[1] = 0, j.node[1] = 2;
  TEST_ERROR(Bad(s, j, 1), PETSC_ERR_ARG_INCOMP, "each once");
  TEST_ERROR(Bad(s, good, 2), PETSC_ERR_ARG_INCOMP, "in joint 0 already");
  for (int k = 0; k < 2; k++) t[k] = s[k];
  t[0].end1 = t[1].end0 = ANCF_END_CLAMP; /* the joint would be fixed twice */
  TEST_ERROR(Bad(t, good, 1), PETSC_ERR_ARG_INCOMP, "supports fix more");
  t[1] = s[1];
  PetscCall(Bad(t, good, 1)); /* once is fine */
  t[0] = s[0];
  t[1].velocity[2] = 1;
  TEST_ERROR(Bad(t, good, 1), PETSC_ERR_ARG_INCOMP, "tear joint 0 apart by 1");
  t[1] = s[1];
  t[1].end[0] = 2, t[1].end[1] = 1e-5;
  TEST_ERROR(Bad(t, good, 1), PETSC_ERR_ARG_INCOMP, "1e-05 rad from one line");
  PetscCall(NetCreate(2, s, 1, &good, 0, "", &a));
  TEST_ERROR(AncfAddJoint(a, ANCF_JOINT_BALL, 2, good.beam, good.node, NULL), PETSC_ERR_ARG_WRONGSTATE, "after AncfSetUp");
  {
    const PetscReal *e, *v;
    PetscReal x[36], f[6];

    TEST_ERROR(AncfGetJointForce(a, 0, 2, f), PETSC_ERR_ARG_OUTOFRANGE, "no joint 0 with a node 2");
    PetscCall(AncfGetState(a, NULL, &e, &v, NULL));
    PetscCall(PetscArraycpy(x, e, 36));
    x[18] += 0.1;
    TEST_ERROR(AncfSetState(a, 0, x, v), PETSC_ERR_ARG_INCOMP, "broken by 0.1");
  }
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  const PetscReal x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, o1[3] = {2. / 3, 2. / 3, 1. / 3}, o2[3] = {-2. / 3, 1. / 3, 2. / 3};

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TestCollinear("", PETSC_FALSE));
  PetscCall(TestCollinear("", PETSC_TRUE));
  PetscCall(TestCollinear("-ancf_ts_type bdf", PETSC_FALSE));
  PetscCall(TestCollinear("-ancf_ts_type theta", PETSC_TRUE));
  PetscCall(TestCollinear("-ancf_ts_type rk -ancf_substeps 10", PETSC_TRUE));
  PetscCall(TestDoublePendulum("", 1e-3, 1e-4));
  PetscCall(TestPortal(""));
  PetscCall(TestPortal("-ancf_static_pc_type cholesky -ancf_static_pc_factor_mat_solver_type cholmod"));
  PetscCall(TestTripod(""));
  PetscCall(TestStar(PETSC_FALSE, x, y));
  PetscCall(TestStar(PETSC_TRUE, x, y));
  PetscCall(TestStar(PETSC_TRUE, o1, o2));
  PetscCall(TestFly(1, ""));
  PetscCall(TestFly(1, "-ancf_ts_alpha_radius 1"));
  PetscCall(TestFly(2, "-ancf_ts_alpha_radius 1"));
  PetscCall(TestFly(3, "-ancf_ts_alpha_radius 1"));
  PetscCall(TestFly(3, "-ancf_ts_type theta"));
  PetscCall(TestFly(3, "-ancf_ts_type bdf"));
  PetscCall(TestFly(3, "-ancf_ts_type rk -ancf_substeps 4"));
  PetscCall(TestSolvers());
  PetscCall(TestBadInput());
  PetscCall(PetscFinalize());
  return test_report();
}
