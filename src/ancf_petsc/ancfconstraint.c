/*
  ancfconstraint.c - the equations of joints, and elimination of their dependent coordinates.

  A joint of n nodes holds Phi(e) = 0, row by row, with t = r'/|r'|:
    position   r_k - r_0                                    three rows for each further node
    equal      r'_k - s r'_0, s = 1 or -1                   two collinear beams of equal EA
    angle      t_0 . t_k - cos                              two beams at a corner
    follow     p . (t_k - s0 t_0 - s1 t_r - s2 t_0 x t_r)   p: two normals of t_k; the others, in the frame of two of them
  G = dPhi/de. With dependent coordinates d, as many as rows, chosen so that G_d is well conditioned, and the others i:
    e_d from Phi(e_i, e_d) = 0,   v_d = T v_i,   a_d = T a_i - G_d^-1 (dG/dt) v,   T = -G_d^-1 G_i;
    equations of motion f_i + T^T f_d = 0, and lambda = -G_d^-T f_d are the forces along the rows.
  The beams see these coordinates whatever the integrator makes of the rows of d, which are kept for a regular structure and
  read: acceleration = that of the last step. The idea is coordinate partitioning (Wehage and Haug, J. Mech. Design 104 (1982)).
*/
#include "ancfimpl.h"
#include "ancfjet.h"

PetscInt AncfJointCoordinate(const AncfJoint *j, PetscInt local)
{
  return local < 3 * j->n ? 6 * j->at[local / 3] + local % 3 : 6 * j->at[local / 3 - j->n] + 3 + local % 3;
}

/* ANGLE or FOLLOW as a function of the gradients of node 0, ref and k. */
static Jet RowJet(const AncfJoint *j, const AncfRow *r, const PetscReal *x)
{
  const PetscInt group[3] = {0, j->ref, r->k};
  Jet u[3][3], t[3][3], cross[3], f = {0};

  for (int g = 0; g < 3; g++) {
    if (group[g] < 0) continue;
    for (int c = 0; c < 3; c++) u[g][c] = JetVariable(x[3 * (j->n + group[g]) + c], 3 * g + c);
    JetUnit(u[g], t[g]);
  }
  if (r->kind == ANCF_ROW_ANGLE) {
    f = JetDot(t[0], t[2]);
    f.v -= r->s[0];
    return f;
  }
  if (j->ref >= 0) JetCross(t[0], t[1], cross);
  for (int c = 0; c < 3; c++) {
    const PetscReal p = j->normal[r->k][r->c][c];

    f = JetSum(f, p, t[2][c]);
    f = JetSum(f, -p * r->s[0], t[0][c]);
    if (j->ref < 0) continue;
    f = JetSum(f, -p * r->s[1], t[1][c]);
    f = JetSum(f, -p * r->s[2], cross[c]);
  }
  return f;
}

/* phi, G and, for the velocities v, dG/dt (NULL: not wanted) of all rows; H += sum lambda d2Phi/de2 (nloc x nloc). */
void AncfRowsEvaluate(const AncfJoint *j, const PetscReal *x, const PetscReal *v, PetscReal *phi, PetscReal *G, PetscReal *Gdot,
                      const PetscReal *lambda, PetscReal *H)
{
  const PetscInt n = j->nloc;

  for (PetscInt i = 0; i < j->nrows * n; i++) G[i] = 0;
  for (PetscInt i = 0; i < j->nrows * n && Gdot; i++) Gdot[i] = 0;
  for (PetscInt i = 0; i < j->nrows; i++) {
    const AncfRow *r = &j->row[i];
    const PetscInt o = r->kind == ANCF_ROW_POSITION ? 0 : 3 * j->n, at = o + 3 * r->k + r->c;
    const PetscReal s = r->kind == ANCF_ROW_POSITION ? 1 : r->s[0];
    PetscInt var[JET];
    Jet f;

    if (r->kind <= ANCF_ROW_EQUAL) {
      phi[i] = x[at] - s * x[o + r->c];
      G[i * n + at] = 1;
      G[i * n + o + r->c] = -s;
      continue;
    }
    f = RowJet(j, r, x);
    phi[i] = f.v;
    for (int q = 0; q < JET; q++) var[q] = 3 * (j->n + (q < 3 ? 0 : q < 6 ? PetscMax(j->ref, 0) : r->k)) + q % 3;
    for (int q = 0; q < JET; q++) G[i * n + var[q]] += f.g[q];
    for (int q = 0; q < JET; q++)
      for (int p = 0; p < JET; p++) {
        if (Gdot) Gdot[i * n + var[q]] += f.h[q][p] * v[var[p]];
        if (H) H[var[q] * n + var[p]] += lambda[i] * f.h[q][p];
      }
  }
}

