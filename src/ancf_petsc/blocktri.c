/* blocktri.c - PCBLOCKTRI: batched block-tridiagonal elimination, see blocktri.h. */
#include "blocktri.h"
#include "lanes.h"
#include <stdlib.h>
#if defined(_OPENMP)
  #include <omp.h>
#endif

typedef BlockTriLanes Lanes;

typedef struct {
  PetscInt chain[BLOCKTRI_LANES], nrows, shortest; /* longest chain first, -1: unused lane */
  PetscInt first[BLOCKTRI_LANES], length[BLOCKTRI_LANES];
  size_t offset; /* of its first row in the stored factors, rows */
} Batch;

typedef struct {
  PetscInt bs, nbatches, maxrows, nthreads;
  Batch *batches;
  PetscInt *first, *length, nchains; /* found in the matrix when it has no source */
  const BlockTriSource *source;
  Lanes *factor; /* stored D, W = D^-1 U, L, bs x bs each, row by row; NULL with a source */
  Lanes *work;   /* per thread */
  size_t nwork, rows;
  void *block; /* allocation behind factor and work */
  PetscObjectState nonzerostate;
} BlockTri;

/* A = L U in place without pivoting; the diagonal keeps the inverse pivots. */
static inline __attribute__((always_inline)) void LU(const int bs, Lanes *A)
{
  for (int k = 0; k < bs; k++) {
    const Lanes inv = 1.0 / A[bs * k + k];

    A[bs * k + k] = inv;
    for (int i = k + 1; i < bs; i++) {
      const Lanes l = A[bs * i + k] * inv;

      A[bs * i + k] = l;
      for (int j = k + 1; j < bs; j++) A[bs * i + j] -= l * A[bs * k + j];
    }
  }
}

/* X := A^-1 X, nx right-hand sides in row-major X. */
static inline __attribute__((always_inline)) void Solve(const int bs, const int nx, const Lanes *A, Lanes *X)
{
  for (int i = 1; i < bs; i++)
    for (int k = 0; k < i; k++)
      for (int c = 0; c < nx; c++) X[nx * i + c] -= A[bs * i + k] * X[nx * k + c];
  for (int i = bs - 1; i >= 0; i--) {
    for (int k = i + 1; k < bs; k++)
      for (int c = 0; c < nx; c++) X[nx * i + c] -= A[bs * i + k] * X[nx * k + c];
    for (int c = 0; c < nx; c++) X[nx * i + c] *= A[bs * i + i];
  }
}

/* C -= A B */
static inline __attribute__((always_inline)) void Subtract(const int bs, const int nx, const Lanes *A, const Lanes *B, Lanes *C)
{
  for (int i = 0; i < bs; i++)
    for (int k = 0; k < bs; k++)
      for (int c = 0; c < nx; c++) C[nx * i + c] -= A[bs * i + k] * B[nx * k + c];
}

/* Loops over entries of the blocks of beams, whose indices must be known to the compiler: the entries then stay in registers. */
#define EACH _Pragma("GCC unroll 6") for
#define SMALL 6

/* A = L D L^T of a symmetric matrix given by its upper triangle: row k then holds column k of L, the diagonal 1/D. Sums stay in
   registers here and below: a sum kept in memory would wait for its own store. */
static inline __attribute__((always_inline)) void LDL(const int bs, Lanes *A)
{
  Lanes local[SMALL * SMALL], *a = bs == SMALL ? local : A;

  EACH(int i = 0; i < bs && a != A; i++) EACH(int j = i; j < bs; j++) a[bs * i + j] = A[bs * i + j];
  EACH(int i = 0; i < bs; i++)
  {
    Lanes d = a[bs * i + i];

    EACH(int k = 0; k < i; k++) d -= a[bs * k + i] * a[bs * k + i] * a[bs * k + k]; /* rows above hold D L^T until the end */
    a[bs * i + i] = 1.0 / d;
    EACH(int j = i + 1; j < bs; j++)
    {
      Lanes x = a[bs * i + j];

      EACH(int k = 0; k < i; k++) x -= a[bs * k + i] * a[bs * k + k] * a[bs * k + j];
      a[bs * i + j] = x;
    }
  }
  EACH(int i = 0; i < bs; i++)
  {
    EACH(int j = i + 1; j < bs; j++) A[bs * i + j] = a[bs * i + j] * a[bs * i + i];
    A[bs * i + i] = a[bs * i + i];
  }
}

