/*
  bench_sph.c - speed of the SPH engine: a three-dimensional dam break.

  Tank 1.6 x 0.67 x 0.4 m, open on top, one layer of wall markers; column 0.4 x 0.67 x 0.3 m at x = 0; h = sqrt(3) dp (about 170
  neighbours), rho0 = 1000 kg/m^3, gamma = 7, g = 9.81 m/s^2, c_s = 34.3 m/s, artificial viscosity 0.1, Wendland or cubic spline.
  dp = 0.013, 0.008, 0.0049 m give 53 k, 203 k, 800 k markers.

  The unit is a marker-evaluation: one right-hand side for one marker, re-sorting, wall markers, time step and integration
  included. Every figure is the best of -reps repetitions of -steps steps by the wall clock; the same by processor time is shown
  for machines that are shared. Figures of DualSPHysics 5.4 for the same case (built -O3 -march=native -ffast-math; two threads of
  a Zen 4 class machine, median of 3) are compiled in.

    bench_sph                                   the table at 203 k markers
    bench_sph -sizes 0.013,0.008,0.0049,0.00315 -full
    bench_sph -flat -sizes 0.013,0.008,0.0049,0.00315
                                                cost against size: the dam break, where the share of dry wall markers, which see
  no neighbour, falls with dp, and a periodic box of the same number of fluid markers bench_sph -fill 0.0027 time to fill, sort
  and set up only bench_sph -sph_kernel cubic -one            one run with any -sph_ option
*/
#include "sph_cuda/sph.h"
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

typedef struct {
  PetscReal dp;
  SphKernelType kernel;
  SphDiffusionType diffusion;
  SphIntegratorType integrator;
  SphPrecision precision;
  int threads;
  PetscInt box; /* instead of the dam break: markers along each side of a periodic box of moving fluid */
} Case;

typedef struct {
  PetscInt n;
  PetscReal wall, cpu;             /* evaluations per second, per processor second */
  PetscReal bytes, resident, peak; /* per marker, as counted, as held at the end, and the most that was held */
  PetscReal setup, setupcpu;       /* s, by the clock and of processor time */
} Result;

/* DualSPHysics 5.4, two threads: marker-evaluations/s in millions; 0 where there is no figure. */
typedef struct {
  PetscReal dp;
  SphDiffusionType diffusion;
  SphIntegratorType integrator;
  PetscReal rate;
} Peer;

static const Peer peers[] = {
    {0.0080, SPH_DIFFUSION_MOLTENI, SPH_INTEGRATOR_VERLET, 0.53},
    {0.0080, SPH_DIFFUSION_NONE, SPH_INTEGRATOR_VERLET, 0.82},
    {0.0049, SPH_DIFFUSION_MOLTENI, SPH_INTEGRATOR_VERLET, 0.50},
    {0.0080, SPH_DIFFUSION_MOLTENI, SPH_INTEGRATOR_SYMPLECTIC, 0.54},
    {0.0080, SPH_DIFFUSION_NONE, SPH_INTEGRATOR_SYMPLECTIC, 0.80},
    {0.0049, SPH_DIFFUSION_MOLTENI, SPH_INTEGRATOR_SYMPLECTIC, 0.50},
};

static PetscReal PeerRate(const Case *c)
{
  for (size_t k = 0; k < sizeof(peers) / sizeof(peers[0]); k++)
    if (fabs(peers[k].dp - c->dp) < 1e-6 && peers[k].diffusion == c->diffusion && peers[k].integrator == c->integrator)
      return peers[k].rate;
  return 0.0;
}

