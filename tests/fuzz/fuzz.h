/*
  fuzz.h - what the libFuzzer targets share: one PetscInitialize(), errors that return, the input as a file in memory.

  Memory that our sources take through PETSc is freed after each input, for error paths may leave it to the end of the program;
  more than FUZZ_BYTES_MAX of it at once is a finding: sizes are to be checked before memory is taken.
*/
#ifndef FUZZ_H
#define FUZZ_H

#include "app.h"
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#define FUZZ_BYTES_MAX ((size_t)64 << 20)

typedef struct FuzzBlock {
  struct FuzzBlock *next, *last;
} FuzzBlock;
static FuzzBlock fuzz_blocks = {&fuzz_blocks, &fuzz_blocks};
static char fuzz_file[64];
static int fuzz_fd = -1;

/* Whether a source is ours and not PETSc's; ccache may make names relative. */
static int fuzz_ours(const char file[])
{
  static const char *const folders[] = {"src/app/", "src/rigid/", "src/ancf_petsc/", "src/couple/", "src/sph_cuda/"};

  for (size_t i = 0; file && i < sizeof(folders) / sizeof(folders[0]); i++)
    if (strstr(file, folders[i])) return 1;
  return 0;
}

static void fuzz_link(FuzzBlock *b, int ours)
{
  if (!ours) {
    b->next = b->last = b;
    return;
  }
  b->next = fuzz_blocks.next;
  b->last = &fuzz_blocks;
  b->next->last = b;
  fuzz_blocks.next = b;
}

static void fuzz_unlink(FuzzBlock *b)
{
  b->next->last = b->last;
  b->last->next = b->next;
}

static PetscErrorCode fuzz_malloc(size_t n, PetscBool clear, int line, const char func[], const char file[], void **p)
{
  const int ours = fuzz_ours(file);
  FuzzBlock *b;

  (void)func;
  *p = NULL;
  if (!n) return PETSC_SUCCESS;
  if (ours && n > FUZZ_BYTES_MAX) {
    fprintf(stderr, "%s, line %d: %zu bytes at once\n", file, line, n);
    abort();
  }
  b = n < ((size_t)1 << 40) ? (clear ? calloc(1, n + sizeof(*b)) : malloc(n + sizeof(*b))) : NULL;
  if (!b) return PETSC_ERR_MEM;
  fuzz_link(b, ours);
  *p = b + 1;
  return PETSC_SUCCESS;
}

static PetscErrorCode fuzz_free(void *p, int line, const char func[], const char file[])
{
  (void)line;
  (void)func;
  (void)file;
  if (!p) return PETSC_SUCCESS;
  fuzz_unlink((FuzzBlock *)p - 1);
  free((FuzzBlock *)p - 1);
  return PETSC_SUCCESS;
}

static PetscErrorCode fuzz_realloc(size_t n, int line, const char func[], const char file[], void **p)
{
  FuzzBlock *b = *p ? (FuzzBlock *)*p - 1 : NULL, *now;
  const int ours = b ? b->next != b : fuzz_ours(file);

  if (!b) return fuzz_malloc(n, PETSC_FALSE, line, func, file, p);
  if (ours && n > FUZZ_BYTES_MAX) {
    fprintf(stderr, "%s, line %d: %zu bytes at once\n", file, line, n);
    abort();
  }
  fuzz_unlink(b);
  now = realloc(b, n + sizeof(*b));
  if (!now) return PETSC_ERR_MEM;
  fuzz_link(now, ours);
  *p = now + 1;
  return PETSC_SUCCESS;
}

static inline void fuzz_free_all(void)
{
  while (fuzz_blocks.next != &fuzz_blocks) fuzz_free(fuzz_blocks.next + 1, 0, NULL, NULL);
}

#ifdef FUZZ_STREAM
  #include <dlfcn.h>
/* Targets that read by fopen() only: the input is a stream of the C library, which needs no system call. */
static const uint8_t *fuzz_data;
static size_t fuzz_size;

__attribute__((visibility("default"))) FILE *fopen(const char *restrict file, const char *restrict mode)
{
  FILE *(*next)(const char *, const char *);

  if (!strcmp(file, fuzz_file)) return fmemopen((void *)(uintptr_t)fuzz_data, fuzz_size, mode);
  *(void **)&next = dlsym(RTLD_NEXT, "fopen");
  return next(file, mode);
}

static inline void fuzz_write(const uint8_t *data, size_t size)
{
  fuzz_data = data;
  fuzz_size = size;
}
#else
/* The input becomes the content of fuzz_file. */
static inline void fuzz_write(const uint8_t *data, size_t size)
{
  if (ftruncate(fuzz_fd, 0) || pwrite(fuzz_fd, data, size, 0) != (ssize_t)size) abort();
}
#endif

#ifdef FUZZ_HDF5
/* HDF5 wants a file with a path of its own. */
static void fuzz_unlink_file(void)
{
  unlink(fuzz_file);
}
#endif

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  char name[] = "fuzz", signals[] = "-no_signal_handler", *words[] = {name, signals, NULL}, **list = words;
  int n = 2;

  (void)argc;
  (void)argv;
  if (PetscMallocSet(fuzz_malloc, fuzz_free, fuzz_realloc)) abort();
  if (PetscInitialize(&n, &list, NULL, NULL)) abort();
  if (PetscPushErrorHandler(PetscReturnErrorHandler, NULL)) abort();
#ifdef FUZZ_HDF5
  strcpy(fuzz_file, access("/dev/shm", W_OK) ? "/tmp/fuzzXXXXXX" : "/dev/shm/fuzzXXXXXX");
  fuzz_fd = mkstemp(fuzz_file);
  if (fuzz_fd < 0 || atexit(fuzz_unlink_file)) abort();
#else
  fuzz_fd = memfd_create("input", 0);
  if (fuzz_fd < 0) abort();
  snprintf(fuzz_file, sizeof(fuzz_file), "/proc/self/fd/%d", fuzz_fd);
#endif
  return 0;
}

#endif
