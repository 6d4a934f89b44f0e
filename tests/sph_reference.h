/*
  sph_reference.h - sums of the fluid by brute force in double precision, with bounds per field, beside those of a backend.

  Bounds. u is the unit round-off of the pair arithmetic (2^-24 or 2^-53). A sum of N terms t_j, each the result of at most OPS =
  32 roundings of magnitude |t_j| (an operation to 2 ulp counts as four), has the error (N + OPS) u Sum |t_j| (Higham, Accuracy
  and Stability, Sect. 4.2), where |t_j| is the sum of the magnitudes of what is added inside the term. Positions are rounded
  relative to a cell of edge <= e, so a difference of two of them is wrong by at most d = 5 u e (own, neighbour, offset, two
  additions); its effect on a kernel is taken from the kernel at q +- (sqrt(3) d/h + 8 u). A quotient of sums n/s carries (dn +
  |n/s| ds)/s. Nothing is fitted to results.
*/
#ifndef SPH_REFERENCE_H
#define SPH_REFERENCE_H

#include "sph_conformance.h"
#include "testing.h"
#include <string.h>

#define OPS 32.0
#define U2 1.1102230246251565e-16 /* 2^-53 */

/* State and rates in the order added. */
typedef struct {
  PetscInt n;
  double *x[3], *v[3], *s, *a[3], *dv[3], *ds, *m, *ratio, *ab[3];
  const double *omega; /* the fluid's own: angular velocity at boundary markers */
  PetscInt nfluid;
  int *group;
  double *memory;
} Snapshot;

static PetscErrorCode Take(Sph sph, Snapshot *t)
{
  const PetscInt n = sph->n;
  double **to[] = {&t->x[0],  &t->x[1],  &t->x[2],  &t->v[0], &t->v[1], &t->v[2],  &t->s,     &t->a[0],  &t->a[1], &t->a[2],
                   &t->dv[0], &t->dv[1], &t->dv[2], &t->ds,   &t->m,    &t->ratio, &t->ab[0], &t->ab[1], &t->ab[2]};

  PetscFunctionBegin;
  PetscCall((*sph->ops->pull)(sph));
  const SphValues from[] = {{sph->st.x[0], NULL}, {sph->st.x[1], NULL}, {sph->st.x[2], NULL}, {sph->st.v[0], NULL},
                            {sph->st.v[1], NULL}, {sph->st.v[2], NULL}, {sph->st.s, NULL},    sph->rate.a[0],
                            sph->rate.a[1],       sph->rate.a[2],       sph->rate.dv[0],      sph->rate.dv[1],
                            sph->rate.dv[2],      sph->rate.ds,         {sph->m, NULL},       {sph->wallratio, NULL},
                            {sph->ab[0], NULL},   {sph->ab[1], NULL},   {sph->ab[2], NULL}};
  const int k = (int)(sizeof(to) / sizeof(to[0]));
  t->n = n;
  t->omega = sph->omega;
  t->nfluid = sph->nfluid;
  PetscCall(PetscMalloc2((size_t)(k * n), &t->memory, n, &t->group));
  for (int j = 0; j < k; j++) {
    *to[j] = t->memory + (size_t)j * (size_t)n;
    for (PetscInt id = 0; id < n; id++) (*to[j])[id] = SphValue(&from[j], sph->slot[id]);
  }
  for (PetscInt id = 0; id < n; id++) t->group[id] = sph->group[sph->slot[id]];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Drop(Snapshot *t)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(t->memory, t->group));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Kernels from their definitions; w without norm, f = w'/q. mag: magnitude of what is added inside w. */
static double W(int kernel, double q, double *mag)
{
  const double a = q < 2.0 ? 2.0 - q : 0.0, b = q < 1.0 ? 1.0 - q : 0.0;
  double w, m;
  if (kernel == SPH_KERNEL_WENDLAND)
    w = m = pow(0.5 * a, 4.0) * (2.0 * q + 1.0);
  else {
    w = a * a * a - 4.0 * b * b * b;
    m = a * a * a + 4.0 * b * b * b;
  }
  if (mag) *mag = m;
  return w;
}

