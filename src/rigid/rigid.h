/*
  rigid.h - public interface of the rigid bodies of Frond.

  Newton-Euler with unit quaternions (Pazouki, Serban, Negrut, Eqs. 12-17). Quaternions are q = (qx, qy, qz, qw) in the
  paper's order, Eq. 17: the FIRST entry is the scalar part of the paper's G; see docs/theory.md. Angular velocity
  is given in the body frame (omega', rad/s) unless a name says otherwise.
*/
#ifndef RIGID_H
#define RIGID_H

#include "frondstate.h"
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
  Closed surface from an STL file, text or binary. Refused, naming facet or edge: surfaces that are open or not consistently
  oriented, facets without area. Not found: surfaces that cut themselves. The body frame is that of the principal axes;
  RigidGeometryGetPlacement() tells where its origin lies and how it is turned in the mesh's own frame, in which
  RigidBodySpec.axisangle acts; RigidBodySpec.position is where the centre of mass goes. comm: communicator of the errors.
  filename: path. scale: > 0; coordinates times it are metres. geometry: the new geometry.
*/
FROND_EXTERN PetscErrorCode RigidGeometryCreateSTL(MPI_Comm comm, const char filename[], PetscReal scale,
                                                   RigidGeometry *geometry);
/*
  The same from an OBJ file: lines "v x y z" and "f a b c ...", the numbers of vertices from 1, or from the last one back if
  negative; what follows a number behind a '/' and all other lines are passed over. Facets of more than three corners must be
  convex; they are cut into triangles from their first corner. comm: communicator of the errors. filename: path. scale: > 0;
  coordinates times it are metres. geometry: the new geometry.
*/
FROND_EXTERN PetscErrorCode RigidGeometryCreateOBJ(MPI_Comm comm, const char filename[], PetscReal scale,
                                                   RigidGeometry *geometry);
/*
  The same from an OBJ file when its name ends in .obj, else from an STL file. comm: communicator of the errors. filename: path.
  scale: > 0; coordinates times it are metres. geometry: the new geometry.
*/
FROND_EXTERN PetscErrorCode RigidGeometryCreateFile(MPI_Comm comm, const char filename[], PetscReal scale,
                                                    RigidGeometry *geometry);
/*
  The same from arrays, copied. comm: communicator of the errors. nv: number of vertices. x: nv x 3, m. nf: number of facets.
  facets: nf x 3 vertex numbers, counter-clockwise from outside. geometry: the new geometry.
*/
FROND_EXTERN PetscErrorCode RigidGeometryCreateMesh(MPI_Comm comm, PetscInt nv, const PetscReal x[], PetscInt nf,
                                                    const PetscInt facets[], RigidGeometry *geometry);
/*
  Rigid union of shapes (no mesh, no composite) at their position and axisangle, each of its own density; they may touch but
  not overlap (refused, naming both). The body's density becomes the mean one. Where parts touch, the depth below the surface
  is that in the deepest part. comm: communicator of the errors. dim: 2 or 3. n: number of parts, >= 1. parts: n specs,
  copied. geometry: the new geometry.
*/
FROND_EXTERN PetscErrorCode RigidGeometryCreateComposite(MPI_Comm comm, PetscInt dim, PetscInt n, const RigidBodySpec parts[],
                                                         RigidGeometry *geometry);
/*
  In the frame of the mesh or the parts; each output may be NULL. geometry: mesh or composite. volume: m^3 (2D: m^2). center:
  3, centre of mass, m. q: 4, orientation of the body frame (-).
*/
FROND_EXTERN PetscErrorCode RigidGeometryGetPlacement(RigidGeometry geometry, PetscReal *volume, PetscReal center[3],
                                                      PetscReal q[4]);
/*
  Signed distance of a point to the surface where the file or the parts have it, m, negative inside. geometry: mesh or composite.
  x: 3, m.
*/
FROND_EXTERN PetscReal RigidGeometryGetDistance(RigidGeometry geometry, const PetscReal x[3]);
/* A box about it in the same frame. geometry: mesh or composite. lo, hi: 3, m. */
FROND_EXTERN PetscErrorCode RigidGeometryGetBounds(RigidGeometry geometry, PetscReal lo[3], PetscReal hi[3]);
/* Give a reference back. geometry: becomes NULL. */
FROND_EXTERN PetscErrorCode RigidGeometryDestroy(RigidGeometry *geometry);

