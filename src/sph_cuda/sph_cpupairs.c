/*
  sph_cpupairs.c - pair sums on the CPU; compiled once with SPH_PAIRS_single and once with SPH_PAIRS_double.

  Markers are sorted by cell and, within a cell, along a Hilbert curve, so that SPH_GROUP consecutive ones lie close together. For
  each such group the markers within 2h of its bounding box are copied from the 27 neighbour cells into a short list of contiguous
  arrays (sphsimd.h), positions relative to the centre of the group's cell, periodic images as plain offsets. Each marker of the
  group then sums over the whole list in SIMD: about half of it lies inside its own support, the kernel is zero for the rest. A
  marker's sum is made by one thread in a fixed order: results do not depend on the number of threads.
*/
#if defined(SPH_PAIRS_single)
typedef float sphreal;
  #define SPH_NAME(name) name##_single
  #define SPH_VALUES(a) ((a).f)
  #define SPH_SQRT sqrtf
#else
typedef double sphreal;
  #define SPH_NAME(name) name##_double
  #define SPH_VALUES(a) ((a).d)
  #define SPH_SQRT sqrt
#endif

#include <math.h>
#include "sph_cpu.h"
#include "sphopenimpl.h"
#include "sphpair.h"
#include "sphsimd.h"
#include <omp.h>

typedef struct {
  sphreal *q[SPH_NQ_MAX];
  int n; /* a multiple of 16 */
} List;

/* What a sweep needs everywhere. */
typedef struct {
  SphPairConst c;
  Sph sph;
  const SphCpu *cpu;
  sphreal *q[SPH_NQ_MAX];
  sphreal *box[6]; /* of batches: lo, hi; numbered from firstbox of a range on */
} Sweep;

typedef void (*Kernel)(const Sweep *w, const List *l, int i);

/* Fill the quantities of markers [i0,i1) of one cell, all fluid or all boundary. */
SPH_INLINE void PrepareRange(Sph sph, const SphCpu *cpu, sphreal *const *q, const int cc[3], int i0, int i1, int boundary,
                             int afteraux)
{
  const SphGrid *g = &cpu->grid;
  const SphParams *par = &sph->par;
  const int uv = SphTwoVelocities(par);

  for (int k = 0; k < 3; k++) {
    const double *restrict x = sph->st.x[k], *restrict v = sph->st.v[k];
    const sphreal *restrict dv = SPH_VALUES(sph->rate.dv[k]);
    if (!afteraux) {
      if (k >= par->dim)
        for (int i = i0; i < i1; i++) q[SPH_Q_X + k][i] = (sphreal)0;
      else
        for (int i = i0; i < i1; i++) q[SPH_Q_X + k][i] = (sphreal)sph_cell_offset(g, k, cc[k], x[i]);
      for (int i = i0; i < i1; i++) q[SPH_Q_V + k][i] = (sphreal)v[i];
      if (uv)
        for (int i = i0; i < i1; i++) q[SPH_Q_U + k][i] = (sphreal)v[i];
    } else {
      sphreal *restrict moved = q[(boundary ? SPH_Q_V : SPH_Q_U) + k];
      for (int i = i0; i < i1; i++) moved[i] = (sphreal)(v[i] + (double)dv[i]);
    }
  }
  if (afteraux && !boundary) return;
  for (int i = i0; i < i1; i++) {
    const double s = sph->st.s[i], rho = par->rho0 * (1.0 + s), p = sph_eos(s, par->B, par->gamma) + par->pb;
    q[SPH_Q_S][i] = (sphreal)s;
    q[SPH_Q_VOL][i] = (sphreal)(sph->m[i] / rho);
    q[SPH_Q_P][i] = (sphreal)(p / (rho * rho));
  }
  if (par->diffusion != SPH_DIFFUSION_NONE)
    for (int i = i0; i < i1; i++) q[SPH_Q_DIF(uv)][i] = boundary ? (sphreal)0 : q[SPH_Q_VOL][i];
}

