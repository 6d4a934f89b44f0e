/*
  sphpair.h - the pair physics of the fluid, one inline function per equation, shared by every backend.

  Equation numbers are those of Pazouki, Serban, Negrut. a is the marker whose sum is taken, b its neighbour;
  x_ab = x_a - x_b (m), r2 = |x_ab|^2, F as in sphkernel.h, so that grad_a W_ab = x_ab F.
*/
#ifndef SPHPAIR_H
#define SPHPAIR_H

#include "sphkernel.h"

/* Constants of a run in the working precision. */
typedef struct {
  sphreal hinv;  /* 1/h, 1/m */
  sphreal r2max; /* (2h)^2, m^2 */
  sphreal wnorm; /* norm of W, 1/m^dim */
  sphreal fnorm; /* norm of F, 1/m^(dim+2) */
  sphreal mu2;   /* mu_a + mu_b = 2 mu, Pa s */
  sphreal epsh2; /* epsilon h^2, m^2 */
  sphreal zeta;  /* XSPH factor, - */
  sphreal rho0;  /* kg/m^3 */
  sphreal avisc; /* artificial viscosity: 2 alpha c_s h, m^2/s */
  sphreal ddt;   /* density diffusion: 2 delta c_s h, m^2/s; 0 without */
  sphreal shift; /* shifting: 2 A h V_max, m^2/s; 0 without */
  sphreal wdp;   /* shifting: 1/W(dp) without norm */
  sphreal g[3];  /* density diffusion, Fourtakas: f/c_s^2, 1/m; 0 for Molteni-Colagrossi */
} SphPairConst;

/*
  Eq. 7: p(rho) as a function of the deviation s = rho/rho0 - 1, so that small pressures lose no digits in single
  precision: expm1/log1p are exact for small s, and so is the expanded seventh power. B = c_s^2 rho0/gamma (Pa).
*/
SPH_INLINE double sph_eos(double s, double B, double gamma)
{
  if (gamma == 7.0) return B * s * (7.0 + s * (21.0 + s * (35.0 + s * (35.0 + s * (21.0 + s * (7.0 + s))))));
  return B * expm1(gamma * log1p(s));
}

/* Inverse of Eq. 7: s = rho/rho0 - 1 from p. */
SPH_INLINE double sph_eos_inverse(double p, double B, double gamma)
{
  return expm1(log1p(p / B) / gamma);
}

/* Eq. 4, divided by rho_a: V_b v_ab . grad W (1/s); V_b = m_b/rho_b, vx = v_ab . x_ab. */
SPH_INLINE sphreal sph_continuity(sphreal Vb, sphreal vx, sphreal F)
{
  return Vb * vx * F;
}

/* Eq. 5, pressure: factor of x_ab in dv_a/dt (1/s^2); P = p/rho^2. */
SPH_INLINE sphreal sph_pressure(sphreal mb, sphreal Pa, sphreal Pb, sphreal F)
{
  return -mb * (Pa + Pb) * F;
}

/* Eqs. 5 and 6, viscosity: factor of v_ab in dv_a/dt (1/s), <= 0; x_ab . grad W = r2 F. */
SPH_INLINE sphreal sph_viscosity(const SphPairConst *c, sphreal mb, sphreal rhoa, sphreal rhob, sphreal r2, sphreal F)
{
  const sphreal rho = (sphreal)0.5 * (rhoa + rhob);
  return mb * c->mu2 * r2 * F / (rho * rho * (r2 + c->epsh2));
}

/* Morris, Fox, Zhu, J. Comput. Phys. 136 (1997), Eq. 22: as sph_viscosity() with rho_a rho_b for the squared mean density. */
SPH_INLINE sphreal sph_viscosity_morris(const SphPairConst *c, sphreal mb, sphreal rhoa, sphreal rhob, sphreal r2, sphreal F)
{
  return mb * c->mu2 * r2 * F / (rhoa * rhob * (r2 + c->epsh2));
}

/*
  Artificial viscosity, Monaghan, Annu. Rev. Astron. Astrophys. 30 (1992), Eq. 4.2 with beta = 0 and the reference sound speed:
  factor of x_ab in dv_a/dt (1/s^2), >= 0 for approaching markers, else 0; vx = v_ab . x_ab.
*/
SPH_INLINE sphreal sph_viscosity_artificial(const SphPairConst *c, sphreal mb, sphreal rhoa, sphreal rhob, sphreal vx, sphreal r2,
                                            sphreal F)
{
  const sphreal approach = vx < (sphreal)0 ? vx : (sphreal)0;
  return mb * c->avisc * approach * F / ((rhoa + rhob) * (r2 + c->epsh2));
}

