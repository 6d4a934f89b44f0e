/*
  couple.h - public interface of the coupling: fluid markers against any number of structure surfaces.

  Sect. 2.4 of Pazouki, Serban, Negrut. A CoupleSurface is all that the coupling knows of a structure: it gives BCE
  markers and their motion, takes forces on them, and advances itself in time. Adapters: ANCF beams, rigid
  bodies, walls with prescribed motion; a host code writes its own by filling CoupleSurfaceOps.
*/
#ifndef COUPLE_H
#define COUPLE_H

#include "ancf.h"
#include "frondsys.h"
#include "rigid.h"
#include "sph.h"
#include "sphlink.h"

/* A fluid coupled to structures. */
typedef struct _p_Couple *Couple;
/* A structure as the coupling sees it; references are counted. */
typedef struct _p_CoupleSurface *CoupleSurface;

/* What a transfer of marker forces lost: marker sums minus generalised sums. Moments about the origin. */
typedef struct {
  PetscReal force[3], moment[3], power;                /* totals over the markers: N, N m, W */
  PetscReal force_lost[3], moment_lost[3], power_lost; /* marker total - what the structure received */
  PetscReal twist;                                     /* axial torque that a gradient-deficient beam cannot carry, N m */
} CoupleAudit;

/* What a structure does for the coupling. All but those called optional must be given. */
typedef struct {
  /* n markers: rest positions x (n x 3), volumes (n), depths (n); borrowed from the surface. */
  PetscErrorCode (*getmarkers)(CoupleSurface, PetscInt *n, const PetscReal **x, const PetscReal **volume,
                               const PetscReal **depth);
  /* Marker state extrapolated by dt from the structure's current time with its current velocity and acceleration: n x 3 each. */
  PetscErrorCode (*kinematics)(CoupleSurface, PetscReal dt, PetscReal *x, PetscReal *v, PetscReal *a);
  /* Forget the loads of the last step. Called for every surface before any applyforces. */
  PetscErrorCode (*zeroloads)(CoupleSurface);
  /*
    Take the marker forces f (n x 3, N), held over the next advance, which act on the state of the last kinematics call; fill the
    audit's *_lost and twist (the totals are filled by the caller).
  */
  PetscErrorCode (*applyforces)(CoupleSurface, const PetscReal *f, CoupleAudit *audit);
  /* Integrate to time t. Surfaces that share a solver share the call: the solver advances once. */
  PetscErrorCode (*advance)(CoupleSurface, PetscReal t);
  /* Optional: linear momentum p (kg m/s) and the mean forces over the last step (N) that do not come from the fluid, of weight
   * and of supports. */
  PetscErrorCode (*momentum)(CoupleSurface, PetscReal p[3], PetscReal weight[3], PetscReal support[3]);
  /* Optional, for surfaces that turn: angular velocity at each marker (n x 3, rad/s) in the state of the last kinematics call. */
  PetscErrorCode (*rotation)(CoupleSurface, PetscReal *omega);
  /* Optional. */
  PetscErrorCode (*view)(CoupleSurface, PetscViewer);
  /* Optional: free the context. */
  PetscErrorCode (*destroy)(CoupleSurface);
  /*
    Optional, all three or none, for CoupleSaveState(): how many reals the state takes, put it there, go back to it; the run then
    goes on with the same bits. A state shared by surfaces (beams of one Ancf) is one surface's to save.
  */
  PetscErrorCode (*statesize)(CoupleSurface, PetscInt *n);
  PetscErrorCode (*save)(CoupleSurface, PetscReal *state);       /* optional */
  PetscErrorCode (*load)(CoupleSurface, const PetscReal *state); /* optional */
  /*
    Optional, all three or none: how the markers hang on the structure's coordinates (borrowed), for fluids that move them and sum
    their forces by themselves; then linkstate stands in for kinematics (state: of SphSetGroupState()) and applyloads for
    applyforces (load, totals: of SphGetGroupLoad()).
  */
  PetscErrorCode (*getlink)(CoupleSurface, SphLinkSpec *spec);
  PetscErrorCode (*linkstate)(CoupleSurface, PetscReal dt, PetscReal *state); /* optional */
  /* optional */
  PetscErrorCode (*applyloads)(CoupleSurface, const PetscReal *load, const SphLinkTotals *totals, CoupleAudit *audit);
  /*
    Optional, for COUPLE_LOADS_LINEAR; called for every surface that has it after all applyforces: the marker forces change by df
    (n x 3, N) over the next advance, linearly in time, about the mean given to applyforces. Without it they stay constant.
  */
  PetscErrorCode (*changeforces)(CoupleSurface, const PetscReal *df);
} CoupleSurfaceOps;

