/*
  appregion.c - signed distances to the regions of a scene, and the wall markers around them.

  The distance to several regions is the least one: exact outside, and inside a bound, since the parts of a region's surface that
  another one covers count. Regions that fill a periodic axis from end to end have no surface there.
*/
#include "app.h"
#include "sphfill.h"

#define TINY 1e-9

static PetscReal box_distance(const App *app, const SceneRegion *r, const PetscReal x[3])
{
  const AppScene *s = &app->scene;
  PetscReal outside = 0, inside = -PETSC_MAX_REAL;

  for (PetscInt a = 0; a < 3 && a < app->dim; a++) {
    const PetscReal q = PetscMax(r->lo[a] - x[a], x[a] - r->hi[a]);

    if (s->periodic[a] && r->hi[a] - r->lo[a] > (1 - TINY) * (s->hi[a] - s->lo[a])) continue;
    if (q > 0) outside += q * q;
    inside = PetscMax(inside, q);
  }
  return outside > 0 ? PetscSqrtReal(outside) : inside;
}

static PetscReal segment_distance2(const PetscReal e[4], PetscReal s, PetscReal r)
{
  const PetscReal ds = e[2] - e[0], dr = e[3] - e[1], len2 = ds * ds + dr * dr;
  const PetscReal t = PetscMax(0, PetscMin(1, ((s - e[0]) * ds + (r - e[1]) * dr) / len2));

  return PetscSqr(s - e[0] - t * ds) + PetscSqr(r - e[1] - t * dr);
}

/* A solid of revolution: the distance to its outline in the plane of axis and radius. */
static PetscReal axis_distance(const App *app, const SceneRegion *g, const PetscReal x[3])
{
  PetscReal s = 0, r2 = 0, r, best = PETSC_MAX_REAL;
  PetscBool inside;

  for (PetscInt a = 0; a < 3 && a < app->dim; a++) s += (x[a] - g->start[a]) * g->axis[a];
  for (PetscInt a = 0; a < 3 && a < app->dim; a++) r2 += PetscSqr(x[a] - g->start[a] - s * g->axis[a]);
  r = PetscSqrtReal(r2);
  if (g->endless) s -= g->length * PetscFloorReal(s / g->length);
  for (PetscInt k = 0; k < g->nsegments; k++) {
    best = PetscMin(best, segment_distance2(g->segment[k], s, r));
    if (!g->endless) continue;
    best = PetscMin(best, segment_distance2(g->segment[k], s - g->length, r));
    best = PetscMin(best, segment_distance2(g->segment[k], s + g->length, r));
  }
  inside = (PetscBool)(s >= 0 && s <= g->length && r < (s < g->step || s >= g->back ? g->radius : g->radius2));
  return inside ? -PetscSqrtReal(best) : PetscSqrtReal(best);
}

static PetscReal shape_distance(const App *app, const SceneRegion *r, const PetscReal x[3])
{
  PetscReal d2 = 0, y[3];

  switch (r->shape) {
  case REGION_BOX:
    return box_distance(app, r, x);
  case REGION_SPHERE:
    for (PetscInt a = 0; a < 3 && a < app->dim; a++) d2 += PetscSqr(x[a] - r->position[a]);
    return PetscSqrtReal(d2) - r->radius;
  case REGION_SURFACE:
    for (int a = 0; a < 3; a++) y[a] = x[a] - r->position[a];
    return RigidGeometryGetDistance(r->geometry, y);
  default:
    return axis_distance(app, r, x);
  }
}

/* How far x lies outside of the box about a region, m. */
static PetscReal bound(const App *app, const SceneRegion *r, const PetscReal x[3])
{
  PetscReal d2 = 0;

  for (PetscInt a = 0; a < 3 && a < app->dim; a++) d2 += PetscSqr(PetscMax(0, PetscMax(r->lo[a] - x[a], x[a] - r->hi[a])));
  return PetscSqrtReal(d2);
}

