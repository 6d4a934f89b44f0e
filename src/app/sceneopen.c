/* sceneopen.c - the openings of a scene: on a face of the domain, their zones outside of it, or on any plane. */
#include "app.h"
#include "sphopen.h"
#include <string.h>

#define COUNT(table) ((PetscInt)(sizeof(table) / sizeof((table)[0])))

static const char *const types[] = {"inflow", "outflow", NULL};
static const char *const givens[] = {"velocity", "pressure", NULL};
static const char *const profiles[] = {"uniform", "parabolic", NULL};
static const char *const faces[] = {"none", "xmin", "xmax", "ymin", "ymax", "zmin", "zmax", NULL};

static PetscErrorCode read_opening(const char prefix[], const char title[], SceneOpening *o)
{
  const AppOpt opt[] = {
      {OPT_CHOICE, "type", "Which way the fluid goes", &o->type, types, NULL},
      {OPT_CHOICE, "given", "What is prescribed (default: velocity for inflow, pressure for outflow)", &o->given, givens,
       &o->set[0]},
      {OPT_CHOICE, "face", "Face of the domain that it is in; none: position and edges say where", &o->face, faces, NULL},
      {OPT_VEC, "lo", "face: lower corner of the part that is open, m (default: the domain's)", o->lo, NULL, &o->set[1]},
      {OPT_VEC, "hi", "face: upper corner of the part that is open, m (default: the domain's)", o->hi, NULL, &o->set[2]},
      {OPT_VEC, "position", "A corner of the opening, m; edge1 x edge2 (2D: edge1 turned right) points into the fluid",
       o->position, NULL, &o->set[3]},
      {OPT_VEC, "edge1", "First edge of the opening, m", o->edge1, NULL, &o->set[4]},
      {OPT_VEC, "edge2", "Second edge, at right angles, m (3D)", o->edge2, NULL, &o->set[5]},
      {OPT_REAL, "speed", "Mean speed along the normal, m/s", &o->speed, NULL, &o->set[6]},
      {OPT_CHOICE, "profile", "Velocity over the opening: uniform, or a parabola along each edge", &o->profile, profiles, NULL},
      {OPT_REAL, "pressure", "Pressure in the opening, Pa", &o->pressure, NULL, &o->set[7]},
      {OPT_REAL, "ramp", "Time over which a constant speed or pressure comes up linearly from 0, s (0: at once)", &o->ramp, NULL,
       NULL},
      {OPT_STRING, "file", "CSV file with columns t and speed or pressure (s, m/s, Pa), in place of a constant", o->file, NULL,
       NULL},
  };

  PetscFunctionBegin;
  PetscCall(AppOptionsRead(prefix, title, COUNT(opt), opt));
  if (!o->set[0]) o->given = o->type == 0 ? 0 : 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What fits together without knowing the fluid. */
static PetscErrorCode check_opening(const char prefix[], const SceneOpening *o)
{
  const PetscBool onface = (PetscBool)(o->face > 0), speed = (PetscBool)(o->given == 0);

  PetscFunctionBegin;
  PetscCheck(onface || (o->set[3] && o->set[4]), PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
             "opening '%s' needs %sface, or %sposition and %sedge1", o->name, prefix, prefix, prefix);
  PetscCheck(!onface || (!o->set[3] && !o->set[4] && !o->set[5]), PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP,
             "opening '%s' is in face %s: position and edges are given too", o->name, faces[o->face]);
  PetscCheck(onface || (!o->set[1] && !o->set[2]), PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP,
             "opening '%s': %slo and %shi are for one in a face", o->name, prefix, prefix);
  PetscCheck(!o->set[speed ? 7 : 6], PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP,
             "opening '%s' prescribes the %s, but its %s is given: set %sgiven", o->name, givens[o->given],
             speed ? "pressure" : "speed", prefix);
  PetscCheck(o->set[speed ? 6 : 7] || o->file[0], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "opening '%s' needs %s%s or %sfile",
             o->name, prefix, speed ? "speed" : "pressure", prefix);
  PetscCheck(!o->set[speed ? 6 : 7] || !o->file[0], PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP,
             "opening '%s': %s%s and %sfile: give only one of them", o->name, prefix, speed ? "speed" : "pressure", prefix);
  PetscCheck(o->ramp >= 0 && (o->ramp == 0 || !o->file[0]), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "opening '%s': ramp %g s must be 0 (none) or more, and has no meaning with a file", o->name, (double)o->ramp);
  PetscCheck(speed || o->profile == 0, PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP,
             "opening '%s' prescribes the pressure: profile parabolic has no meaning", o->name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppSceneReadOpenings(AppScene *s)
{
  AppNames names = {0, NULL};
  SceneOpening all;
  PetscBool help;
  char prefix[128], title[128];
  const AppOpt opt[] = {
      {OPT_NAMES, "openings", "Names of openings through which fluid comes in or goes out, separated by commas", &names, NULL,
       NULL},
      {OPT_INT, "openings_reserve", "Markers in reserve for those that come in; -1: predicted", &s->reserve, NULL, NULL},
  };

  PetscFunctionBegin;
  s->reserve = -1;
  PetscCall(AppOptionsRead(NULL, "Scene: openings", COUNT(opt), opt));
  PetscCall(PetscOptionsHasHelp(NULL, &help));
  PetscCheck(s->reserve >= -1, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "openings_reserve = %" PetscInt_FMT ": must be 0 or more, or -1 for a prediction", s->reserve);
  PetscCall(PetscMemzero(&all, sizeof(all)));
  if (names.n || help) PetscCall(read_opening("opening_", "Openings: the same for all; -opening_<name>_... for one", &all));
  PetscCall(PetscCalloc1(names.n, &s->openings));
  s->nopenings = names.n;
  for (PetscInt i = 0; i < names.n; i++) {
    SceneOpening *o = &s->openings[i];
    *o = all;
    PetscCall(PetscStrncpy(o->name, names.name[i], APP_NAME_LEN));
    PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "opening_%s_", o->name));
    PetscCall(PetscSNPrintf(title, sizeof(title), "Opening '%s'", o->name));
    PetscCall(read_opening(prefix, title, o));
    if (!help) PetscCall(check_opening(prefix, o));
  }
  PetscCall(PetscFree(names.name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rectangle of an opening in a face of the domain; its normal points inwards. */
static PetscErrorCode place_in_face(const AppScene *s, PetscInt dim, const SceneOpening *o, SphOpeningSpec *spec)
{
  const PetscInt face = o->face - 1, a = face / 2, high = face % 2, b = (a + 1) % dim, c = (a + 2) % 3;
  const PetscInt along[2] = {dim == 2 ? b : (high ? c : b), high ? b : c}; /* edge1 x edge2 is the normal */
  PetscReal lo[3], hi[3];

  PetscFunctionBegin;
  PetscCheck(a < dim, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "opening '%s': face %s has no meaning in a 2D scene", o->name,
             SceneFaces[face]);
  PetscCheck(!s->periodic[a], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "opening '%s': face %s is on axis %c, which is periodic",
             o->name, SceneFaces[face], "xyz"[a]);
  PetscCheck(!s->walls[face].motion[0], PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP, "opening '%s': the wall %s moves bodily", o->name,
             SceneFaces[face]);
  for (PetscInt k = 0; k < dim; k++) {
    if (k == a) continue;
    lo[k] = o->set[1] ? o->lo[k] : s->lo[k];
    hi[k] = o->set[2] ? o->hi[k] : s->hi[k];
    PetscCheck(hi[k] > lo[k] && lo[k] >= s->lo[k] && hi[k] <= s->hi[k], PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "opening '%s': %g to %g m along %c; must lie in the domain, %g to %g m", o->name, (double)lo[k], (double)hi[k],
               "xyz"[k], (double)s -> lo[k], (double)s -> hi[k]);
  }
  spec->corner[a] = high ? s->hi[a] : s->lo[a];
  for (PetscInt e = 0; e < dim - 1; e++) {
    const PetscInt k = along[e];
    PetscReal *edge = e ? spec->edge2 : spec->edge1;
    /* 2D: (edge1_y, -edge1_x) is the normal, so edge1 goes up in xmin and ymax */
    const PetscBool down = (PetscBool)(dim == 2 && (a == 0) == (high == 1));
    spec->corner[k] = down ? hi[k] : lo[k];
    edge[k] = down ? lo[k] - hi[k] : hi[k] - lo[k];
    spec->across[e] = s->periodic[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode make_spec(const App *app, const SceneOpening *o, AppTable *table, SphOpeningSpec *spec)
{
  static const char *const columns[2][2] = {{"speed", NULL}, {"pressure", NULL}};
  const AppScene *s = &app->scene;

  PetscFunctionBegin;
  PetscCall(SphOpeningSpecInit(spec));
  PetscCall(PetscMemzero(table, sizeof(*table)));
  PetscCall(PetscStrncpy(spec->name, o->name, sizeof(spec->name)));
  spec->type = (SphOpeningType)o->type;
  spec->given = (SphOpeningGiven)o->given;
  spec->profile = (SphOpeningProfile)o->profile;
  spec->value = o->given == 0 ? o->speed : o->pressure;
  if (o->face)
    PetscCall(place_in_face(s, app->dim, o, spec));
  else {
    PetscCall(PetscArraycpy(spec->corner, o->position, 3));
    PetscCall(PetscArraycpy(spec->edge1, o->edge1, 3));
    PetscCall(PetscArraycpy(spec->edge2, o->edge2, 3));
  }
  if (!o->file[0] && o->ramp == 0) PetscFunctionReturn(PETSC_SUCCESS);
  if (!o->file[0]) {
    table->n = 2;
    PetscCall(PetscCalloc1(2, &table->t));
    PetscCall(PetscCalloc1(2, &table->value));
    table->t[1] = o->ramp;
    table->value[1] = spec->value;
  } else
    PetscCall(AppTableRead(o->file, columns[o->given], s->tend, table));
  spec->n = table->n;
  spec->t = table->t;
  spec->values = table->value;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether the fluid box reaches to the opening where a site of its zone is. */
static PetscBool fluid_behind(const App *app, const SphOpeningSpec *spec, PetscReal dp, const PetscReal x[3])
{
  const AppScene *s = &app->scene;
  const PetscReal *e = spec->edge1, *f = spec->edge2;
  PetscReal n[3] = {e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]}, size = 0, off = 0;

  if (app->dim == 2) n[0] = e[1], n[1] = -e[0], n[2] = 0;
  for (int a = 0; a < 3; a++) {
    size += n[a] * n[a];
    off += n[a] * (x[a] - spec->corner[a]);
  }
  for (PetscInt a = 0; a < app->dim; a++) {
    const PetscReal y = x[a] + (dp / 2 * PetscSqrtReal(size) - off) * n[a] / size;
    if (y < s->fluidlo[a] - 1e-9 * dp || y > s->fluidhi[a] + 1e-9 * dp) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* The zone's first markers: all where a speed brings fluid in, else those behind fluid. */
static PetscErrorCode add_opening(App *app, const SphOpeningSpec *spec, PetscReal *brought, PetscInt *zone)
{
  const AppScene *s = &app->scene;
  PetscReal dp, *x, *p;
  PetscInt n, m = 0;

  PetscFunctionBegin;
  PetscCall(SphGetSpacing(app->sph, &dp));
  PetscCall(SphOpeningSites(app->sph, spec, &n, &x));
  PetscCall(PetscMalloc1(n, &p));
  for (PetscInt i = 0; i < n; i++) {
    if ((spec->type == SPH_OUTFLOW || spec->given == SPH_OPENING_PRESSURE) && !fluid_behind(app, spec, dp, x + 3 * i)) continue;
    PetscCall(PetscArraymove(x + 3 * m, x + 3 * i, 3));
    p[m] = AppFluidPressure(app, x + 3 * m);
    m++;
  }
  PetscCall(SphAddOpening(app->sph, spec, m, x, p, NULL));
  *zone += n;
  if (spec->type == SPH_INFLOW && spec->given == SPH_OPENING_VELOCITY) {
    PetscReal most = spec->value, area = 1;
    for (PetscInt i = 0; i < spec->n; i++) most = i ? PetscMax(most, spec->values[i]) : spec->values[i];
    for (PetscInt e = 0; e < app->dim - 1; e++) {
      const PetscReal *v = e ? spec->edge2 : spec->edge1;
      area *= PetscSqrtReal(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    }
    *brought += most * area * s->tend;
  } else
    *brought = PETSC_MAX_REAL; /* a pressure brings any amount in */
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Room for what may come in: what the speeds bring, but not more than fills the domain with a tenth to spare, since the fluid is
  compressed by less; and twice the zones, whose columns need not go out when they come in.
*/
static PetscErrorCode predict_reserve(const App *app, PetscReal brought, PetscInt zone, PetscInt *reserve)
{
  const AppScene *s = &app->scene;
  PetscReal dp, site = 1, volume = 1, room;
  PetscInt fluid;

  PetscFunctionBegin;
  *reserve = s->reserve;
  if (s->reserve >= 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SphGetSpacing(app->sph, &dp));
  PetscCall(SphGetCounts(app->sph, &fluid, NULL, NULL));
  for (PetscInt a = 0; a < app->dim; a++) {
    site *= dp;
    volume *= s->hi[a] - s->lo[a];
  }
  room = PetscMax((PetscReal)1.1 * volume / site - (PetscReal)fluid, (PetscReal)0.1 * (PetscReal)fluid);
  room = PetscMin(room, (PetscReal)1.1 * brought / site);
  PetscCheck(room < 7e8, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "openings may bring %.2g markers in; this build takes fewer than 7e8: give openings_reserve", (double)room);
  *reserve = (PetscInt)room + 2 * zone;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Before the fluid, which is left out of their zones. brought: at most, m^3; zone: sites of all zones. */
PetscErrorCode AppBuildOpenings(App *app, PetscReal *brought, PetscInt *zone)
{
  const AppScene *s = &app->scene;

  PetscFunctionBegin;
  *brought = 0;
  *zone = 0;
  PetscCheck(!s->nopenings || app->sph, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "openings: '%s', but the scene has no fluid",
             s->openings[0].name);
  for (PetscInt i = 0; i < s->nopenings; i++) {
    SphOpeningSpec spec;
    AppTable table;
    AppDoing(app, "opening '%s'", s->openings[i].name);
    PetscCall(make_spec(app, &s->openings[i], &table, &spec));
    AppDoing(app, "%s", "");
    PetscCall(add_opening(app, &spec, brought, zone));
    PetscCall(AppTableDestroy(&table));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Markers in reserve, after the fluid. */
PetscErrorCode AppBuildReserve(App *app, PetscReal brought, PetscInt zone)
{
  PetscInt reserve;

  PetscFunctionBegin;
  if (!app->scene.nopenings) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(predict_reserve(app, brought, zone, &reserve));
  PetscCall(SphAddReserve(app->sph, reserve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How far beyond a face of the domain the other walls go on: along the zones of its openings, m. */
PetscErrorCode AppOpeningDepth(const App *app, PetscInt face, PetscReal *depth)
{
  const AppScene *s = &app->scene;
  PetscReal dp, support;

  PetscFunctionBegin;
  *depth = 0;
  PetscCall(SphGetSpacing(app->sph, &dp));
  PetscCall(SphGetSupport(app->sph, &support));
  for (PetscInt i = 0; i < s->nopenings; i++)
    if (s->openings[i].face == face + 1 && !s->wall[face]) *depth = PetscCeilReal(support / dp * (1 - 1e-9)) * dp;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Columns of the history: what has passed each opening. */
PetscErrorCode AppOpeningsPut(App *app, AppPut put, AppHistory h)
{
  const char *mass = app->dim == 2 ? "kg/m" : "kg";
  char name[96];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < app->scene.nopenings; i++) {
    const SceneOpening *o = &app->scene.openings[i];
    SphFlow f;
    PetscCall(SphGetFlow(app->sph, i, &f));
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s_markers_in", o->name));
    PetscCall(put(h, name, "1", "markers that came in through the opening since the start", f.in));
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s_markers_out", o->name));
    PetscCall(put(h, name, "1", "markers that went out through it", f.out));
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s_mass_in", o->name));
    PetscCall(put(h, name, mass, "mass that came in through the opening since the start", f.massin));
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s_mass_out", o->name));
    PetscCall(put(h, name, mass, "mass that went out through it", f.massout));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
