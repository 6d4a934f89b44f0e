/* rigidimpl.h - private: the object behind Rigid and what its files share. */
#ifndef RIGIDIMPL_H
#define RIGIDIMPL_H

#include "rigid.h"
#include "rigidrotation.h"

typedef struct {
  RigidBodySpec spec;     /* as given; mass and inertia are filled in by RigidSetUp() */
  PetscReal volume;       /* m^3; per metre of depth in 2D (m^2) */
  PetscReal X[3];         /* centre of mass, m */
  PetscReal q[4];         /* orientation */
  PetscReal V[3];         /* m/s */
  PetscReal L[3];         /* free: angular momentum about the centre of mass, space frame, kg m^2/s; locked components unused */
  PetscReal w[3];         /* prescribed: angular velocity, space frame, rad/s */
  PetscReal F[3], T[3];   /* wrench collected for the next step, N, N m */
  PetscReal Fs[3], Ts[3]; /* short-range wrench of the present half step */
  PetscReal Fm[3], Tm[3]; /* mean of it over the half steps of RigidAdvance() */
  PetscReal Fused[3], Tused[3]; /* all wrenches of the last step but gravity's */
  PetscReal load[3], moment[3]; /* permanent, N, N m */
  PetscReal g[3];               /* own gravity, m/s^2 */
  PetscBool owng;               /* whether that takes the place of the common one */
  PetscInt ntable;              /* prescribed: motion table, times and n x 6 velocities; NULL for constants */
  PetscReal *tabletime, *table;
} RigidBody;

#define RIGID_MAX_ROWS 7

/* One scalar of a joint: a constraint g = 0 (hard) or a spring and damper on g. Jacobian: dg/dt = Ja.(Va, wa) + Jb.(Vb, wb). */
typedef struct {
  PetscReal g, Ja[6], Jb[6];
} RigidRow;

typedef struct {
  RigidJointSpec spec;
  PetscReal ra[3], rb[3];         /* anchors, body frames, m */
  PetscReal ua[3], ub[3];         /* axis in the frames of a and b */
  PetscReal ta[2][3], tb[2][3];   /* normals of the axis: the axes a t, b t and u are a right-handed triad at the start */
  PetscReal qrel[4];              /* initial q_b^-1 q_a */
  PetscInt nrows, first;          /* rows of the system */
  PetscBool hard[RIGID_MAX_ROWS]; /* else: */
  PetscReal k[RIGID_MAX_ROWS], c[RIGID_MAX_ROWS];
  PetscReal rest[3];               /* of the soft rows, plastic part included */
  PetscReal angle;                 /* hinge: last angle, to count turns */
  PetscReal force[RIGID_MAX_ROWS]; /* multipliers of the last step */
  PetscBool broken;
} RigidJoint;

typedef struct _p_RigidContact *RigidContact; /* rigidcontact.c */
typedef struct _p_RigidSystem *RigidSystem;   /* rigidconstraint.c */

/* What bodies keep out of: behind a plane, given by a point of its face, m, and the unit normal out of it, or where gap < 0. */
typedef struct {
  PetscReal x[3], n[3];
  RigidWallGap gap; /* NULL: a plane */
  void *ctx;
} RigidWall;

/* Since set-up, part of the packed state: RigidAudit says what they are. */
typedef struct {
  PetscReal lubrication, impact, joints, driven, turn[3];
} RigidLedger;

struct _p_Rigid {
  MPI_Comm comm;
  char *prefix;
  PetscInt dim;       /* 2 or 3 */
  PetscInt n, nalloc; /* bodies */
  RigidBody *body;
  PetscReal g[3];     /* m/s^2 */
  PetscReal rhofluid; /* kg/m^3; > 0: gravity is reduced by the displaced fluid */
  PetscReal t;        /* s */
  PetscInt substeps;
  PetscInt njoints, njointalloc;
  RigidJoint *joint;
  RigidSystem system; /* NULL without joints */
  ShortRange shortrange;
  PetscReal spacing, period[3];
  PetscInt nwalls;
  RigidWall wall[7];    /* 6 planes, and one of any shape */
  RigidContact contact; /* NULL without short-range forces */
  RigidLedger ledger;
  PetscBool setup, advanced;
};

