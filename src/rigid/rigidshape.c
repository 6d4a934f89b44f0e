/*
  rigidshape.c - what depends on a body's shape alone: names, checks of a body's fields, volume, moments of inertia of the
  homogeneous body, signed distance.

  Moments are the textbook integrals of rho (r^2 1 - r r^T); those of the capsule are the cylinder's plus twice the
  hemisphere's, moved by Steiner's rule. The distance to an ellipsoid is found from the closest point x of its surface to y,
  x_i = a_i^2 y_i/(t + a_i^2) with t the largest root of sum (a_i y_i/(t + a_i^2))^2 = 1.
*/
#include "rigidgeometry.h"

const char *RigidShapeName(RigidShape shape)
{
  static const char *const names[] = {"sphere", "box", "cylinder", "ellipsoid", "capsule", "mesh", "composite"};
  return names[shape];
}

PetscInt RigidShapeNumSizes(RigidShape shape, PetscInt dim)
{
  static const PetscInt n3[] = {1, 3, 2, 3, 2, 0, 0}, n2[] = {1, 2, 1, 2, 0, 0, 0};
  return dim == 2 ? n2[shape] : n3[shape];
}

PetscReal RigidShapeVolume(const RigidBodySpec *spec, PetscInt dim)
{
  const PetscReal *a = spec->size, r = spec->size[0];
  switch (spec->shape) {
  case RIGID_SPHERE:
    return dim == 2 ? PETSC_PI * r * r : 4. / 3. * PETSC_PI * r * r * r;
  case RIGID_BOX:
    return dim == 2 ? a[0] * a[1] : a[0] * a[1] * a[2];
  case RIGID_CYLINDER:
    return dim == 2 ? PETSC_PI * r * r : PETSC_PI * r * r * a[1];
  case RIGID_ELLIPSOID:
    return dim == 2 ? PETSC_PI * a[0] * a[1] : 4. / 3. * PETSC_PI * a[0] * a[1] * a[2];
  case RIGID_CAPSULE:
    return PETSC_PI * r * r * (a[1] + 4. / 3. * r);
  case RIGID_MESH:
  case RIGID_COMPOSITE:
    return spec->geometry->volume;
  }
  return 0.;
}

/* Unit density. In 2D the moments of the thin plate: J[2] = J[0] + J[1]. */
void RigidShapeMoments(const RigidBodySpec *spec, PetscInt dim, PetscReal J[3])
{
  const PetscReal *a = spec->size, r = spec->size[0], l = spec->size[1], v = RigidShapeVolume(spec, dim);
  PetscReal m[3] = {0., 0., 0.}; /* second moments: integral of x_i^2 */
  switch (spec->shape) {
  case RIGID_SPHERE:
    for (int i = 0; i < 3; i++) m[i] = v * r * r / (dim == 2 ? 4. : 5.);
    break;
  case RIGID_BOX:
    for (int i = 0; i < 3; i++) m[i] = v * a[i] * a[i] / 12.;
    break;
  case RIGID_CYLINDER:
    m[0] = m[1] = v * r * r / 4.;
    m[2] = v * l * l / 12.;
    break;
  case RIGID_ELLIPSOID:
    for (int i = 0; i < 3; i++) m[i] = v * a[i] * a[i] / (dim == 2 ? 4. : 5.);
    break;
  case RIGID_CAPSULE: {
    const PetscReal vc = PETSC_PI * r * r * l, vs = 4. / 3. * PETSC_PI * r * r * r;
    m[0] = m[1] = vc * r * r / 4. + vs * r * r / 5.;
    m[2] = vc * l * l / 12. + vs * (r * r / 5. + l * l / 4. + 3. / 8. * l * r); /* cap centroid at l/2 + 3r/8 */
    break;
  }
  case RIGID_MESH:
  case RIGID_COMPOSITE:
    for (int i = 0; i < 3; i++) J[i] = spec->geometry->J[i];
    return;
  }
  if (dim == 2) m[2] = 0.;
  for (int i = 0; i < 3; i++) J[i] = m[(i + 1) % 3] + m[(i + 2) % 3];
}

