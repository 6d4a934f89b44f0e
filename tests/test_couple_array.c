/*
  test_couple_array.c - creeping flow through periodic arrays of cylinders and spheres: drag against Sangani and Acrivos.

  Unit cell with one fixed body at its centre, fluid driven by a body force f. In the steady state the body carries F = rho f
  L^dim (mean pressure gradient included), so that the mean velocity U over the whole cell gives K: F = K mu U for cylinders,
  Sangani, Acrivos, Int. J. Multiphase Flow 8 (1982) 193: 15.558 and 51.527 at solid fractions 0.05 and 0.2, and 30.3507 for
  Morris, Fox, Zhu (1997); F = 6 pi mu a K U for spheres, ibid. 343: 4.2894 at 0.125. The approach to it is exponential, e^(-K nu
  t/L^2): the run ends when that is e^-8 = 3e-4. Bound: 0.6 dp/R, as where the markers put the surface is certain to a
  quarter of a spacing, and the drag changes by 2.3 (cylinders) to 2.5 (spheres) times a relative change of R. Density
  re-initialisation is off: the Shepard filter diffuses pressure, which in a creeping flow lets fluid through, D grad p/(rho
  c_s^2) with D about 0.2 h^2 per 10 steps; with the default every 10 steps K is 10 to 20 % too low. Options: -across, -only n (0
  to 3), -lattice 1: the body is made of the sites of the fluid's lattice that lie in it.
*/
#include "couple.h"
#include "sphcase.h"

typedef struct {
  const char *name;
  PetscInt dim, across;
  PetscReal R; /* over L */
  double K;
} Array;

