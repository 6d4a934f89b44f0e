/*
  ancfrest.c - beams that are not straight and stress-free at first: arcs, pretension.

  With the natural strain eps0 and curvature kappa0 at each Gauss point, U = 1/2 int EA (eps - eps0)^2 + EI |kappa - kappa0 n|^2.
  Against the straight beam's energy this adds -EA eps0 eps + EA eps0^2/2 - EI kappa0 kappa.n + EI kappa0^2/2, linear in strain
  and curvature, made here and added to the forces of ancfelement.c only if a beam needs it. A cable has no frame that turns with
  its sections: the normal n of the plane of the arc is fixed, which is right for motion in that plane and refused for any other.

  kappa.n = h/|r'|^p, h = n.(r' x r''), p = 3 (paper) or 2, so that with s = |r'|^-p and a = r'.r'
    d(kappa.n)/dr' = s (r'' x n) - p s h r'/a,    d(kappa.n)/dr'' = s (n x r').
*/
#include "ancfbatch.h"
#include "ancfpoint.h"
#include "ancfviscous.h"

#define OUT_OF_PLANE 1e-3 /* slope */

typedef struct {
  AncfLanes strain[ANCF_MAX_GAUSS], curvature[ANCF_MAX_GAUSS], normal[3];
} Natural;

static void NaturalAt(const Ancf ancf, const PetscInt node[ANCF_LANES], Natural *n)
{
  const PetscInt na = ancf->rule.axial.n, nb = ancf->rule.bending.n;

  for (int i = 0; i < ANCF_LANES; i++) {
    const PetscReal *x = ancf->natural + (na + nb) * PetscMax(0, node[i]);

    for (PetscInt k = 0; k < na; k++) n->strain[k][i] = x[k];
    for (PetscInt k = 0; k < nb; k++) n->curvature[k][i] = x[na + k];
    for (int c = 0; c < 3; c++) n->normal[c][i] = ancf->normal[3 * PetscMax(0, node[i]) + c];
  }
}

static inline PetscReal Exponent(AncfStrain strain)
{
  return strain == ANCF_STRAIN_PAPER ? 3 : 2;
}

/* eps and deps/dr' */
static inline AncfLanes Strain(AncfStrain strain, const AncfLanes r1[3], AncfLanes f1[3])
{
  const AncfLanes a = Dot(r1, r1), root = LanesSqrt(a);

  for (int c = 0; c < 3; c++) f1[c] = strain == ANCF_STRAIN_PAPER ? r1[c] : r1[c] / root;
  return strain == ANCF_STRAIN_PAPER ? 0.5 * (a - 1.0) : root - 1.0;
}

/* The change of deps/dr' along the unit vector dir. */
static inline void StrainChange(AncfStrain strain, const AncfLanes r1[3], int dir, AncfLanes df1[3])
{
  const AncfLanes a = Dot(r1, r1), i = 1.0 / LanesSqrt(a);

  for (int c = 0; c < 3; c++) {
    df1[c] = strain == ANCF_STRAIN_PAPER ? 0.0 * a : -i * r1[c] * r1[dir] / a;
    if (c == dir) df1[c] += strain == ANCF_STRAIN_PAPER ? 0.0 * a + 1.0 : i;
  }
}

/* kappa.n and its derivatives by r' and r''. */
typedef struct {
  AncfLanes a, s, h, x[3], y[3]; /* x = r'' x n, y = n x r' */
} Bend;

static inline AncfLanes BendAt(PetscReal p, const AncfLanes r1[3], const AncfLanes r2[3], const AncfLanes n[3], Bend *b,
                               AncfLanes f1[3], AncfLanes f2[3])
{
  b->a = Dot(r1, r1);
  b->s = 1.0 / (p > 2.5 ? b->a * LanesSqrt(b->a) : b->a);
  Cross(r2, n, b->x);
  Cross(n, r1, b->y);
  b->h = Dot(r1, b->x);
  for (int c = 0; c < 3; c++) {
    f1[c] = b->s * (b->x[c] - p * b->h / b->a * r1[c]);
    f2[c] = b->s * b->y[c];
  }
  return b->s * b->h;
}

