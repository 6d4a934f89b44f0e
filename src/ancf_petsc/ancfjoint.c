/* ancfjoint.c - joints between beams: their rows from the shape at rest, checks, accelerations and forces. */
#include "ancfimpl.h"

/* Angles between tangents that are neither none nor a corner's cannot be told from an inexact mesh. */
#define COLLINEAR 5e-7 /* a mesh file may hold eight digits */
#define CORNER 1e-3

PetscErrorCode AncfAddJoint(Ancf ancf, AncfJointType type, PetscInt n, const PetscInt beam[], const PetscInt node[],
                            PetscInt *joint)
{
  AncfJoint *j;

  PetscFunctionBegin;
  PetscCheck(!ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfAddJoint: joints cannot be added after AncfSetUp()");
  PetscCheck(type == ANCF_JOINT_BALL || type == ANCF_JOINT_RIGID, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "AncfAddJoint: type %d must be ANCF_JOINT_BALL or ANCF_JOINT_RIGID", (int)type);
  PetscCheck(n >= 2, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE, "AncfAddJoint: %" PetscInt_FMT " nodes, a joint needs 2 or more", n);
  for (PetscInt k = 0; k < n; k++) {
    PetscCheck(beam[k] >= 0 && beam[k] < ancf->nbeams, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "AncfAddJoint: beam %" PetscInt_FMT " must be in 0..%" PetscInt_FMT, beam[k], ancf->nbeams - 1);
    PetscCheck(node[k] >= 0 && node[k] <= ancf->beams[beam[k]].spec.elements, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "AncfAddJoint: node %" PetscInt_FMT " of beam %" PetscInt_FMT " must be in 0..%" PetscInt_FMT, node[k], beam[k],
               ancf->beams[beam[k]].spec.elements);
  }
  if (ancf->njoints == ancf->maxjoints) {
    ancf->maxjoints = PetscMax(8, 2 * ancf->maxjoints);
    PetscCall(PetscRealloc(sizeof(AncfJoint) * (size_t)ancf->maxjoints, &ancf->joints));
  }
  j = &ancf->joints[ancf->njoints];
  PetscCall(PetscMemzero(j, sizeof(*j)));
  j->type = type;
  j->n = n;
  PetscCall(PetscMalloc3(n, &j->beam, n, &j->node, n, &j->at));
  PetscCall(PetscArraycpy(j->beam, beam, n));
  PetscCall(PetscArraycpy(j->node, node, n));
  if (joint) *joint = ancf->njoints;
  ancf->njoints++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfGetNumJoints(Ancf ancf, PetscInt *n)
{
  PetscFunctionBegin;
  *n = ancf->njoints;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfGetJoint(Ancf ancf, PetscInt joint, PetscInt k, PetscInt *n, PetscInt *beam, PetscInt *node)
{
  PetscFunctionBegin;
  PetscCheck(joint >= 0 && joint < ancf->njoints && k >= 0 && k < ancf->joints[joint].n, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "AncfGetJoint: there is no joint %" PetscInt_FMT " with a node %" PetscInt_FMT, joint, k);
  if (n) *n = ancf->joints[joint].n;
  if (beam) *beam = ancf->joints[joint].beam[k];
  if (node) *node = ancf->joints[joint].node[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void AddRow(AncfJoint *j, AncfRowKind kind, PetscInt k, int c, PetscReal s0, PetscReal s1, PetscReal s2)
{
  j->row[j->nrows++] = (AncfRow){kind, (int)k, c, {s0, s1, s2}};
}

static PetscReal Dot(const PetscReal a[3], const PetscReal b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void Cross(const PetscReal a[3], const PetscReal b[3], PetscReal r[3])
{
  for (int c = 0; c < 3; c++) r[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
}

/* Every node at one place, and in this joint only. */
static PetscErrorCode JointPlaces(Ancf ancf, PetscInt number)
{
  AncfJoint *j = &ancf->joints[number];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < j->n; k++) {
    const AncfBeam *b = &ancf->beams[j->beam[k]], *b0 = &ancf->beams[j->beam[0]];
    const PetscReal *x = ancf->e + 6 * (b->node + j->node[k]), *x0 = ancf->e + 6 * (b0->node + j->node[0]);
    PetscReal d[3], l = PetscMax(b->l, b0->l);

    j->at[k] = b->node + j->node[k];
    PetscCheck(ancf->jointof[j->at[k]] < 0, ancf->comm, PETSC_ERR_ARG_INCOMP,
               "Joint %" PetscInt_FMT ": node %" PetscInt_FMT " of beam %" PetscInt_FMT " is in joint %" PetscInt_FMT
               " already; list all nodes that meet in one joint, each once",
               number, j->node[k], j->beam[k], ancf->jointof[j->at[k]]);
    ancf->jointof[j->at[k]] = number;
    ancf->localof[j->at[k]] = k;
    for (int c = 0; c < 3; c++) d[c] = x[c] - x0[c];
    PetscCheck(Dot(d, d) <= PetscSqr(1e-8 * l), ancf->comm, PETSC_ERR_ARG_INCOMP,
               "Joint %" PetscInt_FMT ": node %" PetscInt_FMT " of beam %" PetscInt_FMT " lies %g m from node %" PetscInt_FMT
               " of beam %" PetscInt_FMT "; they must be at the same point",
               number, j->node[k], j->beam[k], (double)PetscSqrtReal(Dot(d, d)), j->node[0], j->beam[0]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows of the tangents of a rigid joint, from the shape at rest. */
static PetscErrorCode RigidRows(Ancf ancf, PetscInt number)
{
  AncfJoint *j = &ancf->joints[number];
  PetscReal(*t)[3], n[3] = {0}, most = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(j->n, &t));
  for (PetscInt k = 0; k < j->n; k++) {
    const PetscReal *u = ancf->e + 6 * j->at[k] + 3;
    PetscReal sine;

    for (int c = 0; c < 3; c++) t[k][c] = u[c] / PetscSqrtReal(Dot(u, u));
    Cross(t[0], t[k], n);
    sine = PetscSqrtReal(Dot(n, n));
    PetscCheck(sine <= COLLINEAR || sine >= CORNER, ancf->comm, PETSC_ERR_ARG_INCOMP,
               "Joint %" PetscInt_FMT ": the tangents of beam %" PetscInt_FMT " and beam %" PetscInt_FMT
               " are %g rad from one line; make them collinear, or bend them by %g or more",
               number, j->beam[0], j->beam[k], (double)sine, CORNER);
    if (sine > CORNER && sine > most * (1 + 1e-12)) most = sine, j->ref = k;
  }
  if (j->n == 2 && j->ref < 0 && ancf->beams[j->beam[0]].EA == ancf->beams[j->beam[1]].EA)
    for (int c = 0; c < 3; c++) AddRow(j, ANCF_ROW_EQUAL, 1, c, Dot(t[0], t[1]) > 0 ? 1 : -1, 0, 0);
  else
    j->linear = PETSC_FALSE;
  if (j->ref >= 0) {
    AddRow(j, ANCF_ROW_ANGLE, j->ref, 0, Dot(t[0], t[j->ref]), 0, 0);
    Cross(t[0], t[j->ref], n);
  }
  for (PetscInt k = 1; k < j->n && !j->linear; k++) {
    const PetscReal cosine = j->ref < 0 ? 0 : Dot(t[0], t[j->ref]), d0 = Dot(t[k], t[0]);
    const PetscReal d1 = j->ref < 0 ? 0 : Dot(t[k], t[j->ref]), det = 1 - cosine * cosine;

    if (k == j->ref) continue;
    for (int c = 0; c < 2; c++) {
      if (j->ref < 0)
        AddRow(j, ANCF_ROW_FOLLOW, k, c, d0 > 0 ? 1 : -1, 0, 0);
      else
        AddRow(j, ANCF_ROW_FOLLOW, k, c, (d0 - cosine * d1) / det, (d1 - cosine * d0) / det, Dot(t[k], n) / det);
    }
  }
  PetscCall(PetscFree(t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode JointAllocate(AncfJoint *j)
{
  const PetscInt m = j->nrows, n = j->nloc;

  PetscFunctionBegin;
  PetscCall(PetscCalloc5(m, &j->dep, m, &j->pivot, m, &j->phi, (size_t)(m + n), &j->lambda, (size_t)m * (size_t)m, &j->LU));
  PetscCall(PetscCalloc5((size_t)m * (size_t)n, &j->G, (size_t)m * (size_t)n, &j->Gdot, (size_t)m * (size_t)n, &j->T, n, &j->x, n,
                         &j->v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfJointSetUp(Ancf ancf)
{
  const PetscInt n = 6 * ancf->nnodes;

  PetscFunctionBegin;
  if (!ancf->njoints) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(ancf->nnodes, &ancf->jointof, ancf->nnodes, &ancf->localof));
  PetscCall(PetscCalloc4(n, &ancf->je, n, &ancf->jv, n, &ancf->ja, n, &ancf->jrow));
  for (PetscInt i = 0; i < ancf->nnodes; i++) ancf->jointof[i] = -1;
  for (PetscInt k = 0; k < ancf->njoints; k++) {
    AncfJoint *j = &ancf->joints[k];

    PetscCall(JointPlaces(ancf, k));
    PetscCall(PetscMalloc2(6 * (size_t)j->n, &j->row, j->n, &j->normal));
    j->ref = -1;
    j->linear = PETSC_TRUE;
    j->nloc = j->type == ANCF_JOINT_RIGID ? 6 * j->n : 3 * j->n;
    for (PetscInt i = 1; i < j->n; i++)
      for (int c = 0; c < 3; c++) AddRow(j, ANCF_ROW_POSITION, i, c, 0, 0, 0);
    if (j->type == ANCF_JOINT_RIGID) PetscCall(RigidRows(ancf, k));
    PetscCall(JointAllocate(j));
  }
  PetscCall(AncfJointCheck(ancf, "AncfSetUp", ancf->e, ancf->v));
  PetscCall(AncfJointSync(ancf, PETSC_TRUE, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfJointDestroy(Ancf ancf)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < ancf->njoints; k++) {
    AncfJoint *j = &ancf->joints[k];

    PetscCall(PetscFree3(j->beam, j->node, j->at));
    if (j->row) PetscCall(PetscFree2(j->row, j->normal));
    if (!j->dep) continue;
    PetscCall(PetscFree5(j->dep, j->pivot, j->phi, j->lambda, j->LU));
    PetscCall(PetscFree5(j->G, j->Gdot, j->T, j->x, j->v));
  }
  PetscCall(PetscFree(ancf->joints));
  if (ancf->jointof) PetscCall(PetscFree2(ancf->jointof, ancf->localof));
  if (ancf->je) PetscCall(PetscFree4(ancf->je, ancf->jv, ancf->ja, ancf->jrow));
  PetscCall(MatDestroy(&ancf->JM));
  PetscCall(KSPDestroy(&ancf->JK));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* To 1e-6 of an element's length, of a tangent, and of the largest velocity. */
PetscErrorCode AncfJointCheck(Ancf ancf, const char function[], const PetscReal *e, const PetscReal *v)
{
  PetscReal speed = 0;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < 6 * ancf->nnodes; i++) speed = PetscMax(speed, PetscAbsReal(v[i]));
  for (PetscInt k = 0; k < ancf->njoints; k++) {
    AncfJoint *j = &ancf->joints[k];
    const PetscReal l = ancf->beams[j->beam[0]].l;

    for (PetscInt c = 0; c < j->nloc; c++) {
      j->x[c] = e[AncfJointCoordinate(j, c)];
      j->v[c] = v[AncfJointCoordinate(j, c)];
    }
    AncfJointNormals(j, j->x);
    AncfRowsEvaluate(j, j->x, NULL, j->phi, j->G, NULL, NULL, NULL);
    for (PetscInt s = 0; s < j->nrows; s++) {
      const AncfRow *r = &j->row[s];
      PetscReal rate = 0;

      PetscCheck(PetscAbsReal(j->phi[s]) <= 1e-6 * (r->kind == ANCF_ROW_POSITION ? l : 1), ancf->comm, PETSC_ERR_ARG_INCOMP,
                 "%s: joint %" PetscInt_FMT " between beam %" PetscInt_FMT " and beam %" PetscInt_FMT
                 " is broken by %g (positions in m, tangents in rad)",
                 function, k, j->beam[0], j->beam[r->k], (double)PetscAbsReal(j->phi[s]));
      for (PetscInt c = 0; c < j->nloc; c++) rate += j->G[s * j->nloc + c] * j->v[c];
      PetscCheck(PetscAbsReal(rate) <= 1e-6 * speed, ancf->comm, PETSC_ERR_ARG_INCOMP,
                 "%s: the velocities of beam %" PetscInt_FMT " and beam %" PetscInt_FMT " tear joint %" PetscInt_FMT
                 " apart by %g m/s or rad/s",
                 function, j->beam[0], j->beam[r->k], k, (double)PetscAbsReal(rate));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* T^T M T, factored; of linear joints once. */
static PetscErrorCode JointMass(Ancf ancf)
{
  PetscBool linear = PETSC_TRUE;
  PC pc;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < ancf->njoints; k++) linear = (PetscBool)(linear && ancf->joints[k].linear);
  if (ancf->jfactored && linear) PetscFunctionReturn(PETSC_SUCCESS);
  if (!ancf->JM) {
    PetscCall(AncfNetworkCreate(ancf, 6, NULL, &ancf->JM));
    PetscCall(MatSetOption(ancf->JM, MAT_SYMMETRIC, PETSC_TRUE));
    PetscCall(KSPCreate(ancf->comm, &ancf->JK));
    PetscCall(KSPSetOperators(ancf->JK, ancf->JM, ancf->JM));
    PetscCall(KSPSetType(ancf->JK, KSPPREONLY));
    PetscCall(KSPGetPC(ancf->JK, &pc));
    PetscCall(PCSetType(pc, PCCHOLESKY));
  }
  PetscCall(MatZeroEntries(ancf->JM));
  PetscCall(AncfAssembleElements(ancf, NULL, 0, 1, ancf->JM));
  PetscCall(AncfAssembleNodes(ancf, 1, ancf->JM));
  PetscCall(MatAssemblyBegin(ancf->JM, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(ancf->JM, MAT_FINAL_ASSEMBLY));
  PetscCall(KSPSetUp(ancf->JK));
  ancf->jfactored = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* As AncfExplicitAcceleration() with joints: T^T M (T m_i + g) = T^T f for m = a + damping v. */
PetscErrorCode AncfJointAcceleration(Ancf ancf, const PetscReal *e, const PetscReal *v, PetscInt stride, PetscReal *a,
                                     PetscInt astride)
{
  const PetscInt n = 6 * ancf->nnodes;
  const PetscReal damping = v ? ancf->damping : 0;
  PetscScalar *f;
  PetscReal *m;
  Vec F;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(n, &m));
  PetscCall(AncfJointState(ancf, e, v, stride, NULL, 0));
  PetscCall(VecCreateSeq(ancf->comm, n, &F));
  PetscCall(VecGetArrayWrite(F, &f));
  for (PetscInt i = 0; i < n; i++) m[i] = ancf->ja[i] + damping * ancf->jv[i] * (AncfIsDependent(ancf, i) ? 1 : 0);
  PetscCall(AncfResidual(ancf, ancf->je, 6, m, 6, f, 6));
  if (v) AncfAddViscous(ancf, ancf->je, ancf->jv, 6, f, 6, NULL);
  for (PetscInt i = 0; i < n; i++) f[i] = -f[i];
  PetscCall(AncfJointReduce(ancf, f, 6, NULL, 0));
  for (PetscInt i = 0; i < n; i++)
    if (ancf->fixed[i / 6] & (i % 6 < 3 ? ANCF_FIX_POSITION : ANCF_FIX_GRADIENT)) f[i] = 0;
  PetscCall(VecRestoreArrayWrite(F, &f));
  PetscCall(JointMass(ancf));
  PetscCall(KSPSolve(ancf->JK, F, F));
  PetscCall(VecGetArray(F, &f));
  for (PetscInt i = 0; i < n; i++) m[i] = f[i] - damping * ancf->jv[i];
  PetscCall(VecRestoreArray(F, &f));
  PetscCall(AncfJointState(ancf, e, v, stride, m, 6));
  for (PetscInt i = 0; i < n; i++) a[(i / 6) * astride + i % 6] = ancf->ja[i];
  AncfFixRows(ancf, NULL, 0, a, astride);
  PetscCall(VecDestroy(&F));
  PetscCall(PetscFree(m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfGetJointForce(Ancf ancf, PetscInt joint, PetscInt k, PetscReal f[6])
{
  const AncfJoint *j;
  PetscReal *r;

  PetscFunctionBegin;
  PetscCheck(ancf->setup, ancf->comm, PETSC_ERR_ARG_WRONGSTATE, "AncfGetJointForce: call AncfSetUp() first");
  PetscCheck(joint >= 0 && joint < ancf->njoints && k >= 0 && k < ancf->joints[joint].n, ancf->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "AncfGetJointForce: there is no joint %" PetscInt_FMT " with a node %" PetscInt_FMT, joint, k);
  j = &ancf->joints[joint];
  PetscCall(PetscMalloc1(6 * (size_t)ancf->nnodes, &r));
  PetscCall(AncfSupportForces(ancf, r, PETSC_FALSE));
  PetscCall(PetscArraycpy(f, r + 6 * j->at[k], 6));
  PetscCall(PetscFree(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}
