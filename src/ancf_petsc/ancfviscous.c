/*
  ancfviscous.c - see ancfviscous.h.

  With a = r'.r', b = r'.r'', beta = b/a, gamma = r'.v'/a, v' and v'' the rates of r' and r'', and q = 2 (paper) or 1, the rate of
  the curvature vector, turned by 90 degrees about the tangent, is

    k* = a^(-q/2) h,   h = P (v'' - beta v' - q gamma r'') - (omega.r'/a) r' x r'',   P x = x - r' (r'.x)/a,

  from kappa = |r'| t x r''/|r'|^(q+1) and the rates of its factors. Half the bending power is EI tau a^-q h.h/2.
*/
#include "ancfviscous.h"
#include "ancfpoint.h"

typedef struct {
  AncfLanes r1[3], r2[3], v1[3], v2[3];
} Point;

static inline void PointAt(const AncfGauss *g, PetscInt k, AncfLanes il, AncfLanes d[3][3], AncfLanes dv[3][3], Point *p)
{
  Derivative(d, g->s1[k], il, p->r1);
  Derivative(d, g->s2[k], il * il, p->r2);
  Derivative(dv, g->s1[k], il, p->v1);
  Derivative(dv, g->s2[k], il * il, p->v2);
}

/* Axial: f1 = EA tau (deps/dt) deps/dr', and its change with the point. deps/dt = r'.v', or r'.v'/|r'|. */
static inline void AxialRate(AncfStrain strain, const Point *p, AncfLanes *rate, AncfLanes f1[3])
{
  const AncfLanes g = Dot(p->r1, p->v1);

  if (strain == ANCF_STRAIN_PAPER) {
    *rate = g;
    for (int c = 0; c < 3; c++) f1[c] = g * p->r1[c];
  } else {
    const AncfLanes a = Dot(p->r1, p->r1);

    *rate = g / LanesSqrt(a);
    for (int c = 0; c < 3; c++) f1[c] = g / a * p->r1[c];
  }
}

static inline void AxialChange(AncfStrain strain, const Point *p, const Point *dp, AncfLanes df1[3])
{
  const AncfLanes g = Dot(p->r1, p->v1), dg = Dot(dp->r1, p->v1) + Dot(p->r1, dp->v1);

  if (strain == ANCF_STRAIN_PAPER) {
    for (int c = 0; c < 3; c++) df1[c] = dg * p->r1[c] + g * dp->r1[c];
  } else {
    const AncfLanes a = Dot(p->r1, p->r1), da = 2.0 * Dot(p->r1, dp->r1);

    for (int c = 0; c < 3; c++) df1[c] = (dg - g * da / a) / a * p->r1[c] + g / a * dp->r1[c];
  }
}

/* What the force needs of a point. */
typedef struct {
  AncfLanes a, beta, gamma, y, z, w[3], x[3], h[3], m, s;
} Rate;

static inline void BendingRate(PetscReal q, const Point *p, const AncfLanes spin[3], Rate *t)
{
  t->a = Dot(p->r1, p->r1);
  t->beta = Dot(p->r1, p->r2) / t->a;
  t->gamma = Dot(p->r1, p->v1) / t->a;
  for (int c = 0; c < 3; c++) t->w[c] = p->v2[c] - t->beta * p->v1[c] - q * t->gamma * p->r2[c];
  t->y = Dot(p->r1, t->w) / t->a;
  t->z = Dot(spin, p->r1) / t->a;
  Cross(p->r1, p->r2, t->x);
  for (int c = 0; c < 3; c++) t->h[c] = t->w[c] - t->y * p->r1[c] - t->z * t->x[c];
  t->m = Dot(t->h, p->r2) / t->a;
  t->s = q > 1.5 ? 1.0 / (t->a * t->a) : 1.0 / t->a; /* a^-q */
}

/* f2 = a^-q h by v'', f1 = -a^-q (beta h + q m r') by v', m = h.r''/a. */
static inline void BendingForce(PetscReal q, const Point *p, const Rate *t, AncfLanes f1[3], AncfLanes f2[3])
{
  for (int c = 0; c < 3; c++) {
    f2[c] = t->s * t->h[c];
    f1[c] = -t->s * (t->beta * t->h[c] + q * t->m * p->r1[c]);
  }
}

