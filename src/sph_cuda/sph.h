/*
  sph.h - public interface of the fluid of Frond: weakly compressible SPH markers and BCE boundary markers.

  Method: Pazouki, Serban, Negrut (the paper), Eqs. 1-11. Backends "cpu" (OpenMP + SIMD) and "cuda" run the same
  pair equations (sphpair.h). SI units. Coordinates are always 3 numbers per marker; in 2D the third is ignored
  and masses and forces are per unit depth (kg/m, N/m).

  Order of calls: SphCreate, setters or SphSetFromOptions, SphAddFluid / SphAddBoundary, SphSetUp, then per step
  SphStepBegin, SphSetBoundaryMotion (state at the half step), SphStepEnd, SphGetBoundaryForce,
  SphSetBoundaryMotion (state at the new time).
*/
#ifndef SPH_H
#define SPH_H

#include "frondstate.h"
#include <petscviewer.h>

/* The fluid and all markers. */
typedef struct _p_Sph *Sph;

/* Name of a backend. */
typedef const char *SphType;
/* Backend on the processor: OpenMP and SIMD. */
#define SPHCPU "cpu"
/* Backend on an NVIDIA GPU. */
#define SPHCUDA "cuda"
/* cuda when a device is there, else cpu, and says so */
#define SPHAUTO "auto"

/* Kernels: cubic spline (Monaghan 1992), Wendland C2 (1995). */
typedef enum { SPH_KERNEL_CUBIC, SPH_KERNEL_WENDLAND } SphKernelType;
/* Precision of the pair arithmetic. */
typedef enum { SPH_PRECISION_SINGLE, SPH_PRECISION_DOUBLE } SphPrecision;
/* BCE: boundary density evolved by Eq. 4 (the paper). ADAMI: pressure and velocity extrapolated (Adami et al. 2012). */
typedef enum { SPH_WALL_BCE, SPH_WALL_ADAMI } SphWallType;
/* Density re-initialisation, Eq. 9: never; the plain sum; the sum normalised by the kernel sum (Shepard). */
typedef enum { SPH_REINIT_NONE, SPH_REINIT_SUM, SPH_REINIT_SHEPARD } SphReinitType;

/*
  Viscous term. EQ6: the paper, Eq. 6. MORRIS: the same with rho_a rho_b (Morris, Fox, Zhu 1997, Eq. 22). ARTIFICIAL: Monaghan
  (1992) with the factor alpha, for nearly inviscid flows; the viscosity mu is not used then.
*/
typedef enum { SPH_VISCOSITY_EQ6, SPH_VISCOSITY_MORRIS, SPH_VISCOSITY_ARTIFICIAL } SphViscosityType;
/* Density diffusion: Molteni and Colagrossi (2009), or without the hydrostatic part, Fourtakas et al. (2019). */
typedef enum { SPH_DIFFUSION_NONE, SPH_DIFFUSION_MOLTENI, SPH_DIFFUSION_FOURTAKAS } SphDiffusionType;
/*
  Shifting of the markers relative to the fluid, sphpair.h. SUN: Sun et al. (2017), not at free surfaces; for confined and
  periodic flows, whose markers would cluster or line up.
*/
typedef enum { SPH_SHIFTING_NONE, SPH_SHIFTING_SUN } SphShiftingType;
/*
  Gradients of pressure and velocity in Eqs. 4 and 5: as there, or exact for linear fields (Bonet, Lok 1999) where the support is
  full, which costs the conservation of momentum.
*/
typedef enum { SPH_GRADIENT_NONE, SPH_GRADIENT_BONET } SphGradientType;
/* sphstep.h; rk2 and symplectic evaluate two right-hand sides per step, verlet one. */
typedef enum { SPH_INTEGRATOR_RK2, SPH_INTEGRATOR_VERLET, SPH_INTEGRATOR_SYMPLECTIC } SphIntegratorType;