PetscReal RigidShapeSmallest(const RigidBodySpec *spec, PetscInt dim)
{
  const PetscReal *a = spec->size;
  switch (spec->shape) {
  case RIGID_SPHERE:
  case RIGID_CAPSULE:
    return 2. * a[0];
  case RIGID_CYLINDER:
    return dim == 2 ? 2. * a[0] : PetscMin(2. * a[0], a[1]);
  case RIGID_BOX:
    return dim == 2 ? PetscMin(a[0], a[1]) : PetscMin(PetscMin(a[0], a[1]), a[2]);
  case RIGID_MESH:
  case RIGID_COMPOSITE: {
    const PetscReal *lo = spec->geometry->lo, *hi = spec->geometry->hi;
    PetscReal least = PETSC_MAX_REAL;
    for (PetscInt k = 0; k < dim; k++) least = PetscMin(least, hi[k] - lo[k]);
    return least;
  }
  case RIGID_ELLIPSOID:
    return 2. * (dim == 2 ? PetscMin(a[0], a[1]) : PetscMin(PetscMin(a[0], a[1]), a[2]));
  }
  return 0.;
}

/* Newton from the left of the root of a convex, decreasing function is monotone; s = t + e^2, e the smallest semi-axis. */
static PetscReal EllipsoidRoot(PetscInt n, const PetscReal a[], const PetscReal y[], PetscReal e, PetscReal s)
{
  for (PetscInt it = 0; it < 300; it++) {
    PetscReal f = -1., df = 0., step;
    for (PetscInt i = 0; i < n; i++) {
      if (y[i] > 0.) {
        const PetscReal d = s + (a[i] - e) * (a[i] + e), g = a[i] * y[i] / d;
        f += g * g;
        df -= 2. * g * g / d;
      }
    }
    if (f <= 0. || df >= 0.) break;
    step = -f / df;
    s += step;
    if (step <= 1.e-16 * s) break;
  }
  return s;
}

static PetscReal EllipsoidDistance(PetscInt n, const PetscReal a[], const PetscReal x[])
{
  PetscReal y[3], e = a[0], ye = 0., level = 0., fmin = 0., dist = 0., s;
  for (PetscInt i = 0; i < n; i++) {
    y[i] = PetscAbsReal(x[i]);
    e = PetscMin(e, a[i]);
    level += (y[i] / a[i]) * (y[i] / a[i]);
  }
  for (PetscInt i = 0; i < n; i++) {
    if (a[i] <= e)
      ye += y[i] * y[i];
    else
      fmin += PetscSqr(a[i] * y[i] / ((a[i] - e) * (a[i] + e)));
  }
  if (ye == 0. && fmin <= 1.) { /* on the medial surface: the closest point is off it, along a shortest axis */
    PetscReal rest = 1.;
    for (PetscInt i = 0; i < n; i++) {
      if (a[i] > e) {
        const PetscReal c = a[i] * a[i] * y[i] / ((a[i] - e) * (a[i] + e));
        rest -= (c / a[i]) * (c / a[i]);
        dist += (c - y[i]) * (c - y[i]);
      }
    }
    return -PetscSqrtReal(dist + e * e * PetscMax(rest, 0.));
  }
  s = EllipsoidRoot(n, a, y, e, ye > 0. ? e * PetscSqrtReal(ye) : 1.e-30 * e * e);
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal c = a[i] * a[i] * y[i] / (s + (a[i] - e) * (a[i] + e));
    dist += (c - y[i]) * (c - y[i]);
  }
  return level < 1. ? -PetscSqrtReal(dist) : PetscSqrtReal(dist);
}

/* Distance to a box of half extents b given the offsets d = |x| - b along n axes. */
static PetscReal OffsetDistance(PetscInt n, const PetscReal d[])
{
  PetscReal out = 0., in = PETSC_MIN_REAL;
  for (PetscInt i = 0; i < n; i++) {
    out += d[i] > 0. ? d[i] * d[i] : 0.;
    in = PetscMax(in, d[i]);
  }
  return out > 0. ? PetscSqrtReal(out) : in;
}

