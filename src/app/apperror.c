/* apperror.c - errors of the `frond` command: one line for the user, the PETSc trace only on request. */
#include "app.h"
#include <string.h>

static PetscErrorCode error_handler(MPI_Comm comm, int line, const char *func, const char *file, PetscErrorCode ierr,
                                    PetscErrorType type, const char *mess, void *ctx)
{
  AppErrors *errors = ctx;

  if (type == PETSC_ERROR_INITIAL) {
    const char *text = (mess && mess[0]) ? mess : NULL;
    errors->memory = (PetscBool)(!strcmp(func, "PetscMallocAlign") || !strcmp(func, "PetscReallocAlign"));
    if (!text) PetscErrorMessage(ierr, &text, NULL);
    if (errors->memory) /* PETSc 3.18 swaps its arguments: the code is a line, the text the function that asked */
      snprintf(errors->message, sizeof(errors->message),
               "out of memory (%s): use fewer markers (a larger sph_dp), fewer elements, or a machine with more",
               text ? text : "?");
    else
      snprintf(errors->message, sizeof(errors->message), "%s", text ? text : "unknown error");
    for (char *c = errors->message; *c; c++)
      if (*c == '\n' || *c == '\r') *c = ' ';
  }
  if (errors->trace) return PetscTraceBackErrorHandler(comm, line, func, file, ierr, type, mess, ctx);
  return ierr;
}

/* Send every error to this file's handler; with errors->trace also print PETSc's trace. */
PetscErrorCode AppErrorInstall(AppErrors *errors)
{
  PetscFunctionBegin;
  PetscCall(PetscPushErrorHandler(error_handler, errors));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PETSc names the bad text of a number or logical value but not its option: find that in the database. */
static void name_option(const AppErrors *errors, size_t len, char name[])
{
  static const char *const heads[] = {"Input string ", "Unknown logical value: ", "Unknown logical value ", NULL};
  const char *word = NULL;
  char value[256], *all = NULL, *at;
  size_t n;

  name[0] = 0;
  for (int i = 0; heads[i] && !word; i++)
    if (!strncmp(errors->message, heads[i], strlen(heads[i]))) word = errors->message + strlen(heads[i]);
  if (!word) return;
  n = strcspn(word, " ");
  if (!n || n >= sizeof(value)) return;
  memcpy(value, word, n);
  value[n] = 0;
  if (PetscOptionsGetAll(NULL, &all)) return;
  for (at = strstr(all, value); at; at = strstr(at + 1, value)) {
    char *start = at;
    while (start > all && !(start[0] == '-' && (start == all || start[-1] == ' ') && strcspn(start, " ") < (size_t)(at - start)))
      start--;
    if (start[0] == '-' && (at[n] == ' ' || at[n] == ',')) {
      snprintf(name, len, "%.*s", (int)(strcspn(start, " ") - 1), start + 1);
      break;
    }
  }
  PetscFree(all);
}

static void print_line(const AppErrors *errors)
{
  char option[PETSC_MAX_OPTION_NAME];

  name_option(errors, sizeof(option), option);
  fflush(stdout);
  fprintf(stderr, "frond: error: ");
  if (option[0]) fprintf(stderr, "option %s: ", option);
  if (errors->context[0]) fprintf(stderr, "%s: ", errors->context);
  fprintf(stderr, "%s\n", errors->message);
}

/* Print the line of the innermost error, unless quiet, and return the exit code for it. */
int AppErrorReport(const AppErrors *errors, PetscErrorCode ierr, PetscBool quiet)
{
  if (!quiet) print_line(errors);
  if (errors->memory) return APP_EXIT_USER;
  switch ((int)ierr) {
  case PETSC_ERR_FP:
  case PETSC_ERR_NOT_CONVERGED:
  case PETSC_ERR_CONV_FAILED:
  case PETSC_ERR_MAT_LU_ZRPVT:
  case PETSC_ERR_MAT_CH_ZRPVT:
    return APP_EXIT_NUMERICAL;
  case PETSC_ERR_FILE_OPEN:
  case PETSC_ERR_FILE_READ:
  case PETSC_ERR_FILE_WRITE:
  case PETSC_ERR_FILE_UNEXPECTED:
    return APP_EXIT_IO;
  default:
    return APP_EXIT_USER;
  }
}
