/*
  rigidconstraint.c - joined bodies advance together: RATTLE (Andersen, J. Comput. Phys. 52, 1983) around the kick - free
  flight - kick of rigidstep.c, in the rotation variables of that file.

  With D(q) the Jacobian of all rows g(q), W = M^-1 D^T and h the step:
    1. p = p_n + h/2 (F + D(q_n)^T lambda),  q_{n+1} = free flight of (q_n, p) over h,  lambda such that
         hard rows:  g(q_{n+1}) = 0
         soft rows:  lambda = -k (g_n + g_{n+1})/2 - c (g_{n+1} - g_n)/h
    2. p_{n+1} = p + h/2 (F + D(q_{n+1})^T lambda_soft + D(q_{n+1})^T mu),  mu such that D_hard(q_{n+1}) v_{n+1} = 0
  Second order and symmetric (without dampers and yield). Springs and dampers act by their mean over the step (average
  acceleration rule), hence stiff ones do not limit h. Constraints are met to round-off at every step: nothing drifts.

  Step 1 is solved by PETSc's SNES (options prefix -rigid_joint_): Newton with the matrix  D W + 2/(h^2 s), s = k/2 + c/h on
  soft rows, at q_n: symmetric positive definite, sparse as the graph of the joints, factored once a step. The test of
  convergence is ours, as rows are met to the round-off of different lengths. A relative shift of 1e-11 of the diagonal lets
  redundant rows pass; iterations remove its effect.

  Yield: a soft row whose |lambda| exceeds the yield moment is held at it and its rest angle moves by the plastic part.
*/
#include "rigidsystem.h"

#define ASSEMBLED 1.e-6 /* placement at the start of a step: of the lengths that a row is the difference of; 1 for angles */

