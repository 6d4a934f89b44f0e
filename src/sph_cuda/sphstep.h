/*
  sphstep.h - one step of one marker, shared by every backend. All state is double.

  rk2: explicit midpoint, the second-order Runge-Kutta scheme of Pazouki, Serban, Negrut, Sect. 3.
  symplectic: midpoint predictor, position Verlet corrector, density corrected by a quotient: Parshikov et al., Int. J. Impact
  Eng. 24 (2000); Dominguez et al., Comput. Part. Mech. 9 (2022), Sect. 2.6. verlet: leapfrog from the state before, one
  evaluation per step, every SPH_VERLET_EVERY steps an explicit Euler step that keeps the two interleaved solutions together:
  Verlet, Phys. Rev. 159 (1967); Dominguez et al. (2022). With a varying step the span is dt + dt_old. The XSPH velocity enters
  positions at the beginning of the step, to first order.
*/
#ifndef SPHSTEP_H
#define SPHSTEP_H

#include "sphkernel.h"

/* One marker: state, state saved, rates. acc includes the body force; dv is the XSPH velocity; ds is d(rho/rho0)/dt. */
typedef struct {
  double x[3], v[3], s;
  double xn[3], vn[3], sn;
  double acc[3], dv[3], ds;
} SphStepMarker;

/* To the middle of the step: rk2 and symplectic. fluid 0: a boundary marker, whose density alone evolves. */
SPH_INLINE void sph_step_half(SphStepMarker *m, int fluid, double dt)
{
  m->sn = m->s;
  m->s += 0.5 * dt * m->ds;
  for (int k = 0; k < 3 && fluid; k++) {
    m->xn[k] = m->x[k];
    m->vn[k] = m->v[k];
    m->x[k] += 0.5 * dt * (m->v[k] + m->dv[k]);
    m->v[k] += 0.5 * dt * m->acc[k];
  }
}

SPH_INLINE void sph_step_full_rk2(SphStepMarker *m, int fluid, double dt)
{
  m->s = m->sn + dt * m->ds;
  for (int k = 0; k < 3 && fluid; k++) {
    m->x[k] = m->xn[k] + dt * (m->v[k] + m->dv[k]);
    m->v[k] = m->vn[k] + dt * m->acc[k];
  }
}

SPH_INLINE void sph_step_full_symplectic(SphStepMarker *m, int fluid, double dt)
{
  const double e = -dt * m->ds / (1.0 + m->s);

  m->s = m->sn - (1.0 + m->sn) * 2.0 * e / (2.0 + e); /* rho = rho_n (2 - e)/(2 + e) */
  for (int k = 0; k < 3 && fluid; k++) {
    m->v[k] = m->vn[k] + dt * m->acc[k];
    m->x[k] = m->xn[k] + dt * (0.5 * (m->vn[k] + m->v[k]) + m->dv[k]);
  }
}

/* span: dt + dt_old from the state before, or 0 for an Euler step from the state now. */
SPH_INLINE void sph_step_full_verlet(SphStepMarker *m, int fluid, double dt, double span)
{
  const double s = m->s;

  m->s = span > 0.0 ? m->sn + span * m->ds : s + dt * m->ds;
  m->sn = s;
  for (int k = 0; k < 3 && fluid; k++) {
    const double v = m->v[k];
    m->x[k] += dt * (v + m->dv[k]) + 0.5 * dt * dt * m->acc[k];
    m->v[k] = span > 0.0 ? m->vn[k] + span * m->acc[k] : v + dt * m->acc[k];
    m->vn[k] = v;
  }
}

#endif