/* Slip of the fluid along boundary markers (wall adami only): none, or free, no friction (Adami et al. 2012, Sect. 3.2). */
typedef enum { SPH_SLIP_NONE, SPH_SLIP_FREE } SphSlipType;

/* Names of SphSlipType. */
FROND_EXTERN const char *const SphSlipTypes[];
/* Names of SphKernelType. */
FROND_EXTERN const char *const SphKernelTypes[];
/* Names of SphPrecision. */
FROND_EXTERN const char *const SphPrecisions[];
/* Names of SphWallType. */
FROND_EXTERN const char *const SphWallTypes[];
/* Names of SphReinitType. */
FROND_EXTERN const char *const SphReinitTypes[];
/* Names of SphViscosityType. */
FROND_EXTERN const char *const SphViscosityTypes[];
/* Names of SphDiffusionType. */
FROND_EXTERN const char *const SphDiffusionTypes[];
/* Names of SphIntegratorType. */
FROND_EXTERN const char *const SphIntegratorTypes[];
/* Names of SphGradientType. */
FROND_EXTERN const char *const SphGradientTypes[];
/* Names of SphShiftingType. */
FROND_EXTERN const char *const SphShiftingTypes[];

/*
  An empty fluid with the default parameters. Several may live side by side. comm: communicator of one rank; every error
  message goes through it. sph: the new fluid. Source: the paper, Sect. 2.1, for the defaults that it gives.
*/
FROND_EXTERN PetscErrorCode SphCreate(MPI_Comm comm, Sph *sph);
/* prefix: put before sph_... in the names of the options, without a leading dash; copied; NULL or "" (default) for none. */
FROND_EXTERN PetscErrorCode SphSetOptionsPrefix(Sph sph, const char prefix[]);
/* Backend, before SphSetUp(). type: SPHCPU (default), SPHCUDA or SPHAUTO; copied; checked by SphSetUp(). */
FROND_EXTERN PetscErrorCode SphSetType(Sph sph, SphType type);
/* type: backend in use (auto is resolved by SphSetUp()); borrowed. */
FROND_EXTERN PetscErrorCode SphGetType(Sph sph, SphType *type);
/* Before markers are added. dim: 2 (x-y plane, everything per m of depth) or 3 (default). */
FROND_EXTERN PetscErrorCode SphSetDimension(Sph sph, PetscInt dim);
/* Initial marker spacing, before SphSetUp(); there is no default. dp: m, > 0. */
FROND_EXTERN PetscErrorCode SphSetSpacing(Sph sph, PetscReal dp);
/* Smoothing length, before SphSetUp(). h: m, 1 to 4 dp; the kernel reaches 2h. Source: the paper, Eq. 2. */
FROND_EXTERN PetscErrorCode SphSetSmoothingLength(Sph sph, PetscReal h);
/* Smoothing length over spacing when h itself is not set; before SphSetUp(). ratio: h/dp (-), 1 to 4, default 1.2. */
FROND_EXTERN PetscErrorCode SphSetSmoothingRatio(Sph sph, PetscReal ratio);
/* Reference density, before SphSetUp(). rho0: kg/m^3, > 0, default 1000. Source: the paper, Eq. 7. */
FROND_EXTERN PetscErrorCode SphSetDensity(Sph sph, PetscReal rho0);
/* Dynamic viscosity, before SphSetUp(). mu: Pa s, >= 0, default 0.001. Source: the paper, Eq. 6. */
FROND_EXTERN PetscErrorCode SphSetViscosity(Sph sph, PetscReal mu);
/*
  Speed that the flow is expected to reach: the speed of sound is ten times it unless set. vmax: m/s, > 0. Source: the paper,
  Eq. 8.
*/
FROND_EXTERN PetscErrorCode SphSetMaxSpeed(Sph sph, PetscReal vmax);
/* Numerical speed of sound, before SphSetUp(). cs: m/s, > 0; default 10 vmax. Source: the paper, Eq. 7. */
FROND_EXTERN PetscErrorCode SphSetSoundSpeed(Sph sph, PetscReal cs);
/* Exponent of the equation of state, before SphSetUp(). gamma: (-), 1 to 20, default 7. Source: the paper, Eq. 7. */
FROND_EXTERN PetscErrorCode SphSetGamma(Sph sph, PetscReal gamma);
/* Constant added to the pressure of the equation of state, before SphSetUp(). pb: Pa, >= 0, default 0. */
FROND_EXTERN PetscErrorCode SphSetBackgroundPressure(Sph sph, PetscReal pb);
/*
  Factor of the XSPH velocity, before SphSetUp(). zeta: (-), 0 (no XSPH) to 1, default 0.5. Source: the paper, Eq. 11. It is
  reduced where markers crowd so much (the sum w of V W above (1 + zeta)/(2 zeta)) that they would all but stop or move against
  their velocity.
*/
FROND_EXTERN PetscErrorCode SphSetXSPH(Sph sph, PetscReal zeta);
/*
  Re-initialisation of the density, before SphSetUp(). type: form of the sum, default Shepard. every: its period in steps, >=
  1, default 10. Source: the paper, Eq. 9; Shepard's form divides by the kernel sum.
*/
FROND_EXTERN PetscErrorCode SphSetDensityReinit(Sph sph, SphReinitType type, PetscInt every);
/*
  Regularisation of the viscous term, before SphSetUp(). epsilon: (-), in units of h^2, 1e-6 to 1, default 0.01. Source: the
  paper, Eq. 6.
*/
FROND_EXTERN PetscErrorCode SphSetViscosityEpsilon(Sph sph, PetscReal epsilon);
/* Whether kernel, gradient and viscous sums are normalised on the initial lattice; before SphSetUp(). normalise: default yes. */
FROND_EXTERN PetscErrorCode SphSetLatticeNormalisation(Sph sph, PetscBool normalise);
/*
  Form of the viscous term, before SphSetUp(). type: see SphViscosityType. Source: the paper, Eq. 6; Morris, Fox, Zhu (1997),
  Eq. 22; Monaghan (1992).
*/
FROND_EXTERN PetscErrorCode SphSetViscosityType(Sph sph, SphViscosityType type);
/*
  Factor of the artificial viscosity, before SphSetUp(); acts like nu = alpha c_s h/(2 (dim + 2)). alpha: (-), 0 to 10,
  default 0.1. Source: Monaghan (2005), Sect. 7.
*/
FROND_EXTERN PetscErrorCode SphSetArtificialViscosity(Sph sph, PetscReal alpha);
/*
  Density diffusion, before SphSetUp(). type: form. delta: its factor (-), 0 to 1, default 0.1. Source: Molteni and Colagrossi
  (2009); Fourtakas et al. (2019).
*/
FROND_EXTERN PetscErrorCode SphSetDensityDiffusion(Sph sph, SphDiffusionType type, PetscReal delta);
/*
  Shifting velocity, before SphSetUp(). type: form. factor: A of sphpair.h (-), 0 to 5, default 2; large ones stir the fluid.
  Source: Sun et al. (2017).
*/
FROND_EXTERN PetscErrorCode SphSetShifting(Sph sph, SphShiftingType type, PetscReal factor);
/*
  Kernel gradient correction, before SphSetUp(); on the CPU only, and with shifting, since exact gradients do not keep markers in
  order as Eq. 5 does. type: none (default) or bonet. Source: Bonet, Lok, Comput.
  Methods Appl. Mech. Eng. 180 (1999).
*/
FROND_EXTERN PetscErrorCode SphSetGradientCorrection(Sph sph, SphGradientType type);
/* Time integrator of the fluid, before SphSetUp(). integrator: rk2 (default), verlet or symplectic; equations in sphstep.h. */
FROND_EXTERN PetscErrorCode SphSetIntegrator(Sph sph, SphIntegratorType integrator);
/*
  Smoothing kernel, before SphSetUp(). kernel: cubic spline (default) or Wendland C2. Source: the paper, Eq. 2; Wendland
  (1995).
*/
FROND_EXTERN PetscErrorCode SphSetKernel(Sph sph, SphKernelType kernel);
/* Precision of the pair arithmetic, before SphSetUp(). precision: single (default) or double; the state is double in both. */
FROND_EXTERN PetscErrorCode SphSetPrecision(Sph sph, SphPrecision precision);
/* Boundary treatment, before SphSetUp(). wall: bce, or adami (default). Source: the paper, Sect. 2.4; Adami et al. (2012). */
FROND_EXTERN PetscErrorCode SphSetWall(Sph sph, SphWallType wall);
/*
  Slip along all boundary markers, before SphSetUp(). slip: none (default) or free; free needs wall adami. Source: Adami et
  al. (2012), Sect. 3.2.
*/
FROND_EXTERN PetscErrorCode SphSetSlip(Sph sph, SphSlipType slip);
/*
  Slip along the markers of one group, after SphAddBoundary() and before SphSetUp(). group: as SphAddBoundary() gave it. slip:
  none or free.
*/
FROND_EXTERN PetscErrorCode SphSetGroupSlip(Sph sph, PetscInt group, SphSlipType slip);
/* Body force per mass. f: 3, m/s^2, default 0. */
FROND_EXTERN PetscErrorCode SphSetBodyForce(Sph sph, const PetscReal f[3]);
/*
  Part of the body force that changes with time, on top of SphSetBodyForce(), such as a ramp of the seed's accelerating channel;
  linear between the entries, constant before and after; before SphSetUp(). n: entries, 0 for none. t: n, s, increasing. f: n x 3,
  m/s^2.
*/
FROND_EXTERN PetscErrorCode SphSetBodyForceTable(Sph sph, PetscInt n, const PetscReal t[], const PetscReal f[]);
/*
  Corners of the domain, before SphSetUp(); markers that leave it are taken out. lo: 3, m. hi: 3, m, above lo; the third
  number is ignored in 2D.
*/
FROND_EXTERN PetscErrorCode SphSetDomain(Sph sph, const PetscReal lo[3], const PetscReal hi[3]);
/* Which axes are periodic, before SphSetUp(). periodic: 3 flags; the domain is then a whole period along the axis. */
FROND_EXTERN PetscErrorCode SphSetPeriodic(Sph sph, const PetscBool periodic[3]);
/* Fixed time step. dt: s, > 0; PETSC_DECIDE (-1, default): the largest stable one each step. */
FROND_EXTERN PetscErrorCode SphSetTimeStep(Sph sph, PetscReal dt);
/* Safety factor of the stable step. cfl: (-), in (0, 1], default 0.25. */
FROND_EXTERN PetscErrorCode SphSetCFL(Sph sph, PetscReal cfl);
/* Floor of the stable step: below it the run ends with PETSC_ERR_CONV_FAILED. dtmin: s, >= 0; 0 (default) for none. */
FROND_EXTERN PetscErrorCode SphSetMinTimeStep(Sph sph, PetscReal dtmin);
/*
  Speed of a marker over the speed of sound above which the run ends with PETSC_ERR_CONV_FAILED: it has become unstable, or the
  speed of sound is too low. ratio: (-), >= 0, default 1; 0 for none.
*/
FROND_EXTERN PetscErrorCode SphSetSpeedStop(Sph sph, PetscReal ratio);
/* Period of the search for values that are not finite. every: steps, >= 1, default 10. */
FROND_EXTERN PetscErrorCode SphSetCheckEvery(Sph sph, PetscInt every);
/* Read -sph_... (with the prefix) into the setters above; `frond help` and README list them. */
FROND_EXTERN PetscErrorCode SphSetFromOptions(Sph sph);
/*
  Check the parameters, choose the backend, sort the markers and evaluate the first right-hand side; parameters and markers
  are fixed from then on.
*/
FROND_EXTERN PetscErrorCode SphSetUp(Sph sph);
/* Print parameters and counts. viewer: an ASCII viewer of PETSc. */
FROND_EXTERN PetscErrorCode SphView(Sph sph, PetscViewer viewer);
/* Free everything. sph: the fluid; becomes NULL. */
FROND_EXTERN PetscErrorCode SphDestroy(Sph *sph);

