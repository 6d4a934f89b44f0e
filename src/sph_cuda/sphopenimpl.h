/* sphopenimpl.h - private: the openings of a fluid. Markers of the zone of opening k have the group SPH_ZONE(k). */
#ifndef SPHOPENIMPL_H
#define SPHOPENIMPL_H

#include "sphopen.h"

#define SPH_ZONE(k) (-3 - (k))

typedef struct {
  SphOpeningSpec spec;             /* with tables of its own */
  double normal[3], tangent[2][3]; /* unit vectors; the normal points into the fluid */
  double length[2], depth;         /* of the edges and of the zone, m */
  double volume;                   /* of a site, m^3 */
  PetscInt sites[2];               /* along the edges */
  SphFlow flow;
  PetscBool warned; /* back flow was said */
} SphOpening;

typedef struct _SphOpenings {
  PetscInt n;
  SphOpening *opening;
  PetscInt idle;               /* markers of group -2 that have not left through an open side of the domain */
  PetscInt nzone, cap;         /* markers in zones during a step; room */
  int *zone;                   /* their slots */
  double *at, *offset, *value; /* cap x 3, x 3, x 10: for the extrapolation */
  int *event;                  /* what happens to each marker at the end of a step */
} SphOpenings;

static inline int SphIsZone(int group)
{
  return group <= -3;
}

/* sphopen.c: velocities and densities of the zones at time t (s) of a step of dt (s; 0 at set-up), from the state now; the search
   structure must be there. */
extern PetscErrorCode SphOpeningsApply(Sph sph, PetscReal t, PetscReal dt);
/* Before the full step of dt (s) with the rates now: forces of the zones. */
extern PetscErrorCode SphOpeningsForce(Sph sph, PetscReal dt);
/* After it: markers that came in, went out, or go. */
extern PetscErrorCode SphOpeningsExchange(Sph sph);
extern PetscErrorCode SphOpeningsCheck(Sph sph);
extern PetscErrorCode SphOpeningsSetUp(Sph sph);
extern PetscErrorCode SphOpeningsView(Sph sph, PetscViewer viewer);
extern PetscErrorCode SphOpeningsState(Sph sph, FrondState *s);
extern PetscErrorCode SphOpeningsDestroy(Sph sph);

/* sphopenbox.c: geometry. */
extern PetscErrorCode SphOpeningFrame(Sph sph, const SphOpeningSpec *spec, SphOpening *o);
/* Coordinates of x (m) in the frame of an opening: along the edges from the corner, and along the normal, below 0 in the zone. */
extern void SphOpeningCoordinates(const SphOpening *o, const double x[3], double c[3]);
/* Whether the point of these coordinates lies in the zone, by more than `margin` (m) inside. */
extern int SphOpeningHolds(const SphOpening *o, const double c[3], double margin);
extern int SphOpeningsOverlap(const SphOpening *a, const SphOpening *b, double margin);

#endif
