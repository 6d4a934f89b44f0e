/* ancfstatic.c - static equilibrium Q^e(e) = Q^a + Q^g by Newton's method with load steps. */
#include "ancfimpl.h"

static PetscErrorCode StaticFunction(SNES snes, Vec X, Vec F, void *ctx)
{
  Ancf ancf = (Ancf)ctx;
  const PetscScalar *x;
  PetscScalar *f;

  PetscFunctionBegin;
  (void)snes;
  PetscCall(VecGetArrayRead(X, &x));
  PetscCall(VecGetArrayWrite(F, &f));
  if (ancf->njoints) {
    PetscCall(AncfJointState(ancf, x, NULL, 6, NULL, 0));
    PetscCall(AncfResidual(ancf, ancf->je, 6, NULL, 0, f, 6));
    PetscCall(AncfJointReduce(ancf, f, 6, NULL, 0));
  } else
    PetscCall(AncfResidual(ancf, x, 6, NULL, 0, f, 6));
  for (PetscInt i = 0; i < 6 * ancf->nnodes; i++)
    if (ancf->fixed[i / 6] & (i % 6 < 3 ? ANCF_FIX_POSITION : ANCF_FIX_GRADIENT)) f[i] = x[i] - ancf->rest[i];
  PetscCall(VecRestoreArrayWrite(F, &f));
  PetscCall(VecRestoreArrayRead(X, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode StaticJacobian(SNES snes, Vec X, Mat J, Mat P, void *ctx)
{
  const PetscScalar *x;

  PetscFunctionBegin;
  (void)snes;
  PetscCall(VecGetArrayRead(X, &x));
  PetscCall(AncfAssemble((Ancf)ctx, x, NULL, 6, 0, 0, 1, J, P));
  PetscCall(VecRestoreArrayRead(X, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode StaticCreate(Ancf ancf, SNES *snes, Vec *X, Mat *J)
{
  SNESLineSearch search;
  KSP ksp;
  PC pc;
  PetscReal EA = 0;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < ancf->nbeams; b++) EA = PetscMax(EA, ancf->beams[b].EA);
  PetscCall(VecCreateSeq(ancf->comm, 6 * ancf->nnodes, X));
  PetscCall(SNESCreate(ancf->comm, snes));
  PetscCall(SNESSetOptionsPrefix(*snes, ancf->prefix));
  PetscCall(SNESAppendOptionsPrefix(*snes, "ancf_static_"));
  PetscCall(SNESSetFunction(*snes, NULL, StaticFunction, ancf));
  /* Full steps: bending first stretches the chord, so that the residual rises before it falls. */
  PetscCall(SNESGetLineSearch(*snes, &search));
  PetscCall(SNESLineSearchSetType(search, ANCF_FULL_STEP));
  PetscCall(
      SNESSetTolerances(*snes, 4 * PETSC_MACHINE_EPSILON * EA * PetscSqrtReal((PetscReal)ancf->nnodes), 1e-10, 1e-13, 40, 10000));
  PetscCall(SNESSetDivergenceTolerance(*snes, -1));
  PetscCall(SNESGetKSP(*snes, &ksp));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCILU));
  PetscCall(SNESSetFromOptions(*snes));
  PetscCall(AncfCreateMatrix(ancf, 6, pc, PETSC_FALSE, J));
  PetscCall(SNESSetJacobian(*snes, *J, *J, StaticJacobian, ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Small steps alone are no equilibrium: without supports the shape runs away in ever smaller relative ones. What is left must be
  small against the loads or near the round-off of the axial forces.
*/
static PetscErrorCode StaticBalanced(Ancf ancf, SNES snes, PetscBool *balanced)
{
  PetscReal left, floor, loads = 0;
  Vec F;

  PetscFunctionBegin;
  PetscCall(SNESGetFunction(snes, &F, NULL, NULL));
  PetscCall(VecNorm(F, NORM_2, &left));
  PetscCall(SNESGetTolerances(snes, &floor, NULL, NULL, NULL, NULL));
  for (PetscInt i = 0; i < 6 * ancf->nnodes; i++) loads += PetscSqr(ancf->steady[i] + ancf->load[i]);
  *balanced = left <= 1e-8 * PetscSqrtReal(loads) + 1e3 * floor ? PETSC_TRUE : PETSC_FALSE; /* false for NaN */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Joints: dependent coordinates in X, which the equations have left alone, and new ones where the old serve badly. */
static PetscErrorCode StaticSync(Ancf ancf, Vec X)
{
  PetscScalar *x;

  PetscFunctionBegin;
  if (!ancf->njoints) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArray(X, &x));
  PetscCall(PetscArraycpy(ancf->e, x, 6 * ancf->nnodes));
  PetscCall(AncfJointSync(ancf, PETSC_FALSE, NULL));
  PetscCall(PetscArraycpy(x, ancf->e, 6 * ancf->nnodes));
  PetscCall(VecRestoreArray(X, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* From load factor 0 to 1; a failed step is halved and tried again from the last equilibrium. */
static PetscErrorCode StaticSteps(Ancf ancf, SNES snes, Vec X, PetscReal step, SNESConvergedReason *reason)
{
  PetscReal done = 0;
  Vec good;

  PetscFunctionBegin;
  PetscCall(VecDuplicate(X, &good));
  PetscCall(VecCopy(X, good));
  while (done < 1 && step > 1e-4) {
    PetscBool balanced = PETSC_FALSE;

    ancf->loadscale = PetscMin(1, done + step);
    if (1 - ancf->loadscale < 1e-12) ancf->loadscale = 1;
    PetscCall(SNESSolve(snes, NULL, X));
    PetscCall(SNESGetConvergedReason(snes, reason));
    if (*reason > 0) PetscCall(StaticBalanced(ancf, snes, &balanced));
    if (balanced) {
      done = ancf->loadscale;
      PetscCall(StaticSync(ancf, X));
      PetscCall(VecCopy(X, good));
    } else {
      step /= 2;
      if (*reason > 0) *reason = SNES_DIVERGED_LOCAL_MIN;
      PetscCall(VecCopy(good, X));
    }
  }
  ancf->loadscale = 1;
  PetscCall(VecDestroy(&good));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfSolveStatic(Ancf ancf, PetscInt loadsteps)
{
  const PetscInt n = 6 * ancf->nnodes;
  SNES snes;
  Vec X;
  Mat J;
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  PetscScalar *x;
  PetscReal size;
  PetscInt node;

  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfSolveStatic: call AncfSetUp() first");
  PetscCheck(loadsteps >= 1, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "AncfSolveStatic: load steps %" PetscInt_FMT " must be at least 1", loadsteps);
  PetscCall(AncfCheckFinite(ancf, "load", ancf->load, ancf->t));
  PetscCall(StaticCreate(ancf, &snes, &X, &J));
  PetscCall(VecGetArrayWrite(X, &x));
  PetscCall(PetscArraycpy(x, ancf->e, n));
  PetscCall(VecRestoreArrayWrite(X, &x));
  PetscCall(StaticSteps(ancf, snes, X, 1 / (PetscReal)loadsteps, &reason));
  PetscCall(AncfWorstNode(ancf, snes, &node, &size));
  if (reason > 0) {
    PetscCall(VecGetArray(X, &x));
    PetscCall(AncfCheckPlane(ancf, x, ancf->t));
    PetscCall(PetscArrayzero(ancf->v, n));
    PetscCall(AncfSetState(ancf, ancf->t, x, ancf->v));
    PetscCall(VecRestoreArray(X, &x));
  }
  PetscCall(SNESDestroy(&snes));
  PetscCall(VecDestroy(&X));
  PetscCall(MatDestroy(&J));
  if (reason < 0) {
    PetscInt b = AncfFindBeam(ancf, PetscMax(node, 0));

    SETERRQ(ancf->comm, PETSC_ERR_NOT_CONVERGED,
            "No static equilibrium (%s): largest residual %g N at beam %" PetscInt_FMT ", node %" PetscInt_FMT
            "; are the supports enough?",
            SNESConvergedReasons[reason], (double)size, b, PetscMax(node, 0) - ancf->beams[b].node);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