PetscReal RigidShapeDistance(const RigidBodySpec *spec, const PetscReal x[3])
{
  const PetscReal *a = spec->size, r = a[0];
  PetscReal d[3];
  switch (spec->shape) {
  case RIGID_SPHERE:
    return Vec3Norm(x) - r;
  case RIGID_BOX:
    for (int i = 0; i < 3; i++) d[i] = PetscAbsReal(x[i]) - .5 * a[i];
    return OffsetDistance(a[2] > 0. ? 3 : 2, d);
  case RIGID_CYLINDER:
    d[0] = PetscSqrtReal(x[0] * x[0] + x[1] * x[1]) - r;
    d[1] = PetscAbsReal(x[2]) - .5 * a[1];
    return OffsetDistance(a[1] > 0. ? 2 : 1, d);
  case RIGID_ELLIPSOID:
    return EllipsoidDistance(a[2] > 0. ? 3 : 2, a, x);
  case RIGID_CAPSULE:
    d[0] = x[0];
    d[1] = x[1];
    d[2] = PetscMax(PetscAbsReal(x[2]) - .5 * a[1], 0.);
    return Vec3Norm(d) - r;
  case RIGID_MESH:
  case RIGID_COMPOSITE:
    return RigidGeometryDistance(spec->geometry, x);
  }
  return 0.;
}

