/*
  ancf.h - public interface of the slender beams of Frond.

  Gradient-deficient ANCF cable elements (Pazouki, Serban, Negrut, Eqs. 18-30): each node carries six
  coordinates e_j = [r_j, r_j,x], position (m) and position gradient (-). All beams of one Ancf object are one
  block-tridiagonal system, integrated by PETSc TS (prefix -ancf_).

  Array layout: node arrays are nodes x 6, node by node, beam after beam in the order of AncfAddBeam.
*/
#ifndef ANCF_H
#define ANCF_H

#include "frondstate.h"
#include <petscts.h>

/* Beams and their solver. */
typedef struct _p_Ancf *Ancf;

/* Strain measures: PAPER eps = (r'.r'-1)/2, kappa = |r' x r''|/|r'|^3; ENGINEERING eps = |r'|-1, kappa = |r' x r''|/|r'|^2. */
typedef enum { ANCF_STRAIN_PAPER, ANCF_STRAIN_ENGINEERING } AncfStrain;
/* Constraints by elimination of coordinates, or with Lagrange multipliers. */
typedef enum { ANCF_CONSTRAINTS_ELIMINATE, ANCF_CONSTRAINTS_MULTIPLIERS } AncfConstraints;

/* What a beam end may do. Free: all 6 coordinates; pin: position fixed; clamp: position and gradient fixed. */
typedef enum { ANCF_END_FREE, ANCF_END_PIN, ANCF_END_CLAMP } AncfEnd;

/* Straight or arched beam of a circular, annular or rectangular section; every field must be set. AncfBeamSpecInit() gives the
 * defaults. */
typedef struct {
  PetscReal start[3];                     /* first node, m */
  PetscReal end[3];                       /* last node, m; |end-start| is the length L, of an arc its chord */
  PetscInt elements;                      /* number of elements, >= 1 */
  PetscReal diameter;                     /* d, m: the outer diameter that the fluid sees; A = pi d^2/4, I = pi d^4/64 */
  PetscReal density;                      /* rho_s, kg/m^3 */
  PetscReal young;                        /* E, Pa */
  PetscReal axialdamping, bendingdamping; /* retardation times tau, s, of N = EA (eps + tau deps/dt) and M alike */
  PetscReal EA, EI, rhoA;                 /* overrides, N, N m^2, kg/m; PETSC_DECIDE (-1): derived from d, E, rho_s */
  PetscReal inner;                        /* inner diameter of a tube, m; default 0 */
  PetscReal width, thickness;             /* rectangle: along the normal and across, m; default 0: none; diameter may be 0 then */
  PetscReal pretension;                   /* axial force in the initial shape, N, within +-EA; default 0 */
  PetscReal curvature, normal[3]; /* the axis is an arc from start to end, free of bending: 1/m, turning about the normal; a
                                             normal, not zero, declares that the beam moves in the plane across it, and refuses
                                     other motion. A rectangle that is no square needs it: the element carries one EI */
  const PetscReal *curve; /* or any curve in the plane across the normal, free of stress: (elements + 1) x 6, r (m) and its
                             gradient by the length, nodes evenly spaced along it; copied; NULL: none. start and end are
                             its ends, curvature is 0 */
  PetscReal curvelength;  /* its length, m */
  PetscReal velocity[3];  /* initial velocity, m/s */
  AncfEnd end0, end1;     /* boundary conditions at start and end */
} AncfBeamSpec;

