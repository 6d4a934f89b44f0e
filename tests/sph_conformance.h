/*
  sph_conformance.h - scenes for tests that compare backends of the fluid: disturbed lattices with walls and a moving body.
*/
#ifndef SPH_CONFORMANCE_H
#define SPH_CONFORMANCE_H

#include "sphfill.h"
#include "sphimpl.h"
#include "sphlink.h"

typedef struct {
  const char *name;
  int dim;
  int n[3];              /* fluid sites per axis */
  PetscBool periodic[3]; /* axes without walls, closed on themselves */
  SphKernelType kernel;
  SphWallType wall;
  SphViscosityType viscosity;
  SphDiffusionType diffusion;
  SphReinitType reinit;
  SphIntegratorType integrator;
  double zeta, pb, gamma, hratio;
} Scene;

/* Deterministic pseudo-random number in [-1, 1): the minimal standard generator of Park and Miller (1988). */
static inline double Noise(unsigned *seed)
{
  *seed = (unsigned)(((unsigned long long)*seed * 16807ull) % 2147483647ull);
  return 2.0 * (double)*seed / 2147483647.0 - 1.0;
}

#define SCENE_DP 0.02
#define SCENE_CS 20.0

static const double scene_velocity[3] = {0.4, -0.2, 0.1}, scene_acceleration[3] = {1.5, -2.0, 1.5};

/* Centre and half width of the hole for the body: about the middle of the fluid. */
static inline void SceneBody(const Scene *c, PetscReal body[4])
{
  for (int k = 0; k < 3; k++) body[k] = k < c->dim ? c->n[k] / 2 * SCENE_DP : 0.0;
  body[3] = 1.01 * SCENE_DP;
}

