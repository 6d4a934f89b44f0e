/*
  appoptions.c - tables of options, and scene files.

  Every option is read by the PETSc call of its type inside PetscOptionsBegin/End, so that -help lists it; its text is
  checked first, so that a bad value is refused in one line that names the option.
*/
#include "app.h"
#include <ctype.h>
#include <errno.h>
#include <string.h>
#include <sys/stat.h>

/* Names of scenes, beams and bodies become option, file and column names: letters, digits and '_', 1 to 32 of them. */
PetscErrorCode AppNameCheck(const char key[], const char name[])
{
  size_t n = strlen(name);

  PetscFunctionBegin;
  PetscCheck(n >= 1 && n <= 32, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "%s: the name '%s' must have 1 to 32 characters", key,
             name);
  for (size_t i = 0; i < n; i++)
    PetscCheck(isalnum((unsigned char)name[i]) || name[i] == '_', PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
               "%s: the name '%s' may hold letters, digits and '_' only", key, name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One number of an option's text, whole and finite. */
static PetscErrorCode check_number(const char key[], const char text[], PetscBool integer)
{
  char *end;
  double x;

  PetscFunctionBegin;
  errno = 0;
  x = integer ? (double)strtol(text, &end, 10) : strtod(text, &end);
  PetscCheck(end != text && !*end, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "%s: '%s' is not %s", key, text,
             integer ? "a whole number" : "a number");
  PetscCheck(PetscIsNormalReal((PetscReal)x) || x == 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "%s: %s must be a finite number", key, text);
  PetscCheck(!integer || (!errno && x <= (double)PETSC_MAX_INT && x >= -(double)PETSC_MAX_INT), PETSC_COMM_SELF,
             PETSC_ERR_ARG_OUTOFRANGE, "%s: %s is too large for a whole number", key, text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cut text at commas, trimming blanks; part[] points into text. n: number of parts, at most max (more: max + 1). */
static PetscInt split(char text[], PetscInt max, char *part[])
{
  PetscInt n = 0;

  for (char *at = text, *next; at; at = next) {
    char *end;
    next = strchr(at, ',');
    if (next) *next++ = 0;
    while (isspace((unsigned char)*at)) at++;
    end = at + strlen(at);
    while (end > at && isspace((unsigned char)end[-1])) *--end = 0;
    if (n >= max) return max + 1;
    part[n++] = at;
  }
  return n;
}

static PetscErrorCode list_words(const char *const list[], size_t len, char words[])
{
  PetscFunctionBegin;
  words[0] = 0;
  for (PetscInt i = 0; list[i]; i++) {
    if (i) PetscCall(PetscStrlcat(words, ", ", len));
    PetscCall(PetscStrlcat(words, list[i], len));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode find_word(const char key[], const char text[], const char *const list[], PetscInt *at)
{
  char words[1024];

  PetscFunctionBegin;
  for (*at = 0; list[*at]; (*at)++)
    if (!strcasecmp(text, list[*at])) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(list_words(list, sizeof(words), words));
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "%s: '%s' is none of %s", key, text, words);
}

#define MAX_PARTS 4096

/* Names: as many as given, each one once. */
static PetscErrorCode take_names(const char key[], PetscInt n, char *part[], AppNames *names)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(names->name));
  PetscCall(PetscCalloc(sizeof(*names->name) * (size_t)n, &names->name));
  names->n = n;
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(AppNameCheck(key, part[i]));
    PetscCall(PetscStrncpy(names->name[i], part[i], APP_NAME_LEN));
    for (PetscInt j = 0; j < i; j++)
      PetscCheck(strcasecmp(names->name[i], names->name[j]), PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
                 "%s: the name '%s' is there twice", key, part[i]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Check an option's text against its type, and take lists of words here. */
static PetscErrorCode check_text(const char key[], const AppOpt *opt, const char given[], PetscBool *none)
{
  char *text, *part[MAX_PARTS];
  PetscInt n, at;
  PetscBool b;

  PetscFunctionBegin;
  PetscCall(PetscStrallocpy(given, &text));
  n = split(text, MAX_PARTS, part);
  PetscCheck(n <= MAX_PARTS, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "%s: more than %d entries", key, MAX_PARTS);
  *none = (PetscBool)((opt->type == OPT_SUBSET || opt->type == OPT_NAMES) && n == 1 && !strcasecmp(part[0], "none"));
  switch (opt->type) {
  case OPT_REAL:
  case OPT_INT:
    PetscCall(check_number(key, text, (PetscBool)(opt->type == OPT_INT)));
    break;
  case OPT_VEC:
  case OPT_AXISANGLE:
    at = opt->type == OPT_VEC ? 3 : 4;
    PetscCheck(n == at, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
               "%s: '%s' has %" PetscInt_FMT " numbers, it needs %" PetscInt_FMT "", key, given, n, at);
    for (PetscInt i = 0; i < n; i++) PetscCall(check_number(key, part[i], PETSC_FALSE));
    break;
  case OPT_BOOL:
    PetscCheck(!PetscOptionsStringToBool(text, &b), PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "%s: '%s' is neither true nor false",
               key, text);
    break;
  case OPT_CHOICE:
    PetscCall(find_word(key, text, opt->list, &at));
    break;
  case OPT_SUBSET:
    for (PetscInt i = 0; opt->list[i]; i++) ((PetscBool *)opt->value)[i] = PETSC_FALSE;
    for (PetscInt i = 0; !*none && i < n; i++) {
      PetscCall(find_word(key, part[i], opt->list, &at));
      ((PetscBool *)opt->value)[at] = PETSC_TRUE;
    }
    break;
  case OPT_NAMES:
    PetscCall(take_names(key, *none ? 0 : n, part, opt->value));
    break;
  case OPT_STRING:
    PetscCheck(strlen(given) < PETSC_MAX_PATH_LEN, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "%s: longer than %d characters", key,
               PETSC_MAX_PATH_LEN - 1);
    break;
  }
  PetscCall(PetscFree(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Text of the words of a list, for -help. */
static PetscErrorCode help_text(const AppOpt *opt, size_t len, char help[])
{
  char words[512];

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(help, opt->help, len));
  if (opt->list && opt->type == OPT_SUBSET) {
    PetscCall(list_words(opt->list, sizeof(words), words));
    PetscCall(PetscStrlcat(help, "; any of ", len));
    PetscCall(PetscStrlcat(help, words, len));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Read the options -<prefix><key> of a table. */
PetscErrorCode AppOptionsRead(const char prefix[], const char title[], PetscInt n, const AppOpt opt[])
{
  char name[PETSC_MAX_OPTION_NAME], key[PETSC_MAX_OPTION_NAME], help[1024], *given;
  PetscBool set, none;
  PetscInt count;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(1 << 16, &given));
  PetscOptionsBegin(PETSC_COMM_SELF, prefix, title, "frond");
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "-%s", opt[i].key));
    PetscCall(PetscSNPrintf(key, sizeof(key), "%s%s", prefix ? prefix : "", opt[i].key));
    PetscCall(PetscOptionsHasName(NULL, prefix, name, &set));
    given[0] = 0;
    if (set) PetscCall(PetscOptionsGetString(NULL, prefix, name, given, 1 << 16, NULL));
    PetscCheck(!set || given[0] || opt[i].type == OPT_BOOL, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "%s: no value is given", key);
    none = PETSC_FALSE;
    if (set && given[0]) PetscCall(check_text(key, &opt[i], given, &none));
    if (set && opt[i].set) *opt[i].set = PETSC_TRUE;
    PetscCall(help_text(&opt[i], sizeof(help), help));
    switch (opt[i].type) {
    case OPT_REAL:
      PetscCall(PetscOptionsReal(name, help, "", *(PetscReal *)opt[i].value, opt[i].value, NULL));
      break;
    case OPT_INT:
      PetscCall(PetscOptionsInt(name, help, "", *(PetscInt *)opt[i].value, opt[i].value, NULL));
      break;
    case OPT_BOOL:
      PetscCall(PetscOptionsBool(name, help, "", *(PetscBool *)opt[i].value, opt[i].value, NULL));
      break;
    case OPT_STRING:
      PetscCall(PetscOptionsString(name, help, "", opt[i].value, opt[i].value, PETSC_MAX_PATH_LEN, NULL));
      break;
    case OPT_VEC:
    case OPT_AXISANGLE:
      count = opt[i].type == OPT_VEC ? 3 : 4;
      PetscCall(PetscOptionsRealArray(name, help, "", opt[i].value, &count, NULL));
      break;
    case OPT_CHOICE:
      for (count = 0; opt[i].list[count];) count++;
      PetscCall(
          PetscOptionsEList(name, help, "", opt[i].list, count, opt[i].list[*(PetscInt *)opt[i].value], opt[i].value, NULL));
      break;
    case OPT_SUBSET:
    case OPT_NAMES:
      PetscCall(PetscOptionsName(name, help, "", NULL));
      break;
    }
  }
  PetscOptionsEnd();
  PetscCall(PetscFree(given));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* --- scene files --------------------------------------------------------------------------------------------- */

#define FILE_MAX (1 << 20) /* bytes */
#define NESTED_MAX 64      /* brackets; YAML parsers need time of the square of it */

static PetscErrorCode read_file(const char file[], char **text)
{
  struct stat st;
  FILE *f;
  size_t n;

  PetscFunctionBegin;
  PetscCheck(!stat(file, &st), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot read the scene file '%s': %s", file,
             strerror(errno));
  PetscCheck(!S_ISDIR(st.st_mode), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot read the scene file '%s': it is a folder", file);
  PetscCheck(st.st_size <= FILE_MAX, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot read the scene file '%s': longer than 1 MiB",
             file);
  f = fopen(file, "r");
  PetscCheck(f, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot read the scene file '%s': %s", file, strerror(errno));
  PetscCall(PetscMalloc1((size_t)st.st_size + 1, text));
  n = fread(*text, 1, (size_t)st.st_size, f);
  fclose(f);
  (*text)[n] = 0;
  PetscCheck(strlen(*text) == n, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED, "scene file '%s' is not a text file", file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists inside lists, outside of comments. */
static PetscErrorCode check_nesting(const char file[], const char text[])
{
  PetscInt depth = 0, line = 1;

  PetscFunctionBegin;
  for (const char *at = text; *at; at++) {
    if (*at == '#') at += strcspn(at, "\n");
    if (!*at) break;
    line += *at == '\n';
    if (*at == '[' || *at == '{') depth++;
    if ((*at == ']' || *at == '}') && depth > 0) depth--;
    PetscCheck(depth <= NESTED_MAX, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "scene file '%s', line %" PetscInt_FMT ": more than %d brackets inside one another", file, line, NESTED_MAX);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether PETSc's YAML parser takes the text. */
static PetscErrorCode try_yaml(const char text[], PetscBool *ok)
{
  PetscOptions scratch;

  PetscFunctionBegin;
  PetscCall(PetscOptionsCreate(&scratch));
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  *ok = PetscOptionsInsertStringYAML(scratch, text) ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(PetscPopErrorHandler());
  PetscCall(PetscOptionsDestroy(&scratch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define PARSED_MAX (1 << 20) /* bytes */

/* The line after the longest beginning of the text that is valid YAML: where a malformed file goes wrong. */
static PetscErrorCode bad_line(const char text[], PetscInt *line)
{
  char *copy;
  PetscInt n = 0;
  size_t parsed = 0;

  PetscFunctionBegin;
  *line = 1;
  PetscCall(PetscStrallocpy(text, &copy));
  for (char *at = copy, *end; (end = strchr(at, '\n')) && n < 2000 && parsed < PARSED_MAX; at = end + 1) {
    char keep = end[1];
    PetscBool ok;
    n++;
    parsed += (size_t)(end - copy);
    end[1] = 0;
    PetscCall(try_yaml(copy, &ok));
    end[1] = keep;
    if (ok) *line = n + 1;
  }
  PetscCall(PetscFree(copy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Read a scene file into the options database. Options that are there already (the command line's) win. Errors:
  PETSC_ERR_FILE_OPEN when unreadable, PETSC_ERR_ARG_WRONG when malformed or a key has no value.
*/
PetscErrorCode AppOptionsInsertFile(const char file[])
{
  PetscOptions scratch;
  PetscBool ok, set;
  PetscInt n, line;
  char *text, **name, **value, option[PETSC_MAX_OPTION_NAME];

  PetscFunctionBegin;
  PetscCall(read_file(file, &text));
  PetscCall(check_nesting(file, text));
  PetscCall(try_yaml(text, &ok));
  if (!ok) {
    PetscCall(bad_line(text, &line));
    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
            "scene file '%s' is not valid YAML (key: value lines) at or after line %" PetscInt_FMT "", file, line);
  }
  PetscCall(PetscOptionsCreate(&scratch));
  PetscCall(PetscOptionsInsertStringYAML(scratch, text));
  PetscCall(PetscOptionsLeftGet(scratch, &n, &name, &value));
  PetscCheck(n, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "scene file '%s' sets nothing", file);
  for (PetscInt i = 0; i < n; i++) {
    PetscCheck(value[i] && value[i][0] && value[i][0] != '~', PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
               "scene file '%s': %s has no value", file, name[i]);
    PetscCall(PetscSNPrintf(option, sizeof(option), "-%s", name[i]));
    PetscCall(PetscOptionsHasName(NULL, NULL, option, &set));
    if (!set) PetscCall(PetscOptionsSetValue(NULL, option, value[i]));
  }
  PetscCall(PetscOptionsLeftRestore(scratch, &n, &name, &value));
  PetscCall(PetscOptionsDestroy(&scratch));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}
