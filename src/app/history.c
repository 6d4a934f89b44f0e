/*
  history.c - the probe table of a run: beam tips, body states, fluid forces, energies, momentum balance, transfer audit.

  history.csv grows while the run goes on, one flushed line per row; history.h5 holds the same columns as datasets
  and is written at the end. A value that is not finite stops the run before its row is written.
*/
#include "app.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct {
  char name[96], unit[16], description[96];
} Column;

struct _AppHistory {
  char dir[PETSC_MAX_PATH_LEN];
  FILE *csv;
  PetscBool known;                         /* the columns are made */
  off_t end;                               /* of the rows of a checkpoint */
  PetscInt ncols, acols, nrows, arows, at; /* at: the column being filled */
  Column *column;
  PetscReal *row, *rows; /* ncols; nrows x ncols */
  HistoryWorst worst;
  AppAudit audit;
  char message[512];
};

static PetscReal norm3(const PetscReal v[3])
{
  return PetscSqrtReal(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* Append a value; the first row also makes the column. */
static PetscErrorCode put(AppHistory h, const char name[], const char unit[], const char description[], PetscReal value)
{
  PetscFunctionBegin;
  if (!h->known && h->at == h->ncols) {
    if (h->ncols == h->acols) {
      h->acols = 2 * h->acols + 32;
      PetscCall(PetscRealloc((size_t)h->acols * sizeof(Column), &h->column));
      PetscCall(PetscRealloc((size_t)h->acols * sizeof(PetscReal), &h->row));
    }
    PetscCall(PetscStrncpy(h->column[h->ncols].name, name, sizeof(h->column->name)));
    PetscCall(PetscStrncpy(h->column[h->ncols].unit, unit, sizeof(h->column->unit)));
    PetscCall(PetscStrncpy(h->column[h->ncols].description, description, sizeof(h->column->description)));
    h->ncols++;
  }
  h->row[h->at++] = value;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode put3(AppHistory h, const char stem[], const char unit[], const char description[], const PetscReal value[3])
{
  char name[96];

  PetscFunctionBegin;
  for (int a = 0; a < 3; a++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s%c", stem, "xyz"[a]));
    PetscCall(put(h, name, unit, description, value[a]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode put_beams(AppHistory h, App *app)
{
  const char *energy = app->dim == 2 ? "J/m" : "J";
  PetscReal kinetic, elastic, potential, dissipation, r[3], v[3], reaction[3], l, off[2];
  char stem[96];
  PetscInt steps, newton, linear;

  PetscFunctionBegin;
  if (!app->ancf) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt b = 0; b < app->scene.nbeams; b++) {
    const AncfBeamSpec *spec = &app->scene.beams[b].spec;
    PetscCall(AncfGetBeam(app->ancf, b, NULL, NULL, &l));
    PetscCall(AppBeamPoint(app, b, l * (PetscReal)spec->elements, r, v, NULL));
    PetscCall(PetscSNPrintf(stem, sizeof(stem), "%s_tip_", app->scene.beams[b].name));
    PetscCall(put3(h, stem, "m", "position of the beam's last end", r));
    PetscCall(PetscSNPrintf(stem, sizeof(stem), "%s_tip_v", app->scene.beams[b].name));
    PetscCall(put3(h, stem, "m/s", "velocity of the beam's last end", v));
  }
  PetscCall(AncfGetEnergy(app->ancf, &kinetic, &elastic, &potential));
  PetscCall(put(h, "beams_kinetic", energy, "kinetic energy of all beams", kinetic));
  PetscCall(put(h, "beams_elastic", energy, "elastic energy of all beams", elastic));
  PetscCall(put(h, "beams_potential", energy, "potential energy of all beams", potential));
  PetscCall(AncfGetDissipation(app->ancf, &dissipation));
  PetscCall(put(h, "beams_dissipation", app->dim == 2 ? "W/m" : "W", "power that damping takes from the beams", dissipation));
  PetscCall(AncfGetReaction(app->ancf, reaction));
  PetscCall(put3(h, "beams_support_", app->dim == 2 ? "N/m" : "N", "force of the supports on all beams", reaction));
  PetscCall(AncfGetConstraintError(app->ancf, &off[0], &off[1]));
  PetscCall(put(h, "beams_constraint_position", "m", "largest violation of supports and joints (directions: rad)", off[0]));
  PetscCall(put(h, "beams_constraint_velocity", "m/s", "the same of velocities (directions: rad/s)", off[1]));
  PetscCall(AncfGetCounts(app->ancf, &steps, &newton, &linear));
  PetscCall(put(h, "beams_steps", "1", "time steps of the beams since the start", (PetscReal)steps));
  PetscCall(put(h, "beams_newton", "1", "Newton iterations of the beams since the start", (PetscReal)newton));
  PetscCall(put(h, "beams_linear", "1", "linear iterations of the beams since the start", (PetscReal)linear));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tips of the lumped beams, in the columns that ANCF beams have too, coordinates of the joints and how well they are met. */
static PetscErrorCode put_lumped(AppHistory h, App *app)
{
  PetscReal r[3], v[3], coordinate, off[2];
  char stem[96];

  PetscFunctionBegin;
  for (PetscInt b = 0; b < app->scene.nlumped; b++) {
    PetscCall(AppLumpedTip(app, b, r, v));
    PetscCall(PetscSNPrintf(stem, sizeof(stem), "%s_tip_", app->scene.lumped[b].name));
    PetscCall(put3(h, stem, "m", "position of the beam's last end", r));
    PetscCall(PetscSNPrintf(stem, sizeof(stem), "%s_tip_v", app->scene.lumped[b].name));
    PetscCall(put3(h, stem, "m/s", "velocity of the beam's last end", v));
  }
  for (PetscInt i = 0; i < app->scene.njoints; i++) {
    const SceneJoint *j = &app->scene.joints[i];
    const PetscBool angle = (PetscBool)(j->spec.type == RIGID_JOINT_HINGE || j->spec.type == RIGID_JOINT_BEND);
    if (j->spec.type == RIGID_JOINT_BALL) continue;
    PetscCall(RigidGetJointState(app->rigid, j->joint, &coordinate, NULL));
    PetscCall(PetscSNPrintf(stem, sizeof(stem), "%s_coordinate", j->name));
    PetscCall(put(h, stem, angle ? "rad" : "m", "angle, shift or elongation of the joint", coordinate));
  }
  if (app->scene.njoints || app->scene.nlumped) {
    PetscCall(RigidGetJointError(app->rigid, &off[0], &off[1]));
    PetscCall(put(h, "joints_constraint_position", "m", "largest violation of the bodies' joints (directions: rad)", off[0]));
    PetscCall(put(h, "joints_constraint_velocity", "m/s", "the same of velocities (directions: rad/s)", off[1]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode put_bodies(AppHistory h, App *app)
{
  const char *energy = app->dim == 2 ? "J/m" : "J";
  PetscReal kinetic, potential, X[3], V[3], W[3];
  char stem[96];

  PetscFunctionBegin;
  if (!app->rigid) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt b = 0; b < app->scene.nbodies; b++) {
    PetscCall(RigidGetState(app->rigid, b, X, NULL, V, W));
    PetscCall(PetscSNPrintf(stem, sizeof(stem), "%s_", app->scene.bodies[b].name));
    PetscCall(put3(h, stem, "m", "centre of mass of the body", X));
    PetscCall(PetscSNPrintf(stem, sizeof(stem), "%s_v", app->scene.bodies[b].name));
    PetscCall(put3(h, stem, "m/s", "velocity of the body's centre of mass", V));
    PetscCall(PetscSNPrintf(stem, sizeof(stem), "%s_w", app->scene.bodies[b].name));
    PetscCall(put3(h, stem, "rad/s", "angular velocity of the body, space frame", W));
  }
  PetscCall(put_lumped(h, app));
  PetscCall(RigidGetEnergy(app->rigid, &kinetic, &potential));
  PetscCall(put(h, "bodies_kinetic", energy, "kinetic energy of all bodies", kinetic));
  PetscCall(put(h, "bodies_potential", energy, "potential energy of all bodies", potential));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What bodies exert on the beams attached to them. */
static PetscErrorCode put_links(AppHistory h, App *app)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < app->scene.nlinks; i++) {
    const SceneLink *l = &app->scene.links[i];
    PetscReal F[3], sum[3] = {0, 0, 0};
    char stem[96];

    if (!l->body[0]) continue;
    for (PetscInt k = 0; k < l->n; k++) {
      PetscCall(CoupleAttachGetForce(app->attach, l->first + k, F, NULL));
      for (int a = 0; a < 3; a++) sum[a] += F[a];
    }
    PetscCall(PetscSNPrintf(stem, sizeof(stem), "%s_f", l->name));
    PetscCall(put3(h, stem, app->dim == 2 ? "N/m" : "N", "force of the body on the beams of this link, last step", sum));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode put_surfaces(AppHistory h, App *app)
{
  const PetscBool flat = (PetscBool)(app->dim == 2);
  const char *force = flat ? "N/m" : "N", *moment = flat ? "N" : "N m", *power = flat ? "W/m" : "W";
  PetscReal lost[3] = {0, 0, 0};
  HistoryWorst *worst = &h->worst;
  char stem[96];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < app->nsurfaces; i++) {
    CoupleAudit audit;
    PetscCall(CoupleGetAudit(app->couple, i, &audit));
    PetscCall(PetscSNPrintf(stem, sizeof(stem), "%s_f", app->surfaces[i].name));
    PetscCall(put3(h, stem, force, "force of the fluid on this surface", audit.force));
    for (int f = 0; f < 6; f++) {
      char wall[32];
      PetscReal X[3];
      PetscCall(PetscSNPrintf(wall, sizeof(wall), "wall_%s", SceneFaces[f]));
      if (!app->mover[f] || strcmp(wall, app->surfaces[i].name)) continue;
      PetscCall(RigidGetState(app->mover[f], 0, X, NULL, NULL, NULL));
      PetscCall(PetscSNPrintf(stem, sizeof(stem), "%s_", wall));
      PetscCall(put3(h, stem, "m", "the wall's pivot", X));
    }
    lost[0] = PetscMax(lost[0], norm3(audit.force_lost));
    lost[1] = PetscMax(lost[1], norm3(audit.moment_lost));
    lost[2] = PetscMax(lost[2], PetscAbsReal(audit.power_lost));
    worst->force = PetscMax(worst->force, norm3(audit.force));
    worst->moment = PetscMax(worst->moment, norm3(audit.moment));
    worst->power = PetscMax(worst->power, PetscAbsReal(audit.power));
  }
  PetscCall(
      put(h, "transfer_force_lost", force, "largest over the surfaces: marker total less what the structure received", lost[0]));
  PetscCall(put(h, "transfer_moment_lost", moment, "largest over the surfaces: marker total less what the structure received",
                lost[1]));
  PetscCall(
      put(h, "transfer_power_lost", power, "largest over the surfaces: marker total less what the structure received", lost[2]));
  worst->forcelost = PetscMax(worst->forcelost, lost[0]);
  worst->momentlost = PetscMax(worst->momentlost, lost[1]);
  worst->powerlost = PetscMax(worst->powerlost, lost[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode put_fluid(AppHistory h, App *app)
{
  const PetscBool flat = (PetscBool)(app->dim == 2);
  const char *energy = flat ? "J/m" : "J", *impulse = flat ? "kg/s" : "kg m/s";
  SphSums sums;
  CoupleBalance balance;

  PetscFunctionBegin;
  if (!app->sph) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SphGetSums(app->sph, &sums));
  PetscCall(put(h, "fluid_mass", flat ? "kg/m" : "kg", "mass of the fluid", sums.mass));
  PetscCall(put(h, "fluid_kinetic", energy, "kinetic energy of the fluid", sums.kinetic));
  PetscCall(put(h, "fluid_potential", energy, "potential energy of the fluid in the body force", sums.potential));
  PetscCall(put(h, "fluid_internal", energy, "energy of compression of the fluid", sums.internal));
  PetscCall(put(h, "fluid_speed_max", "m/s", "largest speed of a fluid marker", sums.vmax));
  PetscCall(put(h, "fluid_compression_max", "1", "largest |rho/rho0 - 1| of a fluid marker", sums.compression));
  PetscCall(put3(h, "fluid_momentum_", impulse, "momentum of the fluid", sums.momentum));
  PetscCall(put_surfaces(h, app));
  PetscCall(CoupleGetBalance(app->couple, &balance));
  PetscCall(put3(h, "momentum_residual_", impulse, "momentum now - initial - impulses of body forces, supports and walls",
                 balance.residual));
  PetscCall(put(h, "momentum_scale", impulse, "largest term of the momentum balance", balance.scale));
  h->worst.vmax = PetscMax(h->worst.vmax, sums.vmax);
  h->worst.compression = PetscMax(h->worst.compression, sums.compression);
  h->worst.residual = PetscMax(h->worst.residual, norm3(balance.residual));
  h->worst.scale = PetscMax(h->worst.scale, balance.scale);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode write_header(AppHistory h)
{
  PetscFunctionBegin;
  for (PetscInt c = 0; c < h->ncols; c++) fprintf(h->csv, "%s%s[%s]", c ? "," : "", h->column[c].name, h->column[c].unit);
  fputc('\n', h->csv);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The shortest of the two forms that gives the same number back. */
static void write_number(FILE *f, PetscReal x)
{
  char text[40];

  snprintf(text, sizeof(text), "%.15g", (double)x);
  if (strtod(text, NULL) != (double)x) snprintf(text, sizeof(text), "%.17g", (double)x);
  fputs(text, f);
}

PetscErrorCode AppHistoryCreate(App *app, AppHistory *history)
{
  char path[PETSC_MAX_PATH_LEN + 32];
  AppHistory h;

  PetscFunctionBegin;
  PetscCall(PetscNew(&h));
  *history = h;
  PetscCall(PetscStrncpy(h->dir, app->scene.outdir, sizeof(h->dir)));
  snprintf(path, sizeof(path), "%s/history.csv", h->dir);
  h->csv = fopen(path, app->scene.restart[0] ? "a+" : "w");
  PetscCheck(h->csv, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write '%s': %s", path, strerror(errno));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The values of the current time; the first call makes the columns. */
static PetscErrorCode fill_row(AppHistory h, App *app, PetscReal dt)
{
  PetscFunctionBegin;
  h->at = 0;
  PetscCall(put(h, "time", "s", "time", app->t));
  PetscCall(put(h, "step", "1", "number of steps taken", (PetscReal)app->step));
  PetscCall(put(h, "dt", "s", "last time step", dt));
  PetscCall(put_beams(h, app));
  PetscCall(put_bodies(h, app));
  PetscCall(put_links(h, app));
  PetscCall(put_fluid(h, app));
  PetscCall(AppAuditPut(app, &h->audit, put, h));
  PetscCall(AppOpeningsPut(app, put, h));
  PetscCall(AppProbesPut(app, put, h));
  h->known = PETSC_TRUE;
  for (PetscInt c = 0; c < h->ncols; c++)
    PetscCheck(!PetscIsInfOrNanReal(h->row[c]), PETSC_COMM_SELF, PETSC_ERR_FP,
               "%s is not finite at step %" PetscInt_FMT ", time %g s", h->column[c].name, app->step, (double)app->t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keep h->row. */
static PetscErrorCode add_row(AppHistory h)
{
  PetscFunctionBegin;
  if (h->nrows == h->arows) {
    h->arows = 2 * h->arows + 256;
    PetscCall(PetscRealloc((size_t)h->arows * (size_t)h->ncols * sizeof(PetscReal), &h->rows));
  }
  PetscCall(PetscArraycpy(h->rows + (size_t)h->nrows * (size_t)h->ncols, h->row, h->ncols));
  h->nrows++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Add the row of the current time; dt (s) is the last step's. */
PetscErrorCode AppHistoryRecord(AppHistory h, App *app, PetscReal dt)
{
  PetscFunctionBegin;
  PetscCall(AppAuditUpdate(app, &h->audit));
  PetscCall(fill_row(h, app, dt));
  if (!h->nrows) PetscCall(write_header(h));
  for (PetscInt c = 0; c < h->ncols; c++) {
    if (c) fputc(',', h->csv);
    write_number(h->csv, h->row[c]);
  }
  fputc('\n', h->csv);
  PetscCheck(!fflush(h->csv) && !ferror(h->csv), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "cannot write '%s/history.csv': %s",
             h->dir, strerror(errno));
  PetscCall(add_row(h));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppHistorySync(AppHistory h)
{
  PetscFunctionBegin;
  PetscCheck(!fsync(fileno(h->csv)), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "cannot write '%s/history.csv': %s", h->dir,
             strerror(errno));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The line just read is a header or a row of this table; a row of finite numbers goes to h->row. */
static PetscBool parse_line(AppHistory h, char *line, PetscBool header)
{
  char name[128], *at = line, *end;

  for (PetscInt c = 0; c < h->ncols; c++) {
    if (header) {
      const size_t n = (size_t)snprintf(name, sizeof(name), "%s[%s]", h->column[c].name, h->column[c].unit);
      if (strncmp(at, name, n)) return PETSC_FALSE;
      end = at + n;
    } else
      h->row[c] = strtod(at, &end);
    if (end == at || *end != (c == h->ncols - 1 ? '\n' : ',') || (!header && PetscIsInfOrNanReal(h->row[c]))) return PETSC_FALSE;
    at = end + 1;
  }
  return PETSC_TRUE;
}

/* Into h->message: the first column of a history.csv with this header that is not the table's. */
static PetscErrorCode name_columns(AppHistory h, const char *header)
{
  char name[128] = "";
  size_t n = 0;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < h->ncols; c++, header += n + (header[n] == ',')) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s[%s]", h->column[c].name, h->column[c].unit));
    n = strcspn(header, ",");
    if (n != strlen(name) || strncmp(header, name, n)) break;
    name[0] = 0;
  }
  if (!name[0]) n = strcspn(header, ",");
  PetscCall(
      PetscSNPrintf(h->message, sizeof(h->message),
                    "'%s/history.csv' has other columns than this run: '%.*s' where there is '%s' now (audit, probes, beams, "
                    "bodies, joints make columns): set output_dir to a new folder, where the history begins anew",
                    h->dir, n ? (int)PetscMin(n, 100) : 4, n ? header : "none", name[0] ? name : "none"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Read `rows` rows of the run so far; a folder without a history begins one. */
static PetscErrorCode read_rows(AppHistory h, PetscInt rows, PetscReal tlast)
{
  char *line = NULL;
  size_t len = 0;
  PetscBool good;

  PetscFunctionBegin;
  rewind(h->csv);
  h->end = 0;
  if (getline(&line, &len, h->csv) < 0 || !rows) {
    free(line);
    if (rows) printf("'%s' has no history of the time before: it begins here\n", h->dir);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  good = parse_line(h, line, PETSC_TRUE);
  if (!good) {
    line[strcspn(line, "\n")] = 0;
    PetscCall(name_columns(h, line));
    free(line);
    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED, "%s", h->message);
  }
  while (good && h->nrows < rows && (good = getline(&line, &len, h->csv) > 0 && parse_line(h, line, PETSC_FALSE)))
    PetscCall(add_row(h));
  free(line);
  PetscCheck(good && h->row[0] == tlast, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
             "'%s/history.csv' is not that of the checkpoint, which has %" PetscInt_FMT
             " rows up to t = %.9g s: set output_dir to the run's own folder or to a new one",
             h->dir, rows, (double)tlast);
  h->end = ftello(h->csv);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppHistoryCut(AppHistory h)
{
  PetscFunctionBegin;
  PetscCheck(h->end >= 0 && !ftruncate(fileno(h->csv), h->end) && !fseeko(h->csv, 0, SEEK_END), PETSC_COMM_SELF,
             PETSC_ERR_FILE_WRITE, "cannot cut '%s/history.csv': %s", h->dir, strerror(errno));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppHistoryMoveState(AppHistory h, App *app, FrondState *s)
{
  PetscInt rows = h->nrows;
  PetscReal tlast = h->nrows ? h->rows[(size_t)(h->nrows - 1) * (size_t)h->ncols] : 0;
  HistoryWorst worst = h->worst;

  PetscFunctionBegin;
  FrondMoveInt(s, "run/history_rows", &rows, 1);
  FrondMoveReal(s, "run/history_last", &tlast, 1);
  FrondMoveReal(s, "run/history_worst", (PetscReal *)&worst, sizeof(worst) / sizeof(PetscReal));
  FrondMoveReal(s, "run/audit", (PetscReal *)&h->audit, sizeof(h->audit) / sizeof(PetscReal));
  if (s->way == FROND_STATE_LOAD) {
    PetscCall(fill_row(h, app, 0)); /* for the columns */
    PetscCall(read_rows(h, rows, tlast));
    h->worst = worst;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode write_h5(AppHistory h)
{
  char path[PETSC_MAX_PATH_LEN + 32], tmp[PETSC_MAX_PATH_LEN + 40];
  PetscReal *values;
  int64_t file;

  PetscFunctionBegin;
  snprintf(path, sizeof(path), "%s/history.h5", h->dir);
  snprintf(tmp, sizeof(tmp), "%s.part", path);
  PetscCall(PetscMalloc1(h->nrows, &values));
  PetscCall(AppH5Create(tmp, &file));
  for (PetscInt c = 0; c < h->ncols; c++) {
    const H5Label label = {h->column[c].name, h->column[c].unit, h->column[c].description};
    for (PetscInt r = 0; r < h->nrows; r++) values[r] = h->rows[(size_t)r * (size_t)h->ncols + (size_t)c];
    PetscCall(AppH5Real(file, &label, PETSC_FALSE, h->nrows, 0, values));
  }
  PetscCall(AppH5Close(file, path));
  PetscCheck(!rename(tmp, path), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "cannot write '%s': %s", path, strerror(errno));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppHistoryWorst(AppHistory h, HistoryWorst *worst)
{
  PetscFunctionBegin;
  *worst = h->worst;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppHistoryAudit(AppHistory h, const AppAudit **audit)
{
  PetscFunctionBegin;
  *audit = &h->audit;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Close the table and write history.h5. */
PetscErrorCode AppHistoryDestroy(AppHistory *history)
{
  AppHistory h = *history;
  int bad;

  PetscFunctionBegin;
  if (!h) PetscFunctionReturn(PETSC_SUCCESS);
  *history = NULL;
  bad = h->csv ? fclose(h->csv) : 0;
  if (h->nrows) PetscCall(write_h5(h));
  PetscCheck(!bad, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "cannot write '%s/history.csv'", h->dir);
  PetscCall(PetscFree(h->column));
  PetscCall(PetscFree(h->row));
  PetscCall(PetscFree(h->rows));
  PetscCall(PetscFree(h));
  PetscFunctionReturn(PETSC_SUCCESS);
}
