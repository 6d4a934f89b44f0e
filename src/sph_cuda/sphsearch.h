/*
  sphsearch.h - private: markers sorted into cells of edge >= 2h on the host, for sums at arbitrary points (sphgrid.c) and over
  pairs (sphaudit.c). The markers are copied; the state's own order is left alone, so that every backend can use it after a pull.
*/
#ifndef SPHSEARCH_H
#define SPHSEARCH_H

#include "sphimpl.h"

typedef struct {
  SphGrid grid;
  PetscInt n;
  int *start;   /* cells + 1 */
  double *x[3]; /* wrapped into the period, m */
  double *v[3]; /* m/s */
  double *vol;  /* m/rho, m^3 */
  double *s;    /* rho/rho0 - 1 */
  int *marker;  /* which one of the state */
  double *work; /* the memory of the above */
} SphSearch;

/* Sums at a point over the markers within 2h; d = x_b - x in units of h. */
typedef struct {
  double w[10];     /* V W times 1, d, d d (xx, xy, xz, yy, yz, zz), W without norm, m^3 */
  double f[5][4];   /* V W (1, d) times vx, vy, vz, p, s */
  PetscInt markers; /* how many */
} SphPointSums;

/* A cell's markers [first, last) and by how much their images are displaced, m. */
typedef struct {
  int first, last;
  double shift[3];
} SphSearchRange;

/* Which fluid markers, those in the zones of openings among them, and boundary markers too: those within 2h of the box (lo, hi),
 * all of them when lo is NULL. */
extern PetscErrorCode SphSearchCreate(Sph sph, const PetscReal lo[3], const PetscReal hi[3], int boundary, SphSearch *search);
extern PetscErrorCode SphSearchDestroy(SphSearch *search);
/* The cells around the point, which comes back wrapped into the period; returns how many. */
extern int SphSearchRanges(const Sph sph, const SphSearch *search, const PetscReal at[3], double x[3], SphSearchRange range[27]);
extern void SphSearchSum(const Sph sph, const SphSearch *search, const PetscReal x[3], SphPointSums *sums);

/*
  Values vx, vy, vz, p, s at the point from its sums: order 1 the moving least squares fit of a linear function, exact for linear
  fields (Lancaster, Salkauskas, Math. Comput. 37 (1981)), where the markers around allow one; else, and with order 0, the mean
  weighted with the kernel (Shepard, ACM 23 (1968)). Returns the order used, or -1 with no marker near.
*/
extern int SphPointValues(const SphPointSums *sums, int dim, int order, double value[5]);
/* The same function where it is u (in units of h) off the point. */
extern int SphPointValuesAt(const SphPointSums *sums, int dim, int order, const double u[3], double value[5]);
/* Add a marker of volume vol (m^3), velocity v and density s = rho/rho0 - 1 that is d (in units of h) off the point. */
extern void SphPointAdd(const SphParams *par, double vol, const double v[3], double s, const double d[3], SphPointSums *sums);

#endif
