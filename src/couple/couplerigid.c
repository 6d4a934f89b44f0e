/*
  couplerigid.c - adapter of a rigid body: BCE markers fixed in the body frame, wrench about the centre of mass (Eqs. 12 and 14).
*/
#include "coupleimpl.h"
#include "sectionmath.h"

typedef struct {
  Rigid rigid;
  PetscInt body, n;
  PetscReal mass;
  PetscReal *xb, *x0, *volume, *depth; /* body frame and rest positions (n x 3), volumes, depths (n) */
  PetscReal X[3], V[3], omega[3];      /* state of the last kinematics call */
  PetscReal *o;                        /* markers from the centre of mass in that call, n x 3 */
  PetscReal F[3], T[3];                /* fluid force and torque of the last step */
  PetscReal A[3], alpha[3], dt;        /* mean accelerations over the last step, its length */
  PetscReal V0[3], omega0[3], t0;      /* at the end of the last step */
  PetscBool jointed;
} Body;

static PetscErrorCode GetMarkers_Rigid(CoupleSurface s, PetscInt *n, const PetscReal **x, const PetscReal **volume,
                                       const PetscReal **depth)
{
  const Body *b = (const Body *)s->ctx;

  PetscFunctionBegin;
  *n = b->n;
  *x = b->x0;
  *volume = b->volume;
  *depth = b->depth;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rotate o by the rotation vector p (Rodrigues). */
static void Rotate(const PetscReal p[3], const PetscReal o[3], PetscReal r[3])
{
  const PetscReal angle = PetscSqrtReal(CoupleDot(p, p));
  PetscReal c[3], d[3], s1 = 1.0, s2 = 0.5;

  if (angle > 1e-8) {
    s1 = PetscSinReal(angle) / angle;
    s2 = 2.0 * PetscSqr(PetscSinReal(0.5 * angle) / angle);
  }
  CoupleCross(p, o, c);
  CoupleCross(p, c, d);
  for (int k = 0; k < 3; k++) r[k] = o[k] + s1 * c[k] + s2 * d[k];
}

/* The body extrapolated by dt, as the state of a section: sectionmath.h. */
static PetscErrorCode LinkState_Rigid(CoupleSurface s, PetscReal dt, PetscReal *state)
{
  Body *b = (Body *)s->ctx;
  PetscReal q[4], R[9], A[3], alpha[3], turn[3];

  PetscFunctionBegin;
  PetscCall(RigidGetState(b->rigid, b->body, b->X, q, b->V, b->omega));
  PetscCall(RigidGetAcceleration(b->rigid, b->body, A, alpha));
  for (int k = 0; b->jointed && b->dt > 0.0 && k < 3; k++) {
    A[k] = b->A[k];
    alpha[k] = b->alpha[k];
  }
  RigidRotationMatrix(q, R);
  for (int k = 0; k < 3; k++) {
    turn[k] = dt * (b->omega[k] + 0.5 * dt * alpha[k]);
    state[k] = b->X[k] += dt * (b->V[k] + 0.5 * dt * A[k]);
    state[3 + k] = b->V[k] += dt * A[k];
    state[6 + k] = A[k];
    state[9 + k] = b->omega[k] += dt * alpha[k];
    state[12 + k] = alpha[k];
  }
  for (int c = 0; c < 3; c++) {
    const PetscReal e[3] = {R[c], R[3 + c], R[6 + c]};
    PetscReal turned[3];
    Rotate(turn, e, turned);
    for (int k = 0; k < 3; k++) state[15 + 3 * k + c] = turned[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Kinematics_Rigid(CoupleSurface s, PetscReal dt, PetscReal *x, PetscReal *v, PetscReal *a)
{
  Body *b = (Body *)s->ctx;
  PetscReal state[SECTION_BODY_STATE];
  FrondSection frame;

  PetscFunctionBegin;
  PetscCall(LinkState_Rigid(s, dt, state));
  section_from_body(state, &frame);
  for (PetscInt i = 0; i < b->n; i++) {
    section_offset(&frame, b->xb + 3 * i, b->o + 3 * i);
    section_marker(&frame, b->o + 3 * i, x + 3 * i, v + 3 * i, a + 3 * i);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Rotation_Rigid(CoupleSurface s, PetscReal *omega)
{
  const Body *b = (const Body *)s->ctx;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < 3 * b->n; i++) omega[i] = b->omega[i % 3];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes back what the last step added: loads that the host gave the body stay. */
static PetscErrorCode ZeroLoads_Rigid(CoupleSurface s)
{
  Body *b = (Body *)s->ctx;

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    b->F[k] = -b->F[k];
    b->T[k] = -b->T[k];
  }
  PetscCall(RigidAddLoad(b->rigid, b->body, b->F, b->T));
  for (int k = 0; k < 3; k++) b->F[k] = b->T[k] = 0.0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fluid force and torque about the centre of mass of the last kinematics call. */
static PetscErrorCode ApplyLoads_Rigid(CoupleSurface s, const PetscReal *load, const SphLinkTotals *totals, CoupleAudit *audit)
{
  Body *b = (Body *)s->ctx;
  PetscReal XF[3];

  PetscFunctionBegin;
  (void)totals;
  PetscCall(PetscArraycpy(b->F, load, 3));
  PetscCall(PetscArraycpy(b->T, load + 3, 3));
  PetscCall(RigidAddLoad(b->rigid, b->body, b->F, b->T));
  CoupleCross(b->X, b->F, XF);
  for (int k = 0; k < 3; k++) {
    audit->force_lost[k] = audit->force[k] - b->F[k];
    audit->moment_lost[k] = audit->moment[k] - (XF[k] + b->T[k]);
  }
  audit->power_lost = audit->power - (CoupleDot(b->F, b->V) + CoupleDot(b->T, b->omega));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ApplyForces_Rigid(CoupleSurface s, const PetscReal *f, CoupleAudit *audit)
{
  const Body *b = (const Body *)s->ctx;
  PetscReal sums[SECTION_SUMS] = {0.0};

  PetscFunctionBegin;
  for (PetscInt i = 0; i < b->n; i++) section_add_force(b->o + 3 * i, f + 3 * i, sums);
  PetscCall(ApplyLoads_Rigid(s, sums, NULL, audit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetLink_Rigid(CoupleSurface s, SphLinkSpec *spec)
{
  PetscFunctionBegin;
  *spec = (SphLinkSpec){.nsections = 1, .offset = ((const Body *)s->ctx)->xb};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* RigidGetAcceleration() is that of the last substep, joints included: jointed bodies go by their mean over the step instead. */
static PetscErrorCode Advance_Rigid(CoupleSurface s, PetscReal t)
{
  Body *b = (Body *)s->ctx;
  PetscReal now;

  PetscFunctionBegin;
  PetscCall(RigidGetTime(b->rigid, &now));
  if (now < t) PetscCall(RigidAdvance(b->rigid, t));
  b->dt = t - b->t0;
  PetscCall(RigidGetState(b->rigid, b->body, NULL, NULL, b->A, b->alpha));
  for (int k = 0; k < 3; k++) {
    const PetscReal V = b->A[k], w = b->alpha[k];
    b->A[k] = (V - b->V0[k]) / b->dt;
    b->alpha[k] = (w - b->omega0[k]) / b->dt;
    b->V0[k] = V;
    b->omega0[k] = w;
  }
  b->t0 = t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Weight: what accelerates the body beyond the fluid's force by itself; support: by how much the
   mean acceleration of a jointed body over the step differs from that of the last substep. */
static PetscErrorCode Momentum_Rigid(CoupleSurface s, PetscReal p[3], PetscReal weight[3], PetscReal support[3])
{
  const Body *b = (const Body *)s->ctx;
  PetscReal V[3], A[3], alpha[3];

  PetscFunctionBegin;
  PetscCall(RigidGetState(b->rigid, b->body, NULL, NULL, V, NULL));
  PetscCall(RigidGetAcceleration(b->rigid, b->body, A, alpha));
  for (int k = 0; k < 3; k++) {
    p[k] = b->mass * V[k];
    weight[k] = b->mass * A[k] - b->F[k];
    support[k] = b->jointed ? b->mass * (b->A[k] - A[k]) : 0.0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the adapter remembers of the last step. */
#define BODY_MEMORY 20
static void Memory(Body *b, PetscReal *p[BODY_MEMORY])
{
  for (int k = 0; k < 3; k++) {
    p[k] = &b->F[k], p[3 + k] = &b->T[k], p[6 + k] = &b->A[k];
    p[9 + k] = &b->alpha[k], p[12 + k] = &b->V0[k], p[15 + k] = &b->omega0[k];
  }
  p[18] = &b->dt, p[19] = &b->t0;
}

/* That, and the solver's time and bodies, which body 0 saves for all. */
static PetscErrorCode StateSize_Rigid(CoupleSurface s, PetscInt *n)
{
  const Body *b = (const Body *)s->ctx;
  PetscInt pack;

  PetscFunctionBegin;
  *n = BODY_MEMORY;
  if (b->body) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(RigidGetPackSize(b->rigid, &pack));
  *n += 1 + pack;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Save_Rigid(CoupleSurface s, PetscReal *state)
{
  Body *b = (Body *)s->ctx;
  PetscReal *p[BODY_MEMORY];

  PetscFunctionBegin;
  Memory(b, p);
  for (int k = 0; k < BODY_MEMORY; k++) state[k] = *p[k];
  if (b->body) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(RigidGetTime(b->rigid, &state[BODY_MEMORY]));
  PetscCall(RigidPack(b->rigid, state + BODY_MEMORY + 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Load_Rigid(CoupleSurface s, const PetscReal *state)
{
  Body *b = (Body *)s->ctx;
  PetscReal *p[BODY_MEMORY];

  PetscFunctionBegin;
  Memory(b, p);
  for (int k = 0; k < BODY_MEMORY; k++) *p[k] = state[k];
  if (b->body) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(RigidSetTime(b->rigid, state[BODY_MEMORY]));
  PetscCall(RigidUnpack(b->rigid, state + BODY_MEMORY + 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode View_Rigid(CoupleSurface s, PetscViewer viewer)
{
  const Body *b = (const Body *)s->ctx;

  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "  body %s: %" PetscInt_FMT " markers\n", s->name, b->n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy_Rigid(CoupleSurface s)
{
  Body *b = (Body *)s->ctx;

  PetscFunctionBegin;
  PetscCall(PetscFree(b->xb));
  PetscCall(PetscFree(b->volume));
  PetscCall(PetscFree(b->depth));
  PetscCall(PetscFree2(b->x0, b->o));
  PetscCall(PetscFree(s->ctx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A surface of the body without markers. */
static PetscErrorCode CreateBody(Rigid rigid, PetscInt body, const char name[], Body **out, CoupleSurface *surface)
{
  const CoupleSurfaceOps ops = {.getmarkers = GetMarkers_Rigid,
                                .kinematics = Kinematics_Rigid,
                                .rotation = Rotation_Rigid,
                                .zeroloads = ZeroLoads_Rigid,
                                .applyforces = ApplyForces_Rigid,
                                .advance = Advance_Rigid,
                                .momentum = Momentum_Rigid,
                                .view = View_Rigid,
                                .destroy = Destroy_Rigid,
                                .statesize = StateSize_Rigid,
                                .save = Save_Rigid,
                                .load = Load_Rigid,
                                .getlink = GetLink_Rigid,
                                .linkstate = LinkState_Rigid,
                                .applyloads = ApplyLoads_Rigid};
  RigidBodySpec spec;
  PetscInt joints;
  Body *b;

  PetscFunctionBegin;
  PetscCall(RigidGetBody(rigid, body, &spec));
  PetscCall(PetscNew(&b));
  b->rigid = rigid;
  b->body = body;
  b->mass = spec.mass;
  PetscCall(RigidGetNumJoints(rigid, &joints));
  b->jointed = joints > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(RigidGetState(rigid, body, NULL, NULL, b->V0, b->omega0));
  PetscCall(RigidGetTime(rigid, &b->t0));
  PetscCall(CoupleSurfaceCreate(PETSC_COMM_SELF, name, &ops, b, surface));
  PetscCall(CoupleSurfaceSetHeld(*surface, spec.motion != RIGID_FREE ? PETSC_TRUE : PETSC_FALSE));
  *out = b;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Room for the state of the markers in xb, and their places now. */
static PetscErrorCode PlaceMarkers(CoupleSurface surface, Body *b)
{
  PetscReal *v, *a;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(3 * (size_t)b->n, &b->x0, 3 * (size_t)b->n, &b->o));
  PetscCall(PetscMalloc2(3 * (size_t)b->n, &v, 3 * (size_t)b->n, &a));
  PetscCall(Kinematics_Rigid(surface, 0.0, b->x0, v, a));
  PetscCall(PetscFree2(v, a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CoupleSurfaceCreateRigid - Surface of body `body` (set up before), filled with BCE markers dp apart to depthmax (m) below its
surface.
@*/
PetscErrorCode CoupleSurfaceCreateRigid(Rigid rigid, PetscInt body, PetscInt dim, PetscReal dp, PetscReal depthmax,
                                        CoupleSurface *surface)
{
  RigidBodySpec spec;
  char name[64];
  Body *b;

  PetscFunctionBegin;
  PetscCall(RigidGetBody(rigid, body, &spec));
  PetscCall(PetscSNPrintf(name, sizeof(name), "body_%" PetscInt_FMT, body));
  PetscCall(CreateBody(rigid, body, name, &b, surface));
  PetscCall(RigidFillMarkers(&spec, dim, dp, depthmax, &b->n, &b->xb, &b->volume, &b->depth));
  PetscCall(PlaceMarkers(*surface, b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CoupleSurfaceCreateMoving - Markers that prescribed body `body` (set up before) carries along from where they are now.
@*/
PetscErrorCode CoupleSurfaceCreateMoving(Rigid rigid, PetscInt body, const char name[], PetscInt n, const PetscReal *x,
                                         const PetscReal *volume, const PetscReal *depth, CoupleSurface *surface)
{
  PetscReal X[3], q[4], R[9];
  Body *b;

  PetscFunctionBegin;
  PetscCall(CreateBody(rigid, body, name, &b, surface));
  b->n = n;
  PetscCall(PetscMalloc1(3 * (size_t)n, &b->xb));
  PetscCall(PetscMalloc1(n, &b->volume));
  PetscCall(PetscMalloc1(n, &b->depth));
  PetscCall(PetscArraycpy(b->volume, volume, n));
  PetscCall(PetscArraycpy(b->depth, depth, n));
  PetscCall(RigidGetState(rigid, body, X, q, NULL, NULL));
  RigidRotationMatrix(q, R);
  for (PetscInt i = 0; i < n; i++)
    for (int k = 0; k < 3; k++) {
      b->xb[3 * i + k] = 0.0;
      for (int l = 0; l < 3; l++) b->xb[3 * i + k] += R[3 * l + k] * (x[3 * i + l] - X[l]);
    }
  PetscCall(PlaceMarkers(*surface, b));
  PetscFunctionReturn(PETSC_SUCCESS);
}
