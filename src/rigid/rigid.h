/*
  rigid.h - public interface of the rigid bodies of Frond.

  Newton-Euler with unit quaternions (Pazouki, Serban, Negrut, Eqs. 12-17). Quaternions are q = (qx, qy, qz, qw) in the
  paper's order, Eq. 17: the FIRST entry is the scalar part of the paper's G; see docs/theory.md. Angular velocity
  is given in the body frame (omega', rad/s) unless a name says otherwise.
*/
#ifndef RIGID_H
#define RIGID_H

#include "frondsys.h"
#include "shortrange.h"
#include <petscviewer.h>

/* Rigid bodies and their integrator. */
typedef struct _p_Rigid *Rigid;

typedef struct _p_RigidGeometry *RigidGeometry; /* closed surface mesh or composite of shapes; references are counted */

/* Shapes of a rigid body. */
typedef enum { RIGID_SPHERE, RIGID_BOX, RIGID_CYLINDER, RIGID_ELLIPSOID, RIGID_CAPSULE, RIGID_MESH, RIGID_COMPOSITE } RigidShape;
/* Fixed: never moves. Prescribed: velocity and angular velocity (space frame) constant. Free: Newton-Euler. */
typedef enum { RIGID_FIXED, RIGID_PRESCRIBED, RIGID_FREE } RigidMotion;

/* A rigid body; RigidBodySpecInit() gives the defaults. */
typedef struct {
  RigidShape shape;   /* shape */
  RigidMotion motion; /* fixed, prescribed or free */
  /*
    m. sphere: radius; box: three edge lengths; cylinder, capsule (axis = body z): radius, length (of the cylindrical
    part for a capsule, whose caps come on top); ellipsoid: semi-axes. In 2D the extent along z is ignored and set to
    0, which RigidShapeDistance() takes as endless.
  */
  PetscReal size[3];
  PetscReal density;      /* kg/m^3 */
  PetscReal position[3];  /* centre of mass, m */
  PetscReal axisangle[4]; /* initial orientation: axis (any length > 0) and angle, rad */
  PetscReal velocity[3];  /* m/s */
  PetscReal omega[3];     /* space frame, rad/s */
  PetscReal mass;         /* kg; PETSC_DECIDE: from density and shape */
  PetscReal inertia[3];   /* principal moments, kg m^2; PETSC_DECIDE each: from mass and shape, homogeneous */
  PetscBool lock[6];      /* free bodies: no velocity along x, y, z, no angular velocity about x, y, z (space frame) */
  RigidGeometry geometry; /* mesh, composite: the shape, and size is not used; NULL for the others */
} RigidBodySpec;

/*
  Closed surface from an STL file (text or binary), coordinates times scale giving metres; or from nv vertices x (nv x 3, m)
  and nf facets (nf x 3 vertex numbers, counter-clockwise from outside). Refused, naming facet or edge: surfaces that are
  open or not consistently oriented, facets without area. Not found: surfaces that cut themselves. The body frame is that
  of the principal axes; RigidGeometryGetPlacement() tells where its origin lies and how it is turned in the mesh's own
  frame, in which RigidBodySpec.axisangle acts; RigidBodySpec.position is where the centre of mass goes.
*/
FROND_EXTERN PetscErrorCode RigidGeometryCreateSTL(MPI_Comm comm, const char filename[], PetscReal scale,
                                                   RigidGeometry *geometry);
/* The same from nv vertices (nv x 3, m) and nf facets (nf x 3). */
FROND_EXTERN PetscErrorCode RigidGeometryCreateMesh(MPI_Comm comm, PetscInt nv, const PetscReal x[], PetscInt nf,
                                                    const PetscInt facets[], RigidGeometry *geometry);
/*
  Rigid union of n shapes (no mesh, no composite) at their position and axisangle, each of its own density; they may touch
  but not overlap (refused, naming both). The body's density becomes the mean one. Where parts touch, the depth below the
  surface is that in the deepest part.
*/
FROND_EXTERN PetscErrorCode RigidGeometryCreateComposite(MPI_Comm comm, PetscInt dim, PetscInt n, const RigidBodySpec parts[],
                                                         RigidGeometry *geometry);
/* Volume (m^3; m^2 in 2D), centre of mass (m) and orientation of the body frame in the frame of the mesh or the parts; each
   may be NULL. */
