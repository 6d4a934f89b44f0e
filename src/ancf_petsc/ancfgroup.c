/*
  ancfgroup.c - many beams as groups, each with a TS of its own.

  Beams do not couple within a call of AncfAdvance(). A group small enough that all vectors of its TS stay in cache runs several
  times faster than one TS over all beams, whose vector operations are bound by memory; and each group takes only the Newton
  iterations and the steps that it needs. A group is an Ancf whose arrays are slices of the whole one's.
*/
#include "ancfimpl.h"

/* Slice of beams [first, last) of the whole set; everything but its TS is shared or derived. */
static PetscErrorCode AncfGroupCreate(Ancf ancf, PetscInt first, PetscInt last, Ancf *group)
{
  const PetscInt node = ancf->beams[first].node, element = ancf->beams[first].element;
  Ancf g;

  PetscFunctionBegin;
  PetscCall(PetscNew(&g));
  *g = *ancf;
  g->whole = ancf;
  g->ts = NULL;
  g->ngroups = 0;
  g->groups = NULL;
  g->firstbeam = first;
  g->nbeams = g->maxbeams = last - first;
  g->nnodes = 0;
  g->nelements = 0;
  PetscCall(PetscMalloc1(g->nbeams, &g->beams));
  for (PetscInt b = 0; b < g->nbeams; b++) {
    g->beams[b] = ancf->beams[first + b];
    g->beams[b].node -= node;
    g->beams[b].element -= element;
    g->nnodes += g->beams[b].spec.elements + 1;
    g->nelements += g->beams[b].spec.elements;
  }
  g->e += 6 * node;
  g->v += 6 * node;
  g->a += 6 * node;
  g->load += 6 * node;
  g->weight += 6 * node;
  g->steady += 6 * node;
  g->rest += 6 * node;
  g->fixed += node;
  g->mass += 8 * node;
  if (ancf->normal) g->normal += 3 * node;
  if (ancf->natural) {
    g->natural += (ancf->rule.axial.n + ancf->rule.bending.n) * node;
    g->shape += 6 * node;
  }
  if (ancf->viscous) {
    g->spin += 3 * first;
    g->spinsum += 9 * first;
  }
  if (ancf->history) {
    g->history += 6 * node;
    g->eprev += 6 * node;
    g->vprev += 6 * node;
  }
  PetscCall(AncfSetUpBatches(g));
  PetscCall(AncfSetUpLaneBeams(g));
  if (first == 0) { /* the first group takes over the TS that AncfCreate() made */
    g->ts = ancf->ts;
    PetscCall(PetscObjectReference((PetscObject)g->ts));
  } else {
    PetscCall(AncfTSCreate(g));
    PetscCall(AncfPrefixTS(g));
    if (ancf->fromoptions) PetscCall(TSSetFromOptions(g->ts));
  }
  PetscCall(AncfTSSetUp(g));
  *group = g;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Groups of about groupnodes nodes, of whole beams and whole batches of them. */
PetscErrorCode AncfGroupSetUp(Ancf ancf)
{
  PetscInt first = 0, max;

  PetscFunctionBegin;
  PetscCall(AncfChooseForm(ancf));
  if (ancf->form == ANCF_FORM_SECOND)
    PetscCall(PetscCalloc3(6 * (size_t)ancf->nnodes, &ancf->history, 6 * (size_t)ancf->nnodes, &ancf->eprev,
                           6 * (size_t)ancf->nnodes, &ancf->vprev));
  max = 1 + ancf->nnodes / PetscMax(1, ancf->groupnodes / 2);
  PetscCall(PetscMalloc1(max, &ancf->groups));
  while (first < ancf->nbeams) {
    PetscInt last = first, nodes = 0;

    while (last < ancf->nbeams && (nodes < ancf->groupnodes || (last - first) % ANCF_LANES))
      nodes += ancf->beams[last++].spec.elements + 1;
    PetscCheck(ancf->ngroups < max, ancf->comm, PETSC_ERR_PLIB, "Too many groups of beams");
    PetscCall(AncfGroupCreate(ancf, first, last, &ancf->groups[ancf->ngroups]));
    ancf->ngroups++;
    first = last;
  }
  ancf->restart = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AncfGroupDestroy(Ancf ancf)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < ancf->ngroups; k++) {
    Ancf g = ancf->groups[k];

    PetscCall(AncfTSDestroy(g));
    PetscCall(PetscFree(g->beams));
    PetscCall(PetscFree(g->batches));
    PetscCall(PetscFree(g->lanebeams));
    PetscCall(PetscFree(g));
  }
  PetscCall(PetscFree(ancf->groups));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All groups restart from the state of the whole set. */
PetscErrorCode AncfGroupPush(Ancf ancf)
{
  PetscFunctionBegin;
  ancf->restart = PETSC_TRUE;
  ancf->given = PETSC_FALSE;
  for (PetscInt k = 0; k < ancf->ngroups; k++) {
    ancf->groups[k]->t = ancf->t;
    PetscCall(AncfTSPush(ancf->groups[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One group after the other; when one fails, those before it go back too. */
PetscErrorCode AncfGroupSolve(Ancf ancf, PetscReal t)
{
  const PetscReal t0 = ancf->t;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < ancf->ngroups; k++) {
    Ancf g = ancf->groups[k];
    PetscErrorCode ierr;

    g->substeps = ancf->substeps;
    g->linear = ancf->linear;
    g->loadend = ancf->linear ? ancf->loadend + (g->load - ancf->load) : NULL;
    g->avalid = PETSC_FALSE;
    if (ancf->restart) g->given = ancf->given;
    ierr = AncfTSSolve(g, t);
    if (ierr)
      for (PetscInt i = 0; i < k; i++) PetscCall(AncfStateLoad(ancf->groups[i], t0, ancf->groups[i]->backup));
    PetscCall(ierr);
  }
  ancf->restart = ancf->given = PETSC_FALSE;
  ancf->t = t;
  ancf->linear = PETSC_FALSE;
  ancf->loadnow = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
