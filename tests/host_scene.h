/*
  host_scene.h - one small tank for the tests of host bodies and of rolling back: water over a floor, periodic sideways, with a
  beam clamped at the floor, a free ball, and a lid of markers that glides.

  The beam's surface is either the one built in, or made through the host interface from rows of its own.
*/
#ifndef HOST_SCENE_H
#define HOST_SCENE_H

#include "couplehost.h"
#include "sphfill.h"
#include "testing.h"

#define DP 0.04
static const PetscReal scene_hi[3] = {0.4, 0.32, 0.4};
static const double scene_beam[3] = {0.14, 0.16, 0.24}, scene_ball[3] = {0.28, 0.16, 0.2}; /* foot and length; centre */

typedef struct {
  Sph sph;
  Ancf ancf;
  Rigid rigid;
  Couple couple;
  PetscInt beam; /* number of the beam's surface */
} Scene;

static PetscBool SceneKeep(const PetscReal x[3], void *ctx)
{
  const double bx = x[0] - scene_beam[0], by = x[1] - scene_beam[1], cx = x[0] - scene_ball[0], cy = x[1] - scene_ball[1],
               cz = x[2] - scene_ball[2];
  (void)ctx;
  if (bx * bx + by * by < 0.04 * 0.04 && x[2] < scene_beam[2]) return PETSC_FALSE;
  return cx * cx + cy * cy + cz * cz < 0.06 * 0.06 ? PETSC_FALSE : PETSC_TRUE;
}

