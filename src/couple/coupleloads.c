/*
  coupleloads.c - loads and accelerations that go on linearly over a step.

  The fluid gives the force F_n+1/2 at the middle of the step. Constant loads are this force. Linear ones have it as mean, so that
  the impulse is the same and momentum stays balanced, and the slope

    s = (F_n+1/2 - F_n-1/2)/((dt_n + dt_n-1)/2):   F(tau) = F_n+1/2 + s (tau - dt_n/2),  0 <= tau <= dt_n,

  extrapolated by half a step behind the middle (staggered), or that of the iterate F_n+1/2 (iterated).

  A wall's pressure needs the acceleration of its markers at t_n + dt_n/2 (Adami et al., Eq. 27). The mean acceleration over a
  step, (v_n+1 - v_n)/dt_n, is true at its middle to second order, whatever the loads and the structure's integrator. Iterated
  steps use it. (The equations of motion at t_n+1 under the loads of the middle give one that is half a step off for the elastic
  forces: iterated, this feeds a mode of frequency w at the rate w^2 dt/4 r/(1 + r), r added over own mass.) Staggered steps with
  linear loads use the acceleration under the loads extrapolated to t_n, half a step late, where the surface takes linear loads;
  else (rigid bodies) the mean acceleration extrapolated from the last two steps. Both at once made elastic plates unstable.
*/
#include "coupleimpl.h"

const char *const CoupleLoadsTypes[] = {"constant", "linear", "CoupleLoads", "COUPLE_LOADS_", NULL};

PetscErrorCode CoupleSetLoads(Couple c, CoupleLoads loads)
{
  PetscFunctionBegin;
  PetscCheck(loads == COUPLE_LOADS_CONSTANT || loads == COUPLE_LOADS_LINEAR, c->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "couple_loads = %d: must be constant or linear", (int)loads);
  for (PetscInt i = 0; i < c->n; i++)
    PetscCheck(!c->slot[i].linked || loads == COUPLE_LOADS_CONSTANT, c->comm, PETSC_ERR_ORDER,
               "couple_loads = linear: must be set before CoupleSetUp() when transfers are generalised (couple_transfer)");
  c->loads = loads;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BeginSlot(Couple c, CoupleSlot *s, PetscReal dt)
{
  PetscFunctionBegin;
  (void)c;
  (void)dt;
  if (s->surface->held || s->linked) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArraycpy(s->flast, s->f, 3 * s->n));
  PetscCall(PetscArraycpy(s->vstart, s->v, 3 * s->n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EndSlot(Couple c, CoupleSlot *s, PetscReal dt)
{
  PetscFunctionBegin;
  (void)c;
  if (s->surface->held || s->linked) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt j = 0; j < 3 * s->n; j++) {
    s->alast[1][j] = s->alast[0][j];
    s->alast[0][j] = (s->v[j] - s->vstart[j]) / dt;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleLoadsBegin(Couple c, PetscReal dt)
{
  PetscFunctionBegin;
  c->dt = dt;
  PetscCall(CoupleShare(c, BeginSlot, dt));
  for (PetscInt i = 0; i < c->n; i++)
    if (!CoupleShares(c, &c->slot[i])) PetscCall(BeginSlot(c, &c->slot[i], dt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleLoadsEnd(Couple c)
{
  PetscReal dt = c->dt;

  PetscFunctionBegin;
  PetscCall(CoupleShare(c, EndSlot, c->dt));
  for (PetscInt i = 0; i < c->n; i++) {
    CoupleSlot *s = &c->slot[i];
    if (!CoupleShares(c, s)) PetscCall(EndSlot(c, s, c->dt));
    if (s->linked && !s->surface->held) dt = 0.0; /* no history of the markers that the fluid moves by itself */
  }
  c->dtlast[1] = c->dtlast[0];
  c->dtlast[0] = dt;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Slopes from the forces of the last step to those just applied. */
PetscErrorCode CoupleLoadsChange(Couple c)
{
  const PetscReal g = 2.0 * c->dt / (c->dt + c->dtlast[0]);

  PetscFunctionBegin;
  /* attached structures go back to the start of the step within it, which loads that vary do not survive */
  if (c->loads != COUPLE_LOADS_LINEAR || c->attach || c->dtlast[0] <= 0.0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < c->n; i++) {
    const CoupleSlot *s = &c->slot[i];
    if (s->surface->held || !s->surface->ops.changeforces) continue;
    for (PetscInt j = 0; j < 3 * s->n; j++) c->work[j] = g * (s->f[j] - s->flast[j]);
    PetscCall((*s->surface->ops.changeforces)(s->surface, c->work));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Motion of a surface's markers at the time of its structure plus ahead (s). Behind it, in the middle of an iterated step: with
  the mean acceleration over the step. Before it, when loads are linear but the surface takes constant ones: with the mean
  acceleration extrapolated from the last two steps.
*/
PetscErrorCode CoupleMoveSlot(Couple c, CoupleSlot *s, PetscReal ahead)
{
  const PetscBool held = s->surface->held;
  const PetscReal *d = c->dtlast;

  PetscFunctionBegin;
  if (ahead < 0.0 && !held) PetscCall((*s->surface->ops.kinematics)(s->surface, 0.0, s->x, c->work, s->a));
  PetscCall((*s->surface->ops.kinematics)(s->surface, ahead, s->x, s->v, s->a));
  if (held) PetscFunctionReturn(PETSC_SUCCESS);
  if (ahead < 0.0) {
    for (PetscInt j = 0; j < 3 * s->n; j++) s->a[j] = (c->work[j] - s->vstart[j]) / c->dt;
  } else if (ahead > 0.0 && c->loads == COUPLE_LOADS_LINEAR && d[1] > 0.0 && !s->surface->ops.changeforces) {
    const PetscReal g = (2.0 * ahead + d[0]) / (d[0] + d[1]);
    for (PetscInt j = 0; j < 3 * s->n; j++) s->a[j] = s->alast[0][j] + g * (s->alast[0][j] - s->alast[1][j]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleLoadsMoveState(Couple c, FrondState *state)
{
  char name[128];

  PetscFunctionBegin;
  FrondMoveReal(state, "couple/last_steps", c->dtlast, 2);
  for (PetscInt i = 0; i < c->n; i++) {
    const CoupleSlot *s = &c->slot[i];
    for (int k = 0; k < 2 && !s->surface->held; k++) {
      PetscCall(PetscSNPrintf(name, sizeof(name), "couple/surface_%" PetscInt_FMT "/last_acceleration_%d", i, k));
      FrondMoveReal(state, name, s->alast[k], 3 * s->n);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