/*
  Wrap a structure for the coupling. comm: communicator of the fluid. name: copied; errors and output name the surface by it.
  ops: copied; all but those called optional must be given. ctx: the structure's own, for ops. surface: the new surface.
*/
FROND_EXTERN PetscErrorCode CoupleSurfaceCreate(MPI_Comm comm, const char name[], const CoupleSurfaceOps *ops, void *ctx,
                                                CoupleSurface *surface);
/* ctx: address of a pointer that becomes the ctx given to CoupleSurfaceCreate(). */
FROND_EXTERN PetscErrorCode CoupleSurfaceGetContext(CoupleSurface surface, void *ctx);
/* name: the surface's name; borrowed. */
FROND_EXTERN PetscErrorCode CoupleSurfaceGetName(CoupleSurface surface, const char **name);
/* ops: a copy of the surface's operations, to drive it outside a Couple. */
FROND_EXTERN PetscErrorCode CoupleSurfaceGetOps(CoupleSurface surface, CoupleSurfaceOps *ops);
/* A held surface (wall, fixed body) takes up any force: the balance counts it as an impulse of walls. held: default no. */
FROND_EXTERN PetscErrorCode CoupleSurfaceSetHeld(CoupleSurface surface, PetscBool held);
/* Give a reference back; the last one frees the surface. surface: becomes NULL. */
FROND_EXTERN PetscErrorCode CoupleSurfaceDestroy(CoupleSurface *surface);

/*
  A beam, marked by disks of BCE markers (lines across the thickness in 2D). ancf: the beams, set up; kept, not owned. beam:
  number. dim: 2 or 3. dp: distance of the markers, m; a diameter below it is refused. depthmax: how deep below the surface,
  m. surface: the new surface. Source: the paper, Sect. 2.4, Fig. 2b.
*/
FROND_EXTERN PetscErrorCode CoupleSurfaceCreateBeam(Ancf ancf, PetscInt beam, PetscInt dim, PetscReal dp, PetscReal depthmax,
                                                    CoupleSurface *surface);
/*
  A rigid body, filled with BCE markers. rigid: the bodies, set up; kept, not owned. body: number. dim: 2 or 3. dp: distance
  of the markers, m. depthmax: how deep below the surface, m. surface: the new surface. Source: the paper, Sect. 2.4, Fig. 2a.
*/
FROND_EXTERN PetscErrorCode CoupleSurfaceCreateRigid(Rigid rigid, PetscInt body, PetscInt dim, PetscReal dp, PetscReal depthmax,
                                                     CoupleSurface *surface);
/*
  Any markers that a prescribed body carries along, such as those of a wave paddle; the arrays are copied. rigid: the bodies, set
  up; kept, not owned. body: number. name: copied. n: number of markers. x: n x 3, their places now, m. volume: n, m^3 (m^2 in
  2D). depth: n, below the surface, m. surface: the new surface.
*/
FROND_EXTERN PetscErrorCode CoupleSurfaceCreateMoving(Rigid rigid, PetscInt body, const char name[], PetscInt n,
                                                      const PetscReal *x, const PetscReal *volume, const PetscReal *depth,
                                                      CoupleSurface *surface);
/*
  Markers moving together; the arrays are copied. comm: communicator of the fluid. name: copied. n: number of markers. x: n x
  3, m. volume: n, m^3 (2D: m^2). depth: n, m. velocity: 3, m/s, constant; 0: at rest. surface: the new surface.
*/
FROND_EXTERN PetscErrorCode CoupleSurfaceCreateWall(MPI_Comm comm, const char name[], PetscInt n, const PetscReal *x,
                                                    const PetscReal *volume, const PetscReal *depth, const PetscReal velocity[3],
                                                    CoupleSurface *surface);
/*
  A wall that moves along itself covers the same place at all times: its markers stay where they are and carry the velocity only,
  as the lid across a closed box. surface: of CoupleSurfaceCreateWall(), before CoupleSetUp(). sliding: PETSC_FALSE by default.
*/
FROND_EXTERN PetscErrorCode CoupleSurfaceSetSliding(CoupleSurface surface, PetscBool sliding);

