/*
  lumped.c - lumped-elasticity beams (Capasso, Tagliafierro, Martinez-Estevez, Dominguez, El Rahi, Stratigaki, Crespo, Montuori,
  Troch, Gomez-Gesteira, Viccione: On the development of a novel approach for simulating elastic beams in DualSPHysics with the
  use of the Project Chrono library, COMPDYN 2021).

  N trunks of length dx = L/N (Eq. 13); the hinge between two trunks turns by M/K (Eq. 17) with K = EI/dx. The hinge of a clamped
  end stands for half a trunk only and gets 2 K, which makes the model second order: the tip of a cantilever under its own weight
  comes out 1 + 1/N^2 times too far. A damper at the free end (Eq. 23) helps to find equilibria. In 3D the hinges are bend joints:
  K about both normals of the axis, G J/dx about the axis.
*/
#include "rigidimpl.h"

/* No section, trunks or stiffness yet; free at both ends; no dampers. */
PetscErrorCode RigidLumpedSpecInit(RigidLumpedSpec *spec)
{
  PetscFunctionBegin;
  PetscCall(PetscMemzero(spec, sizeof(*spec)));
  spec->density = 1000.;
  spec->poisson = .3;
  spec->EI = spec->rhoA = PETSC_DECIDE;
  spec->damperaxis[2] = 1.;
  spec->yield = spec->rupture = PETSC_INFINITY;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckPositive(MPI_Comm comm, const char field[], PetscReal x)
{
  PetscFunctionBegin;
  PetscCheck(x > 0. && !PetscIsInfOrNanReal(x), comm, PETSC_ERR_ARG_OUTOFRANGE, "Lumped beam: %s = %g; must be > 0", field,
             (double)x);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Area and second moment of the section; per metre of depth in 2D. */
static void Section(const RigidLumpedSpec *s, PetscInt dim, PetscReal *A, PetscReal *I2)
{
  const PetscReal d = s->section[0], h = s->section[1];
  if (dim == 2) {
    const PetscReal t = h > 0. ? h : d;
    *A = t;
    *I2 = t * t * t / 12.;
  } else if (h > 0.) {
    *A = d * h;
    *I2 = d * h * h * h / 12.;
  } else {
    *A = PETSC_PI / 4. * d * d;
    *I2 = PETSC_PI / 64. * d * d * d * d;
  }
}

static PetscErrorCode LumpedCheck(Rigid rigid, const RigidLumpedSpec *s)
{
  PetscReal l2 = 0.;

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    const PetscReal d = s->end[k] - s->start[k];
    l2 += d * d;
    PetscCheck(!PetscIsInfOrNanReal(d) && !PetscIsInfOrNanReal(s->velocity[k]), rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "Lumped beam: component %d of start, end or velocity is not finite", k);
  }
  PetscCheck(s->trunks >= 1, rigid->comm, PETSC_ERR_ARG_OUTOFRANGE, "Lumped beam: trunks = %" PetscInt_FMT "; must be >= 1",
             s->trunks);
  PetscCall(CheckPositive(rigid->comm, "length", PetscSqrtReal(l2)));
  PetscCall(CheckPositive(rigid->comm, "section[0]", s->section[0]));
  PetscCheck(s->section[1] >= 0., rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Lumped beam: section[1] = %g m; must be > 0, or 0 for a circle", (double)s->section[1]);
  PetscCheck(rigid->dim == 2 || s->section[1] == 0. || s->section[0] == s->section[1], rigid->comm, PETSC_ERR_ARG_INCOMP,
             "Lumped beam: section = %g x %g m; a rectangle in 3D must be a square, as a hinge has one bending stiffness",
             (double)s->section[0], (double)s->section[1]);
  PetscCall(CheckPositive(rigid->comm, "density", s->density));
  if (s->EI == (PetscReal)PETSC_DECIDE)
    PetscCall(CheckPositive(rigid->comm, "young", s->young));
  else
    PetscCall(CheckPositive(rigid->comm, "EI", s->EI));
  if (s->rhoA != (PetscReal)PETSC_DECIDE) PetscCall(CheckPositive(rigid->comm, "rhoA", s->rhoA));
  PetscCheck(s->poisson > -1. && s->poisson <= .5, rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Lumped beam: poisson = %g; must be > -1 and <= 0.5", (double)s->poisson);
  PetscCheck(s->damping >= 0., rigid->comm, PETSC_ERR_ARG_OUTOFRANGE, "Lumped beam: damping = %g N s/m; must be >= 0",
             (double)s->damping);
  PetscCheck(rigid->dim == 3 || s->start[2] == s->end[2], rigid->comm, PETSC_ERR_ARG_INCOMP,
             "Lumped beam: start and end must have the same z in 2D");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The trunk: its axis is body z in 3D (cylinder, square box) and body x in 2D (rectangle). */
static PetscErrorCode TrunkSpec(Rigid rigid, const RigidLumpedSpec *s, PetscReal dx, const PetscReal u[3], RigidBodySpec *b)
{
  PetscReal A, I2;

  PetscFunctionBegin;
  PetscCall(RigidBodySpecInit(b));
  Section(s, rigid->dim, &A, &I2);
  b->density = s->density;
  if (s->rhoA != (PetscReal)PETSC_DECIDE) b->mass = s->rhoA * dx;
  for (int k = 0; k < 3; k++) b->velocity[k] = s->velocity[k];
  if (rigid->dim == 2) {
    b->shape = RIGID_BOX;
    b->size[0] = dx;
    b->size[1] = A;
    b->axisangle[3] = PetscAtan2Real(u[1], u[0]);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  b->shape = s->section[1] > 0. ? RIGID_BOX : RIGID_CYLINDER;
  b->size[0] = s->section[1] > 0. ? s->section[0] : .5 * s->section[0];
  b->size[1] = s->section[1] > 0. ? s->section[1] : dx;
  b->size[2] = dx;
  /* turn e_z into u: about e_z x u; a trunk along -z is turned about x */
  b->axisangle[0] = -u[1];
  b->axisangle[1] = u[0];
  b->axisangle[2] = 0.;
  b->axisangle[3] = PetscAtan2Real(PetscSqrtReal(u[0] * u[0] + u[1] * u[1]), u[2]);
  if (u[0] == 0. && u[1] == 0.) b->axisangle[0] = 1.;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddHinge(Rigid rigid, const RigidLumpedSpec *s, RigidJointType type, PetscInt a, PetscInt b,
                               const PetscReal x[3], const PetscReal u[3], PetscReal K)
{
  RigidJointSpec j;

  PetscFunctionBegin;
  PetscCall(RigidJointSpecInit(&j));
  j.type = type;
  j.a = a;
  j.b = b;
  for (int k = 0; k < 3; k++) {
    j.point[k] = x[k];
    j.axis[k] = u[k];
  }
  if (type == RIGID_JOINT_BEND) {
    j.stiffness = K;
    j.damping = s->hingedamping;
    j.torsion = K / (1. + s->poisson); /* G J/(E I) = 1/(1 + nu) for J = 2 I */
    j.torsiondamping = s->hingedamping;
    j.yield = s->yield;
    j.rupture = s->rupture;
  }
  PetscCall(RigidAddJoint(rigid, &j, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddDamper(Rigid rigid, const RigidLumpedSpec *s, PetscInt last)
{
  RigidJointSpec j;

  PetscFunctionBegin;
  PetscCall(RigidJointSpecInit(&j));
  j.type = RIGID_JOINT_LINEAR;
  j.a = last;
  j.damping = s->damping;
  for (int k = 0; k < 3; k++) {
    j.point[k] = s->end[k];
    j.axis[k] = s->damperaxis[k];
  }
  PetscCall(RigidAddJoint(rigid, &j, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidAddLumpedBeam(Rigid rigid, const RigidLumpedSpec *s, PetscInt *body, PetscInt *joint)
{
  const PetscInt N = s->trunks, first = rigid->n;
  PetscReal u[3], A, I2, K, L = 0., dx;
  RigidBodySpec b;

  PetscFunctionBegin;
  PetscCall(LumpedCheck(rigid, s));
  for (int k = 0; k < 3; k++) L += PetscSqr(s->end[k] - s->start[k]);
  L = PetscSqrtReal(L);
  dx = L / (PetscReal)N;
  for (int k = 0; k < 3; k++) u[k] = (s->end[k] - s->start[k]) / L;
  Section(s, rigid->dim, &A, &I2);
  K = (s->EI == (PetscReal)PETSC_DECIDE ? s->young * I2 : s->EI) / dx;
  if (body) *body = first;
  if (joint) *joint = rigid->njoints;
  PetscCall(TrunkSpec(rigid, s, dx, u, &b));
  for (PetscInt i = 0; i < N; i++) {
    for (int k = 0; k < 3; k++) b.position[k] = s->start[k] + ((PetscReal)i + .5) * dx * u[k];
    PetscCall(RigidAddBody(rigid, &b, NULL));
  }
  for (PetscInt i = 0; i <= N; i++) {
    const RigidEnd end = i == 0 ? s->end0 : (i == N ? s->end1 : RIGID_END_CLAMP);
    const PetscReal stiff = i == 0 || i == N ? 2. * K : K;
    const PetscInt a = i == N ? first + N - 1 : first + i, before = i == 0 || i == N ? RIGID_GROUND : first + i - 1;
    PetscReal x[3];
    for (int k = 0; k < 3; k++) x[k] = s->start[k] + (PetscReal)i * dx * u[k];
    if (end != RIGID_END_FREE)
      PetscCall(AddHinge(rigid, s, end == RIGID_END_PIN ? RIGID_JOINT_BALL : RIGID_JOINT_BEND, a, before, x, u, stiff));
  }
  if (s->damping > 0.) PetscCall(AddDamper(rigid, s, first + N - 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidGetLumpedNodes(Rigid rigid, PetscInt body, PetscInt trunks, PetscReal x[])
{
  PetscFunctionBegin;
  PetscCheck(rigid->setup, rigid->comm, PETSC_ERR_ORDER, "Call RigidSetUp() first");
  PetscCheck(body >= 0 && trunks >= 1 && body + trunks <= rigid->n, rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Lumped beam: bodies %" PetscInt_FMT " ... %" PetscInt_FMT "; there are %" PetscInt_FMT " bodies", body,
             body + trunks - 1, rigid->n);
  for (PetscInt i = 0; i <= trunks; i++) {
    const RigidBody *b = &rigid->body[body + PetscMin(i, trunks - 1)];
    const PetscInt along = rigid->dim == 2 ? 0 : 2;
    const PetscReal half = .5 * b->spec.size[b->spec.shape == RIGID_CYLINDER ? 1 : along];
    PetscReal e[3] = {0., 0., 0.}, r[3];
    e[along] = i < trunks ? -half : half;
    QuatRotate(b->q, e, r);
    for (int k = 0; k < 3; k++) x[3 * i + k] = b->X[k] + r[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
