/*
  test_sph_gradient.c - kernel gradient correction: exact for linear fields on a disordered set of markers; against a sum by brute
  force with boundary markers, periodic sides, both precisions; the momentum that it costs.

  Exactness. Markers shaken by up to 0.2 dp, p = g.x, v = A x: dv/dt = -g/rho and d(rho/rho0)/dt = -(rho/rho0) tr A to round-off:
  60 terms of p/h over g, p at most 1.5 g: 1e-12 of g or A; 1e-10 is allowed. Without the correction errors are of the order of
  the disorder, some percent. Brute force. The bound is (n + 100) u times the sum of the terms' sizes, times the condition of M,
  for a sum that is multiplied by its inverse; sizes hold the room for rounded positions of sphbrute.h.
*/
#include "sphbrute.h"
#include "testerror.h"

static const char help[] = "Kernel gradient correction.\n";

typedef struct {
  PetscInt dim;
  SphKernelType kernel;
  SphWallType wall;
  SphPrecision precision;
  PetscBool linear, periodic; /* linear fields in an open box, or random ones with a wall below */
} Case;

static PetscReal Shake(PetscInt i)
{
  const PetscReal s = PetscSinReal(12.9898 * (PetscReal)(i + 1)) * 43758.5453;
  return s - PetscFloorReal(s) - 0.5;
}

static const PetscReal gradient[3] = {300.0, -200.0, 100.0};
static const PetscReal A[9] = {0.3, -0.2, 0.1, 0.5, 0.4, -0.3, 0.2, -0.1, 0.25};

#define DP 0.05

