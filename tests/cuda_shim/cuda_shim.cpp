/* cuda_shim.cpp - see cuda_runtime.h. Device memory is one reserved range that is accessible only while stream work runs. */
#include "cuda_runtime.h"
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <map>
#include <string>
#include <sys/mman.h>
#include <vector>
#if defined(__SANITIZE_ADDRESS__)
  #include <sanitizer/asan_interface.h>
#else
  #define ASAN_POISON_MEMORY_REGION(p, n) ((void)0)
  #define ASAN_UNPOISON_MEMORY_REGION(p, n) ((void)0)
#endif

dim3 threadIdx, blockIdx, blockDim, gridDim;

struct CudaShimStream {
  std::deque<std::function<void()>> work;
};
struct CudaShimEvent {
  CudaShimStream *stream;
  bool done;
};

static const size_t guard = 4096, reserve = (size_t)1 << 33;
static const int canary = 0xa5;

static struct {
  char *base;
  size_t used, memory = (size_t)1 << 30;
  std::map<char *, size_t> live;   /* device allocations */
  std::map<char *, size_t> pinned; /* host memory from cudaMallocHost */
  CudaShimStream standard;
  CudaShimCounts counts;
  long failin = -1;
  cudaError_t failure = cudaSuccess;
  int order, eager, devices = 1, depth;
} shim;

static cudaError_t Enter()
{
  shim.counts.calls++;
  if (shim.failin < 0) return cudaSuccess;
  if (shim.failin > 0) {
    shim.failin--;
    return cudaSuccess;
  }
  return shim.failure;
}
#define ENTER()                                                                                                                  \
  do {                                                                                                                           \
    const cudaError_t err_ = Enter();                                                                                            \
    if (err_ != cudaSuccess) return err_;                                                                                        \
  } while (0)

static void Protect(int on)
{
  if (shim.base && shim.used && mprotect(shim.base, (shim.used + 4095) / 4096 * 4096, on ? PROT_NONE : PROT_READ | PROT_WRITE))
    abort();
}

/* Device memory is open to the work, and to nothing else. */
static void Run(const std::function<void()> &work)
{
  if (shim.depth++ == 0) Protect(0);
  work();
  if (--shim.depth == 0) Protect(1);
}

static void Drain(CudaShimStream *s)
{
  while (!s->work.empty()) {
    const std::function<void()> work = std::move(s->work.front());
    s->work.pop_front();
    Run(work);
  }
}

static CudaShimStream *StreamOf(cudaStream_t stream)
{
  return stream ? stream : &shim.standard;
}

static bool Inside(const std::map<char *, size_t> &blocks, const void *p, size_t bytes)
{
  auto it = blocks.upper_bound((char *)p);
  if (it == blocks.begin()) return false;
  --it;
  return (char *)p + bytes <= it->first + it->second;
}

static bool InArena(const void *p)
{
  return shim.base && (char *)p >= shim.base && (char *)p < shim.base + reserve;
}

static void Die(const char *what, const void *p)
{
  fprintf(stderr, "cuda shim: %s (%p)\n", what, p);
  abort();
}

cudaError_t cudaShimEnqueue(cudaStream_t stream, std::function<void()> work)
{
  ENTER();
  StreamOf(stream)->work.push_back(std::move(work));
  if (shim.eager) Drain(StreamOf(stream));
  return cudaSuccess;
}

cudaError_t cudaShimEnqueueGrid(const cudaLaunchConfig_t &config, std::function<void()> thread)
{
  const dim3 g = config.gridDim, b = config.blockDim;
  const size_t total = (size_t)g.x * b.x;

  if (!g.x || !b.x || b.x > 1024 || g.y != 1 || g.z != 1 || b.y != 1 || b.z != 1) return cudaErrorInvalidValue;
  shim.counts.launches++;
  return cudaShimEnqueue(config.stream, [=]() {
    gridDim = g;
    blockDim = b;
    for (size_t k = 0; k < total; k++) {
      size_t t = k;
      if (shim.order == 1)
        t = total - 1 - k;
      else if (shim.order == 2)
        t = k < (total + 1) / 2 ? 2 * k : 2 * (k - (total + 1) / 2) + 1;
      blockIdx = dim3((unsigned)(t / b.x));
      threadIdx = dim3((unsigned)(t % b.x));
      thread();
    }
  });
}