/* The change of f1 and f2 along dp at fixed spin: every line of BendingRate() and BendingForce() differentiated. */
static inline void BendingChange(PetscReal q, const Point *p, const Rate *t, const AncfLanes spin[3], const Point *dp,
                                 AncfLanes df1[3], AncfLanes df2[3])
{
  const AncfLanes da = 2.0 * Dot(p->r1, dp->r1), ds = -q * t->s * da / t->a;
  const AncfLanes dbeta = (Dot(dp->r1, p->r2) + Dot(p->r1, dp->r2) - t->beta * da) / t->a;
  const AncfLanes dgamma = (Dot(dp->r1, p->v1) + Dot(p->r1, dp->v1) - t->gamma * da) / t->a;
  const AncfLanes dz = (Dot(spin, dp->r1) - t->z * da) / t->a;
  AncfLanes dw[3], dx[3], dx2[3], dh[3], dy, dm;

  for (int c = 0; c < 3; c++)
    dw[c] = dp->v2[c] - dbeta * p->v1[c] - t->beta * dp->v1[c] - q * (dgamma * p->r2[c] + t->gamma * dp->r2[c]);
  dy = (Dot(dp->r1, t->w) + Dot(p->r1, dw) - t->y * da) / t->a;
  Cross(dp->r1, p->r2, dx);
  Cross(p->r1, dp->r2, dx2);
  for (int c = 0; c < 3; c++) dh[c] = dw[c] - dy * p->r1[c] - t->y * dp->r1[c] - dz * t->x[c] - t->z * (dx[c] + dx2[c]);
  dm = (Dot(dh, p->r2) + Dot(t->h, dp->r2) - t->m * da) / t->a;
  for (int c = 0; c < 3; c++) {
    const AncfLanes F = t->beta * t->h[c] + q * t->m * p->r1[c];

    df2[c] = ds * t->h[c] + t->s * dh[c];
    df1[c] = -ds * F - t->s * (dbeta * t->h[c] + t->beta * dh[c] + q * (dm * p->r1[c] + t->m * dp->r1[c]));
  }
}

static inline PetscReal Power(const AncfRule *rule)
{
  return rule->strain == ANCF_STRAIN_PAPER ? 2 : 1;
}

void AncfElementViscous(const AncfRule *rule, const AncfViscosity *s, const AncfLanes e[12], const AncfLanes v[12],
                        const AncfLanes spin[3], AncfLanes Q[12], AncfLanes *power)
{
  const AncfLanes il = 1.0 / s->l;
  AncfLanes d[3][3], dv[3][3], q[3][3], F[12], sum = {0};
  Point p;

  Scaled(e, s->l, d);
  Scaled(v, s->l, dv);
  for (int i = 0; i < 3; i++)
    for (int c = 0; c < 3; c++) q[i][c] = (AncfLanes){0};
  for (PetscInt k = 0; k < rule->axial.n; k++) {
    AncfLanes f1[3], rate;

    PointAt(&rule->axial, k, il, d, dv, &p);
    AxialRate(rule->strain, &p, &rate, f1);
    for (int c = 0; c < 3; c++) f1[c] *= s->EA;
    PointForce(&rule->axial, k, il, f1, NULL, q);
    sum += rule->axial.w[k] * s->l * s->EA * rate * rate;
  }
  for (PetscInt k = 0; k < rule->bending.n; k++) {
    AncfLanes f1[3], f2[3];
    Rate t;

    PointAt(&rule->bending, k, il, d, dv, &p);
    BendingRate(Power(rule), &p, spin, &t);
    BendingForce(Power(rule), &p, &t, f1, f2);
    for (int c = 0; c < 3; c++) {
      f1[c] *= s->EI;
      f2[c] *= s->EI;
    }
    PointForce(&rule->bending, k, il, f1, f2, q);
    sum += rule->bending.w[k] * s->l * s->EI * t.s * Dot(t.h, t.h);
  }
  ForceExpand(q, s->l, F);
  for (int c = 0; c < 12; c++) Q[c] += F[c];
  if (power) *power += sum;
}

