/* ancfelement.c - shape functions, elastic force and tangent, mass and uniform load of the ANCF cable element. */
#include "ancfpoint.h"
#include <petscdt.h>

/* Symmetric 3 x 3 blocks are stored xx xy xz yy yz zz; the off-diagonal blocks are (0,1), (0,2), (1,2). */
static const int sym_row[6] = {0, 0, 0, 1, 1, 2}, sym_col[6] = {0, 1, 2, 1, 2, 2};
static const int sym_of[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
static const int off_row[3] = {0, 0, 1}, off_col[3] = {1, 2, 2};

/* Eq. 19 */
void AncfShape(PetscReal xi, PetscReal l, PetscReal S[4])
{
  S[0] = 1 - xi * xi * (3 - 2 * xi);
  S[1] = l * xi * (1 - xi) * (1 - xi);
  S[2] = xi * xi * (3 - 2 * xi);
  S[3] = l * xi * xi * (xi - 1);
}

/* d/dx of Eq. 19 */
void AncfShapeX(PetscReal xi, PetscReal l, PetscReal Sx[4])
{
  Sx[0] = -6 * xi * (1 - xi) / l;
  Sx[1] = (1 - xi) * (1 - 3 * xi);
  Sx[2] = -Sx[0];
  Sx[3] = xi * (3 * xi - 2);
}

/* d2/dx2 of Eq. 19 */
void AncfShapeXX(PetscReal xi, PetscReal l, PetscReal Sxx[4])
{
  Sxx[0] = (12 * xi - 6) / (l * l);
  Sxx[1] = (6 * xi - 4) / l;
  Sxx[2] = -Sxx[0];
  Sxx[3] = (6 * xi - 2) / l;
}

static PetscErrorCode AncfGaussSetUp(AncfGauss *g, PetscInt n)
{
  PetscFunctionBegin;
  PetscCheck(n >= 1 && n <= ANCF_MAX_GAUSS, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "Gauss points per element %" PetscInt_FMT " must be in 1..%d", n, ANCF_MAX_GAUSS);
  g->n = n;
  PetscCall(PetscDTGaussQuadrature(n, 0, 1, g->xi, g->w));
  for (PetscInt q = 0; q < n; q++) {
    PetscReal x = g->xi[q];

    g->s1[q][0] = (1 - x) * (1 - 3 * x);
    g->s1[q][1] = 6 * x * (1 - x);
    g->s1[q][2] = x * (3 * x - 2);
    g->s2[q][0] = 6 * x - 4;
    g->s2[q][1] = 6 - 12 * x;
    g->s2[q][2] = 6 * x - 2;
    for (int i = 0; i < 3; i++) {
      const PetscReal a = g->s1[q][i], b = g->s2[q][i];
      const int r = off_row[i], c = off_col[i];

      g->diag[i][q][0] = a * a;
      g->diag[i][q][1] = a * b;
      g->diag[i][q][2] = b * b;
      g->off[i][q][0] = g->s1[q][r] * g->s1[q][c];
      g->off[i][q][1] = g->s1[q][r] * g->s2[q][c];
      g->off[i][q][2] = g->s2[q][r] * g->s1[q][c];
      g->off[i][q][3] = g->s2[q][r] * g->s2[q][c];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfRuleSetUp(AncfRule *rule, AncfStrain strain, PetscInt naxial, PetscInt nbending)
{
  PetscFunctionBegin;
  rule->strain = strain;
  PetscCall(AncfGaussSetUp(&rule->axial, naxial));
  PetscCall(AncfGaussSetUp(&rule->bending, nbending));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Axial energy density EA f/2 with f(a) = eps^2, a = r'.r': f, df/da, d2f/da2. */
static inline void AxialInvariant(AncfStrain strain, AncfLanes a, AncfLanes f[3])
{
  if (strain == ANCF_STRAIN_PAPER) {
    AncfLanes eps = 0.5 * (a - 1.0);

    f[0] = eps * eps;
    f[1] = eps;
    f[2] = 0.5 - 0.0 * a;
  } else {
    AncfLanes s = LanesSqrt(a), inv = 1.0 / s;

    f[0] = (s - 1.0) * (s - 1.0);
    f[1] = 1.0 - inv;
    f[2] = 0.5 * inv * inv * inv;
  }
}

/* Bending energy density EI g/2 with g = kappa^2 = (a c - b^2)/a^p, a = r'.r', b = r'.r'', c = r''.r'', p = 3 (paper) or 2.
   kappa^2 is smooth where kappa is zero, unlike kappa. */
typedef struct {
  AncfLanes g, a, b, c, aa, ab, ac, bb; /* g and its partial derivatives */
} BendingInvariant;

static inline void BendingGradient(AncfStrain strain, AncfLanes a, AncfLanes b, AncfLanes c, AncfLanes *ip, BendingInvariant *v)
{
  AncfLanes i = 1.0 / a, p = strain == ANCF_STRAIN_PAPER ? i * i * i : i * i; /* a^-p */
  PetscReal n = strain == ANCF_STRAIN_PAPER ? 3 : 2;

  v->g = (a * c - b * b) * p;
  v->a = c * p - n * i * v->g;
  v->b = -2.0 * b * p;
  v->c = a * p;
  ip[0] = i;
  ip[1] = p;
}

static inline void BendingHessian(AncfStrain strain, AncfLanes b, AncfLanes c, const AncfLanes *ip, BendingInvariant *v)
{
  AncfLanes i = ip[0], p = ip[1];
  PetscReal n = strain == ANCF_STRAIN_PAPER ? 3 : 2;

  v->aa = n * p * i * ((n - 1) * c - (n + 1) * b * b * i);
  v->ab = 2.0 * n * b * p * i;
  v->ac = (1 - n) * p;
  v->bb = -2.0 * p;
}

void AncfElementForce(const AncfRule *rule, const AncfSection *s, const AncfLanes e[12], AncfLanes Q[12], AncfLanes *U)
{
  AncfLanes d[3][3], q[3][3], u = {0}, il = 1.0 / s->l, il2 = il * il;

  Scaled(e, s->l, d);
  for (int i = 0; i < 3; i++)
    for (int c = 0; c < 3; c++) q[i][c] = (AncfLanes){0};
  for (PetscInt k = 0; k < rule->axial.n; k++) {
    AncfLanes r1[3], f[3], n, w = rule->axial.w[k] * s->EA;

    Derivative(d, rule->axial.s1[k], il, r1);
    AxialInvariant(rule->strain, Dot(r1, r1), f);
    u += 0.5 * w * s->l * f[0];
    n = w * f[1]; /* dx = l dxi cancels the 1/l of S' */
    for (int i = 0; i < 3; i++)
      for (int c = 0; c < 3; c++) q[i][c] += rule->axial.s1[k][i] * n * r1[c];
  }
  for (PetscInt k = 0; k < rule->bending.n; k++) {
    AncfLanes r1[3], r2[3], ip[2], w = 0.5 * rule->bending.w[k] * s->EI;
    BendingInvariant v;

    Derivative(d, rule->bending.s1[k], il, r1);
    Derivative(d, rule->bending.s2[k], il2, r2);
    BendingGradient(rule->strain, Dot(r1, r1), Dot(r1, r2), Dot(r2, r2), ip, &v);
    u += w * s->l * v.g;
    for (int c = 0; c < 3; c++) {
      AncfLanes g1 = w * (2.0 * v.a * r1[c] + v.b * r2[c]);
      AncfLanes g2 = w * (v.b * r1[c] + 2.0 * v.c * r2[c]) * il;

      for (int i = 0; i < 3; i++) q[i][c] += rule->bending.s1[k][i] * g1 + rule->bending.s2[k][i] * g2;
    }
  }
  ForceExpand(q, s->l, Q);
  if (U) *U = u;
}

/* Second derivatives of the energy at one Gauss point, weights and powers of l included: A by r', r' (symmetric), B by r', r''
   (full), C by r'', r'' (symmetric), and S = B + B^T. */
typedef struct {
  AncfLanes A[6], B[9], C[6], S[6];
} PointBlocks;

/* Point k: adds its part of the force to q, and returns the blocks. */
static inline void BendingPoint(const AncfRule *rule, const AncfSection *s, PetscInt k, AncfLanes d[3][3], AncfLanes il,
                                AncfLanes q[3][3], PointBlocks *p)
{
  const PetscReal *s1 = rule->bending.s1[k], *s2 = rule->bending.s2[k];
  const AncfLanes w = 0.5 * rule->bending.w[k] * s->EI, wA = w * il, wB = wA * il, wC = wB * il;
  AncfLanes r1[3], r2[3], ip[2], b, c;
  BendingInvariant v;

  Derivative(d, s1, il, r1);
  Derivative(d, s2, il * il, r2);
  b = Dot(r1, r2);
  c = Dot(r2, r2);
  BendingGradient(rule->strain, Dot(r1, r1), b, c, ip, &v);
  BendingHessian(rule->strain, b, c, ip, &v);
  ANCF_UNROLL
  for (int m = 0; m < 3; m++) {
    const AncfLanes g1 = w * (2.0 * v.a * r1[m] + v.b * r2[m]), g2 = wA * (v.b * r1[m] + 2.0 * v.c * r2[m]);

    for (int i = 0; i < 3; i++) q[i][m] += s1[i] * g1 + s2[i] * g2;
  }
  const AncfLanes aaA = 4.0 * wA * v.aa, abA = 2.0 * wA * v.ab, bbA = wA * v.bb, abB = 2.0 * wB * v.ab, acB = 4.0 * wB * v.ac,
                  bbB = wB * v.bb, bbC = wC * v.bb;

  ANCF_UNROLL
  for (int m = 0; m < 6; m++) {
    const int i = sym_row[m], j = sym_col[m];
    const AncfLanes r11 = r1[i] * r1[j];

    p->A[m] = aaA * r11 + abA * (r1[i] * r2[j] + r2[i] * r1[j]) + bbA * r2[i] * r2[j];
    p->C[m] = bbC * r11;
  }
  ANCF_UNROLL
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) p->B[3 * i + j] = abB * r1[i] * r1[j] + acB * r1[i] * r2[j] + bbB * r2[i] * r1[j];
    p->A[sym_of[i][i]] += 2.0 * wA * v.a;
    p->B[4 * i] += wB * v.b;
    p->C[sym_of[i][i]] += 2.0 * wC * v.c;
  }
  ANCF_UNROLL
  for (int m = 0; m < 6; m++) p->S[m] = p->B[3 * sym_row[m] + sym_col[m]] + p->B[3 * sym_col[m] + sym_row[m]];
}

/* The same of the axial energy, EA (f' I + 2 f'' r' r'^T), added to A. */
static inline void AxialPoint(const AncfRule *rule, const AncfSection *s, PetscInt k, AncfLanes d[3][3], AncfLanes il,
                              AncfLanes q[3][3], AncfLanes A[6])
{
  const PetscReal *s1 = rule->axial.s1[k];
  const AncfLanes w = rule->axial.w[k] * s->EA;
  AncfLanes r1[3], f[3], n, t;

  Derivative(d, s1, il, r1);
  AxialInvariant(rule->strain, Dot(r1, r1), f);
  n = w * f[1];
  for (int c = 0; c < 3; c++) {
    const AncfLanes nr = n * r1[c];

    for (int i = 0; i < 3; i++) q[i][c] += s1[i] * nr;
  }
  t = 2.0 * w * il * f[2];
  ANCF_UNROLL
  for (int m = 0; m < 6; m++) A[m] += t * r1[sym_row[m]] * r1[sym_col[m]];
  for (int i = 0; i < 3; i++) A[sym_of[i][i]] += n * il;
}

/* K_ij += sum over points of S'_i S'_j A + S'_i S''_j B + S''_i S'_j B^T + S''_i S''_j C, one sum in registers at a time. */
static inline __attribute__((always_inline)) void BlocksToTangent(const AncfGauss *g, const int n, const PointBlocks *p,
                                                                  AncfLanes K[ANCF_TANGENT])
{
  ANCF_UNROLL for (int m = 0; m < 6; m++) for (int i = 0; i < 3; i++)
  {
    AncfLanes k = {0};

    ANCF_UNROLL for (int q = 0; q < n; q++) k +=
        g->diag[i][q][0] * p[q].A[m] + g->diag[i][q][1] * p[q].S[m] + g->diag[i][q][2] * p[q].C[m];
    K[6 * i + m] = k;
  }
  ANCF_UNROLL for (int m = 0; m < 9; m++) for (int t = 0; t < 3; t++)
  {
    const int sym = sym_of[m / 3][m % 3], mt = 3 * (m % 3) + m / 3;
    AncfLanes k = {0};

    ANCF_UNROLL for (int q = 0; q < n; q++) k += g->off[t][q][0] * p[q].A[sym] + g->off[t][q][1] * p[q].B[m] +
                                                 g->off[t][q][2] * p[q].B[mt] + g->off[t][q][3] * p[q].C[sym];
    K[18 + 9 * t + m] = k;
  }
}

/* Axial points of their own: only S'_i S'_j A. */
static inline void AxialTangent(const AncfRule *rule, const AncfSection *s, AncfLanes d[3][3], AncfLanes il, AncfLanes q[3][3],
                                AncfLanes K[ANCF_TANGENT])
{
  for (PetscInt k = 0; k < rule->axial.n; k++) {
    const PetscReal *s1 = rule->axial.s1[k];
    AncfLanes A[6] = {{0}};

    AxialPoint(rule, s, k, d, il, q, A);
    for (int m = 0; m < 6; m++)
      for (int i = 0; i < 3; i++) K[6 * i + m] += s1[i] * s1[i] * A[m];
    for (int t = 0; t < 3; t++)
      for (int m = 0; m < 9; m++) K[18 + 9 * t + m] += s1[off_row[t]] * s1[off_col[t]] * A[sym_of[m / 3][m % 3]];
  }
}

void AncfElementTangent(const AncfRule *rule, const AncfSection *s, const AncfLanes e[12], AncfLanes Q[12],
                        AncfLanes K[ANCF_TANGENT])
{
  const PetscInt n = PetscMax(rule->bending.n, 1); /* never below 1: the compiler sees that p is filled */
  const AncfLanes il = 1.0 / s->l, l = s->l, l2 = l * l;
  AncfLanes d[3][3], q[3][3];
  PointBlocks p[ANCF_MAX_GAUSS];

  Scaled(e, l, d);
  for (int i = 0; i < 3; i++)
    for (int c = 0; c < 3; c++) q[i][c] = (AncfLanes){0};
  for (PetscInt k = 0; k < n; k++) {
    BendingPoint(rule, s, k, d, il, q, &p[k]);
    if (rule->axial.n == n) AxialPoint(rule, s, k, d, il, q, p[k].A); /* the same points: one sum */
  }
  if (n == 3)
    BlocksToTangent(&rule->bending, 3, p, K);
  else
    BlocksToTangent(&rule->bending, (int)n, p, K);
  if (rule->axial.n != n) AxialTangent(rule, s, d, il, q, K);
  ForceExpand(q, l, Q);
  for (int m = 0; m < 6; m++) {
    K[m] *= l2;
    K[12 + m] *= l2;
  }
  for (int m = 0; m < 9; m++) {
    K[18 + m] *= l;
    K[27 + m] *= l2;
    K[36 + m] *= l;
  }
}

void AncfTangentExpand(const AncfLanes K[ANCF_TANGENT], PetscInt lane, PetscReal k[144])
{
  for (int b = 0; b < 3; b++)
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) k[12 * (3 * b + 3 + i) + 3 * b + 3 + j] = K[6 * b + sym_of[i][j]][lane];
  for (int b = 0; b < 3; b++)
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) {
        int r = 3 * off_row[b] + 3 + i, c = 3 * off_col[b] + 3 + j;
        k[12 * r + c] = k[12 * c + r] = K[18 + 9 * b + 3 * i + j][lane];
      }
  for (int i = 0; i < 3; i++) {
    for (int j = 3; j < 12; j++) k[12 * i + j] = k[12 * j + i] = -k[12 * (6 + i) + j];
    for (int j = 0; j < 3; j++) k[12 * i + j] = k[12 * (6 + i) + 6 + j];
  }
}

/* Integral of S_i S_j over the element with unit length and scaled gradients, times 420. */
static const PetscReal mass_table[16] = {156, 22, 54, -13, 22, 4, 13, -3, 54, 13, 156, -22, -13, -3, -22, 4};

void AncfElementInertia(AncfLanes rhoA, AncfLanes l, const AncfLanes a[12], AncfLanes Q[12])
{
  const AncfLanes s = rhoA * l / 420.0;

  for (int c = 0; c < 3; c++) {
    AncfLanes b[4] = {a[c], l * a[3 + c], a[6 + c], l * a[9 + c]};

    for (int i = 0; i < 4; i++) {
      AncfLanes f = s * (mass_table[4 * i] * b[0] + mass_table[4 * i + 1] * b[1] + mass_table[4 * i + 2] * b[2] +
                         mass_table[4 * i + 3] * b[3]);

      Q[3 * i + c] += i % 2 ? l * f : f;
    }
  }
}

void AncfElementMass(PetscReal rhoA, PetscReal l, PetscReal m[16])
{
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) m[4 * i + j] = mass_table[4 * i + j] * rhoA * l / 420 * (i % 2 ? l : 1) * (j % 2 ? l : 1);
}

void AncfElementLoad(PetscReal l, PetscReal w[4])
{
  w[0] = w[2] = l / 2;
  w[1] = l * l / 12;
  w[3] = -w[1];
}
