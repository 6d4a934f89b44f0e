/* bench_ceiling.cu - what the device can do: bytes/s of a copy and FLOP/s of independent fused multiply-adds, float and double.
 */
#include <cuda_runtime.h>
#include <cstdio>

static __global__ void CopyKernel(const float4 *__restrict__ a, float4 *b, size_t n)
{
  for (size_t i = blockIdx.x * (size_t)blockDim.x + threadIdx.x; i < n; i += (size_t)gridDim.x * blockDim.x) b[i] = a[i];
}

/* 8 chains of multiply-adds; the result is stored only if it is impossible, so that nothing is optimised away. */
template <typename T> static __global__ void MultiplyAddKernel(T *out, int rounds, T c)
{
  T x[8];
  for (int k = 0; k < 8; k++) x[k] = (T)(threadIdx.x + k);
  for (int r = 0; r < rounds; r++)
#pragma unroll
    for (int k = 0; k < 8; k++) x[k] = x[k] * c + (T)1e-7;
  T s = 0;
  for (int k = 0; k < 8; k++) s += x[k];
  if (s == (T)-1) out[threadIdx.x] = s;
}

static const char *failed = NULL;

static void Check(cudaError_t err, const char *call)
{
  if (err != cudaSuccess && !failed) {
    failed = call;
    fprintf(stderr, "CUDA error %s in %s\n", cudaGetErrorString(err), call);
  }
}
#define CHECK(call) Check(call, #call)

/* Fastest of five launches, s. */
template <class Launch> static double Best(Launch launch)
{
  cudaEvent_t t0, t1;
  float best = 1e30f, ms = 0.0f;

  CHECK(cudaEventCreate(&t0));
  CHECK(cudaEventCreate(&t1));
  for (int k = 0; k < 6 && !failed; k++) { /* the first one warms up */
    CHECK(cudaEventRecord(t0));
    launch();
    CHECK(cudaGetLastError());
    CHECK(cudaEventRecord(t1));
    CHECK(cudaEventSynchronize(t1));
    CHECK(cudaEventElapsedTime(&ms, t0, t1));
    if (k && ms < best) best = ms;
  }
  CHECK(cudaEventDestroy(t0));
  CHECK(cudaEventDestroy(t1));
  return 1e-3 * (double)best;
}

/* name (256 characters) of the device; bytes/s; FLOP/s in single and double precision. 0 when all went well. */
extern "C" int BenchCeiling(char *name, double *bytes, double *single, double *twice)
{
  const size_t n = (size_t)1 << 24; /* 256 MiB, beyond every cache */
  const int rounds = 4096;
  cudaDeviceProp prop;
  void *a = NULL, *b = NULL;

  CHECK(cudaGetDeviceProperties(&prop, 0));
  if (failed) return 1;
  (void)snprintf(name, 256, "%s, compute capability %d.%d, %d multiprocessors", prop.name, prop.major, prop.minor,
                 prop.multiProcessorCount);
  const int blocks = prop.multiProcessorCount * 16;
  CHECK(cudaMalloc(&a, n * sizeof(float4)));
  CHECK(cudaMalloc(&b, n * sizeof(float4)));
  if (failed) return 1;
  CHECK(cudaMemset(a, 0, n * sizeof(float4)));
  *bytes = 2.0 * (double)(n * sizeof(float4)) / Best([&]() { CopyKernel<<<blocks, 256>>>((const float4 *)a, (float4 *)b, n); });
  *single =
      16.0 * rounds * 256.0 * blocks / Best([&]() { MultiplyAddKernel<float><<<blocks, 256>>>((float *)a, rounds, 0.999f); });
  *twice =
      16.0 * rounds * 256.0 * blocks / Best([&]() { MultiplyAddKernel<double><<<blocks, 256>>>((double *)a, rounds, 0.999); });
  CHECK(cudaFree(a));
  CHECK(cudaFree(b));
  return failed ? 1 : 0;
}
