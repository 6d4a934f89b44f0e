/*
  rigidstep.c - motion of one rigid body over one time step, Eqs. 12-16 of Pazouki, Serban, Negrut.

  Kick - free flight - kick (Strang splitting), with the wrench (F, T), space frame, held over the step dt:
    V += F/M dt/2,  L += T dt/2;   X += V dt, free rotation of q over dt;   V += F/M dt/2,  L += T dt/2
  where L is the angular momentum about the centre of mass in the space frame. Constant force: exact (a parabola).

  Free rotation, q -> q exp(dt w/2), is a Lie midpoint rule: with m = R(q)^T L the momentum in the body frame,
    w = J^-1 (m0 + m1)/2,   m1 = R(q exp(dt w/2))^T L = exp(-dt w) m0.
  It is symmetric, of second order, and keeps the invariants of the free body to round-off: L is not touched; m1 - m0 is
  normal to w and to m0 + m1, since it comes from a rotation about w, hence 2T = m.J^-1 m is kept; |q| = 1 (Eq. 16).
  A body spinning about a principal axis is moved exactly. See Simo and Wong, Int. J. Numer. Meth. Eng. 31 (1991), and
  Austin, Krishnaprasad and Wang, J. Comput. Phys. 107 (1993), for the family of such rules.

  Locked directions are ideal constraints in the space frame: the free components of L obey dL_f/dt = T_f and
  w_f = (J_ff)^-1 L_f with J_ff the free block of R J R^T, so that no multiplier has to be solved for.
*/
#include "rigidgeometry.h"

#define RIGID_MAX_SUBSTEPS 100000

static PetscInt NumRotationLocks(const RigidBody *b)
{
  return (b->spec.lock[3] ? 1 : 0) + (b->spec.lock[4] ? 1 : 0) + (b->spec.lock[5] ? 1 : 0);
}

/* Solve J_ff x_f = y_f, x_l = 0, for the space-frame inertia at q. */
static void SolveUnlocked(const RigidBody *b, const PetscReal q[4], const PetscReal y[3], PetscReal x[3])
{
  PetscReal A[9], rhs[3];
  InertiaSpace(q, b->spec.inertia, A);
  for (int i = 0; i < 3; i++) {
    rhs[i] = b->spec.lock[3 + i] ? 0. : y[i];
    if (!b->spec.lock[3 + i]) continue;
    for (int j = 0; j < 3; j++) A[3 * i + j] = A[3 * j + i] = 0.;
    A[4 * i] = 1.;
  }
  Mat3Solve(A, rhs, x);
}

/* W = M^-1 J for a wrench J = (force, torque): what it changes (V, w) by in unit time, gyroscopic terms aside. */
void RigidBodyMobility(const RigidBody *b, const PetscReal J[6], PetscReal W[6])
{
  for (int k = 0; k < 6; k++) W[k] = 0.;
  if (b->spec.motion != RIGID_FREE) return;
  for (int k = 0; k < 3; k++) W[k] = b->spec.lock[k] ? 0. : J[k] / b->spec.mass;
  SolveUnlocked(b, b->q, J + 3, W + 3);
}

/* Angular velocity (space frame) of body b, were its orientation q. */
void RigidBodyOmega(const RigidBody *b, const PetscReal q[4], PetscReal w[3])
{
  if (b->spec.motion != RIGID_FREE) {
    for (int k = 0; k < 3; k++) w[k] = b->spec.motion == RIGID_PRESCRIBED ? b->w[k] : 0.;
  } else if (NumRotationLocks(b)) {
    SolveUnlocked(b, q, b->L, w);
  } else {
    PetscReal m[3];
    QuatRotateBack(q, b->L, m);
    for (int k = 0; k < 3; k++) m[k] /= b->spec.inertia[k];
    QuatRotate(q, m, w);
  }
}

/* L = R J R^T w; a locked body has w = 0 along its locks. */
void RigidBodySetOmega(RigidBody *b, const PetscReal w[3])
{
  PetscReal A[9];
  InertiaSpace(b->q, b->spec.inertia, A);
  Mat3Mult(A, w, b->L);
  for (int k = 0; k < 3; k++) b->w[k] = w[k];
}

/* From the centre of mass to the centroid of the volume, space frame; not 0 for composites of several densities. */
static void BuoyancyArm(const RigidBody *b, PetscReal r[3])
{
  static const PetscReal zero[3] = {0., 0., 0.};
  QuatRotate(b->q, b->spec.geometry ? b->spec.geometry->centroid : zero, r);
}

