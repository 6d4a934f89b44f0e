/* sphopenbox.c - the box that an opening's buffer zone is: its frame, its lattice, what lies in it, overlaps of two. */
#include "sphimpl.h"
#include "sphopenimpl.h"
#include <math.h>

static double Dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void Cross(const double a[3], const double b[3], double c[3])
{
  for (int k = 0; k < 3; k++) c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* Unit vector, length and sites of edge e; a whole number of dp. */
static PetscErrorCode Edge(Sph sph, SphOpening *o, int e, const PetscReal edge[3])
{
  const PetscReal dp = sph->par.dp;
  double length = 0.0;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < sph->par.dim; k++) length += edge[k] * edge[k];
  length = sqrt(length);
  PetscCheck(length > 0.5 * dp && length < 1e6 * dp, sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "opening '%s': edge%d is %g m long; must be at least sph_dp = %g m and at most 10^6 of them", o->spec.name, e + 1,
             length, (double)dp);
  o->length[e] = length;
  o->sites[e] = (PetscInt)floor(length / dp + 0.5);
  PetscCheck(fabs(length / dp - (double)o->sites[e]) < 1e-3, sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "opening '%s': edge%d is %g m long, which is not a whole number of sph_dp = %g m", o->spec.name, e + 1, length,
             (double)dp);
  for (PetscInt k = 0; k < 3; k++) o->tangent[e][k] = k < sph->par.dim ? edge[k] / length : 0.0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphOpeningFrame(Sph sph, const SphOpeningSpec *spec, SphOpening *o)
{
  const PetscReal dp = sph->par.dp;
  PetscReal support;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(o, sizeof(*o)));
  o->spec = *spec;
  PetscCheck(dp > 0.0, sph->comm, PETSC_ERR_ORDER, "opening '%s': SphSetSpacing() must come before it", spec->name);
  PetscCall(SphGetSupport(sph, &support));
  o->depth = ceil(support / dp * (1.0 - 1e-9)) * dp;
  PetscCall(Edge(sph, o, 0, spec->edge1));
  o->sites[1] = 1;
  o->volume = o->length[0] / (double)o->sites[0] * dp;
  if (sph->par.dim == 2) {
    o->normal[0] = o->tangent[0][1];
    o->normal[1] = -o->tangent[0][0];
    o->tangent[1][2] = 1.0;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(Edge(sph, o, 1, spec->edge2));
  PetscCheck(fabs(Dot(o->tangent[0], o->tangent[1])) < 1e-9, sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "opening '%s': edge1 and edge2 must be at right angles", spec->name);
  o->volume *= o->length[1] / (double)o->sites[1];
  Cross(o->tangent[0], o->tangent[1], o->normal);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphOpeningSites(Sph sph, const SphOpeningSpec *spec, PetscInt *n, PetscReal **xout)
{
  const PetscReal dp = sph->par.dp;
  PetscInt layers, m = 0;
  PetscReal *x;
  SphOpening o;

  PetscFunctionBegin;
  PetscCall(SphOpeningFrame(sph, spec, &o));
  layers = (PetscInt)floor(o.depth / dp + 0.5);
  PetscCall(PetscMalloc1(3 * (size_t)layers * (size_t)o.sites[0] * (size_t)o.sites[1], &x));
  for (PetscInt l = 0; l < layers; l++)
    for (PetscInt j = 0; j < o.sites[1]; j++)
      for (PetscInt i = 0; i < o.sites[0]; i++, m++)
        for (PetscInt k = 0; k < 3; k++) {
          const double a = ((double)i + 0.5) / (double)o.sites[0] * o.length[0],
                       b = sph->par.dim == 3 ? ((double)j + 0.5) / (double)o.sites[1] * o.length[1] : 0.0;
          x[3 * m + k] = k < sph->par.dim ? spec->corner[k] + a * o.tangent[0][k] + b * o.tangent[1][k] -
                                                ((PetscReal)l + 0.5) * dp * o.normal[k]
                                          : 0.0;
        }
  *n = m;
  *xout = x;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SphOpeningCoordinates(const SphOpening *o, const double x[3], double c[3])
{
  const double d[3] = {x[0] - o->spec.corner[0], x[1] - o->spec.corner[1], x[2] - o->spec.corner[2]};

  c[0] = Dot(d, o->tangent[0]);
  c[1] = Dot(d, o->tangent[1]);
  c[2] = Dot(d, o->normal);
}

int SphOpeningHolds(const SphOpening *o, const double c[3], double margin)
{
  for (int e = 0; e < 2; e++)
    if (o->length[e] > 0.0 && !o->spec.across[e] && (c[e] < margin || c[e] > o->length[e] - margin)) return 0;
  return c[2] < -margin && c[2] > -o->depth + margin;
}

/* Extent of the zone along an axis. */
static void Project(const SphOpening *o, const double axis[3], double *lo, double *hi)
{
  const double at = Dot(o->spec.corner, axis),
               way[3] = {o->length[0] * Dot(o->tangent[0], axis), o->length[1] * Dot(o->tangent[1], axis),
                         -o->depth * Dot(o->normal, axis)};
  *lo = *hi = at;
  for (int k = 0; k < 3; k++) {
    *lo += PetscMin(way[k], 0.0);
    *hi += PetscMax(way[k], 0.0);
  }
}

/* Two boxes are apart when they are so along a normal of a face or the normal of two edges (separating axis theorem). */
int SphOpeningsOverlap(const SphOpening *a, const SphOpening *b, double margin)
{
  const double *A[3] = {a->tangent[0], a->tangent[1], a->normal}, *B[3] = {b->tangent[0], b->tangent[1], b->normal};

  for (int i = 0; i < 15; i++) {
    double axis[3], size, alo, ahi, blo, bhi;
    if (i < 6)
      for (int k = 0; k < 3; k++) axis[k] = (i < 3 ? A[i] : B[i - 3])[k];
    else
      Cross(A[(i - 6) / 3], B[(i - 6) % 3], axis);
    size = sqrt(Dot(axis, axis));
    if (size < 1e-6) continue;
    if (a->length[1] == 0.0 && fabs(axis[2]) > 0.5 * size) continue; /* 2D: no extent out of the plane */
    Project(a, axis, &alo, &ahi);
    Project(b, axis, &blo, &bhi);
    if (PetscMin(ahi, bhi) - PetscMax(alo, blo) < margin * size) return 0;
  }
  return 1;
}
