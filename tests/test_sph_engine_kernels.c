/*
  test_sph_engine_kernels.c - smoothing kernels, their lattice normalisation and the equation of state against quadrature,
  differences and exact forms.

  Kernels: composite Simpson over q in [0,2] with n intervals, error of order n^-4 times a fourth derivative of at most 400: 1e-10
  for n = 2000 with a knot of the cubic spline (q = 1) on a node. F = (dW/dr)/r: central differences with step 1e-5 have an error
  of order 1e-10 relative.
*/
#include <float.h>
#include <math.h>
typedef double sphreal;
#include "sph_cuda/sphimpl.h"
#include "sph_cuda/sphpair.h"
#include "testing.h"

static void Integral(int kernel, int dim)
{
  const int n = 2000;
  const double h = 0.37, dq = 2.0 / n, norm = sph_norm(kernel, dim, h);
  double sum = 0.0;
  for (int i = 0; i <= n; i++) {
    const double q = i * dq, shell = dim == 2 ? 2.0 * M_PI * q * h * h : 4.0 * M_PI * q * q * h * h * h;
    sum += (i == 0 || i == n ? 1.0 : (i % 2 ? 4.0 : 2.0)) * norm * sph_w(kernel, q) * shell;
  }
  TEST_NEAR(sum * dq / 3.0, 1.0, 1e-10, "integral of W over its support");
}

static void Gradient(int kernel, int dim)
{
  const double h = 0.37, norm = sph_norm(kernel, dim, h), e = 1e-5;
  double worst = 0.0, worstsign = -1.0;
  for (double q = 0.0137; q < 2.0; q += 0.0271) {
    const double F = norm / (h * h) * sph_f(kernel, q),
                 dWdr = norm * (sph_w(kernel, q + e) - sph_w(kernel, q - e)) / (2.0 * e * h);
    worst = fmax(worst, fabs(F * q * h - dWdr) / (norm / h));
    worstsign = fmax(worstsign, F);
  }
  TEST(worst < 1e-8, "kernel %d in %dD: F r differs from dW/dr by %g of norm/h", kernel, dim, worst);
  TEST(worstsign <= 0.0, "kernel %d: F must not be positive, got %g", kernel, worstsign);
  TEST(sph_w(kernel, 2.0) == 0.0 && sph_w(kernel, 2.5) == 0.0 && sph_f(kernel, 2.0) == 0.0 && sph_f(kernel, 7.0) == 0.0,
       "kernel %d must vanish from q = 2 on", kernel);
}

/* On the undisturbed lattice the normalised sums are exact: sum V W = 1, gradient of a linear field, and Eq. 6 of a quadratic
 * one. */
static void Lattice(int kernel, int dim, double ratio)
{
  SphParams p = {.dim = dim, .dp = 0.02, .h = ratio * 0.02, .kernel = kernel, .mu = 3.0, .epsilon = 0.01, .lattice = PETSC_TRUE};
  const int reach = (int)(2.0 * ratio) + 1, nz = dim == 3 ? reach : 0;
  double w = 0.0, grad = 0.0, visc = 0.0;
  SphLattice(&p);
  for (int i = -reach; i <= reach; i++)
    for (int j = -reach; j <= reach; j++)
      for (int k = -nz; k <= nz; k++) {
        const double x = i * p.dp, r2 = (i * i + j * j + k * k) * p.dp * p.dp, q = sqrt(r2) / p.h, V = pow(p.dp, dim);
        w += V * p.wnorm * sph_w(kernel, q);
        grad -= V * p.fnorm * sph_f(kernel, q) * x * x; /* sum V (u_b - u_a) dW/dx, u = x */
        visc -=
            V * p.fnorm * sph_f(kernel, q) * x * x * r2 / (r2 + 0.01 * p.h * p.h) * p.mupair / p.mu; /* Eq. 6 with u = x^2/2 */
      }
  TEST_NEAR(w, 1.0, 1e-13, "lattice sum of W");
  TEST_NEAR(grad, 1.0, 1e-13, "lattice gradient of a linear field");
  TEST_NEAR(visc, 1.0, 1e-13, "lattice Laplacian of a quadratic field");
}

static void EquationOfState(void)
{
  const double B = 1.7e5;
  double worst = 0.0, inverse = 0.0, slope = 0.0;
  for (int g = 0; g < 3; g++) {
    const double gamma = g == 0 ? 7.0 : (g == 1 ? 1.0 : 3.3);
    for (double s = -0.3; s < 0.3; s += 0.00717) {
      const long double p = (long double)B * (powl(1.0L + (long double)s, (long double)gamma) - 1.0L);
      worst = fmax(worst, fabs((double)(p - (long double)sph_eos(s, B, gamma))) / (double)fabsl(p));
      inverse = fmax(inverse, fabs(sph_eos_inverse(sph_eos(s, B, gamma), B, gamma) - s) / fabs(s));
    }
    slope = fmax(slope, fabs(sph_eos(1e-12, B, gamma) / (B * gamma * 1e-12) -
                             1.0)); /* c_s^2 = dp/drho at rho0, without loss for small s */
  }
  TEST(worst < 64 * DBL_EPSILON, "Eq. 7 differs from B((1+s)^gamma - 1) by %g relative",
       worst); /* 12 operations; powl keeps its own digits */
  TEST(inverse < 256 * DBL_EPSILON, "the inverse of Eq. 7 returns s with a relative error %g",
       inverse);                                                      /* (1+s)^gamma amplifies by up to gamma/(...) = 12 */
  TEST(slope < 1e-11, "the slope of Eq. 7 at rho0 is %g off", slope); /* (gamma-1) s/2 = 3e-12 */
}

/* The linear hydrostatic density difference of sph_diffusion() against Eq. 7: relative error (gamma-1)/2 g z/c^2 to leading
 * order. */
static void Hydrostatic(void)
{
  const double c = 34.3, gamma = 7.0, g = 9.81, B = c * c * 1000.0 / gamma;
  for (double z = 0.001; z < 0.1; z *= 3.0) {
    const double exact = sph_eos_inverse(1000.0 * g * z, B, gamma), linear = g * z / (c * c);
    TEST(fabs(linear - exact) / exact < 0.51 * (gamma - 1.0) * g * z / (c * c) + 1e-12,
         "hydrostatic difference over %g m: linear %g, exact %g", z, linear, exact);
  }
}

int main(int argc, char **argv)
{
  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  for (int kernel = 0; kernel < 2; kernel++)
    for (int dim = 2; dim <= 3; dim++) {
      Integral(kernel, dim);
      Gradient(kernel, dim);
      Lattice(kernel, dim, 1.2);
      Lattice(kernel, dim, 1.7320508);
    }
  EquationOfState();
  Hydrostatic();
  PetscCall(PetscFinalize());
  return test_report();
}
