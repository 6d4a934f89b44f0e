/*
  ancfts.c - assembly of the equations of motion (Eqs. 28-30) and their TS callbacks.

  Eliminated coordinates (Sect. 2.3) keep their rows, so that the block structure is regular: the beams see their
  prescribed values whatever the solver proposes, and their rows read eddot = 0.
*/
#include "ancfbatch.h"

/*
  Which form each TS type takes; anything else is refused. The last column: nothing is carried from step to step but the state
  and, by TSALPHA2, the acceleration.
*/
static const struct {
  const char *type;
  AncfForm form;
  PetscBool exact;
} ancf_types[] = {
    {TSALPHA2, ANCF_FORM_SECOND, PETSC_TRUE},
    {TSBEULER, ANCF_FORM_FIRST, PETSC_TRUE},
    {TSCN, ANCF_FORM_FIRST, PETSC_TRUE},
    {TSTHETA, ANCF_FORM_FIRST, PETSC_FALSE},
    {TSBDF, ANCF_FORM_FIRST, PETSC_FALSE},
    {TSALPHA, ANCF_FORM_FIRST, PETSC_FALSE},
    {TSARKIMEX, ANCF_FORM_FIRST, PETSC_FALSE},
    {"dirk", ANCF_FORM_FIRST, PETSC_FALSE},
    {TSROSW, ANCF_FORM_FIRST, PETSC_FALSE},
    {TSEULER, ANCF_FORM_EXPLICIT, PETSC_TRUE},
    {TSRK, ANCF_FORM_EXPLICIT, PETSC_FALSE},
    {TSSSP, ANCF_FORM_EXPLICIT, PETSC_FALSE},
    {TSBASICSYMPLECTIC, ANCF_FORM_SYMPLECTIC, PETSC_TRUE},
};

PetscErrorCode AncfElasticEnergy(Ancf ancf, PetscReal *W)
{
  PetscReal w = 0;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < ancf->nbatches; k++) {
    const AncfBatch *b = &ancf->batches[k];
    AncfSection s = AncfBatchSection(b);
    AncfLanes e[12], Q[12], U;

    AncfGather(ancf, b, ancf->e, 6, ancf->rest, e);
    AncfElementForce(&ancf->rule, &s, e, Q, &U);
    for (PetscInt i = 0; i < b->n; i++) w += U[i];
  }
  *W = w;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Elements in lanes; f holds minus the loads already. */
static void ResidualElements(Ancf ancf, const PetscReal *e, PetscInt stride, const PetscReal *a, PetscInt astride, PetscReal *f,
                             PetscInt fstride)
{
  for (PetscInt k = 0; k < ancf->nbatches; k++) {
    const AncfBatch *b = &ancf->batches[k];
    AncfSection s = AncfBatchSection(b);
    AncfLanes x[12], Q[12];

    AncfGather(ancf, b, e, stride, ancf->rest, x);
    AncfElementForce(&ancf->rule, &s, x, Q, NULL);
    if (a) {
      AncfGather(ancf, b, a, astride, ancf->restm, x);
      AncfElementInertia(AncfLoad(b->rhoA), s.l, x, Q);
    }
    for (PetscInt i = 0; i < b->n; i++) {
      PetscReal *fj = f + b->node[i] * fstride;

      for (int c = 0; c < 6; c++) fj[c] += Q[c][i];
      for (int c = 0; c < 6; c++) fj[fstride + c] += Q[6 + c][i];
    }
  }
}

