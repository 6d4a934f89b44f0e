/*
  test_couple_link.c - couple_transfer generalised against markers: a beam, a free body, a fixed one, a sliding and a moving wall
  in a fluid that is periodic in x and y. -type cuda runs it on a device; test_couple_link_shim on the host's stand-in for one.

  Both ways are the same equations; differences of round-off grow to at most 3e-8 of each field's scale in 10 steps (derived in
  test_cuda_device.c; double precision).
*/
#include "couple.h"
#include "sphfill.h"
#include "testerror.h"
#if defined(CUDA_SHIM)
  #include "cuda_shim.h"
#endif
#include <string.h>

#define DP 0.02
#define STEPS 10

static const double hi[3] = {0.3, 0.28, 0.24}, ball[2][4] = {{0.1, 0.08, 0.1, 0.04}, {0.22, 0.06, 0.16, 0.03}}, beam_y = 0.2,
                    beam_z = 0.12, beam_r = 0.02, floor_v[3] = {0.2, 0.1, 0.0};
static char type[16] = SPHCPU;

typedef struct {
  Sph sph;
  Ancf ancf;
  Rigid rigid;
  Couple couple;
} System;

static PetscBool Outside(const PetscReal x[3], void *ctx)
{
  const double dy = x[1] - beam_y, dz = x[2] - beam_z;

  (void)ctx;
  for (int b = 0; b < 2; b++) {
    double r2 = 0.0;
    for (int k = 0; k < 3; k++) r2 += PetscSqr(x[k] - ball[b][k]);
    if (r2 < PetscSqr(ball[b][3])) return PETSC_FALSE;
  }
  return x[0] > 0.06 && x[0] < 0.24 && dy * dy + dz * dz < beam_r * beam_r ? PETSC_FALSE : PETSC_TRUE;
}

