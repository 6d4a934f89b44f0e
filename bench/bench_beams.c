/*
  bench_beams.c - time and memory of implicit beam steps with each linear solver, in one run on one core.

    bench_beams [-beams 10000] [-elements 4] [-steps 10] [-newton 2] [-solvers blocktri,baij,...] [-more "-ancf_... ..."]

  Clamped beams of the seed (Pazouki, Serban, Negrut, Sect. 4) with slightly different lengths, released from horizontal, at
  dt = 1e-3 s with alpha2. -newton n fixes the Newton iterations per step; 0 leaves them to the default tolerances.
  Memory is the growth of the resident set from before AncfCreate() to after the steps.
*/
#define _POSIX_C_SOURCE 200809L
#include "ancf.h"
#include <malloc.h>
#include <petsctime.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

typedef struct {
  const char *name, *options;
} Solver;

static const Solver solvers[] = {
    {"default", ""},
    {"blocktri", "-ancf_pc_type blocktri"},
    {"baij", "-ancf_mat_type seqbaij -ancf_pc_type ilu"},
    {"aij", "-ancf_mat_type seqaij -ancf_pc_type lu -ancf_pc_factor_mat_ordering_type natural"},
    {"klu", "-ancf_mat_type seqaij -ancf_pc_type lu -ancf_pc_factor_mat_solver_type klu"},
    {"umfpack", "-ancf_mat_type seqaij -ancf_pc_type lu -ancf_pc_factor_mat_solver_type umfpack"},
    {"cholmod", "-ancf_mat_type seqaij -ancf_pc_type cholesky -ancf_pc_factor_mat_solver_type cholmod"},
};

/* Of all threads; a busy machine stretches the wall clock but hardly this. */
static double CpuSeconds(void)
{
  struct timespec t;

  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double ResidentBytes(void)
{
  long pages = 0, resident = 0;
  FILE *f = fopen("/proc/self/statm", "r");

  if (f) {
    if (fscanf(f, "%ld %ld", &pages, &resident) != 2) resident = 0;
    fclose(f);
  }
  return (double)resident * (double)sysconf(_SC_PAGESIZE);
}

static PetscErrorCode Create(PetscInt beams, PetscInt elements, const char options[], Ancf *ancf)
{
  PetscOptions db;
  PetscReal g[3] = {0, 0, -9.81};

  PetscFunctionBegin;
  PetscCall(AncfCreate(PETSC_COMM_SELF, ancf));
  for (PetscInt b = 0; b < beams; b++) {
    AncfBeamSpec s;

    PetscCall(AncfBeamSpecInit(&s));
    s.start[1] = s.end[1] = 0.1 * (PetscReal)b;
    s.end[0] = 1 + 0.1 * (PetscReal)(b % 7) / 7;
    s.elements = elements;
    s.diameter = 0.04;
    s.density = 7200;
    s.young = 20e6;
    s.end0 = ANCF_END_CLAMP;
    PetscCall(AncfAddBeam(*ancf, &s, NULL));
  }
  PetscCall(AncfSetGravity(*ancf, g));
  PetscCall(PetscOptionsCreate(&db));
  PetscCall(PetscOptionsInsertString(db, options));
  PetscCall(PetscOptionsPush(db));
  PetscCall(AncfSetFromOptions(*ancf));
  PetscCall(AncfSetUp(*ancf));
  PetscCall(PetscOptionsPop());
  PetscCall(PetscOptionsDestroy(&db));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Run(const Solver *s, const char more[], PetscInt beams, PetscInt elements, PetscInt steps, PetscInt newton)
{
  const PetscReal dt = 1e-3;
  PetscReal W;
  double before, after;
  char options[1024];
  PetscLogDouble t0, t1, c0, c1;
  PetscInt n0[3], n[3];
  Ancf a;

  PetscFunctionBegin;
  malloc_trim(0);
  before = ResidentBytes();
  if (newton > 0)
    snprintf(options, sizeof(options), "%s %s -ancf_snes_max_it %d -ancf_snes_convergence_test skip", s->options, more,
             (int)newton);
  else
    snprintf(options, sizeof(options), "%s %s", s->options, more);
  PetscCall(Create(beams, elements, options, &a));
  PetscCall(AncfAdvance(a, dt));
  PetscCall(AncfGetCounts(a, &n0[0], &n0[1], &n0[2]));
  PetscCall(PetscTime(&t0));
  c0 = CpuSeconds();
  for (PetscInt i = 2; i <= steps + 1; i++) PetscCall(AncfAdvance(a, (PetscReal)i * dt));
  PetscCall(PetscTime(&t1));
  c1 = CpuSeconds();
  PetscCall(AncfGetCounts(a, &n[0], &n[1], &n[2]));
  after = ResidentBytes();
  PetscCall(AncfGetEnergy(a, NULL, &W, NULL));
  printf("%-10s %8.3f us/element/step (%.3f of CPU)   %5.2f Newton/step   %7.2f KB/element   elastic energy %.10e J\n", s->name,
         (t1 - t0) * 1e6 / ((double)steps * (double)beams * (double)elements),
         (c1 - c0) * 1e6 / ((double)steps * (double)beams * (double)elements), (double)(n[1] - n0[1]) / (double)(n[0] - n0[0]),
         (after - before) / 1024 / ((double)beams * (double)elements), (double)W);
  fflush(stdout);
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscInt beams = 10000, elements = 4, steps = 10, newton = 2, n = 16;
  char *names[16], more[512] = "";
  PetscBool given;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-beams", &beams, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-elements", &elements, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-steps", &steps, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-newton", &newton, NULL));
  PetscCall(PetscOptionsGetString(NULL, NULL, "-more", more, sizeof(more), NULL));
  PetscCall(PetscOptionsGetStringArray(NULL, NULL, "-solvers", names, &n, &given));
  printf("%d beams of %d elements, %d steps of alpha2\n", (int)beams, (int)elements, (int)steps);
  for (size_t k = 0; k < sizeof(solvers) / sizeof(solvers[0]); k++) {
    PetscBool wanted = given ? PETSC_FALSE : PETSC_TRUE;

    for (PetscInt i = 0; given && i < n; i++)
      if (!strcmp(names[i], solvers[k].name)) wanted = PETSC_TRUE;
    if (wanted) PetscCall(Run(&solvers[k], more, beams, elements, steps, newton));
  }
  for (PetscInt i = 0; given && i < n; i++) PetscCall(PetscFree(names[i]));
  return PetscFinalize();
}