/*
  What goes to and fro between beams and bodies, see CoupleAttachGetExchange() and CoupleShortGetExchange(). Sums begin at set-up.
  beams + bodies = 0, but for bodies that are not free and the error of the time integration.
*/
typedef struct {
  PetscReal elastic;       /* energy of the forces between them now, J */
  PetscReal taken;         /* energy that they turned into heat, J */
  PetscReal beams, bodies; /* work of the bodies on the beams, and on free bodies, J */
  PetscReal turnbeams[3];  /* angular impulse about the origin, on the beams, N m s */
  PetscReal turnbodies[3]; /* on free bodies */
  PetscReal torque[3];     /* attachments: about the origin, of the reactions now that AncfGetTorque() holds of them, N m */
} CoupleExchange;

/* Nodes of beams attached to rigid bodies. */
typedef struct _p_CoupleAttach *CoupleAttach;
/*
  Attachments of beams to bodies, none yet; the method is described in coupleattachstep.c. comm: communicator of the errors. ancf:
  the beams, and rigid: the bodies, both set up; kept, not owned. attach: the new object.
*/
FROND_EXTERN PetscErrorCode CoupleAttachCreate(MPI_Comm comm, Ancf ancf, Rigid rigid, CoupleAttach *attach);
/*
  Attach a node, before CoupleAttachSetUp(): a clamped node turns with the body, a pinned one is a ball joint. Refused: a node
  without support or attached already, one that lies farther outside of the body than the beam's diameter. beam, node: supported
  (AncfFixNode()). body: number.
*/
FROND_EXTERN PetscErrorCode CoupleAttachAdd(CoupleAttach attach, PetscInt beam, PetscInt node, PetscInt body);
/* Of the forces in a step. n: most iterations, >= 1 (50). tolerance: relative, in (0, 1) (1e-8). */
FROND_EXTERN PetscErrorCode CoupleAttachSetIterations(CoupleAttach attach, PetscInt n, PetscReal tolerance);
/* Read -couple_attach_.... */
FROND_EXTERN PetscErrorCode CoupleAttachSetFromOptions(CoupleAttach attach);
/* The nodes take the bodies' velocities; those of the rest of the beams are the caller's (AncfSetState()). */
FROND_EXTERN PetscErrorCode CoupleAttachSetUp(CoupleAttach attach);
/*
  Beams and bodies to a time together, instead of AncfAdvance() and RigidAdvance(), under the loads that both have. t: s, after
  the current time of both. Errors: PETSC_ERR_NOT_CONVERGED.
*/
FROND_EXTERN PetscErrorCode CoupleAttachAdvance(CoupleAttach attach, PetscReal t);
/* n: number of attachments. */
FROND_EXTERN PetscErrorCode CoupleAttachGetNum(CoupleAttach attach, PetscInt *n);
/* On the beam, mean over the last step; either may be NULL. i: attachment. F: 3, N. M: 3, about the node, N m. */
FROND_EXTERN PetscErrorCode CoupleAttachGetForce(CoupleAttach attach, PetscInt i, PetscReal F[3], PetscReal M[3]);
/* Work and angular impulses of the attachments after a step, elastic and taken 0. exchange: to be filled. */
FROND_EXTERN PetscErrorCode CoupleAttachGetExchange(CoupleAttach attach, CoupleExchange *exchange);
/* n: iterations made since set-up. */
FROND_EXTERN PetscErrorCode CoupleAttachGetIterations(CoupleAttach attach, PetscInt *n);
/* What the attachments remember, see frondstate.h; beams and bodies move their own. state: saved to or loaded from. */
FROND_EXTERN PetscErrorCode CoupleAttachMoveState(CoupleAttach attach, FrondState *state);
/* Print the attachments. viewer: an ASCII viewer of PETSc. */
FROND_EXTERN PetscErrorCode CoupleAttachView(CoupleAttach attach, PetscViewer viewer);
/* Free the attachments. attach: becomes NULL. */
FROND_EXTERN PetscErrorCode CoupleAttachDestroy(CoupleAttach *attach);

