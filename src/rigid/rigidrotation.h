/*
  rigidrotation.h - quaternion and 3 x 3 algebra of the rigid bodies; pure functions, no allocation.

  Quaternions are q = (qx, qy, qz, qw) as in Eqs. 15-17 of Pazouki, Serban, Negrut, where qx is the scalar part:
  space = R(q) body, and dq/dt = G^T omega'/2 = q (0, omega')/2 with omega' in the body frame.
*/
#ifndef RIGIDROTATION_H
#define RIGIDROTATION_H

#include <math.h>
#include <petscsys.h>

static inline void Vec3Cross(const PetscReal a[3], const PetscReal b[3], PetscReal c[3])
{
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

static inline PetscReal Vec3Dot(const PetscReal a[3], const PetscReal b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline PetscReal Vec3Norm(const PetscReal a[3])
{
  return PetscSqrtReal(Vec3Dot(a, a));
}

/* y = A x and y = A^T x for a row-major 3 x 3 matrix. */
static inline void Mat3Mult(const PetscReal A[9], const PetscReal x[3], PetscReal y[3])
{
  for (int i = 0; i < 3; i++) y[i] = A[3 * i] * x[0] + A[3 * i + 1] * x[1] + A[3 * i + 2] * x[2];
}

static inline void Mat3MultTranspose(const PetscReal A[9], const PetscReal x[3], PetscReal y[3])
{
  for (int i = 0; i < 3; i++) y[i] = A[i] * x[0] + A[3 + i] * x[1] + A[6 + i] * x[2];
}

static inline PetscReal Mat3Det(const PetscReal A[9])
{
  return A[0] * (A[4] * A[8] - A[5] * A[7]) - A[1] * (A[3] * A[8] - A[5] * A[6]) + A[2] * (A[3] * A[7] - A[4] * A[6]);
}

/* x = A^-1 b by Cramer's rule; A must be non-singular (callers pass symmetric positive definite matrices). */
static inline void Mat3Solve(const PetscReal A[9], const PetscReal b[3], PetscReal x[3])
{
  PetscReal det = Mat3Det(A);
  for (int c = 0; c < 3; c++) {
    PetscReal B[9];
    for (int k = 0; k < 9; k++) B[k] = (k % 3 == c) ? b[k / 3] : A[k];
    x[c] = Mat3Det(B) / det;
  }
}

/* c = a b (Hamilton product). */
static inline void QuatMult(const PetscReal a[4], const PetscReal b[4], PetscReal c[4])
{
  c[0] = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3];
  c[1] = a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2];
  c[2] = a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1];
  c[3] = a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0];
}

static inline void QuatNormalize(PetscReal q[4])
{
  PetscReal s = 1. / PetscSqrtReal(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (int k = 0; k < 4; k++) q[k] *= s;
}

/* Quaternion of the rotation vector v (axis times angle, rad). */
static inline void QuatExp(const PetscReal v[3], PetscReal q[4])
{
  PetscReal a = .5 * Vec3Norm(v), s;
  s = (a < 1.e-4) ? .5 * (1. - a * a / 6.) : .5 * PetscSinReal(a) / a; /* next term a^4/120 < 1e-18 */
  q[0] = PetscCosReal(a);
  for (int k = 0; k < 3; k++) q[k + 1] = s * v[k];
}

/* Rotation matrix, row major: space = R body. */
static inline void QuatMatrix(const PetscReal q[4], PetscReal R[9])
{
  const PetscReal s = q[0], x = q[1], y = q[2], z = q[3];
  R[0] = s * s + x * x - y * y - z * z;
  R[1] = 2. * (x * y - s * z);
  R[2] = 2. * (x * z + s * y);
  R[3] = 2. * (x * y + s * z);
  R[4] = s * s - x * x + y * y - z * z;
  R[5] = 2. * (y * z - s * x);
  R[6] = 2. * (x * z - s * y);
  R[7] = 2. * (y * z + s * x);
  R[8] = s * s - x * x - y * y + z * z;
}

/* v = R(q) x and v = R(q)^T x. */
static inline void QuatRotate(const PetscReal q[4], const PetscReal x[3], PetscReal v[3])
{
  PetscReal R[9];
  QuatMatrix(q, R);
  Mat3Mult(R, x, v);
}

static inline void QuatRotateBack(const PetscReal q[4], const PetscReal x[3], PetscReal v[3])
{
  PetscReal R[9];
  QuatMatrix(q, R);
  Mat3MultTranspose(R, x, v);
}

/* Space-frame inertia tensor R diag(J) R^T. */
static inline void InertiaSpace(const PetscReal q[4], const PetscReal J[3], PetscReal A[9])
{
  PetscReal R[9];
  QuatMatrix(q, R);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      A[3 * i + j] = R[3 * i] * J[0] * R[3 * j] + R[3 * i + 1] * J[1] * R[3 * j + 1] + R[3 * i + 2] * J[2] * R[3 * j + 2];
}

#endif