FROND_EXTERN PetscErrorCode RigidGeometryGetPlacement(RigidGeometry geometry, PetscReal *volume, PetscReal center[3],
                                                      PetscReal q[4]);
/* Give a reference back; *geometry becomes NULL. */
FROND_EXTERN PetscErrorCode RigidGeometryDestroy(RigidGeometry *geometry);

FROND_EXTERN PetscErrorCode RigidCreate(MPI_Comm comm, Rigid *rigid);
FROND_EXTERN PetscErrorCode RigidSetOptionsPrefix(Rigid rigid, const char prefix[]);
/* dim = 2: unit depth, planar motion, shapes cut at z = 0; call it before RigidAddBody(). */
FROND_EXTERN PetscErrorCode RigidSetDimension(Rigid rigid, PetscInt dim);
FROND_EXTERN PetscErrorCode RigidBodySpecInit(RigidBodySpec *spec);
FROND_EXTERN PetscErrorCode RigidAddBody(Rigid rigid, const RigidBodySpec *spec, PetscInt *body);
FROND_EXTERN PetscErrorCode RigidSetGravity(Rigid rigid, const PetscReal g[3]);
FROND_EXTERN PetscErrorCode RigidSetFluidDensity(Rigid rigid, PetscReal rho);
/* Read -rigid_.... */
FROND_EXTERN PetscErrorCode RigidSetFromOptions(Rigid rigid);
FROND_EXTERN PetscErrorCode RigidSetUp(Rigid rigid);
/* Print the bodies; viewer NULL: standard output. */
FROND_EXTERN PetscErrorCode RigidView(Rigid rigid, PetscViewer viewer);
/* Free everything; *rigid becomes NULL. */
FROND_EXTERN PetscErrorCode RigidDestroy(Rigid *rigid);

/* Number of bodies. */
FROND_EXTERN PetscErrorCode RigidGetNumBodies(Rigid rigid, PetscInt *n);
FROND_EXTERN PetscErrorCode RigidGetBody(Rigid rigid, PetscInt body, RigidBodySpec *spec);
/* X (m), q (-), V (m/s), omega in the space frame (rad/s); each may be NULL. */
FROND_EXTERN PetscErrorCode RigidGetState(Rigid rigid, PetscInt body, PetscReal X[3], PetscReal q[4], PetscReal V[3],
                                          PetscReal omega[3]);
FROND_EXTERN PetscErrorCode RigidSetState(Rigid rigid, PetscInt body, const PetscReal X[3], const PetscReal q[4],
                                          const PetscReal V[3], const PetscReal omega[3]);
/* Time of the state, s (0 at the start). */
FROND_EXTERN PetscErrorCode RigidSetTime(Rigid rigid, PetscReal t);
/* Time of the state, s. */
FROND_EXTERN PetscErrorCode RigidGetTime(Rigid rigid, PetscReal *t);
/* The integrator's own variables, RigidGetPackSize() reals, for restarts that go on bit for bit. */
#define RIGID_PACK_SIZE 28      /* for each body */
#define RIGID_JOINT_PACK_SIZE 5 /* for each joint, after the bodies */
/* How many reals RigidPack() writes. */
FROND_EXTERN PetscErrorCode RigidGetPackSize(Rigid rigid, PetscInt *n);
FROND_EXTERN PetscErrorCode RigidPack(Rigid rigid, PetscReal state[]);
/* Back to what RigidPack() wrote. */
FROND_EXTERN PetscErrorCode RigidUnpack(Rigid rigid, const PetscReal state[]);
/* Linear and angular acceleration (space frame), m/s^2, rad/s^2, from all wrenches of the last step: applied, weight,
   short-range and joints; of a prescribed body, the slope of its table. */
FROND_EXTERN PetscErrorCode RigidGetAcceleration(Rigid rigid, PetscInt body, PetscReal A[3], PetscReal alpha[3]);
/* Rotation matrix, row major, space = R body. */
FROND_EXTERN void RigidRotationMatrix(const PetscReal q[4], PetscReal R[9]);

/*
  A prescribed body's velocity (n x 3, m/s) and angular velocity (n x 3, space frame, rad/s; NULL for none) at n times (s,
  increasing): linear between them, constant before and after. Replaces the constants of its spec.
*/
FROND_EXTERN PetscErrorCode RigidSetMotionTable(Rigid rigid, PetscInt body, PetscInt n, const PetscReal t[],
                                                const PetscReal velocity[], const PetscReal omega[]);