/* Beams in lanes: each node is read and written once. */
static void ResidualBeams(Ancf ancf, const AncfLaneBeams *b, const PetscReal *e, PetscInt stride, const PetscReal *a,
                          PetscInt astride, PetscReal *f, PetscInt fstride)
{
  const AncfSection full = {AncfLoad(b->EA), AncfLoad(b->EI), AncfLoad(b->l)};
  AncfLanes x[12], y[12], left[6];

  for (int c = 0; c < 12; c++) x[c] = y[c] = (AncfLanes){0};
  for (int c = 0; c < 6; c++) left[c] = (AncfLanes){0};
  AncfGatherLane(ancf, b, 0, e, stride, ancf->rest, x);
  if (a) AncfGatherLane(ancf, b, 0, a, astride, ancf->restm, y);
  for (PetscInt k = 0; k <= b->most; k++) {
    AncfLanes Q[12], mass = AncfLoad(b->rhoA);
    AncfSection s = full;

    if (k < b->most) {
      AncfGatherLane(ancf, b, k + 1, e, stride, ancf->rest, x + 6);
      for (int i = 0; i < ANCF_LANES && k >= b->least; i++)
        if (k >= b->elements[i]) AncfIdleLane(i, &s, &mass, x);
      AncfElementForce(&ancf->rule, &s, x, Q, NULL);
      if (a) {
        AncfGatherLane(ancf, b, k + 1, a, astride, ancf->restm, y + 6);
        AncfElementInertia(mass, s.l, y, Q);
      }
    } else
      for (int c = 0; c < 12; c++) Q[c] = (AncfLanes){0};
    for (int c = 0; c < 6; c++) {
      Q[c] += left[c];
      left[c] = Q[6 + c];
      x[c] = x[6 + c];
      y[c] = y[6 + c];
    }
    for (int i = 0; i < ANCF_LANES; i++)
      if (k <= b->elements[i])
        for (int c = 0; c < 6; c++) f[(b->first[i] + k) * fstride + c] += Q[c][i];
  }
}

