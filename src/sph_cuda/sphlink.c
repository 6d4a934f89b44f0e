/*
  sphlink.c - boundary groups that follow generalised coordinates: the description, and the host's way of moving them.

  Backends with operations of their own (cuda) get the states as they are; for the others the markers are placed here and their
  forces are summed here.
*/
#include "sphlinkimpl.h"

static SphLink *Find(Sph sph, PetscInt group)
{
  const struct _SphLinks *l = sph->links;

  return l && group >= 0 && group < l->nof && l->of[group] >= 0 ? &l->link[l->of[group]] : NULL;
}

PetscBool SphIsLinked(Sph sph, PetscInt group)
{
  return Find(sph, group) ? PETSC_TRUE : PETSC_FALSE;
}

static PetscErrorCode GetLink(Sph sph, PetscInt group, SphLink **link)
{
  PetscFunctionBegin;
  *link = Find(sph, group);
  PetscCheck(*link, sph->comm, PETSC_ERR_ORDER, "boundary group %" PetscInt_FMT " is not linked: SphSetGroupLink() comes first",
             group);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckSpec(Sph sph, PetscInt group, PetscInt n, const SphLinkSpec *p)
{
  PetscFunctionBegin;
  PetscCheck(p->nnodes >= 0 && p->nsections > 0 && (p->nnodes > 0 || p->nsections == 1), sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "link of group %" PetscInt_FMT ": nnodes = %" PetscInt_FMT ", nsections = %" PetscInt_FMT
             ": must be >= 0 and > 0, and a body (no nodes) has 1 section",
             group, p->nnodes, p->nsections);
  if (!p->nnodes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(p->rowstart[0] == 0, sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "link of group %" PetscInt_FMT ": rowstart[0] = %" PetscInt_FMT ": must be 0", group, p->rowstart[0]);
  for (PetscInt s = 0; s < p->nsections; s++)
    PetscCheck(p->rowstart[s + 1] >= p->rowstart[s], sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "link of group %" PetscInt_FMT ": rowstart must not fall; it does after section %" PetscInt_FMT, group, s);
  for (PetscInt e = 0; e < p->rowstart[p->nsections]; e++)
    PetscCheck(p->node[e] >= 0 && p->node[e] < p->nnodes, sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "link of group %" PetscInt_FMT ", entry %" PetscInt_FMT ": node %" PetscInt_FMT " must be in [0, %" PetscInt_FMT
               ")",
               group, e, p->node[e], p->nnodes);
  for (PetscInt i = 0; i < n; i++)
    PetscCheck(p->section[i] >= (i ? p->section[i - 1] : 0) && p->section[i] < p->nsections, sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "link of group %" PetscInt_FMT ", marker %" PetscInt_FMT ": section %" PetscInt_FMT
               " must be in [0, %" PetscInt_FMT ") and ascend",
               group, i, p->section[i], p->nsections);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CopySpec(SphLink *k, const SphLinkSpec *p)
{
  const PetscInt ns = p->nsections, ne = p->nnodes ? p->rowstart[ns] : 0;

  PetscFunctionBegin;
  k->nnodes = (int)p->nnodes;
  k->nsections = (int)ns;
  k->nstate = p->nnodes ? 9 * k->nnodes + (p->slope ? 3 * k->nsections : 0) : SECTION_BODY_STATE;
  k->nload = p->nnodes ? 3 * k->nnodes : 6;
  PetscCall(PetscCalloc3(ns + 1, &k->rowstart, ne, &k->node, k->n, &k->section));
  PetscCall(PetscCalloc3(ne, &k->shape, 3 * (size_t)k->n, &k->offset, k->nstate, &k->state));
  PetscCall(PetscArraycpy(k->offset, p->offset, 3 * k->n));
  if (!p->nnodes) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt s = 0; s <= ns; s++) k->rowstart[s] = (int)p->rowstart[s];
  for (PetscInt e = 0; e < ne; e++) k->node[e] = (int)p->node[e];
  for (PetscInt i = 0; i < k->n; i++) k->section[i] = (int)p->section[i];
  PetscCall(PetscArraycpy(k->shape, p->shape, ne));
  if (!p->slope) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(ne, &k->slope));
  PetscCall(PetscArraycpy(k->slope, p->slope, ne));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetGroupLink(Sph sph, PetscInt group, const SphLinkSpec *spec)
{
  struct _SphLinks *l = sph->links;

  PetscFunctionBegin;
  PetscCheck(!sph->setup, sph->comm, PETSC_ERR_ORDER, "SphSetGroupLink() must come before SphSetUp()");
  PetscCheck(group >= 0 && group < sph->ngroups, sph->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "boundary group %" PetscInt_FMT ": must be in [0, %" PetscInt_FMT ")", group, sph->ngroups);
  PetscCheck(!Find(sph, group), sph->comm, PETSC_ERR_ORDER, "boundary group %" PetscInt_FMT " is linked already", group);
  const PetscInt n = sph->groupstart[group + 1] - sph->groupstart[group];
  PetscCall(CheckSpec(sph, group, n, spec));
  if (!l) {
    PetscCall(PetscNew(&sph->links));
    l = sph->links;
  }
  if (l->n == l->cap) {
    SphLink *more;
    l->cap = 2 * l->cap + 8;
    PetscCall(PetscCalloc1(l->cap, &more));
    if (l->n) PetscCall(PetscArraycpy(more, l->link, l->n));
    PetscCall(PetscFree(l->link));
    l->link = more;
  }
  if (group >= l->nof) {
    const int nof = 2 * (int)group + 8;
    PetscCall(PetscRealloc((size_t)nof * sizeof(int), &l->of));
    for (int k = l->nof; k < nof; k++) l->of[k] = -1;
    l->nof = nof;
  }
  l->of[group] = l->n;
  SphLink *k = &l->link[l->n++];
  k->group = (int)group;
  k->n = (int)n;
  PetscCall(CopySpec(k, spec));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphLinksDestroy(Sph sph)
{
  PetscFunctionBegin;
  for (int i = 0; sph->links && i < sph->links->n; i++) {
    SphLink *k = &sph->links->link[i];
    PetscCall(PetscFree3(k->rowstart, k->node, k->section));
    PetscCall(PetscFree3(k->shape, k->offset, k->state));
    PetscCall(PetscFree(k->slope));
    PetscCall(PetscFree2(k->frame, k->sums));
    PetscCall(PetscFree5(k->x, k->v, k->a, k->f, k->o));
  }
  if (sph->links) PetscCall(PetscFree(sph->links->link));
  if (sph->links) PetscCall(PetscFree(sph->links->of));
  PetscCall(PetscFree(sph->links));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphGetGroupLinkSize(Sph sph, PetscInt group, PetscInt *state, PetscInt *load)
{
  SphLink *k;

  PetscFunctionBegin;
  PetscCall(GetLink(sph, group, &k));
  if (state) *state = k->nstate;
  if (load) *load = k->nload;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Markers from k->state; `move`: to the backend as well. */
static PetscErrorCode PlaceMarkers(Sph sph, SphLink *k, PetscBool move)
{
  PetscFunctionBegin;
  if (!k->frame) {
    PetscCall(PetscMalloc2(k->nsections, &k->frame, (size_t)SECTION_SUMS * (size_t)k->nsections, &k->sums));
    PetscCall(PetscMalloc5(3 * (size_t)k->n, &k->x, 3 * (size_t)k->n, &k->v, 3 * (size_t)k->n, &k->a, 3 * (size_t)k->n, &k->f,
                           3 * (size_t)k->n, &k->o));
  }
  for (int s = 0; s < k->nsections; s++) SphLinkSection(k, (int)sph->par.dim, k->state, s, &k->frame[s]);
  for (int i = 0; i < k->n; i++) {
    const FrondSection *s = &k->frame[k->section[i]];
    section_offset(s, k->offset + 3 * i, k->o + 3 * i);
    section_marker(s, k->o + 3 * i, k->x + 3 * i, k->v + 3 * i, k->a + 3 * i);
  }
  for (int i = 0; i < k->n && sph->omega; i++)
    PetscCall(PetscArraycpy(sph->omega + 3 * (sph->groupstart[k->group] - sph->nfluid + i), k->frame[k->section[i]].w, 3));
  if (move) PetscCall((*sph->ops->motion)(sph, k->group, k->x, k->v, k->a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphSetGroupState(Sph sph, PetscInt group, const PetscReal *state)
{
  SphLink *k;

  PetscFunctionBegin;
  PetscCheck(sph->setup, sph->comm, PETSC_ERR_ORDER, "SphSetGroupState() must come after SphSetUp()");
  PetscCall(GetLink(sph, group, &k));
  PetscCall(PetscLogEventBegin(SPH_Motion, 0, 0, 0, 0));
  PetscCall(PetscArraycpy(k->state, state, k->nstate));
  k->set = PETSC_TRUE;
  if (sph->ops->linkmotion)
    PetscCall((*sph->ops->linkmotion)(sph, (PetscInt)(k - sph->links->link)));
  else
    PetscCall(PlaceMarkers(sph, k, PETSC_TRUE));
  PetscCall(PetscLogEventEnd(SPH_Motion, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SumForces(Sph sph, SphLink *k, PetscReal *load, double *totals)
{
  PetscFunctionBegin;
  PetscCall((*sph->ops->force)(sph, k->group, k->f));
  PetscCall(PetscArrayzero(k->sums, SECTION_SUMS * k->nsections));
  PetscCall(PetscArrayzero(load, k->nload));
  for (int i = 0; i < k->n; i++) {
    double *sums = k->sums + SECTION_SUMS * k->section[i];
    section_add_force(k->o + 3 * i, k->f + 3 * i, sums);
    section_add_moment_power(k->x + 3 * i, k->v + 3 * i, k->f + 3 * i, sums);
  }
  for (int s = 0; s < k->nsections; s++) {
    const double *sums = k->sums + SECTION_SUMS * s;
    section_add_totals(&k->frame[s], sums, totals);
    if (!k->nnodes) PetscCall(PetscArraycpy(load, sums, 6));
    for (int e = k->rowstart[s]; e < k->rowstart[s + 1]; e++)
      section_add_node(&k->frame[s], k->shape[e], k->slope ? k->slope[e] : 0.0, sums, sums + 3, load + 3 * k->node[e]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SphGetGroupLoad(Sph sph, PetscInt group, PetscReal *load, SphLinkTotals *totals)
{
  double t[SECTION_TOTALS] = {0.0};
  SphLink *k;

  PetscFunctionBegin;
  PetscCall(GetLink(sph, group, &k));
  PetscCheck(k->set, sph->comm, PETSC_ERR_ORDER, "SphGetGroupLoad() of group %" PetscInt_FMT ": SphSetGroupState() comes first",
             group);
  if (sph->ops->linkload)
    PetscCall((*sph->ops->linkload)(sph, (PetscInt)(k - sph->links->link), load, t));
  else
    PetscCall(SumForces(sph, k, load, t));
  if (!totals) PetscFunctionReturn(PETSC_SUCCESS);
  for (int c = 0; c < 3; c++) {
    totals->force[c] = t[c];
    totals->moment[c] = t[3 + c];
    totals->axial[c] = t[8 + c];
  }
  totals->power = t[6];
  totals->twist = t[7];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The states of linked groups, which the forces of a restored state act on; a state of an unlinked fluid has none. */
PetscErrorCode SphLinksState(Sph sph, FrondState *s)
{
  char name[64];

  PetscFunctionBegin;
  for (int i = 0; sph->links && i < sph->links->n; i++) {
    SphLink *k = &sph->links->link[i];
    PetscBool there = PETSC_TRUE;
    PetscCall(PetscSNPrintf(name, sizeof(name), "fluid/link_%d/set", k->group));
    if (s->way == FROND_STATE_LOAD) PetscCall((*s->has)(s, name, &there));
    if (!there) continue;
    FrondMoveInt32(s, name, &k->set, 1);
    PetscCall(PetscSNPrintf(name, sizeof(name), "fluid/link_%d/state", k->group));
    FrondMoveReal(s, name, k->state, k->nstate);
    if (s->way != FROND_STATE_LOAD || !k->set) continue;
    if (sph->ops->linkmotion)
      PetscCall((*sph->ops->linkmotion)(sph, i));
    else
      PetscCall(PlaceMarkers(sph, k, PETSC_FALSE)); /* the markers themselves are in the state */
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
