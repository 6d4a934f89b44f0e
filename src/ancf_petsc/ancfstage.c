/*
  ancfstage.c - the stage of TSALPHA2 as SNES callbacks of our own.

  TSALPHA2 makes the arguments of the equations of motion by eleven vector operations per evaluation, each a sweep over memory.
  Here they are one sweep: with d = x - x_0 of the unknown x = x_1 (Chung and Hulbert 1993),

    A_1 = (d - dt V_0)/(beta dt^2) - (1/(2 beta) - 1) A_0,   V_1 = V_0 + dt ((1 - gamma) A_0 + gamma A_1),
    x_a = x_0 + alpha_f d,   V_a = V_0 + alpha_f (V_1 - V_0),   A_a = A_0 + alpha_m (A_1 - A_0),

  and F(x) = F(x_a, V_a, A_a)/alpha_f as TSALPHA2 scales it. V_1 and A_1, which TSALPHA2 then cannot know, are put into the
  state after the step. Its start (ancfalpha.c) and steps of adapted length, whose error estimate reads its vectors, stay its own.
*/
#include "ancfimpl.h"

typedef struct {
  PetscReal dt, am, af, gamma, beta;
} Alpha;

static PetscErrorCode GetAlpha(Ancf ancf, Alpha *p, PetscBool *own)
{
  PetscFunctionBegin;
  PetscCall(TSAlpha2GetParams(ancf->ts, &p->am, &p->af, &p->gamma, &p->beta));
  p->dt = ancf->stagedt;
  *own = ancf->priming || (p->am == 1 && p->af == 1 && p->gamma == 1 && p->beta == 0.5) ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The arguments at x for some nodes, into stagex, stagev (NULL: nothing asks for velocities) and stagea. */
static void Arguments(const Ancf ancf, const Alpha *p, AncfNodes nodes, const PetscReal *PETSC_RESTRICT x)
{
  const PetscReal *PETSC_RESTRICT x0 = ancf->e0, *PETSC_RESTRICT v0 = ancf->v0, *PETSC_RESTRICT a0 = ancf->history;
  PetscReal *PETSC_RESTRICT xa = ancf->stagex, *PETSC_RESTRICT va = ancf->stagev, *PETSC_RESTRICT aa = ancf->stagea;
  const PetscReal dt = p->dt, kd = 1 / (dt * dt * p->beta), ka = (1 - 2 * p->beta) / (2 * p->beta), af = p->af, am = p->am;

  for (PetscInt i = 6 * nodes.begin; i < 6 * nodes.end; i++) {
    const PetscReal d = x[i] - x0[i], a = kd * (d - dt * v0[i]) - ka * a0[i];

    xa[i] = x0[i] + af * d;
    aa[i] = a0[i] + am * (a - a0[i]);
  }
  for (PetscInt i = 6 * nodes.begin; i < 6 * nodes.end && va; i++) {
    const PetscReal a = kd * (x[i] - x0[i] - dt * v0[i]) - ka * a0[i];

    va[i] = v0[i] + af * dt * ((1 - p->gamma) * a0[i] + p->gamma * a);
  }
}

/* Residual of batch k, from the arguments to the sum of squares while all of it is in cache. */
static void StageBatch(Ancf ancf, const Alpha *p, PetscInt k, const PetscReal *x, PetscReal *f)
{
  const PetscReal scale = 1 / p->af;
  AncfNodes nodes[ANCF_LANES];
  const int n = AncfBatchNodes(&ancf->lanebeams[k], nodes);
  PetscReal sum[6] = {0};

  for (int r = 0; r < n; r++) Arguments(ancf, p, nodes[r], x);
  AncfMotionBatch(ancf, k, ancf->stagex, ancf->stagev, ancf->stagea, f);
  for (int r = 0; r < n; r++)
    for (PetscInt i = 6 * nodes[r].begin; i < 6 * nodes[r].end; i += 6)
      for (int c = 0; c < 6; c++) {
        f[i + c] *= scale;
        sum[c] += f[i + c] * f[i + c];
      }
  ancf->stagesum[k] = sum[0] + sum[1] + sum[2] + sum[3] + sum[4] + sum[5];
}

/* All batches, on all threads; the norm is summed in their order, whatever the threads. */
static PetscErrorCode StageBatches(Ancf ancf, const Alpha *p, const PetscReal *x, PetscReal *f)
{
  PetscReal sum = 0;

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(ANCF_Force, 0, 0, 0, 0));
#pragma omp parallel for schedule(static) if (ancf->nlanebeams >= ANCF_PARALLEL)
  for (PetscInt k = 0; k < ancf->nlanebeams; k++) StageBatch(ancf, p, k, x, f);
  for (PetscInt k = 0; k < ancf->nlanebeams; k++) sum += ancf->stagesum[k];
  ancf->stagenorm = PetscSqrtReal(sum);
  PetscCall(PetscLogEventEnd(ANCF_Force, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode StageFunction(SNES snes, Vec X, Vec F, void *ctx)
{
  Ancf ancf = (Ancf)ctx;
  const PetscScalar *x;
  PetscScalar *f;
  PetscBool own = PETSC_FALSE;
  Alpha p;

  PetscFunctionBegin;
  PetscCall(GetAlpha(ancf, &p, &own));
  ancf->stagenorm = -1;
  ancf->stageat = NULL;
  if (!own) {
    PetscCall(SNESTSFormFunction(snes, X, F, ancf->ts));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  AncfSetLoadTime(ancf, ancf->stagetime);
  AncfMoveStage(ancf, ancf->stagetime);
  PetscCall(VecGetArrayRead(X, &x));
  PetscCall(VecGetArrayWrite(F, &f));
  if (ancf->stagesum)
    PetscCall(StageBatches(ancf, &p, x, f));
  else {
    Arguments(ancf, &p, (AncfNodes){0, ancf->nnodes}, x);
    PetscCall(AncfMotionResidual(ancf, ancf->stagex, ancf->stagev, ancf->stagea, 6, f, 6));
    for (PetscInt i = 0; i < 6 * ancf->nnodes; i++) f[i] *= 1 / p.af;
  }
  PetscCall(VecRestoreArrayWrite(F, &f));
  PetscCall(VecRestoreArrayRead(X, &x));
  ancf->stageat = X;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Newton's method with full steps: the matrix follows a residual at the same x, and no residual comes between it and the solution
  with it, so that both can have the same arguments.
*/
static PetscErrorCode Lasting(SNES snes, PetscBool *lasting)
{
  SNESLineSearch search;
  PetscBool full;
  PetscInt lag;

  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)snes, SNESNEWTONLS, lasting));
  if (!*lasting) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESGetLineSearch(snes, &search));
  PetscCall(PetscObjectTypeCompare((PetscObject)search, SNESLINESEARCHSHELL, &full));
  PetscCall(SNESGetLagJacobian(snes, &lag));
  *lasting = (PetscBool)(full && lag == 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode StageJacobian(SNES snes, Vec X, Mat J, Mat P, void *ctx)
{
  Ancf ancf = (Ancf)ctx;
  const PetscScalar *x;
  PetscReal shiftv, shifta;
  PetscBool own = PETSC_FALSE, lasting = PETSC_FALSE;
  Alpha p;

  PetscFunctionBegin;
  PetscCall(GetAlpha(ancf, &p, &own));
  if (!own) {
    PetscCall(SNESTSFormJacobian(snes, X, J, P, ancf->ts));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  shiftv = p.gamma / (p.dt * p.beta);
  shifta = p.am / (p.af * p.dt * p.dt * p.beta);
  PetscCall(Lasting(snes, &lasting));
  if (J != P) lasting = PETSC_FALSE; /* products by differences of residuals */
  if (!lasting || X != ancf->stageat) {
    PetscCall(VecGetArrayRead(X, &x));
    Arguments(ancf, &p, (AncfNodes){0, ancf->nnodes}, x);
    PetscCall(VecRestoreArrayRead(X, &x));
  }
  ancf->lasting = lasting;
  PetscCall(AncfAssemble(ancf, ancf->stagex, ancf->stagev, 6, shifta + ancf->damping * shiftv, shiftv, shifta, J, P));
  ancf->lasting = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After TSSetI2Function() and TSSetI2Jacobian(), for runs whose history is ours alone. */
PetscErrorCode AncfStageSetUp(Ancf ancf)
{
  const PetscInt n = 6 * ancf->nnodes;
  SNES snes;

  PetscFunctionBegin;
  ancf->fused = (PetscBool)(ancf->exact && !ancf->nmult && !ancf->njoints && !ancf->exposed);
  if (!ancf->fused) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(n, &ancf->stagex, n, &ancf->stagea));
  if (ancf->viscous || ancf->damping != 0) PetscCall(PetscMalloc1(n, &ancf->stagev));
  if (ancf->lanebeams && !ancf->viscous) PetscCall(PetscMalloc1(ancf->nlanebeams, &ancf->stagesum));
  PetscCall(TSGetSNES(ancf->ts, &snes));
  PetscCall(SNESSetFunction(snes, NULL, StageFunction, ancf));
  PetscCall(SNESSetJacobian(snes, ancf->J, ancf->J, StageJacobian, ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfStageDestroy(Ancf ancf)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(ancf->stagex, ancf->stagea));
  PetscCall(PetscFree(ancf->stagev));
  PetscCall(PetscFree(ancf->stagesum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Before a step: e and v at its start, which the first step of an AncfAdvance() has in its backup. */
PetscErrorCode AncfStagePreStep(Ancf ancf)
{
  const PetscInt n = 6 * ancf->nnodes;

  PetscFunctionBegin;
  ancf->e0 = ancf->stored ? ancf->backup : ancf->eprev;
  ancf->v0 = ancf->stored ? ancf->backup + n : ancf->vprev;
  if (!ancf->stored) PetscCall(AncfAlphaPreStep(ancf));
  ancf->stored = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After it: V_1 and A_1. */
PetscErrorCode AncfStagePostStep(Ancf ancf)
{
  const PetscReal *PETSC_RESTRICT x = ancf->e, *PETSC_RESTRICT x0 = ancf->e0, *PETSC_RESTRICT v0 = ancf->v0;
  PetscReal *PETSC_RESTRICT v = ancf->v, *PETSC_RESTRICT a = ancf->history;
  PetscScalar *touch;
  PetscReal kd, ka;
  PetscBool own = PETSC_FALSE;
  Alpha p;

  PetscFunctionBegin;
  PetscCall(GetAlpha(ancf, &p, &own));
  kd = 1 / (p.dt * p.dt * p.beta);
  ka = (1 - 2 * p.beta) / (2 * p.beta);
#pragma omp parallel for schedule(static) if (ancf->nlanebeams >= ANCF_PARALLEL)
  for (PetscInt i = 0; i < 6 * ancf->nnodes; i++) {
    const PetscReal a1 = kd * (x[i] - x0[i] - p.dt * v0[i]) - ka * a[i];

    v[i] = v0[i] + p.dt * ((1 - p.gamma) * a[i] + p.gamma * a1);
    a[i] = a1;
  }
  PetscCall(VecGetArray(ancf->V, &touch)); /* its array is ancf->v */
  PetscCall(VecRestoreArray(ancf->V, &touch));
  PetscFunctionReturn(PETSC_SUCCESS);
}