/*
  No bodies, no gravity, dim = 3, t = 0. Every rank holds every body and must make the same calls. comm: communicator. rigid:
  the new object.
*/
FROND_EXTERN PetscErrorCode RigidCreate(MPI_Comm comm, Rigid *rigid);
/* prefix: options are then -<prefix>rigid_gravity and so on; copied. */
FROND_EXTERN PetscErrorCode RigidSetOptionsPrefix(Rigid rigid, const char prefix[]);
/* Before RigidAddBody(). dim: 3 (default), or 2: unit depth, planar motion, shapes cut at z = 0. */
FROND_EXTERN PetscErrorCode RigidSetDimension(Rigid rigid, PetscInt dim);
/*
  A free sphere of water's density at rest in the origin, without a radius; mass and inertia from the shape; no locks. spec:
  to be filled.
*/
FROND_EXTERN PetscErrorCode RigidBodySpecInit(RigidBodySpec *spec);
/*
  Append a body, before RigidSetUp(); errors name the body, the field, its value and the rule. spec: copied. body: its number,
  or NULL.
*/
FROND_EXTERN PetscErrorCode RigidAddBody(Rigid rigid, const RigidBodySpec *spec, PetscInt *body);
/* Gravitational acceleration. g: 3, space frame, m/s^2, finite, default 0. */
FROND_EXTERN PetscErrorCode RigidSetGravity(Rigid rigid, const PetscReal g[3]);
/* For fluids whose own hydrostatic pressure is left out: bodies weigh (m - rho V) g. rho: kg/m^3, >= 0; 0 (default): m g. */
FROND_EXTERN PetscErrorCode RigidSetFluidDensity(Rigid rigid, PetscReal rho);
/* Gravitational acceleration of one body in place of RigidSetGravity()'s; displaced fluid keeps that one. body: number. g: 3,
   space frame, m/s^2, finite. */
FROND_EXTERN PetscErrorCode RigidSetBodyGravity(Rigid rigid, PetscInt body, const PetscReal g[3]);
/* A permanent load on a body, until it is set again; not part of its state. body: number. F: 3, in the centre of mass, N. T: 3,
   torque about it, N m; both of fixed direction, finite; NULL for none. */
FROND_EXTERN PetscErrorCode RigidSetBodyLoad(Rigid rigid, PetscInt body, const PetscReal F[3], const PetscReal T[3]);
/* Read -rigid_... (with the prefix). */
FROND_EXTERN PetscErrorCode RigidSetFromOptions(Rigid rigid);
/* Mass properties and initial state; after it the state functions may be called and bodies no longer added. */
FROND_EXTERN PetscErrorCode RigidSetUp(Rigid rigid);
/* Print the bodies. viewer: an ASCII viewer; NULL: standard output. */
FROND_EXTERN PetscErrorCode RigidView(Rigid rigid, PetscViewer viewer);
/* Free everything. rigid: becomes NULL. */
FROND_EXTERN PetscErrorCode RigidDestroy(Rigid *rigid);

/* n: number of bodies. */
FROND_EXTERN PetscErrorCode RigidGetNumBodies(Rigid rigid, PetscInt *n);
/* body: number. spec: the fields as given to RigidAddBody(); mass and inertia as used once RigidSetUp() was called. */
FROND_EXTERN PetscErrorCode RigidGetBody(Rigid rigid, PetscInt body, RigidBodySpec *spec);
/*
  Each output may be NULL. body: number. X: 3, centre of mass, m. q: 4, quaternion (-). V: 3, m/s. omega: 3, angular velocity,
  space frame, rad/s.
*/
FROND_EXTERN PetscErrorCode RigidGetState(Rigid rigid, PetscInt body, PetscReal X[3], PetscReal q[4], PetscReal V[3],
                                          PetscReal omega[3]);
/*
  NULL leaves a part as it is (for omega: keeps the angular velocity). Locked directions of V and omega are set to 0. body:
  number. X: 3, m. q: 4, any length > 0. V: 3, m/s. omega: 3, space frame, rad/s.
*/
FROND_EXTERN PetscErrorCode RigidSetState(Rigid rigid, PetscInt body, const PetscReal X[3], const PetscReal q[4],
                                          const PetscReal V[3], const PetscReal omega[3]);
