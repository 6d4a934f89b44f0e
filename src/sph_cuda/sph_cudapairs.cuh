/*
  sph_cudapairs.cuh - pair sums on the device; included once with sphreal = float and once with double.

  One thread per marker walks the cells around it; its sum is made by one thread in a fixed order, without atomics. Positions
  are stored relative to the centre of each marker's cell, neighbour cells add whole cell edges. The equations are those of
  sphpair.h; sph_cpupairs.c is the specification of each sum.
*/
#include "sph_cuda.cuh"
#include "sphpair.h"

struct alignas(16) Real4 {
  sphreal x, y, z, w;
};

/* Prepared quantities, each n long: x and m; velocity that moves densities and s; velocity in the viscous term and p/rho^2. */
typedef struct {
  Real4 *xm, *us, *vp;
} Prepared;

static __device__ __forceinline__ float Sqrt(float x)
{
  return sqrtf(x);
}
static __device__ __forceinline__ double Sqrt(double x)
{
  return sqrt(x);
}

/* s and p/rho^2 of marker i; double: a float holds too few digits of a small pressure. */
static __device__ __forceinline__ sphreal PressureTerm(const SphParams &par, double s)
{
  const double rho = par.rho0 * (1.0 + s);

  return (sphreal)((sph_eos(s, par.B, par.gamma) + par.pb) / (rho * rho));
}

/* Fill the prepared quantities from the state. */
static __global__ void PrepareKernel(SphCudaArrays d, SphGrid g, SphParams par, Prepared q)
{
  const int i = SPH_ITEM;

  if (i >= d.n || d.group[i] == -2) return;
  const int cell = (int)(d.key[i] >> 1);
  const int cc[3] = {cell % g.n[0], cell / g.n[0] % g.n[1], cell / (g.n[0] * g.n[1])};
  const double s = d.st.s[i];
  sphreal x[3], v[3];
  for (int k = 0; k < 3; k++) {
    x[k] = k < par.dim ? (sphreal)sph_cell_offset(&g, k, cc[k], d.st.x[k][i]) : (sphreal)0;
    v[k] = (sphreal)d.st.v[k][i];
  }
  q.xm[i] = Real4{x[0], x[1], x[2], (sphreal)d.m[i]};
  q.us[i] = Real4{v[0], v[1], v[2], (sphreal)s};
  q.vp[i] = Real4{v[0], v[1], v[2], PressureTerm(par, s)};
}

/* What an auxiliary sweep changes: the velocity that moves fluid; velocity in the viscous term, density and pressure of
 * boundaries. */
static __global__ void PrepareAfterAuxKernel(SphCudaArrays d, SphParams par, Prepared q)
{
  const int i = SPH_ITEM;
  sphreal w[3];

  if (i >= d.n || d.group[i] == -2) return;
  const double s = d.st.s[i];
  for (int k = 0; k < 3; k++) w[k] = (sphreal)(d.st.v[k][i] + d.rate.dv[k][i]);
  if (!(d.key[i] & 1u)) {
    q.us[i] = Real4{w[0], w[1], w[2], (sphreal)s};
    return;
  }
  q.us[i].w = (sphreal)s;
  q.vp[i] = Real4{w[0], w[1], w[2], PressureTerm(par, s)};
}

static __device__ __forceinline__ sphreal Density(const SphPairConst &c, sphreal s)
{
  return c.rho0 + c.rho0 * s;
}

/* term(j, j is fluid, x_ij, r^2, m_j) for the neighbours j of the marker with this key at x: of all kinds, or fluid only for a
 * boundary marker. */
