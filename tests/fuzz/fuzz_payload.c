/*
  fuzz_payload.c - what a checkpoint whose checksum is right may hold: datasets of any name, type and shape, as the input says.
  Each record of the input is a length of name, a name, a kind, a size of 2 bytes, and a byte that the values are made of. What
  was read is then loaded as parts of a state. HDF5's own readers, behind their checksums, are not what is tested here.
*/
#include "checkpoint.c"
#define FUZZ_HDF5
#include "fuzz.h"

#define MOST_VALUES 1024

enum {
  KIND_REAL,
  KIND_INT64,
  KIND_INT32,
  KIND_CHAR,
  KIND_FLOAT,
  KIND_SHORT,
  KIND_COMPOUND,
  KIND_STRING,
  KIND_SCALAR,
  KIND_FLAT,
  KIND_NULL,
  KIND_HUGE,
  KINDS
};

/* A dataset of n values; of a shape that no checkpoint has for the later kinds. */
static void add(hid_t file, hid_t links, const char name[], int kind, hsize_t n, uint8_t byte)
{
  const hid_t types[KINDS] = {H5T_IEEE_F64LE, H5T_STD_I64LE, H5T_STD_I32LE,  H5T_NATIVE_CHAR, H5T_IEEE_F32LE, H5T_STD_I16LE,
                              H5T_IEEE_F64LE, H5T_C_S1,      H5T_IEEE_F64LE, H5T_IEEE_F64LE,  H5T_STD_I32LE,  H5T_IEEE_F64LE};
  const hsize_t flat[2] = {n, 3}, huge = (hsize_t)1 << 40, most = H5S_UNLIMITED, chunk = 64;
  static uint8_t values[3 * MOST_VALUES * 8];
  hid_t type = H5Tcopy(types[kind]), space, create = H5Pcreate(H5P_DATASET_CREATE), set;

  if (kind == KIND_COMPOUND) {
    H5Tclose(type);
    type = H5Tcreate(H5T_COMPOUND, 12);
    H5Tinsert(type, "a", 0, H5T_IEEE_F64LE);
    H5Tinsert(type, "b", 8, H5T_STD_I32LE);
  }
  if (kind == KIND_STRING) H5Tset_size(type, (size_t)byte + 1);
  if (kind == KIND_SCALAR)
    space = H5Screate(H5S_SCALAR);
  else if (kind == KIND_NULL)
    space = H5Screate(H5S_NULL);
  else if (kind == KIND_FLAT)
    space = H5Screate_simple(2, flat, NULL);
  else
    space = H5Screate_simple(1, kind == KIND_HUGE ? &huge : &n, kind == KIND_HUGE ? &most : NULL);
  if (kind == KIND_HUGE) H5Pset_chunk(create, 1, &chunk);
  set = H5Dcreate2(file, name, type, space, links, create, H5P_DEFAULT);
  memset(values, byte, 24 * (size_t)n); /* at most 3 values of 8 bytes for each */
  if (set >= 0 && kind != KIND_HUGE && kind != KIND_NULL && kind != KIND_STRING)
    H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  if (set >= 0) H5Dclose(set);
  H5Pclose(create);
  H5Sclose(space);
  H5Tclose(type);
}

static void write_payload(const uint8_t *data, size_t size)
{
  hid_t create = H5Pcreate(H5P_FILE_CREATE), links = H5Pcreate(H5P_LINK_CREATE), file;
  size_t at = 0;

  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  H5Pset_userblock(create, HEAD_BYTES);
  H5Pset_create_intermediate_group(links, 1);
  file = H5Fcreate(fuzz_file, H5F_ACC_TRUNC, create, H5P_DEFAULT);
  if (file < 0) abort();
  for (int records = 0; records < 16 && at + 6 <= size; records++) {
    const size_t len = PetscMin((size_t)data[at], size - at - 5);
    char name[256];
    memcpy(name, data + at + 1, len);
    name[len] = 0;
    at += 1 + len;
    add(file, links, name, data[at] % KINDS, (hsize_t)(data[at + 1] | data[at + 2] << 8) % MOST_VALUES, data[at + 3]);
    at += 4;
  }
  H5Fclose(file);
  H5Pclose(create);
  H5Pclose(links);
}

static PetscErrorCode load(AppState *state)
{
  FrondState *s = AppStateBegin(state, FROND_STATE_LOAD);
  double t, x[4];
  PetscInt step;
  int group[4];
  PetscBool flag = PETSC_FALSE;

  PetscFunctionBegin;
  FrondMoveReal(s, "run/time", &t, 1);
  FrondMoveInt(s, "run/step", &step, 1);
  FrondMoveReal(s, "fluid/x", x, 4);
  FrondMoveInt32(s, "fluid/group", group, 4);
  FrondMoveBool(s, "flag", &flag);
  PetscFunctionReturn(PETSC_SUCCESS);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  CheckpointInfo info = {3, 0.5, NULL};
  AppState state;

  write_payload(data, size);
  if (seal(fuzz_file, &info)) abort();
  memset(&state, 0, sizeof(state));
  if (!AppCheckpointRead(fuzz_file, &state, &info)) {
    (void)load(&state);
    (void)AppStateNotFinite(&state);
    PetscFree(info.options);
  }
  AppStateDestroy(&state);
  fuzz_free_all();
  return 0;
}