/* Bounding boxes of the batches of markers [i0,i1), the first of which has number b, in the frame of their cell. */
static void BoundBatches(sphreal *const *q, sphreal *const *box, int b, int i0, int i1)
{
  for (int a = i0; a < i1; a += SPH_BATCH, b++)
    for (int k = 0; k < 3; k++) {
      sphreal lo = q[k][a], hi = lo;
      for (int i = a + 1; i < i1 && i < a + SPH_BATCH; i++) {
        lo = q[k][i] < lo ? q[k][i] : lo;
        hi = q[k][i] > hi ? q[k][i] : hi;
      }
      box[k][b] = lo;
      box[3 + k][b] = hi;
    }
}

static void Pointers(const SphCpu *cpu, sphreal *q[SPH_NQ_MAX], sphreal *box[6])
{
  for (int k = 0; k < 6; k++) box[k] = (sphreal *)cpu->boxes + (size_t)k * (size_t)cpu->boxcap;
  for (int k = 0; k < SPH_NQ_MAX; k++) q[k] = (sphreal *)cpu->q + (size_t)PetscMin(k, cpu->nq - 1) * (size_t)cpu->stride;
}

void SPH_NAME(SphCpuPrepare)(Sph sph, int afteraux)
{
  const SphCpu *cpu = (const SphCpu *)sph->data;
  const SphGrid *g = &cpu->grid;
  const int ncell = g->n[0] * g->n[1] * g->n[2];
  sphreal *q[SPH_NQ_MAX], *box[6];

  Pointers(cpu, q, box);
#pragma omp parallel for schedule(static) num_threads((int)cpu->threads)
  for (int c = 0; c < ncell; c++) {
    const int *s = cpu->cellstart + 2 * c, cc[3] = {c % g->n[0], c / g->n[0] % g->n[1], c / (g->n[0] * g->n[1])};
    if (s[0] < s[1]) PrepareRange(sph, cpu, q, cc, s[0], s[1], 0, afteraux);
    if (s[1] < s[2]) PrepareRange(sph, cpu, q, cc, s[1], s[2], 1, afteraux);
    for (int kind = 0; kind < 2 && !afteraux; kind++) BoundBatches(q, box, cpu->firstbox[2 * c + kind], s[kind], s[kind + 1]);
  }
}

