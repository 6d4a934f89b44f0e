/*
  fuzz_checkpoint.c - a checkpoint: its head and checksum. HDF5 sees only files whose CRC-32 is right, so that its own readers
  are not what is tested here.
*/
#define FUZZ_HDF5
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  AppState state;
  CheckpointInfo info;

  fuzz_write(data, size);
  memset(&state, 0, sizeof(state));
  if (!AppCheckpointRead(fuzz_file, &state, &info)) PetscFree(info.options);
  AppStateDestroy(&state);
  fuzz_free_all();
  return 0;
}
