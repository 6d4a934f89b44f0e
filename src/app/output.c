/*
  output.c - the frames of a run: one HDF5 file each, written under another name and then put in its place, so that
  whatever happens later every frame on disk is whole.

  frame_NNNNN.h5: attributes time (s), step, scene; groups /markers, /beams/<name>/{nodes,line}, /bodies,
  /grids/<name>. Every dataset has the
  attributes unit and description.
*/
#include "app.h"
#include <dirent.h>
#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define FRAME_NAME "frame_%lld.h5%n"

#define POINTS_PER_ELEMENT 8

struct _AppOutput {
  char dir[PETSC_MAX_PATH_LEN], last[PETSC_MAX_PATH_LEN + 32];
  XdmfSeries series;
  PetscInt alloc, nmarkers;
  PetscReal tlast;
  PetscReal *vector, *scalar; /* 3 n and n values of the markers */
  PetscInt *group, *index;
};

/* Make the folder and its parents. */
static PetscErrorCode make_dir(const char dir[])
{
  char path[PETSC_MAX_PATH_LEN];
  struct stat st;

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(path, dir, sizeof(path)));
  for (char *c = path + 1;; c++) {
    char keep = *c;
    if (keep && keep != '/') continue;
    *c = 0;
    PetscCheck(!mkdir(path, 0777) || errno == EEXIST, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN,
               "output_dir: cannot make the folder '%s': %s", path, strerror(errno));
    *c = keep;
    if (!keep) break;
  }
  PetscCheck(!stat(dir, &st) && S_ISDIR(st.st_mode), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "output_dir: '%s' is not a folder",
             dir);
  PetscCheck(!access(dir, W_OK | X_OK), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "output_dir: cannot write in '%s': %s", dir,
             strerror(errno));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether the folder, or the nearest one above that exists, can be written in; makes nothing. */
PetscErrorCode AppOutputCheck(const char dir[])
{
  char path[PETSC_MAX_PATH_LEN], *slash;
  struct stat st;

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(path, dir, sizeof(path)));
  while (stat(path, &st)) {
    PetscCheck(errno == ENOENT, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "output_dir: cannot make the folder '%s': %s", dir,
               strerror(errno));
    slash = strrchr(path, '/');
    if (!slash)
      PetscCall(PetscStrncpy(path, ".", sizeof(path)));
    else if (slash == path)
      slash[1] = 0;
    else
      *slash = 0;
  }
  PetscCheck(S_ISDIR(st.st_mode), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "output_dir: '%s' is not a folder", path);
  PetscCheck(!access(path, W_OK | X_OK), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "output_dir: cannot write in '%s': %s", path,
             strerror(errno));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Number in a name such as frame_00012.h5, which may be that of a file not finished yet (.part); -1 for another name. */
static long long result_number(const char name[], const char format[], PetscBool *part)
{
  long long number;
  int end = 0;

  if (sscanf(name, format, &number, &end) != 1 || !end) return -1;
  *part = (PetscBool)(name[end] != 0);
  return *part && strcmp(name + end, ".part") ? -1 : number;
}

static PetscBool is_result(const char name[])
{
  static const char *const fixed[] = {"run.xdmf",   "run.xdmf.part",   "history.csv",
                                      "history.h5", "history.h5.part", "settings.txt"};
  PetscBool part;

  for (size_t i = 0; i < sizeof(fixed) / sizeof(fixed[0]); i++)
    if (!strcmp(name, fixed[i])) return PETSC_TRUE;
  return (PetscBool)(result_number(name, FRAME_NAME, &part) >= 0 || result_number(name, "checkpoint_%lld.h5%n", &part) >= 0);
}

