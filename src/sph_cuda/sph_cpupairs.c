/*
  sph_cpupairs.c - pair sums on the CPU; compiled once with SPH_PAIRS_single and once with SPH_PAIRS_double.

  For each cell the candidates of its 27 neighbour cells are copied once into a tile of contiguous arrays, fluid first, with
  positions relative to the centre of the cell; periodic images become plain offsets. Each marker of the cell then selects
  its neighbours from the tile (sphsimd.h) and sums over them in SIMD. A marker's sum is made by one thread in a fixed order: results do not
  depend on the number of threads.
*/
#if defined(SPH_PAIRS_single)
typedef float sphreal;
  #define SPH_SWEEP_NAME SphCpuSweep_single
#else
typedef double sphreal;
  #define SPH_SWEEP_NAME SphCpuSweep_double
#endif

#include <math.h>
#include "sph_cpu.h"
#include "sphpair.h"
#include "sphsimd.h"
#include <omp.h>

#if defined(SPH_PAIRS_single)
  #define SPH_SQRT sqrtf
  #if defined(SPH_HAVE_FILTER_FLOAT)
    #define SphFilter sph_filter_float
  #else
SPH_FILTER_SCALAR(SphFilter, float)
  #endif
#else
  #define SPH_SQRT sqrt
SPH_FILTER_SCALAR(SphFilter, double)
#endif

#define SPH_TINY ((sphreal)1e-12)

typedef struct {
  sphreal *q[SPH_NQ];
  int     *idx;
  int      nfluid, n;
} Tile;

/* Fill the prepared arrays from the state; p is what the sweep wants in SPH_Q_P. */
static void Prepare(Sph sph, SphCpu *cpu, SphSweep sweep)
{
  const SphGrid   *g = &cpu->grid;
  const SphParams *par = &sph->par;
  sphreal         *base = (sphreal *)cpu->q;
  sphreal         *q[SPH_NQ];
  const int        ncell = g->n[0] * g->n[1] * g->n[2];

  for (int k = 0; k < SPH_NQ; k++) q[k] = base + (size_t)k * (size_t)cpu->stride;
#pragma omp parallel for schedule(static)
  for (int c = 0; c < ncell; c++) {
    const int cc[3] = {c % g->n[0], c / g->n[0] % g->n[1], c / (g->n[0] * g->n[1])};
    for (int i = cpu->cellstart[2 * c]; i < cpu->cellstart[2 * c + 2]; i++) {
      const PetscBool boundary = sph->group[i] >= 0 ? PETSC_TRUE : PETSC_FALSE;
      const double    rho = par->rho0 * (1.0 + sph->st.s[i]);
      const double    p = sph_eos(sph->st.s[i], par->B, par->gamma) + par->pb;
      for (int k = 0; k < 3; k++) {
        const double v = sph->st.v[k][i], w = sweep == SPH_SWEEP_AUX ? v : v + sph->rate.dv[k][i];
        q[SPH_Q_X + k][i] = k < par->dim ? (sphreal)sph_cell_offset(g, k, cc[k], sph->st.x[k][i]) : (sphreal)0;
        q[SPH_Q_U + k][i] = (sphreal)(boundary ? v : w);
        q[SPH_Q_V + k][i] = (sphreal)(boundary ? w : v);
      }
      q[SPH_Q_M][i] = (sphreal)sph->m[i];
      q[SPH_Q_RHO][i] = (sphreal)rho;
      q[SPH_Q_VOL][i] = (sphreal)(sph->m[i] / rho);
      q[SPH_Q_P][i] = (sphreal)(sweep == SPH_SWEEP_RATES ? p / (rho * rho) : p);
    }
  }
}

static inline void TileAppend(Tile *t, const sphreal *base, PetscInt stride, int j0, int j1, const sphreal off[3])
{
  const int n = j1 - j0, at = t->n;
  for (int k = 0; k < 3; k++) {
    const sphreal *restrict src = base + (size_t)k * (size_t)stride + j0;
    sphreal *restrict dst = t->q[k] + at;
    for (int j = 0; j < n; j++) dst[j] = src[j] + off[k];
  }
  for (int k = 3; k < SPH_NQ; k++) {
    const sphreal *restrict src = base + (size_t)k * (size_t)stride + j0;
    sphreal *restrict dst = t->q[k] + at;
    for (int j = 0; j < n; j++) dst[j] = src[j];
  }
  t->n = at + n;
}

