/*
  sphwall.c - constants that depend on the kernel and the initial lattice only: wall extrapolation and viscosity normalisation.

  Adami, Hu, Adams, J. Comput. Phys. 231 (2012), Eq. 23, give a boundary marker the velocity 2 v_b - <v>, where <v> is the kernel
  mean of the fluid velocity around it. That is exact for a linear profile only if the fluid seen lies as far outside the surface
  as the marker lies inside. Here v_ext = v_b + r (v_b - <v>) with r = depth/<y>, <y> the kernel mean of the distance from the
  surface of a fluid lattice over a flat wall, so that a linear profile along a flat wall is continued exactly
  (antisymmetrically).
*/
#include <math.h>
typedef double sphreal;
#include "sphimpl.h"
#include "sphkernel.h"

/* r is bounded: deep markers see a few fluid markers near the surface only, with vanishing kernel gradients. */
#define SPH_WALLRATIO_MAX 4.0

PetscReal SphWallRatio(const SphParams *par, PetscReal depth)
{
  const int reach = (int)ceil(2.0 * par->h / par->dp) + 1, nz = par->dim == 3 ? reach : 0;
  double sw = 0.0, sy = 0.0;

  if (depth <= 0.0) return 1.0;
  for (int j = 0; j < reach; j++)
    for (int i = -reach; i <= reach; i++)
      for (int k = -nz; k <= nz; k++) {
        const double y = (j + 0.5) * par->dp, dy = y + depth, r = sqrt(dy * dy + (i * i + k * k) * par->dp * par->dp);
        const double w = r < 2.0 * par->h ? sph_w(par->kernel, r / par->h) : 0.0;
        sw += w;
        sy += w * y;
      }
  if (sw <= 0.0) return 1.0;
  return PetscMin(depth * sw / sy, SPH_WALLRATIO_MAX);
}

/*
  SphViscosityLattice - What Eq. 6 makes of the Laplacian of a quadratic velocity field on the undisturbed lattice, 1 for an exact
  operator.

  u = y^2/2 has the Laplacian 1; the sum over the lattice gives C = -sum V F y^2 r^2/(r^2 + epsilon h^2). Dividing mu by C removes
  the part of the error that does not fall with resolution at fixed h/dp (0.1 to 2 %).
*/
PetscReal SphViscosityLattice(const SphParams *par)
{
  const int reach = (int)ceil(2.0 * par->h / par->dp), nz = par->dim == 3 ? reach : 0;
  const double norm = sph_norm(par->kernel, (int)par->dim, par->h) / (par->h * par->h), d2 = par->dp * par->dp;
  double sum = 0.0;

  for (int j = -reach; j <= reach; j++)
    for (int i = -reach; i <= reach; i++)
      for (int k = -nz; k <= nz; k++) {
        const double r2 = (i * i + j * j + k * k) * d2, y2 = j * j * d2;
        if (r2 > 0.0 && r2 < 4.0 * par->h * par->h)
          sum -= norm * sph_f(par->kernel, sqrt(r2) / par->h) * y2 * r2 / (r2 + par->epsilon * par->h * par->h);
      }
  return sum * pow(par->dp, (double)par->dim);
}
