/*
  test_rigid_contact.c - short-range forces: Eq. 31 against Brenner's exact resistances, its cutoff, approach to a wall against
  the exact loss of speed, Hertz collisions against closed forms, Eq. 32 against a lattice sum, conservation, crowds, refusals.
*/
#include "rigid.h"
#include "rigidtest.h"

static const char help[] = "Short-range forces of rigid bodies.\n";

/* Brenner, Chem. Eng. Sci. 16 (1961): force/(6 pi mu a U) of a sphere at distance a + s from a solid wall (solid) or a plane of
   symmetry (two equal spheres, gap 2 s, approaching at U each). */
static PetscReal Brenner(PetscReal s, PetscBool solid)
{
  const PetscReal al = acosh(1. + s), sh = sinh(al);
  PetscReal sum = 0.;
  for (int n = 1; n < 400; n++) {
    const PetscReal m = 2. * n + 1., e = .5 * m * al;
    PetscReal r;
    if (e > 300.) break;
    if (solid)
      r = (2. * sinh(m * al) + m * sinh(2. * al)) / (4. * sinh(e) * sinh(e) - m * m * sh * sh) - 1.;
    else
      r = (4. * cosh(e) * cosh(e) + m * m * sh * sh) / (2. * sinh(m * al) - m * sinh(2. * al)) - 1.;
    sum += n * (n + 1.) / ((2. * n - 1.) * (2. * n + 3.)) * r;
  }
  return 4. / 3. * sh * sum;
}

/* The singular part of Eq. 31 is Brenner's: what is left between two gaps is the next term, ln(1/s)/5 (wall), .45 ln(1/s) (pair).
 */