/* An empty set of beams. comm: communicator of one rank: beams are not shared out among processes. ancf: the new set. */
FROND_EXTERN PetscErrorCode AncfCreate(MPI_Comm comm, Ancf *ancf);
/* prefix: options are then -<prefix>ancf_gravity, -<prefix>ancf_ts_type and so on; copied. */
FROND_EXTERN PetscErrorCode AncfSetOptionsPrefix(Ancf ancf, const char prefix[]);
/* Four elements, everything free, EA, EI, rhoA derived; the rest is invalid until set. spec: to be filled. */
FROND_EXTERN PetscErrorCode AncfBeamSpecInit(AncfBeamSpec *spec);
/*
  EA, EI and rhoA of an annulus from diameter, young and density, which must be set. spec: the beam. inner: inner diameter, m,
  in [0, diameter).
*/
FROND_EXTERN PetscErrorCode AncfBeamSpecSetAnnulus(AncfBeamSpec *spec, PetscReal inner);
/*
  Where a beam lies at first. spec: the beam. s: fraction of the length, in [0, 1]. e: 6, position, m, and its gradient, of the
  line, arc or curve.
*/
FROND_EXTERN PetscErrorCode AncfBeamSpecGetPoint(const AncfBeamSpec *spec, PetscReal s, PetscReal e[6]);
/* Append a beam, before AncfSetUp(). spec: copied. beam: its number, or NULL. */
FROND_EXTERN PetscErrorCode AncfAddBeam(Ancf ancf, const AncfBeamSpec *spec, PetscInt *beam);
/*
  Support any node, before AncfSetUp(); the ends may also be supported in the spec. beam: number. node: of the beam, 0 is its
  start. how: ANCF_END_PIN or ANCF_END_CLAMP.
*/
FROND_EXTERN PetscErrorCode AncfFixNode(Ancf ancf, PetscInt beam, PetscInt node, AncfEnd how);
/* Support of a node. beam: number. node: of the beam. how: free, pin or clamp, from spec or AncfFixNode(). */
FROND_EXTERN PetscErrorCode AncfGetSupport(Ancf ancf, PetscInt beam, PetscInt node, AncfEnd *how);
/* How a joint holds nodes together. Ball: one position. Rigid: one position, and the tangents turn together. */
typedef enum { ANCF_JOINT_BALL, ANCF_JOINT_RIGID } AncfJointType;
/*
  Join nodes that lie at the same point, before AncfSetUp(). The element carries no twist: a rigid joint of two beams keeps the
  angle between their tangents, one of three or more keeps all tangents in one turning frame; each beam's stretch is its own,
  but for two collinear beams of equal EA, whose gradients are one. Refused by AncfSetUp(): nodes apart, a node in two joints,
  tangents that are neither collinear nor 1e-3 rad apart, several supports in one joint. type: ball or rigid. n: number of
  nodes, >= 2. beam: their beams, n. node: their numbers in their beams, n. joint: its number, or NULL.
*/
FROND_EXTERN PetscErrorCode AncfAddJoint(Ancf ancf, AncfJointType type, PetscInt n, const PetscInt beam[], const PetscInt node[],
                                         PetscInt *joint);
/* n: number of joints. */
FROND_EXTERN PetscErrorCode AncfGetNumJoints(Ancf ancf, PetscInt *n);
/* One node of a joint. joint: number. k: which of its nodes, from 0. n: nodes of the joint. beam, node: this one. Any may be
 * NULL. */
