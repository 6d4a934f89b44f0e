/* test_ancf_element.c - force, tangent, mass and load of the ANCF cable element against independent checks. */
#include "ancf_common.h"
#include "ancfelement.h"
#include <petscdt.h>

static void Fill(AncfLanes *x, double v)
{
  for (int i = 0; i < ANCF_LANES; i++) (*x)[i] = v;
}

/* A different element in each lane: sections, lengths, orientations and finite deformations of order `size`. */
static void RandomElements(double size, AncfSection *s, AncfLanes e[12])
{
  for (int i = 0; i < ANCF_LANES; i++) {
    double t[3] = {Random(), Random(), Random()}, n = sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);

    s->EA[i] = 2 + Random();
    s->EI[i] = 0.3 + 0.2 * Random();
    s->l[i] = 0.8 + 0.5 * Random();
    for (int c = 0; c < 3; c++) {
      e[c][i] = Random();
      e[3 + c][i] = t[c] / n + size * Random();
      e[6 + c][i] = e[c][i] + s->l[i] * (t[c] / n + size * Random());
      e[9 + c][i] = t[c] / n + size * Random();
    }
  }
}

/* Energy by the formulas of the paper as they stand, with kappa itself and 20 Gauss points; engineering measures likewise. */
static double EnergyDirect(AncfStrain strain, double EA, double EI, double l, const double e[12], int n)
{
  double x[20], w[20], U = 0;

  PetscCallAbort(PETSC_COMM_SELF, PetscDTGaussQuadrature(n, 0, 1, x, w));
  for (int q = 0; q < n; q++) {
    double z = x[q], Sx[4] = {(-6 * z + 6 * z * z) / l, 1 - 4 * z + 3 * z * z, (6 * z - 6 * z * z) / l, -2 * z + 3 * z * z};
    double Sxx[4] = {(-6 + 12 * z) / (l * l), (-4 + 6 * z) / l, (6 - 12 * z) / (l * l), (-2 + 6 * z) / l};
    double a[3] = {0}, b[3] = {0}, cr[3], na, eps, kappa;

    for (int i = 0; i < 4; i++)
      for (int c = 0; c < 3; c++) {
        a[c] += Sx[i] * e[3 * i + c];
        b[c] += Sxx[i] * e[3 * i + c];
      }
    for (int c = 0; c < 3; c++) cr[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
    na = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    kappa = sqrt(cr[0] * cr[0] + cr[1] * cr[1] + cr[2] * cr[2]) / (strain == ANCF_STRAIN_PAPER ? na * na * na : na * na);
    eps = strain == ANCF_STRAIN_PAPER ? (na * na - 1) / 2 : na - 1;
    U += 0.5 * w[q] * l * (EA * eps * eps + EI * kappa * kappa);
  }
  return U;
}

static void TestEnergy(AncfStrain strain)
{
  AncfRule rule;
  AncfSection s;
  AncfLanes e[12], Q[12], U;

  PetscCallAbort(PETSC_COMM_SELF, AncfRuleSetUp(&rule, strain, 6, 6));
  RandomElements(0.3, &s, e);
  AncfElementForce(&rule, &s, e, Q, &U);
  for (int i = 0; i < ANCF_LANES; i++) {
    double x[12];

    for (int c = 0; c < 12; c++) x[c] = e[c][i];
    /* same quadrature, other formulas: round-off only */
    TEST_REL(U[i], EnergyDirect(strain, s.EA[i], s.EI[i], s.l[i], x, 6), 1e-13, "energy against Eqs. 22 as printed");
  }
}

/* Fourth-order central differences with step h: error h^4 f^(5)/30 = 5e-17 f^(5), where five powers of 1/|r'| and 1/l make
   f^(5) up to 1e6 f'; round-off 1e-16/h = 5e-13. */
static void TestDerivatives(AncfStrain strain, double size, const char name[])
{
  const double h = 2e-4, tol = 1e-9;
  AncfRule rule;
  AncfSection s;
  AncfLanes e[12], Q[12], Q2[12], K[ANCF_TANGENT], U, F[4][12], E[4];
  double worstQ = 0, worstK = 0, worstsame = 0;

  PetscCallAbort(PETSC_COMM_SELF, AncfRuleSetUp(&rule, strain, 5, 4));
  RandomElements(size, &s, e);
  AncfElementForce(&rule, &s, e, Q, &U);
  AncfElementTangent(&rule, &s, e, Q2, K);
  for (int j = 0; j < 12; j++) {
    static const double step[4] = {-2, -1, 1, 2};
    AncfLanes keep = e[j];

    for (int k = 0; k < 4; k++) {
      e[j] = keep + step[k] * h;
      AncfElementForce(&rule, &s, e, F[k], &E[k]);
    }
    e[j] = keep;
    for (int i = 0; i < ANCF_LANES; i++) {
      double full[144], scaleK = 0, d;

      AncfTangentExpand(K, i, full);
      for (int r = 0; r < 144; r++) scaleK = fmax(scaleK, fabs(full[r]));
      d = (E[0][i] - 8 * E[1][i] + 8 * E[2][i] - E[3][i]) / (12 * h);
      worstQ = fmax(worstQ, fabs(d - Q[j][i]) / scaleK);
      worstsame = fmax(worstsame, fabs(Q[j][i] - Q2[j][i]) / scaleK);
      for (int r = 0; r < 12; r++) {
        d = (F[0][r][i] - 8 * F[1][r][i] + 8 * F[2][r][i] - F[3][r][i]) / (12 * h);
        worstK = fmax(worstK, fabs(d - full[12 * r + j]) / scaleK);
        TEST_NEAR(full[12 * r + j], full[12 * j + r], 0, "tangent symmetry");
      }
    }
  }
  printf("%-32s force - dU/de %.1e, tangent - dQ/de %.1e (relative to the largest stiffness)\n", name, worstQ, worstK);
  TEST(worstQ < tol, "%s: force is not the gradient of the energy: %g", name, worstQ);
  TEST(worstK < tol, "%s: tangent is not the derivative of the force: %g", name, worstK);
  TEST(worstsame < 1e-14, "%s: two force evaluations differ by %g", name, worstsame);
}

/* Energy unchanged, force rotated by any rigid motion. */
static void TestObjectivity(AncfStrain strain)
{
  AncfRule rule;
  AncfSection s;
  AncfLanes e[12], x[12], Q[12], P[12], U, W;
  double q[4] = {0.3, -0.5, 0.7, 0.2}, n = 0, R[9], shift[3] = {3, -2, 5};

  for (int i = 0; i < 4; i++) n += q[i] * q[i];
  for (int i = 0; i < 4; i++) q[i] /= sqrt(n);
  R[0] = 1 - 2 * (q[2] * q[2] + q[3] * q[3]), R[1] = 2 * (q[1] * q[2] - q[0] * q[3]), R[2] = 2 * (q[1] * q[3] + q[0] * q[2]);
  R[3] = 2 * (q[1] * q[2] + q[0] * q[3]), R[4] = 1 - 2 * (q[1] * q[1] + q[3] * q[3]), R[5] = 2 * (q[2] * q[3] - q[0] * q[1]);
  R[6] = 2 * (q[1] * q[3] - q[0] * q[2]), R[7] = 2 * (q[2] * q[3] + q[0] * q[1]), R[8] = 1 - 2 * (q[1] * q[1] + q[2] * q[2]);
  PetscCallAbort(PETSC_COMM_SELF, AncfRuleSetUp(&rule, strain, 5, 4));
  RandomElements(0.3, &s, e);
  for (int i = 0; i < 4; i++)
    for (int r = 0; r < 3; r++) {
      x[3 * i + r] = R[3 * r] * e[3 * i] + R[3 * r + 1] * e[3 * i + 1] + R[3 * r + 2] * e[3 * i + 2];
      if (i % 2 == 0) x[3 * i + r] += shift[r];
    }
  AncfElementForce(&rule, &s, e, Q, &U);
  AncfElementForce(&rule, &s, x, P, &W);
  for (int k = 0; k < ANCF_LANES; k++) {
    double force[3] = {0}, moment[3] = {0}, scale = 0;

    TEST_REL(W[k], U[k], 1e-12, "energy under a rigid motion");
    for (int r = 0; r < 12; r++) scale = fmax(scale, fabs(Q[r][k]));
    for (int i = 0; i < 4; i++)
      for (int r = 0; r < 3; r++) {
        double y = R[3 * r] * Q[3 * i][k] + R[3 * r + 1] * Q[3 * i + 1][k] + R[3 * r + 2] * Q[3 * i + 2][k];

        TEST_NEAR(P[3 * i + r][k], y, 1e-12 * scale, "force under a rigid motion");
        if (i % 2 == 0) force[r] += Q[3 * i + r][k];
        moment[r] +=
            e[3 * i + (r + 1) % 3][k] * Q[3 * i + (r + 2) % 3][k] - e[3 * i + (r + 2) % 3][k] * Q[3 * i + (r + 1) % 3][k];
      }
    for (int r = 0; r < 3; r++) {
      TEST_NEAR(force[r], 0, 1e-13 * scale, "internal forces have no resultant");
      TEST_NEAR(moment[r], 0, 1e-12 * scale, "internal forces have no moment");
    }
  }
}

/* Straight elements, stretched and not: all finite, bending force zero, the small-deflection stiffness of a cubic beam. */
static void TestStraight(AncfStrain strain)
{
  /* Hermite beam stiffness EI/l^3 [12 6l -12 6l; 6l 4l2 -6l 2l2; ...] acts on transverse displacement and slope. */
  const double EI = 0.7, EA = 11, l = 0.6;
  const double ref[16] = {12,  6 * l,  -12, 6 * l,  6 * l, 4 * l * l, -6 * l, 2 * l * l,
                          -12, -6 * l, 12,  -6 * l, 6 * l, 2 * l * l, -6 * l, 4 * l * l};
  AncfRule rule;
  AncfSection s;
  AncfLanes e[12], Q[12], K[ANCF_TANGENT];
  double k[144];

  PetscCallAbort(PETSC_COMM_SELF, AncfRuleSetUp(&rule, strain, 5, 4));
  Fill(&s.EA, EA);
  Fill(&s.EI, EI);
  Fill(&s.l, l);
  for (int c = 0; c < 12; c++) Fill(&e[c], c == 3 || c == 9 ? 1 : c == 6 ? l : 0);
  AncfElementTangent(&rule, &s, e, Q, K);
  AncfTangentExpand(K, 3, k);
  for (int c = 0; c < 12; c++) TEST_NEAR(Q[c][0], 0, 1e-13, "a straight element is free of force");
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      TEST_NEAR(k[12 * (3 * i + 2) + 3 * j + 2], EI / (l * l * l) * ref[4 * i + j], 1e-11, "Hermite bending stiffness");
}

static void TestMass(void)
{
  const double rhoA = 2.3, l = 0.7;
  double x[8], w[8], m[16], load[4], S[4], lw[4] = {0}, ref[16] = {0};
  AncfLanes a[12], Q[12], r, ll;

  PetscCallAbort(PETSC_COMM_SELF, PetscDTGaussQuadrature(8, 0, 1, x, w)); /* exact to degree 15; the integrand has 6 */
  for (int q = 0; q < 8; q++) {
    AncfShape(x[q], l, S);
    for (int i = 0; i < 4; i++) {
      lw[i] += w[q] * l * S[i];
      for (int j = 0; j < 4; j++) ref[4 * i + j] += rhoA * w[q] * l * S[i] * S[j];
    }
  }
  AncfElementMass(rhoA, l, m);
  AncfElementLoad(l, load);
  for (int i = 0; i < 16; i++) TEST_NEAR(m[i], ref[i], 1e-14, "consistent mass against quadrature");
  for (int i = 0; i < 4; i++) TEST_NEAR(load[i], lw[i], 1e-15, "uniform load against quadrature");
  for (int c = 0; c < 12; c++) {
    Fill(&a[c], Random());
    Fill(&Q[c], 1);
  }
  Fill(&r, rhoA);
  Fill(&ll, l);
  AncfElementInertia(r, ll, a, Q);
  for (int i = 0; i < 4; i++)
    for (int c = 0; c < 3; c++) {
      double y = 1;

      for (int j = 0; j < 4; j++) y += ref[4 * i + j] * a[3 * j + c][5];
      TEST_NEAR(Q[3 * i + c][5], y, 1e-14, "Q += M a");
    }
}

static void TestShape(void)
{
  const double l = 0.9, h = 1e-6;

  for (int k = 0; k <= 10; k++) {
    double x = 0.1 * k, S[4], Sx[4], Sp[4], Sm[4];

    AncfShape(x, l, S);
    AncfShapeX(x, l, Sx);
    TEST_NEAR(S[0] + S[2], 1, 1e-15, "S1 + S3 = 1");
    TEST_NEAR(S[1] + l * S[2] + S[3], x * l, 1e-15, "a straight unit-gradient element is reproduced");
    AncfShape(x + h, l, Sp);
    AncfShape(x - h, l, Sm);
    for (int i = 0; i < 4; i++) TEST_NEAR(Sx[i], (Sp[i] - Sm[i]) / (2 * h * l), 1e-9, "dS/dx"); /* h^2 and 1e-16/h */
  }
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  TestShape();
  TestMass();
  for (AncfStrain s = ANCF_STRAIN_PAPER; s <= ANCF_STRAIN_ENGINEERING; s++) {
    TestEnergy(s);
    TestDerivatives(s, 0.3, s ? "engineering, finite deformation" : "paper, finite deformation");
    TestDerivatives(s, 0, s ? "engineering, straight" : "paper, straight");
    TestObjectivity(s);
    TestStraight(s);
  }
  PetscCall(PetscFinalize());
  return test_report();
}
