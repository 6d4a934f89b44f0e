/* couplestate.c - stepping for programs that own the time loop: to a time, back to a saved state, and the loads on the way. */
#include "coupleimpl.h"

struct _p_CoupleState {
  size_t bytes, cap; /* fluid */
  void *fluid;
  PetscInt n, ncap; /* surfaces and balance */
  PetscReal *real;
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
  if (n) *n = c->slot[i].n;
  if (x) *x = c->slot[i].x;
  if (v) *v = c->slot[i].v;
  if (f) *f = c->slot[i].f;
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  PetscReal *p;
  PetscInt at;
  enum { WAY_COUNT, WAY_SAVE, WAY_LOAD } way;
} Cursor;

static void Move(Cursor *b, PetscReal *x, PetscInt n)
{
  for (PetscInt i = 0; i < n && b->way != WAY_COUNT; i++) {
    if (b->way == WAY_SAVE)
      b->p[b->at + i] = x[i];
    else
      x[i] = b->p[b->at + i];
  }
  b->at += n;
}

/* The one list of what the coupling itself remembers. */
static PetscErrorCode MoveCouple(Couple c, Cursor *b)
{
  PetscReal left = (PetscReal)c->left;

  PetscFunctionBegin;
  Move(b, &left, 1);
  c->left = (PetscInt)left;
  Move(b, &c->mass, 1);
  Move(b, c->p0, 3);
  Move(b, c->balance.body, 3);
  Move(b, c->balance.support, 3);
  Move(b, c->balance.wall, 3);
  for (PetscInt i = 0; i < c->n; i++) {
    CoupleSlot *s = &c->slot[i];
    CoupleSurface surface = s->surface;
    PetscInt n;
    Move(b, (PetscReal *)&s->audit, (PetscInt)(sizeof(s->audit) / sizeof(PetscReal)));
    Move(b, s->f, 3 * s->n);
    PetscCheck(surface->ops.statesize, c->comm, PETSC_ERR_SUP,
               "surface %s cannot save its state: its CoupleSurfaceOps have no statesize, save and load", surface->name);
    PetscCall((*surface->ops.statesize)(surface, &n));
    if (b->way == WAY_SAVE) PetscCall((*surface->ops.save)(surface, b->p + b->at));
    if (b->way == WAY_LOAD) PetscCall((*surface->ops.load)(surface, b->p + b->at));
    b->at += n;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Reserve(Couple c, CoupleState s)
{
  Cursor count = {NULL, 0, WAY_COUNT};

  PetscFunctionBegin;
  PetscCall(SphGetStateSize(c->sph, &s->bytes));
  PetscCall(MoveCouple(c, &count));
  s->n = count.at;
  if (s->bytes > s->cap) {
    PetscCall(PetscFree(s->fluid));
    s->cap = s->bytes + s->bytes / 16;
    PetscCall(PetscMalloc(s->cap, &s->fluid));
  }
  if (s->n > s->ncap) {
    PetscCall(PetscFree(s->real));
    s->ncap = s->n;
    PetscCall(PetscMalloc1(s->ncap, &s->real));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleSaveState(Couple c, CoupleState *state)
{
  Cursor save = {NULL, 0, WAY_SAVE};

  PetscFunctionBegin;
  PetscCheck(c->setup, c->comm, PETSC_ERR_ORDER, "CoupleSetUp() must come before CoupleSaveState()");
  if (!*state) PetscCall(PetscNew(state));
  PetscCall(Reserve(c, *state));
  save.p = (*state)->real;
  PetscCall(SphSaveState(c->sph, (*state)->bytes, (*state)->fluid));
  PetscCall(MoveCouple(c, &save));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleRestoreState(Couple c, CoupleState s)
{
  Cursor load = {NULL, 0, WAY_LOAD}, count = {NULL, 0, WAY_COUNT};

  PetscFunctionBegin;
  PetscCheck(s, c->comm, PETSC_ERR_ARG_NULL, "CoupleRestoreState() needs a state made by CoupleSaveState()");
  PetscCall(MoveCouple(c, &count));
  PetscCheck(count.at == s->n, c->comm, PETSC_ERR_ARG_SIZ,
             "the saved state has %" PetscInt_FMT " numbers of structures, this coupling %" PetscInt_FMT, s->n, count.at);
  load.p = s->real;
  PetscCall(SphRestoreState(c->sph, s->bytes, s->fluid));
  PetscCall(MoveCouple(c, &load));
  PetscCall(CoupleMoveMarkers(c, 0.0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleStateDestroy(CoupleState *state)
{
  PetscFunctionBegin;
  if (!*state) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree((*state)->fluid));
  PetscCall(PetscFree((*state)->real));
  PetscCall(PetscFree(*state));
  PetscFunctionReturn(PETSC_SUCCESS);
}
