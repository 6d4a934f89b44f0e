/*
  test_couple_cylinder.c - a sprung cylinder (2D) in a fluid-filled fixed concentric cylinder: the gate of two-way coupling.

  Radius R, outer radius 5R, rho_s/rho = 2, rho w0 R^2/mu = 10, w0 the frequency in vacuum. Small motions x ~ exp(-i w t) of the
  unsteady Stokes problem f = A r + B/r + C I1(kr) + D K1(kr), k^2 = -i w rho/mu, f = R, f' = 1 at R, f = f' = 0 at 5R, give w/w0
  = 0.661721 - 0.132566 i. Released at rest from 0.05 R, the motion after the first quarter period is fitted by one decaying
  oscillation (Prony). Bound at the finest spacing: 3 % of |w| for frequency and decay rate each; the errors of the spacings are
  printed as a table.
*/
#include "couple.h"
#include "sphfill.h"
#include "testing.h"

#define R 1.0
#define RO 5.0
#define RHO 1.0
#define W0 1.0
#define MU 0.1
#define OFFSET 0.05
#define WR 0.661721
#define WI 0.132566

static PetscBool InAnnulus(const PetscReal x[3], void *ctx)
{
  const double dx = x[0] - OFFSET, ro = hypot(x[0], x[1]);
  (void)ctx;
  return hypot(dx, x[1]) > R && ro < RO ? PETSC_TRUE : PETSC_FALSE;
}