template <class Term>
static __device__ __forceinline__ void ForNeighbours(const SphGrid &g, const sphreal r2max, const int *__restrict__ cellstart,
                                                     const Real4 *__restrict__ xm, const unsigned key, const Real4 &x, Term &term)
{
  const int cell = (int)(key >> 1), behind = (key & 1u) ? 1 : 2;
  const int cx = cell % g.n[0], cy = cell / g.n[0] % g.n[1], cz = cell / (g.n[0] * g.n[1]);
  const sphreal edge[3] = {(sphreal)g.edge[0], (sphreal)g.edge[1], (sphreal)g.edge[2]};

  for (int oz = -1; oz <= 1; oz++) {
    const int nz = sph_cell_neighbour(&g, 2, cz, oz);
    for (int oy = -1; oy <= 1; oy++) {
      const int ny = sph_cell_neighbour(&g, 1, cy, oy);
      for (int ox = -1; ox <= 1; ox++) {
        const int nx = sph_cell_neighbour(&g, 0, cx, ox);
        if (nx < 0 || ny < 0 || nz < 0) continue;
        const int c = 2 * sph_cell_index(&g, nx, ny, nz), boundary = cellstart[c + 1], last = cellstart[c + behind];
        const sphreal ex = x.x - (sphreal)ox * edge[0], ey = x.y - (sphreal)oy * edge[1], ez = x.z - (sphreal)oz * edge[2];
        for (int j = cellstart[c]; j < last; j++) {
          const Real4 b = xm[j];
          const sphreal dx = ex - b.x, dy = ey - b.y, dz = ez - b.z, r2 = dx * dx + dy * dy + dz * dz;
          if (r2 < r2max) term(j, j < boundary, dx, dy, dz, r2, b.w);
        }
      }
    }
  }
}

/* Eq. 11 for fluid marker i. */
template <int KERNEL>
static __device__ __forceinline__ void AuxFluid(const SphCudaArrays &d, const SphGrid &g, const SphPairConst &c,
                                                const Prepared &q, int i, unsigned key)
{
  const Real4 x = q.xm[i], a = q.us[i];
  const sphreal rhoa = Density(c, a.w);
  sphreal sw = 0, sx = 0, sy = 0, sz = 0;
  auto term = [&](int j, bool, sphreal, sphreal, sphreal, sphreal r2, sphreal mb) {
    const Real4 b = q.us[j];
    const sphreal w = sph_xsph(mb, rhoa, Density(c, b.w), c.wnorm * sph_w(KERNEL, Sqrt(r2) * c.hinv));
    sw += w;
    sx += w * (b.x - a.x);
    sy += w * (b.y - a.y);
    sz += w * (b.z - a.z);
  };

  ForNeighbours(g, c.r2max, d.cellstart, q.xm, key, x, term);
  const sphreal zeta = sph_xsph_factor(c.zeta, sw);
  d.rate.dv[0][i] = (double)(zeta * sx);
  d.rate.dv[1][i] = (double)(zeta * sy);
  d.rate.dv[2][i] = (double)(zeta * sz);
}

/* Sums over the fluid around a boundary marker: weights, weights times rho, pressure, velocity, rho x_ab. */
struct WallSums {
  sphreal w, wr, p, v[3], rx[3];
};

/* Adami, Hu, Adams (2012), Eqs. 22-27: extrapolated velocity and density of boundary marker i. */
static __device__ __forceinline__ void WallExtrapolate(const SphCudaArrays &d, const SphParams &par, const WallSums &s, int i)
{
  if (s.w <= (sphreal)1e-6) { /* no fluid near */
    for (int k = 0; k < 3; k++) d.rate.dv[k][i] = 0.0;
    d.st.s[i] = sph_eos_inverse(-par.pb, par.B, par.gamma);
    return;
  }
  const double inv = 1.0 / (double)s.w;
  double p = (double)s.p * inv, own[3], mean[3], offset[3], dv[3];
  for (int k = 0; k < 3; k++) {
    p += (par.f[k] - d.ab[k][i]) * (double)s.rx[k] * inv;
    own[k] = d.st.v[k][i];
    mean[k] = (double)s.v[k] * inv;
    offset[k] = -(double)(s.rx[k] / s.wr);
  }
  sph_wall_velocity(d.wallratio[i], own, mean, d.omega + 3 * (size_t)(d.id[i] - d.nfluid), offset, dv);
  for (int k = 0; k < 3; k++) d.rate.dv[k][i] = dv[k];
  const double ps = p - par.pb, least = -0.9 * par.B;
  d.st.s[i] = sph_eos_inverse(ps > least ? ps : least, par.B, par.gamma);
}