cudaError_t cudaMalloc(void **p, size_t bytes)
{
  const size_t room = (bytes + 4095) / 4096 * 4096 + 2 * guard;

  ENTER();
  if (shim.counts.bytes + bytes > shim.memory) return cudaErrorMemoryAllocation;
  if (!shim.base) {
    shim.base = (char *)mmap(NULL, reserve, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (shim.base == MAP_FAILED) Die("no address space", NULL);
  }
  if (shim.used + room > reserve) Die("out of address space", NULL);
  char *block = shim.base + shim.used, *start = block + guard;
  shim.used += room;
  Run([=]() {
    memset(block, canary, room);
    memset(start, 0xff, bytes); /* not a number in every format */
  });
  ASAN_POISON_MEMORY_REGION(block, guard);
  ASAN_POISON_MEMORY_REGION(start + bytes, room - guard - bytes);
  shim.live[start] = bytes;
  shim.counts.live++;
  shim.counts.mallocs++;
  shim.counts.bytes += bytes;
  if (shim.counts.bytes > shim.counts.peak) shim.counts.peak = shim.counts.bytes;
  *p = start;
  return cudaSuccess;
}

cudaError_t cudaFree(void *p)
{
  if (!p) return Enter();
  auto it = shim.live.find((char *)p);
  if (it == shim.live.end()) Die("cudaFree of an address that cudaMalloc did not give", p);
  Drain(&shim.standard);
#if !defined(__SANITIZE_ADDRESS__)
  char *start = it->first;
  const size_t bytes = it->second, room = (bytes + 4095) / 4096 * 4096;
  Run([=]() {
    for (size_t k = 0; k < guard; k++)
      if ((unsigned char)start[-1 - (long)k] != canary) Die("write in front of a device allocation", start);
    for (size_t k = bytes; k < room + guard; k++)
      if ((unsigned char)start[k] != canary) Die("write behind a device allocation", start);
  });
#endif
  ASAN_POISON_MEMORY_REGION(p, it->second);
  shim.counts.live--;
  shim.counts.bytes -= it->second;
  shim.live.erase(it);
  if (shim.live.empty()) { /* start over */
    ASAN_UNPOISON_MEMORY_REGION(shim.base, shim.used);
    shim.used = 0;
  }
  return Enter();
}

cudaError_t cudaMallocHost(void **p, size_t bytes)
{
  ENTER();
  *p = malloc(bytes);
  memset(*p, 0xff, bytes);
  shim.pinned[(char *)*p] = bytes;
  shim.counts.live++;
  return cudaSuccess;
}

cudaError_t cudaFreeHost(void *p)
{
  if (!p) return Enter();
  if (!shim.pinned.erase((char *)p)) Die("cudaFreeHost of an address that cudaMallocHost did not give", p);
  shim.counts.live--;
  free(p);
  return Enter();
}

static bool BadCopy(const void *dst, const void *src, size_t bytes, cudaMemcpyKind kind)
{
  const bool dd = kind == cudaMemcpyHostToDevice || kind == cudaMemcpyDeviceToDevice,
             sd = kind == cudaMemcpyDeviceToHost || kind == cudaMemcpyDeviceToDevice;

  if (dd ? !Inside(shim.live, dst, bytes) : InArena(dst)) return true;
  return sd ? !Inside(shim.live, src, bytes) : InArena(src);
}

/* From pageable memory the source is read at once, from pinned memory when the copy runs. */
cudaError_t cudaMemcpyAsync(void *dst, const void *src, size_t bytes, cudaMemcpyKind kind, cudaStream_t stream)
{
  if (BadCopy(dst, src, bytes, kind)) return cudaErrorInvalidValue;
  if (kind == cudaMemcpyHostToDevice) shim.counts.todevice += bytes;
  if (kind == cudaMemcpyDeviceToHost) shim.counts.fromdevice += bytes;
  if (kind == cudaMemcpyHostToDevice && !Inside(shim.pinned, src, bytes)) {
    const std::string now((const char *)src, bytes);
    return cudaShimEnqueue(stream, [=]() { memcpy(dst, now.data(), bytes); });
  }
  return cudaShimEnqueue(stream, [=]() { memcpy(dst, src, bytes); });
}

cudaError_t cudaMemcpy(void *dst, const void *src, size_t bytes, cudaMemcpyKind kind)
{
  const cudaError_t err = cudaMemcpyAsync(dst, src, bytes, kind, NULL);

  Drain(&shim.standard);
  return err;
}

cudaError_t cudaMemsetAsync(void *dst, int value, size_t bytes, cudaStream_t stream)
{
  if (!Inside(shim.live, dst, bytes)) return cudaErrorInvalidValue;
  return cudaShimEnqueue(stream, [=]() { memset(dst, value, bytes); });
}

cudaError_t cudaStreamCreateWithFlags(cudaStream_t *stream, unsigned)
{
  ENTER();
  *stream = new CudaShimStream;
  shim.counts.live++;
  return cudaSuccess;
}

cudaError_t cudaStreamSynchronize(cudaStream_t stream)
{
  ENTER();
  Drain(StreamOf(stream));
  return cudaSuccess;
}

cudaError_t cudaStreamDestroy(cudaStream_t stream)
{
  delete stream;
  shim.counts.live--;
  return Enter();
}

cudaError_t cudaEventCreateWithFlags(cudaEvent_t *event, unsigned)
{
  ENTER();
  *event = new CudaShimEvent{NULL, true};
  shim.counts.live++;
  return cudaSuccess;
}

cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream)
{
  event->stream = StreamOf(stream);
  event->done = false;
  return cudaShimEnqueue(stream, [=]() { event->done = true; });
}

