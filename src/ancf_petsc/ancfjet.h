/* ancfjet.h - private: values with exact first and second derivatives in nine variables, for the rows of joints (forward mode).
 */
#ifndef ANCFJET_H
#define ANCFJET_H

#include <petscsys.h>

#define JET 9

typedef struct {
  PetscReal v, g[JET], h[JET][JET]; /* value, gradient, Hessian */
} Jet;

static inline Jet JetVariable(PetscReal v, int i)
{
  Jet r = {.v = v};

  r.g[i] = 1;
  return r;
}

static inline Jet JetSum(Jet a, PetscReal s, Jet b) /* a + s b */
{
  a.v += s * b.v;
  for (int i = 0; i < JET; i++) {
    a.g[i] += s * b.g[i];
    for (int j = 0; j < JET; j++) a.h[i][j] += s * b.h[i][j];
  }
  return a;
}

static inline Jet JetScale(PetscReal s, Jet a)
{
  return JetSum((Jet){0}, s, a);
}

static inline Jet JetProduct(const Jet *a, const Jet *b)
{
  Jet r = {.v = a->v * b->v};

  for (int i = 0; i < JET; i++) {
    r.g[i] = a->v * b->g[i] + b->v * a->g[i];
    for (int j = 0; j < JET; j++) r.h[i][j] = a->v * b->h[i][j] + b->v * a->h[i][j] + a->g[i] * b->g[j] + a->g[j] * b->g[i];
  }
  return r;
}

/* f(a) with f = f0, f' = f1, f'' = f2 at a. */
static inline Jet JetChain(const Jet *a, PetscReal f0, PetscReal f1, PetscReal f2)
{
  Jet r = {.v = f0};

  for (int i = 0; i < JET; i++) {
    r.g[i] = f1 * a->g[i];
    for (int j = 0; j < JET; j++) r.h[i][j] = f1 * a->h[i][j] + f2 * a->g[i] * a->g[j];
  }
  return r;
}

static inline Jet JetDot(const Jet a[3], const Jet b[3])
{
  Jet r = JetProduct(&a[0], &b[0]);

  for (int c = 1; c < 3; c++) r = JetSum(r, 1, JetProduct(&a[c], &b[c]));
  return r;
}

/* t = a/|a| */
static inline void JetUnit(const Jet a[3], Jet t[3])
{
  const Jet q = JetDot(a, a);
  const PetscReal s = 1 / PetscSqrtReal(q.v);
  const Jet r = JetChain(&q, s, -0.5 * s / q.v, 0.75 * s / (q.v * q.v));

  for (int c = 0; c < 3; c++) t[c] = JetProduct(&r, &a[c]);
}

/* r = a x b */
static inline void JetCross(const Jet a[3], const Jet b[3], Jet r[3])
{
  for (int c = 0; c < 3; c++)
    r[c] = JetSum(JetProduct(&a[(c + 1) % 3], &b[(c + 2) % 3]), -1, JetProduct(&a[(c + 2) % 3], &b[(c + 1) % 3]));
}

#endif