static double F(int kernel, double q, double *mag)
{
  const double a = q < 2.0 ? 2.0 - q : 0.0, b = q < 1.0 ? 1.0 - q : 0.0;
  double f, m;
  if (kernel == SPH_KERNEL_WENDLAND)
    f = -5.0 * pow(0.5 * a, 3.0), m = -f;
  else if (q < 1.0)
    f = 9.0 * q - 12.0, m = 9.0 * q + 12.0; /* (12 b^2 - 3 a^2)/q */
  else
    f = (12.0 * b * b - 3.0 * a * a) / q, m = -f;
  if (mag) *mag = m;
  return f;
}

typedef double (*KernelFn)(int, double, double *);

/* Change of a kernel when q is wrong by dq. */
static double Change(KernelFn k, int kernel, double q, double dq)
{
  const double c = k(kernel, q, NULL), l = fabs(k(kernel, PetscMax(q - dq, 0.0), NULL) - c),
               r = fabs(k(kernel, q + dq, NULL) - c);
  return PetscMax(l, r);
}

/* A sum with its error bound: value, magnitude of the terms, errors from positions, number of terms. */
typedef struct {
  double v, mag, pos;
  int n;
} Sum;

static void Add(Sum *s, double value, double mag, double pos)
{
  s->v += value;
  s->mag += mag;
  s->pos += pos;
  s->n++;
}

static double Bound(const Sum *s, double u)
{
  return ((double)s->n + OPS) * u * s->mag + s->pos;
}

/* Bound of the quotient of two sums. */
static double QuotientBound(const Sum *n, const Sum *d, double u)
{
  return (Bound(n, u) + fabs(n->v / d->v) * Bound(d, u)) / (d->v - Bound(d, u)) + 4.0 * u * fabs(n->v / d->v);
}

/* A pair as marker a sees it. */
typedef struct {
  double x[3], r, r2, q, dx, dq;
} Pair;

typedef struct {
  const SphParams *p;
  const Snapshot *t;
  double u, edge, far;
} Ref;

/* Calls term for each neighbour of a, periodic images included; fluidonly: fluid neighbours. */
typedef void (*Term)(const Ref *r, PetscInt a, PetscInt b, const Pair *x, void *ctx);

static void ForNeighbours(const Ref *r, PetscInt a, int fluidonly, Term term, void *ctx)
{
  const SphParams *p = r->p;
  const int ex = (int)p->periodic[0], ey = (int)p->periodic[1], ez = p->dim == 3 && p->periodic[2];

  for (PetscInt b = 0; b < r->t->n; b++) {
    if (r->t->group[b] == -2 || (fluidonly && r->t->group[b] != -1)) continue;
    for (int i = -ex; i <= ex; i++)
      for (int j = -ey; j <= ey; j++)
        for (int k = -ez; k <= ez; k++) {
          const int image[3] = {i, j, k};
          Pair x = {.r2 = 0.0};
          for (int d = 0; d < p->dim; d++) {
            const double L = p->hi[d] - p->lo[d];
            x.x[d] = r->t->x[d][a] - r->t->x[d][b];
            if (p->periodic[d]) x.x[d] += image[d] * L - L * rint(x.x[d] / L);
            x.r2 += x.x[d] * x.x[d];
          }
          if (x.r2 >= 4.0 * p->h * p->h * (1.0 + 1e-5)) continue; /* what lies this close to the rim has a weight of about 0 */
          x.r = sqrt(x.r2);
          x.q = x.r / p->h;
          x.dx = 5.0 * r->u * r->edge + 8.0 * U2 * r->far;
          x.dq = sqrt(3.0) * x.dx / p->h + 8.0 * r->u;
          term(r, a, b, &x, ctx);
        }
  }
}

static double Rho(const Ref *r, PetscInt i)
{
  return r->p->rho0 * (1.0 + r->t->s[i]);
}

static double Pressure(const Ref *r, PetscInt i)
{
  return r->p->B * (pow(1.0 + r->t->s[i], r->p->gamma) - 1.0) + r->p->pb;
}

