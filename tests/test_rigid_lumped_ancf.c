/*
  test_rigid_lumped_ancf.c - lumped-elasticity beams against ANCF beams: the static cantilever of Capasso et al. (Table 1) and the
  seed's cantilever swinging down from the horizontal. Two independent models of one beam: lumped results, extrapolated in
  1/N^2 from two numbers of trunks, must meet the ANCF ones.
*/
#include "ancf.h"
#include "rigid.h"
#include "testing.h"

static const char help[] = "Lumped beams against ANCF beams.\n";

/* d: of the section that the lumped trunks take their rotary inertia from, small; E I and rho A are given. */
typedef struct {
  PetscReal L, d, EI, EA, rhoA, g;
} Beam;

static PetscErrorCode AncfBeam(const Beam *b, PetscInt elements, Ancf *ancf)
{
  AncfBeamSpec s;
  const PetscReal g[3] = {0., 0., -b->g};

  PetscFunctionBegin;
  PetscCall(AncfCreate(PETSC_COMM_SELF, ancf));
  PetscCall(AncfBeamSpecInit(&s));
  for (int k = 0; k < 3; k++) s.start[k] = s.end[k] = s.velocity[k] = 0.;
  s.end[0] = b->L;
  s.elements = elements;
  s.diameter = b->d;
  s.density = 1000.;
  s.young = 1e6;
  s.EI = b->EI, s.EA = b->EA, s.rhoA = b->rhoA;
  s.end0 = ANCF_END_CLAMP, s.end1 = ANCF_END_FREE;
  PetscCall(AncfAddBeam(*ancf, &s, NULL));
  PetscCall(AncfSetGravity(*ancf, g));
  PetscCall(AncfSetFromOptions(*ancf));
  PetscCall(AncfSetUp(*ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LumpedBeam(const Beam *b, PetscInt N, PetscReal damping, Rigid *r)
{
  RigidLumpedSpec s;
  const PetscReal g[3] = {0., 0., -b->g};

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, r));
  PetscCall(RigidSetGravity(*r, g));
  PetscCall(RigidLumpedSpecInit(&s));
  s.end[0] = b->L;
  s.trunks = N;
  s.section[0] = b->d;
  s.EI = b->EI, s.rhoA = b->rhoA;
  s.end0 = RIGID_END_CLAMP;
  s.damping = damping;
  PetscCall(RigidAddLumpedBeam(*r, &s, NULL, NULL));
  PetscCall(RigidSetUp(*r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Tip(Ancf ancf, PetscInt elements, PetscReal x[3])
{
  const PetscReal *e;
  PetscReal t;

  PetscFunctionBegin;
  PetscCall(AncfGetState(ancf, &t, &e, NULL, NULL));
  for (int k = 0; k < 3; k++) x[k] = e[6 * elements + k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Table 1. The lumped error is 1/N^2 with a remainder of order 1/N^4 at most; ANCF with 16 cubic elements is 1e-5 off. */
static PetscErrorCode TestStatic(void)
{
  const Beam b = {.079, .005, 6.25e-4, 300., .0275, 9.81};
  Ancf ancf;
  PetscReal x[3 * 21], tip[3], z[2];

  PetscFunctionBegin;
  PetscCall(AncfBeam(&b, 16, &ancf));
  PetscCall(AncfSolveStatic(ancf, 1));
  PetscCall(Tip(ancf, 16, tip));
  PetscCall(AncfDestroy(&ancf));
  for (int m = 0; m < 2; m++) {
    Rigid r;
    const PetscInt N = 10 << m;
    PetscCall(LumpedBeam(&b, N, .08, &r));
    for (int n = 1; n <= 800; n++) { /* the weight grows over 0.6 s, high modes stay quiet */
      const PetscReal t = PetscMin(1., n / 600.), g[3] = {0., 0., -9.81 * t * t * t * (10. + t * (6. * t - 15.))};
      PetscCall(RigidSetGravity(r, g));
      PetscCall(RigidAdvance(r, n * 2e-3));
    }
    PetscCall(RigidGetLumpedNodes(r, 0, N, x));
    z[m] = x[3 * N + 2];
    PetscCall(RigidDestroy(&r));
  }
  printf("static cantilever: ANCF %.6f mm, lumped N = 10 %.6f, 20 %.6f, extrapolated %.6f mm\n", tip[2] * 1e3, z[0] * 1e3,
         z[1] * 1e3, (4. * z[1] - z[0]) / 3. * 1e3);
  TEST_REL((4. * z[1] - z[0]) / 3., tip[2], 3e-4, "tip"); /* axial strain of the ANCF beam: q L/EA (z/L) = 7e-5 L, (z/L)^2/2
                                                             = 3.5e-4 of L enter at their squares or times z/L */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Seed beam (L 1 m, EI 2.513274 N m^2, 9.047787 kg/m) without axial strain: EA 100 times the seed's; section too thin for rotary
 * inertia. */
static PetscErrorCode TestSwing(void)
{
  const Beam b = {1., .004, 2.513274, 2.513274e6, 9.047787, 9.81};
  const PetscInt elements[2] = {24, 48}, N[2] = {20, 40};
  const PetscReal dt = 1e-3;
  Ancf ancf[2];
  Rigid r[2];
  PetscReal x[2][3 * 41], coarse[3], tip[3], worst[4] = {0., 0., 0., 0.};

  PetscFunctionBegin;
  for (int m = 0; m < 2; m++) PetscCall(AncfBeam(&b, elements[m], &ancf[m]));
  for (int m = 0; m < 2; m++) PetscCall(LumpedBeam(&b, N[m], 0., &r[m]));
  for (int n = 1; n <= 800; n++) {
    for (int m = 0; m < 2; m++) PetscCall(AncfAdvance(ancf[m], n * dt));
    for (int m = 0; m < 2; m++) PetscCall(RigidAdvance(r[m], n * dt));
    if (n % 20) continue;
    PetscCall(Tip(ancf[0], elements[0], coarse));
    PetscCall(Tip(ancf[1], elements[1], tip));
    for (int m = 0; m < 2; m++) PetscCall(RigidGetLumpedNodes(r[m], 0, N[m], x[m]));
    for (int k = 0; k < 3; k += 2) {
      const PetscReal a = x[0][3 * N[0] + k], c = x[1][3 * N[1] + k];
      worst[0] = PetscMax(worst[0], fabs(a - tip[k]));
      worst[1] = PetscMax(worst[1], fabs(c - tip[k]));
      worst[2] = PetscMax(worst[2], fabs((4. * c - a) / 3. - tip[k]));
      worst[3] = PetscMax(worst[3], fabs(coarse[k] - tip[k]));
    }
    if (n % 200 == 0)
      printf("t = %.1f s: ANCF %.5f %.5f, lumped N = 40 %.5f %.5f\n", n * dt, tip[0], tip[2], x[1][3 * N[1]], x[1][3 * N[1] + 2]);
  }
  printf("swing to .8 s: largest tip difference from ANCF, N = 20 %.2e, N = 40 %.2e, extrapolated %.2e; ANCF 24 from 48 elements "
         "%.2e m\n",
         worst[0], worst[1], worst[2], worst[3]);
  TEST(worst[1] < .4 * worst[0], "N = 40 is no closer: %g, %g", worst[0], worst[1]);
  /* ANCF's own error, of second order in its elements at least, is a third of what they change it by from 24 to 48 */
  TEST(worst[2] < worst[3] / 3., "extrapolated tip off by %g m, ANCF by about %g m", worst[2], worst[3] / 3.);
  for (int m = 0; m < 2; m++) PetscCall(AncfDestroy(&ancf[m]));
  for (int m = 0; m < 2; m++) PetscCall(RigidDestroy(&r[m]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, help));
  PetscCall(TestStatic());
  PetscCall(TestSwing());
  PetscCall(PetscFinalize());
  return test_report();
}
