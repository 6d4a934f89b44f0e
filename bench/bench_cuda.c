/*
  bench_cuda.c - speed of the fluid on a CUDA device: markers times steps per second, time per stage, distance from the ceilings.

  Scene: a tank of sides 2 : 1 : 1, filled to three quarters, walls on five sides, the method of the paper (cubic spline, XSPH,
  Adami walls, midpoint, re-initialisation every 10 steps) unless -sph_ options say otherwise. Each size runs twice: free for the
  total, and waiting after every stage for the table of stages.

  FLOP: 60 per pair inside the support for the rates and 30 for the auxiliary sweep, 8 per candidate of the 27 cells, divisions
  and roots counted as one. Bytes: what must move at least once per evaluation if caches were perfect (state in, prepared
  quantities out and in, rates out). Both are lower bounds of what the device does, so the percentages are of useful work.

    bench_cuda                          0.1, 1, 3, 10 M markers
    bench_cuda -markers 5e4 -steps 10   smaller
    bench_cuda -sph_type cpu -markers 2e4   the same table for the CPU backend, without ceilings
*/
#include "sph.h"
#include "sphlink.h"
#include "sphfill.h"
#include <math.h>
#include <petsctime.h>
#include <stdio.h>
#include <string.h>

#if defined(FROND_HAVE_CUDA) && !defined(CUDA_SHIM)
extern int BenchCeiling(char *name, double *bytes, double *single, double *twice);
#endif

typedef struct {
  double bytes, flops; /* per s; 0 when unknown */
} Ceiling;

static PetscErrorCode Make(double markers, Sph *out)
{
  const double dp = cbrt(2.0 * 0.75 / markers);
  const PetscReal nx = floor(2.0 / dp + 0.5), ny = floor(0.75 / dp + 0.5), nz = floor(1.0 / dp + 0.5);
  const PetscReal lo[3] = {0.0, 0.0, 0.0}, hi[3] = {nx * dp, ny * dp, nz * dp}, top[3] = {nx * dp, ny * dp * 4.0 / 3.0, nz * dp},
                  g[3] = {0.0, -9.81, 0.0};
  const PetscBool face[6] = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE, PETSC_FALSE, PETSC_TRUE, PETSC_TRUE},
                  periodic[3] = {PETSC_FALSE, PETSC_FALSE, PETSC_FALSE};
  PetscReal *x, *p, *vol, *depth, support;
  PetscInt n, group;
  SphLinkSpec wall = {.nsections = 1};
  const PetscReal rest[24] = {[15] = 1.0, [19] = 1.0, [23] = 1.0};
  Sph sph;

  PetscFunctionBegin;
  PetscCall(SphCreate(PETSC_COMM_SELF, &sph));
  PetscCall(SphSetType(sph, SPHCUDA));
  PetscCall(SphSetSpacing(sph, dp));
  PetscCall(SphSetMaxSpeed(sph, 4.0));
  PetscCall(SphSetBodyForce(sph, g));
  PetscCall(SphSetDomain(sph, lo, top));
  PetscCall(SphSetCheckEvery(sph, 50));
  PetscCall(SphSetFromOptions(sph));
  PetscCall(SphFillBox(3, dp, lo, hi, NULL, NULL, &n, &x));
  PetscCall(PetscMalloc1(n, &p));
  for (PetscInt i = 0; i < n; i++) p[i] = 9810.0 * (hi[1] - x[3 * i + 1]);
  PetscCall(SphAddFluid(sph, n, x, NULL, p));
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(p));
  PetscCall(SphGetSupport(sph, &support));
  PetscCall(SphFillWalls(3, dp, lo, hi, face, periodic, support, &n, &x, &vol, &depth));
  PetscCall(SphAddBoundary(sph, n, x, NULL, vol, depth, &group));
  wall.offset = x; /* a body at the origin */
  PetscCall(SphSetGroupLink(sph, group, &wall));
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(vol));
  PetscCall(PetscFree(depth));
  PetscCall(SphSetUp(sph));
  PetscCall(SphSetGroupState(sph, group, rest));
  *out = sph;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Seconds per step; the force on the walls is read back in every step, as a coupled run does. */