/* Wrench: force (N) and torque about the centre of mass (N m), space frame, held over the next RigidAdvance(). */
FROND_EXTERN PetscErrorCode RigidZeroLoads(Rigid rigid);
FROND_EXTERN PetscErrorCode RigidAddLoad(Rigid rigid, PetscInt body, const PetscReal F[3], const PetscReal T[3]);
FROND_EXTERN PetscErrorCode RigidAdvance(Rigid rigid, PetscReal t);
FROND_EXTERN PetscErrorCode RigidGetEnergy(Rigid rigid, PetscReal *kinetic, PetscReal *potential);
FROND_EXTERN PetscErrorCode RigidGetMomentum(Rigid rigid, PetscReal p[3], PetscReal L[3]);

/*
  Joints, between two bodies or a body and the ground. Positions and directions are those of the initial placement, space
  frame. The constraints are kept to round-off, positions and velocities alike, see rigidconstraint.c.
    ball    point of a = point of b
    hinge   ball, and only a turn about axis is left; stiffness, damping (N m/rad, N m s/rad) act on its angle
    slider  only a shift along axis is left; stiffness, damping (N/m, N s/m) act on it
    spring  no constraint: spring and damper between point of a and pointb of b; rest length `rest`
    linear  no constraint: spring and damper on the shift of point of a along axis, which is fixed to b
    bend    ball with rotational springs: stiffness, damping about both directions normal to axis, torsion, torsiondamping about
  it
*/
typedef enum {
  RIGID_JOINT_BALL,
  RIGID_JOINT_HINGE,
  RIGID_JOINT_SLIDER,
  RIGID_JOINT_SPRING,
  RIGID_JOINT_LINEAR,
  RIGID_JOINT_BEND
} RigidJointType;
/* In place of a body: the ground. */
#define RIGID_GROUND (-1)

/* A joint; RigidJointSpecInit() gives the defaults. */
typedef struct {
  RigidJointType type;      /* kind */
  PetscInt a, b;            /* bodies, or RIGID_GROUND for one of them */
  PetscReal point[3];       /* m */
  PetscReal pointb[3];      /* spring: its end on b, m */
  PetscReal axis[3];        /* hinge, slider, linear, bend: any length > 0 */
  PetscReal stiffness;      /* >= 0 */
  PetscReal damping;        /* >= 0 */
  PetscReal torsion;        /* bend: N m/rad, >= 0 */
  PetscReal torsiondamping; /* bend: N m s/rad, >= 0 */
  PetscReal
      rest; /* spring: length without force, m, PETSC_DECIDE: the initial one; hinge, slider, linear: rad or m from the start */
  PetscReal yield;   /* hinge, bend: moment at which a hinge yields (each direction by itself), N m; default: never */
  PetscReal rupture; /* hinge, bend: angle at which the joint breaks for good, rad; default: never */
} RigidJointSpec;

FROND_EXTERN PetscErrorCode RigidJointSpecInit(RigidJointSpec *spec);
FROND_EXTERN PetscErrorCode RigidAddJoint(Rigid rigid, const RigidJointSpec *spec, PetscInt *joint);
/* Number of joints. */
FROND_EXTERN PetscErrorCode RigidGetNumJoints(Rigid rigid, PetscInt *n);
/* Force (N) and moment about the joint's point (N m) on body a over the last step, space frame; each may be NULL. */
FROND_EXTERN PetscErrorCode RigidGetJointForce(Rigid rigid, PetscInt joint, PetscReal F[3], PetscReal M[3]);
/* Free coordinate: hinge angle (rad), slider or linear shift, spring elongation (m), largest bend angle (rad); broken: ruptured.
 */
FROND_EXTERN PetscErrorCode RigidGetJointState(Rigid rigid, PetscInt joint, PetscReal *coordinate, PetscBool *broken);
/* Largest violation of the constraints, of position (m, rad) and of velocity (m/s, rad/s), now. */
FROND_EXTERN PetscErrorCode RigidGetJointError(Rigid rigid, PetscReal *position, PetscReal *velocity);
/* Energy in the springs of the joints, J. */
FROND_EXTERN PetscErrorCode RigidGetJointEnergy(Rigid rigid, PetscReal *elastic);
/* Steps of the integrator in one RigidAdvance(), >= 1. */
FROND_EXTERN PetscErrorCode RigidSetSubsteps(Rigid rigid, PetscInt n);

