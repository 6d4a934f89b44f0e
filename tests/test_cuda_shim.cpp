/*
  test_cuda_shim.cpp - the stand-in for the CUDA runtime finds what it is there to find: each mistake below must be noticed.

  A mistake that ends in a fault or a report of AddressSanitizer is made in a child process.
*/
#include "cuda_runtime.h"
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_reduce.cuh>
#include "testing.h"
#include <sys/wait.h>
#include <unistd.h>

static __global__ void Fill(int *p, int n, int value)
{
  const int i = (int)(blockIdx.x * blockDim.x + threadIdx.x);

  if (i < n) p[i] = value + i;
}

static cudaError_t Launch(cudaStream_t stream, int threads, int *p, int n, int value)
{
  cudaLaunchConfig_t config = {};

  config.gridDim = dim3((unsigned)((threads + 31) / 32));
  config.blockDim = dim3(32);
  config.stream = stream;
  return cudaLaunchKernelEx(&config, Fill, p, n, value);
}

/* Does the action end the process? */
static bool Dies(const std::function<void()> &action)
{
  int status = 0;

  fflush(stdout);
  const pid_t pid = fork();
  if (pid == 0) {
    if (!freopen("/dev/null", "w", stderr)) _exit(0);
    action();
    _exit(0);
  }
  (void)waitpid(pid, &status, 0);
  return !(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

int main()
{
  const int n = 100;
  int *d = NULL, *e = NULL, h[100];
  cudaStream_t stream = NULL;
  int *pinned = NULL;

  TEST(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking) == cudaSuccess, "stream");
  TEST(cudaMalloc((void **)&d, n * sizeof(int)) == cudaSuccess && cudaMalloc((void **)&e, n * sizeof(int)) == cudaSuccess,
       "memory");
  TEST(cudaMallocHost((void **)&pinned, n * sizeof(int)) == cudaSuccess, "pinned memory");

  TEST(Launch(stream, n, d, n, 5) == cudaSuccess, "launch");
  TEST(cudaMemcpyAsync(pinned, d, n * sizeof(int), cudaMemcpyDeviceToHost, stream) == cudaSuccess, "copy");
  TEST(pinned[0] != 5, "the result was there without waiting for the stream");
  TEST(cudaStreamSynchronize(stream) == cudaSuccess && pinned[0] == 5 && pinned[n - 1] == 5 + n - 1,
       "the kernel filled in %d, %d", pinned[0], pinned[n - 1]);

  pinned[0] = 7; /* overwritten before the copy ran: the later value arrives */
  TEST(cudaMemcpyAsync(d, pinned, sizeof(int), cudaMemcpyHostToDevice, stream) == cudaSuccess, "copy");
  pinned[0] = 8;
  TEST(cudaStreamSynchronize(stream) == cudaSuccess && cudaMemcpy(h, d, sizeof(int), cudaMemcpyDeviceToHost) == cudaSuccess &&
           h[0] == 8,
       "a pinned buffer was read at the time of the call");
  h[0] = 7;
  TEST(cudaMemcpyAsync(d, h, sizeof(int), cudaMemcpyHostToDevice, stream) == cudaSuccess, "copy");
  h[0] = 8;
  TEST(cudaStreamSynchronize(stream) == cudaSuccess && cudaMemcpy(h, d, sizeof(int), cudaMemcpyDeviceToHost) == cudaSuccess &&
           h[0] == 7,
       "a pageable buffer was read after the call");

  TEST(Dies([&]() { h[0] = d[0]; }), "host code read device memory");
  TEST(Dies([&]() { d[0] = 1; }), "host code wrote device memory");
  TEST(Dies([&]() {
         (void)Launch(stream, n, d, n + 1, 0), (void)Launch(stream, 128, d, n + 1, 0), (void)cudaStreamSynchronize(stream),
             (void)cudaFree(d);
       }),
       "a kernel wrote behind its array");
  TEST(Dies([&]() { (void)Launch(stream, n, d - 1, n, 0), (void)cudaStreamSynchronize(stream), (void)cudaFree(d); }),
       "a kernel wrote in front of its array");
  TEST(Dies([&]() { (void)cudaFree(d), (void)Launch(stream, n, d, n, 0), (void)cudaStreamSynchronize(stream); }),
       "a kernel used memory after it was freed");
  TEST(Dies([&]() { (void)cudaFree(h); }), "host memory was freed as device memory");

  TEST(cudaMemcpy(h, d, sizeof(int), cudaMemcpyHostToDevice) != cudaSuccess, "a copy in the wrong direction passed");
  TEST(cudaMemcpy(h, d, (n + 1) * sizeof(int), cudaMemcpyDeviceToHost) != cudaSuccess, "a copy of too many bytes passed");
  TEST(cudaMemcpy(d, h, sizeof(int), cudaMemcpyDeviceToDevice) != cudaSuccess, "host memory passed as device memory");

  /* Sorting looks at the given bits only, keeps the order of equal keys and leaves the result in the other buffers. */
  unsigned key[4] = {0x13, 0x21, 0x11, 0x03}, got[4];
  unsigned *k0, *k1;
  int value[4] = {0, 1, 2, 3}, from[4];
  void *temp;
  size_t bytes = 0;
  TEST(cudaMalloc((void **)&k0, sizeof(key)) == cudaSuccess && cudaMalloc((void **)&k1, sizeof(key)) == cudaSuccess, "memory");
  TEST(cudaMemcpy(k0, key, sizeof(key), cudaMemcpyHostToDevice) == cudaSuccess &&
           cudaMemcpy(d, value, sizeof(value), cudaMemcpyHostToDevice) == cudaSuccess,
       "copy");
  cub::DoubleBuffer<unsigned> kb(k0, k1);
  cub::DoubleBuffer<int> vb(d, e);
  TEST(cub::DeviceRadixSort::SortPairs(NULL, bytes, kb, vb, 4, 0, 4, stream) == cudaSuccess &&
           cudaMalloc(&temp, bytes) == cudaSuccess,
       "work space");
  TEST(cub::DeviceRadixSort::SortPairs(temp, bytes, kb, vb, 4, 0, 4, stream) == cudaSuccess &&
           cudaStreamSynchronize(stream) == cudaSuccess,
       "sort");
  TEST(cudaMemcpy(got, kb.Current(), sizeof(got), cudaMemcpyDeviceToHost) == cudaSuccess &&
           cudaMemcpy(from, vb.Current(), sizeof(from), cudaMemcpyDeviceToHost) == cudaSuccess,
       "copy");
  TEST(got[0] == 0x21 && got[1] == 0x11 && got[2] == 0x13 && got[3] == 0x03 && from[0] == 1 && from[1] == 2 && from[2] == 0 &&
           from[3] == 3,
       "sorted to %x %x %x %x", got[0], got[1], got[2], got[3]);

  cudaShimFailCall(1, cudaErrorLaunchFailure);
  TEST(cudaStreamSynchronize(stream) == cudaSuccess && cudaStreamSynchronize(stream) == cudaErrorLaunchFailure &&
           cudaStreamSynchronize(stream) == cudaErrorLaunchFailure,
       "a failure does not last");
  cudaShimFailCall(-1, 0);
  cudaShimSetMemory(1000);
  TEST(cudaMalloc((void **)&e, 2000) == cudaErrorMemoryAllocation, "memory without limit");
  return test_report();
}
