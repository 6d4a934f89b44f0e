/* ancfsearch.c - the line search of the beams: full Newton steps with their norms in one sweep over the vectors. */
#include "ancfimpl.h"

/* Sum of squares in six parts, as the coordinates come: additions need not wait for one another. */
static PetscReal AncfNorm(PetscInt n, const PetscReal *x)
{
  PetscReal s[6] = {0};

  for (PetscInt i = 0; i + 6 <= n; i += 6)
    for (int c = 0; c < 6; c++) s[c] += x[i + c] * x[i + c];
  for (PetscInt i = n - n % 6; i < n; i++) s[0] += x[i] * x[i];
  return PetscSqrtReal(s[0] + s[1] + s[2] + s[3] + s[4] + s[5]);
}

/* Sums of squares of x -= lambda y and of y over a piece of them. */
static void UpdatePiece(PetscInt n, PetscReal lambda, PetscReal *PETSC_RESTRICT x, const PetscReal *PETSC_RESTRICT y,
                        PetscReal sum[2])
{
  PetscReal s[6] = {0}, r[6] = {0};
  PetscInt i;

  for (i = 0; i + 6 <= n; i += 6)
    for (int c = 0; c < 6; c++) {
      x[i + c] -= lambda * y[i + c];
      s[c] += x[i + c] * x[i + c];
      r[c] += y[i + c] * y[i + c];
    }
  for (; i < n; i++) {
    x[i] -= lambda * y[i];
    s[0] += x[i] * x[i];
    r[0] += y[i] * y[i];
  }
  sum[0] = s[0] + s[1] + s[2] + s[3] + s[4] + s[5];
  sum[1] = r[0] + r[1] + r[2] + r[3] + r[4] + r[5];
}

/* x -= lambda y and both norms, in pieces whose sums are added in their order, whatever the threads. */
static void Update(Ancf ancf, PetscInt n, PetscReal lambda, PetscReal *x, const PetscReal *y, PetscReal *xnorm, PetscReal *ynorm)
{
  const PetscInt pieces = (n + ANCF_PIECE - 1) / ANCF_PIECE;
  PetscReal sum[2] = {0};

#pragma omp parallel for schedule(static) if (ancf->nlanebeams >= ANCF_PARALLEL)
  for (PetscInt k = 0; k < pieces; k++) {
    const PetscInt i = ANCF_PIECE * k;

    UpdatePiece(PetscMin(ANCF_PIECE, n - i), lambda, x + i, y + i, ancf->piece + 2 * k);
  }
  for (PetscInt k = 0; k < pieces; k++)
    for (int q = 0; q < 2; q++) sum[q] += ancf->piece[2 * k + q];
  *xnorm = PetscSqrtReal(sum[0]);
  *ynorm = PetscSqrtReal(sum[1]);
}

/*
  Line search of the default: full steps (times -snes_linesearch_damping). Bending first stretches the chord, so that the residual
  rises before it falls; a step that fails is reduced. The same as SNESLINESEARCHBASIC in one pass over the vectors.
*/
static PetscErrorCode AncfFullStep(SNESLineSearch search, void *ctx)
{
  PetscReal lambda, xnorm, ynorm, fnorm;
  PetscScalar *x;
  const PetscScalar *y;
  PetscInt n;
  Vec X, F, Y;
  SNES snes;
  Ancf ancf = (Ancf)ctx;

  PetscFunctionBegin;
  PetscCall(SNESLineSearchGetVecs(search, &X, &F, &Y, NULL, NULL));
  PetscCall(SNESLineSearchGetSNES(search, &snes));
  PetscCall(SNESLineSearchGetLambda(search, &lambda));
  PetscCall(VecGetLocalSize(X, &n));
  PetscCall(VecGetArray(X, &x));
  PetscCall(VecGetArrayRead(Y, &y));
  Update(ancf, n, lambda, x, y, &xnorm, &ynorm);
  PetscCall(VecRestoreArrayRead(Y, &y));
  PetscCall(VecRestoreArray(X, &x));
  ancf->stagenorm = -1;
  PetscCall(SNESComputeFunction(snes, X, F));
  PetscCall(SNESLineSearchSetReason(search, SNES_LINESEARCH_SUCCEEDED)); /* SNES itself looks for a NaN in the norm */
  fnorm = ancf->stagenorm;
  if (!(fnorm >= 0)) {
    PetscCall(VecGetArrayRead(F, &y));
    fnorm = AncfNorm(n, y);
    PetscCall(VecRestoreArrayRead(F, &y));
  }
  PetscCall(SNESLineSearchSetNorms(search, xnorm, fnorm, ynorm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfSetFullStep(Ancf ancf)
{
  SNESLineSearch search;
  SNES snes;

  PetscFunctionBegin;
  PetscCall(TSGetSNES(ancf->ts, &snes));
  PetscCall(SNESGetLineSearch(snes, &search));
#if PETSC_VERSION_LT(3, 21, 0)
  PetscCall(SNESLineSearchShellSetUserFunc(search, AncfFullStep, ancf));
#else
  PetscCall(SNESLineSearchShellSetApply(search, AncfFullStep, ancf));
#endif
  PetscFunctionReturn(PETSC_SUCCESS);
}
