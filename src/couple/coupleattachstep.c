/*
  coupleattachstep.c - nodes of ANCF beams attached to rigid bodies: a moving clamp where the node is clamped, a ball joint where
  it is pinned.

  Over a step dt the bodies move under the wrenches W that the beams exert, held constant; the nodes follow the bodies' points,
  r + v tau + a tau^2/2 with a = (v_1 - v_0)/dt, so that node and point have one velocity at the ends of the step (their places
  are made one anew each step; they part by O(dt^3)); the beams advance and answer with the reactions of these supports, those of
  the integrator's own equations where it tells them (AncfGetMeanReactions()), else the mean of both ends of the step. W is found
  such that it is that answer, G(W) = W, by Broyden's method on R = G - W (Math. Comp. 19 (1965), inverse form), six unknowns a
  body, whose matrix is kept from step to step; where it is slow, from differences. A plain exchange of motion and reaction would
  diverge where the beams outweigh the body.

  Where a set of joined beams has no other support than free bodies, its change of momentum less the impulse of its loads is what
  the bodies gave: the reactions are corrected to that sum, and their moments likewise when one of them is a clamp. With the
  lever of each force at the middle of the step, as the bodies' kick - free flight - kick has it, momenta of beams and bodies
  together are then kept to the tolerance (of the motion, so that of a force times 1 + the beams' mass over the body's), but for
  the second-order error in the moment of loads.
*/
#include "coupleattach.h"