static PetscErrorCode CheckFinite(MPI_Comm comm, PetscInt body, const char field[], const PetscReal x[], PetscInt n)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < n; k++) {
    PetscCheck(!PetscIsInfOrNanReal(x[k]), comm, PETSC_ERR_ARG_OUTOFRANGE,
               "Rigid body %" PetscInt_FMT ": %s[%" PetscInt_FMT "] = %g is not a finite number", body, field, k, (double)x[k]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mass and principal moments that the user gave; those from the shape are right by construction. */
static PetscErrorCode CheckMass(MPI_Comm comm, PetscInt body, PetscInt dim, const RigidBodySpec *spec)
{
  const PetscReal *J = spec->inertia;

  PetscFunctionBegin;
  PetscCheck(spec->mass == (PetscReal)PETSC_DECIDE || spec->mass > 0., comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Rigid body %" PetscInt_FMT ": mass = %g kg; must be > 0, or left to density and shape", body, (double)spec->mass);
  for (int i = 0; i < 3; i++) {
    PetscCheck(J[i] == (PetscReal)PETSC_DECIDE || J[i] > 0., comm, PETSC_ERR_ARG_OUTOFRANGE,
               "Rigid body %" PetscInt_FMT ": inertia[%d] = %g kg m^2; principal moments must be > 0 (positive definite)", body,
               i, (double)J[i]);
  }
  if (dim == 3 && J[0] > 0. && J[1] > 0. && J[2] > 0.) {
    for (int i = 0; i < 3; i++) {
      PetscCheck(J[i] <= (J[(i + 1) % 3] + J[(i + 2) % 3]) * (1. + 1.e-9), comm, PETSC_ERR_ARG_OUTOFRANGE,
                 "Rigid body %" PetscInt_FMT
                 ": inertia = (%g, %g, %g) kg m^2; no principal moment may exceed the sum of the other two",
                 body, (double)J[0], (double)J[1], (double)J[2]);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckLocks(MPI_Comm comm, PetscInt body, PetscInt dim, const RigidBodySpec *spec)
{
  PetscFunctionBegin;
  for (int k = 0; k < 6 && spec->motion == RIGID_FREE; k++) {
    const PetscReal v = k < 3 ? spec->velocity[k] : spec->omega[k - 3];
    PetscCheck(!spec->lock[k] || v == 0., comm, PETSC_ERR_ARG_INCOMP,
               "Rigid body %" PetscInt_FMT ": %s[%d] = %g, but this direction is locked; must be 0", body,
               k < 3 ? "velocity" : "omega", k % 3, (double)v);
  }
  if (dim == 2) {
    PetscCheck(spec->velocity[2] == 0. && spec->omega[0] == 0. && spec->omega[1] == 0., comm, PETSC_ERR_ARG_INCOMP,
               "Rigid body %" PetscInt_FMT ": velocity[2], omega[0], omega[1] = %g, %g, %g; must be 0 in 2D", body,
               (double)spec->velocity[2], (double)spec->omega[0], (double)spec->omega[1]);
    PetscCheck(spec->axisangle[3] == 0. || (spec->axisangle[0] == 0. && spec->axisangle[1] == 0.), comm, PETSC_ERR_ARG_INCOMP,
               "Rigid body %" PetscInt_FMT ": axisangle = (%g, %g, %g, %g); the axis must be along z in 2D", body,
               (double)spec->axisangle[0], (double)spec->axisangle[1], (double)spec->axisangle[2], (double)spec->axisangle[3]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidSpecCheck(MPI_Comm comm, PetscInt body, PetscInt dim, const RigidBodySpec *spec)
{
  PetscFunctionBegin;
  PetscCheck((int)spec->shape >= 0 && spec->shape <= RIGID_COMPOSITE, comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Rigid body %" PetscInt_FMT
             ": shape = %d; must be one of sphere, box, cylinder, ellipsoid, capsule, mesh, composite",
             body, (int)spec->shape);
  if (spec->shape == RIGID_MESH || spec->shape == RIGID_COMPOSITE) {
    PetscCheck(spec->geometry && spec->geometry->shape == spec->shape, comm, PETSC_ERR_ARG_INCOMP,
               "Rigid body %" PetscInt_FMT ": shape = %s, but its geometry is %s; must be a %s", body,
               RigidShapeName(spec->shape), spec->geometry ? RigidShapeName(spec->geometry->shape) : "missing",
               RigidShapeName(spec->shape));
    PetscCheck(spec->geometry->dim == dim, comm, PETSC_ERR_ARG_INCOMP,
               "Rigid body %" PetscInt_FMT ": the geometry of a %s in %" PetscInt_FMT "D cannot be used in %" PetscInt_FMT "D",
               body, RigidShapeName(spec->shape), spec->geometry->dim, dim);
  }
  PetscCheck(dim == 3 || spec->shape != RIGID_CAPSULE, comm, PETSC_ERR_ARG_INCOMP,
             "Rigid body %" PetscInt_FMT ": shape = capsule; in 2D use cylinder (a disc), box or ellipsoid", body);
  PetscCheck((int)spec->motion >= 0 && spec->motion <= RIGID_FREE, comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Rigid body %" PetscInt_FMT ": motion = %d; must be one of fixed, prescribed, free", body, (int)spec->motion);
  PetscCall(CheckFinite(comm, body, "size", spec->size, RigidShapeNumSizes(spec->shape, dim)));
  for (PetscInt k = 0; k < RigidShapeNumSizes(spec->shape, dim); k++) {
    PetscCheck(spec->size[k] > 0., comm, PETSC_ERR_ARG_OUTOFRANGE,
               "Rigid body %" PetscInt_FMT ": size[%" PetscInt_FMT "] = %g m of a %s; must be > 0", body, k,
               (double)spec->size[k], RigidShapeName(spec->shape));
  }
  PetscCall(CheckFinite(comm, body, "density", &spec->density, 1));
  PetscCheck(spec->density > 0., comm, PETSC_ERR_ARG_OUTOFRANGE, "Rigid body %" PetscInt_FMT ": density = %g kg/m^3; must be > 0",
             body, (double)spec->density);
  PetscCall(CheckFinite(comm, body, "position", spec->position, 3));
  PetscCall(CheckFinite(comm, body, "velocity", spec->velocity, 3));
  PetscCall(CheckFinite(comm, body, "omega", spec->omega, 3));
  PetscCall(CheckFinite(comm, body, "axisangle", spec->axisangle, 4));
  PetscCheck(Vec3Norm(spec->axisangle) > 0., comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Rigid body %" PetscInt_FMT ": axisangle = (0, 0, 0, %g); the axis must have a length > 0", body,
             (double)spec->axisangle[3]);
  PetscCall(CheckFinite(comm, body, "mass", &spec->mass, 1));
  PetscCall(CheckFinite(comm, body, "inertia", spec->inertia, 3));
  PetscCall(CheckMass(comm, body, dim, spec));
  PetscCall(CheckLocks(comm, body, dim, spec));
  PetscFunctionReturn(PETSC_SUCCESS);
}