/* t: time of the state, s (0 at the start). */
FROND_EXTERN PetscErrorCode RigidSetTime(Rigid rigid, PetscReal t);
/* t: time of the state, s. */
FROND_EXTERN PetscErrorCode RigidGetTime(Rigid rigid, PetscReal *t);
/* The integrator's own variables, RigidGetPackSize() reals, for restarts that go on bit for bit. */
#define RIGID_PACK_SIZE 28      /* for each body */
#define RIGID_JOINT_PACK_SIZE 5 /* for each joint, after the bodies */
#define RIGID_LEDGER_SIZE 7     /* at the end: sums of RigidGetAudit() */
/* n: how many reals RigidPack() writes: RIGID_PACK_SIZE a body, RIGID_JOINT_PACK_SIZE a joint, and RIGID_LEDGER_SIZE. */
FROND_EXTERN PetscErrorCode RigidGetPackSize(Rigid rigid, PetscInt *n);
/*
  The integrator's own variables, for restarts that go on bit for bit; the time is not among them, see RigidGetTime(). state:
  RigidGetPackSize() reals, written.
*/
FROND_EXTERN PetscErrorCode RigidPack(Rigid rigid, PetscReal state[]);
/* Back to what RigidPack() wrote. state: RigidGetPackSize() reals. */
FROND_EXTERN PetscErrorCode RigidUnpack(Rigid rigid, const PetscReal state[]);
/* Time and the packed state as named arrays, see frondstate.h. state: saved to or loaded from. */
FROND_EXTERN PetscErrorCode RigidMoveState(Rigid rigid, FrondState *state);
/*
  From all wrenches of the last step: applied, weight, short-range (their mean over it) and joints (before the first one, from the
  loads collected so far); of a prescribed body, the slope of its table. Each output may be NULL. body: number. A: 3, m/s^2.
  alpha: 3, space frame, rad/s^2.
*/
FROND_EXTERN PetscErrorCode RigidGetAcceleration(Rigid rigid, PetscInt body, PetscReal A[3], PetscReal alpha[3]);
/* q: 4, unit quaternion. R: 9, row major, space = R body. Source: the paper, Eq. 17. */
FROND_EXTERN void RigidRotationMatrix(const PetscReal q[4], PetscReal R[9]);

/*
  Velocities of a prescribed body: linear between the times, constant before and after; replaces the constants of its spec.
  body: number. n: number of times, >= 1. t: n, s, increasing. velocity: n x 3, m/s. omega: n x 3, space frame, rad/s; NULL
  for none.
*/
FROND_EXTERN PetscErrorCode RigidSetMotionTable(Rigid rigid, PetscInt body, PetscInt n, const PetscReal t[],
                                                const PetscReal velocity[], const PetscReal omega[]);

/* Forget the wrenches of RigidAddLoad(). */
FROND_EXTERN PetscErrorCode RigidZeroLoads(Rigid rigid);
/*
  Add a wrench, held over the next RigidAdvance(). Fixed and prescribed bodies take loads and ignore them. body: number. F: 3,
  N, or NULL for none. T: 3, about the centre of mass, space frame, N m, or NULL for none. Source: the paper, Eqs. 12 and 13.
*/
FROND_EXTERN PetscErrorCode RigidAddLoad(Rigid rigid, PetscInt body, const PetscReal F[3], const PetscReal T[3]);
/*
  Integrate in -rigid_substeps steps, see rigidstep.c and rigidconstraint.c. t: s, not in the past. Source: the paper, Eqs.
  12-17.
*/
FROND_EXTERN PetscErrorCode RigidAdvance(Rigid rigid, PetscReal t);
/*
  Each output may be NULL. kinetic: of free and prescribed bodies, J. potential: -g.(m X - rho V X_v) of the free ones, X_v
  the centroid of the volume, J.
*/
FROND_EXTERN PetscErrorCode RigidGetEnergy(Rigid rigid, PetscReal *kinetic, PetscReal *potential);
/*
  Sums over the free and prescribed bodies; each output may be NULL. p: 3, m V, kg m/s. L: 3, about the origin, m X x V + J w,
  kg m^2/s.
*/
FROND_EXTERN PetscErrorCode RigidGetMomentum(Rigid rigid, PetscReal p[3], PetscReal L[3]);