/* Candidates of cell (cx,cy,cz): pass 0 fluid, pass 1 boundary markers. */
static void TileGather(const SphCpu *cpu, int cx, int cy, int cz, Tile *t)
{
  const SphGrid *g = &cpu->grid;
  t->n = 0;
  for (int pass = 0; pass < 2; pass++) {
    for (int o = 0; o < 27; o++) {
      const int ox = o % 3 - 1, oy = o / 3 % 3 - 1, oz = o / 9 - 1;
      const int nx = sph_cell_neighbour(g, 0, cx, ox), ny = sph_cell_neighbour(g, 1, cy, oy), nz = sph_cell_neighbour(g, 2, cz, oz);
      if (nx < 0 || ny < 0 || nz < 0) continue;
      const int     d = 2 * sph_cell_index(g, nx, ny, nz) + pass;
      const sphreal off[3] = {(sphreal)(ox * g->edge[0]), (sphreal)(oy * g->edge[1]), (sphreal)(oz * g->edge[2])};
      if (cpu->cellstart[d] < cpu->cellstart[d + 1]) TileAppend(t, (const sphreal *)cpu->q, cpu->stride, cpu->cellstart[d], cpu->cellstart[d + 1], off);
    }
    if (!pass) t->nfluid = t->n;
  }
}

/* Shepard-type sums that the auxiliary sweep gives: XSPH for fluid, Adami et al. (2012), Eqs. 22-27, for boundary markers. */
SPH_INLINE void AuxFluid(const SphPairConst *c, const int kernel, const Tile *t, int m, Sph sph, int i, const sphreal *const xi, const sphreal *const vi, sphreal rhoi)
{
  sphreal sx = 0, sy = 0, sz = 0;
#pragma omp simd reduction(+ : sx, sy, sz)
  for (int k = 0; k < m; k++) {
    const int     j = t->idx[k];
    const sphreal dx = xi[0] - t->q[SPH_Q_X][j], dy = xi[1] - t->q[SPH_Q_X + 1][j], dz = xi[2] - t->q[SPH_Q_X + 2][j];
    const sphreal q = SPH_SQRT(dx * dx + dy * dy + dz * dz) * c->hinv;
    const sphreal w = sph_xsph(t->q[SPH_Q_M][j], rhoi, t->q[SPH_Q_RHO][j], c->wnorm * sph_w(kernel, q));
    sx += w * (t->q[SPH_Q_V][j] - vi[0]);
    sy += w * (t->q[SPH_Q_V + 1][j] - vi[1]);
    sz += w * (t->q[SPH_Q_V + 2][j] - vi[2]);
  }
  sph->rate.dv[0][i] = (double)(c->zeta * sx);
  sph->rate.dv[1][i] = (double)(c->zeta * sy);
  sph->rate.dv[2][i] = (double)(c->zeta * sz);
}

SPH_INLINE void AuxBoundary(const SphPairConst *c, const int kernel, const Tile *t, int m, Sph sph, int i, const sphreal *const xi)
{
  const SphParams *par = &sph->par;
  sphreal          sw = 0, sp = 0, vx = 0, vy = 0, vz = 0, rx = 0, ry = 0, rz = 0;
#pragma omp simd reduction(+ : sw, sp, vx, vy, vz, rx, ry, rz)
  for (int k = 0; k < m; k++) {
    const int     j = t->idx[k];
    const sphreal dx = xi[0] - t->q[SPH_Q_X][j], dy = xi[1] - t->q[SPH_Q_X + 1][j], dz = xi[2] - t->q[SPH_Q_X + 2][j];
    const sphreal w = sph_w(kernel, SPH_SQRT(dx * dx + dy * dy + dz * dz) * c->hinv), wr = w * t->q[SPH_Q_RHO][j];
    sw += w;
    sp += w * t->q[SPH_Q_P][j];
    vx += w * t->q[SPH_Q_V][j];
    vy += w * t->q[SPH_Q_V + 1][j];
    vz += w * t->q[SPH_Q_V + 2][j];
    rx += wr * dx;
    ry += wr * dy;
    rz += wr * dz;
  }
  if (sw <= (sphreal)1e-6) { /* no fluid near */
    for (int k = 0; k < 3; k++) sph->rate.dv[k][i] = 0.0;
    sph->st.s[i] = sph_eos_inverse(-par->pb, par->B, par->gamma);
    return;
  }
  const double inv = 1.0 / (double)sw, v[3] = {(double)vx * inv, (double)vy * inv, (double)vz * inv};
  double       p = (double)sp * inv;
  p += ((par->f[0] - sph->ab[0][i]) * (double)rx + (par->f[1] - sph->ab[1][i]) * (double)ry + (par->f[2] - sph->ab[2][i]) * (double)rz) * inv;
  for (int k = 0; k < 3; k++) sph->rate.dv[k][i] = sph->wallratio[i] * (sph->st.v[k][i] - v[k]);
  sph->st.s[i] = sph_eos_inverse(PetscMax(p - par->pb, -0.9 * par->B), par->B, par->gamma);
}

