/*
  rigidfill.c - BCE markers of a rigid body (Pazouki, Serban, Negrut, Sect. 2.4, Fig. 2a): "placed to a depth no larger than
  the size of the compact support", about dp apart.

  Sphere, capsule, disc, radial direction of a cylinder: layer k lies between the surfaces at depth k dp and (k+1) dp, its
  markers half way. Markers of a layer stand on latitude rings, evenly along the meridian and along each ring; a marker's
  volume is its ring's exact share of the layer. A core too thin for a layer of its own is counted with the last layer.
  Box, axial direction of a cylinder: edges are divided evenly into round(edge/dp) cells, which are multiples of dp.
  Ellipsoid: layers lie between the ellipsoids of semi-axes a_i - k dp and a_i - (k+1) dp. These are not parallel surfaces:
  such a layer is dp thick at the six poles and up to a few percent thinner between them. The recorded depth is exact.
  Mesh, composite: see rigidpack.c.
*/
#include "rigidimpl.h"

#define SLACK (1. + 1.e-9) /* so that sizes which are multiples of dp are not lost to round-off */

PetscErrorCode RigidMarkersAdd(RigidMarkers *m, PetscReal x, PetscReal y, PetscReal z, PetscReal volume)
{
  PetscFunctionBegin;
  if (m->n == m->nalloc) {
    m->nalloc = 2 * m->nalloc + 64;
    PetscCall(PetscRealloc(sizeof(PetscReal) * 3 * (size_t)m->nalloc, &m->x));
    PetscCall(PetscRealloc(sizeof(PetscReal) * (size_t)m->nalloc, &m->volume));
  }
  m->x[3 * m->n] = x;
  m->x[3 * m->n + 1] = y;
  m->x[3 * m->n + 2] = z;
  m->volume[m->n++] = volume;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt RoundToOne(PetscReal x)
{
  return PetscMax(1, (PetscInt)PetscFloorReal(x + .5));
}

/* Markers on a circle of radius rho at height z, spaced about dp; one goes to the axis, two are kept dp apart. */
static PetscErrorCode Ring(RigidMarkers *m, PetscReal dp, PetscReal rho, PetscReal z, PetscInt parity, PetscReal volume)
{
  const PetscInt n = RoundToOne(2. * PETSC_PI * rho / dp);

  PetscFunctionBegin;
  if (n == 1) rho = 0.;
  if (n == 2) rho = PetscMax(rho, .5 * dp);
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal phi = 2. * PETSC_PI * ((PetscReal)i + .5 * (PetscReal)(parity % 2)) / (PetscReal)n;
    PetscCall(RigidMarkersAdd(m, rho * PetscCosReal(phi), rho * PetscSinReal(phi), z, volume / (PetscReal)n));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Radial layer k of a round body of radius R: its outer, inner and marker radius. False when there is no such layer. A core of
  radius < 0.4 dp, whose disc is smaller than half a marker's, goes to the last layer if it is to be filled at all.
*/
static PetscBool RadialLayer(PetscReal R, PetscReal dp, PetscReal depthmax, PetscInt k, PetscReal *ro, PetscReal *ri,
                             PetscReal *rk)
{
  const PetscReal out = R - (PetscReal)k * dp, in = out - dp;
  if (out <= 1.e-9 * dp || ((PetscReal)k + .5) * dp > depthmax * SLACK) return PETSC_FALSE;
  if (k > 0 && out < .4 * dp) return PETSC_FALSE;
  *ro = out;
  *ri = (in < .4 * dp && ((PetscReal)k + 1.5) * dp <= depthmax * SLACK) ? 0. : PetscMax(in, 0.);
  *rk = PetscMax(out - .5 * dp, 0.);
  return PETSC_TRUE;
}

/* Volume of a shell ro > r > ri of a capsule (cylinder of length L) between the arc lengths s0 < s1 of the meridian of radius rk.
 */
static PetscReal CapsuleBand(PetscReal L, PetscReal rk, PetscReal ro, PetscReal ri, PetscReal s0, PetscReal s1)
{
  const PetscReal c = .5 * PETSC_PI * rk, cap = 2. / 3. * PETSC_PI * (ro * ro * ro - ri * ri * ri);
  PetscReal v = 0., a, b;
  if (s0 < c) v += cap * (PetscCosReal(s0 / rk) - PetscCosReal(PetscMin(s1, c) / rk));
  a = PetscMax(s0, c);
  b = PetscMin(s1, c + L);
  if (b > a) v += PETSC_PI * (ro * ro - ri * ri) * (b - a);
  a = PetscMax(s0, c + L);
  if (s1 > a) v += cap * (PetscSinReal((s1 - c - L) / rk) - PetscSinReal((a - c - L) / rk));
  return v;
}

/* A sphere is a capsule with L = 0. */
static PetscErrorCode CapsuleLayer(RigidMarkers *m, PetscReal dp, PetscReal L, PetscReal ro, PetscReal ri, PetscReal rk)
{
  PetscFunctionBegin;
  if (rk <= 1.e-9 * dp) {
    const PetscInt n = RoundToOne((L + 2. * ro) / dp);
    const PetscReal v = PETSC_PI * (ro * ro * L + 4. / 3. * ro * ro * ro - ri * ri * L - 4. / 3. * ri * ri * ri);
    for (PetscInt i = 0; i < n; i++)
      PetscCall(RigidMarkersAdd(m, 0., 0., (L + 2. * ro) * (((PetscReal)i + .5) / (PetscReal)n - .5), v / (PetscReal)n));
  } else {
    const PetscReal c = .5 * PETSC_PI * rk, length = 2. * c + L;
    const PetscInt n = RoundToOne(length / dp);
    for (PetscInt i = 0; i < n; i++) {
      const PetscReal s0 = length * (PetscReal)i / (PetscReal)n, s1 = length * (PetscReal)(i + 1) / (PetscReal)n,
                      s = .5 * (s0 + s1);
      PetscReal rho = rk, z = .5 * L - (s - c);
      if (s < c) {
        rho = rk * PetscSinReal(s / rk);
        z = .5 * L + rk * PetscCosReal(s / rk);
      } else if (s > c + L) {
        rho = rk * PetscCosReal((s - c - L) / rk);
        z = -.5 * L - rk * PetscSinReal((s - c - L) / rk);
      }
      PetscCall(Ring(m, dp, rho, z, i, CapsuleBand(L, rk, ro, ri, s0, s1)));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FillCapsule(RigidMarkers *m, PetscReal R, PetscReal L, PetscReal dp, PetscReal depthmax)
{
  PetscReal ro, ri, rk;

  PetscFunctionBegin;
  for (PetscInt k = 0; RadialLayer(R, dp, depthmax, k, &ro, &ri, &rk); k++) PetscCall(CapsuleLayer(m, dp, L, ro, ri, rk));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One disc of a cylinder (dz thick; 1 in 2D) at height z. */
static PetscErrorCode FillDisc(RigidMarkers *m, PetscReal R, PetscReal z, PetscReal dz, PetscInt parity, PetscReal dp,
                               PetscReal depthmax)
{
  PetscReal ro, ri, rk;

  PetscFunctionBegin;
  for (PetscInt k = 0; RadialLayer(R, dp, depthmax, k, &ro, &ri, &rk); k++)
    PetscCall(Ring(m, dp, rk, z, k + parity, PETSC_PI * (ro * ro - ri * ri) * dz));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FillCylinder(RigidMarkers *m, PetscReal R, PetscReal L, PetscReal dp, PetscReal depthmax)
{
  const PetscInt n = RoundToOne(L / dp);
  const PetscReal dz = L / (PetscReal)n;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal z = -.5 * L + ((PetscReal)i + .5) * dz;
    const PetscBool end = .5 * L - PetscAbsReal(z) <= depthmax * SLACK ? PETSC_TRUE : PETSC_FALSE;
    PetscCall(FillDisc(m, R, z, dz, i, dp, end ? R + dp : depthmax));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FillBox(RigidMarkers *m, PetscInt dim, const PetscReal a[], PetscReal dp, PetscReal depthmax)
{
  PetscInt n[3] = {1, 1, 1};
  PetscReal d[3] = {0., 0., 0.}, v = 1.;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < dim; k++) {
    n[k] = RoundToOne(a[k] / dp);
    d[k] = a[k] / (PetscReal)n[k];
    v *= d[k];
  }
  for (PetscInt iz = 0; iz < n[2]; iz++) {
    for (PetscInt iy = 0; iy < n[1]; iy++) {
      for (PetscInt ix = 0; ix < n[0]; ix++) {
        const PetscInt i[3] = {ix, iy, iz};
        PetscReal x[3] = {0., 0., 0.}, depth = PETSC_MAX_REAL;
        for (PetscInt k = 0; k < dim; k++) {
          x[k] = ((PetscReal)i[k] + .5 - .5 * (PetscReal)n[k]) * d[k];
          depth = PetscMin(depth, .5 * a[k] - PetscAbsReal(x[k]));
        }
        if (depth <= depthmax * SLACK) PetscCall(RigidMarkersAdd(m, x[0], x[1], x[2], v));
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Angles theta that cut an arc of the ellipse (p cos theta, q sin theta), 0 <= theta <= span, into n parts of equal length,
  theta[0..2n]: ends and middles alternate. Returns the arc length. Midpoint rule on a fine grid; only the evenness depends on it.
*/
#define ARC_STEPS 2048
static PetscReal EllipseArc(PetscReal p, PetscReal q, PetscReal span, PetscInt n, PetscReal theta[])
{
  const PetscReal h = span / ARC_STEPS;
  PetscReal length = 0., s = 0.;
  PetscInt next = 0;
  for (PetscInt i = 0; i < ARC_STEPS; i++) {
    const PetscReal t = ((PetscReal)i + .5) * h;
    length += h * PetscSqrtReal(PetscSqr(p * PetscSinReal(t)) + PetscSqr(q * PetscCosReal(t)));
  }
  for (PetscInt i = 0; i < ARC_STEPS && theta; i++) {
    const PetscReal t = ((PetscReal)i + .5) * h,
                    ds = h * PetscSqrtReal(PetscSqr(p * PetscSinReal(t)) + PetscSqr(q * PetscCosReal(t)));
    for (; next < 2 * n && length * (PetscReal)next / (PetscReal)(2 * n) <= s + ds; next++)
      theta[next] = ((PetscReal)i + (length * (PetscReal)next / (PetscReal)(2 * n) - s) / ds) * h;
    s += ds;
  }
  if (theta) theta[2 * n] = span;
  return length;
}

/* Ring of an ellipsoid: ellipse of semi-axes p, q in the plane of axes u, v at height z along axis w. */
static PetscErrorCode EllipseRing(RigidMarkers *m, PetscReal dp, const PetscInt axis[3], PetscReal p, PetscReal q, PetscReal z,
                                  PetscInt parity, PetscReal volume)
{
  const PetscInt n = RoundToOne(EllipseArc(p, q, 2. * PETSC_PI, 1, NULL) / dp);
  PetscReal *theta;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1((size_t)(2 * n + 1), &theta));
  (void)EllipseArc(p, q, 2. * PETSC_PI, n, theta);
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal t = theta[2 * i + parity % 2];
    PetscReal x[3];
    x[axis[0]] = n == 1 ? 0. : p * PetscCosReal(t);
    x[axis[1]] = n == 1 ? 0. : q * PetscSinReal(t);
    x[axis[2]] = z;
    PetscCall(RigidMarkersAdd(m, x[0], x[1], x[2], volume / (PetscReal)n));
  }
  PetscCall(PetscFree(theta));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Axis about which the ellipsoid c is roundest: the ratio of the other two semi-axes is nearest to 1. */
static PetscInt EllipsoidAxis(const PetscReal c[3])
{
  PetscInt w = 0;
  PetscReal best = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < 3; k++) {
    const PetscReal p = c[(k + 1) % 3], q = c[(k + 2) % 3], ratio = PetscMax(p, q) / PetscMin(p, q);
    if (ratio < best) {
      best = ratio;
      w = k;
    }
  }
  return w;
}

/* Layer of an ellipsoid on the mean ellipsoid c, the volume between products of semi-axes vo and vi. */
static PetscErrorCode EllipsoidLayer(RigidMarkers *m, PetscReal dp, const PetscReal c[3], PetscReal vo, PetscReal vi)
{
  const PetscInt w = EllipsoidAxis(c), axis[3] = {(w + 1) % 3, (w + 2) % 3, w};
  const PetscReal mean = .5 * (c[axis[0]] + c[axis[1]]);
  const PetscInt n = RoundToOne(EllipseArc(c[w], mean, PETSC_PI, 1, NULL) / dp);
  PetscReal *theta;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1((size_t)(2 * n + 1), &theta));
  (void)EllipseArc(c[w], mean, PETSC_PI, n, theta);
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal v = 2. / 3. * PETSC_PI * (vo - vi) * (PetscCosReal(theta[2 * i]) - PetscCosReal(theta[2 * i + 2])),
                    t = theta[2 * i + 1];
    PetscCall(EllipseRing(m, dp, axis, c[axis[0]] * PetscSinReal(t), c[axis[1]] * PetscSinReal(t), c[w] * PetscCosReal(t), i, v));
  }
  PetscCall(PetscFree(theta));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The core of an ellipsoid, thinner than 2 dp: cell centres of an even grid share its volume. They keep 0.3 dp from the core's
  surface, less where each would stand for more than 1.5 cells.
*/
static PetscErrorCode EllipsoidCore(RigidMarkers *m, PetscInt dim, PetscReal dp, const PetscReal a[3], PetscReal volume)
{
  RigidBodySpec core;
  PetscInt n[3] = {1, 1, 1};
  const PetscInt first = m->n;
  const PetscReal fewest = volume / (1.5 * PetscPowReal(dp, (PetscReal)dim));

  PetscFunctionBegin;
  PetscCall(RigidBodySpecInit(&core));
  core.shape = RIGID_ELLIPSOID;
  for (PetscInt k = 0; k < dim; k++) {
    n[k] = RoundToOne(2. * a[k] / dp);
    core.size[k] = a[k];
  }
  for (PetscInt gap = 3; gap >= 0 && (PetscReal)(m->n - first) < fewest; gap--) {
    m->n = first;
    for (PetscInt c = 0; c < n[0] * n[1] * n[2]; c++) {
      const PetscInt i[3] = {c % n[0], (c / n[0]) % n[1], c / (n[0] * n[1])};
      PetscReal x[3] = {0., 0., 0.};
      for (PetscInt k = 0; k < dim; k++) x[k] = a[k] * (2. * ((PetscReal)i[k] + .5) / (PetscReal)n[k] - 1.);
      if (RigidShapeDistance(&core, x) <= -.1 * dp * (PetscReal)gap) PetscCall(RigidMarkersAdd(m, x[0], x[1], x[2], 0.));
    }
  }
  for (PetscInt i = first; i < m->n; i++) m->volume[i] = volume / (PetscReal)(m->n - first);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FillEllipsoid(RigidMarkers *m, PetscInt dim, const PetscReal a[], PetscReal dp, PetscReal depthmax)
{
  const PetscInt xyz[3] = {0, 1, 2};
  const PetscReal unit = dim == 2 ? PETSC_PI : 4. / 3. * PETSC_PI;
  PetscReal least = PETSC_MAX_REAL;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < dim; i++) least = PetscMin(least, a[i]);
  for (PetscInt k = 0; ((PetscReal)k + .5) * dp <= depthmax * SLACK; k++) {
    const PetscReal d = (PetscReal)k * dp, in = least - d - dp;
    const PetscBool rest = (in < .3 * dp && ((PetscReal)k + 1.5) * dp <= depthmax * SLACK) || in <= 0. ? PETSC_TRUE : PETSC_FALSE;
    PetscReal o[3] = {0., 0., 0.}, c[3] = {0., 0., 0.}, vo = 1., vi = 1.;
    for (PetscInt i = 0; i < dim; i++) {
      o[i] = a[i] - d;
      c[i] = o[i] - .5 * dp;
      vo *= o[i];
      vi *= o[i] - dp;
    }
    if (rest) vi = 0.;
    if (least - d < SLACK * dp)
      PetscCall(EllipsoidCore(m, dim, dp, o, unit * vo));
    else if (dim == 2)
      PetscCall(EllipseRing(m, dp, xyz, c[0], c[1], 0., k, unit * (vo - vi)));
    else
      PetscCall(EllipsoidLayer(m, dp, c, vo, vi));
    if (rest) break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidFillCheck(const RigidBodySpec *spec, PetscInt dim, PetscReal dp)
{
  const PetscReal least = RigidShapeSmallest(spec, dim);

  PetscFunctionBegin;
  PetscCheck(dim == 2 || dim == 3, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "RigidFillMarkers(): dim = %" PetscInt_FMT "; must be 2 or 3", dim);
  PetscCheck(dp > 0. && !PetscIsInfOrNanReal(dp), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "RigidFillMarkers(): dp = %g m; must be > 0", (double)dp);
  PetscCheck(least * SLACK >= dp, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "A %s whose smallest extent is %g m cannot be marked at spacing dp = %g m; dp must be <= %g m",
             RigidShapeName(spec->shape), (double)least, (double)dp, (double)least);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidFillMarkers(const RigidBodySpec *spec, PetscInt dim, PetscReal dp, PetscReal depthmax, PetscInt *n,
                                PetscReal **x, PetscReal **volume, PetscReal **depth)
{
  RigidMarkers m = {0, 0, NULL, NULL, NULL};
  RigidBodySpec flat = *spec;
  const PetscReal *a = flat.size;

  PetscFunctionBegin;
  PetscCall(RigidFillCheck(spec, dim, dp));
  PetscCheck(depthmax >= .5 * dp, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "RigidFillMarkers(): depthmax = %g m; must be >= dp/2 = %g m", (double)depthmax, .5 * (double)dp);
  PetscCheck(RigidShapeVolume(spec, dim) / PetscPowReal(dp, (PetscReal)dim) < 2.e9, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "A %s of volume %g would need more than 2e9 markers at spacing dp = %g m", RigidShapeName(spec->shape),
             (double)RigidShapeVolume(spec, dim), (double)dp);
  PetscCall(RigidCheckCount(spec, dim, dp, depthmax));
  PetscCall(RigidRegisterEvents());
  PetscCall(PetscLogEventBegin(RIGID_Fill, 0, 0, 0, 0));
  for (PetscInt k = RigidShapeNumSizes(spec->shape, dim); k < 3; k++) flat.size[k] = 0.;
  switch (spec->shape) {
  case RIGID_SPHERE:
    if (dim == 2)
      PetscCall(FillDisc(&m, a[0], 0., 1., 0, dp, depthmax));
    else
      PetscCall(FillCapsule(&m, a[0], 0., dp, depthmax));
    break;
  case RIGID_CAPSULE:
    PetscCall(FillCapsule(&m, a[0], a[1], dp, depthmax));
    break;
  case RIGID_CYLINDER:
    if (dim == 2)
      PetscCall(FillDisc(&m, a[0], 0., 1., 0, dp, depthmax));
    else
      PetscCall(FillCylinder(&m, a[0], a[1], dp, depthmax));
    break;
  case RIGID_BOX:
    PetscCall(FillBox(&m, dim, a, dp, depthmax));
    break;
  case RIGID_ELLIPSOID:
    PetscCall(FillEllipsoid(&m, dim, a, dp, depthmax));
    break;
  case RIGID_MESH:
  case RIGID_COMPOSITE:
    PetscCall(RigidPackMarkers(&m, &flat, dim, dp, depthmax));
    break;
  }
  PetscCall(PetscMalloc1(m.n, &m.depth));
  for (PetscInt i = 0; i < m.n; i++) m.depth[i] = -RigidShapeDistance(&flat, &m.x[3 * i]);
  *n = m.n;
  *x = m.x;
  *volume = m.volume;
  *depth = m.depth;
  PetscCall(PetscLogEventEnd(RIGID_Fill, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
