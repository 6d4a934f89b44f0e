/* apprestart.c - which checkpoint a run goes on from, and whether it is of this very scene. */
#include "app.h"
#include <ctype.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <zlib.h>

/* Options that do not change what is computed, or that a run may go on with differently; also all that begin with the stems. */
static PetscBool is_free(const char name[])
{
  static const char *const names[] = {"restart",         "restart_changed", "checkpoint_every", "checkpoint_keep",
                                      "output_dir",      "output_fields",   "output_overwrite", "progress_every",
                                      "time_end",        "error_trace",     "fault_nan",        "sph_type",
                                      "sph_cuda_timing", "scene_name",      "sph_speed_stop"};
  static const char *const stems[] = {"log_",    "malloc",  "info",    "options_", "on_error_",
                                      "memory_", "viewer_", "fp_trap", "check_",   "debug"};

  for (size_t i = 0; i < sizeof(names) / sizeof(names[0]); i++)
    if (!strcasecmp(name, names[i])) return PETSC_TRUE;
  for (size_t i = 0; i < sizeof(stems) / sizeof(stems[0]); i++)
    if (!strncasecmp(name, stems[i], strlen(stems[i]))) return PETSC_TRUE;
  return PETSC_FALSE;
}

static int by_text(const void *a, const void *b)
{
  return strcmp(*(char *const *)a, *(char *const *)b);
}

/* A file that an option names (a mesh, a table) counts with what it holds. */
static unsigned long file_crc(const char name[])
{
  struct stat st;
  unsigned char block[4096];
  uLong crc = crc32(0, NULL, 0);
  size_t n;
  FILE *f;

  if (!name[0] || stat(name, &st) || !S_ISREG(st.st_mode) || !(f = fopen(name, "rb"))) return 0;
  while ((n = fread(block, 1, sizeof(block), f)) > 0) crc = crc32(crc, block, (uInt)n);
  fclose(f);
  return crc;
}

/* The next "name value" of PETSc's list "-name value -name value"; *at moves on. */
static char *next_option(char **at)
{
  char *start = *at, *end;

  while (*start == ' ' || *start == '-') start++;
  if (!*start) return NULL;
  for (end = start; *end && !(end[0] == ' ' && end[1] == '-' && (isalpha((unsigned char)end[2]) || end[2] == '_'));) end++;
  *at = *end ? end + 1 : end;
  *end = 0;
  while (end > start && end[-1] == ' ') *--end = 0;
  return start;
}

/* Every option that says what is computed, one a line in the order of the alphabet; free it with PetscFree(). */
PetscErrorCode AppOptionsText(char **text)
{
  char *all, *at, *option, **lines, name[PETSC_MAX_PATH_LEN], one[64];
  size_t len = 1, most = 0;
  int n = 0;

  PetscFunctionBegin;
  PetscCall(PetscOptionsGetAll(NULL, &all));
  for (at = all; *at; at++) most += *at == '-'; /* no fewer than options */
  PetscCall(PetscMalloc1(most, &lines));
  at = all;
  while ((option = next_option(&at))) {
    snprintf(name, sizeof(name), "%.*s", (int)strcspn(option, " "), option);
    if (is_free(name)) continue;
    lines[n++] = option;
    len += strlen(option) + sizeof(one);
  }
  if (n) qsort(lines, (size_t)n, sizeof(lines[0]), by_text);
  PetscCall(PetscCalloc1(len, text));
  for (int i = 0; i < n; i++) {
    const char *value = strchr(lines[i], ' ');
    const unsigned long crc = value ? file_crc(value + 1) : 0;
    snprintf(one, sizeof(one), crc ? " (file %08lx)\n" : "\n", crc);
    PetscCall(PetscStrlcat(*text, lines[i], len));
    PetscCall(PetscStrlcat(*text, one, len));
  }
  PetscCall(PetscFree(lines));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void complain(size_t len, char text[], int *n, const char format[], const char a[], int na, const char b[], int nb)
{
  const size_t at = strlen(text);

  if ((*n)++ >= 4) return;
  snprintf(text + at, len - at, "%s", at ? "; " : "");
  snprintf(text + strlen(text), len - strlen(text), format, na, a, nb, b);
}

/* The options that differ between two texts, in words; empty for none. */
static void differences(const char *was, const char *is, size_t len, char text[])
{
  int n = 0;

  text[0] = 0;
  while (*was || *is) { /* both in the order of the alphabet */
    const int lw = (int)strcspn(was, "\n"), li = (int)strcspn(is, "\n"), nw = (int)strcspn(was, " \n"),
              ni = (int)strcspn(is, " \n");
    const int order =
        !*was ? 1 : (!*is ? -1 : (nw == ni ? strncmp(was, is, (size_t)nw) : strncmp(was, is, (size_t)(nw < ni ? nw : ni))));
    const int same = !order && nw == ni, first = order < 0 || (!order && nw < ni);
    if (same) {
      if (lw != li || strncmp(was, is, (size_t)lw)) complain(len, text, &n, "was %.*s, is %.*s", was, lw, is, li);
    } else if (first)
      complain(len, text, &n, "%.*s is missing%.*s", was, lw, "", 0);
    else
      complain(len, text, &n, "%.*s is new%.*s", is, li, "", 0);
    if (same || first) was += lw + (was[lw] == '\n');
    if (same || !first) is += li + (is[li] == '\n');
  }
  if (n > 4) snprintf(text + strlen(text), len - strlen(text), "; and %d more", n - 4);
}

static PetscErrorCode check_options(const App *app, const CheckpointInfo *info)
{
  char *now, text[1200];

  PetscFunctionBegin;
  PetscCall(AppOptionsText(&now));
  differences(info->options, now, sizeof(text), text);
  PetscCall(PetscFree(now));
  PetscCheck(!text[0] || app->scene.restartchanged, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
             "restart: the options are not those of the checkpoint: %s (restart_changed goes on all the same)", text);
  if (text[0]) printf("restart with changed options: %s\n", text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Read the checkpoint that app->scene.restart means. Errors: there is none; it is damaged; it is of other options. */
PetscErrorCode AppRestartRead(const App *app, AppState *s, CheckpointInfo *info)
{
  char path[PETSC_MAX_PATH_LEN + 300];
  struct stat st;

  PetscFunctionBegin;
  PetscCheck(!stat(app->scene.restart, &st), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "restart: cannot read '%s': %s",
             app->scene.restart, strerror(errno));
  snprintf(path, sizeof(path), "%s", app->scene.restart);
  if (S_ISDIR(st.st_mode)) PetscCall(AppCheckpointNewest(app->scene.restart, NULL, PETSC_FALSE, sizeof(path), path));
  PetscCheck(path[0], PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "restart: there is no checkpoint in '%s'", app->scene.restart);
  PetscCall(AppCheckpointRead(path, s, info));
  PetscCall(check_options(app, info));
  /* that of the very end is taken: the run may have been killed before its last files were written */
  PetscCheck(info->t <= app->scene.tend * (1 + 1e-12), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "restart: the checkpoint's time %.9g s is after time_end = %g s", (double)info->t, (double)app->scene.tend);
  printf("restart from '%s': step %" PetscInt_FMT ", t = %.9g s\n", path, info->step, (double)info->t);
  PetscFunctionReturn(PETSC_SUCCESS);
}
