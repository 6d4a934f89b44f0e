/* cuda_shim.h - what a test can ask of the stand-in for the CUDA runtime. */
#ifndef CUDA_SHIM_H
#define CUDA_SHIM_H

#include <stddef.h>

#if defined(__cplusplus)
extern "C" {
#endif

/* Order of the threads of a grid and of the terms of a reduction: 0 ascending, 1 descending, 2 interleaved. */
void cudaShimSetOrder(int order);
/* 1: work of a stream runs when it is enqueued; 0 (default): when a call waits for it. */
void cudaShimSetEager(int eager);
/* Device memory in bytes (default 1 GiB). */
void cudaShimSetMemory(size_t bytes);
void cudaShimSetDeviceCount(int n);
/* The call after `calls` more of them fails with the error, and every one after it; calls < 0 ends the failure. */
void cudaShimFailCall(long calls, int error);
/* Allocations that were not freed; calls of cudaMalloc, API calls and launches so far; bytes in allocations, largest so far;
 * bytes copied to the device and from it so far. */
typedef struct {
  long live, mallocs, calls, launches;
  size_t bytes, peak, todevice, fromdevice;
} CudaShimCounts;
CudaShimCounts cudaShimGetCounts(void);
/* Some device address, to show that the host cannot read it. */
const void *cudaShimSomeDeviceAddress(void);

#if defined(__cplusplus)
}
#endif

#endif