FROND_EXTERN PetscErrorCode AncfGetJoint(Ancf ancf, PetscInt joint, PetscInt k, PetscInt *n, PetscInt *beam, PetscInt *node);
/*
  Generalised force of a joint on one of its nodes now. joint: number. k: which of its nodes, from 0. f: 6, position part in N,
  gradient part in N m.
*/
FROND_EXTERN PetscErrorCode AncfGetJointForce(Ancf ancf, PetscInt joint, PetscInt k, PetscReal f[6]);
/* Gravitational acceleration. g: 3, m/s^2, finite, default 0. Source: the paper, Eq. 24. */
FROND_EXTERN PetscErrorCode AncfSetGravity(Ancf ancf, const PetscReal g[3]);
/*
  Density of the surrounding fluid: gravity acts on rho_s A - rho A_outer, A_outer = pi d^2/4. rho: kg/m^3, >= 0; 0 (default):
  no buoyancy.
*/
FROND_EXTERN PetscErrorCode AncfSetFluidDensity(Ancf ancf, PetscReal rho);
/*
  TS steps in each AncfAdvance(); with an adaptive TS, of the first step. ratio: 1 to 1000, default 1. Source: the paper,
  Sect. 3.
*/
FROND_EXTERN PetscErrorCode AncfSetSubsteps(Ancf ancf, PetscInt ratio);
/*
  Strain measure, before AncfSetUp(). strain: ANCF_STRAIN_PAPER (default) or ANCF_STRAIN_ENGINEERING. Source: the paper, Eqs.
  26 and 27.
*/
FROND_EXTERN PetscErrorCode AncfSetStrain(Ancf ancf, AncfStrain strain);
/*
  How supports and joints are kept, before AncfSetUp(); multipliers: a differential-algebraic equation, with the TS types alpha2,
  theta, cn, bdf and beuler. type: eliminate (default) or multipliers. Source: the paper, Sect. 2.3.
*/
FROND_EXTERN PetscErrorCode AncfSetConstraints(Ancf ancf, AncfConstraints type);
/*
  Largest violation of supports and joints now: round-off of eliminated ones; of multipliers Newton's tolerance in positions
  (alpha2 at corners: the error of the step) and the error of the step in velocities. Each output may be NULL. position: m, of
  directions rad. velocity: m/s, rad/s.
*/
FROND_EXTERN PetscErrorCode AncfGetConstraintError(Ancf ancf, PetscReal *position, PetscReal *velocity);
/* Gauss points per element, before AncfSetUp(). axial: for the axial energy, 1 to 8. bending: for the bending energy, 2 to 8. */
FROND_EXTERN PetscErrorCode AncfSetQuadrature(Ancf ancf, PetscInt axial, PetscInt bending);
/*
  Mass-proportional (Rayleigh) damping C = damping M, before AncfSetUp(): a mode of frequency w (rad/s) has the damping ratio
  damping/(2 w). damping: 1/s, >= 0, default 0.
*/
FROND_EXTERN PetscErrorCode AncfSetDamping(Ancf ancf, PetscReal damping);
/*
  Internal damping proportional to the stiffness (Rayleigh): a mode of frequency w rad/s has the damping ratio damping w/2. It
  acts as a retardation time of every beam in addition to those of its spec, and not on rigid motion. damping: s, not negative
  (default 0). Before AncfSetUp().
*/
FROND_EXTERN PetscErrorCode AncfSetStiffnessDamping(Ancf ancf, PetscReal damping);
/*
  Beams are integrated in groups of about this many nodes, so that the vectors of a group's TS stay in cache; before
  AncfSetUp(). nodes: >= 1, default 16000.
*/
FROND_EXTERN PetscErrorCode AncfSetGroupNodes(Ancf ancf, PetscInt nodes);
/* Read -ancf_... and the options of TS, SNES, KSP and PC under that prefix. */
FROND_EXTERN PetscErrorCode AncfSetFromOptions(Ancf ancf);
/* Check the beams, assemble the mass matrix (Eq. 22), make the solver; needed before all that follows. */
FROND_EXTERN PetscErrorCode AncfSetUp(Ancf ancf);
/* Print beams and solver. viewer: an ASCII viewer; NULL: standard output. */
FROND_EXTERN PetscErrorCode AncfView(Ancf ancf, PetscViewer viewer);
/* Free everything. ancf: the beams; becomes NULL. */
FROND_EXTERN PetscErrorCode AncfDestroy(Ancf *ancf);

/* ts: the integrator (the first group's, see AncfSetGroupNodes()), for choices without an option of ours; borrowed. */
FROND_EXTERN PetscErrorCode AncfGetTS(Ancf ancf, TS *ts);
/* n: number of beams. */
FROND_EXTERN PetscErrorCode AncfGetNumBeams(Ancf ancf, PetscInt *n);
/* n: number of nodes of all beams together. */
FROND_EXTERN PetscErrorCode AncfGetNumNodes(Ancf ancf, PetscInt *n);
/*
  Each output may be NULL. beam: number. spec: with EA, EI and rhoA resolved. firstnode: where its nodes begin in the node
  arrays. elementlength: m.
*/
FROND_EXTERN PetscErrorCode AncfGetBeam(Ancf ancf, PetscInt beam, AncfBeamSpec *spec, PetscInt *firstnode,
                                        PetscReal *elementlength);

