/*
  test_couple_short.c - short-range forces of beams: lubrication of crossing cylinders against Reynolds' equation, repulsion
  against Hertz, conservation of both momenta, smoothness at the cutoff, what a beam feels of itself, beams that cross, fall on
  a wall and on a ball without passing through, the cell grid against all pairs, determinism, refusals.
*/
#include "couple.h"
#include "testerror.h"
#include <string.h>

static const char help[] = "Short-range forces of beams.\n";

/* A beam of radius .02 m, free at both ends. */
static PetscErrorCode AddBeam(Ancf ancf, const PetscReal start[3], const PetscReal end[3], PetscInt elements, PetscReal young)
{
  AncfBeamSpec spec;

  PetscFunctionBegin;
  PetscCall(AncfBeamSpecInit(&spec));
  for (int k = 0; k < 3; k++) spec.start[k] = start[k], spec.end[k] = end[k];
  spec.elements = elements;
  spec.diameter = .04;
  spec.density = 1000.;
  spec.young = young;
  PetscCall(AncfAddBeam(ancf, &spec, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two beams 1 m long that cross in the middle at the angle phi, a gap apart along z; the upper one has the velocity v. */
static PetscErrorCode Cross(PetscReal phi, PetscReal gap, PetscReal v, PetscReal young, Ancf *ancf)
{
  const PetscReal a0[3] = {-.5, 0., 0.}, a1[3] = {.5, 0., 0.}, z = .04 + gap, c = .5 * cos(phi), s = .5 * sin(phi);
  const PetscReal b0[3] = {-c, -s, z}, b1[3] = {c, s, z};
  const PetscReal *e, *ed;
  PetscReal *w;

  PetscFunctionBegin;
  PetscCall(AncfCreate(PETSC_COMM_SELF, ancf));
  PetscCall(AddBeam(*ancf, a0, a1, 8, young));
  PetscCall(AddBeam(*ancf, b0, b1, 8, young));
  PetscCall(AncfSetUp(*ancf));
  PetscCall(AncfGetState(*ancf, NULL, &e, &ed, NULL));
  PetscCall(PetscCalloc1(6 * 18, &w));
  for (PetscInt i = 9; i < 18; i++) w[6 * i + 2] = v;
  PetscCall(AncfSetState(*ancf, 0., e, w));
  PetscCall(PetscFree(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MakeShort(Ancf ancf, Rigid rigid, const ShortRange *p, PetscInt samples, CoupleShort *sr)
{
  PetscFunctionBegin;
  PetscCall(CoupleShortCreate(PETSC_COMM_SELF, ancf, rigid, sr));
  PetscCall(CoupleShortSetParameters(*sr, p));
  PetscCall(CoupleShortSetSamples(*sr, samples));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Force (N) on the nodes first .. last - 1 along z. */
static PetscErrorCode ForceZ(Ancf ancf, PetscInt first, PetscInt last, PetscReal *f)
{
  PetscReal *Q;

  PetscFunctionBegin;
  PetscCall(AncfGetLoads(ancf, &Q));
  *f = 0.;
  for (PetscInt i = first; i < last; i++) *f += Q[6 * i + 2];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Cylinders of radius a at an angle phi: 6 pi mu a^2 v/(s sin phi) to leading order (Reynolds' equation for the gap s + x^2/2Rx
  + y^2/2Ry, p ~ 1/gap^2). What the cutoff takes off is known in closed form.
*/
static PetscErrorCode TestCrossing(void)
{
  const PetscReal a = .02, mu = 2., s = 2e-4, v = 1e-3;
  ShortRange p;
  CoupleShort sr;
  Ancf ancf;

  PetscFunctionBegin;
  PetscCall(ShortRangeInit(&p));
  p.viscosity = mu, p.cutoff = .5 * a, p.roughness = 1e-6, p.kink = PETSC_TRUE;
  for (PetscReal deg = 30.; deg < 91.; deg += 30.) {
    const PetscReal phi = deg * PETSC_PI / 180., lead = 6. * PETSC_PI * mu * a * a * v / (s * sin(phi));
    PetscReal f, tail, gap, t;
    PetscCall(Cross(phi, s, -v, 1e6, &ancf));
    PetscCall(MakeShort(ancf, NULL, &p, 64, &sr));
    PetscCall(CoupleShortSetUp(sr));
    PetscCall(CoupleShortApply(sr, 1e-9));
    PetscCall(ForceZ(ancf, 9, 18, &f));
    PetscCall(CoupleShortGetForces(sr, NULL, &gap, NULL, NULL));
    /* share of (s + q t^2)^(-3/2) at |t| > T, and of Dc^(-3/2) at |t| < T, in the integral 2/(s sqrt(q)) */
    const PetscReal q = sin(phi) * sin(phi) / (4. * a), T = sqrt((p.cutoff - s) / q);
    tail = 1. - T / sqrt(T * T + s / q) + T * s * sqrt(q) / pow(p.cutoff, 1.5);
    t = f / (lead * (1. - tail));
    printf("crossing at %.0f degrees: %.6f N, Reynolds %.6f N, with the cutoff %.6f: ratio %.5f\n", deg, f, lead,
           lead * (1. - tail), t);
    /* next order: tilt of the normals, n_z^2 = 1 - t^2/4a^2, under the kernel's tail (s/a) ln(Dc/s), and s/a from its width */
    TEST_NEAR(t, 1., s / a * (1. + log(p.cutoff / s)), "lubrication of crossing cylinders");
    TEST_NEAR(gap, s, 1.05 * a / 16384., "smallest gap"); /* samples a/32 apart: (a/64)^2/4a above it */
    PetscCall(CoupleShortDestroy(&sr));
    PetscCall(AncfDestroy(&ancf));
  }
  /* Hertz at right angles, 4/3 E sqrt(a) d^1.5; the sum over samples is off by (step/width)^2, width = sqrt(4 a d) */
  PetscCall(ShortRangeInit(&p));
  p.roughness = .04 * a, p.modulus = 1e5;
  const PetscReal d = .03 * a, hertz = 4. / 3. * p.modulus * sqrt(a) * pow(d, 1.5);
  PetscReal f;
  PetscCall(Cross(.5 * PETSC_PI, p.roughness - d, 0., 1e6, &ancf));
  PetscCall(MakeShort(ancf, NULL, &p, 64, &sr));
  PetscCall(CoupleShortSetUp(sr));
  PetscCall(CoupleShortApply(sr, 1e-9));
  PetscCall(ForceZ(ancf, 9, 18, &f));
  printf("repulsion at right angles: %.5f N, Hertz %.5f N\n", f, hertz);
  TEST_REL(f, hertz, a / 32. * a / 32. / (4. * a * d) + .01 * d / a, "Hertz");
  PetscCall(CoupleShortDestroy(&sr));
  PetscCall(AncfDestroy(&ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A random state of two bent beams, a box and a ball in between: forces and moments about the origin cancel to round-off. */
static PetscErrorCode TestConservation(PetscBool again, PetscReal *sum)
{
  const PetscReal a0[3] = {-.5, 0., 0.}, a1[3] = {.5, 0., 0.}, b0[3] = {-.3, -.4, .052}, b1[3] = {.4, .3, .052};
  PetscReal F[3] = {0., 0., 0.}, M[3] = {0., 0., 0.}, size = 0., msize = 0., held[3], onbodies[3];
  const PetscReal *e, *ed;
  PetscReal *x, *v, *Q;
  PetscInt nn, contacts;
  RigidBodySpec spec;
  ShortRange p;
  PetscRandom rnd;
  CoupleShort sr;
  Rigid rigid;
  Ancf ancf;

  PetscFunctionBegin;
  PetscCall(PetscRandomCreate(PETSC_COMM_SELF, &rnd));
  PetscCall(PetscRandomSetSeed(rnd, 7));
  PetscCall(PetscRandomSeed(rnd));
  PetscCall(PetscRandomSetInterval(rnd, -1., 1.));
  PetscCall(ShortRangeInit(&p));
  p.viscosity = 3., p.cutoff = .02, p.roughness = .004, p.modulus = 1e5, p.restitution = .8;
  PetscCall(AncfCreate(PETSC_COMM_SELF, &ancf));
  PetscCall(AddBeam(ancf, a0, a1, 6, 1e6));
  PetscCall(AddBeam(ancf, b0, b1, 6, 1e6));
  PetscCall(AncfSetUp(ancf));
  PetscCall(RigidCreate(PETSC_COMM_SELF, &rigid));
  PetscCall(RigidBodySpecInit(&spec));
  spec.size[0] = .05;
  spec.position[0] = .3;
  spec.position[2] = -.08;
  spec.velocity[2] = .4;
  spec.omega[1] = 3.;
  PetscCall(RigidAddBody(rigid, &spec, NULL));
  spec.shape = RIGID_BOX;
  spec.size[0] = spec.size[1] = spec.size[2] = .1;
  spec.position[0] = -.3;
  spec.position[1] = .02;
  spec.axisangle[0] = 1., spec.axisangle[1] = .3, spec.axisangle[3] = .2;
  spec.position[2] = .09;
  PetscCall(RigidAddBody(rigid, &spec, NULL));
  PetscCall(RigidSetUp(rigid));
  PetscCall(MakeShort(ancf, rigid, &p, 8, &sr));
  PetscCall(CoupleShortSetUp(sr));
  PetscCall(AncfGetNumNodes(ancf, &nn));
  PetscCall(AncfGetState(ancf, NULL, &e, &ed, NULL));
  PetscCall(PetscMalloc2(6 * (size_t)nn, &x, 6 * (size_t)nn, &v));
  for (PetscInt i = 0; i < 6 * nn; i++) {
    PetscReal r;
    PetscCall(PetscRandomGetValueReal(rnd, &r));
    x[i] = e[i] + (i % 6 < 3 ? .002 : .02) * r;
    PetscCall(PetscRandomGetValueReal(rnd, &r));
    v[i] = r;
  }
  PetscCall(AncfSetState(ancf, 0., x, v));
  const PetscReal h = 1e-5;
  PetscCall(CoupleShortApply(sr, h));
  PetscCall(AncfGetLoads(ancf, &Q));
  for (PetscInt i = 0; i < 2 * nn; i++) {
    PetscReal r[3];
    const PetscReal *q = Q + 3 * i;
    for (int k = 0; k < 3; k++) r[k] = x[3 * i + k] + .5 * h * v[3 * i + k];
    for (int k = 0; k < 3; k++) {
      const int l = (k + 1) % 3, m = (k + 2) % 3;
      M[k] += r[l] * q[m] - r[m] * q[l];
      msize += fabs(r[l] * q[m]) + fabs(r[m] * q[l]);
      if (i % 2 == 0) F[k] += q[k];
      if (i % 2 == 0) size += fabs(q[k]);
    }
    if (sum) *sum += q[0] * (double)(i + 1) + q[1] - q[2] / 3.;
  }
  PetscCall(CoupleShortGetForces(sr, &contacts, NULL, held, onbodies));
  /* what the bodies got shows in their motion: momentum after a step without other forces */
  PetscReal p0[3], L0[3], p1[3], L1[3];
  PetscCall(RigidGetMomentum(rigid, p0, L0));
  PetscCall(RigidAdvance(rigid, h));
  PetscCall(CoupleShortRemove(sr));
  PetscCall(RigidGetMomentum(rigid, p1, L1));
  for (int k = 0; k < 3; k++) {
    /* round-off of the momenta (24 kg m/s at most) over h; the torque's arm moves with the body: m V x V = 0, X(t) x F is exact
       at the middle of the step for constant F, to F/m h^2 F */
    TEST_NEAR(F[k] + (p1[k] - p0[k]) / h, 0., 1e-14 * size + 100. * 1e-16 / h, "forces of beams and bodies");
    TEST_NEAR(M[k] + (L1[k] - L0[k]) / h, 0., 1e-13 * msize + 100. * 1e-16 / h, "moments of beams and bodies");
    TEST_NEAR(F[k] + onbodies[k], 0., 1e-14 * size, "reported force on the bodies");
    TEST_NEAR(held[k], 0., 0., "nothing is held");
  }
  TEST(contacts > 20 && size > .1, "nothing touched: %d contacts, %g N", (int)contacts, size);
  if (!again)
    printf("conservation: %d contacts, sum |F| %.3g N, total %.1e N, %.1e N m\n", (int)contacts, size, F[0] + onbodies[0],
           M[1] + (L1[1] - L0[1]) / h);
  PetscCall(PetscFree2(x, v));
  PetscCall(PetscRandomDestroy(&rnd));
  PetscCall(CoupleShortDestroy(&sr));
  PetscCall(RigidDestroy(&rigid));
  PetscCall(AncfDestroy(&ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The force goes to zero with zero slope at the cutoff: like (Dc - s)^2 sqrt(Dc - s), the root from the length within reach. */
static PetscErrorCode TestCutoff(void)
{
  PetscReal f[3];
  ShortRange p;

  PetscFunctionBegin;
  PetscCall(ShortRangeInit(&p));
  p.viscosity = 1., p.cutoff = .01, p.roughness = 1e-4;
  for (int i = 0; i < 3; i++) {
    CoupleShort sr;
    Ancf ancf;
    PetscCall(Cross(.5 * PETSC_PI, p.cutoff * (i == 2 ? 1. + 1e-9 : 1. - (i ? .005 : .02)), -1., 1e6, &ancf));
    PetscCall(MakeShort(ancf, NULL, &p, 64, &sr));
    PetscCall(CoupleShortSetUp(sr));
    PetscCall(CoupleShortApply(sr, 1e-12));
    PetscCall(ForceZ(ancf, 9, 18, &f[i]));
    PetscCall(CoupleShortDestroy(&sr));
    PetscCall(AncfDestroy(&ancf));
  }
  printf("cutoff: %.3e N at 2 %%, %.3e at 0.5 %%, %.1e beyond; power %.3f\n", f[0], f[1], f[2], log(f[0] / f[1]) / log(4.));
  /* power 2.5; between samples a/32 apart the length within reach, 2 sqrt(4 a .005 Dc) = 6 samples, is known to a few per cent */
  TEST_NEAR(log(f[0] / f[1]) / log(4.), 2.5, .2, "power of the force at the cutoff");
  TEST(f[2] == 0. && f[0] > 0., "beyond the cutoff %g N", f[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A beam along a circle of radius r (arc L/r), or straight for r = 0. */
static PetscErrorCode Bent(PetscReal L, PetscReal turn, Ancf *ancf)
{
  const PetscInt n = 64;
  const PetscReal a0[3] = {0., 0., 0.}, a1[3] = {L, 0., 0.};
  PetscReal *x, *v;

  PetscFunctionBegin;
  PetscCall(AncfCreate(PETSC_COMM_SELF, ancf));
  PetscCall(AddBeam(*ancf, a0, a1, n, 1e6));
  PetscCall(AncfSetUp(*ancf));
  PetscCall(PetscCalloc2(6 * (size_t)(n + 1), &x, 6 * (size_t)(n + 1), &v));
  for (PetscInt i = 0; i <= n; i++) { /* a hairpin: straight legs, a half circle of length `turn` in the middle */
    const PetscReal s = L * (PetscReal)i / (PetscReal)n, r = turn / PETSC_PI, leg = .5 * (L - turn);
    const PetscReal phi = turn > 0. ? PetscMax(0., PetscMin(PETSC_PI, (s - leg) / r)) : 0.;
    x[6 * i] = turn > 0. ? PetscMin(s, leg) + r * sin(phi) - PetscMax(0., s - leg - turn) : s;
    x[6 * i + 1] = turn > 0. ? r * (1. - cos(phi)) : 0.;
    x[6 * i + 3] = cos(phi);
    x[6 * i + 4] = sin(phi);
    v[6 * i + 1] = turn > 0. && s > .5 * L ? -1. : 0.;
  }
  PetscCall(AncfSetState(*ancf, 0., x, v));
  PetscCall(PetscFree2(x, v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestSelf(void)
{
  const PetscReal a = .02, L = 1.;
  ShortRange p;
  PetscInt contacts[3];

  PetscFunctionBegin;
  PetscCall(ShortRangeInit(&p));
  p.viscosity = 1., p.cutoff = .5 * a, p.roughness = 1e-3 * a;
  /* straight; a hairpin whose legs are out of reach, 2 r - 2 a = 1.2 Dc; one whose legs are .5 Dc apart */
  for (int i = 0; i < 3; i++) {
    const PetscReal gap = (i == 1 ? 1.2 : .5) * p.cutoff, turn = i ? PETSC_PI * (a + .5 * gap) : 0.;
    PetscReal f = 0., *Q;
    CoupleShort sr;
    Ancf ancf;
    PetscCall(Bent(L, turn, &ancf));
    PetscCall(MakeShort(ancf, NULL, &p, 8, &sr));
    PetscCall(CoupleShortSetUp(sr));
    PetscCall(CoupleShortApply(sr, 1e-9));
    PetscCall(CoupleShortGetForces(sr, &contacts[i], NULL, NULL, NULL));
    PetscCall(AncfGetLoads(ancf, &Q));
    for (PetscInt k = 33; k < 65; k++) f += Q[6 * k + 1];
    if (i < 2) TEST(contacts[i] == 0, "%s: %d pairs", i ? "a wide hairpin" : "a straight beam", (int)contacts[i]);
    if (i == 2) {
      /* legs side by side: the law of parallel cylinders times the length; ends: caps, the share that comes in over ex/4 */
      const PetscReal length = .5 * (L - turn) - a, ex = PETSC_PI * (a + .5 * p.cutoff),
                      want = ShortRangeLine(&p, .5 * a, gap) * length;
      printf("hairpin: %d pairs, %.4f N on a leg, law of parallel cylinders %.4f N\n", (int)contacts[i], f, want);
      TEST_NEAR(f / want, 1., .5 * (1.25 * ex - turn) / length + 1e-2, "force between the legs");
    }
    PetscCall(CoupleShortDestroy(&sr));
    PetscCall(AncfDestroy(&ancf));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Step(Ancf ancf, Rigid rigid, CoupleShort sr, PetscReal t, PetscReal h)
{
  PetscFunctionBegin;
  PetscCall(AncfZeroLoads(ancf));
  PetscCall(CoupleShortApply(sr, h));
  PetscCall(AncfAdvance(ancf, t + h));
  if (rigid) PetscCall(RigidAdvance(rigid, t + h));
  PetscCall(CoupleShortRemove(sr));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two soft beams thrown at each other: they bend around each other, part or stick, and the middle of the upper one stays above.
 */
static PetscErrorCode TestNoPassing(PetscReal *last)
{
  PetscReal p0[3], L0[3], p1[3], L1[3], lowest = 1., r[3], rb[3], gap = 1., least = 1., K;
  const PetscReal h = 1e-4;
  ShortRange p;
  CoupleShort sr;
  Ancf ancf;

  PetscFunctionBegin;
  PetscCall(ShortRangeInit(&p));
  p.viscosity = .5, p.cutoff = .01, p.roughness = .002, p.modulus = 1e8, p.restitution = .5;
  TEST(ShortRangeOverlap(&p, .02, .5 * 1000. * PETSC_PI * 4e-4, 2.) < p.roughness, "modulus too low to keep rigid beams apart");
  PetscCall(Cross(1.2, .02, -2., 2e5, &ancf));
  PetscCall(MakeShort(ancf, NULL, &p, 8, &sr));
  PetscCall(CoupleShortSetUp(sr));
  PetscCall(AncfGetMomentum(ancf, p0, L0));
  PetscCall(AncfGetEnergy(ancf, &K, NULL, NULL));
  for (PetscInt n = 0; n < 2000; n++) {
    PetscCall(Step(ancf, NULL, sr, h * (PetscReal)n, h));
    PetscCall(AncfGetSection(ancf, 0, .5, r, NULL, NULL, NULL));
    PetscCall(AncfGetSection(ancf, 1, .5, rb, NULL, NULL, NULL));
    PetscCall(CoupleShortGetForces(sr, NULL, &gap, NULL, NULL));
    lowest = PetscMin(lowest, rb[2] - r[2]);
    least = PetscMin(least, gap);
  }
  PetscCall(AncfGetMomentum(ancf, p1, L1));
  printf("crossing at 2 m/s: middles never nearer than %.4f m (diameter .04), gap %.2e m, momentum kept to %.1e of %.3g kg m/s, "
         "angular momentum to %.1e\n",
         lowest, least, p1[2] - p0[2], fabs(p0[2]), L1[0] - L0[0]);
  TEST(lowest > .04 && least > 0., "the beams went into each other: %g m, gap %g m", lowest - .04, least);
  for (int k = 0; k < 3; k++) {
    TEST_NEAR(p1[k], p0[k], 2000. * 1e-15 * 18. * fabs(p0[2]), "momentum"); /* 2000 steps of round-off over 18 nodes */
    /* second order in h; the tangents turn by about 2 m/s/.1 m h in a step: (20 h)^2 of p0 x 1 m */
    TEST_NEAR(L1[k], L0[k], 4e-6 * fabs(p0[2]) * 1., "angular momentum");
  }
  *last = rb[2];
  PetscCall(CoupleShortDestroy(&sr));
  PetscCall(AncfDestroy(&ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A beam falls flat on a wall, and one across a fixed ball: it stays out of both. */
static PetscErrorCode TestFall(PetscBool ball)
{
  const PetscReal g[3] = {0., 0., -10.}, x[3] = {0., 0., 0.}, n[3] = {0., 0., 2.};
  const PetscReal a0[3] = {-.3, 0., ball ? .13 : .03}, a1[3] = {.3, 0., ball ? .13 : .03}, h = 2e-4;
  PetscReal least = 1., gap, held[3], r[3];
  RigidBodySpec spec;
  ShortRange p;
  CoupleShort sr;
  Rigid rigid = NULL;
  Ancf ancf;

  PetscFunctionBegin;
  PetscCall(ShortRangeInit(&p));
  p.viscosity = 1., p.cutoff = .01, p.roughness = .001, p.modulus = ball ? 1e8 : 2e6, p.restitution = .3;
  PetscCall(AncfCreate(PETSC_COMM_SELF, &ancf));
  PetscCall(AddBeam(ancf, a0, a1, 6, ball ? 1e8 : 1e6));
  PetscCall(AncfSetGravity(ancf, g));
  PetscCall(AncfSetUp(ancf));
  if (ball) {
    PetscCall(RigidCreate(PETSC_COMM_SELF, &rigid));
    PetscCall(RigidBodySpecInit(&spec));
    spec.size[0] = .1;
    spec.motion = RIGID_FIXED;
    PetscCall(RigidAddBody(rigid, &spec, NULL));
    PetscCall(RigidSetUp(rigid));
  }
  PetscCall(MakeShort(ancf, rigid, &p, 8, &sr));
  if (!ball) PetscCall(CoupleShortAddWall(sr, x, n));
  PetscCall(CoupleShortSetUp(sr));
  for (PetscInt k = 0; k < 5000; k++) {
    PetscCall(Step(ancf, rigid, sr, h * (PetscReal)k, h));
    PetscCall(CoupleShortGetForces(sr, NULL, &gap, held, NULL));
    least = PetscMin(least, gap);
  }
  PetscCall(AncfGetSection(ancf, 0, .5, r, NULL, NULL, NULL));
  const PetscReal weight = 1000. * PETSC_PI * 4e-4 * .6 * 10.;
  printf("beam on a %s: least gap %.2e m, at the end height %.5f m, force %.4f N of the weight %.4f N\n", ball ? "ball" : "wall",
         least, r[2], held[2], weight);
  TEST(least > 0., "the beam went into it by %g m", -least);
  if (!ball) { /* at rest: k d L = weight over the length that is sampled (less the caps) */
    const PetscReal d = weight / (.5 * p.modulus * .56);
    TEST_NEAR(held[2], weight, 1e-3 * weight, "weight on the wall");
    TEST_NEAR(r[2], .02 + p.roughness - d, 2. * d, "height at rest");
  }
  PetscCall(CoupleShortDestroy(&sr));
  PetscCall(RigidDestroy(&rigid));
  PetscCall(AncfDestroy(&ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Many beams in a periodic box: forces with the grid equal those of the same beams a period further along, which fall into
   other cells, and pairs of beams taken two by two give the same sum. */
static PetscErrorCode TestGrid(void)
{
  enum { N = 24 };
  const PetscReal period[3] = {1., 0., 1.};
  PetscReal f[3][N], size = 0.;
  ShortRange p;
  PetscRandom rnd;
  PetscReal start[N][3], end[N][3];
  PetscInt pairs[2] = {0, 0}, sum = 0;

  PetscFunctionBegin;
  PetscCall(PetscRandomCreate(PETSC_COMM_SELF, &rnd));
  PetscCall(PetscRandomSetInterval(rnd, 0., 1.));
  PetscCall(ShortRangeInit(&p));
  p.viscosity = 1., p.cutoff = .08, p.roughness = .002;
  for (int i = 0; i < N; i++) { /* a pile of crossed beams, layers .05 m apart */
    PetscReal phi, x;
    PetscCall(PetscRandomGetValueReal(rnd, &phi));
    PetscCall(PetscRandomGetValueReal(rnd, &x));
    for (int k = 0; k < 3; k++) start[i][k] = end[i][k] = k == 2 ? .05 * (i % 20) : x;
    start[i][1] = end[i][1] = i < 20 ? 0. : 3.;
    end[i][0] += .4 * cos(6.28 * phi);
    end[i][1] += .4 * sin(6.28 * phi);
  }
  PetscCall(PetscRandomDestroy(&rnd));
  for (int way = 0; way < 3; way++) {
    for (int i = 0; i < N; i++) f[way][i] = 0.;
    for (int i = 0; i < (way < 2 ? 1 : N); i++)
      for (int j = (way < 2 ? 0 : i + 1); j < (way < 2 ? 1 : N); j++) {
        const PetscInt n = way < 2 ? N : 2;
        const PetscReal *e;
        PetscReal *v;
        CoupleShort sr;
        PetscInt contacts;
        Ancf ancf;
        PetscCall(AncfCreate(PETSC_COMM_SELF, &ancf));
        for (PetscInt b = 0; b < n; b++) {
          const PetscInt at = way < 2 ? b : (b ? j : i);
          PetscReal s[3], t[3];
          for (int k = 0; k < 3; k++) {
            s[k] = start[at][k] + (way == 1 ? 1.37 * (k != 1) - .41 * (k == 1) : 0.);
            t[k] = end[at][k] + (way == 1 ? 1.37 * (k != 1) - .41 * (k == 1) : 0.);
          }
          PetscCall(AddBeam(ancf, s, t, 2, 1e6));
        }
        PetscCall(AncfSetUp(ancf));
        PetscCall(AncfGetState(ancf, NULL, &e, NULL, NULL));
        PetscCall(PetscCalloc1(18 * (size_t)n, &v));
        for (PetscInt b = 0; b < n; b++)
          for (PetscInt k = 0; k < 3; k++) v[18 * b + 6 * k + 2] = sin(3. * (PetscReal)(way < 2 ? b : (b ? j : i)));
        PetscCall(AncfSetState(ancf, 0., e, v));
        PetscCall(MakeShort(ancf, NULL, &p, 8, &sr));
        PetscCall(CoupleShortSetPeriod(sr, period));
        PetscCall(CoupleShortSetUp(sr));
        PetscCall(CoupleShortApply(sr, 1e-12));
        PetscCall(CoupleShortGetForces(sr, &contacts, NULL, NULL, NULL));
        if (way < 2) pairs[way] = contacts;
        sum += way == 2 ? contacts : 0;
        for (PetscInt b = 0; b < n; b++) {
          PetscReal z;
          PetscCall(ForceZ(ancf, 3 * b, 3 * b + 3, &z));
          f[way][way < 2 ? b : (b ? j : i)] += z;
        }
        PetscCall(PetscFree(v));
        PetscCall(CoupleShortDestroy(&sr));
        PetscCall(AncfDestroy(&ancf));
      }
  }
  for (int i = 0; i < N; i++) size = PetscMax(size, fabs(f[0][i]));
  printf("grid: %d pairs of points, shifted %d, beams two by two %d; largest force %.4g N\n", (int)pairs[0], (int)pairs[1],
         (int)sum, size);
  TEST(pairs[0] == sum && pairs[1] == sum && sum > 100, "pairs");
  /* gaps of .01 m and positions of order 1 known to 1e-15; hG, of order 1e-12 x 1 N s/m x 1/.1 kg, below */
  for (int i = 0; i < N; i++) {
    TEST_NEAR(f[1][i], f[0][i], 1e-10 * size, "shifted by no period");
    TEST_NEAR(f[2][i], f[0][i], 1e-9 * size, "two by two");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestRefusals(void)
{
  const PetscReal period[3] = {.15, 0., 0.}, bad[3] = {-1., 0., 0.}, zero[3] = {0., 0., 0.};
  ShortRange p;
  CoupleShort sr;
  Ancf ancf;

  PetscFunctionBegin;
  PetscCall(ShortRangeInit(&p));
  p.viscosity = 1., p.cutoff = .01, p.roughness = 1e-3;
  PetscCall(Cross(1., -.005, 0., 1e6, &ancf));
  PetscCall(MakeShort(ancf, NULL, &p, 8, &sr));
  TEST_REFUSED(CoupleShortApply(sr, 1.), "CoupleShortSetUp()");
  TEST_REFUSED(CoupleShortSetSamples(sr, 1), "couple_shortrange_samples = 1");
  TEST_REFUSED(CoupleShortSetPeriod(sr, bad), "-1");
  TEST_REFUSED(CoupleShortAddWall(sr, zero, zero), "normal");
  TEST_REFUSED(CoupleShortSetUp(sr), "beam 0 and beam 1 overlap by 0.0049");
  PetscCall(CoupleShortDestroy(&sr));
  PetscCall(MakeShort(ancf, NULL, &p, 8, &sr));
  PetscCall(CoupleShortSetPeriod(sr, period));
  TEST_REFUSED(CoupleShortSetUp(sr), "too short");
  PetscCall(CoupleShortDestroy(&sr));
  p.cutoff = 1e-4;
  PetscCall(CoupleShortCreate(PETSC_COMM_SELF, ancf, NULL, &sr));
  TEST_REFUSED(CoupleShortSetParameters(sr, &p), "cutoff");
  PetscCall(CoupleShortDestroy(&sr));
  PetscCall(AncfDestroy(&ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscReal s[2] = {0., 0.}, last[2];

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, help));
  PetscCall(TestCrossing());
  PetscCall(TestConservation(PETSC_FALSE, &s[0]));
  PetscCall(TestConservation(PETSC_TRUE, &s[1]));
  TEST(s[0] == s[1], "the same state gives other forces: %.17g, %.17g", s[0], s[1]);
  PetscCall(TestCutoff());
  PetscCall(TestSelf());
  PetscCall(TestGrid());
  PetscCall(TestNoPassing(&last[0]));
  PetscCall(TestNoPassing(&last[1]));
  TEST(last[0] == last[1], "two runs differ: %.17g, %.17g", last[0], last[1]);
  PetscCall(TestFall(PETSC_FALSE));
  PetscCall(TestFall(PETSC_TRUE));
  PetscCall(TestRefusals());
  PetscCall(PetscFinalize());
  return test_report();
}