/* Eqs. 4-6 for marker i over its list. uv: two velocities; visc: SphViscosityType; diff: with density diffusion. */
SPH_INLINE void Rates(const int kernel, const int visc, const int uv, const int diff, const Sweep *w, const List *l, int i)
{
  const SphPairConst c = w->c;
  sphreal *const *l_q = l->q;
  const sphreal *restrict X = l_q[0], *restrict Y = l_q[1], *restrict Z = l_q[2], *restrict VX = l_q[SPH_Q_V],
                          *restrict VY = l_q[SPH_Q_V + 1], *restrict VZ = l_q[SPH_Q_V + 2];
  const sphreal *restrict S = l_q[SPH_Q_S], *restrict VOL = l_q[SPH_Q_VOL], *restrict P = l_q[SPH_Q_P];
  const sphreal *restrict UX = l_q[SPH_Q_U], *restrict UY = l_q[SPH_Q_U + 1], *restrict UZ = l_q[SPH_Q_U + 2],
                          *restrict D = l_q[SPH_Q_DIF(uv)];
  const sphreal xi = w->q[0][i], yi = w->q[1][i], zi = w->q[2][i], vx = w->q[SPH_Q_V][i], vy = w->q[SPH_Q_V + 1][i],
                vz = w->q[SPH_Q_V + 2][i];
  const sphreal si = w->q[SPH_Q_S][i], Pi = w->q[SPH_Q_P][i], rho = c.rho0 + c.rho0 * si;
  const sphreal ux = uv ? w->q[SPH_Q_U][i] : vx, uy = uv ? w->q[SPH_Q_U + 1][i] : vy, uz = uv ? w->q[SPH_Q_U + 2][i] : vz;
  sphreal ax = 0, ay = 0, az = 0, ds = 0, dd = 0;
#pragma omp simd reduction(+ : ax, ay, az, ds, dd)
  for (int j = 0; j < l->n; j++) {
    const sphreal dx = xi - X[j], dy = yi - Y[j], dz = zi - Z[j];
    const sphreal r2 = dx * dx + dy * dy + dz * dz;
    const sphreal F = c.fnorm * sph_f(kernel, SPH_SQRT(r2) * c.hinv);
    const sphreal ex = vx - VX[j], ey = vy - VY[j], ez = vz - VZ[j], rhoj = c.rho0 + c.rho0 * S[j], mj = VOL[j] * rhoj;
    const sphreal evx = ex * dx + ey * dy + ez * dz;
    const sphreal eux = uv ? (ux - UX[j]) * dx + (uy - UY[j]) * dy + (uz - UZ[j]) * dz : evx;
    const sphreal fp = sph_pressure(mj, Pi, P[j], F);
    ds += sph_continuity(VOL[j], eux, F);
    if (diff) dd += sph_diffusion(&c, D[j], si, S[j], c.g[0] * dx + c.g[1] * dy + c.g[2] * dz, F);
    if (visc == SPH_VISCOSITY_ARTIFICIAL) {
      const sphreal f = fp + sph_viscosity_artificial(&c, mj, rho, rhoj, evx, r2, F);
      ax += f * dx;
      ay += f * dy;
      az += f * dz;
    } else {
      const sphreal fv =
          visc == SPH_VISCOSITY_MORRIS ? sph_viscosity_morris(&c, mj, rho, rhoj, r2, F) : sph_viscosity(&c, mj, rho, rhoj, r2, F);
      ax += fp * dx + fv * ex;
      ay += fp * dy + fv * ey;
      az += fp * dz + fv * ez;
    }
  }
  const double change = diff && w->sph->group[i] == -1 ? (double)dd : 0.0;
  SPH_VALUES(w->sph->rate.a[0])[i] = ax;
  SPH_VALUES(w->sph->rate.a[1])[i] = ay;
  SPH_VALUES(w->sph->rate.a[2])[i] = az;
  SPH_VALUES(w->sph->rate.ds)[i] = (sphreal)((1.0 + w->sph->st.s[i]) * (double)ds + change);
}

/* XSPH velocity of a fluid marker, Eq. 11. */
SPH_INLINE void AuxFluid(const int kernel, const Sweep *w, const List *l, int i)
{
  const SphPairConst c = w->c;
  const sphreal *restrict X = l->q[0], *restrict Y = l->q[1], *restrict Z = l->q[2], *restrict VX = l->q[SPH_Q_V],
                          *restrict VY = l->q[SPH_Q_V + 1], *restrict VZ = l->q[SPH_Q_V + 2];
  const sphreal *restrict S = l->q[SPH_Q_S], *restrict VOL = l->q[SPH_Q_VOL];
  const sphreal xi = w->q[0][i], yi = w->q[1][i], zi = w->q[2][i], vx = w->q[SPH_Q_V][i], vy = w->q[SPH_Q_V + 1][i],
                vz = w->q[SPH_Q_V + 2][i];
  const sphreal rho = c.rho0 + c.rho0 * w->q[SPH_Q_S][i];
  sphreal sw = 0, sx = 0, sy = 0, sz = 0;
  if (SphIsZone(w->sph->group[i])) { /* moves as its opening says */
    for (int k = 0; k < 3; k++) SPH_VALUES(w->sph->rate.dv[k])[i] = 0;
    return;
  }
#pragma omp simd reduction(+ : sw, sx, sy, sz)
  for (int j = 0; j < l->n; j++) {
    const sphreal dx = xi - X[j], dy = yi - Y[j], dz = zi - Z[j], rhoj = c.rho0 + c.rho0 * S[j];
    const sphreal f = sph_xsph(VOL[j] * rhoj, rho, rhoj, c.wnorm * sph_w(kernel, SPH_SQRT(dx * dx + dy * dy + dz * dz) * c.hinv));
    sw += f;
    sx += f * (VX[j] - vx);
    sy += f * (VY[j] - vy);
    sz += f * (VZ[j] - vz);
  }
  const sphreal zeta = sph_xsph_factor(c.zeta, sw);
  SPH_VALUES(w->sph->rate.dv[0])[i] = zeta * sx;
  SPH_VALUES(w->sph->rate.dv[1])[i] = zeta * sy;
  SPH_VALUES(w->sph->rate.dv[2])[i] = zeta * sz;
}