/*
  State at the current time; arrays borrowed until the next call that changes it; each output may be NULL. t: s. e: nodes x 6,
  r (m) and r,x (-). edot: nodes x 6, m/s and 1/s. eddot: nodes x 6, m/s^2 and 1/s^2.
*/
FROND_EXTERN PetscErrorCode AncfGetState(Ancf ancf, PetscReal *t, const PetscReal **e, const PetscReal **edot,
                                         const PetscReal **eddot);
/*
  Replace the state; multistep history is discarded. Supported coordinates keep their new values from now on; their velocities
  must be zero unless the node moves. t: s. e: nodes x 6. edot: nodes x 6.
*/
FROND_EXTERN PetscErrorCode AncfSetState(Ancf ancf, PetscReal t, const PetscReal *e, const PetscReal *edot);

/* Set the generalised applied forces Q^a to zero. */
FROND_EXTERN PetscErrorCode AncfZeroLoads(Ancf ancf);
/*
  Q^a, held constant over the next AncfAdvance(); ask again before each step. Q: nodes x 6, N and N m, to write to; borrowed.
  Source: the paper, Eq. 23.
*/
FROND_EXTERN PetscErrorCode AncfGetLoads(Ancf ancf, PetscReal **Q);
/*
  Loads at the end of the next AncfAdvance(): Q^a is then linear in time from AncfGetLoads() to these in that call, and
  constant at these afterwards. Q: nodes x 6, N and N m, to write to; borrowed; a copy of the loads at the start, made when first
  asked for since AncfGetLoads().
*/
FROND_EXTERN PetscErrorCode AncfGetLoadsEnd(Ancf ancf, PetscReal **Q);

/*
  Add a permanent force of fixed direction, Q = S^T F. beam: number. s: fraction of the length, in [0, 1]. F: 3, N. Source:
  the paper, Eq. 23.
*/
FROND_EXTERN PetscErrorCode AncfAddPointLoad(Ancf ancf, PetscInt beam, PetscReal s, const PetscReal F[3]);
/*
  Add a permanent uniform load of fixed direction over a whole beam. beam: number. q: 3, N per m of rest length. Source: the
  paper, Eq. 24.
*/
FROND_EXTERN PetscErrorCode AncfAddLineLoad(Ancf ancf, PetscInt beam, const PetscReal q[3]);
/*
  Set a moment of fixed direction at a node, until it is set again; it works on the rotation of the tangent, so a component
  along the tangent has no effect. beam: number. node: of the beam, 0 is its start. M: 3, N m.
*/
FROND_EXTERN PetscErrorCode AncfSetMoment(Ancf ancf, PetscInt beam, PetscInt node, const PetscReal M[3]);
/* Remove all point loads, line loads and moments. */
FROND_EXTERN PetscErrorCode AncfClearLoads(Ancf ancf);
/*
  Centreline and section forces; each output may be NULL. beam: number. s: fraction of the length, in [0, 1]. r: 3, m. N:
  axial force EA (eps - eps0), N. kappa: 3, curvature vector r' x r''/|r'|^3 (engineering strains: over |r'|^2), 1/m. M: 3,
  bending moment EI (kappa - kappa0), N m; eps0 and kappa0: without stress. Damping is not in them. Source: the paper, Eqs. 26
  and 27.
*/
FROND_EXTERN PetscErrorCode AncfGetSection(Ancf ancf, PetscInt beam, PetscReal s, PetscReal r[3], PetscReal *N,
                                           PetscReal kappa[3], PetscReal M[3]);

