/* sph_cpu.h - private to the CPU backend: the search structure, and the pair sums that exist once per precision. */
#ifndef SPH_CPU_H
#define SPH_CPU_H

#include "sphimpl.h"

/* Quantities of each marker that pair sums read, in the working precision; each n long, in sorted order. */
enum {
  SPH_Q_X,     /* 3: position relative to the centre of the marker's cell, m */
  SPH_Q_V = 3, /* 3: velocity in the viscous term (boundary: extrapolated when wall = adami), m/s */
  SPH_Q_S = 6, /* rho/rho0 - 1 */
  SPH_Q_VOL,   /* m/rho, m^3 */
  SPH_Q_P,     /* p/rho^2, Pa m^6/kg^2 */
  SPH_NQ_BASE,
  SPH_Q_U = SPH_NQ_BASE, /* 3: velocity that moves densities, Eq. 10 (boundary: its own), m/s; only where it differs from V */
  SPH_NQ_MAX = SPH_NQ_BASE + 4
};
/* Last comes m/rho of fluid and 0 of boundary markers, the weight of density diffusion, when there is any. */
#define SPH_Q_DIF(uv) (SPH_NQ_BASE + ((uv) ? 3 : 0))

/* Markers that share one list of neighbours: compact by the order within cells. */
#define SPH_GROUP 8

/* Most markers in a batch, consecutive ones of one cell with a bounding box, sphsimd.h. */
#define SPH_BATCH 16

typedef struct {
  SphGrid grid;
  int *cellstart; /* 2 ncell + 2 offsets: fluid and boundary markers of each cell */
  int *firstbox;  /* number of the first batch of each range r = 2 cell + kind */
  PetscInt cellcap;
  double moved;      /* bound on the displacement of any fluid marker since the last build, m */
  double *gmoved;    /* the same for each boundary group */
  double skin;       /* relative enlargement of the cells */
  PetscInt listcap;  /* most neighbours that a group can have */
  PetscInt batchcap; /* most batches around a cell */
  PetscInt threads;
  void *q; /* nq x stride values in the working precision */
  PetscInt nq, stride;
  void *lists; /* per thread, from the first multiple of 64 bytes on: a list and the batches around a cell, see CutMemory() */
  size_t listbytes;
  void *boxes; /* 6 x boxcap: bounding boxes of batches of up to SPH_BATCH markers in the working precision */
  PetscInt boxcap;
  PetscBool built;
} SphCpu;

/* Which sums a sweep over the markers makes. */
typedef enum {
  SPH_SWEEP_AUX,     /* Eq. 11 for fluid markers, Adami extrapolation for boundary markers */
  SPH_SWEEP_RATES,   /* Eqs. 4 and 5 */
  SPH_SWEEP_CORRECT, /* adds the kernel gradient correction to Eqs. 4 and 5 */
  SPH_SWEEP_SHIFT,   /* adds the shifting velocity to that of Eq. 11 */
  SPH_SWEEP_SUM      /* Eq. 9 and its normalisation */
} SphSweep;

/* Fill the prepared quantities from the state; after an auxiliary sweep only what that changed. */
extern void SphCpuPrepare_single(Sph sph, int afteraux);
extern void SphCpuPrepare_double(Sph sph, int afteraux);
extern void SphCpuSweep_single(Sph sph, SphSweep sweep);
extern void SphCpuSweep_double(Sph sph, SphSweep sweep);

#endif