static double Clock(clockid_t id)
{
  struct timespec t;
  clock_gettime(id, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Memory that the process holds now, bytes. */
static double Resident(void)
{
  long pages = 0, size = 0;
  FILE *f = fopen("/proc/self/statm", "r");
  if (!f) return 0.0;
  if (fscanf(f, "%ld %ld", &size, &pages) != 2) pages = 0;
  fclose(f);
  return 4096.0 * (double)pages;
}

/* The most that the process has held, bytes. */
static double Peak(void)
{
  struct rusage u;
  return getrusage(RUSAGE_SELF, &u) ? 0.0 : 1024.0 * (double)u.ru_maxrss;
}

/* Markers along each axis of the dam break: of the tank less one, and of the fluid. */
static void Lattice(PetscReal dp, PetscInt n[3], PetscInt f[3])
{
  n[0] = (PetscInt)floor(1.6 / dp + 0.5);
  n[1] = (PetscInt)floor(0.67 / dp + 0.5);
  n[2] = (PetscInt)floor(0.4 / dp + 1e-9) - 1;
  f[0] = (PetscInt)floor(0.4 / dp + 0.5);
  f[1] = n[1] - 1;
  f[2] = (PetscInt)floor(0.3 / dp + 0.5);
}

/* Nodes p of [1,f] with p + o in [lo,hi], all axes. */
static double Overlap(const PetscInt f[3], const PetscInt lo[3], const PetscInt hi[3], const PetscInt o[3])
{
  double m = 1.0;
  for (int k = 0; k < 3; k++) m *= (double)PetscMax(0, PetscMin(f[k], hi[k] - o[k]) - PetscMax(1, lo[k] - o[k]) + 1);
  return m;
}

/* Neighbours per marker on the lattice of the dam break, within 2h = sqrt(12) dp: fluid has all, walls have fluid only. */
static PetscReal Neighbours(PetscReal dp)
{
  const PetscInt zero[3] = {0, 0, 0}, one[3] = {1, 1, 1};
  PetscInt n[3], f[3], inner[3], whole[3];
  double pairs = 0.0, markers;

  Lattice(dp, n, f);
  for (int k = 0; k < 3; k++) {
    inner[k] = k < 2 ? n[k] - 1 : n[k];
    whole[k] = n[k] + 1;
  }
  markers = Overlap(f, one, f, zero) + Overlap(whole, one, whole, zero) - Overlap(inner, one, inner, zero);
  for (PetscInt a = 0; a < 343; a++) {
    const PetscInt o[3] = {a % 7 - 3, a / 7 % 7 - 3, a / 49 - 3}, r2 = o[0] * o[0] + o[1] * o[1] + o[2] * o[2];
    if (r2 && r2 < 12) pairs += Overlap(f, one, f, o) + 2.0 * (Overlap(f, zero, n, o) - Overlap(f, one, inner, o));
  }
  return pairs / markers;
}

/* Nodes i dp: walls on the planes x = 0, y = 0, z = 0 and at the far ends; fluid at 0.01 dp off them never, a full dp away. */
static PetscErrorCode AddMarkers(Sph sph, PetscReal dp)
{
  PetscReal *x, *p, *vol, *depth;
  PetscInt m = 0, group, n[3], f[3], nf, nw;

  PetscFunctionBegin;
  Lattice(dp, n, f);
  nf = f[0] * f[1] * f[2];
  nw = (n[0] + 1) * (n[1] + 1) * (n[2] + 1) - (n[0] - 1) * (n[1] - 1) * n[2];
  PetscCall(PetscMalloc4(3 * (size_t)PetscMax(nf, nw), &x, nf, &p, nw, &vol, nw, &depth));
  for (PetscInt k = 1; k <= f[2]; k++)
    for (PetscInt j = 1; j <= f[1]; j++)
      for (PetscInt i = 1; i <= f[0]; i++) {
        x[3 * m] = (PetscReal)i * dp;
        x[3 * m + 1] = (PetscReal)j * dp;
        x[3 * m + 2] = (PetscReal)k * dp;
        p[m++] = 1000.0 * 9.81 * (PetscReal)(f[2] - k) * dp;
      }
  PetscCall(SphAddFluid(sph, m, x, NULL, p));
  m = 0;
  for (PetscInt k = 0; k <= n[2]; k++)
    for (PetscInt j = 0; j <= n[1]; j++)
      for (PetscInt i = 0; i <= n[0]; i++) {
        if (k > 0 && j > 0 && j < n[1] && i > 0 && i < n[0]) continue;
        x[3 * m] = (PetscReal)i * dp;
        x[3 * m + 1] = (PetscReal)j * dp;
        x[3 * m + 2] = (PetscReal)k * dp;
        vol[m] = dp * dp * dp;
        depth[m++] = 0.0;
      }
  PetscCall(SphAddBoundary(sph, m, x, NULL, vol, depth, &group));
  PetscCall(PetscFree4(x, p, vol, depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A lattice of m^3 fluid markers in a shear flow of up to 1.7 m/s, so that re-sorting takes part as in a dam break under way. */
static PetscErrorCode AddBox(Sph sph, PetscReal dp, PetscInt m)
{
  PetscReal *x, *v;
  PetscInt at = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(3 * (size_t)(m * m * m), &x, 3 * (size_t)(m * m * m), &v));
  for (PetscInt k = 0; k < m; k++)
    for (PetscInt j = 0; j < m; j++)
      for (PetscInt i = 0; i < m; i++, at += 3) {
        const PetscInt node[3] = {i, j, k};
        for (int d = 0; d < 3; d++) {
          x[at + d] = ((PetscReal)node[d] + 0.5) * dp;
          v[at + d] = sin(2.0 * PETSC_PI * ((PetscReal)node[(d + 1) % 3] + 0.5) / (PetscReal)m);
        }
      }
  PetscCall(SphAddFluid(sph, m * m * m, x, v, NULL));
  PetscCall(PetscFree2(x, v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Make(const Case *c, Sph *out)
{
  const PetscReal side = (PetscReal)c->box * c->dp, lo[3] = {0.0, 0.0, 0.0}, hi[3] = {1.6, 0.67, 0.6},
                  cube[3] = {side, side, side}, g[3] = {0.0, 0.0, c->box ? 0.0 : -9.81};
  const PetscBool periodic[3] = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE};
  Sph sph;

  PetscFunctionBegin;
  omp_set_num_threads(c->threads);
  PetscCall(SphCreate(PETSC_COMM_SELF, &sph));
  PetscCall(SphSetSpacing(sph, c->dp));
  PetscCall(SphSetSmoothingRatio(sph, sqrt(3.0)));
  PetscCall(SphSetSoundSpeed(sph, 34.3));
  PetscCall(SphSetViscosityType(sph, SPH_VISCOSITY_ARTIFICIAL));
  PetscCall(SphSetArtificialViscosity(sph, 0.1));
  PetscCall(SphSetDensityDiffusion(sph, c->diffusion, 0.1));
  PetscCall(SphSetDensityReinit(sph, SPH_REINIT_NONE, 1));
  PetscCall(SphSetXSPH(sph, 0.0));
  PetscCall(SphSetKernel(sph, c->kernel));
  PetscCall(SphSetWall(sph, SPH_WALL_BCE));
  PetscCall(SphSetIntegrator(sph, c->integrator));
  PetscCall(SphSetPrecision(sph, c->precision));
  PetscCall(SphSetBodyForce(sph, g));
  PetscCall(SphSetDomain(sph, lo, c->box ? cube : hi));
  if (c->box) PetscCall(SphSetPeriodic(sph, periodic));
  PetscCall(SphSetCheckEvery(sph, 100));
  PetscCall(SphSetFromOptions(sph));
  if (c->box)
    PetscCall(AddBox(sph, c->dp, c->box));
  else
    PetscCall(AddMarkers(sph, c->dp));
  PetscCall(SphSetUp(sph));
  *out = sph;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Steps(Sph sph, PetscInt steps)
{
  PetscReal dt;

  PetscFunctionBegin;
  for (PetscInt s = 0; s < steps; s++) {
    PetscCall(SphComputeTimeStep(sph, &dt));
    PetscCall(SphStepBegin(sph, dt));
    PetscCall(SphStepEnd(sph));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Run(const Case *c, PetscInt warm, PetscInt steps, PetscInt reps, Result *r)
{
  const double before = Resident(), t0 = Clock(CLOCK_MONOTONIC), c0 = Clock(CLOCK_PROCESS_CPUTIME_ID);
  PetscInt nf, nb;
  PetscReal e0, e1;
  Sph sph;

  PetscFunctionBegin;
  PetscCall(Make(c, &sph));
  r->setup = Clock(CLOCK_MONOTONIC) - t0;
  r->setupcpu = Clock(CLOCK_PROCESS_CPUTIME_ID) - c0;
  PetscCall(SphGetCounts(sph, &nf, &nb, NULL));
  r->n = nf + nb;
  r->wall = r->cpu = 0.0;
  PetscCall(Steps(sph, warm));
  for (PetscInt k = 0; k < reps; k++) {
    const double w = Clock(CLOCK_MONOTONIC), p = Clock(CLOCK_PROCESS_CPUTIME_ID);
    PetscCall(SphGetWork(sph, NULL, &e0));
    PetscCall(Steps(sph, steps));
    PetscCall(SphGetWork(sph, NULL, &e1));
    r->wall = PetscMax(r->wall, (e1 - e0) / (Clock(CLOCK_MONOTONIC) - w));
    r->cpu = PetscMax(r->cpu, (e1 - e0) / (Clock(CLOCK_PROCESS_CPUTIME_ID) - p));
  }
  PetscCall(SphGetWork(sph, &r->bytes, NULL));
  r->bytes /= (PetscReal)r->n;
  r->resident = (Resident() - before) / (PetscReal)r->n;
  r->peak = (Peak() - before) / (PetscReal)r->n;
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* By processor time: what `threads` processors to themselves would reach, if the threads do not hinder one another. */
static PetscErrorCode Row(const Case *c, PetscInt warm, PetscInt steps, PetscInt reps, Result *r)
{
  const PetscReal peer = c->threads == 2 ? PeerRate(c) : 0.0;

  PetscFunctionBegin;
  PetscCall(Run(c, warm, steps, reps, r));
  printf("%8" PetscInt_FMT "  %-8s  %-9s  %-10s  %-6s  %d   %6.3f  %11.3f  %8.0f", r->n, SphKernelTypes[c->kernel],
         SphDiffusionTypes[c->diffusion], SphIntegratorTypes[c->integrator], SphPrecisions[c->precision], c->threads,
         r->wall * 1e-6, r->cpu * c->threads * 1e-6, r->bytes);
  if (peer > 0.0) printf("  %5.2f %5.2f", r->wall * 1e-6 / peer, r->cpu * c->threads * 1e-6 / peer);
  printf("\n");
  fflush(stdout);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Verlet and, with full, the other integrators; all kernels, diffusions and numbers of threads; then what the choices cost. */
static PetscErrorCode Table(Case c, PetscBool full, PetscBool precision, PetscInt warm, PetscInt steps, PetscInt reps)
{
  const SphIntegratorType order[] = {SPH_INTEGRATOR_VERLET, SPH_INTEGRATOR_SYMPLECTIC, SPH_INTEGRATOR_RK2};
  Result r, one[2][2] = {{{0}}}, many = {0}; /* one thread, [kernel][diffusion]; most threads, Wendland, no diffusion */

  PetscFunctionBegin;
  for (c.threads = 1; c.threads <= PetscMax(2, omp_get_num_procs()); c.threads *= 2)
    for (int k = 1; k >= 0; k--)
      for (int d = 0; d < 2; d++)
        for (int i = 0; i < (full ? 3 : 1); i++) {
          c.kernel = (SphKernelType)k;
          c.diffusion = (SphDiffusionType)d;
          c.integrator = order[i];
          PetscCall(Row(&c, warm, steps, reps, &r));
          if (i == 0 && c.threads == 1) one[k][d] = r;
          if (i == 0 && k == 1 && d == 0) many = r;
        }
  printf("Verlet, processor time: cubic spline/Wendland %.2f, with density diffusion %.2f; density diffusion/none %.2f; speed by "
         "the "
         "clock: most threads/one %.2f\n",
         one[1][0].cpu / one[0][0].cpu, one[1][1].cpu / one[0][1].cpu, one[1][0].cpu / one[1][1].cpu, many.wall / one[1][0].wall);
  if (!precision) PetscFunctionReturn(PETSC_SUCCESS);
  c.kernel = SPH_KERNEL_WENDLAND;
  c.diffusion = SPH_DIFFUSION_NONE;
  c.integrator = SPH_INTEGRATOR_VERLET;
  c.precision = SPH_PRECISION_DOUBLE;
  c.threads = 1;
  PetscCall(Row(&c, warm, steps, reps, &r));
  printf("double/single %.2f\n", one[1][0].cpu / r.cpu);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cost against size, by processor time; ratios are those of the time per marker (and per neighbour) to that of the first size. */
static PetscErrorCode Flat(Case c, const PetscReal *sizes, PetscInt nsizes, PetscInt warm, PetscInt steps, PetscInt reps)
{
  PetscReal dam0 = 0.0, pair0 = 0.0, box0 = 0.0;

  PetscFunctionBegin;
  printf(" thr  dam markers   M/s  cost  neighbours  M neighbours/s  cost   box markers   M/s  cost\n");
  for (PetscInt s = 0; s < nsizes; s++) {
    Result dam, box;
    PetscReal pairs;
    c.dp = sizes[s];
    c.box = 0;
    PetscCall(Run(&c, warm, steps, reps, &dam));
    dam.cpu *= c.threads;
    pairs = dam.cpu * Neighbours(c.dp);
    c.box = (PetscInt)floor(cbrt((double)dam.n) + 0.5);
    PetscCall(Run(&c, warm, steps, reps, &box));
    box.cpu *= c.threads;
    if (s == 0) {
      dam0 = dam.cpu;
      pair0 = pairs;
      box0 = box.cpu;
    }
    printf("%4d %12" PetscInt_FMT " %5.3f %5.2f %11.1f %15.0f %5.2f %13" PetscInt_FMT " %5.3f %5.2f\n", c.threads, dam.n,
           dam.cpu * 1e-6, dam0 / dam.cpu, Neighbours(c.dp), pairs * 1e-6, pair0 / pairs, box.n, box.cpu * 1e-6, box0 / box.cpu);
    fflush(stdout);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscReal sizes[16] = {0.008}, fill = 0.0;
  PetscInt nsizes = 16, warm = 10, steps = 10, reps = 5;
  PetscBool full = PETSC_FALSE, one = PETSC_FALSE, flat = PETSC_FALSE, set;
  Case c = {0.008, SPH_KERNEL_WENDLAND, SPH_DIFFUSION_NONE, SPH_INTEGRATOR_VERLET, SPH_PRECISION_SINGLE, omp_get_max_threads(),
            0};
  Result r;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetRealArray(NULL, NULL, "-sizes", sizes, &nsizes, &set));
  if (!set) nsizes = 1;
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-warm", &warm, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-steps", &steps, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-reps", &reps, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-full", &full, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-one", &one, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-fill", &fill, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-flat", &flat, NULL));
  if (flat) {
    PetscCall(Flat(c, sizes, nsizes, warm, steps, reps));
    PetscCall(PetscFinalize());
    return 0;
  }
  if (fill > 0.0) {
    c.dp = fill;
    PetscCall(Run(&c, 0, 0, 0, &r));
    printf(
        "%" PetscInt_FMT
        " markers: filled, sorted, checked and evaluated once in %.2f s (%.2f s of processor time, %.2f us per marker), at most "
        "%.0f bytes per marker\n",
        r.n, r.setup, r.setupcpu, 1e6 * r.setupcpu / (PetscReal)r.n, r.peak);
    PetscCall(PetscFinalize());
    return 0;
  }
  printf(" markers  kernel    diffusion  integrator  real    thr  M/s wall  M/s cpu x thr  B/marker  x DualSPHysics (wall, cpu x "
         "thr)\n");
  for (PetscInt s = 0; s < nsizes; s++) {
    c.dp = sizes[s];
    if (one) { /* what the options ask for */
      PetscCall(Run(&c, warm, steps, reps, &r));
      printf("%8" PetscInt_FMT "  as the options say%25s%d   %6.3f  %11.3f  %8.1f  (resident %.1f, at most %.1f)\n", r.n, "",
             c.threads, r.wall * 1e-6, r.cpu * c.threads * 1e-6, r.bytes, r.resident, r.peak);
      continue;
    }
    PetscCall(Table(c, full, s == 0 ? PETSC_TRUE : PETSC_FALSE, warm, steps, reps));
  }
  PetscCall(PetscFinalize());
  return 0;
}
