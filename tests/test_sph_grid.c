/*
  test_sph_grid.c - fields of the fluid at points against sums over all markers and against the fields that the markers were
  given.

  The markers are a lattice shaken by a quarter of a spacing. Shepard's mean must equal the plain sum over all markers and their
  periodic images (round-off of some 60 terms: 1e-12 relative). The linear fit must give linear fields back at any point, at walls
  and outside them too: to round-off times the condition of the moment matrix, whose smallest pivot allowed is 0.005 of the
  largest: 1e-11. A quadratic profile u = 4 y (1 - y) through a plane: the midpoint rule misses 2/3 by dp^2/3 (second derivative
  -8: -f'' dp^2/24), and the fit misses u by |u''|/2 times the mean square distance of its markers, at most (2h)^2/2 for the
  weight of the kernel: 4 (0.5 h)^2 is the mean for the cubic spline in 2D, so 2 h^2 + dp^2/3 bounds the flow.
*/
#include "sphcase.h"

typedef struct {
  Sph sph;
  PetscInt n;
  PetscReal *x, *v, *rho, *p;
  PetscReal dp, h, L;
} Cloud;

static PetscReal Shake(PetscInt i)
{
  const PetscReal s = PetscSinReal(12.9898 * (PetscReal)(i + 1)) * 43758.5453;
  return s - PetscFloorReal(s) - 0.5;
}

