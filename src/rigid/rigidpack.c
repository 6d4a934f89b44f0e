/*
  rigidpack.c - BCE markers of a body known by its signed distance only (mesh, composite).

  Candidates are the cell centres of a grid of dp/3 inside the body. Layer by layer, from the surface inwards, each is moved
  along the normal to the middle of its layer, depth dp/2, 3dp/2, ..., and becomes a marker unless another one stands nearer
  than 0.85 dp: the layers conform to the surface and no gap wider than that stays open. Candidates that have no such
  place, near edges of the medial surface, are then tried where they are. A marker's volume is that of the grid cells nearer to it
  than to any other, scaled so that the cells of the whole body add up to its volume.
*/
#include "rigidgeometry.h"

#define FINE 3      /* grid cells along dp */
#define CLOSEST .85 /* least distance of two markers, dp */
#define SLACK (1. + 1.e-9)

typedef struct {
  PetscInt dim, n[3];  /* buckets of side dp over the bounding box */
  PetscReal lo[3], dp; /* m */
  PetscInt *head, *next, nnext;
} Buckets;

typedef struct {
  PetscInt n, nalloc;
  PetscReal *x, *depth, *weight; /* n x 3, n, n; weight: part of the cell inside */
  PetscReal total;               /* weight of all cells of the body */
} Cells;

static PetscErrorCode BucketsCreate(Buckets *b, PetscInt dim, PetscReal dp, const PetscReal lo[], const PetscReal hi[])
{
  PetscInt total = 1;

  PetscFunctionBegin;
  b->dim = dim;
  b->dp = dp;
  for (int k = 0; k < 3; k++) {
    b->lo[k] = lo[k] - dp;
    b->n[k] = k < dim ? (PetscInt)((hi[k] - lo[k]) / dp) + 3 : 1;
    total *= b->n[k];
  }
  PetscCall(PetscMalloc1((size_t)total, &b->head));
  for (PetscInt i = 0; i < total; i++) b->head[i] = -1;
  b->next = NULL;
  b->nnext = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void BucketOf(const Buckets *b, const PetscReal x[3], PetscInt id[3])
{
  for (int k = 0; k < 3; k++) {
    const PetscInt i = k < b->dim ? (PetscInt)PetscFloorReal((x[k] - b->lo[k]) / b->dp) : 0;
    id[k] = PetscMax(0, PetscMin(b->n[k] - 1, i));
  }
}

/* The marker nearest to x within `reach` buckets, -1 for none; its distance squared in d2. */
static PetscInt Nearest(const Buckets *b, const RigidMarkers *m, const PetscReal x[3], PetscInt reach, PetscReal *d2)
{
  PetscInt id[3], lo[3], hi[3], best = -1;
  *d2 = PETSC_MAX_REAL;
  BucketOf(b, x, id);
  for (int k = 0; k < 3; k++) {
    lo[k] = PetscMax(0, id[k] - reach);
    hi[k] = PetscMin(b->n[k] - 1, id[k] + reach);
  }
  for (PetscInt kz = lo[2]; kz <= hi[2]; kz++)
    for (PetscInt ky = lo[1]; ky <= hi[1]; ky++)
      for (PetscInt kx = lo[0]; kx <= hi[0]; kx++)
        for (PetscInt i = b->head[kx + b->n[0] * (ky + b->n[1] * kz)]; i >= 0; i = b->next[i]) {
          const PetscReal d = PetscSqr(m->x[3 * i] - x[0]) + PetscSqr(m->x[3 * i + 1] - x[1]) + PetscSqr(m->x[3 * i + 2] - x[2]);
          if (d < *d2) {
            *d2 = d;
            best = i;
          }
        }
  return best;
}

/* Adds a marker at x unless one is too close. */
static PetscErrorCode TryMarker(Buckets *b, RigidMarkers *m, const PetscReal x[3])
{
  PetscReal d2;
  PetscInt id[3], bucket;

  PetscFunctionBegin;
  (void)Nearest(b, m, x, 1, &d2);
  if (d2 < PetscSqr(CLOSEST * b->dp)) PetscFunctionReturn(PETSC_SUCCESS);
  if (m->n == b->nnext) {
    b->nnext = 2 * b->nnext + 256;
    PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)b->nnext, &b->next));
  }
  BucketOf(b, x, id);
  bucket = id[0] + b->n[0] * (id[1] + b->n[1] * id[2]);
  b->next[m->n] = b->head[bucket];
  b->head[bucket] = m->n;
  PetscCall(RigidMarkersAdd(m, x[0], x[1], x[2], 0.));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Grid cells of the body; those down to `bottom` are kept. The share inside of a cut cell is 1/2 + depth/h, see
 * test_rigid_shape.c. */
