/*
  coupleshort.c - short-range forces of ANCF beams (Sect. 2.5): lubrication and repulsion per length of axis (shortrange.h) over
  samples, generalised forces Q = S^T F (Eq. 23). Each pair of points gets equal and opposite forces along the line through
  them: both momenta are kept.

  The forces are held over a step h and taken from the gaps in its middle and the velocities at its start,
  f = k d/(1 + h^2 k G/2) - c v_n/(1 + h c G), G = sum_j |J M^-1 J_j^T| over the pairs j at the same beams and body. The row sums
  bound the eigenvalues of all pairs together, h D M^-1 < 1 and h^2 K M^-1 < 2: no step makes them unstable, and repulsion alone
  is a leapfrog rule that loses no energy. |M^-1| is that of the whole beam without stiffness, which only takes mobility away.
*/
#include "coupleshort.h"
#include "coupleattach.h"
#include <stdlib.h>

PetscErrorCode CoupleShortCreate(MPI_Comm comm, Ancf ancf, Rigid rigid, CoupleShort *sr)
{
  CoupleShort c;

  PetscFunctionBegin;
  PetscCall(PetscNew(&c));
  c->comm = comm;
  c->ancf = ancf;
  c->rigid = rigid;
  c->persample = 8;
  c->t0 = PETSC_NINFINITY;
  PetscCall(ShortRangeInit(&c->p));
  *sr = c;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleShortSetParameters(CoupleShort c, const ShortRange *p)
{
  PetscFunctionBegin;
  PetscCheck(!c->setup, c->comm, PETSC_ERR_ORDER, "CoupleShortSetParameters() must come before CoupleShortSetUp()");
  PetscCall(ShortRangeCheck(c->comm, p));
  c->p = *p;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleShortSetSamples(CoupleShort c, PetscInt n)
{
  PetscFunctionBegin;
  PetscCheck(!c->setup, c->comm, PETSC_ERR_ORDER, "CoupleShortSetSamples() must come before CoupleShortSetUp()");
  PetscCheck(n >= 2 && n <= 64, c->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "couple_shortrange_samples = %" PetscInt_FMT ": must be in [2, 64]", n);
  c->persample = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleShortSetAttach(CoupleShort c, CoupleAttach attach)
{
  PetscFunctionBegin;
  PetscCheck(!c->setup, c->comm, PETSC_ERR_ORDER, "CoupleShortSetAttach() must come before CoupleShortSetUp()");
  PetscCheck(!attach || (attach->setup && attach->ancf == c->ancf && attach->rigid == c->rigid), c->comm, PETSC_ERR_ARG_INCOMP,
             "CoupleShortSetAttach(): the attachments must be set up, of the same beams and bodies");
  c->attach = attach;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleShortSetPeriod(CoupleShort c, const PetscReal period[3])
{
  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    PetscCheck(period[k] >= 0. && !PetscIsInfOrNanReal(period[k]), c->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "CoupleShortSetPeriod(): component %d = %g m; must be > 0, or 0 for none", k, (double)period[k]);
    c->period[k] = period[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleShortAddWall(CoupleShort c, const PetscReal x[3], const PetscReal normal[3])
{
  const PetscReal norm = PetscSqrtReal(CoupleDot(normal, normal));

  PetscFunctionBegin;
  PetscCheck(c->nwalls < 6, c->comm, PETSC_ERR_ARG_OUTOFRANGE, "CoupleShortAddWall(): there are 6 walls already");
  PetscCheck(norm > 0. && !PetscIsInfOrNanReal(norm + x[0] + x[1] + x[2]), c->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "CoupleShortAddWall(): the normal (%g, %g, %g) must be finite and longer than 0", (double)normal[0],
             (double)normal[1], (double)normal[2]);
  for (int k = 0; k < 3; k++) {
    c->wall[c->nwalls].x[k] = x[k];
    c->wall[c->nwalls].n[k] = normal[k] / norm;
  }
  c->nwalls++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleShortSetFromOptions(CoupleShort c)
{
  ShortRange p = c->p;
  PetscInt n = c->persample;
  PetscReal spacing = 0.;

  PetscFunctionBegin;
  PetscCall(ShortRangeSetFromOptions(c->comm, NULL, &p, &spacing));
  PetscCall(CoupleShortSetParameters(c, &p));
  PetscOptionsBegin(c->comm, NULL, "Short-range forces of beams", "Couple");
  PetscCall(PetscOptionsInt("-couple_shortrange_samples", "Samples of a beam's axis per diameter for its short-range forces",
                            "CoupleShortSetSamples", n, &n, NULL));
  PetscOptionsEnd();
  PetscCall(CoupleShortSetSamples(c, n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* |M^-1| of a beam of n elements, unit length each, unit mass per length; held coordinates do not move. */
static PetscErrorCode MakeInverse(ShortInverse *inv)
{
  const PetscReal m[4][4] = {{156, 22, 54, -13}, {22, 4, 13, -3}, {54, 13, 156, -22}, {-13, -3, -22, 4}};
  const PetscInt n = 2 * inv->elements + 2;
  const PetscBool held[4] = {inv->held[0][0], inv->held[0][1], inv->held[1][0], inv->held[1][1]};
  PetscScalar *a, *x;
  Mat A, B, X;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1((size_t)n * (size_t)n, &inv->m));
  PetscCall(PetscCalloc2((size_t)n * (size_t)n, &a, (size_t)n * (size_t)n, &x));
  for (PetscInt e = 0; e < inv->elements; e++)
    for (PetscInt i = 0; i < 4; i++)
      for (PetscInt j = 0; j < 4; j++) a[(2 * e + i) * n + 2 * e + j] += m[i][j] / 420.;
  for (PetscInt i = 0; i < n; i++) x[i * n + i] = 1.;
  for (PetscInt k = 0; k < 4; k++) {
    const PetscInt at = k < 2 ? k : n - 4 + k;
    for (PetscInt i = 0; i < n && held[k]; i++) a[at * n + i] = a[i * n + at] = x[at * n + i] = 0.;
    if (held[k]) a[at * n + at] = 1.;
  }
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, n, n, a, &A));
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, n, n, x, &B));
  PetscCall(MatDuplicate(B, MAT_DO_NOT_COPY_VALUES, &X));
  PetscCall(MatLUFactor(A, NULL, NULL, NULL));
  PetscCall(MatMatSolve(A, B, X));
  {
    const PetscScalar *y;
    PetscCall(MatDenseGetArrayRead(X, &y));
    for (PetscInt i = 0; i < n * n; i++) inv->m[i] = PetscAbsReal(PetscRealPart(y[i]));
    PetscCall(MatDenseRestoreArrayRead(X, &y));
  }
  PetscCall(MatDestroy(&A));
  PetscCall(MatDestroy(&B));
  PetscCall(MatDestroy(&X));
  PetscCall(PetscFree2(a, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FindInverse(CoupleShort c, const AncfBeamSpec *s, PetscInt *number)
{
  ShortInverse inv;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(&inv, sizeof(inv)));
  inv.elements = s->elements;
  inv.held[0][0] = s->end0 != ANCF_END_FREE ? PETSC_TRUE : PETSC_FALSE;
  inv.held[0][1] = s->end0 == ANCF_END_CLAMP ? PETSC_TRUE : PETSC_FALSE;
  inv.held[1][0] = s->end1 != ANCF_END_FREE ? PETSC_TRUE : PETSC_FALSE;
  inv.held[1][1] = s->end1 == ANCF_END_CLAMP ? PETSC_TRUE : PETSC_FALSE;
  for (*number = 0; *number < c->ninverses; (*number)++) {
    const ShortInverse *i = &c->inverse[*number];
    if (i->elements == inv.elements && i->held[0][0] == inv.held[0][0] && i->held[0][1] == inv.held[0][1] &&
        i->held[1][0] == inv.held[1][0] && i->held[1][1] == inv.held[1][1])
      PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(MakeInverse(&inv));
  PetscCall(PetscRealloc(sizeof(inv) * (size_t)(c->ninverses + 1), &c->inverse));
  c->inverse[c->ninverses++] = inv;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Samples from one cap's centre to the other's; links of about a diameter. */
static PetscErrorCode SetUpBeam(CoupleShort c, PetscInt i)
{
  ShortBeam *b = &c->beam[i];
  AncfBeamSpec spec;

  PetscFunctionBegin;
  PetscCall(AncfGetBeam(c->ancf, i, &spec, &b->node, &b->l));
  b->elements = spec.elements;
  b->R = .5 * spec.diameter;
  b->L = b->l * (PetscReal)spec.elements;
  b->rhoA = spec.rhoA;
  b->exclude = PETSC_PI * (b->R + .5 * c->reach);
  b->held[0] = spec.end0 != ANCF_END_FREE ? PETSC_TRUE : PETSC_FALSE;
  b->held[1] = spec.end1 != ANCF_END_FREE ? PETSC_TRUE : PETSC_FALSE;
  b->lo = b->held[0] ? 0. : PetscMin(b->R, .45 * b->L);
  b->hi = b->held[1] ? b->L : b->L - PetscMin(b->R, .45 * b->L);
  b->samples = (PetscInt)PetscCeilReal((b->hi - b->lo) * (PetscReal)c->persample / (2. * b->R) - 1.e-9);
  b->samples = PetscMax(1, b->samples);
  b->step = (b->hi - b->lo) / (PetscReal)b->samples;
  b->sample = c->nsamples;
  b->link = c->nlinks;
  b->links = (b->samples + c->persample - 1) / c->persample;
  c->nsamples += b->samples;
  c->nlinks += b->links;
  PetscCall(FindInverse(c, &spec, &b->inverse));
  for (int k = 0; k < 3; k++)
    PetscCheck(c->period[k] == 0. || c->period[k] >= 2. * (5. * b->R + c->reach), c->comm, PETSC_ERR_ARG_INCOMP,
               "beam %" PetscInt_FMT ": a period of %g m is too short for nearest images; must be >= %g m", i,
               (double)c->period[k], (double)(2. * (5. * b->R + c->reach)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  PetscReal x[3], s;
  PetscInt beam;
} ShortNode;

static int CompareNodes(const void *pa, const void *pb)
{
  const ShortNode *a = (const ShortNode *)pa, *b = (const ShortNode *)pb;
  if (a->x[0] != b->x[0]) return a->x[0] < b->x[0] ? -1 : 1;
  return a->beam < b->beam ? -1 : (a->beam > b->beam);
}

static int CompareJoints(const void *pa, const void *pb)
{
  const ShortJoint *a = (const ShortJoint *)pa, *b = (const ShortJoint *)pb;
  if (a->a != b->a) return a->a < b->a ? -1 : 1;
  if (a->b != b->b) return a->b < b->b ? -1 : 1;
  return a->sa < b->sa ? -1 : (a->sa > b->sa);
}

static int CompareAttached(const void *pa, const void *pb)
{
  const ShortAttach *a = (const ShortAttach *)pa, *b = (const ShortAttach *)pb;
  if (a->body != b->body) return a->body < b->body ? -1 : 1;
  if (a->beam != b->beam) return a->beam < b->beam ? -1 : 1;
  return a->s < b->s ? -1 : (a->s > b->s);
}

static PetscErrorCode AddJoint(CoupleShort c, const ShortJoint *j)
{
  PetscFunctionBegin;
  if (c->njoints == c->ajoints) {
    c->ajoints = 2 * c->ajoints + 16;
    PetscCall(PetscRealloc(sizeof(ShortJoint) * (size_t)c->ajoints, &c->joint));
  }
  c->joint[c->njoints++] = *j;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where beams are attached, body by body; two places on one body join their beams through it. */
static PetscErrorCode FindAttached(CoupleShort c)
{
  const CoupleAttach l = c->attach;
  const PetscReal *e;

  PetscFunctionBegin;
  if (!l || !l->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2((size_t)l->n, &c->attached, (size_t)c->nbodies + 1, &c->bodyof));
  PetscCall(AncfGetState(c->ancf, NULL, &e, NULL, NULL));
  for (c->nattach = 0; c->nattach < l->n; c->nattach++) {
    const Attachment *from = &l->a[c->nattach];
    ShortAttach *to = &c->attached[c->nattach];
    RigidBodySpec spec;

    PetscCall(RigidGetBody(c->rigid, from->body, &spec));
    to->beam = from->beam;
    to->body = from->body;
    to->s = c->beam[from->beam].l * (PetscReal)from->node;
    to->depth = PetscMax(0., -RigidShapeDistance(&spec, from->place));
    PetscCall(PetscArraycpy(to->x, e + 6 * from->at, 3));
    c->bodyof[from->body + 1]++;
  }
  qsort(c->attached, (size_t)c->nattach, sizeof(*c->attached), CompareAttached);
  for (PetscInt b = 0; b < c->nbodies; b++) c->bodyof[b + 1] += c->bodyof[b];
  for (PetscInt i = 0; i < c->nattach; i++)
    for (PetscInt j = i + 1; j < c->bodyof[c->attached[i].body + 1]; j++) {
      const ShortAttach *a = &c->attached[i], *b = &c->attached[j];
      PetscReal d2 = 0.;

      for (int k = 0; k < 3; k++) d2 += PetscSqr(a->x[k] - b->x[k]);
      PetscCall(AddJoint(c, &(ShortJoint){a->beam, b->beam, a->s, b->s, PetscSqrtReal(d2)}));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes of different beams that lie in one place now. */
static PetscErrorCode FindJoints(CoupleShort c)
{
  ShortNode *node;
  const PetscReal *e;
  PetscInt n = 0;

  PetscFunctionBegin;
  PetscCall(AncfGetNumJoints(c->ancf, &n));
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AncfGetState(c->ancf, NULL, &e, NULL, NULL));
  PetscCall(PetscMalloc1(c->nnodes, &node));
  n = 0;
  for (PetscInt i = 0; i < c->nbeams; i++)
    for (PetscInt k = 0; k <= c->beam[i].elements; k++, n++) {
      PetscCall(PetscArraycpy(node[n].x, e + 6 * (c->beam[i].node + k), 3));
      node[n].s = c->beam[i].l * (PetscReal)k;
      node[n].beam = i;
    }
  qsort(node, (size_t)n, sizeof(*node), CompareNodes);
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = i + 1; j < n && node[j].x[0] - node[i].x[0] <= 1.e-6 * c->beam[node[i].beam].L; j++) {
      const ShortNode *a = node[i].beam < node[j].beam ? &node[i] : &node[j], *b = a == &node[i] ? &node[j] : &node[i];
      if (a->beam == b->beam || PetscAbsReal(a->x[1] - b->x[1]) + PetscAbsReal(a->x[2] - b->x[2]) > 1.e-6 * c->beam[a->beam].L)
        continue;
      PetscCall(AddJoint(c, &(ShortJoint){a->beam, b->beam, a->s, b->s, 0.}));
    }
  PetscCall(PetscFree(node));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The deepest overlap is an error. */
static PetscErrorCode CheckOverlap(CoupleShort c)
{
  const ShortPair *p = NULL;
  PetscReal deep;
  PetscInt a;

  PetscFunctionBegin;
  c->half = 0.;
  PetscCall(CoupleShortFindPairs(c));
  for (PetscInt i = 0; i < c->npairs; i++)
    if (c->pair[i].gap < -1.e-9 * c->pair[i].R && (!p || c->pair[i].gap < p->gap)) p = &c->pair[i];
  if (!p) PetscFunctionReturn(PETSC_SUCCESS);
  deep = -p->gap;
  a = p->a.beam;
  PetscCheck(p->body != SHORT_BEAM || a != p->b.beam, c->comm, PETSC_ERR_ARG_INCOMP,
             "beam %" PetscInt_FMT " overlaps itself by %g m", a, (double)deep);
  PetscCheck(p->body != SHORT_BEAM, c->comm, PETSC_ERR_ARG_INCOMP,
             "beam %" PetscInt_FMT " and beam %" PetscInt_FMT " overlap by %g m", PetscMin(a, p->b.beam), PetscMax(a, p->b.beam),
             (double)deep);
  PetscCheck(p->body < 0, c->comm, PETSC_ERR_ARG_INCOMP, "beam %" PetscInt_FMT " and body %" PetscInt_FMT " overlap by %g m", a,
             p->body, (double)deep);
  SETERRQ(c->comm, PETSC_ERR_ARG_INCOMP, "beam %" PetscInt_FMT " overlaps the wall of normal (%g, %g, %g) by %g m", a,
          (double)p->n[0], (double)p->n[1], (double)p->n[2], (double)deep);
}

PetscErrorCode CoupleShortSetUp(CoupleShort c)
{
  PetscFunctionBegin;
  if (c->setup) PetscFunctionReturn(PETSC_SUCCESS);
  c->setup = PETSC_TRUE;
  c->active = c->p.viscosity > 0. || c->p.modulus > 0. ? PETSC_TRUE : PETSC_FALSE;
  c->gap = PETSC_INFINITY;
  if (!c->active) PetscFunctionReturn(PETSC_SUCCESS);
  c->reach = PetscMax(c->p.viscosity > 0. ? c->p.cutoff : 0., c->p.roughness);
  PetscCall(AncfGetNumBeams(c->ancf, &c->nbeams));
  PetscCall(AncfGetNumNodes(c->ancf, &c->nnodes));
  if (c->rigid) PetscCall(RigidGetNumBodies(c->rigid, &c->nbodies));
  PetscCall(PetscCalloc1(c->nbeams, &c->beam));
  for (PetscInt i = 0; i < c->nbeams; i++) PetscCall(SetUpBeam(c, i));
  PetscCall(PetscCalloc2(c->nlinks, &c->link, c->nlinks, &c->next));
  PetscCall(PetscMalloc5(6 * (size_t)c->nnodes, &c->e, 6 * (size_t)c->nnodes, &c->v, 3 * (size_t)c->nsamples, &c->x,
                         2 * (size_t)c->nnodes, &c->w, 2 * (size_t)c->nnodes, &c->z));
  PetscCall(PetscCalloc3(c->nbodies, &c->root, 6 * (size_t)c->nbodies, &c->given, 6 * (size_t)c->nbodies, &c->place));
  for (PetscInt i = 0; i < c->nbeams; i++)
    for (PetscInt k = 0; k < c->beam[i].links; k++) {
      ShortLink *l = &c->link[c->beam[i].link + k];
      l->beam = i;
      l->first = k * c->persample;
      l->n = PetscMin(c->persample, c->beam[i].samples - l->first);
    }
  PetscCall(FindJoints(c));
  PetscCall(FindAttached(c));
  if (c->njoints) qsort(c->joint, (size_t)c->njoints, sizeof(ShortJoint), CompareJoints);
  PetscCall(CheckOverlap(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleShortView(CoupleShort c, PetscViewer viewer)
{
  const ShortRange *p = &c->p;

  PetscFunctionBegin;
  if (p->viscosity == 0. && p->modulus == 0.) {
    PetscCall(PetscViewerASCIIPrintf(viewer, "Short-range forces of beams: none\n"));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(
      PetscViewerASCIIPrintf(viewer,
                             "Short-range forces of beams: viscosity %g Pa s, cutoff %g m%s, roughness %g m, modulus %g Pa, "
                             "restitution %g, couple_shortrange_samples %" PetscInt_FMT ", %" PetscInt_FMT " walls\n",
                             (double)p->viscosity, (double)p->cutoff, p->kink ? " (with kink)" : "", (double)p->roughness,
                             (double)p->modulus, (double)p->restitution, c->persample, c->nwalls));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleShortDestroy(CoupleShort *sr)
{
  CoupleShort c = *sr;

  PetscFunctionBegin;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < c->ninverses; i++) PetscCall(PetscFree(c->inverse[i].m));
  PetscCall(PetscFree(c->inverse));
  PetscCall(PetscFree(c->beam));
  PetscCall(PetscFree(c->joint));
  PetscCall(PetscFree2(c->attached, c->bodyof));
  PetscCall(PetscFree(c->head));
  PetscCall(PetscFree(c->pair));
  if (c->e) {
    PetscCall(PetscFree2(c->link, c->next));
    PetscCall(PetscFree5(c->e, c->v, c->x, c->w, c->z));
    PetscCall(PetscFree3(c->root, c->given, c->place));
  }
  PetscCall(PetscFree(*sr));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* |S_i| in the units of the scaled mass matrix: gradients times the element's length. */
static PetscReal Weight(const ShortBeam *b, const ShortPoint *p, int i)
{
  return PetscAbsReal(p->S[i]) / (i % 2 ? b->l : 1.);
}

static void Gather(CoupleShort c, const ShortPoint *p)
{
  for (int i = 0; i < 4; i++) c->w[2 * p->node + i] += Weight(&c->beam[p->beam], p, i);
}

/* Sum over all pairs of |S M^-1 S_j^T|, 1/kg. */
static PetscReal Mobility(const CoupleShort c, const ShortPoint *p)
{
  PetscReal sum = 0.;
  for (int i = 0; i < 4; i++) sum += Weight(&c->beam[p->beam], p, i) * c->z[2 * p->node + i];
  return sum;
}

/* Resistance and stiffness of every pair; what beams and bodies have to do with all of theirs together. */
static PetscErrorCode Prepare(CoupleShort c)
{
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(c->w, 2 * c->nnodes));
  PetscCall(PetscArrayzero(c->root, c->nbodies));
  c->gap = PETSC_INFINITY;
  for (PetscInt k = 0; k < c->npairs; k++) {
    ShortPair *p = &c->pair[k];
    PetscReal m = c->beam[p->a.beam].rhoA;
    if (p->body == SHORT_BEAM) m = 1. / (1. / m + 1. / c->beam[p->b.beam].rhoA);
    ShortRangeLineContact(&c->p, m, p->gap, &p->k, &p->c);
    p->k *= p->length;
    p->c = p->length * (p->c + p->factor * ShortRangeLine(&c->p, p->R, p->gap));
    c->gap = PetscMin(c->gap, p->gap);
    Gather(c, &p->a);
    if (p->body == SHORT_BEAM) Gather(c, &p->b);
    if (p->body >= 0) {
      PetscCall(RigidGetInverseMass(c->rigid, p->body, p->n, p->r, &p->root));
      p->root = PetscSqrtReal(p->root);
      c->root[p->body] += p->root;
    }
  }
  for (PetscInt i = 0; i < c->nbeams; i++) {
    const ShortBeam *b = &c->beam[i];
    const PetscInt n = 2 * b->elements + 2;
    const PetscReal *M = c->inverse[b->inverse].m, *w = c->w + 2 * b->node, scale = 1. / (b->rhoA * b->l);
    PetscReal *z = c->z + 2 * b->node;
    PetscBool any = PETSC_FALSE;
    for (PetscInt j = 0; j < n; j++) any = any || w[j] > 0. ? PETSC_TRUE : PETSC_FALSE;
    for (PetscInt j = 0; j < n && any; j++) {
      z[j] = 0.;
      for (PetscInt l = 0; l < n; l++) z[j] += scale * M[j * n + l] * w[l];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* v += sign velocity of a beam's point. */
static void AddVelocity(const CoupleShort c, const ShortPoint *p, PetscReal sign, PetscReal v[3])
{
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 3; k++) v[k] += sign * p->S[i] * c->v[6 * p->node + 3 * i + k];
}

static PetscErrorCode NormalVelocity(CoupleShort c, const ShortPair *p, PetscReal *vn)
{
  PetscReal v[3] = {0., 0., 0.}, V[3], w[3], wr[3];

  PetscFunctionBegin;
  AddVelocity(c, &p->a, 1., v);
  if (p->body == SHORT_BEAM) AddVelocity(c, &p->b, -1., v);
  if (p->body >= 0) {
    PetscCall(RigidGetState(c->rigid, p->body, NULL, NULL, V, w));
    CoupleCross(w, p->r, wr);
    for (int k = 0; k < 3; k++) v[k] -= V[k] + wr[k];
  }
  *vn = CoupleDot(v, p->n);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void AddForce(const ShortPoint *p, PetscReal f, const PetscReal n[3], PetscReal *Q)
{
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 3; k++) Q[6 * p->node + 3 * i + k] += f * p->S[i] * n[k];
}

/* The reaction on a body or a wall, and the sums for the balance of momentum. */
static PetscErrorCode React(CoupleShort c, const ShortPair *p, PetscReal f)
{
  PetscReal F[3], T[3];
  RigidBodySpec spec;

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) F[k] = -f * p->n[k];
  spec.motion = RIGID_FIXED;
  if (p->body >= 0) {
    CoupleCross(p->r, F, T);
    PetscCall(RigidAddLoad(c->rigid, p->body, F, T));
    for (int k = 0; k < 3; k++) {
      c->given[6 * p->body + k] += F[k];
      c->given[6 * p->body + 3 + k] += T[k];
    }
    PetscCall(RigidGetBody(c->rigid, p->body, &spec));
  }
  for (int k = 0; k < 3; k++) {
    if (spec.motion == RIGID_FREE)
      c->onbodies[k] += F[k];
    else
      c->onbeams[k] -= F[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleShortApply(CoupleShort c, PetscReal h)
{
  PetscReal *Q, t, tb;

  PetscFunctionBegin;
  PetscCheck(c->setup, c->comm, PETSC_ERR_ORDER, "CoupleShortSetUp() must come before CoupleShortApply()");
  PetscCheck(h > 0. && !PetscIsInfOrNanReal(h), c->comm, PETSC_ERR_ARG_OUTOFRANGE, "CoupleShortApply(): h = %g s must be > 0",
             (double)h);
  if (!c->active) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AncfGetState(c->ancf, &t, NULL, NULL, NULL));
  if (c->rigid) {
    PetscCall(RigidGetTime(c->rigid, &tb));
    PetscCheck(PetscAbsReal(t - tb) <= 1.e-6 * h, c->comm, PETSC_ERR_ORDER,
               "CoupleShortApply(): the beams stand at t = %g s, the bodies at %g s", (double)t, (double)tb);
  }
  c->half = .5 * h;
  PetscCall(CoupleShortFindPairs(c));
  PetscCall(Prepare(c));
  PetscCall(CoupleShortStart(c, t, h));
  PetscCall(AncfGetLoads(c->ancf, &Q));
  PetscCall(PetscArrayzero(c->onbeams, 3));
  PetscCall(PetscArrayzero(c->onbodies, 3));
  PetscCall(PetscArrayzero(c->given, 6 * c->nbodies));
  for (PetscInt k = 0; k < c->npairs; k++) {
    ShortPair *p = &c->pair[k];
    PetscReal vn = 0., f, G = Mobility(c, &p->a);
    if (p->body == SHORT_BEAM) G += Mobility(c, &p->b);
    if (p->body >= 0) G += p->root * c->root[p->body];
    PetscCall(NormalVelocity(c, p, &vn));
    p->elastic = p->k * (c->p.roughness - p->gap) / (1. + .5 * h * h * p->k * G);
    p->heat = -p->c * vn / (1. + h * p->c * G);
    f = p->elastic + p->heat;
    AddForce(&p->a, f, p->n, Q);
    if (p->body == SHORT_BEAM)
      AddForce(&p->b, -f, p->n, Q);
    else
      PetscCall(React(c, p, f));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleShortRemove(CoupleShort c)
{
  PetscFunctionBegin;
  PetscCall(CoupleShortAccount(c));
  for (PetscInt i = 0; i < c->nbodies; i++) {
    PetscReal *g = c->given + 6 * i;
    if (g[0] == 0. && g[1] == 0. && g[2] == 0. && g[3] == 0. && g[4] == 0. && g[5] == 0.) continue;
    for (int k = 0; k < 6; k++) g[k] = -g[k];
    PetscCall(RigidAddLoad(c->rigid, i, g, g + 3));
    PetscCall(PetscArrayzero(g, 6));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleShortGetForces(CoupleShort c, PetscInt *contacts, PetscReal *gap, PetscReal held[3], PetscReal bodies[3])
{
  PetscFunctionBegin;
  if (contacts) *contacts = c->contacts;
  if (gap) *gap = c->gap;
  if (held) PetscCall(PetscArraycpy(held, c->onbeams, 3));
  if (bodies) PetscCall(PetscArraycpy(bodies, c->onbodies, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}