/* Shifting velocity of a fluid marker, at most V_max/2, added to that of Eq. 11. */
SPH_INLINE void Shift(const int kernel, const Sweep *w, const List *l, int i)
{
  const SphPairConst c = w->c;
  const SphParams *par = &w->sph->par;
  const sphreal *restrict X = l->q[0], *restrict Y = l->q[1], *restrict Z = l->q[2], *restrict VOL = l->q[SPH_Q_VOL];
  const sphreal xi = w->q[0][i], yi = w->q[1][i], zi = w->q[2][i];
  sphreal px = 0, py = 0, pz = 0, div = 0;
  if (SphIsZone(w->sph->group[i])) return;
#pragma omp simd reduction(+ : px, py, pz, div)
  for (int j = 0; j < l->n; j++) {
    const sphreal dx = xi - X[j], dy = yi - Y[j], dz = zi - Z[j], r2 = dx * dx + dy * dy + dz * dz;
    const sphreal q = SPH_SQRT(r2) * c.hinv, F = c.fnorm * sph_f(kernel, q), g = sph_shift(&c, VOL[j], sph_w(kernel, q), F);
    div -= VOL[j] * r2 * F;
    px += g * dx;
    py += g * dy;
    pz += g * dz;
  }
  const double u = sqrt((double)(px * px + py * py + pz * pz)), most = 0.5 * par->vmax;
  const double keep = sph_shift_keep((double)div, (double)par->dim) * (u > most ? most / u : 1.0);
  SPH_VALUES(w->sph->rate.dv[0])[i] += (sphreal)(keep * (double)px);
  SPH_VALUES(w->sph->rate.dv[1])[i] += (sphreal)(keep * (double)py);
  SPH_VALUES(w->sph->rate.dv[2])[i] += (sphreal)(keep * (double)pz);
}

