/* ancfpoint.h - private: vectors in lanes, and how what happens at a Gauss point becomes forces and tangents of an element. */
#ifndef ANCFPOINT_H
#define ANCFPOINT_H

#include "ancfelement.h"

static inline AncfLanes LanesSqrt(AncfLanes a)
{
  for (int i = 0; i < ANCF_LANES; i++) a[i] = PetscSqrtReal(a[i]);
  return a;
}

static inline AncfLanes Dot(const AncfLanes a[3], const AncfLanes b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void Cross(const AncfLanes a[3], const AncfLanes b[3], AncfLanes c[3])
{
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

/* Scaled coordinates d[0..2] = l r_0,x, r_1 - r_0, l r_1,x: the position vector's derivatives need only these. */
static inline void Scaled(const AncfLanes e[12], AncfLanes l, AncfLanes d[3][3])
{
  for (int c = 0; c < 3; c++) {
    d[0][c] = l * e[3 + c];
    d[1][c] = e[6 + c] - e[c];
    d[2][c] = l * e[9 + c];
  }
}

/* r' or r'' from table row s; scale is 1/l or 1/l^2. */
static inline void Derivative(AncfLanes d[3][3], const PetscReal s[3], AncfLanes scale, AncfLanes r[3])
{
  for (int c = 0; c < 3; c++) r[c] = (s[0] * d[0][c] + s[1] * d[1][c] + s[2] * d[2][c]) * scale;
}

/* Generalised force from the derivatives q of the energy by the three scaled coordinates. */
static inline void ForceExpand(AncfLanes q[3][3], AncfLanes l, AncfLanes Q[12])
{
  for (int c = 0; c < 3; c++) {
    Q[c] = -q[1][c];
    Q[3 + c] = l * q[0][c];
    Q[6 + c] = q[1][c];
    Q[9 + c] = l * q[2][c];
  }
}

/* Adds what is conjugate to r' and r'' at point k, f1 and f2 (per length), with weight w: q += S'_i w f1 + S''_i w f2/l. */
static inline void PointForce(const AncfGauss *g, PetscInt k, AncfLanes il, const AncfLanes f1[3], const AncfLanes f2[3],
                              AncfLanes q[3][3])
{
  for (int i = 0; i < 3; i++)
    for (int c = 0; c < 3; c++) q[i][c] += g->w[k] * (f2 ? g->s1[k][i] * f1[c] + g->s2[k][i] * il * f2[c] : g->s1[k][i] * f1[c]);
}

/* The same for the derivatives of f by one direction of r' (dir = 0..2) or r'' (3..5): a column of the 9 x 9 tangent H by scaled
   coordinates. */
static inline void PointTangent(const AncfGauss *g, PetscInt k, AncfLanes il, int dir, const AncfLanes f1[3],
                                const AncfLanes f2[3], AncfLanes H[81])
{
  const PetscReal *column = dir < 3 ? g->s1[k] : g->s2[k];

  for (int j = 0; j < 3; j++) {
    const AncfLanes w = g->w[k] * column[j] * (dir < 3 ? il : il * il);

    for (int i = 0; i < 3; i++)
      for (int c = 0; c < 3; c++)
        H[9 * (3 * i + c) + 3 * j + dir % 3] += w * (f2 ? g->s1[k][i] * f1[c] + g->s2[k][i] * il * f2[c] : g->s1[k][i] * f1[c]);
  }
}

#endif
