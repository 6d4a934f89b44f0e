/*
  Constraints with Lagrange multipliers against elimination: the same motion under clamps, pins, driven supports and joints; the
  constraints kept; types that cannot solve the equations refused.
*/
#include "ancf_common.h"

typedef enum { SWING, CANTILEVER, SHAKEN, PENDULUM, STAR, CASES } Case;
static const char *const names[CASES] = {"pinned swing", "cantilever", "shaken clamp", "ball joint", "rigid star"};

static PetscErrorCode Create(Case what, const char options[], Ancf *a)
{
  const Joint ball = {{0, 1}, {2, 0}, 2, ANCF_JOINT_BALL}, rigid = {{0, 1, 2}, {2, 0, 0}, 3, ANCF_JOINT_RIGID};
  AncfBeamSpec s[3];

  PetscFunctionBegin;
  for (int b = 0; b < 3; b++) {
    PetscCall(SeedSpec(2, &s[b]));
    s[b].end0 = ANCF_END_FREE;
  }
  s[0].end0 = what == CANTILEVER || what == SHAKEN || what == STAR ? ANCF_END_CLAMP : ANCF_END_PIN;
  if (what == SWING || what == CANTILEVER || what == SHAKEN) {
    Place(&s[0], 0, 0, 0, 1, 0, 0, 4);
    PetscCall(NetCreate(1, s, 0, NULL, -9.81, options, a));
  } else if (what == PENDULUM) {
    Place(&s[0], 0, 0, 0, 0.5, 0, 0, 2);
    Place(&s[1], 0.5, 0, 0, 0.7, 0, -0.4, 2);
    PetscCall(NetCreate(2, s, 1, &ball, -9.81, options, a));
  } else {
    Place(&s[0], 0, 0, 0, 1, 0, 0, 2);
    Place(&s[1], 1, 0, 0, 1, 0.5, 0.1, 2);
    Place(&s[2], 1, 0, 0, 1.3, -0.3, 0.3, 2);
    PetscCall(NetCreate(3, s, 1, &rigid, -9.81, options, a));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Coordinates and velocities after 0.1 s, and the largest violations on the way. */
static PetscErrorCode Run(Case what, const char options[], PetscReal dt, PetscReal e[60], PetscReal v[60], PetscReal off[2])
{
  const PetscReal rest[6] = {0, 0, 0, 1, 0, 0}, zero[6] = {0}, push[6] = {0, 4, 8, 0, -3, 5};
  const PetscReal *x, *u;
  PetscReal p, q;
  PetscInt n;
  Ancf a;

  PetscFunctionBegin;
  PetscCall(Create(what, options, &a));
  if (what == SHAKEN) PetscCall(AncfSetNodeMotion(a, 0, 0, rest, zero, push));
  off[0] = off[1] = 0;
  for (int i = 1; i * dt <= 0.1 + 1e-9; i++) {
    PetscCall(AncfAdvance(a, i * dt));
    PetscCall(AncfGetConstraintError(a, &p, &q));
    off[0] = PetscMax(off[0], p);
    off[1] = PetscMax(off[1], q);
  }
  PetscCall(AncfGetNumNodes(a, &n));
  PetscCall(AncfGetState(a, NULL, &x, &u, NULL));
  PetscCall(PetscArrayzero(e, 60));
  PetscCall(PetscArrayzero(v, 60));
  PetscCall(PetscArraycpy(e, x, 6 * n));
  PetscCall(PetscArraycpy(v, u, 6 * n));
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Distance(const PetscReal *x, const PetscReal *y)
{
  PetscReal d = 0;

  for (int i = 0; i < 60; i++) d = PetscMax(d, PetscAbsReal(x[i] - y[i]));
  return d;
}

/*
  Both are of the same order in the step, so that they differ by the sum of two errors at most; that of elimination is 4/3
  (second order) or 2 (first order) of what halving its step changes; allow each three times as much. Where fixed supports and
  ball joints are all, alpha2, theta, cn and beuler give the same discrete equations: positions agree to Newton's tolerance, 1e-9
  of the first residual in each of 100 steps, and velocities to that over the step (exact).

  Positions keep the constraints to Newton's tolerance: 1e-9 of the first residual, which the fall in a step, v dt = 1e-3 m,
  makes with the axial stiffness that also scales the rows. alpha2 and theta do so at their stage, a point between the ends of the
  step, so that the angles of a corner are off at the ends by dt^2/8 of their second derivative, at most (4 w)^2 for tangents that
  turn at w: four of them are in a row. Velocities keep them to the error of the step, bounded as above.
*/
static PetscErrorCode TestCase(Case what, const char type[], PetscBool exact, PetscReal dt)
{
  const char *eliminated = what == STAR && strstr(type, "cn") ? "-ancf_ts_type theta" : type; /* cn refuses corners there */
  PetscReal e[3][60], v[3][60], off[3][2], de, dv, me, mv, turn = 0;
  char options[256];

  PetscFunctionBegin;
  PetscCall(Run(what, eliminated, dt, e[0], v[0], off[0]));
  PetscCall(Run(what, eliminated, dt / 2, e[1], v[1], off[1]));
  PetscCall(PetscSNPrintf(options, sizeof(options), "%s -ancf_constraints multipliers", type));
  PetscCall(Run(what, options, dt, e[2], v[2], off[2]));
  de = Distance(e[0], e[1]), dv = Distance(v[0], v[1]), me = Distance(e[0], e[2]), mv = Distance(v[0], v[2]);
  printf("%-14s %-26s dt %.0e: positions differ by %.1e (the step's error %.1e), velocities by %.1e (%.1e); constraints off by "
         "%.1e, %.1e; eliminated %.0e, %.0e\n",
         names[what], type, (double)dt, (double)me, (double)de, (double)mv, (double)dv, (double)off[2][0], (double)off[2][1],
         (double)off[0][0], (double)off[0][1]);
  TEST_NEAR(me, 0, exact ? 1e-9 : 6 * 2 * de, "positions");
  TEST_NEAR(mv, 0, exact ? 1e-9 / dt : 6 * 2 * dv, "velocities");
  for (int i = 3; i < 60; i++) turn = PetscMax(turn, i % 6 < 3 ? 0 : PetscAbsReal(v[0][i]));
  TEST_NEAR(off[2][0], 0,
            what == STAR && (!strstr(type, "-ancf_ts_type") || strstr(type, "theta")) ? PetscSqr(dt * 4 * turn) / 8 : 1e-11,
            "positions off the constraints");
  TEST_NEAR(off[2][1], 0, exact ? 1e-11 / dt : 6 * 2 * dv, "velocities off the constraints");
  TEST_NEAR(off[0][0], 0, 1e-14, "eliminated positions off the constraints");
  TEST_NEAR(off[0][1], 0, 1e-13, "eliminated velocities off the constraints");
  PetscCall(PetscArrayzero(e[1], 60));
  TEST(Distance(v[0], e[1]) > 0.1, "%s does not move", names[what]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A run from a packed state goes on with the bits of the packed one, which begins anew. */
static PetscErrorCode TestPack(const char options[])
{
  PetscReal *state, tip[2][3];
  const PetscReal *e;
  PetscInt n;
  Ancf a;

  PetscFunctionBegin;
  PetscCall(Create(STAR, options, &a));
  PetscCall(AncfAdvance(a, 0.01));
  PetscCall(AncfGetPackSize(a, &n));
  PetscCall(PetscMalloc1(n, &state));
  PetscCall(AncfPack(a, state));
  for (int run = 0; run < 2; run++) {
    if (run) PetscCall(AncfUnpack(a, state));
    PetscCall(AncfAdvance(a, 0.02));
    PetscCall(AncfGetState(a, NULL, &e, NULL, NULL));
    PetscCall(PetscArraycpy(tip[run], e + 48, 3));
  }
  for (int c = 0; c < 3; c++) TEST_NEAR(tip[1][c], tip[0][c], 0, "tip of the run from a state");
  PetscCall(PetscFree(state));
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Refused(Case what, const char options[])
{
  Ancf a = NULL;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  ierr = Create(what, options, &a);
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(ierr);
}

static PetscErrorCode TestBadInput(void)
{
  Ancf a;

  PetscFunctionBegin;
  TEST_ERROR(Refused(CANTILEVER, "-ancf_constraints multipliers -ancf_ts_type alpha"), PETSC_ERR_ARG_INCOMP,
             "alpha2 theta cn bdf beuler");
  TEST_ERROR(Refused(CANTILEVER, "-ancf_constraints multipliers -ancf_ts_type arkimex"), PETSC_ERR_ARG_INCOMP,
             "-ancf_ts_type arkimex");
  TEST_ERROR(Refused(CANTILEVER, "-ancf_constraints multipliers -ancf_ts_type rk"), PETSC_ERR_ARG_INCOMP, "-ancf_ts_type rk");
  TEST_ERROR(Refused(CANTILEVER, "-ancf_constraints multipliers -ancf_ts_type basicsymplectic"), PETSC_ERR_ARG_INCOMP,
             "basicsymplectic");
  TEST_ERROR(Refused(CANTILEVER, "-ancf_constraints multipliers -ancf_pc_type blocktri"), PETSC_ERR_ARG_INCOMP,
             "-ancf_pc_type blocktri");
  TEST_ERROR(Refused(CANTILEVER, "-ancf_constraints multipliers -ancf_pc_type cholesky"), PETSC_ERR_ARG_INCOMP, "use lu");
  TEST_ERROR(Refused(STAR, "-ancf_ts_type cn"), PETSC_ERR_ARG_INCOMP, "-ancf_ts_type cn cannot keep the rigid joint 0");
  PetscCall(Create(CANTILEVER, "", &a));
  TEST_ERROR(AncfSetConstraints(a, ANCF_CONSTRAINTS_MULTIPLIERS), PETSC_ERR_ARG_WRONGSTATE, "after AncfSetUp()");
  PetscCall(AncfDestroy(&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  for (int what = 0; what < CASES; what++) {
    const PetscBool fixed = what != SHAKEN && what != STAR ? PETSC_TRUE : PETSC_FALSE;

    PetscCall(TestCase((Case)what, "", fixed, 1e-3));
    PetscCall(TestCase((Case)what, "-ancf_ts_type bdf", PETSC_FALSE, 1e-3));
    PetscCall(TestCase((Case)what, "-ancf_ts_type beuler", fixed, 1e-3));
    PetscCall(TestCase((Case)what, "-ancf_ts_type theta", fixed, 1e-3));
    PetscCall(TestCase((Case)what, "-ancf_ts_type cn", fixed, 1e-3));
  }
  PetscCall(TestCase(STAR, "-ancf_damping 2 -ancf_damping_stiffness 1e-3", PETSC_FALSE, 1e-3));
  PetscCall(TestPack("-ancf_constraints multipliers"));
  PetscCall(TestPack("-ancf_constraints multipliers -ancf_ts_type bdf"));
  PetscCall(TestPack("-ancf_constraints multipliers -ancf_ts_type theta"));
  PetscCall(TestBadInput());
  PetscCall(PetscFinalize());
  return test_report();
}