static PetscErrorCode MakeFluid(PetscReal dp, Sph *sph)
{
  const PetscReal b = ceil(RO / dp) * dp, lo[3] = {-b, -b, 0}, hi[3] = {b, b, 0};
  PetscReal *x;
  PetscInt n;

  PetscFunctionBegin;
  PetscCall(SphCreate(PETSC_COMM_SELF, sph));
  PetscCall(SphSetDimension(*sph, 2));
  PetscCall(SphSetSpacing(*sph, dp));
  PetscCall(SphSetDensity(*sph, RHO));
  PetscCall(SphSetViscosity(*sph, MU));
  PetscCall(SphSetSoundSpeed(*sph, 30.0)); /* (w 5R/c)^2 = 0.012: nearly incompressible across the annulus */
  PetscCall(SphSetDomain(*sph, lo, hi));
  PetscCall(SphSetFromOptions(*sph));
  PetscCall(SphFillBox(2, dp, lo, hi, InAnnulus, NULL, &n, &x));
  PetscCall(SphAddFluid(*sph, n, x, NULL, NULL));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rings of wall markers at RO + dp/2, RO + 3dp/2, ... */
static PetscErrorCode AddOuterWall(PetscReal dp, PetscReal support, Couple couple)
{
  const PetscReal zero[3] = {0, 0, 0};
  const PetscInt layers = (PetscInt)ceil(support / dp), most = layers * (PetscInt)(7.0 * (RO + support) / dp);
  PetscReal *x, *vol, *depth;
  PetscInt n = 0;
  CoupleSurface wall;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(3 * (size_t)most, &x, most, &vol, most, &depth));
  for (PetscInt k = 0; k < layers; k++) {
    const double r = RO + (k + 0.5) * dp;
    const PetscInt m = (PetscInt)lrint(2.0 * PETSC_PI * r / dp);
    for (PetscInt i = 0; i < m; i++, n++) {
      x[3 * n] = r * cos(2.0 * PETSC_PI * i / m);
      x[3 * n + 1] = r * sin(2.0 * PETSC_PI * i / m);
      x[3 * n + 2] = 0.0;
      vol[n] = 2.0 * PETSC_PI * r * dp / m;
      depth[n] = r - RO;
    }
  }
  PetscCall(CoupleSurfaceCreateWall(PETSC_COMM_SELF, "outer", n, x, vol, depth, zero, &wall));
  PetscCall(CoupleAddSurface(couple, wall));
  PetscCall(CoupleSurfaceDestroy(&wall));
  PetscCall(PetscFree3(x, vol, depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddCylinder(PetscReal dp, PetscReal support, Couple couple, Rigid *rigid)
{
  RigidBodySpec spec;
  RigidJointSpec spring;
  PetscInt body, joint;
  CoupleSurface s;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, rigid));
  PetscCall(RigidSetDimension(*rigid, 2));
  PetscCall(RigidBodySpecInit(&spec));
  spec.shape = RIGID_SPHERE;
  spec.motion = RIGID_FREE;
  spec.size[0] = R;
  spec.density = 2.0 * RHO;
  spec.position[0] = OFFSET;
  PetscCall(RigidAddBody(*rigid, &spec, &body));
  PetscCall(RigidJointSpecInit(&spring));
  spring.type = RIGID_JOINT_LINEAR;
  spring.a = body;
  spring.b = RIGID_GROUND;
  spring.point[0] = OFFSET;
  spring.axis[0] = 1.0;
  spring.axis[1] = spring.axis[2] = 0.0;
  spring.stiffness = 2.0 * RHO * PETSC_PI * R * R * W0 * W0;
  spring.rest = -OFFSET;
  PetscCall(RigidAddJoint(*rigid, &spring, &joint));
  PetscCall(RigidSetUp(*rigid));
  PetscCall(CoupleSurfaceCreateRigid(*rigid, body, 2, dp, support, &s));
  PetscCall(CoupleAddSurface(couple, s));
  PetscCall(CoupleSurfaceDestroy(&s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One decaying oscillation through samples dt apart: x(t+2s) = a x(t+s) + b x(t), s = lag samples; roots exp(-i w s). */
static void Prony(PetscInt n, const double *x, double dt, PetscInt lag, double *wr, double *wi)
{
  double p = 0, q = 0, r = 0, u = 0, v = 0;
  for (PetscInt i = 0; i + 2 * lag < n; i++) {
    const double c = x[i], b = x[i + lag], a = x[i + 2 * lag];
    p += b * b;
    q += b * c;
    r += c * c;
    u += a * b;
    v += a * c;
  }
  const double det = p * r - q * q, a1 = (u * r - v * q) / det, a0 = (v * p - u * q) / det, mod = sqrt(-a0);
  *wi = -log(mod) / (lag * dt);
  *wr = acos(a1 / (2.0 * mod)) / (lag * dt);
}

#define NS 400

static PetscErrorCode Run(PetscReal dp, double *er, double *ei)
{
  const double period = 2.0 * PETSC_PI / WR, t0 = 0.25 * period, t1 = 1.75 * period, ds = (t1 - t0) / (NS - 1);
  double x[NS], wr, wi;
  PetscReal t = 0.0, dt, support, X[3];
  Sph sph;
  Couple couple;
  Rigid rigid;

  PetscFunctionBegin;
  PetscCall(MakeFluid(dp, &sph));
  PetscCall(SphGetSupport(sph, &support));
  PetscCall(CoupleCreate(PETSC_COMM_SELF, &couple));
  PetscCall(CoupleSetSph(couple, sph));
  PetscCall(AddOuterWall(dp, support, couple));
  PetscCall(AddCylinder(dp, support, couple, &rigid));
  PetscCall(CoupleSetUp(couple));
  for (PetscInt i = 0; i < NS; i++) {
    while (t < t0 + i * ds) {
      PetscCall(CoupleStep(couple, t0 + i * ds, &dt));
      PetscCall(CoupleGetTime(couple, &t, NULL));
    }
    PetscCall(RigidGetState(rigid, 0, X, NULL, NULL, NULL));
    x[i] = X[0];
  }
  Prony(NS, x, ds, NS / 12, &wr, &wi);
  *er = (wr - WR) / hypot(WR, WI);
  *ei = (wi - WI) / hypot(WR, WI);
  printf("dp %.4f R: w/w0 = %.6f - %.6f i, errors %+.4f %+.4f of |w|\n", (double)dp, wr, wi, *er, *ei);
  fflush(stdout);
  PetscCall(CoupleDestroy(&couple));
  PetscCall(SphDestroy(&sph));
  PetscCall(RigidDestroy(&rigid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscInt n = 2;
  PetscReal dp[4] = {0.25, 0.125, 0, 0};
  double er = 0, ei = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetRealArray(NULL, NULL, "-dp", dp, &n, NULL));
  if (dp[n - 1] == 0) n = 2;
  for (PetscInt i = 0; i < n; i++) PetscCall(Run(dp[i], &er, &ei));
  TEST_NEAR(er, 0.0, 0.03, "frequency error over |w|");
  TEST_NEAR(ei, 0.0, 0.03, "decay rate error over |w|");
  PetscCall(PetscFinalize());
  return test_report();
}
