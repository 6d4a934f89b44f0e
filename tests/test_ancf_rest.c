/* test_ancf_rest.c - curved and prestressed beams: tangent, invariance, rest, arcs under loads, strings; sections; refusals. */
#include "ancf_common.h"
#include "ancfimpl.h"

/* Arc of radius R over `turn` rad from (R, 0, 0) about the z-axis, clamped there; turned into the frame of columns t, s, n. */
static PetscErrorCode ArcSpec(PetscReal R, PetscReal turn, PetscInt n, const PetscReal F[3][3], AncfBeamSpec *s)
{
  PetscFunctionBegin;
  PetscCall(AncfBeamSpecInit(s));
  for (int c = 0; c < 3; c++) {
    s->start[c] = R * F[0][c];
    s->end[c] = R * (PetscCosReal(turn) * F[0][c] + PetscSinReal(turn) * F[1][c]);
    s->normal[c] = 3 * F[2][c]; /* of any length */
  }
  s->curvature = 1 / R;
  s->elements = n;
  s->diameter = 0.01;
  s->EA = 1e4;
  s->EI = 1;
  s->rhoA = 1;
  s->end0 = ANCF_END_CLAMP;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const PetscReal plain[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
static const PetscReal oblique[3][3] = {{2. / 3, -1. / 3, 2. / 3}, {2. / 3, 2. / 3, -1. / 3}, {-1. / 3, 2. / 3, 2. / 3}};

/*
  Force and energy at random states against central differences: with steps h = 1e-5 of unit size the error is h^2 times third
  derivatives, a few hundred times EA, plus 2e-16 EA/h.
*/
static PetscErrorCode TestTangent(const char options[])
{
  const PetscReal h = 1e-5;
  PetscReal worst[2] = {0, 0}, scale[2] = {0, 0};
  AncfBeamSpec s;
  Ancf a;
  Mat J;
  PC pc;
  PetscInt n;
  PetscReal *f[2], *e;

  PetscFunctionBegin;
  PetscCall(AncfCreate(PETSC_COMM_SELF, &a));
  PetscCall(ArcSpec(1, 1, 2, oblique, &s));
  s.EA = 3;
  s.pretension = 0.4;
  s.end0 = ANCF_END_FREE;
  PetscCall(AncfAddBeam(a, &s, NULL));
  s.curvature = 0;
  s.pretension = -0.7;
  PetscCall(AncfAddBeam(a, &s, NULL));
  PetscCall(SetUpWith(a, options, NULL));
  n = 6 * a->nnodes;
  PetscCall(PetscMalloc3(n, &f[0], n, &f[1], n, &e));
  for (PetscInt i = 0; i < n; i++) a->e[i] += 0.1 * Random();
  PetscCall(PetscArraycpy(e, a->e, n));
  PetscCall(PCCreate(PETSC_COMM_SELF, &pc));
  PetscCall(PCSetType(pc, PCLU));
  PetscCall(AncfCreateMatrix(a, 6, pc, PETSC_FALSE, &J));
  PetscCall(AncfAssemble(a, e, NULL, 6, 0, 0, 1, J, J));
  for (PetscInt i = 0; i < n; i++) {
    PetscReal U[2];

    for (int k = 0; k < 2; k++) {
      a->e[i] = e[i] + (k ? h : -h);
      PetscCall(AncfResidual(a, a->e, 6, NULL, 0, f[k], 6));
      PetscCall(AncfElasticEnergy(a, &U[k]));
      a->e[i] = e[i];
    }
    PetscCall(AncfResidual(a, a->e, 6, NULL, 0, e, 6)); /* e: borrowed for the force itself */
    worst[0] = PetscMax(worst[0], PetscAbsReal((U[1] - U[0]) / (2 * h) - e[i]));
    scale[0] = PetscMax(scale[0], PetscAbsReal(e[i]));
    PetscCall(PetscArraycpy(e, a->e, n));
    for (PetscInt r = 0; r < n; r++) {
      PetscScalar k;

      PetscCall(MatGetValue(J, r, i, &k));
      worst[1] = PetscMax(worst[1], PetscAbsReal((f[1][r] - f[0][r]) / (2 * h) - k));
      scale[1] = PetscMax(scale[1], PetscAbsReal(k));
    }
  }
  printf("%-28s energy and force %.1e of %.1e, force and tangent %.1e of %.1e\n", options, worst[0], scale[0], worst[1],
         scale[1]);
  TEST(worst[0] < 1e-7 * scale[0] && scale[0] > 0.1, "force is not the derivative of the energy: %g", (double)worst[0]);
  TEST(worst[1] < 1e-7 * scale[1] && scale[1] > 0.1, "tangent is not the derivative of the force: %g", (double)worst[1]);
  PetscCall(PetscFree3(f[0], f[1], e));
  PetscCall(MatDestroy(&J));
  PetscCall(PCDestroy(&pc));
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Without loads an arc, clamped or free, stays: forces cancel to round-off, 1e-16 EI kappa/l, which bend it by 1e-16 L^3/(R l).
 */
static PetscErrorCode TestRest(const char options[])
{
  PetscReal worst = 0, *x;
  const PetscReal *e;
  PetscInt n;
  Ancf a;

  PetscFunctionBegin;
  PetscCall(AncfCreate(PETSC_COMM_SELF, &a));
  for (int b = 0; b < 6; b++) {
    AncfBeamSpec s;

    PetscCall(ArcSpec(1, 0.5 + 0.4 * b, 4 + b, b % 2 ? oblique : plain, &s));
    if (b > 2) s.end0 = ANCF_END_FREE;
    if (b == 5) { /* the same arc the other way round */
      s.curvature = -s.curvature;
      for (int c = 0; c < 3; c++) s.normal[c] = -s.normal[c];
    }
    PetscCall(AncfAddBeam(a, &s, NULL));
  }
  PetscCall(SetUpWith(a, options, NULL));
  PetscCall(AncfGetNumNodes(a, &n));
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  PetscCall(PetscMalloc1(6 * (size_t)n, &x));
  PetscCall(PetscArraycpy(x, e, 6 * n));
  for (int i = 1; i <= 50; i++) PetscCall(AncfAdvance(a, i * 0.01));
  for (PetscInt i = 0; i < 6 * n; i++) worst = PetscMax(worst, PetscAbsReal(e[i] - x[i]));
  /* alpha2 and Newton's method add their own round-off, EA 1e-16 against a stiffness EI/l^2 (gradients): 1e-14 */
  printf("%-28s arcs without loads move by %.1e\n", options, worst);
  TEST(worst < 1e-12, "an arc without loads moves by %g", (double)worst);
  PetscCall(PetscFree(x));
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  A quarter of a circle, clamped, small force P at the tip across its tangent. Castigliano with M = P R cos(phi),
  N = -P cos(phi): delta = pi/4 (P R^3/EI + P R/EA) along P, and 1/2 (P R^3/EI - P R/EA) along the tangent.
  P R^2/EI = 1e-4 makes the rest of the geometry 1e-4; stretch changes the moment by eps, and bending the stretch, at the order
  EI/(EA R^2) = 1e-4.
*/
static PetscErrorCode TestQuarter(const char options[], const PetscReal F[3][3], PetscReal u[2])
{
  const PetscReal P = 1e-4, EA = 1e4, along = PETSC_PI / 4 * P * (1 + 1 / EA), across = 0.5 * P * (1 - 1 / EA);
  PetscReal err[2];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; k++) {
    const PetscInt n = k ? 16 : 8;
    AncfBeamSpec s;
    const PetscReal *e;
    PetscReal load[3], d[3];
    Ancf a;

    PetscCall(ArcSpec(1, PETSC_PI / 2, n, F, &s));
    PetscCall(BeamCreate(&s, 0, options, &a));
    for (int c = 0; c < 3; c++) load[c] = -P * F[1][c];
    PetscCall(AncfAddPointLoad(a, 0, 1, load));
    PetscCall(AncfSolveStatic(a, 1));
    PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
    u[0] = u[1] = 0;
    for (int c = 0; c < 3; c++) {
      d[c] = e[6 * n + c] - s.end[c];
      u[0] -= d[c] * F[1][c];
      u[1] -= d[c] * F[0][c];
    }
    err[k] = PetscMax(PetscAbsReal(u[0] / along - 1), PetscAbsReal(u[1] / across - 1));
    printf("quarter circle, %2d elements: (%.6e, %.6e), Castigliano (%.6e, %.6e)\n", (int)n, u[0], u[1], along, across);
    PetscCall(AncfDestroy(&a));
  }
  TEST(err[1] < 5e-4, "16 elements: %g", (double)err[1]);
  TEST(err[0] < 1e-2, "8 elements: %g", (double)err[0]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  An end moment -EI/R makes the arc straight. Cubics hold the line exactly, but the curvature of their arc varies by
  (l/R)^2/12 about 1/R, which leaves at most that part of the deflection L^2/(2R).
*/
static PetscErrorCode TestStraighten(void)
{
  const PetscInt n = 16;
  const PetscReal M[3] = {0, 0, -1}, tol = PetscSqr(1. / n) / 12 * 0.5;
  const PetscReal *e;
  PetscReal m[3], N;
  AncfBeamSpec s;
  Ancf a;

  PetscFunctionBegin;
  PetscCall(ArcSpec(1, 1, n, plain, &s));
  PetscCall(BeamCreate(&s, 0, "-ancf_strain engineering", &a));
  PetscCall(AncfSetMoment(a, 0, n, M));
  PetscCall(AncfSolveStatic(a, 5));
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  printf("arc of 1 rad under -EI/R: tip (%.8f, %.8f), straight (1, 1)\n", e[6 * n], e[6 * n + 1]);
  TEST_NEAR(e[6 * n], 1, tol, "tip x");
  TEST_NEAR(e[6 * n + 1], 1, tol, "tip y");
  PetscCall(AncfGetSection(a, 0, 0.5 + (0.5 - 0.5 / PetscSqrtReal(3)) / n, NULL, &N, NULL, m));
  TEST_NEAR(m[2], -1, 1. / (12 * n * n), "bending moment");
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reaction and section force of a pinned string are T; its first mode has w^2 = (pi/L)^2 (T + EI (pi/L)^2)/rhoA. */
static PetscErrorCode TestString(void)
{
  const PetscInt n = 16, half = 400;
  const PetscReal T = 50, w = PETSC_PI * PetscSqrtReal(T + PetscSqr(PETSC_PI)), dt = PETSC_PI / w / half, A = 1e-5;
  AncfBeamSpec s;
  Ancf a;
  PetscReal x[102], v[102], f[6], N, cross = 0, prev = 0;
  const PetscReal *e;

  PetscFunctionBegin;
  PetscCall(AncfBeamSpecInit(&s));
  s.end[0] = 1;
  s.elements = n;
  s.diameter = 0.01;
  s.EA = 1e5;
  s.EI = s.rhoA = 1;
  s.pretension = T;
  s.end0 = s.end1 = ANCF_END_PIN;
  PetscCall(BeamCreate(&s, 0, "-ancf_ts_alpha_radius 1", &a));
  PetscCall(AncfGetNodeReaction(a, 0, n, f));
  TEST_NEAR(f[0], T, 1e5 * n * PETSC_MACHINE_EPSILON, "reaction of the string"); /* EA/l times the round-off of positions */
  PetscCall(AncfGetSection(a, 0, 0.3, NULL, &N, NULL, NULL));
  TEST_REL(N, T, 1e-12, "force of the string");
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  for (PetscInt j = 0; j <= n; j++)
    for (int c = 0; c < 6; c++) {
      x[6 * j + c] = e[6 * j + c];
      v[6 * j + c] = c == 2   ? (j % n ? A * w * PetscSinReal(PETSC_PI * j / n) : 0)
                     : c == 5 ? A * w * PETSC_PI * PetscCosReal(PETSC_PI * j / n)
                              : 0;
    }
  PetscCall(AncfSetState(a, 0, x, v));
  for (PetscInt i = 1; i <= half + 20 && cross == 0; i++) {
    PetscCall(AncfAdvance(a, i * dt));
    if (prev > 0 && e[6 * (n / 2) + 2] <= 0) cross = (i - 1 + prev / (prev - e[6 * (n / 2) + 2])) * dt;
    prev = e[6 * (n / 2) + 2];
  }
  printf("string: half a period %.8f s, exact %.8f s\n", cross, PETSC_PI / w);
  /* midpoint's period is (w dt)^2/12 = 5e-6 long; the strain T/EA = 5e-4 makes the string of the paper's measure r' longer */
  TEST_REL(cross, PETSC_PI / w, 2e-5, "half a period");
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define ARCS 20

static PetscErrorCode CreateArcs(const char options[], const PetscReal F[3][3], Ancf *ancf)
{
  PetscReal g[3];
  Ancf a;

  PetscFunctionBegin;
  PetscCall(AncfCreate(PETSC_COMM_SELF, &a));
  for (int b = 0; b < ARCS; b++) {
    AncfBeamSpec s;

    PetscCall(ArcSpec(0.5 + 0.05 * b, 0.5 + 0.05 * b, 3 + b % 3, F, &s));
    s.pretension = b % 9 - 4;
    if (b == 4) s.bendingdamping = 0.01;
    PetscCall(AncfAddBeam(a, &s, NULL));
  }
  for (int c = 0; c < 3; c++) g[c] = -F[0][c] - 0.5 * F[1][c];
  PetscCall(AncfSetGravity(a, g));
  PetscCall(SetUpWith(a, options, NULL));
  *ancf = a;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ArcTips(Ancf a, const PetscReal F[3][3], PetscReal tip[ARCS][2])
{
  const PetscReal *e;

  PetscFunctionBegin;
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  for (int b = 0; b < ARCS; b++) {
    AncfBeamSpec s;
    PetscInt first;

    PetscCall(AncfGetBeam(a, b, &s, &first, NULL));
    for (int k = 0; k < 2; k++) {
      tip[b][k] = 0;
      for (int c = 0; c < 3; c++) tip[b][k] += F[k][c] * e[6 * (first + s.elements) + c];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Arcs of all sizes swing in their planes: an assembled matrix, beams in lanes, groups, and in an oblique plane, the same. */
static PetscErrorCode TestSame(void)
{
  static const char *const runs[] = {"-ancf_pc_type ilu -ancf_mat_type baij", "-ancf_pc_type blocktri",
                                     "-ancf_pc_type blocktri -ancf_group_nodes 30", "-ancf_pc_type blocktri"};
  PetscReal ref[ARCS][2], tip[ARCS][2], start[ARCS][2];

  PetscFunctionBegin;
  for (int r = 0; r < 4; r++) {
    const PetscReal(*F)[3] = r == 3 ? oblique : plain;
    PetscReal worst = 0, moved = 0;
    Ancf a;

    PetscCall(CreateArcs(runs[r], F, &a));
    PetscCall(ArcTips(a, F, start));
    for (int i = 1; i <= 100; i++) PetscCall(AncfAdvance(a, i * 2e-3));
    PetscCall(ArcTips(a, F, r ? tip : ref));
    TEST((a->ngroups > 1) == (r == 2), "run %d has %d groups", r, (int)a->ngroups);
    PetscCall(AncfDestroy(&a));
    for (int i = 0; i < 2 * ARCS; i++) {
      moved = PetscMax(moved, PetscAbsReal(ref[i / 2][i % 2] - start[i / 2][i % 2]));
      if (r) worst = PetscMax(worst, PetscAbsReal(tip[i / 2][i % 2] - ref[i / 2][i % 2]));
    }
    TEST(moved > 1e-3, "the arcs move by %g", (double)moved);
    if (r) printf("arcs, %-45s %-7s: off by %.1e, moved by %.1e\n", runs[r], r == 3 ? "oblique" : "", worst, moved);
    TEST(worst < 1e-9, "run %d: off by %g", r, (double)worst); /* Newton's tolerance 1e-8 of the step's change */
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A run that goes on from a packed state has the bits of the one that was packed. */
static PetscErrorCode TestPack(void)
{
  PetscReal tip[2][ARCS][2], *state;
  PetscInt n;
  Ancf a[2];

  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) PetscCall(CreateArcs("", plain, &a[k]));
  for (int i = 1; i <= 20; i++) PetscCall(AncfAdvance(a[0], i * 2e-3));
  PetscCall(AncfGetPackSize(a[0], &n));
  PetscCall(PetscMalloc1(n, &state));
  PetscCall(AncfPack(a[0], state));
  PetscCall(AncfUnpack(a[1], state));
  PetscCall(PetscFree(state));
  for (int k = 0; k < 2; k++) {
    for (int i = 21; i <= 40; i++) PetscCall(AncfAdvance(a[k], i * 2e-3));
    PetscCall(ArcTips(a[k], plain, tip[k]));
    PetscCall(AncfDestroy(&a[k]));
  }
  TEST(!memcmp(tip[0], tip[1], sizeof(tip[0])), "an unpacked run has other bits");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateBad(const AncfBeamSpec *s)
{
  Ancf a;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  ierr = BeamCreate(s, 0, "", &a);
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(ierr);
}

/* Stiffness and mass of the sections by their formulas, and the mass that moves by the momentum of a free beam at 2 m/s. */
static PetscErrorCode TestSections(void)
{
  static const struct {
    PetscReal diameter, inner, width, thickness, density, A, I2;
  } runs[] = {{0.02, 0, 0, 0, 1000, PETSC_PI * 1e-4, PETSC_PI / 4 * 1e-8},
              {0.02, 0.01, 0, 0, 1000, PETSC_PI * 0.75e-4, PETSC_PI / 4 * (1e-8 - 6.25e-10)},
              {0.02, 0.01, 0, 0, 3000, PETSC_PI * 0.75e-4, PETSC_PI / 4 * (1e-8 - 6.25e-10)},
              {0, 0, 0.03, 0.03, 1000, 9e-4, 8.1e-7 / 12},
              {0, 0, 0.05, 0.01, 1000, 5e-4, 0.05e-6 / 12}};

  PetscFunctionBegin;
  for (size_t k = 0; k < sizeof(runs) / sizeof(runs[0]); k++) {
    AncfBeamSpec s, got;
    PetscReal p[3];
    Ancf a;

    PetscCall(AncfBeamSpecInit(&s));
    s.end[0] = 2;
    s.diameter = runs[k].diameter;
    s.inner = runs[k].inner;
    s.width = runs[k].width;
    s.thickness = runs[k].thickness;
    s.density = runs[k].density;
    s.young = 1e9;
    s.velocity[1] = 2;
    s.normal[2] = runs[k].width != runs[k].thickness;
    PetscCall(BeamCreate(&s, 0, "", &a));
    PetscCall(AncfGetBeam(a, 0, &got, NULL, NULL));
    TEST_REL(got.EA, 1e9 * runs[k].A, 1e-14, "EA");
    TEST_REL(got.EI, 1e9 * runs[k].I2, 1e-14, "EI");
    s.density *= 5; /* the caller's copy: the beam keeps its mass, and takes no other after set-up */
    TEST_ERROR(AncfAddBeam(a, &s, NULL), PETSC_ERR_ARG_WRONGSTATE, "after AncfSetUp");
    PetscCall(AncfAdvance(a, 1e-3));
    PetscCall(AncfGetMomentum(a, p, NULL));
    TEST_REL(p[1], 4 * runs[k].density * runs[k].A, 1e-12, "momentum");
    PetscCall(AncfDestroy(&a));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A flat strip declared planar: bends by F L^3/(3 EI) in its plane, and is refused outside. */
static PetscErrorCode TestStrip(void)
{
  const PetscReal in[3] = {0, 1e-6, 0}, out[3] = {0, 0, 1};
  const PetscReal *e;
  AncfBeamSpec s;
  Ancf a;

  PetscFunctionBegin;
  PetscCall(AncfBeamSpecInit(&s));
  s.end[0] = 1;
  s.width = 0.05;
  s.thickness = 0.01;
  s.young = 1e9;
  s.density = 1000;
  s.end0 = ANCF_END_CLAMP;
  TEST_ERROR(CreateBad(&s), PETSC_ERR_SUP, "two bending stiffnesses");
  s.normal[2] = 1;
  PetscCall(BeamCreate(&s, 0, "", &a));
  PetscCall(AncfAddPointLoad(a, 0, 1, in));
  PetscCall(AncfSolveStatic(a, 1));
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  TEST_REL(e[25], in[1] / (3 * 1e9 * 0.05e-6 / 12), 1e-6, "tip of the strip");
  PetscCall(AncfAddPointLoad(a, 0, 1, out));
  TEST_ERROR(AncfAdvance(a, 1), PETSC_ERR_SUP, "leaves its plane");
  PetscCall(AncfDestroy(&a));
  s.inner = 0.01;
  TEST_ERROR(CreateBad(&s), PETSC_ERR_ARG_INCOMP, "a tube or a rectangle");
  s.inner = 0;
  s.thickness = -0.01;
  TEST_ERROR(CreateBad(&s), PETSC_ERR_ARG_OUTOFRANGE, "thickness = -0.01");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestBad(void)
{
  const PetscReal F[3] = {0, 0, 0.1};
  AncfBeamSpec s, bad;
  Ancf a;

  PetscFunctionBegin;
  PetscCall(ArcSpec(1, 1, 4, plain, &s));
#define BAD(change, code, word)                                                                                                  \
  do {                                                                                                                           \
    bad = s;                                                                                                                     \
    change;                                                                                                                      \
    TEST_ERROR(CreateBad(&bad), code, word);                                                                                     \
  } while (0)
  BAD(bad.curvature = 2.1, PETSC_ERR_ARG_OUTOFRANGE, "curvature = 2.1");
  BAD(bad.curvature = NAN, PETSC_ERR_ARG_OUTOFRANGE, "curvature");
  BAD(bad.pretension = INFINITY, PETSC_ERR_ARG_OUTOFRANGE, "pretension");
  BAD(bad.normal[2] = 0, PETSC_ERR_ARG_INCOMP, "normal");
  BAD(bad.normal[1] = 1, PETSC_ERR_ARG_INCOMP, "normal");
  PetscCall(BeamCreate(&s, 0, "", &a));
  PetscCall(AncfAddPointLoad(a, 0, 1, F));
  TEST_ERROR(AncfSolveStatic(a, 1), PETSC_ERR_SUP, "leaves its plane");
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscReal u[2], w[2];

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TestTangent(""));
  PetscCall(TestTangent("-ancf_strain engineering"));
  PetscCall(TestTangent("-ancf_quadrature_axial 2"));
  PetscCall(TestRest(""));
  PetscCall(TestRest("-ancf_strain engineering"));
  PetscCall(TestQuarter("", plain, u));
  PetscCall(TestQuarter("", oblique, w));
  for (int k = 0; k < 2; k++) TEST_NEAR(u[k], w[k], 1e-12, "quarter circle in an oblique plane");
  PetscCall(TestQuarter("-ancf_strain engineering", plain, u));
  PetscCall(TestStraighten());
  PetscCall(TestString());
  PetscCall(TestSame());
  PetscCall(TestPack());
  PetscCall(TestSections());
  PetscCall(TestStrip());
  PetscCall(TestBad());
  PetscCall(PetscFinalize());
  return test_report();
}
