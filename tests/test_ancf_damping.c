/* test_ancf_damping.c - internal damping: element, objectivity, modal damping ratio, energy balance, matrices, bad input. */
#include "ancf_common.h"
#include "ancfviscous.h"

static void RandomElements(AncfViscosity *s, AncfLanes e[12], AncfLanes v[12], AncfLanes spin[3])
{
  for (int i = 0; i < ANCF_LANES; i++) {
    s->EA[i] = 2 + Random();
    s->EI[i] = 0.3 + 0.2 * Random();
    s->l[i] = 0.8 + 0.3 * Random();
    for (int c = 0; c < 3; c++) {
      e[c][i] = Random();
      e[3 + c][i] = (c == 0) + 0.3 * Random();
      e[6 + c][i] = e[c][i] + s->l[i] * ((c == 0) + 0.3 * Random());
      e[9 + c][i] = (c == 0) + 0.3 * Random();
      spin[c][i] = Random();
    }
    for (int c = 0; c < 12; c++) v[c][i] = Random();
  }
}

/* Fourth-order differences as in test_ancf_element.c: 5e-17 f^(5) and 1e-16/h = 5e-13, f^(5) up to 1e6 f'. */
static void TestElementTangent(AncfStrain strain)
{
  static const double step[4] = {-2, -1, 1, 2}, weight[4] = {1. / 12, -8. / 12, 8. / 12, -1. / 12};
  const double h = 2e-4, ge = 1.3, gv = -0.7;
  AncfRule rule;
  AncfViscosity s;
  AncfLanes e[12], v[12], spin[3], Q[12] = {{0}}, H[81] = {{0}}, power = {0};
  double worst = 0, scale = 0;

  PetscCallAbort(PETSC_COMM_SELF, AncfRuleSetUp(&rule, strain, 4, 3));
  RandomElements(&s, e, v, spin);
  AncfElementViscousTangent(&rule, &s, e, v, spin, ge, gv, H);
  for (int j = 0; j < 12; j++) {
    const AncfLanes ej = e[j], vj = v[j];
    AncfLanes D[12] = {{0}};

    for (int k = 0; k < 4; k++) {
      AncfLanes F[12] = {{0}};

      e[j] = ej + ge * step[k] * h;
      v[j] = vj + gv * step[k] * h;
      AncfElementViscous(&rule, &s, e, v, spin, F, NULL);
      for (int c = 0; c < 12; c++) D[c] += weight[k] / h * F[c];
    }
    e[j] = ej;
    v[j] = vj;
    for (int i = 0; i < ANCF_LANES; i++) {
      double full[144] = {0};

      AncfScaledExpand(H, s.l, i, full);
      for (int c = 0; c < 12; c++) {
        scale = fmax(scale, fabs(full[12 * c + j]));
        worst = fmax(worst, fabs(full[12 * c + j] - D[c][i]));
      }
    }
  }
  printf("damping tangent against differences: %.1e of the largest entry\n", worst / scale);
  TEST(worst / scale < 1e-9, "damping tangent is off by %g", worst / scale);
  /* without spin the force is the gradient of half the power, which is quadratic: v.Q = power */
  for (int c = 0; c < 3; c++) spin[c] = (AncfLanes){0};
  AncfElementViscous(&rule, &s, e, v, spin, Q, &power);
  for (int i = 0; i < ANCF_LANES; i++) {
    double work = 0;

    for (int c = 0; c < 12; c++) work += v[c][i] * Q[c][i];
    TEST_REL(work, power[i], 1e-13, "v.Q is the dissipated power");
    TEST(power[i] > 0, "power %g", (double)power[i]);
  }
}

/* At a straight unstretched element dQ/dv is the retardation time times the elastic tangent: Rayleigh's C = tau K, to round-off.
 */