/* Their change along dr' = dr[0], dr'' = dr[1]. */
static inline void BendChange(PetscReal p, const Bend *b, const AncfLanes r1[3], const AncfLanes n[3], AncfLanes dr[2][3],
                              AncfLanes df1[3], AncfLanes df2[3])
{
  const AncfLanes da = 2.0 * Dot(r1, dr[0]), ds = -0.5 * p * b->s * da / b->a, dh = Dot(dr[0], b->x) + Dot(dr[1], b->y);
  AncfLanes dx[3], dy[3];

  Cross(dr[1], n, dx);
  Cross(n, dr[0], dy);
  for (int c = 0; c < 3; c++) {
    const AncfLanes z = b->x[c] - p * b->h / b->a * r1[c];

    df1[c] = ds * z + b->s * (dx[c] - p / b->a * ((dh - b->h * da / b->a) * r1[c] + b->h * dr[0][c]));
    df2[c] = ds * b->y[c] + b->s * dy[c];
  }
}

/* Adds the part of the elements that begin at these nodes to their force and (may be NULL) energy. */
void AncfRestForce(const Ancf ancf, const PetscInt node[ANCF_LANES], const AncfSection *s, const AncfLanes e[12], AncfLanes Q[12],
                   AncfLanes *U)
{
  const AncfRule *rule = &ancf->rule;
  const AncfLanes il = 1.0 / s->l;
  AncfLanes d[3][3], q[3][3], F[12], u = {0};
  Natural n;

  NaturalAt(ancf, node, &n);
  Scaled(e, s->l, d);
  for (int i = 0; i < 3; i++)
    for (int c = 0; c < 3; c++) q[i][c] = (AncfLanes){0};
  for (PetscInt k = 0; k < rule->axial.n; k++) {
    const AncfLanes N = s->EA * n.strain[k];
    AncfLanes r1[3], f1[3], eps;

    Derivative(d, rule->axial.s1[k], il, r1);
    eps = Strain(rule->strain, r1, f1);
    for (int c = 0; c < 3; c++) f1[c] *= -N;
    PointForce(&rule->axial, k, il, f1, NULL, q);
    u += rule->axial.w[k] * s->l * N * (0.5 * n.strain[k] - eps);
  }
  for (PetscInt k = 0; k < rule->bending.n; k++) {
    const AncfLanes M = s->EI * n.curvature[k];
    AncfLanes r1[3], r2[3], f1[3], f2[3], kn;
    Bend b;

    Derivative(d, rule->bending.s1[k], il, r1);
    Derivative(d, rule->bending.s2[k], il * il, r2);
    kn = BendAt(Exponent(rule->strain), r1, r2, n.normal, &b, f1, f2);
    for (int c = 0; c < 3; c++) f1[c] *= -M, f2[c] *= -M;
    PointForce(&rule->bending, k, il, f1, f2, q);
    u += rule->bending.w[k] * s->l * M * (0.5 * n.curvature[k] - kn);
  }
  ForceExpand(q, s->l, F);
  for (int c = 0; c < 12; c++) Q[c] += F[c];
  if (U) *U += u;
}

/* Adds the derivative of that force to the packed tangent. */
void AncfRestTangent(const Ancf ancf, const PetscInt node[ANCF_LANES], const AncfSection *s, const AncfLanes e[12],
                     AncfLanes K[ANCF_TANGENT])
{
  const AncfRule *rule = &ancf->rule;
  const AncfLanes il = 1.0 / s->l, zero = {0};
  AncfLanes d[3][3], H[81], dr[2][3], r1[3], r2[3], f1[3], f2[3];
  Natural n;

  NaturalAt(ancf, node, &n);
  Scaled(e, s->l, d);
  for (int c = 0; c < 81; c++) H[c] = zero;
  for (int c = 0; c < 6; c++) dr[c / 3][c % 3] = zero;
  for (PetscInt k = 0; k < rule->axial.n; k++) {
    Derivative(d, rule->axial.s1[k], il, r1);
    for (int dir = 0; dir < 3; dir++) {
      StrainChange(rule->strain, r1, dir, f1);
      for (int c = 0; c < 3; c++) f1[c] *= -s->EA * n.strain[k];
      PointTangent(&rule->axial, k, il, dir, f1, NULL, H);
    }
  }
  for (PetscInt k = 0; k < rule->bending.n; k++) {
    const AncfLanes M = s->EI * n.curvature[k];
    Bend b;

    Derivative(d, rule->bending.s1[k], il, r1);
    Derivative(d, rule->bending.s2[k], il * il, r2);
    BendAt(Exponent(rule->strain), r1, r2, n.normal, &b, f1, f2);
    for (int dir = 0; dir < 6; dir++) {
      dr[dir / 3][dir % 3] = zero + 1.0;
      BendChange(Exponent(rule->strain), &b, r1, n.normal, dr, f1, f2);
      for (int c = 0; c < 3; c++) f1[c] *= -M, f2[c] *= -M;
      PointTangent(&rule->bending, k, il, dir, f1, f2, H);
      dr[dir / 3][dir % 3] = zero;
    }
  }
  AncfScaledPack(H, s->l, K);
}

