/*
  rigidaudit.c - where the energy and the angular momentum of the bodies go, for balances.

  Kicks come one after the other, so that the force F of a kick of length h does the work h F.(v + v')/2 exactly, v and v' being
  the velocities before and after the whole kick; elastic forces count by their energy instead, and what these two part by is the
  error of the time integration. Forces of joints are summed in rigidconstraint.c.
*/
#include "rigidcontact.h"

/* v += sign n.(velocity of the point r of a body that moves as dv = (V, w)). */
static void AddPoint(const PetscReal dv[6], const PetscReal r[3], const PetscReal n[3], PetscReal sign, PetscReal *v)
{
  PetscReal x[3];
  Vec3Cross(dv + 3, r, x);
  *v += sign * (Vec3Dot(n, dv) + Vec3Dot(n, x));
}

static void BodyVelocity(const RigidBody *b, PetscReal v[6])
{
  for (int k = 0; k < 3; k++) v[k] = b->V[k];
  RigidBodyOmega(b, b->q, v + 3);
}

/* c->kick of a body: what all its wrenches but those of joints change (V, w) by. */
static void KickOf(Rigid rigid, RigidContact c, PetscInt i, PetscReal kick)
{
  const RigidBody *b = &rigid->body[i];
  PetscReal wrench[6], *dv = c->kick + 6 * i;
  RigidBodyWeight(rigid, b, wrench, wrench + 3);
  for (int k = 0; k < 3; k++) {
    wrench[k] += b->F[k] + b->Fs[k];
    wrench[3 + k] += b->T[k] + b->Ts[k];
  }
  RigidBodyMobility(b, wrench, dv);
  for (int k = 0; k < 6; k++) dv[k] *= kick;
}

/* Work of a body that is not free on the other one, and the angular impulse that comes from outside; f: on body i along n. */
static void Outside(Rigid rigid, const Contact *t, PetscReal f, PetscReal kick)
{
  for (int end = 0; end < 2; end++) {
    const PetscInt i = end ? t->j : t->i, other = end ? t->i : t->j;
    const PetscReal sign = end ? -1. : 1., *r = end ? t->rj : t->ri, *ro = end ? t->ri : t->rj;
    PetscReal v[6], vo = 0., x[3], m[3];
    if (i < 0 || rigid->body[i].spec.motion != RIGID_FREE || (other >= 0 && rigid->body[other].spec.motion == RIGID_FREE))
      continue;
    for (int k = 0; k < 3; k++) x[k] = rigid->body[i].X[k] + r[k];
    Vec3Cross(x, t->n, m);
    for (int k = 0; k < 3; k++) rigid->ledger.turn[k] += kick * sign * f * m[k];
    if (other < 0) continue;
    BodyVelocity(&rigid->body[other], v);
    AddPoint(v, ro, t->n, 1., &vo);
    rigid->ledger.driven += kick * sign * f * vo;
  }
}

/* Of the contacts that RigidContactForces() has found, for the kick to come. */
PetscErrorCode RigidAuditContacts(Rigid rigid, PetscReal kick)
{
  RigidContact c = rigid->contact;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < c->n; k++) {
    KickOf(rigid, c, c->contact[k].i, kick);
    if (c->contact[k].j >= 0) KickOf(rigid, c, c->contact[k].j, kick);
  }
  for (PetscInt k = 0; k < c->n; k++) {
    const Contact *t = &c->contact[k];
    PetscReal dv = 0., mean;
    AddPoint(c->kick + 6 * t->i, t->ri, t->n, 1., &dv);
    if (t->j >= 0) AddPoint(c->kick + 6 * t->j, t->rj, t->n, -1., &dv);
    mean = t->v + .5 * dv;
    rigid->ledger.lubrication -= kick * t->lubrication * mean;
    rigid->ledger.impact -= kick * t->impact * mean;
    Outside(rigid, t, t->lubrication + t->elastic + t->impact, kick);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Half a step of weight and permanent loads, as a step has one before its first kick and one after its last. */
void RigidAuditLoads(Rigid rigid, PetscReal h)
{
  for (PetscInt i = 0; i < rigid->n; i++) {
    const RigidBody *b = &rigid->body[i];
    PetscReal F[3], T[3], x[3], w[3];
    if (b->spec.motion != RIGID_FREE) continue;
    RigidBodyWeight(rigid, b, F, T);
    Vec3Cross(b->X, F, x);
    for (int k = 0; k < 3; k++) rigid->ledger.turn[k] += h * (x[k] + T[k]);
    if (Vec3Norm(b->moment) == 0.) continue;
    RigidBodyOmega(b, b->q, w);
    rigid->ledger.driven += h * Vec3Dot(b->moment, w);
  }
}

PetscErrorCode RigidGetAudit(Rigid rigid, RigidAudit *a)
{
  const RigidLedger *l = &rigid->ledger;

  PetscFunctionBegin;
  PetscCheck(rigid->setup, rigid->comm, PETSC_ERR_ORDER, "Call RigidSetUp() first");
  PetscCall(PetscMemzero(a, sizeof(*a)));
  for (PetscInt i = 0; i < rigid->n; i++) {
    const RigidBody *b = &rigid->body[i];
    PetscReal w[3], Jw[3], XV[3], A[9];
    if (b->spec.motion != RIGID_FREE) continue;
    RigidBodyOmega(b, b->q, w);
    InertiaSpace(b->q, b->spec.inertia, A);
    Mat3Mult(A, w, Jw);
    Vec3Cross(b->X, b->V, XV);
    a->kinetic += .5 * b->spec.mass * Vec3Dot(b->V, b->V) + .5 * Vec3Dot(w, Jw);
    for (int k = 0; k < 3; k++) a->angular[k] += b->spec.mass * XV[k] + Jw[k];
  }
  PetscCall(RigidContactEnergy(rigid, &a->contact));
  a->lubrication = l->lubrication;
  a->impact = l->impact;
  a->joints = l->joints;
  a->driven = l->driven;
  PetscCall(PetscArraycpy(a->turn, l->turn, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}
