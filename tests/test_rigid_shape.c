/*
  test_rigid_shape.c - mass properties by integration over a lattice, signed distances against sampled surfaces, BCE markers
  (volume, spacing, depth, cover, moments), and the messages for bad input.
*/
#include "rigid.h"
#include "rigidtest.h"

static const char help[] = "Shapes, markers and input checks of rigid bodies.\n";

typedef struct {
  RigidShape shape;
  PetscReal size[3];
  PetscInt dim;
} Case;

static const Case cases[] = {
    {RIGID_SPHERE, {.7, 0., 0.}, 3},     {RIGID_BOX, {.8, 1.3, 1.9}, 3},     {RIGID_CYLINDER, {.6, 1.7, 0.}, 3},
    {RIGID_ELLIPSOID, {.6, .8, 1.1}, 3}, {RIGID_ELLIPSOID, {.9, .9, .5}, 3}, {RIGID_CAPSULE, {.5, 1.2, 0.}, 3},
    {RIGID_SPHERE, {.7, 0., 0.}, 2},     {RIGID_BOX, {.8, 1.3, 0.}, 2},      {RIGID_CYLINDER, {.6, 0., 0.}, 2},
    {RIGID_ELLIPSOID, {1.1, .6, 0.}, 2},
};
#define NUM_CASES ((int)(sizeof(cases) / sizeof(cases[0])))

