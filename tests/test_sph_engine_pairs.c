/*
  test_sph_engine_pairs.c - every pair sum of the engine against brute force over all pairs and images.

  Markers: a lattice jittered by up to 0.2 dp with random velocities, densities and boundary accelerations; the lower layers are
  boundary markers where the case has walls. Bound per field: (2 N + 64) epsilon amplitude, N the number of terms, epsilon that of
  the pair arithmetic; the derivation stands in sphbrute.h, the factor 2 is for sums over values that are sums themselves (XSPH
  and wall velocities). -sph_type runs it on another backend.
*/
#include <float.h>
#include "sphbrute.h"
#include "testing.h"

typedef struct {
  const char *name;
  int dim, kernel;
  int periodic[3];
  double length[3]; /* sides in units of 2h */
  double hratio;
  int wall, walls;
  double zeta;
  int viscosity, diffusion, precision;
} Case;

static const Case cases[] = {
    {"3D open, RK2 defaults without walls", 3, 0, {0, 0, 0}, {3.3, 2.6, 2.2}, 1.2, SPH_WALL_ADAMI, 0, 0.5, 0, 0, 0},
    {"3D open, adami walls, Wendland", 3, 1, {0, 0, 0}, {3.3, 2.6, 2.2}, 1.2, SPH_WALL_ADAMI, 1, 0.5, 0, 0, 0},
    {"3D periodic, 1 and 2 cells, adami", 3, 0, {1, 0, 1}, {1.2, 3.0, 2.3}, 1.3, SPH_WALL_ADAMI, 1, 0.3, 1, 0, 0},
    {"3D periodic, all 1 cell", 3, 1, {1, 1, 1}, {1.1, 1.3, 1.6}, 1.5, SPH_WALL_BCE, 0, 0.0, 2, 2, 0},
    {"3D bench: bce, artificial", 3, 1, {0, 0, 0}, {2.4, 2.2, 1.9}, 1.7320508, SPH_WALL_BCE, 1, 0.0, 2, 0, 0},
    {"3D bench: bce, artificial, diffusion", 3, 1, {0, 0, 0}, {2.4, 2.2, 1.9}, 1.7320508, SPH_WALL_BCE, 1, 0.0, 2, 1, 0},
    {"3D bench: cubic, Fourtakas, XSPH", 3, 0, {0, 0, 0}, {2.4, 2.2, 1.9}, 1.7320508, SPH_WALL_BCE, 1, 0.5, 2, 2, 0},
    {"3D Morris, diffusion, adami", 3, 0, {0, 1, 0}, {2.4, 2.2, 1.9}, 1.4, SPH_WALL_ADAMI, 1, 0.5, 1, 1, 0},
    {"3D Wendland, XSPH in full", 3, 1, {0, 0, 0}, {2.4, 2.2, 1.9}, 1.4, SPH_WALL_ADAMI, 1, 1.0, 0, 0, 0},
    {"2D open, adami", 2, 0, {0, 0, 0}, {6.3, 5.2, 0}, 1.2, SPH_WALL_ADAMI, 1, 0.5, 0, 0, 0},
    {"2D periodic 2 cells, bce, Wendland", 2, 1, {1, 0, 0}, {2.4, 5.2, 0}, 1.3, SPH_WALL_BCE, 1, 0.5, 1, 2, 0},
    {"3D closed box with XSPH, double", 3, 0, {1, 1, 1}, {1.4, 2.3, 3.2}, 1.2, SPH_WALL_BCE, 0, 0.5, 0, 0, 1},
    {"2D periodic 1 cell both", 2, 0, {1, 1, 0}, {1.15, 1.9, 0}, 2.0, SPH_WALL_BCE, 0, 0.0, 0, 1, 0},
    {"2D double, adami, Fourtakas", 2, 0, {1, 0, 0}, {3.4, 5.2, 0}, 1.2, SPH_WALL_ADAMI, 1, 0.5, 0, 2, 1},
    {"3D double, adami", 3, 1, {0, 1, 0}, {2.4, 2.2, 1.9}, 1.2, SPH_WALL_ADAMI, 1, 0.5, 1, 0, 1},
    {"3D double, bce, artificial, diffusion", 3, 0, {1, 0, 0}, {2.4, 2.2, 1.9}, 1.7320508, SPH_WALL_BCE, 1, 0.0, 2, 1, 1},
};

static unsigned seed;

/* Uniform in [-1,1]; its own generator, so that every machine has the same markers. */
static double Random(void)
{
  seed = seed * 1664525u + 1013904223u;
  return (double)(seed >> 8) / 8388608.0 - 1.0;
}