static inline PetscErrorCode SceneBodyMarkers(const Scene *c, const PetscReal body[4], PetscInt *n, PetscReal **x)
{
  const double dp = SCENE_DP;

  PetscFunctionBegin;
  PetscCall(SphFillBox(c->dim, dp, (PetscReal[3]){body[0] - dp, body[1] - dp, body[2] - dp},
                       (PetscReal[3]){body[0] + dp, body[1] + dp, body[2] + dp}, NULL, NULL, n, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscBool OutsideBody(const PetscReal x[3], void *ctx)
{
  const PetscReal *b = (const PetscReal *)ctx;
  for (int k = 0; k < 3; k++)
    if (fabs(x[k] - b[k]) > b[3]) return PETSC_TRUE;
  return PETSC_FALSE;
}

static inline PetscErrorCode SceneParameters(Sph sph, const Scene *c, const char *type, SphPrecision precision)
{
  const double dp = SCENE_DP;
  const PetscReal lo[3] = {0.0, 0.0, 0.0}, hi[3] = {c->n[0] * dp, 1.5 * c->n[1] * dp, c->n[2] * dp}, f[3] = {0.3, -9.81, 0.0};

  PetscFunctionBegin;
  PetscCall(SphSetType(sph, type));
  PetscCall(SphSetDimension(sph, c->dim));
  PetscCall(SphSetSpacing(sph, dp));
  PetscCall(SphSetSmoothingRatio(sph, c->hratio));
  PetscCall(SphSetDensity(sph, 1000.0));
  PetscCall(SphSetViscosity(sph, 0.5));
  PetscCall(SphSetSoundSpeed(sph, SCENE_CS));
  PetscCall(SphSetGamma(sph, c->gamma));
  PetscCall(SphSetBackgroundPressure(sph, c->pb));
  PetscCall(SphSetXSPH(sph, c->zeta));
  PetscCall(SphSetBodyForce(sph, f));
  PetscCall(SphSetDomain(sph, lo, hi));
  PetscCall(SphSetPeriodic(sph, c->periodic));
  PetscCall(SphSetKernel(sph, c->kernel));
  PetscCall(SphSetWall(sph, c->wall));
  PetscCall(SphSetViscosityType(sph, c->viscosity));
  PetscCall(SphSetDensityDiffusion(sph, c->diffusion, 0.1));
  PetscCall(SphSetIntegrator(sph, c->integrator));
  PetscCall(SphSetDensityReinit(sph, c->reinit, 4));
  PetscCall(SphSetPrecision(sph, precision));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Boundary markers of the group: a lattice of n markers at x with one depth each. */
static inline PetscErrorCode SceneBoundary(Sph sph, PetscInt n, const PetscReal *x, const PetscReal *vol, const PetscReal *depth,
                                           const PetscReal v0[3])
{
  PetscReal *v;
  PetscInt g;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * (size_t)n, &v));
  for (PetscInt i = 0; i < 3 * n; i++) v[i] = v0[i % 3];
  PetscCall(SphAddBoundary(sph, n, x, v, vol, depth, &g));
  PetscCall(PetscFree(v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fluid over a floor, walls on the sides that are not periodic, open top; a block of 2 x 2 (x 2) body markers inside: group 1. */
static inline PetscErrorCode SceneCreate(const Scene *c, const char *type, SphPrecision precision, Sph *out)
{
  const double dp = SCENE_DP, q = 0.2 * dp;
  const PetscReal lo[3] = {0.0, 0.0, 0.0}, hi[3] = {c->n[0] * dp, c->n[1] * dp, c->n[2] * dp};
  const PetscReal rest[3] = {0.0, 0.0, 0.0},
                  moving[3] = {scene_velocity[0], scene_velocity[1], c->dim == 3 ? scene_velocity[2] : 0.0};
  const PetscBool face[6] = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE, PETSC_FALSE, c->dim == 3, c->dim == 3};
  PetscReal body[4], *x, *v, *p, *vol, *depth, support;
  PetscInt n;
  unsigned seed = 12345;
  Sph sph;

  PetscFunctionBegin;
  SceneBody(c, body);
  PetscCall(SphCreate(PETSC_COMM_SELF, &sph));
  PetscCall(SceneParameters(sph, c, type, precision));
  PetscCall(SphFillBox(c->dim, dp, lo, hi, OutsideBody, body, &n, &x));
  PetscCall(PetscMalloc2(3 * (size_t)n, &v, n, &p));
  for (PetscInt i = 0; i < n; i++) {
    for (int k = 0; k < 3; k++) {
      v[3 * i + k] = k < c->dim ? Noise(&seed) : 0.0;
      x[3 * i + k] += k < c->dim ? q * Noise(&seed) : 0.0;
    }
    p[i] = 3000.0 * Noise(&seed); /* up to 0.75 % compression */
  }
  PetscCall(SphAddFluid(sph, n, x, v, p));
  PetscCall(PetscFree2(v, p));
  PetscCall(PetscFree(x));
  PetscCall(SphGetSupport(sph, &support));
  PetscCall(SphFillWalls(c->dim, dp, lo, hi, face, c->periodic, support, &n, &x, &vol, &depth));
  PetscCall(SceneBoundary(sph, n, x, vol, depth, rest));
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(vol));
  PetscCall(PetscFree(depth));
  PetscCall(SceneBodyMarkers(c, body, &n, &x));
  PetscCall(PetscMalloc2(n, &vol, n, &depth));
  for (PetscInt i = 0; i < n; i++) {
    vol[i] = pow(dp, c->dim);
    depth[i] = 0.5 * dp;
  }
  PetscCall(SceneBoundary(sph, n, x, vol, depth, moving));
  PetscCall(PetscFree2(vol, depth));
  PetscCall(PetscFree(x));
  *out = sph;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How group 1 may be linked (sphlink.h): not; to a rigid body; to four nodes, affinely. */
typedef enum { SCENE_FREE, SCENE_BODY, SCENE_NODES } SceneLink;

/* Its markers in the body's frame, n x 3. */
static inline PetscErrorCode SceneOffsets(const Scene *c, PetscInt *n, PetscReal **o)
{
  PetscReal body[4];

  PetscFunctionBegin;
  SceneBody(c, body);
  PetscCall(SceneBodyMarkers(c, body, n, o));
  for (PetscInt i = 0; i < 3 * *n; i++) (*o)[i] -= body[i % 3];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes: the centre, and one at a distance of 1 along each axis. */
static inline PetscErrorCode SceneSetLink(Sph sph, const Scene *c, SceneLink link)
{
  PetscReal *o, *shape, *zero;
  PetscInt n, *rowstart, *node, *section;
  SphLinkSpec spec = {0};

  PetscFunctionBegin;
  if (link == SCENE_FREE) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SceneOffsets(c, &n, &o));
  PetscCall(PetscMalloc4(n + 1, &rowstart, 4 * (size_t)n, &node, n, &section, 4 * (size_t)n, &shape));
  PetscCall(PetscCalloc1(3 * (size_t)n, &zero));
  rowstart[0] = 0;
  for (PetscInt i = 0; i < n; i++) {
    rowstart[i + 1] = 4 * (i + 1);
    section[i] = i;
    for (int j = 0; j < 4; j++) node[4 * i + j] = j;
    shape[4 * i] = 1.0 - o[3 * i] - o[3 * i + 1] - o[3 * i + 2];
    for (int j = 0; j < 3; j++) shape[4 * i + 1 + j] = o[3 * i + j];
  }
  spec.nsections = link == SCENE_BODY ? 1 : n;
  spec.offset = link == SCENE_BODY ? o : zero;
  if (link == SCENE_NODES) {
    spec.nnodes = 4;
    spec.rowstart = rowstart;
    spec.node = node;
    spec.shape = shape;
    spec.section = section;
  }
  PetscCall(SphSetGroupLink(sph, 1, &spec));
  PetscCall(PetscFree4(rowstart, node, section, shape));
  PetscCall(PetscFree(zero));
  PetscCall(PetscFree(o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The motion of SceneMoveBody() as a state of the link. */
static inline PetscErrorCode SceneSetState(Sph sph, const Scene *c, double t)
{
  PetscReal body[4], state[36] = {0.0};
  PetscInt nstate;

  PetscFunctionBegin;
  SceneBody(c, body);
  PetscCall(SphGetGroupLinkSize(sph, 1, &nstate, NULL));
  for (int k = 0; k < 3; k++) {
    const double a = k < c->dim ? scene_acceleration[k] : 0.0, v = (k < c->dim ? scene_velocity[k] : 0.0) + a * t,
                 x = body[k] + (v - 0.5 * a * t) * t;
    if (nstate == 24) {
      state[k] = x;
      state[3 + k] = v;
      state[6 + k] = a;
      state[15 + 4 * k] = 1.0;
    } else
      for (int j = 0; j < 4; j++) {
        state[3 * j + k] = x + (j == k + 1 ? 1.0 : 0.0);
        state[12 + 3 * j + k] = v;
        state[24 + 3 * j + k] = a;
      }
  }
  PetscCall(SphSetGroupState(sph, 1, state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Motion of group 1 at time t: constant acceleration. Nothing is read back, as in a coupled run. */
static inline PetscErrorCode SceneMoveBody(Sph sph, const Scene *c, double t)
{
  PetscReal body[4], *x, *v, *a;
  PetscInt n;

  PetscFunctionBegin;
  if (SphIsLinked(sph, 1)) {
    PetscCall(SceneSetState(sph, c, t));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  SceneBody(c, body);
  PetscCall(SceneBodyMarkers(c, body, &n, &x));
  PetscCall(PetscMalloc2(3 * (size_t)n, &v, 3 * (size_t)n, &a));
  for (PetscInt i = 0; i < 3 * n; i++) {
    a[i] = i % 3 < c->dim ? scene_acceleration[i % 3] : 0.0;
    v[i] = (i % 3 < c->dim ? scene_velocity[i % 3] : 0.0) + a[i] * t;
    x[i] += (v[i] - 0.5 * a[i] * t) * t;
  }
  PetscCall(SphSetBoundaryMotion(sph, 1, x, v, a));
  PetscCall(PetscFree2(v, a));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Group 1 turns where it is, whatever its velocities say: for the velocity that walls lend. */
static inline PetscErrorCode SceneTurnBody(Sph sph, const Scene *c)
{
  PetscReal body[4], *x, *w;
  PetscInt n;

  PetscFunctionBegin;
  SceneBody(c, body);
  PetscCall(SceneBodyMarkers(c, body, &n, &x));
  PetscCall(PetscMalloc1(3 * (size_t)n, &w));
  for (PetscInt i = 0; i < 3 * n; i++) w[i] = c->dim == 3 || i % 3 == 2 ? 5.0 * (PetscReal)(i % 3) - 4.0 : 0.0;
  PetscCall(SphSetBoundaryRotation(sph, 1, w));
  PetscCall(PetscFree(w));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One whole step with a moving body. */
static inline PetscErrorCode SceneStep(Sph sph, const Scene *c, double dt)
{
  PetscReal t;

  PetscFunctionBegin;
  PetscCall(SphGetTime(sph, &t, NULL));
  PetscCall(SphStepBegin(sph, dt));
  PetscCall(SceneMoveBody(sph, c, t + 0.5 * dt));
  PetscCall(SphStepEnd(sph));
  PetscCall(SceneMoveBody(sph, c, t + dt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#endif
