/* rigidtable.c - prescribed motion: constant velocities or a table of them, linear in time between its entries. */
#include "rigidimpl.h"

PetscErrorCode RigidSetMotionTable(Rigid rigid, PetscInt body, PetscInt n, const PetscReal t[], const PetscReal velocity[],
                                   const PetscReal omega[])
{
  RigidBody *b;

  PetscFunctionBegin;
  PetscCheck(body >= 0 && body < rigid->n, rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Rigid body %" PetscInt_FMT ": there are %" PetscInt_FMT " bodies", body, rigid->n);
  b = &rigid->body[body];
  PetscCheck(!rigid->setup, rigid->comm, PETSC_ERR_ORDER, "RigidSetMotionTable() must come before RigidSetUp()");
  PetscCheck(b->spec.motion == RIGID_PRESCRIBED, rigid->comm, PETSC_ERR_ARG_INCOMP,
             "Rigid body %" PetscInt_FMT ": a motion table is for prescribed bodies", body);
  PetscCheck(n >= 1, rigid->comm, PETSC_ERR_ARG_SIZ,
             "Rigid body %" PetscInt_FMT ": motion table of %" PetscInt_FMT " entries; must be >= 1", body, n);
  for (PetscInt i = 0; i < n; i++) {
    PetscCheck(!PetscIsInfOrNanReal(t[i]) && (i == 0 || t[i] > t[i - 1]), rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "Rigid body %" PetscInt_FMT ": time %" PetscInt_FMT " of its motion table is %g s; times must increase", body, i,
               (double)t[i]);
    for (int k = 0; k < 3; k++)
      PetscCheck(!PetscIsInfOrNanReal(velocity[3 * i + k]) && (!omega || !PetscIsInfOrNanReal(omega[3 * i + k])), rigid->comm,
                 PETSC_ERR_ARG_OUTOFRANGE,
                 "Rigid body %" PetscInt_FMT ": entry %" PetscInt_FMT " of its motion table is not finite", body, i);
    PetscCheck(rigid->dim == 3 || (velocity[3 * i + 2] == 0. && (!omega || (omega[3 * i] == 0. && omega[3 * i + 1] == 0.))),
               rigid->comm, PETSC_ERR_ARG_INCOMP,
               "Rigid body %" PetscInt_FMT ": entry %" PetscInt_FMT " of its motion table leaves the plane in 2D", body, i);
  }
  PetscCall(PetscFree(b->tabletime));
  PetscCall(PetscFree(b->table));
  PetscCall(PetscMalloc1((size_t)n, &b->tabletime));
  PetscCall(PetscMalloc1(6 * (size_t)n, &b->table));
  b->ntable = n;
  for (PetscInt i = 0; i < n; i++) {
    b->tabletime[i] = t[i];
    for (int k = 0; k < 3; k++) {
      b->table[6 * i + k] = velocity[3 * i + k];
      b->table[6 * i + 3 + k] = omega ? omega[3 * i + k] : 0.;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Velocities (linear, angular) at t and their slopes just after it. */
void RigidTableVelocity(const RigidBody *b, PetscReal t, PetscReal v[6], PetscReal a[6])
{
  PetscInt i = 0, hi = b->ntable;
  for (int k = 0; k < 6; k++) {
    v[k] = k < 3 ? b->V[k] : b->w[k - 3];
    a[k] = 0.;
  }
  if (!b->ntable) return;
  while (hi - i > 1) { /* last entry at or before t */
    const PetscInt mid = (i + hi) / 2;
    if (b->tabletime[mid] <= t)
      i = mid;
    else
      hi = mid;
  }
  for (int k = 0; k < 6; k++) {
    const PetscReal *y = b->table + 6 * i + k;
    v[k] = y[0];
    if (t < b->tabletime[0] || i + 1 == b->ntable) continue;
    a[k] = (y[6] - y[0]) / (b->tabletime[i + 1] - b->tabletime[i]);
    v[k] += a[k] * (t - b->tabletime[i]);
  }
}

/* Integral of the velocities from t0 to t1: trapezia between the entries. */
void RigidTableIntegral(const RigidBody *b, PetscReal t0, PetscReal t1, PetscReal d[6])
{
  PetscReal v0[6], v1[6], a[6], t = t0;
  PetscInt i = 0;
  for (int k = 0; k < 6; k++) d[k] = 0.;
  while (i < b->ntable && b->tabletime[i] <= t0) i++;
  RigidTableVelocity(b, t0, v0, a);
  while (t < t1) {
    const PetscReal next = i < b->ntable ? PetscMin(t1, b->tabletime[i]) : t1;
    RigidTableVelocity(b, next, v1, a);
    for (int k = 0; k < 6; k++) {
      d[k] += .5 * (next - t) * (v0[k] + v1[k]);
      v0[k] = v1[k];
    }
    t = next;
    i++;
  }
}

void RigidTableApply(RigidBody *b, PetscReal t)
{
  PetscReal v[6], a[6];
  if (!b->ntable || b->spec.motion != RIGID_PRESCRIBED) return;
  RigidTableVelocity(b, t, v, a);
  for (int k = 0; k < 3; k++) {
    b->V[k] = v[k];
    b->w[k] = v[3 + k];
  }
}
