/* sceneregion.c - the regions of a scene: what the fluid fills, and where walls lie around it. */
#include "app.h"
#include <string.h>

#define COUNT(table) ((PetscInt)(sizeof(table) / sizeof((table)[0])))
#define TINY 1e-9 /* relative: lengths that are equal */

static const char *const shapes[] = {"box", "sphere", "cylinder", "pipe", "surface", NULL};

enum { SET_LO, SET_HI, SET_START, SET_END, SET_RADIUS, SET_RADIUS2, SET_STEP, SET_BACK, SET_POSITION };

static PetscErrorCode read_region(const char prefix[], const char title[], SceneRegion *r, PetscBool set[REGION_SETS])
{
  const AppOpt opt[] = {
      {OPT_CHOICE, "shape",
       "box: lo, hi; sphere: position, radius; cylinder: start, end, radius; pipe: these, radius2, step; surface: file",
       &r->shape, shapes, NULL},
      {OPT_VEC, "lo", "box: lower corner, m (default: the domain's)", r->lo, NULL, &set[SET_LO]},
      {OPT_VEC, "hi", "box: upper corner, m (default: the domain's)", r->hi, NULL, &set[SET_HI]},
      {OPT_VEC, "start", "cylinder, pipe: first end of the axis, m (needed)", r->start, NULL, &set[SET_START]},
      {OPT_VEC, "end", "cylinder, pipe: last end of the axis, m (needed)", r->end, NULL, &set[SET_END]},
      {OPT_REAL, "radius", "sphere, cylinder, pipe: radius; in 2D half the width across the axis, m (needed)", &r->radius, NULL,
       &set[SET_RADIUS]},
      {OPT_REAL, "radius2", "pipe: radius behind the step, m (needed)", &r->radius2, NULL, &set[SET_RADIUS2]},
      {OPT_REAL, "step", "pipe: distance from the start at which radius becomes radius2, m (needed)", &r->step, NULL,
       &set[SET_STEP]},
      {OPT_REAL, "back", "pipe: distance from the start at which it becomes radius again, m (default: never)", &r->back, NULL,
       &set[SET_BACK]},
      {OPT_STRING, "file", "surface: STL or OBJ file of a closed surface (needed)", r->file, NULL, NULL},
      {OPT_REAL, "scale", "surface: metres per unit of the file", &r->scale, NULL, NULL},
      {OPT_VEC, "position", "sphere: centre, m (needed); surface: where the file's origin goes, m", r->position, NULL,
       &set[SET_POSITION]},
      {OPT_BOOL, "wall", "Whether its surface is a wall, where it is not inside of another region", &r->wall, NULL, NULL},
  };

  PetscFunctionBegin;
  PetscCall(AppOptionsRead(prefix, title, COUNT(opt), opt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode need(const SceneRegion *r, PetscBool set, const char key[])
{
  PetscFunctionBegin;
  PetscCheck(set, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "region '%s' is a %s and needs region_%s_%s", r->name, shapes[r->shape],
             r->name, key);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What each shape needs. */
static PetscErrorCode check_given(SceneRegion *r, const PetscBool set[REGION_SETS])
{
  const PetscBool pipe = (PetscBool)(r->shape == REGION_PIPE), cylinder = (PetscBool)(r->shape == REGION_CYLINDER);

  PetscFunctionBegin;
  r->setlo = set[SET_LO];
  r->sethi = set[SET_HI];
  if (r->shape == REGION_SPHERE) PetscCall(need(r, set[SET_POSITION], "position"));
  if (pipe || cylinder) {
    PetscCall(need(r, set[SET_START], "start"));
    PetscCall(need(r, set[SET_END], "end"));
  }
  if (pipe) {
    PetscCall(need(r, set[SET_RADIUS2], "radius2"));
    PetscCall(need(r, set[SET_STEP], "step"));
    PetscCheck(r->radius2 > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "region_%s_radius2 = %g m: must be > 0", r->name,
               (double)r->radius2);
  }
  if (r->shape == REGION_SURFACE) {
    PetscCall(need(r, (PetscBool)(r->file[0] != 0), "file"));
  } else if (r->shape != REGION_BOX) {
    PetscCall(need(r, set[SET_RADIUS], "radius"));
    PetscCheck(r->radius > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "region_%s_radius = %g m: must be > 0", r->name,
               (double)r->radius);
  }
  if (!set[SET_BACK]) r->back = PETSC_MAX_REAL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Read the regions; file: the scene's, beside which files of surfaces may lie. */
PetscErrorCode AppSceneReadRegions(AppScene *s, const char file[])
{
  AppNames names = {0, NULL};
  SceneRegion all;
  PetscBool help, allset[REGION_SETS] = {PETSC_FALSE}, set[REGION_SETS];
  const AppOpt opt[] = {
      {OPT_NAMES, "regions", "Names of regions that the fluid fills, all together, in place of the domain", &names, NULL, NULL}};
  char prefix[128], title[128];

  PetscFunctionBegin;
  PetscCall(AppOptionsRead(NULL, "Scene: regions", 1, opt));
  PetscCall(PetscOptionsHasHelp(NULL, &help));
  PetscCall(PetscMemzero(&all, sizeof(all)));
  all.scale = 1;
  all.wall = PETSC_TRUE;
  if (names.n || help) PetscCall(read_region("region_", "Regions: the same for all; -region_<name>_... for one", &all, allset));
  PetscCall(PetscCalloc1(names.n, &s->regions));
  s->nregions = names.n;
  for (PetscInt i = 0; i < names.n; i++) {
    SceneRegion *r = &s->regions[i];
    *r = all;
    PetscCall(PetscArraycpy(set, allset, REGION_SETS));
    PetscCall(PetscStrncpy(r->name, names.name[i], APP_NAME_LEN));
    PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "region_%s_", r->name));
    PetscCall(PetscSNPrintf(title, sizeof(title), "Region '%s'", r->name));
    PetscCall(read_region(prefix, title, r, set));
    if (help) continue;
    PetscCall(check_given(r, set));
    if (r->file[0]) PetscCall(AppFindFile(file, r->file));
  }
  PetscCall(PetscFree(names.name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppSceneFreeRegions(AppScene *s)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->nregions; i++) PetscCall(RigidGeometryDestroy(&s->regions[i].geometry));
  PetscCall(PetscFree(s->regions));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* --- set up, once domain and dimension are known ------------------------------------------------------------------ */

static void add_segment(SceneRegion *r, PetscReal s0, PetscReal r0, PetscReal s1, PetscReal r1)
{
  PetscReal *at = r->segment[r->nsegments++];

  at[0] = s0;
  at[1] = r0;
  at[2] = s1;
  at[3] = r1;
}

/* Outline of a cylinder or pipe over its axis: (s, r) of wall and steps, and of the ends unless it is endless. */
static void outline(SceneRegion *r)
{
  const PetscReal L = r->length, at[4] = {0, r->step, r->back, L}, R[3] = {r->radius, r->radius2, r->radius};
  PetscReal last = 0;

  r->nsegments = 0;
  for (int k = 0; k < 3; k++) {
    const PetscReal s0 = PetscMin(at[k], L), s1 = PetscMin(at[k + 1], L);

    if (s1 <= s0) continue;
    if (k == 0 && !r->endless)
      add_segment(r, 0, 0, 0, R[0]);
    else if (k > 0)
      add_segment(r, s0, last, s0, R[k]);
    add_segment(r, s0, R[k], s1, R[k]);
    last = R[k];
  }
  if (!r->endless)
    add_segment(r, L, 0, L, last);
  else if (last != R[0])
    add_segment(r, L, last, L, R[0]);
}

static PetscErrorCode setup_axis(const App *app, SceneRegion *r)
{
  const AppScene *s = &app->scene;
  PetscReal L = 0;

  PetscFunctionBegin;
  if (r->shape == REGION_CYLINDER) {
    r->radius2 = r->radius;
    r->step = r->back = PETSC_MAX_REAL;
  }
  for (int a = 0; a < app->dim; a++) L += PetscSqr(r->end[a] - r->start[a]);
  r->length = L = PetscSqrtReal(L);
  PetscCheck(L > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "region_%s_start and end are the same point: its axis has no length", r->name);
  PetscCheck(r->shape == REGION_CYLINDER || (r->step > 0 && r->step < L), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "region_%s_step = %g m: must lie between 0 and its length %g m", r->name, (double)r->step, (double)L);
  PetscCheck(r->back > r->step || r->shape == REGION_CYLINDER, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "region_%s_back = %g m: must lie behind the step at %g m", r->name, (double)r->back, (double)r->step);
  for (int a = 0; a < 3; a++) {
    const PetscReal R = PetscMax(r->radius, r->radius2);

    r->axis[a] = a < app->dim ? (r->end[a] - r->start[a]) / L : 0;
    const PetscReal wide = R * PetscSqrtReal(PetscMax(0, 1 - r->axis[a] * r->axis[a]));
    r->lo[a] = PetscMin(r->start[a], r->end[a]) - wide;
    r->hi[a] = PetscMax(r->start[a], r->end[a]) + wide;
    if (s->periodic[a] && PetscAbsReal(PetscAbsReal(r->axis[a]) - 1) < TINY && PetscAbsReal(L - (s->hi[a] - s->lo[a])) < TINY * L)
      r->endless = PETSC_TRUE;
  }
  outline(r);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A region lies in the domain; along a periodic axis it may reach into the images next to it. */
static PetscErrorCode check_place(const App *app, const SceneRegion *r)
{
  const AppScene *s = &app->scene;

  PetscFunctionBegin;
  for (PetscInt a = 0; a < app->dim; a++) {
    const PetscReal period = s->hi[a] - s->lo[a], more = (s->periodic[a] ? 1 : TINY) * period;

    PetscCheck(r->hi[a] > r->lo[a], PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "region_%s_hi %c = %g m must lie above region_%s_lo = %g m", r->name, "xyz"[a], (double)r -> hi[a], r -> name,
               (double)r -> lo[a]);
    PetscCheck(r->lo[a] >= s->lo[a] - more && r->hi[a] <= s->hi[a] + more, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "region '%s' (%g to %g m along %c) must lie inside the domain (%g to %g m)", r->name, (double)r->lo[a],
               (double)r->hi[a], "xyz"[a], (double)s -> lo[a], (double)s -> hi[a]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Read the surfaces, find what each region covers, and keep the fluid box within them. */
PetscErrorCode AppRegionsSetUp(App *app)
{
  AppScene *s = &app->scene;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->nregions; i++) {
    SceneRegion *r = &s->regions[i];

    AppDoing(app, "region '%s'", r->name);
    for (int a = 0; a < 3 && r->shape == REGION_BOX; a++) {
      if (!r->setlo) r->lo[a] = s->lo[a];
      if (!r->sethi) r->hi[a] = s->hi[a];
    }
    for (int a = 0; a < 3 && r->shape == REGION_SPHERE; a++) {
      r->lo[a] = r->position[a] - r->radius;
      r->hi[a] = r->position[a] + r->radius;
    }
    if (r->shape == REGION_CYLINDER || r->shape == REGION_PIPE) PetscCall(setup_axis(app, r));
    if (r->shape == REGION_SURFACE) {
      PetscCheck(app->dim == 3, PETSC_COMM_SELF, PETSC_ERR_SUP, "region_%s_shape surface: is for 3D", r->name);
      PetscCall(RigidGeometryCreateFile(PETSC_COMM_SELF, r->file, r->scale, &r->geometry));
      PetscCall(RigidGeometryGetBounds(r->geometry, r->lo, r->hi));
      for (int a = 0; a < 3; a++) {
        r->lo[a] += r->position[a];
        r->hi[a] += r->position[a];
      }
    }
    PetscCall(check_place(app, r));
    AppDoing(app, "%s", "");
  }
  for (PetscInt a = 0; a < app->dim && s->nregions; a++) {
    PetscReal lo = PETSC_MAX_REAL, hi = -PETSC_MAX_REAL;

    if (s->periodic[a]) continue;
    for (PetscInt i = 0; i < s->nregions; i++) {
      lo = PetscMin(lo, s->regions[i].lo[a]);
      hi = PetscMax(hi, s->regions[i].hi[a]);
    }
    s->fluidlo[a] = PetscMax(s->fluidlo[a], lo);
    s->fluidhi[a] = PetscMin(s->fluidhi[a], hi);
    PetscCheck(s->fluidhi[a] > s->fluidlo[a], PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "the regions (%g to %g m along %c) have nothing in common with the fluid box: the domain has no fluid", (double)lo,
               (double)hi, "xyz"[a]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
