/*
  checkpoint.c - checkpoint files: written whole or not at all, and read only when not a bit is wrong.

  A file is a head of HEAD_BYTES bytes of text (the user block of HDF5) and an HDF5 file with a dataset for each array of the
  state, each with a Fletcher-32 sum. The head:

    frond-checkpoint <format>
    step <step> time <s> bytes <size of the file>
    crc32 <zlib's CRC-32 of all that follows the head, then of the lines above>

  and zeros. Nothing but the head is looked at before the CRC-32 of the whole file is found right.
*/
#include "app.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#define HEAD_BYTES 512
#define MAGIC "frond-checkpoint "
#define BLOCK (1 << 20)

#define FileCheck(ok, file)                                                                                                      \
  PetscCheck(ok, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "cannot write the checkpoint '%s': %s", file, strerror(errno))

void AppCheckpointName(PetscInt step, size_t len, char name[])
{
  snprintf(name, len, "checkpoint_%09" PetscInt_FMT ".h5", step);
}

/* CRC-32 of everything behind the head; bytes: the file's size. Returns 0 when reading fails. */
static int body_crc(int fd, uint32_t *crc, long long *bytes)
{
  unsigned char *block = malloc(BLOCK);
  uLong c = crc32(0, NULL, 0);
  ssize_t n = block ? 1 : -1;

  *bytes = HEAD_BYTES;
  while (n > 0) {
    n = pread(fd, block, BLOCK, (off_t)*bytes);
    if (n > 0) {
      c = crc32(c, block, (uInt)n);
      *bytes += n;
    }
  }
  free(block);
  *crc = (uint32_t)c;
  return n == 0;
}

static int head_lines(const CheckpointInfo *info, long long bytes, uint32_t crc, char head[HEAD_BYTES])
{
  int n;

  memset(head, 0, HEAD_BYTES);
  n = snprintf(head, HEAD_BYTES, MAGIC "%d\nstep %lld time %.17g bytes %lld\n", APP_CHECKPOINT_FORMAT, (long long)info->step,
               (double)info->t, bytes);
  crc = (uint32_t)crc32(crc, (const unsigned char *)head, (uInt)n);
  return n + snprintf(head + n, (size_t)(HEAD_BYTES - n), "crc32 %08x\n", (unsigned)crc);
}

