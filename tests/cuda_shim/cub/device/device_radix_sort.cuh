/* device_radix_sort.cuh - test-only stand-in for cub::DeviceRadixSort::SortPairs with double buffers. */
#ifndef CUDA_SHIM_RADIX_SORT
#define CUDA_SHIM_RADIX_SORT

#include <algorithm>
#include <cstring>
#include <numeric>
#include <vector>
#include "../../cuda_runtime.h"

namespace cub
{
template <typename T> struct DoubleBuffer {
  T *d_buffers[2];
  int selector;

  DoubleBuffer(T *current, T *alternate) : d_buffers{current, alternate}, selector(0)
  {
  }
  T *Current() const
  {
    return d_buffers[selector];
  }
  T *Alternate() const
  {
    return d_buffers[selector ^ 1];
  }
};

struct DeviceRadixSort {
  /* Looks at the given bits of the keys only; what is left in the alternate buffers is garbage, as it may be with CUB. */
  template <typename K, typename V>
  static cudaError_t SortPairs(void *temp, size_t &bytes, DoubleBuffer<K> &key, DoubleBuffer<V> &value, int n, int begin, int end,
                               cudaStream_t stream = 0)
  {
    const size_t need = 1024;
    K *k0 = key.Current(), *k1 = key.Alternate();
    V *v0 = value.Current(), *v1 = value.Alternate();

    if (!temp) {
      bytes = need;
      return cudaSuccess;
    }
    if (bytes < need || begin < 0 || end > (int)(8 * sizeof(K)) || begin >= end) return cudaErrorInvalidValue;
    key.selector ^= 1;
    value.selector ^= 1;
    return cudaShimEnqueue(stream, [=]() {
      const unsigned long long mask = ((1ull << (end - begin)) - 1) << begin;
      std::vector<int> from((size_t)n);
      std::iota(from.begin(), from.end(), 0);
      std::stable_sort(from.begin(), from.end(), [&](int a, int b) { return (k0[a] & mask) < (k0[b] & mask); });
      for (int i = 0; i < n; i++) {
        k1[i] = k0[from[(size_t)i]];
        v1[i] = v0[from[(size_t)i]];
      }
      memset(temp, 0xee, need);
      memset(k0, 0xee, (size_t)n * sizeof(K));
      memset(v0, 0xee, (size_t)n * sizeof(V));
    });
  }
};
} // namespace cub

#endif
