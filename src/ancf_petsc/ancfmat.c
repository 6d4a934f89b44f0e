/*
  ancfmat.c - the matrix tangent + shift M (Eqs. 28-30 linearised): assembled into any Mat, or, for PCBLOCKTRI, kept as the
  coordinates it was asked at and made block by block when the solver needs it.
*/
#include "ancfbatch.h"
#include "ancfviscous.h"
#include "blocktri.h"

#if PETSC_VERSION_LT(3, 24, 0)
typedef void (*AncfOperation)(void);
#else
typedef PetscErrorCodeFn *AncfOperation;
#endif

/* The unassembled matrix: MATSHELL that produces its blocks for PCBLOCKTRI. */
typedef struct {
  Ancf ancf;
  PetscReal *e, shift, diag; /* room for coordinates; shift of M; diagonal of eliminated coordinates */
  const PetscReal *at;       /* linearised here: e, or an array that lasts as long */
  PetscReal *v, *spin, gv;   /* internal damping: velocities, spin, shift of its dQ/dv */
  PetscBool identity;        /* diag times the identity, nothing else */
  PetscInt *first, *length;  /* chains of the source */
  PetscInt *lanes;           /* by the first chain of a batch: its place in ancf->lanebeams; NULL without these */
  BlockTriSource source;
} AncfShell;

/* k = tangent + shift * mass of one element, 12 x 12 row-major, with rows and columns of eliminated coordinates cleared. */
static inline void AncfElementMatrix(Ancf ancf, const AncfBatch *b, PetscInt lane, const AncfLanes K[ANCF_TANGENT],
                                     PetscReal shift, PetscReal k[144])
{
  PetscReal m[16];

  AncfTangentExpand(K, lane, k);
  AncfElementMass(b->rhoA[lane], b->l[lane], m);
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      for (int c = 0; c < 3; c++) k[12 * (3 * i + c) + 3 * j + c] += shift * m[4 * i + j];
  AncfClearFixed(ancf, b, lane, k);
}