/* Exact gradients of linear fields for a fluid marker in place of those of Eqs. 4 and 5; there is shifting, so U is there. */
SPH_INLINE void Correct(const int kernel, const Sweep *w, const List *l, int i)
{
  const SphPairConst c = w->c;
  const sphreal *restrict X = l->q[0], *restrict Y = l->q[1], *restrict Z = l->q[2], *restrict VX = l->q[SPH_Q_U],
                          *restrict VY = l->q[SPH_Q_U + 1], *restrict VZ = l->q[SPH_Q_U + 2];
  const sphreal *restrict S = l->q[SPH_Q_S], *restrict VOL = l->q[SPH_Q_VOL], *restrict P = l->q[SPH_Q_P];
  const sphreal xi = w->q[0][i], yi = w->q[1][i], zi = w->q[2][i], vx = w->q[SPH_Q_U][i], vy = w->q[SPH_Q_U + 1][i],
                vz = w->q[SPH_Q_U + 2][i];
  const sphreal rho = c.rho0 + c.rho0 * w->q[SPH_Q_S][i], Pi = w->q[SPH_Q_P][i], p = Pi * rho * rho;
  sphreal mxx = 0, myy = 0, mzz = 0, mxy = 0, myz = 0, mzx = 0, gx = 0, gy = 0, gz = 0, sx = 0, sy = 0, sz = 0;
  sphreal txx = 0, txy = 0, txz = 0, tyx = 0, tyy = 0, tyz = 0, tzx = 0, tzy = 0, tzz = 0;
#pragma omp simd reduction(+ : mxx, myy, mzz, mxy, myz, mzx, gx, gy, gz, sx, sy, sz, txx, txy, txz, tyx, tyy, tyz, tzx, tzy, tzz)
  for (int j = 0; j < l->n; j++) {
    const sphreal dx = xi - X[j], dy = yi - Y[j], dz = zi - Z[j], r2 = dx * dx + dy * dy + dz * dz;
    const sphreal F = c.fnorm * sph_f(kernel, SPH_SQRT(r2) * c.hinv), f = VOL[j] * F, rhoj = c.rho0 + c.rho0 * S[j];
    const sphreal fg = f * (P[j] * rhoj * rhoj - p), fs = sph_pressure(VOL[j] * rhoj, Pi, P[j], F);
    const sphreal ex = f * (VX[j] - vx), ey = f * (VY[j] - vy), ez = f * (VZ[j] - vz);
    mxx -= f * dx * dx;
    myy -= f * dy * dy;
    mzz -= f * dz * dz;
    mxy -= f * dx * dy;
    myz -= f * dy * dz;
    mzx -= f * dz * dx;
    gx += fg * dx;
    gy += fg * dy;
    gz += fg * dz;
    sx += fs * dx;
    sy += fs * dy;
    sz += fs * dz;
    txx += ex * dx;
    txy += ex * dy;
    txz += ex * dz;
    tyx += ey * dx;
    tyy += ey * dy;
    tyz += ey * dz;
    tzx += ez * dx;
    tzy += ez * dy;
    tzz += ez * dz;
  }
  const SphGradientSums sums = {
      {mxx, myy, mzz, mxy, myz, mzx}, {gx, gy, gz}, {sx, sy, sz}, {txx, txy, txz, tyx, tyy, tyz, tzx, tzy, tzz}};
  double a[3], div;
  sph_gradient_correct((int)w->sph->par.dim, (double)rho, &sums, a, &div);
  for (int k = 0; k < 3; k++) SPH_VALUES(w->sph->rate.a[k])[i] += (sphreal)a[k];
  SPH_VALUES(w->sph->rate.ds)[i] += (sphreal)((1.0 + w->sph->st.s[i]) * div);
}

/* Pressure (as density) and velocity of a boundary marker: Adami, Hu, Adams, J. Comput. Phys. 231 (2012), Eqs. 22-27. */
SPH_INLINE void AuxBoundary(const int kernel, const Sweep *w, const List *l, int i)
{
  const SphPairConst c = w->c;
  Sph sph = w->sph;
  const SphParams *par = &sph->par;
  const sphreal *restrict X = l->q[0], *restrict Y = l->q[1], *restrict Z = l->q[2], *restrict VX = l->q[SPH_Q_V],
                          *restrict VY = l->q[SPH_Q_V + 1], *restrict VZ = l->q[SPH_Q_V + 2];
  const sphreal *restrict S = l->q[SPH_Q_S], *restrict P = l->q[SPH_Q_P];
  const sphreal xi = w->q[0][i], yi = w->q[1][i], zi = w->q[2][i];
  sphreal sw = 0, sr = 0, sp = 0, vx = 0, vy = 0, vz = 0, rx = 0, ry = 0, rz = 0;
#pragma omp simd reduction(+ : sw, sr, sp, vx, vy, vz, rx, ry, rz)
  for (int j = 0; j < l->n; j++) {
    const sphreal dx = xi - X[j], dy = yi - Y[j], dz = zi - Z[j], rho = c.rho0 + c.rho0 * S[j];
    const sphreal W = sph_w(kernel, SPH_SQRT(dx * dx + dy * dy + dz * dz) * c.hinv), wr = W * rho;
    sw += W;
    sr += wr;
    sp += wr * rho * P[j];
    vx += W * VX[j];
    vy += W * VY[j];
    vz += W * VZ[j];
    rx += wr * dx;
    ry += wr * dy;
    rz += wr * dz;
  }
  if (sw <= (sphreal)1e-6) { /* no fluid near */
    for (int k = 0; k < 3; k++) SPH_VALUES(sph->rate.dv[k])[i] = 0;
    sph->st.s[i] = sph_eos_inverse(-par->pb, par->B, par->gamma);
    return;
  }
  const double inv = 1.0 / (double)sw, v[3] = {(double)vx * inv, (double)vy * inv, (double)vz * inv},
               offset[3] = {-(double)(rx / sr), -(double)(ry / sr), -(double)(rz / sr)};
  double p = (double)sp * inv, dv[3];
  p += ((par->f[0] - sph->ab[0][i]) * (double)rx + (par->f[1] - sph->ab[1][i]) * (double)ry +
        (par->f[2] - sph->ab[2][i]) * (double)rz) *
       inv;
  sph_wall_velocity(sph->wallratio[i], (const double[3]){sph->st.v[0][i], sph->st.v[1][i], sph->st.v[2][i]}, v,
                    sph->omega + 3 * (sph->id[i] - sph->nfluid), offset, dv);
  for (int k = 0; k < 3; k++) SPH_VALUES(sph->rate.dv[k])[i] = (sphreal)dv[k];
  sph->st.s[i] = sph_eos_inverse(PetscMax(p - par->pb, -0.9 * par->B), par->B, par->gamma);
}

