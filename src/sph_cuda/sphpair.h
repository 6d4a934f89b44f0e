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
  sphreal hinv;   /* 1/h, 1/m */
  sphreal r2max;  /* (2h)^2, m^2 */
  sphreal wnorm;  /* norm of W, 1/m^dim */
  sphreal fnorm;  /* norm of F, 1/m^(dim+2) */
  sphreal mu2;    /* mu_a + mu_b = 2 mu, Pa s */
  sphreal epsh2;  /* epsilon h^2, m^2 */
  sphreal zeta;   /* XSPH factor, - */
  sphreal rho0;   /* kg/m^3 */
} SphPairConst;

/*
  Eq. 7: p(rho) as a function of the deviation s = rho/rho0 - 1, so that small pressures lose no digits in single
  precision: expm1/log1p are exact for small s. B = c_s^2 rho0/gamma (Pa).
*/
SPH_INLINE double sph_eos(double s, double B, double gamma)
{
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

/* Eq. 11: factor of (v_b - v_a) in the XSPH velocity (-), without zeta. */
SPH_INLINE sphreal sph_xsph(sphreal mb, sphreal rhoa, sphreal rhob, sphreal W)
{
  return (sphreal)2 * mb / (rhoa + rhob) * W;
}

#endif
