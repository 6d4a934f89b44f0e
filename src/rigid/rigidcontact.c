/*
  rigidcontact.c - short-range forces between the bodies of one Rigid: which pairs are near, where they face one another, and the
  forces of shortrange.h there. Forces act on both bodies in one point, equal and opposite: momenta are kept.

  Lubrication diverges as gaps close and would need ever smaller steps if taken explicitly. With G_i = sum over the body's
  contacts of gamma (1/m + (r x n).J^-1 (r x n)), a kick of length h takes F = -gamma v_n/(1 + h (G_i + G_j)): the implicit
  Euler value for a lone pair, and never more than that for crowds, since the resistance of all pairs is bounded by their sum.
*/
#include "rigidcontact.h"
#include <stdlib.h>

static PetscBool IsRound(const RigidBodySpec *s, PetscInt dim)
{
  return (PetscBool)(s->shape == RIGID_SPHERE || (dim == 2 && s->shape == RIGID_CYLINDER));
}

static PetscReal BoundingRadius(const RigidBodySpec *s, PetscInt dim)
{
  const PetscReal *a = s->size;
  PetscReal h[3] = {0., 0., 0.};
  if (IsRound(s, dim)) return a[0];
  switch (s->shape) {
  case RIGID_CYLINDER:
    return PetscSqrtReal(a[0] * a[0] + .25 * a[1] * a[1]);
  case RIGID_CAPSULE:
    return a[0] + .5 * a[1];
  case RIGID_ELLIPSOID:
    return PetscMax(a[0], PetscMax(a[1], dim == 2 ? 0. : a[2]));
  case RIGID_BOX:
    for (PetscInt k = 0; k < dim; k++) h[k] = .5 * a[k];
    return Vec3Norm(h);
  default:
    for (PetscInt k = 0; k < dim; k++) h[k] = PetscMax(PetscAbsReal(s->geometry->lo[k]), PetscAbsReal(s->geometry->hi[k]));
    return Vec3Norm(h);
  }
}