/* A box [0, 1]^dim (x periodic) of shaken markers with v and rho as `set` says. */
static PetscErrorCode CloudCreate(PetscInt dim, PetscReal length,
                                  void (*set)(const PetscReal x[3], PetscReal v[3], PetscReal *rho), Cloud *c)
{
  FlowCase f = {
      .dim = dim, .dp = 0.05, .hi = {length, 1, 1}, .periodic = {1, 0, 0}, .rho = 1000, .vmax = 1, .hratio = 1.3, .xsph = -1};
  PetscInt n;

  PetscFunctionBegin;
  if (dim == 3) f.hi[1] = f.hi[2] = 0.6;
  PetscCall(FlowFluid(&f, &c->sph));
  PetscCall(SphSetUp(c->sph));
  PetscCall(SphGetCounts(c->sph, &n, NULL, NULL));
  c->n = n;
  c->dp = f.dp;
  c->h = 1.3 * f.dp;
  c->L = length;
  PetscCall(PetscMalloc4(3 * (size_t)n, &c->x, 3 * (size_t)n, &c->v, n, &c->rho, n, &c->p));
  PetscCall(SphGetFields(c->sph, &(SphFields){.x = c->x}));
  for (PetscInt i = 0; i < n; i++) {
    for (int k = 0; k < dim; k++) c->x[3 * i + k] += 0.5 * f.dp * Shake(3 * i + k);
    c->v[3 * i + 2] = 0.0;
    set(c->x + 3 * i, c->v + 3 * i, &c->rho[i]);
  }
  PetscCall(SphSetFields(c->sph, &(SphFields){.x = c->x, .v = c->v, .rho = c->rho}));
  PetscCall(SphGetFields(c->sph, &(SphFields){.p = c->p}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CloudDestroy(Cloud *c)
{
  PetscFunctionBegin;
  PetscCall(PetscFree4(c->x, c->v, c->rho, c->p));
  PetscCall(SphDestroy(&c->sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Wavy(const PetscReal x[3], PetscReal v[3], PetscReal *rho)
{
  v[0] = PetscSinReal(7.0 * x[1]);
  v[1] = x[0] * x[0];
  *rho = 1000.0 * (1.0 + 0.01 * PetscCosReal(5.0 * x[1]));
}

static void Linear(const PetscReal x[3], PetscReal v[3], PetscReal *rho)
{
  v[0] = 0.3 + 2.0 * x[1] - x[2];
  v[1] = -0.7 * x[1];
  v[2] = x[2];
  *rho = 1000.0 + 8.0 * x[1];
}

static void Parabola(const PetscReal x[3], PetscReal v[3], PetscReal *rho)
{
  v[0] = 4.0 * x[1] * (1.0 - x[1]);
  v[1] = 0.0;
  *rho = 1000.0;
}

/* Cubic spline, the paper, Eq. 1, written out. */
static double Spline(double q)
{
  if (q < 1.0) return (2.0 - q) * (2.0 - q) * (2.0 - q) - 4.0 * (1.0 - q) * (1.0 - q) * (1.0 - q);
  return q < 2.0 ? (2.0 - q) * (2.0 - q) * (2.0 - q) : 0.0;
}

static void Brute(const Cloud *c, PetscInt dim, const PetscReal x[3], double out[3])
{
  const double V = pow((double)c->dp, (double)dim);
  double sw = 0.0;

  out[0] = out[1] = out[2] = 0.0;
  for (PetscInt i = 0; i < c->n; i++)
    for (int image = -40; image <= 40; image++) {
      double r2 = 0.0;
      for (int k = 0; k < dim; k++) r2 += PetscSqr(x[k] - c->x[3 * i + k] - (k == 0 ? image * c->L : 0.0));
      const double w = Spline(sqrt(r2) / c->h) * V * 1000.0 / c->rho[i];
      sw += w;
      out[0] += w * c->v[3 * i];
      out[1] += w * c->v[3 * i + 1];
      out[2] += w * c->p[i];
    }
  for (int k = 0; k < 3; k++) out[k] /= sw;
}

static PetscErrorCode TestShepard(PetscInt dim, PetscReal length)
{
  const PetscReal x[15] = {0.02, 0.5, 0.3, 0.11, 0.03, 0.02, -2.3, 0.31, 0.4, 4.99, 0.55, 0.1, 0.149, 0.7, 0.2};
  PetscReal v[15], p[5], top = 0.0;
  double ref[3];
  Cloud c;

  PetscFunctionBegin;
  PetscCall(CloudCreate(dim, length, Wavy, &c));
  PetscCall(SphSample(c.sph, 5, x, v, p));
  for (PetscInt i = 0; i < c.n; i++) top = PetscMax(top, PetscAbsReal(c.p[i]));
  for (int j = 0; j < 5; j++) {
    Brute(&c, dim, x + 3 * j, ref);
    if (dim == 3 && j == 4) continue; /* above the box */
    TEST_NEAR(v[3 * j], ref[0], 1e-12, "Shepard, v_x");
    TEST_NEAR(v[3 * j + 1], ref[1], 1e-12, "Shepard, v_y");
    TEST_NEAR(p[j], ref[2], 1e-11 * (double)top, "Shepard, p");
  }
  PetscCall(CloudDestroy(&c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestLinear(PetscInt dim)
{
  PetscReal x[3 * 40], v[3 * 40], rho[40], fraction[40];
  Cloud c;

  PetscFunctionBegin;
  PetscCall(CloudCreate(dim, 1.0, Linear, &c));
  for (int j = 0; j < 40; j++) {
    x[3 * j] = 1.7 * Shake(j);
    x[3 * j + 1] = j < 20 ? -0.03 + 0.66 / 20.0 * j : 0.3 + 0.2 * Shake(100 + j);
    x[3 * j + 2] = dim == 3 ? 0.3 + 0.66 * Shake(200 + j) : 0.0;
  }
  PetscCall(SphInterpolate(c.sph, SPH_INTERPOLATE_LINEAR, 40, x, &(SphPoints){v, NULL, rho, fraction}));
  for (int j = 0; j < 40; j++) {
    TEST_NEAR(v[3 * j], 0.3 + 2.0 * x[3 * j + 1] - x[3 * j + 2], 1e-11, "linear fit, v_x");
    TEST_NEAR(v[3 * j + 1], -0.7 * x[3 * j + 1], 1e-11, "linear fit, v_y");
    TEST_NEAR(rho[j], 1000.0 + 8.0 * x[3 * j + 1], 1e-8, "linear fit, rho");
    TEST(fraction[j] > 0.0 && fraction[j] < 1.3, "kernel sum %g", (double)fraction[j]);
  }
  /* far away there is nothing; on the line of the surface about half */
  const PetscReal far[6] = {0.5, 7.0, 0.3, 0.5, 0.0, 0.3};
  PetscCall(SphInterpolate(c.sph, SPH_INTERPOLATE_LINEAR, 2, far, &(SphPoints){v, NULL, NULL, fraction}));
  TEST(fraction[0] == 0.0 && isnan((double)v[0]), "a dry point: fraction %g, v %g", (double)fraction[0], (double)v[0]);
  TEST_NEAR(fraction[1], 0.5, 0.1, "kernel sum at the surface");
  PetscCall(CloudDestroy(&c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestPlane(PetscInt dim)
{
  const PetscReal corner[3] = {0.31, 0, 0}, up[3] = {0, 1, 0}, down[3] = {0, -1, 0}, top[3] = {0.31, 1, 0}, half[3] = {0, 0.6, 0};
  const PetscReal deep[3] = {0, 0, 0.6};
  Cloud c;
  SphPlane a, b;

  PetscFunctionBegin;
  PetscCall(CloudCreate(dim, 1.0, dim == 2 ? Parabola : Linear, &c));
  if (dim == 2) {
    PetscCall(SphGetPlane(c.sph, corner, up, NULL, &a));
    PetscCall(SphGetPlane(c.sph, top, down, NULL, &b));
    printf("flow of a parabola: %.6f, exact %.6f; h^2 %.6f\n", (double)a.volume, 2.0 / 3.0, (double)(c.h * c.h));
    TEST_NEAR(a.volume, 2.0 / 3.0, 2.0 * c.h * c.h + c.dp * c.dp / 3.0, "flow of a parabola");
    TEST_NEAR(b.volume, -a.volume, 1e-12, "flow, edge turned round");
    TEST_NEAR(a.area, 1.0, 1e-12, "wetted length");
    TEST_REL(a.mass, 1000.0 * a.volume, 1e-12, "mass flow");
  } else { /* linear: midpoints are exact; 0.3 + 2 * 0.3 - 0.3 over 0.36 */
    PetscCall(SphGetPlane(c.sph, corner, half, deep, &a));
    PetscCall(SphGetPlane(c.sph, corner, deep, half, &b));
    TEST_NEAR(a.volume, 0.6 * 0.36, 1e-11, "flow of a linear profile");
    TEST_NEAR(b.volume, -a.volume, 1e-12, "flow, edges exchanged");
    TEST_NEAR(a.area, 0.36, 1e-12, "wetted area");
  }
  PetscCall(CloudDestroy(&c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(TestShepard(2, 1.0));
  PetscCall(TestShepard(2, 0.15)); /* a period of 2.3 h: every marker is seen with its images */
  PetscCall(TestShepard(3, 0.3));
  PetscCall(TestLinear(2));
  PetscCall(TestLinear(3));
  PetscCall(TestPlane(2));
  PetscCall(TestPlane(3));
  PetscCall(PetscFinalize());
  return test_report();
}
