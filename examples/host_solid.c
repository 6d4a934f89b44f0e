/* host_solid.c - plane-strain finite elements on DMPlex and TS, see host_solid.h. */
#include "host_solid.h"

static const PetscReal gauss[3] = {-0.774596669241483377, 0.0, 0.774596669241483377}, weight3[3] = {5. / 9., 8. / 9., 5. / 9.};

/* Quadratic Lagrange functions at -1, 0, 1 and their derivatives. */
static void Line3(PetscReal x, PetscReal L[3], PetscReal D[3])
{
  L[0] = 0.5 * x * (x - 1.0), L[1] = 1.0 - x * x, L[2] = 0.5 * x * (x + 1.0);
  D[0] = x - 0.5, D[1] = -2.0 * x, D[2] = x + 0.5;
}

/* Place of the nine nodes in the 3 x 3 lattice of the reference cell. */
static const int at[9][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0}, {2, 1}, {1, 2}, {0, 1}, {1, 1}};

static void ShapeGradient(PetscReal xi, PetscReal eta, PetscReal N[9], PetscReal dN[9][2])
{
  PetscReal a[3], da[3], b[3], db[3];

  Line3(xi, a, da);
  Line3(eta, b, db);
  for (int j = 0; j < 9; j++) {
    N[j] = a[at[j][0]] * b[at[j][1]];
    dN[j][0] = da[at[j][0]] * b[at[j][1]];
    dN[j][1] = a[at[j][0]] * db[at[j][1]];
  }
}

/* Position and Jacobian dx_i/dxi_j. */
static void Map(const Solid *s, PetscInt cell, const PetscReal N[9], PetscReal dN[9][2], PetscReal x[2], PetscReal J[2][2])
{
  for (int i = 0; i < 2; i++) {
    x[i] = J[i][0] = J[i][1] = 0.0;
    for (int j = 0; j < 9; j++) {
      const PetscReal X = s->X[2 * s->cell[cell][j] + i];
      x[i] += N[j] * X;
      J[i][0] += dN[j][0] * X;
      J[i][1] += dN[j][1] * X;
    }
  }
}

/* Gradient with respect to x at a Gauss point, and the determinant. */
static PetscReal Gradient(const Solid *s, PetscInt cell, PetscReal xi, PetscReal eta, PetscReal N[9], PetscReal g[9][2])
{
  PetscReal dN[9][2], x[2], J[2][2], det;

  ShapeGradient(xi, eta, N, dN);
  Map(s, cell, N, dN, x, J);
  det = J[0][0] * J[1][1] - J[0][1] * J[1][0];
  for (int j = 0; j < 9; j++) {
    g[j][0] = (J[1][1] * dN[j][0] - J[1][0] * dN[j][1]) / det;
    g[j][1] = (J[0][0] * dN[j][1] - J[0][1] * dN[j][0]) / det;
  }
  return det;
}

void SolidShape(const Solid *s, PetscInt cell, PetscReal xi, PetscReal eta, PetscReal N[9], PetscReal Nx[9])
{
  PetscReal g[9][2];

  (void)Gradient(s, cell, xi, eta, N, g);
  for (int j = 0; j < 9; j++) Nx[j] = g[j][0];
}