static PetscErrorCode ContactCreate(Rigid rigid, PetscReal reach, PetscReal spacing, RigidContact *contact)
{
  RigidContact c;

  PetscFunctionBegin;
  PetscCall(PetscNew(&c));
  *contact = c;
  c->reach = reach;
  c->nbodies = rigid->n;
  PetscCall(PetscMalloc4((size_t)rigid->n, &c->radius, (size_t)rigid->n, &c->next, (size_t)rigid->n, &c->G, 6 * (size_t)rigid->n,
                         &c->kick));
  PetscCall(PetscCalloc1((size_t)rigid->n, &c->surface));
  PetscCall(PetscMalloc1((size_t)rigid->njoints, &c->joined));
  for (PetscInt j = 0; j < rigid->njoints; j++) {
    c->joined[c->njoined].i = PetscMin(rigid->joint[j].spec.a, rigid->joint[j].spec.b);
    c->joined[c->njoined++].j = PetscMax(rigid->joint[j].spec.a, rigid->joint[j].spec.b);
  }
  if (c->njoined) qsort(c->joined, (size_t)c->njoined, sizeof(Pair), RigidComparePairs);
  for (PetscInt i = 0; i < rigid->n; i++) {
    const RigidBodySpec *s = &rigid->body[i].spec;
    c->radius[i] = BoundingRadius(s, rigid->dim);
    if (IsRound(s, rigid->dim)) continue;
    PetscCheck(spacing > 0. && !PetscIsInfOrNanReal(spacing), rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "-rigid_shortrange_spacing %g m: must be > 0, as body %" PetscInt_FMT " is a %s", (double)spacing, i,
               RigidShapeName(s->shape));
    PetscCall(RigidSurfacePoints(s, rigid->dim, spacing, &c->surface[i]));
  }
  if (rigid->n) { /* four times the median radius */
    PetscReal *sorted;
    PetscCall(PetscMalloc1((size_t)rigid->n, &sorted));
    PetscCall(PetscArraycpy(sorted, c->radius, rigid->n));
    PetscCall(PetscSortReal(rigid->n, sorted));
    c->small = 4. * sorted[rigid->n / 2];
    for (PetscInt i = rigid->n - 1; i >= 0; i--)
      if (sorted[i] <= c->small) {
        c->small = sorted[i];
        break;
      }
    PetscCall(PetscFree(sorted));
  }
  for (PetscInt i = 0; i < rigid->n; i++)
    for (int k = 0; k < 3; k++) { /* two images of a body may both be near another one; a lone body has its own images only */
      const PetscReal least = (rigid->n > 1 ? 2. : 1.) * (2. * c->radius[i] + reach);
      PetscCheck(rigid->period[k] == 0. || IsRound(&rigid->body[i].spec, rigid->dim) == PETSC_FALSE || rigid->period[k] >= least,
                 rigid->comm, PETSC_ERR_ARG_INCOMP,
                 "Rigid body %" PetscInt_FMT ": a period of %g m is too short for nearest images; must be >= %g m", i,
                 (double)rigid->period[k], (double)least);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidContactDestroy(RigidContact *contact)
{
  RigidContact c = *contact;

  PetscFunctionBegin;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 2; k++) PetscCall(PetscFree(c->near[k].x));
  for (int k = 0; k < 2; k++) PetscCall(PetscFree(c->near[k].volume));
  PetscCall(PetscFree(c->joined));
  PetscCall(PetscFree(c->head));
  PetscCall(PetscFree(c->pair));
  PetscCall(PetscFree(c->contact));
  for (PetscInt i = 0; i < c->nbodies; i++) PetscCall(PetscFree(c->surface[i].x));
  for (PetscInt i = 0; i < c->nbodies; i++) PetscCall(PetscFree(c->surface[i].volume));
  PetscCall(PetscFree4(c->radius, c->next, c->G, c->kick));
  PetscCall(PetscFree(c->surface));
  PetscCall(PetscFree(*contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidContactSetUp(Rigid rigid)
{
  const ShortRange *p = &rigid->shortrange;

  PetscFunctionBegin;
  PetscCall(ShortRangeCheck(rigid->comm, p));
  if (p->viscosity == 0. && p->modulus == 0.) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(rigid->dim == 3 || p->viscosity == 0., rigid->comm, PETSC_ERR_ARG_INCOMP,
             "-rigid_lubrication_viscosity %g Pa s: lubrication (Eqs. 31, 32) is for 3D; must be 0 in 2D", (double)p->viscosity);
  PetscCall(ContactCreate(rigid, PetscMax(p->viscosity > 0. ? p->cutoff : 0., p->roughness), rigid->spacing, &rigid->contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Place of body j as seen from body i: its nearest image. */
static void ImageOf(Rigid rigid, PetscInt i, PetscInt j, PetscReal X[3])
{
  for (int k = 0; k < 3; k++)
    X[k] = rigid->body[i].X[k] - RigidNearestImage(rigid->body[i].X[k] - rigid->body[j].X[k], rigid->period[k]);
}

/* Gap between a point x and body j placed at X; n, if not NULL: normal of its surface there, space frame. */
static PetscReal GapTo(Rigid rigid, PetscInt j, const PetscReal X[3], const PetscReal x[3], PetscReal n[3])
{
  const RigidBody *b = &rigid->body[j];
  const PetscReal d[3] = {x[0] - X[0], x[1] - X[1], x[2] - X[2]};
  PetscReal y[3], ny[3] = {0., 0., 0.}, s;
  QuatRotateBack(b->q, d, y);
  s = RigidShapeDistance(&b->spec, y);
  if (!n) return s;
  (void)RigidShapeNormal(&b->spec, rigid->dim, y, 1.e-6 * (PetscAbsReal(s) + 1.e-3 * RigidShapeSmallest(&b->spec, rigid->dim)),
                         ny);
  QuatRotate(b->q, ny, n);
  return s;
}

/* Point of action x; X_j is the image of body j. */
static PetscErrorCode AddContact(Rigid rigid, RigidContact c, PetscInt i, PetscInt j, const PetscReal Xj[3], const PetscReal n[3],
                                 const PetscReal x[3], PetscReal s, PetscReal gamma, PetscReal R, PetscReal share)
{
  Contact *t;

  PetscFunctionBegin;
  if (c->n == c->nalloc) {
    c->nalloc = 2 * c->nalloc + 64;
    PetscCall(PetscRealloc(sizeof(Contact) * (size_t)c->nalloc, &c->contact));
  }
  t = &c->contact[c->n++];
  t->i = i;
  t->j = j;
  t->s = s;
  t->gamma = gamma;
  t->R = R;
  t->share = share;
  for (int k = 0; k < 3; k++) {
    t->n[k] = n[k];
    t->ri[k] = x[k] - rigid->body[i].X[k];
    t->rj[k] = x[k] - Xj[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RoundRound(Rigid rigid, RigidContact c, PetscInt i, PetscInt j)
{
  const PetscReal ai = c->radius[i], aj = c->radius[j];
  PetscReal Xj[3], n[3], x[3], d, s;

  PetscFunctionBegin;
  ImageOf(rigid, i, j, Xj);
  for (int k = 0; k < 3; k++) n[k] = rigid->body[i].X[k] - Xj[k];
  d = Vec3Norm(n);
  s = d - ai - aj;
  if (s >= c->reach || d == 0.) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 3; k++) {
    n[k] /= d;
    x[k] = Xj[k] + (aj + .5 * s) * n[k];
  }
  PetscCall(
      AddContact(rigid, c, i, j, Xj, n, x, s, ShortRangeSphere(&rigid->shortrange, ai, aj, s), 1. / (1. / ai + 1. / aj), 1.));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* i is round, j is not. */
static PetscErrorCode RoundAny(Rigid rigid, RigidContact c, PetscInt i, PetscInt j)
{
  const PetscReal a = c->radius[i];
  PetscReal Xj[3], n[3], x[3], s;

  PetscFunctionBegin;
  ImageOf(rigid, i, j, Xj);
  s = GapTo(rigid, j, Xj, rigid->body[i].X, n) - a;
  if (s >= c->reach) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 3; k++) x[k] = rigid->body[i].X[k] - (a + .5 * s) * n[k];
  PetscCall(AddContact(rigid, c, i, j, Xj, n, x, s, ShortRangeSphere(&rigid->shortrange, a, PETSC_INFINITY, s), a, 1.));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Surface points of body i (placed at X) within reach of body j (at Xj), space frame. */
static PetscErrorCode FacingPoints(Rigid rigid, RigidContact c, PetscInt i, const PetscReal X[3], PetscInt j,
                                   const PetscReal Xj[3], RigidMarkers *near)
{
  PetscFunctionBegin;
  near->n = 0;
  for (PetscInt k = 0; k < c->surface[i].n; k++) {
    PetscReal x[3], s, d2 = 0.;
    QuatRotate(rigid->body[i].q, &c->surface[i].x[3 * k], x);
    for (int d = 0; d < 3; d++) {
      x[d] += X[d];
      d2 += PetscSqr(x[d] - Xj[d]);
    }
    if (d2 > PetscSqr(c->radius[j] + c->reach)) continue;
    s = GapTo(rigid, j, Xj, x, NULL);
    if (s < c->reach) PetscCall(RigidMarkersAdd(near, x[0], x[1], x[2], s));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Eq. 32 over all pairs of facing points; contact of each side's points, half of it each. near->volume holds the gaps. */
static PetscErrorCode AnyAny(Rigid rigid, RigidContact c, PetscInt i, PetscInt j)
{
  const ShortRange *p = &rigid->shortrange;
  PetscReal Xj[3], n[3], x[3];

  PetscFunctionBegin;
  ImageOf(rigid, i, j, Xj);
  PetscCall(FacingPoints(rigid, c, i, rigid->body[i].X, j, Xj, &c->near[0]));
  PetscCall(FacingPoints(rigid, c, j, Xj, i, rigid->body[i].X, &c->near[1]));
  for (PetscInt a = 0; a < c->near[0].n && p->viscosity > 0.; a++)
    for (PetscInt b = 0; b < c->near[1].n; b++) {
      PetscReal s;
      for (int k = 0; k < 3; k++) {
        n[k] = c->near[0].x[3 * a + k] - c->near[1].x[3 * b + k];
        x[k] = .5 * (c->near[0].x[3 * a + k] + c->near[1].x[3 * b + k]);
      }
      s = Vec3Norm(n);
      if (s >= p->cutoff || s == 0.) continue;
      for (int k = 0; k < 3; k++) n[k] /= s;
      PetscCall(AddContact(rigid, c, i, j, Xj, n, x, s, ShortRangeMarkers(p, rigid->spacing, s), 0., 0.));
    }
  for (int side = 0; side < 2 && p->modulus > 0.; side++)
    for (PetscInt a = 0; a < c->near[side].n; a++) {
      if (c->near[side].volume[a] >= p->roughness) continue;
      const PetscReal s = GapTo(rigid, side ? i : j, side ? rigid->body[i].X : Xj, &c->near[side].x[3 * a], n);
      for (int k = 0; k < 3; k++) n[k] *= side ? -1. : 1.;
      PetscCall(AddContact(rigid, c, i, j, Xj, n, &c->near[side].x[3 * a], s, 0., .5 * rigid->spacing, .5));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gap between x and a wall, m; n, if not NULL: unit normal into the free side, 0 where there is none. */
static PetscReal WallGap(const RigidWall *w, PetscReal step, const PetscReal x[3], PetscReal n[3])
{
  const PetscReal d[3] = {x[0] - w->x[0], x[1] - w->x[1], x[2] - w->x[2]};
  PetscReal norm;

  for (int k = 0; k < 3 && n; k++) n[k] = w->n[k];
  if (!w->gap) return Vec3Dot(w->n, d);
  for (int k = 0; k < 3 && n; k++) {
    PetscReal a[3] = {x[0], x[1], x[2]}, b[3] = {x[0], x[1], x[2]};
    a[k] += step;
    b[k] -= step;
    n[k] = w->gap(a, w->ctx) - w->gap(b, w->ctx);
  }
  norm = n ? Vec3Norm(n) : 0.;
  for (int k = 0; k < 3 && n && norm > 0.; k++) n[k] /= norm;
  return w->gap(x, w->ctx);
}

/* Body i and a wall: the sphere, or every surface marker, against a plane in the nearest point. */
static PetscErrorCode AnyWall(Rigid rigid, RigidContact c, PetscInt i, const RigidWall *w)
{
  const RigidBody *b = &rigid->body[i];
  const PetscBool round = IsRound(&b->spec, rigid->dim);
  const PetscReal a = round ? c->radius[i] : 0.;
  const Pair ground = {RIGID_GROUND, i};
  const PetscReal step = 1.e-5 * c->radius[i];

  PetscFunctionBegin;
  if (b->spec.motion != RIGID_FREE || WallGap(w, step, b->X, NULL) > c->radius[i] + c->reach) PetscFunctionReturn(PETSC_SUCCESS);
  if (c->njoined && bsearch(&ground, c->joined, (size_t)c->njoined, sizeof(Pair), RigidComparePairs))
    PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < (round ? 1 : c->surface[i].n); k++) {
    PetscReal o[3] = {0., 0., 0.}, x[3], n[3], s;
    if (!round) QuatRotate(b->q, &c->surface[i].x[3 * k], o);
    for (int m = 0; m < 3; m++) x[m] = b->X[m] + o[m];
    s = WallGap(w, step, x, NULL) - a;
    if (s >= c->reach) continue;
    (void)WallGap(w, step, x, n);
    for (int m = 0; m < 3; m++) x[m] -= (a + .5 * s) * n[m];
    PetscCall(AddContact(rigid, c, i, RIGID_WALL, x, n, x, s,
                         ShortRangeSphere(&rigid->shortrange, round ? a : rigid->spacing, PETSC_INFINITY, s),
                         round ? a : .5 * rigid->spacing, 1.));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FindContacts(Rigid rigid, RigidContact c)
{
  PetscFunctionBegin;
  c->n = 0;
  for (PetscInt k = 0; k < c->npairs; k++) {
    const PetscInt i = c->pair[k].i, j = c->pair[k].j;
    const PetscBool ri = IsRound(&rigid->body[i].spec, rigid->dim), rj = IsRound(&rigid->body[j].spec, rigid->dim);
    if (ri && rj)
      PetscCall(RoundRound(rigid, c, i, j));
    else if (ri)
      PetscCall(RoundAny(rigid, c, i, j));
    else if (rj)
      PetscCall(RoundAny(rigid, c, j, i));
    else
      PetscCall(AnyAny(rigid, c, i, j));
  }
  for (PetscInt i = 0; i < rigid->n; i++)
    for (PetscInt k = 0; k < rigid->nwalls; k++) PetscCall(AnyWall(rigid, c, i, &rigid->wall[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Inverse effective mass of one side of a contact. */
static PetscReal InverseMass(const RigidBody *b, const PetscReal n[3], const PetscReal r[3])
{
  PetscReal J[6], W[6], w = 0.;
  for (int k = 0; k < 3; k++) J[k] = n[k];
  Vec3Cross(r, n, J + 3);
  RigidBodyMobility(b, J, W);
  for (int k = 0; k < 6; k++) w += J[k] * W[k];
  return w;
}

static PetscErrorCode CheckNumber(Rigid rigid, PetscInt body)
{
  PetscFunctionBegin;
  PetscCheck(rigid->setup && body >= 0 && body < rigid->n, rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Rigid body %" PetscInt_FMT ": there are %" PetscInt_FMT " bodies%s", body, rigid->n,
             rigid->setup ? "" : "; call RigidSetUp() first");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidGetRadius(Rigid rigid, PetscInt body, PetscReal *radius)
{
  PetscFunctionBegin;
  PetscCall(CheckNumber(rigid, body));
  *radius = BoundingRadius(&rigid->body[body].spec, rigid->dim);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidGetGap(Rigid rigid, PetscInt body, const PetscReal x[3], PetscReal *gap, PetscReal n[3])
{
  PetscFunctionBegin;
  PetscCall(CheckNumber(rigid, body));
  *gap = GapTo(rigid, body, rigid->body[body].X, x, n);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidGetInverseMass(Rigid rigid, PetscInt body, const PetscReal n[3], const PetscReal r[3], PetscReal *w)
{
  PetscFunctionBegin;
  PetscCall(CheckNumber(rigid, body));
  *w = InverseMass(&rigid->body[body], n, r);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void AddVelocity(const RigidBody *b, const PetscReal r[3], PetscReal sign, PetscReal v[3])
{
  PetscReal w[3], x[3];
  RigidBodyOmega(b, b->q, w);
  Vec3Cross(w, r, x);
  for (int k = 0; k < 3; k++) v[k] += sign * (b->V[k] + x[k]);
}

static PetscReal NormalVelocity(Rigid rigid, const Contact *t)
{
  PetscReal v[3] = {0., 0., 0.};
  AddVelocity(&rigid->body[t->i], t->ri, 1., v);
  if (t->j >= 0) AddVelocity(&rigid->body[t->j], t->rj, -1., v);
  return Vec3Dot(v, t->n);
}

static void AddForce(RigidBody *b, const PetscReal r[3], const PetscReal n[3], PetscReal f)
{
  PetscReal x[3];
  Vec3Cross(r, n, x);
  for (int k = 0; k < 3; k++) {
    b->Fs[k] += f * n[k];
    b->Ts[k] += f * x[k];
  }
}

/* Fs, Ts of all bodies from their present placement and velocities, for a kick of length `kick` (s). */
PetscErrorCode RigidContactForces(Rigid rigid, PetscReal kick)
{
  RigidContact c = rigid->contact;

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(RIGID_Contact, 0, 0, 0, 0));
  PetscCall(RigidFindPairs(rigid, c));
  PetscCall(FindContacts(rigid, c));
  for (PetscInt i = 0; i < rigid->n; i++) {
    c->G[i] = 0.;
    for (int k = 0; k < 3; k++) rigid->body[i].Fs[k] = rigid->body[i].Ts[k] = 0.;
  }
  for (PetscInt k = 0; k < c->n; k++) {
    const Contact *t = &c->contact[k];
    c->G[t->i] += t->gamma * InverseMass(&rigid->body[t->i], t->n, t->ri);
    if (t->j >= 0) c->G[t->j] += t->gamma * InverseMass(&rigid->body[t->j], t->n, t->rj);
  }
  for (PetscInt k = 0; k < c->n; k++) {
    Contact *t = &c->contact[k];
    RigidBody *bi = &rigid->body[t->i], *bj = t->j >= 0 ? &rigid->body[t->j] : NULL;
    const PetscReal v = NormalVelocity(rigid, t), w = InverseMass(bi, t->n, t->ri) + (bj ? InverseMass(bj, t->n, t->rj) : 0.);
    PetscReal f = -t->gamma * v / (1. + kick * (c->G[t->i] + (bj ? c->G[t->j] : 0.))), contact = 0.;
    t->v = v;
    t->lubrication = f;
    t->elastic = t->impact = 0.;
    if (t->share > 0. && w > 0.) {
      contact = t->share * ShortRangeContact(&rigid->shortrange, t->R, 1. / w, t->s, v);
      t->elastic = t->share * ShortRangeContact(&rigid->shortrange, t->R, 1. / w, t->s, 0.);
      t->impact = contact - t->elastic;
    }
    f += contact;
    AddForce(bi, t->ri, t->n, f);
    if (bj) AddForce(bj, t->rj, t->n, -f);
  }
  PetscCall(RigidAuditContacts(rigid, kick));
  PetscCall(PetscLogEventEnd(RIGID_Contact, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of the repulsion where the bodies are now. */
PetscErrorCode RigidContactEnergy(Rigid rigid, PetscReal *elastic)
{
  RigidContact c = rigid->contact;

  PetscFunctionBegin;
  *elastic = 0.;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(RigidFindPairs(rigid, c));
  PetscCall(FindContacts(rigid, c));
  for (PetscInt k = 0; k < c->n; k++)
    *elastic += c->contact[k].share * ShortRangeContactEnergy(&rigid->shortrange, c->contact[k].R, c->contact[k].s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Deepest overlap of a pair, m; 0 when there is none. */
static PetscErrorCode PairOverlap(Rigid rigid, RigidContact c, PetscInt i, PetscInt j, PetscReal *depth)
{
  PetscReal Xj[3];

  PetscFunctionBegin;
  *depth = 0.;
  c->n = 0;
  if (IsRound(&rigid->body[i].spec, rigid->dim) && IsRound(&rigid->body[j].spec, rigid->dim))
    PetscCall(RoundRound(rigid, c, i, j));
  else if (IsRound(&rigid->body[i].spec, rigid->dim))
    PetscCall(RoundAny(rigid, c, i, j));
  else if (IsRound(&rigid->body[j].spec, rigid->dim))
    PetscCall(RoundAny(rigid, c, j, i));
  else {
    ImageOf(rigid, i, j, Xj);
    PetscCall(FacingPoints(rigid, c, i, rigid->body[i].X, j, Xj, &c->near[0]));
    PetscCall(FacingPoints(rigid, c, j, Xj, i, rigid->body[i].X, &c->near[1]));
    for (int side = 0; side < 2; side++)
      for (PetscInt k = 0; k < c->near[side].n; k++) *depth = PetscMax(*depth, -c->near[side].volume[k]);
  }
  if (c->n) *depth = PetscMax(*depth, -c->contact[0].s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidCheckOverlap(Rigid rigid, PetscReal spacing)
{
  RigidContact c;

  PetscFunctionBegin;
  PetscCheck(rigid->setup, rigid->comm, PETSC_ERR_ORDER, "Call RigidSetUp() first");
  PetscCall(ContactCreate(rigid, 0., spacing, &c));
  PetscCall(RigidFindPairs(rigid, c));
  for (PetscInt k = 0; k < c->npairs; k++) {
    const PetscInt i = c->pair[k].i, j = c->pair[k].j;
    PetscReal depth;
    PetscCall(PairOverlap(rigid, c, i, j, &depth));
    PetscCheck(depth <= 1.e-9 * (c->radius[i] + c->radius[j]), rigid->comm, PETSC_ERR_ARG_INCOMP,
               "Rigid bodies %" PetscInt_FMT " (%s) and %" PetscInt_FMT " (%s) overlap by %g m", i,
               RigidShapeName(rigid->body[i].spec.shape), j, RigidShapeName(rigid->body[j].spec.shape), (double)depth);
  }
  for (PetscInt i = 0; i < rigid->n; i++)
    for (PetscInt k = 0; k < rigid->nwalls; k++) {
      PetscReal depth = 0.;
      c->n = 0;
      PetscCall(AnyWall(rigid, c, i, &rigid->wall[k]));
      for (PetscInt m = 0; m < c->n; m++) depth = PetscMax(depth, -c->contact[m].s);
      PetscCheck(depth <= 1.e-9 * c->radius[i], rigid->comm, PETSC_ERR_ARG_INCOMP,
                 "Rigid body %" PetscInt_FMT " (%s) overlaps the wall of normal (%g, %g, %g) by %g m", i,
                 RigidShapeName(rigid->body[i].spec.shape), (double)c->contact[0].n[0], (double)c->contact[0].n[1],
                 (double)c->contact[0].n[2], (double)depth);
    }
  PetscCall(RigidContactDestroy(&c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidSetShortRange(Rigid rigid, const ShortRange *p)
{
  PetscFunctionBegin;
  PetscCheck(!rigid->setup, rigid->comm, PETSC_ERR_ORDER, "RigidSetShortRange() must come before RigidSetUp()");
  PetscCall(ShortRangeCheck(rigid->comm, p));
  rigid->shortrange = *p;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidSetShortRangeSpacing(Rigid rigid, PetscReal spacing)
{
  PetscFunctionBegin;
  PetscCheck(spacing >= 0. && !PetscIsInfOrNanReal(spacing), rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "-rigid_shortrange_spacing %g m: must be >= 0", (double)spacing);
  rigid->spacing = spacing;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidSetPeriod(Rigid rigid, const PetscReal period[3])
{
  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    PetscCheck(period[k] >= 0. && !PetscIsInfOrNanReal(period[k]), rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "RigidSetPeriod(): component %d = %g m; must be > 0, or 0 for none", k, (double)period[k]);
    rigid->period[k] = period[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidAddWallGap(Rigid rigid, RigidWallGap gap, void *ctx)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < rigid->nwalls; k++)
    PetscCheck(!rigid->wall[k].gap, rigid->comm, PETSC_ERR_ARG_OUTOFRANGE, "RigidAddWallGap(): there is one already");
  rigid->wall[rigid->nwalls].gap = gap;
  rigid->wall[rigid->nwalls++].ctx = ctx;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidAddWall(Rigid rigid, const PetscReal x[3], const PetscReal normal[3])
{
  const PetscReal norm = Vec3Norm(normal);
  PetscInt planes = 0;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < rigid->nwalls; k++) planes += !rigid->wall[k].gap;
  PetscCheck(planes < 6, rigid->comm, PETSC_ERR_ARG_OUTOFRANGE, "RigidAddWall(): there are 6 walls already");
  PetscCheck(norm > 0. && !PetscIsInfOrNanReal(norm + x[0] + x[1] + x[2]), rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "RigidAddWall(): the normal (%g, %g, %g) must be finite and longer than 0", (double)normal[0], (double)normal[1],
             (double)normal[2]);
  for (int k = 0; k < 3; k++) {
    rigid->wall[rigid->nwalls].x[k] = x[k];
    rigid->wall[rigid->nwalls].n[k] = normal[k] / norm;
  }
  rigid->nwalls++;
  PetscFunctionReturn(PETSC_SUCCESS);
}