/* Two normals of each node's tangent. */
void AncfJointNormals(AncfJoint *j, const PetscReal *x)
{
  for (PetscInt k = 0; k < j->n && !j->linear; k++) {
    const PetscReal *u = x + 3 * (j->n + k);
    PetscReal l = PetscSqrtReal(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]), *p = j->normal[k][0], *q = j->normal[k][1], s = 0;
    const int small = PetscAbsReal(u[0]) <= PetscAbsReal(u[1]) ? (PetscAbsReal(u[0]) <= PetscAbsReal(u[2]) ? 0 : 2)
                                                               : (PetscAbsReal(u[1]) <= PetscAbsReal(u[2]) ? 1 : 2);

    for (int c = 0; c < 3; c++) p[c] = (c == small) - u[small] * u[c] / (l * l);
    for (int c = 0; c < 3; c++) s += p[c] * p[c];
    for (int c = 0; c < 3; c++) p[c] /= PetscSqrtReal(s);
    for (int c = 0; c < 3; c++) q[c] = (u[(c + 1) % 3] * p[(c + 2) % 3] - u[(c + 2) % 3] * p[(c + 1) % 3]) / l;
  }
}

static PetscBool IsFixed(const Ancf ancf, PetscInt i)
{
  return ancf->fixed[i / 6] & (i % 6 < 3 ? ANCF_FIX_POSITION : ANCF_FIX_GRADIENT) ? PETSC_TRUE : PETSC_FALSE;
}

