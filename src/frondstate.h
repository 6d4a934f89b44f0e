/*
  frondstate.h - the state of a solver as a list of named arrays.

  Each part lists its state once, in XMoveState(part, state): one FrondMove line for each array. What happens to the arrays is up
  to the `state` given: they are counted, copied to memory or a file, or set from there (checkpoints, rollback of a step). Names
  are paths such as fluid/velocity_x, the same for every backend; arrays that only one backend has are asked for with has().
*/
#ifndef FRONDSTATE_H
#define FRONDSTATE_H

#include "frondsys.h"
#include <stdint.h>
#include <string.h>

/* Types of the arrays. */
typedef enum { FROND_INT32, FROND_INT64, FROND_REAL64 } FrondStateType;
#define FROND_INT (sizeof(PetscInt) == 8 ? FROND_INT64 : FROND_INT32)
/* Count: sizes only, no data is touched. Save: data goes out. Load: data comes in. */
typedef enum { FROND_STATE_COUNT, FROND_STATE_SAVE, FROND_STATE_LOAD } FrondStateWay;

typedef struct _FrondState FrondState;
struct _FrondState {
  FrondStateWay way;
  /* Move n values at x (NULL allowed when counting). Errors when loading: PETSC_ERR_ARG_SIZ naming an array of another length. */
  PetscErrorCode (*move)(FrondState *, const char name[], FrondStateType type, size_t n, void *x);
  /* When loading: whether there is an array of this name. */
  PetscErrorCode (*has)(FrondState *, const char name[], PetscBool *yes);
};

static inline size_t FrondStateSize(FrondStateType type)
{
  return type == FROND_INT32 ? 4 : 8;
}

/* n values each; x is a pointer of the type named. */
#define FrondMoveReal(s, name, x, n) PetscCall((*(s)->move)(s, name, FROND_REAL64, (size_t)(n), x))
#define FrondMoveInt(s, name, x, n) PetscCall((*(s)->move)(s, name, FROND_INT, (size_t)(n), x))
#define FrondMoveInt32(s, name, x, n) PetscCall((*(s)->move)(s, name, FROND_INT32, (size_t)(n), x))
/* One PetscBool, whose size depends on the version of PETSc, as an int32. */
#define FrondMoveBool(s, name, x) PetscCall(FrondStateBool(s, name, x))

static inline PetscErrorCode FrondStateBool(FrondState *s, const char name[], PetscBool *x)
{
  int32_t value = *x ? 1 : 0;

  PetscFunctionBegin;
  FrondMoveInt32(s, name, &value, 1);
  *x = value ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All arrays one after the other in one piece of memory, without names: for going back within a run. */
typedef struct {
  FrondState state; /* first: a pointer to it is one to the whole */
  char *p;
  size_t size, at; /* bytes there are, bytes moved */
} FrondStateBuffer;

static inline PetscErrorCode FrondStateBufferMove(FrondState *s, const char name[], FrondStateType type, size_t n, void *x)
{
  FrondStateBuffer *b = (FrondStateBuffer *)s;
  const size_t bytes = n * FrondStateSize(type);

  PetscFunctionBegin;
  (void)name;
  if (s->way != FROND_STATE_COUNT) {
    PetscCheck(b->at + bytes <= b->size, PETSC_COMM_SELF, PETSC_ERR_ARG_SIZ, "the buffer of a state has %zu bytes; it needs more",
               b->size);
    if (s->way == FROND_STATE_SAVE && bytes)
      memcpy(b->p + b->at, x, bytes);
    else if (bytes)
      memcpy(x, b->p + b->at, bytes);
  }
  b->at += bytes;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscErrorCode FrondStateBufferHas(FrondState *s, const char name[], PetscBool *yes)
{
  (void)s;
  (void)name;
  *yes = PETSC_TRUE;
  return PETSC_SUCCESS;
}

static inline FrondStateBuffer FrondStateBufferMake(FrondStateWay way, size_t size, void *p)
{
  FrondStateBuffer b;

  b.state.way = way;
  b.state.move = FrondStateBufferMove;
  b.state.has = FrondStateBufferHas;
  b.p = (char *)p;
  b.size = size;
  b.at = 0;
  return b;
}

#endif
