/*
  ancfpack.c - all that the beams carry from step to step as one array, and back.

  TSALPHA2 with steps of given size, backward Euler, Crank-Nicolson, Euler and the symplectic methods remember e, v and at most
  an acceleration, which is here (ancfalpha.c): packing changes nothing, and a run that is continued from a packed state has the
  bits of one that was not interrupted. Other types, and constraints with multipliers, have memory that TS does not give away:
  they begin anew at what is packed, when it is packed and when it is unpacked, so that these two go on alike.
*/
#include "ancfimpl.h"

/* Time, whether the acceleration is there, step wanted, time of the motion, whether supports move. */
#define PACK_HEAD 5

/* The arrays of a node in this order, widths in reals; NULL for those not in use. */
#define PACK_ARRAYS 6
static void PackArrays(Ancf ancf, PetscReal *p[PACK_ARRAYS], int width[PACK_ARRAYS])
{
  p[0] = ancf->e, p[1] = ancf->v, p[2] = ancf->load, p[3] = ancf->rest, p[4] = ancf->history, p[5] = ancf->motion;
  for (int k = 0; k < PACK_ARRAYS; k++) width[k] = k == 5 ? 18 : 6;
}

PetscErrorCode AncfGetPackSize(Ancf ancf, PetscInt *n)
{
  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfGetPackSize: call AncfSetUp() first");
  *n = PACK_HEAD + (5 * 6 + 18 + 1) * ancf->nnodes + ancf->nmult;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfGetPackExact(Ancf ancf, PetscBool *exact)
{
  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfGetPackExact: call AncfSetUp() first");
  *exact = ancf->exact;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The multipliers, from which the next step's Newton iterations start, behind all else. */
static PetscErrorCode MoveMultipliers(Ancf ancf, PetscReal state[], PetscBool load)
{
  PetscReal *in = state + PACK_HEAD + (5 * 6 + 18 + 1) * ancf->nnodes;
  const PetscInt at = (ancf->form == ANCF_FORM_SECOND ? 6 : 12) * ancf->nnodes;
  PetscScalar *y;

  PetscFunctionBegin;
  if (!ancf->nmult) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArray(ancf->U, &y));
  if (load)
    PetscCall(PetscArraycpy(y + at, in, ancf->nmult));
  else
    PetscCall(PetscArraycpy(in, y + at, ancf->nmult));
  PetscCall(VecRestoreArray(ancf->U, &y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfPack(Ancf ancf, PetscReal state[])
{
  PetscReal *p[PACK_ARRAYS], *s = state + PACK_HEAD;
  int width[PACK_ARRAYS];

  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfPack: call AncfSetUp() first");
  PetscCheck(!ancf->linear, ancf->comm, PETSC_ERR_ARG_WRONGSTATE,
             "AncfPack: loads that vary over the step to come cannot be packed");
  state[0] = ancf->t;
  state[1] = ancf->history && !(ancf->restart && !ancf->given);
  state[2] = ancf->step;
  state[3] = ancf->motiontime;
  state[4] = ancf->motion != NULL;
  PackArrays(ancf, p, width);
  for (int k = 0; k < PACK_ARRAYS; k++, s += width[k - 1] * ancf->nnodes) {
    if (p[k])
      PetscCall(PetscArraycpy(s, p[k], width[k] * ancf->nnodes));
    else
      PetscCall(PetscArrayzero(s, width[k] * ancf->nnodes));
  }
  for (PetscInt j = 0; j < ancf->nnodes; j++) s[j] = ancf->fixed[j];
  PetscCall(MoveMultipliers(ancf, state, PETSC_FALSE));
  if (!ancf->exact) PetscCall(AncfUnpack(ancf, state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfUnpack(Ancf ancf, const PetscReal state[])
{
  PetscReal *p[PACK_ARRAYS];
  const PetscReal *s = state + PACK_HEAD;
  int width[PACK_ARRAYS];

  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfUnpack: call AncfSetUp() first");
  if (state[4] != 0) PetscCall(AncfMotionCreate(ancf));
  PackArrays(ancf, p, width);
  for (int k = 0; k < PACK_ARRAYS; k++, s += width[k - 1] * ancf->nnodes)
    if (p[k] && k != 4) PetscCall(PetscArraycpy(p[k], s, width[k] * ancf->nnodes));
  for (PetscInt j = 0; j < ancf->nnodes; j++) ancf->fixed[j] = (unsigned char)s[j];
  PetscCall(AncfCheckFinite(ancf, "position", ancf->e, state[0]));
  PetscCall(AncfCheckFinite(ancf, "velocity", ancf->v, state[0]));
  ancf->t = state[0];
  ancf->motiontime = state[3];
  for (PetscInt k = 0; k < ancf->ngroups; k++) {
    ancf->groups[k]->motiontime = state[3];
    ancf->groups[k]->step = ancf->exact ? ancf->groups[k]->step : 0;
  }
  ancf->linear = ancf->avalid = PETSC_FALSE;
  ancf->loadnow = 0;
  PetscCall(AncfTSPush(ancf));
  PetscCall(MoveMultipliers(ancf, (PetscReal *)(size_t)state, PETSC_TRUE));
  ancf->step = state[2];
  if (ancf->history && state[1] != 0) {
    PetscCall(PetscArraycpy(ancf->history, state + PACK_HEAD + 24 * ancf->nnodes, 6 * ancf->nnodes));
    ancf->given = PETSC_TRUE;
  }
  AncfMove(ancf, ancf->t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Steps, Newton and linear iterations of each TS so far; loading makes the counts go on from there. */
static PetscErrorCode MoveCounts(Ancf ancf, FrondState *s, PetscInt k)
{
  PetscInt n[3], total[3];
  char name[64];

  PetscFunctionBegin;
  PetscCall(AncfTSCounts(ancf, total));
  for (int i = 0; i < 3; i++) n[i] = total[i] - ancf->uncounted[i];
  PetscCall(PetscSNPrintf(name, sizeof(name), "beams/counts_%" PetscInt_FMT, k));
  FrondMoveInt(s, name, n, 3);
  for (int i = 0; i < 3 && s->way == FROND_STATE_LOAD; i++) ancf->uncounted[i] = total[i] - n[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfMoveCounts(Ancf ancf, FrondState *s)
{
  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfMoveCounts: call AncfSetUp() first");
  for (PetscInt k = 0; k < PetscMax(1, ancf->ngroups); k++) PetscCall(MoveCounts(ancf->ngroups ? ancf->groups[k] : ancf, s, k));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfMoveState(Ancf ancf, FrondState *s)
{
  PetscReal *x = NULL;
  const FrondStateWay way = s->way;
  PetscInt n;

  PetscFunctionBegin;
  PetscCall(AncfGetPackSize(ancf, &n));
  if (way != FROND_STATE_COUNT) PetscCall(PetscMalloc1(n, &x));
  if (way == FROND_STATE_SAVE) PetscCall(AncfPack(ancf, x));
  FrondMoveReal(s, "beams/state", x, n);
  if (way == FROND_STATE_LOAD) PetscCall(AncfUnpack(ancf, x));
  PetscCall(PetscFree(x));
  PetscCall(AncfMoveCounts(ancf, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