/* Round-off of (1 + s)^gamma - 1 evaluated as written above, for the comparison in double precision. */
static double PressureError(const Ref *r)
{
  return 4.0 * (1.0 + r->p->gamma) * U2 * r->p->B;
}

typedef struct {
  Sum a[3], ds, dd;
} RateSums;

static void RateTerm(const Ref *r, PetscInt a, PetscInt b, const Pair *x, void *ctx)
{
  const SphParams *p = r->p;
  const Snapshot *t = r->t;
  RateSums *s = (RateSums *)ctx;
  const int fa = t->group[a] == -1, fb = t->group[b] == -1;
  const double ra = Rho(r, a), rb = Rho(r, b), Pa = Pressure(r, a) / (ra * ra), Pb = Pressure(r, b) / (rb * rb), V = t->m[b] / rb;
  double fmag, ua[3], ub[3], va[3], vb[3], vx = 0.0, vxmag = 0.0, vmag1 = 0.0, wx = 0.0, wxmag = 0.0, wmag1 = 0.0, gx = 0.0;
  const double f = p->fnorm * F(p->kernel, x->q, &fmag), df = p->fnorm * Change(F, p->kernel, x->q, x->dq);
  fmag *= p->fnorm;

  for (int k = 0; k < 3; k++) {
    ua[k] = fa ? t->v[k][a] + t->dv[k][a] : t->v[k][a];
    ub[k] = fb ? t->v[k][b] + t->dv[k][b] : t->v[k][b];
    va[k] = fa ? t->v[k][a] : t->v[k][a] + t->dv[k][a];
    vb[k] = fb ? t->v[k][b] : t->v[k][b] + t->dv[k][b];
    vx += (ua[k] - ub[k]) * x->x[k];
    vxmag += (fabs(ua[k]) + fabs(ub[k])) * fabs(x->x[k]);
    vmag1 += fabs(ua[k]) + fabs(ub[k]);
    wx += (va[k] - vb[k]) * x->x[k];
    wxmag += (fabs(va[k]) + fabs(vb[k])) * fabs(x->x[k]);
    wmag1 += fabs(va[k]) + fabs(vb[k]);
    if (p->diffusion == SPH_DIFFUSION_FOURTAKAS) gx += p->f[k] / (p->cs * p->cs) * x->x[k];
  }
  Add(&s->ds, V * vx * f, V * vxmag * fmag, V * (vxmag * df + vmag1 * x->dx * fabs(f)));
  if (p->diffusion != SPH_DIFFUSION_NONE && fa && fb) {
    const double c = 2.0 * p->delta * p->cs * p->h * V, e = fabs(t->s[a]) + fabs(t->s[b]) + fabs(gx);
    Add(&s->dd, c * (t->s[a] - t->s[b] - gx) * f, c * e * fmag, c * (e * df + fabs(f) * 3.0 * x->dx * 10.0 / (p->cs * p->cs)));
  }
  const double P = -t->m[b] * (Pa + Pb), Pmag = t->m[b] * (fabs(Pa) + fabs(Pb)),
               Perr = t->m[b] * PressureError(r) * (1.0 / (ra * ra) + 1.0 / (rb * rb));
  const double soft = x->r2 + p->epsilon * p->h * p->h;
  double c = 0.0, art = 0.0, artmag = 0.0, artpos = 0.0;
  if (p->viscosity == SPH_VISCOSITY_ARTIFICIAL) {
    const double k = t->m[b] * p->alpha * p->cs * p->h / (0.5 * (ra + rb) * soft);
    art = k * PetscMin(wx, 0.0);
    artmag = k * wxmag;
    artpos = k * wmag1 * x->dx + artmag * 2.0 * x->r * x->dx * 3.0 / soft;
  } else
    c = 2.0 * p->mupair * t->m[b] * x->r2 / soft /
        (p->viscosity == SPH_VISCOSITY_MORRIS ? ra * rb : 0.25 * (ra + rb) * (ra + rb));
  for (int k = 0; k < 3; k++) {
    const double w = va[k] - vb[k], wm = fabs(va[k]) + fabs(vb[k]), xk = fabs(x->x[k]);
    Add(&s->a[k], (P + art) * f * x->x[k] + c * f * w, (Pmag + artmag) * fmag * xk + c * fmag * wm,
        (Pmag + artmag) * (df * xk + fabs(f) * x->dx) + artpos * fabs(f) * xk + Perr * fabs(f) * xk +
            c * wm * (df + fabs(f) * (x->r > 0.0 ? 6.0 * x->dx / x->r : 0.0)));
  }
}

