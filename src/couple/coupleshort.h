/* coupleshort.h - private: what coupleshort.c (the forces) and couplenear.c (where beams are near something) share. */
#ifndef COUPLESHORT_H
#define COUPLESHORT_H

#include "coupleimpl.h"

/* A point on a beam: S over the vector coordinates 2 node .. 2 node + 3 of all beams, Eq. 19. */
typedef struct {
  PetscInt beam, node;
  PetscReal s, S[4], x[3]; /* arc coordinate and place, m */
} ShortPoint;

enum { SHORT_BEAM = -1, SHORT_WALL = -2 };

/* Beam a against beam b, a body (body >= 0) or a wall; n: unit vector from there to a; length of axis that the pair stands for.
 */
typedef struct {
  ShortPoint a, b;
  PetscInt body;
  PetscReal n[3], r[3], gap, R, length; /* r: from the body's centre to the point of action, m */
  PetscReal factor;                     /* of the resistance */
  PetscReal c, k, root;                 /* resistance, N s/m; stiffness, N/m; root of the body's inverse mass, kg^-1/2 */
  PetscReal elastic, heat, start;       /* parts of the force along n, N; n.(x_a - x_b) of beams at the start of the step, m */
} ShortPair;

typedef struct {
  PetscInt elements, node, sample, samples, inverse; /* first node, first sample; inverse: number of its mass matrix */
  PetscReal R, l, L, lo, hi, step, rhoA, exclude;    /* m; samples lie at lo + (k + 1/2) step */
  PetscBool held[2];                                 /* ends supported */
  PetscInt links, link;
} ShortBeam;

/* Some samples in a row and the sphere that holds them. */
typedef struct {
  PetscInt beam, first, n;
  PetscReal c[3], r;
} ShortLink;

/* Nodes of two beams in one place: joined; or on one body, `gap` apart. */
typedef struct {
  PetscInt a, b; /* beams, a < b, or a = b of one that has both on a body */
  PetscReal sa, sb, gap;
} ShortJoint;

/* A beam attached to a body, `depth` inside of it. */
typedef struct {
  PetscInt beam, body;
  PetscReal s, depth, x[3]; /* m; place */
} ShortAttach;

typedef struct {
  PetscReal x[3], n[3];
} ShortWall;

typedef struct {
  PetscInt elements;
  PetscBool held[2][2]; /* first, last end: position, gradient */
  PetscReal *m;         /* |M^-1| of unit mass per length and element length, (2 elements + 2)^2 */
} ShortInverse;

struct _p_CoupleShort {
  MPI_Comm comm;
  Ancf ancf;
  Rigid rigid; /* may be NULL */
  ShortRange p;
  PetscInt persample; /* samples per diameter */
  PetscReal period[3], reach;
  CoupleAttach attach;       /* or NULL */
  PetscInt nattach, *bodyof; /* attachments of a body: bodyof[body] to bodyof[body + 1] - 1 */
  ShortAttach *attached;
  PetscInt nwalls;
  ShortWall wall[6];
  PetscBool setup, active;
  PetscInt nbeams, nnodes, nsamples, nlinks, nbodies, njoints, ajoints, ninverses;
  ShortBeam *beam;
  ShortLink *link;
  ShortJoint *joint;
  ShortInverse *inverse;
  PetscReal *e, *v; /* coordinates at the middle of the step, velocities; nodes x 6 */
  PetscReal *x;     /* samples x 3, middle of the step */
  PetscInt nhead, *head, *next;
  PetscReal half; /* s from the present to the middle of the step */
  PetscInt npairs, nalloc;
  ShortPair *pair;
  PetscReal *w, *z; /* 2 x nodes each: sums of |S|, |M^-1| w */
  PetscReal *root;  /* of each body: sum of the roots of its inverse masses */
  PetscReal *given; /* bodies x 6: force and torque to take back */
  PetscReal gap, onbeams[3], onbodies[3];
  PetscInt contacts;
  PetscBool applied;           /* forces of a step that has not been accounted for */
  CoupleExchange done, before; /* of all steps; of those before the one that began at t0 */
  PetscReal t0, h;             /* of the last CoupleShortApply(), s */
  PetscReal *place;            /* bodies x 6: centre and angular velocity then, m, rad/s */
};

/* couplenear.c: samples and links at the middle of the step; all pairs within reach. */
extern PetscErrorCode CoupleShortPlace(CoupleShort c, PetscInt beam, PetscReal s, ShortPoint *p);
extern PetscErrorCode CoupleShortFindPairs(CoupleShort c);

/* coupleshortwork.c: before and after a step of h from t. */
extern PetscErrorCode CoupleShortStart(CoupleShort c, PetscReal t, PetscReal h);
extern PetscErrorCode CoupleShortAccount(CoupleShort c);

#endif
