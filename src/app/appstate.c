/* appstate.c - the state of a run as named arrays in memory: between the solvers and a checkpoint file. */
#include "app.h"
#include <math.h>
#include <string.h>

/* The next array of this name: states are moved in one order, so that it is nearly always the one after the last. */
static StateArray *find(AppState *s, const char name[])
{
  for (PetscInt i = 0; i < s->n; i++) {
    StateArray *a = &s->array[(s->at + i) % s->n];
    if (strcmp(a->name, name)) continue;
    s->at = (PetscInt)(a - s->array) + 1;
    return a;
  }
  return NULL;
}

/* A new array of n values at the end, or the memory of the one that was there. */
PetscErrorCode AppStateAdd(AppState *s, const char name[], FrondStateType type, size_t n, void **data)
{
  StateArray *a;

  PetscFunctionBegin;
  if (s->n == s->alloc) {
    const PetscInt alloc = 2 * s->alloc + 64;
    PetscCall(PetscRealloc((size_t)alloc * sizeof(StateArray), &s->array));
    PetscCall(PetscMemzero(s->array + s->alloc, (size_t)(alloc - s->alloc) * sizeof(StateArray)));
    s->alloc = alloc;
  }
  a = &s->array[s->n++];
  PetscCall(PetscStrncpy(a->name, name, sizeof(a->name)));
  a->type = type;
  a->n = n;
  if (n * FrondStateSize(type) > a->bytes) {
    PetscCall(PetscFree(a->data));
    a->bytes = 0;
    PetscCall(PetscMalloc(n * FrondStateSize(type), &a->data));
    a->bytes = n * FrondStateSize(type);
  }
  *data = a->data;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Widths of integers may differ between the programs that write and read. */
static PetscErrorCode load_int(const StateArray *a, FrondStateType type, void *x)
{
  PetscFunctionBegin;
  for (size_t i = 0; i < a->n; i++) {
    const int64_t v = a->type == FROND_INT64 ? ((const int64_t *)a->data)[i] : ((const int32_t *)a->data)[i];
    PetscCheck(type == FROND_INT64 || (v >= INT32_MIN && v <= INT32_MAX), PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
               "the checkpoint's %s has a number that is too large for this build", a->name);
    if (type == FROND_INT64)
      ((int64_t *)x)[i] = v;
    else
      ((int32_t *)x)[i] = (int32_t)v;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode move(FrondState *state, const char name[], FrondStateType type, size_t n, void *x)
{
  AppState *s = (AppState *)state;
  const StateArray *a;
  void *data;

  PetscFunctionBegin;
  if (state->way == FROND_STATE_SAVE) {
    PetscCall(AppStateAdd(s, name, type, n, &data));
    if (n) PetscCall(PetscMemcpy(data, x, n * FrondStateSize(type)));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  a = find(s, name);
  PetscCheck(a, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED, "the checkpoint has no %s: it is of another scene or version", name);
  PetscCheck(a->n == n, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
             "the checkpoint's %s has %zu values, this scene needs %zu: it is of another scene", name, a->n, n);
  PetscCheck((a->type == FROND_REAL64) == (type == FROND_REAL64), PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
             "the checkpoint's %s is of another type", name);
  if (a->type != type)
    PetscCall(load_int(a, type, x));
  else if (n)
    PetscCall(PetscMemcpy(x, a->data, n * FrondStateSize(type)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode has(FrondState *state, const char name[], PetscBool *yes)
{
  PetscFunctionBegin;
  *yes = find((AppState *)state, name) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ready for saving into (anew) or loading from. */
FrondState *AppStateBegin(AppState *s, FrondStateWay way)
{
  s->state.way = way;
  s->state.move = move;
  s->state.has = has;
  s->at = 0;
  if (way == FROND_STATE_SAVE) s->n = 0;
  return &s->state;
}

/* The name of the first array that holds a value that is not finite, or NULL. */
const char *AppStateNotFinite(const AppState *s)
{
  for (PetscInt i = 0; i < s->n; i++) {
    const StateArray *a = &s->array[i];
    const double *x = (const double *)a->data;
    double sum = 0;
    if (a->type != FROND_REAL64) continue;
    for (size_t k = 0; k < a->n; k++) sum += 0 * x[k];
    if (sum != 0) return a->name;
  }
  return NULL;
}

PetscErrorCode AppStateDestroy(AppState *s)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->alloc; i++) PetscCall(PetscFree(s->array[i].data));
  PetscCall(PetscFree(s->array));
  PetscCall(PetscMemzero(s, sizeof(*s)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The one list of what a scene's solvers carry from step to step. */
PetscErrorCode AppMoveState(App *app, FrondState *s)
{
  PetscFunctionBegin;
  FrondMoveReal(s, "run/time", &app->t, 1);
  FrondMoveInt(s, "run/step", &app->step, 1);
  if (app->couple) PetscCall(CoupleMoveState(app->couple, s));
  /* beams and bodies that are coupled are in the coupling's state; counts of iterations are not */
  if (app->ancf) PetscCall(app->couple ? AncfMoveCounts(app->ancf, s) : AncfMoveState(app->ancf, s));
  if (app->rigid && !app->couple) PetscCall(RigidMoveState(app->rigid, s));
  if (app->attach && !app->couple) PetscCall(CoupleAttachMoveState(app->attach, s));
  if (app->shortrange && !app->couple) PetscCall(CoupleShortMoveState(app->shortrange, s));
  if (app->ancf) FrondMoveReal(s, "run/beam_torque", app->beamtorque, 3);
  if (app->ancf) FrondMoveReal(s, "run/beam_turn", app->beamturn, 3);
  PetscFunctionReturn(PETSC_SUCCESS);
}
