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

/* Cell-centred lattice of spacing dp in the box [lo,hi]: n x 3 positions (m). Along a periodic axis the box must be a whole
 * number of dp. */
FROND_EXTERN PetscErrorCode SphFillBox(PetscInt dim, PetscReal dp, const PetscReal lo[3], const PetscReal hi[3], SphFillKeep keep,
                                       void *ctx, PetscInt *n, PetscReal **x);

/*
  Layers of wall markers outside the box [lo,hi] on the faces flagged in face[6] (xmin,xmax,ymin,ymax,zmin,zmax), to `depthmax`
  (m); corners included once. Volume (m^3) dp^dim each; depth (m) below the box face.
*/
FROND_EXTERN PetscErrorCode SphFillWalls(PetscInt dim, PetscReal dp, const PetscReal lo[3], const PetscReal hi[3],
                                         const PetscBool face[6], const PetscBool periodic[3], PetscReal depthmax, PetscInt *n,
                                         PetscReal **x, PetscReal **volume, PetscReal **depth);

#endif
