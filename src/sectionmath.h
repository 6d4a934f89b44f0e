/*
  sectionmath.h - private: motion of BCE markers on rigid sections, and the transposed transfer of their forces. The coupling and
  both backends of the fluid use these.

  A section is a point r with a frame e1, e2, e3 that turns with w. A rigid body is one section. A section of a structure with
  nodes q_j lies at r = sum S_j q_j; with slopes its e3 is the tangent t = r_s/|r_s|, r_s = sum S'_j q_j, and it turns with w = t
  x r_s'/|r_s|: the turning of the tangent without spin about it, which the nodes have no coordinate for. A marker at offset o
  moves with r' + w x o. A force F on it does the virtual work F . dr + (o x F) . (t x dr_s)/|r_s|, hence Q_j = S_j F + S'_j ((o x
  F) x t)/|r_s|. The axial part of o x F does no work on any node. Source: Pazouki, Serban, Negrut, Eq. 23 and Sect. 2.4.
*/
#ifndef SECTIONMATH_H
#define SECTIONMATH_H

#include <math.h>

#if defined(__CUDACC__)
  #define SECTION_FN static __host__ __device__ inline
#else
  #define SECTION_FN static inline
#endif

typedef struct {
  double r[3], v[3], a[3];   /* point, its velocity and acceleration: m, m/s, m/s^2 */
  double w[3], alpha[3];     /* 1/s, 1/s^2 */
  double e1[3], e2[3], t[3]; /* frame; 0 for a section without slopes */
  double len;                /* |r_s|, or 0 */
} FrondSection;

/* State of a rigid body: r, v, a, w, alpha, and the rotation matrix by rows. */
#define SECTION_BODY_STATE 24

/* Sums over markers: force, moment about the section's point, moment about the origin, power. */
#define SECTION_SUMS 10

/* Totals over the sections of a structure: force, moment about the origin, power, twist, twist as a vector. */
#define SECTION_TOTALS 11

