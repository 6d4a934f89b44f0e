/*
  sphimpl.h - private: the Sph object, its parameters and the operations of a backend.

  State lives in structure-of-arrays form in sorted order (sphcell.h); id[] gives each slot's number in the order the
  markers were added and slot[] is its inverse. All state is double; pair arithmetic and its results, the rates, are single or
  double (sph_cpupairs.c).
*/
#ifndef SPHIMPL_H
#define SPHIMPL_H

#include "sph.h"
#include "sphcell.h"
#include <string.h>

/* Steps between the Euler steps of the Verlet integrator, sphstep.h. */
#define SPH_VERLET_EVERY 40

typedef struct {
  PetscInt dim;
  PetscReal dp;           /* initial spacing, m */
  PetscReal h;            /* smoothing length, m */
  PetscReal rho0;         /* reference density, kg/m^3 */
  PetscReal mu;           /* viscosity, Pa s */
  PetscReal mupair;       /* viscosity in Eq. 6, lattice-normalised, Pa s */
  PetscReal wnorm, fnorm; /* norms of W (1/m^dim) and F (1/m^(dim+2)), lattice-normalised */
  PetscReal vmax;         /* expected maximum speed, m/s */
  PetscReal cs;           /* speed of sound, m/s */
  PetscReal gamma;        /* Eq. 7, - */
  PetscReal B;            /* cs^2 rho0/gamma, Pa */
  PetscReal pb;           /* background pressure, Pa */
  PetscReal zeta;         /* XSPH factor, - */
  PetscReal epsilon;      /* Eq. 6, - */
  PetscReal f[3];         /* body force, m/s^2 */
  PetscReal lo[3], hi[3];
  PetscBool periodic[3];
  PetscReal dtfixed; /* s, or PETSC_DECIDE */
  PetscReal cfl;
  PetscReal dtmin;     /* s; 0 for none */
  PetscReal speedstop; /* speed over c_s at which a run ends, -; 0 for none */
  int slip;            /* SphSlipType */
  PetscInt reinitevery, checkevery;
  int kernel; /* SphKernelType */
  int precision, wall, reinit;
  PetscBool lattice;     /* normalise kernel and viscosity on the initial lattice */
  int viscosity;         /* SphViscosityType */
  PetscReal alpha;       /* artificial viscosity, - */
  int diffusion;         /* SphDiffusionType */
  PetscReal delta;       /* density diffusion, - */
  int integrator;        /* SphIntegratorType */
  int shifting;          /* SphShiftingType */
  PetscReal shiftfactor; /* - */
  int gradient;          /* SphGradientType */
} SphParams;

/* One array per component, n long. */
typedef struct {
  double *x[3]; /* m */
  double *v[3]; /* m/s */
  double *s;    /* rho/rho0 - 1 */
} SphState;

/* One value of each marker, in double or in single precision; neither: all zero, no term reads them. */
typedef struct {
  double *d;
  float *f;
} SphValues;

static inline double SphValue(const SphValues *a, PetscInt i)
{
  return a->d ? a->d[i] : (a->f ? (double)a->f[i] : 0.0);
}

static inline void SphSetValue(const SphValues *a, PetscInt i, double value)
{
  if (a->d)
    a->d[i] = value;
  else if (a->f)
    a->f[i] = (float)value;
}

/* What the pair sums make of the state, in their precision on the CPU: they have no more digits. */
typedef struct {
  SphValues a[3];  /* right-hand side of Eq. 5 without f; boundary: force per marker mass; m/s^2 */
  SphValues dv[3]; /* XSPH velocity, Eq. 11, m/s; zero on boundaries */
  SphValues ds;    /* d(rho/rho0)/dt, 1/s */
} SphRates;

typedef struct _SphOps {
  PetscErrorCode (*setup)(Sph);
  PetscErrorCode (*build)(Sph);                  /* sort markers and find cell ranges when needed */
  PetscErrorCode (*rates)(Sph);                  /* all right-hand sides at the current state */
  PetscErrorCode (*halfstep)(Sph, PetscReal dt); /* sph_step_half(); not called with verlet */
  PetscErrorCode (*fullstep)(Sph, PetscReal dt); /* sph_step_full_<integrator>(), verlet with span = sph->verletspan */
  PetscErrorCode (*reinit)(Sph);                 /* Eq. 9 */
  PetscErrorCode (*motion)(Sph, PetscInt group, const PetscReal *x, const PetscReal *v, const PetscReal *a);
  PetscErrorCode (*force)(Sph, PetscInt group, PetscReal *f);
  PetscErrorCode (*limits)(Sph, PetscReal *vmax, PetscReal *amax);
  PetscErrorCode (*pull)(Sph); /* make the host arrays current */
  PetscErrorCode (*push)(Sph); /* host arrays changed */
  PetscErrorCode (*destroy)(Sph);
  PetscErrorCode (*check)(Sph); /* as SphCheckFinite(), where the state lives; NULL: the host arrays are the state */
  PetscErrorCode (*state)(Sph, FrondState *); /* move the search structure, and all of the state to the device when loading; NULL:
                                                 it is built anew when a state is saved or restored */
  /* sphlink.c: link number k has a new state; its load and the SECTION_TOTALS totals. NULL: done on the host */
  PetscErrorCode (*linkmotion)(Sph, PetscInt k);
  PetscErrorCode (*linkload)(Sph, PetscInt k, PetscReal *load, double *totals);
  PetscErrorCode (*rotation)(Sph, PetscInt group); /* sph->omega of the group changed; NULL: it is read where it is */
  /* sphopen.c: vx, vy, vz, p, s of a linear fit to the fluid around n points (n x 3, m), at the points and at an offset (n x 3,
     m) from them (n x 2 x 5); group: to the markers of this group in place of the fluid, n, or NULL; near[]: whether there are
     any. NULL: there are no openings */
  PetscErrorCode (*fit)(Sph, PetscInt n, const double *at, const double *offset, const int *group, double *value, int *near);
} SphOps;

