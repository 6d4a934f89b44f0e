/*
  couplehost.c - structures given by nodes and shape functions: motion of BCE markers on them, and the transposed transfer of
  forces.

  The equations are those of sectionmath.h. Beams of ANCF are a case of this (couplebeam.c).
*/
#include "couplehost.h"
#include "coupleimpl.h"
#include "sectionmath.h"

typedef struct {
  CoupleHostOps ops;
  void *ctx;
  PetscInt dim, nnodes, nsections, n;
  PetscInt *rowstart, *node, *section;
  PetscBool *direction;
  PetscReal *shape, *slope; /* slope: NULL without */
  PetscReal *offset, *x0, *volume, *depth;
  PetscReal *d1;         /* per section with slopes: transported unit normal at the structure's own time, 3 */
  PetscReal *Q;          /* of this surface alone: the host's when it has no array for it */
  PetscReal *loads, *dQ; /* the host's array; change of Q over the step */
  /* of the last kinematics call */
  PetscReal *q, *qdot; /* nodes, nnodes x 3 */
  FrondSection *frame; /* per section */
  PetscReal *o;        /* per marker: offset (3) */
  PetscReal *offset3;  /* the same in the frame, for a link; NULL without */
  int *inode;          /* node, as int */
} Host;

/* The nodes extrapolated by dt: q, q', and (the host's array) q''. */
static PetscErrorCode Extrapolate(Host *h, PetscReal dt, const PetscReal **qddot)
{
  const PetscReal *q, *v, *a;

  PetscFunctionBegin;
  PetscCall((*h->ops.getstate)(h->ctx, NULL, &q, &v, &a));
  for (PetscInt i = 0; i < 3 * h->nnodes; i++) {
    h->q[i] = q[i] + dt * (v[i] + 0.5 * dt * a[i]);
    h->qdot[i] = v[i] + dt * a[i];
  }
  *qddot = a;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void MoveSection(Host *h, PetscInt s, const PetscReal *qddot)
{
  const PetscInt e = h->rowstart[s];

  section_from_nodes((int)h->dim, (int)(h->rowstart[s + 1] - e), h->inode + e, h->shape + e, h->slope ? h->slope + e : NULL, h->q,
                     h->qdot, qddot, h->d1 + 3 * s, &h->frame[s]);
}

static PetscErrorCode Kinematics_Host(CoupleSurface surface, PetscReal dt, PetscReal *x, PetscReal *v, PetscReal *a)
{
  Host *h = (Host *)surface->ctx;
  const PetscReal *qddot;
  PetscInt i = 0;

  PetscFunctionBegin;
  PetscCall(Extrapolate(h, dt, &qddot));
  for (PetscInt s = 0; s < h->nsections; s++) {
    MoveSection(h, s, qddot);
    for (; i < h->n && h->section[i] == s; i++) {
      const PetscReal c[3] = {h->offset[2 * i], h->offset[2 * i + 1], 0.0};
      section_offset(&h->frame[s], c, h->o + 3 * i);
      section_marker(&h->frame[s], h->o + 3 * i, x + 3 * i, v + 3 * i, a + 3 * i);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Rotation_Host(CoupleSurface surface, PetscReal *omega)
{
  const Host *h = (const Host *)surface->ctx;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < h->n; i++) PetscCall(PetscArraycpy(omega + 3 * i, h->frame[h->section[i]].w, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetMarkers_Host(CoupleSurface surface, PetscInt *n, const PetscReal **x, const PetscReal **volume,
                                      const PetscReal **depth)
{
  const Host *h = (const Host *)surface->ctx;

  PetscFunctionBegin;
  *n = h->n;
  *x = h->x0;
  *volume = h->volume;
  *depth = h->depth;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetLoads(Host *h, PetscReal **Q)
{
  PetscFunctionBegin;
  *Q = h->Q;
  if (h->ops.getloads) PetscCall((*h->ops.getloads)(h->ctx, Q));
  h->loads = *Q;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ZeroLoads_Host(CoupleSurface surface)
{
  Host *h = (Host *)surface->ctx;
  PetscReal *Q;

  PetscFunctionBegin;
  PetscCall(GetLoads(h, &Q));
  PetscCall(PetscArrayzero(Q, 3 * h->nnodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the generalised forces added amount to: force, moment about the origin, power; subtracted from the marker totals. */
static void Audit(const Host *h, const PetscReal *Q, const PetscReal axial[3], CoupleAudit *audit)
{
  PetscReal F[3] = {0, 0, 0}, M[3] = {axial[0], axial[1], axial[2]}, power = 0.0;

  for (PetscInt j = 0; j < h->nnodes; j++) {
    PetscReal c[3];
    CoupleCross(h->q + 3 * j, Q + 3 * j, c);
    for (int k = 0; k < 3; k++) {
      if (!h->direction[j]) F[k] += Q[3 * j + k];
      M[k] += c[k];
      power += Q[3 * j + k] * h->qdot[3 * j + k];
    }
  }
  for (int k = 0; k < 3; k++) {
    audit->force_lost[k] = audit->force[k] - F[k];
    audit->moment_lost[k] = audit->moment[k] - M[k];
  }
  audit->power_lost = audit->power - power;
}

/* The forces in h->Q, to the host; axial: the torque that they leave out. */
static PetscErrorCode GiveLoads(Host *h, const PetscReal axial[3], CoupleAudit *audit)
{
  PetscReal *Q;

  PetscFunctionBegin;
  Audit(h, h->Q, axial, audit);
  Q = h->loads; /* as zeroloads got it */
  if (!Q) PetscCall(GetLoads(h, &Q));
  if (Q != h->Q)
    for (PetscInt j = 0; j < 3 * h->nnodes; j++) Q[j] += h->Q[j];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Q = S^T f, and totals over the sections. */
static PetscErrorCode Gather(const Host *h, const PetscReal *f, PetscReal *Q, PetscReal totals[SECTION_TOTALS])
{
  PetscInt i = 0;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(Q, 3 * h->nnodes));
  for (PetscInt s = 0; s < h->nsections; s++) {
    PetscReal sums[SECTION_SUMS] = {0.0};
    for (; i < h->n && h->section[i] == s; i++) section_add_force(h->o + 3 * i, f + 3 * i, sums);
    for (PetscInt e = h->rowstart[s]; e < h->rowstart[s + 1]; e++)
      section_add_node(&h->frame[s], h->shape[e], h->slope ? h->slope[e] : 0.0, sums, sums + 3, Q + 3 * h->node[e]);
    section_add_totals(&h->frame[s], sums, totals);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ApplyForces_Host(CoupleSurface surface, const PetscReal *f, CoupleAudit *audit)
{
  Host *h = (Host *)surface->ctx;
  PetscReal totals[SECTION_TOTALS] = {0.0};

  PetscFunctionBegin;
  PetscCall(Gather(h, f, h->Q, totals));
  audit->twist += totals[7];
  PetscCall(GiveLoads(h, totals + 8, audit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ChangeForces_Host(CoupleSurface surface, const PetscReal *df)
{
  Host *h = (Host *)surface->ctx;
  PetscReal totals[SECTION_TOTALS] = {0.0};

  PetscFunctionBegin;
  PetscCall(Gather(h, df, h->dQ, totals));
  PetscCall((*h->ops.changeloads)(h->ctx, h->dQ));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How the markers hang on the nodes, for fluids that move them by themselves. */
static PetscErrorCode GetLink_Host(CoupleSurface surface, SphLinkSpec *spec)
{
  Host *h = (Host *)surface->ctx;

  PetscFunctionBegin;
  if (!h->offset3) {
    PetscCall(PetscCalloc1(3 * (size_t)h->n, &h->offset3));
    for (PetscInt i = 0; i < h->n; i++)
      for (int k = 0; k < 2; k++) h->offset3[3 * i + k] = h->offset[2 * i + k];
  }
  *spec = (SphLinkSpec){h->nnodes, h->nsections, h->rowstart, h->node, h->shape, h->slope, h->section, h->offset3};
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LinkState_Host(CoupleSurface surface, PetscReal dt, PetscReal *state)
{
  Host *h = (Host *)surface->ctx;
  const PetscInt n = 3 * h->nnodes;
  const PetscReal *qddot;

  PetscFunctionBegin;
  PetscCall(Extrapolate(h, dt, &qddot));
  PetscCall(PetscArraycpy(state, h->q, n));
  PetscCall(PetscArraycpy(state + n, h->qdot, n));
  PetscCall(PetscArraycpy(state + 2 * n, qddot, n));
  if (h->slope) PetscCall(PetscArraycpy(state + 3 * n, h->d1, 3 * h->nsections));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ApplyLoads_Host(CoupleSurface surface, const PetscReal *load, const SphLinkTotals *totals,
                                      CoupleAudit *audit)
{
  Host *h = (Host *)surface->ctx;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(h->Q, load, 3 * h->nnodes));
  audit->twist += totals->twist;
  PetscCall(GiveLoads(h, totals->axial, audit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The normals of the sections carried along to the structure's present state. */
static PetscErrorCode CarryNormals(CoupleSurface surface)
{
  Host *h = (Host *)surface->ctx;
  const PetscReal *q, *v;

  PetscFunctionBegin;
  if (!h->slope) PetscFunctionReturn(PETSC_SUCCESS);
  /* The tangents need no accelerations, which a structure may have to compute for all its bodies: velocities in their place. */
  PetscCall((*h->ops.getstate)(h->ctx, NULL, &q, &v, NULL));
  PetscCall(PetscArraycpy(h->q, q, 3 * h->nnodes));
  PetscCall(PetscArraycpy(h->qdot, v, 3 * h->nnodes));
  for (PetscInt s = 0; s < h->nsections; s++) {
    MoveSection(h, s, v);
    PetscCall(PetscArraycpy(h->d1 + 3 * s, h->frame[s].e1, 3));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A host whose state is current serves several threads. */
static PetscErrorCode Prepare_Host(CoupleSurface surface)
{
  const Host *h = (const Host *)surface->ctx;
  const PetscReal *q, *v, *a;

  PetscFunctionBegin;
  PetscCall((*h->ops.getstate)(h->ctx, NULL, &q, &v, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Advance_Host(CoupleSurface surface, PetscReal t)
{
  Host *h = (Host *)surface->ctx;
  PetscReal *Q = h->loads, now;

  PetscFunctionBegin;
  if (!Q) PetscCall(GetLoads(h, &Q));
  PetscCall((*h->ops.advance)(h->ctx, t, Q));
  PetscCall((*h->ops.getstate)(h->ctx, &now, NULL, NULL, NULL));
  PetscCheck(PetscAbsReal(now - t) <= 1e-12 * PetscMax(1.0, PetscAbsReal(t)), surface->comm, PETSC_ERR_USER,
             "surface %s: the host advanced to t = %.15g s when asked for %.15g s", surface->name, (double)now, (double)t);
  if (!surface->unsettled) PetscCall(CarryNormals(surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Momentum_Host(CoupleSurface surface, PetscReal p[3], PetscReal weight[3], PetscReal support[3])
{
  const Host *h = (const Host *)surface->ctx;

  PetscFunctionBegin;
  PetscCall((*h->ops.momentum)(h->ctx, p, weight, support));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode StateSize_Host(CoupleSurface surface, PetscInt *n)
{
  const Host *h = (const Host *)surface->ctx;

  PetscFunctionBegin;
  PetscCall((*h->ops.statesize)(h->ctx, n));
  if (h->slope) *n += 3 * h->nsections;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Save_Host(CoupleSurface surface, PetscReal *state)
{
  const Host *h = (const Host *)surface->ctx;

  PetscFunctionBegin;
  if (h->slope) {
    PetscCall(PetscArraycpy(state, h->d1, 3 * h->nsections));
    state += 3 * h->nsections;
  }
  PetscCall((*h->ops.save)(h->ctx, state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Load_Host(CoupleSurface surface, const PetscReal *state)
{
  Host *h = (Host *)surface->ctx;

  PetscFunctionBegin;
  if (h->slope) {
    PetscCall(PetscArraycpy(h->d1, state, 3 * h->nsections));
    state += 3 * h->nsections;
  }
  PetscCall((*h->ops.load)(h->ctx, state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode View_Host(CoupleSurface surface, PetscViewer viewer)
{
  const Host *h = (const Host *)surface->ctx;

  PetscFunctionBegin;
  if (h->ops.view)
    PetscCall((*h->ops.view)(h->ctx, viewer));
  else
    PetscCall(PetscViewerASCIIPrintf(
        viewer, "  host %s: %" PetscInt_FMT " nodes, %" PetscInt_FMT " sections, %" PetscInt_FMT " markers\n", surface->name,
        h->nnodes, h->nsections, h->n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy_Host(CoupleSurface surface)
{
  Host *h = (Host *)surface->ctx;

  PetscFunctionBegin;
  if (h->ops.destroy) PetscCall((*h->ops.destroy)(h->ctx));
  PetscCall(PetscFree4(h->rowstart, h->node, h->section, h->direction));
  PetscCall(PetscFree(h->shape));
  PetscCall(PetscFree(h->slope));
  PetscCall(PetscFree4(h->offset, h->x0, h->volume, h->depth));
  PetscCall(PetscFree5(h->d1, h->Q, h->dQ, h->q, h->qdot));
  PetscCall(PetscFree3(h->frame, h->o, h->inode));
  PetscCall(PetscFree(h->offset3));
  PetscCall(PetscFree(surface->ctx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Numbers in range, sums of shape functions. */
static PetscErrorCode CheckRows(MPI_Comm comm, const char name[], const CoupleHostSpec *p)
{
  PetscFunctionBegin;
  PetscCheck(p->dim == 2 || p->dim == 3, comm, PETSC_ERR_ARG_OUTOFRANGE, "surface %s: dim = %" PetscInt_FMT " must be 2 or 3",
             name, p->dim);
  PetscCheck(p->nnodes > 0 && p->nsections > 0 && p->nmarkers > 0, comm, PETSC_ERR_ARG_OUTOFRANGE,
             "surface %s: nnodes = %" PetscInt_FMT ", nsections = %" PetscInt_FMT ", nmarkers = %" PetscInt_FMT
             " must all be > 0",
             name, p->nnodes, p->nsections, p->nmarkers);
  for (PetscInt s = 0; s < p->nsections; s++) {
    PetscReal one = 0.0, zero = 0.0, size = 1.0;
    PetscCheck(p->rowstart[s + 1] > p->rowstart[s] && p->rowstart[0] == 0, comm, PETSC_ERR_ARG_OUTOFRANGE,
               "surface %s: rowstart must begin with 0 and rise; it does not at section %" PetscInt_FMT, name, s);
    for (PetscInt e = p->rowstart[s]; e < p->rowstart[s + 1]; e++) {
      PetscCheck(p->node[e] >= 0 && p->node[e] < p->nnodes, comm, PETSC_ERR_ARG_OUTOFRANGE,
                 "surface %s, section %" PetscInt_FMT ": node %" PetscInt_FMT " must be in [0, %" PetscInt_FMT ")", name, s,
                 p->node[e], p->nnodes);
      if (p->direction && p->direction[p->node[e]]) continue;
      one += p->shape[e];
      if (!p->slope) continue;
      zero += p->slope[e];
      size += PetscAbsReal(p->slope[e]);
    }
    PetscCheck(PetscAbsReal(one - 1.0) <= 1e-10, comm, PETSC_ERR_ARG_INCOMP,
               "surface %s, section %" PetscInt_FMT ": shape functions of the position nodes add up to %.12g; must be 1", name, s,
               (double)one);
    PetscCheck(PetscAbsReal(zero) <= 1e-10 * size, comm, PETSC_ERR_ARG_INCOMP,
               "surface %s, section %" PetscInt_FMT ": slopes of the position nodes add up to %.12g; must be 0", name, s,
               (double)zero);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckMarkers(MPI_Comm comm, const char name[], const CoupleHostSpec *p)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->nmarkers; i++) {
    PetscCheck(p->section[i] >= (i ? p->section[i - 1] : 0) && p->section[i] < p->nsections, comm, PETSC_ERR_ARG_OUTOFRANGE,
               "surface %s, marker %" PetscInt_FMT ": section %" PetscInt_FMT " must be in [0, %" PetscInt_FMT ") and ascend",
               name, i, p->section[i], p->nsections);
    PetscCheck(p->slope || !p->offset || (p->offset[2 * i] == 0.0 && p->offset[2 * i + 1] == 0.0), comm, PETSC_ERR_ARG_INCOMP,
               "surface %s, marker %" PetscInt_FMT ": offset (%g, %g) m needs slopes; without them it must be 0", name, i,
               (double)p->offset[2 * i], (double)p->offset[2 * i + 1]);
    PetscCheck(p->volume[i] > 0.0 && !PetscIsInfOrNanReal(p->volume[i]), comm, PETSC_ERR_ARG_OUTOFRANGE,
               "surface %s, marker %" PetscInt_FMT ": volume = %g must be > 0", name, i, (double)p->volume[i]);
    PetscCheck(p->depth[i] >= 0.0 && !PetscIsInfOrNanReal(p->depth[i]), comm, PETSC_ERR_ARG_OUTOFRANGE,
               "surface %s, marker %" PetscInt_FMT ": depth = %g m must be >= 0", name, i, (double)p->depth[i]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CopySpec(Host *h, const CoupleHostSpec *p)
{
  const PetscInt ne = p->rowstart[p->nsections], ns = p->nsections, n = p->nmarkers, nn = p->nnodes;

  PetscFunctionBegin;
  h->dim = p->dim;
  h->nnodes = nn;
  h->nsections = ns;
  h->n = n;
  PetscCall(PetscCalloc4(ns + 1, &h->rowstart, ne, &h->node, n, &h->section, nn, &h->direction));
  PetscCall(PetscMalloc1(ne, &h->shape));
  if (p->slope) PetscCall(PetscMalloc1(ne, &h->slope));
  PetscCall(PetscCalloc4(2 * (size_t)n, &h->offset, 3 * (size_t)n, &h->x0, n, &h->volume, n, &h->depth));
  PetscCall(PetscCalloc5(3 * (size_t)ns, &h->d1, 3 * (size_t)nn, &h->Q, 3 * (size_t)nn, &h->dQ, 3 * (size_t)nn, &h->q,
                         3 * (size_t)nn, &h->qdot));
  PetscCall(PetscCalloc3(ns, &h->frame, 3 * (size_t)n, &h->o, ne, &h->inode));
  PetscCall(PetscArraycpy(h->rowstart, p->rowstart, ns + 1));
  PetscCall(PetscArraycpy(h->node, p->node, ne));
  for (PetscInt e = 0; e < ne; e++) h->inode[e] = (int)p->node[e];
  PetscCall(PetscArraycpy(h->shape, p->shape, ne));
  PetscCall(PetscArraycpy(h->section, p->section, n));
  PetscCall(PetscArraycpy(h->volume, p->volume, n));
  PetscCall(PetscArraycpy(h->depth, p->depth, n));
  if (p->direction) PetscCall(PetscArraycpy(h->direction, p->direction, nn));
  if (p->slope) PetscCall(PetscArraycpy(h->slope, p->slope, ne));
  if (p->offset) PetscCall(PetscArraycpy(h->offset, p->offset, 2 * n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A unit vector normal to t, along the coordinate axis least aligned with it. */
static void AnyNormal(const PetscReal t[3], PetscReal d1[3])
{
  int m = 0;
  for (int k = 1; k < 3; k++)
    if (PetscAbsReal(t[k]) < PetscAbsReal(t[m])) m = k;
  for (int k = 0; k < 3; k++) d1[k] = (k == m ? 1.0 : 0.0) - t[m] * t[k];
  const PetscReal n = PetscSqrtReal(CoupleDot(d1, d1));
  for (int k = 0; k < 3; k++) d1[k] /= n;
}

/* First normals, and the markers' rest positions. */
static PetscErrorCode PlaceMarkers(CoupleSurface surface)
{
  Host *h = (Host *)surface->ctx;
  const PetscReal *qddot;
  PetscReal *v, *a;

  PetscFunctionBegin;
  PetscCall(Extrapolate(h, 0.0, &qddot));
  for (PetscInt s = 0; s < h->nsections && h->slope; s++) {
    MoveSection(h, s, qddot);
    PetscCheck(h->frame[s].len > 0.0 && !PetscIsInfOrNanReal(h->frame[s].len), surface->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "surface %s, section %" PetscInt_FMT ": the tangent has the length %g; must be > 0", surface->name, s,
               (double)h->frame[s].len);
    AnyNormal(h->frame[s].t, h->d1 + 3 * s);
    section_transport((int)h->dim, h->frame[s].t, h->d1 + 3 * s);
  }
  PetscCall(PetscMalloc2(3 * (size_t)h->n, &v, 3 * (size_t)h->n, &a));
  PetscCall(Kinematics_Host(surface, 0.0, h->x0, v, a));
  PetscCall(PetscFree2(v, a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleHostShare(CoupleSurface surface)
{
  PetscFunctionBegin;
  surface->prepare = Prepare_Host;
  surface->settle = CarryNormals;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleSurfaceCreateHost(MPI_Comm comm, const char name[], const CoupleHostSpec *spec, const CoupleHostOps *ops,
                                       void *ctx, CoupleSurface *surface)
{
  CoupleSurfaceOps sops = {.getmarkers = GetMarkers_Host,
                           .kinematics = Kinematics_Host,
                           .rotation = Rotation_Host,
                           .zeroloads = ZeroLoads_Host,
                           .applyforces = ApplyForces_Host,
                           .advance = Advance_Host,
                           .getlink = GetLink_Host,
                           .linkstate = LinkState_Host,
                           .applyloads = ApplyLoads_Host,
                           .view = View_Host,
                           .destroy = Destroy_Host};
  Host *h;

  PetscFunctionBegin;
  PetscCheck(ops->getstate && ops->advance, comm, PETSC_ERR_ARG_NULL, "surface %s: getstate and advance must be given", name);
  PetscCheck(!ops->statesize == !ops->save && !ops->save == !ops->load, comm, PETSC_ERR_ARG_NULL,
             "surface %s: statesize, save and load must be given together or not at all", name);
  PetscCall(CheckRows(comm, name, spec));
  PetscCall(CheckMarkers(comm, name, spec));
  if (ops->momentum) sops.momentum = Momentum_Host;
  if (ops->changeloads) sops.changeforces = ChangeForces_Host;
  if (ops->statesize) {
    sops.statesize = StateSize_Host;
    sops.save = Save_Host;
    sops.load = Load_Host;
  }
  PetscCall(PetscNew(&h));
  h->ops = *ops;
  h->ctx = ctx;
  PetscCall(CopySpec(h, spec));
  PetscCall(CoupleSurfaceCreate(comm, name, &sops, h, surface));
  PetscCall(PlaceMarkers(*surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckHost(CoupleSurface surface)
{
  PetscFunctionBegin;
  PetscCheck(surface->ops.kinematics == Kinematics_Host, surface->comm, PETSC_ERR_ARG_WRONG,
             "surface %s is neither a host's (CoupleSurfaceCreateHost()) nor a beam's", surface->name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleSurfaceHostGetLoads(CoupleSurface surface, const PetscReal **Q)
{
  PetscFunctionBegin;
  PetscCall(CheckHost(surface));
  *Q = ((Host *)surface->ctx)->Q;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupleSurfaceHostGetSpec(CoupleSurface surface, CoupleHostSpec *spec)
{
  const Host *h = (const Host *)surface->ctx;

  PetscFunctionBegin;
  PetscCall(CheckHost(surface));
  *spec = (CoupleHostSpec){h->dim,   h->nnodes, h->direction, h->nsections, h->rowstart, h->node, h->shape,
                           h->slope, h->n,      h->section,   h->offset,    h->volume,   h->depth};
  PetscFunctionReturn(PETSC_SUCCESS);
}
