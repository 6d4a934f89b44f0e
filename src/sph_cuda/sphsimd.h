/*
  sphsimd.h - selecting the neighbours of a group of markers: the one loop that compilers do not vectorise by themselves.

  SphSelect appends to the list the markers k < n of one cell that lie within 2h of the group's bounding box, with their
  nq quantities, in increasing order, and returns the new length. Position of marker k in the frame of the group: src[0..2][k] +
  off. Entries up to 16 behind the end may be overwritten. scratch: n + 16 indices.
*/
#ifndef SPHSIMD_H
#define SPHSIMD_H

/* Bounding box of a group: centre and half extents, m. */
typedef struct {
  sphreal c[3], e[3];
} SphBox;

#if defined(SPH_PAIRS_single) && defined(__AVX512F__)
  #include <immintrin.h>

static inline __m512 sph_boxgap(__m512 x, sphreal c, sphreal e)
{
  return _mm512_max_ps(_mm512_sub_ps(_mm512_abs_ps(_mm512_sub_ps(x, _mm512_set1_ps(c))), _mm512_set1_ps(e)), _mm512_setzero_ps());
}

SPH_INLINE int SphSelect(const int nq, const sphreal *const *src, const sphreal off[3], int n, const SphBox *box, sphreal r2max,
                         sphreal *const *list, int m, int *scratch)
{
  const SphBox b = {{box->c[0] - off[0], box->c[1] - off[1], box->c[2] - off[2]}, {box->e[0], box->e[1], box->e[2]}};
  (void)scratch;
  for (int k = 0; k < n; k += 16) {
    const __mmask16 live = n - k >= 16 ? (__mmask16)0xffff : (__mmask16)((1u << (n - k)) - 1u);
    const __m512 x = _mm512_maskz_loadu_ps(live, src[0] + k), y = _mm512_maskz_loadu_ps(live, src[1] + k),
                 z = _mm512_maskz_loadu_ps(live, src[2] + k);
    const __m512 dx = sph_boxgap(x, b.c[0], b.e[0]), dy = sph_boxgap(y, b.c[1], b.e[1]), dz = sph_boxgap(z, b.c[2], b.e[2]);
    const __m512 r2 = _mm512_fmadd_ps(dx, dx, _mm512_fmadd_ps(dy, dy, _mm512_mul_ps(dz, dz)));
    const __mmask16 in = _mm512_mask_cmp_ps_mask(live, r2, _mm512_set1_ps(r2max), _CMP_LT_OQ);
    if (!in) continue;
    _mm512_storeu_ps(list[0] + m, _mm512_maskz_compress_ps(in, _mm512_add_ps(x, _mm512_set1_ps(off[0]))));
    _mm512_storeu_ps(list[1] + m, _mm512_maskz_compress_ps(in, _mm512_add_ps(y, _mm512_set1_ps(off[1]))));
    _mm512_storeu_ps(list[2] + m, _mm512_maskz_compress_ps(in, _mm512_add_ps(z, _mm512_set1_ps(off[2]))));
  #pragma GCC unroll 16
    for (int q = 3; q < nq; q++)
      _mm512_storeu_ps(list[q] + m, _mm512_maskz_compress_ps(in, _mm512_maskz_loadu_ps(live, src[q] + k)));
    m += __builtin_popcount(in);
  }
  return m;
}

#else

SPH_INLINE sphreal sph_boxgap(sphreal x, sphreal c, sphreal e)
{
  const sphreal d = (x > c ? x - c : c - x) - e;
  return d > (sphreal)0 ? d : (sphreal)0;
}

SPH_INLINE int SphSelect(const int nq, const sphreal *const *src, const sphreal off[3], int n, const SphBox *box, sphreal r2max,
                         sphreal *const *list, int m, int *scratch)
{
  int found = 0;
  for (int k = 0; k < n; k++) {
    const sphreal dx = sph_boxgap(src[0][k], box->c[0] - off[0], box->e[0]),
                  dy = sph_boxgap(src[1][k], box->c[1] - off[1], box->e[1]),
                  dz = sph_boxgap(src[2][k], box->c[2] - off[2], box->e[2]);
    scratch[found] = k;
    found += dx * dx + dy * dy + dz * dz < r2max;
  }
  for (int q = 0; q < nq; q++) {
    const sphreal add = q < 3 ? off[q] : (sphreal)0;
    for (int k = 0; k < found; k++) list[q][m + k] = src[q][scratch[k]] + add;
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
