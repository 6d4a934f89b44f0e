/*
  couplebeam.c - adapter of an ANCF beam: disks of BCE markers along the axis (Sect. 2.4, Fig. 2b), S^T projection of their forces
  (Eq. 23).

  A disk at arc coordinate s is rigid and normal to the tangent t = r_x/|r_x|. A marker at offset o from the axis moves with
  r' + w x o, w = t x r_x'/|r_x|: the turning of the tangent without spin about it, which a gradient-deficient element has no
  coordinate for. A force F on it does the virtual work F . dr + (o x F) . (t x dr_x)/|r_x|, hence the generalised force
  Q = S^T F + S_x^T ((o x F) x t)/|r_x|. The axial part of the torque o x F does no work on any coordinate of the beam; the audit
  reports it as twist.
*/
#include "coupleimpl.h"

typedef struct {
  Ancf ancf;
  PetscInt beam, dim, node0, elements;
  PetscReal l, rhoA; /* element length, m; mass per length, kg/m */
  PetscInt ndisk, n;
  PetscInt *element;      /* per disk */
  PetscReal *xi;          /* per disk, in [0,1] */
  PetscReal *d1;          /* per disk: transported unit normal at the beam's own time, 3 */
  PetscInt *disk;         /* per marker */
  PetscReal *off1, *off2; /* per marker: coordinates along d1 and t x d1, m */
  PetscReal *x0, *volume, *depth;
  /* of the last kinematics call */
  PetscReal *r, *t, *len, *o, *v; /* per disk: axis point, tangent (3), |r_x|; per marker: offset, velocity (3) */
  PetscReal *e, *ed;              /* nodal coordinates and velocities of this beam, (elements + 1) x 6 */
  PetscReal reaction[2][3];       /* of all supports at the ends of the last step, N; beam 0 only */
} Beam;

