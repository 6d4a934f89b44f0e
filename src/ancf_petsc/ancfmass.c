/*
  ancfmass.c - the assembled mass matrix (Eq. 29) and everything that needs it: accelerations, momentum, energy.

  The consistent mass acts on each component alike, so it is a scalar matrix of two rows (r_j, r_j,x) per node with half
  bandwidth 3, factored once by Cholesky. Rows of eliminated coordinates are those of the identity.
*/
#include "ancfimpl.h"

#define BAND 4

PetscErrorCode AncfMassFactor(Ancf ancf)
{
  PetscReal *M = ancf->mass;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(M, 2 * ancf->nnodes * BAND));
  for (PetscInt b = 0; b < ancf->nbeams; b++) {
    const AncfBeam *beam = &ancf->beams[b];
    PetscInt row = 2 * beam->node;
    PetscReal m[16];

    AncfElementMass(beam->rhoA, beam->l, m);
    for (PetscInt k = 0; k < beam->spec.elements; k++, row += 2)
      for (PetscInt i = 0; i < 4; i++)
        for (PetscInt j = 0; j <= i; j++) M[(row + i) * BAND + i - j] += m[4 * i + j];
  }
  for (PetscInt i = 0; i < 2 * ancf->nnodes; i++) {
    if (!(ancf->fixed[i / 2] & (i % 2 ? ANCF_FIX_GRADIENT : ANCF_FIX_POSITION))) continue;
    for (PetscInt k = 1; k < BAND; k++) {
      M[i * BAND + k] = 0;
      if (i + k < 2 * ancf->nnodes) M[(i + k) * BAND + k] = 0;
    }
    M[i * BAND] = 1;
  }
  /* M[i][k] = L(i, i-k); beams do not couple, their entries across the border are zero. */
  for (PetscInt i = 0; i < 2 * ancf->nnodes; i++) {
    PetscInt first = PetscMax(0, i - BAND + 1);

    for (PetscInt j = first; j <= i; j++) {
      PetscReal s = M[i * BAND + i - j];

      for (PetscInt k = first; k < j; k++)
        if (j - k < BAND) s -= M[i * BAND + i - k] * M[j * BAND + j - k];
      M[i * BAND + i - j] = j < i ? s / M[j * BAND] : PetscSqrtReal(s);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* f := M^-1 f; f is nodes x 6 with the given stride between nodes. */
PetscErrorCode AncfMassSolve(Ancf ancf, PetscReal *f, PetscInt stride)
{
  const PetscReal *L = ancf->mass;
  const PetscInt n = 2 * ancf->nnodes;

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(ANCF_MassSolve, 0, 0, 0, 0));
#define ROW(i) (f + ((i) / 2) * stride + 3 * ((i) % 2))
  for (PetscInt i = 0; i < n; i++) {
    PetscReal *fi = ROW(i);

    for (PetscInt k = 1; k < BAND && k <= i; k++)
      for (PetscInt c = 0; c < 3; c++) fi[c] -= L[i * BAND + k] * ROW(i - k)[c];
    for (PetscInt c = 0; c < 3; c++) fi[c] /= L[i * BAND];
  }
  for (PetscInt i = n - 1; i >= 0; i--) {
    PetscReal *fi = ROW(i);

    for (PetscInt k = 1; k < BAND && i + k < n; k++)
      for (PetscInt c = 0; c < 3; c++) fi[c] -= L[(i + k) * BAND + k] * ROW(i + k)[c];
    for (PetscInt c = 0; c < 3; c++) fi[c] /= L[i * BAND];
  }
#undef ROW
  PetscCall(PetscLogEventEnd(ANCF_MassSolve, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfMassMult(Ancf ancf, const PetscReal *x, PetscReal *f)
{
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(f, 6 * ancf->nnodes));
  for (PetscInt b = 0; b < ancf->nbeams; b++) {
    const AncfBeam *beam = &ancf->beams[b];
    PetscReal m[16];

    AncfElementMass(beam->rhoA, beam->l, m);
    for (PetscInt k = 0; k < beam->spec.elements; k++) {
      const PetscReal *xe = x + 6 * (beam->node + k);
      PetscReal *fe = f + 6 * (beam->node + k);

      for (PetscInt i = 0; i < 4; i++)
        for (PetscInt j = 0; j < 4; j++)
          for (PetscInt c = 0; c < 3; c++) fe[3 * i + c] += m[4 * i + j] * xe[3 * j + c];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfComputeAcceleration(Ancf ancf)
{
  PetscFunctionBegin;
  if (ancf->avalid) PetscFunctionReturn(PETSC_SUCCESS);
  AncfMove(ancf, ancf->t);
  PetscCall(AncfExplicitAcceleration(ancf, ancf->e, ancf->v, 6, ancf->a, 6));
  ancf->avalid = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfGetEnergy(Ancf ancf, PetscReal *kinetic, PetscReal *elastic, PetscReal *potential)
{
  PetscReal T = 0, W = 0, P = 0, *f;

  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfGetEnergy: call AncfSetUp() first");
  PetscCall(PetscMalloc1(6 * (size_t)ancf->nnodes, &f));
  PetscCall(AncfMassMult(ancf, ancf->v, f));
  for (PetscInt i = 0; i < 6 * ancf->nnodes; i++) {
    T += 0.5 * f[i] * ancf->v[i];
    P -= ancf->steady[i] * ancf->e[i];
  }
  PetscCall(PetscFree(f));
  if (elastic) PetscCall(AncfElasticEnergy(ancf, &W));
  if (kinetic) *kinetic = T;
  if (elastic) *elastic = W;
  if (potential) *potential = P;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* sum += of the vector coordinates x of one beam: positions of q, and x cross q. */
static void BeamTotals(const AncfBeam *b, const PetscReal *x, const PetscReal *q, PetscReal sum[3], PetscReal moment[3])
{
  for (PetscInt i = 2 * b->node; i < 2 * (b->node + b->spec.elements + 1); i++) {
    const PetscReal *r = x + 3 * i, *m = q + 3 * i;

    for (PetscInt c = 0; c < 3; c++) {
      if (i % 2 == 0) sum[c] += m[c];
      moment[c] += r[(c + 1) % 3] * m[(c + 2) % 3] - r[(c + 2) % 3] * m[(c + 1) % 3];
    }
  }
}

/* p = sum of the position rows of M v (the shape functions S1, S3 sum to one); L = integral of rho_s A r x rdot. */
PetscErrorCode AncfGetMomentum(Ancf ancf, PetscReal p[3], PetscReal L[3])
{
  PetscReal *f, P[3] = {0}, H[3] = {0};

  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfGetMomentum: call AncfSetUp() first");
  PetscCall(PetscMalloc1(6 * (size_t)ancf->nnodes, &f));
  PetscCall(AncfMassMult(ancf, ancf->v, f));
  for (PetscInt k = 0; k < ancf->nbeams; k++) BeamTotals(&ancf->beams[k], ancf->e, f, P, H);
  PetscCall(PetscFree(f));
  for (PetscInt c = 0; c < 3; c++) {
    if (p) p[c] = P[c];
    if (L) L[c] = H[c];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfGetBeamBalances(Ancf ancf, PetscReal p[], PetscReal L[], PetscReal F[], PetscReal T[])
{
  const PetscInt n = 3 * ancf->nbeams;
  PetscReal *f;

  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfGetBeamBalances: call AncfSetUp() first");
  PetscCall(PetscMalloc1(6 * (size_t)ancf->nnodes, &f));
  PetscCall(AncfMassMult(ancf, ancf->v, f));
  for (PetscInt i = 0; i < n; i++) p[i] = L[i] = F[i] = T[i] = 0;
  for (PetscInt b = 0; b < ancf->nbeams; b++) BeamTotals(&ancf->beams[b], ancf->e, f, p + 3 * b, L + 3 * b);
  for (PetscInt j = 0; j < ancf->nnodes; j++) {
    PetscReal Q[3] = {0};

    if (ancf->moment) AncfMomentForce(ancf->moment + 3 * j, ancf->e + 6 * j + 3, Q, NULL);
    for (PetscInt c = 0; c < 6; c++)
      f[6 * j + c] = ancf->steady[6 * j + c] + ancf->load[6 * j + c] - ancf->damping * f[6 * j + c] + (c < 3 ? 0 : Q[c - 3]);
  }
  for (PetscInt b = 0; b < ancf->nbeams; b++) BeamTotals(&ancf->beams[b], ancf->e, f, F + 3 * b, T + 3 * b);
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfGetTorque(Ancf ancf, PetscReal T[3])
{
  PetscReal *f, *r, F[3];

  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfGetTorque: call AncfSetUp() first");
  PetscCall(PetscMalloc2(6 * (size_t)ancf->nnodes, &f, 6 * (size_t)ancf->nnodes, &r));
  PetscCall(AncfMassMult(ancf, ancf->v, f));
  PetscCall(AncfGetReactions(ancf, r));
  for (PetscInt j = 0; j < ancf->nnodes; j++) {
    PetscReal Q[3] = {0};

    if (ancf->moment) AncfMomentForce(ancf->moment + 3 * j, ancf->e + 6 * j + 3, Q, NULL);
    for (PetscInt c = 0; c < 6; c++)
      f[6 * j + c] = ancf->steady[6 * j + c] + r[6 * j + c] - ancf->damping * f[6 * j + c] + (c < 3 ? 0 : Q[c - 3]);
  }
  for (int c = 0; c < 3; c++) F[c] = T[c] = 0;
  for (PetscInt b = 0; b < ancf->nbeams; b++) BeamTotals(&ancf->beams[b], ancf->e, f, F, T);
  PetscCall(PetscFree2(f, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Residual of the full equations of motion, constraints ignored, summed over the fixed positions. */
PetscErrorCode AncfGetReaction(Ancf ancf, PetscReal f[3])
{
  PetscReal *r;

  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfGetReaction: call AncfSetUp() first");
  PetscCall(PetscMalloc1(6 * (size_t)ancf->nnodes, &r));
  PetscCall(AncfSupportForces(ancf, r, PETSC_TRUE));
  f[0] = f[1] = f[2] = 0;
  for (PetscInt j = 0; j < ancf->nnodes; j++)
    if (ancf->fixed[j] & ANCF_FIX_POSITION)
      for (PetscInt c = 0; c < 3; c++) f[c] += r[6 * j + c];
  PetscCall(PetscFree(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfGetWeight(Ancf ancf, PetscReal f[3])
{
  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfGetWeight: call AncfSetUp() first");
  f[0] = f[1] = f[2] = 0;
  for (PetscInt j = 0; j < ancf->nnodes; j++)
    for (PetscInt c = 0; c < 3; c++) f[c] += ancf->steady[6 * j + c];
  PetscFunctionReturn(PETSC_SUCCESS);
}