/*
  Beam of rigid trunks joined by rotational springs, K = EI/dx (lumped elasticity, Capasso et al., Eqs. 10-23): trunks in a row
  are bodies of their own, hinges are bend joints. The hinge of a clamped end has 2 K.
*/
typedef enum { RIGID_END_FREE, RIGID_END_PIN, RIGID_END_CLAMP } RigidEnd;

/* A beam of rigid trunks and bend joints; RigidLumpedSpecInit() gives the defaults. */
typedef struct {
  PetscReal start[3], end[3]; /* m */
  PetscInt trunks;            /* N >= 1 */
  PetscReal section[2]; /* (d, 0): circle of diameter d; (b, h): rectangle, 3D: b = h only; in 2D h is the thickness, b is 1; m */
  PetscReal density;    /* kg/m^3 */
  PetscReal young;      /* E, Pa */
  PetscReal poisson;    /* 3D: torsion G J = E J/(2 (1 + nu)), J = 2 I */
  PetscReal EI, rhoA;   /* overrides, N m^2, kg/m (2D: N m, kg/m^2); PETSC_DECIDE: from the section */
  PetscReal velocity[3];    /* initial, m/s */
  RigidEnd end0, end1;      /* supports of the two ends */
  PetscReal damping;        /* c of the damper between the free end (end1) and the ground, N s/m; 0: none */
  PetscReal damperaxis[3];  /* its direction, any length > 0 */
  PetscReal hingedamping;   /* of each hinge, N m s/rad */
  PetscReal yield, rupture; /* of each hinge, N m, rad; default: never */
} RigidLumpedSpec;

FROND_EXTERN PetscErrorCode RigidLumpedSpecInit(RigidLumpedSpec *spec);
/* Adds `trunks` bodies and their joints; *body and *joint are the first ones (each may be NULL). */
FROND_EXTERN PetscErrorCode RigidAddLumpedBeam(Rigid rigid, const RigidLumpedSpec *spec, PetscInt *body, PetscInt *joint);
/* Ends of the trunks of a beam whose first body is `body`: (trunks + 1) x 3, m. */
FROND_EXTERN PetscErrorCode RigidGetLumpedNodes(Rigid rigid, PetscInt body, PetscInt trunks, PetscReal x[]);

/*
  Short-range forces between bodies, see shortrange.h. Two spheres: Eq. 31. A sphere and any other body: Eq. 31 with the other
  surface taken as plane. Any two other bodies: Eq. 32 over surface markers about `spacing` apart, and contact of each one's
  markers with the other's surface. Bodies that share a joint are left alone. Lubrication is for 3D only.
*/
FROND_EXTERN PetscErrorCode RigidSetShortRange(Rigid rigid, const ShortRange *p);
/* Distance of surface markers for bodies that are no spheres, m; needed if there are such. */
FROND_EXTERN PetscErrorCode RigidSetShortRangeSpacing(Rigid rigid, PetscReal spacing);
/* Periodic lengths, m; 0 for none: short-range forces act between nearest images. */
FROND_EXTERN PetscErrorCode RigidSetPeriod(Rigid rigid, const PetscReal period[3]);
/* Refuses bodies that overlap, naming both; joined bodies, and pairs of which none is free, are left alone. spacing: see above.
 */
FROND_EXTERN PetscErrorCode RigidCheckOverlap(Rigid rigid, PetscReal spacing);

/* Signed distance (m) from a point in the body frame to the surface, negative inside; exact for every shape. */
FROND_EXTERN PetscReal RigidShapeDistance(const RigidBodySpec *spec, const PetscReal xbody[3]);

/*
  Fill a body with BCE markers to a depth below its surface (Sect. 2.4, Fig. 2a), nearly dp apart: layers at depth
  dp/2, 3dp/2, ... ; outputs, allocated with PetscMalloc and owned by the caller: body-frame positions n x 3 (m), the volume that
  each stands for (m^3; area in 2D) and its depth below the surface (m). Volumes add up to the volume of the filled layers.
*/
FROND_EXTERN PetscErrorCode RigidFillMarkers(const RigidBodySpec *spec, PetscInt dim, PetscReal dp, PetscReal depthmax,
                                             PetscInt *n, PetscReal **x, PetscReal **volume, PetscReal **depth);

#endif
