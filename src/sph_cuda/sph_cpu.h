/* sph_cpu.h - private to the CPU backend: the search structure, and the pair sums that exist once per precision. */
#ifndef SPH_CPU_H
#define SPH_CPU_H

#include "sphimpl.h"

/* Quantities of each marker that pair sums read, in the working precision; all n long, in sorted order. */
enum {
  SPH_Q_X,   /* 3: position relative to the centre of the marker's cell, m */
  SPH_Q_U = 3, /* 3: velocity that moves densities, Eq. 10 (boundary: its own), m/s */
  SPH_Q_V = 6, /* 3: velocity in the viscous term (boundary: extrapolated when wall = adami), m/s */
  SPH_Q_M = 9, /* mass, kg */
  SPH_Q_RHO,   /* density, kg/m^3 */
  SPH_Q_VOL,   /* m/rho, m^3 */
  SPH_Q_P,     /* p/rho^2; in the auxiliary pass p itself, Pa */
  SPH_NQ
};

typedef struct {
  SphGrid  grid;
  int     *cellstart; /* 2 ncell + 2 offsets: fluid and boundary markers of each cell */
  PetscInt cellcap;
  double  *xref[3];   /* positions at the last build, m */
  double   skin;      /* relative enlargement of the cells */
  PetscInt tilecap;   /* most candidates that any cell can have */
  PetscInt threads;
  void    *q;         /* SPH_NQ x stride values in the working precision */
  PetscInt stride;
  void    *tiles;     /* per thread: tilecap x (SPH_NQ values + one index) */
  size_t   tilebytes;
  PetscBool built;
} SphCpu;

/* Which sums a sweep over the markers makes. */
typedef enum {
  SPH_SWEEP_AUX,   /* Eq. 11 for fluid markers, Adami extrapolation for boundary markers */
  SPH_SWEEP_RATES, /* Eqs. 4 and 5 */
  SPH_SWEEP_SUM    /* Eq. 9 and its normalisation */
} SphSweep;

extern PetscErrorCode SphCpuSweep_single(Sph sph, SphSweep sweep);
extern PetscErrorCode SphCpuSweep_double(Sph sph, SphSweep sweep);

#endif
