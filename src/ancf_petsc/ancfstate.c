/* ancfstate.c - state, loads and their history: reading, replacing, saving and restoring. */
#include "ancfimpl.h"

/* PETSC_ERR_FP with beam, node and time when an array of nodes x 6 holds a NaN or an infinity. */
PetscErrorCode AncfCheckFinite(Ancf ancf, const char what[], const PetscReal *x, PetscReal t)
{
  const PetscInt n = 6 * ancf->nnodes;
  PetscReal part[6] = {0}, sum; /* several sums: additions need not wait for one another */

  PetscFunctionBegin;
  for (PetscInt i = 0; i < n; i += 6)
    for (int c = 0; c < 6; c++) part[c] += 0 * x[i + c]; /* NaN if any is not finite */
  sum = part[0] + part[1] + part[2] + part[3] + part[4] + part[5];
  if (PetscLikely(sum == 0)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < 6 * ancf->nnodes; i++) {
    PetscInt b;

    if (PetscLikely(!PetscIsInfOrNanReal(x[i]))) continue;
    b = AncfFindBeam(ancf, i / 6);
    SETERRQ(ancf->comm, PETSC_ERR_FP,
            "Beam %" PetscInt_FMT ", node %" PetscInt_FMT ": %s coordinate %" PetscInt_FMT " is %g at t = %g s",
            ancf->firstbeam + b, i / 6 - ancf->beams[b].node, what, i % 6, (double)x[i], (double)t);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfGetState(Ancf ancf, PetscReal *t, const PetscReal **e, const PetscReal **edot, const PetscReal **eddot)
{
  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfGetState: call AncfSetUp() first");
  if (eddot) PetscCall(AncfComputeAcceleration(ancf));
  if (t) *t = ancf->t;
  if (e) *e = ancf->e;
  if (edot) *edot = ancf->v;
  if (eddot) *eddot = ancf->a;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfStateStore(Ancf ancf, PetscReal *x)
{
  const PetscInt n = 6 * ancf->nnodes;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(x, ancf->e, n));
  PetscCall(PetscArraycpy(x + n, ancf->v, n));
  if (ancf->history) PetscCall(PetscArraycpy(x + 2 * n, ancf->history, n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfStateLoad(Ancf ancf, PetscReal t, const PetscReal *x)
{
  const PetscInt n = 6 * ancf->nnodes;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(ancf->e, x, n));
  PetscCall(PetscArraycpy(ancf->v, x + n, n));
  ancf->t = t;
  ancf->avalid = PETSC_FALSE;
  PetscCall(AncfTSPush(ancf));
  if (ancf->history) {
    PetscCall(PetscArraycpy(ancf->history, x + 2 * n, n));
    ancf->given = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfSaveState(Ancf ancf)
{
  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfSaveState: call AncfSetUp() first");
  if (!ancf->saved) PetscCall(PetscMalloc1(18 * (size_t)ancf->nnodes, &ancf->saved));
  if (ancf->restart && ancf->history && !ancf->given) { /* nothing carried yet: what the next step would start from */
    PetscCall(AncfComputeAcceleration(ancf));
    PetscCall(PetscArraycpy(ancf->history, ancf->a, 6 * ancf->nnodes));
  }
  PetscCall(AncfStateStore(ancf, ancf->saved));
  ancf->savedtime = ancf->t;
  ancf->savedstep = ancf->step;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfRestoreState(Ancf ancf)
{
  PetscFunctionBegin;
  PetscCheck(ancf->saved, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfRestoreState: call AncfSaveState() first");
  PetscCall(AncfStateLoad(ancf, ancf->savedtime, ancf->saved));
  ancf->step = ancf->savedstep;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfGetHistory(Ancf ancf, const PetscReal **A)
{
  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfGetHistory: call AncfSetUp() first");
  *A = ancf->restart && !ancf->given ? NULL : ancf->history;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfSetHistory(Ancf ancf, const PetscReal *A)
{
  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfSetHistory: call AncfSetUp() first");
  if (!ancf->history || !A) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AncfCheckFinite(ancf, "acceleration", A, ancf->t));
  PetscCall(AncfTSPush(ancf));
  PetscCall(PetscArraycpy(ancf->history, A, 6 * ancf->nnodes));
  ancf->given = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  AncfSetState - replaces time, coordinates and velocities (nodes x 6 each); multistep history is discarded.
  Fixed coordinates keep their new values from now on; their velocities must be zero unless the node moves.
*/
PetscErrorCode AncfSetState(Ancf ancf, PetscReal t, const PetscReal *e, const PetscReal *edot)
{
  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfSetState: call AncfSetUp() first");
  PetscCheck(!PetscIsInfOrNanReal(t), ancf->comm, PETSC_ERR_ARG_OUTOFRANGE, "AncfSetState: time %g must be finite", (double)t);
  PetscCall(AncfCheckFinite(ancf, "position", e, t));
  PetscCall(AncfCheckFinite(ancf, "velocity", edot, t));
  for (PetscInt i = 0; i < 6 * ancf->nnodes; i++) {
    PetscInt b = AncfFindBeam(ancf, i / 6);

    PetscCheck(edot[i] == 0 || ancf->fixed[i / 6] & ANCF_MOVING ||
                   !(ancf->fixed[i / 6] & (i % 6 < 3 ? ANCF_FIX_POSITION : ANCF_FIX_GRADIENT)),
               ancf->comm, PETSC_ERR_ARG_INCOMP,
               "AncfSetState: beam %" PetscInt_FMT ", node %" PetscInt_FMT ": velocity %g of a fixed coordinate must be zero", b,
               i / 6 - ancf->beams[b].node, (double)edot[i]);
  }
  if (ancf->njoints) PetscCall(AncfJointCheck(ancf, "AncfSetState", e, edot));
  if (e != ancf->e) PetscCall(PetscArraycpy(ancf->e, e, 6 * ancf->nnodes));
  if (edot != ancf->v) PetscCall(PetscArraycpy(ancf->v, edot, 6 * ancf->nnodes));
  PetscCall(PetscArraycpy(ancf->rest, e, 6 * ancf->nnodes));
  for (PetscInt i = 0; i < 6 * ancf->nnodes && ancf->motion; i++) {
    ancf->motion[18 * (i / 6) + i % 6] = e[i];
    ancf->motion[18 * (i / 6) + 6 + i % 6] = edot[i];
  }
  ancf->t = ancf->motiontime = t;
  for (PetscInt k = 0; k < ancf->ngroups; k++) ancf->groups[k]->motiontime = t;
  ancf->avalid = PETSC_FALSE;
  PetscCall(AncfTSPush(ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfZeroLoads(Ancf ancf)
{
  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfZeroLoads: call AncfSetUp() first");
  PetscCall(PetscArrayzero(ancf->load, 6 * ancf->nnodes));
  ancf->linear = PETSC_FALSE;
  ancf->loadnow = 0;
  ancf->avalid = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfGetLoads(Ancf ancf, PetscReal **Q)
{
  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfGetLoads: call AncfSetUp() first");
  *Q = ancf->load;
  ancf->linear = PETSC_FALSE;
  ancf->loadnow = 0;
  ancf->avalid = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfGetLoadsEnd(Ancf ancf, PetscReal **Q)
{
  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfGetLoadsEnd: call AncfSetUp() first");
  if (!ancf->loadend) PetscCall(PetscMalloc1(6 * (size_t)ancf->nnodes, &ancf->loadend));
  if (!ancf->linear) PetscCall(PetscArraycpy(ancf->loadend, ancf->load, 6 * ancf->nnodes));
  *Q = ancf->loadend;
  ancf->linear = PETSC_TRUE;
  ancf->loadnow = 0;
  ancf->avalid = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void AncfSetLoadTime(Ancf ancf, PetscReal t)
{
  AncfMove(ancf, t);
  ancf->loadnow = ancf->linear ? (t - ancf->loadtime[0]) / (ancf->loadtime[1] - ancf->loadtime[0]) : 0;
}