/*
  Density diffusion between fluid markers, in d(rho_a/rho0)/dt (1/s); s = rho/rho0 - 1, gx = g . x_ab.
  Molteni, Colagrossi, Comput. Phys. Commun. 180 (2009), Eq. 9: delta h c_s Sum V_b psi . grad W with psi = 2 (rho_b - rho_a)
  x_ba/r2. Fourtakas, Dominguez, Vacondio, Rogers, Comput. Fluids 190 (2019): the hydrostatic part of the difference is taken out;
  here with Eq. 7 linearised, s_a - s_b = f . x_ab/c_s^2 at rest (relative error of order gamma f h/c_s^2).
*/
SPH_INLINE sphreal sph_diffusion(const SphPairConst *c, sphreal Vb, sphreal sa, sphreal sb, sphreal gx, sphreal F)
{
  return c->ddt * Vb * (sa - sb - gx) * F;
}

/* Eq. 11: factor of (v_b - v_a) in the XSPH velocity (-), without zeta: sph_xsph_factor(). */
SPH_INLINE sphreal sph_xsph(sphreal mb, sphreal rhoa, sphreal rhob, sphreal W)
{
  return (sphreal)2 * mb / (rhoa + rhob) * W;
}

/*
  Factor of the sum of Eq. 11 (-): zeta, less where markers crowd; w: the sum of sph_xsph() over all markers, the marker itself
  too, 1 in an undisturbed fluid. Eq. 11 leaves markers that crowd the part 1 - zeta w of the velocity that they have relative to
  one another. When w > 1/zeta that is negative: they move against their velocity, so that what pulls them together drives them
  apart and back without end. The part is kept at (1 - zeta)/2 at least, half of what it is in an undisturbed fluid.
*/
SPH_INLINE sphreal sph_xsph_factor(sphreal zeta, sphreal w)
{
  const sphreal most = (sphreal)0.5 * ((sphreal)1 + zeta);
  return zeta * w > most ? most / w : zeta;
}

/*
  Shifting velocity, factor of x_ab (1/s): Sun, Colagrossi, Marrone, Zhang, Comput. Methods Appl. Mech. Eng. 315 (2017), Eq. 4, as
  a velocity: -2 A h V_max Sum V_b [1 + 0.2 (W/W(dp))^4] grad W; A = 1 there. It moves positions only: density and velocity go
  along, so that mass and momentum are conserved exactly. w = W without norm.
*/
SPH_INLINE sphreal sph_shift(const SphPairConst *c, sphreal Vb, sphreal w, sphreal F)
{
  const sphreal r = w * c->wdp, r2 = r * r;
  return -c->shift * Vb * ((sphreal)1 + (sphreal)0.2 * r2 * r2) * F;
}

/*
  What part of the shifting velocity a marker keeps: none at a free surface, where the divergence of the position -Sum V_b r2 F
  falls short of dim (Lee et al., J. Comput. Phys. 227 (2008)), nor in a second row of markers; all where the support is full.
*/
SPH_INLINE double sph_shift_keep(double div, double dim)
{
  const double keep = (div / dim - 0.9) / 0.07;
  return keep < 0.0 ? 0.0 : (keep > 1.0 ? 1.0 : keep);
}

/*
  Kernel gradient correction (Bonet, Lok, Comput. Methods Appl. Mech. Eng. 180 (1999)): with M = -Sum V_b F x_ab x_ab^T and L =
  M^-1, grad p = L Sum V_b (p_b - p_a) F x_ab and grad v = L Sum V_b F x_ab (v_b - v_a)^T are exact for linear fields on any set
  of markers. These are the sums that need b; T: rows of -v_ab.
*/
typedef struct {
  sphreal m[6], g[3], s[3],
      t[9]; /* M: xx, yy, zz, xy, yz, zx; pressure; Eq. 5's pressure term; T, t[3 k + l] = (v_b - v_a)_k x_l */
} SphGradientSums;