/* Eqs. 4-6 for marker i over its m neighbours. */
SPH_INLINE void Rates(const SphPairConst *c, const int kernel, const Tile *t, int m, Sph sph, int i, const sphreal *const own)
{
  const sphreal xi = own[0], yi = own[1], zi = own[2], ux = own[SPH_Q_U], uy = own[SPH_Q_U + 1], uz = own[SPH_Q_U + 2], vx = own[SPH_Q_V], vy = own[SPH_Q_V + 1], vz = own[SPH_Q_V + 2];
  const sphreal rho = own[SPH_Q_RHO], P = own[SPH_Q_P];
  sphreal       ax = 0, ay = 0, az = 0, ds = 0;
#pragma omp simd reduction(+ : ax, ay, az, ds)
  for (int k = 0; k < m; k++) {
    const int     j = t->idx[k];
    const sphreal dx = xi - t->q[SPH_Q_X][j], dy = yi - t->q[SPH_Q_X + 1][j], dz = zi - t->q[SPH_Q_X + 2][j];
    const sphreal r2 = dx * dx + dy * dy + dz * dz;
    const sphreal F = c->fnorm * sph_f(kernel, SPH_SQRT(r2) * c->hinv);
    const sphreal mb = t->q[SPH_Q_M][j];
    const sphreal ex = ux - t->q[SPH_Q_U][j], ey = uy - t->q[SPH_Q_U + 1][j], ez = uz - t->q[SPH_Q_U + 2][j];
    const sphreal fp = sph_pressure(mb, P, t->q[SPH_Q_P][j], F);
    const sphreal fv = sph_viscosity(c, mb, rho, t->q[SPH_Q_RHO][j], r2, F);
    ds += sph_continuity(t->q[SPH_Q_VOL][j], ex * dx + ey * dy + ez * dz, F);
    ax += fp * dx + fv * (vx - t->q[SPH_Q_V][j]);
    ay += fp * dy + fv * (vy - t->q[SPH_Q_V + 1][j]);
    az += fp * dz + fv * (vz - t->q[SPH_Q_V + 2][j]);
  }
  sph->rate.a[0][i] = (double)ax;
  sph->rate.a[1][i] = (double)ay;
  sph->rate.a[2][i] = (double)az;
  sph->rate.ds[i] = (1.0 + sph->st.s[i]) * (double)ds;
}

/* Eq. 9: sum of m_b W into ds; normalised by the sum of V_b W when Shepard is asked. */
SPH_INLINE void Sum(const SphPairConst *c, const int kernel, const Tile *t, int m, Sph sph, int i, const sphreal *const xi)
{
  sphreal sm = 0, sv = 0;
#pragma omp simd reduction(+ : sm, sv)
  for (int k = 0; k < m; k++) {
    const int     j = t->idx[k];
    const sphreal dx = xi[0] - t->q[SPH_Q_X][j], dy = xi[1] - t->q[SPH_Q_X + 1][j], dz = xi[2] - t->q[SPH_Q_X + 2][j];
    const sphreal W = c->wnorm * sph_w(kernel, SPH_SQRT(dx * dx + dy * dy + dz * dz) * c->hinv);
    sm += t->q[SPH_Q_VOL][j] * (t->q[SPH_Q_RHO][j] - c->rho0) * W;
    sv += t->q[SPH_Q_VOL][j] * W;
  }
  if (sph->par.reinit == SPH_REINIT_SHEPARD) sph->rate.ds[i] = (double)(sm / (sv * c->rho0));
  else sph->rate.ds[i] = (double)sm / (double)c->rho0 + (double)sv - 1.0;
}

