/*
  ancfnetwork.c - matrices of beams with joints: no chains any more, hence AIJ and a sparse direct solver.

  Element matrices are transformed one by one, k -> S^T k S, where S replaces dependent coordinates by T e_i (ancfconstraint.c).
  The derivative of T itself is the geometric term sum lambda d2Phi/de2. Rows of dependent coordinates are diagonal, so that the
  matrix stays symmetric; terms with dT/dt in inertia forces are left to Newton's method.
*/
#include "ancfimpl.h"
#include "blocktri.h"

static PetscInt LocalIndex(const Ancf ancf, PetscInt i)
{
  const AncfJoint *j = &ancf->joints[ancf->jointof[i / 6]];
  const PetscInt k = ancf->localof[i / 6];

  if (i % 6 < 3) return 3 * k + i % 6;
  return j->type == ANCF_JOINT_RIGID ? 3 * (j->n + k) + i % 6 - 3 : -1;
}

/* Row of the joint whose dependent coordinate this is, or -1. */
static PetscInt DependentRow(const Ancf ancf, PetscInt i)
{
  PetscInt l;

  if (!ancf->jointof || ancf->jointof[i / 6] < 0) return -1;
  l = LocalIndex(ancf, i);
  for (PetscInt s = 0; s < ancf->joints[ancf->jointof[i / 6]].nrows && l >= 0; s++)
    if (ancf->joints[ancf->jointof[i / 6]].dep[s] == l) return s;
  return -1;
}