struct _p_Sph {
  MPI_Comm comm;
  char prefix[64];
  char type[16];
  SphParams par;
  PetscBool hset, hratioset, vmaxset, csset, domainset, setup;
  PetscReal hratio;
  PetscReal fconst[3]; /* constant part of the body force, m/s^2; par.f is the whole at the time of the last evaluation */
  PetscInt nforce;     /* entries of its table */
  PetscReal *forcetime, *force; /* nforce, s; nforce x 3, m/s^2 */

  PetscInt n, nfluid, ngroups; /* markers; fluid ones; boundary groups */
  PetscInt cap;                /* room in the arrays below */
  PetscInt *groupstart;        /* ngroups+1 offsets in added order */
  PetscInt groupcap;
  PetscInt left; /* fluid markers that left through an open side */

  SphState st, stn; /* now; at the beginning of the step: arrays that no term reads are NULL */
  SphRates rate;
  double *m; /* mass, kg */
  double
      *wallratio; /* boundary: depth below the surface (m) until SphSetUp, then the factor of SphWallRatio; fluid: 0; or NULL */
  double *ab[3];  /* boundary acceleration, m/s^2, or NULL */
  double *omega;  /* angular velocity at boundary markers in the order added, (n - nfluid) x 3, rad/s; NULL without adami */
  int *group;     /* -1 fluid, -2 left or in reserve, SPH_ZONE(k) zone of opening k, else group */
  int *id, *slot;
  PetscReal backendbytes; /* memory of the backend on the host, bytes */

  PetscReal t, dt; /* time and current step, s */
  PetscInt step;
  PetscReal speedwarned;                        /* the speed at the last warning about the speed of sound, m/s */
  PetscBool insidestep, fixedwarned, evaluated; /* evaluated: second-stage rates are there already */
  PetscInt verletstep;                          /* steps since stn was last invalid: 0 asks for an Euler step */
  PetscReal dtold, verletspan;                  /* s; span of the Verlet step in progress, 0 for Euler */
  PetscReal evaluations;                        /* marker right-hand sides evaluated */

  const SphOps *ops;
  void *data;                    /* backend */
  struct _SphLinks *links;       /* sphlink.c; NULL: none */
  struct _SphOpenings *openings; /* sphopen.c; NULL: none */
};

FROND_VISIBLE extern const SphOps SphOps_CPU;
#if defined(FROND_HAVE_CUDA)
FROND_VISIBLE extern const SphOps SphOps_CUDA;
extern PetscErrorCode SphCudaAvailable(PetscBool *yes);
#endif

extern PetscLogEvent SPH_Build, SPH_Aux, SPH_Rates, SPH_Integrate, SPH_Reinit, SPH_Motion, SPH_Output, SPH_Open;

/* sphcell.c: grid for the markers as they are, and a stable sort of all arrays into cell order. */
extern PetscErrorCode SphGridSetUp(Sph sph, PetscReal skin, SphGrid *grid);
extern PetscErrorCode SphSortMarkers(Sph sph, const SphGrid *grid, int **cellstart, PetscInt *cellcap,
                                     void *scratch); /* scratch: 12 n bytes, for doubles */
extern PetscErrorCode SphCheckOverlap(Sph sph, const SphGrid *grid, const int *cellstart);

/* sphstate.c: the grid of a search structure, as arrays below the name `search`. */
extern PetscErrorCode SphMoveGrid(FrondState *s, const char search[], SphGrid *grid);

/* Whether the velocity that moves densities differs from that of the viscous term: XSPH, or extrapolated wall velocities. */
static inline int SphTwoVelocities(const SphParams *p)
{
  return p->zeta > 0.0 || p->shifting != SPH_SHIFTING_NONE || p->wall == SPH_WALL_ADAMI;
}

/* sphlink.c */
FROND_VISIBLE extern PetscBool SphIsLinked(Sph sph, PetscInt group);
extern PetscErrorCode SphLinksState(Sph sph, FrondState *s);
extern PetscErrorCode SphLinksDestroy(Sph sph);

/* sphmarkers.c: markers of the fluid's kind: group -1, -2 (reserve) or SPH_ZONE(k); as SphAddFluid(). */
extern PetscErrorCode SphAppendFluid(Sph sph, PetscInt n, const PetscReal *x, const PetscReal *v, const PetscReal *p, int group);

/* sphmarkers.c: the arrays that a run needs besides those of the markers added; all of them, rates in double precision, or
 * (spare) only those that a term reads, rates in that of the pair sums. */
extern PetscErrorCode SphAllocateArrays(Sph sph, PetscBool spare);
extern PetscErrorCode SphFreeArrays(Sph sph);

/* sphforce.c: par.f at time t (s). */
extern void SphBodyForceAt(Sph sph, PetscReal t);

/* sphwall.c: factor r in v_ext = v_b + r (v_b - <v>) for a marker `depth` below a flat surface. */
/* The factor -1 makes v_ext = <v>, so that no friction acts: free slip. */
#define SPH_WALLRATIO_SLIP (-1.0)
extern PetscReal SphWallRatio(const SphParams *par, PetscReal depth);
/* Set wnorm, fnorm and mupair from kernel, h, dp, mu. */
extern void SphLattice(SphParams *par);

/* sphcheck.c: a non-finite value in any field is PETSC_ERR_FP naming field, marker, step and time. */
extern PetscErrorCode SphCheckFinite(Sph sph);

#endif
