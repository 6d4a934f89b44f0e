/*
  test_couple_transfer.c - the projection between BCE markers and structures.

  For a beam in a curved, moving state and random marker forces: force, moment (axial torque apart) and power lost are round-off;
  marker velocities and accelerations are the time derivatives of marker positions; the generalised force is the gradient of the
  virtual work of the marker forces. The same for a spinning rigid body. Rest markers: volumes, spacing, distance from the axis.
*/
#include "couple.h"
#include "testing.h"

#define DP 0.02

static PetscRandom rnd;

static double Random(double a, double b)
{
  PetscScalar s;
  PetscCallAbort(PETSC_COMM_SELF, PetscRandomGetValue(rnd, &s));
  return a + (b - a) * PetscRealPart(s);
}

/* A cantilever of 4 elements in 3D (or in the x-y plane), bent and moving at random but smoothly: perturbed nodal coordinates. */
static PetscErrorCode MakeBeam(PetscInt dim, Ancf *out)
{
  AncfBeamSpec spec;
  PetscReal *e1, *v1;
  const PetscReal *e, *v;
  PetscInt n, beam;
  Ancf ancf;

  PetscFunctionBegin;
  PetscCall(AncfCreate(PETSC_COMM_SELF, &ancf));
  PetscCall(AncfBeamSpecInit(&spec));
  spec.start[0] = 0.1;
  spec.start[1] = 0.2;
  spec.start[2] = dim == 3 ? 0.3 : 0.0;
  spec.end[0] = 0.9;
  spec.end[1] = 0.5;
  spec.end[2] = dim == 3 ? 0.1 : 0.0;
  spec.elements = 4;
  spec.diameter = 0.08;
  spec.density = 1200.0;
  spec.young = 1e6;
  PetscCall(AncfAddBeam(ancf, &spec, &beam));
  PetscCall(AncfSetUp(ancf));
  PetscCall(AncfGetNumNodes(ancf, &n));
  PetscCall(AncfGetState(ancf, NULL, &e, &v, NULL));
  PetscCall(PetscMalloc2(6 * (size_t)n, &e1, 6 * (size_t)n, &v1));
  for (PetscInt i = 0; i < 6 * n; i++) {
    const PetscBool flat = dim == 2 && i % 3 == 2 ? PETSC_TRUE : PETSC_FALSE;
    e1[i] = e[i] + (flat ? 0.0 : Random(-1, 1) * (i % 6 < 3 ? 0.02 : 0.2));
    v1[i] = flat ? 0.0 : Random(-1, 1);
  }
  PetscCall(AncfSetState(ancf, 0.0, e1, v1));
  PetscCall(PetscFree2(e1, v1));
  *out = ancf;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marker totals as CoupleStep makes them. */
static void Totals(PetscInt n, const PetscReal *x, const PetscReal *v, const PetscReal *f, CoupleAudit *a)
{
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal *p = x + 3 * i, *q = f + 3 * i;
    a->moment[0] += p[1] * q[2] - p[2] * q[1];
    a->moment[1] += p[2] * q[0] - p[0] * q[2];
    a->moment[2] += p[0] * q[1] - p[1] * q[0];
    for (int k = 0; k < 3; k++) {
      a->force[k] += q[k];
      a->power += q[k] * v[3 * i + k];
    }
  }
}

/* Sums of about n terms of size `scale` keep n eps scale; 16 for the products inside. */
static void CheckAudit(const char *what, PetscInt n, const CoupleAudit *a, double scale)
{
  const double tol = 16.0 * (double)n * PETSC_MACHINE_EPSILON * scale;
  for (int k = 0; k < 3; k++) {
    TEST_NEAR(a->force_lost[k], 0.0, tol, what);
    TEST_NEAR(a->moment_lost[k], 0.0, tol, what);
  }
  TEST_NEAR(a->power_lost, 0.0, tol, what);
}

