/* ancfadvance.c - one call of AncfAdvance(): repeated TSSolve(), Newton's tolerances, and what is said when a step fails. */
#include "ancfimpl.h"

/*
  Newton cannot reduce the residual below the round-off of its largest terms: the axial force EA and the inertia of the
  eliminated step, about rhoA l |r| 4/dt^2. Below a few ulps of these the iterate is as good as it gets.
*/
static PetscErrorCode AncfSetNewtonFloor(Ancf ancf, PetscReal dt)
{
  PetscReal scale = 0, size = 0, abstol, rtol, stol;
  PetscInt maxit, maxf;
  SNES snes;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < ancf->nnodes; j++)
    for (PetscInt c = 0; c < 3; c++) size = PetscMax(size, PetscAbsReal(ancf->e[6 * j + c]));
  for (PetscInt b = 0; b < ancf->nbeams; b++) {
    const AncfBeam *m = &ancf->beams[b];

    scale = PetscMax(scale, m->EA + m->rhoA * m->l * size * 4 / (dt * dt));
  }
  abstol = 4 * PETSC_MACHINE_EPSILON * scale * PetscSqrtReal((PetscReal)ancf->nnodes);
  PetscCall(TSGetSNES(ancf->ts, &snes));
  PetscCall(SNESGetTolerances(snes, NULL, &rtol, &stol, &maxit, &maxf));
  PetscCall(SNESSetTolerances(snes, abstol, rtol, stol, maxit, maxf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The node with the largest residual of the last Newton iterate, a NaN counting as largest. */
PetscErrorCode AncfWorstNode(Ancf ancf, SNES snes, PetscInt *node, PetscReal *size)
{
  Vec F = NULL;
  const PetscScalar *f;
  PetscInt n, bs;

  PetscFunctionBegin;
  *node = -1;
  *size = 0;
  PetscCall(SNESGetFunction(snes, &F, NULL, NULL));
  if (!F) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetLocalSize(F, &n));
  n -= ancf->nmult; /* a constraint that fails shows in its node */
  bs = n / ancf->nnodes;
  PetscCall(VecGetArrayRead(F, &f));
  for (PetscInt i = 0; i < n; i++) {
    PetscReal r = PetscAbsScalar(f[i]);

    if (!(r <= *size) || *node < 0) {
      *node = i / bs;
      *size = r;
      if (PetscIsInfOrNanReal(r)) break;
    }
  }
  PetscCall(VecRestoreArrayRead(F, &f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Restores the state at t0 and reports why TS stopped. */
static PetscErrorCode AncfFail(Ancf ancf, PetscReal t0, TSConvergedReason reason)
{
  PetscReal t, dt, size;
  PetscInt node, b;
  SNES snes;
  SNESConvergedReason why;

  PetscFunctionBegin;
  PetscCall(TSGetTime(ancf->ts, &t));
  PetscCall(TSGetTimeStep(ancf->ts, &dt));
  PetscCall(TSGetSNES(ancf->ts, &snes));
  PetscCall(SNESGetConvergedReason(snes, &why));
  PetscCall(AncfWorstNode(ancf, snes, &node, &size));
  PetscCall(AncfStateLoad(ancf, t0, ancf->backup));
  PetscCheck(node >= 0, ancf->comm, PETSC_ERR_NOT_CONVERGED, "Beam step at t = %g s failed: %s", (double)t,
             TSConvergedReasons[reason]);
  b = AncfFindBeam(ancf, node);
  node -= ancf->beams[b].node;
  SETERRQ(ancf->comm, PETSC_ERR_NOT_CONVERGED,
          "Newton failed (%s) at t = %g s even with the step halved down to %g s: largest residual %g N at beam %" PetscInt_FMT
          ", element %" PetscInt_FMT " of %" PetscInt_FMT ", node %" PetscInt_FMT
          "; use a smaller step (-ancf_substeps) or softer loads",
          SNESConvergedReasons[why], (double)t, (double)dt, (double)size, ancf->firstbeam + b, PetscMax(node - 1, 0),
          ancf->beams[b].spec.elements, node);
}

PetscErrorCode AncfTSSolve(Ancf ancf, PetscReal t)
{
  const PetscReal t0 = ancf->t;
  PetscReal dt = (t - t0) / (PetscReal)ancf->substeps;
  PetscBool fixedstep;
  TSAdapt adapt;
  TSConvergedReason reason;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  ancf->loadtime[0] = t0;
  ancf->loadtime[1] = t;
  AncfSetLoadTime(ancf, t0);
  PetscCall(TSGetAdapt(ancf->ts, &adapt));
  PetscCall(PetscObjectTypeCompare((PetscObject)adapt, TSADAPTNONE, &fixedstep));
  if (!fixedstep && ancf->step > 0) dt = PetscMin(ancf->step, t - t0);
  ancf->nominal = fixedstep ? dt : 0;
  PetscCall(AncfSetNewtonFloor(ancf, dt));
  if (ancf->restart && ancf->form == ANCF_FORM_SECOND) {
    if (!ancf->given) {
      PetscCall(AncfComputeAcceleration(ancf));
      PetscCall(PetscArraycpy(ancf->history, ancf->a, 6 * ancf->nnodes));
    }
    PetscCall(AncfAlphaStart(ancf, dt));
  }
  ancf->restart = ancf->given = PETSC_FALSE;
  PetscCall(AncfStateStore(ancf, ancf->backup));
  ancf->stored = PETSC_TRUE;
  PetscCall(TSSetTimeStep(ancf->ts, dt));
  if (ancf->stage) PetscCall(PetscArrayzero(ancf->impulse, 6 * ancf->nnodes));
  ancf->advanced = t - t0;
  if (ancf->form == ANCF_FORM_SYMPLECTIC) { /* sums its stages' times and matches no final time: count steps instead */
    PetscInt steps;

    PetscCall(TSGetStepNumber(ancf->ts, &steps));
    PetscCall(TSSetMaxSteps(ancf->ts, steps + ancf->substeps));
    PetscCall(TSSetMaxTime(ancf->ts, t + dt));
  } else
    PetscCall(TSSetMaxTime(ancf->ts, t));
  PetscCall(TSSolve(ancf->ts, NULL));
  PetscCall(TSGetConvergedReason(ancf->ts, &reason));
  if (reason < 0) PetscCall(AncfFail(ancf, t0, reason));
  PetscCall(TSSetTime(ancf->ts, t)); /* sums of steps may be off by round-off */
  PetscCall(TSGetTimeStep(ancf->ts, &ancf->step));
  PetscCall(AncfTSPull(ancf));
  if (ancf->nmult) {
    PetscCall(AncfDaePost(ancf));
    AncfMove(ancf, t);
  } else {
    if (ancf->njoints) PetscCall(AncfJointSync(ancf, PETSC_FALSE, NULL));
    PetscCall(AncfMoveNodes(ancf, t));
  }
  ierr = AncfCheckFinite(ancf, "position", ancf->e, t);
  if (!ierr) ierr = AncfCheckFinite(ancf, "velocity", ancf->v, t);
  if (!ierr) ierr = AncfCheckPlane(ancf, ancf->e, t);
  if (ierr) PetscCall(AncfStateLoad(ancf, t0, ancf->backup));
  PetscCall(ierr);
  ancf->t = t;
  if (ancf->linear) PetscCall(PetscArraycpy(ancf->load, ancf->loadend, 6 * ancf->nnodes));
  ancf->linear = PETSC_FALSE;
  AncfSetLoadTime(ancf, t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  AncfAdvance - integrates to time t (> the current one) under the present loads.

  Errors: PETSC_ERR_FP for non-finite loads or results, PETSC_ERR_NOT_CONVERGED when Newton's method fails even after the
  step was reduced. After an error the state is that before the call.
*/
PetscErrorCode AncfAdvance(Ancf ancf, PetscReal t)
{
  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfAdvance: call AncfSetUp() first");
  PetscCheck(t > ancf->t && !PetscIsInfOrNanReal(t), ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "AncfAdvance: time %g s must be finite and after the current time %g s", (double)t, (double)ancf->t);
  PetscCall(AncfCheckFinite(ancf, "load", ancf->load, ancf->t));
  if (ancf->linear) PetscCall(AncfCheckFinite(ancf, "load", ancf->loadend, t));
  PetscCall(PetscLogEventBegin(ANCF_Advance, 0, 0, 0, 0));
  if (ancf->ngroups)
    PetscCall(AncfGroupSolve(ancf, t));
  else
    PetscCall(AncfTSSolve(ancf, t));
  PetscCall(PetscLogEventEnd(ANCF_Advance, 0, 0, 0, 0));
  ancf->avalid = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
