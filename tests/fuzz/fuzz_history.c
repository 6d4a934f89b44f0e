/*
  fuzz_history.c - a history.csv that a restart goes on: header, then rows of the columns that the run has. The first byte of the
  input is the number of rows that the checkpoint has, the second its last time in ms; what is taken is finite and ends there.
*/
#define FUZZ_STREAM
#include "history.c"
#include "fuzz.h"

static PetscErrorCode columns(AppHistory h)
{
  static const char *const names[][2] = {{"time", "s"}, {"step", "1"}, {"dt", "s"}, {"beam_rod_kinetic", "J"}};

  PetscFunctionBegin;
  for (size_t c = 0; c < sizeof(names) / sizeof(names[0]); c++) PetscCall(put(h, names[c][0], names[c][1], "", 0));
  h->known = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  struct _AppHistory h;
  PetscReal tlast;

  if (size < 3) return 0;
  memset(&h, 0, sizeof(h));
  strcpy(h.dir, "folder");
  tlast = data[1] * 1e-3;
  fuzz_write(data + 2, size - 2);
  if (columns(&h)) abort();
  h.csv = fopen(fuzz_file, "r");
  if (h.csv) {
    if (!read_rows(&h, data[0], tlast) && h.nrows) {
      if (h.nrows != data[0] || h.rows[(h.nrows - 1) * h.ncols] != tlast || h.end < 0 || h.end > (off_t)size) abort();
      for (PetscInt i = 0; i < h.nrows * h.ncols; i++)
        if (PetscIsInfOrNanReal(h.rows[i])) abort();
    }
    fclose(h.csv);
  }
  fuzz_free_all();
  return 0;
}