static PetscErrorCode TestBrenner(void)
{
  ShortRange p;
  const PetscReal mu = 1e-3, a = .2, unit = 6. * PETSC_PI * mu * a;
  PetscReal f1, f2, left;

  PetscFunctionBegin;
  TEST_REL(Brenner(.01, PETSC_TRUE), 101.896, 1e-5, "Brenner, wall");
  TEST_REL(Brenner(.05, PETSC_TRUE), 21.5858, 1e-5, "Brenner, wall");
  TEST_REL(Brenner(.1, PETSC_TRUE), 11.4592, 1e-5, "Brenner, wall");
  TEST_REL(Brenner(1., PETSC_TRUE), 2.12554, 1e-5, "Brenner, wall");
  TEST_REL(Brenner(.01, PETSC_FALSE), 28.1140, 1e-5, "Brenner, pair");
  TEST_REL(Brenner(.1, PETSC_FALSE), 4.62554, 1e-5, "Brenner, pair");
  PetscCall(ShortRangeInit(&p));
  p.viscosity = mu, p.roughness = 1e-6 * a, p.cutoff = .5 * a, p.kink = PETSC_TRUE;
  f1 = ShortRangeSphere(&p, a, PETSC_INFINITY, .01 * a) / unit;
  f2 = ShortRangeSphere(&p, a, PETSC_INFINITY, .05 * a) / unit;
  left = Brenner(.01, PETSC_TRUE) - Brenner(.05, PETSC_TRUE) - (f1 - f2);
  printf("wall, .01 - .05: Eq. 31 %.4f, Brenner %.4f, left %.4f (%.4f)", f1 - f2,
         Brenner(.01, PETSC_TRUE) - Brenner(.05, PETSC_TRUE), left, .2 * log(5.));
  TEST_NEAR(left, .2 * log(5.), .05 * log(1. / .05), "next term of the wall"); /* O(s ln 1/s) */
  f1 = ShortRangeSphere(&p, a, a, 2. * .01 * a) * 2. / unit;                   /* both move: v_n = 2 U */
  f2 = ShortRangeSphere(&p, a, a, 2. * .1 * a) * 2. / unit;
  left = Brenner(.01, PETSC_FALSE) - Brenner(.1, PETSC_FALSE) - (f1 - f2);
  printf("; pair, .01 - .1: %.4f, %.4f, left %.4f (%.4f)\n", f1 - f2, Brenner(.01, PETSC_FALSE) - Brenner(.1, PETSC_FALSE), left,
         .45 * log(10.));
  TEST_NEAR(left, .45 * log(10.), .2 * log(1. / .2), "next term of the pair");
  /* cutoff: value of Eq. 31; smooth form without kink, same singular part */
  TEST_NEAR(ShortRangeSphere(&p, a, a, p.cutoff * (1. - 1e-12)), 0., 1e-10 * unit, "Eq. 31 at the cutoff");
  TEST_REL(ShortRangeSphere(&p, a, 2. * a, .1 * a), 6. * PETSC_PI * mu * PetscSqr(a / 1.5) * (10. - 2.) / a, 1e-13, "Eq. 31");
  TEST_REL(ShortRangeMarkers(&p, .03, .1 * a), 1.5 * PETSC_PI * mu * 9e-4 * (10. - 2.) / a, 1e-13, "Eq. 32");
  p.kink = PETSC_FALSE;
  for (PetscReal s = .02 * a; s < p.cutoff; s *= 1.3)
    TEST_REL(ShortRangeMarkers(&p, .03, s), 1.5 * PETSC_PI * mu * 9e-4 * (1. / s - 2. / p.cutoff + s / (p.cutoff * p.cutoff)),
             1e-12, "smooth factor");
  TEST_NEAR(ShortRangeSphere(&p, a, a, p.cutoff - 1e-5 * a) / (1e-5 * a), 0., 1e-3 * unit / a, "slope at the cutoff");
  TEST(ShortRangeSphere(&p, a, a, -1.) == ShortRangeSphere(&p, a, a, p.roughness), "capped at the roughness");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A sphere of radius a runs at a fixed box from a gap of .3 a: the speed lost is (6 pi mu a^2/m) times the integral of the
 * factor. */
static PetscErrorCode Approach(PetscReal St, PetscReal dt, PetscReal modulus, PetscReal *vcontact, PetscReal *vout,
                               PetscReal *least)
{
  Rigid r;
  RigidBodySpec s;
  ShortRange p;
  const PetscReal a = .01, mu = .1, m = 4e-3, v0 = St * 6. * PETSC_PI * mu * a * a / m;
  PetscReal X[3], V[3], gap = .3 * a, t = 0.;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(ShortRangeInit(&p));
  p.viscosity = mu, p.cutoff = .2 * a, p.roughness = .002 * a, p.modulus = modulus;
  PetscCall(RigidSetShortRange(r, &p));
  PetscCall(RigidSetShortRangeSpacing(r, .5 * a));
  PetscCall(RigidBodySpecInit(&s));
  s.size[0] = a;
  s.mass = m;
  s.position[0] = a + gap;
  s.velocity[0] = -v0;
  PetscCall(RigidAddBody(r, &s, NULL));
  s.shape = RIGID_BOX;
  s.motion = RIGID_FIXED;
  s.size[0] = s.size[1] = s.size[2] = 4. * a;
  s.position[0] = -2. * a;
  s.velocity[0] = 0.;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidSetUp(r));
  *vcontact = *vout = 0.;
  *least = gap / a;
  for (int n = 0; n < 4000000 && gap < .4 * a; n++) {
    PetscReal was, before;
    PetscCall(RigidGetState(r, 0, X, NULL, V, NULL));
    was = X[0] - a;
    before = V[0]; /* the step that ends in contact is slowed by it */
    PetscCall(RigidAdvance(r, t += dt * a / v0));
    PetscCall(RigidGetState(r, 0, X, NULL, V, NULL));
    gap = X[0] - a;
    *least = PetscMin(*least, gap / a);
    if (was >= p.roughness && gap < p.roughness) *vcontact = -before / v0;
    if (fabs(V[0]) < 1e-9 * v0) break;
  }
  *vout = V[0] / v0;
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestApproach(void)
{
  ShortRange p;
  PetscReal Stc, vc, vout, least, vc2;

  PetscFunctionBegin;
  PetscCall(ShortRangeInit(&p));
  p.viscosity = 1., p.cutoff = .2, p.roughness = .002;
  Stc = ShortRangeCriticalStokes(&p);
  TEST_REL(Stc, log(100.) - 2. * .99 + .5 * (1. - 1e-4), 1e-12, "critical Stokes number");
  p.kink = PETSC_TRUE;
  TEST_REL(ShortRangeCriticalStokes(&p), log(100.) - .99, 1e-12, "critical Stokes number of the printed factor");
  PetscCall(Approach(20., 2e-4, 1e11, &vc, &vout, &least));
  PetscCall(Approach(20., 1e-4, 1e11, &vc2, &vout, &least));
  printf("St 20: St_c %.4f, speed at contact %.6f %.6f (%.6f), after %.4f (%.4f), least gap %.4f a\n", Stc, vc, vc2,
         1. - Stc / 20., vout, 1. - 2. * Stc / 20., least);
  /* the last step before contact, 1e-4 a long, still had to lose 1e-4 (1/s_min = 500)/St of v0; implicit Euler's z/4 is less */
  TEST_NEAR(vc2, 1. - Stc / 20., 3e-3, "speed at contact");
  /* on the way out the same again; in contact the capped resistance acts for t_c, a few (t_c v/s_min)/St */
  TEST(vout < 1. - 2. * Stc / 20. + 5e-3 && vout > .5 * (1. - 2. * Stc / 20.), "speed after the rebound %g", vout);
  TEST(least > 0., "the sphere overlaps the wall: %g a", least);
  PetscCall(Approach(.8 * Stc, 1e-4, 1e11, &vc, &vout, &least));
  printf("St 0.8 St_c: stops at %.5f a, speed %.1e\n", least, vout);
  TEST(least > .002 && vc == 0. && fabs(vout) < 1e-3, "does not stop before contact: gap %g a, speed %g", least, vout);
  /* where it stops, the integral of the factor from there to the cutoff is St */
  const PetscReal x = least / .2, St = -log(x) - 2. * (1. - x) + .5 * (1. - x * x);
  /* implicit Euler loses z/4 less, z = dt a gamma/(m v0): dt/4 x (1/s_stop = 260)/St of St */
  TEST_NEAR(St, .8 * Stc, 2. * 1e-4 / 4. * 260., "gap at which it stops");
  /* a step far beyond the explicit limit 2 m/gamma neither explodes nor reverses the motion */
  PetscCall(Approach(.05, 1e-1, 0., &vc, &vout, &least));
  TEST(fabs(vout) <= 1e-3 && least > .002, "long steps: speed %g, gap %g a", vout, least);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Head-on collision of two spheres without fluid: rebound at e, largest overlap (5 m v^2/4k)^(2/5), duration 2.943 d/v. */
static PetscErrorCode TestHertz(PetscReal e)
{
  Rigid r;
  RigidBodySpec s;
  ShortRange p;
  const PetscReal ai = .01, aj = .03, v0 = .7, R = 1. / (1. / ai + 1. / aj);
  PetscReal m[2], Xi[3], Xj[3], Vi[3], Vj[3], deepest = 0., first = -1., last = 0., t = 0., p0[3], L0[3], p1[3], L1[3];

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(ShortRangeInit(&p));
  p.roughness = 1e-5, p.modulus = 1e8, p.restitution = e;
  PetscCall(RigidSetShortRange(r, &p));
  PetscCall(RigidBodySpecInit(&s));
  s.size[0] = ai;
  s.velocity[0] = .5 * v0;
  s.velocity[1] = .3;
  PetscCall(RigidAddBody(r, &s, NULL));
  s.size[0] = aj;
  s.density = 2000.;
  s.position[0] = ai + aj + 5e-5;
  s.velocity[0] = -.5 * v0;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidSetUp(r));
  for (int b = 0; b < 2; b++) {
    PetscCall(RigidGetBody(r, b, &s));
    m[b] = s.mass;
  }
  const PetscReal mred = m[0] * m[1] / (m[0] + m[1]), k = 4. / 3. * p.modulus * sqrt(R), d = ShortRangeOverlap(&p, R, mred, v0),
                  tc = ShortRangeContactTime(&p, R, mred, v0);
  TEST_REL(.4 * k * pow(d, 2.5), .5 * mred * v0 * v0, 1e-12, "work of the contact force up to the largest overlap");
  TEST_REL(tc, 2.9433 * d / v0, 1e-4, "Hertz contact time");
  PetscCall(RigidGetMomentum(r, p0, L0));
  const PetscReal dt = tc / 200.;
  for (int n = 0; n < 1000; n++) {
    PetscCall(RigidAdvance(r, t += dt));
    PetscCall(RigidGetState(r, 0, Xi, NULL, Vi, NULL));
    PetscCall(RigidGetState(r, 1, Xj, NULL, Vj, NULL));
    const PetscReal gap = sqrt(PetscSqr(Xi[0] - Xj[0]) + PetscSqr(Xi[1] - Xj[1]) + PetscSqr(Xi[2] - Xj[2])) - ai - aj;
    deepest = PetscMax(deepest, p.roughness - gap);
    if (gap < p.roughness && first < 0.) first = t;
    if (gap < p.roughness) last = t;
  }
  PetscCall(RigidGetMomentum(r, p1, L1));
  printf("Hertz, e = %.1f: rebound %.5f, overlap %.4f of the elastic one, duration %.4f of the elastic one\n", e,
         (Vj[0] - Vi[0]) / v0, deepest / d, (last - first) / tc);
  TEST_NEAR((Vj[0] - Vi[0]) / v0, e, e == 1. ? 1e-3 : 5e-3,
            "restitution"); /* (pi dt/tc)^2 elastic; damping on half a step's old speed */
  if (e == 1.) {
    TEST_REL(deepest, d, 2e-3, "largest overlap");
    TEST_NEAR((last - first) / tc, 1., 3. / 200., "duration"); /* found to a step at either end */
  }
  for (int c = 0; c < 3; c++) {
    TEST_NEAR(p1[c], p0[c], 1e-14 * mred * 100., "momentum"); /* 1000 steps of round-off */
    TEST_NEAR(L1[c], L0[c], 1e-14 * mred * 100., "angular momentum");
  }
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two plates, lattice nodes as surface markers: the total of Eq. 32 is the lattice sum over pairs, here done by hand. */
static PetscErrorCode TestPlates(void)
{
  Rigid r;
  RigidBodySpec s;
  ShortRange p;
  const PetscReal h = .1, gap = .05, V = .3;
  PetscReal want = 0., A[3], Ab[3];

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(ShortRangeInit(&p));
  p.viscosity = 2., p.cutoff = .14, p.roughness = 1e-3;
  PetscCall(RigidSetShortRange(r, &p));
  PetscCall(RigidSetShortRangeSpacing(r, h));
  PetscCall(RigidBodySpecInit(&s));
  s.shape = RIGID_BOX;
  s.size[0] = .4, s.size[1] = .3, s.size[2] = .4; /* the next nodes on the sides are .15 away */
  s.mass = 1e9;                                   /* so that the implicit factor is 1 */
  s.velocity[2] = -V;
  s.position[2] = .4 + gap;
  PetscCall(RigidAddBody(r, &s, NULL));
  s.position[2] = 0.;
  s.velocity[2] = 0.;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidSetUp(r));
  PetscCall(RigidAdvance(r, 1e-9));
  for (int a = 0; a < 20; a++)
    for (int b = 0; b < 20; b++) {
      const PetscReal dx = h * (a % 5 - b % 5), dy = h * (a / 5 - b / 5);
      const PetscReal d = sqrt(dx * dx + dy * dy + gap * gap);
      if (d < p.cutoff)
        want += 1.5 * PETSC_PI * 2. * h * h * PetscSqr(p.cutoff - d) / (d * p.cutoff * p.cutoff) * V * gap / d * gap / d;
    }
  PetscCall(RigidGetAcceleration(r, 0, A, NULL));
  PetscCall(RigidGetAcceleration(r, 1, Ab, NULL));
  printf("plates: Eq. 32 %.8f N, lattice sum %.8f N\n", A[2] * 1e9, want);
  TEST_REL(A[2] * 1e9, want, 1e-6, "Eq. 32 summed"); /* the gap changes by 3e-10 m, 1e-8 of it */
  TEST_REL(Ab[2], -A[2], 1e-12, "reaction");
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A box .05 m above z = 0, with contact only; s: its spec. */
static PetscErrorCode DropBox(ShortRange *p, const PetscReal g[3], RigidBodySpec *s, Rigid *r)
{
  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, r));
  p->viscosity = 0., p->restitution = .3, p->modulus = 1e7;
  PetscCall(RigidSetShortRange(*r, p));
  PetscCall(RigidSetShortRangeSpacing(*r, .1));
  PetscCall(RigidSetGravity(*r, g));
  PetscCall(RigidBodySpecInit(s));
  s->shape = RIGID_BOX;
  s->size[0] = .3, s->size[1] = .2, s->size[2] = .4;
  s->position[2] = .25;
  PetscCall(RigidAddBody(*r, s, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Odd bodies collide off centre: momenta are kept; a joined pair is left alone; a box comes to rest on a floor; images across a
 * period. */
static PetscErrorCode TestOddBodies(void)
{
  Rigid r;
  RigidBodySpec s;
  ShortRange p;
  RigidJointSpec j;
  PetscReal p0[3], L0[3], p1[3], L1[3], w0[3], w1[3], X[3], V[3], scale;
  const PetscReal g[3] = {0., 0., -10.}, period[3] = {1., 0., 0.};

  PetscFunctionBegin;
  PetscCall(ShortRangeInit(&p));
  p.viscosity = .5, p.cutoff = .05, p.roughness = 2e-3, p.modulus = 1e5, p.restitution = .7;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidSetShortRange(r, &p));
  PetscCall(RigidSetShortRangeSpacing(r, .05));
  PetscCall(RigidBodySpecInit(&s));
  s.shape = RIGID_BOX;
  s.size[0] = .3, s.size[1] = .2, s.size[2] = .4;
  s.axisangle[0] = 1., s.axisangle[1] = .5, s.axisangle[3] = .7;
  s.velocity[0] = 1.;
  PetscCall(RigidAddBody(r, &s, NULL));
  s.shape = RIGID_CYLINDER;
  s.size[0] = .1, s.size[1] = .5;
  s.position[0] = .5, s.position[1] = .1, s.position[2] = .1;
  s.velocity[0] = -1.;
  s.omega[1] = 2.;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidSetUp(r));
  PetscCall(RigidGetMomentum(r, p0, L0));
  PetscCall(RigidGetState(r, 0, NULL, NULL, NULL, w0));
  for (int n = 1; n <= 6000; n++) PetscCall(RigidAdvance(r, n * 1e-4));
  PetscCall(RigidGetMomentum(r, p1, L1));
  PetscCall(RigidGetState(r, 0, NULL, NULL, V, w1));
  scale = 24. * 1.;
  for (int k = 0; k < 3; k++) {
    TEST_NEAR(p1[k], p0[k], 1e-12 * scale, "momentum of the collision");
    TEST_NEAR(L1[k], L0[k], 1e-12 * scale, "angular momentum of the collision");
  }
  TEST(fabs(V[0] - 1.) > .1 && fabs(w1[0]) + fabs(w1[1]) + fabs(w1[2]) > .1, "there was no collision: V %g", V[0]);
  PetscCall(RigidDestroy(&r));

  /* box dropped flat on a floor from .05 m: rests with a gap between 0 and the roughness */
  PetscCall(DropBox(&p, g, &s, &r));
  s.motion = RIGID_FIXED;
  s.size[0] = s.size[1] = 2., s.size[2] = .5;
  s.position[2] = -.25;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidSetUp(r));
  for (int n = 1; n <= 20000; n++) PetscCall(RigidAdvance(r, n * 1e-4));
  PetscCall(RigidGetState(r, 0, X, NULL, V, w1));
  printf("box on a floor: gap %.6f m (roughness %.6f), speed %.1e m/s, tilt rate %.1e rad/s\n", X[2] - .2, p.roughness,
         fabs(V[2]), fabs(w1[0]) + fabs(w1[1]));
  TEST(X[2] - .2 > 0. && X[2] - .2 < p.roughness, "gap %g m", X[2] - .2);
  TEST(fabs(V[2]) < 1e-3 && fabs(w1[0]) + fabs(w1[1]) < 1e-3, "does not rest: %g m/s, %g rad/s", V[2], fabs(w1[0]) + fabs(w1[1]));
  PetscCall(RigidDestroy(&r));

  /* two spheres that meet across a periodic side, and two joined ones that overlap */
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  p.restitution = 1.;
  p.modulus = 1e7;
  PetscCall(RigidSetShortRange(r, &p));
  PetscCall(RigidSetPeriod(r, period));
  for (int i = 0; i < 2; i++) {
    PetscCall(RigidBodySpecInit(&s));
    s.size[0] = .1;
    s.position[0] = i ? .9 : .05;
    s.velocity[0] = i ? .5 : -.5;
    s.position[0] += i ? -.1 : .1;
    PetscCall(RigidAddBody(r, &s, NULL));
  }
  for (int i = 0; i < 2; i++) {
    s.position[0] = .4 + .05 * i;
    s.position[1] = 3.;
    s.velocity[0] = 0.;
    PetscCall(RigidAddBody(r, &s, NULL));
  }
  PetscCall(RigidJointSpecInit(&j));
  j.a = 2, j.b = 3;
  j.point[0] = .4, j.point[1] = 3.;
  PetscCall(RigidAddJoint(r, &j, NULL));
  PetscCall(RigidSetUp(r));
  for (int n = 1; n <= 4000; n++) PetscCall(RigidAdvance(r, n * 1e-4));
  PetscCall(RigidGetState(r, 0, X, NULL, V, NULL));
  TEST_NEAR(V[0], .5, 5e-3, "rebound across the periodic side");
  PetscCall(RigidGetState(r, 2, X, NULL, V, NULL));
  TEST(V[0] == 0. && fabs(X[0] - .4) < 1e-14, "joined bodies push one another: V %g", V[0]);
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal PlaneGap(const PetscReal x[3], void *ctx)
{
  return x[2] - ((const PetscReal *)ctx)[2];
}

/* Inside of a pipe of radius 1 about the z axis. */
static PetscReal PipeGap(const PetscReal x[3], void *ctx)
{
  (void)ctx;
  return 1. - PetscSqrtReal(x[0] * x[0] + x[1] * x[1]);
}

/*
  A sphere that flies about in a pipe: the wall pushes radially, so that speed along the axis and angular momentum about it stay,
  to the error of normals by differences (round-off over a step of 1e-5 a: 1e-10), and so does the energy, to second order of the
  step.
*/
static PetscErrorCode TestPipe(void)
{
  Rigid r;
  RigidBodySpec s;
  ShortRange p;
  PetscReal X[3], V[3], far = 0., L = 0., L0, E0, turned = 0., last[2];
  int hits = 0, out = 0;

  PetscFunctionBegin;
  PetscCall(ShortRangeInit(&p));
  p.roughness = 5e-3, p.modulus = 1e7;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidSetShortRange(r, &p));
  PetscCall(RigidBodySpecInit(&s));
  s.size[0] = .2;
  s.mass = 1.;
  s.position[0] = .3;
  s.velocity[0] = .2, s.velocity[1] = 1., s.velocity[2] = .1;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidAddWallGap(r, PipeGap, NULL));
  PetscCall(RigidSetUp(r));
  L0 = s.position[0] * s.velocity[1];
  E0 = .2 * .2 + 1. + .1 * .1;
  last[0] = s.position[0], last[1] = 0.;
  for (int m = 1; m <= 200000; m++) {
    PetscReal rad;
    PetscCall(RigidAdvance(r, m * 1e-4));
    PetscCall(RigidGetState(r, 0, X, NULL, V, NULL));
    rad = hypot(X[0], X[1]);
    far = PetscMax(far, rad);
    if (rad > .795 && !out) hits++;
    out = rad > .795;
    turned += atan2(last[0] * X[1] - last[1] * X[0], last[0] * X[0] + last[1] * X[1]);
    last[0] = X[0], last[1] = X[1];
    L = X[0] * V[1] - X[1] * V[0];
  }
  printf("sphere in a pipe: %d hits, %.1f turns, gap at least %g m\n", hits, turned / (2. * PETSC_PI), .8 - far);
  TEST(hits > 10, "hits: %d", hits);
  TEST(far < .8, "overlaps the pipe by %g m", far - .8);
  TEST_NEAR(V[2], .1, 1e-9, "speed along the axis");
  TEST_NEAR(L, L0, 1e-6, "angular momentum about the axis");
  TEST_REL(V[0] * V[0] + V[1] * V[1] + V[2] * V[2], E0, 1e-3, "energy"); /* 60 steps in a contact: (h w)^2/24 = 1e-4 a hit */
  PetscCall(RigidAdvance(r, 20.1));
  PetscCall(RigidDestroy(&r));

  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  s.position[0] = .85;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidAddWallGap(r, PipeGap, NULL));
  PetscCall(RigidSetUp(r));
  PetscCall(PetscPushErrorHandler(TestCatch, NULL));
  Refused(RigidCheckOverlap(r, .1), "sphere in the wall of a pipe", "body 0 (sphere) overlaps the wall", "by 0.05");
  Refused(RigidAddWallGap(r, PipeGap, NULL), "two walls of any shape", "RigidAddWallGap()", "one already");
  PetscCall(PetscPopErrorHandler());
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A wall is a fixed box without edges: a sphere feels the same, a box rests on it; bodies joined to the ground feel nothing. */
static PetscErrorCode TestWall(void)
{
  Rigid r;
  RigidBodySpec s;
  ShortRange p;
  RigidJointSpec j;
  PetscReal A[3][3], X[3], V[3], w[3];
  const PetscReal x[3] = {3., 1., 0.}, n[3] = {0., 0., 2.}, g[3] = {0., 0., -10.}, zero[3] = {0., 0., 0.};

  PetscFunctionBegin;
  PetscCall(ShortRangeInit(&p));
  p.viscosity = .5, p.cutoff = .05, p.roughness = 2e-3, p.modulus = 1e5, p.restitution = .7;
  for (int k = 0; k < 3; k++) {
    PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
    PetscCall(RigidSetShortRange(r, &p));
    PetscCall(RigidSetShortRangeSpacing(r, .1));
    PetscCall(RigidBodySpecInit(&s));
    s.size[0] = .1;
    s.position[2] = .1015; /* both forces act */
    s.velocity[2] = -.1;
    PetscCall(RigidAddBody(r, &s, NULL));
    if (k == 2)
      PetscCall(RigidAddWallGap(r, PlaneGap, (void *)x));
    else if (k)
      PetscCall(RigidAddWall(r, x, n));
    else {
      s.shape = RIGID_BOX;
      s.motion = RIGID_FIXED;
      for (int c = 0; c < 3; c++) s.size[c] = 1.;
      s.position[2] = -.5;
      PetscCall(RigidAddBody(r, &s, NULL));
    }
    PetscCall(RigidSetUp(r));
    PetscCall(RigidAdvance(r, 1e-6));
    PetscCall(RigidGetAcceleration(r, 0, A[k], NULL));
    PetscCall(RigidDestroy(&r));
  }
  TEST_REL(A[1][2], A[0][2], 1e-6, "sphere at a wall and at a box"); /* the box's normal is by differences */
  TEST_REL(A[2][2], A[1][2], 1e-6, "sphere at a wall given by its gap");
  TEST(A[0][2] > 1., "no force: %g", A[0][2]);

  PetscCall(DropBox(&p, g, &s, &r));
  s.position[0] = 1.; /* hangs with its foot in the wall */
  s.position[2] = .15;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidJointSpecInit(&j));
  j.a = 1, j.b = RIGID_GROUND;
  j.point[0] = 1., j.point[2] = 1.;
  PetscCall(RigidAddJoint(r, &j, NULL));
  PetscCall(RigidAddWall(r, x, n));
  PetscCall(RigidSetUp(r));
  PetscCall(RigidCheckOverlap(r, .1));
  for (int m = 1; m <= 20000; m++) PetscCall(RigidAdvance(r, m * 1e-4));
  PetscCall(RigidGetState(r, 0, X, NULL, V, w));
  TEST(X[2] - .2 > 0. && X[2] - .2 < p.roughness, "box on a wall: gap %g m", X[2] - .2);
  TEST(fabs(V[2]) < 1e-3 && fabs(w[0]) + fabs(w[1]) < 1e-3, "does not rest: %g m/s", V[2]);
  PetscCall(RigidGetState(r, 1, X, NULL, V, NULL));
  TEST_NEAR(X[2], .15, 1e-12, "joined to the ground, not pushed by the wall");
  PetscCall(RigidDestroy(&r));

  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidBodySpecInit(&s));
  s.size[0] = .5;
  s.position[2] = .25;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidAddWall(r, x, n));
  PetscCall(RigidSetUp(r));
  PetscCall(PetscPushErrorHandler(TestCatch, NULL));
  Refused(RigidCheckOverlap(r, .1), "body in a wall", "body 0 (sphere) overlaps the wall", "by 0.25");
  Refused(RigidAddWall(r, x, zero), "a wall without normal", "RigidAddWall()", "longer than 0");
  PetscCall(PetscPopErrorHandler());
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A gas of 400 spheres in a periodic box: elastic collisions keep momentum and energy, no pair overlaps (checked by brute force).
 */