/* Dependent columns by elimination with full pivoting over the free ones. */
static PetscErrorCode ChooseDependent(Ancf ancf, AncfJoint *j)
{
  const PetscInt m = j->nrows, n = j->nloc;
  PetscReal *A;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1((size_t)m * (size_t)n, &A));
  PetscCall(PetscArraycpy(A, j->G, m * n));
  for (PetscInt c = 0; c < n; c++)
    for (PetscInt r = 0; r < m && IsFixed(ancf, AncfJointCoordinate(j, c)); r++) A[r * n + c] = 0;
  for (PetscInt s = 0; s < m; s++) {
    PetscInt pr = s, pc = 0;

    for (PetscInt r = s; r < m; r++)
      for (PetscInt c = 0; c < n; c++)
        if (PetscAbsReal(A[r * n + c]) >= PetscAbsReal(A[pr * n + pc]) * (1 + 1e-12)) pr = r, pc = c;
    if (!(PetscAbsReal(A[pr * n + pc]) > 1e-6)) {
      PetscCall(PetscFree(A));
      SETERRQ(ancf->comm, PETSC_ERR_ARG_INCOMP,
              "Joint %" PetscInt_FMT " of node %" PetscInt_FMT " of beam %" PetscInt_FMT
              ": its supports fix more than the joint leaves free; support one of its nodes only, or join without supports",
              (PetscInt)(j - ancf->joints), j->node[0], j->beam[0]);
    }
    for (PetscInt c = 0; c < n; c++) {
      const PetscReal t = A[s * n + c];

      A[s * n + c] = A[pr * n + c];
      A[pr * n + c] = t;
    }
    j->dep[s] = pc;
    for (PetscInt r = s + 1; r < m; r++) {
      const PetscReal f = A[r * n + pc] / A[s * n + pc];

      for (PetscInt c = 0; c < n; c++) A[r * n + c] -= f * A[s * n + c];
      A[r * n + pc] = 0;
    }
  }
  PetscCall(PetscFree(A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* LU of G_d by rows, partial pivoting. */
static PetscErrorCode FactorDependent(AncfJoint *j)
{
  const PetscInt m = j->nrows;
  PetscReal *A = j->LU;

  PetscFunctionBegin;
  for (PetscInt r = 0; r < m; r++)
    for (PetscInt s = 0; s < m; s++) A[r * m + s] = j->G[r * j->nloc + j->dep[s]];
  for (PetscInt s = 0; s < m; s++) {
    PetscInt p = s;

    for (PetscInt r = s + 1; r < m; r++)
      if (PetscAbsReal(A[r * m + s]) > PetscAbsReal(A[p * m + s])) p = r;
    j->pivot[s] = p;
    for (PetscInt c = 0; c < m && p != s; c++) {
      const PetscReal t = A[s * m + c];

      A[s * m + c] = A[p * m + c];
      A[p * m + c] = t;
    }
    for (PetscInt r = s + 1; r < m; r++) {
      A[r * m + s] /= A[s * m + s];
      if (A[r * m + s] == 0) continue;
      for (PetscInt c = s + 1; c < m; c++) A[r * m + c] -= A[r * m + s] * A[s * m + c];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* b := G_d^-1 b, or G_d^-T b. */
static void SolveDependent(const AncfJoint *j, PetscBool transpose, PetscReal *b)
{
  const PetscInt m = j->nrows;
  const PetscReal *A = j->LU;

  if (!transpose) {
    for (PetscInt s = 0; s < m; s++) {
      const PetscReal t = b[j->pivot[s]];

      b[j->pivot[s]] = b[s];
      b[s] = t;
    }
    for (PetscInt s = 0; s < m; s++)
      for (PetscInt r = s + 1; r < m; r++) b[r] -= A[r * m + s] * b[s];
    for (PetscInt s = m - 1; s >= 0; s--) {
      b[s] /= A[s * m + s];
      for (PetscInt r = 0; r < s; r++) b[r] -= A[r * m + s] * b[s];
    }
    return;
  }
  for (PetscInt s = 0; s < m; s++) {
    for (PetscInt r = 0; r < s; r++) b[s] -= A[r * m + s] * b[r];
    b[s] /= A[s * m + s];
  }
  for (PetscInt s = m - 1; s >= 0; s--)
    for (PetscInt r = s + 1; r < m; r++) b[s] -= A[r * m + s] * b[r];
  for (PetscInt s = m - 1; s >= 0; s--) {
    const PetscReal t = b[j->pivot[s]];

    b[j->pivot[s]] = b[s];
    b[s] = t;
  }
}

/* T = -G_d^-1 G, zero in the dependent columns. */
static PetscErrorCode TransferMatrix(AncfJoint *j)
{
  const PetscInt m = j->nrows, n = j->nloc;

  PetscFunctionBegin;
  PetscCall(FactorDependent(j));
  for (PetscInt c = 0; c < n; c++) {
    PetscReal *b = j->phi;
    PetscBool any = PETSC_FALSE;

    for (PetscInt r = 0; r < m; r++) {
      b[r] = -j->G[r * n + c];
      if (b[r] != 0) any = PETSC_TRUE;
    }
    if (any) SolveDependent(j, PETSC_FALSE, b);
    for (PetscInt r = 0; r < m; r++) j->T[r * n + c] = b[r];
  }
  for (PetscInt s = 0; s < m; s++)
    for (PetscInt r = 0; r < m; r++) j->T[r * n + j->dep[s]] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Dependent entries of j->x from the others, Newton's method from their present values; G, LU and T there. */
static PetscErrorCode SolvePositions(Ancf ancf, AncfJoint *j)
{
  const PetscInt m = j->nrows, n = j->nloc;
  PetscReal last = PETSC_MAX_REAL;

  PetscFunctionBegin;
  if (j->linear) {
    for (PetscInt s = 0; s < m; s++) {
      PetscReal x = 0;

      for (PetscInt c = 0; c < n; c++)
        if (j->T[s * n + c] != 0) x += j->T[s * n + c] * j->x[c];
      j->x[j->dep[s]] = x;
    }
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (int it = 0; it < 30; it++) {
    PetscReal step = 0;

    AncfRowsEvaluate(j, j->x, NULL, j->phi, j->G, NULL, NULL, NULL);
    PetscCall(FactorDependent(j));
    SolveDependent(j, PETSC_FALSE, j->phi);
    for (PetscInt s = 0; s < m; s++) {
      j->x[j->dep[s]] -= j->phi[s];
      step = PetscMax(step, PetscAbsReal(j->phi[s]));
    }
    if (!(step < PETSC_MAX_REAL)) break; /* NaN: the step fails, and is halved */
    if (step < 1e-15 || (step < 1e-10 && step >= last)) break;
    last = step;
  }
  AncfRowsEvaluate(j, j->x, NULL, j->phi, j->G, NULL, NULL, NULL);
  (void)ancf;
  PetscCall(TransferMatrix(j));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* out_d = T in_i, less G_d^-1 (dG/dt) v if quadratic, over the local coordinates. */
static void ApplyTransfer(AncfJoint *j, PetscReal *y, PetscBool quadratic)
{
  const PetscInt m = j->nrows, n = j->nloc;
  PetscReal *b = j->phi;

  for (PetscInt s = 0; s < m; s++) {
    b[s] = 0;
    for (PetscInt c = 0; c < n && quadratic; c++) b[s] += j->Gdot[s * n + c] * j->v[c];
  }
  if (quadratic) SolveDependent(j, PETSC_FALSE, b);
  for (PetscInt s = 0; s < m; s++) {
    PetscReal z = -b[s];

    for (PetscInt c = 0; c < n; c++)
      if (j->T[s * n + c] != 0) z += j->T[s * n + c] * y[c];
    b[s] = z;
  }
  for (PetscInt s = 0; s < m; s++) y[j->dep[s]] = b[s];
}

static PetscReal Pick(const Ancf ancf, const PetscReal *x, PetscInt stride, const PetscReal *fix, PetscInt i)
{
  if (IsFixed(ancf, i)) return fix ? fix[i] : 0;
  return x ? x[(i / 6) * stride + i % 6] : 0;
}

PetscErrorCode AncfJointState(Ancf ancf, const PetscReal *e, const PetscReal *v, PetscInt stride, const PetscReal *a,
                              PetscInt astride)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < ancf->nnodes; i++)
    for (int c = 0; c < 6; c++) {
      ancf->je[6 * i + c] = e[i * stride + c];
      ancf->jv[6 * i + c] = v ? v[i * stride + c] : 0;
      ancf->ja[6 * i + c] = a ? a[i * astride + c] : 0;
    }
  for (PetscInt k = 0; k < ancf->njoints; k++) {
    AncfJoint *j = &ancf->joints[k];
    PetscReal *y = j->lambda + j->nrows; /* room for one more vector */

    for (PetscInt c = 0; c < j->nloc; c++) {
      const PetscInt i = AncfJointCoordinate(j, c);

      y[c] = j->x[c];
      j->x[c] = Pick(ancf, e, stride, ancf->rest, i);
      j->v[c] = Pick(ancf, v, stride, ancf->restv, i);
    }
    for (PetscInt s = 0; s < j->nrows; s++) j->x[j->dep[s]] = y[j->dep[s]]; /* where Newton's method last ended */
    PetscCall(SolvePositions(ancf, j));
    ApplyTransfer(j, j->v, PETSC_FALSE);
    if (!j->linear) AncfRowsEvaluate(j, j->x, j->v, j->phi, j->G, j->Gdot, NULL, NULL);
    for (PetscInt c = 0; c < j->nloc; c++) y[c] = Pick(ancf, a, astride, ancf->resta, AncfJointCoordinate(j, c));
    ApplyTransfer(j, y, j->linear ? PETSC_FALSE : PETSC_TRUE);
    for (PetscInt s = 0; s < j->nrows; s++) {
      const PetscInt c = j->dep[s], i = AncfJointCoordinate(j, c);

      ancf->je[i] = j->x[c];
      ancf->jv[i] = j->v[c];
      ancf->ja[i] = y[c];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfJointReduce(Ancf ancf, PetscReal *f, PetscInt fstride, const PetscReal *x, PetscInt stride)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < ancf->njoints; k++) {
    AncfJoint *j = &ancf->joints[k];
    const PetscInt n = j->nloc;

    for (PetscInt s = 0; s < j->nrows; s++) {
      const PetscInt i = AncfJointCoordinate(j, j->dep[s]);
      const PetscReal fd = f[(i / 6) * fstride + i % 6];

      j->lambda[s] = -fd;
      for (PetscInt c = 0; c < n; c++) {
        const PetscInt l = AncfJointCoordinate(j, c);

        if (j->T[s * n + c] != 0) f[(l / 6) * fstride + l % 6] += j->T[s * n + c] * fd;
      }
      f[(i / 6) * fstride + i % 6] = x ? x[(i / 6) * stride + i % 6] - ancf->jrow[i] : 0;
    }
    SolveDependent(j, PETSC_TRUE, j->lambda);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether the dependent coordinates and normals still serve. */
static PetscBool Serves(const AncfJoint *j)
{
  PetscReal most = 0, lean = 0;

  for (PetscInt i = 0; i < j->nrows * j->nloc; i++) most = PetscMax(most, PetscAbsReal(j->T[i]));
  for (PetscInt i = 0; i < j->nrows; i++) {
    const AncfRow *r = &j->row[i];
    const PetscReal *u = j->x + 3 * (j->n + r->k), *p = j->normal[r->k][r->c];

    if (r->kind != ANCF_ROW_FOLLOW) continue;
    lean = PetscMax(lean, PetscAbsReal(p[0] * u[0] + p[1] * u[1] + p[2] * u[2]) /
                              PetscSqrtReal(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]));
  }
  return most < 5 && lean < 0.2 ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode AncfJointSync(Ancf ancf, PetscBool fresh, PetscBool *changed)
{
  PetscFunctionBegin;
  if (changed) *changed = PETSC_FALSE;
  for (PetscInt k = 0; k < ancf->njoints; k++) {
    AncfJoint *j = &ancf->joints[k];

    if (!fresh && (j->linear || Serves(j))) continue;
    for (PetscInt c = 0; c < j->nloc; c++) {
      const PetscInt i = AncfJointCoordinate(j, c);

      j->x[c] = Pick(ancf, fresh ? ancf->e : ancf->je, 6, ancf->rest, i);
    }
    if (changed) *changed = PETSC_TRUE;
    AncfJointNormals(j, j->x);
    AncfRowsEvaluate(j, j->x, NULL, j->phi, j->G, NULL, NULL, NULL);
    PetscCall(ChooseDependent(ancf, j));
    PetscCall(TransferMatrix(j));
  }
  if (fresh) PetscCall(PetscArrayzero(ancf->jrow, 6 * ancf->nnodes));
  PetscCall(AncfJointState(ancf, ancf->e, ancf->v, 6, NULL, 0));
  for (PetscInt k = 0; k < ancf->njoints; k++) {
    const AncfJoint *j = &ancf->joints[k];

    for (PetscInt s = 0; s < j->nrows; s++) {
      const PetscInt i = AncfJointCoordinate(j, j->dep[s]);

      ancf->e[i] = ancf->je[i];
      ancf->v[i] = ancf->jv[i];
    }
  }
  ancf->jfactored = ancf->jfactored && !fresh ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