static PetscErrorCode CaseSpec(const Case *c, RigidBodySpec *s)
{
  PetscFunctionBegin;
  PetscCall(RigidBodySpecInit(s));
  s->shape = c->shape;
  for (int k = 0; k < 3; k++) s->size[k] = c->size[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Mass and moments by summing cells of a lattice, each by the part clamp(1/2 - distance/h, 0, 1) that lies inside. The smeared
  indicator is right for flat faces normal to an axis; elsewhere the error is O((h/r)^2), r the smallest radius or half edge.
*/
static PetscErrorCode TestMass(const Case *c)
{
  const PetscInt n = c->dim == 2 ? 400 : 120;
  Rigid r;
  RigidBodySpec s;
  PetscReal ext = 0., h, mass = 0., m2[3] = {0., 0., 0.}, tol;

  PetscFunctionBegin;
  PetscCall(CaseSpec(c, &s));
  s.density = 1.7;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidSetDimension(r, c->dim));
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidSetUp(r));
  PetscCall(RigidGetBody(r, 0, &s));
  ext = 1.21; /* more than half of every case's extent */
  h = 2. * ext / (PetscReal)n;
  for (PetscInt k = 0; k < (c->dim == 2 ? 1 : n); k++)
    for (PetscInt j = 0; j < n; j++)
      for (PetscInt i = 0; i < n; i++) {
        const PetscReal x[3] = {-ext + h * (i + .5), -ext + h * (j + .5), c->dim == 2 ? 0. : -ext + h * (k + .5)};
        const PetscReal f =
            PetscMin(PetscMax(.5 - RigidShapeDistance(&s, x) / h, 0.), 1.) * s.density * (c->dim == 2 ? h * h : h * h * h);
        mass += f;
        for (int d = 0; d < 3; d++) m2[d] += f * x[d] * x[d];
      }
  tol = 4. * (h / .4) * (h / .4);
  TEST_REL(s.mass, mass, tol, "mass");
  for (int d = (c->dim == 2 ? 2 : 0); d < 3; d++)
    TEST_REL(s.inertia[d], m2[(d + 1) % 3] + m2[(d + 2) % 3], tol, "moment of inertia");
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The distance function is the distance: |grad d| = 1, the point x - d grad d lies on the surface, and no sampled surface point
 * is nearer. */
static PetscErrorCode TestDistance(const Case *c)
{
  RigidBodySpec s;
  const int nsurf = 4000;
  PetscReal *surf;

  PetscFunctionBegin;
  PetscCall(CaseSpec(c, &s));
  PetscCall(PetscMalloc1((size_t)(3 * nsurf), &surf));
  for (int i = 0; i < nsurf; i++) { /* rays from the centre, cut by bisection on the sign alone */
    PetscReal d[3], lo = 0., hi = 4., len;
    for (int k = 0; k < 3; k++) d[k] = (c->dim == 2 && k == 2) ? 0. : 2. * Random() - 1.;
    len = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    if (len < .1) {
      i--;
      continue;
    }
    for (int k = 0; k < 3; k++) d[k] /= len;
    for (int it = 0; it < 60; it++) {
      const PetscReal m = .5 * (lo + hi), x[3] = {m * d[0], m * d[1], m * d[2]};
      if (RigidShapeDistance(&s, x) < 0.)
        lo = m;
      else
        hi = m;
    }
    for (int k = 0; k < 3; k++) surf[3 * i + k] = lo * d[k];
  }
  for (int i = 0; i < 300; i++) {
    PetscReal x[3], y[3], g[3] = {0., 0., 0.}, d, near = 1e30, gg = 0.;
    for (int k = 0; k < 3; k++) x[k] = (c->dim == 2 && k == 2) ? 0. : 3. * Random() - 1.5;
    d = RigidShapeDistance(&s, x);
    for (int j = 0; j < nsurf; j++) {
      PetscReal q = 0.;
      for (int k = 0; k < 3; k++) q += PetscSqr(surf[3 * j + k] - x[k]);
      near = PetscMin(near, q);
    }
    TEST(fabs(d) <= sqrt(near) + 1e-12, "distance %g, but a surface point is %g away", d, sqrt(near));
    TEST(sqrt(near) <= fabs(d) + .25, "distance %g, but the nearest of many surface points is %g away", d,
         sqrt(near)); /* gaps of the samples */
    for (int k = 0; k < c->dim; k++) {
      PetscReal p[3] = {x[0], x[1], x[2]}, m[3] = {x[0], x[1], x[2]};
      p[k] += 1e-6;
      m[k] -= 1e-6;
      g[k] = (RigidShapeDistance(&s, p) - RigidShapeDistance(&s, m)) / 2e-6;
      gg += g[k] * g[k];
    }
    if (fabs(gg - 1.) > 1e-3) continue; /* the difference straddles the medial surface; counted below */
    for (int k = 0; k < 3; k++) y[k] = x[k] - d * g[k];
    TEST_NEAR(RigidShapeDistance(&s, y), 0., 1e-7, "foot point on the surface"); /* difference error 1e-10 x second derivatives */
  }
  PetscCall(PetscFree(surf));
  /* medial points */
  const PetscReal o[3] = {0., 0., 0.};
  PetscReal least = 1e30;
  for (int k = 0; k < c->dim; k++) {
    if (c->shape == RIGID_ELLIPSOID) least = PetscMin(least, s.size[k]);
    if (c->shape == RIGID_BOX) least = PetscMin(least, .5 * s.size[k]);
  }
  if (c->shape == RIGID_SPHERE || c->shape == RIGID_CAPSULE) least = s.size[0];
  if (c->shape == RIGID_CYLINDER) least = c->dim == 2 ? s.size[0] : PetscMin(s.size[0], .5 * s.size[1]);
  TEST_NEAR(RigidShapeDistance(&s, o), -least, 1e-14, "distance at the centre");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Volume of the K outer layers of thickness dp, where a formula of its own exists; < 0 where not. */
static PetscReal LayerVolume(const Case *c, PetscReal dp, PetscReal K)
{
  const PetscReal t = K * dp, R = c->size[0], L = c->size[1];
  if (c->dim == 3) {
    if (c->shape == RIGID_SPHERE) return 4. / 3. * PETSC_PI * (R * R * R - pow(PetscMax(R - t, 0.), 3));
    if (c->shape == RIGID_CAPSULE) return PETSC_PI * (L * (R * R - (R - t) * (R - t)) + 4. / 3. * (R * R * R - pow(R - t, 3)));
  } else if (c->shape == RIGID_SPHERE || c->shape == RIGID_CYLINDER)
    return PETSC_PI * (R * R - (R - t) * (R - t));
  if (c->shape == RIGID_ELLIPSOID) {
    PetscReal a = c->dim == 2 ? PETSC_PI : 4. / 3. * PETSC_PI, b = a;
    for (int k = 0; k < c->dim; k++) a *= c->size[k], b *= c->size[k] - t;
    return a - b;
  }
  return -1.;
}

static PetscReal ShapeVolume(const Case *c)
{
  const PetscReal *a = c->size;
  if (c->shape == RIGID_BOX) return c->dim == 2 ? a[0] * a[1] : a[0] * a[1] * a[2];
  if (c->shape == RIGID_CYLINDER && c->dim == 3) return PETSC_PI * a[0] * a[0] * a[1];
  if (c->shape == RIGID_CAPSULE) return PETSC_PI * a[0] * a[0] * (a[1] + 4. / 3. * a[0]);
  return LayerVolume(c, 1., c->shape == RIGID_ELLIPSOID ? 0. : a[0]) +
         (c->shape == RIGID_ELLIPSOID ? (c->dim == 2 ? PETSC_PI * a[0] * a[1] : 4. / 3. * PETSC_PI * a[0] * a[1] * a[2]) : 0.);
}

static PetscReal Nearest(PetscInt n, const PetscReal *x, const PetscReal p[3], PetscInt skip)
{
  PetscReal best = 1e30;
  for (PetscInt j = 0; j < n; j++)
    if (j != skip)
      best = PetscMin(best, PetscSqr(x[3 * j] - p[0]) + PetscSqr(x[3 * j + 1] - p[1]) + PetscSqr(x[3 * j + 2] - p[2]));
  return sqrt(best);
}

static PetscErrorCode TestMarkers(const Case *c, PetscReal dp, PetscReal layers, PetscBool quiet)
{
  RigidBodySpec s;
  PetscInt n;
  PetscReal *x, *v, *depth, sum = 0., lo = 1e30, hi = 0., cen[3] = {0., 0., 0.}, worst = 0., vlo = 1e30, vhi = 0., vref;
  const PetscReal depthmax = layers * dp, cell = c->dim == 2 ? dp * dp : dp * dp * dp;
  const PetscBool full = layers > 50. ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(CaseSpec(c, &s));
  PetscCall(RigidFillMarkers(&s, c->dim, dp, depthmax, &n, &x, &v, &depth));
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal near = Nearest(n, x, &x[3 * i], i);
    sum += v[i];
    lo = PetscMin(lo, near);
    hi = PetscMax(hi, near);
    vlo = PetscMin(vlo, v[i]);
    vhi = PetscMax(vhi, v[i]);
    for (int k = 0; k < 3; k++) cen[k] += v[i] * x[3 * i + k];
    TEST_NEAR(depth[i], -RigidShapeDistance(&s, &x[3 * i]), 0., "depth");
    TEST(depth[i] > .25 * dp && depth[i] <= PetscMax(depthmax, dp) * (1. + 1e-9), "marker at depth %g, depthmax %g, dp %g",
         depth[i], depthmax, dp);
    if (c->dim == 2) TEST(x[3 * i + 2] == 0., "a 2D marker at z = %g", x[3 * i + 2]);
  }
  vref = full ? ShapeVolume(c) : LayerVolume(c, dp, layers);
  if (vref > 0.) TEST_REL(sum, vref, 1e-12, "volume of the markers"); /* round-off of a few thousand terms */
  /*
    Rings of n = round(2 pi rho/dp) markers have chords of .83 dp and more for n >= 4, .69 dp for n = 3 (rho >= .4 dp); layers are
    dp apart and the innermost of a round body .9 dp from a core. An ellipsoid's core keeps .5 dp + 0 ... .3 dp.
  */
  TEST(lo >= (c->shape == RIGID_ELLIPSOID ? .5 : .69) * dp && hi <= 1.25 * dp, "%g <= nearest neighbour <= %g, dp = %g", lo, hi,
       dp);
  /* rounding to n >= 1 cells stretches an edge by 1.5 at most; a core of radius .4 dp has .5 dp^2 dz or .27 dp^3; one below joins
   * a layer of 3 markers at least */
  TEST(vlo > .25 * cell && vhi < pow(1.5, c->dim) * cell, "%g <= volume/dp^d <= %g", vlo / cell, vhi / cell);
  for (int k = 0; k < 3; k++) TEST_NEAR(cen[k] / sum, 0., .02 * dp, "centroid");
  /* every point of the filled layers, and of the surface, has a marker within the half diagonal of a cell 1.5 dp wide (an
   * ellipsoid's core is .3 dp short) */
  for (int i = 0, seen = 0; i < 20000 && seen < 400; i++) {
    PetscReal p[3], d;
    for (int k = 0; k < 3; k++) p[k] = (c->dim == 2 && k == 2) ? 0. : 2.4 * Random() - 1.2;
    d = RigidShapeDistance(&s, p);
    if (d > 0. || -d > (layers - .5) * dp) continue;
    seen++;
    worst = PetscMax(worst, Nearest(n, x, p, -1));
  }
  TEST(worst <= (.5 * sqrt((PetscReal)c->dim) * 1.5 + (c->shape == RIGID_ELLIPSOID ? .3 : 0.)) * dp,
       "shape %d: a point inside is %g dp from the next marker, dp = %g", (int)c->shape, worst / dp, dp);
  if (!quiet)
    printf("%d-D shape %d dp %.3f layers %4.1f: %5d markers, nearest %.3f..%.3f dp, volume %.3f..%.3f dp^d, gap %.3f dp\n",
           (int)c->dim, (int)c->shape, dp, full ? -1. : layers, (int)n, lo / dp, hi / dp, vlo / cell, vhi / cell, worst / dp);
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(v));
  PetscCall(PetscFree(depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A box whose edges are multiples of dp is the fluid's lattice; markers below depthmax are left out. */
static PetscErrorCode TestBoxLattice(void)
{
  RigidBodySpec s;
  PetscInt n;
  PetscReal *x, *v, *depth;

  PetscFunctionBegin;
  PetscCall(RigidBodySpecInit(&s));
  s.shape = RIGID_BOX;
  s.size[0] = .8, s.size[1] = .6, s.size[2] = 1.;
  PetscCall(RigidFillMarkers(&s, 3, .1, .2, &n, &x, &v, &depth));
  TEST(n == 8 * 6 * 10 - 4 * 2 * 6, "box of 8 x 6 x 10 cells, two layers: %d markers", (int)n);
  for (PetscInt i = 0; i < n; i++) {
    for (int k = 0; k < 3; k++) {
      const PetscReal u = (x[3 * i + k] + .5 * s.size[k]) / .1 - .5;
      TEST_NEAR(u, floor(u + .5), 1e-12, "lattice");
    }
    TEST_REL(v[i], 1e-3, 1e-12, "cell volume");
  }
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(v));
  PetscCall(PetscFree(depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Try(PetscInt dim, const RigidBodySpec *s)
{
  Rigid r = NULL;
  RigidBodySpec good;
  PetscErrorCode ierr = RigidCreate(PETSC_COMM_SELF, &r);
  if (!ierr) ierr = RigidBodySpecInit(&good);
  good.size[0] = 1.;
  if (!ierr) ierr = RigidSetDimension(r, dim);
  if (!ierr) ierr = RigidAddBody(r, &good, NULL); /* so that the bad one is body 1 */
  if (!ierr) ierr = RigidAddBody(r, s, NULL);
  if (!ierr) ierr = RigidSetUp(r);
  (void)RigidDestroy(&r);
  return ierr;
}

#define REFUSE(dim, change, a, b)                                                                                                \
  do {                                                                                                                           \
    RigidBodySpec s;                                                                                                             \
    PetscCall(RigidBodySpecInit(&s));                                                                                            \
    s.shape = RIGID_BOX;                                                                                                         \
    s.size[0] = s.size[1] = s.size[2] = 1.;                                                                                      \
    change;                                                                                                                      \
    Refused(Try(dim, &s), #change, a, b);                                                                                        \
  } while (0)

static PetscErrorCode TestBadInput(void)
{
  Rigid r;
  RigidBodySpec ok;
  PetscInt n;
  PetscReal *x, *v, *d;
  const PetscReal nan = (PetscReal)NAN, badg[3] = {0., nan, 0.}, F[3] = {nan, 0., 0.};

  PetscFunctionBegin;
  PetscCall(PetscPushErrorHandler(TestCatch, NULL));
  REFUSE(3, s.density = 0., "body 1", "density = 0");
  REFUSE(3, s.density = -5., "body 1", "density = -5");
  REFUSE(3, s.density = nan, "body 1", "density");
  REFUSE(3, s.size[2] = 0., "body 1", "size[2] = 0");
  REFUSE(3, s.size[1] = -2., "body 1", "size[1] = -2");
  REFUSE(3, s.size[1] = nan, "body 1", "size[1]");
  REFUSE(3, s.mass = 0., "body 1", "mass = 0");
  REFUSE(3, s.mass = -3., "body 1", "mass = -3");
  REFUSE(3, s.inertia[1] = 0., "inertia[1] = 0", "positive definite");
  REFUSE(3, s.inertia[1] = -2., "inertia[1] = -2", "positive definite");
  REFUSE(3, (s.inertia[0] = 1.25, s.inertia[1] = 1.25, s.inertia[2] = 3.5), "inertia = (1.25, 1.25, 3.5)",
         "sum of the other two");
  REFUSE(3, s.inertia[0] = 1e9, "inertia = (1e+09", "sum of the other two");
  REFUSE(3, s.axisangle[2] = 0., "axisangle", "length > 0");
  REFUSE(3, s.position[0] = nan, "body 1", "position[0]");
  REFUSE(3, s.velocity[2] = (PetscReal)INFINITY, "body 1", "velocity[2]");
  REFUSE(3, s.omega[1] = nan, "body 1", "omega[1]");
  REFUSE(3, s.shape = (RigidShape)77, "body 1", "shape = 77");
  REFUSE(3, s.motion = (RigidMotion)7, "body 1", "motion = 7");
  REFUSE(3, (s.lock[0] = PETSC_TRUE, s.velocity[0] = 2.), "velocity[0] = 2", "locked");
  REFUSE(3, (s.lock[4] = PETSC_TRUE, s.omega[1] = 2.), "omega[1] = 2", "locked");
  REFUSE(2, s.velocity[2] = 1., "body 1", "velocity[2]");
  REFUSE(2, s.omega[0] = 1., "body 1", "omega[0]");
  REFUSE(2, (s.axisangle[0] = 1., s.axisangle[3] = .1), "body 1", "along z");
  REFUSE(2, s.shape = RIGID_CAPSULE, "body 1", "capsule");

  PetscCall(RigidBodySpecInit(&ok));
  ok.size[0] = .525;
  Refused(RigidFillMarkers(&ok, 3, 1.1, 3., &n, &x, &v, &d), "too small a body", "smallest extent is 1.05 m", "dp = 1.1");
  Refused(RigidFillMarkers(&ok, 3, -.1, 3., &n, &x, &v, &d), "dp < 0", "dp = -0.1", "> 0");
  Refused(RigidFillMarkers(&ok, 3, nan, 3., &n, &x, &v, &d), "dp NaN", "dp", "> 0");
  Refused(RigidFillMarkers(&ok, 3, .1, 0., &n, &x, &v, &d), "depthmax = 0", "depthmax = 0", "dp/2");
  Refused(RigidFillMarkers(&ok, 4, .1, 1., &n, &x, &v, &d), "dim = 4", "dim = 4", "2 or 3");
  Refused(RigidFillMarkers(&ok, 3, 1e-5, 1., &n, &x, &v, &d), "too many markers", "2e9 markers", "dp = 1e-05");
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  Refused(RigidSetGravity(r, badg), "gravity NaN", "-rigid_gravity", "finite");
  Refused(RigidSetFluidDensity(r, -1.), "rho < 0", "-rigid_fluid_density -1", ">= 0");
  Refused(RigidSetDimension(r, 1), "dim = 1", "-rigid_dimension 1", "2 or 3");
  PetscCall(RigidAddBody(r, &ok, NULL));
  Refused(RigidSetDimension(r, 2), "dim after bodies", "RigidSetDimension", "before");
  const PetscReal tt[2] = {1.5, 1.5}, vv[6] = {0.};
  Refused(RigidSetMotionTable(r, 0, 2, tt, vv, NULL), "table of a free body", "body 0", "prescribed");
  ok.motion = RIGID_PRESCRIBED;
  PetscCall(RigidAddBody(r, &ok, NULL));
  Refused(RigidSetMotionTable(r, 1, 2, tt, vv, NULL), "times that stand still", "body 1: time 1", "1.5 s; times must increase");
  Refused(RigidSetMotionTable(r, 1, 0, tt, vv, NULL), "empty table", "body 1", "0 entries");
  Refused(RigidGetState(r, 0, x = NULL, NULL, NULL, NULL), "no set-up", "RigidSetUp", "first");
  PetscCall(RigidSetUp(r));
  Refused(RigidGetState(r, 2, NULL, NULL, NULL, NULL), "no such body", "body 2", "2 bodies");
  Refused(RigidAddBody(r, &ok, NULL), "late body", "RigidAddBody", "before");
  PetscCall(RigidAdvance(r, 1.));
  Refused(RigidAdvance(r, .5), "backwards", "t = 0.5", ">= the present time 1");
  PetscCall(RigidAddLoad(r, 0, F, NULL));
  Refused(RigidAdvance(r, 2.), "NaN load", "body 0", "not finite");
  PetscCall(RigidDestroy(&r));
  PetscCall(PetscOptionsSetValue(NULL, "-rigid_gravity", "1,2"));
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  Refused(RigidSetFromOptions(r), "two numbers", "-rigid_gravity", "3 numbers");
  PetscCall(PetscOptionsClearValue(NULL, "-rigid_gravity"));
  PetscCall(RigidDestroy(&r));
  PetscCall(PetscPopErrorHandler());
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Options with a prefix reach the object and show in its view. */
static PetscErrorCode TestOptions(void)
{
  Rigid r;
  RigidBodySpec s;
  PetscViewer viewer;
  char text[4096];
  FILE *fp = tmpfile();
  size_t got;

  PetscFunctionBegin;
  PetscCall(PetscOptionsSetValue(NULL, "-my_rigid_gravity", "0,0,-9.5"));
  PetscCall(PetscOptionsSetValue(NULL, "-my_rigid_fluid_density", "998"));
  PetscCall(RigidCreate(PETSC_COMM_SELF, &r));
  PetscCall(RigidSetOptionsPrefix(r, "my_"));
  PetscCall(RigidSetFromOptions(r));
  PetscCall(RigidBodySpecInit(&s));
  s.size[0] = .25;
  s.lock[5] = PETSC_TRUE;
  PetscCall(RigidAddBody(r, &s, NULL));
  PetscCall(RigidSetUp(r));
  PetscCall(PetscViewerASCIIOpenWithFILE(PETSC_COMM_SELF, fp, &viewer));
  PetscCall(RigidView(r, viewer));
  PetscCall(PetscViewerDestroy(&viewer));
  rewind(fp);
  got = fread(text, 1, sizeof(text) - 1, fp);
  text[got] = 0;
  TEST(strstr(text, "gravity 0. 0. -9.5") || strstr(text, "gravity 0 0 -9.5"), "view: %s", text);
  TEST(strstr(text, "998") && strstr(text, "sphere, free, size 0.25") && strstr(text, "locks 000001"), "view: %s", text);
  fclose(fp);
  PetscCall(RigidDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, help));
  for (int k = 0; k < NUM_CASES; k++) {
    PetscCall(TestMass(&cases[k]));
    PetscCall(TestDistance(&cases[k]));
    PetscCall(TestMarkers(&cases[k], .1, 2., PETSC_FALSE));
    PetscCall(TestMarkers(&cases[k], .093, 3., PETSC_FALSE));
    PetscCall(TestMarkers(&cases[k], .21, 100., PETSC_FALSE));
    for (PetscReal dp = .15; dp < (cases[k].shape == RIGID_ELLIPSOID ? .27 : .6); dp *= 1.021)
      PetscCall(TestMarkers(&cases[k], dp, 100., PETSC_TRUE));
  }
  PetscCall(TestBoxLattice());
  PetscCall(TestBadInput());
  PetscCall(TestOptions());
  PetscCall(PetscFinalize());
  return test_report();
}
