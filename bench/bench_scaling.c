/*
  bench_scaling.c - time of a coupled step against the number of bodies and the size of the problem: Figs. 9 and 10 of Pazouki,
  Serban, Negrut.

  A box of water closed on itself in all directions is driven by a body force. Spheres of diameter 5 dp, as dense as water, or
  cantilevers of diameter 2 dp and length 6 dp in 4 ANCF elements, held at their lower ends, stand on a regular grid. The number
  of markers stays the same when bodies take the place of fluid.

    bench_scaling -experiment rigid   spheres 0 ... 10 000 in 3e6 markers      (Fig. 9a)
    bench_scaling -experiment size    0.2e6 ... 3e6 markers, a sphere per 1000  (Fig. 9b)
    bench_scaling -experiment beams   cantilevers 0 ... 10 000 in 1.5e6 markers (Fig. 10)
  Smaller by one option: -markers 1e5 (counts that do not fit are left out). Also: -steps, -bodies 100,10000 (other counts), -csv
  file (for bench/plot_scaling.py), and every option of the solvers, as -sph_type.
*/
#include "couple.h"
#include "sphfill.h"
#include <math.h>
#include <petsctime.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#define DP 1e-3 /* m */
#define SPHERE_R (2.5 * DP)
#define BEAM_D (2.0 * DP)
#define BEAM_L (6.0 * DP)

typedef struct {
  PetscInt n[3];    /* fluid sites per axis */
  PetscInt grid[3]; /* bodies per axis */
  PetscInt count;   /* bodies */
  int beams;
} Layout;

typedef struct {
  Sph sph;
  Rigid rigid;
  Ancf ancf;
  Couple couple;
} System;

/* Place of body b: its centre, or the held end of a cantilever. */
static void Place(const Layout *l, PetscInt b, PetscReal x[3])
{
  const PetscInt at[3] = {b % l->grid[0], b / l->grid[0] % l->grid[1], b / (l->grid[0] * l->grid[1])};
  for (int k = 0; k < 3; k++) x[k] = ((PetscReal)at[k] + 0.5) * (PetscReal)l->n[k] * DP / (PetscReal)l->grid[k];
  if (l->beams) x[2] -= 0.5 * BEAM_L;
}

/* The coarsest grid with room for `count` bodies; false when they do not fit. */
static PetscBool Arrange(Layout *l)
{
  const double pitch[3] = {l->beams ? 4.0 : 6.0, l->beams ? 4.0 : 6.0, l->beams ? 8.0 : 6.0};
  double scale = 1e9;
  for (int k = 0; k < 3; k++) l->grid[k] = 1;
  if (!l->count) return PETSC_TRUE;
  for (;; scale *= 0.98) { /* pitches shrink until the grid is fine enough */
    for (int k = 0; k < 3; k++) {
      l->grid[k] = (PetscInt)floor((double)l->n[k] / (pitch[k] * PetscMax(scale, 1.0)));
      if (l->grid[k] < 1 && scale > 1.0) l->grid[k] = 1;
    }
    if (l->grid[0] * l->grid[1] * l->grid[2] >= l->count) return PETSC_TRUE;
    if (scale <= 1.0) return PETSC_FALSE;
  }
}

/* Fluid keeps out of the bodies; the nearest places of the grid are looked at. */
static PetscBool OutsideBodies(const PetscReal x[3], void *ctx)
{
  const Layout *l = (const Layout *)ctx;
  PetscInt at[3];

  if (!l->count) return PETSC_TRUE;
  for (int k = 0; k < 3; k++)
    at[k] = PetscMin(l->grid[k] - 1, (PetscInt)floor(x[k] / ((PetscReal)l->n[k] * DP) * (PetscReal)l->grid[k]));
  const PetscInt b = (at[2] * l->grid[1] + at[1]) * l->grid[0] + at[0];
  PetscReal c[3];
  if (b >= l->count) return PETSC_TRUE;
  Place(l, b, c);
  const PetscReal dx = x[0] - c[0], dy = x[1] - c[1], dz = x[2] - c[2];
  if (l->beams)
    return dx * dx + dy * dy > 0.25 * BEAM_D * BEAM_D || dz < -0.5 * DP || dz > BEAM_L + 0.5 * DP ? PETSC_TRUE : PETSC_FALSE;
  return dx * dx + dy * dy + dz * dz > SPHERE_R * SPHERE_R ? PETSC_TRUE : PETSC_FALSE;
}

