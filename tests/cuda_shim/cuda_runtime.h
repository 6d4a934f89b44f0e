/*
  cuda_runtime.h - test-only stand-in for the CUDA runtime: runs the kernels of the CUDA backend on the host, one thread after
  another.

  What it checks that a plain CPU build cannot: launch geometry and index arithmetic (AddressSanitizer, guard zones around every
  device allocation), address spaces (device memory is inaccessible to host code, copies are checked for direction and bounds),
  missing synchronisation (work of a stream runs as late as the rules allow), dependence on the order of threads
  (cudaShimSetOrder()), and the reaction to errors (cudaShimFailCall(), cudaShimSetMemory(), cudaShimSetDeviceCount()). Kernels
  may use neither shared memory nor barriers. It models no timing.
*/
#ifndef CUDA_SHIM_RUNTIME_H
#define CUDA_SHIM_RUNTIME_H

#include <cmath>
#include <cstddef>
#include <functional>
#include <tuple>
#include "cuda_shim.h"

#define __global__
#define __device__
#define __host__
#define __forceinline__ inline __attribute__((always_inline))
#define __launch_bounds__(...)

typedef enum {
  cudaSuccess = 0,
  cudaErrorInvalidValue = 1,
  cudaErrorMemoryAllocation = 2,
  cudaErrorInsufficientDriver = 35,
  cudaErrorDevicesUnavailable = 46,
  cudaErrorNoDevice = 100,
  cudaErrorInvalidDevice = 101,
  cudaErrorECCUncorrectable = 214,
  cudaErrorNvlinkUncorrectable = 220,
  cudaErrorIllegalAddress = 700,
  cudaErrorHardwareStackError = 714,
  cudaErrorLaunchFailure = 719,
  cudaErrorSystemDriverMismatch = 803
} cudaError_t;

typedef enum { cudaMemcpyHostToHost, cudaMemcpyHostToDevice, cudaMemcpyDeviceToHost, cudaMemcpyDeviceToDevice } cudaMemcpyKind;
enum { cudaStreamNonBlocking = 1, cudaEventDisableTiming = 2 };

typedef struct CudaShimStream *cudaStream_t;
typedef struct CudaShimEvent *cudaEvent_t;

struct dim3 {
  unsigned x, y, z;
  dim3(unsigned x_ = 1, unsigned y_ = 1, unsigned z_ = 1) : x(x_), y(y_), z(z_)
  {
  }
};

typedef struct {
  dim3 gridDim, blockDim;
  size_t dynamicSmemBytes;
  cudaStream_t stream;
} cudaLaunchConfig_t;

extern dim3 threadIdx, blockIdx, blockDim, gridDim;

const char *cudaGetErrorName(cudaError_t err);
const char *cudaGetErrorString(cudaError_t err);
cudaError_t cudaGetLastError(void);
cudaError_t cudaGetDeviceCount(int *n);
cudaError_t cudaMemGetInfo(size_t *free, size_t *total);
cudaError_t cudaMalloc(void **p, size_t bytes);
cudaError_t cudaFree(void *p);
cudaError_t cudaMallocHost(void **p, size_t bytes);
cudaError_t cudaFreeHost(void *p);
cudaError_t cudaMemcpy(void *dst, const void *src, size_t bytes, cudaMemcpyKind kind);
cudaError_t cudaMemcpyAsync(void *dst, const void *src, size_t bytes, cudaMemcpyKind kind, cudaStream_t stream);
cudaError_t cudaMemsetAsync(void *dst, int value, size_t bytes, cudaStream_t stream);
cudaError_t cudaStreamCreateWithFlags(cudaStream_t *stream, unsigned flags);
cudaError_t cudaStreamSynchronize(cudaStream_t stream);
cudaError_t cudaStreamDestroy(cudaStream_t stream);
cudaError_t cudaEventCreateWithFlags(cudaEvent_t *event, unsigned flags);
cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream);
cudaError_t cudaEventSynchronize(cudaEvent_t event);
cudaError_t cudaEventDestroy(cudaEvent_t event);

/* Append work to a stream; device memory is accessible while it runs. */
cudaError_t cudaShimEnqueue(cudaStream_t stream, std::function<void()> work);
/* The same for a kernel: `thread` is called once per thread of the grid. */
cudaError_t cudaShimEnqueueGrid(const cudaLaunchConfig_t &config, std::function<void()> thread);
int cudaShimOrder(void);

template <typename... P, typename... A>
static inline cudaError_t cudaLaunchKernelEx(const cudaLaunchConfig_t *config, void (*kernel)(P...), A &&...args)
{
  std::tuple<P...> copy(static_cast<P>(args)...); /* arguments are taken at the time of the launch */

  return cudaShimEnqueueGrid(*config, [kernel, copy]() { std::apply(kernel, copy); });
}

#endif
