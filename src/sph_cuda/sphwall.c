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
  SphLattice - Kernel norms and pair viscosity such that sums over the undisturbed lattice are exact.

  At fixed h/dp the sums over the initial lattice miss their integrals by 0.1 to 2 %, an error that does not fall with resolution.
  One factor each makes them exact there: sum V W = 1; -sum V F y^2 = 1, so that gradients and divergences of linear fields are
  exact; and Eq. 6 gives the Laplacian 1 for u = y^2/2. With `lattice` off the continuous norms and mu itself are used.
*/
void SphLattice(SphParams *par)
{
  const int reach = (int)ceil(2.0 * par->h / par->dp), nz = par->dim == 3 ? reach : 0;
  const double norm = sph_norm(par->kernel, (int)par->dim, par->h), d2 = par->dp * par->dp, V = pow(par->dp, (double)par->dim);
  double sw = 0.0, sf = 0.0, sv = 0.0;

  par->wnorm = norm;
  par->fnorm = norm / (par->h * par->h);
  par->mupair = par->mu;
  if (!par->lattice) return;
  for (int j = -reach; j <= reach; j++)
    for (int i = -reach; i <= reach; i++)
      for (int k = -nz; k <= nz; k++) {
        const double r2 = (i * i + j * j + k * k) * d2, y2 = j * j * d2;
        if (r2 >= 4.0 * par->h * par->h) continue;
        const double F = r2 > 0.0 ? par->fnorm * sph_f(par->kernel, sqrt(r2) / par->h) : 0.0;
        sw += V * norm * sph_w(par->kernel, sqrt(r2) / par->h);
        sf -= V * F * y2;
        sv -= V * F * y2 * r2 / (r2 + par->epsilon * par->h * par->h);
      }
  par->wnorm /= sw;
  par->fnorm /= sf;
  par->mupair = par->mu * sf / sv;
}