/*
  An empty coupling. Then: CoupleSetSph(), CoupleAddSurface(), CoupleSetUp(), CoupleStep(). comm: communicator of the fluid.
  couple: the new coupling.
*/
FROND_EXTERN PetscErrorCode CoupleCreate(MPI_Comm comm, Couple *couple);
/* The fluid, whose markers are added before CoupleSetUp(). sph: kept, not owned. */
FROND_EXTERN PetscErrorCode CoupleSetSph(Couple couple, Sph sph);
/* Append a structure, before CoupleSetUp(). surface: the couple keeps a reference of its own; destroy yours as well. */
FROND_EXTERN PetscErrorCode CoupleAddSurface(Couple couple, CoupleSurface surface);
/* Beams attached to bodies, before CoupleSetUp(); their surfaces are added as well. attach: set up; kept, not owned; NULL: none.
 */
FROND_EXTERN PetscErrorCode CoupleSetAttach(Couple couple, CoupleAttach attach);
/* Upper bound on the step. dtmax: s, > 0; PETSC_DECIDE (default) for none. */
FROND_EXTERN PetscErrorCode CoupleSetMaxTimeStep(Couple couple, PetscReal dtmax);
/*
  Strong coupling: iterations per step until the forces agree. n: at most so many, >= 1; 1 (default) is the staggered step.
  tolerance: of the forces, relative (-), > 0. relaxation: the first factor of each step (-), in (0, 1].
*/
FROND_EXTERN PetscErrorCode CoupleSetIterations(Couple couple, PetscInt n, PetscReal tolerance, PetscReal relaxation);
/*
  What passes between coupling and fluid. Markers: the state of every marker and the force on it. Generalised: the states of the
  structures and generalised forces, for surfaces that can (CoupleSurfaceOps.getlink); same physics, equal to round-off; not with
  iterations. Auto (default): generalised where markers live on a device.
*/
typedef enum { COUPLE_TRANSFER_AUTO, COUPLE_TRANSFER_MARKERS, COUPLE_TRANSFER_GENERALISED } CoupleTransferType;
/* Names of CoupleTransferType. */
FROND_EXTERN const char *const CoupleTransferTypes[];
/* Before CoupleSetUp(). transfer: what passes between coupling and fluid. */
FROND_EXTERN PetscErrorCode CoupleSetTransfer(Couple couple, CoupleTransferType transfer);
/*
  How a step's loads go on over it. constant (default): the fluid's force at the middle of the step. linear: with that mean, and
  with the slope from the force of the last step to this one's (each iterate's, when iterated). With marker forces only, see
  CoupleSetTransfer(); constant with CoupleSetAttach(). Source: coupleloads.c; orders measured in docs/substeps.md.
*/
typedef enum { COUPLE_LOADS_CONSTANT, COUPLE_LOADS_LINEAR } CoupleLoads;
/* Names of CoupleLoads. */
FROND_EXTERN const char *const CoupleLoadsTypes[];
/* How loads go on over a step; may be changed between steps. loads: COUPLE_LOADS_CONSTANT (default) or COUPLE_LOADS_LINEAR. */
FROND_EXTERN PetscErrorCode CoupleSetLoads(Couple couple, CoupleLoads loads);
/* Each output may be NULL. iterations: made since set-up. unconverged: steps that missed the tolerance. */
FROND_EXTERN PetscErrorCode CoupleGetIterations(Couple couple, PetscInt *iterations, PetscInt *unconverged);
/* Read -couple_.... */
FROND_EXTERN PetscErrorCode CoupleSetFromOptions(Couple couple);
/* Give every surface's markers to the fluid and set the fluid up. Add the fluid markers before. */
FROND_EXTERN PetscErrorCode CoupleSetUp(Couple couple);
/* Print the coupling and its surfaces. viewer: an ASCII viewer of PETSc. */
FROND_EXTERN PetscErrorCode CoupleView(Couple couple, PetscViewer viewer);
/* Free the coupling and its references of surfaces; the fluid is the caller's. couple: becomes NULL. */
FROND_EXTERN PetscErrorCode CoupleDestroy(Couple *couple);