/* Eq. 9: sum of m_b W into ds; normalised by the sum of V_b W when Shepard is asked. */
SPH_INLINE void Sum(const int kernel, const Sweep *w, const List *l, int i)
{
  const SphPairConst c = w->c;
  const sphreal *restrict X = l->q[0], *restrict Y = l->q[1], *restrict Z = l->q[2], *restrict S = l->q[SPH_Q_S],
                          *restrict VOL = l->q[SPH_Q_VOL];
  const sphreal xi = w->q[0][i], yi = w->q[1][i], zi = w->q[2][i];
  sphreal sm = 0, sv = 0;
#pragma omp simd reduction(+ : sm, sv)
  for (int j = 0; j < l->n; j++) {
    const sphreal dx = xi - X[j], dy = yi - Y[j], dz = zi - Z[j];
    const sphreal VW = VOL[j] * (c.wnorm * sph_w(kernel, SPH_SQRT(dx * dx + dy * dy + dz * dz) * c.hinv));
    sm += S[j] * VW;
    sv += VW;
  }
  if (w->sph->par.reinit == SPH_REINIT_SHEPARD)
    SPH_VALUES(w->sph->rate.ds)[i] = sm / sv;
  else
    SPH_VALUES(w->sph->rate.ds)[i] = (sphreal)((double)sm + (double)sv - 1.0);
}

/* The batches of the 27 cells around cell cc, fluid ones first, in its frame. */
static void CollectBatches(const Sweep *w, const int cc[3], SphBatches *b)
{
  const SphGrid *g = &w->cpu->grid;

  b->n = 0;
  for (int kind = 0; kind < 2; kind++) {
    for (int o = 0; o < 27; o++) {
      const int ox = o % 3 - 1, oy = o / 3 % 3 - 1, oz = o / 9 - 1;
      const int nx = sph_cell_neighbour(g, 0, cc[0], ox), ny = sph_cell_neighbour(g, 1, cc[1], oy),
                nz = sph_cell_neighbour(g, 2, cc[2], oz);
      if (nx < 0 || ny < 0 || nz < 0) continue;
      const int r = 2 * sph_cell_index(g, nx, ny, nz) + kind, j0 = w->cpu->cellstart[r], j1 = w->cpu->cellstart[r + 1],
                s0 = w->cpu->firstbox[r];
      const sphreal off[3] = {(sphreal)(ox * g->edge[0]), (sphreal)(oy * g->edge[1]), (sphreal)(oz * g->edge[2])};
      for (int a = j0, s = s0; a < j1; a += SPH_BATCH, s++, b->n++) {
        for (int k = 0; k < 3; k++) {
          b->lo[k][b->n] = w->box[k][s] + off[k];
          b->hi[k][b->n] = w->box[3 + k][s] + off[k];
          b->off[k][b->n] = off[k];
        }
        b->first[b->n] = a;
        b->count[b->n] = PetscMin(SPH_BATCH, j1 - a);
      }
    }
    if (kind == 0) b->nfluid = b->n;
  }
}