/* X := L^-1 X */
static inline __attribute__((always_inline)) void LowerSolve(const int bs, const int nx, const Lanes *A, Lanes *X)
{
  Lanes local[SMALL * SMALL];
  const Lanes *l = bs == SMALL ? local : A;

  EACH(int i = 0; i < bs && l != A; i++) EACH(int j = i + 1; j < bs; j++) local[bs * i + j] = A[bs * i + j];
  for (int c = 0; c < nx; c++) {
    EACH(int i = 1; i < bs; i++)
    {
      Lanes x = X[nx * i + c];

      EACH(int k = 0; k < i; k++) x -= l[bs * k + i] * X[nx * k + c];
      X[nx * i + c] = x;
    }
  }
}

/* Eliminates a row: upper triangle of C -= W^T D^-1 W, z1 -= W^T D^-1 z0. */
static inline __attribute__((always_inline)) void Eliminate(const int bs, const Lanes *A, const Lanes *W, Lanes *C,
                                                            const Lanes *z0, Lanes *z1)
{
  Lanes local[SMALL * SMALL], rhs[SMALL], *c = bs == SMALL ? local : C, *z = bs == SMALL ? rhs : z1;

  EACH(int i = 0; i < bs && c != C; i++)
  {
    z[i] = z1[i];
    EACH(int j = i; j < bs; j++) c[bs * i + j] = C[bs * i + j];
  }
  for (int k = 0; k < bs; k++) {
    EACH(int i = 0; i < bs; i++)
    {
      const Lanes v = W[bs * k + i] * A[bs * k + k];

      z[i] -= v * z0[k];
      EACH(int j = i; j < bs; j++) c[bs * i + j] -= v * W[bs * k + j];
    }
  }
  EACH(int i = 0; i < bs && c != C; i++)
  {
    z1[i] = z[i];
    EACH(int j = i; j < bs; j++) C[bs * i + j] = c[bs * i + j];
  }
}

/* z := L^-T D^-1 z */
static inline __attribute__((always_inline)) void UpperSolve(const int bs, const Lanes *A, Lanes *z)
{
  EACH(int i = bs - 1; i >= 0; i--)
  {
    Lanes x = z[i] * A[bs * i + i];

    EACH(int k = i + 1; k < bs; k++) x -= A[bs * i + k] * z[k];
    z[i] = x;
  }
}

static inline __attribute__((always_inline)) void Gather(const int bs, const Batch *b, PetscInt row, const PetscScalar *x,
                                                         Lanes *y)
{
  if (row < b->shortest) { /* no branch between the lanes */
    const PetscScalar *s[BLOCKTRI_LANES];

    for (int i = 0; i < BLOCKTRI_LANES; i++) s[i] = x + (b->first[i] + row) * bs;
    LanesGather(bs, s, y);
    return;
  }
  for (int i = 0; i < BLOCKTRI_LANES; i++) {
    const PetscScalar *s = x + (b->first[i] + row) * bs;

    if (row < b->length[i])
      for (int c = 0; c < bs; c++) y[c][i] = s[c];
    else
      for (int c = 0; c < bs; c++) y[c][i] = 0;
  }
}

static inline __attribute__((always_inline)) void Scatter(const int bs, const Batch *b, PetscInt row, const Lanes *y,
                                                          PetscScalar *x)
{
  if (row < b->shortest) {
    PetscScalar *s[BLOCKTRI_LANES];

    for (int i = 0; i < BLOCKTRI_LANES; i++) s[i] = x + (b->first[i] + row) * bs;
    LanesScatter(bs, y, s, 0);
    return;
  }
  for (int i = 0; i < BLOCKTRI_LANES; i++)
    if (row < b->length[i])
      for (int c = 0; c < bs; c++) x[(b->first[i] + row) * bs + c] = y[c][i];
}