/*
  Adds the element matrices to P, whose node blocks have 6 rows (second-order form) or 12 with the equations of motion in
  the last 6 (first-order form): there the tangent takes the columns of e and the mass those of v.
*/
PetscErrorCode AncfAssembleElements(Ancf ancf, const PetscReal *e, PetscInt stride, PetscReal shift, Mat P)
{
  PetscReal k[144], m[144], blk[576];
  AncfLanes zero[ANCF_TANGENT] = {{0}};
  PetscInt bs;

  PetscFunctionBegin;
  PetscCall(MatGetBlockSize(P, &bs));
  for (PetscInt n = 0; n < ancf->nbatches; n++) {
    const AncfBatch *b = &ancf->batches[n];
    AncfSection s = AncfBatchSection(b);
    AncfLanes x[12], Q[12], K[ANCF_TANGENT];

    if (e) {
      AncfGather(ancf, b, e, stride, ancf->rest, x);
      AncfElementTangent(&ancf->rule, &s, x, Q, K);
      if (ancf->natural) AncfRestTangent(ancf, b->node, &s, x, K);
    } else
      PetscCall(PetscMemcpy(K, zero, sizeof(K)));
    for (PetscInt i = 0; i < b->n; i++) {
      PetscInt idx[2] = {b->node[i], b->node[i] + 1};

      if (AncfInJoint(ancf, idx[0]) || AncfInJoint(ancf, idx[1])) {
        AncfElementMatrix(ancf, b, i, K, bs == 6 ? shift : 0, k);
        AncfElementMatrix(ancf, b, i, zero, shift, m);
        PetscCall(AncfNetworkElement(ancf, P, idx[0], k, m));
        continue;
      }
      if (bs == 6) {
        AncfElementMatrix(ancf, b, i, K, shift, k);
        PetscCall(MatSetValuesBlocked(P, 2, idx, 2, idx, k, ADD_VALUES));
        continue;
      }
      AncfElementMatrix(ancf, b, i, K, 0, k);
      AncfElementMatrix(ancf, b, i, zero, shift, m);
      PetscCall(PetscArrayzero(blk, 576));
      for (int r = 0; r < 12; r++)
        for (int c = 0; c < 12; c++) {
          int row = 12 * (r / 6) + 6 + r % 6, col = 12 * (c / 6) + c % 6;

          blk[24 * row + col] = k[12 * r + c];
          blk[24 * row + col + 6] = m[12 * r + c];
        }
      PetscCall(MatSetValuesBlocked(P, 2, idx, 2, idx, blk, ADD_VALUES));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tangent of the moments, which are not conservative and make it unsymmetric unless all bending is in one plane. */
static PetscErrorCode AncfAssembleMoments(Ancf ancf, const PetscReal *e, PetscInt stride, Mat P)
{
  PetscReal blk[144];
  PetscInt bs;

  PetscFunctionBegin;
  PetscCall(MatGetBlockSize(P, &bs));
  for (PetscInt j = 0; j < ancf->nnodes && ancf->moment; j++) {
    const PetscReal *M = ancf->moment + 3 * j;
    PetscReal Q[3], dQ[9];

    if (ancf->fixed[j] & ANCF_FIX_GRADIENT || (M[0] == 0 && M[1] == 0 && M[2] == 0)) continue;
    AncfMomentForce(M, e + j * stride + 3, Q, dQ);
    if (ancf->njoints) {
      const PetscInt coord[3] = {6 * j + 3, 6 * j + 4, 6 * j + 5};

      for (int c = 0; c < 9; c++) dQ[c] *= -ancf->loadscale;
      PetscCall(AncfNetworkAdd(ancf, P, 3, coord, dQ, bs - 6, 0, PETSC_FALSE));
      continue;
    }
    PetscCall(PetscArrayzero(blk, 144));
    for (int r = 0; r < 3; r++)
      for (int c = 0; c < 3; c++) blk[bs * (bs - 3 + r) + 3 + c] = -ancf->loadscale * dQ[3 * r + c];
    PetscCall(MatSetValuesBlocked(P, 1, &j, 1, &j, blk, ADD_VALUES));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Diagonal entries of eliminated coordinates, and in the first-order form the rows shift edot - v. */
PetscErrorCode AncfAssembleNodes(Ancf ancf, PetscReal shift, Mat P)
{
  PetscReal blk[144];
  PetscInt bs;

  PetscFunctionBegin;
  PetscCall(MatGetBlockSize(P, &bs));
  for (PetscInt j = 0; j < ancf->nnodes; j++) {
    if (bs == 6 && !ancf->fixed[j] && !AncfInJoint(ancf, j)) continue;
    PetscCall(PetscArrayzero(blk, 144));
    for (int c = 0; c < 6; c++) {
      if (ancf->fixed[j] & (c < 3 ? ANCF_FIX_POSITION : ANCF_FIX_GRADIENT) || AncfIsDependent(ancf, 6 * j + c))
        blk[(bs + 1) * (bs - 6 + c)] = shift;
      if (bs == 12) {
        blk[13 * c] = shift;
        blk[12 * c + 6 + c] = -1;
      }
    }
    PetscCall(MatSetValuesBlocked(P, 1, &j, 1, &j, blk, ADD_VALUES));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfAssemble(Ancf ancf, const PetscReal *e, const PetscReal *v, PetscInt stride, PetscReal shift, PetscReal gv,
                            PetscReal diag, Mat J, Mat P)
{
  PetscBool shell;

  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)P, MATSHELL, &shell));
  PetscCall(PetscLogEventBegin(ANCF_Tangent, 0, 0, 0, 0));
  if (shell) {
    AncfShell *s;

    PetscCall(MatShellGetContext(P, &s));
    s->at = ancf->lasting ? e : s->e;
    if (!ancf->lasting) PetscCall(PetscArraycpy(s->e, e, 6 * ancf->nnodes));
    s->shift = shift;
    s->diag = diag;
    s->identity = PETSC_FALSE;
    if (s->v) {
      AncfSpin(ancf, e, v, stride, s->spin);
      PetscCall(PetscArraycpy(s->v, v, 6 * ancf->nnodes));
      s->gv = gv;
    }
  } else {
    if (ancf->njoints) {
      PetscCall(AncfJointState(ancf, e, v, stride, NULL, 0));
      e = ancf->je, v = v ? ancf->jv : NULL, stride = 6;
    }
    PetscCall(MatZeroEntries(P));
    PetscCall(AncfAssembleElements(ancf, e, stride, shift, P));
    if (v) PetscCall(AncfAssembleViscous(ancf, e, v, stride, gv, P));
    PetscCall(AncfAssembleMoments(ancf, e, stride, P));
    PetscCall(AncfNetworkGeometric(ancf, P));
    PetscCall(AncfAssembleNodes(ancf, diag, P));
  }
  PetscCall(MatAssemblyBegin(P, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(P, MAT_FINAL_ASSEMBLY));
  if (J != P) {
    PetscCall(MatAssemblyBegin(J, MAT_FINAL_ASSEMBLY));
    PetscCall(MatAssemblyEnd(J, MAT_FINAL_ASSEMBLY));
  }
  PetscCall(PetscLogEventEnd(ANCF_Tangent, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* P = diag times the identity. */
PetscErrorCode AncfAssembleIdentity(Ancf ancf, PetscReal diag, Mat P)
{
  PetscBool shell;

  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)P, MATSHELL, &shell));
  if (shell) {
    AncfShell *s;

    PetscCall(MatShellGetContext(P, &s));
    s->diag = diag;
    s->identity = PETSC_TRUE;
  } else {
    PetscCall(MatZeroEntries(P));
    for (PetscInt i = 0; i < 6 * ancf->nnodes + ancf->nmult; i++) PetscCall(MatSetValue(P, i, i, diag, INSERT_VALUES));
  }
  PetscCall(MatAssemblyBegin(P, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(P, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mass matrix of the lanes' elements for one direction; shift included in mass. */
static inline void ShellMass(AncfLanes mass, AncfLanes l, AncfLanes m[4][4])
{
  const AncfLanes one = {1, 1, 1, 1, 1, 1, 1, 1}, scale[2] = {one, l};
  PetscReal t[16];

  AncfElementMass(1, 1, t);
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) m[i][j] = t[4 * i + j] * mass * scale[i % 2] * scale[j % 2];
}

/* Adds the four 6 x 6 blocks of the element between two rows; r_0 rows and columns are minus those of r_1. */
static inline void ShellAdd(const AncfLanes K[ANCF_TANGENT], AncfLanes m[4][4], AncfLanes *D0, AncfLanes *U, AncfLanes *D1)
{
  static const int sym[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};

  ANCF_UNROLL for (int i = 0; i < 3; i++) ANCF_UNROLL for (int j = 0; j < 3; j++)
  {
    const AncfLanes aa = K[sym[i][j]], bb = K[6 + sym[i][j]], cc = K[12 + sym[i][j]];
    const AncfLanes ab = K[18 + 3 * i + j], ba = K[18 + 3 * j + i], ac = K[27 + 3 * i + j], bc = K[36 + 3 * i + j];
    const AncfLanes zero = {0};
    const int same = i == j; /* the mass couples equal directions */

    D0[6 * i + 3 + j] -= same ? ba - m[0][1] : ba;
    U[6 * i + j] = (same ? m[0][2] : zero) - bb;
    U[6 * i + 3 + j] = (same ? m[0][3] : zero) - bc;
    U[6 * (3 + i) + j] = same ? ab + m[1][2] : ab;
    U[6 * (3 + i) + 3 + j] = same ? ac + m[1][3] : ac;
    D1[6 * i + 3 + j] = same ? bc + m[2][3] : bc;
    if (j < i) continue; /* the lower triangles are not read */
    D0[6 * i + j] += same ? bb + m[0][0] : bb;
    D0[6 * (3 + i) + 3 + j] += same ? aa + m[1][1] : aa;
    D1[6 * i + j] = same ? bb + m[2][2] : bb;
    D1[6 * (3 + i) + 3 + j] = same ? cc + m[3][3] : cc;
  }
}

typedef __typeof__((AncfLanes){0} == (AncfLanes){0}) ShellMask;
#define SHELL_KEEP(mask, x) ((AncfLanes)((mask) & (ShellMask)(x)))

/* Identity rows of eliminated coordinates and of rows past the end of a lane's beam; only upper triangles of D are read. */
static void ShellFix(const AncfShell *s, const AncfLaneBeams *b, PetscInt nrows, AncfLanes *D, AncfLanes *U)
{
  for (PetscInt j = 0; j < nrows; j++) {
    ShellMask keep[2];
    AncfLanes diag = {0}, *Dj = D + 36 * j, *Uj = U + 36 * j;
    unsigned char any = 0;

    for (int i = 0; i < ANCF_LANES && j <= b->least; i++) any |= s->ancf->fixed[b->first[i] + j];
    if (PetscLikely(!any && j <= b->least)) continue;
    for (int i = 0; i < ANCF_LANES; i++) {
      const PetscBool past = j > b->elements[i] ? PETSC_TRUE : PETSC_FALSE;
      const unsigned char fix = past ? ANCF_FIX_POSITION | ANCF_FIX_GRADIENT : s->ancf->fixed[b->first[i] + j];

      keep[0][i] = fix & ANCF_FIX_POSITION ? 0 : -1;
      keep[1][i] = fix & ANCF_FIX_GRADIENT ? 0 : -1;
      diag[i] = past ? 1 : s->diag;
    }
    for (int r = 0; r < 6; r++) {
      for (int c = r; c < 6; c++) Dj[6 * r + c] = SHELL_KEEP(keep[r / 3] & keep[c / 3], Dj[6 * r + c]);
      Dj[7 * r] += SHELL_KEEP(~keep[r / 3], diag);
      for (int c = 0; c < 6 && j + 1 < nrows; c++) Uj[6 * r + c] = SHELL_KEEP(keep[r / 3], Uj[6 * r + c]);
      for (int c = 0; c < 6 && j > 0; c++) Uj[6 * r + c - 36] = SHELL_KEEP(keep[c / 3], Uj[6 * r + c - 36]);
    }
  }
}

/* The symmetric part of the tangent of the moments: Newton's method corrects the rest. */
static void ShellMoments(const AncfShell *s, const PetscInt chain[ANCF_LANES], PetscInt nrows, AncfLanes *D)
{
  for (int i = 0; i < ANCF_LANES; i++)
    for (PetscInt k = 0; k < nrows; k++) {
      const PetscInt j = chain[i] < 0 || k >= s->length[chain[i]] ? -1 : s->first[chain[i]] + k;
      const PetscReal *M = j < 0 ? NULL : s->ancf->moment + 3 * j;
      PetscReal Q[3], dQ[9];

      if (!M || (M[0] == 0 && M[1] == 0 && M[2] == 0)) continue;
      AncfMomentForce(M, s->at + 6 * j + 3, Q, dQ);
      for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
          D[36 * k + 6 * (3 + r) + 3 + c][i] -= 0.5 * s->ancf->loadscale * (dQ[3 * r + c] + dQ[3 * c + r]);
    }
}

/* The chains of a batch as beams in lanes; those of PCBLOCKTRI come longest first, like the set's own if there are enough. */
static inline AncfLaneBeams ShellLanes(const AncfShell *s, const PetscInt chain[ANCF_LANES])
{
  AncfLaneBeams b;
  PetscBool same = s->lanes ? PETSC_TRUE : PETSC_FALSE;

  if (same) {
    b = s->ancf->lanebeams[s->lanes[chain[0]]];
    for (int i = 0; i < ANCF_LANES; i++)
      if (b.first[i] != (chain[i] < 0 ? -1 : s->first[chain[i]])) same = PETSC_FALSE;
    if (PetscLikely(same)) return b;
  }

  for (int i = 0; i < ANCF_LANES; i++) {
    const PetscBool used = chain[i] >= 0 ? PETSC_TRUE : PETSC_FALSE;
    const AncfBeam *m = &s->ancf->beams[used ? chain[i] : chain[0]];

    b.first[i] = used ? m->node : -1;
    b.elements[i] = used ? m->spec.elements : -1;
    b.EA[i] = m->EA;
    b.EI[i] = m->EI;
    b.rhoA[i] = m->rhoA;
    b.l[i] = m->l;
  }
  b.most = b.elements[0];
  b.least = b.elements[ANCF_LANES - 1];
  return b;
}

static void ShellFill(void *ctx, const PetscInt chain[ANCF_LANES], PetscInt nrows, AncfLanes *D, AncfLanes *U)
{
  const AncfShell *s = (const AncfShell *)ctx;
  const AncfLaneBeams b = ShellLanes(s, chain);
  const AncfSection full = {AncfLoad(b.EA), AncfLoad(b.EI), AncfLoad(b.l)};
  const AncfLanes zero = {0}, one = zero + 1.0, fullmass = s->shift * AncfLoad(b.rhoA) * full.l;
  AncfLanes e[12] = {zero, zero, zero, one, zero, zero, one, zero, zero, one, zero, zero}, m[4][4];

  if (s->identity) {
    for (PetscInt j = 0; j < 36 * nrows; j++) {
      D[j] = j % 36 % 7 ? zero : zero + s->diag;
      U[j] = zero;
    }
    return;
  }
  for (int c = 0; c < 36; c++) D[c] = zero;
  ShellMass(fullmass, full.l, m);
  AncfGatherLane(s->ancf, &b, 0, s->at, 6, s->ancf->rest, e);
  for (PetscInt k = 0; k + 1 < nrows; k++) {
    AncfSection sec = full;
    AncfLanes Q[12], K[ANCF_TANGENT];

    AncfGatherLane(s->ancf, &b, k + 1, s->at, 6, s->ancf->rest, e + 6);
    if (k >= b.least) {
      AncfLanes mass = fullmass;

      for (int i = 0; i < ANCF_LANES; i++)
        if (k >= b.elements[i]) AncfIdleLane(i, &sec, &mass, e);
      ShellMass(mass, sec.l, m);
    }
    AncfElementTangent(&s->ancf->rule, &sec, e, Q, K);
    if (s->ancf->natural) {
      PetscInt node[ANCF_LANES];

      for (int i = 0; i < ANCF_LANES; i++) node[i] = sec.EA[i] > 0 ? s->first[chain[i]] + k : -1;
      AncfRestTangent(s->ancf, node, &sec, e, K);
    }
    if (s->v) AncfViscousChain(s->ancf, chain, k, e, s->v, s->spin, s->gv, K);
    ShellAdd(K, m, D + 36 * k, U + 36 * k, D + 36 * (k + 1));
    for (int c = 0; c < 6; c++) e[c] = e[6 + c];
  }
  if (s->ancf->moment) ShellMoments(s, chain, nrows, D);
  ShellFix(s, &b, nrows, D, U);
}

static PetscErrorCode ShellMult(Mat A, Vec X, Vec Y)
{
  AncfShell *s;
  Ancf ancf;
  const PetscScalar *x;
  PetscScalar *y;

  PetscFunctionBegin;
  PetscCall(MatShellGetContext(A, &s));
  ancf = s->ancf;
  PetscCall(VecGetArrayRead(X, &x));
  PetscCall(VecGetArrayWrite(Y, &y));
  PetscCall(PetscArrayzero(y, 6 * ancf->nnodes));
  for (PetscInt n = 0; n < ancf->nbatches && !s->identity; n++) {
    const AncfBatch *b = &ancf->batches[n];
    AncfSection sec = AncfBatchSection(b);
    AncfLanes e[12], Q[12], K[ANCF_TANGENT], H[81];
    PetscReal k[144];

    AncfGather(ancf, b, s->at, 6, ancf->rest, e);
    AncfElementTangent(&ancf->rule, &sec, e, Q, K);
    if (ancf->natural) AncfRestTangent(ancf, b->node, &sec, e, K);
    if (s->v) AncfViscousBatch(ancf, b, s->spin, e, s->v, 6, 1, s->gv, H);
    for (PetscInt i = 0; i < b->n; i++) {
      AncfElementMatrix(ancf, b, i, K, s->shift, k);
      if (s->v) {
        AncfScaledExpand(H, sec.l, i, k);
        AncfClearFixed(ancf, b, i, k);
      }
      for (int r = 0; r < 12; r++)
        for (int c = 0; c < 12; c++) y[6 * b->node[i] + r] += k[12 * r + c] * x[6 * b->node[i] + c];
    }
  }
  for (PetscInt j = 0; j < ancf->nnodes && ancf->moment && !s->identity; j++) {
    PetscReal Q[3], dQ[9];

    AncfMomentForce(ancf->moment + 3 * j, s->at + 6 * j + 3, Q, dQ);
    for (int r = 0; r < 9; r++) y[6 * j + 3 + r / 3] -= ancf->loadscale * dQ[r] * x[6 * j + 3 + r % 3];
  }
  for (PetscInt j = 0; j < ancf->nnodes; j++)
    for (int c = 0; c < 6; c++)
      if (s->identity || ancf->fixed[j] & (c < 3 ? ANCF_FIX_POSITION : ANCF_FIX_GRADIENT)) y[6 * j + c] = s->diag * x[6 * j + c];
  PetscCall(VecRestoreArrayWrite(Y, &y));
  PetscCall(VecRestoreArrayRead(X, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ShellDestroy(Mat A)
{
  AncfShell *s;

  PetscFunctionBegin;
  PetscCall(MatShellGetContext(A, &s));
  PetscCall(PetscFree3(s->e, s->first, s->length));
  PetscCall(PetscFree(s->lanes));
  PetscCall(PetscFree2(s->v, s->spin));
  PetscCall(PetscFree(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AncfCreateShell(Ancf ancf, Mat *J)
{
  const PetscInt n = 6 * ancf->nnodes;
  AncfShell *s;

  PetscFunctionBegin;
  PetscCall(PetscNew(&s));
  PetscCall(PetscMalloc3(n, &s->e, ancf->nbeams, &s->first, ancf->nbeams, &s->length));
  if (ancf->viscous) PetscCall(PetscMalloc2(n, &s->v, 3 * (size_t)ancf->nbeams, &s->spin));
  for (PetscInt b = 0; b < ancf->nbeams; b++) {
    s->first[b] = ancf->beams[b].node;
    s->length[b] = ancf->beams[b].spec.elements + 1;
  }
  s->ancf = ancf;
  if (ancf->lanebeams) {
    PetscCall(PetscCalloc1(ancf->nbeams, &s->lanes));
    for (PetscInt k = 0; k < ancf->nlanebeams; k++) s->lanes[AncfFindBeam(ancf, ancf->lanebeams[k].first[0])] = k;
  }
  s->source = (BlockTriSource){ancf->nbeams, s->first, s->length, ShellFill, s};
  PetscCall(MatCreateShell(ancf->comm, n, n, n, n, s, J));
  PetscCall(MatSetBlockSize(*J, 6));
  PetscCall(MatShellSetOperation(*J, MATOP_MULT, (AncfOperation)ShellMult));
  PetscCall(MatShellSetOperation(*J, MATOP_DESTROY, (AncfOperation)ShellDestroy));
  PetscCall(MatBlockTriSetSource(*J, &s->source));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AncfCreateStored(Ancf ancf, PetscInt bs, Mat *J)
{
  PetscInt n = bs * ancf->nnodes, *nnz, *upper;
  PetscBool sbaij;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(ancf->nnodes, &nnz, ancf->nnodes, &upper));
  for (PetscInt b = 0; b < ancf->nbeams; b++) {
    const AncfBeam *m = &ancf->beams[b];

    for (PetscInt k = 0; k <= m->spec.elements; k++)
      nnz[m->node + k] = 3 - (k == 0) - (k == m->spec.elements), upper[m->node + k] = 2 - (k == m->spec.elements);
  }
  PetscCall(MatCreate(ancf->comm, J));
  PetscCall(MatSetSizes(*J, n, n, n, n));
  PetscCall(MatSetBlockSize(*J, bs));
  PetscCall(MatSetType(*J, MATSEQBAIJ));
  PetscCall(MatSetOptionsPrefix(*J, ancf->prefix));
  PetscCall(MatAppendOptionsPrefix(*J, "ancf_"));
  PetscCall(MatSetFromOptions(*J));
  PetscCall(MatXAIJSetPreallocation(*J, bs, nnz, NULL, upper, NULL));
  PetscCall(PetscFree2(nnz, upper));
  PetscCall(MatSetOption(*J, MAT_SYMMETRIC, bs == 6 && !ancf->viscous ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(PetscObjectTypeCompare((PetscObject)*J, MATSEQSBAIJ, &sbaij));
  if (sbaij) PetscCall(MatSetOption(*J, MAT_IGNORE_LOWER_TRIANGULAR, PETSC_TRUE));
  for (PetscInt b = 0; b < ancf->nbeams; b++) {
    PetscReal zero[4 * 144] = {0};

    for (PetscInt k = 0; k < ancf->beams[b].spec.elements; k++) {
      PetscInt idx[2] = {ancf->beams[b].node + k, ancf->beams[b].node + k + 1};

      PetscCall(MatSetValuesBlocked(*J, 2, idx, 2, idx, zero, INSERT_VALUES));
    }
  }
  PetscCall(MatAssemblyBegin(*J, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*J, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Matrix for this preconditioner: unassembled for PCBLOCKTRI, else MATSEQBAIJ by default. Unless told otherwise, and if choose is
  set, a set of enough beams to fill half the vector lanes takes PCBLOCKTRI, a smaller one the block ILU(0), exact for these
  matrices.
*/
PetscErrorCode AncfCreateMatrix(Ancf ancf, PetscInt bs, PC pc, PetscBool choose, Mat *J)
{
  PetscBool blocktri, mat, given;
  char prefix[256];

  PetscFunctionBegin;
  if (ancf->nmult && choose) {
    PetscCall(AncfDaeCreateMatrix(ancf, bs, pc, J));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (ancf->njoints) {
    PetscCall(AncfNetworkCreate(ancf, bs, pc, J));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%sancf_", ancf->prefix ? ancf->prefix : ""));
  PetscCall(PetscOptionsHasName(NULL, prefix, "-mat_type", &mat));
  PetscCall(PetscOptionsHasName(NULL, prefix, "-pc_type", &given));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCILU, &blocktri));
  if (choose && blocktri && !given && !mat && !ancf->exposed && bs == 6 && 2 * ancf->nbeams >= ANCF_LANES)
    PetscCall(PCSetType(pc, PCBLOCKTRI));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCBLOCKTRI, &blocktri));
  if (blocktri && bs == 6 && !mat)
    PetscCall(AncfCreateShell(ancf, J));
  else
    PetscCall(AncfCreateStored(ancf, bs, J));
  PetscFunctionReturn(PETSC_SUCCESS);
}
