/*
  ancfresidual.c - the equations of motion of all beams (Eqs. 28-30), element by element or beam by beam in vector lanes.

  Eliminated coordinates (Sect. 2.3) keep their rows, so that the block structure is regular: the beams see their
  prescribed values whatever the solver proposes, and their rows read eddot = 0.
*/
#include "ancfbatch.h"

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
    if (ancf->natural) AncfRestForce(ancf, b->node, &s, e, Q, &U);
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
    if (ancf->natural) AncfRestForce(ancf, b->node, &s, x, Q, NULL);
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
      if (ancf->natural) {
        PetscInt node[ANCF_LANES];

        for (int i = 0; i < ANCF_LANES; i++) node[i] = k < b->elements[i] ? b->first[i] + k : -1;
        AncfRestForce(ancf, node, &s, x, Q, NULL);
      }
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
    AncfScatterLane(b, k, Q, f, fstride);
  }
}

/* f = -(loads) of nodes [j0, j1). */
static void Loads(const Ancf ancf, PetscInt j0, PetscInt j1, PetscReal *f, PetscInt fstride)
{
  const PetscReal scale = ancf->loadscale, *PETSC_RESTRICT steady = ancf->steady, *PETSC_RESTRICT load = ancf->load;
  PetscReal *PETSC_RESTRICT r = f;

  for (PetscInt j = j0; j < j1; j++)
    ANCF_UNROLL for (PetscInt c = 0; c < 6; c++) r[j * fstride + c] = -scale * (steady[6 * j + c] + load[6 * j + c]);
  if (ancf->loadnow == 0) return;
  for (PetscInt j = j0; j < j1; j++)
    for (PetscInt c = 0; c < 6; c++)
      f[j * fstride + c] -= scale * ancf->loadnow * (ancf->loadend[6 * j + c] - ancf->load[6 * j + c]);
}

static void Moments(const Ancf ancf, PetscInt j0, PetscInt j1, const PetscReal *e, PetscInt stride, PetscReal *f,
                    PetscInt fstride)
{
  for (PetscInt j = j0; j < j1 && ancf->moment; j++) {
    const PetscReal *M = ancf->moment + 3 * j;
    PetscReal Q[3];

    if (M[0] == 0 && M[1] == 0 && M[2] == 0) continue;
    AncfMomentForce(M, ancf->fixed[j] & ANCF_FIX_GRADIENT ? ancf->rest + 6 * j + 3 : e + j * stride + 3, Q, NULL);
    for (int c = 0; c < 3; c++) f[j * fstride + 3 + c] -= ancf->loadscale * Q[c];
  }
}

int AncfBatchNodes(const AncfLaneBeams *b, AncfNodes nodes[ANCF_LANES])
{
  int n = 0;

  for (int i = 0; i < ANCF_LANES; i++) {
    if (b->first[i] < 0) continue;
    if (n && nodes[n - 1].end == b->first[i])
      n--;
    else
      nodes[n].begin = b->first[i];
    nodes[n++].end = b->first[i] + b->elements[i] + 1;
  }
  return n;
}

/* The residual of the beams of batch k, a row of their own each: batches can go to different threads. */
static void ResidualBatch(Ancf ancf, PetscInt k, const PetscReal *e, PetscInt stride, const PetscReal *a, PetscInt astride,
                          PetscReal *f, PetscInt fstride)
{
  AncfNodes nodes[ANCF_LANES];
  const int n = AncfBatchNodes(&ancf->lanebeams[k], nodes);

  for (int i = 0; i < n; i++) Loads(ancf, nodes[i].begin, nodes[i].end, f, fstride);
  ResidualBeams(ancf, &ancf->lanebeams[k], e, stride, a, astride, f, fstride);
  for (int i = 0; i < n; i++) Moments(ancf, nodes[i].begin, nodes[i].end, e, stride, f, fstride);
}

