/*
  rigidjoint.c - joints: their checks, their placement in the bodies, and the rows (value and Jacobian) of each type.

  With r = R(q) r' a point of body a, d/dt r = w x r gives for a direction e fixed in space  d/dt (e.r) = w.(r x e).
  A rotation vector phi of R_rel = R_b^T R_a (R_b^T R_a)_0^T obeys dphi/dt = J_l^-1(phi) R_b^T (w_a - w_b) with
  J_l^-1 = 1 - phi~/2 + (1/|phi|^2 - (1 + cos|phi|)/(2 |phi| sin|phi|)) phi~^2 (see e.g. Chirikjian, Stochastic Models,
  Information Theory, and Lie Groups, vol. 2, Sect. 10.6).
*/
#include "rigidimpl.h"

const char *RigidJointName(RigidJointType type)
{
  static const char *const names[] = {"ball", "hinge", "slider", "spring", "linear", "bend"};
  return names[type];
}

/* A ball joint of nothing yet: bodies, point and axis must be set. */
PetscErrorCode RigidJointSpecInit(RigidJointSpec *spec)
{
  PetscFunctionBegin;
  PetscCall(PetscMemzero(spec, sizeof(*spec)));
  spec->a = spec->b = RIGID_GROUND;
  spec->yield = spec->rupture = PETSC_INFINITY;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckNotNegative(MPI_Comm comm, PetscInt j, const char field[], PetscReal x)
{
  PetscFunctionBegin;
  PetscCheck(x >= 0. && !PetscIsInfOrNanReal(x), comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Rigid joint %" PetscInt_FMT ": %s = %g; must be >= 0", j, field, (double)x);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckEnds(Rigid rigid, PetscInt j, const RigidJointSpec *s)
{
  const PetscInt end[2] = {s->a, s->b};

  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) {
    PetscCheck(end[k] >= RIGID_GROUND && end[k] < rigid->n, rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "Rigid joint %" PetscInt_FMT ": %s = %" PetscInt_FMT "; must be one of the %" PetscInt_FMT
               " bodies or RIGID_GROUND (-1)",
               j, k ? "b" : "a", end[k], rigid->n);
  }
  PetscCheck(s->a != s->b, rigid->comm, PETSC_ERR_ARG_INCOMP,
             "Rigid joint %" PetscInt_FMT ": joins body %" PetscInt_FMT " to itself; a and b must differ", j, s->a);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks every field; errors name the joint, the field, its value and the rule. joint may be NULL. */
PetscErrorCode RigidAddJoint(Rigid rigid, const RigidJointSpec *s, PetscInt *joint)
{
  const PetscInt j = rigid->njoints;
  const PetscBool axis = s->type == RIGID_JOINT_BALL || s->type == RIGID_JOINT_SPRING ? PETSC_FALSE : PETSC_TRUE;

  PetscFunctionBegin;
  PetscCheck(!rigid->setup, rigid->comm, PETSC_ERR_ORDER, "RigidAddJoint() must come before RigidSetUp()");
  PetscCheck((int)s->type >= 0 && s->type <= RIGID_JOINT_BEND, rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Rigid joint %" PetscInt_FMT ": type = %d; must be one of ball, hinge, slider, spring, linear, bend", j,
             (int)s->type);
  PetscCall(CheckEnds(rigid, j, s));
  for (int k = 0; k < 3; k++)
    PetscCheck(!PetscIsInfOrNanReal(s->point[k]) && !PetscIsInfOrNanReal(s->pointb[k]) && !PetscIsInfOrNanReal(s->axis[k]),
               rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "Rigid joint %" PetscInt_FMT ": component %d of point, pointb or axis is not a finite number", j, k);
  PetscCheck(!axis || Vec3Norm(s->axis) > 0., rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Rigid joint %" PetscInt_FMT ": axis = (0, 0, 0) of a %s joint; must have a length > 0", j, RigidJointName(s->type));
  PetscCheck(rigid->dim == 3 || s->type != RIGID_JOINT_HINGE || (s->axis[0] == 0. && s->axis[1] == 0.), rigid->comm,
             PETSC_ERR_ARG_INCOMP, "Rigid joint %" PetscInt_FMT ": axis = (%g, %g, %g) of a hinge; must be along z in 2D", j,
             (double)s->axis[0], (double)s->axis[1], (double)s->axis[2]);
  PetscCall(CheckNotNegative(rigid->comm, j, "stiffness", s->stiffness));
  PetscCall(CheckNotNegative(rigid->comm, j, "damping", s->damping));
  PetscCall(CheckNotNegative(rigid->comm, j, "torsion", s->torsion));
  PetscCall(CheckNotNegative(rigid->comm, j, "torsiondamping", s->torsiondamping));
  PetscCheck(!PetscIsInfOrNanReal(s->rest), rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Rigid joint %" PetscInt_FMT ": rest = %g is not a finite number", j, (double)s->rest);
  PetscCheck(s->yield > 0., rigid->comm, PETSC_ERR_ARG_OUTOFRANGE, "Rigid joint %" PetscInt_FMT ": yield = %g N m; must be > 0",
             j, (double)s->yield);
  PetscCheck(s->rupture > 0., rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Rigid joint %" PetscInt_FMT ": rupture = %g rad; must be > 0", j, (double)s->rupture);
  PetscCheck(s->type != RIGID_JOINT_SPRING || s->rest >= 0. || s->rest == (PetscReal)PETSC_DECIDE, rigid->comm,
             PETSC_ERR_ARG_OUTOFRANGE, "Rigid joint %" PetscInt_FMT ": rest = %g m of a spring; must be >= 0", j,
             (double)s->rest);
  if (rigid->njoints == rigid->njointalloc) {
    RigidJoint *more;
    rigid->njointalloc = 2 * rigid->njointalloc + 8;
    PetscCall(PetscCalloc1(rigid->njointalloc, &more));
    if (rigid->njoints) PetscCall(PetscArraycpy(more, rigid->joint, rigid->njoints));
    PetscCall(PetscFree(rigid->joint));
    rigid->joint = more;
  }
  rigid->joint[j].spec = *s;
  rigid->njoints++;
  if (joint) *joint = j;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidGetNumJoints(Rigid rigid, PetscInt *n)
{
  PetscFunctionBegin;
  *n = rigid->njoints;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Placement of one end; the ground stands still in the origin. */
typedef struct {
  PetscReal X[3], q[4], R[9];
} Frame;

static void EndFrame(Rigid rigid, PetscInt i, Frame *f)
{
  static const PetscReal origin[3] = {0., 0., 0.}, rest[4] = {1., 0., 0., 0.};
  const PetscReal *X = i == RIGID_GROUND ? origin : rigid->body[i].X, *q = i == RIGID_GROUND ? rest : rigid->body[i].q;
  for (int k = 0; k < 3; k++) f->X[k] = X[k];
  for (int k = 0; k < 4; k++) f->q[k] = q[k];
  QuatMatrix(q, f->R);
}

/* Two unit vectors that make a right-handed triad (t0, t1, u) with the unit vector u. */
static void Normals(const PetscReal u[3], PetscReal t0[3], PetscReal t1[3])
{
  PetscReal e[3] = {0., 0., 0.}, n;
  int least = 0;
  for (int k = 1; k < 3; k++)
    if (PetscAbsReal(u[k]) < PetscAbsReal(u[least])) least = k;
  e[least] = 1.;
  Vec3Cross(u, e, t0);
  n = Vec3Norm(t0);
  for (int k = 0; k < 3; k++) t0[k] /= n;
  Vec3Cross(u, t0, t1);
}

static void RelativeRotation(const Frame *a, const Frame *b, PetscReal q[4])
{
  const PetscReal back[4] = {b->q[0], -b->q[1], -b->q[2], -b->q[3]};
  QuatMult(back, a->q, q);
}

static void AddRow(RigidJoint *j, PetscBool hard, PetscReal k, PetscReal c)
{
  j->hard[j->nrows] = hard;
  j->k[j->nrows] = k;
  j->c[j->nrows++] = c;
}

/* How many rows, and what kind; in the order of RigidJointRows(). */
static void JointRowKinds(RigidJoint *j)
{
  static const int hard[] = {3, 5, 5, 0, 0, 3};
  const RigidJointSpec *s = &j->spec;
  j->nrows = 0;
  for (int k = 0; k < hard[s->type]; k++) AddRow(j, PETSC_TRUE, 0., 0.);
  if (s->type == RIGID_JOINT_BEND) {
    for (int k = 0; k < 2; k++) AddRow(j, PETSC_FALSE, s->stiffness, s->damping);
    AddRow(j, PETSC_FALSE, s->torsion, s->torsiondamping);
  } else if (s->type != RIGID_JOINT_BALL) {
    AddRow(j, PETSC_FALSE, s->stiffness, s->damping);
  }
}

PetscErrorCode RigidJointSetUp(Rigid rigid, PetscInt i)
{
  RigidJoint *j = &rigid->joint[i];
  const RigidJointSpec *s = &j->spec;
  const PetscReal n = Vec3Norm(s->axis), *pb = s->type == RIGID_JOINT_SPRING ? s->pointb : s->point;
  PetscReal da[3], db[3], u[3], t[2][3];
  Frame a, b;

  PetscFunctionBegin;
  EndFrame(rigid, s->a, &a);
  EndFrame(rigid, s->b, &b);
  for (int k = 0; k < 3; k++) {
    da[k] = s->point[k] - a.X[k];
    db[k] = pb[k] - b.X[k];
    u[k] = n > 0. ? s->axis[k] / n : (k == 2 ? 1. : 0.);
  }
  Normals(u, t[0], t[1]);
  Mat3MultTranspose(a.R, da, j->ra);
  Mat3MultTranspose(b.R, db, j->rb);
  Mat3MultTranspose(a.R, u, j->ua);
  Mat3MultTranspose(b.R, u, j->ub);
  for (int m = 0; m < 2; m++) {
    Mat3MultTranspose(a.R, t[m], j->ta[m]);
    Mat3MultTranspose(b.R, t[m], j->tb[m]);
  }
  RelativeRotation(&a, &b, j->qrel);
  JointRowKinds(j);
  for (int k = 0; k < 3; k++) j->rest[k] = 0.;
  if (s->type != RIGID_JOINT_BEND && s->type != RIGID_JOINT_BALL) j->rest[0] = s->rest;
  if (s->type == RIGID_JOINT_SPRING) {
    const PetscReal d[3] = {s->point[0] - pb[0], s->point[1] - pb[1], s->point[2] - pb[2]};
    PetscCheck(Vec3Norm(d) > 0., rigid->comm, PETSC_ERR_ARG_INCOMP,
               "Rigid joint %" PetscInt_FMT ": a spring of length 0 has no direction; point and pointb must differ", i);
    if (s->rest == (PetscReal)PETSC_DECIDE) j->rest[0] = Vec3Norm(d);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Row for e.(Pa - Pb): e fixed to b when follow is set, to space otherwise. */
static void PointRow(const PetscReal e[3], const PetscReal ra[3], const PetscReal rb[3], const PetscReal d[3], PetscBool follow,
                     RigidRow *row)
{
  PetscReal x[3];
  row->g = Vec3Dot(e, d);
  for (int k = 0; k < 3; k++) {
    row->Ja[k] = e[k];
    row->Jb[k] = -e[k];
  }
  Vec3Cross(ra, e, row->Ja + 3);
  Vec3Cross(rb, e, x);
  for (int k = 0; k < 3; k++) row->Jb[3 + k] = -x[k];
  if (!follow) return;
  Vec3Cross(e, d, x);
  for (int k = 0; k < 3; k++) row->Jb[3 + k] += x[k];
}

/* Row for x.y, unit vectors x fixed to a and y fixed to b. */
static void AngleRow(const PetscReal x[3], const PetscReal y[3], RigidRow *row)
{
  row->g = Vec3Dot(x, y);
  for (int k = 0; k < 3; k++) row->Ja[k] = row->Jb[k] = 0.;
  Vec3Cross(x, y, row->Ja + 3);
  for (int k = 3; k < 6; k++) row->Jb[k] = -row->Ja[k];
}

static void TurnRow(const PetscReal axis[3], PetscReal g, RigidRow *row)
{
  row->g = g;
  for (int k = 0; k < 3; k++) {
    row->Ja[k] = row->Jb[k] = 0.;
    row->Ja[3 + k] = axis[k];
    row->Jb[3 + k] = -axis[k];
  }
}

/* Angle of a about the hinge axis relative to b, within half a turn of the last one. */
static PetscReal HingeAngle(const RigidJoint *j, const PetscReal t0a[3], const PetscReal t0b[3], const PetscReal t1b[3])
{
  const PetscReal a = PetscAtan2Real(Vec3Dot(t0a, t1b), Vec3Dot(t0a, t0b));
  return a + 2. * PETSC_PI * PetscFloorReal((j->angle - a) / (2. * PETSC_PI) + .5);
}

/* Rotation vector phi and the rows e.phi for the two normals and the axis of b. */
static void BendRows(const RigidJoint *j, const Frame *a, const Frame *b, RigidRow row[3])
{
  const PetscReal *axis[3] = {j->tb[0], j->tb[1], j->ub};
  const PetscReal back[4] = {j->qrel[0], -j->qrel[1], -j->qrel[2], -j->qrel[3]};
  PetscReal q[4], p[4], phi[3], v, angle, c;
  RelativeRotation(a, b, q);
  QuatMult(q, back, p);
  if (p[0] < 0.)
    for (int k = 0; k < 4; k++) p[k] = -p[k];
  v = Vec3Norm(p + 1);
  angle = 2. * PetscAtan2Real(v, p[0]);
  for (int k = 0; k < 3; k++) phi[k] = v > 0. ? angle * p[1 + k] / v : 0.;
  c = angle < 1.e-3 ? 1. / 12. + angle * angle / 720.
                    : 1. / (angle * angle) - (1. + PetscCosReal(angle)) / (2. * angle * PetscSinReal(angle));
  for (int m = 0; m < 3; m++) {
    PetscReal x[3], y[3], z[3], s[3];
    Vec3Cross(phi, axis[m], x);
    Vec3Cross(phi, x, y);
    for (int k = 0; k < 3; k++) z[k] = axis[m][k] + .5 * x[k] + c * y[k];
    Mat3Mult(b->R, z, s);
    TurnRow(s, Vec3Dot(axis[m], phi), &row[m]);
  }
}

static void SpringRow(const PetscReal ra[3], const PetscReal rb[3], const PetscReal d[3], RigidRow *row)
{
  const PetscReal l = Vec3Norm(d);
  PetscReal e[3];
  for (int k = 0; k < 3; k++) e[k] = l > 0. ? d[k] / l : 0.;
  PointRow(e, ra, rb, d, PETSC_FALSE, row);
  row->g = l;
}

/* Values and Jacobians of all rows at the present placement of the bodies; rest values of the soft rows subtracted. */
void RigidJointRows(Rigid rigid, RigidJoint *j, RigidRow row[])
{
  Frame a, b;
  PetscReal ra[3], rb[3], d[3], ua[3], ub[3], ta[2][3], tb[2][3];
  const RigidJointType type = j->spec.type;
  PetscInt soft = 0;
  EndFrame(rigid, j->spec.a, &a);
  EndFrame(rigid, j->spec.b, &b);
  Mat3Mult(a.R, j->ra, ra);
  Mat3Mult(b.R, j->rb, rb);
  Mat3Mult(a.R, j->ua, ua);
  Mat3Mult(b.R, j->ub, ub);
  for (int m = 0; m < 2; m++) {
    Mat3Mult(a.R, j->ta[m], ta[m]);
    Mat3Mult(b.R, j->tb[m], tb[m]);
  }
  for (int k = 0; k < 3; k++) d[k] = (a.X[k] + ra[k]) - (b.X[k] + rb[k]);
  if (type == RIGID_JOINT_BALL || type == RIGID_JOINT_HINGE || type == RIGID_JOINT_BEND) {
    for (int k = 0; k < 3; k++) {
      const PetscReal e[3] = {k == 0, k == 1, k == 2};
      PointRow(e, ra, rb, d, PETSC_FALSE, &row[k]);
    }
  }
  if (type == RIGID_JOINT_HINGE) {
    for (int m = 0; m < 2; m++) AngleRow(ua, tb[m], &row[3 + m]);
    TurnRow(ub, HingeAngle(j, ta[0], tb[0], tb[1]), &row[5]);
  } else if (type == RIGID_JOINT_SLIDER) {
    for (int m = 0; m < 2; m++) {
      PointRow(tb[m], ra, rb, d, PETSC_TRUE, &row[m]);
      AngleRow(ua, tb[m], &row[2 + m]);
    }
    AngleRow(ta[0], tb[1], &row[4]);
    PointRow(ub, ra, rb, d, PETSC_TRUE, &row[5]);
  } else if (type == RIGID_JOINT_SPRING) {
    SpringRow(ra, rb, d, &row[0]);
  } else if (type == RIGID_JOINT_LINEAR) {
    PointRow(ub, ra, rb, d, PETSC_TRUE, &row[0]);
  } else if (type == RIGID_JOINT_BEND) {
    BendRows(j, &a, &b, &row[3]);
  }
  for (PetscInt r = 0; r < j->nrows; r++)
    if (!j->hard[r]) row[r].g -= j->rest[soft++]; /* NOLINT(clang-analyzer-core.uninitialized.Assign): one of the types */
}

static PetscErrorCode CheckJoint(Rigid rigid, PetscInt joint)
{
  PetscFunctionBegin;
  PetscCheck(joint >= 0 && joint < rigid->njoints, rigid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Rigid joint %" PetscInt_FMT ": there are %" PetscInt_FMT " joints", joint, rigid->njoints);
  PetscCheck(rigid->setup, rigid->comm, PETSC_ERR_ORDER, "Call RigidSetUp() first");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidGetJointForce(Rigid rigid, PetscInt joint, PetscReal F[3], PetscReal M[3])
{
  RigidRow row[RIGID_MAX_ROWS];
  RigidJoint *j;
  PetscReal f[3] = {0., 0., 0.}, m[3] = {0., 0., 0.}, arm[3] = {0., 0., 0.}, x[3];

  PetscFunctionBegin;
  PetscCall(CheckJoint(rigid, joint));
  j = &rigid->joint[joint];
  RigidJointRows(rigid, j, row);
  for (PetscInt r = 0; r < j->nrows; r++)
    for (int k = 0; k < 3; k++) {
      f[k] += j->force[r] * row[r].Ja[k];
      m[k] += j->force[r] * row[r].Ja[3 + k];
    }
  if (j->spec.a != RIGID_GROUND)
    QuatRotate(rigid->body[j->spec.a].q, j->ra, arm);
  else
    for (int k = 0; k < 3; k++) arm[k] = j->ra[k];
  Vec3Cross(arm, f, x);
  for (int k = 0; k < 3; k++) {
    if (F) F[k] = f[k];
    if (M) M[k] = m[k] - x[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidGetJointState(Rigid rigid, PetscInt joint, PetscReal *coordinate, PetscBool *broken)
{
  RigidRow row[RIGID_MAX_ROWS];
  RigidJoint *j;
  PetscReal sum = 0.;
  PetscInt soft = 0;

  PetscFunctionBegin;
  PetscCall(CheckJoint(rigid, joint));
  j = &rigid->joint[joint];
  RigidJointRows(rigid, j, row);
  for (PetscInt r = 0; r < j->nrows; r++) {
    if (j->hard[r]) continue;
    if (j->spec.type == RIGID_JOINT_SPRING)
      sum = row[r].g;
    else if (j->spec.type == RIGID_JOINT_BEND)
      sum = PetscSqrtReal(sum * sum + PetscSqr(row[r].g + j->rest[soft]));
    else
      sum = row[r].g + j->rest[soft];
    soft++;
  }
  if (coordinate) *coordinate = sum;
  if (broken) *broken = j->broken;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidGetJointEnergy(Rigid rigid, PetscReal *elastic)
{
  PetscFunctionBegin;
  PetscCheck(rigid->setup, rigid->comm, PETSC_ERR_ORDER, "Call RigidSetUp() first");
  *elastic = 0.;
  for (PetscInt i = 0; i < rigid->njoints; i++) {
    RigidRow row[RIGID_MAX_ROWS];
    RigidJoint *j = &rigid->joint[i];
    RigidJointRows(rigid, j, row);
    for (PetscInt r = 0; r < j->nrows && !j->broken; r++)
      if (!j->hard[r]) *elastic += .5 * j->k[r] * row[r].g * row[r].g;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
