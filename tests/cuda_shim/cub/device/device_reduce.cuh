/* device_reduce.cuh - test-only stand-in for cub::DeviceReduce::Reduce. */
#ifndef CUDA_SHIM_REDUCE
#define CUDA_SHIM_REDUCE

#include <cstring>
#include "../../cuda_runtime.h"

namespace cub
{
struct DeviceReduce {
  template <class In, class T, class Op>
  static cudaError_t Reduce(void *temp, size_t &bytes, In in, T *out, int n, Op op, T init, cudaStream_t stream = 0)
  {
    const size_t need = 256 + sizeof(T) * ((size_t)n / 4096 + 1);

    if (!temp) {
      bytes = need;
      return cudaSuccess;
    }
    if (bytes < need) return cudaErrorInvalidValue;
    return cudaShimEnqueue(stream, [=]() {
      T acc = init;
      memset(temp, 0xee, need);
      if (cudaShimOrder())
        for (int i = n; i-- > 0;) acc = op(in[i], acc);
      else
        for (int i = 0; i < n; i++) acc = op(acc, in[i]);
      *out = acc;
    });
  }
};
} // namespace cub

#endif