cudaError_t cudaEventSynchronize(cudaEvent_t event)
{
  ENTER();
  while (!event->done && !event->stream->work.empty()) {
    const std::function<void()> work = std::move(event->stream->work.front());
    event->stream->work.pop_front();
    Run(work);
  }
  return cudaSuccess;
}

cudaError_t cudaEventDestroy(cudaEvent_t event)
{
  delete event;
  shim.counts.live--;
  return Enter();
}

cudaError_t cudaMemGetInfo(size_t *free, size_t *total)
{
  ENTER();
  *free = shim.memory - shim.counts.bytes;
  *total = shim.memory;
  return cudaSuccess;
}

cudaError_t cudaGetDeviceCount(int *n)
{
  ENTER();
  *n = shim.devices;
  return shim.devices ? cudaSuccess : cudaErrorNoDevice;
}

cudaError_t cudaGetLastError(void)
{
  return shim.failin == 0 ? shim.failure : cudaSuccess;
}

const char *cudaGetErrorName(cudaError_t err)
{
  switch (err) {
  case cudaErrorMemoryAllocation:
    return "cudaErrorMemoryAllocation";
  case cudaErrorNoDevice:
    return "cudaErrorNoDevice";
  case cudaErrorECCUncorrectable:
    return "cudaErrorECCUncorrectable";
  case cudaErrorLaunchFailure:
    return "cudaErrorLaunchFailure";
  case cudaErrorInvalidValue:
    return "cudaErrorInvalidValue";
  default:
    return "cudaError";
  }
}

const char *cudaGetErrorString(cudaError_t err)
{
  return cudaGetErrorName(err);
}

int cudaShimOrder(void)
{
  return shim.order;
}
void cudaShimSetOrder(int order)
{
  shim.order = order;
}
void cudaShimSetEager(int eager)
{
  shim.eager = eager;
}
void cudaShimSetMemory(size_t bytes)
{
  shim.memory = bytes;
}
void cudaShimSetDeviceCount(int n)
{
  shim.devices = n;
}
CudaShimCounts cudaShimGetCounts(void)
{
  return shim.counts;
}
const void *cudaShimSomeDeviceAddress(void)
{
  return shim.live.empty() ? NULL : shim.live.begin()->first;
}

void cudaShimFailCall(long calls, int error)
{
  shim.failin = calls;
  shim.failure = (cudaError_t)error;
}