/* dim: 2 or 3. */
FROND_EXTERN PetscErrorCode SphGetDimension(Sph sph, PetscInt *dim);
/* dp: marker spacing, m. */
FROND_EXTERN PetscErrorCode SphGetSpacing(Sph sph, PetscReal *dp);
/* h: smoothing length, m. */
FROND_EXTERN PetscErrorCode SphGetSmoothingLength(Sph sph, PetscReal *h);
/* rho0: reference density, kg/m^3. */
FROND_EXTERN PetscErrorCode SphGetDensity(Sph sph, PetscReal *rho0);
/* mu: dynamic viscosity, Pa s. */
FROND_EXTERN PetscErrorCode SphGetViscosity(Sph sph, PetscReal *mu);
/* cs: numerical speed of sound, m/s. */
FROND_EXTERN PetscErrorCode SphGetSoundSpeed(Sph sph, PetscReal *cs);
/* f: 3, body force per mass, m/s^2. */
FROND_EXTERN PetscErrorCode SphGetBodyForce(Sph sph, PetscReal f[3]);
/* Each output may be NULL. lo: 3, m. hi: 3, m. periodic: 3 flags. */
FROND_EXTERN PetscErrorCode SphGetDomain(Sph sph, PetscReal lo[3], PetscReal hi[3], PetscBool periodic[3]);
/* support: the depth below a surface to which BCE markers are needed, 2h, m. Source: the paper, Sect. 2.4. */
FROND_EXTERN PetscErrorCode SphGetSupport(Sph sph, PetscReal *support);