/* Copy what lies within 2h of markers [i0,i1) of the cell into the list; fluidonly leaves boundary markers out. */
SPH_INLINE void Gather(const int nq, const Sweep *w, const SphBatches *b, int i0, int i1, int fluidonly, List *l)
{
  SphBox box;
  int m = 0, near;

  for (int k = 0; k < 3; k++) {
    box.lo[k] = box.hi[k] = w->q[k][i0];
    for (int i = i0 + 1; i < i1; i++) {
      box.lo[k] = w->q[k][i] < box.lo[k] ? w->q[k][i] : box.lo[k];
      box.hi[k] = w->q[k][i] > box.hi[k] ? w->q[k][i] : box.hi[k];
    }
  }
  near = SphNear(b, fluidonly ? b->nfluid : b->n, &box, w->c.r2max);
  for (int a = 0; a < near; a++) {
    const int k = b->near[a];
    const sphreal off[3] = {b->off[0][k], b->off[1][k], b->off[2][k]};
    m = SphSelect(nq, w->q, b->first[k], b->count[k], off, &box, w->c.r2max, l->q, m);
  }
  l->n = SphPad(nq, (sphreal)100 / w->c.hinv, l->q, m);
}

static void GatherAny(const int nq, const Sweep *w, const SphBatches *b, int i0, int i1, int fluidonly, List *l)
{
  if (nq == SPH_NQ_BASE)
    Gather(SPH_NQ_BASE, w, b, i0, i1, fluidonly, l);
  else if (nq == SPH_NQ_BASE + 1)
    Gather(SPH_NQ_BASE + 1, w, b, i0, i1, fluidonly, l);
  else if (nq == SPH_NQ_BASE + 3)
    Gather(SPH_NQ_BASE + 3, w, b, i0, i1, fluidonly, l);
  else
    Gather(SPH_NQ_BASE + 4, w, b, i0, i1, fluidonly, l);
}

/* Sums of one sweep for markers [i0,i1) of a cell, in groups. */
static void SweepRange(const Sweep *w, Kernel kernel, int nq, const SphBatches *batches, int i0, int i1, int fluidonly, List *l)
{
  for (int a = i0; a < i1; a += SPH_GROUP) {
    const int b = PetscMin(a + SPH_GROUP, i1);
    GatherAny(nq, w, batches, a, b, fluidonly, l);
    for (int i = a; i < b; i++) kernel(w, l, i);
  }
}

/* Cut a thread's memory into its list and its batches. */
static void CutMemory(const SphCpu *cpu, int thread, List *l, SphBatches *b)
{
  const size_t nb = (size_t)cpu->batchcap;
  sphreal *mem = (sphreal *)(((uintptr_t)cpu->lists + 63) / 64 * 64 + (size_t)thread * cpu->listbytes);

  for (int k = 0; k < SPH_NQ_MAX; k++, mem += cpu->listcap) l->q[k] = mem;
  for (int k = 0; k < 3; k++, mem += 3 * nb) {
    b->lo[k] = mem;
    b->hi[k] = mem + nb;
    b->off[k] = mem + 2 * nb;
  }
  b->first = (int *)mem;
  b->count = b->first + nb;
  b->near = b->count + nb;
}

/* The loops above for each combination of compile-time choices. */
#define SPH_RATES(K, V, U, D)                                                                                                    \
  static void Rates_##K##V##U##D(const Sweep *w, const List *l, int i)                                                           \
  {                                                                                                                              \
    Rates(K, V, U, D, w, l, i);                                                                                                  \
  }
