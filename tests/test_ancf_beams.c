/* test_ancf_beams.c - a set of beams: reactions, buoyancy, supports, tubes, threads; what it refuses, and failures at run time.
 */
#include "ancf_common.h"
#if defined(_OPENMP)
  #include <omp.h>
#endif

/* The support carries m (a_cm - g): dp/dt by central differences of the momentum = weight + reaction.
   Largest frequency 1e3 rad/s: (w dt)^2/6 = 7e-5 of the axial oscillation, allowed 5e-4 of the weight of 88.8 N. */
static PetscErrorCode TestReaction(void)
{
  const PetscReal dt = 2e-5, tol = 0.5 * 88.8e-3;
  AncfBeamSpec s;
  Ancf a;
  PetscReal p0[3], p1[3], f[3] = {0}, w[3];

  PetscFunctionBegin;
  PetscCall(SeedSpec(2, &s));
  PetscCall(BeamCreate(&s, -9.81, "-ancf_ts_alpha_radius 1", &a));
  PetscCall(AncfGetWeight(a, w));
  TEST_REL(w[2], -7200 * PETSC_PI * 4e-4 * 9.81, 1e-12, "weight rho_s A L g");
  for (int i = 1; i <= 1001; i++) {
    PetscCall(AncfAdvance(a, dt * i));
    if (i == 999) PetscCall(AncfGetMomentum(a, p0, NULL));
    if (i == 1000) PetscCall(AncfGetReaction(a, f));
  }
  PetscCall(AncfGetMomentum(a, p1, NULL));
  for (int c = 0; c < 3; c++) TEST_NEAR((p1[c] - p0[c]) / (2 * dt), f[c] + w[c], tol, "dp/dt = weight + reaction");
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Buoyancy (rho_s A - rho A_outer) g, also after a change of fluid density. */
static PetscErrorCode TestBuoyancy(void)
{
  AncfBeamSpec s;
  Ancf a;
  PetscReal w[3];

  PetscFunctionBegin;
  PetscCall(SeedSpec(3, &s));
  PetscCall(BeamCreate(&s, -9.81, "-ancf_fluid_density 1000", &a));
  PetscCall(AncfGetWeight(a, w));
  TEST_REL(w[2], -6200 * PETSC_PI * 4e-4 * 9.81, 1e-12, "buoyant weight");
  PetscCall(AncfSetFluidDensity(a, 0));
  PetscCall(AncfGetWeight(a, w));
  TEST_REL(w[2], -7200 * PETSC_PI * 4e-4 * 9.81, 1e-12, "weight in vacuum");
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A beam pinned in the middle as well: its deflection under a uniform load is that of a continuous beam over two spans. */
static PetscErrorCode TestInnerSupport(void)
{
  const PetscReal q[3] = {0, 0, -1e-3};
  PetscReal f[6], l = 0;
  AncfBeamSpec s;
  Ancf a;

  PetscFunctionBegin;
  PetscCall(SeedSpec(8, &s));
  s.end0 = s.end1 = ANCF_END_PIN;
  PetscCall(AncfCreate(PETSC_COMM_SELF, &a));
  PetscCall(AncfAddBeam(a, &s, NULL));
  PetscCall(AncfFixNode(a, 0, 4, ANCF_END_PIN));
  PetscCall(AncfSetUp(a));
  PetscCall(AncfAddLineLoad(a, 0, q));
  PetscCall(AncfSolveStatic(a, 1));
  PetscCall(AncfGetNodeReaction(a, 0, 4, f));
  TEST_REL(f[2], 1e-3 * 10. / 16, 1e-5, "middle support carries 5/8 of the load"); /* two spans of L/2: 10/8 q (L/2) */
  PetscCall(AncfGetBeam(a, 0, NULL, NULL, &l));
  TEST_REL(l, 0.125, 1e-15, "element length");
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Enough beams to be shared out: the same bits for 1, 2 and 3 threads. */
static PetscErrorCode TestThreads(const char options[])
{
  const PetscReal g[3] = {0, 0, -9.81};
  const PetscInt nbeams = 9 * 64 + 5;
  PetscReal *x[3];

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    const PetscReal *p[3];
    PetscInt n = 0;
    Ancf a;

#if defined(_OPENMP)
    omp_set_num_threads(k + 1);
#endif
    PetscCall(AncfCreate(PETSC_COMM_SELF, &a));
    for (PetscInt b = 0; b < nbeams; b++) {
      AncfBeamSpec s;

      PetscCall(SeedSpec(1 + b % 3, &s));
      s.start[1] = s.end[1] = 0.1 * (PetscReal)b;
      s.end[0] = 1 + 0.1 * (PetscReal)(b % 7);
      PetscCall(AncfAddBeam(a, &s, NULL));
      n += 6 * (s.elements + 1);
    }
    PetscCall(AncfSetGravity(a, g));
    PetscCall(SetUpWith(a, options, NULL));
    for (int i = 1; i <= 5; i++) PetscCall(AncfAdvance(a, 1e-3 * i));
    PetscCall(AncfGetState(a, NULL, &p[0], &p[1], &p[2]));
    PetscCall(PetscMalloc1(3 * n, &x[k]));
    for (int q = 0; q < 3; q++) PetscCall(PetscArraycpy(x[k] + q * n, p[q], n));
    TEST(!memcmp(x[k], x[0], sizeof(PetscReal) * 3 * (size_t)n), "%s: %d threads give other bits than one", options, k + 1);
    TEST(x[k][n - 4] < 0, "%s: the last beam does not fall", options);
    PetscCall(AncfDestroy(&a));
  }
  for (int k = 0; k < 3; k++) PetscCall(PetscFree(x[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A tube weighs and bends like the difference of two rods, and displaces fluid like its outer diameter. */
static PetscErrorCode TestAnnulus(void)
{
  const PetscReal g[3] = {0, 0, -9.81}, E = 20e6, Ixx = PETSC_PI / 64 * (2.56e-6 - 8.1e-7),
                  A = PETSC_PI / 4 * (1.6e-3 - 9e-4); /* 0.04 and 0.03 m */
  PetscReal w[3], F[3] = {0, 0, 1e-4};
  const PetscReal *e;
  AncfBeamSpec s;
  Ancf a;

  PetscFunctionBegin;
  PetscCall(SeedSpec(4, &s));
  PetscCall(AncfBeamSpecSetAnnulus(&s, 0.03));
  PetscCall(AncfCreate(PETSC_COMM_SELF, &a));
  PetscCall(AncfAddBeam(a, &s, NULL));
  PetscCall(AncfSetUp(a));
  PetscCall(AncfAddPointLoad(a, 0, 1, F));
  PetscCall(AncfSolveStatic(a, 1));
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  TEST_REL(e[26], F[2] / (3 * E * Ixx), 1e-6, "deflection F L^3/(3 EI) of a tube"); /* cubic: exact but for (v/L)^2 */
  PetscCall(AncfSetFluidDensity(a, 1000));
  PetscCall(AncfSetGravity(a, g));
  PetscCall(AncfGetWeight(a, w));
  TEST_REL(w[2], F[2] - 9.81 * (7200 * A - 1000 * PETSC_PI * 4e-4), 1e-12, "weight of a tube under water, its load included");
  PetscCall(AncfDestroy(&a));
  TEST_ERROR(AncfBeamSpecSetAnnulus(&s, 0.04), PETSC_ERR_ARG_OUTOFRANGE, "inner diameter");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddBad(AncfBeamSpec s)
{
  Ancf a;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(AncfCreate(PETSC_COMM_SELF, &a));
  ierr = AncfAddBeam(a, &s, NULL);
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(ierr);
}

static PetscErrorCode CreateBad(const char options[])
{
  AncfBeamSpec s;
  Ancf a = NULL;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(SeedSpec(2, &s));
  ierr = BeamCreate(&s, -9.81, options, &a);
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(ierr);
}

static PetscErrorCode TestBadInput(void)
{
  AncfBeamSpec good, s;
  const PetscReal bad[4] = {0, -1, NAN, INFINITY};
  Ancf a;

  PetscFunctionBegin;
  PetscCall(SeedSpec(4, &good));
  for (int k = 0; k < 4; k++) {
    s = good, s.young = bad[k];
    TEST_ERROR(AddBad(s), PETSC_ERR_ARG_OUTOFRANGE, "young");
    s = good, s.density = bad[k];
    TEST_ERROR(AddBad(s), PETSC_ERR_ARG_OUTOFRANGE, "density");
    s = good, s.diameter = bad[k];
    TEST_ERROR(AddBad(s), PETSC_ERR_ARG_OUTOFRANGE, "diameter");
  }
  s = good, s.elements = 0;
  TEST_ERROR(AddBad(s), PETSC_ERR_ARG_OUTOFRANGE, "elements");
  s = good, s.end[0] = 0;
  TEST_ERROR(AddBad(s), PETSC_ERR_ARG_OUTOFRANGE, "length");
  s = good, s.end[1] = NAN;
  TEST_ERROR(AddBad(s), PETSC_ERR_ARG_OUTOFRANGE, "end");
  s = good, s.start[2] = INFINITY;
  TEST_ERROR(AddBad(s), PETSC_ERR_ARG_OUTOFRANGE, "start");
  s = good, s.EI = 0;
  TEST_ERROR(AddBad(s), PETSC_ERR_ARG_OUTOFRANGE, "EI");
  s = good, s.velocity[1] = 1;
  TEST_ERROR(AddBad(s), PETSC_ERR_ARG_INCOMP, "velocity");
  TEST_ERROR(CreateBad("-ancf_substeps 0"), PETSC_ERR_ARG_OUTOFRANGE, "-ancf_substeps 0");
  TEST_ERROR(CreateBad("-ancf_substeps 1001"), PETSC_ERR_ARG_OUTOFRANGE, "1..1000");
  TEST_ERROR(CreateBad("-ancf_gravity 1,2"), PETSC_ERR_ARG_WRONG, "-ancf_gravity");
  TEST_ERROR(CreateBad("-ancf_fluid_density -1"), PETSC_ERR_ARG_OUTOFRANGE, "-ancf_fluid_density");
  TEST_ERROR(CreateBad("-ancf_quadrature_axial 0"), PETSC_ERR_ARG_OUTOFRANGE, "-ancf_quadrature_axial");
  TEST_ERROR(CreateBad("-ancf_quadrature_bending 9"), PETSC_ERR_ARG_OUTOFRANGE, "-ancf_quadrature_bending");
  TEST_ERROR(CreateBad("-ancf_damping -1"), PETSC_ERR_ARG_OUTOFRANGE, "-ancf_damping");
  TEST_ERROR(CreateBad("-ancf_damping 1 -ancf_ts_type basicsymplectic"), PETSC_ERR_ARG_INCOMP, "-ancf_damping");
  TEST_ERROR(CreateBad("-ancf_ts_type pseudo"), PETSC_ERR_ARG_WRONG, "-ancf_ts_type pseudo");
  TEST_ERROR(CreateBad("-ancf_ts_type arkimex -ancf_ts_arkimex_type 3"), PETSC_ERR_ARG_WRONG, "-ancf_ts_arkimex_type 3");
  PetscCall(AncfCreate(PETSC_COMM_SELF, &a));
  TEST_ERROR(AncfSetUp(a), PETSC_ERR_ARG_WRONGSTATE, "no beams");
  TEST_ERROR(AncfAdvance(a, 1), PETSC_ERR_ARG_WRONGSTATE, "AncfSetUp");
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The length of the first step that TS takes from time 0 on; the monitor comes before that step's starts, too. */
static PetscErrorCode FirstStep(TS ts, PetscInt n, PetscReal t, Vec u, void *ctx)
{
  PetscFunctionBegin;
  (void)ts;
  (void)n;
  (void)u;
  if (*(PetscReal *)ctx == 0 && t > 0) *(PetscReal *)ctx = t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Failures at run time: named, and the state is the one before the call. */
static PetscErrorCode TestFailures(void)
{
  AncfBeamSpec s;
  Ancf a;
  PetscReal *Q, t, tip;
  const PetscReal *e;

  PetscFunctionBegin;
  PetscCall(SeedSpec(4, &s));
  PetscCall(BeamCreate(&s, -9.81, "", &a));
  TEST_ERROR(AncfAddBeam(a, &s, NULL), PETSC_ERR_ARG_WRONGSTATE, "after AncfSetUp");
  TEST_ERROR(AncfAdvance(a, 0), PETSC_ERR_ARG_OUTOFRANGE, "after the current time");
  PetscCall(AncfAdvance(a, 1e-2));
  PetscCall(AncfGetLoads(a, &Q));
  Q[15] = NAN;
  TEST_ERROR(AncfAdvance(a, 2e-2), PETSC_ERR_FP, "Beam 0, node 2");
  Q[15] = 0;
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  tip = e[26];
  Q[26] = 1e200; /* overflows whatever the step */
  TEST_ERROR(AncfAdvance(a, 2e-2), PETSC_ERR_NOT_CONVERGED, "beam 0, element 3 of 4, node 4");
  TEST(strstr(test_message, "at t = 0.01 s") != NULL, "'%s' does not name the time", test_message);
  PetscCall(AncfGetState(a, &t, &e, NULL, NULL));
  TEST_NEAR(t, 1e-2, 0, "time after a failure");
  TEST_NEAR(e[26], tip, 0, "tip after a failure");
  Q[26] = 0;
  PetscCall(AncfAdvance(a, 2e-2));
  PetscCall(AncfDestroy(&a));
  s.end0 = ANCF_END_FREE; /* falls for ever */
  PetscCall(BeamCreate(&s, -9.81, "", &a));
  TEST_ERROR(AncfSolveStatic(a, 2), PETSC_ERR_NOT_CONVERGED, "supports");
  PetscCall(AncfDestroy(&a));
  s.end0 = ANCF_END_CLAMP;
  /* Three iterations are too few for a step of 0.3 s, a third of the swing's period, but not for a small one: the first step
     that is taken is 0.3 s over a power of 2. */
  PetscCall(BeamCreate(&s, -9.81, "-ancf_snes_max_it 3", &a));
  {
    PetscReal first = 0, k;
    PetscInt steps;
    TS ts;

    PetscCall(AncfGetTS(a, &ts));
    PetscCall(TSMonitorSet(ts, FirstStep, &first, NULL));
    PetscCall(AncfAdvance(a, 0.3));
    k = PetscLog2Real(0.3 / first);
    TEST(first > 0 && first < 0.2 && PetscAbsReal(k - PetscFloorReal(k + 0.5)) < 1e-6, "first step %g s: not 0.3 s in halves",
         (double)first);
    PetscCall(AncfGetCounts(a, &steps, NULL, NULL));
    printf("one step of 0.3 s with at most 3 Newton iterations was taken as %d steps\n", (int)steps);
    TEST(steps > 1, "the step of 0.3 s was not reduced");
  }
  PetscCall(AncfDestroy(&a));
  PetscCall(BeamCreate(&s, -9.81, "-ancf_ts_type euler", &a)); /* unstable without damping: must end in a named error */
  {
    PetscErrorCode ierr = PETSC_SUCCESS;

    PetscCall(PetscPushErrorHandler(TestCatch, NULL));
    for (int i = 1; i <= 2000 && !ierr; i++) ierr = AncfAdvance(a, 1e-3 * i);
    PetscCall(PetscPopErrorHandler());
    TEST(ierr == PETSC_ERR_FP && strstr(test_message, "Beam 0"), "explicit Euler ended with %d '%s'", (int)ierr, test_message);
  }
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TestReaction());
  PetscCall(TestBuoyancy());
  PetscCall(TestInnerSupport());
  PetscCall(TestThreads("-ancf_ts_type alpha2"));
  PetscCall(TestThreads("-ancf_ts_type alpha2 -ancf_damping_stiffness 0.01"));
  PetscCall(TestThreads("-ancf_ts_type rk -ancf_substeps 5"));
  PetscCall(TestAnnulus());
  PetscCall(TestBadInput());
  PetscCall(TestFailures());
  PetscCall(PetscFinalize());
  return test_report();
}