/*
  Which part of the correction a marker takes: none in the first row at a free surface, where trace M is 0.59 to 0.70 dim, all in
  the second, where it is 0.81 to 0.99 dim (both kernels, h/dp 1.2 to 2).
*/
SPH_INLINE double sph_gradient_keep(double trace, double dim)
{
  const double keep = (trace / dim - 0.7) / 0.1;
  return keep < 0.0 ? 0.0 : (keep > 1.0 ? 1.0 : keep);
}

/* The correction of dv/dt (m/s^2) and of d(rho/rho0)/dt/(rho/rho0) (1/s): exact gradients less those of Eqs. 4 and 5. */
SPH_INLINE void sph_gradient_correct(int dim, double rho, const SphGradientSums *c, double a[3], double *div)
{
  const double xx = (double)c->m[0], yy = (double)c->m[1], zz = dim == 3 ? (double)c->m[2] : 1.0, xy = (double)c->m[3],
               yz = dim == 3 ? (double)c->m[4] : 0.0, zx = dim == 3 ? (double)c->m[5] : 0.0;
  const double keep = sph_gradient_keep(xx + yy + (dim == 3 ? zz : 0.0), (double)dim);
  const double cxx = yy * zz - yz * yz, cxy = yz * zx - xy * zz, czx = xy * yz - yy * zx, det = xx * cxx + xy * cxy + zx * czx;
  const double L[9] = {cxx, cxy, czx, cxy, xx * zz - zx * zx, xy * zx - xx * yz, czx, xy * zx - xx * yz, xx * yy - xy * xy};

  *div = 0.0;
  for (int k = 0; k < 3; k++) {
    double grad = 0.0, own = 0.0;
    for (int l = 0; l < 3; l++) {
      grad += L[3 * k + l] * (double)c->g[l];
      own += L[3 * k + l] * (double)c->t[3 * k + l];
    }
    a[k] = keep > 0.0 ? keep * (-grad / (det * rho) - (double)c->s[k]) : 0.0;
    if (keep > 0.0 && k < dim) *div += keep * (-own / det + (double)c->t[4 * k]);
  }
}

/*
  Velocity that boundary marker a lends the viscous term, less its own: r (v_a + w x (<x> - x_a) - <v>), m/s. <v>, <x>: kernel
  means of velocity and position over the fluid around; w: angular velocity of the wall (rad/s), so that the fluid is compared
  with the wall's motion where the fluid is, and turns with the wall as one body without friction. Over a flat wall and r of
  SphWallRatio() that is Adami, Hu, Adams, J. Comput. Phys. 231 (2012), Eq. 23, with the wall's velocity at the surface point
  above the marker. Free slip (r < 0) takes <v> itself.
*/
SPH_INLINE void sph_wall_velocity(double r, const double va[3], const double mean[3], const double w[3], const double offset[3],
                                  double dv[3])
{
  for (int k = 0; k < 3; k++) {
    const int l = (k + 1) % 3, m = (k + 2) % 3;
    const double turn = r < 0.0 ? 0.0 : w[l] * offset[m] - w[m] * offset[l];
    dv[k] = r * (va[k] + turn - mean[k]);
  }
}

#if defined(SPHIMPL_H)
/* The constants from the parameters of a run. */
SPH_INLINE SphPairConst sph_pair_const(const SphParams *p)
{
  SphPairConst c;

  c.hinv = (sphreal)(1.0 / p->h);
  c.r2max = (sphreal)(4.0 * p->h * p->h);
  c.wnorm = (sphreal)p->wnorm;
  c.fnorm = (sphreal)p->fnorm;
  c.mu2 = (sphreal)(2.0 * p->mupair);
  c.epsh2 = (sphreal)(p->epsilon * p->h * p->h);
  c.zeta = (sphreal)p->zeta;
  c.rho0 = (sphreal)p->rho0;
  c.avisc = (sphreal)(2.0 * p->alpha * p->cs * p->h);
  c.ddt = (sphreal)(p->diffusion == SPH_DIFFUSION_NONE ? 0.0 : 2.0 * p->delta * p->cs * p->h);
  c.shift = (sphreal)(p->shifting == SPH_SHIFTING_NONE ? 0.0 : 2.0 * p->shiftfactor * p->h * p->vmax);
  c.wdp = (sphreal)1 / sph_w(p->kernel, (sphreal)(p->dp / p->h));
  for (int k = 0; k < 3; k++)
    c.g[k] = (sphreal)(p->diffusion == SPH_DIFFUSION_FOURTAKAS && k < p->dim ? p->f[k] / (p->cs * p->cs) : 0.0);
  return c;
}
#endif

#endif