/* Stiffness (plane strain), consistent mass and weight of one cell, added to the system. */
static PetscErrorCode AssembleCell(Solid *s, PetscInt cell)
{
  const PetscReal lambda = s->young * s->poisson / ((1.0 + s->poisson) * (1.0 - 2.0 * s->poisson)),
                  G = 0.5 * s->young / (1.0 + s->poisson);
  PetscScalar K[18 * 18] = {0}, M[18 * 18] = {0}, w[18] = {0};
  PetscInt dof[18];

  PetscFunctionBegin;
  for (int p = 0; p < 9; p++) {
    PetscReal N[9], g[9][2], dv = weight3[p % 3] * weight3[p / 3];
    dv *= Gradient(s, cell, gauss[p % 3], gauss[p / 3], N, g);
    PetscCheck(dv > 0.0, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "cell %" PetscInt_FMT " of the mesh is turned inside out", cell);
    for (int i = 0; i < 9; i++) {
      w[2 * i + 1] -= dv * s->density * s->gravity * N[i];
      for (int j = 0; j < 9; j++)
        for (int a = 0; a < 2; a++) {
          M[18 * (2 * i + a) + 2 * j + a] += dv * s->density * N[i] * N[j];
          for (int b = 0; b < 2; b++) {
            PetscReal k = lambda * g[i][a] * g[j][b] + G * g[i][b] * g[j][a];
            if (a == b) k += G * (g[i][0] * g[j][0] + g[i][1] * g[j][1]);
            K[18 * (2 * i + a) + 2 * j + b] += dv * k;
          }
        }
    }
  }
  for (int i = 0; i < 18; i++) dof[i] = s->dof[2 * s->cell[cell][i / 2] + i % 2];
  PetscCall(MatSetValues(s->K, 18, dof, 18, dof, K, ADD_VALUES));
  PetscCall(MatSetValues(s->M, 18, dof, 18, dof, M, ADD_VALUES));
  PetscCall(VecSetValues(s->weight, 18, dof, w, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The nine nodes of a cell from its vertices in turn and the edges between them. */
static PetscErrorCode NumberCell(Solid *s, PetscInt c)
{
  const PetscInt *edges, *ends;
  PetscInt *closure = NULL, size, v0, v1, nv = 0, ne, *cell = s->cell[c - s->c0];

  PetscFunctionBegin;
  PetscCall(DMPlexGetDepthStratum(s->dm, 0, &v0, &v1));
  PetscCall(DMPlexGetTransitiveClosure(s->dm, c, PETSC_TRUE, &size, &closure));
  for (PetscInt k = 0; k < size; k++)
    if (closure[2 * k] >= v0 && closure[2 * k] < v1 && nv < 4) cell[nv++] = closure[2 * k];
  PetscCall(DMPlexRestoreTransitiveClosure(s->dm, c, PETSC_TRUE, &size, &closure));
  PetscCall(DMPlexGetConeSize(s->dm, c, &ne));
  PetscCheck(nv == 4 && ne == 4, PETSC_COMM_SELF, PETSC_ERR_SUP,
             "the mesh must be of quadrilaterals; cell %" PetscInt_FMT " has %" PetscInt_FMT " edges", c, ne);
  PetscCall(DMPlexGetCone(s->dm, c, &edges));
  for (int k = 0; k < 4; k++)
    for (PetscInt e = 0; e < 4; e++) {
      PetscCall(DMPlexGetCone(s->dm, edges[e], &ends));
      if ((ends[0] == cell[k] && ends[1] == cell[(k + 1) % 4]) || (ends[1] == cell[k] && ends[0] == cell[(k + 1) % 4]))
        cell[4 + k] = edges[e];
    }
  for (int k = 4; k < 8; k++)
    PetscCheck(cell[k] > 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "cell %" PetscInt_FMT ": its vertices are not in turn", c);
  cell[8] = c;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Positions of the nodes: vertices from the mesh, edges and cells in the middle of their vertices. */
static PetscErrorCode PlaceNodes(Solid *s)
{
  PetscSection section;
  Vec coordinates;
  const PetscScalar *x;
  PetscInt v0, v1;

  PetscFunctionBegin;
  PetscCall(DMPlexGetDepthStratum(s->dm, 0, &v0, &v1));
  PetscCall(DMGetCoordinatesLocal(s->dm, &coordinates));
  PetscCall(DMGetCoordinateSection(s->dm, &section));
  PetscCall(VecGetArrayRead(coordinates, &x));
  for (PetscInt v = v0; v < v1; v++) {
    PetscInt o;
    PetscCall(PetscSectionGetOffset(section, v, &o));
    for (int k = 0; k < 2; k++) s->X[2 * v + k] = PetscRealPart(x[o + k]);
  }
  PetscCall(VecRestoreArrayRead(coordinates, &x));
  for (PetscInt c = 0; c < s->c1 - s->c0; c++) {
    const PetscInt *cell = s->cell[c];
    for (int k = 0; k < 2; k++) {
      s->X[2 * cell[8] + k] = 0.0;
      for (int j = 0; j < 4; j++) {
        s->X[2 * cell[8] + k] += 0.25 * s->X[2 * cell[j] + k];
        s->X[2 * cell[4 + j] + k] = 0.5 * (s->X[2 * cell[j] + k] + s->X[2 * cell[(j + 1) % 4] + k]);
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Edges of the physical number 1 are clamped with their ends. */
static PetscErrorCode NumberDisplacements(Solid *s)
{
  IS edges;
  const PetscInt *e, *ends;
  PetscInt n = 0;

  PetscFunctionBegin;
  PetscCall(DMGetStratumIS(s->dm, "Face Sets", 1, &edges));
  PetscCheck(edges, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "the mesh has no curve of the physical number 1 to clamp");
  PetscCall(ISGetLocalSize(edges, &n));
  PetscCall(ISGetIndices(edges, &e));
  for (PetscInt k = 0; k < n; k++) {
    PetscCall(DMPlexGetCone(s->dm, e[k], &ends));
    for (int c = 0; c < 2; c++) s->dof[2 * e[k] + c] = s->dof[2 * ends[0] + c] = s->dof[2 * ends[1] + c] = -1;
  }
  PetscCall(ISRestoreIndices(edges, &e));
  PetscCall(ISDestroy(&edges));
  for (PetscInt i = 0; i < 2 * s->n; i++)
    if (s->dof[i] >= 0) s->dof[i] = s->nfree++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Residual(TS ts, PetscReal t, Vec U, Vec V, Vec A, Vec R, void *ctx)
{
  const Solid *s = (const Solid *)ctx;

  PetscFunctionBegin;
  (void)ts;
  (void)t;
  PetscCall(MatMult(s->M, V, R));
  PetscCall(VecScale(R, s->damping));
  PetscCall(MatMultAdd(s->M, A, R, R));
  PetscCall(MatMultAdd(s->K, U, R, R));
  PetscCall(VecAXPY(R, -1.0, s->f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Jacobian(TS ts, PetscReal t, Vec U, Vec V, Vec A, PetscReal sv, PetscReal sa, Mat J, Mat P, void *ctx)
{
  const Solid *s = (const Solid *)ctx;

  PetscFunctionBegin;
  (void)ts, (void)t, (void)U, (void)V, (void)A, (void)J;
  PetscCall(MatCopy(s->K, P, SAME_NONZERO_PATTERN));
  PetscCall(MatAXPY(P, sa + s->damping * sv, s->M, SAME_NONZERO_PATTERN));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateSolver(Solid *s)
{
  SNES snes;
  KSP ksp;
  PC pc;

  PetscFunctionBegin;
  PetscCall(TSCreate(PETSC_COMM_SELF, &s->ts));
  PetscCall(TSSetOptionsPrefix(s->ts, "plate_"));
  PetscCall(TSSetType(s->ts, TSALPHA2));
  PetscCall(TSAlpha2SetRadius(s->ts, 0.5));
  PetscCall(TSSetI2Function(s->ts, NULL, Residual, s));
  PetscCall(TSSetI2Jacobian(s->ts, s->J, s->J, Jacobian, s));
  PetscCall(TS2SetSolution(s->ts, s->U, s->V));
  PetscCall(TSSetExactFinalTime(s->ts, TS_EXACTFINALTIME_MATCHSTEP));
  PetscCall(TSSetMaxSteps(s->ts, PETSC_MAX_INT));
  PetscCall(TSGetSNES(s->ts, &snes));
  PetscCall(SNESSetType(snes, SNESKSPONLY));
  PetscCall(SNESGetKSP(snes, &ksp));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCLU));
  PetscCall(TSSetFromOptions(s->ts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolidCreate(const char mesh[], Solid *s)
{
  PetscInt p0, p1, dim;

  PetscFunctionBegin;
  PetscCall(DMPlexCreateGmshFromFile(PETSC_COMM_SELF, mesh, PETSC_TRUE, &s->dm));
  PetscCall(DMGetDimension(s->dm, &dim));
  PetscCheck(dim == 2, PETSC_COMM_SELF, PETSC_ERR_SUP, "%s: a mesh of dimension %" PetscInt_FMT "; must be 2", mesh, dim);
  PetscCall(DMPlexGetChart(s->dm, &p0, &p1));
  PetscCall(DMPlexGetHeightStratum(s->dm, 0, &s->c0, &s->c1));
  s->n = p1;
  s->nfree = 0;
  PetscCall(PetscCalloc3(2 * (size_t)s->n, &s->X, 2 * (size_t)s->n, &s->dof, (size_t)(s->c1 - s->c0), &s->cell));
  for (PetscInt c = s->c0; c < s->c1; c++) PetscCall(NumberCell(s, c));
  PetscCall(PlaceNodes(s));
  PetscCall(NumberDisplacements(s));
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, s->nfree, s->nfree, 50, NULL, &s->K));
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, s->nfree, s->nfree, 50, NULL, &s->M)); /* a vertex shares cells with 25 nodes */
  PetscCall(MatCreateVecs(s->K, &s->U, &s->V));
  PetscCall(VecDuplicate(s->U, &s->f));
  PetscCall(VecDuplicate(s->U, &s->weight));
  PetscCall(VecSetOption(s->weight, VEC_IGNORE_NEGATIVE_INDICES, PETSC_TRUE));
  for (PetscInt c = 0; c < s->c1 - s->c0; c++) PetscCall(AssembleCell(s, c));
  PetscCall(MatAssemblyBegin(s->K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(s->K, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyBegin(s->M, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(s->M, MAT_FINAL_ASSEMBLY));
  PetscCall(VecAssemblyBegin(s->weight));
  PetscCall(VecAssemblyEnd(s->weight));
  PetscCall(VecCopy(s->weight, s->f));
  PetscCall(MatDuplicate(s->K, MAT_COPY_VALUES, &s->J));
  PetscCall(CreateSolver(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolidDestroy(Solid *s)
{
  PetscFunctionBegin;
  PetscCall(TSDestroy(&s->ts));
  PetscCall(MatDestroy(&s->M));
  PetscCall(MatDestroy(&s->K));
  PetscCall(MatDestroy(&s->J));
  PetscCall(VecDestroy(&s->U));
  PetscCall(VecDestroy(&s->V));
  PetscCall(VecDestroy(&s->f));
  PetscCall(VecDestroy(&s->weight));
  PetscCall(DMDestroy(&s->dm));
  PetscCall(PetscFree3(s->X, s->dof, s->cell));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Newton's method for the inverse of the map, cell by cell. */
PetscErrorCode SolidFind(const Solid *s, const PetscReal x[2], PetscInt *cell, PetscReal *xi, PetscReal *eta)
{
  PetscFunctionBegin;
  for (*cell = 0; *cell < s->c1 - s->c0; (*cell)++) {
    *xi = *eta = 0.0;
    for (int k = 0; k < 20; k++) {
      PetscReal N[9], dN[9][2], y[2], J[2][2], det, r[2];
      ShapeGradient(*xi, *eta, N, dN);
      Map(s, *cell, N, dN, y, J);
      det = J[0][0] * J[1][1] - J[0][1] * J[1][0];
      for (int i = 0; i < 2; i++) r[i] = x[i] - y[i];
      *xi += (J[1][1] * r[0] - J[0][1] * r[1]) / det;
      *eta += (J[0][0] * r[1] - J[1][0] * r[0]) / det;
    }
    if (PetscAbsReal(*xi) <= 1.0 + 1e-9 && PetscAbsReal(*eta) <= 1.0 + 1e-9) PetscFunctionReturn(PETSC_SUCCESS);
  }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "the point (%g, %g) m lies in no cell of the mesh", (double)x[0],
          (double)x[1]);
}

PetscErrorCode SolidSetLoads(Solid *s, const PetscReal *Q)
{
  PetscScalar *f;

  PetscFunctionBegin;
  PetscCall(VecCopy(s->weight, s->f));
  PetscCall(VecGetArray(s->f, &f));
  for (PetscInt i = 0; i < s->n; i++)
    for (int c = 0; c < 2; c++)
      if (s->dof[2 * i + c] >= 0) f[s->dof[2 * i + c]] += Q[3 * i + c];
  PetscCall(VecRestoreArray(s->f, &f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Simpson's weights 1/6, 4/6, 1/6 are exact for quadratic shape functions. */
PetscErrorCode SolidPressure(Solid *s, PetscInt tag, PetscReal pressure, PetscReal *Q)
{
  IS edges;
  const PetscInt *e, *ends;
  PetscInt n;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(Q, 3 * s->n));
  PetscCall(DMGetStratumIS(s->dm, "Face Sets", tag, &edges));
  PetscCheck(edges, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "the mesh has no curve of the physical number %" PetscInt_FMT, tag);
  PetscCall(ISGetLocalSize(edges, &n));
  PetscCall(ISGetIndices(edges, &e));
  for (PetscInt k = 0; k < n; k++) {
    PetscReal l;
    PetscCall(DMPlexGetCone(s->dm, e[k], &ends));
    l = PetscAbsReal(s->X[2 * ends[1]] - s->X[2 * ends[0]]);
    Q[3 * e[k] + 1] -= pressure * l * 4.0 / 6.0;
    for (int j = 0; j < 2; j++) Q[3 * ends[j] + 1] -= pressure * l / 6.0;
  }
  PetscCall(ISRestoreIndices(edges, &e));
  PetscCall(ISDestroy(&edges));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolidStatic(Solid *s)
{
  KSP ksp;
  PC pc;

  PetscFunctionBegin;
  PetscCall(KSPCreate(PETSC_COMM_SELF, &ksp));
  PetscCall(KSPSetOperators(ksp, s->K, s->K));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCLU));
  PetscCall(KSPSolve(ksp, s->f, s->U));
  PetscCall(KSPDestroy(&ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolidAdvance(Solid *s, PetscReal t)
{
  PetscReal now;

  PetscFunctionBegin;
  PetscCall(TSGetTime(s->ts, &now));
  PetscCall(TSSetTimeStep(s->ts, t - now));
  PetscCall(TSSetMaxTime(s->ts, t));
  PetscCall(TSSolve(s->ts, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}
