/*
  ancfalpha.c - start and continuation of TSALPHA2, the generalized-alpha method (Chung and Hulbert 1993).

  The method carries an acceleration A from step to step that TS neither accepts nor returns. Left to itself TSALPHA2 guesses
  it from two backward Euler half steps: two more nonlinear solves, and before PETSc 3.22 a guess twice too large, which
  leaves a first-order error in time. A wanted A is set instead through the public interface by one step of the trivial
  problem that produces it, from t - dt to t:

    during the method's own start (parameters 1, 1, 1, 1/2)   A_a = 0               so it guesses 0, right or not;
    in the step itself                                        A_a = alpha_m A       hence A_1 = A, since A_a = (1 - alpha_m) 0 +
  alpha_m A_1.

  State and time are then put back. The step begins at the state extrapolated backwards, which is the history that the
  error estimate of an adaptive TS needs.
*/
#include "ancfimpl.h"

PetscErrorCode AncfAlphaFunction(Ancf ancf, const PetscReal *a, PetscReal *f)
{
  PetscReal am, af, gamma, beta, s;

  PetscFunctionBegin;
  PetscCall(TSAlpha2GetParams(ancf->ts, &am, &af, &gamma, &beta));
  s = am == 1 && af == 1 && gamma == 1 && beta == 0.5 ? 0 : am;
  for (PetscInt i = 0; i < 6 * ancf->nnodes; i++) f[i] = a[i] - s * ancf->history[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes TSALPHA2 continue from (t, e, v) with the acceleration ancf->history and a previous step of length dt. */
PetscErrorCode AncfAlphaStart(Ancf ancf, PetscReal dt)
{
  const PetscInt n = 6 * ancf->nnodes;
  PetscReal *keep, rtol, stol, abstol;
  PetscInt before[3], after[3], maxit, maxf;
  TSConvergedReason reason;
  SNES snes;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(2 * n, &keep));
  PetscCall(PetscArraycpy(keep, ancf->e, n));
  PetscCall(PetscArraycpy(keep + n, ancf->v, n));
  PetscCall(TSGetStepNumber(ancf->ts, &before[0]));
  PetscCall(TSGetSNESIterations(ancf->ts, &before[1]));
  PetscCall(TSGetKSPIterations(ancf->ts, &before[2]));
  for (PetscInt i = 0; i < n; i++) {
    ancf->e[i] += dt * (0.5 * dt * ancf->history[i] - ancf->v[i]);
    ancf->v[i] -= dt * ancf->history[i];
  }
  PetscCall(AncfTSTouch(ancf));
  PetscCall(TSGetSNES(ancf->ts, &snes));
  PetscCall(SNESGetTolerances(snes, &abstol, &rtol, &stol, &maxit, &maxf));
  PetscCall(SNESSetTolerances(snes, 0, rtol, stol, maxit, maxf));
  PetscCall(TSSetTime(ancf->ts, ancf->t - dt));
  PetscCall(TSSetMaxTime(ancf->ts, ancf->t));
  PetscCall(TSSetTimeStep(ancf->ts, dt));
  PetscCall(TSRestartStep(ancf->ts));
  ancf->priming = PETSC_TRUE;
  PetscCall(TSStep(ancf->ts));
  ancf->priming = PETSC_FALSE;
  PetscCall(TSGetConvergedReason(ancf->ts, &reason));
  PetscCheck(reason >= 0, ancf->comm, PETSC_ERR_PLIB, "Start of TSALPHA2 failed: %s", TSConvergedReasons[reason]);
  PetscCall(SNESSetTolerances(snes, abstol, rtol, stol, maxit, maxf));
  PetscCall(PetscArraycpy(ancf->e, keep, n));
  PetscCall(PetscArraycpy(ancf->v, keep + n, n));
  PetscCall(AncfTSTouch(ancf));
  PetscCall(TSSetTime(ancf->ts, ancf->t));
  PetscCall(PetscFree(keep));
  PetscCall(TSGetStepNumber(ancf->ts, &after[0]));
  PetscCall(TSGetSNESIterations(ancf->ts, &after[1]));
  PetscCall(TSGetKSPIterations(ancf->ts, &after[2]));
  for (int k = 0; k < 3; k++) ancf->uncounted[k] += after[k] - before[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Before a step: remember v. */
PetscErrorCode AncfAlphaPreStep(Ancf ancf)
{
  PetscFunctionBegin;
  PetscCall(PetscArraycpy(ancf->vprev, ancf->v, 6 * ancf->nnodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After it: v_1 = v_0 + dt ((1 - gamma) A_0 + gamma A_1) gives A_1. */
PetscErrorCode AncfAlphaPostStep(Ancf ancf)
{
  PetscReal am, af, gamma, beta, t, t0, c, d;

  PetscFunctionBegin;
  PetscCall(TSAlpha2GetParams(ancf->ts, &am, &af, &gamma, &beta));
  PetscCall(TSGetTime(ancf->ts, &t));
  PetscCall(TSGetPrevTime(ancf->ts, &t0));
  c = 1 / (gamma * (t - t0));
  d = (1 - gamma) / gamma;
  for (PetscInt i = 0; i < 6 * ancf->nnodes; i++) ancf->history[i] = c * (ancf->v[i] - ancf->vprev[i]) - d * ancf->history[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}