/*
  Fluid markers of mass rho(p) dp^dim, rho(p) the density at the initial pressure; before any SphAddBoundary(). n: number, >=
  0. x: n x 3, m. v: n x 3, m/s, or NULL for rest. p: n, Pa, or NULL for 0. Source: the paper, Eq. 7 inverted.
*/
FROND_EXTERN PetscErrorCode SphAddFluid(Sph sph, PetscInt n, const PetscReal *x, const PetscReal *v, const PetscReal *p);
/*
  A group of boundary markers (a wall, a beam, a body) of mass rho0 volume. n: number, >= 0. x: n x 3, m. v: n x 3, m/s, or
  NULL for rest. volume: n, m^3 (2D: m^2), > 0. depth: n, m below the surface. group: its number. Source: the paper, Sect.
  2.4.
*/
FROND_EXTERN PetscErrorCode SphAddBoundary(Sph sph, PetscInt n, const PetscReal *x, const PetscReal *v, const PetscReal *volume,
                                           const PetscReal *depth, PetscInt *group);
/* Each output may be NULL. fluid: fluid markers. boundary: boundary markers. left: fluid markers that left the domain. */
FROND_EXTERN PetscErrorCode SphGetCounts(Sph sph, PetscInt *fluid, PetscInt *boundary, PetscInt *left);

