/* fuzz_table.c - a table over time in a CSV file; what is taken is finite and its times increase. */
#define FUZZ_STREAM
#include "fuzz.h"
#include <math.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  static const char *const names[] = {"vx", "vy", "vz", "wx", "wy", "wz", NULL};
  AppTable table;

  fuzz_write(data, size);
  if (!AppTableRead(fuzz_file, names, 1., &table)) {
    for (PetscInt i = 0; i < table.n; i++) {
      if (!isfinite(table.t[i]) || (i && !(table.t[i] > table.t[i - 1]))) abort();
      for (int k = 0; k < 6; k++)
        if (!isfinite(table.value[6 * i + k])) abort();
    }
    AppTableDestroy(&table);
  }
  fuzz_free_all();
  return 0;
}