/*
  One step of the coupled system. PETSC_ERR_FP on a value that is not finite, PETSC_ERR_NOT_CONVERGED when a structure's
  solver fails. tmax: not past this time, s. dt: the step taken, s, or NULL. Source: the paper, Sect. 2.4; the scheme is
  described in couple.c.
*/
FROND_EXTERN PetscErrorCode CoupleStep(Couple couple, PetscReal tmax, PetscReal *dt);
/* Each output may be NULL. t: time, s. step: number of steps. */
FROND_EXTERN PetscErrorCode CoupleGetTime(Couple couple, PetscReal *t, PetscInt *step);
/* n: number of surfaces. */
FROND_EXTERN PetscErrorCode CoupleGetNumSurfaces(Couple couple, PetscInt *n);
/*
  Each output may be NULL. i: number of the surface, from 0. surface: borrowed. group: boundary group of its markers in the
  fluid.
*/
FROND_EXTERN PetscErrorCode CoupleGetSurface(Couple couple, PetscInt i, CoupleSurface *surface, PetscInt *group);
/* i: number of the surface. audit: of the last step's transfer. */
FROND_EXTERN PetscErrorCode CoupleGetAudit(Couple couple, PetscInt i, CoupleAudit *audit);

/*
  Short-range forces of beams: on other beams, on themselves, on rigid bodies and on flat walls; also without a fluid. A beam is a
  capsule along its axis, whose line resistance and repulsion (shortrange.h) are summed over samples of the axis. See
  coupleshort.c. 3D only.
*/
typedef struct _p_CoupleShort *CoupleShort;
/* comm: communicator of the errors. ancf: the beams, set up; kept, not owned. rigid: the bodies, set up, or NULL. sr: the new
 * one. */
FROND_EXTERN PetscErrorCode CoupleShortCreate(MPI_Comm comm, Ancf ancf, Rigid rigid, CoupleShort *sr);
/* sr: the forces. p: parameters, copied; neither viscosity nor modulus: no forces. Before CoupleShortSetUp(). */
FROND_EXTERN PetscErrorCode CoupleShortSetParameters(CoupleShort sr, const ShortRange *p);
/* sr: the forces. n: samples of the axis per diameter, 2 to 64, default 8. Before CoupleShortSetUp(). */
FROND_EXTERN PetscErrorCode CoupleShortSetSamples(CoupleShort sr, PetscInt n);
/* Forces act between nearest images. sr: the forces. period: 3, m; 0 for none. */
FROND_EXTERN PetscErrorCode CoupleShortSetPeriod(CoupleShort sr, const PetscReal period[3]);
/* A flat wall at rest, at most 6. sr: the forces. x: 3, a point of its face, m. normal: 3, into the free side, of any length > 0.
 */
FROND_EXTERN PetscErrorCode CoupleShortAddWall(CoupleShort sr, const PetscReal x[3], const PetscReal normal[3]);
/*
  Attached beams and their bodies: a beam and its body leave one another alone near the place of attachment, as do beams that are
  attached to one body in places close together. sr: the forces; before CoupleShortSetUp(). attach: set up; kept, not owned; NULL:
  none.
*/
FROND_EXTERN PetscErrorCode CoupleShortSetAttach(CoupleShort sr, CoupleAttach attach);
/* Read -couple_shortrange_samples and the options of ShortRangeSetFromOptions(). sr: the forces. */
FROND_EXTERN PetscErrorCode CoupleShortSetFromOptions(CoupleShort sr);
/* Check the parameters; refuse beams that overlap each other, a body or a wall, naming both. sr: the forces. */
FROND_EXTERN PetscErrorCode CoupleShortSetUp(CoupleShort sr);
/* Print the parameters. sr: the forces. viewer: an ASCII viewer of PETSc. */
FROND_EXTERN PetscErrorCode CoupleShortView(CoupleShort sr, PetscViewer viewer);
/* Free it. sr: becomes NULL. */
FROND_EXTERN PetscErrorCode CoupleShortDestroy(CoupleShort *sr);
/*
  Add the forces of the coming step to the loads of beams and bodies, which must stand at the same time. sr: the forces. h: length
  of the step, s.
*/
FROND_EXTERN PetscErrorCode CoupleShortApply(CoupleShort sr, PetscReal h);
/* After the step: take back what the bodies were given (loads of beams are made anew each step). sr: the forces. */
FROND_EXTERN PetscErrorCode CoupleShortRemove(CoupleShort sr);
/*
  Of the last CoupleShortApply(); each output may be NULL. sr: the forces. contacts: number of pairs of points. gap: smallest one,
  m; PETSC_INFINITY without contacts. held: 3, force of walls and of bodies that are not free on the beams, N. bodies: 3, force of
  the beams on free bodies, N.
*/
FROND_EXTERN PetscErrorCode CoupleShortGetForces(CoupleShort sr, PetscInt *contacts, PetscReal *gap, PetscReal held[3],
                                                 PetscReal bodies[3]);
