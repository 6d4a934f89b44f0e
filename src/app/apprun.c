/* apprun.c - the time loop of `frond run`: events, progress, signals, summary. */
#include "app.h"
#include <math.h>
#include <signal.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static volatile sig_atomic_t stop_signal; /* SIGINT or SIGTERM, once it came */

static void on_signal(int signal_number)
{
  if (stop_signal) _exit(128 + signal_number); /* asked twice: go at once */
  stop_signal = signal_number;
}

/* Wall time, s. */
PetscReal AppWallTime(void)
{
  struct timespec t;

  clock_gettime(CLOCK_MONOTONIC, &t);
  return (PetscReal)t.tv_sec + (PetscReal)t.tv_nsec * 1e-9;
}

typedef struct {
  App *app;
  AppOutput output;
  AppHistory history;
  PetscReal nextframe, nexthistory, lastdt; /* s */
  PetscInt frame;                           /* frames due so far */
  PetscReal wallstart, wallprinted;         /* s */
  PetscBool tty;
} Run;

static void format_seconds(PetscReal s, size_t len, char text[])
{
  if (!(s < 1e7))
    snprintf(text, len, "?");
  else if (s < 100)
    snprintf(text, len, "%.0f s", (double)s);
  else if (s < 6000)
    snprintf(text, len, "%d min %02d s", (int)s / 60, (int)s % 60);
  else
    snprintf(text, len, "%d h %02d min", (int)s / 3600, ((int)s / 60) % 60);
}

static PetscReal throughput(const App *app, PetscReal wall)
{
  PetscReal markers = app->sph ? (PetscReal)(app->nfluid + app->nboundary) : (PetscReal)1;

  return wall > 0 ? markers * (PetscReal)app->step / wall : 0;
}

static void print_progress(Run *run, PetscBool last)
{
  const App *app = run->app;
  PetscReal now = AppWallTime(), wall = now - run->wallstart, part = app->t / app->scene.tend;
  char left[32];

  if (app->scene.progressevery <= 0 || (!last && now - run->wallprinted < app->scene.progressevery)) return;
  run->wallprinted = now;
  format_seconds(part > 0 ? wall * (1 - part) / part : (PetscReal)INFINITY, sizeof(left), left);
  printf("%st = %.6g s (%.1f %%)  step %d  dt %.3g s  %.3g %s/s  ETA %s%s", run->tty ? "\r" : "", (double)app->t,
         100 * (double)part, (int)app->step, (double)run->lastdt, (double)throughput(app, wall),
         app->sph ? "markers*steps" : "steps", left, run->tty ? "\033[K" : "\n");
  if (run->tty && last) printf("\n");
  fflush(stdout);
}

/* Frames lie at whole multiples of output_every and at the end. */
static void next_frame(Run *run)
{
  const AppScene *s = &run->app->scene;

  if (s->outevery <= 0) {
    run->nextframe = run->app->t; /* every step */
    return;
  }
  do run->frame++;
  while ((PetscReal)run->frame * s->outevery <= run->app->t * (1 + 1e-12));
  run->nextframe = PetscMin((PetscReal)run->frame * s->outevery, s->tend);
  if (s->tend - run->nextframe < 1e-9 * s->tend) run->nextframe = s->tend;
}