/*
  Central differences over +-dt of the extrapolated motion. Their error is dt^2/6 times third derivatives: for v about R alpha^2,
  with alpha up to 1e6 rad/s^2 in these violently bent states 4e10 m/s^4, hence below 0.01 m/s^2 at dt = 1e-6 s; for x it is (w
  alpha R) dt^2/6 < 1e-6 m/s. Round-off is eps/dt = 2e-10.
*/
static PetscErrorCode CheckKinematics(CoupleSurface s, const CoupleSurfaceOps *ops, PetscInt n, double tol)
{
  PetscReal *x[3], *v[3], *a[3], worst[2] = {0, 0};
  const double dt = 1e-6;

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) PetscCall(PetscMalloc3(3 * (size_t)n, &x[k], 3 * (size_t)n, &v[k], 3 * (size_t)n, &a[k]));
  PetscCall((*ops->kinematics)(s, -dt, x[0], v[0], a[0]));
  PetscCall((*ops->kinematics)(s, dt, x[2], v[2], a[2]));
  PetscCall((*ops->kinematics)(s, 0.0, x[1], v[1], a[1]));
  for (PetscInt i = 0; i < 3 * n; i++) {
    worst[0] = PetscMax(worst[0], PetscAbsReal((x[2][i] - x[0][i]) / (2 * dt) - v[1][i]));
    worst[1] = PetscMax(worst[1], PetscAbsReal((v[2][i] - v[0][i]) / (2 * dt) - a[1][i]));
  }
  TEST_NEAR(worst[0], 0.0, tol, "marker velocity against differences of positions");
  TEST_NEAR(worst[1], 0.0, tol * 1e2, "marker acceleration against differences of velocities");
  for (int k = 0; k < 3; k++) PetscCall(PetscFree3(x[k], v[k], a[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Q . de against sum F . dx for a random small change de of the nodal coordinates; second-order differences, so 1e-6 relative at
 * de ~ 1e-5. */
static PetscErrorCode CheckVirtualWork(Ancf ancf, CoupleSurface s, const CoupleSurfaceOps *ops, PetscInt dim, PetscInt n,
                                       const PetscReal *f)
{
  PetscReal *Q, *e0, *v0, *em, *de, *xp, *xm, *v, *a, work = 0, gen = 0, size = 0;
  const PetscReal *e, *ed;
  PetscInt nn;

  PetscFunctionBegin;
  PetscCall(AncfGetNumNodes(ancf, &nn));
  PetscCall(PetscMalloc4(6 * (size_t)nn, &e0, 6 * (size_t)nn, &v0, 6 * (size_t)nn, &em, 6 * (size_t)nn, &de));
  PetscCall(PetscMalloc4(3 * (size_t)n, &xp, 3 * (size_t)n, &xm, 3 * (size_t)n, &v, 3 * (size_t)n, &a));
  PetscCall(AncfGetLoads(ancf, &Q));
  PetscCall(AncfGetState(ancf, NULL, &e, &ed, NULL));
  for (PetscInt i = 0; i < 6 * nn; i++) {
    e0[i] = e[i];
    v0[i] = ed[i];
    de[i] = dim == 2 && i % 3 == 2 ? 0.0 : 1e-5 * Random(-1, 1);
    gen += Q[i] * de[i];
  }
  for (PetscInt i = 0; i < 6 * nn; i++) em[i] = e0[i] + 0.5 * de[i];
  PetscCall(AncfSetState(ancf, 0.0, em, v0));
  PetscCall((*ops->kinematics)(s, 0.0, xp, v, a));
  for (PetscInt i = 0; i < 6 * nn; i++) em[i] = e0[i] - 0.5 * de[i];
  PetscCall(AncfSetState(ancf, 0.0, em, v0));
  PetscCall((*ops->kinematics)(s, 0.0, xm, v, a));
  PetscCall(AncfSetState(ancf, 0.0, e0, v0));
  for (PetscInt i = 0; i < 3 * n; i++) {
    work += f[i] * (xp[i] - xm[i]);
    size += PetscAbsReal(f[i] * (xp[i] - xm[i]));
  }
  TEST_NEAR(gen, work, 1e-4 * size, "virtual work of the generalised forces");
  PetscCall(PetscFree4(e0, v0, em, de));
  PetscCall(PetscFree4(xp, xm, v, a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rest volumes add up to the beam's own; every marker lies inside, at its stated depth. */
static void CheckRest(PetscInt dim, PetscInt n, const PetscReal *volume, const PetscReal *depth, double L)
{
  const double R = 0.04, exact = dim == 2 ? 2 * R * L : PETSC_PI * R * R * L;
  double sum = 0.0;
  for (PetscInt i = 0; i < n; i++) {
    sum += volume[i];
    TEST(depth[i] > 0.0 && depth[i] <= R, "depth %g of a marker must be in (0, %g]", depth[i], R);
  }
  TEST_REL(sum, exact, 1e-12, "sum of the marker volumes of a beam");
}

static PetscErrorCode TestBeam(PetscInt dim)
{
  const PetscReal *x0, *volume, *depth;
  PetscReal *x, *v, *a, *f;
  CoupleSurfaceOps ops;
  CoupleSurface s;
  CoupleAudit audit = {0};
  PetscInt n;
  Ancf ancf;

  PetscFunctionBegin;
  PetscCall(MakeBeam(dim, &ancf));
  PetscCall(CoupleSurfaceCreateBeam(ancf, 0, dim, DP, 3 * DP, &s));
  PetscCall(CoupleSurfaceGetOps(s, &ops));
  PetscCall((*ops.getmarkers)(s, &n, &x0, &volume, &depth));
  CheckRest(dim, n, volume, depth, sqrt(0.8 * 0.8 + 0.3 * 0.3 + (dim == 3 ? 0.04 : 0.0)));
  PetscCall(PetscMalloc4(3 * (size_t)n, &x, 3 * (size_t)n, &v, 3 * (size_t)n, &a, 3 * (size_t)n, &f));
  for (PetscInt i = 0; i < 3 * n; i++) f[i] = dim == 2 && i % 3 == 2 ? 0.0 : Random(-1, 1);
  PetscCall(CheckKinematics(s, &ops, n, 1e-3));
  PetscCall((*ops.kinematics)(s, 1e-3, x, v, a)); /* as in a step: the forces act on an extrapolated state */
  Totals(n, x, v, f, &audit);
  PetscCall((*ops.zeroloads)(s));
  PetscCall((*ops.applyforces)(s, f, &audit));
  CheckAudit("transfer to a beam", n, &audit, 4.0);
  PetscCall((*ops.kinematics)(s, 0.0, x, v, a));
  PetscCall((*ops.zeroloads)(s));
  audit = (CoupleAudit){0};
  Totals(n, x, v, f, &audit);
  PetscCall((*ops.applyforces)(s, f, &audit));
  CheckAudit("transfer to a beam at its own time", n, &audit, 4.0);
  PetscCall(CheckVirtualWork(ancf, s, &ops, dim, n, f));
  PetscCall(PetscFree4(x, v, a, f));
  PetscCall(CoupleSurfaceDestroy(&s));
  PetscCall(AncfDestroy(&ancf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestRigid(void)
{
  const PetscReal *x0, *volume, *depth;
  PetscReal *x, *v, *a, *f;
  RigidBodySpec spec;
  CoupleSurfaceOps ops;
  CoupleSurface s;
  CoupleAudit audit = {0};
  PetscInt n, body;
  Rigid rigid;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, &rigid));
  PetscCall(RigidBodySpecInit(&spec));
  spec.shape = RIGID_BOX;
  spec.motion = RIGID_FREE;
  spec.density = 500.0;
  for (int k = 0; k < 3; k++) {
    spec.size[k] = 0.1 + 0.04 * k;
    spec.position[k] = 0.3 - 0.2 * k;
    spec.velocity[k] = 0.5 * k - 0.3;
    spec.omega[k] = 1.0 - 0.7 * k;
  }
  PetscCall(RigidAddBody(rigid, &spec, &body));
  PetscCall(RigidSetUp(rigid));
  PetscCall(CoupleSurfaceCreateRigid(rigid, body, 3, DP, 3 * DP, &s));
  PetscCall(CoupleSurfaceGetOps(s, &ops));
  PetscCall((*ops.getmarkers)(s, &n, &x0, &volume, &depth));
  PetscCall(PetscMalloc4(3 * (size_t)n, &x, 3 * (size_t)n, &v, 3 * (size_t)n, &a, 3 * (size_t)n, &f));
  for (PetscInt i = 0; i < 3 * n; i++) f[i] = Random(-1, 1);
  PetscCall(CheckKinematics(s, &ops, n, 1e-6));
  PetscCall((*ops.kinematics)(s, 1e-3, x, v, a));
  Totals(n, x, v, f, &audit);
  PetscCall((*ops.zeroloads)(s));
  PetscCall((*ops.applyforces)(s, f, &audit));
  CheckAudit("transfer to a rigid body", n, &audit, 2.0);
  PetscCall(PetscFree4(x, v, a, f));
  PetscCall(CoupleSurfaceDestroy(&s));
  PetscCall(RigidDestroy(&rigid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscRandomCreate(PETSC_COMM_SELF, &rnd));
  PetscCall(PetscRandomSetSeed(rnd, 7));
  PetscCall(PetscRandomSeed(rnd));
  for (int r = 0; r < 3; r++) {
    PetscCall(TestBeam(3));
    PetscCall(TestBeam(2));
  }
  PetscCall(TestRigid());
  PetscCall(PetscRandomDestroy(&rnd));
  PetscCall(PetscFinalize());
  return test_report();
}
