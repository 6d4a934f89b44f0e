/*
  test_sph_slip.c - free-slip walls, the warning about the speed of sound, the floor of the time step.

  A channel between free-slip walls under a body force f for a time t: the fluid moves as one block, u = f t. What is left of
  friction comes from rows of markers that slide over rows of wall markers, whose pressures and densities they disturb: a fraction
  of the compression that V_max^2/c_s^2 = 1 % allows; bound 0.1 % of f t. With no-slip walls the markers at the wall lose almost
  half.
*/
#include "sphcase.h"

static FlowCase Channel(PetscReal f)
{
  return (FlowCase){.dim = 2,
                    .dp = 0.05,
                    .hi = {0.6, 1, 0},
                    .periodic = {PETSC_TRUE, PETSC_FALSE, PETSC_FALSE},
                    .wall = {0, 0, 1, 1, 0, 0},
                    .rho = 1000.0,
                    .mu = 1.0,
                    .vmax = 0.1,
                    .f = {f, 0, 0},
                    .hratio = 1.2,
                    .xsph = -1.0};
}

static PetscErrorCode Slowest(SphSlipType slip, PetscBool pergroup, PetscReal t, double *least, double *most)
{
  const FlowCase c = Channel(0.01);
  Sph sph;
  PetscInt n, nb, group;
  PetscReal *v;

  PetscFunctionBegin;
  PetscCall(FlowFluid(&c, &sph));
  PetscCall(SphSetPrecision(sph, SPH_PRECISION_DOUBLE));
  if (!pergroup) PetscCall(SphSetSlip(sph, slip));
  PetscCall(FlowWalls(&c, sph, &group));
  if (pergroup) PetscCall(SphSetGroupSlip(sph, group, slip));
  PetscCall(SphSetUp(sph));
  PetscCall(FlowRun(sph, t));
  PetscCall(SphGetCounts(sph, &n, &nb, NULL));
  PetscCall(PetscMalloc1(3 * (size_t)(n + nb), &v));
  PetscCall(SphGetFields(sph, &(SphFields){.v = v}));
  *least = *most = v[0];
  for (PetscInt i = 0; i < n; i++) {
    *least = PetscMin(*least, v[3 * i]);
    *most = PetscMax(*most, v[3 * i]);
  }
  PetscCall(PetscFree(v));
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Ignore(MPI_Comm comm, int line, const char *fun, const char *file, PetscErrorCode n, PetscErrorType p,
                             const char *mess, void *ctx)
{
  (void)comm, (void)line, (void)fun, (void)file, (void)p;
  if (mess && mess[0]) snprintf((char *)ctx, 512, "%s", mess);
  return n;
}

/* A floor above the stable step is one error that names both. */
static PetscErrorCode Floor(void)
{
  const FlowCase c = Channel(0.0);
  char message[512] = "";
  PetscErrorCode ierr;
  PetscReal dt;
  PetscInt group;
  Sph sph;

  PetscFunctionBegin;
  PetscCall(FlowFluid(&c, &sph));
  PetscCall(SphSetMinTimeStep(sph, 1.0));
  PetscCall(FlowWalls(&c, sph, &group));
  PetscCall(SphSetUp(sph));
  PetscCall(PetscPushErrorHandler(Ignore, message));
  ierr = SphComputeTimeStep(sph, &dt);
  PetscCall(PetscPopErrorHandler());
  TEST(ierr == PETSC_ERR_CONV_FAILED && strstr(message, "sph_dt_min = 1"), "error %d, '%s'", (int)ierr, message);
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The warning goes to PETSC_STDERR once, and names the speed and the speed of sound it needs. */
static PetscErrorCode Warning(void)
{
  FlowCase c = Channel(0.0);
  char text[2048] = "";
  FILE *keep = PETSC_STDERR, *file = tmpfile();
  PetscReal dt;
  Sph sph;
  PetscInt group, lines = 0;
  SphFields f = {0};
  PetscReal *v;
  PetscInt n, nb;

  PetscFunctionBegin;
  PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "no temporary file");
  PetscCall(FlowFluid(&c, &sph));
  PetscCall(FlowWalls(&c, sph, &group));
  PetscCall(SphSetUp(sph));
  PetscCall(SphGetCounts(sph, &n, &nb, NULL));
  PetscCall(PetscCalloc1(3 * (size_t)(n + nb), &v));
  PETSC_STDERR = file;
  PetscCall(SphComputeTimeStep(sph, &dt));
  for (PetscInt i = 0; i < n; i++) v[3 * i] = 0.4; /* 0.4 of c_s = 1 m/s */
  f.v = v;
  PetscCall(SphSetFields(sph, &f));
  PetscCall(SphComputeTimeStep(sph, &dt));
  PetscCall(SphComputeTimeStep(sph, &dt));
  PETSC_STDERR = keep;
  rewind(file);
  while (fgets(text, sizeof(text), file)) lines++;
  fclose(file);
  TEST(lines == 1, "%d lines of warning, expected 1", (int)lines);
  TEST(strstr(text, "sph_sound_speed should be at least 4"), "the warning reads '%s'", text);
  PetscCall(PetscFree(v));
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  double least, most;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  for (int pergroup = 0; pergroup < 2; pergroup++) {
    PetscCall(Slowest(SPH_SLIP_FREE, pergroup ? PETSC_TRUE : PETSC_FALSE, 2.0, &least, &most));
    printf("free slip%s: velocities %.9f to %.9f m/s, exact 0.02\n", pergroup ? " of one group" : "", least, most);
    TEST_REL(least, 0.02, 1e-3, "slowest marker between free-slip walls");
    TEST_REL(most, 0.02, 1e-3, "fastest marker between free-slip walls");
  }
  PetscCall(Slowest(SPH_SLIP_NONE, PETSC_FALSE, 2.0, &least, &most));
  printf("no slip: velocities %.9f to %.9f m/s\n", least, most);
  TEST(least < 0.019, "no slip: the slowest marker has %g m/s", least);
  PetscCall(Floor());
  PetscCall(Warning());
  PetscCall(PetscFinalize());
  return test_report();
}
