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
  PetscReal *x, *normal, *depth, *weight; /* n x 3, n x 3, n, n; weight: part of the cell inside */
  PetscReal total;                        /* weight of all cells of the body */
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
  b->nnext = 256;
  PetscCall(PetscMalloc1(b->nnext, &b->next));
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

static PetscBool IsFree(const Buckets *b, const RigidMarkers *m, const PetscReal x[3])
{
  PetscReal d2;
  (void)Nearest(b, m, x, 1, &d2);
  return d2 < PetscSqr(CLOSEST * b->dp) ? PETSC_FALSE : PETSC_TRUE;
}

static PetscErrorCode AddMarker(Buckets *b, RigidMarkers *m, const PetscReal x[3])
{
  PetscInt id[3], bucket;

  PetscFunctionBegin;
  if (m->n == b->nnext) {
    b->nnext *= 2;
    PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)b->nnext, &b->next));
  }
  BucketOf(b, x, id);
  bucket = id[0] + b->n[0] * (id[1] + b->n[1] * id[2]);
  b->next[m->n] = b->head[bucket];
  b->head[bucket] = m->n;
  PetscCall(RigidMarkersAdd(m, x[0], x[1], x[2], 0.));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Depth of x, no deeper than `bound` from the surface, and the outward normal there; 0 on the medial surface of a composite. */
static PetscReal DepthAndNormal(const RigidBodySpec *s, PetscInt dim, PetscReal dp, const PetscReal x[3], PetscReal bound,
                                PetscReal n[3])
{
  PetscReal y[3], d;
  for (int k = 0; k < 3; k++) n[k] = 0.;
  if (s->shape != RIGID_MESH) {
    d = RigidShapeDistance(s, x);
    if (-d < bound) (void)RigidShapeNormal(s, dim, x, 1.e-4 * dp, n);
    return -d;
  }
  d = RigidMeshClosest(&s->geometry->mesh, x, bound, y);
  for (int k = 0; k < 3 && d != 0.; k++) n[k] = (x[k] - y[k]) / d;
  return -d;
}

static PetscErrorCode AddCell(Cells *c, const PetscReal x[3], const PetscReal normal[3], PetscReal depth, PetscReal weight)
{
  PetscFunctionBegin;
  if (c->n == c->nalloc) {
    c->nalloc = 2 * c->nalloc + 1024;
    PetscCall(PetscRealloc(sizeof(PetscReal) * 3 * (size_t)c->nalloc, &c->x));
    PetscCall(PetscRealloc(sizeof(PetscReal) * 3 * (size_t)c->nalloc, &c->normal));
    PetscCall(PetscRealloc(sizeof(PetscReal) * (size_t)c->nalloc, &c->depth));
    PetscCall(PetscRealloc(sizeof(PetscReal) * (size_t)c->nalloc, &c->weight));
  }
  PetscCall(PetscArraycpy(&c->x[3 * c->n], x, 3));
  PetscCall(PetscArraycpy(&c->normal[3 * c->n], normal, 3));
  c->depth[c->n] = depth;
  c->weight[c->n++] = weight;
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
    for (PetscInt iy = 0; iy < n[1]; iy++) {
      PetscReal bound = PETSC_MAX_REAL; /* a distance changes by h at most from cell to cell */
      for (PetscInt ix = 0; ix < n[0]; ix++) {
        const PetscReal x[3] = {lo[0] + h[0] * ((PetscReal)ix + .5), lo[1] + h[1] * ((PetscReal)iy + .5),
                                dim == 2 ? 0. : lo[2] + h[2] * ((PetscReal)iz + .5)};
        PetscReal normal[3];
        const PetscReal depth = DepthAndNormal(s, dim, dp, x, bound, normal), w = PetscMin(1., .5 + depth / least);
        const PetscReal far =
            depth > 0. ? depth - bottom : -depth - .5 * least; /* so many cells to come are outside or too deep too */
        const PetscInt skip = far > h[0] ? PetscMin((PetscInt)(far / h[0] * (1. - 1.e-9)), n[0] - 1 - ix) : 0;
        bound = (PetscAbsReal(depth) + h[0] * (PetscReal)(skip + 1)) * SLACK;
        ix += skip;
        if (w > 0.) c->total += w * (PetscReal)(skip + 1);
        if (w > 0. && depth <= bottom) PetscCall(AddCell(c, x, normal, depth, w));
      }
    }
  PetscFunctionReturn(PETSC_SUCCESS);
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
  Cells c = {0, 0, NULL, NULL, NULL, NULL, 0.};
  Buckets b;
  PetscReal deepest = 0.;

  PetscFunctionBegin;
  PetscCall(BucketsCreate(&b, dim, dp, s->geometry->lo, s->geometry->hi));
  PetscCall(GatherCells(&c, s, dim, dp, (PetscReal)layers * dp));
  for (PetscInt i = 0; i < c.n; i++) deepest = PetscMax(deepest, c.depth[i]);
  for (PetscInt k = 0; k < layers && (PetscReal)k * dp < deepest; k++)
    for (PetscInt i = 0; i < c.n; i++) {
      const PetscReal target = ((PetscReal)k + .5) * dp;
      PetscReal y[3];
      if (c.depth[i] <= (PetscReal)k * dp || c.depth[i] > (PetscReal)(k + 1) * dp) continue;
      for (int d = 0; d < 3; d++) y[d] = c.x[3 * i + d] + (c.depth[i] - target) * c.normal[3 * i + d];
      if (IsFree(&b, m, y) && PetscAbsReal(RigidShapeDistance(s, y) + target) < 1.e-2 * dp) PetscCall(AddMarker(&b, m, y));
    }
  for (PetscInt i = 0; i < c.n; i++)
    if (c.depth[i] > .25 * dp && IsFree(&b, m, &c.x[3 * i])) PetscCall(AddMarker(&b, m, &c.x[3 * i]));
  PetscCheck(m->n > 0, s->geometry->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "A %s that is nowhere %g m deep cannot be marked at spacing dp = %g m", RigidShapeName(s->shape), .25 * (double)dp,
             (double)dp);
  PetscCall(CellVolumes(&b, m, &c, s->geometry->volume));
  PetscCall(PetscFree(c.x));
  PetscCall(PetscFree(c.normal));
  PetscCall(PetscFree(c.depth));
  PetscCall(PetscFree(c.weight));
  PetscCall(PetscFree(b.head));
  PetscCall(PetscFree(b.next));
  PetscFunctionReturn(PETSC_SUCCESS);
}