PetscErrorCode RigidSystemHasBody(Rigid rigid, PetscInt i, PetscBool *has)
{
  PetscFunctionBegin;
  *has = rigid->system && rigid->system->start[i + 1] > rigid->system->start[i] ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists of rows by body. */
static PetscErrorCode SystemLists(Rigid rigid)
{
  RigidSystem s = rigid->system;
  PetscInt *fill;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1((size_t)(rigid->n + 2), &s->start));
  PetscCall(PetscMalloc1(2 * (size_t)s->n, &s->entry));
  for (PetscInt r = 0; r < s->n; r++)
    for (int e = 0; e < 2; e++)
      if (RigidRowEnd(rigid, r, e) != RIGID_GROUND) s->start[RigidRowEnd(rigid, r, e) + 1]++;
  for (PetscInt i = 0; i < rigid->n; i++) s->start[i + 1] += s->start[i];
  PetscCall(PetscMalloc1((size_t)rigid->n, &fill));
  PetscCall(PetscArraycpy(fill, s->start, rigid->n));
  for (PetscInt r = 0; r < s->n; r++)
    for (int e = 0; e < 2; e++)
      if (RigidRowEnd(rigid, r, e) != RIGID_GROUND) s->entry[fill[RigidRowEnd(rigid, r, e)]++] = 2 * r + e;
  PetscCall(PetscFree(fill));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SystemMatrix(Rigid rigid)
{
  RigidSystem s = rigid->system;
  PetscInt *nnz, most = 1;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1((size_t)s->n, &nnz));
  for (PetscInt r = 0; r < s->n; r++) {
    nnz[r] = 1;
    for (int e = 0; e < 2; e++) {
      const PetscInt i = RigidRowEnd(rigid, r, e);
      if (i != RIGID_GROUND) nnz[r] += s->start[i + 1] - s->start[i];
    }
    most = PetscMax(most, nnz[r]);
    nnz[r] = PetscMin(nnz[r], s->n);
  }
  PetscCall(PetscMalloc1((size_t)most, &s->value));
  PetscCall(PetscMalloc1((size_t)most, &s->column));
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, s->n, s->n, 0, nnz, &s->A));
  PetscCall(PetscFree(nnz));
  PetscCall(MatSetOption(s->A, MAT_SPD, PETSC_TRUE));
  PetscCall(MatCreateVecs(s->A, &s->x, &s->b));
  PetscCall(RigidPositionCreate(rigid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidSystemCreate(Rigid rigid)
{
  RigidSystem s;

  PetscFunctionBegin;
  PetscCall(PetscNew(&rigid->system));
  s = rigid->system;
  for (PetscInt j = 0; j < rigid->njoints; j++) {
    rigid->joint[j].first = s->n;
    s->n += rigid->joint[j].nrows;
  }
  PetscCall(PetscMalloc4((size_t)s->n, &s->joint, (size_t)s->n, &s->local, (size_t)s->n, &s->row0, (size_t)s->n, &s->row1));
  PetscCall(PetscMalloc1((size_t)s->n, &s->drive));
  PetscCall(PetscMalloc5(12 * (size_t)s->n, &s->W, (size_t)s->n, &s->lambda, (size_t)s->n, &s->res, (size_t)s->n, &s->length,
                         (size_t)s->n, &s->active));
  PetscCall(PetscMalloc2(6 * (size_t)rigid->n, &s->wrench, (size_t)rigid->n, &s->saved));
  for (PetscInt j = 0; j < rigid->njoints; j++)
    for (PetscInt k = 0; k < rigid->joint[j].nrows; k++) {
      s->joint[rigid->joint[j].first + k] = j;
      s->local[rigid->joint[j].first + k] = k;
    }
  PetscCall(SystemLists(rigid));
  PetscCall(SystemMatrix(rigid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidSystemDestroy(Rigid rigid)
{
  RigidSystem s = rigid->system;

  PetscFunctionBegin;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree4(s->joint, s->local, s->row0, s->row1));
  PetscCall(PetscFree5(s->W, s->lambda, s->res, s->length, s->active));
  PetscCall(PetscFree2(s->wrench, s->saved));
  PetscCall(PetscFree(s->drive));
  PetscCall(PetscFree(s->start));
  PetscCall(PetscFree(s->entry));
  PetscCall(PetscFree(s->value));
  PetscCall(PetscFree(s->column));
  PetscCall(MatDestroy(&s->A));
  PetscCall(VecDestroy(&s->x));
  PetscCall(VecDestroy(&s->b));
  PetscCall(SNESDestroy(&s->snes));
  PetscCall(PetscFree(rigid->system));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void RigidSystemRows(Rigid rigid, RigidRow *row)
{
  for (PetscInt j = 0; j < rigid->njoints; j++) RigidJointRows(rigid, &rigid->joint[j], row + rigid->joint[j].first);
}

/* Is the row one of translation (else of angles), and what lengths it is the difference of, for its round-off. */
static void SystemLengths(Rigid rigid)
{
  RigidSystem s = rigid->system;
  for (PetscInt r = 0; r < s->n; r++) {
    const RigidJoint *j = &rigid->joint[s->joint[r]];
    const PetscBool point = Vec3Norm(s->row0[r].Ja) > 0. ? PETSC_TRUE : PETSC_FALSE;
    s->length[r] = 1.;
    if (!point) continue;
    s->length[r] = Vec3Norm(j->ra) + Vec3Norm(j->rb);
    for (int e = 0; e < 2; e++) {
      const PetscInt i = RigidRowEnd(rigid, r, e);
      if (i != RIGID_GROUND) s->length[r] += Vec3Norm(rigid->body[i].X);
    }
  }
}

/* D W of the active rows plus the compliance of soft ones (stage 1: h > 0) at the present placement; unit rows for the others. */
PetscErrorCode RigidSystemAssemble(Rigid rigid, const RigidRow *row, PetscReal h)
{
  RigidSystem s = rigid->system;

  PetscFunctionBegin;
  for (PetscInt r = 0; r < s->n; r++) {
    const RigidJoint *j = &rigid->joint[s->joint[r]];
    PetscReal diag = 0.;
    for (int e = 0; e < 2; e++) {
      const PetscReal *J = e ? row[r].Jb : row[r].Ja;
      PetscReal *W = s->W + 12 * r + 6 * e;
      const PetscInt i = RigidRowEnd(rigid, r, e);
      for (int k = 0; k < 6; k++) W[k] = 0.;
      if (i != RIGID_GROUND) RigidBodyMobility(&rigid->body[i], J, W);
      for (int k = 0; k < 6; k++) diag += J[k] * W[k];
    }
    if (j->hard[s->local[r]] && diag == 0.) s->active[r] = PETSC_FALSE; /* neither end can move this way */
  }
  PetscCall(MatZeroEntries(s->A));
  for (PetscInt r = 0; r < s->n; r++) {
    const RigidJoint *j = &rigid->joint[s->joint[r]];
    PetscInt n = 0;
    PetscReal diag = 0.;
    for (int e = 0; e < 2; e++) {
      const PetscInt i = RigidRowEnd(rigid, r, e);
      const PetscReal *J = e ? row[r].Jb : row[r].Ja;
      for (PetscInt p = i == RIGID_GROUND ? 0 : s->start[i]; i != RIGID_GROUND && p < s->start[i + 1]; p++) {
        const PetscReal *W = s->W + 6 * s->entry[p];
        s->column[n] = s->entry[p] / 2;
        PetscReal dot = 0.;
        if (s->active[r] && s->active[s->column[n]])
          for (int k = 0; k < 6; k++) dot += J[k] * W[k];
        if (s->column[n] == r) diag += dot;
        s->value[n++] = dot;
      }
    }
    s->column[n] = r;
    s->value[n] = s->active[r] ? 1.e-11 * diag : 1.;
    if (s->active[r] && !j->hard[s->local[r]]) s->value[n] += 2. / (h * h * (.5 * j->k[s->local[r]] + j->c[s->local[r]] / h));
    n++;
    PetscCall(MatSetValues(s->A, 1, &r, n, s->column, s->value, ADD_VALUES));
  }
  PetscCall(MatAssemblyBegin(s->A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(s->A, MAT_FINAL_ASSEMBLY));
  PetscCall(KSPSetOperators(s->ksp, s->A, s->A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y += factor A^-1 res on the active rows. */
static PetscErrorCode SystemSolve(Rigid rigid, PetscReal factor, PetscReal y[])
{
  RigidSystem s = rigid->system;
  PetscScalar *b;
  const PetscScalar *x;
  KSPConvergedReason reason;

  PetscFunctionBegin;
  PetscCall(VecGetArrayWrite(s->b, &b));
  for (PetscInt r = 0; r < s->n; r++) b[r] = s->active[r] ? s->res[r] : 0.;
  PetscCall(VecRestoreArrayWrite(s->b, &b));
  PetscCall(KSPSolve(s->ksp, s->b, s->x));
  PetscCall(KSPGetConvergedReason(s->ksp, &reason));
  PetscCheck(reason > 0, rigid->comm, PETSC_ERR_NOT_CONVERGED,
             "Rigid joints: the linear system at t = %g s cannot be solved (%s)", (double)rigid->t, KSPConvergedReasons[reason]);
  PetscCall(VecGetArrayRead(s->x, &x));
  for (PetscInt r = 0; r < s->n; r++)
    if (s->active[r]) y[r] += factor * PetscRealPart(x[r]);
  PetscCall(VecRestoreArrayRead(s->x, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* wrench = D^T y, over the rows of one kind: hard (1), soft (0), both (-1). */
void RigidSystemWrench(Rigid rigid, const RigidRow *row, const PetscReal y[], int kind)
{
  RigidSystem s = rigid->system;
  for (PetscInt i = 0; i < 6 * rigid->n; i++) s->wrench[i] = 0.;
  for (PetscInt r = 0; r < s->n; r++) {
    if (kind >= 0 && (int)rigid->joint[s->joint[r]].hard[s->local[r]] != kind) continue;
    for (int e = 0; e < 2; e++) {
      const PetscInt i = RigidRowEnd(rigid, r, e);
      if (i == RIGID_GROUND) continue;
      for (int k = 0; k < 6; k++) s->wrench[6 * i + k] += y[r] * (e ? row[r].Jb[k] : row[r].Ja[k]);
    }
  }
}

/* Kick all free bodies of the system by the wrench. */
void RigidSystemKick(Rigid rigid, PetscReal h)
{
  RigidSystem s = rigid->system;
  for (PetscInt i = 0; i < rigid->n; i++) {
    if (s->start[i + 1] == s->start[i] || rigid->body[i].spec.motion != RIGID_FREE) continue;
    RigidBodyKick(&rigid->body[i], s->wrench + 6 * i, s->wrench + 6 * i + 3, h);
  }
}

/* Angular impulse of the wrenches over h; the bodies are where they are now, or where they were when saved. */
static void AuditTurn(Rigid rigid, const RigidBody *saved, PetscReal h)
{
  RigidSystem s = rigid->system;
  for (PetscInt i = 0; i < rigid->n; i++) {
    const PetscReal *w = s->wrench + 6 * i;
    PetscReal x[3];
    if (s->start[i + 1] == s->start[i] || rigid->body[i].spec.motion != RIGID_FREE) continue;
    Vec3Cross(saved ? saved[i].X : rigid->body[i].X, w, x);
    for (int k = 0; k < 3; k++) rigid->ledger.turn[k] += h * (x[k] + w[3 + k]);
  }
}

/* Velocity of a row; of the ends that are not free alone, when told so. */
static PetscReal RowVelocity(Rigid rigid, const RigidRow *row, PetscInt r, PetscBool driven)
{
  PetscReal v = 0.;
  for (int e = 0; e < 2; e++) {
    const PetscInt i = RigidRowEnd(rigid, r, e);
    const PetscReal *J = e ? row->Jb : row->Ja;
    PetscReal w[3];
    if (i == RIGID_GROUND || (driven && rigid->body[i].spec.motion == RIGID_FREE)) continue;
    RigidBodyOmega(&rigid->body[i], rigid->body[i].q, w);
    v += Vec3Dot(J, rigid->body[i].V) + Vec3Dot(J + 3, w);
  }
  return v;
}

static void ActivateRows(Rigid rigid, PetscBool soft)
{
  RigidSystem s = rigid->system;
  for (PetscInt r = 0; r < s->n; r++) {
    const RigidJoint *j = &rigid->joint[s->joint[r]];
    const PetscInt l = s->local[r];
    s->active[r] = j->broken ? PETSC_FALSE : (j->hard[l] ? PETSC_TRUE : (PetscBool)(soft && (j->k[l] > 0. || j->c[l] > 0.)));
  }
}

/* Work of ends that are not free, and angular impulses, of the rows of one kind (hard 1, soft 0) over h. */
static void AuditRows(Rigid rigid, const RigidRow *row, int kind, PetscReal h)
{
  RigidSystem s = rigid->system;
  for (PetscInt r = 0; r < s->n; r++) {
    if ((int)rigid->joint[s->joint[r]].hard[s->local[r]] == kind)
      rigid->ledger.driven -= h * s->lambda[r] * RowVelocity(rigid, &row[r], r, PETSC_TRUE);
  }
  AuditTurn(rigid, NULL, h);
}

/* Hard rows of the velocity, at the present placement whose rows are given. Three corrections remove the diagonal shift's effect.
 */
static PetscErrorCode ProjectVelocity(Rigid rigid, const RigidRow *row)
{
  RigidSystem s = rigid->system;

  PetscFunctionBegin;
  ActivateRows(rigid, PETSC_FALSE);
  PetscCall(RigidSystemAssemble(rigid, row, 0.));
  for (int it = 0; it < 3; it++) {
    for (PetscInt r = 0; r < s->n; r++) {
      s->res[r] = s->active[r] ? RowVelocity(rigid, &row[r], r, PETSC_FALSE) : 0.;
      s->lambda[r] = 0.;
    }
    PetscCall(SystemSolve(rigid, -1., s->lambda));
    RigidSystemWrench(rigid, row, s->lambda, 1);
    RigidSystemKick(rigid, 1.);
    AuditRows(rigid, row, 1, 1.);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The initial velocities are moved to the nearest ones (in kinetic energy) that the joints allow. */
PetscErrorCode RigidSystemProjectVelocity(Rigid rigid)
{
  PetscFunctionBegin;
  RigidSystemRows(rigid, rigid->system->row0);
  PetscCall(ProjectVelocity(rigid, rigid->system->row0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckAssembled(Rigid rigid)
{
  RigidSystem s = rigid->system;

  PetscFunctionBegin;
  for (PetscInt r = 0; r < s->n; r++) {
    const RigidJoint *j = &rigid->joint[s->joint[r]];
    PetscCheck(!j->hard[s->local[r]] || j->broken || PetscAbsReal(s->row0[r].g) <= ASSEMBLED * s->length[r], rigid->comm,
               PETSC_ERR_ARG_INCOMP,
               "Rigid joint %" PetscInt_FMT " (%s of bodies %" PetscInt_FMT " and %" PetscInt_FMT
               ") is not assembled at t = %g s: its ends are apart by %g",
               s->joint[r], RigidJointName(j->spec.type), j->spec.a, j->spec.b, (double)rigid->t,
               (double)PetscAbsReal(s->row0[r].g));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Holds rows beyond yield at the yield moment; *changed tells whether there was a new one. */
static void YieldRows(Rigid rigid, PetscBool *changed)
{
  RigidSystem s = rigid->system;
  *changed = PETSC_FALSE;
  for (PetscInt r = 0; r < s->n; r++) {
    const RigidJoint *j = &rigid->joint[s->joint[r]];
    if (!s->active[r] || j->hard[s->local[r]] || PetscAbsReal(s->lambda[r]) <= j->spec.yield * (1. + 1.e-12)) continue;
    s->lambda[r] = s->lambda[r] > 0. ? j->spec.yield : -j->spec.yield;
    s->active[r] = PETSC_FALSE;
    *changed = PETSC_TRUE;
  }
}

/* After the step: plastic part of the rest angles, hinge angles, rupture. */
static void FinishJoints(Rigid rigid, PetscReal h)
{
  RigidSystem s = rigid->system;
  for (PetscInt i = 0; i < rigid->njoints; i++) {
    RigidJoint *j = &rigid->joint[i];
    const PetscBool turns = j->spec.type == RIGID_JOINT_HINGE || j->spec.type == RIGID_JOINT_BEND ? PETSC_TRUE : PETSC_FALSE;
    PetscInt soft = 0;
    PetscReal angle = 0., elastic = 0.;
    for (PetscInt l = 0; l < j->nrows; l++) {
      const PetscInt r = j->first + l;
      const PetscReal g0 = s->row0[r].g, g1 = s->row1[r].g;
      PetscReal plastic = 0.;
      if (j->hard[l]) continue;
      angle += PetscSqr(s->row1[r].g + j->rest[soft]);
      if (j->spec.type == RIGID_JOINT_HINGE) j->angle = s->row1[r].g + j->rest[soft];
      if (turns && !j->broken && j->k[l] > 0. && PetscAbsReal(s->lambda[r]) >= j->spec.yield)
        plastic = .5 * (g0 + g1) + (s->lambda[r] + j->c[l] * (g1 - g0) / h) / j->k[l];
      j->rest[soft++] += plastic;
      if (j->broken) continue;
      elastic += .5 * j->k[l] * PetscSqr(g1 - plastic);
      rigid->ledger.joints -= s->lambda[r] * (g1 - g0) + .5 * j->k[l] * (PetscSqr(g1 - plastic) - g0 * g0);
    }
    for (PetscInt l = 0; l < j->nrows; l++) j->force[l] = s->lambda[j->first + l];
    if (turns && !j->broken && PetscSqrtReal(angle) > j->spec.rupture) {
      j->broken = PETSC_TRUE;
      rigid->ledger.joints += elastic;
    }
  }
}

/* Further on, the constraints have several solutions, and Newton may find the wrong one. */
static PetscErrorCode CheckTurn(Rigid rigid, PetscInt i, PetscReal h)
{
  PetscReal w[3];

  PetscFunctionBegin;
  RigidBodyOmega(&rigid->body[i], rigid->body[i].q, w);
  PetscCheck(h * Vec3Norm(w) <= 1., rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Rigid body %" PetscInt_FMT
             ": turns by %g rad in a step of %g s at t = %g s; a joined body may turn by 1 rad: raise -rigid_substeps",
             i, (double)(h * Vec3Norm(w)), (double)h, (double)rigid->t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stage 1 of a step of h > 0. */
PetscErrorCode RigidSystemBegin(Rigid rigid, PetscReal h)
{
  RigidSystem s = rigid->system;
  PetscBool again = PETSC_TRUE;

  PetscFunctionBegin;
  RigidSystemRows(rigid, s->row0);
  SystemLengths(rigid);
  PetscCall(CheckAssembled(rigid));
  for (PetscInt r = 0; r < s->n; r++) s->drive[r] = RowVelocity(rigid, &s->row0[r], r, PETSC_TRUE);
  for (PetscInt i = 0; i < rigid->n; i++) {
    if (s->start[i + 1] == s->start[i]) continue;
    PetscCall(RigidBodyCheckLoad(rigid, i));
    PetscCall(CheckTurn(rigid, i, h));
    if (rigid->body[i].spec.motion != RIGID_FREE) PetscCall(RigidBodyBegin(rigid, i, h));
    s->saved[i] = rigid->body[i];
  }
  ActivateRows(rigid, PETSC_TRUE);
  for (PetscInt r = 0; r < s->n; r++) s->lambda[r] = 0.;
  while (again) {
    PetscCall(RigidPositionSolve(rigid, h));
    YieldRows(rigid, &again);
  }
  FinishJoints(rigid, h);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stage 2; the multipliers of stage 1 are still in place. */
PetscErrorCode RigidSystemEnd(Rigid rigid, PetscReal h)
{
  RigidSystem s = rigid->system;

  PetscFunctionBegin;
  RigidSystemWrench(rigid, s->row0, s->lambda, -1); /* goes into the accelerations */
  AuditTurn(rigid, s->saved, .5 * h);
  for (PetscInt r = 0; r < s->n; r++) rigid->ledger.driven -= .5 * h * s->lambda[r] * s->drive[r];
  for (PetscInt i = 0; i < rigid->n; i++) {
    RigidBody *b = &rigid->body[i];
    if (s->start[i + 1] == s->start[i]) continue;
    RigidBodyEnd(rigid, i, h);
    for (int k = 0; k < 3 && b->spec.motion == RIGID_FREE; k++) {
      b->Fused[k] += s->wrench[6 * i + k];
      b->Tused[k] += s->wrench[6 * i + 3 + k];
    }
  }
  RigidSystemWrench(rigid, s->row1, s->lambda, 0);
  RigidSystemKick(rigid, .5 * h);
  AuditRows(rigid, s->row1, 0, .5 * h);
  PetscCall(ProjectVelocity(rigid, s->row1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidGetJointError(Rigid rigid, PetscReal *position, PetscReal *velocity)
{
  PetscReal p = 0., v = 0.;

  PetscFunctionBegin;
  PetscCheck(rigid->setup, rigid->comm, PETSC_ERR_ORDER, "Call RigidSetUp() first");
  for (PetscInt i = 0; i < rigid->njoints; i++) {
    RigidRow row[RIGID_MAX_ROWS];
    RigidJoint *j = &rigid->joint[i];
    RigidJointRows(rigid, j, row);
    for (PetscInt r = 0; r < j->nrows; r++) {
      if (!j->hard[r] || j->broken) continue;
      p = PetscMax(p, PetscAbsReal(row[r].g));
      v = PetscMax(v, PetscAbsReal(RowVelocity(rigid, &row[r], j->first + r, PETSC_FALSE)));
    }
  }
  if (position) *position = p;
  if (velocity) *velocity = v;
  PetscFunctionReturn(PETSC_SUCCESS);
}
