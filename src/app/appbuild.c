/* appbuild.c - the solver objects of a scene, and one step of them. */
#include "app.h"
#include "sphfill.h"
#include "sphopen.h"
#include <string.h>

static PetscErrorCode build_sph(App *app)
{
  AppScene *s = &app->scene;

  PetscFunctionBegin;
  app->dim = 3;
  if (!s->fluid) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SphCreate(PETSC_COMM_SELF, &app->sph));
  PetscCall(SphSetFromOptions(app->sph));
  PetscCall(SphGetDimension(app->sph, &app->dim));
  PetscCall(AppSceneCheck(s, app->dim));
  PetscCall(SphSetDomain(app->sph, s->lo, s->hi));
  PetscCall(SphSetPeriodic(app->sph, s->periodic));
  PetscCall(AppBodyForce(app));
  PetscCall(AppRegionsSetUp(app));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* In 2D a beam is a plate of thickness d, for one metre of depth: A = d, I = d^3/12 unless stiffness and mass are given. */
static PetscErrorCode plate_section(AncfBeamSpec *spec)
{
  const PetscReal d = spec->diameter;

  PetscFunctionBegin;
  if (!(d > 0 && spec->young > 0 && spec->density > 0))
    PetscFunctionReturn(PETSC_SUCCESS); /* AncfAddBeam() refuses it or does not need it */
  if (spec->EA == PETSC_DECIDE) spec->EA = spec->young * d;
  if (spec->EI == PETSC_DECIDE) spec->EI = spec->young * d * d * d / 12;
  if (spec->rhoA == PETSC_DECIDE) spec->rhoA = spec->density * d;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode build_beams(App *app, PetscReal rho)
{
  AppScene *s = &app->scene;

  PetscFunctionBegin;
  if (!s->nbeams && !s->nlinks) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(app->dim == 3 || rho == 0, PETSC_COMM_SELF, PETSC_ERR_SUP,
             "buoyancy archimedes is not there for beams in a 2D scene: use resolved");
  PetscCall(AncfCreate(PETSC_COMM_SELF, &app->ancf));
  PetscCall(AncfSetGravity(app->ancf, s->gravity));
  PetscCall(AncfSetFluidDensity(app->ancf, rho));
  for (PetscInt b = 0; b < s->nbeams; b++) {
    AppDoing(app, "beam '%s'", s->beams[b].name);
    if (app->dim == 2) PetscCall(plate_section(&s->beams[b].spec));
    PetscCheck(s->beams[b].spec.width == 0 || (!s->fluid && app->dim == 3), PETSC_COMM_SELF, PETSC_ERR_SUP,
               "beam_%s_width = %g m: beams in a fluid are round, and plates in 2D; give diameter, EA, EI and rhoA",
               s->beams[b].name, (double)s->beams[b].spec.width);
    PetscCheck(s->beams[b].spec.inner == 0 || app->dim == 3, PETSC_COMM_SELF, PETSC_ERR_SUP,
               "beam_%s_inner = %g m: in 2D a beam is a plate; give EA, EI and rhoA", s->beams[b].name,
               (double)s->beams[b].spec.inner);
    PetscCall(AncfAddBeam(app->ancf, &s->beams[b].spec, NULL));
    AppDoing(app, "%s", "");
  }
  PetscCall(AppBuildLinks(app));
  PetscCall(AncfSetFromOptions(app->ancf));
  PetscCall(AppSetUpBeams(app));
  PetscCall(AppBuildBeamLoads(app));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode build_bodies(App *app, PetscReal rho)
{
  AppScene *s = &app->scene;
  PetscReal dp = 0;

  PetscFunctionBegin;
  if (!s->nbodies && !s->nlumped) PetscFunctionReturn(PETSC_SUCCESS);
  if (app->sph) PetscCall(SphGetSpacing(app->sph, &dp));
  PetscCall(RigidCreate(PETSC_COMM_SELF, &app->rigid));
  PetscCall(RigidSetDimension(app->rigid, app->dim));
  PetscCall(RigidSetGravity(app->rigid, s->gravity));
  PetscCall(RigidSetFluidDensity(app->rigid, rho));
  PetscCall(AppBuildShortRange(app));
  PetscCall(RigidSetFromOptions(app->rigid));
  for (PetscInt b = 0; b < s->nbodies; b++) {
    RigidBodySpec *spec = &s->bodies[b].spec;
    RigidGeometry mesh = NULL;
    AppDoing(app, "body '%s'", s->bodies[b].name);
    if (spec->shape == RIGID_MESH)
      PetscCall(RigidGeometryCreateFile(PETSC_COMM_SELF, s->bodies[b].file, s->bodies[b].scale, &mesh));
    spec->geometry = mesh;
    PetscCall(RigidAddBody(app->rigid, spec, NULL));
    if (s->bodies[b].owngravity) PetscCall(RigidSetBodyGravity(app->rigid, b, s->bodies[b].gravity));
    PetscCall(RigidSetBodyLoad(app->rigid, b, s->bodies[b].load, s->bodies[b].torque));
    PetscCall(RigidGeometryDestroy(&mesh)); /* the body keeps its own reference */
    PetscCall(RigidGetBody(app->rigid, b, spec));
    if (app->sph) PetscCall(RigidFillCheck(spec, app->dim, dp));
    AppDoing(app, "%s", "");
  }
  PetscCall(AppBuildLumped(app));
  PetscCall(AppBuildJoints(app));
  PetscCall(RigidSetUp(app->rigid));
  PetscCall(AppCheckOverlap(app));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode build_structures(App *app)
{
  PetscReal rho = 0;

  PetscFunctionBegin;
  if (app->sph && app->scene.buoyancy == BUOYANCY_ARCHIMEDES) PetscCall(SphGetDensity(app->sph, &rho));
  PetscCall(build_beams(app, rho));
  PetscCall(build_bodies(app, rho));
  PetscCall(AppBuildAttach(app));
  PetscCall(AppBuildShortBeams(app));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* --- surfaces -------------------------------------------------------------------------------------------------- */

static PetscErrorCode add_surface(App *app, AppSurfaceKind kind, const char name[], CoupleSurface surface)
{
  AppSurface *at = &app->surfaces[app->nsurfaces++];

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(at->name, name, sizeof(at->name)));
  at->surface = surface;
  at->kind = kind;
  PetscCall(CoupleAddSurface(app->couple, surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The face that a wall marker belongs to: of those it lies outside of, one at rest before one that moves. */
static PetscInt wall_face(const AppScene *s, PetscInt dim, const PetscReal x[3])
{
  PetscInt moving = -1;

  for (PetscInt f = 0; f < 2 * dim; f++) {
    const PetscReal *v = s->wallvelocity[f];
    PetscBool outside = (PetscBool)(f % 2 ? x[f / 2] > s->hi[f / 2] : x[f / 2] < s->lo[f / 2]);
    if (!s->wall[f] || !outside) continue;
    if (v[0] == 0 && v[1] == 0 && v[2] == 0 && !s->walls[f].motion[0]) return f;
    moving = f;
  }
  return moving;
}

/* A wall of n markers (x: n x 3, m; volume: n; depth: n, m; all copied) with a velocity (m/s) along itself. */
static PetscErrorCode create_wall(const char name[], PetscInt n, const PetscReal *x, const PetscReal *volume,
                                  const PetscReal *depth, const PetscReal velocity[3], CoupleSurface *surface)
{
  PetscFunctionBegin;
  PetscCall(CoupleSurfaceCreateWall(PETSC_COMM_SELF, name, n, x, volume, depth, velocity, surface));
  PetscCall(CoupleSurfaceSetSliding(*surface, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode add_walls(App *app)
{
  AppScene *s = &app->scene;
  PetscInt n = 0, m;
  PetscReal dp, support, *x, *volume, *depth, *fx, *fvolume, *fdepth, lo[3], hi[3];
  CoupleSurface surface;
  char name[APP_NAME_LEN];
  PetscBool any = PETSC_FALSE;

  PetscFunctionBegin;
  for (int f = 0; f < 6; f++) any = (PetscBool)(any || s->wall[f]);
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SphGetSpacing(app->sph, &dp));
  PetscCall(SphGetSupport(app->sph, &support));
  for (PetscInt f = 0; f < 6; f++) { /* walls go on beside the zones of openings */
    PetscReal beyond;
    PetscCall(AppOpeningDepth(app, f, &beyond));
    if (f % 2)
      hi[f / 2] = s->hi[f / 2] + beyond;
    else
      lo[f / 2] = s->lo[f / 2] - beyond;
  }
  PetscCall(SphFillWalls(app->dim, dp, lo, hi, s->wall, s->periodic, support, &n, &x, &volume, &depth));
  PetscCall(PetscMalloc3(3 * (size_t)n, &fx, n, &fvolume, n, &fdepth));
  for (PetscInt f = 0; f < 6; f++) {
    m = 0;
    for (PetscInt i = 0; i < n && s->wall[f]; i++) {
      PetscBool open;
      if (wall_face(s, app->dim, x + 3 * i) != f) continue;
      PetscCall(SphInOpening(app->sph, x + 3 * i, &open));
      if (open) continue;
      PetscCall(PetscArraycpy(fx + 3 * m, x + 3 * i, 3));
      fvolume[m] = volume[i];
      fdepth[m++] = depth[i];
    }
    if (!m) continue;
    PetscCall(PetscSNPrintf(name, sizeof(name), "wall_%s", SceneFaces[f]));
    if (s->walls[f].motion[0])
      PetscCall(AppWallCreateMoving(app, f, name, m, fx, fvolume, fdepth, &surface));
    else
      PetscCall(create_wall(name, m, fx, fvolume, fdepth, s->wallvelocity[f], &surface));
    PetscCall(add_surface(app, SURFACE_WALL, name, surface));
  }
  PetscCall(PetscFree3(fx, fvolume, fdepth));
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(volume));
  PetscCall(PetscFree(depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The walls around regions, one surface each. */
static PetscErrorCode add_region_walls(App *app)
{
  const AppScene *s = &app->scene;
  const PetscReal rest[3] = {0, 0, 0};
  PetscInt n, *owner;
  PetscReal *x, *volume, *depth, *rx, *rvolume, *rdepth;
  CoupleSurface surface;
  char name[APP_NAME_LEN + 8];

  PetscFunctionBegin;
  if (!s->nregions) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AppRegionWalls(app, &n, &x, &volume, &depth, &owner));
  PetscCall(PetscMalloc3(3 * (size_t)n, &rx, n, &rvolume, n, &rdepth));
  for (PetscInt r = 0; r < s->nregions; r++) {
    PetscInt m = 0;
    for (PetscInt i = 0; i < n; i++) {
      if (owner[i] != r) continue;
      PetscCall(PetscArraycpy(rx + 3 * m, x + 3 * i, 3));
      rvolume[m] = volume[i];
      rdepth[m++] = depth[i];
    }
    if (!m) continue;
    PetscCall(PetscSNPrintf(name, sizeof(name), "region_%s", s->regions[r].name));
    PetscCall(create_wall(name, m, rx, rvolume, rdepth, rest, &surface));
    PetscCall(add_surface(app, SURFACE_WALL, name, surface));
  }
  PetscCall(PetscFree3(rx, rvolume, rdepth));
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(volume));
  PetscCall(PetscFree(depth));
  PetscCall(PetscFree(owner));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How many markers each surface has. */
static PetscErrorCode count_surfaces(App *app)
{
  PetscInt n, group, *groups;
  SphFields f;

  PetscFunctionBegin;
  PetscCall(SphGetCounts(app->sph, &app->nfluid, &app->nboundary, NULL));
  n = app->nfluid + app->nboundary;
  PetscCall(PetscMalloc1(n, &groups));
  PetscCall(PetscMemzero(&f, sizeof(f)));
  f.group = groups;
  PetscCall(SphGetFields(app->sph, &f));
  for (PetscInt i = 0; i < app->nsurfaces; i++) {
    PetscCall(CoupleGetSurface(app->couple, i, NULL, &group));
    app->surfaces[i].markers = 0;
    app->surfaces[i].group = group;
    for (PetscInt k = 0; k < n; k++) app->surfaces[i].markers += groups[k] == group;
  }
  PetscCall(PetscFree(groups));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A structure that lies outside of the domain as a whole would never meet the fluid. */
static PetscErrorCode check_places(const App *app)
{
  const AppScene *s = &app->scene;

  PetscFunctionBegin;
  for (PetscInt a = 0; a < app->dim; a++) {
    if (s->periodic[a]) continue;
    for (PetscInt b = 0; b < s->nbeams; b++) {
      const AncfBeamSpec *spec = &s->beams[b].spec;
      PetscCheck(PetscMax(spec->start[a], spec->end[a]) > s->lo[a] && PetscMin(spec->start[a], spec->end[a]) < s->hi[a],
                 PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
                 "beam '%s' lies outside of the domain along %c (%g to %g m; the domain: %g to %g m)", s->beams[b].name, "xyz"[a],
                 (double)spec -> start[a], (double)spec -> end[a], (double)s -> lo[a], (double)s -> hi[a]);
    }
    for (PetscInt b = 0; b < s->nbodies; b++) {
      const PetscReal x = s->bodies[b].spec.position[a];
      PetscCheck(x > s->lo[a] && x < s->hi[a], PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
                 "body '%s': its centre, %c = %g m, lies outside of the domain (%g to %g m)", s->bodies[b].name, "xyz"[a],
                 (double)x, (double)s -> lo[a], (double)s -> hi[a]);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode build_couple(App *app)
{
  AppScene *s = &app->scene;
  PetscReal dp, support, dt, brought;
  PetscInt zone;
  CoupleSurface surface;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1((size_t)(6 + s->nregions + s->nbeams + s->nbodies), &app->surfaces));
  if (!s->fluid) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CoupleCreate(PETSC_COMM_SELF, &app->couple));
  PetscCall(CoupleSetSph(app->couple, app->sph));
  PetscCall(CoupleSetFromOptions(app->couple));
  PetscCall(CoupleSetShort(app->couple, app->shortrange));
  PetscCall(CoupleSetAttach(app->couple, app->attach));
  PetscCall(check_places(app));
  PetscCall(AppBuildOpenings(app, &brought, &zone));
  PetscCall(AppFluidFill(app));
  PetscCall(AppBuildReserve(app, brought, zone));
  PetscCall(add_walls(app));
  PetscCall(add_region_walls(app));
  PetscCall(SphGetSpacing(app->sph, &dp));
  PetscCall(SphGetSupport(app->sph, &support));
  for (PetscInt b = 0; b < s->nbeams; b++) {
    AppDoing(app, "beam '%s'", s->beams[b].name);
    PetscCall(CoupleSurfaceCreateBeam(app->ancf, b, app->dim, dp, support, &surface));
    PetscCall(add_surface(app, SURFACE_BEAM, s->beams[b].name, surface));
  }
  for (PetscInt b = 0; b < s->nbodies; b++) {
    AppDoing(app, "body '%s'", s->bodies[b].name);
    PetscCall(CoupleSurfaceCreateRigid(app->rigid, b, app->dim, dp, support, &surface));
    PetscCall(add_surface(app, SURFACE_BODY, s->bodies[b].name, surface));
  }
  AppDoing(app, "%s", "");
  PetscCall(CoupleSetUp(app->couple));
  PetscCall(SphComputeTimeStep(app->sph, &dt)); /* refuses a fixed one that is not stable, before any file is made */
  PetscCall(count_surfaces(app));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Make and set up everything that app->scene asks for. */
PetscErrorCode AppBuild(App *app)
{
  PetscFunctionBegin;
  PetscCall(build_sph(app));
  PetscCall(build_structures(app));
  PetscCall(build_couple(app));
  PetscCall(AppProbesSetUp(app));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppDestroy(App *app)
{
  PetscFunctionBegin;
  PetscCall(CoupleDestroy(&app->couple));
  for (PetscInt i = 0; i < app->nsurfaces; i++) PetscCall(CoupleSurfaceDestroy(&app->surfaces[i].surface));
  PetscCall(PetscFree(app->surfaces));
  PetscCall(SphDestroy(&app->sph));
  PetscCall(CoupleShortDestroy(&app->shortrange));
  PetscCall(CoupleAttachDestroy(&app->attach));
  PetscCall(AncfDestroy(&app->ancf));
  PetscCall(RigidDestroy(&app->rigid));
  for (int f = 0; f < 6; f++) PetscCall(RigidDestroy(&app->mover[f]));
  PetscCall(AppSceneDestroy(&app->scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* --- stepping -------------------------------------------------------------------------------------------------- */

/* One step, not past tmax (s); dt (s) is the step taken. */
PetscErrorCode AppStep(App *app, PetscReal tmax, PetscReal *dt)
{
  PetscReal t;

  PetscFunctionBegin;
  PetscCall(AppUpdateBeamLoads(app));
  if (app->couple) {
    PetscCall(CoupleStep(app->couple, tmax, dt));
    PetscCall(CoupleGetTime(app->couple, &app->t, &app->step));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  t = app->t + app->scene.dt;
  if (t > tmax - 1e-9 * app->scene.dt) t = tmax;
  if (app->shortrange) {
    PetscCall(AncfZeroLoads(app->ancf));
    PetscCall(CoupleShortApply(app->shortrange, t - app->t));
  }
  if (app->attach) PetscCall(CoupleAttachAdvance(app->attach, t));
  if (app->ancf && !app->attach) PetscCall(AncfAdvance(app->ancf, t));
  if (app->rigid && !app->attach) PetscCall(RigidAdvance(app->rigid, t));
  if (app->shortrange) PetscCall(CoupleShortRemove(app->shortrange));
  *dt = t - app->t;
  app->t = t;
  app->step++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppBeamPoint(App *app, PetscInt beam, PetscReal s, PetscReal r[3], PetscReal v[3], PetscReal rx[3])
{
  const PetscReal *e, *edot;
  PetscReal l, S[4], Sx[4];
  PetscInt first, k, ne = app->scene.beams[beam].spec.elements;

  PetscFunctionBegin;
  PetscCall(AncfGetBeam(app->ancf, beam, NULL, &first, &l));
  PetscCall(AncfGetState(app->ancf, NULL, &e, &edot, NULL));
  k = PetscMin((PetscInt)(s / l), ne - 1);
  AncfShape(s / l - (PetscReal)k, l, S);
  AncfShapeX(s / l - (PetscReal)k, l, Sx);
  e += 6 * (first + k);
  edot += 6 * (first + k);
  for (int a = 0; a < 3; a++) {
    r[a] = S[0] * e[a] + S[1] * e[3 + a] + S[2] * e[6 + a] + S[3] * e[9 + a];
    v[a] = S[0] * edot[a] + S[1] * edot[3 + a] + S[2] * edot[6 + a] + S[3] * edot[9 + a];
    if (rx) rx[a] = Sx[0] * e[a] + Sx[1] * e[3 + a] + Sx[2] * e[6 + a] + Sx[3] * e[9 + a];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
