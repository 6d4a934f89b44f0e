/*
  appunknown.c - help, and options that nobody knows.

  The names that exist are those that -help lists: they are collected by running every SetFromOptions with PETSc's
  help printer replaced by one that takes the names down.
*/
#include "app.h"
#include <ctype.h>
#include <fcntl.h>
#include <stdarg.h>
#include <string.h>
#include <unistd.h>

static AppKnown *collecting; /* PETSc's help printer has no context argument */

static PetscErrorCode collect_name(MPI_Comm comm, const char format[], ...)
{
  char line[4096], *start, *end;
  va_list args;

  va_start(args, format);
  vsnprintf(line, sizeof(line), format, args); /* NOLINT(clang-analyzer-valist.Uninitialized): it does not see va_start() */
  va_end(args);
  (void)comm;
  for (start = line; *start == ' ';) start++;
  if (start == line || *start != '-' || !collecting) return PETSC_SUCCESS;
  start++;
  for (end = start; isalnum((unsigned char)*end) || *end == '_' || *end == '-';) end++;
  if (end == start || (*end != ':' && *end != ' ')) return PETSC_SUCCESS;
  *end = 0;
  if (collecting->n == collecting->alloc) {
    collecting->alloc = 2 * collecting->alloc + 256;
    collecting->name = realloc(collecting->name, (size_t)collecting->alloc * sizeof(char *));
  }
  collecting->name[collecting->n++] = strdup(start);
  return PETSC_SUCCESS;
}

