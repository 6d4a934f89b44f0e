/*
  rigid.c - life cycle, options, state access and sums of the rigid bodies; no dynamics (rigidstep.c), no shapes (rigidshape.c).

  Every rank of the communicator holds every body and must make the same calls: the bodies are replicated, not distributed.
*/
#include "rigidgeometry.h"

PetscLogEvent RIGID_Advance, RIGID_Fill, RIGID_Contact;

PetscErrorCode RigidRegisterEvents(void)
{
  static PetscBool registered = PETSC_FALSE;
  PetscClassId id;

  PetscFunctionBegin;
  if (registered) PetscFunctionReturn(PETSC_SUCCESS);
  registered = PETSC_TRUE;
  PetscCall(PetscClassIdRegister("Rigid bodies", &id));
  PetscCall(PetscLogEventRegister("RigidAdvance", id, &RIGID_Advance));
  PetscCall(PetscLogEventRegister("RigidFill", id, &RIGID_Fill));
  PetscCall(PetscLogEventRegister("RigidContact", id, &RIGID_Contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Collective. The object holds no bodies, no gravity, dim = 3, t = 0. */
PetscErrorCode RigidCreate(MPI_Comm comm, Rigid *rigid)
{
  PetscFunctionBegin;
  PetscCall(RigidRegisterEvents());
  PetscCall(PetscNew(rigid));
  (*rigid)->comm = comm;
  (*rigid)->dim = 3;
  (*rigid)->substeps = 1;
  PetscCall(ShortRangeInit(&(*rigid)->shortrange));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Options are then -<prefix>rigid_gravity and so on. */
PetscErrorCode RigidSetOptionsPrefix(Rigid rigid, const char prefix[])
{
  PetscFunctionBegin;
  PetscCall(PetscFree(rigid->prefix));
  PetscCall(PetscStrallocpy(prefix, &rigid->prefix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidSetDimension(Rigid rigid, PetscInt dim)
{
  PetscFunctionBegin;
  PetscCheck(dim == 2 || dim == 3, rigid->comm, PETSC_ERR_ARG_OUTOFRANGE, "-rigid_dimension %" PetscInt_FMT ": must be 2 or 3",
             dim);
  PetscCheck(rigid->n == 0 || dim == rigid->dim, rigid->comm, PETSC_ERR_ORDER, "Call RigidSetDimension() before RigidAddBody()");
  rigid->dim = dim;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A free sphere of water's density at rest in the origin, without a radius; mass and inertia from the shape; no locks. */
PetscErrorCode RigidBodySpecInit(RigidBodySpec *spec)
{
  PetscFunctionBegin;
  PetscCall(PetscMemzero(spec, sizeof(*spec)));
  spec->shape = RIGID_SPHERE;
  spec->motion = RIGID_FREE;
  spec->density = 1000.;
  spec->axisangle[2] = 1.;
  spec->mass = PETSC_DECIDE;
  for (int k = 0; k < 3; k++) spec->inertia[k] = PETSC_DECIDE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks every field of spec; errors name the body, the field, its value and the rule. body may be NULL. */
PetscErrorCode RigidAddBody(Rigid rigid, const RigidBodySpec *spec, PetscInt *body)
{
  RigidBody *b;

  PetscFunctionBegin;
  PetscCheck(!rigid->setup, rigid->comm, PETSC_ERR_ORDER, "RigidAddBody() must come before RigidSetUp()");
  PetscCall(RigidSpecCheck(rigid->comm, rigid->n, rigid->dim, spec));
  if (rigid->n == rigid->nalloc) {
    RigidBody *more;
    rigid->nalloc = 2 * rigid->nalloc + 8;
    PetscCall(PetscCalloc1(rigid->nalloc, &more));
    if (rigid->n) PetscCall(PetscArraycpy(more, rigid->body, rigid->n));
    PetscCall(PetscFree(rigid->body));
    rigid->body = more;
  }
  b = &rigid->body[rigid->n];
  b->spec = *spec;
  for (PetscInt k = RigidShapeNumSizes(spec->shape, rigid->dim); k < 3; k++) b->spec.size[k] = 0.;
  if (rigid->dim == 2) b->spec.lock[2] = b->spec.lock[3] = b->spec.lock[4] = PETSC_TRUE;
  if (spec->geometry) PetscCall(RigidGeometryReference(spec->geometry));
  if (spec->geometry && spec->shape == RIGID_COMPOSITE) b->spec.density = spec->geometry->density;
  b->volume = RigidShapeVolume(&b->spec, rigid->dim);
  if (body) *body = rigid->n;
  rigid->n++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* g in m/s^2 (space frame). */
PetscErrorCode RigidSetGravity(Rigid rigid, const PetscReal g[3])
{
  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    PetscCheck(!PetscIsInfOrNanReal(g[k]), rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "-rigid_gravity: component %d = %g is not a finite number", k, (double)g[k]);
    rigid->g[k] = g[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rho > 0 (kg/m^3): bodies weigh (m - rho V) g, for fluids whose own hydrostatic pressure is left out; 0 (default): m g. */
PetscErrorCode RigidSetFluidDensity(Rigid rigid, PetscReal rho)
{
  PetscFunctionBegin;
  PetscCheck(rho >= 0. && !PetscIsInfOrNanReal(rho), rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "-rigid_fluid_density %g kg/m^3: must be >= 0", (double)rho);
  rigid->rhofluid = rho;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidSetFromOptions(Rigid rigid)
{
  ShortRange p = rigid->shortrange;
  PetscReal g[3] = {rigid->g[0], rigid->g[1], rigid->g[2]}, rho = rigid->rhofluid, spacing = rigid->spacing;
  PetscInt n = 3, dim = rigid->dim, substeps = rigid->substeps;
  PetscBool set;

  PetscFunctionBegin;
  PetscOptionsBegin(rigid->comm, rigid->prefix, "Rigid bodies", "Rigid");
  PetscCall(PetscOptionsInt("-rigid_dimension", "2: unit depth and planar motion; 3", "RigidSetDimension", dim, &dim, NULL));
  PetscCall(RigidSetDimension(rigid, dim));
  PetscCall(PetscOptionsRealArray("-rigid_gravity", "Gravity gx,gy,gz, m/s^2", "RigidSetGravity", g, &n, &set));
  PetscCheck(!set || n == 3, rigid->comm, PETSC_ERR_ARG_SIZ, "-rigid_gravity: needs 3 numbers gx,gy,gz, got %" PetscInt_FMT, n);
  PetscCall(RigidSetGravity(rigid, g));
  PetscCall(PetscOptionsReal("-rigid_fluid_density",
                             "Density of displaced fluid that reduces the weight, kg/m^3 (0: full weight)",
                             "RigidSetFluidDensity", rho, &rho, NULL));
  PetscCall(RigidSetFluidDensity(rigid, rho));
  PetscCall(PetscOptionsInt("-rigid_substeps", "Steps of the rigid bodies in one step of the fluid", "RigidSetSubsteps", substeps,
                            &substeps, NULL));
  PetscCall(RigidSetSubsteps(rigid, substeps));
  PetscOptionsEnd();
  PetscCall(ShortRangeSetFromOptions(rigid->comm, rigid->prefix, &p, &spacing));
  PetscCall(RigidSetShortRange(rigid, &p));
  PetscCall(RigidSetShortRangeSpacing(rigid, spacing));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Free bodies need one step only; joints with stiff springs or fast mechanisms may need more. */
PetscErrorCode RigidSetSubsteps(Rigid rigid, PetscInt n)
{
  PetscFunctionBegin;
  PetscCheck(n >= 1, rigid->comm, PETSC_ERR_ARG_OUTOFRANGE, "-rigid_substeps %" PetscInt_FMT ": must be >= 1", n);
  rigid->substeps = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BodySetUp(Rigid rigid, PetscInt i)
{
  RigidBody *b = &rigid->body[i];
  RigidBodySpec *s = &b->spec;
  PetscReal J[3], v[3];
  const PetscReal norm = Vec3Norm(s->axisangle);

  PetscFunctionBegin;
  if (s->mass == (PetscReal)PETSC_DECIDE) s->mass = s->density * b->volume;
  RigidShapeMoments(s, rigid->dim, J);
  for (int k = 0; k < 3; k++) {
    if (s->inertia[k] == (PetscReal)PETSC_DECIDE) s->inertia[k] = J[k] * s->mass / b->volume;
    b->X[k] = s->position[k];
    b->V[k] = s->motion == RIGID_FIXED ? 0. : s->velocity[k];
    v[k] = s->axisangle[k] / norm * s->axisangle[3];
  }
  for (int k = 0; k < 3 && rigid->dim == 3; k++) {
    PetscCheck(s->inertia[k] <= (s->inertia[(k + 1) % 3] + s->inertia[(k + 2) % 3]) * (1. + 1.e-9), rigid->comm,
               PETSC_ERR_ARG_OUTOFRANGE,
               "Rigid body %" PetscInt_FMT
               ": inertia = (%g, %g, %g) kg m^2; no principal moment may exceed the sum of the other two",
               i, (double)s->inertia[0], (double)s->inertia[1], (double)s->inertia[2]);
  }
  QuatExp(v, b->q);
  if (s->geometry) {
    PetscReal q[4];
    QuatMult(b->q, s->geometry->q, q);
    PetscCall(PetscArraycpy(b->q, q, 4));
  }
  QuatNormalize(b->q);
  RigidBodySetOmega(b, s->omega);
  RigidTableApply(b, rigid->t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mass properties and initial state; after it the state functions may be called and bodies no longer added. */
PetscErrorCode RigidSetUp(Rigid rigid)
{
  PetscFunctionBegin;
  if (rigid->setup) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < rigid->n; i++) PetscCall(BodySetUp(rigid, i));
  rigid->setup = PETSC_TRUE;
  for (PetscInt j = 0; j < rigid->njoints; j++) PetscCall(RigidJointSetUp(rigid, j));
  PetscCall(RigidContactSetUp(rigid));
  if (rigid->njoints) {
    PetscCall(RigidSystemCreate(rigid));
    PetscCall(RigidSystemProjectVelocity(rigid));
  }
  PetscCall(PetscMemzero(&rigid->ledger, sizeof(rigid->ledger)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BodyView(Rigid rigid, PetscInt i, PetscViewer viewer)
{
  static const char *const motion[] = {"fixed", "prescribed", "free"};
  const RigidBody *b = &rigid->body[i];
  const RigidBodySpec *s = &b->spec;
  char lock[7];

  PetscFunctionBegin;
  for (int k = 0; k < 6; k++) lock[k] = s->lock[k] ? '1' : '0';
  lock[6] = 0;
  PetscCall(
      PetscViewerASCIIPrintf(viewer, "body %" PetscInt_FMT ": %s, %s, size", i, RigidShapeName(s->shape), motion[s->motion]));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_FALSE));
  for (PetscInt k = 0; k < RigidShapeNumSizes(s->shape, rigid->dim); k++)
    PetscCall(PetscViewerASCIIPrintf(viewer, " %g", (double)s->size[k]));
  PetscCall(PetscViewerASCIIPrintf(viewer, " m, density %g kg/m^3, locks %s\n", (double)s->density, lock));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_TRUE));
  PetscCall(PetscViewerASCIIPushTab(viewer));
  if (b->owng)
    PetscCall(PetscViewerASCIIPrintf(viewer, "own gravity %g %g %g m/s^2\n", (double)b->g[0], (double)b->g[1], (double)b->g[2]));
  if (Vec3Norm(b->load) + Vec3Norm(b->moment) > 0.)
    PetscCall(PetscViewerASCIIPrintf(viewer, "load %g %g %g N, torque %g %g %g N m\n", (double)b->load[0], (double)b->load[1],
                                     (double)b->load[2], (double)b->moment[0], (double)b->moment[1], (double)b->moment[2]));
  if (rigid->setup) {
    PetscReal w[3];
    RigidBodyOmega(b, b->q, w);
    PetscCall(PetscViewerASCIIPrintf(viewer, "mass %g kg, principal moments %g %g %g kg m^2\n", (double)s->mass,
                                     (double)s->inertia[0], (double)s->inertia[1], (double)s->inertia[2]));
    PetscCall(PetscViewerASCIIPrintf(viewer, "position %g %g %g m, quaternion %g %g %g %g\n", (double)b->X[0], (double)b->X[1],
                                     (double)b->X[2], (double)b->q[0], (double)b->q[1], (double)b->q[2], (double)b->q[3]));
    PetscCall(PetscViewerASCIIPrintf(viewer, "velocity %g %g %g m/s, angular velocity %g %g %g rad/s\n", (double)b->V[0],
                                     (double)b->V[1], (double)b->V[2], (double)w[0], (double)w[1], (double)w[2]));
  }
  PetscCall(PetscViewerASCIIPopTab(viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidView(Rigid rigid, PetscViewer viewer)
{
  PetscBool ascii;

  PetscFunctionBegin;
  if (!viewer) viewer = PETSC_VIEWER_STDOUT_(rigid->comm);
  PetscCall(PetscObjectTypeCompare((PetscObject)viewer, PETSCVIEWERASCII, &ascii));
  if (!ascii) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscViewerASCIIPrintf(viewer, "Rigid bodies: %" PetscInt_FMT ", dimension %" PetscInt_FMT ", t = %g s\n", rigid->n,
                                   rigid->dim, (double)rigid->t));
  PetscCall(PetscViewerASCIIPushTab(viewer));
  PetscCall(PetscViewerASCIIPrintf(viewer, "gravity %g %g %g m/s^2, fluid density %g kg/m^3%s\n", (double)rigid->g[0],
                                   (double)rigid->g[1], (double)rigid->g[2], (double)rigid->rhofluid,
                                   rigid->rhofluid > 0. ? "" : " (full weight)"));
  if (rigid->contact) {
    const ShortRange *p = &rigid->shortrange;
    PetscCall(PetscViewerASCIIPrintf(viewer, "lubrication: viscosity %g Pa s, cutoff %g m%s; roughness %g m\n",
                                     (double)p->viscosity, (double)p->cutoff, p->kink ? " (with kink)" : "",
                                     (double)p->roughness));
    PetscCall(PetscViewerASCIIPrintf(viewer, "contact: modulus %g Pa, restitution %g; surface markers %g m apart\n",
                                     (double)p->modulus, (double)p->restitution, (double)rigid->spacing));
  }
  PetscCall(PetscViewerASCIIPrintf(viewer, "substeps %" PetscInt_FMT "\n", rigid->substeps));
  for (PetscInt i = 0; i < rigid->n; i++) PetscCall(BodyView(rigid, i, viewer));
  for (PetscInt j = 0; j < rigid->njoints; j++) {
    const RigidJointSpec *s = &rigid->joint[j].spec;
    PetscCall(PetscViewerASCIIPrintf(
        viewer, "joint %" PetscInt_FMT ": %s, bodies %" PetscInt_FMT " and %" PetscInt_FMT ", stiffness %g, damping %g%s\n", j,
        RigidJointName(s->type), s->a, s->b, (double)s->stiffness, (double)s->damping, rigid->joint[j].broken ? ", broken" : ""));
  }
  PetscCall(PetscViewerASCIIPopTab(viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidDestroy(Rigid *rigid)
{
  PetscFunctionBegin;
  if (!*rigid) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < (*rigid)->n; i++) {
    PetscCall(RigidGeometryDestroy(&(*rigid)->body[i].spec.geometry));
    PetscCall(PetscFree((*rigid)->body[i].tabletime));
    PetscCall(PetscFree((*rigid)->body[i].table));
  }
  PetscCall(RigidSystemDestroy(*rigid));
  PetscCall(RigidContactDestroy(&(*rigid)->contact));
  PetscCall(PetscFree((*rigid)->prefix));
  PetscCall(PetscFree((*rigid)->joint));
  PetscCall(PetscFree((*rigid)->body));
  PetscCall(PetscFree(*rigid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RigidCheckBody(Rigid rigid, PetscInt body, PetscBool setup)
{
  PetscFunctionBegin;
  PetscCheck(body >= 0 && body < rigid->n, rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Rigid body %" PetscInt_FMT ": there are %" PetscInt_FMT " bodies", body, rigid->n);
  PetscCheck(rigid->setup || !setup, rigid->comm, PETSC_ERR_ORDER, "Call RigidSetUp() first");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidGetNumBodies(Rigid rigid, PetscInt *n)
{
  PetscFunctionBegin;
  *n = rigid->n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The fields as given to RigidAddBody(); mass and inertia as used once RigidSetUp() was called. */
PetscErrorCode RigidGetBody(Rigid rigid, PetscInt body, RigidBodySpec *spec)
{
  PetscFunctionBegin;
  PetscCall(RigidCheckBody(rigid, body, PETSC_FALSE));
  *spec = rigid->body[body].spec;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidGetState(Rigid rigid, PetscInt body, PetscReal X[3], PetscReal q[4], PetscReal V[3], PetscReal omega[3])
{
  const RigidBody *b;

  PetscFunctionBegin;
  PetscCall(RigidCheckBody(rigid, body, PETSC_TRUE));
  b = &rigid->body[body];
  if (X) PetscCall(PetscArraycpy(X, b->X, 3));
  if (q) PetscCall(PetscArraycpy(q, b->q, 4));
  if (V) PetscCall(PetscArraycpy(V, b->V, 3));
  if (omega) RigidBodyOmega(b, b->q, omega);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* NULL leaves a part as it is (for omega: keeps the angular velocity). Locked directions of V and omega are set to 0. */
PetscErrorCode RigidSetState(Rigid rigid, PetscInt body, const PetscReal X[3], const PetscReal q[4], const PetscReal V[3],
                             const PetscReal omega[3])
{
  RigidBody *b;
  PetscReal w[3];

  PetscFunctionBegin;
  PetscCall(RigidCheckBody(rigid, body, PETSC_TRUE));
  b = &rigid->body[body];
  RigidBodyOmega(b, b->q, w);
  if (q) {
    const PetscReal norm = PetscSqrtReal(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    PetscCheck(norm > 0. && !PetscIsInfOrNanReal(norm), rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "Rigid body %" PetscInt_FMT ": quaternion of length %g; must be > 0", body, (double)norm);
    for (int k = 0; k < 4; k++) b->q[k] = q[k];
    QuatNormalize(b->q);
  }
  for (int k = 0; k < 3; k++) {
    const PetscBool fixed = b->spec.motion == RIGID_FIXED ? PETSC_TRUE : PETSC_FALSE,
                    lk = b->spec.motion == RIGID_FREE ? b->spec.lock[k] : PETSC_FALSE;
    const PetscBool lr = b->spec.motion == RIGID_FREE ? b->spec.lock[3 + k] : PETSC_FALSE;
    if (X) b->X[k] = X[k];
    if (V) b->V[k] = (fixed || lk) ? 0. : V[k];
    if (omega) w[k] = omega[k];
    if (fixed || lr) w[k] = 0.;
    PetscCheck(!PetscIsInfOrNanReal(b->X[k]) && !PetscIsInfOrNanReal(b->V[k]) && !PetscIsInfOrNanReal(w[k]), rigid->comm,
               PETSC_ERR_FP, "Rigid body %" PetscInt_FMT ": component %d of the state is not finite", body, k);
  }
  RigidBodySetOmega(b, w);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidSetTime(Rigid rigid, PetscReal t)
{
  PetscFunctionBegin;
  rigid->t = t;
  for (PetscInt i = 0; i < rigid->n && rigid->setup; i++) RigidTableApply(&rigid->body[i], t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidGetTime(Rigid rigid, PetscReal *t)
{
  PetscFunctionBegin;
  *t = rigid->t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One body's part of state[], in this order. */
static void BodyPointers(RigidBody *b, PetscReal *p[], int n[])
{
  p[0] = b->X, p[1] = b->q, p[2] = b->V, p[3] = b->L, p[4] = b->w, p[5] = b->Fused, p[6] = b->Tused, p[7] = b->F, p[8] = b->T;
  for (int k = 0; k < 9; k++) n[k] = k == 1 ? 4 : 3;
}

/* One joint's part, after the bodies. */
static void JointPointers(RigidJoint *j, PetscReal *p[4])
{
  for (int k = 0; k < 3; k++) p[k] = &j->rest[k];
  p[3] = &j->angle;
}

PetscErrorCode RigidGetPackSize(Rigid rigid, PetscInt *n)
{
  PetscFunctionBegin;
  *n = rigid->n * RIGID_PACK_SIZE + rigid->njoints * RIGID_JOINT_PACK_SIZE + RIGID_LEDGER_SIZE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* state: RigidGetPackSize() reals; the time is not in it, see RigidGetTime(). */
PetscErrorCode RigidPack(Rigid rigid, PetscReal state[])
{
  PetscReal *p[9];
  int n[9];

  PetscFunctionBegin;
  PetscCheck(rigid->setup, rigid->comm, PETSC_ERR_ORDER, "Call RigidSetUp() first");
  for (PetscInt i = 0; i < rigid->n; i++) {
    BodyPointers(&rigid->body[i], p, n);
    for (int k = 0; k < 9; k++)
      for (int c = 0; c < n[k]; c++) *state++ = p[k][c];
  }
  for (PetscInt i = 0; i < rigid->njoints; i++) {
    JointPointers(&rigid->joint[i], p);
    for (int k = 0; k < 4; k++) *state++ = *p[k];
    *state++ = rigid->joint[i].broken ? 1. : 0.;
  }
  PetscCall(PetscArraycpy(state, (const PetscReal *)&rigid->ledger, RIGID_LEDGER_SIZE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidUnpack(Rigid rigid, const PetscReal state[])
{
  PetscReal *p[9];
  int n[9];

  PetscFunctionBegin;
  PetscCheck(rigid->setup, rigid->comm, PETSC_ERR_ORDER, "Call RigidSetUp() first");
  for (PetscInt i = 0; i < rigid->n; i++) {
    BodyPointers(&rigid->body[i], p, n);
    for (int k = 0; k < 9; k++)
      for (int c = 0; c < n[k]; c++) p[k][c] = *state++;
  }
  for (PetscInt i = 0; i < rigid->njoints; i++) {
    JointPointers(&rigid->joint[i], p);
    for (int k = 0; k < 4; k++) *p[k] = *state++;
    rigid->joint[i].broken = *state++ != 0. ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscCall(PetscArraycpy((PetscReal *)&rigid->ledger, state, RIGID_LEDGER_SIZE));
  rigid->advanced = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidMoveState(Rigid rigid, FrondState *s)
{
  PetscReal *x = NULL, t = rigid->t;
  const FrondStateWay way = s->way;
  PetscInt n;

  PetscFunctionBegin;
  PetscCall(RigidGetPackSize(rigid, &n));
  if (way != FROND_STATE_COUNT) PetscCall(PetscMalloc1(n, &x));
  if (way == FROND_STATE_SAVE) PetscCall(RigidPack(rigid, x));
  FrondMoveReal(s, "bodies/time", &t, 1);
  FrondMoveReal(s, "bodies/state", x, n);
  if (way == FROND_STATE_LOAD) {
    PetscCall(RigidSetTime(rigid, t));
    PetscCall(RigidUnpack(rigid, x));
  }
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* From the wrench of the last RigidAdvance(); before the first one, from the loads collected so far. Gravity included. */
PetscErrorCode RigidGetAcceleration(Rigid rigid, PetscInt body, PetscReal A[3], PetscReal alpha[3])
{
  PetscReal a[3], al[3];

  PetscFunctionBegin;
  PetscCall(RigidCheckBody(rigid, body, PETSC_TRUE));
  RigidBodyAcceleration(rigid, &rigid->body[body], a, al);
  if (A) PetscCall(PetscArraycpy(A, a, 3));
  if (alpha) PetscCall(PetscArraycpy(alpha, al, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void RigidRotationMatrix(const PetscReal q[4], PetscReal R[9])
{
  QuatMatrix(q, R);
}

PetscErrorCode RigidZeroLoads(Rigid rigid)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < rigid->n; i++) {
    PetscCall(PetscArrayzero(rigid->body[i].F, 3));
    PetscCall(PetscArrayzero(rigid->body[i].T, 3));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* F in N, T about the centre of mass in N m; NULL for none. Fixed and prescribed bodies take loads and ignore them. */
PetscErrorCode RigidAddLoad(Rigid rigid, PetscInt body, const PetscReal F[3], const PetscReal T[3])
{
  PetscFunctionBegin;
  PetscCall(RigidCheckBody(rigid, body, PETSC_FALSE));
  for (int k = 0; k < 3; k++) {
    if (F) rigid->body[body].F[k] += F[k];
    if (T) rigid->body[body].T[k] += T[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Short-range wrenches of a half step, and their mean so far. */
static PetscErrorCode ShortRangeKick(Rigid rigid, PetscReal h)
{
  const PetscReal part = .5 / (PetscReal)rigid->substeps;

  PetscFunctionBegin;
  PetscCall(RigidContactForces(rigid, .5 * h));
  for (PetscInt i = 0; i < rigid->n; i++)
    for (int k = 0; k < 3; k++) {
      rigid->body[i].Fm[k] += part * rigid->body[i].Fs[k];
      rigid->body[i].Tm[k] += part * rigid->body[i].Ts[k];
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Kick, free flight, kick of all bodies; the short-range forces of each kick are those at its end of the flight. */
static PetscErrorCode RigidSubstep(Rigid rigid, PetscReal h)
{
  PetscBool jointed;

  PetscFunctionBegin;
  RigidAuditLoads(rigid, .5 * h);
  if (rigid->contact) PetscCall(ShortRangeKick(rigid, h));
  for (PetscInt i = 0; i < rigid->n; i++) {
    PetscCall(RigidSystemHasBody(rigid, i, &jointed));
    if (!jointed) PetscCall(RigidBodyBegin(rigid, i, h));
  }
  if (rigid->system) PetscCall(RigidSystemBegin(rigid, h));
  if (rigid->contact) PetscCall(ShortRangeKick(rigid, h));
  for (PetscInt i = 0; i < rigid->n; i++) {
    PetscCall(RigidSystemHasBody(rigid, i, &jointed));
    if (!jointed) RigidBodyEnd(rigid, i, h);
  }
  if (rigid->system) PetscCall(RigidSystemEnd(rigid, h));
  RigidAuditLoads(rigid, .5 * h);
  rigid->t += h;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* From the present time to t (s) in -rigid_substeps steps, see rigidstep.c and rigidconstraint.c; t must not lie in the past. */
PetscErrorCode RigidAdvance(Rigid rigid, PetscReal t)
{
  const PetscReal dt = t - rigid->t;

  PetscFunctionBegin;
  PetscCheck(rigid->setup, rigid->comm, PETSC_ERR_ORDER, "Call RigidSetUp() first");
  PetscCheck(dt >= 0. && !PetscIsInfOrNanReal(t), rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "RigidAdvance() to t = %g s: must be >= the present time %g s", (double)t, (double)rigid->t);
  PetscCall(PetscLogEventBegin(RIGID_Advance, 0, 0, 0, 0));
  for (PetscInt i = 0; i < rigid->n; i++)
    for (int k = 0; k < 3; k++) rigid->body[i].Fm[k] = rigid->body[i].Tm[k] = 0.;
  for (PetscInt s = 0; s < rigid->substeps && dt > 0.; s++) PetscCall(RigidSubstep(rigid, dt / (PetscReal)rigid->substeps));
  for (PetscInt i = 0; i < rigid->n && rigid->contact && dt > 0.; i++)
    for (int k = 0; k < 3; k++) { /* the last half step's gives way to the mean, so that m A dt is the step's impulse */
      rigid->body[i].Fused[k] += rigid->body[i].Fm[k] - rigid->body[i].Fs[k];
      rigid->body[i].Tused[k] += rigid->body[i].Tm[k] - rigid->body[i].Ts[k];
    }
  rigid->t = t;
  rigid->advanced = PETSC_TRUE;
  PetscCall(PetscLogEventEnd(RIGID_Advance, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* J. Kinetic energy of free and prescribed bodies; potential -g.(m X - rho V X_v) of the free ones, X_v the centroid of the
 * volume. Each may be NULL. */
PetscErrorCode RigidGetEnergy(Rigid rigid, PetscReal *kinetic, PetscReal *potential)
{
  PetscReal ke = 0., pe = 0.;

  PetscFunctionBegin;
  PetscCheck(rigid->setup, rigid->comm, PETSC_ERR_ORDER, "Call RigidSetUp() first");
  for (PetscInt i = 0; i < rigid->n; i++) {
    const RigidBody *b = &rigid->body[i];
    PetscReal w[3], wb[3];
    RigidBodyOmega(b, b->q, w);
    QuatRotateBack(b->q, w, wb);
    ke += .5 * b->spec.mass * Vec3Dot(b->V, b->V);
    for (int k = 0; k < 3; k++) ke += .5 * b->spec.inertia[k] * wb[k] * wb[k];
    if (b->spec.motion == RIGID_FREE) pe += RigidBodyPotential(rigid, b);
  }
  if (kinetic) *kinetic = ke;
  if (potential) *potential = pe;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sum over the free and prescribed bodies of m V (kg m/s) and, about the origin, m X x V + J w (kg m^2/s). Each may be NULL. */
PetscErrorCode RigidGetMomentum(Rigid rigid, PetscReal p[3], PetscReal L[3])
{
  PetscReal ps[3] = {0., 0., 0.}, Ls[3] = {0., 0., 0.};

  PetscFunctionBegin;
  PetscCheck(rigid->setup, rigid->comm, PETSC_ERR_ORDER, "Call RigidSetUp() first");
  for (PetscInt i = 0; i < rigid->n; i++) {
    const RigidBody *b = &rigid->body[i];
    PetscReal w[3], Jw[3], XV[3], A[9];
    RigidBodyOmega(b, b->q, w);
    InertiaSpace(b->q, b->spec.inertia, A);
    Mat3Mult(A, w, Jw);
    Vec3Cross(b->X, b->V, XV);
    for (int k = 0; k < 3; k++) {
      ps[k] += b->spec.mass * b->V[k];
      Ls[k] += b->spec.mass * XV[k] + Jw[k];
    }
  }
  if (p) PetscCall(PetscArraycpy(p, ps, 3));
  if (L) PetscCall(PetscArraycpy(L, Ls, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}