/* Head and sync of a file that HDF5 has closed. */
static PetscErrorCode seal(const char file[], const CheckpointInfo *info)
{
  char head[HEAD_BYTES];
  long long bytes;
  uint32_t crc;
  int fd = open(file, O_RDWR), good, err;

  PetscFunctionBegin;
  FileCheck(fd >= 0, file);
  good = body_crc(fd, &crc, &bytes);
  if (good) {
    head_lines(info, bytes, crc, head);
    good = pwrite(fd, head, HEAD_BYTES, 0) == HEAD_BYTES && !fsync(fd);
  }
  err = errno;
  good = !close(fd) && good;
  errno = err;
  FileCheck(good, file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static hid_t disk_type(FrondStateType type)
{
  return type == FROND_REAL64 ? H5T_IEEE_F64LE : (type == FROND_INT64 ? H5T_STD_I64LE : H5T_STD_I32LE);
}

static hid_t memory_type(FrondStateType type)
{
  return type == FROND_REAL64 ? H5T_NATIVE_DOUBLE : (type == FROND_INT64 ? H5T_NATIVE_INT64 : H5T_NATIVE_INT32);
}

static herr_t write_array(hid_t file, hid_t links, const char name[], hid_t disk, hid_t memory, size_t n, const void *data)
{
  hsize_t dim = n, chunk = PetscMin(n, (size_t)1 << 17);
  hid_t space = H5Screate_simple(1, &dim, NULL), create = H5Pcreate(H5P_DATASET_CREATE), set;
  herr_t err = 0;

  if (n) err |= H5Pset_chunk(create, 1, &chunk) | H5Pset_fletcher32(create);
  set = H5Dcreate2(file, name, disk, space, links, create, H5P_DEFAULT);
  err |= set < 0 ? -1 : 0;
  if (n && set >= 0) err |= H5Dwrite(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
  if (set >= 0) err |= H5Dclose(set);
  H5Pclose(create);
  H5Sclose(space);
  return err;
}

static PetscErrorCode write_h5(const char file[], const AppState *s, const CheckpointInfo *info)
{
  hid_t create = H5Pcreate(H5P_FILE_CREATE), access = H5Pcreate(H5P_FILE_ACCESS), links = H5Pcreate(H5P_LINK_CREATE), id;
  herr_t err;

  PetscFunctionBegin;
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  H5Pset_userblock(create, HEAD_BYTES);
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_LATEST);
  H5Pset_create_intermediate_group(links, 1);
  errno = 0;
  id = H5Fcreate(file, H5F_ACC_TRUNC, create, access);
  err = id < 0 ? -1 : 0;
  if (!err) err = write_array(id, links, "options", H5T_NATIVE_CHAR, H5T_NATIVE_CHAR, strlen(info->options), info->options);
  for (PetscInt i = 0; i < s->n && err >= 0; i++) {
    const StateArray *a = &s->array[i];
    err = write_array(id, links, a->name, disk_type(a->type), memory_type(a->type), a->n, a->data);
  }
  if (id >= 0) err |= H5Fflush(id, H5F_SCOPE_GLOBAL) | H5Fclose(id);
  H5Pclose(create);
  H5Pclose(access);
  H5Pclose(links);
  PetscCheck(err >= 0, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "cannot write the checkpoint '%s': %s", file,
             errno ? strerror(errno) : "is the disk full?");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int checkpoint_step(const char name[], long long *step)
{
  int end = 0;

  return sscanf(name, "checkpoint_%lld.h5%n", step, &end) == 1 && end && !name[end];
}

/* Remove those of dir that are older than the newest `keep` up to step `newest`, or, with keep < 0, those newer than `newest`. */
PetscErrorCode AppCheckpointPrune(const char dir[], PetscInt newest, PetscInt keep)
{
  char path[PETSC_MAX_PATH_LEN + 300];
  struct dirent *entry;
  PetscInt n = 0, alloc = 0;
  PetscInt64 *steps = NULL;
  long long step;
  int end = 0;
  DIR *d = opendir(dir);

  PetscFunctionBegin;
  if (!d) PetscFunctionReturn(PETSC_SUCCESS);
  while ((entry = readdir(d))) {
    if (keep < 0 && sscanf(entry->d_name, "checkpoint_%lld.h5.par%n", &step, &end) == 1 && end &&
        !strcmp(entry->d_name + end, "t")) {
      snprintf(path, sizeof(path), "%s/%s", dir, entry->d_name); /* a run that was killed left it */
      (void)unlink(path);
    }
    if (!checkpoint_step(entry->d_name, &step) || (keep >= 0 ? step > newest : step <= newest)) continue;
    if (n == alloc) {
      alloc = 2 * alloc + 16;
      PetscCall(PetscRealloc((size_t)alloc * sizeof(*steps), &steps));
    }
    steps[n++] = step;
  }
  closedir(d);
  for (PetscInt i = 0; i < n; i++) {
    PetscInt newer = 0;
    char name[64];
    for (PetscInt k = 0; k < n; k++) newer += steps[k] > steps[i];
    if (keep >= 0 && newer < keep) continue;
    AppCheckpointName((PetscInt)steps[i], sizeof(name), name);
    snprintf(path, sizeof(path), "%s/%s", dir, name);
    (void)unlink(path); /* one more than wanted does no harm */
  }
  PetscCall(PetscFree(steps));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Write the state as dir/checkpoint_<step>.h5 and keep the last `keep`; path: where it lies. */
PetscErrorCode AppCheckpointWrite(const char dir[], const AppState *s, const CheckpointInfo *info, PetscInt keep, size_t len,
                                  char path[])
{
  char name[64], part[PETSC_MAX_PATH_LEN + 80];
  int fd;

  PetscFunctionBegin;
  AppCheckpointName(info->step, sizeof(name), name);
  snprintf(path, len, "%s/%s", dir, name);
  snprintf(part, sizeof(part), "%s/%s.part", dir, name);
  PetscCall(write_h5(part, s, info));
  PetscCall(seal(part, info));
  FileCheck(!rename(part, path), path);
  fd = open(dir, O_RDONLY | O_DIRECTORY); /* the new name too must survive a power failure */
  FileCheck(fd >= 0 && !fsync(fd), path);
  close(fd);
  PetscCall(AppCheckpointPrune(dir, info->step, keep));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is wrong with a file, in words; empty for nothing. Fills info but the options. */
static void examine(const char file[], CheckpointInfo *info, size_t len, char wrong[])
{
  char head[HEAD_BYTES + 1] = "", again[HEAD_BYTES];
  long long bytes = 0, size = 0, step = 0;
  unsigned want;
  int format, fd = open(file, O_RDONLY), good;
  struct stat st;
  double t;
  uint32_t crc = 0;

  wrong[0] = 0;
  if (fd < 0 || fstat(fd, &st) || !S_ISREG(st.st_mode)) {
    snprintf(wrong, len, "cannot be read: %s", fd < 0 ? strerror(errno) : "no file");
    if (fd >= 0) close(fd);
    return;
  }
  good = pread(fd, head, HEAD_BYTES, 0) == HEAD_BYTES;
  if (strncmp(head, MAGIC, strlen(MAGIC)) || sscanf(head + strlen(MAGIC), "%d", &format) != 1)
    snprintf(wrong, len, "is no checkpoint of frond");
  else if (format > APP_CHECKPOINT_FORMAT)
    snprintf(wrong, len, "is of format %d, from a newer frond; this one reads format %d", format, APP_CHECKPOINT_FORMAT);
  else if (format < APP_CHECKPOINT_FORMAT)
    snprintf(wrong, len, "is of format %d, from an older frond; this one reads format %d", format, APP_CHECKPOINT_FORMAT);
  else if (!good || sscanf(head, MAGIC "%d\nstep %lld time %lg bytes %lld\ncrc32 %x\n", &format, &step, &t, &size, &want) != 5)
    snprintf(wrong, len, "is damaged: its head is not whole");
  else if (st.st_size != size)
    snprintf(wrong, len, "is damaged: it has %lld bytes of %lld", (long long)st.st_size, size);
  else if (!body_crc(fd, &crc, &bytes))
    snprintf(wrong, len, "cannot be read: %s", strerror(errno));
  else {
    info->step = (PetscInt)step;
    info->t = (PetscReal)t;
    head_lines(info, size, crc, again);
    if (memcmp(head, again, HEAD_BYTES)) snprintf(wrong, len, "is damaged: its checksum is wrong");
  }
  close(fd);
}

/* The good checkpoint of the highest step in dir, other than `not`; path is empty when there is none. */
PetscErrorCode AppCheckpointNewest(const char dir[], const char not [], PetscBool good, size_t len, char path[])
{
  char one[PETSC_MAX_PATH_LEN + 300], wrong[256];
  CheckpointInfo info;
  long long step, best = -1;
  struct dirent *entry;
  DIR *d = opendir(dir);

  PetscFunctionBegin;
  path[0] = 0;
  if (!d) PetscFunctionReturn(PETSC_SUCCESS);
  while ((entry = readdir(d))) {
    if (!checkpoint_step(entry->d_name, &step) || step <= best) continue;
    snprintf(one, sizeof(one), "%s/%s", dir, entry->d_name);
    if (not &&!strcmp(one, not )) continue;
    wrong[0] = 0;
    if (good) examine(one, &info, sizeof(wrong), wrong);
    if (wrong[0]) continue;
    best = step;
    snprintf(path, len, "%s", one);
  }
  closedir(d);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int read_array(hid_t file, const char name[], hsize_t bytes, AppState *s, CheckpointInfo *info)
{
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT), type = H5Dget_type(set), space = H5Dget_space(set);
  const hssize_t n = H5Sget_simple_extent_npoints(space);
  const size_t size = H5Tget_size(type);
  FrondStateType t = H5Tget_class(type) == H5T_FLOAT ? FROND_REAL64 : (size == 8 ? FROND_INT64 : FROND_INT32);
  void *data = NULL;
  int err = n < 0 || !size || (hsize_t)n > bytes / size; /* no array is larger than the file */

  if (!strcmp(name, "options")) {
    err = err || size != 1 || PetscMalloc((size_t)n + 1, &info->options);
    if (!err) info->options[n] = 0;
    if (!err && n) err = H5Dread(set, H5T_NATIVE_CHAR, H5S_ALL, H5S_ALL, H5P_DEFAULT, info->options) < 0;
  } else {
    err = err || (size != 4 && size != 8) || AppStateAdd(s, name, t, (size_t)n, &data);
    if (!err && n) err = H5Dread(set, memory_type(t), H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0;
  }
  H5Sclose(space);
  H5Tclose(type);
  H5Dclose(set);
  return err;
}

typedef struct {
  AppState *s;
  CheckpointInfo *info;
  hsize_t bytes; /* of the file */
} Reading;

#if H5_VERSION_GE(1, 12, 0)
typedef H5O_info2_t ObjectInfo;
  #define Visit(id, ctx) H5Ovisit3(id, H5_INDEX_NAME, H5_ITER_NATIVE, visit, ctx, H5O_INFO_BASIC)
#else
typedef H5O_info_t ObjectInfo;
  #define Visit(id, ctx) H5Ovisit2(id, H5_INDEX_NAME, H5_ITER_NATIVE, visit, ctx, H5O_INFO_BASIC)
#endif

static herr_t visit(hid_t file, const char *name, const ObjectInfo *object, void *ctx)
{
  const Reading *r = (const Reading *)ctx;
  return object->type == H5O_TYPE_DATASET ? read_array(file, name, r->bytes, r->s, r->info) : 0;
}

/* Read a checkpoint into s and info (free info->options). Errors: PETSC_ERR_FILE_UNEXPECTED naming a good one nearby, if any. */
PetscErrorCode AppCheckpointRead(const char file[], AppState *s, CheckpointInfo *info)
{
  char wrong[256], dir[PETSC_MAX_PATH_LEN], other[PETSC_MAX_PATH_LEN + 300];
  Reading r = {s, info, 0};
  herr_t err;
  hid_t id;

  PetscFunctionBegin;
  info->options = NULL;
  examine(file, info, sizeof(wrong), wrong);
  if (wrong[0]) {
    char *slash;
    PetscCall(PetscStrncpy(dir, file, sizeof(dir)));
    slash = strrchr(dir, '/');
    if (slash)
      *slash = 0;
    else
      PetscCall(PetscStrncpy(dir, ".", sizeof(dir)));
    PetscCall(AppCheckpointNewest(dir, file, PETSC_TRUE, sizeof(other), other));
    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED, "restart: '%s' %s; %s%s%s", file, wrong,
            other[0] ? "the last good checkpoint there is '" : "there is no other checkpoint in that folder", other,
            other[0] ? "'" : "");
  }
  AppStateBegin(s, FROND_STATE_SAVE);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  id = H5Fopen(file, H5F_ACC_RDONLY, H5P_DEFAULT);
  err = id < 0 || H5Fget_filesize(id, &r.bytes) < 0 ? -1 : Visit(id, &r);
  if (id >= 0) H5Fclose(id);
  PetscCheck(!err && info->options, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED, "restart: HDF5 cannot read '%s'", file);
  PetscFunctionReturn(PETSC_SUCCESS);
}