/* Signed distance (m, negative inside) to all regions, and to those that have walls and the one of them it is to; -1 for none. */
void AppRegionDistance(const App *app, const PetscReal x[3], PetscReal *region, PetscReal *wall, PetscInt *nearest)
{
  const AppScene *s = &app->scene;
  PetscInt n[3];

  *region = *wall = PETSC_MAX_REAL;
  *nearest = -1;
  for (int a = 0; a < 3; a++) n[a] = a < app->dim && s->periodic[a] ? 1 : 0;
  for (PetscInt g = 0; g < s->nregions; g++)
    for (PetscInt i = -n[0]; i <= n[0]; i++)
      for (PetscInt j = -n[1]; j <= n[1]; j++)
        for (PetscInt k = -n[2]; k <= n[2]; k++) {
          const SceneRegion *r = &s->regions[g];
          const PetscReal y[3] = {x[0] + (PetscReal)i * (s->hi[0] - s->lo[0]), x[1] + (PetscReal)j * (s->hi[1] - s->lo[1]),
                                  x[2] + (PetscReal)k * (s->hi[2] - s->lo[2])};
          PetscReal d;

          if (bound(app, r, y) > (r->wall ? *wall : *region)) continue;
          d = shape_distance(app, r, y);
          if (d < *region) *region = d;
          if (!r->wall || d >= *wall) continue;
          *wall = d;
          *nearest = g;
        }
}

static void fill_distance(const PetscReal x[3], void *ctx, PetscReal *region, PetscReal *wall)
{
  PetscInt nearest;

  AppRegionDistance(ctx, x, region, wall, &nearest);
}

/* Gap between x, which may have gone round a periodic axis, and the walls of the regions, m. */
PetscReal AppRegionGap(const PetscReal x[3], void *ctx)
{
  const App *app = ctx;
  const AppScene *s = &app->scene;
  PetscReal y[3] = {x[0], x[1], x[2]}, region, wall;
  PetscInt nearest;

  for (PetscInt a = 0; a < 3 && a < app->dim; a++)
    if (s->periodic[a]) y[a] -= (s->hi[a] - s->lo[a]) * PetscFloorReal((y[a] - s->lo[a]) / (s->hi[a] - s->lo[a]));
  AppRegionDistance(app, y, &region, &wall, &nearest);
  return -wall;
}

/* Whether a fixed body holds the place; its own markers are the boundary there. */
static PetscErrorCode held(const App *app, const PetscReal x[3], PetscBool *yes)
{
  PetscFunctionBegin;
  *yes = PETSC_FALSE;
  for (PetscInt b = 0; b < app->scene.nbodies && !*yes; b++) {
    PetscReal gap;

    if (app->scene.bodies[b].spec.motion != RIGID_FIXED) continue;
    PetscCall(RigidGetGap(app->rigid, b, x, &gap, NULL));
    *yes = (PetscBool)(gap < 0);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Wall markers of all regions and the region of each; the caller frees the four arrays with PetscFree(). */
PetscErrorCode AppRegionWalls(App *app, PetscInt *count, PetscReal **x, PetscReal **volume, PetscReal **depth, PetscInt **owner)
{
  const AppScene *s = &app->scene;
  PetscReal dp, support, region, wall;
  PetscInt n, m = 0;

  PetscFunctionBegin;
  PetscCall(SphGetSpacing(app->sph, &dp));
  PetscCall(SphGetSupport(app->sph, &support));
  PetscCall(
      SphFillRegionWalls(app->dim, dp, s->lo, s->hi, s->wall, s->periodic, support, fill_distance, app, &n, x, volume, depth));
  PetscCall(PetscMalloc1(PetscMax(n, 1), owner));
  for (PetscInt i = 0; i < n; i++) {
    PetscBool no;
    PetscCall(held(app, *x + 3 * i, &no));
    if (no) continue;
    for (int a = 0; a < 3; a++) (*x)[3 * m + a] = (*x)[3 * i + a];
    (*volume)[m] = (*volume)[i];
    (*depth)[m] = (*depth)[i];
    AppRegionDistance(app, *x + 3 * m, &region, &wall, &(*owner)[m]);
    m++;
  }
  *count = m;
  PetscFunctionReturn(PETSC_SUCCESS);
}
