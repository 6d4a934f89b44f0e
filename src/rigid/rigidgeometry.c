/*
  rigidgeometry.c - life cycle of geometries, and composites: rigid unions of shapes.

  Moments of a composite: sum over the parts of R J R^T + m (|d|^2 1 - d d^T), d from the common centre of mass (Steiner).
  Its distance is the least of the parts' distances; inside, that is the depth in the deepest part.
*/
#include "rigidgeometry.h"

PetscErrorCode RigidGeometryCreate_Private(MPI_Comm comm, RigidShape shape, PetscInt dim, RigidGeometry *g)
{
  PetscFunctionBegin;
  PetscCall(PetscNew(g));
  (*g)->comm = comm;
  (*g)->refct = 1;
  (*g)->dim = dim;
  (*g)->shape = shape;
  (*g)->q[0] = 1.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidGeometryReference(RigidGeometry g)
{
  PetscFunctionBegin;
  g->refct++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidGeometryDestroy(RigidGeometry *g)
{
  RigidGeometry p = *g;

  PetscFunctionBegin;
  *g = NULL;
  if (!p || --p->refct > 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree(p->mesh.x));
  PetscCall(PetscFree(p->mesh.tri));
  PetscCall(PetscFree(p->mesh.nface));
  PetscCall(PetscFree(p->mesh.nedge));
  PetscCall(PetscFree(p->mesh.nvert));
  PetscCall(PetscFree(p->mesh.order));
  PetscCall(PetscFree(p->mesh.node));
  PetscCall(PetscFree(p->part));
  PetscCall(PetscFree(p->partq));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidGeometryGetPlacement(RigidGeometry g, PetscReal *volume, PetscReal center[3], PetscReal q[4])
{
  PetscFunctionBegin;
  if (volume) *volume = g->volume;
  if (center) PetscCall(PetscArraycpy(center, g->center, 3));
  if (q) PetscCall(PetscArraycpy(q, g->q, 4));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A point of the body frame in the frame of part i. */
static void ToPart(RigidGeometry g, PetscInt i, const PetscReal x[3], PetscReal y[3])
{
  PetscReal d[3];
  for (int k = 0; k < 3; k++) d[k] = x[k] - g->part[i].position[k];
  QuatRotateBack(&g->partq[4 * i], d, y);
}

PetscReal RigidGeometryDistance(RigidGeometry g, const PetscReal x[3])
{
  PetscReal best = PETSC_MAX_REAL;
  if (g->shape == RIGID_MESH) return RigidMeshDistance(&g->mesh, x);
  for (PetscInt i = 0; i < g->nparts; i++) {
    PetscReal y[3];
    ToPart(g, i, x, y);
    best = PetscMin(best, RigidShapeDistance(&g->part[i], y));
  }
  return best;
}

PetscReal RigidGeometryGetDistance(RigidGeometry geometry, const PetscReal x[3])
{
  const PetscReal d[3] = {x[0] - geometry->center[0], x[1] - geometry->center[1], x[2] - geometry->center[2]};
  PetscReal y[3];

  QuatRotateBack(geometry->q, d, y);
  return RigidGeometryDistance(geometry, y);
}

PetscErrorCode RigidGeometryGetBounds(RigidGeometry geometry, PetscReal lo[3], PetscReal hi[3])
{
  PetscReal R[9];

  PetscFunctionBegin;
  QuatMatrix(geometry->q, R);
  for (int k = 0; k < 3; k++) {
    lo[k] = hi[k] = geometry->center[k];
    for (int c = 0; c < 3 && geometry->shape != RIGID_MESH; c++) { /* the turned box about that of the parts */
      lo[k] += PetscMin(R[3 * k + c] * geometry->lo[c], R[3 * k + c] * geometry->hi[c]);
      hi[k] += PetscMax(R[3 * k + c] * geometry->lo[c], R[3 * k + c] * geometry->hi[c]);
    }
  }
  for (PetscInt i = 0; i < geometry->mesh.nv; i++) {
    PetscReal x[3];
    QuatRotate(geometry->q, &geometry->mesh.x[3 * i], x);
    for (int k = 0; k < 3; k++) {
      x[k] += geometry->center[k];
      lo[k] = i ? PetscMin(lo[k], x[k]) : x[k];
      hi[k] = i ? PetscMax(hi[k], x[k]) : x[k];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Half extents of a part's own bounding box; 0 along z in 2D. */
static void PartExtent(const RigidBodySpec *p, PetscInt dim, PetscReal h[3])
{
  const PetscReal *a = p->size;
  for (int k = 0; k < 3; k++) h[k] = p->shape == RIGID_BOX ? .5 * a[k] : (p->shape == RIGID_ELLIPSOID ? a[k] : a[0]);
  if (p->shape == RIGID_CYLINDER) h[2] = .5 * a[1];
  if (p->shape == RIGID_CAPSULE) h[2] = .5 * a[1] + a[0];
  if (dim == 2) h[2] = 0.;
}

/* Looks for common points of parts i and j on a grid over part i; finds overlaps wider than 1/12 of part i. */
static PetscErrorCode CheckOverlap(RigidGeometry g, PetscInt i, PetscInt j)
{
  const PetscInt n = 25, nz = g->dim == 2 ? 1 : n;
  PetscReal h[3];

  PetscFunctionBegin;
  PartExtent(&g->part[i], g->dim, h);
  for (PetscInt c = 0; c < n * n * nz; c++) {
    const PetscInt id[3] = {c % n, (c / n) % n, c / (n * n)};
    const PetscReal slack = 1.e-9 * (h[0] + h[1] + h[2]);
    PetscReal y[3], x[3], z[3];
    for (int k = 0; k < 3; k++) y[k] = (k == 2 && g->dim == 2) ? 0. : h[k] * (2. * (PetscReal)id[k] / (PetscReal)(n - 1) - 1.);
    if (RigidShapeDistance(&g->part[i], y) > -slack) continue;
    QuatRotate(&g->partq[4 * i], y, x);
    for (int k = 0; k < 3; k++) x[k] += g->part[i].position[k];
    ToPart(g, j, x, z);
    PetscCheck(RigidShapeDistance(&g->part[j], z) > -slack, g->comm, PETSC_ERR_ARG_INCOMP,
               "Composite: parts %" PetscInt_FMT " and %" PetscInt_FMT " overlap at (%g, %g, %g); parts may touch only",
               PetscMin(i, j), PetscMax(i, j), (double)x[0], (double)x[1], (double)x[2]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CopyParts(RigidGeometry g, PetscInt n, const RigidBodySpec parts[])
{
  PetscFunctionBegin;
  g->nparts = n;
  PetscCall(PetscMalloc1((size_t)n, &g->part));
  PetscCall(PetscMalloc1(4 * (size_t)n, &g->partq));
  for (PetscInt i = 0; i < n; i++) {
    RigidBodySpec *p = &g->part[i];
    PetscReal v[3];
    *p = parts[i];
    PetscCheck(p->shape != RIGID_MESH && p->shape != RIGID_COMPOSITE, g->comm, PETSC_ERR_ARG_WRONG,
               "Composite: part %" PetscInt_FMT " is a %s; must be a sphere, box, cylinder, ellipsoid or capsule", i,
               RigidShapeName(p->shape));
    PetscCall(RigidSpecCheck(g->comm, i, g->dim, p));
    for (PetscInt k = RigidShapeNumSizes(p->shape, g->dim); k < 3; k++) p->size[k] = 0.;
    for (int k = 0; k < 3; k++) v[k] = p->axisangle[k] * p->axisangle[3] / Vec3Norm(p->axisangle);
    QuatExp(v, &g->partq[4 * i]);
    QuatNormalize(&g->partq[4 * i]);
  }
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = 0; j < n; j++)
      if (i != j) PetscCall(CheckOverlap(g, i, j));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Volume, mean density, centres, tensor A of inertia per unit of mean density about the centre of mass. */
static void CompositeIntegrals(RigidGeometry g, PetscReal A[9])
{
  PetscReal mass = 0.;
  for (PetscInt i = 0; i < g->nparts; i++) {
    const PetscReal v = RigidShapeVolume(&g->part[i], g->dim), m = v * g->part[i].density;
    g->volume += v;
    mass += m;
    for (int k = 0; k < 3; k++) {
      g->center[k] += m * g->part[i].position[k];
      g->centroid[k] += v * g->part[i].position[k];
    }
  }
  g->density = mass / g->volume;
  for (int k = 0; k < 3; k++) {
    g->center[k] /= mass;
    g->centroid[k] = g->centroid[k] / g->volume - g->center[k];
  }
  for (int k = 0; k < 9; k++) A[k] = 0.;
  for (PetscInt i = 0; i < g->nparts; i++) {
    const PetscReal ratio = g->part[i].density / g->density, m = RigidShapeVolume(&g->part[i], g->dim) * ratio;
    PetscReal J[3], B[9], d[3];
    RigidShapeMoments(&g->part[i], g->dim, J);
    InertiaSpace(&g->partq[4 * i], J, B);
    for (int k = 0; k < 3; k++) d[k] = g->part[i].position[k] - g->center[k];
    for (int r = 0; r < 3; r++)
      for (int c = 0; c < 3; c++) A[3 * r + c] += ratio * B[3 * r + c] + m * ((r == c ? Vec3Dot(d, d) : 0.) - d[r] * d[c]);
  }
}

/* Moves parts and centroid to the body frame and finds the bounding box. */
static void CompositeBodyFrame(RigidGeometry g)
{
  PetscReal y[3], q[4];
  const PetscReal back[4] = {g->q[0], -g->q[1], -g->q[2], -g->q[3]};
  QuatRotateBack(g->q, g->centroid, y);
  for (int k = 0; k < 3; k++) g->centroid[k] = y[k];
  for (PetscInt i = 0; i < g->nparts; i++) {
    PetscReal d[3], h[3], R[9];
    for (int k = 0; k < 3; k++) d[k] = g->part[i].position[k] - g->center[k];
    QuatRotateBack(g->q, d, g->part[i].position);
    QuatMult(back, &g->partq[4 * i], q);
    for (int k = 0; k < 4; k++) g->partq[4 * i + k] = q[k];
    PartExtent(&g->part[i], g->dim, h);
    QuatMatrix(q, R);
    for (int k = 0; k < 3; k++) {
      const PetscReal r = PetscAbsReal(R[3 * k]) * h[0] + PetscAbsReal(R[3 * k + 1]) * h[1] + PetscAbsReal(R[3 * k + 2]) * h[2];
      const PetscReal lo = g->part[i].position[k] - r, hi = g->part[i].position[k] + r;
      g->lo[k] = i ? PetscMin(g->lo[k], lo) : lo;
      g->hi[k] = i ? PetscMax(g->hi[k], hi) : hi;
    }
  }
}

PetscErrorCode RigidGeometryCreateComposite(MPI_Comm comm, PetscInt dim, PetscInt n, const RigidBodySpec parts[],
                                            RigidGeometry *geometry)
{
  RigidGeometry g;
  PetscReal A[9];

  PetscFunctionBegin;
  PetscCheck(n > 0, comm, PETSC_ERR_ARG_SIZ, "Composite of %" PetscInt_FMT " parts; must have one at least", n);
  PetscCheck(dim == 2 || dim == 3, comm, PETSC_ERR_ARG_OUTOFRANGE, "Composite of dimension %" PetscInt_FMT "; must be 2 or 3",
             dim);
  PetscCall(RigidGeometryCreate_Private(comm, RIGID_COMPOSITE, dim, &g));
  *geometry = g;
  PetscCall(CopyParts(g, n, parts));
  CompositeIntegrals(g, A);
  if (dim == 3)
    RigidPrincipalAxes(A, g->J, g->q);
  else
    for (int k = 0; k < 3; k++) g->J[k] = A[4 * k];
  CompositeBodyFrame(g);
  PetscFunctionReturn(PETSC_SUCCESS);
}
