/*
  test_cuda_device.c - the device path of the CUDA backend, run on the host through tests/cuda_shim: order of threads,
  synchronisation, allocations, memory limits, and a failure of every single call.

  Results must have the same bits whatever the order of the threads of a launch (no thread may depend on another) and whether work
  of a stream runs at once or as late as possible (nothing may be read or overwritten too early).
*/
#include "cuda_shim.h"
#include "sph_conformance.h"
#include "testerror.h"
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static const Scene small = {"2d",
                            2,
                            {5, 5, 1},
                            {1, 0, 0},
                            SPH_KERNEL_CUBIC,
                            SPH_WALL_ADAMI,
                            SPH_VISCOSITY_EQ6,
                            SPH_DIFFUSION_NONE,
                            SPH_REINIT_SHEPARD,
                            SPH_INTEGRATOR_RK2,
                            0.5,
                            0.0,
                            7.0,
                            1.2};
static const Scene cube = {"3d",
                           3,
                           {6, 6, 6},
                           {0, 0, 1},
                           SPH_KERNEL_WENDLAND,
                           SPH_WALL_ADAMI,
                           SPH_VISCOSITY_EQ6,
                           SPH_DIFFUSION_FOURTAKAS,
                           SPH_REINIT_SHEPARD,
                           SPH_INTEGRATOR_RK2,
                           0.5,
                           0.0,
                           7.0,
                           1.3};
static const Scene leap = {"3d verlet",
                           3,
                           {6, 6, 6},
                           {0, 0, 0},
                           SPH_KERNEL_CUBIC,
                           SPH_WALL_BCE,
                           SPH_VISCOSITY_ARTIFICIAL,
                           SPH_DIFFUSION_MOLTENI,
                           SPH_REINIT_NONE,
                           SPH_INTEGRATOR_VERLET,
                           0.0,
                           0.0,
                           7.0,
                           1.2};

