/*
  scenecurve.c - the axis of a beam through the points of a mesh: a straight line, an arc of a circle, or another curve in a
  plane.

  Tangents are those of the circle through a point and its neighbours, exact for circles however the points are spaced; the curve
  between is Hermite's cubic, whose nodes are spaced evenly along it.
*/
#include "app.h"

/* Places of points may be off by this share of the length: files hold as few as eight digits. */
#define PLACE_TOLERANCE 1e-6

static PetscReal dot(const PetscReal a[3], const PetscReal b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const PetscReal a[3], const PetscReal b[3], PetscReal r[3])
{
  for (int c = 0; c < 3; c++) r[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
}

/* u = (b - a)/|b - a|; returns the distance. */
static PetscReal towards(const PetscReal a[3], const PetscReal b[3], PetscReal u[3])
{
  PetscReal d;

  for (int c = 0; c < 3; c++) u[c] = b[c] - a[c];
  d = PetscSqrtReal(dot(u, u));
  for (int c = 0; c < 3 && d > 0; c++) u[c] /= d;
  return d;
}

/*
  Unit tangent at b, from a to c, of the circle through the three: the chords of lengths h1, h2 deviate from it by half their
  arcs, sin(arc/2) = h/(2R), to either side.
*/
void AppCurveTangent(const PetscReal a[3], const PetscReal b[3], const PetscReal c[3], PetscReal t[3])
{
  PetscReal u[3], w[3], h1 = towards(a, b, u), h2 = towards(b, c, w), size;

  for (int k = 0; k < 3; k++) t[k] = h2 * u[k] + h1 * w[k];
  size = PetscSqrtReal(dot(t, t));
  for (int k = 0; k < 3; k++) t[k] /= size;
}

/* Tangents of all m + 1 points; t0, t1: given ones of the ends, or NULL. */
static void tangents(PetscInt m, const PetscReal *x, const PetscReal *t0, const PetscReal *t1, PetscReal *t)
{
  PetscReal u[3];

  for (PetscInt k = 1; k < m; k++) AppCurveTangent(x + 3 * (k - 1), x + 3 * k, x + 3 * (k + 1), t + 3 * k);
  for (int end = 0; end < 2; end++) { /* mirrored across the chord */
    const PetscInt at = end ? m : 0, next = end ? m - 1 : 1;
    const PetscReal *given = end ? t1 : t0;

    towards(x + 3 * PetscMin(at, next), x + 3 * PetscMax(at, next), u);
    for (int c = 0; c < 3; c++)
      t[3 * at + c] = given ? given[c] : m == 1 ? u[c] : 2 * dot(t + 3 * next, u) * u[c] - t[3 * next + c];
  }
}

/* The circle through the first, the middle and the last point: curvature (1/m), axis and centre; 0 for a straight line. */
static PetscReal circle(PetscInt m, const PetscReal *x, PetscReal axis[3], PetscReal centre[3])
{
  const PetscReal *p = x, *q = x + 3 * (m / 2), *r = x + 3 * m;
  PetscReal u[3], w[3], d[3], uu, ww, nn;

  for (int a = 0; a < 3; a++) u[a] = q[a] - p[a], w[a] = r[a] - p[a];
  uu = dot(u, u), ww = dot(w, w);
  cross(u, w, axis);
  nn = dot(axis, axis);
  if (PetscSqrtReal(nn) <= PLACE_TOLERANCE * ww / (PetscReal)m) return 0;
  for (int a = 0; a < 3; a++) {
    const int i = (a + 1) % 3, j = (a + 2) % 3;

    centre[a] = p[a] + (uu * (w[i] * axis[j] - w[j] * axis[i]) + ww * (axis[i] * u[j] - axis[j] * u[i])) / (2 * nn);
  }
  for (int a = 0; a < 3; a++) axis[a] /= PetscSqrtReal(nn);
  return 1 / towards(p, centre, d);
}

/* Whether the given tangents of the ends are those of the shape. */
static PetscBool ends_agree(const AncfBeamSpec *spec, const PetscReal *t0, const PetscReal *t1)
{
  PetscReal e[6], off = 0;

  for (int end = 0; end < 2; end++) {
    const PetscReal *t = end ? t1 : t0;

    if (!t || AncfBeamSpecGetPoint(spec, (PetscReal)end, e)) continue;
    for (int c = 0; c < 3; c++) off = PetscMax(off, PetscAbsReal(t[c] - e[3 + c]));
  }
  return (PetscBool)(off <= PLACE_TOLERANCE);
}

/* A straight line with its points in order, however spaced. */
static PetscBool is_straight(PetscInt m, const PetscReal *x)
{
  PetscReal u[3], d[3], last = -1, s;
  const PetscReal L = towards(x, x + 3 * m, u);

  for (PetscInt k = 0; k <= m; k++) {
    for (int c = 0; c < 3; c++) d[c] = x[3 * k + c] - x[c];
    s = dot(d, u);
    if (s <= last || dot(d, d) - s * s > PetscSqr(PLACE_TOLERANCE * L)) return PETSC_FALSE;
    last = s;
  }
  return PETSC_TRUE;
}

/* Evenly spaced points on an arc of at most half a circle. */
static PetscBool is_arc(PetscInt m, const PetscReal *x, PetscReal kappa, const PetscReal axis[3], const PetscReal centre[3])
{
  PetscReal u[3], first[3], side[3], angle, d2;
  const PetscReal chord = towards(x, x + 3 * m, u);

  for (int c = 0; c < 3; c++) first[c] = x[c] - centre[c];
  cross(axis, first, side);
  angle = 2 * PetscAsinReal(PetscMin(1.0, chord * kappa / 2));
  for (PetscInt k = 0; k <= m; k++) {
    const PetscReal at = angle * (PetscReal)k / (PetscReal)m;

    d2 = 0;
    for (int c = 0; c < 3; c++)
      d2 += PetscSqr(centre[c] + PetscCosReal(at) * first[c] + PetscSinReal(at) * side[c] - x[3 * k + c]);
    if (d2 > PetscSqr(PLACE_TOLERANCE * angle / kappa)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/*
  A line or an arc, if that is what m + 1 points are; t0, t1: tangents that the ends must have, or NULL. n: elements. done:
  whether.
*/
PetscErrorCode AppCurveSimple(PetscInt m, const PetscReal *x, const PetscReal *t0, const PetscReal *t1, PetscInt n,
                              AncfBeamSpec *spec, PetscBool *done)
{
  PetscReal axis[3] = {0}, centre[3] = {0}, kappa;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(spec->start, x, 3));
  PetscCall(PetscArraycpy(spec->end, x + 3 * m, 3));
  spec->elements = n;
  spec->curvature = 0;
  *done = (PetscBool)(is_straight(m, x) && ends_agree(spec, t0, t1));
  if (*done || m == 1) PetscFunctionReturn(PETSC_SUCCESS);
  kappa = circle(m, x, axis, centre);
  if (kappa == 0 || !is_arc(m, x, kappa, axis, centre)) PetscFunctionReturn(PETSC_SUCCESS);
  spec->curvature = kappa;
  PetscCall(PetscArraycpy(spec->normal, axis, 3));
  *done = ends_agree(spec, t0, t1);
  if (!*done) spec->curvature = spec->normal[0] = spec->normal[1] = spec->normal[2] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The axis of the plane of the points and tangents: the sum of the chords' cross products, each turned to the largest one's side.
 */
static void plane(PetscInt m, const PetscReal *x, const PetscReal *t, PetscReal normal[3])
{
  PetscReal largest[3] = {0}, u[3], n[3], size = 0;

  for (int pass = 0; pass < 2; pass++)
    for (PetscInt k = 0; k < m; k++)
      for (int end = 0; end < 2; end++) {
        towards(x + 3 * k, x + 3 * (k + 1), u);
        cross(end ? u : t + 3 * k, end ? t + 3 * (k + 1) : u, n);
        if (!pass && dot(n, n) > size) {
          size = dot(n, n);
          for (int c = 0; c < 3; c++) largest[c] = n[c], normal[c] = 0;
        }
        for (int c = 0; c < 3 && pass; c++) normal[c] += dot(n, largest) < 0 ? -n[c] : n[c];
      }
  size = PetscSqrtReal(dot(normal, normal));
  for (int c = 0; c < 3 && size > 0; c++) normal[c] /= size;
}

/* Hermite's cubic at the fraction xi of a chord's curve of length l. */
static void hermite(const PetscReal *x, const PetscReal *t, PetscReal l, PetscReal xi, PetscReal e[6])
{
  PetscReal S[4], Sx[4], size = 0;

  AncfShape(xi, l, S);
  AncfShapeX(xi, l, Sx);
  for (int c = 0; c < 3; c++) {
    e[c] = S[0] * x[c] + S[1] * t[c] + S[2] * x[3 + c] + S[3] * t[3 + c];
    e[3 + c] = Sx[0] * x[c] + Sx[1] * t[c] + Sx[2] * x[3 + c] + Sx[3] * t[3 + c];
    size += PetscSqr(e[3 + c]);
  }
  for (int c = 0; c < 3; c++) e[3 + c] /= PetscSqrtReal(size);
}

/* Length of the curve over a chord that leaves at t[0..2] and comes in at t[3..5]; exact for circles. */
static PetscReal arc_length(const PetscReal *x, const PetscReal *t)
{
  PetscReal u[3], d2 = 0;
  const PetscReal chord = towards(x, x + 3, u);

  for (int c = 0; c < 3; c++) d2 += PetscSqr(t[3 + c] - t[c]);
  d2 = PetscSqrtReal(d2) / 2; /* sine of half the angle between the tangents */
  return d2 > 1e-4 ? chord * PetscAsinReal(PetscMin(1.0, d2)) / d2 : chord * (1 + d2 * d2 / 6);
}

/*
  Any curve in a plane, through m + 1 points: n elements of equal length on it. curve: (n + 1) x 6, of the spec, to be freed. off:
  how far the points lie off a plane, over the length; the curve is one when this is PLACE_TOLERANCE at most.
*/
PetscErrorCode AppCurveGeneral(PetscInt m, const PetscReal *x, const PetscReal *t0, const PetscReal *t1, PetscInt n,
                               AncfBeamSpec *spec, PetscReal **curve, PetscReal *off)
{
  PetscReal *t, *s;
  PetscInt k = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(3 * (size_t)(m + 1), &t, (size_t)m + 1, &s));
  PetscCall(PetscMalloc1(6 * (size_t)(n + 1), curve));
  tangents(m, x, t0, t1, t);
  plane(m, x, t, spec->normal);
  s[0] = *off = 0;
  for (PetscInt i = 0; i < m; i++) s[i + 1] = s[i] + arc_length(x + 3 * i, t + 3 * i);
  for (PetscInt i = 0; i <= m; i++) {
    PetscReal d[3], out = dot(t + 3 * i, spec->normal);

    for (int c = 0; c < 3; c++) d[c] = x[3 * i + c] - x[c];
    *off = PetscMax(*off, PetscMax(PetscAbsReal(dot(d, spec->normal)) / s[m], PetscAbsReal(out) / (PetscReal)m));
    for (int c = 0; c < 3; c++) t[3 * i + c] -= out * spec->normal[c];
  }
  for (PetscInt j = 0; j <= n; j++) {
    const PetscReal at = s[m] * (PetscReal)j / (PetscReal)n;

    while (k < m - 1 && at > s[k + 1]) k++;
    hermite(x + 3 * k, t + 3 * k, s[k + 1] - s[k], (at - s[k]) / (s[k + 1] - s[k]), *curve + 6 * j);
  }
  spec->curvature = 0;
  spec->elements = n;
  spec->curvelength = s[m];
  spec->curve = *curve;
  PetscCall(PetscArraycpy(spec->start, x, 3));
  PetscCall(PetscArraycpy(spec->end, x + 3 * m, 3));
  PetscCall(PetscFree2(t, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
