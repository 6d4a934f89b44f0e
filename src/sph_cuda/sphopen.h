/*
  sphopen.h - open boundaries of the fluid: buffer zones through which markers come in and go out.

  A buffer zone lies behind a flat opening (a line in 2D, a rectangle in 3D) and is a kernel's reach deep. Its markers are
  neighbours of the fluid as others are, but move and have the pressure that the opening prescribes or that are extrapolated from
  the fluid: Tafuni, Dominguez, Vacondio, Crespo, Comput. Methods Appl. Mech. Eng. 342 (2018). A marker of the zone that crosses
  the opening becomes fluid and a new one appears at the far end; a fluid marker that crosses it belongs to the zone, and is taken
  out at the far end. The number of markers is fixed before the run: SphAddReserve().
*/
#ifndef SPHOPEN_H
#define SPHOPEN_H

#include "sph.h"

/* Which way the fluid is meant to go; against it a warning tells of back flow. */
typedef enum { SPH_INFLOW, SPH_OUTFLOW } SphOpeningType;
/* What an opening prescribes; the other one is extrapolated from the fluid. */
typedef enum { SPH_OPENING_VELOCITY, SPH_OPENING_PRESSURE } SphOpeningGiven;
/* Velocity over the opening: the same everywhere, or a parabola along each edge, zero at its ends. */
typedef enum { SPH_PROFILE_UNIFORM, SPH_PROFILE_PARABOLIC } SphOpeningProfile;

/* Names of SphOpeningType. */
FROND_EXTERN const char *const SphOpeningTypes[];
/* Names of SphOpeningGiven. */
FROND_EXTERN const char *const SphOpeningGivens[];
/* Names of SphOpeningProfile. */
FROND_EXTERN const char *const SphOpeningProfiles[];

/* One opening. The normal edge1 x edge2 (2D: (edge1_y, -edge1_x)) points into the fluid. */
typedef struct {
  char name[64];                           /* for messages */
  SphOpeningType type;                     /* inflow (default) or outflow */
  SphOpeningGiven given;                   /* velocity (default) or pressure */
  SphOpeningProfile profile;               /* of a given velocity: uniform (default) or parabolic */
  PetscReal corner[3], edge1[3], edge2[3]; /* m; edges at right angles, whole numbers of dp long; edge2 in 3D only */
  PetscBool across[2];                     /* the edge spans a periodic axis: no parabola along it */
  PetscReal value;                         /* mean speed, m/s, >= 0 along `type`; or pressure in the opening, Pa */
  PetscReal gradient[3];                   /* of a given pressure along the opening, Pa/m: rho g for a hydrostatic one */
  PetscInt n;                              /* entries of a table of the value over time; 0: it is constant */
  const PetscReal *t, *values;             /* n, s, increasing, linear in between; n, m/s or Pa; copied */
} SphOpeningSpec;

/* What has passed an opening since set-up; in 2D per metre of depth. */
typedef struct {
  PetscReal in, out;         /* markers that became fluid; fluid markers that left */
  PetscReal massin, massout; /* theirs, kg */
  PetscReal momentum[3];     /* of those that came in less those that left, kg m/s */
  PetscReal impulse[3];      /* of the zone's forces on the fluid and on boundary markers around it, N s */
} SphFlow;

/* Default values. spec: filled. */
FROND_EXTERN PetscErrorCode SphOpeningSpecInit(SphOpeningSpec *spec);
/*
  Lattice sites of an opening's buffer zone, those next to the opening first; after SphSetSpacing() and the smoothing length. sph:
  the fluid. spec: the opening. n: number of sites. x: n x 3, m; the caller frees it with PetscFree(). Errors: edges of no length,
  not at right angles or no whole number of dp long.
*/
FROND_EXTERN PetscErrorCode SphOpeningSites(Sph sph, const SphOpeningSpec *spec, PetscInt *n, PetscReal **x);
/*
  An opening with the markers that its buffer zone holds at first; before SphAddBoundary(). spec: copied. n:
  number of markers, some of SphOpeningSites() or none. x: n x 3, m. p: n, Pa, or NULL for 0. opening: its number, may be NULL.
  Errors: values out of range, an overlap with another opening's zone; by SphSetUp(): boundary markers in the zone, a backend or
  an integrator that has no openings. Source: Tafuni et al. (2018).
*/
FROND_EXTERN PetscErrorCode SphAddOpening(Sph sph, const SphOpeningSpec *spec, PetscInt n, const PetscReal *x, const PetscReal *p,
                                          PetscInt *opening);
/*
  Markers in reserve, of group -2, for those that openings will bring in; before SphAddBoundary(). Markers that have left count as
  reserve too. n: number, >= 0. A run that needs more ends with PETSC_ERR_ARG_OUTOFRANGE.
*/
FROND_EXTERN PetscErrorCode SphAddReserve(Sph sph, PetscInt n);
/* n: number of openings. */
FROND_EXTERN PetscErrorCode SphGetNumOpenings(Sph sph, PetscInt *n);
/* opening: number, from 0. flow: what has passed it since set-up. */
FROND_EXTERN PetscErrorCode SphGetFlow(Sph sph, PetscInt opening, SphFlow *flow);
/* x: 3, m. inside: whether the point lies in the buffer zone of some opening. */
FROND_EXTERN PetscErrorCode SphInOpening(Sph sph, const PetscReal x[3], PetscBool *inside);

#endif