/* The set-up fluid: a box of 12 to 20 spacings, on a wall of four layers unless linear. */
static PetscErrorCode Make(const Case *c, SphGradientType type, Sph *out)
{
  const PetscInt n[3] = {c->dim == 2 ? 20 : 14, c->dim == 2 ? 20 : 12, c->dim == 2 ? 1 : 12}, layers = c->linear ? 0 : 4;
  const PetscReal hi[3] = {DP * (PetscReal)n[0], DP * (PetscReal)n[1], DP * (PetscReal)n[2]}, lo[3] = {0, 0, 0};
  const PetscBool periodic[3] = {c->periodic, PETSC_FALSE, PETSC_FALSE};
  const PetscInt total = n[0] * (n[1] + layers) * n[2];
  PetscReal *x, *v, *p, *volume, *depth;
  PetscInt m = 0, nf, group;
  Sph sph;

  PetscFunctionBegin;
  PetscCall(SphCreate(PETSC_COMM_SELF, &sph));
  PetscCall(SphSetType(sph, SPHCPU));
  PetscCall(SphSetDimension(sph, c->dim));
  PetscCall(SphSetSpacing(sph, DP));
  PetscCall(SphSetSmoothingRatio(sph, 1.3));
  PetscCall(SphSetDensity(sph, 1000.0));
  PetscCall(SphSetViscosity(sph, 1.0));
  PetscCall(SphSetMaxSpeed(sph, 1.0));
  PetscCall(SphSetXSPH(sph, 0.0));
  PetscCall(SphSetKernel(sph, c->kernel));
  PetscCall(SphSetWall(sph, c->wall));
  PetscCall(SphSetPrecision(sph, c->precision));
  PetscCall(SphSetLatticeNormalisation(sph, PETSC_FALSE));
  PetscCall(SphSetDomain(sph, lo, hi));
  PetscCall(SphSetPeriodic(sph, periodic));
  PetscCall(SphSetGradientCorrection(sph, type));
  PetscCall(SphSetShifting(sph, SPH_SHIFTING_SUN, 0.0)); /* asked for, and without effect on the rates */
  if (c->linear) PetscCall(SphSetViscosity(sph, 1e-12));
  PetscCall(PetscMalloc5(3 * (size_t)total, &x, 3 * (size_t)total, &v, total, &p, total, &volume, total, &depth));
  for (PetscInt j = 0; j < n[1] + layers; j++) /* the wall's come last */
    for (PetscInt k = 0; k < n[2]; k++)
      for (PetscInt i = 0; i < n[0]; i++, m++) {
        const PetscReal site[3] = {(PetscReal)i + 0.5, j < n[1] ? (PetscReal)j + 0.5 : (PetscReal)(n[1] - j) - 0.5,
                                   (PetscReal)k + 0.5};
        for (int a = 0; a < 3; a++) x[3 * m + a] = a < c->dim ? DP * (site[a] + (j < n[1] ? 0.4 * Shake(3 * m + a) : 0)) : 0;
        p[m] = c->linear ? 0 : 2000 * Shake(7 * m);
        volume[m] = PetscPowReal(DP, (PetscReal)c->dim);
        depth[m] = -x[3 * m + 1];
        for (int a = 0; a < 3; a++) {
          v[3 * m + a] = c->linear || a >= c->dim ? 0 : Shake(5 * m + a);
          for (int b = 0; b < c->dim && c->linear && a < c->dim; b++) v[3 * m + a] += A[3 * a + b] * x[3 * m + b];
          if (c->linear && a < c->dim) p[m] += gradient[a] * x[3 * m + a];
        }
      }
  nf = n[0] * n[1] * n[2];
  PetscCall(SphAddFluid(sph, nf, x, v, p));
  if (layers) PetscCall(SphAddBoundary(sph, total - nf, x + 3 * nf, v + 3 * nf, volume + nf, depth + nf, &group));
  PetscCall(SphSetUp(sph));
  PetscCall(PetscFree5(x, v, p, volume, depth));
  *out = sph;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Largest errors of interior markers against the exact rates, relative to g/rho and tr A; counts them. */
static PetscErrorCode Errors(const Case *c, SphGradientType type, PetscReal *ea, PetscReal *ed, PetscInt *inside)
{
  PetscReal trace = 0, size = 0;
  Sph sph;

  PetscFunctionBegin;
  PetscCall(Make(c, type, &sph));
  for (int k = 0; k < c->dim; k++) trace += A[4 * k], size += gradient[k] * gradient[k];
  *ea = *ed = 0;
  *inside = 0;
  for (PetscInt i = 0; i < sph->n; i++) {
    const PetscReal r = 1.0 + sph->st.s[i];
    PetscBool in = PETSC_TRUE;
    for (int k = 0; k < c->dim; k++)
      in = (PetscBool)(in && sph->st.x[k][i] > 2 * sph->par.h && sph->st.x[k][i] < sph->par.hi[k] - 2 * sph->par.h);
    if (!in) continue;
    (*inside)++;
    for (int k = 0; k < c->dim; k++)
      *ea = PetscMax(*ea, PetscAbsReal(SphValue(&sph->rate.a[k], i) * 1000.0 * r + gradient[k]) / PetscSqrtReal(size));
    *ed = PetscMax(*ed, PetscAbsReal(SphValue(&sph->rate.ds, i) / r + trace) / trace);
  }
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestExact(PetscInt dim, SphKernelType kernel)
{
  const Case c = {dim, kernel, SPH_WALL_ADAMI, SPH_PRECISION_DOUBLE, PETSC_TRUE, PETSC_FALSE};
  PetscReal ea[2], ed[2];
  PetscInt n;

  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) PetscCall(Errors(&c, k ? SPH_GRADIENT_BONET : SPH_GRADIENT_NONE, &ea[k], &ed[k], &n));
  printf("%dD, kernel %d, %d markers: largest error of grad p %.2g, corrected %.1e; of div v %.2g, corrected %.1e\n", (int)dim,
         (int)kernel, (int)n, (double)ea[0], (double)ea[1], (double)ed[0], (double)ed[1]);
  TEST(n > 100, "%d markers", (int)n);
  TEST(ea[0] > 0.01 && ed[0] > 0.01, "not disordered: %g, %g", (double)ea[0], (double)ed[0]);
  TEST(ea[1] < 1e-10, "pressure gradient: %g", (double)ea[1]);
  TEST(ed[1] < 1e-10, "divergence: %g", (double)ed[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solve M y = b by elimination with pivots, n <= 3; false when M is singular. */
static int Solve(int n, const double M[9], const double b[3], double y[3])
{
  double a[3][4];
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++) a[i][j] = M[3 * i + j];
    a[i][n] = b[i];
  }
  for (int k = 0; k < n; k++) {
    int best = k;
    for (int i = k + 1; i < n; i++)
      if (fabs(a[i][k]) > fabs(a[best][k])) best = i;
    for (int j = 0; j <= n; j++) {
      const double t = a[k][j];
      a[k][j] = a[best][j];
      a[best][j] = t;
    }
    if (a[k][k] == 0.0) return 0;
    for (int i = k + 1; i < n; i++)
      for (int j = n; j >= k; j--) a[i][j] -= a[i][k] / a[k][k] * a[k][j];
  }
  for (int i = n - 1; i >= 0; i--) {
    y[i] = a[i][n];
    for (int j = i + 1; j < n; j++) y[i] -= a[i][j] * y[j];
    y[i] /= a[i][i];
  }
  return 1;
}

/* The correction of marker i of dv/dt and of d(rho/rho0)/dt, and bounds of their errors for unit round-off u. */
static int BruteCorrection(Sph sph, PetscInt i, double u, double a[3], double *ds, double *ba, double *bd)
{
  const SphParams *p = &sph->par;
  const int dim = (int)p->dim;
  double M[9] = {0}, G[3] = {0}, S[3] = {0}, T[9] = {0}, sizeM = 0, sizeG = 0, sizeS = 0, sizeT = 0, trace = 0, inverse = 0, keep;
  double y[3], norm = 0;
  const double ri = p->rho0 * (1 + sph->st.s[i]), pi = BrutePressure(p, sph->st.s[i]);
  int n = 0;

  for (PetscInt j = 0; j < sph->n; j++)
    for (int image = -1; image <= 1; image++) {
      const double rj = p->rho0 * (1 + sph->st.s[j]), pj = BrutePressure(p, sph->st.s[j]), V = sph->m[j] / rj;
      double d[3] = {0}, r = 0, dv[3] = {0}, speed = 0;
      if (image && !p->periodic[0]) continue;
      for (int k = 0; k < dim; k++) {
        d[k] = sph->st.x[k][i] - sph->st.x[k][j] - (k ? 0 : image * (p->hi[0] - p->lo[0]));
        dv[k] = sph->st.v[k][j] - sph->st.v[k][i];
        r += d[k] * d[k];
        speed += fabs(sph->st.v[k][j]) + fabs(sph->st.v[k][i]);
      }
      r = sqrt(r);
      if (r >= 2 * p->h || r == 0) continue;
      const double dW = BruteDW(p->kernel, dim, p->h, r), C = BruteCapDW(p, r);
      n++;
      for (int k = 0; k < dim; k++) {
        G[k] += V * (pj - pi) * dW * d[k] / r;
        S[k] -= sph->m[j] * (pi / (ri * ri) + pj / (rj * rj)) * dW * d[k] / r;
        for (int l = 0; l < dim; l++) {
          M[3 * k + l] -= V * dW * d[k] * d[l] / r;
          T[3 * k + l] += V * dv[k] * dW * d[l] / r;
        }
      }
      sizeM += V * C * r;
      sizeG += V * (fabs(pj) + fabs(pi)) * C;
      sizeS += sph->m[j] * (fabs(pi) / (ri * ri) + fabs(pj) / (rj * rj)) * C;
      sizeT += V * speed * C;
    }
  for (int k = 0; k < dim; k++) trace += M[4 * k];
  keep = fmin(1, fmax(0, (trace / dim - 0.7) / 0.1));
  a[0] = a[1] = a[2] = *ds = 0;
  for (int k = 0; k < dim; k++) { /* |L| by its columns */
    const double e[3] = {k == 0, k == 1, k == 2};
    if (!Solve(dim, M, e, y)) return 0;
    for (int l = 0; l < dim; l++) inverse = fmax(inverse, fabs(y[l]) * dim);
  }
  (void)Solve(dim, M, G, y);
  for (int k = 0; k < dim; k++) a[k] = keep * (-y[k] / ri - S[k]), norm += fabs(a[k] / (keep > 0 ? keep : 1));
  for (int k = 0; k < dim; k++) {
    (void)Solve(dim, M, T + 3 * k, y); /* M is symmetric: row k of T L is (L T_k)^T */
    *ds += keep * (1 + sph->st.s[i]) * (-y[k] + T[4 * k]);
  }
  { /* of keep: its slope is 10 of trace/dim */
    const double cond = 1 + inverse * sizeM, e = (n + 100) * u;
    *ba = e * (cond * (inverse * sizeG / ri + sizeS) + norm * sizeM / 0.1 + sizeS);
    *bd = e * (cond * (inverse + 1) * sizeT * dim * (1 + sizeM / 0.1));
  }
  return 1;
}

static PetscErrorCode TestBrute(const Case *c)
{
  const double u = c->precision == SPH_PRECISION_SINGLE ? 5.9604644775390625e-8 : 1.1102230246251565e-16;
  double worst = 0, largest = 0;
  PetscInt corrected = 0, left = 0;
  Sph plain, sph;

  PetscFunctionBegin;
  PetscCall(Make(c, SPH_GRADIENT_NONE, &plain));
  PetscCall(Make(c, SPH_GRADIENT_BONET, &sph));
  for (PetscInt i = 0; i < sph->n; i++) { /* both are sorted alike */
    double a[3], ds, ba, bd;
    PetscCheck(sph->id[i] == plain->id[i], PETSC_COMM_SELF, PETSC_ERR_PLIB, "sorted otherwise");
    if (sph->group[i] != -1) {
      for (int k = 0; k < 3; k++)
        TEST(SphValue(&sph->rate.a[k], i) == SphValue(&plain->rate.a[k], i), "a boundary marker's force has changed");
      continue;
    }
    if (!BruteCorrection(sph, i, u, a, &ds, &ba, &bd)) continue;
    if (a[0] != 0)
      corrected++;
    else
      left++;
    for (int k = 0; k < 3; k++) {
      const double e = fabs(SphValue(&sph->rate.a[k], i) - SphValue(&plain->rate.a[k], i) - a[k]);
      worst = fmax(worst, e / ba);
      largest = fmax(largest, fabs(a[k]));
      TEST(e <= ba, "marker %d: correction of the acceleration off by %g, bound %g", (int)i, e, ba);
    }
    TEST_NEAR(SphValue(&sph->rate.ds, i) - SphValue(&plain->rate.ds, i), ds, bd, "correction of the density's rate");
  }
  printf("%dD, kernel %d, wall %d, precision %d: %d markers corrected (by up to %.3g m/s^2), %d at surfaces not; %.3f of the "
         "bound\n",
         (int)c->dim, (int)c->kernel, (int)c->wall, (int)c->precision, (int)corrected, largest, (int)left, worst);
  TEST(corrected > 100 && left > 10, "%d corrected, %d not", (int)corrected, (int)left);
  PetscCall(SphDestroy(&plain));
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestRefused(void)
{
  const PetscReal x[3] = {0.5, 0.5, 0};
  Sph sph;

  PetscFunctionBegin;
  PetscCall(SphCreate(PETSC_COMM_SELF, &sph));
  PetscCall(SphSetDimension(sph, 2));
  PetscCall(SphSetSpacing(sph, 0.1));
  PetscCall(SphSetDensity(sph, 1.0));
  PetscCall(SphSetMaxSpeed(sph, 1.0));
  PetscCall(SphSetDomain(sph, (const PetscReal[3]){0, 0, 0}, (const PetscReal[3]){1, 1, 0}));
  PetscCall(SphAddFluid(sph, 1, x, NULL, NULL));
  PetscCall(SphSetGradientCorrection(sph, SPH_GRADIENT_BONET));
  TEST_REFUSED(SphSetUp(sph), "sph_gradient_correction = bonet: needs sph_shifting sun");
  PetscCall(SphSetShifting(sph, SPH_SHIFTING_SUN, 1.0));
  PetscCall(SphSetUp(sph));
  TEST_REFUSED(SphSetGradientCorrection(sph, SPH_GRADIENT_NONE), "gradient_correction");
  PetscCall(SphDestroy(&sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, help));
  for (PetscInt dim = 2; dim <= 3; dim++)
    for (int kernel = 0; kernel < 2; kernel++) {
      PetscCall(TestExact(dim, (SphKernelType)kernel));
      for (int wall = 0; wall < 2; wall++) {
        const Case c = {dim,         (SphKernelType)kernel,      (SphWallType)wall, (SphPrecision)((kernel + wall) % 2),
                        PETSC_FALSE, (PetscBool)(wall == kernel)};
        PetscCall(TestBrute(&c));
      }
    }
  PetscCall(TestRefused());
  PetscCall(PetscFinalize());
  return test_report();
}