/*
  One batch, blocks made by the source: A = L D L^T and forward sweep together, then the backward sweep. Row j keeps L_j, D_j and
  W_j = L_j^-1 U_j, so that the next row loses W_j^T D_j^-1 W_j; no block is inverted.
*/
static inline __attribute__((always_inline)) void FusedBatch(const int bs, const BlockTriSource *s, const Batch *b, Lanes *work,
                                                             const PetscScalar *x, PetscScalar *y)
{
  const PetscInt n = b->nrows, m = bs * bs;
  Lanes *D = work, *U = D + n * m, *z = U + n * m;

  s->fill(s->ctx, b->chain, n, D, U);
  Gather(bs, b, 0, x, z);
  for (PetscInt j = 0; j < n; j++) {
    LDL(bs, D + j * m);
    LowerSolve(bs, 1, D + j * m, z + j * bs);
    if (j + 1 == n) break;
    LowerSolve(bs, bs, D + j * m, U + j * m);
    Gather(bs, b, j + 1, x, z + (j + 1) * bs);
    Eliminate(bs, D + j * m, U + j * m, D + (j + 1) * m, z + j * bs, z + (j + 1) * bs);
  }
  for (PetscInt j = n - 1; j >= 0; j--) {
    if (j + 1 < n) Subtract(bs, 1, U + j * m, z + (j + 1) * bs, z + j * bs);
    UpperSolve(bs, D + j * m, z + j * bs);
    Scatter(bs, b, j, z + j * bs, y);
  }
}

static inline __attribute__((always_inline)) void FactorBatch(const int bs, const Batch *b, Lanes *factor)
{
  const PetscInt m = bs * bs;

  for (PetscInt j = 0; j < b->nrows; j++) {
    Lanes *D = factor + 3 * m * j, *U = D + m, *L = U + m;

    LU(bs, D);
    if (j + 1 == b->nrows) break;
    Solve(bs, bs, D, U);
    Subtract(bs, bs, L, U, D + 3 * m);
  }
}

static inline __attribute__((always_inline)) void SolveBatch(const int bs, const Batch *b, const Lanes *factor, Lanes *z,
                                                             const PetscScalar *x, PetscScalar *y)
{
  const PetscInt m = bs * bs, n = b->nrows;

  for (PetscInt j = 0; j < n; j++) {
    const Lanes *D = factor + 3 * m * j;

    Gather(bs, b, j, x, z + j * bs);
    if (j) Subtract(bs, 1, D - m, z + (j - 1) * bs, z + j * bs);
    Solve(bs, 1, D, z + j * bs);
  }
  for (PetscInt j = n - 1; j >= 0; j--) {
    if (j + 1 < n) Subtract(bs, 1, factor + 3 * m * j + m, z + (j + 1) * bs, z + j * bs);
    Scatter(bs, b, j, z + j * bs, y);
  }
}

/* The block sizes of beams are compiled for themselves. The calls are statements: no parentheses.
   NOLINTBEGIN(bugprone-macro-parentheses) */
#define DISPATCH(bs, call6, call12, calln)                                                                                       \
  do {                                                                                                                           \
    if ((bs) == 6)                                                                                                               \
      call6;                                                                                                                     \
    else if ((bs) == 12)                                                                                                         \
      call12;                                                                                                                    \
    else                                                                                                                         \
      calln;                                                                                                                     \
  } while (0)
/* NOLINTEND(bugprone-macro-parentheses) */

static int Thread(void)
{
#if defined(_OPENMP)
  return omp_get_thread_num();
#else
  return 0;
#endif
}

