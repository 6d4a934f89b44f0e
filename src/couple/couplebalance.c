/* couplebalance.c - linear momentum of fluid and structures against the impulses that went in. */
#include "coupleimpl.h"
#include "sphopen.h"

static PetscErrorCode Momenta(Couple c, PetscReal fluid[3], PetscReal structure[3])
{
  SphSums sums;

  PetscFunctionBegin;
  PetscCall(SphGetSums(c->sph, &sums));
  for (int k = 0; k < 3; k++) {
    fluid[k] = sums.momentum[k];
    structure[k] = 0.0;
  }
  for (PetscInt i = 0; i < c->n; i++) {
    CoupleSlot *s = &c->slot[i];
    PetscReal p[3], weight[3], support[3];
    if (s->surface->held || !s->surface->ops.momentum) continue;
    PetscCall((*s->surface->ops.momentum)(s->surface, p, weight, support));
    for (int k = 0; k < 3; k++) {
      structure[k] += p[k];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mass that openings have let in, net, kg, and the momentum that came with it and from their zones. */
PetscErrorCode CoupleOpenings(Couple c, PetscReal *mass, PetscReal momentum[3])
{
  PetscInt n;

  PetscFunctionBegin;
  *mass = momentum[0] = momentum[1] = momentum[2] = 0.0;
  PetscCall(SphGetNumOpenings(c->sph, &n));
  for (PetscInt i = 0; i < n; i++) {
    SphFlow f;
    PetscCall(SphGetFlow(c->sph, i, &f));
    *mass += f.massin - f.massout;
    for (int k = 0; k < 3; k++) momentum[k] += f.momentum[k] + f.impulse[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleBalanceStart(Couple c)
{
  PetscReal fluid[3], structure[3];

  PetscFunctionBegin;
  c->left = -1;
  PetscCall(Momenta(c, fluid, structure));
  for (int k = 0; k < 3; k++) c->p0[k] = fluid[k] + structure[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The beams' supports hold what bodies do to them, and the bodies' weight what beams do: what is between the two goes out. */
static void AttachImpulses(Couple c, PetscReal dt)
{
  PetscReal bodies[3], held[3], ends[3];

  CoupleAttachTotal(c->attach, bodies, held, ends);
  for (int k = 0; k < 3; k++) {
    c->balance.body[k] -= dt * bodies[k];
    c->balance.support[k] += dt * (held[k] - ends[k]);
  }
}

/* Impulses of one step: body force and held surfaces exactly, weight and supports as the structure gives them for the step. */
PetscErrorCode CoupleBalanceAdd(Couple c, PetscReal dt)
{
  CoupleBalance *b = &c->balance;
  PetscReal f[3], net, came[3];
  PetscInt left;

  PetscFunctionBegin;
  PetscCall(SphGetBodyForce(c->sph, f));
  PetscCall(SphGetCounts(c->sph, NULL, NULL, &left));
  PetscCall(CoupleOpenings(c, &net, came)); /* at the end of the step */
  if (left != c->left) {                    /* markers that leave take their mass along */
    SphSums sums;
    PetscCall(SphGetSums(c->sph, &sums));
    c->mass = sums.mass - (net - c->net);
    c->left = left;
  }
  for (int k = 0; k < 3; k++) b->body[k] += dt * c->mass * f[k];
  c->mass += net - c->net;
  c->net = net;
  for (PetscInt i = 0; i < c->n; i++) {
    CoupleSlot *s = &c->slot[i];
    PetscReal p[3], weight[3], support[3];
    c->ledger[4 * i] += dt * s->audit.power;
    for (int k = 0; k < 3; k++) c->ledger[4 * i + 1 + k] += dt * s->audit.moment[k];
    if (s->surface->held || !s->surface->ops.momentum) {
      for (int k = 0; k < 3; k++) b->wall[k] -= dt * s->audit.force[k];
      continue;
    }
    PetscCall((*s->surface->ops.momentum)(s->surface, p, weight, support));
    for (int k = 0; k < 3; k++) {
      b->body[k] += dt * weight[k];
      b->support[k] += dt * support[k];
    }
  }
  if (c->shortrange) { /* a body's weight above holds what beams do to it */
    PetscReal held[3], bodies[3];
    PetscCall(CoupleShortGetForces(c->shortrange, NULL, NULL, held, bodies));
    for (int k = 0; k < 3; k++) {
      b->wall[k] += dt * held[k];
      b->body[k] -= dt * bodies[k];
    }
  }
  if (c->attach) AttachImpulses(c, dt);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CoupleGetBalance - Momentum now, impulses since set-up, and the residual between them (kg m/s).

  The residual of a system without supports is round-off (of the pair arithmetic's precision); with supports it carries
  the second-order error of integrating the support force.
@*/
PetscErrorCode CoupleGetBalance(Couple c, CoupleBalance *balance)
{
  CoupleBalance *b = &c->balance;
  PetscReal net;

  PetscFunctionBegin;
  PetscCall(Momenta(c, b->fluid, b->structure));
  PetscCall(CoupleOpenings(c, &net, b->opening));
  b->scale = 0.0;
  for (int k = 0; k < 3; k++) {
    b->residual[k] = b->fluid[k] + b->structure[k] - c->p0[k] - b->body[k] - b->support[k] - b->wall[k] - b->opening[k];
    b->scale = PetscMax(b->scale, PetscMax(PetscAbsReal(b->fluid[k]), PetscAbsReal(b->structure[k])));
    b->scale =
        PetscMax(b->scale, PetscMax(PetscAbsReal(b->body[k]), PetscMax(PetscAbsReal(b->support[k]), PetscAbsReal(b->wall[k]))));
    b->scale = PetscMax(b->scale, PetscAbsReal(b->opening[k]));
  }
  *balance = *b;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CoupleGetWork - Work (J) and angular impulse about the origin (N m s) that surface i has received from the fluid since set-up.
@*/
PetscErrorCode CoupleGetWork(Couple c, PetscInt i, PetscReal *work, PetscReal impulse[3])
{
  PetscFunctionBegin;
  PetscCheck(c->setup && i >= 0 && i < c->n, c->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "surface %" PetscInt_FMT ": must be in [0, %" PetscInt_FMT "), after CoupleSetUp()", i, c->n);
  if (work) *work = c->ledger[4 * i];
  if (impulse) PetscCall(PetscArraycpy(impulse, c->ledger + 4 * i + 1, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}