static PetscErrorCode record(Run *run, PetscBool frame, PetscBool row)
{
  PetscFunctionBegin;
  if (row) PetscCall(AppHistoryRecord(run->history, run->app, run->lastdt));
  if (frame) PetscCall(AppOutputWrite(run->output, run->app));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode run_start(Run *run)
{
  PetscFunctionBegin;
  PetscCall(AppOutputCreate(run->app, &run->output));
  PetscCall(AppHistoryCreate(run->app, &run->history));
  PetscCall(record(run, PETSC_TRUE, PETSC_TRUE));
  next_frame(run);
  run->nexthistory = run->app->scene.histevery;
  run->wallstart = run->wallprinted = AppWallTime();
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode run_steps(Run *run)
{
  App *app = run->app;
  PetscReal tend = app->scene.tend;

  PetscFunctionBegin;
  while (app->t < tend && !stop_signal) {
    PetscReal tmax = app->scene.outevery > 0 ? run->nextframe : tend;
    PetscBool done, frame, row;
    PetscCall(AppInjectFault(app));
    PetscCall(AppStep(app, tmax, &run->lastdt));
    done = (PetscBool)(app->t >= tend || stop_signal);
    frame = (PetscBool)(done || app->scene.outevery <= 0 || app->t >= run->nextframe);
    row = (PetscBool)(done || app->t >= run->nexthistory * (1 - 1e-12));
    PetscCall(record(run, frame, row));
    if (frame) next_frame(run);
    if (row && app->scene.histevery > 0)
      run->nexthistory = app->scene.histevery * (PetscFloorReal(app->t / app->scene.histevery * (1 + 1e-12)) + 1);
    print_progress(run, done);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode print_structures(App *app)
{
  PetscReal r[3], v[3];

  PetscFunctionBegin;
  for (PetscInt b = 0; b < app->scene.nbeams; b++) {
    const AncfBeamSpec *spec = &app->scene.beams[b].spec;
    PetscReal L2 = 0;
    for (int a = 0; a < 3; a++) L2 += PetscSqr(spec->end[a] - spec->start[a]);
    PetscCall(AppBeamPoint(app, b, PetscSqrtReal(L2), r, v, NULL));
    printf("  beam %-12s tip at (%.6g, %.6g, %.6g) m\n", app->scene.beams[b].name, (double)r[0], (double)r[1], (double)r[2]);
  }
  for (PetscInt b = 0; b < app->scene.nlumped; b++) {
    PetscCall(AppLumpedTip(app, b, r, v));
    printf("  beam %-12s tip at (%.6g, %.6g, %.6g) m\n", app->scene.lumped[b].name, (double)r[0], (double)r[1], (double)r[2]);
  }
  for (PetscInt b = 0; b < app->scene.nbodies; b++) {
    PetscCall(RigidGetState(app->rigid, b, r, NULL, NULL, NULL));
    printf("  body %-12s centre at (%.6g, %.6g, %.6g) m\n", app->scene.bodies[b].name, (double)r[0], (double)r[1], (double)r[2]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode print_summary(Run *run)
{
  App *app = run->app;
  PetscReal wall = AppWallTime() - run->wallstart;
  PetscInt frames, fluid, boundary, left;
  HistoryWorst w;
  char text[32];

  PetscFunctionBegin;
  PetscCall(AppHistoryWorst(run->history, &w));
  PetscCall(AppOutputLast(run->output, NULL, NULL, &frames));
  format_seconds(wall, sizeof(text), text);
  printf("%s: t = %.6g s after %d steps, %s of wall time (%.3g %s/s)\n", app->scene.name, (double)app->t, (int)app->step, text,
         (double)throughput(app, wall), app->sph ? "markers*steps" : "steps");
  PetscCall(print_structures(app));
  if (app->sph) {
    PetscCall(SphGetCounts(app->sph, &fluid, &boundary, &left));
    printf("  fluid: largest speed %.4g m/s, largest compression %.3g %%, %d of %d markers left the domain\n", (double)w.vmax,
           100 * (double)w.compression, (int)left, (int)fluid);
    printf("  momentum balance: residual at most %.3g of %.4g %s\n", (double)w.residual, (double)w.scale,
           app->dim == 2 ? "kg/s" : "kg m/s");
    printf("  transfer audit, at most: force lost %.3g of %.4g N, moment %.3g of %.4g N m, power %.3g of %.4g W%s\n",
           (double)w.forcelost, (double)w.force, (double)w.momentlost, (double)w.moment, (double)w.powerlost, (double)w.power,
           app->dim == 2 ? " (per metre of depth)" : "");
  }
  printf("results: %s/run.xdmf (%d frames, for ParaView), %s/history.csv, %s/settings.txt\n", app->scene.outdir, (int)frames,
         app->scene.outdir, app->scene.outdir);
  fflush(stdout);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void catch_signals(void)
{
  struct sigaction action;

  memset(&action, 0, sizeof(action));
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
}

/* After a failed step: say what is safe. The history's rows and all frames are on disk already. */
static void report_safe(const Run *run)
{
  PetscReal t;
  PetscInt frames;
  const char *file;

  if (!run->output || AppOutputLast(run->output, &t, &file, &frames) || !frames) return;
  printf("%sstopped in step %d after t = %.9g s; the last good frame is %s (t = %.6g s)\n", run->tty ? "\n" : "",
         (int)run->app->step + 1, (double)run->app->t, file, (double)t);
}

/* Run the scene to its end, or until a signal; exitcode is 0, or 128 + the signal's number. */
PetscErrorCode AppRun(App *app, int *exitcode)
{
  Run run = {.app = app};
  PetscErrorCode ierr;

  PetscFunctionBegin;
  run.tty = (PetscBool)isatty(STDOUT_FILENO);
  catch_signals();
  ierr = run_start(&run);
  if (!ierr) ierr = run_steps(&run);
  if (!ierr) ierr = print_summary(&run);
  if (ierr) {
    report_safe(&run);
    (void)PetscPushErrorHandler(PetscReturnErrorHandler, NULL); /* the first error is the one to report */
    (void)AppHistoryDestroy(&run.history);
    (void)AppOutputDestroy(&run.output);
    (void)PetscPopErrorHandler();
    PetscFunctionReturn(ierr);
  }
  PetscCall(AppHistoryDestroy(&run.history));
  PetscCall(AppOutputDestroy(&run.output));
  if (stop_signal) printf("interrupted by signal %d: the results are whole up to t = %.6g s\n", (int)stop_signal, (double)app->t);
  *exitcode = stop_signal ? 128 + (int)stop_signal : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
