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

typedef struct _p_Sph *Sph;

typedef const char *SphType;
#define SPHCPU "cpu"
#define SPHCUDA "cuda"
#define SPHAUTO "auto" /* cuda when a device is there, else cpu, and says so */

typedef enum { SPH_KERNEL_CUBIC, SPH_KERNEL_WENDLAND } SphKernelType;
typedef enum { SPH_PRECISION_SINGLE, SPH_PRECISION_DOUBLE } SphPrecision;
/* BCE: boundary density evolved by Eq. 4 (the paper). ADAMI: pressure and velocity extrapolated (Adami et al. 2012). */
typedef enum { SPH_WALL_BCE, SPH_WALL_ADAMI } SphWallType;
/* Density re-initialisation, Eq. 9: never; the plain sum; the sum normalised by the kernel sum (Shepard). */
typedef enum { SPH_REINIT_NONE, SPH_REINIT_SUM, SPH_REINIT_SHEPARD } SphReinitType;

/*
  Viscous term. EQ6: the paper, Eq. 6. MORRIS: the same with rho_a rho_b (Morris, Fox, Zhu 1997, Eq. 22). ARTIFICIAL: Monaghan (1992) with the factor
  alpha, for nearly inviscid flows; the viscosity mu is not used then.
*/
typedef enum { SPH_VISCOSITY_EQ6, SPH_VISCOSITY_MORRIS, SPH_VISCOSITY_ARTIFICIAL } SphViscosityType;
/* Density diffusion: Molteni and Colagrossi (2009), or without the hydrostatic part, Fourtakas et al. (2019). */
typedef enum { SPH_DIFFUSION_NONE, SPH_DIFFUSION_MOLTENI, SPH_DIFFUSION_FOURTAKAS } SphDiffusionType;
/*
  Shifting of the markers relative to the fluid, sphpair.h. SUN: Sun et al. (2017), not at free surfaces; for confined and periodic
  flows, whose markers would cluster or line up.
*/
typedef enum { SPH_SHIFTING_NONE, SPH_SHIFTING_SUN } SphShiftingType;
/* sphstep.h; rk2 and symplectic evaluate two right-hand sides per step, verlet one. */
typedef enum { SPH_INTEGRATOR_RK2, SPH_INTEGRATOR_VERLET, SPH_INTEGRATOR_SYMPLECTIC } SphIntegratorType;

/* Slip of the fluid along boundary markers (wall adami only): none, or free, no friction (Adami et al. 2012, Sect. 3.2). */
typedef enum { SPH_SLIP_NONE, SPH_SLIP_FREE } SphSlipType;

FROND_EXTERN const char *const SphSlipTypes[];
FROND_EXTERN const char *const SphKernelTypes[];
FROND_EXTERN const char *const SphPrecisions[];
FROND_EXTERN const char *const SphWallTypes[];
FROND_EXTERN const char *const SphReinitTypes[];
FROND_EXTERN const char *const SphViscosityTypes[];
FROND_EXTERN const char *const SphDiffusionTypes[];
FROND_EXTERN const char *const SphIntegratorTypes[];
FROND_EXTERN const char *const SphShiftingTypes[];

FROND_EXTERN PetscErrorCode SphCreate(MPI_Comm comm, Sph *sph);
FROND_EXTERN PetscErrorCode SphSetOptionsPrefix(Sph sph, const char prefix[]);
FROND_EXTERN PetscErrorCode SphSetType(Sph sph, SphType type);
FROND_EXTERN PetscErrorCode SphGetType(Sph sph, SphType *type);
FROND_EXTERN PetscErrorCode SphSetDimension(Sph sph, PetscInt dim);
FROND_EXTERN PetscErrorCode SphSetSpacing(Sph sph, PetscReal dp);
FROND_EXTERN PetscErrorCode SphSetSmoothingLength(Sph sph, PetscReal h);
FROND_EXTERN PetscErrorCode SphSetSmoothingRatio(Sph sph, PetscReal ratio);
FROND_EXTERN PetscErrorCode SphSetDensity(Sph sph, PetscReal rho0);
FROND_EXTERN PetscErrorCode SphSetViscosity(Sph sph, PetscReal mu);
FROND_EXTERN PetscErrorCode SphSetMaxSpeed(Sph sph, PetscReal vmax);
FROND_EXTERN PetscErrorCode SphSetSoundSpeed(Sph sph, PetscReal cs);
FROND_EXTERN PetscErrorCode SphSetGamma(Sph sph, PetscReal gamma);
FROND_EXTERN PetscErrorCode SphSetBackgroundPressure(Sph sph, PetscReal pb);
FROND_EXTERN PetscErrorCode SphSetXSPH(Sph sph, PetscReal zeta);
FROND_EXTERN PetscErrorCode SphSetDensityReinit(Sph sph, SphReinitType type, PetscInt every);
FROND_EXTERN PetscErrorCode SphSetViscosityEpsilon(Sph sph, PetscReal epsilon);
FROND_EXTERN PetscErrorCode SphSetLatticeNormalisation(Sph sph, PetscBool normalise);
FROND_EXTERN PetscErrorCode SphSetViscosityType(Sph sph, SphViscosityType type);
/* Factor alpha of the artificial viscosity (default 0.1); acts like nu = alpha c_s h/(2 (dim + 2)) (Monaghan 2005). */
FROND_EXTERN PetscErrorCode SphSetArtificialViscosity(Sph sph, PetscReal alpha);
/* Density diffusion and its factor delta (default 0.1). */
FROND_EXTERN PetscErrorCode SphSetDensityDiffusion(Sph sph, SphDiffusionType type, PetscReal delta);
/* Shifting velocity and its factor A, sphpair.h (default 2; large ones stir the fluid). */
FROND_EXTERN PetscErrorCode SphSetShifting(Sph sph, SphShiftingType type, PetscReal factor);
FROND_EXTERN PetscErrorCode SphSetIntegrator(Sph sph, SphIntegratorType integrator);
FROND_EXTERN PetscErrorCode SphSetKernel(Sph sph, SphKernelType kernel);
FROND_EXTERN PetscErrorCode SphSetPrecision(Sph sph, SphPrecision precision);
FROND_EXTERN PetscErrorCode SphSetWall(Sph sph, SphWallType wall);
/* Of all boundary markers; SphSetGroupSlip() for one group, after SphAddBoundary() and before SphSetUp(). */
FROND_EXTERN PetscErrorCode SphSetSlip(Sph sph, SphSlipType slip);
FROND_EXTERN PetscErrorCode SphSetGroupSlip(Sph sph, PetscInt group, SphSlipType slip);
FROND_EXTERN PetscErrorCode SphSetBodyForce(Sph sph, const PetscReal f[3]);
FROND_EXTERN PetscErrorCode SphSetDomain(Sph sph, const PetscReal lo[3], const PetscReal hi[3]);
FROND_EXTERN PetscErrorCode SphSetPeriodic(Sph sph, const PetscBool periodic[3]);
FROND_EXTERN PetscErrorCode SphSetTimeStep(Sph sph, PetscReal dt);
FROND_EXTERN PetscErrorCode SphSetCFL(Sph sph, PetscReal cfl);
/* A stable step below this floor (s) ends the run with PETSC_ERR_CONV_FAILED; 0 (default) for none. */
FROND_EXTERN PetscErrorCode SphSetMinTimeStep(Sph sph, PetscReal dtmin);
FROND_EXTERN PetscErrorCode SphSetCheckEvery(Sph sph, PetscInt every);
FROND_EXTERN PetscErrorCode SphSetFromOptions(Sph sph);
FROND_EXTERN PetscErrorCode SphSetUp(Sph sph);
FROND_EXTERN PetscErrorCode SphView(Sph sph, PetscViewer viewer);
FROND_EXTERN PetscErrorCode SphDestroy(Sph *sph);

