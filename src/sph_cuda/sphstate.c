/*
  sphstate.c - the whole state of the fluid and back: rollback of a step, checkpoints.

  Everything that the next step depends on, in the order of the arrays: sums over neighbours then run in the same order and
  give the same bits. A backend's search structure goes along; another backend that reads the state makes its own anew.
*/
#include "sphimpl.h"
#include "sphopenimpl.h"

static PetscErrorCode CheckReady(Sph sph, const char *function)
{
  PetscFunctionBegin;
  PetscCheck(sph->setup && !sph->insidestep, sph->comm, PETSC_ERR_ORDER, "%s() must come after SphSetUp() and between steps",
             function);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MoveCounts(Sph sph, FrondState *s)
{
  const PetscInt n0 = sph->n, g0 = sph->ngroups;
  PetscInt n = n0, groups = g0;

  PetscFunctionBegin;
  FrondMoveInt(s, "fluid/markers", &n, 1);
  FrondMoveInt(s, "fluid/groups", &groups, 1);
  PetscCheck(n == n0 && groups == g0, sph->comm, PETSC_ERR_ARG_SIZ,
             "the saved fluid has %" PetscInt_FMT " markers in %" PetscInt_FMT " groups, this one %" PetscInt_FMT
             " in %" PetscInt_FMT,
             n, groups, n0, g0);
  FrondMoveReal(s, "fluid/time", &sph->t, 1);
  FrondMoveReal(s, "fluid/dt", &sph->dt, 1);
  FrondMoveInt(s, "fluid/step", &sph->step, 1);
  FrondMoveInt(s, "fluid/left", &sph->left, 1);
  FrondMoveReal(s, "fluid/evaluations", &sph->evaluations, 1);
  FrondMoveReal(s, "fluid/speed_warned", &sph->speedwarned, 1);
  FrondMoveBool(s, "fluid/step_warned", &sph->fixedwarned);
  FrondMoveInt(s, "fluid/verlet_step", &sph->verletstep, 1);
  FrondMoveReal(s, "fluid/verlet_dt", &sph->dtold, 1);
  FrondMoveReal(s, "fluid/verlet_span", &sph->verletspan, 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* As doubles, whatever they are kept as, and zeros where there is nothing: every backend and precision reads the same arrays. */
static PetscErrorCode MoveValues(Sph sph, FrondState *s, const char name[], const SphValues *x)
{
  double *wide = NULL;

  PetscFunctionBegin;
  if (!x->d && s->way != FROND_STATE_COUNT) PetscCall(PetscMalloc1(sph->n, &wide));
  for (PetscInt i = 0; i < sph->n && wide && s->way == FROND_STATE_SAVE; i++) wide[i] = SphValue(x, i);
  FrondMoveReal(s, name, x->d ? x->d : wide, sph->n);
  for (PetscInt i = 0; i < sph->n && wide && s->way == FROND_STATE_LOAD; i++) SphSetValue(x, i, wide[i]);
  PetscCall(PetscFree(wide));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MoveArray(Sph sph, FrondState *s, const char name[], double *x)
{
  const SphValues values = {x, NULL};

  PetscFunctionBegin;
  PetscCall(MoveValues(sph, s, name, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MoveRates(Sph sph, FrondState *s, const char stem[], const SphValues x[3])
{
  char name[64];

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "fluid/%s_%c", stem, "xyz"[k]));
    PetscCall(MoveValues(sph, s, name, &x[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MoveVector(Sph sph, FrondState *s, const char stem[], double *const x[3])
{
  const SphValues values[3] = {{x[0], NULL}, {x[1], NULL}, {x[2], NULL}};

  PetscFunctionBegin;
  PetscCall(MoveRates(sph, s, stem, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SphMoveState - The one list of what makes up the state of the fluid, between two steps; see frondstate.h.

  Errors: inside a step; PETSC_ERR_ARG_SIZ when the state loaded is not of this many markers and groups.
@*/
PetscErrorCode SphMoveState(Sph sph, FrondState *s)
{
  PetscFunctionBegin;
  PetscCall(CheckReady(sph, "SphMoveState"));
  if (s->way != FROND_STATE_COUNT) PetscCall((*sph->ops->pull)(sph));
  PetscCall(MoveCounts(sph, s));
  PetscCall(MoveVector(sph, s, "position", sph->st.x));
  PetscCall(MoveVector(sph, s, "velocity", sph->st.v));
  PetscCall(MoveArray(sph, s, "fluid/compression", sph->st.s));
  if (sph->par.integrator == SPH_INTEGRATOR_VERLET) { /* the others begin each step from the state alone */
    PetscCall(MoveVector(sph, s, "old_velocity", sph->stn.v));
    PetscCall(MoveArray(sph, s, "fluid/old_compression", sph->stn.s));
  }
  PetscCall(MoveRates(sph, s, "acceleration", sph->rate.a));
  PetscCall(MoveRates(sph, s, "xsph_velocity", sph->rate.dv));
  PetscCall(MoveValues(sph, s, "fluid/compression_rate", &sph->rate.ds));
  PetscCall(MoveVector(sph, s, "boundary_acceleration", sph->ab));
  PetscCall(MoveArray(sph, s, "fluid/mass", sph->m));
  PetscCall(MoveArray(sph, s, "fluid/wall_ratio", sph->wallratio));
  if (sph->omega) FrondMoveReal(s, "fluid/boundary_rotation", sph->omega, 3 * (sph->n - sph->nfluid));
  FrondMoveInt32(s, "fluid/group", sph->group, sph->n);
  FrondMoveInt32(s, "fluid/id", sph->id, sph->n);
  FrondMoveInt32(s, "fluid/slot", sph->slot, sph->n);
  if (sph->ops->state) PetscCall((*sph->ops->state)(sph, s));
  if (!sph->ops->state && s->way != FROND_STATE_COUNT) PetscCall((*sph->ops->push)(sph));
  PetscCall(SphLinksState(sph, s));
  PetscCall(SphOpeningsState(sph, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphMoveGrid(FrondState *s, const char search[], SphGrid *g)
{
  double real[9];
  int number[6];
  char name[64];

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    real[k] = g->lo[k], real[3 + k] = g->edge[k], real[6 + k] = g->length[k];
    number[k] = g->n[k], number[3 + k] = g->periodic[k];
  }
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/grid", search));
  FrondMoveReal(s, name, real, 9);
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s/cells", search));
  FrondMoveInt32(s, name, number, 6);
  for (int k = 0; k < 3 && s->way == FROND_STATE_LOAD; k++) {
    g->lo[k] = real[k], g->edge[k] = real[3 + k], g->length[k] = real[6 + k];
    g->n[k] = number[k], g->periodic[k] = number[3 + k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphGetStateSize(Sph sph, size_t *bytes)
{
  FrondStateBuffer b = FrondStateBufferMake(FROND_STATE_COUNT, 0, NULL);

  PetscFunctionBegin;
  PetscCall(SphMoveState(sph, &b.state));
  *bytes = b.at;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSaveState(Sph sph, size_t bytes, void *buffer)
{
  FrondStateBuffer b = FrondStateBufferMake(FROND_STATE_SAVE, bytes, buffer);

  PetscFunctionBegin;
  PetscCall(SphMoveState(sph, &b.state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphRestoreState(Sph sph, size_t bytes, const void *buffer)
{
  FrondStateBuffer b = FrondStateBufferMake(FROND_STATE_LOAD, bytes, (void *)(size_t)buffer);

  PetscFunctionBegin;
  PetscCall(SphMoveState(sph, &b.state));
  PetscFunctionReturn(PETSC_SUCCESS);
}