void AncfElementViscousTangent(const AncfRule *rule, const AncfViscosity *s, const AncfLanes e[12], const AncfLanes v[12],
                               const AncfLanes spin[3], PetscReal ge, PetscReal gv, AncfLanes H[81])
{
  const AncfLanes il = 1.0 / s->l, zero = {0};
  AncfLanes d[3][3], dv[3][3], df1[3], df2[3];
  Point p, dp;

  Scaled(e, s->l, d);
  Scaled(v, s->l, dv);
  for (int c = 0; c < 3; c++) dp.r1[c] = dp.r2[c] = dp.v1[c] = dp.v2[c] = zero;
  for (PetscInt k = 0; k < rule->axial.n; k++) {
    PointAt(&rule->axial, k, il, d, dv, &p);
    for (int dir = 0; dir < 3; dir++) {
      dp.r1[dir] = zero + ge;
      dp.v1[dir] = zero + gv;
      AxialChange(rule->strain, &p, &dp, df1);
      for (int c = 0; c < 3; c++) df1[c] *= s->EA;
      PointTangent(&rule->axial, k, il, dir, df1, NULL, H);
      dp.r1[dir] = dp.v1[dir] = zero;
    }
  }
  for (PetscInt k = 0; k < rule->bending.n; k++) {
    Rate t;

    PointAt(&rule->bending, k, il, d, dv, &p);
    BendingRate(Power(rule), &p, spin, &t);
    for (int dir = 0; dir < 6; dir++) {
      AncfLanes *dr = dir < 3 ? dp.r1 : dp.r2, *dvel = dir < 3 ? dp.v1 : dp.v2;

      dr[dir % 3] = zero + ge;
      dvel[dir % 3] = zero + gv;
      BendingChange(Power(rule), &p, &t, spin, &dp, df1, df2);
      for (int c = 0; c < 3; c++) {
        df1[c] *= s->EI;
        df2[c] *= s->EI;
      }
      PointTangent(&rule->bending, k, il, dir, df1, df2, H);
      dr[dir % 3] = dvel[dir % 3] = zero;
    }
  }
}

void AncfElementSpin(const AncfRule *rule, const AncfViscosity *s, const AncfLanes e[12], const AncfLanes v[12], AncfLanes A[6],
                     AncfLanes b[3])
{
  const AncfLanes il = 1.0 / s->l, none[3] = {{0}};
  AncfLanes d[3][3], dv[3][3];
  Point p;

  Scaled(e, s->l, d);
  Scaled(v, s->l, dv);
  for (PetscInt k = 0; k < rule->bending.n; k++) {
    AncfLanes wb, wA;
    Rate t;

    PointAt(&rule->bending, k, il, d, dv, &p);
    BendingRate(Power(rule), &p, none, &t);
    wb = rule->bending.w[k] * s->l * s->EI * t.s / t.a;
    wA = wb * Dot(t.x, t.x) / t.a;
    for (int i = 0, m = 0; i < 3; i++) {
      b[i] += wb * Dot(t.h, t.x) * p.r1[i];
      for (int j = i; j < 3; j++, m++) A[m] += wA * p.r1[i] * p.r1[j];
    }
  }
}

/* Rows and columns of r_0 are minus those of r_1; gradients carry a factor l. */
void AncfScaledExpand(const AncfLanes H[81], AncfLanes l, PetscInt lane, PetscReal k[144])
{
  const PetscReal factor[4] = {-1, l[lane], 1, l[lane]};
  static const int of[4] = {1, 0, 1, 2};

  for (int r = 0; r < 12; r++)
    for (int c = 0; c < 12; c++)
      k[12 * r + c] += factor[r / 3] * factor[c / 3] * H[9 * (3 * of[r / 3] + r % 3) + 3 * of[c / 3] + c % 3][lane];
}

void AncfScaledPack(const AncfLanes H[81], AncfLanes l, AncfLanes K[ANCF_TANGENT])
{
  static const int row[6] = {0, 0, 0, 1, 1, 2}, col[6] = {0, 1, 2, 1, 2, 2}, first[3] = {0, 0, 1}, second[3] = {1, 2, 2};
  const AncfLanes one = {1, 1, 1, 1, 1, 1, 1, 1}, factor[3] = {l, one, l};

#define SYMMETRIC(r, c) (0.5 * (H[9 * (r) + (c)] + H[9 * (c) + (r)]))
  for (int i = 0; i < 3; i++)
    for (int m = 0; m < 6; m++) K[6 * i + m] += factor[i] * factor[i] * SYMMETRIC(3 * i + row[m], 3 * i + col[m]);
  for (int t = 0; t < 3; t++)
    for (int m = 0; m < 9; m++)
      K[18 + 9 * t + m] += factor[first[t]] * factor[second[t]] * SYMMETRIC(3 * first[t] + m / 3, 3 * second[t] + m % 3);
#undef SYMMETRIC
}
