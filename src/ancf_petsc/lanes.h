/* lanes.h - private: rows of numbers in memory, one row per vector lane, and back. */
#ifndef LANES_H
#define LANES_H

#include <petscsys.h>

typedef PetscReal RealLanes __attribute__((vector_size(8 * sizeof(PetscReal))));
typedef PetscReal RealQuad __attribute__((vector_size(4 * sizeof(PetscReal))));
typedef PetscReal RealPair __attribute__((vector_size(2 * sizeof(PetscReal)), aligned(sizeof(PetscReal)), may_alias));

#if defined(__has_builtin)
  #if __has_builtin(__builtin_shufflevector)
    #define LANES_SHUFFLE __builtin_shufflevector
  #endif
#endif

#define LANES_INLINE static inline __attribute__((always_inline))

/* y[c] = p[0][c], p[1][c], ... for c < n. */
LANES_INLINE void LanesGather(const int n, const PetscReal *const p[8], RealLanes *y)
{
  int c = 0;
#if defined(LANES_SHUFFLE) /* two numbers of a row at a time */
  _Pragma("GCC unroll 6") for (; c + 1 < n; c += 2)
  {
    RealPair q[8];
    RealLanes even, odd;

    for (int i = 0; i < 8; i++) q[i] = *(const RealPair *)(p[i] + c);
    even = LANES_SHUFFLE(LANES_SHUFFLE(q[0], q[2], 0, 1, 2, 3), LANES_SHUFFLE(q[4], q[6], 0, 1, 2, 3), 0, 1, 2, 3, 4, 5, 6, 7);
    odd = LANES_SHUFFLE(LANES_SHUFFLE(q[1], q[3], 0, 1, 2, 3), LANES_SHUFFLE(q[5], q[7], 0, 1, 2, 3), 0, 1, 2, 3, 4, 5, 6, 7);
    y[c] = LANES_SHUFFLE(even, odd, 0, 8, 2, 10, 4, 12, 6, 14);
    y[c + 1] = LANES_SHUFFLE(even, odd, 1, 9, 3, 11, 5, 13, 7, 15);
  }
#endif
  for (; c < n; c++) y[c] = (RealLanes){p[0][c], p[1][c], p[2][c], p[3][c], p[4][c], p[5][c], p[6][c], p[7][c]};
}

LANES_INLINE void LanesPut(PetscReal *p, RealPair x, const int add)
{
  RealPair *q = (RealPair *)p;

  if (add) x += *q;
  *q = x;
}

/* p[i][c] (+)= y[c][i] for c < n. */
LANES_INLINE void LanesScatter(const int n, const RealLanes *y, PetscReal *const p[8], const int add)
{
  int c = 0;
#if defined(LANES_SHUFFLE)
  #define LANES_PUT(p, lanes, k) LanesPut((p) + c, (RealPair)LANES_SHUFFLE(lanes, lanes, k, (k) + 1), add)
  _Pragma("GCC unroll 6") for (; c + 1 < n; c += 2)
  {
    const RealLanes even = LANES_SHUFFLE(y[c], y[c + 1], 0, 8, 2, 10, 4, 12, 6, 14),
                    odd = LANES_SHUFFLE(y[c], y[c + 1], 1, 9, 3, 11, 5, 13, 7, 15);

    LANES_PUT(p[0], even, 0);
    LANES_PUT(p[2], even, 2);
    LANES_PUT(p[4], even, 4);
    LANES_PUT(p[6], even, 6);
    LANES_PUT(p[1], odd, 0);
    LANES_PUT(p[3], odd, 2);
    LANES_PUT(p[5], odd, 4);
    LANES_PUT(p[7], odd, 6);
  }
  #undef LANES_PUT
#endif
  for (; c < n; c++)
    for (int i = 0; i < 8; i++) p[i][c] = add ? p[i][c] + y[c][i] : y[c][i];
}

#endif
