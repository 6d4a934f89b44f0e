/*
  host_plate.c - a FEM code that hands its structure to Frond: a water column of 2 m on a clamped plate.

      host_plate examples/host_plate.msh [-plate_dp 0.025] [-plate_end 0.6] [-plate_check 0.03] [PETSc's and Frond's options]

  The host (host_solid.h) owns mesh, state and integrator. To be coupled it says how BCE markers hang on its nodes (make_surface),
  tells its motion (get_state), takes the nodal forces S^T F and steps (advance): nothing else.

  Plate L = 1 m, h = 0.05 m, E = 67.5 GPa, nu = 0.34, 2700 kg/m^3, clamped at both ends, in plane strain, under 2 m of water and
  its own weight q = rho g H + rho_s g h. Thin-plate theory: q L^4/(384 D) = 6.860e-5 m down in the middle, D = E h^3/12(1 -
  nu^2). Shear adds q L^2/(8 kappa G h), 2.5e-6 m for kappa = 5/6, less what clamping a whole face stiffens: these elements bend
  by 6.994e-5 m under the exact hydrostatic pressure. -plate_check bounds the error against both. The plate is damped by mass (c =
  1e5 1/s) so that it settles without ringing the water column; deflection and load are means over the last third of the run.
*/
#include "couplehost.h"
#include "host_solid.h"
#include "sphfill.h"

#define LENGTH 1.0
#define THICKNESS 0.05
#define HEIGHT 2.0
#define RHO 1000.0
#define G 9.81

typedef struct {
  Solid solid;
  PetscReal t, *q, *v, *a; /* time of the state; nodes x 3 */
} Host;