/* Length of the axis: of the arc over the chord from start to end, if curved. */
PetscReal AncfSpecLength(const AncfBeamSpec *s)
{
  PetscReal chord = 0;

  if (s->curve) return s->curvelength;
  for (int c = 0; c < 3; c++) chord += PetscSqr(s->end[c] - s->start[c]);
  chord = PetscSqrtReal(chord);
  return s->curvature == 0 ? chord : 2 * PetscAsinReal(s->curvature * chord / 2) / s->curvature;
}

/* The cubic between the nodes of a given curve. */
static void CurvePoint(const AncfBeamSpec *s, PetscReal xi, PetscReal e[6])
{
  const PetscReal at = xi * (PetscReal)s->elements, l = s->curvelength / (PetscReal)s->elements;
  const PetscInt k = PetscMin((PetscInt)at, s->elements - 1);
  PetscReal S[4], Sx[4];

  AncfShape(at - (PetscReal)k, l, S);
  AncfShapeX(at - (PetscReal)k, l, Sx);
  for (int c = 0; c < 6; c++) e[c] = 0;
  for (int i = 0; i < 4; i++)
    for (int c = 0; c < 3; c++) {
      e[c] += S[i] * s->curve[6 * k + 3 * i + c];
      e[3 + c] += Sx[i] * s->curve[6 * k + 3 * i + c];
    }
}

/* Coordinates at the fraction xi of the length: a line, or an arc that turns about the normal by its curvature. */
void AncfSpecPoint(const AncfBeamSpec *s, PetscReal xi, PetscReal e[6])
{
  const PetscReal L = AncfSpecLength(s), k = s->curvature, turn = k * L;
  PetscReal t[3], n[3], side[3], chord = 0, size = 0, along, across, angle = turn * (xi - 0.5);

  if (s->curve) {
    CurvePoint(s, xi, e);
    return;
  }
  for (int c = 0; c < 3; c++) {
    chord += PetscSqr(s->end[c] - s->start[c]);
    size += PetscSqr(s->normal[c]);
  }
  for (int c = 0; c < 3; c++) {
    t[c] = (s->end[c] - s->start[c]) / (k == 0 ? L : PetscSqrtReal(chord));
    e[c] = s->start[c] * (1 - xi) + s->end[c] * xi;
    e[3 + c] = t[c];
  }
  if (k == 0) return;
  for (int c = 0; c < 3; c++) n[c] = s->normal[c] / PetscSqrtReal(size);
  for (int c = 0; c < 3; c++) side[c] = n[(c + 1) % 3] * t[(c + 2) % 3] - n[(c + 2) % 3] * t[(c + 1) % 3];
  along = (PetscSinReal(angle) + PetscSinReal(turn / 2)) / k;
  across = (PetscCosReal(turn / 2) - PetscCosReal(angle)) / k;
  for (int c = 0; c < 3; c++) {
    e[c] = s->start[c] + along * t[c] + across * side[c];
    e[3 + c] = PetscCosReal(angle) * t[c] + PetscSinReal(angle) * side[c];
  }
}