/* All markers of one cell. Boundary markers see fluid only; they take no part in a SUM sweep. */
SPH_INLINE void SweepCell(const SphPairConst *c, const int kernel, const SphSweep sweep, Sph sph, const SphCpu *cpu, int cell, Tile *t)
{
  const SphGrid *g = &cpu->grid;
  const int      i0 = cpu->cellstart[2 * cell], ib = cpu->cellstart[2 * cell + 1], i1 = cpu->cellstart[2 * cell + 2];
  const sphreal *base = (const sphreal *)cpu->q;
  const int      onlywalls = sweep == SPH_SWEEP_AUX && sph->par.zeta == 0.0;

  if (i0 == i1 || (onlywalls && ib == i1)) return;
  TileGather(cpu, cell % g->n[0], cell / g->n[0] % g->n[1], cell / (g->n[0] * g->n[1]), t);
  for (int i = i0; i < i1; i++) {
    const int boundary = i >= ib;
    sphreal   own[SPH_NQ];
    if (boundary ? sweep == SPH_SWEEP_SUM || (sweep == SPH_SWEEP_AUX && sph->par.wall != SPH_WALL_ADAMI) : onlywalls) continue;
    for (int k = 0; k < SPH_NQ; k++) own[k] = base[(size_t)k * (size_t)cpu->stride + (size_t)i];
    const int m = SphFilter(t->q[0], t->q[1], t->q[2], boundary ? t->nfluid : t->n, own[0], own[1], own[2], c->r2max, t->idx);
    if (sweep == SPH_SWEEP_RATES) Rates(c, kernel, t, m, sph, i, own);
    else if (sweep == SPH_SWEEP_SUM) Sum(c, kernel, t, m, sph, i, own);
    else if (boundary) AuxBoundary(c, kernel, t, m, sph, i, own);
    else AuxFluid(c, kernel, t, m, sph, i, own, own + SPH_Q_V, own[SPH_Q_RHO]);
  }
}

static void SweepAll(const SphPairConst *c, const int kernel, const SphSweep sweep, Sph sph, const SphCpu *cpu)
{
  const int ncell = cpu->grid.n[0] * cpu->grid.n[1] * cpu->grid.n[2];
#pragma omp parallel num_threads((int)cpu->threads)
  {
    char *mem = (char *)cpu->tiles + (size_t)omp_get_thread_num() * cpu->tilebytes;
    Tile  t;
    for (int k = 0; k < SPH_NQ; k++) t.q[k] = (sphreal *)mem + (size_t)k * (size_t)cpu->tilecap;
    t.idx = (int *)((sphreal *)mem + (size_t)SPH_NQ * (size_t)cpu->tilecap);
#define SPH_CELLS(K, S) \
  _Pragma("omp for schedule(dynamic, 8)") for (int cell = 0; cell < ncell; cell++) SweepCell(c, K, S, sph, cpu, cell, &t)
    if (kernel) {
      if (sweep == SPH_SWEEP_RATES) SPH_CELLS(1, SPH_SWEEP_RATES);
      else if (sweep == SPH_SWEEP_AUX) SPH_CELLS(1, SPH_SWEEP_AUX);
      else SPH_CELLS(1, SPH_SWEEP_SUM);
    } else {
      if (sweep == SPH_SWEEP_RATES) SPH_CELLS(0, SPH_SWEEP_RATES);
      else if (sweep == SPH_SWEEP_AUX) SPH_CELLS(0, SPH_SWEEP_AUX);
      else SPH_CELLS(0, SPH_SWEEP_SUM);
    }
#undef SPH_CELLS
  }
}

PetscErrorCode SPH_SWEEP_NAME(Sph sph, SphSweep sweep)
{
  const SphParams *p = &sph->par;
  const double     norm = sph_norm(p->kernel, (int)p->dim, p->h);
  SphCpu          *cpu = (SphCpu *)sph->data;
  SphPairConst     c;

  PetscFunctionBegin;
  c.hinv = (sphreal)(1.0 / p->h);
  c.r2max = (sphreal)(4.0 * p->h * p->h);
  c.wnorm = (sphreal)norm;
  c.fnorm = (sphreal)(norm / (p->h * p->h));
  c.mu2 = (sphreal)(2.0 * p->mupair);
  c.epsh2 = (sphreal)(p->epsilon * p->h * p->h);
  c.zeta = (sphreal)p->zeta;
  c.rho0 = (sphreal)p->rho0;
  Prepare(sph, cpu, sweep);
  SweepAll(&c, p->kernel, sweep, sph, cpu);
  PetscFunctionReturn(PETSC_SUCCESS);
}