PetscErrorCode AncfResidual(Ancf ancf, const PetscReal *e, PetscInt stride, const PetscReal *a, PetscInt astride, PetscReal *f,
                            PetscInt fstride)
{
  const PetscReal scale = ancf->loadscale;

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(ANCF_Force, 0, 0, 0, 0));
  for (PetscInt j = 0; j < ancf->nnodes; j++)
    for (PetscInt c = 0; c < 6; c++) f[j * fstride + c] = -scale * (ancf->steady[6 * j + c] + ancf->load[6 * j + c]);
  if (ancf->loadnow != 0)
    for (PetscInt j = 0; j < ancf->nnodes; j++)
      for (PetscInt c = 0; c < 6; c++)
        f[j * fstride + c] -= scale * ancf->loadnow * (ancf->loadend[6 * j + c] - ancf->load[6 * j + c]);
  if (ancf->lanebeams)
    for (PetscInt k = 0; k < ancf->nlanebeams; k++) ResidualBeams(ancf, &ancf->lanebeams[k], e, stride, a, astride, f, fstride);
  else
    ResidualElements(ancf, e, stride, a, astride, f, fstride);
  for (PetscInt j = 0; j < ancf->nnodes && ancf->moment; j++) {
    const PetscReal *M = ancf->moment + 3 * j;
    PetscReal Q[3];

    if (M[0] == 0 && M[1] == 0 && M[2] == 0) continue;
    AncfMomentForce(M, ancf->fixed[j] & ANCF_FIX_GRADIENT ? ancf->rest + 6 * j + 3 : e + j * stride + 3, Q, NULL);
    for (int c = 0; c < 3; c++) f[j * fstride + 3 + c] -= scale * Q[c];
  }
  PetscCall(PetscLogEventEnd(ANCF_Force, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void AncfFixRows(Ancf ancf, const PetscReal *x, PetscInt stride, PetscReal *f, PetscInt fstride)
{
  for (PetscInt j = 0; j < ancf->nnodes; j++) {
    const unsigned char fix = ancf->fixed[j];

    if (PetscLikely(!fix)) continue;
    for (int c = 0; c < 6; c++) {
      const PetscReal a = ancf->resta ? ancf->resta[6 * j + c] : 0;

      if (fix & (c < 3 ? ANCF_FIX_POSITION : ANCF_FIX_GRADIENT)) f[j * fstride + c] = x ? x[j * stride + c] - a : a;
    }
  }
}

/* Mass-proportional damping, C = damping M, enters as the acceleration a + damping v; returns a itself without damping. */
static const PetscReal *AncfDamped(Ancf ancf, const PetscReal *v, const PetscReal *a, PetscInt stride, PetscInt *outstride)
{
  *outstride = stride;
  if (ancf->damping == 0) return a;
  *outstride = 6;
  for (PetscInt j = 0; j < ancf->nnodes; j++)
    for (PetscInt c = 0; c < 6; c++) ancf->damped[6 * j + c] = a[j * stride + c] + ancf->damping * v[j * stride + c];
  return ancf->damped;
}

/* The full equations of motion at the current state, constraints ignored: what the supports must supply. */
PetscErrorCode AncfSupportForces(Ancf ancf, PetscReal *f)
{
  const PetscReal *a;
  PetscInt stride;

  PetscFunctionBegin;
  PetscCall(AncfComputeAcceleration(ancf));
  a = AncfDamped(ancf, ancf->v, ancf->a, 6, &stride);
  PetscCall(AncfResidual(ancf, ancf->e, 6, a, stride, f, 6));
  AncfAddViscous(ancf, ancf->e, ancf->v, 6, f, 6, NULL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* F = M a + C v + Q^e - Q^g - Q^a */
static PetscErrorCode AncfI2Function(TS ts, PetscReal t, Vec U, Vec V, Vec A, Vec F, void *ctx)
{
  Ancf ancf = (Ancf)ctx;
  const PetscScalar *u, *v, *a;
  PetscScalar *f;

  PetscFunctionBegin;
  (void)ts;
  AncfSetLoadTime((Ancf)ctx, t);
  PetscCall(VecGetArrayRead(U, &u));
  PetscCall(VecGetArrayRead(V, &v));
  PetscCall(VecGetArrayRead(A, &a));
  PetscCall(VecGetArrayWrite(F, &f));
  if (ancf->priming)
    PetscCall(AncfAlphaFunction(ancf, a, f));
  else {
    PetscInt stride;
    const PetscReal *m = AncfDamped(ancf, v, a, 6, &stride);

    PetscCall(AncfResidual(ancf, u, 6, m, stride, f, 6));
    AncfAddViscous(ancf, u, v, 6, f, 6, NULL);
    AncfFixRows(ancf, a, 6, f, 6);
  }
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
  const PetscReal *m;
  PetscScalar *f;
  PetscInt stride;

  PetscFunctionBegin;
  (void)ts;
  AncfSetLoadTime((Ancf)ctx, t);
  PetscCall(VecGetArrayRead(Y, &y));
  PetscCall(VecGetArrayRead(Ydot, &yd));
  PetscCall(VecGetArrayWrite(F, &f));
  m = AncfDamped(ancf, y + 6, yd + 6, 12, &stride);
  PetscCall(AncfResidual(ancf, y, 12, m, stride, f + 6, 12));
  AncfAddViscous(ancf, y, y + 6, 12, f + 6, 12, NULL);
  AncfFixRows(ancf, yd + 6, 12, f + 6, 12);
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
  PetscCall(AncfAssemble((Ancf)ctx, y, y + 6, 12, shift + ((Ancf)ctx)->damping, 1, shift, J, P));
  PetscCall(VecRestoreArrayRead(Y, &y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* a = M^-1 (Q^g + Q^a - Q^e), coordinates and result with their own strides */
PetscErrorCode AncfExplicitAcceleration(Ancf ancf, const PetscReal *e, const PetscReal *v, PetscInt stride, PetscReal *a,
                                        PetscInt astride)
{
  const PetscReal damping = v ? ancf->damping : 0;

  PetscFunctionBegin;
  PetscCall(AncfResidual(ancf, e, stride, ancf->restm, 6, a, astride));
  if (v) AncfAddViscous(ancf, e, v, stride, a, astride, NULL);
  for (PetscInt j = 0; j < ancf->nnodes; j++)
    for (PetscInt c = 0; c < 6; c++) a[j * astride + c] = -a[j * astride + c];
  AncfFixRows(ancf, NULL, 0, a, astride);
  PetscCall(AncfMassSolve(ancf, a, astride));
  for (PetscInt j = 0; j < ancf->nnodes && damping > 0; j++)
    for (int c = 0; c < 6; c++)
      if (!(ancf->fixed[j] & (c < 3 ? ANCF_FIX_POSITION : ANCF_FIX_GRADIENT))) a[j * astride + c] -= damping * v[j * stride + c];
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
  if (ancf->form == ANCF_FORM_SECOND) PetscCall(AncfAlphaPreStep(ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AncfPreStage(TS ts, PetscReal t)
{
  Ancf ancf;

  PetscFunctionBegin;
  (void)t;
  PetscCall(TSGetApplicationContext(ts, &ancf));
  PetscCall(TSGetTimeStep(ts, &ancf->stagedt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A step that was reduced because Newton failed grows again, which TSADAPTNONE would not do. */
static PetscErrorCode AncfPostStep(TS ts)
{
  PetscReal t, tmax, dt;
  Ancf ancf;

  PetscFunctionBegin;
  PetscCall(TSGetApplicationContext(ts, &ancf));
  if (ancf->form == ANCF_FORM_SECOND) PetscCall(AncfAlphaPostStep(ancf));
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
  /* Full steps: bending first stretches the chord, so that the residual rises before it falls; a step that fails is reduced. */
  PetscCall(SNESGetLineSearch(snes, &search));
  PetscCall(SNESLineSearchSetType(search, ANCF_FULL_STEP));
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

PetscErrorCode AncfChooseForm(Ancf ancf)
{
  TSType type;
  TSAdapt adapt;
  PetscBool fixedstep;
  const size_t n = sizeof(ancf_types) / sizeof(ancf_types[0]);
  size_t k;
  char list[256] = "";

  PetscFunctionBegin;
  PetscCall(TSGetType(ancf->ts, &type));
  for (k = 0; k < n; k++) {
    PetscBool match;

    PetscCall(PetscStrcmp(type, ancf_types[k].type, &match));
    if (match) break;
    PetscCall(PetscStrlcat(list, " ", sizeof(list)));
    PetscCall(PetscStrlcat(list, ancf_types[k].type, sizeof(list)));
  }
  PetscCheck(k < n, ancf->comm, PETSC_ERR_ARG_WRONG, "-ancf_ts_type %s cannot integrate beams; use one of:%s", type, list);
  PetscCall(TSGetAdapt(ancf->ts, &adapt));
  PetscCall(PetscObjectTypeCompare((PetscObject)adapt, TSADAPTNONE, &fixedstep));
  ancf->form = ancf_types[k].form;
  ancf->exact = (PetscBool)(ancf_types[k].exact && fixedstep);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  TSARKIMEX accepts a mass matrix other than the identity only in tableaux without an explicit first stage; l2 (L-stable,
  second order) is our default among them.
*/
static PetscErrorCode AncfChooseARKIMEX(Ancf ancf)
{
  const char *const fit[] = {TSARKIMEXL2, TSARKIMEX1BEE, TSARKIMEXPRSSP2};
  TSARKIMEXType type;
  const char *prefix;
  PetscBool is, given;

  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)ancf->ts, TSARKIMEX, &is));
  if (!is) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TSARKIMEXGetType(ancf->ts, &type));
  for (int k = 0; k < 3; k++) {
    PetscCall(PetscStrcmp(type, fit[k], &is));
    if (is) PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(TSGetOptionsPrefix(ancf->ts, &prefix));
  PetscCall(PetscOptionsHasName(NULL, prefix, "-ts_arkimex_type", &given));
  PetscCheck(!given, ancf->comm, PETSC_ERR_ARG_WRONG,
             "-ancf_ts_arkimex_type %s cannot take the mass matrix of beams; use one of: l2 1bee prssp2", type);
  PetscCall(TSARKIMEXSetType(ancf->ts, TSARKIMEXL2));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfTSSetUp(Ancf ancf)
{
  const PetscInt n = 6 * ancf->nnodes;
  SNES snes;
  KSP ksp;
  PC pc;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * n, &ancf->backup));
  PetscCall(TSSetApplicationContext(ancf->ts, ancf));
  PetscCall(TSSetPreStep(ancf->ts, AncfPreStep));
  PetscCall(TSSetPreStage(ancf->ts, AncfPreStage));
  PetscCall(TSSetPostStep(ancf->ts, AncfPostStep));
  PetscCall(AncfChooseForm(ancf));
  PetscCall(AncfChooseARKIMEX(ancf));
  PetscCheck(ancf->damping == 0 || ancf->form != ANCF_FORM_SYMPLECTIC, ancf->comm, PETSC_ERR_ARG_INCOMP,
             "-ancf_damping %g needs another -ancf_ts_type than basicsymplectic, which takes no velocities",
             (double)ancf->damping);
  PetscCheck(
      !ancf->viscous || ancf->form != ANCF_FORM_SYMPLECTIC, ancf->comm, PETSC_ERR_ARG_INCOMP,
      "-ancf_damping_stiffness %g and beams with axial or bending damping need another -ancf_ts_type than basicsymplectic, "
      "which takes no velocities",
      (double)ancf->stiffnessdamping);
  if (ancf->damping > 0) PetscCall(PetscMalloc1(6 * ancf->nnodes, &ancf->damped));
  PetscCall(TSGetSNES(ancf->ts, &snes));
  PetscCall(SNESGetKSP(snes, &ksp));
  PetscCall(KSPGetPC(ksp, &pc));
  if (ancf->form == ANCF_FORM_SECOND) {
    PetscCall(VecCreateSeqWithArray(ancf->comm, 6, n, ancf->e, &ancf->U));
    PetscCall(VecCreateSeqWithArray(ancf->comm, 6, n, ancf->v, &ancf->V));
    PetscCall(AncfCreateMatrix(ancf, 6, pc, PETSC_TRUE, &ancf->J));
    PetscCall(TSSetI2Function(ancf->ts, NULL, AncfI2Function, ancf));
    PetscCall(TSSetI2Jacobian(ancf->ts, ancf->J, ancf->J, AncfI2Jacobian, ancf));
    PetscCall(TS2SetSolution(ancf->ts, ancf->U, ancf->V));
    PetscCall(SNESSetComputeInitialGuess(snes, AncfPredict, ancf));
    PetscCall(AncfAlphaSetUp(ancf));
  } else {
    PetscCall(VecCreateSeq(ancf->comm, 2 * n, &ancf->U));
    if (ancf->form == ANCF_FORM_FIRST) {
      PetscCall(AncfCreateMatrix(ancf, 12, pc, PETSC_TRUE, &ancf->J));
      PetscCall(TSSetEquationType(ancf->ts, TS_EQ_ODE_IMPLICIT));
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
  PetscFunctionBegin;
  if (ancf->ngroups) {
    PetscCall(AncfGroupPush(ancf));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(TSSetTime(ancf->ts, ancf->t));
  PetscCall(TSRestartStep(ancf->ts));
  ancf->restart = PETSC_TRUE;
  ancf->given = PETSC_FALSE;
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
  PetscCall(VecGetArrayWrite(ancf->U, &y));
  for (PetscInt j = 0; j < ancf->nnodes; j++)
    for (PetscInt c = 0; c < 6; c++) {
      y[12 * j + c] = ancf->e[6 * j + c];
      y[12 * j + 6 + c] = ancf->v[6 * j + c];
    }
  PetscCall(VecRestoreArrayWrite(ancf->U, &y));
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