FROND_EXTERN PetscErrorCode SphGetDimension(Sph sph, PetscInt *dim);
FROND_EXTERN PetscErrorCode SphGetSpacing(Sph sph, PetscReal *dp);
FROND_EXTERN PetscErrorCode SphGetSmoothingLength(Sph sph, PetscReal *h);
FROND_EXTERN PetscErrorCode SphGetDensity(Sph sph, PetscReal *rho0);
FROND_EXTERN PetscErrorCode SphGetViscosity(Sph sph, PetscReal *mu);
FROND_EXTERN PetscErrorCode SphGetSoundSpeed(Sph sph, PetscReal *cs);
FROND_EXTERN PetscErrorCode SphGetBodyForce(Sph sph, PetscReal f[3]);
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
FROND_EXTERN PetscErrorCode SphGetCounts(Sph sph, PetscInt *fluid, PetscInt *boundary, PetscInt *left);

/* The largest stable time step now (acoustic, force and viscous limits), or the fixed one after checking it. */
FROND_EXTERN PetscErrorCode SphComputeTimeStep(Sph sph, PetscReal *dt);
FROND_EXTERN PetscErrorCode SphStepBegin(Sph sph, PetscReal dt);
FROND_EXTERN PetscErrorCode SphStepEvaluate(Sph sph);
FROND_EXTERN PetscErrorCode SphStepEnd(Sph sph);
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
FROND_EXTERN PetscErrorCode SphGetFields(Sph sph, const SphFields *f);
/* Overwrite fields (x, v, rho as given, others ignored); for initial conditions, restart and fault tests. */
FROND_EXTERN PetscErrorCode SphSetFields(Sph sph, const SphFields *f);

/*
  The whole state between two steps as bytes, for rolling back a step or restarting: the run goes on with the same bits after
  SphRestoreState() as it did after SphSaveState(). bytes: what SphGetStateSize() gives right before saving. The buffer fits the
  same scene, backend and machine only. Errors: PETSC_ERR_ARG_SIZ when the markers or the buffer's size do not fit.
*/
FROND_EXTERN PetscErrorCode SphGetStateSize(Sph sph, size_t *bytes);
FROND_EXTERN PetscErrorCode SphSaveState(Sph sph, size_t bytes, void *buffer);
FROND_EXTERN PetscErrorCode SphRestoreState(Sph sph, size_t bytes, const void *buffer);

/* Sums over fluid markers: mass (kg), linear momentum (kg m/s), kinetic energy (J), max speed (m/s), max |rho/rho0-1|. */
typedef struct {
  PetscReal mass, momentum[3], kinetic, potential, internal, vmax, compression;
} SphSums;
FROND_EXTERN PetscErrorCode SphGetSums(Sph sph, SphSums *sums);
/* Fluid velocity and pressure at points (n x 3) by Shepard interpolation over fluid markers; NaN where no marker is near. */
FROND_EXTERN PetscErrorCode SphSample(Sph sph, PetscInt n, const PetscReal *x, PetscReal *v, PetscReal *p);

/* Bytes of memory that n markers need, and a marker-evaluation count since set-up for throughput figures. */
FROND_EXTERN PetscErrorCode SphGetWork(Sph sph, PetscReal *bytes, PetscReal *evaluations);

#endif
