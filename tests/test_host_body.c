/*
  test_host_body.c - structures of a host code through CoupleSurfaceCreateHost().

  1. A beam that this program owns and drives through the host interface, with rows of its own, moves with the same bits as the
  one built in.
  2. Transfer of random forces to nodes in random motion, for solids in 2D and 3D (no slopes) and for lines (slopes): force,
  moment and power are kept to round-off, the generalised forces do the virtual work of the marker forces, velocities and
  accelerations are the derivatives of positions.
  3. A host that cannot be: one clear error each.
*/
#include "host_scene.h"
#include "testerror.h"

/* ---- 1: a host that owns an Ancf ---- */

static PetscErrorCode GetState_Own(void *ctx, PetscReal *t, const PetscReal **q, const PetscReal **qdot, const PetscReal **qddot)
{
  PetscFunctionBegin;
  PetscCall(AncfGetState((Ancf)ctx, t, q, qdot, qddot));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Advance_Own(void *ctx, PetscReal t, const PetscReal *Q)
{
  PetscReal *load;
  PetscInt n;

  PetscFunctionBegin;
  PetscCall(AncfGetNumNodes((Ancf)ctx, &n));
  PetscCall(AncfGetLoads((Ancf)ctx, &load));
  PetscCall(PetscArraycpy(load, Q, 6 * n));
  PetscCall(AncfAdvance((Ancf)ctx, t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows from the disks' places along the axis; the markers' places on the disks, volumes and depths are those of the beam built
 * in. */
static PetscErrorCode OwnBeam(Ancf ancf, PetscReal support, CoupleSurface *surface)
{
  const CoupleHostOps ops = {.getstate = GetState_Own, .advance = Advance_Own};
  CoupleSurface builtin;
  CoupleHostSpec spec;
  AncfBeamSpec beam;
  PetscReal l, *S, *Sx, ds;
  PetscInt *rowstart, *node;
  PetscBool *direction;

  PetscFunctionBegin;
  PetscCall(CoupleSurfaceCreateBeam(ancf, 0, 3, DP, support, &builtin));
  PetscCall(CoupleSurfaceHostGetSpec(builtin, &spec));
  PetscCall(AncfGetBeam(ancf, 0, &beam, NULL, &l));
  PetscCall(PetscMalloc5(spec.nsections + 1, &rowstart, 4 * (size_t)spec.nsections, &node, spec.nnodes, &direction,
                         4 * (size_t)spec.nsections, &S, 4 * (size_t)spec.nsections, &Sx));
  for (PetscInt j = 0; j < spec.nnodes; j++) direction[j] = j % 2 ? PETSC_TRUE : PETSC_FALSE;
  ds = l * (PetscReal)beam.elements / (PetscReal)spec.nsections;
  rowstart[0] = 0;
  for (PetscInt d = 0; d < spec.nsections; d++) {
    const PetscReal s = ((PetscReal)d + 0.5) * ds;
    const PetscInt element = (PetscInt)(s / l);
    AncfShape(s / l - (PetscReal)element, l, S + 4 * d);
    AncfShapeX(s / l - (PetscReal)element, l, Sx + 4 * d);
    for (PetscInt j = 0; j < 4; j++) node[4 * d + j] = 2 * element + j;
    rowstart[d + 1] = 4 * (d + 1);
  }
  spec.rowstart = rowstart;
  spec.node = node;
  spec.shape = S;
  spec.slope = Sx;
  spec.direction = direction;
  PetscCall(CoupleSurfaceCreateHost(PETSC_COMM_SELF, "own", &spec, &ops, ancf, surface));
  PetscCall(PetscFree5(rowstart, node, direction, S, Sx));
  PetscCall(CoupleSurfaceDestroy(&builtin));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestSameBits(void)
{
  PetscReal *a, *b, *a0, largest = 0;
  PetscInt n, n0, steps = 40, nodes;
  const PetscReal *e;
  CoupleAudit audit;
  Scene one, two;

  PetscFunctionBegin;
  PetscCall(SceneCreate(BuiltinBeam, &one));
  PetscCall(SceneCreate(OwnBeam, &two));
  PetscCall(SceneNumbers(&one, &n0, &a0));
  for (PetscInt i = 0; i < steps; i++) {
    PetscCall(CoupleStep(one.couple, 10.0, NULL));
    PetscCall(CoupleStep(two.couple, 10.0, NULL));
  }
  PetscCall(SceneNumbers(&one, &n, &a));
  PetscCall(SceneNumbers(&two, &n0, &b));
  PetscCall(AncfGetNumNodes(one.ancf, &nodes));
  PetscCall(AncfGetState(one.ancf, NULL, &e, NULL, NULL));
  for (PetscInt i = 0; i < n; i++) largest = PetscMax(largest, PetscAbsReal(a[i] - a0[i]));
  PetscCall(CoupleGetAudit(two.couple, two.beam, &audit));
  printf("ANCF beam through the host interface: %" PetscInt_FMT " steps, %" PetscInt_FMT " numbers of the state, %" PetscInt_FMT
         " differ from the beam built in; tip moved %.3e m; force on it (%g, %g, %g) N\n",
         steps, n, DifferentBits(n, a, b), (double)(e[6 * (nodes - 1)] - scene_beam[0]), (double)audit.force[0],
         (double)audit.force[1], (double)audit.force[2]);
  TEST(n == n0 && DifferentBits(n, a, b) == 0, "%d numbers differ", (int)DifferentBits(n, a, b));
  TEST(largest > 1e-3 && PetscAbsReal(e[6 * (nodes - 1)] - scene_beam[0]) > 1e-6, "nothing moved: %g", (double)largest);
  PetscCall(PetscFree(a));
  PetscCall(PetscFree(b));
  PetscCall(PetscFree(a0));
  PetscCall(SceneDestroy(&one));
  PetscCall(SceneDestroy(&two));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- 2: the transfer ---- */

typedef struct {
  PetscInt n;         /* numbers */
  PetscReal *q[3], t; /* q, q', q'' */
} Cloud;

static PetscRandom rnd;

static double Random(double a, double b)
{
  PetscScalar s;
  PetscCallAbort(PETSC_COMM_SELF, PetscRandomGetValue(rnd, &s));
  return a + (b - a) * PetscRealPart(s);
}

static PetscErrorCode GetState_Cloud(void *ctx, PetscReal *t, const PetscReal **q, const PetscReal **v, const PetscReal **a)
{
  const Cloud *c = (const Cloud *)ctx;
  if (t) *t = c->t;
  if (q) *q = c->q[0];
  if (v) *v = c->q[1];
  if (a) *a = c->q[2];
  return PETSC_SUCCESS;
}

static PetscErrorCode Advance_Cloud(void *ctx, PetscReal t, const PetscReal *Q)
{
  (void)Q;
  ((Cloud *)ctx)->t = t;
  return PETSC_SUCCESS;
}

/* An element of 2^dim nodes with bilinear shape functions, or a line of three nodes and three directions; markers at random. */
#define NSEC 12
#define NMARK (3 * NSEC)
typedef struct {
  PetscInt rowstart[NSEC + 1], node[8 * NSEC], section[NMARK];
  PetscBool direction[8];
  PetscReal shape[8 * NSEC], slope[8 * NSEC], offset[2 * NMARK], volume[NMARK], depth[NMARK];
} Arrays;

static void Fill(PetscInt dim, PetscBool line, Arrays *r, CoupleHostSpec *spec)
{
  const PetscInt nn = line ? 6 : (dim == 2 ? 4 : 8), m = line ? 4 : nn;

  r->rowstart[0] = 0;
  for (PetscInt s = 0; s < NSEC; s++) {
    const double x[3] = {Random(0, 1), Random(0, 1), Random(0, 1)};
    const PetscInt el = line ? s % 2 : 0;
    r->rowstart[s + 1] = m * (s + 1);
    if (line) {
      AncfShape(x[0], 0.5, r->shape + m * s);
      AncfShapeX(x[0], 0.5, r->slope + m * s);
    }
    for (PetscInt j = 0; j < m; j++) {
      r->node[m * s + j] = line ? 2 * el + j : j;
      if (line) continue;
      r->shape[m * s + j] = (j & 1 ? x[0] : 1 - x[0]) * (j & 2 ? x[1] : 1 - x[1]);
      if (dim == 3) r->shape[m * s + j] *= j & 4 ? x[2] : 1 - x[2];
    }
    for (PetscInt k = 3 * s; k < 3 * s + 3; k++) {
      r->section[k] = s;
      r->offset[2 * k] = line ? Random(-0.05, 0.05) : 0.0;
      r->offset[2 * k + 1] = line && dim == 3 ? Random(-0.05, 0.05) : 0.0;
      r->volume[k] = r->depth[k] = 1e-3;
    }
  }
  for (PetscInt j = 0; j < nn; j++) r->direction[j] = line && j % 2 ? PETSC_TRUE : PETSC_FALSE;
  *spec = (CoupleHostSpec){dim,   nn,         r->direction, NSEC,      r->rowstart, r->node, r->shape, line ? r->slope : NULL,
                           NMARK, r->section, r->offset,    r->volume, r->depth};
}

/* Nodes about their places, in motion. */
static void Shake(PetscInt dim, PetscBool line, Cloud *c)
{
  for (PetscInt i = 0; i < c->n; i++) {
    const PetscInt j = i / 3, k = i % 3;
    double rest = line ? (k == 0 ? (j % 2 ? 1.0 : 0.5 * (double)(j / 2)) : 0.0) : (double)((j >> k) & 1);
    const double s = dim == 2 && k == 2 ? 0.0 : 0.2;
    if (s == 0.0) rest = 0.0;
    c->q[0][i] = rest + s * Random(-1, 1);
    c->q[1][i] = 5.0 * s * Random(-1, 1);
    c->q[2][i] = 5.0 * s * Random(-1, 1);
  }
}

static void Totals(const PetscReal *x, const PetscReal *v, const PetscReal *f, CoupleAudit *a)
{
  for (PetscInt i = 0; i < NMARK; i++) {
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

/*
  Central differences over +-dt: their error is dt^2/6 third derivatives, some hundred m/s^3 here, so below 1e-9 at dt = 3e-6;
  round-off of positions adds eps/dt = 1e-10 to velocities. Accelerations: fourth derivatives some thousand, and the same
  round-off.
*/
static PetscErrorCode CheckMotion(CoupleSurface s, const CoupleSurfaceOps *ops)
{
  static PetscReal x[3][3 * NMARK], v[3][3 * NMARK], a[3][3 * NMARK];
  const double dt = 3e-6;
  double worst[2] = {0, 0};

  PetscFunctionBegin;
  PetscCall((*ops->kinematics)(s, -dt, x[0], v[0], a[0]));
  PetscCall((*ops->kinematics)(s, dt, x[2], v[2], a[2]));
  PetscCall((*ops->kinematics)(s, 0.0, x[1], v[1], a[1]));
  for (PetscInt i = 0; i < 3 * NMARK; i++) {
    worst[0] = fmax(worst[0], fabs((x[2][i] - x[0][i]) / (2 * dt) - v[1][i]));
    worst[1] = fmax(worst[1], fabs((v[2][i] - v[0][i]) / (2 * dt) - a[1][i]));
  }
  TEST_NEAR(worst[0], 0.0, 2e-9, "marker velocity against differences of positions");
  TEST_NEAR(worst[1], 0.0, 2e-8, "marker acceleration against differences of velocities");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* sum F . dx against Q . dq for a small change of the nodes; the differences leave (dq)^2 relative, 1e-8. */
static PetscErrorCode CheckWork(CoupleSurface s, const CoupleSurfaceOps *ops, Cloud *c, const PetscReal *f)
{
  static PetscReal x[2][3 * NMARK], v[3 * NMARK], a[3 * NMARK];
  const PetscReal *Q;
  PetscReal dq[24];
  double work = 0, size = 0, gen = 0;

  PetscFunctionBegin;
  PetscCall(CoupleSurfaceHostGetLoads(s, &Q));
  for (PetscInt i = 0; i < c->n; i++) {
    dq[i] = c->q[0][i] == 0.0 ? 0.0 : 1e-4 * Random(-1, 1);
    gen += Q[i] * dq[i];
  }
  for (int side = 0; side < 2; side++) {
    for (PetscInt i = 0; i < c->n; i++) c->q[0][i] += (side ? 1.0 : -0.5) * dq[i];
    PetscCall((*ops->kinematics)(s, 0.0, x[side], v, a));
  }
  for (PetscInt i = 0; i < c->n; i++) c->q[0][i] -= 0.5 * dq[i];
  for (PetscInt i = 0; i < 3 * NMARK; i++) {
    work += f[i] * (x[1][i] - x[0][i]);
    size += fabs(f[i] * (x[1][i] - x[0][i]));
  }
  TEST_NEAR(gen, work, 1e-6 * size, "virtual work of the generalised forces");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TestTransfer(PetscInt dim, PetscBool line)
{
  const CoupleHostOps hostops = {.getstate = GetState_Cloud, .advance = Advance_Cloud};
  static PetscReal x[3 * NMARK], v[3 * NMARK], a[3 * NMARK], f[3 * NMARK];
  Arrays *r;
  CoupleHostSpec spec;
  CoupleSurface s;
  CoupleSurfaceOps ops;
  Cloud c = {0};
  double size = 0, lost = 0;

  PetscFunctionBegin;
  PetscCall(PetscNew(&r));
  Fill(dim, line, r, &spec);
  c.n = 3 * spec.nnodes;
  for (int k = 0; k < 3; k++) PetscCall(PetscMalloc1(c.n, &c.q[k]));
  Shake(dim, line, &c);
  PetscCall(CoupleSurfaceCreateHost(PETSC_COMM_SELF, "cloud", &spec, &hostops, &c, &s));
  PetscCall(CoupleSurfaceGetOps(s, &ops));
  PetscCall(CheckMotion(s, &ops));
  for (PetscInt i = 0; i < 3 * NMARK; i++) {
    f[i] = dim == 2 && i % 3 == 2 ? 0.0 : Random(-1, 1);
    size += fabs(f[i]);
  }
  for (int when = 0; when < 2; when++) { /* extrapolated, as in a step; then at the host's own time */
    CoupleAudit audit = {0};
    const double tol = 64 * PETSC_MACHINE_EPSILON * size * 4; /* products of numbers up to 4, summed */
    PetscCall((*ops.kinematics)(s, when ? 0.0 : 1e-2, x, v, a));
    Totals(x, v, f, &audit);
    PetscCall((*ops.zeroloads)(s));
    PetscCall((*ops.applyforces)(s, f, &audit));
    for (int k = 0; k < 3; k++) {
      TEST_NEAR(audit.force_lost[k], 0.0, tol, "force lost");
      TEST_NEAR(audit.moment_lost[k], 0.0, tol, "moment lost");
      lost = fmax(lost, fmax(fabs(audit.force_lost[k]), fabs(audit.moment_lost[k])));
    }
    TEST_NEAR(audit.power_lost, 0.0, tol, "power lost");
    TEST(line && dim == 3 ? audit.twist != 0.0 : audit.twist == 0.0, "twist %g", (double)audit.twist);
    lost = fmax(lost, fabs(audit.power_lost));
  }
  PetscCall(CheckWork(s, &ops, &c, f));
  printf("%s in %dD: largest loss of force, moment, power %.1e of %.3g\n", line ? "line with offsets" : "solid", (int)dim, lost,
         size);
  PetscCall(CoupleSurfaceDestroy(&s));
  for (int k = 0; k < 3; k++) PetscCall(PetscFree(c.q[k]));
  PetscCall(PetscFree(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- 3: bad input ---- */

static PetscErrorCode TestRefused(void)
{
  const CoupleHostOps ops = {.getstate = GetState_Cloud, .advance = Advance_Cloud};
  const char *const wanted[] = {"node 9 must be in [0, 6)",
                                "add up to 2; must be 1",
                                "volume = -1. must be > 0",
                                "needs slopes",
                                "and ascend",
                                "the tangent has the length 0",
                                "getstate and advance must be given"};
  Arrays *r;
  Cloud c = {0};

  PetscFunctionBegin;
  PetscCall(PetscNew(&r));
  c.n = 18;
  for (int k = 0; k < 3; k++) PetscCall(PetscCalloc1(c.n, &c.q[k]));
  for (int bad = 0; bad < 7; bad++) {
    CoupleHostSpec spec;
    CoupleHostOps o = ops;
    CoupleSurface s = NULL;
    Fill(3, PETSC_TRUE, r, &spec);
    Shake(3, PETSC_TRUE, &c);
    if (bad == 0) r->node[5] = 9;
    if (bad == 1) r->shape[0] += 1.0;
    if (bad == 2) r->volume[3] = -1.0;
    if (bad == 3) spec.slope = NULL;
    if (bad == 4) r->section[0] = 4;
    if (bad == 5) PetscCall(PetscArrayzero(c.q[0], c.n));
    if (bad == 6) o.advance = NULL;
    TEST_REFUSED(CoupleSurfaceCreateHost(PETSC_COMM_SELF, "cloud", &spec, &o, &c, &s), wanted[bad]);
  }
  for (int k = 0; k < 3; k++) PetscCall(PetscFree(c.q[k]));
  PetscCall(PetscFree(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscRandomCreate(PETSC_COMM_SELF, &rnd));
  PetscCall(PetscRandomSetSeed(rnd, 11));
  PetscCall(PetscRandomSeed(rnd));
  for (int k = 0; k < 3; k++) {
    PetscCall(TestTransfer(2, PETSC_FALSE));
    PetscCall(TestTransfer(3, PETSC_FALSE));
    PetscCall(TestTransfer(2, PETSC_TRUE));
    PetscCall(TestTransfer(3, PETSC_TRUE));
  }
  PetscCall(TestRefused());
  PetscCall(TestSameBits());
  PetscCall(PetscRandomDestroy(&rnd));
  PetscCall(PetscFinalize());
  return test_report();
}