static PetscErrorCode MakeFluid(const char *backend, SphPrecision precision, Sph *sph)
{
  const PetscReal lo[3] = {0, 0, 0};
  const PetscBool per[3] = {PETSC_TRUE, PETSC_TRUE, PETSC_FALSE};
  PetscReal *x, *v;
  PetscInt n;

  PetscFunctionBegin;
  PetscCall(SphCreate(PETSC_COMM_SELF, sph));
  PetscCall(SphSetType(*sph, backend));
  PetscCall(SphSetSpacing(*sph, DP));
  PetscCall(SphSetMaxSpeed(*sph, 1.0));
  PetscCall(SphSetViscosity(*sph, 1.0));
  PetscCall(SphSetDomain(*sph, lo, hi));
  PetscCall(SphSetPeriodic(*sph, per));
  PetscCall(SphSetPrecision(*sph, precision));
  PetscCall(SphFillBox(3, DP, lo, hi, Outside, NULL, &n, &x));
  PetscCall(PetscMalloc1(3 * (size_t)n, &v));
  for (PetscInt i = 0; i < n; i++) {
    v[3 * i] = 0.3 * sin(2.0 * PETSC_PI * x[3 * i + 1] / hi[1]);
    v[3 * i + 1] = 0.2 * sin(2.0 * PETSC_PI * x[3 * i] / hi[0]);
    v[3 * i + 2] = 0.0;
  }
  PetscCall(SphAddFluid(*sph, n, x, v, NULL));
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Add(System *s, CoupleSurface surface)
{
  PetscFunctionBegin;
  PetscCall(CoupleAddSurface(s->couple, surface));
  PetscCall(CoupleSurfaceDestroy(&surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MakeWalls(System *s, PetscReal support)
{
  const PetscReal lo[3] = {0, 0, 0}, velocity[2][3] = {{floor_v[0], floor_v[1], floor_v[2]}, {0.5, 0.0, 0.0}};
  const PetscBool per[3] = {PETSC_TRUE, PETSC_TRUE, PETSC_FALSE};

  PetscFunctionBegin;
  for (int w = 0; w < 2; w++) {
    PetscBool face[6] = {PETSC_FALSE, PETSC_FALSE, PETSC_FALSE, PETSC_FALSE, PETSC_FALSE, PETSC_FALSE};
    PetscReal *x, *volume, *depth;
    CoupleSurface surface;
    PetscInt n;
    face[4 + w] = PETSC_TRUE;
    PetscCall(SphFillWalls(3, DP, lo, hi, face, per, support, &n, &x, &volume, &depth));
    PetscCall(CoupleSurfaceCreateWall(PETSC_COMM_SELF, w ? "lid" : "floor", n, x, volume, depth, velocity[w], &surface));
    PetscCall(CoupleSurfaceSetSliding(surface, w ? PETSC_FALSE : PETSC_TRUE));
    PetscCall(Add(s, surface));
    PetscCall(PetscFree(x));
    PetscCall(PetscFree(volume));
    PetscCall(PetscFree(depth));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MakeBeam(System *s, PetscReal support)
{
  const PetscReal g[3] = {0, 0, -9.81};
  CoupleSurface surface;
  AncfBeamSpec beam;
  PetscInt id;

  PetscFunctionBegin;
  PetscCall(AncfCreate(PETSC_COMM_SELF, &s->ancf));
  PetscCall(AncfBeamSpecInit(&beam));
  for (int k = 0; k < 3; k++) {
    beam.start[k] = k == 0 ? 0.06 : (k == 1 ? beam_y : beam_z);
    beam.end[k] = k == 0 ? 0.24 : beam.start[k];
  }
  beam.elements = 3;
  beam.diameter = 2 * beam_r;
  beam.density = 3000.0;
  beam.young = 1e6;
  beam.velocity[1] = -0.3;
  PetscCall(AncfAddBeam(s->ancf, &beam, &id));
  PetscCall(AncfSetGravity(s->ancf, g));
  PetscCall(AncfSetSubsteps(s->ancf, 2));
  PetscCall(AncfSetUp(s->ancf));
  PetscCall(CoupleSurfaceCreateBeam(s->ancf, id, 3, DP, support, &surface));
  PetscCall(Add(s, surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MakeBalls(System *s, PetscReal support)
{
  CoupleSurface surface;
  PetscInt id[2];

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &s->rigid));
  for (int b = 0; b < 2; b++) {
    RigidBodySpec spec;
    PetscCall(RigidBodySpecInit(&spec));
    spec.shape = RIGID_SPHERE;
    spec.motion = b ? RIGID_FIXED : RIGID_FREE;
    spec.size[0] = ball[b][3];
    spec.density = 2000.0;
    for (int k = 0; k < 3; k++) {
      spec.position[k] = ball[b][k];
      spec.velocity[k] = b ? 0.0 : 0.2 - 0.1 * k;
      spec.omega[k] = b ? 0.0 : 5.0 + k;
    }
    PetscCall(RigidAddBody(s->rigid, &spec, &id[b]));
  }
  PetscCall(RigidSetUp(s->rigid));
  for (int b = 0; b < 2; b++) {
    PetscCall(CoupleSurfaceCreateRigid(s->rigid, id[b], 3, DP, support, &surface));
    PetscCall(Add(s, surface));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Make(const char *backend, SphPrecision precision, CoupleTransferType transfer, System *s)
{
  PetscReal support;

  PetscFunctionBegin;
  PetscCall(MakeFluid(backend, precision, &s->sph));
  PetscCall(SphGetSupport(s->sph, &support));
  PetscCall(CoupleCreate(PETSC_COMM_SELF, &s->couple));
  PetscCall(CoupleSetSph(s->couple, s->sph));
  PetscCall(CoupleSetTransfer(s->couple, transfer));
  PetscCall(MakeWalls(s, support));
  PetscCall(MakeBeam(s, support));
  PetscCall(MakeBalls(s, support));
  PetscCall(CoupleSetUp(s->couple));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(System *s)
{
  PetscFunctionBegin;
  PetscCall(CoupleDestroy(&s->couple));
  PetscCall(SphDestroy(&s->sph));
  PetscCall(AncfDestroy(&s->ancf));
  PetscCall(RigidDestroy(&s->rigid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Steps(System *s, int n)
{
  PetscFunctionBegin;
  for (int k = 0; k < n; k++) PetscCall(CoupleStep(s->couple, 1.0, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* x, v of all markers, then the forces on every surface; n: markers. */
static PetscErrorCode Dump(System *s, PetscInt *n, PetscReal **d)
{
  PetscInt nf, nb, surfaces;
  SphFields f = {0};
  CoupleAudit audit;

  PetscFunctionBegin;
  PetscCall(SphGetCounts(s->sph, &nf, &nb, NULL));
  *n = nf + nb;
  PetscCall(CoupleGetNumSurfaces(s->couple, &surfaces));
  PetscCall(PetscCalloc1((size_t)(6 * *n + 7 * surfaces), d));
  f.x = *d;
  f.v = *d + 3 * *n;
  PetscCall(SphGetFields(s->sph, &f));
  for (PetscInt i = 0; i < surfaces; i++) {
    PetscCall(CoupleGetAudit(s->couple, i, &audit));
    for (int k = 0; k < 3; k++) {
      (*d)[6 * *n + 7 * i + k] = audit.force[k];
      (*d)[6 * *n + 7 * i + 3 + k] = audit.moment[k];
    }
    (*d)[6 * *n + 7 * i + 6] = audit.power;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Scales: 0.3 m, 1 m/s; forces of n markers of 0.008 kg accelerated by c_s^2/h = 4e3 m/s^2, at less than 1 m and 1 m/s. */
static PetscErrorCode Compare(const PetscReal *a, const PetscReal *b, PetscInt n, const char *what)
{
  PetscInt bad[3] = {0, 0, 0};

  PetscFunctionBegin;
  for (PetscInt i = 0; i < 3 * n; i++) {
    bad[0] += !(fabs(a[i] - b[i]) <= 3e-8 * 0.3);
    bad[1] += !(fabs(a[3 * n + i] - b[3 * n + i]) <= 3e-8);
  }
  for (PetscInt i = 6 * n; i < 6 * n + 7 * 5; i++) bad[2] += !(fabs(a[i] - b[i]) <= 3e-8 * 0.008 * 4e3 * (double)n);
  TEST(bad[0] + bad[1] + bad[2] == 0, "%s: %d positions, %d velocities, %d forces differ", what, (int)bad[0], (int)bad[1],
       (int)bad[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  What the structures received against what the markers felt: sums of n terms each, to (n + 32) 2^-53 of the magnitudes; positions
  and speeds are below 1. The torque about a beam's axis is known to be lost, and is in the audit's account.
*/
static PetscErrorCode CheckAudit(System *s)
{
  PetscInt surfaces, n;
  const PetscReal *x, *v, *f;
  CoupleAudit audit;

  PetscFunctionBegin;
  PetscCall(CoupleGetNumSurfaces(s->couple, &surfaces));
  for (PetscInt i = 0; i < surfaces; i++) {
    PetscReal size = 0.0, lost = PetscAbsReal(0.0);
    PetscCall(CoupleGetAudit(s->couple, i, &audit));
    PetscCall(CoupleGetMarkers(s->couple, i, &n, &x, &v, &f));
    for (PetscInt j = 0; j < 3 * n; j++) size += fabs(f[j]);
    for (int k = 0; k < 3; k++) lost = PetscMax(lost, PetscMax(fabs(audit.force_lost[k]), fabs(audit.moment_lost[k])));
    lost = PetscMax(lost, fabs(audit.power_lost));
    TEST(size > 0.0 && lost <= 4.0 * (double)(n + 32) * 1.2e-16 * size, "surface %d lost %g of the markers' %g N", (int)i, lost,
         size);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The markers that CoupleGetMarkers() makes up are those of the fluid: to a few roundings of 0.3 m and 1 m/s (one copy may be
 * fused). */
static PetscErrorCode CheckMarkers(System *s)
{
  PetscInt surfaces, nf, nb, n, at, bad = 0;
  const PetscReal *x, *v, *f;
  SphFields all = {0};

  PetscFunctionBegin;
  PetscCall(SphGetCounts(s->sph, &nf, &nb, NULL));
  PetscCall(PetscMalloc2(3 * (size_t)(nf + nb), &all.x, 3 * (size_t)(nf + nb), &all.v));
  PetscCall(SphGetFields(s->sph, &all));
  PetscCall(CoupleGetNumSurfaces(s->couple, &surfaces));
  at = 3 * nf;
  for (PetscInt i = 0; i < surfaces; i++) {
    PetscCall(CoupleGetMarkers(s->couple, i, &n, &x, &v, &f));
    for (PetscInt j = 0; j < 3 * n; j++, at++) bad += !(fabs(all.x[at] - x[j]) <= 1e-15 && fabs(all.v[at] - v[j]) <= 4e-15);
  }
  TEST(bad == 0 && at == 3 * (nf + nb), "%d of the markers' numbers are not those of the fluid", (int)bad);
  PetscCall(PetscFree2(all.x, all.v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The floor slides: its markers are where the filling put them, layers of DP below z = 0, and have its velocity; the lid's have
 * moved. */
static PetscErrorCode CheckWalls(System *s)
{
  const PetscReal *x, *v, *f;
  PetscInt n, moved = 0, bad = 0;

  PetscFunctionBegin;
  for (PetscInt w = 0; w < 2; w++) {
    PetscCall(CoupleGetMarkers(s->couple, w, &n, &x, &v, &f));
    for (PetscInt j = 0; j < n; j++) {
      const PetscReal cell = x[3 * j] / DP - 0.5;
      if (w)
        moved += fabs(cell - round(cell)) * DP > 1e-6;
      else
        bad += !(fabs(cell - round(cell)) < 1e-12 && v[3 * j] == floor_v[0] && v[3 * j + 1] == floor_v[1] && v[3 * j + 2] == 0.0);
    }
    TEST(w ? moved == n : bad == 0, "wall %d of %d markers: %d off the place or speed, %d moved", (int)w, (int)n, (int)bad,
         (int)moved);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestSame(void)
{
  PetscReal *d[2];
  PetscInt n = 0;

  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) {
    System s;
    PetscCall(Make(type, SPH_PRECISION_DOUBLE, k ? COUPLE_TRANSFER_GENERALISED : COUPLE_TRANSFER_MARKERS, &s));
    PetscCall(Steps(&s, STEPS));
    PetscCall(Dump(&s, &n, &d[k]));
    PetscCall(CheckAudit(&s));
    PetscCall(CheckMarkers(&s));
    PetscCall(CheckWalls(&s));
    PetscCall(Destroy(&s));
  }
  PetscCall(Compare(d[0], d[1], n, "generalised transfer against markers"));
  PetscCall(PetscFree(d[0]));
  PetscCall(PetscFree(d[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Back to a saved state, with markers linked: the same bits again. */
static PetscErrorCode TestRollBack(void)
{
  CoupleState state = NULL;
  PetscReal *d[2];
  PetscInt n = 0;
  System s;

  PetscFunctionBegin;
  PetscCall(Make(type, SPH_PRECISION_SINGLE, COUPLE_TRANSFER_GENERALISED, &s));
  PetscCall(Steps(&s, 3));
  PetscCall(CoupleSaveState(s.couple, &state));
  for (int k = 0; k < 2; k++) {
    PetscCall(Steps(&s, 4));
    PetscCall(Dump(&s, &n, &d[k]));
    PetscCall(CoupleRestoreState(s.couple, state));
  }
  TEST(!memcmp(d[0], d[1], (size_t)(6 * n + 35) * sizeof(PetscReal)), "the second run from a saved state has other bits");
  PetscCall(CoupleStateDestroy(&state));
  PetscCall(PetscFree(d[0]));
  PetscCall(PetscFree(d[1]));
  PetscCall(Destroy(&s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestRefusals(void)
{
  PetscReal x[3] = {0.1, 0.1, 0.1}, volume = 8e-6, depth = 0.0, load[6];
  PetscInt one[2] = {0, 1}, node = 3, section = 0, group;
  SphLinkSpec body = {.nsections = 1, .offset = x}, bad = {1, 1, one, &node, x, NULL, &section, x};
  System s;
  Sph sph;

  PetscFunctionBegin;
  PetscCall(MakeFluid(type, SPH_PRECISION_SINGLE, &sph));
  TEST_REFUSED(SphSetGroupLink(sph, 0, &body), "boundary group 0: must be in [0, 0)");
  PetscCall(SphAddBoundary(sph, 1, (PetscReal[3]){0.1, 0.08, 0.1}, NULL, &volume, &depth, &group));
  TEST_REFUSED(SphSetGroupLink(sph, group, &bad), "node 3 must be in [0, 1)");
  node = 0;
  section = 1;
  TEST_REFUSED(SphSetGroupLink(sph, group, &bad), "section 1 must be in [0, 1)");
  bad.nsections = 0;
  TEST_REFUSED(SphSetGroupLink(sph, group, &bad), "nsections = 0");
  TEST_REFUSED(SphSetGroupState(sph, group, x), "must come after SphSetUp()");
  PetscCall(SphSetGroupLink(sph, group, &body));
  TEST_REFUSED(SphSetGroupLink(sph, group, &body), "is linked already");
  PetscCall(SphSetUp(sph));
  TEST_REFUSED(SphSetBoundaryMotion(sph, group, x, x, NULL), "is linked");
  TEST_REFUSED(SphGetGroupLoad(sph, group, load, NULL), "SphSetGroupState() comes first");
  PetscCall(SphDestroy(&sph));
  PetscCall(Make(type, SPH_PRECISION_SINGLE, COUPLE_TRANSFER_GENERALISED, &s));
  TEST_REFUSED(CoupleSetIterations(s.couple, 5, 1e-4, 0.5), "couple_iterations = 5: must be set before CoupleSetUp()");
  TEST_REFUSED(CoupleSetTransfer(s.couple, COUPLE_TRANSFER_MARKERS), "couple_transfer = markers: cannot change");
  PetscCall(Destroy(&s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#if defined(CUDA_SHIM)
/* Whatever the number of markers, a step moves the states twice, the loads once, and the results of a few reductions. */
static PetscErrorCode TestTraffic(void)
{
  CudaShimCounts before, after;
  PetscInt states = 0, loads = 0, surfaces, n, nf, nb;
  System s;

  PetscFunctionBegin;
  PetscCall(Make(type, SPH_PRECISION_SINGLE, COUPLE_TRANSFER_AUTO, &s));
  PetscCall(CoupleGetNumSurfaces(s.couple, &surfaces));
  for (PetscInt i = 0; i < surfaces; i++) {
    PetscCall(SphGetGroupLinkSize(s.sph, i, &n, &nb));
    states += 1 + n;
    loads += nb + 11;
  }
  PetscCall(SphGetCounts(s.sph, &nf, &nb, NULL));
  PetscCall(Steps(&s, 2));
  before = cudaShimGetCounts();
  PetscCall(Steps(&s, STEPS));
  after = cudaShimGetCounts();
  const double up = (double)(after.todevice - before.todevice) / STEPS,
               down = (double)(after.fromdevice - before.fromdevice) / STEPS;
  printf("%d + %d markers: %.0f bytes to the device and %.0f from it per step, %.1f launches\n", (int)nf, (int)nb, up, down,
         (double)(after.launches - before.launches) / STEPS);
  TEST(up > 0.0 && up <= 2.0 * 8.0 * (double)states, "%g bytes went to the device per step, the states are %d numbers", up,
       (int)states);
  TEST(down > 0.0 && down <= 8.0 * (double)loads + 512.0, "%g bytes came from the device per step, the loads are %d numbers",
       down, (int)loads);
  TEST(after.mallocs == before.mallocs, "%ld allocations in %d steps", after.mallocs - before.mallocs, STEPS);
  PetscCall(Destroy(&s));
  TEST(cudaShimGetCounts().live == 0, "%ld objects were not freed", cudaShimGetCounts().live);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Neither the order of threads nor the time at which the stream's work runs shows in the bits. */
static PetscErrorCode TestOrder(void)
{
  PetscReal *first = NULL, *now;
  PetscInt n;

  PetscFunctionBegin;
  for (int eager = 0; eager < 2; eager++)
    for (int order = 0; order < 3; order++) {
      System s;
      cudaShimSetOrder(order);
      cudaShimSetEager(eager);
      PetscCall(Make(type, SPH_PRECISION_SINGLE, COUPLE_TRANSFER_AUTO, &s));
      PetscCall(Steps(&s, 4));
      PetscCall(Dump(&s, &n, &now));
      PetscCall(Destroy(&s));
      if (!first) first = now;
      TEST(!memcmp(first, now, (size_t)(6 * n + 35) * sizeof(PetscReal)), "order %d, eager %d gives other bits", order, eager);
      if (now != first) PetscCall(PetscFree(now));
    }
  PetscCall(PetscFree(first));
  cudaShimSetOrder(0);
  cudaShimSetEager(0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The device path with generalised transfer against the CPU backend with markers. */
static PetscErrorCode TestAgainstCpu(void)
{
  PetscReal *d[2];
  PetscInt n = 0;

  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) {
    System s;
    PetscCall(Make(k ? SPHCUDA : SPHCPU, SPH_PRECISION_DOUBLE, COUPLE_TRANSFER_AUTO, &s));
    PetscCall(Steps(&s, STEPS));
    PetscCall(Dump(&s, &n, &d[k]));
    PetscCall(Destroy(&s));
  }
  PetscCall(Compare(d[0], d[1], n, "device against CPU"));
  PetscCall(PetscFree(d[0]));
  PetscCall(PetscFree(d[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
#endif

int main(int argc, char **argv)
{
  PetscBool cuda, resident = PETSC_TRUE;
  Sph sph;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-type", type, sizeof(type), NULL));
  PetscCall(PetscStrcmp(type, SPHCUDA, &cuda));
  PetscCall(SphCreate(PETSC_COMM_SELF, &sph));
  PetscCall(SphSetType(sph, SPHAUTO));
  if (cuda) PetscCall(SphGetResident(sph, &resident));
  PetscCall(SphDestroy(&sph));
  if (!resident) {
    printf("no CUDA device: skipped\n");
    PetscCall(PetscFinalize());
    return 77;
  }
  PetscCall(TestSame());
  PetscCall(TestRollBack());
  PetscCall(TestRefusals());
#if defined(CUDA_SHIM)
  PetscCall(TestTraffic());
  PetscCall(TestOrder());
  PetscCall(TestAgainstCpu());
#endif
  PetscCall(PetscFinalize());
  return test_report();
}
