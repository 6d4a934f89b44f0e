/*
  ancfalpha.c - start and continuation of TSALPHA2, the generalized-alpha method (Chung and Hulbert 1993).

  The method carries an acceleration A from step to step that TS neither accepts nor returns. Left to itself TSALPHA2 guesses
  it from two backward Euler half steps: two more nonlinear solves, and before PETSc 3.22 a guess twice too large, which
  leaves a first-order error in time. A wanted A is set instead through the public interface by one step of the trivial
  problem that produces it:

    during the method's own start (parameters 1, 1, 1, 1/2)   A_a = 0               so it guesses 0, right or not;
    in the step itself                                        A_a = alpha_m A       hence A_1 = A, since A_a = (1 - alpha_m) 0 +
  alpha_m A_1.

  State and time are then put back. A TS with steps of given size makes that step from e = v = 0 with dt = 1 and the parameters
  alpha_m = alpha_f = 1, gamma = beta = 1/2, so that A_1 = 2 e_1 and every operation is exact: A_1 is A to the last bit. An
  adaptive one begins at the state extrapolated backwards, which is the history that its error estimate needs; A_1 is A to
  round-off.

  A is found after each step by the very operations of TSALPHA2 on the same numbers, so that a run that is started again with
  it goes on with the same bits.
*/
#include "ancfimpl.h"

PetscErrorCode AncfAlphaFunction(Ancf ancf, const PetscReal *a, PetscReal *f)
{
  PetscReal am, af, gamma, beta, s;

  PetscFunctionBegin;
  PetscCall(TSAlpha2GetParams(ancf->ts, &am, &af, &gamma, &beta));
  s = am == 1 && af == 1 && gamma == 1 && beta == 0.5 ? 0 : am;
  for (PetscInt i = 0; i < 6 * ancf->nnodes + ancf->nmult; i++) f[i] = a[i] - s * ancf->history[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfAlphaSetUp(Ancf ancf)
{
  const PetscInt n = 6 * ancf->nnodes + ancf->nmult;

  PetscFunctionBegin;
  if (!ancf->history) PetscCall(PetscCalloc3(n, &ancf->history, n, &ancf->eprev, n, &ancf->vprev));
  PetscCall(VecCreateSeqWithArray(ancf->comm, 6, n, ancf->history, &ancf->A));
  PetscCall(VecCreateSeqWithArray(ancf->comm, 6, n, ancf->eprev, &ancf->E0));
  PetscCall(VecCreateSeqWithArray(ancf->comm, 6, n, ancf->vprev, &ancf->V0));
  PetscCall(VecDuplicate(ancf->U, &ancf->work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where the trivial step begins, see above, and its length. */
static PetscErrorCode AncfAlphaPlace(Ancf ancf, PetscReal dt)
{
  const PetscInt n = 6 * ancf->nnodes + ancf->nmult;

  PetscFunctionBegin;
  if (ancf->exact) {
    dt = 1;
    PetscCall(TSAlpha2SetParams(ancf->ts, 1, 1, 0.5, 0.5));
    PetscCall(PetscArrayzero(ancf->e, n));
    PetscCall(PetscArrayzero(ancf->v, n));
  } else
    for (PetscInt i = 0; i < n; i++) {
      ancf->e[i] += dt * (0.5 * dt * ancf->history[i] - ancf->v[i]);
      ancf->v[i] -= dt * ancf->history[i];
    }
  PetscCall(AncfTSTouch(ancf));
  PetscCall(TSSetTime(ancf->ts, ancf->t - dt));
  PetscCall(TSSetMaxTime(ancf->ts, ancf->t));
  PetscCall(TSSetTimeStep(ancf->ts, dt));
  PetscCall(TSRestartStep(ancf->ts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfTSCounts(Ancf ancf, PetscInt n[3])
{
  PetscFunctionBegin;
  PetscCall(TSGetStepNumber(ancf->ts, &n[0]));
  PetscCall(TSGetSNESIterations(ancf->ts, &n[1]));
  PetscCall(TSGetKSPIterations(ancf->ts, &n[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes TSALPHA2 continue from (t, e, v) with the acceleration ancf->history and a previous step of length dt. */
PetscErrorCode AncfAlphaStart(Ancf ancf, PetscReal dt)
{
  const PetscInt n = 6 * ancf->nnodes + ancf->nmult;
  PetscReal *keep, rtol, stol, abstol, am, af, gamma, beta;
  PetscInt before[3], after[3], maxit, maxf;
  TSConvergedReason reason;
  SNES snes;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(2 * (size_t)n, &keep));
  PetscCall(PetscArraycpy(keep, ancf->e, n));
  PetscCall(PetscArraycpy(keep + n, ancf->v, n));
  PetscCall(AncfTSCounts(ancf, before));
  PetscCall(TSAlpha2GetParams(ancf->ts, &am, &af, &gamma, &beta));
  PetscCall(TSGetSNES(ancf->ts, &snes));
  PetscCall(SNESGetTolerances(snes, &abstol, &rtol, &stol, &maxit, &maxf));
  PetscCall(SNESSetTolerances(snes, 0, rtol, stol, maxit, maxf));
  PetscCall(AncfAlphaPlace(ancf, dt));
  ancf->priming = PETSC_TRUE;
  PetscCall(TSStep(ancf->ts));
  ancf->priming = PETSC_FALSE;
  PetscCall(TSGetConvergedReason(ancf->ts, &reason));
  PetscCheck(reason >= 0, ancf->comm, PETSC_ERR_PLIB, "Start of TSALPHA2 failed: %s", TSConvergedReasons[reason]);
  PetscCall(TSAlpha2SetParams(ancf->ts, am, af, gamma, beta));
  PetscCall(SNESSetTolerances(snes, abstol, rtol, stol, maxit, maxf));
  PetscCall(PetscArraycpy(ancf->e, keep, n));
  PetscCall(PetscArraycpy(ancf->v, keep + n, n));
  PetscCall(AncfTSTouch(ancf));
  PetscCall(TSSetTime(ancf->ts, ancf->t));
  PetscCall(PetscFree(keep));
  PetscCall(AncfTSCounts(ancf, after));
  for (int k = 0; k < 3; k++) ancf->uncounted[k] += after[k] - before[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Before a step: remember e and v. */
PetscErrorCode AncfAlphaPreStep(Ancf ancf)
{
  PetscFunctionBegin;
  PetscCall(PetscArraycpy(ancf->eprev, ancf->e, 6 * ancf->nnodes + ancf->nmult));
  PetscCall(PetscArraycpy(ancf->vprev, ancf->v, 6 * ancf->nnodes + ancf->nmult));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  After it: e_1 = e_0 + dt v_0 + dt^2 ((1/2 - beta) A_0 + beta A_1) gives A_1. The operations are those of TSALPHA2 one by one,
  for the same rounding.
*/
PetscErrorCode AncfAlphaPostStep(Ancf ancf)
{
  PetscReal am, af, gamma, beta, dt = ancf->stagedt;

  PetscFunctionBegin;
  PetscCall(TSAlpha2GetParams(ancf->ts, &am, &af, &gamma, &beta));
  PetscCall(VecWAXPY(ancf->work, -1, ancf->E0, ancf->U));
  PetscCall(VecAXPY(ancf->work, -dt, ancf->V0));
  PetscCall(VecAXPBY(ancf->work, -(1 - 2 * beta) / (2 * beta), 1 / (dt * dt * beta), ancf->A));
  PetscCall(VecCopy(ancf->work, ancf->A));
  PetscFunctionReturn(PETSC_SUCCESS);
}