static PetscErrorCode Dump(Sph sph, double **out, PetscInt *size)
{
  const PetscInt n = sph->n;
  SphFields f = {0};

  PetscFunctionBegin;
  *size = 14 * n;
  PetscCall(PetscCalloc1(*size, out));
  f.x = *out;
  f.v = f.x + 3 * n;
  f.a = f.v + 3 * n;
  f.rho = f.a + 3 * n;
  f.p = f.rho + n;
  PetscCall(SphGetFields(sph, &f));
  for (PetscInt g = 0; g < sph->ngroups; g++)
    PetscCall(SphGetBoundaryForce(sph, g, f.p + n + 3 * (sph->groupstart[g] - sph->nfluid)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A step in which motion is set again while the device may still be reading what was set before. */
static PetscErrorCode Hurry(Sph sph, const Scene *scene)
{
  PetscReal t;

  PetscFunctionBegin;
  PetscCall(SphGetTime(sph, &t, NULL));
  PetscCall(SphStepBegin(sph, 2e-4));
  PetscCall(SceneMoveBody(sph, scene, t + 1e-4));
  PetscCall(SphStepEvaluate(sph));
  PetscCall(SceneMoveBody(sph, scene, t + 2e-4));
  PetscCall(SphStepEnd(sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* link: as group 1 is linked */
static PetscErrorCode TestOrder(const Scene *scene, SceneLink link)
{
  double *first = NULL, *now;
  PetscInt n;

  PetscFunctionBegin;
  for (int eager = 0; eager < 2; eager++)
    for (int order = 0; order < 3; order++) {
      Sph sph;
      cudaShimSetOrder(order);
      cudaShimSetEager(eager);
      PetscCall(SceneCreate(scene, SPHCUDA, SPH_PRECISION_SINGLE, &sph));
      PetscCall(SceneSetLink(sph, scene, link));
      PetscCall(SphSetUp(sph));
      for (int step = 0; step < 12; step++) PetscCall(SceneStep(sph, scene, 2e-4));
      if (scene->integrator != SPH_INTEGRATOR_VERLET) PetscCall(Hurry(sph, scene));
      PetscCall(Dump(sph, &now, &n));
      if (!first) {
        first = now;
        PetscCall(SphDestroy(&sph));
        continue;
      }
      TEST(!memcmp(first, now, (size_t)n * sizeof(double)), "%s: order %d, eager %d gives other bits", scene->name, order, eager);
      PetscCall(PetscFree(now));
      PetscCall(SphDestroy(&sph));
    }
  PetscCall(PetscFree(first));
  cudaShimSetOrder(0);
  cudaShimSetEager(0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A step allocates nothing, and nothing is left behind. */
static PetscErrorCode TestAllocation(void)
{
  Sph sph;
  CudaShimCounts before, after;

  PetscFunctionBegin;
  PetscCall(SceneCreate(&cube, SPHCUDA, SPH_PRECISION_SINGLE, &sph));
  PetscCall(SphSetUp(sph));
  before = cudaShimGetCounts();
  for (int step = 0; step < 40; step++) PetscCall(SceneStep(sph, &cube, 2e-4));
  after = cudaShimGetCounts();
  TEST(after.mallocs == before.mallocs && after.launches > before.launches, "40 steps made %ld allocations",
       after.mallocs - before.mallocs);
  printf("device memory: %.0f bytes per marker, %.1f launches per step\n", (double)after.bytes / (double)sph->n,
         (double)(after.launches - before.launches) / 40.0);
  before = cudaShimGetCounts();
  for (int step = 0; step < 4; step++) PetscCall(SceneStep(sph, &cube, 1e-9));
  after = cudaShimGetCounts();
  /* nothing moves: 2 x (prepare, auxiliary, prepare, rates), 2 stages, 2 motions; one re-initialisation in 4 steps has 3; a sort
   * would add 24 */
  TEST(after.launches - before.launches <= 4 * 12 + 3, "4 steps at rest made %ld launches: the markers were sorted again",
       after.launches - before.launches);
  PetscCall(SphDestroy(&sph));
  TEST(cudaShimGetCounts().live == 0, "%ld objects were not freed", cudaShimGetCounts().live);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Same physics as the CPU: double precision, 10 steps. A difference of e in the state grows at most by (1 + L dt) per stage, with
  L dt of order 1 at a stable step (CFL), so by no more than 2^20 over 20 stages; sums differ by (N + 32) 2^-53 = 3e-14 of their
  terms at most: 3e-8 of the scale of each field. Fields: velocities of 1 m/s, positions of 0.1 m, accelerations of c_s^2/h = 2e4
  m/s^2.
*/
static PetscErrorCode TestAgainstCpu(const Scene *scene)
{
  double *d[2], scale[] = {0.1, 1.0, 2e4};
  PetscInt n[2], bad = 0;

  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) {
    Sph sph;
    PetscCall(SceneCreate(scene, k ? SPHCUDA : SPHCPU, SPH_PRECISION_DOUBLE, &sph));
    PetscCall(SphSetUp(sph));
    for (int step = 0; step < 10; step++) PetscCall(SceneStep(sph, scene, 2e-4));
    PetscCall(Dump(sph, &d[k], &n[k]));
    n[k] = sph->n;
    PetscCall(SphDestroy(&sph));
  }
  for (int f = 0; f < 3; f++)
    for (PetscInt i = 3 * f * n[0]; i < 3 * (f + 1) * n[0]; i++) bad += !(fabs(d[0][i] - d[1][i]) <= 3e-8 * scale[f]);
  TEST(bad == 0, "%s: %d values differ from the CPU backend after 10 steps", scene->name, (int)bad);
  PetscCall(PetscFree(d[0]));
  PetscCall(PetscFree(d[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestMemory(void)
{
  Sph sph;
  PetscErrorCode err;
  const long mallocs = cudaShimGetCounts().mallocs;

  PetscFunctionBegin;
  cudaShimSetMemory(100000);
  PetscCall(SceneCreate(&cube, SPHCUDA, SPH_PRECISION_SINGLE, &sph));
  PetscCall(PetscPushErrorHandler(TestCatch, NULL));
  err = SphSetUp(sph);
  PetscCall(PetscPopErrorHandler());
  TEST(err == PETSC_ERR_MEM, "too little device memory gave error %d", (int)err);
  TEST(strstr(test_message, "bytes of device memory, 100000 of 100000 are free"), "the message is: %s", test_message);
  TEST(cudaShimGetCounts().mallocs == mallocs, "memory was allocated before it was found too small");
  PetscCall(SphDestroy(&sph));
  cudaShimSetMemory((size_t)1 << 30);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestAbsent(void)
{
  Sph sph;
  SphType type;
  PetscErrorCode err;

  PetscFunctionBegin;
  cudaShimSetDeviceCount(0);
  PetscCall(SceneCreate(&small, SPHCUDA, SPH_PRECISION_SINGLE, &sph));
  PetscCall(PetscPushErrorHandler(TestCatch, NULL));
  err = SphSetUp(sph);
  PetscCall(PetscPopErrorHandler());
  TEST(err == PETSC_ERR_SUP_SYS && strstr(test_message, "no CUDA device"), "without a device: error %d, %s", (int)err,
       test_message);
  PetscCall(SphDestroy(&sph));
  PetscCall(SceneCreate(&small, SPHAUTO, SPH_PRECISION_SINGLE, &sph));
  PetscCall(SphSetUp(sph));
  PetscCall(SphGetType(sph, &type));
  TEST(!strcmp(type, SPHCPU), "auto without a device chose %s", type);
  PetscCall(SphDestroy(&sph));
  cudaShimSetDeviceCount(1);
  PetscCall(SceneCreate(&small, SPHAUTO, SPH_PRECISION_SINGLE, &sph));
  PetscCall(SphSetUp(sph));
  PetscCall(SphGetType(sph, &type));
  TEST(!strcmp(type, SPHCUDA), "auto with a device chose %s", type);
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A run in which call number `fail` and all later ones fail; true when it was reached. */
static PetscErrorCode RunFailing(SceneLink link, long fail, int error, PetscErrorCode *err)
{
  Sph sph;
  PetscReal dt, load[12];

  PetscFunctionBegin;
  PetscCall(SceneCreate(&small, SPHCUDA, SPH_PRECISION_SINGLE, &sph));
  PetscCall(SceneSetLink(sph, &small, link));
  test_message[0] = 0;
  PetscCall(PetscPushErrorHandler(TestCatch, NULL));
  cudaShimFailCall(fail, error);
  *err = SphSetUp(sph);
  for (int step = 0; step < 2 && !*err; step++) {
    *err = SphComputeTimeStep(sph, &dt);
    if (!*err) *err = SceneStep(sph, &small, 1e-3); /* far enough to sort again */
    if (!*err && link != SCENE_FREE) *err = SphGetGroupLoad(sph, 1, load, NULL);
  }
  if (!*err)
    *err = SphSetBoundaryMotion(sph, 5, NULL, NULL, NULL) ? PETSC_SUCCESS : PETSC_ERR_PLIB; /* a refused call changes nothing */
  PetscCall(SphDestroy(&sph));
  cudaShimFailCall(-1, 0);
  PetscCall(PetscPopErrorHandler());
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestEveryFailure(SceneLink link)
{
  enum { LAUNCH_FAILURE = 719, ECC_UNCORRECTABLE = 214 };
  PetscErrorCode err = PETSC_ERR_LIB;
  long k = 0, wrong = 0, leaks = 0;

  PetscFunctionBegin;
  for (k = 0; err; k++) { /* until the run is over before call k */
    PetscCall(RunFailing(link, k, LAUNCH_FAILURE, &err));
    if (!err) break;
    wrong += !(k == 0 ? strstr(test_message, "no CUDA device") : strstr(test_message, "cudaErrorLaunchFailure")) ||
             !(k == 0 || strchr(test_message, '('));
    leaks += cudaShimGetCounts().live;
  }
  TEST(k > 100 && k < 2000 && wrong == 0, "%ld of %ld failing calls gave no clear error (the last: %s)", wrong, k, test_message);
  TEST(leaks == 0, "%ld objects were not freed after failures", leaks);
  printf("%ld CUDA calls failed one after another\n", k);
  PetscCall(RunFailing(link, 100, ECC_UNCORRECTABLE, &err));
  TEST(err && strstr(test_message, "absent or lost"), "a lost device: %s", test_message);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Host code that follows a device pointer dies. */
static PetscErrorCode TestAddressSpaces(void)
{
  Sph sph;
  int status = 0;
  pid_t pid;

  PetscFunctionBegin;
  PetscCall(SceneCreate(&small, SPHCUDA, SPH_PRECISION_SINGLE, &sph));
  PetscCall(SphSetUp(sph));
  fflush(stdout);
  pid = fork();
  if (pid == 0) {
    volatile const double *p = (volatile const double *)cudaShimSomeDeviceAddress();
    if (!freopen("/dev/null", "w", stderr)) _exit(2);
    _exit(*p > 0.0 ? 0 : 0);
  }
  (void)waitpid(pid, &status, 0);
  TEST(cudaShimSomeDeviceAddress() && !(WIFEXITED(status) && WEXITSTATUS(status) == 0), "the host read device memory");
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TestOrder(&small, SCENE_FREE));
  PetscCall(TestOrder(&cube, SCENE_FREE));
  PetscCall(TestOrder(&leap, SCENE_FREE));
  PetscCall(TestOrder(&small, SCENE_NODES));
  PetscCall(TestOrder(&leap, SCENE_BODY));
  PetscCall(TestAgainstCpu(&small));
  PetscCall(TestAgainstCpu(&cube));
  PetscCall(TestAgainstCpu(&leap));
  PetscCall(TestAllocation());
  PetscCall(TestMemory());
  PetscCall(TestAbsent());
  PetscCall(TestAddressSpaces());
  PetscCall(TestEveryFailure(SCENE_FREE));
  PetscCall(TestEveryFailure(SCENE_NODES));
  PetscCall(PetscFinalize());
  return test_report();
}