PetscErrorCode AncfBeamSpecGetPoint(const AncfBeamSpec *spec, PetscReal s, PetscReal e[6])
{
  PetscFunctionBegin;
  PetscCheck(s >= 0 && s <= 1, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "AncfBeamSpecGetPoint: s = %g must be in [0, 1]",
             (double)s);
  AncfSpecPoint(spec, s, e);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A given curve: finite, from start to end, in the plane across the normal, with gradients of one and nodes evenly spaced. */
static PetscErrorCode CheckCurve(Ancf ancf, const AncfBeamSpec *s)
{
  const PetscReal *n = s->normal, L = s->curvelength, size = PetscSqrtReal(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);

  PetscFunctionBegin;
  PetscCheck(L > 0 && !PetscIsInfOrNanReal(L), ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Beam %" PetscInt_FMT ": curvelength = %g m must be positive and finite", ancf->nbeams, (double)L);
  PetscCheck(s->curvature == 0 && size > 0 && !PetscIsInfOrNanReal(size), ancf->comm, PETSC_ERR_ARG_INCOMP,
             "Beam %" PetscInt_FMT ": a curve needs a normal, the axis of its plane, and curvature 0; it is %g 1/m", ancf->nbeams,
             (double)s->curvature);
  for (PetscInt k = 0; k <= s->elements; k++) {
    const PetscReal *e = s->curve + 6 * k, *ref = k ? e - 6 : s->start;
    PetscReal off = 0, out = 0, stretch = 0, gap = 0;

    for (int c = 0; c < 3; c++) {
      off += (e[c] - s->start[c]) * n[c] / size;
      out += e[3 + c] * n[c] / size;
      stretch += PetscSqr(e[3 + c]);
      gap += PetscSqr(e[c] - ref[c]);
    }
    gap = PetscSqrtReal(gap) * (PetscReal)s->elements / L;
    PetscCheck(PetscAbsReal(off) <= 1e-5 * L && PetscAbsReal(out) <= 1e-5 && PetscAbsReal(stretch - 1) <= 1e-3 &&
                   (k ? gap > 0.1 && gap < 1.01 : gap < 1e-8),
               ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "Beam %" PetscInt_FMT ": node %" PetscInt_FMT
               " of its curve, (%g, %g, %g) m with gradient (%g, %g, %g), must be finite, in the plane across the normal through "
               "start, with a gradient of length 1, and about %g m along the curve from the node before",
               ancf->nbeams, k, (double)e[0], (double)e[1], (double)e[2], (double)e[3], (double)e[4], (double)e[5],
               (double)(L / (PetscReal)s->elements));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfCheckRest(Ancf ancf, const AncfBeamSpec *s)
{
  PetscReal chord = 0, size = 0, dot = 0;

  PetscFunctionBegin;
  PetscCheck(!PetscIsInfOrNanReal(s->pretension), ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Beam %" PetscInt_FMT ": pretension = %g N must be finite", ancf->nbeams, (double)s->pretension);
  PetscCheck(!PetscIsInfOrNanReal(s->curvature), ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Beam %" PetscInt_FMT ": curvature = %g 1/m must be finite", ancf->nbeams, (double)s->curvature);
  if (s->curve) {
    PetscCall(CheckCurve(ancf, s));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (int c = 0; c < 3; c++) {
    chord += PetscSqr(s->end[c] - s->start[c]);
    size += PetscSqr(s->normal[c]);
    dot += (s->end[c] - s->start[c]) * s->normal[c];
  }
  if (s->curvature == 0 && size == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(PetscAbsReal(s->curvature) * PetscSqrtReal(chord) <= 2, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Beam %" PetscInt_FMT
             ": curvature = %g 1/m must be within +-%g, 2 over the distance of start and end: an arc is at most "
             "half a circle",
             ancf->nbeams, (double)s->curvature, (double)(2 / PetscSqrtReal(chord)));
  PetscCheck(size > 0 && !PetscIsInfOrNanReal(size) && PetscAbsReal(dot) <= 1e-10 * PetscSqrtReal(chord * size), ancf->comm,
             PETSC_ERR_ARG_INCOMP,
             "Beam %" PetscInt_FMT
             ": normal = (%g, %g, %g) must be a vector across the line from start to end, which lies in the plane "
             "of motion",
             ancf->nbeams, (double)s->normal[0], (double)s->normal[1], (double)s->normal[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Strain and curvature of element `node` at xi without stress. */
void AncfRestSection(const Ancf ancf, const AncfBeam *m, PetscInt node, PetscReal xi, PetscReal *eps, PetscReal kappa[3])
{
  PetscReal r[3];

  *eps = kappa[0] = kappa[1] = kappa[2] = 0;
  if (!ancf->natural) return;
  AncfMeasure(ancf->strain, m->l, xi, ancf->shape + 6 * node, r, eps, kappa);
  *eps -= m->spec.pretension / m->EA;
}

static PetscErrorCode SetUpNormals(Ancf ancf)
{
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(3 * (size_t)ancf->nnodes, &ancf->normal));
  for (PetscInt b = 0; b < ancf->nbeams; b++) {
    const AncfBeam *m = &ancf->beams[b];
    const PetscReal *n = m->spec.normal, size = PetscSqrtReal(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);

    for (PetscInt j = m->node; j <= m->node + m->spec.elements && size > 0; j++)
      for (int c = 0; c < 3; c++) ancf->normal[3 * j + c] = n[c] / size;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The shape in e is the natural one, so that the beams stay at rest in it to round-off. */
PetscErrorCode AncfSetUpRest(Ancf ancf)
{
  const PetscInt na = ancf->rule.axial.n, nb = ancf->rule.bending.n;
  PetscBool natural = PETSC_FALSE, planar = PETSC_FALSE;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < ancf->nbeams; b++) {
    const AncfBeamSpec *s = &ancf->beams[b].spec;

    if (s->pretension != 0 || s->curvature != 0 || s->curve) natural = PETSC_TRUE;
    if (s->normal[0] != 0 || s->normal[1] != 0 || s->normal[2] != 0) planar = PETSC_TRUE;
  }
  if (natural || planar) PetscCall(SetUpNormals(ancf));
  if (!natural) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2((size_t)(na + nb) * (size_t)ancf->nnodes, &ancf->natural, 6 * (size_t)ancf->nnodes, &ancf->shape));
  PetscCall(PetscArraycpy(ancf->shape, ancf->e, 6 * ancf->nnodes));
  for (PetscInt b = 0; b < ancf->nbeams; b++) {
    const AncfBeam *m = &ancf->beams[b];

    for (PetscInt j = m->node; j < m->node + m->spec.elements; j++) {
      PetscReal none, kappa[3], *x = ancf->natural + (na + nb) * j, *n = ancf->normal + 3 * j;

      for (PetscInt k = 0; k < na; k++) AncfRestSection(ancf, m, j, ancf->rule.axial.xi[k], &x[k], kappa);
      for (PetscInt k = 0; k < nb; k++) {
        AncfRestSection(ancf, m, j, ancf->rule.bending.xi[k], &none, kappa);
        x[na + k] = kappa[0] * n[0] + kappa[1] * n[1] + kappa[2] * n[2];
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A beam that leaves its plane has no frame to say where its curvature, or the smaller of two stiffnesses, goes. */
PetscErrorCode AncfCheckPlane(Ancf ancf, const PetscReal *e, PetscReal t)
{
  PetscFunctionBegin;
  for (PetscInt j = 0; j < ancf->nnodes && ancf->normal; j++) {
    const PetscReal *n = ancf->normal + 3 * j, *r = e + 6 * j + 3;
    const PetscReal slope = PetscAbsReal(n[0] * r[0] + n[1] * r[1] + n[2] * r[2]);
    PetscInt b;

    if (PetscLikely(slope <= OUT_OF_PLANE)) continue;
    b = AncfFindBeam(ancf, j);
    SETERRQ(ancf->comm, PETSC_ERR_SUP,
            "Beam %" PetscInt_FMT " leaves its plane, that across its normal (slope %g at node %" PetscInt_FMT
            ", allowed %g) at t = %g s: without twist, a curved or flat beam moves in that plane only",
            ancf->firstbeam + b, (double)slope, j - ancf->beams[b].node, OUT_OF_PLANE, (double)t);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
