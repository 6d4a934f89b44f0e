/*
  ancfts.c - the equations of motion (ancfresidual.c) as TS callbacks, and the set-up of TS; its type: ancftype.c.
*/
#include "ancfimpl.h"

/* F = M a + C v + Q^e - Q^g - Q^a */
static PetscErrorCode AncfI2Function(TS ts, PetscReal t, Vec U, Vec V, Vec A, Vec F, void *ctx)
{
  Ancf ancf = (Ancf)ctx;
  const PetscScalar *u, *v, *a;
  PetscScalar *f;

  PetscFunctionBegin;
  (void)ts;
  AncfSetLoadTime((Ancf)ctx, t);
  AncfMoveStage((Ancf)ctx, t);
  PetscCall(VecGetArrayRead(U, &u));
  PetscCall(VecGetArrayRead(V, &v));
  PetscCall(VecGetArrayRead(A, &a));
  PetscCall(VecGetArrayWrite(F, &f));
  if (ancf->priming)
    PetscCall(AncfAlphaFunction(ancf, a, f));
  else if (ancf->nmult)
    PetscCall(AncfDaeResidual(ancf, u, v, a, 6, u + 6 * ancf->nnodes, f, 6, f + 6 * ancf->nnodes));
  else
    PetscCall(AncfMotionResidual(ancf, u, v, a, 6, f, 6));
  PetscCall(VecRestoreArrayWrite(F, &f));
  PetscCall(VecRestoreArrayRead(A, &a));
  PetscCall(VecRestoreArrayRead(V, &v));
  PetscCall(VecRestoreArrayRead(U, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AncfI2Jacobian(TS ts, PetscReal t, Vec U, Vec V, Vec A, PetscReal shiftV, PetscReal shiftA, Mat J, Mat P,
                                     void *ctx)
{
  const PetscScalar *u, *v;

  PetscFunctionBegin;
  (void)ts;
  (void)t;
  (void)A;
  PetscCall(VecGetArrayRead(U, &u));
  PetscCall(VecGetArrayRead(V, &v));
  if (((Ancf)ctx)->priming)
    PetscCall(AncfAssembleIdentity((Ancf)ctx, shiftA, P));
  else if (((Ancf)ctx)->nmult)
    PetscCall(AncfDaeAssemble((Ancf)ctx, u, v, 6, u + 6 * ((Ancf)ctx)->nnodes, shiftA + ((Ancf)ctx)->damping * shiftV, shiftV,
                              shiftA, J, P));
  else
    PetscCall(AncfAssemble((Ancf)ctx, u, v, 6, shiftA + ((Ancf)ctx)->damping * shiftV, shiftV, shiftA, J, P));
  PetscCall(VecRestoreArrayRead(V, &v));
  PetscCall(VecRestoreArrayRead(U, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* F = (edot - v, M vdot + C v + Q^e - Q^g - Q^a), y = (e, v) node by node */
static PetscErrorCode AncfIFunction(TS ts, PetscReal t, Vec Y, Vec Ydot, Vec F, void *ctx)
{
  Ancf ancf = (Ancf)ctx;
  const PetscScalar *y, *yd;
  PetscScalar *f;

  PetscFunctionBegin;
  (void)ts;
  AncfSetLoadTime((Ancf)ctx, t);
  AncfMoveStage((Ancf)ctx, t);
  PetscCall(VecGetArrayRead(Y, &y));
  PetscCall(VecGetArrayRead(Ydot, &yd));
  PetscCall(VecGetArrayWrite(F, &f));
  if (ancf->nmult)
    PetscCall(AncfDaeResidual(ancf, y, y + 6, yd + 6, 12, y + 12 * ancf->nnodes, f + 6, 12, f + 12 * ancf->nnodes));
  else
    PetscCall(AncfMotionResidual(ancf, y, y + 6, yd + 6, 12, f + 6, 12));
  for (PetscInt j = 0; j < ancf->nnodes; j++)
    for (PetscInt c = 12 * j; c < 12 * j + 6; c++) f[c] = yd[c] - y[c + 6];
  PetscCall(VecRestoreArrayWrite(F, &f));
  PetscCall(VecRestoreArrayRead(Ydot, &yd));
  PetscCall(VecRestoreArrayRead(Y, &y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AncfIJacobian(TS ts, PetscReal t, Vec Y, Vec Ydot, PetscReal shift, Mat J, Mat P, void *ctx)
{
  const PetscScalar *y;

  PetscFunctionBegin;
  (void)ts;
  (void)t;
  (void)Ydot;
  PetscCall(VecGetArrayRead(Y, &y));
  if (((Ancf)ctx)->nmult)
    PetscCall(
        AncfDaeAssemble((Ancf)ctx, y, y + 6, 12, y + 12 * ((Ancf)ctx)->nnodes, shift + ((Ancf)ctx)->damping, 1, shift, J, P));
  else
    PetscCall(AncfAssemble((Ancf)ctx, y, y + 6, 12, shift + ((Ancf)ctx)->damping, 1, shift, J, P));
  PetscCall(VecRestoreArrayRead(Y, &y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AncfRHSFunction(TS ts, PetscReal t, Vec Y, Vec G, void *ctx)
{
  Ancf ancf = (Ancf)ctx;
  const PetscScalar *y;
  PetscScalar *g;

  PetscFunctionBegin;
  (void)ts;
  AncfSetLoadTime((Ancf)ctx, t);
  PetscCall(VecGetArrayRead(Y, &y));
  PetscCall(VecGetArrayWrite(G, &g));
  PetscCall(AncfExplicitAcceleration(ancf, y, y + 6, 12, g + 6, 12));
  for (PetscInt j = 0; j < ancf->nnodes; j++)
    for (PetscInt c = 12 * j; c < 12 * j + 6; c++) g[c] = y[c + 6];
  PetscCall(VecRestoreArrayWrite(G, &g));
  PetscCall(VecRestoreArrayRead(Y, &y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Halves of a separable Hamiltonian system; TSBASICSYMPLECTIC passes the other half's coordinates, nodes x 6. */
static PetscErrorCode AncfSymplecticPosition(TS ts, PetscReal t, Vec V, Vec G, void *ctx)
{
  PetscFunctionBegin;
  (void)ts;
  (void)t;
  (void)ctx;
  PetscCall(VecCopy(V, G));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  PETSc from 3.19 on passes the time to which the momenta are about to be moved; loads and supports belong to that of the
  positions, without which the methods are of first order. The coefficients are those of TSBasicSymplecticRegister(): positions
  move by c dt, momenta by d dt; other schemes than PETSc's own keep the time that is passed.
*/
static PetscErrorCode AncfSymplecticTime(Ancf ancf, PetscReal *t)
{
#if PETSC_VERSION_GE(3, 19, 0)
  const PetscReal b = 1 / (2 - PetscPowReal(2, 1. / 3));
  const struct {
    const char *name;
    PetscReal c[4], d[4];
  } schemes[] = {{TSBASICSYMPLECTICVELVERLET, {0, 1}, {0.5, 0.5}},
                 {TSBASICSYMPLECTIC3, {1, -2. / 3, 2. / 3}, {-1. / 24, 3. / 4, 7. / 24}},
                 {TSBASICSYMPLECTIC4, {b / 2, (1 - b) / 2, (1 - b) / 2, b / 2}, {b, 1 - 2 * b, b, 0}}};
  TSBasicSymplecticType type;
  PetscReal start, dt;

  PetscFunctionBegin;
  PetscCall(TSBasicSymplecticGetType(ancf->ts, &type));
  PetscCall(TSGetTime(ancf->ts, &start));
  PetscCall(TSGetTimeStep(ancf->ts, &dt));
  for (size_t s = 0; s < sizeof(schemes) / sizeof(schemes[0]); s++) {
    PetscBool same;
    PetscReal drift = 0, kick = 0;

    PetscCall(PetscStrcmp(type, schemes[s].name, &same));
    for (int k = 0; same && k < 4; k++) {
      drift += schemes[s].c[k];
      kick += schemes[s].d[k];
      if (PetscAbsReal((*t - start) / dt - kick) > 1e-6) continue;
      *t = start + drift * dt;
      PetscFunctionReturn(PETSC_SUCCESS);
    }
  }
#else
  PetscFunctionBegin;
  (void)ancf;
  (void)t;
#endif
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AncfSymplecticMomentum(TS ts, PetscReal t, Vec X, Vec G, void *ctx)
{
  Ancf ancf = (Ancf)ctx;
  const PetscScalar *x;
  PetscScalar *g;

  PetscFunctionBegin;
  (void)ts;
  PetscCall(AncfSymplecticTime(ancf, &t));
  AncfSetLoadTime(ancf, t);
  PetscCall(VecGetArrayRead(X, &x));
  PetscCall(VecGetArrayWrite(G, &g));
  PetscCall(AncfExplicitAcceleration(ancf, x, NULL, 6, g, 6));
  PetscCall(VecRestoreArrayWrite(G, &g));
  PetscCall(VecRestoreArrayRead(X, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Initial guess of the second-order form: positions at constant velocity. */
static PetscErrorCode AncfPredict(SNES snes, Vec X, void *ctx)
{
  Ancf ancf = (Ancf)ctx;
  PetscReal dt;

  PetscFunctionBegin;
  (void)snes;
  PetscCall(TSGetTimeStep(ancf->ts, &dt));
  PetscCall(VecAXPY(X, dt, ancf->V));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AncfPreStep(TS ts)
{
  Ancf ancf;

  PetscFunctionBegin;
  PetscCall(TSGetApplicationContext(ts, &ancf));
  if (ancf->fused)
    PetscCall(AncfStagePreStep(ancf));
  else if (ancf->form == ANCF_FORM_SECOND)
    PetscCall(AncfAlphaPreStep(ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AncfPreStage(TS ts, PetscReal t)
{
  Ancf ancf;

  PetscFunctionBegin;
  PetscCall(TSGetApplicationContext(ts, &ancf));
  ancf->stagetime = t;
  PetscCall(TSGetTimeStep(ts, &ancf->stagedt));
  PetscCall(TSGetTime(ts, &ancf->stagestart));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Dependent coordinates of joints put right in the state. The vectors of TS keep theirs, which no equation reads: TS restarts when
  it sees a change. Only where the choice of dependent coordinates changes must it take them, and restart.
*/
static PetscErrorCode AncfPostJoints(Ancf ancf)
{
  PetscBool changed;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(ancf->jrow, ancf->ja, 6 * ancf->nnodes));
  PetscCall(AncfTSPull(ancf));
  PetscCall(AncfJointSync(ancf, PETSC_FALSE, &changed));
  if (changed && ancf->form != ANCF_FORM_SECOND) PetscCall(AncfTSCopy(ancf)); /* there U and V are the state itself */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A step that was reduced because Newton failed grows again, which TSADAPTNONE would not do. */
static PetscErrorCode AncfPostStep(TS ts)
{
  PetscReal t, tmax, dt;
  Ancf ancf;

  PetscFunctionBegin;
  PetscCall(TSGetApplicationContext(ts, &ancf));
  if (ancf->fused)
    PetscCall(AncfStagePostStep(ancf));
  else if (ancf->form == ANCF_FORM_SECOND)
    PetscCall(AncfAlphaPostStep(ancf));
  for (PetscInt i = 0; i < 6 * ancf->nnodes && ancf->stage; i++) ancf->impulse[i] += ancf->stagedt * ancf->stage[i];
  if (ancf->nmult) {
    PetscCall(AncfTSPull(ancf));
    PetscCall(AncfDaePost(ancf));
  } else if (ancf->njoints)
    PetscCall(AncfPostJoints(ancf));
  PetscCall(TSGetTimeStep(ts, &dt));
  PetscCall(TSGetTime(ts, &t));
  PetscCall(TSGetMaxTime(ts, &tmax));
  if (dt < 0.5 * ancf->nominal && t + dt < tmax) PetscCall(TSSetTimeStep(ts, PetscMin(2 * dt, tmax - t)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Defaults of the solver stack, all changeable by -ancf_ts_..., -ancf_snes_..., -ancf_ksp_..., -ancf_pc_.... */
PetscErrorCode AncfTSCreate(Ancf ancf)
{
  TSAdapt adapt;
  SNES snes;
  SNESLineSearch search;
  KSP ksp;
  PC pc;

  PetscFunctionBegin;
  PetscCall(TSCreate(ancf->comm, &ancf->ts));
  PetscCall(TSSetType(ancf->ts, TSALPHA2));
  PetscCall(TSAlpha2SetRadius(ancf->ts, ANCF_DEFAULT_RADIUS));
  PetscCall(TSSetExactFinalTime(ancf->ts, TS_EXACTFINALTIME_MATCHSTEP));
  PetscCall(TSSetMaxSteps(ancf->ts, PETSC_MAX_INT));
  PetscCall(TSSetMaxSNESFailures(ancf->ts, ANCF_UNLIMITED)); /* a failed step is tried again with half of it */
  PetscCall(TSSetMaxStepRejections(ancf->ts, ANCF_MAX_HALVES));
  PetscCall(TSSetErrorIfStepFails(ancf->ts, PETSC_FALSE));
  PetscCall(TSGetAdapt(ancf->ts, &adapt));
  PetscCall(TSAdaptSetType(adapt, TSADAPTNONE));
  PetscCall(TSAdaptSetScaleSolveFailed(adapt, 0.5));
  PetscCall(TSGetSNES(ancf->ts, &snes));
  PetscCall(SNESSetTolerances(snes, 1e-50, 1e-9, 1e-12, 25, 10000));
  PetscCall(SNESSetForceIteration(snes, PETSC_TRUE)); /* the floor of AncfSetNewtonFloor() must not swallow small loads */
  PetscCall(SNESGetLineSearch(snes, &search));
  PetscCall(SNESLineSearchSetType(search, SNESLINESEARCHSHELL));
  PetscCall(AncfSetFullStep(ancf));
  PetscCall(SNESGetKSP(snes, &ksp));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCILU)); /* level 0 of a block-tridiagonal matrix of full blocks: the exact block LU */
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfTSDestroy(Ancf ancf)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(ancf->backup));
  PetscCall(PetscFree(ancf->damped));
  PetscCall(AncfStageDestroy(ancf));
  PetscCall(PetscFree(ancf->piece));
  if (!ancf->whole) PetscCall(PetscFree3(ancf->history, ancf->eprev, ancf->vprev));
  PetscCall(VecDestroy(&ancf->U));
  PetscCall(VecDestroy(&ancf->V));
  PetscCall(VecDestroy(&ancf->A));
  PetscCall(VecDestroy(&ancf->E0));
  PetscCall(VecDestroy(&ancf->V0));
  PetscCall(VecDestroy(&ancf->work));
  PetscCall(MatDestroy(&ancf->J));
  PetscCall(TSDestroy(&ancf->ts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AncfSetUpSymplectic(Ancf ancf)
{
  IS is;
  PetscInt *idx;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(ancf->nnodes, &idx));
  for (PetscInt half = 0; half < 2; half++) {
    const char *name = half ? "momentum" : "position";

    for (PetscInt j = 0; j < ancf->nnodes; j++) idx[j] = 2 * j + half;
    PetscCall(ISCreateBlock(ancf->comm, 6, ancf->nnodes, idx, PETSC_COPY_VALUES, &is));
    PetscCall(TSRHSSplitSetIS(ancf->ts, name, is));
    PetscCall(TSRHSSplitSetRHSFunction(ancf->ts, name, NULL, half ? AncfSymplecticMomentum : AncfSymplecticPosition, ancf));
    PetscCall(ISDestroy(&is));
  }
  PetscCall(PetscFree(idx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfTSSetUp(Ancf ancf)
{
  const PetscInt n = 6 * ancf->nnodes;
  SNES snes;
  KSP ksp;
  PC pc;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * (size_t)n, &ancf->backup));
  PetscCall(TSSetApplicationContext(ancf->ts, ancf));
  PetscCall(TSSetPreStep(ancf->ts, AncfPreStep));
  PetscCall(TSSetPreStage(ancf->ts, AncfPreStage));
  PetscCall(TSSetPostStep(ancf->ts, AncfPostStep));
  PetscCall(AncfChooseForm(ancf));
  PetscCall(AncfCheckVariant(ancf));
  PetscCall(AncfDaeSetUp(ancf));
  PetscCall(PetscMalloc1(2 * ((2 * (size_t)n + (size_t)ancf->nmult) / ANCF_PIECE + 1), &ancf->piece));
  if (ancf->whole) PetscCall(AncfSetFullStep(ancf)); /* the first group's TS was made for the whole set */
  PetscCheck(ancf->damping == 0 || ancf->form != ANCF_FORM_SYMPLECTIC, ancf->comm, PETSC_ERR_ARG_INCOMP,
             "-ancf_damping %g needs another -ancf_ts_type than basicsymplectic, which takes no velocities",
             (double)ancf->damping);
  PetscCheck(
      !ancf->viscous || ancf->form != ANCF_FORM_SYMPLECTIC, ancf->comm, PETSC_ERR_ARG_INCOMP,
      "-ancf_damping_stiffness %g and beams with axial or bending damping need another -ancf_ts_type than basicsymplectic, "
      "which takes no velocities",
      (double)ancf->stiffnessdamping);
  for (PetscInt k = 0; k < ancf->njoints; k++)
    PetscCheck(
        ancf->joints[k].linear || ancf->form != ANCF_FORM_SYMPLECTIC, ancf->comm, PETSC_ERR_ARG_INCOMP,
        "-ancf_ts_type basicsymplectic takes no velocities, which the rigid joint %" PetscInt_FMT " needs; use another type", k);
  if (ancf->damping > 0) PetscCall(PetscMalloc1(6 * (size_t)ancf->nnodes, &ancf->damped));
  PetscCall(TSGetSNES(ancf->ts, &snes));
  PetscCall(SNESGetKSP(snes, &ksp));
  PetscCall(KSPGetPC(ksp, &pc));
  if (ancf->form == ANCF_FORM_SECOND) {
    PetscCall(VecCreateSeqWithArray(ancf->comm, 6, n + ancf->nmult, ancf->e, &ancf->U));
    PetscCall(VecCreateSeqWithArray(ancf->comm, 6, n + ancf->nmult, ancf->v, &ancf->V));
    PetscCall(AncfCreateMatrix(ancf, 6, pc, PETSC_TRUE, &ancf->J));
    PetscCall(TSSetI2Function(ancf->ts, NULL, AncfI2Function, ancf));
    PetscCall(TSSetI2Jacobian(ancf->ts, ancf->J, ancf->J, AncfI2Jacobian, ancf));
    PetscCall(TS2SetSolution(ancf->ts, ancf->U, ancf->V));
    PetscCall(SNESSetComputeInitialGuess(snes, AncfPredict, ancf));
    PetscCall(AncfAlphaSetUp(ancf));
    PetscCall(AncfStageSetUp(ancf));
  } else {
    PetscCall(VecCreateSeq(ancf->comm, 2 * n + ancf->nmult, &ancf->U));
    PetscCall(VecZeroEntries(ancf->U));
    if (ancf->form == ANCF_FORM_FIRST) {
      PetscCall(AncfCreateMatrix(ancf, 12, pc, PETSC_TRUE, &ancf->J));
      PetscCall(TSSetEquationType(ancf->ts, ancf->nmult ? TS_EQ_DAE_IMPLICIT_INDEX3 : TS_EQ_ODE_IMPLICIT));
      PetscCall(TSSetIFunction(ancf->ts, NULL, AncfIFunction, ancf));
      PetscCall(TSSetIJacobian(ancf->ts, ancf->J, ancf->J, AncfIJacobian, ancf));
    } else {
      PetscCall(TSSetEquationType(ancf->ts, TS_EQ_ODE_EXPLICIT));
      PetscCall(TSSetRHSFunction(ancf->ts, NULL, AncfRHSFunction, ancf));
      if (ancf->form == ANCF_FORM_SYMPLECTIC) PetscCall(AncfSetUpSymplectic(ancf));
    }
    PetscCall(TSSetSolution(ancf->ts, ancf->U));
  }
  PetscCall(AncfTSPush(ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfTSTouch(Ancf ancf)
{
  PetscScalar *y;

  PetscFunctionBegin;
  PetscCall(VecGetArray(ancf->U, &y));
  PetscCall(VecRestoreArray(ancf->U, &y));
  PetscCall(VecGetArray(ancf->V, &y));
  PetscCall(VecRestoreArray(ancf->V, &y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* State -> TS, whose history is discarded. */
PetscErrorCode AncfTSPush(Ancf ancf)
{
  PetscBool glee;

  PetscFunctionBegin;
  if (ancf->ngroups) {
    PetscCall(AncfGroupPush(ancf));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(TSSetTime(ancf->ts, ancf->t));
  PetscCall(TSRestartStep(ancf->ts));
  PetscCall(PetscObjectTypeCompare((PetscObject)ancf->ts, TSGLEE, &glee));
  if (glee) { /* carries several solutions, which it makes of ours when it is set up */
    PetscCall(TSReset(ancf->ts));
    PetscCall(TSSetSolution(ancf->ts, ancf->U));
  }
  ancf->restart = PETSC_TRUE;
  ancf->given = PETSC_FALSE;
  if (ancf->njoints) PetscCall(AncfJointSync(ancf, PETSC_TRUE, NULL));
  if (ancf->nmult && ancf->history) { /* the rates of multipliers, which no equation reads */
    PetscCall(PetscArrayzero(ancf->v + 6 * ancf->nnodes, ancf->nmult));
    PetscCall(PetscArrayzero(ancf->history + 6 * ancf->nnodes, ancf->nmult));
  }
  if (ancf->form == ANCF_FORM_SECOND)
    PetscCall(AncfTSTouch(ancf));
  else
    PetscCall(AncfTSCopy(ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfTSCopy(Ancf ancf)
{
  PetscScalar *y;

  PetscFunctionBegin;
  PetscCall(VecGetArray(ancf->U, &y));
  for (PetscInt j = 0; j < ancf->nnodes; j++)
    for (PetscInt c = 0; c < 6; c++) {
      y[12 * j + c] = ancf->e[6 * j + c];
      y[12 * j + 6 + c] = ancf->v[6 * j + c];
    }
  PetscCall(VecRestoreArray(ancf->U, &y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* TS -> state. */
PetscErrorCode AncfTSPull(Ancf ancf)
{
  PetscFunctionBegin;
  if (ancf->form != ANCF_FORM_SECOND) {
    const PetscScalar *y;

    PetscCall(VecGetArrayRead(ancf->U, &y));
    for (PetscInt j = 0; j < ancf->nnodes; j++)
      for (PetscInt c = 0; c < 6; c++) {
        ancf->e[6 * j + c] = y[12 * j + c];
        ancf->v[6 * j + c] = y[12 * j + 6 + c];
      }
    PetscCall(VecRestoreArrayRead(ancf->U, &y));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