static void TestRayleigh(AncfStrain strain)
{
  const double tau = 0.37;
  AncfRule rule;
  AncfSection s;
  AncfViscosity c;
  AncfLanes e[12], v[12], Q[12], K[ANCF_TANGENT], H[81] = {{0}}, spin[3] = {{0}};

  PetscCallAbort(PETSC_COMM_SELF, AncfRuleSetUp(&rule, strain, 3, 3));
  RandomElements(&c, e, v, spin);
  for (int i = 0; i < ANCF_LANES; i++) {
    double t[3] = {Random(), Random(), Random()}, n = sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);

    s.EA[i] = c.EA[i] / tau;
    s.EI[i] = c.EI[i] / tau;
    s.l[i] = c.l[i];
    for (int k = 0; k < 3; k++) {
      e[3 + k][i] = e[9 + k][i] = t[k] / n;
      e[6 + k][i] = e[k][i] + c.l[i] * t[k] / n;
      spin[k][i] = 0;
    }
    for (int k = 0; k < 12; k++) v[k][i] = 0;
  }
  AncfElementTangent(&rule, &s, e, Q, K);
  AncfElementViscousTangent(&rule, &c, e, v, spin, 0, 1, H);
  for (int i = 0; i < ANCF_LANES; i++) {
    double k[144], d[144] = {0}, scale = 0;

    AncfTangentExpand(K, i, k);
    AncfScaledExpand(H, c.l, i, d);
    for (int r = 0; r < 144; r++) scale = fmax(scale, fabs(k[r]));
    for (int r = 0; r < 144; r++) TEST_NEAR(d[r], tau * k[r], 1e-13 * tau * scale, "C = tau K");
  }
}

