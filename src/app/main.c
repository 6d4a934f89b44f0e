/*
  main.c - the `frond` command.

  frond run FILE [options]     run a scene
  frond check FILE [options]   validate it, count, estimate
  frond study substeps FILE    sweep integrators and step ratios of the beams
  frond -help | -version
*/
#include "app.h"
#include <hdf5.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char usage[] =
    "Frond: fully resolved fluid-structure interaction (SPH fluid, ANCF beams, rigid bodies)\n"
    "  frond run FILE [options]     run the scene of a YAML file\n"
    "  frond check FILE [options]   validate it; print marker counts, memory, time step and cost\n"
    "  frond study substeps FILE    sweep integrators, step ratios and moduli of the beams (frond study substeps -h)\n"
    "  frond -help                  every option (frond run FILE -help: with the scene's values)\n"
    "  frond -version\n"
    "An option -a_b_c of the command line is a_b_c: in the file, or c: nested under a: and b:, and wins over it.\n"
    "Exit codes: 0 done, 1 wrong input, 2 the computation failed, 3 files, 128 + n: signal n.\n";

static PetscErrorCode print_version(void)
{
  char petsc[128];
  unsigned major, minor, release;

  PetscFunctionBegin;
  PetscCall(PetscGetVersion(petsc, sizeof(petsc)));
  petsc[strcspn(petsc, ",\n")] = 0;
  H5get_libversion(&major, &minor, &release);
  printf("frond %s (%s; HDF5 %u.%u.%u; CUDA %s)\n", FROND_VERSION, petsc, major, minor, release, FROND_CUDA_BUILD ? "yes" : "no");
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  PetscBool run, check, help, version;
  const char *file;
} Command;

/* The words before the options. */
static PetscErrorCode parse_command(int argc, char **argv, Command *c)
{
  const char *word = argc > 1 ? argv[1] : "-help";

  PetscFunctionBegin;
  memset(c, 0, sizeof(*c));
  for (int i = 1; i < argc; i++) {
    if (!strcmp(argv[i], "-help") || !strcmp(argv[i], "--help") || !strcmp(argv[i], "-h")) c->help = PETSC_TRUE;
    if (!strcmp(argv[i], "-version") || !strcmp(argv[i], "--version")) c->version = PETSC_TRUE;
  }
  if (argc <= 1 || !strcmp(word, "help")) c->help = PETSC_TRUE;
  c->run = (PetscBool)!strcmp(word, "run");
  c->check = (PetscBool)!strcmp(word, "check");
  if (!c->run && !c->check) {
    PetscCheck(c->help || c->version, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
               "'%s' is no command; use frond run FILE, frond check FILE or frond study (frond -help)", word);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (argc > 2 && argv[2][0] != '-') c->file = argv[2];
  PetscCheck(c->file || c->help, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
             "frond %s needs a scene file right after it: frond %s FILE [options]", word, word);
  for (int i = 3; i < argc; i++)
    PetscCheck(argv[i][0] == '-' || (argv[i - 1][0] == '-' && i > 3), PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
               "'%s' is neither an option nor the value of one", argv[i]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode check_ranks(void)
{
  PetscMPIInt size;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCheck(size == 1, PETSC_COMM_SELF, PETSC_ERR_SUP,
             "this version runs on 1 MPI rank, not %d (it uses all cores of the rank through OpenMP)", (int)size);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode use_scene(App *app, const Command *c, AppKnown *known, int *exitcode)
{
  PetscFunctionBegin;
  PetscCall(AppBuild(app));
  PetscCall(AppOptionsCheckUnused(known));
  if (c->check)
    PetscCall(AppCheck(app));
  else
    PetscCall(AppRun(app, exitcode));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode run_scene(const Command *c, AppErrors *errors, AppKnown *known, int *exitcode)
{
  PetscErrorCode ierr;
  App app;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(&app, sizeof(app)));
  app.errors = errors;
  PetscCall(AppOptionsInsertFile(c->file));
  PetscCall(AppKnownCollect(known));
  PetscCall(AppSceneRead(&app.scene, c->file));
  ierr = use_scene(&app, c, known, exitcode);
  if (ierr) AppNameError(&app);
  PetscCall(ierr);
  PetscCall(AppDestroy(&app));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode execute(int argc, char **argv, AppErrors *errors, AppKnown *known, int *exitcode)
{
  Command c;

  PetscFunctionBegin;
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-error_trace", &errors->trace, NULL));
  PetscCall(check_ranks());
  PetscCall(parse_command(argc, argv, &c));
  if (c.version)
    PetscCall(print_version());
  else if (c.help) {
    printf("%s", usage);
    if (c.file) PetscCall(AppOptionsInsertFile(c.file));
    PetscCall(AppHelp());
  } else
    PetscCall(run_scene(&c, errors, known, exitcode));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A misspelt option may be why another one is missing: add it to the line of a user's error. */
static void add_misspelt(const AppKnown *known, AppErrors *errors)
{
  char text[1600];
  size_t n;

  if (!known->n || known->partial || strstr(errors->message, "unknown option")) return;
  if (AppOptionsUnused(known, PETSC_TRUE, sizeof(text), text) || !text[0] || strstr(errors->message, text)) return;
  n = strlen(errors->message);
  snprintf(errors->message + n, sizeof(errors->message) - n, " [%s]", text);
}

/* PETSc's arguments: ours less the words before the options and -help, whose text begins with ours (see execute()). */
static int petsc_arguments(int argc, char **argv, char **out)
{
  int n = 1;

  out[0] = argv[0];
  for (int i = 1; i < argc; i++) {
    const char *a = argv[i];
    if (n == 1 && a[0] != '-') continue;
    if (!strcmp(a, "-help") || !strcmp(a, "--help") || !strcmp(a, "-h") || !strcmp(a, "-version") || !strcmp(a, "--version"))
      continue;
    out[n++] = argv[i];
  }
  out[n] = NULL;
  return n;
}

int main(int argc, char **argv)
{
  AppErrors errors = {PETSC_FALSE, PETSC_FALSE, PETSC_FALSE, "", ""};
  AppKnown known = {0, 0, NULL, PETSC_FALSE};
  int exitcode = 0, petscargc;
  char **petscargv, **list;
  PetscErrorCode ierr;

  if (argc > 1 && !strcmp(argv[1], "study")) return AppStudy(argc, argv);
  list = petscargv = malloc(((size_t)argc + 1) * sizeof(char *));
  if (!list || MPI_Init(&argc, &argv)) {
    free(list);
    return APP_EXIT_USER;
  }
  petscargc = petsc_arguments(argc, argv, petscargv);
  if (PetscInitialize(&petscargc, &petscargv, NULL, NULL) || AppErrorInstall(&errors)) {
    free(list);
    return APP_EXIT_USER;
  }
  signal(SIGPIPE, SIG_DFL); /* frond -help | head */
  signal(SIGXFSZ, SIG_IGN); /* a file too large is an error of writing, reported in one line */
  ierr = execute(argc, argv, &errors, &known, &exitcode);
  if (ierr) {
    AppErrors first = errors;
    if (!errors.trace) add_misspelt(&known, &first);
    exitcode = AppErrorReport(&first, ierr, (PetscBool)(PetscGlobalRank != 0));
  } else if (PetscFinalize())
    exitcode = APP_EXIT_USER;
  AppKnownFree(&known);
  free(list);
  fflush(NULL);
  if (exitcode == APP_EXIT_IO || errors.files)
    _exit(exitcode); /* HDF5 cleans up inside MPI_Finalize(), and crashes on a file it cannot write */
  MPI_Finalize();
  return exitcode;
}
