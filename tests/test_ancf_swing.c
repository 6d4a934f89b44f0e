/*
  test_ancf_swing.c - the seed's cantilever in vacuum (Sect. 4, Fig. 3): released from horizontal, convergence with elements
  and time step, energy over 10 s, static shape, small vibrations.

  References for the swing: the same continuous model integrated by two independent codes (32 elements).
*/
#include "ancf_common.h"

#define SAMPLES 250
/* the quadrature of Gerstmayr and Shabana (2006), with which the static references were made */
#define FIVE_THREE "-ancf_quadrature_axial 5 -ancf_quadrature_bending 3"

/* Tip (x, z) every 1/SAMPLES s for one second. */
static PetscErrorCode Trajectory(PetscInt elements, PetscInt perSample, const char options[], PetscReal tip[2 * SAMPLES])
{
  AncfBeamSpec s;
  Ancf a;
  const PetscReal *e;

  PetscFunctionBegin;
  PetscCall(SeedSpec(elements, &s));
  PetscCall(BeamCreate(&s, -9.81, options, &a));
  PetscCall(AncfSetSubsteps(a, perSample));
  for (PetscInt i = 0; i < SAMPLES; i++) {
    PetscCall(AncfAdvance(a, (PetscReal)(i + 1) / SAMPLES));
    PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
    tip[2 * i] = e[6 * elements];
    tip[2 * i + 1] = e[6 * elements + 2];
  }
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Rms(const PetscReal a[2 * SAMPLES], const PetscReal b[2 * SAMPLES])
{
  PetscReal s = 0;

  for (int i = 0; i < 2 * SAMPLES; i++) s += PetscSqr(a[i] - b[i]);
  return PetscSqrtReal(s / SAMPLES);
}

/* Published to five digits; the time step of 5e-4 s adds less than 1e-5 m. */
static PetscErrorCode TestTable(const PetscReal fine[2 * SAMPLES])
{
  static const PetscReal ref[4][3] = {
      {.2, .96387, -.20358}, {.4, .42635, -.84586}, {.8, -.53485, -.38203}, {1.0, -.29002, -.59771}};

  PetscFunctionBegin;
  for (int k = 0; k < 4; k++) {
    int i = (int)(ref[k][0] * SAMPLES + 0.5) - 1;

    printf("t %.1f s: tip (%.5f, %.5f), reference (%.5f, %.5f)\n", ref[k][0], fine[2 * i], fine[2 * i + 1], ref[k][1], ref[k][2]);
    TEST_NEAR(fine[2 * i], ref[k][1], 5e-5, "tip x");
    TEST_NEAR(fine[2 * i + 1], ref[k][2], 5e-5, "tip z");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cubic elements: strains of second order in l, so that the shape converges at least as l^2 once resolved. */
static PetscErrorCode TestElements(const PetscReal fine[2 * SAMPLES])
{
  PetscReal tip[2 * SAMPLES], last = 0;

  PetscFunctionBegin;
  printf("elements  rms of the tip's path against 32 elements, m  order\n");
  for (PetscInt n = 2; n <= 16; n *= 2) {
    PetscReal rms;

    PetscCall(Trajectory(n, 8, "-ancf_ts_alpha_radius 1", tip));
    rms = Rms(tip, fine);
    printf("%8d  %.3e  %s%.2f\n", (int)n, rms, n > 2 ? "" : "  ", n > 2 ? PetscLog2Real(last / rms) : 0.0);
    if (n >= 8) TEST(PetscLog2Real(last / rms) > 1.9, "order with elements %g", (double)PetscLog2Real(last / rms));
    last = rms;
  }
  TEST(last < 2e-3, "16 elements against 32: %g m", (double)last);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rms over the path, because the error at one time changes sign with the step. The sudden release excites frequencies up to
   2000 rad/s: the order shows where these are resolved, dt < 1/2000 s. */
static PetscErrorCode TestTimeOrder(const char options[])
{
  PetscReal ref[2 * SAMPLES], tip[2 * SAMPLES], last = 0;

  PetscFunctionBegin;
  PetscCall(Trajectory(4, 160, "-ancf_ts_type rk -ancf_ts_rk_type 4", ref)); /* error (w dt)^4 below 1e-7 */
  printf("%s\ndt, s      rms of the tip's path, m  order\n", options);
  for (PetscInt n = 1; n <= 64; n *= 2) {
    PetscReal rms, order;

    PetscCall(Trajectory(4, n, options, tip));
    rms = Rms(tip, ref);
    order = n > 1 ? PetscLog2Real(last / rms) : 0;
    printf("%.3e  %.3e  %.2f\n", 1.0 / (SAMPLES * (double)n), rms, order);
    if (n == 64) TEST(PetscAbsReal(order - 2) < 0.1, "%s: order in time %g", options, (double)order);
    last = rms;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Undamped: relative to the energy m g L/2 that falls and returns. */
static PetscErrorCode TestEnergy(const char options[], PetscReal dt, PetscReal tol)
{
  AncfBeamSpec s;
  Ancf a;
  PetscReal k, w, p, E, E0, drift = 0;
  const PetscReal scale = 88.7588 / 2;

  PetscFunctionBegin;
  PetscCall(SeedSpec(4, &s));
  PetscCall(BeamCreate(&s, -9.81, options, &a));
  PetscCall(AncfGetEnergy(a, &k, &w, &p));
  E0 = k + w + p;
  for (PetscInt i = 1; (PetscReal)i * dt < 10 + dt / 2; i++) {
    PetscCall(AncfAdvance(a, (PetscReal)i * dt));
    PetscCall(AncfGetEnergy(a, &k, &w, &p));
    E = k + w + p - E0;
    drift = PetscMax(drift, PetscAbsReal(E));
  }
  printf("%-42s dt %g: largest energy error over 10 s %.2e of m g L/2, at the end %.2e\n", options, dt, drift / scale,
         (k + w + p - E0) / scale);
  TEST(drift / scale < tol, "energy error %g of m g L/2", (double)(drift / scale));
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Hanging under its weight. The elastica (inextensible, shear-free) is the limit for EA -> infinity; EA here stretches 0.2 %. */
static PetscErrorCode TestStatic(void)
{
  static const struct {
    PetscInt n;
    const char *options;
    PetscReal x, z, tol;
  } runs[] = {{4, FIVE_THREE, NAN, -0.87174, 1e-5},
              {32, FIVE_THREE, 0.306666, -0.888455, 1e-6},
              {64, "-ancf_strain engineering", 0.307793, -0.886028, 4e-3},
              {64, "", 0.307793, -0.886028, 4e-3}};

  PetscFunctionBegin;
  for (size_t k = 0; k < sizeof(runs) / sizeof(runs[0]); k++) {
    AncfBeamSpec s;
    Ancf a;
    const PetscReal *e;
    PetscReal f[3], kin, W, P;
    PetscInt n = runs[k].n;

    PetscCall(SeedSpec(n, &s));
    PetscCall(BeamCreate(&s, -9.81, runs[k].options, &a));
    PetscCall(AncfSolveStatic(a, 10));
    PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
    PetscCall(AncfGetReaction(a, f));
    PetscCall(AncfGetEnergy(a, &kin, &W, &P));
    printf("static, %2d elements %-56s tip (%.6f, %.6f), reference (%.6f, %.6f), support force %.4f N\n", (int)n, runs[k].options,
           e[6 * n], e[6 * n + 2], runs[k].x, runs[k].z, f[2]);
    if (!PetscIsNanReal(runs[k].x)) TEST_NEAR(e[6 * n], runs[k].x, runs[k].tol, "static tip x");
    TEST_NEAR(e[6 * n + 2], runs[k].z, runs[k].tol, "static tip z");
    TEST_NEAR(e[6 * n + 1], 0, 1e-9, "plane problem");
    TEST_REL(f[2], 88.7588, 1e-5, "the support carries the weight");
    PetscCall(AncfDestroy(&a));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Generalised eigenproblem K x = w^2 M x of the straight beam, dense by LAPACK: the eigenvalues of (K + sigma M)^-1 M are
  1/(w^2 + sigma). Ascending w^2; transverse modes come in pairs (y, z).
*/
static PetscErrorCode Eigenvalues(Ancf a, PetscReal sigma, PetscInt *n, PetscReal **w2)
{
  TS ts;
  Vec u, zero;
  Mat J, K, M;
  KSP ksp;
  PC pc;
  PetscReal *im;

  PetscFunctionBegin;
  PetscCall(AncfGetTS(a, &ts));
  PetscCall(TSSetUp(ts));
  PetscCall(TSGetSolution(ts, &u));
  PetscCall(VecDuplicate(u, &zero));
  PetscCall(VecZeroEntries(zero));
  PetscCall(TSGetI2Jacobian(ts, &J, NULL, NULL, NULL));
  PetscCall(TSComputeI2Jacobian(ts, 0, u, zero, zero, 0, sigma, J, J));
  PetscCall(MatConvert(J, MATSEQDENSE, MAT_INITIAL_MATRIX, &K));
  PetscCall(TSComputeI2Jacobian(ts, 0, u, zero, zero, 0, 0, J, J));
  PetscCall(MatConvert(J, MATSEQDENSE, MAT_INITIAL_MATRIX, &M));
  PetscCall(MatAYPX(M, -1, K, SAME_NONZERO_PATTERN));
  PetscCall(MatScale(M, 1 / sigma));
  PetscCall(VecGetSize(u, n));
  PetscCall(KSPCreate(PETSC_COMM_SELF, &ksp));
  PetscCall(KSPSetOperators(ksp, M, K));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCLU));
  PetscCall(KSPSetUp(ksp));
  PetscCall(PetscMalloc1(*n, w2));
  PetscCall(PetscMalloc1(*n, &im));
  PetscCall(KSPComputeEigenvaluesExplicitly(ksp, *n, *w2, im));
  for (PetscInt i = 0; i < *n; i++) (*w2)[i] = 1 / (*w2)[i] - sigma;
  PetscCall(PetscSortReal(*n, *w2));
  PetscCall(PetscFree(im));
  PetscCall(KSPDestroy(&ksp));
  PetscCall(VecDestroy(&zero));
  PetscCall(MatDestroy(&K));
  PetscCall(MatDestroy(&M));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  First three Euler-Bernoulli frequencies, w = (beta L)^2 sqrt(EI/(rho A L^4)), at 8 elements: within 0.5 %. Fixed coordinates
  appear as w^2 = 0, one each; rigid modes too.
*/
static PetscErrorCode TestModes(const char name[], AncfEnd end0, AncfEnd end1, const PetscReal betaL2[3])
{
  AncfBeamSpec s;
  Ancf a;
  PetscReal *w2, unit;
  PetscInt n, k = 0;

  PetscFunctionBegin;
  PetscCall(SeedSpec(8, &s));
  s.end0 = end0;
  s.end1 = end1;
  PetscCall(BeamCreate(&s, 0, "", &a));
  PetscCall(AncfGetBeam(a, 0, &s, NULL, NULL));
  unit = PetscSqrtReal(s.EI / s.rhoA);
  PetscCall(Eigenvalues(a, PetscSqr(betaL2[0] * unit), &n, &w2));
  while (k < n && w2[k] < 1e-2 * PetscSqr(betaL2[0] * unit)) k++;
  for (int m = 0; m < 3; m++, k += 2) {
    PetscReal w = PetscSqrtReal(w2[k]), ref = betaL2[m] * unit;

    printf("%-15s mode %d: %.6f Hz, Euler-Bernoulli %.6f Hz, error %+.4f %%\n", name, m + 1, w / (2 * PETSC_PI),
           ref / (2 * PETSC_PI), 100 * (w / ref - 1));
    TEST_REL(w, ref, 5e-3, "frequency");
    TEST_REL(w2[k], w2[k + 1], 1e-7, "the two planes vibrate alike");
  }
  PetscCall(PetscFree(w2));
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Modes without stiffness of a free straight beam: three translations and two rotations. Two axial points miss the axial strain
  P_2(xi) of a uniform change of all gradients, which is then a sixth: why three is the default.
*/
static PetscErrorCode TestRank(const char options[], PetscInt expected)
{
  AncfBeamSpec s;
  Ancf a;
  PetscReal *w2, unit;
  PetscInt n, zeros = 0;

  PetscFunctionBegin;
  PetscCall(SeedSpec(4, &s));
  s.end0 = ANCF_END_FREE;
  PetscCall(BeamCreate(&s, 0, options, &a));
  PetscCall(AncfGetBeam(a, 0, &s, NULL, NULL));
  unit = s.EI / s.rhoA; /* the lowest elastic mode has 22.4^2 of these */
  PetscCall(Eigenvalues(a, 500 * unit, &n, &w2));
  for (PetscInt i = 0; i < n; i++) zeros += w2[i] < unit;
  printf("free beam %-55s %d modes without stiffness\n", options, (int)zeros);
  TEST(zeros == expected, "%d modes without stiffness, expected %d", (int)zeros, (int)expected);
  PetscCall(PetscFree(w2));
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* First mode by time integration: period of a small free vibration from the zero crossings of the tip. */
static PetscErrorCode TestPeriod(void)
{
  AncfBeamSpec s;
  Ancf a;
  const PetscReal *e, dt = 5e-3, ref = 0.294930; /* Hz */
  PetscReal *Q, first = 0, last = 0, prev;
  PetscInt crossings = 0;

  PetscFunctionBegin;
  PetscCall(SeedSpec(8, &s));
  PetscCall(BeamCreate(&s, 0, "-ancf_ts_alpha_radius 1", &a));
  PetscCall(AncfGetLoads(a, &Q));
  Q[6 * 8 + 2] = 3 * 2.513274 * 1e-3; /* static tip deflection 1 mm */
  PetscCall(AncfSolveStatic(a, 1));
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  TEST_REL(e[50], 1e-3, 1e-4, "tip deflection F L^3/(3 EI)");
  PetscCall(AncfZeroLoads(a));
  prev = e[50];
  for (PetscInt i = 1; i <= 4000; i++) {
    PetscCall(AncfAdvance(a, (PetscReal)i * dt));
    PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
    if (prev < 0 && e[50] >= 0) {
      last = ((PetscReal)i - e[50] / (e[50] - prev)) * dt;
      if (!crossings++) first = last;
    }
    prev = e[50];
  }
  printf("period from %d upward crossings: %.6f Hz, Euler-Bernoulli %.6f Hz\n", (int)crossings, (crossings - 1) / (last - first),
         ref);
  TEST_REL((PetscReal)(crossings - 1) / (last - first), ref, 5e-3, "frequency by time integration");
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  static const PetscReal clamped[3] = {3.516015, 22.034492, 61.697214}, pinned[3] = {9.869604, 39.478418, 88.826440};
  static const PetscReal freefree[3] = {22.373285, 61.672823, 120.903392};
  PetscReal fine[2 * SAMPLES];

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(Trajectory(32, 8, "-ancf_ts_alpha_radius 1", fine));
  PetscCall(TestTable(fine));
  PetscCall(TestElements(fine));
  PetscCall(TestTimeOrder("-ancf_ts_type alpha2"));
  PetscCall(TestTimeOrder("-ancf_ts_type alpha2 -ancf_ts_alpha_radius 1"));
  PetscCall(TestTimeOrder("-ancf_ts_type bdf"));
  PetscCall(TestTimeOrder("-ancf_ts_type theta"));
  PetscCall(TestEnergy("-ancf_ts_alpha_radius 1", 1.25e-4, 1e-3));
  PetscCall(TestEnergy("-ancf_ts_alpha_radius 1", 2.5e-4, 4e-3)); /* four times as much */
  PetscCall(TestStatic());
  PetscCall(TestModes("clamped-free", ANCF_END_CLAMP, ANCF_END_FREE, clamped));
  PetscCall(TestModes("pinned-pinned", ANCF_END_PIN, ANCF_END_PIN, pinned));
  PetscCall(TestModes("free-free", ANCF_END_FREE, ANCF_END_FREE, freefree));
  PetscCall(TestRank("", 5));
  PetscCall(TestRank(FIVE_THREE, 5));
  PetscCall(TestRank("-ancf_quadrature_axial 2", 6));
  PetscCall(TestPeriod());
  PetscCall(PetscFinalize());
  return test_report();
}
