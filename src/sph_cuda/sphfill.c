/* sphfill.c - initial lattices. A site belongs to the first of wall, body and fluid that claims it: walls lie outside the box,
 * `keep` carves bodies out. */
#include "sphfill.h"
#include <math.h>

/* Nobody fills more sites than this by mistake. */
#define SPH_MAXSITES 7.0e8

static PetscErrorCode SitesPerAxis(PetscInt dim, PetscReal dp, const PetscReal lo[3], const PetscReal hi[3], PetscInt n[3])
{
  double total = 1.0;

  PetscFunctionBegin;
  PetscCheck(dp > 0.0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "sph_dp = %g: must be > 0 (m)", (double)dp);
  for (int k = 0; k < 3; k++) {
    const double sites = k < dim ? floor((hi[k] - lo[k]) / dp + 0.5 * (1.0 + 1e-9)) : 1.0;
    n[k] = 0;
    total *= PetscMax(sites, 0.0);
    PetscCheck(total < SPH_MAXSITES, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "the box (%g, %g, %g) to (%g, %g, %g) m holds more than %g lattice sites of sph_dp = %g m: use a larger sph_dp or "
               "a smaller box",
               (double)lo[0], (double)lo[1], (double)lo[2], (double)hi[0], (double)hi[1], (double)hi[2], SPH_MAXSITES,
               (double)dp);
    n[k] = (PetscInt)PetscMax(sites, 0.0);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphFillBox(PetscInt dim, PetscReal dp, const PetscReal lo[3], const PetscReal hi[3], SphFillKeep keep, void *ctx,
                          PetscInt *count, PetscReal **xout)
{
  PetscInt n[3], m = 0;
  PetscReal *x;

  PetscFunctionBegin;
  PetscCall(SitesPerAxis(dim, dp, lo, hi, n));
  PetscCall(PetscMalloc1(3 * (size_t)PetscMax(1, n[0] * n[1] * n[2]), &x));
  for (PetscInt k = 0; k < n[2]; k++)
    for (PetscInt j = 0; j < n[1]; j++)
      for (PetscInt i = 0; i < n[0]; i++) {
        const PetscReal s[3] = {lo[0] + ((PetscReal)i + 0.5) * dp, lo[1] + ((PetscReal)j + 0.5) * dp,
                                dim == 3 ? lo[2] + ((PetscReal)k + 0.5) * dp : 0.0};
        if (keep && !keep(s, ctx)) continue;
        for (int d = 0; d < 3; d++) x[3 * m + d] = s[d];
        m++;
      }
  *count = m;
  *xout = x;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Depth of lattice index i below the faces of an axis with n sites: 0 inside, < 0 where no face is flagged. */
static PetscReal DepthBelow(PetscInt i, PetscInt n, PetscReal dp, PetscBool low, PetscBool high)
{
  if (i < 0) return low ? ((PetscReal)(-i) - 0.5) * dp : -1.0;
  if (i >= n) return high ? ((PetscReal)(i - n) + 0.5) * dp : -1.0;
  return 0.0;
}

PetscErrorCode SphFillWalls(PetscInt dim, PetscReal dp, const PetscReal lo[3], const PetscReal hi[3], const PetscBool face[6],
                            const PetscBool periodic[3], PetscReal depthmax, PetscInt *count, PetscReal **xout, PetscReal **vout,
                            PetscReal **dout)
{
  const PetscInt layers = (PetscInt)ceil(depthmax / dp);
  const PetscReal vol = dim == 2 ? dp * dp : dp * dp * dp;
  PetscInt n[3], a[3], b[3], m = 0, total = 1;
  PetscReal *x, *v, *d;

  PetscFunctionBegin;
  PetscCall(SitesPerAxis(dim, dp, lo, hi, n));
  for (int k = 0; k < 3; k++) {
    const PetscBool lay = k < dim && !periodic[k] ? PETSC_TRUE : PETSC_FALSE;
    a[k] = lay && face[2 * k] ? -layers : 0;
    b[k] = n[k] + (lay && face[2 * k + 1] ? layers : 0);
    total *= b[k] - a[k];
  }
  total -= n[0] * n[1] * n[2];
  PetscCall(PetscMalloc1(3 * (size_t)PetscMax(total, 1), &x));
  PetscCall(PetscMalloc1(PetscMax(total, 1), &v));
  PetscCall(PetscMalloc1(PetscMax(total, 1), &d));
  for (PetscInt k = a[2]; k < b[2]; k++)
    for (PetscInt j = a[1]; j < b[1]; j++)
      for (PetscInt i = a[0]; i < b[0]; i++) {
        const PetscInt s[3] = {i, j, k};
        PetscReal depth = 0.0;
        for (int c = 0; c < dim && c < 3; c++) depth = PetscMax(depth, DepthBelow(s[c], n[c], dp, face[2 * c], face[2 * c + 1]));
        if (depth <= 0.0) continue;
        for (int c = 0; c < 3; c++) x[3 * m + c] = c < dim ? lo[c] + ((PetscReal)s[c] + 0.5) * dp : 0.0;
        v[m] = vol;
        d[m++] = depth;
      }
  *count = m;
  *xout = x;
  *vout = v;
  *dout = d;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Wall markers so far. */
typedef struct {
  PetscInt n, alloc;
  PetscReal *x, *volume, *depth;
} Walls;

static PetscErrorCode AddWall(Walls *w, const PetscReal x[3], PetscReal volume, PetscReal depth)
{
  PetscFunctionBegin;
  if (w->n == w->alloc) {
    w->alloc = 2 * w->alloc + 1024;
    PetscCall(PetscRealloc(3 * (size_t)w->alloc * sizeof(PetscReal), &w->x));
    PetscCall(PetscRealloc((size_t)w->alloc * sizeof(PetscReal), &w->volume));
    PetscCall(PetscRealloc((size_t)w->alloc * sizeof(PetscReal), &w->depth));
  }
  for (int k = 0; k < 3; k++) w->x[3 * w->n + k] = x[k];
  w->volume[w->n] = volume;
  w->depth[w->n++] = depth;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphFillRegionWalls(PetscInt dim, PetscReal dp, const PetscReal lo[3], const PetscReal hi[3],
                                  const PetscBool face[6], const PetscBool periodic[3], PetscReal depthmax,
                                  SphFillDistance distance, void *ctx, PetscInt *count, PetscReal **xout, PetscReal **vout,
                                  PetscReal **dout)
{
  const PetscInt layers = (PetscInt)ceil(depthmax / dp);
  const PetscReal vol = dim == 2 ? dp * dp : dp * dp * dp, reach = depthmax * (1.0 + 1e-9), slack = SPH_FILL_SLACK * dp;
  PetscInt n[3], a[3], b[3];
  Walls w = {0, 0, NULL, NULL, NULL};

  PetscFunctionBegin;
  PetscCall(SitesPerAxis(dim, dp, lo, hi, n));
  for (int k = 0; k < 3; k++) {
    const PetscBool lay = k < dim && !periodic[k] ? PETSC_TRUE : PETSC_FALSE;
    a[k] = lay && !face[2 * k] ? -layers : 0;
    b[k] = n[k] + (lay && !face[2 * k + 1] ? layers : 0);
  }
  for (PetscInt k = a[2]; k < b[2]; k++)
    for (PetscInt j = a[1]; j < b[1]; j++)
      for (PetscInt i = a[0], skip; i < b[0]; i += skip + 1) {
        const PetscReal x[3] = {lo[0] + ((PetscReal)i + 0.5) * dp, lo[1] + ((PetscReal)j + 0.5) * dp,
                                dim == 3 ? lo[2] + ((PetscReal)k + 0.5) * dp : 0.0};
        PetscReal region, wall, far;
        distance(x, ctx, &region, &wall);
        if (region > slack && wall <= reach) PetscCall(AddWall(&w, x, vol, wall));
        far = PetscMax(-region, wall - reach); /* sites of this row that are nearer than this cannot be walls either */
        skip = far > dp ? (PetscInt)PetscMin(floor((1.0 - 1e-9) * far / dp), (PetscReal)(b[0] - i)) : 0;
      }
  if (!w.n) { /* the caller frees them in any case */
    PetscCall(PetscMalloc1(3, &w.x));
    PetscCall(PetscMalloc1(1, &w.volume));
    PetscCall(PetscMalloc1(1, &w.depth));
  }
  *count = w.n;
  *xout = w.x;
  *vout = w.volume;
  *dout = w.depth;
  PetscFunctionReturn(PETSC_SUCCESS);
}
