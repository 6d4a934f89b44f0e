/* ancfbatch.h - private: elements of a batch into vector lanes. */
#ifndef ANCFBATCH_H
#define ANCFBATCH_H

#include "ancfimpl.h"
#include "lanes.h"

/* Coordinates x of a node as the beams see them: eliminated ones are replaced by fix (NULL: zero). */
static inline void AncfGather(const Ancf ancf, const AncfBatch *b, const PetscReal *x, PetscInt stride, const PetscReal *fix,
                              AncfLanes out[12])
{
  for (int i = 0; i < ANCF_LANES; i++) {
    for (int side = 0; side < 2; side++) {
      PetscInt j = b->node[i] + side;
      const PetscReal *xj = x + j * stride;
      unsigned char f = ancf->fixed[j];

      for (int c = 0; c < 6; c++) out[6 * side + c][i] = xj[c];
      if (PetscUnlikely(f)) {
        for (int c = f & ANCF_FIX_POSITION ? 0 : 3; c < (f & ANCF_FIX_GRADIENT ? 6 : 3); c++)
          out[6 * side + c][i] = fix ? fix[6 * j + c] : 0;
      }
    }
  }
}

static inline AncfLanes AncfLoad(const PetscReal x[ANCF_LANES])
{
  AncfLanes v;

  for (int i = 0; i < ANCF_LANES; i++) v[i] = x[i];
  return v;
}

static inline AncfSection AncfBatchSection(const AncfBatch *b)
{
  return (AncfSection){AncfLoad(b->EA), AncfLoad(b->EI), AncfLoad(b->l)};
}

/* Clears rows and columns of eliminated coordinates of one lane's 12 x 12 row-major matrix. */
static inline void AncfClearFixed(const Ancf ancf, const AncfBatch *b, PetscInt lane, PetscReal k[144])
{
  for (int side = 0; side < 2; side++) {
    unsigned char fix = ancf->fixed[b->node[lane] + side];

    if (PetscLikely(!fix)) continue;
    for (int c = 0; c < 6; c++) {
      if (!(fix & (c < 3 ? ANCF_FIX_POSITION : ANCF_FIX_GRADIENT))) continue;
      for (int j = 0; j < 12; j++) k[12 * (6 * side + c) + j] = k[12 * j + 6 * side + c] = 0;
    }
  }
}

/* Node k of each lane's beam; lanes past their end stay as they are. */
static inline void AncfGatherLane(const Ancf ancf, const AncfLaneBeams *b, PetscInt k, const PetscReal *x, PetscInt stride,
                                  const PetscReal *fix, AncfLanes out[6])
{
  static const PetscReal zero[6] = {0};
  const PetscBool full = k <= b->least ? PETSC_TRUE : PETSC_FALSE;

  if (PetscLikely(full)) { /* no branch between the lanes; what is clamped is read elsewhere */
    const PetscReal *p[ANCF_LANES];
    PetscBool part = PETSC_FALSE;

    for (int i = 0; i < ANCF_LANES; i++) {
      const PetscInt j = b->first[i] + k;
      const unsigned char f = ancf->fixed[j] & (ANCF_FIX_POSITION | ANCF_FIX_GRADIENT);

      p[i] = PetscLikely(!f) ? x + j * stride : fix ? fix + 6 * j : zero;
      if (f && f != (ANCF_FIX_POSITION | ANCF_FIX_GRADIENT)) part = PETSC_TRUE;
    }
    if (PetscLikely(!part)) {
      LanesGather(6, p, out);
      return;
    }
  }
  for (int i = 0; i < ANCF_LANES; i++) {
    const PetscInt j = b->first[i] + k;
    unsigned char f;

    if (k > b->elements[i]) continue;
    f = ancf->fixed[j];
    for (int c = 0; c < 6; c++) out[c][i] = x[j * stride + c];
    for (int c = f & ANCF_FIX_POSITION ? 0 : 3; c < (f & ANCF_FIX_GRADIENT ? 6 : 3); c++) out[c][i] = fix ? fix[6 * j + c] : 0;
  }
}

/* Adds Q to node k of each lane's beam; lanes past their end add nothing. */
static inline void AncfScatterLane(const AncfLaneBeams *b, PetscInt k, const AncfLanes Q[6], PetscReal *f, PetscInt stride)
{
  if (PetscLikely(k <= b->least)) {
    PetscReal *p[ANCF_LANES];

    for (int i = 0; i < ANCF_LANES; i++) p[i] = f + (b->first[i] + k) * stride;
    LanesScatter(6, Q, p, 1);
    return;
  }
  for (int i = 0; i < ANCF_LANES; i++)
    if (k <= b->elements[i])
      for (int c = 0; c < 6; c++) f[(b->first[i] + k) * stride + c] += Q[c][i];
}

/* Lanes without an element k: no stiffness, no mass, and a straight element of unit length, so that nothing divides by zero. */
static inline void AncfIdleLane(int i, AncfSection *s, AncfLanes *mass, AncfLanes e[12])
{
  s->EA[i] = s->EI[i] = (*mass)[i] = 0;
  s->l[i] = 1;
  for (int c = 0; c < 12; c++) e[c][i] = c == 3 || c == 6 || c == 9;
}

#endif
