/* coupleattach.c - attachments of beam nodes to rigid bodies: what is attached to what, set-up and state; steps:
 * coupleattachstep.c.
 */
#include "coupleattach.h"

PetscErrorCode CoupleAttachCreate(MPI_Comm comm, Ancf ancf, Rigid rigid, CoupleAttach *attach)
{
  CoupleAttach l;

  PetscFunctionBegin;
  PetscCall(PetscNew(&l));
  l->comm = comm;
  l->ancf = ancf;
  l->rigid = rigid;
  l->tolerance = 1e-8;
  l->maxiterations = 50;
  *attach = l;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleAttachSetIterations(CoupleAttach l, PetscInt n, PetscReal tolerance)
{
  PetscFunctionBegin;
  PetscCheck(n >= 1, l->comm, PETSC_ERR_ARG_OUTOFRANGE, "couple_attach_iterations = %" PetscInt_FMT ": must be 1 or more", n);
  PetscCheck(tolerance > 0.0 && tolerance < 1.0, l->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "couple_attach_tolerance = %g: must be in (0, 1)", (double)tolerance);
  l->maxiterations = n;
  l->tolerance = tolerance;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleAttachSetFromOptions(CoupleAttach l)
{
  PetscInt n = l->maxiterations;
  PetscReal tolerance = l->tolerance;

  PetscFunctionBegin;
  PetscOptionsBegin(l->comm, NULL, "Attachment options", "CoupleAttach");
  PetscCall(PetscOptionsInt("-couple_attach_iterations", "Most iterations in a step for the forces between beams and bodies",
                            "CoupleAttachSetIterations", n, &n, NULL));
  PetscCall(PetscOptionsReal("-couple_attach_tolerance", "Relative tolerance of these forces", "CoupleAttachSetIterations",
                             tolerance, &tolerance, NULL));
  PetscCall(CoupleAttachSetIterations(l, n, tolerance));
  PetscOptionsEnd();
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleAttachAdd(CoupleAttach l, PetscInt beam, PetscInt node, PetscInt body)
{
  RigidBodySpec spec;
  AncfBeamSpec bspec;
  AncfEnd how;
  Attachment *a;
  const PetscReal *e;
  PetscReal X[3], q[4], R[9], d[3], depth;
  PetscInt nbodies, first;

  PetscFunctionBegin;
  PetscCheck(!l->setup, l->comm, PETSC_ERR_ORDER, "CoupleAttachAdd: attachments cannot be added after CoupleAttachSetUp()");
  PetscCall(AncfGetSupport(l->ancf, beam, node, &how));
  PetscCall(RigidGetNumBodies(l->rigid, &nbodies));
  PetscCheck(body >= 0 && body < nbodies, l->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "CoupleAttachAdd: body %" PetscInt_FMT " must be in 0..%" PetscInt_FMT, body, nbodies - 1);
  PetscCheck(how != ANCF_END_FREE, l->comm, PETSC_ERR_ARG_WRONG,
             "CoupleAttachAdd: node %" PetscInt_FMT " of beam %" PetscInt_FMT " has no support (AncfFixNode)", node, beam);
  for (PetscInt i = 0; i < l->n; i++)
    PetscCheck(l->a[i].beam != beam || l->a[i].node != node, l->comm, PETSC_ERR_ARG_INCOMP,
               "CoupleAttachAdd: node %" PetscInt_FMT " of beam %" PetscInt_FMT " is attached to body %" PetscInt_FMT " already",
               node, beam, l->a[i].body);
  if (l->n == l->cap) {
    l->cap = 2 * l->cap + 8;
    PetscCall(PetscRealloc(sizeof(Attachment) * (size_t)l->cap, &l->a));
  }
  a = &l->a[l->n];
  PetscCall(PetscMemzero(a, sizeof(*a)));
  a->beam = beam, a->node = node, a->body = body;
  a->clamp = how == ANCF_END_CLAMP ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(AncfGetBeam(l->ancf, beam, &bspec, &first, NULL));
  a->at = first + node;
  PetscCall(AncfGetState(l->ancf, NULL, &e, NULL, NULL));
  PetscCall(RigidGetState(l->rigid, body, X, q, NULL, NULL));
  PetscCall(RigidGetBody(l->rigid, body, &spec));
  RigidRotationMatrix(q, R);
  for (int c = 0; c < 3; c++) d[c] = e[6 * a->at + c] - X[c];
  Turn(R, PETSC_TRUE, d, a->place);
  Turn(R, PETSC_TRUE, e + 6 * a->at + 3, a->gradient);
  depth = RigidShapeDistance(&spec, a->place);
  PetscCheck(depth <= bspec.diameter, l->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "CoupleAttachAdd: node %" PetscInt_FMT " of beam %" PetscInt_FMT " lies %g m outside of body %" PetscInt_FMT
             "; it may be as far as the beam's diameter, %g m",
             node, beam, (double)depth, body, (double)bspec.diameter);
  l->n++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Beams that joints tie together are one set; numbered by the attachments, -1 elsewhere. */
static PetscErrorCode FindSets(CoupleAttach l)
{
  PetscInt joints, n, beam, first, *root;
  PetscBool changed = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(AncfGetNumBeams(l->ancf, &l->nbeams));
  PetscCall(AncfGetNumJoints(l->ancf, &joints));
  PetscCall(PetscMalloc1(l->nbeams, &l->setof));
  PetscCall(PetscMalloc1(l->nbeams, &root));
  PetscCall(PetscCalloc1(l->n, &l->sets));
  for (PetscInt b = 0; b < l->nbeams; b++) root[b] = b, l->setof[b] = -1;
  while (changed) {
    changed = PETSC_FALSE;
    for (PetscInt j = 0; j < joints; j++) {
      PetscCall(AncfGetJoint(l->ancf, j, 0, &n, &first, NULL));
      for (PetscInt k = 1; k < n; k++) {
        PetscCall(AncfGetJoint(l->ancf, j, k, NULL, &beam, NULL));
        if (root[beam] == root[first]) continue;
        root[beam] = root[first] = PetscMin(root[beam], root[first]);
        changed = PETSC_TRUE;
      }
    }
  }
  for (PetscInt i = 0; i < l->n; i++) {
    Attachment *a = &l->a[i];

    a->set = l->setof[a->beam];
    if (a->set < 0) {
      a->set = l->nsets++;
      l->sets[a->set].closed = PETSC_TRUE;
      for (PetscInt b = 0; b < l->nbeams; b++)
        if (root[b] == root[a->beam]) l->setof[b] = a->set;
    }
    l->sets[a->set].n++;
    if (a->clamp) l->sets[a->set].clamps++;
    if (a->unknown < 0) l->sets[a->set].closed = PETSC_FALSE;
  }
  PetscCall(PetscFree(root));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A support without an attachment makes its set one that the ground holds, too. */
static PetscErrorCode FindGround(CoupleAttach l)
{
  PetscFunctionBegin;
  for (PetscInt b = 0; b < l->nbeams; b++) {
    AncfBeamSpec spec;

    if (l->setof[b] < 0) continue;
    PetscCall(AncfGetBeam(l->ancf, b, &spec, NULL, NULL));
    for (PetscInt k = 0; k <= spec.elements; k++) {
      PetscBool attached = PETSC_FALSE;
      AncfEnd how;

      PetscCall(AncfGetSupport(l->ancf, b, k, &how));
      for (PetscInt i = 0; i < l->n && how != ANCF_END_FREE; i++)
        if (l->a[i].beam == b && l->a[i].node == k) attached = PETSC_TRUE;
      if (how != ANCF_END_FREE && !attached) l->sets[l->setof[b]].closed = PETSC_FALSE;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Free bodies, their size, and the mass of the beams on each over its own. */
static PetscErrorCode FindBodies(CoupleAttach l)
{
  RigidBodySpec spec;
  AncfBeamSpec bspec;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(l->n, &l->free, l->n, &l->length, l->n, &l->ratio));
  for (PetscInt i = 0; i < l->n; i++) {
    Attachment *a = &l->a[i];
    PetscReal l2 = 0, element;

    a->unknown = -1;
    PetscCall(RigidGetBody(l->rigid, a->body, &spec));
    if (spec.motion != RIGID_FREE) continue;
    for (PetscInt k = 0; k < l->nfree; k++)
      if (l->free[k] == a->body) a->unknown = k;
    if (a->unknown < 0) {
      a->unknown = l->nfree;
      l->free[l->nfree] = a->body;
      for (int c = 0; c < 3; c++) l2 += spec.inertia[c];
      l->length[l->nfree] = PetscSqrtReal(l2 / (3 * spec.mass));
      l->ratio[l->nfree++] = 0;
    }
    PetscCall(AncfGetBeam(l->ancf, a->beam, &bspec, NULL, &element));
    l->ratio[a->unknown] += bspec.rhoA * element * (PetscReal)bspec.elements / spec.mass;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleAttachSetUp(CoupleAttach l)
{
  PetscInt nodes, nb, nr, m;

  PetscFunctionBegin;
  if (l->setup) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FindBodies(l));
  PetscCall(FindSets(l));
  PetscCall(FindGround(l));
  m = 6 * l->nfree;
  PetscCall(AncfGetNumNodes(l->ancf, &nodes));
  PetscCall(AncfGetPackSize(l->ancf, &nb));
  PetscCall(RigidGetPackSize(l->rigid, &nr));
  PetscCall(PetscMalloc6(nb, &l->beams, nr, &l->bodies, 6 * (size_t)nodes, &l->f0, 6 * (size_t)nodes, &l->f1, 6 * (size_t)nodes,
                         &l->f2, 12 * (size_t)l->nbeams, &l->balance));
  PetscCall(PetscCalloc4(m, &l->W, (size_t)m * (size_t)m, &l->B, 3 * (size_t)l->nfree, &l->X, m, &l->G));
  PetscCall(PetscCalloc4(m, &l->R, m, &l->Rold, m, &l->s, m, &l->y));
  CoupleAttachFirstInverse(l);
  for (PetscInt i = 0; i < l->n; i++) { /* the nodes have the bodies' velocity from the start */
    PetscReal e[6], v[6], zero[6] = {0};

    PetscCall(CoupleAttachFollow(l, &l->a[i], e, v));
    PetscCall(AncfSetNodeMotion(l->ancf, l->a[i].beam, l->a[i].node, e, v, zero));
  }
  PetscCall(AncfGetReactions(l->ancf, l->f1));
  CoupleAttachSum(l);
  l->setup = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleAttachGetNum(CoupleAttach l, PetscInt *n)
{
  PetscFunctionBegin;
  *n = l->n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleAttachGetForce(CoupleAttach l, PetscInt i, PetscReal F[3], PetscReal M[3])
{
  PetscFunctionBegin;
  PetscCheck(i >= 0 && i < l->n, l->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "CoupleAttachGetForce: attachment %" PetscInt_FMT " must be in 0..%" PetscInt_FMT, i, l->n - 1);
  for (int c = 0; c < 3; c++) {
    if (F) F[c] = l->a[i].F[c];
    if (M) M[c] = l->a[i].M[c];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleAttachGetExchange(CoupleAttach l, CoupleExchange *exchange)
{
  const PetscReal *e;

  PetscFunctionBegin;
  *exchange = l->done;
  PetscCall(AncfGetState(l->ancf, NULL, &e, NULL, NULL));
  for (PetscInt i = 0; i < l->n; i++) {
    const PetscReal *x = e + 6 * l->a[i].at, *f = l->f1 + 6 * l->a[i].at;
    PetscReal t[3], m[3];

    CoupleCross(x, f, t);
    CoupleCross(x + 3, f + 3, m);
    for (int c = 0; c < 3; c++) exchange->torque[c] += t[c] + m[c];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleAttachGetIterations(CoupleAttach l, PetscInt *n)
{
  PetscFunctionBegin;
  *n = l->iterations;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void CoupleAttachTotal(CoupleAttach l, PetscReal bodies[3], PetscReal held[3], PetscReal ends[3])
{
  for (int c = 0; c < 3; c++) {
    bodies[c] = held[c] = 0;
    ends[c] = 0.5 * (l->sum[0][c] + l->sum[1][c]);
  }
  for (PetscInt k = 0; k < l->nfree; k++)
    for (int c = 0; c < 3; c++) bodies[c] += l->W[6 * k + c];
  for (PetscInt i = 0; i < l->n; i++)
    for (int c = 0; c < 3 && l->a[i].unknown < 0; c++) held[c] += l->a[i].F[c];
}

/* What goes on from step to step: wrenches, the matrix, and the forces to report. */
void CoupleAttachCount(CoupleAttach l, PetscInt *n)
{
  const PetscInt m = 6 * l->nfree;

  *n = m + m * m + 12 * l->n + 7 + (PetscInt)(sizeof(l->done) / sizeof(PetscReal));
}

static void Swap(PetscBool load, PetscReal **at, PetscReal *x, PetscInt n)
{
  for (PetscInt i = 0; i < n; i++, (*at)++) {
    if (load)
      x[i] = **at;
    else
      **at = x[i];
  }
}

void CoupleAttachCopy(CoupleAttach l, PetscBool load, PetscReal *state)
{
  const PetscInt m = 6 * l->nfree;
  PetscReal known = l->known ? 1 : 0;

  Swap(load, &state, l->W, m);
  Swap(load, &state, l->B, m * m);
  for (PetscInt i = 0; i < l->n; i++) {
    Swap(load, &state, l->a[i].F, 3);
    Swap(load, &state, l->a[i].M, 3);
    Swap(load, &state, l->a[i].last, 6);
  }
  Swap(load, &state, l->sum[0], 6);
  Swap(load, &state, (PetscReal *)&l->done, (PetscInt)(sizeof(l->done) / sizeof(PetscReal)));
  Swap(load, &state, &known, 1);
  l->known = known != 0 ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode CoupleAttachMoveState(CoupleAttach l, FrondState *s)
{
  PetscReal *x = NULL;
  const FrondStateWay way = s->way;
  PetscInt n;

  PetscFunctionBegin;
  CoupleAttachCount(l, &n);
  if (way != FROND_STATE_COUNT) PetscCall(PetscMalloc1(n, &x));
  if (way == FROND_STATE_SAVE) CoupleAttachCopy(l, PETSC_FALSE, x);
  FrondMoveReal(s, "attach/state", x, n);
  FrondMoveInt(s, "attach/iterations", &l->iterations, 1);
  if (way == FROND_STATE_LOAD) CoupleAttachCopy(l, PETSC_TRUE, x);
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleAttachView(CoupleAttach l, PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "Attachments: %" PetscInt_FMT " of beams to bodies, couple_attach_iterations %" PetscInt_FMT
                                   ", couple_attach_tolerance %g\n",
                                   l->n, l->maxiterations, (double)l->tolerance));
  for (PetscInt i = 0; i < l->n; i++)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  node %" PetscInt_FMT " of beam %" PetscInt_FMT ", %s to body %" PetscInt_FMT "\n",
                                     l->a[i].node, l->a[i].beam, l->a[i].clamp ? "clamped" : "ball-jointed", l->a[i].body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleAttachDestroy(CoupleAttach *attach)
{
  CoupleAttach l = *attach;

  PetscFunctionBegin;
  if (!l) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree(l->a));
  PetscCall(PetscFree(l->setof));
  PetscCall(PetscFree(l->sets));
  if (l->free) PetscCall(PetscFree3(l->free, l->length, l->ratio));
  if (l->setup) {
    PetscCall(PetscFree6(l->beams, l->bodies, l->f0, l->f1, l->f2, l->balance));
    PetscCall(PetscFree4(l->W, l->B, l->X, l->G));
    PetscCall(PetscFree4(l->R, l->Rold, l->s, l->y));
  }
  PetscCall(PetscFree(*attach));
  PetscFunctionReturn(PETSC_SUCCESS);
}