template <int KERNEL>
static __device__ __forceinline__ void AuxBoundary(const SphCudaArrays &d, const SphGrid &g, const SphParams &par,
                                                   const SphPairConst &c, const Prepared &q, int i, unsigned key)
{
  const Real4 x = q.xm[i];
  WallSums s = {0, 0, 0, {0, 0, 0}, {0, 0, 0}};
  auto term = [&](int j, bool, sphreal dx, sphreal dy, sphreal dz, sphreal r2, sphreal) {
    const Real4 b = q.us[j];
    const sphreal rho = Density(c, b.w), w = sph_w(KERNEL, Sqrt(r2) * c.hinv), wr = w * rho;
    s.w += w;
    s.wr += wr;
    s.p += wr * rho * q.vp[j].w;
    s.v[0] += w * b.x;
    s.v[1] += w * b.y;
    s.v[2] += w * b.z;
    s.rx[0] += wr * dx;
    s.rx[1] += wr * dy;
    s.rx[2] += wr * dz;
  };

  ForNeighbours(g, c.r2max, d.cellstart, q.xm, key, x, term);
  WallExtrapolate(d, par, s, i);
}

template <int KERNEL>
static __global__ void __launch_bounds__(SPH_BLOCK)
    AuxKernel(SphCudaArrays d, SphGrid g, SphParams par, SphPairConst c, Prepared q)
{
  const int i = SPH_ITEM;

  if (i >= d.n || d.group[i] == -2) return;
  const unsigned key = d.key[i];
  if (key & 1u) {
    if (par.wall == SPH_WALL_ADAMI) AuxBoundary<KERNEL>(d, g, par, c, q, i, key);
  } else if (par.zeta > 0.0)
    AuxFluid<KERNEL>(d, g, c, q, i, key);
}

/* Eqs. 4-6 for marker i; VISCOSITY is a SphViscosityType. */
template <int KERNEL, int VISCOSITY>
static __global__ void __launch_bounds__(SPH_BLOCK)
    RatesKernel(SphCudaArrays d, SphGrid g, SphPairConst c, const Real4 *__restrict__ xm, const Real4 *__restrict__ us,
                const Real4 *__restrict__ vp)
{
  const int i = SPH_ITEM;

  if (i >= d.n || d.group[i] == -2) return;
  const Real4 x = xm[i], u = us[i], v = vp[i];
  const unsigned key = d.key[i];
  const bool diffuse = c.ddt != (sphreal)0 && !(key & 1u);
  const sphreal rhoa = Density(c, u.w);
  sphreal ax = 0, ay = 0, az = 0, ds = 0, dd = 0;
  auto term = [&](int j, bool fluid, sphreal dx, sphreal dy, sphreal dz, sphreal r2, sphreal mb) {
    const Real4 ub = us[j], vb = vp[j];
    const sphreal F = c.fnorm * sph_f(KERNEL, Sqrt(r2) * c.hinv), rhob = Density(c, ub.w), Vb = mb / rhob;
    const sphreal wx = v.x - vb.x, wy = v.y - vb.y, wz = v.z - vb.z;
    sphreal fx = sph_pressure(mb, v.w, vb.w, F), fv = 0;
    if (VISCOSITY == SPH_VISCOSITY_EQ6)
      fv = sph_viscosity(&c, mb, rhoa, rhob, r2, F);
    else if (VISCOSITY == SPH_VISCOSITY_MORRIS)
      fv = sph_viscosity_morris(&c, mb, rhoa, rhob, r2, F);
    else
      fx += sph_viscosity_artificial(&c, mb, rhoa, rhob, wx * dx + wy * dy + wz * dz, r2, F);
    ds += sph_continuity(Vb, (u.x - ub.x) * dx + (u.y - ub.y) * dy + (u.z - ub.z) * dz, F);
    if (diffuse && fluid) dd += sph_diffusion(&c, Vb, u.w, ub.w, c.g[0] * dx + c.g[1] * dy + c.g[2] * dz, F);
    ax += fx * dx + fv * wx;
    ay += fx * dy + fv * wy;
    az += fx * dz + fv * wz;
  };

  ForNeighbours(g, c.r2max, d.cellstart, xm, key, x, term);
  d.rate.a[0][i] = (double)ax;
  d.rate.a[1][i] = (double)ay;
  d.rate.a[2][i] = (double)az;
  d.rate.ds[i] = (1.0 + d.st.s[i]) * (double)ds + (double)dd;
}

