/*
  ancfmotion.c - supports of any node, their prescribed motion, and the forces they carry.

  A supported node keeps its rows (see ancfts.c); the beams see its prescribed coordinates e + v tau + a tau^2/2, tau being the
  time since the motion was given, whatever the integrator makes of its rows eddot = a.
*/
#include "ancfimpl.h"

/* Supports a node: the position, or position and gradient. Before AncfSetUp(); ends may also be given in AncfBeamSpec. */
PetscErrorCode AncfFixNode(Ancf ancf, PetscInt beam, PetscInt node, AncfEnd how)
{
  PetscFunctionBegin;
  PetscCheck(!ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfFixNode: supports cannot change after AncfSetUp()");
  PetscCheck(beam >= 0 && beam < ancf->nbeams, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "AncfFixNode: beam %" PetscInt_FMT " must be in 0..%" PetscInt_FMT, beam, ancf->nbeams - 1);
  PetscCheck(node >= 0 && node <= ancf->beams[beam].spec.elements, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "AncfFixNode: node %" PetscInt_FMT " of beam %" PetscInt_FMT " must be in 0..%" PetscInt_FMT, node, beam,
             ancf->beams[beam].spec.elements);
  PetscCheck(how == ANCF_END_PIN || how == ANCF_END_CLAMP, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "AncfFixNode: %d must be ANCF_END_PIN or ANCF_END_CLAMP", (int)how);
  if (ancf->nsupports == ancf->maxsupports) {
    ancf->maxsupports = PetscMax(16, 2 * ancf->maxsupports);
    PetscCall(PetscRealloc(sizeof(AncfSupport) * (size_t)ancf->maxsupports, &ancf->supports));
  }
  ancf->supports[ancf->nsupports++] = (AncfSupport){beam, node, how};
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfGetSupport(Ancf ancf, PetscInt beam, PetscInt node, AncfEnd *how)
{
  PetscInt j;

  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfGetSupport: call AncfSetUp() first");
  PetscCheck(beam >= 0 && beam < ancf->nbeams && node >= 0 && node <= ancf->beams[beam].spec.elements, ancf->comm,
             PETSC_ERR_ARG_OUTOFRANGE, "AncfGetSupport: there is no beam %" PetscInt_FMT " with a node %" PetscInt_FMT, beam,
             node);
  j = ancf->beams[beam].node + node;
  *how = ancf->fixed[j] & ANCF_FIX_GRADIENT ? ANCF_END_CLAMP : ancf->fixed[j] & ANCF_FIX_POSITION ? ANCF_END_PIN : ANCF_END_FREE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MotionNode(Ancf ancf, const char function[], PetscInt beam, PetscInt node, PetscInt *j)
{
  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "%s: call AncfSetUp() first", function);
  PetscCheck(beam >= 0 && beam < ancf->nbeams && node >= 0 && node <= ancf->beams[beam].spec.elements, ancf->comm,
             PETSC_ERR_ARG_OUTOFRANGE, "%s: there is no beam %" PetscInt_FMT " with a node %" PetscInt_FMT, function, beam, node);
  *j = ancf->beams[beam].node + node;
  PetscCheck(ancf->fixed[*j] & ANCF_FIX_POSITION, ancf->comm, PETSC_ERR_ARG_WRONG,
             "%s: node %" PetscInt_FMT " of beam %" PetscInt_FMT " has no support (AncfFixNode)", function, node, beam);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* State of the moving nodes of [0, nnodes) at time t: rest, its acceleration, and, if asked, the integrator's coordinates too. */
static void MoveNodes(Ancf ancf, PetscReal t, PetscBool state)
{
  const PetscReal tau = t - ancf->motiontime;

  for (PetscInt j = 0; j < ancf->nnodes; j++) {
    const PetscReal *m = ancf->motion + 18 * j;

    if (!(ancf->fixed[j] & ANCF_MOVING)) continue;
    for (int c = 0; c < 6; c++) {
      if (!(ancf->fixed[j] & (c < 3 ? ANCF_FIX_POSITION : ANCF_FIX_GRADIENT))) continue;
      ancf->rest[6 * j + c] = m[c] + tau * (m[6 + c] + 0.5 * tau * m[12 + c]);
      ancf->resta[6 * j + c] = m[12 + c];
      ancf->restv[6 * j + c] = m[6 + c] + tau * m[12 + c];
      ancf->restm[6 * j + c] = m[12 + c] + ancf->damping * (m[6 + c] + tau * m[12 + c]);
      if (!state) continue;
      ancf->e[6 * j + c] = ancf->rest[6 * j + c];
      ancf->v[6 * j + c] = m[6 + c] + tau * m[12 + c];
    }
  }
}

void AncfMove(Ancf ancf, PetscReal t)
{
  if (ancf->motion) MoveNodes(ancf, t, PETSC_FALSE);
}

/*
  In a stage at time t: where the integrator takes positions as linear between the ends of the step, the moving nodes go with the
  others, or a beam that accelerates as a whole would be strained, and a stiff one that drives a body would be unstable.
*/
void AncfMoveStage(Ancf ancf, PetscReal t)
{
  const PetscReal dt = ancf->stagedt, w = dt > 0 ? (t - ancf->stagestart) / dt : 0;

  if (!ancf->motion || !ancf->interpolates || w <= 0 || w >= 1) return;
  for (PetscInt j = 0; j < ancf->nnodes; j++)
    for (int c = 0; c < 6 && ancf->fixed[j] & ANCF_MOVING; c++)
      if (ancf->fixed[j] & (c < 3 ? ANCF_FIX_POSITION : ANCF_FIX_GRADIENT))
        ancf->rest[6 * j + c] += 0.5 * dt * dt * w * (1 - w) * ancf->motion[18 * j + 12 + c];
}

/* After a step: the moving nodes are exactly where they should be. */
PetscErrorCode AncfMoveNodes(Ancf ancf, PetscReal t)
{
  PetscFunctionBegin;
  if (!ancf->motion) PetscFunctionReturn(PETSC_SUCCESS);
  MoveNodes(ancf, t, PETSC_TRUE);
  if (ancf->njoints) PetscCall(AncfJointSync(ancf, PETSC_FALSE, NULL));
  if (ancf->form == ANCF_FORM_SECOND)
    PetscCall(AncfTSTouch(ancf));
  else
    PetscCall(AncfTSCopy(ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfMotionCreate(Ancf ancf)
{
  PetscFunctionBegin;
  if (ancf->motion) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2(6 * (size_t)ancf->nnodes, &ancf->stage, 6 * (size_t)ancf->nnodes, &ancf->impulse));
  PetscCall(PetscCalloc4(18 * (size_t)ancf->nnodes, &ancf->motion, 6 * (size_t)ancf->nnodes, &ancf->resta,
                         6 * (size_t)ancf->nnodes, &ancf->restm, 6 * (size_t)ancf->nnodes, &ancf->restv));
  for (PetscInt k = 0; k < ancf->ngroups; k++) {
    const PetscInt first = ancf->beams[ancf->groups[k]->firstbeam].node;

    ancf->groups[k]->stage = ancf->stage + 6 * first;
    ancf->groups[k]->impulse = ancf->impulse + 6 * first;
    ancf->groups[k]->motion = ancf->motion + 18 * first;
    ancf->groups[k]->resta = ancf->resta + 6 * first;
    ancf->groups[k]->restm = ancf->restm + 6 * first;
    ancf->groups[k]->restv = ancf->restv + 6 * first;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  AncfSetNodeMotion - prescribes a supported node's motion from the current time on: coordinates e, velocities v and constant
  accelerations a of its 6 coordinates (those that are not supported are ignored). Give it anew before each AncfAdvance(), or
  once for a uniformly accelerated support. e and v should continue the motion so far; a jump acts as an impact.
*/
PetscErrorCode AncfSetNodeMotion(Ancf ancf, PetscInt beam, PetscInt node, const PetscReal e[6], const PetscReal v[6],
                                 const PetscReal a[6])
{
  PetscInt j = 0;

  PetscFunctionBegin;
  PetscCall(MotionNode(ancf, "AncfSetNodeMotion", beam, node, &j));
  for (int c = 0; c < 6; c++)
    PetscCheck(!PetscIsInfOrNanReal(e[c] + v[c] + a[c]), ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "AncfSetNodeMotion: beam %" PetscInt_FMT ", node %" PetscInt_FMT ": coordinate %d (%g, %g, %g) must be finite",
               beam, node, c, (double)e[c], (double)v[c], (double)a[c]);
  PetscCall(AncfMotionCreate(ancf));
  if (ancf->motiontime != ancf->t) { /* the others go on from where they are */
    for (PetscInt i = 0; i < ancf->nnodes; i++)
      for (int c = 0; c < 6 && ancf->fixed[i] & ANCF_MOVING; c++) {
        ancf->motion[18 * i + c] = ancf->e[6 * i + c];
        ancf->motion[18 * i + 6 + c] = ancf->v[6 * i + c];
      }
    ancf->motiontime = ancf->t;
  }
  ancf->fixed[j] |= ANCF_MOVING;
  PetscCall(PetscArraycpy(ancf->motion + 18 * j, e, 6));
  PetscCall(PetscArraycpy(ancf->motion + 18 * j + 6, v, 6));
  PetscCall(PetscArraycpy(ancf->motion + 18 * j + 12, a, 6));
  for (PetscInt k = 0; k < ancf->ngroups; k++) {
    ancf->groups[k]->motiontime = ancf->motiontime;
    if (ancf->groups[k]->firstbeam <= beam && beam < ancf->groups[k]->firstbeam + ancf->groups[k]->nbeams)
      PetscCall(AncfMoveNodes(ancf->groups[k], ancf->t));
  }
  if (!ancf->ngroups) PetscCall(AncfMoveNodes(ancf, ancf->t));
  ancf->avalid = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfGetReactions(Ancf ancf, PetscReal f[])
{
  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfGetReactions: call AncfSetUp() first");
  PetscCall(AncfSupportForces(ancf, f, PETSC_TRUE));
  for (PetscInt i = 0; i < 6 * ancf->nnodes; i++)
    if (!(ancf->fixed[i / 6] & (i % 6 < 3 ? ANCF_FIX_POSITION : ANCF_FIX_GRADIENT))) f[i] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* When the last residual of a step holds, in steps after its middle; below 0: it is none of the equations of motion. */
static PetscErrorCode StageOffset(Ancf ancf, PetscReal *offset)
{
  PetscBool is, endpoint;
  PetscReal alpha;

  PetscFunctionBegin;
  *offset = -1;
  PetscCall(PetscObjectTypeCompare((PetscObject)ancf->ts, TSALPHA2, &is));
  if (is) {
    PetscCall(TSAlpha2GetParams(ancf->ts, NULL, &alpha, NULL, NULL));
    *offset = alpha - 0.5;
  }
  PetscCall(PetscObjectTypeCompare((PetscObject)ancf->ts, TSTHETA, &is));
  if (is) {
    PetscCall(TSThetaGetTheta(ancf->ts, &alpha));
    PetscCall(TSThetaGetEndpoint(ancf->ts, &endpoint));
    if (!endpoint) *offset = alpha - 0.5;
  }
  PetscCall(PetscObjectTypeCompareAny((PetscObject)ancf->ts, &is, TSBEULER, TSBDF, ""));
  if (is) *offset = 0.5;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfGetMeanReactions(Ancf ancf, PetscReal *offset, PetscReal f[])
{
  const Ancf one = ancf->ngroups ? ancf->groups[0] : ancf;

  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfGetMeanReactions: call AncfSetUp() first");
  *offset = -1;
  if (!ancf->stage || one->advanced <= 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StageOffset(one, offset));
  *offset /= *offset > 0 ? (PetscReal)ancf->substeps : 1;
  for (PetscInt i = 0; i < 6 * ancf->nnodes; i++) {
    const PetscBool fixed = ancf->fixed[i / 6] & (i % 6 < 3 ? ANCF_FIX_POSITION : ANCF_FIX_GRADIENT) ? PETSC_TRUE : PETSC_FALSE;

    f[i] = fixed ? ancf->impulse[i] / one->advanced : 0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  AncfGetNodeReaction - generalised force of a support on the beam: f[0..2] in N, f[3..5] work-conjugate to the gradient, N m (the
  moment of a clamp about its node is r' x f[3..5]).
*/
PetscErrorCode AncfGetNodeReaction(Ancf ancf, PetscInt beam, PetscInt node, PetscReal f[6])
{
  PetscReal *r;
  PetscInt j = 0;

  PetscFunctionBegin;
  PetscCall(MotionNode(ancf, "AncfGetNodeReaction", beam, node, &j));
  PetscCall(PetscMalloc1(6 * (size_t)ancf->nnodes, &r));
  PetscCall(AncfGetReactions(ancf, r));
  PetscCall(PetscArraycpy(f, r + 6 * j, 6));
  PetscCall(PetscFree(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}