static PetscErrorCode TestCrowd(void)
{
  const int n = 400, side = 8;
  Rigid r;
  RigidBodySpec s;
  ShortRange p;
  const PetscReal a = .03, period[3] = {1., 1., 1.};
  PetscReal ke0, ke, p0[3], p1[3], L[3], least = 1e30, *X, *V0, V[3];
  int hit = 0;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(ShortRangeInit(&p));
  p.roughness = 2e-3, p.modulus = 3e6;
  PetscCall(RigidSetShortRange(r, &p));
  PetscCall(RigidSetPeriod(r, period));
  PetscCall(PetscMalloc2((size_t)(3 * n), &X, (size_t)(3 * n), &V0));
  for (int i = 0; i < n; i++) {
    const int id[3] = {i % side, i / side % side, i / side / side};
    PetscCall(RigidBodySpecInit(&s));
    s.size[0] = a;
    for (int k = 0; k < 3; k++) {
      s.position[k] = (id[k] + .5) / side;
      s.velocity[k] = Random() - .5;
      V0[3 * i + k] = s.velocity[k];
    }
    PetscCall(RigidAddBody(r, &s, NULL));
  }
  PetscCall(RigidSetUp(r));
  PetscCall(RigidCheckOverlap(r, .01));
  PetscCall(RigidGetEnergy(r, &ke0, NULL));
  PetscCall(RigidGetMomentum(r, p0, L));
  for (int m = 1; m <= 1500; m++) {
    PetscCall(RigidAdvance(r, m * 2e-4));
    if (m % 50) continue;
    for (int i = 0; i < n; i++) PetscCall(RigidGetState(r, i, X + 3 * i, NULL, NULL, NULL));
    for (int i = 0; i < n; i++)
      for (int j = 0; j < i; j++) {
        PetscReal d2 = 0.;
        for (int k = 0; k < 3; k++) d2 += PetscSqr(X[3 * i + k] - X[3 * j + k] - floor(X[3 * i + k] - X[3 * j + k] + .5));
        least = PetscMin(least, sqrt(d2) - 2. * a);
      }
  }
  PetscCall(RigidGetEnergy(r, &ke, NULL));
  PetscCall(RigidGetMomentum(r, p1, L));
  for (int i = 0; i < n; i++) {
    PetscCall(RigidGetState(r, i, NULL, NULL, V, NULL));
    hit += fabs(V[0] - V0[3 * i]) + fabs(V[1] - V0[3 * i + 1]) + fabs(V[2] - V0[3 * i + 2]) > .01;
  }
  PetscCall(PetscFree2(X, V0));
  printf("crowd: least gap %.2e m, energy %.5f of the initial one, %d of %d spheres have collided\n", least, ke / ke0, hit, n);
  TEST(least > 0., "spheres overlap by %g m", -least);
  TEST(hit > n / 2, "only %d spheres have collided", hit);
  TEST(fabs(ke / ke0 - 1.) < .02, "energy %g of the initial one", ke / ke0); /* pairs in contact at the end hold some */
  for (int k = 0; k < 3; k++) TEST_NEAR(p1[k], p0[k], 1e-11, "momentum of the crowd");
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Overlapping(RigidShape a, RigidShape b, PetscReal x, RigidMotion motion, Rigid *r)
{
  RigidBodySpec s;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, r));
  for (int i = 0; i < 3; i++) {
    PetscCall(RigidBodySpecInit(&s));
    s.shape = i == 1 ? a : b;
    for (int k = 0; k < 3; k++) s.size[k] = .5;
    s.position[0] = i == 0 ? 9. : (i == 1 ? 0. : x);
    s.motion = motion;
    PetscCall(RigidAddBody(*r, &s, NULL));
  }
  PetscCall(RigidSetUp(*r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestBadInput(void)
{
  Rigid r;
  RigidBodySpec s;
  ShortRange p, good;
  const PetscReal period[3] = {-1.5, 0., 0.}, shortperiod[3] = {1.5, 0., 0.};

  PetscFunctionBegin;
  PetscCall(ShortRangeInit(&good));
  good.viscosity = 1., good.cutoff = .5, good.roughness = .125, good.modulus = 1.;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(PetscPushErrorHandler(TestCatch, NULL));
#define REFUSE(change, a, b)                                                                                                     \
  do {                                                                                                                           \
    p = good;                                                                                                                    \
    change;                                                                                                                      \
    Refused(RigidSetShortRange(r, &p), #change, a, b);                                                                           \
  } while (0)
  REFUSE(p.viscosity = -1.5, "-rigid_lubrication_viscosity -1.5", ">= 0");
  REFUSE(p.cutoff = .0625, "-rigid_lubrication_cutoff 0.0625", "0.125");
  REFUSE(p.roughness = 0., "-rigid_roughness 0", "> 0");
  REFUSE(p.modulus = (PetscReal)NAN, "-rigid_contact_modulus", ">= 0");
  REFUSE(p.restitution = 1.5, "-rigid_contact_restitution 1.5", "<= 1");
  REFUSE(p.restitution = 0., "-rigid_contact_restitution 0", "> 0");
  Refused(RigidSetShortRangeSpacing(r, -1.5), "spacing", "-rigid_shortrange_spacing -1.5", ">= 0");
  Refused(RigidSetPeriod(r, period), "period", "-1.5", "> 0");
  PetscCall(RigidSetShortRange(r, &good));
  PetscCall(RigidBodySpecInit(&s));
  s.shape = RIGID_BOX;
  s.size[0] = s.size[1] = s.size[2] = 1.;
  PetscCall(RigidAddBody(r, &s, NULL));
  Refused(RigidSetUp(r), "no spacing", "-rigid_shortrange_spacing 0", "body 0 is a box");
  PetscCall(RigidDestroy(&r));
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidSetDimension(r, 2));
  PetscCall(RigidSetShortRange(r, &good));
  Refused(RigidSetUp(r), "lubrication in 2D", "-rigid_lubrication_viscosity 1", "3D");
  PetscCall(RigidDestroy(&r));
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidSetShortRange(r, &good));
  PetscCall(RigidSetPeriod(r, shortperiod));
  s.shape = RIGID_SPHERE;
  PetscCall(RigidAddBody(r, &s, NULL));
  Refused(RigidSetUp(r), "short period", "body 0", "1.5 m is too short");
  PetscCall(RigidDestroy(&r));
  for (int bodies = 1; bodies <= 2; bodies++) { /* 3.5 m is enough for a lone sphere of radius 1 m, not for two */
    const PetscReal period[3] = {3.5, 0., 0.};
    PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
    PetscCall(RigidSetShortRange(r, &good));
    PetscCall(RigidSetPeriod(r, period));
    for (int b = 0; b < bodies; b++) PetscCall(RigidAddBody(r, &s, NULL));
    if (bodies == 1)
      PetscCall(RigidSetUp(r));
    else
      Refused(RigidSetUp(r), "short period of two", "body 0", "3.5 m is too short");
    PetscCall(RigidDestroy(&r));
  }
  /* overlaps at start, both named; touching and fixed pairs pass */
  PetscCall(Overlapping(RIGID_SPHERE, RIGID_SPHERE, .75, RIGID_FREE, &r));
  Refused(RigidCheckOverlap(r, .1), "spheres", "bodies 1 (sphere) and 2 (sphere)", "overlap by 0.25");
  PetscCall(RigidDestroy(&r));
  PetscCall(Overlapping(RIGID_BOX, RIGID_SPHERE, .7, RIGID_FREE, &r));
  Refused(RigidCheckOverlap(r, .1), "box and sphere", "bodies 1 (box) and 2 (sphere)", "overlap by 0.05");
  PetscCall(RigidDestroy(&r));
  PetscCall(Overlapping(RIGID_BOX, RIGID_ELLIPSOID, .7, RIGID_FREE, &r));
  Refused(RigidCheckOverlap(r, .1), "box and ellipsoid", "bodies 1 (box) and 2 (ellipsoid)", "overlap");
  PetscCall(RigidDestroy(&r));
  PetscCall(PetscPopErrorHandler());
  PetscCall(Overlapping(RIGID_BOX, RIGID_SPHERE, .75, RIGID_FREE, &r)); /* touches: .25 + .5 */
  PetscCall(RigidCheckOverlap(r, .1));
  PetscCall(RigidDestroy(&r));
  PetscCall(Overlapping(RIGID_BOX, RIGID_BOX, .3, RIGID_FIXED, &r));
  PetscCall(RigidCheckOverlap(r, .1));
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, help));
  PetscCall(TestBrenner());
  PetscCall(TestApproach());
  PetscCall(TestHertz(1.));
  PetscCall(TestHertz(.6));
  PetscCall(TestPlates());
  PetscCall(TestOddBodies());
  PetscCall(TestWall());
  PetscCall(TestPipe());
  PetscCall(TestCrowd());
  PetscCall(TestBadInput());
  PetscCall(PetscFinalize());
  return test_report();
}