typedef struct {
  int n, nfluid;
  double *x, *v, *ab, *p, *vol, *depth;
} Markers;

static PetscErrorCode Fill(const Case *c, double dp, const double hi[3], Markers *k)
{
  int n[3], total = 1, pass, m = 0;

  PetscFunctionBegin;
  for (int d = 0; d < 3; d++) {
    n[d] = d < c->dim ? (int)lround(hi[d] / dp) : 1;
    total *= n[d];
  }
  PetscCall(PetscMalloc6(3 * (size_t)total, &k->x, 3 * (size_t)total, &k->v, 3 * (size_t)total, &k->ab, total, &k->p, total,
                         &k->vol, total, &k->depth));
  for (pass = 0; pass < 2; pass++) {
    for (int s = 0; s < total; s++) {
      const int i[3] = {s % n[0], s / n[0] % n[1], s / (n[0] * n[1])}, wall = c->walls && i[1] < 3;
      if (wall != pass) continue;
      for (int d = 0; d < 3; d++) {
        k->x[3 * m + d] = d < c->dim ? (i[d] + 0.5 + 0.2 * Random()) * hi[d] / n[d] : 0.0;
        k->v[3 * m + d] = d < c->dim ? 0.5 * Random() : 0.0;
        k->ab[3 * m + d] = d < c->dim ? 5.0 * Random() : 0.0;
      }
      k->p[m] = 1000.0 * Random();
      k->vol[m] = pow(dp, c->dim) * (1.0 + 0.2 * Random());
      k->depth[m] = (2.5 - i[1]) * dp;
      m++;
    }
    if (!pass) k->nfluid = m;
  }
  k->n = m;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Make(const Case *c, Markers *k, Sph *out)
{
  const double dp = 0.01, h = c->hratio * dp;
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {c->length[0] * 2 * h, c->length[1] * 2 * h, c->length[2] * 2 * h},
                  f[3] = {1.5, -9.81, c->dim == 3 ? 0.7 : 0.0};
  const PetscBool periodic[3] = {(PetscBool)c->periodic[0], (PetscBool)c->periodic[1], (PetscBool)c->periodic[2]};
  PetscInt g;
  Sph sph;

  PetscFunctionBegin;
  PetscCall(SphCreate(PETSC_COMM_SELF, &sph));
  PetscCall(SphSetDimension(sph, c->dim));
  PetscCall(SphSetSpacing(sph, dp));
  PetscCall(SphSetSmoothingRatio(sph, c->hratio));
  PetscCall(SphSetSoundSpeed(sph, 20.0));
  PetscCall(SphSetViscosity(sph, 0.5));
  PetscCall(
      SphSetLatticeNormalisation(sph, PETSC_FALSE)); /* textbook kernels; test_sph_engine_kernels looks at the normalised ones */
  PetscCall(SphSetViscosityType(sph, (SphViscosityType)c->viscosity));
  PetscCall(SphSetArtificialViscosity(sph, 0.2));
  PetscCall(SphSetDensityDiffusion(sph, (SphDiffusionType)c->diffusion, 0.15));
  PetscCall(SphSetKernel(sph, (SphKernelType)c->kernel));
  PetscCall(SphSetPrecision(sph, (SphPrecision)c->precision));
  PetscCall(SphSetWall(sph, (SphWallType)c->wall));
  PetscCall(SphSetXSPH(sph, c->zeta));
  PetscCall(SphSetBodyForce(sph, f));
  PetscCall(SphSetBackgroundPressure(sph, 50.0));
  PetscCall(SphSetDomain(sph, lo, hi));
  PetscCall(SphSetPeriodic(sph, periodic));
  PetscCall(SphSetFromOptions(sph));
  PetscCall(Fill(c, dp, hi, k));
  PetscCall(SphAddFluid(sph, k->nfluid, k->x, k->v, k->p));
  if (k->n > k->nfluid)
    PetscCall(SphAddBoundary(sph, k->n - k->nfluid, k->x + 3 * k->nfluid, k->v + 3 * k->nfluid, k->vol + k->nfluid,
                             k->depth + k->nfluid, &g));
  PetscCall(SphSetUp(sph));
  if (k->n > k->nfluid)
    PetscCall(SphSetBoundaryMotion(sph, 0, k->x + 3 * k->nfluid, k->v + 3 * k->nfluid, k->ab + 3 * k->nfluid));
  *out = sph;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The reference wants the arrays in added order; positions as the solver holds them (wrapped), densities before the evaluation.
 */
static PetscErrorCode MakeBrute(Sph sph, const Markers *k, Brute *b)
{
  int *boundary;
  double *m, *x, *v;

  PetscFunctionBegin;
  PetscCall(PetscCalloc7(3 * (size_t)k->n, &x, 3 * (size_t)k->n, &v, k->n, &boundary, k->n, &m, k->n, &b->s, 3 * (size_t)k->n,
                         &b->u, 3 * (size_t)k->n, &b->w));
  for (int id = 0; id < k->n; id++) {
    const int i = sph->slot[id];
    for (int d = 0; d < 3; d++) {
      x[3 * id + d] = sph->st.x[d][i];
      v[3 * id + d] = sph->st.v[d][i];
    }
    boundary[id] = id >= k->nfluid;
    m[id] = sph->m[i];
    b->s[id] = sph->st.s[i];
  }
  b->p = &sph->par;
  b->n = k->n;
  b->x = x;
  b->v = v;
  b->ab = k->ab;
  b->boundary = boundary;
  b->m = m;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Largest error over its bound, per field. */
enum { F_A, F_DS, F_DV, F_WALLV, F_WALLP, F_SUM, NF };
static const char *const field[NF] = {"acceleration",  "density rate",  "XSPH velocity",
                                      "wall velocity", "wall pressure", "density sum"};

static void Compare(double got, double want, double bound, double *worst)
{
  const double r = fabs(got - want) / bound;
  if (!(r <= *worst)) *worst = r;
}

static void CheckAux(Sph sph, const Markers *k, Brute *b, const BruteSums *aux, double eps, double worst[NF])
{
  const SphParams *p = &sph->par;
  for (int id = 0; id < k->n; id++) {
    const int i = sph->slot[id];
    const BruteSums *o = &aux[id];
    const double tol = (2.0 * o->n + 64.0) * eps;
    if (!b->boundary[id]) {
      for (int d = 0; d < p->dim; d++) Compare(SphValue(&sph->rate.dv[d], i), o->dv[d], tol * o->Adv + 1e-300, &worst[F_DV]);
    } else if (p->wall == SPH_WALL_ADAMI) {
      const double sw = o->dv[0], norm = BruteW(p->kernel, (int)p->dim, p->h, 0.0);
      if (sw < 1e-3 * norm) continue; /* the kernel sum itself has no digits there */
      for (int d = 0; d < p->dim; d++)
        Compare(SphValue(&sph->rate.dv[d], i), sph->wallratio[i] * (b->v[3 * id + d] - o->wv[d] / sw),
                tol * sph->wallratio[i] * o->Awv / sw * 2.0 * o->n * 0.3 * norm / sw, &worst[F_WALLV]);
      Compare(BrutePressure(p, sph->st.s[i]), o->wp / sw, tol * o->Awp / sw * (1.0 + o->n * 0.3 * norm / sw), &worst[F_WALLP]);
    }
  }
}

/* Velocities and densities of the second sweep, as the reference has them. */
static void SecondSweepValues(const SphParams *p, const Sph sph, const Markers *k, Brute *b, const BruteSums *aux)
{
  for (int id = 0; id < k->n; id++) {
    const int i = sph->slot[id];
    for (int d = 0; d < 3; d++) {
      b->u[3 * id + d] = b->w[3 * id + d] = b->v[3 * id + d];
      if (d >= p->dim) continue;
      if (!b->boundary[id])
        b->u[3 * id + d] += aux[id].dv[d];
      else if (p->wall == SPH_WALL_ADAMI)
        b->w[3 * id + d] += SphValue(&sph->rate.dv[d], i); /* checked above, where it has digits */
    }
    if (b->boundary[id] && p->wall == SPH_WALL_ADAMI) b->s[id] = sph->st.s[i];
  }
}

/* Closed periodic boxes of fluid only: pair forces cancel, as does the momentum that XSPH moves; what is left are the rounding
 * errors of the terms. */
static void CheckMomentum(const Case *c, Sph sph, const Brute *b, const BruteSums *aux, double eps)
{
  double p[3] = {0}, q[3] = {0}, bound = 0.0, xbound = 0.0;
  if (c->walls || !c->periodic[0] || !c->periodic[1] || (c->dim == 3 && !c->periodic[2])) return;
  for (int id = 0; id < b->n; id++) {
    const int i = sph->slot[id];
    BruteSums o = {0};
    BruteLoop(b, id, BruteRates, &o);
    bound += b->m[id] * o.A * (2.0 * o.n + 64.0) * eps;
    xbound += b->m[id] * aux[id].Adv * (2.0 * o.n + 64.0) * eps;
    for (int d = 0; d < 3; d++) {
      p[d] += b->m[id] * SphValue(&sph->rate.a[d], i);
      q[d] += b->m[id] * SphValue(&sph->rate.dv[d], i);
    }
  }
  printf("  momentum rate of the closed box: %.2g of its bound, XSPH: %.2g\n", BruteNorm3(p) / bound,
         c->zeta > 0.0 ? BruteNorm3(q) / xbound : 0.0);
  TEST(BruteNorm3(p) <= bound, "%s: sum of m a is %g N, round-off allows %g", c->name, BruteNorm3(p), bound);
  if (c->zeta > 0.0)
    TEST(BruteNorm3(q) <= xbound, "%s: sum of m dv of XSPH is %g, round-off allows %g", c->name, BruteNorm3(q), xbound);
}

static PetscErrorCode RunCase(const Case *c)
{
  const double eps = c->precision == SPH_PRECISION_SINGLE ? FLT_EPSILON : DBL_EPSILON;
  double worst[NF] = {0}, *before;
  BruteSums *aux;
  Markers k;
  Brute b;
  Sph sph;
  int terms = 0;

  PetscFunctionBegin;
  seed = 12345u + (unsigned)(c - cases);
  PetscCall(Make(c, &k, &sph));
  PetscCall((*sph->ops->pull)(sph));
  PetscCall(MakeBrute(sph, &k, &b));
  PetscCall(PetscCalloc2(k.n, &aux, k.n, &before));
  PetscCall((*sph->ops->rates)(sph));
  PetscCall((*sph->ops->pull)(sph));
  for (int id = 0; id < k.n; id++) {
    BruteLoop(&b, id, BruteAux, &aux[id]);
    if (!b.boundary[id]) BruteCrowd(&sph->par, &aux[id]);
  }
  CheckAux(sph, &k, &b, aux, eps, worst);
  SecondSweepValues(&sph->par, sph, &k, &b, aux);
  for (int id = 0; id < k.n; id++) {
    const int i = sph->slot[id];
    BruteSums o = {0};
    BruteLoop(&b, id, BruteRates, &o);
    const double tol = (2.0 * o.n + 64.0) * eps;
    if (o.n == 0) continue;
    terms = o.n > terms ? o.n : terms;
    for (int d = 0; d < 3; d++) Compare(SphValue(&sph->rate.a[d], i), o.a[d], tol * o.A, &worst[F_A]);
    if (!b.boundary[id] || sph->par.wall == SPH_WALL_BCE) Compare(SphValue(&sph->rate.ds, i), o.ds, tol * o.Ads, &worst[F_DS]);
  }
  CheckMomentum(c, sph, &b, aux, eps);
  for (int shepard = 0; shepard < 2; shepard++) {
    sph->par.reinit = shepard ? SPH_REINIT_SHEPARD : SPH_REINIT_SUM;
    for (int id = 0; id < k.n; id++) before[id] = b.s[id] = sph->st.s[sph->slot[id]];
    PetscCall((*sph->ops->reinit)(sph));
    PetscCall((*sph->ops->pull)(sph));
    for (int id = 0; id < k.nfluid; id++) {
      BruteSums o = {0};
      BruteLoop(&b, id, BruteAux, &o);
      Compare(sph->st.s[sph->slot[id]], shepard ? o.shepard / o.wsum : o.sum - 1.0,
              (2.0 * o.n + 64.0) * eps * o.Asum / (shepard ? o.wsum : 1.0), &worst[F_SUM]);
    }
  }
  printf("%-38s %5d markers, %3d terms, worst error/bound:", c->name, k.n, terms);
  for (int f = 0; f < NF; f++) {
    printf(" %.3f", worst[f]);
    TEST(worst[f] <= 1.0, "%s: %s is %g times its bound off", c->name, field[f], worst[f]);
  }
  printf("\n");
  PetscCall(PetscFree2(aux, before));
  PetscCall(PetscFree7(b.x, b.v, b.boundary, b.m, b.s, b.u, b.w));
  PetscCall(PetscFree6(k.x, k.v, k.ab, k.p, k.vol, k.depth));
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  printf("fields: acceleration, density rate, XSPH velocity, wall velocity, wall pressure, density sum\n");
  for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) PetscCall(RunCase(&cases[i]));
  PetscCall(PetscFinalize());
  return test_report();
}