/* Eq. 9 for fluid marker i: new rho/rho0 - 1 into ds. */
template <int KERNEL>
static __global__ void __launch_bounds__(SPH_BLOCK)
    SumKernel(SphCudaArrays d, SphGrid g, SphPairConst c, int shepard, const Real4 *__restrict__ xm, const Real4 *__restrict__ us)
{
  const int i = SPH_ITEM;

  if (i >= d.n || d.group[i] != -1) return;
  const Real4 x = xm[i];
  sphreal sm = 0, sv = 0;
  auto term = [&](int j, bool, sphreal, sphreal, sphreal, sphreal r2, sphreal mb) {
    const sphreal s = us[j].w, VW = mb / Density(c, s) * c.wnorm * sph_w(KERNEL, Sqrt(r2) * c.hinv);
    sm += VW * s;
    sv += VW;
  };

  ForNeighbours(g, c.r2max, d.cellstart, xm, d.key[i], x, term);
  d.rate.ds[i] = shepard ? (double)(sm / sv) : (double)sm + ((double)sv - 1.0);
}

static Prepared Quantities(const SphCuda *cuda)
{
  Real4 *base = (Real4 *)cuda->q;
  Prepared q = {base, base + (size_t)cuda->d.n, base + 2 * (size_t)cuda->d.n};

  return q;
}

static PetscErrorCode Prepare(Sph sph)
{
  SphCuda *cuda = (SphCuda *)sph->data;

  PetscFunctionBegin;
  SphCallCUDA(SphLaunch(cuda->stream, cuda->d.n, PrepareKernel, cuda->d, cuda->grid, sph->par, Quantities(cuda)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Also brings the prepared quantities to where the rates want them. */
static PetscErrorCode Aux(Sph sph)
{
  SphCuda *cuda = (SphCuda *)sph->data;

  PetscFunctionBegin;
  SphCallCUDA(SphLaunch(cuda->stream, cuda->d.n, sph->par.kernel ? AuxKernel<1> : AuxKernel<0>, cuda->d, cuda->grid, sph->par,
                        sph_pair_const(&sph->par), Quantities(cuda)));
  SphCallCUDA(SphLaunch(cuda->stream, cuda->d.n, PrepareAfterAuxKernel, cuda->d, sph->par, Quantities(cuda)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef void (*RatesFn)(SphCudaArrays, SphGrid, SphPairConst, const Real4 *, const Real4 *, const Real4 *);
static const RatesFn rates[2][3] = {{RatesKernel<0, 0>, RatesKernel<0, 1>, RatesKernel<0, 2>},
                                    {RatesKernel<1, 0>, RatesKernel<1, 1>, RatesKernel<1, 2>}};

static PetscErrorCode Rates(Sph sph)
{
  SphCuda *cuda = (SphCuda *)sph->data;
  const Prepared q = Quantities(cuda);

  PetscFunctionBegin;
  SphCallCUDA(SphLaunch(cuda->stream, cuda->d.n, rates[sph->par.kernel][sph->par.viscosity], cuda->d, cuda->grid,
                        sph_pair_const(&sph->par), q.xm, q.us, q.vp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Sum(Sph sph)
{
  SphCuda *cuda = (SphCuda *)sph->data;
  const Prepared q = Quantities(cuda);

  PetscFunctionBegin;
  SphCallCUDA(SphLaunch(cuda->stream, cuda->d.n, sph->par.kernel ? SumKernel<1> : SumKernel<0>, cuda->d, cuda->grid,
                        sph_pair_const(&sph->par), sph->par.reinit == SPH_REINIT_SHEPARD ? 1 : 0, q.xm, q.us));
  PetscFunctionReturn(PETSC_SUCCESS);
}
