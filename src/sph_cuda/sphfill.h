/* sphfill.h - initial lattices of fluid and wall markers. Arrays returned are allocated with PetscMalloc; the caller frees them.
 */
#ifndef SPHFILL_H
#define SPHFILL_H

#include "frondsys.h"

/*
  A lattice site is kept as fluid when `inside` says so; ctx is the caller's. dist > 0 outside every body.
  Ownership: a site belongs to the first of {wall, body, fluid} that claims it.
*/
typedef PetscBool (*SphFillKeep)(const PetscReal x[3], void *ctx);

/*
  Cell-centred lattice in the box [lo, hi]; along a periodic axis the box must be a whole number of dp. dim: 2 or 3. dp:
  spacing, m, > 0. lo: 3, m. hi: 3, m. keep: which sites to keep, NULL for all. ctx: its second argument. n: number of sites.
  x: n x 3, m; the caller frees it with PetscFree().
*/
FROND_EXTERN PetscErrorCode SphFillBox(PetscInt dim, PetscReal dp, const PetscReal lo[3], const PetscReal hi[3], SphFillKeep keep,
                                       void *ctx, PetscInt *n, PetscReal **x);

/*
  Signed distances of a place x (m): *region to the surface of what fluid fills, < 0 inside, *wall to the part of that surface
  which is a wall (the same, or greater). ctx is the caller's. Neither may differ by more than |x - y| between two places x, y.
*/
typedef void (*SphFillDistance)(const PetscReal x[3], void *ctx, PetscReal *region, PetscReal *wall);

/* A site no further outside than this times dp is inside, so that none is lost to round-off where regions touch. */
#define SPH_FILL_SLACK 1.0e-6

/*
  Wall markers around a region of any shape: the sites of the lattice of SphFillBox(), and of its continuation beyond the open
  faces of the box, that lie outside of the region and within depthmax of a wall. dim: 2 or 3. dp: spacing, m, > 0. lo, hi: 3,
  m, the box. face: 6 flags, as SphFillWalls(): nothing is put beyond these. periodic: 3 flags, nor beyond the ends of such an
  axis. depthmax: how deep, m. distance: the region. ctx: its second argument. n: number of markers. x: n x 3, m. volume: n,
  m^3, dp^dim each (2D: m^2). depth: n, m below the wall's surface; the caller frees the three arrays with PetscFree(). Source:
  the paper, Sect. 2.4.
*/
FROND_EXTERN PetscErrorCode SphFillRegionWalls(PetscInt dim, PetscReal dp, const PetscReal lo[3], const PetscReal hi[3],
                                               const PetscBool face[6], const PetscBool periodic[3], PetscReal depthmax,
                                               SphFillDistance distance, void *ctx, PetscInt *n, PetscReal **x,
                                               PetscReal **volume, PetscReal **depth);

/*
  Layers of wall markers outside the box [lo, hi], corners once. dim: 2 or 3. dp: spacing, m, > 0. lo: 3, m. hi: 3, m. face: 6
  flags, xmin, xmax, ymin, ymax, zmin, zmax. periodic: 3 flags: walls go on to the ends of such an axis. depthmax: how deep,
  m. n: number of markers. x: n x 3, m. volume: n, m^3, dp^dim each (2D: m^2). depth: n, m below the box face; the caller
  frees the three arrays with PetscFree(). Source: the paper, Sect. 2.4.
*/
FROND_EXTERN PetscErrorCode SphFillWalls(PetscInt dim, PetscReal dp, const PetscReal lo[3], const PetscReal hi[3],
                                         const PetscBool face[6], const PetscBool periodic[3], PetscReal depthmax, PetscInt *n,
                                         PetscReal **x, PetscReal **volume, PetscReal **depth);

#endif
