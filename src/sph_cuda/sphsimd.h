/*
  sphsimd.h - selecting the neighbours of a group of markers: the loops that compilers do not vectorise by themselves.

  Markers come in batches of up to SPH_BATCH consecutive ones of one cell, with a bounding box each. SphNear lists the batches
  whose boxes lie within 2h of the group's box; SphSelect appends to the list those markers of one batch that do, with their nq
  quantities, in increasing order, and returns the new length. Entries up to SPH_BATCH behind the end may be overwritten.
*/
#ifndef SPHSIMD_H
#define SPHSIMD_H

#include "sph_cpu.h"

/* Bounding box of a group, m. */
typedef struct {
  sphreal lo[3], hi[3];
} SphBox;

/* The batches around one cell, in its frame; fluid ones first. */
typedef struct {
  sphreal *lo[3], *hi[3]; /* bounding boxes, m; readable up to a multiple of SPH_BATCH */
  sphreal *off[3];        /* shift of the batch's own cell frame, m */
  int *first, *count;     /* markers */
  int *near;              /* room for the numbers of all batches and SPH_BATCH more */
  int n, nfluid;
} SphBatches;

#if defined(SPH_PAIRS_single) && defined(__AVX512F__)
  #include <immintrin.h>

/* Squared distance from an interval [lo,hi] on each axis to the group's: two boxes, or box and point when lo = hi. */
static inline __m512 sph_gap2(__m512 lo, __m512 hi, sphreal glo, sphreal ghi, __m512 sum)
{
  const __m512 d = _mm512_max_ps(_mm512_max_ps(_mm512_sub_ps(lo, _mm512_set1_ps(ghi)), _mm512_sub_ps(_mm512_set1_ps(glo), hi)),
                                 _mm512_setzero_ps());
  return _mm512_fmadd_ps(d, d, sum);
}

SPH_INLINE int SphNear(const SphBatches *b, int n, const SphBox *g, sphreal r2max)
{
  __m512i number = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  int m = 0;
  for (int k = 0; k < n; k += 16, number = _mm512_add_epi32(number, _mm512_set1_epi32(16))) {
    const __mmask16 live = n - k >= 16 ? (__mmask16)0xffff : (__mmask16)((1u << (n - k)) - 1u);
    __m512 r2 = _mm512_setzero_ps();
    for (int d = 0; d < 3; d++)
      r2 = sph_gap2(_mm512_loadu_ps(b->lo[d] + k), _mm512_loadu_ps(b->hi[d] + k), g->lo[d], g->hi[d], r2);
    const __mmask16 in = _mm512_mask_cmp_ps_mask(live, r2, _mm512_set1_ps(r2max), _CMP_LT_OQ);
    _mm512_storeu_si512(b->near + m, _mm512_maskz_compress_epi32(in, number));
    m += __builtin_popcount(in);
  }
  return m;
}

SPH_INLINE int SphSelect(const int nq, sphreal *const *src, int first, int n, const sphreal off[3], const SphBox *g,
                         sphreal r2max, sphreal *const *list, int m)
{
  const __mmask16 live = (__mmask16)((1u << n) - 1u);
  __m512 x[3], r2 = _mm512_setzero_ps();
  for (int d = 0; d < 3; d++) {
    x[d] = _mm512_add_ps(_mm512_maskz_loadu_ps(live, src[d] + first), _mm512_set1_ps(off[d]));
    r2 = sph_gap2(x[d], x[d], g->lo[d], g->hi[d], r2);
  }
  const __mmask16 in = _mm512_mask_cmp_ps_mask(live, r2, _mm512_set1_ps(r2max), _CMP_LT_OQ);
  for (int d = 0; d < 3; d++) _mm512_storeu_ps(list[d] + m, _mm512_maskz_compress_ps(in, x[d]));
  #pragma GCC unroll 16
  for (int q = 3; q < nq; q++)
    _mm512_storeu_ps(list[q] + m, _mm512_maskz_compress_ps(in, _mm512_maskz_loadu_ps(live, src[q] + first)));
  return m + __builtin_popcount(in);
}

#else

SPH_INLINE sphreal sph_gap2(sphreal lo, sphreal hi, sphreal glo, sphreal ghi)
{
  const sphreal a = lo - ghi, b = glo - hi, c = a > b ? a : b, d = c > (sphreal)0 ? c : (sphreal)0;
  return d * d;
}

SPH_INLINE int SphNear(const SphBatches *b, int n, const SphBox *g, sphreal r2max)
{
  int m = 0;
  for (int k = 0; k < n; k++) {
    sphreal r2 = 0;
    for (int d = 0; d < 3; d++) r2 += sph_gap2(b->lo[d][k], b->hi[d][k], g->lo[d], g->hi[d]);
    b->near[m] = k;
    m += r2 < r2max;
  }
  return m;
}

SPH_INLINE int SphSelect(const int nq, sphreal *const *src, int first, int n, const sphreal off[3], const SphBox *g,
                         sphreal r2max, sphreal *const *list, int m)
{
  int in[SPH_BATCH], found = 0;
  for (int k = 0; k < n; k++) {
    sphreal r2 = 0;
    for (int d = 0; d < 3; d++) {
      const sphreal x = src[d][first + k] + off[d];
      r2 += sph_gap2(x, x, g->lo[d], g->hi[d]);
    }
    in[found] = first + k;
    found += r2 < r2max;
  }
  for (int q = 0; q < nq; q++) {
    const sphreal add = q < 3 ? off[q] : (sphreal)0;
    for (int k = 0; k < found; k++)
      list[q][m + k] = src[q][in[k]] + add; /* NOLINT(clang-analyzer-core.uninitialized.ArraySubscript): found <= n */
  }
  return m + found;
}

#endif

/* Append markers far outside every support, without mass, up to a multiple of 16, so that loops over the list have no remainder.
 */
SPH_INLINE int SphPad(const int nq, sphreal far, sphreal *const *list, int m)
{
  const int end = (m + 15) & ~15;
  for (int q = 0; q < nq; q++)
    for (int k = m; k < end; k++) list[q][k] = q < 3 ? far : (sphreal)0;
  return end;
}

#endif