PetscBool AncfIsDependent(const Ancf ancf, PetscInt i)
{
  return DependentRow(ancf, i) >= 0 ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool IsFixed(const Ancf ancf, PetscInt i)
{
  return ancf->fixed[i / 6] & (i % 6 < 3 ? ANCF_FIX_POSITION : ANCF_FIX_GRADIENT) ? PETSC_TRUE : PETSC_FALSE;
}

/* Column of coordinate i in S, appended when new. */
static PetscInt Column(PetscInt i, PetscInt *n, PetscInt idx[])
{
  for (PetscInt k = 0; k < *n; k++)
    if (idx[k] == i) return k;
  idx[*n] = i;
  return (*n)++;
}

PetscErrorCode AncfNetworkAdd(Ancf ancf, Mat P, PetscInt n, const PetscInt coord[], const PetscReal k[], PetscInt row,
                              PetscInt col, PetscBool pattern)
{
  PetscInt most = n, m = 0, bs, *idx, *rows, *cols;
  PetscReal *S, *kS, *out;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < n; i++)
    if (ancf->jointof && ancf->jointof[coord[i] / 6] >= 0) most += ancf->joints[ancf->jointof[coord[i] / 6]].nloc;
  PetscCall(PetscCalloc6(most, &idx, most, &rows, most, &cols, (size_t)n * (size_t)most, &S, (size_t)n * (size_t)most, &kS,
                         (size_t)most * (size_t)most, &out));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt s = DependentRow(ancf, coord[i]);
    const AncfJoint *j = ancf->jointof && ancf->jointof[coord[i] / 6] >= 0 ? &ancf->joints[ancf->jointof[coord[i] / 6]] : NULL;

    if (s < 0 || pattern) S[i * most + Column(coord[i], &m, idx)] = 1;
    for (PetscInt c = 0; j && c < j->nloc && (s >= 0 || pattern); c++) {
      const PetscInt g = AncfJointCoordinate(j, c);

      if (pattern || (j->T[s * j->nloc + c] != 0 && !IsFixed(ancf, g)))
        S[i * most + Column(g, &m, idx)] += pattern ? 0 : j->T[s * j->nloc + c];
    }
  }
  for (PetscInt i = 0; i < n && !pattern; i++)
    for (PetscInt q = 0; q < n; q++)
      for (PetscInt c = 0; c < m && k[i * n + q] != 0; c++) kS[i * most + c] += k[i * n + q] * S[q * most + c];
  for (PetscInt i = 0; i < n && !pattern; i++)
    for (PetscInt r = 0; r < m; r++)
      for (PetscInt c = 0; c < m && S[i * most + r] != 0; c++) out[r * m + c] += S[i * most + r] * kS[i * most + c];
  PetscCall(MatGetBlockSize(P, &bs));
  for (PetscInt c = 0; c < m; c++) {
    rows[c] = bs * (idx[c] / 6) + row + idx[c] % 6;
    cols[c] = bs * (idx[c] / 6) + col + idx[c] % 6;
  }
  PetscCall(MatSetValues(P, m, rows, m, cols, out, ADD_VALUES));
  PetscCall(PetscFree6(idx, rows, cols, S, kS, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Element matrices, 12 x 12, of coordinates and, in the first-order form, of velocities, from this node on. */
PetscErrorCode AncfNetworkElement(Ancf ancf, Mat P, PetscInt node, const PetscReal k[144], const PetscReal m[144])
{
  PetscInt coord[12], bs;

  PetscFunctionBegin;
  PetscCall(MatGetBlockSize(P, &bs));
  for (int c = 0; c < 12; c++) coord[c] = 6 * node + c;
  PetscCall(AncfNetworkAdd(ancf, P, 12, coord, k, bs - 6, 0, PETSC_FALSE));
  if (bs == 12) PetscCall(AncfNetworkAdd(ancf, P, 12, coord, m, 6, 6, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forces of the joints turn with their nodes. */
PetscErrorCode AncfNetworkGeometric(Ancf ancf, Mat P)
{
  PetscInt bs;

  PetscFunctionBegin;
  PetscCall(MatGetBlockSize(P, &bs));
  for (PetscInt k = 0; k < ancf->njoints; k++) {
    AncfJoint *j = &ancf->joints[k];
    PetscInt *coord;
    PetscReal *H;

    if (j->linear) continue;
    PetscCall(PetscCalloc2(j->nloc, &coord, (size_t)j->nloc * (size_t)j->nloc, &H));
    AncfRowsEvaluate(j, j->x, NULL, j->phi, j->G, NULL, j->lambda, H);
    for (PetscInt c = 0; c < j->nloc; c++) coord[c] = AncfJointCoordinate(j, c);
    for (PetscInt r = 0; r < j->nloc; r++)
      for (PetscInt c = 0; c < j->nloc; c++)
        if (IsFixed(ancf, coord[r]) || IsFixed(ancf, coord[c])) H[r * j->nloc + c] = 0;
    PetscCall(AncfNetworkAdd(ancf, P, j->nloc, coord, H, bs - 6, 0, PETSC_FALSE));
    PetscCall(PetscFree2(coord, H));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Every place that the matrix may ever use. */
static PetscErrorCode Pattern(Ancf ancf, PetscInt bs, Mat P)
{
  PetscInt coord[12];

  PetscFunctionBegin;
  for (PetscInt b = 0; b < ancf->nbeams; b++)
    for (PetscInt k = 0; k < ancf->beams[b].spec.elements; k++) {
      for (PetscInt c = 0; c < 12; c++) coord[c] = 6 * (ancf->beams[b].node + k) + c;
      for (PetscInt o = 0; o < bs; o += 6) PetscCall(AncfNetworkAdd(ancf, P, 12, coord, NULL, bs - 6, o, PETSC_TRUE));
    }
  for (PetscInt i = 0; i < ancf->nnodes && bs == 12; i++)
    for (PetscInt c = 0; c < 6; c++) {
      PetscCall(MatSetValue(P, 12 * i + c, 12 * i + c, 0, ADD_VALUES));
      PetscCall(MatSetValue(P, 12 * i + c, 12 * i + 6 + c, 0, ADD_VALUES));
    }
  PetscCall(MatAssemblyBegin(P, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(P, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A direct solver that takes any pattern, unless the user asked for another: KLU where PETSc has it. */
static PetscErrorCode ChooseSolver(Ancf ancf, PC pc)
{
  char prefix[256], solver[64] = "";
  PetscBool given, ilu, chain, cholmod;

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%sancf_", ancf->prefix ? ancf->prefix : ""));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCBLOCKTRI, &chain));
  PetscCheck(!chain, ancf->comm, PETSC_ERR_ARG_INCOMP,
             "-ancf_pc_type blocktri eliminates single chains, but %" PetscInt_FMT
             " joints couple the beams; use lu (klu, umfpack) or cholesky (cholmod)",
             ancf->njoints);
  PetscCall(PetscOptionsHasName(NULL, prefix, "-pc_type", &given));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCILU, &ilu));
  if (given || !ilu) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscOptionsGetString(NULL, prefix, "-pc_factor_mat_solver_type", solver, sizeof(solver), &given));
  PetscCall(PetscStrcmp(solver, "cholmod", &cholmod));
  PetscCall(PCSetType(pc, cholmod ? PCCHOLESKY : PCLU));
#if defined(PETSC_HAVE_SUITESPARSE)
  if (!given) PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERKLU));
#endif
  if (ancf->fromoptions) PetscCall(PCSetFromOptions(pc));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Matrix of MATSEQAIJ with blocks of bs rows per node, and its solver; pc NULL: the matrix alone. */
PetscErrorCode AncfNetworkCreate(Ancf ancf, PetscInt bs, PC pc, Mat *J)
{
  const PetscInt n = bs * ancf->nnodes;
  Mat pre;

  PetscFunctionBegin;
  if (pc) PetscCall(ChooseSolver(ancf, pc));
  PetscCall(MatCreate(ancf->comm, &pre));
  PetscCall(MatSetSizes(pre, n, n, n, n));
  PetscCall(MatSetType(pre, MATPREALLOCATOR));
  PetscCall(MatSetBlockSize(pre, bs));
  PetscCall(MatSetUp(pre));
  PetscCall(Pattern(ancf, bs, pre));
  PetscCall(MatCreate(ancf->comm, J));
  PetscCall(MatSetSizes(*J, n, n, n, n));
  PetscCall(MatSetBlockSize(*J, bs));
  PetscCall(MatSetType(*J, MATSEQAIJ));
  PetscCall(MatPreallocatorPreallocate(pre, PETSC_TRUE, *J));
  PetscCall(MatDestroy(&pre));
  PetscCall(MatSetOption(*J, MAT_SYMMETRIC, bs == 6 ? PETSC_TRUE : PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}