/* State of this beam's nodes extrapolated by dt: e, e', and (shared) e''. */
static PetscErrorCode Extrapolate(Beam *b, PetscReal dt, const PetscReal **edd)
{
  const PetscReal *e, *v, *a;
  const PetscInt m = 6 * (b->elements + 1), o = 6 * b->node0;

  PetscFunctionBegin;
  PetscCall(AncfGetState(b->ancf, NULL, &e, &v, &a));
  for (PetscInt i = 0; i < m; i++) {
    b->e[i] = e[o + i] + dt * (v[o + i] + 0.5 * dt * a[o + i]);
    b->ed[i] = v[o + i] + dt * a[o + i];
  }
  *edd = a + o;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* sum_j S_j e_j over the four vector coordinates of an element (Eq. 18). */
static void Interpolate(const PetscReal S[4], const PetscReal *e12, PetscReal r[3])
{
  for (int k = 0; k < 3; k++) r[k] = S[0] * e12[k] + S[1] * e12[3 + k] + S[2] * e12[6 + k] + S[3] * e12[9 + k];
}

/* Transport of the normal d1 to tangent t: remove its component along t. In 2D it is the in-plane normal. */
static void Transport(const Beam *b, const PetscReal t[3], PetscReal d1[3])
{
  if (b->dim == 2) {
    d1[0] = -t[1];
    d1[1] = t[0];
    d1[2] = 0.0;
    return;
  }
  const PetscReal c = CoupleDot(d1, t);
  PetscReal n;
  for (int k = 0; k < 3; k++) d1[k] -= c * t[k];
  n = PetscSqrtReal(CoupleDot(d1, d1));
  for (int k = 0; k < 3; k++) d1[k] /= n;
}

/* Axis motion of disk d: point, tangent, w and dw/dt, velocity and acceleration of the axis point. */
static void DiskMotion(Beam *b, PetscInt d, const PetscReal *edd, PetscReal w[3], PetscReal alpha[3], PetscReal rd[3],
                       PetscReal rdd[3])
{
  const PetscInt at = 6 * b->element[d];
  PetscReal S[4], Sx[4], rx[3], rxd[3], rxdd[3], *t = b->t + 3 * d, td[3], c1[3], c2[3], tr;

  AncfShape(b->xi[d], b->l, S);
  AncfShapeX(b->xi[d], b->l, Sx);
  Interpolate(S, b->e + at, b->r + 3 * d);
  Interpolate(S, b->ed + at, rd);
  Interpolate(S, edd + at, rdd);
  Interpolate(Sx, b->e + at, rx);
  Interpolate(Sx, b->ed + at, rxd);
  Interpolate(Sx, edd + at, rxdd);
  b->len[d] = PetscSqrtReal(CoupleDot(rx, rx));
  for (int k = 0; k < 3; k++) t[k] = rx[k] / b->len[d];
  CoupleCross(t, rxd, w);
  tr = CoupleDot(t, rxd) / b->len[d];
  for (int k = 0; k < 3; k++) {
    w[k] /= b->len[d];
    td[k] = rxd[k] / b->len[d] - t[k] * tr;
  }
  CoupleCross(td, rxd, c1);
  CoupleCross(t, rxdd, c2);
  for (int k = 0; k < 3; k++) alpha[k] = (c1[k] + c2[k]) / b->len[d] - w[k] * tr;
}

static PetscErrorCode Kinematics_Beam(CoupleSurface s, PetscReal dt, PetscReal *x, PetscReal *v, PetscReal *a)
{
  Beam *b = (Beam *)s->ctx;
  const PetscReal *edd;
  PetscInt i = 0;

  PetscFunctionBegin;
  PetscCall(Extrapolate(b, dt, &edd));
  for (PetscInt d = 0; d < b->ndisk; d++) {
    PetscReal w[3], alpha[3], rd[3], rdd[3], d1[3], d2[3];
    DiskMotion(b, d, edd, w, alpha, rd, rdd);
    for (int k = 0; k < 3; k++) d1[k] = b->d1[3 * d + k];
    Transport(b, b->t + 3 * d, d1);
    CoupleCross(b->t + 3 * d, d1, d2);
    for (; i < b->n && b->disk[i] == d; i++) {
      PetscReal *o = b->o + 3 * i, wo[3], wwo[3], ao[3];
      for (int k = 0; k < 3; k++) o[k] = b->off1[i] * d1[k] + b->off2[i] * d2[k];
      CoupleCross(w, o, wo);
      CoupleCross(w, wo, wwo);
      CoupleCross(alpha, o, ao);
      for (int k = 0; k < 3; k++) {
        x[3 * i + k] = b->r[3 * d + k] + o[k];
        v[3 * i + k] = b->v[3 * i + k] = rd[k] + wo[k];
        a[3 * i + k] = rdd[k] + ao[k] + wwo[k];
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetMarkers_Beam(CoupleSurface s, PetscInt *n, const PetscReal **x, const PetscReal **volume,
                                      const PetscReal **depth)
{
  const Beam *b = (const Beam *)s->ctx;

  PetscFunctionBegin;
  *n = b->n;
  *x = b->x0;
  *volume = b->volume;
  *depth = b->depth;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ZeroLoads_Beam(CoupleSurface s)
{
  Beam *b = (Beam *)s->ctx;
  PetscReal *Q;

  PetscFunctionBegin;
  PetscCall(AncfGetLoads(b->ancf, &Q));
  PetscCall(PetscArrayzero(Q + 6 * b->node0, 6 * (b->elements + 1)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Force and moment-like vector of each disk onto the 12 coordinates of its element, Eq. 23 and its off-axis part. */
static void Project(const Beam *b, PetscInt d, const PetscReal F[3], const PetscReal M[3], PetscReal *Q)
{
  PetscReal S[4], Sx[4], g[3], *q = Q + 6 * (b->node0 + b->element[d]);

  AncfShape(b->xi[d], b->l, S);
  AncfShapeX(b->xi[d], b->l, Sx);
  CoupleCross(M, b->t + 3 * d, g);
  for (int j = 0; j < 4; j++)
    for (int k = 0; k < 3; k++) q[3 * j + k] += S[j] * F[k] + Sx[j] * g[k] / b->len[d];
}

/* What the generalised forces amount to: force, moment about the origin, power; subtracted from the marker totals. */
static void AuditBeam(const Beam *b, const PetscReal *Q, const PetscReal axial[3], CoupleAudit *audit)
{
  PetscReal F[3] = {0, 0, 0}, M[3] = {axial[0], axial[1], axial[2]}, power = 0.0;

  for (PetscInt j = 0; j <= b->elements; j++) {
    const PetscReal *q = Q + 6 * (b->node0 + j), *e = b->e + 6 * j, *v = b->ed + 6 * j;
    PetscReal c1[3], c2[3];
    CoupleCross(e, q, c1);
    CoupleCross(e + 3, q + 3, c2);
    for (int k = 0; k < 3; k++) {
      F[k] += q[k];
      M[k] += c1[k] + c2[k];
    }
    for (int k = 0; k < 6; k++) power += q[k] * v[k];
  }
  for (int k = 0; k < 3; k++) {
    audit->force_lost[k] = audit->force[k] - F[k];
    audit->moment_lost[k] = audit->moment[k] - M[k];
  }
  audit->power_lost = audit->power - power;
}

static PetscErrorCode ApplyForces_Beam(CoupleSurface s, const PetscReal *f, CoupleAudit *audit)
{
  Beam *b = (Beam *)s->ctx;
  PetscReal *Q, axial[3] = {0, 0, 0};
  PetscInt i = 0;

  PetscFunctionBegin;
  PetscCall(AncfGetLoads(b->ancf, &Q));
  for (PetscInt d = 0; d < b->ndisk; d++) {
    PetscReal F[3] = {0, 0, 0}, M[3] = {0, 0, 0}, twist;
    for (; i < b->n && b->disk[i] == d; i++) {
      PetscReal c[3];
      CoupleCross(b->o + 3 * i, f + 3 * i, c);
      for (int k = 0; k < 3; k++) {
        F[k] += f[3 * i + k];
        M[k] += c[k];
      }
    }
    Project(b, d, F, M, Q);
    twist = CoupleDot(M, b->t + 3 * d);
    audit->twist += twist;
    for (int k = 0; k < 3; k++) axial[k] += twist * b->t[3 * d + k];
  }
  AuditBeam(b, Q, axial, audit);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Advance_Beam(CoupleSurface s, PetscReal t)
{
  Beam *b = (Beam *)s->ctx;
  const PetscReal *edd;
  PetscReal now, w[3], alpha[3], rd[3], rdd[3];

  PetscFunctionBegin;
  PetscCall(AncfGetState(b->ancf, &now, NULL, NULL, NULL));
  if (now < t) PetscCall(AncfAdvance(b->ancf, t));
  if (b->beam == 0) {
    PetscCall(PetscArraycpy(b->reaction[0], b->reaction[1], 3));
    PetscCall(AncfGetReaction(b->ancf, b->reaction[1]));
  }
  PetscCall(Extrapolate(b, 0.0, &edd));
  for (PetscInt d = 0; d < b->ndisk; d++) {
    DiskMotion(b, d, edd, w, alpha, rd, rdd);
    Transport(b, b->t + 3 * d, b->d1 + 3 * d);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Momentum of this beam: the integral of rhoA S e'. Weight and supports are known for all beams together; beam 0 answers for
 * them. */
static PetscErrorCode Momentum_Beam(CoupleSurface s, PetscReal p[3], PetscReal weight[3], PetscReal support[3])
{
  const Beam *b = (const Beam *)s->ctx;
  const PetscReal *v, m = b->rhoA * b->l;

  PetscFunctionBegin;
  PetscCall(AncfGetState(b->ancf, NULL, NULL, &v, NULL));
  v += 6 * b->node0;
  for (int k = 0; k < 3; k++) p[k] = weight[k] = support[k] = 0.0;
  for (PetscInt j = 0; j < b->elements; j++, v += 6)
    for (int k = 0; k < 3; k++) p[k] += m * (0.5 * (v[k] + v[6 + k]) + b->l / 12.0 * (v[3 + k] - v[9 + k]));
  if (b->beam == 0) {
    PetscCall(AncfGetWeight(b->ancf, weight));
    for (int k = 0; k < 3; k++) support[k] = 0.5 * (b->reaction[0][k] + b->reaction[1][k]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode View_Beam(CoupleSurface s, PetscViewer viewer)
{
  const Beam *b = (const Beam *)s->ctx;

  PetscFunctionBegin;
  PetscCall(
      PetscViewerASCIIPrintf(viewer, "  beam %s: %" PetscInt_FMT " disks, %" PetscInt_FMT " markers\n", s->name, b->ndisk, b->n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy_Beam(CoupleSurface s)
{
  Beam *b = (Beam *)s->ctx;

  PetscFunctionBegin;
  PetscCall(PetscFree3(b->element, b->xi, b->d1));
  PetscCall(PetscFree7(b->disk, b->off1, b->off2, b->x0, b->volume, b->depth, b->o));
  PetscCall(PetscFree6(b->r, b->t, b->len, b->v, b->e, b->ed));
  PetscCall(PetscFree(s->ctx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  PetscInt n;
  PetscReal o1[512], o2[512], area[512], depth[512], turn[512]; /* turn: half the angle between markers of the ring */
} Section;

static void SectionAdd(Section *c, PetscReal o1, PetscReal o2, PetscReal area, PetscReal depth, PetscReal turn)
{
  if (c->n == 512) return;
  c->turn[c->n] = turn;
  c->o1[c->n] = o1;
  c->o2[c->n] = o2;
  c->area[c->n] = area;
  c->depth[c->n++] = depth;
}

/*
  Markers of one disk of radius R: rings in layers dp thick from the surface inwards, evenly spaced about dp apart, and one in the
  middle of a core of radius up to 3dp/4. Areas add up to the marked area. In 2D: a line across the thickness 2R, layers from both
  sides.
*/
static void SectionFill(PetscInt dim, PetscReal R, PetscReal dp, PetscReal depthmax, Section *c)
{
  PetscReal out = R;

  c->n = 0;
  for (; out > 1e-6 * dp && R - out < depthmax; out -= dp) {
    const PetscBool core = out <= 0.75 * dp ? PETSC_TRUE : PETSC_FALSE;
    const PetscReal in = core ? 0.0 : PetscMax(out - dp, 0.0), r = core ? 0.0 : 0.5 * (out + in);
    const PetscReal area = dim == 2 ? 2.0 * (out - in) : PETSC_PI * (out * out - in * in);
    const PetscInt n = core ? 1 : (dim == 2 ? 2 : PetscMax(3, (PetscInt)(2.0 * PETSC_PI * r / dp + 0.5)));
    for (PetscInt i = 0; i < n; i++) {
      const PetscReal a = 2.0 * PETSC_PI * (PetscReal)i / (PetscReal)n;
      SectionAdd(c, r * PetscCosReal(a), dim == 2 ? 0.0 : r * PetscSinReal(a), area / (PetscReal)n, R - r,
                 dim == 3 ? PETSC_PI / (PetscReal)n : 0.0);
    }
  }
}

/* A unit vector normal to t, along the coordinate axis least aligned with it. */
static void AnyNormal(const PetscReal t[3], PetscReal d1[3])
{
  int m = 0;
  for (int k = 1; k < 3; k++)
    if (PetscAbsReal(t[k]) < PetscAbsReal(t[m])) m = k;
  for (int k = 0; k < 3; k++) d1[k] = (k == m ? 1.0 : 0.0) - t[m] * t[k];
  const PetscReal n = PetscSqrtReal(CoupleDot(d1, d1));
  for (int k = 0; k < 3; k++) d1[k] /= n;
}

static PetscErrorCode Allocate(Beam *b, PetscInt persection)
{
  const PetscInt nd = b->ndisk, n = nd * persection, m = 6 * (b->elements + 1);

  PetscFunctionBegin;
  b->n = n;
  PetscCall(PetscMalloc3(nd, &b->element, nd, &b->xi, 3 * nd, &b->d1));
  PetscCall(PetscMalloc7(n, &b->disk, n, &b->off1, n, &b->off2, 3 * n, &b->x0, n, &b->volume, n, &b->depth, 3 * n, &b->o));
  PetscCall(PetscMalloc6(3 * nd, &b->r, 3 * nd, &b->t, nd, &b->len, 3 * n, &b->v, m, &b->e, m, &b->ed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Disks at (k + 1/2) L/ndisk; every other one turned by half a marker, so that the markers of neighbours interleave. */
static PetscErrorCode Place(Beam *b, const AncfBeamSpec *spec, const Section *c)
{
  const PetscReal L = b->l * (PetscReal)b->elements, ds = L / (PetscReal)b->ndisk;
  const PetscReal *e;
  PetscReal w[3], alpha[3], rd[3], rdd[3];
  PetscInt i = 0;

  PetscFunctionBegin;
  PetscCall(AncfGetState(b->ancf, NULL, &e, NULL, NULL));
  for (PetscInt d = 0; d < b->ndisk; d++) {
    const PetscReal s = ((PetscReal)d + 0.5) * ds,
                    ends = PetscMin(spec->end0 == ANCF_END_FREE ? s : L, spec->end1 == ANCF_END_FREE ? L - s : L);
    b->element[d] = PetscMin((PetscInt)(s / b->l), b->elements - 1);
    b->xi[d] = s / b->l - (PetscReal)b->element[d];
    for (PetscInt j = 0; j < c->n; j++, i++) {
      const PetscReal turn = d % 2 ? c->turn[j] : 0.0;
      b->disk[i] = d;
      b->off1[i] = c->o1[j] * PetscCosReal(turn) - c->o2[j] * PetscSinReal(turn);
      b->off2[i] = c->o1[j] * PetscSinReal(turn) + c->o2[j] * PetscCosReal(turn);
      b->volume[i] = c->area[j] * ds;
      b->depth[i] = PetscMin(c->depth[j], ends);
    }
  }
  if (b->beam == 0) PetscCall(AncfGetReaction(b->ancf, b->reaction[1]));
  PetscCall(Extrapolate(b, 0.0, &e));
  for (PetscInt d = 0; d < b->ndisk; d++) {
    DiskMotion(b, d, e, w, alpha, rd, rdd);
    AnyNormal(b->t + 3 * d, b->d1 + 3 * d);
    Transport(b, b->t + 3 * d, b->d1 + 3 * d);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CoupleSurfaceCreateBeam - Surface of beam `beam` of ancf (set up before): disks about dp apart, marked to depthmax (m) below the
surface.

  Errors: a diameter below dp cannot be marked: not even one marker of the fluid's volume fits across the beam.
@*/
PetscErrorCode CoupleSurfaceCreateBeam(Ancf ancf, PetscInt beam, PetscInt dim, PetscReal dp, PetscReal depthmax,
                                       CoupleSurface *surface)
{
  const CoupleSurfaceOps ops = {GetMarkers_Beam, Kinematics_Beam, ZeroLoads_Beam, ApplyForces_Beam,
                                Advance_Beam,    Momentum_Beam,   View_Beam,      Destroy_Beam};
  AncfBeamSpec spec;
  Section *c;
  Beam *b;
  PetscReal *v, *a;
  char name[64];

  PetscFunctionBegin;
  PetscCall(PetscNew(&b));
  PetscCall(PetscNew(&c));
  b->ancf = ancf;
  b->beam = beam;
  b->dim = dim;
  PetscCall(AncfGetBeam(ancf, beam, &spec, &b->node0, &b->l));
  b->elements = spec.elements;
  b->rhoA = spec.rhoA >= 0.0 ? spec.rhoA : spec.density * PETSC_PI * 0.25 * spec.diameter * spec.diameter;
  PetscCheck(spec.diameter >= dp * (1.0 - 1e-9), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "beam %" PetscInt_FMT ": diameter = %g m is thinner than the marker spacing sph_dp = %g m: a beam needs at least "
             "one marker across; use sph_dp <= %g",
             beam, (double)spec.diameter, (double)dp, (double)spec.diameter);
  SectionFill(dim, 0.5 * spec.diameter, dp, depthmax, c);
  PetscCheck(c->n < 512, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "beam %" PetscInt_FMT ": diameter = %g m needs more than 511 markers per disk at sph_dp = %g m", beam,
             (double)spec.diameter, (double)dp);
  b->ndisk = PetscMax(1, (PetscInt)(b->l * (PetscReal)b->elements / dp + 0.5));
  PetscCall(Allocate(b, c->n));
  PetscCall(Place(b, &spec, c));
  PetscCall(PetscFree(c));
  PetscCall(PetscSNPrintf(name, sizeof(name), "beam_%" PetscInt_FMT, beam));
  PetscCall(CoupleSurfaceCreate(PETSC_COMM_SELF, name, &ops, b, surface));
  PetscCall(PetscMalloc2(3 * b->n, &v, 3 * b->n, &a));
  PetscCall(Kinematics_Beam(*surface, 0.0, b->x0, v, a));
  PetscCall(PetscFree2(v, a));
  PetscFunctionReturn(PETSC_SUCCESS);
}
