/*
  sphstate.c - the whole state of the fluid in one buffer, and back: rollback of a step, restart.

  Everything that the next step depends on, in the order of the arrays: sums over neighbours then run in the same order and
  give the same bits. A backend without an operation of its own for its search structure makes that anew after a save as well as
  after a restore, from the same arrays.
*/
#include "sphimpl.h"

#define Move(b, x) PetscCall(SphBufferMove(b, &(x), sizeof(x)))
#define MoveArray(b, x, n) PetscCall(SphBufferMove(b, x, (size_t)(n) * sizeof(*(x))))

static PetscErrorCode MoveState(Sph sph, SphState *st, SphBuffer *b)
{
  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    MoveArray(b, st->x[k], sph->n);
    MoveArray(b, st->v[k], sph->n);
  }
  MoveArray(b, st->s, sph->n);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The one list of what makes up the state. */
static PetscErrorCode MoveAll(Sph sph, SphBuffer *b)
{
  const PetscInt n0 = sph->n, g0 = sph->ngroups;
  PetscInt n = n0, groups = g0;

  PetscFunctionBegin;
  Move(b, n);
  Move(b, groups);
  PetscCheck(n == n0 && groups == g0, sph->comm, PETSC_ERR_ARG_SIZ,
             "the saved fluid has %" PetscInt_FMT " markers in %" PetscInt_FMT " groups, this one %" PetscInt_FMT
             " in %" PetscInt_FMT,
             n, groups, n0, g0);
  Move(b, sph->t);
  Move(b, sph->dt);
  Move(b, sph->step);
  Move(b, sph->left);
  Move(b, sph->verletstep);
  Move(b, sph->dtold);
  Move(b, sph->verletspan);
  Move(b, sph->evaluations);
  PetscCall(MoveState(sph, &sph->st, b));
  PetscCall(MoveState(sph, &sph->stn, b));
  for (int k = 0; k < 3; k++) {
    MoveArray(b, sph->rate.a[k], n);
    MoveArray(b, sph->rate.dv[k], n);
    MoveArray(b, sph->ab[k], n);
  }
  MoveArray(b, sph->rate.ds, n);
  MoveArray(b, sph->m, n);
  MoveArray(b, sph->wallratio, n);
  MoveArray(b, sph->group, n);
  MoveArray(b, sph->id, n);
  MoveArray(b, sph->slot, n);
  if (sph->ops->state) PetscCall((*sph->ops->state)(sph, b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckReady(Sph sph, const char *function)
{
  PetscFunctionBegin;
  PetscCheck(sph->setup && !sph->insidestep, sph->comm, PETSC_ERR_ORDER, "%s() must come after SphSetUp() and between steps",
             function);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphGetStateSize(Sph sph, size_t *bytes)
{
  SphBuffer b = {NULL, 0, 0, SPH_BUFFER_COUNT};

  PetscFunctionBegin;
  PetscCall(CheckReady(sph, "SphGetStateSize"));
  PetscCall(MoveAll(sph, &b));
  *bytes = b.at;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSaveState(Sph sph, size_t bytes, void *buffer)
{
  SphBuffer b = {(char *)buffer, bytes, 0, SPH_BUFFER_SAVE};

  PetscFunctionBegin;
  PetscCall(CheckReady(sph, "SphSaveState"));
  PetscCall((*sph->ops->pull)(sph));
  PetscCall(MoveAll(sph, &b));
  if (!sph->ops->state) PetscCall((*sph->ops->push)(sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphRestoreState(Sph sph, size_t bytes, const void *buffer)
{
  SphBuffer b = {(char *)(size_t)buffer, bytes, 0, SPH_BUFFER_LOAD};

  PetscFunctionBegin;
  PetscCall(CheckReady(sph, "SphRestoreState"));
  PetscCall((*sph->ops->pull)(sph));
  PetscCall(MoveAll(sph, &b));
  if (!sph->ops->state) PetscCall((*sph->ops->push)(sph));
  PetscFunctionReturn(PETSC_SUCCESS);
}
