/*
  Beams attached to rigid bodies: momenta of body and beam together in free flight, also where the beam outweighs the body by far,
  pendulums against Lagrange's equations of rigid ones, a clamp that moves as prescribed, states, and wrong attachments.
*/
#include "couple.h"
#include "testerror.h"

#define TOLERANCE 1e-8 /* default of couple_attach_tolerance */

typedef struct {
  Ancf ancf;
  Rigid rigid;
  CoupleAttach attach;
} Pair;

static PetscErrorCode Beam(PetscReal x, PetscReal length, PetscReal young, AncfBeamSpec *s)
{
  PetscFunctionBegin;
  PetscCall(AncfBeamSpecInit(s));
  s->start[0] = x;
  s->end[0] = x + length;
  s->elements = 4;
  s->diameter = 0.04;
  s->density = 7200;
  s->young = young;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Box(PetscReal x, PetscReal mass, RigidBodySpec *s)
{
  PetscFunctionBegin;
  PetscCall(RigidBodySpecInit(s));
  s->shape = RIGID_BOX;
  s->size[0] = 0.2, s->size[1] = 0.1, s->size[2] = 0.15;
  s->position[0] = x;
  s->density = mass / (0.2 * 0.1 * 0.15);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Beams and bodies set up; node[k] of beam 0 attached to body k. */
static PetscErrorCode PairCreate(const AncfBeamSpec *s, PetscInt nbodies, const RigidBodySpec *bodies, const PetscInt node[],
                                 AncfEnd how, PetscReal gz, const char options[], Pair *p)
{
  const PetscReal g[3] = {0, 0, gz};
  PetscOptions o;

  PetscFunctionBegin;
  PetscCall(AncfCreate(PETSC_COMM_SELF, &p->ancf));
  PetscCall(AncfAddBeam(p->ancf, s, NULL));
  for (PetscInt k = 0; k < nbodies; k++) PetscCall(AncfFixNode(p->ancf, 0, node[k], how));
  PetscCall(AncfSetGravity(p->ancf, g));
  PetscCall(PetscOptionsCreate(&o));
  PetscCall(PetscOptionsInsertString(o, options));
  PetscCall(PetscOptionsPush(o));
  PetscCall(AncfSetFromOptions(p->ancf));
  PetscCall(AncfSetUp(p->ancf));
  PetscCall(PetscOptionsPop());
  PetscCall(PetscOptionsDestroy(&o));
  PetscCall(RigidCreate(PETSC_COMM_SELF, &p->rigid));
  PetscCall(RigidSetGravity(p->rigid, g));
  for (PetscInt k = 0; k < nbodies; k++) PetscCall(RigidAddBody(p->rigid, &bodies[k], NULL));
  PetscCall(RigidSetUp(p->rigid));
  PetscCall(CoupleAttachCreate(PETSC_COMM_SELF, p->ancf, p->rigid, &p->attach));
  for (PetscInt k = 0; k < nbodies; k++) PetscCall(CoupleAttachAdd(p->attach, 0, node[k], k));
  PetscCall(CoupleAttachSetUp(p->attach));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PairDestroy(Pair *p)
{
  PetscFunctionBegin;
  PetscCall(CoupleAttachDestroy(&p->attach));
  PetscCall(AncfDestroy(&p->ancf));
  PetscCall(RigidDestroy(&p->rigid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Momenta(const Pair *p, PetscReal P[3], PetscReal L[3], PetscReal *E)
{
  PetscReal q[3], H[3], k, u, kb;

  PetscFunctionBegin;
  PetscCall(AncfGetMomentum(p->ancf, P, L));
  PetscCall(RigidGetMomentum(p->rigid, q, H));
  for (int c = 0; c < 3; c++) P[c] += q[c], L[c] += H[c];
  PetscCall(AncfGetEnergy(p->ancf, &k, &u, NULL));
  PetscCall(RigidGetEnergy(p->rigid, &kb, NULL));
  *E = k + u + kb;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rotation w about the origin and the velocity V for beam and bodies. */
static PetscErrorCode Spin(Pair *p, const PetscReal V[3], const PetscReal w[3], PetscInt nbodies)
{
  const PetscReal *e;
  PetscReal x[30], v[30], X[3], U[3];

  PetscFunctionBegin;
  PetscCall(AncfGetState(p->ancf, NULL, &e, NULL, NULL));
  for (int i = 0; i < 30; i++) x[i] = e[i];
  for (int i = 0; i < 30; i++)
    v[i] = (i % 6 < 3 ? V[i % 3] : 0) + w[(i + 1) % 3] * x[i - i % 3 + (i + 2) % 3] - w[(i + 2) % 3] * x[i - i % 3 + (i + 1) % 3];
  PetscCall(AncfSetState(p->ancf, 0, x, v));
  for (PetscInt k = 0; k < nbodies; k++) {
    PetscCall(RigidGetState(p->rigid, k, X, NULL, NULL, NULL));
    for (int c = 0; c < 3; c++) U[c] = V[c] + w[(c + 1) % 3] * X[(c + 2) % 3] - w[(c + 2) % 3] * X[(c + 1) % 3];
    PetscCall(RigidSetState(p->rigid, k, NULL, NULL, U, w));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Free flight, spinning. In each step the bodies move under wrenches that are off by TOLERANCE at most: the linear momentum
  drifts by less than that times the impulses exchanged, and that of clamped beams about the origin by the same times the
  largest lever, here 2 m. A ball joint hands on no moment, so that the beam's own error stays: its lever and force follow from
  trapezoidal sums, dt^2/12 of [d(xF)/dt]; the force rings with the first axial mode Ω = pi/2 c/L around its mean w^2 m L/2 (the
  beam starts unstrained), x F < 2 m * 2 mean. Energy: alpha2 of radius 1 and the bodies' steps keep it to the same order, the
  elastic part that rings being 3 eps of all, eps = rho/E w^2 L^2, to (dt Omega)^2 with four modes.
*/
static PetscErrorCode TestFlight(PetscInt nbodies, AncfEnd how, PetscReal mass, const char options[], PetscReal dt)
{
  const PetscInt node[2] = {0, 4};
  const PetscReal V[3] = {0.3, -0.2, 0.1}, w[3] = {1, -2, 3}, spin = PetscSqrtReal(14);
  PetscReal P0[3], L0[3], E0, P[3], L[3], E, F[3], M[3], impulse = 0, dP = 0, dL = 0, bound, Omega;
  const PetscReal tol = TOLERANCE * (1 + 9.05 / mass);
  AncfBeamSpec s;
  RigidBodySpec box[2];
  PetscInt n;
  Pair p;

  PetscFunctionBegin;
  PetscCall(Beam(0.1, 1, 20e6, &s));
  PetscCall(Box(0, mass, &box[0]));
  PetscCall(Box(1.2, 2 * mass, &box[1]));
  PetscCall(PairCreate(&s, nbodies, box, node, how, 0, options, &p));
  PetscCall(Spin(&p, V, w, nbodies));
  PetscCall(Momenta(&p, P0, L0, &E0));
  for (int i = 1; i * dt <= 0.1 + 1e-9; i++) {
    PetscCall(CoupleAttachAdvance(p.attach, i * dt));
    for (PetscInt k = 0; k < nbodies; k++) {
      PetscCall(CoupleAttachGetForce(p.attach, k, F, M));
      for (int c = 0; c < 3; c++) impulse += dt * (PetscAbsReal(F[c]) + PetscAbsReal(M[c]) / 0.05);
    }
  }
  PetscCall(Momenta(&p, P, L, &E));
  for (int c = 0; c < 3; c++) dP = PetscMax(dP, PetscAbsReal(P[c] - P0[c])), dL = PetscMax(dL, PetscAbsReal(L[c] - L0[c]));
  PetscCall(CoupleAttachGetIterations(p.attach, &n));
  Omega = PETSC_PI / 2 * PetscSqrtReal(s.young / s.density);
  bound = dt * dt / 12 * 2 * 2 * 2 * spin * spin * 9.05 / 2 * Omega;
  printf("%-26s %d bodies of %g kg, %s, dt %.0e: momentum off by %.1e of %.1e kg m/s, angular %.1e of %.1e, energy %.1e, %.1f "
         "iterations a step\n",
         options, (int)nbodies, (double)mass, how == ANCF_END_CLAMP ? "clamp" : "ball", (double)dt, (double)dP, (double)impulse,
         (double)dL, (double)(how == ANCF_END_CLAMP ? 2 * impulse : bound), (double)(PetscAbsReal(E - E0) / E0),
         (double)n / (0.1 / (double)dt));
  TEST_NEAR(dP, 0, tol * impulse, "linear momentum");
  TEST_NEAR(dL, 0, how == ANCF_END_CLAMP ? 2 * tol * impulse : bound, "angular momentum");
  TEST_NEAR(E, E0, E0 * 3 * s.density / s.young * 14 * 4 * PetscSqr(dt * Omega), "energy");
  PetscCall(PairDestroy(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rod of mass m, length l from the ground; at its end a body (M, J about its centre, at d from the joint); angles from below. */
typedef struct {
  double m, l, M, J, d, g;
  int rigid; /* joint locked */
} Double;

static void Rate(const Double *p, const double y[4], double r[4])
{
  const double c = cos(y[0] - y[1]), s = sin(y[0] - y[1]);
  const double a = (p->m / 3 + p->M) * p->l * p->l, b = p->M * p->l * p->d * c, e = p->J + p->M * p->d * p->d;
  const double u = -p->M * p->l * p->d * s * y[3] * y[3] - (p->m / 2 + p->M) * p->g * p->l * sin(y[0]);
  const double v = p->M * p->l * p->d * s * y[2] * y[2] - p->M * p->g * p->d * sin(y[1]);
  const double det = a * e - b * b;

  r[0] = y[2], r[1] = y[3];
  r[2] = p->rigid ? (u + v) / (a + 2 * b + e) : (e * u - b * v) / det;
  r[3] = p->rigid ? r[2] : (a * v - b * u) / det;
}

static void Swing(const Double *p, double y[4], double t, int n)
{
  const double h = t / n;

  for (int i = 0; i < n; i++) {
    double k[4][4], z[4];

    Rate(p, y, k[0]);
    for (int s = 1; s < 4; s++) {
      for (int c = 0; c < 4; c++) z[c] = y[c] + (s == 3 ? h : h / 2) * k[s - 1][c];
      Rate(p, z, k[s]);
    }
    for (int c = 0; c < 4; c++) y[c] += h / 6 * (k[0][c] + 2 * k[1][c] + 2 * k[2][c] + k[3][c]);
  }
}

/*
  A body on a stiff beam that is pinned to the ground, from 90 degrees. The beam's compliance: the body's weight and inertia, some
  3 M g at the bottom, stretch it by 3 M g l/EA and bend it by (M g) l^3/(3 EI); both are below 1e-5 m here, and so is the
  integrators' (dt w)^2 times some 1 of the motion, w = 5 rad/s.
*/
static PetscErrorCode TestPendulum(AncfEnd how)
{
  const PetscInt node = 4;
  const PetscReal dt = 5e-4, T = 0.5;
  PetscReal X[3];
  AncfBeamSpec s;
  RigidBodySpec box;
  Double d = {.l = 0.5, .d = 0.1, .g = 9.81, .rigid = how == ANCF_END_CLAMP};
  double y[4] = {PETSC_PI / 2, PETSC_PI / 2, 0, 0};
  Pair p;

  PetscFunctionBegin;
  PetscCall(Beam(0, 0.5, 2e11, &s));
  s.end0 = ANCF_END_PIN;
  PetscCall(Box(0.6, 3, &box));
  PetscCall(PairCreate(&s, 1, &box, &node, how, -9.81, "", &p));
  for (int i = 1; i * dt <= T + 1e-9; i++) PetscCall(CoupleAttachAdvance(p.attach, i * dt));
  d.m = 7200 * PETSC_PI / 4 * 0.04 * 0.04 * 0.5;
  d.M = 3;
  d.J = 3 * (0.2 * 0.2 + 0.15 * 0.15) / 12; /* about y */
  Swing(&d, y, T, 5000);
  PetscCall(RigidGetState(p.rigid, 0, X, NULL, NULL, NULL));
  printf("pendulum, %s: body at %.6f, %.6f m, rigid %.6f, %.6f\n", how == ANCF_END_CLAMP ? "clamp" : "ball", (double)X[0],
         (double)X[2], d.l * sin(y[0]) + d.d * sin(y[1]), -d.l * cos(y[0]) - d.d * cos(y[1]));
  TEST_NEAR(X[0], d.l * sin(y[0]) + d.d * sin(y[1]), 3e-5, "body x");
  TEST_NEAR(X[2], -d.l * cos(y[0]) - d.d * cos(y[1]), 3e-5, "body z");
  PetscCall(PairDestroy(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A body that moves as prescribed carries the clamp along: at the end of a step they part by dt^3/12 of the jerk, some w^3 R. */
static PetscErrorCode TestPrescribed(void)
{
  const PetscInt node = 0;
  const PetscReal dt = 1e-3;
  PetscReal X[3], q[4], R[9], V[3], w[3], r = 0, speed = 0;
  const PetscReal *e, *v;
  AncfBeamSpec s;
  RigidBodySpec box;
  Pair p;

  PetscFunctionBegin;
  PetscCall(Beam(0.1, 1, 20e6, &s));
  PetscCall(Box(0, 3, &box));
  box.motion = RIGID_PRESCRIBED;
  box.velocity[1] = 0.5;
  box.omega[2] = 4;
  PetscCall(PairCreate(&s, 1, &box, &node, ANCF_END_CLAMP, 0, "", &p));
  for (int i = 1; i <= 50; i++) {
    PetscCall(CoupleAttachAdvance(p.attach, i * dt));
    PetscCall(AncfGetState(p.ancf, NULL, &e, &v, NULL));
    PetscCall(RigidGetState(p.rigid, 0, X, q, V, w));
    RigidRotationMatrix(q, R);
    for (int c = 0; c < 3; c++) {
      const PetscReal point = V[c] + (c == 0 ? -w[2] * R[3] * 0.1 : c == 1 ? w[2] * R[0] * 0.1 : 0);

      r = PetscMax(r, PetscAbsReal(e[c] - X[c] - R[3 * c] * 0.1));
      r = PetscMax(r, PetscAbsReal(e[3 + c] - R[3 * c]));
      speed = PetscMax(speed, PetscAbsReal(v[c] - point));
    }
  }
  printf("prescribed clamp: node off its body by %.1e, velocity by %.1e\n", (double)r, (double)speed);
  TEST_NEAR(r, 0, PetscSqr(dt) * dt / 12 * 64, "node and gradient on the body");
  TEST_NEAR(speed, 0, 1e-13, "velocity of the node");
  TEST(PetscAbsReal(e[1] - 0.025 - 0.1 * PetscSinReal(0.2)) < 1e-6, "the node has moved to y = %g m", (double)e[1]);
  PetscCall(PairDestroy(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Move(Pair *p, FrondState *s)
{
  PetscFunctionBegin;
  PetscCall(AncfMoveState(p->ancf, s));
  PetscCall(RigidMoveState(p->rigid, s));
  PetscCall(CoupleAttachMoveState(p->attach, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Saved, gone on, put back and gone on again: the same bits. */
static PetscErrorCode TestState(void)
{
  const PetscInt node = 0;
  const PetscReal V[3] = {0.3, -0.2, 0.1}, w[3] = {1, -2, 3};
  PetscReal P[2][3], L[2][3], E[2];
  AncfBeamSpec s;
  RigidBodySpec box;
  FrondStateBuffer count = FrondStateBufferMake(FROND_STATE_COUNT, 0, NULL), save, load;
  void *x;
  Pair p;

  PetscFunctionBegin;
  PetscCall(Beam(0.1, 1, 20e6, &s));
  PetscCall(Box(0, 2, &box));
  PetscCall(PairCreate(&s, 1, &box, &node, ANCF_END_CLAMP, -9.81, "", &p));
  PetscCall(Spin(&p, V, w, 1));
  for (int i = 1; i <= 10; i++) PetscCall(CoupleAttachAdvance(p.attach, i * 1e-3));
  PetscCall(Move(&p, &count.state));
  PetscCall(PetscMalloc(count.at, &x));
  save = FrondStateBufferMake(FROND_STATE_SAVE, count.at, x);
  PetscCall(Move(&p, &save.state));
  for (int run = 0; run < 2; run++) {
    if (run) {
      load = FrondStateBufferMake(FROND_STATE_LOAD, count.at, x);
      PetscCall(Move(&p, &load.state));
    }
    for (int i = 11; i <= 20; i++) PetscCall(CoupleAttachAdvance(p.attach, i * 1e-3));
    PetscCall(Momenta(&p, P[run], L[run], &E[run]));
  }
  for (int c = 0; c < 3; c++) TEST(P[0][c] == P[1][c] && L[0][c] == L[1][c], "momenta of the run from a state differ");
  TEST(E[0] == E[1], "energy of the run from a state differs by %g", (double)(E[1] - E[0]));
  PetscCall(PetscFree(x));
  PetscCall(PairDestroy(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestBadInput(void)
{
  const PetscInt node = 0;
  AncfBeamSpec s;
  RigidBodySpec box[2];
  CoupleAttach l;
  Pair p;

  PetscFunctionBegin;
  PetscCall(Beam(0.1, 1, 20e6, &s));
  PetscCall(Box(0, 2, &box[0]));
  s.end1 = ANCF_END_PIN;
  PetscCall(PairCreate(&s, 1, box, &node, ANCF_END_CLAMP, 0, "", &p));
  PetscCall(CoupleAttachCreate(PETSC_COMM_SELF, p.ancf, p.rigid, &l));
  TEST_REFUSED(CoupleAttachAdd(l, 1, 0, 0), "no beam 1");
  TEST_REFUSED(CoupleAttachAdd(l, 0, 5, 0), "no beam 0 with a node 5");
  TEST_REFUSED(CoupleAttachAdd(l, 0, 0, 1), "body 1 must be in 0..0");
  TEST_REFUSED(CoupleAttachAdd(l, 0, 1, 0), "node 1 of beam 0 has no support");
  TEST_REFUSED(CoupleAttachAdd(l, 0, 4, 0), "m outside of body 0");
  PetscCall(CoupleAttachAdd(l, 0, 0, 0));
  TEST_REFUSED(CoupleAttachAdd(l, 0, 0, 0), "attached to body 0 already");
  TEST_REFUSED(CoupleAttachAdvance(l, 1), "CoupleAttachSetUp()");
  TEST_REFUSED(CoupleAttachSetIterations(l, 0, 1e-6), "couple_attach_iterations = 0");
  TEST_REFUSED(CoupleAttachSetIterations(l, 5, 2), "couple_attach_tolerance = 2");
  PetscCall(CoupleAttachSetIterations(l, 1, 1e-14));
  PetscCall(CoupleAttachSetUp(l));
  TEST_REFUSED(CoupleAttachAdd(l, 0, 4, 0), "after CoupleAttachSetUp()");
  TEST_REFUSED(CoupleAttachAdvance(l, 0), "cannot go to 0");
  {
    const PetscReal F[3] = {0, 0, 1};

    PetscCall(RigidAddLoad(p.rigid, 0, F, NULL));
    TEST_REFUSED(CoupleAttachAdvance(l, 1e-3), "did not converge at t = 0.001 s");
  }
  PetscCall(CoupleAttachDestroy(&l));
  PetscCall(PairDestroy(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lubrication and repulsion within 10 mm; with the attachment made known or not. */
static PetscErrorCode MakeShort(const Pair *p, PetscBool known, CoupleShort *sr)
{
  ShortRange range;

  PetscFunctionBegin;
  PetscCall(ShortRangeInit(&range));
  range.viscosity = 2;
  range.cutoff = 0.01;
  range.roughness = 2e-3;
  range.modulus = 1e8;
  PetscCall(CoupleShortCreate(PETSC_COMM_SELF, p->ancf, p->rigid, sr));
  PetscCall(CoupleShortSetParameters(*sr, &range));
  if (known) PetscCall(CoupleShortSetAttach(*sr, p->attach));
  PetscCall(CoupleShortSetUp(*sr));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One step with short-range forces, as couplings and the frond command make it. */
static PetscErrorCode ShortStep(const Pair *p, CoupleShort sr, PetscReal t, PetscReal dt, PetscInt *contacts, PetscReal *gap)
{
  PetscFunctionBegin;
  PetscCall(AncfZeroLoads(p->ancf));
  PetscCall(CoupleShortApply(sr, dt));
  PetscCall(CoupleShortGetForces(sr, contacts, gap, NULL, NULL));
  PetscCall(CoupleAttachAdvance(p->attach, t));
  PetscCall(CoupleShortRemove(sr));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Short-range forces leave a beam and its body alone at the attachment: a spinning pair has the bits of one without such forces,
  while it would feel them from the first step if the attachment were not known. A body in front of the beam's other end is felt.
*/
static PetscErrorCode TestShortAlone(void)
{
  const PetscInt node = 0;
  const PetscReal V[3] = {0.3, -0.2, 0.1}, w[3] = {1, -2, 3}, *e;
  PetscReal x[2][30];
  PetscInt contacts = -1, most = 0;
  AncfBeamSpec s;
  RigidBodySpec box[2];
  CoupleShort sr;
  Pair p;

  PetscFunctionBegin;
  PetscCall(Beam(0.1, 1, 20e6, &s));
  PetscCall(Box(0, 2, &box[0]));
  PetscCall(Box(1.1 + 0.005 + 0.1, 2, &box[1]));
  for (int with = 0; with < 2; with++) {
    PetscCall(PairCreate(&s, 1, box, &node, ANCF_END_CLAMP, 0, "", &p));
    PetscCall(Spin(&p, V, w, 1));
    if (with) PetscCall(MakeShort(&p, PETSC_TRUE, &sr));
    for (int i = 1; i <= 50; i++) {
      if (with)
        PetscCall(ShortStep(&p, sr, 1e-3 * i, 1e-3, &contacts, NULL));
      else
        PetscCall(CoupleAttachAdvance(p.attach, 1e-3 * i));
      most = PetscMax(most, contacts);
    }
    PetscCall(AncfGetState(p.ancf, NULL, &e, NULL, NULL));
    PetscCall(PetscArraycpy(x[with], e, 30));
    if (with) PetscCall(CoupleShortDestroy(&sr));
    PetscCall(PairDestroy(&p));
  }
  TEST(most == 0, "%d contacts at the attachment", (int)most);
  for (int i = 0; i < 30; i++) TEST(x[0][i] == x[1][i], "bits of the motion, coordinate %d", i);
  for (int known = 0; known < 2; known++) {
    PetscCall(PairCreate(&s, 1, box, &node, ANCF_END_CLAMP, 0, "", &p));
    PetscCall(MakeShort(&p, (PetscBool)known, &sr));
    PetscCall(CoupleShortApply(sr, 1e-3));
    PetscCall(CoupleShortGetForces(sr, &contacts, NULL, NULL, NULL));
    TEST(known ? contacts == 0 : contacts > 0, "%d contacts, attachment %sknown", (int)contacts, known ? "" : "not ");
    PetscCall(CoupleShortDestroy(&sr));
    PetscCall(PairDestroy(&p));
  }
  { /* node 0 on the first body, the other one free and near the end of the beam */
    PetscReal f[3];

    PetscCall(PairCreate(&s, 1, box, &node, ANCF_END_CLAMP, 0, "", &p));
    PetscCall(RigidDestroy(&p.rigid));
    PetscCall(CoupleAttachDestroy(&p.attach));
    PetscCall(RigidCreate(PETSC_COMM_SELF, &p.rigid));
    for (int k = 0; k < 2; k++) PetscCall(RigidAddBody(p.rigid, &box[k], NULL));
    PetscCall(RigidSetUp(p.rigid));
    PetscCall(CoupleAttachCreate(PETSC_COMM_SELF, p.ancf, p.rigid, &p.attach));
    PetscCall(CoupleAttachAdd(p.attach, 0, 0, 0));
    PetscCall(CoupleAttachSetUp(p.attach));
    PetscCall(RigidSetState(p.rigid, 1, NULL, NULL, (PetscReal[3]){-1, 0, 0}, NULL));
    PetscCall(MakeShort(&p, PETSC_TRUE, &sr));
    PetscCall(CoupleShortApply(sr, 1e-3));
    PetscCall(CoupleShortGetForces(sr, &contacts, NULL, NULL, f));
    TEST(contacts > 0 && f[0] > 0, "the body at the free end is felt: %d contacts, %g N", (int)contacts, (double)f[0]);
    PetscCall(CoupleShortDestroy(&sr));
    PetscCall(PairDestroy(&p));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  A free beam, crosswise and 8 mm above the attached one, meets it at 2 m/s: the impulse goes through beam and body. Linear
  momentum: to the tolerance of the attachment's forces, as in TestFlight(), times the impulses exchanged. Angular momentum: the
  force F of a step acts at the places predicted for its middle; they are off by F/m h^2/8, m being the mass of the stretch in
  touch, a diameter of each beam at least; the attached clamp adds what it does there. alpha2 of a radius below 1 hands a constant
  load on over some steps, and the attachment, which has the load at once, is ahead of the free beam by what is under way: F dt at
  most.
*/
static PetscErrorCode TestShortMeeting(PetscReal mass, const char options[])
{
  const PetscInt node = 0;
  const PetscReal dt = 2e-4, tol = TOLERANCE * (1 + 18.1 / mass);
  PetscReal P0[3], L0[3], E0, P[3], L[3], E, F[3], M[3], impulse = 0, bound = 0, last, gap, least = PETSC_INFINITY, v[60], f = 0;
  PetscReal dP = 0, dL = 0, m[6], l[6], q[6], T[6];
  PetscReal under = 0;
  PetscInt contacts, most = 0;
  const PetscReal *e;
  PetscOptions o;
  AncfBeamSpec s, other;
  RigidBodySpec box;
  CoupleShort sr;
  Pair p;

  PetscFunctionBegin;
  PetscCall(Beam(0.1, 1, 20e6, &s));
  PetscCall(Box(0, mass, &box));
  PetscCall(Beam(0, 1, 20e6, &other));
  for (int c = 0; c < 2; c++) {
    PetscReal *x = c ? other.end : other.start;

    x[0] = 0.7, x[1] = c ? 0.5 : -0.5, x[2] = 0.048;
  }
  PetscCall(PetscMemzero(&p, sizeof(p)));
  PetscCall(AncfCreate(PETSC_COMM_SELF, &p.ancf));
  PetscCall(AncfAddBeam(p.ancf, &s, NULL));
  PetscCall(AncfAddBeam(p.ancf, &other, NULL));
  PetscCall(AncfFixNode(p.ancf, 0, node, ANCF_END_CLAMP));
  PetscCall(PetscOptionsCreate(&o));
  PetscCall(PetscOptionsInsertString(o, options));
  PetscCall(PetscOptionsPush(o));
  PetscCall(AncfSetFromOptions(p.ancf));
  PetscCall(AncfSetUp(p.ancf));
  PetscCall(PetscOptionsPop());
  PetscCall(PetscOptionsDestroy(&o));
  PetscCall(RigidCreate(PETSC_COMM_SELF, &p.rigid));
  PetscCall(RigidAddBody(p.rigid, &box, NULL));
  PetscCall(RigidSetUp(p.rigid));
  PetscCall(CoupleAttachCreate(PETSC_COMM_SELF, p.ancf, p.rigid, &p.attach));
  PetscCall(CoupleAttachAdd(p.attach, 0, node, 0));
  PetscCall(CoupleAttachSetUp(p.attach));
  PetscCall(AncfGetState(p.ancf, NULL, &e, NULL, NULL));
  for (int i = 0; i < 60; i++) v[i] = i >= 30 && i % 6 == 2 ? -2 : 0;
  PetscCall(AncfSetState(p.ancf, 0, e, v));
  PetscCall(MakeShort(&p, PETSC_TRUE, &sr));
  PetscCall(Momenta(&p, P0, L0, &E0));
  PetscCall(AncfGetBeamBalances(p.ancf, m, l, q, T));
  last = m[5];
  for (int i = 1; i <= 200; i++) {
    PetscCall(ShortStep(&p, sr, i * dt, dt, &contacts, &gap));
    most = PetscMax(most, contacts);
    least = PetscMin(least, gap);
    PetscCall(AncfGetBeamBalances(p.ancf, m, l, q, T));
    f = PetscAbsReal(m[5] - last) / dt;
    last = m[5];
    if (!options[0]) under = PetscMax(under, f * dt);
    bound += dt * f * f * dt * dt / 8 / (7200 * PETSC_PI * 4e-4 * 0.04);
    PetscCall(CoupleAttachGetForce(p.attach, 0, F, M));
    for (int c = 0; c < 3; c++) impulse += dt * (PetscAbsReal(F[c]) + PetscAbsReal(M[c]) / 0.05);
  }
  PetscCall(Momenta(&p, P, L, &E));
  for (int c = 0; c < 3; c++) dP = PetscMax(dP, PetscAbsReal(P[c] - P0[c])), dL = PetscMax(dL, PetscAbsReal(L[c] - L0[c]));
  printf(
      "meeting beams, body of %g kg: %d contacts, gap down to %g m, momentum given %g, off by %.1e kg m/s, angular %.1e of %.1e, "
      "energy %g of %g J\n",
      (double)mass, (int)most, (double)least, (double)(last - -2 * 9.05), (double)dP, (double)dL, (double)bound, (double)E,
      (double)E0);
  TEST(most > 0 && least > -0.004, "they touch, and overlap by less than a tenth of a diameter: %g m", (double)least);
  TEST(last - -2 * 9.05 > 1, "momentum is exchanged");
  TEST_NEAR(dP, 0, tol * impulse + under, "linear momentum");
  TEST_NEAR(dL, 0, bound + 2 * tol * impulse + under, "angular momentum");
  TEST(E <= E0 * (1 + 1e-3), "no energy from nowhere: %g of %g J", (double)E, (double)E0);
  PetscCall(CoupleShortDestroy(&sr));
  PetscCall(PairDestroy(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  for (int how = ANCF_END_PIN; how <= ANCF_END_CLAMP; how++) {
    PetscCall(TestFlight(1, (AncfEnd)how, 5, "-ancf_ts_alpha_radius 1", 1e-3));
    PetscCall(TestFlight(1, (AncfEnd)how, 5, "", 1e-3));
    PetscCall(TestFlight(1, (AncfEnd)how, 5, "-ancf_ts_alpha_radius 1", 5e-4));
    PetscCall(TestFlight(1, (AncfEnd)how, 0.5, "", 1e-3));
    PetscCall(TestFlight(1, (AncfEnd)how, 0.2, "-ancf_ts_alpha_radius 1", 1e-3));
    PetscCall(TestFlight(2, (AncfEnd)how, 2, "", 1e-3));
    PetscCall(TestFlight(1, (AncfEnd)how, 5, "-ancf_ts_type theta", 1e-3));
    PetscCall(TestFlight(1, (AncfEnd)how, 5, "-ancf_constraints multipliers", 1e-3));
    PetscCall(TestPendulum((AncfEnd)how));
  }
  PetscCall(TestPrescribed());
  PetscCall(TestShortAlone());
  PetscCall(TestShortMeeting(5, "-ancf_ts_alpha_radius 1"));
  PetscCall(TestShortMeeting(0.5, "-ancf_ts_alpha_radius 1"));
  PetscCall(TestShortMeeting(5, ""));
  PetscCall(TestState());
  PetscCall(TestBadInput());
  PetscCall(PetscFinalize());
  return test_report();
}