static PetscErrorCode Steps(Sph sph, PetscInt steps, double *seconds)
{
  PetscReal load[6], dt;
  PetscLogDouble t0, t1;

  PetscFunctionBegin;
  PetscCall(PetscTime(&t0));
  for (PetscInt k = 0; k < steps; k++) {
    PetscCall(SphComputeTimeStep(sph, &dt));
    PetscCall(SphStepBegin(sph, dt));
    PetscCall(SphStepEnd(sph));
    PetscCall(SphGetGroupLoad(sph, 0, load, NULL)); /* waits for the device */
  }
  PetscCall(PetscTime(&t1));
  *seconds = (t1 - t0) / (double)steps;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const char *const stages[] = {"SphBuild", "SphAuxiliary", "SphRates", "SphIntegrate", "SphReinit"};
#define NSTAGES ((int)(sizeof(stages) / sizeof(stages[0])))

static PetscErrorCode StageTimes(double t[NSTAGES])
{
  PetscFunctionBegin;
  for (int k = 0; k < NSTAGES; k++) {
    PetscLogEvent e;
    PetscEventPerfInfo info;
    PetscCall(PetscLogEventGetId(stages[k], &e));
    PetscCall(PetscLogEventGetPerfInfo(PETSC_DETERMINE, e, &info));
    t[k] = info.time;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Useful FLOP and bytes per marker and evaluation. */
static PetscErrorCode Work(Sph sph, double *flops, double *bytes)
{
  PetscReal h, dp;

  PetscFunctionBegin;
  PetscCall(SphGetSmoothingLength(sph, &h));
  PetscCall(SphGetSpacing(sph, &dp));
  const double pairs = 4.0 / 3.0 * PETSC_PI * pow(2.0 * h / dp, 3.0), candidates = 27.0 * pow(2.1 * h / dp, 3.0);
  *flops = pairs * (60.0 + 30.0) + 2.0 * candidates * 8.0;
  /* per sweep: state and rates 13 doubles in, 12 floats out and in, 4 doubles out; two sweeps; one stage: 21 doubles in, 14 out
   */
  *bytes = 2.0 * (13.0 * 8.0 + 2.0 * 12.0 * 4.0 + 4.0 * 8.0) + 35.0 * 8.0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RunSize(double markers, PetscInt steps, const Ceiling *top)
{
  Sph sph;
  SphType borrowed;
  char type[16];
  PetscInt nf, nb;
  PetscReal e0, e1, bytes;
  double s, waiting, t0[NSTAGES], t1[NSTAGES], flops = 0.0, moved = 0.0;

  PetscFunctionBegin;
  PetscCall(PetscOptionsSetValue(NULL, "-sph_cuda_timing", "0"));
  PetscCall(Make(markers, &sph));
  PetscCall(SphGetType(sph, &borrowed));
  PetscCall(PetscStrncpy(type, borrowed, sizeof(type)));
  PetscCall(SphGetCounts(sph, &nf, &nb, NULL));
  PetscCall(SphGetWork(sph, &bytes, NULL));
  PetscCall(Steps(sph, 3, &s));
  PetscCall(SphGetWork(sph, NULL, &e0));
  PetscCall(Steps(sph, steps, &s));
  PetscCall(SphGetWork(sph, NULL, &e1));
  PetscCall(Work(sph, &flops, &moved));
  PetscCall(SphDestroy(&sph));
  const double evaluations = (e1 - e0) / (s * (double)steps), n = (double)(nf + nb);
  PetscCall(PetscPrintf(PETSC_COMM_SELF, "%-5s %9.0f %10.3g %12.4g %12.4g %11.3g %11.3g", type, n, s, n / s, evaluations,
                        evaluations * flops * 1e-9, evaluations * moved * 1e-9));
  if (top->flops > 0.0)
    PetscCall(PetscPrintf(PETSC_COMM_SELF, " %7.1f%% %7.1f%%", 100.0 * evaluations * flops / top->flops,
                          100.0 * evaluations * moved / top->bytes));
  PetscCall(PetscPrintf(PETSC_COMM_SELF, "\n"));

  PetscCall(PetscOptionsSetValue(NULL, "-sph_cuda_timing", "1"));
  PetscCall(Make(markers, &sph));
  PetscCall(Steps(sph, 3, &s));
  PetscCall(StageTimes(t0));
  PetscCall(Steps(sph, steps, &waiting));
  PetscCall(StageTimes(t1));
  PetscCall(SphDestroy(&sph));
  PetscCall(PetscPrintf(PETSC_COMM_SELF, "      ms per step, waiting after each stage:"));
  for (int k = 0; k < NSTAGES; k++)
    PetscCall(PetscPrintf(PETSC_COMM_SELF, " %s %.3f", stages[k] + 3, 1e3 * (t1[k] - t0[k]) / (double)steps));
  PetscCall(PetscPrintf(PETSC_COMM_SELF, "; all %.3f\n", 1e3 * waiting));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* have: there is something to run on. */
static PetscErrorCode Ceilings(Ceiling *top, PetscBool *have)
{
  char type[16] = SPHCUDA, precision[16] = "single";

  PetscFunctionBegin;
  *have = PETSC_TRUE;
  top->bytes = top->flops = 0.0;
  PetscCall(PetscOptionsGetString(NULL, NULL, "-sph_type", type, sizeof(type), NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-sph_precision", precision, sizeof(precision), NULL));
  if (strcmp(type, SPHCUDA)) PetscFunctionReturn(PETSC_SUCCESS);
#if defined(FROND_HAVE_CUDA) && !defined(CUDA_SHIM)
  {
    char name[256];
    double single, twice;
    if (BenchCeiling(name, &top->bytes, &single, &twice)) {
      fprintf(stderr, "bench_cuda: no CUDA device answers: run this program where there is one, or with -sph_type cpu\n");
      *have = PETSC_FALSE;
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    top->flops = strcmp(precision, "double") ? single : twice;
    PetscCall(PetscPrintf(PETSC_COMM_SELF, "%s: copy %.0f GB/s, float %.1f TFLOP/s, double %.1f TFLOP/s (measured)\n", name,
                          1e-9 * top->bytes, 1e-12 * single, 1e-12 * twice));
  }
#endif
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscReal markers[16] = {1e5, 1e6, 3e6, 1e7};
  PetscInt count = 16, steps = 20;
  PetscBool set, have;
  Ceiling top;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscLogDefaultBegin());
  PetscCall(PetscOptionsGetRealArray(NULL, NULL, "-markers", markers, &count, &set));
  if (!set) count = 4;
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-steps", &steps, NULL));
  PetscCheck(steps > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "steps = %" PetscInt_FMT ": must be > 0", steps);
  for (PetscInt k = 0; k < count; k++)
    PetscCheck(markers[k] >= 1000.0 && markers[k] < 1e9, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "markers = %g: must be in [1e3, 1e9)", (double)markers[k]);
  PetscCall(Ceilings(&top, &have));
  if (!have) {
    PetscCall(PetscFinalize());
    return 1;
  }
  PetscCall(PetscPrintf(PETSC_COMM_SELF, "type    markers     s/step marker*step/s marker*eval/s      GFLOP/s        GB/s %s\n",
                        top.flops > 0.0 ? " of FLOP  of copy" : ""));
  for (PetscInt k = 0; k < count; k++) PetscCall(RunSize(markers[k], steps, &top));
  PetscCall(PetscFinalize());
  return 0;
}
