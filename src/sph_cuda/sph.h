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

#include "frondsys.h"
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
/* Names of SphShiftingType. */
FROND_EXTERN const char *const SphShiftingTypes[];

FROND_EXTERN PetscErrorCode SphCreate(MPI_Comm comm, Sph *sph);
/* Prefix put before -sph_... in the options. */
FROND_EXTERN PetscErrorCode SphSetOptionsPrefix(Sph sph, const char prefix[]);
/* Backend: cpu, cuda or auto. */
FROND_EXTERN PetscErrorCode SphSetType(Sph sph, SphType type);
/* Backend in use (auto is resolved by SphSetUp()); borrowed. */
FROND_EXTERN PetscErrorCode SphGetType(Sph sph, SphType *type);
/* 2 or 3. Before markers are added. */
FROND_EXTERN PetscErrorCode SphSetDimension(Sph sph, PetscInt dim);
/* Initial marker spacing dp, m, > 0. */
FROND_EXTERN PetscErrorCode SphSetSpacing(Sph sph, PetscReal dp);
/* Smoothing length h, m, 1 to 4 dp; the kernel reaches 2h. */
FROND_EXTERN PetscErrorCode SphSetSmoothingLength(Sph sph, PetscReal h);
/* h/dp, when h is not set: 1 to 4, default 1.2. */
FROND_EXTERN PetscErrorCode SphSetSmoothingRatio(Sph sph, PetscReal ratio);
/* Reference density rho0, kg/m^3, > 0. */
FROND_EXTERN PetscErrorCode SphSetDensity(Sph sph, PetscReal rho0);
/* Viscosity mu, Pa s, >= 0. */
FROND_EXTERN PetscErrorCode SphSetViscosity(Sph sph, PetscReal mu);
/* Expected maximum speed, m/s: the speed of sound is ten times it unless set. */
FROND_EXTERN PetscErrorCode SphSetMaxSpeed(Sph sph, PetscReal vmax);
/* Numerical speed of sound c_s, m/s, > 0. */
FROND_EXTERN PetscErrorCode SphSetSoundSpeed(Sph sph, PetscReal cs);
/* Exponent of the equation of state, Eq. 7; default 7. */
FROND_EXTERN PetscErrorCode SphSetGamma(Sph sph, PetscReal gamma);
/* Pressure added everywhere, Pa. */
FROND_EXTERN PetscErrorCode SphSetBackgroundPressure(Sph sph, PetscReal pb);
/* Factor zeta of Eq. 11, default 0.5; 0: no XSPH. */
FROND_EXTERN PetscErrorCode SphSetXSPH(Sph sph, PetscReal zeta);
/* Density re-initialisation, Eq. 9, and its period in steps. */
FROND_EXTERN PetscErrorCode SphSetDensityReinit(Sph sph, SphReinitType type, PetscInt every);
/* Regularisation of Eq. 6, default 0.01. */
FROND_EXTERN PetscErrorCode SphSetViscosityEpsilon(Sph sph, PetscReal epsilon);
/* Whether kernel sums are normalised on the initial lattice (default: yes). */
FROND_EXTERN PetscErrorCode SphSetLatticeNormalisation(Sph sph, PetscBool normalise);
/* Form of the viscous term. */
FROND_EXTERN PetscErrorCode SphSetViscosityType(Sph sph, SphViscosityType type);
/* Factor alpha of the artificial viscosity (default 0.1); acts like nu = alpha c_s h/(2 (dim + 2)) (Monaghan 2005). */
FROND_EXTERN PetscErrorCode SphSetArtificialViscosity(Sph sph, PetscReal alpha);
/* Density diffusion and its factor delta (default 0.1). */
FROND_EXTERN PetscErrorCode SphSetDensityDiffusion(Sph sph, SphDiffusionType type, PetscReal delta);
/* Shifting velocity and its factor A, sphpair.h (default 2; large ones stir the fluid). */
FROND_EXTERN PetscErrorCode SphSetShifting(Sph sph, SphShiftingType type, PetscReal factor);
/* Time integrator of the fluid. */
FROND_EXTERN PetscErrorCode SphSetIntegrator(Sph sph, SphIntegratorType integrator);
/* Kernel: cubic spline (default) or Wendland C2. */
FROND_EXTERN PetscErrorCode SphSetKernel(Sph sph, SphKernelType kernel);
/* Precision of the pair arithmetic; the state is double in both. */
FROND_EXTERN PetscErrorCode SphSetPrecision(Sph sph, SphPrecision precision);
/* Boundary treatment. */
FROND_EXTERN PetscErrorCode SphSetWall(Sph sph, SphWallType wall);
/* Of all boundary markers; SphSetGroupSlip() for one group, after SphAddBoundary() and before SphSetUp(). */
FROND_EXTERN PetscErrorCode SphSetSlip(Sph sph, SphSlipType slip);
FROND_EXTERN PetscErrorCode SphSetGroupSlip(Sph sph, PetscInt group, SphSlipType slip);
/* Body force per mass, m/s^2. */
FROND_EXTERN PetscErrorCode SphSetBodyForce(Sph sph, const PetscReal f[3]);
/* Corners of the domain, m; the third coordinate is ignored in 2D. */
FROND_EXTERN PetscErrorCode SphSetDomain(Sph sph, const PetscReal lo[3], const PetscReal hi[3]);
/* Which axes are periodic. */
FROND_EXTERN PetscErrorCode SphSetPeriodic(Sph sph, const PetscBool periodic[3]);
/* Fixed time step, s; PETSC_DECIDE (-1): the largest stable one. */
FROND_EXTERN PetscErrorCode SphSetTimeStep(Sph sph, PetscReal dt);
/* Safety factor of the stable step, default 0.25. */
FROND_EXTERN PetscErrorCode SphSetCFL(Sph sph, PetscReal cfl);
/* A stable step below this floor (s) ends the run with PETSC_ERR_CONV_FAILED; 0 (default) for none. */
FROND_EXTERN PetscErrorCode SphSetMinTimeStep(Sph sph, PetscReal dtmin);
/* Steps between searches for non-finite values, >= 1. */
FROND_EXTERN PetscErrorCode SphSetCheckEvery(Sph sph, PetscInt every);
/* Read -sph_.... */
FROND_EXTERN PetscErrorCode SphSetFromOptions(Sph sph);
FROND_EXTERN PetscErrorCode SphSetUp(Sph sph);
/* Print parameters and counts. */
FROND_EXTERN PetscErrorCode SphView(Sph sph, PetscViewer viewer);
/* Free everything; *sph becomes NULL. */
FROND_EXTERN PetscErrorCode SphDestroy(Sph *sph);

