/*
  ancf.h - public interface of the slender beams of Frond.

  Gradient-deficient ANCF cable elements (Pazouki, Serban, Negrut, Eqs. 18-30): each node carries six
  coordinates e_j = [r_j, r_j,x], position (m) and position gradient (-). All beams of one Ancf object are one
  block-tridiagonal system, integrated by PETSc TS (prefix -ancf_).

  Array layout: node arrays are nodes x 6, node by node, beam after beam in the order of AncfAddBeam.
*/
#ifndef ANCF_H
#define ANCF_H

#include "frondsys.h"
#include <petscts.h>

/* Beams and their solver. */
typedef struct _p_Ancf *Ancf;

/* Strain measures: PAPER eps = (r'.r'-1)/2, kappa = |r' x r''|/|r'|^3; ENGINEERING eps = |r'|-1, kappa = |r' x r''|/|r'|^2. */
typedef enum { ANCF_STRAIN_PAPER, ANCF_STRAIN_ENGINEERING } AncfStrain;

/* What a beam end may do. Free: all 6 coordinates; pin: position fixed; clamp: position and gradient fixed. */
typedef enum { ANCF_END_FREE, ANCF_END_PIN, ANCF_END_CLAMP } AncfEnd;

/* Straight beam with a circular section; every field must be set. AncfBeamSpecInit() gives the defaults. */
typedef struct {
  PetscReal start[3];     /* first node, m */
  PetscReal end[3];       /* last node, m; |end-start| is the rest length L */
  PetscInt elements;      /* number of elements, >= 1 */
  PetscReal diameter;     /* d, m: the outer diameter that the fluid sees; A = pi d^2/4, I = pi d^4/64 */
  PetscReal density;      /* rho_s, kg/m^3 */
  PetscReal young;        /* E, Pa */
  PetscReal EA, EI, rhoA; /* overrides, N, N m^2, kg/m; PETSC_DECIDE (-1): derived from d, E, rho_s */
  PetscReal velocity[3];  /* initial velocity, m/s */
  AncfEnd end0, end1;     /* boundary conditions at start and end */
} AncfBeamSpec;

FROND_EXTERN PetscErrorCode AncfCreate(MPI_Comm comm, Ancf *ancf);
FROND_EXTERN PetscErrorCode AncfSetOptionsPrefix(Ancf ancf, const char prefix[]);
FROND_EXTERN PetscErrorCode AncfBeamSpecInit(AncfBeamSpec *spec);
/* Sets EA, EI and rhoA of an annulus from diameter, young and density, which must be set, and its inner diameter, m. */
FROND_EXTERN PetscErrorCode AncfBeamSpecSetAnnulus(AncfBeamSpec *spec, PetscReal inner);
FROND_EXTERN PetscErrorCode AncfAddBeam(Ancf ancf, const AncfBeamSpec *spec, PetscInt *beam);
/* Supports any node of a beam, before AncfSetUp(): ANCF_END_PIN or ANCF_END_CLAMP. */
FROND_EXTERN PetscErrorCode AncfFixNode(Ancf ancf, PetscInt beam, PetscInt node, AncfEnd how);
FROND_EXTERN PetscErrorCode AncfSetGravity(Ancf ancf, const PetscReal g[3]);
FROND_EXTERN PetscErrorCode AncfSetFluidDensity(Ancf ancf, PetscReal rho);
FROND_EXTERN PetscErrorCode AncfSetSubsteps(Ancf ancf, PetscInt ratio);
/* Strain measure, ANCF_STRAIN_PAPER by default. Before AncfSetUp(). */
FROND_EXTERN PetscErrorCode AncfSetStrain(Ancf ancf, AncfStrain strain);
FROND_EXTERN PetscErrorCode AncfSetQuadrature(Ancf ancf, PetscInt axial, PetscInt bending);
FROND_EXTERN PetscErrorCode AncfSetDamping(Ancf ancf, PetscReal damping);
FROND_EXTERN PetscErrorCode AncfSetGroupNodes(Ancf ancf, PetscInt nodes);
/* Read -ancf_... and the options of TS, SNES, KSP and PC under that prefix. */
FROND_EXTERN PetscErrorCode AncfSetFromOptions(Ancf ancf);
/* Check the beams, assemble the mass matrix, make the solver; needed before all that follows. Errors: no beams, a TS type that
   cannot integrate them. */
FROND_EXTERN PetscErrorCode AncfSetUp(Ancf ancf);
/* Print beams and solver; viewer NULL: standard output. */
FROND_EXTERN PetscErrorCode AncfView(Ancf ancf, PetscViewer viewer);
/* Free everything; *ancf becomes NULL. */
FROND_EXTERN PetscErrorCode AncfDestroy(Ancf *ancf);

FROND_EXTERN PetscErrorCode AncfGetTS(Ancf ancf, TS *ts);
/* Number of beams. */
FROND_EXTERN PetscErrorCode AncfGetNumBeams(Ancf ancf, PetscInt *n);
/* Number of nodes of all beams together. */
FROND_EXTERN PetscErrorCode AncfGetNumNodes(Ancf ancf, PetscInt *n);
FROND_EXTERN PetscErrorCode AncfGetBeam(Ancf ancf, PetscInt beam, AncfBeamSpec *spec, PetscInt *firstnode,
                                        PetscReal *elementlength);

/* State at the current time: positions, velocities, accelerations of the nodal coordinates; borrowed, nodes x 6. */
FROND_EXTERN PetscErrorCode AncfGetState(Ancf ancf, PetscReal *t, const PetscReal **e, const PetscReal **edot,
                                         const PetscReal **eddot);