static PetscBool Outside(const PetscReal x[3], void *ctx)
{
  const Array *a = (const Array *)ctx;
  PetscReal r2 = 0.0;
  for (int k = 0; k < a->dim; k++) r2 += PetscSqr(x[k] - 0.5);
  return r2 > a->R * a->R ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool Inside(const PetscReal x[3], void *ctx)
{
  return Outside(x, ctx) ? PETSC_FALSE : PETSC_TRUE;
}

/* The body as the lattice sites inside it, a wall at rest: fluid and body share one lattice, as in Morris, Fox, Zhu. */
static PetscErrorCode AddLattice(Array *a, Sph sph, Couple couple)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {1, 1, 1}, zero[3] = {0, 0, 0}, dp = 1.0 / (PetscReal)a->across;
  PetscReal *x, *volume, *depth, support;
  PetscInt n, m = 0;
  CoupleSurface s;

  PetscFunctionBegin;
  PetscCall(SphGetSupport(sph, &support));
  PetscCall(SphFillBox(a->dim, dp, lo, hi, Inside, a, &n, &x));
  PetscCall(PetscMalloc2(n, &volume, n, &depth));
  for (PetscInt i = 0; i < n; i++) {
    PetscReal r2 = 0.0;
    for (int k = 0; k < a->dim; k++) r2 += PetscSqr(x[3 * i + k] - 0.5);
    depth[m] = a->R - PetscSqrtReal(r2);
    volume[m] = PetscPowReal(dp, (PetscReal)a->dim);
    if (depth[m] > support) continue;
    PetscCall(PetscArraycpy(x + 3 * m, x + 3 * i, m < i ? 3 : 0));
    m++;
  }
  PetscCall(CoupleSurfaceCreateWall(PETSC_COMM_SELF, "body", m, x, volume, depth, zero, &s));
  PetscCall(CoupleAddSurface(couple, s));
  PetscCall(CoupleSurfaceDestroy(&s));
  PetscCall(PetscFree2(volume, depth));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddBody(const Array *a, Sph sph, Couple couple, Rigid *rigid)
{
  RigidBodySpec spec;
  PetscReal support;
  PetscInt body;
  CoupleSurface s;

  PetscFunctionBegin;
  PetscCall(RigidCreate(PETSC_COMM_SELF, rigid));
  PetscCall(RigidSetDimension(*rigid, a->dim));
  PetscCall(RigidBodySpecInit(&spec));
  spec.shape = RIGID_SPHERE;
  spec.motion = RIGID_FIXED;
  spec.density = 1.0;
  spec.size[0] = a->R;
  for (int k = 0; k < a->dim; k++) spec.position[k] = 0.5;
  PetscCall(RigidAddBody(*rigid, &spec, &body));
  PetscCall(RigidSetUp(*rigid));
  PetscCall(SphGetSupport(sph, &support));
  PetscCall(CoupleSurfaceCreateRigid(*rigid, body, a->dim, 1.0 / (PetscReal)a->across, support, &s));
  PetscCall(CoupleAddSurface(couple, s));
  PetscCall(CoupleSurfaceDestroy(&s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Run(Array *a, PetscBool lattice, double bound)
{
  const double U = 0.02, factor = a->dim == 2 ? 1.0 : 6.0 * PETSC_PI * (double)a->R, f = factor * a->K * U,
               tend = 8.0 / (factor * a->K);
  FlowCase c = {.dim = a->dim,
                .dp = 1.0 / (PetscReal)a->across,
                .hi = {1, 1, 1},
                .periodic = {1, 1, a->dim == 3},
                .rho = 1.0,
                .mu = 1.0,
                .vmax = sqrt(f),
                .f = {f, 0, 0},
                .hratio = 1.2,
                .xsph = -1.0,
                .keep = Outside,
                .ctx = a};
  Sph sph;
  Couple couple;
  Rigid rigid = NULL;
  CoupleAudit audit;
  SphSums s;
  PetscReal t = 0.0, dt;

  PetscFunctionBegin;
  if (a->dim == 2) c.hi[2] = 0.0;
  PetscCall(FlowFluid(&c, &sph));
  PetscCall(SphSetDensityReinit(sph, SPH_REINIT_NONE, 10));
  PetscCall(CoupleCreate(PETSC_COMM_SELF, &couple));
  PetscCall(CoupleSetSph(couple, sph));
  if (lattice)
    PetscCall(AddLattice(a, sph, couple));
  else
    PetscCall(AddBody(a, sph, couple, &rigid));
  PetscCall(CoupleSetUp(couple));
  while (t < tend) {
    PetscCall(CoupleStep(couple, tend, &dt));
    PetscCall(CoupleGetTime(couple, &t, NULL));
  }
  PetscCall(SphGetSums(sph, &s));
  PetscCall(CoupleGetAudit(couple, 0, &audit));
  const double K = f / (factor * (double)s.momentum[0]);
  printf(
      "%s, %d across, R/dp %.2f: K %.4f, reference %.4f, error %+.2f %%; force on the body over body force on the fluid %.4f\n",
      a->name, (int)a->across, (double)(a->R * (PetscReal)a->across), K, a->K, 100.0 * (K / a->K - 1.0),
      (double)audit.force[0] / (f * (double)s.mass));
  fflush(stdout);
  TEST_REL(K, a->K, bound, a->name);
  TEST_NEAR((double)audit.force[0] / (f * (double)s.mass), 1.0, 0.01, "force on the body over body force on the fluid");
  PetscCall(CoupleDestroy(&couple));
  PetscCall(SphDestroy(&sph));
  if (rigid) PetscCall(RigidDestroy(&rigid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  Array arrays[] = {{"cylinders, solid fraction 0.05", 2, 32, 0.126157, 15.558},
                    {"cylinders of Morris, Fox, Zhu", 2, 32, 0.2, 30.3507},
                    {"cylinders, solid fraction 0.2", 2, 32, 0.252313, 51.527},
                    {"spheres, solid fraction 0.125", 3, 16, 0.310175, 4.2894}};
  PetscInt across = 0, only = -1;
  PetscBool lattice = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-across", &across, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-only", &only, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-lattice", &lattice, NULL));
  for (int k = 0; k < 4; k++) {
    if (only >= 0 && only != k) continue;
    if (across > 0) arrays[k].across = across;
    PetscCall(Run(&arrays[k], lattice, 0.6 / (double)(arrays[k].R * (PetscReal)arrays[k].across)));
  }
  PetscCall(PetscFinalize());
  return test_report();
}