/* 2 or 3. */
FROND_EXTERN PetscErrorCode SphGetDimension(Sph sph, PetscInt *dim);
/* Marker spacing, m. */
FROND_EXTERN PetscErrorCode SphGetSpacing(Sph sph, PetscReal *dp);
/* Smoothing length, m. */
FROND_EXTERN PetscErrorCode SphGetSmoothingLength(Sph sph, PetscReal *h);
/* Reference density, kg/m^3. */
FROND_EXTERN PetscErrorCode SphGetDensity(Sph sph, PetscReal *rho0);
/* Viscosity, Pa s. */
FROND_EXTERN PetscErrorCode SphGetViscosity(Sph sph, PetscReal *mu);
/* Numerical speed of sound, m/s. */
FROND_EXTERN PetscErrorCode SphGetSoundSpeed(Sph sph, PetscReal *cs);
/* Body force per mass, m/s^2. */
FROND_EXTERN PetscErrorCode SphGetBodyForce(Sph sph, PetscReal f[3]);
/* Corners (m) and periodic axes; any may be NULL. */
FROND_EXTERN PetscErrorCode SphGetDomain(Sph sph, PetscReal lo[3], PetscReal hi[3], PetscBool periodic[3]);
/* The depth below a surface to which BCE markers are needed: 2h. */
FROND_EXTERN PetscErrorCode SphGetSupport(Sph sph, PetscReal *support);

/*
  Markers. x, v: n x 3 (m, m/s; v may be NULL for rest). p: n (Pa) initial pressures, or NULL for zero.
  Boundary markers form groups (walls, each beam, each rigid body); volume: n (m^3), depth: n (m below the
  surface). Marker masses are rho(p) dp^dim for fluid, rho(p) the
  density at the initial pressure, and rho0 volume for boundary markers.
*/
FROND_EXTERN PetscErrorCode SphAddFluid(Sph sph, PetscInt n, const PetscReal *x, const PetscReal *v, const PetscReal *p);
FROND_EXTERN PetscErrorCode SphAddBoundary(Sph sph, PetscInt n, const PetscReal *x, const PetscReal *v, const PetscReal *volume,
                                           const PetscReal *depth, PetscInt *group);
