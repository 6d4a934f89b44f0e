/*
  ancfdae.c - constraints with Lagrange multipliers, the seed's alternative to elimination (Sect. 2.3):

    M a + C v + Q^e - Q^g - Q^a + G^T lambda = 0,    Phi(e, t) = 0,    G = dPhi/de,

  Phi: a row for each supported coordinate, e_i less its prescribed value, and the rows of the joints (ancfconstraint.c). This is
  a differential-algebraic equation of index 3. alpha2 takes it as it stands (Arnold, Bruels, Multibody System Dynamics 18 (2007):
  second order), theta likewise, and cn, bdf and beuler, whose stages are the ends of steps. Others lose their order where
  supports are driven: arkimex l2 to velocities off by more than the step's error, alpha and rosw to velocities that do not
  settle; multipliers have no history that motion depends on: a step finds those of its own. Positions keep the constraints to
  Newton's tolerance in the stages: with cn, bdf, beuler and rows that are linear at the ends of steps too, with alpha2, theta and
  corners these are off by dt^2/8 of the row's curvature. Velocities follow to the order of the step. Nothing adds up: each step
  meets the constraints anew.

  The multipliers come after the coordinates, filled up to whole blocks. Both Phi and lambda are scaled with s, an axial
  stiffness, so that one residual norm serves all rows: s Phi = 0, forces s G^T lambda.
*/
#include "ancfimpl.h"

/* While elimination looks away: every coordinate is free. */
typedef struct {
  unsigned char *fixed;
  PetscInt njoints, *jointof;
} Hidden;

static Hidden Free(Ancf ancf)
{
  const Hidden h = {ancf->fixed, ancf->njoints, ancf->jointof};

  ancf->allfixed = ancf->fixed;
  ancf->fixed = ancf->nofix;
  ancf->njoints = 0;
  ancf->jointof = NULL;
  return h;
}

static void Bind(Ancf ancf, Hidden h)
{
  ancf->fixed = h.fixed;
  ancf->allfixed = NULL;
  ancf->njoints = h.njoints;
  ancf->jointof = h.jointof;
}

/* Room for multipliers before the number of joints' rows is known, 6 a node at most and a block of 12. */
PetscInt AncfDaeRoom(const Ancf ancf)
{
  PetscInt n = 2 * ancf->nbeams + ancf->nsupports;

  if (ancf->constraints != ANCF_CONSTRAINTS_MULTIPLIERS) return 0;
  for (PetscInt k = 0; k < ancf->njoints; k++) n += ancf->joints[k].n;
  return 6 * n + 12;
}

