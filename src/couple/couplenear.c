/*
  couplenear.c - where beams are near each other, themselves, bodies and walls. Axes are cut into links of about a diameter, which
  a grid of cells sorts; within two near links every sample of one looks for the points of the other's axis that are locally the
  nearest, found on the cubic itself, and the other way round: each side counts half.

  Of a beam with itself, points less than pi (R + reach/2) apart along it are left out (a half circle whose legs are just out of
  reach is as long), and come in smoothly up to 5/4 of that. Joined beams are treated as one beam through the joint, and beams
  that are attached to one body through the body; an attached beam leaves its body alone over the same length.
*/
#include "coupleshort.h"

static PetscReal Image(PetscReal d, PetscReal period)
{
  return period > 0. ? d - period * PetscFloorReal(d / period + .5) : d;
}

PetscErrorCode CoupleShortPlace(CoupleShort c, PetscInt beam, PetscReal s, ShortPoint *p)
{
  const ShortBeam *b = &c->beam[beam];
  const PetscInt k = PetscMax(0, PetscMin(b->elements - 1, (PetscInt)(s / b->l)));

  PetscFunctionBegin;
  p->beam = beam;
  p->node = b->node + k;
  p->s = s;
  AncfShape(s / b->l - (PetscReal)k, b->l, p->S);
  for (int d = 0; d < 3; d++) {
    p->x[d] = 0.;
    for (int i = 0; i < 4; i++) p->x[d] += p->S[i] * c->e[6 * p->node + 3 * i + d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (r - x).r' and its slope (r'.r' + (r - x).r'') at s. */
static PetscReal Lead(const CoupleShort c, const ShortBeam *b, PetscReal s, const PetscReal x[3], PetscReal *slope)
{
  const PetscInt k = PetscMax(0, PetscMin(b->elements - 1, (PetscInt)(s / b->l)));
  const PetscReal xi = s / b->l - (PetscReal)k, *e = c->e + 6 * (b->node + k);
  PetscReal S[4], S1[4], S2[4], f = 0.;
  AncfShape(xi, b->l, S);
  AncfShapeX(xi, b->l, S1);
  AncfShapeXX(xi, b->l, S2);
  *slope = 0.;
  for (int d = 0; d < 3; d++) {
    PetscReal r = -x[d], r1 = 0., r2 = 0.;
    for (int i = 0; i < 4; i++) {
      r += S[i] * e[3 * i + d];
      r1 += S1[i] * e[3 * i + d];
      r2 += S2[i] * e[3 * i + d];
    }
    f += r * r1;
    *slope += r1 * r1 + r * r2;
  }
  return f;
}

/* Nearest point to x in [lo, hi]: Newton's method kept in a bracket by bisection. */
static PetscReal Foot(const CoupleShort c, const ShortBeam *b, PetscReal lo, PetscReal hi, const PetscReal x[3])
{
  PetscReal slope, s = .5 * (lo + hi), f;
  if (Lead(c, b, lo, x, &slope) >= 0.) return lo;
  if (Lead(c, b, hi, x, &slope) <= 0.) return hi;
  for (int it = 0; it < 60 && hi - lo > 1.e-15 * b->L; it++) {
    PetscReal next;
    f = Lead(c, b, s, x, &slope);
    if (f == 0.) break;
    if (f < 0.)
      lo = s;
    else
      hi = s;
    next = slope > 0. ? s - f / slope : lo;
    if (!(next > lo && next < hi)) next = .5 * (lo + hi);
    if (PetscAbsReal(next - s) < 1.e-14 * b->L) return next;
    s = next;
  }
  return s;
}

/* 0 at x <= 0, 1 at x >= 1, smooth. */
static PetscReal Ramp(PetscReal x)
{
  const PetscReal y = PetscMax(0., PetscMin(1., x));
  return y * y * (3. - 2. * y);
}

/* Share of a pair of points that are an arc apart along one body of beams. */
static PetscReal Share(PetscReal arc, PetscReal exclude)
{
  return Ramp(4. * (arc / exclude - 1.));
}

/* Length of the way from a point of one beam to one of another through a joint of both, or of one beam through a body. */
static PetscReal JoinedArc(const CoupleShort c, PetscInt a, PetscReal sa, PetscInt b, PetscReal sb)
{
  PetscInt lo = 0, hi = c->njoints;
  PetscReal arc = PETSC_INFINITY;
  if (a > b) return JoinedArc(c, b, sb, a, sa);
  while (lo < hi) {
    const PetscInt m = (lo + hi) / 2;
    const ShortJoint *j = &c->joint[m];
    if (j->a < a || (j->a == a && j->b < b))
      lo = m + 1;
    else
      hi = m;
  }
  for (; lo < c->njoints && c->joint[lo].a == a && c->joint[lo].b == b; lo++) {
    const ShortJoint *j = &c->joint[lo];
    arc = PetscMin(arc, j->gap + PetscAbsReal(sa - j->sa) + PetscAbsReal(sb - j->sb));
    if (a == b) arc = PetscMin(arc, j->gap + PetscAbsReal(sb - j->sa) + PetscAbsReal(sa - j->sb));
  }
  return arc;
}

static PetscReal JoinedShare(const CoupleShort c, PetscInt a, PetscReal sa, PetscInt b, PetscReal sb)
{
  const PetscReal arc = JoinedArc(c, a, sa, b, sb);
  return arc == PETSC_INFINITY ? 1. : Share(arc, PetscMax(c->beam[a].exclude, c->beam[b].exclude));
}

/* A beam leaves the body alone that it, or a beam joined to it, is attached to; what of it is inside does not count. */
static PetscReal AttachedShare(const CoupleShort c, PetscInt beam, PetscReal s, PetscInt body)
{
  PetscReal share = 1.;
  for (PetscInt i = c->nattach ? c->bodyof[body] : 0; c->nattach && i < c->bodyof[body + 1]; i++) {
    const ShortAttach *a = &c->attached[i];
    const PetscReal arc = a->beam == beam ? PetscAbsReal(s - a->s) : JoinedArc(c, beam, s, a->beam, a->s);
    if (arc < PETSC_INFINITY) share = PetscMin(share, Share(PetscMax(0., arc - a->depth), c->beam[beam].exclude));
  }
  return share;
}

static PetscErrorCode NewPair(CoupleShort c, ShortPair **pair)
{
  PetscFunctionBegin;
  if (c->npairs == c->nalloc) {
    c->nalloc = 2 * c->nalloc + 64;
    PetscCall(PetscRealloc(sizeof(ShortPair) * (size_t)c->nalloc, &c->pair));
  }
  *pair = &c->pair[c->npairs++];
  PetscCall(PetscMemzero(*pair, sizeof(**pair)));
  (*pair)->factor = 1.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sample i of beam a, whose image is shifted, at the point s of beam b. */
static PetscErrorCode AddBeamPair(CoupleShort c, PetscInt a, PetscReal si, const PetscReal x[3], PetscInt b, PetscReal s)
{
  const ShortBeam *ba = &c->beam[a], *bb = &c->beam[b];
  PetscReal share, d[3], norm;
  ShortPoint at;
  ShortPair *p;

  PetscFunctionBegin;
  share = JoinedShare(c, a, si, b, s);
  if (a == b) share = PetscMin(share, Share(PetscAbsReal(s - si), ba->exclude));
  if (share == 0.) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CoupleShortPlace(c, b, s, &at));
  for (int k = 0; k < 3; k++) d[k] = x[k] - at.x[k];
  norm = PetscSqrtReal(CoupleDot(d, d));
  if (norm == 0. || norm - ba->R - bb->R >= c->reach) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(NewPair(c, &p));
  PetscCall(CoupleShortPlace(c, a, si, &p->a));
  p->b = at;
  p->body = SHORT_BEAM;
  for (int k = 0; k < 3; k++) p->n[k] = d[k] / norm;
  p->gap = norm - ba->R - bb->R;
  p->R = 1. / (1. / ba->R + 1. / bb->R);
  p->length = .5 * ba->step * share;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Distance2(const PetscReal *x, const PetscReal *y)
{
  return PetscSqr(x[0] - y[0]) + PetscSqr(x[1] - y[1]) + PetscSqr(x[2] - y[2]);
}

/* Samples of link a against the axis of link b, which lies `shift` further in the image of a. */
static PetscErrorCode LinkOnLink(CoupleShort c, const ShortLink *la, const ShortLink *lb, const PetscReal shift[3])
{
  const ShortBeam *ba = &c->beam[la->beam], *bb = &c->beam[lb->beam];
  const PetscReal *xb = c->x + 3 * bb->sample;
  const PetscReal far = PetscSqr(ba->R + bb->R + c->reach + 2. * bb->step); /* the foot is within a step of its sample */

  PetscFunctionBegin;
  for (PetscInt i = la->first; i < la->first + la->n; i++) {
    const PetscReal *xi = c->x + 3 * (ba->sample + i), si = ba->lo + ((PetscReal)i + .5) * ba->step;
    const PetscReal x[3] = {xi[0] - shift[0], xi[1] - shift[1], xi[2] - shift[2]};
    if (Distance2(x, lb->c) > PetscSqr(ba->R + lb->r + c->reach)) continue;
    for (PetscInt j = lb->first; j < lb->first + lb->n; j++) {
      const PetscReal d2 = Distance2(x, xb + 3 * j);
      PetscReal lo = bb->lo + ((PetscReal)j - .5) * bb->step, hi = lo + 2. * bb->step;
      if (d2 > far) continue;
      if ((j > 0 && d2 > Distance2(x, xb + 3 * (j - 1))) || (j < bb->samples - 1 && d2 >= Distance2(x, xb + 3 * (j + 1))))
        continue;
      if (j == 0) lo = bb->lo;
      if (j == bb->samples - 1) hi = bb->hi;
      if (la->beam == lb->beam && hi > si - ba->exclude && lo < si + ba->exclude) continue;
      PetscCall(AddBeamPair(c, la->beam, si, x, lb->beam, Foot(c, bb, lo, hi, x)));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LinkPair(CoupleShort c, const ShortLink *la, const ShortLink *lb)
{
  PetscReal shift[3], back[3], d2 = 0.;

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    const PetscReal d = la->c[k] - lb->c[k], near = Image(d, c->period[k]);
    d2 += near * near;
    shift[k] = d - near;
    back[k] = near - d;
  }
  if (d2 > PetscSqr(la->r + lb->r + c->reach)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LinkOnLink(c, la, lb, shift));
  PetscCall(LinkOnLink(c, lb, la, back));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Coordinates at the middle of the step, samples, links with their spheres. */
static PetscErrorCode PlaceAll(CoupleShort c)
{
  const PetscReal *e, *v;

  PetscFunctionBegin;
  PetscCall(AncfGetState(c->ancf, NULL, &e, &v, NULL));
  for (PetscInt i = 0; i < 6 * c->nnodes; i++) {
    c->v[i] = v[i];
    c->e[i] = e[i] + c->half * v[i];
  }
  for (PetscInt b = 0; b < c->nbeams; b++) {
    const ShortBeam *beam = &c->beam[b];
    for (PetscInt k = 0; k < beam->samples; k++) {
      ShortPoint p;
      PetscCall(CoupleShortPlace(c, b, beam->lo + ((PetscReal)k + .5) * beam->step, &p));
      PetscCall(PetscArraycpy(c->x + 3 * (beam->sample + k), p.x, 3));
    }
  }
  for (PetscInt k = 0; k < c->nlinks; k++) {
    ShortLink *l = &c->link[k];
    const ShortBeam *b = &c->beam[l->beam];
    const PetscReal *x = c->x + 3 * (b->sample + l->first);
    l->r = 0.;
    for (int d = 0; d < 3; d++) l->c[d] = .5 * (x[d] + x[3 * (l->n - 1) + d]);
    for (PetscInt i = 0; i < l->n; i++) l->r = PetscMax(l->r, Distance2(x + 3 * i, l->c));
    l->r = PetscSqrtReal(l->r) + b->R + b->step;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A grid of cells in which links lie. */
typedef struct {
  PetscReal lo[3], cell[3];
  PetscInt n[3];
} Grid;

/* Cells no smaller than the reach of a link and at most 8 nlinks + 8 of them; the period or the box of the links. */
static void GridSize(const CoupleShort c, Grid *g)
{
  PetscReal size = 0., length[3], total;
  for (PetscInt i = 0; i < c->nlinks; i++) size = PetscMax(size, 2. * c->link[i].r + c->reach);
  for (int k = 0; k < 3; k++) {
    PetscReal hi = 0.;
    g->lo[k] = 0.;
    for (PetscInt i = 0; i < c->nlinks && c->period[k] == 0.; i++) {
      const PetscReal x = c->link[i].c[k];
      g->lo[k] = i ? PetscMin(g->lo[k], x) : x;
      hi = i ? PetscMax(hi, x) : x;
    }
    length[k] = c->period[k] > 0. ? c->period[k] : hi - g->lo[k];
  }
  do {
    total = 1.;
    for (int k = 0; k < 3; k++) {
      g->n[k] = PetscMax(1, (PetscInt)PetscMin(length[k] / size, 1.e6));
      g->cell[k] = length[k] > 0. ? length[k] / (PetscReal)g->n[k] : 1.;
      total *= (PetscReal)g->n[k];
    }
    size *= 1.26;
  } while (total > 8. * (PetscReal)c->nlinks + 8.);
}

/* Cell number along axis k of a coordinate, not yet cut to the grid. */
static PetscInt CellOf(const CoupleShort c, const Grid *g, int k, PetscReal x)
{
  const PetscReal L = c->period[k];
  return (PetscInt)PetscFloorReal((L > 0. ? x - L * PetscFloorReal(x / L) : x - g->lo[k]) / g->cell[k]);
}

static PetscErrorCode FillGrid(CoupleShort c, const Grid *g)
{
  const PetscInt total = g->n[0] * g->n[1] * g->n[2];

  PetscFunctionBegin;
  if (total > c->nhead) {
    PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)total, &c->head));
    c->nhead = total;
  }
  for (PetscInt i = 0; i < total; i++) c->head[i] = -1;
  for (PetscInt i = c->nlinks - 1; i >= 0; i--) {
    PetscInt at = 0;
    for (int k = 2; k >= 0; k--) at = at * g->n[k] + PetscMax(0, PetscMin(g->n[k] - 1, CellOf(c, g, k, c->link[i].c[k])));
    c->next[i] = c->head[at];
    c->head[at] = i;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells that a cube of half width w about x meets: first one and how many along each axis; each cell once. */
static void Around(const CoupleShort c, const Grid *g, const PetscReal x[3], PetscReal w, PetscInt first[3], PetscInt count[3])
{
  for (int k = 0; k < 3; k++) {
    const PetscReal L = c->period[k], y = L > 0. ? x[k] - L * PetscFloorReal(x[k] / L) : x[k] - g->lo[k];
    const PetscReal lo = PetscFloorReal((y - w) / g->cell[k]), hi = PetscFloorReal((y + w) / g->cell[k]);
    if (L > 0.) {
      count[k] = (PetscInt)PetscMin(hi - lo + 1., (PetscReal)g->n[k]);
      first[k] = (PetscInt)(lo - (PetscReal)g->n[k] * PetscFloorReal(lo / (PetscReal)g->n[k]));
    } else {
      const PetscReal last = (PetscReal)g->n[k] - 1.; /* the border is in the last cell */
      first[k] = (PetscInt)PetscMax(0., PetscMin(lo, last));
      count[k] = hi < 0. || lo > last + 1. ? 0 : (PetscInt)PetscMin(PetscMax(hi, 0.), last) - first[k] + 1;
    }
  }
}

static PetscInt HeadOf(const CoupleShort c, const Grid *g, const PetscInt first[3], const PetscInt count[3], PetscInt m)
{
  const PetscInt i = (first[0] + m % count[0]) % g->n[0], j = (first[1] + m / count[0] % count[1]) % g->n[1],
                 k = (first[2] + m / (count[0] * count[1])) % g->n[2];
  return c->head[i + g->n[0] * (j + g->n[1] * k)];
}

static PetscErrorCode BeamsOnBeams(CoupleShort c, const Grid *g)
{
  PetscInt first[3], count[3];
  PetscReal rmax = 0.;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < c->nlinks; i++) rmax = PetscMax(rmax, c->link[i].r);
  for (PetscInt i = 0; i < c->nlinks; i++) {
    Around(c, g, c->link[i].c, c->link[i].r + rmax + c->reach, first, count);
    for (PetscInt m = 0; m < count[0] * count[1] * count[2]; m++)
      for (PetscInt j = HeadOf(c, g, first, count, m); j >= 0; j = c->next[j])
        if (j > i) PetscCall(LinkPair(c, &c->link[i], &c->link[j]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A supported end leaves its wall or fixed body alone. */
static PetscReal EndShare(const ShortBeam *b, PetscReal s)
{
  PetscReal share = 1.;
  if (b->held[0]) share = PetscMin(share, Share(s, b->exclude));
  if (b->held[1]) share = PetscMin(share, Share(b->L - s, b->exclude));
  return share;
}

/*
  Resistance of a sphere of radius b facing a cylinder of radius a over that of the line law summed along the cylinder:
  Reynolds' equation gives 12 pi mu sqrt(Rx Ry)/((1/Rx + 1/Ry) s), Rx = ab/(a + b), Ry = b; the sum 12 pi mu R^(3/2) sqrt(a +
  b)/s.
*/
static PetscReal SphereFactor(PetscReal a, PetscReal b)
{
  return PetscSqrtReal(b * (a + b)) / (2. * a + b);
}

/* Samples of one link against a body, its centre at the middle of the step X, present one X0. */
static PetscErrorCode LinkOnBody(CoupleShort c, const ShortLink *l, PetscInt body, const RigidBodySpec *spec,
                                 const PetscReal X[3], const PetscReal X0[3])
{
  const ShortBeam *b = &c->beam[l->beam];
  const PetscBool round = spec->shape == RIGID_SPHERE ? PETSC_TRUE : PETSC_FALSE;
  ShortPair *p;

  PetscFunctionBegin;
  for (PetscInt i = l->first; i < l->first + l->n; i++) {
    const PetscReal *x = c->x + 3 * (b->sample + i), s = b->lo + ((PetscReal)i + .5) * b->step,
                    share = PetscMin(AttachedShare(c, l->beam, s, body), spec->motion == RIGID_FREE ? 1. : EndShare(b, s));
    PetscReal y[3], r[3], n[3], gap;
    for (int k = 0; k < 3; k++) {
      r[k] = Image(x[k] - X[k], c->period[k]);
      y[k] = X0[k] + r[k];
    }
    if (share == 0.) continue;
    PetscCall(RigidGetGap(c->rigid, body, y, &gap, NULL));
    if (gap - b->R >= c->reach) continue;
    PetscCall(RigidGetGap(c->rigid, body, y, &gap, n));
    if (CoupleDot(n, n) == 0.) continue;
    PetscCall(NewPair(c, &p));
    PetscCall(CoupleShortPlace(c, l->beam, s, &p->a));
    p->body = body;
    for (int k = 0; k < 3; k++) {
      p->n[k] = n[k];
      p->r[k] = r[k];
    }
    p->gap = gap - b->R;
    p->R = round ? 1. / (1. / b->R + 1. / spec->size[0]) : b->R;
    p->factor = round ? SphereFactor(b->R, spec->size[0]) : 1.;
    p->length = b->step * share;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BeamsOnBodies(CoupleShort c, const Grid *g)
{
  PetscInt first[3], count[3];
  PetscReal rmax = 0.;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < c->nlinks; i++) rmax = PetscMax(rmax, c->link[i].r);
  for (PetscInt body = 0; body < c->nbodies; body++) {
    PetscReal X0[3], X[3], V[3], radius;
    RigidBodySpec spec;
    PetscCall(RigidGetBody(c->rigid, body, &spec));
    PetscCall(RigidGetState(c->rigid, body, X0, NULL, V, NULL));
    PetscCall(RigidGetRadius(c->rigid, body, &radius));
    for (int k = 0; k < 3; k++) X[k] = X0[k] + c->half * V[k];
    Around(c, g, X, radius + rmax + c->reach, first, count);
    for (PetscInt m = 0; m < count[0] * count[1] * count[2]; m++)
      for (PetscInt j = HeadOf(c, g, first, count, m); j >= 0; j = c->next[j]) {
        const ShortLink *l = &c->link[j];
        PetscReal d2 = 0.;
        for (int k = 0; k < 3; k++) d2 += PetscSqr(Image(l->c[k] - X[k], c->period[k]));
        if (d2 <= PetscSqr(l->r + radius + c->reach)) PetscCall(LinkOnBody(c, l, body, &spec, X, X0));
      }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BeamsOnWalls(CoupleShort c)
{
  ShortPair *p;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < c->nlinks; j++)
    for (PetscInt w = 0; w < c->nwalls; w++) {
      const ShortLink *l = &c->link[j];
      const ShortBeam *b = &c->beam[l->beam];
      const ShortWall *wall = &c->wall[w];
      if (CoupleDot(wall->n, l->c) - CoupleDot(wall->n, wall->x) > l->r + c->reach) continue;
      for (PetscInt i = l->first; i < l->first + l->n; i++) {
        const PetscReal *x = c->x + 3 * (b->sample + i), s = b->lo + ((PetscReal)i + .5) * b->step, share = EndShare(b, s);
        const PetscReal gap = CoupleDot(wall->n, x) - CoupleDot(wall->n, wall->x) - b->R;
        if (gap >= c->reach || share == 0.) continue;
        PetscCall(NewPair(c, &p));
        PetscCall(CoupleShortPlace(c, l->beam, s, &p->a));
        p->body = SHORT_WALL;
        PetscCall(PetscArraycpy(p->n, wall->n, 3));
        p->gap = gap;
        p->R = b->R;
        p->length = b->step * share;
      }
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleShortFindPairs(CoupleShort c)
{
  Grid g;

  PetscFunctionBegin;
  c->npairs = 0;
  PetscCall(PlaceAll(c));
  GridSize(c, &g);
  PetscCall(FillGrid(c, &g));
  PetscCall(BeamsOnBeams(c, &g));
  PetscCall(BeamsOnBodies(c, &g));
  PetscCall(BeamsOnWalls(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}
