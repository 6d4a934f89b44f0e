/*
  sphbrute.h - every sum of the fluid over all pairs and all periodic images, in double, straight from the papers' equations.

  It shares no line with the solver: kernels in their textbook form, gradients by the chain rule, no cells, no lists. For each sum
  it also gives the amplitude: the same sum with every term replaced by its size before any cancellation. An error bound follows
  from that: with N terms in a precision epsilon, summation costs at most N epsilon amplitude, and a few tens of epsilon go into
  each term. Positions are rounded relative to a cell centre at most 6 h away, which changes q by 6 epsilon and the kernel by the
  slope (at most 9 norm) times that; 1.2 norm added to each kernel value in the amplitude covers it for N + 32 >= 45.
*/
#ifndef SPHBRUTE_H
#define SPHBRUTE_H

#include "sph_cuda/sphimpl.h"
#include <math.h>
#include <stdlib.h>

static double BruteW(int kernel, int dim, double h, double r)
{
  const double q = r / h;
  double w = 0.0;
  if (q >= 2.0) return 0.0;
  if (kernel == SPH_KERNEL_CUBIC) {
    w = pow(2.0 - q, 3) - (q < 1.0 ? 4.0 * pow(1.0 - q, 3) : 0.0);
    return w * (dim == 2 ? 5.0 / (14.0 * M_PI * h * h) : 1.0 / (4.0 * M_PI * h * h * h));
  }
  w = pow(1.0 - 0.5 * q, 4) * (2.0 * q + 1.0);
  return w * (dim == 2 ? 7.0 / (4.0 * M_PI * h * h) : 21.0 / (16.0 * M_PI * h * h * h));
}

/* dW/dr. */
static double BruteDW(int kernel, int dim, double h, double r)
{
  const double q = r / h;
  if (q >= 2.0) return 0.0;
  if (kernel == SPH_KERNEL_CUBIC) {
    const double c = dim == 2 ? 5.0 / (14.0 * M_PI * h * h) : 1.0 / (4.0 * M_PI * h * h * h);
    return c / h * (-3.0 * pow(2.0 - q, 2) + (q < 1.0 ? 12.0 * pow(1.0 - q, 2) : 0.0));
  }
  const double c = dim == 2 ? 7.0 / (4.0 * M_PI * h * h) : 21.0 / (16.0 * M_PI * h * h * h);
  return c / h * (-5.0 * q * pow(1.0 - 0.5 * q, 3));
}

/* One value of each sum for marker i, and its amplitude. */
typedef struct {
  double a[3], ds, dv[3], sum, shepard; /* Eq. 5 without f, d(rho/rho0)/dt, Eq. 11, Eq. 9 / rho0 - 1 plain and normalised */
  double wp, wv[3],
      wsum; /* boundary: extrapolated pressure and mean fluid velocity, kernel sum x volume of a cell of the lattice */
  double A, Ads, Adv, Asum, Awp, Awv; /* amplitudes */
  double share, Ashare;               /* zeta times the sum of the weights of Eq. 11, and its amplitude */
  int n;                              /* terms */
} BruteSums;

/* Everything in added order; s, u, w (velocities of Eq. 4 and of the viscous term) set by the caller. */
typedef struct {
  const SphParams *p;
  int n;
  const double *x, *v, *ab; /* n x 3 */
  const int *boundary;
  const double *m;
  double *s, *u, *w;
} Brute;

typedef void (*BrutePair)(const Brute *b, int i, int j, const double d[3], double r, BruteSums *out);

/* Calls pair for all j and images closer than 2h, i itself once with r = 0. */
static void BruteLoop(const Brute *b, int i, BrutePair pair, BruteSums *out)
{
  const SphParams *p = b->p;
  int img[3];
  for (int k = 0; k < 3; k++) img[k] = k < p->dim && p->periodic[k] ? 1 : 0;
  for (int j = 0; j < b->n; j++) {
    if (b->boundary[i] && b->boundary[j]) continue;
    for (int ix = -img[0]; ix <= img[0]; ix++)
      for (int iy = -img[1]; iy <= img[1]; iy++)
        for (int iz = -img[2]; iz <= img[2]; iz++) {
          const int o[3] = {ix, iy, iz};
          double d[3] = {0, 0, 0}, r2 = 0.0;
          for (int k = 0; k < p->dim; k++) {
            d[k] = b->x[3 * i + k] - b->x[3 * j + k] - o[k] * (p->hi[k] - p->lo[k]);
            r2 += d[k] * d[k];
          }
          if (r2 < 4.0 * p->h * p->h) pair(b, i, j, d, sqrt(r2), out);
        }
  }
}

