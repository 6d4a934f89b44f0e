/* rigidposition.c - stage 1 of joined bodies (rigidconstraint.c), solved by PETSc's SNES for the multipliers of the active rows.
 */
#include "rigidsystem.h"

#define MAX_ITERATIONS 60
#define TOLERANCE 1.e-13 /* of the lengths that a row is the difference of; 1 for angles */

/* Stage 1 with the multipliers as they are: free bodies from their saved state over h; then the residuals, worst one relative to
 * its tolerance. */
static PetscErrorCode Trial(Rigid rigid, PetscReal h)
{
  RigidSystem s = rigid->system;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < rigid->n; i++)
    if (s->start[i + 1] > s->start[i] && rigid->body[i].spec.motion == RIGID_FREE) {
      rigid->body[i] = s->saved[i];
      RigidBodyKickApplied(rigid, &rigid->body[i], .5 * h);
    }
  RigidSystemWrench(rigid, s->row0, s->lambda, -1);
  RigidSystemKick(rigid, .5 * h);
  for (PetscInt i = 0; i < rigid->n; i++)
    if (s->start[i + 1] > s->start[i] && rigid->body[i].spec.motion == RIGID_FREE) PetscCall(RigidBodyDrift(rigid, i, h));
  RigidSystemRows(rigid, s->row1);
  s->worst = 0.;
  s->where = 0;
  for (PetscInt r = 0; r < s->n; r++) {
    const RigidJoint *j = &rigid->joint[s->joint[r]];
    const PetscReal k = j->k[s->local[r]], c = j->c[s->local[r]], g0 = s->row0[r].g, g1 = s->row1[r].g, stiff = .5 * k + c / h;
    s->res[r] =
        !s->active[r] ? 0. : (j->hard[s->local[r]] ? g1 : (s->lambda[r] + .5 * k * (g0 + g1) + c * (g1 - g0) / h) / stiff);
    PetscCheck(!PetscIsInfOrNanReal(s->res[r]), rigid->comm, PETSC_ERR_FP,
               "Rigid joint %" PetscInt_FMT " (%s): not finite at t = %g s", s->joint[r], RigidJointName(j->spec.type),
               (double)rigid->t);
    if (PetscAbsReal(s->res[r]) > s->worst * TOLERANCE * s->length[r]) {
      s->worst = PetscAbsReal(s->res[r]) / (TOLERANCE * s->length[r]);
      s->where = r;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* f = 2 g/h^2 of the active rows: the matrix of RigidSystemAssemble() is its derivative. */
static PetscErrorCode PositionResidual(SNES snes, Vec x, Vec f, void *ctx)
{
  Rigid rigid = (Rigid)ctx;
  RigidSystem s = rigid->system;
  const PetscScalar *y;
  PetscScalar *g;

  PetscFunctionBegin;
  (void)snes;
  PetscCall(VecGetArrayRead(x, &y));
  for (PetscInt r = 0; r < s->n; r++)
    if (s->active[r]) s->lambda[r] = PetscRealPart(y[r]);
  PetscCall(VecRestoreArrayRead(x, &y));
  PetscCall(Trial(rigid, s->h));
  PetscCall(VecGetArrayWrite(f, &g));
  for (PetscInt r = 0; r < s->n; r++) g[r] = s->active[r] ? 2. / (s->h * s->h) * s->res[r] : 0.;
  PetscCall(VecRestoreArrayWrite(f, &g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The matrix stays as RigidSystemAssemble() made it at the start of the step, and so does its factorisation. */
static PetscErrorCode PositionJacobian(SNES snes, Vec x, Mat A, Mat P, void *ctx)
{
  PetscFunctionBegin;
  (void)snes;
  (void)x;
  (void)A;
  (void)P;
  (void)ctx;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Each row to the round-off of its lengths, or as near as iterations get. */
static PetscErrorCode PositionConverged(SNES snes, PetscInt it, PetscReal xnorm, PetscReal snorm, PetscReal fnorm,
                                        SNESConvergedReason *reason, void *ctx)
{
  RigidSystem s = ((Rigid)ctx)->system;

  PetscFunctionBegin;
  (void)snes;
  (void)xnorm;
  (void)snorm;
  (void)fnorm;
  *reason = SNES_CONVERGED_ITERATING;
  if (s->worst <= 1.)
    *reason = SNES_CONVERGED_FNORM_ABS;
  else if (it > 2 && s->worst > .5 * s->last && s->worst < 1.e3)
    *reason = SNES_CONVERGED_FNORM_RELATIVE;
  s->last = s->worst;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Newton's method, without a line search: the start is the motion without joints, near by for any step that CheckTurn() lets
 * pass. */
PetscErrorCode RigidPositionCreate(Rigid rigid)
{
  RigidSystem s = rigid->system;
  SNESLineSearch search;
  PC pc;

  PetscFunctionBegin;
  PetscCall(SNESCreate(PETSC_COMM_SELF, &s->snes));
  PetscCall(SNESSetOptionsPrefix(s->snes, rigid->prefix));
  PetscCall(SNESAppendOptionsPrefix(s->snes, "rigid_joint_"));
  PetscCall(SNESSetType(s->snes, SNESNEWTONLS));
  PetscCall(SNESGetLineSearch(s->snes, &search));
  PetscCall(SNESLineSearchSetType(search, SNESLINESEARCHBASIC));
  PetscCall(SNESSetFunction(s->snes, NULL, PositionResidual, rigid));
  PetscCall(SNESSetJacobian(s->snes, s->A, s->A, PositionJacobian, rigid));
  PetscCall(SNESSetTolerances(s->snes, 0., 0., 0., MAX_ITERATIONS, PETSC_MAX_INT));
  PetscCall(SNESSetConvergenceTest(s->snes, PositionConverged, rigid, NULL));
  PetscCall(SNESGetKSP(s->snes, &s->ksp));
  PetscCall(KSPSetType(s->ksp, KSPPREONLY));
  PetscCall(KSPGetPC(s->ksp, &pc));
  PetscCall(PCSetType(pc, PCLU));
  PetscCall(SNESSetFromOptions(s->snes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckSolved(Rigid rigid)
{
  RigidSystem s = rigid->system;
  const RigidJoint *j = &rigid->joint[s->joint[s->where]];
  SNESConvergedReason reason;
  KSPConvergedReason linear;

  PetscFunctionBegin;
  PetscCall(SNESGetConvergedReason(s->snes, &reason));
  if (reason > 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPGetConvergedReason(s->ksp, &linear));
  PetscCheck(reason != SNES_DIVERGED_LINEAR_SOLVE, rigid->comm, PETSC_ERR_NOT_CONVERGED,
             "Rigid joints: the linear system at t = %g s cannot be solved (%s)", (double)rigid->t, KSPConvergedReasons[linear]);
  PetscCheck(s->worst < 1.e4, rigid->comm, PETSC_ERR_NOT_CONVERGED,
             "Rigid joint %" PetscInt_FMT " (%s of bodies %" PetscInt_FMT " and %" PetscInt_FMT
             "): cannot be kept at t = %g s, ends apart by %g; the step of %g s is too long or the "
             "joints contradict one another",
             s->joint[s->where], RigidJointName(j->spec.type), j->spec.a, j->spec.b, (double)rigid->t,
             (double)PetscAbsReal(s->res[s->where]), (double)s->h);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stage 1 for the present set of active rows. */
PetscErrorCode RigidPositionSolve(Rigid rigid, PetscReal h)
{
  RigidSystem s = rigid->system;
  PetscScalar *x;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < rigid->n; i++)
    if (s->start[i + 1] > s->start[i] && rigid->body[i].spec.motion == RIGID_FREE) rigid->body[i] = s->saved[i];
  PetscCall(RigidSystemAssemble(rigid, s->row0, h));
  s->h = h;
  s->last = PETSC_MAX_REAL;
  PetscCall(VecGetArrayWrite(s->x, &x));
  for (PetscInt r = 0; r < s->n; r++) x[r] = s->lambda[r];
  PetscCall(VecRestoreArrayWrite(s->x, &x));
  PetscCall(SNESSolve(s->snes, NULL, s->x));
  PetscCall(CheckSolved(rigid));
  PetscFunctionReturn(PETSC_SUCCESS);
}