/* Numbers of fluid markers, of boundary markers, and of fluid markers that left the domain; any may be NULL. */
FROND_EXTERN PetscErrorCode SphGetCounts(Sph sph, PetscInt *fluid, PetscInt *boundary, PetscInt *left);

/* The largest stable time step now (acoustic, force and viscous limits), or the fixed one after checking it. */
FROND_EXTERN PetscErrorCode SphComputeTimeStep(Sph sph, PetscReal *dt);
FROND_EXTERN PetscErrorCode SphStepBegin(Sph sph, PetscReal dt);
FROND_EXTERN PetscErrorCode SphStepEvaluate(Sph sph);
FROND_EXTERN PetscErrorCode SphStepEnd(Sph sph);
/* Time (s) and number of steps; either may be NULL. */
FROND_EXTERN PetscErrorCode SphGetTime(Sph sph, PetscReal *t, PetscInt *step);

/* State of a group's markers: x (m), v (m/s), a (m/s^2; NULL for zero), n x 3, in the order of SphAddBoundary. */
FROND_EXTERN PetscErrorCode SphSetBoundaryMotion(Sph sph, PetscInt group, const PetscReal *x, const PetscReal *v,
                                                 const PetscReal *a);
/* Fluid forces on a group's markers from the last right-hand side of Eq. 5, times the marker mass: n x 3, N. */
FROND_EXTERN PetscErrorCode SphGetBoundaryForce(Sph sph, PetscInt group, PetscReal *f);

/* Fields of all markers in the order added (fluid first, then groups). Any pointer may be NULL. */
typedef struct {
  PetscReal *x, *v;   /* n x 3, m, m/s */
  PetscReal *a;       /* n x 3, m/s^2, last right-hand side of Eq. 5 */
  PetscReal *rho, *p; /* n, kg/m^3, Pa */
  PetscInt *group;    /* n, -1 fluid, -2 left the domain, else the boundary group */
} SphFields;
/* Copy fields into the arrays given. */
FROND_EXTERN PetscErrorCode SphGetFields(Sph sph, const SphFields *f);
/* Overwrite fields (x, v, rho as given, others ignored); for initial conditions, restart and fault tests. */
FROND_EXTERN PetscErrorCode SphSetFields(Sph sph, const SphFields *f);

/*
  The whole state between two steps as bytes, for rolling back a step or restarting: the run goes on with the same bits after
  SphRestoreState() as it did after SphSaveState(). bytes: what SphGetStateSize() gives right before saving. The buffer fits the
  same scene, backend and machine only. Errors: PETSC_ERR_ARG_SIZ when the markers or the buffer's size do not fit.
*/
FROND_EXTERN PetscErrorCode SphGetStateSize(Sph sph, size_t *bytes);
/* Write the state to buffer (bytes long). */
FROND_EXTERN PetscErrorCode SphSaveState(Sph sph, size_t bytes, void *buffer);
/* Go back to the state in buffer. */
FROND_EXTERN PetscErrorCode SphRestoreState(Sph sph, size_t bytes, const void *buffer);

/* Sums over fluid markers: mass (kg), linear momentum (kg m/s), kinetic energy (J), max speed (m/s), max |rho/rho0-1|. */
typedef struct {
  PetscReal mass, momentum[3];            /* kg, kg m/s; in 2D per m */
  PetscReal kinetic, potential, internal; /* J */
  PetscReal vmax, compression;            /* m/s, - */
} SphSums;
/* The sums of SphSums over the fluid now. */
FROND_EXTERN PetscErrorCode SphGetSums(Sph sph, SphSums *sums);
/* Fluid velocity and pressure at points (n x 3) by Shepard interpolation over fluid markers; NaN where no marker is near. */
FROND_EXTERN PetscErrorCode SphSample(Sph sph, PetscInt n, const PetscReal *x, PetscReal *v, PetscReal *p);

/* Bytes of memory that n markers need, and a marker-evaluation count since set-up for throughput figures. */
FROND_EXTERN PetscErrorCode SphGetWork(Sph sph, PetscReal *bytes, PetscReal *evaluations);

#endif