/* Refuse to mix with an earlier run, or remove its files (and no others) when told to. */
static PetscErrorCode clear_dir(const char dir[], PetscBool overwrite)
{
  DIR *d = opendir(dir);
  struct dirent *entry;
  char path[2 * PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  PetscCheck(d, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "output_dir: cannot list '%s': %s", dir, strerror(errno));
  while ((entry = readdir(d))) {
    PetscBool found = is_result(entry->d_name);
    if (!found) continue;
    snprintf(path, sizeof(path), "%s/%s", dir, entry->d_name);
    if (!overwrite) closedir(d);
    PetscCheck(overwrite, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN,
               "output_dir: '%s' holds an earlier run; choose another folder or set output_overwrite", dir);
    PetscCheck(!unlink(path), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "output_dir: cannot remove '%s': %s", path, strerror(errno));
  }
  closedir(d);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* settings.txt: every option as used, and every solver's view. */
static PetscErrorCode write_settings(const App *app, const char dir[])
{
  char path[PETSC_MAX_PATH_LEN + 32];
  PetscViewer viewer;

  PetscFunctionBegin;
  snprintf(path, sizeof(path), "%s/settings.txt", dir);
  PetscCall(PetscViewerASCIIOpen(PETSC_COMM_SELF, path, &viewer));
  PetscCall(PetscViewerASCIIPrintf(viewer, "frond %s, scene %s\n", FROND_VERSION, app->scene.name));
  PetscCall(PetscOptionsView(NULL, viewer));
  if (app->couple) PetscCall(CoupleView(app->couple, viewer));
  if (app->shortrange && !app->couple) PetscCall(CoupleShortView(app->shortrange, viewer));
  if (app->attach && !app->couple) PetscCall(CoupleAttachView(app->attach, viewer));
  if (app->sph) PetscCall(SphView(app->sph, viewer));
  if (app->ancf) PetscCall(AncfView(app->ancf, viewer));
  if (app->rigid) PetscCall(RigidView(app->rigid, viewer));
  PetscCall(PetscViewerDestroy(&viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppOutputCreate(const App *app, AppOutput *output)
{
  AppOutput out;
  PetscInt longest = app->nfluid + app->nboundary;

  PetscFunctionBegin;
  PetscCall(make_dir(app->scene.outdir));
  if (!app->scene.restart[0]) PetscCall(clear_dir(app->scene.outdir, app->scene.overwrite));
  PetscCall(PetscNew(&out));
  *output = out;
  PetscCall(PetscStrncpy(out->dir, app->scene.outdir, sizeof(out->dir)));
  out->series.app = app;
  out->nmarkers = app->nfluid + app->nboundary;
  PetscCall(PetscMalloc1(app->scene.nbeams, &out->series.points));
  for (PetscInt b = 0; b < app->scene.nbeams; b++) {
    out->series.points[b] = app->scene.beams[b].spec.elements * POINTS_PER_ELEMENT + 1;
    longest = PetscMax(longest, out->series.points[b]);
  }
  longest = PetscMax(longest, app->scene.nbodies);
  PetscCall(PetscMalloc4(3 * (size_t)longest, &out->vector, longest, &out->scalar, longest, &out->group, longest, &out->index));
  for (PetscInt i = 0; i < longest; i++) out->index[i] = i;
  PetscCall(write_settings(app, out->dir));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode write_markers(AppOutput out, App *app, int64_t file)
{
  const PetscBool *want = app->scene.field;
  PetscInt n = out->nmarkers;
  PetscReal dp;
  SphFields all;
  int64_t g;

  PetscFunctionBegin;
  PetscCall(AppH5Group(file, "markers", &g));
  PetscCall(AppH5Int(g, &(H5Label){"index", "1", "marker number in the order of the set-up: fluid, then each boundary group"}, n,
                     0, out->index));
  PetscCall(PetscMemzero(&all, sizeof(all)));
  all.x = out->vector;
  PetscCall(SphGetFields(app->sph, &all));
  PetscCall(AppH5Real(g, &(H5Label){"position", "m", "marker position"}, PETSC_FALSE, n, 3, out->vector));
  PetscCall(PetscMemzero(&all, sizeof(all)));
  all.v = out->vector;
  all.rho = out->scalar;
  all.group = out->group;
  PetscCall(SphGetFields(app->sph, &all));
  if (want[FIELD_VELOCITY])
    PetscCall(AppH5Real(g, &(H5Label){"velocity", "m/s", "marker velocity"}, PETSC_TRUE, n, 3, out->vector));
  if (want[FIELD_DENSITY])
    PetscCall(AppH5Real(g, &(H5Label){"density", "kg/m^3", "marker density"}, PETSC_TRUE, n, 0, out->scalar));
  if (want[FIELD_GROUP])
    PetscCall(AppH5Int(g,
                       &(H5Label){"group", "1",
                                  "-1 fluid, -2 left the domain or in reserve, -3 - k zone of opening k, else the boundary group "
                                  "(see the attribute groups)"},
                       n, 0, out->group));
  PetscCall(PetscMemzero(&all, sizeof(all)));
  all.a = out->vector;
  all.p = out->scalar;
  PetscCall(SphGetFields(app->sph, &all));
  if (want[FIELD_PRESSURE])
    PetscCall(AppH5Real(g, &(H5Label){"pressure", "Pa", "pressure from the equation of state"}, PETSC_TRUE, n, 0, out->scalar));
  if (want[FIELD_ACCELERATION])
    PetscCall(AppH5Real(g, &(H5Label){"acceleration", "m/s^2", "right-hand side of the momentum equation at the last evaluation"},
                        PETSC_TRUE, n, 3, out->vector));
  PetscCall(SphGetSpacing(app->sph, &dp));
  PetscCall(AppH5AttrReal(g, "spacing", dp));
  for (PetscInt i = 0; i < app->nsurfaces; i++) {
    char key[32];
    PetscCall(PetscSNPrintf(key, sizeof(key), "group_%" PetscInt_FMT "", app->surfaces[i].group));
    PetscCall(AppH5AttrString(g, key, app->surfaces[i].name));
  }
  PetscCall(AppH5GroupClose(g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode write_nodes(App *app, PetscInt beam, int64_t g)
{
  const PetscReal *e, *edot;
  PetscInt first, nodes = app->scene.beams[beam].spec.elements + 1;
  int64_t h;

  PetscFunctionBegin;
  PetscCall(AncfGetBeam(app->ancf, beam, NULL, &first, NULL));
  PetscCall(AncfGetState(app->ancf, NULL, &e, &edot, NULL));
  PetscCall(AppH5Group(g, "nodes", &h));
  PetscCall(AppH5Real(h, &(H5Label){"coordinates", "m, 1", "nodal coordinates: position (m) and position gradient (-)"},
                      PETSC_FALSE, nodes, 6, e + 6 * first));
  PetscCall(AppH5Real(h, &(H5Label){"velocities", "m/s, 1/s", "time derivatives of the nodal coordinates"}, PETSC_FALSE, nodes, 6,
                      edot + 6 * first));
  PetscCall(AppH5GroupClose(h));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Axial force, curvature and bending moment at n points at equal distances. */
static PetscErrorCode write_sections(App *app, PetscInt beam, PetscInt n, int64_t h)
{
  const char *force = app->dim == 2 ? "N/m" : "N", *moment = app->dim == 2 ? "N" : "N m";
  PetscReal *N, *kappa, *M;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(n, &N, 3 * (size_t)n, &kappa, 3 * (size_t)n, &M));
  for (PetscInt i = 0; i < n; i++)
    PetscCall(AncfGetSection(app->ancf, beam, (PetscReal)i / (PetscReal)(n - 1), NULL, &N[i], kappa + 3 * i, M + 3 * i));
  PetscCall(AppH5Real(h, &(H5Label){"axial_force", force, "elastic axial force, tension positive"}, PETSC_FALSE, n, 0, N));
  PetscCall(
      AppH5Real(h, &(H5Label){"curvature", "1/m", "curvature vector r' x r'' of the centre line"}, PETSC_FALSE, n, 3, kappa));
  PetscCall(AppH5Real(h, &(H5Label){"moment", moment, "elastic bending moment"}, PETSC_FALSE, n, 3, M));
  PetscCall(PetscFree3(N, kappa, M));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode write_beam(AppOutput out, App *app, PetscInt beam, int64_t beams)
{
  const AncfBeamSpec *spec = &app->scene.beams[beam].spec;
  AncfBeamSpec got;
  PetscInt n = out->series.points[beam];
  PetscReal *v, *s, l, L, *r = out->vector, *stretch = out->scalar;
  int64_t g, h;

  PetscFunctionBegin;
  PetscCall(AncfGetBeam(app->ancf, beam, &got, NULL, &l));
  L = l * (PetscReal)spec->elements;
  PetscCall(PetscMalloc2(3 * (size_t)n, &v, n, &s));
  for (PetscInt i = 0; i < n; i++) {
    PetscReal rx[3];
    s[i] = L * (PetscReal)i / (PetscReal)(n - 1);
    PetscCall(AppBeamPoint(app, beam, s[i], r + 3 * i, v + 3 * i, rx));
    stretch[i] = PetscSqrtReal(rx[0] * rx[0] + rx[1] * rx[1] + rx[2] * rx[2]);
  }
  PetscCall(AppH5Group(beams, app->scene.beams[beam].name, &g));
  PetscCall(AppH5AttrReal(g, "diameter", got.diameter));
  PetscCall(AppH5AttrReal(g, "length", L));
  PetscCall(AppH5AttrInt(g, "elements", spec->elements));
  PetscCall(write_nodes(app, beam, g));
  PetscCall(AppH5Group(g, "line", &h));
  PetscCall(AppH5Int(h, &(H5Label){"index", "1", "point number along the axis"}, n, 0, out->index));
  PetscCall(AppH5Real(h, &(H5Label){"position", "m", "points of the centre line, from the elements' shape functions"},
                      PETSC_FALSE, n, 3, r));
  PetscCall(AppH5Real(h, &(H5Label){"velocity", "m/s", "velocity of the centre line"}, PETSC_FALSE, n, 3, v));
  PetscCall(AppH5Real(h, &(H5Label){"stretch", "1", "length of the position gradient"}, PETSC_FALSE, n, 0, stretch));
  PetscCall(AppH5Real(h, &(H5Label){"coordinate", "m", "material coordinate along the axis"}, PETSC_FALSE, n, 0, s));
  PetscCall(write_sections(app, beam, n, h));
  PetscCall(AppH5GroupClose(h));
  PetscCall(AppH5GroupClose(g));
  PetscCall(PetscFree2(v, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode write_bodies(AppOutput out, App *app, int64_t file)
{
  PetscInt n = app->scene.nbodies;
  PetscReal *X, *q, *V, *W;
  int64_t g;

  PetscFunctionBegin;
  PetscCall(PetscMalloc4(3 * (size_t)n, &X, 4 * (size_t)n, &q, 3 * (size_t)n, &V, 3 * (size_t)n, &W));
  for (PetscInt i = 0; i < n; i++) PetscCall(RigidGetState(app->rigid, i, X + 3 * i, q + 4 * i, V + 3 * i, W + 3 * i));
  PetscCall(AppH5Group(file, "bodies", &g));
  PetscCall(AppH5Int(g, &(H5Label){"index", "1", "body number in the order of the option bodies"}, n, 0, out->index));
  PetscCall(AppH5Real(g, &(H5Label){"position", "m", "centre of mass"}, PETSC_FALSE, n, 3, X));
  PetscCall(AppH5Real(g, &(H5Label){"orientation", "1", "unit quaternion, scalar part first"}, PETSC_FALSE, n, 4, q));
  PetscCall(AppH5Real(g, &(H5Label){"velocity", "m/s", "velocity of the centre of mass"}, PETSC_FALSE, n, 3, V));
  PetscCall(AppH5Real(g, &(H5Label){"omega", "rad/s", "angular velocity, space frame"}, PETSC_FALSE, n, 3, W));
  for (PetscInt i = 0; i < n; i++) {
    char key[32];
    PetscCall(PetscSNPrintf(key, sizeof(key), "body_%" PetscInt_FMT "", i));
    PetscCall(AppH5AttrString(g, key, app->scene.bodies[i].name));
  }
  PetscCall(AppH5GroupClose(g));
  PetscCall(PetscFree4(X, q, V, W));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode write_frame(AppOutput out, App *app, int64_t file)
{
  int64_t g;

  PetscFunctionBegin;
  PetscCall(AppH5AttrString(file, "program", "frond " FROND_VERSION));
  PetscCall(AppH5AttrString(file, "scene", app->scene.name));
  PetscCall(AppH5AttrReal(file, "time", app->t));
  PetscCall(AppH5AttrInt(file, "step", app->step));
  PetscCall(AppH5AttrInt(file, "dimension", app->dim));
  if (app->sph) PetscCall(write_markers(out, app, file));
  if (app->ancf) {
    PetscCall(AppH5Group(file, "beams", &g));
    for (PetscInt b = 0; b < app->scene.nbeams; b++) PetscCall(write_beam(out, app, b, g));
    PetscCall(AppH5GroupClose(g));
  }
  if (app->rigid) PetscCall(write_bodies(out, app, file));
  PetscCall(AppGridsWrite(app, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Write the next frame at the current time, and the index of all frames. */
PetscErrorCode AppOutputWrite(AppOutput out, App *app)
{
  XdmfSeries *series = &out->series;
  char name[32], path[PETSC_MAX_PATH_LEN + 32], tmp[PETSC_MAX_PATH_LEN + 40];
  int64_t file;

  PetscFunctionBegin;
  AppFrameName(series->nframes, sizeof(name), name);
  snprintf(path, sizeof(path), "%s/%s", out->dir, name);
  snprintf(tmp, sizeof(tmp), "%s.part", path);
  PetscCall(AppH5Create(tmp, &file));
  PetscCall(write_frame(out, app, file));
  PetscCall(AppH5Close(file, path));
  PetscCheck(!rename(tmp, path), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "cannot write '%s': %s", path, strerror(errno));
  if (series->nframes == out->alloc) {
    out->alloc = 2 * out->alloc + 64;
    PetscCall(PetscRealloc((size_t)out->alloc * sizeof(PetscReal), &series->time));
  }
  series->time[series->nframes++] = app->t;
  out->tlast = app->t;
  PetscCall(PetscStrncpy(out->last, path, sizeof(out->last)));
  PetscCall(AppXdmfWrite(out->dir, series));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Frames from number `first` on belong to a future that will be computed anew. */
static PetscErrorCode cut_frames(AppOutput out)
{
  char path[2 * PETSC_MAX_PATH_LEN];
  struct dirent *entry;
  DIR *d = opendir(out->dir);

  PetscFunctionBegin;
  PetscCheck(d, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "output_dir: cannot list '%s': %s", out->dir, strerror(errno));
  while ((entry = readdir(d))) {
    PetscBool part;
    const long long number = result_number(entry->d_name, FRAME_NAME, &part);
    if (number < 0 || (!part && number < out->series.nframes)) continue;
    snprintf(path, sizeof(path), "%s/%s", out->dir, entry->d_name);
    PetscCheck(!unlink(path), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "output_dir: cannot remove '%s': %s", path, strerror(errno));
  }
  closedir(d);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppOutputMoveState(AppOutput out, FrondState *s)
{
  XdmfSeries *series = &out->series;

  PetscFunctionBegin;
  FrondMoveInt(s, "run/frames", &series->nframes, 1);
  FrondMoveReal(s, "run/frame_last", &out->tlast, 1);
  if (s->way == FROND_STATE_LOAD) {
    PetscCheck(series->nframes >= 0 && series->nframes < 100000000, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
               "the checkpoint has %" PetscInt_FMT " frames", series->nframes);
    out->alloc = series->nframes + 64;
    PetscCall(PetscRealloc((size_t)out->alloc * sizeof(PetscReal), &series->time));
  }
  FrondMoveReal(s, "run/frame_times", series->time, series->nframes);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppOutputCut(AppOutput out)
{
  XdmfSeries *series = &out->series;
  char name[32] = "";

  PetscFunctionBegin;
  PetscCall(cut_frames(out));
  for (series->first = series->nframes; series->first > 0; series->first--) {
    AppFrameName(series->first - 1, sizeof(name), name);
    snprintf(out->last, sizeof(out->last), "%s/%s", out->dir, name);
    if (access(out->last, R_OK)) break;
  }
  if (series->nframes) AppFrameName(series->nframes - 1, sizeof(name), name);
  snprintf(out->last, sizeof(out->last), "%s/%s", out->dir, series->nframes ? name : "");
  PetscCall(AppXdmfWrite(out->dir, series));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Time (s) and file of the last whole frame, and how many there are. */
PetscErrorCode AppOutputLast(AppOutput out, PetscReal *t, const char **file, PetscInt *frames)
{
  PetscFunctionBegin;
  if (t) *t = out->tlast;
  if (file) *file = out->last;
  if (frames) *frames = out->series.nframes;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppOutputDestroy(AppOutput *out)
{
  PetscFunctionBegin;
  if (!*out) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree((*out)->series.points));
  PetscCall(PetscFree((*out)->series.time));
  PetscCall(PetscFree4((*out)->vector, (*out)->scalar, (*out)->group, (*out)->index));
  PetscCall(PetscFree(*out));
  PetscFunctionReturn(PETSC_SUCCESS);
}
