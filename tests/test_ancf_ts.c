/* test_ancf_ts.c - Jacobians of both forms, every TS type, conservation, continuation across calls, groups. */
#include "ancf_common.h"

static PetscErrorCode RandomState(Ancf a, PetscReal size)
{
  const PetscReal *e, *v;
  PetscReal *x, *y;
  PetscInt n;

  PetscFunctionBegin;
  PetscCall(AncfGetNumNodes(a, &n));
  PetscCall(AncfGetState(a, NULL, &e, &v, NULL));
  PetscCall(PetscMalloc2(6 * (size_t)n, &x, 6 * (size_t)n, &y));
  for (PetscInt i = 0; i < 6 * n; i++) {
    x[i] = e[i] + (i >= 6 ? size * Random() : 0);
    y[i] = i >= 6 && i < 6 * (n - 1) ? Random() : 0; /* both ends may be fixed */
  }
  PetscCall(AncfSetState(a, 0, x, y));
  PetscCall(PetscFree2(x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  dF/du + shift dF/dudot column by column, as -snes_test_jacobian does, with fourth-order differences: error h^4 F^(5)/30
  with lengths of 0.25 m gives 1e-16 * 4^5 relative, round-off 1e-16/h = 1e-12 of the largest entry.
*/
static PetscErrorCode TestJacobian(const char options[], PetscBool second)
{
  const PetscReal h = 1e-4, shift = 50, shiftV = 3, tol = 1e-8;
  static const PetscReal step[4] = {-2, -1, 1, 2}, weight[4] = {1. / 12, -8. / 12, 8. / 12, -1. / 12};
  AncfBeamSpec s;
  Ancf a;
  TS ts;
  Vec u, v, w, F, D;
  Mat J, E;
  PetscInt n;
  PetscReal err, scale;

  PetscFunctionBegin;
  PetscCall(SeedSpec(4, &s));
  s.young = 2e5;
  s.end1 = ANCF_END_PIN;
  PetscCall(BeamCreate(&s, -9.81, options, &a));
  PetscCall(RandomState(a, 0.05));
  PetscCall(AncfGetTS(a, &ts));
  PetscCall(TSSetUp(ts));
  PetscCall(TSGetSolution(ts, &u));
  PetscCall(VecDuplicate(u, &v));
  PetscCall(VecDuplicate(u, &w));
  PetscCall(VecDuplicate(u, &F));
  PetscCall(VecDuplicate(u, &D));
  PetscCall(VecGetSize(u, &n));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(VecSetValue(v, i, Random(), INSERT_VALUES));
    PetscCall(VecSetValue(w, i, Random(), INSERT_VALUES));
  }
  if (second) {
    PetscCall(TSGetI2Jacobian(ts, &J, NULL, NULL, NULL));
    PetscCall(TSComputeI2Jacobian(ts, 0, u, v, w, shiftV, shift, J, J));
  } else {
    PetscCall(TSGetIJacobian(ts, &J, NULL, NULL, NULL));
    PetscCall(TSComputeIJacobian(ts, 0, u, w, shift, J, J, PETSC_FALSE));
  }
  PetscCall(MatConvert(J, MATSEQDENSE, MAT_INITIAL_MATRIX, &E));
  PetscCall(MatNorm(E, NORM_INFINITY, &scale));
  for (PetscInt j = 0; j < n; j++) {
    PetscCall(VecZeroEntries(D));
    for (int k = 0; k < 4; k++) {
      PetscReal d = step[k] * h;

      PetscCall(VecSetValue(u, j, d, ADD_VALUES));
      PetscCall(VecSetValue(w, j, shift * d, ADD_VALUES));
      if (second) {
        PetscCall(VecSetValue(v, j, shiftV * d, ADD_VALUES));
        PetscCall(TSComputeI2Function(ts, 0, u, v, w, F));
        PetscCall(VecSetValue(v, j, -shiftV * d, ADD_VALUES));
      } else
        PetscCall(TSComputeIFunction(ts, 0, u, w, F, PETSC_FALSE));
      PetscCall(VecSetValue(u, j, -d, ADD_VALUES));
      PetscCall(VecSetValue(w, j, -shift * d, ADD_VALUES));
      PetscCall(VecAXPY(D, -weight[k] / h, F));
    }
    for (PetscInt i = 0; i < n; i++) {
      PetscScalar x;

      PetscCall(VecGetValues(D, 1, &i, &x));
      PetscCall(MatSetValue(E, i, j, x, ADD_VALUES));
    }
  }
  PetscCall(MatAssemblyBegin(E, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(E, MAT_FINAL_ASSEMBLY));
  PetscCall(MatNorm(E, NORM_INFINITY, &err));
  printf("Jacobian %-40s |J - J_fd| / |J| = %.1e\n", options, err / scale);
  TEST(err / scale < tol, "Jacobian of %s is off by %g", options, err / scale);
  PetscCall(MatDestroy(&E));
  PetscCall(VecDestroy(&v));
  PetscCall(VecDestroy(&w));
  PetscCall(VecDestroy(&F));
  PetscCall(VecDestroy(&D));
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Swing(const char options[], PetscInt elements, PetscReal dt, PetscReal T, PetscReal tip[3],
                            PetscInt counts[3])
{
  AncfBeamSpec s;
  Ancf a;
  const PetscReal *e;
  PetscInt n = (PetscInt)PetscFloorReal(T / dt + 0.5);

  PetscFunctionBegin;
  PetscCall(SeedSpec(elements, &s));
  PetscCall(BeamCreate(&s, -9.81, options, &a));
  for (PetscInt i = 1; i <= n; i++) PetscCall(AncfAdvance(a, (PetscReal)i * dt));
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  PetscCall(PetscArraycpy(tip, e + 6 * elements, 3));
  if (counts) PetscCall(AncfGetCounts(a, &counts[0], &counts[1], &counts[2]));
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Tip of the two-element seed beam at t = 0.2 s with each type, against RK4 with a tenth of the step. A first-order method
  with dt = 5e-4 is off by about g t dt = 1e-3 m; a second-order one by (w dt)^2/12 = 1e-5 of the tip's drop of 0.2 m for the
  bending frequencies of 20 rad/s that carry the motion, here with a factor of 5.
*/
static PetscErrorCode TestTypes(void)
{
  static const struct {
    const char *options;
    PetscReal tol;
  } runs[] = {
      {"-ancf_ts_type alpha2", 1e-5},
      {"-ancf_ts_type alpha2 -ancf_ts_alpha_radius 1", 1e-5},
      {"-ancf_ts_type theta", 1e-5},
      {"-ancf_ts_type cn", 1e-5},
      {"-ancf_ts_type bdf", 1e-5},
      {"-ancf_ts_type alpha", 1e-5},
      {"-ancf_ts_type arkimex", 1e-5},
      {"-ancf_ts_type arkimex -ancf_ts_arkimex_type prssp2", 1e-5},
      {"-ancf_ts_type rosw", 1e-5},
      {"-ancf_ts_type beuler", 3e-3},
      {"-ancf_ts_type rk", 1e-5},
      {"-ancf_ts_type rk -ancf_ts_rk_type 2a", 1e-5},
      {"-ancf_ts_type ssp", 1e-5},
      {"-ancf_ts_type basicsymplectic -ancf_ts_basicsymplectic_type 2", 1e-5},
      {"-ancf_ts_type alpha2 -ancf_mat_type aij", 1e-5},
      {"-ancf_ts_type alpha2 -ancf_mat_type aij -ancf_pc_type lu", 1e-5},
      {"-ancf_ts_type alpha2 -ancf_substeps 3", 1e-5},
      {"-ancf_ts_type rk -ancf_substeps 7", 1e-5},
      {"-ancf_ts_type basicsymplectic -ancf_ts_basicsymplectic_type 2 -ancf_substeps 3", 1e-5},
      {"-ancf_ts_type alpha2 -ancf_ts_adapt_type basic -ancf_ts_rtol 1e-6 -ancf_ts_atol 1e-6", 1e-5},
      {"-ancf_ts_type bdf -ancf_ts_adapt_type basic -ancf_ts_rtol 1e-6 -ancf_ts_atol 1e-6", 1e-5},
      {"-ancf_ts_type rk -ancf_ts_adapt_type basic -ancf_ts_rtol 1e-6 -ancf_ts_atol 1e-6", 1e-5},
  };
  PetscReal ref[3], tip[3];

  PetscFunctionBegin;
  PetscCall(Swing("-ancf_ts_type rk -ancf_ts_rk_type 4", 2, 5e-5, 0.2, ref, NULL));
  for (size_t k = 0; k < sizeof(runs) / sizeof(runs[0]); k++) {
    PetscInt counts[3];

    PetscCall(Swing(runs[k].options, 2, 5e-4, 0.2, tip, counts));
    printf("%-88s tip error %9.2e m, steps %d, Newton %d\n", runs[k].options, (double)PetscAbsReal(tip[2] - ref[2]),
           (int)counts[0], (int)counts[1]);
    TEST_NEAR(tip[0], ref[0], runs[k].tol, runs[k].options);
    TEST_NEAR(tip[1], ref[1], runs[k].tol, runs[k].options);
    TEST_NEAR(tip[2], ref[2], runs[k].tol, runs[k].options);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* 400 calls of one step are the same as one call of 400 steps: no restart, same Newton count, same tip to round-off. */
static PetscErrorCode TestContinuation(const char type[])
{
  PetscReal a[3], b[3];
  PetscInt na[3], nb[3];
  char options[128];

  PetscFunctionBegin;
  PetscCall(Swing(type, 3, 1e-3, 0.4, a, na));
  snprintf(options, sizeof(options), "%s -ancf_substeps 400", type);
  PetscCall(Swing(options, 3, 0.4, 0.4, b, nb));
  printf("%-40s 400 calls: %d steps, %d Newton iterations; one call: %d, %d\n", type, (int)na[0], (int)na[1], (int)nb[0],
         (int)nb[1]);
  TEST(na[0] == nb[0], "steps %d, %d", (int)na[0], (int)nb[0]);
  TEST(PetscAbsInt(na[1] - nb[1]) <= 4, "Newton iterations %d, %d: the method restarts", (int)na[1], (int)nb[1]);
  for (int c = 0; c < 3; c++) TEST_NEAR(a[c], b[c], 1e-8, "tip"); /* Newton's tolerance 1e-9, 400 steps */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Free flight with spin. The midpoint rule (radius 1, theta) conserves angular momentum, a quadratic invariant, up to Newton's
   tolerance of 1e-9 per step relative to the first residual; generalized-alpha with damping only to second order. */
static PetscErrorCode TestMomentum(const char options[], PetscReal tol)
{
  AncfBeamSpec s;
  Ancf a;
  const PetscReal *e, *v;
  PetscReal x[30], y[30], p0[3], H0[3], p[3], H[3], w[3], E0 = 0, E1 = 0, k, u, q, scale;

  PetscFunctionBegin;
  PetscCall(SeedSpec(4, &s));
  s.end0 = ANCF_END_FREE;
  PetscCall(BeamCreate(&s, 0, options, &a));
  PetscCall(AncfGetState(a, NULL, &e, &v, NULL));
  for (int i = 0; i < 30; i++) x[i] = e[i], y[i] = 0;
  for (int j = 0; j < 5; j++) { /* spin about z and y at the centre, bending velocities, drift */
    y[6 * j + 0] = 0.3;
    y[6 * j + 1] = 4 * (x[6 * j] - 0.5) + PetscSinReal(3 * x[6 * j]);
    y[6 * j + 2] = -2 * (x[6 * j] - 0.5);
    y[6 * j + 4] = 4 + 3 * PetscCosReal(3 * x[6 * j]);
    y[6 * j + 5] = -2;
  }
  PetscCall(AncfSetState(a, 0, x, y));
  PetscCall(AncfGetMomentum(a, p0, H0));
  PetscCall(AncfGetEnergy(a, &k, &u, &q));
  E0 = k + u + q;
  for (int i = 1; i <= 200; i++) PetscCall(AncfAdvance(a, 5e-4 * i));
  PetscCall(AncfGetMomentum(a, p, H));
  PetscCall(AncfGetEnergy(a, &k, &u, &q));
  E1 = k + u + q;
  PetscCall(AncfGetWeight(a, w));
  scale = PetscSqrtReal(H0[0] * H0[0] + H0[1] * H0[1] + H0[2] * H0[2]);
  printf("%-40s free flight: dp %.1e, dH/H %.1e, dE/E %.1e\n", options, (double)PetscAbsReal(p[1] - p0[1]),
         (double)PetscAbsReal(H[2] - H0[2]) / scale, (double)((E1 - E0) / E0));
  for (int c = 0; c < 3; c++) {
    TEST_NEAR(w[c], 0, 0, "no weight without gravity");
    TEST_NEAR(p[c], p0[c], 1e-10, "linear momentum"); /* Newton's residual 1e-9 EA eps dt, summed: telescopes to round-off */
    TEST_NEAR(H[c], H0[c], tol * scale, "angular momentum");
  }
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A free beam under a uniform load that grows linearly: p = integral of the load, which a method of order 2 integrates exactly.
 */
static PetscErrorCode TestLinearLoads(const char options[])
{
  AncfBeamSpec s;
  Ancf a;
  PetscReal *Q, p[3], l;
  const PetscReal dt = 1e-3, q0 = 3, q1 = 50; /* N/m */
  PetscInt nnodes;

  PetscFunctionBegin;
  PetscCall(SeedSpec(3, &s));
  s.end0 = ANCF_END_FREE;
  PetscCall(BeamCreate(&s, 0, options, &a));
  PetscCall(AncfGetBeam(a, 0, NULL, NULL, &l));
  PetscCall(AncfGetNumNodes(a, &nnodes));
  for (PetscInt end = 0; end < 2; end++) {
    PetscReal q = end ? q1 : q0;

    if (end)
      PetscCall(AncfGetLoadsEnd(a, &Q));
    else
      PetscCall(AncfGetLoads(a, &Q));
    for (PetscInt j = 0; j < nnodes; j++) Q[6 * j + 1] = q * l * (j == 0 || j == nnodes - 1 ? 0.5 : 1);
    Q[4] = q * l * l / 12; /* Eq. 24: the gradients of the inner nodes cancel */
    Q[6 * nnodes - 2] = -q * l * l / 12;
  }
  PetscCall(AncfAdvance(a, dt));
  PetscCall(AncfGetMomentum(a, p, NULL));
  TEST_REL(p[1], 0.5 * (q0 + q1) * dt, 1e-10, options);
  PetscCall(AncfAdvance(a, 2 * dt)); /* constant afterwards */
  PetscCall(AncfGetMomentum(a, p, NULL));
  TEST_REL(p[1], 0.5 * (q0 + q1) * dt + q1 * dt, 1e-10, options);
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Going back and repeating, and continuing in another object from a checkpoint, gives the same motion up to Newton's tolerance.
 */
static PetscErrorCode TestRestore(const char options[])
{
  AncfBeamSpec s;
  Ancf a, b;
  const PetscReal dt = 2e-3, *e, *v, *A;
  PetscReal *Q, first[3], again[3], other[3], t;

  PetscFunctionBegin;
  PetscCall(SeedSpec(4, &s));
  PetscCall(BeamCreate(&s, -9.81, options, &a));
  PetscCall(BeamCreate(&s, -9.81, options, &b));
  for (int i = 1; i <= 100; i++) PetscCall(AncfAdvance(a, i * dt));
  PetscCall(AncfSaveState(a));
  PetscCall(AncfGetState(a, &t, &e, &v, NULL));
  PetscCall(AncfSetState(b, t, e, v));
  PetscCall(AncfGetHistory(a, &A));
  PetscCall(AncfSetHistory(b, A));
  for (int i = 101; i <= 110; i++) PetscCall(AncfAdvance(a, i * dt));
  PetscCall(PetscArraycpy(first, e + 24, 3));
  PetscCall(AncfRestoreState(a));
  PetscCall(AncfGetLoads(a, &Q));
  Q[26] = 100;
  for (int i = 101; i <= 103; i++) PetscCall(AncfAdvance(a, i * dt));
  PetscCall(AncfRestoreState(a));
  PetscCall(AncfGetState(a, &t, NULL, NULL, NULL));
  TEST_NEAR(t, 100 * dt, 0, "restored time");
  PetscCall(AncfZeroLoads(a));
  for (int i = 101; i <= 110; i++) PetscCall(AncfAdvance(a, i * dt));
  PetscCall(PetscArraycpy(again, e + 24, 3));
  for (int i = 101; i <= 110; i++) PetscCall(AncfAdvance(b, i * dt));
  PetscCall(AncfGetState(b, NULL, &e, NULL, NULL));
  PetscCall(PetscArraycpy(other, e + 24, 3));
  printf("%-40s repeated: %.1e m, from a checkpoint: %.1e m\n", options, PetscAbsReal(first[2] - again[2]),
         PetscAbsReal(first[2] - other[2]));
  TEST_NEAR(first[2], again[2], 1e-9, options);
  TEST_NEAR(first[2], other[2], 1e-9, options);
  PetscCall(AncfDestroy(&a));
  PetscCall(AncfDestroy(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  A support accelerated by a is a beam at rest under gravity -a, seen from the support (Galilei and d'Alembert): same relative
  motion and support force. An implicit stage sees the support where it is at the stage's time and the beam at an average of its
  positions, a dt^2/8 off: second order in dt, with a factor of up to 5 after a third of the swing. Explicit stages agree to the
  order of the method. Then the support goes on uniformly.
*/
static PetscErrorCode TestMovingSupport(const char options[], PetscReal dt, PetscReal *err)
{
  const PetscReal tol = 5 * 9.81 * dt * dt / 8, acc[6] = {1.5, 0, 9.81, 0, 0, 0};
  PetscReal g[3] = {-1.5, 0, -9.81}, e0[6] = {0, 0, 0, 1, 0, 0}, v0[6] = {0}, f[6], r[6], vend[6] = {0}, none[6] = {0};
  const PetscReal *x, *y, *vx, *vy;
  AncfBeamSpec s;
  Ancf a, b;

  PetscFunctionBegin;
  PetscCall(SeedSpec(3, &s));
  PetscCall(BeamCreate(&s, 0, options, &a));
  PetscCall(BeamCreate(&s, 0, options, &b));
  PetscCall(AncfSetNodeMotion(a, 0, 0, e0, v0, acc));
  PetscCall(AncfSetGravity(b, g));
  PetscCall(AncfGetNodeReaction(a, 0, 0, f));
  PetscCall(AncfGetNodeReaction(b, 0, 0, r));
  for (int c = 0; c < 6; c++) TEST_NEAR(f[c], r[c], 1e-9, "support force at the start"); /* round-off of 90 N */
  for (int i = 1; i <= (int)(0.3 / dt + 0.5); i++) {
    PetscCall(AncfAdvance(a, i * dt));
    PetscCall(AncfAdvance(b, i * dt));
  }
  PetscCall(AncfGetState(a, NULL, &x, &vx, NULL));
  PetscCall(AncfGetState(b, NULL, &y, &vy, NULL));
  PetscCall(AncfGetNodeReaction(a, 0, 0, f));
  PetscCall(AncfGetNodeReaction(b, 0, 0, r));
  printf("%-80s moving support: tip %.1e m, force %.1e N\n", options, (double)PetscAbsReal(x[20] - x[2] - y[20]),
         (double)PetscAbsReal(f[2] - r[2]));
  *err = PetscAbsReal(x[20] - x[2] - y[20]);
  for (int c = 0; c < 3; c++) {
    TEST_NEAR(x[c], 0.5 * acc[c] * 0.09, 1e-13, "position of the support");
    TEST_NEAR(vx[c], acc[c] * 0.3, 1e-13, "velocity of the support");
    TEST_NEAR(x[18 + c] - x[c], y[18 + c], tol, options);
    TEST_NEAR(vx[18 + c] - vx[c], vy[18 + c], 100 * tol, options);
  }
  for (int c = 0; c < 6; c++) TEST_NEAR(f[c], r[c], 1e-3 * 130, "support force");
  for (int c = 0; c < 6; c++) {
    e0[c] = x[c];
    vend[c] = vx[c];
  }
  PetscCall(AncfSetNodeMotion(a, 0, 0, e0, vend, none));
  PetscCall(AncfAdvance(a, 0.31));
  PetscCall(AncfGetState(a, NULL, &x, &vx, NULL));
  for (int c = 0; c < 6; c++) TEST_NEAR(x[c], e0[c] + 0.01 * vend[c], 1e-13, "uniform motion of the support");
  TEST_ERROR(AncfSetNodeMotion(a, 0, 2, e0, v0, acc), PETSC_ERR_ARG_WRONG, "no support");
  PetscCall(AncfDestroy(&a));
  PetscCall(AncfDestroy(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Damping C = alpha M slows a rigid translation as exp(-alpha t): second-order methods err by alpha^3 t dt^2/12 < 1e-6. */
static PetscErrorCode TestDamping(const char type[])
{
  const PetscReal alpha = 3, dt = 1e-3;
  char options[160];
  PetscReal p[3], p0[3];
  AncfBeamSpec s;
  Ancf a;

  PetscFunctionBegin;
  snprintf(options, sizeof(options), "%s -ancf_damping 3", type);
  PetscCall(SeedSpec(3, &s));
  s.end0 = ANCF_END_FREE;
  s.velocity[1] = 2;
  PetscCall(BeamCreate(&s, 0, options, &a));
  PetscCall(AncfGetMomentum(a, p0, NULL));
  for (int i = 1; i <= 500; i++) PetscCall(AncfAdvance(a, i * dt));
  PetscCall(AncfGetMomentum(a, p, NULL));
  TEST_REL(p[1], p0[1] * PetscExpReal(-0.5 * alpha), 3e-6, options);
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define QUAD22 "-ancf_quadrature_axial 2 -ancf_quadrature_bending 2"

/* Many beams in groups: as one beam alone, to Newton's tolerance; in blocktri as with the assembled matrix. */
static PetscErrorCode TestGroups(void)
{
  static const char *const options[] = {"-ancf_group_nodes 60",
                                        "-ancf_group_nodes 100000",
                                        "-ancf_group_nodes 60 -ancf_pc_type ilu",
                                        "-ancf_pc_type blocktri -ancf_mat_type baij",
                                        "-ancf_pc_type blocktri -ancf_mat_type aij",
                                        "-ancf_ts_type bdf -ancf_group_nodes 60",
                                        "-ancf_ts_type bdf -ancf_pc_type blocktri",
                                        QUAD22 " -ancf_pc_type ilu",
                                        QUAD22};
  PetscReal tips[9][40], alone[3];

  PetscFunctionBegin;
  for (int k = 0; k < 9; k++) {
    const PetscReal g[3] = {0, 0, -9.81};
    const PetscReal *e;
    PetscOptions db;
    PetscReal *Q;
    Ancf a;

    PetscCall(AncfCreate(PETSC_COMM_SELF, &a));
    for (int b = 0; b < 40; b++) { /* 2 to 6 elements: lanes of unequal length */
      AncfBeamSpec s;

      PetscCall(SeedSpec(2 + b % 5, &s));
      s.start[1] = s.end[1] = b;
      if (b % 7 == 3) s.end0 = ANCF_END_PIN;
      if (b % 7 == 5) s.end0 = ANCF_END_FREE;
      PetscCall(AncfAddBeam(a, &s, NULL));
    }
    PetscCall(AncfSetGravity(a, g));
    PetscCall(SetUpWith(a, options[k], NULL));
    for (int i = 1; i <= 100; i++) PetscCall(AncfAdvance(a, 1e-3 * i));
    PetscCall(AncfSaveState(a));
    PetscCall(AncfGetLoads(a, &Q));
    Q[6 * 151 + 2] = NAN;
    TEST_ERROR(AncfAdvance(a, 0.101), PETSC_ERR_FP, "Beam 30, node 1"); /* 3+4+5+6+7 nodes in 5 beams: node 150 starts beam 30 */
    Q[6 * 151 + 2] = 1e200;
    if (k < 5) TEST_ERROR(AncfAdvance(a, 0.101), PETSC_ERR_NOT_CONVERGED, "beam 30, element 0 of 2, node 1");
    PetscCall(AncfZeroLoads(a));
    for (int i = 101; i <= 120; i++) PetscCall(AncfAdvance(a, 1e-3 * i));
    if (k < 5) {
      PetscCall(AncfRestoreState(a));
      for (int i = 101; i <= 120; i++) PetscCall(AncfAdvance(a, 1e-3 * i));
    }
    PetscCall(TipHeights(a, 40, tips[k]));
    PetscCall(AncfDestroy(&a));
  }
  for (int k = 1; k < 9; k++)
    for (int b = 0; b < 40; b++) TEST_NEAR(tips[k][b], tips[k < 5 ? 0 : k < 7 ? 5 : 7][b], 1e-8, options[k]);
  PetscCall(Swing("", 2, 1e-3, 0.12, alone, NULL));
  TEST_NEAR(tips[0][0], alone[2], 1e-8, "a beam among many as a beam alone");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two beams, the second driven sideways, with every term of the equations of motion; theirs: stages by TSALPHA2's own operations.
 */
static PetscErrorCode StageRun(const char options[], PetscBool theirs, PetscReal e[60], PetscReal v[60], PetscReal A[60])
{
  const PetscReal g[3] = {0, 0, -9.81}, *p[3];
  AncfBeamSpec s;
  Ancf a;
  TS ts;

  PetscFunctionBegin;
  PetscCall(AncfCreate(PETSC_COMM_SELF, &a));
  PetscCall(SeedSpec(4, &s));
  PetscCall(AncfAddBeam(a, &s, NULL));
  s.start[1] = s.end[1] = 1;
  PetscCall(AncfAddBeam(a, &s, NULL));
  PetscCall(AncfSetGravity(a, g));
  if (theirs) PetscCall(AncfGetTS(a, &ts));
  PetscCall(SetUpWith(a, options, NULL));
  for (int k = 0; k < 20; k++) {
    const PetscReal t = 1e-3 * k, me[6] = {0, 1 + 5 * t * t, 0, 1}, mv[6] = {0, 10 * t}, ma[6] = {0, 10};
    PetscReal *load;

    PetscCall(AncfSetNodeMotion(a, 1, 0, me, mv, ma));
    PetscCall(AncfGetLoads(a, &load));
    load[6 * 4 + 1] = 10 * t;
    PetscCall(AncfGetLoadsEnd(a, &load));
    load[6 * 4 + 1] = 10 * t + 1e-2;
    PetscCall(AncfAdvance(a, t + 1e-3));
  }
  PetscCall(AncfGetState(a, NULL, &p[0], &p[1], NULL));
  PetscCall(AncfGetHistory(a, &p[2]));
  PetscCall(PetscArraycpy(e, p[0], 60));
  PetscCall(PetscArraycpy(v, p[1], 60));
  PetscCall(PetscArraycpy(A, p[2], 60));
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The stages of ancfstage.c are those of TSALPHA2. Newton stops at 1e-9 of its first residual or 1e-12 of the coordinates (about 1
  m), and converges quadratically, so both ends agree to about 1e-12 m; v and A take that over dt and beta dt^2, here 1e-3 s, with
  beta about 0.3, and a step or two more where one run stops an iteration earlier.
*/
static PetscErrorCode TestStage(const char options[])
{
  PetscReal x[2][3][60], err[3] = {0};

  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) PetscCall(StageRun(options, k ? PETSC_TRUE : PETSC_FALSE, x[k][0], x[k][1], x[k][2]));
  for (int q = 0; q < 3; q++)
    for (int i = 0; i < 60; i++) err[q] = PetscMax(err[q], PetscAbsReal(x[0][q][i] - x[1][q][i]));
  printf("stages with %s: %.1e m, %.1e m/s, %.1e m/s^2 from TSALPHA2's own\n", options, (double)err[0], (double)err[1],
         (double)err[2]);
  TEST(err[0] < 1e-11 && err[1] < 1e-8 && err[2] < 5e-5, "stage with %s: off by %g m, %g m/s, %g m/s^2", options, (double)err[0],
       (double)err[1], (double)err[2]);
  TEST(PetscAbsReal(x[0][0][26]) > 1e-4, "the beam with %s does not move: %g m", options, (double)x[0][0][26]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TestJacobian("-ancf_ts_type alpha2", PETSC_TRUE));
  PetscCall(TestJacobian("-ancf_ts_type alpha2 -ancf_strain engineering", PETSC_TRUE));
  PetscCall(TestJacobian("-ancf_ts_type bdf", PETSC_FALSE));
  PetscCall(TestJacobian("-ancf_ts_type alpha2 -ancf_damping 7", PETSC_TRUE));
  PetscCall(TestJacobian("-ancf_ts_type theta -ancf_damping 7", PETSC_FALSE));
  PetscCall(TestJacobian("-ancf_ts_type alpha2 -ancf_damping_stiffness 0.3", PETSC_TRUE));
  PetscCall(TestJacobian("-ancf_ts_type bdf -ancf_damping_stiffness 0.3 -ancf_strain engineering", PETSC_FALSE));
  PetscCall(TestTypes());
  PetscCall(TestStage("-ancf_ts_alpha_radius 0.8"));
  PetscCall(TestStage("-ancf_ts_alpha_radius 0.5 -ancf_substeps 3 -ancf_damping 3"));
  PetscCall(TestStage("-ancf_ts_alpha_radius 1 -ancf_damping_stiffness 0.01 -ancf_strain engineering"));
  PetscCall(TestContinuation("-ancf_ts_type alpha2"));
  PetscCall(TestContinuation("-ancf_ts_type bdf"));
  PetscCall(TestMomentum("-ancf_ts_type alpha2", 1e-4));
  PetscCall(TestMomentum("-ancf_ts_type alpha2 -ancf_ts_alpha_radius 1", 1e-11));
  PetscCall(TestMomentum("-ancf_ts_type theta", 1e-11));
  PetscCall(TestLinearLoads("-ancf_ts_alpha_radius 1"));
  PetscCall(TestLinearLoads("-ancf_ts_alpha_radius 1 -ancf_substeps 3"));
  PetscCall(TestLinearLoads("-ancf_ts_type theta"));
  PetscCall(TestLinearLoads("-ancf_ts_type rk -ancf_substeps 2"));
  PetscCall(TestRestore("-ancf_ts_type alpha2"));
  PetscCall(TestRestore("-ancf_ts_type alpha2 -ancf_ts_alpha_radius 1"));
  PetscCall(TestRestore("-ancf_ts_type theta"));
  PetscCall(TestRestore("-ancf_ts_type rk -ancf_substeps 4"));
  {
    static const char *const types[] = {"-ancf_ts_alpha_radius 1", "-ancf_ts_type alpha2", "-ancf_ts_type theta",
                                        "-ancf_ts_type rk -ancf_substeps 5",
                                        "-ancf_ts_type basicsymplectic -ancf_ts_basicsymplectic_type 2 -ancf_substeps 5"};
    PetscReal coarse, fine;

    for (int k = 0; k < 5; k++) {
      PetscCall(TestMovingSupport(types[k], 1e-3, &coarse));
      PetscCall(TestMovingSupport(types[k], 5e-4, &fine));
      TEST(fine < coarse / 3 || fine < 1e-9, "%s: error %g after %g with twice the step", types[k], (double)fine, (double)coarse);
    }
  }
  PetscCall(TestDamping("-ancf_ts_type alpha2"));
  PetscCall(TestDamping("-ancf_ts_type theta"));
  PetscCall(TestDamping("-ancf_ts_type rk -ancf_substeps 4"));
  PetscCall(TestGroups());
  PetscCall(PetscFinalize());
  return test_report();
}