static PetscErrorCode CheckVector(Rigid rigid, PetscInt body, const char what[], const PetscReal x[3])
{
  PetscFunctionBegin;
  PetscCheck(body >= 0 && body < rigid->n, rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Rigid body %" PetscInt_FMT ": there are %" PetscInt_FMT " bodies", body, rigid->n);
  PetscCheck(!x || !PetscIsInfOrNanReal(x[0] + x[1] + x[2]), rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Rigid body %" PetscInt_FMT ": %s = (%g, %g, %g) must be finite", body, what, (double)x[0], (double)x[1],
             (double)x[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidSetBodyGravity(Rigid rigid, PetscInt body, const PetscReal g[3])
{
  PetscFunctionBegin;
  PetscCall(CheckVector(rigid, body, "gravity", g));
  PetscCall(PetscArraycpy(rigid->body[body].g, g, 3));
  rigid->body[body].owng = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidSetBodyLoad(Rigid rigid, PetscInt body, const PetscReal F[3], const PetscReal T[3])
{
  PetscFunctionBegin;
  PetscCall(CheckVector(rigid, body, "load", F));
  PetscCall(CheckVector(rigid, body, "torque", T));
  for (int k = 0; k < 3; k++) {
    rigid->body[body].load[k] = F ? F[k] : 0.;
    rigid->body[body].moment[k] = T ? T[k] : 0.;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gravity less the weight of the displaced fluid, which acts in the centroid of the volume, and the permanent load. */
void RigidBodyWeight(Rigid rigid, const RigidBody *b, PetscReal F[3], PetscReal T[3])
{
  const PetscReal lift = -rigid->rhofluid * b->volume, *g = b->owng ? b->g : rigid->g;
  PetscReal r[3], rxg[3];
  BuoyancyArm(b, r);
  Vec3Cross(r, rigid->g, rxg);
  for (int k = 0; k < 3; k++) {
    F[k] = b->spec.mass * g[k] + lift * rigid->g[k] + b->load[k];
    T[k] = lift * rxg[k] + b->moment[k];
  }
}

/* Of weight and permanent force; a torque of fixed direction has none. */
PetscReal RigidBodyPotential(Rigid rigid, const RigidBody *b)
{
  const PetscReal lift = -rigid->rhofluid * b->volume, *g = b->owng ? b->g : rigid->g;
  PetscReal r[3];
  BuoyancyArm(b, r);
  return -b->spec.mass * Vec3Dot(g, b->X) - lift * (Vec3Dot(rigid->g, b->X) + Vec3Dot(rigid->g, r)) - Vec3Dot(b->load, b->X);
}

/* Eqs. 12, 14 for the last wrench: J alpha = T - w x J w in the space frame. */
void RigidBodyAcceleration(Rigid rigid, const RigidBody *b, PetscReal A[3], PetscReal alpha[3])
{
  PetscReal w[3], Jw[3], gyro[3], weight[3], tilt[3], S[9], rhs[3];
  for (int k = 0; k < 3; k++) A[k] = alpha[k] = 0.;
  if (b->spec.motion == RIGID_PRESCRIBED) {
    PetscReal v[6], a[6];
    RigidTableVelocity(b, rigid->t, v, a);
    for (int k = 0; k < 3; k++) {
      A[k] = a[k];
      alpha[k] = a[3 + k];
    }
  }
  if (b->spec.motion != RIGID_FREE) return;
  RigidBodyWeight(rigid, b, weight, tilt);
  RigidBodyOmega(b, b->q, w);
  InertiaSpace(b->q, b->spec.inertia, S);
  Mat3Mult(S, w, Jw);
  Vec3Cross(w, Jw, gyro);
  for (int k = 0; k < 3; k++) {
    const PetscReal F = rigid->advanced ? b->Fused[k] : b->F[k], T = rigid->advanced ? b->Tused[k] : b->T[k];
    A[k] = b->spec.lock[k] ? 0. : (F + weight[k]) / b->spec.mass;
    rhs[k] = T + tilt[k] - gyro[k];
  }
  SolveUnlocked(b, b->q, rhs, alpha);
}

/* One free rotation without locks; the iteration contracts by dt |L|/(2 min J) <= 1/4 (see NumSubsteps()). */
static void RotateFree(RigidBody *b, PetscReal dt)
{
  const PetscReal *J = b->spec.inertia;
  PetscReal m0[3], m1[3], v[3], e[4], qn[4], last = PETSC_MAX_REAL;
  QuatRotateBack(b->q, b->L, m0);
  for (int k = 0; k < 3; k++) m1[k] = m0[k];
  for (int it = 0; it < 60; it++) {
    PetscReal m[3], change = 0.;
    for (int k = 0; k < 3; k++) v[k] = .5 * dt * (m0[k] + m1[k]) / J[k];
    QuatExp(v, e);
    QuatRotateBack(e, m0, m);
    for (int k = 0; k < 3; k++) {
      change = PetscMax(change, PetscAbsReal(m[k] - m1[k]));
      m1[k] = m[k];
    }
    if (change == 0. || (change >= last && it > 3)) break;
    last = change;
  }
  QuatMult(b->q, e, qn);
  QuatNormalize(qn);
  for (int k = 0; k < 4; k++) b->q[k] = qn[k];
}

/* The same midpoint rule in the space frame, w taken at the orientation half way, for bodies with locked rotations. */
static void RotateLocked(RigidBody *b, PetscReal dt)
{
  PetscReal w[3], v[3], e[4], qn[4], last = PETSC_MAX_REAL;
  RigidBodyOmega(b, b->q, w);
  for (int it = 0; it < 60; it++) {
    PetscReal wn[3], change = 0.;
    for (int k = 0; k < 3; k++) v[k] = .5 * dt * w[k];
    QuatExp(v, e);
    QuatMult(e, b->q, qn);
    RigidBodyOmega(b, qn, wn);
    for (int k = 0; k < 3; k++) {
      change = PetscMax(change, PetscAbsReal(wn[k] - w[k]));
      w[k] = wn[k];
    }
    if (change == 0. || (change >= last && it > 3)) break;
    last = change;
  }
  for (int k = 0; k < 3; k++) v[k] = dt * w[k];
  QuatExp(v, e);
  QuatMult(e, b->q, qn);
  QuatNormalize(qn);
  for (int k = 0; k < 4; k++) b->q[k] = qn[k];
}

/* Enough substeps for the fixed-point iterations to contract by 4 at least. */
static PetscErrorCode NumSubsteps(Rigid rigid, PetscInt i, PetscReal dt, PetscInt *nsub)
{
  const RigidBody *b = &rigid->body[i];
  const PetscReal Jmin = PetscMin(PetscMin(b->spec.inertia[0], b->spec.inertia[1]), b->spec.inertia[2]);
  const PetscReal n = PetscCeilReal(2. * dt * Vec3Norm(b->L) / Jmin);

  PetscFunctionBegin;
  PetscCheck(n <= RIGID_MAX_SUBSTEPS, rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Rigid body %" PetscInt_FMT
             ": it spins too fast for the time step %g s at t = %g s (|L|/min J = %g rad/s; a step may hold %g rad)",
             i, (double)dt, (double)rigid->t, (double)(Vec3Norm(b->L) / Jmin), .5 * RIGID_MAX_SUBSTEPS);
  *nsub = PetscMax((PetscInt)n, 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void RigidBodyKick(RigidBody *b, const PetscReal F[3], const PetscReal T[3], PetscReal dt)
{
  for (int k = 0; k < 3; k++) {
    if (!b->spec.lock[k]) b->V[k] += dt * F[k] / b->spec.mass;
    if (!b->spec.lock[3 + k]) b->L[k] += dt * T[k];
  }
}

/* The applied and short-range wrenches and the weight at the present orientation, over dt. */
void RigidBodyKickApplied(Rigid rigid, RigidBody *b, PetscReal dt)
{
  PetscReal F[3], T[3];
  RigidBodyWeight(rigid, b, F, T);
  for (int k = 0; k < 3; k++) {
    F[k] += b->F[k] + b->Fs[k];
    T[k] += b->T[k] + b->Ts[k];
  }
  RigidBodyKick(b, F, T, dt);
}

/* Free flight. */
PetscErrorCode RigidBodyDrift(Rigid rigid, PetscInt i, PetscReal dt)
{
  RigidBody *b = &rigid->body[i];
  PetscInt nsub;

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) b->X[k] += dt * b->V[k];
  PetscCall(NumSubsteps(rigid, i, dt, &nsub));
  for (PetscInt s = 0; s < nsub; s++) {
    if (NumRotationLocks(b))
      RotateLocked(b, dt / (PetscReal)nsub);
    else
      RotateFree(b, dt / (PetscReal)nsub);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidBodyCheckLoad(Rigid rigid, PetscInt i)
{
  const RigidBody *b = &rigid->body[i];

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    PetscCheck(!PetscIsInfOrNanReal(b->F[k]) && !PetscIsInfOrNanReal(b->T[k]), rigid->comm, PETSC_ERR_FP,
               "Rigid body %" PetscInt_FMT ": force[%d] = %g N, torque[%d] = %g N m at t = %g s are not finite", i, k,
               (double)b->F[k], k, (double)b->T[k], (double)rigid->t);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* First kick and free flight of one body over dt; of a prescribed one, all of its motion. */
PetscErrorCode RigidBodyBegin(Rigid rigid, PetscInt i, PetscReal dt)
{
  RigidBody *b = &rigid->body[i];

  PetscFunctionBegin;
  PetscCall(RigidBodyCheckLoad(rigid, i));
  if (b->spec.motion == RIGID_FREE) {
    RigidBodyKickApplied(rigid, b, .5 * dt);
    PetscCall(RigidBodyDrift(rigid, i, dt));
  } else if (b->spec.motion == RIGID_PRESCRIBED) {
    PetscReal d[6], *v = d + 3, e[4], qn[4];
    RigidTableIntegral(b, rigid->t, rigid->t + dt, d);
    for (int k = 0; k < 3; k++) b->X[k] += d[k];
    QuatExp(v, e);
    QuatMult(e, b->q, qn);
    QuatNormalize(qn);
    for (int k = 0; k < 4; k++) b->q[k] = qn[k];
    RigidTableApply(b, rigid->t + dt);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Second kick. */
void RigidBodyEnd(Rigid rigid, PetscInt i, PetscReal dt)
{
  RigidBody *b = &rigid->body[i];
  for (int k = 0; k < 3; k++) {
    b->Fused[k] = b->F[k] + b->Fs[k];
    b->Tused[k] = b->T[k] + b->Ts[k];
  }
  if (b->spec.motion == RIGID_FREE) RigidBodyKickApplied(rigid, b, .5 * dt);
}