PetscErrorCode CoupleAttachFollow(CoupleAttach l, const Attachment *a, PetscReal e[6], PetscReal v[6])
{
  PetscReal X[3], q[4], V[3], w[3], R[9], d[3], wd[3];

  PetscFunctionBegin;
  PetscCall(RigidGetState(l->rigid, a->body, X, q, V, w));
  RigidRotationMatrix(q, R);
  Turn(R, PETSC_FALSE, a->place, d);
  CoupleCross(w, d, wd);
  for (int c = 0; c < 3; c++) e[c] = X[c] + d[c], v[c] = V[c] + wd[c];
  Turn(R, PETSC_FALSE, a->gradient, e + 3);
  CoupleCross(w, e + 3, v + 3);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The Jacobian of R is about -(1 + mass of the beams over that of the body). */
void CoupleAttachFirstInverse(CoupleAttach l)
{
  const PetscInt m = 6 * l->nfree;

  for (PetscInt i = 0; i < m * m; i++) l->B[i] = 0;
  for (PetscInt i = 0; i < m; i++) l->B[i * m + i] = -1 / (1 + l->ratio[i / 6]);
}

void CoupleAttachSum(CoupleAttach l)
{
  for (int c = 0; c < 3; c++) {
    l->sum[0][c] = l->sum[1][c];
    l->sum[1][c] = 0;
    for (PetscInt i = 0; i < l->n; i++) l->sum[1][c] += l->f1[6 * l->a[i].at + c];
  }
}

/* Sums over the beams of each set, 12 per set: p, L, F, T. */
static PetscErrorCode Balances(CoupleAttach l, PetscInt set, PetscReal sum[12])
{
  PetscReal *x = l->balance;
  const PetscInt n = 3 * l->nbeams;

  PetscFunctionBegin;
  for (int k = 0; k < 12; k++) sum[k] = 0;
  for (PetscInt b = 0; b < l->nbeams; b++)
    for (int k = 0; k < 12 && l->setof[b] == set; k++) sum[k] += x[k / 3 * n + 3 * b + k % 3];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BeamBalances(CoupleAttach l)
{
  PetscReal *x = l->balance;
  const PetscInt n = 3 * l->nbeams;

  PetscFunctionBegin;
  PetscCall(AncfGetBeamBalances(l->ancf, x, x + n, x + 2 * n, x + 3 * n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Wrenches of free bodies in or out of the loads. */
static PetscErrorCode Load(CoupleAttach l, const PetscReal *W, PetscReal sign)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < l->nfree; k++) {
    PetscReal F[3], T[3];

    for (int c = 0; c < 3; c++) F[c] = sign * W[6 * k + c], T[c] = sign * W[6 * k + 3 + c] * l->length[k];
    PetscCall(RigidAddLoad(l->rigid, l->free[k], F, T));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Mean reactions over the step: of the integrator, moved from its time in the step to the middle between this step and the last
  one, or else from both ends of the step.
*/
static PetscErrorCode Reactions(CoupleAttach l, const PetscReal *e0, const PetscReal *e1)
{
  PetscReal offset;

  PetscFunctionBegin;
  PetscCall(AncfGetMeanReactions(l->ancf, &offset, l->f2));
  for (PetscInt i = 0; i < l->n; i++) {
    Attachment *a = &l->a[i];
    PetscReal m0[3], m1[3];

    CoupleCross(e0 + 6 * i + 3, l->f0 + 6 * a->at + 3, m0);
    CoupleCross(e1 + 6 * a->at + 3, l->f1 + 6 * a->at + 3, m1);
    for (int c = 0; c < 3; c++) {
      a->F[c] = 0.5 * (l->f0[6 * a->at + c] + l->f1[6 * a->at + c]);
      a->M[c] = a->clamp ? 0.5 * (m0[c] + m1[c]) : 0;
      a->x0[c] = e0[6 * i + c];
      a->x1[c] = e1[6 * a->at + c];
    }
    if (offset < 0) continue;
    for (int c = 0; c < 3; c++) m1[c] = 0.5 * (e0[6 * i + 3 + c] + e1[6 * a->at + 3 + c]);
    CoupleCross(m1, l->f2 + 6 * a->at + 3, m0);
    for (int c = 0; c < 3; c++) {
      a->raw[c] = l->f2[6 * a->at + c];
      a->raw[3 + c] = a->clamp ? m0[c] : 0;
      a->F[c] = a->raw[c] - (l->known ? offset * (a->raw[c] - a->last[c]) : 0);
      a->M[c] = a->raw[3 + c] - (l->known ? offset * (a->raw[3 + c] - a->last[3 + c]) : 0);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of the closed sets to their change of momentum. */
static PetscErrorCode Correct(CoupleAttach l, PetscReal dt)
{
  PetscFunctionBegin;
  PetscCall(BeamBalances(l));
  for (PetscInt s = 0; s < l->nsets; s++) {
    const BeamSet *set = &l->sets[s];
    PetscReal end[12], miss[6], mid[3], xF[3];

    if (!set->closed) continue;
    PetscCall(Balances(l, s, end));
    for (int k = 0; k < 6; k++) miss[k] = (end[k] - set->balance[k]) / dt - 0.5 * (end[6 + k] + set->balance[6 + k]);
    for (PetscInt i = 0; i < l->n; i++)
      for (int c = 0; c < 3 && l->a[i].set == s; c++) miss[c] -= l->a[i].F[c];
    for (PetscInt i = 0; i < l->n; i++) {
      Attachment *a = &l->a[i];

      if (a->set != s) continue;
      for (int c = 0; c < 3; c++) a->F[c] += miss[c] / (PetscReal)set->n, mid[c] = 0.5 * (a->x0[c] + a->x1[c]);
      CoupleCross(mid, a->F, xF);
      for (int c = 0; c < 3; c++) miss[3 + c] -= xF[c] + a->M[c];
    }
    for (PetscInt i = 0; i < l->n; i++)
      for (int c = 0; c < 3 && l->a[i].set == s && l->a[i].clamp; c++) l->a[i].M[c] += miss[3 + c] / (PetscReal)set->clamps;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the beams exert on the bodies, about their centres. */
static PetscErrorCode Answer(CoupleAttach l)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < 6 * l->nfree; k++) l->G[k] = 0;
  for (PetscInt i = 0; i < l->n; i++) {
    const Attachment *a = &l->a[i];
    PetscReal X[3], arm[3], aF[3], *G;

    if (a->unknown < 0) continue;
    G = l->G + 6 * a->unknown;
    PetscCall(RigidGetState(l->rigid, a->body, X, NULL, NULL, NULL));
    for (int c = 0; c < 3; c++) arm[c] = 0.5 * (a->x0[c] + a->x1[c]) - 0.5 * (l->X[3 * a->unknown + c] + X[c]);
    CoupleCross(arm, a->F, aF);
    for (int c = 0; c < 3; c++) {
      G[c] -= a->F[c];
      G[3 + c] -= (aF[c] + a->M[c]) / l->length[a->unknown];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bodies and beams from the start of the step to t under W; R = G - W. */
static PetscErrorCode Evaluate(CoupleAttach l, PetscReal t0, PetscReal t, PetscBool again)
{
  PetscReal *e0, *v0, e[6], v[6], a[6];
  const PetscReal *e1;

  PetscFunctionBegin;
  if (again) {
    PetscCall(RigidSetTime(l->rigid, t0));
    PetscCall(RigidUnpack(l->rigid, l->bodies));
    PetscCall(AncfUnpack(l->ancf, l->beams));
  }
  PetscCall(PetscMalloc2(6 * (size_t)l->n, &e0, 6 * (size_t)l->n, &v0));
  for (PetscInt i = 0; i < l->n; i++) PetscCall(CoupleAttachFollow(l, &l->a[i], e0 + 6 * i, v0 + 6 * i));
  PetscCall(Load(l, l->W, 1));
  PetscCall(RigidAdvance(l->rigid, t));
  for (PetscInt i = 0; i < l->n; i++) {
    PetscCall(CoupleAttachFollow(l, &l->a[i], e, v));
    for (int c = 0; c < 6; c++) a[c] = (v[c] - v0[6 * i + c]) / (t - t0);
    PetscCall(AncfSetNodeMotion(l->ancf, l->a[i].beam, l->a[i].node, e0 + 6 * i, v0 + 6 * i, a));
  }
  PetscCall(AncfGetReactions(l->ancf, l->f0));
  PetscCall(AncfAdvance(l->ancf, t));
  PetscCall(AncfGetReactions(l->ancf, l->f1));
  PetscCall(AncfGetState(l->ancf, NULL, &e1, NULL, NULL));
  PetscCall(Reactions(l, e0, e1));
  PetscCall(Correct(l, t - t0));
  PetscCall(Answer(l));
  for (PetscInt i = 0; i < 6 * l->nfree; i++) l->R[i] = l->G[i] - l->W[i];
  PetscCall(PetscFree2(e0, v0));
  l->iterations++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Norm(const PetscReal *x, PetscInt n)
{
  PetscReal s = 0;

  for (PetscInt i = 0; i < n; i++) s += x[i] * x[i];
  return PetscSqrtReal(s);
}

/* B += (s - B y) (s^T B)/(s^T B y) after the step s changed R by y. */
static void Update(CoupleAttach l)
{
  const PetscInt m = 6 * l->nfree;
  PetscReal *By = l->Rold, *sB = l->G, d = 0;

  for (PetscInt i = 0; i < m; i++) By[i] = sB[i] = 0;
  for (PetscInt i = 0; i < m; i++)
    for (PetscInt j = 0; j < m; j++) By[i] += l->B[i * m + j] * l->y[j], sB[j] += l->s[i] * l->B[i * m + j];
  for (PetscInt i = 0; i < m; i++) d += l->s[i] * By[i];
  if (PetscAbsReal(d) < 1e-3 * Norm(l->s, m) * Norm(By, m)) return; /* tells nothing */
  for (PetscInt i = 0; i < m; i++)
    for (PetscInt j = 0; j < m; j++) l->B[i * m + j] += (l->s[i] - By[i]) * sB[j] / d;
}

/* B = A^-1 (m x m, A is lost) by elimination with row exchanges; false for a singular one. */
static PetscBool Invert(PetscInt m, PetscReal *A, PetscReal *B)
{
  for (PetscInt i = 0; i < m * m; i++) B[i] = i % (m + 1) == 0;
  for (PetscInt c = 0; c < m; c++) {
    PetscInt p = c;

    for (PetscInt r = c; r < m; r++)
      if (PetscAbsReal(A[r * m + c]) > PetscAbsReal(A[p * m + c])) p = r;
    if (!(PetscAbsReal(A[p * m + c]) > 1e-12)) return PETSC_FALSE;
    for (PetscInt k = 0; k < m; k++) {
      const PetscReal a = A[c * m + k], b = B[c * m + k];

      A[c * m + k] = A[p * m + k], B[c * m + k] = B[p * m + k];
      A[p * m + k] = a, B[p * m + k] = b;
    }
    for (PetscInt r = 0; r < m; r++) {
      const PetscReal f = r == c ? 0 : A[r * m + c] / A[c * m + c];

      for (PetscInt k = 0; k < m && f != 0; k++) A[r * m + k] -= f * A[c * m + k], B[r * m + k] -= f * B[c * m + k];
    }
  }
  for (PetscInt r = 0; r < m; r++)
    for (PetscInt k = 0; k < m; k++) B[r * m + k] /= A[r * m + r];
  return PETSC_TRUE;
}

/* B := (dR/dW)^-1, columns by differences of width h: where Broyden's method is slow, as for a body on a stiff support. */
static PetscErrorCode Differences(CoupleAttach l, PetscReal t0, PetscReal t, PetscReal h)
{
  const PetscInt m = 6 * l->nfree;
  PetscReal *J, *R0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2((size_t)m * (size_t)m, &J, m, &R0));
  PetscCall(PetscArraycpy(R0, l->R, m));
  for (PetscInt j = 0; j < m; j++) {
    const PetscReal W = l->W[j];

    l->W[j] = W + h;
    PetscCall(Evaluate(l, t0, t, PETSC_TRUE));
    for (PetscInt i = 0; i < m; i++) J[i * m + j] = (l->R[i] - R0[i]) / h;
    l->W[j] = W;
  }
  PetscCall(PetscArraycpy(l->R, R0, m));
  if (!Invert(m, J, l->B)) CoupleAttachFirstInverse(l);
  PetscCall(PetscFree2(J, R0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Below which R is round-off: forces of 1e-12 of all momentum in a step. */
static PetscErrorCode Floor(CoupleAttach l, PetscReal dt, PetscReal *floor)
{
  PetscReal p = 0;

  PetscFunctionBegin;
  for (PetscInt s = 0; s < l->nsets; s++) p += Norm(l->sets[s].balance, 3) + dt * Norm(l->sets[s].balance + 6, 3);
  for (PetscInt k = 0; k < l->nfree; k++) {
    RigidBodySpec spec;
    PetscReal V[3], w[3];

    PetscCall(RigidGetBody(l->rigid, l->free[k], &spec));
    PetscCall(RigidGetState(l->rigid, l->free[k], NULL, NULL, V, w));
    p += spec.mass * (Norm(V, 3) + l->length[k] * Norm(w, 3));
  }
  *floor = PetscMax(1e-12 * p / dt, PETSC_SMALL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Beams and bodies at the start of a step; what ends the iteration: R below part of the forces, or below floor. */
static PetscErrorCode Start(CoupleAttach l, PetscReal t, PetscReal *t0, PetscReal *part, PetscReal *floor)
{
  PetscReal tr, ratio = 0;

  PetscFunctionBegin;
  PetscCheck(l->setup, l->comm, PETSC_ERR_ORDER, "CoupleAttachSetUp() must come before CoupleAttachAdvance()");
  PetscCall(AncfGetState(l->ancf, t0, NULL, NULL, NULL));
  PetscCall(RigidGetTime(l->rigid, &tr));
  PetscCheck(PetscAbsReal(tr - *t0) <= 1e-12 * PetscMax(1, PetscAbsReal(t)) && t > *t0, l->comm, PETSC_ERR_ORDER,
             "CoupleAttachAdvance: beams at t = %g s and bodies at %g s cannot go to %g s together", (double)*t0, (double)tr,
             (double)t);
  PetscCall(BeamBalances(l));
  for (PetscInt s = 0; s < l->nsets; s++) PetscCall(Balances(l, s, l->sets[s].balance));
  for (PetscInt k = 0; k < l->nfree; k++) PetscCall(RigidGetState(l->rigid, l->free[k], l->X + 3 * k, NULL, NULL, NULL));
  for (PetscInt i = 0; i < l->n; i++) PetscCall(RigidGetState(l->rigid, l->a[i].body, NULL, NULL, NULL, l->a[i].w0));
  PetscCall(Floor(l, t - *t0, floor));
  for (PetscInt k = 0; k < l->nfree; k++) ratio = PetscMax(ratio, l->ratio[k]);
  *part = l->tolerance * (1 + ratio); /* an error of R changes the body's motion by 1/(1 + ratio) of it */
  if (l->nfree) {
    PetscCall(AncfPack(l->ancf, l->beams));
    PetscCall(RigidPack(l->rigid, l->bodies));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Work and angular impulse of the step, forces held over it; angles by the mean angular velocity of the step. */
static PetscErrorCode Account(CoupleAttach l, PetscReal dt)
{
  CoupleExchange *d = &l->done;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < l->n; i++) {
    const Attachment *a = &l->a[i];
    PetscReal w1[3], mid[3], t[3];

    PetscCall(RigidGetState(l->rigid, a->body, NULL, NULL, NULL, w1));
    for (int c = 0; c < 3; c++) {
      mid[c] = 0.5 * (a->x0[c] + a->x1[c]);
      d->beams += a->F[c] * (a->x1[c] - a->x0[c]) + 0.5 * dt * a->M[c] * (a->w0[c] + w1[c]);
    }
    CoupleCross(mid, a->F, t);
    for (int c = 0; c < 3; c++) d->turnbeams[c] += dt * (t[c] + a->M[c]);
  }
  for (PetscInt k = 0; k < l->nfree; k++) {
    const PetscReal *F = l->W + 6 * k, *X0 = l->X + 3 * k, *w0 = NULL;
    PetscReal X[3], w1[3], T[3], mid[3], t[3];

    for (PetscInt i = 0; i < l->n && !w0; i++)
      if (l->a[i].unknown == k) w0 = l->a[i].w0;
    PetscCheck(w0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "no beam is attached to free body %" PetscInt_FMT "", l->free[k]);
    PetscCall(RigidGetState(l->rigid, l->free[k], X, NULL, NULL, w1));
    for (int c = 0; c < 3; c++) {
      T[c] = F[3 + c] * l->length[k];
      mid[c] = 0.5 * (X0[c] + X[c]);
      d->bodies += F[c] * (X[c] - X0[c]) + 0.5 * dt * T[c] * (w0[c] + w1[c]);
    }
    CoupleCross(mid, F, t);
    for (int c = 0; c < 3; c++) d->turnbodies[c] += dt * (t[c] + T[c]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleAttachAdvance(CoupleAttach l, PetscReal t)
{
  const PetscInt m = 6 * l->nfree;
  PetscReal t0 = 0, part = 0, floor = 0, size = 0;
  PetscBool done = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(Start(l, t, &t0, &part, &floor));
  PetscCall(Evaluate(l, t0, t, PETSC_FALSE));
  for (PetscInt it = 0; m; it++) {
    size = PetscMax(Norm(l->G, m), Norm(l->W, m));
    for (PetscInt i = 0; i < m; i++) {
      l->s[i] = 0;
      for (PetscInt j = 0; j < m; j++) l->s[i] -= l->B[i * m + j] * l->R[j];
      l->y[i] = -l->R[i];
    }
    done = Norm(l->R, m) <= PetscMax(part * size, floor) || Norm(l->s, m) <= l->tolerance * size ? PETSC_TRUE : PETSC_FALSE;
    if (done || it + 1 >= l->maxiterations) break;
    for (PetscInt i = 0; i < m; i++) l->W[i] += l->s[i];
    PetscCall(Evaluate(l, t0, t, PETSC_TRUE));
    for (PetscInt i = 0; i < m; i++) l->y[i] += l->R[i];
    Update(l);
    if (it % 8 == 7) PetscCall(Differences(l, t0, t, PetscMax(1e-5 * size, 100 * floor)));
    for (PetscInt i = 0; i < m; i++) l->G[i] = l->W[i] + l->R[i];
  }
  PetscCall(Load(l, l->W, -1));
  for (PetscInt i = 0; i < l->n; i++) PetscCall(PetscArraycpy(l->a[i].last, l->a[i].raw, 6));
  l->known = PETSC_TRUE;
  CoupleAttachSum(l);
  PetscCall(Account(l, t - t0));
  PetscCheck(
      done || !m, l->comm, PETSC_ERR_NOT_CONVERGED,
      "the forces between beams and bodies did not converge at t = %g s: relative residual %g after %" PetscInt_FMT
      " iterations (couple_attach_tolerance = %g); the beams weigh up to %g times their body; smaller steps, a heavier body or "
      "more couple_attach_iterations help",
      (double)t, (double)(Norm(l->R, m) / size), l->maxiterations, (double)l->tolerance, (double)(part / l->tolerance - 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}
