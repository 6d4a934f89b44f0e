/*
  appcsv.c - tables over time in text files with commas: a header that names the columns, then rows of numbers.

  The first column is t (s), the others are any of those that the caller knows; those left out are zero. Lines that are empty
  or begin with # are skipped. Refused, naming file, line and column: unknown or missing columns, cells that are empty or no
  finite number, times that do not increase, and tables that do not cover the run.
*/
#include "app.h"
#include <ctype.h>
#include <errno.h>
#include <string.h>

#define COLUMNS_MAX 16
#define LINE_MAX_CHARS 4096

typedef struct {
  const char *file;
  PetscInt line, ncols, column[COLUMNS_MAX]; /* of the file: -1 the time, else the caller's */
} Csv;

/* Cut a line at its commas, blanks trimmed. */
static PetscInt cut(char line[], char *cell[COLUMNS_MAX + 1])
{
  PetscInt n = 0;

  for (char *at = line, *next; at && n <= COLUMNS_MAX; at = next) {
    char *end;
    next = strchr(at, ',');
    if (next) *next++ = 0;
    while (isspace((unsigned char)*at)) at++;
    end = at + strlen(at);
    while (end > at && isspace((unsigned char)end[-1])) *--end = 0;
    cell[n++] = at;
  }
  return n;
}

static PetscErrorCode read_header(Csv *c, char line[], const char *const names[])
{
  char *cell[COLUMNS_MAX + 1], known[256] = "t";

  PetscFunctionBegin;
  for (PetscInt k = 0; names[k]; k++) {
    PetscCall(PetscStrlcat(known, ", ", sizeof(known)));
    PetscCall(PetscStrlcat(known, names[k], sizeof(known)));
  }
  c->ncols = cut(line, cell);
  PetscCheck(c->ncols >= 2 && c->ncols <= COLUMNS_MAX && !strcmp(cell[0], "t"), PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
             "'%s', line %" PetscInt_FMT ": the header must name t first, then some of %s", c->file, c->line, known);
  c->column[0] = -1;
  for (PetscInt i = 1; i < c->ncols; i++) {
    PetscInt k = 0;
    while (names[k] && strcmp(names[k], cell[i])) k++;
    PetscCheck(names[k], PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED, "'%s', line %" PetscInt_FMT ": column '%.40s' is none of %s",
               c->file, c->line, cell[i], known);
    for (PetscInt j = 1; j < i; j++)
      PetscCheck(c->column[j] != k, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
                 "'%s', line %" PetscInt_FMT ": column %s is there twice", c->file, c->line, cell[i]);
    c->column[i] = k;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode read_row(const Csv *c, char line[], const char *const names[], PetscReal *t, PetscReal *row)
{
  char *cell[COLUMNS_MAX + 1];
  const PetscInt n = cut(line, cell);

  PetscFunctionBegin;
  PetscCheck(n == c->ncols, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
             "'%s', line %" PetscInt_FMT ": %" PetscInt_FMT " cells, the header has %" PetscInt_FMT, c->file, c->line, n,
             c->ncols);
  for (PetscInt i = 0; i < n; i++) {
    const char *name = c->column[i] < 0 ? "t" : names[c->column[i]];
    char *end;
    double x;
    PetscCheck(cell[i][0], PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
               "'%s', line %" PetscInt_FMT ": column %s is empty: the table has a gap", c->file, c->line, name);
    x = strtod(cell[i], &end);
    PetscCheck(!*end && isfinite(x), PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
               "'%s', line %" PetscInt_FMT ": column %s is '%.40s', not a finite number", c->file, c->line, name, cell[i]);
    if (c->column[i] < 0)
      *t = (PetscReal)x;
    else
      row[c->column[i]] = (PetscReal)x;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode add_row(const Csv *c, char line[], const char *const names[], PetscInt ncols, PetscInt *alloc,
                              AppTable *table)
{
  const PetscInt n = table->n;

  PetscFunctionBegin;
  if (n == *alloc) {
    *alloc = 2 * *alloc + 64;
    PetscCall(PetscRealloc((size_t)*alloc * sizeof(PetscReal), &table->t));
    PetscCall(PetscRealloc((size_t)*alloc * (size_t)ncols * sizeof(PetscReal), &table->value));
  }
  PetscCall(PetscArrayzero(table->value + n * ncols, ncols));
  PetscCall(read_row(c, line, names, &table->t[n], table->value + n * ncols));
  PetscCheck(n == 0 || table->t[n] > table->t[n - 1], PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
             "'%s', line %" PetscInt_FMT ": time %g s does not lie after %g s: times must increase", c->file, c->line,
             (double)table->t[n], n ? (double)table->t[n - 1] : 0.0);
  table->n++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Header and rows of an open file. */
static PetscErrorCode read_lines(Csv *c, FILE *f, const char *const names[], AppTable *table)
{
  char line[LINE_MAX_CHARS];
  PetscInt ncols = 0, alloc = 0;

  PetscFunctionBegin;
  while (names[ncols]) ncols++;
  while (fgets(line, sizeof(line), f)) {
    const size_t blanks = strspn(line, " \t\r\n");
    c->line++;
    PetscCheck(strchr(line, '\n') || feof(f), PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
               "'%s', line %" PetscInt_FMT ": longer than %d characters", c->file, c->line, LINE_MAX_CHARS - 2);
    if (!line[blanks] || line[blanks] == '#') continue;
    if (!c->ncols)
      PetscCall(read_header(c, line, names));
    else
      PetscCall(add_row(c, line, names, ncols, &alloc, table));
  }
  PetscCheck(!ferror(f), PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "cannot read '%s': is it a folder?", c->file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Table of the columns names[] (NULL at the end) over time from a file; it must reach from t = 0 to tend (s). value: n x columns,
  zero where the file lacks the column. Freed by AppTableDestroy().
*/
PetscErrorCode AppTableRead(const char file[], const char *const names[], PetscReal tend, AppTable *table)
{
  Csv c = {.file = file};
  PetscErrorCode ierr;
  FILE *f = fopen(file, "r");

  PetscFunctionBegin;
  PetscCheck(f, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot read '%s': %s", file, strerror(errno));
  PetscCall(PetscMemzero(table, sizeof(*table)));
  ierr = read_lines(&c, f, names, table);
  fclose(f);
  PetscCall(ierr);
  PetscCheck(table->n > 0, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED, "'%s': holds no rows", file);
  PetscCheck(table->t[0] <= 0 && table->t[table->n - 1] >= tend * (1 - 1e-9), PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
             "'%s': times from %g to %g s do not cover the run, 0 to %g s", file, (double)table->t[0],
             (double)table->t[table->n - 1], (double)tend);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppTableDestroy(AppTable *table)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(table->t));
  PetscCall(PetscFree(table->value));
  table->n = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