static PetscErrorCode get_state(void *ctx, PetscReal *t, const PetscReal **q, const PetscReal **v, const PetscReal **a)
{
  const Host *h = (const Host *)ctx;

  PetscFunctionBeginUser;
  if (t) *t = h->t;
  if (q) *q = h->q;
  if (v) *v = h->v;
  if (a) *a = h->a;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copy the solver's state to the nodes; accelerations are the mean ones over the step. */
static PetscErrorCode publish(Host *h, PetscReal t)
{
  const Solid *s = &h->solid;
  const PetscScalar *u, *v;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(s->U, &u));
  PetscCall(VecGetArrayRead(s->V, &v));
  for (PetscInt i = 0; i < s->n; i++)
    for (int c = 0; c < 2; c++) {
      const PetscReal vel = SolidValue(s, v, i, c);
      if (t > h->t) h->a[3 * i + c] = (vel - h->v[3 * i + c]) / (t - h->t);
      h->q[3 * i + c] = s->X[2 * i + c] + SolidValue(s, u, i, c);
      h->v[3 * i + c] = vel;
    }
  PetscCall(VecRestoreArrayRead(s->V, &v));
  PetscCall(VecRestoreArrayRead(s->U, &u));
  h->t = t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode advance(void *ctx, PetscReal t, const PetscReal *Q)
{
  Host *h = (Host *)ctx;

  PetscFunctionBeginUser;
  PetscCall(SolidSetLoads(&h->solid, Q));
  PetscCall(SolidAdvance(&h->solid, t));
  PetscCall(publish(h, t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Sections across the plate dp apart, at r on its middle line with the tangent r_x; BCE markers on each, dp apart along the normal
  from the wet face down. The plate is dry below: the layers go on there until they fill the support of the fluid's kernel.
*/
static PetscErrorCode make_surface(Host *h, PetscReal dp, PetscReal support, CoupleSurface *surface)
{
  const CoupleHostOps ops = {.getstate = get_state, .advance = advance};
  const Solid *s = &h->solid;
  const PetscInt nx = (PetscInt)(LENGTH / dp + 0.5), ny = (PetscInt)PetscCeilReal(support / dp - 1e-9), n = nx * ny;
  PetscInt *rowstart, *node, *section;
  PetscReal *shape, *slope, *offset, *volume, *depth;
  CoupleHostSpec spec;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(nx + 1, &rowstart, 9 * (size_t)nx, &node, n, &section));
  PetscCall(PetscMalloc5(9 * (size_t)nx, &shape, 9 * (size_t)nx, &slope, 2 * (size_t)n, &offset, n, &volume, n, &depth));
  rowstart[0] = 0;
  for (PetscInt i = 0; i < nx; i++) {
    const PetscReal r[2] = {((PetscReal)i + 0.5) * LENGTH / (PetscReal)nx, -0.5 * THICKNESS};
    PetscReal xi, eta;
    PetscInt cell;
    PetscCall(SolidFind(s, r, &cell, &xi, &eta));
    SolidShape(s, cell, xi, eta, shape + 9 * i, slope + 9 * i);
    for (int j = 0; j < 9; j++) node[9 * i + j] = s->cell[cell][j];
    rowstart[i + 1] = 9 * (i + 1);
    for (PetscInt k = ny * i; k < ny * (i + 1); k++) {
      section[k] = i;
      volume[k] = dp * LENGTH / (PetscReal)nx;
      depth[k] = ((PetscReal)(k % ny) + 0.5) * dp;
      offset[2 * k] = 0.5 * THICKNESS - depth[k];
      offset[2 * k + 1] = 0.0;
    }
  }
  spec = (CoupleHostSpec){.dim = 2,
                          .nnodes = s->n,
                          .nsections = nx,
                          .rowstart = rowstart,
                          .node = node,
                          .shape = shape,
                          .slope = slope,
                          .nmarkers = n,
                          .section = section,
                          .offset = offset,
                          .volume = volume,
                          .depth = depth};
  PetscCall(CoupleSurfaceCreateHost(PETSC_COMM_SELF, "plate", &spec, &ops, h, surface));
  PetscCall(PetscFree3(rowstart, node, section));
  PetscCall(PetscFree5(shape, slope, offset, volume, depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode make_water(PetscReal dp, Sph *sph)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {LENGTH, 1.2 * HEIGHT, 0}, top[3] = {LENGTH, HEIGHT, 0}, g[3] = {0, -G, 0};
  PetscReal *x, *p;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(SphCreate(PETSC_COMM_SELF, sph));
  PetscCall(SphSetDimension(*sph, 2));
  PetscCall(SphSetSpacing(*sph, dp));
  PetscCall(SphSetKernel(*sph, SPH_KERNEL_WENDLAND));
  PetscCall(SphSetSmoothingRatio(*sph, 1.5));
  PetscCall(SphSetDensity(*sph, RHO));
  PetscCall(SphSetViscosity(*sph, 10.0));
  PetscCall(SphSetMaxSpeed(*sph, PetscSqrtReal(G * HEIGHT)));
  PetscCall(SphSetBodyForce(*sph, g));
  PetscCall(SphSetDomain(*sph, lo, hi));
  PetscCall(SphSetFromOptions(*sph));
  PetscCall(SphFillBox(2, dp, lo, top, NULL, NULL, &n, &x));
  PetscCall(PetscMalloc1(n, &p));
  for (PetscInt i = 0; i < n; i++) p[i] = RHO * G * (HEIGHT - x[3 * i + 1]);
  PetscCall(SphAddFluid(*sph, n, x, NULL, p));
  PetscCall(PetscFree(p));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Side walls, and the floor beside the plate: the walls' corners. */
static PetscErrorCode add_walls(PetscReal dp, Sph sph, Couple couple)
{
  const PetscReal lo[3] = {0, 0, 0}, hi[3] = {LENGTH, 1.2 * HEIGHT, 0}, rest[3] = {0, 0, 0};
  const PetscBool face[6] = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE, PETSC_FALSE, PETSC_FALSE, PETSC_FALSE}, none[3] = {PETSC_FALSE};
  PetscReal support, *x, *volume, *depth;
  PetscInt n, m = 0;
  CoupleSurface wall;

  PetscFunctionBeginUser;
  PetscCall(SphGetSupport(sph, &support));
  PetscCall(SphFillWalls(2, dp, lo, hi, face, none, support, &n, &x, &volume, &depth));
  for (PetscInt i = 0; i < n; i++) {
    if (x[3 * i] > 0.0 && x[3 * i] < LENGTH) continue; /* the plate's place */
    for (int k = 0; k < 3; k++) x[3 * m + k] = x[3 * i + k];
    volume[m] = volume[i];
    depth[m++] = depth[i];
  }
  PetscCall(CoupleSurfaceCreateWall(PETSC_COMM_SELF, "walls", m, x, volume, depth, rest, &wall));
  PetscCall(CoupleAddSurface(couple, wall));
  PetscCall(CoupleSurfaceDestroy(&wall));
  PetscCall(PetscFree(x));
  PetscCall(PetscFree(volume));
  PetscCall(PetscFree(depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The node nearest to the middle of the plate. */
static PetscInt middle(const Solid *s)
{
  PetscInt best = 0;
  PetscReal least = PETSC_MAX_REAL;

  for (PetscInt i = 0; i < s->n; i++) {
    const PetscReal d = PetscSqr(s->X[2 * i] - 0.5 * LENGTH) + PetscSqr(s->X[2 * i + 1] + 0.5 * THICKNESS);
    if (d < least) {
      least = d;
      best = i;
    }
  }
  return best;
}

/* Deflection of the middle (m) of these elements under the exact pressure. */
static PetscErrorCode exact_deflection(Host *h, PetscReal *w)
{
  const PetscScalar *u;
  PetscReal *Q;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * (size_t)h->solid.n, &Q));
  PetscCall(SolidPressure(&h->solid, 2, RHO * G * HEIGHT, Q));
  PetscCall(SolidSetLoads(&h->solid, Q));
  PetscCall(SolidStatic(&h->solid));
  PetscCall(VecGetArrayRead(h->solid.U, &u));
  *w = SolidValue(&h->solid, u, middle(&h->solid), 1);
  PetscCall(VecRestoreArrayRead(h->solid.U, &u));
  PetscCall(VecZeroEntries(h->solid.U));
  PetscCall(PetscFree(Q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Steps to the end; mean deflection and load on the plate over the last third, and the worst transfer loss. */
static PetscErrorCode run(Host *h, Couple couple, PetscReal tend, PetscReal *w, PetscReal *load, PetscReal *lost)
{
  const PetscInt mid = middle(&h->solid);
  PetscReal t = 0.0, dt, span = 0.0, next = 0.0;
  CoupleAudit audit;

  PetscFunctionBeginUser;
  *w = *load = *lost = 0.0;
  while (t < tend) {
    PetscCall(CoupleStep(couple, tend, &dt));
    PetscCall(CoupleGetTime(couple, &t, NULL));
    PetscCall(CoupleGetAudit(couple, 1, &audit));
    for (int k = 0; k < 2; k++) *lost = PetscMax(*lost, PetscAbsReal(audit.force_lost[k] / audit.force[1]));
    *lost = PetscMax(*lost, PetscAbsReal(audit.moment_lost[2] / (audit.force[1] * LENGTH)));
    if (t > next) {
      PetscCall(PetscPrintf(PETSC_COMM_SELF, "t %.3f s  deflection %.4e m  load %.1f N\n", (double)t,
                            (double)(h->q[3 * mid + 1] - h->solid.X[2 * mid + 1]), (double)audit.force[1]));
      next += tend / 12.0;
    }
    if (t <= tend * 2.0 / 3.0) continue;
    *w += dt * (h->q[3 * mid + 1] - h->solid.X[2 * mid + 1]);
    *load += dt * audit.force[1];
    span += dt;
  }
  *w /= span;
  *load /= span;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode couple_all(Host *h, PetscReal dp, Sph *sph, Couple *couple)
{
  PetscReal support;
  CoupleSurface plate;

  PetscFunctionBeginUser;
  PetscCall(make_water(dp, sph));
  PetscCall(CoupleCreate(PETSC_COMM_SELF, couple));
  PetscCall(CoupleSetSph(*couple, *sph));
  PetscCall(CoupleSetFromOptions(*couple));
  PetscCall(add_walls(dp, *sph, *couple));
  PetscCall(SphGetSupport(*sph, &support));
  PetscCall(publish(h, 0.0));
  PetscCall(make_surface(h, dp, support, &plate));
  PetscCall(CoupleAddSurface(*couple, plate));
  PetscCall(CoupleSurfaceDestroy(&plate));
  PetscCall(CoupleSetUp(*couple));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode options(Host *h, PetscReal *dp, PetscReal *tend, PetscReal *check)
{
  Solid *s = &h->solid;

  PetscFunctionBeginUser;
  s->young = 67.5e9, s->poisson = 0.34, s->density = 2700.0, s->gravity = G, s->damping = 1e5;
  PetscOptionsBegin(PETSC_COMM_SELF, "plate_", "Plate", "");
  PetscCall(PetscOptionsReal("-dp", "Marker spacing, m; 0.05 is a whole number of it", "", *dp, dp, NULL));
  PetscCall(PetscOptionsReal("-end", "End time, s", "", *tend, tend, NULL));
  PetscCall(PetscOptionsReal("-check", "Largest relative error of the deflection, exit code 1 beyond; 0: no check", "", *check,
                             check, NULL));
  PetscCall(PetscOptionsReal("-young", "E, Pa", "", s->young, &s->young, NULL));
  PetscCall(PetscOptionsReal("-damping", "Damping by mass, 1/s", "", s->damping, &s->damping, NULL));
  PetscOptionsEnd();
  PetscCheck(*dp > 0.0 && *dp <= THICKNESS && PetscAbsReal(THICKNESS / *dp - (PetscReal)(PetscInt)(THICKNESS / *dp + 0.5)) < 1e-6,
             PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "plate_dp = %g m: must divide the thickness %g m", (double)*dp,
             THICKNESS);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode report(const Host *h, PetscReal w, PetscReal exact, PetscReal load, PetscReal lost, PetscReal *error)
{
  const Solid *s = &h->solid;
  const PetscReal D = s->young * THICKNESS * THICKNESS * THICKNESS / (12.0 * (1.0 - s->poisson * s->poisson)),
                  q = G * (RHO * HEIGHT + s->density * THICKNESS), thin = -q * PetscPowReal(LENGTH, 4) / (384.0 * D),
                  shear = -q * LENGTH * LENGTH / (8.0 * 5.0 / 6.0 * THICKNESS * 0.5 * s->young / (1.0 + s->poisson));

  PetscFunctionBeginUser;
  PetscCall(PetscPrintf(PETSC_COMM_SELF, "load %.1f N, weight of the water %.1f N (%+.2f %%)\n", (double)load,
                        -RHO * G * HEIGHT * LENGTH, 100.0 * (double)(-load / (RHO * G * HEIGHT * LENGTH) - 1.0)));
  PetscCall(PetscPrintf(
      PETSC_COMM_SELF,
      "deflection of the middle %.4e m; the same elements under the exact pressure %.4e m (%+.2f %%); thin plate %.4e m "
      "(%+.2f %%), with shear %.4e m (%+.2f %%)\n",
      (double)w, (double)exact, 100.0 * (double)(w / exact - 1.0), (double)thin, 100.0 * (double)(w / thin - 1.0),
      (double)(thin + shear), 100.0 * (double)(w / (thin + shear) - 1.0)));
  *error = PetscMax(PetscAbsReal(w / exact - 1.0), PetscAbsReal(w / thin - 1.0));
  PetscCall(PetscPrintf(PETSC_COMM_SELF, "lost in transfer: %.1e of force and moment\n", (double)lost));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscReal dp = 0.025, tend = 0.6, check = 0.0, exact = 0.0, w = 0.0, load = 0.0, lost = 0.0, error = 0.0;
  Host host = {0};
  Couple couple;
  Sph sph;
  PetscBool failed;

  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCheck(argc > 1 && argv[1][0] != '-', PETSC_COMM_SELF, PETSC_ERR_USER, "name a mesh: host_plate FILE.msh [options]");
  PetscCall(options(&host, &dp, &tend, &check));
  PetscCall(SolidCreate(argv[1], &host.solid));
  PetscCall(
      PetscCalloc3(3 * (size_t)host.solid.n, &host.q, 3 * (size_t)host.solid.n, &host.v, 3 * (size_t)host.solid.n, &host.a));
  PetscCall(exact_deflection(&host, &exact));
  PetscCall(couple_all(&host, dp, &sph, &couple));
  PetscCall(run(&host, couple, tend, &w, &load, &lost));
  PetscCall(report(&host, w, exact, load, lost, &error));
  failed = check > 0.0 && !(error <= check && lost < 1e-12) ? PETSC_TRUE : PETSC_FALSE;
  if (failed) PetscCall(PetscPrintf(PETSC_COMM_SELF, "FAILED: beyond -plate_check %g\n", (double)check));
  PetscCall(CoupleDestroy(&couple));
  PetscCall(SphDestroy(&sph));
  PetscCall(SolidDestroy(&host.solid));
  PetscCall(PetscFree3(host.q, host.v, host.a));
  PetscCall(PetscFinalize());
  return failed ? 1 : 0;
}
