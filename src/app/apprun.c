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
  PetscReal tstart;                         /* of this start of the run, s */
  PetscInt stepstart;
  PetscBool tty;
  PetscReal nextcheckpoint; /* s */
  AppState state;           /* the one being saved */
  AppState good;            /* the last finite one, written when a step fails */
  CheckpointInfo goodinfo;
  PetscBool exact;    /* saving changes nothing */
  PetscReal goodnext; /* wall time of the next one, s */
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

static PetscReal throughput(const Run *run, PetscReal wall)
{
  const App *app = run->app;
  PetscReal markers = app->sph ? (PetscReal)(app->nfluid + app->nboundary) : (PetscReal)1;

  return wall > 0 ? markers * (PetscReal)(app->step - run->stepstart) / wall : 0;
}

static void print_progress(Run *run, PetscBool last)
{
  const App *app = run->app;
  PetscReal now = AppWallTime(), wall = now - run->wallstart, part = app->t / app->scene.tend,
            made = (app->t - run->tstart) / (app->scene.tend - run->tstart);
  char left[32];

  if (app->scene.progressevery <= 0 || (!last && now - run->wallprinted < app->scene.progressevery)) return;
  run->wallprinted = now;
  format_seconds(made > 0 ? wall * (1 - made) / made : (PetscReal)INFINITY, sizeof(left), left);
  printf("%st = %.6g s (%.1f %%)  step %d  dt %.3g s  %.3g %s/s  ETA %s%s", run->tty ? "\r" : "", (double)app->t,
         100 * (double)part, (int)app->step, (double)run->lastdt, (double)throughput(run, wall),
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

/* The one list of what the run itself remembers. */
static PetscErrorCode move_run(Run *run, FrondState *s)
{
  PetscFunctionBegin;
  PetscCall(AppMoveState(run->app, s));
  FrondMoveReal(s, "run/dt", &run->lastdt, 1);
  FrondMoveInt(s, "run/frames_due", &run->frame, 1);
  FrondMoveReal(s, "run/next_frame", &run->nextframe, 1);
  FrondMoveReal(s, "run/next_history", &run->nexthistory, 1);
  PetscCall(AppHistoryMoveState(run->history, run->app, s));
  PetscCall(AppOutputMoveState(run->output, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void next_checkpoint(Run *run)
{
  const PetscReal every = run->app->scene.checkpointevery, t = run->app->t;

  run->nextcheckpoint =
      every > 0 ? every * (PetscFloorReal(t / every * (1 + 1e-12)) + 1) : (every == 0 ? t : (PetscReal)INFINITY);
}

/* Go on from a checkpoint. Frames and rows due next follow from the intervals, which may have been changed. */
static PetscErrorCode restart(Run *run)
{
  const AppScene *s = &run->app->scene;

  PetscFunctionBegin;
  PetscCall(move_run(run, AppStateBegin(&run->state, FROND_STATE_LOAD)));
  if (s->outevery > 0 && run->nextframe != PetscMin((PetscReal)run->frame * s->outevery, s->tend)) {
    run->frame = (PetscInt)PetscFloorReal(run->app->t / s->outevery);
    next_frame(run);
  }
  if (s->histevery > 0 && run->nexthistory > (run->app->t + s->histevery) * (1 + 1e-9))
    run->nexthistory = run->app->t + s->histevery;
  /* later checkpoints go first: were the run killed in between, the one that is left would still fit the other files */
  PetscCall(AppCheckpointPrune(s->outdir, run->app->step, -1));
  PetscCall(AppOutputCut(run->output));
  PetscCall(AppHistoryCut(run->history));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode run_start(Run *run)
{
  CheckpointInfo info;

  PetscFunctionBegin;
  run->exact = PETSC_TRUE;
  if (run->app->ancf) PetscCall(AncfGetPackExact(run->app->ancf, &run->exact));
  if (run->app->scene.restart[0]) { /* before any file is touched */
    PetscCall(AppRestartRead(run->app, &run->state, &info));
    PetscCall(PetscFree(info.options));
  }
  PetscCall(AppOutputCreate(run->app, &run->output));
  PetscCall(AppHistoryCreate(run->app, &run->history));
  if (run->app->scene.restart[0]) {
    PetscCall(restart(run));
  } else {
    PetscCall(record(run, PETSC_TRUE, PETSC_TRUE));
    next_frame(run);
    run->nexthistory = run->app->scene.histevery;
  }
  next_checkpoint(run);
  run->wallstart = run->wallprinted = AppWallTime();
  run->stepstart = run->app->step;
  run->tstart = run->app->t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode write_checkpoint(Run *run, AppState *s, CheckpointInfo *info, PetscBool tell)
{
  const AppScene *scene = &run->app->scene;
  char path[PETSC_MAX_PATH_LEN + 80];

  PetscFunctionBegin;
  PetscCall(AppOptionsText(&info->options));
  PetscCall(AppHistorySync(run->history));
  PetscCall(AppCheckpointWrite(scene->outdir, s, info, scene->checkpointkeep, sizeof(path), path));
  PetscCall(PetscFree(info->options));
  if (tell)
    printf("checkpoint of step %" PetscInt_FMT ", t = %.9g s: go on with -restart %s\n", info->step, (double)info->t, path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode save_state(Run *run, AppState *s, CheckpointInfo *info)
{
  PetscFunctionBegin;
  PetscCall(move_run(run, AppStateBegin(s, FROND_STATE_SAVE)));
  info->step = run->app->step;
  info->t = run->app->t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keep the state for the case that a later step fails, at the cost of a hundredth of the time. */
static PetscErrorCode keep_good(Run *run)
{
  PetscReal start = AppWallTime();
  CheckpointInfo info = {0, 0, NULL};
  PetscErrorCode ierr;

  PetscFunctionBegin;
  if (!run->exact || start < run->goodnext) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  ierr = save_state(run, &run->state, &info);
  PetscCall(PetscPopErrorHandler());
  if (ierr) { /* there is no memory for two states: the run itself may go on */
    run->goodnext = (PetscReal)INFINITY;
    PetscCall(AppStateDestroy(&run->state));
    PetscCall(AppStateDestroy(&run->good));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (!AppStateNotFinite(&run->state)) {
    const AppState swap = run->good;
    run->good = run->state;
    run->state = swap;
    run->goodinfo = info;
  }
  run->goodnext = AppWallTime() + 99 * (AppWallTime() - start);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After a step: a checkpoint when one is due, when the run is interrupted, and at its end if there are any. */
static PetscErrorCode checkpoint(Run *run)
{
  const AppScene *s = &run->app->scene;
  const PetscBool due =
      (PetscBool)(run->app->t >= run->nextcheckpoint * (1 - 1e-12) || (run->app->t >= s->tend && s->checkpointevery >= 0));
  CheckpointInfo info;

  PetscFunctionBegin;
  if (!due && !stop_signal) {
    PetscCall(keep_good(run));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(save_state(run, &run->state, &info));
  PetscCall(write_checkpoint(run, &run->state, &info, (PetscBool)(stop_signal != 0)));
  next_checkpoint(run);
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
    PetscCall(AppAuditStep(app, run->lastdt));
    done = (PetscBool)(app->t >= tend);
    frame = (PetscBool)(done || app->scene.outevery <= 0 || app->t >= run->nextframe);
    row = (PetscBool)(done || app->t >= run->nexthistory * (1 - 1e-12));
    PetscCall(record(run, frame, row));
    if (frame) next_frame(run);
    if (row && app->scene.histevery > 0)
      run->nexthistory = app->scene.histevery * (PetscFloorReal(app->t / app->scene.histevery * (1 + 1e-12)) + 1);
    PetscCall(checkpoint(run));
    /* those of an interruption come after the checkpoint, which knows nothing of them */
    if (stop_signal) PetscCall(record(run, (PetscBool)!frame, (PetscBool)!row));
    print_progress(run, (PetscBool)(done || stop_signal));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode print_structures(App *app)
{
  PetscReal r[3], v[3];

  PetscFunctionBegin;
  for (PetscInt b = 0; b < app->scene.nbeams; b++) {
    const AncfBeamSpec *spec = &app->scene.beams[b].spec;
    PetscReal l;
    PetscCall(AncfGetBeam(app->ancf, b, NULL, NULL, &l));
    PetscCall(AppBeamPoint(app, b, l * (PetscReal)spec->elements, r, v, NULL));
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

/* The largest residuals of the energies over their largest terms. */
static PetscErrorCode print_audit(Run *run)
{
  static const char *const names[] = {"", "", "fluid", "beams", "bodies"};
  const App *app = run->app;
  const PetscBool there[] = {PETSC_FALSE, PETSC_FALSE, (PetscBool)(app->sph != NULL), (PetscBool)(app->ancf != NULL),
                             (PetscBool)(app->rigid != NULL)};
  const AppAudit *a;

  PetscFunctionBegin;
  if (!app->scene.audit) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AppHistoryAudit(run->history, &a));
  printf("  energy balance, residual at most:");
  for (int k = AUDIT_FLUID; k < AUDIT_TERMS; k++)
    if (there[k])
      printf(" %s %.2g of %.4g %s", names[k], (double)(a->worst[k]), (double)a->scale[k], app->dim == 2 ? "J/m" : "J");
  printf("\n");
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
         (double)throughput(run, wall), app->sph ? "markers*steps" : "steps");
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
  PetscCall(print_audit(run));
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

/* After a failed step: a checkpoint of the last good state. The first error is the one that is reported; this may fail silently.
 */
static void save_good(Run *run, PetscErrorCode ierr)
{
  const int number = (int)ierr;

  if (!run->good.n || number == PETSC_ERR_FILE_WRITE || number == PETSC_ERR_FILE_OPEN) return;
  (void)PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  if (write_checkpoint(run, &run->good, &run->goodinfo, PETSC_TRUE)) run->app->errors->files = PETSC_TRUE;
  (void)PetscPopErrorHandler();
}

/*
  After a failure: add to the error's line where the first value that is not finite came up. With one found, whatever complained
  of it, the error is a numerical one.
*/
static PetscErrorCode trace_fault(Run *run, PetscErrorCode ierr)
{
  AppErrors *errors = run->app->errors, first = *errors;
  const PetscInt failed = run->app->step;
  char text[256] = "";
  size_t n;

  if (!run->good.n || (int)ierr == PETSC_ERR_FILE_WRITE || (int)ierr == PETSC_ERR_FILE_OPEN) return ierr;
  (void)PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  if (!AppMoveState(run->app, AppStateBegin(&run->good, FROND_STATE_LOAD)))
    (void)AppTraceFault(run->app, failed, run->app->scene.tend, sizeof(text), text);
  (void)PetscPopErrorHandler();
  *errors = first;
  n = strlen(errors->message);
  if (!text[0]) return ierr;
  snprintf(errors->message + n, sizeof(errors->message) - n, " [%s]", text);
  return PETSC_ERR_FP;
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
    save_good(&run, ierr);
    ierr = trace_fault(&run, ierr);
    (void)PetscPushErrorHandler(PetscReturnErrorHandler, NULL); /* the first error is the one to report */
    (void)AppHistoryDestroy(&run.history);
    (void)AppOutputDestroy(&run.output);
    (void)PetscPopErrorHandler();
    (void)AppStateDestroy(&run.state);
    (void)AppStateDestroy(&run.good);
    PetscFunctionReturn(ierr);
  }
  PetscCall(AppStateDestroy(&run.state));
  PetscCall(AppStateDestroy(&run.good));
  PetscCall(AppHistoryDestroy(&run.history));
  PetscCall(AppOutputDestroy(&run.output));
  if (stop_signal) printf("interrupted by signal %d: the results are whole up to t = %.6g s\n", (int)stop_signal, (double)app->t);
  *exitcode = stop_signal ? 128 + (int)stop_signal : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