static PetscErrorCode scene_options(void)
{
  AppScene scene;

  PetscFunctionBegin;
  PetscCall(AppSceneRead(&scene, "scene"));
  PetscCall(AppSceneDestroy(&scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode sph_options(void)
{
  Sph sph;

  PetscFunctionBegin;
  PetscCall(SphCreate(PETSC_COMM_SELF, &sph));
  PetscCall(SphSetFromOptions(sph));
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ancf_options(void)
{
  Ancf ancf;

  PetscFunctionBegin;
  PetscCall(AncfCreate(PETSC_COMM_SELF, &ancf));
  PetscCall(AncfSetFromOptions(ancf));
  PetscCall(AncfDestroy(&ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode attach_options(void)
{
  CoupleAttach attach;

  PetscFunctionBegin;
  PetscCall(CoupleAttachCreate(PETSC_COMM_SELF, NULL, NULL, &attach));
  PetscCall(CoupleAttachSetFromOptions(attach));
  PetscCall(CoupleAttachDestroy(&attach));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode rigid_options(void)
{
  Rigid rigid;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &rigid));
  PetscCall(RigidSetFromOptions(rigid));
  PetscCall(RigidDestroy(&rigid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode couple_options(void)
{
  CoupleShort sr;
  Couple couple;

  PetscFunctionBegin;
  PetscCall(CoupleShortCreate(PETSC_COMM_SELF, NULL, NULL, &sr));
  PetscCall(CoupleShortSetFromOptions(sr));
  PetscCall(CoupleShortDestroy(&sr));
  PetscCall(CoupleCreate(PETSC_COMM_SELF, &couple));
  PetscCall(CoupleSetFromOptions(couple));
  PetscCall(CoupleDestroy(&couple));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The command's own words, which PETSc's help does not list. */
static const char *const own_words[] = {"help", "version", "error_trace"};

/* Print the help of every option (with -help in the database). */
PetscErrorCode AppHelp(void)
{
  PetscFunctionBegin;
  PetscCall(PetscOptionsSetValue(NULL, "-help", NULL));
  PetscCall(scene_options());
  PetscCall(sph_options());
  PetscCall(rigid_options());
  PetscCall(couple_options());
  PetscCall(attach_options());
  PetscCall(ancf_options());
  PetscCall(PetscOptionsClearValue(NULL, "-help")); /* else PetscFinalize() adds to it */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A copy of the options database with -help set. */
static PetscErrorCode copy_options(PetscOptions *copy)
{
  char *all;

  PetscFunctionBegin;
  PetscCall(PetscOptionsCreate(copy));
  PetscCall(PetscOptionsGetAll(NULL, &all));
  PetscCall(PetscOptionsInsertString(*copy, all));
  PetscCall(PetscOptionsSetValue(*copy, "-help", NULL));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  List the options that exist for the scene in the database. To be called before anything else reads options: PETSC
  lists a block once only. Works on a copy, so that nothing counts as used.
*/
PetscErrorCode AppKnownCollect(AppKnown *known)
{
  PetscErrorCode (*printer)(MPI_Comm, const char[], ...) = PetscHelpPrintf;
  PetscErrorCode (*const part[])(void) = {scene_options, sph_options, rigid_options, couple_options, ancf_options};
  PetscOptions copy;
  int nowhere, out;

  PetscFunctionBegin;
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  PetscCall(copy_options(&copy));
  PetscCall(PetscOptionsPush(copy));
  collecting = known;
  PetscHelpPrintf = collect_name;
  fflush(stdout); /* lists of types go past the help printer, to stdout */
  out = dup(STDOUT_FILENO);
  nowhere = open("/dev/null", O_WRONLY);
  if (out >= 0 && nowhere >= 0) dup2(nowhere, STDOUT_FILENO);
  for (size_t i = 0; i < sizeof(part) / sizeof(part[0]); i++)
    if (part[i]()) known->partial = PETSC_TRUE; /* a bad value ends one part of the list early */
  fflush(stdout);
  if (out >= 0 && nowhere >= 0) dup2(out, STDOUT_FILENO);
  if (out >= 0) close(out);
  if (nowhere >= 0) close(nowhere);
  PetscHelpPrintf = printer;
  collecting = NULL;
  PetscCall(PetscOptionsPop());
  PetscCall(PetscOptionsDestroy(&copy));
  PetscCall(PetscPopErrorHandler());
  PetscFunctionReturn(PETSC_SUCCESS);
}

void AppKnownFree(AppKnown *known)
{
  for (PetscInt i = 0; i < known->n; i++) free(known->name[i]);
  free(known->name);
  memset(known, 0, sizeof(*known));
}

/* Damerau-Levenshtein distance (adjacent transpositions count one), at most 64 letters. */
static int distance(const char a[], const char b[])
{
  int d[66][66], m = (int)PetscMin(strlen(a), (size_t)64), n = (int)PetscMin(strlen(b), (size_t)64);

  for (int i = 0; i <= m; i++) d[i][0] = i;
  for (int j = 0; j <= n; j++) d[0][j] = j;
  for (int i = 1; i <= m; i++)
    for (int j = 1; j <= n; j++) {
      d[i][j] = PetscMin(PetscMin(d[i - 1][j], d[i][j - 1]) + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1]));
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) d[i][j] = PetscMin(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[m][n];
}

/* known: the name is listed. nearest: the closest listed name, or NULL when none is close. */
static void look_up(const AppKnown *list, const char name[], PetscBool *known, const char **nearest)
{
  int best = 1 + (int)strlen(name) / 4, d;

  *known = PETSC_FALSE;
  *nearest = NULL;
  for (size_t i = 0; i < sizeof(own_words) / sizeof(own_words[0]); i++)
    if (!strcasecmp(own_words[i], name)) *known = PETSC_TRUE;
  for (PetscInt i = 0; i < list->n && !*known; i++) {
    d = distance(name, list->name[i]);
    if (d == 0) *known = PETSC_TRUE;
    if (d <= best) {
      best = d - 1;
      *nearest = list->name[i];
    }
  }
}

/* PETSc reads these at its end, or they are for people to see. */
static PetscBool is_petsc_wide(const char name[])
{
  static const char *const stems[] = {"log_",    "malloc",  "info",   "options_", "on_error_", "memory_",
                                      "viewer_", "fp_trap", "check_", "debug",    "display",   "nox"};

  for (size_t i = 0; i < sizeof(stems) / sizeof(stems[0]); i++)
    if (!strncasecmp(name, stems[i], strlen(stems[i]))) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* beam_<name>_<key> or body_<name>_<key> of a structure that is not listed: where <name> lies. */
static PetscBool names_absent(const AppKnown *list, const char name[], const char **start, int *length)
{
  if (strncmp(name, "beam_", 5) && strncmp(name, "body_", 5)) return PETSC_FALSE;
  for (PetscInt i = 0; i < list->n; i++) {
    const char *key = list->name[i] + 4; /* _<key> */
    size_t n = strlen(name), k = strlen(list->name[i]) > 5 ? strlen(key) : n;
    if (strncmp(name, list->name[i], 5) || n < 6 + k || strcmp(name + n - k, key)) continue;
    *start = name + 5;
    *length = (int)(n - k - 5);
    return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* beam_<name>_p<number>_<key>: a piece of a beam from a mesh, not known before the mesh is read. */
static PetscBool names_piece(const char name[])
{
  const char *at = strncmp(name, "beam_", 5) ? NULL : strstr(name + 5, "_p");

  for (; at; at = strstr(at + 2, "_p")) {
    const size_t digits = strspn(at + 2, "0123456789");
    if (digits && at[2 + digits] == '_') return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* What is wrong with an option that nothing asked for; empty for nothing. */
static void complain(const AppKnown *list, const char name[], PetscBool only_unlisted, size_t len, char text[])
{
  const char *nearest, *absent;
  PetscBool known;
  int length;

  text[0] = 0;
  if (is_petsc_wide(name)) return;
  look_up(list, name, &known, &nearest);
  if ((known || names_piece(name)) && only_unlisted) return;
  if (known)
    snprintf(text, len, "option %s has no effect in this scene", name);
  else if (names_absent(list, name, &absent, &length))
    snprintf(text, len, "option %s: %s does not list '%.*s'", name, name[1] == 'e' ? "beams" : "bodies", length, absent);
  else if (nearest)
    snprintf(text, len, "unknown option %s (did you mean %s?)", name, nearest);
  else
    snprintf(text, len, "unknown option %s", name);
}

/*
  One sentence about the options that were set and that nothing asked for; empty when there are none. With `only_unlisted`,
  an option that exists but was not asked for yet is no offence.
*/
PetscErrorCode AppOptionsUnused(const AppKnown *list, PetscBool only_unlisted, size_t len, char text[])
{
  PetscInt n, bad = 0;
  char **name, **value, one[512];

  PetscFunctionBegin;
  text[0] = 0;
  PetscCall(PetscOptionsLeftGet(NULL, &n, &name, &value));
  for (PetscInt i = 0; i < n; i++) {
    complain(list, name[i], only_unlisted, sizeof(one), one);
    if (!one[0] || bad++ >= 4) continue;
    if (text[0]) PetscCall(PetscStrlcat(text, "; ", len));
    PetscCall(PetscStrlcat(text, one, len));
  }
  if (bad > 4) {
    PetscCall(PetscSNPrintf(one, sizeof(one), "; and %" PetscInt_FMT " more", bad - 4));
    PetscCall(PetscStrlcat(text, one, len));
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &name, &value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After all set-up: an option that nothing asked for is an error that names it. */
PetscErrorCode AppOptionsCheckUnused(const AppKnown *known)
{
  char text[1600];

  PetscFunctionBegin;
  PetscCall(AppOptionsUnused(known, PETSC_FALSE, sizeof(text), text));
  PetscCheck(!text[0], PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "%s", text);
  PetscFunctionReturn(PETSC_SUCCESS);
}