static PetscErrorCode GatherCells(Cells *c, const RigidBodySpec *s, PetscInt dim, PetscReal dp, PetscReal bottom)
{
  const PetscReal *lo = s->geometry->lo, *hi = s->geometry->hi;
  PetscInt n[3] = {1, 1, 1};
  PetscReal h[3] = {0., 0., 0.}, least = PETSC_MAX_REAL;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < dim; k++) {
    n[k] = (PetscInt)PetscCeilReal((hi[k] - lo[k]) * FINE / (dp * SLACK));
    h[k] = (hi[k] - lo[k]) / (PetscReal)n[k];
    least = PetscMin(least, h[k]);
  }
  for (PetscInt iz = 0; iz < n[2]; iz++)
    for (PetscInt iy = 0; iy < n[1]; iy++)
      for (PetscInt ix = 0; ix < n[0]; ix++) {
        const PetscReal x[3] = {lo[0] + h[0] * ((PetscReal)ix + .5), lo[1] + h[1] * ((PetscReal)iy + .5),
                                dim == 2 ? 0. : lo[2] + h[2] * ((PetscReal)iz + .5)};
        const PetscReal depth = -RigidShapeDistance(s, x), w = PetscMin(1., .5 + depth / least);
        if (w <= 0.) continue;
        c->total += w;
        if (depth > bottom) continue;
        if (c->n == c->nalloc) {
          c->nalloc = 2 * c->nalloc + 1024;
          PetscCall(PetscRealloc(sizeof(PetscReal) * 3 * (size_t)c->nalloc, &c->x));
          PetscCall(PetscRealloc(sizeof(PetscReal) * (size_t)c->nalloc, &c->depth));
          PetscCall(PetscRealloc(sizeof(PetscReal) * (size_t)c->nalloc, &c->weight));
        }
        PetscCall(PetscArraycpy(&c->x[3 * c->n], x, 3));
        c->depth[c->n] = depth;
        c->weight[c->n++] = w;
      }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y: x moved along the normal to depth `target`; false where no point of that depth lies that way. */
static PetscBool MoveToDepth(const RigidBodySpec *s, PetscInt dim, PetscReal dp, const PetscReal x[3], PetscReal depth,
                             PetscReal target, PetscReal y[3])
{
  PetscReal g[3] = {0., 0., 0.}, norm;
  for (PetscInt k = 0; k < dim; k++) {
    PetscReal p[3] = {x[0], x[1], x[2]}, m[3] = {x[0], x[1], x[2]};
    p[k] += 1.e-4 * dp;
    m[k] -= 1.e-4 * dp;
    g[k] = RigidShapeDistance(s, p) - RigidShapeDistance(s, m);
  }
  norm = Vec3Norm(g);
  if (norm == 0.) return PETSC_FALSE;
  for (int k = 0; k < 3; k++) y[k] = x[k] + (depth - target) * g[k] / norm;
  return PetscAbsReal(-RigidShapeDistance(s, y) - target) < 1.e-2 * dp ? PETSC_TRUE : PETSC_FALSE;
}

static PetscErrorCode CellVolumes(const Buckets *b, RigidMarkers *m, const Cells *c, PetscReal volume)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < c->n; i++) {
    PetscReal d2;
    PetscInt j = -1, reach = 0;
    do j = Nearest(b, m, &c->x[3 * i], ++reach, &d2);
    while (j < 0 || d2 > PetscSqr((PetscReal)reach * b->dp)); /* a nearer one could stand outside of the buckets searched */
    m->volume[j] += c->weight[i] * volume / c->total;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidPackMarkers(RigidMarkers *m, const RigidBodySpec *s, PetscInt dim, PetscReal dp, PetscReal depthmax)
{
  const PetscInt layers = (PetscInt)PetscFloorReal(PetscMin(depthmax / dp * SLACK + .5, 1.e6));
  Cells c = {0, 0, NULL, NULL, NULL, 0.};
  Buckets b;
  PetscReal deepest = 0.;

  PetscFunctionBegin;
  PetscCall(BucketsCreate(&b, dim, dp, s->geometry->lo, s->geometry->hi));
  PetscCall(GatherCells(&c, s, dim, dp, (PetscReal)layers * dp));
  for (PetscInt i = 0; i < c.n; i++) deepest = PetscMax(deepest, c.depth[i]);
  for (PetscInt k = 0; k < layers && (PetscReal)k * dp < deepest; k++)
    for (PetscInt i = 0; i < c.n; i++) {
      PetscReal y[3];
      if (c.depth[i] <= (PetscReal)k * dp || c.depth[i] > (PetscReal)(k + 1) * dp) continue;
      if (MoveToDepth(s, dim, dp, &c.x[3 * i], c.depth[i], ((PetscReal)k + .5) * dp, y)) PetscCall(TryMarker(&b, m, y));
    }
  for (PetscInt i = 0; i < c.n; i++)
    if (c.depth[i] > .25 * dp) PetscCall(TryMarker(&b, m, &c.x[3 * i]));
  PetscCheck(m->n > 0, s->geometry->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "A %s that is nowhere %g m deep cannot be marked at spacing dp = %g m", RigidShapeName(s->shape), .25 * (double)dp,
             (double)dp);
  PetscCall(CellVolumes(&b, m, &c, s->geometry->volume));
  PetscCall(PetscFree(c.x));
  PetscCall(PetscFree(c.depth));
  PetscCall(PetscFree(c.weight));
  PetscCall(PetscFree(b.head));
  PetscCall(PetscFree(b.next));
  PetscFunctionReturn(PETSC_SUCCESS);
}