#define SPH_RATES_FORMS(K, V) SPH_RATES(K, V, 0, 0) SPH_RATES(K, V, 0, 1) SPH_RATES(K, V, 1, 0) SPH_RATES(K, V, 1, 1)
SPH_RATES_FORMS(0, 0)
SPH_RATES_FORMS(0, 1)
SPH_RATES_FORMS(0, 2)
SPH_RATES_FORMS(1, 0)
SPH_RATES_FORMS(1, 1)
SPH_RATES_FORMS(1, 2)
#define SPH_RATES_ROW(K, V)                                                                                                      \
  {                                                                                                                              \
    {Rates_##K##V##00, Rates_##K##V##01},                                                                                        \
    {                                                                                                                            \
      Rates_##K##V##10, Rates_##K##V##11                                                                                         \
    }                                                                                                                            \
  }
static const Kernel rates[2][3][2][2] = {{SPH_RATES_ROW(0, 0), SPH_RATES_ROW(0, 1), SPH_RATES_ROW(0, 2)},
                                         {SPH_RATES_ROW(1, 0), SPH_RATES_ROW(1, 1), SPH_RATES_ROW(1, 2)}};

#define SPH_OTHER(name)                                                                                                          \
  static void name##_0(const Sweep *w, const List *l, int i)                                                                     \
  {                                                                                                                              \
    name(0, w, l, i);                                                                                                            \
  }                                                                                                                              \
  static void name##_1(const Sweep *w, const List *l, int i)                                                                     \
  {                                                                                                                              \
    name(1, w, l, i);                                                                                                            \
  }
SPH_OTHER(Correct)
SPH_OTHER(AuxFluid)
SPH_OTHER(Shift)
SPH_OTHER(AuxBoundary)
SPH_OTHER(Sum)

/* Boundary markers see fluid only; they take no part in a SUM sweep. */
void SPH_NAME(SphCpuSweep)(Sph sph, SphSweep sweep)
{
  const SphParams *p = &sph->par;
  const SphCpu *cpu = (const SphCpu *)sph->data;
  const SphGrid *g = &cpu->grid;
  const int ncell = g->n[0] * g->n[1] * g->n[2],
            nq = sweep == SPH_SWEEP_RATES || sweep == SPH_SWEEP_CORRECT ? (int)cpu->nq : SPH_NQ_BASE;
  Kernel fluid = NULL, boundary = NULL;
  Sweep w = {.c = sph_pair_const(p), .sph = sph, .cpu = cpu};

  Pointers(cpu, w.q, w.box);
  if (sweep == SPH_SWEEP_RATES)
    fluid = boundary = rates[p->kernel][p->viscosity][SphTwoVelocities(p)][p->diffusion != SPH_DIFFUSION_NONE];
  else if (sweep == SPH_SWEEP_CORRECT)
    fluid = p->kernel ? Correct_1 : Correct_0;
  else if (sweep == SPH_SWEEP_SHIFT)
    fluid = p->kernel ? Shift_1 : Shift_0;
  else if (sweep == SPH_SWEEP_SUM)
    fluid = p->kernel ? Sum_1 : Sum_0;
  else {
    if (p->zeta > 0.0 || p->shifting != SPH_SHIFTING_NONE) fluid = p->kernel ? AuxFluid_1 : AuxFluid_0;
    if (p->wall == SPH_WALL_ADAMI) boundary = p->kernel ? AuxBoundary_1 : AuxBoundary_0;
  }
#pragma omp parallel num_threads((int)cpu->threads)
  {
    List l;
    SphBatches b;
    CutMemory(cpu, omp_get_thread_num(), &l, &b);
#pragma omp for schedule(dynamic, 8)
    for (int c = 0; c < ncell; c++) {
      const int *s = cpu->cellstart + 2 * c, cc[3] = {c % g->n[0], c / g->n[0] % g->n[1], c / (g->n[0] * g->n[1])};
      const int nf = fluid ? s[1] - s[0] : 0, nb = boundary ? s[2] - s[1] : 0;
      if (nf + nb == 0) continue;
      CollectBatches(&w, cc, &b);
      if (nf) SweepRange(&w, fluid, nq, &b, s[0], s[1], 0, &l);
      if (nb) SweepRange(&w, boundary, nq, &b, s[1], s[2], 1, &l);
    }
  }
}