static void CheckRates(const Ref *r, const char *scene)
{
  const Snapshot *t = r->t;
  double worst = 0.0;
  PetscInt bad = 0, checked = 0;

  for (PetscInt i = 0; i < t->n; i++) {
    RateSums s;
    memset(&s, 0, sizeof(s));
    if (t->group[i] == -2) continue;
    ForNeighbours(r, i, t->group[i] >= 0, RateTerm, &s);
    for (int k = 0; k < r->p->dim; k++) {
      const double b = Bound(&s.a[k], r->u), e = fabs(t->a[k][i] - s.a[k].v);
      bad += !(e <= b);
      worst = PetscMax(worst, b > 0.0 ? e / b : 0.0);
      checked++;
    }
    const double b = (1.0 + t->s[i]) * Bound(&s.ds, r->u) + Bound(&s.dd, r->u) + 8.0 * U2 * s.ds.mag,
                 e = fabs(t->ds[i] - (1.0 + t->s[i]) * s.ds.v - s.dd.v);
    bad += !(e <= b);
    worst = PetscMax(worst, b > 0.0 ? e / b : 0.0);
  }
  TEST(bad == 0 && checked > 100, "%s: %d of %d accelerations and density rates outside their bounds, worst error/bound %g",
       scene, (int)bad, (int)checked, worst);
  printf("  rates: worst error/bound %.3f\n", worst);
}

typedef struct {
  Sum w, wr, x[3], p, v[3], xsph[3], share; /* share: what XSPH takes from the marker's own velocity */
  double g[3];
} AuxSums;

static void WallTerm(const Ref *r, PetscInt a, PetscInt b, const Pair *x, void *ctx)
{
  AuxSums *s = (AuxSums *)ctx;
  double mag, drop = 0.0, dropmag = 0.0, drop1 = 0.0;
  const double w = W(r->p->kernel, x->q, &mag), dw = Change(W, r->p->kernel, x->q, x->dq), p = Pressure(r, b), rho = Rho(r, b);

  (void)a;
  for (int k = 0; k < 3; k++) {
    drop += rho * s->g[k] * x->x[k];
    dropmag += rho * fabs(s->g[k] * x->x[k]);
    drop1 += rho * fabs(s->g[k]);
    Add(&s->v[k], w * r->t->v[k][b], mag * fabs(r->t->v[k][b]), dw * fabs(r->t->v[k][b]));
    Add(&s->x[k], -w * rho * x->x[k], mag * rho * fabs(x->x[k]), rho * (dw * fabs(x->x[k]) + w * x->dx));
  }
  Add(&s->w, w, mag, dw);
  Add(&s->wr, w * rho, mag * rho, dw * rho);
  Add(&s->p, w * (p + drop), mag * (fabs(p) + dropmag), dw * (fabs(p) + dropmag) + w * (drop1 * x->dx + PressureError(r)));
}

static void XsphTerm(const Ref *r, PetscInt a, PetscInt b, const Pair *x, void *ctx)
{
  AuxSums *s = (AuxSums *)ctx;
  double mag;
  const double c = r->p->zeta * r->t->m[b] * 2.0 / (Rho(r, a) + Rho(r, b)) * r->p->wnorm;
  const double w = W(r->p->kernel, x->q, &mag), dw = Change(W, r->p->kernel, x->q, x->dq);

  Add(&s->share, c * w, c * mag, c * dw);
  for (int k = 0; k < 3; k++) {
    const double va = r->t->v[k][a], vb = r->t->v[k][b], m = fabs(va) + fabs(vb);
    Add(&s->xsph[k], c * w * (vb - va), c * mag * m, c * dw * m);
  }
}