/*
  Motion of a supported node from now on, e + v tau + a tau^2/2; coordinates that are not supported are ignored. beam: number.
  node: of the beam. e: 6, m and -. v: 6, m/s and 1/s. a: 6, m/s^2 and 1/s^2.
*/
FROND_EXTERN PetscErrorCode AncfSetNodeMotion(Ancf ancf, PetscInt beam, PetscInt node, const PetscReal e[6], const PetscReal v[6],
                                              const PetscReal a[6]);
/*
  Generalised force of a support on the beam. beam: number. node: of the beam. f: 6: force, N, and the part work-conjugate to
  the gradient, N m; the moment of a clamp about its node is r' x f[3..5].
*/
FROND_EXTERN PetscErrorCode AncfGetNodeReaction(Ancf ancf, PetscInt beam, PetscInt node, PetscReal f[6]);

/*
  Keep the state for AncfRestoreState(): with the history of the integrator for one-step methods and alpha2 (a multistep
  method restarts). Loads are left alone.
*/
FROND_EXTERN PetscErrorCode AncfSaveState(Ancf ancf);
/* Back to the time of AncfSaveState(), as often as wanted. */
FROND_EXTERN PetscErrorCode AncfRestoreState(Ancf ancf);
/*
  All that the beams carry from step to step. A run that goes on from an unpacked state has the bits of the one that was
  packed; that one is not changed by AncfPack() with the types alpha2, beuler, cn, euler and basicsymplectic and steps of given
  size and no multipliers, while the others begin anew (multistep methods at first order). n: reals.
*/
FROND_EXTERN PetscErrorCode AncfGetPackSize(Ancf ancf, PetscInt *n);
/* Pack, see AncfGetPackSize(), whose number of reals this takes; not between AncfGetLoadsEnd() and the end of the step. state:
 * filled. */
FROND_EXTERN PetscErrorCode AncfPack(Ancf ancf, PetscReal state[]);
/* Whether AncfPack() leaves the run as it is. exact: whether. */
FROND_EXTERN PetscErrorCode AncfGetPackExact(Ancf ancf, PetscBool *exact);
/* Back to a packed state. state: from AncfPack() of the same beams. */
FROND_EXTERN PetscErrorCode AncfUnpack(Ancf ancf, const PetscReal state[]);
/* The packed state and the counts of steps and iterations as named arrays, see frondstate.h. state: saved to or loaded from. */
FROND_EXTERN PetscErrorCode AncfMoveState(Ancf ancf, FrondState *state);
/* The counts alone, for a state that holds the packed beams elsewhere (CoupleMoveState()). state: saved to or loaded from. */
FROND_EXTERN PetscErrorCode AncfMoveCounts(Ancf ancf, FrondState *state);
/*
  For checkpoints of an own making: the acceleration that alpha2 carries from step to step. Without it alpha2 starts from the
  acceleration of the equations of motion. A: nodes x 6, borrowed; NULL for other types.
*/
FROND_EXTERN PetscErrorCode AncfGetHistory(Ancf ancf, const PetscReal **A);
/* Set what AncfGetHistory() gave, after AncfSetState(). A: nodes x 6; NULL, or another type than alpha2: nothing is done. */
FROND_EXTERN PetscErrorCode AncfSetHistory(Ancf ancf, const PetscReal *A);

/*
  Integrate from the current time with `substeps` TS steps (or adaptively) under the present loads; after an error the state
  is that before the call. t: s, above the current time. Source: the paper, Eqs. 18-30.
*/
FROND_EXTERN PetscErrorCode AncfAdvance(Ancf ancf, PetscReal t);

/*
  Static equilibrium under the present loads and gravity, from the present shape; velocities become zero.
  PETSC_ERR_NOT_CONVERGED when there is none, as for beams without enough supports. Options: -ancf_static_snes_...,
  -ancf_static_ksp_.... loadsteps: the loads are applied in this many equal steps, >= 1, each halved when Newton fails.
*/
FROND_EXTERN PetscErrorCode AncfSolveStatic(Ancf ancf, PetscInt loadsteps);