/* dt: the largest stable time step now (acoustic, force and viscous limits), or the fixed one after checking it, s. */
FROND_EXTERN PetscErrorCode SphComputeTimeStep(Sph sph, PetscReal *dt);
/* First stage: rates at t, fluid at t + dt/2 (verlet: it stays). Set the boundary motion at t + dt/2 next. dt: s, > 0. */
FROND_EXTERN PetscErrorCode SphStepBegin(Sph sph, PetscReal dt);
/*
  Second-stage rates and boundary forces for the boundary motion as set now; may be repeated with another motion before
  SphStepEnd(), which then takes the last ones. Not with verlet.
*/
FROND_EXTERN PetscErrorCode SphStepEvaluate(Sph sph);
/*
  Second stage: rates and boundary forces at t + dt/2 (verlet: those at t stay), fluid at t + dt. Set the boundary motion at t
  + dt next.
*/
FROND_EXTERN PetscErrorCode SphStepEnd(Sph sph);
/* Each output may be NULL. t: time, s. step: number of steps. */
FROND_EXTERN PetscErrorCode SphGetTime(Sph sph, PetscReal *t, PetscInt *step);

/*
  State of a group's markers, in the order of SphAddBoundary(). group: as SphAddBoundary() gave it. x: n x 3, m. v: n x 3,
  m/s. a: n x 3, m/s^2, or NULL for 0. On the CPU different groups may be set by different threads at once.
*/
FROND_EXTERN PetscErrorCode SphSetBoundaryMotion(Sph sph, PetscInt group, const PetscReal *x, const PetscReal *v,
                                                 const PetscReal *a);