static PetscErrorCode GetContext(PC pc, BlockTri **t)
{
  PetscContainer c;

  PetscFunctionBegin;
  PetscCall(PetscObjectQuery((PetscObject)pc, "PCBlockTri", (PetscObject *)&c));
  PetscCheck(c, PetscObjectComm((PetscObject)pc), PETSC_ERR_PLIB, "PCBLOCKTRI lost its data");
  PetscCall(PetscContainerGetPointer(c, (void **)t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Reset(BlockTri *t)
{
  free(t->batches);
  free(t->first);
  free(t->length);
  free(t->block);
  t->batches = NULL;
  t->first = t->length = NULL;
  t->block = NULL;
  t->factor = t->work = NULL;
}

/* Chains of a stored matrix: block rows that couple to the next one. */
static PetscErrorCode FindChains(Mat P, BlockTri *t)
{
  PetscInt rows, nb, n = 0, lastlinked = -1;

  PetscFunctionBegin;
  PetscCall(MatGetSize(P, &rows, NULL));
  nb = rows / t->bs;
  t->first = malloc(sizeof(PetscInt) * (size_t)PetscMax(nb, 1));
  t->length = malloc(sizeof(PetscInt) * (size_t)PetscMax(nb, 1));
  PetscCheck(t->first && t->length, PETSC_COMM_SELF, PETSC_ERR_MEM, "PCBLOCKTRI: no memory for %" PetscInt_FMT " block rows", nb);
  for (PetscInt j = 0; j < nb; j++) {
    PetscBool linked = lastlinked == j ? PETSC_TRUE : PETSC_FALSE;

    for (PetscInt r = 0; r < t->bs; r++) {
      const PetscInt *cols;
      PetscInt nc;

      PetscCall(MatGetRow(P, t->bs * j + r, &nc, &cols, NULL));
      for (PetscInt c = 0; c < nc; c++) {
        PetscInt k = cols[c] / t->bs;

        PetscCheck(k >= j - 1 && k <= j + 1, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
                   "PCBLOCKTRI needs a block-tridiagonal matrix; block row %" PetscInt_FMT " couples to %" PetscInt_FMT, j, k);
        if (k == j - 1) linked = PETSC_TRUE;
        if (k == j + 1) lastlinked = j + 1;
      }
      PetscCall(MatRestoreRow(P, t->bs * j + r, &nc, &cols, NULL));
    }
    if (linked && n > 0)
      t->length[n - 1]++;
    else {
      t->first[n] = j;
      t->length[n++] = 1;
    }
  }
  t->nchains = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const PetscInt *sort_length; /* guarded: set-up runs on one thread */

static int LongestFirst(const void *a, const void *b)
{
  PetscInt i = *(const PetscInt *)a, j = *(const PetscInt *)b;

  if (sort_length[i] != sort_length[j]) return sort_length[i] < sort_length[j] ? 1 : -1;
  return i < j ? -1 : 1;
}

/* Chains of similar length share a batch, so that few lanes idle. */
static PetscErrorCode MakeBatches(BlockTri *t)
{
  const PetscInt n = t->source ? t->source->nchains : t->nchains;
  const PetscInt *first = t->source ? t->source->first : t->first, *length = t->source ? t->source->length : t->length;
  PetscInt *order;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &order));
  for (PetscInt i = 0; i < n; i++) order[i] = i;
  sort_length = length;
  qsort(order, (size_t)n, sizeof(PetscInt), LongestFirst);
  t->nbatches = (n + BLOCKTRI_LANES - 1) / BLOCKTRI_LANES;
  t->batches = malloc(sizeof(Batch) * (size_t)PetscMax(t->nbatches, 1));
  PetscCheck(t->batches, PETSC_COMM_SELF, PETSC_ERR_MEM, "PCBLOCKTRI: no memory for %" PetscInt_FMT " batches", t->nbatches);
  t->maxrows = 0;
  t->rows = 0;
  for (PetscInt k = 0; k < t->nbatches; k++) {
    Batch *b = &t->batches[k];

    b->nrows = 0;
    for (PetscInt i = 0; i < BLOCKTRI_LANES; i++) {
      PetscInt c = BLOCKTRI_LANES * k + i < n ? order[BLOCKTRI_LANES * k + i] : -1;

      b->chain[i] = c;
      b->first[i] = c < 0 ? 0 : first[c];
      b->length[i] = c < 0 ? 0 : length[c];
      b->nrows = PetscMax(b->nrows, b->length[i]);
    }
    b->shortest = b->length[BLOCKTRI_LANES - 1];
    b->offset = t->rows;
    t->rows += (size_t)b->nrows;
    t->maxrows = PetscMax(t->maxrows, b->nrows);
  }
  PetscCall(PetscFree(order));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Blocks of one batch from a stored matrix into D, U, L. */
static PetscErrorCode Extract(Mat P, BlockTri *t, const Batch *b)
{
  const PetscInt bs = t->bs, m = bs * bs;
  Lanes *factor = t->factor + 3 * (size_t)m * b->offset;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < 3 * m * b->nrows; i++) factor[i] = (Lanes){0};
  for (PetscInt i = 0; i < BLOCKTRI_LANES; i++)
    for (PetscInt j = 0; j < b->nrows; j++) {
      Lanes *D = factor + 3 * m * j;

      for (PetscInt r = 0; r < bs; r++) {
        const PetscInt *cols, row = b->first[i] + j;
        const PetscScalar *vals;
        PetscInt nc;

        if (j >= b->length[i]) {
          D[bs * r + r][i] = 1;
          continue;
        }
        PetscCall(MatGetRow(P, row * bs + r, &nc, &cols, &vals));
        for (PetscInt c = 0; c < nc; c++) {
          PetscInt k = cols[c] / bs - row, q = bs * r + cols[c] % bs;

          if (k == 0)
            D[q][i] = vals[c];
          else if (k == 1)
            D[m + q][i] = vals[c];
          else
            D[2 * m - 3 * m + q][i] = vals[c]; /* L of the row above */
        }
        PetscCall(MatRestoreRow(P, row * bs + r, &nc, &cols, &vals));
      }
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Allocate(BlockTri *t)
{
  const size_t m = (size_t)t->bs * (size_t)t->bs, maxrows = (size_t)t->maxrows, factors = t->source ? 0 : 3 * m * t->rows;

  PetscFunctionBegin;
#if defined(_OPENMP)
  t->nthreads = omp_get_max_threads();
#else
  t->nthreads = 1;
#endif
  t->nwork = maxrows * (2 * m + (size_t)t->bs);
  t->block = aligned_alloc(sizeof(Lanes), sizeof(Lanes) * (factors + (size_t)t->nthreads * t->nwork));
  PetscCheck(t->block, PETSC_COMM_SELF, PETSC_ERR_MEM, "PCBLOCKTRI: no memory for %g MB",
             (double)(factors + (size_t)t->nthreads * t->nwork) * sizeof(Lanes) / 1e6);
  t->work = (Lanes *)t->block;
  t->factor = t->source ? NULL : t->work + (size_t)t->nthreads * t->nwork;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PCSetUp_BlockTri(PC pc)
{
  BlockTri *t;
  Mat P;
  PetscContainer c;
  PetscObjectState state;
  const BlockTriSource *source = NULL;

  PetscFunctionBegin;
  PetscCall(GetContext(pc, &t));
  PetscCall(PCGetOperators(pc, NULL, &P));
  PetscCall(PetscObjectQuery((PetscObject)P, "MatBlockTriSource", (PetscObject *)&c));
  if (c) PetscCall(PetscContainerGetPointer(c, (void **)&source));
  PetscCall(MatGetNonzeroState(P, &state));
  if (!t->batches || source != t->source || state != t->nonzerostate) {
    Reset(t);
    t->source = source;
    t->nonzerostate = state;
    PetscCall(MatGetBlockSize(P, &t->bs));
    if (!source) PetscCall(FindChains(P, t));
    PetscCall(MakeBatches(t));
    PetscCall(Allocate(t));
  }
  if (t->source) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < t->nbatches; k++) PetscCall(Extract(P, t, &t->batches[k]));
#pragma omp parallel for schedule(static) if (t->nbatches >= 64)
  for (PetscInt k = 0; k < t->nbatches; k++) {
    const Batch *b = &t->batches[k];
    Lanes *f = t->factor + 3 * (size_t)(t->bs * t->bs) * b->offset;

    DISPATCH(t->bs, FactorBatch(6, b, f), FactorBatch(12, b, f), FactorBatch((int)t->bs, b, f));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PCApply_BlockTri(PC pc, Vec X, Vec Y)
{
  BlockTri *t;
  const PetscScalar *x;
  PetscScalar *y;

  PetscFunctionBegin;
  PetscCall(GetContext(pc, &t));
  PetscCall(VecGetArrayRead(X, &x));
  PetscCall(VecGetArrayWrite(Y, &y));
#pragma omp parallel for schedule(static) num_threads(t->nthreads) if (t->nbatches >= 64)
  for (PetscInt k = 0; k < t->nbatches; k++) {
    const Batch *b = &t->batches[k];
    Lanes *w = t->work + (size_t)Thread() * t->nwork;

    if (t->source)
      DISPATCH(t->bs, FusedBatch(6, t->source, b, w, x, y), FusedBatch(12, t->source, b, w, x, y),
               FusedBatch((int)t->bs, t->source, b, w, x, y));
    else {
      const Lanes *f = t->factor + 3 * (size_t)(t->bs * t->bs) * b->offset;

      DISPATCH(t->bs, SolveBatch(6, b, f, w, x, y), SolveBatch(12, b, f, w, x, y), SolveBatch((int)t->bs, b, f, w, x, y));
    }
  }
  PetscCall(VecRestoreArrayWrite(Y, &y));
  PetscCall(VecRestoreArrayRead(X, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PCView_BlockTri(PC pc, PetscViewer viewer)
{
  BlockTri *t;

  PetscFunctionBegin;
  PetscCall(GetContext(pc, &t));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "block size %" PetscInt_FMT ", batches of %d chains: %" PetscInt_FMT
                                   ", longest chain %" PetscInt_FMT ", threads %" PetscInt_FMT ", %s\n",
                                   t->bs, BLOCKTRI_LANES, t->nbatches, t->maxrows, t->nthreads,
                                   t->source ? "eliminated while assembled" : "factors stored"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PCDestroy_BlockTri(PC pc)
{
  BlockTri *t;

  PetscFunctionBegin;
  PetscCall(GetContext(pc, &t));
  Reset(t);
  PetscCall(PetscFree(t));
  PetscCall(PetscObjectCompose((PetscObject)pc, "PCBlockTri", NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PCSHELL under a name of its own: a PC can be built from the public interface in no other way. */
static PetscErrorCode PCCreate_BlockTri(PC pc)
{
  PetscContainer c;
  BlockTri *t;

  PetscFunctionBegin;
  PetscCall(PetscNew(&t));
  PetscCall(PetscContainerCreate(PetscObjectComm((PetscObject)pc), &c));
  PetscCall(PetscContainerSetPointer(c, t));
  PetscCall(PetscObjectCompose((PetscObject)pc, "PCBlockTri", (PetscObject)c));
  PetscCall(PetscContainerDestroy(&c));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetSetUp(pc, PCSetUp_BlockTri));
  PetscCall(PCShellSetApply(pc, PCApply_BlockTri));
  PetscCall(PCShellSetView(pc, PCView_BlockTri));
  PetscCall(PCShellSetDestroy(pc, PCDestroy_BlockTri));
  PetscCall(PetscObjectChangeTypeName((PetscObject)pc, PCBLOCKTRI));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PCBlockTriRegister(void)
{
  PetscFunctionBegin;
  PetscCall(PCRegister(PCBLOCKTRI, PCCreate_BlockTri));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MatBlockTriSetSource(Mat P, const BlockTriSource *source)
{
  PetscContainer c;

  PetscFunctionBegin;
  PetscCall(PetscContainerCreate(PetscObjectComm((PetscObject)P), &c));
  PetscCall(PetscContainerSetPointer(c, (void *)source));
  PetscCall(PetscObjectCompose((PetscObject)P, "MatBlockTriSource", (PetscObject)c));
  PetscCall(PetscContainerDestroy(&c));
  PetscFunctionReturn(PETSC_SUCCESS);
}
