/*
  sphgrid.c - the fluid's fields at points: regular grids, lines, probes; flow through a plane.

  The mapping from markers to a grid is that of Pazouki, Serban, Negrut, Sect. 2: sums over the markers around a point, normalised
  by the kernel sum (Shepard), or a linear least squares fit around the point. Boundary markers take no part.
*/
#include <math.h>
typedef double sphreal;
#include "sphsearch.h"

const char *const SphInterpolations[] = {"shepard", "linear", "SphInterpolation", "SPH_INTERPOLATE_", NULL};

/*@
  SphInterpolate - Fields of the fluid at n points x (n x 3, m); see SphPoints for what comes out.

  Errors: before SphSetUp(), a coordinate that is not finite.
@*/
PetscErrorCode SphInterpolate(Sph sph, SphInterpolation how, PetscInt n, const PetscReal *x, const SphPoints *out)
{
  const SphParams *p = &sph->par;
  PetscReal lo[3] = {PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL}, hi[3] = {PETSC_MIN_REAL, PETSC_MIN_REAL, PETSC_MIN_REAL};
  SphSearch search;

  PetscFunctionBegin;
  PetscCheck(sph->setup, sph->comm, PETSC_ERR_ORDER, "SphInterpolate() must come after SphSetUp()");
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt j = 0; j < n; j++)
    for (int k = 0; k < p->dim; k++) {
      PetscCheck(!PetscIsInfOrNanReal(x[3 * j + k]), sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
                 "point %" PetscInt_FMT ": its coordinate %d is %g m; must be finite", j, k, (double)x[3 * j + k]);
      lo[k] = PetscMin(lo[k], x[3 * j + k]);
      hi[k] = PetscMax(hi[k], x[3 * j + k]);
    }
  PetscCall(PetscLogEventBegin(SPH_Output, 0, 0, 0, 0));
  PetscCall((*sph->ops->pull)(sph));
  PetscCall(SphSearchCreate(sph, lo, hi, 0, &search));
#pragma omp parallel for schedule(dynamic, 64)
  for (PetscInt j = 0; j < n; j++) {
    SphPointSums sums;
    double value[5];
    SphSearchSum(sph, &search, x + 3 * j, &sums);
    const int wet = SphPointValues(&sums, (int)p->dim, how == SPH_INTERPOLATE_LINEAR, value) >= 0;
    for (int k = 0; k < 3; k++)
      if (out->v) out->v[3 * j + k] = wet ? value[k] : NAN;
    if (out->p) out->p[j] = wet ? value[3] : NAN;
    if (out->rho) out->rho[j] = wet ? p->rho0 * (1.0 + value[4]) : NAN;
    if (out->fraction) out->fraction[j] = p->wnorm * sums.w[0];
  }
  PetscCall(SphSearchDestroy(&search));
  PetscCall(PetscLogEventEnd(SPH_Output, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SphSample - Velocity (n x 3, m/s) and pressure (n, Pa) at n points by Shepard's mean; NaN where no marker is near.
@*/
PetscErrorCode SphSample(Sph sph, PetscInt n, const PetscReal *x, PetscReal *v, PetscReal *p)
{
  const SphPoints out = {.v = v, .p = p};

  PetscFunctionBegin;
  PetscCall(SphInterpolate(sph, SPH_INTERPOLATE_SHEPARD, n, x, &out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Midpoints of the cells, at most dp long, of a parallelogram with corner c, edges a, b and this area (in 2D: of the line c, c +
 * a, its length). */
static PetscErrorCode PlanePoints(Sph sph, const PetscReal c[3], const PetscReal a[3], const PetscReal b[3], PetscReal area,
                                  PetscInt *n, PetscReal **x)
{
  const PetscReal *edge[2] = {a, b};
  PetscInt m[2] = {1, 1};

  PetscFunctionBegin;
  for (int e = 0; e < (sph->par.dim == 3 ? 2 : 1); e++) {
    const PetscReal l = PetscSqrtReal(edge[e][0] * edge[e][0] + edge[e][1] * edge[e][1] + edge[e][2] * edge[e][2]);
    const double cells = ceil(l / sph->par.dp - 1e-9);
    PetscCheck(l > 0.0 && cells < 1e6, sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "plane: its edge %d is %g m long; must be > 0 and below 10^6 sph_dp", e + 1, (double)l);
    m[e] = (PetscInt)cells;
  }
  PetscCheck(area > 0.0, sph->comm, PETSC_ERR_ARG_OUTOFRANGE, "plane: its edges are parallel; must span an area");
  PetscCheck((double)m[0] * (double)m[1] < 1e8, sph->comm, PETSC_ERR_ARG_OUTOFRANGE, "plane: more than 10^8 points");
  *n = m[0] * m[1];
  PetscCall(PetscMalloc1(3 * (size_t)*n, x));
  for (PetscInt j = 0; j < m[1]; j++)
    for (PetscInt i = 0; i < m[0]; i++)
      for (int k = 0; k < 3; k++)
        (*x)[3 * (j * m[0] + i) + k] = c[k] + ((PetscReal)i + 0.5) / (PetscReal)m[0] * a[k] +
                                       (sph->par.dim == 3 ? ((PetscReal)j + 0.5) / (PetscReal)m[1] * b[k] : 0.0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SphGetPlane - Flow through the parallelogram with a corner (m) and two edges (m; in 2D the line along edge1, edge2 may be NULL).

  Positive along edge1 x edge2, in 2D along (edge1_y, -edge1_x). Midpoint rule with cells of at most dp, second order; a cell
  counts when its kernel sum says that at least half of its surroundings is fluid. Errors: an edge without length.
@*/
PetscErrorCode SphGetPlane(Sph sph, const PetscReal corner[3], const PetscReal edge1[3], const PetscReal edge2[3],
                           SphPlane *plane)
{
  const int dim = (int)sph->par.dim;
  PetscReal N[3] = {edge1[1], -edge1[0], 0.0}, *x, *v, *p, *rho, *fraction, area, dA;
  PetscInt n;
  SphPlane t = {0};

  PetscFunctionBegin;
  if (dim == 3)
    for (int k = 0; k < 3; k++) N[k] = edge1[(k + 1) % 3] * edge2[(k + 2) % 3] - edge1[(k + 2) % 3] * edge2[(k + 1) % 3];
  area = PetscSqrtReal(N[0] * N[0] + N[1] * N[1] + N[2] * N[2]);
  PetscCall(PlanePoints(sph, corner, edge1, edge2, area, &n, &x));
  PetscCall(PetscMalloc4(3 * (size_t)n, &v, n, &p, n, &rho, n, &fraction));
  PetscCall(SphInterpolate(sph, SPH_INTERPOLATE_LINEAR, n, x, &(SphPoints){v, p, rho, fraction}));
  dA = area / (PetscReal)n;
  for (PetscInt j = 0; j < n; j++) {
    PetscReal un = 0.0;
    if (!(fraction[j] >= 0.5)) continue;
    for (int k = 0; k < dim; k++) un += v[3 * j + k] * N[k] / (PetscReal)n;
    t.area += dA;
    t.volume += un;
    t.mass += rho[j] * un;
    t.pressure += p[j] * dA;
  }
  if (t.area > 0.0) t.pressure /= t.area;
  PetscCall(PetscFree4(v, p, rho, fraction));
  PetscCall(PetscFree(x));
  *plane = t;
  PetscFunctionReturn(PETSC_SUCCESS);
}