/*
  Angular velocity of the wall at a group's markers, 0 until set; wall adami needs it for no-slip to be of second order at walls
  that turn. Kept until set anew. group: as SphAddBoundary() gave it. omega: n x 3, rad/s, in the order of SphAddBoundary(); only
  the third number counts in 2D. Source: sph_wall_velocity() of sphpair.h.
*/
FROND_EXTERN PetscErrorCode SphSetBoundaryRotation(Sph sph, PetscInt group, const PetscReal *omega);
/*
  Fluid forces on a group's markers: the right-hand side of Eq. 5 times the marker mass. group: as SphAddBoundary() gave it.
  f: n x 3, N (2D: N/m). Source: the paper, Eq. 5 and Sect. 2.4.
*/
FROND_EXTERN PetscErrorCode SphGetBoundaryForce(Sph sph, PetscInt group, PetscReal *f);

/* Fields of all markers in the order added (fluid first, then groups). Any pointer may be NULL. */
typedef struct {
  PetscReal *x, *v;   /* n x 3, m, m/s */
  PetscReal *a;       /* n x 3, m/s^2, last right-hand side of Eq. 5 */
  PetscReal *rho, *p; /* n, kg/m^3, Pa */
  PetscInt *group;    /* n, -1 fluid, -2 left the domain, else the boundary group */
} SphFields;
/* Copy fields, in the order added. f: arrays to fill, each with room for all markers or NULL. */
FROND_EXTERN PetscErrorCode SphGetFields(Sph sph, const SphFields *f);
/*
  Overwrite fields, for initial conditions, restart and fault tests. f: x, v, rho as given, each may be NULL; the others are
  ignored.
*/
FROND_EXTERN PetscErrorCode SphSetFields(Sph sph, const SphFields *f);

/* bytes: what SphSaveState() needs right now. */
FROND_EXTERN PetscErrorCode SphGetStateSize(Sph sph, size_t *bytes);
/*
  The whole state between two steps, for rolling back a step or restarting: the run goes on with the same bits after
  SphRestoreState() as it did after saving. Fits the same scene, backend and machine only. bytes: of SphGetStateSize(), asked
  right before. buffer: bytes long, written.
*/
FROND_EXTERN PetscErrorCode SphSaveState(Sph sph, size_t bytes, void *buffer);
/* Go back to a saved state. bytes: length of the buffer. buffer: what SphSaveState() wrote. */
FROND_EXTERN PetscErrorCode SphRestoreState(Sph sph, size_t bytes, const void *buffer);

/* The same state as named arrays that every backend reads, see frondstate.h. state: saved to or loaded from. */
FROND_EXTERN PetscErrorCode SphMoveState(Sph sph, FrondState *state);