/* r->t: state before the sweep; out: rates and boundary densities after it. */
static void CheckAuxiliary(const Ref *r, const Snapshot *out, const char *scene)
{
  const SphParams *p = r->p;
  const Snapshot *t = r->t;
  double worst = 0.0;
  PetscInt bad = 0, walls = 0;

  for (PetscInt i = 0; i < t->n; i++) {
    AuxSums s;
    double err[4] = {0.0}, bound[4] = {0.0};
    memset(&s, 0, sizeof(s));
    if (t->group[i] == -1) {
      ForNeighbours(r, i, 0, XsphTerm, &s);
      for (int k = 0; k < p->dim; k++) {
        /* of its own velocity a marker keeps at least half of the part 1 - zeta that it keeps in an undisturbed fluid */
        const double most = 1.0 - 0.5 * (1.0 - p->zeta), over = s.share.v > most ? most / s.share.v : 1.0;
        err[k] = fabs(out->dv[k][i] - over * s.xsph[k].v);
        bound[k] = over * Bound(&s.xsph[k], r->u);
        if (s.share.v > most) bound[k] += over * fabs(s.xsph[k].v) * (Bound(&s.share, r->u) / s.share.v + 4.0 * r->u);
      }
    } else if (p->wall == SPH_WALL_ADAMI) {
      for (int k = 0; k < p->dim; k++) s.g[k] = p->f[k] - t->ab[k][i];
      ForNeighbours(r, i, 1, WallTerm, &s);
      if (s.w.v < 1e-4) continue; /* at the threshold below which a wall marker counts as dry */
      for (int k = 0; k < p->dim; k++) {
        const double *o = t->omega + 3 * (i - t->nfluid); /* v + omega x (<x> - x) */
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        const double wall = t->v[k][i] + (o[l] * s.x[m].v - o[m] * s.x[l].v) / s.wr.v;
        err[k] = fabs(out->dv[k][i] - t->ratio[i] * (wall - s.v[k].v / s.w.v));
        bound[k] = t->ratio[i] * (QuotientBound(&s.v[k], &s.w, r->u) + fabs(o[l]) * QuotientBound(&s.x[m], &s.wr, r->u) +
                                  fabs(o[m]) * QuotientBound(&s.x[l], &s.wr, r->u)) +
                   8.0 * U2;
      }
      const double pw = PetscMax(s.p.v / s.w.v - p->pb, -0.9 * p->B), sw = pow(1.0 + pw / p->B, 1.0 / p->gamma) - 1.0;
      err[3] = fabs(out->s[i] - sw);
      bound[3] =
          QuotientBound(&s.p, &s.w, r->u) / (p->B * p->gamma) * pow(1.0 + pw / p->B, 1.0 / p->gamma - 1.0) * 1.01 + 16.0 * U2;
      walls++;
    }
    for (int k = 0; k < 4; k++) {
      bad += !(err[k] <= bound[k]);
      worst = PetscMax(worst, bound[k] > 0.0 ? err[k] / bound[k] : 0.0);
    }
  }
  TEST(bad == 0 && (walls > 5 || p->wall == SPH_WALL_BCE),
       "%s: %d values of XSPH or of %d extrapolated wall markers outside their bounds, worst error/bound %g", scene, (int)bad,
       (int)walls, worst);
  printf("  auxiliary: worst error/bound %.3f\n", worst);
}

typedef struct {
  Sum m, v;
} DensitySums;

static void DensityTerm(const Ref *r, PetscInt a, PetscInt b, const Pair *x, void *ctx)
{
  DensitySums *s = (DensitySums *)ctx;
  double mag;
  const double c = r->t->m[b] / Rho(r, b) * r->p->wnorm, w = W(r->p->kernel, x->q, &mag),
               dw = Change(W, r->p->kernel, x->q, x->dq), sb = r->t->s[b];

  (void)a;
  Add(&s->m, c * w * sb, c * mag * fabs(sb), c * dw * fabs(sb));
  Add(&s->v, c * w, c * mag, c * dw);
}