static PetscErrorCode SceneFluid(Sph *out)
{
  const PetscReal lo[3] = {0, 0, 0}, f[3] = {0.5, 0, -9.81};
  const PetscBool periodic[3] = {PETSC_TRUE, PETSC_TRUE, PETSC_FALSE};
  PetscReal *x, *v, *p;
  PetscInt n;
  Sph sph;

  PetscFunctionBegin;
  PetscCall(SphCreate(PETSC_COMM_SELF, &sph));
  PetscCall(SphSetDimension(sph, 3));
  PetscCall(SphSetSpacing(sph, DP));
  PetscCall(SphSetSmoothingRatio(sph, 1.3));
  PetscCall(SphSetViscosity(sph, 1.0));
  PetscCall(SphSetMaxSpeed(sph, 2.0));
  PetscCall(SphSetBodyForce(sph, f));
  PetscCall(SphSetDomain(sph, lo, scene_hi));
  PetscCall(SphSetPeriodic(sph, periodic));
  PetscCall(SphSetFromOptions(sph));
  PetscCall(SphFillBox(3, DP, lo, scene_hi, SceneKeep, NULL, &n, &x));
  PetscCall(PetscMalloc2(3 * (size_t)n, &v, n, &p));
  for (PetscInt i = 0; i < n; i++) {
    p[i] = 1000.0 * 9.81 * (scene_hi[2] - x[3 * i + 2]);
    v[3 * i] = x[3 * i + 2];
    v[3 * i + 1] = 0.2;
    v[3 * i + 2] = 0.0;
  }
  PetscCall(SphAddFluid(sph, n, x, v, p));
  PetscCall(PetscFree2(v, p));
  PetscCall(PetscFree(x));
  *out = sph;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneWall(Sph sph, Couple couple, int face, const PetscReal velocity[3])
{
  const PetscReal lo[3] = {0, 0, 0};
  const PetscBool periodic[3] = {PETSC_TRUE, PETSC_TRUE, PETSC_FALSE};
  PetscBool faces[6] = {PETSC_FALSE};
  PetscReal *x, *volume, *depth, support;
  PetscInt n;
  CoupleSurface wall;

  PetscFunctionBegin;
  faces[face] = PETSC_TRUE;
  PetscCall(SphGetSupport(sph, &support));
  PetscCall(SphFillWalls(3, DP, lo, scene_hi, faces, periodic, support, &n, &x, &volume, &depth));
  PetscCall(CoupleSurfaceCreateWall(PETSC_COMM_SELF, face == 4 ? "floor" : "lid", n, x, volume, depth, velocity, &wall));
  PetscCall(CoupleAddSurface(couple, wall));
  PetscCall(CoupleSurfaceDestroy(&wall));
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(volume));
  PetscCall(PetscFree(depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneBeam(Ancf *out)
{
  const PetscReal g[3] = {0, 0, -9.81};
  AncfBeamSpec spec;
  Ancf ancf;

  PetscFunctionBegin;
  PetscCall(AncfCreate(PETSC_COMM_SELF, &ancf));
  PetscCall(AncfBeamSpecInit(&spec));
  for (int k = 0; k < 3; k++) spec.start[k] = spec.end[k] = k < 2 ? scene_beam[k] : 0.0;
  spec.end[2] = scene_beam[2];
  spec.elements = 3;
  spec.diameter = 0.08;
  spec.density = 1500.0;
  spec.young = 1e5;
  spec.end0 = ANCF_END_CLAMP;
  PetscCall(AncfAddBeam(ancf, &spec, NULL));
  PetscCall(AncfSetGravity(ancf, g));
  PetscCall(AncfSetSubsteps(ancf, 2));
  PetscCall(AncfSetFromOptions(ancf));
  PetscCall(AncfSetUp(ancf));
  *out = ancf;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneBall(Rigid *out)
{
  const PetscReal g[3] = {0, 0, -9.81};
  RigidBodySpec spec;
  Rigid rigid;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &rigid));
  PetscCall(RigidBodySpecInit(&spec));
  spec.shape = RIGID_SPHERE;
  spec.motion = RIGID_FREE;
  spec.size[0] = 0.06;
  spec.density = 800.0;
  for (int k = 0; k < 3; k++) {
    spec.position[k] = scene_ball[k];
    spec.omega[k] = 1.0 + k;
  }
  PetscCall(RigidAddBody(rigid, &spec, NULL));
  PetscCall(RigidSetGravity(rigid, g));
  PetscCall(RigidSetUp(rigid));
  *out = rigid;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* beamsurface makes the surface of the beam. */
static PetscErrorCode SceneCreate(PetscErrorCode (*beamsurface)(Ancf, PetscReal, CoupleSurface *), Scene *s)
{
  const PetscReal rest[3] = {0, 0, 0}, glide[3] = {0.3, 0, 0};
  PetscReal support;
  CoupleSurface surface;

  PetscFunctionBegin;
  PetscCall(SceneFluid(&s->sph));
  PetscCall(SceneBeam(&s->ancf));
  PetscCall(SceneBall(&s->rigid));
  PetscCall(CoupleCreate(PETSC_COMM_SELF, &s->couple));
  PetscCall(CoupleSetSph(s->couple, s->sph));
  PetscCall(SceneWall(s->sph, s->couple, 4, rest));
  PetscCall(SceneWall(s->sph, s->couple, 5, glide));
  PetscCall(SphGetSupport(s->sph, &support));
  s->beam = 2;
  PetscCall((*beamsurface)(s->ancf, support, &surface));
  PetscCall(CoupleAddSurface(s->couple, surface));
  PetscCall(CoupleSurfaceDestroy(&surface));
  PetscCall(CoupleSurfaceCreateRigid(s->rigid, 0, 3, DP, support, &surface));
  PetscCall(CoupleAddSurface(s->couple, surface));
  PetscCall(CoupleSurfaceDestroy(&surface));
  PetscCall(CoupleSetUp(s->couple));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SceneDestroy(Scene *s)
{
  PetscFunctionBegin;
  PetscCall(CoupleDestroy(&s->couple));
  PetscCall(SphDestroy(&s->sph));
  PetscCall(AncfDestroy(&s->ancf));
  PetscCall(RigidDestroy(&s->rigid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscErrorCode BuiltinBeam(Ancf ancf, PetscReal support, CoupleSurface *surface)
{
  PetscFunctionBegin;
  PetscCall(CoupleSurfaceCreateBeam(ancf, 0, 3, DP, support, surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Every number of the state, one after the other. */
static PetscErrorCode SceneNumbers(Scene *s, PetscInt *n, PetscReal **numbers)
{
  const PetscReal *e, *v, *a;
  PetscInt nf, nb, m, nodes, pack;
  PetscReal *p;

  PetscFunctionBegin;
  PetscCall(SphGetCounts(s->sph, &nf, &nb, NULL));
  PetscCall(AncfGetNumNodes(s->ancf, &nodes));
  PetscCall(RigidGetPackSize(s->rigid, &pack));
  m = nf + nb;
  *n = 11 * m + 18 * nodes + pack;
  PetscCall(PetscMalloc1(*n, numbers));
  p = *numbers;
  PetscCall(SphGetFields(s->sph, &(SphFields){.x = p, .v = p + 3 * m, .a = p + 6 * m, .rho = p + 9 * m, .p = p + 10 * m}));
  p += 11 * m;
  PetscCall(AncfGetState(s->ancf, NULL, &e, &v, &a));
  PetscCall(PetscArraycpy(p, e, 6 * nodes));
  PetscCall(PetscArraycpy(p + 6 * nodes, v, 6 * nodes));
  PetscCall(PetscArraycpy(p + 12 * nodes, a, 6 * nodes));
  PetscCall(RigidPack(s->rigid, p + 18 * nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How many of the n numbers differ in any bit. */
static inline PetscInt DifferentBits(PetscInt n, const PetscReal *a, const PetscReal *b)
{
  PetscInt d = 0;
  for (PetscInt i = 0; i < n; i++) d += memcmp(a + i, b + i, sizeof(*a)) != 0;
  return d;
}

#endif