static PetscErrorCode MakeFluid(Layout *l, Sph *sph)
{
  const PetscReal lo[3] = {0.0, 0.0, 0.0}, hi[3] = {(PetscReal)l->n[0] * DP, (PetscReal)l->n[1] * DP, (PetscReal)l->n[2] * DP},
                  f[3] = {1.0, 0.0, 0.0};
  const PetscBool periodic[3] = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE};
  PetscReal *x;
  PetscInt n;

  PetscFunctionBegin;
  PetscCall(SphCreate(PETSC_COMM_SELF, sph));
  PetscCall(SphSetType(*sph, SPHAUTO));
  PetscCall(SphSetSpacing(*sph, DP));
  PetscCall(SphSetMaxSpeed(*sph, 0.1));
  PetscCall(SphSetBodyForce(*sph, f));
  PetscCall(SphSetDomain(*sph, lo, hi));
  PetscCall(SphSetPeriodic(*sph, periodic));
  PetscCall(SphSetFromOptions(*sph));
  PetscCall(SphFillBox(3, DP, lo, hi, OutsideBodies, l, &n, &x));
  PetscCall(SphAddFluid(*sph, n, x, NULL, NULL));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddSurface(System *s, const Layout *l, PetscInt body, PetscReal support)
{
  CoupleSurface surface;

  PetscFunctionBegin;
  if (l->beams)
    PetscCall(CoupleSurfaceCreateBeam(s->ancf, body, 3, DP, support, &surface));
  else
    PetscCall(CoupleSurfaceCreateRigid(s->rigid, body, 3, DP, support, &surface));
  PetscCall(CoupleAddSurface(s->couple, surface));
  PetscCall(CoupleSurfaceDestroy(&surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddBeams(System *s, const Layout *l)
{
  AncfBeamSpec beam;
  PetscInt id;

  PetscFunctionBegin;
  PetscCall(AncfCreate(PETSC_COMM_SELF, &s->ancf));
  PetscCall(AncfBeamSpecInit(&beam));
  beam.elements = 4;
  beam.diameter = BEAM_D;
  beam.density = 1100.0;
  beam.young = 1e5;
  beam.end0 = ANCF_END_CLAMP;
  for (PetscInt b = 0; b < l->count; b++) {
    Place(l, b, beam.start);
    for (int k = 0; k < 3; k++) beam.end[k] = beam.start[k] + (k == 2 ? BEAM_L : 0.0);
    PetscCall(AncfAddBeam(s->ancf, &beam, &id));
  }
  PetscCall(AncfSetFromOptions(s->ancf));
  PetscCall(AncfSetUp(s->ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddSpheres(System *s, const Layout *l)
{
  RigidBodySpec ball;
  PetscInt id;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &s->rigid));
  PetscCall(RigidBodySpecInit(&ball));
  ball.shape = RIGID_SPHERE;
  ball.motion = RIGID_FREE;
  ball.size[0] = SPHERE_R;
  ball.density = 1000.0;
  for (PetscInt b = 0; b < l->count; b++) {
    Place(l, b, ball.position);
    PetscCall(RigidAddBody(s->rigid, &ball, &id));
  }
  PetscCall(RigidSetFromOptions(s->rigid));
  PetscCall(RigidSetUp(s->rigid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Make(Layout *l, System *s)
{
  PetscReal support;

  PetscFunctionBegin;
  memset(s, 0, sizeof(*s));
  PetscCall(MakeFluid(l, &s->sph));
  PetscCall(CoupleCreate(PETSC_COMM_SELF, &s->couple));
  PetscCall(CoupleSetSph(s->couple, s->sph));
  PetscCall(CoupleSetFromOptions(s->couple));
  if (l->count) {
    if (l->beams)
      PetscCall(AddBeams(s, l));
    else
      PetscCall(AddSpheres(s, l));
  }
  PetscCall(SphGetSupport(s->sph, &support));
  for (PetscInt b = 0; b < l->count; b++) PetscCall(AddSurface(s, l, b, support));
  PetscCall(CoupleSetUp(s->couple));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const char *const parts[] = {"SphBuild",  "SphAuxiliary",     "SphRates",       "SphIntegrate",
                                    "SphReinit", "CoupleKinematics", "CoupleTransfer", "CoupleAdvance"};
#define NPARTS ((int)(sizeof(parts) / sizeof(parts[0])))

static PetscErrorCode PartTimes(double t[NPARTS])
{
  PetscFunctionBegin;
  for (int k = 0; k < NPARTS; k++) {
    PetscLogEvent e;
    PetscEventPerfInfo info = {0};
    PetscCall(PetscLogEventGetId(parts[k], &e));
    if (e >= 0) PetscCall(PetscLogEventGetPerfInfo(PETSC_DETERMINE, e, &info));
    t[k] = info.time;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Time of all threads of this process, s: what a shared machine disturbs least. */
static double Processor(void)
{
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* One line of the table; *first is the time of the first line of an experiment. */
static PetscErrorCode Measure(Layout *l, PetscInt steps, FILE *csv, const char *experiment, double *first)
{
  System s;
  SphType type;
  PetscInt nf, nb;
  PetscReal dt;
  PetscLogDouble t0, t1, best = 1e30;
  double c0, processor = 1e30;
  double p0[NPARTS], p1[NPARTS];

  PetscFunctionBegin;
  PetscCall(Make(l, &s));
  PetscCall(SphGetType(s.sph, &type));
  PetscCall(SphGetCounts(s.sph, &nf, &nb, NULL));
  for (int k = 0; k < 2; k++) PetscCall(CoupleStep(s.couple, 1.0, &dt));
  PetscCall(PartTimes(p0));
  for (PetscInt k = 0; k < steps; k++) {
    c0 = Processor();
    PetscCall(PetscTime(&t0));
    PetscCall(CoupleStep(s.couple, 1.0, &dt));
    PetscCall(PetscTime(&t1));
    best = PetscMin(best, t1 - t0);
    processor = PetscMin(processor, Processor() - c0);
  }
  PetscCall(PartTimes(p1));
  if (*first <= 0.0) *first = best;
  PetscCall(PetscPrintf(PETSC_COMM_SELF, "%-5s %9" PetscInt_FMT " %8" PetscInt_FMT " %9" PetscInt_FMT " %10.4g %8.3f %10.4g |",
                        type, nf + nb, l->count, nb, best, best / *first, processor));
  for (int k = 0; k < NPARTS; k++) PetscCall(PetscPrintf(PETSC_COMM_SELF, " %9.4f", (p1[k] - p0[k]) / (double)steps));
  PetscCall(PetscPrintf(PETSC_COMM_SELF, "\n"));
  if (csv) fprintf(csv, "%s,%s,%d,%d,%d,%g,%g\n", experiment, type, (int)(nf + nb), (int)l->count, (int)nb, best, processor);
  PetscCall(CoupleDestroy(&s.couple));
  PetscCall(SphDestroy(&s.sph));
  if (s.rigid) PetscCall(RigidDestroy(&s.rigid));
  if (s.ancf) PetscCall(AncfDestroy(&s.ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Cube(Layout *l, double markers)
{
  for (int k = 0; k < 3; k++) l->n[k] = (PetscInt)floor(cbrt(markers) + 0.5);
}

static PetscErrorCode Experiment(const char *name, double markers, PetscInt steps, FILE *csv)
{
  PetscInt counts[16] = {0, 10, 100, 1000, 3000, 10000}, ncounts = 16;
  PetscBool given;
  const int size = !strcmp(name, "size"), beams = !strcmp(name, "beams");
  double first = 0.0;

  PetscFunctionBegin;
  PetscCheck(size || beams || !strcmp(name, "rigid"), PETSC_COMM_SELF, PETSC_ERR_ARG_UNKNOWN_TYPE,
             "experiment = %s: must be rigid, size or beams", name);
  if (markers <= 0.0) markers = beams ? 1.5e6 : 3e6;
  PetscCheck(markers >= 5e3 && markers < 1e9, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "markers = %g: must be in [5e3, 1e9)",
             markers);
  PetscCall(PetscPrintf(PETSC_COMM_SELF,
                        "%s: best time of a coupled step (s), ratio to the first line, processor time of all threads (s); mean "
                        "time of the parts (s; on a device "
                        "only with -sph_cuda_timing)\ntype    markers   bodies   surface     s/step    ratio  processor |",
                        name));
  for (int k = 0; k < NPARTS; k++)
    PetscCall(PetscPrintf(PETSC_COMM_SELF, " %9.9s", strncmp(parts[k], "Sph", 3) ? parts[k] + 6 : parts[k] + 3));
  PetscCall(PetscPrintf(PETSC_COMM_SELF, "\n"));
  PetscCall(PetscOptionsGetIntArray(NULL, NULL, "-bodies", counts, &ncounts, &given));
  if (!given || size) ncounts = 6;
  for (PetscInt k = 0; k < ncounts; k++) {
    Layout l = {.count = counts[k], .beams = beams};
    Cube(&l, size ? markers * PetscSqr((double)k + 1.0) / 36.0 : markers);
    if (size) l.count = (l.n[0] * l.n[1] * l.n[2]) / 1000;
    if (Arrange(&l))
      PetscCall(Measure(&l, steps, csv, name, &first));
    else
      PetscCall(PetscPrintf(PETSC_COMM_SELF, "%" PetscInt_FMT " bodies do not fit into %g markers\n", l.count, markers));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  char name[32] = "rigid", file[PETSC_MAX_PATH_LEN] = "";
  PetscReal markers = 0.0;
  PetscInt steps = 5;
  PetscBool set;
  FILE *csv = NULL;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscLogDefaultBegin());
  PetscCall(PetscOptionsGetString(NULL, NULL, "-experiment", name, sizeof(name), NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-markers", &markers, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-steps", &steps, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-csv", file, sizeof(file), &set));
  PetscCheck(steps > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "steps = %" PetscInt_FMT ": must be > 0", steps);
  if (set) {
    csv = fopen(file, "w");
    PetscCheck(csv, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "csv = %s: the file cannot be written", file);
    fprintf(csv, "experiment,type,markers,bodies,surface,seconds,processor\n");
  }
  PetscCall(Experiment(name, markers, steps, csv));
  if (csv) fclose(csv);
  PetscCall(PetscFinalize());
  return 0;
}