/*
  Energy in the repulsion now; heat of lubrication and contact; work and angular impulses. Steps taken again from the time of the
  last CoupleShortApply() count once. sr: the forces. exchange: to be filled.
*/
FROND_EXTERN PetscErrorCode CoupleShortGetExchange(CoupleShort sr, CoupleExchange *exchange);
/* Those sums, see frondstate.h; a coupling moves them with its own. sr: the forces. state: saved to or loaded from. */
FROND_EXTERN PetscErrorCode CoupleShortMoveState(CoupleShort sr, FrondState *state);
/* Let a coupling apply them in every step, before its first one. couple: the coupling. sr: kept, not owned; NULL: none. */
FROND_EXTERN PetscErrorCode CoupleSetShort(Couple couple, CoupleShort sr);

/* Steps up to a time, as CoupleStep(). t: s, after the current one. */
FROND_EXTERN PetscErrorCode CoupleAdvance(Couple couple, PetscReal t);
/*
  Borrowed until the next step; each output may be NULL. i: number of the surface. n: its markers. x: n x 3, positions now, m.
  v: n x 3, velocities now, m/s. f: n x 3, fluid forces of the last step, N.
*/
FROND_EXTERN PetscErrorCode CoupleGetMarkers(Couple couple, PetscInt i, PetscInt *n, const PetscReal **x, const PetscReal **v,
                                             const PetscReal **f);

/*
  Rolling back: CoupleSaveState() keeps fluid and structures as they are between two steps (*state is made when NULL, else used
  again); CoupleRestoreState() goes back there, as often as wanted, and the run goes on with the bits that it went on with after
  saving. Several states may be kept. Saving makes integrators with a memory start from what is saved, a change at round-off (a
  multistep method of PETSc begins anew). Errors: PETSC_ERR_SUP when a surface cannot save its state.
*/
typedef struct _p_CoupleState *CoupleState;
/*
  Keep fluid and structures as they are between two steps; several states may be kept. Integrators with a memory start from
  what is saved, a change at round-off (a multistep method of PETSc begins anew). PETSC_ERR_SUP when a surface cannot save its
  state. state: made when NULL, else used again.
*/
FROND_EXTERN PetscErrorCode CoupleSaveState(Couple couple, CoupleState *state);
/*
  Back to where CoupleSaveState() was called, as often as wanted; the run goes on with the bits that it went on with after
  saving. state: saved.
*/
FROND_EXTERN PetscErrorCode CoupleRestoreState(Couple couple, CoupleState state);
/* The same state as named arrays, see frondstate.h. state: loaded into a coupling set up for the same scene. */
FROND_EXTERN PetscErrorCode CoupleMoveState(Couple couple, FrondState *state);
/* Free a saved state. state: becomes NULL. */
FROND_EXTERN PetscErrorCode CoupleStateDestroy(CoupleState *state);

/*
  Balance since set-up: impulses that went into the fluid and structures (kg m/s). residual = fluid momentum + structure momentum
  - initial - impulse of body forces - impulse of supports, walls and prescribed bodies - what came through openings.
*/
typedef struct {
  PetscReal fluid[3], structure[3];       /* momentum now, kg m/s */
  PetscReal body[3], support[3], wall[3]; /* impulses since set-up, kg m/s */
  PetscReal opening[3];                   /* momentum that openings let in, and impulses of their zones, since set-up, kg m/s */
  PetscReal residual[3], scale;           /* residual, and the largest term it is a difference of */
} CoupleBalance;
/*
  Momentum now, impulses since set-up and the residual between them: round-off for a system without supports (of the pair
  arithmetic's precision); with supports it carries the second-order error of integrating their force. balance: to be filled.
*/
FROND_EXTERN PetscErrorCode CoupleGetBalance(Couple couple, CoupleBalance *balance);
/*
  What a surface has received from the fluid since set-up; each output may be NULL. i: number of the surface. work: J, forces
  times the velocities of the markers that they act on. impulse: 3, angular, about the origin, N m s.
*/
FROND_EXTERN PetscErrorCode CoupleGetWork(Couple couple, PetscInt i, PetscReal *work, PetscReal impulse[3]);

#endif