static void CheckReinit(const Ref *r, const Snapshot *out, const char *scene)
{
  double worst = 0.0;
  PetscInt bad = 0;

  for (PetscInt i = 0; i < r->t->n; i++) {
    DensitySums s;
    double want, bound;
    if (r->t->group[i] != -1) continue;
    memset(&s, 0, sizeof(s));
    ForNeighbours(r, i, 0, DensityTerm, &s);
    if (r->p->reinit == SPH_REINIT_SHEPARD) {
      want = s.m.v / s.v.v;
      bound = QuotientBound(&s.m, &s.v, r->u) + 4.0 * U2;
    } else {
      want = s.m.v + s.v.v - 1.0;
      bound = Bound(&s.m, r->u) + Bound(&s.v, r->u) + 4.0 * U2;
    }
    bad += !(fabs(out->s[i] - want) <= bound);
    worst = PetscMax(worst, fabs(out->s[i] - want) / bound);
  }
  TEST(bad == 0, "%s: %d re-initialised densities outside their bounds, worst error/bound %g", scene, (int)bad, worst);
  printf("  density sum: worst error/bound %.3f\n", worst);
}

static PetscErrorCode CheckForcesAndLimits(Sph sph, const Snapshot *t, const char *scene)
{
  PetscReal *f, vmax, amax, v2 = 0.0, a2 = 0.0;
  PetscInt bad = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * (size_t)sph->n, &f));
  for (PetscInt g = 0; g < sph->ngroups; g++) {
    PetscCall(SphGetBoundaryForce(sph, g, f));
    for (PetscInt i = sph->groupstart[g]; i < sph->groupstart[g + 1]; i++)
      for (int k = 0; k < 3; k++) bad += f[3 * (i - sph->groupstart[g]) + k] != t->m[i] * t->a[k][i];
  }
  TEST(bad == 0, "%s: %d boundary forces differ from mass times acceleration", scene, (int)bad);
  PetscCall((*sph->ops->limits)(sph, &vmax, &amax));
  for (PetscInt i = 0; i < t->n; i++) {
    double v = 0.0, a = 0.0;
    for (int k = 0; k < sph->par.dim; k++) {
      v += t->v[k][i] * t->v[k][i];
      if (t->group[i] == -1) a += PetscSqr(t->a[k][i] + sph->par.f[k]);
    }
    v2 = PetscMax(v2, v);
    a2 = PetscMax(a2, a);
  }
  TEST_REL(vmax, sqrt(v2), 8.0 * U2, "largest speed");
  TEST_REL(amax, sqrt(a2), 8.0 * U2, "largest acceleration");
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckSums(Sph sph, const Scene *c)
{
  const SphParams *p = &sph->par;
  Snapshot before, after, last;
  Ref r = {.p = p, .u = p->precision == SPH_PRECISION_SINGLE ? 0x1p-24 : U2, .edge = 2.5 * p->h};

  PetscFunctionBegin;
  for (int k = 0; k < p->dim; k++) {
    const double L = p->hi[k] - p->lo[k];
    r.far = PetscMax(r.far, L + 4.0 * p->h);
    if (p->periodic[k]) r.edge = PetscMax(r.edge, L / PetscMax(1.0, floor(L / (2.5 * p->h))));
  }
  PetscCall(SceneMoveBody(sph, c, 1e-4));
  PetscCall(SceneTurnBody(sph, c));
  PetscCall(Take(sph, &before));
  PetscCall((*sph->ops->rates)(sph));
  PetscCall(Take(sph, &after));
  r.t = &before;
  CheckAuxiliary(&r, &after, c->name);
  r.t = &after;
  CheckRates(&r, c->name);
  PetscCall(CheckForcesAndLimits(sph, &after, c->name));
  if (p->reinit != SPH_REINIT_NONE) {
    PetscCall((*sph->ops->reinit)(sph));
    PetscCall(Take(sph, &last));
    CheckReinit(&r, &last, c->name);
    PetscCall(Drop(&last));
  }
  PetscCall(Drop(&before));
  PetscCall(Drop(&after));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#endif
