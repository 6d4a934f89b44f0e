/*
  sphkernel.h - smoothing kernels W(q,h) and their gradients, for host and device, in the precision `sphreal`.

  W      = norm * sph_w(q)                              (1/m^dim)
  grad_a W_ab = x_ab * F,  F = norm/h^2 * sph_f(q) <= 0 (1/m^(dim+2))
  with q = |x_ab|/h in [0,2). Cubic spline: the paper, Eq. 1; 2D normalisation: Monaghan, Rep. Prog. Phys. 68 (2005).
  Wendland C2: Wendland, Adv. Comput. Math. 4 (1995). Include with `sphreal` defined to float or double.
*/
#ifndef SPHKERNEL_H
#define SPHKERNEL_H

#if defined(__CUDACC__)
  #define SPH_INLINE static __host__ __device__ __forceinline__
#elif defined(__GNUC__)
  #define SPH_INLINE static inline __attribute__((always_inline, unused))
#else
  #define SPH_INLINE static inline
#endif

#define SPH_PI 3.14159265358979323846

/* W(0..2) without norm. */
SPH_INLINE sphreal sph_w_cubic(sphreal q)
{
  const sphreal a = q < (sphreal)2 ? (sphreal)2 - q : (sphreal)0;
  const sphreal b = q < (sphreal)1 ? (sphreal)1 - q : (sphreal)0;
  return a * a * a - (sphreal)4 * b * b * b;
}

/* (dW/dq)/q without norm: 9q - 12 inside q < 1, -3(2-q)^2/q outside. */
SPH_INLINE sphreal sph_f_cubic(sphreal q)
{
  const sphreal a = q < (sphreal)2 ? (sphreal)2 - q : (sphreal)0;
  const sphreal d = q > (sphreal)1 ? q : (sphreal)1;
  const sphreal outer = (sphreal)-3 * a * a / d;
  const sphreal inner = (sphreal)9 * q - (sphreal)12;
  return q < (sphreal)1 ? inner : outer;
}

SPH_INLINE sphreal sph_w_wendland(sphreal q)
{
  const sphreal a = q < (sphreal)2 ? (sphreal)1 - (sphreal)0.5 * q : (sphreal)0;
  return a * a * a * a * ((sphreal)2 * q + (sphreal)1);
}

SPH_INLINE sphreal sph_f_wendland(sphreal q)
{
  const sphreal a = q < (sphreal)2 ? (sphreal)1 - (sphreal)0.5 * q : (sphreal)0;
  return (sphreal)-5 * a * a * a;
}

/* kernel: 0 cubic spline, 1 Wendland C2 (SphKernelType); a compile-time constant in every caller. */
SPH_INLINE sphreal sph_w(int kernel, sphreal q)
{
  return kernel ? sph_w_wendland(q) : sph_w_cubic(q);
}

SPH_INLINE sphreal sph_f(int kernel, sphreal q)
{
  return kernel ? sph_f_wendland(q) : sph_f_cubic(q);
}

/* norm (1/m^dim) such that the integral of norm * sph_w over the support is 1. */
SPH_INLINE double sph_norm(int kernel, int dim, double h)
{
  if (kernel) return dim == 2 ? 7.0 / (4.0 * SPH_PI * h * h) : 21.0 / (16.0 * SPH_PI * h * h * h);
  return dim == 2 ? 5.0 / (14.0 * SPH_PI * h * h) : 1.0 / (4.0 * SPH_PI * h * h * h);
}

#endif