SECTION_FN void section_cross(const double a[3], const double b[3], double c[3])
{
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

SECTION_FN double section_dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* r = sum of n weights times node vectors. */
SECTION_FN void section_interpolate(int n, const int *node, const double *weight, const double *q, double r[3])
{
  r[0] = r[1] = r[2] = 0.0;
  for (int e = 0; e < n; e++)
    for (int k = 0; k < 3; k++) r[k] += weight[e] * q[3 * (long long)node[e] + k];
}

/* Transport of the unit normal d1 to tangent t: remove its component along t. In 2D it is the in-plane normal. */
SECTION_FN void section_transport(int dim, const double t[3], double d1[3])
{
  if (dim == 2) {
    d1[0] = -t[1];
    d1[1] = t[0];
    d1[2] = 0.0;
    return;
  }
  const double c = section_dot(d1, t);
  for (int k = 0; k < 3; k++) d1[k] -= c * t[k];
  const double n = sqrt(section_dot(d1, d1));
  for (int k = 0; k < 3; k++) d1[k] /= n;
}

/* Turning of a section from r_s and its rates. */
SECTION_FN void section_turn(const double rs[3], const double rsd[3], const double rsdd[3], FrondSection *s)
{
  double td[3], c1[3], c2[3];

  s->len = sqrt(section_dot(rs, rs));
  for (int k = 0; k < 3; k++) s->t[k] = rs[k] / s->len;
  section_cross(s->t, rsd, s->w);
  const double tr = section_dot(s->t, rsd) / s->len;
  for (int k = 0; k < 3; k++) {
    s->w[k] /= s->len;
    td[k] = rsd[k] / s->len - s->t[k] * tr;
  }
  section_cross(td, rsd, c1);
  section_cross(s->t, rsdd, c2);
  for (int k = 0; k < 3; k++) s->alpha[k] = (c1[k] + c2[k]) / s->len - s->w[k] * tr;
}

/*
  Section of a structure with nodes q, their velocities v and accelerations a, from its n entries. slope: NULL without slopes.
  normal: a normal of the section some time ago; transported here into e1.
*/
SECTION_FN void section_from_nodes(int dim, int n, const int *node, const double *shape, const double *slope, const double *q,
                                   const double *v, const double *a, const double *normal, FrondSection *s)
{
  double rs[3], rsd[3], rsdd[3];

  section_interpolate(n, node, shape, q, s->r);
  section_interpolate(n, node, shape, v, s->v);
  section_interpolate(n, node, shape, a, s->a);
  s->len = 0.0;
  for (int k = 0; k < 3; k++) s->w[k] = s->alpha[k] = s->e1[k] = s->e2[k] = s->t[k] = 0.0;
  if (!slope) return;
  section_interpolate(n, node, slope, q, rs);
  section_interpolate(n, node, slope, v, rsd);
  section_interpolate(n, node, slope, a, rsdd);
  section_turn(rs, rsd, rsdd, s);
  for (int k = 0; k < 3; k++) s->e1[k] = normal[k];
  section_transport(dim, s->t, s->e1);
  section_cross(s->t, s->e1, s->e2);
}

/* Section of a rigid body. */
SECTION_FN void section_from_body(const double *state, FrondSection *s)
{
  for (int k = 0; k < 3; k++) {
    s->r[k] = state[k];
    s->v[k] = state[3 + k];
    s->a[k] = state[6 + k];
    s->w[k] = state[9 + k];
    s->alpha[k] = state[12 + k];
    s->e1[k] = state[15 + 3 * k];
    s->e2[k] = state[16 + 3 * k];
    s->t[k] = state[17 + 3 * k];
  }
  s->len = 0.0;
}

/* Offset o of a marker with the components c in the frame. */
SECTION_FN void section_offset(const FrondSection *s, const double c[3], double o[3])
{
  for (int k = 0; k < 3; k++) o[k] = c[0] * s->e1[k] + c[1] * s->e2[k] + c[2] * s->t[k];
}

/* A marker at offset o: position, velocity, acceleration. */
SECTION_FN void section_marker(const FrondSection *s, const double o[3], double x[3], double v[3], double a[3])
{
  double wo[3], wwo[3], ao[3];

  section_cross(s->w, o, wo);
  section_cross(s->w, wo, wwo);
  section_cross(s->alpha, o, ao);
  for (int k = 0; k < 3; k++) {
    x[k] = s->r[k] + o[k];
    v[k] = s->v[k] + wo[k];
    a[k] = s->a[k] + ao[k] + wwo[k];
  }
}

/* The force f on a marker at offset o, added to the sums about the section's point. */
SECTION_FN void section_add_force(const double o[3], const double f[3], double *sums)
{
  double m[3];

  section_cross(o, f, m);
  for (int k = 0; k < 3; k++) {
    sums[k] += f[k];
    sums[3 + k] += m[k];
  }
}

/* The force f on a marker that is at x and moves with v, added to the other sums. */
SECTION_FN void section_add_moment_power(const double x[3], const double v[3], const double f[3], double *sums)
{
  double m[3];

  section_cross(x, f, m);
  for (int k = 0; k < 3; k++) sums[6 + k] += m[k];
  sums[9] += section_dot(f, v);
}

/* Force F and moment M about the section's point, added to Q of a node with the weights shape and slope. */
SECTION_FN void section_add_node(const FrondSection *s, double shape, double slope, const double F[3], const double M[3],
                                 double Q[3])
{
  double g[3] = {0.0, 0.0, 0.0};

  if (s->len > 0.0) section_cross(M, s->t, g);
  for (int k = 0; k < 3; k++) {
    Q[k] += shape * F[k];
    if (s->len > 0.0) Q[k] += slope * g[k] / s->len;
  }
}

/* Sums of a section, added to the totals of its structure. */
SECTION_FN void section_add_totals(const FrondSection *s, const double *sums, double *totals)
{
  for (int k = 0; k < 3; k++) {
    totals[k] += sums[k];
    totals[3 + k] += sums[6 + k];
  }
  totals[6] += sums[9];
  if (!(s->len > 0.0)) return;
  const double twist = section_dot(sums + 3, s->t);
  totals[7] += twist;
  for (int k = 0; k < 3; k++) totals[8 + k] += twist * s->t[k];
}

#endif