/* Sums over fluid markers: mass (kg), linear momentum (kg m/s), kinetic energy (J), max speed (m/s), max |rho/rho0-1|. */
typedef struct {
  PetscReal mass, momentum[3];            /* kg, kg m/s; in 2D per m */
  PetscReal kinetic, potential, internal; /* J */
  PetscReal vmax, compression;            /* m/s, - */
} SphSums;
/* sums: over the fluid markers now. */
FROND_EXTERN PetscErrorCode SphGetSums(Sph sph, SphSums *sums);
/* What balances of energy and angular momentum need besides SphSums; W and kg m^2/s, in 2D per m. */
typedef struct {
  PetscReal viscous;               /* heat that viscous forces make between fluid markers and their neighbours, W */
  PetscReal pressure;              /* power of pressure forces on the relative motion of fluid markers and their neighbours, W */
  PetscReal angular[3], centre[3]; /* angular momentum about the origin, kg m^2/s; sum of m x over the mass, m */
} SphAudit;
/*
  The audit of the fluid now, from a sum over pairs in double precision on the host: costs about as much as some steps and changes
  nothing. Boundary markers have the pressure and velocity that the last evaluation gave them. audit: filled. Source: power of
  each pair force of sphpair.h; their sum is d/dt of the kinetic energy less the work of body and boundary forces.
*/
FROND_EXTERN PetscErrorCode SphGetAudit(Sph sph, SphAudit *audit);
/* Fields at points: the kernel-weighted mean (Shepard), or a linear least squares fit, exact for linear fields also at walls. */
typedef enum { SPH_INTERPOLATE_SHEPARD, SPH_INTERPOLATE_LINEAR } SphInterpolation;
/* Names of SphInterpolation. */
FROND_EXTERN const char *const SphInterpolations[];
/* What SphInterpolate() gives at n points; any may be NULL. NaN where no fluid marker lies within 2h. */
typedef struct {
  PetscReal *v, *p;    /* n x 3, m/s; n, Pa */
  PetscReal *rho;      /* n, kg/m^3 */
  PetscReal *fraction; /* n: part of the surroundings that is fluid, the kernel sum; 1 inside, about 0.5 at a surface */
} SphPoints;
/*
  Fields of the fluid at points, from the fluid markers around them. how: mean or linear fit. n: number of points. x: n x 3, m.
  out: the arrays to fill. Source: Shepard (1968); Lancaster, Salkauskas (1981).
*/
FROND_EXTERN PetscErrorCode SphInterpolate(Sph sph, SphInterpolation how, PetscInt n, const PetscReal *x, const SphPoints *out);
/*
  Velocity and pressure at points by Shepard interpolation over fluid markers; NaN where none is near. n: number of points. x:
  n x 3, m. v: n x 3, m/s, or NULL. p: n, Pa, or NULL.
*/
FROND_EXTERN PetscErrorCode SphSample(Sph sph, PetscInt n, const PetscReal *x, PetscReal *v, PetscReal *p);

/* Flow through a plane: in 2D per metre of depth. */
typedef struct {
  PetscReal area;         /* wetted, m^2 */
  PetscReal volume, mass; /* flow, m^3/s, kg/s */
  PetscReal pressure;     /* mean over the wetted area, Pa; 0 when dry */
} SphPlane;
/*
  Flow through a parallelogram, positive along edge1 x edge2; in 2D through the line along edge1, positive along (edge1_y,
  -edge1_x). corner: 3, m. edge1: 3, m. edge2: 3, m; NULL in 2D. plane: the flow.
*/
FROND_EXTERN PetscErrorCode SphGetPlane(Sph sph, const PetscReal corner[3], const PetscReal edge1[3], const PetscReal edge2[3],
                                        SphPlane *plane);

/* Each output may be NULL. bytes: memory of the markers. evaluations: marker evaluations since set-up, for throughput figures. */
FROND_EXTERN PetscErrorCode SphGetWork(Sph sph, PetscReal *bytes, PetscReal *evaluations);

#endif
