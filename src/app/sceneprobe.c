/* sceneprobe.c - the grids and probes of a scene. */
#include "app.h"
#include <string.h>

#define COUNT(table) ((PetscInt)(sizeof(table) / sizeof((table)[0])))
#define POINTS_MAX 3e8

static const char *const interpolations[] = {"shepard", "linear", NULL};
static const char *const kinds[] = {"point", "plane", NULL};

static PetscErrorCode read_grid(const char prefix[], const char title[], SceneGrid *g)
{
  const AppOpt opt[] = {
      {OPT_VEC, "lo", "First point, m (default: the domain's lower corner)", g->lo, NULL, &g->setlo},
      {OPT_VEC, "hi", "Last point, m (default: the domain's upper corner); equal to lo along an axis: a slice or a line", g->hi,
       NULL, &g->sethi},
      {OPT_REAL, "spacing", "Largest distance of points, m (default: sph_dp)", &g->spacing, NULL, NULL},
      {OPT_CHOICE, "mapping", "Shepard's mean over the markers around a point, or a linear fit to them", &g->how, interpolations,
       NULL},
  };

  PetscFunctionBegin;
  PetscCall(AppOptionsRead(prefix, title, COUNT(opt), opt));
  PetscCheck(g->spacing >= 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "%sspacing = %g m must be positive (0: sph_dp)", prefix,
             (double)g->spacing);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode read_probe(const char prefix[], const char title[], SceneProbe *p)
{
  const AppOpt opt[] = {
      {OPT_CHOICE, "type", "point: pressure and velocity; plane: flow and mean pressure", &p->kind, kinds, NULL},
      {OPT_VEC, "position", "The point, or a corner of the plane, m (needed)", p->position, NULL, &p->set[0]},
      {OPT_VEC, "edge1", "plane: first edge of the parallelogram, in 2D the line, m (needed)", p->edge1, NULL, &p->set[1]},
      {OPT_VEC, "edge2", "plane: second edge, m (needed in 3D); flow counts along edge1 x edge2", p->edge2, NULL, &p->set[2]},
      {OPT_CHOICE, "mapping", "point: Shepard's mean over the markers around it, or a linear fit to them", &p->how,
       interpolations, NULL},
  };

  PetscFunctionBegin;
  PetscCall(AppOptionsRead(prefix, title, COUNT(opt), opt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode read_grids(AppScene *s, const AppNames *names, PetscBool help)
{
  SceneGrid all;
  char prefix[128], title[128];

  PetscFunctionBegin;
  PetscCall(PetscMemzero(&all, sizeof(all)));
  if (names->n || help)
    PetscCall(read_grid("grid_", "Grids of points in the frames: the same for all; -grid_<name>_... for one", &all));
  PetscCall(PetscCalloc1(names->n, &s->grids));
  s->ngrids = names->n;
  for (PetscInt i = 0; i < names->n; i++) {
    s->grids[i] = all;
    PetscCall(PetscStrncpy(s->grids[i].name, names->name[i], APP_NAME_LEN));
    PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "grid_%s_", names->name[i]));
    PetscCall(PetscSNPrintf(title, sizeof(title), "Grid '%s'", names->name[i]));
    PetscCall(read_grid(prefix, title, &s->grids[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Read grids and probes. */
PetscErrorCode AppSceneReadProbes(AppScene *s)
{
  AppNames grids = {0, NULL}, probes = {0, NULL};
  SceneProbe all;
  PetscBool help;
  char prefix[128], title[128];
  const AppOpt opt[] = {
      {OPT_NAMES, "grids", "Names of grids of points in the frames, separated by commas", &grids, NULL, NULL},
      {OPT_NAMES, "probes", "Names of probes in the history, separated by commas", &probes, NULL, NULL},
  };

  PetscFunctionBegin;
  PetscCall(AppOptionsRead(NULL, "Scene: grids and probes", COUNT(opt), opt));
  PetscCall(PetscOptionsHasHelp(NULL, &help));
  PetscCall(read_grids(s, &grids, help));
  PetscCall(PetscMemzero(&all, sizeof(all)));
  all.how = SPH_INTERPOLATE_LINEAR;
  if (probes.n || help)
    PetscCall(read_probe("probe_", "Probes in the history: the same for all; -probe_<name>_... for one", &all));
  PetscCall(PetscCalloc1(probes.n, &s->probes));
  s->nprobes = probes.n;
  for (PetscInt i = 0; i < probes.n; i++) {
    SceneProbe *p = &s->probes[i];
    *p = all;
    PetscCall(PetscStrncpy(p->name, probes.name[i], APP_NAME_LEN));
    PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "probe_%s_", p->name));
    PetscCall(PetscSNPrintf(title, sizeof(title), "Probe '%s'", p->name));
    PetscCall(read_probe(prefix, title, p));
    PetscCheck(help || p->set[0], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "probe '%s' needs %sposition", p->name, prefix);
    PetscCheck(help || p->kind == 0 || p->set[1], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "probe '%s' is a plane and needs %sedge1",
               p->name, prefix);
  }
  PetscCall(PetscFree(grids.name));
  PetscCall(PetscFree(probes.name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Points along each axis and how far they reach, once domain, dimension and spacing are known; refuses what lies outside. */
PetscErrorCode AppProbesSetUp(App *app)
{
  AppScene *s = &app->scene;
  PetscReal dp;

  PetscFunctionBegin;
  PetscCheck(app->sph || (!s->ngrids && !s->nprobes), PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
             "%s: '%s' looks at the fluid, but the scene has none", s->ngrids ? "grids" : "probes",
             s->ngrids ? s->grids[0].name : s->probes[0].name);
  if (!app->sph) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SphGetSpacing(app->sph, &dp));
  for (PetscInt i = 0; i < s->ngrids; i++) {
    SceneGrid *g = &s->grids[i];
    PetscReal total = 1;
    if (g->spacing == 0) g->spacing = dp;
    for (PetscInt a = 0; a < 3; a++) {
      PetscReal cells;
      if (!g->setlo) g->lo[a] = s->lo[a];
      if (!g->sethi) g->hi[a] = s->hi[a];
      if (a >= app->dim) g->lo[a] = g->hi[a] = 0;
      PetscCheck(g->hi[a] >= g->lo[a], PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
                 "grid_%s_hi %c = %g m must not lie below grid_%s_lo = %g m", g->name, "xyz"[a], (double)g -> hi[a], g -> name,
                 (double)g -> lo[a]);
      PetscCheck(a >= app->dim || (g->hi[a] >= s->lo[a] && g->lo[a] <= s->hi[a]), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
                 "grid '%s' (%g to %g m along %c) lies outside of the domain (%g to %g m)", g->name, (double)g->lo[a],
                 (double)g->hi[a], "xyz"[a], (double)s -> lo[a], (double)s -> hi[a]);
      cells = PetscCeilReal((g->hi[a] - g->lo[a]) / g->spacing - (PetscReal)1e-6);
      total *= PetscMax(cells, 0) + 1;
      PetscCheck(total < POINTS_MAX, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
                 "grid_%s_spacing = %g m makes more than %g points: choose a larger one", g->name, (double)g->spacing,
                 POINTS_MAX);
      g->n[a] = (PetscInt)PetscMax(cells, 0) + 1;
    }
  }
  for (PetscInt i = 0; i < s->nprobes; i++) {
    const SceneProbe *p = &s->probes[i];
    for (PetscInt a = 0; a < app->dim; a++)
      PetscCheck(p->position[a] >= s->lo[a] && p->position[a] <= s->hi[a], PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
                 "probe_%s_position: %c = %g m lies outside of the domain (%g to %g m)", p->name, "xyz"[a],
                 (double)p -> position[a], (double)s -> lo[a], (double)s -> hi[a]);
    PetscCheck(p->kind == 0 || app->dim == 2 || p->set[2], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
               "probe '%s' is a plane and needs probe_%s_edge2", p->name, p->name);
    if (p->kind == 1) { /* refuses a plane without area before any file is made */
      SphPlane plane;
      AppDoing(app, "probe '%s'", p->name);
      PetscCall(SphGetPlane(app->sph, p->position, p->edge1, p->edge2, &plane));
      AppDoing(app, "%s", "");
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