extern PetscLogEvent RIGID_Advance, RIGID_Fill, RIGID_Contact;
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

/* rigidjoint.c */
extern const char *RigidJointName(RigidJointType type);
extern PetscErrorCode RigidJointSetUp(Rigid rigid, PetscInt j);
extern void RigidJointRows(Rigid rigid, RigidJoint *joint, RigidRow row[]);

/* rigidconstraint.c */
extern PetscErrorCode RigidSystemCreate(Rigid rigid);
extern PetscErrorCode RigidSystemDestroy(Rigid rigid);
extern PetscErrorCode RigidSystemProjectVelocity(Rigid rigid);
extern PetscErrorCode RigidSystemBegin(Rigid rigid, PetscReal dt);
extern PetscErrorCode RigidSystemEnd(Rigid rigid, PetscReal dt);
extern PetscErrorCode RigidSystemHasBody(Rigid rigid, PetscInt i, PetscBool *has);

/* rigidsurface.c */
extern PetscBool RigidShapeNormal(const RigidBodySpec *s, PetscInt dim, const PetscReal x[3], PetscReal step, PetscReal n[3]);
extern PetscErrorCode RigidSurfacePoints(const RigidBodySpec *s, PetscInt dim, PetscReal spacing, RigidMarkers *m);
extern PetscErrorCode RigidCheckCount(const RigidBodySpec *s, PetscInt dim, PetscReal spacing, PetscReal depth);

/* rigidcontact.c */
extern PetscErrorCode RigidContactSetUp(Rigid rigid);
extern PetscErrorCode RigidContactDestroy(RigidContact *c);
extern PetscErrorCode RigidContactForces(Rigid rigid, PetscReal kick);
extern PetscErrorCode RigidContactEnergy(Rigid rigid, PetscReal *elastic);

/* rigidaudit.c */
extern PetscErrorCode RigidAuditContacts(Rigid rigid, PetscReal kick);
extern void RigidAuditLoads(Rigid rigid, PetscReal h);

/* rigidtable.c */
extern void RigidTableVelocity(const RigidBody *b, PetscReal t, PetscReal v[6], PetscReal a[6]);
extern void RigidTableIntegral(const RigidBody *b, PetscReal t0, PetscReal t1, PetscReal d[6]);
extern void RigidTableApply(RigidBody *b, PetscReal t);

/* rigidstep.c */
extern void RigidBodyMobility(const RigidBody *b, const PetscReal J[6], PetscReal W[6]);
extern void RigidBodyOmega(const RigidBody *b, const PetscReal q[4], PetscReal w[3]);
extern void RigidBodySetOmega(RigidBody *b, const PetscReal w[3]);
extern void RigidBodyWeight(Rigid rigid, const RigidBody *b, PetscReal F[3], PetscReal T[3]);
extern PetscReal RigidBodyPotential(Rigid rigid, const RigidBody *b);
extern void RigidBodyAcceleration(Rigid rigid, const RigidBody *b, PetscReal A[3], PetscReal alpha[3]);
extern void RigidBodyKick(RigidBody *b, const PetscReal F[3], const PetscReal T[3], PetscReal dt);
extern void RigidBodyKickApplied(Rigid rigid, RigidBody *b, PetscReal dt);
extern PetscErrorCode RigidBodyDrift(Rigid rigid, PetscInt i, PetscReal dt);
extern PetscErrorCode RigidBodyCheckLoad(Rigid rigid, PetscInt i);
extern PetscErrorCode RigidBodyBegin(Rigid rigid, PetscInt i, PetscReal dt);
extern void RigidBodyEnd(Rigid rigid, PetscInt i, PetscReal dt);

#endif