/* What RigidGetAudit() tells of the free bodies. Sums begin at set-up. */
typedef struct {
  PetscReal kinetic;                     /* now, J */
  PetscReal contact;                     /* elastic energy of contacts now, J */
  PetscReal lubrication, impact, joints; /* energy taken by lubrication, by the damping of contacts, by dampers, yield and rupture
                                            of joints, J */
  PetscReal driven;     /* work of bodies that are not free, through contacts and joints, and of permanent torques, J */
  PetscReal angular[3]; /* angular momentum about the origin now, kg m^2/s */
  PetscReal turn[3];    /* angular impulse about the origin of weight, permanent loads, walls, the ground and bodies that are not
                           free,    N m s */
} RigidAudit;
/*
  Balances of the free bodies: kinetic + potential (RigidGetEnergy()) + springs (RigidGetJointEnergy()) + contact + lubrication +
  impact + joints - driven changes by the work of the loads of RigidAddLoad(), angular - turn by their angular impulse; what is
  left is the error of the time integration. Locks that hold a body back are not in turn. audit: to be filled.
*/
FROND_EXTERN PetscErrorCode RigidGetAudit(Rigid rigid, RigidAudit *audit);

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

/* A ball joint of nothing yet: bodies, point and axis must be set. spec: to be filled. */
FROND_EXTERN PetscErrorCode RigidJointSpecInit(RigidJointSpec *spec);
/*
  Append a joint, before RigidSetUp(); errors name the joint, the field, its value and the rule. spec: copied. joint: its
  number, or NULL.
*/
FROND_EXTERN PetscErrorCode RigidAddJoint(Rigid rigid, const RigidJointSpec *spec, PetscInt *joint);
/* n: number of joints. */
FROND_EXTERN PetscErrorCode RigidGetNumJoints(Rigid rigid, PetscInt *n);
/*
  On body a over the last step, space frame; each output may be NULL. joint: number. F: 3, force, N. M: 3, moment about the
  joint's point, N m.
*/
FROND_EXTERN PetscErrorCode RigidGetJointForce(Rigid rigid, PetscInt joint, PetscReal F[3], PetscReal M[3]);
/*
  Each output may be NULL. joint: number. coordinate: hinge angle (rad), slider or linear shift (m), spring elongation (m),
  largest bend angle (rad). broken: ruptured.
*/
FROND_EXTERN PetscErrorCode RigidGetJointState(Rigid rigid, PetscInt joint, PetscReal *coordinate, PetscBool *broken);
/* Largest violation of the constraints now; each output may be NULL. position: m or rad. velocity: m/s or rad/s. */
FROND_EXTERN PetscErrorCode RigidGetJointError(Rigid rigid, PetscReal *position, PetscReal *velocity);
/* elastic: energy in the springs of the joints, J. */
FROND_EXTERN PetscErrorCode RigidGetJointEnergy(Rigid rigid, PetscReal *elastic);
/*
  Free bodies need one step only; joints with stiff springs or fast mechanisms may need more. n: steps of the integrator in
  one RigidAdvance(), >= 1.
*/
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

/* No section, trunks or stiffness yet; free at both ends; no dampers. spec: to be filled. */
FROND_EXTERN PetscErrorCode RigidLumpedSpecInit(RigidLumpedSpec *spec);
/*
  Add `trunks` bodies and their joints, before RigidSetUp(). spec: copied. body: number of the first body, or NULL. joint:
  number of the first joint, or NULL. Source: Capasso et al., Eqs. 10-23.
*/
FROND_EXTERN PetscErrorCode RigidAddLumpedBeam(Rigid rigid, const RigidLumpedSpec *spec, PetscInt *body, PetscInt *joint);
/* Ends of the trunks of a beam. body: its first body. trunks: how many. x: (trunks + 1) x 3, m. */
FROND_EXTERN PetscErrorCode RigidGetLumpedNodes(Rigid rigid, PetscInt body, PetscInt trunks, PetscReal x[]);

