/*
  ancfelement.h - mathematics of one gradient-deficient ANCF cable element: no Vec, no Mat, no allocation.

  Source: Pazouki, Serban, Negrut, Eqs. 18-24; Gerstmayr and Shabana, Nonlinear Dynamics 45 (2006) 109-130.
  Element coordinates e[12] = (r_0, r_0,x, r_1, r_1,x): positions in m, gradients dimensionless. Generalised forces are
  N for positions and N m for gradients.

  Everything that is evaluated in the inner loops works on ANCF_LANES elements at a time, one element per vector lane, so
  that each equation is written once, as for scalars, and compiles to SIMD code.
*/
#ifndef ANCFELEMENT_H
#define ANCFELEMENT_H

#include "ancf.h"

#define ANCF_LANES 8
#define ANCF_MAX_GAUSS 8
/* Loops over the entries of 3 x 3 blocks, whose indices must be known to the compiler. */
#define ANCF_UNROLL _Pragma("GCC unroll 9")
typedef PetscReal AncfLanes __attribute__((vector_size(ANCF_LANES * sizeof(PetscReal))));

/* Gauss points on [0,1] with weights and the derivatives of the shape functions in xi. The element length enters through
   scaled gradients l r_x, hence the dimensionless table serves every element. Only functions 2..4 are kept: S1 = 1 - S3. */
typedef struct {
  PetscInt n;
  PetscReal xi[ANCF_MAX_GAUSS], w[ANCF_MAX_GAUSS];
  PetscReal s1[ANCF_MAX_GAUSS][3];                                 /* dS/dxi   of l r_0,x, r_1, l r_1,x */
  PetscReal s2[ANCF_MAX_GAUSS][3];                                 /* d2S/dxi2 */
  PetscReal diag[3][ANCF_MAX_GAUSS][3], off[3][ANCF_MAX_GAUSS][4]; /* products S'S', S'S'', S''S' of the tangent's blocks */
} AncfGauss;

typedef struct {
  AncfStrain strain;
  AncfGauss axial, bending;
} AncfRule;

typedef struct {
  AncfLanes EA, EI, l; /* N, N m^2, m */
} AncfSection;

/* Independent entries of the 12 x 12 tangent: because S1 = 1 - S3, rows and columns of r_0 are minus those of r_1.
   Blocks with a = r_0,x, b = r_1, c = r_1,x: aa, bb, cc symmetric (xx xy xz yy yz zz), ab, ac, bc full (row-major). */
#define ANCF_TANGENT 45

extern PetscErrorCode AncfRuleSetUp(AncfRule *rule, AncfStrain strain, PetscInt naxial, PetscInt nbending);

/* Energy (J), and elastic force (Eq. 22) of ANCF_LANES elements; U may be NULL. */
extern void AncfElementForce(const AncfRule *rule, const AncfSection *s, const AncfLanes e[12], AncfLanes Q[12], AncfLanes *U);
/* The same force and its exact derivative. */
extern void AncfElementTangent(const AncfRule *rule, const AncfSection *s, const AncfLanes e[12], AncfLanes Q[12],
                               AncfLanes K[ANCF_TANGENT]);
/* Full 12 x 12 row-major tangent of one lane. */
extern void AncfTangentExpand(const AncfLanes K[ANCF_TANGENT], PetscInt lane, PetscReal k[144]);

/* Q += M a with the consistent mass (Eq. 21) of ANCF_LANES elements; rhoA in kg/m, l in m. */
extern void AncfElementInertia(AncfLanes rhoA, AncfLanes l, const AncfLanes a[12], AncfLanes Q[12]);
/* That mass is m (x) I_3 with this symmetric 4 x 4 m, row-major. */
extern void AncfElementMass(PetscReal rhoA, PetscReal l, PetscReal m[16]);
/* Integral of S1..S4 over the element, m (S1, S3) and m^2 (S2, S4): a uniform line load q gives Q_i = w_i q (Eq. 24). */
extern void AncfElementLoad(PetscReal l, PetscReal w[4]);

#endif