FROND_EXTERN PetscErrorCode AncfSetState(Ancf ancf, PetscReal t, const PetscReal *e, const PetscReal *edot);

/* Generalised applied forces Q^a (nodes x 6), held constant over the next AncfAdvance(). Writable; ask again before each step. */
FROND_EXTERN PetscErrorCode AncfZeroLoads(Ancf ancf);
/* Q^a to write to, nodes x 6; borrowed. */
FROND_EXTERN PetscErrorCode AncfGetLoads(Ancf ancf, PetscReal **Q);
/* Loads at the end of the next AncfAdvance(): Q^a is then linear in time from AncfGetLoads() to these in that
   call, and constant at these afterwards. Returned as a copy of the loads at the start. */
FROND_EXTERN PetscErrorCode AncfGetLoadsEnd(Ancf ancf, PetscReal **Q);

/* Permanent loads, in addition to Q^a; see ancfloads.c. s in [0,1]: fraction of the length; node: 0 is the beam's start. */
FROND_EXTERN PetscErrorCode AncfAddPointLoad(Ancf ancf, PetscInt beam, PetscReal s, const PetscReal F[3]);
FROND_EXTERN PetscErrorCode AncfAddLineLoad(Ancf ancf, PetscInt beam, const PetscReal q[3]);
FROND_EXTERN PetscErrorCode AncfSetMoment(Ancf ancf, PetscInt beam, PetscInt node, const PetscReal M[3]);
FROND_EXTERN PetscErrorCode AncfClearLoads(Ancf ancf);
/* Centreline (m), axial force (N), curvature vector (1/m) and bending moment (N m) at the fraction s of a beam's length. */
FROND_EXTERN PetscErrorCode AncfGetSection(Ancf ancf, PetscInt beam, PetscReal s, PetscReal r[3], PetscReal *N,
                                           PetscReal kappa[3], PetscReal M[3]);

/* Motion of a supported node from now on, e + v tau + a tau^2/2, and the generalised force that the support exerts; ancfmotion.c.
 */
FROND_EXTERN PetscErrorCode AncfSetNodeMotion(Ancf ancf, PetscInt beam, PetscInt node, const PetscReal e[6], const PetscReal v[6],
                                              const PetscReal a[6]);
FROND_EXTERN PetscErrorCode AncfGetNodeReaction(Ancf ancf, PetscInt beam, PetscInt node, PetscReal f[6]);

/* Iterated coupling: AncfRestoreState() goes back to the time of AncfSaveState() as often as wanted, with the history of the
   integrator for one-step methods and alpha2 (a multistep method restarts). Loads are left alone. */
FROND_EXTERN PetscErrorCode AncfSaveState(Ancf ancf);
/* Back to the time of AncfSaveState(). Errors: PETSC_ERR_ARG_WRONGSTATE before it. */
FROND_EXTERN PetscErrorCode AncfRestoreState(Ancf ancf);
/* Checkpoints: the acceleration (nodes x 6) that alpha2 carries from step to step, to be set after AncfSetState(); *A is NULL
   for other types. Without it alpha2 starts from the acceleration of the equations of motion. */
FROND_EXTERN PetscErrorCode AncfGetHistory(Ancf ancf, const PetscReal **A);
/* Set what AncfGetHistory() gave; NULL or another type than alpha2: nothing is done. */
FROND_EXTERN PetscErrorCode AncfSetHistory(Ancf ancf, const PetscReal *A);

/* Integrate from the current time to t with `substeps` TS steps (or adaptively). */
FROND_EXTERN PetscErrorCode AncfAdvance(Ancf ancf, PetscReal t);

/* Static equilibrium under the present loads and gravity, from the present shape; velocities become zero. The loads are
   applied in equal steps, each halved when Newton fails. PETSC_ERR_NOT_CONVERGED when no equilibrium is found, as for
   beams without enough supports. Options: -ancf_static_snes_..., -ancf_static_ksp_.... */
FROND_EXTERN PetscErrorCode AncfSolveStatic(Ancf ancf, PetscInt loadsteps);

/* Energies, J: kinetic, elastic (axial + bending), potential (of gravity less buoyancy, -sum (rho_s A - rho A_outer) g.r, and of
   permanent point and line loads). */
FROND_EXTERN PetscErrorCode AncfGetEnergy(Ancf ancf, PetscReal *kinetic, PetscReal *elastic, PetscReal *potential);
/* Total linear momentum (kg m/s) and angular momentum about the origin (kg m^2/s); either may be NULL. */
FROND_EXTERN PetscErrorCode AncfGetMomentum(Ancf ancf, PetscReal p[3], PetscReal L[3]);
/* Force of the supports (clamped and pinned ends) on the beams, and of gravity less buoyancy, N. */
FROND_EXTERN PetscErrorCode AncfGetReaction(Ancf ancf, PetscReal f[3]);
/* Gravity less buoyancy on all beams, N. */
FROND_EXTERN PetscErrorCode AncfGetWeight(Ancf ancf, PetscReal f[3]);
/* Counters since AncfSetUp(): TS steps, Newton iterations, linear iterations; the largest over the groups of beams. */
FROND_EXTERN PetscErrorCode AncfGetCounts(Ancf ancf, PetscInt *steps, PetscInt *newton, PetscInt *linear);

/* Shape functions S1..S4 of Eq. 19, their first and second x-derivatives at xi in [0,1] of an element of length l (m). */
FROND_EXTERN void AncfShape(PetscReal xi, PetscReal l, PetscReal S[4]);
FROND_EXTERN void AncfShapeX(PetscReal xi, PetscReal l, PetscReal Sx[4]);
FROND_EXTERN void AncfShapeXX(PetscReal xi, PetscReal l, PetscReal Sxx[4]);

#endif
