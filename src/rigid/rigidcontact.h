/* rigidcontact.h - private: what rigidpairs.c (which bodies are near) and rigidcontact.c (where they face one another) share. */
#ifndef RIGIDCONTACT_H
#define RIGIDCONTACT_H

#include "rigidgeometry.h"

typedef struct {
  PetscInt i, j;
} Pair;

#define RIGID_WALL (-2) /* in place of body j: a wall */

/* n points from j to i; ri, rj: from the centres of mass to the point of action; s: gap. */
typedef struct {
  PetscInt i, j;
  PetscReal n[3], ri[3], rj[3], s, gamma, R, share;
  PetscReal v, elastic, lubrication, impact; /* normal velocity, m/s; parts of the force on i along n, N */
} Contact;

struct _p_RigidContact {
  PetscInt nbodies;
  PetscReal reach;       /* m */
  PetscReal *radius;     /* of each body's bounding sphere, m */
  RigidMarkers *surface; /* of each body, body frame; empty for spheres */
  PetscInt njoined;
  Pair *joined;                 /* sorted; the ground is RIGID_GROUND */
  PetscReal small;              /* bodies of larger radius, walls say, are tried against all others, m */
  PetscInt nhead, *head, *next; /* grid of the others: first body of a cell, next body in it */
  PetscInt npairs, npairalloc;
  Pair *pair;
  PetscInt n, nalloc;
  Contact *contact;
  PetscReal *G;         /* 1/s, of each body */
  PetscReal *kick;      /* 6 of each body: change of V and w by the present kick, m/s, rad/s */
  RigidMarkers near[2]; /* surface points of a pair that face the other body, space frame */
};

static inline PetscReal RigidNearestImage(PetscReal d, PetscReal period)
{
  return period > 0. ? d - period * PetscFloorReal(d / period + .5) : d;
}

/* rigidpairs.c */
extern int RigidComparePairs(const void *pa, const void *pb);
extern PetscErrorCode RigidFindPairs(Rigid rigid, RigidContact c);

#endif
