/* couplestate.c - stepping for programs that own the time loop: to a time, back to a saved state, and the loads on the way. */
#include "coupleimpl.h"

struct _p_CoupleState {
  size_t bytes, cap;
  void *p;
};

PetscErrorCode CoupleAdvance(Couple c, PetscReal tend)
{
  PetscReal t;

  PetscFunctionBegin;
  PetscCheck(c->setup, c->comm, PETSC_ERR_ORDER, "CoupleSetUp() must come before CoupleAdvance()");
  PetscCheck(!PetscIsInfOrNanReal(tend), c->comm, PETSC_ERR_ARG_OUTOFRANGE, "CoupleAdvance() to t = %g s: must be finite",
             (double)tend);
  do { /* CoupleStep() refuses a time that has passed */
    PetscCall(CoupleStep(c, tend, NULL));
    PetscCall(CoupleGetTime(c, &t, NULL));
  } while (t < tend - 1e-12 * PetscMax(1.0, PetscAbsReal(tend)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleGetMarkers(Couple c, PetscInt i, PetscInt *n, const PetscReal **x, const PetscReal **v, const PetscReal **f)
{
  PetscFunctionBegin;
  PetscCheck(c->setup, c->comm, PETSC_ERR_ORDER, "CoupleSetUp() must come before CoupleGetMarkers()");
  PetscCheck(i >= 0 && i < c->n, c->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "surface %" PetscInt_FMT ": must be in [0, %" PetscInt_FMT ")", i, c->n);
  if (x || v || f) PetscCall(CoupleLinkFetch(c, i));
  if (n) *n = c->slot[i].n;
  if (x) *x = c->slot[i].x;
  if (v) *v = c->slot[i].v;
  if (f) *f = c->slot[i].f;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a surface remembers, and its structure. */
static PetscErrorCode MoveSurface(Couple c, PetscInt i, FrondState *state)
{
  CoupleSlot *s = &c->slot[i];
  CoupleSurface surface = s->surface;
  char name[128];
  PetscReal *x = NULL;
  PetscInt n;

  PetscFunctionBegin;
  PetscCheck(surface->ops.statesize, c->comm, PETSC_ERR_SUP,
             "surface %s cannot save its state: its CoupleSurfaceOps have no statesize, save and load", surface->name);
  PetscCall(PetscSNPrintf(name, sizeof(name), "couple/surface_%" PetscInt_FMT "/audit", i));
  FrondMoveReal(state, name, (PetscReal *)&s->audit, sizeof(s->audit) / sizeof(PetscReal));
  PetscCall(PetscSNPrintf(name, sizeof(name), "couple/surface_%" PetscInt_FMT "/force", i));
  if (state->way == FROND_STATE_SAVE) PetscCall(CoupleLinkForces(c, s)); /* for a coupling that reads it without links */
  FrondMoveReal(state, name, s->f, 3 * s->n);
  PetscCall((*surface->ops.statesize)(surface, &n));
  if (state->way != FROND_STATE_COUNT) PetscCall(PetscMalloc1(n, &x));
  if (state->way == FROND_STATE_SAVE) PetscCall((*surface->ops.save)(surface, x));
  PetscCall(PetscSNPrintf(name, sizeof(name), "couple/surface_%" PetscInt_FMT "/state", i));
  FrondMoveReal(state, name, x, n);
  if (state->way == FROND_STATE_LOAD) PetscCall((*surface->ops.load)(surface, x));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CoupleMoveState - The one list of what makes up the coupled system between two steps, see frondstate.h: fluid, structures, and
  what the coupling itself remembers.
@*/
PetscErrorCode CoupleMoveState(Couple c, FrondState *s)
{
  const PetscInt n0 = c->n;
  PetscInt n = n0;

  PetscFunctionBegin;
  PetscCheck(c->setup, c->comm, PETSC_ERR_ORDER, "CoupleSetUp() must come before CoupleMoveState()");
  PetscCall(SphMoveState(c->sph, s));
  FrondMoveInt(s, "couple/surfaces", &n, 1);
  PetscCheck(n == n0, c->comm, PETSC_ERR_ARG_SIZ, "the saved coupling has %" PetscInt_FMT " surfaces, this one %" PetscInt_FMT, n,
             n0);
  FrondMoveInt(s, "couple/left", &c->left, 1);
  FrondMoveInt(s, "couple/iterations", &c->iterations, 1);
  FrondMoveInt(s, "couple/unconverged", &c->unconverged, 1);
  FrondMoveReal(s, "couple/fluid_mass", &c->mass, 1);
  FrondMoveReal(s, "couple/momentum_start", c->p0, 3);
  FrondMoveReal(s, "couple/impulse_body", c->balance.body, 3);
  FrondMoveReal(s, "couple/impulse_support", c->balance.support, 3);
  FrondMoveReal(s, "couple/impulse_wall", c->balance.wall, 3);
  FrondMoveReal(s, "couple/ledger", c->ledger, 4 * c->n);
  for (PetscInt i = 0; i < c->n; i++) PetscCall(MoveSurface(c, i, s));
  if (c->attach) PetscCall(CoupleAttachMoveState(c->attach, s));
  if (c->shortrange) PetscCall(CoupleShortMoveState(c->shortrange, s));
  PetscCall(CoupleLoadsMoveState(c, s));
  if (s->way == FROND_STATE_LOAD) {
    PetscReal came[3];
    PetscCall(CoupleMoveMarkers(c, 0.0));
    PetscCall(CoupleOpenings(c, &c->net, came));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleSaveState(Couple c, CoupleState *state)
{
  FrondStateBuffer count = FrondStateBufferMake(FROND_STATE_COUNT, 0, NULL), save;
  CoupleState s;

  PetscFunctionBegin;
  PetscCheck(c->setup, c->comm, PETSC_ERR_ORDER, "CoupleSetUp() must come before CoupleSaveState()");
  if (!*state) PetscCall(PetscNew(state));
  s = *state;
  PetscCall(CoupleMoveState(c, &count.state));
  s->bytes = count.at;
  if (s->bytes > s->cap) {
    PetscCall(PetscFree(s->p));
    s->cap = s->bytes + s->bytes / 16;
    PetscCall(PetscMalloc(s->cap, &s->p));
  }
  save = FrondStateBufferMake(FROND_STATE_SAVE, s->bytes, s->p);
  PetscCall(CoupleMoveState(c, &save.state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleRestoreState(Couple c, CoupleState s)
{
  FrondStateBuffer load;

  PetscFunctionBegin;
  PetscCheck(s, c->comm, PETSC_ERR_ARG_NULL, "CoupleRestoreState() needs a state made by CoupleSaveState()");
  load = FrondStateBufferMake(FROND_STATE_LOAD, s->bytes, s->p);
  PetscCall(CoupleMoveState(c, &load.state));
  PetscCheck(load.at == s->bytes, c->comm, PETSC_ERR_ARG_SIZ, "the saved state has %zu bytes, this coupling's %zu", s->bytes,
             load.at);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleStateDestroy(CoupleState *state)
{
  PetscFunctionBegin;
  if (!*state) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree((*state)->p));
  PetscCall(PetscFree(*state));
  PetscFunctionReturn(PETSC_SUCCESS);
}