/*
  Short-range forces between bodies, see shortrange.h; before RigidSetUp(). Two spheres: Eq. 31. A sphere and any other body: Eq.
  31 with the other surface taken as plane. Any two other bodies: Eq. 32 over surface markers, and contact of each one's markers
  with the other's surface. Bodies that share a joint are left alone. Lubrication is for 3D only. p: parameters, copied. Source:
  the paper, Eqs. 31 and 32.
*/
FROND_EXTERN PetscErrorCode RigidSetShortRange(Rigid rigid, const ShortRange *p);
/* Distance of surface markers, needed when there are bodies that are no spheres. spacing: m, > 0; 0 (default): none. */
FROND_EXTERN PetscErrorCode RigidSetShortRangeSpacing(Rigid rigid, PetscReal spacing);
/* Short-range forces act between nearest images. period: 3, m; 0 for none. */
FROND_EXTERN PetscErrorCode RigidSetPeriod(Rigid rigid, const PetscReal period[3]);
/*
  A flat wall for the short-range forces, at most 6; it does not move along its normal. Lubrication: Eq. 31 with a plane, for
  spheres and for each surface marker (of size spacing) of other bodies. Bodies joined to the ground are left alone. x: 3, a
  point of its face, m. normal: 3, into the free side, of any length > 0.
*/
FROND_EXTERN PetscErrorCode RigidAddWall(Rigid rigid, const PetscReal x[3], const PetscReal normal[3]);
/* Gap between a place x (m) and walls, m, < 0 in them; ctx is the caller's. It is a distance: it changes by |x - y| at most. */
typedef PetscReal (*RigidWallGap)(const PetscReal x[3], void *ctx);
/*
  Walls of any shape that do not move, one at most, besides those of RigidAddWall(): forces act as at a plane in the nearest
  point. Its normal comes from central differences. gap: gap to the walls. ctx: its second argument.
*/
FROND_EXTERN PetscErrorCode RigidAddWallGap(Rigid rigid, RigidWallGap gap, void *ctx);
/* What other solvers need for short-range forces on a body. body: number. radius: of a sphere about its centre that holds it, m.
 */
FROND_EXTERN PetscErrorCode RigidGetRadius(Rigid rigid, PetscInt body, PetscReal *radius);
/*
  Gap between a point and the surface of a body where it is now. body: number. x: 3, the point, m. gap: m, negative inside. n: 3,
  unit normal of the surface there, space frame, or NULL.
*/
FROND_EXTERN PetscErrorCode RigidGetGap(Rigid rigid, PetscInt body, const PetscReal x[3], PetscReal *gap, PetscReal n[3]);
/*
  Inverse effective mass of a body at a point of action: n.dv per unit impulse along n; 0 for bodies that are not free. body:
  number. n: 3, unit vector. r: 3, from the centre of mass, m. w: 1/kg.
*/
FROND_EXTERN PetscErrorCode RigidGetInverseMass(Rigid rigid, PetscInt body, const PetscReal n[3], const PetscReal r[3],
                                                PetscReal *w);
/*
  Refuse bodies that overlap, naming both, and free bodies that overlap a wall; joined bodies, and pairs of which none is free,
  are left alone. spacing: distance of surface markers, m, as RigidSetShortRangeSpacing().
*/
FROND_EXTERN PetscErrorCode RigidCheckOverlap(Rigid rigid, PetscReal spacing);

/*
  Signed distance to the surface (m), negative inside; exact for every shape. spec: the body; its placement is not used.
  xbody: 3, point in the body frame, m.
*/
FROND_EXTERN PetscReal RigidShapeDistance(const RigidBodySpec *spec, const PetscReal xbody[3]);

/*
  Fill a body with BCE markers in layers at depth dp/2, 3dp/2, ... below its surface, nearly dp apart; volumes add up to the
  volume of the layers. spec: the body. dim: 2 or 3. dp: spacing, m, > 0. depthmax: how deep, m. n: number of markers. x: n x
  3, body frame, m. volume: n, m^3 (2D: m^2). depth: n, m below the surface; the caller frees the three arrays with
  PetscFree(). Source: the paper, Sect. 2.4, Fig. 2a.
*/
FROND_EXTERN PetscErrorCode RigidFillMarkers(const RigidBodySpec *spec, PetscInt dim, PetscReal dp, PetscReal depthmax,
                                             PetscInt *n, PetscReal **x, PetscReal **volume, PetscReal **depth);

/*
  Refuse a body whose smallest extent is below the spacing, as RigidFillMarkers() does, without laying out any marker. spec: the
  body. dim: 2 or 3. dp: spacing, m, > 0.
*/
FROND_EXTERN PetscErrorCode RigidFillCheck(const RigidBodySpec *spec, PetscInt dim, PetscReal dp);

#endif