/* Rows, once the form is known. */
PetscErrorCode AncfDaeSetUp(Ancf ancf)
{
  const PetscInt bs = ancf->form == ANCF_FORM_SECOND ? 6 : 12;
  PetscInt n = 0;
  PetscBool fit;
  TSType type;

  PetscFunctionBegin;
  if (ancf->constraints != ANCF_CONSTRAINTS_MULTIPLIERS) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TSGetType(ancf->ts, &type));
  PetscCall(PetscObjectTypeCompareAny((PetscObject)ancf->ts, &fit, TSALPHA2, TSTHETA, TSCN, TSBDF, TSBEULER, ""));
  PetscCheck(
      fit, ancf->comm, PETSC_ERR_ARG_INCOMP,
      "-ancf_constraints multipliers makes a differential-algebraic equation, which -ancf_ts_type %s does not solve; use one "
      "of: alpha2 theta cn bdf beuler",
      type);
  PetscCall(PetscCalloc2(ancf->nnodes, &ancf->nofix, 6 * (size_t)ancf->nnodes, &ancf->heldrow));
  for (PetscInt i = 0; i < 6 * ancf->nnodes; i++)
    if (ancf->fixed[i / 6] & (i % 6 < 3 ? ANCF_FIX_POSITION : ANCF_FIX_GRADIENT)) ancf->heldrow[n++] = i;
  ancf->nheld = n;
  for (PetscInt k = 0; k < ancf->njoints; k++) n += ancf->joints[k].nrows;
  ancf->nrows = n;
  ancf->nmult = bs * ((n + bs - 1) / bs);
  ancf->rowscale = 0;
  for (PetscInt b = 0; b < ancf->nbeams; b++) ancf->rowscale = PetscMax(ancf->rowscale, ancf->beams[b].EA / ancf->beams[b].l);
  ancf->exact = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfDaeDestroy(Ancf ancf)
{
  PetscFunctionBegin;
  if (ancf->nofix) PetscCall(PetscFree2(ancf->nofix, ancf->heldrow));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Local coordinates of a joint, all as the integrator has them. */
static void JointLocal(AncfJoint *j, const PetscReal *e, PetscInt stride)
{
  for (PetscInt c = 0; c < j->nloc; c++) {
    const PetscInt i = AncfJointCoordinate(j, c);

    j->x[c] = e[(i / 6) * stride + i % 6];
  }
}

/* Residual f of the equations of motion, nodes x 6, and g of the constraints, for the multipliers lambda. */
PetscErrorCode AncfDaeResidual(Ancf ancf, const PetscReal *e, const PetscReal *v, const PetscReal *a, PetscInt stride,
                               const PetscReal *lambda, PetscReal *f, PetscInt fstride, PetscReal *g)
{
  const PetscReal s = ancf->rowscale;
  const Hidden h = Free(ancf);
  PetscInt row = ancf->nheld;

  PetscFunctionBegin;
  PetscCall(AncfFreeResidual(ancf, e, v, a, stride, f, fstride));
  Bind(ancf, h);
  for (PetscInt k = 0; k < ancf->njoints; k++) {
    AncfJoint *j = &ancf->joints[k];

    JointLocal(j, e, stride);
    AncfRowsEvaluate(j, j->x, NULL, j->phi, j->G, NULL, NULL, NULL);
    for (PetscInt r = 0; r < j->nrows; r++, row++) {
      g[row] = s * j->phi[r];
      for (PetscInt c = 0; c < j->nloc; c++) {
        const PetscInt i = AncfJointCoordinate(j, c);

        f[(i / 6) * fstride + i % 6] += s * j->G[r * j->nloc + c] * lambda[row];
      }
    }
  }
  for (PetscInt i = 0; i < 6 * ancf->nnodes && ancf->stage; i++) ancf->stage[i] = f[(i / 6) * fstride + i % 6];
  for (PetscInt r = 0; r < ancf->nheld; r++) {
    const PetscInt i = ancf->heldrow[r];

    g[r] = s * (e[(i / 6) * stride + i % 6] - ancf->rest[i]);
    f[(i / 6) * fstride + i % 6] += s * lambda[r];
  }
  for (PetscInt r = ancf->nrows; r < ancf->nmult; r++) g[r] = lambda[r];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Entries between rows and coordinates, and the joints' geometric terms; lambda NULL: all places, zeros. */
static PetscErrorCode Couplings(Ancf ancf, PetscInt bs, const PetscReal *e, PetscInt stride, const PetscReal *lambda, Mat P)
{
  const PetscInt first = bs * ancf->nnodes;
  const PetscReal s = lambda ? ancf->rowscale : 0;
  PetscInt row = ancf->nheld;

  PetscFunctionBegin;
  for (PetscInt r = 0; r < ancf->nmult; r++)
    PetscCall(MatSetValue(P, first + r, first + r, lambda && r >= ancf->nrows ? 1 : 0, ADD_VALUES));
  for (PetscInt r = 0; r < ancf->nheld; r++) {
    const PetscInt i = ancf->heldrow[r], at = bs * (i / 6) + i % 6;

    PetscCall(MatSetValue(P, first + r, at, s, ADD_VALUES));
    PetscCall(MatSetValue(P, at + bs - 6, first + r, s, ADD_VALUES));
  }
  for (PetscInt k = 0; k < ancf->njoints; row += ancf->joints[k++].nrows) {
    AncfJoint *j = &ancf->joints[k];
    PetscReal *H, *scaled;
    PetscInt *at;

    PetscCall(PetscCalloc3((size_t)j->nloc * (size_t)j->nloc, &H, j->nrows, &scaled, j->nloc, &at));
    for (PetscInt r = 0; r < j->nrows && lambda; r++) scaled[r] = s * lambda[row + r];
    if (lambda) {
      JointLocal(j, e, stride);
      AncfRowsEvaluate(j, j->x, NULL, j->phi, j->G, NULL, scaled, H);
    }
    for (PetscInt c = 0; c < j->nloc; c++) {
      const PetscInt i = AncfJointCoordinate(j, c);

      at[c] = bs * (i / 6) + i % 6;
    }
    for (PetscInt c = 0; c < j->nloc; c++) {
      for (PetscInt d = 0; d < j->nloc && !j->linear; d++)
        PetscCall(MatSetValue(P, at[c] + bs - 6, at[d], H[c * j->nloc + d], ADD_VALUES));
      for (PetscInt r = 0; r < j->nrows; r++) {
        PetscCall(MatSetValue(P, first + row + r, at[c], lambda ? s * j->G[r * j->nloc + c] : 0, ADD_VALUES));
        PetscCall(MatSetValue(P, at[c] + bs - 6, first + row + r, lambda ? s * j->G[r * j->nloc + c] : 0, ADD_VALUES));
      }
    }
    PetscCall(PetscFree3(H, scaled, at));
  }
  PetscCall(MatAssemblyBegin(P, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(P, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* As AncfAssemble(), with the constraints. */
PetscErrorCode AncfDaeAssemble(Ancf ancf, const PetscReal *e, const PetscReal *v, PetscInt stride, const PetscReal *lambda,
                               PetscReal shift, PetscReal gv, PetscReal diag, Mat J, Mat P)
{
  const Hidden h = Free(ancf);
  PetscInt bs;

  PetscFunctionBegin;
  PetscCall(AncfAssemble(ancf, e, v, stride, shift, gv, diag, J, P));
  Bind(ancf, h);
  PetscCall(MatGetBlockSize(P, &bs));
  PetscCall(Couplings(ancf, bs, e, stride, lambda, P));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* LU that exchanges rows, unless the user asked for another: the rows of constraints have no diagonal. */
static PetscErrorCode ChooseSolver(Ancf ancf, PC pc)
{
  char prefix[256];
  const char *type;
  PetscBool given, bad;

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%sancf_", ancf->prefix ? ancf->prefix : ""));
  PetscCall(PCGetType(pc, &type));
  PetscCall(PetscOptionsHasName(NULL, prefix, "-pc_type", &given));
  PetscCall(
      PetscObjectTypeCompareAny((PetscObject)pc, &bad, PCILU, PCCHOLESKY, PCICC, PCJACOBI, PCBJACOBI, PCSOR, "blocktri", ""));
  PetscCheck(!given || !bad, ancf->comm, PETSC_ERR_ARG_INCOMP,
             "-ancf_pc_type %s cannot take the zero diagonal of -ancf_constraints multipliers; use lu", type);
  PetscCall(PetscOptionsHasName(NULL, prefix, "-pc_factor_mat_solver_type", &bad));
  PetscCall(PCSetType(pc, PCLU));
#if defined(PETSC_HAVE_SUITESPARSE)
  if (!bad) PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERKLU));
#else
  PetscCall(PCFactorSetMatOrderingType(pc, MATORDERINGNATURAL)); /* coordinates first fill the rows of constraints */
#endif
  if (ancf->fromoptions) PetscCall(PCSetFromOptions(pc));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfDaeCreateMatrix(Ancf ancf, PetscInt bs, PC pc, Mat *J)
{
  const PetscInt n = bs * ancf->nnodes + ancf->nmult;
  PetscReal zero[576] = {0};
  Mat pre;

  PetscFunctionBegin;
  PetscCall(ChooseSolver(ancf, pc));
  PetscCall(MatCreate(ancf->comm, &pre));
  PetscCall(MatSetSizes(pre, n, n, n, n));
  PetscCall(MatSetType(pre, MATPREALLOCATOR));
  PetscCall(MatSetBlockSize(pre, bs));
  PetscCall(MatSetUp(pre));
  for (PetscInt b = 0; b < ancf->nbeams; b++)
    for (PetscInt k = 0; k < ancf->beams[b].spec.elements; k++) {
      const PetscInt idx[2] = {ancf->beams[b].node + k, ancf->beams[b].node + k + 1};

      PetscCall(MatSetValuesBlocked(pre, 2, idx, 2, idx, zero, ADD_VALUES));
    }
  PetscCall(Couplings(ancf, bs, NULL, 0, NULL, pre));
  PetscCall(MatCreate(ancf->comm, J));
  PetscCall(MatSetSizes(*J, n, n, n, n));
  PetscCall(MatSetBlockSize(*J, bs));
  PetscCall(MatSetType(*J, MATSEQAIJ));
  PetscCall(MatPreallocatorPreallocate(pre, PETSC_TRUE, *J));
  PetscCall(MatDestroy(&pre));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After a step: what elimination needs to report accelerations follows; the state stays the integrator's. */
PetscErrorCode AncfDaePost(Ancf ancf)
{
  const PetscInt n = 6 * ancf->nnodes;
  PetscReal *keep;

  PetscFunctionBegin;
  if (!ancf->njoints) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(2 * (size_t)n, &keep));
  PetscCall(PetscArraycpy(keep, ancf->e, n));
  PetscCall(PetscArraycpy(keep + n, ancf->v, n));
  PetscCall(AncfJointSync(ancf, PETSC_FALSE, NULL));
  PetscCall(PetscArraycpy(ancf->e, keep, n));
  PetscCall(PetscArraycpy(ancf->v, keep + n, n));
  PetscCall(PetscFree(keep));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfSetConstraints(Ancf ancf, AncfConstraints type)
{
  PetscFunctionBegin;
  PetscCheck(!ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "-ancf_constraints cannot change after AncfSetUp()");
  PetscCheck(type == ANCF_CONSTRAINTS_ELIMINATE || type == ANCF_CONSTRAINTS_MULTIPLIERS, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "-ancf_constraints %d must be eliminate or multipliers", (int)type);
  ancf->constraints = type;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfGetConstraintError(Ancf ancf, PetscReal *position, PetscReal *velocity)
{
  PetscReal p = 0, q = 0;

  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfGetConstraintError: call AncfSetUp() first");
  AncfMove(ancf, ancf->t);
  for (PetscInt i = 0; i < 6 * ancf->nnodes; i++) {
    if (!(ancf->fixed[i / 6] & (i % 6 < 3 ? ANCF_FIX_POSITION : ANCF_FIX_GRADIENT))) continue;
    p = PetscMax(p, PetscAbsReal(ancf->e[i] - ancf->rest[i]));
    q = PetscMax(q, PetscAbsReal(ancf->v[i] - (ancf->restv ? ancf->restv[i] : 0)));
  }
  for (PetscInt k = 0; k < ancf->njoints; k++) {
    AncfJoint *j = &ancf->joints[k];

    JointLocal(j, ancf->v, 6);
    PetscCall(PetscArraycpy(j->v, j->x, j->nloc));
    JointLocal(j, ancf->e, 6);
    AncfRowsEvaluate(j, j->x, NULL, j->phi, j->G, NULL, NULL, NULL);
    for (PetscInt r = 0; r < j->nrows; r++) {
      PetscReal rate = 0;

      for (PetscInt c = 0; c < j->nloc; c++) rate += j->G[r * j->nloc + c] * j->v[c];
      p = PetscMax(p, PetscAbsReal(j->phi[r]));
      q = PetscMax(q, PetscAbsReal(rate));
    }
  }
  if (position) *position = p;
  if (velocity) *velocity = q;
  PetscFunctionReturn(PETSC_SUCCESS);
}
