/* outside.c - a free beam and a free ball fall for 0.1 s: z = -g t^2 / 2, exact for both integrators' second order. */
#include <frond/couple.h>
#include <frond/sphfill.h>
#include <math.h>
#include <stdio.h>

static PetscErrorCode fall(PetscReal *beam, PetscReal *ball)
{
  const PetscReal g[3] = {0, 0, -9.81}, *e;
  PetscReal X[3];
  AncfBeamSpec spec;
  RigidBodySpec body;
  Ancf ancf;
  Rigid rigid;

  PetscFunctionBegin;
  PetscCall(AncfCreate(PETSC_COMM_SELF, &ancf));
  PetscCall(AncfBeamSpecInit(&spec));
  spec.end[0] = 1;
  spec.elements = 2;
  spec.diameter = 0.04;
  spec.density = 7200;
  spec.young = 2e7;
  PetscCall(AncfAddBeam(ancf, &spec, NULL));
  PetscCall(AncfSetGravity(ancf, g));
  PetscCall(AncfSetFromOptions(ancf));
  PetscCall(AncfSetUp(ancf));
  PetscCall(RigidCreate(PETSC_COMM_SELF, &rigid));
  PetscCall(RigidBodySpecInit(&body));
  body.shape = RIGID_SPHERE;
  body.motion = RIGID_FREE;
  body.size[0] = 0.1;
  body.density = 1000;
  PetscCall(RigidAddBody(rigid, &body, NULL));
  PetscCall(RigidSetGravity(rigid, g));
  PetscCall(RigidSetUp(rigid));
  for (int i = 1; i <= 100; i++) {
    PetscCall(AncfAdvance(ancf, 1e-3 * i));
    PetscCall(RigidAdvance(rigid, 1e-3 * i));
  }
  PetscCall(AncfGetState(ancf, NULL, &e, NULL, NULL));
  PetscCall(RigidGetState(rigid, 0, X, NULL, NULL, NULL));
  *beam = e[2];
  *ball = X[2];
  PetscCall(AncfDestroy(&ancf));
  PetscCall(RigidDestroy(&rigid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  const double exact = -0.5 * 9.81 * 0.01;
  PetscReal beam = 0, ball = 0;

  if (PetscInitialize(&argc, &argv, NULL, NULL) || fall(&beam, &ball)) return 1;
  printf("fall of a beam %.12g m, of a ball %.12g m, exact %.12g m\n", (double)beam, (double)ball, exact);
  if (PetscFinalize()) return 1;
  /* Newton stops at 1e-9 of its start: 100 steps of it. */
  return fabs((double)beam - exact) < 1e-7 && fabs((double)ball - exact) < 1e-12 ? 0 : 1;
}