PetscErrorCode AncfResidual(Ancf ancf, const PetscReal *e, PetscInt stride, const PetscReal *a, PetscInt astride, PetscReal *f,
                            PetscInt fstride)
{
  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(ANCF_Force, 0, 0, 0, 0));
  if (ancf->lanebeams) {
#pragma omp parallel for schedule(static) if (ancf->nlanebeams >= ANCF_PARALLEL)
    for (PetscInt k = 0; k < ancf->nlanebeams; k++) ResidualBatch(ancf, k, e, stride, a, astride, f, fstride);
  } else {
    Loads(ancf, 0, ancf->nnodes, f, fstride);
    ResidualElements(ancf, e, stride, a, astride, f, fstride);
    Moments(ancf, 0, ancf->nnodes, e, stride, f, fstride);
  }
  PetscCall(PetscLogEventEnd(ANCF_Force, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void FixRows(const Ancf ancf, PetscInt j0, PetscInt j1, const PetscReal *x, PetscInt stride, PetscReal *f,
                    PetscInt fstride)
{
  for (PetscInt j = j0; j < j1; j++) {
    const unsigned char fix = ancf->fixed[j];

    if (PetscLikely(!fix)) continue;
    for (int c = 0; c < 6; c++) {
      const PetscReal a = ancf->resta ? ancf->resta[6 * j + c] : 0;

      if (fix & (c < 3 ? ANCF_FIX_POSITION : ANCF_FIX_GRADIENT)) f[j * fstride + c] = x ? x[j * stride + c] - a : a;
    }
  }
}

void AncfFixRows(Ancf ancf, const PetscReal *x, PetscInt stride, PetscReal *f, PetscInt fstride)
{
  FixRows(ancf, 0, ancf->nnodes, x, stride, f, fstride);
}

/* AncfMotionResidual() of the beams of batch k, without joints and internal damping; arrays are nodes x 6. */
void AncfMotionBatch(Ancf ancf, PetscInt k, const PetscReal *e, const PetscReal *v, const PetscReal *a, PetscReal *f)
{
  const PetscReal *m = ancf->damping == 0 ? a : ancf->damped;
  AncfNodes nodes[ANCF_LANES];
  const int n = AncfBatchNodes(&ancf->lanebeams[k], nodes);

  for (int r = 0; r < n && ancf->damping != 0; r++)
    for (PetscInt i = 6 * nodes[r].begin; i < 6 * nodes[r].end; i++) ancf->damped[i] = a[i] + ancf->damping * v[i];
  ResidualBatch(ancf, k, e, 6, m, 6, f, 6);
  for (int r = 0; r < n; r++) {
    for (PetscInt i = 6 * nodes[r].begin; i < 6 * nodes[r].end && ancf->stage; i++) ancf->stage[i] = f[i];
    FixRows(ancf, nodes[r].begin, nodes[r].end, a, 6, f, 6);
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
PetscErrorCode AncfSupportForces(Ancf ancf, PetscReal *f, PetscBool supports)
{
  const PetscReal *a;
  PetscInt stride;

  PetscFunctionBegin;
  PetscCall(AncfComputeAcceleration(ancf));
  a = AncfDamped(ancf, ancf->v, ancf->a, 6, &stride);
  PetscCall(AncfResidual(ancf, ancf->e, 6, a, stride, f, 6));
  AncfAddViscous(ancf, ancf->e, ancf->v, 6, f, 6, NULL);
  if (supports && ancf->njoints) {
    PetscCall(AncfJointState(ancf, ancf->e, ancf->v, 6, NULL, 0));
    PetscCall(AncfJointReduce(ancf, f, 6, NULL, 0));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfFreeResidual(Ancf ancf, const PetscReal *e, const PetscReal *v, const PetscReal *a, PetscInt stride,
                                PetscReal *f, PetscInt fstride)
{
  PetscInt mstride;
  const PetscReal *m = AncfDamped(ancf, v, a, stride, &mstride);

  PetscFunctionBegin;
  PetscCall(AncfResidual(ancf, e, stride, m, mstride, f, fstride));
  AncfAddViscous(ancf, e, v, stride, f, fstride, NULL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfMotionResidual(Ancf ancf, const PetscReal *e, const PetscReal *v, const PetscReal *a, PetscInt stride,
                                  PetscReal *f, PetscInt fstride)
{
  const PetscReal *x = e, *xv = v, *xa = a, *m;
  PetscInt xstride = stride, mstride;

  PetscFunctionBegin;
  if (ancf->njoints) {
    PetscCall(AncfJointState(ancf, e, v, stride, a, stride));
    x = ancf->je, xv = ancf->jv, xa = ancf->ja, xstride = 6;
  }
  m = AncfDamped(ancf, xv, xa, xstride, &mstride);
  PetscCall(AncfResidual(ancf, x, xstride, m, mstride, f, fstride));
  AncfAddViscous(ancf, x, xv, xstride, f, fstride, NULL);
  if (ancf->njoints) PetscCall(AncfJointReduce(ancf, f, fstride, a, stride));
  if (ancf->stage)
    for (PetscInt i = 0; i < 6 * ancf->nnodes; i++) ancf->stage[i] = f[(i / 6) * fstride + i % 6];
  AncfFixRows(ancf, a, stride, f, fstride);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* a = M^-1 (Q^g + Q^a - Q^e), coordinates and result with their own strides */
PetscErrorCode AncfExplicitAcceleration(Ancf ancf, const PetscReal *e, const PetscReal *v, PetscInt stride, PetscReal *a,
                                        PetscInt astride)
{
  const PetscReal damping = v ? ancf->damping : 0;

  PetscFunctionBegin;
  if (ancf->njoints) {
    PetscCall(AncfJointAcceleration(ancf, e, v, stride, a, astride));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(AncfResidual(ancf, e, stride, ancf->restm, 6, a, astride));
  if (v) AncfAddViscous(ancf, e, v, stride, a, astride, NULL);
  for (PetscInt j = 0; j < ancf->nnodes; j++)
    for (PetscInt c = 0; c < 6; c++) a[j * astride + c] = -a[j * astride + c];
  AncfFixRows(ancf, NULL, 0, a, astride);
  PetscCall(AncfMassSolve(ancf, a, astride));
  for (PetscInt j = 0; v && damping > 0 && j < ancf->nnodes; j++)
    for (int c = 0; c < 6; c++)
      if (!(ancf->fixed[j] & (c < 3 ? ANCF_FIX_POSITION : ANCF_FIX_GRADIENT))) a[j * astride + c] -= damping * v[j * stride + c];
  PetscFunctionReturn(PETSC_SUCCESS);
}
