/*
  rigidsurface.c - points on the surface of a body, about `spacing` apart, edges and corners included: what short-range forces
  of bodies that are no spheres are summed over.
*/
#include "rigidgeometry.h"

/* Outward unit normal by central differences; false on the medial surface. */
PetscBool RigidShapeNormal(const RigidBodySpec *s, PetscInt dim, const PetscReal x[3], PetscReal step, PetscReal n[3])
{
  PetscReal norm;
  n[0] = n[1] = n[2] = 0.;
  for (PetscInt k = 0; k < dim && k < 3; k++) {
    PetscReal p[3] = {x[0], x[1], x[2]}, m[3] = {x[0], x[1], x[2]};
    p[k] += step;
    m[k] -= step;
    n[k] = RigidShapeDistance(s, p) - RigidShapeDistance(s, m);
  }
  norm = Vec3Norm(n);
  if (norm == 0.) return PETSC_FALSE;
  for (int k = 0; k < 3; k++) n[k] /= norm;
  return PETSC_TRUE;
}

static PetscInt Cells(PetscReal length, PetscReal spacing)
{
  return PetscMax(1, (PetscInt)PetscFloorReal(length / spacing + .5));
}

/* Nodes of the box's lattice that lie on its faces. */
static PetscErrorCode BoxSurface(const RigidBodySpec *s, PetscInt dim, PetscReal spacing, RigidMarkers *m)
{
  PetscInt n[3] = {0, 0, 0};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < dim; k++) n[k] = Cells(s->size[k], spacing);
  for (PetscInt iz = 0; iz <= n[2]; iz++)
    for (PetscInt iy = 0; iy <= n[1]; iy++)
      for (PetscInt ix = 0; ix <= n[0]; ix++) {
        const PetscInt i[3] = {ix, iy, iz};
        PetscBool face = PETSC_FALSE;
        PetscReal x[3] = {0., 0., 0.};
        for (PetscInt k = 0; k < dim; k++) {
          x[k] = s->size[k] * ((PetscReal)i[k] / (PetscReal)n[k] - .5);
          if (i[k] == 0 || i[k] == n[k]) face = PETSC_TRUE;
        }
        if (face) PetscCall(RigidMarkersAdd(m, x[0], x[1], x[2], 0.));
      }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Circle(RigidMarkers *m, PetscReal r, PetscReal z, PetscReal spacing)
{
  const PetscInt n = r > 0. ? PetscMax(3, Cells(2. * PETSC_PI * r, spacing)) : 1;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal phi = 2. * PETSC_PI * (PetscReal)i / (PetscReal)n;
    PetscCall(RigidMarkersAdd(m, r * PetscCosReal(phi), r * PetscSinReal(phi), z, 0.));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CylinderSurface(const RigidBodySpec *s, PetscReal spacing, RigidMarkers *m)
{
  const PetscReal R = s->size[0], L = s->size[1];
  const PetscInt nz = Cells(L, spacing), nr = Cells(R, spacing);

  PetscFunctionBegin;
  for (PetscInt i = 0; i <= nz; i++) PetscCall(Circle(m, R, L * ((PetscReal)i / (PetscReal)nz - .5), spacing));
  for (PetscInt i = 0; i < nr; i++)
    for (int e = -1; e <= 1; e += 2) PetscCall(Circle(m, R * (PetscReal)i / (PetscReal)nr, .5 * L * e, spacing));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The outer layer of BCE markers moved onto the surface. */
static PetscErrorCode LayerSurface(const RigidBodySpec *s, PetscInt dim, PetscReal spacing, RigidMarkers *m)
{
  PetscInt n;
  PetscReal *x, *v, *depth;

  PetscFunctionBegin;
  PetscCall(RigidFillMarkers(s, dim, spacing, .75 * spacing, &n, &x, &v, &depth));
  for (PetscInt i = 0; i < n; i++) {
    PetscReal nrm[3], y[3];
    if (!RigidShapeNormal(s, dim, &x[3 * i], 1.e-5 * spacing, nrm)) continue;
    for (int k = 0; k < 3; k++) y[k] = x[3 * i + k] + depth[i] * nrm[k];
    if (PetscAbsReal(RigidShapeDistance(s, y)) < 1.e-3 * spacing) PetscCall(RigidMarkersAdd(m, y[0], y[1], y[2], 0.));
  }
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(v));
  PetscCall(PetscFree(depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Surfaces of the parts, less what lies inside of another part. */
static PetscErrorCode CompositeSurface(RigidGeometry g, PetscReal spacing, RigidMarkers *m)
{
  PetscFunctionBegin;
  for (PetscInt p = 0; p < g->nparts; p++) {
    const PetscInt first = m->n;
    PetscInt keep = first;
    PetscCall(RigidSurfacePoints(&g->part[p], g->dim, spacing, m));
    for (PetscInt i = first; i < m->n; i++) {
      PetscReal x[3];
      QuatRotate(&g->partq[4 * p], &m->x[3 * i], x);
      for (int k = 0; k < 3; k++) x[k] += g->part[p].position[k];
      if (RigidGeometryDistance(g, x) < -1.e-6 * spacing) continue;
      for (int k = 0; k < 3; k++) m->x[3 * keep + k] = x[k];
      keep++;
    }
    m->n = keep;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sides of a box that holds the shape, m. */
static void Extents(const RigidBodySpec *s, PetscReal e[3])
{
  const PetscReal *a = s->size;
  for (int k = 0; k < 3; k++) {
    if (s->geometry)
      e[k] = s->geometry->hi[k] - s->geometry->lo[k];
    else
      e[k] = s->shape == RIGID_BOX ? a[k] : 2. * (s->shape == RIGID_ELLIPSOID ? a[k] : a[0]);
  }
  if (s->shape == RIGID_CYLINDER || s->shape == RIGID_CAPSULE) e[2] = a[1] + (s->shape == RIGID_CAPSULE ? 2. * a[0] : 0.);
}

/* Before any memory is taken: about how many markers lie to a depth (m) below the surface; fewer than 10^8 are. */
PetscErrorCode RigidCheckCount(const RigidBodySpec *s, PetscInt dim, PetscReal spacing, PetscReal depth)
{
  PetscReal e[3], area, volume, count;

  PetscFunctionBegin;
  Extents(s, e);
  area = dim == 2 ? 2. * (e[0] + e[1]) : 2. * (e[0] * e[1] + e[1] * e[2] + e[2] * e[0]);
  volume = dim == 2 ? e[0] * e[1] : e[0] * e[1] * e[2];
  count = PetscMin(volume, area * depth) / PetscPowRealInt(spacing, (int)dim);
  PetscCheck(!(count >= 1.e8), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "a %s of %g x %g x %g m takes about %.2g markers %g m apart; must be fewer than 1e8", RigidShapeName(s->shape),
             (double)e[0], (double)e[1], (double)e[2], (double)count, (double)spacing);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Appends points in the body frame to m->x. */
PetscErrorCode RigidSurfacePoints(const RigidBodySpec *s, PetscInt dim, PetscReal spacing, RigidMarkers *m)
{
  PetscFunctionBegin;
  PetscCall(RigidCheckCount(s, dim, spacing, spacing));
  if (s->shape == RIGID_BOX)
    PetscCall(BoxSurface(s, dim, spacing, m));
  else if (dim == 2 && (s->shape == RIGID_SPHERE || s->shape == RIGID_CYLINDER))
    PetscCall(Circle(m, s->size[0], 0., spacing));
  else if (s->shape == RIGID_CYLINDER)
    PetscCall(CylinderSurface(s, spacing, m));
  else if (s->shape == RIGID_COMPOSITE)
    PetscCall(CompositeSurface(s->geometry, spacing, m));
  else
    PetscCall(LayerSurface(s, dim, spacing, m));
  if (s->shape == RIGID_MESH) {
    const RigidMesh *mesh = &s->geometry->mesh;
    for (PetscInt v = 0; v < mesh->nv; v++)
      PetscCall(RigidMarkersAdd(m, mesh->x[3 * v], mesh->x[3 * v + 1], mesh->x[3 * v + 2], 0.));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
