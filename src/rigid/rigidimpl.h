/* rigidimpl.h - private: the object behind Rigid and what its files share. */
#ifndef RIGIDIMPL_H
#define RIGIDIMPL_H

#include "rigid.h"
#include "rigidrotation.h"

typedef struct {
  RigidBodySpec spec;   /* as given; mass and inertia are filled in by RigidSetUp() */
  PetscReal volume;     /* m^3; per metre of depth in 2D (m^2) */
  PetscReal X[3];       /* centre of mass, m */
  PetscReal q[4];       /* orientation */
  PetscReal V[3];       /* m/s */
  PetscReal L[3];       /* free: angular momentum about the centre of mass, space frame, kg m^2/s; locked components unused */
  PetscReal w[3];       /* prescribed: angular velocity, space frame, rad/s */
  PetscReal F[3], T[3]; /* wrench collected for the next step, N, N m */
  PetscReal Fused[3], Tused[3]; /* wrench of the last step, gravity not included */
} RigidBody;

struct _p_Rigid {
  MPI_Comm comm;
  char *prefix;
  PetscInt dim;       /* 2 or 3 */
  PetscInt n, nalloc; /* bodies */
  RigidBody *body;
  PetscReal g[3];     /* m/s^2 */
  PetscReal rhofluid; /* kg/m^3; > 0: gravity is reduced by the displaced fluid */
  PetscReal t;        /* s */
  PetscBool setup, advanced;
};

extern PetscLogEvent RIGID_Advance, RIGID_Fill;
extern PetscErrorCode RigidRegisterEvents(void);

/* rigidshape.c: volume (m^3, area in 2D), principal moments per unit density (m^5; m^4 in 2D), smallest extent (m). */
extern PetscReal RigidShapeVolume(const RigidBodySpec *spec, PetscInt dim);
extern void RigidShapeMoments(const RigidBodySpec *spec, PetscInt dim, PetscReal J[3]);
extern PetscReal RigidShapeSmallest(const RigidBodySpec *spec, PetscInt dim);
extern PetscInt RigidShapeNumSizes(RigidShape shape, PetscInt dim);
extern const char *RigidShapeName(RigidShape shape);
extern PetscErrorCode RigidSpecCheck(MPI_Comm comm, PetscInt body, PetscInt dim, const RigidBodySpec *spec);

/* rigidfill.c, rigidpack.c */
typedef struct {
  PetscInt n, nalloc;
  PetscReal *x, *volume, *depth; /* n x 3, n, n; m, m^3 (m^2 in 2D), m */
} RigidMarkers;
extern PetscErrorCode RigidMarkersAdd(RigidMarkers *m, PetscReal x, PetscReal y, PetscReal z, PetscReal volume);
extern PetscErrorCode RigidPackMarkers(RigidMarkers *m, const RigidBodySpec *spec, PetscInt dim, PetscReal dp,
                                       PetscReal depthmax);

/* rigidstep.c */
extern void RigidBodyOmega(const RigidBody *b, const PetscReal q[4], PetscReal w[3]);
extern void RigidBodySetOmega(RigidBody *b, const PetscReal w[3]);
extern void RigidBodyWeight(Rigid rigid, const RigidBody *b, PetscReal F[3], PetscReal T[3]);
extern PetscReal RigidBodyPotential(Rigid rigid, const RigidBody *b);
extern void RigidBodyAcceleration(Rigid rigid, const RigidBody *b, PetscReal A[3], PetscReal alpha[3]);
extern void RigidBodyKick(RigidBody *b, const PetscReal F[3], const PetscReal T[3], PetscReal dt);
extern void RigidBodyKickApplied(Rigid rigid, RigidBody *b, PetscReal dt);
extern PetscErrorCode RigidBodyDrift(Rigid rigid, PetscInt i, PetscReal dt);
extern PetscErrorCode RigidBodyAdvance(Rigid rigid, PetscInt i, PetscReal dt);

#endif
