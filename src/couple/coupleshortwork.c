/* coupleshortwork.c - energy and angular momentum that go through the short-range forces of coupleshort.c, for balances. */
#include "coupleshort.h"

/* n.(x_a - x_b) of the beams' points now. */
static PetscReal Along(const ShortPair *p, const PetscReal *e)
{
  PetscReal s = 0.;
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 3; k++) {
      s += p->n[k] * p->a.S[i] * e[6 * p->a.node + 3 * i + k];
      if (p->body == SHORT_BEAM) s -= p->n[k] * p->b.S[i] * e[6 * p->b.node + 3 * i + k];
    }
  return s;
}

/* Where pairs and bodies are at the start of a step; one that starts where the last did is that one, taken again. */
PetscErrorCode CoupleShortStart(CoupleShort c, PetscReal t, PetscReal h)
{
  const PetscReal *e;

  PetscFunctionBegin;
  if (t == c->t0)
    c->done = c->before;
  else
    c->before = c->done;
  c->t0 = t;
  c->h = h;
  c->contacts = c->npairs;
  c->applied = PETSC_TRUE;
  PetscCall(AncfGetState(c->ancf, NULL, &e, NULL, NULL));
  for (PetscInt k = 0; k < c->npairs; k++) {
    ShortPair *p = &c->pair[k];
    p->start = Along(p, e);
    if (p->body >= 0) PetscCall(RigidGetState(c->rigid, p->body, c->place + 6 * p->body, NULL, NULL, c->place + 6 * p->body + 3));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After the step, whose forces were held over it: work is force times displacement. */
PetscErrorCode CoupleShortAccount(CoupleShort c)
{
  CoupleExchange *d = &c->done;
  const PetscReal *e;

  PetscFunctionBegin;
  if (!c->applied) PetscFunctionReturn(PETSC_SUCCESS);
  c->applied = PETSC_FALSE;
  PetscCall(AncfGetState(c->ancf, NULL, &e, NULL, NULL));
  for (PetscInt k = 0; k < c->npairs; k++) {
    const ShortPair *p = &c->pair[k];
    const PetscReal *x = p->body >= 0 ? c->place + 6 * p->body : NULL, f = p->elastic + p->heat;
    PetscReal beams = Along(p, e) - p->start, body = 0., X[3], w[3], turn[3], mid[3], t[3], F[3];
    RigidBodySpec spec;
    for (int i = 0; i < 3; i++) F[i] = f * p->n[i];
    if (p->body != SHORT_BEAM) {
      CoupleCross(p->a.x, F, t);
      for (int i = 0; i < 3; i++) d->turnbeams[i] += c->h * t[i];
    }
    if (p->body >= 0) {
      PetscCall(RigidGetState(c->rigid, p->body, X, NULL, NULL, w));
      PetscCall(RigidGetBody(c->rigid, p->body, &spec));
      for (int i = 0; i < 3; i++) w[i] = .5 * c->h * (w[i] + x[3 + i]);
      CoupleCross(w, p->r, turn);
      for (int i = 0; i < 3; i++) {
        body += p->n[i] * (X[i] - x[i] + turn[i]);
        mid[i] = .5 * (X[i] + x[i]) + p->r[i];
      }
      d->beams += f * body;
      CoupleCross(mid, F, t);
      if (spec.motion == RIGID_FREE) d->bodies -= f * body;
      for (int i = 0; i < 3 && spec.motion == RIGID_FREE; i++) d->turnbodies[i] -= c->h * t[i];
    }
    d->taken -= p->heat * (beams - body);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleShortGetExchange(CoupleShort c, CoupleExchange *exchange)
{
  PetscFunctionBegin;
  PetscCheck(c->setup, c->comm, PETSC_ERR_ORDER, "CoupleShortSetUp() must come before CoupleShortGetExchange()");
  *exchange = c->done;
  exchange->elastic = 0.;
  if (!c->active || c->p.modulus == 0.) PetscFunctionReturn(PETSC_SUCCESS);
  c->half = 0.;
  PetscCall(CoupleShortFindPairs(c));
  for (PetscInt k = 0; k < c->npairs; k++) {
    const ShortPair *p = &c->pair[k];
    PetscReal stiffness, damping;
    ShortRangeLineContact(&c->p, 0., p->gap, &stiffness, &damping);
    exchange->elastic += .5 * p->length * stiffness * PetscSqr(c->p.roughness - p->gap);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleShortMoveState(CoupleShort c, FrondState *s)
{
  PetscFunctionBegin;
  FrondMoveReal(s, "shortrange/done", (PetscReal *)&c->done, sizeof(c->done) / sizeof(PetscReal));
  if (s->way == FROND_STATE_LOAD) c->t0 = PETSC_NINFINITY;
  PetscFunctionReturn(PETSC_SUCCESS);
}
