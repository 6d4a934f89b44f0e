/* test_ancf_validation.c - large static deflections, catenary, pendulum, free spin, invariance under rotations. */
#include "ancf_common.h"

/* Bending beam of length L along x, clamped at the origin, from EA and EI alone. */
static PetscErrorCode Cantilever(PetscInt n, PetscReal L, PetscReal EA, PetscReal EI, const char options[], Ancf *a)
{
  AncfBeamSpec s;

  PetscFunctionBegin;
  PetscCall(AncfBeamSpecInit(&s));
  s.end[0] = L;
  s.elements = n;
  s.diameter = 0.01;
  s.EA = EA;
  s.EI = EI;
  s.rhoA = 1;
  s.end0 = ANCF_END_CLAMP;
  PetscCall(BeamCreate(&s, 0, options, a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Incomplete elliptic integrals from phi to pi/2 by composite Gauss quadrature (integrands smooth for k < 1). */
static void Elliptic(double k, double phi, double *F, double *E)
{
  static const double x[5] = {0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640, -0.9061798459386640};
  static const double w[5] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665, 0.2369268850561891, 0.2369268850561891};
  const int n = 400;
  const double h = (PETSC_PI / 2 - phi) / n;

  *F = *E = 0;
  for (int i = 0; i < n; i++)
    for (int q = 0; q < 5; q++) {
      double t = phi + h * (i + 0.5 + 0.5 * x[q]), s = sqrt(1 - k * k * sin(t) * sin(t));

      *F += 0.5 * h * w[q] / s;
      *E += 0.5 * h * w[q] * s;
    }
}

/* Bisshopp and Drucker, Q. Appl. Math. 3 (1945) 272: tip of an inextensible cantilever under alpha = P L^2/EI. */
static void Elastica(double alpha, double *x, double *v)
{
  double lo = 1e-9, hi = PETSC_PI / 2 - 1e-9, theta = 0, k, phi, F, E;

  for (int i = 0; i < 200; i++) { /* alpha grows with the tip's angle theta */
    theta = 0.5 * (lo + hi);
    k = sqrt(0.5 * (1 + sin(theta)));
    phi = asin(1 / (k * sqrt(2)));
    Elliptic(k, phi, &F, &E);
    if (F * F < alpha)
      lo = theta;
    else
      hi = theta;
  }
  k = sqrt(0.5 * (1 + sin(theta)));
  phi = asin(1 / (k * sqrt(2)));
  Elliptic(k, phi, &F, &E);
  *x = sqrt(2 * sin(theta) / alpha);
  *v = 1 - 2 * E / sqrt(alpha);
}

/* 8 elements within 0.5 % of each value; the extension alpha EI/(EA L^2) is at most 1e-3. */
static PetscErrorCode TestElastica(void)
{
  static const double alphas[] = {0.25, 0.5, 1, 2, 3, 4, 5, 7.5, 10};
  double x, v;

  PetscFunctionBegin;
  Elastica(1, &x, &v);
  TEST_NEAR(1 - x, .0564332, 1e-7, "reference at alpha = 1");
  TEST_NEAR(v, .3017208, 1e-7, "reference at alpha = 1");
  Elastica(10, &x, &v);
  TEST_NEAR(1 - x, .5549956, 1e-7, "reference at alpha = 10");
  TEST_NEAR(v, .8106090, 1e-7, "reference at alpha = 10");
  printf("alpha   1-x/L: 8 elements, elastica     v/L: 8 elements, elastica\n");
  for (size_t i = 0; i < sizeof(alphas) / sizeof(alphas[0]); i++) {
    const PetscReal *e;
    PetscReal *Q;
    Ancf a;

    PetscCall(Cantilever(8, 1, 1e4, 1, "", &a));
    PetscCall(AncfGetLoads(a, &Q));
    Q[6 * 8 + 2] = alphas[i];
    PetscCall(AncfSolveStatic(a, 4));
    PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
    Elastica(alphas[i], &x, &v);
    printf("%5.2f   %.6f  %.6f             %.6f  %.6f\n", alphas[i], 1 - e[48], 1 - x, e[50], v);
    TEST_REL(1 - e[48], 1 - x, 5e-3, "elastica 1 - x/L");
    TEST_REL(e[50], v, 5e-3, "elastica v/L");
    PetscCall(AncfDestroy(&a));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* 0.1 x 0.1 m steel, L = 2 m, F = 3 EI/L^2; engineering strains: EXUDYN's published displacement of the tip (many elements). */
static PetscErrorCode TestLargeCantilever(void)
{
  static const struct {
    const char *options;
    PetscReal ux, uz, tol;
  } runs[] = {{"-ancf_strain engineering -ancf_quadrature_axial 5", -.508537304, -1.207239855, 2e-5},
              {"-ancf_quadrature_axial 5", -.508918644, -1.208380547, 2e-5}};

  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) {
    const PetscReal EI = 2.07e11 * 1e-4 / 12, *e;
    PetscReal *Q;
    Ancf a;

    PetscCall(Cantilever(32, 2, 2.07e9, EI, runs[k].options, &a));
    PetscCall(AncfGetLoads(a, &Q));
    Q[6 * 32 + 2] = -3 * EI / 4;
    PetscCall(AncfSolveStatic(a, 5));
    PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
    printf("large cantilever %-50s tip (%.9f, %.9f), reference (%.9f, %.9f)\n", runs[k].options, e[192] - 2, e[194], runs[k].ux,
           runs[k].uz);
    TEST_NEAR(e[192] - 2, runs[k].ux, runs[k].tol, "tip displacement x");
    TEST_NEAR(e[194], runs[k].uz, runs[k].tol, "tip displacement z");
    PetscCall(AncfDestroy(&a));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  End moment M = 2 pi EI/L. With engineering strains, whose bending energy does not depend on the stretch, the beam closes to a
  circle; known errors of the element .0925 L with 4 (5 + 3 Gauss points), 1.5e-3 L with 8. The paper's curvature falls with the
  stretch lambda, so that the moment also stretches the beam: N = 0 gives lambda^2 = 1 + 2 M^2/(EA EI), and the end turns by
  M lambda^2 L/EI, which leaves a chord |sin(pi lambda^2)|/(pi lambda) open.
*/
static PetscErrorCode TestRollUp(PetscBool paper)
{
  const PetscReal EA = 1e4, K = 2 * PETSC_PI, lambda2 = paper ? 1 + 2 * K * K / EA : 1;
  const PetscReal chord = PetscAbsReal(PetscSinReal(PETSC_PI * lambda2)) / (PETSC_PI * PetscSqrtReal(lambda2));
  PetscReal err[2] = {0, 0};

  PetscFunctionBegin;
  for (PetscInt n = 4; n <= 16; n *= 2) {
    const PetscReal *e, M[3] = {0, -K, 0}, gauss = 0.5 - 0.5 / PetscSqrtReal(3); /* where the curvature of a cubic is best */
    PetscReal tip, kappa[3], N;
    Ancf a;

    PetscCall(Cantilever(n, 1, EA, 1, paper ? "" : "-ancf_strain engineering", &a));
    PetscCall(AncfSetMoment(a, 0, n, M));
    PetscCall(AncfSolveStatic(a, 20));
    PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
    PetscCall(AncfGetSection(a, 0, 0.5 + gauss / (PetscReal)n, NULL, &N, kappa, NULL));
    tip = PetscSqrtReal(PetscSqr(e[6 * n]) + PetscSqr(e[6 * n + 2]));
    printf("roll-up %-11s %2d elements: chord %.3e, exact %.3e; kappa %.5f, exact %.5f\n", paper ? "paper" : "engineering",
           (int)n, tip, chord, -kappa[1], K * PetscSqrtReal(lambda2));
    if (n >= 8) err[n / 8 - 1] = PetscAbsReal(tip - chord);
    if (n == 16) TEST_REL(-kappa[1], K * PetscSqrtReal(lambda2), 5e-3, "curvature of the circle");
    PetscCall(AncfDestroy(&a));
  }
  TEST(err[0] < 3e-3, "8 elements: %g", (double)err[0]);
  TEST(err[1] < err[0] / 4, "16 elements: %g after %g", (double)err[1], (double)err[0]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* theta'' = -lambda (1-s) cos(theta): Runge-Kutta and shooting on the clamp's curvature; lambda = q L^3/EI. */
static void SelfWeight(double lambda, double *x, double *y)
{
  double lo = 0, hi = lambda;

  for (int it = 0; it < 100; it++) {
    const int n = 2000;
    const double h = 1.0 / n, k0 = 0.5 * (lo + hi);
    double th = 0, k = k0;

    *x = *y = 0;
    for (int i = 0; i < n; i++) {
      const double s = i * h;
      const double a1 = k, b1 = -lambda * (1 - s) * cos(th);
      const double a2 = k + 0.5 * h * b1, b2 = -lambda * (1 - s - 0.5 * h) * cos(th + 0.5 * h * a1);
      const double a3 = k + 0.5 * h * b2, b3 = -lambda * (1 - s - 0.5 * h) * cos(th + 0.5 * h * a2);
      const double a4 = k + h * b3, b4 = -lambda * (1 - s - h) * cos(th + h * a3);
      const double mid = th + h * (a1 + a2 + a3 + a4) / 8 + h * (a1 - a4) / 16; /* Hermite midpoint up to h^3 */

      *x += h / 6 * (cos(th) + 4 * cos(mid) + cos(th + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)));
      *y += h / 6 * (sin(th) + 4 * sin(mid) + sin(th + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)));
      th += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
      k += h / 6 * (b1 + 2 * b2 + 2 * b3 + b4);
    }
    if (k > 0)
      hi = k0; /* curvature left at the free end */
    else
      lo = k0;
  }
}

static PetscErrorCode TestSelfWeight(void)
{
  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) {
    const double lambda = k ? 10 : 1, rx = k ? .656354 : .991246, ry = k ? .700200 : .123471;
    const PetscReal *e, q[3] = {0, 0, lambda};
    double x, y;
    Ancf a;

    SelfWeight(lambda, &x, &y);
    TEST_NEAR(x, rx, 2e-6, "reference x/L");
    TEST_NEAR(y, ry, 2e-6, "reference y/L");
    PetscCall(Cantilever(16, 1, 1e5, 1, "", &a));
    PetscCall(AncfAddLineLoad(a, 0, q));
    PetscCall(AncfSolveStatic(a, 5));
    PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
    printf("line load lambda = %g: tip (%.6f, %.6f), elastica (%.6f, %.6f)\n", lambda, e[96], e[98], x, y);
    TEST_NEAR(e[96], x, 2e-3, "tip x/L");
    TEST_NEAR(e[98], y, 2e-3, "tip y/L");
    PetscCall(AncfDestroy(&a));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A point load between nodes bends like the beam theory says: v = F a^2 (3L - a)/(6 EI) at the tip for a small force at a. */
static PetscErrorCode TestPointLoad(void)
{
  const PetscReal *e, F[3] = {0, 1e-4, 0}, at = 0.37;
  PetscReal M[3], N;
  Ancf a;

  PetscFunctionBegin;
  PetscCall(Cantilever(8, 1, 1e4, 1, "", &a));
  PetscCall(AncfAddPointLoad(a, 0, at, F));
  PetscCall(AncfSolveStatic(a, 1));
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  TEST_REL(e[49], F[1] * at * at * (3 - at) / 6, 1e-6,
           "tip under a point load"); /* cubic elements: exact at nodes, linear theory */
  PetscCall(AncfGetSection(a, 0, 0.0625, NULL, &N, NULL, M));
  TEST_REL(M[2], F[1] * (at - 0.0625), 1e-6, "bending moment");
  PetscCall(AncfClearLoads(a));
  PetscCall(AncfSolveStatic(a, 1));
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  TEST_NEAR(e[49], 0, 1e-12, "straight again without loads");
  TEST_ERROR(AncfAddPointLoad(a, 0, 1.5, F), PETSC_ERR_ARG_OUTOFRANGE, "s = 1.5");
  TEST_ERROR(AncfSetMoment(a, 0, 9, F), PETSC_ERR_ARG_OUTOFRANGE, "node 9");
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Span 1, length 1.5, hardly any bending stiffness: y = a cosh(x/a), sag .5026332616. Pinned ends; starts from a parabola. */
static PetscErrorCode TestCatenary(void)
{
  const PetscInt n = 32;
  const PetscReal L = 1.5, ref = .5026332616;
  AncfBeamSpec s;
  Ancf a;
  PetscReal x[6 * 33], v[6 * 33] = {0}, arc = 0;
  const PetscReal *e;

  PetscFunctionBegin;
  PetscCall(AncfBeamSpecInit(&s));
  s.end[0] = L;
  s.elements = n;
  s.diameter = 0.01;
  s.EA = 1e4;
  s.EI = 1e-4;
  s.rhoA = 1;
  s.end0 = s.end1 = ANCF_END_PIN;
  PetscCall(BeamCreate(&s, -9.81, "", &a));
  for (int j = 0, k = 0; j <= n; j++) { /* nodes at equal arc lengths of a parabola of sag 0.5 */
    PetscReal t = (PetscReal)k / 4000, slope, c;

    while (k < 4000 && arc < 1.4789 * j / n) {
      arc += PetscSqrtReal(1 + PetscSqr(-2 * (1 - 2 * (k + 0.5) / 4000))) / 4000;
      t = (PetscReal)(++k) / 4000;
    }
    if (j == n) t = 1;
    slope = -2 * (1 - 2 * t);
    c = 1 / PetscSqrtReal(1 + slope * slope);
    x[6 * j] = t;
    x[6 * j + 1] = x[6 * j + 4] = 0;
    x[6 * j + 2] = -2 * t * (1 - t);
    x[6 * j + 3] = c;
    x[6 * j + 5] = c * slope;
  }
  PetscCall(AncfSetState(a, 0, x, v));
  PetscCall(AncfSolveStatic(a, 1));
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  printf("catenary: sag %.6f, reference %.6f\n", -e[6 * (n / 2) + 2], ref);
  /* bending rounds the ends over sqrt(EI/T) ~ 4 mm, stretch T/EA = 1e-3 of the length */
  TEST_NEAR(-e[6 * (n / 2) + 2], ref, 2e-3, "sag");
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Seed beam pinned at one end, released from horizontal. */
static PetscErrorCode TestPendulum(void)
{
  const PetscReal dt = 5e-4, *e;
  AncfBeamSpec s;
  Ancf a;
  PetscReal prev = 1, cross = 0;

  PetscFunctionBegin;
  PetscCall(SeedSpec(32, &s));
  s.end0 = ANCF_END_PIN;
  PetscCall(BeamCreate(&s, -9.81, "-ancf_ts_alpha_radius 1", &a));
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  for (int i = 1; i <= 1000; i++) {
    PetscCall(AncfAdvance(a, i * dt));
    if (prev > 0 && e[192] <= 0) cross = (i - 1 + prev / (prev - e[192])) * dt;
    prev = e[192];
  }
  printf("pinned pendulum: x = 0 at %.5f s (reference .46879), t = .5 s: (%.5f, %.5f), reference (-.17060, -.96879)\n", cross,
         e[192], e[194]);
  TEST_REL(cross, .46879, 1e-4, "time of the first crossing"); /* the reference is of another element and step */
  TEST_NEAR(e[192], -.17060, 5e-5, "tip x");
  TEST_NEAR(e[194], -.96879, 5e-5, "tip z");
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Planar chain of N masses, springs EA and hinges EI, pinned at the origin, released from the x-axis: an independent model of
  second order in 1/N, integrated by velocity Verlet. Tip every 0.15 s.
*/
static PetscErrorCode Chain(PetscInt N, PetscReal L, PetscReal EA, PetscReal EI, PetscReal rhoA, PetscInt steps, PetscReal tip[8])
{
  const PetscReal h = L / (PetscReal)N, m = rhoA * h, dt = 0.6 / (PetscReal)steps;
  PetscReal(*x)[2], (*v)[2], (*f)[2], *angle;

  PetscFunctionBegin;
  PetscCall(PetscCalloc4(N + 1, &x, N + 1, &v, N + 1, &f, N, &angle));
  for (PetscInt i = 0; i <= N; i++) x[i][0] = h * (PetscReal)i;
  for (PetscInt k = 0; k <= steps; k++) {
    for (PetscInt i = 0; i <= N; i++) {
      f[i][0] = 0;
      f[i][1] = -9.81 * (i == N ? m / 2 : m);
    }
    for (PetscInt i = 0; i < N; i++) angle[i] = atan2(x[i + 1][1] - x[i][1], x[i + 1][0] - x[i][0]);
    for (PetscInt i = 0; i < N; i++) { /* N along the segment, and the couple of the hinges at its ends across it */
      const PetscReal d[2] = {x[i + 1][0] - x[i][0], x[i + 1][1] - x[i][1]}, a = sqrt(d[0] * d[0] + d[1] * d[1]);
      const PetscReal left = i ? EI / h * remainder(angle[i] - angle[i - 1], 2 * PETSC_PI) : 0;
      const PetscReal right = i < N - 1 ? EI / h * remainder(angle[i + 1] - angle[i], 2 * PETSC_PI) : 0;
      const PetscReal n = EA * (a / h - 1) / a, q = (left - right) / (a * a);

      for (int c = 0; c < 2; c++) {
        const PetscReal p = n * d[c] + q * (c ? d[0] : -d[1]);

        f[i][c] += p;
        f[i + 1][c] -= p;
      }
    }
    for (PetscInt i = 1; i <= N; i++)
      for (int c = 0; c < 2; c++) v[i][c] += (k == 0 || k == steps ? 0.5 : 1) * dt * f[i][c] / (i == N ? m / 2 : m);
    if (k % (steps / 4) == 0 && k > 0) {
      tip[2 * (k / (steps / 4)) - 2] = x[N][0];
      tip[2 * (k / (steps / 4)) - 1] = x[N][1];
    }
    for (PetscInt i = 1; i <= N; i++)
      for (int c = 0; c < 2; c++) x[i][c] += dt * v[i][c];
  }
  PetscCall(PetscFree4(x, v, f, angle));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The falling pendulum of very flexible rubber of Berzeri and Shabana, J. Sound Vib. 235 (2000) 539, Gerstmayr and Shabana 2006:
  L = 1.2 m, A = 0.0018 m^2, I = 1.215e-8 m^4, rho = 5540 kg/m^3, E = 0.7 MPa. Against the chain extrapolated to no spacing;
  what is left of the chain's error is below the last extrapolation step, plus 5e-5 for 32 elements and steps of 5e-4 s.
*/
static PetscErrorCode TestFallingPendulum(void)
{
  const PetscReal E = 0.7e6, A = 0.0018, I2 = 1.215e-8, rho = 5540, dt = 5e-4;
  PetscReal coarse[8], middle[8], fine[8];
  const PetscReal *e;
  AncfBeamSpec s;
  Ancf a;

  PetscFunctionBegin;
  PetscCall(Chain(100, 1.2, E * A, E * I2, rho * A, 8000, coarse));
  PetscCall(Chain(200, 1.2, E * A, E * I2, rho * A, 16000, middle));
  PetscCall(Chain(400, 1.2, E * A, E * I2, rho * A, 32000, fine));
  PetscCall(AncfBeamSpecInit(&s));
  s.end[0] = 1.2;
  s.elements = 32;
  s.diameter = 0.04;
  s.EA = E * A;
  s.EI = E * I2;
  s.rhoA = rho * A;
  s.end0 = ANCF_END_PIN;
  PetscCall(BeamCreate(&s, -9.81, "-ancf_strain engineering", &a));
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  for (int i = 1; i <= 1200; i++) {
    const int k = i / 300 - 1;

    PetscCall(AncfAdvance(a, i * dt));
    if (i % 300) continue;
    printf("falling pendulum, t %.2f s: tip (%.5f, %.5f), chain (%.5f, %.5f), its error %.1e\n", i * dt, e[192], e[194],
           fine[2 * k] + (fine[2 * k] - middle[2 * k]) / 3, fine[2 * k + 1] + (fine[2 * k + 1] - middle[2 * k + 1]) / 3,
           PetscMax(PetscAbsReal(fine[2 * k] - middle[2 * k]), PetscAbsReal(fine[2 * k + 1] - middle[2 * k + 1])));
    for (int c = 0; c < 2; c++) {
      const PetscReal step[2] = {middle[2 * k + c] - coarse[2 * k + c], fine[2 * k + c] - middle[2 * k + c]};

      TEST_NEAR(e[192 + 2 * c], fine[2 * k + c] + step[1] / 3, PetscAbsReal(step[1]) + 5e-5, "tip of the falling pendulum");
      TEST(PetscAbsReal(step[1]) < 1e-3 && PetscAbsReal(step[1]) < PetscAbsReal(step[0]) / 2 + 1e-4,
           "the chain converges: %g after %g", (double)step[1], (double)step[0]);
    }
  }
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The same chain in space, turned about y by 4 rad/s at first, with gravity along -y; tip and middle every 0.1 s up to 0.3 s. */
static PetscErrorCode SpaceChain(PetscInt N, PetscReal EA, PetscReal EI, PetscReal rhoA, PetscInt steps, PetscReal out[18])
{
  const PetscReal h = 1 / (PetscReal)N, m = rhoA * h, dt = 0.3 / (PetscReal)steps;
  PetscReal(*x)[3], (*v)[3], (*f)[3], (*t)[3], *a;

  PetscFunctionBegin;
  PetscCall(PetscCalloc5(N + 1, &x, N + 1, &v, N + 1, &f, N + 2, &t, N + 2, &a));
  for (PetscInt i = 0; i <= N; i++) x[i][0] = h * (PetscReal)i, v[i][2] = -4 * x[i][0];
  for (PetscInt k = 0; k <= steps; k++) {
    for (PetscInt i = 0; i <= N; i++) f[i][0] = f[i][2] = 0, f[i][1] = -9.81 * (i == N ? m / 2 : m);
    for (PetscInt i = 1; i <= N; i++) { /* segments 1 to N; no bending beyond the ends: t of 0 and N + 1 is zero */
      a[i] = 0;
      for (int c = 0; c < 3; c++) t[i][c] = x[i][c] - x[i - 1][c], a[i] += t[i][c] * t[i][c];
      a[i] = sqrt(a[i]);
      for (int c = 0; c < 3; c++) t[i][c] /= a[i];
    }
    for (PetscInt i = 1; i <= N; i++) { /* energies EA h/2 (a/h - 1)^2 and EI/h (1 - t_i . t_(i+1)) */
      PetscReal b[3], along = 0;

      for (int c = 0; c < 3; c++) b[c] = t[i - 1][c] + t[i + 1][c], along += b[c] * t[i][c];
      for (int c = 0; c < 3; c++) {
        const PetscReal p = EA * (a[i] / h - 1) * t[i][c] - EI / h * (b[c] - along * t[i][c]) / a[i];

        f[i - 1][c] += p;
        f[i][c] -= p;
      }
    }
    for (PetscInt i = 1; i <= N; i++)
      for (int c = 0; c < 3; c++) v[i][c] += (k == 0 || k == steps ? 0.5 : 1) * dt * f[i][c] / (i == N ? m / 2 : m);
    if (k % (steps / 3) == 0 && k > 0)
      for (int c = 0; c < 3; c++) out[6 * (3 * k / steps - 1) + c] = x[N][c], out[6 * (3 * k / steps - 1) + 3 + c] = x[N / 2][c];
    for (PetscInt i = 1; i <= N; i++)
      for (int c = 0; c < 3; c++) x[i][c] += dt * v[i][c];
  }
  PetscCall(PetscFree5(x, v, f, t, a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The cable test of Chrono, which is that of Gerstmayr and Shabana 2006 (f = 5: A = 25e-6 m^2, E = 1e9/f^4 Pa, rho = 8000/f^2
  kg/m^3, L = 1 m, pinned, 4 rad/s): motion in space. Chrono compares with itself at 0.02 s and a linearised Euler step; here the
  converged motion up to 0.3 s, against the chain extrapolated to no spacing, with what is left of its error as above.
*/
static PetscErrorCode TestCable(void)
{
  const PetscReal A = 25e-6, E = 1e9 / 625, rho = 320, dt = 2e-4, g[3] = {0, -9.81, 0};
  PetscReal chain[3][18], x[6 * 65], v[6 * 65];
  const PetscReal *e;
  AncfBeamSpec s;
  Ancf a;

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) PetscCall(SpaceChain(100 << k, E * A, E * A * A / (4 * PETSC_PI), rho * A, 6000 << k, chain[k]));
  PetscCall(AncfBeamSpecInit(&s));
  s.end[0] = 1;
  s.elements = 64;
  s.diameter = 2 * PetscSqrtReal(A / PETSC_PI);
  s.density = rho;
  s.young = E;
  s.end0 = ANCF_END_PIN;
  PetscCall(AncfCreate(PETSC_COMM_SELF, &a));
  PetscCall(AncfAddBeam(a, &s, NULL));
  PetscCall(AncfSetGravity(a, g));
  PetscCall(SetUpWith(a, "-ancf_strain engineering", NULL));
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  PetscCall(PetscArraycpy(x, e, 6 * 65));
  PetscCall(PetscArrayzero(v, 6 * 65));
  for (int j = 0; j <= 64; j++) v[6 * j + 2] = -4 * x[6 * j], v[6 * j + 5] = -4;
  PetscCall(AncfSetState(a, 0, x, v));
  for (int i = 1; i <= 1500; i++) {
    const int k = 6 * (i / 500 - 1);

    PetscCall(AncfAdvance(a, i * dt));
    if (i % 500) continue;
    for (int c = 0; c < 6; c++) {
      const PetscReal step[2] = {chain[1][k + c] - chain[0][k + c], chain[2][k + c] - chain[1][k + c]};
      const PetscReal ref = chain[2][k + c] + step[1] / 3, got = e[6 * (c < 3 ? 64 : 32) + c % 3];

      printf("cable, t %.1f s, %s %c: %.5f, chain %.5f, its error %.1e\n", i * dt, c < 3 ? "tip" : "middle", "xyz"[c % 3], got,
             ref, PetscAbsReal(step[1]));
      TEST_NEAR(got, ref, PetscAbsReal(step[1]) + 1e-4, "the cable in space");
      TEST(PetscAbsReal(step[1]) < 2e-3 && PetscAbsReal(step[1]) < PetscAbsReal(step[0]) / 2 + 1e-4,
           "the chain converges: %g after %g", (double)step[1], (double)step[0]);
    }
  }
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Free seed beam spinning at 2 pi rad/s about its centre: m L^2 w^2/24, m L^2 w/12; momenta conserved to round-off. */
static PetscErrorCode TestSpin(void)
{
  AncfBeamSpec s;
  Ancf a;
  PetscReal k, w, p, P[3], H[3], x[54], v[54], E0, H0, E1;
  const PetscReal *e;

  PetscFunctionBegin;
  PetscCall(SeedSpec(8, &s));
  s.end0 = ANCF_END_FREE;
  PetscCall(BeamCreate(&s, 0, "-ancf_ts_alpha_radius 1 -ancf_snes_rtol 1e-13", &a));
  PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
  for (int j = 0; j < 9; j++)
    for (int c = 0; c < 6; c++) {
      x[6 * j + c] = e[6 * j + c];
      v[6 * j + c] = c == 1 ? 2 * PETSC_PI * (e[6 * j] - 0.5) : c == 4 ? 2 * PETSC_PI : 0;
    }
  PetscCall(AncfSetState(a, 0, x, v));
  PetscCall(AncfGetEnergy(a, &k, &w, &p));
  PetscCall(AncfGetMomentum(a, P, H));
  TEST_NEAR(k, 14.883013, 1e-6, "kinetic energy of the spin");
  TEST_NEAR(H[2], 4.737410, 1e-6, "angular momentum of the spin");
  E0 = k + w;
  H0 = H[2];
  for (int i = 1; i <= 1000; i++) PetscCall(AncfAdvance(a, i * 1e-3));
  PetscCall(AncfGetEnergy(a, &k, &w, &p));
  PetscCall(AncfGetMomentum(a, P, H));
  E1 = k + w;
  printf("free spin, one turn: dH/H %.1e, |p| %.1e, dE/E %.1e\n", PetscAbsReal(H[2] / H0 - 1),
         PetscSqrtReal(P[0] * P[0] + P[1] * P[1] + P[2] * P[2]), E1 / E0 - 1);
  TEST_REL(H[2], H0, 1e-12, "angular momentum after a turn");
  for (int c = 0; c < 3; c++) TEST_NEAR(P[c], 0, 1e-12 * 9.05 * PETSC_PI, "linear momentum after a turn");
  /* The start excites axial vibration at 165 rad/s holding 3e-3 of the energy, of which midpoint keeps all but (w dt)^2/12 =
     2e-3; a few times that in higher modes. */
  TEST_REL(E1, E0, 5e-5, "energy after a turn");
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The swing along x, y, z and an oblique axis, with gravity turned alike, gives the same path to 1e-10. */
static PetscErrorCode TestInvariance(void)
{
  static const PetscReal axes[4][2][3] = {{{1, 0, 0}, {0, 0, 1}},
                                          {{0, 1, 0}, {1, 0, 0}},
                                          {{0, 0, 1}, {0, 1, 0}},
                                          {{2. / 3, -1. / 3, 2. / 3}, {1. / 3, -2. / 3, -2. / 3}}};
  PetscReal ref[2] = {0, 0};

  PetscFunctionBegin;
  for (int k = 0; k < 4; k++) {
    PetscReal g[3], u[2] = {0, 0};
    const PetscReal *e;
    AncfBeamSpec s;
    Ancf a;

    PetscCall(SeedSpec(4, &s));
    for (int c = 0; c < 3; c++) {
      s.start[c] = 0;
      s.end[c] = axes[k][0][c];
      g[c] = -9.81 * axes[k][1][c];
    }
    PetscCall(AncfCreate(PETSC_COMM_SELF, &a));
    PetscCall(AncfAddBeam(a, &s, NULL));
    PetscCall(AncfSetGravity(a, g));
    PetscCall(AncfSetUp(a));
    for (int i = 1; i <= 400; i++) PetscCall(AncfAdvance(a, i * 1e-3));
    PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
    for (int c = 0; c < 3; c++) {
      u[0] += e[24 + c] * axes[k][0][c];
      u[1] += e[24 + c] * axes[k][1][c];
    }
    if (!k) PetscCall(PetscArraycpy(ref, u, 2));
    printf("axis (%.3f, %.3f, %.3f): tip (%.12f, %.12f)\n", axes[k][0][0], axes[k][0][1], axes[k][0][2], u[0], u[1]);
    TEST_NEAR(u[0], ref[0], 1e-10, "tip along the axis");
    TEST_NEAR(u[1], ref[1], 1e-10, "tip across the axis");
    PetscCall(AncfDestroy(&a));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TestElastica());
  PetscCall(TestLargeCantilever());
  PetscCall(TestRollUp(PETSC_TRUE));
  PetscCall(TestRollUp(PETSC_FALSE));
  PetscCall(TestSelfWeight());
  PetscCall(TestPointLoad());
  PetscCall(TestCatenary());
  PetscCall(TestPendulum());
  PetscCall(TestFallingPendulum());
  PetscCall(TestCable());
  PetscCall(TestSpin());
  PetscCall(TestInvariance());
  PetscCall(PetscFinalize());
  return test_report();
}