/* A bent and stretched free beam in any rigid motion dissipates nothing, another velocity field does. */
static PetscErrorCode TestObjective(const char options[])
{
  const PetscReal omega[3] = {0.7, -1.1, 2.3};
  PetscReal x[30], v[30], rigid, bent;
  const PetscReal *e;
  AncfBeamSpec s;
  Ancf a;

  PetscFunctionBegin;
  PetscCall(SeedSpec(4, &s));
  s.end0 = ANCF_END_FREE;
  PetscCall(BeamCreate(&s, 0, options, &a));
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  for (int i = 0; i < 30; i++) x[i] = e[i] + 0.1 * Random();
  for (int i = 0; i < 10; i++)
    for (int c = 0; c < 3; c++)
      v[3 * i + c] =
          omega[(c + 1) % 3] * x[3 * i + (c + 2) % 3] - omega[(c + 2) % 3] * x[3 * i + (c + 1) % 3] + (i % 2 ? 0 : 0.4);
  PetscCall(AncfSetState(a, 0, x, v));
  PetscCall(AncfGetDissipation(a, &rigid));
  for (int i = 0; i < 30; i++) v[i] += 0.1 * Random();
  PetscCall(AncfSetState(a, 0, x, v));
  PetscCall(AncfGetDissipation(a, &bent));
  printf("%-60s power in rigid motion %.1e W, otherwise %.1e W\n", options, rigid, bent);
  /* rates cancel to round-off, squared; the spin's floor is 1e-14 of the curvature squared: amplified by 1/(kappa L)^2 */
  TEST(rigid <= 1e-20 * bent, "a rigid motion dissipates %g W of %g W", (double)rigid, (double)bent);
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Free vibration of the seed cantilever from a small static deflection: zeta = beta w/2 + alpha/(2 w), so that the tip falls by
  exp(-2 pi zeta/sqrt(1 - zeta^2)) from one downward crossing's velocity to the next, every 2 pi/(w sqrt(1 - zeta^2)). The higher
  modes, w2 = 6.27 w1, have died out by then: with beta their ratio is 6.27 zeta, and e^(-6.27^2 2 pi zeta) < 1e-4 for zeta =
  0.05. The midpoint rule with 100 steps a period makes w smaller by (w dt)^2/24 = 1.6e-4 and zeta by about as much; reading the
  velocity at a crossing by linear interpolation costs (w dt)^2/8 = 5e-4 of it, the same every time.
*/
static PetscErrorCode TestModal(const char options[], PetscReal alpha, PetscReal tau)
{
  const PetscReal w = 3.516015 * PetscSqrtReal(2.513274 / (7200 * PETSC_PI * 4e-4)), zeta = tau * w / 2 + alpha / (2 * w);
  const PetscReal wd = w * PetscSqrtReal(1 - zeta * zeta), dt = 2 * PETSC_PI / wd / 100;
  PetscReal *Q, speed[8] = {0}, time[8] = {0}, px, pv;
  const PetscReal *e, *v;
  PetscInt n = 0;
  AncfBeamSpec s;
  Ancf a;

  PetscFunctionBegin;
  PetscCall(SeedSpec(8, &s));
  PetscCall(BeamCreate(&s, 0, options, &a));
  PetscCall(AncfGetLoads(a, &Q));
  Q[50] = 3 * 2.513274 * 1e-4; /* static tip deflection 0.1 mm */
  PetscCall(AncfSolveStatic(a, 1));
  PetscCall(AncfZeroLoads(a));
  PetscCall(AncfGetState(a, NULL, &e, &v, NULL));
  px = e[50];
  pv = v[50];
  for (PetscInt i = 1; i <= 450 && n < 8; i++) {
    PetscCall(AncfAdvance(a, (PetscReal)i * dt));
    PetscCall(AncfGetState(a, NULL, &e, &v, NULL));
    if (px > 0 && e[50] <= 0) {
      const PetscReal f = px / (px - e[50]);

      time[n] = ((PetscReal)(i - 1) + f) * dt;
      speed[n++] = pv + f * (v[50] - pv);
    }
    px = e[50];
    pv = v[50];
  }
  TEST(n >= 4, "%d crossings", (int)n);
  printf("%-60s zeta %.5f: decrement %.5f, exact %.5f; period %.5f, exact %.5f s\n", options, zeta,
         PetscLogReal(speed[1] / speed[3]) / 2, 2 * PETSC_PI * zeta * w / wd, (time[3] - time[1]) / 2, 2 * PETSC_PI / wd);
  TEST_REL(PetscLogReal(speed[1] / speed[3]) / 2, 2 * PETSC_PI * zeta * w / wd, 3e-3, "logarithmic decrement");
  TEST_REL((time[3] - time[1]) / 2, 2 * PETSC_PI / wd, 1e-3,
           "damped period"); /* with 6e-4 of the beam's own mode at 8 elements */
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Large swing: what damping takes (trapezoidal rule) is what the beam loses, to second order in the step. */
static PetscErrorCode Balance(const char options[], PetscReal dt, PetscReal *err, PetscReal *lost)
{
  PetscReal k, u, p, E0, power, last;
  AncfBeamSpec s;
  Ancf a;

  PetscFunctionBegin;
  PetscCall(SeedSpec(4, &s));
  PetscCall(BeamCreate(&s, -9.81, options, &a));
  PetscCall(AncfGetEnergy(a, &k, &u, &p));
  E0 = k + u + p;
  *lost = 0;
  PetscCall(AncfGetDissipation(a, &last));
  for (PetscInt i = 1; (PetscReal)i * dt < 0.5 + dt / 2; i++) {
    PetscCall(AncfAdvance(a, (PetscReal)i * dt));
    PetscCall(AncfGetDissipation(a, &power));
    *lost += dt * (power + last) / 2;
    last = power;
  }
  PetscCall(AncfGetEnergy(a, &k, &u, &p));
  *err = k + u + p + *lost - E0;
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestBalance(const char options[])
{
  PetscReal coarse, fine, lost;

  PetscFunctionBegin;
  PetscCall(Balance(options, 5e-4, &coarse, &lost));
  PetscCall(Balance(options, 2.5e-4, &fine, &lost));
  printf("%-60s lost %.5f J, balance off by %.1e, %.1e J\n", options, lost, coarse, fine);
  TEST(lost > 1, "lost %g J", (double)lost);
  TEST(PetscAbsReal(fine) < PetscAbsReal(coarse) / 3, "balance %g J after %g J", (double)fine, (double)coarse);
  TEST(PetscAbsReal(fine) < 1e-3 * lost, "balance %g J of %g J", (double)fine, (double)lost);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forty beams, clamped, pinned and free: batched, assembled and grouped solvers give the same motion to Newton's tolerance. */
static PetscErrorCode TestSolvers(void)
{
  static const char *const options[] = {"-ancf_pc_type ilu", "", "-ancf_group_nodes 60",
                                        "-ancf_pc_type blocktri -ancf_mat_type baij", "-ancf_ts_type theta"};
  PetscReal tips[5][40];

  PetscFunctionBegin;
  for (int k = 0; k < 5; k++) {
    const PetscReal g[3] = {0, 1, -9.81};
    PetscInt newton;
    Ancf a;

    PetscCall(AncfCreate(PETSC_COMM_SELF, &a));
    for (int b = 0; b < 40; b++) {
      AncfBeamSpec s;

      PetscCall(SeedSpec(2 + b % 5, &s));
      s.axialdamping = 1e-3;
      s.bendingdamping = b % 3 ? 0.02 : 0;
      if (b % 7 == 3) s.end0 = ANCF_END_PIN;
      if (b % 7 == 5) s.end0 = ANCF_END_FREE;
      PetscCall(AncfAddBeam(a, &s, NULL));
    }
    PetscCall(AncfSetGravity(a, g));
    PetscCall(SetUpWith(a, options[k], "-ancf_ts_alpha_radius 1 -ancf_snes_rtol 1e-11 -ancf_snes_stol 1e-13"));
    for (int i = 1; i <= 100; i++) PetscCall(AncfAdvance(a, 1e-3 * i));
    PetscCall(AncfGetCounts(a, NULL, &newton, NULL));
    printf("%-60s %d Newton iterations\n", options[k], (int)newton);
    PetscCall(TipHeights(a, 40, tips[k]));
    PetscCall(AncfDestroy(&a));
  }
  for (int k = 1; k < 4; k++)
    for (int b = 0; b < 40; b++) TEST_NEAR(tips[k][b], tips[0][b], 1e-8, options[k]);
  /* theta 1/2 in first-order form starts alike and is the same rule but for where it evaluates Q: second order, dt^2 g/8 each */
  for (int b = 0; b < 40; b++) TEST_NEAR(tips[4][b], tips[0][b], 5 * 9.81e-6 / 8, options[4]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateBad(const char options[], PetscReal axial, PetscReal bending)
{
  AncfBeamSpec s;
  Ancf a = NULL;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(SeedSpec(2, &s));
  s.axialdamping = axial;
  s.bendingdamping = bending;
  PetscCall(AncfCreate(PETSC_COMM_SELF, &a));
  ierr = AncfAddBeam(a, &s, NULL);
  PetscCall(AncfDestroy(&a));
  if (!ierr) ierr = BeamCreate(&s, 0, options, &a);
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(ierr);
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  for (AncfStrain s = ANCF_STRAIN_PAPER; s <= ANCF_STRAIN_ENGINEERING; s++) {
    TestElementTangent(s);
    TestRayleigh(s);
  }
  PetscCall(TestObjective("-ancf_damping_stiffness 0.1"));
  PetscCall(TestObjective("-ancf_damping_stiffness 0.1 -ancf_strain engineering"));
  PetscCall(TestModal("-ancf_ts_alpha_radius 1 -ancf_damping_stiffness 0.05", 0, 0.05));
  PetscCall(TestModal("-ancf_ts_type theta -ancf_damping_stiffness 0.05 -ancf_damping 0.05", 0.05, 0.05));
  PetscCall(TestBalance("-ancf_ts_alpha_radius 1 -ancf_damping_stiffness 0.02"));
  PetscCall(TestBalance("-ancf_ts_type rk -ancf_ts_rk_type 4 -ancf_damping_stiffness 2e-4 -ancf_damping 1 -ancf_substeps 4"));
  PetscCall(TestSolvers());
  TEST_ERROR(CreateBad("-ancf_damping_stiffness -1", 0, 0), PETSC_ERR_ARG_OUTOFRANGE, "-ancf_damping_stiffness -1");
  TEST_ERROR(CreateBad("-ancf_damping_stiffness 1 -ancf_ts_type basicsymplectic", 0, 0), PETSC_ERR_ARG_INCOMP, "basicsymplectic");
  TEST_ERROR(CreateBad("", -1, 0), PETSC_ERR_ARG_OUTOFRANGE, "axialdamping");
  TEST_ERROR(CreateBad("", 0, NAN), PETSC_ERR_ARG_OUTOFRANGE, "bendingdamping");
  PetscCall(PetscFinalize());
  return test_report();
}