static double BruteNorm3(const double *a)
{
  return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

static double BrutePressure(const SphParams *p, double s)
{
  return p->cs * p->cs * p->rho0 / p->gamma * expm1(p->gamma * log1p(s)) + p->pb;
}

static double BruteCapW(const SphParams *p, double r)
{
  return BruteW(p->kernel, (int)p->dim, p->h, r) + 0.3 * BruteW(p->kernel, (int)p->dim, p->h, 0.0);
}

/* |dW/dr| and the room for rounded positions, see the top. */
static double BruteCapDW(const SphParams *p, double r)
{
  return fabs(BruteDW(p->kernel, (int)p->dim, p->h, r)) +
         1.2 * BruteW(p->kernel, (int)p->dim, p->h, 0.0) / (p->kernel == SPH_KERNEL_CUBIC ? 4.0 : 1.0) * r / (p->h * p->h);
}

/* Eqs. 9 and 11 and, for boundary markers, Adami et al. (2012), Eqs. 22 and 27. */
static void BruteAux(const Brute *b, int i, int j, const double d[3], double r, BruteSums *o)
{
  const SphParams *p = b->p;
  const double W = BruteW(p->kernel, (int)p->dim, p->h, r), C = BruteCapW(p, r), ri = p->rho0 * (1.0 + b->s[i]),
               rj = p->rho0 * (1.0 + b->s[j]);
  o->n++;
  o->sum += b->m[j] * W / p->rho0;
  o->wsum += b->m[j] / rj * W;
  o->shepard += b->m[j] / rj * b->s[j] * W;
  o->Asum += b->m[j] / p->rho0 * C;
  if (b->boundary[i]) {
    double pj = BrutePressure(p, b->s[j]), size = fabs(pj);
    for (int k = 0; k < p->dim; k++) {
      pj += rj * (p->f[k] - b->ab[3 * i + k]) * d[k];
      size += rj * fabs(p->f[k] - b->ab[3 * i + k]) * fabs(d[k]);
      o->wv[k] += W * b->v[3 * j + k];
    }
    o->wp += W * pj;
    o->Awp += C * size;
    o->Awv += C * BruteNorm3(b->v + 3 * j);
    o->dv[0] += W; /* kernel sum, for the caller to divide by */
    return;
  }
  for (int k = 0; k < p->dim; k++) o->dv[k] += p->zeta * b->m[j] / (0.5 * (ri + rj)) * (b->v[3 * j + k] - b->v[3 * i + k]) * W;
  o->Adv += p->zeta * b->m[j] / (0.5 * (ri + rj)) * (BruteNorm3(b->v + 3 * j) + BruteNorm3(b->v + 3 * i)) * C;
  o->share += p->zeta * b->m[j] / (0.5 * (ri + rj)) * W;
  o->Ashare += p->zeta * b->m[j] / (0.5 * (ri + rj)) * C;
}

/* Eq. 11 where markers crowd: they keep half of 1 - zeta of their own velocity. The amplitude takes the error of the quotient. */
static void BruteCrowd(const SphParams *p, BruteSums *o)
{
  const double most = (1.0 + p->zeta) / 2.0;
  if (o->share <= most) return;
  for (int k = 0; k < 3; k++) o->dv[k] *= most / o->share;
  o->Adv *= most / o->share * (1.0 + o->Ashare / o->share);
}

/* Eqs. 4-6, Morris et al. (1997) Eq. 22, Monaghan (1992) Eq. 4.2, Molteni and Colagrossi (2009), Fourtakas et al. (2019). */
static void BruteRates(const Brute *b, int i, int j, const double d[3], double r, BruteSums *o)
{
  const SphParams *p = b->p;
  const double ri = p->rho0 * (1.0 + b->s[i]), rj = p->rho0 * (1.0 + b->s[j]), rm = 0.5 * (ri + rj),
               h2 = p->epsilon * p->h * p->h;
  const double Pi = BrutePressure(p, b->s[i]) / (ri * ri), Pj = BrutePressure(p, b->s[j]) / (rj * rj), C = BruteCapDW(p, r);
  double dW[3], xdW = 0.0, uv = 0.0, wv = 0.0, gx = 0.0, ew[3], speed = 0.0, size;
  if (r <= 0.0) return;
  o->n++;
  for (int k = 0; k < 3; k++) {
    dW[k] = BruteDW(p->kernel, (int)p->dim, p->h, r) * d[k] / r;
    xdW += d[k] * dW[k];
    ew[k] = b->w[3 * i + k] - b->w[3 * j + k];
    uv += (b->u[3 * i + k] - b->u[3 * j + k]) * dW[k];
    wv += ew[k] * d[k];
    if (k < p->dim) gx += p->f[k] * d[k];
  }
  speed = BruteNorm3(b->w + 3 * i) + BruteNorm3(b->w + 3 * j);
  size = (fabs(Pi) + fabs(Pj)) * C;
  for (int k = 0; k < 3; k++) {
    double pi = 0.0;
    if (p->viscosity == SPH_VISCOSITY_EQ6)
      pi = -2.0 * p->mupair * xdW / (rm * rm * (r * r + h2)) * ew[k];
    else if (p->viscosity == SPH_VISCOSITY_MORRIS)
      pi = -2.0 * p->mupair * xdW / (ri * rj * (r * r + h2)) * ew[k];
    else if (wv < 0.0)
      pi = -p->alpha * p->cs * (p->h * wv / (r * r + h2)) / rm * dW[k];
    o->a[k] -= b->m[j] * ((Pi + Pj) * dW[k] + pi);
  }
  if (p->viscosity == SPH_VISCOSITY_ARTIFICIAL)
    size += p->alpha * p->cs * p->h * speed * r / (r * r + h2) / rm * C;
  else
    size += 2.0 * p->mupair * r * C / (rm * rm * (r * r + h2)) * speed;
  o->A += b->m[j] * size;
  o->ds += (1.0 + b->s[i]) * b->m[j] / rj * uv;
  o->Ads += b->m[j] / rj * (BruteNorm3(b->u + 3 * i) + BruteNorm3(b->u + 3 * j)) * C;
  if (p->diffusion == SPH_DIFFUSION_NONE || b->boundary[i] || b->boundary[j]) return;
  const double dyn = (ri - rj) - (p->diffusion == SPH_DIFFUSION_FOURTAKAS ? p->rho0 * gx / (p->cs * p->cs)
                                                                          : 0.0); /* rho_a - rho_b without the hydrostatic part */
  o->ds += p->delta * p->h * p->cs * 2.0 * dyn * xdW / (r * r) * b->m[j] / rj / p->rho0;
  o->Ads += p->delta * p->h * p->cs * 2.0 * (fabs(b->s[i]) + fabs(b->s[j]) + fabs(gx) / (p->cs * p->cs)) * C / r * b->m[j] / rj;
}

#endif
