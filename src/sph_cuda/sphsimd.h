/*
  sphsimd.h - the one loop that compilers do not vectorise by themselves: selecting the neighbours of a marker.

  SphFilter writes the indices k < n with |x_k - x|^2 < r2max, in increasing order, and returns their number. idx must have
  room for n + 16 entries.
*/
#ifndef SPHSIMD_H
#define SPHSIMD_H

#if defined(__AVX512F__)
  #include <immintrin.h>

static inline int sph_filter_float(const float *x, const float *y, const float *z, int n, float xi, float yi, float zi, float r2max, int *idx)
{
  const __m512 X = _mm512_set1_ps(xi), Y = _mm512_set1_ps(yi), Z = _mm512_set1_ps(zi), R = _mm512_set1_ps(r2max);
  const __m512i step = _mm512_set1_epi32(16);
  __m512i       k = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  int           m = 0;
  for (int b = 0; b < n; b += 16, k = _mm512_add_epi32(k, step)) {
    const __mmask16 live = n - b >= 16 ? (__mmask16)0xffff : (__mmask16)((1u << (n - b)) - 1u);
    const __m512    dx = _mm512_sub_ps(X, _mm512_maskz_loadu_ps(live, x + b)), dy = _mm512_sub_ps(Y, _mm512_maskz_loadu_ps(live, y + b)), dz = _mm512_sub_ps(Z, _mm512_maskz_loadu_ps(live, z + b));
    const __m512    r2 = _mm512_fmadd_ps(dx, dx, _mm512_fmadd_ps(dy, dy, _mm512_mul_ps(dz, dz)));
    const __mmask16 in = _mm512_mask_cmp_ps_mask(live, r2, R, _CMP_LT_OQ);
    _mm512_storeu_si512(idx + m, _mm512_maskz_compress_epi32(in, k));
    m += __builtin_popcount(in);
  }
  return m;
}
  #define SPH_HAVE_FILTER_FLOAT
#endif

#define SPH_FILTER_SCALAR(name, real) \
  static inline int name(const real *x, const real *y, const real *z, int n, real xi, real yi, real zi, real r2max, int *idx) \
  { \
    int m = 0; \
    for (int k = 0; k < n; k++) { \
      const real dx = xi - x[k], dy = yi - y[k], dz = zi - z[k]; \
      idx[m] = k; \
      m += dx * dx + dy * dy + dz * dz < r2max; \
    } \
    return m; \
  }

#endif
