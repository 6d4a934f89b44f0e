/*
  test_couple_many.c - so many beams in a fluid that they are shared out among threads: the same bits as one after the other on
  one thread.

  One after the other: each surface in a wrapper that has its operations and nothing else, which the coupling does not know as one
  of its own. Markers, loads, beams, and the balance must be the same to the last bit, whatever the threads.
*/
#include "couple.h"
#include "sphfill.h"
#include "testing.h"
#include <omp.h>

#define DP 0.01
#define NX 4
#define NZ 5
#define NBEAMS (NX * NX * NZ)

static const PetscReal lo[3] = {0, 0, 0}, hi[3] = {0.2, 0.2, 0.4}; /* 5 x 5 x 8 spacings for each beam */

static void Place(PetscInt b, PetscReal x[3])
{
  x[0] = DP * (5.0 * (PetscReal)(b % NX) + 2.5);
  x[1] = DP * (5.0 * (PetscReal)(b / NX % NX) + 2.5);
  x[2] = DP * (8.0 * (PetscReal)(b / (NX * NX)) + 1.0);
}

static PetscBool Outside(const PetscReal x[3], void *ctx)
{
  (void)ctx;
  for (PetscInt b = 0; b < NBEAMS; b++) {
    PetscReal c[3];

    Place(b, c);
    if (PetscSqr(x[0] - c[0]) + PetscSqr(x[1] - c[1]) < DP * DP && x[2] > c[2] && x[2] < c[2] + 6 * DP) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

typedef struct {
  Sph sph;
  Ancf ancf;
  Couple couple;
  CoupleSurface inner[NBEAMS];
} System;

static PetscErrorCode MakeFluid(Sph *sph)
{
  const PetscBool periodic[3] = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE};
  PetscReal *x, *v;
  PetscInt n;

  PetscFunctionBegin;
  PetscCall(SphCreate(PETSC_COMM_SELF, sph));
  PetscCall(SphSetSpacing(*sph, DP));
  PetscCall(SphSetMaxSpeed(*sph, 1.0));
  PetscCall(SphSetDomain(*sph, lo, hi));
  PetscCall(SphSetPeriodic(*sph, periodic));
  PetscCall(SphFillBox(3, DP, lo, hi, Outside, NULL, &n, &x));
  PetscCall(PetscMalloc1(3 * (size_t)n, &v));
  for (PetscInt i = 0; i < n; i++)
    for (int k = 0; k < 3; k++) v[3 * i + k] = 0.1 * sin(2.0 * PETSC_PI * x[3 * i + (k + 1) % 3] / 0.2);
  PetscCall(SphAddFluid(*sph, n, x, v, NULL));
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Make(CoupleLoads loads, PetscBool wrap, System *s)
{
  AncfBeamSpec beam;
  PetscReal support;

  PetscFunctionBegin;
  PetscCall(MakeFluid(&s->sph));
  PetscCall(SphGetSupport(s->sph, &support));
  PetscCall(CoupleCreate(PETSC_COMM_SELF, &s->couple));
  PetscCall(CoupleSetSph(s->couple, s->sph));
  PetscCall(CoupleSetLoads(s->couple, loads));
  PetscCall(AncfCreate(PETSC_COMM_SELF, &s->ancf));
  PetscCall(AncfBeamSpecInit(&beam));
  beam.elements = 2;
  beam.diameter = 2 * DP;
  beam.density = 1500.0;
  beam.young = 1e5;
  beam.end0 = beam.end1 = ANCF_END_FREE;
  for (PetscInt b = 0; b < NBEAMS; b++) {
    Place(b, beam.start);
    for (int k = 0; k < 3; k++) beam.end[k] = beam.start[k] + (k == 2 ? 6 * DP : 0.0);
    PetscCall(AncfAddBeam(s->ancf, &beam, NULL));
  }
  PetscCall(AncfSetUp(s->ancf));
  for (PetscInt b = 0; b < NBEAMS; b++) {
    CoupleSurface surface = NULL;

    PetscCall(CoupleSurfaceCreateBeam(s->ancf, b, 3, DP, support, &s->inner[b]));
    if (wrap) {
      CoupleSurfaceOps ops;
      void *ctx;

      PetscCall(CoupleSurfaceGetOps(s->inner[b], &ops));
      PetscCall(CoupleSurfaceGetContext(s->inner[b], &ctx));
      ops.destroy = NULL;
      PetscCall(CoupleSurfaceCreate(PETSC_COMM_SELF, "wrapped", &ops, ctx, &surface));
    }
    PetscCall(CoupleAddSurface(s->couple, wrap ? surface : s->inner[b]));
    if (wrap) PetscCall(CoupleSurfaceDestroy(&surface));
  }
  PetscCall(CoupleSetUp(s->couple));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Five steps; then markers, loads and beams, and the balance. */
static PetscErrorCode Run(CoupleLoads loads, PetscBool wrap, int threads, PetscReal **state, PetscInt *nstate, CoupleBalance *b)
{
  const PetscReal *e, *v, *a;
  PetscReal dt, *load, *p;
  PetscInt n, nb;
  const PetscInt nn = 18 * NBEAMS;
  System s;

  PetscFunctionBegin;
  omp_set_num_threads(threads);
  PetscCall(Make(loads, wrap, &s));
  PetscCall(SphGetCounts(s.sph, &n, &nb, NULL));
  *nstate = 6 * (n + nb) + 4 * nn;
  PetscCall(PetscMalloc1(*nstate, state));
  for (int i = 0; i < 5; i++) PetscCall(CoupleStep(s.couple, 1.0, &dt));
  PetscCall(SphGetFields(s.sph, &(SphFields){.x = *state, .v = *state + 3 * (n + nb)}));
  PetscCall(AncfGetState(s.ancf, NULL, &e, &v, &a));
  PetscCall(AncfGetLoads(s.ancf, &load));
  p = *state + 6 * (n + nb);
  PetscCall(PetscArraycpy(p, e, nn));
  PetscCall(PetscArraycpy(p + nn, v, nn));
  PetscCall(PetscArraycpy(p + 2 * nn, a, nn));
  PetscCall(PetscArraycpy(p + 3 * nn, load, nn));
  PetscCall(CoupleGetBalance(s.couple, b));
  PetscCall(CoupleDestroy(&s.couple));
  for (int k = 0; k < NBEAMS; k++) PetscCall(CoupleSurfaceDestroy(&s.inner[k]));
  PetscCall(SphDestroy(&s.sph));
  PetscCall(AncfDestroy(&s.ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestMany(CoupleLoads loads)
{
  CoupleBalance one, b;
  PetscReal *ref, largest = 0.0;
  PetscInt n, m;

  PetscFunctionBegin;
  PetscCall(Run(loads, PETSC_TRUE, 1, &ref, &n, &one));
  for (PetscInt i = n - 18 * NBEAMS; i < n; i++) largest = PetscMax(largest, PetscAbsReal(ref[i]));
  TEST(largest > 1e-6, "%s: largest load on the beams %g N: there must be some", CoupleLoadsTypes[loads], (double)largest);
  for (int threads = 1; threads <= 3; threads++) {
    PetscReal *x;
    PetscBool same;

    PetscCall(Run(loads, PETSC_FALSE, threads, &x, &m, &b));
    PetscCall(PetscArraycmp(x, ref, n, &same));
    TEST(same && m == n, "%s: other bits with %d threads than one after the other", CoupleLoadsTypes[loads], threads);
    for (int k = 0; k < 3; k++)
      TEST(b.residual[k] == one.residual[k] && b.structure[k] == one.structure[k],
           "%s, %d threads: balance %g, %g kg m/s along %d", CoupleLoadsTypes[loads], threads, (double)b.residual[k],
           (double)one.residual[k], k);
    PetscCall(PetscFree(x));
  }
  PetscCall(PetscFree(ref));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TestMany(COUPLE_LOADS_CONSTANT));
  PetscCall(TestMany(COUPLE_LOADS_LINEAR));
  PetscCall(PetscFinalize());
  return test_report();
}
