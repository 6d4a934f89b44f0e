/*
  couplebeam.c - adapter of an ANCF beam: disks of BCE markers along the axis (Sect. 2.4, Fig. 2b), S^T projection of their forces
  (Eq. 23). A beam is a host (couplehost.c) whose nodes are the vector coordinates r_j, r_j,x; its sections are the disks.
*/
#include "couplehost.h"
#include "coupleimpl.h"

typedef struct {
  Ancf ancf;
  PetscInt beam, node0, elements, ndisk;
  PetscReal l, rhoA;        /* element length, m; mass per length, kg/m */
  PetscReal *load;          /* this beam's of AncfGetLoads() */
  PetscReal reaction[2][3]; /* of all supports at the ends of the last step, N; beam 0 only */
} Beam;

static PetscErrorCode GetState_Beam(void *ctx, PetscReal *t, const PetscReal **q, const PetscReal **qdot, const PetscReal **qddot)
{
  const Beam *b = (const Beam *)ctx;
  const PetscInt o = 6 * b->node0;

  PetscFunctionBegin;
  PetscCall(AncfGetState(b->ancf, t, q, qdot, qddot));
  if (q) *q += o;
  if (qdot) *qdot += o;
  if (qddot) *qddot += o;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetLoads_Beam(void *ctx, PetscReal **Q)
{
  Beam *b = (Beam *)ctx;

  PetscFunctionBegin;
  PetscCall(AncfGetLoads(b->ancf, Q));
  *Q += 6 * b->node0;
  b->load = *Q;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ChangeLoads_Beam(void *ctx, const PetscReal *dQ)
{
  Beam *b = (Beam *)ctx;
  PetscReal *end;

  PetscFunctionBegin;
  PetscCall(AncfGetLoadsEnd(b->ancf, &end));
  end += 6 * b->node0;
  for (PetscInt i = 0; i < 6 * (b->elements + 1); i++) {
    b->load[i] -= 0.5 * dQ[i];
    end[i] += 0.5 * dQ[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first beam's call advances all of them. */
static PetscErrorCode Advance_Beam(void *ctx, PetscReal t, const PetscReal *Q)
{
  Beam *b = (Beam *)ctx;
  PetscReal now;

  PetscFunctionBegin;
  (void)Q;
  PetscCall(AncfGetState(b->ancf, &now, NULL, NULL, NULL));
  if (now < t) PetscCall(AncfAdvance(b->ancf, t));
  if (b->beam == 0) {
    PetscCall(PetscArraycpy(b->reaction[0], b->reaction[1], 3));
    PetscCall(AncfGetReaction(b->ancf, b->reaction[1]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Momentum of this beam: the integral of rhoA S e'. Weight and supports are known for all beams together; beam 0 answers for
 * them. */
static PetscErrorCode Momentum_Beam(void *ctx, PetscReal p[3], PetscReal weight[3], PetscReal support[3])
{
  const Beam *b = (const Beam *)ctx;
  const PetscReal *v, m = b->rhoA * b->l;

  PetscFunctionBegin;
  PetscCall(AncfGetState(b->ancf, NULL, NULL, &v, NULL));
  v += 6 * b->node0;
  for (int k = 0; k < 3; k++) p[k] = weight[k] = support[k] = 0.0;
  for (PetscInt j = 0; j < b->elements; j++, v += 6)
    for (int k = 0; k < 3; k++) p[k] += m * (0.5 * (v[k] + v[6 + k]) + b->l / 12.0 * (v[3 + k] - v[9 + k]));
  if (b->beam == 0) {
    PetscCall(AncfGetWeight(b->ancf, weight));
    for (int k = 0; k < 3; k++) support[k] = 0.5 * (b->reaction[0][k] + b->reaction[1][k]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* State of all beams together, saved by beam 0: supports (6), what AncfPack() gives. */
#define BEAM_HEAD 6
static PetscErrorCode StateSize_Beam(void *ctx, PetscInt *n)
{
  const Beam *b = (const Beam *)ctx;

  PetscFunctionBegin;
  *n = 0;
  if (b->beam) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AncfGetPackSize(b->ancf, n));
  *n += BEAM_HEAD;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Load_Beam(void *ctx, const PetscReal *state)
{
  Beam *b = (Beam *)ctx;

  PetscFunctionBegin;
  if (b->beam) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 6; k++) b->reaction[k / 3][k % 3] = state[k];
  PetscCall(AncfUnpack(b->ancf, state + BEAM_HEAD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Save_Beam(void *ctx, PetscReal *state)
{
  const Beam *b = (const Beam *)ctx;

  PetscFunctionBegin;
  if (b->beam) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 6; k++) state[k] = b->reaction[k / 3][k % 3];
  PetscCall(AncfPack(b->ancf, state + BEAM_HEAD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode View_Beam(void *ctx, PetscViewer viewer)
{
  const Beam *b = (const Beam *)ctx;

  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "  beam %" PetscInt_FMT ": %" PetscInt_FMT " elements, %" PetscInt_FMT " disks\n",
                                   b->beam, b->elements, b->ndisk));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy_Beam(void *ctx)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(ctx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  PetscInt n;
  PetscReal o1[512], o2[512], area[512], depth[512], turn[512]; /* turn: half the angle between markers of the ring */
} Section;

static void SectionAdd(Section *c, PetscReal o1, PetscReal o2, PetscReal area, PetscReal depth, PetscReal turn)
{
  if (c->n == 512) return;
  c->turn[c->n] = turn;
  c->o1[c->n] = o1;
  c->o2[c->n] = o2;
  c->area[c->n] = area;
  c->depth[c->n++] = depth;
}

/*
  Markers of one disk of radius R: rings in layers dp thick from the surface inwards, evenly spaced about dp apart, and one in the
  middle of a core of radius up to 3dp/4. Areas add up to the marked area. In 2D: a line across the thickness 2R, layers from both
  sides.
*/
static void SectionFill(PetscInt dim, PetscReal R, PetscReal dp, PetscReal depthmax, Section *c)
{
  PetscReal out = R;

  c->n = 0;
  for (; out > 1e-6 * dp && R - out < depthmax; out -= dp) {
    const PetscBool core = out <= 0.75 * dp ? PETSC_TRUE : PETSC_FALSE;
    const PetscReal in = core ? 0.0 : PetscMax(out - dp, 0.0), r = core ? 0.0 : 0.5 * (out + in);
    const PetscReal area = dim == 2 ? 2.0 * (out - in) : PETSC_PI * (out * out - in * in);
    const PetscInt n = core ? 1 : (dim == 2 ? 2 : PetscMax(3, (PetscInt)(2.0 * PETSC_PI * r / dp + 0.5)));
    for (PetscInt i = 0; i < n; i++) {
      const PetscReal a = 2.0 * PETSC_PI * (PetscReal)i / (PetscReal)n;
      SectionAdd(c, r * PetscCosReal(a), dim == 2 ? 0.0 : r * PetscSinReal(a), area / (PetscReal)n, R - r,
                 dim == 3 ? PETSC_PI / (PetscReal)n : 0.0);
    }
  }
}

/* Arrays of a CoupleHostSpec. */
typedef struct {
  PetscInt *rowstart, *node, *section;
  PetscBool *direction;
  PetscReal *shape, *slope, *offset, *volume, *depth;
} Rows;

/* Disk d at arc coordinate s: its element's four vector coordinates and their weights, Eq. 19. */
static void PlaceDisk(const Beam *b, PetscInt d, PetscReal s, Rows *r)
{
  const PetscInt element = PetscMin((PetscInt)(s / b->l), b->elements - 1);
  const PetscReal xi = s / b->l - (PetscReal)element;

  AncfShape(xi, b->l, r->shape + 4 * d);
  AncfShapeX(xi, b->l, r->slope + 4 * d);
  for (PetscInt j = 0; j < 4; j++) r->node[4 * d + j] = 2 * element + j;
  r->rowstart[d + 1] = 4 * (d + 1);
}

/* Disks at (k + 1/2) L/ndisk; every other one turned by half a marker, so that the markers of neighbours interleave. */
static void PlaceMarkers(const Beam *b, const AncfBeamSpec *spec, const Section *c, Rows *r)
{
  const PetscReal L = b->l * (PetscReal)b->elements, ds = L / (PetscReal)b->ndisk;
  PetscInt i = 0;

  for (PetscInt j = 0; j < 2 * (b->elements + 1); j++) r->direction[j] = j % 2 ? PETSC_TRUE : PETSC_FALSE;
  r->rowstart[0] = 0;
  for (PetscInt d = 0; d < b->ndisk; d++) {
    const PetscReal s = ((PetscReal)d + 0.5) * ds,
                    ends = PetscMin(spec->end0 == ANCF_END_FREE ? s : L, spec->end1 == ANCF_END_FREE ? L - s : L);
    PlaceDisk(b, d, s, r);
    for (PetscInt j = 0; j < c->n; j++, i++) {
      const PetscReal turn = d % 2 ? c->turn[j] : 0.0;
      r->section[i] = d;
      r->offset[2 * i] = c->o1[j] * PetscCosReal(turn) - c->o2[j] * PetscSinReal(turn);
      r->offset[2 * i + 1] = c->o1[j] * PetscSinReal(turn) + c->o2[j] * PetscCosReal(turn);
      r->volume[i] = c->area[j] * ds;
      r->depth[i] = PetscMin(c->depth[j], ends);
    }
  }
}

static PetscErrorCode CreateSurface(Beam *b, const AncfBeamSpec *spec, PetscInt dim, const Section *c, CoupleSurface *surface)
{
  const CoupleHostOps ops = {.getstate = GetState_Beam,
                             .getloads = GetLoads_Beam,
                             .advance = Advance_Beam,
                             .momentum = Momentum_Beam,
                             .statesize = StateSize_Beam,
                             .save = Save_Beam,
                             .load = Load_Beam,
                             .view = View_Beam,
                             .destroy = Destroy_Beam,
                             .changeloads = ChangeLoads_Beam};
  const PetscInt nd = b->ndisk, n = nd * c->n, nn = 2 * (b->elements + 1);
  CoupleHostSpec host;
  Rows r;
  char name[64];

  PetscFunctionBegin;
  PetscCall(PetscMalloc4(nd + 1, &r.rowstart, 4 * (size_t)nd, &r.node, n, &r.section, nn, &r.direction));
  PetscCall(
      PetscMalloc5(4 * (size_t)nd, &r.shape, 4 * (size_t)nd, &r.slope, 2 * (size_t)n, &r.offset, n, &r.volume, n, &r.depth));
  PlaceMarkers(b, spec, c, &r);
  host =
      (CoupleHostSpec){dim, nn, r.direction, nd, r.rowstart, r.node, r.shape, r.slope, n, r.section, r.offset, r.volume, r.depth};
  PetscCall(PetscSNPrintf(name, sizeof(name), "beam_%" PetscInt_FMT, b->beam));
  PetscCall(CoupleSurfaceCreateHost(PETSC_COMM_SELF, name, &host, &ops, b, surface));
  PetscCall(CoupleHostShare(*surface));
  PetscCall(PetscFree4(r.rowstart, r.node, r.section, r.direction));
  PetscCall(PetscFree5(r.shape, r.slope, r.offset, r.volume, r.depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CoupleSurfaceCreateBeam - Surface of beam `beam` of ancf (set up before): disks about dp apart, marked to depthmax (m) below the
surface.

  Errors: a diameter below dp cannot be marked: not even one marker of the fluid's volume fits across the beam.
@*/
PetscErrorCode CoupleSurfaceCreateBeam(Ancf ancf, PetscInt beam, PetscInt dim, PetscReal dp, PetscReal depthmax,
                                       CoupleSurface *surface)
{
  AncfBeamSpec spec;
  Section *c;
  Beam *b;

  PetscFunctionBegin;
  PetscCall(PetscNew(&b));
  PetscCall(PetscNew(&c));
  b->ancf = ancf;
  b->beam = beam;
  PetscCall(AncfGetBeam(ancf, beam, &spec, &b->node0, &b->l));
  b->elements = spec.elements;
  b->rhoA = spec.rhoA >= 0.0 ? spec.rhoA : spec.density * PETSC_PI * 0.25 * spec.diameter * spec.diameter;
  PetscCheck(spec.diameter >= dp * (1.0 - 1e-9), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "beam %" PetscInt_FMT ": diameter = %g m is thinner than the marker spacing sph_dp = %g m: a beam needs at least "
             "one marker across; use sph_dp <= %g",
             beam, (double)spec.diameter, (double)dp, (double)spec.diameter);
  SectionFill(dim, 0.5 * spec.diameter, dp, depthmax, c);
  PetscCheck(c->n < 512, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "beam %" PetscInt_FMT ": diameter = %g m needs more than 511 markers per disk at sph_dp = %g m", beam,
             (double)spec.diameter, (double)dp);
  b->ndisk = PetscMax(1, (PetscInt)(b->l * (PetscReal)b->elements / dp + 0.5));
  if (beam == 0) PetscCall(AncfGetReaction(ancf, b->reaction[1]));
  PetscCall(CreateSurface(b, &spec, dim, c, surface));
  PetscCall(PetscFree(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}