/*
  Each output may be NULL. kinetic: J. elastic: axial and bending, J. potential: of gravity less buoyancy, -sum (rho_s A - rho
  A_outer) g.r, and of permanent point and line loads, J.
*/
FROND_EXTERN PetscErrorCode AncfGetEnergy(Ancf ancf, PetscReal *kinetic, PetscReal *elastic, PetscReal *potential);
/*
  Power that damping takes from the beams now: damping v.M v, and the integral of EA tau (deps/dt)^2 + EI tau |kappa*|^2 with the
  rate kappa* of the curvature seen from the section. power: W.
*/
FROND_EXTERN PetscErrorCode AncfGetDissipation(Ancf ancf, PetscReal *power);
/*
  Each output may be NULL. p: 3, linear momentum, kg m/s. L: 3, angular momentum about the origin, integral of rho_s A r x
  rdot, kg m^2/s.
*/
FROND_EXTERN PetscErrorCode AncfGetMomentum(Ancf ancf, PetscReal p[3], PetscReal L[3]);
/*
  Mean of the supports' forces over the last AncfAdvance(), as the integrator's equations have them: unlike those at the ends of
  a step they stay smooth where it does not resolve the fastest modes. Known for alpha2, theta, beuler and bdf only. offset: they
  belong to the middle of that time plus this part of it; below 0: not known. f: nodes x 6, N and N m.
*/
FROND_EXTERN PetscErrorCode AncfGetMeanReactions(Ancf ancf, PetscReal *offset, PetscReal f[]);
/*
  Balance of every beam now, moments about the origin; F and T are of weight, loads, moments and damping of the mass, without
  supports and joints. All beams x 3. p: kg m/s. L: kg m^2/s. F: N. T: N m.
*/
FROND_EXTERN PetscErrorCode AncfGetBeamBalances(Ancf ancf, PetscReal p[], PetscReal L[], PetscReal F[], PetscReal T[]);
/*
  Torque about the origin now of weight, permanent loads, moments, damping of the mass and supports; with that of the loads of
  AncfGetLoads() it is the rate of L of AncfGetMomentum(). T: 3, N m.
*/
FROND_EXTERN PetscErrorCode AncfGetTorque(Ancf ancf, PetscReal T[3]);
/* As AncfGetNodeReaction() for all nodes at once. f: nodes x 6, N and N m, 0 where there is no support. */
FROND_EXTERN PetscErrorCode AncfGetReactions(Ancf ancf, PetscReal f[]);
/* f: 3, force of all supports on the beams, N: the residual of the equations of motion over supported positions. */
FROND_EXTERN PetscErrorCode AncfGetReaction(Ancf ancf, PetscReal f[3]);
/* f: 3, gravity less buoyancy and the permanent point and line loads on all beams, N. */
FROND_EXTERN PetscErrorCode AncfGetWeight(Ancf ancf, PetscReal f[3]);
/*
  Counters since AncfSetUp(), the largest over the groups of beams; each output may be NULL. steps: TS steps. newton: Newton
  iterations. linear: linear iterations.
*/
FROND_EXTERN PetscErrorCode AncfGetCounts(Ancf ancf, PetscInt *steps, PetscInt *newton, PetscInt *linear);

/*
  Shape functions. xi: place in the element, in [0, 1]. l: length of the element, m. S: 4, S1 and S3 (-), S2 and S4 (m).
  Source: the paper, Eq. 19.
*/
FROND_EXTERN void AncfShape(PetscReal xi, PetscReal l, PetscReal S[4]);
/*
  Their first x-derivatives. xi: place in the element, in [0, 1]. l: length of the element, m. Sx: 4, 1/m and -. Source: the
  paper, Eq. 19.
*/
FROND_EXTERN void AncfShapeX(PetscReal xi, PetscReal l, PetscReal Sx[4]);
/*
  Their second x-derivatives. xi: place in the element, in [0, 1]. l: length of the element, m. Sxx: 4, 1/m^2 and 1/m. Source:
  the paper, Eq. 19.
*/
FROND_EXTERN void AncfShapeXX(PetscReal xi, PetscReal l, PetscReal Sxx[4]);

#endif
