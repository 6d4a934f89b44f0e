/*
  ancfdamping.c - internal damping of beams: parameters, forces, tangent, dissipated power. The element is in ancfviscous.c.

  Mass-proportional damping is part of the inertia, see AncfDamped() in ancfts.c.
*/
#include "ancfbatch.h"
#include "ancfviscous.h"

/* Curvature times length below which a beam counts as straight and the spin of its sections, then without effect, as zero. */
#define STRAIGHT 1e-7

/*
  AncfSetStiffnessDamping - stiffness-proportional (Rayleigh) damping, s: a mode of frequency w rad/s has the damping ratio
  damping w/2. It acts as Kelvin-Voigt damping of strain and curvature, with this retardation time in addition to those of the
  beams' specs: C = damping K about the shape at rest, and none in rigid motion. Default 0. Before AncfSetUp().
*/
PetscErrorCode AncfSetStiffnessDamping(Ancf ancf, PetscReal damping)
{
  PetscFunctionBegin;
  PetscCheck(!ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "-ancf_damping_stiffness cannot change after AncfSetUp()");
  PetscCheck(damping >= 0 && !PetscIsInfOrNanReal(damping), ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "-ancf_damping_stiffness %g s must be finite and not negative", (double)damping);
  ancf->stiffnessdamping = damping;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfSetUpDamping(Ancf ancf)
{
  PetscFunctionBegin;
  for (PetscInt b = 0; b < ancf->nbeams; b++) {
    AncfBeam *m = &ancf->beams[b];

    m->EAtau = m->EA * (m->spec.axialdamping + ancf->stiffnessdamping);
    m->EItau = m->EI * (m->spec.bendingdamping + ancf->stiffnessdamping);
    if (m->EAtau > 0 || m->EItau > 0) ancf->viscous = PETSC_TRUE;
  }
  if (ancf->viscous) PetscCall(PetscCalloc2(3 * (size_t)ancf->nbeams, &ancf->spin, 9 * (size_t)ancf->nbeams, &ancf->spinsum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static AncfViscosity BatchViscosity(Ancf ancf, const AncfBatch *b)
{
  AncfViscosity s;

  for (int i = 0; i < ANCF_LANES; i++) {
    const AncfBeam *m = &ancf->beams[b->beam[i]];

    s.EA[i] = m->EAtau;
    s.EI[i] = m->EItau;
    s.l[i] = m->l;
  }
  return s;
}

static void BatchSpin(const AncfBatch *b, const PetscReal *spin, AncfLanes s[3])
{
  for (int i = 0; i < ANCF_LANES; i++)
    for (int c = 0; c < 3; c++) s[c][i] = spin[3 * b->beam[i] + c];
}

/* Sections do not spin where a clamp at rest holds them. */
static PetscBool HasClamp(Ancf ancf, const AncfBeam *m)
{
  const unsigned char *fixed = ancf->allfixed ? ancf->allfixed : ancf->fixed;

  for (PetscInt j = m->node; j <= m->node + m->spec.elements; j++)
    if (fixed[j] & ANCF_FIX_GRADIENT && !(fixed[j] & ANCF_MOVING)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* x = A^-1 b of a symmetric positive definite 3 x 3 matrix (xx xy xz yy yz zz), by Cholesky. */
static void Solve3(const PetscReal A[6], const PetscReal b[3], PetscReal x[3])
{
  const PetscReal l0 = PetscSqrtReal(A[0]), l1 = A[1] / l0, l2 = A[2] / l0, l3 = PetscSqrtReal(A[3] - l1 * l1),
                  l4 = (A[4] - l1 * l2) / l3, l5 = PetscSqrtReal(A[5] - l2 * l2 - l4 * l4);

  x[0] = b[0] / l0;
  x[1] = (b[1] - l1 * x[0]) / l3;
  x[2] = (b[2] - l2 * x[0] - l4 * x[1]) / l5;
  x[2] /= l5;
  x[1] = (x[1] - l4 * x[2]) / l3;
  x[0] = (x[0] - l1 * x[1] - l2 * x[2]) / l0;
}

/* Angular velocity about which each beam's sections may spin freely: the one of least dissipation. */
void AncfSpin(Ancf ancf, const PetscReal *e, const PetscReal *v, PetscInt stride, PetscReal *spin)
{
  PetscReal *sum = ancf->spinsum;
  PetscBool any = PETSC_FALSE;

  for (PetscInt b = 0; b < ancf->nbeams; b++) {
    const PetscBool held = ancf->beams[b].EItau == 0 || HasClamp(ancf, &ancf->beams[b]) ? PETSC_TRUE : PETSC_FALSE;

    for (int c = 0; c < 9; c++) sum[9 * b + c] = 0;
    for (int c = 0; c < 3; c++) spin[3 * b + c] = 0;
    sum[9 * b] = held ? -1 : 0;
    if (!held) any = PETSC_TRUE;
  }
  if (!any) return;
  for (PetscInt k = 0; k < ancf->nbatches; k++) {
    const AncfBatch *b = &ancf->batches[k];
    const AncfViscosity s = BatchViscosity(ancf, b);
    AncfLanes x[12], y[12], A[6] = {{0}}, r[3] = {{0}};

    AncfGather(ancf, b, e, stride, ancf->rest, x);
    AncfGather(ancf, b, v, stride, ancf->restv, y);
    AncfElementSpin(&ancf->rule, &s, x, y, A, r);
    for (PetscInt i = 0; i < b->n; i++) {
      PetscReal *to = sum + 9 * b->beam[i];

      if (to[0] < 0) continue;
      for (int c = 0; c < 6; c++) to[c] += A[c][i];
      for (int c = 0; c < 3; c++) to[6 + c] += r[c][i];
    }
  }
  for (PetscInt b = 0; b < ancf->nbeams; b++) {
    const AncfBeam *m = &ancf->beams[b];
    const PetscReal L = m->l * (PetscReal)m->spec.elements, floor = m->EItau * STRAIGHT * STRAIGHT / L;

    if (sum[9 * b] < 0) continue;
    sum[9 * b] += floor;
    sum[9 * b + 3] += floor;
    sum[9 * b + 5] += floor;
    Solve3(sum + 9 * b, sum + 9 * b + 6, spin + 3 * b);
  }
}

void AncfAddViscous(Ancf ancf, const PetscReal *e, const PetscReal *v, PetscInt stride, PetscReal *f, PetscInt fstride,
                    PetscReal *power)
{
  PetscReal sum = 0;

  if (power) *power = 0;
  if (!ancf->viscous) return;
  AncfSpin(ancf, e, v, stride, ancf->spin);
  for (PetscInt k = 0; k < ancf->nbatches; k++) {
    const AncfBatch *b = &ancf->batches[k];
    const AncfViscosity s = BatchViscosity(ancf, b);
    AncfLanes x[12], y[12], spin[3], Q[12] = {{0}}, P = {0};

    AncfGather(ancf, b, e, stride, ancf->rest, x);
    AncfGather(ancf, b, v, stride, ancf->restv, y);
    BatchSpin(b, ancf->spin, spin);
    AncfElementViscous(&ancf->rule, &s, x, y, spin, Q, &P);
    for (PetscInt i = 0; i < b->n; i++) {
      sum += P[i];
      for (int c = 0; c < 6 && f; c++) {
        f[b->node[i] * fstride + c] += Q[c][i];
        f[(b->node[i] + 1) * fstride + c] += Q[6 + c][i];
      }
    }
  }
  if (power) *power = sum;
}

/* ge dQ/de + gv dQ/dv of a batch at coordinates x, to be expanded lane by lane; e, v: where the spin was taken. */
void AncfViscousBatch(Ancf ancf, const AncfBatch *b, const PetscReal *spin, const AncfLanes x[12], const PetscReal *v,
                      PetscInt stride, PetscReal ge, PetscReal gv, AncfLanes H[81])
{
  const AncfViscosity s = BatchViscosity(ancf, b);
  AncfLanes y[12], o[3];

  for (int c = 0; c < 81; c++) H[c] = (AncfLanes){0};
  AncfGather(ancf, b, v, stride, ancf->restv, y);
  BatchSpin(b, spin, o);
  AncfElementViscousTangent(&ancf->rule, &s, x, y, o, ge, gv, H);
}

/* Element k of each lane's beam (chain, -1: none), at coordinates x: adds the symmetric part of dQ/de + gv dQ/dv to K. */
void AncfViscousChain(Ancf ancf, const PetscInt chain[ANCF_LANES], PetscInt k, const AncfLanes x[12], const PetscReal *v,
                      const PetscReal *spin, PetscReal gv, AncfLanes K[ANCF_TANGENT])
{
  AncfBatch b;
  AncfViscosity s;
  AncfLanes y[12], o[3], H[81];

  for (int i = 0; i < ANCF_LANES; i++) {
    const PetscBool idle = chain[i] < 0 || k >= ancf->beams[chain[i]].spec.elements ? PETSC_TRUE : PETSC_FALSE;
    const AncfBeam *m = &ancf->beams[idle ? 0 : chain[i]];

    b.node[i] = idle ? m->node : m->node + k;
    b.beam[i] = idle ? 0 : chain[i];
    s.EA[i] = idle ? 0 : m->EAtau;
    s.EI[i] = idle ? 0 : m->EItau;
    s.l[i] = idle ? 1 : m->l;
  }
  AncfGather(ancf, &b, v, 6, ancf->restv, y);
  BatchSpin(&b, spin, o);
  for (int c = 0; c < 81; c++) H[c] = (AncfLanes){0};
  AncfElementViscousTangent(&ancf->rule, &s, x, y, o, 1, gv, H);
  AncfScaledPack(H, s.l, K);
}

/* Adds dQ/de + shift dQ/dv to the values of P, or, when P has columns of v, dQ/de and dQ/dv each to its columns. */
PetscErrorCode AncfAssembleViscous(Ancf ancf, const PetscReal *e, const PetscReal *v, PetscInt stride, PetscReal shift, Mat P)
{
  PetscReal k[2][144], blk[576];
  PetscInt bs;

  PetscFunctionBegin;
  if (!ancf->viscous) PetscFunctionReturn(PETSC_SUCCESS);
  AncfSpin(ancf, e, v, stride, ancf->spin);
  PetscCall(MatGetBlockSize(P, &bs));
  for (PetscInt n = 0; n < ancf->nbatches; n++) {
    const AncfBatch *b = &ancf->batches[n];
    AncfLanes x[12], H[2][81];

    AncfGather(ancf, b, e, stride, ancf->rest, x);
    AncfViscousBatch(ancf, b, ancf->spin, x, v, stride, 1, bs == 6 ? shift : 0, H[0]);
    if (bs == 12) AncfViscousBatch(ancf, b, ancf->spin, x, v, stride, 0, 1, H[1]);
    for (PetscInt i = 0; i < b->n; i++) {
      const PetscInt idx[2] = {b->node[i], b->node[i] + 1};

      PetscCall(PetscArrayzero(k[0], 288));
      for (int h = 0; h < 2; h++) {
        if (h && bs == 6) continue;
        AncfScaledExpand(H[h], AncfLoad(b->l), i, k[h]);
        AncfClearFixed(ancf, b, i, k[h]);
      }
      if (AncfInJoint(ancf, idx[0]) || AncfInJoint(ancf, idx[1])) {
        PetscCall(AncfNetworkElement(ancf, P, idx[0], k[0], k[1]));
        continue;
      }
      if (bs == 6) {
        PetscCall(MatSetValuesBlocked(P, 2, idx, 2, idx, k[0], ADD_VALUES));
        continue;
      }
      PetscCall(PetscArrayzero(blk, 576));
      for (int r = 0; r < 12; r++)
        for (int c = 0; c < 12; c++) {
          const int row = 12 * (r / 6) + 6 + r % 6, col = 12 * (c / 6) + c % 6;

          blk[24 * row + col] = k[0][12 * r + c];
          blk[24 * row + col + 6] = k[1][12 * r + c];
        }
      PetscCall(MatSetValuesBlocked(P, 2, idx, 2, idx, blk, ADD_VALUES));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  AncfGetDissipation - power (W) that damping takes from the beams now, -dE/dt: alpha v.M v of mass-proportional damping and
  EA tau (deps/dt)^2 + EI tau (kappa*)^2 of internal damping, integrated over the beams. Supports that move do work of their own.
*/
PetscErrorCode AncfGetDissipation(Ancf ancf, PetscReal *power)
{
  PetscReal kinetic = 0;

  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfGetDissipation: call AncfSetUp() first");
  AncfAddViscous(ancf, ancf->e, ancf->v, 6, NULL, 0, power);
  if (ancf->damping > 0) PetscCall(AncfGetEnergy(ancf, &kinetic, NULL, NULL));
  *power += 2 * ancf->damping * kinetic;
  PetscFunctionReturn(PETSC_SUCCESS);
}
