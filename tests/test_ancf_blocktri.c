/* test_ancf_blocktri.c - PCBLOCKTRI against dense LU on random chains of unequal length, several block sizes and matrix types. */
#include "ancf_common.h"
#include "blocktri.h"
#include <petscksp.h>

/* Chains of 1..7 block rows, unsymmetric blocks, diagonally dominant so that elimination without pivoting is stable. */
static PetscErrorCode RandomChains(PetscInt bs, MatType type, Mat *A)
{
  const PetscInt nchains = 21;
  PetscInt rows = 0, n;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < nchains; c++) rows += 1 + (5 * c) % 7;
  n = bs * rows;
  PetscCall(MatCreate(PETSC_COMM_SELF, A));
  PetscCall(MatSetSizes(*A, n, n, n, n));
  PetscCall(MatSetBlockSize(*A, bs));
  PetscCall(MatSetType(*A, type));
  PetscCall(MatSetUp(*A));
  PetscCall(MatSetOption(*A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  rows = 0;
  for (PetscInt c = 0; c < nchains; c++) {
    const PetscInt length = 1 + (5 * c) % 7;

    for (PetscInt j = 0; j < length; j++, rows++)
      for (PetscInt k = PetscMax(0, j - 1); k <= PetscMin(length - 1, j + 1); k++)
        for (PetscInt r = 0; r < bs; r++)
          for (PetscInt q = 0; q < bs; q++)
            PetscCall(MatSetValue(*A, bs * rows + r, bs * (rows + k - j) + q, Random() + (k == j && r == q ? 3 * bs : 0),
                                  INSERT_VALUES));
  }
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestSolve(PetscInt bs, MatType type)
{
  Mat A;
  Vec b, x, r;
  KSP ksp;
  PC pc;
  PetscReal norm, ref;
  PetscInt n;

  PetscFunctionBegin;
  PetscCall(RandomChains(bs, type, &A));
  PetscCall(MatCreateVecs(A, &x, &b));
  PetscCall(VecDuplicate(b, &r));
  PetscCall(KSPCreate(PETSC_COMM_SELF, &ksp));
  PetscCall(KSPSetOperators(ksp, A, A));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCBLOCKTRI));
  for (int round = 0; round < 2; round++) { /* the second time with other values */
    PetscCall(VecGetSize(b, &n));
    for (PetscInt i = 0; i < n; i++) PetscCall(VecSetValue(b, i, Random(), INSERT_VALUES));
    PetscCall(KSPSolve(ksp, b, x));
    PetscCall(MatMult(A, x, r));
    PetscCall(VecAXPY(r, -1, b));
    PetscCall(VecNorm(r, NORM_INFINITY, &norm));
    PetscCall(VecNorm(b, NORM_INFINITY, &ref));
    printf("%-8s block size %2d: |A x - b| / |b| = %.1e\n", type, (int)bs, norm / ref);
    TEST(norm <= 1e-13 * ref, "residual %g", (double)(norm / ref)); /* n eps times a condition number of about 2 */
    PetscCall(MatScale(A, 1.7));
    PetscCall(MatShift(A, 0.3));
  }
  PetscCall(KSPDestroy(&ksp));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&r));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestRefusal(void)
{
  Mat A;
  PC pc;

  PetscFunctionBegin;
  PetscCall(RandomChains(6, MATSEQAIJ, &A));
  PetscCall(MatSetValue(A, 0, 40, 1, INSERT_VALUES));
  PetscCall(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  PetscCall(PCCreate(PETSC_COMM_SELF, &pc));
  PetscCall(PCSetOperators(pc, A, A));
  PetscCall(PCSetType(pc, PCBLOCKTRI));
  TEST_ERROR(PCSetUp(pc), PETSC_ERR_ARG_WRONG, "block row 0 couples to 6");
  PetscCall(PCDestroy(&pc));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PCBlockTriRegister());
  PetscCall(TestSolve(6, MATSEQAIJ));
  PetscCall(TestSolve(6, MATSEQBAIJ));
  PetscCall(TestSolve(12, MATSEQBAIJ));
  PetscCall(TestSolve(3, MATSEQAIJ));
  PetscCall(TestSolve(1, MATSEQAIJ));
  PetscCall(TestRefusal());
  PetscCall(PetscFinalize());
  return test_report();
}
